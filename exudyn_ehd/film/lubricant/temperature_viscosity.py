"""Viscosity that depends on temperature: Reynolds, Vogel and Walther laws, in closed form through published points.

A law returns the dynamic viscosity at ambient pressure. Temperatures in kelvin. Laws are monotone: hotter oil is
thinner.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np

from exudyn_ehd.status import NOT_NEGATIVE, Checked, InputError, require_vector

# Walther's constant for viscosities above 2 mm2/s, ASTM D341.
WALTHER_SHIFT = 0.7
CELSIUS_15 = 288.15


@runtime_checkable
class TemperatureLaw(Protocol):
    """Viscosity that depends on temperature: a law of this module or one's own."""

    def viscosity(self, temperature: float | np.ndarray, density: float) -> np.ndarray:
        """Dynamic viscosity, Pa s, at ambient pressure, temperatures in K and the lubricant's density, kg/m3."""


@dataclass(frozen=True, kw_only=True)
class ReynoldsTemperature(Checked):
    """Viscosity over temperature, ``mu = mu_1 exp(-beta (T - T_1))`` (O. Reynolds 1886), for narrow ranges.

    Parameters
    ----------
    point : (float, float)
        Temperature T_1, K, and dynamic viscosity mu_1, Pa s.
    coefficient : float
        beta, 1/K; 0.02 to 0.05 for mineral oils.

    Examples
    --------
    >>> law = ehd.ReynoldsTemperature(point=(313.15, 0.04), coefficient=0.03)
    >>> round(float(law.viscosity(333.15, 870.0)), 4)  # Pa s at 60 degrees Celsius
    0.022
    """

    point: tuple[float, float]
    coefficient: float

    checks: ClassVar = {"coefficient": NOT_NEGATIVE}

    def __post_init__(self) -> None:
        _check_point("ReynoldsTemperature.point", self.point, "Pa s")
        super().__post_init__()

    def viscosity(self, temperature: float | np.ndarray, density: float) -> np.ndarray:
        """Dynamic viscosity, Pa s, at temperatures in K; the density does not matter."""
        return self.point[1] * np.exp(-self.coefficient * (_kelvin(temperature) - self.point[0]))


@dataclass(frozen=True, kw_only=True)
class VogelTemperature(Checked):
    """Viscosity over temperature by Vogel's law ``mu = A exp(B / (T - T_0))`` through two points.

    H. Vogel, Physikalische Zeitschrift 22 (1921) 645:
    ``B = ln(mu_1 / mu_2) / (1 / (T_1 - T_0) - 1 / (T_2 - T_0))``, ``A = mu_1 exp(-B / (T_1 - T_0))``.

    Parameters
    ----------
    first, second : (float, float)
        Temperature, K, and dynamic viscosity, Pa s; the second one hotter and thinner.
    pole : float, default 178.15
        T_0, K; -95 degrees Celsius suits mineral oils (A. Cameron, Principles of Lubrication).

    Examples
    --------
    >>> law = ehd.VogelTemperature(first=(313.15, 0.04), second=(373.15, 0.006))
    >>> round(float(law.viscosity(333.15, 870.0)), 4)  # Pa s at 60 degrees Celsius
    0.0181
    """

    first: tuple[float, float]
    second: tuple[float, float]
    pole: float = 178.15

    checks: ClassVar = {"pole": NOT_NEGATIVE}

    def __post_init__(self) -> None:
        _check_points("VogelTemperature", self.first, self.second, "Pa s")
        super().__post_init__()
        if not self.pole < self.first[0]:
            raise InputError(
                f"VogelTemperature.pole must be below both temperatures ({self.first[0]:g} K), got {self.pole:g} K; "
                "the law has no viscosity at its pole."
            )

    @cached_property
    def constants(self) -> tuple[float, float]:
        """(A in Pa s, B in K)."""
        (t1, mu1), (t2, mu2) = self.first, self.second
        B = math.log(mu1 / mu2) / (1.0 / (t1 - self.pole) - 1.0 / (t2 - self.pole))
        return mu1 * math.exp(-B / (t1 - self.pole)), B

    def viscosity(self, temperature: float | np.ndarray, density: float) -> np.ndarray:
        """Dynamic viscosity, Pa s, at temperatures in K above the pole; the density does not matter."""
        A, B = self.constants
        return A * np.exp(B / (_kelvin(temperature) - self.pole))


@dataclass(frozen=True, kw_only=True)
class WaltherTemperature(Checked):
    """Viscosity over temperature by Walther's law ``log10 log10(nu + 0.7) = a - b log10 T`` through two points.

    In this formula the kinematic viscosity nu is in mm2/s (ASTM D341); the arguments are in m2/s.

    The dynamic viscosity is ``nu rho(T)``, with ``rho = rho_15 exp(-x (1 + 0.8 x))``, ``x = expansion (T - 288.15)``;
    `Lubricant.density` is rho_15, the density at 15 degrees Celsius (ISO 91, ASTM D1250).

    Parameters
    ----------
    first, second : (float, float)
        Temperature, K, and kinematic viscosity, m2/s, above 2e-6; the second one hotter and thinner.
    expansion : float, default 0.0
        Thermal expansion at 15 degrees, 1/K; lubricating oils: 7e-4 (0.6278 kg/(m3 K) over rho_15). 0: the same density
        at all temperatures, which overestimates the dynamic viscosity of mineral oils by 2 % at 40 and 7 % at 100
        degrees.

    Examples
    --------
    >>> law = ehd.WaltherTemperature(first=(313.15, 46e-6), second=(373.15, 6.8e-6))
    >>> round(float(law.viscosity(333.15, 870.0)), 4)  # Pa s at 60 degrees Celsius
    0.0179
    """

    first: tuple[float, float]
    second: tuple[float, float]
    expansion: float = 0.0

    checks: ClassVar = {"expansion": partial(NOT_NEGATIVE, at_most=0.01, hint="oils have 7e-4 1/K, 0.6278 / density.")}

    def __post_init__(self) -> None:
        _check_points("WaltherTemperature", self.first, self.second, "m2/s")
        if not 1e6 * self.second[1] + WALTHER_SHIFT > 1.0 or not 1e6 * self.first[1] < 1e7:
            raise InputError(
                f"WaltherTemperature takes kinematic viscosities in m2/s (46 mm2/s is 46e-6), got {self.first[1]!r} "
                f"and {self.second[1]!r}."
            )
        super().__post_init__()

    @cached_property
    def constants(self) -> tuple[float, float]:
        """(a, b) for natural logarithms inside: ``ln ln(nu + 0.7) = a - b ln T``."""
        w1, w2 = (math.log(math.log(1e6 * nu + WALTHER_SHIFT)) for _, nu in (self.first, self.second))
        t1, t2 = math.log(self.first[0]), math.log(self.second[0])
        b = (w1 - w2) / (t2 - t1)
        return w1 + b * t1, b

    def viscosity(self, temperature: float | np.ndarray, density: float) -> np.ndarray:
        """Dynamic viscosity, Pa s, at temperatures in K, for a density at 15 degrees Celsius in kg/m3."""
        a, b = self.constants
        T = _kelvin(temperature)
        mu = 1e-6 * (np.exp(np.exp(a - b * np.log(T))) - WALTHER_SHIFT) * density
        if self.expansion == 0.0:
            return mu
        x = self.expansion * (T - CELSIUS_15)
        return mu * np.exp(-x * (1.0 + 0.8 * x))


def _kelvin(temperature: float | np.ndarray) -> float | np.ndarray:
    """A float as it is, since one temperature of the whole film takes the law once a step.

    Anything else as an array.
    """
    return temperature if isinstance(temperature, float) else np.asarray(temperature)


def _check_point(where: str, point: tuple[float, float], unit: str) -> None:
    values = require_vector(where, point, 2)
    if not (values[0] > 0.0 and values[1] > 0.0):
        raise InputError(f"{where} must be (temperature > 0 K, viscosity > 0 {unit}), got {point!r}.")


def _check_points(name: str, first: tuple[float, float], second: tuple[float, float], unit: str) -> None:
    _check_point(f"{name}.first", first, unit)
    _check_point(f"{name}.second", second, unit)
    if not (first[0] < second[0] and first[1] > second[1]):
        raise InputError(
            f"{name}: the second point must be hotter and thinner than the first, got {first!r} and {second!r}; "
            f"temperatures are in kelvin."
        )
