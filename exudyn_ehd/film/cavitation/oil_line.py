"""Rupture line of a mass-conserving film inside a cell: pressure and fill of the last full vertex in front of it.

At a vertex let ``f`` be the flow that wedge and squeeze take away, and ``k`` the mean conductance of its two links in
theta. ``o`` is the outflow by the Couette flows of a full film. The pressure in front of the line is the parabola of
`exudyn_ehd.film.cavitation.rupture_line`. If the line lies s cells beyond the vertex, 0 < s < 1, the pressure of the
vertex above the cavity's is ``p = f s^2 / (2 k)``. At the line the pressure gradient vanishes, and only the Couette
flow carries oil. Integrated from there, the flow over the middle of the link is, for any line on the link,

    o + f (s - 1/2) = o + k p - N,    N = f (1 - s)^2 / 2.

So the scheme's flow ``o + k p`` is too large by N: the last full vertex loses N too much, and the first vertex of the
cavity receives it. To reduce the flow by N, its fill is set to

    fill = 1 - N / o = 1 - (f / (2 o)) (1 - s)^2,    s = sqrt(2 k p / f),

instead of 1. The two branches of the film without such a line, fill 1 and cavity pressure, are thus connected by this
curve instead of a corner. No balance has an additional term, and mass is conserved to round-off. A vertex becomes full
at s = 0, when the fill of its outflow, that of the gap half a cell downstream, reaches ``1 - f / (2 o)``. Both pressure
and fill grow along the curve. So the matrices stay column diagonally dominant M-matrices, and there is one solution.

The fill of the vertex is ``1 - (f / (2 o)) (1 - s / FILLED)^2`` up to s = FILLED, and 1 beyond. It differs from
the fill of the outflow because the void in front of a line is of second order in the cell size. With the outflow's
fill, a short motion, which displaces the oil by less than a cell, would first have to fill this void. Only then would
the pressure respond, as if the film ended at the vertex.

f is bounded by o: ``f / sqrt(1 + (f / o)^2)`` replaces it, a change of third order in the cell size. So in a gap that
opens with little Couette flow the line lies on vertices. There is no line where the wedge builds pressure up
(f <= 0), in films at rest, without pressure flow in theta, and next to columns with prescribed pressure. Where a film
reforms in a gap that opens, the first full vertex is on the curve as well. Its missing oil is at most half of that by
which the gap opens over one cell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.compilation import TOLERANCE
from exudyn_ehd.film.cavitation.rupture_line import line_gradients
from exudyn_ehd.film.grid import Mesh
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.gap import Gradients
from exudyn_ehd.film.reynolds.links import LinkFlux

# s from which on the fill of a vertex is 1. Larger values delay the response of the pressure to short motions, smaller
# ones make the fill steeper over s.
FILLED = 0.25


class CurveFields(NamedTuple):
    """Curves of a film's vertices as kernels take them, flat (n m,).

    Attributes
    ----------
    f, k, out : arrays
        f of the module, bounded by o, 0 where there is no line; k; o.
    bend : array
        Derivative of the bounded f to f.
    whole, drop : arrays
        Pressure above the cavity's at s = 1; missing fill at s = 0.
    s : array
        Distance of the line from the vertex in cells; 1 where there is none.
    slope, rise : arrays
        Derivatives to the pressure, along the curve, of the fill of the outflow and of the fill of the vertex; 0 where
        there is no line.
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


@njit(cache=True, inline="always")
def curve_of(f):
    """Return `CurveFields` of its fields (9, n m)."""
    return CurveFields(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8])


class OilLine:
    """Rupture line of one mass-conserving film.

    Attributes
    ----------
    block : (9, n m) array
        Fields of the `CurveFields`, as kernels take them.
    fields : CurveFields
        Views of ``block``.
    s, rise : (n, m) arrays
        Views of ``fields``.
    density : float
        Density in the cavity over that at ambient pressure.
    lift_by_speed : (m,) array
        Derivative to vx of the conductance that an elastic liner adds to k.
    """

    def __init__(self, block: np.ndarray, shape: tuple[int, int]) -> None:
        self.block = block
        self.fields = CurveFields(*self.block)
        self.s, self.rise = self.fields.s.reshape(shape), self.fields.rise.reshape(shape)
        self.density, self.lift_by_speed = 1.0, np.zeros(shape[1])

    def take(self, film: FilmTerms, b: np.ndarray, density: float, vx: float) -> None:
        """Set the curves from a film's terms and right-hand side b (n, m) at the cavity pressure."""
        self.density = density
        curve_terms(film, b, density, self.lift_by_speed * vx, self.fields)

    def gradients(
        self,
        gaps: tuple[np.ndarray, np.ndarray],
        flux: LinkFlux | None,
        speeds: tuple[float, float],
        flow_x: float,
        squeeze: bool,
        mesh: tuple[np.ndarray, ...],
    ) -> tuple[Gradients, Gradients]:
        """Derivatives to the motion, at fixed pressure, of two fills of every vertex at the line: fill of the outflow,
        fill of the vertex.

        They hold for the last solution, with its ``gaps`` at vertices and links. ``rows`` of the results are flat
        vertices, not unknowns.
        """
        places = np.flatnonzero(self.fields.s < 1.0)
        slopes, by_speed = (None, None) if flux is None else (flux.slopes, flux.by_speed)
        out = []
        for end in (1.0, FILLED):
            by, weights = np.zeros((10, places.size)), _curve_weights(places, self.fields, end)
            weights[::2] *= self.density
            line_gradients(places, weights[:2], *gaps, slopes, by_speed, *speeds, flow_x, squeeze, mesh, by)
            _outflow_gradients(places, weights[2], *gaps, slopes, *speeds, mesh, by)
            by[6] += weights[1] * self.lift_by_speed[places % self.lift_by_speed.size]
            out.append(Gradients(places, places, by))
        return out[0], out[1]

    def balance_gradients(
        self, fills: tuple[Gradients, Gradients], film: FilmTerms, store: np.ndarray, unknowns: np.ndarray
    ) -> Gradients:
        """Derivatives of the balances through the fills of `gradients`: one entry for every balance and vertex at the
        line.

        ``film``, ``store``: results of `FilmSolver.fill_weights`; ``unknowns`` (count,): flat vertices of the balances.
        """
        (carried, full), m, size = fills, store.shape[1], store.size
        c, number = full.places, np.full(size, -1)
        number[unknowns] = np.arange(unknowns.size)
        prv, fx, fz = (c - m) % size, film.fx.reshape(-1), film.fz.reshape(-1)
        # nothing flows over the last row's links
        out = np.array(
            (np.maximum(fx[c], 0.0), -np.minimum(fx[prv], 0.0), np.maximum(fz[c], 0.0), -np.minimum(fz[c - 1], 0.0))
        )
        shares = film.prompt.reshape(-1)[c] * np.vstack((out.sum(axis=0), -out))
        rows = number[np.array((c, c + m, prv, c + 1, c - 1)) % size]
        target, q = np.nonzero((shares != 0.0) & (rows >= 0))
        stored = np.where(target == 0, store.reshape(-1)[c[q]], 0.0)
        by = shares[target, q] * carried.by[:, q] + stored * full.by[:, q]
        return Gradients(rows[target, q], c[q], by)


@njit(cache=True)
def curve_terms(film, b, density, lift, curve):
    """Set f, k, o and the fields that follow from them, from `FilmTerms` and the right-hand side b (n, m).

    ``density``: that of the oil over that at ambient pressure; ``lift`` (m,): conductance that a liner adds to k.
    """
    n, m = b.shape
    along, f_x, f_z = film.kx.reshape(-1), film.fx.reshape(-1), film.fz.reshape(-1)
    rest, known = b.reshape(-1), film.fixed.reshape(-1)
    size = n * m
    for c in range(size):
        prv = c - m if c >= m else c - m + size
        nxt = c + m if c + m < size else c + m - size
        # nothing flows over the last row's links in z
        out = max(f_x[c], 0.0) - min(f_x[prv], 0.0) + max(f_z[c], 0.0) - min(f_z[c - 1], 0.0)
        curve.out[c] = density * out
        curve.k[c] = 0.5 * (along[prv] + along[c]) + lift[c % m]
        curve.f[c] = curve.whole[c] = curve.drop[c] = curve.bend[c] = 0.0
        if (
            # smaller ones are round-off
            -rest[c] > TOLERANCE * out
            and out > 0.0
            and min(along[prv], along[c]) > 0.0
            and not (known[c] | known[prv] | known[nxt])
        ):
            share = rest[c] / out
            root = 1.0 / np.sqrt(1.0 + share * share)
            curve.f[c] = -density * rest[c] * root
            curve.bend[c] = root * root * root
            curve.whole[c] = 0.5 * curve.f[c] / curve.k[c]
            curve.drop[c] = 0.5 * curve.f[c] / curve.out[c]


@njit(cache=True, inline="always")
def missing_fill(s, end):
    """Return the missing fill over that at s = 0, ``(1 - s / end)^2``, and its derivative to s; 0 beyond ``end``."""
    if s >= end:
        return 0.0, 0.0
    left = 1.0 - s / end
    return left * left, -2.0 * left / end


def _curve_weights(places: np.ndarray, curve: CurveFields, end: float) -> np.ndarray:
    """Return derivatives (3, c) of the fill ``1 - drop missing_fill(s, end)`` at ``places`` (c,) to the right-hand
    side, k and o."""
    f, k, o, bend, s = (field[places] for field in (curve.f, curve.k, curve.out, curve.bend, curve.s))
    left = np.maximum(1.0 - s / end, 0.0)
    by_s = -0.5 * left / end * s
    by_f = (by_s - 0.5 * left * left) / o
    # the bounded f has the derivative (f / o)^3 bend to o, with f before it is bounded
    share = f / o
    share /= np.sqrt(np.maximum(1.0 - share * share, 1e-300))
    return np.array((-by_f * bend, -by_s * f / (k * o), 0.5 * left * left * f / (o * o) + by_f * share**3 * bend))


@njit(cache=True)
def _outflow_gradients(places, by_out, H, HF, slopes, vx, vz, mesh, by):
    """Add the derivatives of the fills through o; parameters as for `rupture_line.line_gradients`."""
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
    """Add the derivatives of flows and storage to the pressure through the fills at the line to ``slopes`` (5, n m).

    ``density`` (n, m), None: 1; ``slopes``: those of `exudyn_ehd.film.reynolds.balance.film_slopes`, which counts the
    vertices at the line as full.
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
        # nothing flows over the last row's links in z
        slopes[2, c] += carried * max(across[c], 0.0) * right
        slopes[3, c - 1] += carried * min(across[c - 1], 0.0) * left
        slopes[4, c] += held * area[c] * grow[c]
