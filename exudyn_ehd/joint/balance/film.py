"""The steady film at a motion of the journal, with settled temperature and oil content."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.joint.balance.limits import advice, require_oil_bears, seized
from exudyn_ehd.joint.balance.temperature import settled_history
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.status import FilmError, Status

# Minimum film thickness below which a film closes, share of the clearance.
CLOSED = 1e-3


def lacks_oil(bearing: JournalBearing) -> bool:
    """Whether the film conserves mass and has no source of oil, unless the journal slides along."""
    closure = bearing.cavitation
    return closure.conserves_mass and not is_fed(bearing, closure.cavity_pressure)


def is_fed(bearing: JournalBearing, cavity_pressure: float) -> bool:
    """Whether oil comes to cavities of this pressure, Pa, from ends, supply or an open inlet."""
    supplied = bool(bearing.supply) or isinstance(bearing.inlet, MaximumGap)
    return supplied or max(bearing.end_pressures) > cavity_pressure


def history_at(model: BearingModel, motion: np.ndarray, where: str, near: History | None = None) -> History | None:
    """Settled temperature at ``motion`` and, with rates, the oil content of the steady film at rest there.

    None if nothing remembers. ``near``: history of a film nearby, whose temperature saves time.
    """
    history = settled_history(model, motion, near)
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
    evaluation = model.evaluate_steady(motion, history_at(model, motion, where, near))
    if evaluation.film is None or evaluation.status is not Status.CONVERGED:
        remedy = advice(evaluation.status, model.bearing)
        if isinstance(evaluation, ElasticEvaluation) and evaluation.status is not Status.NO_PRESSURE:
            remedy = _without_a_shape(evaluation)
        raise FilmError(
            f"{where}: {evaluation.status.name} at x = {motion[0]:.4g} m, y = {motion[1]:.4g} m, tilt = "
            f"({motion[2]:.3g}, {motion[3]:.3g}), minimum film thickness {evaluation.minimum_gap:.3g} m: "
            f"{remedy}"
        )
    require_oil_bears(evaluation.film.temperature, model.grid, where)
    if message := seized(evaluation.film.walls):
        raise FilmError(f"{where}: {message}")
    return evaluation, evaluation.film


def _without_a_shape(evaluation: ElasticEvaluation) -> str:
    """Why no shape of a flexible bore has a film, and what to do."""
    bearing, last = evaluation.model.bearing, evaluation.closing
    kind = type(bearing.yielding).__name__
    if evaluation.model.elasticity.failure:
        return f"{kind}: {evaluation.model.elasticity.failure}"
    surface = "surface" if bearing.bush is None else "bore"
    missing = f"no shape of the {kind}'s {surface} was found in balance with a film"
    if last is None or last.gap > CLOSED * bearing.radial_clearance or evaluation.model.effects.contacts:
        return (
            f"{missing}, neither by Newton's method nor on the way of a viscous bore from its undeformed shape; "
            "thicken what is thin in it, name a contact=RegularisedWall(...) if the surfaces touch, or refine the "
            "film's grid."
        )
    return (
        f"{missing}. On the way there, at {last.part:.3g} of eccentricity and tilt, the film closes at theta = "
        f"{last.theta:.3g} rad, z = {last.z:.4g} m (minimum film thickness {last.gap:.2g} m): the surfaces touch; at "
        "an end of the bearing, where no pressure opens the gap, they do so first. Name contact=RegularisedWall(...) "
        "or asperity=GreenwoodTripp(...), refine the film's grid, or move the journal back."
    )
