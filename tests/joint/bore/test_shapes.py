"""Bores that move in modes against dense algebra: symmetric about the mid-plane, or not."""

from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_ehd.film.banded.many_sides import TILE, make_tiles
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.joint.bore.shapes import ModalBore
from exudyn_ehd.solid.mesh import HollowCylinder

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


@pytest.mark.parametrize("kind", ["both", "even", "odd", "neither"])
@pytest.mark.parametrize("n_z", [6, 7])
def test_products(kind, n_z):
    bore, S = bore_and_shapes(kind, n_z)
    n, m = bore.grid_shape
    assert bore.mirrored == (0 if kind == "neither" else m // 2)
    rng = np.random.default_rng(2)
    q, q_t = rng.normal(size=(2, K))
    place, rate = bore.displacements(q, q_t)
    np.testing.assert_allclose([place.ravel(), rate.ravel()], [S @ q, S @ q_t], rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(bore.displacement(q).ravel(), S @ q, rtol=1e-11, atol=1e-11)
    fields = rng.normal(size=(3, n, m))
    np.testing.assert_allclose(bore.contract(fields), fields.reshape(3, -1) @ S, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(bore.load(fields[0]), fields[0].ravel() @ S, rtol=1e-11, atol=1e-11)
    expected = S.T @ (fields[0].reshape(-1, 1) * S)
    np.testing.assert_allclose(bore.product(fields[0]), expected, rtol=1e-11, atol=1e-10)


@pytest.mark.parametrize("kind", ["both", "even", "odd", "neither"])
@pytest.mark.parametrize("columns", [range(9, 15), [22, 23, 0, 1], range(24)])
def test_rows_and_projection(kind, columns):
    bore, S = bore_and_shapes(kind, 6)
    n, m = bore.grid_shape
    places = np.array([i * m + j for i in columns for j in range(1, m - 1)])
    count, first = len(places), 5
    rng = np.random.default_rng(3)
    integrals, weight = rng.normal(size=(first, count)), rng.normal(size=count)
    tiles = make_tiles(integrals, first + K)
    bore.fill_rows(places, weight, first, tiles)
    X = tiles.transpose(1, 0, 2).reshape(-1, TILE * len(tiles))[:count, : first + K]
    np.testing.assert_allclose(X[:, :first], integrals.T)
    np.testing.assert_allclose(X[:, first:], (weight[:, None] * S[places])[:, bore.order], rtol=1e-11, atol=1e-12)
    i, j = np.divmod(places, m)
    vertices = np.stack([places, (i + 1) % n * m + j, (i - 1) % n * m + j, places + 1, places - 1], axis=1)
    stencil = rng.normal(size=(count, 5))
    expected = X.T @ np.einsum("rc,rck->rk", stencil, S[vertices])
    np.testing.assert_allclose(bore.project(stencil, vertices, tiles, first + K), expected, rtol=1e-10, atol=1e-10)
    part = bore.project(stencil, vertices, tiles, first)
    np.testing.assert_allclose(part, expected[:first], rtol=1e-10, atol=1e-10)
