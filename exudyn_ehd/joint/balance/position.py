"""The journal's position under a load, by Newton's method or by creep."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.joint.balance.film import evaluate_at, history_at
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.status import FilmError, Status

LARGEST_LOAD_STEPS = 100
LARGEST_CREEP_STEPS = 300
STEP_HALVINGS = 8


def newton(
    model: BearingModel,
    motion: np.ndarray,
    force: np.ndarray,
    tolerance: float,
    where: str,
    most: int = LARGEST_LOAD_STEPS,
) -> tuple[int, float, Evaluation, np.ndarray]:
    """Newton's method from ``motion`` (changed in place): steps, unbalance over load, film and tangent at the end.

    ``force`` (2,) is the load on the journal, N; `FilmError`, in the name of ``where``, without a film at the start.
    """
    size = float(np.hypot(*force))
    count, residual = 0, math.inf
    evaluation, _ = evaluate_at(model, motion, where)
    tangent = evaluation.steady_tangent()
    while count < most:
        count += 1
        unbalance = evaluation.wrench[:2] + force
        residual = float(np.max(np.abs(unbalance))) / size
        if residual <= tolerance:
            break
        try:
            step = _limited_step(model, motion, np.linalg.solve(tangent[:2, :2], -unbalance))
            evaluation = _move(model, motion, step, where)
        except (np.linalg.LinAlgError, FilmError):  # a film that carries nothing, or no film whatever the step
            break
        tangent = evaluation.steady_tangent()
    return count, residual, evaluation, tangent


def creep(
    model: BearingModel, motion: np.ndarray, force: np.ndarray, tolerance: float, where: str
) -> tuple[int, float, Evaluation, np.ndarray]:
    """As `newton`, by way of the journal's creep.

    A viscous resistance r holds it back, which falls as the unbalance does.

    ``(r I - dF/dx) step = unbalance``; a step that increases the unbalance is taken back and r grows. Slow and sure
    where Newton's method jumps over a film that starves or touches.
    """
    size = float(np.hypot(*force))
    evaluation, _ = evaluate_at(model, motion, where)
    unbalance, tangent = evaluation.wrench[:2] + force, evaluation.steady_tangent()
    resistance, count = 10.0 * size / model.bearing.radial_clearance, 1
    while count < LARGEST_CREEP_STEPS and float(np.max(np.abs(unbalance))) > tolerance * size:
        try:
            step = np.linalg.solve(resistance * np.eye(2) - tangent[:2, :2], unbalance)
        except np.linalg.LinAlgError:
            resistance *= 4.0
            count += 1
            continue
        base = motion[:2].copy()
        motion[:2] += _limited_step(model, motion, step)
        count += 1
        try:
            evaluation, _ = evaluate_at(model, motion, where)
            trial = evaluation.wrench[:2] + force
        except FilmError:
            trial = np.full(2, math.inf)
        if float(np.hypot(*trial)) < float(np.hypot(*unbalance)):
            unbalance, tangent = trial, evaluation.steady_tangent()
            resistance /= 5.0
        else:
            motion[:2] = base
            resistance *= 4.0
    evaluation, _ = evaluate_at(model, motion, where)
    return count, float(np.max(np.abs(unbalance))) / size, evaluation, tangent


def _move(model: BearingModel, motion: np.ndarray, step: np.ndarray, where: str) -> Evaluation:
    """Advance ``motion`` (10,) in place by a step (2,) and evaluate.

    In a flexible bore by the part of it that leaves a film.
    """
    motion[:2] += step
    if model.flexible:
        for _ in range(STEP_HALVINGS):
            evaluation = model.evaluate_steady(motion, history_at(model, motion, where))
            if evaluation.status is Status.CONVERGED:
                return evaluation
            step = 0.5 * step
            motion[:2] -= step
    return evaluate_at(model, motion, where)[0]


def _limited_step(model: BearingModel, motion: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Shorten a step (2,) so that it uses up at most 60 % of the smallest gap at either end.

    A wall or a flexible bush limits nothing.
    """
    if model.effects.contacts or model.flexible:
        longest = 0.3 * model.bearing.radial_clearance
        return step * min(1.0, longest / float(np.hypot(*step) + 1e-300))
    c, half = model.bearing.radial_clearance, 0.5 * model.bearing.length
    scale = 1.0
    for s in (-half, half):
        e = motion[:2] + s * motion[2:4]
        allowed = float(np.hypot(*e)) + 0.6 * (c - float(np.hypot(*e)))
        a, b, d = float(step @ step), float(e @ step), float(e @ e) - allowed**2
        if a > 0.0:
            scale = min(scale, (-b + math.sqrt(b * b - a * d)) / a)
    return scale * step
