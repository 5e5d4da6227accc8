"""Rupture line between the columns of a film without pressure flow in theta (short bearing).

Every column is a film of its own in z, and has pressure where its source builds it up. In theta the pressure falls
linearly through the rupture line, because it follows the source there. So the pressure ``p`` of a column goes on into a
ruptured vertex of the next column as the negative one that the lack of oil there would make,

    u = -r / D,    D = k dz_below dz_above / (z_below z_above),

with the vertex's multiplier ``r = A p - b >= 0``, the sum k of its two conductances in z, the lengths of these links,
and its distances to both ends. D is the stiffness of a column with the same lack of oil per area everywhere, whose
pressure is a parabola over z. `exudyn_ehd.film.cavitation.linear_film.mean_in_cells` counts pressures up to where they
and u meet the cavity's, as it does with the linear film of Gümbel's condition, which is the same for an aligned
journal. u is zero where a vertex joins the film, so that forces are continuous in the motion of a tilted journal too.

For derivatives these u are unknowns behind the film's, with the balances ``D u + r = 0``. Pressures here are those
above the cavity's.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.linear_film import beside, mean_in_cells
from exudyn_ehd.film.cavitation.rupture_line import LineGradients
from exudyn_ehd.film.reynolds.links import LinkFlux


class ColumnLine:
    """Continuation of the pressures of a film without pressure flow in theta into its ruptured columns.

    Parameters
    ----------
    z : (m,) array
        Rows of the grid.

    Attributes
    ----------
    stiffness : (m,) array
        D over k in every row.
    film : int
        Number of the film's unknowns, in front of the ruptured vertices.
    """

    def __init__(self, z: np.ndarray) -> None:
        links, inner = np.diff(z), z[1:-1]
        self.stiffness = np.zeros(z.size)
        self.stiffness[1:-1] = links[:-1] * links[1:] / ((inner - z[0]) * (z[-1] - inner))
        self.film = 0

    def extend(
        self,
        links: tuple[np.ndarray, np.ndarray],
        sets: tuple[np.ndarray, np.ndarray, np.ndarray],
        pc: float,
        P: np.ndarray,
        work: Workspace,
        u_out: np.ndarray,
        counted_out: np.ndarray,
    ) -> None:
        """Continued pressures u (n, m) of a film with the pressures P (n, m), and the pressures that count.

        ``links``: kz and b; ``sets``: prescribed vertices, film, and columns (n,) with a next one. Appends the
        unknowns to those of the workspace.
        """
        self.film = work.count
        work.count = extend_film(links, sets, pc, self.stiffness, P, work.factor, self.film, u_out, counted_out)

    def couple(self, work: Workspace, kz: np.ndarray, x: np.ndarray, transposed: bool) -> None:
        """Add ``-dr/dp`` over D times the film's rows of x (count, k) to the others; ``transposed``: the reverse."""
        couple(kz.reshape(-1), work.active.reshape(-1), work.factor, self.film, work.count, x, transposed)

    def gradients(
        self, work: Workspace, kz: np.ndarray, u: np.ndarray, H: np.ndarray, flux: LinkFlux | None
    ) -> LineGradients:
        """`LineGradients` of ``D u`` at fixed u (n, m), pressures above the cavity's."""
        rows = np.arange(self.film, work.count)
        i, j = np.divmod(work.order[rows], H.shape[1])
        by = np.zeros((8, rows.size))
        for q, above in ((3, j), (4, j - 1)):
            part = self.stiffness[j] * u[i, j] * kz[i, above]
            if flux is None:
                slope = 3.0 / (0.5 * (H[i, above] + H[i, above + 1]))
            else:
                slope = flux.gz_h[i, above] / flux.gz[i, above]
                by[6] += part * (flux.gz_v / flux.gz)[i, above] if flux.speeds else 0.0
            by[q] = 0.5 * part * slope
        by[2] = by[3] + by[4]
        return LineGradients(rows, work.order[rows], by)


@njit(cache=True)
def extend_film(links, sets, pc, stiffness, P, factor, count, u_out, counted_out):
    """`ColumnLine.extend`; returns the number of unknowns. Rows of the factor behind ``count`` hold D alone."""
    (kz, b), (fixed, active, linked), (order, _, number, band, inv_diag) = links, sets, factor
    n, m = P.shape
    for i in range(n):
        prv, nxt = beside(i, linked)
        for j in range(m):
            u_out[i, j] = counted_out[i, j] = P[i, j]
            if fixed[i, j] or active[i, j] or not (prv >= 0 and active[prv, j] or nxt >= 0 and active[nxt, j]):
                continue
            piled_up = b[i, j] + kz[i, j] * (P[i, j + 1] - pc) + kz[i, j - 1] * (P[i, j - 1] - pc)
            D = stiffness[j] * (kz[i, j] + kz[i, j - 1])
            u_out[i, j] = pc + piled_up / D
            order[count], number[i, j], inv_diag[count] = i * m + j, count, 1.0 / D
            band[count] = 0.0
            band[count, 0] = D
            count += 1
    mean_in_cells(u_out, fixed, linked, pc, active, counted_out)
    return count


@njit(cache=True)
def couple(kz, active, factor, film, count, x, transposed):
    """`ColumnLine.couple`; kz and ``active`` are flat."""
    order, _, number, _, inv_diag = factor
    numbers = number.reshape(-1)
    for r in range(film, count):
        c = order[r]
        for near, k in ((c - 1, kz[c - 1]), (c + 1, kz[c])):
            if active[near]:
                a, by = (numbers[near], r) if transposed else (r, numbers[near])
                for q in range(x.shape[1]):
                    x[a, q] += k * inv_diag[r] * x[by, q]
