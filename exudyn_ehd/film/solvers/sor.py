"""Finite differences and SOR iteration of Flores' EHD joint paper, Eqs. (8)-(11), as a reference to compare with.

In scaled form (lengths over R, H = h/c, P = p c^2 / (12 mu R^2)) Eq. (8) reads

    H^3 (P_xx + P_zz) + 3 H^2 (H_x P_x + H_z P_z) = vx H_x + vz H_z + H_t,   vx = omega / 2,

with central differences on a uniform grid (second order, not conservative), solved by successive over-relaxation in
place until sum |P_new - P_old| <= tolerance sum |P_new|, rule (11); then negative pressures are cut off (Gümbel).

Misprints of the paper, corrected here:

* (9), (10): the coefficient of p(i+1, j) carries + 3 h^2 (h(i+1, j) - h(i-1, j)); printed with a minus, as that of
  p(i-1, j);
* (10): dh/dt in a_0 is not squared;
* (10): p is relaxed towards the solution of its own equation, p + lambda [(a_0 - sum a_k p_k) / a_5 - p]; printed
  without - p;
* (11): the denominator is the sum of |p|; the sum of p of an unclipped periodic film vanishes;
* (5): the middle form needs phi = theta - beta + pi; (6): the angle needs both signs (atan2). Both are avoided here by
  using the last form of (5).

The paper does not give its relaxation factor. When rule (11) stops, the true error is larger than the tolerance, about
by the number of sweeps that reduce it by a factor of e. Compare with `FiniteLength` or a smaller tolerance to measure
it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numba import njit
from scipy.sparse import coo_matrix, csr_matrix, diags_array, eye_array, kron

from exudyn_ehd.film.banded.factors import factor_lu, number_cells
from exudyn_ehd.film.cavitation.linear_film import clip_pressure
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.status import POSITIVE, Checked, Status, require_count

LARGEST_SWEEPS = 20_000


@dataclass(frozen=True, kw_only=True)
class ClassicSOR(Checked):
    """Finite differences with successive over-relaxation (SOR) and Gümbel's condition, to compare with other codes.

    For comparison with Flores' paper on EHD joints and codes like it; `FiniteLength` is faster at the same error.
    Equations: `exudyn_ehd.film.solvers.sor`. Needs ``cavitation=Gumbel()``.

    Every solution starts from zero pressure, so that it depends on the state alone. It jumps by about ``tolerance``
    where the number of sweeps changes: take 1e-9 in joints with an implicit solver. The tangent is that of the
    converged difference operator (one banded LU factorisation), exact as the tolerance goes to zero.

    Parameters
    ----------
    n_theta : int, default 96
        Points around the circumference, at least 16.
    n_z : int, default 24
        Intervals along the bearing, at least 4.
    tolerance : float, default 1e-5
        Sweeps end when the sum of the pressure changes is at most this share of the sum of the pressures (absolute
        values); the paper's value is 1e-5.
    relaxation : float or None, default None
        Relaxation factor, between 0 and 2; None: 2 / (1 + sqrt(1 - rho^2)) with the spectral radius rho of Jacobi's
        iteration for a constant gap.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, film=ehd.ClassicSOR(), cavitation=ehd.Gumbel())
    >>> bearing.film.tolerance
    1e-05
    """

    n_theta: int = 96
    n_z: int = 24
    tolerance: float = 1e-5
    relaxation: float | None = None

    stretch = 0.0
    circumferential_pressure_flow = True

    checks: ClassVar = {
        "n_theta": partial(require_count, at_least=16, hint="96 is a good start."),
        "n_z": partial(require_count, at_least=4, hint="24 is a good start."),
        "tolerance": POSITIVE,
        "relaxation": partial(POSITIVE, below=2.0, hint="None chooses one."),
    }


def best_relaxation(n_z: int, step_x: float, step_z: float) -> float:
    """SOR factor for a constant gap: Young's 2 / (1 + sqrt(1 - rho^2)), p = 0 at both ends of a ring.

    Source: D. M. Young, Trans. AMS 76 (1954) 92; Jacobi's rho = (1/dx^2 + cos(pi / n_z) / dz^2) / (1/dx^2 + 1/dz^2).
    """
    x, z = 1.0 / step_x**2, 1.0 / step_z**2
    rho = (x + z * math.cos(math.pi / n_z)) / (x + z)
    return 2.0 / (1.0 + math.sqrt(1.0 - rho * rho))


class ClassicSolver(FilmSolver):
    """Film solver with the pressure of `ClassicSOR`; flows through the edges are those of the conservative links.

    Parameters
    ----------
    film : ClassicSOR
    grid, closure, squeeze
        As for `FilmSolver`; the grid uniform, the closure `Gumbel`.
    """

    def __init__(self, film: ClassicSOR, grid, closure, *, squeeze: bool) -> None:
        super().__init__(grid, closure, squeeze=squeeze)
        self.symmetric = False
        self.film = film
        self.step_x = float(grid.width_x[0])
        self.step_z = float(grid.z[1] - grid.z[0])
        chosen = film.relaxation
        self.relaxation = best_relaxation(film.n_z, self.step_x, self.step_z) if chosen is None else chosen
        self.slope_x, self.slope_z, self.curvature = difference_operators(grid.shape, self.step_x, self.step_z)

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve as `FilmSolver.solve`; the second returned value is the number of sweeps."""
        g, s, w = self.grid, self.system, self.work
        self.vx, self.vz = vx, vz
        s.cavity_pressure = cavity_pressure
        self.set_links()
        self.set_right_hand_side()
        s.linear_pressure[:] = np.where(g.fixed, s.pressure, 0.0)
        a = coefficients(self.H, self.H_t, self.squeeze, (vx, vz), (self.step_x, self.step_z))
        sweeps = sor_solve(a, g.fixed, self.relaxation, self.film.tolerance, LARGEST_SWEEPS, s.linear_pressure)
        np.logical_not(g.fixed, out=w.active)
        w.count, w.width = number_cells(w.active, s.kx, w.order, w.number)
        clip_pressure(s.linear_pressure, g.fixed, cavity_pressure, s.pressure, w.active)
        ok = sweeps > 0 and bool(np.all(np.isfinite(s.linear_pressure)))
        return (Status.CONVERGED if ok else Status.NOT_CONVERGED), abs(sweeps)

    def factor_solution(self) -> None:
        """Factor the difference operator at the unknowns."""
        w, h = self.work, self.H.ravel()
        by_slope = (diags_array(3.0 * h * h * (d @ h)) @ d for d in (self.slope_x, self.slope_z))
        unknowns = w.order[: w.count]
        a = coo_matrix(csr_matrix(sum(by_slope, diags_array(h**3) @ self.curvature))[unknowns][:, unknowns])
        (lower, upper), above = self._bands(), a.col >= a.row
        lower[:] = upper[:] = 0.0
        upper[a.row[above], (a.col - a.row)[above]] = a.data[above]
        lower[a.col[~above], (a.row - a.col)[~above]] = a.data[~above]
        factor_lu(lower, upper, w.count, w.width, w.inv_diag)

    def difference_columns(self, gaps: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Derivatives (k + 2, count) of the difference equations at the unknowns to k changes of the gap and to vx, vz.

        ``gaps``, ``rates`` (n m, k): changes of the scaled gap and of its rate.
        """
        h, P = self.H.ravel(), self.system.linear_pressure.ravel()
        out, speed = (3.0 * h * h * (self.curvature @ P))[:, None] * gaps, []
        for d, v in ((self.slope_x, self.vx), (self.slope_z, self.vz)):
            out += (6.0 * h * (d @ h) * (d @ P))[:, None] * gaps + (3.0 * h * h * (d @ P) - v)[:, None] * (d @ gaps)
            speed.append(-(d @ h))
        if self.squeeze:
            out -= rates
        return np.concatenate((out.T, speed))[:, self.work.order[: self.work.count]]


def difference_operators(
    shape: tuple[int, int], step_x: float, step_z: float
) -> tuple[csr_matrix, csr_matrix, csr_matrix]:
    """Central differences on a ring of n columns and m rows: slopes in theta and z, and sum of both second differences.

    They are valid in the rows between both ends.
    """
    n, m = shape
    on_x, on_z = (
        diags_array([1.0, 1.0], offsets=[1, 1 - n], shape=(n, n)),
        diags_array([1.0], offsets=[1], shape=(m, m)),
    )
    slope_x = kron((on_x - on_x.T) / (2.0 * step_x), eye_array(m))
    slope_z = kron(eye_array(n), (on_z - on_z.T) / (2.0 * step_z))
    second_x = kron((on_x + on_x.T - 2.0 * eye_array(n)) / step_x**2, eye_array(m))
    second_z = kron(eye_array(n), (on_z + on_z.T - 2.0 * eye_array(m)) / step_z**2)
    return csr_matrix(slope_x), csr_matrix(slope_z), csr_matrix(second_x + second_z)


def coefficients(
    H: np.ndarray, H_t: np.ndarray, squeeze: bool, speeds: tuple[float, float], steps: tuple[float, float]
) -> np.ndarray:
    """Coefficients (n, m, 5) of Eq. (10), valid in the rows between both ends: of the pressures before and behind a
    vertex in theta, of those in z, and the source; all over the coefficient of the vertex's own pressure."""
    (vx, vz), (dx, dz) = speeds, steps
    x, z = (np.roll(H, -1, axis) - np.roll(H, 1, axis) for axis in (0, 1))
    cube, slope_x_term, slope_z_term = H**3, 0.75 * H * H * x, 0.75 * H * H * z
    source = 0.5 * (vx * x / dx + vz * z / dz) + (H_t if squeeze else 0.0)
    around = (
        (cube - slope_x_term) / dx**2,
        (cube + slope_x_term) / dx**2,
        (cube - slope_z_term) / dz**2,
        (cube + slope_z_term) / dz**2,
    )
    return np.stack((*around, source), axis=-1) / (-2.0 * cube * (1.0 / dx**2 + 1.0 / dz**2))[..., None]


@njit(cache=True)
def sor_solve(a, fixed, relaxation, tolerance, largest_sweeps, P):
    """Solve by SOR with `coefficients`, in place; P (n, m) holds the prescribed values at fixed vertices.

    Returns the number of sweeps, negative if not converged.
    """
    n, m = P.shape
    for sweep in range(1, largest_sweeps + 1):
        change = 0.0
        total = 0.0
        for i in range(n):
            prv = i - 1 if i > 0 else n - 1
            nxt = i + 1 if i + 1 < n else 0
            for j in range(1, m - 1):
                if fixed[i, j]:
                    continue
                c = a[i, j]
                target = c[4] - c[0] * P[prv, j] - c[1] * P[nxt, j] - c[2] * P[i, j - 1] - c[3] * P[i, j + 1]
                step = relaxation * (target - P[i, j])
                P[i, j] += step
                change += abs(step)
                total += abs(P[i, j])
        if not total < np.inf:
            return -sweep
        if change <= tolerance * total:
            return sweep
    return -largest_sweeps
