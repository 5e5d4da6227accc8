"""Equations of motion of a nodal bush in the coordinates of its Exudyn object.

Mesh nodes are moving (three coordinates each), grounded (none), or slaved to a carrier with coordinates q_c.
With u = T(q) the reduced equations are T^T (M u_tt + f_int - f_load) = 0, and u_tt = T q_tt + (velocity accelerations).
If the carrier's mass contains the bush, the bush is subtracted from it as a rigid body (`RigidPart`).

Inertia of a bush as a rigid part, which the mass of its carrier already contains
---------------------------------------------------------------------------------
With its mass m, first moment s = A int rho X dV and inertia I about the carrier's frame (position p, rotation A,
velocity v, angular velocity omega), the carrier's kinetic energy contains

    m v^2 / 2 + v . (omega x s) + omega . I omega / 2.

The equations of the mesh subtract it. Mass, momentum and weight of the model are then those of the carrier, for any
material of the bush. The remaining inertia of the mesh is that of its deformation.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import exudyn as exu
import numpy as np
from exudyn.rigidBodyUtilities import Skew
from scipy.sparse import bmat, csr_matrix, diags
from scipy.sparse.linalg import splu

from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, Side
from exudyn_ehd.coupling.items.objects import warn_if_indefinite
from exudyn_ehd.coupling.items.reduced_bodies import Carrier, positions, velocities
from exudyn_ehd.solid.loads import BushLoad, FollowerPressure, dead_forces, factor
from exudyn_ehd.solid.total_lagrange import TotalLagrange
from exudyn_ehd.status import ROUNDING, RunError


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
        s, second = Skew(A @ self.first), A @ self.second @ A.T
        return np.block([[self.mass * np.eye(3), -s], [s, np.trace(second) * np.eye(3) - second]])


class BushEquations:
    """Force, Jacobian and mass of a bush object: user functions, which Exudyn calls.

    Parameters
    ----------
    name : str
        Name of the object, for messages.
    solid : TotalLagrange
        Mesh at its place in the model.
    held : ndarray of bool, shape (n, 3)
        Supported directions.
    slaved : ndarray of bool, shape (n,)
        Nodes that move with the carrier.
    carrier : Carrier or None
    loads : tuple of loads
    mass_rate : float
        Mass-proportional damping [1/s].
    contained : RigidPart or None
        The bush in the carrier's frame, if the carrier's mass contains it.

    Attributes
    ----------
    count : int
        Coordinates of the mesh's own nodes, which come first.
    """

    def __init__(
        self,
        name: str,
        *,
        solid: TotalLagrange,
        held: np.ndarray,
        slaved: np.ndarray,
        carrier: Carrier | None,
        loads: Sequence[BushLoad],
        mass_rate: float,
        contained: RigidPart | None,
    ) -> None:
        self.name, self.solid, self.held, self.slaved, self.carrier = name, solid, held, slaved, carrier
        self.loads, self.mass_rate, self.contained = loads, mass_rate, contained
        # start of the last step at which elements were checked
        self._watched, self._weighed = math.nan, False
        moving = ~slaved & ~held.all(axis=1)
        self._moving_rows, self._slaved_rows = (np.flatnonzero(np.repeat(nodes, 3)) for nodes in (moving, slaved))
        self.count = self._moving_rows.size
        # coordinates held by a spring
        self._held = np.flatnonzero(held[moving].ravel())
        self._followers = [load for load in loads if isinstance(load, FollowerPressure)]
        self._follower_places = [[x.ravel() for x in load.places()] for load in self._followers]
        dead = [load for load in loads if not isinstance(load, FollowerPressure)]
        self._dead_vectors = [(load, dead_forces(load, solid)) for load in dead]

    def motion(
        self, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType = CURRENT
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return displacement [m] and velocity [m/s] of all mesh nodes, shapes (n, 3), at a state of Exudyn."""
        u, v = self._nodal(q), self._nodal(q_t)
        if self.carrier is not None:
            self.carrier.move(q[self.count :], q_t[self.count :], configuration)
            u[self.slaved] = positions(self.carrier.side.frame, self.carrier.local) - self.solid.mesh.nodes[self.slaved]
            v[self.slaved] = velocities(self.carrier.side.frame, self.carrier.local)
        return u, v

    def _nodal(self, q: np.ndarray) -> np.ndarray:
        """Expand values of the nodes with coordinates to an array of all nodes, shape (n, 3)."""
        values = np.zeros(self.held.size)
        values[self._moving_rows] = q[: self.count]
        return values.reshape(-1, 3)

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> list[float]:
        """Generalised force (n,), a list, which Exudyn reads fastest; raises if an element was inside out."""
        start = mbs.systemData.GetTime(START_OF_STEP)
        if start != self._watched:
            self._watched = start
            self.require_upright(mbs, np.array(mbs.systemData.GetObjectLTGODE2(item)), start)
        return self.forces(t, np.array(q), np.array(q_t)).tolist()

    def forces(self, t: float, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Return the right-hand side of M q_tt = force, generalised forces [N], [Nm]."""
        u, v = self.motion(q, q_t)
        nodal = self._nodal_forces(t, u, v)
        if self.carrier is not None:
            acceleration = np.zeros_like(u)
            of_frame, acceleration[self.slaved] = self.carrier.accelerations(q[self.count :], q_t[self.count :])
            nodal -= self.solid.scalar_mass @ acceleration
        result = np.empty(len(q))
        result[: self.count] = nodal.ravel()[self._moving_rows]
        if self.carrier is not None:
            B = self.carrier.jacobian()
            result[self.count :] = B.T @ nodal[self.slaved].ravel()
            if self.contained is not None:
                result[self.count :] += self.contained.velocity_force(self.carrier.side, of_frame)
        result[self._held] = -self._spring * q[self._held]
        return result

    def jacobian(
        self,
        mbs: exu.MainSystem | None,
        t: float,
        item: int,
        coordinates: list[float],
        rates: list[float],
        position_factor: float,
        velocity_factor: float,
    ) -> csr_matrix:
        """Return -(position_factor d(force)/dq + velocity_factor d(force)/dq_t).

        It is exact without carrier and without viscosity, also with mass-proportional damping. Two terms are omitted:
        the change of a viscosity with the strain rate (see `TotalLagrange.tangent`), and with a carrier the change of
        the slaved velocities and inertia forces with its attitude, of the size of its angular velocity. Newton's method
        then needs more iterations; its result is the same.
        """
        q, q_t = np.array(coordinates), np.array(rates)
        u, v = self.motion(q, q_t)
        whole = self.solid.tangent(u, v, position_factor=position_factor, velocity_factor=velocity_factor)
        for pressure, (rows, columns) in zip(self._followers, self._follower_places, strict=True):
            block = position_factor * factor(pressure, t) * pressure.stiffness(self.solid.mesh.nodes + u)
            whole = whole + csr_matrix((block.ravel(), (rows, columns)), shape=whole.shape)
        moving = whole[self._moving_rows]
        own = moving[:, self._moving_rows]
        if self.mass_rate:
            own = own + velocity_factor * self.mass_rate * self._moving_mass
        K = self._without_held(own, position_factor * self._spring)
        if self.carrier is None:
            return K
        qc, slaved = q[self.count :], whole[self._slaved_rows]
        B = self.carrier.jacobian()
        along, across = moving[:, self._slaved_rows] @ B, (slaved[:, self._moving_rows].T @ B).T
        along[self._held] = across[:, self._held] = 0.0
        turn = self.carrier.force_derivative(qc, self._nodal_forces(t, u, v)[self.slaved])
        carried = B.T @ (slaved[:, self._slaved_rows] @ B) - position_factor * turn
        return bmat([[K, along], [across, carried]], format="csr")

    def mass(self, q: np.ndarray | None) -> csr_matrix:
        """Return the mass matrix: constant without a carrier, else T^T M T at the carrier's coordinates."""
        if self.carrier is None or q is None:
            return self._moving_mass
        qc = q[self.count :]
        self.carrier.move(qc, np.zeros_like(qc))
        B = self.carrier.jacobian()
        M = self.solid.mass
        coupling = M[self._moving_rows][:, self._slaved_rows] @ B
        coupling[self._held] = 0.0
        own = B.T @ (M[self._slaved_rows][:, self._slaved_rows] @ B)
        if self.contained is not None:
            own -= self.contained.matrix(self.carrier.side)
        return bmat([[self._moving_mass, coupling], [coupling.T, own]], format="csr")

    def mass_at(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> csr_matrix:
        """Return `mass` of a bush on a carrier."""
        if not self._weighed:
            self._weighed = True
            self.warn_if_light(mbs, np.array(q))
        return self.mass(np.array(q))

    def rounding(self, reach: np.ndarray) -> float:
        """Return an upper bound of the norm of the forces' round-off [N], for coordinates up to a size (n,).

        Nodes on a carrier have the round-off of their positions in the model at the last evaluation.
        """
        size = float(reach[: self.count].max(initial=0.0))
        whole, carried = self._rounding
        if self.carrier is None:
            return whole * size
        places = np.abs(positions(self.carrier.side.frame, self.carrier.local)).max(initial=0.0)
        return math.hypot(whole * size, carried * float(places))

    def require_upright(self, mbs: exu.MainSystem, places: np.ndarray, time: float) -> None:
        """Raise `RunError` if an element has turned inside out in the accepted state at the start of the step."""
        start, data = START_OF_STEP, mbs.systemData
        q, q_t = (np.asarray(get(start))[places] for get in (data.GetODE2Coordinates, data.GetODE2Coordinates_t))
        if turned := self.solid.inversion(self.motion(q, q_t, start)[0]):
            raise RunError(f"FlexibleBush '{self.name}' at t = {time:.9g} s: {turned}")

    def warn_if_light(self, mbs: exu.MainSystem, q: np.ndarray) -> None:
        """Warn if the carrier's mass must contain the bush but is smaller; call it in an assembled system."""
        if self.contained is None or self.carrier is None:
            return
        M, k = self.mass(q).tocsc(), self.count
        coupling = M[:k, k:].toarray()
        change = M[k:, k:].toarray() - coupling.T @ splu(M[:k, :k]).solve(coupling)
        name = self.name.removesuffix(" bush")
        warn_if_indefinite(mbs, self.carrier.side.nodes, change, self.contained.mass, name)

    def _nodal_forces(self, t: float, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Loads minus internal and mass-proportional damping forces, shape (n, 3) [N]."""
        total = -self.solid.force(u, v)
        for load, vector in self._dead_vectors:
            total += factor(load, t) * vector
        for pressure in self._followers:
            total += factor(pressure, t) * pressure.forces(self.solid.mesh.nodes + u)
        if self.mass_rate:
            total -= self.mass_rate * (self.solid.scalar_mass @ v)
        return total

    def _without_held(self, matrix: csr_matrix, value: float) -> csr_matrix:
        """Return a matrix with the rows and columns of held coordinates replaced by ``value`` on the diagonal."""
        if not len(self._held):
            return matrix
        held = np.zeros(self.count)
        held[self._held] = 1.0
        free = diags(1.0 - held)
        return (free @ matrix @ free + value * diags(held)).tocsr()

    @cached_property
    def _spring(self) -> float:
        """Spring of a single supported direction [N/m], far above the stiffest entry of the mesh."""
        return float(self.solid.tangent(np.zeros(self.held.shape)).diagonal().max()) / ROUNDING

    @cached_property
    def _rounding(self) -> tuple[float, float]:
        """Norms of the forces' round-off [N] per size of coordinates [m], of all nodes and of carried nodes alone.

        They hold for the worst signs at all nodes.
        """
        K = abs(self.solid.tangent(np.zeros(self.held.shape)))
        norms = (np.linalg.norm(part.sum(axis=1)) for part in (K, K[:, self._slaved_rows]))
        whole, carried = (float(np.finfo(float).eps * norm) for norm in norms)
        return whole, carried

    @cached_property
    def _moving_mass(self) -> csr_matrix:
        """Mass matrix of the nodes with coordinates.

        A coordinate held by a spring gets a mass with a frequency far above every frequency of the mesh. Upper estimate
        of the frequencies' squares: largest row sum of K over a hundredth of the smallest diagonal of M.
        """
        K = self.solid.tangent(np.zeros(self.held.shape))
        highest = 100.0 * float(abs(K).sum(axis=1).max() / self.solid.scalar_mass.diagonal().min())
        held_inertia = self._spring / (100.0 * highest)
        M = self._without_held(self.solid.mass[self._moving_rows][:, self._moving_rows], held_inertia)
        M.eliminate_zeros()
        return M
