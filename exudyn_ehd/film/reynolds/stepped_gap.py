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


def stepped_links(
    H: np.ndarray, gx_out: np.ndarray, cx_out: np.ndarray, gz_out: np.ndarray, cz_out: np.ndarray
) -> None:
    """Conductance and carrier of all links (n, m) from the gaps at the vertices."""
    H3 = H * H * H
    for axis, g, c in ((0, gx_out, cx_out), (1, gz_out, cz_out)):
        b, b3 = np.roll(H, -1, axis), np.roll(H3, -1, axis)
        g[:], c[:] = 2.0 * H3 * b3 / (H3 + b3), (H * b3 + b * H3) / (H3 + b3)
