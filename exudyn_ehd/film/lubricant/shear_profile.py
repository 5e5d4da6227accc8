"""Velocity profile of a film whose viscosity follows the shear rate at every height, under sliding and pressure flow.

Across the gap the shear stress is linear, and the shear rate follows from it by the law of the oil. With the height
zeta from -1/2 to 1/2 over the gap h, stresses over mu_0 / lambda and shear rates over 1 / lambda,

    T(zeta) = T_m + zeta G,    Gamma(T) = f(|T|^2) T,    integral of Gamma = S,    F = integral of zeta Gamma,

vectors along and across the sliding: S = lambda U / h, G = lambda h grad p / mu_0. f is the fluidity mu_0 / mu. The
first condition gives the mean stress T_m, the second the pressure flow ``-h^2 F / lambda`` beside the Couette flow ``h
U / 2``; a film of constant viscosity has T_m = S and F = G / 12. This is the generalised Reynolds equation (D. Dowson,
Int. J. Mech. Sci. 4 (1962) 159) with a viscosity that varies across the film by the shear rate alone. T_m minimises a
convex function, so that it is unique. Gauss points stand for the integrals, and all derivatives are those of their
sums: with J = dGamma/dT, H, C, B the integrals of J, zeta J, zeta^2 J,

    dT_m/dS = H^-1,    dT_m/dG = -H^-1 C,    dF/dS = C H^-1,    dF/dG = B - C H^-1 C.

Symbols: x along the sliding, z across; _s derivative to S (which has no part across), _xx, _xz, _zz to G.
"""

from __future__ import annotations

import functools
from collections.abc import Hashable
from typing import NamedTuple, Protocol

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FUSED

# Intervals of the fluidity's table for every factor of two in 1 + |T|^2; must be a power of two. Scaled shear rate at
# the table's end; at higher rates the fluidity is constant.
PARTS, FASTEST = 32, 1e12
# Numbers in one interval differ in the last 47 of the 52 bits of their mantissa, which follow the 5 of PARTS.
BITS_OF_ONE, BITS_OF_PART = np.float64(1.0).view(np.uint64), np.uint64(47)
# Gauss points across the film, of the pressure flow and of the mean stress. Largest error of a flow for exponents from
# 0.4 on, of any rates: 4.3 % with 3 points, 1.7 % with 4, 1.1 % with 5, 0.55 % with 6, 0.24 % with 8, of either sign.
FLOW_POINTS, STRESS_POINTS = 6, 12
# Newton's step over the stress below which it is the last step. The first value is for iterations of the film: the
# error of stress and flow is then the square of the step. The second value is for exact derivatives, whose error is as
# large as the step.
LAST_STEP, EXACT, MOST_STEPS, MOST_HALVINGS = 1e-5, 1e-12, 200, 30
# Number of values stored of a place's last profile: S, G (2), T_m (2), six derivatives of T_m.
LAST = 11
# Stress of the pressure flow over that of the sliding below which the flow's derivative replaces flow over gradient.
SLIGHT = 1e-5
# Shear rate of the sliding over that of the pressure flow, below which stress over rate is that at this limit.
STILL = 1e-3


class Profile(NamedTuple):
    """Mean stress and pressure flow, scaled, with their derivatives; symbols of this module."""

    T_x: float
    T_z: float
    F_x: float
    F_z: float
    T_xs: float
    T_xx: float
    T_xz: float
    F_xs: float
    F_zs: float
    F_xx: float
    F_xz: float
    F_zz: float


class RateLaw(Hashable, Protocol):
    """Viscosity ratio ``mu / mu_0`` at shear rates from 0 to 1e36 over the relaxation time.

    It is 1 at rest and smooth there: an even function of the rate. The stress, ratio times rate, grows with the rate.
    Equal laws have equal hashes.
    """

    @property
    def relaxation_time(self) -> float:
        """Unit of time of the law's table, s: the ratio changes at rates around 1 over it."""

    def ratio(self, rate: np.ndarray) -> np.ndarray:
        """mu / mu_0."""

    def ratio_slope(self, rate: np.ndarray) -> np.ndarray:
        """Derivative of the ratio to the rate, s."""

    def ratio_bend(self, rate: np.ndarray) -> np.ndarray:
        """Second derivative of the ratio to the rate, s^2."""


@functools.lru_cache(maxsize=16)
def fluidity_table(law: RateLaw) -> np.ndarray:
    """Fluidity ``f(s)``, s = |T|^2, of ``T = Gamma ratio(Gamma)`` as cubics in s; of Carreau's law within 1e-8.

    Value and slope are exact at the ends of 32 equal parts of every factor of two in 1 + s. Rows: 1 + s where a part
    begins, 1 over its width, four coefficients. Beyond the last part, at `FASTEST`, the fluidity is constant.
    """
    unit = 1.0 / law.relaxation_time
    highest = FASTEST * float(law.ratio(np.array(FASTEST * unit)))
    octaves = int(np.log2(1.0 + highest**2)) + 1
    edges = (1.0 + np.arange(PARTS) / PARTS) * 2.0 ** np.arange(octaves)[:, None]
    s = np.append(edges.ravel(), 2.0**octaves) - 1.0
    t = np.sqrt(s[1:])
    low, high = np.log(t), np.full(t.size, 3.0 * np.log(FASTEST))
    # bisection to the last bit
    while np.any((low < (middle := 0.5 * (low + high))) & (middle < high)):
        above = middle + np.log(law.ratio(np.exp(middle) * unit)) > np.log(t)
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    rate = np.exp(middle)
    steep = law.ratio(rate * unit) + rate * unit * law.ratio_slope(rate * unit)
    f = np.append(1.0, rate / t)
    f_s = np.append(-0.5 * unit**2 * law.ratio_bend(np.zeros(1)), (1.0 / steep - f[1:]) / (2.0 * s[1:]))
    h = np.diff(s)
    d0, d1, rise = f_s[:-1] * h, f_s[1:] * h, np.diff(f)
    table = np.array([1.0 + s[:-1], 1.0 / h, f[:-1], d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise]).T
    return np.vstack([table, [0.0, 0.0, f[-1], 0.0, 0.0, 0.0]])


@functools.lru_cache(maxsize=16)
def gauss_points(count: int) -> np.ndarray:
    """Heights zeta across the film, and weights times 1, zeta .. zeta^4: (6, count)."""
    zeta, weight = 0.5 * np.array(np.polynomial.legendre.leggauss(count))
    return np.array([zeta, *(weight * zeta**k for k in range(5))])


@njit(cache=True, inline="always")
def _fluidity(s, table):
    """f(s) and its derivative."""
    x = 1.0 + s
    at = min((np.float64(x).view(np.uint64) - BITS_OF_ONE) >> BITS_OF_PART, np.uint64(len(table) - 1))
    row = table[at]
    per = row[1]
    t = (x - row[0]) * per
    a, b, c, d = row[2], row[3], row[4], row[5]
    return a + t * (b + t * (c + t * d)), (b + t * (2.0 * c + t * 3.0 * d)) * per


@njit(cache=True, inline="always")
def _moments(T_x, T_z, S, G_x, G_z, oil, points):
    """Excess of the shear rate's integral over S, F, and H, C, B (xx, xz, zz each).

    With ``J = f + 2 f' T T^T`` all of them are sums of f zeta^k and 2 f' zeta^k, times T and G.
    """
    a0 = a1 = a2 = b0 = b1 = b2 = b3 = b4 = 0.0
    for k in range(points.shape[1]):
        zeta = points[0, k]
        t_x, t_z = T_x + zeta * G_x, T_z + zeta * G_z
        f, f_s = _fluidity(t_x * t_x + t_z * t_z, oil)
        w0, w1, w2 = points[1, k], points[2, k], points[3, k]
        a0, a1, a2 = a0 + w0 * f, a1 + w1 * f, a2 + w2 * f
        b0, b1, b2 = b0 + w0 * f_s, b1 + w1 * f_s, b2 + w2 * f_s
        b3, b4 = b3 + points[4, k] * f_s, b4 + points[5, k] * f_s
    own_xx, own_xz, own_zz = 2.0 * T_x * T_x, 2.0 * T_x * T_z, 2.0 * T_z * T_z
    mix_xx, mix_xz, mix_zz = 4.0 * T_x * G_x, 2.0 * (T_x * G_z + T_z * G_x), 4.0 * T_z * G_z
    far_xx, far_xz, far_zz = 2.0 * G_x * G_x, 2.0 * G_x * G_z, 2.0 * G_z * G_z
    return (
        (a0 * T_x + a1 * G_x - S, a0 * T_z + a1 * G_z),
        (a1 * T_x + a2 * G_x, a1 * T_z + a2 * G_z),
        (
            a0 + b0 * own_xx + b1 * mix_xx + b2 * far_xx,
            b0 * own_xz + b1 * mix_xz + b2 * far_xz,
            a0 + b0 * own_zz + b1 * mix_zz + b2 * far_zz,
        ),
        (
            a1 + b1 * own_xx + b2 * mix_xx + b3 * far_xx,
            b1 * own_xz + b2 * mix_xz + b3 * far_xz,
            a1 + b1 * own_zz + b2 * mix_zz + b3 * far_zz,
        ),
        (
            a2 + b2 * own_xx + b3 * mix_xx + b4 * far_xx,
            b2 * own_xz + b3 * mix_xz + b4 * far_xz,
            a2 + b2 * own_zz + b3 * mix_zz + b4 * far_zz,
        ),
    )


@njit(cache=True, error_model="numpy", fastmath=FUSED, inline="always")
def profile(S, G_x, G_z, oil, points, T_x, T_z, last_step):
    """Return the `Profile` of one place, and the mean stress's derivatives T_zs, T_zx, T_zz.

    Newton's method starts at the mean stress (T_x, T_z) and ends when a step is below ``last_step`` times the stress. A
    poor start costs steps, but the solution is the same.
    """
    r, F, H, C, B = _moments(T_x, T_z, S, G_x, G_z, oil, points)
    for _ in range(MOST_STEPS):
        det = 1.0 / (H[0] * H[2] - H[1] * H[1])
        d_x, d_z = (H[1] * r[1] - H[2] * r[0]) * det, (H[1] * r[0] - H[0] * r[1]) * det
        share, rough = 1.0, (abs(d_x) + abs(d_z)) / _scale(T_x, T_z, G_x, G_z)
        if rough <= last_step:
            break
        norm = r[0] * r[0] + r[1] * r[1]
        for _ in range(MOST_HALVINGS):
            x, z = T_x + share * d_x, T_z + share * d_z
            r, F, H, C, B = _moments(x, z, S, G_x, G_z, oil, points)
            if r[0] * r[0] + r[1] * r[1] < norm:
                break
            share *= 0.5
        T_x, T_z = x, z
    det = 1.0 / (H[0] * H[2] - H[1] * H[1])
    d_x, d_z = (H[1] * r[1] - H[2] * r[0]) * det, (H[1] * r[0] - H[0] * r[1]) * det
    i_xx, i_xz, i_zz = H[2] * det, -H[1] * det, H[0] * det
    # H^-1 C, which is not symmetric
    m_xx, m_xz = i_xx * C[0] + i_xz * C[1], i_xx * C[1] + i_xz * C[2]
    m_zx, m_zz = i_xz * C[0] + i_zz * C[1], i_xz * C[1] + i_zz * C[2]
    found = Profile(
        T_x + d_x, T_z + d_z, F[0] + C[0] * d_x + C[1] * d_z, F[1] + C[1] * d_x + C[2] * d_z,
        i_xx, -m_xx, -m_xz, m_xx, m_xz,
        B[0] - C[0] * m_xx - C[1] * m_zx, B[1] - C[0] * m_xz - C[1] * m_zz, B[2] - C[1] * m_xz - C[2] * m_zz,
    )  # fmt: skip
    return found, (i_xz, -m_zx, -m_zz)


@njit(cache=True, inline="always")
def _scale(T_x, T_z, G_x, G_z):
    """Shear stress across the film, of either flow."""
    return abs(T_x) + abs(T_z) + 1e-3 * (abs(G_x) + abs(G_z)) + 1e-300


@njit(cache=True, error_model="numpy", fastmath=FUSED, inline="always")
def _follow(S, G_x, G_z, oil, points, last_step, last):
    """Return the `Profile`, started from the last one, ``last`` (`LAST`,), by its derivatives; updates ``last``."""
    dS, d_x, d_z = S - last[0], G_x - last[1], G_z - last[2]
    T_x, T_z = last[3], last[4]
    by_x = last[5] * dS + last[6] * d_x + last[7] * d_z
    by_z = last[8] * dS + last[9] * d_x + last[10] * d_z
    T_x, T_z = T_x + by_x, T_z + by_z
    p, others = profile(S, G_x, G_z, oil, points, T_x, T_z, last_step)
    last[0], last[1], last[2], last[3], last[4] = S, G_x, G_z, p.T_x, p.T_z
    last[5], last[6], last[7] = p.T_xs, p.T_xx, p.T_xz
    last[8], last[9], last[10] = others
    return p


@njit(cache=True, error_model="numpy", fastmath=FUSED)
def thin_links(gap, slope, cross, fluid, speed, k, axis, oil, points, last, out):
    """Pressure flow of links over that of an oil of constant viscosity.

    Parameters
    ----------
    gap : (n, m) array
    slope, cross : (n, m) arrays
        Scaled pressure gradient along the link, and across it.
    fluid : (n, m) or (1, 1) array
        1 over the viscosity ratio at the link.
    speed, k : float
        ``k vx``, with k = 2 lambda R / c.
    axis : int
        0: links along the sliding, 1: across.
    last : (n, m, LAST) array
        Profiles of the last call, from which the iterations start; zeros if there are none.
    out : (5, n, m) array
        Ratio a; da/dH and da/dvx at fixed gradients; derivative of the flow to ``slope`` over a, and to ``cross``.
    """
    n, m = gap.shape
    wide = fluid.size > 1
    for i in range(n):
        for j in range(m):
            h = gap[i, j]
            S, per = speed / h, 6.0 * k * h * (fluid[i, j] if wide else fluid[0, 0])
            own, other = per * slope[i, j], per * cross[i, j]
            G_x, G_z = (own, other) if axis == 0 else (other, own)
            p = _follow(S, G_x, G_z, oil, points, LAST_STEP, last[i, j])
            F, by_own, by_s = (p.F_x, p.F_xx, p.F_xs) if axis == 0 else (p.F_z, p.F_zz, p.F_zs)
            if abs(own) <= SLIGHT * (abs(p.T_x) + abs(p.T_z) + 1.0):
                a = 12.0 * by_own
                out[1, i, j] = out[2, i, j] = 0.0
            else:
                a = 12.0 * F / own
                out[1, i, j] = (12.0 / h) * (by_own * own + p.F_xz * other - by_s * S - F) / own
                out[2, i, j] = 12.0 * k / h * by_s / own
            out[0, i, j] = a
            out[3, i, j] = 12.0 * by_own / a
            out[4, i, j] = 12.0 * p.F_xz / a


@njit(cache=True, error_model="numpy", fastmath=FUSED)
def thin_shear(H, slopes, fluid, speed, k, oil, points, last, out):
    """Mean stress along the sliding over that of an oil of constant viscosity.

    ``slopes`` (2, n, m): scaled pressure gradients along and across the sliding at the vertices; the others as for
    `thin_links`. ``out`` (5, n, m): the ratio, its derivatives to H and vx at fixed gradients, and to ``slopes``.
    """
    n, m = H.shape
    wide = fluid.size > 1
    for i in range(n):
        for j in range(m):
            h = H[i, j]
            S, per = speed / h, 6.0 * k * h * (fluid[i, j] if wide else fluid[0, 0])
            G_x, G_z = per * slopes[0, i, j], per * slopes[1, i, j]
            # for a journal that hardly turns, the viscosity is that under the shear of the pressure flow
            least = STILL * (1.0 + abs(G_x) + abs(G_z))
            turns = abs(S) > least
            at = S if turns else least
            p = _follow(at, G_x, G_z, oil, points, EXACT, last[i, j])
            a, by_s = p.T_x / at, p.T_xs
            out[0, i, j] = a
            out[1, i, j] = (p.T_xx * G_x + p.T_xz * G_z) / at / h
            out[2, i, j] = 0.0
            out[3, i, j] = p.T_xx / at * per
            out[4, i, j] = p.T_xz / at * per
            if turns:
                out[1, i, j] += (a - by_s) / h
                out[2, i, j] = (by_s - a) / S * k / h
