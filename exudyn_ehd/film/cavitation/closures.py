"""Cavitation closures: models of the film where the linear Reynolds equation gives less than the cavity pressure.

Each closure is a small frozen object, an option of a bearing; `Closure` is the interface that film solvers use. All
pressures here are scaled (see `exudyn_ehd.film.reynolds.links`), except the option ``cavity_pressure``, a gauge
pressure in Pa.

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
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from exudyn_ehd.status import PlausibilityWarning, require_bool, require_number, warn_user

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

    def __post_init__(self) -> None:
        _check_closure(self)


@dataclass(frozen=True, kw_only=True)
class SwiftStieber(Closure):
    """Default cavitation (Swift-Stieber or Reynolds): pressure and its gradient vanish at the rupture line.

    The standard model for steadily loaded bearings. The pressure is at least the cavity pressure everywhere; oil in the
    cavity is not counted (`ElrodAdams` does). Cheaper than `Gumbel` here, because only the full film is factored.

    With the rupture line inside the cells of the grid the error of stiffness and damping is at most 1.5 % in any
    direction (default grid, eccentricity ratio up to 0.9, L/D 0.25 to 2). On vertices it is up to 13 %, in two thirds
    of the time. Loads differ by 0.2 %. For errors of a `ShortBearing` see there.

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


def check_cavity_pressure(name: str, pressure: float) -> None:
    """Raise `InputError` unless ``pressure`` is a number; warn of one below the absolute vacuum."""
    where = f"{name}.cavity_pressure"
    if require_number(where, pressure, "Pa") < VACUUM:
        warn_user(
            f"{where}: {pressure:g} Pa is unusual, bearings have -1e5 Pa (vapour, released air) to what their ends "
            f"have: it is a gauge pressure, and the absolute vacuum is at -1e5 Pa.",
            PlausibilityWarning,
        )


def place_line(closure: Placed, in_cells: bool) -> Placed:
    """Return the closure with ``line_in_cells`` set to ``in_cells`` if it is None."""
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

    The state of the film is the void, the part of the gap without oil. Oil flows balance to round-off. The oil content
    differs from their sum by at most half of a step's change of the gap, which does not accumulate over steps.

    With ``line_in_cells=True`` (default grid, eccentricity ratio 0.6 to 0.9, L/D 0.5 and 1) the error of steady
    stiffness falls from 9 to 1.5 %, in two to three times the time. The spread of damping over the direction of the
    load falls from 8 to 1 % with a cavity pressure of -10 bar. The reformation line stays on vertices. Its effect is
    the larger the nearer the cavity pressure is to that of the ends: at -1 bar the spread of damping falls from 49 to
    23 %, and that of stiffness from 9 to 4 %; on 192 x 20 vertices that of damping falls from 3 to 2 %.

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
