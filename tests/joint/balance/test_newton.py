"""One Newton's method for position, temperature and axial place: what it keeps of each of them."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import Balance
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.newton import continued
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.thrust import ThrustModel

C, SPEED, SUPPLY = 30e-6, 300.0, 320.0
LAW = ehd.ReynoldsTemperature(point=(SUPPLY, 0.02), coefficient=0.03)
KINDS = {
    "isothermal": None,
    "lumped": ehd.LumpedThermal(supply_temperature=SUPPLY),
    "field": ehd.FilmEnergy(supply_temperature=SUPPLY),
}


def bearing(thermal, **options):
    return ehd.JournalBearing(
        journal_radius=0.03,
        length=0.03,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=0.02, temperature_law=LAW, temperature=SUPPLY),
        thermal=thermal,
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        **options,
    )


@pytest.mark.parametrize("kind", KINDS)
def test_a_position_under_its_own_load_is_found_again_with_its_temperature(kind):
    model = build_study_model(bearing(KINDS[kind]), 0.0)
    motion = np.array([0.5 * C, -0.3 * C, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SPEED, 0.0])
    given = Balance(model, "test")
    there = given.solve(motion, given.temperature_of(None))
    assert given.is_balanced(there, settled=1e-11)
    search = Balance(model, "test", -there.evaluation.wrench[:2])
    start = np.where(np.arange(10) < 2, 0.9, 1.0) * motion
    found = search.solve(start, search.temperature_of(None))
    assert search.is_balanced(found) and search.residual(found) < 1e-10
    np.testing.assert_allclose(found.motion[:2], motion[:2], rtol=0, atol=1e-8 * C)
    np.testing.assert_allclose(found.temperature, there.temperature, rtol=0, atol=1e-6)


def test_a_held_temperature_is_not_sought():
    model = build_study_model(bearing(KINDS["lumped"]), 0.0)
    motion = np.array([0.5 * C, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SPEED, 0.0])
    expected = model.evaluate(motion, History(temperature=350.0)).wrench[:2].copy()
    search = Balance(model, "test", -expected, held=History(temperature=350.0))
    found = search.solve(1.1 * motion * (np.arange(10) < 8) + motion * (np.arange(10) >= 8), search.cold)
    assert found.film.temperature == 350.0 and not found.change.size
    np.testing.assert_allclose(found.motion[:2], motion[:2], rtol=0, atol=1e-8 * C)


def test_plane_faces_without_an_axial_load_stay_where_they_are():
    faces = ehd.ThrustFaces(inner_radius=0.032, outer_radius=0.05, clearance=4e-5, n_theta=24, n_r=6)
    made = bearing(None, thrust=faces)
    search = Balance(build_study_model(made, 0.0), "test", np.array([0.0, -1e3, 0.0]), faces=ThrustModel(made))
    motion = np.array([0.3 * C, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SPEED, 0.0, 5e-6])
    found = search.solve(motion, search.cold)
    assert search.is_balanced(found) and found.motion[10] == 5e-6


def test_steps_of_a_continuation_are_halved_where_one_is_not_reached():
    tried = []

    def reach(share, here, final):
        tried.append((share, here, final))
        return share if share < 0.7 else None

    assert continued(reach, 0.5, 0.1) == (0.625, 0.625)
    assert tried[0] == (0.5, None, False)
    assert [final for _, _, final in tried][-1]
    assert continued(lambda share, here, final: None, 1.0, 1.0) == (0.0, None)
