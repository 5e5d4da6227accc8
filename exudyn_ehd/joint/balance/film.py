"""The steady film at a motion of the journal, with settled temperature and oil content.

Steady temperature of a film at a given motion: a fixed point between film and heat balance.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.joint.balance.limits import NO_OIL, advice, require_oil_bears, seized
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.seams import ThermalEffect
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.status import FilmError, Status

# Largest change of temperature that counts as settled, as a share of the film's rise over its coldest source.
SETTLED = 1e-11
MAX_ROUNDS = 200
# Like SETTLED, after `MAX_ROUNDS`: round-off of hot fields keeps changes from falling further.
NEARLY = 1e-9
# Differences of past rounds that the acceleration combines.
DEPTH = 10
# K, up to which a search goes on, far beyond what any oil bears: on its way a film is hotter than where it ends.
DIVERGED = 2000.0
LARGEST_CHANGE = 50.0
# Largest change of a round, K, that the acceleration starts from, and rounds without progress before the damping grows.
ACCELERATED = 5.0
PATIENCE = 20
# K, within which of a film that is there none is: growing walls close its gap.
CLOSED_BY = 1e-2
WAY_OUT = (
    "let oil flow through (end pressures, eccentricity, supply) or give the thermal effect heat transfer to the "
    "surfaces "
    "(housing_conductance, bush_coefficient, journal_coefficient)."
)
# Minimum film thickness below which a film closes, share of the clearance.
CLOSED = 1e-3


def settled_history(model: BearingModel, motion: np.ndarray, near: History | None = None) -> History | None:
    """History whose temperature is in balance with the steady film at ``motion``; None for an isothermal bearing.

    One temperature: the heat falls with rising temperature, so that the balance has one root, found by the secant
    method inside a bracket. A field: Anderson acceleration of ``T -> heat balance(film(T))``, started where plain
    rounds, damped as needed, have brought the change below 5 K, and anew from the best field when it makes no
    progress. Both end when the temperature changes by less than 1e-11 of its rise (a field behind 200 rounds 1e-9), or
    at a film that has no solution, which the caller then finds.

    Parameters
    ----------
    model : BearingModel
    motion : (10,) array
        As for `BearingModel.evaluate`.
    near : History, optional
        Memory of a film nearby, whose temperature is the initial guess; it saves time.

    Raises
    ------
    FilmError
        If the heat has no way out, or the temperature does not settle.
    """
    thermal = model.effects.thermal
    if thermal is None:
        return None
    cold = thermal.initial_temperature(model.grid.shape)
    start = cold if near is None or near.temperature is None else near.temperature
    if isinstance(cold, np.ndarray):
        return _settle_field(model, thermal, motion, np.asarray(start), cold)
    return _settle_number(model, thermal, motion, float(start), float(cold))


def _target(
    model: BearingModel, thermal: ThermalEffect, motion: np.ndarray, T: float | np.ndarray
) -> np.ndarray | None:
    """Temperature in balance with the heat of the film at T; None without a film."""
    # a flexible bore settles under the film of every temperature that is tried
    film = model.evaluate_steady(motion, History(temperature=T)).film
    return None if film is None else np.asarray(thermal.steady_temperature(film))


def _require_way_out(T: float) -> None:
    if not T < DIVERGED:
        what = (
            f"beyond {DIVERGED:g} K, {NO_OIL}"
            if math.isfinite(T)
            else f"heated, and its heat has no way out; {WAY_OUT}"
        )
        raise FilmError(f"steady temperature: the film is {what}")


def _settle_number(
    model: BearingModel, thermal: ThermalEffect, motion: np.ndarray, start: float, cold: float
) -> History:
    lower, upper = -math.inf, math.inf
    T, slope, previous, f_previous = start, -1.0, math.nan, math.nan
    for _ in range(MAX_ROUNDS):
        target = _target(model, thermal, motion, T)
        if target is None:
            return History(temperature=T)
        _require_way_out(T if math.isfinite(float(target)) else math.inf)
        f = float(target) - T
        if abs(f) <= SETTLED * max(abs(T - cold), abs(f), 1e-3):
            return History(temperature=T)
        lower, upper = (T, upper) if f > 0.0 else (lower, T)
        if previous != T and not math.isnan(previous):
            slope = (f - f_previous) / (T - previous)
        guess = T - f / slope if slope < 0.0 else T + f
        if not lower < guess < upper:
            guess = 0.5 * (lower + upper) if math.isfinite(lower + upper) else T + f
        previous, f_previous, T = T, f, min(guess, 1.5 * T)
    raise _unsettled(abs(f))


def _settle_field(
    model: BearingModel, thermal: ThermalEffect, motion: np.ndarray, start: np.ndarray, cold: np.ndarray
) -> History:
    T = best = start
    past: list[tuple[np.ndarray, np.ndarray]] = []
    smallest, damping, patience = math.inf, 1.0, 0
    for _ in range(MAX_ROUNDS):
        target = _target(model, thermal, motion, T)
        if target is None:
            if T is best or float(np.abs(T - best).max()) < CLOSED_BY:
                return History(temperature=T)
            T, past = 0.5 * (T + best), []  # growing walls have closed the gap of a film on the way
            continue
        change = target - T
        size = float(np.abs(change).max())
        _require_way_out(float(T.max()) if math.isfinite(size) else math.inf)
        if is_settled(T, change, cold):
            return History(temperature=T)
        near = size < ACCELERATED
        patience = 0 if size < 0.9 * smallest else patience + 1
        if size < smallest:
            smallest, best = size, T
        if patience > PATIENCE:
            patience, damping = 0, max(0.6 * damping, 0.1)
            if near and past:
                T, past = best, []
                continue
        past = [*past, (T.ravel(), change.ravel())][-DEPTH - 1 :] if near else []
        step = damping * min(1.0, LARGEST_CHANGE / size) * change
        if len(past) > 1:
            step = step - foreseen(past, damping).reshape(T.shape)
            step = step * min(1.0, 4.0 * size / float(np.abs(step).max()))
        T = T + step
    if smallest <= NEARLY * max(float(np.ptp(best)), float(np.abs(best - cold).max())):
        return History(temperature=best)
    raise _unsettled(size)


def foreseen(past: list[tuple[np.ndarray, np.ndarray]], damping: float = 1.0) -> np.ndarray:
    """Return the part of the next fixed-point step that Anderson's acceleration subtracts.

    The step is ``damping`` times the iteration's change.

    ``past``: points (k,) of two rounds and more with the changes (k,) that the iteration gave there, the newest last.
    """
    dX, dF = (np.diff(np.array(values), axis=0).T for values in zip(*past))
    return (dX + damping * dF) @ np.linalg.lstsq(dF, past[-1][1], rcond=1e-12)[0]


def is_settled(T: float | np.ndarray, change: float | np.ndarray, cold: float | np.ndarray) -> bool:
    """Return whether a change of a temperature field is negligible."""
    rise = max(float(np.ptp(T + change)), float(np.abs(T - cold).max()), 1e-3)
    return float(np.abs(change).max()) <= SETTLED * rise


def _unsettled(change: float) -> FilmError:
    return FilmError(
        f"steady temperature: not settled after {MAX_ROUNDS} rounds, last change {change:.3g} K; the heating is too "
        "strong for a "
        "steady film, check speed, clearance and the temperature law."
    )


def lacks_oil(bearing: JournalBearing) -> bool:
    """Return whether the film conserves mass and has no source of oil, unless the journal slides axially."""
    closure = bearing.cavitation
    return closure.conserves_mass and not is_fed(bearing, closure.cavity_pressure)


def is_fed(bearing: JournalBearing, cavity_pressure: float) -> bool:
    """Return whether ends, supply areas or an open inlet feed oil into cavities of this pressure, Pa."""
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
    """Return the reason why no shape of a flexible bore has a film, and the remedy."""
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
