"""Rates of a step that agree with its positions.

A film is squeezed by the rates v of its pose p (the journal's axis in the housing's frame, and the coordinates of a
flexible bore). Exudyn ties coordinates and velocities by Newmark's formulas, but joint points of turning bodies leave
the trapezoid of their velocities by some r (omega h)^3 / 12 a step: a film that takes the velocities at the end of a
step as they are lets the journal drift by that, a film's thickness within a turn at steps of some degrees. What the
velocities miss in a step h is known behind it,

    d = (p1 - p0) / h - (v0 + v1) / 2,

grows with h^2 and hardly changes from step to step. The rates of a step are its velocities and what the last three
steps, of misses d_1 (the last one), d_2 and d_3, lead to expect at its end,

    rate = v1 + (3 d_1 + d_2 - 2 d_3) / 2,

each d_k times (h / h_k)^2. At steps of one size they add up to what the velocities do and the misses, except for those
of the last steps: rates and pose differ by what telescopes. Of smooth motions they are the pose's own rate to second
order.

The weights are those that go on in a line for two steps, from the middle of d_1, d_2 to the end of the step, and do not
see misses that alternate. With linear kinematics d is h (beta - gamma / 2) (a1 - a0) of Newmark's formulas; fed back by
weights that see its alternation, as 5/2 and -3/2 of the last two, it throws stiff films into alternation at spectral
radii below 0.4. These keep every mode within the unit circle at any spectral radius, and damp alternating rates as
velocities alone do: on films of every closure, with what they remember, each step at least by the spectral radius. They
ask for no parameter of the integrator: it takes a rule of second order for the coordinates, and the film at the end of
the step, as Exudyn's implicit solvers of second order have.

Misses by which a journal would move less than a millionth of its clearance in a step are left out: nodes on Lie groups
round rotations to some 1e-11 rad a step, which over short steps is no rate.

The rates differ from the velocities by what is known before the step, so that tangents stay as they are, and the
rounding of positions over h is no noise to Newton's method. It is in forms with the present d, such as those of
``(p1 - p0) / h + (1 - g) (v1 - v0)``; where they halve a step it grows.
"""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
from numba import njit

from exudyn_ehd.joint.solved_film import MOTION_SIZE

# Weights of the velocities' errors in the last steps, the last one first, by the number of known errors.
WEIGHTS = tuple(np.array(w) for w in ((), (1.0,), (0.5, 0.5), (1.5, 0.5, -1.0)))
# Displacement by misses in a step, share of the clearance: less changes no film, and may be rounding of positions.
SMALLEST_MISS = 1e-6
# Growth from step to step beyond which nothing is expected; Exudyn doubles steps.
LARGEST_GROWTH = 4.0


@dataclasses.dataclass(frozen=True, eq=False)
class StepStart:
    """Start of a step.

    Attributes
    ----------
    time : float
        s.
    motion : (10 + 2 k,) array
        Pose, velocities and bore; (11,) of a ball, see `exudyn_ehd.joint.spherical.film`.
    step : float
        Length of the step before, s; 0 if there was none.
    misses : (n, 4 + k) array
        Error of the velocities in up to three last steps, the last one first, over the square of the step.
    clearance : float
        m.
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
        """Largest expected error of the places: two of a journal (without tilts), three of a ball (odd motion)."""
        return max(map(abs, self._expected[: 2 + self.motion.size % 2].tolist()))

    def film_motion(self, motion: np.ndarray, time: float) -> np.ndarray:
        """Motion (10 + 2 k,) as given for the end of the step, with the rates that the film takes."""
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
    """Add what is expected (4 + k,), times a factor, to the rates of a motion (10 + 2 k,)."""
    size = expected.size
    for j in range(size):
        motion_out[4 + j if j < 4 else 2 + size + j] += factor * expected[j]


@njit(cache=True)
def _misses(motion, old, step, known, misses_out):
    """Write the error of the velocities in a step between two motions (10 + 2 k,), then the ``known`` earlier ones."""
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
        Start of the step before it, or of another one that begins here.
    motion : (10 + 2 k,) array
        Motion at the state, with the velocities.
    time : float
        s.
    clearance : float
        m.
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
