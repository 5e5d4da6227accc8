"""Soft nodal bushes in balance with their films: the solid's own equations, stiffness about the deformed state.

`tests/coupling/element/test_nodal.py` compares them with static solves in Exudyn.
"""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

RADIUS, C, SPEED, WALL = 0.02, 50e-6, 314.0, 1e-3
CYLINDER = ehd.HollowCylinder(
    inner_radius=RADIUS + C, thickness=WALL, length=RADIUS, axial=2, radial=1, circumferential=16
)


def bearing(modulus, law=ehd.NeoHooke, mesh=CYLINDER, **options):
    given = {
        "journal_radius": RADIUS,
        "length": RADIUS,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=0.02),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
        "bush": ehd.ANCFBush(mesh=mesh, material=law(youngs_modulus=modulus, poisson_ratio=0.3, density=1200.0)),
    }
    return ehd.JournalBearing(**(given | options))


def motion(x, y=0.0):
    return np.array([x, y, 0, 0, 0, 0, 0, 0, SPEED, 0.0])


@pytest.mark.parametrize("modulus", [2.1e11, 2e7, 5e6])
def test_the_solid_holds_the_films_forces(modulus):
    """Internal forces of the mesh against the film's forces on its nodes, at strains from nothing to a tenth."""
    b = bearing(modulus)
    model = build_model(b)
    evaluation = model.evaluate_steady(motion(C * (0.8 if modulus > 1e9 else 1.5)))
    mesh, u = b.bush.build_mesh(), model.elasticity.displacements
    assert np.array_equal(u[mesh.bore.nodes, :2].ravel(), evaluation.bore.coordinates)
    assert not u[mesh.outer.nodes].any()
    lack = b.bush.solid(mesh).force(u)
    lack[mesh.bore.nodes] -= evaluation.forces_at(mesh.bore.positions + u[mesh.bore.nodes])
    lack[mesh.outer.nodes] = 0.0
    assert np.linalg.norm(lack) < 1e-8 * np.linalg.norm(evaluation.bore.load)
    assert (np.abs(u).max() > 0.05 * WALL) == (modulus < 1e9)


@pytest.mark.parametrize("law", [ehd.NeoHooke, pytest.param(ehd.SaintVenantKirchhoff, marks=pytest.mark.slow)])
def test_stiffness_is_that_about_the_deformed_state(law):
    b = bearing(1e7, law)
    eq = ehd.equilibrium(b, speed=SPEED, load=(0.0, -250.0))
    assert np.abs(eq.film.bore_displacement).max() > 0.03 * WALL
    model, step = build_model(b), 1e-5 * C
    model.evaluate_steady(motion(*eq.position))

    def force(shift):
        return model.evaluate_steady(motion(*eq.position + shift)).wrench[:2].copy()

    numeric = -np.stack([force(s) - force(-s) for s in step * np.eye(2)], axis=1) / (2.0 * step)
    assert np.allclose(eq.stiffness, numeric, rtol=0, atol=1e-5 * np.abs(numeric).max())


@pytest.mark.slow
def test_a_film_does_not_depend_on_the_one_before():
    """A film is found from an undeformed bush, from one strained elsewhere, and after a search without a solution."""
    model = build_model(bearing(1e7))
    first = model.evaluate_steady(motion(0.6 * C, -0.5 * C)).wrench.copy()
    model.evaluate_steady(motion(-1.1 * C))
    assert model.evaluate_steady(motion(3.0 * C)).status is not ehd.Status.CONVERGED
    again = model.evaluate_steady(motion(0.6 * C, -0.5 * C)).wrench
    assert np.allclose(again, first, rtol=0, atol=1e-9 * np.abs(first).max())


@pytest.mark.slow
def test_journals_go_far_beyond_the_clearance():
    """Eight clearances into a soft bush, which creeping steps follow; a linear one holds it at seven."""
    mesh = ehd.HollowCylinder(
        inner_radius=RADIUS + C, thickness=3.9e-3, length=RADIUS, axial=2, radial=1, circumferential=16
    )
    fine = ehd.FiniteLength(n_theta=96, n_z=12)
    b = bearing(4.1e6, ehd.SaintVenantKirchhoff, mesh, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5), film=fine)
    eq = ehd.equilibrium(b, speed=SPEED, load=(-300.0, 110.0))
    assert eq.eccentricity_ratio > 7.5
    assert np.allclose(eq.film.force[:2], (300.0, -110.0), atol=1e-6)


def test_nodes_of_the_bore_that_are_held_stay():
    """A bush clamped at one end too: its bore is held there."""
    plain = CYLINDER.mesh()
    with pytest.warns(UserWarning, match="are clamped"):
        mesh = ehd.mesh_from_arrays(
            plain.nodes,
            plain.elements,
            bore_radius=RADIUS + C,
            held=np.union1d(plain.outer.nodes, plain.end_low.nodes),
        )
    model = build_model(bearing(1e8, mesh=mesh))
    evaluation = model.evaluate_steady(motion(0.7 * C))
    assert evaluation.status is ehd.Status.CONVERGED
    held = np.isin(mesh.bore.nodes, mesh.outer.nodes)
    moved = evaluation.bore.coordinates.reshape(-1, 2)
    assert held.sum() == 32
    assert not moved[held].any()
    assert np.abs(moved[~held]).max() > 0.01 * C
