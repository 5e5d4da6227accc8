"""Bores against dense algebra: modes that are symmetric about the mid-plane or not, nodes of a mesh."""

from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.joint.bore.shapes import ModalBore, NodalBore
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


def nodal_bore_and_shapes(n_z):
    grid = bearing_grid(0.03, 0.06, 24, n_z)
    mesh = HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.06, axial=2, radial=1, circumferential=6).mesh()
    bore, theta = NodalBore(mesh.bore, grid), np.repeat(grid.x, grid.shape[1])[:, None]
    values = bore.values.toarray()
    shapes = np.stack((np.cos(theta) * values, np.sin(theta) * values), axis=2)
    return bore, shapes.reshape(len(values), -1)


@pytest.mark.parametrize("kind", ["both", "even", "odd", "neither", "nodal"])
@pytest.mark.parametrize("n_z", [6, 7])
def test_products(kind, n_z):
    bore, S = nodal_bore_and_shapes(n_z) if kind == "nodal" else bore_and_shapes(kind, n_z)
    n, m = bore.grid.shape
    rng = np.random.default_rng(2)
    q = rng.normal(size=bore.size)
    np.testing.assert_allclose(bore.displacement(q).ravel(), S @ q, rtol=1e-11, atol=1e-11)
    fields = rng.normal(size=(3, n, m))
    np.testing.assert_allclose(bore.load(fields), fields.reshape(3, -1) @ S, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(bore.load(fields[0]), fields[0].ravel() @ S, rtol=1e-11, atol=1e-11)
    expected = S.T @ (fields[0].reshape(-1, 1) * S)
    np.testing.assert_allclose(bore.product(fields[0]), expected, rtol=1e-11, atol=1e-10)
