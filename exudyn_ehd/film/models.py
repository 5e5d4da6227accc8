"""From a film model that a scene names to its grid and solver; the only place that asks which one it is."""

from __future__ import annotations

from exudyn_ehd.film.cavitation.closures import Gumbel
from exudyn_ehd.film.grid import FilmGrid, FiniteLength, ShortBearing, bearing_grid
from exudyn_ehd.film.long_bearing import LongBearing, LongSolver, long_bearing_grid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.compliant import CompliantFilmSolver
from exudyn_ehd.film.solvers.compliant_parts import ColumnContact, ColumnLimiter, ColumnOil
from exudyn_ehd.film.solvers.compressible import CompressibleFilmSolver
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.linear import Closure, FilmSolver
from exudyn_ehd.film.solvers.liner import LinerFilmSolver
from exudyn_ehd.film.solvers.sor import ClassicSolver, ClassicSOR
from exudyn_ehd.film.supply import AxialGroove, SupplyArea
from exudyn_ehd.status import InputError

Film = FiniteLength | ShortBearing | ClassicSOR | LongBearing | ImpedanceMap


def check_film(
    film: Film, closure: Closure, supply: tuple[SupplyArea, ...], open_ring: bool, end_pressures: tuple[float, float]
) -> None:
    """Raise `InputError` for a film model that does not go with the other choices; ``open_ring``: inlet at the maximum gap."""
    if isinstance(film, ClassicSOR) and not isinstance(closure, Gumbel):
        raise InputError(
            f"JournalBearing.film=ClassicSOR(...) is the paper's scheme with the Guembel condition, got cavitation={closure!r}; use "
            "cavitation=Gumbel(), or film=FiniteLength(...) for every other closure."
        )
    if not isinstance(film, LongBearing):
        return
    if not open_ring and not supply:
        raise InputError(
            "JournalBearing.film=LongBearing(...) needs a line of prescribed pressure, because without axial flow a closed ring "
            "neither loses nor gets oil; give inlet=MaximumGap() (prescribed positions) or supply=(AxialGroove(...),)."
        )
    if any(not isinstance(area, AxialGroove) or area.length is not None for area in supply):
        raise InputError(
            "JournalBearing.film=LongBearing(...) takes axial grooves over the whole length only (AxialGroove without length), got "
            f"supply={supply!r}; use film=FiniteLength(...) for other areas."
        )
    if any(p != 0.0 for p in end_pressures):
        raise InputError(
            f"JournalBearing.end_pressures must be (0, 0) with film=LongBearing(...), which has no axial flow, got {end_pressures!r}."
        )


def film_grid(film: Film, radius: float, length: float, *, start_angle: float, open_ring: bool) -> FilmGrid:
    """Grid of a film model; parameters as for `bearing_grid`."""
    if isinstance(film, LongBearing):
        return long_bearing_grid(radius, length, film.n_theta, film.n_z, start_angle=start_angle, open_ring=open_ring)
    return bearing_grid(
        radius, length, film.n_theta, film.n_z, stretch=film.stretch, start_angle=start_angle, open_ring=open_ring
    )


def film_solver(
    film: Film,
    grid: FilmGrid,
    closure: Closure,
    *,
    squeeze: bool,
    flux_effects: tuple[FluxEffect, ...],
    density: CompressibleLaw | None = None,
) -> FilmSolver:
    """Solver of a film model on its grid; ``density``: of a compressible film."""
    if density is not None:
        if not isinstance(film, FiniteLength):
            raise InputError(
                f"Lubricant.density_law must be None with film={type(film).__name__}(...), which takes oil as incompressible; use "
                "film=FiniteLength(...)."
            )
        return CompressibleFilmSolver(grid, closure, density, squeeze=squeeze, flux_effects=flux_effects)
    if isinstance(film, ClassicSOR):
        if flux_effects:
            raise InputError(
                "JournalBearing.film=ClassicSOR(...) is the paper's plain film and takes no roughness, shear thinning or "
                "temperature field; use film=FiniteLength(...)."
            )
        return ClassicSolver(film, grid, closure, squeeze=squeeze)
    solver = LongSolver if isinstance(film, LongBearing) else FilmSolver
    return solver(
        grid, closure, squeeze=squeeze, flux_effects=flux_effects,
        circumferential_pressure_flow=film.circumferential_pressure_flow,
    )  # fmt: skip


def liner_film_solver(
    grid: FilmGrid,
    closure: Closure,
    *,
    squeeze: bool,
    contact: ColumnContact | None,
    limiter: ColumnLimiter | None,
    flux_effects: tuple[FluxEffect, ...],
    oil: ColumnOil | None,
) -> LinerFilmSolver | CompliantFilmSolver:
    """Solver of a film on an elastic liner.

    ``contact`` presses on it beside the film, whose gap the ``limiter`` keeps open; ``oil``: of a viscosity that follows the pressure.
    """
    if contact is None and limiter is None and oil is None and not flux_effects and not closure.conserves_mass:
        return LinerFilmSolver(grid, closure, squeeze=squeeze)
    return CompliantFilmSolver(
        grid, closure, squeeze=squeeze, contact=contact, limiter=limiter, flux_effects=flux_effects, oil=oil
    )
