"""Steady elastohydrodynamics.

The bore's coordinates in equilibrium with the film, and the tangent of a bore that follows.

With the bush's stiffness K the residual is ``r(q) = Q(q) - K q``; the damped Newton's method of
`exudyn_ehd.joint.newton` with the exact ``K - dQ/dq``. A pressure falls with the gap it opens, and falls the less the
wider the gap: from a small q on Newton's steps stop short of the solution and stay on the safe side.

A bore with thin parts that the film bends or tilts, as tongues and pads, has several equilibria, and Newton's method
jumps between them or nowhere. Damped, its steps are those of a bore that moves as slowly as a viscous one,
``K (q + tau dq/dt) = Q(q)``: backward Euler, whose time step is tau over the damping. A step is taken where it leaves
less of this balance than there was before. So the equilibrium is the one to which the undeformed bore comes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Protocol, TypeVar

import numpy as np

from exudyn_ehd.joint.bore.shapes import Bore
from exudyn_ehd.joint.newton import DampedNewton, continued
from exudyn_ehd.joint.solved_film import MOTION_SIZE, BoreState, History
from exudyn_ehd.status import ROUNDING, Status

# Shortest step of the continuation to the prescribed position, and trials after which none is begun.
SMALLEST_PART, MOST_TRIALS = 1e-4, 3000
# Share of the viscous balance that a damped step may leave. Larger ones jump between equilibria: with 0.5 one of 16
# random tongues is in another one than with 0.2 and with ten Newton steps at a time.
LEFT = 0.2


class Elasticity:
    """Stiffness of the bore's coordinates in a steady state: a constant matrix.

    `exudyn_ehd.joint.bore.solid` has the stiffness of a solid at any strain.

    Parameters
    ----------
    make : function
        Returns the matrix (k, k), N/m; called when it is first needed.
    load : (k,) array or float
        Generalised force on the bore besides the film's, N.

    Attributes
    ----------
    failure : str
        Reason why the last `settle` found no balance, and a remedy; empty if it did, or if the film is the reason.
    reached : float, (k,) array
        Largest part of the last place of `settle` with an equilibrium on the way, and its coordinates.
    straight : bool
        `settle` gives up where Newton's method does not go straight to a balance: for searches that can come nearer.
    """

    failure = ""
    straight = False

    def __init__(self, make: Callable[[], np.ndarray], load: np.ndarray | float = 0.0) -> None:
        self._make, self.load, self.reached = make, load, (0.0, np.zeros(0))

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

    def tangent(self, evaluation: NodalEvaluation, exact: bool) -> np.ndarray:
        """d (wrench, Q) / d motion (6 + k, 10 + 2 k) of a film after `settle`; good enough for a search, or exact."""
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

    @property
    def status(self) -> Status: ...
    @property
    def bore(self) -> BoreState: ...
    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """d (wrench, Q) to the motion, and ``by_place d/dq + by_rate d/dq_t``, (6 + k, 10 + k)."""


class NodalEvaluation(BoreEvaluation, Protocol):
    """A film on the nodes of a bore."""

    @property
    def motion(self) -> np.ndarray: ...
    def tangent(self) -> np.ndarray:
        """d (wrench, Q) / d motion (6 + k, 10 + 2 k)."""

    def forces_at(self, x: np.ndarray) -> np.ndarray:
        """Forces (nodes, 3) on the bore's nodes at x (nodes, 3), N."""

    def tangent_at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """d wrench / d motion (6, 10 + 2 k), and that of `forces_at` (nodes, 3, 10 + 2 k)."""


Result = TypeVar("Result", bound=BoreEvaluation, covariant=True)
Film = TypeVar("Film", bound=BoreEvaluation)


class FilmOnBore(Protocol[Result]):
    """A bearing model whose bore has coordinates, and what resists them."""

    @property
    def bore(self) -> Bore: ...
    @property
    def elasticity(self) -> Elasticity: ...
    def evaluate(self, motion: np.ndarray, history: History | None, step: float, spin: float) -> Result:
        """The film at a motion (10 + 2 k,)."""


def bore_equilibrium(
    model: FilmOnBore[Film],
    motion: np.ndarray,
    film: tuple[History | None, float, float],
    start: np.ndarray,
) -> tuple[Film | None, tuple[float, np.ndarray]]:
    """Evaluate with the bore in equilibrium.

    The place is approached in parts where the rigid surfaces would touch, each from where the last two lead: a thin
    film leaves the bore no room to stay behind.

    ``film``: history, step and spin as for `BearingModel.evaluate`; ``start``: coordinates (k,) to begin with, if
    they leave a gap, before the undeformed bore. Returns the evaluation or None, and the largest part of the place with
    an equilibrium on the way, with its coordinates (k,).
    """
    newton, still = BoreNewton(model, motion, film), np.zeros_like(start)
    found = newton.solve(start, 1.0, straight=True) if start.any() else None
    if found is not None:
        return found, (1.0, start)
    path, straight = [(-1.0, still), (0.0, still)], model.elasticity.straight

    def reach(part: float, here: Film | None, final: bool) -> Film | None:
        (before, first), (last, q) = path[-2:]
        guess = q + (part - last) / (last - before) * (q - first)
        near = newton.solve(guess, part, straight) if newton.trials < MOST_TRIALS else None
        if near is not None:
            path.append((part, near.bore.coordinates.copy()))
        return near

    reached, found = continued(reach, 1.0, 1.0 if straight else SMALLEST_PART)
    return found if reached == 1.0 else None, path[-1]


class BoreNewton(DampedNewton[Film]):
    """Search for the coordinates q of a bore in balance with the film at a motion."""

    def __init__(self, model: FilmOnBore[Film], motion: np.ndarray, film: tuple[History | None, float, float]) -> None:
        self.model, self.motion, self.film = model, motion, film
        self.trials = 0

    def solve(self, q: np.ndarray, part: float, straight: bool = False) -> Film | None:
        """Equilibrium from coordinates q (k,) with the pose scaled by ``part``, the model's last; None if not found.

        ``straight``: nor where a step has to be damped.
        """
        self._full = np.concatenate((self.motion[:MOTION_SIZE], q, np.zeros(q.size)))
        self._full[:4] *= part
        self._size, self._at = 1e-300, None
        self.most_damping = 0.0 if straight else DampedNewton.most_damping
        start = self._evaluate(q)
        found = None if start is None else self.descend(start)
        if found is None or not self.is_balanced(found):
            return None
        return found if found is self._last else self._evaluate(found.bore.coordinates.copy())

    def _evaluate(self, q: np.ndarray) -> Film | None:
        self._full[MOTION_SIZE : MOTION_SIZE + q.size] = q
        self.trials += 1
        self._last = found = self.model.evaluate(self._full, *self.film)
        if found.status is not Status.CONVERGED:
            return None
        self._size = max(self._size, float(np.linalg.norm(found.bore.load)))
        return found

    def _residual(self, place: Film) -> np.ndarray:
        elasticity = self.model.elasticity
        return place.bore.load + elasticity.load - elasticity.force(place.bore.coordinates)

    def step(self, here: Film, damping: float) -> np.ndarray:
        """Step (k,) of a bore with a viscosity, m."""
        if here is not self._at:  # its film is the model's last then
            self._at, self._softening = here, here.combined_tangent(1.0, 0.0)[6:, MOTION_SIZE:]
        held = 1.0 + damping
        return self.model.elasticity.solve(here.bore.coordinates, self._softening / held, self._residual(here) / held)

    def moved(self, here: Film, step: np.ndarray) -> Film | None:
        """The film a step on."""
        return self._evaluate(here.bore.coordinates + step)

    def error(self, place: Film) -> float:
        """Residual over the largest load of the search."""
        return float(np.linalg.norm(self._residual(place))) / self._size

    def is_balanced(self, place: Film, tolerance: float = ROUNDING) -> bool:
        """Return whether the residual is below a share of the load."""
        return self.error(place) <= tolerance

    def accepts(self, here: Film, there: Film, damping: float) -> bool:
        """Return whether a step is taken: with what the viscosity resists, less of the balance is left."""
        resisted = damping * (self.model.elasticity.stiffness @ (there.bore.coordinates - here.bore.coordinates))
        left = np.linalg.norm(self._residual(there) - resisted)
        return bool(left < (LEFT if damping > 0.0 else 1.0) * np.linalg.norm(self._residual(here)))


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
