"""Wrench of contact pressures and of their friction, and its gradient.

The wrench is linear in the integrals of the pressure times `FilmGrid.moments`: cos, sin, z cos, z sin and 1. The
pressures do no work on the journal's spin, so that their torque about O is e x F. Friction acts at the bore's points
against the slip, regularised as ``v / sqrt(|v|^2 + v0^2)``.
"""

import math

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def slip(motion, R, transition):
    """Regularised slip direction (theta, z) of a motion (10,), and its derivatives (2, 2) to (omega, w).

    ``transition``: v0, m/s.
    """
    v, w = R * motion[8], motion[9]
    size = math.sqrt(v * v + w * w + transition * transition)
    a, b, by = v / size, w / size, np.empty((2, 2))
    by[0, 0], by[0, 1] = (1.0 - a * a) * R / size, -a * b / size
    by[1, 0], by[1, 1] = -a * b * R / size, (1.0 - b * b) / size
    return a, b, by


@njit(cache=True)
def _add_traction(a, b, R, weights):
    """Add the weights (6, 5) of the integrals in the wrench of tractions of -a along theta and -b along z per
    pressure."""
    force, moment = R * R, R * R * R
    weights[0, 1] += force * a
    weights[1, 0] -= force * a
    weights[2, 4] -= force * b
    weights[3, 1] -= moment * b
    weights[3, 2] += moment * a
    weights[4, 0] += moment * b
    weights[4, 3] += moment * a
    weights[5, 4] -= moment * a


@njit(cache=True)
def contact_weights(motion, friction, transition, R):
    """Weights (6, 5) of the integrals in the wrench about O of pressures and their Coulomb friction, N and Nm."""
    out, force, moment = np.zeros((6, 5)), R * R, R * R * R
    out[0, 0] = out[1, 1] = -force
    out[3, 3], out[4, 2] = moment, -moment
    out[5, 0], out[5, 1] = force * motion[1], -force * motion[0]
    out[5, 2], out[5, 3] = moment * motion[3], -moment * motion[2]
    a, b, _ = slip(motion, R, transition)
    _add_traction(friction * a, friction * b, R, out)
    return out


@njit(cache=True, fastmath=_FAST)
def _integral(density, weight, moment):
    total = 0.0
    for c in range(density.size):
        total += density[c] * weight[c] * moment[c]
    return total


@njit(cache=True)
def add_contact(P, weight, moments, motion, friction, transition, R, integrals_out, friction_out, wrench):
    """Set the integrals (5,) of a contact's pressures P (n, m), and add its wrench and that of its friction alone, both
    (6,)."""
    for k in range(5):
        integrals_out[k] = _integral(P.reshape(-1), weight.reshape(-1), moments[k].reshape(-1))
    whole, drag = contact_weights(motion, friction, transition, R), np.zeros((6, 5))
    a, b, _ = slip(motion, R, transition)
    _add_traction(friction * a, friction * b, R, drag)
    for r in range(6):
        for k in range(5):
            wrench[r] += whole[r, k] * integrals_out[k]
            friction_out[r] += drag[r, k] * integrals_out[k]


@njit(cache=True)
def add_contact_tangent(slope, weight, moments, motion, pose_scale, friction, transition, R, integrals, tangent):
    """Add the gradient of a contact's wrench to the motion to ``tangent`` (6, 10).

    ``slope`` (n, m): derivative of the pressure to the scaled gap; ``integrals`` (5,): of `add_contact`.
    """
    weights, density = contact_weights(motion, friction, transition, R), slope * weight
    for q in range(4):
        for k in range(5):
            change = -pose_scale[q] * _integral(density.reshape(-1), moments[q].reshape(-1), moments[k].reshape(-1))
            for r in range(6):
                tangent[r, q] += weights[r, k] * change
    force, moment = R * R, R * R * R
    tangent[5, 0] -= force * integrals[1]
    tangent[5, 1] += force * integrals[0]
    tangent[5, 2] -= moment * integrals[3]
    tangent[5, 3] += moment * integrals[2]
    by = slip(motion, R, transition)[2]
    for q in range(2):
        weights[:] = 0.0
        _add_traction(friction * by[0, q], friction * by[1, q], R, weights)
        for r in range(6):
            for k in range(5):
                tangent[r, 8 + q] += weights[r, k] * integrals[k]
