"""Analysis and fronts against elimination written out on dense matrices, and triplets against scipy."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix, csc_matrix, diags, random_array

from exudyn_ehd.solid.linear.elimination import Elimination
from exudyn_ehd.solid.linear.supernodal import mesh_factor
from exudyn_ehd.solid.linear.tree import WIDEST, count_columns, elimination_tree
from exudyn_ehd.solid.linear.triplets import Triplets


def matrix(seed, size=1):
    """Symmetric, positive and negative pivots; of nodes with ``size`` coordinates."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 60))
    A = random_array((n, n), density=rng.choice([0.02, 0.1, 0.4]), rng=rng)
    A = np.kron((A + A.T + diags(np.ones(n))).toarray() != 0.0, np.ones((size, size)))
    A = A * rng.standard_normal(A.shape)
    A = csc_matrix(A + A.T + np.diag(rng.choice([-1.0, 1.0], len(A)) * (3.0 + 4.0 * len(A))))
    A.sort_indices()
    return A


def filled(A):
    """Pattern of L, column by column."""
    L = np.tril(A.toarray() != 0.0)
    for j in range(len(L)):
        below = np.flatnonzero(L[j + 1 :, j]) + j + 1
        L[np.ix_(below, below)] |= np.tri(len(below), dtype=bool)
    return L


@pytest.mark.parametrize("seed", range(8))
def test_tree_and_counts_are_those_of_the_filled_pattern(seed):
    A = matrix(seed)
    L = filled(A)
    parent = elimination_tree(A.indptr, A.indices)
    below = [np.flatnonzero(column) for column in (L & ~np.eye(len(L), dtype=bool)).T]
    assert parent.tolist() == [rows[0] if len(rows) else -1 for rows in below]
    assert count_columns(parent, A.indptr, A.indices).tolist() == L.sum(axis=0).tolist()


@pytest.mark.parametrize("size", [1, 3])
@pytest.mark.parametrize("seed", range(8))
def test_panels_are_the_factor(seed, size):
    A = matrix(seed, size)
    analysis = Elimination.of(A)
    panels, pivots = analysis.factorise(A.data)
    L = np.zeros(A.shape)
    for s, (a, b) in enumerate(zip(analysis.starts[:-1], analysis.starts[1:], strict=True)):
        rows, w = analysis.rows[analysis.firsts[s] : analysis.firsts[s + 1]], b - a
        assert 0 < w <= WIDEST and (np.diff(rows) > 0).all()
        square, below = np.split(panels[analysis.offsets[s] : analysis.offsets[s + 1]], [w * w])
        L[a:b, a:b] = np.tril(square.reshape(w, w).T)
        L[rows, a:b] = below.reshape(w, -1).T
    order = np.argsort(analysis.order)
    expected = A.toarray()[np.ix_(order, order)]
    np.testing.assert_allclose(L * pivots @ L.T, expected, atol=1e-12 * np.abs(expected).max())
    if size == 3:
        # coordinates of a node stay together
        assert (analysis.order.reshape(-1, 3) // 3 == analysis.order[::3, None] // 3).all()


def test_an_analysis_serves_as_long_as_the_pattern_stays():
    A, rng = matrix(3, 3), np.random.default_rng(1)
    known, right = mesh_factor(A).analysis, rng.standard_normal(A.shape[0])
    again = mesh_factor(2.0 * A, known)
    assert again.analysis is known
    np.testing.assert_allclose(2.0 * (A @ again.solve(right)), right, atol=1e-12)
    other = matrix(4, 3)
    assert mesh_factor(other, known).analysis is not known


def test_triplets_are_summed_whether_their_places_are_known_or_new():
    rng, triplets = np.random.default_rng(2), Triplets()
    for places in (rng.integers(0, 9, (2, 60)), rng.integers(0, 9, (2, 40))):
        for _ in range(4):
            values = rng.standard_normal(places.shape[1])
            found = triplets.matrix([(*places[:, :30], values[:30]), (*places[:, 30:], values[30:])], 9)
            expected = coo_matrix((values, tuple(places)), shape=(9, 9)).toarray()
            np.testing.assert_allclose(found.toarray(), expected, atol=1e-14)
            assert found.has_sorted_indices
