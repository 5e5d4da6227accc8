"""Response of a film to small motions of the journal where surfaces yield to its pressure, at any frequency.

What yields, q, follows with a delay, since the film between has to be squeezed. With the forces F on the journal and
the balance of q linear about a steady state, a small motion ``x exp(i nu t)`` gives

    q = (1 - i nu M)^-1 (X + i nu V) x,    M = A dQ/dq_t, X = A dQ/dx, V = A dQ/dx_t,    A = (K_q - dQ/dq)^-1,

of a bore or journal with the stiffness K_q and the film's loads Q on it. The dynamic stiffness is, exactly,

    Z(nu) = K + i nu C + nu^2 L (1 - i nu M)^-1 R,    R = M X + V,    L = dF/dq M + dF/dq_t,

K and C of the motion that q follows slowly. M has the times, some radians of a turn where a surface yields by a tenth
of the clearance, in which the film squeezes what yields back. On a liner, whose deflection follows the pressure of its
place, the same stands for the adjoint solutions of the film. L and R see little of M, which is replaced by its part on
their Krylov space.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.film.reynolds.gap import contract_pose
from exudyn_ehd.film.solvers.nonlinear import NonlinearFilmSolver
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE, SolvedFilm
from exudyn_ehd.joint.tangent.fields import add_by_motion
from exudyn_ehd.joint.tangent.wrench import adjoint_rows, liner_weights

# Vectors of the Krylov space, and share of a new one below which it lies in the space already.
LARGEST_SPACE, NOTHING_NEW = 60, 1e-10


@dataclass(frozen=True, eq=False)
class YieldingResponse:
    """Dynamic stiffness of a film between surfaces that yield; symbols of the module.

    Attributes
    ----------
    stiffness, damping : (2, 2) arrays
        K and C of slow motions, N/m and N s/m.
    left, core, right : (2, m), (m, m), (m, 2) arrays
        L, M and R.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    left: np.ndarray
    core: np.ndarray
    right: np.ndarray

    def at(self, frequency: float) -> np.ndarray:
        """Z (2, 2), N/m, at a frequency, rad/s."""
        followed = np.linalg.solve(np.eye(len(self.core)) - 1j * frequency * self.core, self.right)
        return self.stiffness + 1j * frequency * self.damping + frequency**2 * (self.left @ followed)


def yielding_response(evaluation: Evaluation, stiffness: np.ndarray, damping: np.ndarray) -> YieldingResponse | None:
    """Response of the last film of its model, of K and C (2, 2) for slow motions; None between rigid surfaces.

    Of films without a memory of their oil.
    """
    if isinstance(evaluation, ElasticEvaluation):
        return YieldingResponse(stiffness, damping, *_of_bore(evaluation))
    if evaluation.film is not None and evaluation.film.parts.liner is not None:
        return YieldingResponse(stiffness, damping, *_of_liner(evaluation.film, evaluation.film.parts.liner))
    return None


def _of_bore(evaluation: ElasticEvaluation) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """L, M and R of a flexible bore or journal."""
    elasticity, q = evaluation.model.elasticity, evaluation.bore.coordinates
    T, k, m = elasticity.refined_tangent(evaluation), q.size, MOTION_SIZE
    T = elasticity.tangent(evaluation) if T is None else T
    softening, place, rate = T[6:, m : m + k], T[:2, m : m + k], T[:2, m + k :]
    answers = elasticity.solve(q, softening, np.concatenate((T[6:, :2], T[6:, 4:6], T[6:, m + k :]), axis=1))
    X, V, M = answers[:, :2], answers[:, 2:4], answers[:, 4:]
    basis, core = _krylov(lambda v: M @ v, M @ X + V)
    return (place @ M + rate) @ basis, core, basis.T @ (M @ X + V)


def _of_liner(film: SolvedFilm, solver: NonlinearFilmSolver) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """L, M and R of a liner, by adjoint fields (n m,): L is what these start from, R what they do to the motion."""
    shape, w, p = film.grid.shape, film.solver.work, film.parts
    by_rate, yields, slope = solver.elements.deflection_weights, solver.deflection_by_pressure, solver.gap_slopes.D_r

    def delayed(field: np.ndarray) -> np.ndarray:
        weights = by_rate(field.reshape(1, *shape)) * yields
        return solver.adjoint(np.ascontiguousarray(weights.reshape(1, -1)[:, w.order[: w.count]])).ravel()

    first = solver.adjoint(np.ascontiguousarray(liner_weights(film)[:2] @ adjoint_rows(film)))
    starts = np.array([delayed(field) for field in first]).T
    basis, core = _krylov(delayed, starts)
    fields = basis.T.reshape(-1, *shape).copy()
    gradient, through = np.zeros((len(fields), MOTION_SIZE)), np.zeros((len(fields), 4))
    contract_pose(by_rate(fields) * slope, p.directions.cos_x, p.directions.sin_x, film.grid.z, through)
    add_by_motion(film, solver.sensitivities(fields), gradient)
    gradient *= p.motion_scale
    moved = core.T @ gradient[:, :2] + gradient[:, 4:6] + through[:, :2] * p.motion_scale[4:6]
    return (basis.T @ starts).T, core.T, moved


def _krylov(apply: Callable[[np.ndarray], np.ndarray], starts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal basis (n, m) of the Krylov space of a matrix and starts (n, r), and the matrix (m, m) on it."""
    basis: list[np.ndarray] = []
    images: list[np.ndarray] = []
    waiting = list(starts.T)
    while waiting and len(basis) < min(LARGEST_SPACE, len(starts)):
        vector = waiting.pop(0)
        rest = vector.copy()
        for _ in range(2):
            rest -= sum((known * (known @ rest) for known in basis), np.zeros_like(rest))
        size = float(np.linalg.norm(rest))
        if size > NOTHING_NEW * float(np.linalg.norm(vector)):
            basis.append(rest / size)
            images.append(apply(basis[-1]))
            waiting.append(images[-1])
    space = np.array(basis).reshape(len(basis), len(starts)).T
    return space, space.T @ np.array(images).reshape(space.T.shape).T
