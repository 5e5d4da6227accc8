"""What each law costs over the plain film: factor of one accepted step (three evaluations, two tangents, one history).

Interleaved minima of one thread; the limits are the targets with a margin for a noisy machine.
"""

import time

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.build import build_model

WALTHER = ehd.WaltherTemperature(first=(313.15, 23e-6), second=(373.15, 5e-6))
ROELANDS, CARREAU = (
    ehd.RoelandsPressure(coefficient=2e-8),
    ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2),
)
CASES = {
    "barus": ({"pressure_law": ehd.BarusPressure(coefficient=1e-8)}, None, 1.5),
    "roelands": ({"pressure_law": ROELANDS}, None, 1.5),
    "carreau": ({"shear_law": CARREAU}, None, 1.5),
    "density": ({"density_law": ehd.DowsonHigginson()}, None, 1.5),
    "density and barus": (
        {"density_law": ehd.DowsonHigginson(), "pressure_law": ehd.BarusPressure(coefficient=1e-8)},
        None,
        1.5,
    ),
    "lumped": ({}, ehd.LumpedThermal(supply_temperature=320.0), 1.05),
    "field": ({}, ehd.FilmEnergy(supply_temperature=320.0), 2.5),
}
MARGIN = 1.1
MOTION = np.array([13e-6, 5e-6, 1e-4, -1.5e-4, 1e-3, -1e-3, 0.05, 0.02, 250.0, 0.3])


def make(laws, thermal, cavitation):
    oil = ehd.Lubricant(viscosity=0.02, temperature_law=WALTHER, **laws)
    return build_model(
        ehd.JournalBearing(
            journal_radius=0.025, length=0.05, radial_clearance=25e-6, lubricant=oil, cavitation=cavitation, thermal=thermal,
            end_pressures=(1e5, 1e5),
        )
    )  # fmt: skip


def timed(call):
    begin = time.process_time()
    result = call()
    return time.process_time() - begin, result


def step_time(model, history):
    evaluate, evaluation = timed(lambda: model.evaluate(MOTION, history, 1e-4))
    tangent, _ = timed(evaluation.tangent)
    accept, _ = timed(evaluation.history)
    return np.array([evaluate, tangent, accept])


@pytest.mark.benchmark
@pytest.mark.parametrize(
    "cavitation", [ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)], ids=["swift", "elrod"]
)
@pytest.mark.parametrize("name", list(CASES))
def test_factor_over_the_plain_film(name, cavitation):
    laws, thermal, target = CASES[name]
    models = [make({}, None, cavitation), make(laws, thermal, cavitation)]
    histories = [m.initial_history(MOTION) for m in models]
    best = np.full((2, 3), np.inf)
    for _ in range(80):
        for k, model in enumerate(models):
            best[k] = np.minimum(best[k], step_time(model, histories[k]))
    plain, law = best @ (3.0, 2.0, 1.0)
    print(
        f"{name} {type(cavitation).__name__}: plain {1e3 * plain:.3f} ms, with the law {1e3 * law:.3f} ms, {law / plain:.2f}"
    )
    assert law / plain < MARGIN * target
