"""Arrays that contacts and a gap limiter need beside those of the plain film."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.joint.seams import Contact


class ContactFields:
    """Buffers of the contacts and of the gap limiter; allocated only if there are any."""

    def __init__(self, shape: tuple[int, int], contacts: tuple[Contact, ...]) -> None:
        self.P = [np.zeros(shape) for _ in contacts]
        self.slope = [np.zeros(shape) for _ in contacts]
        self.integrals = np.zeros((len(contacts), 5))
        self.gradients = np.zeros((5, 4))
        self.friction = [(float(c.friction_coefficient), float(c.transition_speed)) for c in contacts]
        self.presses_below = max(c.presses_below for c in contacts)

    def clear(self) -> None:
        """No pressures."""
        for known in (*self.P, *self.slope, self.integrals):
            known[:] = 0.0


class LimiterFields:
    """Derivatives of the film's gap with respect to the true gap, at vertices and links, as `GapLimiter.limit` gives them."""

    def __init__(self, shape: tuple[int, int]) -> None:
        self.slope, self.bend = np.zeros(shape), np.zeros(shape)
        self.face_slope = np.zeros(shape)
        self.by_rate, self.by_gap = np.zeros(shape), np.zeros(shape)
