"""Cavitation closures: what the film does where the linear Reynolds equation would go below the cavity pressure.

Each closure is a small frozen object, which a scene names: what a film needs of it is `Closure`. All pressures
here are scaled (see `exudyn_ehd.film.reynolds.links`); ``cavity_pressure`` of the specs is a gauge pressure in Pa.

* `FullSommerfeld`: nothing; negative pressures stay.
* `Gumbel` (half Sommerfeld): the linear problem is solved, then pressures below the cavity pressure are cut off.
* `SwiftStieber` (Reynolds condition): the complementarity problem ``P >= Pc, A P - b >= 0, (P - Pc)(A P - b) = 0``,
  which `exudyn_ehd.film.cavitation.swift_stieber` solves. Vertices with neither pressure nor source (a film at rest)
  count as active, so that a film at rest has the tangent of the whole film: the sum of what a motion and its opposite
  meet (a concentric journal meets half of it).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.linear_film import clip_pressure, extend_film, mean_in_cells, solve_linear
from exudyn_ehd.film.cavitation.pseudo_time import recover
from exudyn_ehd.film.cavitation.solve import solve_system
from exudyn_ehd.film.cavitation.states import CLIPPED, OIL, RUPTURE
from exudyn_ehd.film.cavitation.steady_oil import has_unfed_row
from exudyn_ehd.film.cavitation.swift_stieber import solve_rupturing
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.reynolds.balance import store_content
from exudyn_ehd.status import PlausibilityWarning, Status, require_bool, require_number, warn_user

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

    Violates mass conservation at the rupture line; load 15 % low against `SwiftStieber` at eccentricity ratio 0.8. It
    is the paper's condition. Flows through ends and supply areas with more than the cavity's pressure are those of the
    linear film: beside the cavity it sucks in oil that the cut then loses, at a rate that hardly depends on that
    pressure. ``leakage`` and ``supply_flow`` are then those of this condition, not of a bearing; take `SwiftStieber`.

    Parameters
    ----------
    cavity_pressure : float, default 0.0
        Gauge pressure of the cavity, Pa.
    cavity_shear : float, default 1.0
        Share of the full film's Couette shear that the ruptured part transmits, 0 to 1.
    line_in_cells : bool, default False
        True: pressures act up to where the linear one is the cavity's, inside the cells of the grid (order two in
        stiffness and damping); not with elastic liners. False: up to the vertex in front of it.

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

    The standard closure for steadily loaded bearings, and cheaper than `Gumbel` here because only the unbroken film is
    factored.

    Inside the cells of the grid the line lies where it is, and stiffness and damping are of second order, within 1.5 %
    in any direction (default grid, eccentricity ratio up to 0.9, L/D 0.25 to 2). On the vertices of the
    grid they are up to 13 % off, in two thirds of the time. Loads differ by 0.1 %.

    ``line_in_cells=None`` is inside the cells, but for `ShortBearing` with a shear or density law. The line of a
    `ShortBearing` lies between its columns; see there for its errors.
    On an `ElasticLiner` and with density laws the line is where the film has the cavity's pressure
    (`exudyn_ehd.film.solvers.liner.line`), in about 1.4 times (liner) and 1.7 times (density law) of the time with it
    on the vertices; where a soft liner is deflected by the pressure of a single cell errors are those of the grid.

    Parameters
    ----------
    cavity_pressure : float, default 0.0
        Gauge pressure of the cavity, Pa.
    cavity_shear : float, default 1.0
        Share of the full film's Couette shear that the ruptured part transmits, 0 to 1.
    line_in_cells : bool or None, default None
        True: the rupture line lies inside the cells of the grid (`exudyn_ehd.film.cavitation.rupture_line`). False: on
        its vertices. None: inside the cells, with the exception above; `JournalBearing.closure` tells which.

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
