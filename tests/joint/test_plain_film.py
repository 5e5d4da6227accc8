"""Films without further effects, from one kernel, against the way of any film."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import Status

GRID = ehd.FiniteLength(n_theta=48, n_z=6)
GROOVE = ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5)
RING = ehd.CircumferentialGroove(z=0.004, width=3e-3, pressure=1e5)
ORIFICE = ehd.Orifice(diameter=1e-3, supply_pressure=5e5)
ROUGH = ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=1e11)
WARM = {"lubricant": ehd.oil("ISO VG 32"), "thermal": ehd.LumpedThermal(supply_temperature=313.0)}
PLAIN = {
    "default": {},
    "on vertices": {"cavitation": ehd.SwiftStieber(line_in_cells=False)},
    "partly sheared": {"cavitation": ehd.SwiftStieber(cavity_shear=0.3, cavity_pressure=-5e4)},
    "ends": {"end_pressures": (1e5, 3e4)},
    "no squeeze": {"squeeze": False},
    "groove": {"supply": (GROOVE,)},
    "hole and ring": {"supply": (ehd.Hole(angle=2.0, diameter=4e-3, pressure=1e5), RING)},
    "groove in the journal": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5, rotating=True),)},
    "wall": {"contact": ehd.RegularisedWall(onset=10e-6)},
    "one temperature": WARM | {"supply": (GROOVE,)},
    "short": {"film": ehd.ShortBearing()},
    "short, on vertices": {"film": ehd.ShortBearing(), "cavitation": ehd.SwiftStieber(line_in_cells=False)},
}
OTHERS = {
    "no cavity": {"cavitation": ehd.FullSommerfeld()},
    "Gumbel": {"cavitation": ehd.Gumbel()},
    "mass": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "groove with a floor": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5, depth=1e-4),)},
    "orifice": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, supply=ORIFICE),)},
    "temperature field": {"lubricant": ehd.oil("ISO VG 32"), "thermal": ehd.FilmEnergy(supply_temperature=313.0)},
    "oil": {"lubricant": ehd.Lubricant(viscosity=0.02, pressure_law=ehd.RoelandsPressure(coefficient=2e-8))},
    "rubbing": {"asperity": ROUGH, "wear": ehd.ArchardWear(wear_rate=1e-15)},
    "liner": {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=1e-6)},
    "oval": {"profile": ehd.OutOfRound(order=2, amplitude=3e-6)},
}


def _model(make_bearing, **options):
    return build_model(make_bearing(1.0, **({"film": GRID} | options)))


def _motions(count, seed):
    """Any place, tilt, rate and speed; now and then a journal in the bore's wall, or one that is lost."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        eps, angle = rng.uniform(0.0, 0.97), rng.uniform(0.0, 2.0 * np.pi)
        motion = np.zeros(10)
        motion[:2] = 25e-6 * (1.3 if k % 17 == 16 else eps) * np.array([np.cos(angle), np.sin(angle)])
        motion[2:4] = rng.normal(0.0, 0.2 * (1.0 - eps), 2) * 1e-3
        motion[4:] = *rng.normal(0, 5e-3, 2), *rng.normal(0, 0.1, 2), rng.normal(0, 200), rng.normal(0, 0.1)
        if k % 23 == 22:
            motion[rng.integers(10)] = np.nan
        yield motion


@pytest.mark.parametrize("name", PLAIN)
def test_same_as_the_way_of_any_film(make_bearing, name):
    model, other = (_model(make_bearing, **PLAIN[name]) for _ in range(2))
    assert model._least_gap is not None
    other._least_gap = None
    seen, still = set(), np.eye(10)[8] * 100.0
    histories = [each.initial_history(still) for each in (model, other)]
    for k, motion in enumerate(_motions(70, 3)):
        found, expected = (
            each.evaluate(motion, history, 1e-3, 0.2 * k)
            for each, history in zip((model, other), histories, strict=True)
        )
        seen.add(found.status)
        assert found.status is expected.status
        # the same kernels, which may round otherwise inside another
        for got, want in ((found.wrench[:, None], expected.wrench[:, None]), (found.tangent(), expected.tangent())):
            scale = np.maximum(np.abs(want).max(axis=0), 1e-300)
            np.testing.assert_allclose(got / scale, want / scale, rtol=0.0, atol=1e-12)
        assert found.quantities() == pytest.approx(expected.quantities(), nan_ok=True, rel=1e-12, abs=0.0)
        if found.status is Status.CONVERGED:
            histories = [each.history() for each in (found, expected)]
    if histories[0] is not None:
        assert histories[0].temperature == pytest.approx(histories[1].temperature, rel=1e-12)
        assert histories[0].temperature > 314.0
    assert seen == {Status.CONVERGED, Status.NOT_FINITE} | (set() if name == "wall" else {Status.NO_FILM})


def test_a_state_without_a_film_leaves_the_warm_start(make_bearing):
    model = _model(make_bearing)
    motion = np.array([12e-6, 16e-6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 100.0, 0.0])
    model.evaluate(motion)
    steps = model.evaluate(motion).iterations
    assert model.evaluate(2.0 * motion).status is Status.NO_FILM
    assert model.solver.work.warm
    assert model.evaluate(motion).iterations <= steps + 1


@pytest.mark.parametrize("name", OTHERS)
def test_others_take_the_long_way(make_bearing, name):
    model = _model(make_bearing, **OTHERS[name])
    assert model._least_gap is None
