"""Cavitation closures, and the film problem that they pose.

Closures are models of the film where the linear Reynolds equation gives less than the cavity pressure. Each closure is
a small frozen object, an option of a bearing; `Closure` is the interface that film solvers use. `FilmSystem` has the
arrays of one film problem and of its solution. All pressures here are scaled (see `exudyn_ehd.film.reynolds.links`),
except the option ``cavity_pressure``, a gauge pressure in Pa.

* `FullSommerfeld`: no cavitation; negative pressures stay.
* `Gumbel` (half Sommerfeld): the linear problem is solved, then pressures below the cavity pressure are cut off.
* `SwiftStieber` (Reynolds condition): the complementarity problem ``P >= Pc, A P - b >= 0, (P - Pc)(A P - b) = 0``,
  which `exudyn_ehd.film.solvers.newton` solves. Vertices with neither pressure nor source (a film at rest) count as
  active. So a film at rest has the tangent of the full film, which is the sum of those for a motion and its opposite:
  a concentric journal that starts to move feels half of it.

`ElrodAdams` is mass-conserving cavitation (Jakobsson-Floberg-Olsson condition in the form of Elrod and Adams).

Every vertex is either full (``P >= Pc``, fill = 1, unknown P) or cavitated (``P = Pc``, 0 <= fill <= 1, unknown fill).
Its balance is

    sum over links of [k (P - P_neighbour) + f carried_upstream] + area (fill H - kept) / dt = 0,

with the Poiseuille conductance k, the Couette flux f of a full film (gap on the link), and the fill carried from
upstream, which is averaged over the step (`exudyn_ehd.film.reynolds.links`). ``kept`` is the oil content at the start
of the step, from `exudyn_ehd.film.solvers.solver.FilmSolver.keep`. Without a history the film is steady and the last
term is ``area fill dH/dt``. For a given active set the system is linear; `exudyn_ehd.film.solvers.newton` finds set and
solution. If it fails, pseudo-transient continuation follows: the storage of growing pseudo time steps makes the
matrices more dominant.

Sources: H. G. Elrod, J. Lubrication Technology 103 (1981) 350; the one-unknown form after F. M. Alakhramsing, R. van
Ostayen, R. Eling, Lubricants 3 (2015) 256, and T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58
(2015) 18.

Steady mass-conserving films without a unique solution
------------------------------------------------------
Let u be the pressure above the cavity's at full vertices and fill - 1 at cavitated ones, and R(u) the balances of
`ElrodAdams`. The derivatives dR_i / du_j are <= 0 for i not j. The sum s_j of column j is the
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

from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Protocol, TypeVar, runtime_checkable

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.linear_film import ColumnLine, column_line
from exudyn_ehd.film.cavitation.oil_line import OilLine
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, fields_without_line
from exudyn_ehd.film.cavitation.states import CLIPPED, FULL, OIL
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import DensityField
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.status import (
    NOT_NEGATIVE,
    ROUNDING,
    Checked,
    PlausibilityWarning,
    Status,
    require_bool,
    require_number,
    warn_user,
)

# Lowest gauge pressure of the absolute vacuum, Pa, at the highest air pressure. Lower cavity pressures cause a warning.
VACUUM = -1.1e5
Placed = TypeVar("Placed", bound="Closure")


@runtime_checkable
class Closure(Protocol):
    """Properties of a cavitation model that a film solver needs; its films are found by `exudyn_ehd.film.solvers.sets`.

    For a model of your own, derive a frozen dataclass from it, and set the attributes that differ.

    Attributes
    ----------
    cavity_pressure : float
        Gauge pressure at which the film ruptures and which its cavities have, Pa; -inf: the film does not rupture.
    cavity_shear : float
        Couette shear in the ruptured part of the film over that of a full film.
    conserves_mass : bool
        True: the oil in cavities is counted, by a film fraction; ``clips`` then has no effect.
    clips : bool
        True: the linear film is solved, and pressures below the cavity pressure are cut off. False: complementarity
        problem, with pressures of at least the cavity pressure.
    line_in_cells : bool or None
        Whether the rupture line lies inside the cells of the grid; None: where the bearing's other options allow it.
    """

    cavity_pressure: float
    cavity_shear: float = 1.0
    conserves_mass: bool = False
    clips: bool = False
    line_in_cells: bool | None = False


def check_cavity_pressure(where: str, pressure: float) -> None:
    """Raise `InputError` unless ``pressure`` is a number; warn of one below the absolute vacuum."""
    if require_number(where, pressure, "Pa") < VACUUM:
        warn_user(
            f"{where}: {pressure:g} Pa is unusual, bearings have -1e5 Pa (vapour, released air) to what their ends "
            f"have: it is a gauge pressure, and the absolute vacuum is at -1e5 Pa.",
            PlausibilityWarning,
        )


class _Ruptures(Closure, Checked):
    """Base of the closures of films that rupture: checks of their arguments."""

    checks: ClassVar = {
        "cavity_pressure": check_cavity_pressure,
        "cavity_shear": partial(NOT_NEGATIVE, at_most=1.0, hint="it is a share."),
        "line_in_cells": require_bool,
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.line_in_cells is not None:
            object.__setattr__(self, "line_in_cells", bool(self.line_in_cells))


@dataclass(frozen=True, kw_only=True)
class FullSommerfeld(Closure):
    """No cavitation: the film carries tension.

    For comparison with closed forms and for fully flooded, pressurised films.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, cavitation=ehd.FullSommerfeld())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    14368
    """

    cavity_pressure = -np.inf


@dataclass(frozen=True, kw_only=True)
class Gumbel(_Ruptures):
    """Half-Sommerfeld (Gümbel) cavitation: solve the linear film, then cut off pressures below the cavity pressure.

    For comparison with `ClassicSOR` and older results. Violates mass conservation at the rupture line: at eccentricity
    ratio 0.8 the load is 15 % (L/D 1), 12 % (0.5) or 6 % (0.25) below that of `SwiftStieber`.

    Where an end or a supply area has more than the cavity pressure, do not use ``leakage`` and ``supply_flow``; take
    `SwiftStieber`. Both are flows of the linear film, whose tension beside the cavity draws in oil that is then lost.

    Parameters
    ----------
    cavity_pressure : float, default 0.0
        Gauge pressure of the cavity, Pa.
    cavity_shear : float, default 1.0
        Shear stress of sliding in the cavity over that of a full film, 0 to 1.
    line_in_cells : bool, default False
        True: the rupture line lies inside the cells of the grid, where the linear pressure is the cavity pressure;
        stiffness and damping are then of second order. Not with an `ElasticLiner`. False: it lies on vertices.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, cavitation=ehd.Gumbel())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    12032
    """

    cavity_pressure: float = 0.0
    cavity_shear: float = 1.0
    line_in_cells: bool = False

    clips = True


@dataclass(frozen=True, kw_only=True)
class SwiftStieber(_Ruptures):
    """Default cavitation (Swift-Stieber or Reynolds): pressure and its gradient vanish at the rupture line.

    The standard model for steadily loaded bearings. The pressure is at least the cavity pressure everywhere; oil in the
    cavity is not counted (`ElrodAdams` does). Cheaper than `Gumbel` here, because only the full film is factored.

    A cavity stays full where its gap widens. ``supply_flows``, and temperatures by `FilmEnergy`, omit the oil that it
    makes there, for grooves along the axis and pockets in the bore that have a given pressure. With one of them within
    30 degrees of the largest gap, over at least 0.6 of the length, nine of ten bearings give, over the numbers of
    `ElrodAdams`: supply flow 0.7 to 1.1 (few down to 0.3), power loss 1.0 to 1.3, ``oil_flow`` 1.05 to 1.6; rise of the
    temperature by `FilmEnergy` in the mean 0.65 to 1.0, at its peak 1.0 to 1.2, by `LumpedThermal` 0.85 to 1.1.
    In front of other supply areas this oil is counted: their flow is too small or even negative, and it cools the film,
    whose rises are down to half of the true ones. Take `ElrodAdams` for them, for two grooves, and for a groove that is
    further from the largest gap.

    With the rupture line inside the cells of the grid the error of stiffness and damping is at most 1.5 % in any
    direction (default grid, eccentricity ratio up to 0.9, L/D 0.25 to 2). On vertices it is up to 13 %, in two thirds
    of the time. Loads differ by 0.2 %. For errors of a `ShortBearing` see there.

    With an `ElasticLiner` or a density law, a rupture line inside the cells takes 1.4 times (liner) or 1.7 times
    (density law) the time of one on vertices (`exudyn_ehd.film.cavitation.rupture_line`). It does not lower the errors
    where the pressure of a single cell deflects a soft liner.

    Parameters
    ----------
    cavity_pressure : float, default 0.0
        Gauge pressure of the cavity, Pa.
    cavity_shear : float, default 1.0
        Shear stress of sliding in the cavity over that of a full film, 0 to 1.
    line_in_cells : bool or None, default None
        True: the rupture line lies inside the cells of the grid (`exudyn_ehd.film.cavitation.rupture_line`). False: on
        its vertices. None: inside the cells, but on vertices in a `ShortBearing` with a shear or density law, in a
        `SphericalBearing`, and on thrust faces with pads; `JournalBearing.closure` tells which.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, cavitation=ehd.SwiftStieber())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2])), round(film.leakage, 8)  # N, m^3/s
    (13615, 3.79e-06)
    """

    cavity_pressure: float = 0.0
    cavity_shear: float = 1.0
    line_in_cells: bool | None = None


def place_line(closure: Placed, in_cells: bool) -> Placed:
    """Return the closure with ``line_in_cells`` set to ``in_cells`` if it is None."""
    open_line = closure.line_in_cells is None
    return replace(closure, line_in_cells=in_cells) if open_line else closure  # type: ignore[type-var]


@dataclass(frozen=True, kw_only=True)
class ElrodAdams(_Ruptures):
    """Cavitation that conserves the oil: rupture and reformation, with the oil in the cavity remembered in time.

    For starved or grooved bearings, oscillating loads, and wherever leakage and friction of the cavity matter. In a
    joint it needs an implicit solver.

    It needs a supply of oil: end or supply pressures above the cavity pressure. Without one, `steady` raises an error;
    in a joint the film runs dry within some turns, and a warning says so.

    The state of the film is the void, the part of the gap without oil. Oil flows balance to round-off. The oil content
    differs from their sum by at most half of a step's change of the gap, which does not accumulate over steps.

    Oil content is transported with second order along theta. In five journals under loads that turn, the orbit on 96
    columns is within 2.1 % of the film thickness of that on 384 (``tests/mechanisms/test_oil_in_time.py``). The error
    by the time steps is of first order: orbits of a rotor with an unbalance are 2 % too small or large with 120 steps
    per turn, 1 % with 240 (``tests/coupling/rotor/test_solve.py``).

    With ``line_in_cells=True`` (default grid, eccentricity ratio 0.6 to 0.9, L/D 0.5 and 1) the error of steady
    stiffness falls from 9 to 1.5 %, in two to three times the time. Damping depends on the direction of the load, by
    the grid alone: at half of the speed (L/D 1, eccentricity ratio 0.8) this spread is 0.4 % in place of 3.3 %, with a
    cavity pressure of -10 bar. The reformation line stays on vertices. Its effect is the larger the nearer the cavity
    pressure is to that of the ends: at -1 bar the spread is 5 % in place of 9 %, on 192 x 20 vertices 2 % in place of
    3 %. There a second threshold of whirl, at a third of the critical mass, exists for some directions only on the
    default grid.

    Parameters
    ----------
    cavity_pressure : float, default 0.0
        Gauge pressure of the cavity, Pa; about -1e5 for oil vapour or released air, 0 for a vented cavity.
    line_in_cells : bool, default False
        True: the rupture line lies inside the cells of the grid (`exudyn_ehd.film.cavitation.oil_line`); not in a
        `ShortBearing`. False: it lies on vertices.

    Source
    ------
    H. G. Elrod, J. Lubrication Technology 103 (1981) 350; one unknown per vertex after Alakhramsing et al., Lubricants
    3 (2015) 256, and Woloszynski et al., Tribology Letters 58 (2015) 18.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2])), round(float(film.fill.min()), 2)  # N, least share of oil
    (12179, 0.12)
    """

    cavity_pressure: float = 0.0
    line_in_cells: bool = False

    conserves_mass = True


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
    rise : (n, m) array
        Part of ``late``: rise of the fill from the vertex to the links downstream, 0 in a steady film.
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
        self.prompt, self.late, self.rise = self.terms.prompt, np.zeros(shape), np.zeros(shape)
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


def status_of(s: FilmSystem, status: Status) -> Status:
    """Return the status of a solution; NO_OIL for a steady film in which a row receives no oil."""
    if status is not Status.CONVERGED or s.turns == 0.0:
        return status
    unfed = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
    return Status.NO_OIL if unfed and not s.H_t.any() else status


def has_unfed_row(P: np.ndarray, H: np.ndarray, fixed: np.ndarray, turns: float, pc: float) -> bool:
    """Return whether oil circulates in a row without pressure or prescribed vertices; ``turns`` of `FilmSystem`.

    A vertex is without pressure if pressure times the square of the gap over the scaled speed, a measure relative to
    the Couette flow, is nothing. A wedge causes about its eccentricity ratio, round-off about 1e-16.
    """
    fed = fixed | ((P - pc) * H * H > ROUNDING * turns)
    return turns != 0.0 and not fed.any(axis=0).all()


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
