"""Gap of a rigid journal in a bore, also with steps, and derivatives of a film's balances to the gap.

``H = 1 - (x + bx z) cos theta - (y + by z) sin theta (+ extra)`` in scaled lengths: x, y divided by c; z by R; bx, by
multiplied by R/c. These are Eqs. (3), (5), (7) of Flores' paper. The gap's rate at fixed theta is the same expression
in the rates, without the 1.

Symbols: pose = (x, y, bx, by) scaled, cos_x / sin_x at vertices, cos_f / sin_f at the links i -> i+1, z (m,) vertices.

Gaps with steps (pockets, textures, edges of grooves)
-----------------------------------------------------
A link between two vertices consists of two halves with gaps h1 and h2. The flow is the same in both,

    q = V h1 - h1^3 (pf - p1) / (ds / 2) = V h2 - h2^3 (p2 - pf) / (ds / 2),

or, with the pressure pf on the face eliminated,

    q = V c - g (p2 - p1) / ds,   g = 2 / (1/h1^3 + 1/h2^3),   c = (1/h1^2 + 1/h2^2) / (1/h1^3 + 1/h2^3).

The flow over a step is then exact if the gap is constant on both sides; for a smooth gap it is of second order. Without
this model the mean gap of both vertices is used, which is of first order at a step.

Derivatives of balances and other sums over the film to the gaps, at fixed unknowns
-----------------------------------------------------------------------------------
Let DX and DZ be the derivatives of a link's flow to its gap (`exudyn_ehd.film.reynolds.balance`), AC and AR those of
the storage to the gap and to its rate. The balance of vertex (i, j) between rigid surfaces changes by

    dr = DX_i dHF_i - DX_i-1 dHF_i-1 + DZ_j dHZ_j - DZ_j-1 dHZ_j-1 + AC dH + AR dH_t,   HF gap on links in theta,
    HZ mean over the two ends of a link in z,

and similarly with the speeds of the surfaces. With an elastic liner the flow over a link also depends on the gaps at
its ends. A rupture line inside the cells adds entries of the same form. The gap is a sum of shapes,
``H = 1 + sum q_k S_k``, whose coefficients q are the journal's pose or a bore's coordinates. Derivatives to q are those
to the gap times S, at vertices and on links. The gradient of a functional with the adjoint lam is ``-lam . dr``.

Differences and sums over the links
-----------------------------------
Links lead from a vertex to the next one in theta, around the ring, and to the next one in z. Values on links are
(2, ..., n, m), those in theta first; behind the last row there is no link in z, and its value has to be zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.sparse import csr_matrix

from exudyn_ehd.compilation import FAST
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux


@njit(cache=True, fastmath=FAST)
def rigid_gap(pose, cos_x, sin_x, z, base, H_out):
    """Gap ``base - e(z) . n`` of a rigid journal at the angles given by cos_x, sin_x: H_out (n, m)."""
    for i in range(cos_x.size):
        level = base - pose[0] * cos_x[i] - pose[1] * sin_x[i]
        slope = pose[2] * cos_x[i] + pose[3] * sin_x[i]
        for j in range(z.size):
            H_out[i, j] = level - slope * z[j]


@njit(cache=True)
def largest_eccentricity(pose, half_length):
    """Largest distance of the journal axis from the bearing axis, scaled by c; it is reached at one of the ends."""
    worst = 0.0
    for s in (-half_length, half_length):
        ex = pose[0] + pose[2] * s
        ey = pose[1] + pose[3] * s
        worst = max(worst, np.sqrt(ex * ex + ey * ey))
    return worst


@njit(cache=True, inline="always")
def rigid_gaps(pose, rate, squeeze, at, half_length, closed, H, HF, H_t):
    """Set the gaps of a rigid journal at vertices and links, with ``squeeze`` also their rate; returns the minimum film
    thickness.

    ``at``: `exudyn_ehd.film.grid.FilmGrid.directions`; ``closed``: whether the grid is a ring. For a ring the minimum
    is exact, for arcs it is that of vertices and links; the link behind an arc's last column lies on that column.
    """
    cos_x, sin_x, cos_f, sin_f, z = at
    rigid_gap(pose, cos_x, sin_x, z, 1.0, H)
    rigid_gap(pose, cos_f, sin_f, z, 1.0, HF)
    if squeeze:
        rigid_gap(rate, cos_x, sin_x, z, 0.0, H_t)
    if closed:
        return 1.0 - largest_eccentricity(pose, half_length)
    return min(H.min(), HF.min())


def gap_slopes(field: np.ndarray, grid: FilmGrid) -> tuple[np.ndarray, np.ndarray]:
    """Mean on the links in theta (n, m), and slopes (2, n, m) in theta and in scaled z, of a field (n, m).

    Central differences, one-sided at the ends of z and at columns without a link: of second order inside on any spacing
    of z, of first order at its ends. Behind a column without a link its own values replace those of the next column.
    """
    before, after = grid.beside
    ahead = field[after]
    along = (ahead - field[before]) / (2.0 * grid.width_x[:, None])
    return 0.5 * (field + ahead), np.stack((along, field @ grid.differences_z.T))


def transposed_slopes(field: np.ndarray, grid: FilmGrid) -> np.ndarray:
    """Transpose of the slopes of `gap_slopes` on a ring.

    The sums of the returned fields (2, n, m) times a gap term are those of ``field`` (n, m) times the term's slopes.
    """
    along = field / (2.0 * grid.width_x[:, None])
    return np.stack((np.roll(along, 1, axis=0) - np.roll(along, -1, axis=0), field @ grid.differences_z))


def add_gap(
    field: np.ndarray, rate: np.ndarray, grid: FilmGrid, H: np.ndarray, HF: np.ndarray, H_t: np.ndarray
) -> tuple[float, np.ndarray]:
    """Add an elastic gap (n, m) and its rate to the gaps and their rate.

    Returns the minimum film thickness, and the slopes (2, n, m) of `gap_slopes`.
    """
    link, slopes = gap_slopes(field, grid)
    H += field
    HF += link
    H_t += rate
    return float(min(H.min(), HF.min())), slopes


class SteppedGap(FluxEffect):
    """Flux effect for gaps with steps: every link consists of two halves of constant gap.

    For prescribed gaps only: the derivatives with respect to the link's gap are left at zero.

    Parameters
    ----------
    H : (n, m) array
        The film solver's gap at the vertices, read at every solution.
    """

    changes_carriers = True
    depends_on_speed = False

    def __init__(self, H: np.ndarray) -> None:
        self.H = H

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Replace conductances and carriers of all links."""
        stepped_links(self.H, flux.gx, flux.cx, flux.gz, flux.cz)
        flux.gx_h[:] = flux.cx_h[:] = flux.gz_h[:] = flux.cz_h[:] = 0.0


def stepped_links(
    H: np.ndarray, gx_out: np.ndarray, cx_out: np.ndarray, gz_out: np.ndarray, cz_out: np.ndarray
) -> None:
    """Set conductance and carrier of all links (n, m) from the gaps at the vertices."""
    H3 = H * H * H
    for axis, g, c in ((0, gx_out, cx_out), (1, gz_out, cz_out)):
        b, b3 = np.roll(H, -1, axis), np.roll(H3, -1, axis)
        g[:], c[:] = 2.0 * H3 * b3 / (H3 + b3), (H * b3 + b * H3) / (H3 + b3)


class Gradients(NamedTuple):
    """Derivatives of sums over a film, in c entries.

    Attributes
    ----------
    rows, places : (c,) int arrays
        Number of the sum to which an entry is added, such as the balance of an unknown, and flat index of its vertex.
    by : (10, c) array
        Derivatives, by row: (0, 1) to the gaps on the links in theta behind and before the vertex; (2, 3, 4) to the
        gaps at the vertex, and at the next and the previous one in z; (5) to the rate of the gap at the vertex; (6, 7)
        to vx and vz; (8, 9) to the gaps at the next and the previous vertex in theta.
    """

    rows: np.ndarray
    places: np.ndarray
    by: np.ndarray

    def weighed(self, weights: np.ndarray, rows: np.ndarray | None = None) -> Gradients:
        """Multiply the entries by ``weights`` (n, m) and add each to the sum ``rows`` (n m,) of its vertex; None: one
        sum over all."""
        at = np.zeros_like(self.places) if rows is None else rows[self.places]
        return Gradients(at, self.places, self.by * weights.reshape(-1)[self.places])

    def to_true_gap(self, slope: np.ndarray, bend: np.ndarray, face_slope: np.ndarray) -> Gradients:
        """Convert derivatives to the film's gap of a limiter into derivatives to the true gap.

        ``slope``, ``face_slope`` (n, m): derivatives of the film's gap to the true gap at vertices and on links in
        theta; ``bend``: second derivative at vertices, times the rate of the true gap.
        """
        (n, m), by = slope.shape, self.by.copy()
        i, j = np.divmod(self.places, m)
        by[0] *= face_slope[i, j]
        by[1] *= face_slope[i - 1, j]
        by[2] = by[2] * slope[i, j] + by[5] * bend[i, j]
        by[3] *= slope[i, np.minimum(j + 1, m - 1)]
        by[4] *= slope[i, np.maximum(j - 1, 0)]
        by[5] *= slope[i, j]
        by[8] *= slope[(i + 1) % n, j]
        by[9] *= slope[i - 1, j]
        return self._replace(by=by)

    def columns(self, shapes: np.ndarray, count: int) -> np.ndarray:
        """Derivatives (10, count) of the sums to (scaled pose, scaled rates, vx, vz); ``shapes``:
        `FilmGrid.gap_shapes`."""
        out = np.zeros((10, count))
        add_columns(self.rows, self.places, self.by, shapes, out)
        return out

    def matrix(self, shape: tuple[int, int], count: int, by_gap: float, by_rate: float) -> csr_matrix:
        """Return ``by_gap d/dH + by_rate d/dH_t`` (count, n m) of the sums, to gaps and rates at the vertices."""
        (n, m), on, back, own, above, below, rate = shape, *self.by[:6]
        # the gap on a link in theta is the mean of both ends
        on_next, on_last = 0.5 * on + self.by[8], 0.5 * back + self.by[9]
        weights = by_gap * np.array((own + 0.5 * (on + back), on_next, on_last, above, below))
        weights[0] += by_rate * rate
        # entries for vertices beyond the ends are 0
        around = (self.places + np.array([[0], [m], [-m], [1], [-1]])) % (n * m)
        return csr_matrix((weights.ravel(), (np.tile(self.rows, 5), around.ravel())), shape=(count, n * m))

    def fields(self, rows: np.ndarray, shape: tuple[int, int]) -> tuple[np.ndarray, ...]:
        """Gradients ``-rows . dr`` of k functionals with the weights ``rows`` (k, count).

        Returns
        -------
        cell, face, rate : (k, n, m) arrays
            Derivatives to the gaps at vertices and on links in theta, and to the gap's rate at vertices.
        speed : (k, 2) array
            Derivatives to vx and vz.
        """
        out = *np.zeros((3, len(rows), *shape)), np.zeros((len(rows), 2))
        _add_fields(rows, self.rows, self.places, self.by, *out)
        return out


def join(a: Gradients, b: Gradients) -> Gradients:
    """Return the entries of both."""
    rows, places = np.concatenate((a.rows, b.rows)), np.concatenate((a.places, b.places))
    return Gradients(rows, places, np.concatenate((a.by, b.by), axis=1))


@njit(cache=True, fastmath=FAST)
def _ends(by_h, by_d, a, b, follows, gap):
    """Return the derivatives of a link's flow to the undeformed gaps at its ends a and b.

    ``by_h``, ``by_d``: derivatives to the link's gap and to d, see `exudyn_ehd.film.reynolds.balance`. Row
    ``gap`` of ``follows`` is the derivative of the gap to the undeformed one, row 1 that of E. None: rigid surfaces.
    """
    if follows is None:
        return 0.5 * by_h, 0.5 * by_h
    here, there = by_h * follows[gap, a] - by_d * follows[1, a], by_h * follows[gap, b] + by_d * follows[1, b]
    return 0.5 * here, 0.5 * there


@njit(cache=True, fastmath=FAST)
def link_rows(order, count, m, by, by_speed, follows, storage, out):
    """Set the derivatives ``out`` (10, count) of the balances at vertices ``order``, see `Gradients.by`.

    Parameters
    ----------
    by, by_speed : (4, n m) and (3, n m) arrays
        Derivatives of the links' flows, see `exudyn_ehd.film.reynolds.balance`.
    follows : (4, n m) array or None
        With a liner: derivatives of deflection, E and film gap to the undeformed gap, and of the film's gap on a link
        to the true gap there; None: rigid surfaces.
    storage : two (n, m) arrays
        Derivatives of the storage to the gap's rate and to the gap.
    """
    rate, stored, size = storage[0].reshape(-1), storage[1].reshape(-1), by.shape[1]
    for r in range(count):
        c = order[r]
        on, up = c + m if c + m < size else c + m - size, c + 1 if c + 1 < size else 0
        back, down = c - m if c >= m else c - m + size, c - 1 if c > 0 else size - 1
        face, before, own = by[0, c], by[0, back], stored[c]
        out[8, r] = out[9, r] = 0.0
        if follows is not None:
            face, before = face * follows[3, c], before * follows[3, back]
            here, there = _ends(face, by[1, c], c, on, follows, 0)
            behind, at = _ends(before, by[1, back], back, c, follows, 0)
            own += here - at
            out[8, r], out[9, r] = there, -behind
        # the derivatives of links in z beyond the ends are 0
        here, there = _ends(by[2, c], by[3, c], c, up, follows, 2)
        behind, at = _ends(by[2, down], by[3, down], down, c, follows, 2)
        out[0, r], out[1, r], out[2, r], out[3, r], out[4, r] = face, -before, own + here - at, there, -behind
        out[5, r] = rate[c]
        out[6, r] = by_speed[0, c] - by_speed[0, back] + by_speed[2, c] - by_speed[2, down]
        out[7, r] = by_speed[1, c] - by_speed[1, down]


@njit(cache=True, fastmath=FAST)
def add_columns(rows, places, by, shapes, out):
    """Add the derivatives (10, count) of the sums to the motion to ``out``, see `Gradients.columns`."""
    at, link = shapes[0].reshape(-1), shapes[1].reshape(-1)
    # flat unsigned indices need no check of their sign
    size, column, row = np.uint64(at.size), np.uint64(4 * shapes.shape[2]), np.uint64(4)
    for e in range(rows.size):
        r, c = rows[e], row * np.uint64(places[e])
        on, back = (
            c + column if c + column < size else c + column - size,
            c - column if c >= column else c + size - column,
        )
        # entries for vertices beyond the ends are 0
        above, below = c + row if c + row < size else c, c - row if c >= row else c
        f0, f1, own, a0, a1, rate, x0, x1 = (
            by[0, e],
            by[1, e],
            by[2, e],
            by[3, e],
            by[4, e],
            by[5, e],
            by[8, e],
            by[9, e],
        )
        for q in range(4):
            k = np.uint64(q)
            gaps = f0 * link[c + k] + f1 * link[back + k] + own * at[c + k] + a0 * at[above + k] + a1 * at[below + k]
            out[q, r] += gaps + x0 * at[on + k] + x1 * at[back + k]
            out[4 + q, r] += rate * at[c + k]
        out[8, r] += by[6, e]
        out[9, r] += by[7, e]


@njit(cache=True)
def _add_fields(lam, rows, places, by, cell, face, rate, speed):
    """Add the gradients of `Gradients.fields`."""
    _, n, m = cell.shape
    for e in range(rows.size):
        i, j = places[e] // m, places[e] % m
        # entries for vertices beyond the ends are 0
        on, back, above, below = (i + 1) % n, (i - 1) % n, min(j + 1, m - 1), max(j - 1, 0)
        for k in range(len(lam)):
            w = -lam[k, rows[e]]
            face[k, i, j] += w * by[0, e]
            face[k, back, j] += w * by[1, e]
            cell[k, i, j] += w * by[2, e]
            cell[k, i, above] += w * by[3, e]
            cell[k, i, below] += w * by[4, e]
            cell[k, on, j] += w * by[8, e]
            cell[k, back, j] += w * by[9, e]
            rate[k, i, j] += w * by[5, e]
            speed[k, 0] += w * by[6, e]
            speed[k, 1] += w * by[7, e]


@njit(cache=True, fastmath=FAST)
def functional_gradients(lam, columns, out):
    """Set the gradients ``-lam . dr`` (k, 10) of k functionals with the adjoints lam (k, count), for dr (10, count)."""
    for k in range(lam.shape[0]):
        own = lam[k]
        for q in range(columns.shape[0]):
            column, total = columns[q], 0.0
            for r in range(own.size):
                total -= own[r] * column[r]
            out[k, q] = total


def following(P: np.ndarray) -> np.ndarray:
    """Return the values (2, n, m) of a field at the next vertex in theta and z; the last row in z keeps its own."""
    out = np.array((P, P))
    out[0, :-1], out[0, -1] = P[1:], P[0]
    out[1, :, :-1] = P[:, 1:]
    return out


def on_links(P: np.ndarray) -> np.ndarray:
    """Return the mean of a field at both ends of the links (2, n, m)."""
    return 0.5 * (P + following(P))


def drops(P: np.ndarray) -> np.ndarray:
    """Return the differences on the links (2, n, m): field P (n, m) less its value at the next vertex."""
    return P - following(P)


def drop_weights(links: np.ndarray) -> np.ndarray:
    """Transpose of `drops`: weights of P (2, ..., n, m) in the sums of ``links`` times `drops`, in theta and in z.

    For flows on the links, the sum over both directions is the outflow of the vertices.
    """
    out, (x, z) = links.copy(), links
    out[0, ..., 1:, :] -= x[..., :-1, :]
    out[0, ..., 0, :] -= x[..., -1, :]
    out[1, ..., 1:] -= z[..., :-1]
    return out


def to_ends(values: np.ndarray, axis: int) -> np.ndarray:
    """Transpose of the mean of both ends: half of the value of every link along an axis, added at each of its ends."""
    out = values.copy()
    ends, links = out.swapaxes(0, axis), values.swapaxes(0, axis)
    ends[1:] += links[:-1]
    ends[0] += links[-1]
    return 0.5 * out
