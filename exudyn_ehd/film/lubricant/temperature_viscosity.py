"""Viscosity that depends on temperature: Reynolds, Vogel and Walther laws, in closed form through published points, and
a table.

A law returns the dynamic viscosity at ambient pressure. Temperatures in kelvin. Laws are monotone: hotter oil is
thinner.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
import scipy

from exudyn_ehd.status import NOT_NEGATIVE, Checked, InputError, require_vector

# Walther's constant for viscosities above 2 mm2/s, ASTM D341.
WALTHER_SHIFT = 0.7
CELSIUS_15 = 288.15
# Unit of viscosity, Pa s, in the double logarithm of a table; below the viscosity of liquids, so that the logarithm is
# positive. With a smaller unit the curves of oils are less straight.
TABLE_UNIT = 1e-5


@runtime_checkable
class TemperatureLaw(Protocol):
    """Viscosity that depends on temperature: a law of this module or a user's law.

    ``limits``, an optional attribute: lowest and highest temperature, K, that a film with this law may have.
    """

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


@dataclass(frozen=True, kw_only=True)
class TableViscosity(Checked):
    """Viscosity over temperature from measured points, by monotone cubics of ``ln ln (mu / 1e-5 Pa s)`` over ``ln T``.

    Oils are nearly straight lines in these coordinates, as in Walther's law. Between two points the viscosity stays
    between theirs and has a continuous slope (F. N. Fritsch and R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238).
    Points 20 K apart give ISO and multigrade oils within 0.1 %, SAE single grades, which bend more, within 1.2 %;
    points 10 K apart within 0.01 and 0.2 %.

    Temperatures outside the table are errors: `InputError` for a given temperature, `FilmError` for that of a film.

    Parameters
    ----------
    temperatures : sequence of float
        Increasing, K; at least 2.
    viscosities : sequence of float
        Dynamic viscosity at these temperatures, Pa s; each below the one before, above 1e-5.

    Examples
    --------
    >>> law = ehd.TableViscosity(temperatures=(293.15, 313.15, 333.15), viscosities=(0.108, 0.0397, 0.0178))
    >>> round(float(law.viscosity(323.15, 870.0)), 4)  # Pa s at 50 degrees Celsius
    0.026
    """

    temperatures: Sequence[float]
    viscosities: Sequence[float]

    def __post_init__(self) -> None:
        for name in ("temperatures", "viscosities"):
            values = getattr(self, name)
            size = len(values) if isinstance(values, Sequence | np.ndarray) else 2
            # lists and arrays are stored as tuples, which can be compared and hashed
            object.__setattr__(self, name, tuple(require_vector(f"TableViscosity.{name}", values, size).tolist()))
        T, mu = np.array(self.temperatures), np.array(self.viscosities)
        rising = T.size > 1 and T[0] > 0.0 and np.all(np.diff(T) > 0.0)
        if not (rising and mu.shape == T.shape and mu[-1] > TABLE_UNIT and np.all(np.diff(mu) < 0.0)):
            raise InputError(
                "TableViscosity needs at least two increasing temperatures above 0 K, each with a viscosity below the "
                f"one before and above {TABLE_UNIT:g} Pa s, got temperatures={self.temperatures!r} and "
                f"viscosities={self.viscosities!r}; sort the points, and leave out those that measure the same."
            )

    @property
    def limits(self) -> tuple[float, float]:
        """Lowest and highest temperature of the table, K."""
        return self.temperatures[0], self.temperatures[-1]

    @cached_property
    def curve(self) -> scipy.interpolate.CubicHermiteSpline:
        """Double logarithm of the viscosity over the logarithm of the temperature; straight beyond both ends.

        The search for a film's temperature may use states beyond the ends; results are between them.
        """
        x, y = np.log(self.temperatures), np.log(np.log(np.array(self.viscosities) / TABLE_UNIT))
        slopes = scipy.interpolate.PchipInterpolator(x, y)(x, 1)
        first, last = slopes[0], slopes[-1]
        wide, values = (x[0] - 1.0, *x, x[-1] + 1.0), (y[0] - first, *y, y[-1] + last)
        return scipy.interpolate.CubicHermiteSpline(wide, values, (first, *slopes, last))

    def viscosity(self, temperature: float | np.ndarray, density: float) -> np.ndarray:
        """Dynamic viscosity, Pa s, at temperatures in K; the density does not matter."""
        return TABLE_UNIT * np.exp(np.exp(self.curve(np.log(_kelvin(temperature)))))


def require_covered(where: str, law: TemperatureLaw, temperature: float) -> None:
    """Raise `InputError` for a temperature, K, outside the ``limits`` of a law that has any."""
    low, high = getattr(law, "limits", (0.0, math.inf))
    if not low <= temperature <= high:
        raise InputError(
            f"{where} = {temperature!r} K is outside the {type(law).__name__}, which reaches from {low:g} to {high:g} "
            "K; extend the table."
        )


def _kelvin(temperature: float | np.ndarray) -> float | np.ndarray:
    """Return a float unchanged, which is fast for the one temperature of a whole film.

    Other arguments are returned as arrays.
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
