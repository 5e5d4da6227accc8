"""The film element on the bore nodes of a nodal bush.

The bore's displacement is that of its nodes from their positions in the housing's joint frame, in this frame; normals
are fixed in the frame. The nodal loads are the transpose of the shape functions times the forces of pressure and shear
at the film's vertices (`exudyn_ehd.joint.tangent.nodes`). They differ from the film's wrench by small moments of forces
on displaced points, and by the net shear force across the axis. This force has the size clearance over radius times the
load, and a wrench by the Reynolds equation omits it. The difference is spread over the bore's nodes as
``w (a + b x r)``, with a and b from force and moment. So journal and bush get exactly opposite forces and moments, at
any displacement. The housing is loaded only through the bush.

The film element on a flexible bore has a third block of coordinates, in addition to those of housing and journal.

Modal bush: one NodeGenericODE2 holds the coordinates q of static modes in the housing's joint frame, those of an
elastic journal after those of the bore. Their force is ``Q - K q``. The film's wrench on the housing is the opposite of
that on the journal, since the modes' forces are internal to bush and journal: force and moment on journal and housing
cancel exactly. The housing's body contains the mass of the undeformed bush.
"""

from __future__ import annotations

import dataclasses
import weakref
from collections.abc import Callable

import exudyn as exu
import numpy as np
from exudyn.rigidBodyUtilities import Skew
from scipy.sparse import csr_matrix

from exudyn_ehd.coupling import exudyn_solvers
from exudyn_ehd.coupling.contract import CURRENT, Index, JointEvaluation, Side, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.bush import FlexibleBush
from exudyn_ehd.joint.bore.shapes import ModalBore
from exudyn_ehd.joint.model.build import TurningEvaluation, TurningModel
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.joint.tangent.nodes import complete, resultant, spread_matrix
from exudyn_ehd.solid.bush import BoreModes
from exudyn_ehd.solid.turning_journal import TurningJournal
from exudyn_ehd.status import Status


def elastic(trial: Trial) -> ElasticEvaluation:
    """Evaluation of a trial's film on a flexible bore."""
    assert isinstance(trial.evaluation, ElasticEvaluation)
    return trial.evaluation


class ModalFilmElement(FilmElement):
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
        # for an unknown solver: its step, number of calls in it, whether it has called at the start of the step, and
        # number of successive steps with the calls of an explicit solver
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
        elif t == steps.start and exudyn_solvers.is_implicit(steps.solver):
            force[self.rigid_size :] = 0.0
        return force

    def _find_out(self, step: int, at_start: bool) -> None:
        """Raise `InputError` if a solver that is not stored proves explicit.

        Explicit solvers evaluate the force at the start of every step, or (velocity Verlet) once at its end; implicit
        solvers evaluate it at least twice at the end.
        """
        if step == self._step:
            self._asked += 1
            self._at_start = self._at_start or at_start
            return
        explicit = step == self._step + 1 and step > 1 and (self._at_start or self._asked == 1)
        self._in_a_row = self._in_a_row + 1 if explicit else 0
        # behind the first one
        if self._in_a_row == 2:
            raise self.failures.no_mass()
        self._step, self._asked, self._at_start = step, 1, at_start

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        evaluation = elastic(trial)
        held = self.stiffness * trial.motion[MOTION_SIZE:][: self.stiffness.size]
        return np.concatenate((self._wrench_map() @ evaluation.wrench, evaluation.bore.load - held))

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        # tangent of wrench and loads on the modes, combined by f_q and f_qt
        T, n, k = elastic(trial).combined_tangent(f_q, f_qt), self.rigid_size, self.stiffness.size
        own, whole = np.ascontiguousarray(T[:6, :MOTION_SIZE]), np.empty((n + k, n + k))
        stiffness, damping, by_place, by_rate = self._rigid_derivatives(mbs, trial, own)
        whole[:n, :n] = -(f_q * stiffness + f_qt * damping)
        whole[:n, n:] = -self._wrench_map() @ T[:6, MOTION_SIZE:]
        whole[n:, :n] = -T[6:, :MOTION_SIZE] @ (f_q * by_place + f_qt * by_rate)
        whole[n:, n:] = f_q * np.diag(self.stiffness) - T[6:, MOTION_SIZE:]
        return whole

    def bush_displacement(self, trial: Trial, configuration: exu.ConfigurationType) -> np.ndarray | None:
        """Displacement (k, 3) of the bush's mesh at the last trial; None without a bush, or on a user's body."""
        if not isinstance(self.modes, BoreModes):
            return None
        return np.tensordot(elastic(trial).bore.coordinates[: self.modes.count], self.modes.displacements, 1)


class TurningFilmElement(ModalFilmElement):
    """Film on a finite-element journal, whose body has nodes, mass and stiffness for the modes that turn with it.

    Force and Jacobian are those of a modal bush, with an additional dependence on the angle phi of the journal, the
    atan2 of its frame's x in the joint frame: ``d phi = n . (d turn of the journal - d turn of the housing)``.
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


class NodalFilmElement(FilmElement):
    """Film on a nodal bush; see the module's docstring.

    The Jacobian is exact except for the change of lever arms with the bore's displacement, which is smaller by
    displacement over radius.

    Parameters
    ----------
    bush : FlexibleBush
        Its frame in the reference configuration is the joint frame.
    """

    def __init__(
        self,
        model: ElasticBearingModel,
        housing: Side,
        journal: Side,
        nodes: list[Index],
        name: str,
        bush: FlexibleBush,
    ) -> None:
        super().__init__(model, housing, journal, name, nodes)
        # weak reference: the system refers to this element, which must not keep the system alive
        self.bush = dataclasses.replace(bush, mbs=weakref.proxy(bush.mbs))
        self.reference = bush.solid.mesh.nodes[bush.mesh.bore.nodes]
        self.place = bush.mesh.bore.positions
        self.count = len(self.place)
        self.arms = np.zeros((self.count, 3))
        self.drift = np.zeros((self.count, 3))

    def _bore_motion(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        frame = self.sides[0].frame
        A = frame[:, :3]
        self.arms = self.reference + q.reshape(-1, 3) - frame[:, 3]
        self.drift = q_t.reshape(-1, 3) - frame[:, 4] - np.cross(frame[:, 5], self.arms)
        d = self.arms @ A - self.place
        return d[:, :2].ravel(), (self.drift @ A[:, :2]).ravel()

    def bush_displacement(self, trial: Trial, configuration: exu.ConfigurationType) -> np.ndarray:
        """Displacement (k, 3) of the bush's mesh against the housing; the sides must be updated."""
        frame = self.sides[0].frame
        positions = self.bush.solid.mesh.nodes + self.bush.displacements(configuration)
        return (positions - frame[:, 3]) @ frame[:, :3] - self.bush.mesh.nodes

    def nodal_forces(self, evaluation: ElasticEvaluation) -> np.ndarray:
        """Forces on the bore's nodes (count, 3), joint frame, N."""
        return complete(self.arms @ self.sides[0].frame[:, :3], evaluation.wrench, evaluation.nodal_forces())

    def _quantities(self, evaluation: JointEvaluation) -> dict[str, float]:
        assert isinstance(evaluation, ElasticEvaluation)
        out = dict(evaluation.quantities())
        # the model includes only the work on the radial displacement, not that of the spread forces
        rest = self.nodal_forces(evaluation)
        rest[:, :2] -= evaluation.bore.load.reshape(-1, 2)
        out["power_loss"] -= float(np.sum(rest * (self.drift @ self.sides[0].frame[:, :3])))
        return out

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        evaluation, housing = elastic(trial), self.sides[0]
        rigid = self._wrench_map() @ evaluation.wrench
        rigid[: housing.size] = 0.0
        return np.concatenate((rigid, (self.nodal_forces(evaluation) @ housing.frame[:, :3].T).ravel()))

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        return NodalJacobian(self, mbs, trial, f_q, f_qt).matrix()

    def operator(
        self, mbs: exu.MainSystem, t: float, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> Callable[[np.ndarray], np.ndarray] | None:
        """Return `jacobian` as an operator, valid until the film's next evaluation; None without a film."""
        trial = self._try(mbs, q, q_t, CURRENT, t)
        if trial.status != Status.CONVERGED:
            return None
        film, n = NodalJacobian(self, mbs, trial, f_q, f_qt), self.rigid_size
        of_faces = self.faces_jacobian(mbs, trial, f_q, f_qt)

        def product(change: np.ndarray) -> np.ndarray:
            out = film(change)
            out[:n] += of_faces @ change[:n]
            return out

        return product

    def _turning_forces(self, evaluation: ElasticEvaluation) -> np.ndarray:
        """Derivative (3 count, n_h) of the forces on the bore's nodes as the housing turns them."""
        force = self.nodal_forces(evaluation) @ self.sides[0].frame[:, :3].T
        turn = np.cross(self.sides[0].jac[1].T, force[:, None, :])
        return turn.transpose(0, 2, 1).reshape(3 * self.count, -1)

    def _housing_maps(self) -> tuple[np.ndarray, np.ndarray]:
        """d(d)/dq = d(d_t)/dq_t and d(d_t)/dq (2 count, n_h) of the bore's displacements; q of the housing."""
        frame, (Jp, Jr, Vq, Wq) = self.sides[0].frame, self.sides[0].jac
        A, omega = frame[:, :2], frame[:, 5]
        r, u = self.arms[:, None, :], self.drift[:, None, :]
        moved = -Jp.T - np.cross(Jr.T, r)
        first = np.einsum("aci,ij->ajc", moved, A).reshape(2 * self.count, -1)
        change = -Vq.T - np.cross(Wq.T, r) + np.cross(omega, Jp.T) - np.cross(Jr.T, u)
        second = np.einsum("aci,ij->ajc", change, A).reshape(2 * self.count, -1)
        return first, second

    def bore_map(self, by_housing: np.ndarray, by_node: np.ndarray) -> csr_matrix:
        """Map (2 count, N) to displacements of the bore: (2 count, n_h) from the housing, (2, 3) from each node."""
        nodes = self.rigid_size + 3 * np.arange(self.count).repeat(2)[:, None] + np.arange(3)
        housing = np.broadcast_to(np.arange(by_housing.shape[1]), by_housing.shape)
        values = np.hstack((by_housing, np.tile(by_node, (self.count, 1))))
        starts = np.arange(0, values.size + 1, values.shape[1])
        size = self.rigid_size + 3 * self.count
        return csr_matrix((values.ravel(), np.hstack((housing, nodes)).ravel(), starts), shape=(len(values), size))


class NodalJacobian:
    """Minus (f_q dQ/dq + f_qt dQ/dq_t) of a film on a nodal bush, as a matrix or as an operator.

    A product with the operator needs one film solve.

    Parameters
    ----------
    element : NodalFilmElement
    mbs : exudyn.MainSystem
    trial : Trial
        Last trial of the element.
    f_q, f_qt : float
    """

    def __init__(self, element: NodalFilmElement, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> None:
        self.film = film = elastic(trial).nodal_tangent()
        self.n, self.n_h = element.rigid_size, element.sides[0].size
        stiffness, damping, by_place, by_rate = element._rigid_derivatives(mbs, trial, film.wrench)
        self.rigid = (f_q * stiffness + f_qt * damping)[self.n_h :]
        self.motion = f_q * by_place + f_qt * by_rate
        self.journal = element._wrench_map()[self.n_h :]
        self.frame, omega = element.sides[0].frame[:, :3], element.sides[0].frame[:, 5]
        x = element.arms @ self.frame
        self.spread, self.resultant = spread_matrix(x), resultant(x)
        place, drift = element._housing_maps()
        # in the rotating frame, the rate depends on the displacement u by -omega x u
        along, turning = self.frame[:, :2].T, self.frame[:, :2].T @ -Skew(omega)
        self.place = element.bore_map(f_q * place, f_q * along)
        self.rate = element.bore_map(f_q * drift + f_qt * place, f_q * turning + f_qt * along)
        self.turned = f_q * element._turning_forces(elastic(trial))

    def matrix(self) -> np.ndarray:
        """The whole matrix (N, N)."""
        return self._product(np.eye(self.n, self.place.shape[1]), self.place, self.rate)

    def __call__(self, change: np.ndarray) -> np.ndarray:
        """Product (N,) with a change (N,) of the element's coordinates."""
        column = change[:, None]
        return self._product(column[: self.n], self.place @ column, self.rate @ column)[:, 0]

    def _product(self, sides: np.ndarray, place: np.ndarray | csr_matrix, rate: np.ndarray | csr_matrix) -> np.ndarray:
        """Products (N, r) with r changes (n, r) of the sides' coordinates and (2 count, r) of the bore's motion."""
        motion = self.motion @ sides
        wrench, local = self.film.changes(motion, place, rate)
        nodal = local - np.tensordot(self.spread, wrench + self.resultant @ local.reshape(-1, sides.shape[1]), 1)
        out = np.zeros((self.place.shape[1], sides.shape[1]))
        through_bore = wrench - self.film.wrench @ motion
        out[self.n_h : self.n] = -(self.journal @ through_bore + self.rigid @ sides)
        turned = np.einsum("ij,ajc->aic", self.frame, nodal).reshape(-1, sides.shape[1])
        out[self.n :] = -(turned + self.turned @ sides[: self.n_h])
        return out
