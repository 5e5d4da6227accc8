"""Steady elastohydrodynamics.

The bore's coordinates in equilibrium with the film, and the tangent of a bore that follows.

With the bush's stiffness K the residual is ``r(q) = K q - Q(q)``; Newton with the exact ``K - dQ/dq``. A pressure
falls with the gap it opens, and falls the less the wider the gap: from a small q on Newton's steps stop short of the
solution and stay on the safe side.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Generic, Protocol, TypeVar

import numpy as np

from exudyn_ehd.joint.bore.shapes import Bore
from exudyn_ehd.joint.solved_film import MOTION_SIZE, BoreState, History
from exudyn_ehd.status import Status

LARGEST_SETTLING_STEPS = 60
SETTLING_TOLERANCE = 1e-11
SMALLEST_PART = 1e-3


class Elasticity:
    """What resists the bore's coordinates in a steady state: a constant stiffness matrix.

    Parameters
    ----------
    make : function
        Returns the matrix (k, k), N/m; called when it is first needed.
    """

    def __init__(self, make: Callable[[], np.ndarray]) -> None:
        self._make = make

    @cached_property
    def stiffness(self) -> np.ndarray:
        """K (k, k), N/m."""
        return self._make()

    def force(self, q: np.ndarray) -> np.ndarray:
        """Generalised force (k,) that holds the bore at q, N."""
        return self.stiffness @ q

    def solve(self, q: np.ndarray, softening: np.ndarray, rhs: np.ndarray) -> np.ndarray:
        """Solve ``(K - softening) x = rhs`` for rhs (k,) or (k, r), K the stiffness at q."""
        return np.linalg.solve(self.stiffness - softening, rhs)


class BoreEvaluation(Protocol):
    """A film on a bore with given coordinates."""

    @property
    def status(self) -> Status: ...
    @property
    def bore(self) -> BoreState: ...
    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """d (wrench, Q) to the motion, and ``by_place d/dq + by_rate d/dq_t``, (6 + k, 10 + k)."""


Result = TypeVar("Result", bound=BoreEvaluation, covariant=True)


class FilmOnBore(Protocol[Result]):
    """A bearing model whose bore has coordinates, and what resists them."""

    @property
    def bore(self) -> Bore: ...
    @property
    def elasticity(self) -> Elasticity: ...
    def evaluate(self, motion: np.ndarray, history: History | None, step: float, spin: float) -> Result:
        """The film at a motion (10 + 2 k,)."""


def bore_equilibrium(
    model: FilmOnBore[Result],
    motion: np.ndarray,
    film: tuple[History | None, float, float],
    start: np.ndarray,
) -> tuple[Result, bool, int]:
    """Evaluate with the bore in equilibrium.

    The eccentricity is approached in parts where the rigid surfaces would touch.

    ``film``: history, step and spin as for `BearingModel.evaluate`; ``start``: coordinates (k,) to begin with, if
    they leave a gap, before the undeformed bore. Returns the evaluation, whether it is an equilibrium, and the number
    of Newton trials.
    """
    newton = Newton(model, motion, film)
    found = newton.solve(start, 1.0)
    if found is None and start.any():
        found = newton.solve(np.zeros_like(start), 1.0)
    reached, part, q = 0.0, 0.5, np.zeros_like(start)
    while found is None and part > SMALLEST_PART:
        target = min(1.0, reached + part)
        near = newton.solve(q, target)
        if near is None:
            part *= 0.5
        elif target == 1.0:
            found = near
        else:
            reached, q = target, near.bore.coordinates.copy()
    if found is None:
        return model.evaluate(motion, *film), False, newton.trials
    return found, True, newton.trials


class Newton(Generic[Result]):
    """Newton's method on q; steps are halved until the gap stays open and the residual falls."""

    def __init__(
        self, model: FilmOnBore[Result], motion: np.ndarray, film: tuple[History | None, float, float]
    ) -> None:
        self.model, self.motion, self.film = model, motion, film
        self.trials = 0

    def solve(self, q: np.ndarray, part: float) -> Result | None:
        """Equilibrium from coordinates q (k,) with the pose scaled by ``part``; None if none was found."""
        model, elasticity, k = self.model, self.model.elasticity, q.size
        full = np.concatenate((self.motion[:MOTION_SIZE], q, np.zeros(k)))
        full[:4] *= part
        evaluation = model.evaluate(full, *self.film)
        if evaluation.status is not Status.CONVERGED:
            return None
        scale = max(float(np.linalg.norm(evaluation.bore.load)), 1e-300)
        residual = evaluation.bore.load - elasticity.force(q)
        error, last = float(np.linalg.norm(residual)), np.inf
        for _ in range(LARGEST_SETTLING_STEPS):
            # stop at the tolerance, or where rounding keeps a converged residual from falling
            if error <= SETTLING_TOLERANCE * scale or (error <= 1e-8 * scale and error > 0.5 * last):
                return evaluation
            softening = evaluation.combined_tangent(1.0, 0.0)[6:, MOTION_SIZE:]
            step = elasticity.solve(q, softening, residual)
            last = error
            for _ in range(12):
                full[MOTION_SIZE : MOTION_SIZE + k] = q + step
                evaluation = model.evaluate(full, *self.film)
                self.trials += 1
                if evaluation.status is Status.CONVERGED:
                    residual = evaluation.bore.load - elasticity.force(q + step)
                    error = float(np.linalg.norm(residual))
                    if error < 2.0 * last or error <= 1e-8 * scale:
                        break
                step = 0.5 * step
            else:
                return None
            q = q + step
            scale = max(scale, float(np.linalg.norm(evaluation.bore.load)))
        return None


def condensed_tangent(tangent: np.ndarray, elasticity: Elasticity, coordinates: np.ndarray) -> np.ndarray:
    """d wrench / d motion (6, 10) with a massless bore in equilibrium, to first order in the rates.

    From ``tangent`` (6 + k, 10 + 2 k) at the bore's ``coordinates`` (k,): with A = (K - dQ/dq)^-1 the bore follows
    the journal as ``dq = A Q_m dm``; its rate follows the pose's rate likewise and acts through squeeze on wrench and
    bore.
    """
    T, k, M = tangent, coordinates.size, MOTION_SIZE
    softening = T[6:, M : M + k]
    follow = elasticity.solve(coordinates, softening, T[6:, :M])
    rate = np.zeros_like(follow)
    rate[:, 4:8] = follow[:, :4]
    second = elasticity.solve(coordinates, softening, T[6:, M + k :] @ rate)
    return T[:6, :M] + T[:6, M : M + k] @ (follow + second) + T[:6, M + k :] @ rate
