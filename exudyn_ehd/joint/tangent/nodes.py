"""Exact tangent of the forces of a film on the nodes of a bore, pressure and shear, as matrix and as operator.

As in `elastic_tangent`, with rows of three forces per node in place of the loads on the radial displacements: the weights of the film's
unknowns in them are ``E^T`` times the vertex forces' derivatives (`traction.TractionChange`), and one adjoint solve each gives their gradients.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import diags

from exudyn_ehd.film.banded.many_sides import make_tiles
from exudyn_ehd.film.sensitivity.bore_stencil import put_rows
from exudyn_ehd.joint.tangent.bore import Balances, wrench_weights
from exudyn_ehd.joint.tangent.elastic_product import TangentProduct
from exudyn_ehd.joint.tangent.traction import BoreForces, TractionChange
from exudyn_ehd.joint.tangent.wrench import SIZE, adjoint_rows, wrench_tangent

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.flexible import ElasticBearingModel


def nodal_tangent(model: ElasticBearingModel, forces: BoreForces) -> tuple[np.ndarray, np.ndarray]:
    """Tangent of wrench and nodal forces of the last evaluation, SI units.

    Returns
    -------
    wrench : (6, 10 + 2 k) array
    nodal : (nodes, 3, 10 + 2 k) array
        d/d motion, then d/dq and d/dq_t.
    """
    k, rows = model.bore.size, 3 * forces.count
    change, balances = TractionChange(model, forces), Balances(model)
    integrals = adjoint_rows(model)
    count, unknowns = integrals.shape
    lam = make_tiles(integrals, count + rows)
    loads = np.ascontiguousarray(forces.rows(change.by_unknown()).T.toarray())
    put_rows(loads, np.arange(unknowns), np.ones(unknowns), count, lam)
    model.solver.adjoint_columns(lam)
    gradient = -balances.gradient(lam).transpose(0, 2, 1).reshape(-1, SIZE)
    wrench, nodal = np.empty((6, SIZE + 2 * k)), np.empty((rows, SIZE + 2 * k))
    wrench[:, :SIZE] = wrench_tangent(model, gradient=gradient[:count])
    nodal[:, :SIZE] = gradient[count : count + rows] * model.motion_scale + _by_motion(model, forces, change)
    weights, direct = wrench_weights(model)
    c = model.bearing.radial_clearance
    gaps = [diags(field) for field in change.gap]
    slope = diags(change.slope)
    gaps[1:] = [gap + slope @ along for gap, along in zip(gaps[1:], (forces.slope_x, forces.slope_z), strict=True)]
    shapes = model.bore.shapes  # type: ignore[attr-defined]
    at_once = (forces.rows(gaps) @ shapes).toarray() / c
    for i, (by_gap, by_rate) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        part = slice(SIZE + i * k, SIZE + (i + 1) * k)
        by_bore = model.bore.project(*balances.stencil(-by_gap, -by_rate), lam, count + rows)
        wrench[:, part] = weights @ by_bore[:count] + by_gap * direct
        nodal[:, part] = by_bore[count:] + by_gap * at_once
    return wrench, forces.by_node(nodal)


class NodalProduct(TangentProduct):
    """The same as an operator, one film solve per product; valid until the model's next evaluation."""

    def __init__(self, model: ElasticBearingModel, forces: BoreForces) -> None:
        super().__init__(model)
        self.forces, self.change = forces, TractionChange(model, forces)
        self.columns = _pose_columns(model) * model.pose_scale

    def nodal_forces(self, motion: np.ndarray, place: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Change (nodes, 3) with changes of motion (10,), q and q_t (k,).

        Raises
        ------
        RuntimeError
            If the model has evaluated another state since.
        """
        moved, residual = self.residual(motion, place, rate)
        scaled = moved.ravel() / self.model.bearing.radial_clearance
        gap = scaled - self.columns @ motion[:4]
        forces = self.change.vertex_forces(-residual, gap, scaled, motion[8:])
        return self.forces.nodal(forces)


def _pose_columns(model: ElasticBearingModel) -> np.ndarray:
    """Minus dH / d(scaled pose) (n m, 4)."""
    z = model.grid.z
    cos, sin = np.repeat(model.cos_x, z.size), np.repeat(model.sin_x, z.size)
    heights = np.tile(z, model.cos_x.size)
    return np.column_stack((cos, sin, cos * heights, sin * heights))


def _by_motion(model: ElasticBearingModel, forces: BoreForces, change: TractionChange) -> np.ndarray:
    """Derivatives (3 nodes, 10) to the motion at fixed unknowns; rows by direction as in `BoreForces.rows`."""
    vertex = np.zeros((SIZE, *change.gap.shape))
    columns = _pose_columns(model) * model.pose_scale
    for j in range(4):
        vertex[j] = -change.gap * columns[:, j]
    vertex[8], vertex[9] = change.speed[:, :, 0], change.speed[:, :, 1]
    out = np.zeros((3 * forces.count, SIZE))
    for j in (0, 1, 2, 3, 8, 9):
        out[:, j] = forces.nodal(vertex[j]).T.ravel()
    return out
