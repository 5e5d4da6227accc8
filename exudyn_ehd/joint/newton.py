"""Damped Newton's method and continuation, by which all searches for a steady balance proceed.

A balance is R(x) = 0 with unknowns x: the position of a journal under a load with the temperature of its film, the
coordinates of a flexible bore, the tilts of pads, the positions of all bodies of a rotor. `DampedNewton` searches from
an initial guess. The subclass for a balance evaluates R, gives Newton's step -(dR/dx)^-1 R and shortens it so that no
film closes. All searches have these rules:

1. A step is accepted if there is a film after it and the norm of R is less than `growth` times the one before.
2. Otherwise the step is halved. In a search with a resistance r, the resistance is quadrupled instead, and divided by
   five after an accepted step. With J = dR/dx the step of ``(J^T J + r^2 I) step = -J^T R`` reduces the norm of R for r
   large enough, whatever J (Levenberg 1944, Marquardt 1963). Such steps are slow but reliable where Newton's method
   jumps over a film that starves or touches, and where a film without a cavity moves the journal across the load.
3. A search succeeds when R is below its tolerance, or below `ROUNDED` when round-off keeps R from falling.
4. A search fails when `PATIENCE` steps have made no progress, when `HALVINGS` halvings lead to no acceptable step, or
   after `ROUNDS` steps. It returns the last state that it has reached.

`continued` follows a balance over a parameter, from a case that is easy to find to the wanted one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

# Largest number of steps of a search; number of steps in a row without progress, after which a search fails; largest
# number of halvings of a step. Larger: hopeless searches take longer; smaller: slow ones fail.
ROUNDS, PATIENCE, HALVINGS = 300, 20, 12
# Tolerance of a residual over the load; `ROUNDED` if round-off keeps the residual from falling. Larger: fewer films,
# less accurate states.
SETTLED, ROUNDED = 1e-11, 1e-8
# Largest number of film solves of a whole search. Larger: a hopeless search takes longer.
MOST_FILMS = 6000
# Shortest step of a continuation over the whole way, at which it fails. Smaller: slower, fails less often.
SHORTEST = 1e-4

Film = TypeVar("Film", covariant=True)


@dataclass(eq=False)
class SearchState(Generic[Film]):
    """A state of a search: the unknowns with everything that was evaluated there.

    Attributes
    ----------
    x : (n,) array
        Unknowns.
    unbalance : (n,) array
        R(x).
    size : float
        Size of the loads, over which the unbalance is measured.
    newton_step : function
        Newton's step (n,) for a resistance. It is first called while the film is the last one of its model, because the
        tangent is made of buffers of the model.
    film : Film
        Film or films at x.
    """

    x: np.ndarray
    unbalance: np.ndarray
    size: float
    newton_step: Callable[[float], np.ndarray]
    film: Film

    @property
    def residual(self) -> float:
        """Norm of the unbalance."""
        return float(np.linalg.norm(self.unbalance))


AnyState = TypeVar("AnyState", bound=SearchState[object])
Reached = TypeVar("Reached")


class DampedNewton(Generic[AnyState]):
    """Search for the state in which the unbalance R(x) vanishes.

    A subclass has at least the method `moved`.

    Attributes
    ----------
    growth : float
        Largest ratio of the residuals after and before a step without a resistance; inf: every film is accepted.
    progress : float
        Largest ratio of an error to the smallest one before it that counts as progress.
    tolerance : float
        Residual over the size of the loads at which a search ends.
    count : int
        Number of states evaluated.
    """

    growth, progress, tolerance, count = 1.0, 0.9, SETTLED, 0

    def moved(self, state: AnyState, step: np.ndarray) -> AnyState | None:
        """Evaluate the state after a step; None without a film."""
        raise NotImplementedError

    def step(self, state: AnyState, resistance: float) -> np.ndarray:
        """Step from a state, which a subclass shortens so that no film closes."""
        return state.newton_step(resistance)

    def is_balanced(self, state: AnyState, tolerance: float) -> bool:
        """Return whether the residual is below a share of the size of the loads."""
        return state.residual <= tolerance * state.size

    def error(self, state: AnyState) -> float:
        """Measure of the progress of the search."""
        return state.residual

    def resumes(self) -> bool:
        """Return whether a search without progress goes on from the best state, with other steps."""
        return False

    def search(
        self, start: AnyState, *, resistance: float = 0.0, rounds: int = ROUNDS, halvings: int = HALVINGS
    ) -> AnyState:
        """Return the balanced state, evaluated last; the last state that was reached if the search fails."""
        here = best = start
        there: AnyState | None = start
        smallest, last, idle, part = self.error(here), math.inf, 0, 1.0
        for _ in range(rounds):
            rounded = here.residual > 0.5 * last and self.is_balanced(here, ROUNDED)
            if rounded or self.is_balanced(here, self.tolerance):
                break
            if idle > PATIENCE:
                if there is not here or not self.resumes():
                    break
                here, idle = best, 0
            there = self.moved(here, part * self.step(here, resistance))
            limit = here.residual if resistance else self.growth * here.residual
            if there is None or (there.residual >= limit and not self.is_balanced(there, ROUNDED)):
                if resistance:
                    resistance, idle = 4.0 * resistance, idle + 1
                else:
                    part *= 0.5
                if part < 0.5**halvings:
                    break
                continue
            last, here, part, resistance = here.residual, there, 1.0, resistance / 5.0
            error = self.error(here)
            idle = 0 if error <= self.progress * smallest else idle + 1
            if error < smallest:
                best, smallest = here, error
        if there is not here and self.is_balanced(here, ROUNDED):
            here = self.moved(here, 0.0 * self.step(here, 0.0)) or here
        return here


def damped_step(slope: np.ndarray, residual: np.ndarray, resistance: float) -> np.ndarray:
    """Newton's step (n,) for a residual (n,) with the derivative ``-slope`` (n, n), damped by a resistance."""
    rows = np.vstack((slope, resistance * np.eye(residual.size)))
    step, *_ = np.linalg.lstsq(rows, np.append(residual, np.zeros_like(residual)), rcond=None)
    return step


class Acceleration:
    """Anderson's acceleration of a fixed-point iteration, by its points and changes since the last `restart`.

    Attributes
    ----------
    damping : float
        Factor of the changes.
    """

    def __init__(self) -> None:
        self.damping = 1.0
        self.restart()

    def restart(self) -> None:
        """Forget all points."""
        self.points: list[np.ndarray] = []
        self.changes: list[np.ndarray] = []

    def step(self, point: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Return the step (k,) from a point (k,) at which the iteration gives a change (k,)."""
        most = min(PATIENCE, change.size) + 1
        self.points, self.changes = [*self.points, point][-most:], [*self.changes, change][-most:]
        if len(self.points) == 1:
            return self.damping * change
        by_point, by_change = np.diff(self.points, axis=0).T, np.diff(self.changes, axis=0).T
        weights = np.linalg.lstsq(by_change, change, rcond=1e-12)[0]
        return self.damping * change - (by_point + self.damping * by_change) @ weights


def continued(
    reach: Callable[[float, Reached | None, bool], Reached | None], step: float = 1.0, shortest: float = SHORTEST
) -> tuple[float, Reached | None]:
    """Follow states over a parameter from 0 to 1; a step is halved if it leads to no state.

    Parameters
    ----------
    reach : function
        Function of the parameter, of the last state (None at first), and of a flag for the shortest step; it returns
        the state there, or None.
    step, shortest : float
        First and shortest step.

    Returns
    -------
    parameter, state
        Last parameter reached, with its state; 0 and None if no state was found.
    """
    at, here = 0.0, None
    while at < 1.0:
        target = min(1.0, at + step)
        if (there := reach(target, here, step <= shortest)) is not None:
            at, here = target, there
        elif step <= shortest:
            break
        else:
            step = max(0.5 * step, shortest)
    return at, here
