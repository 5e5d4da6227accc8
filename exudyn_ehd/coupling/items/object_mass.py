"""Mass matrices of Exudyn's objects, also of those that don't return them."""

from __future__ import annotations

from collections.abc import Callable

import exudyn as exu
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, issparse

from exudyn_ehd.coupling.contract import Index


def object_mass(mbs: exu.MainSystem, item: Index) -> np.ndarray | csc_matrix | None:
    """Mass matrix (n, n) of an object in its own coordinates; None if Exudyn returns none and it is not constant."""
    data = mbs.GetObject(item)
    if data["objectType"] == "GenericODE2":
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
