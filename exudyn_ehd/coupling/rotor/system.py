"""Exudyn system, without the forces of its films, about a state in which rotors spin and everything else is at rest.

Every rigid node is described in space by a small displacement and a small rotation of its frame, ``x = (dp, dphi)``,
and by its velocity and angular velocity, ``u = (v, omega)``. Any other coordinate is its own direction. With q_t = B(q)
u the equations of motion of the system are the balance of forces and moments on its bodies::

    r(x, u, u_t) = B^T (M(q) q_tt - f(q, q_t) + C(q)^T mu) = 0,    q_tt = B (u_t - (dB^-1/dt) B u).

A rotor at rest except for its spin has omega_i = Omega a_i, with the axis a_i of its node i. A small motion about this
state changes omega also by the rotation of the frame::

    d omega = dphi_t + dphi x omega,    d omega_t = dphi_tt + dphi_t x omega,

so that, with S dphi = dphi x omega in the rows of turning nodes, and with the derivatives r_x and r_u::

    M x_tt + (r_u + M S) x_t + (r_x + r_u S) x = 0.

Displacements and rotations count in space, not in the turning body: for rotors that are the same in all directions
about their axis the matrices are constant. Gyroscopic moments are part of r_u. Damping inside of a rotor is that of
Exudyn's elements: its ``RigidBodySpringDamper`` damps velocities in space, which drives no whirl.

Source of the variation of omega: dA = [dphi] A and A_t = [omega] A give [d omega] = d/dt [dphi] + [dphi][omega] -
[omega][dphi]. The derivatives of r are central differences; films are left out, whose tangents are exact (`films`).

Flexible bushes and journals of bearings: their coordinates follow the films, and x is without them
--------------------------------------------------------------------------------------------------
Modes of a bush or a journal have no mass. Their motion follows from the balance of film and surface, which is part of
the film's K, C and dynamic stiffness (`exudyn_ehd.joint.static.dynamic_stiffness`). The mesh of an `ANCFBush` has mass.
It counts as a rigid part of the housing, with whose node its nodes move: a bush is much stiffer than its film, and the
frequencies of its vibrations are far above those of a rotor.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

import exudyn as exu
import numpy as np
from exudyn.lieGroupBasics import ExpSO3
from exudyn.rigidBodyUtilities import (
    RotationMatrix2EulerParameters,
    RotationMatrix2RotationVector,
    RotationMatrix2RotXYZ,
    Skew,
)

from exudyn_ehd.coupling.contract import INITIAL, NodeIndex
from exudyn_ehd.coupling.element.nodal import NodalFilmElement
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.sides import NodeSide, node_side
from exudyn_ehd.coupling.rotor.spinning import TURNING, WHERE, Rotor
from exudyn_ehd.joint.bore.solid import SolidElasticity
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.status import InputError

# Step of the difference quotients of u, m/s or rad/s. It may be large, because the forces of bodies are quadratic in u.
RATE_STEP = 1e-2

COORDINATES_OF = {
    rigid_nodes.EULER_PARAMETERS: RotationMatrix2EulerParameters,
    rigid_nodes.TAIT_BRYAN: RotationMatrix2RotXYZ,
    rigid_nodes.ROTATION_VECTOR: RotationMatrix2RotationVector,
}
"""Functions from a rotation (3, 3) to a node's coordinates, by the kind of these."""


class TurningNode:
    """Node of a rigid body or a beam, with the nodes of a flexible bush that move rigidly with it.

    Parameters
    ----------
    side : NodeSide
        Frame of the node.
    places : (n,) array
        Indices of its coordinates among those of the system.
    first : int
        Index of its displacement and rotation (6,) in x.

    Attributes
    ----------
    places : (n + 3 k,) array
        Its coordinates and those of k nodes that it carries.
    """

    def __init__(self, side: NodeSide, places: np.ndarray, first: int) -> None:
        self.side, self.places, self.own = side, places, slice(first, first + 6)
        self.count, self.carried = places.size, np.zeros((0, 3))

    def carry(self, places: np.ndarray, reference: np.ndarray) -> None:
        """Add nodes that move with this node, with coordinates at ``places`` (3 k,) and reference positions (k, 3), m.

        Their centripetal acceleration is omitted, because a housing does not spin.
        """
        self.places = np.concatenate((self.places, places))
        self.carried = np.concatenate((self.carried, reference))

    def turn(self, q: np.ndarray) -> np.ndarray:
        """Rotation (3, 3), node to space, at the system's coordinates."""
        return rigid_nodes.rotation_of(self.side.kind, self.side.reference + q[self.places[: self.count]])

    def position(self, q: np.ndarray) -> np.ndarray:
        """Place (3,) in space, m."""
        return self.side.reference[:3] + q[self.places[:3]]

    def _arms(self, q: np.ndarray) -> np.ndarray:
        """Distances (k, 3) of the carried nodes, m."""
        return self.carried + q[self.places[self.count :]].reshape(-1, 3) - self.position(q)

    def rates(self, q: np.ndarray, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """B (n + 3 k, 6), and the second derivatives (m,) of the rotation's coordinates at constant omega (3,)."""
        own = q[self.places[: self.count]]
        rates = np.zeros(own.size)
        self.side.update(None, own, rates, None)
        # Euler parameters keep their length
        inverse = np.linalg.pinv(self.side.jac[1, :, 3:])
        rates[3:] = inverse @ omega
        B = np.zeros((self.places.size, 6))
        B[:3, :3], B[3 : own.size, 3:] = np.eye(3), inverse
        for k, arm in enumerate(self._arms(q)):
            B[own.size + 3 * k : own.size + 3 * k + 3] = np.hstack((np.eye(3), -Skew(arm)))
        return B, -inverse @ (self.side.change(None, own)[3:] @ rates @ rates)

    def move(self, q: np.ndarray, x: np.ndarray) -> None:
        """Change the coordinates of the system by a displacement and a rotation vector (6,)."""
        own, carried, reference = self.places[3 : self.count], self.places[self.count :], self.side.reference[3:]
        arms, turning = self._arms(q), ExpSO3(x[3:])
        theta = np.ravel(COORDINATES_OF[self.side.kind](turning @ self.turn(q)))
        if self.side.kind == rigid_nodes.EULER_PARAMETERS:
            # of either sign
            theta = theta * np.sign(theta @ (reference + q[own]))
        q[self.places[:3]] += x[:3]
        q[own] = theta - reference
        q[carried] += (x[:3] + arms @ (turning - np.eye(3)).T).ravel()


class HeldBore:
    """Coordinates of the flexible bush and journal of one film; empty for rigid surfaces and liners.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    element : FilmElement

    Attributes
    ----------
    places : (k,) array
        Indices in the system's coordinates.
    housing : int
        Node that carries a mesh; -1 without one.
    reference, local : (n, 3) arrays
        Of a mesh: reference positions of the nodes that have coordinates, and their places in the bush's frame, m.
    """

    def __init__(self, mbs: exu.MainSystem, element: FilmElement) -> None:
        bush = element.bush if isinstance(element, NodalFilmElement) else None
        nodes = element.bore_nodes if bush is None else bush.nodeNumbers
        found = [mbs.systemData.GetNodeLTGODE2(int(node)) if int(node) >= 0 else () for node in nodes]
        self.places = np.array([place for part in found for place in part], dtype=int)
        self.housing, self._moves = -1, [k for k, part in enumerate(found) if len(part)]
        if bush is not None:
            self.reference, self.local = bush.solid.mesh.nodes[self._moves], bush.mesh.nodes[self._moves]
            self.housing = int(element.sides[0].nodes[0]) if element.sides[0].nodes else -1

    def enter(self, q: np.ndarray, evaluation: Evaluation, frame: np.ndarray) -> None:
        """Write the coordinates of a film's bore to the system's q (n,); ``frame``: frame of the housing."""
        if not isinstance(evaluation, ElasticEvaluation):
            return
        elasticity = evaluation.model.elasticity
        if isinstance(elasticity, SolidElasticity):
            moved = self.local + elasticity.displacements[self._moves]
            q[self.places] = (frame[:, 3] + moved @ frame[:, :3].T - self.reference).ravel()
        else:
            q[self.places] = evaluation.bore.coordinates


class SpinningSystem:
    """Forces and matrices of an assembled system without its films.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    rotors : list of Rotor
    bores : sequence of HeldBore, default ()
        Flexible bushes and journals, whose coordinates take no part in x.

    Attributes
    ----------
    q : (n,) array
        Coordinates of the state.
    spins : (r,) array
        Speeds of the rotors, rad/s.
    spinning : list
        Number of the rotor, node and its axis in its own frame, of all nodes that turn.
    ratios : dict
        Speed of a rotor's node over that of the first rotor, by its number.
    size : int
        Length of x.
    multipliers : (m,) array
        mu of the constraints.
    places, own : (k,) arrays
        Coordinates that belong to no rigid node, and their directions in x.
    """

    def __init__(self, mbs: exu.MainSystem, rotors: list[Rotor], bores: Sequence[HeldBore] = ()) -> None:
        self.mbs, self.rotors, self.spins = mbs, rotors, np.zeros(len(rotors))
        self.ratios = {node: rotor.ratio for rotor in rotors for node in rotor.nodes}
        data = mbs.systemData
        if len(data.GetODE1Coordinates()) or mbs.NumberOfGeneralContacts():
            raise InputError(
                f"{WHERE}: the system must have second-order coordinates only and no GeneralContact; take contact "
                "objects and controllers without states of their own."
            )
        self.q = np.array(data.GetODE2Coordinates(INITIAL), dtype=float)
        self.nodes: dict[int, TurningNode] = {}
        self.size, plain = 0, np.ones(self.q.size, dtype=bool)
        for number in range(data.NumberOfNodes()):
            node = NodeIndex(number)
            if mbs.GetNode(node)["nodeType"] in TURNING:
                places = np.array(data.GetNodeLTGODE2(number), dtype=int)
                self.nodes[number] = TurningNode(node_side(mbs, node), places, self.size)
                plain[places] = False
                self.size += 6
        for bore in bores:
            plain[bore.places] = False
            if bore.housing in self.nodes:
                self.nodes[bore.housing].carry(bore.places, bore.reference)
        turning = [(k, *pair) for k, rotor in enumerate(rotors) for pair in zip(rotor.nodes, rotor.axes, strict=True)]
        self.spinning = [(k, self.nodes[number], axis) for k, number, axis in turning]
        self.places = np.flatnonzero(plain)
        self.own = self.size + np.arange(self.places.size)
        self.size += self.places.size
        self._settings = settings = exu.SimulationSettings()
        settings.staticSolver.verboseMode = 0
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        settings.solution.file.write = settings.solution.sensors.active = False
        self._solver = cast(Any, exu.MainSolverStatic())
        self._solver.InitializeSolver(mbs, settings)
        self.multipliers = np.zeros(self._solver.GetAEsize())

    def axis(self, rotor: int) -> np.ndarray:
        """Axis (3,) in space of the driven node of a rotor."""
        driven = self.rotors[rotor]
        return self.nodes[driven.nodes[0]].turn(self.q) @ driven.axes[0]

    def spin(self) -> np.ndarray:
        """u (size,) of the state: the spins of the rotors."""
        u = np.zeros(self.size)
        for rotor, node, axis in self.spinning:
            u[node.own][3:] = self.spins[rotor] * (node.turn(self.q) @ axis)
        return u

    def turning(self) -> np.ndarray:
        """S (size, size) of the module's text at the state."""
        S, u = np.zeros((self.size, self.size)), self.spin()
        for _, node, _ in self.spinning:
            own = slice(node.own.start + 3, node.own.stop)
            S[own, own] = -Skew(u[own])
        return S

    def moved(self, x: np.ndarray, alone: int | None = None) -> np.ndarray:
        """Coordinates (n,) of the state moved by x (size,), which may be that of one node ``alone`` (-1: of none)."""
        q = self.q.copy()
        q[self.places] += x[self.own]
        for number in self.nodes if alone is None else {alone} & self.nodes.keys():
            self.nodes[number].move(q, x[self.nodes[number].own])
        return q

    def balance(
        self,
        q: np.ndarray,
        u: np.ndarray,
        known: Mapping[int, tuple[np.ndarray, np.ndarray]] | None = None,
        moved: int = -1,
    ) -> tuple[np.ndarray, np.ndarray]:
        """r (size,) at coordinates q (n,), rates u and u_t = 0, and the constraints' errors (m,).

        ``known`` are the rates of nodes other than ``moved``, where only that one has changed.
        """
        rates, accelerations, maps = np.zeros_like(q), np.zeros_like(q), []
        for number, node in self.nodes.items():
            own = known[number] if known and number != moved else node.rates(q, u[node.own][3:])
            rates[node.places], accelerations[node.places[3 : node.count]] = own[0] @ u[node.own], own[1]
            maps.append((node, own[0]))
        rates[self.places] = u[self.own]
        self._enter(q, rates)
        self._solver.ComputeNewtonResidual(self.mbs, self._settings)
        found = np.array(self._solver.GetSystemResidual())
        force = -found[: q.size]
        if accelerations.any():
            force += self._mass_matrix() @ accelerations
        r = np.zeros(self.size)
        for node, B in maps:
            r[node.own] = B.T @ force[node.places]
        r[self.own] = force[self.places]
        return r, found[q.size :]

    def derivatives(self) -> tuple[np.ndarray, np.ndarray]:
        """r_x and r_u (size, size) at the state."""
        u, r_x, r_u = self.spin(), np.empty((self.size, self.size)), np.empty((self.size, self.size))
        known = {number: node.rates(self.q, u[node.own][3:]) for number, node in self.nodes.items()}
        owners = np.full(self.size, -1)
        h = float(np.cbrt(np.finfo(float).eps))  # m or rad, with the least error of central differences
        for number, node in self.nodes.items():
            owners[node.own] = number
        for k, unit in enumerate(np.eye(self.size)):
            ends = [self.balance(self.moved(step * unit, owners[k]), u, known, owners[k])[0] for step in (h, -h)]
            r_x[:, k] = (ends[0] - ends[1]) / (2.0 * h)
            ends = [self.balance(self.q, u + step * unit, known, owners[k])[0] for step in (RATE_STEP, -RATE_STEP)]
            r_u[:, k] = (ends[0] - ends[1]) / (2.0 * RATE_STEP)
        return r_x, r_u

    def maps(self) -> np.ndarray:
        """B (n, size) at the state."""
        B = np.zeros((self.q.size, self.size))
        for node in self.nodes.values():
            B[node.places, node.own] = node.rates(self.q, np.zeros(3))[0]
        B[self.places, self.own] = 1.0
        return B

    def mass(self) -> np.ndarray:
        """M (size, size) at the state."""
        self._enter(self.q, np.zeros_like(self.q))
        B = self.maps()
        return B.T @ self._mass_matrix() @ B

    def constraints(self) -> np.ndarray:
        """Constraint matrix C B (m, size) at the state."""
        n, m = self.q.size, self.multipliers.size
        if m == 0:
            return np.zeros((0, self.size))
        self._enter(self.q, np.zeros(n))
        self._solver.SetSystemJacobian(np.zeros((n + m, n + m)))
        self._solver.ComputeJacobianAE(
            self.mbs, scalarFactor_ODE2=1.0, scalarFactor_ODE2_t=0.0, scalarFactor_ODE1=0.0, velocityLevel=False
        )
        return np.array(self._solver.GetSystemJacobian())[n:, :n] @ self.maps()

    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M, D, K (size, size) of the module's text at the state."""
        M, S, (r_x, r_u) = self.mass(), self.turning(), self.derivatives()
        return M, r_u + M @ S, r_x + r_u @ S

    def drives(self) -> np.ndarray:
        """Rows (r, size) of the angles that drives hold: those of the first nodes about their axes."""
        rows = np.zeros((len(self.rotors), self.size))
        for k, rotor in enumerate(self.rotors):
            rows[k, self.nodes[rotor.nodes[0]].own][3:] = self.axis(k)
        return rows

    def turned(self) -> np.ndarray:
        """Coordinates (n,) of the state after all rotors have turned by one radian."""
        q = self.q.copy()
        for _, node, axis in self.spinning:
            node.move(q, np.concatenate((np.zeros(3), node.turn(self.q) @ axis)))
        return q

    def _enter(self, q: np.ndarray, rates: np.ndarray) -> None:
        data = self.mbs.systemData
        data.SetODE2Coordinates(q.tolist())
        data.SetODE2Coordinates_t(rates.tolist())
        if self.multipliers.size:
            data.SetAECoordinates((-self.multipliers).tolist())

    def _mass_matrix(self) -> np.ndarray:
        self._solver.ComputeMassMatrix(self.mbs)
        n = self.q.size
        return np.array(self._solver.GetSystemMassMatrix())[:n, :n]
