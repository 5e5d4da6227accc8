"""Mass matrices of Exudyn's objects, also of those that don't return them; whether a housing contains its bush."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, issparse

from exudyn_ehd.coupling.contract import Index, ObjectIndex
from exudyn_ehd.coupling.items.bodies import body_of_node
from exudyn_ehd.coupling.items.own_equations import ReducedBody
from exudyn_ehd.status import InputError

# Negative eigenvalue of a scaled mass matrix that is none of rounding.
INDEFINITE = -1e-6


def object_mass(mbs: exu.MainSystem, item: Index) -> np.ndarray | csc_matrix | None:
    """Mass matrix (n, n) of an object in its own coordinates; None if Exudyn returns none and it is not constant."""
    data = mbs.GetObject(item)
    if data["objectType"] == "GenericODE2":
        function: Any = data["massMatrixUserFunction"]
        body = getattr(function["function"], "__self__", None) if isinstance(function, dict) else None
        if isinstance(body, ReducedBody):
            q = np.asarray(mbs.systemData.GetODE2Coordinates())[mbs.systemData.GetObjectLTGODE2(int(item))]
            return body.mass(mbs, 0.0, int(item), q.tolist(), [])
        matrix = as_sparse(data["massMatrix"])
        return None if matrix is None or matrix.nnz == 0 else matrix.tocsc()
    if data["objectType"].startswith("MassPoint"):
        return point_mass(mbs, item, len(mbs.systemData.GetObjectLTGODE2(int(item))))(mbs)
    if data["objectType"] == "RigidBody2D":
        return planar_mass(mbs, item)(mbs)
    if exu.ComputeItemType.MassMatrix not in mbs.ComputeItem(item):
        return None
    matrix = np.asarray(mbs.ComputeItem(item, exu.ComputeItemType.MassMatrix))
    return matrix if matrix.size else None


def point_mass(mbs: exu.MainSystem, item: Index, size: int) -> Callable:
    """Mass matrix of a mass point: density times position Jacobian."""
    mass = np.asarray(mbs.ComputeItem(item, exu.ComputeItemType.MassWeightedPositionJacobian))[:size]
    return lambda mbs: mass


def planar_mass(mbs: exu.MainSystem, item: Index) -> Callable:
    """Mass matrix of a planar rigid body.

    Density times position Jacobian are its first two rows, also with the centre of mass off the node.
    """
    inertia = float(mbs.GetObjectParameter(item, "inertia"))

    def mass(mbs: exu.MainSystem) -> np.ndarray:
        out = np.zeros((3, 3))
        out[:2] = np.asarray(mbs.ComputeItem(item, exu.ComputeItemType.MassWeightedPositionJacobian))[:2]
        out[2, :2], out[2, 2] = out[:2, 2], inertia
        return out

    return mass


def as_sparse(value) -> coo_matrix | None:
    """A matrix that a user function or an object holds, as triplets."""
    if isinstance(value, exu.MatrixContainer):
        value = value.GetPythonObject()
    if isinstance(value, dict):
        shape = (value["numberOfRows"], value["numberOfColumns"])
        triplets = np.asarray(value["triplets"]).reshape(-1, 3)
        return coo_matrix((triplets[:, 2], (triplets[:, 0].astype(int), triplets[:, 1].astype(int))), shape=shape)
    if issparse(value):
        return value.tocoo()
    dense = np.atleast_2d(np.asarray(value, dtype=float))
    return None if dense.size == 0 else coo_matrix(dense)


def require_heavy_housing(mbs: exu.MainSystem, node: Index | None, bush: tuple[str, float, str], name: str) -> None:
    """Raise `InputError` if the rigid body on a node is lighter than the bush, which is a part of it.

    ``bush`` is what messages call it, its mass [kg], and what else to do.
    """
    body = None if node is None else body_of_node(mbs, node)
    if body is None:
        return
    mass, (kind, own, remedy) = float(mbs.GetObject(body)["mass"]), bush
    if mass < own * (1.0 - 1e-6):
        raise InputError(
            f"CreateLubricatedJoint '{name}': the housing (object {int(body)}) has a mass of {mass:.4g} kg, its {kind} "
            f"has {own:.4g} kg, but the body's mass and inertia contain the bush's: add the bush's to the body, or "
            f"{remedy}."
        )


def warn_if_indefinite(
    mbs: exu.MainSystem, nodes: Sequence[Index], change: np.ndarray, bush: tuple[str, float, str], name: str
) -> None:
    """Warn if what carries the bush has not its mass: the mass matrix is then indefinite.

    To be called once the system is assembled. No error: constraints may hold what is too light.

    Parameters
    ----------
    nodes : sequence
        Nodes of the housing's side, with n coordinates.
    change : (n, n) array
        What the bush adds to their mass when its own coordinates move as they like (the Schur complement).
    bush, name
        As in `require_heavy_housing`.
    """
    data, (kind, own, remedy) = mbs.systemData, bush
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
    moved = size > 1e-9 * size.max()
    scaled = (whole + change)[np.ix_(moved, moved)] / np.outer(size[moved], size[moved])
    if np.linalg.eigvalsh(scaled)[0] < INDEFINITE:
        warnings.warn(
            f"LubricatedJoint '{name}': the mass matrix of housing and bush is indefinite; what carries the {kind} of "
            f"{own:.4g} kg is lighter than it there, or has less rotary inertia, but must contain the bush's: add them "
            f"to the housing, or {remedy}.",
            stacklevel=2,
        )
