"""Supply areas behind restrictors on flexible bores and journals, and fed from a sump: an independent search for their
pressures, forces, limits, and small motions.

Their tangents are in tests/joint/tangent: test_bore, test_bore_traction.
"""

import dataclasses
import math

import numpy as np
import pytest
import scipy

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.static.dynamic_stiffness import FilmResponse
from tests.sampling import sample

RADIUS, LENGTH, CLEARANCE, SUPPLY, SPEED = 0.03, 0.06, 30e-6, 6e6, 60.0
MESH = ehd.HollowCylinder(inner_radius=RADIUS, thickness=0.01, length=LENGTH, axial=2, radial=1, circumferential=16)


def plastic(youngs_modulus=3e9):
    return ehd.SaintVenantKirchhoff(youngs_modulus=youngs_modulus, poisson_ratio=0.35, density=1400.0)


def surfaces(youngs_modulus=3e9):
    material = plastic(youngs_modulus)
    pin = ehd.ElasticJournal(material=material, span=(-0.04, 0.04), held=ehd.HeldEnds(), tolerance=0.2)
    modes = ehd.ModalBush(mesh=MESH, material=material, tolerance=0.2)
    return {
        "modes": {"bush": modes},
        "mesh": {"bush": ehd.ANCFBush(mesh=MESH, material=material)},
        "journal": {"journal": pin},
        "both": {"bush": modes, "journal": pin},
    }


FEEDS = [
    ehd.Orifice(diameter=3.96e-4, supply_pressure=SUPPLY),
    ehd.Capillary(diameter=5.05e-4, length=0.08, supply_pressure=SUPPLY),
    ehd.GivenFlow(flow=8e-6),
]


def make_bearing(feeds=(FEEDS[0],) * 4, **options):
    supply = tuple(
        ehd.Pocket(angle=0.1 + 0.5 * math.pi * k, width_angle=1.1, length=0.04, supply=feed)
        for k, feed in enumerate(feeds)
    )
    given = {
        "journal_radius": RADIUS,
        "length": LENGTH,
        "radial_clearance": CLEARANCE,
        "lubricant": ehd.Lubricant(viscosity=0.008, density=860.0),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
        "supply": supply,
    }
    return ehd.JournalBearing(**(given | options))


def with_pressures(bearing, pressures):
    """The bearing with given pressures of its areas."""
    supply = (dataclasses.replace(a, supply=None, pressure=p) for a, p in zip(bearing.supply, pressures, strict=True))
    return dataclasses.replace(bearing, supply=tuple(supply))


@pytest.mark.parametrize("closure", sample([ehd.SwiftStieber(), ehd.FullSommerfeld(), ehd.ElrodAdams()], 0), ids=repr)
@pytest.mark.parametrize("name", ["modes", "mesh", "journal", "both"])
def test_pressures_are_those_at_which_given_pressures_have_the_flows_of_the_restrictors(name, closure):
    bearing = make_bearing((*FEEDS, FEEDS[0]), cavitation=closure, **surfaces()[name])
    at = {"speed": SPEED, "eccentricity_ratio": 0.6, "direction": 1.0}
    found = ehd.steady(bearing, **at)
    viscosity, density = bearing.lubricant.viscosity, bearing.lubricant.density

    def lack(scaled):
        pressures = SUPPLY * scaled
        film = ehd.steady(with_pressures(bearing, pressures), **at)
        orifice = 0.6 * 0.25 * math.pi * FEEDS[0].diameter ** 2
        drop = SUPPLY - pressures
        expected = orifice * np.sign(drop) * np.sqrt(2.0 * np.abs(drop) / density)
        expected[1] = math.pi * FEEDS[1].diameter ** 4 * drop[1] / (128.0 * viscosity * FEEDS[1].length)
        expected[2] = FEEDS[2].flow
        return (film.supply_flows - expected) / FEEDS[2].flow

    solved = scipy.optimize.root(lack, np.full(4, 0.5), tol=1e-10)
    assert np.abs(lack(solved.x)).max() < 1e-7
    np.testing.assert_allclose(found.pocket_pressures, SUPPLY * solved.x, rtol=1e-6)
    again = ehd.steady(with_pressures(bearing, found.pocket_pressures), **at)
    np.testing.assert_allclose(again.force, found.force, rtol=0.0, atol=1e-7 * np.linalg.norm(found.force))


@pytest.mark.parametrize("name", ["modes", "mesh", "journal"])
def test_very_stiff_surfaces_are_rigid(name):
    load = (1000.0, -3000.0)
    rigid, stiff = (
        ehd.equilibrium(make_bearing(**options), speed=SPEED, load=load) for options in ({}, surfaces(1e16)[name])
    )
    np.testing.assert_allclose(stiff.position, rigid.position, rtol=0.0, atol=1e-5 * CLEARANCE)
    np.testing.assert_allclose(stiff.film.pocket_pressures, rigid.film.pocket_pressures, rtol=1e-5)
    for ours, theirs in ((stiff.stiffness, rigid.stiffness), (stiff.damping, rigid.damping)):
        np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-4 * np.abs(theirs).max())


@pytest.mark.parametrize("name", ["modes", "mesh", "journal"])
def test_stiffness_is_the_derivative_of_the_force(name):
    bearing = make_bearing(**surfaces()[name])
    rest = ehd.equilibrium(bearing, speed=SPEED, load=(1000.0, -3000.0))

    def force(position):
        angle = math.atan2(position[1], position[0])
        ratio = math.hypot(*position) / CLEARANCE
        return ehd.steady(bearing, speed=SPEED, eccentricity_ratio=ratio, direction=angle).force[:2]

    steps = 1e-3 * CLEARANCE * np.eye(2)
    numeric = np.stack(
        [(force(rest.position - d) - force(rest.position + d)) / 2e-3 / CLEARANCE for d in steps], axis=1
    )
    np.testing.assert_allclose(rest.stiffness, numeric, rtol=0.0, atol=1e-4 * np.abs(numeric).max())


def test_forces_of_areas_balance_on_journal_and_mesh():
    model = build_model(make_bearing(**surfaces()["mesh"]))
    found = model.evaluate_steady(np.array([0.5 * CLEARANCE, -0.2 * CLEARANCE, 1e-4, 0, 0, 0, 0, 0, SPEED, 0]))
    nodal = found.forces_at(model.elasticity.solid.mesh.bore.positions)
    total = np.concatenate((nodal.sum(axis=0), np.cross(model.elasticity.solid.mesh.bore.positions, nodal).sum(axis=0)))
    np.testing.assert_allclose(total, -found.wrench, rtol=0.0, atol=1e-12 * np.abs(nodal).sum())
    # without what is spread: the film's own forces, areas included
    own = found.nodal_forces()
    np.testing.assert_allclose(own.sum(axis=0)[:2], -found.wrench[:2], rtol=0.0, atol=2e-3 * np.abs(found.wrench).max())


@pytest.mark.parametrize("name", ["modes", "mesh", "journal"])
def test_small_motions_with_compressible_oil_in_the_areas(name, monkeypatch):
    """Z against the steady film's K, K and C of slow motions, and at given pressures; fewer coordinates of the bore."""
    feed = dataclasses.replace(FEEDS[0], compressible_volume=2e-5, bulk_modulus=1e9)
    made = {key: make_bearing((part,) * 4, **surfaces()[name]) for key, part in (("soft", feed), ("stiff", FEEDS[0]))}
    rest = {key: ehd.equilibrium(part, speed=SPEED, load=(1000.0, -3000.0)) for key, part in made.items()}
    np.testing.assert_allclose(rest["soft"].position, rest["stiff"].position, rtol=1e-8)
    np.testing.assert_allclose(rest["soft"].stiffness, rest["stiff"].stiffness, rtol=1e-6)
    rates = rest["soft"].response.rates
    slow = 1e-4 * rates.min()
    (Z,) = rest["soft"].dynamic_stiffness([slow])
    np.testing.assert_allclose(Z.real, rest["soft"].stiffness, rtol=0.0, atol=1e-6 * np.abs(Z).max())
    C = rest["soft"].damping
    np.testing.assert_allclose(Z.imag / slow, C, rtol=0.0, atol=1e-5 * np.abs(C).max())
    # quick motions leave the oil in the areas no time: given pressures
    held = ehd.equilibrium(
        with_pressures(made["soft"], rest["soft"].film.pocket_pressures), speed=SPEED, load=(1000.0, -3000.0)
    )
    between, quick = np.geomspace(0.1 * rates.min(), 10.0 * rates.max(), 5), 1e5 * rates.max()
    reduced = rest["soft"].dynamic_stiffness(between)
    monkeypatch.setattr(FilmResponse, "_reduce", lambda self, found: None)
    whole = [ehd.equilibrium(made["soft"], speed=SPEED, load=(1000.0, -3000.0)), held]
    np.testing.assert_allclose(
        reduced, whole[0].dynamic_stiffness(between), rtol=0.0, atol=1e-5 * np.abs(reduced).max()
    )
    if name == "mesh":  # shear and axial forces on its nodes are those of slow motions
        return
    ours, theirs = (part.dynamic_stiffness([quick])[0] for part in whole)
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-3 * np.abs(theirs).max())


@pytest.mark.parametrize("kind", [ehd.LumpedThermal, ehd.FilmEnergy])
def test_a_sump_that_feeds_restrictors_has_the_temperature_of_its_heat(kind):
    """A supply of the temperature that was found makes the same film; steps of one temperature end there."""
    sump = ehd.Sump(conductance=30.0, ambient=300.0)
    feeds = (FEEDS[0], FEEDS[2]) * 2
    made = make_bearing(feeds, lubricant=ehd.oil("ISO VG 32"), thermal=kind(supply_temperature=sump))
    at = {"speed": 5.0 * SPEED, "eccentricity_ratio": 0.5, "direction": 1.0}
    found = ehd.steady(made, **at)
    assert found.supply_temperature == pytest.approx(300.0 + found.heat_by_oil / 30.0, rel=1e-8)
    assert found.supply_temperature > 301.0
    known = dataclasses.replace(made, thermal=kind(supply_temperature=found.supply_temperature))
    same = ehd.steady(known, **at)
    np.testing.assert_allclose(same.pocket_pressures, found.pocket_pressures, rtol=1e-7)
    np.testing.assert_allclose(same.temperature, found.temperature, rtol=1e-8)
    if kind is ehd.FilmEnergy:
        return
    model = build_model(made)
    motion = np.array([0.5 * CLEARANCE * np.cos(1.0), 0.5 * CLEARANCE * np.sin(1.0), *[0.0] * 6, 5.0 * SPEED, 0.0])
    history = model.initial_history(motion)
    for _ in range(400):
        history = model.evaluate(motion, history, 1e-2).history()
    assert history.sump == pytest.approx(found.supply_temperature, abs=0.02)


def test_a_capillary_does_not_go_with_a_sump():
    sump = ehd.Sump(conductance=30.0, ambient=300.0)
    with pytest.raises(ehd.InputError, match=r"supply\[1\] with Capillary\(...\) does not go with .*Sump"):
        make_bearing(FEEDS, thermal=ehd.LumpedThermal(supply_temperature=sump))
