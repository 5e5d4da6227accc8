"""Faces that the journal's film feeds: closed form, films with prescribed edges, continuity, tangents."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.joint.feed.films import FedFilms
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.thrust import ThrustModel

MU, R, L, CJ, C, RI, RO = 0.03, 0.025, 0.04, 50e-6, 40e-6, 0.026, 0.05
SCALE = np.array([25e-6, 25e-6, 2e-4, 2e-4, 5e-3, 5e-3, 0.02, 0.02, 300.0, 2e-3, C])
GROOVE = ehd.CircumferentialGroove(width=8e-3, pressure=2e5)
PADS = ehd.TaperLand(pads=4, depth=30e-6)
WALL = ehd.RegularisedWall(onset=15e-6, pressure=1e7)


def _bearing(faces=None, **options):
    own = {"inner_radius": RI, "outer_radius": RO, "clearance": C, "n_theta": 48, "n_r": 6}
    given = {"film": ehd.FiniteLength(n_theta=48, n_z=6), "supply": (GROOVE,)} | options
    return ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=CJ,
        lubricant=ehd.Lubricant(viscosity=MU),
        thrust=ehd.ThrustFaces(**(own | {"feed": ehd.JournalLeakage()} | (faces or {}))),
        **given,
    )


def _films(bearing):
    return FedFilms(build_study_model(dataclasses.replace(bearing, thrust=None), 0.0), ThrustModel(bearing))


@pytest.mark.parametrize("pressure", (2e5, 3e6))
def test_two_resistances_in_series(pressure):
    """Land 12 mu l / (pi D c^3) and washer 6 mu ln(r_o / r_i) / (pi h^3) from the groove to the outer edges."""
    groove = dataclasses.replace(GROOVE, pressure=pressure)
    bearing = _bearing({"outer_pressures": (0.0, 2e4)}, supply=(groove,))
    film = ehd.steady(bearing, speed=0.0, eccentricity_ratio=0.0, axial_position=10e-6)
    land = 12 * MU * 0.5 * (L - GROOVE.width) / (math.pi * 2 * R * CJ**3)
    # the journal moved up: the lower gap closes
    washers = [6 * MU * math.log(RO / RI) / (math.pi * h**3) for h in (30e-6, 50e-6)]
    flows = [(pressure - outer) / (land + washer) for washer, outer in zip(washers, (0.0, 2e4), strict=True)]
    edges = [pressure - flow * land for flow in flows]
    # pressures linear in z and in ln r are exact on any grid
    assert film.faces.edge_pressures == pytest.approx(edges, rel=1e-11)
    for found in (film.faces.inflow, film.faces.outflow, film.faces.feed):
        assert found == pytest.approx(flows, rel=1e-11)
    assert (film.leakage, film.supply_flows.sum()) == pytest.approx((sum(flows), sum(flows)), rel=1e-11)


CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "swift": ehd.SwiftStieber(cavity_pressure=-2e4, cavity_shear=0.4, line_in_cells=False),
    "swift_in_cells": ehd.SwiftStieber(),
}
SCENES = {
    "plain": ({}, {}),
    "pads": ({"profile": PADS}, {"supply": (ehd.Hole(angle=1.0, z=0.012, diameter=4e-3, pressure=3e5),)}),
    "walls": ({"contact": WALL}, {"contact": WALL, "profile": ehd.Crown(drop=5e-6)}),
    "one face": ({"upper": False}, {"end_pressures": (0.0, 1e5)}),
    "short": ({}, {"film": ehd.ShortBearing(n_theta=48, n_z=6)}),
    "low pressures": ({"clearance": 2e-4}, {}),
}
FEW = [("swift_in_cells", scene) for scene in SCENES] + [("full", "walls"), ("swift", "low pressures")]
ALL = [
    pytest.param(name, scene, marks=[] if (name, scene) in FEW else pytest.mark.slow)
    for name in CLOSURES
    for scene in SCENES
]


def _states(rng, scene, count):
    size = np.array([1.6, 1.6, *[1.0] * 8, 1.1]) if scene == "walls" else 1.0
    return rng.uniform(-0.8, 0.8, (count, 11)) * SCALE * size


@pytest.mark.parametrize(("closure", "scene"), ALL)
def test_continuity_and_tangents(closure, scene):
    """In random states: flows are the same to 1e-9, and both tangents are central differences."""
    faces, options = SCENES[scene]
    films, rng = _films(_bearing(faces, cavitation=CLOSURES[closure], **options)), np.random.default_rng(5)
    balanced = limited = 0
    for state in _states(rng, scene, 3):
        found = films.evaluate(state[:10], state[10])
        assert found.settled
        b, limited = found.balanced, limited + (found.journal.film.limited is not None)
        balanced += b.sum()
        assert found.taken[b] == pytest.approx(found.given[b], rel=1e-9)
        assert np.all(found.taken[~b] >= found.given[~b])
        assert np.all(found.pressures[films.ends[~b]] == films.lowest[films.ends[~b]])
        assert found.journal.film.scales.ends * found.journal.film.scales.pressure == pytest.approx(found.pressures)
        added, faces = found.with_feed()
        tangents = [tangent * SCALE for tangent in (np.pad(found.journal.tangent(), ((0, 0), (0, 1))) + added, faces)]
        d = rng.normal(size=11)
        plus, minus = (films.evaluate(near[:10], near[10]) for near in (state + k * 1e-6 * d * SCALE for k in (1, -1)))
        for tangent, high, low in zip(
            tangents,
            (plus.journal.wrench, plus.wrench),
            (minus.journal.wrench, minus.wrench),
            strict=True,
        ):
            error = np.abs(tangent @ d - (high - low) / 2e-6)
            # truncation of central differences and rounding over 1e-6; by roots of small flows they bend more
            limit = 3e-6 if scene == "low pressures" else 1e-6
            assert np.all(error < limit * np.abs(tangent).max(axis=1))
    assert balanced
    assert limited or scene != "walls"


def test_prescribed_edges_give_the_same_films():
    """Bisection on a bearing whose edges have a given pressure, and its films at the one of equal flows."""
    bearing = _bearing({"lower": False}, cavitation=ehd.FullSommerfeld())
    state = {"speed": 250.0, "eccentricity_ratio": 0.5, "tilt": (1e-4, 0.0), "axial_position": 5e-6}
    found = ehd.steady(bearing, **state)

    def with_edge(pressure):
        faces = dataclasses.replace(bearing.thrust, feed=None, inner_pressures=(0.0, pressure))
        return dataclasses.replace(bearing, thrust=faces, end_pressures=(0.0, pressure))

    def missing(pressure):
        given = with_edge(pressure)
        journal = build_study_model(dataclasses.replace(given, thrust=None), 0.0).evaluate(found.motion)
        taken = ThrustModel(given).evaluate(found.motion, state["axial_position"]).states[0].inflow
        return taken - journal.quantities()["leakage_upper"]

    edge = float(found.faces.edge_pressures[0])
    assert edge == pytest.approx(brentq(missing, 0.0, 1e6, xtol=1e-4), abs=1e-3)
    known = ehd.steady(with_edge(edge), **state)
    assert known.force == pytest.approx(found.force, rel=1e-12)
    assert known.faces.force == pytest.approx(found.faces.force, rel=1e-12)
    assert known.leakage == pytest.approx(found.leakage, rel=1e-11)


def test_a_face_that_takes_more_than_the_film_gives():
    """Suction at the outer edge: the channel stays at the bearing's end pressure, and flows differ."""
    bearing = _bearing(
        {"outer_pressures": (0.0, -8e4), "clearance": 120e-6},
        end_pressures=(0.0, 1e4),
        cavitation=ehd.SwiftStieber(cavity_pressure=-1e5),
    )
    faces = ehd.steady(bearing, speed=0.0, eccentricity_ratio=0.0).faces
    assert faces.edge_pressures[1] == 1e4
    assert faces.feed[1] < 0.5 * faces.inflow[1]
    assert faces.edge_pressures[0] > 0.0
    assert faces.feed[0] == pytest.approx(faces.inflow[0], rel=1e-11)
    land = 12 * MU * 0.5 * (L - GROOVE.width) / (math.pi * 2 * R * CJ**3)
    assert faces.feed[1] == pytest.approx((2e5 - 1e4) / land, rel=1e-11)


def test_turned_frame():
    """By whole columns of both films: pressures and flows stay, forces and moments turn."""
    bearing, angle, load = _bearing(), 5 * 2 * math.pi / 48, np.array([300.0, -2000.0])
    c, s = math.cos(angle), math.sin(angle)
    turn, tilt = np.array([[c, -s], [s, c]]), np.array([1e-4, 2e-4])
    wall = dataclasses.replace(bearing.thrust, contact=WALL)
    bearing = dataclasses.replace(bearing, thrust=wall)
    first, second = (
        ehd.equilibrium(bearing, speed=200.0, load=tuple(q @ load), tilt=tuple(q @ tilt), axial_position=8e-6)
        for q in (np.eye(2), turn)
    )
    assert second.position == pytest.approx(turn @ first.position, abs=1e-9 * CJ)
    assert second.stiffness == pytest.approx(turn @ first.stiffness @ turn.T, abs=1e-6 * np.abs(first.stiffness).max())
    one, two = first.film.faces, second.film.faces
    assert two.edge_pressures == pytest.approx(one.edge_pressures, rel=1e-8)
    assert two.feed == pytest.approx(one.feed, abs=1e-8 * np.abs(one.feed).max())
    assert two.moment[:2] == pytest.approx(turn @ one.moment[:2], abs=1e-8 * np.abs(one.moment).max())


def _whole_force(bearing, motion, position):
    found = _films(bearing).evaluate(motion, position)
    return found.journal.wrench[:3] + found.wrench[:3]


@pytest.mark.parametrize("given", ({"axial_position": -12e-6}, {"axial_load": 2500.0}))
def test_equilibrium(given):
    """Forces of both films balance; K and C are differences in which the edges' pressures follow."""
    bearing, load, tilt = _bearing({"profile": PADS}), (300.0, -2000.0), (2e-4, -1e-4)
    found = ehd.equilibrium(bearing, speed=200.0, load=load, tilt=tilt, **given)
    place = found.film.faces.axial_position
    motion = np.array([*found.position, *tilt, 0, 0, 0, 0, 200.0, 0])
    force = _whole_force(bearing, motion, place)
    assert force[:2] == pytest.approx(-np.array(load), abs=2e-7)
    assert found.film.force + found.film.faces.force == pytest.approx(force, abs=2e-7)
    if "axial_load" in given:
        assert force[2] == pytest.approx(-2500.0, abs=2e-7)
    for matrix, first, step in ((found.stiffness, 0, 1e-10), (found.damping, 4, 1e-7)):
        for k in range(2):
            d = step * np.eye(10)[first + k]
            change = _whole_force(bearing, motion + d, place) - _whole_force(bearing, motion - d, place)
            # rounding of 2 kN over steps of 2e-6 of the clearance
            assert -change[:2] / (2 * step) == pytest.approx(matrix[:, k], abs=1e-6 * np.abs(matrix).max())
    faces = ehd.steady(
        bearing,
        speed=200.0,
        eccentricity_ratio=found.eccentricity_ratio,
        direction=math.atan2(*found.position[::-1]),
        tilt=tilt,
        axial_position=place,
    ).faces
    assert found.film.faces.edge_pressures == pytest.approx(faces.edge_pressures, rel=1e-8)
    assert found.film.faces.axial_stiffness == pytest.approx(faces.axial_stiffness, rel=1e-6)
    # the audit looks at the film with the ends that it has
    assert found.film.audit()["cavitation"].value > 0.0


def test_refused():
    for faces, options, names in (
        ({"inner_pressures": (0.0, 0.0)}, {}, "inner_pressures must be None"),
        ({}, {"film": ehd.LongBearing(), "supply": ()}, "film=LongBearing"),
        ({}, {"film": ehd.ClassicSOR(), "supply": (), "cavitation": ehd.Gumbel()}, "film=ClassicSOR.*Gumbel"),
        ({}, {"inlet": ehd.MaximumGap(), "supply": ()}, r"inlet=MaximumGap"),
        ({}, {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9)}, r"JournalBearing\.bush"),
        (
            {},
            {"supply": (ehd.AxialGroove(angle=0.0, width_angle=0.5, length=L, pressure=0.0),)},
            r"supply\[0\].*a land of",
        ),
    ):
        with pytest.raises(ehd.InputError, match=names):
            _bearing(faces, **options)
    with pytest.raises(ehd.FilmError, match="NO_FILM on a thrust face"):
        ehd.steady(_bearing(), speed=200.0, eccentricity_ratio=0.5, axial_position=5e-5)
    with pytest.raises(ehd.FilmError, match="NO_FILM at x"):
        ehd.steady(_bearing(), speed=200.0, eccentricity_ratio=0.9, tilt=(1e-3, 0.0), axial_position=0.0)
