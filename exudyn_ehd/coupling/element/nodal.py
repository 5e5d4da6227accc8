"""The film element on the bore nodes of a nodal bush.

The bore's displacement is that of its nodes against where the housing's joint frame would carry them, in that frame;
normals are fixed in the frame. The nodal loads of pressure and shear are the shape functions' transpose of their forces
at the film's vertices (`exudyn_ehd.joint.tangent.nodes`). What the film's wrench has beyond them is spread over the
bore's nodes as ``w (a + b x r)``, with a and b from force and moment, so that journal and bush receive exactly opposite
forces and moments, at any displacement: the small moments of forces on displaced points, and the shear's net force
across the axis, clearance over radius of the load, which the wrench of a film leaves out as its Reynolds equation does.
The housing itself is loaded through the bush.
"""

from __future__ import annotations

import dataclasses
import weakref

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.bush.object import FlexibleBush
from exudyn_ehd.coupling.contract import CURRENT, Evaluation, Index, Side, Trial
from exudyn_ehd.coupling.element.modal import BoreFilmElement
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.joint.tangent.spread import complete, resultant, spread_matrix
from exudyn_ehd.status import Status


class NodalFilmElement(BoreFilmElement):
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
        super().__init__(model, housing, journal, nodes, name)
        # the system holds this element: it must not keep the system alive
        self.bush = dataclasses.replace(bush, mbs=weakref.proxy(bush.mbs))
        self.reference = bush.solid.mesh.nodes[bush.mesh.bore.nodes]
        self.place = bush.mesh.bore.positions
        self.count = len(self.place)
        self._nodal: tuple[Evaluation | None, np.ndarray] = (None, np.zeros((0, 3)))
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
        """Displacement (k, 3) of the bush's mesh against the housing, to whose frame the sides were brought."""
        frame = self.sides[0].frame
        positions = self.bush.solid.mesh.nodes + self.bush.displacements(configuration)
        return (positions - frame[:, 3]) @ frame[:, :3] - self.bush.mesh.nodes

    def nodal_forces(self, evaluation: ElasticEvaluation) -> np.ndarray:
        """Forces on the bore's nodes (count, 3), joint frame, N."""
        if self._nodal[0] is not evaluation:
            self._nodal = evaluation, evaluation.nodal_forces()
        return complete(self.arms @ self.sides[0].frame[:, :3], evaluation.wrench, self._nodal[1])

    def _quantities(self, evaluation: Evaluation) -> dict[str, float]:
        assert isinstance(evaluation, ElasticEvaluation)
        out = dict(evaluation.quantities())
        # the model knows the work on the radial displacement only, not that of the spread forces
        rest = self.nodal_forces(evaluation)
        rest[:, :2] -= evaluation.bore_load.reshape(-1, 2)
        out["power_loss"] -= float(np.sum(rest * (self.drift @ self.sides[0].frame[:, :3])))
        return out

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        evaluation, housing, n = self._evaluation(trial), self.sides[0], self.rigid_size
        force = np.empty(len(trial.q))
        self._rigid_force(evaluation.wrench, force[:n])
        force[: housing.size] = 0.0
        force[n:] = (self.nodal_forces(evaluation) @ housing.frame[:, :3].T).ravel()
        return force

    def _film_tangent(self, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (6 + 3 count, 10 + 4 count) of wrench and nodal forces."""
        wrench, nodal = self._evaluation(trial).nodal_tangent()
        return np.concatenate((wrench, nodal.reshape(3 * self.count, -1)))

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        evaluation, T = self._evaluation(trial), self._tangent(trial, f_q, f_qt)
        n, n_h, k = self.rigid_size, self.sides[0].size, 2 * self.count
        rigid = self._rigid_derivatives(mbs, trial, np.ascontiguousarray(T[:6, :MOTION_SIZE]))
        by_place, by_rate = T[:, MOTION_SIZE : MOTION_SIZE + k], T[:, MOTION_SIZE + k :]
        place, rate_place = self._housing_maps()
        A, omega = self.sides[0].frame[:, :3], self.sides[0].frame[:, 5]
        along = A[:, :2].T
        # the rate in the turning frame changes with the place as -omega x u
        turning = along @ -relative.skew(omega)
        by_bore = [np.zeros((6 + 3 * self.count, n + 3 * self.count)) for _ in range(2)]
        by_bore[0][:, :n_h] = by_place @ place + by_rate @ rate_place
        by_bore[1][:, :n_h] = by_rate @ place
        by_bore[0][:, n:] = _per_node(by_place, along) + _per_node(by_rate, turning)
        by_bore[1][:, n:] = _per_node(by_rate, along)
        stiffness, damping = (
            self._assemble(b, block, T[:, :MOTION_SIZE] @ motion)
            for b, block, motion in zip(by_bore, rigid[:2], rigid[2:], strict=True)
        )
        if n_h:
            stiffness[n:, :n_h] += self._turning_forces(evaluation)
        return -(f_q * stiffness + f_qt * damping)

    def operator(
        self, mbs: exu.MainSystem, t: float, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> NodalTangent | None:
        """The matrix of `jacobian` as an operator, valid until the film's next evaluation; None if there is no film."""
        trial = self._try(mbs, q, q_t, CURRENT, t)
        return NodalTangent(self, mbs, trial, f_q, f_qt) if trial.status == Status.CONVERGED else None

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

    def _assemble(self, by_bore: np.ndarray, rigid: np.ndarray, by_motion: np.ndarray) -> np.ndarray:
        """dQ/dq or dQ/dq_t (N, N).

        Parameters
        ----------
        by_bore : (6 + 3 count, N) array
            Derivatives of wrench and nodal forces through the bore's motion.
        rigid : (n, n) array
            Those of the generalized forces on the sides through the journal's motion, with geometric terms.
        by_motion : (6 + 3 count, n) array
            Derivatives of wrench and nodal forces through the journal's motion.
        """
        n, n_h = self.rigid_size, self.sides[0].size
        size = by_bore.shape[1]
        whole = np.zeros((size, size))
        whole[n_h:n] = self._wrench_map()[n_h:] @ by_bore[:6]
        whole[n_h:n, :n] += rigid[n_h:]
        by_bore[:, :n] += by_motion
        local = by_bore[6:].reshape(self.count, 3, size)
        nodal = complete(self.arms @ self.sides[0].frame[:, :3], by_bore[:6], local)
        whole[n:] = np.einsum("ij,ajc->aic", self.sides[0].frame[:, :3], nodal).reshape(-1, size)
        return whole


class NodalTangent:
    """Minus (f_q dQ/dq + f_qt dQ/dq_t) of a film on a nodal bush as an operator: one film solve per product.

    Parameters
    ----------
    element : NodalFilmElement
    mbs : exudyn.MainSystem
    trial : Trial
        The last one of the element.
    f_q, f_qt : float
    """

    def __init__(self, element: NodalFilmElement, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> None:
        evaluation = element._evaluation(trial)
        self.film = evaluation.nodal_product()
        self.factors = f_q, f_qt
        self.n, self.n_h, self.count = element.rigid_size, element.sides[0].size, element.count
        stiffness, damping, by_place, by_rate = element._rigid_derivatives(mbs, trial, self.film.wrench)
        self.rigid = (f_q * stiffness + f_qt * damping)[self.n_h :]
        self.motion = f_q * by_place + f_qt * by_rate
        self.journal = element._wrench_map()[self.n_h :]
        self.frame, omega = element.sides[0].frame[:, :3], element.sides[0].frame[:, 5]
        self.turning = (self.frame[:, :2].T @ -relative.skew(omega)).T
        x = element.arms @ self.frame
        self.spread, self.resultant = spread_matrix(x).reshape(-1, 6), resultant(x)
        if self.n_h:
            self.place, self.drift = element._housing_maps()
            self.turned = f_q * element._turning_forces(evaluation)

    def __call__(self, change: np.ndarray) -> np.ndarray:
        """Product (N,) with a change (N,) of the element's coordinates."""
        n, n_h, film, (f_q, f_qt) = self.n, self.n_h, self.film, self.factors
        nodes = change[n:].reshape(-1, 3)
        moved, drift = (nodes @ self.frame[:, :2]).ravel(), (nodes @ self.turning).ravel()
        if n_h:
            moved += self.place @ change[:n_h]
            drift += self.drift @ change[:n_h]
        place, rate = f_q * moved, f_q * drift + f_qt * moved
        motion = self.motion @ change[:n]
        local = film.nodal_forces(motion, place, rate)
        through_bore = film.wrench_place @ place + film.wrench_rate @ rate
        rest = through_bore + film.wrench @ motion + self.resultant @ local.ravel()
        nodal = local + (self.spread @ -rest).reshape(-1, 3)
        out = np.empty_like(change)
        out[:n_h] = 0.0
        out[n_h:n] = self.journal @ through_bore + self.rigid @ change[:n]
        out[n:] = (nodal @ self.frame.T).ravel()
        if n_h:
            out[n:] += self.turned @ change[:n_h]
        return np.negative(out, out=out)


def _per_node(rows: np.ndarray, map_: np.ndarray) -> np.ndarray:
    """Rows (r, 2 count) times a block diagonal map of (2, 3) blocks, (r, 3 count)."""
    return (rows.reshape(len(rows), -1, 2) @ map_).reshape(len(rows), -1)
