"""Cavitation closures: what the film does where the linear Reynolds equation would go below the cavity pressure.

Each closure is a small frozen object, which a scene names: what a film needs of it is `Closure`. All pressures
here are scaled (see `exudyn_ehd.film.reynolds.links`); ``cavity_pressure`` of the specs is a gauge pressure in Pa.

* `FullSommerfeld`: nothing; negative pressures stay.
* `Gumbel` (half Sommerfeld): the linear problem is solved, then pressures below the cavity pressure are cut off.
* `SwiftStieber` (Reynolds condition): the complementarity problem ``P >= Pc, A P - b >= 0, (P - Pc)(A P - b) = 0``,
  which `exudyn_ehd.film.cavitation.swift_stieber` solves. Vertices with neither pressure nor source (a film at rest)
  count as active, so that a film at rest has the tangent of the whole film: the sum of what a motion and its opposite
  meet (a concentric journal meets half of it).

`ElrodAdams` is mass-conserving cavitation (Jakobsson-Floberg-Olsson condition in the form of Elrod and Adams).

Every vertex is either full (``P >= Pc``, fill = 1, unknown P) or cavitated (``P = Pc``, 0 <= fill <= 1, unknown fill).
Its balance is

    sum over links of [k (P - P_neighbour) + f carried_upstream] + area (fill H - kept) / dt = 0,

with the Poiseuille conductance k, the Couette flux f of a full film (gap on the link), the fill carried from upstream,
which in a step is averaged over it (`exudyn_ehd.film.reynolds.links`), and ``kept`` by the film's history,
`exudyn_ehd.film.solvers.solver.FilmSolver.keep`. Without a history the film is steady and the last term is
``area fill dH/dt``. For given sets the system is linear; `exudyn_ehd.film.cavitation.solve` finds them with it. Should
it not, the film is approached through growing pseudo time steps, whose storage makes the matrices dominant enough.

Sources: H. G. Elrod, J. Lubrication Technology 103 (1981) 350; the one-unknown form after F. M. Alakhramsing, R. van
Ostayen, R. Eling, Lubricants 3 (2015) 256, and T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58
(2015) 18.

Pseudo-transient continuation for a film that Newton's method does not find from its initial guess.

An additional storage at every vertex slows the film down and is reduced step by step; the last solution has none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.linear_film import clip_pressure, extend_film, mean_in_cells, solve_linear
from exudyn_ehd.film.cavitation.solve import base_of, solve_system
from exudyn_ehd.film.cavitation.states import CLIPPED, OIL, RUPTURE
from exudyn_ehd.film.cavitation.swift_stieber import solve_rupturing
from exudyn_ehd.film.cavitation.system import FilmSystem, has_unfed_row
from exudyn_ehd.film.reynolds.balance import store_content
from exudyn_ehd.status import PlausibilityWarning, Status, require_bool, require_number, warn_user

MOST_STEPS = 200
# Rates of the storage over that of the film: of the first one, of one above which the continuation ends, of one below
# which the film without storage is tried, and of one below which it is not tried again.
FIRST, HOPELESS, LAST, LEAST = 100.0, 1e6, 1e-3, 1e-7
# Factors of the storage after a film that is found, and after one that is not.
FADES, GROWS = 0.3, 8.0
# Share of its compressibility with which an oil counts as nearly incompressible.
SOFTEST = 1e-9


def pseudo_time(attempt: Callable[[float], tuple[bool, int]], rate: float) -> tuple[bool, int]:
    """Find a film by pseudo-transient continuation; returns (found, Newton steps).

    Parameters
    ----------
    attempt : function of a rate, 1/s
        Solves with a storage of that rate, 0 for the film itself, and keeps a film that is found as the start of the
        next; returns (found, Newton steps).
    rate : float
        Rate of the film itself, 1/s, > 0.
    """
    extra, total = FIRST * rate, 0
    for _ in range(MOST_STEPS):
        ok, steps = attempt(extra)
        total += steps
        if not ok:
            extra *= GROWS
            if extra > HOPELESS * rate:
                return False, total
            continue
        extra *= FADES
        if extra < LAST * rate:
            ok, steps = attempt(0.0)
            total += steps
            if ok:
                return True, total
            if extra < LEAST * rate:
                return False, total
    return False, total


def recover(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Find a film that Newton's method does not find from a full one; returns (status, Newton steps).

    Where the density follows the pressure, Newton's method starts from the film of a nearly incompressible oil. If it
    fails and pressures reach the end of the law's range, the status is NO_PRESSURE. A film that is still not found is
    followed in pseudo time.
    """
    density, steps = s.density, 0
    if density is not None:
        work.warm = False
        scale, density.scale = density.scale, SOFTEST * density.scale
        ok, steps = solve_system(s, work)
        density.scale = scale
        beyond = ok and density.is_exhausted(s.linear_pressure)
        for crosses in (True, False) if ok else ():
            # the iteration oscillates about the end of the law, unless its steps stop there
            work.warm, density.crosses = True, crosses
            ok, count = solve_system(s, work)
            steps += count
            if ok:
                break
        density.crosses = False
        if ok or beyond or density.is_exhausted(s.linear_pressure):
            return (Status.CONVERGED if ok else Status.NO_PRESSURE), steps
    status, count = follow(s, work)
    return status, steps + count


def follow(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Follow a film in pseudo time from a full one; returns (status, Newton steps). The status is NO_OIL if rows run
    dry on the way."""
    largest = max(float(np.max(np.abs(s.fx))), float(np.max(np.abs(s.fz))), float(np.max(np.abs(s.H_t * s.area))))
    largest += float(np.max(s.kx) * np.max(np.abs(s.pressure[s.fixed] - base_of(s)), initial=0.0))
    rate = largest / float(np.min(s.area[s.area > 0.0])) + s.inverse_step
    mass = (s.mass_old if s.inverse_step > 0.0 else s.H).copy()
    work.warm = runs_dry = False

    def attempt(extra: float) -> tuple[bool, int]:
        nonlocal runs_dry
        inverse = s.inverse_step + extra
        blend = (s.inverse_step * s.mass_old + extra * mass) / inverse if inverse > 0.0 else s.mass_old
        # in a steady film the gap's rate is kept: extra (fill H - mass) + fill dH/dt
        H = s.H + s.H_t / extra if s.inverse_step == 0.0 < extra else s.H
        store_content(s.term_fields, H, s.H_t, inverse, blend, s.instant)
        ok, steps = solve_system(s, work)
        if ok:
            np.multiply(s.fill, s.H, out=mass)
            if s.density is not None:
                np.multiply(mass, s.density.rho, out=mass)
            runs_dry = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
        return ok, steps

    ok, steps = pseudo_time(attempt, rate if rate > 0.0 else 1.0)
    if ok:
        return Status.CONVERGED, steps
    return (Status.NO_OIL if runs_dry and not s.H_t.any() else Status.NOT_CONVERGED), steps


# Gauge pressure of the absolute vacuum, Pa, where the air presses most.
VACUUM = -1.1e5
Placed = TypeVar("Placed", bound="Closure")


@runtime_checkable
class Closure(Protocol):
    """Properties of a cavitation model that a film solver needs; its films are found by `solve_sets`.

    Derive a frozen dataclass from it, and set what differs.

    Attributes
    ----------
    cavity_pressure : float
        Gauge pressure at which the film ruptures and that its cavities have, Pa; -inf: it does not rupture.
    cavity_shear : float
        Share of the full film's Couette shear that the ruptured part transmits.
    conserves_mass : bool
        True: cavities hold oil, the film fraction. It decides before ``clips``.
    clips : bool
        True: a linear film of which pressures below the cavity's are cut off. False: pressures at least the cavity's,
        no oil from cavities, and one of both at every vertex (complementarity).
    line_in_cells : bool or None
        Whether the rupture line lies inside the cells of the grid; None: where the bearing's other options allow it.
    """

    cavity_pressure: float
    cavity_shear: float = 1.0
    conserves_mass: bool = False
    clips: bool = False
    line_in_cells: bool | None = False


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
class Gumbel(Closure):
    """Half-Sommerfeld (Gümbel) cavitation: solve the linear film, then cut off pressures below the cavity pressure.

    For comparison with `ClassicSOR` and older results. Violates mass conservation at the rupture line: at eccentricity
    ratio 0.8 the load is 15 % (L/D 1), 12 % (0.5) or 6 % (0.25) below that of `SwiftStieber`.

    Where an end or a supply area has more than the cavity pressure, do not use ``leakage`` and ``supply_flow``; take
    `SwiftStieber`. They are those of the linear film, whose tension beside the cavity sucks in oil that the cut then
    loses.

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

    def __post_init__(self) -> None:
        _check_closure(self)


@dataclass(frozen=True, kw_only=True)
class SwiftStieber(Closure):
    """Default cavitation (Swift-Stieber or Reynolds): pressure and its gradient vanish at the rupture line.

    The standard model for steadily loaded bearings. The pressure is at least the cavity pressure everywhere; oil in the
    cavity is not counted (`ElrodAdams` does). Cheaper than `Gumbel` here, because only the full film is factored.

    With the rupture line inside the cells of the grid the error of stiffness and damping is at most 1.5 % in any
    direction (default grid, eccentricity ratio up to 0.9, L/D 0.25 to 2). On vertices it is up to 13 %, in two thirds
    of the time. Loads differ by 0.2 %. Errors of a `ShortBearing` are told there.

    With an `ElasticLiner` or a density law, a rupture line inside the cells takes 1.4 times (liner) or 1.7 times
    (density law) the time of one on vertices (`exudyn_ehd.film.solvers.liner.line`). It does not lower the errors where
    the pressure of a single cell deflects a soft liner.

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

    def __post_init__(self) -> None:
        _check_closure(self)


def solve_sets(system: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Find a film whose coefficients do not follow its pressure, from the last one if ``work.warm``, else from a full
    one; returns (status, linear solves)."""
    s = system
    if s.kind == OIL or s.density is not None:
        outcome = _solve_by_newton(s, work)
    elif s.kind == RUPTURE:
        outcome = _solve_rupturing(s, work)
    else:
        outcome = _solve_linear(s, work)
    if s.kind == CLIPPED:
        linear, pc = s.linear_pressure, s.cavity_pressure
        clip_pressure(linear, s.fixed, pc, s.pressure, work.active)
        if s.continued is not None:
            mean_in_cells(linear, s.fixed, s.linked, pc, work.active, s.pressure)
    return outcome


def _solve_linear(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve the linear film of all vertices that are not prescribed."""
    np.logical_not(s.fixed, out=work.active)
    links, P = (s.kx, s.kz, s.b), s.linear_pressure
    ok, work.count, work.width = solve_linear(links, work.active, work.factor, work.unknowns, P)
    return (Status.CONVERGED if ok else Status.NOT_CONVERGED), 1


def _solve_rupturing(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film of Swift and Stieber, and continue it behind a line between its columns."""
    ok, steps = solve_rupturing(s, s.rupture, work, s.line is not None)
    if s.column_line is not None:
        size, pc = work.count, s.cavity_pressure
        work.count = extend_film(s.column_line, s.b, (s.fixed, work.active), pc, work.factor, size, s.pressure)
    return (Status.CONVERGED if ok else Status.NOT_CONVERGED), steps


def _solve_by_newton(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film that conserves mass or whose density follows the pressure, by Newton's method; where that does not
    find it from a full film, by `recover`."""
    was_warm, status = work.warm, Status.CONVERGED
    store_content(s.term_fields, s.H, s.H_t, s.inverse_step, s.mass_old, s.instant)
    ok, steps = solve_system(s, work)
    if not ok:
        status = Status.NOT_CONVERGED
    elif s.closes and has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure):
        ok = False
    if not (ok or was_warm):
        status, count = recover(s, work)
        steps += count
    work.warm = status is Status.CONVERGED
    return status, steps


def check_cavity_pressure(name: str, pressure: float) -> None:
    """Refuse what is no pressure; warn of one below the absolute vacuum, which no gas in a cavity has."""
    where = f"{name}.cavity_pressure"
    if require_number(where, pressure, "Pa") < VACUUM:
        warn_user(
            f"{where}: {pressure:g} Pa is unusual, bearings have -1e5 Pa (vapour, released air) to what their ends "
            f"have: it is a gauge pressure, and the absolute vacuum is at -1e5 Pa.",
            PlausibilityWarning,
        )


def place_line(closure: Placed, in_cells: bool) -> Placed:
    """A closure whose rupture line has a place: ``in_cells`` where it leaves that open."""
    open_line = closure.line_in_cells is None
    return replace(closure, line_in_cells=in_cells) if open_line else closure  # type: ignore[type-var]


def _check_closure(closure: Gumbel | SwiftStieber) -> None:
    name = type(closure).__name__
    check_cavity_pressure(name, closure.cavity_pressure)
    require_number(f"{name}.cavity_shear", closure.cavity_shear, at_least=0.0, at_most=1.0, hint="it is a share.")
    if closure.line_in_cells is not None or isinstance(closure, Gumbel):
        object.__setattr__(closure, "line_in_cells", require_bool(f"{name}.line_in_cells", closure.line_in_cells))


@dataclass(frozen=True, kw_only=True)
class ElrodAdams(Closure):
    """Cavitation that conserves the oil: rupture and reformation, with the oil in the cavity remembered in time.

    For starved or grooved bearings, oscillating loads, and wherever leakage and friction of the cavity matter. In a
    joint it needs an implicit solver.

    It needs a supply of oil: end or supply pressures above the cavity pressure. Without one, `steady` raises an error;
    in a joint the film runs dry within some turns, and a warning says so.

    From step to step it remembers the void, the part of the gap without oil. Oil flows balance to round-off. The oil
    content follows from them but for half of a step's change of the gap, a difference that does not add up over steps.

    With ``line_in_cells=True`` (default grid, eccentricity ratio 0.6 to 0.9, L/D 0.5 and 1) the error of steady
    stiffness falls from 9 to 1.5 %, in two to three times the time. The spread of damping over the direction of the
    load falls from 8 to 1 % with a cavity pressure of -10 bar. The line where the film reforms stays on vertices, and
    matters more the nearer the cavity's pressure is to that of the ends: at -1 bar the spread of damping falls from 49
    to 23 %, and that of stiffness from 9 to 4 %; on 192 x 20 vertices that of damping falls from 3 to 2 %.

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

    def __post_init__(self) -> None:
        check_cavity_pressure("ElrodAdams", self.cavity_pressure)
        object.__setattr__(self, "line_in_cells", require_bool("ElrodAdams.line_in_cells", self.line_in_cells))
