"""Film pressure on the faces of a bore: against consistent loads on pairs of grids, resultants, torn bores."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.grid import bearing_grid, long_bearing_grid
from exudyn_ehd.film.models import film_grid
from exudyn_ehd.joint.bore.shapes import ModalBore, NodalBore, vertex_means
from exudyn_ehd.solid.bush import bore_modes
from exudyn_ehd.solid.fe_bore import OUTSIDE
from exudyn_ehd.solid.mesh import patch
from exudyn_ehd.solid.total_lagrange import held_solution
from tests.sampling import sample
from tests.solid_pressures import pressure_loads
from tests.solid_tetrahedra import tetrahedra

R, L = 0.03, 0.066
# Modulus and thickness: steel, and a layer of polymer that yields next to where it is pressed.
STEEL, LAYER = (2.1e11, 0.02), (3e9, 5e-3)


def cylinder(axial, radial, circumferential, thickness=0.02):
    return ehd.HollowCylinder(
        inner_radius=R,
        thickness=thickness,
        length=L,
        axial=axial,
        radial=radial,
        circumferential=circumferential,
    )


def pressure(theta, zeta):
    """Pressure under a tilted journal at eccentricity ratio 0.7."""
    local = 0.7 + 0.05 * zeta
    film = np.maximum(local * np.sin(theta - 0.3), 0.0) / (1.0 + local * np.cos(theta - 0.3)) ** 3
    return film * (1.0 - np.cosh(4.0 * zeta) / np.cosh(4.0))


def grids(rng, count):
    """Film grids of every kind, with rows on the edges of grooves too."""
    for _ in range(count):
        n, n_z, stretch = int(rng.integers(16, 97)), int(rng.integers(4, 17)), rng.uniform(0.0, 0.95)
        yield bearing_grid(R, L, n, n_z, stretch=stretch, start_angle=rng.uniform(-3.0, 3.0))
    groove = ehd.CircumferentialGroove(width=rng.uniform(0.02, 0.3) * L, z=rng.uniform(-0.2, 0.2) * L)
    yield film_grid(ehd.FiniteLength(), R, L, start_angle=0.0, open_ring=False, supply=(groove,))
    yield long_bearing_grid(R, L, 48, int(rng.integers(2, 7)))


@pytest.mark.parametrize(
    "mesh",
    sample(
        [cylinder(3, 1, 14).mesh(), ehd.mesh_from_arrays(*tetrahedra(cylinder(2, 1, 16), shift=0.2), bore_radius=R)], 0
    ),
    ids=["hexahedra", "tetrahedra"],
)
def test_rigid_motions_are_exact_and_loads_have_the_resultants_of_the_film(mesh):
    rng = np.random.default_rng(5)
    for grid in grids(rng, 2):
        bore = NodalBore(mesh.bore, grid)
        n, m = grid.shape
        cos, sin, z = np.cos(grid.x)[:, None], np.sin(grid.x)[:, None], grid.z * R
        shift, tilt = rng.normal(size=2), rng.normal(size=2)
        q = (shift + mesh.bore.z[:, None] / L * tilt).ravel()
        rigid = (shift[0] + z / L * tilt[0]) * cos + (shift[1] + z / L * tilt[1]) * sin
        assert np.abs(bore.displacement(q) - rigid).max() < 1e-13
        force = rng.normal(size=(n, m)) * grid.weight
        load = bore.load(force).reshape(-1, 2)
        for weight, height in ((np.ones_like(mesh.bore.z), np.ones(m)), (mesh.bore.z, z)):
            expected = [np.sum(force * height * direction) for direction in (cos, sin)]
            assert np.abs(weight @ load - expected).max() < 1e-13 * np.abs(force).sum() * height.max()


def deflections(described, material, grid):
    """Displacements of the film's vertices (n, m): under the film's loads, and under consistent ones on the mesh."""
    bush = ehd.ANCFBush(
        mesh=described, material=ehd.SaintVenantKirchhoff(youngs_modulus=material, poisson_ratio=0.3, density=1e3)
    )
    mesh = bush.build_mesh()
    solve = held_solution(bush.solid(mesh).tangent(0.0 * mesh.nodes), mesh.outer.nodes)
    bore, size = NodalBore(mesh.bore, grid), len(mesh.nodes)
    loads = np.zeros((size, 3, 2))
    force = pressure(grid.x[:, None], 2.0 * grid.z * R / L) * grid.weight * R**2
    loads[mesh.bore.nodes, :2, 0] = bore.load(force).reshape(-1, 2)
    loads = loads.reshape(-1, 2)
    loads[:, 1:] = pressure_loads(mesh.bore, size, [pressure], 12)
    moved = solve(loads).reshape(size, 3, 2)[mesh.bore.nodes, :2]
    # at the vertices themselves, by the shape functions there
    T, Z = np.meshgrid(grid.x, grid.z * R, indexing="ij")
    exact = mesh.bore.interpolation(T.ravel(), Z.ravel()) @ moved[..., 1]
    normals = np.stack([np.cos(T.ravel()), np.sin(T.ravel())], axis=1)
    return bore.displacement(moved[..., 0].ravel()), np.sum(exact * normals, axis=1).reshape(grid.shape)


def check_pair(described, modulus, film):
    grid = bearing_grid(R, L, *film)
    got, exact = deflections(described, modulus, grid)
    peak = np.unravel_index(np.abs(exact).argmax(), exact.shape)[0]
    error = (got[peak] - exact[peak]) / np.abs(exact).max()
    # six intervals hold the pressure itself to a per cent, and to five next to its ends
    coarse = film[1] == 6 and described.thickness < 0.01
    assert abs(error[len(error) // 2]) < (0.015 if coarse else 0.01)
    # what alternates from vertex to vertex
    saw = np.abs(error[1:-1] - 0.5 * (error[2:] + error[:-2])).max()
    assert saw < (0.06 if coarse else 0.025)
    return got[peak, grid.z.size // 2]


@pytest.mark.parametrize(("mesh", "film"), [((4, 1, 24), (48, 6)), ((4, 1, 24), (96, 10)), ((2, 1, 16), (192, 16))])
def test_the_bore_has_no_saw_teeth(mesh, film):
    check_pair(cylinder(*mesh), STEEL[0], film)


@pytest.mark.slow
@pytest.mark.parametrize("layer", [STEEL, LAYER], ids=["steel", "layer"])
@pytest.mark.parametrize("film", [(48, 6), (96, 10), (128, 12), (192, 16)], ids=str)
def test_no_finer_mesh_makes_it_worse(layer, film):
    modulus, thickness = layer
    meshes = (4, 1, 24), (4, 2, 40), (6, 2, 48), (8, 2, 64), (12, 2, 80)
    found = [check_pair(cylinder(*mesh, thickness=thickness), modulus, film) for mesh in meshes]
    # the mesh itself converges: 2 % from its coarsest to its finest
    assert np.abs(np.array(found) / found[-1] - 1.0).max() < 0.02


@pytest.mark.slow
def test_modes_see_the_film_as_the_nodes_do():
    bush = ehd.ModalBush(
        mesh=cylinder(2, 1, 16),
        material=ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=1e3),
        tolerance=0.2,
    )
    modes, grid = bore_modes(bush), bearing_grid(R, L, 48, 6)
    shapes = (
        NodalBore(modes.mesh.bore, grid).shapes
        @ modes.displacements[:, modes.mesh.bore.nodes, :2].reshape(modes.count, -1).T
    )
    q = np.random.default_rng(1).normal(size=modes.count)
    moved = ModalBore(modes, grid).displacement(q).ravel()
    assert np.abs(moved - shapes @ q).max() < 1e-9 * np.abs(moved).max()


def torn_bore(surface, hole):
    """A bore without one of its faces, or with one of its lines of nodes cut in two."""
    positions, faces = surface.positions.copy(), surface.local_faces.copy()
    if hole:
        middle = positions[faces].mean(axis=1)
        faces = np.delete(faces, np.argmin(np.linalg.norm(middle - [R, 0.0, 0.0], axis=1)), axis=0)
    else:
        on_cut = np.flatnonzero((np.abs(positions[:, 1]) < 1e-9) & (positions[:, 0] > 0.0))
        number = np.arange(len(positions))
        number[on_cut] = len(number) + np.arange(on_cut.size)
        above = positions[faces].mean(axis=1)[:, 1] > 0.0
        faces[above] = number[faces[above]]
        positions = np.concatenate((positions, positions[on_cut]))
    return replace(patch(positions, faces), tolerance=OUTSIDE)


@pytest.mark.parametrize("hole", [False, True], ids=["slot", "hole"])
def test_no_mean_is_taken_across_slots_and_holes(hole):
    """A bore whose halves move apart moves the vertices of either side as that side; holes between vertices pass."""
    torn = torn_bore(cylinder(8, 1, 64).mesh().bore, hole)
    grid = bearing_grid(R, L, 16 if hole else 50, 5, start_angle=0.02 + (0.17 if hole else 0.0))
    S = vertex_means(torn, grid)
    assert np.abs(S.sum(axis=1) - 1.0).max() < 1e-12
    if not hole:
        apart = (np.arange(len(torn.positions)) >= len(torn.positions) - 17) | (torn.positions[:, 1] > 1e-9)
        seen = (S @ apart.astype(float)).reshape(grid.shape)
        side = np.sin(grid.x) > 0.0
        near = np.abs((grid.x + np.pi) % (2.0 * np.pi) - np.pi) < 0.4
        assert np.abs(seen[near] - side[near, None]).max() < 1e-12
