"""Infinitely long journal bearing: Sommerfeld's integrals.

Source: A. Sommerfeld, Z. Math. Phys. 50 (1904) 97; as in any textbook on hydrodynamic lubrication, e.g. B. J. Hamrock,
Fundamentals of Fluid Film Lubrication, chapter on journal bearings. theta counts from the largest gap in the sense of
rotation, ``h = c (1 + eps cos theta)``.
"""

from __future__ import annotations

import math


def full_sommerfeld_pressure(eps: float, theta: float) -> float:
    """Dimensionless pressure ``p c^2 / (mu omega R^2)``, zero at theta = 0 (largest gap)."""
    h = 1.0 + eps * math.cos(theta)
    return 6.0 * eps * math.sin(theta) * (1.0 + h) / ((2.0 + eps**2) * h**2)


def full_sommerfeld_load(eps: float) -> float:
    """Sommerfeld number of the film that carries tension; the attitude angle is pi/2."""
    return 6.0 * math.pi * eps / ((2.0 + eps**2) * math.sqrt(1.0 - eps**2))


def half_sommerfeld_load(eps: float) -> float:
    """Sommerfeld number with the pressures below ambient cut off."""
    root = math.sqrt(math.pi**2 - eps**2 * (math.pi**2 - 4.0))
    return 3.0 * eps * root / ((2.0 + eps**2) * (1.0 - eps**2))


def half_sommerfeld_attitude(eps: float) -> float:
    """Attitude angle of the half Sommerfeld film, rad."""
    return math.atan2(math.pi * math.sqrt(1.0 - eps**2), 2.0 * eps)


def full_sommerfeld_journal_torque(eps: float) -> float:
    """Friction torque on the journal about its own axis, divided by Petroff's torque."""
    return 2.0 * (1.0 + 2.0 * eps**2) / ((2.0 + eps**2) * math.sqrt(1.0 - eps**2))


def full_sommerfeld_bush_torque(eps: float) -> float:
    """Friction torque on the bush about its own axis, divided by Petroff's torque."""
    return 2.0 * math.sqrt(1.0 - eps**2) / (2.0 + eps**2)
