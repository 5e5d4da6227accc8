"""Density that depends on pressure, and with it the Kirchhoff transform of a compressible film.

Dowson and Higginson (D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, 1966), for p >= 0 (gauge):

    rho / rho_0 = 1 + a p / (1 + b p);      below, where oil cavitates, continued with the same slope by exp(a p).

The mass flow under pressure ``rho / mu grad p = grad q / mu_0`` is linear in
``q = integral of (rho / rho_0) / (mu / mu_0) dp``, which grows with p, so that conditions on the cavity hold in q as in
p. Below ambient pressure ``q = (1 - exp(-k p)) / k``, k = alpha - a with the viscosity's coefficient alpha.

Symbols: P scaled transformed pressures (n, m), ``scale`` Pa per unit of P, ``floor`` the scaled pressure below which
the density is constant.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Protocol, runtime_checkable

import numpy as np
from numba import njit

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
        Density over that at ambient pressure, of the last solution, and its derivative to the scaled pressure.
    """

    def __init__(self, law: CompressibleLaw, shape: tuple[int, int]) -> None:
        self.law, self.scale = law, 1.0
        self.rho, self.rho_P = np.ones((2, *shape))
        # s = dp/dq and ds/dq of the vertices
        self.bends = np.zeros((2, self.rho.size))
        # whether Newton's steps may go beyond the end of the law
        self.crosses = False

    def is_exhausted(self, P: np.ndarray) -> bool:
        """Return whether scaled transformed pressures (n, m) reach the end of the law's range."""
        return bool(P.max() * self.scale >= (1.0 - ROUNDING) * self.law.kernel_table.highest)

    def fields(self, floor: float) -> tuple[float, float, LawTable, np.ndarray, bool]:
        """Arguments of the kernels for this law; ``floor``: scaled pressure below which the density is constant."""
        return self.scale, floor, self.law.kernel_table, self.bends, self.crosses


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


@njit(cache=True)
def density_at(P, scale, floor, law, bends_out, rho_out, rho_P_out):
    """Set the density ratio and its derivative to P (n, m), and s and ds/dq (2, size), at scaled pressures P.

    Below ``floor`` and beyond the law's range the density is that at the bound, with the derivative 0.
    """
    x, rho, slope = P.reshape(-1), rho_out.reshape(-1), rho_P_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    at_lowest = law_at(lowest * scale, law)
    for c in range(x.size):
        # nan counts as below the floor
        at = law_at(min(x[c], highest) * scale, law) if x[c] > lowest else at_lowest
        _, rho[c], bends_out[0, c], bends_out[1, c], by_q = at
        slope[c] = scale * by_q if lowest <= x[c] < highest else 0.0
