"""Mass matrices of Exudyn's objects, also of those that do not return them; checks of housings and of deleted items.

Equations of a user's ObjectFFRFreducedOrder, with an exact Jacobian
--------------------------------------------------------------------
Exudyn differentiates that object numerically by each of its coordinates and rates. With ``computeFFRFterms=False`` it
has neither forces nor mass, so that the differentiation costs next to nothing; markers, sensors, loads and drawing
still work. An ObjectGenericODE2 on the same two nodes has the equations instead
(`exudyn_ehd.coupling.kinematics.flexible_bodies`).
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, issparse

from exudyn_ehd.coupling.contract import Index, NodeIndex, ObjectIndex, Side
from exudyn_ehd.coupling.items.bodies import Item, body_of_node
from exudyn_ehd.coupling.kinematics.flexible_bodies import BodyIntegrals, FloatingBody
from exudyn_ehd.coupling.kinematics.sides import MarkerSide, node_side
from exudyn_ehd.status import ROUNDING, SMALL, InputError, warn_user

_OR_GRAVITY = "give the joint bushGravity=(...): the bush's mass then counts beside the housing's, with this gravity"


def own_equations(mbs: exu.MainSystem, body: Index) -> Index:
    """Move the equations of a body to a separate object, before Assemble; return that object."""
    equations = ReducedBody(mbs, body)
    mbs.SetObjectParameter(body, "computeFFRFterms", False)
    return mbs.AddObject(
        eii.ObjectGenericODE2(
            name=f"equations of object {int(body)}",
            nodeNumbers=list(mbs.GetObjectParameter(body, "nodeNumbers")),
            forceUserFunction=equations.force,
            massMatrixUserFunction=equations.mass,
            jacobianUserFunction=equations.jacobian,
            visualization=eii.VObjectGenericODE2(show=False),
        )
    )


class ReducedBody:
    """User functions of the object with a body's equations.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    body : exudyn.ObjectIndex
        An ObjectFFRFreducedOrder.
    """

    def __init__(self, mbs: exu.MainSystem, body: Index) -> None:
        self.body = ObjectIndex(int(body))
        self.nodes = [int(node) for node in mbs.GetObjectParameter(body, "nodeNumbers")]
        self.frame = node_side(mbs, NodeIndex(self.nodes[0]))
        self._solvers: tuple[object, object] = (None, None)

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """User function of Exudyn: forces (n + k,) on the right-hand side."""
        return -self._bound(mbs).left_hand_side(np.array(q), np.array(q_t))

    def mass(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """User function of Exudyn: mass matrix (n + k, n + k)."""
        return self._bound(mbs).mass(np.array(q))

    def jacobian(
        self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> np.ndarray:
        """User function of Exudyn: derivative (n + k, n + k) of the left-hand side."""
        return self._bound(mbs).derivative(np.array(q), np.array(q_t), f_q, f_qt)

    def _bound(self, mbs: exu.MainSystem) -> FloatingBody:
        """Return the body with its matrices: read once per run if the solver is stored, else in every call."""
        stored = mbs.sys
        solvers = stored.get("dynamicSolver"), stored.get("staticSolver")
        at_work = any(solver is not None and not solver.output.finishedSuccessfully for solver in solvers)
        if not at_work or solvers[0] is not self._solvers[0] or solvers[1] is not self._solvers[1]:
            if not self._is_there(mbs):
                raise InputError(
                    f"ReplaceReducedBody: the body, object {int(self.body)} on nodes {self.nodes}, has another number "
                    "since items of the system were deleted, or has its own terms again; delete items before, and "
                    "leave computeFFRFterms."
                )
            self._solvers = solvers
            self._body = FloatingBody(self.frame, body_integrals(mbs, self.body))
        return self._body

    def _is_there(self, mbs: exu.MainSystem) -> bool:
        try:
            nodes = [int(node) for node in mbs.GetObjectParameter(self.body, "nodeNumbers")]
            return nodes == self.nodes and not mbs.GetObjectParameter(self.body, "computeFFRFterms")
        except exu.ExudynError:
            return False


def body_integrals(mbs: exu.MainSystem, body: Index) -> BodyIntegrals:
    """Integrals of an ObjectFFRFreducedOrder, from its parameters."""

    def values(name: str) -> np.ndarray:
        return np.array(mbs.GetObjectParameter(body, name), dtype=float)

    def dense(name: str) -> np.ndarray:
        matrix = np.asarray(mbs.GetObjectParameter(body, name).Convert2DenseMatrix(), dtype=float)
        return matrix if matrix.size else np.zeros((k, k))

    S, mass = values("mPhitTPsi"), float(mbs.GetObjectParameter(body, "mass"))
    k = S.shape[1]
    return BodyIntegrals(
        mass=mass,
        moment=mass * values("centerOfMass"),
        inertia=values("inertia"),
        S=S,
        T=values("mXRefTildePsi"),
        X=values("mXRefTildePsiTilde").reshape(3, k, 3).transpose(1, 0, 2),
        P=values("mPsiTildePsiTilde").reshape(k, 3, k, 3).transpose(0, 2, 1, 3),
        C=values("mPsiTildePsi").reshape(k, 3, k).transpose(0, 2, 1),
        modal_mass=dense("massMatrixReduced"),
        stiffness=dense("stiffnessMatrixReduced"),
        damping=dense("dampingMatrixReduced"),
    )


def object_mass(mbs: exu.MainSystem, item: Index) -> np.ndarray | csc_matrix | None:
    """Mass matrix (n, n) of an object in its own coordinates; None if Exudyn returns none and it is not constant."""
    data = mbs.GetObject(item)
    if data["objectType"] == "GenericODE2":
        body = force_owner(mbs, int(item), "massMatrixUserFunction")
        if isinstance(body, ReducedBody):
            q = np.asarray(mbs.systemData.GetODE2Coordinates())[mbs.systemData.GetObjectLTGODE2(int(item))]
            return body.mass(mbs, 0.0, int(item), q.tolist(), [])
        matrix = as_sparse(data["massMatrix"])
        return None if matrix is None or matrix.nnz == 0 else matrix.tocsc()
    if is_hidden(data["objectType"]):
        return hidden_mass(mbs, item, len(mbs.systemData.GetObjectLTGODE2(int(item))))
    if exu.ComputeItemType.MassMatrix not in mbs.ComputeItem(item):
        return None
    matrix = np.asarray(mbs.ComputeItem(item, exu.ComputeItemType.MassMatrix))
    return matrix if matrix.size else None


def is_hidden(object_type: str) -> bool:
    """Return whether Exudyn keeps the mass matrix of such an object sparse and can't return it."""
    return object_type.startswith("MassPoint") or object_type == "RigidBody2D"


def hidden_mass(mbs: exu.MainSystem, item: Index, size: int) -> np.ndarray:
    """Mass matrix (n, n) of a mass point or a planar rigid body: density times position Jacobian.

    Of a planar body these are the first two rows, also with the centre of mass off the node.
    """
    mass = np.array(mbs.ComputeItem(item, exu.ComputeItemType.MassWeightedPositionJacobian))[:size]
    if mass.shape[1] == 3 and "inertia" in mbs.GetObject(item):
        mass[2, :2], mass[2, 2] = mass[:2, 2], float(mbs.GetObjectParameter(item, "inertia"))
    return mass


def as_sparse(value) -> csr_matrix | None:
    """Return a matrix of a user function or an object in sparse form; None if there is none."""
    if isinstance(value, exu.MatrixContainer):
        value = value.GetPythonObject()
    if isinstance(value, dict):
        shape = (value["numberOfRows"], value["numberOfColumns"])
        triplets = np.asarray(value["triplets"]).reshape(-1, 3)
        return csr_matrix((triplets[:, 2], (triplets[:, 0].astype(int), triplets[:, 1].astype(int))), shape=shape)
    if issparse(value):
        return value.tocsr()
    dense = np.atleast_2d(np.asarray(value, dtype=float))
    return None if dense.size == 0 else csr_matrix(dense)


def require_heavy_housing(mbs: exu.MainSystem, housing: Item, bush: float, name: str) -> None:
    """Raise `InputError` if a rigid housing is lighter than the bush, which is a part of it: ``bush`` kg."""
    body = None if housing.kind is None or not housing.nodes else body_of_node(mbs, housing.nodes[0])
    if body is None:
        return
    mass = float(mbs.GetObject(body)["mass"])
    if mass < bush * (1.0 - SMALL):
        raise InputError(
            f"CreateLubricatedJoint '{name}': the housing (object {int(body)}) has a mass of {mass:.4g} kg, its "
            f"ANCFBush has {bush:.4g} kg, but the body's mass and inertia contain the bush's: add the bush's to the "
            f"body, or {_OR_GRAVITY}."
        )


def warn_if_indefinite(mbs: exu.MainSystem, nodes: Sequence[Index], change: np.ndarray, bush: float, name: str) -> None:
    """Warn if the housing has less mass than the bush that it must contain: the mass matrix is then indefinite.

    Call it in an assembled system. It is no error, because constraints may hold a housing that is too light.

    Parameters
    ----------
    nodes : sequence
        Nodes of the housing's side, with n coordinates.
    change : (n, n) array
        Contribution of the bush to their mass with free bush coordinates (the Schur complement).
    bush, name
        As in `require_heavy_housing`.
    """
    data = mbs.systemData
    places = np.concatenate([data.GetNodeLTGODE2(int(node)) for node in nodes])
    whole = np.zeros_like(change)
    for number in range(data.NumberOfObjects()):
        item = ObjectIndex(number)
        coordinates = np.asarray(data.GetObjectLTGODE2(item), dtype=int)
        here, there = np.nonzero(coordinates[:, None] == places)
        matrix = object_mass(mbs, item) if len(here) else None
        if matrix is not None:
            whole[np.ix_(there, there)] += matrix[here][:, here]
    size = np.sqrt(np.maximum(np.diag(whole), np.abs(np.diag(change))))
    moved = size > ROUNDING * size.max()
    scaled = (whole + change)[np.ix_(moved, moved)] / np.outer(size[moved], size[moved])
    if np.linalg.eigvalsh(scaled)[0] < -SMALL:
        warn_user(
            f"LubricatedJoint '{name}': the mass matrix of housing and bush is indefinite; what carries the "
            f"ANCFBush of {bush:.4g} kg is lighter than it there, or has less rotary inertia, but must contain the "
            f"bush's: add them to the housing, or {_OR_GRAVITY}.",
            UserWarning,
        )


class Presence:
    """Items of one joint as they were when it was created.

    Exudyn's DeleteObject, DeleteNode and DeleteMarker renumber the remaining items, and Reset deletes all. With its old
    numbers a joint would act on other bodies.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    name : str
        Name of the joint.
    owner : object
        Object whose method is the force function of the joint's object.
    number : exudyn.ObjectIndex
        The joint's object.
    sides : pair of Side
    """

    def __init__(self, mbs: exu.MainSystem, name: str, owner: object, number: Index, sides: tuple[Side, Side]) -> None:
        self.name, self.owner, self.number = name, weakref.ref(owner), int(number)
        self.nodes = _nodes(mbs, self.number)
        self.markers = [(side.marker, _marker(mbs, side.marker)) for side in sides if isinstance(side, MarkerSide)]

    def found(self, mbs: exu.MainSystem) -> int | None:
        """Number of the joint's object in the system; None if it is not there."""
        count = mbs.systemData.NumberOfObjects()
        for number in (self.number, *range(count)):
            if number < count and force_owner(mbs, number) is self.owner():
                return number
        return None

    def require(self, mbs: exu.MainSystem) -> None:
        """Raise `InputError` unless the joint is in the system, on the items that it was made on."""
        if (number := self.found(mbs)) is None:
            raise InputError(
                f"LubricatedJoint '{self.name}': its object is no longer in the system, after mbs.Reset() or "
                "mbs.DeleteObject(...); create the joint again."
            )
        nodes = _nodes(mbs, number)
        count = mbs.systemData.NumberOfMarkers()
        same = all(int(marker) < count and _marker(mbs, marker) == as_made for marker, as_made in self.markers)
        if not (same and number == self.number and nodes == self.nodes):
            raise InputError(
                f"LubricatedJoint '{self.name}': items of the system were deleted after the joint was created, and "
                f"Exudyn has renumbered the others: the joint's object {self.number} on nodes {self.nodes} is now "
                f"object {number} on nodes {nodes}; delete items before CreateLubricatedJoint."
            )


def force_owner(mbs: exu.MainSystem, number: int, name: str = "forceUserFunction") -> object:
    """Return the Python object whose method is a user function, by default the force, of an Exudyn object; or None."""
    item = ObjectIndex(number)
    # only some objects have a force function
    if mbs.GetObject(item)["objectType"] != "GenericODE2":
        return None
    function: Any = mbs.GetObjectParameter(item, name)
    return getattr(function["function"], "__self__", None) if isinstance(function, dict) else None


def _nodes(mbs: exu.MainSystem, number: int) -> list[int]:
    return [int(node) for node in mbs.GetObjectParameter(ObjectIndex(number), "nodeNumbers")]


def _marker(mbs: exu.MainSystem, number: Index) -> str:
    values = mbs.GetMarker(number)
    return repr({key: value for key, value in values.items() if key != "name" and not key.startswith("V")})
