"""One damped Newton's method, and one continuation, for all balances of a joint: journals, pads and flexible bores.

Of unknowns x with the residual r(x), both scaled, a step with the damping d, a number from 0 on, is

    (J^T J + d^2 I) dx = J^T r,    J = -dr/dx

after Levenberg (1944) and Marquardt (1963), or what a balance puts in its place. It is Newton's where d is 0, and goes
downhill in |r|^2 for d large enough, whatever J. A step that finds no film, or does not go downhill, is taken back and
damped more.
"""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

from exudyn_ehd.status import ROUNDING, SMALL

# Share of its size below which a residual is balanced; where round-off keeps it from falling further, `ROUNDING` is.
TOLERANCE = 1e-11
# Rounds that may pass without the error falling to a share of what it was. More rounds, and a share nearer to 1, give
# up later: with 12 rounds three of 440 random bearings lose the position that they have with 20 and more.
PATIENCE, FALLS = 30, 0.9
# First damping, and factor by which it grows with a step that is taken back, and falls with one that is taken. Of 16
# random bores with tongues 13 are found with the factor 8, all with 3 and 4.
FIRST_DAMPING, FACTOR = 0.01, 3.0
# Growth of the step of a continuation behind one that is reached.
LONGER = 1.5

P = TypeVar("P")


class DampedNewton(abc.ABC, Generic[P]):
    """Search for a balance from place to place.

    Attributes
    ----------
    most_damping : float
        Damping beyond which no step leads on; 0 for a search that goes straight to a balance or gives up.
    """

    most_damping = 1.0 / ROUNDING

    @abc.abstractmethod
    def step(self, here: P, damping: float) -> np.ndarray:
        """Damped step from a place."""

    @abc.abstractmethod
    def moved(self, here: P, step: np.ndarray) -> P | None:
        """Place behind a step, or behind as much of it as gaps allow; None without a film."""

    @abc.abstractmethod
    def error(self, place: P) -> float:
        """Size of the residual."""

    @abc.abstractmethod
    def is_balanced(self, place: P, tolerance: float = ROUNDING) -> bool:
        """Return whether the residual is below a share of its size, or round-off."""

    def accepts(self, here: P, there: P, damping: float) -> bool:
        """Return whether a step is taken: downhill."""
        return self.error(there) < self.error(here)

    def descend(self, here: P, damping: float = 0.0) -> P:
        """Place in balance from a place on, or the last one where no progress is made."""
        smallest, idle = self.error(here), 0
        while idle <= PATIENCE and damping <= self.most_damping and not self.is_balanced(here, TOLERANCE):
            there = self.moved(here, self.step(here, damping))
            if self.is_balanced(here) and (there is None or not self.error(there) < self.error(here)):
                break
            if there is None or not self.accepts(here, there, damping):
                damping = max(FIRST_DAMPING, FACTOR * damping)
                continue
            idle += 1
            here, damping = there, damping / FACTOR if damping > SMALL else 0.0
            if self.error(here) < FALLS * smallest:
                smallest, idle = self.error(here), 0
        return here


def levenberg_step(slope: np.ndarray, residual: np.ndarray, damping: float) -> np.ndarray:
    """Step (k,) by ``slope`` (k, k), minus the derivative of the ``residual`` (k,), all of them scaled."""
    rows = np.vstack((slope, damping * np.eye(residual.size)))
    step, *_ = np.linalg.lstsq(rows, np.append(residual, np.zeros(residual.size)), rcond=None)
    return np.asarray(step)


def continued(
    reach: Callable[[float, P | None, bool], P | None], step: float, shortest: float
) -> tuple[float, P | None]:
    """Follow films over a parameter from 0 to 1, by steps that are halved where one is not reached.

    Parameters
    ----------
    reach : function
        Of the parameter, the last film (None for the first), and whether the step can't be halved any more; returns the
        film there, or None.
    step, shortest : float
        First and shortest step.

    Returns
    -------
    parameter, film
        The last that was reached; 0 and None without any.
    """
    at, here = 0.0, None
    while at < 1.0:
        target = min(1.0, at + step)
        there = reach(target, here, step <= shortest)
        if there is not None:
            at, here, step = target, there, LONGER * step
        elif step <= shortest:
            break
        else:
            step = max(0.5 * step, shortest)
    return at, here
