"""Steady elastohydrodynamics.

The bore's coordinates in equilibrium with the film, and the tangent of the wrench with a bore that follows the journal.

With the bush's stiffness K the residual is ``r(q) = K q - Q(q)``; Newton's method uses the exact ``K - dQ/dq``. The
pressure falls as it opens the gap, and falls less in a wider gap. So Newton's steps from a small q end before the
solution and do not overshoot.

A bore with thin parts that the film bends or tilts, such as tongues and pads, has several equilibria. Newton's method
may jump between them or fail. If it does not converge by full steps, the equilibrium is defined by a slow motion: that
of a viscous bore, ``K (q + tau dq/dt) = Q(q)``, from the undeformed state to rest. The motion is integrated by backward
Euler (pseudo-transient continuation). tau over the step h grows if a step fails and falls if it succeeds. Newton's
method starts from the state at which the motion has nearly come to rest. The steps of this motion decide which of
several equilibria is found, so that they have rules of their own and every one is solved by `DampedNewton`.
"""

from __future__ import annotations

from functools import cache
from typing import Generic, Protocol, TypeVar

import numpy as np

from exudyn_ehd.joint.bore.shapes import Bore
from exudyn_ehd.joint.newton import (
    HALVINGS,
    MOST_FILMS,
    PATIENCE,
    ROUNDED,
    ROUNDS,
    DampedNewton,
    SearchState,
    continued,
)
from exudyn_ehd.joint.solved_film import MOTION_SIZE, BoreState, History
from exudyn_ehd.status import ROUNDING, Status

# Pseudo-transient continuation of a viscous bore: tau / h at its start; relative change of q in a step from which on
# Newton's method is tried. It fails at a step h of less than `ROUNDING` times tau.
SLOWEST, NEAR = 10.0, 0.02


class Elasticity:
    """Constant stiffness of the bore's coordinates in a steady state.

    The stiffness of a solid at any strain is in `exudyn_ehd.joint.bore.solid`.

    Parameters
    ----------
    stiffness : (k, k) array
        K, N/m.
    load : (k,) array or float
        Generalised force on the bore in addition to the film's, N.

    Attributes
    ----------
    failure : str
        Reason why the last `settle` found no balance, and a remedy; empty if it found one, or if the film failed.
    reached : float, (k,) array
        Largest fraction of the prescribed eccentricity and tilt with an equilibrium in the last `settle`, and the
        bore's coordinates there.
    """

    failure = ""

    def __init__(self, stiffness: np.ndarray, load: np.ndarray | float = 0.0) -> None:
        self.stiffness, self.load, self.reached = stiffness, load, (0.0, np.zeros(0))

    def force(self, q: np.ndarray) -> np.ndarray:
        """Generalised force (k,) that holds the bore at q, N."""
        return self.stiffness @ q

    def solve(self, softening: np.ndarray, rhs: np.ndarray) -> np.ndarray:
        """Solve ``(K - softening) x = rhs`` for rhs (k,) or (k, r)."""
        return np.linalg.solve(self.stiffness - softening, rhs)

    def tangent(self, evaluation: NodalEvaluation, exact: bool) -> np.ndarray:
        """d (wrench, Q) / d motion (6 + k, 10 + 2 k) of a film after `settle`.

        Not ``exact``: an approximation that suffices for a search.
        """
        return evaluation.tangent()

    def settle(
        self,
        model: FilmOnBore[NodalEvaluation],
        motion: np.ndarray,
        film: tuple[History | None, float, float],
        start: np.ndarray,
    ) -> NodalEvaluation | None:
        """Find the balance of bore and film, as `bore_equilibrium` does."""
        found, self.reached = bore_equilibrium(model, motion, film, start)
        return found


class BoreEvaluation(Protocol):
    """A film on a bore with given coordinates."""

    status: Status
    bore: BoreState

    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """d (wrench, Q) to the motion, and ``by_place d/dq + by_rate d/dq_t``, (6 + k, 10 + k)."""


class NodalEvaluation(BoreEvaluation, Protocol):
    """A film on the nodes of a bore."""

    motion: np.ndarray

    def tangent(self) -> np.ndarray:
        """d (wrench, Q) / d motion (6 + k, 10 + 2 k)."""

    def forces_at(self, x: np.ndarray) -> np.ndarray:
        """Forces (nodes, 3) on the bore's nodes at x (nodes, 3), N."""

    def tangent_at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """d wrench / d motion (6, 10 + 2 k), and that of `forces_at` (nodes, 3, 10 + 2 k)."""


Result = TypeVar("Result", bound=BoreEvaluation)
Found = TypeVar("Found", bound=BoreEvaluation, covariant=True)


class FilmOnBore(Protocol[Found]):
    """A bearing model whose bore has coordinates, with the elasticity that resists them."""

    bore: Bore
    elasticity: Elasticity

    def evaluate(self, motion: np.ndarray, history: History | None, step: float, spin: float) -> Found:
        """The film at a motion (10 + 2 k,)."""


def bore_equilibrium(
    model: FilmOnBore[Result],
    motion: np.ndarray,
    film: tuple[History | None, float, float],
    start: np.ndarray,
) -> tuple[Result | None, tuple[float, np.ndarray]]:
    """Evaluate with the bore in equilibrium.

    If the direct search fails, eccentricity and tilt are approached in steps. Each step starts from coordinates that
    are extrapolated from the last two, since in a thin film the gap closes if the bore does not follow.

    ``film``: history, step and spin as for `BearingModel.evaluate`; ``start``: coordinates (k,) to try before the
    undeformed bore. Returns the evaluation or None, and the largest fraction of eccentricity and tilt with an
    equilibrium, with its coordinates (k,).
    """
    search = BoreSearch(model, motion, film)
    if start.any() and (found := search.find(start, 1.0, straight=True)) is not None:
        return found, (0.0, np.zeros_like(start))
    reached, q, rate = 0.0, np.zeros_like(start), np.zeros_like(start)

    def reach(target: float, here: Result | None, final: bool) -> Result | None:
        nonlocal reached, q, rate
        near = search.settle(q + (target - reached) * rate, target)
        if near is not None and target < 1.0:
            rate = (near.bore.coordinates - q) / (target - reached)
            reached, q = target, near.bore.coordinates.copy()
        return near

    part, near = continued(reach)
    return near if part == 1.0 else None, (reached, q)


class BoreSearch(DampedNewton[SearchState[Result]], Generic[Result]):
    """Damped Newton's method for the coordinates of a bore.

    The residual may double in a step, since the steps of a bore that opens its film end before the solution.

    Parameters
    ----------
    model : FilmOnBore
    motion : (10,) array
    film : tuple
        History, step and spin as for `BearingModel.evaluate`.

    Attributes
    ----------
    slowness, anchor : float, (k,) array
        s = tau / h of a step of a viscous bore, and the coordinates before it; s = 0 for an equilibrium.
    """

    growth = 2.0

    def __init__(
        self, model: FilmOnBore[Result], motion: np.ndarray, film: tuple[History | None, float, float]
    ) -> None:
        self.model, self.motion, self.film = model, motion, film

    def settle(self, q: np.ndarray, part: float) -> Result | None:
        """Find the balance by full Newton steps from q; else by the motion of a viscous bore; else by halved steps."""
        return self.find(q, part, straight=True) or self._come_to_rest(q, part) or self.find(q, part)

    def _come_to_rest(self, q: np.ndarray, part: float) -> Result | None:
        slowness = SLOWEST
        while slowness * ROUNDING < 1.0 and self.count < MOST_FILMS:
            near = self.find(q, part, slowness)
            if near is None:
                slowness *= 4.0
                continue
            new = near.bore.coordinates.copy()
            moved, size = np.linalg.norm(new - q), np.linalg.norm(new)
            found = self.find(new, part) if moved <= NEAR * size else None
            if found is not None and np.linalg.norm(found.bore.coordinates - new) <= 5.0 * NEAR * size:
                return found
            q, slowness = new, slowness / 3.0
        return None

    def find(self, q: np.ndarray, part: float, slowness: float = 0.0, straight: bool = False) -> Result | None:
        """Return the equilibrium found from coordinates q (k,) with the pose scaled by ``part``; None without one.

        ``straight``: None also if a step has to be halved. With a ``slowness`` s = tau / h, the result is the state q'
        of a viscous bore after one step: ``K (q' + s (q' - q)) = Q(q')``.
        """
        self.part, self.slowness, self.anchor = part, slowness, q
        if (start := self.at(q)) is None:
            return None
        rounds, halvings = PATIENCE if slowness else ROUNDS, 0 if straight else HALVINGS
        found = self.search(start, rounds=rounds, halvings=halvings)
        return found.film if self.is_balanced(found, ROUNDED) else None

    def at(self, q: np.ndarray) -> SearchState[Result] | None:
        """Return the film at coordinates q (k,); None without one, or after too many films."""
        self.count += 1
        motion, force = np.concatenate((self.motion[:MOTION_SIZE], q, np.zeros_like(q))), self.model.elasticity.force
        motion[:4] *= self.part
        evaluation = self.model.evaluate(motion, *self.film)
        if evaluation.status is not Status.CONVERGED or self.count > MOST_FILMS:
            return None
        stiffening, load, elasticity = 1.0 + self.slowness, evaluation.bore.load, self.model.elasticity
        unbalance = load + elasticity.load - stiffening * force(q) + self.slowness * force(self.anchor)

        @cache
        def step(resistance: float) -> np.ndarray:
            softening = evaluation.combined_tangent(1.0, 0.0)[6:, MOTION_SIZE:]
            return elasticity.solve(softening / stiffening, unbalance / stiffening)

        return SearchState(q, unbalance, float(np.linalg.norm(load)), step, evaluation)

    def moved(self, state: SearchState[Result], step: np.ndarray) -> SearchState[Result] | None:
        """Film after a step."""
        return self.at(state.x + step)


def condensed_tangent(tangent: np.ndarray, elasticity: Elasticity) -> np.ndarray:
    """d wrench / d motion (6, 10) with a massless bore in equilibrium, to first order in the rates.

    From ``tangent`` (6 + k, 10 + 2 k): with A = (K - dQ/dq)^-1 the bore follows the journal by ``dq = A Q_m dm``. The
    bore's rate follows the rate of the pose in the same way; through the squeeze it acts on the wrench and on the bore.
    """
    T, k, M = tangent, len(elasticity.stiffness), MOTION_SIZE
    softening = T[6:, M : M + k]
    follow = elasticity.solve(softening, T[6:, :M])
    rate = np.zeros_like(follow)
    rate[:, 4:8] = follow[:, :4]
    second = elasticity.solve(softening, T[6:, M + k :] @ rate)
    return T[:6, :M] + T[:6, M : M + k] @ (follow + second) + T[:6, M + k :] @ rate
