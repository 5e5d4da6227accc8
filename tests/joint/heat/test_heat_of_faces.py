"""Heat of films on end faces: in the balance of one temperature, and behind a temperature field."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.thrust.face import FaceFilm
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.thrust import ThrustModel

OIL, SPEED, COLD = ehd.oil("ISO VG 46"), 300.0, 313.15
LUMPED = ehd.LumpedThermal(supply_temperature=COLD, housing_conductance=5.0)
FIELD = ehd.FilmEnergy(supply_temperature=COLD)
PADS = ehd.TaperLand(pads=6, depth=30e-6)


def _bearing(thermal=LUMPED, profile=PADS, oil=OIL, cavitation=None, ends=(0.0, 0.0), **options):
    faces = {"inner_radius": 0.026, "outer_radius": 0.045, "clearance": 40e-6, "profile": profile}
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.03,
        radial_clearance=40e-6,
        lubricant=oil,
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        cavitation=cavitation or ehd.SwiftStieber(),
        end_pressures=ends,
        thrust=ehd.ThrustFaces(**faces | {"n_theta": 96, "n_r": 8} | options),
        thermal=thermal,
    )


def _steady(bearing, **options):
    return ehd.steady(bearing, **{"speed": SPEED, "eccentricity_ratio": 0.6, "tilt": (1e-4, -2e-4)} | options)


def _heat_capacity(oil=OIL):
    return oil.density * oil.specific_heat


@pytest.mark.parametrize("closure", (ehd.SwiftStieber(), ehd.FullSommerfeld(), ehd.Gumbel()), ids=repr)
@pytest.mark.parametrize("profile", (None, PADS))
def test_power_of_all_films_is_the_heat_that_leaves(closure, profile):
    """Power = heat carried by the oil + heat to the housing; the films have the viscosity of the one temperature."""
    film = _steady(_bearing(profile=profile, cavitation=closure), axial_position=8e-6)
    power = film.power_loss + film.faces.power_loss
    assert film.faces.power_loss > film.power_loss
    assert film.heat_by_oil + film.heat_to_walls == pytest.approx(power, rel=1e-8)
    assert film.heat_to_walls == pytest.approx(5.0 * (film.temperature - COLD), rel=1e-9)
    alone = _bearing(None, profile, OIL.at(film.temperature), closure)
    known = _steady(alone, axial_position=8e-6)
    for found, expected in ((film.faces, known.faces), (film, known)):
        assert found.force == pytest.approx(expected.force, rel=1e-7, abs=1e-6)
        assert found.power_loss == pytest.approx(expected.power_loss, rel=1e-7)


def test_oil_that_carries_the_heat():
    """Fed plane faces take in pi h^3 p / (6 mu ln) each, the leakage of the bore first: the rest is fresh."""
    shares = []
    for p in (2e4, 5e6):
        bearing = _bearing(profile=None, cavitation=ehd.FullSommerfeld(), inner_pressures=(p, p))
        film = _steady(bearing, tilt=(0.0, 0.0))
        mu = OIL.at(film.temperature).viscosity
        into = math.pi * 40e-6**3 * p / (6 * mu * math.log(45 / 26))
        assert film.faces.inflow == pytest.approx([into, into], rel=1e-6)
        # without a cavity the oil that passes the bore leaves it at both ends alike
        fresh = 2.0 * max(into - 0.5 * film.oil_flow, 0.0)
        shares.append(fresh / film.oil_flow)
        carried = _heat_capacity() * (film.temperature - COLD) * (film.oil_flow + fresh)
        assert film.heat_by_oil == pytest.approx(carried, rel=1e-6)
        # the pressure's work on the oil becomes heat in the faces
        pumped = p * film.faces.inflow.sum()
        power = film.power_loss + film.faces.power_loss + pumped
        assert film.heat_by_oil + film.heat_to_walls == pytest.approx(power, rel=1e-8)
    assert shares[0] == 0.0 and shares[1] > 0.5


def test_heat_of_a_face_between_pressures():
    """`FaceFilm.heat`: shear and pressure flow by differences of the field, to 1.5 %, also with a cavity pressure."""
    rng = np.random.default_rng(4)
    faces = ehd.ThrustFaces(inner_radius=0.025, outer_radius=0.05, clearance=40e-6, n_theta=128, n_r=16)
    for closure in (ehd.FullSommerfeld(), ehd.SwiftStieber(cavity_pressure=-4e6)):
        film = FaceFilm(faces, 1, closure, ehd.Lubricant(viscosity=0.03), (2e6, 5e5))
        scale = np.array([20e-6, 3e-4, 3e-4, 1e-3, 0.02, 0.02, 300.0, 0.01, 0.01])
        motion = rng.uniform(-0.5, 1.0, 9) * scale
        assert film.evaluate(motion).status is ehd.Status.CONVERGED
        a, p, h, (*_, omega, ux, uy) = film.annulus, film.pressure, film.gap, motion
        assert closure.cavity_pressure < p.min() < 0.0 or p.min() >= 0.0
        r, (_, x, y) = a.scale * a.r, a.scale * a.moments
        shear = 0.03 * ((ux - omega * y) ** 2 + (uy + omega * x) ** 2) / h
        around = np.gradient(np.vstack((p[-1:], p, p[:1])), 2 * math.pi / 128, axis=0)[1:-1]
        outward = np.gradient(p, a.grid.z, axis=1)
        flow = h**3 / (12 * 0.03) * (around**2 + outward**2) / r**2
        heat = ((shear + flow) * a.weight).sum() * a.scale**2
        assert film.heat()[0] == pytest.approx(heat, rel=0.015)


def test_a_temperature_field_hands_its_oil_to_the_faces():
    """Each face has the mean temperature of what leaves the bore there, by the flow; the field does not change."""
    film = _steady(_bearing(FIELD))
    alone = _steady(dataclasses.replace(_bearing(FIELD), thrust=None))
    assert np.array_equal(film.temperature, alone.temperature) and film.heat_by_oil == alone.heat_by_oil
    model = ThrustModel(_bearing(None))
    for face, (end, beside), force in zip(model.faces, ((0, 1), (-1, -2)), film.faces.pressure.sum(axis=(1, 2))):
        flow = np.maximum(film.gap[:, end] ** 3 * film.pressure[:, beside], 0.0)
        T = float(np.average(film.temperature[:, end], weights=flow))
        assert T > COLD + 3.0
        ratio = OIL.at(T).viscosity / OIL.viscosity
        found = face.evaluate(np.array([0, 1e-4, -2e-4, 0, 0, 0, SPEED, 0, 0]), ratio)
        assert found.status is ehd.Status.CONVERGED
        # the flow over the half control volume at the end is not in this mean: 1 K, 3 %
        assert face.pressure.sum() == pytest.approx(force, rel=0.03)


# fields on few columns settle less than one temperature
@pytest.mark.parametrize(("thermal", "error"), ((LUMPED, 1e-6), (FIELD, 1e-3)), ids=("lumped", "field"))
def test_steps_lead_to_the_steady_temperature(thermal, error):
    """A motion that lasts, step by step as joints take them, ends at the film of `steady`, faces too."""
    bearing = _bearing(thermal)
    model, faces = build_model(bearing), ThrustModel(bearing)
    motion = np.array([0.6 * 40e-6, 0, 1e-4, -2e-4, 0, 0, 0, 0, SPEED, 0])
    place, history = np.append(motion, 0.0), model.initial_history(motion)
    first = faces.evaluate(place, history)
    # at last steps in which the oil passes less than a column, whose transport along theta is that of steady films
    for step in (*[0.02] * 60, *[2.0 * np.pi / SPEED / 64] * 300):
        evaluation, beside = model.evaluate(motion, history, step), faces.evaluate(place, history)
        evaluation.heat_with(beside.heat)
        history = evaluation.history()
    known = _steady(bearing)
    assert history.temperature == pytest.approx(known.temperature, rel=error)
    whole = np.append(known.faces.force, known.faces.moment)
    assert beside.wrench[[2, 5]] == pytest.approx(whole[[2, 5]], rel=20 * error, abs=1e-6)
    assert first.quantities()["thrust_power_loss"] > 1.05 * beside.quantities()["thrust_power_loss"]


def test_oil_between_collars_warms_up_too():
    """dT/dt of a cold start is the power of all films over the heat capacity of all of their oil, and of the metal."""
    bearing = _bearing(dataclasses.replace(LUMPED, capacity=0.3))
    model, faces, step = build_model(bearing), ThrustModel(bearing), 1e-8
    motion = np.array([0.6 * 40e-6, 0, 0, 0, 0, 0, 0, 0, SPEED, 0])
    history = model.initial_history(motion)
    evaluation, beside = model.evaluate(motion, history, step), faces.evaluate(np.append(motion, 0.0), history)
    evaluation.heat_with(beside.heat)
    oil = 2 * math.pi * 0.025 * 0.03 * 40e-6 + 2 * math.pi * (0.045**2 - 0.026**2) * 40e-6
    power = evaluation.quantities()["power_loss"] + beside.quantities()["thrust_power_loss"]
    rate = (evaluation.history().temperature - COLD) / step
    assert rate == pytest.approx(power / (_heat_capacity() * oil + 0.3), rel=1e-4)


@pytest.mark.parametrize("given", ({"axial_position": 5e-6}, {"axial_load": 800.0}))
def test_equilibrium(given):
    """Forces and heat balance together; K that the temperature follows is that of solved positions beside."""
    bearing, load = _bearing(), np.array([300.0, -2000.0])
    found = ehd.equilibrium(bearing, speed=SPEED, load=tuple(load), **given)
    film, faces = found.film, found.film.faces
    assert film.heat_by_oil + film.heat_to_walls == pytest.approx(film.power_loss + faces.power_loss, rel=1e-8)
    assert film.force[:2] + faces.force[:2] == pytest.approx(-load, abs=1e-6)
    if "axial_load" in given:
        assert faces.axial_force == pytest.approx(-800.0, rel=1e-8)
    step, forces = 1e-9, []
    for sign in (1, -1):
        x, y = found.position + sign * np.array([step, 0.0])
        there = ehd.steady(
            bearing,
            speed=SPEED,
            eccentricity_ratio=float(np.hypot(x, y)) / 40e-6,
            direction=math.atan2(y, x),
            axial_position=faces.axial_position,
        )
        forces.append((there.force + there.faces.force)[:2])
    K = -(forces[0] - forces[1]) / (2 * step)
    assert found.settled_stiffness[:, 0] == pytest.approx(K, rel=1e-3, abs=1e-3 * np.abs(K).max())
    assert np.abs(found.settled_stiffness - found.stiffness).max() > 1e-3 * np.abs(K).max()


def test_without_a_way_out_for_the_heat():
    """A concentric, aligned bearing between plane faces leaks nothing: one remedy is a conductance."""
    bearing = _bearing(ehd.LumpedThermal(supply_temperature=COLD), None, cavitation=ehd.FullSommerfeld())
    with pytest.raises(ehd.FilmError, match="no way out"):
        _steady(bearing, eccentricity_ratio=0.0, tilt=(0.0, 0.0))
