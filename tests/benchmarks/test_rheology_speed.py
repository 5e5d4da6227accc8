"""Cost of each law over the plain film: factor of one accepted step (three evaluations, two tangents, one history).

Interleaved minima of one thread; the limits are the targets with a margin for a noisy machine.
"""

import time

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

WALTHER = ehd.WaltherTemperature(first=(313.15, 23e-6), second=(373.15, 5e-6))
ROELANDS, CARREAU = (
    ehd.RoelandsPressure(coefficient=2e-8),
    ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2),
)
CASES = {
    "barus": ({"pressure_law": ehd.BarusPressure(coefficient=1e-8)}, None, 1.25),
    "roelands": ({"pressure_law": ROELANDS}, None, 1.25),
    "carreau": ({"shear_law": CARREAU}, None, 4.2),
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
R, C, SPEED = 0.02, 20e-6, 300.0
MOTION = np.array([13e-6, 5e-6, 1e-4, -1.5e-4, 1e-3, -1e-3, 0.05, 0.02, 250.0, 0.3])


def make(laws, thermal, cavitation):
    oil = ehd.Lubricant(viscosity=0.02, temperature_law=WALTHER, **laws)
    return build_model(
        ehd.JournalBearing(
            journal_radius=0.025,
            length=0.05,
            radial_clearance=25e-6,
            lubricant=oil,
            cavitation=cavitation,
            thermal=thermal,
            end_pressures=(1e5, 1e5),
        )
    )


def make_orbiting(laws):
    return build_model(
        ehd.JournalBearing(
            journal_radius=R,
            length=0.03,
            radial_clearance=C,
            lubricant=ehd.Lubricant(viscosity=0.03, **laws),
            film=ehd.FiniteLength(n_theta=96, n_z=10),
        )
    )


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
        f"{name} {type(cavitation).__name__}: "
        f"plain {1e3 * plain:.3f} ms, with the law {1e3 * law:.3f} ms, {law / plain:.2f}"
    )
    assert law / plain < MARGIN * target


def orbit(eccentricity_ratio, count=60):
    """The journal one degree further per evaluation, as in a time integration."""
    k = np.radians(np.arange(count))
    e = C * eccentricity_ratio * (1.0 + 0.06 * np.sin(5 * k))
    v = 0.3 * SPEED * e
    zero = np.zeros(count)
    rows = [e * np.cos(k), e * np.sin(k), zero, zero, -v * np.sin(k), v * np.cos(k), zero, zero, zero + SPEED, zero]
    return np.stack(rows, axis=1)


@pytest.mark.benchmark
@pytest.mark.parametrize(
    "name, eccentricity_ratio", [("density", 0.85), ("density", 0.68), ("density and barus", 0.68)]
)
def test_density_on_an_orbit(name, eccentricity_ratio):
    """Evaluation with tangent: means over the orbit of every state's best time, each from the state before.

    Peaks of 40 to 110 MPa, where Barus' law has no pressure left, and of 11 to 17 MPa.
    """
    laws, _, target = CASES[name]
    models, motions = (make_orbiting({}), make_orbiting(laws)), orbit(eccentricity_ratio)
    best = np.full((2, len(motions)), np.inf)
    for _ in range(40):
        for model, times in zip(models, best):
            for k, motion in enumerate(motions):
                evaluate, evaluation = timed(lambda: model.evaluate(motion))  # noqa: B023 - called at once
                tangent, _ = timed(evaluation.tangent)
                times[k] = min(times[k], evaluate + tangent)
    plain, law = best.mean(axis=1)
    print(
        f"{name} on an orbit at {eccentricity_ratio}: "
        f"plain {1e6 * plain:.0f} us, with the law {1e6 * law:.0f} us, {law / plain:.2f}"
    )
    assert law / plain < MARGIN * target
