"""From a film model that a scene names to its grid and solver; the only place that asks which one it is."""

from __future__ import annotations

from exudyn_ehd.film.cavitation import Gumbel
from exudyn_ehd.film.classic import ClassicSolver, ClassicSOR
from exudyn_ehd.film.flux import FluxEffect
from exudyn_ehd.film.grid import FilmGrid, FiniteLength, ShortBearing
from exudyn_ehd.film.solver import Closure, FilmSolver
from exudyn_ehd.status import InputError

Film = FiniteLength | ShortBearing | ClassicSOR


def check_film(film: Film, closure: Closure) -> None:
    """Raise `InputError` for a film model that does not go with the cavitation closure."""
    if isinstance(film, ClassicSOR) and not isinstance(closure, Gumbel):
        raise InputError(
            f"JournalBearing.film=ClassicSOR(...) is the paper's scheme with the Guembel condition, got cavitation={closure!r}; use "
            "cavitation=Gumbel(), or film=FiniteLength(...) for every other closure."
        )


def film_solver(
    film: Film, grid: FilmGrid, closure: Closure, *, squeeze: bool, flux_effects: tuple[FluxEffect, ...]
) -> FilmSolver:
    """Solver of a film model on its grid."""
    if isinstance(film, ClassicSOR):
        if flux_effects:
            raise InputError(
                "JournalBearing.film=ClassicSOR(...) is the paper's plain film and takes no roughness, shear thinning or "
                "temperature field; use film=FiniteLength(...)."
            )
        return ClassicSolver(film, grid, closure, squeeze=squeeze)
    return FilmSolver(
        grid, closure, squeeze=squeeze, flux_effects=flux_effects,
        circumferential_pressure_flow=film.circumferential_pressure_flow,
    )  # fmt: skip
