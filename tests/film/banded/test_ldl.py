"""The structured direct solver against a sparse reference, over rings, cuts and random sets of unknowns."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from exudyn_ehd.film.banded.factors import assemble_band, factor_band
from exudyn_ehd.film.banded.numbering import first_changed_row, number_cells
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
        w.band[:] = np.nan  # nothing may be read that was not written
        P = np.where(active, 0.0, np.random.default_rng(seed).normal(size=(n, m)))
        known = P.copy()
        ok, count, width = solve_linear((f.kx, f.kz, f.b), active, w.factor, w.unknowns, P)
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
            assemble_band(f.kx, f.kz, w.number, w.order, count, width, 0, w.band)
            A = np.zeros((count, count))
            for r in range(count):
                for d in range(min(width, count - 1 - r) + 1):
                    A[r, r + d] = A[r + d, r] = w.band[r, d]
            o = w.order[:count]
            np.testing.assert_allclose(A, dense_matrix(f.kx, f.kz)[np.ix_(o, o)], atol=1e-13)


@pytest.mark.parametrize("cut", (True, False))
def test_factoring_behind_the_first_change_gives_the_same_bits(make_film, cut):
    n, m = 24, 7
    f = make_film(11, n, m)
    rng = np.random.default_rng(12)
    for _ in range(60):
        old = np.ones((n, m), dtype=bool)
        if cut:
            old[2:5] = False
        old &= rng.random((n, m)) > 0.03
        new = old.copy()
        # changes anywhere, near the end, and none
        i, j = int(rng.integers(n)), int(rng.integers(m))
        new[i, j] = not new[i, j]
        w, full = Workspace(n, m), Workspace(n, m)
        _, count, width = _factor(f, old, w, 0, 1)
        w.old_order[:] = w.order
        got, expected = _factor(f, new, w, count, width), _factor(f, new, full, 0, 1)
        assert got == expected
        k, reach = got[1], got[2] + 1
        np.testing.assert_array_equal(w.band[:k, :reach], full.band[:k, :reach])
        np.testing.assert_array_equal(w.inv_diag[:k], full.inv_diag[:k])


def _factor(film, active, w, old_count, old_width):
    """Factor of the active vertices, from the first row that differs from the one at hand."""
    count, width = number_cells(active, film.kx, w.order, w.number)
    first = first_changed_row(w.order, w.old_order, old_count, count, width) if width == old_width else 0
    assemble_band(film.kx, film.kz, w.number, w.order, count, width, first, w.band)
    return factor_band(w.band, count, width, first, w.inv_diag), count, width


def test_a_singular_film_is_refused(make_film):
    # A ring without any prescribed pressure: the last pivot is zero up to rounding, an isolated vertex has none at all.
    f = make_film(9)
    w = Workspace(12, 6)
    zero, active = np.zeros_like(f.kx), np.ones((12, 6), dtype=bool)
    ok, _, _ = solve_linear((zero, zero, f.b), active, w.factor, w.unknowns, np.zeros((12, 6)))
    assert not ok
