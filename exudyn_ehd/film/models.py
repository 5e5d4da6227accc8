"""Film models of a bearing, with their grids and solvers; the only place that distinguishes between the models.

Without axial flow (`LongBearing`) a closed ring keeps its oil and has no reference pressure: a complementarity
condition can't remove any, so that its solution is the full film with its lowest pressure at the cavity's. One line of
prescribed pressure is therefore required: the line of maximum gap or an axial groove.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

from exudyn_ehd.film.arcs import Arc, arc_grid
from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.grid import STRETCH, FilmGrid, bearing_grid, long_bearing_grid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.solvers.sor import ClassicSolver, ClassicSOR
from exudyn_ehd.film.solvers.winkler import Liner
from exudyn_ehd.film.supply.areas import AxialGroove, SupplyArea, placed
from exudyn_ehd.film.supply.restrictors import sealed_grid
from exudyn_ehd.film.supply.rows import column_of_hole, meeting_rows, supply_rows
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.status import Checked, InputError, require_count

# Columns of a film that leaves them to the bearing.
FEWEST_COLUMNS, MOST_COLUMNS = 96, 176
# Bytes of a film's banded matrix.
LARGEST_MATRIX = 4e9


class _OnVertices(Checked):
    """Base of the films on vertices in theta and z: checks of their grid."""

    n_theta: int | None
    n_z: int
    circumferential_pressure_flow: bool

    checks: ClassVar = {
        "n_theta": partial(require_count, at_least=16, hint="96 is a good start."),
        "n_z": partial(require_count, at_least=4, hint="10 is a good start."),
        "stretch": STRETCH,
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = MOST_COLUMNS if self.n_theta is None else self.n_theta
        coupled = self.n_z if self.circumferential_pressure_flow else 1
        # Python's integers: neither numpy's nor floats hold any product
        if 16 * int(columns) * int(self.n_z) * int(coupled) > LARGEST_MATRIX:
            raise InputError(
                f"{type(self).__name__}: a grid of {columns} x {self.n_z} takes more than {LARGEST_MATRIX:g} bytes for "
                "one matrix; 192 x 16 is fine."
            )


@dataclass(frozen=True, kw_only=True)
class FiniteLength(_OnVertices):
    """Default film: the full, two-dimensional Reynolds equation on a grid over angle and length.

    Largest error of the load against extrapolated grids (Swift-Stieber, L/D from 1/8 to 1, any direction of the
    journal), by n_theta x n_z and the eccentricity ratio eps:

    ========  ===========  ============
    grid      eps <= 0.8   eps = 0.95
    ========  ===========  ============
    48 x 6    0.7 %        3.3 %
    64 x 8    0.4 %        1.7 %
    96 x 10   0.2 %        0.7 %
    128 x 12  0.1 %        0.4 %
    192 x 16  0.05 %       0.15 %
    ========  ===========  ============

    So 1 % in the load at eps 0.8 takes 48 x 6, and 0.1 % takes 128 x 12. Stiffness K and damping C have larger errors,
    most of all in narrow bearings and with tilted journals, whose film narrows towards one end. Error of their largest
    entry, K up to eps 0.95, C up to the eps named; a tilt of 0.9 is 0.9 of the tilt that closes the gap:

    ========  ==========  =========  ============  ============  ======================
    grid      L/D         K          C, eps 0.8    C, eps 0.95   load, K, C at tilt 0.9
    ========  ==========  =========  ============  ============  ======================
    96 x 10   from 0.5    0.8 %      0.5 %         1.6 %         3.2 %, 17 %, 11 %
    96 x 10   from 0.125  1.5 %      2.8 %         6.5 %         3.2 %, 17 %, 11 %
    192 x 16  from 0.125  0.25 %     0.5 %         1.1 %         1.1 %, 6 %, 3.5 %
    ========  ==========  =========  ============  ============  ======================

    Errors of the default grid (aligned journal in any direction, L/D 0.25 to 2, eps 0.1 to 0.9): entries of K and C 1 %
    up to eps 0.8 and 2 % at 0.9 (of W/c, load over clearance, for entries below that), load 0.2 %, peak pressure 0.5 %;
    critical mass 2 % and whirl ratio 1 % up to eps 0.74, far more where the bearing is about to become stable at any
    mass, which `EquilibriumResult.critical_mass_error` tells. With the rupture line on vertices
    (`SwiftStieber(line_in_cells=False)`) the error of K is up to 8 % and that of C 13 %.

    A `GridWarning`, once per result or run, says that the error of the peak pressure is above some 5 %, as with
    journals that tilt to near contact; it names a grid with an error of 2 %.

    Grids with few rows need a larger stretch: ``FiniteLength(n_theta=84, n_z=4, stretch=0.85)`` takes 0.4 of the
    default grid's time. Its errors: load 0.1 % (L/D 0.5 to 1.1, eps up to 0.8), entries of K and C 1 % from L/D 0.9 and
    1.7 % from L/D 0.5.

    Parameters
    ----------
    n_theta : int or None, default None
        Vertices around the circumference, at least 16. None: 96 from L/D 0.65 up, 112 at 0.5, 176 at 0.25 and below.
    n_z : int, default 10
        Intervals along the bearing, at least 4.
    stretch : float, default 0.75
        Concentration of the vertices towards both ends, 0 (uniform) to 0.95.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> ehd.JournalBearing(**b).sized_film
    FiniteLength(n_theta=112, n_z=10, stretch=0.75)
    >>> bearing = ehd.JournalBearing(**b, film=ehd.FiniteLength(n_theta=48, n_z=6))
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    13626
    """

    n_theta: int | None = None
    n_z: int = 10
    stretch: float = 0.75

    circumferential_pressure_flow = True


def columns_for(ratio: float) -> int:
    """Vertices around the circumference for a bearing of this L/D.

    96 from 0.65 on, ``8 ceil(9 (D/L)^0.62)`` below, up to 176: 112 at 0.5, 176 from 0.25 down. At the rupture line
    pressure changes within a part of the bearing's length, which takes more columns the narrower it is. The fewest
    that hold what `FiniteLength` says, of the multiples of 8 at L/D 0.25, 0.35, 0.5 and 0.7, lie up to a sixth below.
    """
    return min(max(FEWEST_COLUMNS, 8 * math.ceil(9.0 * ratio**-0.62)), MOST_COLUMNS)


def sized(film: FilmOption, ratio: float) -> FilmOption:
    """A film model with its columns, where it leaves them to the bearing's L/D."""
    is_open = isinstance(film, FiniteLength) and film.n_theta is None
    return replace(film, n_theta=columns_for(ratio)) if is_open else film


def columns_of(film: FilmOption, ratio: float) -> int:
    """Vertices around the circumference of a film on a bearing of this L/D."""
    return columns_for(ratio) if film.n_theta is None else film.n_theta


@dataclass(frozen=True, kw_only=True)
class ShortBearing(_OnVertices):
    """Ocvirk's short bearing, for L/D below 0.25: without pressure flow in theta, every column is solved on its own.

    Compared with `FiniteLength` the load is 19 % too high already at L/D = 0.25 and eccentricity ratio 0.8. Meant for
    L/D below 0.25 and moderate eccentricity, and for comparison with closed forms. Tilt, squeeze and end pressures are
    included.

    Errors of the default grid against the short bearing's closed form (Swift-Stieber, aligned journal in any direction,
    eccentricity ratio 0.1 to 0.9): stiffness and damping 0.3 %, load 0.25 %; 1.5 % for tilts up to 0.3 of the tilt that
    closes the gap. With the rupture line on vertices (`SwiftStieber(line_in_cells=False)`): stiffness 3 %, damping 8 %,
    tilted journals 5 %. Errors grow to these where the rupture line crosses many columns, as with larger tilts and end
    pressures above the cavity pressure; the load on 96 columns then has 0.7 %, compared with 0.3 % on vertices.

    Parameters
    ----------
    n_theta, n_z : int, default 160, 8
        As for `FiniteLength`.
    stretch : float, default 0.75
        As for `FiniteLength`.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, film=ehd.ShortBearing())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    22472
    """

    n_theta: int = 160
    n_z: int = 8
    stretch: float = 0.75

    circumferential_pressure_flow = False


@dataclass(frozen=True, kw_only=True)
class LongBearing(Checked):
    """Long bearing (Sommerfeld): no axial flow, each cross-section on its own; needs axial grooves or `MaximumGap`.

    Meant for closed forms and for sealed bearings: compared with `FiniteLength` the load at eccentricity ratios 0.5 /
    0.8 / 0.95 is too high by 262 / 111 / 39 % at L/D = 1, 81 / 41 / 17 % at 2 and 30 / 17 / 8 % at 4 (Swift-Stieber,
    p = 0 at the maximum gap). Needs ambient end pressures, and ``inlet=MaximumGap()`` or axial grooves over the whole
    length (``supply=(AxialGroove(angle=..., width_angle=...),)``).

    Parameters
    ----------
    n_theta : int, default 192
        Vertices around the circumference, at least 16.
    n_z : int, default 4
        Slices along the bearing, at least 2, which suffice without tilt.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, film=ehd.LongBearing(), inlet=ehd.MaximumGap())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    59211
    """

    n_theta: int = 192
    n_z: int = 4

    stretch = 0.0
    circumferential_pressure_flow = True

    checks: ClassVar = {
        "n_theta": partial(require_count, at_least=16, hint="192 is a good start."),
        "n_z": partial(require_count, at_least=2, hint="4 is a good start."),
    }


FilmOption = FiniteLength | ShortBearing | ClassicSOR | LongBearing | ImpedanceMap


def check_film(
    film: FilmOption,
    closure: Closure,
    supply: tuple[SupplyArea, ...],
    open_ring: bool,
    end_pressures: tuple[float, float],
) -> None:
    """Raise `InputError` for a film model that does not go with the other choices.

    ``open_ring``: inlet at the maximum gap.
    """
    if isinstance(film, ClassicSOR) and not closure.clips:
        raise InputError(
            f"JournalBearing.film=ClassicSOR(...) works with Gümbel's condition only, got "
            f"cavitation={closure!r}; use cavitation=Gumbel(), or film=FiniteLength(...) for every other closure."
        )
    if isinstance(film, ClassicSOR) and supply:
        raise InputError(
            "JournalBearing.supply must be () with film=ClassicSOR(...), whose uniform grid has no rows on the edges "
            "of supply areas; use film=FiniteLength(...)."
        )
    if not isinstance(film, LongBearing):
        return
    if not open_ring and not supply:
        raise InputError(
            "JournalBearing.film=LongBearing(...) needs a line of prescribed pressure, because without axial flow a "
            "closed ring neither loses nor gets oil; give inlet=MaximumGap() (prescribed positions) or "
            "supply=(AxialGroove(...),)."
        )
    if any(not isinstance(area, AxialGroove) or area.length is not None for area in supply):
        raise InputError(
            f"JournalBearing.film=LongBearing(...) takes axial grooves over the whole length only (AxialGroove "
            f"without length), got supply={supply!r}; use film=FiniteLength(...) for other areas."
        )
    if any(p != 0.0 for p in end_pressures):
        raise InputError(
            f"JournalBearing.end_pressures must be (0, 0) with film=LongBearing(...), which has no axial flow, got "
            f"{end_pressures!r}."
        )


def no_line_with(film: FilmOption, closure: Closure, bush: object, oil: Lubricant) -> list[str]:
    """Names of a bearing's options that do not support the closure's rupture line inside the cells of the grid."""
    clips, oil_counts = closure.clips, closure.conserves_mass
    short = isinstance(film, ShortBearing) and not clips
    reduced = () if oil_counts else (ShortBearing,) if clips else (ShortBearing, ImpedanceMap)
    others = {
        f"film={type(film).__name__}(...)": not isinstance(film, (FiniteLength, LongBearing, *reduced)),
        # deflections end with the clipped pressure of a vertex: with the line between them tangents get worse
        "bush=ElasticLiner(...)": clips and isinstance(bush, ElasticLiner),
        "Lubricant.density_law": short and oil.density_law is not None,
        "Lubricant.shear_law": short and oil.shear_law is not None,
    }
    return [name for name, there in others.items() if there]


def check_line(film: FilmOption, closure: Closure, bush: object, oil: Lubricant) -> None:
    """Raise `InputError` for a rupture line inside the cells with options that do not support it."""
    others = no_line_with(film, closure, bush, oil) if closure.line_in_cells else []
    if not others:
        return
    name = type(closure).__name__
    raise InputError(
        f"{name}.line_in_cells=True does not go with {others[0]} yet; use {name}(), with its line on the grid, or "
        f"leave the other out."
    )


def film_grid(
    film: FilmOption,
    radius: float,
    length: float,
    *,
    start_angle: float,
    open_ring: bool,
    supply: tuple[SupplyArea, ...] = (),
    conserves_mass: bool = False,
    arcs: tuple[Arc, ...] = (),
    seals: tuple[float | None, float | None] | None = None,
) -> FilmGrid:
    """Grid of a film model, with rows on the edges of supply areas and a column on the first hole.

    Of a film that ``conserves_mass`` the control volumes of rows meet on the edges. ``seals`` as for `sealed_grid`;
    other parameters as for `bearing_grid`.
    """
    if isinstance(film, LongBearing):
        return long_bearing_grid(radius, length, film.n_theta, film.n_z, start_angle=start_angle, open_ring=open_ring)
    columns = columns_of(film, 0.5 * length / radius)
    sizes = placed(supply, length), radius, length, film.n_z, film.stretch
    rows = meeting_rows(*sizes, columns) if conserves_mass else supply_rows(*sizes)
    if arcs:
        grid = arc_grid(radius, length, arcs, columns, film.n_z, film.stretch, rows)
    else:
        grid = bearing_grid(
            radius,
            length,
            columns,
            film.n_z,
            stretch=film.stretch,
            start_angle=start_angle + column_of_hole(supply, columns),
            open_ring=open_ring,
            rows=rows,
        )
    return grid if seals is None else sealed_grid(grid, seals)


def film_solver(
    film: FilmOption | None,
    grid: FilmGrid,
    closure: Closure,
    *,
    squeeze: bool,
    flux_effects: tuple[FluxEffect, ...],
    density: CompressibleLaw | None = None,
    liner: Liner | None = None,
) -> FilmSolver:
    """Solver of a film model on its grid; ``density`` and ``liner`` as for `FilmSolver`.

    A ball has no film model: its ``film`` is None.
    """
    if isinstance(film, ClassicSOR):
        return ClassicSolver(film, grid, closure, squeeze=squeeze)
    return FilmSolver(
        grid,
        closure,
        squeeze=squeeze,
        flux_effects=flux_effects,
        circumferential_pressure_flow=getattr(film, "circumferential_pressure_flow", True),
        density=density,
        liner=liner,
    )
