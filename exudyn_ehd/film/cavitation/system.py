"""One film problem and its solution, as arrays that closures read and write; steady films that are not determined.

Symbols: kx, kz conductances of the links, b right-hand side, P pressure, all scaled (see
`exudyn_ehd.film.reynolds.links`).

Steady mass-conserving films that their equations alone do not determine
------------------------------------------------------------------------
Let u be the pressure above the cavity's at full vertices and fill - 1 at cavitated ones, and R(u) the balances of
`exudyn_ehd.film.cavitation.closures`. The derivatives dR_i / du_j are <= 0 for i not j. The sum s_j of column j is
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

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.linear_film import ColumnLine, column_line
from exudyn_ehd.film.cavitation.oil_line import OilLine
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, straight
from exudyn_ehd.film.cavitation.states import CLIPPED, FULL, OIL
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import DensityField
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.status import Status


class FilmSystem:
    """One film problem and its solution, as arrays that closures read and write; steady films that are not determined.

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
        Pressure that solves the linear film, on which the adjoint is received; the same array as ``pressure`` unless
        other pressures count in loads: clipped ones, or those up to a line inside the cells.
    flow_pressure : (n, m) array
        Pressure that drives flows inside the film: ``pressure``, or where a line lies between columns the linear one.
    continued : (n, m) array or None
        ``linear_pressure``, beyond a rupture line with the negative pressures that place it inside the cells of
        `exudyn_ehd.film.cavitation.linear_film.mean_in_cells`; None where no line lies there.
    column_line : ColumnLine or None
        What continues it in a film of Swift and Stieber without pressure flow in theta.
    fx, fz, H, H_t, area : (n, m) arrays
        Couette fluxes of a full film, gap, its rate, control volumes; ``b`` already holds the fluxes and the squeeze.
    fill, mass_old : (n, m) arrays
        Film fraction, and the old value of fill H; only used by closures that conserve mass.
    prompt, late : (n, m) arrays
        Of `exudyn_ehd.film.reynolds.links`; 1 and 0 without.
    inverse_step : float
        1 / time step since ``mass_old``, 1/s; 0: steady.
    closes : bool
        Whether a steady film conserves mass and its gap closes somewhere; see
        `exudyn_ehd.film.cavitation.system`.
    turns : float
        Scaled speed with which oil goes round in the rows of a steady film that conserves mass, 1/s; 0 with axial
        speed.
    rupture : RuptureLine
        Where a film of Swift and Stieber ends.
    line : RuptureLine or None
        The same if it may end inside its cells; None: on vertices.
    oil_line : OilLine or None
        The same of a film that conserves mass.
    curve : (9, n m) array
        `CurveFields` of the vertices; straight ones of a film without a line in its cells.
    density : DensityField or None
        None: the density does not follow the pressure.
    instant : bool
        Whether the time step stands for none.
    linked : (n,) bool array
        Columns with a link to the next one.
    terms : FilmTerms
        Holds kx, kz, fx, fz, area and prompt. Couette flows take ``prompt fill + terms.late`` along: on curves it is
        smaller than ``late``.
    fields : (15, n, m) array
        Those of ``terms``, then b, H, HF (gap on the links i -> i+1), H_t and pressure.
    """

    def __init__(self, grid: FilmGrid, kind: int) -> None:
        shape, self.kind = grid.shape, kind
        self.fields = np.zeros((15, *shape))
        self.terms = FilmTerms(*(*self.fields[:10], grid.fixed))
        self.kx, self.kz, self.fx, self.fz = self.fields[:4]
        self.b, self.H, self.HF, self.H_t, self.pressure = self.fields[10:]
        self.H[:] = self.HF[:] = 1.0
        self.fixed = grid.fixed
        self.cavity_pressure = 0.0
        self.linear_pressure = np.zeros(shape) if kind == CLIPPED else self.pressure
        self.flow_pressure = self.pressure
        self.area, self.terms.area[:] = grid.area, grid.area
        self.inverse_step = 0.0
        self.closes, self.turns = False, 0.0
        empty = np.ones(shape if kind == OIL else (0, 0))
        self.fill, self.mass_old = empty, empty.copy()
        self.prompt, self.late = self.terms.prompt, np.zeros(shape)
        self.prompt[:] = 1.0
        self.line: RuptureLine | None = None
        self.column_line: ColumnLine | None = None
        self.continued: np.ndarray | None = None
        self.rupture = RuptureLine(straight(shape), shape)
        self.oil_line: OilLine | None = None
        self.density: DensityField | None = None
        self.instant = False
        self.linked = grid.link_x != 0.0

    def count_in_cells(self, grid: FilmGrid, clips: bool) -> None:
        """Let pressures count in loads up to a line inside the cells: where the film is clipped, or between columns."""
        if clips:
            self.continued = self.linear_pressure
            return
        self.column_line = line = column_line(grid, self.kz)
        self.linear_pressure, self.continued = line.solved, line.continued
        self.flow_pressure = line.solved

    def see_motion(self, steady: bool, rate: np.ndarray, vx: float, vz: float) -> None:
        """Take over the gap's rate (n, m) and the scaled speeds of a film that conserves mass."""
        self.closes = steady and bool(rate.min() < 0.0)
        self.turns = abs(vx) if steady and vz == 0.0 else 0.0

    def take_density(self, density: DensityField) -> None:
        """Let the density follow the pressure in all later solutions."""
        self.density = density
        if self.kind != OIL:
            self.fill, self.mass_old = np.ones((2, *self.H.shape))

    @property
    def curve(self) -> np.ndarray:
        """Fields of the vertices' curves, of a film that Newton's method solves."""
        return self.rupture.block

    @property
    def film(self) -> tuple[np.ndarray, ...]:
        """Fields, prescribed vertices, ``late``, and fields of the curves, as kernels take them."""
        return self.fields, self.fixed, self.late, self.curve

    @property
    def base(self) -> float:
        """Scaled cavity pressure, 0 for a film without cavitation."""
        return self.cavity_pressure if self.kind != FULL else 0.0

    @property
    def floor(self) -> float:
        """Scaled pressure below which the density stays."""
        return self.cavity_pressure if self.kind >= CLIPPED else -np.inf


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
