"""Newton's method for a film whose gap or density depends on its pressure, together with its sets.

The chord method: a factor is reused while the sets stay and the steps contract, and the
contraction also says what is left after a step (E. Hairer, G. Wanner, Solving Ordinary
Differential Equations II, 1996, section IV.8). Steps are halved while the balances do not improve.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.links import FilmState


class Rule(NamedTuple):
    """Tolerances of the driver; sizes are shares of the peak pressure."""

    # cold films of soft liners at their limits need some 40
    most_steps: int = 60
    # rounding of a pressure that comes out of a factor: what is left of a converged film
    converged: float = 1e-13
    # what a step with a fresh factor leaves is its square times the curvature, which is some 10 in thin films
    square: float = 1e-14
    # below it the change of a balance is rounding, and says nothing about a step
    silent: float = 1e-8
    # an error so small leaves the factor that of the solution to the rounding of a tangent
    exact: float = 1e-7
    # a last step so small needs no other look at gaps and balances
    final: float = 1e-10
    # a factor whose steps shrink less than five times is slower than a new one
    contraction: float = 0.2
    # a factor that leaves more than this of a step does not pay again
    reusable: float = 0.005
    # halvings until a share of a step is lost in rounding
    most_halvings: int = 12


RULE = Rule()


class Step(NamedTuple):
    """Newton's step: largest change of a pressure over the peak or of a fill;
    over what counts after it; the peak; safe share of the step."""

    size: float
    left: float
    peak: float
    share: float


class Balance(Protocol):
    """A film as the driver sees it: its balance and its slopes, what a step may do, and its sets.

    Attributes
    ----------
    u, trial : FilmState
        Present state, and the one that a step would lead to.
    reusable : bool
        Whether the factor of the last film is there to start with.
    exact : bool
        Set on return: whether the factor is that of the solution.
    changes : int
        How many unknowns change sides on the way to the trial state.
    """

    u: FilmState
    trial: FilmState
    reusable: bool
    exact: bool
    changes: int

    def balance(self, state: FilmState) -> tuple[float, float]:
        """Norm of what does not hold, and the smallest gap; gaps of zero or less where there is no film."""

    def begin(self) -> None:
        """Sets to start with; scales of what is none but rounding."""

    def factor(self) -> bool:
        """Newton's matrix at the present state, factored."""

    def unknowns(self) -> int:
        """Number of unknowns of the factor."""

    def step(self, gap: float) -> Step:
        """Newton's step with the factor at hand, and the trial state after its
        safe share; ``gap`` is the smallest one."""

    def move(self, share: float, peak: float) -> int:
        """The trial state after another ``share`` of the step; returns how many unknowns change sides."""

    def accept(self) -> int:
        """The trial state becomes the present one; returns how many vertices change sides."""

    def undo(self) -> None:
        """Sets at the present state once more, after a trial that is not taken."""

    def nothing_left(self, norm: float) -> bool:
        """Whether the balances hold to the rounding of the flows."""

    def settled(self, norm: float) -> bool:
        """Whether small steps mean a solution."""

    def correct(self, gap: float) -> None:
        """One more step with the factor at hand, for the balances alone."""

    def sound(self) -> bool:
        """Whether the film holds what a film can hold."""


@njit(cache=True)
def too_slow(size, last):
    """Whether a step shows that an older factor is of no use any more; ``last`` is the step before."""
    return size > RULE.contraction * last


@njit(cache=True)
def improves(gap, trial_norm, norm, size, changes):
    """Whether a trial state is taken: with a gap, and balances that hold better, unless they can't tell."""
    return gap > 0.0 and (trial_norm < norm or size <= RULE.silent or changes > 0)


@njit(cache=True)
def is_final(left, last, fresh):
    """Whether what a step leaves may be left: about its square, or with an
    older factor itself times its ratio to the last one."""
    return left * left <= (RULE.square if fresh else RULE.converged * min(max(last, 1e-300), 1.0))


@njit(cache=True)
def pays_again(size, last, new):
    """Whether a factor is used for another step; ``new``: it was for the first time, in this film."""
    return new or size <= RULE.reusable * last


def newton(film: Balance) -> tuple[bool, int]:
    """Solve from the film's present state, in place; returns (found, steps)."""
    norm, gap = film.balance(film.u)
    if not gap > 0.0:
        return False, 0
    film.begin()
    reused = ready = film.reusable
    film.reusable = film.exact = False
    last, last_left, moved = 0.0, 0.0, 0.0
    for count in range(1, RULE.most_steps + 1):
        fresh = not ready
        if fresh:
            if not film.factor():
                return False, count
            moved = 0.0
            if film.unknowns() == 0 or norm == 0.0:
                film.exact = film.reusable = True
                return True, count
        step = film.step(gap)
        if not step.size < 1e300:
            return False, count
        from_last = reused and count == 1
        converged = step.size <= RULE.converged
        if not (fresh or from_last or converged) and too_slow(step.size, last):
            ready = False
            continue
        share, trial_norm, trial_gap = _search(film, step, norm, 1 if from_last else RULE.most_halvings)
        if from_last and not improves(trial_gap, trial_norm, norm, step.size, film.changes):
            norm, gap = film.balance(film.u)
            film.undo()
            ready = False
            continue
        norm, gap = trial_norm, trial_gap
        if not (gap > 0.0 and norm < 1e300):
            return False, count
        changes = film.accept()
        moved += share * step.size
        if film.nothing_left(norm):
            film.exact = film.reusable = film.factor()
            return film.exact, count
        ready = changes == 0 and share == 1.0
        if ready:
            converged = converged and film.settled(norm)
            if converged or (not from_last and is_final(step.left, last_left, fresh)):
                if not converged:
                    film.correct(gap)
                film.exact = not from_last and moved <= RULE.exact
                film.reusable = True
                return film.sound(), count
        ready = ready and pays_again(step.size, last, fresh or from_last)
        # how steps with another film's factor shrink says nothing about what is left
        last, last_left = step.size, 0.0 if from_last else step.left
    return False, RULE.most_steps


def _search(film: Balance, step: Step, norm: float, most: int) -> tuple[float, float, float]:
    """Halve the step until the balances improve; returns (share of the step, norm, smallest gap)."""
    share, changes, trial_norm, gap = step.share, film.changes, np.inf, -1.0
    for k in range(most):
        if k > 0:
            share *= 0.5
            changes = film.move(share, step.peak)
        trial_norm, gap = film.balance(film.trial)
        if improves(gap, trial_norm, norm, step.size, changes):
            break
    return share, trial_norm, gap
