"""Steady temperature of a film at a given motion: a fixed point between film and heat balance."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.joint.balance.limits import NO_OIL
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.seams import ThermalEffect
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.status import FilmError

# Largest change of temperature that counts as settled, as a share of the film's rise over its coldest source.
SETTLED = 1e-11
MAX_ROUNDS = 200
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


def settled_history(model: BearingModel, motion: np.ndarray, near: History | None = None) -> History | None:
    """History whose temperature is in balance with the steady film at ``motion``; None for an isothermal bearing.

    One temperature: the heat falls with rising temperature, so that the balance has one root, found by the secant
    method inside a bracket. A field: Anderson acceleration of ``T -> heat balance(film(T))``, started where plain
    rounds, damped as needed, have brought the change below 5 K, and anew from the best field when it makes no
    progress. Both end when the temperature changes by less than 1e-11 of its rise, or at a film that has no solution,
    which the caller then finds.

    Parameters
    ----------
    model : BearingModel
    motion : (10,) array
        As for `BearingModel.evaluate`.
    near : History, optional
        Of a film nearby, from whose temperature to start; it saves time.

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


WAY_OUT = (
    "let oil flow through (end pressures, eccentricity, supply) or give the thermal effect heat transfer to the "
    "surfaces "
    "(housing_conductance, bush_coefficient, journal_coefficient)."
)


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
    raise _unsettled(size)


def foreseen(past: list[tuple[np.ndarray, np.ndarray]], damping: float = 1.0) -> np.ndarray:
    """What Anderson's acceleration takes off the next step of a fixed-point iteration, ``damping`` times its change.

    ``past``: points (k,) of two rounds and more with the changes (k,) that the iteration gave there, the newest last.
    """
    dX, dF = (np.diff(np.array(values), axis=0).T for values in zip(*past))
    return (dX + damping * dF) @ np.linalg.lstsq(dF, past[-1][1], rcond=1e-12)[0]


def is_settled(T: float | np.ndarray, change: float | np.ndarray, cold: float | np.ndarray) -> bool:
    """Whether a change of a field of temperatures counts as none."""
    rise = max(float(np.ptp(T + change)), float(np.abs(T - cold).max()), 1e-3)
    return float(np.abs(change).max()) <= SETTLED * rise


def _unsettled(change: float) -> FilmError:
    return FilmError(
        f"steady temperature: not settled after {MAX_ROUNDS} rounds, last change {change:.3g} K; the heating is too "
        "strong for a "
        "steady film, check speed, clearance and the temperature law."
    )
