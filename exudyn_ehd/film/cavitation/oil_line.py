"""The rupture line of a mass-conserving film inside a cell: pressure and fill of the last full vertex in front of it.

Of a vertex let ``f`` be what wedge and squeeze take away, ``k`` the mean conductance of its two links in theta, and
``o`` what leaves it with the Couette flows of a full film. The pressure in front of the line is the parabola of
`exudyn_ehd.film.cavitation.rupture_line`: with the line s cells beyond the vertex, 0 < s < 1, its pressure above the
cavity's is ``p = f s^2 / (2 k)``. Where the pressure's gradient has vanished, at the line, the oil is carried by the
surfaces alone. Integrated from there, the flow over the middle of the link is, wherever the line lies on it,

    o + f (s - 1/2) = o + k p - N,    N = f (1 - s)^2 / 2,

so that the flow ``o + k p`` of the scheme is too large by N. What the balance of the last full vertex is spared, the
first vertex of the cavity misses. A flow that is smaller by N is one that carries the fill

    fill = 1 - N / o = 1 - (f / (2 o)) (1 - s)^2,    s = sqrt(2 k p / f),

instead of 1. So the two branches of the plain film, a full fill and the cavity's pressure, meet not in a corner but
along this curve, vertex by vertex: nothing is added to any balance, and mass is conserved to rounding. A vertex joins
the film at s = 0, when its oil fills ``1 - f / (2 o)`` of what leaves it, the gap half a cell downstream. With both
growing along the curve, the matrices stay column diagonally dominant M-matrices, and there is one solution.

What a vertex holds follows a curve of its own, ``1 - (f / (2 o)) (1 - s / FILLED)^2`` up to s = FILLED and 1 behind:
the void in front of a line is of second order of the cell. Were it that of the flows, motions that are over before the
oil moves on by a cell would have to fill it before they meet the film's pressure, as if it ended at the vertex.

f is bounded by o, ``f / sqrt(1 + (f / o)^2)`` for it, which changes it in third order of the cell: a film that opens
without being carried along keeps its line on the grid. There is no line where the wedge builds pressure up (f <= 0),
in films at rest, without pressure flow in theta, and next to columns with prescribed pressure. Where a film reforms
in a gap that opens, the first full vertex is on the curve as well: it is full up to half of what one cell opens by.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.rupture_line import LineGradients, line_gradients
from exudyn_ehd.film.grid import Mesh
from exudyn_ehd.film.reynolds.links import Coefficients, LinkFlux

# s at which a vertex holds all that it can.
FILLED = 0.25
# Share of what leaves a vertex that its wedge has to be beyond.
ROUNDING = 1e-13


class Curve(NamedTuple):
    """The curves of a film's vertices as kernels take them, flat (n m,).

    Attributes
    ----------
    f, k, out : arrays
        Symbols of the module: bounded f, 0 where there can be no line; k; o.
    bend : array
        Derivative of the bounded f to f.
    whole, drop : arrays
        Pressure above the cavity's at s = 1; fill that lacks at s = 0.
    s : array
        1 where there is no line.
    slope, rise : arrays
        Derivatives of what flows carry and of the fill to the pressure along the curve, 0 where there is no line.
    """

    f: np.ndarray
    k: np.ndarray
    out: np.ndarray
    bend: np.ndarray
    whole: np.ndarray
    drop: np.ndarray
    s: np.ndarray
    slope: np.ndarray
    rise: np.ndarray


def straight(shape: tuple[int, int]) -> Curve:
    """No curve at any vertex."""
    curve = Curve(*np.zeros((9, shape[0] * shape[1])))
    curve.s[:] = 1.0
    return curve


class OilLine:
    """The rupture line of one mass-conserving film.

    Attributes
    ----------
    fields : Curve
    s, rise : (n, m) arrays
        Of ``fields``.
    late : (n, m) array
        ``late`` of `exudyn_ehd.film.reynolds.links.Coefficients` with what flows carry less than the fill.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self.fields = straight(shape)
        self.s, self.rise = self.fields.s.reshape(shape), self.fields.rise.reshape(shape)
        self.late = np.zeros(shape)

    def gradients(
        self,
        gaps: tuple[np.ndarray, np.ndarray],
        flux: LinkFlux | None,
        speeds: tuple[float, float],
        flow_x: float,
        squeeze: bool,
        mesh: tuple[np.ndarray, ...],
    ) -> tuple[LineGradients, LineGradients]:
        """Derivatives of what flows carry from the vertices at the line, and of their fills, at fixed pressure.

        For the last solution, to the film's ``gaps`` at vertices and links; ``rows`` are no unknowns here.
        """
        places = np.flatnonzero(self.fields.s < 1.0)
        slopes, by_speed = (None, None) if flux is None else (flux.slopes, flux.by_speed)
        out = []
        for end in (1.0, FILLED):
            by, weights = np.zeros((8, places.size)), np.empty((3, places.size))
            _curve_weights(places, self.fields, end, weights)
            line_gradients(places, weights[:2], *gaps, slopes, by_speed, *speeds, flow_x, squeeze, mesh, by)
            _outflow_gradients(places, weights[2], *gaps, slopes, *speeds, mesh, by)
            out.append(LineGradients(places, places, by))
        return out[0], out[1]

    def balance_gradients(
        self,
        fills: tuple[LineGradients, LineGradients],
        film: Coefficients,
        rho: np.ndarray,
        inverse_step: float,
        unknowns: np.ndarray,
    ) -> LineGradients:
        """What the balances of the ``unknowns`` (count,), flat vertices, change by with what `gradients` returns: an
        entry for every balance and vertex at the line; ``rho`` (n, m): density."""
        carried, full = fills
        rows, places = np.empty((2, 5 * full.places.size), dtype=np.int64)
        by = np.empty((8, 5 * full.places.size))
        count = _spread_fills(full.places, carried.by, full.by, film, rho, inverse_step, unknowns, rows, places, by)
        return LineGradients(rows[:count], places[:count], by[:, :count])


@njit(cache=True)
def curve_terms(film, b, curve):
    """f, k, o and what follows from them, for `Coefficients` and the right-hand side b (n, m)."""
    n, m = b.shape
    along, f_x, f_z = film.kx.reshape(-1), film.fx.reshape(-1), film.fz.reshape(-1)
    rest, known = b.reshape(-1), film.fixed.reshape(-1)
    size = n * m
    for c in range(size):
        prv = c - m if c >= m else c - m + size
        nxt = c + m if c + m < size else c + m - size
        out = max(f_x[c], 0.0) - min(f_x[prv], 0.0) + max(f_z[c], 0.0)  # nothing flows over the last row's links
        if c % m > 0:
            out -= min(f_z[c - 1], 0.0)
        curve.out[c] = out
        curve.k[c] = 0.5 * (along[prv] + along[c])
        curve.f[c] = curve.whole[c] = curve.drop[c] = curve.bend[c] = 0.0
        if (
            -rest[c] > ROUNDING * out
            and out > 0.0
            and min(along[prv], along[c]) > 0.0
            and not (known[c] | known[prv] | known[nxt])
        ):
            share = rest[c] / out
            root = 1.0 / np.sqrt(1.0 + share * share)
            curve.f[c] = -rest[c] * root
            curve.bend[c] = root * root * root
            curve.whole[c] = 0.5 * curve.f[c] / curve.k[c]
            curve.drop[c] = 0.5 * curve.f[c] / out


@njit(cache=True, inline="always")
def lack(s, end):
    """What lacks at s of all that lacks at s = 0, and its derivative to s, for a curve that ends at s = ``end``."""
    if s >= end:
        return 0.0, 0.0
    left = 1.0 - s / end
    return left * left, -2.0 * left / end


@njit(cache=True)
def _curve_weights(places, curve, end, out):
    """Derivatives (3, c) of ``1 - drop lack(s, end)`` at ``places`` (c,) to the right-hand side, to k and to o."""
    for q in range(places.size):
        c = places[q]
        s, f, o = curve.s[c], curve.f[c], curve.out[c]
        left, by_s = lack(s, end)
        by_f = (0.25 * by_s * s - 0.5 * left) / o
        out[0, q] = -by_f * curve.bend[c]
        out[1, q] = -0.25 * by_s * s * f / (curve.k[c] * o)
        # f / o, of which the bounded f is f / sqrt(1 + (f / o)^2): its derivative to o is (f / o)^3 bend
        share = f / o
        share = share / np.sqrt(max(1.0 - share * share, 1e-300))
        out[2, q] = 0.5 * left * f / (o * o) + by_f * share * share * share * curve.bend[c]


@njit(cache=True)
def _outflow_gradients(places, by_out, H, HF, slopes, vx, vz, mesh, by):
    """Add what the fills change by with o; parameters as for `rupture_line.line_gradients`."""
    mesh = Mesh(*mesh)
    n, m = H.shape
    for q in range(places.size):
        i = places[q] // m
        j = places[q] - i * m
        w, wx, wz = by_out[q], mesh.width_x[i], mesh.width_z[j]
        face, entry, sign = (i, 0, 1.0) if vx > 0.0 else (i - 1 if i > 0 else n - 1, 1, -1.0)
        by[entry, q] += w * abs(vx) * wz * (1.0 if slopes is None else slopes[4][face, j])
        by[6, q] += sign * w * wz * (HF[face, j] if slopes is None else slopes[2][face, j])
        link, entry, sign = (j, 3, 1.0) if vz > 0.0 else (j - 1, 4, -1.0)
        if vz != 0.0 and 0 <= link < m - 1:
            across = 0.5 * w * abs(vz) * wx * (1.0 if slopes is None else slopes[5][i, link])
            by[2, q] += across
            by[entry, q] += across
            by[7, q] += sign * w * wx * (0.5 * (H[i, link] + H[i, link + 1]) if slopes is None else slopes[3][i, link])


@njit(cache=True)
def add_curve(curve, terms, density, slopes):
    """Add to the derivatives (5, n m) of flows and storage what the fills at the line follow the pressure by.

    ``density`` (n, m), None: 1; ``slopes``: of `exudyn_ehd.film.reynolds.balance.film_slopes`, the line's vertices
    among the full ones.
    """
    m, size = terms.kx.shape[1], terms.kx.size
    along, across, area, grow = (
        terms.fx.reshape(-1),
        terms.fz.reshape(-1),
        terms.area.reshape(-1),
        terms.grow.reshape(-1),
    )
    prompt = terms.prompt.reshape(-1)
    for c in range(size):
        by = curve.slope[c]
        if by == 0.0:
            continue
        carried, held, prv = by * prompt[c], curve.rise[c], c - m if c >= m else c - m + size
        back = left = on = right = 1.0
        if density is not None:
            rho = density.reshape(-1)
            here, nxt, held = rho[c], c + m if c + m < size else c + m - size, held * rho[c]
            on, back = 0.5 * (here + rho[nxt]), 0.5 * (here + rho[prv])
            right, left = 0.5 * (here + rho[min(c + 1, size - 1)]), 0.5 * (here + rho[max(c - 1, 0)])
        slopes[0, c] += carried * max(along[c], 0.0) * on
        slopes[1, prv] += carried * min(along[prv], 0.0) * back
        if c + 1 < size:
            slopes[2, c] += carried * max(across[c], 0.0) * right
        if c > 0:
            slopes[3, c - 1] += carried * min(across[c - 1], 0.0) * left
        slopes[4, c] += held * area[c] * grow[c]


@njit(cache=True)
def _spread_fills(fills, by_carried, by_fill, film, density, inverse_step, unknowns, rows, places, by):
    """`OilLine.balance_gradients` of the vertices ``fills``; returns how many entries there are."""
    n, m = film.H.shape
    number = np.full(n * m, -1)
    for r in range(unknowns.size):
        number[unknowns[r]] = r
    rho = density.reshape(-1)
    targets, shares, count = np.empty(5, dtype=np.int64), np.empty(5), 0
    for q in range(fills.size):
        c = fills[q]
        i = c // m
        j = c - i * m
        prv = i - 1 if i > 0 else n - 1
        targets[0], targets[1], targets[2] = c, c + m if i + 1 < n else j, prv * m + j
        targets[3], targets[4] = c + 1 if j + 1 < m else c, c - 1 if j > 0 else c
        prompt = film.prompt[i, j]
        shares[1] = -prompt * max(film.fx[i, j], 0.0)
        shares[2] = prompt * min(film.fx[prv, j], 0.0)
        shares[3] = -prompt * max(film.fz[i, j], 0.0) if j + 1 < m else 0.0
        shares[4] = prompt * min(film.fz[i, j - 1], 0.0) if j > 0 else 0.0
        grow = inverse_step * film.H[i, j] if inverse_step > 0.0 else film.H_t[i, j]
        for e in range(1, 5):
            shares[e] *= 0.5 * (rho[c] + rho[targets[e]])
        shares[0], store = -(shares[1] + shares[2] + shares[3] + shares[4]), film.area[i, j] * grow * rho[c]
        for e in range(5):
            if shares[e] != 0.0 and number[targets[e]] >= 0:
                rows[count], places[count] = number[targets[e]], c
                for d in range(8):
                    by[d, count] = shares[e] * by_carried[d, q] + (store * by_fill[d, q] if e == 0 else 0.0)
                count += 1
    return count


def weigh_flows(lam: np.ndarray, film: Coefficients, rho: np.ndarray) -> np.ndarray:
    """What adjoints (k, n, m) of the balances make of their derivatives to what flows carry from vertices (k, n, m);
    ``rho`` (n, m): density."""
    out = np.zeros_like(lam)
    for axis, f in ((1, film.fx), (2, film.fz)):
        f = f * 0.5 * (rho + np.roll(rho, -1, axis - 1))
        on, back = np.maximum(f, 0.0), np.roll(np.maximum(-f, 0.0), 1, axis - 1)
        out += film.prompt * (on * (lam - np.roll(lam, -1, axis)) + back * (lam - np.roll(lam, 1, axis)))
    return out
