"""What the steps of a run miss in the gap, from the accepted steps alone.

A film has no inertia: in balance with its load it gives the journal's pose a rate, dp/dt = f(p, t), and a time
integration has to add these rates up. The rates r that the film was told in the last three states tell what a step h
has missed: its displacement less the integral of the parabola through them,

    l = p1 - p0 - (r0 + r1) h / 2 + [r_1, r0, r1] h^3 / 6

with the second divided difference in brackets; the error of the parabola is one order smaller. A film forgets errors e
of its pose as its damping D = -dF/dr and stiffness K = -dF/dp let it, D de/dt + K e = 0 under the same load:

    e1 = (D + h K)^-1 D (e0 + l),

translations and tilts each by themselves (of a ball three translations), with the D and K of Newton's last iteration.
No film is solved for it. The error of the gap is |e| at the end of the journal where it is larger. A liner's deflection
w goes into the film by its difference quotient, of first order: dw/dt of the parabola through the last three states
less (w1 - w0) / h, times h, is a step's further error, along the direction of the peak, unless the peak jumps.

A load L on the film that jumps makes the rate jump by D^-1 dL. The steps take it to happen in the middle of the one in
which it lies: each u h off, with u within -1/2 and 1/2, makes an error of the pose of u h D^-1 dL, however smooth the
rates are that inertia lets follow. No accepted state tells u. So jumps add a variance

    P1 = A (P0 + h^2 / 12 q q^T) A^T,   A = (D + h K)^-1 D,   q = D^-1 dL,

that of a u anywhere in the step, and the error of the gap is the root of |e|^2 and the trace of P. Of a jump it tells
0.58 |e| and more; up to 2.5 times the error where the jump lies more than 0.12 h off the middle. At the first state
behind a jump near the end of its step the error may be twice that: the whole step took the new load. L is known at
accepted states, from the bodies' accelerations and the film's force (`exudyn_ehd.coupling.element.outer_load`): dL is
what departs from the line through the two states before, if it does so at once. Behind a jump it is what departs from
the line before it, if that is less: so a pulse has two jumps. A pulse that begins and ends within a step leaves no
trace in any state, and no estimate. D is the mean of both ends of the step.

Left out: the first two steps, in which the rates still jump from what the model was given to what its films ask for;
errors of the motion of the bodies, which films do not feel at once (of two journals that weigh 30 and 113 times their
load, thrown by a jump, `StepControl` ends at 4 and 6 times the error asked for; at ten times their load and less it
keeps it); what the trapezoidal rule, which does not damp, lets ring on; and errors of what films remember (cavities,
heat, wear), which are of first order there: with `ElrodAdams` the estimate is some 0.4 to 0.9 of the error.
"""

from __future__ import annotations

import math

import numpy as np

# Entries of a tangent (6, 10), rows after each other: dF/dp, dF/dr of translations, and of tilts.
BLOCKS = np.array([[10 * i + j for i in (k, k + 1) for j in (m, m + 1)] for k, m in ((0, 0), (0, 4), (3, 2), (3, 6))])
# Rows of a tangent and places of the pose that go together.
JOURNAL, BALL = (([0, 1], [0, 1]), ([3, 4], [2, 3])), (([0, 1, 2], [0, 1, 2]),)
# Of a symmetric matrix what a ball's row keeps.
_UPPER = np.triu_indices(3)
# First state whose error is known.
FIRST = 3
# At the beginning of a record, see `errors_behind`.
NO_ERROR = np.zeros(10)
# Least gap against which errors count, share of the clearance.
SMALLEST_GAP_SHARE = 1e-3
# Cosine of the turn of a peak in a step beyond which it has jumped.
JUMP = 0.9
# A load has jumped in a step if its departure from a straight line, times the step, outgrows that of the step before:
# that one is less than this share of it. A larger share repeats steps of smooth loads, a smaller one misses jumps of
# loads that vary. Of 138 errors by random jumps 92, 92, 91 and 91 % are told at 0.5 to 2.5 of their size at 0.1, 0.2,
# 0.3 and 0.5. Steps of a spatial four-bar mechanism without jumps: none is repeated at 0.05 to 0.3, five at 0.5, which
# then takes 1.6 times the evaluations of films and has five times the error.
SUDDEN = 0.3
# What a step has missed over what it may miss, from which it is repeated.
REFUSED = 8.0
# What a step may miss of the error that is left, and of the largest one at least.
BUDGET, SMALLEST_BUDGET = 0.1, 0.01
# The error that the number of steps aims at, less than half of the one that is told: the first steps are not known.
GOAL = 0.02


def errors_behind(
    before: np.ndarray,
    time: np.ndarray,
    motion: np.ndarray,
    tangent: np.ndarray,
    minimum_gap: np.ndarray,
    clearance: float,
    length: float,
    deflection: np.ndarray | None,
    load: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Error (n,) of the gap over the minimum film thickness, of every accepted state, and ``before`` behind the last.

    The first `FIRST` states have nan, as those before the first tangent; a record in parts has the errors of the whole
    if every part begins with the last `FIRST` states of the one before.

    Parameters
    ----------
    before : (10,) array
        Error of the pose behind the first `FIRST` states (4,), and variances (xx, xy, yy) of places and of slopes; zero
        (`NO_ERROR`) at the beginning of a record.
    time : (n,) array
        s.
    motion : (n, 10) array
        With the rates that the film was told.
    tangent : (n, 4, 4) array
        `BLOCKS` of the tangents; nan where there was none: the last one counts.
    minimum_gap : (n,) array
        m.
    clearance, length : float
        m.
    deflection : (n, 2) array, optional
        Of a liner, where it is largest, m.
    load : (n, 4) array
        On the film, N and N m (rows of `JOURNAL`); nan where it is not known: no jump.
    """
    out = np.full(time.size, np.nan)
    last = np.maximum.accumulate(np.where(np.isfinite(tangent[:, 0, 0]), np.arange(time.size), -1))
    # rows before the first tangent know no error
    known = slice(max(FIRST, int(np.count_nonzero(last < 0))), None)
    if time.size <= FIRST or last[-1] < 0:
        return out, before
    missed = _missed(time, motion[:, :4], motion[:, 4:8])
    if deflection is not None:
        missed[:, :2] -= _lag(time, deflection)
    errors, variance = np.zeros((time.size, 4)), np.zeros((time.size, 2, 3))
    steps = np.diff(time, prepend=time[0])
    for k in (0, 2):
        K, D = -tangent[last, k], -tangent[last, k + 1]
        kept = _kept(K, D, steps)
        errors[known, k : k + 2] = _added(kept[known], missed[known, k : k + 2], before[k : k + 2])
        jumped = _jumped(D.reshape(-1, 2, 2), _sudden(time, load[:, k : k + 2]), steps)
        variance[known, k // 2] = _variances(kept[known], jumped[known], before[4 + 3 * (k // 2) :][:3])
    ends = [np.hypot(*(errors[:, :2] + s * 0.5 * length * errors[:, 2:]).T) for s in (-1.0, 1.0)]
    square = variance[:, 0, ::2].sum(axis=1) + (0.5 * length) ** 2 * variance[:, 1, ::2].sum(axis=1)
    whole = np.sqrt(np.maximum(*ends) ** 2 + square)
    out[known] = (whole / np.maximum(minimum_gap, SMALLEST_GAP_SHARE * clearance))[known]
    return out, np.concatenate([errors[-1], variance[-1].ravel()])


def pack_of_ball(tangent: np.ndarray) -> np.ndarray:
    """What a record keeps (15,) of a ball's tangent (3, >= 7) to place, 0 and velocity: K, and D's symmetric part."""
    damping = -tangent[:3, 4:7]
    return np.concatenate([-tangent[:3, :3].ravel(), (0.5 * (damping + damping.T))[_UPPER]])


def errors_of_ball(
    time: np.ndarray,
    place: np.ndarray,
    velocity: np.ndarray,
    packed: np.ndarray,
    minimum_gap: np.ndarray,
    clearance: float,
    load: np.ndarray,
) -> np.ndarray:
    """Error (n,) of a ball's place over the minimum film thickness, of every accepted state; see `errors_behind`.

    Parameters
    ----------
    time : (n,) array
        s.
    place, velocity : (n, 3) arrays
        m, and m/s as the film was told.
    packed : (n, 15) array
        `pack_of_ball` of the tangents; nan where there was none: the last one counts.
    minimum_gap : (n,) array
        m.
    clearance : float
        m.
    load : (n, 3) array
        On the ball, N; nan where it is not known.
    """
    out = np.full(time.size, np.nan)
    last = np.maximum.accumulate(np.where(np.isfinite(packed[:, 0]), np.arange(time.size), -1))
    first = max(FIRST, int(np.count_nonzero(last < 0)))
    if time.size <= first:
        return out
    missed, h = _missed(time, place, velocity), np.diff(time, prepend=time[0])
    K, D = packed[last, :9].reshape(-1, 3, 3), np.empty((time.size, 3, 3))
    D[:, _UPPER[0], _UPPER[1]] = D[:, _UPPER[1], _UPPER[0]] = packed[last, 9:]
    kept, error, variance = _kept_of_ball(K, D, h), np.zeros(3), np.zeros((3, 3))
    jumped = _jumped(D, _sudden(time, load), h)
    for k in range(first, time.size):
        error = kept[k] @ (error + missed[k])
        variance = kept[k] @ (variance + np.outer(jumped[k], jumped[k])) @ kept[k].T
        out[k] = np.sqrt(error @ error + np.trace(variance))
    return out / np.maximum(minimum_gap, SMALLEST_GAP_SHARE * clearance)


def next_error(
    time: np.ndarray,
    motion: np.ndarray,
    tangent: np.ndarray,
    before: np.ndarray,
    length: float,
    largest: float,
    deflection: np.ndarray | None = None,
    *,
    ball: bool = False,
) -> tuple[np.ndarray, float]:
    """Error of the pose behind a step, and what the step has missed over what it may miss.

    It may miss what the film forgets of the ``largest`` error in a step, or a tenth of what the error before leaves of
    it where that is more.

    Parameters
    ----------
    time : (3,) array
        Of the last three states, s.
    motion : (3, 10) array
        There, with the rates that the film was told.
    tangent : (6, 10) array
        Of the film's wrench.
    before : (4,) array
        Error of the pose at the start of the step.
    length, largest : float
        Of the bearing, and error of the gap that is allowed, m.
    deflection : (3, 2) array, optional
        Of a liner, where it is largest, m.
    ball : bool
        Whether the pose is a ball's place and a zero.

    Returns
    -------
    ndarray (4,), float
    """
    missed = _missed(time, motion[:, :4], motion[:, 4:8])[2]
    if deflection is not None:
        missed[:2] -= _lag(time, deflection)[2]
    after, used, h = np.zeros(4), 0.0, np.diff(time)[-1:]
    for rows, places in BALL if ball else JOURNAL:
        D, K = (-tangent[rows][:, np.add(places, shift)] for shift in (4, 0))
        kept = _kept_of_ball(K[None], D[None], h)[0] if ball else _kept(K.reshape(1, 4), D.reshape(1, 4), h)
        kept = kept.reshape(D.shape)
        after[places] = kept @ (before[places] + missed[places])
        lever = 1.0 if rows[0] == 0 else 0.5 * length
        forgotten = 1.0 - float(np.abs(np.linalg.eigvals(kept)).max())
        left = largest - lever * float(np.linalg.norm(before[places]))
        allowed = max(forgotten * largest, BUDGET * left, SMALLEST_BUDGET * largest)
        used += lever * float(np.linalg.norm(missed[places])) / allowed
    return after, used


def largest_jump_error(
    time: np.ndarray, load: np.ndarray, tangents: tuple[np.ndarray, np.ndarray], length: float, *, ball: bool
) -> float:
    """Error of the gap, m, of a jump at an end of the step to the last state: h |D^-1 dL| / 2.

    Parameters
    ----------
    time : (n,) array
        Of the last states, six to tell all pulses from ringing, s.
    load : (n, 4) array
        On the film, as for `errors_behind` or `errors_of_ball`.
    tangents : two (6, 10) arrays
        Of the film's wrench, at the start of the step and at its end.
    length : float
        Of the bearing, m.
    ball : bool
        Whether the pose is a ball's place and a zero.
    """
    out, mean = 0.0, -0.5 * (tangents[0] + tangents[1])
    for rows, places in BALL if ball else JOURNAL:
        jump = _sudden(time, load[:, places])[-1]
        if jump.any():
            rate = np.linalg.pinv(mean[rows][:, np.add(places, 4)], rcond=1e-9) @ jump
            out += (1.0 if rows[0] == 0 else 0.5 * length) * float(np.linalg.norm(rate))
    return 0.5 * float(time[-1] - time[-2]) * out


def _bend(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Second divided difference (n, k) of the last three states."""
    out, h = np.zeros_like(values), np.diff(time)[:, None]
    slopes = np.diff(values, axis=0) / h
    out[2:] = np.diff(slopes, axis=0) / (h[1:] + h[:-1])
    return out


def _missed(time: np.ndarray, pose: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """What every step misses (n, 4)."""
    h = np.diff(time)[:, None]
    out = _bend(time, rate)
    out[1:] = np.diff(pose, axis=0) - 0.5 * h * (rate[1:] + rate[:-1]) + out[1:] * h**3 / 6.0
    return out


def _lag(time: np.ndarray, deflection: np.ndarray) -> np.ndarray:
    """What a liner's difference quotient misses in every step (n, 2)."""
    h = np.diff(time, prepend=time[0])[:, None]
    size = np.hypot(*deflection.T)
    turned = np.sum(deflection[1:] * deflection[:-1], axis=1) < JUMP * size[1:] * size[:-1]
    jumps = np.concatenate(([True], turned))
    jumps[1:] |= jumps[:-1]
    return np.where(jumps[:, None], 0.0, _bend(time, deflection) * h**2)


def _sudden(time: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Jump of a load (n, k) in every step, zero where it goes on as before."""
    steps, change = np.diff(time, prepend=time[0]), np.diff(load, axis=0, prepend=load[:1])
    off, back = np.zeros_like(load), np.zeros(time.size, dtype=bool)
    ratio = steps[2:, None] / steps[1:-1, None]
    off[2:] = np.nan_to_num(change[2:] - change[1:-1] * ratio)
    # behind a jump, the departure from the line before it where that is smaller
    jumps, jump, onward = _outgrown(steps, off)[2:-1], off[2:-1].copy(), off[2:-1] * ratio[1:] + off[3:]
    smaller = jumps & (np.sum(onward * onward, axis=1) < np.sum(off[3:] * off[3:], axis=1))
    off[3:] = np.where(smaller[:, None], onward, off[3:])
    back[3:] = smaller & (np.sum(onward * jump, axis=1) < -SUDDEN * np.sum(jump * jump, axis=1))
    return np.where((back | _outgrown(steps, off))[:, None], off, 0.0)


def _outgrown(steps: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Steps (n,) whose departure (n, k) of the load, times the step, outgrows that of the step before."""
    size = steps * np.sqrt(np.sum(off * off, axis=1))
    # the first departure that is known has none to be compared with
    earlier = np.concatenate([np.full(3, np.inf), size[2:-1]])[: size.size]
    return earlier < SUDDEN * size


def _jumped(D: np.ndarray, load: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Standard deviation (n, k) of the displacement by jumps of a load (n, k) anywhere in a step, with its sign."""
    out, jumps = np.zeros_like(load), np.flatnonzero(load.any(axis=1))
    if jumps.size:
        mean = np.nan_to_num(0.5 * (D[jumps] + D[jumps - 1]))
        rate = np.linalg.pinv(mean, rcond=1e-9) @ load[jumps, :, None]
        out[jumps] = step[jumps, None] * rate[:, :, 0] / math.sqrt(12.0)
    return out


def _variances(kept: np.ndarray, jumped: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Variances (n, 3), xx, xy and yy: what is left of the one before and of the step's jump."""
    if not (jumped.any() or before.any()):
        return np.zeros((len(kept), 3))
    out, (xx, xy, yy) = [], before.tolist()
    for (a, b, c, d), (u, v) in zip(kept.tolist(), jumped.tolist(), strict=True):
        xx, xy, yy = xx + u * u, xy + u * v, yy + v * v
        left = a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy
        xx, xy, yy = left[0] * a + left[1] * b, left[0] * c + left[1] * d, left[2] * c + left[3] * d
        out.append((xx, xy, yy))
    return np.array(out).reshape(-1, 3)


def _kept(K: np.ndarray, D: np.ndarray, step: np.ndarray) -> np.ndarray:
    """(D + h K)^-1 D (n, 4) of matrices (n, 4), rows after each other; zero where the film resists nothing."""
    a, b, c, d = (D + step[:, None] * K).T
    p, q, r, s = D.T
    with np.errstate(divide="ignore", invalid="ignore"):
        out = np.stack((d * p - b * r, d * q - b * s, a * r - c * p, a * s - c * q)) / (a * d - b * c)
    return np.nan_to_num(out.T, nan=0.0, posinf=0.0, neginf=0.0)


def _kept_of_ball(K: np.ndarray, D: np.ndarray, step: np.ndarray) -> np.ndarray:
    """As `_kept`, of matrices (n, 3, 3)."""
    a, b, c = np.moveaxis(D + step[:, None, None] * K, 2, 0)
    turned = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        out = turned @ D / np.sum(a * turned[:, 0], axis=1)[:, None, None]
    return np.nan_to_num(out, nan=0.0, posinf=0.0, neginf=0.0)


def _added(kept: np.ndarray, missed: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Errors (n, 2), each what is left of the one before and of what the step has missed."""
    out, (x, y) = [], before.tolist()
    for (a, b, c, d), (u, v) in zip(kept.tolist(), missed.tolist(), strict=True):
        u, v = x + u, y + v
        x, y = a * u + b * v, c * u + d * v
        out.append((x, y))
    return np.array(out).reshape(-1, 2)


def enough_steps(time: np.ndarray, omega: np.ndarray, error: np.ndarray, count: np.ndarray | None = None) -> str:
    """Number of steps of equal size that would do, in words: errors fall with the square of the step at least.

    Parameters
    ----------
    time, omega, error : (n,) arrays
        s, relative spin (rad/s), estimated errors with one that is known.
    count : (n,) int array, optional
        Number of each step, where steps between them are not given.
    """
    worst = int(np.nanargmax(error))
    count = np.arange(time.size) if count is None else count
    near = slice(max(0, worst - 3), worst + 1)
    step = float((np.diff(time[near]) / np.diff(count[near])).max())
    needed = float(time[-1] - time[0]) / step * math.sqrt(max(1.0, float(error[worst]) / GOAL))
    turns = abs(float(np.trapezoid(omega, time))) / (2.0 * math.pi)
    if turns < 1.0:
        return f"{_rounded(needed)} steps in all"
    return f"{_rounded(needed / turns)} steps per turn of the journal"


def _rounded(number: float) -> int:
    """Up to two digits."""
    unit = 10 ** max(0, math.floor(math.log10(max(number, 1.0))) - 1)
    return unit * math.ceil(number / unit - 1e-9)
