"""The equations of a user's ObjectFFRFreducedOrder, with an exact Jacobian.

Exudyn differentiates that object by differences, by each of its coordinates and rates. Without its own terms
(``computeFFRFterms=False``) it has neither forces nor mass, and its differences cost next to nothing, while its
markers, sensors, loads and drawing go on. An ObjectGenericODE2 on the same two nodes has the equations instead
(`exudyn_ehd.coupling.kinematics.floating_body`).
"""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.coupling.contract import Index, NodeIndex, ObjectIndex
from exudyn_ehd.coupling.items.bodies import NODE_KINDS
from exudyn_ehd.coupling.kinematics.floating_body import BodyIntegrals, FloatingBody
from exudyn_ehd.coupling.kinematics.sides import NodeSide
from exudyn_ehd.status import InputError


def own_equations(mbs: exu.MainSystem, body: Index) -> Index:
    """Move the equations of a body to an object of their own, before Assemble; returns that object."""
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
        node = NodeIndex(self.nodes[0])
        values = mbs.GetNode(node)
        reference = np.array(values["referenceCoordinates"], dtype=float)
        self.frame = NodeSide(NODE_KINDS[values["nodeType"]], node, reference, np.zeros(3), np.eye(3))
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
        """The body with its matrices, read once in a run whose solver is stored, and in every call else."""
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
