"""Swift-Stieber's rupture line inside a cell: the film's balance as it is where its edge lies between two vertices.

Where the film ends its pressure is a parabola, ``p = q d^2 / 2`` with the distance d to the line. Of a vertex let ``f``
be what wedge and squeeze take away (minus the right-hand side of `exudyn_ehd.film.reynolds.links`) and ``k`` the mean
conductance of its two links in theta, so that ``q = f / (k h^2)`` with the distance h of two columns. If the line lies
s cells beyond a vertex, 0 < s < 1, then ``p = q h^2 s^2 / 2`` there. The parabola, continued beyond the line, meets
the scheme's balance exactly; but the scheme has the cavity's pressure at the next vertex, not the parabola's value
``q h^2 (1 - s)^2 / 2``. So the true film leaves in the balance of the last vertex

    N = f (1 - s)^2 / 2,    s = sqrt(2 k p / f),    for 0 < s < 1, else nothing,

and the film solves ``A P - b - N(P) = 0`` where it is not ruptured. A vertex joins at s = 0 when its own balance falls
below f / 2. The matrix stays symmetric, and an M-matrix, since

    -dN/dp = k (1 - s) / s,    dN/df = (1 - s) / 2,    dN/dk = -f s (1 - s) / (2 k),

the first of which makes the outer link as long as it is, s h. N falls with p and is convex, so that there is one
solution. Pressures are continuous in the motion, and forces have continuous derivatives.

N is zero where the wedge builds pressure up (f <= 0), in films at rest, without pressure flow in theta, and next to
columns with prescribed pressure, in which no line is to be looked for.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.gradients import Gradients
from exudyn_ehd.film.grid import Mesh
from exudyn_ehd.film.kernels import FAST
from exudyn_ehd.film.reynolds.links import LinkFlux

# Smallest s of a vertex in the film, as dp/ds vanishes at 0: what lies below is the rounding of its neighbours'
# pressures.
LEAST = 1e-8


def straight(shape: tuple[int, int]) -> np.ndarray:
    """Return the fields (9, n m) of a `RuptureLine` that lies at no vertex."""
    fields = np.zeros((9, shape[0] * shape[1]))
    fields[6] = 1.0
    return fields


class RuptureLine:
    """The rupture line of one film.

    Parameters
    ----------
    block : (9, n m) array
        Its fields; see below.
    shape : (int, int)

    Attributes
    ----------
    block : (9, n m) array
        Fields of `exudyn_ehd.film.cavitation.oil_line.CurveFields`: f is 0 where there can be no line, and s is 1 where
        there is none.
    whole : (n m,) array
        Pressure above the cavity's at s = 1.
    f, k, s : (n, m) arrays
        Of ``block``.
    """

    def __init__(self, block: np.ndarray, shape: tuple[int, int]) -> None:
        self.block, self.whole = block, block[4]
        self.f, self.k, self.s = (block[row].reshape(shape) for row in (0, 1, 6))

    def gradients(
        self,
        work: Workspace,
        gaps: tuple[np.ndarray, np.ndarray],
        flux: LinkFlux | None,
        speeds: tuple[float, float],
        flow_x: float,
        squeeze: bool,
        mesh: tuple[np.ndarray, ...],
    ) -> Gradients:
        """`Gradients` of -N in the last solution's balances, to the film's ``gaps`` at vertices and links."""
        slopes, by_speed = (None, None) if flux is None else (flux.slopes, flux.by_speed)
        return Gradients(*line_rows(self.block, work.number, *gaps, slopes, by_speed, *speeds, flow_x, squeeze, mesh))


@njit(cache=True, inline="always")
def line_terms(kx, b, fixed, in_cells, line):
    """f and k of all vertices, and what follows from them; f = 0 where the line is not looked for ``in_cells``."""
    links, rest, known, m = kx.reshape(-1), b.reshape(-1), fixed.reshape(-1), b.shape[1]
    f, k, whole = line[0], line[1], line[4]
    if not in_cells:
        for c in range(f.size):
            f[c], whole[c] = 0.0, 0.0
        return
    last = rest.size - m
    for start, end, prv, nxt in ((0, m, last, m), (m, last, 0, 2 * m), (last, rest.size, last - m, 0)):
        at, before, behind = slice(start, end), slice(prv, prv + end - start), slice(nxt, nxt + end - start)
        _terms(links[before], links[at], rest[at], f[at], k[at], whole[at])
        _clear_known(known[before], known[at], known[behind], f[at], whole[at])


@njit(cache=True, fastmath=FAST, error_model="numpy")
def _terms(before, links, rest, f, k, whole):
    for c in range(f.size):
        k[c] = 0.5 * (before[c] + links[c])
        can = (rest[c] < 0.0) & (before[c] > 0.0) & (links[c] > 0.0)
        f[c] = -rest[c] if can else 0.0
        whole[c] = 0.5 * f[c] / (k[c] if can else 1.0)


@njit(cache=True)
def _clear_known(before, known, behind, f, whole):
    for c in range(f.size):
        if known[c] | before[c] | behind[c]:
            f[c] = whole[c] = 0.0


@njit(cache=True, inline="always")
def weigh_line(line, number):
    """Rows of the balances at the line, their flat vertices, and weights (2, c): derivatives of -N to the right-hand
    side b and to the mean conductance k."""
    f, k, s, numbers, found = line[0], line[1], line[6], number.reshape(-1), 0
    rows, places, weights = np.empty(s.size, dtype=np.int64), np.empty(s.size, dtype=np.int64), np.empty((2, s.size))
    for c in range(s.size):
        if s[c] < 1.0:
            rows[found], places[found], weights[0, found] = numbers[c], c, 0.5 * (1.0 - s[c])
            weights[1, found] = weights[0, found] * f[c] * s[c] / k[c]
            found += 1
    return rows[:found], places[:found], weights[:, :found].copy()


@njit(cache=True)
def line_rows(line, number, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh):
    """Rows, flat vertices and derivatives of `RuptureLine.gradients`."""
    rows, places, weights = weigh_line(line, number)
    by = np.zeros((10, places.size))
    line_gradients(places, weights, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh, by)
    return rows, places, by


@njit(cache=True)
def line_gradients(places, weights, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh, by):
    """`Gradients.by` of the last solution at ``places`` (c,) added to ``by`` (10, c).

    ``weights``: of `weigh_line`; ``slopes``, ``by_speed``: `LinkFlux.slopes` and `LinkFlux.by_speed`, as for
    `exudyn_ehd.film.reynolds.link_derivatives.link_derivatives`.
    """
    mesh = Mesh(*mesh)
    n, m = H.shape
    for found in range(places.size):
        i = places[found] // m
        j = places[found] - i * m
        prv = i - 1 if i > 0 else n - 1
        source, conduct = weights[0, found], weights[1, found]
        wx, wz = mesh.width_x[i], mesh.width_z[j]
        for q, face, side in ((0, i, -1.0), (1, prv, 1.0)):
            half = 0.5 * conduct * mesh.link_x[face] * flow_x * wz
            if slopes is None:
                h = HF[face, j]
                by[q, found] += side * source * vx * wz + half * 3.0 * h * h
                by[6, found] += side * source * h * wz
            else:
                by[q, found] += side * source * vx * wz * slopes[4][face, j] + half * slopes[0][face, j]
                by[6, found] += side * source * slopes[2][face, j] * wz
            if by_speed is not None:
                by[6, found] += half * by_speed[0][face, j]
        for q, face, side in ((3, j, -1.0), (4, j - 1, 1.0)):
            if 0 <= face < m - 1:
                carrier, carrier_h = 0.5 * (H[i, face] + H[i, face + 1]), 1.0
                if slopes is not None:
                    carrier, carrier_h = slopes[3][i, face], slopes[5][i, face]
                across = 0.5 * side * source * vz * wx * carrier_h
                by[2, found] += across
                by[q, found] += across
                by[7, found] += side * source * wx * carrier
        if squeeze:
            by[5, found] -= source * wx * wz
