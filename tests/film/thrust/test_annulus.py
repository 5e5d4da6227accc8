"""Columns on the edges of pads, and the error of default grids that `ThrustFaces` states."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.thrust.annulus import face_grid, pad_columns
from exudyn_ehd.film.thrust.face import FaceFilm

MU, SPEED = 0.02, 300.0


def _draw(rng, pads=True):
    """Random faces and motion (9,) of the range that `ThrustFaces` states."""
    clearance, outer = 10.0 ** rng.uniform(-5.0, -4.0), 10.0 ** rng.uniform(-2.0, -1.0)
    place = rng.uniform(-0.8, 0.5) * clearance
    gap, tilt, angle = clearance + place, rng.uniform(0.0, 0.8), rng.uniform(0.0, 2.0 * math.pi)
    kind = (ehd.StepLand, ehd.TaperLand)[int(rng.integers(2))]
    profile = kind(
        pads=int(rng.integers(3, 17)),
        share=rng.uniform(0.2, 0.9),
        depth=gap * rng.uniform(0.3, 3.0),
        reverse=bool(rng.integers(2)),
    )
    faces = ehd.ThrustFaces(
        inner_radius=rng.uniform(0.35, 0.85) * outer,
        outer_radius=outer,
        clearance=clearance,
        profile=profile if pads else None,
    )
    slope = tilt * gap / outer * np.array([math.cos(angle), math.sin(angle)])
    return faces, np.array([place, *slope, 0.0, 0.0, 0.0, -SPEED if profile.reverse else SPEED, 0.0, 0.0])


def _found(faces, motion):
    """Force, stiffness, damping, torque, power, inflow and outflow of a face."""
    film = FaceFilm(faces, 1, ehd.SwiftStieber(line_in_cells=True), ehd.Lubricant(viscosity=MU), (0.0, 0.0))
    state = film.evaluate(motion)
    tangent = film.tangent()
    return np.array([state.wrench[2], -tangent[2, 0], -tangent[2, 3], state.wrench[5], state.power_loss, *film.flows()])


def _errors(faces, motion):
    """Relative errors against a grid three times as fine, which has a ninth of an error of second order left."""
    n_theta, n_r, _ = face_grid(faces)
    fine = dataclasses.replace(faces, n_theta=3 * n_theta, n_r=3 * n_r)
    return 9.0 / 8.0 * np.abs(_found(faces, motion) / _found(fine, motion) - 1.0)


# as the table of `ThrustFaces` states them
PADS = np.array([0.015, 0.02, 0.05, 0.006, 0.006, 0.01, 0.01])
PLANE = np.array([0.004, 0.006, 0.02, 0.001, 0.001, 0.01, 0.01])


def test_error_of_the_default_grid():
    rng = np.random.default_rng(3)
    assert np.all(_errors(*_draw(rng)) <= PADS)
    assert np.all(_errors(*_draw(rng, pads=False)) <= PLANE)


@pytest.mark.slow
def test_error_of_the_default_grid_over_the_range():
    rng = np.random.default_rng(31)
    errors = np.array([_errors(*_draw(rng)) for _ in range(40)])
    assert np.all(errors <= PADS)
    # damping is off where the cavity behind an edge ends between two rows
    assert np.mean(errors[:, 2] <= 0.025) >= 0.95
    assert np.all([_errors(*_draw(rng, pads=False)) <= PLANE for _ in range(16)])


def test_every_edge_has_a_column():
    """Columns of equal pads, on edges to rounding, of any number of columns."""
    rng = np.random.default_rng(1)
    for _ in range(50):
        pads, count, share = int(rng.integers(1, 30)), int(rng.integers(8, 40)), rng.uniform(0.01, 0.999)
        kind = (ehd.StepLand, ehd.TaperLand)[int(rng.integers(2))]
        profile = kind(pads=pads, depth=1e-5, share=share, reverse=bool(rng.integers(2)))
        theta = pad_columns(profile, count)
        assert theta.size == pads * count and theta[0] == 0.0
        assert np.all(np.diff(theta, append=2.0 * math.pi) > 0.0)
        edges = 2.0 * math.pi / pads * np.add.outer(np.arange(pads), profile.edges[:-1]).ravel()
        assert np.abs(theta[:, None] - edges).min(axis=0).max() < 1e-14
    assert pad_columns(ehd.StepLand(pads=5, depth=1e-5, share=1.0), 9).size == 45


@pytest.mark.parametrize("share", (0.3, 0.7))
def test_contact_on_lands(share):
    """A collar on the lands of steps: their area times the wall's pressure, to rounding."""
    wall, depth, gap = ehd.RegularisedWall(onset=5e-6, pressure=1e8), 20e-6, 2e-6
    profile = ehd.StepLand(pads=7, depth=depth, share=share)
    faces = ehd.ThrustFaces(inner_radius=0.02, outer_radius=0.04, clearance=30e-6, profile=profile, contact=wall)
    film = FaceFilm(faces, 1, ehd.SwiftStieber(), ehd.Lubricant(viscosity=MU), (0.0, 0.0))
    found = film.evaluate(np.array([gap - faces.clearance, *np.zeros(8)]))
    area = (1.0 - share) * math.pi * (0.04**2 - 0.02**2)
    assert found.contact_load == pytest.approx(area * wall.pressure * (1.0 - gap / wall.onset) ** 2, rel=1e-12)
    assert found.minimum_gap == pytest.approx(gap, rel=1e-12)
