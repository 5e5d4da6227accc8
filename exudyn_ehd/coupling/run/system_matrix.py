"""Iteration matrix of a system, assembled object by object, for `exudyn_ehd.coupling.run.sparse`."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import exudyn as exu
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, csr_matrix

from exudyn_ehd.coupling.contract import Index, NodeIndex, ObjectIndex
from exudyn_ehd.coupling.element.nodal import NodalFilmElement
from exudyn_ehd.coupling.items.bush_equations import BushEquations
from exudyn_ehd.coupling.items.objects import as_sparse, force_owner, hidden_mass, is_hidden
from exudyn_ehd.status import InputError

# Bodies of one node without stiffness, whose velocity forces are omitted in the matrix, as in Exudyn.
_SIMPLE = ("Ground", "RigidBody", "RigidBody2D", "MassPoint", "MassPoint2D", "Mass1D", "RotationalMass1D")
# Constraints without coordinates except multipliers, for which Exudyn returns all terms of the Jacobian.
_CONSTRAINTS = (
    "ConnectorCoordinate",
    "ConnectorCoordinateVector",
    "ConnectorDistance",
    "JointGeneric",
    "JointPrismatic2D",
    "JointPrismaticX",
    "JointRevolute2D",
    "JointRevoluteZ",
    "JointRollingDisc",
    "JointSpherical",
)
# Exudyn's steps of numerical differentiation.
_STEPS = exu.SimulationSettings().timeIntegration.newton.numericalDifferentiation


class Factors(NamedTuple):
    """Factors of the terms of an iteration matrix.

    Attributes
    ----------
    mass, stiffness, damping : float
        1 / f, beta h^2, gamma h.
    position, velocity : float
        Factors of the constraints that Exudyn solves for positions and for velocities: 1 and gamma / (beta h), the
        derivative of a rate with respect to its coordinate.
    """

    mass: float
    stiffness: float
    damping: float
    position: float
    velocity: float


class SystemMatrix:
    """The system's iteration matrix, assembled object by object.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        Assembled.

    Attributes
    ----------
    coordinates, constraints : int
        Second-order coordinates and algebraic equations.
    parts : list
        One function (mbs, Factors) -> list of (rows, columns, values) per object.
    meshes : list
        The same for nodal bushes.
    mesh : (n,) array of bool
        True for coordinates and equations of bushes' nodes.
    films : list
        Films on nodal bushes, and the indices of their coordinates.
    """

    def __init__(self, mbs: exu.MainSystem) -> None:
        data = mbs.systemData
        if mbs.NumberOfGeneralContacts():
            raise InputError(
                "SolveDynamicSparse.mbs must have no GeneralContact, whose stiffness Exudyn does not return; use "
                "contact objects (ObjectContact...), or mbs.SolveDynamic."
            )
        self.coordinates, self.constraints = len(data.GetODE2Coordinates()), len(data.GetAECoordinates())
        self.parts: list[Callable] = []
        self.meshes: list[Callable] = []
        self.films: list[tuple[NodalFilmElement, np.ndarray]] = []
        self.mesh = np.zeros(self.coordinates + self.constraints, dtype=bool)
        for number in range(data.NumberOfNodes()):
            kind = mbs.GetNode(NodeIndex(number))["nodeType"]
            if "LG" in kind or "LieGroup" in kind:
                raise InputError(
                    f"SolveDynamicSparse.mbs must have additive coordinates only, got node {number} of type {kind}; "
                    "create rigid bodies with nodeType=exu.NodeType.RotationEulerParameters or RotationRxyz, or use "
                    "mbs.SolveDynamic."
                )
            if kind == "RigidBodyEP":
                self.parts.append(_euler_parameters(mbs, NodeIndex(number), self.coordinates))
        if len(data.GetODE1Coordinates()):
            raise InputError(
                "SolveDynamicSparse.mbs must have second-order coordinates only, got "
                f"{len(data.GetODE1Coordinates())} of first order; use mbs.SolveDynamic."
            )
        for number in range(data.NumberOfObjects()):
            item = ObjectIndex(number)
            places = np.array(data.GetObjectLTGODE2(item), dtype=np.int32)
            if len(places):
                self._add(mbs, item, places)

    def _add(self, mbs: exu.MainSystem, item: Index, places: np.ndarray) -> None:
        """Look up an object with coordinates at ``places`` of the system's."""
        owner = force_owner(mbs, int(item))
        if isinstance(owner, NodalFilmElement):
            self.films.append((owner, places))
        elif isinstance(owner, BushEquations):
            self.meshes.append(_generic(mbs, item, places))
            self.mesh[places[: owner.count]] = True
        elif mbs.GetObject(item)["objectType"] == "GenericODE2":
            self.parts.append(_generic(mbs, item, places))
        else:
            equations = self.coordinates + np.array(mbs.systemData.GetObjectLTGAE(int(item)), dtype=np.int32)
            self.parts.append(_standard(mbs, item, places, equations))

    def film_operators(
        self, mbs: exu.MainSystem, solver: exu.MainSolverImplicitSecondOrder
    ) -> list[tuple[np.ndarray, Callable]]:
        """Places and operators of the films on nodal bushes at the current state, scaled by beta h^2."""
        if not self.films:
            return []
        h, data = solver.it.currentStepSize, mbs.systemData
        q, q_t, t = (np.asarray(data.GetODE2Coordinates()), np.asarray(data.GetODE2Coordinates_t()), data.GetTime())
        factors = solver.newmarkBeta * h * h, solver.newmarkGamma * h
        made = ((places, film.operator(mbs, t, q[places], q_t[places], *factors)) for film, places in self.films)
        return [(places, operator) for places, operator in made if operator is not None]

    def assemble(
        self,
        mbs: exu.MainSystem,
        solver: exu.MainSolverImplicitSecondOrder,
        *,
        index2: bool = False,
        meshes: bool = True,
    ) -> csc_matrix:
        """Return the iteration matrix of the current state, scaled by beta h^2.

        ``index2`` says that all constraints are solved for velocities (``useIndex2Constraints``); without ``meshes``
        the rows of bushes' nodes lack them.
        """
        h, rate = solver.it.currentStepSize, solver.newmarkGamma / solver.newmarkBeta / solver.it.currentStepSize
        square = solver.newmarkBeta * h * h
        factors = Factors(1 / solver.factJacAlgorithmic, square, solver.newmarkGamma * h, rate if index2 else 1.0, rate)
        own, size = mbs.GetSystemJacobianUserFunction(), self.coordinates + self.constraints
        none = np.zeros(0, dtype=np.int32)
        triplets = [(none, none, np.zeros(0))]
        for part in self.parts + self.meshes if meshes else self.parts:
            triplets += part(mbs, factors)
        if isinstance(own, dict):
            scales = (-square, -factors.damping, -square)
            added = as_sparse(own["function"](mbs, mbs.systemData.GetTime(), *scales))
            if added is not None:
                triplets.append(_placed(np.arange(size), 1.0, added))
        rows, columns, values = (np.concatenate(x) for x in zip(*triplets, strict=True))
        system = coo_matrix((values, (rows, columns)), shape=(size, size)).tocsc()
        if self.constraints:
            # rows of inactive constraints are lambda = 0
            idle = np.flatnonzero(np.asarray(abs(system).sum(axis=1)).ravel() == 0)
            system = (system + coo_matrix((np.full(len(idle), 1 / square), (idle, idle)), shape=(size, size))).tocsc()
        return system


def _generic(mbs: exu.MainSystem, item: Index, places: np.ndarray) -> Callable:
    """Triplets of an ObjectGenericODE2 through its own functions and matrices."""

    names = ("forceUserFunction", "jacobianUserFunction", "massMatrixUserFunction")
    found = {name: mbs.GetObjectParameter(item, name) for name in names}
    force, jacobian, mass = (value["function"] if isinstance(value, dict) else None for value in found.values())
    if jacobian is None and force is not None:
        raise InputError(
            f"SolveDynamicSparse: object {int(item)} has a forceUserFunction, so it must have a jacobianUserFunction, "
            "got none; add one, or use mbs.SolveDynamic, which differentiates numerically."
        )
    constant = [
        as_sparse(mbs.GetObjectParameter(item, name)) for name in ("massMatrix", "stiffnessMatrix", "dampingMatrix")
    ]

    def part(mbs, factors: Factors):
        fM, fK, fD = factors[:3]
        data = mbs.systemData
        q = np.asarray(data.GetODE2Coordinates())[places]
        q_t = np.asarray(data.GetODE2Coordinates_t())[places]
        t = data.GetTime()
        terms = list(zip((fM, fK, fD), constant, strict=True))
        if jacobian is not None:
            terms.append((1.0, as_sparse(jacobian(mbs, t, int(item), q, q_t, fK, fD))))
        if mass is not None:
            terms.append((fM, as_sparse(mass(mbs, t, int(item), q, q_t))))
        return [_placed(places, factor, matrix) for factor, matrix in terms if matrix is not None]

    return part


def _placed(places: np.ndarray, factor: float, matrix: csr_matrix) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triplets of a matrix at an object's places in the system."""
    entries = matrix.tocoo()
    return places[entries.row], places[entries.col], factor * entries.data


def _standard(mbs: exu.MainSystem, item: Index, places: np.ndarray, equations: np.ndarray) -> Callable:
    """Triplets of a body, connector or constraint through Exudyn's own matrices."""
    kind = exu.ComputeItemType
    offered = mbs.ComputeItem(item)
    constrained = kind.ConstraintJacobian in offered and len(equations) > 0
    values = mbs.GetObject(item)
    object_type = values["objectType"]
    hidden = is_hidden(object_type)
    matrices = enumerate((kind.MassMatrix, kind.JacobianODE2, kind.JacobianODE2_t))
    terms = [(k, i) for i, k in matrices if k in offered and not (hidden and k is kind.MassMatrix)]
    if constrained and object_type not in _CONSTRAINTS:
        raise InputError(
            f"SolveDynamicSparse.mbs must hold constraints between markers only, got object {int(item)} of type "
            f"{object_type}, whose algebraic equations have coordinates of their own; use mbs.SolveDynamic."
        )
    # solved for velocities whatever the settings are
    by_rates = object_type == "JointRollingDisc" or bool(values.get("velocityLevel", False))
    for what, _ in terms:
        try:
            mbs.ComputeItem(item, what)
        except exu.ExudynError as error:
            raise InputError(
                f"SolveDynamicSparse.mbs must hold objects whose matrices Exudyn returns, got object {int(item)} of "
                f"type {object_type} without {what.name}; use mbs.SolveDynamic for this model."
            ) from error
    differs = kind.ODE2LHS in offered and kind.JacobianODE2 not in offered and object_type not in _SIMPLE
    # a reduced body without its own terms has no forces but a user's
    differs = differs and (values.get("computeFFRFterms", True) or values["forceUserFunction"] != 0)
    rows, columns = (x.ravel() for x in np.meshgrid(places, places, indexing="ij"))

    def part(mbs, factors: Factors):
        values = np.zeros((len(places), len(places)))
        if hidden:
            values += factors.mass * hidden_mass(mbs, item, len(places))
        for what, i in terms:
            matrix = np.asarray(mbs.ComputeItem(item, what))
            if matrix.size:
                values += factors[i] * matrix
        if differs:
            values += _differences(mbs, item, places, factors.stiffness, factors.damping)
        own = [(rows, columns, values.ravel())]
        if not constrained:
            return own
        C = coo_matrix(np.asarray(mbs.ComputeItem(item, kind.ConstraintJacobian)))
        a, q = equations[C.row], places[C.col]
        return [*own, (a, q, (factors.velocity if by_rates else factors.position) * C.data), (q, a, C.data)]

    return part


def _differences(mbs: exu.MainSystem, item: Index, places: np.ndarray, fK: float, fD: float) -> np.ndarray:
    """fK K + fD D (n, n) of an object by differences of its forces, with the steps that Exudyn uses."""
    kind, data = exu.ComputeItemType.ODE2LHS, mbs.systemData
    out = np.zeros((len(places), len(places)))
    for factor, read, write in (
        (fK, data.GetODE2Coordinates, data.SetODE2Coordinates),
        (fD, data.GetODE2Coordinates_t, data.SetODE2Coordinates_t),
    ):
        if factor == 0.0:
            continue
        state = np.array(read())
        still = np.array(mbs.ComputeItem(item, kind))
        # a coordinate that an object lists twice is moved once
        for column, place in zip(*np.unique(places, return_index=True)[::-1], strict=True):
            moved = state.copy()
            step = _STEPS.relativeEpsilon * (_STEPS.minimumCoordinateSize + abs(state[place]))
            moved[place] += step
            write(moved.tolist())
            out[:, column] += factor / step * (np.array(mbs.ComputeItem(item, kind)) - still)
        write(state.tolist())
    return out


def _euler_parameters(mbs: exu.MainSystem, node: Index, n: int) -> Callable:
    """Triplets of a node's norm condition theta.theta - 1 = 0, which no object returns."""
    data = mbs.systemData
    columns = np.array(data.GetNodeLTGODE2(int(node)), dtype=np.int32)[3:]
    rows = np.full(4, n + data.GetNodeLTGAE(int(node))[0], dtype=np.int32)
    reference = np.array(mbs.GetNode(node)["referenceCoordinates"], dtype=float)[3:]

    def part(mbs, factors: Factors):
        slope = 2 * (reference + np.asarray(mbs.systemData.GetODE2Coordinates())[columns])
        return [(rows, columns, factors.position * slope), (columns, rows, slope)]

    return part
