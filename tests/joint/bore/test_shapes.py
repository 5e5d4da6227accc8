"""Bores against dense algebra: modes that are symmetric about the mid-plane or not, nodes of a mesh."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from exudyn_ehd.film.banded.many_sides import TILE, make_tiles
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.joint.bore.columns import by_columns
from exudyn_ehd.joint.bore.shapes import ModalBore, NodalBore, courses
from exudyn_ehd.solid.mesh import HollowCylinder, directed

K = 60


def bore_and_shapes(kind, n_z):
    grid = bearing_grid(0.03, 0.06, 24, n_z)
    shapes = np.random.default_rng(1).normal(size=(*grid.shape, K))
    is_even = np.arange(K) % 3 > 0 if kind == "both" else np.full(K, kind == "even")
    if kind != "neither":
        sign = np.where(is_even, 1.0, -1.0)
        # with rounding of the modes' eigenvalue problem
        shapes = shapes + sign * shapes[:, ::-1] * (1.0 + 1e-14)
    shapes = shapes.reshape(-1, K)
    faces = HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.06, axial=1, radial=1, circumferential=8).mesh()
    modes = SimpleNamespace(
        count=K, stiffness=np.ones(K), faces=faces.bore, radial_of=lambda values, theta, z: shapes.copy()
    )
    return ModalBore(modes, grid), shapes


def nodal_bore_and_shapes(n_z):
    grid = bearing_grid(0.03, 0.06, 24, n_z)
    mesh = HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.06, axial=2, radial=1, circumferential=6).mesh()
    bore, m = NodalBore(mesh.bore, grid), grid.shape[1]
    # weights whose vertices do not follow each other
    bore.values += csr_matrix(([0.3, -0.2], ([m, 2 * m - 1], [0, 0])), shape=bore.values.shape)
    bore.columns = by_columns(bore.values, grid)
    theta = np.repeat(grid.x, grid.shape[1])
    bore.shapes = directed(bore.values, np.stack([np.cos(theta), np.sin(theta)], axis=1), 2)
    return bore, bore.shapes.toarray()


@pytest.mark.parametrize("kind", ["both", "even", "odd", "neither", "nodal"])
@pytest.mark.parametrize("n_z", [6, 7])
def test_products(kind, n_z):
    bore, S = nodal_bore_and_shapes(n_z) if kind == "nodal" else bore_and_shapes(kind, n_z)
    n, m = bore.grid_shape
    rng = np.random.default_rng(2)
    q, q_t = rng.normal(size=(2, bore.size))
    place, rate = bore.displacements(q, q_t)
    np.testing.assert_allclose([place.ravel(), rate.ravel()], [S @ q, S @ q_t], rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(bore.displacement(q).ravel(), S @ q, rtol=1e-11, atol=1e-11)
    fields = rng.normal(size=(3, n, m))
    np.testing.assert_allclose(bore.contract(fields), fields.reshape(3, -1) @ S, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(bore.load(fields[0]), fields[0].ravel() @ S, rtol=1e-11, atol=1e-11)
    expected = S.T @ (fields[0].reshape(-1, 1) * S)
    np.testing.assert_allclose(bore.product(fields[0]), expected, rtol=1e-11, atol=1e-10)


@pytest.mark.parametrize("kind", ["both", "even", "odd", "neither", "nodal"])
@pytest.mark.parametrize("columns", [range(9, 15), [22, 23, 0, 1], range(24)])
def test_rows_and_projection(kind, columns):
    bore, S = nodal_bore_and_shapes(6) if kind == "nodal" else bore_and_shapes(kind, 6)
    (n, m), k = bore.grid_shape, bore.size
    places = np.array([i * m + j for i in columns for j in range(1, m - 1)])
    count, first = len(places), 5
    rng = np.random.default_rng(3)
    integrals, weight = rng.normal(size=(first, count)), rng.normal(size=count)
    tiles = make_tiles(integrals, first + k)
    bore.fill_rows(places, weight, first, tiles)
    X = tiles.transpose(1, 0, 2).reshape(-1, TILE * len(tiles))[:count, : first + k]
    np.testing.assert_allclose(X[:, :first], integrals.T)
    np.testing.assert_allclose(X[:, first:], weight[:, None] * S[places], rtol=1e-11, atol=1e-12)
    i, j = np.divmod(places, m)
    vertices = np.stack([places, (i + 1) % n * m + j, (i - 1) % n * m + j, places + 1, places - 1], axis=1)
    stencil = rng.normal(size=(count, 5))
    expected = X.T @ np.einsum("rc,rck->rk", stencil, S[vertices])
    np.testing.assert_allclose(bore.project(stencil, vertices, tiles, first + k), expected, rtol=1e-10, atol=1e-10)
    part = bore.project(stencil, vertices, tiles, first)
    np.testing.assert_allclose(part, expected[:first], rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("rows, rank", [(9, 5), (9, 9), (3, 2), (12, 4)])
def test_courses_along_z(rows, rank):
    rng = np.random.default_rng(8)
    shapes = rng.normal(size=(rows, rank)) @ rng.normal(size=(9, rank, 7))
    basis, coordinates = courses(shapes)
    assert basis.shape == (rank, rows)
    np.testing.assert_allclose(basis.T @ coordinates.reshape(9, rank, 7), shapes, rtol=1e-12, atol=1e-12)
