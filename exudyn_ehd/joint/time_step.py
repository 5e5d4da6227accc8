"""One time step of a film: rates that agree with its positions, and its error by a load that jumps within it.

Rates that agree with positions
-------------------------------
A film is squeezed by the rates v of its pose p (the journal's axis in the housing's frame, and the coordinates of a
flexible bore). Exudyn couples coordinates and velocities by Newmark's formulas. But displacements of joint points on
turning bodies differ from the trapezoidal integral of their velocities by some r (omega h)^3 / 12 in each step. If the
film used the velocities at the end of a step, the journal would drift by this difference: by a film thickness per turn
with steps of some degrees. The error of the velocities in a step h is known after the step,

    d = (p1 - p0) / h - (v0 + v1) / 2.

It grows with h^2 and hardly changes from step to step. The rates of a step are its velocities plus the error that is
extrapolated from the last three steps, with the errors d_1 (the last one), d_2 and d_3,

    rate = v1 + (3 d_1 + d_2 - 2 d_3) / 2,

each d_k times (h / h_k)^2. With equal steps, the sum of these rates equals the sum of velocities and errors, except for
the errors of the last steps, since the weights telescope. For smooth motions they are the rate of the pose to second
order.

The weights are a linear extrapolation over two steps, from the middle of d_1, d_2 to the end of the step, and give 0
for alternating errors. With linear kinematics d is h (beta - gamma / 2) (a1 - a0) of Newmark's formulas. Weights that
are not 0 for alternating errors, such as 5/2 and -3/2 of the last two, make stiff films alternate at spectral radii
below 0.4. The weights used here keep every mode within the unit circle at any spectral radius, and damp alternating
rates like velocities alone: for all closures, with the films' memory, in each step at least by the spectral radius.
They need no parameter of the integrator. It must use a rule of second order for the coordinates and the film at the end
of the step, as Exudyn's implicit solvers of second order do.

Errors that would move a journal by less than a millionth of its clearance in a step are omitted: nodes on Lie groups
have a round-off of rotations of some 1e-11 rad per step, which over short steps would be a wrong rate.

The rates differ from the velocities by numbers that are known before the step. So tangents do not change, and the
round-off of positions over h does not disturb Newton's method. It would in formulas with the present d, such as
``(p1 - p0) / h + (1 - g) (v1 - v0)``, and the more so, the more a step is halved.

Error of a step within which the load on a film jumps
-----------------------------------------------------
To estimate it, the step is integrated again in small parts, with a film force interpolated between its ends.

After a jump of the load the film differs: its rupture line moves with the direction of the squeeze, and its damping
falls as the journal lifts. At both ends of the step the forces F0 and F1, the stiffness K = -dF/dp and the damping
D = -dF/dv are known. With the fraction s of the path from the pose and rate (p0, v0) to (p1, v1) the force is

    F = (1 - s) F0(p, v) + s F1(p, v) + s (1 - s) ((1 - s) g1 - s g0 - (1 - 2 s) (F1 - F0)),

with Fi(p, v) = Fi - Ki (p - pi) - Di (v - vi) and gi = -Ki (p1 - p0) - Di (v1 - v0). On the straight path between the
ends this is Hermite's cubic. s is the projection of (p, 2 h v) on this path, see `RATE_LEVER`.

The motion M dv/dt = F + L(t), dp/dt = v starts from (p0, v0). The load L changes from L0 to L1 linearly within a part
of the step, or at once. The time of this change is such that L has the known mean; if no time within the step gives
this mean, the difference is added to L0 and L1. The error of the step is (p1, v1) minus the end of this motion. No film
is evaluated.
"""

from __future__ import annotations

import dataclasses
import functools
import math

import numpy as np
from numba import njit

from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.status import SMALL

# Weights of the velocities' errors in the last steps, the last one first, by the number of known errors.
WEIGHTS = tuple(np.array(w) for w in ((), (1.0,), (0.5, 0.5), (1.5, 0.5, -1.0)))
# Displacement by the velocities' errors in a step, over the clearance, below which they are omitted: smaller ones
# change no film and may be round-off of positions. Larger: more drift.
SMALLEST_MISS = 1e-6
# Largest ratio of a step to the previous one for which errors are extrapolated; Exudyn doubles steps.
LARGEST_GROWTH = 4.0


@dataclasses.dataclass(frozen=True, eq=False)
class StepStart:
    """Start of a step.

    Attributes
    ----------
    time : float
        s.
    motion : (10 + 2 k,) array
        Pose, velocities and bore; (11,) for a ball, see `exudyn_ehd.joint.spherical.model`.
    step : float
        Length of the step before, s; 0 if there was none.
    misses : (n, 4 + k) array
        Errors of the velocities in up to three last steps, the last one first, over the square of the step.
    clearance : float
        Radial clearance, m.
    """

    time: float
    motion: np.ndarray
    step: float
    misses: np.ndarray
    clearance: float

    @functools.cached_property
    def _expected(self) -> np.ndarray:
        return np.asarray(WEIGHTS[len(self.misses)] @ self.misses)

    @functools.cached_property
    def _largest(self) -> float:
        """Largest expected error of the positions: two of a journal, three of a ball (whose motion has an odd size)."""
        return max(map(abs, self._expected[: 2 + self.motion.size % 2].tolist()))

    def film_motion(self, motion: np.ndarray, time: float) -> np.ndarray:
        """Return the motion (10 + 2 k,) at the end of the step, with the rates for the film."""
        step, known = time - self.time, len(self.misses)
        if known == 0 or step > LARGEST_GROWTH * self.step:
            return motion
        if step * step * step * self._largest < SMALLEST_MISS * self.clearance:
            return motion
        out = motion.copy()
        _add_rates(self._expected, step * step, out)
        return out


@njit(cache=True)
def _add_rates(expected, factor, motion_out):
    """Add the expected errors (4 + k,), times a factor, to the rates of a motion (10 + 2 k,)."""
    size = expected.size
    for j in range(size):
        motion_out[4 + j if j < 4 else 2 + size + j] += factor * expected[j]


@njit(cache=True)
def _misses(motion, old, step, known, misses_out):
    """Write the error of the velocities in the step from ``old`` to ``motion``, then the ``known`` earlier errors."""
    size = misses_out.shape[1]
    for j in range(size):
        place, rate = (j, 4 + j) if j < 4 else (6 + j, 2 + size + j)
        slope, mean = (motion[place] - old[place]) / step, 0.5 * (motion[rate] + old[rate])
        misses_out[0, j] = (slope - mean) / (step * step)
        for k in range(known.shape[0]):
            misses_out[1 + k, j] = known[k, j]


def next_start(before: StepStart | None, motion: np.ndarray, time: float, clearance: float) -> StepStart:
    """Return the start of the step after an accepted state.

    Parameters
    ----------
    before : StepStart or None
        Start of the previous step, or of another one that begins at this state.
    motion : (10 + 2 k,) array
        Motion at the state, with the velocities.
    time : float
        Time of the state, s.
    clearance : float
        Radial clearance, m.
    """
    k = (motion.size - MOTION_SIZE) // 2
    if before is None or before.time > time:
        return StepStart(time, motion, 0.0, np.empty((0, 4 + k)), clearance)
    if before.time == time:
        return dataclasses.replace(before, motion=motion)
    step, old = time - before.time, before.motion
    known = before.misses[:2] if step <= LARGEST_GROWTH * before.step else before.misses[:0]
    misses = np.empty((1 + len(known), 4 + k))
    _misses(motion, old, step, known, misses)
    return StepStart(time, motion, step, misses, clearance)


# Fraction of a step in each of two stages of backward Euler, whose extrapolation is then of second order.
GAMMA = 1.0 - math.sqrt(0.5)
# Time, over the step, by which rates are multiplied to measure the path of poses and rates. Measured on 332 errors
# above 2 % by random jumps (seeds below 4130 of `tests/mechanisms/test_load_jumps.py`): estimate over error 0.69 to
# 1.7; without iterations for s 0.59 to 1.9 at values from 1.4 to 4. Smaller values miss how the rupture line moves with
# the rate (0.25: 0.29 to 2.8), larger ones how the journal lifts (16: 0.72 to 2.3).
RATE_LEVER = 2.0
# Number of parts before, during and after the change of the load, each. Larger: slower. Estimate over error without
# iterations for s: 0.50 to 2.1 with 4 parts, 0.66 to 1.7 with 8, 0.69 to 1.7 with 32.
PARTS = 8
# Iterations for s in a stage. With one, a jump that turns the force of the film within a part of the step is missed.
# With 1, 2 and 3 the logarithm of estimate over error has a standard deviation of 0.084, 0.073 and 0.072 (the same
# errors).
ITERATIONS = 3
# Determinant of a matrix whose largest entry is scaled to 1, above which it resists motion in all directions.
RESISTS = 1e-12


def errors_of_jumps(
    step: np.ndarray,
    K: np.ndarray,
    D: np.ndarray,
    M: np.ndarray,
    force: np.ndarray,
    load: np.ndarray,
    beyond: np.ndarray,
    lasting: np.ndarray,
    pose: np.ndarray,
    rate: np.ndarray,
) -> np.ndarray:
    """Errors of pose and rate (n, 2 k) by steps with a jump of the load; zero where nothing resists the motion.

    Parameters
    ----------
    step : (n,) array
        s.
    K, D : (2, n, k, k) arrays
        Stiffness and damping of the film at both ends.
    M : (n, k, k) array
        Mass.
    force, load : (2, n, k) arrays
        Force of the film, and load on it, at both ends.
    beyond : (n, k) array
        Mean load within the step less the mean of its ends.
    lasting : (n,) array
        Fraction of the step in which the load changes.
    pose, rate : (2, n, k) arrays
        Pose and rate at both ends.
    """
    h, change = step[:, None], load[1] - load[0]
    square = np.sum(change * change, axis=1)
    share = 0.5 - np.sum(beyond * change, axis=1) / np.where(square > 0.0, square, 1.0)
    # no part of the step may vanish: without mass its matrix would be singular
    share = np.clip(share, 1.5 * SMALL, 1.0 - 1.5 * SMALL)[:, None]
    changing = np.clip(lasting[:, None], SMALL, 2.0 * np.minimum(share, 1.0 - share) - 2.0 * SMALL)
    before, after = load + beyond - (0.5 - share) * change
    lever = np.square(RATE_LEVER * h)
    way = np.concatenate([pose[1] - pose[0], lever * (rate[1] - rate[0])], axis=1)
    length = np.sum(way[:, : pose.shape[2]] ** 2 + way[:, pose.shape[2] :] ** 2 / lever, axis=1)
    bend = [-_times(K[i], pose[1] - pose[0]) - _times(D[i], rate[1] - rate[0]) for i in (0, 1)]
    constant = [force[i] + _times(K[i], pose[i]) + _times(D[i], rate[i]) for i in (0, 1)]
    stiff = np.asarray(resists(M + h[:, :, None] * (D + h[:, :, None] * K)).all(axis=0))
    idle = np.where(stiff, 0.0, np.eye(pose.shape[2]))

    def stage(p: np.ndarray, v: np.ndarray, h: np.ndarray, outer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """One stage of backward Euler, in which s is found by iteration."""
        end, rate_of_end = p, v
        for _ in range(ITERATIONS):
            gone = np.sum(np.concatenate([end - pose[0], rate_of_end - rate[0]], axis=1) * way, axis=1)
            s = np.clip(gone / np.where(length > 0.0, length, 1.0), 0.0, 1.0)[:, None]
            t, w = h[:, :, None], s[:, :, None]
            k, d = (1.0 - w) * K[0] + w * K[1], (1.0 - w) * D[0] + w * D[1]
            cubic = (1.0 - s) * bend[1] - s * bend[0] - (1.0 - 2.0 * s) * (force[1] - force[0])
            film = (1.0 - s) * constant[0] + s * constant[1] + s * (1.0 - s) * cubic - _times(k, p)
            right = _times(M, v) + h * (film + outer)
            rate_of_end = np.linalg.solve(M + t * (d + t * k) + idle, right[:, :, None])[:, :, 0]
            end = p + h * rate_of_end
        return end, rate_of_end

    p, v = pose[0], rate[0]
    shares = share - 0.5 * changing, changing, 1.0 - share - 0.5 * changing
    for part, start, way_of_load in zip(shares, (before, before, after), (0.0, change, 0.0), strict=True):
        tau = part * h / PARTS
        for i in range(PARTS):
            once = stage(p, v, GAMMA * tau, start + (i + GAMMA) / PARTS * way_of_load)
            twice = stage(*once, GAMMA * tau, start + (i + 2.0 * GAMMA) / PARTS * way_of_load)
            p, v = (extrapolated(a, b) for a, b in zip(once, twice, strict=True))
    return np.where(stiff[:, 0], np.concatenate([pose[1] - p, rate[1] - v], axis=1), 0.0)


def extrapolated(once: np.ndarray, twice: np.ndarray) -> np.ndarray:
    """Result of second order from the results after one stage and after both."""
    return (1.0 + math.sqrt(2.0)) * twice - math.sqrt(2.0) * once


def resists(matrix: np.ndarray) -> np.ndarray:
    """Return whether matrices (..., k, k) resist motion in all directions (..., 1, 1)."""
    scale = np.abs(matrix).max(axis=(-2, -1), keepdims=True)
    return (np.abs(np.linalg.det(matrix / np.where(scale > 0.0, scale, 1.0))) > RESISTS)[..., None, None]


def _times(matrix: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Products of matrices (n, k, k) and vectors (n, k)."""
    return (matrix @ vector[:, :, None])[:, :, 0]


def part_that_closes(share: float, before: np.ndarray, after: np.ndarray, clearance: float, length: float) -> float:
    """Part of a step between two motions that closes a share of the smallest gap of rigid surfaces; at most 1.

    The ends of the journal's axis are at p and move by d, and the smallest gap is g = c - max |p|. The part is the
    largest s with ``|p + s d| <= c - (1 - share) g`` at both ends.
    """
    (x, y, bx, by), (to_x, to_y, to_bx, to_by), part = before[:4].tolist(), after[:4].tolist(), 1.0
    ends = [(x + z * bx, y + z * by, to_x + z * to_bx, to_y + z * to_by) for z in (-0.5 * length, 0.5 * length)]
    farthest = clearance - (1.0 - share) * (clearance - max(math.hypot(px, py) for px, py, _, _ in ends))
    for px, py, to_px, to_py in ends:
        dx, dy = to_px - px, to_py - py
        along, square, rest = px * dx + py * dy, dx * dx + dy * dy, farthest**2 - px * px - py * py
        # the comparison is False for numbers that are not finite; a gap that is closed limits nothing
        if 2.0 * along + square > rest >= 0.0:
            part = min(part, (math.sqrt(along * along + square * rest) - along) / square)
    return part
