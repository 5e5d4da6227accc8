"""The steady film at a motion of the journal, with the temperature and the oil content that it keeps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.joint.balance.limits import require_oil_bears, seized
from exudyn_ehd.joint.balance.newton import Balance
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.status import FilmError


def lacks_oil(bearing: JournalBearing) -> bool:
    """Return whether the film conserves mass and has no source of oil, unless the journal slides axially."""
    closure = bearing.cavitation
    return closure.conserves_mass and not is_fed(bearing, closure.cavity_pressure)


def is_fed(bearing: JournalBearing, cavity_pressure: float) -> bool:
    """Return whether ends, supply areas or an open inlet feed oil into cavities of this pressure, Pa."""
    supplied = bool(bearing.supply) or isinstance(bearing.inlet, MaximumGap) or bearing.arc is not None
    return supplied or max(bearing.end_pressures) > cavity_pressure


def settled_history(
    model: BearingModel, motion: np.ndarray, near: History | None = None, where: str = "steady"
) -> History | None:
    """History whose temperature is in balance with the steady film at a motion; None for an isothermal bearing.

    Parameters
    ----------
    model : BearingModel
    motion : (10,) array
        As for `BearingModel.evaluate_steady`.
    near : History, optional
        Memory of a film nearby, whose temperature is the initial guess; it saves time.
    where : str
        Name of the caller, for error messages.

    Raises
    ------
    FilmError
        Without a film, if the heat has no way out, or the temperature does not settle.
    """
    balance = Balance(model, where)
    if balance.thermal is None:
        return None
    found = balance.solve(motion, balance.temperature_of(near))
    if not balance.is_balanced(found):
        require_oil_bears(found.film.temperature, model.grid, where)
        raise FilmError(
            f"{where}: the film's temperature does not converge, its last change is {np.abs(found.change).max():.3g} "
            "K; the heating is too strong for a steady film, check speed, clearance and the temperature law."
        )
    return found.film.history


def history_at(model: BearingModel, motion: np.ndarray, where: str, near: History | None = None) -> History | None:
    """Settled temperature at ``motion`` and, with rates, the oil content of the steady film at rest there.

    None if nothing remembers. ``near``: history of a film nearby, whose temperature saves time.
    """
    history = settled_history(model, motion, near, where)
    if not model.remembers_mass or not np.any(motion[4:8]):
        return history
    at_rest = motion.copy()
    at_rest[4:8] = 0.0
    content = evaluate_at(model, at_rest, where)[0].history()
    assert content is not None
    return replace(content, temperature=None if history is None else history.temperature)


def evaluate_at(
    model: BearingModel, motion: np.ndarray, where: str, near: History | None = None
) -> tuple[Evaluation, SolvedFilm]:
    """The steady film at ``motion``; `FilmError`, in the name of ``where``, if there is none that is oil.

    ``near`` as for `history_at`.
    """
    balance = Balance(model, where, held=history_at(model, motion, where, near))
    found = balance.at(motion, balance.cold)
    require_oil_bears(found.film.temperature, model.grid, where)
    if message := seized(found.film.walls):
        raise FilmError(f"{where}: {message}")
    return found.evaluation, found.film
