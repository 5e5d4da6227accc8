"""The film element on a flexible bore: a third block of coordinates besides those of housing and journal.

Modal bush: one NodeGenericODE2 holds the coordinates q of static modes in the housing's joint frame, those of an
elastic journal behind those of the bore. Their force is ``Q - K q``; their mass, if the bush has ``dynamics``, is the
mass matrix of Exudyn's object, on a housing that moves coupled with it (`ModalInertia`). The film's wrench on the
housing stays the opposite of the journal's, since the modes' forces are internal to bush and journal: force and moment
on journal and housing cancel exactly.

Inertia of a modal bush on a housing that moves: floating frame of reference, linear in the modes' displacement.

The housing's body has the bush's mass, at its undeformed place. A point X of the bush's frame (position r, rotation A,
velocity v, angular velocity omega) stands at r + A (X + u), u = Phi q. Of its kinetic energy beyond the body's,

    T = int rho d(A X + r)/dt . d(A u)/dt dV + q_t^T M q_t / 2,

what is left out is of the second order in u: gyroscopic and centrifugal terms of u with itself. T does not change when
the whole model is displaced or turned, so that momentum, angular momentum and energy of housing and bush together are
kept. Its Euler-Lagrange equations, with p = P q and accelerations in the frame's components,

    delta r:    a_w = alpha x p + Omega x (Omega x p) + 2 Omega x p_t + p_tt,
    delta phi:  p x a + I alpha + Omega x (I Omega) + 2 sum q_t,i K_i Omega + Theta q_tt,     I = sum q_i (K_i + K_i^T),
    delta q_i:  P_i . a + Theta_i . alpha - Omega . K_i Omega + (M q_tt)_i,

need three integrals of the modes: P = int rho Phi, Theta = int rho X x Phi and K = int rho (X . Phi 1 - Phi X^T), see
`BoreModes.moments`. With modes for body forces (`exudyn_ehd.solid.modes.dynamic`) the bore deflects under accelerations
as the mesh does, else within 5 to 20 %.
"""

from __future__ import annotations

import weakref

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import CURRENT, Index, Side, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.object_mass import warn_if_indefinite
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.sides import bind, detached
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.joint.bore.shapes import ModalBore
from exudyn_ehd.joint.model.build_flexible import TurningEvaluation, TurningModel
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.solid.journal.turning import TurningJournal
from exudyn_ehd.solid.modes.static import BoreModes

# An explicit solver that is not stored gives itself away by so many whole steps in a row, behind the first one.
EXPLICIT_STEPS = 2


class BoreFilmElement(FilmElement):
    """Film between two sides on a bore with nodes of its own.

    Parameters
    ----------
    model : ElasticBearingModel
        The film.
    housing, journal : NodeSide or MarkerSide
        As in `FilmElement`.
    nodes : list
        Nodes of the bore; their coordinates follow those of housing and journal.
    name : str
        For messages.
    """

    model: ElasticBearingModel

    def __init__(self, model: ElasticBearingModel, housing: Side, journal: Side, nodes: list[Index], name: str) -> None:
        super().__init__(model, housing, journal, name)
        self.bore_nodes = nodes
        self._places: np.ndarray | None = None

    @property
    def rigid_size(self) -> int:
        """Number of coordinates of housing and journal."""
        return self.sides[0].size + self.sides[1].size

    def read(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> tuple[list[float], list[float]]:
        q, q_t = super().read(mbs, configuration)
        if self._places is None:
            self._places = np.concatenate([mbs.systemData.GetNodeLTGODE2(int(node)) for node in self.bore_nodes])
        data = mbs.systemData
        q += np.asarray(data.GetODE2Coordinates(configuration))[self._places].tolist()
        q_t += np.asarray(data.GetODE2Coordinates_t(configuration))[self._places].tolist()
        return q, q_t

    def _move(
        self, mbs: exu.MainSystem, q: list[float], q_t: list[float], configuration: exu.ConfigurationType
    ) -> np.ndarray:
        """Motion (10 + 2 k,): that of the rigid surfaces, then the bore's coordinates and rates."""
        if not self._bound:
            self._bind(mbs)
        qv, qv_t, n = np.array(q), np.array(q_t), self.rigid_size
        rigid = self._move_rigid(mbs, qv[:n], qv_t[:n], configuration)
        return np.concatenate((rigid, *self._bore_motion(qv[n:], qv_t[n:])))

    @staticmethod
    def _evaluation(trial: Trial) -> ElasticEvaluation:
        assert isinstance(trial.evaluation, ElasticEvaluation)
        return trial.evaluation

    def _bore_motion(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and rates of the bore in the film model from those of the bore's nodes."""
        return q, q_t

    def _wrench_map(self) -> np.ndarray:
        """Map (n, 6) from the wrench on the journal, joint frame, to generalized forces on housing and journal."""
        housing, journal = self.sides
        found: np.ndarray = relative.wrench_map(housing.frame, journal.frame, housing.jac, journal.jac)
        return found


class ModalFilmElement(BoreFilmElement):
    """Film on a modal bush; see the module's docstring.

    Parameters
    ----------
    bore : ModalBore or TurningJournal
        That of the model.

    Attributes
    ----------
    modes : BoreModes, ReducedBore or None
        Of the bore; those of an elastic journal follow.
    stiffness : (k,) array
        Modal stiffness, N/m.
    inertia : ModalInertia or None
        Of modes with mass on a housing that moves.
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
        super().__init__(model, housing, journal, nodes, name)
        self.bore, self.modes = bore, bore.modes
        self.stiffness = bore.stiffness
        self.inertia: ModalInertia | None = None
        self._weighed = False
        # of a solver unknown: its step, how often it has asked there, whether at its start, and how many steps in a row
        # were an explicit solver's
        self._step = self._asked = self._in_a_row = 0
        self._at_start = False

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """As `FilmElement.force`.

        An implicit solver that asks at the start of its step looks for initial accelerations. Modes that no inertia
        resists have none, whether they are in balance or not; on their numerical mass a lack of balance would throw
        them.
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

    def mass(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """User function of Exudyn: mass matrix (N, N) of modes and housing."""
        assert self.inertia is not None
        if not self._bound:
            self._bind(mbs)
        if not self._weighed:
            self._weighed = True
            assert isinstance(self.modes, BoreModes)
            self.inertia.warn_if_indefinite(self.modes, self.failures.name)
        n, n_h, state = self.rigid_size, self.sides[0].size, np.array(q)
        whole = np.zeros((state.size, state.size))
        whole[:n_h, :n_h], coupling, whole[n:, n:] = self.inertia.mass(state[:n_h], state[n:])
        whole[:n_h, n:], whole[n:, :n_h] = coupling, coupling.T
        return whole

    def _inertia_state(self, trial: Trial) -> list[np.ndarray]:
        """Coordinates and rates of the housing, then of the modes."""
        n, n_h = self.rigid_size, self.sides[0].size
        q, q_t = np.array(trial.q), np.array(trial.q_t)
        return [q[:n_h], q_t[:n_h], q[n:], q_t[n:]]

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        evaluation = self._evaluation(trial)
        n, k = self.rigid_size, self.stiffness.size
        force = np.empty(len(trial.q))
        self._rigid_force(evaluation.wrench, force[:n])
        force[n:] = evaluation.bore_load - self.stiffness * trial.motion[MOTION_SIZE : MOTION_SIZE + k]
        if self.inertia is not None:
            on_housing, on_modes = self.inertia.force(*self._inertia_state(trial))
            force[: self.sides[0].size] += on_housing
            force[n:] += on_modes
        return force

    def _film_tangent(self, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (6 + k, 10 + k) of wrench and loads on the modes, combined by f_q and f_qt."""
        return self._evaluation(trial).combined_tangent(f_q, f_qt)

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        T, n, k = self._tangent(trial, f_q, f_qt), self.rigid_size, self.stiffness.size
        rigid = self._rigid_derivatives(mbs, trial, np.ascontiguousarray(T[:6, :MOTION_SIZE]))
        whole = np.empty((n + k, n + k))
        relative.modal_jacobian(T, *rigid, self._wrench_map(), f_q, f_qt, self.stiffness, whole)
        if self.inertia is not None:
            by_place, by_rate = self.inertia.derivatives(*self._inertia_state(trial))
            places = np.r_[: self.sides[0].size, n : n + k]
            whole[np.ix_(places, places)] -= f_q * by_place + f_qt * by_rate
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

    def __init__(self, model: TurningModel, housing: Side, journal: Side, nodes: list[Index], name: str) -> None:
        super().__init__(model, housing, journal, nodes, name, model.turning)
        self._by_angle = np.zeros(0)

    def _film_tangent(self, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        evaluation = trial.evaluation
        assert isinstance(evaluation, TurningEvaluation)
        self._by_angle = evaluation.derivatives[:, -1]
        return evaluation.combined_tangent(f_q, f_qt)

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        whole = super()._jacobian(mbs, trial, f_q, f_qt)
        housing, journal = self.sides
        t = housing.frame[:, :3].T @ journal.frame[:, 0]
        n = housing.frame[:, :3] @ [*(-t[2] * t[:2] / (t[0] ** 2 + t[1] ** 2)), 1.0]
        turn = np.concatenate((-n @ housing.jac[1], n @ journal.jac[1]))
        own = np.concatenate((self._wrench_map() @ self._by_angle[:6], self._by_angle[6:]))
        whole[:, : turn.size] -= f_q * np.multiply.outer(own, turn)
        return whole


def describe(modes: BoreModes) -> tuple[str, float, str]:
    """What messages say of a bush with mass: its kind, its mass [kg], and what else to do."""
    assert modes.moments is not None
    return "bush with dynamics=True", float(modes.moments[:, 0].sum()), "take ModalBush(dynamics=False)"


class ModalInertia:
    """Mass and velocity forces of modes on a side.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    side : Side
        Carries the bush's frame; a copy with arrays of its own is kept.
    modes : BoreModes
        With mass.
    """

    def __init__(self, mbs: exu.MainSystem, side: Side, modes: BoreModes) -> None:
        assert modes.mass is not None
        # held by the system's own functions: what they refer to must not keep it alive
        self.mbs: exu.MainSystem = weakref.proxy(mbs)
        self.side: Side = detached(side)
        self.modal_mass = modes.mass
        self.P, self.Theta, self.K = modes.participation()
        self._both, self._flat = np.concatenate((self.P, self.Theta)), self.K.reshape(-1, 9)
        self._bound = False

    def mass(self, q: np.ndarray, modes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Blocks of housing (n, n), housing and modes (n, k), and modes (k, k) at their coordinates (n,) and (k,)."""
        J = self._move(q)
        p, inertia = relative.skew(self.P @ modes), self._inertia(modes)
        own = np.block([[np.zeros((3, 3)), -p], [p, inertia]])
        return J.T @ own @ J, J.T @ self._both, self.modal_mass

    def warn_if_indefinite(self, modes: BoreModes, name: str) -> None:
        """Warn if what carries the bush has not its mass, once the system is assembled."""
        data, nodes = self.mbs.systemData, self.side.nodes
        places = np.concatenate([data.GetNodeLTGODE2(int(node)) for node in nodes])
        q = np.asarray(data.GetODE2Coordinates())[places]
        _, coupling, mass = self.mass(q, np.zeros(len(self.modal_mass)))
        change = -coupling @ np.linalg.solve(mass, coupling.T)
        warn_if_indefinite(self.mbs, nodes, change, describe(modes), name)

    def force(
        self, q: np.ndarray, q_t: np.ndarray, modes: np.ndarray, modes_t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Forces (n,) on the housing and (k,) on the modes that velocities cause."""
        return self._velocity_force(self._move(q), q, q_t, modes, modes_t)

    def derivatives(
        self, q: np.ndarray, q_t: np.ndarray, modes: np.ndarray, modes_t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n + k, n + k) of `force` to the coordinates and to the rates.

        Exact except for the change with the housing's coordinates, which is left out; so is that of the mass matrix in
        Exudyn: Newton's rate suffers by the angle of a step.
        """
        J, n, k = self._move(q), q.size, modes.size
        place, rate = np.zeros((n + k, n + k)), np.zeros((n + k, n + k))
        a, alpha, omega = self._accelerations(J, q, q_t)
        N = self.K + self.K.transpose(0, 2, 1)
        columns = self.P.T
        force = np.cross(alpha, columns) + np.cross(omega, np.cross(omega, columns))
        moment = np.cross(columns, a) + N @ alpha + np.cross(omega, N @ omega)
        by_place = np.concatenate((force, moment), axis=1)
        by_rate = np.concatenate((np.cross(omega, columns), self.K @ omega), axis=1)
        place[:n, n:] = -(J.T @ by_place.T)
        rate[:n, n:] = -2.0 * (J.T @ by_rate.T)
        # quadratic in the rates: central differences are exact
        for i in range(n):
            ends = []
            for sign in (1.0, -1.0):
                moved = q_t.copy()
                moved[i] += sign
                ends.append(np.concatenate(self._velocity_force(J, q, moved, modes, modes_t)))
            rate[:, i] = 0.5 * (ends[0] - ends[1])
        return place, rate

    def _velocity_force(
        self, J: np.ndarray, q: np.ndarray, q_t: np.ndarray, modes: np.ndarray, modes_t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        a, alpha, omega = self._accelerations(J, q, q_t)
        p, p_t, inertia = self.P @ modes, self.P @ modes_t, self._inertia(modes)
        turn, each = relative.skew(omega), self.K @ omega
        force = relative.skew(alpha) @ p + turn @ (turn @ p + 2.0 * p_t)
        moment = relative.skew(p) @ a + inertia @ alpha + turn @ (inertia @ omega) + 2.0 * (modes_t @ each)
        on_modes = a @ self.P + alpha @ self.Theta - each @ omega
        return -(np.concatenate((force, moment)) @ J), -on_modes

    def _accelerations(self, J: np.ndarray, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, ...]:
        """Accelerations a and alpha at q_tt = 0, and Omega, in the frame's components."""
        side = self.side
        side.frame[:, 5] = side.jac[1] @ q_t
        side.vary(self.mbs, q, q_t)
        A = side.frame[:, :3]
        return (side.jac[2] @ q_t) @ A, (side.jac[3] @ q_t) @ A, J[3:] @ q_t

    def _inertia(self, modes: np.ndarray) -> np.ndarray:
        first = (modes @ self._flat).reshape(3, 3)
        return first + first.T

    def _move(self, q: np.ndarray) -> np.ndarray:
        """Bring the side to ``q``; its Jacobian (6, n) in the frame's components."""
        if not self._bound:
            bind(self.mbs, self.side)
            self._bound = True
        self.side.update(self.mbs, q, np.zeros_like(q), CURRENT)
        A = self.side.frame[:, :3]
        return np.concatenate((A.T @ self.side.jac[0], A.T @ self.side.jac[1]))
