"""Impedance map: the force of an aligned plain journal bearing from a table, in about a microsecond.

For an aligned journal at e = (x, y) with the spin omega, the right side of the Reynolds equation is

    omega / 2 dh/dtheta + dh/dt = -V . n,   V = (dx/dt + omega y / 2, dy/dt - omega x / 2),   n =
    (cos theta, sin theta):

in a frame that rotates with half the spin every motion is a pure squeeze with the velocity V (J. F. Booker, J.
Basic Engineering 87 (1965) 537; D. Childs, H. Moes, H. van Leeuwen, J. Lubrication Technology 99 (1977) 198). With p =
0 at the ends and in the cavity the pressure is homogeneous of first degree in V and independent of the housing's
orientation, so that

    F = -(L D mu / psi^2) |V| / c  exp(m) (cos(phi_V + sign g), sin(phi_V + sign g)),   phi_V = angle of V,

with two functions m, g of the eccentricity ratio eps and of the angle alpha in 0 .. pi between e and V; sign is the
sense of rotation from e to V. m is the logarithm of the force, g the angle between force and -V. Over
s = -ln(1 - eps) both are smooth, while the force itself changes by four orders of magnitude. The error is thus relative
to the force at the same state, also where the film nearly unloads (alpha above 90 degrees).

m and g are bicubic Hermite functions on a uniform (s, alpha) grid with spline slopes (C1; the symmetries at alpha = 0,
pi and at eps = 0 hold exactly), so that their derivatives are exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
import scipy
from numba import njit

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.grid import STRETCH, bearing_grid
from exudyn_ehd.film.loads import pressure_integrals
from exudyn_ehd.film.reynolds.gap import rigid_gaps
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.status import ROUNDING, Checked, FilmError, Status, require_count, require_number
from exudyn_ehd.storage import cached_arrays


@dataclass(frozen=True, kw_only=True)
class ImpedanceMap(Checked):
    """Table of the two-dimensional film, for plain aligned bearings in multibody models where speed matters most.

    The table is built once per L/D and cavitation model (a few seconds) and kept on disk. A joint with it raises an
    error for tilted journals and for eccentricity ratios above ``largest_eccentricity_ratio``. It reports force,
    friction, power loss and minimum film thickness, but no pressure. `steady` and `equilibrium` solve the
    two-dimensional film itself.

    Needs `SwiftStieber` or `Gumbel` with a cavity at ambient pressure, ambient pressure at the ends, the squeeze term,
    a closed ring and no further effect.

    Parameters
    ----------
    n_theta, n_z : int, default 320, 10
        Grid of the film from which the table is made, as for `FiniteLength`, but at least 64 columns. The default has
        many of them against the ripple of the force with the rupture line on vertices: the map's largest error at L/D 1
        is then 0.44 %, with the line inside the cells 0.11 %.
    stretch : float, default 0.75
        Stretching of that grid along the bearing, as for `FiniteLength`.
    largest_eccentricity_ratio : float, default 0.99
        End of the table, 0.5 to 0.995.
    n_eccentricity, n_direction : int, default 41, 81
        Nodes over the eccentricity and over the angle between eccentricity and squeeze velocity, 0 to pi; at
        least 8.

    Source
    ------
    J. F. Booker, J. Basic Engineering 87 (1965) 537; D. Childs, H. Moes and H. van Leeuwen, J. Lubrication Technology
    99 (1977) 198.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, film=ehd.ImpedanceMap())
    >>> bearing.film.largest_eccentricity_ratio
    0.99
    """

    n_theta: int = 320
    n_z: int = 10
    stretch: float = 0.75
    largest_eccentricity_ratio: float = 0.99
    n_eccentricity: int = 41
    n_direction: int = 81

    circumferential_pressure_flow = True

    checks: ClassVar = {
        "n_theta": partial(require_count, at_least=64, hint="320 is a good start."),
        "n_z": partial(require_count, at_least=4, hint="10 is a good start."),
        "n_eccentricity": partial(require_count, at_least=8, hint="41 is a good start."),
        "n_direction": partial(require_count, at_least=8, hint="81 is a good start."),
        "stretch": STRETCH,
        "largest_eccentricity_ratio": partial(
            require_number,
            at_least=0.5,
            at_most=0.995,
            hint="closer to the wall use film=FiniteLength(...) with a contact.",
        ),
    }


def places(film: ImpedanceMap) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of a map in s and in alpha."""
    s = np.linspace(0.0, -math.log(1.0 - film.largest_eccentricity_ratio), film.n_eccentricity)
    return s, np.linspace(0.0, math.pi, film.n_direction)


def build_nodes(film: ImpedanceMap, closure: Closure, length_to_radius: float) -> np.ndarray:
    """Solve the film at the nodes, and fit the map; returns the nodes of `_fit`."""
    grid = bearing_grid(1.0, length_to_radius, film.n_theta, film.n_z, stretch=film.stretch)
    solver, (s, alpha) = FilmSolver(grid, closure), places(film)
    f = np.empty((s.size, alpha.size, 2))
    for i, si in enumerate(s):
        solver.forget()
        for j, a in enumerate(alpha):
            f[i, j] = _squeeze_force(solver, 1.0 - math.exp(-si), a)
    f *= 6.0 / length_to_radius
    m = np.log(np.hypot(f[..., 0], f[..., 1]))
    g = np.arctan2(f[..., 1], f[..., 0]) - alpha
    g = np.remainder(g + math.pi, 2.0 * math.pi) - math.pi
    g[:, 0] = g[:, -1] = 0.0
    return _fit(s, alpha, m, g)


def _squeeze_force(s: FilmSolver, eps: float, alpha: float) -> np.ndarray:
    """Scaled force (2,) along e and across, for a velocity at the angle ``alpha`` from e."""
    at, rate = s.grid.directions, np.array([math.cos(alpha), math.sin(alpha), 0.0, 0.0])
    rigid_gaps(np.array([eps, 0.0, 0.0, 0.0]), rate, True, at, 0.0, True, s.H, s.HF, s.H_t)
    s.pressure[:, 0] = s.pressure[:, -1] = 0.0
    status, _ = s.solve(0.0, 0.0, 0.0)
    if status is not Status.CONVERGED:
        raise FilmError(f"ImpedanceMap: {status.name} at eccentricity ratio {eps:.4f}: {status.advice}")
    out = np.empty(4)
    pressure_integrals(s.pressure, s.grid.weight, s.grid.gap_shapes, out)
    return out[:2]


def _fit(s: np.ndarray, alpha: np.ndarray, m: np.ndarray, g: np.ndarray) -> np.ndarray:
    """Nodes (n_eccentricity, n_direction, 8): m, dm/ds, dm/dalpha, d2m/ds dalpha, then g alike, with spline slopes.

    m is even and g odd about alpha = 0 and pi, both are smooth in the plane at eps = 0.
    """
    m[0], g[0] = m[0].mean(), 0.0
    nodes = np.empty((s.size, alpha.size, 8))
    first = (np.cos(alpha), np.sin(alpha))
    for k, (field, ends) in enumerate(((m, "clamped"), (g, "natural"))):
        field_s = scipy.interpolate.CubicSpline(s, field, axis=0)(s, 1)
        # Next to the centre the fields are linear in (x, y): a multiple of cos alpha, or of sin alpha.
        wave = first[k]
        field_s[0] = wave * (field_s[0] @ wave) / (wave @ wave)
        nodes[..., 4 * k] = field
        nodes[..., 4 * k + 1] = field_s
        nodes[..., 4 * k + 2] = scipy.interpolate.CubicSpline(alpha, field, axis=1, bc_type=ends)(alpha, 1)
        nodes[..., 4 * k + 3] = scipy.interpolate.CubicSpline(alpha, field_s, axis=1, bc_type=ends)(alpha, 1)
    return nodes


@njit(cache=True)
def interpolate(nodes, step_s, step_alpha, s, alpha, out):
    """Set m, dm/ds, dm/dalpha, g, dg/ds, dg/dalpha in out (6,) by bicubic Hermite functions with exact derivatives."""
    i = min(max(int(s / step_s), 0), nodes.shape[0] - 2)
    j = min(max(int(alpha / step_alpha), 0), nodes.shape[1] - 2)
    t = s / step_s - i
    u = alpha / step_alpha - j
    # Hermite weights (value at 0, value at 1, slope at 0, slope at 1) and their derivatives.
    ht = ((1 + 2 * t) * (1 - t) ** 2, t * t * (3 - 2 * t), t * (1 - t) ** 2 * step_s, t * t * (t - 1) * step_s)
    dt = (6 * t * (t - 1) / step_s, 6 * t * (1 - t) / step_s, (1 - t) * (1 - 3 * t), t * (3 * t - 2))
    hu = ((1 + 2 * u) * (1 - u) ** 2, u * u * (3 - 2 * u), u * (1 - u) ** 2 * step_alpha, u * u * (u - 1) * step_alpha)
    du = (6 * u * (u - 1) / step_alpha, 6 * u * (1 - u) / step_alpha, (1 - u) * (1 - 3 * u), u * (3 * u - 2))
    for k in range(2):
        value = 0.0
        by_s = 0.0
        by_alpha = 0.0
        for a in range(2):
            for b in range(2):
                c = nodes[i + a, j + b]
                f, fs, fa, fsa = c[4 * k], c[4 * k + 1], c[4 * k + 2], c[4 * k + 3]
                along = f * ht[a] + fs * ht[a + 2]
                along_a = fa * ht[a] + fsa * ht[a + 2]
                value += along * hu[b] + along_a * hu[b + 2]
                by_alpha += along * du[b] + along_a * du[b + 2]
                by_s += (f * dt[a] + fs * dt[a + 2]) * hu[b] + (fa * dt[a] + fsa * dt[a + 2]) * hu[b + 2]
        out[3 * k], out[3 * k + 1], out[3 * k + 2] = value, by_s, by_alpha


@njit(cache=True)
def impedance_force(nodes, step_s, step_alpha, x, y, x_t, y_t, omega, force_out, tangent_out):
    """Force (2,) / (L D mu / psi^2) and its derivatives (2, 5) to (x, y, x_t, y_t, omega); x, y over c, rates in 1/s.

    Without any velocity the tangent is that of a closing journal.
    """
    vx, vy = x_t + 0.5 * omega * y, y_t - 0.5 * omega * x
    q = np.sqrt(vx * vx + vy * vy)
    eps = np.sqrt(x * x + y * y)
    at_rest = q < 1e-200
    if at_rest:
        q = 1.0
        vx, vy = (x / eps, y / eps) if eps > 0.0 else (1.0, 0.0)
    ex, ey = x, y
    # below it the direction of e is that of V; the relative error of the force is about this eccentricity ratio
    if eps < ROUNDING:
        eps = ROUNDING
        ex, ey = eps * vx / q, eps * vy / q
    cross = ex * vy - ey * vx
    alpha = np.arctan2(abs(cross), ex * vx + ey * vy)
    sign = 1.0 if cross >= 0.0 else -1.0
    out = np.empty(6)
    interpolate(nodes, step_s, step_alpha, -np.log(1.0 - eps), alpha, out)
    size = np.exp(out[0])
    c, s = np.cos(sign * out[3]), np.sin(sign * out[3])
    fx, fy = -size * (vx * c - vy * s), -size * (vy * c + vx * s)
    # Directions of the derivatives: dx, dy, and the changes of V. At rest the force is zero at every position, so
    # that only changes of V count.
    shift = 0.0 if at_rest else 1.0
    directions = (
        (shift, 0.0, 0.0, -0.5 * omega),
        (0.0, shift, 0.5 * omega, 0.0),
        (0.0, 0.0, 1.0, 0.0),
        (0.0, 0.0, 0.0, 1.0),
        (0.0, 0.0, 0.5 * y, -0.5 * x),
    )
    for k in range(5):
        dx, dy, dvx, dvy = directions[k]
        turn_v = (vx * dvy - vy * dvx) / (q * q)
        turn_e = (ex * dy - ey * dx) / (eps * eps)
        ds = (ex * dx + ey * dy) / eps / (1.0 - eps)
        da = sign * (turn_v - turn_e)
        growth = (vx * dvx + vy * dvy) / (q * q) + out[1] * ds + out[2] * da
        turn = turn_v + sign * (out[4] * ds + out[5] * da)
        tangent_out[0, k] = fx * growth - fy * turn
        tangent_out[1, k] = fy * growth + fx * turn
    force_out[0] = 0.0 if at_rest else fx
    force_out[1] = 0.0 if at_rest else fy


@njit(cache=True)
def impedance_wrench(nodes, p, motion, wrench_out, tangent_out):
    """Wrench (6,) on the journal and its derivatives (6, 10) to the motion, SI units; tilts have none.

    p = (step_s, step_alpha, largest eps, clearance, radius, half length, force scale, Couette scale, tilt share);
    returns 0, or 1 not finite, 2 outside the map, 3 no film, 4 tilted.
    """
    c, R = p[3], p[4]
    x, y, omega, w = motion[0], motion[1], motion[8], motion[9]
    wrench_out[:] = np.nan
    tangent_out[:] = np.nan
    if not np.isfinite(np.sum(motion)):
        return 1
    eps = np.sqrt(x * x + y * y) / c
    if eps > p[2]:
        return 2 if eps < 1.0 else 3
    if p[5] * np.sqrt(motion[2] ** 2 + motion[3] ** 2) > p[8] * (1.0 - eps) * c:
        return 4
    f, f_d = np.empty(2), np.empty((2, 5))
    impedance_force(nodes, p[0], p[1], x / c, y / c, motion[4] / c, motion[5] / c, omega, f, f_d)
    fx, fy = p[6] * f[0], p[6] * f[1]
    rest = 1.0 - eps * eps
    couette = p[7] / np.sqrt(rest)
    # Pressure on the gap's slope: half of e x F, the sum of (h / 2) dp / dtheta by parts.
    wrench_out[0], wrench_out[1], wrench_out[2] = fx, fy, -couette * w
    wrench_out[3] = wrench_out[4] = 0.0
    wrench_out[5] = -couette * R * R * omega + 0.5 * (x * fy - y * fx)
    tangent_out[:] = 0.0
    for k, column in enumerate((0, 1, 4, 5, 8)):
        scale = p[6] / c if k < 4 else p[6]
        dx, dy = scale * f_d[0, k], scale * f_d[1, k]
        tangent_out[0, column], tangent_out[1, column] = dx, dy
        tangent_out[5, column] = 0.5 * (x * dy - y * dx)
    slope = couette / (rest * c * c)
    tangent_out[5, 0] += 0.5 * fy - R * R * omega * slope * x
    tangent_out[5, 1] -= 0.5 * fx + R * R * omega * slope * y
    tangent_out[5, 8] -= couette * R * R
    tangent_out[2, 0], tangent_out[2, 1], tangent_out[2, 9] = -slope * w * x, -slope * w * y, -couette
    return 0


def impedance_nodes(film: ImpedanceMap, closure: Closure, length_to_radius: float) -> np.ndarray:
    """Load the nodes of the map from the disk, or build and store them; see `exudyn_ehd.storage`."""
    condition = type(closure).__name__ + " in cells" * bool(closure.line_in_cells)
    key = film, condition, length_to_radius
    data = cached_arrays("impedance_maps", key, lambda: {"nodes": build_nodes(film, closure, length_to_radius)})
    return data["nodes"]
