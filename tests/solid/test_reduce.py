"""Modes of a bush's bore: what they must span, and what the tolerance promises."""

import numpy as np
import pytest

from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.reduce import ModalBush, bore_modes, sample_loads, sample_pressures
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import InputError

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=4, radial=2, circumferential=24)


@pytest.fixture(scope="module")
def modes():
    return bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.02))


def _solve(mesh, loads):
    """Nodal displacements (k, n, 3) under loads (3 n, k) with a dense solver; outer surface fixed."""
    solid = TotalLagrange(mesh=mesh, material=STEEL)
    fixed = (3 * mesh.outer.nodes[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(3 * len(mesh.nodes)), fixed)
    K = solid.tangent(np.zeros_like(mesh.nodes)).toarray()[np.ix_(free, free)]
    u = np.zeros((loads.shape[1], 3 * len(mesh.nodes)))
    u[:, free] = np.linalg.solve(K, loads[free]).T
    return u.reshape(len(u), -1, 3)


def _on_grid(mesh, u, theta, z):
    T, Z = np.meshgrid(theta, z, indexing="ij")
    H = mesh.bore.radial_interpolation(T.ravel(), Z.ravel())
    return (H @ u[mesh.bore.nodes].ravel()).reshape(T.shape)


def test_modes_are_orthogonal_in_energy_and_scaled_in_metres(modes):
    solid = TotalLagrange(mesh=modes.mesh, material=STEEL)
    K = solid.tangent(np.zeros_like(modes.mesh.nodes))
    u = modes.displacements.reshape(modes.count, -1)
    energy = u @ (K @ u.T)
    # rounding of the eigenvectors, relative to the stiffest mode
    assert np.allclose(energy, np.diag(modes.stiffness), atol=1e-8 * modes.stiffness.max())
    theta, z = np.linspace(-np.pi, np.pi, 193), np.linspace(-0.033, 0.033, 33)
    largest = np.abs(modes.radial(theta, z)).max(axis=(0, 1))
    # 1 at a node; between nodes the quadratic interpolation may pass it by a little
    assert np.all(largest > 0.9)
    assert np.all(largest < 1.2)


@pytest.mark.parametrize(
    ("eps", "share", "phi"), [(0.5, 0.0, 0.3), (0.8, 0.6, 2.0), (0.7, 0.2, -1.1), (0.9, -0.4, 3.0)]
)
def test_tolerance_holds_for_film_pressures_in_and_outside_the_sample(modes, eps, share, phi):
    mesh = modes.mesh
    theta = np.linspace(-np.pi, np.pi, 96, endpoint=False)
    z = np.linspace(-0.033, 0.033, 33)
    T, Z = np.meshgrid(theta, 2 * z / 0.066, indexing="ij")
    local = eps + share * (1 - eps) * Z
    p = np.maximum(local * np.sin(T - phi), 0) / (1 + local * np.cos(T - phi)) ** 3 * (1 - Z**2)
    area = 0.03 * (2 * np.pi / 96) * np.full(33, z[1] - z[0])
    area[[0, -1]] /= 2
    H = mesh.bore.radial_interpolation(np.repeat(theta, 33), np.tile(z, 96))
    loads = np.zeros((len(mesh.nodes), 3))
    loads[mesh.bore.nodes] = (H.T @ (p * area).ravel()).reshape(-1, 3)
    exact = _on_grid(mesh, _solve(mesh, loads.reshape(-1, 1))[0], theta, z)
    S = modes.radial(theta, z)
    q = np.einsum("ijk,ij->k", S, p * area) / modes.stiffness
    error = np.abs(S @ q - exact).max() / np.abs(exact).max()
    # the promise holds at the sampled pressures; between the sampled directions and ratios it may double
    assert error < 2 * 0.02


def test_tighter_tolerance_takes_more_modes_and_aligned_films_fewer():
    counts = [bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=t)).count for t in (0.1, 0.05, 0.02)]
    assert counts[0] < counts[1] < counts[2]
    aligned = bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.02, tilted=False))
    assert aligned.count < 0.6 * counts[2]
    assert aligned.error <= 0.02


def test_stiffness_is_proportional_to_youngs_modulus(modes):
    soft = SaintVenantKirchhoff(youngs_modulus=2.1e9, poisson_ratio=0.3, density=7800.0)
    other = bore_modes(ModalBush(mesh=CYLINDER, material=soft, tolerance=0.02))
    assert other.count == modes.count
    # the same modes from a matrix scaled by 0.01; signs and order are fixed by the scaling to the peak
    assert np.allclose(np.sort(other.stiffness), 0.01 * np.sort(modes.stiffness), rtol=1e-6)


def test_sample_is_what_the_docstring_says():
    theta, zeta = np.array([2.0, 2.5, 3.0, 4.0]), np.array([0.0, 0.5, 0.0, 0.0])
    p = sample_pressures(theta, zeta, 8, False)
    assert p.shape == (4, 3 * 8)
    h = 1 + 0.5 * np.cos(theta)
    expected = np.maximum(np.sin(theta), 0) / h**3 * (1 - zeta**2)
    # first column: eps = 0.5, direction 0; peak over the points is 1
    assert np.allclose(p[:, 0], expected / expected.max())
    assert sample_pressures(theta, zeta, 8, True).shape == (4, 9 * 8)


def test_loads_carry_the_pressures_resultant():
    mesh = CYLINDER.mesh()
    loads = sample_loads(mesh.bore, len(mesh.nodes), 8, False)
    total = loads.reshape(len(mesh.nodes), 3, -1).sum(axis=0)
    # direct quadrature of p (cos, sin) over the true cylinder; 24 quadratic faces around are 1e-4 off the circle
    theta = np.linspace(-np.pi, np.pi, 720, endpoint=False)
    z = np.linspace(-0.033, 0.033, 201)
    p = sample_pressures(np.repeat(theta, 201), np.tile(2 * z / 0.066, 720), 8, False).reshape(720, 201, -1)
    line = np.trapezoid(p, z, axis=1) * 0.03 * 2 * np.pi / 720
    for k, direction in enumerate((np.cos(theta), np.sin(theta))):
        expected = direction @ line
        # the peaks that scale the sampled pressures are those at the quadrature's own points
        assert np.allclose(total[k], expected, rtol=0.03, atol=0.03 * np.abs(expected).max())
    assert np.allclose(total[2], 0.0, atol=1e-12 * np.abs(total[:2]).max())


@pytest.mark.parametrize(
    "wrong",
    [{"tolerance": 0.0}, {"tolerance": 0.5}, {"directions": 3}, {"tilted": 1}, {"mesh": 3}, {"material": 2.1e11}],
)
def test_wrong_values_are_named(wrong):
    given = {"mesh": CYLINDER, "material": STEEL} | wrong
    with pytest.raises(InputError, match=f"ModalBush.{next(iter(wrong))}"):
        ModalBush(**given)
