"""Rates of a step that agree with its positions.

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
"""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
from numba import njit

from exudyn_ehd.joint.solved_film import MOTION_SIZE

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
        Pose, velocities and bore; (11,) for a ball, see `exudyn_ehd.joint.spherical.film`.
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
