"""Films on both end faces of a bearing: about its origin, with its options, at prescribed positions."""

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.thrust import ThrustModel, face_motion
from tests.recorded.draw import FACTORS
from tests.sampling import sample

CLOSURES = {name: level["cavitation"] for name, level in FACTORS["closure"].items()}
# Effects of the journal's film beside which faces keep their own.
CARRIED = ("supply", "surfaces", "profile", "wall", "roughness", "asperity")


@dataclasses.dataclass(frozen=True)
class ByGapAndSpeed:
    """A law of one's own that changes links by their gap and the sliding speed."""

    onset = 1e6

    def bound(self, radius, clearance):
        raise NotImplementedError


C = 40e-6
PADS = ehd.TaperLand(pads=4, depth=30e-6)
SCALE = np.array([25e-6, 25e-6, 4e-4, 4e-4, 5e-3, 5e-3, 0.02, 0.02, 300.0, 2e-3, C])


def _faces(**options):
    return ehd.ThrustFaces(
        **{"inner_radius": 0.026, "outer_radius": 0.05, "clearance": C, "n_theta": 48, "n_r": 6} | options
    )


def _bearing(faces=None, **options):
    b = {"journal_radius": 0.025, "length": 0.04, "radial_clearance": 50e-6}
    oil = ehd.Lubricant(viscosity=0.03, **options.pop("lubricant", {}))
    return ehd.JournalBearing(**b, lubricant=oil, thrust=faces or _faces(), **options)


@pytest.mark.parametrize("closure", [name for name in CLOSURES if not CLOSURES[name].conserves_mass])
@pytest.mark.parametrize("profile", (None, PADS))
def test_tangent(closure, profile):
    """d wrench / d motion on random states, wall included."""
    wall = ehd.RegularisedWall(onset=15e-6, pressure=1e7)
    faces = _faces(profile=profile, contact=wall, inner_pressures=(1e5, 2e5))
    model, rng = ThrustModel(_bearing(faces, cavitation=CLOSURES[closure])), np.random.default_rng(5)
    for _ in range(4):
        state = rng.uniform(-0.8, 0.8, 11) * SCALE
        found = model.evaluate(state)
        assert found.status is ehd.Status.CONVERGED
        tangent = found.tangent() * SCALE
        for d in rng.normal(size=(2, 11)):
            near = [state + k * 1e-6 * d * SCALE for k in (1, -1)]
            plus, minus = (model.evaluate(s).wrench for s in near)
            error = np.abs(tangent @ d - (plus - minus) / 2e-6)
            # central differences of smooth states, see tests/film/thrust
            assert np.all(error < 1e-6 * np.abs(tangent).max(axis=1))
    with pytest.raises(RuntimeError, match="another state"):
        found.tangent()


def test_turn_of_the_journal_about_the_origin():
    """A journal that turns about O as a whole, (x, y) and tilt together, moves its collars as their planes move."""
    rng, height = np.random.default_rng(2), 0.02
    motion, position, turn = rng.normal(size=10) * SCALE[:10], 10e-6, 1e-7 * np.array([0.3, -0.7])
    # small turn (phi_x, phi_y): z of the centre by phi_x y - phi_y x, slopes by (phi_y, -phi_x)
    turned = motion.copy()
    turned[2] += turn[1]
    turned[3] -= turn[0]
    there = position + turn[0] * motion[1] - turn[1] * motion[0]
    change = face_motion(np.append(turned, there), height)[:3] - face_motion(np.append(motion, position), height)[:3]
    # the plane's height on the bearing's axis stays
    assert abs(change[0]) < 1e-6 * np.abs(turn).max() * 25e-6
    assert change[1:] == pytest.approx([turn[1], -turn[0]])


def test_wrench_about_the_origin():
    """Forces in the plane of a face have the moment of their height."""
    model, motion = ThrustModel(_bearing(_faces(lower=False))), np.zeros(10)
    motion[4] = 0.1
    found = model.evaluate(np.append(motion, 0.0))
    shear = 0.03 * 0.1 / C * np.pi * (0.05**2 - 0.026**2)
    assert found.wrench == pytest.approx([-shear, 0, 0, 0, -0.02 * shear, 0], rel=1e-3, abs=1e-9)


def test_both_faces_balance():
    """In the middle nothing pushes; pressure of one bearing end pushes its collar away."""
    still = np.zeros(10)
    assert ThrustModel(_bearing()).evaluate(np.append(still, 0.0)).wrench == pytest.approx(np.zeros(6), abs=1e-9)
    lifted = ThrustModel(_bearing(end_pressures=(0.0, 1e5))).evaluate(np.append(still, 0.0)).wrench
    fed = ThrustModel(_bearing(_faces(inner_pressures=(0.0, 1e5)))).evaluate(np.append(still, 0.0)).wrench
    assert lifted[2] > 10.0
    assert np.array_equal(lifted, fed)


def test_pads_hold_the_journal_in_the_middle():
    bearing = _bearing(_faces(profile=PADS))
    faces = [
        ehd.steady(bearing, speed=200.0, eccentricity_ratio=0.4, axial_position=z).faces for z in (-2e-5, 0.0, 2e-5)
    ]
    force = np.array([f.axial_force for f in faces])
    assert force[0] > 100.0
    assert force == pytest.approx([force[0], 0.0, -force[0]], abs=1e-9 * force[0])
    assert all(f.axial_stiffness > 0 and f.axial_damping > 0 for f in faces)
    assert faces[2].minimum_gap == pytest.approx(2e-5)
    assert faces[0].power_loss == pytest.approx(-200.0 * faces[0].friction_torque, rel=1e-3)
    assert faces[0].pressure.shape == faces[0].gap.shape == (2, 48, 7)
    assert faces[0].r[[0, -1]] == pytest.approx([0.026, 0.05])


def test_journal_film_does_not_know_the_faces():
    """The rest of `steady` is that of the bearing without them, bit for bit; without them there is no position."""
    bearing = _bearing()
    plain = dataclasses.replace(bearing, thrust=None)
    with_faces, without = (ehd.steady(b, speed=200.0, eccentricity_ratio=0.6) for b in (bearing, plain))
    assert without.faces is None
    assert with_faces.faces is not None
    assert np.array_equal(with_faces.pressure, without.pressure)
    assert np.array_equal(with_faces.force, without.force)
    with pytest.raises(ehd.InputError, match=r"axial_position.*thrust"):
        ehd.steady(plain, speed=200.0, eccentricity_ratio=0.6, axial_position=1e-6)
    with pytest.raises(ehd.FilmError, match="NO_FILM on a thrust face"):
        ehd.steady(bearing, speed=200.0, eccentricity_ratio=0.6, axial_position=5e-5)


def _effects(names):
    """(name, options) of the levels of factors, but for the absence of an effect, or of single levels."""
    for factor, levels in FACTORS.items():
        for name, level in list(levels.items())[1:]:
            if factor in names or name in names:
                yield pytest.param(level(0.04) if callable(level) else level, id=f"{factor} {name}")


LAWS = {
    "pressure_law": ehd.BarusPressure(coefficient=1e-7),
    "density_law": ehd.DowsonHigginson(),
    "shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6),
}


@pytest.mark.parametrize("name", (*LAWS, "turbulence", "thermal"))
def test_effects_that_faces_share_with_the_journal_s_film(name):
    """They change both films; d wrench / d motion is exact with them."""
    options = {"lubricant": {name: LAWS[name]}} if name in LAWS else {}
    if name == "turbulence":
        options["turbulence"] = ehd.Hirs(onset=2.0, full=4.0, coefficient=5.0)
    if name == "thermal":
        law = ehd.ReynoldsTemperature(point=(320.0, 0.03), coefficient=0.03)
        options = {"lubricant": {"temperature_law": law}, "thermal": ehd.LumpedThermal(supply_temperature=330.0)}
    bearing = _bearing(_faces(profile=PADS), **options)
    model, state = ThrustModel(bearing), 0.4 * SCALE
    found = model.evaluate(state, build_model(bearing).initial_history(state[:10]))
    tangent = found.tangent() * SCALE
    assert not np.allclose(found.wrench, ThrustModel(_bearing(_faces(profile=PADS))).evaluate(state).wrench, rtol=1e-6)
    d = np.random.default_rng(3).normal(size=11)
    plus, minus = (model.evaluate(state + k * 1e-6 * d * SCALE).wrench for k in (1, -1))
    assert np.all(np.abs(tangent @ d - (plus - minus) / 2e-6) < 1e-6 * np.abs(tangent).max(axis=1))


OF_JOURNALS = list(_effects(CARRIED))
# modes take long: by default those of both surfaces
QUICK = [k for k, case in enumerate(OF_JOURNALS) if case.id not in ("surfaces modal bush", "surfaces elastic journal")]


@pytest.mark.parametrize("options", sample(OF_JOURNALS, *QUICK))
def test_effects_of_the_journal_s_film_leave_the_faces_theirs(options):
    bearing = _bearing(**options)
    motion = 0.4 * SCALE[:10]
    assert build_model(bearing).bearing.thrust is not None
    assert np.array_equal(
        ThrustModel(bearing).evaluate(np.append(motion, 1e-5)).wrench,
        ThrustModel(_bearing()).evaluate(np.append(motion, 1e-5)).wrench,
    )


@pytest.mark.parametrize("name", CLOSURES)
def test_the_faces_own_cavitation_model(name):
    """Beside a bore of any model, films of the faces are those of a bearing whose bore has the faces' model too."""
    faces = _faces(profile=PADS, cavitation=ehd.Gumbel(cavity_pressure=-1e4))
    bearing, alike = _bearing(faces, cavitation=CLOSURES[name]), _bearing(faces, cavitation=faces.cavitation)
    motion = 0.4 * SCALE
    assert np.array_equal(ThrustModel(bearing).evaluate(motion).wrench, ThrustModel(alike).evaluate(motion).wrench)
    at = {"speed": 300.0, "eccentricity_ratio": 0.6, "axial_position": 1e-5}
    film, bare = (
        ehd.steady(bearing, **at),
        ehd.steady(dataclasses.replace(bearing, thrust=None), **at | {"axial_position": 0.0}),
    )
    assert np.array_equal(film.pressure, bare.pressure)
    assert film.faces.axial_force == ehd.steady(alike, **at).faces.axial_force


def test_refused():
    for options, names in (
        ({"cavitation": ehd.ElrodAdams()}, "does not go with ElrodAdams"),
        ({"faces": _faces(cavitation=ehd.ElrodAdams())}, "does not go with ElrodAdams"),
        ({"faces": _faces(inner_radius=0.024)}, "inner_radius must be at least"),
        (
            {"cavitation": ehd.Gumbel(cavity_pressure=-1e3), "faces": _faces(outer_pressures=(-2e3, 0.0))},
            "cavity_pressure",
        ),
        ({"film": ehd.ImpedanceMap()}, "thrust must be None"),
        ({"lubricant": {"shear_law": ByGapAndSpeed()}}, "by the gap and the sliding speed of a bore"),
    ):
        with pytest.raises(ehd.InputError, match=names):
            _bearing(**options)
