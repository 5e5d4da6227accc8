"""The film element on a flexible bore: a third block of coordinates besides those of housing and journal.

Modal bush: one NodeGenericODE2 holds the coordinates q of static modes in the housing's joint frame, those of an
elastic journal behind those of the bore. Their force is ``Q - K q``. The film's wrench on the housing stays the
opposite of the journal's, since the modes' forces are internal to bush and journal: force and moment on journal and
housing cancel exactly. The housing's body has the bush's mass, at its undeformed place.
"""

from __future__ import annotations

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Index, Side, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.joint.bore.shapes import ModalBore
from exudyn_ehd.joint.model.build_flexible import TurningEvaluation, TurningModel
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.solid.bush_modes import BoreModes
from exudyn_ehd.solid.journal.turning import TurningJournal

# An explicit solver that is not stored gives itself away by so many whole steps in a row, behind the first one.
EXPLICIT_STEPS = 2


class BoreFilmElement(FilmElement):
    """Film between two sides on a bore with nodes of its own."""

    model: ElasticBearingModel

    @staticmethod
    def _evaluation(trial: Trial) -> ElasticEvaluation:
        assert isinstance(trial.evaluation, ElasticEvaluation)
        return trial.evaluation


class ModalFilmElement(BoreFilmElement):
    """Film on a modal bush; see the module's docstring.

    Parameters
    ----------
    bore : ModalBore or TurningJournal
        Bore of the model.

    Attributes
    ----------
    modes : BoreModes, ReducedBore or None
        Modes of the bore; those of an elastic journal follow.
    stiffness : (k,) array
        Modal stiffness, N/m.
    """

    def __init__(
        self,
        model: ElasticBearingModel,
        housing: Side,
        journal: Side,
        nodes: list[Index],
        name: str,
        bore: ModalBore | TurningJournal,
    ) -> None:
        super().__init__(model, housing, journal, name, nodes)
        self.bore, self.modes = bore, bore.modes
        self.stiffness = bore.stiffness
        # of a solver unknown: its step, how often it has asked there, whether at its start, and how many steps in a row
        # were an explicit solver's
        self._step = self._asked = self._in_a_row = 0
        self._at_start = False

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """Return the force of `FilmElement.force`, without loads on massless modes for initial accelerations.

        An implicit solver evaluates the force at the start of a step to find initial accelerations. Massless modes
        have none, in balance or not. An unbalanced load on their numerical mass would give a huge one.
        """
        force = super().force(mbs, t, item, q, q_t)
        steps = self.steps
        if not self.is_massless:
            return force
        if steps.is_idle:
            self._find_out(steps.unseen, t == steps.start)
        elif t == steps.start and solver_state.is_implicit(steps.solver):
            force[self.rigid_size :] = 0.0
        return force

    def _find_out(self, step: int, at_start: bool) -> None:
        """Raise `InputError` if a solver that is not stored proves explicit.

        Explicit solvers ask at the start of every step, or (velocity Verlet) once at its end; implicit ones twice and
        more, at its end.
        """
        if step == self._step:
            self._asked += 1
            self._at_start = self._at_start or at_start
            return
        explicit = step == self._step + 1 and step > 1 and (self._at_start or self._asked == 1)
        self._in_a_row = self._in_a_row + 1 if explicit else 0
        if self._in_a_row == EXPLICIT_STEPS:
            raise self.failures.no_mass()
        self._step, self._asked, self._at_start = step, 1, at_start

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        evaluation = self._evaluation(trial)
        n, k = self.rigid_size, self.stiffness.size
        force = np.empty(len(trial.q))
        self._rigid_force(evaluation.wrench, force[:n])
        force[n:] = evaluation.bore_load - self.stiffness * trial.motion[MOTION_SIZE : MOTION_SIZE + k]
        return force

    def _film_tangent(self, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (6 + k, 10 + k) of wrench and loads on the modes, combined by f_q and f_qt."""
        return self._evaluation(trial).combined_tangent(f_q, f_qt)

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        T, n, k = self._tangent(trial, f_q, f_qt), self.rigid_size, self.stiffness.size
        rigid = self._rigid_derivatives(mbs, trial, np.ascontiguousarray(T[:6, :MOTION_SIZE]))
        whole = np.empty((n + k, n + k))
        relative.modal_jacobian(T, *rigid, self._wrench_map(), f_q, f_qt, self.stiffness, whole)
        return whole

    def bush_displacement(self, trial: Trial, configuration: exu.ConfigurationType) -> np.ndarray | None:
        """Displacement (k, 3) of the bush's mesh at the last trial; None without one: a body shows itself."""
        if not isinstance(self.modes, BoreModes):
            return None
        return np.tensordot(self._evaluation(trial).bore.coordinates[: self.modes.count], self.modes.displacements, 1)


class TurningFilmElement(ModalFilmElement):
    """Film on a finite-element journal, whose body has nodes, mass and stiffness for the modes that turn with it.

    Force and Jacobian are those of a modal bush, but for the angle phi of the journal, atan2 of its frame's x in the
    joint frame, at which the film finds the modes: ``d phi = n . (d turn of the journal - d turn of the housing)``.
    """

    model: TurningModel

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        whole, evaluation = super()._jacobian(mbs, trial, f_q, f_qt), trial.evaluation
        assert isinstance(evaluation, TurningEvaluation)
        by_angle = evaluation.derivatives[:, -1]
        housing, journal = self.sides
        t = housing.frame[:, :3].T @ journal.frame[:, 0]
        n = housing.frame[:, :3] @ [*(-t[2] * t[:2] / (t[0] ** 2 + t[1] ** 2)), 1.0]
        turn = np.concatenate((-n @ housing.jac[1], n @ journal.jac[1]))
        own = np.concatenate((self._wrench_map() @ by_angle[:6], by_angle[6:]))
        whole[:, : turn.size] -= f_q * np.multiply.outer(own, turn)
        return whole
