"""The film on a set of active vertices, and Swift-Stieber's iteration over such sets.

The primal-dual active set method, which for an M-matrix is Howard's policy iteration and ends after finitely many steps
(Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Bokanowski, Maroso, Zidani, SIAM J. Numer. Anal. 47 (2009)
3001).

Symbols: kx, kz conductances of the links, b right-hand side, P pressure, pc cavity pressure, all scaled (see
`exudyn_ehd.film.reynolds.links`); active: P is unknown.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.ldl import assemble_band, factor_band
from exudyn_ehd.film.banded.numbering import first_changed_row, number_cells
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import FIRST_ROW
from exudyn_ehd.film.cavitation.oil_line import Curve, OilLine, straight
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.links import Coefficients

MAX_ACTIVE_SET_STEPS = 200
# A vertex leaves the film if its pressure is below the cavity's by more than this share of the peak: about 100
# roundings.
ACTIVE_SET_TOLERANCE = 1e-13


class FilmSystem:
    """One film problem and its solution, as arrays that closures read and write.

    Attributes
    ----------
    kx, kz, b : (n, m) arrays
        Link conductances and right-hand side.
    fixed : (n, m) bool array
        Vertices whose entry of ``pressure`` is prescribed.
    cavity_pressure : float
        Scaled.
    pressure : (n, m) array
        In: prescribed values at fixed vertices. Out: the film's pressure.
    linear_pressure : (n, m) array
        Pressure before clipping, on which the adjoint is received; the same array as ``pressure`` unless the closure
        clips.
    fx, fz, H, H_t, area : (n, m) arrays
        Couette fluxes of a full film, gap, its rate, control volumes; ``b`` already holds the fluxes and the squeeze.
    fill, mass_old : (n, m) arrays
        Film fraction, and the old value of fill H; only used by closures that conserve mass.
    prompt, late : (n, m) arrays
        Couette flows take ``prompt fill + late`` along, of `exudyn_ehd.film.reynolds.lagging_void`; 1 and 0 without.
    inverse_step : float
        1 / time step since ``mass_old``, 1/s; 0: steady.
    closes : bool
        Whether a steady film conserves mass and its gap closes somewhere; see
        `exudyn_ehd.film.cavitation.steady_oil`.
    turns : float
        Scaled speed with which oil goes round in the rows of a steady film that conserves mass, 1/s; 0 with axial
        speed.
    line : RuptureLine or None
        Where the film's edge lies inside its cells; None: on vertices.
    oil_line : OilLine or None
        The same of a film that conserves mass.
    straight : Curve or None
        That of a film that conserves mass without one.
    linked : (n,) bool array
        Columns with a link to the next one.
    fields : (9, n, m) array
        Holds kx, kz, fx, fz, b, H, HF (gap on the links i -> i+1), H_t and pressure.
    """

    def __init__(self, grid: FilmGrid, clips: bool, fills: bool) -> None:
        shape = grid.shape
        self.fields = np.zeros((9, *shape))
        self.kx, self.kz, self.fx, self.fz, self.b, self.H, self.HF, self.H_t, self.pressure = self.fields
        self.H[:] = self.HF[:] = 1.0
        self.fixed = grid.fixed
        self.cavity_pressure = 0.0
        self.linear_pressure = np.zeros(shape) if clips else self.pressure
        self.area = grid.area
        self.inverse_step = 0.0
        self.closes, self.turns = False, 0.0
        empty = np.ones(shape) if fills else np.ones((0, 0))
        self.fill, self.mass_old = empty, empty.copy()
        self.prompt, self.late = np.ones(shape), np.zeros(shape)
        self.line: RuptureLine | None = None
        self.oil_line: OilLine | None = None
        self.straight = straight(shape) if fills else None
        self.linked = grid.link_x != 0.0

    def see_motion(self, steady: bool, rate: np.ndarray, vx: float, vz: float) -> None:
        """Take over the gap's rate (n, m) and the scaled speeds of a film that conserves mass."""
        self.closes = steady and bool(rate.min() < 0.0)
        self.turns = abs(vx) if steady and vz == 0.0 else 0.0

    @property
    def curve(self) -> Curve | None:
        """Of a film that conserves mass: where its edge lies."""
        return self.straight if self.oil_line is None else self.oil_line.fields

    @property
    def coefficients(self) -> Coefficients:
        """These arrays as kernels take them."""
        late = self.late if self.oil_line is None else self.oil_line.late
        return Coefficients(
            self.kx, self.kz, self.fx, self.fz, self.H, self.H_t, self.area, self.fixed, self.prompt, late
        )


@njit(cache=True)
def gather_rhs(kx, kz, b, active, order, count, P, rhs_out):
    """Right-hand side of the active vertices, with the known pressures of inactive neighbours moved over."""
    n, m = b.shape
    i = 0
    for r in range(count):
        j = order[r] - i * m
        if j < 0 or j >= m:  # rows of a column follow each other: one division per column
            i = order[r] // m
            j = order[r] - i * m
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        s = b[i, j]
        if not active[prv, j]:
            s += kx[prv, j] * P[prv, j]
        if not active[nxt, j]:
            s += kx[i, j] * P[nxt, j]
        if j > 0 and not active[i, j - 1]:
            s += kz[i, j - 1] * P[i, j - 1]
        if j + 1 < m and not active[i, j + 1]:
            s += kz[i, j] * P[i, j + 1]
        rhs_out[r] = s


@njit(cache=True, inline="always")
def solve_on_active(kx, kz, b, active, order, old_order, old_count, old_width, number, band, inv_diag, unknowns, P):
    """Factor and solve on the active vertices; P holds the known pressures elsewhere. Returns (ok, count, width).

    ``old_order``, ``old_count`` and ``old_width`` describe the factor in ``band`` if it belongs to the same
    coefficients; only the rows behind the first change are then factored again. ``old_count`` = 0: there is none.
    """
    count, width = number_cells(active, kx, order, number)
    # another bandwidth splits the loops over a row elsewhere, and so rounds differently: start over
    first = first_changed_row(order, old_order, old_count, count, width) if width == old_width else 0
    assemble_band(kx, kz, number, order, count, width, first, band)
    if not factor_band(band, count, width, first, inv_diag):
        return False, count, width
    gather_rhs(kx, kz, b, active, order, count, P, unknowns)
    solve_ldl_one(band, inv_diag, count, width, unknowns)
    flat = P.reshape(-1)
    for r in range(count):
        flat[order[r]] = unknowns[r]
    return True, count, width


@njit(cache=True)
def update_active_set(kx, kz, b, fixed, pc, active, P):
    """One policy step from the pressures of the last one: who leaves, who joins; returns the number of changes.

    An active vertex leaves if its pressure is below pc; another one joins if its residual at pc is not positive.
    Inactive pressures are then set to pc.
    """
    n, m = b.shape
    peak = 0.0
    for i in range(n):
        for j in range(m):
            peak = max(peak, abs(P[i, j] - pc))
    floor = pc - ACTIVE_SET_TOLERANCE * peak
    changes = 0
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if active[i, j]:
                if P[i, j] < floor:
                    active[i, j] = False
                    changes += 1
            elif not fixed[i, j]:
                r = kx[i, j] * (pc - P[nxt, j]) + kx[prv, j] * (pc - P[prv, j]) - b[i, j]
                if j > 0:
                    r += kz[i, j - 1] * (pc - P[i, j - 1])
                if j + 1 < m:
                    r += kz[i, j] * (pc - P[i, j + 1])
                if r <= 0.0:
                    active[i, j] = True
                    changes += 1
    for i in range(n):
        for j in range(m):
            if not active[i, j] and not fixed[i, j]:
                P[i, j] = pc
    return changes


@njit(cache=True, nogil=True)
def solve_active_set(kx, kz, b, fixed, pc, active, order, old_order, number, band, inv_diag, unknowns, P):
    """Swift-Stieber film; returns (ok, steps, count, width). ``active`` is the start and, on return, the result."""
    n, m = b.shape
    for i in range(n):
        for j in range(m):
            if fixed[i, j]:
                active[i, j] = False
            elif not active[i, j]:
                P[i, j] = pc
    count, width = FIRST_ROW, np.int64(1)
    for step in range(MAX_ACTIVE_SET_STEPS):
        old_count, old_width = count, width
        for r in range(old_count):
            old_order[r] = order[r]
        ok, count, width = solve_on_active(
            kx, kz, b, active, order, old_order, old_count, old_width, number, band, inv_diag, unknowns, P
        )
        if not ok:
            return False, step + 1, count, width
        if update_active_set(kx, kz, b, fixed, pc, active, P) == 0:
            for i in range(n):
                for j in range(m):
                    if active[i, j] and P[i, j] < pc:
                        P[i, j] = pc
            return True, step + 1, count, width
    return False, MAX_ACTIVE_SET_STEPS, count, width


@njit(cache=True)
def clip_pressure(linear, fixed, pc, P_out, active_out):
    """Gümbel: P = max(linear, pc) at free vertices; active marks where nothing was cut."""
    n, m = linear.shape
    for i in range(n):
        for j in range(m):
            active_out[i, j] = linear[i, j] >= pc and not fixed[i, j]
            P_out[i, j] = linear[i, j] if fixed[i, j] or active_out[i, j] else pc


@njit(cache=True, inline="always")
def _reach(linear, fixed, pc, i, j, other):
    """Share of the cell from vertex (i, j) to column ``other`` up to where the linear pressure is the cavity's; 1 if it
    stays above, or is prescribed there."""
    if other < 0 or fixed[other, j] or linear[other, j] >= pc:
        return 1.0
    p = linear[i, j] - pc
    return p / (p + (pc - linear[other, j]))


@njit(cache=True, inline="always")
def _beside(i, linked):
    """Columns on either side, -1 where a ring is open."""
    n = linked.size
    prv, nxt = (i - 1 if i > 0 else n - 1), (i + 1 if i + 1 < n else 0)
    return prv if linked[prv] else -1, nxt if linked[i] else -1


@njit(cache=True)
def clip_in_cells(linear, fixed, linked, pc, P_out, active_out):
    """Gümbel's condition inside the cells: P of a vertex is the mean of the pressure that is left of the linear one.

    Between a vertex at the pressure p above the cavity's and one below it, the film ends in theta after a share s of
    the cell, ``s = p / (p - p_other)``: its integral there is ``p s / 2`` instead of p / 2. ``linked`` (n,): whether
    columns have a link to the next one.
    """
    n, m = linear.shape
    clip_pressure(linear, fixed, pc, P_out, active_out)
    for i in range(n):
        prv, nxt = _beside(i, linked)
        for j in range(m):
            if active_out[i, j]:
                reach = _reach(linear, fixed, pc, i, j, prv) + _reach(linear, fixed, pc, i, j, nxt)
                P_out[i, j] = pc + 0.5 * reach * (linear[i, j] - pc)


@njit(cache=True)
def rows_of_linear(linear, fixed, linked, pc, active, number, rows):
    """From weights (k, count) of P as `clip_in_cells` leaves it, none at clipped ones, to those of the linear pressure.

    ``d(p s) = s (2 - s) dp + s^2 dp_other``.
    """
    n, m = linear.shape
    for i in range(n):
        prv, nxt = _beside(i, linked)
        for j in range(m):
            if not active[i, j]:
                continue
            r, own = number[i, j], 0.0
            for other in (prv, nxt):
                s = _reach(linear, fixed, pc, i, j, other)
                own += 0.5 * s * (2.0 - s)
                if s < 1.0:
                    for k in range(rows.shape[0]):
                        rows[k, number[other, j]] += 0.5 * s * s * rows[k, r]
            for k in range(rows.shape[0]):
                rows[k, r] *= own


@njit(cache=True)
def prolong_set(coarse, fixed, fine_out):
    """Active set of a grid from that of every second vertex: active if a coarse vertex next to it is."""
    n, m = fine_out.shape
    nc = coarse.shape[0]
    for i in range(n):
        a = i // 2
        b = (a + i % 2) % nc
        for j in range(m):
            c = j // 2
            d = c + j % 2
            fine_out[i, j] = (coarse[a, c] or coarse[a, d] or coarse[b, c] or coarse[b, d]) and not fixed[i, j]
