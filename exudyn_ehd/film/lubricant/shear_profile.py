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

from typing import NamedTuple

import numpy as np
from numba import njit

# Intervals of the fluidity's table for every factor of two in 1 + |T|^2, a power of two; most factors of two; scaled
# shear rate that the table need not pass.
PARTS, OCTAVES, FASTEST = 32, 48, 1e12
_MANTISSA, _SHIFT = np.int64(52), np.int64(47)
# Gauss points across the film, of the pressure flow and of the mean stress. Largest error of a flow for exponents from
# 0.4 on, of any rates: 4.3 % with 3 points, 1.7 % with 4, 1.1 % with 5, 0.55 % with 6, 0.24 % with 8, of either sign.
FLOW_POINTS, STRESS_POINTS = 6, 12
# Share of the stress at which Newton's step is the last one: what it leaves of stress and flow is its square.
LAST_STEP, MOST_STEPS, MOST_HALVINGS = 1e-7, 200, 30
# Pressure stress over that of the sliding below which a flow over its gradient is its derivative.
SLIGHT = 1e-5
# Rate of the sliding over that of the pressure flow below which the mean stress over the rate is that at this rate.
STILL = 1e-3
_BISECTIONS = 90


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


class Oil(NamedTuple):
    """The law as kernels take it: coefficients (intervals, 4) of the fluidity's cubics, power behind them, exponent and
    residual of Carreau's law."""

    table: np.ndarray
    power: float
    exponent: float
    residual: float


def fluidity_table(exponent: float, residual: float) -> Oil:
    """Fluidity ``f(s)``, s = |T|^2, of ``T = Gamma (r + (1 - r) (1 + Gamma^2)^((n - 1) / 2))`` as cubics in s.

    Value and slope are exact at the ends of 32 equal parts of every factor of two in 1 + s, so that errors stay below
    1e-8 of the value; behind the last one follows a power.
    """
    e = 0.5 * (exponent - 1.0)
    highest = FASTEST * (residual + (1.0 - residual) * (1.0 + FASTEST**2) ** e)
    octaves = min(OCTAVES, int(np.log2(1.0 + highest**2)) + 1)
    edges = (1.0 + np.arange(PARTS) / PARTS) * 2.0 ** np.arange(octaves)[:, None]
    s = np.append(edges.ravel(), 2.0**octaves) - 1.0
    t = np.sqrt(s[1:])
    low, high = np.log(t), np.full(t.size, 3.0 * np.log(FASTEST))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        above = middle + np.log(residual + (1.0 - residual) * np.exp(e * np.logaddexp(0.0, 2.0 * middle))) > np.log(t)
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    rate = np.exp(0.5 * (low + high))
    thin = (1.0 - residual) * np.exp(e * np.log1p(rate * rate))
    steep = residual + thin + thin * 2.0 * e * rate**2 / (1.0 + rate**2)
    f = np.append(1.0, rate / t)
    f_s = np.append(-e * (1.0 - residual), (1.0 / steep - f[1:]) / (2.0 * s[1:]))
    h = np.diff(s)
    d0, d1, rise = f_s[:-1] * h, f_s[1:] * h, np.diff(f)
    table = np.array([f[:-1], d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise]).T
    return Oil(np.ascontiguousarray(table), float((1.0 + s[-1]) * f_s[-1] / f[-1]), exponent, residual)


def gauss_points(count: int) -> np.ndarray:
    """Heights and weights (2, count) across the film."""
    zeta, weight = np.polynomial.legendre.leggauss(count)
    return 0.5 * np.array([zeta, weight])


@njit(cache=True, inline="always")
def _fluidity(s, table, power):
    """f(s) and its derivative."""
    y = 1.0 + s
    bits = np.float64(y).view(np.int64)
    at = (bits >> _SHIFT) - (np.int64(1023) << np.int64(5))
    if at >= table.shape[0]:
        last = table.shape[0] - 1
        end = 2.0 ** (table.shape[0] // PARTS)
        f = (table[last, 0] + table[last, 1] + table[last, 2] + table[last, 3]) * (y / end) ** power
        return f, power * f / y
    width = 2.0 ** (-5.0) * np.int64(bits >> _MANTISSA << _MANTISSA).view(np.float64)
    t = (bits & np.int64((1 << 47) - 1)) * (1.0 / (1 << 47))
    a, b, c, d = table[at, 0], table[at, 1], table[at, 2], table[at, 3]
    return a + t * (b + t * (c + t * d)), (b + t * (2.0 * c + t * 3.0 * d)) / width


@njit(cache=True, inline="always")
def _moments(T_x, T_z, S, G_x, G_z, oil, points):
    """Excess of the shear rate's integral over S, F, and H, C, B (xx, xz, zz each)."""
    r_x, r_z, F_x, F_z = -S, 0.0, 0.0, 0.0
    H_xx = H_xz = H_zz = C_xx = C_xz = C_zz = B_xx = B_xz = B_zz = 0.0
    for k in range(points.shape[1]):
        zeta, w = points[0, k], points[1, k]
        t_x, t_z = T_x + zeta * G_x, T_z + zeta * G_z
        f, f_s = _fluidity(t_x * t_x + t_z * t_z, oil.table, oil.power)
        f, f_s = w * f, 2.0 * w * f_s
        r_x += f * t_x
        r_z += f * t_z
        F_x += zeta * f * t_x
        F_z += zeta * f * t_z
        J_xx, J_xz, J_zz = f + f_s * t_x * t_x, f_s * t_x * t_z, f + f_s * t_z * t_z
        H_xx, H_xz, H_zz = H_xx + J_xx, H_xz + J_xz, H_zz + J_zz
        C_xx, C_xz, C_zz = C_xx + zeta * J_xx, C_xz + zeta * J_xz, C_zz + zeta * J_zz
        q = zeta * zeta
        B_xx, B_xz, B_zz = B_xx + q * J_xx, B_xz + q * J_xz, B_zz + q * J_zz
    return (r_x, r_z), (F_x, F_z), (H_xx, H_xz, H_zz), (C_xx, C_xz, C_zz), (B_xx, B_xz, B_zz)


@njit(cache=True, error_model="numpy")
def couette_stress(S, oil):
    """Stress of a shear rate."""
    return S * (oil.residual + (1.0 - oil.residual) * (1.0 + S * S) ** (0.5 * (oil.exponent - 1.0)))


@njit(cache=True, error_model="numpy")
def profile(S, G_x, G_z, oil, points, T_x, T_z):
    """`Profile` of one place, by Newton's method from a mean stress, which may prolong but not mislead it."""
    scale = 0.0
    r, F, H, C, B = _moments(T_x, T_z, S, G_x, G_z, oil, points)
    for _ in range(MOST_STEPS):
        det = 1.0 / (H[0] * H[2] - H[1] * H[1])
        d_x, d_z = (H[1] * r[1] - H[2] * r[0]) * det, (H[1] * r[0] - H[0] * r[1]) * det
        size, share = abs(d_x) + abs(d_z), 1.0
        # the shear stress across the film, of either flow
        scale = abs(T_x) + abs(T_z) + 1e-3 * (abs(G_x) + abs(G_z)) + 1e-300
        if size <= LAST_STEP * scale:
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
    return Profile(
        T_x + d_x, T_z + d_z, F[0] + C[0] * d_x + C[1] * d_z, F[1] + C[1] * d_x + C[2] * d_z,
        i_xx, -m_xx, -m_xz, m_xx, m_xz,
        B[0] - C[0] * m_xx - C[1] * m_zx, B[1] - C[0] * m_xz - C[1] * m_zz, B[2] - C[1] * m_xz - C[2] * m_zz,
    )  # fmt: skip


@njit(cache=True, error_model="numpy")
def thin_links(gap, slope, cross, fluid, speed, k, axis, oil, points, stress, out):
    """Pressure flow of links over that of an oil of constant viscosity.

    Parameters
    ----------
    gap : (n, m) array
    slope, cross : (n, m) arrays
        Scaled pressure gradient along the link, and across it.
    fluid : (n, m) or (1, 1) array
        1 over the viscosity ratio of the place.
    speed, k : float
        ``k vx``, with k = 2 lambda R / c.
    axis : int
        0: links along the sliding, 1: across.
    stress : (2, n, m) array
        Mean stress of the last call, where this one starts.
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
            if own == 0.0 and other == 0.0:
                # sliding alone: the same at every height
                t = couette_stress(S, oil)
                f, f_s = _fluidity(t * t, oil.table, oil.power)
                stress[0, i, j], stress[1, i, j] = t, 0.0
                out[0, i, j] = f + 2.0 * f_s * t * t if axis == 0 else f
                out[1, i, j] = out[2, i, j] = out[4, i, j] = 0.0
                out[3, i, j] = 1.0
                continue
            p = profile(S, G_x, G_z, oil, points, stress[0, i, j], stress[1, i, j])
            stress[0, i, j], stress[1, i, j] = p.T_x, p.T_z
            F, by_own, by_s = (p.F_x, p.F_xx, p.F_xs) if axis == 0 else (p.F_z, p.F_zz, p.F_zs)
            if abs(own) <= SLIGHT * (abs(couette_stress(S, oil)) + 1.0):
                a = 12.0 * by_own
                out[1, i, j] = out[2, i, j] = 0.0
            else:
                a = 12.0 * F / own
                out[1, i, j] = (12.0 / h) * (by_own * own + p.F_xz * other - by_s * S - F) / own
                out[2, i, j] = 12.0 * k / h * by_s / own
            out[0, i, j] = a
            out[3, i, j] = 12.0 * by_own / a
            out[4, i, j] = 12.0 * p.F_xz / a


@njit(cache=True, error_model="numpy")
def thin_shear(H, slopes, fluid, speed, k, oil, points, out):
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
            # a journal that hardly turns meets what the pressure flow leaves of the viscosity
            least = STILL * (1.0 + abs(G_x) + abs(G_z))
            turns = abs(S) > least
            at = S if turns else least
            p = profile(at, G_x, G_z, oil, points, couette_stress(at, oil), 0.0)
            a = p.T_x / at
            out[0, i, j] = a
            out[1, i, j] = (p.T_xx * G_x + p.T_xz * G_z) / at / h
            out[2, i, j] = 0.0
            if turns:
                out[1, i, j] += (a - p.T_xs) / h
                out[2, i, j] = (p.T_xs - a) / S * k / h
            out[3, i, j] = p.T_xx / at * per
            out[4, i, j] = p.T_xz / at * per
