"""Wrench of contact pressures and of their friction, and its gradient.

The wrench is linear in the integrals of the pressure times `FilmGrid.moments`: cos, sin, z cos, z sin and 1. The
pressures do no work on the journal's spin, so that their torque about O is e x F. Friction acts at the bore's points
against the slip, regularised as ``v / sqrt(|v|^2 + v0^2)``.
"""

from __future__ import annotations

import functools
import math

import numpy as np

# Weights (6, 5) of the integrals in force and moment about O, lengths over R: of pressures on a centred journal, and of
# tractions of -1 per pressure along theta and along z.
_PRESSED, _ALONG, _ACROSS = np.zeros((3, 6, 5))
_PRESSED[0, 0], _PRESSED[1, 1], _PRESSED[3, 3], _PRESSED[4, 2] = -1.0, -1.0, 1.0, -1.0
_ALONG[0, 1], _ALONG[1, 0], _ALONG[3, 2], _ALONG[4, 3], _ALONG[5, 4] = 1.0, -1.0, 1.0, 1.0, -1.0
_ACROSS[2, 4], _ACROSS[3, 1], _ACROSS[4, 0] = -1.0, -1.0, 1.0


def slip(motion: np.ndarray, R: float, transition: float) -> tuple[float, float, np.ndarray]:
    """Regularised slip direction (theta, z) of a motion (10,), and its derivatives (2, 2) to (omega, w).

    ``transition``: v0, m/s.
    """
    v, w = R * float(motion[8]), float(motion[9])
    size = math.sqrt(v * v + w * w + transition**2)
    a, b = v / size, w / size
    return a, b, np.array([[(1.0 - a * a) * R, -a * b], [-a * b * R, 1.0 - b * b]]) / size


def contact_integrals(P: np.ndarray, weight: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """Integrals (5,) of contact pressures (n, m) with the moments (5, n, m)."""
    return moments.reshape(5, -1) @ (P * weight).ravel()


def contact_weights(motion: np.ndarray, friction: float, transition: float, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench about O of pressures and their Coulomb friction, N and Nm."""
    return pressure_weights(motion, R) + friction_weights(motion, friction, transition, R)


def pressure_weights(motion: np.ndarray, R: float) -> np.ndarray:
    """`contact_weights` of the pressures alone."""
    out, (x, y, bx, by) = _PRESSED.copy(), motion[:4].tolist()
    out[5, :4] = y / R, -x / R, by, -bx
    return _units(R) * out


def friction_weights(motion: np.ndarray, friction: float, transition: float, R: float) -> np.ndarray:
    """`contact_weights` of the friction alone."""
    a, b, _ = slip(motion, R, transition)
    return friction * _units(R) * (a * _ALONG + b * _ACROSS)


def contact_tangent(
    slope: np.ndarray,
    moments: np.ndarray,
    motion: np.ndarray,
    pose_scale: np.ndarray,
    friction: float,
    transition: float,
    R: float,
    integrals: np.ndarray,
) -> np.ndarray:
    """Gradient (6, 10) of a contact's wrench to the motion.

    ``slope`` (n, m): derivative of the pressure to the scaled gap times the integration weights.
    """
    out, flat = np.zeros((6, 10)), moments.reshape(5, -1)
    by_pose = (flat * slope.ravel()) @ flat[:4].T * -pose_scale
    out[:, :4] = contact_weights(motion, friction, transition, R) @ by_pose
    sc, ss, szc, szs, _ = integrals.tolist()
    out[5, :4] += R**2 * np.array([-ss, sc, -R * szs, R * szc])
    by_slip = np.array((_ALONG @ integrals, _ACROSS @ integrals)).T
    out[:, 8:] = friction * _units(R) * (by_slip @ slip(motion, R, transition)[2])
    return out


@functools.lru_cache(maxsize=16)
def _units(R: float) -> np.ndarray:
    """Force and moment (6, 1) of a unit pressure over scaled area and arm, m^2 and m^3."""
    return np.array([R**2, R**2, R**2, R**3, R**3, R**3])[:, None]
