"""Inertia of a modal bush on a housing that moves: floating frame of reference, linear in the modes' displacement.

The housing's body has the bush's mass, at its undeformed place. A point X of the bush's frame (position r, rotation A,
velocity v, angular velocity omega) stands at r + A (X + u), u = Phi q. Of its kinetic energy beyond the body's,

    T = int rho d(A X + r)/dt . d(A u)/dt dV + q_t^T M q_t / 2,

what is left out is of the second order in u: gyroscopic and centrifugal terms of u with itself. T does not change when
the whole model is displaced or turned, so that momentum, angular momentum and energy of housing and bush together are
kept. Its Euler-Lagrange equations, with p = P q and accelerations in the frame's components,

    delta r:    a_w = alpha x p + Omega x (Omega x p) + 2 Omega x p_t + p_tt,
    delta phi:  p x a + I alpha + Omega x (I Omega) + 2 sum q_t,i K_i Omega + Theta q_tt,     I = sum q_i (K_i + K_i^T),
    delta q_i:  P_i . a + Theta_i . alpha - Omega . K_i Omega + (M q_tt)_i,

need three integrals of the modes: P = int rho Phi, Theta = int rho X x Phi and K = int rho (X . Phi 1 - Phi X^T), see
`BoreModes.moments`. With modes for body forces (`exudyn_ehd.solid.modes.dynamic`) the bore deflects under accelerations
as the mesh does, else within 5 to 20 %.
"""

from __future__ import annotations

import weakref

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import CURRENT, Side
from exudyn_ehd.coupling.items.object_mass import warn_if_indefinite
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.sides import bind, detached
from exudyn_ehd.solid.modes.static import BoreModes


def describe(modes: BoreModes) -> tuple[str, float, str]:
    """What messages say of a bush with mass: its kind, its mass [kg], and what else to do."""
    assert modes.moments is not None
    return "bush with dynamics=True", float(modes.moments[:, 0].sum()), "take ModalBush(dynamics=False)"


class ModalInertia:
    """Mass and velocity forces of modes on a side.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    side : Side
        Carries the bush's frame; a copy with arrays of its own is kept.
    modes : BoreModes
        With mass.
    """

    def __init__(self, mbs: exu.MainSystem, side: Side, modes: BoreModes) -> None:
        assert modes.mass is not None
        # held by the system's own functions: what they refer to must not keep it alive
        self.mbs: exu.MainSystem = weakref.proxy(mbs)
        self.side: Side = detached(side)
        self.modal_mass = modes.mass
        self.P, self.Theta, self.K = modes.participation()
        self._both, self._flat = np.concatenate((self.P, self.Theta)), self.K.reshape(-1, 9)
        self._bound = False

    def mass(self, q: np.ndarray, modes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Blocks of housing (n, n), housing and modes (n, k), and modes (k, k) at their coordinates (n,) and (k,)."""
        J = self._move(q)
        p, inertia = relative.skew(self.P @ modes), self._inertia(modes)
        own = np.block([[np.zeros((3, 3)), -p], [p, inertia]])
        return J.T @ own @ J, J.T @ self._both, self.modal_mass

    def warn_if_indefinite(self, modes: BoreModes, name: str) -> None:
        """Warn if what carries the bush has not its mass, once the system is assembled."""
        data, nodes = self.mbs.systemData, self.side.nodes
        places = np.concatenate([data.GetNodeLTGODE2(int(node)) for node in nodes])
        q = np.asarray(data.GetODE2Coordinates())[places]
        _, coupling, mass = self.mass(q, np.zeros(len(self.modal_mass)))
        change = -coupling @ np.linalg.solve(mass, coupling.T)
        warn_if_indefinite(self.mbs, nodes, change, describe(modes), name)

    def force(
        self, q: np.ndarray, q_t: np.ndarray, modes: np.ndarray, modes_t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Forces (n,) on the housing and (k,) on the modes that velocities cause."""
        return self._velocity_force(self._move(q), q, q_t, modes, modes_t)

    def derivatives(
        self, q: np.ndarray, q_t: np.ndarray, modes: np.ndarray, modes_t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n + k, n + k) of `force` to the coordinates and to the rates.

        Exact except for the change with the housing's coordinates, which is left out; so is that of the mass matrix in
        Exudyn: Newton's rate suffers by the angle of a step.
        """
        J, n, k = self._move(q), q.size, modes.size
        place, rate = np.zeros((n + k, n + k)), np.zeros((n + k, n + k))
        a, alpha, omega = self._accelerations(J, q, q_t)
        N = self.K + self.K.transpose(0, 2, 1)
        columns = self.P.T
        force = np.cross(alpha, columns) + np.cross(omega, np.cross(omega, columns))
        moment = np.cross(columns, a) + N @ alpha + np.cross(omega, N @ omega)
        by_place = np.concatenate((force, moment), axis=1)
        by_rate = np.concatenate((np.cross(omega, columns), self.K @ omega), axis=1)
        place[:n, n:] = -(J.T @ by_place.T)
        rate[:n, n:] = -2.0 * (J.T @ by_rate.T)
        # quadratic in the rates: central differences are exact
        for i in range(n):
            ends = []
            for sign in (1.0, -1.0):
                moved = q_t.copy()
                moved[i] += sign
                ends.append(np.concatenate(self._velocity_force(J, q, moved, modes, modes_t)))
            rate[:, i] = 0.5 * (ends[0] - ends[1])
        return place, rate

    def _velocity_force(
        self, J: np.ndarray, q: np.ndarray, q_t: np.ndarray, modes: np.ndarray, modes_t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        a, alpha, omega = self._accelerations(J, q, q_t)
        p, p_t, inertia = self.P @ modes, self.P @ modes_t, self._inertia(modes)
        turn, each = relative.skew(omega), self.K @ omega
        force = relative.skew(alpha) @ p + turn @ (turn @ p + 2.0 * p_t)
        moment = relative.skew(p) @ a + inertia @ alpha + turn @ (inertia @ omega) + 2.0 * (modes_t @ each)
        on_modes = a @ self.P + alpha @ self.Theta - each @ omega
        return -(np.concatenate((force, moment)) @ J), -on_modes

    def _accelerations(self, J: np.ndarray, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, ...]:
        """Accelerations a and alpha at q_tt = 0, and Omega, in the frame's components."""
        side = self.side
        side.frame[:, 5] = side.jac[1] @ q_t
        side.vary(self.mbs, q, q_t)
        A = side.frame[:, :3]
        return (side.jac[2] @ q_t) @ A, (side.jac[3] @ q_t) @ A, J[3:] @ q_t

    def _inertia(self, modes: np.ndarray) -> np.ndarray:
        first = (modes @ self._flat).reshape(3, 3)
        return first + first.T

    def _move(self, q: np.ndarray) -> np.ndarray:
        """Bring the side to ``q``; its Jacobian (6, n) in the frame's components."""
        if not self._bound:
            bind(self.mbs, self.side)
            self._bound = True
        self.side.update(self.mbs, q, np.zeros_like(q), CURRENT)
        A = self.side.frame[:, :3]
        return np.concatenate((A.T @ self.side.jac[0], A.T @ self.side.jac[1]))
