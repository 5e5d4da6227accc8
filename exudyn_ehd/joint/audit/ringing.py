"""Forces that alternate from step to step.

Time integration that rings, recognised from the accepted steps of a joint
--------------------------------------------------------------------------
The deviation of a force is d_k = F_k - L_k, where L_k is the value at t_k of the line through the forces of the steps
k - 1 and k + 1. An alternation F = F_0 + (-1)^k A has d_k = 2 (-1)^k A. An oscillation with n steps per period has
d_k = (1 - cos(2 pi / n)) times its value. So d changes its sign from step to step only below some three steps per
period, and such oscillations are not resolved by the steps. A force *zigzags* at a step if d there points against d of
the steps before and after it, and is more than a tenth of the force.

Zigzags alone are no fault: after a sudden start generalized alpha damps the alternation within some steps. In a run
that rings, alternations are excited again and again: by halved steps, by Newton's method that accepts forces next to
the solution, by impacts within a single step. So *bursts* are counted. A burst is a zigzag stronger than those of the
five steps before it, or an alternation that does not fade, which counts once in `LASTING` zigzags.

Masses move by the mean of the force over the steps. By Newmark's formulas, and those of generalized alpha, positions
depend on ``F_k - d_k / 2``, which in equal steps is the mean with the weights (1, 2, 1) / 4. An alternation adds
nothing to this mean; it changes accelerations only. A force that is many times its mean *throws* the masses to and fro
within the steps. Oscillations with three or more steps per period, and a single impact, have a mean of at least a
fourth of the force.
"""

from __future__ import annotations

import math
import warnings
from collections import deque

import numpy as np

from exudyn_ehd.status import RingingWarning

# Least size of d in a zigzag: over the force there, and over the largest force before it, which counts less by this
# factor per step. Larger: weaker alternations are ignored.
LOCAL_SHARE, LARGEST_SHARE, FADING = 0.1, 0.01, 0.99
# Least component of the neighbouring d against d, over d. Larger: only even alternations count as zigzags.
EVEN = 0.3
# Mean pressure on the projected area, Pa, below which d is ignored as round-off next to an ideal joint.
NEGLIGIBLE = 100.0
# Limits of a burst: least strength over that of the five steps before; or least share of the last burst's strength
# after this many zigzags; least number of steps between two bursts. Larger values: fewer bursts are counted.
STRONGER, KEPT, LASTING, APART = 1.5, 0.75, 20, 5
# Number of steps in which bursts are counted together, and number of bursts in it from which on a run rings.
WINDOW, LIMIT = 100, 4
# Limits of a force that throws masses: least ratio to its mean, least pressure on the projected area in Pa, least share
# of the largest force; a run that rings ends at this number of such forces within the window.
PROPORTION, HEAVY, STRONG_SHARE, MOST_THROWS = 10.0, 1e6, 0.3, 20


class RingingWatch:
    """Counter of the bursts of one joint's force; it takes some microseconds per step.

    Parameters
    ----------
    area : float
        Projected area of the bearing, 2 R L, m2.

    Attributes
    ----------
    most : int
        Most bursts within `WINDOW` steps.
    first, last : float
        Times of the first and the last burst, s; nan without one.
    rings : bool
        True after `LIMIT` or more bursts lay in one window.
    worst : (float, float)
        Largest force that throws masses, and its mean, N.
    """

    def __init__(self, area: float) -> None:
        self.smallest, self.heavy = NEGLIGIBLE * area, HEAVY * area
        self.begin_anew()

    def begin_anew(self) -> None:
        """Forget all steps."""
        self.most, self.rings = 0, False
        self.first = self.last = math.nan
        # time and force of the last steps; the last eight d with their sizes
        self._states: deque[tuple[float, float, float, float]] = deque(maxlen=4)
        self._bends: deque[tuple[float, float, float, float]] = deque([(0.0, 0.0, 0.0, 0.0)] * 8, maxlen=8)
        self._bursts: deque[int] = deque()
        self._throws: deque[int] = deque([-WINDOW] * MOST_THROWS, maxlen=MOST_THROWS)
        self.worst = (0.0, 0.0)
        self._step = self._zigzags = 0
        self._largest = self._strength = 0.0

    def take(self, time: float, x: float, y: float, z: float = 0.0) -> bool:
        """Add an accepted step.

        Parameters
        ----------
        time : float
            s; a time that is not later than the previous one resets the counter.
        x, y, z : float
            Force, N; z of a ball.

        Returns
        -------
        bool
            True if this step is a burst and `LIMIT` or more bursts lie in the window.
        """
        states = self._states
        if states and not time > states[-1][0]:
            self.begin_anew()
            states = self._states
        states.append((time, x, y, z))
        self._step += 1
        self._largest = max(math.hypot(x, y, z), FADING * self._largest)
        if len(states) < 3:
            return False
        (t_2, x_2, y_2, z_2), (t_1, x_1, y_1, z_1) = states[-3], states[-2]
        share = (t_1 - t_2) / (time - t_2)
        dx, dy, dz = x_1 - x_2 - share * (x - x_2), y_1 - y_2 - share * (y - y_2), z_1 - z_2 - share * (z - z_2)
        self._bends.append((dx, dy, dz, math.hypot(dx, dy, dz)))
        force = math.hypot(x_1, y_1, z_1)
        if force > self.heavy and force > STRONG_SHARE * self._largest:
            mean = math.hypot(x_1 - 0.5 * dx, y_1 - 0.5 * dy, z_1 - 0.5 * dz)
            if force > PROPORTION * mean:
                self._throws.append(self._step)
                self.worst = max(self.worst, (force, mean))
        if not self._zigzag():
            return False
        self._zigzags += 1
        return self._is_burst() and self._count(t_1)

    def _zigzag(self) -> bool:
        (ax, ay, az, _), (bx, by, bz, b), (cx, cy, cz, _) = list(self._bends)[-3:]
        against = max(ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz)
        if not b > max(self.smallest, LARGEST_SHARE * self._largest) or against > -EVEN * b * b:
            return False
        force = sum(math.hypot(x, y, z) for _, x, y, z in list(self._states)[:3]) / 3.0
        return b > LOCAL_SHARE * force

    def _is_burst(self) -> bool:
        if self._bursts and self._step - self._bursts[-1] < APART:
            return False
        sizes = [bend[3] for bend in self._bends]
        strength = max(sizes[-3:])
        lasting = self._zigzags >= LASTING and strength > KEPT * self._strength
        if not (lasting or strength > STRONGER * max(sizes[:5])):
            return False
        self._strength = strength
        return True

    def _count(self, time: float) -> bool:
        bursts = self._bursts
        self._zigzags = 0
        bursts.append(self._step)
        while bursts[0] <= self._step - WINDOW:
            bursts.popleft()
        self.most = max(self.most, len(bursts))
        self.first = time if math.isnan(self.first) else self.first
        self.last = time
        self.rings = self.rings or len(bursts) >= LIMIT
        return len(bursts) >= LIMIT

    @property
    def throws(self) -> bool:
        """Return whether the run rings and `MOST_THROWS` forces within the window have thrown masses."""
        return self.rings and self._throws[0] > self._step - WINDOW


def watched(time: np.ndarray, force: np.ndarray, area: float) -> RingingWatch:
    """Watch after all steps of a record: times (n,) in s and forces (n, 2) or (n, 3) in N on an area in m2."""
    watch = RingingWatch(area)
    for t, parts in zip(time.tolist(), force.tolist(), strict=True):
        watch.take(t, *parts)
    return watch


def warn(name: str, watch: RingingWatch, *, starts_well: bool) -> None:
    """Warn that the run of the joint ``name`` rings.

    ``starts_well``: this package gives Newton's method its initial guess, so that `SolveDynamic` is not advised.
    """
    start = "" if starts_well else "use ehd.SolveDynamic(mbs, simulationSettings) in place of mbs.SolveDynamic, or "
    warnings.warn(
        f"LubricatedJoint '{name}': from t = {watch.first:.9g} s to {watch.last:.9g} s the film's force alternates "
        f"from step to step, thrown anew {watch.most} times within {WINDOW} steps: the time integration causes these "
        f"forces and pressures; {start}take more steps until none is halved, or a smaller spectral "
        "radius.",
        RingingWarning,
        stacklevel=2,
    )
