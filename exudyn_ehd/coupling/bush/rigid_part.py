"""Inertia of a bush as a rigid part, which the mass of its carrier already contains.

With its mass m, first moment s = A int rho X dV and inertia I about the carrier's frame (position p, rotation A,
velocity v, angular velocity omega), the carrier's kinetic energy contains

    m v^2 / 2 + v . (omega x s) + omega . I omega / 2.

The equations of the mesh subtract it. Mass, momentum and weight of the model are then those of the carrier, for any
material of the bush. Of the mesh's inertia only that of its strain remains.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.coupling.contract import Side
from exudyn_ehd.coupling.kinematics.relative import skew


class RigidPart:
    """Inertia of points that move with a frame.

    Parameters
    ----------
    points : ndarray (n, 3)
        Places in the frame [m].
    mass : sparse matrix (n, n)
        [kg].
    """

    def __init__(self, points: np.ndarray, mass) -> None:
        share = mass @ points
        self.mass = float(mass.sum())
        self.first = share.sum(axis=0)
        self.second = points.T @ share

    def describe(self) -> tuple[str, float, str]:
        """Return values for messages: kind of the bush, its mass [kg], and an alternative remedy."""
        remedy = "give the joint bushGravity=(...): the bush's mass then counts beside the housing's, with this gravity"
        return "ANCFBush", self.mass, remedy

    def matrix(self, side: Side) -> np.ndarray:
        """Mass matrix (n, n) on the coordinates of a side."""
        J = side.jac[:2].reshape(6, -1)
        return J.T @ self._frame_mass(side.frame) @ J

    def velocity_force(self, side: Side, accelerations: np.ndarray) -> np.ndarray:
        """Generalized inertia force (n,) at q_tt = 0, with the sign of M q_tt, for the frame's accelerations (6,)."""
        A, omega = side.frame[:, :3], side.frame[:, 5]
        s, inertia = A @ self.first, self._frame_mass(side.frame)[3:, 3:]
        wrench = self._frame_mass(side.frame) @ accelerations
        wrench[:3] += np.cross(omega, np.cross(omega, s))
        wrench[3:] += np.cross(omega, inertia @ omega)
        return wrench @ side.jac[:2].reshape(6, -1)

    def momenta(self, frame: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        """Kinetic energy [J], momentum [kg m/s] and angular momentum about the global origin [kg m^2/s]."""
        rates = np.concatenate((frame[:, 4], frame[:, 5]))
        both = self._frame_mass(frame) @ rates
        return 0.5 * float(rates @ both), both[:3], both[3:] + np.cross(frame[:, 3], both[:3])

    def _frame_mass(self, frame: np.ndarray) -> np.ndarray:
        A = frame[:, :3]
        s, second = skew(A @ self.first), A @ self.second @ A.T
        return np.block([[self.mass * np.eye(3), -s], [s, np.trace(second) * np.eye(3) - second]])
