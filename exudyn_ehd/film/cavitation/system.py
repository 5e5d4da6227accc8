"""One film problem and its solution, as arrays that closures read and write; steady films without a unique solution.

Symbols: kx, kz conductances of the links, b right-hand side, P pressure, all scaled (see
`exudyn_ehd.film.reynolds.links`).

Steady mass-conserving films without a unique solution
------------------------------------------------------
Let u be the pressure above the cavity's at full vertices and fill - 1 at cavitated ones, and R(u) the balances of
`exudyn_ehd.film.cavitation.closures`. The derivatives dR_i / du_j are <= 0 for i not j. The sum s_j of column j is the
flow that leaves the film per unit of u_j: conductances to prescribed vertices, Couette flow to those downstream, and
``area dH/dt`` in a cavity. Two films u and v satisfy
``sum_i sign(u_i - v_i) (R_i(u) - R_i(v)) >= sum_j s_j |u_j - v_j|``. If s >= 0, and if every vertex is connected to one
with s > 0, R is an M-function and the film is unique (W. C. Rheinboldt, J. Math. Anal. Appl. 32 (1970) 274). Two kinds
of films do not satisfy this condition:

* The gap of a steady film closes at a constant rate. Where it closes faster than oil flows out, a dry cavity may stay
  dry or fill up. The film with the most oil is chosen. A cold start or pseudo-transient continuation finds it, as they
  start from a full film; a warm start may not.
* Oil circulates in a row that has neither prescribed vertices nor pressure (`has_unfed_row`), without rates and axial
  Couette flow. ``fill H`` is then constant around the row, with any value from 0 to the minimum film thickness. A row
  whose neighbour has pressure receives oil from it.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.linear_film import ColumnLine, column_line
from exudyn_ehd.film.cavitation.oil_line import OilLine
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, fields_without_line
from exudyn_ehd.film.cavitation.states import CLIPPED, FULL, OIL
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import DensityField
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.status import Status


class FilmSystem:
    """Arrays of one film problem and its solution.

    Attributes
    ----------
    kx, kz, b : (n, m) arrays
        Link conductances and right-hand side.
    fixed : (n, m) bool array
        Vertices with prescribed ``pressure``.
    cavity_pressure : float
        Scaled cavity pressure.
    pressure : (n, m) array
        In: prescribed values at fixed vertices. Out: pressure of the film.
    linear_pressure : (n, m) array
        Pressure that solves the balances, to which adjoints refer. It is the same array as ``pressure``, unless loads
        are integrals of other pressures: clipped ones, or means up to a rupture line inside the cells.
    flow_pressure : (n, m) array
        Pressure that drives flows inside the film: ``pressure``, or ``linear_pressure`` if there is a ``column_line``.
    continued : (n, m) array or None
        ``linear_pressure``, with negative pressures beyond the rupture line, from which
        `exudyn_ehd.film.cavitation.linear_film.mean_in_cells` finds the line; None if that function is not used.
    column_line : ColumnLine or None
        Continuation of the pressure beyond the line, in a film of Swift and Stieber without pressure flow in theta.
    fx, fz, H, H_t, area : (n, m) arrays
        Couette fluxes of a full film, gap, its rate, control volumes; ``b`` already holds the fluxes and the squeeze.
    fill, mass_old : (n, m) arrays
        Film fraction, and fill H at the start of the step; only used by closures that conserve mass.
    prompt, late : (n, m) arrays
        Couette flows carry the fill ``prompt fill + late``, see `exudyn_ehd.film.reynolds.links`; 1 and 0 if it is not
        averaged over the step.
    inverse_step : float
        1 / time step since ``mass_old``, 1/s; 0: steady.
    closes : bool
        Whether the film is steady, conserves mass, and has a gap that closes somewhere; see the module.
    turns : float
        Scaled speed with which oil circulates in the rows of a steady film that conserves mass, 1/s; 0 with axial
        speed.
    rupture : RuptureLine
        Rupture line of a film of Swift and Stieber, inside the cells or on vertices.
    line : RuptureLine or None
        The same if the line lies inside the cells; None: on vertices.
    oil_line : OilLine or None
        Rupture line inside the cells of a film that conserves mass; None: on vertices.
    curve : (9, n m) array
        `CurveFields` of the vertices, with f = 0 and s = 1 where there is no line inside the cells.
    density : DensityField or None
        None: the density does not follow the pressure.
    instant : bool
        Whether the time step is only a small number with which the rates at an instant are found.
    linked : (n,) bool array
        Columns with a link to the next one.
    terms : FilmTerms
        Holds kx, kz, fx, fz, area and prompt. Couette flows carry the fill ``prompt fill + terms.late``: on curves,
        ``terms.late`` is smaller than ``late``.
    fields : (15, n, m) array
        Fields of ``terms``, then b, H, HF (gap on the links i -> i+1), H_t and pressure.
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
        self.rupture = RuptureLine(fields_without_line(shape), shape)
        self.oil_line: OilLine | None = None
        self.density: DensityField | None = None
        self.instant = False
        self.linked = grid.link_x != 0.0

    def count_in_cells(self, grid: FilmGrid, clips: bool) -> None:
        """Use means up to a rupture line inside the cells as pressures in loads: of the clipped linear film
        (``clips``), or of a film without pressure flow in theta."""
        if clips:
            self.continued = self.linear_pressure
            return
        self.column_line = line = column_line(grid, self.kz)
        self.linear_pressure, self.continued = line.solved, line.continued
        self.flow_pressure = line.solved

    def set_motion(self, steady: bool, rate: np.ndarray, vx: float, vz: float) -> None:
        """Set ``closes`` and ``turns`` from the gap's rate (n, m) and the scaled speeds of a film that conserves
        mass."""
        self.closes = steady and bool(rate.min() < 0.0)
        self.turns = abs(vx) if steady and vz == 0.0 else 0.0

    def take_density(self, density: DensityField) -> None:
        """Use a density that follows the pressure in all later solutions."""
        self.density = density
        if self.kind != OIL:
            self.fill, self.mass_old = np.ones((2, *self.H.shape))

    @property
    def curve(self) -> np.ndarray:
        """`CurveFields` of the vertices (9, n m), for films that Newton's method solves."""
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
        """Scaled pressure below which the density is constant."""
        return self.cavity_pressure if self.kind >= CLIPPED else -np.inf


# Pressure times the square of the gap over the scaled speed, a measure relative to the Couette flow, below which a
# vertex counts as being without pressure. A wedge causes about its eccentricity ratio, round-off about 1e-16. With
# larger values, rows with little oil supply count as unfed.
SMALLEST_PRESSURE = 1e-9


def status_of(s: FilmSystem, status: Status) -> Status:
    """Return the status of a solution; NO_OIL for a steady film in which a row receives no oil."""
    if status is not Status.CONVERGED or s.turns == 0.0:
        return status
    unfed = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
    return Status.NO_OIL if unfed and not s.H_t.any() else status


@njit(cache=True)
def has_unfed_row(P, H, fixed, turns, pc):
    """Return whether oil circulates in a row without pressure or prescribed vertices; ``turns`` of `FilmSystem`."""
    n, m = P.shape
    for j in range(m):
        fed = turns == 0.0
        for i in range(n):
            if fed:
                break
            fed = fixed[i, j] or (P[i, j] - pc) * H[i, j] * H[i, j] > SMALLEST_PRESSURE * turns
        if not fed:
            return True
    return False


@njit(cache=True)
def imbalance(terms, P, balance, full, ruptures, stored):
    """Return the largest residual of an unknown vertex over the largest flow that drives the film, and over the largest
    flow of any kind.

    Driving flows are Couette flows, storage, and pressure flows at prescribed vertices.

    Parameters
    ----------
    P, balance : (n, m) arrays
        Pressure above the cavity's, and residual.
    full, ruptures : (n, m) bool array, bool
        In a film that ``ruptures`` without mass conservation only ``full`` vertices have unknowns.
    stored : float
        Largest flow into storage of which the terms hold only a small difference; counts among flows of any kind.
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
