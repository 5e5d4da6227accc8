"""The tangent of a plain film in one kernel against that of any film."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.tangent import wrench
from exudyn_ehd.joint.tangent.plain import has_plain_tangent

GRID = ehd.FiniteLength(n_theta=48, n_z=6)
GROOVE = ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5)
RING = ehd.CircumferentialGroove(z=0.004, width=3e-3, pressure=1e5)
ORIFICE = ehd.Orifice(diameter=1e-3, supply_pressure=5e5)
PLAIN = {
    "default": {},
    "on vertices": {"cavitation": ehd.SwiftStieber(line_in_cells=False)},
    "no cavity": {"cavitation": ehd.FullSommerfeld()},
    "partly sheared": {"cavitation": ehd.SwiftStieber(cavity_shear=0.3, cavity_pressure=-5e4)},
    "ends": {"end_pressures": (1e5, 3e4)},
    "groove": {"supply": (GROOVE,)},
    "no squeeze": {"squeeze": False},
    "short": {"film": ehd.ShortBearing()},
    "short, on vertices": {"film": ehd.ShortBearing(), "cavitation": ehd.SwiftStieber(line_in_cells=False)},
    "fed by a hole and a ring": {"supply": (ehd.Hole(angle=2.0, diameter=4e-3, pressure=1e5), RING)},
    "groove in the journal": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5, rotating=True),)},
    "long": {"film": ehd.LongBearing(), "supply": (GROOVE,)},
}
OTHERS = {
    "groove with a floor": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5, depth=1e-4),)},
    "orifice": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, supply=ORIFICE),)},
    "Gumbel": {"cavitation": ehd.Gumbel()},
    "mass": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "oil": {"lubricant": ehd.Lubricant(viscosity=0.02, pressure_law=ehd.RoelandsPressure(coefficient=2e-8))},
    "wall": {"contact": ehd.RegularisedWall(onset=10e-6)},
    "liner": {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=1e-6)},
    "turbulent": {"turbulence": ehd.NgPan()},
    "oval": {"profile": ehd.OutOfRound(order=2, amplitude=3e-6)},
}


def motions(count):
    rng = np.random.default_rng(4)
    for _ in range(count):
        eps, angle = rng.uniform(0.0, 0.95), rng.uniform(0.0, 2.0 * np.pi)
        tilt = rng.normal(0.0, 0.2 * (1.0 - eps), 2) * 1e-3
        place = 25e-6 * eps * np.array([np.cos(angle), np.sin(angle)])
        yield np.array([*place, *tilt, *rng.normal(0, 5e-3, 2), *rng.normal(0, 0.1, 2), *rng.normal(0, 200, 1), 0.1])


@pytest.mark.parametrize("name", PLAIN)
def test_same_as_for_any_film(make_bearing, name, monkeypatch):
    model = build_model(make_bearing(1.0, **({"film": GRID} | PLAIN[name])))
    seen = 0
    for motion in motions(20):
        evaluation = model.evaluate(motion, spin=0.3 * seen)
        if evaluation.film is None:
            continue
        assert has_plain_tangent(evaluation.film) is (name != "long")
        seen += 1
        plain = evaluation.tangent()
        with monkeypatch.context() as patch:
            patch.setattr(wrench, "has_plain_tangent", lambda film: False)
            patient = evaluation.tangent()
        assert plain == pytest.approx(patient, rel=1e-12, abs=1e-14 * abs(patient).max())
    assert seen > 10


@pytest.mark.parametrize("name", OTHERS)
def test_others_take_the_long_way(make_bearing, name):
    model = build_model(make_bearing(1.0, **({"film": GRID} | OTHERS[name])))
    motion = np.array([12e-6, 16e-6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 100.0, 0.0])
    assert not has_plain_tangent(model.evaluate(motion, model.initial_history(motion), 1e-4).film)
