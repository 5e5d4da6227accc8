"""Bearing with a flexible bore, a flexible journal or both: model of rigid surfaces with ``delta = S q`` in the gap.

The motion (10,) of the rigid surfaces is followed by the bore's coordinates and rates,

    motion = [x, y, ..., omega, w, q_1 .. q_k, dq_1/dt .. dq_k/dt];

Results are the wrench on the journal and the generalised loads Q = S^T (p A) on q. Q contains the loads of the film's
moment on a bush that deflects by it (`exudyn_ehd.solid.bush`). The forces of the bush are not part of this model; only
`evaluate_steady` uses its `Elasticity` and finds the q with K q = Q, or the balance of a solid.

The coordinates of an elastic journal follow those of the bore, S = [S_bore, S_journal]; an inward displacement of its
surface opens the gap. An elastic journal is a body of revolution: under a pressure at rest its displacement is at rest,
whatever its spin. So its modes do not turn, and the gap's rate by deflection is ``S q_t``. The pressure has no torque
on the deflection, ``int p d(C p)/d theta dA = 0`` for a compliance C that is the same in all directions, so that
friction is shear alone.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.joint.bore.equilibrium import Elasticity, condensed_tangent
from exudyn_ehd.joint.bore.shapes import Bore, NodalBore
from exudyn_ehd.joint.model.effects import Effects
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import (
    MOTION_SIZE,
    BoreState,
    ContactFields,
    History,
    JournalMotion,
    SolvedFilm,
)
from exudyn_ehd.joint.tangent.bore import elastic_tangent, storage_tangent
from exudyn_ehd.joint.tangent.nodes import BoreForces, NodalTangent, complete, traction
from exudyn_ehd.status import Status, warn_user

# Displacement of the journal's ends by tilt, over the clearance, above which a bush or journal with tilted=False, whose
# modes are even along the axis, causes a warning.
TILTED = 0.02


class ClosingFilm(NamedTuple):
    """Last film found on the way to a position without one.

    ``part``: fraction of that position's eccentricity and tilt; ``gap``: minimum film thickness there, m, at the angle
    ``theta``, rad, and at ``z``, m.
    """

    part: float
    gap: float
    theta: float
    z: float


@dataclasses.dataclass(eq=False)
class ElasticEvaluation(Evaluation):
    """One film evaluation on a flexible bore.

    Attributes
    ----------
    bore : BoreState
    closing : ClosingFilm or None
        Last film found, if `ElasticBearingModel.evaluate_steady` found none at the position itself.
    """

    model: ElasticBearingModel = dataclasses.field(repr=False)
    bore: BoreState = dataclasses.field(repr=False)
    closing: ClosingFilm | None = None

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d (wrench, Q) / d motion (6 + k, 10 + 2 k); nan without a film."""
        return self._tangent((1.0, 0.0), (0.0, 1.0))

    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """Return `tangent` with the bore's columns as ``by_place d/dq + by_rate d/dq_t``, (6 + k, 10 + k).

        Integrators need this form.
        """
        return self._tangent((by_place, by_rate))

    def _tangent(self, *combinations: tuple[float, float]) -> np.ndarray:
        film, k = self._current(), self.bore.coordinates.size
        if film is None:
            return np.full((6 + k, MOTION_SIZE + k * len(combinations)), np.nan)
        return elastic_tangent(film, self.model.bore, *combinations)

    def steady_tangent(self, exact: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10) with the bore in equilibrium; ``exact`` as in `Evaluation.steady_tangent`."""
        if self.is_central:
            return self.tangents_beside(exact).mean(axis=0)
        elasticity = self.model.elasticity
        T = elasticity.tangent(self, exact)
        if exact and self.model.solver.pockets is not None:
            T = T + storage_tangent(self.solved, self.model.bore)
        return condensed_tangent(T, elasticity)

    def nodal_forces(self) -> np.ndarray:
        """Forces (nodes, 3) of pressure, shear and contacts on the nodes of a nodal bore, joint frame, N.

        There must be a film.
        """
        shear = traction(self.solved, self.model.bore_forces)
        nodal = self.model.bore_forces.nodal(np.concatenate((np.zeros((1, shear.shape[1])), shear)))
        nodal[:, :2] += self.bore.load.reshape(-1, 2)
        return nodal

    def forces_at(self, x: np.ndarray) -> np.ndarray:
        """`nodal_forces` on nodes at x (nodes, 3), completed so that they balance the wrench on the journal."""
        return complete(x, self.wrench, self.nodal_forces())

    def nodal_tangent(self) -> NodalTangent:
        """Return the tangent of wrench and nodal forces; there must be a film."""
        assert isinstance(self.model.bore, NodalBore)
        return NodalTangent(self.solved, self.model.bore, self.model.bore_forces)

    def tangent_at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """`NodalTangent.whole` with the forces completed as in `forces_at`."""
        wrench, nodal = self.nodal_tangent().whole()
        return wrench, complete(x, wrench, nodal)

    def quantities(self) -> dict[str, float]:
        """Return `Evaluation.quantities` and the largest ``bore_displacement``, m."""
        largest = float(np.max(np.abs(self.bore.displacement))) * self.model.bearing.radial_clearance
        return super().quantities() | {"bore_displacement": largest}


def end_load(bore: Bore, grid: FilmGrid, pressures: tuple[float, float]) -> np.ndarray:
    """Return the correction (k,) of the bore's loads by end pressures, N.

    In the film's sums, vertices on the ends load the bore at the ends only. The pressure is therefore split into
    ``p0 (1 - zeta) / 2 + p1 (1 + zeta) / 2``, zeta = 2 z / L, and a rest that vanishes at the ends. The loads of the
    first part are integrated; the correction is their difference to its sum. The first part has neither force nor
    moment on the journal.

    Parameters
    ----------
    bore : Bore
        Bore on the grid.
    grid : FilmGrid
        Grid of the film.
    pressures : (float, float)
        Pressures at -L/2 and L/2, Pa.
    """
    half, R = float(grid.z[-1]), grid.reference_length
    exact = 2.0 * np.pi * half * (np.array(pressures) @ bore.end_shapes())
    course = 0.5 * (pressures[0] * (1.0 - grid.z / half) + pressures[1] * (1.0 + grid.z / half))
    return np.asarray(exact - bore.load(course * grid.weight)) * R**2


class ElasticBearingModel(BearingModel):
    """Film between a journal and a bore of which at least one is flexible.

    Parameters
    ----------
    bearing : JournalBearing
    bore : function of FilmGrid
        Makes the bore for the film's grid.
    elasticity : Elasticity
        Elasticity that resists q in a steady state.
    start_angle, effects
        As in `BearingModel`.

    Attributes
    ----------
    size : int
        k, the number of coordinates in its motion.
    """

    flexible = True

    def __init__(
        self,
        bearing: JournalBearing,
        bore: Callable[[FilmGrid], Bore],
        *,
        elasticity: Elasticity,
        start_angle: float = 0.0,
        effects: Effects | None = None,
    ) -> None:
        super().__init__(bearing, start_angle=start_angle, effects=effects)
        self.make_bore, self.bore = bore, bore(self.grid)
        self.elasticity, self.size = elasticity, self.bore.size
        self._parallel = not all(getattr(part, "tilted", True) for part in (bearing.bush, bearing.journal))
        self._coordinates = np.zeros(self.bore.size)
        self._end_load = end_load(self.bore, self.grid, bearing.end_pressures) if any(bearing.end_pressures) else None

    @cached_property
    def bore_forces(self) -> BoreForces:
        """Return the map from the film's forces to the nodes of a nodal bore."""
        assert isinstance(self.bore, NodalBore)
        return BoreForces(self.bore)

    def _journal(self, motion: np.ndarray, spin: float) -> JournalMotion:
        """Set the motion (10 + 2 k,); with (10,) the bore is undeformed and at rest."""
        motion, k = np.asarray(motion, dtype=float), self.bore.size
        if motion.size == MOTION_SIZE:
            motion = np.concatenate((motion, np.zeros(2 * k)))
        journal = super()._journal(motion, spin)
        self._coordinates = journal.motion[MOTION_SIZE : MOTION_SIZE + k]
        scaled = journal.motion[MOTION_SIZE:] / self.bearing.radial_clearance
        self._displacement, self._rate = (self.bore.displacement(q) for q in (scaled[:k], scaled[k:]))
        return journal

    def _bore_state(
        self,
        journal: JournalMotion,
        oil: OilFields | None = None,
        pressing: ContactFields | None = None,
        moment: float = 0.0,
    ) -> BoreState:
        k, moved = self.bore.size, journal.motion[MOTION_SIZE:]
        load = np.full(k, np.nan)
        if oil is not None:
            # force of film and contact on the bore at every vertex, N, outward
            field = oil.P * self.scales.pressure
            for P in () if pressing is None else pressing.P:
                field += P
            load = self.bore.load(field * (self.grid.weight * self.grid.reference_length**2))
            if self._end_load is not None:
                load += self._end_load
            if self.bore.twist is not None:
                load -= self.bore.twist * moment
        assert self._displacement is not None
        return BoreState(moved[:k], moved[k:], self._displacement, load)

    def _result(
        self, status: Status, journal: JournalMotion, iterations: int, gap: float, film: SolvedFilm | None = None
    ) -> ElasticEvaluation:
        bore = self._bore_state(journal) if film is None or film.bore is None else film.bore
        return ElasticEvaluation(**vars(super()._result(status, journal, iterations, gap, film)), bore=bore)

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> ElasticEvaluation:
        """Evaluate the film; ``motion`` (10 + 2 k,) as in the module's docstring, the rest as in `BearingModel`."""
        if self._parallel:
            self._warn_of_tilt(motion)
        evaluation = super().evaluate(motion, history, step, spin)
        assert isinstance(evaluation, ElasticEvaluation)
        return evaluation

    def _warn_of_tilt(self, motion: np.ndarray) -> None:
        """Warn once if the journal tilts on modes that are even along the axis."""
        travel = 0.5 * self.bearing.length * float(np.hypot(motion[2], motion[3]))
        if travel > TILTED * self.bearing.radial_clearance:
            self._parallel = False
            warn_user(
                f"{type(self.bearing.yielding).__name__}(tilted=False) deflects as under a parallel journal, but the "
                f"journal's ends tilt by {travel / self.bearing.radial_clearance:.0%} of the clearance: the minimum "
                "film thickness may be 10 % off. Take tilted=True.",
                UserWarning,
            )

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> ElasticEvaluation:
        """Evaluate at a motion (10,) with the bore in equilibrium under the film, q_t = 0.

        The other arguments are those of `evaluate`. The search starts from the coordinates of the last evaluation. The
        status is NOT_CONVERGED if no equilibrium was found.
        """
        start = self._coordinates.copy()
        found = self.elasticity.settle(self, motion, (history, step, spin), start)
        if found is not None:
            assert isinstance(found, ElasticEvaluation)
            return found
        part, q = self.elasticity.reached
        closing = self._closing(motion, (history, step, spin), part, q) if part > 0.0 else None
        evaluation = self.evaluate(motion, history, step, spin)
        status = Status.NOT_CONVERGED if evaluation.status is Status.CONVERGED else evaluation.status
        return dataclasses.replace(evaluation, status=status, film=None, closing=closing)

    def _closing(
        self, motion: np.ndarray, film: tuple[History | None, float, float], part: float, q: np.ndarray
    ) -> ClosingFilm:
        near = np.concatenate((motion[:MOTION_SIZE], q, np.zeros(q.size)))
        near[:4] *= part
        gap = self.evaluate(near, *film).minimum_gap
        i, j = np.unravel_index(int(self.solver.H.argmin()), self.grid.shape)
        return ClosingFilm(part, gap, float(self.grid.x[i]), float(self.grid.z[j]) * self.grid.reference_length)
