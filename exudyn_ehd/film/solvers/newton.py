"""Rules of Newton's method for a film whose gap or density depends on its pressure, together with its sets.

The chord method: a factor is reused while the sets stay and the steps contract, and the
contraction also says what is left after a step (E. Hairer, G. Wanner, Solving Ordinary
Differential Equations II, 1996, section IV.8). Steps are halved while the balances do not improve.
"""

from __future__ import annotations

from typing import NamedTuple

from numba import njit


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
    # change of the film since its factor, up to which that is the solution's: tangents are as exact
    exact: float = 1e-13
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
