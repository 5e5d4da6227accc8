"""Rupture line inside a cell: mass balance of the last active vertex in front of the line.

Films of Swift and Stieber
--------------------------
Near the line the pressure is a parabola, ``p = q d^2 / 2`` with the distance d to the line. At a vertex let ``f`` be
the flow that wedge and squeeze take away (minus the right-hand side of `exudyn_ehd.film.reynolds.links`), and ``k`` the
mean conductance of its two links in theta. Then ``q = f / (k h^2)`` with the distance h of two columns. If the line
lies s cells beyond a vertex, 0 < s < 1, its pressure is ``p = q h^2 s^2 / 2``. The parabola, continued beyond the line,
satisfies the discrete balance exactly. But the scheme has the cavity pressure at the next vertex, not the value
``q h^2 (1 - s)^2 / 2`` of the parabola. So the balance of the last vertex has for the true pressures the residual

    N = f (1 - s)^2 / 2,    s = sqrt(2 k p / f),    for 0 < s < 1, else 0,

and the equation of the active set is ``A P - b - N(P) = 0``. A vertex becomes active, at s = 0, when ``A P - b`` falls
below f / 2. The matrix stays symmetric, and an M-matrix, since

    -dN/dp = k (1 - s) / s,    dN/df = (1 - s) / 2,    dN/dk = -f s (1 - s) / (2 k).

The first derivative raises the conductance k of the outer link to k / s, that of a link of the length s h. N falls
with p and is convex, so that there is one solution. Pressures are continuous in the motion, and forces have continuous
derivatives.

N is zero where the wedge builds pressure up (f <= 0), in films at rest, and without pressure flow in theta. Next to
columns with prescribed pressure no line is assumed, so that N is zero there as well.

Films whose gap, density or conductances follow the pressure
------------------------------------------------------------
At the line the pressure is the cavity pressure, with zero
gradient and zero rate. So f and k are computed for a film at the cavity pressure everywhere: with its density, with its
conductances without pressure flow, and with the liner at rest. They do not follow the pressure. N therefore depends on
the pressure of its own vertex alone, and does not impair the monotonicity of the balances.

A liner of compliance beta deflects from the line on. The Couette flow that its deflection adds is counted as
conductance, ``k + beta |vx| width / 2``. With it, a vertex becomes active exactly when the vertex before it is full.
The pressures within one cell change the gap h by ``t h`` with ``t = beta f / (2 k h)``. Unless t is small, the grid is
too coarse for the parabola. f is therefore replaced by ``f / (1 + t^2)``, so that the line moves to the vertices as h
vanishes.

A film that conserves mass has the curve of `exudyn_ehd.film.cavitation.oil_line`, with f, k and o of the same film at
the cavity pressure. In front of the line its flow over the middle of the link is ``o + f (s - 1/2)``. The scheme's flow
there is ``fill (o + beta |vx| width p / 2) + k p``, since the pressure p of the vertex deflects the liner by
``beta p / 2``. With ``K = k + beta |vx| width / 2`` the equations are those between rigid surfaces,

    p = f s^2 / (2 K),    fill = 1 - (f / (2 o)) (1 - s)^2,

up to the deflection times the missing fill, which is of third order of the cell. As f is bounded by o, p deflects the
liner by less than the gap, and no bound by t is needed. Where the density follows the pressure, f and o are mass flows
with the density of the cavity, and k is that of the transformed pressure.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.grid import Mesh
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.gap import Gradients
from exudyn_ehd.film.reynolds.links import LinkFlux

# Smallest s of an active vertex, as dp/ds vanishes at 0. Below it, s is round-off of the neighbours' pressures. Larger
# limits falsify N, smaller ones allow larger entries -dN/dp of the matrix.
SMALLEST_S = 1e-8


def fields_without_line(shape: tuple[int, int]) -> np.ndarray:
    """Return the fields (9, n m) of a `RuptureLine` for a film without a line inside its cells."""
    fields = np.zeros((9, shape[0] * shape[1]))
    fields[6] = 1.0
    return fields


class RuptureLine:
    """The rupture line of one film.

    Parameters
    ----------
    block : (9, n m) array
        Fields; see the attribute.
    shape : (int, int)

    Attributes
    ----------
    block : (9, n m) array
        Fields of `exudyn_ehd.film.cavitation.oil_line.CurveFields`: f is 0 where there can be no line, and s is 1 where
        there is none.
    whole : (n m,) array
        Pressure above the cavity's at s = 1.
    f, k, s : (n, m) arrays
        Views of ``block``.
    density : float
        Density in the cavity over that at ambient pressure.
    gap_ratio : (n, m) array
        t of the module.
    lift_by_speed : (m,) array
        Conductance that a liner's deflection adds to k, over vx.
    liner : (float, (n, m) array)
        Compliance, and gaps on the links at the cavity pressure.
    """

    def __init__(self, block: np.ndarray, shape: tuple[int, int]) -> None:
        self.block, self.whole = block, block[4]
        self.f, self.k, self.s = (block[row].reshape(shape) for row in (0, 1, 6))
        self.density, self.gap_ratio, self.lift_by_speed = 1.0, np.zeros(shape), np.zeros(shape[1])
        self.liner = 0.0, self.gap_ratio

    def take(self, film: FilmTerms, b: np.ndarray, density: float, vx: float) -> None:
        """Set f, k and t from the terms and the right-hand side b (n, m) of a film at the cavity pressure.

        For films on a liner, or whose conductances or density follow the pressure; others set f and k in their solver.
        """
        (beta, gaps), self.density, self.s[:] = self.liner, density, 1.0
        line_terms(film.kx, density * b, film.fixed, True, self.block)
        if beta > 0.0:
            limit_by_liner(self.block, gaps, beta, self.lift_by_speed * vx, self.gap_ratio)

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
        """Derivatives of -N in the balances of the last solution.

        ``gaps`` (at vertices and links) and ``flux`` are those at the cavity pressure.
        """
        slopes, by_speed = (None, None) if flux is None else (flux.slopes, flux.by_speed)
        own = self.block, self.gap_ratio, self.density, self.lift_by_speed, work.number
        return Gradients(*line_rows(*own, *gaps, slopes, by_speed, *speeds, flow_x, squeeze, mesh))


@njit(cache=True, inline="always")
def line_terms(kx, b, fixed, in_cells, line):
    """Set f, k and ``whole`` of all vertices in the fields ``line``; f is 0 everywhere if not ``in_cells``."""
    links, rest, known, m = kx.reshape(-1), b.reshape(-1), fixed.reshape(-1), b.shape[1]
    f, k, whole = line[0], line[1], line[4]
    for c in range(f.size):
        behind = c + m if c + m < f.size else c + m - f.size
        k[c] = 0.5 * (links[c - m] + links[c])
        can = in_cells and rest[c] < 0.0 and links[c - m] > 0.0 and links[c] > 0.0
        f[c] = -rest[c] if can and not (known[c - m] | known[c] | known[behind]) else 0.0
        whole[c] = 0.5 * f[c] / k[c] if f[c] > 0.0 else 0.0


@njit(cache=True, inline="always")
def weigh_line(line, number):
    """Return the rows of the balances at the line, their flat vertices, and weights (2, c): derivatives of -N to the
    right-hand side b and to the mean conductance k."""
    f, k, s, numbers, found = line[0], line[1], line[6], number.reshape(-1), 0
    rows, places, weights = np.empty(s.size, dtype=np.int64), np.empty(s.size, dtype=np.int64), np.empty((2, s.size))
    for c in range(s.size):
        if s[c] < 1.0:
            rows[found], places[found], weights[0, found] = numbers[c], c, 0.5 * (1.0 - s[c])
            weights[1, found] = weights[0, found] * f[c] * s[c] / k[c]
            found += 1
    return rows[:found], places[:found], weights[:, :found].copy()


@njit(cache=True)
def line_gradients(places, weights, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh, by):
    """Add the derivatives (`Gradients.by`) of the last solution's balances at ``places`` (c,) to ``by`` (10, c).

    ``weights``: as from `weigh_line`; ``slopes``, ``by_speed``: `LinkFlux.slopes` and `LinkFlux.by_speed`, None for a
    plain film.
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


@njit(cache=True)
def limit_by_liner(line, HF, beta, lift, gap_ratio_out):
    """Set t in ``gap_ratio_out`` and f / (1 + t^2), for a liner of compliance ``beta`` that adds ``lift`` (m,) to k."""
    f, k, whole, gap, gap_ratio, m = line[0], line[1], line[4], HF.reshape(-1), gap_ratio_out.reshape(-1), HF.shape[1]
    for c in range(f.size):
        k[c] += lift[c % m]
        t = beta * f[c] / (k[c] * (gap[c - m] + gap[c])) if f[c] > 0.0 else 0.0
        gap_ratio[c] = t
        f[c] /= 1.0 + t * t
        whole[c] = 0.5 * f[c] / k[c] if f[c] > 0.0 else 0.0


@njit(cache=True)
def line_rows(line, gap_ratio, density, lift, number, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh):
    """Rows, flat vertices and derivatives of `RuptureLine.gradients`, those through t and through the conductance that
    a liner adds, ``lift`` (m,) times the speed, included."""
    rows, places, weights = weigh_line(line, number)
    gap, t, m = HF.reshape(-1), gap_ratio.reshape(-1), HF.shape[1]
    f, k, s, by = line[0], line[1], line[6], np.zeros((10, places.size))
    for q in range(places.size):
        c = places[q]
        # df / d(f without liner), and d(ln f) / d(ln k), which is equal to d(ln f) / d(ln h)
        held = 1.0 / (1.0 + t[c] * t[c])
        turned = 2.0 * t[c] * t[c] * held
        by_f, short = held * (1.0 - turned), weights[0, q]
        weights[1, q] -= short * turned * f[c] / k[c]
        weights[0, q] = density * short * by_f
        by[0, q] = by[1, q] = -short * turned * f[c] / (gap[c - m] + gap[c])
        by[6, q] = short * (s[c] - turned) * f[c] / k[c] * lift[c % m]
    line_gradients(places, weights, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh, by)
    return rows, places, by


class GapChain(NamedTuple):
    """Derivatives of the film's gaps, (n, m) each.

    ``slope``: to the true gap; ``bend``: second derivative to the true gap, times its rate; ``face_slope``: to the true
    gap on links in theta; ``follow``: derivative of the deflection to the gap of the undeformed surfaces.
    """

    slope: np.ndarray
    bend: np.ndarray
    face_slope: np.ndarray
    follow: np.ndarray


class AtLine(NamedTuple):
    """Film at the cavity pressure, for the derivatives of its rupture line.

    Attributes
    ----------
    gaps : two (n, m) arrays
        Gaps at vertices and links.
    flux : LinkFlux or None
        Coefficients of the links; None for a plain film.
    chain : GapChain or None
        Derivatives of the film's gaps; None without contact and gap limiter.
    """

    gaps: tuple[np.ndarray, np.ndarray]
    flux: LinkFlux | None
    chain: GapChain | None


def undeformed(line: Gradients, chain: GapChain | None) -> Gradients:
    """Convert gradients to the film's gap to gradients to the undeformed gap, with a contact or a limiter."""
    if chain is None:
        return line
    n, m = chain.slope.shape
    out = line.to_true_gap(chain.slope, chain.bend, chain.face_slope)
    i, j = np.divmod(line.places, m)
    nxt, prv, here = (i + 1) % n, (i - 1) % n, chain.follow[i, j]
    # the deflection on a link is the mean of those at its ends
    out.by[8], out.by[9] = 0.5 * out.by[0] * chain.follow[nxt, j], 0.5 * out.by[1] * chain.follow[prv, j]
    out.by[2] += out.by[2] * here + 0.5 * (out.by[0] + out.by[1]) * here
    out.by[3] *= 1.0 + chain.follow[i, (j + 1) % m]
    out.by[4] *= 1.0 + chain.follow[i, (j - 1) % m]
    return out
