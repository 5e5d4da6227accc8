"""Supply areas are no lands: shear and contact against films of the lands alone, integrals and laws."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.supply.areas import axial_span, placed
from exudyn_ehd.film.surfaces.contact import WallContact
from exudyn_ehd.film.surfaces.roughness import AsperityContact
from exudyn_ehd.joint.heat.power import heat_and_exchange, heat_of
from exudyn_ehd.joint.model.build import build_model

R, L, C, MU = 0.04, 0.05, 40e-6, 0.012
OIL = ehd.Lubricant(viscosity=MU)
HOT = ehd.Lubricant(temperature_law=ehd.ReynoldsTemperature(point=(325.0, MU), coefficient=0.03), temperature=325.0)
ASPERITY = ehd.GreenwoodTripp(composite_roughness=2e-6, composite_modulus=2e11)
WALL = ehd.RegularisedWall(onset=4e-6)


def bearing(**options):
    plain = {"journal_radius": R, "length": L, "radial_clearance": C, "lubricant": OIL}
    return ehd.JournalBearing(**(plain | options))


EFFECTS = {
    "plain": {},
    "elrod": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "asperity": {"asperity": ASPERITY},
    "wall": {"contact": WALL},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=2e-6)},
    "turbulent": {"turbulence": ehd.Hirs(onset=20.0, full=60.0)},
    "thinning": {
        "lubricant": ehd.Lubricant(viscosity=MU, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7))
    },
}


@pytest.mark.parametrize("effect", EFFECTS)
def test_a_groove_takes_no_more_than_the_lands_that_it_makes(effect, measured):
    """Loss, torque and contact of any width and eccentricity; the lands' films have more rows than the groove's."""
    rng = np.random.default_rng(1)
    for _ in range(4):
        width, eps, options = L * rng.uniform(0.02, 0.5), rng.uniform(0.0, 0.97), EFFECTS[effect]
        groove = ehd.CircumferentialGroove(width=width, pressure=1e5)
        state = {"speed": 200.0, "eccentricity_ratio": eps}
        one = ehd.steady(bearing(supply=(groove,), **options), **state)
        two = ehd.steady(bearing(length=0.5 * (L - width), end_pressures=(0.0, 1e5), **options), **state)
        # rows at cavities of ElrodAdams lie elsewhere
        limit = 0.004 if effect == "elrod" else 0.002
        for name in ("power_loss", "friction_torque"):
            ratio = getattr(one, name) / (2.0 * getattr(two, name))
            measured(f"{name}, groove of {width:.3g} m, eccentricity {eps:.2f}", abs(ratio - 1.0), limit)
        if two.contact_load > 1.0:
            measured("contact", abs(one.contact_load / (2.0 * two.contact_load) - 1.0), 0.005)


def test_lands_of_grooves_have_the_weights_of_bearings_of_their_own():
    rng = np.random.default_rng(4)
    for _ in range(20):
        width, z = L * rng.uniform(0.02, 0.5), L * rng.uniform(-0.2, 0.2)
        groove = ehd.CircumferentialGroove(width=width, z=z)
        grid = build_model(bearing(supply=(groove,))).grid
        # both end on a row
        low, high = (int(np.argmin(np.abs(grid.z * R - edge))) for edge in (z - 0.5 * width, z + 0.5 * width))
        assert np.all(np.abs(grid.lands[:, low + 1 : high]) < 1e-15)
        for rows, length in (
            (slice(low + 1), z - 0.5 * width + 0.5 * L),
            (slice(high, None), 0.5 * L - z - 0.5 * width),
        ):
            weights = grid.lands[0, rows] / grid.width_x[0]
            land = build_model(bearing(length=length, film=ehd.FiniteLength(n_z=weights.size - 1))).grid
            np.testing.assert_allclose(weights, land.weight_z, rtol=1e-9)


def draw(rng, kind, depth=None):
    """A random area of a kind, in the housing or the journal."""
    rotating, angle, at = bool(rng.integers(2)), rng.uniform(0.0, 2.0 * math.pi), {"depth": depth, "pressure": 1e5}
    z = L * rng.uniform(-0.2, 0.2)
    if kind == "axial":
        length = None if rng.integers(2) else L * rng.uniform(0.2, 0.95)
        return ehd.AxialGroove(angle=angle, width_angle=rng.uniform(0.1, 1.0), length=length, rotating=rotating, **at)
    if kind == "pocket":
        length = L * rng.uniform(0.1, 0.6)
        return ehd.Pocket(angle=angle, width_angle=rng.uniform(0.1, 2.0), length=length, z=z, rotating=rotating, **at)
    if kind == "hole":
        diameter = L * rng.uniform(0.15 if rotating else 0.01, 0.5)
        return ehd.Hole(angle=angle, diameter=diameter, z=z, rotating=rotating, **at)
    return ehd.CircumferentialGroove(width=L * rng.uniform(0.03, 0.4), z=z, **at)


def size(area):
    """Its surface, m2."""
    if isinstance(area, ehd.Hole):
        return 0.25 * math.pi * area.diameter**2
    (area,) = placed((area,), L)
    if isinstance(area, ehd.CircumferentialGroove):
        return 2.0 * math.pi * R * area.width
    return R * area.width_angle * area.length


def motion(rng, speed=100.0):
    eps, (angle, leaning) = rng.uniform(0.0, 0.9), rng.uniform(0.0, 2.0 * math.pi, 2)
    tilt = rng.uniform(0.0, 0.5) * (1.0 - eps) * C / (0.5 * L)
    place = eps * C * math.cos(angle), eps * C * math.sin(angle)
    return np.array([*place, tilt * math.cos(leaning), tilt * math.sin(leaning), 0, 0, 0, 0, speed, 0.0])


# Of an area's size: round-off, and what 128 chords make of control volumes inside a hole.
RELATIVE = {"axial": 1e-9, "pocket": 1e-9, "circumferential": 1e-9, "hole": 3e-4}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def inverse_gap(at, theta, z):
    return 1.0 / (1.0 - ((at[0] + z * at[2]) * np.cos(theta) + (at[1] + z * at[3]) * np.sin(theta)) / C)


def over_rectangle(at, low, high, bottom, top):
    """Integral of c / h over theta and z / R, by Gauss and Legendre on eight parts in theta."""
    z = 0.5 * (bottom + top + (top - bottom) * NODES)
    edges = np.linspace(low, high, 9)
    thetas = (0.5 * (a + b + (b - a) * NODES) for a, b in itertools.pairwise(edges))
    scale = 0.25 * (high - low) / 8.0 * (top - bottom) / R
    return scale * sum(WEIGHTS @ inverse_gap(at, theta[:, None], z) @ WEIGHTS for theta in thetas)


def over_area(at, area, spin):
    """Integral of c / h over an area; over a disc in polar coordinates."""
    center = getattr(area, "angle", 0.0) + (spin if area.rotating else 0.0)
    if isinstance(area, ehd.Hole):
        r, phi = 0.25 * area.diameter * (1.0 + NODES[:, None]), 2.0 * math.pi * np.arange(200) / 200
        values = r * inverse_gap(at, center + r * np.cos(phi) / R, area.z + r * np.sin(phi))
        return float(WEIGHTS @ values.sum(axis=1)) * 0.25 * area.diameter * 2.0 * math.pi / 200 / R**2
    half = math.pi if isinstance(area, ehd.CircumferentialGroove) else 0.5 * area.width_angle
    return over_rectangle(at, center - half, center + half, *axial_span(*placed((area,), L)))


@pytest.mark.parametrize("kind", ["axial", "pocket", "hole", "circumferential"])
@pytest.mark.parametrize("count", [6, pytest.param(100, marks=pytest.mark.slow)])
def test_shear_is_integrated_over_the_lands(kind, count, measured):
    """Against quadrature of the whole surface less that of the area, on the default grid."""
    rng = np.random.default_rng(7)
    for _ in range(count):
        area, at, spin = draw(rng, kind), motion(rng), rng.uniform(0.0, 6.0)
        model = build_model(bearing(supply=(area,), cavitation=ehd.FullSommerfeld()))
        film = model.evaluate(at, spin=spin).film
        lands = over_rectangle(at, 0.0, 2.0 * math.pi, -0.5 * L, 0.5 * L) - over_area(at, area, spin)
        # films as thin as a twentieth of the clearance at an end, where the grid without an area is as far off
        measured(f"{area}", abs(film.loads.couette / lands - 1.0), 0.002)
        parts, g = model.parts.supply.parts[0], model.grid
        assert parts.sum() * R**2 == pytest.approx(size(area), rel=RELATIVE[kind])
        assert g.lands.sum() + parts.sum() == pytest.approx(g.weight.sum(), rel=1e-12)
        assert kind == "hole" or g.lands.min() > -1e-12


@pytest.mark.parametrize("kind", ["axial", "pocket", "hole"])
def test_shear_of_turning_areas_has_no_steps(kind):
    """Over two columns in 200 spins: no more than what their edges sweep, a hundredth of a column."""
    area, at = (
        dataclasses.replace(draw(np.random.default_rng(2), kind), rotating=True),
        motion(np.random.default_rng(3)),
    )
    model = build_model(bearing(supply=(area,), cavitation=ehd.FullSommerfeld()))
    step = 2.0 * math.pi / model.grid.x.size / 100
    found = [model.evaluate(at, spin=k * step).film for k in range(200)]
    swept = step * L / R / found[0].solver.H.min()
    assert np.abs(np.diff([film.loads.couette for film in found])).max() < 1.01 * swept


@pytest.mark.parametrize("kind", ["axial", "pocket", "hole", "circumferential"])
def test_recesses_are_sheared_by_their_depth(kind):
    """Loss, torque and heat grow by the power of 4 mu U / d, or of Hirs' turbulent stress where that is larger."""
    rng = np.random.default_rng(3)
    for _ in range(4):
        area, depth = draw(rng, kind), C * 10.0 ** rng.uniform(1.0, 3.0)
        where, spin = motion(rng, rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(0.0, 3.5)), rng.uniform(0.0, 6.0)
        models = [build_model(bearing(supply=(dataclasses.replace(area, depth=d),))) for d in (None, depth)]
        deep, shallow = (m.evaluate(where, spin=spin) for m in models)
        U = abs(where[8]) * R
        reynolds = OIL.density * U * depth / MU
        stress = max(4.0 * MU * U / depth, 0.033 * OIL.density * U**2 * reynolds**-0.25)
        assert (reynolds < (4.0 / 0.033) ** (4.0 / 3.0)) is (stress == 4.0 * MU * U / depth)
        torque = -math.copysign(stress * size(area) * R, where[8])
        rel = {"rel": RELATIVE[kind]}
        a, b = deep.quantities(), shallow.quantities()
        near = {"abs": 1e-11 * abs(b["power_loss"])} | rel
        assert b["friction_torque"] - a["friction_torque"] == pytest.approx(torque, abs=1e-11 * abs(torque), **rel)
        assert shallow.wrench[5] - deep.wrench[5] == pytest.approx(torque, **rel)
        assert shallow.wrench[:5] == pytest.approx(deep.wrench[:5], rel=1e-12, abs=1e-12 * abs(deep.wrench[:5]).max())
        assert b["power_loss"] - a["power_loss"] == pytest.approx(torque * -where[8], **near)
        heats = [heat_and_exchange(e.film, 1.0)[0] for e in (deep, shallow)]
        assert heats[1] - heats[0] == pytest.approx(torque * -where[8], **near)


@pytest.mark.parametrize("thermal", [ehd.LumpedThermal, ehd.FilmEnergy])
def test_heat_of_recesses_has_the_viscosity_of_their_temperature(thermal):
    """The heat in a film's temperature balance grows by as much as its power loss."""
    effect, where = thermal(supply_temperature=325.0), motion(np.random.default_rng(2), 300.0)
    found = []
    for depth in (None, 5e-4):
        pocket = ehd.Pocket(angle=1.0, width_angle=1.0, length=0.03, pressure=1e6, depth=depth)
        model = build_model(bearing(lubricant=HOT, supply=(pocket,), thermal=effect))
        history = dataclasses.replace(
            model.initial_history(where), temperature=model.initial_history(where).temperature + 10.0
        )
        evaluation = model.evaluate(where, history, 0.0)
        film = evaluation.film
        heat = heat_of(film).sum() if thermal is ehd.FilmEnergy else heat_and_exchange(film, 1.0)[0]
        found.append((evaluation.quantities()["power_loss"], heat))
    (loss, heat), (more_loss, more_heat) = found
    expected = 4.0 * MU * math.exp(-0.3) * (300.0 * R) ** 2 / 5e-4 * R * 0.03
    assert more_loss - loss == pytest.approx(expected, rel=1e-9)
    assert more_heat - heat == pytest.approx(expected, rel=1e-9)
    # the field's sum over control volumes: to the grid's error
    assert heat == pytest.approx(loss + heat_and_exchange(film, 1.0)[0] - more_loss, rel=0.01)


@pytest.mark.parametrize("law", [AsperityContact(ASPERITY, C), WallContact(WALL, C)], ids=["asperity", "wall"])
def test_contacts_press_on_the_land_alone(law):
    rng = np.random.default_rng(5)
    gap, land = rng.uniform(-0.05, 0.3, (12, 7)), rng.uniform(0.0, 1.0, (12, 7))
    land[:3], land[3:6] = 0.0, 1.0
    contact = law.on_land(land)
    P, slope, plain, plain_slope = np.zeros((4, 12, 7))
    contact.pressure(gap, P, slope)
    law.pressure(gap, plain, plain_slope)
    assert np.array_equal(P, land * plain) and np.array_equal(slope, land * plain_slope)
    # on a liner the land deflects under the whole pressure
    scale, compliance = 1e7, 0.02
    G, own = gap.copy(), gap.copy()
    contact.solve_gap(gap, compliance, scale, G, P, slope)
    law.solve_gap(gap, compliance, scale, own, plain, plain_slope)
    assert np.array_equal(G[:3], gap[:3]) and not P[:3].any() and not slope[:3].any()
    assert np.array_equal(G[3:], own[3:]) and np.array_equal(slope[3:], plain_slope[3:])
    assert np.array_equal(P, land * plain)


@pytest.mark.parametrize("liner", [None, ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)], ids=["rigid", "liner"])
@pytest.mark.parametrize("contact", [{"asperity": ASPERITY}, {"contact": WALL}], ids=["asperity", "wall"])
def test_tangent_where_contacts_meet_the_edge_of_a_recess(liner, contact):
    """Against differences of second order, with edges between columns and rows under the contact."""
    pocket = ehd.Pocket(angle=0.1, z=0.002, width_angle=0.4, length=0.02, pressure=1e6, depth=3e-4)
    model = build_model(bearing(supply=(pocket,), cavitation=ehd.FullSommerfeld(), bush=liner, **contact))
    where = np.array([0.97 * C, 0.1 * C, 1e-5, -2e-5, 1e-4, -2e-4, 1e-3, 2e-3, 150.0, 0.1])
    unit = np.array([C, C, C / L, C / L, 1e-3, 1e-3, 0.02, 0.02, 100.0, 1.0])
    evaluation = model.evaluate(where)
    assert evaluation.quantities()["contact_load"] > 10.0
    tangent, force = evaluation.tangent() * unit, np.abs(evaluation.wrench)
    for k in range(10):
        ends = [model.evaluate(where + sign * 1e-5 * unit * (np.arange(10) == k)).wrench for sign in (1.0, -1.0)]
        numeric = (ends[0] - ends[1]) / 2e-5
        scale = np.abs(tangent).max(axis=1) + force
        assert np.all(np.abs(numeric - tangent[:, k]) < 1e-5 * scale), k


def test_wear_leaves_areas_alone():
    pocket = ehd.Pocket(angle=0.0, width_angle=0.6, length=0.02, pressure=1e5)
    made = bearing(asperity=ASPERITY, wear=ehd.ArchardWear(wear_rate=1e-15), supply=(pocket,))
    model = build_model(made)
    where = np.zeros(10)
    where[0], where[8] = 0.97 * C, 100.0
    evaluation = model.evaluate(where, model.initial_history(where), 1.0)
    depth, land = evaluation.history().wear, model.parts.supply.land
    assert not depth[land == 0.0].any() and depth[land == 1.0].max() > 0.0


@pytest.mark.parametrize("depth", [-1e-3, 0.0, math.nan, "deep", 3.9 * C])
def test_refused_depths(depth):
    with pytest.raises(ehd.InputError, match="depth"):
        bearing(supply=(ehd.Hole(angle=0.0, diameter=0.01, depth=depth),))
