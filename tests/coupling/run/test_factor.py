"""The factor of a system with meshes against a dense solution of the whole."""

import numpy as np
import pytest
from scipy.sparse import block_diag, csc_matrix, random_array

from exudyn_ehd.coupling.run.sparse import LARGEST_REST, SystemFactor


def system(rng, *, coupled, mesh=40, rest=9):
    """A mesh, and beside it a matrix without symmetry and with a zero on its diagonal."""
    A = rng.standard_normal((mesh, mesh))
    own = rng.standard_normal((rest, rest))
    if rest:
        own[-1, -1] = 0.0
    J = block_diag([A @ A.T + mesh * np.eye(mesh), own], format="lil")
    if coupled:
        J[:mesh, mesh:] = random_array((mesh, rest), density=0.3, rng=rng)
        J[mesh:, :mesh] = random_array((rest, mesh), density=0.3, rng=rng)
    places = rng.permutation(mesh + rest)
    is_mesh = (np.arange(mesh + rest) < mesh)[places]
    return csc_matrix(J)[places][:, places].tocsc(), is_mesh


@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("rest", [0, 1, 9, LARGEST_REST + 1])
def test_solution(coupled, rest):
    rng = np.random.default_rng(rest + 7 * coupled)
    J, is_mesh = system(rng, coupled=coupled, rest=max(rest, 0))
    if rest == 1:
        J = (J + csc_matrix(np.diag(1.0 * ~is_mesh))).tocsc()
    right = rng.standard_normal(J.shape[0])
    factor = SystemFactor(J, is_mesh, pivoting=0.01)
    assert factor.coupled == (rest > LARGEST_REST or (coupled and rest > 0))
    exact = np.linalg.solve(J.toarray(), right)
    # round-off, with pivots of a hundredth of the largest entry
    assert np.linalg.norm(factor.solve(right) - exact) < 1e-10 * np.linalg.norm(exact)


def test_without_a_mesh():
    rng = np.random.default_rng(5)
    J, is_mesh = system(rng, coupled=True)
    factor = SystemFactor(J, np.zeros_like(is_mesh), pivoting=0.01)
    right = rng.standard_normal(J.shape[0])
    assert factor.coupled and np.allclose(J @ factor.solve(right), right, atol=1e-8)


def test_the_rest_anew():
    rng = np.random.default_rng(6)
    J, is_mesh = system(rng, coupled=False)
    factor = SystemFactor(J, is_mesh, pivoting=0.01)
    assert not factor.coupled
    changed = (J + csc_matrix(np.diag(np.where(is_mesh, 0.0, 3.0)))).tocsc()
    factor.renew_rest(changed)
    right = rng.standard_normal(J.shape[0])
    exact = np.linalg.solve(changed.toarray(), right)
    assert np.linalg.norm(factor.solve(right) - exact) < 1e-10 * np.linalg.norm(exact)


def test_a_singular_rest_raises():
    J, is_mesh = system(np.random.default_rng(8), coupled=False)
    with pytest.raises(RuntimeError):
        SystemFactor((J @ csc_matrix(np.diag(1.0 * is_mesh))).tocsc(), is_mesh, pivoting=0.01)
