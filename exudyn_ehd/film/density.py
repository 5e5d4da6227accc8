"""Density that depends on pressure, and with it the Kirchhoff transform of a compressible film.

Dowson and Higginson (D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, 1966), for p >= 0 (gauge):

    rho / rho_0 = 1 + a p / (1 + b p);      below, where oil cavitates, continued with the same slope by exp(a p).

The mass flow under pressure ``rho / mu grad p = grad q / mu_0`` is linear in ``q = integral of (rho / rho_0) / (mu / mu_0) dp``, which
grows with p, so that conditions on the cavity hold in q as in p. Below ambient pressure ``q = (1 - exp(-k p)) / k``, k = alpha - a with
the viscosity's coefficient alpha.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.viscosity import (
    LARGEST_PRESSURE,
    BoundPressureLaw,
    HermiteTable,
    hermite_fourth_at,
    hermite_inverse,
)
from exudyn_ehd.status import InputError, require_number

LARGEST_COEFFICIENT = 1e-6
# Stands for an exponent k = 0, for which q = p: far below what rounding could show.
SMALLEST_EXPONENT = 1e-30
# Change of dp/dq, as a share, up to which Taylor's polynomial about a known value is the law: to 1e-14 in the density, which the balance is
# solved with, 3e-13 in p and 1e-10 in their slopes.
NEAR = 5e-4
# Tension, Pa, at which the law for p >= 0 and its continuation below still agree to rounding (for any coefficients below the largest).
AMBIENT = 1e-2
_FAST = {"reassoc", "contract", "nsz", "arcp"}


class DensityTable(NamedTuple):
    """What the kernels need of a `CompressibleLaw`: its spline of p(q), range of q and coefficients."""

    exponent: float
    q: np.ndarray
    table: np.ndarray
    bucket: np.ndarray
    bucket_scale: float
    lowest: float
    highest: float
    a: float
    b: float


@dataclass(frozen=True, kw_only=True)
class DowsonHigginson:
    """Density ``rho_0 (1 + a p / (1 + b p))`` of mineral oils: at most a third denser, 10 % at some 230 MPa.

    When: pressures above some 100 MPa, or the compliance of the oil itself in fast transients (with `ElrodAdams`, whose history
    is the oil's mass).

    Parameters
    ----------
    coefficient : float
        a, 1/Pa: the compressibility at ambient pressure.
    saturation : float
        b, 1/Pa; the density grows to 1 + a / b at most.
    """

    coefficient: float = 0.6e-9
    saturation: float = 1.7e-9

    def __post_init__(self) -> None:
        for name, value in (("coefficient", self.coefficient), ("saturation", self.saturation)):
            where, hint = f"DowsonHigginson.{name}", "mineral oils have 0.6e-9 (coefficient) and 1.7e-9 (saturation)."
            if require_number(where, value, "1/Pa", above=0.0, hint=hint) > LARGEST_COEFFICIENT:
                raise InputError(f"{where} must be at most {LARGEST_COEFFICIENT:g} 1/Pa, got {value!r}; {hint}")

    def ratio(self, p: np.ndarray) -> np.ndarray:
        """rho / rho_0 at gauge pressures p, Pa."""
        p = np.asarray(p, dtype=float)
        above = np.maximum(p, 0.0)
        dense = 1.0 + self.coefficient * above / (1.0 + self.saturation * above)
        return np.where(p >= 0.0, dense, np.exp(self.coefficient * np.minimum(p, 0.0)))

    def ratio_slope(self, p: np.ndarray) -> np.ndarray:
        """d(rho / rho_0)/dp, 1/Pa."""
        p = np.asarray(p, dtype=float)
        dense = self.coefficient / (1.0 + self.saturation * np.maximum(p, 0.0)) ** 2
        return np.where(p >= 0.0, dense, self.coefficient * np.exp(self.coefficient * np.minimum(p, 0.0)))

    def flow_work(self, p: np.ndarray) -> np.ndarray:
        """Integral of dp / (rho / rho_0) from ambient pressure, Pa.

        The work on oil that enters at p, per volume at ambient density: p dV that pushes it in and the elastic energy that it holds.
        """
        p, a, b = np.asarray(p, dtype=float), self.coefficient, self.saturation
        above, g = np.maximum(p, 0.0), a + b
        dense = (b * above + a / g * np.log1p(g * above)) / g
        return np.where(p >= 0.0, dense, -np.expm1(-a * np.minimum(p, 0.0)) / a)

    def bound(self, viscosity: BoundPressureLaw | None) -> CompressibleLaw:
        """The transform for this density and a viscosity's pressure law, None: constant."""
        return CompressibleLaw(self, viscosity)


class CompressibleLaw(HermiteTable):
    """q(p) of a density law together with a viscosity's, and their inverse; a pressure law for a bearing model.

    Parameters
    ----------
    density : DowsonHigginson
    viscosity : BoundPressureLaw or None
        None: constant viscosity.
    """

    def __init__(self, density: DowsonHigginson, viscosity: BoundPressureLaw | None) -> None:
        self.density, self.viscosity = density, viscosity
        exponent = (0.0 if viscosity is None else viscosity.coefficient) - density.coefficient
        super().__init__(
            LARGEST_PRESSURE if viscosity is None else viscosity.largest_pressure, exponent or SMALLEST_EXPONENT
        )
        # Below, q has no p; at its upper end the spline has none either.
        lowest = -np.inf if exponent >= 0.0 else 0.999 / exponent
        self.kernel_table = DensityTable(
            self.alpha, self.q, self.table, self.bucket, self.bucket_scale, lowest, self.q[-1] * (1.0 - 1e-12),
            density.coefficient, density.saturation,
        )  # fmt: skip

    def _viscosity(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if self.viscosity is None:
            return np.ones_like(p), np.zeros_like(p)
        return self.viscosity.ratio(p), self.viscosity.ratio_slope(p)

    def slope(self, p: np.ndarray) -> np.ndarray:
        """dp/dq = mu / rho, both as ratios."""
        return self._viscosity(p)[0] / self.density.ratio(p)

    def curvature(self, p: np.ndarray) -> np.ndarray:
        """d2p/dq2 = s ds/dp with s = mu / rho, 1/Pa."""
        (mu, mu_p), rho, rho_p = self._viscosity(p), self.density.ratio(p), self.density.ratio_slope(p)
        return mu / rho * (mu_p * rho - mu * rho_p) / rho**2

    def inverse(self, q: np.ndarray, p_out: np.ndarray, ratio_out: np.ndarray, ratio_q_out: np.ndarray) -> bool:
        """p(q), r = mu(p)/mu_0 and dr/dq (1/Pa) for fields (n, m); False where q has no p."""
        return bool(viscosity_of_transformed(q, self.kernel_table, p_out, ratio_out, ratio_q_out))


@njit(cache=True)
def density_ratio(p, a, b):
    """rho / rho_0 and its derivative with respect to p."""
    if p >= 0.0:
        s = 1.0 / (1.0 + b * p)
        return 1.0 + a * p * s, a * s * s
    e = np.exp(a * p)
    return e, a * e


@njit(cache=True)
def viscosity_of_transformed(q, law, p_out, ratio_out, ratio_q_out):
    """p, r = mu / mu_0 = rho dp/dq and dr/dq; False where q has no p."""
    n, m = q.shape
    for i in range(n):
        for j in range(m):
            if not law.lowest < q[i, j] < law.highest:
                return False
    if not hermite_inverse(
        q, law.exponent, law.q, law.table, law.bucket, law.bucket_scale, p_out, ratio_out, ratio_q_out
    ):
        return False
    for i in range(n):
        for j in range(m):
            rho, rho_p = density_ratio(p_out[i, j], law.a, law.b)
            s = ratio_out[i, j]
            ratio_q_out[i, j] = ratio_q_out[i, j] * rho + rho_p * s * s
            ratio_out[i, j] = s * rho
    return True


@njit(cache=True)
def density_of_transformed(P, scale, floor, law, share, at, p, s, s_q, s_qq, s_3, rho_out, rho_P_out):
    """Density ratio and its derivative at scaled pressures P (n, m), with ``floor`` the scaled pressure below which it stays.

    ``share`` = 1: the law; less: that share of the difference to a constant density. Pressures beyond the law's range have the density
    at its end. p, s, s_q, s_qq, s_3 (n, m) are the law's value and derivatives at the transformed pressures ``at`` (n, m), Pa, as of
    `viscosity.hermite_fourth_at`: they serve for all pressures near by, see `near_value`, and are looked up anew for others
    (``at`` = nan: nothing known).
    """
    n, m = P.shape
    found = False
    y0 = p0 = s0 = s0_q = s0_qq = s0_3 = rho0 = rho0_P = 0.0
    for i in range(n):
        for j in range(m):
            x = P[i, j]
            if x <= floor:
                if not found:
                    found = True
                    y0 = min(max(floor * scale, law.lowest), law.highest)
                    p0, s0, s0_q, s0_qq, s0_3 = hermite_fourth_at(
                        y0, law.exponent, law.q, law.table, law.bucket, law.bucket_scale
                    )
                    rho0, rho0_p = density_ratio(p0, law.a, law.b)
                    rho0 = 1.0 + share * (rho0 - 1.0)
                    rho0_P = share * rho0_p * s0 * scale if law.lowest < floor * scale < law.highest else 0.0
                if at[i, j] != y0:
                    at[i, j], p[i, j], s[i, j], s_q[i, j], s_qq[i, j], s_3[i, j] = y0, p0, s0, s0_q, s0_qq, s0_3
                rho_out[i, j] = rho0
                rho_P_out[i, j] = rho0_P if x == floor else 0.0
                continue
            q = x * scale
            inside = law.lowest < q < law.highest
            y = q if inside else min(max(q, law.lowest), law.highest)
            near, value, slope, _ = near_value(y, at[i, j], p[i, j], s[i, j], s_q[i, j], s_qq[i, j], s_3[i, j])
            if not near:
                value, slope, s_q[i, j], s_qq[i, j], s_3[i, j] = hermite_fourth_at(
                    y, law.exponent, law.q, law.table, law.bucket, law.bucket_scale
                )
                at[i, j], p[i, j], s[i, j] = y, value, slope
            rho, rho_p = density_ratio(value, law.a, law.b)
            rho_out[i, j] = 1.0 + share * (rho - 1.0)
            rho_P_out[i, j] = share * rho_p * slope * scale if inside else 0.0


@njit(cache=True)
def density_near(P, scale, floor, law, share, at, p, s, s_q, s_qq, s_3, rho_out, rho_P_out):
    """As `density_of_transformed` for pressures that are all near known ones; False if some are not."""
    known = (
        at.reshape(-1),
        p.reshape(-1),
        s.reshape(-1),
        s_q.reshape(-1),
        s_qq.reshape(-1),
        s_3.reshape(-1),
    )
    far, others = _ratio_near(
        P.reshape(-1), scale, floor, law.lowest / scale, law.highest / scale, share, law.a, law.b, *known,
        rho_out.reshape(-1),
    )  # fmt: skip
    if far > 0.0:
        return False
    if others > 0.0:
        density_of_transformed(P, scale, floor, law, share, at, p, s, s_q, s_qq, s_3, rho_out, rho_P_out)
    else:
        _slope_near(P.reshape(-1), scale, floor, share, law.a, law.b, *known, rho_P_out.reshape(-1))
    return True


# Checks for a division by zero would keep the compiler from vectorising the next two.
@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _ratio_near(P, scale, floor, lowest, highest, share, a, b, at, p, s, s_q, s_qq, s_3, rho_out):
    """Density ratio of `density_near`, flat; returns how many are far from known pressures, and how many in tension or outside of the range."""
    far = 0.0
    others = 0.0
    for c in range(rho_out.size):
        x = P[c] if P[c] > floor else floor
        q = x * scale
        d = q - at[c]
        value = p[c] + d * (s[c] + d * (0.5 * s_q[c] + d * (s_qq[c] * (1.0 / 6.0) + d * s_3[c] * (1.0 / 24.0))))
        far += 0.0 if (abs(d * s_q[c]) <= NEAR * s[c]) & ((q > 0.0) == (at[c] > 0.0)) else 1.0
        others += 0.0 if (value >= -AMBIENT) & (x > lowest) & (x < highest) else 1.0
        rho_out[c] = 1.0 + share * a * value / (1.0 + b * value)
    return far, others


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _slope_near(P, scale, floor, share, a, b, at, p, s, s_q, s_qq, s_3, rho_P_out):
    """Derivative of the density ratio of `density_near`, flat, for p >= 0 inside the range."""
    for c in range(rho_P_out.size):
        d = P[c] * scale - at[c]
        value = p[c] + d * (s[c] + d * (0.5 * s_q[c] + d * (s_qq[c] * (1.0 / 6.0) + d * s_3[c] * (1.0 / 24.0))))
        slope = s[c] + d * (s_q[c] + d * (0.5 * s_qq[c] + d * s_3[c] * (1.0 / 6.0)))
        denser = 1.0 / (1.0 + b * value)
        rho_P_out[c] = share * a * scale * denser * denser * slope if P[c] >= floor else 0.0


@njit(cache=True)
def pressure_near(P, scale, floor, law, at, p, s, s_q, s_qq, s_3, p_out, p_P_out):
    """Pressure over ``scale`` and its derivative to P where all P are near known ones; False if some are not, or have no pressure."""
    far = _pressure_near(
        P.reshape(-1), scale, max(floor, law.lowest / scale), law.highest / scale, at.reshape(-1), p.reshape(-1),
        s.reshape(-1), s_q.reshape(-1), s_qq.reshape(-1), s_3.reshape(-1), p_out.reshape(-1),
    )  # fmt: skip
    _pressure_slope_near(
        P.reshape(-1),
        scale,
        at.reshape(-1),
        s.reshape(-1),
        s_q.reshape(-1),
        s_qq.reshape(-1),
        s_3.reshape(-1),
        p_P_out.reshape(-1),
    )
    return far == 0.0


@njit(cache=True, fastmath=_FAST)
def _pressure_near(P, scale, lowest, highest, at, p, s, s_q, s_qq, s_3, p_out):
    far = 0.0
    per_scale = 1.0 / scale
    for c in range(p_out.size):
        q = P[c] * scale
        d = q - at[c]
        near = (abs(d * s_q[c]) <= NEAR * s[c]) & ((q > 0.0) == (at[c] > 0.0)) & (P[c] >= lowest) & (P[c] < highest)
        far += 0.0 if near else 1.0
        p_out[c] = per_scale * (
            p[c] + d * (s[c] + d * (0.5 * s_q[c] + d * (s_qq[c] * (1.0 / 6.0) + d * s_3[c] * (1.0 / 24.0))))
        )
    return far


@njit(cache=True, fastmath=_FAST)
def _pressure_slope_near(P, scale, at, s, s_q, s_qq, s_3, p_P_out):
    for c in range(p_P_out.size):
        d = P[c] * scale - at[c]
        p_P_out[c] = s[c] + d * (s_q[c] + d * (0.5 * s_qq[c] + d * s_3[c] * (1.0 / 6.0)))


@njit(cache=True, inline="always")
def near_value(q, at, p, s, s_q, s_qq, s_3):
    """Whether q is so near that Taylor's polynomial about ``at`` is the law (`NEAR`; on one side of 0), and p and two derivatives there."""
    d = q - at
    return (
        abs(d * s_q) <= NEAR * s and (q > 0.0) == (at > 0.0),
        p + d * (s + d * (0.5 * s_q + d * (s_qq / 6.0 + d * s_3 / 24.0))),
        s + d * (s_q + d * (0.5 * s_qq + d * s_3 / 6.0)),
        s_q + d * (s_qq + 0.5 * d * s_3),
    )
