"""Temperatures that oil does not bear: from which on a film warns, and beyond which it is none."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.conduction import Walls
from exudyn_ehd.status import FilmError, HotFilmWarning, warn_user

# K. Rules of thumb, not properties of an oil: 150 degrees Celsius, from which mineral oils oxidise fast, and what is
# beyond any oil, so that a film of one is a wrong answer.
HOT, HOTTEST = 423.15, 700.0

COOLER = (
    "let more oil flow through (end pressures, supply, clearance), give the thermal effect heat transfer to the "
    "surfaces (housing_conductance, bush_coefficient, journal_coefficient), or take a thinner oil, less load or speed."
)
NO_OIL = f"and no oil is a liquid above {HOTTEST:g} K: the bearing seizes; {COOLER}"
ROOM = (
    "give the journal's heat a way out (Conduction.conductance, more oil), let it warm up slowly, or take a larger "
    "radial_clearance."
)
Temperature = float | np.ndarray | None


def is_above(limit: float, temperature: float | np.ndarray) -> bool:
    """Whether a film's temperature, K, is above a limit somewhere, or no number."""
    return not float(np.max(temperature)) <= limit


def hottest(temperature: float | np.ndarray, grid: FilmGrid) -> str:
    """Highest temperature of a film, with its place where it has a field, for messages."""
    if np.ndim(temperature) == 0:
        return f"{float(temperature):.4g} K"
    T = np.asarray(temperature)[:, : grid.z.size]  # without the walls behind it
    i, j = divmod(int(np.argmax(T)), grid.z.size)
    return f"{T[i, j]:.4g} K at theta = {grid.x[i]:.3g} rad, z = {grid.z[j] * grid.reference_length:.4g} m"


def require_oil_bears(temperature: Temperature, grid: FilmGrid, where: str) -> None:
    """Raise `FilmError` in the name of ``where`` for a film in which no oil is a liquid."""
    if temperature is not None and is_above(HOTTEST, temperature):
        raise FilmError(f"{where}: the film is at {hottest(temperature, grid)}, {NO_OIL}")


def hot_film(temperature: float | np.ndarray, grid: FilmGrid, where: str) -> str:
    """What to say of a film that oil does not bear for long."""
    return (
        f"{where}: the film is at {hottest(temperature, grid)}, and mineral oils do not bear {HOT:g} K for long; "
        f"{COOLER}"
    )


def seized(walls: Walls | None) -> str:
    """What to say where the walls have grown by the whole clearance; empty if they have not."""
    if walls is None or walls.clearance > 0.0:
        return ""
    return (
        f"the bearing seizes: bush and journal have grown by more than the radial clearance, of which "
        f"{walls.clearance:.3g} m are left; {ROOM}"
    )


def warn_of_heat(temperature: Temperature, grid: FilmGrid, where: str) -> bool:
    """Warn in the name of ``where`` of a film that oil does not bear for long; whether it is one."""
    if temperature is None or not is_above(HOT, temperature):
        return False
    warn_user(hot_film(temperature, grid, where), HotFilmWarning)
    return True
