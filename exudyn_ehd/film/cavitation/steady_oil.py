"""Steady mass-conserving films that their equations alone do not determine.

Let u be the pressure above the cavity's at full vertices and fill - 1 at cavitated ones, and R(u) the balances of
`exudyn_ehd.film.cavitation.elrod_adams`. The derivatives dR_i / du_j are <= 0 for i not j. The sum s_j of column j is
what leaves the film for good: conductances to prescribed vertices, Couette flow to those downstream, and ``area dH/dt``
in a cavity. Two films u and v have ``sum_i sign(u_i - v_i) (R_i(u) - R_i(v)) >= sum_j s_j |u_j - v_j|``. With s >= 0,
and every vertex connected to one with s > 0, R is an M-function and the film the only one (W. C. Rheinboldt, J. Math.
Anal. Appl. 32 (1970) 274). Two kinds of films do not have that:

* The gap closes at a rate that lasts. Where it closes faster than oil flows out, a dry cavity may stay dry or fill up.
  The film is then the largest one, which a cold start or pseudo time reaches from the full side: such films take no
  warm start.
* Oil goes round in a row that has neither prescribed vertices nor pressure (`has_unfed_row`), without rates and axial
  Couette flow: ``fill H`` is the same all around, and any number up to the minimum film thickness. A row whose
  neighbour has pressure is fed by it.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.status import Status

# Pressure times the gap's square over the scaled speed, below which a vertex has none: a share of the Couette flow. A
# wedge makes some of its eccentricity ratio, rounding some 1e-16. Larger values take slightly fed films for dry ones.
NO_PRESSURE = 1e-9


def status_of(s: FilmSystem, status: Status) -> Status:
    """Return the status of a solution; NO_OIL if nothing but time determines how much oil a steady one has."""
    if status is not Status.CONVERGED or s.turns == 0.0:
        return status
    unfed = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
    return Status.NO_OIL if unfed and not s.H_t.any() else status


@njit(cache=True)
def has_unfed_row(P, H, fixed, turns, pc):
    """Return whether oil goes round in a row without pressure or prescribed vertices; ``turns`` of `FilmSystem`."""
    n, m = P.shape
    for j in range(m):
        fed = turns == 0.0
        for i in range(n):
            if fed:
                break
            fed = fixed[i, j] or (P[i, j] - pc) * H[i, j] * H[i, j] > NO_PRESSURE * turns
        if not fed:
            return True
    return False


@njit(cache=True)
def imbalance(terms, P, balance, full, ruptures, stored):
    """Return the largest balance (n, m) of an unknown vertex over the largest flow that drives the film, and over the
    largest flow that it has; P (n, m) above the cavity's.

    Of a film that ``ruptures`` without a memory the ``full`` vertices alone are unknown. ``stored``: largest flow into
    storage of which the terms hold a difference.
    """
    worst, drive, most = 0.0, 0.0, stored
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            flows = abs(terms.fx[i, j]) + abs(terms.fz[i, j])
            flows += terms.area[i, j] * (abs(terms.grow[i, j]) + abs(terms.kept[i, j]))
            conductance = max(terms.kx[i, j], max(terms.kz[i, j], terms.kz[i, j - 1] if j > 0 else 0.0))
            pressed = conductance * abs(P[i, j])
            most = max(most, flows + pressed)
            if terms.fixed[i, j]:
                flows += pressed
            elif full[i, j] or not ruptures:
                worst = max(worst, abs(balance[i, j]) if np.isfinite(balance[i, j]) else np.inf)
            drive = max(drive, flows)
    return worst / max(drive, 1e-300), worst / max(most, 1e-300)
