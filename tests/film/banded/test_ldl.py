"""The structured direct solver against a sparse reference, over rings, cuts and random sets of unknowns."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from exudyn_ehd.film.banded.factors import assemble_band, number_cells
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.linear_film import solve_linear


def _active_sets(n, m, seed):
    rng = np.random.default_rng(seed)
    inner = np.zeros((n, m), dtype=bool)
    inner[:, 1:-1] = True
    gap = inner.copy()
    gap[rng.integers(n) :][:3] = False
    one = np.zeros((n, m), dtype=bool)
    one[n // 2, m // 2] = True
    wrapped = inner.copy()
    wrapped[3 : n - 3] = False
    return {
        "ring": inner,
        "empty columns": gap,
        "across the seam": wrapped,
        "random": inner & (rng.random((n, m)) < 0.6),
        "sparse": inner & (rng.random((n, m)) < 0.15),
        "single": one,
        "nothing": np.zeros((n, m), dtype=bool),
    }


@pytest.mark.parametrize("name", list(_active_sets(12, 6, 0)))
@pytest.mark.parametrize("cut", (False, True))
@pytest.mark.parametrize(("n", "m"), [(12, 6), (13, 5), (16, 9), (17, 3)])
def test_against_sparse_solution(make_film, dense_matrix, name, cut, n, m):
    for seed in range(4):
        f = make_film(seed, n, m, cut=cut)
        active = _active_sets(n, m, seed)[name]
        w = Workspace(n, m)
        w.upper[:] = np.nan  # nothing may be read that was not written
        P = np.where(active, 0.0, np.random.default_rng(seed).normal(size=(n, m)))
        known = P.copy()
        ok, count, width = solve_linear((f.kx, f.kz, f.b), active, w.symmetric, w.unknowns, P)
        assert ok
        assert count == active.sum()
        assert width <= 2 * m
        a = active.ravel()
        A = sp.csr_matrix(dense_matrix(f.kx, f.kz))
        if count:
            rhs = f.b.ravel()[a] - A[a][:, ~a] @ known.ravel()[~a]
            expected = np.atleast_1d(spsolve(A[a][:, a].tocsc(), rhs))
            # Condition numbers stay below 1e4, rounding 1e-16.
            np.testing.assert_allclose(P[active], expected, rtol=1e-9, atol=1e-11)
        np.testing.assert_array_equal(P[~active], known[~active])


@pytest.mark.parametrize("cut", (False, True))
def test_numbering_and_band_are_the_matrix(make_film, dense_matrix, cut):
    for seed in range(5):
        f = make_film(seed, cut=cut)
        for active in _active_sets(12, 6, seed).values():
            w = Workspace(12, 6)
            count, width = number_cells(active, f.kx, w.order, w.number)
            assert sorted(w.order[:count]) == list(np.flatnonzero(active))
            assert (w.number[~active] == -1).all()
            np.testing.assert_array_equal(w.number.ravel()[w.order[:count]], np.arange(count))
            assemble_band(f.kx, f.kz, w.number, w.order, count, width, w.upper)
            A = np.zeros((count, count))
            for r in range(count):
                for d in range(min(width, count - 1 - r) + 1):
                    A[r, r + d] = A[r + d, r] = w.upper[r, d]
            o = w.order[:count]
            np.testing.assert_allclose(A, dense_matrix(f.kx, f.kz)[np.ix_(o, o)], atol=1e-13)


def test_a_singular_film_is_refused(make_film):
    # A ring without any prescribed pressure: the last pivot is zero up to rounding, an isolated vertex has none at all.
    f = make_film(9)
    w = Workspace(12, 6)
    zero, active = np.zeros_like(f.kx), np.ones((12, 6), dtype=bool)
    ok, _, _ = solve_linear((zero, zero, f.b), active, w.symmetric, w.unknowns, np.zeros((12, 6)))
    assert not ok
