"""Explicit integrators beyond their stability limit, recognised from the accepted steps of a joint.

A film is a damper C between masses: beyond h C / m = 2 (forward Euler), 2.51 (RK33) or 2.79 (RK44) the journal's velocity is a product of
the step size h. The film's stiffening keeps it finite, so that the journal chatters about a wrong place. What tells is that velocities
are no longer the rates of the positions: with the displacement d of a step and the velocities v0, v1 at its ends,

    s = |d - h (v0 + v1) / 2| / (h max(|v0|, |v1|))

is |sin(a) / a - cos(a)|, a = pi / n, for an oscillation with n steps per period: 0.05 at eight, 0.19 at four, 0.64 at two. For
v' = -lambda v a Runge-Kutta method has d = h v0 (1 - R) / z, with z = h lambda and its stability function R(z): s = |(1 - R) / z - (1 + R) / 2| is
2 / z at the limit R = -1 and 1 at the limit R = 1, however slow the growth. Single steps of that kind belong to impacts, and
those that die away to transients that end within some steps: neither counts.
"""

from __future__ import annotations

from typing import Any

import numpy as np

# Mismatch s of a step that is not resolved: an oscillation with less than 3.5 steps per period.
UNRESOLVED = 0.25
# Position error below which a step counts as resolved, share of the clearance: rounding of positions far from the origin stays below.
SMALLEST_SHARE = 1e-6
# A step counts if its error is still so large a share of the largest one before, which fades by so much per step.
LASTING_SHARE, FADING = 0.15, 0.99
# A step that counts adds two, any other takes one.
LIMIT = 32


class ChatterWatch:
    """Watches one joint under an explicit solver.

    Parameters
    ----------
    bearing : JournalBearing

    Attributes
    ----------
    error : float
        |d - h (v0 + v1) / 2| of the last step, m; tilts count by half the length.
    """

    def __init__(self, bearing: Any) -> None:
        self.smallest = SMALLEST_SHARE * bearing.radial_clearance
        self.lever = 0.5 * bearing.length
        self.begin_anew()

    def begin_anew(self) -> None:
        """Forget all steps."""
        self.time = np.inf
        self.place = self.rate = np.zeros(4)
        self.error = self.largest = 0.0
        self.score = 0

    def sees_chatter(self, time: float, motion: np.ndarray) -> bool:
        """Take an accepted state; whether the last steps were not resolved.

        Parameters
        ----------
        time : float
            s.
        motion : (10,) array
            In the joint frame.
        """
        place, rate = motion[:4].copy(), motion[4:8].copy()
        place[2:] *= self.lever
        rate[2:] *= self.lever
        step, before, rate_before = time - self.time, self.place, self.rate
        self.time, self.place, self.rate = time, place, rate
        if not step > 0.0:
            self.error = self.largest = 0.0
            self.score = 0
            return False
        mismatch = place - before - 0.5 * step * (rate + rate_before)
        self.error = float(np.sqrt(mismatch @ mismatch))
        way = step * float(np.sqrt(max(rate @ rate, rate_before @ rate_before)))
        self.largest = max(self.error, FADING * self.largest)
        counts = self.error > max(UNRESOLVED * way, self.smallest, LASTING_SHARE * self.largest)
        self.score = self.score + 2 if counts else max(self.score - 1, 0)
        return self.score >= LIMIT
