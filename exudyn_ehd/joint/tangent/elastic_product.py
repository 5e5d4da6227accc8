"""Products of the tangent of a film on a flexible bore with vectors, one film solve each: what an iterative solver needs.

With the balances r(u, m, delta, delta_t) = 0 of the film's unknowns u,

    A du = -(dr/dm dm + dr/d delta S dq + dr/d delta_t S dq_t),   dQ = S^T W du + (contacts);

the six rows of the wrench are made once, by adjoint solves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.sensitivity.bore_stencil import balance_change
from exudyn_ehd.joint.tangent.bore import Balances, contact_slope, load_weights, wrench_rows

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.flexible import ElasticBearingModel


class TangentProduct:
    """Tangent of the last evaluation of a model as an operator; valid until the next one.

    Attributes
    ----------
    wrench : (6, 10) array
        d wrench / d motion.
    wrench_place, wrench_rate : (6, k) arrays
        d wrench / dq, / dq_t.
    """

    def __init__(self, model: ElasticBearingModel) -> None:
        self.model = model
        self.serial = model.serial
        balances = Balances(model)
        self.wrench, self.wrench_place, self.wrench_rate = wrench_rows(model, balances)
        self.motion = balances.motion * model.motion_scale
        self.by_place, self.vertices = balances.stencil(1.0, 0.0)
        # the rate acts on a vertex's own storage alone
        self.by_rate = balances.stencil(0.0, 1.0)[0][:, 0]
        self.places = balances.places
        self.weight = -model.force_scale * load_weights(model)
        self.contact: np.ndarray | None = None
        if model.pressing is not None:
            self.contact = contact_slope(model)
            z = model.grid.z
            cos, sin = self.contact * model.cos_x[:, None], self.contact * model.sin_x[:, None]
            fields = model.bore.contract(np.stack([cos, sin, cos * z, sin * z]))
            self.contact_motion = -fields.T * model.pose_scale
            self.contact = self.contact / model.bearing.radial_clearance

    def bore_load(self, motion: np.ndarray, place: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Change of the bore's loads (k,) with changes of motion (10,), q and q_t (k,).

        Raises
        ------
        RuntimeError
            If the model has evaluated another state since.
        """
        model = self.model
        moved, residual = self.residual(motion, place, rate)
        field = np.zeros(moved.shape)
        field.reshape(-1)[self.places] = self.weight * residual
        if self.contact is None:
            return model.bore.load(field)
        return model.bore.load(field + self.contact * moved) + self.contact_motion @ motion[:4]

    def residual(self, motion: np.ndarray, place: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (n, m) of the bore, m, and minus the change (count,) of the film's unknowns."""
        model = self.model
        if model.serial != self.serial:
            raise RuntimeError("TangentProduct: the model has evaluated another state since.")
        moved, speed = model.bore.displacements(place, rate)
        residual = np.empty(len(self.places))
        balance_change(
            self.motion,
            self.by_place,
            self.vertices,
            self.by_rate,
            motion,
            moved.reshape(-1),
            speed.reshape(-1),
            residual,
        )
        model.solver.direct(residual)
        return moved, residual
