"""Gap of a tilted rigid journal in a bore, slopes of additional gap terms, and gaps with steps.

``H = 1 - (x + bx z) cos theta - (y + by z) sin theta (+ extra)`` in scaled lengths: x, y divided by c; z by R; bx, by
multiplied by R/c. Paper, Eqs. (3), (5), (7). The gap's rate at fixed theta is the same expression in the rates, without
the 1.

Symbols: pose = (x, y, bx, by) scaled, cos_x / sin_x at vertices, cos_f / sin_f at the links i -> i+1, z (m,) vertices.

Gaps with steps (pockets, textures, edges of grooves)
-----------------------------------------------------
A link between two vertices consists of two halves with gaps h1 and h2. The flow is the same in both,

    q = V h1 - h1^3 (pf - p1) / (ds / 2) = V h2 - h2^3 (p2 - pf) / (ds / 2),

or, with the pressure pf on the face eliminated,

    q = V c - g (p2 - p1) / ds,   g = 2 / (1/h1^3 + 1/h2^3),   c = (1/h1^2 + 1/h2^2) / (1/h1^3 + 1/h2^3).

The flow over a step is then exact if the gap is constant on both sides; for a smooth gap it is of second order. Without
this model the mean gap of both vertices is used, which is of first order at a step.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.kernels import FAST
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
