"""Panels against SuperLU's own substitutions and a dense solution, and what they are refused for."""

import numpy as np
import pytest
from scipy.sparse import csc_matrix, diags, random_array
from scipy.sparse.linalg import SuperLU

from exudyn_ehd.solid.linear.supernodal import SupernodalFactor, mesh_factor, sparse_factor
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.modes.static import held_stiffness
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange


def stiffness(seed=3):
    mesh = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.06, axial=2, radial=1, circumferential=12).mesh()
    steel = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    return held_stiffness(TotalLagrange(mesh=mesh, material=steel))[1], np.random.default_rng(seed)


def plain(L, pivots, right):
    """L D L^T x = right, column by column."""
    x = right.copy()
    for j in range(len(x)):
        x[j + 1 :] -= L[j + 1 :, j] * x[j]
    x /= pivots
    for j in reversed(range(len(x))):
        x[j] -= L[j + 1 :, j] @ x[j + 1 :]
    return x


def symmetric(rng, n, density):
    """Positive and negative pivots, patterns without structure, widths of supernodes from one on."""
    A = random_array((n, n), density=density, rng=rng)
    return csc_matrix(A + A.T + diags(rng.choice([-1.0, 1.0], n) * (2.0 + n * density)))


def test_a_mesh_in_panels():
    K, rng = stiffness()
    right = rng.standard_normal(K.shape[0])
    factor, reference = mesh_factor(K), sparse_factor(K)
    assert isinstance(factor, SupernodalFactor)
    order = np.argsort(reference.perm_r)
    expected = plain(reference.L.toarray(), reference.U.diagonal(), right[order])[reference.perm_r]
    # rounding of the condition, below 1e5
    assert np.allclose(factor.solve(right), expected, rtol=0.0, atol=1e-11 * np.abs(expected).max())
    # half of SuperLU's memory
    assert factor.nbytes < 0.6 * 12 * (reference.L.nnz + reference.U.nnz)


def test_many_sides_are_one_after_the_other():
    K, rng = stiffness()
    factor, right = mesh_factor(K), rng.standard_normal((K.shape[0], 7))
    each = np.column_stack([factor.solve(column) for column in right.T])
    assert np.allclose(factor.solve(right), each, rtol=0.0, atol=1e-11 * np.abs(each).max())


@pytest.mark.parametrize("seed", range(12))
def test_random_matrices(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 120))
    A = symmetric(rng, n, rng.choice([0.0, 0.02, 0.1, 0.6]))
    right = rng.standard_normal(n)
    factor = mesh_factor(A)
    assert isinstance(factor, SupernodalFactor)
    assert np.allclose(factor.solve(right), np.linalg.solve(A.toarray(), right), rtol=1e-9, atol=1e-12)


def test_what_is_not_symmetric_stays_with_superlu():
    K, rng = stiffness()
    K = K.tolil()
    K[0, 1] += 1e-3 * K[0, 0]
    factor, right = mesh_factor(K), rng.standard_normal(K.shape[0])
    assert isinstance(factor, SuperLU)
    assert np.allclose(K.tocsr() @ factor.solve(right), right, rtol=0.0, atol=1e-8)


def test_single_precision_only_where_it_is_enough():
    K, rng = stiffness()
    factor, right = mesh_factor(K), rng.standard_normal(K.shape[0])
    single = factor.rounded(1e-4)
    assert single.panels.dtype == np.float32 and factor.rounded(1e-12) is factor
    exact = factor.solve(right)
    # the probe's error stands for others to a factor of ten
    assert np.linalg.norm(single.solve(right) - exact) < 1e-3 * np.linalg.norm(exact)


def test_a_singular_matrix_raises():
    with pytest.raises(RuntimeError):
        mesh_factor(csc_matrix((3, 3)))
