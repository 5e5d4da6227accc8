"""Response of a mass-conserving film to small motions of the journal about a steady state, at any frequency.

The cavity's oil follows the journal with a delay, so that stiffness and damping depend on the frequency nu. With the
steady balance ``r(u, x) = 0`` of the unknowns u (pressures of full vertices, fills of cavitated ones) for the position
x, and the oil content ``C(u, x)`` of the vertices, a small motion ``x exp(i nu t)`` gives

    (A + i nu S) u + (B + i nu T) x = 0,    A = dr/du, S = area dC/du, B = dr/dx, T = area dC/dx,

at fixed sets of full and cavitated vertices. The force's amplitude is ``-Z x`` with the dynamic stiffness
``Z = K + i nu C``, from one adjoint solve of ``(A + i nu S)^T`` per component of the force. For nu = 0 it is the
stiffness of the steady film; for nu without bounds C tends to that of a sudden velocity. On a liner A and S count its
deflection as well.

The threshold of whirl: a rotor of mass M on the bearing neither grows nor decays where ``Z(i nu)`` has the real
eigenvalue ``M nu^2``.

Response of a film to small motions of the journal where surfaces yield to its pressure, at any frequency.

What yields, q, follows with a delay, since the film between has to be squeezed. With the forces F on the journal and
the balance of q linear about a steady state, a small motion ``x exp(i nu t)`` gives

    q = (1 - i nu M)^-1 (X + i nu V) x,    M = A dQ/dq_t, X = A dQ/dx, V = A dQ/dx_t,    A = (K_q - dQ/dq)^-1,

of a bore or journal with the stiffness K_q and the film's loads Q on it. Of a mass-conserving film the loads depend
on the frequency too: with Z of the journal's and the bore's coordinates together, as for the rigid journal,

    Z(nu) = Z_xx - Z_xq (K_q + Z_qq)^-1 Z_qx.

Without a memory of the oil the dynamic stiffness is, exactly,

    Z(nu) = K + i nu C + nu^2 L (1 - i nu M)^-1 R,    R = M X + V,    L = dF/dq M + dF/dq_t,

K and C of the motion that q follows slowly. M has the times, some radians of a turn where a surface yields by a tenth
of the clearance, in which the film squeezes what yields back. On a liner, whose deflection follows the pressure of its
place, the same stands for the adjoint solutions of the film. L and R see little of M, which is replaced by its part on
their Krylov space.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag
from scipy.optimize import brentq
from scipy.sparse import csc_matrix, csr_matrix, diags_array
from scipy.sparse.linalg import splu

from exudyn_ehd.film.cavitation.rupture_line import line_matrices
from exudyn_ehd.film.reynolds.gap import contract_pose
from exudyn_ehd.film.solvers.nonlinear import NonlinearFilmSolver
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE, SolvedFilm
from exudyn_ehd.joint.tangent.bore import Balances, load_columns
from exudyn_ehd.joint.tangent.line import add_by_motion, line_by_motion, true_fills, weigh_fills
from exudyn_ehd.joint.tangent.wrench import adjoint_rows, balance_gradients, liner_weights

# Whirl ratios between which a threshold is looked for: a journal bearing's is near one half.
SLOWEST, FASTEST, STEPS = 0.05, 2.0, 24
# Whirl ratios at which a bore of many coordinates is asked how it follows. The space of the answers tells the critical
# mass of soft bushes to 2e-9, and Z from 0 to 4 times the spin to 5e-7.
SAMPLES = (0.0, 0.2, 0.5, 1.0, 2.0)
# Vectors of the Krylov space, and share of a new one below which it lies in the space already.
LARGEST_SPACE, NOTHING_NEW = 60, 1e-10


class FilmResponse:
    """Dynamic stiffness of a film that conserves mass, on a rigid bore or a liner.

    Parameters
    ----------
    film : SolvedFilm
        Of the steady state; what is needed of it is copied.
    tangent : (6, 10) array
        Of the wrench there, for slow motions.
    """

    def __init__(self, film: SolvedFilm, tangent: np.ndarray) -> None:
        s, w, liner = film.solver, film.solver.work, film.parts.liner
        order, number = w.order[: w.count].copy(), np.full(w.order.size, -1)
        number[order] = np.arange(order.size)
        rows, followed = adjoint_rows(film), np.ones(order.size)
        rho = rho_P = None
        self.matrix = s.matrix()
        if s.law is not None:
            rho, rho_P = s.rho, s.rho_P
        density, denser = (1.0, 0.0) if rho is None or rho_P is None else (rho, rho_P)
        whole = s.area * s.H * density
        rises = s.area * s.fill * s.H * denser
        if s.oil_line is not None:
            rises += whole * s.oil_line.rise
        if liner is not None:
            rises += s.area * s.fill * liner.gap_slopes.H_P * density
            followed = 1.0 + liner.gap_slopes.D_r.reshape(-1)[order]
            rows = -liner_weights(film)[:2] @ rows / film.scales.force
        self.store = diags_array(np.where(w.active, rises, whole).reshape(-1)[order])
        self.rows = rows[:2].T.astype(complex)
        scale = -(film.scales.force * film.parts.motion_scale)[:, None]
        by_motion, by_fill = balance_gradients(film) * scale, np.zeros((MOTION_SIZE, w.count))
        fills, self.contents = true_fills(film), None
        if fills is not None:
            self.contents = weigh_fills(fills, whole, number)
            by_fill = line_by_motion(film, self.contents, w.count) * scale
        # the content at a mass-conserving film's line follows position and velocity: the balances feel its rate
        self.by_pose, self.by_rate = by_motion[:2].copy(), by_motion[4:6]
        self.by_content, self.by_sway = by_fill[:2], by_fill[4:6]
        self._rest_of(tangent[:2, :2], tangent[:2, 4:6])
        # the tangent knows no rate of a liner's deflection
        self.by_rate = self.by_rate * followed

    def _rest_of(self, by_place: np.ndarray, by_rate: np.ndarray) -> None:
        """Keep what the derivatives of the forces hold besides the film's pressure."""
        pose, rate = self._gradients(0.0)
        self.rest = -by_place - pose, -by_rate - rate

    def at(self, frequency: float) -> np.ndarray:
        """Z (2, 2), N/m, at a frequency, rad/s."""
        pose, rate = self._gradients(frequency)
        return self.rest[0] + pose + 1j * frequency * (self.rest[1] + rate)

    def _gradients(self, frequency: float) -> tuple[np.ndarray, np.ndarray]:
        """Contributions of the film's pressure to stiffness and damping at a frequency, rad/s, (2, 2) each, complex."""
        lam = splu(csc_matrix(self.matrix + 1j * frequency * self.store)).solve(self.rows, trans="T")
        pose, rate = self.by_pose + 1j * frequency * self.by_content, self.by_rate + 1j * frequency * self.by_sway
        return (pose @ lam).T, (rate @ lam).T


class FilmOnBoreResponse(FilmResponse):
    """Dynamic stiffness of a film on a flexible bore or journal, whose coordinates q are motions like the journal's.

    Parameters
    ----------
    evaluation : ElasticEvaluation
        In balance with the bore.
    """

    def __init__(self, evaluation: ElasticEvaluation) -> None:
        film, bore, elasticity = evaluation.film, evaluation.model.bore, evaluation.model.elasticity
        assert film is not None
        T, k, m = elasticity.refined_tangent(evaluation), bore.size, MOTION_SIZE
        T = elasticity.tangent(evaluation) if T is None else T
        super().__init__(film, T)
        balances, force = Balances(film), film.scales.force

        self.rows = np.concatenate((self.rows, -load_columns(film, bore) / force), axis=1)
        place, rate = (-force * _dense(balances.times(bore.shapes, *ends)).T for ends in ((1.0, 0.0), (0.0, 1.0)))
        sway = content = np.zeros_like(rate)
        if self.contents is not None:
            parts = line_matrices(self.contents, film.grid.shape, len(balances.places))
            content, sway = (-force / balances.clearance * _dense(part @ bore.shapes).T for part in parts)
        self.by_pose, self.by_rate = np.concatenate((self.by_pose, place)), np.concatenate((self.by_rate, rate))
        self.by_content, self.by_sway = np.concatenate((self.by_content, content)), np.concatenate((self.by_sway, sway))
        forces = np.r_[0:2, 6 : 6 + k]
        self._rest_of(T[np.ix_(forces, np.r_[0:2, m : m + k])], T[np.ix_(forces, np.r_[4:6, m + k : m + 2 * k])])
        self.stiffness = elasticity.stiffness.copy()
        if k > 4 * len(SAMPLES):
            speed, whole = abs(film.journal.omega), super().at
            self._reduce([self._followed(whole(ratio * speed)) for ratio in SAMPLES])

    def at(self, frequency: float) -> np.ndarray:
        """Z (2, 2), N/m, at a frequency, rad/s."""
        Z = super().at(frequency)
        return Z[:2, :2] + Z[:2, 2:] @ self._followed(Z)

    def _followed(self, Z: np.ndarray) -> np.ndarray:
        """q (k, 2) of unit motions of the journal."""
        return -np.linalg.solve(self.stiffness + Z[2:, 2:], Z[2:, :2])

    def _reduce(self, found: list[np.ndarray]) -> None:
        """Leave q in the space of what it was found to be at some frequencies."""
        columns = [part for q in found for part in (q.real, q.imag)]
        V = block_diag(np.eye(2), np.linalg.qr(np.concatenate(columns, axis=1))[0])
        self.rows, self.by_pose, self.by_rate = self.rows @ V, V.T @ self.by_pose, V.T @ self.by_rate
        self.by_content, self.by_sway = V.T @ self.by_content, V.T @ self.by_sway
        self.rest = V.T @ self.rest[0] @ V, V.T @ self.rest[1] @ V
        self.stiffness = V[2:, 2:].T @ self.stiffness @ V[2:, 2:]


def _dense(matrix: np.ndarray | csr_matrix) -> np.ndarray:
    return matrix if isinstance(matrix, np.ndarray) else np.asarray(matrix.toarray())


def threshold(stiffness: Callable[[float], np.ndarray], omega: float) -> tuple[float, float]:
    """Whirl ratio and critical mass of a rigid rotor on a bearing of the dynamic stiffness Z(nu) (2, 2).

    As `exudyn_ehd.joint.static.equilibrium.whirl_threshold`; thresholds are looked for between 0.05 and twice the
    spin omega > 0, and the one of the smallest mass counts.
    """

    def both(ratio: float) -> float:
        """Product of the imaginary parts of Z's eigenvalues: it changes sign where one of them is real."""
        return float(np.prod(np.linalg.eigvals(stiffness(ratio * omega)).imag))

    ratios = np.geomspace(SLOWEST, FASTEST, STEPS)
    signs = [both(ratio) for ratio in ratios]
    found = []
    for k in np.flatnonzero(np.diff(np.sign(signs))):
        ratio = brentq(both, ratios[k], ratios[k + 1], rtol=1e-9)
        values = np.linalg.eigvals(stiffness(ratio * omega))
        real = float(values[np.argmin(np.abs(values.imag))].real)
        if real > 0.0:
            found.append((real / (ratio * omega) ** 2, ratio))
    if found:
        mass, ratio = min(found)
        return ratio, mass
    return math.nan, math.inf if np.linalg.eigvals(stiffness(SLOWEST * omega)).imag.min() > 0.0 else 0.0


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
