"""Products with the map S of a nodal bore, column by column in theta.

A column of the film's vertices has one normal, and several of its vertices move with the same node. S therefore is
known by pairs of a column and a node: the weights W of the node at the column's vertices, without directions, and

    S q = W (cos q_x + sin q_y),    S^T f = (cos, sin) W^T f,

half the products of a matrix with two columns per node.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.sparse import csr_matrix

from exudyn_ehd.film.banded.many_sides import TILE
from exudyn_ehd.film.grid import FilmGrid

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Columns(NamedTuple):
    """Pairs of a column in theta and a node that moves it, by columns.

    Attributes
    ----------
    height : int
        Vertices of a column, m.
    cos, sin : (n,) arrays
        The columns' normals.
    pair : (n + 1,) int array
        First pair of every column.
    node, vertex : (pairs,) int arrays
        The pair's node, and the first of the vertices that it moves, flat.
    entry : (pairs + 1,) int array
        First weight of every pair.
    weight : (entries,) array
        Of vertices that follow each other.
    """

    height: int
    cos: np.ndarray
    sin: np.ndarray
    pair: np.ndarray
    node: np.ndarray
    vertex: np.ndarray
    entry: np.ndarray
    weight: np.ndarray


def by_columns(values: csr_matrix, grid: FilmGrid) -> Columns:
    """Columns of values (n m, nodes) of the nodes at the vertices of an (n, m) grid."""
    n, m = grid.shape
    given, nodes = values.tocoo(), values.shape[1]
    pairs, own = np.unique(given.row.astype(np.int64) // m * nodes + given.col, return_inverse=True)
    low, high = np.full(pairs.size, n * m), np.zeros(pairs.size, dtype=np.int64)
    np.minimum.at(low, own, given.row)
    np.maximum.at(high, own, given.row + 1)
    entry = np.concatenate(([0], np.cumsum(high - low)))
    weight = np.zeros(entry[-1])
    weight[entry[own] + given.row - low[own]] = given.data
    first = np.searchsorted(pairs // nodes, np.arange(n + 1))
    return Columns(m, np.cos(grid.x), np.sin(grid.x), first, pairs % nodes, low, entry, weight)


@njit(cache=True, fastmath=_FAST)
def column_displacements(S, q, q_t, place_out, rate_out):
    """S q and S q_t (n m,) for q and q_t (2 nodes,), x and y of every node."""
    place_out[:] = 0.0
    rate_out[:] = 0.0
    for i in range(S.cos.size):
        for p in range(S.pair[i], S.pair[i + 1]):
            k, begin, end, v = 2 * S.node[p], S.entry[p], S.entry[p + 1], S.vertex[p]
            place, rate = S.cos[i] * q[k] + S.sin[i] * q[k + 1], S.cos[i] * q_t[k] + S.sin[i] * q_t[k + 1]
            for e in range(end - begin):
                place_out[v + e] += S.weight[begin + e] * place
                rate_out[v + e] += S.weight[begin + e] * rate


@njit(cache=True, fastmath=_FAST)
def column_loads(S, field, out):
    """S^T f (2 nodes,) of forces (n, m); columns where none act cost nothing."""
    out[:] = 0.0
    for i in range(S.cos.size):
        if not field[i].any():
            continue
        own = field[i]
        for p in range(S.pair[i], S.pair[i + 1]):
            begin, end, j, total = S.entry[p], S.entry[p + 1], S.vertex[p] - i * S.height, 0.0
            for e in range(end - begin):
                total += S.weight[begin + e] * own[j + e]
            out[2 * S.node[p]] += S.cos[i] * total
            out[2 * S.node[p] + 1] += S.sin[i] * total


@njit(cache=True, fastmath=_FAST)
def column_forces(S, forces, out):
    """Forces (nodes, 3) along x, y and z of forces (3, n m) along r, theta and z at the vertices."""
    out[:] = 0.0
    for i in range(S.cos.size):
        c, s = S.cos[i], S.sin[i]
        for p in range(S.pair[i], S.pair[i + 1]):
            begin, end, v, r, t, z = S.entry[p], S.entry[p + 1], S.vertex[p], 0.0, 0.0, 0.0
            for e in range(end - begin):
                w = S.weight[begin + e]
                r += w * forces[0, v + e]
                t += w * forces[1, v + e]
                z += w * forces[2, v + e]
            out[S.node[p], 0] += c * r - s * t
            out[S.node[p], 1] += s * r + c * t
            out[S.node[p], 2] += z


@njit(cache=True)
def put_sparse(indptr, indices, values, weight, first, out):
    """Rows of a CSR matrix (count, k) times ``weight`` (count,) to the columns from ``first`` on.

    ``out``: tiles (tiles, >= count, width), zero from there on.
    """
    wide = out.shape[2]
    for tile in range(first // wide, out.shape[0]):
        out[tile, : weight.size, max(first - tile * wide, 0) :] = 0.0
    for r in range(weight.size):
        for p in range(indptr[r], indptr[r + 1]):
            side = first + indices[p]
            out[side // wide, r, side % wide] = weight[r] * values[p]


@njit(cache=True, fastmath=_FAST)
def project_columns(S, stencil, fields, direct, out):
    """``X^T B S + D S`` (size, 2 nodes) for the first columns X (count, size) of tiles.

    Parameters
    ----------
    S : Columns
    stencil : (int, (columns m, 5) array, (columns m, 5) int array)
        B by vertices, see `exudyn_ehd.film.sensitivity.vertex_stencil.stencil_by_vertices`.
    fields : (tiles, rows, TILE) array
    direct : CSR matrix (size, n m)
        D as its indptr, indices and data.
    """
    first, by_vertex, row = stencil
    indptr, indices, data = direct
    size, k = out.shape
    n, m = S.cos.size, S.height
    # whole vectors
    known, wide = len(row) // m, min(size + -size % 8, TILE)
    at_vertices, sums, total = np.empty((n * m, wide)), np.empty((k, wide)), np.empty(wide)
    for tile in range((size + TILE - 1) // TILE):
        low = tile * TILE
        rows = min(TILE, size - low)
        acts = np.zeros(n, dtype=np.bool_)
        at_vertices[:] = 0.0
        sums[:] = 0.0
        for q in range(rows):
            for p in range(indptr[low + q], indptr[low + q + 1]):
                at_vertices[indices[p], q] += data[p]
                acts[indices[p] // m] = True
        X = fields[tile]
        for c in range(known):
            i = (first + c) % n
            acts[i] = True
            for j in range(m):
                v, target = c * m + j, at_vertices[i * m + j]
                w0, w1, w2, w3, w4 = by_vertex[v, 0], by_vertex[v, 1], by_vertex[v, 2], by_vertex[v, 3], by_vertex[v, 4]
                x0, x1, x2, x3, x4 = X[row[v, 0]], X[row[v, 1]], X[row[v, 2]], X[row[v, 3]], X[row[v, 4]]
                for q in range(wide):
                    target[q] += w0 * x0[q] + w1 * x1[q] + w2 * x2[q] + w3 * x3[q] + w4 * x4[q]
        for i in range(n):
            if acts[i]:
                _add_column(S, i, at_vertices, total, sums)
        for a in range(k):
            for q in range(rows):
                out[low + q, a] = sums[a, q]


@njit(cache=True, fastmath=_FAST)
def _add_column(S, i, at_vertices, total, sums_out):
    """Add the part of a column i in S^T times fields at the vertices (n m, r) to sums (2 nodes, r)."""
    wide = total.size
    for p in range(S.pair[i], S.pair[i + 1]):
        w, f = S.weight[S.entry[p] : S.entry[p + 1]], at_vertices[S.vertex[p] :]
        whole = w.size - w.size % 4
        total[:] = 0.0
        for e in range(0, whole, 4):
            w0, w1, w2, w3 = w[e], w[e + 1], w[e + 2], w[e + 3]
            f0, f1, f2, f3 = f[e], f[e + 1], f[e + 2], f[e + 3]
            for q in range(wide):
                total[q] += w0 * f0[q] + w1 * f1[q] + w2 * f2[q] + w3 * f3[q]
        for e in range(whole, w.size):
            w0, f0 = w[e], f[e]
            for q in range(wide):
                total[q] += w0 * f0[q]
        c, s, x, y = S.cos[i], S.sin[i], sums_out[2 * S.node[p]], sums_out[2 * S.node[p] + 1]
        for q in range(wide):
            x[q] += c * total[q]
            y[q] += s * total[q]
