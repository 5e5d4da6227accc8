"""Response of a film to small motions of the journal about a steady state, at any frequency.

A film with a memory follows the journal with a delay, so that stiffness and damping depend on the frequency nu. The
unknowns u are pressures of full vertices and fills of cavitated ones. With their steady balance ``r(u, x) = 0`` at the
position x, and the volume ``C(u, x)`` stored at the vertices, a small motion ``x exp(i nu t)`` gives

    (A + i nu S) u + (B + i nu T) x = 0,    A = dr/du, S = area dC/du, B = dr/dx, T = area dC/dx,

for fixed sets of full and cavitated vertices. Stored volumes are: the oil of a mass-conserving film, the deflection of
a liner, and the compressible oil of supply areas with a restrictor. The amplitude of the force is ``-Z x`` with the
dynamic stiffness ``Z = K + i nu C``, from one adjoint solve of ``(A + i nu S)^T`` per component of the force. For nu =
0 it is the stiffness of the steady film. For nu to infinity, C tends to the damping of a sudden velocity.

A flexible bore or journal with the stiffness K_q deflects by q. The deflection follows with a delay, because the film
between the surfaces has to be squeezed. With Z of the journal's and the bore's coordinates together,

    Z(nu) = Z_xx - Z_xq (K_q + Z_qq)^-1 Z_qx.

For a film without a memory of its oil, the Z of these coordinates is ``K + i nu C`` of its tangent.

Threshold of whirl: the vibration of a rotor of mass M on the bearing neither grows nor decays if ``Z(nu)`` has the real
eigenvalue ``M nu^2``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy
from scipy.linalg import block_diag
from scipy.sparse import block_diag as block_diag_sparse
from scipy.sparse import csc_matrix, diags_array, identity
from scipy.sparse.linalg import splu

from exudyn_ehd.film.reynolds.gap import Gradients, join
from exudyn_ehd.film.solvers.liner import LinerFilm
from exudyn_ehd.joint.bore.shapes import Bore, dense
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import LARGEST_SPREAD, MOTION_SIZE, SolvedFilm
from exudyn_ehd.joint.tangent.bore import Balances, load_columns
from exudyn_ehd.joint.tangent.wrench import balance_gradients, to_true_gap, true_fills, wrench_rows
from exudyn_ehd.status import ROUNDING, FilmError

# Range of whirl ratios in which a threshold is searched; for journal bearings the whirl ratio is near one half.
SLOWEST, FASTEST = 0.05, 2.0
# Number of values, in a range of frequencies or speeds, at which a search for a threshold begins. More: fewer missed
# thresholds, slower.
SCAN = 16
# Whirl ratios at which the response of a bore with many coordinates is computed, to reduce them to the space of these
# responses; also frequencies over the rates at which the pressures of supply areas settle. Fewer: larger error. Error
# of the critical mass of soft bushes 2e-9, of Z from 0 to 4 times the spin 5e-7.
SAMPLES = (0.0, 0.2, 0.5, 1.0, 2.0)
# Complex frequencies over the speed, with arguments of 0, 25 and 50 degrees (decaying motions), at which the responses
# for `FilmResponse.linear` are computed. Error of Z: 2e-7 for motions of up to 15 oscillations per turn, and for
# motions that decay far faster.
RAYS = np.outer((0.1, 0.4, 1.0, 2.5, 6.0, 15.0, 60.0, 300.0), np.exp(1j * np.radians((0.0, 25.0, 50.0)))).ravel()
# Map (4, 6) from a wrench to the loads that do work on a journal's coordinates x, y, bx, by: F_x, F_y, M_y, -M_x.
LOADS = np.eye(6)[[0, 1, 4, 3]] * [[1.0], [1.0], [1.0], [-1.0]]
PLACES = len(LOADS)


def slow_motions(tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """K and C (4, 4) of x, y (m) and slopes bx, by (rad): minus the derivatives of F_x, F_y (N), M_y, -M_x (N m).

    ``tangent`` (6, 10) is that of the wrench to the motion.
    """
    rows = -LOADS @ tangent
    return rows[:, :PLACES], rows[:, PLACES : 2 * PLACES]


class FilmResponse:
    """Dynamic stiffness of a film that conserves mass, on a liner or a flexible bore, or fed by a compressible volume.

    Coordinates q (k,) of a flexible bore or journal are motions like the journal's four.

    Parameters
    ----------
    evaluation : Evaluation
        Steady film, in balance with its bore. Its data are copied, so that the model may evaluate other states.

    Attributes
    ----------
    rates : (k,) array
        Rates at which the pressures of supply areas with a compressible volume settle at rest, 1/s.
    speed : float
        Spin, rad/s, > 0.
    stiffness : (k, k) array
        Stiffness of a flexible bore or journal in its coordinates.
    fastest : float
        Frequency above which Z does not hold, rad/s: the rupture line inside the cells does not see a liner deflect.
    remembers : bool
        True: the film has a memory, so that its forces depend on the frequency.
    """

    def __init__(self, evaluation: Evaluation) -> None:
        film, bore, m = evaluation.solved, None, MOTION_SIZE
        self.speed = abs(film.journal.omega)
        self.rates, self.stiffness, self.remembers, self.fastest = np.zeros(0), np.zeros((0, 0)), True, math.inf
        if isinstance(evaluation, ElasticEvaluation):
            elasticity, bore = evaluation.model.elasticity, evaluation.model.bore
            T, self.stiffness = elasticity.tangent(evaluation, exact=True), elasticity.stiffness.copy()
            self.remembers = film.solver.closure.conserves_mass or film.solver.pockets is not None
        else:
            T = evaluation.steady_tangent()
        if self.remembers:
            self._take(film, bore)
        k = len(self.stiffness)
        rows = -np.vstack((LOADS @ T[:6], T[6:]))
        pose, rate = self._gradients(0.0)
        # stiffness and damping of slow motions without the part by the film's unknowns
        self.rest = (
            np.hstack((rows[:, :PLACES], rows[:, m : m + k])) - pose,
            np.hstack((rows[:, PLACES : 2 * PLACES], rows[:, m + k :])) - rate,
        )
        if film.parts.liner is not None:
            self._let_follow(film, film.parts.liner)
        if self.remembers and k > 2 * PLACES * len(SAMPLES):
            self._reduce([self._followed(self._whole(nu)) for nu in self._frequencies(SAMPLES)])

    def _take(self, film: SolvedFilm, bore: Bore | None) -> None:
        """Copy the balances of a film, its stored volumes, and the derivatives of both to the motions."""
        s, w = film.solver, film.solver.work
        order, number = w.order[: w.count].copy(), np.full(w.order.size, -1)
        number[order] = np.arange(order.size)
        rows = -LOADS @ wrench_rows(film) / film.scales.force
        stored = np.zeros(film.grid.shape)
        self.matrix = s.matrix()
        if s.closure.conserves_mass:
            whole = s.area * s.H
            if s.law is not None:
                stored += whole * s.fill * s.rho_P
                whole = whole * s.rho
            if s.oil_line is not None:
                stored += whole * s.oil_line.rise
            stored = np.where(w.active, stored, whole)
        areas = s.unknowns - w.count  # number of supply areas with an unknown pressure
        self.store = diags_array(np.append(stored.reshape(-1)[order], np.zeros(areas)) + s.surroundings())
        if s.reservoirs is not None:
            filled = s.reservoirs.storage()
            at = filled > 0.0
            self.rates = np.diag(s.reservoirs.derivatives(s.reduced()[2]))[at] / filled[at]
        self.rows = rows.T.astype(complex)
        scale = -(film.scales.force * film.parts.motion_scale)[:, None]
        by_motion, by_fill = balance_gradients(film) * scale, np.zeros((MOTION_SIZE, w.count + areas))
        contents = None
        if s.closure.conserves_mass:
            # the unknowns and the storage of a steady film are those with the fills of its flows, not of its vertices
            carried, rise = s.flows_by_fills()
            by_flow = block_diag_sparse((carried[order][:, order], identity(areas)), format="csc")
            self.matrix, self.rows = self.matrix @ by_flow, by_flow.T @ self.rows
            moved = s.elements.gap_slopes.H_r if s.elements is not None else 1.0
            by = np.zeros((10, w.count))
            by[2] = -(rise * whole / s.H * moved).ravel()[order]
            contents = to_true_gap(film, Gradients(np.arange(w.count), order, by))
            if (fills := true_fills(film)) is not None:
                contents = join(contents, fills.weighed(whole, number))
            by_fill = contents.columns(film.grid.gap_shapes, w.count + areas) * scale
        # the content at fixed unknowns depends on the position, at the rupture line also on the velocity, so that its
        # rate enters the balances
        # derivatives of the balances to places and to rates, and of the contents to places and to rates
        self.by = np.stack([part[at : at + PLACES] for part in (by_motion, by_fill) for at in (0, PLACES)])
        if bore is not None:
            self._add_bore(film, bore, contents)

    def _let_follow(self, film: SolvedFilm, liner: LinerFilm) -> None:
        """Add the deflection rates of a liner on which surfaces touch to the balances.

        Neither the tangent nor the rupture line contains them.
        """
        s, w, by_gap = film.solver, film.solver.work, self.by[1]
        if (line := s.line_gradients()) is not None:
            self.fastest = self.speed * float(np.abs(RAYS).max())
            scale = -film.scales.force * film.parts.motion_scale[PLACES : 2 * PLACES, None]
            by_gap = by_gap - line.columns(film.grid.gap_shapes, s.unknowns)[PLACES : 2 * PLACES] * scale
        follows = np.append(liner.gap_slopes.D_r.reshape(-1)[w.order[: w.count]], np.zeros(s.unknowns - w.count))
        self.by[1] += by_gap * follows

    def _add_bore(self, film: SolvedFilm, bore: Bore, contents: Gradients | None) -> None:
        """Add the loads on the bore to those on the journal, and its coordinates to the motion."""
        balances, force = Balances(film), film.scales.force
        self.rows = np.concatenate((self.rows, dense(-load_columns(film, bore)) / force), axis=1)
        own, ends = np.zeros((4, bore.size, balances.count)), ((1.0, 0.0), (0.0, 1.0))
        own[:2] = [-force * balances.times(bore.shapes, *factors).T for factors in ends]
        if contents is not None:
            at, by = (film.grid.shape, balances.count), -force / balances.clearance
            own[2:] = [by * dense(contents.matrix(*at, *factors) @ bore.shapes).T for factors in ends]
        self.by = np.concatenate((self.by, own), axis=1)

    def linear(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """K, C and M (p, p) of ``K z + C z_t + M z_tt = load`` for z = (journal's motions, q, reduced film unknowns).

        The film's unknowns and balances are projected on the space of the responses to motions and to loads at some
        frequencies. At these frequencies Z and its derivative are exact.
        """
        K, C = self.rest[0] + np.pad(self.stiffness, (PLACES, 0)), self.rest[1]
        if not self.remembers:
            return K, C, np.zeros_like(K)
        found = []
        for nu in self._frequencies((0.0, *RAYS)):
            factor = splu(csc_matrix(self.matrix + 1j * nu * self.store), permc_spec="NATURAL")
            Z = self._whole(nu)
            motions, loads = (np.vstack((np.eye(PLACES), self._followed(way))) for way in (Z, Z.T))
            by_motion = self.by[0] + 1j * nu * (self.by[1] + self.by[2]) - nu**2 * self.by[3]
            found += [factor.solve(by_motion.T @ motions), factor.solve(self.rows @ loads, trans="T")]
        V = _real_space(found)
        none, film = np.zeros((len(K), V.shape[1])), np.zeros((V.shape[1], V.shape[1]))
        return (
            np.block([[K, -self.rows.real.T @ V], [V.T @ self.by[0].T, V.T @ (self.matrix @ V)]]),
            np.block([[C, none], [V.T @ (self.by[1] + self.by[2]).T, V.T @ (self.store @ V)]]),
            np.block([[np.zeros_like(K), none], [V.T @ self.by[3].T, film]]),
        )

    def _frequencies(self, shares: Sequence[complex]) -> np.ndarray:
        """Frequencies, rad/s: ``shares`` of the speed, and `SAMPLES` of the rates of supply areas."""
        beside = np.outer(SAMPLES[1:], (self.rates.min(), self.rates.max())).ravel() if self.rates.size else ()
        return np.array((*(self.speed * np.array(shares)), *beside))

    def add(self, stiffness: np.ndarray, damping: np.ndarray) -> None:
        """Add K and C (2, 2) that do not depend on the frequency."""
        self.rest[0][:2, :2] += stiffness
        self.rest[1][:2, :2] += damping

    def at(self, frequency: complex) -> np.ndarray:
        """Z (4, 4) in the coordinates of `slow_motions`, at a frequency, rad/s.

        A complex frequency stands for motions that grow or decay.
        """
        Z = self._whole(frequency)
        return Z[:PLACES, :PLACES] + Z[:PLACES, PLACES:] @ self._followed(Z)

    def _whole(self, frequency: complex) -> np.ndarray:
        """Z (4 + k, 4 + k) of the journal's motions and q."""
        pose, rate = self._gradients(frequency)
        return self.rest[0] + pose + 1j * frequency * (self.rest[1] + rate)

    def _gradients(self, frequency: complex) -> tuple[np.ndarray | float, np.ndarray | float]:
        """Contributions of the film's memory to stiffness and damping at a frequency, rad/s, (4 + k, 4 + k) each."""
        if not self.remembers:
            return 0.0, 0.0
        # the unknowns are numbered for a narrow band
        factor = splu(csc_matrix(self.matrix + 1j * frequency * self.store), permc_spec="NATURAL")
        lam = factor.solve(self.rows, trans="T")
        pose, rate = (self.by[:2] + 1j * frequency * self.by[2:]) @ lam
        return pose.T, rate.T

    def _followed(self, Z: np.ndarray) -> np.ndarray:
        """Amplitudes q (k, 4) by unit motions of the journal."""
        return -np.linalg.solve(self.stiffness + Z[PLACES:, PLACES:], Z[PLACES:, :PLACES])

    def _reduce(self, found: list[np.ndarray]) -> None:
        """Reduce q to the space of its responses ``found`` at some frequencies."""
        space = _real_space(found)
        V = block_diag(np.eye(PLACES), space)
        self.rows, self.by = self.rows @ V, V.T @ self.by
        self.rest = V.T @ self.rest[0] @ V, V.T @ self.rest[1] @ V
        self.stiffness = space.T @ self.stiffness @ space


def _real_space(found: list[np.ndarray]) -> np.ndarray:
    """Orthonormal basis (n, p) of the real and imaginary parts of complex columns (n, m), up to round-off."""
    columns = np.concatenate([part for some in found for part in (some.real, some.imag)], axis=1)
    lengths = np.linalg.norm(columns, axis=0)
    return np.asarray(scipy.linalg.orth(columns[:, lengths > 0.0] / lengths[lengths > 0.0]))


class FilmMemory(NamedTuple):
    """A film whose stiffness and damping depend on the frequency, in n coordinates y of a system.

    Attributes
    ----------
    response : FilmResponse
    slow : two (4, 4) arrays
        K and C of slow motions, which the system's matrices already contain.
    loads, places : (n, 4), (4, n) arrays
        Forces on y per load of `slow_motions`, and coordinates of `slow_motions` per y.
    """

    response: FilmResponse
    slow: tuple[np.ndarray, np.ndarray]
    loads: np.ndarray
    places: np.ndarray

    def beyond(self, s: complex) -> np.ndarray:
        """Dynamic stiffness (n, n) of motions exp(s t), minus K + s C of slow motions."""
        stiffness, damping = self.slow
        return self.loads @ (self.response.at(-1j * s) - stiffness - s * damping) @ self.places


def response_of(evaluation: Evaluation) -> tuple[tuple[np.ndarray, np.ndarray], FilmResponse | None]:
    """K and C (4, 4) of slow motions, and the response at other frequencies; None if K and C are independent of it.

    Parameters
    ----------
    evaluation : Evaluation
        A steady film, the model's last. At the exact centre it is replaced by a film slightly off the centre, if the
        film has a memory and does not conserve mass.
    """
    model = evaluation.model
    has_memory = model.remembers_mass or model.flexible or model.parts.liner is not None
    has_memory = has_memory or model.solver.pockets is not None
    if has_memory and not model.remembers_mass and evaluation.is_central:
        evaluation = evaluation.beside()
    slow = slow_motions(evaluation.steady_tangent(exact=True))
    return slow, FilmResponse(evaluation) if has_memory else None


def require_derivatives(evaluation: Evaluation, where: str) -> None:
    """Raise `FilmError` in the name of ``where`` if K and C slightly off the centre depend on the direction."""
    tangents = evaluation.tangents_beside(exact=True)
    for block in (tangents[:, :2, :2], tangents[:, :2, 4:6]):
        mean = block.mean(axis=0)
        spread = float(np.abs(block - mean).max()) / max(float(np.abs(mean).max()), 1e-300)
        if spread > max(LARGEST_SPREAD, 2.0 / evaluation.solved.grid.x.size):
            raise FilmError(
                f"{where}: at the exact centre this film has no stiffness and damping: it ruptures on the side that "
                f"opens, and its force differs by {spread:.0%} between the directions of a displacement, because a "
                "supply area, a profile or a soft surface breaks the symmetry; give a small load across the axis, "
                "which sets the direction, or a supply pressure above the cavity pressure."
            )


def whirl_stiffness(stiffness: np.ndarray, damping: np.ndarray) -> tuple[float, float]:
    """Stiffness k at the threshold of whirl, see `whirl_threshold`, and the determinant of K - k.

    nan if the trace of the damping is not positive.
    """
    (kxx, kxy), (kyx, kyy) = stiffness
    (cxx, cxy), (cyx, cyy) = damping
    if cxx + cyy <= 0.0:
        return math.nan, math.nan
    k = (kxx * cyy + kyy * cxx - kxy * cyx - kyx * cxy) / (cxx + cyy)
    return k, (k - kxx) * (k - kyy) - kxy * kyx


def whirl_threshold(stiffness: np.ndarray, damping: np.ndarray, omega: float) -> tuple[float, float]:
    """Whirl ratio and critical mass of a rigid rotor on one bearing (half of a symmetric rotor on two).

    With ``det(M s^2 + C s + K) = 0`` at ``s = i gamma omega``::

        k = (Kxx Cyy + Kyy Cxx - Kxy Cyx - Kyx Cxy) / (Cxx + Cyy),
        (gamma omega)^2 = ((k - Kxx)(k - Kyy) - Kxy Kyx) / (Cxx Cyy - Cxy Cyx),   M = k / (gamma omega)^2.

    Source: J. W. Lund, J. Tribology 109 (1987) 37, derived again from the determinant.

    Parameters
    ----------
    stiffness, damping : (2, 2) arrays
    omega : float
        Spin, rad/s, > 0.

    Returns
    -------
    whirl_ratio, critical_mass : float
        (nan, inf) if stable at any mass; (nan, 0) if unstable at any mass, because k is not positive or C is singular.
    """
    k, above = whirl_stiffness(stiffness, damping)
    below = damping[0, 0] * damping[1, 1] - damping[0, 1] * damping[1, 0]
    # an unbroken film about the centre has k = 0, with round-off of either sign
    rounding = ROUNDING * float(np.abs(stiffness).max())
    if math.isnan(k) or k < -rounding or (k <= rounding and above <= 0.0):
        return math.nan, 0.0
    k = max(k, 0.0)
    if below == 0.0 < above:
        # whirl of unbounded frequency at a mass that tends to 0
        return math.nan, 0.0
    if below == 0.0 or above / below <= 0.0:
        return math.nan, math.inf
    square = above / below
    return math.sqrt(square) / omega, k / square


def threshold(
    stiffness: Callable[[float], np.ndarray], omega: float, rates: np.ndarray, fastest: float = math.inf
) -> tuple[float, float]:
    """Whirl ratio and critical mass of a rigid rotor on a bearing of the dynamic stiffness Z(nu).

    The first two coordinates of Z are x and y. Results as for `whirl_threshold`. Thresholds are searched for between
    0.05 and 2 times the spin omega > 0, with `FilmResponse.rates` also around these rates up to `FilmResponse.fastest`.
    The one with the smallest mass is returned.
    """

    def values(frequency: float) -> np.ndarray:
        found = np.linalg.eigvals(stiffness(frequency)[:2, :2])
        return found[np.argsort(found.imag)]

    nu = omega * np.geomspace(SLOWEST, FASTEST, SCAN)
    if rates.size:
        low, high = min(nu[0], rates.min() * SLOWEST**2), max(nu[-1], min(rates.max() / SLOWEST**2, fastest))
        nu = np.geomspace(low, high, math.ceil(SCAN * math.log(high / low) / math.log(FASTEST / SLOWEST)))
    imag, found = np.array([values(frequency).imag for frequency in nu]), []
    for k, q in np.argwhere(np.diff(np.sign(imag), axis=0)):
        frequency = scipy.optimize.brentq(lambda nu, q=q: values(nu)[q].imag, nu[k], nu[k + 1], rtol=1e-9)
        real = float(values(frequency)[q].real)
        if real > 0.0:
            found.append((real / frequency**2, frequency / omega))
    if found:
        mass, ratio = min(found)
        return ratio, mass
    return math.nan, math.inf if imag[0].min() > 0.0 else 0.0
