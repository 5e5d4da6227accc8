"""Concentric journal: N. P. Petroff's friction (1883)."""

from __future__ import annotations

import math


def torque(viscosity: float, speed: float, radius: float, length: float, clearance: float) -> float:
    """Friction torque in Nm: ``2 pi mu omega R^3 L / c``.

    Parameters
    ----------
    viscosity : float
        Pa s.
    speed : float
        Relative spin, rad/s.
    radius, length, clearance : float
        m; clearance is radial.
    """
    return 2.0 * math.pi * viscosity * speed * radius**3 * length / clearance


def power(viscosity: float, speed: float, radius: float, length: float, clearance: float) -> float:
    """Power loss in W; arguments as for `torque`."""
    return torque(viscosity, speed, radius, length, clearance) * speed
