"""Factor L D L^T of a symmetric matrix in dense panels, without pivoting, its pattern analysed once.

Multifrontal (I. S. Duff and J. K. Reid, ACM Transactions on Mathematical Software 9 (1983) 302): a supernode's columns,
w of them with b rows below, gather the matrix's entries and what the supernodes before leave for them in a dense front

    [F11      ]   [L11    ] [D     ] [L11^T  L21^T]
    [F21  F22 ] = [L21  I ] [    U ] [         I  ],    Y = L11^-1 F21^T,   L21^T = D^-1 Y,   U = F22 - L21 Y,

and U goes on to the supernode of the first row below. Products of dense matrices make nearly all of the work. The order
is SuperLU's of least degree, of a mesh that of its nodes, whose coordinates stay together; so that nodes of an element
that lie behind each other make wide supernodes, narrow ones are joined with what follows where few zeros come with it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.sparse import csc_matrix, identity, tril
from scipy.sparse.linalg import splu

from exudyn_ehd.solid.linear.tree import WIDEST, count_columns, elimination_tree, fill_rows, find_supernodes, postorder

# Columns of an update that are made at a time.
STRIP = 96
# Coordinates of a mesh's node.
NODE = 3


@dataclass(frozen=True, kw_only=True, eq=False)
class Elimination:
    """Order of elimination of a symmetric pattern, and the supernodes of its factor.

    Parameters
    ----------
    indptr, indices : arrays of int
        The pattern, in compressed columns with sorted rows.
    mirror : (nnz,) array of int
        Place of an entry's mirror image.
    order : (n,) array of int
        Place of a coordinate in the order of elimination.
    columns, lower, source : arrays of int
        Lower triangle in that order, in compressed columns: their starts, rows, and places among the matrix's entries.
    starts : (s + 1,) array of int
        First columns of the supernodes.
    firsts, offsets : (s + 1,) arrays of int
        Where rows and panels of the supernodes begin.
    rows : array of int
        Rows below the supernodes, sorted.
    """

    indptr: np.ndarray
    indices: np.ndarray
    mirror: np.ndarray
    order: np.ndarray
    columns: np.ndarray
    lower: np.ndarray
    source: np.ndarray
    starts: np.ndarray
    firsts: np.ndarray
    offsets: np.ndarray
    rows: np.ndarray

    @classmethod
    def of(cls, A: csc_matrix) -> Elimination | None:
        """Analyse a matrix with sorted rows; None if its pattern is not symmetric or lacks entries of its diagonal."""
        numbered = csc_matrix((np.arange(1.0, A.nnz + 1), A.indices, A.indptr), shape=A.shape)
        turned = numbered.T.tocsc()
        same = np.array_equal(turned.indptr, A.indptr) and np.array_equal(turned.indices, A.indices)
        if not same or not numbered.diagonal().all():
            return None
        places = least_degree(numbered)
        first = _permuted(numbered, places)
        places = postorder(elimination_tree(first.indptr, first.indices))[places]
        whole = _permuted(numbered, places)
        parent = elimination_tree(whole.indptr, whole.indices)
        starts, below = find_supernodes(parent, count_columns(parent, whole.indptr, whole.indices))
        width = np.diff(starts)
        firsts, offsets = (np.concatenate([[0], np.cumsum(x)]) for x in (below, width * (width + below)))
        rows = np.empty(firsts[-1], dtype=np.int64)
        fill_rows(starts, firsts, whole.indptr, whole.indices, rows)
        rows = rows[np.lexsort((rows, np.repeat(np.arange(len(below)), below)))]
        lower = csc_matrix(tril(whole))
        lower.sort_indices()
        return cls(
            indptr=A.indptr,
            indices=A.indices,
            mirror=turned.data.astype(np.int64) - 1,
            order=places,
            columns=lower.indptr,
            lower=lower.indices,
            source=lower.data.astype(np.int64) - 1,
            starts=starts,
            firsts=firsts,
            offsets=offsets,
            rows=rows,
        )

    def fits(self, A: csc_matrix) -> bool:
        """Whether a matrix with sorted rows has this pattern."""
        return np.array_equal(self.indptr, A.indptr) and np.array_equal(self.indices, A.indices)

    def factorise(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Panels and pivots of the matrix with these entries, not finite if a pivot is zero."""
        panels, pivots = np.zeros(self.offsets[-1]), np.empty(len(self.order))
        structure = self.columns, self.lower, self.source, self.starts, self.firsts, self.offsets, self.rows
        factorise(*structure, values, panels, pivots)
        return panels, pivots


def least_degree(A: csc_matrix) -> np.ndarray:
    """Places (n,) in SuperLU's order of least degree for a symmetric pattern; coordinates of a node stay together."""
    n = A.shape[0]
    columns = np.repeat(np.arange(n), np.diff(A.indptr))
    for size in (NODE, 1):
        nodes = csc_matrix((np.ones(A.nnz), (A.indices // size, columns // size)), shape=(-(-n // size),) * 2)
        if n % size == 0 and nodes.nnz * size * size == A.nnz:
            break
    # any numbers that need no pivoting do
    nodes.data[:] = -1.0
    dominant = (nodes + (nodes.shape[0] + 1.0) * identity(nodes.shape[0])).tocsc()
    found = splu(dominant, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}).perm_c
    return (size * found[:, None].astype(np.int64) + np.arange(size)).ravel()


def _permuted(A: csc_matrix, places: np.ndarray) -> csc_matrix:
    order = np.argsort(places)
    permuted = A[:, order].tocsr()[order].tocsc()
    permuted.sort_indices()
    return permuted


@njit(cache=True, fastmath={"contract", "reassoc"})
def _factorise_triangle(F, inverse_out, pivots_out):
    """L below the diagonal of a front's columns F[column, row] (w, w) and D, and L^-1 row by row."""
    w = len(F)
    for j in range(w):
        pivots_out[j] = F[j, j]
        for k in range(j + 1, w):
            share = F[j, k] / F[j, j]
            for i in range(k, w):
                F[k, i] -= share * F[j, i]
        for i in range(j + 1, w):
            F[j, i] /= pivots_out[j]
        F[j, j] = 1.0
    inverse_out[:] = 0.0
    for i in range(w):
        inverse_out[i, i] = 1.0
        for k in range(i):
            for j in range(k + 1):
                inverse_out[i, j] -= F[k, i] * inverse_out[k, j]


@njit(cache=True)
def _add_update(update, rows, place, w, front_out, below_out, rest_out):
    """Add an update U[column, row] (b, b), of which row >= column counts, to a front of w columns."""
    own, size = 0, len(rows)
    while own < size and place[rows[own]] < w:
        own += 1
    for k in range(own):
        column = place[rows[k]]
        for i in range(k, own):
            front_out[column, place[rows[i]]] += update[k, i]
        for i in range(own, size):
            below_out[column, place[rows[i]] - w] += update[k, i]
    for k in range(own, size):
        column = place[rows[k]] - w
        for i in range(k, size):
            rest_out[column, place[rows[i]] - w] += update[k, i]


@njit(cache=True)
def _most_waiting(starts, firsts, rows):
    """Entries of all updates that wait at a time, at most, and how many."""
    waiting, children, size, most = np.empty(len(starts), dtype=np.int64), 0, 0, 0
    for s in range(len(starts) - 1):
        while children and rows[firsts[waiting[children - 1]]] < starts[s + 1]:
            children -= 1
            size -= (firsts[waiting[children] + 1] - firsts[waiting[children]]) ** 2
        if firsts[s + 1] > firsts[s]:
            waiting[children] = s
            children += 1
            size += (firsts[s + 1] - firsts[s]) ** 2
            most = max(most, size)
    return most


@njit(cache=True)
def factorise(columns, lower, source, starts, firsts, offsets, rows, values, panels_out, pivots_out):
    """L D L^T in panels.

    Parameters
    ----------
    columns, lower, source, starts, firsts, offsets, rows : as in `Elimination`
    values : (nnz,) entries of the matrix
    panels_out : triangle of every supernode as a full square, then its rows below, column by column; zero
    pivots_out : (n,)
    """
    place, waiting, children, size = np.empty(starts[-1], np.int64), np.empty(len(starts), np.int64), 0, 0
    stack = np.empty(_most_waiting(starts, firsts, rows))
    most = np.diff(firsts).max()
    rests, answers, products = np.empty(most * most), np.empty(WIDEST * most), np.empty(STRIP * most)
    for s in range(len(starts) - 1):
        a, end = starts[s], starts[s + 1]
        w, own = end - a, rows[firsts[s] : firsts[s + 1]]
        b = len(own)
        square = panels_out[offsets[s] : offsets[s] + w * w].reshape(w, w)
        below = panels_out[offsets[s] + w * w : offsets[s + 1]].reshape(w, b)
        rest, Y = rests[: b * b].reshape(b, b), answers[: w * b].reshape(w, b)
        for k in range(b):
            rest[k, k:] = 0.0
        for j in range(w):
            place[a + j] = j
        for i in range(b):
            place[own[i]] = w + i
        for j in range(w):
            for p in range(columns[a + j], columns[a + j + 1]):
                row = place[lower[p]]
                if row < w:
                    square[j, row] += values[source[p]]
                else:
                    below[j, row - w] += values[source[p]]
        while children and rows[firsts[waiting[children - 1]]] < end:
            children -= 1
            left = rows[firsts[waiting[children]] : firsts[waiting[children] + 1]]
            size -= len(left) ** 2
            update = stack[size : size + len(left) ** 2].reshape(len(left), len(left))
            _add_update(update, left, place, w, square, below, rest)
        inverse = np.empty((w, w))
        _factorise_triangle(square, inverse, pivots_out[a:end])
        if b:
            np.dot(inverse, below, Y)
            for j in range(w):
                for i in range(b):
                    below[j, i] = Y[j, i] / pivots_out[a + j]
            for c in range(0, b, STRIP):
                # of a symmetric matrix the part to the right of a strip's first column
                strip = np.ascontiguousarray(below[:, c : c + STRIP])
                wide = strip.shape[1]
                product = products[: wide * (b - c)].reshape(wide, b - c)
                np.dot(strip.T, np.ascontiguousarray(Y[:, c:]), product)
                for k in range(wide):
                    for i in range(k, b - c):
                        stack[size + (c + k) * b + c + i] = rest[c + k, c + i] - product[k, i]
            waiting[children] = s
            children += 1
            size += b * b
