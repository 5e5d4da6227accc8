"""Convergence of a tilted journal's steady film on a flexible bore: bush mesh, modes, film grid.

And where its minimum film thickness is.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.sampling import sample

SPEED, C, R, LENGTH, TILT = 100.0 * np.pi, 30e-6, 0.03, 0.066, 1e-4
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)


def modal(axial=4, radial=2, circumferential=24, **options):
    mesh = ehd.HollowCylinder(
        inner_radius=R, thickness=0.02, length=LENGTH, axial=axial, radial=radial, circumferential=circumferential
    )
    return ehd.ModalBush(mesh=mesh, material=STEEL, **options)


def solve(bush, n_theta=96, n_z=12):
    bearing = ehd.JournalBearing(
        journal_radius=R,
        length=LENGTH,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=9e-3),
        bush=bush,
        film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
    )
    return ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.8, direction=-np.pi / 2, tilt=(0.0, TILT))


def values(film):
    return np.array([film.peak_pressure, np.hypot(*film.force[:2])])


@pytest.mark.slow
def test_bush_mesh_converges():
    results = [values(solve(modal(2 * k, k, 12 * k, tolerance=0.01))) for k in (1, 2, 3)]
    first, second = (abs(b - a) for a, b in itertools.pairwise(results))
    # errors h^2 with h = 1, 1/2, 1/3 make (1 - 1/4) / (1/4 - 1/9) = 5.4 of the ratio, h makes 3; 7.2 (peak) and 3.8
    # (load) measured
    assert first[0] > 5.4 * second[0]
    assert first[1] > 3.0 * second[1]
    assert np.all(second < 0.003 * results[-1])


@pytest.mark.slow
def test_film_grid_converges_on_a_flexible_bore_as_on_a_rigid_one():
    bush = modal(tolerance=0.04)
    loads = [values(solve(bush, *grid))[1] for grid in ((48, 6), (96, 12), (192, 24))]
    # second order less what the rupture line's snapping to columns takes: 3.0 measured
    assert abs(loads[1] - loads[0]) > 2.5 * abs(loads[2] - loads[1])
    assert abs(loads[2] / loads[1] - 1.0) < 0.005


@pytest.mark.slow
def test_modes_converge_with_their_tolerance():
    exact = values(solve(modal(tolerance=5e-3)))
    for tolerance in (0.08, 0.04, 0.02, 0.01):
        # measured: a tenth to a quarter of it
        assert np.all(abs(values(solve(modal(tolerance=tolerance))) / exact - 1.0) < 0.5 * tolerance)


@pytest.mark.parametrize("bush", sample(["liner", "modal", "nodal"], 2))
def test_smallest_gap_of_a_tilted_journal_is_at_an_edge_of_the_deformed_bore(bush):
    mesh = ehd.HollowCylinder(inner_radius=R, thickness=0.02, length=LENGTH, axial=4, radial=1, circumferential=16)
    spec = {
        "liner": ehd.ElasticLiner(thickness=0.02, youngs_modulus=2.1e11),
        "modal": ehd.ModalBush(mesh=mesh, material=STEEL, tolerance=0.1),
        "nodal": ehd.ANCFBush(mesh=mesh, material=STEEL),
    }[bush]
    coarse, fine = solve(spec, 64, 8), solve(spec, 128, 16)
    for film in (coarse, fine):
        # the end vertices lie on the bearing's ends; links between columns see a little less than the vertices
        edge = film.gap[:, [0, -1]].min()
        assert edge == film.gap.min()
        assert 0.995 * edge < film.minimum_gap <= edge
        ends = film.motion[:2] + np.outer([-0.5 * LENGTH, 0.5 * LENGTH], film.motion[2:4])
        rigid = C - np.outer(np.cos(film.theta), ends[:, 0]) - np.outer(np.sin(film.theta), ends[:, 1])
        moved = 0.0 if film.bore_displacement is None else film.bore_displacement[:, [0, -1]]
        # a liner does not move where the pressure is that of the ends
        assert np.allclose(film.gap[:, [0, -1]], rigid + moved, rtol=0, atol=1e-12)
    # the inner rows would report a fifth more and over; the edge is found to 1 %
    assert coarse.gap[:, 1:-1].min() > 1.15 * coarse.minimum_gap
    assert coarse.minimum_gap == pytest.approx(fine.minimum_gap, rel=0.01)
