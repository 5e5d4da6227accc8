"""Wrench of contact pressures and of their friction, and its gradient.

The wrench is linear in the integrals of the pressure times `FilmGrid.moments`: cos, sin, z cos, z sin and 1. The
pressures do no work on the journal's spin, so that their torque about O is e x F. Friction acts at the bore's points
against the slip, regularised as ``v / sqrt(|v|^2 + v0^2)``.
"""

from __future__ import annotations

import math

import numpy as np


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


def pressure_weights(motion: np.ndarray, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench of the pressures about O, N and Nm."""
    x, y, bx, by = motion[:4].tolist()
    return R**2 * np.array(
        [
            [-1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, R, 0.0],
            [0.0, 0.0, -R, 0.0, 0.0],
            [y, -x, R * by, -R * bx, 0.0],
        ]
    )


def drag_weights(a: float, b: float, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench of tractions of -a in theta and -b in z per pressure."""
    return R**2 * np.array(
        [
            [0.0, a, 0.0, 0.0, 0.0],
            [-a, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, -b],
            [0.0, -b * R, a * R, 0.0, 0.0],
            [b * R, 0.0, 0.0, a * R, 0.0],
            [0.0, 0.0, 0.0, 0.0, -a * R],
        ]
    )


def friction_weights(motion: np.ndarray, friction: float, transition: float, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench of Coulomb friction with this coefficient."""
    a, b, _ = slip(motion, R, transition)
    return drag_weights(friction * a, friction * b, R)


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
    by_pose = -(flat * slope.ravel()) @ flat[:4].T * pose_scale
    out[:, :4] = (pressure_weights(motion, R) + friction_weights(motion, friction, transition, R)) @ by_pose
    sc, ss, szc, szs, _ = integrals.tolist()
    out[5, :4] += R**2 * np.array([-ss, sc, -R * szs, R * szc])
    for column, (a, b) in enumerate(slip(motion, R, transition)[2].T.tolist()):
        out[:, 8 + column] = drag_weights(friction * a, friction * b, R) @ integrals
    return out
