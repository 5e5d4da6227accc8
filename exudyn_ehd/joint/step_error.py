"""Error of the gap by the time steps of a run, estimated from the accepted steps alone.

A film has no inertia. In balance with its load it gives the journal's pose a rate, dp/dt = f(p, t), which the time
integration integrates. The local error of a step h is its displacement minus the integral of the parabola through the
rates r that the film got in the last three states,

    l = p1 - p0 - (r0 + r1) h / 2 + [r_1, r0, r1] h^3 / 6

with the second divided difference in brackets; the error of the parabola is one order smaller. The local error of the
momentum follows in the same way from the velocities v of the bodies and from accelerations a. These are the
accelerations that satisfy the equations of motion at accepted states; those of Newmark's formulas differ from them.

    m = M (v1 - v0 - (a0 + a1) h / 2 + [a_1, a0, a1] h^3 / 6)

The parabolas do not hold if a load L on the film jumps within a step. If the load is a function of time, its mean
within the step is known. It exceeds the mean of both ends by s d, with the deviation d of L from the line through the
two states before, and the offset s (`exudyn_ehd.coupling.element.outer_load`). For a jump at the fraction u of the
step, s = 1/2 - u. Such a step, and the one after it, is integrated again with the film's force between both ends
(`exudyn_ehd.joint.time_step`). The result replaces l and m.

Errors e of the pose follow the equation of motion of the journal in its film, under the same load,

    M d2e/dt2 + D de/dt + K e = 0,

separately for translations and for tilts (for a ball: three translations). Damping D = -dF/dr and stiffness K = -dF/dp
are those of Newton's last iteration; M is the mass that acts on the film (`exudyn_ehd.coupling.element.outer_load`). No
film is solved for it. The equation is integrated by two stages of backward Euler, of second order and L-stable, so that
M may be zero. Each step adds l and m in its middle, with the mean of D at both ends. The error of the gap is the larger
|e| of both ends of the journal. The rate of a liner's deflection w enters the film as a difference quotient, of first
order. Its error adds to the error of a step, along the direction of the peak, unless the peak jumps: h times the
difference of dw/dt, by the parabola through the last three states, and (w1 - w0) / h.

For impacts, and for loads that are set from step to step, u is unknown. The integration assumes the middle of the step.
For a uniformly distributed u the impulse has a standard deviation of h |d| / sqrt(12), which adds to the variance P of
(e, de/dt). The error of the gap is then the root of |e|^2 plus the trace of P. This is 0.5 to 2.5 times the error
unless the jump lies within 0.12 h of the middle. d is the deviation from the line through the two states before, if
this deviation is sudden. After a jump, the deviation from the line before the jump is used if it is smaller: so a pulse
has two jumps.

Accuracy, as estimate over error: 0.69 to 1.8, for half of them 0.98 to 1.02, for 416 errors above 2 % by random jumps,
ramps, pulses and knocks of loads that are functions of time (`tests/mechanisms/test_load_jumps.py`). 0.75 to 1.3 for 42
such errors of journals of 10 to 120 times the weight of their load. Without the loads' functions, as for impacts, 0.5
to 2.5 for 125 of 137 errors.

Omitted are: the first two steps, in which the rates still jump from the given initial values to those of the films;
pulses within a step without `StepControl`, which no accepted state shows; oscillations that the trapezoidal rule does
not damp; constraints, in M; and errors of the films' memory: heat and cavities, nearly of second order; wear and
compressible volumes of restrictors, of first order. The line at the end of a run gives the error of the pressures
behind restrictors. With `ElrodAdams` the estimate was 0.04 to 0.9 of the error, with `FilmEnergy` 0.02 to 0.9.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from exudyn_ehd.joint.time_step import GAMMA, errors_of_jumps, extrapolated, resists


class MotionPart(NamedTuple):
    """Components of a motion that share mass, stiffness and damping.

    Attributes
    ----------
    rows, places : tuples of k int
        Indices in the wrench, and in the pose and the columns of a `FilmLoad`. In a motion, the index of a rate is that
        of its pose plus four.
    """

    rows: tuple[int, ...]
    places: tuple[int, ...]

    def lever(self, length: float) -> float:
        """Length that turns the part's pose into a distance: half the bearing's for tilts, 1 for translations."""
        return 0.5 * length if self.rows[0] else 1.0


# Translations and tilts of a journal, translations of a ball.
JOURNAL: tuple[MotionPart, ...] = (MotionPart((0, 1), (0, 1)), MotionPart((3, 4), (2, 3)))
BALL: tuple[MotionPart, ...] = (MotionPart((0, 1, 2), (0, 1, 2)),)


class FilmLoad(NamedTuple):
    """Load on a film at n accepted states, and local errors of the momentum in the steps to them; nan if unknown.

    Attributes
    ----------
    force : (n, 4) array
        Force, N, and moment, N m, in the order of the parts.
    offset : (n, 1) array
        Mean load in the step minus the mean of its ends, over the deviation of the load; nan if the load is no function
        of time.
    lasting : (n, 1) array
        Fraction of the step in which the load changes.
    mass : (n, 6) array
        Upper triangles of the parts' masses, kg and kg m^2.
    momentum : (n, 4) array
        Change of momentum minus the trapezoidal integral of the accelerations, N s and N m s.
    demanded : (n, 4) array
        Masses times the accelerations that satisfy the equations of motion, N and N m.
    """

    force: np.ndarray
    offset: np.ndarray
    lasting: np.ndarray
    mass: np.ndarray
    momentum: np.ndarray
    demanded: np.ndarray

    @classmethod
    def of(cls, columns: np.ndarray) -> FilmLoad:
        """Load from columns (n, 20) side by side."""
        return cls(*np.split(columns, np.cumsum(LOAD_COLUMNS)[:-1], axis=-1))


# Numbers of columns of a `FilmLoad`.
LOAD_COLUMNS = (4, 1, 1, 6, 4, 4)
# Index of the first state whose error is estimated.
FIRST = 3
# Lower bound of the gap in relative errors, over the clearance. Smaller: larger errors are reported for closed gaps.
SMALLEST_GAP_SHARE = 1e-3
# Cosine of the angle by which a peak turns in a step, below which it counts as having jumped.
JUMP = 0.9
# A load has jumped in a step if the deviation from a straight line, times the step, has grown suddenly: that of the
# step before is less than this share of it. A larger share repeats steps of smooth loads, a smaller one misses jumps of
# loads that vary. It decides where the functions of loads are called, and which jumps have an unknown time. Of 138
# errors by jumps, without functions, 92, 92, 91 and 91 % were estimated at 0.5 to 2.5 times their size with shares of
# 0.1, 0.2, 0.3 and 0.5. Steps of a spatial four-bar mechanism without jumps: none is repeated at 0.05 to 0.3; five are
# repeated at 0.5, with 1.6 times the evaluations of films and five times the error.
SUDDEN = 0.3
# Error of a step over its allowed error, above which the step is repeated. Larger: fewer repeated steps, larger errors.
REFUSED = 8.0
# Allowed error of a step over the error that is left, and least error left over the largest one. Larger: larger steps.
BUDGET = 0.1
# Error aimed at by the recommended number of steps: below half the reported limit, as that of first steps is unknown.
GOAL = 0.02


@functools.cache
def recorded_entries(parts: tuple[MotionPart, ...]) -> tuple[np.ndarray, ...]:
    """Rows and columns of the entries of a tangent (6, 10) that errors need: dF/dp and dF/dr of all parts."""
    pairs = [(row, place + shift) for part in parts for shift in (0, 4) for row in part.rows for place in part.places]
    return tuple(np.array(pairs).T)


def no_error(parts: tuple[MotionPart, ...]) -> list[np.ndarray]:
    """Return the errors at the start of a record: zeros (1 + 2 k, 2 k) for each part.

    The first row has the error and its rate, the others their variance (2 k, 2 k).
    """
    return [np.zeros((1 + 2 * len(part.rows), 2 * len(part.rows))) for part in parts]


def errors_behind(
    parts: tuple[MotionPart, ...],
    before: Sequence[np.ndarray],
    time: np.ndarray,
    motion: np.ndarray,
    tangent: np.ndarray,
    minimum_gap: np.ndarray,
    clearance: float,
    length: float,
    deflection: np.ndarray | None,
    load: FilmLoad,
) -> tuple[np.ndarray, Sequence[np.ndarray]]:
    """Return the error (n,) of the gap over the minimum film thickness at accepted states, and the last errors.

    The first `FIRST` states, and those before the first tangent, have nan. A record may be evaluated in parts with the
    same result, if every part begins with the last `FIRST` states of the previous one.

    Parameters
    ----------
    parts : tuple of MotionPart
        `JOURNAL` or `BALL`.
    before : sequence of arrays
        `no_error` at the start of a record, else the errors returned for the previous part.
    time : (n,) array
        s.
    motion : (n, 8) array
        Pose and rates that the film got.
    tangent : (n, m) array
        `recorded_entries` of the tangents; nan for a state without one, which uses the last tangent.
    minimum_gap : (n,) array
        m.
    clearance, length : float
        m.
    deflection : (n, 2) array, optional
        Largest deflection of a liner, m.
    load : FilmLoad
        Load on the film; where it is nan, no jump is assumed.
    """
    out = np.full(time.size, np.nan)
    last = np.maximum.accumulate(np.where(np.isfinite(tangent[:, 0]), np.arange(time.size), -1))
    # no errors in rows before the first tangent
    first = int(np.count_nonzero(last < 0))
    known = slice(max(FIRST, first), None)
    if time.size <= known.start:
        return out, before
    lag, after = _lag(time, deflection), []
    square, ends = np.zeros(time.size), np.zeros((2, time.size, len(parts[0].rows)))
    for part, state, film in zip(parts, before, _films(parts, tangent[np.maximum(last, first)]), strict=True):
        terms, lever = _terms(part, time, *film, motion, lag, load, known), part.lever(length)
        error, variance, state = _errors(time.size, known, terms, state)
        after.append(state)
        ends += np.multiply.outer((-lever if part.rows[0] else lever, lever), error)
        square += lever**2 * variance
    whole = np.sqrt(np.max(np.sum(ends**2, axis=2), axis=0) + square)
    out[known] = (whole / np.maximum(minimum_gap, SMALLEST_GAP_SHARE * clearance))[known]
    return out, after


def next_error(
    parts: tuple[MotionPart, ...],
    time: np.ndarray,
    motion: np.ndarray,
    tangents: tuple[np.ndarray, np.ndarray],
    load: FilmLoad,
    before: Sequence[np.ndarray],
    length: float,
    largest: float,
    deflection: np.ndarray | None = None,
) -> tuple[list[np.ndarray], float, np.ndarray]:
    """Return the errors after a step, the local error over the allowed one, and errors by loads within the step.

    The allowed local error is the larger of two values: the part of the ``largest`` error by which the film's damping
    reduces an error in a step, and `BUDGET` times the difference between ``largest`` and the error before the step.

    Parameters
    ----------
    parts : tuple of MotionPart
        `JOURNAL` or `BALL`.
    time : (n,) array
        Times of the last states, s: three or more; with six, all pulses are distinguished from ringing.
    motion : (n, 8) array
        Motion at these times, with the rates that the film got.
    tangents : two (m,) arrays
        `recorded_entries` of the tangents of the film's wrench, at the start of the step and at its end.
    load : FilmLoad
        Load on the film.
    before : sequence of arrays
        Errors at the start of the step: `no_error`, or those returned for the previous step.
    length, largest : float
        Length of the bearing, and allowed error of the gap, m.
    deflection : (n, 2) array, optional
        Largest deflection of a liner, m.

    Returns
    -------
    list of arrays, float, ndarray (4,)
        The last one in m: error by a jump in the step, or the step before, whose time is known; displacement by a jump
        of unknown time and by the whole load in the step, both without inertia; error before the step.
    """
    missed, lag, n = missed_in_steps(time, motion[:, :4], motion[:, 4:8]), _lag(time, deflection), time.size
    entries, h = np.stack([tangents[0]] * (n - 1) + [tangents[1]]), time[-1] - time[-2]
    after, used, moved = [], 0.0, np.zeros(4)
    for part, state, (K, D) in zip(parts, before, _films(parts, entries), strict=True):
        places, k, lever, known = list(part.places), len(part.places), part.lever(length), slice(n - 1, n)
        kept, new, _ = terms = _terms(part, time, K, D, motion, lag, load, known)
        after.append(_errors(n, known, terms, state)[2])
        M, mean = _masses(part, load)[-1], 0.5 * (D[-1] + D[-2])
        mobility, *at_ends = lever * np.linalg.pinv(np.stack([mean, *D[-2:]]), rcond=1e-9)
        loads = math.sqrt(3.0) * _spread(part, time, load)[-1], h * load.force[-1, places]
        moved[1:3] += [max(float(np.linalg.norm(inverse @ impulse)) for inverse in at_ends) for impulse in loads]
        memory = np.abs(np.linalg.eigvals(kept[-1])).max()
        # time in which the rate of an error decays
        m, d, s = (float(np.linalg.norm(matrix)) for matrix in (M, mean, K[-1]))
        lasting = min(m / d if d > 0.0 else math.inf, math.sqrt(m / s) if s > 0.0 else math.inf) if m > 0.0 else 0.0
        size = np.sum(state[0].reshape(2, k) ** 2, axis=1) + np.diag(state[1:]).reshape(2, k).sum(axis=1)
        moved[3] += lever * math.sqrt(float(size[0]))
        left = largest - lever * math.sqrt(float(size[0] + lasting**2 * size[1]))
        allowed = max((1.0 - memory) * largest, BUDGET * max(left, BUDGET * largest))
        # accelerations under constraints alternate: of two successive momenta with equal signs the smaller one counts
        a, b = _momenta(part, time, load)[-2:]
        steady = np.where(a * b > 0.0, np.sign(b) * np.minimum(np.abs(a), np.abs(b)), 0.0)
        own = lever * (missed - lag)[-1, places] + mobility @ steady
        if math.isfinite(load.offset[-1, 0]):
            own = lever * new[-1, :k] + mobility @ M @ new[-1, k:]
            moved[0] += max(float(np.linalg.norm(lever * new[-1, :k])), float(np.linalg.norm(own)))
        used += float(np.linalg.norm(own)) / allowed
    return after, used, np.nan_to_num(moved)


def _films(parts: tuple[MotionPart, ...], entries: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Stiffness and damping (n, k, k) of the film in all parts, from `recorded_entries` (n, m) of its tangents."""
    sizes = [len(part.rows) for part in parts]
    blocks = np.split(-entries, np.cumsum([2 * k * k for k in sizes]), axis=1)
    whole = [block.reshape(-1, 2, k, k) for k, block in zip(sizes, blocks, strict=False)]
    return [(block[:, 0], block[:, 1]) for block in whole]


def _bend(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Second divided difference (n, k) of the last three states."""
    out, h = np.zeros_like(values), np.diff(time)[:, None]
    slopes = np.diff(values, axis=0) / h
    out[2:] = np.diff(slopes, axis=0) / (h[1:] + h[:-1])
    return out


def missed_in_steps(time: np.ndarray, pose: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Change of a pose (n, k) in every step, minus the integral of its rate (n, k) by parabolas."""
    h = np.diff(time)[:, None]
    out = _bend(time, rate)
    out[1:] = np.diff(pose, axis=0) - 0.5 * h * (rate[1:] + rate[:-1]) + out[1:] * h**3 / 6.0
    return out


def _lag(time: np.ndarray, deflection: np.ndarray | None) -> np.ndarray:
    """Return the error of the pose (n, 4) by a liner's difference quotient in every step."""
    out = np.zeros((time.size, 4))
    if deflection is None:
        return out
    h = np.diff(time, prepend=time[0])[:, None]
    size = np.hypot(*deflection.T)
    turned = np.sum(deflection[1:] * deflection[:-1], axis=1) < JUMP * size[1:] * size[:-1]
    jumps = np.concatenate(([True], turned))
    jumps[1:] |= jumps[:-1]
    out[:, :2] = np.where(jumps[:, None], 0.0, _bend(time, deflection) * h**2)
    return out


def departure(time: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Deviation of a load (n, k) at every state from the line through the two states before; zero at the first two."""
    change, steps, off = np.diff(load, axis=0), np.diff(time)[:, None], np.zeros_like(load)
    off[2:] = np.nan_to_num(change[1:] - change[:-1] * (steps[1:] / steps[:-1]))
    return off


def _sudden(time: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Jump of a load (n, k) in every step; zero in steps without a jump."""
    steps, off = np.diff(time, prepend=time[0]), departure(time, load)
    back, ratio = np.zeros(time.size, dtype=bool), steps[2:, None] / steps[1:-1, None]
    # after a jump, the deviation from the line before the jump, if it is smaller
    jumps, jump, onward = _outgrown(steps, off)[2:-1], off[2:-1].copy(), off[2:-1] * ratio[1:] + off[3:]
    smaller = jumps & (np.sum(onward * onward, axis=1) < np.sum(off[3:] * off[3:], axis=1))
    off[3:] = np.where(smaller[:, None], onward, off[3:])
    back[3:] = smaller & (np.sum(onward * jump, axis=1) < -SUDDEN * np.sum(jump * jump, axis=1))
    return np.where((back | _outgrown(steps, off))[:, None], off, 0.0)


def _outgrown(steps: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Return for each step (n,) whether the load's deviation (n, k), times the step, has grown suddenly, `SUDDEN`."""
    size = steps * np.sqrt(np.sum(off * off, axis=1))
    # the first known deviation cannot be compared with an earlier one
    earlier = np.concatenate([np.full(3, np.inf), size[2:-1]])[: size.size]
    return earlier < SUDDEN * size


def _spread(part: MotionPart, time: np.ndarray, load: FilmLoad) -> np.ndarray:
    """Standard deviation (n, k) of the impulse of a part's load jumps with an unknown time."""
    share = np.diff(time, prepend=time[0])[:, None] / math.sqrt(12.0)
    return np.where(np.isfinite(load.offset), 0.0, _sudden(time, load.force[:, part.places])) * share


def _steps(K: np.ndarray, D: np.ndarray, M: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Maps (n, 2 k, 2 k) from error and momentum before a step to error and rate after it; 0 if nothing resists."""
    h, k = GAMMA * step[:, None, None], K.shape[1]
    S = M + h * (D + h * K)
    stiff = resists(S)
    rate = np.linalg.inv(np.where(stiff, S, np.eye(k))) * stiff
    once = np.block([[np.eye(k) * stiff - h * h * (rate @ K), h * rate], [-h * (rate @ K), rate]])
    return extrapolated(once, np.concatenate([once[:, :, :k], once[:, :, k:] @ M], axis=2) @ once)


def _momenta(part: MotionPart, time: np.ndarray, load: FilmLoad) -> np.ndarray:
    """Local errors (n, k) of a part's momentum in every step."""
    momentum, demanded = (np.nan_to_num(values[:, part.places]) for values in (load.momentum, load.demanded))
    return momentum + _bend(time, demanded) * np.diff(time, prepend=time[0])[:, None] ** 3 / 6.0


def _masses(part: MotionPart, load: FilmLoad) -> np.ndarray:
    """Masses (n, k, k) of a part."""
    k, upper, place = len(part.rows), np.triu_indices(len(part.rows)), 3 * (part.places[0] // 2)
    M = np.zeros((len(load.mass), k, k))
    mass = np.nan_to_num(load.mass[:, place : place + upper[0].size])
    M[:, upper[0], upper[1]] = M[:, upper[1], upper[0]] = mass
    # moments Mx and My turn the axis to -y and to x
    return M @ np.array([[0.0, -1.0], [1.0, 0.0]]) if part.rows[0] else M


def _terms(
    part: MotionPart,
    time: np.ndarray,
    K: np.ndarray,
    D: np.ndarray,
    motion: np.ndarray,
    lag: np.ndarray,
    load: FilmLoad,
    known: slice,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return terms of the recursion of a part's errors for ``known`` steps.

    These are the propagation (m, 2 k, 2 k), the new errors (m, 2 k) and their standard deviation (m, 2 k).
    """
    places, k = np.array(part.places), len(part.places)
    pose, rate, lag = motion[:, places], motion[:, 4 + places], lag[:, places]
    steps, M, outer = np.diff(time, prepend=time[0]), _masses(part, load), load.force[:, places]
    K, D = np.nan_to_num(K), np.nan_to_num(D)
    mean = 0.5 * (D + np.concatenate([D[:1], D[:-1]]))
    kept = _steps(K[known], D[known], M[known], steps[known])
    added = _steps(K[known], mean[known], M[known], 0.5 * steps[known])
    kept[:, :, k:] = kept[:, :, k:] @ M[known]
    missed = np.concatenate([missed_in_steps(time, pose, rate) - lag, _momenta(part, time, load)], axis=1)
    new = (added @ missed[known, :, None])[:, :, 0]
    jumps = np.isfinite(load.offset[:, 0] * outer[:, 0])
    jumps[1:] &= np.isfinite(outer[:-1, 0])
    ends = np.flatnonzero(jumps[known]) + known.start
    if ends.size:
        both = np.stack([ends - 1, ends])
        beyond, lasting = load.offset[ends] * departure(time, outer)[ends], load.lasting[ends, 0]
        demanded, h = load.demanded[:, places][both], steps[ends, None]
        # inertia of second order in the rates, as in a rotating frame: the rest of the rate's change
        change = (M[ends] @ (rate[ends] - rate[ends - 1])[:, :, None])[:, :, 0] - load.momentum[:, places][ends]
        films = K[both], D[both], M[ends], demanded - outer[both]
        loads = outer[both] + change / h - demanded.mean(axis=0), beyond, lasting
        jumped = errors_of_jumps(steps[ends], *films, *loads, pose[both], rate[both])
        jumped[:, :k] -= lag[ends]
        new[ends - known.start] = jumped
    return kept, new, (added[:, :, k:] @ _spread(part, time, load)[known, :, None])[:, :, 0]


def _errors(
    count: int, known: slice, terms: tuple[np.ndarray, np.ndarray, np.ndarray], before: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return errors (n, k), traces (n,) of their variances, and the last error, rate and variance (1 + 2 k, 2 k)."""
    kept, new, wide = terms
    k = new.shape[1] // 2
    errors, variances, x, P = np.zeros((count, k)), np.zeros(count), before[0], before[1:]
    varies = bool(P.any() or wide.any())
    for i, (A, b, c) in enumerate(zip(kept, new, wide, strict=True), known.start):
        x = A @ x + b
        errors[i] = x[:k]
        if varies:
            P = A @ P @ A.T + np.outer(c, c)
            variances[i] = np.trace(P[:k, :k])
    return errors, variances, np.concatenate([x[None], P])


def enough_steps(time: np.ndarray, omega: np.ndarray, error: np.ndarray, count: np.ndarray | None = None) -> str:
    """Return, in words, the number of equal steps with an error of `GOAL`: errors fall at least as the step squared.

    Parameters
    ----------
    time, omega, error : (n,) arrays
        Times, s, relative spin, rad/s, and estimated errors, of which at least one is finite.
    count : (n,) int array, optional
        Number of each step, if the arrays do not contain all steps.
    """
    worst = int(np.nanargmax(error))
    count = np.arange(time.size) if count is None else count
    near = slice(max(0, worst - 3), worst + 1)
    step = float((np.diff(time[near]) / np.diff(count[near])).max())
    needed = float(time[-1] - time[0]) / step * math.sqrt(max(1.0, float(error[worst]) / GOAL))
    turns = abs(float(np.trapezoid(omega, time))) / (2.0 * math.pi)
    whole = f"{_rounded(needed)} steps in all"
    return whole if turns < 1.0 else f"{_rounded(needed / turns)} steps per turn of the journal"


def _rounded(number: float) -> int:
    """Return the number rounded up to two significant digits."""
    unit = 10 ** max(0, math.floor(math.log10(max(number, 1.0))) - 1)
    return unit * math.ceil(number / unit - 1e-9)
