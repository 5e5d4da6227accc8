"""Forces that alternate from step to step.

Time integration that rings, recognised from the accepted steps of a joint
--------------------------------------------------------------------------
With d_k = F_k - L_k, where L_k is the value at t_k of the line through the forces before and behind, an alternation
F = F_0 + (-1)^k A has d_k = 2 (-1)^k A, and an oscillation with n steps per period d_k = (1 - cos(2 pi / n)) times its
value: d changes its sign from step to step below some three steps per period only, which no step resolves. A force
*zigzags* at a step if d there points against the d before and behind, and is more than a tenth of the force.

That alone is no fault: whatever starts suddenly leaves an alternation that generalized alpha damps within some steps.
A run that rings is thrown again and again: by steps that were halved, by Newton's method that accepts forces next to
the solution, by impacts within a single step. So *bursts* are counted: zigzags stronger than the five steps before,
and alternations that do not fade, once in so many steps.

What a force does to the masses around it, and what it carries of their loads, is its mean over the steps: under
Newmark's formulas, and those of generalized alpha, places follow ``F_k - d_k / 2``, the mean of (1, 2, 1) / 4 in equal
steps, to which an alternation adds nothing. The rest is between the film and accelerations that nothing follows. A
force that is many times that mean *throws* the masses to and fro within the steps: any oscillation of three and more
steps per period, and a single impact, leave a fourth of it or more.
"""

from __future__ import annotations

import math
import warnings
from collections import deque

import numpy as np

from exudyn_ehd.status import RingingWarning

# Size of a zigzag, share of the force there and of the largest one before, which fades by so much per step.
LOCAL_SHARE, LARGEST_SHARE, FADING = 0.1, 0.01, 0.99
# Share of a d by which those before and behind it point against it.
EVEN = 0.3
# Mean pressure on the projected area below which a force is none: rounding next to an ideal joint, Pa.
NEGLIGIBLE = 100.0
# A burst is so much stronger than the steps before, or has kept such a share of its size over so many zigzags; steps
# between two bursts.
STRONGER, KEPT, LASTING, APART = 1.5, 0.75, 20, 5
# Bursts within so many steps are counted together; a run rings from so many on.
WINDOW, LIMIT = 100, 4
# A force is out of all proportion if it is so many times its mean, presses by so many Pa on the projected area, and
# fades no faster than to this share of the largest one; a run that rings ends at so many of them within the window.
PROPORTION, HEAVY, STRONG_SHARE, MOST_THROWS = 10.0, 1e6, 0.3, 20


class RingingWatch:
    """Counts the bursts of one joint's force; some microseconds per step.

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
        Whether `LIMIT` or more bursts have lain in the window.
    worst : (float, float)
        The largest force out of all proportion, and its mean, N.
    """

    def __init__(self, area: float) -> None:
        self.smallest, self.heavy = NEGLIGIBLE * area, HEAVY * area
        self.begin_anew()

    def begin_anew(self) -> None:
        """Forget all steps."""
        self.most, self.rings = 0, False
        self.first = self.last = math.nan
        # time and force of the last steps; the last three d and five before, with their sizes
        self._states: deque[tuple[float, float, float, float]] = deque(maxlen=4)
        self._bends: deque[tuple[float, float, float, float]] = deque([(0.0, 0.0, 0.0, 0.0)] * 8, maxlen=8)
        self._bursts: deque[int] = deque()
        self._throws: deque[int] = deque([-WINDOW] * MOST_THROWS, maxlen=MOST_THROWS)
        self.worst = (0.0, 0.0)
        self._step = self._zigzags = 0
        self._largest = self._strength = 0.0

    def take(self, time: float, x: float, y: float, z: float = 0.0) -> bool:
        """Take an accepted step.

        Parameters
        ----------
        time : float
            s; not after the last one begins anew.
        x, y, z : float
            Force, N; z of a ball.

        Returns
        -------
        bool
            Whether the run rings, that is, whether this step is a burst and `LIMIT` or more lie in the window.
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
        """Return whether the run rings with forces out of all proportion to the moved masses and the loads."""
        return self.rings and self._throws[0] > self._step - WINDOW


def watched(time: np.ndarray, force: np.ndarray, area: float) -> RingingWatch:
    """A watch that has seen a record: times (n,) in s and forces (n, 2) or (n, 3) in N on an area in m2."""
    watch = RingingWatch(area)
    for t, parts in zip(time.tolist(), force.tolist(), strict=True):
        watch.take(t, *parts)
    return watch


def warn(name: str, watch: RingingWatch, *, starts_well: bool) -> None:
    """Warn that the run of the joint ``name`` rings; ``starts_well`` if Newton's method is started by this package."""
    start = "" if starts_well else "use ehd.SolveDynamic(mbs, simulationSettings) in place of mbs.SolveDynamic, or "
    warnings.warn(
        f"LubricatedJoint '{name}': from t = {watch.first:.9g} s to {watch.last:.9g} s the film's force alternates "
        f"from step to step, thrown anew {watch.most} times within {WINDOW} steps: the time integration causes these "
        f"forces and pressures; {start}take more steps until none is halved, or a smaller spectral "
        "radius.",
        RingingWarning,
        stacklevel=2,
    )
