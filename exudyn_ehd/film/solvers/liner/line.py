"""Rupture line inside the cells of a film whose gap, density or conductances follow its pressure.

Symbols: see `exudyn_ehd.film.cavitation.rupture_line`. At the line the pressure is the cavity pressure, with zero
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
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, line_gradients, line_terms, weigh_line
from exudyn_ehd.film.gradients import Gradients
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.links import LinkFlux

# Gap over the clearance below which surfaces at the cavity pressure count as touching: no line lies there. Larger
# values omit lines in thin films, smaller ones divide by nearly vanishing gaps.
TOUCHING = 1e-6


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
def _by_bare(t):
    """Return df / d(f without liner), and d(ln f) / d(ln k), which is equal to d(ln f) / d(ln h)."""
    held = 1.0 / (1.0 + t * t)
    turned = 2.0 * (t * held) * (t * held)
    return held - turned, turned / held


@njit(cache=True)
def liner_rows(line, gap_ratio, density, lift, number, H, HF, slopes, by_speed, vx, vz, flow_x, squeeze, mesh):
    """Return the results of `exudyn_ehd.film.cavitation.rupture_line.line_rows`, with the derivatives through t and
    through the conductance that the liner adds, ``lift`` (m,) times the speed."""
    rows, places, weights = weigh_line(line, number)
    gap, t, m = HF.reshape(-1), gap_ratio.reshape(-1), HF.shape[1]
    f, k, s, by = line[0], line[1], line[6], np.zeros((10, places.size))
    for q in range(places.size):
        c = places[q]
        by_f, turned = _by_bare(t[c])
        short = weights[0, q]
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


class FilmLine(RuptureLine):
    """Rupture line of a film on a liner, or of one whose conductances or density follow the pressure.

    Attributes
    ----------
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
        super().__init__(block, shape)
        self.density, self.gap_ratio, self.lift_by_speed = 1.0, np.zeros(shape), np.zeros(shape[1])
        self.liner = 0.0, self.gap_ratio

    def take(self, film: FilmTerms, b: np.ndarray, density: float, vx: float) -> None:
        """Set f, k and t from the terms and the right-hand side b (n, m) of a film at the cavity pressure."""
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
        """Return the results of `RuptureLine.gradients`, with the liner's contribution, for ``gaps`` and ``flux`` at
        the cavity pressure."""
        slopes, by_speed = (None, None) if flux is None else (flux.slopes, flux.by_speed)
        rest = self.block, self.gap_ratio, self.density, self.lift_by_speed, work.number
        return Gradients(*liner_rows(*rest, *gaps, slopes, by_speed, *speeds, flow_x, squeeze, mesh))


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
