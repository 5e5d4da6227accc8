"""A bearing whose bore is flexible: the rigid surfaces' model with ``delta = S q`` in the gap.

The motion (10,) of the rigid surfaces is followed by the bore's coordinates and rates,

    motion = [x, y, ..., omega, w, q_1 .. q_k, dq_1/dt .. dq_k/dt];

the wrench on the journal is accompanied by the generalised loads Q = S^T (p A) on q. The bush resists q outside of this model; only
`evaluate_steady` knows its stiffness K and finds the q with K q = Q.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.sensitivity.bore_stencil import add_gap
from exudyn_ehd.joint.bore.equilibrium import Elasticity, condensed_tangent, settle
from exudyn_ehd.joint.bore.shapes import Bore
from exudyn_ehd.joint.evaluation import Evaluation
from exudyn_ehd.joint.model.rigid import MOTION_SIZE, BearingModel
from exudyn_ehd.joint.seams import Effects, History
from exudyn_ehd.joint.tangent.bore import elastic_tangent
from exudyn_ehd.joint.tangent.elastic_product import TangentProduct
from exudyn_ehd.joint.tangent.nodes import NodalProduct, nodal_tangent
from exudyn_ehd.joint.tangent.traction import BoreForces, traction
from exudyn_ehd.status import Status

# Panels of three Gauss points around and along the bore that integrate the load of the ends' pressure; they match the usual meshes.
END_PANELS = 120, 12


@dataclasses.dataclass(eq=False)
class ElasticEvaluation(Evaluation):
    """One film evaluation on a flexible bore.

    Attributes
    ----------
    bore_load : (k,) array
        Q, N; nan if there is no film.
    """

    bore_load: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))

    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """As `ElasticBearingModel.combined_tangent`; RuntimeError if the model has evaluated another state since."""
        self._require_current()
        model: Any = self._model
        return model.combined_tangent(by_place, by_rate)

    def tangent_product(self) -> TangentProduct:
        """As `ElasticBearingModel.tangent_product`; RuntimeError if the model has evaluated another state since."""
        self._require_current()
        model: Any = self._model
        return model.tangent_product()

    def nodal_forces(self, forces: BoreForces) -> np.ndarray:
        """Forces (nodes, 3) of pressure, shear and contacts on the nodes of a nodal bore, joint frame, N; RuntimeError as above."""
        self._require_current()
        model: Any = self._model
        shear = traction(model, forces)
        nodal = forces.nodal(np.concatenate((np.zeros((1, shear.shape[1])), shear)))
        nodal[:, :2] += self.bore_load.reshape(-1, 2)
        return nodal

    def nodal_tangent(self, forces: BoreForces) -> tuple[np.ndarray, np.ndarray]:
        """As `exudyn_ehd.joint.tangent.nodes.nodal_tangent`; RuntimeError as above."""
        self._require_current()
        model: Any = self._model
        return nodal_tangent(model, forces)

    def nodal_product(self, forces: BoreForces) -> NodalProduct:
        """The tangent of wrench and nodal forces as an operator; RuntimeError as above."""
        self._require_current()
        model: Any = self._model
        return NodalProduct(model, forces)


class BoreTerm:
    """The bore's displacement as a gap term; its field belongs to the motion being evaluated."""

    def __init__(self) -> None:
        self.displacement = np.zeros((0, 0))
        self.rate = np.zeros((0, 0))

    def field(self, history: History | None) -> np.ndarray:
        """Scaled displacement (n, m)."""
        return self.displacement


def end_load(bore: Callable[[FilmGrid], Bore], grid: FilmGrid, pressures: tuple[float, float]) -> np.ndarray:
    """What the film's weights lack in the bore's loads (k,) of the ends' pressure, N.

    The weights are made for pressures that vanish at the ends; a pressure that does not meets there the part of the bore that gives way most,
    which few vertices can't integrate (8 % in the displacement with 12 intervals). The pressure is therefore split into
    ``p0 (1 - zeta) / 2 + p1 (1 + zeta) / 2``, zeta = 2 z / L, whose loads are integrated by Gauss points, and a rest
    that vanishes at the ends. The first part has neither force nor moment on the journal.

    Parameters
    ----------
    bore : function of FilmGrid
    grid : FilmGrid
        The film's.
    pressures : (float, float)
        At -L/2 and L/2, Pa.
    """
    half = float(grid.z[-1])
    x, weight_x = _panels(0.0, 2.0 * np.pi, END_PANELS[0])
    z, weight_z = _panels(-half, half, END_PANELS[1])
    area = np.outer(weight_x, weight_z)
    points = dataclasses.replace(grid, x=x, z=z, fixed=np.zeros(area.shape, dtype=bool))

    def course(z: np.ndarray) -> np.ndarray:
        return pressures[0] + (pressures[1] - pressures[0]) * 0.5 * (1.0 + z / half)

    exact, seen = bore(points).load(course(z) * area), bore(grid).load(course(grid.z) * grid.weight)
    return (exact - seen) * grid.reference_length**2


def _panels(start: float, end: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Three Gauss points in each of ``count`` panels, and their weights."""
    nodes, weights = np.polynomial.legendre.leggauss(3)
    half = 0.5 * (end - start) / count
    return (start + half * (2.0 * np.arange(count)[:, None] + 1.0 + nodes)).ravel(), np.tile(weights * half, count)


class ElasticBearingModel(BearingModel):
    """Film between a rigid journal and a flexible bore.

    Parameters
    ----------
    bearing : JournalBearing
    bore : function of FilmGrid
        Makes the bore for the film's grid.
    elasticity : Elasticity
        What resists q in a steady state.
    start_angle, effects
        As in `BearingModel`.
    """

    def __init__(
        self,
        bearing: JournalBearing,
        bore: Callable[[FilmGrid], Bore],
        *,
        elasticity: Elasticity,
        start_angle: float = 0.0,
        effects: Effects | None = None,
    ) -> None:
        effects = Effects() if effects is None else effects
        term = BoreTerm()
        effects = dataclasses.replace(effects, gap_terms=(*effects.gap_terms, term))
        super().__init__(bearing, start_angle=start_angle, effects=effects)
        self.term = term
        self.bore = bore(self.grid)
        self.elasticity = elasticity
        self.coordinates = np.zeros(self.bore.size)
        self.bore_load = np.zeros(self.bore.size)
        self.end_load = end_load(bore, self.grid, bearing.end_pressures) if any(bearing.end_pressures) else None
        self.settling_steps = 0
        R = self.grid.reference_length
        self.area = self.grid.weight * R**2
        # SI units of the scaled motion
        self.motion_scale = np.concatenate((self.pose_scale, self.pose_scale, (0.5, 0.5 / R)))

    def _set_motion(self, motion: np.ndarray) -> None:
        """Take over a motion (10 + 2 k,); with (10,) the bore is undeformed and at rest."""
        motion = np.asarray(motion, dtype=float)
        k = self.bore.size
        if motion.size == MOTION_SIZE:
            motion = np.concatenate((motion, np.zeros(2 * k)))
        super()._set_motion(motion)
        scaled = self.motion[MOTION_SIZE:] / self.bearing.radial_clearance
        self.coordinates = self.motion[MOTION_SIZE : MOTION_SIZE + k]
        self.rates = self.motion[MOTION_SIZE + k :]
        self.term.displacement, self.term.rate = self.bore.displacements(scaled[:k], scaled[k:])

    def shape(self) -> np.ndarray | None:
        """As `BearingModel.shape`: without the bore's displacement."""
        fields = [field for field in self.gap_fields if field is not self.term.displacement]
        return np.sum(fields, axis=0) if fields else None

    def _add_gap_terms(self, history: History | None) -> float:
        s, g = self.solver, self.grid
        fields = [term.field(history) for term in self.effects.gap_terms]
        self.gap_fields = fields
        self.extra = fields[0] if len(fields) == 1 else np.sum(fields, axis=0)
        if self.extra_slope_x is None or self.extra_slope_z is None:
            self.extra_slope_x, self.extra_slope_z = np.empty(g.shape), np.empty(g.shape)
        return float(
            add_gap(
                self.extra, self.term.rate, g.width_x[0], g.z, s.H, s.HF, s.H_t, self.extra_slope_x, self.extra_slope_z
            )
        )

    def _loads(self) -> np.ndarray:
        wrench = super()._loads()
        self.bore_load = self.bore.load(self.pressure_field())
        if self.end_load is not None:
            self.bore_load += self.end_load
        return wrench

    def pressure_field(self) -> np.ndarray:
        """Force of film and contact on the bore at every vertex (n, m), N, outward."""
        field = self.P * self.area
        field *= self.pressure_scale
        if self.pressing is not None:
            for P in self.pressing.P:
                field += P * self.area
        return field

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> ElasticEvaluation:
        """Evaluate the film; ``motion`` (10 + 2 k,) as in the module's docstring, the rest as in `BearingModel`."""
        base = super().evaluate(motion, history, step, spin)
        if base.status is not Status.CONVERGED:
            self.bore_load = np.full(self.bore.size, np.nan)
        return ElasticEvaluation(
            base.status, base.motion, base.wrench, base.iterations, base._model, base._serial, self.bore_load
        )

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> ElasticEvaluation:
        """Evaluate at a motion (10,) with the bore in equilibrium under the film, q_t = 0; the rest as for `evaluate`."""
        return settle(self, motion, history, step, spin)

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d (wrench, Q) / d motion (6 + k, 10 + 2 k) of the last evaluation; nan without a film."""
        if self.status is not Status.CONVERGED:
            k = self.bore.size
            return np.full((6 + k, MOTION_SIZE + 2 * k), np.nan)
        return elastic_tangent(self, (1.0, 0.0), (0.0, 1.0))

    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """As `tangent` with the bore's columns as ``by_place d/dq + by_rate d/dq_t``, (6 + k, 10 + k): what an integrator needs."""
        if self.status is not Status.CONVERGED:
            k = self.bore.size
            return np.full((6 + k, MOTION_SIZE + k), np.nan)
        return elastic_tangent(self, (by_place, by_rate))

    def tangent_product(self) -> TangentProduct:
        """The tangent of the last evaluation, which must have found a film, as an operator."""
        return TangentProduct(self)

    def bore_fields(self) -> dict[str, np.ndarray]:
        """Displacement (n, m) and coordinates (k,) of the bore, m."""
        return {
            "bore_displacement": self.term.displacement * self.bearing.radial_clearance,
            "bore_coordinates": self.coordinates.copy(),
        }

    def steady_tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10) with the bore following slowly, after `evaluate_steady`."""
        return condensed_tangent(self)

    def power_loss(self) -> float:
        """Of film and contacts as in `BearingModel`, W; what the film does to the bore leaves the film."""
        return super().power_loss() - float(self.bore_load @ self.rates)

    def quantities(self) -> dict[str, float]:
        """Scalars of the last evaluation as in `BearingModel`, and ``bore_displacement`` (m, largest)."""
        out = super().quantities()
        out["bore_displacement"] = float(np.max(np.abs(self.term.displacement))) * self.bearing.radial_clearance
        return out
