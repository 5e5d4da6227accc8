"""Gaps with steps (pockets, textures, grooves' edges): constant gap around each vertex, steps on the faces between.

Between two vertices lie two halves of a link with gaps h1 and h2. The same flow passes both,

    q = V h1 - h1^3 (pf - p1) / (ds / 2) = V h2 - h2^3 (p2 - pf) / (ds / 2),

which without the pressure pf on the face is

    q = V c - g (p2 - p1) / ds,   g = 2 / (1/h1^3 + 1/h2^3),   c = (1/h1^2 + 1/h2^2) / (1/h1^3 + 1/h2^3).

The flow over a step is then exact for a gap that is constant on both sides; a smooth gap stays of second order. Without
it the mean gap of both vertices is used, which is of first order at a step.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux


class SteppedGap(FluxEffect):
    """Flux effect: links between two vertices as two halves of constant gap.

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


@njit(cache=True)
def stepped_links(H, gx_out, cx_out, gz_out, cz_out):
    """Conductance and carrier of all links (n, m) from the gaps at the vertices."""
    n, m = H.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            a, b = H[i, j], H[nxt, j]
            a3, b3 = a * a * a, b * b * b
            gx_out[i, j] = 2.0 * a3 * b3 / (a3 + b3)
            cx_out[i, j] = (a * b3 + b * a3) / (a3 + b3)
            if j + 1 < m:
                b = H[i, j + 1]
                b3 = b * b * b
                gz_out[i, j] = 2.0 * a3 * b3 / (a3 + b3)
                cz_out[i, j] = (a * b3 + b * a3) / (a3 + b3)
