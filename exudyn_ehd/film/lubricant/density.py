"""Density that depends on pressure, and with it the Kirchhoff transform of a compressible film.

Dowson and Higginson (D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, 1966), for p >= 0 (gauge):

    rho / rho_0 = 1 + a p / (1 + b p);      below, where oil cavitates, continued with the same slope by exp(a p).

The mass flow under pressure ``rho / mu grad p = grad q / mu_0`` is linear in
``q = integral of (rho / rho_0) / (mu / mu_0) dp``, which grows with p, so that conditions on the cavity hold in q as in
p. Below ambient pressure ``q = (1 - exp(-k p)) / k``, k = alpha - a with the viscosity's coefficient alpha.

Density at the vertices of a film. A vertex has nearly the same pressure in successive iterations and films, and looking
up the law takes time. So ``known`` (9, size) stores the law at one transformed pressure q of every vertex: q, density
ratio, s = dp/dq and its derivative, and the four further coefficients of the density's Taylor polynomial about q. The
last entry is the reach, the change of q up to which the polynomial may replace the law. The compiler vectorises the
loops that evaluate these polynomials.

Symbols: P scaled transformed pressures (n, m), ``scale`` Pa per unit of P, ``floor`` the scaled pressure below which
the density is constant.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Protocol, runtime_checkable

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST
from exudyn_ehd.film.lubricant.pressure_viscosity import (
    LARGEST_PRESSURE,
    LawTable,
    PressureLaw,
    PressureTransform,
    law_at,
)
from exudyn_ehd.status import POSITIVE, ROUNDING, Checked

COEFFICIENT = partial(POSITIVE, hint="mineral oils have 0.6e-9 (coefficient) and 1.7e-9 (saturation).")
# Exponent in place of k = 0, for which q = p; so small that the results agree to rounding.
SMALLEST_EXPONENT = 1e-30


@runtime_checkable
class DensityLaw(Protocol):
    """Density ratio ``rho / rho_0`` at gauge pressures p, Pa; below ambient pressure it is ``exp(coefficient p)``."""

    @property
    def coefficient(self) -> float:
        """Slope of the ratio at ambient pressure, 1/Pa; above 0."""

    def ratio(self, p: np.ndarray) -> np.ndarray:
        """rho / rho_0."""

    def ratio_slope(self, p: np.ndarray) -> np.ndarray:
        """d(rho / rho_0)/dp, 1/Pa."""

    def ratio_bend(self, p: np.ndarray) -> np.ndarray:
        """d2(rho / rho_0)/dp2 for p >= 0, 1/Pa^2."""

    def flow_work(self, p: np.ndarray) -> np.ndarray:
        """Integral of dp / (rho / rho_0) from ambient pressure, Pa."""


@dataclass(frozen=True, kw_only=True)
class DowsonHigginson(Checked):
    """Density of mineral oils under pressure, ``rho_0 (1 + a p / (1 + b p))``: 10 % more at 230 MPa, at most a third.

    When: peak pressures above some 100 MPa, or fast transients in which the oil itself is a spring.

    Only `ElrodAdams` contains the storage of oil by compression, ``h drho/dt``. Use it for those transients, and where
    the load turns against the housing, as in planet gears. Under a steady load the law thickens the film by 2 % at a
    peak pressure of 130 MPa. Other cavitation models give this increase fully if the journal spins in a housing at
    rest, and not at all if the housing spins around a journal at rest.

    Oil is 0.6 % denser at 10 MPa and 5 % at 100 MPa gauge. Reported flows, m3/s, are mass flows over the density at
    ambient pressure.

    Parameters
    ----------
    coefficient : float, default 6e-10
        a, 1/Pa: the compressibility at ambient pressure.
    saturation : float, default 1.7e-9
        b, 1/Pa; the density stays below 1 + a / b times that at ambient pressure.

    Source
    ------
    D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, 1966.

    Examples
    --------
    >>> law = ehd.DowsonHigginson()
    >>> round(float(law.ratio(1e8)), 3)  # as dense at 100 MPa as at ambient pressure
    1.051
    """

    coefficient: float = 0.6e-9
    saturation: float = 1.7e-9

    checks = dict.fromkeys(("coefficient", "saturation"), COEFFICIENT)

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

    def ratio_bend(self, p: np.ndarray) -> np.ndarray:
        """d2(rho / rho_0)/dp2 for p >= 0, 1/Pa^2."""
        return -2.0 * self.coefficient * self.saturation / (1.0 + self.saturation * p) ** 3

    def flow_work(self, p: np.ndarray) -> np.ndarray:
        """Integral of dp / (rho / rho_0) from ambient pressure, Pa.

        The work on oil that enters at p, per volume at ambient density: p dV that pushes it in and the elastic energy
        that it holds.
        """
        p, a, b = np.asarray(p, dtype=float), self.coefficient, self.saturation
        above, g = np.maximum(p, 0.0), a + b
        dense = (b * above + a / g * np.log1p(g * above)) / g
        return np.where(p >= 0.0, dense, -np.expm1(-a * np.minimum(p, 0.0)) / a)


class DensityField:
    """Density at the vertices of a film.

    Attributes
    ----------
    scale : float
        Pa per unit of the scaled pressure.
    rho, rho_P : (n, m) arrays
        Density over that at ambient pressure, of the last solution, and its derivative when last factored.
    """

    def __init__(self, law: CompressibleLaw, shape: tuple[int, int]) -> None:
        self.law, self.scale = law, 1.0
        self.rho, self.rho_P = np.ones((2, *shape))
        self.known = np.full((9, self.rho.size), np.nan)
        # whether Newton's steps may go beyond the end of the law
        self.crosses = False

    def is_exhausted(self, P: np.ndarray) -> bool:
        """Return whether scaled transformed pressures (n, m) reach the end of the law's range."""
        return bool(P.max() * self.scale >= (1.0 - ROUNDING) * self.law.kernel_table.highest)

    def fields(self, floor: float) -> tuple[float, float, LawTable, np.ndarray, bool]:
        """Arguments of the kernels for this law; ``floor``: scaled pressure below which the density is constant."""
        return self.scale, floor, self.law.kernel_table, self.known, self.crosses


class CompressibleLaw(PressureTransform):
    """Transform of a density law together with a viscosity's: ``s = r / (rho / rho_0)``.

    Parameters
    ----------
    density : DensityLaw
    viscosity : PressureLaw or None
        None: constant viscosity.
    """

    def __init__(self, density: DensityLaw, viscosity: PressureLaw | None) -> None:
        self.density, self.viscosity = density, viscosity
        exponent = (0.0 if viscosity is None else viscosity.coefficient) - density.coefficient
        largest_pressure = LARGEST_PRESSURE if viscosity is None else viscosity.largest_pressure
        self.compressibility = density.coefficient
        self._tabulate(largest_pressure, exponent or SMALLEST_EXPONENT)

    def densities(self, slope: np.ndarray, slope_p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density ratio at the nodes and its first two derivatives to q, for s = dp/dq and ds/dp there."""
        p, law = self.p, self.density
        rho_p, rho_pp = law.ratio_slope(p), law.ratio_bend(p)
        return law.ratio(p), rho_p * slope, rho_pp * slope**2 + rho_p * slope * slope_p

    def slopes(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """s = dp/dq and ds/dp, 1/Pa, for p >= 0."""
        mu, mu_p = (np.ones_like(p), np.zeros_like(p)) if self.viscosity is None else super().slopes(p)
        rho, rho_p = self.density.ratio(p), self.density.ratio_slope(p)
        return mu / rho, (mu_p * rho - mu * rho_p) / rho**2


# Reach of a Taylor polynomial: relative change of dp/dq, and an eighth of that of the density's slope, up to which the
# polynomial replaces the law. The error is then 1e-14 in the density and 1e-10 in its slope. A larger value gives
# larger errors, a smaller one more look-ups.
NEAR = 5e-4


@njit(cache=True)
def density_at(P, scale, floor, law, known, rho_out):
    """Density ratio (n, m); looks up pressures beyond a polynomial's reach. Beyond the law's range: that at its end."""
    x, rho = P.reshape(-1), rho_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    if _ratio_near(x, scale, lowest, highest, known, rho) > 0.0:
        look_up(x, scale, lowest, highest, law, 1.0, known)
        _ratio_near(x, scale, lowest, highest, known, rho)


@njit(cache=True)
def know_at(P, scale, floor, law, known):
    """Store the law at the pressures (n, m) of a solution, so that tangents do not depend on the previous film."""
    look_up(P.reshape(-1), scale, max(floor, law.lowest / scale), law.highest / scale, law, 0.0, known)


# Where a law is linear, the reach of its polynomial is infinite.
@njit(cache=True, error_model="numpy")
def look_up(x, scale, lowest, highest, law, near, known):
    """Store the law at every x (size,) that is farther from its stored pressure than ``near`` times the reach.

    x is cut at ``lowest`` and ``highest``.
    """
    for c in range(x.size):
        q = _within(x[c], lowest, highest) * scale
        if abs(q - known[0, c]) <= near * known[8, c] and (q > 0.0) == (known[0, c] > 0.0):
            continue
        _, rho, s, s_q, r1, r2, r3, r4 = law_at(q, law)
        known[0, c], known[1, c], known[2, c], known[3, c] = q, rho, s, s_q
        known[4, c], known[5, c], known[6, c], known[7, c] = r1, r2, r3, r4
        known[8, c] = NEAR * min(s / abs(s_q), 4.0 * r1 / abs(r2))


@njit(cache=True, inline="always")
def _within(x, lowest, highest):
    if not x > lowest:
        return lowest
    return x if x < highest else highest


@njit(cache=True, fastmath=FAST)
def _ratio_near(x, scale, lowest, highest, known, rho_out):
    """Density ratio from the stored polynomials; returns the number of pressures beyond their reach."""
    at, rho, r1, r2, r3, r4, reach = known[0], known[1], known[4], known[5], known[6], known[7], known[8]
    far = 0.0
    for c in range(rho_out.size):
        y = x[c] if x[c] > lowest else lowest
        q = (y if y < highest else highest) * scale
        d = q - at[c]
        far += 0.0 if (abs(d) <= reach[c]) & ((q > 0.0) == (at[c] > 0.0)) else 1.0
        rho_out[c] = rho[c] + d * (r1[c] + d * (r2[c] + d * (r3[c] + d * r4[c])))
    return far


@njit(cache=True, fastmath=FAST)
def density_slope_at(P, scale, floor, law, known, rho_P_out):
    """Derivative (n, m) of the density ratio to P at the pressures of the last `density_at`; 0 where it is constant."""
    x, slope = P.reshape(-1), rho_P_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    at, r1, r2, r3, r4 = known[0], known[4], known[5], known[6], known[7]
    for c in range(slope.size):
        y = x[c] if x[c] > lowest else lowest
        d = (y if y < highest else highest) * scale - at[c]
        by_pressure = scale * (r1[c] + d * (2.0 * r2[c] + d * (3.0 * r3[c] + 4.0 * d * r4[c])))
        slope[c] = by_pressure if (x[c] >= lowest) & (x[c] < highest) else 0.0
