"""Equilibrium of a journal with films on its end faces."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.thrust import ThrustModel

C, SPEED, LOAD = 40e-6, 200.0, (300.0, -2000.0)
PADS = ehd.TaperLand(pads=4, depth=30e-6)


def _bearing(**options):
    faces = {"inner_radius": 0.026, "outer_radius": 0.05, "clearance": C, "n_theta": 48, "n_r": 6, "profile": PADS}
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=0.03),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        thrust=ehd.ThrustFaces(**(faces | options)),
    )


def _whole_force(bearing, motion, position):
    """Force (3,) of all films."""
    plain = dataclasses.replace(bearing, thrust=None)
    own = build_model(plain).evaluate(motion).wrench[:3]
    return own + ThrustModel(bearing).evaluate(np.append(motion, position)).wrench[:3]


@pytest.mark.parametrize("given", ({"axial_position": -12e-6}, {"axial_load": 2500.0}, {"axial_load": -400.0}))
@pytest.mark.parametrize("tilt", ((0.0, 0.0), (2e-4, -3e-4)))
def test_forces_balance_and_their_derivatives(given, tilt):
    """In x and y, and with an axial load along z; K and C at the place that was found are central differences."""
    bearing = _bearing()
    found = ehd.equilibrium(bearing, speed=SPEED, load=LOAD, tilt=tilt, **given)
    place, size = found.film.faces.axial_position, math.hypot(*LOAD)
    motion = np.array([*found.position, *tilt, 0, 0, 0, 0, SPEED, 0])
    force = _whole_force(bearing, motion, place)
    assert force[:2] == pytest.approx(-np.array(LOAD), abs=1e-9 * size)
    assert found.film.force + found.film.faces.force == pytest.approx(force, abs=1e-9 * size)
    if "axial_load" in given:
        assert force[2] == pytest.approx(-given["axial_load"], abs=1e-10 * size)
    else:
        assert place == given["axial_position"]
    for matrix, first, step in ((found.stiffness, 0, 1e-10), (found.damping, 4, 1e-7)):
        for k in range(2):
            d = step * np.eye(10)[first + k]
            change = _whole_force(bearing, motion + d, place) - _whole_force(bearing, motion - d, place)
            # rounding of 2 kN over steps of 2e-6 of the clearance
            assert -change[:2] / (2 * step) == pytest.approx(matrix[:, k], abs=1e-6 * np.abs(matrix).max())


def test_tilted_faces_take_part_in_the_load():
    """Their pressure on tilted collars: as much as the difference of both equilibria, and far above rounding."""
    bearing, tilt = _bearing(lower=False), (4e-4, 0.0)
    with_faces = ehd.equilibrium(bearing, speed=SPEED, load=LOAD, tilt=tilt, axial_load=-20e3)
    alone = ehd.equilibrium(dataclasses.replace(bearing, thrust=None), speed=SPEED, load=LOAD, tilt=tilt)
    share = with_faces.film.faces.force[:2]
    assert np.abs(share).max() > 3.0
    shift = np.linalg.solve(alone.stiffness, share)
    assert with_faces.position - alone.position == pytest.approx(shift, rel=0.02)


def test_axial_place_is_that_of_steady():
    """Bisection on prescribed places; opposite loads have opposite places."""
    bearing = _bearing()

    def force(z):
        film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.0, axial_position=z)
        return film.faces.axial_force + 3000.0

    expected = brentq(force, 0.0, 0.9 * C, xtol=1e-15)
    places = [
        ehd.equilibrium(bearing, speed=SPEED, load=LOAD, axial_load=load).film.faces.axial_position
        for load in (3000.0, -3000.0, 0.0)
    ]
    # sliding of an eccentric collar: 1e-5 of the force
    assert places == pytest.approx([expected, -expected, 0.0], rel=1e-4, abs=1e-10 * C)


def test_wall_carries_plane_faces():
    """Without pads a wall does, and the film none; the place is past the wall's onset."""
    wall = ehd.RegularisedWall(onset=5e-6, pressure=1e7)
    bearing = _bearing(profile=None, contact=wall)
    faces = ehd.equilibrium(bearing, speed=SPEED, load=LOAD, axial_load=500.0).film.faces
    assert faces.contact_load == pytest.approx(500.0, rel=1e-6)
    assert faces.minimum_gap < 5e-6
    assert faces.axial_position == pytest.approx(C - faces.minimum_gap, rel=1e-9)


def test_wide_plane_faces_change_next_to_nothing():
    """Drag alone across the axis: mu e omega A / h of each face, over the stiffness of the journal's film."""
    bearing = _bearing(profile=None, clearance=2e-4)
    alone = ehd.equilibrium(dataclasses.replace(bearing, thrust=None), speed=SPEED, load=LOAD)
    found = ehd.equilibrium(bearing, speed=SPEED, load=LOAD)
    assert alone.film.faces is None
    drag = 2.0 * 0.03 * SPEED * 50e-6 * math.pi * (0.05**2 - 0.026**2) / 2e-4
    moved = np.abs(found.position - alone.position).max()
    assert 0.0 < moved < drag / np.abs(alone.stiffness).min()


@pytest.mark.slow
def test_refused():
    plain = dataclasses.replace(_bearing(), thrust=None)
    for options in ({"axial_position": 1e-6}, {"axial_load": 10.0}):
        with pytest.raises(ehd.InputError, match=r"equilibrium: axial_.*ThrustFaces"):
            ehd.equilibrium(plain, speed=SPEED, load=LOAD, **options)
    with pytest.raises(ehd.InputError, match="exclude each other"):
        ehd.equilibrium(_bearing(), speed=SPEED, load=LOAD, axial_position=1e-6, axial_load=10.0)
    with pytest.raises(ehd.FilmError, match="no axial position found"):
        ehd.equilibrium(_bearing(profile=None), speed=SPEED, load=LOAD, axial_load=10.0)
    with pytest.raises(ehd.FilmError, match="NO_FILM on a thrust face"):
        ehd.equilibrium(_bearing(), speed=SPEED, load=LOAD, tilt=(1e-3, 0.0))
