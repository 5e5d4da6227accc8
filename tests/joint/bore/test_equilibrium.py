"""A flexible bore in balance with its film: thin tongues, where Newton's method alone jumps to other films or none."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import evaluate_at
from exudyn_ehd.joint.bore.equilibrium import BoreSearch
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.mesh import BushMesh, boundary_faces, surface_of

R, L, C = 0.025, 0.025, 25e-6
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)


def tongue(thickness, cells):
    """A bush with a tongue: its inner layer is cut free from the outer one over some of 24 columns, and at one side."""
    cylinder = ehd.HollowCylinder(
        inner_radius=R + C, thickness=2.0 * thickness, length=L, axial=2, radial=2, circumferential=24
    ).mesh()
    nodes, elements = cylinder.nodes.copy(), cylinder.elements.copy()
    half, middle, limit = math.pi * cells / 24, cylinder.nodes[elements].mean(axis=1), R + C + thickness
    inner = (np.hypot(*middle[:, :2].T) < limit) & (np.abs(np.arctan2(middle[:, 1], middle[:, 0])) < half)
    r, angle = np.hypot(nodes[:, 0], nodes[:, 1]), np.arctan2(nodes[:, 1], nodes[:, 0])
    slot = (np.abs(r - limit) < 1e-9) & (angle > 1e-6 - half) & (angle < half + 1e-6)
    cut = np.flatnonzero(slot | ((r < limit) & (np.abs(angle - half) < 1e-6)))
    number = np.arange(len(nodes))
    number[cut] = len(nodes) + np.arange(len(cut))
    nodes[:, :2] *= np.where(r > limit, 1.0 + (r - limit) / thickness * 6e-3 / r, 1.0)[:, None]
    nodes = np.concatenate((nodes, nodes[cut]))
    elements[inner] = number[elements[inner]]
    faces, r, z = boundary_faces(elements), np.hypot(nodes[:, 0], nodes[:, 1]), nodes[:, 2]

    def surface(member):
        return surface_of(nodes, faces, member)

    return BushMesh(
        nodes=nodes,
        elements=elements,
        bore=surface(np.abs(r - R - C) < 1e-9),
        outer=surface(r > r.max() - 1e-9),
        end_low=surface(z < z.min() + 1e-9),
        end_high=surface(z > z.max() - 1e-9),
    )


def tongues(seed, count, shapes=((4e-4, 8),)):
    """Models and motions of journals that press on the middle of thin tongues, random in shape, speed and place."""
    rng = np.random.default_rng(seed)
    bushes = [
        ehd.ModalBush(mesh=tongue(thickness, cells), material=STEEL, tolerance=0.2) for thickness, cells in shapes
    ]
    for _ in range(count):
        b = ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=C,
            lubricant=ehd.Lubricant(viscosity=0.03),
            bush=bushes[rng.integers(len(bushes))],
            film=ehd.FiniteLength(n_theta=72, n_z=8),
        )
        e, direction = C * rng.uniform(0.3, 1.1), rng.uniform(-0.7, 0.7)
        place = [e * math.cos(direction), e * math.sin(direction)]
        yield build_model(b), np.array([*place, 0, 0, 0, 0, 0, 0, rng.choice([-300.0, 50.0, 100.0, 300.0, 600.0]), 0.0])


@pytest.mark.slow
def test_films_on_thin_tongues_are_found():
    """Bores that bend by ten clearances: from the undeformed one a film is found, in a bounded number of trials."""
    for model, motion in tongues(0, 4):
        before = model.parts.evaluations
        evaluation = model.evaluate_steady(motion)
        assert evaluation.status is ehd.Status.CONVERGED
        assert model.parts.evaluations - before < 400
        held = model.elasticity.force(evaluation.bore.coordinates)
        np.testing.assert_allclose(evaluation.bore.load, held, atol=1e-8 * np.abs(held).max())


@pytest.mark.slow
def test_the_film_on_a_tongue_is_the_one_reached_from_the_undeformed_bore():
    """The end of the viscous bore's motion ``K (q + tau dq/dt) = Q``, followed in short steps.

    Two of eight have a second balance, nearer to the undeformed bore, at which Newton's method arrives first.
    """
    others = 0
    for model, motion in tongues(1, 8, ((4e-4, 8), (1e-3, 6))):
        evaluation = model.evaluate_steady(motion)
        found, load = evaluation.bore.coordinates.copy(), evaluation.bore.load
        q, search = np.zeros_like(found), BoreSearch(model, motion, (None, 0.0, 0.0))
        part = min(1.0, 0.9 * C / float(np.hypot(*motion[:2])))
        for step in range(150):
            ways = (search.find(q, min(1.0, part + 0.01 * step), slowness=s) for s in (10.0, 100.0, 1e3, 1e4))
            q = next(near for near in ways if near is not None).bore.coordinates.copy()
        if np.linalg.norm(q - found) > 1e-3 * np.linalg.norm(found):
            others += 1
            held = model.elasticity.force(found)
            assert np.linalg.norm(load - held) < 1e-8 * np.linalg.norm(held)
            assert np.linalg.norm(found) < 0.1 * np.linalg.norm(q)
    assert others <= 2


@pytest.mark.slow
def test_a_bore_without_an_equilibrium_is_named():
    model, motion = next(tongues(0, 1))
    motion[:2] *= 40.0 * C / np.hypot(*motion[:2])
    with pytest.raises(ehd.FilmError, match=r"steady: .* no shape of the ModalBush's bore was found"):
        evaluate_at(model, motion, "steady")


def soft_bushes(seed, count, contact=None):
    """Models and motions of journals pressed into soft bushes deeper than the clearance."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        c, modulus = C * rng.uniform(0.5, 3.0), math.exp(rng.uniform(math.log(1e7), math.log(1e10)))
        cylinder = ehd.HollowCylinder(
            inner_radius=R + c, thickness=rng.uniform(4e-3, 1.2e-2), length=L, axial=2, radial=1, circumferential=16
        )
        soft = ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.35, density=1200.0)
        b = ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=c,
            lubricant=ehd.Lubricant(viscosity=0.05),
            bush=ehd.ModalBush(mesh=cylinder.mesh(), material=soft),
            contact=contact,
            film=ehd.FiniteLength(n_theta=96, n_z=12),
        )
        e, direction = c * rng.uniform(1.05, 4.0), rng.uniform(-math.pi, math.pi)
        place = [e * math.cos(direction), e * math.sin(direction), 0, 0]
        yield build_model(b), np.array([*place, 0, 0, 0, 0, math.exp(rng.uniform(math.log(5.0), math.log(300.0))), 0])


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "closed"), [(6, 4), (7, 3)])
def test_films_on_soft_bores_are_found_unless_they_close_at_an_end(seed, closed):
    """A film that closes before the journal is there is named; with a contact there is one.

    The same films close on modes with tolerances of 0.004 and 0.02; with 0.2 they are found.
    """
    wall = ehd.RegularisedWall(onset=5e-7, pressure=1e8)
    pairs = zip(soft_bushes(seed, closed + 1), soft_bushes(seed, closed + 1, wall), strict=True)
    for i, ((model, motion), (with_wall, _)) in enumerate(pairs):
        evaluation = model.evaluate_steady(motion)
        if i < closed:
            assert evaluation.status is ehd.Status.CONVERGED
            held = model.elasticity.force(evaluation.bore.coordinates)
            np.testing.assert_allclose(evaluation.bore.load, held, atol=1e-8 * np.abs(held).max())
            continue
        assert evaluation.status is not ehd.Status.CONVERGED
        assert evaluation.closing.part < 1.0 and abs(evaluation.closing.z) == 0.5 * L
        with pytest.raises(ehd.FilmError, match=r"the film closes at theta = .*the surfaces touch.*contact="):
            evaluate_at(model, motion, "steady")
        assert with_wall.evaluate_steady(motion).status is ehd.Status.CONVERGED
