"""Steady elastohydrodynamics: the bore's coordinates in equilibrium with the film, and the tangent of a bore that follows.

With the bush's stiffness K the residual is ``r(q) = K q - Q(q)``; Newton with the exact ``K - dQ/dq``. A pressure falls with the gap it
opens, and falls the less the wider the gap: from a small q on Newton's steps stop short of the solution and stay on the safe side.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from exudyn_ehd.joint.model.rigid import MOTION_SIZE
from exudyn_ehd.status import Status

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
    from exudyn_ehd.joint.seams import History

LARGEST_SETTLING_STEPS = 60
SETTLING_TOLERANCE = 1e-11
SMALLEST_PART = 1e-3


class Elasticity(Protocol):
    """What resists the bore's coordinates in a steady state."""

    def force(self, q: np.ndarray) -> np.ndarray:
        """Generalised force (k,) that holds the bore at q, N."""

    def solve(self, q: np.ndarray, softening: np.ndarray, rhs: np.ndarray) -> np.ndarray:
        """Solve ``(K - softening) x = rhs`` for rhs (k,) or (k, r), K the stiffness at q."""


class ModalElasticity:
    """Diagonal stiffness of modes (k,), N/m."""

    def __init__(self, stiffness: np.ndarray) -> None:
        self.stiffness = stiffness

    def force(self, q: np.ndarray) -> np.ndarray:
        """K q (k,)."""
        return self.stiffness * q

    def solve(self, q: np.ndarray, softening: np.ndarray, rhs: np.ndarray) -> np.ndarray:
        """Solve ``(K - softening) x = rhs``."""
        return np.linalg.solve(np.diag(self.stiffness) - softening, rhs)


class DenseElasticity:
    """Constant stiffness matrix (k, k), N/m, made when first needed."""

    def __init__(self, make: Callable[[], np.ndarray]) -> None:
        self._make = make

    @cached_property
    def stiffness(self) -> np.ndarray:
        """K (k, k)."""
        return self._make()

    def force(self, q: np.ndarray) -> np.ndarray:
        """K q (k,)."""
        return self.stiffness @ q

    def solve(self, q: np.ndarray, softening: np.ndarray, rhs: np.ndarray) -> np.ndarray:
        """Solve ``(K - softening) x = rhs``."""
        return np.linalg.solve(self.stiffness - softening, rhs)


def settle(
    model: ElasticBearingModel, motion: np.ndarray, history: History | None, step: float = 0.0, spin: float = 0.0
) -> ElasticEvaluation:
    """Evaluate with the bore in equilibrium; the eccentricity is approached in parts where the rigid surfaces would touch.

    ``history``, ``step`` and ``spin`` as for `BearingModel.evaluate`. Starts from the model's last coordinates if they leave a gap, else from the undeformed bore. The status of the evaluation is
    NOT_CONVERGED if no equilibrium was found.
    """
    q = model.coordinates.copy()
    model.settling_steps = 0
    film = history, step, spin
    found = _newton(model, motion, film, q, 1.0)
    if found is None and q.any():
        found = _newton(model, motion, film, np.zeros_like(q), 1.0)
    if found is not None:
        return found
    reached, part, q = 0.0, 0.5, np.zeros_like(q)
    while part > SMALLEST_PART:
        target = min(1.0, reached + part)
        found = _newton(model, motion, film, q, target)
        if found is None:
            part *= 0.5
            continue
        if target == 1.0:
            return found
        reached, q = target, model.coordinates.copy()
    evaluation = model.evaluate(motion, *film)
    if evaluation.status is Status.CONVERGED:
        evaluation.status = model.status = Status.NOT_CONVERGED
    return evaluation


def _newton(
    model: ElasticBearingModel,
    motion: np.ndarray,
    film: tuple[History | None, float, float],
    q: np.ndarray,
    part: float,
) -> ElasticEvaluation | None:
    """Newton on q with the pose scaled by ``part``; steps are halved until the gap stays open and the residual falls."""
    elasticity, k = model.elasticity, model.bore.size
    full = np.concatenate((motion[:MOTION_SIZE], q, np.zeros(k)))
    full[:4] *= part
    evaluation = model.evaluate(full, *film)
    if evaluation.status is not Status.CONVERGED:
        return None
    scale = max(float(np.linalg.norm(evaluation.bore_load)), 1e-300)
    residual = evaluation.bore_load - elasticity.force(q)
    error, last = float(np.linalg.norm(residual)), np.inf
    for _ in range(LARGEST_SETTLING_STEPS):
        # stop at the tolerance, or where rounding keeps a converged residual from falling
        if error <= SETTLING_TOLERANCE * scale or (error <= 1e-8 * scale and error > 0.5 * last):
            return evaluation
        softening = model.combined_tangent(1.0, 0.0)[6:, MOTION_SIZE:]
        step = elasticity.solve(q, softening, residual)
        last = error
        for _ in range(12):
            full[MOTION_SIZE : MOTION_SIZE + k] = q + step
            evaluation = model.evaluate(full, *film)
            model.settling_steps += 1
            if evaluation.status is Status.CONVERGED:
                residual = evaluation.bore_load - elasticity.force(q + step)
                error = float(np.linalg.norm(residual))
                if error < 2.0 * last or error <= 1e-8 * scale:
                    break
            step = 0.5 * step
        else:
            return None
        q = q + step
        scale = max(scale, float(np.linalg.norm(evaluation.bore_load)))
    return None


def condensed_tangent(model: ElasticBearingModel) -> np.ndarray:
    """d wrench / d motion (6, 10) with a massless bore in equilibrium, to first order in the rates.

    With A = (K - dQ/dq)^-1 the bore follows the journal as ``dq = A Q_m dm``; its rate follows the pose's rate likewise and acts through
    squeeze on wrench and bore.
    """
    T, k, M = model.tangent(), model.bore.size, MOTION_SIZE
    softening = T[6:, M : M + k]
    follow = model.elasticity.solve(model.coordinates, softening, T[6:, :M])
    rate = np.zeros_like(follow)
    rate[:, 4:8] = follow[:, :4]
    second = model.elasticity.solve(model.coordinates, softening, T[6:, M + k :] @ rate)
    return T[:6, :M] + T[:6, M : M + k] @ (follow + second) + T[:6, M + k :] @ rate
