"""Films on liners are those of a cold start, with their tangents, whatever film was solved before."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import but_slow

C, R = 25e-6, 0.025
CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "gumbel": ehd.Gumbel(),
    "swift": ehd.SwiftStieber(),
    "swift on vertices": ehd.SwiftStieber(line_in_cells=False),
    "elrod": ehd.ElrodAdams(cavity_pressure=-1e5),
    "elrod in cells": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True),
}
OILS = {
    "plain": {},
    "barus": {"pressure_law": ehd.BarusPressure(coefficient=1e-8)},
    "dowson": {"density_law": ehd.DowsonHigginson()},
    "carreau": {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)},
}
CASES = [(oil, closure) for oil in OILS for closure in CLOSURES]


def _random_motion(rng):
    e, at, motion = rng.uniform(0.05, 0.9), rng.uniform(0.0, 2.0 * np.pi), np.zeros(10)
    motion[:2] = e * C * np.array([np.cos(at), np.sin(at)])
    motion[2:4] = rng.uniform(-0.4, 0.4, 2) * (1.0 - e) * C / R
    motion[4:6], motion[6:8] = rng.normal(0.0, 4e-3, 2), rng.normal(0.0, 0.05, 2)
    motion[8:] = rng.uniform(-400.0, 400.0), rng.normal()
    return motion


@pytest.mark.parametrize(
    "case",
    but_slow(CASES, *(case for case in CASES if case[0] != "plain")),
    ids=", ".join,
)
def test_films_and_tangents_are_those_of_a_cold_start(case):
    """Steady, in a step after it at the same place, at a new place; 1e-12 is ten times what a film is solved to.

    In a step at the same place the gap's rates are others, while hardly a pressure changes.
    """
    oil, closure = case
    model = build_model(
        ehd.JournalBearing(
            journal_radius=R, length=0.05, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.02, **OILS[oil]),
            cavitation=CLOSURES[closure], end_pressures=(1e5, 2e5), film=ehd.FiniteLength(n_theta=48, n_z=8),
            bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=5e9),
        )
    )  # fmt: skip
    rng, compared = np.random.default_rng(5), 0
    for _ in range(8):
        motion = _random_motion(rng)
        model.forget()
        history = model.initial_history(motion)
        for place, past, step in ((motion, None, 0.0), (motion, history, 1e-4), (_random_motion(rng), None, 0.0)):
            warm = model.evaluate(place, past, step)
            if warm.status is not ehd.Status.CONVERGED:
                continue
            wrench, tangent = warm.wrench.copy(), warm.tangent().copy()
            model.forget()
            cold = model.evaluate(place, past, step)
            assert cold.status is ehd.Status.CONVERGED
            assert np.abs(wrench - cold.wrench).max() < 1e-12 * np.abs(cold.wrench).max()
            rows = cold.tangent()
            assert (np.abs(tangent - rows).max(axis=1) < 1e-12 * np.abs(rows).max(axis=1)).all()
            compared += 1
    assert compared >= 12
