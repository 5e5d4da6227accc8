"""Lubricant: viscosity and density at the reference state, and laws of the viscosity over temperature.

Viscosity that depends on temperature
-------------------------------------
Reynolds, Vogel and Walther laws in closed form through published points, and a table. A law returns the dynamic
viscosity at ambient pressure. Temperatures in kelvin. Laws are monotone: hotter oil is thinner.

Named oils: ISO grades, SAE single grades and multigrades from two viscosity points
-----------------------------------------------------------------------------------
ISO VG: mid-point kinematic viscosity at 40 degrees Celsius by definition (ISO 3448); at 100 degrees Celsius, and the
density at 15, typical figures of paraffinic mineral oils with a viscosity index (ASTM D2270) of 95 to 102, as hydraulic
and gear oils have; VG 220 is Shell's Omala S2 G 220. Other makers' oils of these grades lie within 6 % at 100 degrees
and 2.5 % in density.

SAE: single grades after A. S. Seireg and S. Dandage, J. Lubrication Technology 104 (1982) 135,
``mu = mu_0 exp(b / (T + 95))`` with T in degrees Fahrenheit and mu_0 in reyn, which is Vogel's law with its pole at -95
degrees Fahrenheit.

Multigrade: typical figures of one mineral or synthetic oil per grade from its maker's product data sheet
(ASTM D445 and D4052): Mobil Super 3000 0W-20, 2000 5W-30, 2000 X2 10W-40, 1000 X2 15W-40 and 1000 20W-50 (ExxonMobil,
Mobil Oil Australia, 2015). Their viscosity improvers thin under shear, which these figures at low shear do not show: at
150 degrees Celsius and 1e6 1/s (ASTM D4683) the same sheets give 7 to 17 % less than the law; add a `CarreauShear`
if this matters.

Oils of one grade differ by some 10 % in the viscosity at 40 and at 100 degrees Celsius: if the data sheet of an oil is
known, use its two points. The density decreases from that at 15 degrees by 0.63 kg/m3 per kelvin, as for all
lubricating oils (ASTM D1250, table 54D). The dynamic viscosity takes this into account.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import ClassVar, Protocol, get_args, get_type_hints, runtime_checkable

import numpy as np
import scipy

from exudyn_ehd.film.lubricant.density import CompressibleLaw, DensityLaw, DowsonHigginson
from exudyn_ehd.film.lubricant.pressure_viscosity import (
    BarusPressure,
    PressureOption,
    PressureTransform,
    RoelandsPressure,
)
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear, ShearLaw
from exudyn_ehd.status import KELVIN, NOT_NEGATIVE, POSITIVE, Checked, InputError, require_type, require_vector

# Walther's constant for viscosities above 2 mm2/s, ASTM D341.
WALTHER_SHIFT = 0.7
CELSIUS_15, CELSIUS_40, CELSIUS_100 = 288.15, 313.15, 373.15
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


# kg/(m3 K), ASTM D1250, table 54D
EXPANSION = 0.6278
REYN = 6894.757  # Pa s
VOGEL_POLE = (459.67 - 95.0) / 1.8  # K
# grade: (nu at 40, nu at 100 in mm2/s, density at 15 in kg/m3)
ISO_GRADES = {
    "ISO VG 22": (22.0, 4.3, 866.0),
    "ISO VG 32": (32.0, 5.4, 875.0),
    "ISO VG 46": (46.0, 6.7, 879.0),
    "ISO VG 68": (68.0, 8.6, 886.0),
    "ISO VG 100": (100.0, 11.1, 891.0),
    "ISO VG 150": (150.0, 15.0, 897.0),
    "ISO VG 220": (220.0, 19.4, 899.0),
    "ISO VG 320": (320.0, 25.0, 903.0),
    "ISO VG 460": (460.0, 30.8, 904.0),
}
# grade: (nu at 40, nu at 100 in mm2/s, density at 15 in kg/m3)
MULTIGRADES = {
    "SAE 0W-20": (44.9, 8.6, 848.0),
    "SAE 5W-30": (64.0, 10.6, 860.0),
    "SAE 10W-40": (96.0, 14.4, 877.0),
    "SAE 15W-40": (109.0, 14.5, 880.0),
    "SAE 20W-50": (161.0, 18.2, 884.0),
}
# grade: (mu_0 in 1e-6 reyn, b in degrees Fahrenheit)
SAE_GRADES = {
    "SAE 10": (0.0158, 1157.5),
    "SAE 20": (0.0136, 1271.6),
    "SAE 30": (0.0141, 1360.0),
    "SAE 40": (0.0121, 1474.4),
    "SAE 50": (0.0170, 1509.6),
    "SAE 60": (0.0187, 1564.0),
}
SAE_DENSITY = 880.0


@dataclass(frozen=True, kw_only=True)
class Lubricant(Checked):
    """Oil or another liquid: Newtonian and of constant viscosity unless laws are named.

    When: a pressure law for peak pressures above some 50 MPa, a temperature law where the film warms up by more than a
    few kelvin, a shear law for multigrade oils at shear rates above 1e5 to 1e6 1/s. Each adds 10 to 20 % to the time of
    a film evaluation. A density law adds 25 % with `ElrodAdams`; with the other cavitation models, whose matrix it
    makes non-symmetric, it more than doubles the time.

    Laws multiply: ``mu = viscosity * r_p(p) * r_T(T) * r_G(shear rate)``, each ratio 1 at ambient pressure, at
    ``temperature``, at rest. `PressureOption`, `TemperatureLaw`, `ShearLaw` and `DensityLaw` stand for laws of your
    own: "Extension points" in the package's README.

    Parameters
    ----------
    viscosity : float or None, default None
        Dynamic viscosity at ``temperature``, ambient pressure and low shear, Pa s. None: taken from
        ``temperature_law``.
    density : float, default 870.0
        kg/m3, at ambient pressure; used for masses, Reynolds numbers, heat capacities and kinematic viscosities.
    temperature : float, default 313.15
        K, at which ``viscosity`` holds; without a thermal effect the whole film has it. To change it, use `at`, which
        changes the viscosity as well.
    specific_heat : float, default 2000.0
        J/(kg K); only used by thermal effects.
    pressure_law : BarusPressure, RoelandsPressure, PressureOption or None, default None
        Viscosity under pressure; None: the viscosity does not depend on the pressure.
    temperature_law : ReynoldsTemperature, VogelTemperature, WaltherTemperature, TableViscosity or None, default None
        Or a `TemperatureLaw`. None: the viscosity does not depend on the temperature.
    shear_law : CarreauShear, ShearLaw or None, default None
        Viscosity under shear; None: Newtonian.
    density_law : DowsonHigginson, DensityLaw or None, default None
        Density under pressure, at any temperature: reported flows, m3/s, are then mass flows over ``density``. None:
        incompressible.

    Raises
    ------
    InputError
        For values outside their ranges, or if neither a viscosity nor a temperature law is given.

    Examples
    --------
    >>> oil = ehd.Lubricant(viscosity=0.02, pressure_law=ehd.RoelandsPressure(coefficient=2e-8))
    >>> oil.viscosity, oil.density  # Pa s, kg/m^3
    (0.02, 870.0)
    """

    viscosity: float = None  # type: ignore[assignment]
    density: float = 870.0
    temperature: float = 313.15
    specific_heat: float = 2000.0
    pressure_law: BarusPressure | RoelandsPressure | PressureOption | None = None
    temperature_law: (
        ReynoldsTemperature | VogelTemperature | WaltherTemperature | TableViscosity | TemperatureLaw | None
    ) = None
    shear_law: CarreauShear | ShearLaw | None = None
    density_law: DowsonHigginson | DensityLaw | None = None

    checks: ClassVar = {"viscosity": POSITIVE, "density": POSITIVE, "temperature": KELVIN, "specific_heat": POSITIVE}

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, laws in LAWS.items():
            law = getattr(self, name)
            require_type(f"Lubricant.{name}", law, *laws, hint="laws are objects, not strings or classes.")
        if self.temperature_law is not None:
            require_covered("Lubricant.temperature", self.temperature_law, self.temperature)
        if self.viscosity is None:
            if self.temperature_law is None:
                raise InputError(
                    "Lubricant.viscosity must be > 0 Pa s, got None; give viscosity=..., a temperature_law=..., or "
                    'take a named oil, oil("ISO VG 46").'
                )
            object.__setattr__(self, "viscosity", float(self.temperature_law.viscosity(self.temperature, self.density)))
            POSITIVE("Lubricant.viscosity", self.viscosity)
        if self.pressure_law is not None:
            self.pressure_law.bound(self.viscosity)

    def at(self, temperature: float) -> Lubricant:
        """Return the same lubricant at another temperature.

        Parameters
        ----------
        temperature : float
            K.

        Returns
        -------
        Lubricant

        Raises
        ------
        InputError
            Without a temperature law.
        """
        if (law := self.temperature_law) is None:
            raise InputError("Lubricant.at needs a temperature_law, which says how the viscosity changes; got None.")
        POSITIVE("Lubricant.at: temperature", temperature)
        require_covered("Lubricant.at: temperature", law, temperature)
        ratio = law.viscosity(temperature, self.density) / law.viscosity(self.temperature, self.density)
        return replace(self, temperature=float(temperature), viscosity=float(self.viscosity * ratio))


def transform_of(oil: Lubricant) -> PressureTransform | None:
    """Transform from pressure to a film's unknown; `CompressibleLaw` with a density law; None without these laws."""
    viscosity = None if oil.pressure_law is None else oil.pressure_law.bound(oil.viscosity)
    if oil.density_law is not None:
        return CompressibleLaw(oil.density_law, viscosity)
    return None if viscosity is None else PressureTransform(viscosity)


LAWS = {name: get_args(kinds) for name, kinds in get_type_hints(Lubricant).items() if name.endswith("_law")}


def oil(name: str, *, temperature: float = CELSIUS_40) -> Lubricant:
    """Return the `Lubricant` of a grade, e.g. ISO VG 46, whose viscosity changes with temperature.

    Parameters
    ----------
    name : str
        ``"ISO VG 22"`` to ``"ISO VG 460"``, ``"SAE 10"`` to ``"SAE 60"``, or ``"SAE 0W-20"``, ``"SAE 5W-30"``,
        ``"SAE 10W-40"``, ``"SAE 15W-40"``, ``"SAE 20W-50"``; spaces and case do not matter.
    temperature : float, default 313.15
        K, at which ``viscosity`` is given; without a thermal effect the temperature of the whole film.

    Returns
    -------
    Lubricant
        With a temperature law; add other laws by ``dataclasses.replace(lubricant, pressure_law=...)``.

    Raises
    ------
    InputError
        For a name that is not in the tables.

    Source
    ------
    ISO 3448; makers' data sheets; A. S. Seireg and S. Dandage, J. Lubrication Technology 104 (1982) 135.

    Examples
    --------
    >>> round(ehd.oil("ISO VG 46").viscosity, 4)  # Pa s, at 40 degrees Celsius
    0.0397
    >>> round(ehd.oil("SAE 5W-30", temperature=373.15).viscosity, 4)
    0.0085
    """
    POSITIVE("oil: temperature", temperature)
    known = {_key(k): k for k in (*ISO_GRADES, *SAE_GRADES, *MULTIGRADES)}
    grade = known.get(_key(name)) if isinstance(name, str) else None
    if grade is None:
        raise InputError(
            f"oil: name must be one of {', '.join(known.values())}, got {name!r}; for any other oil use "
            "Lubricant(temperature_law=WaltherTemperature(first=..., second=...), temperature=...)."
        )
    two_points = ISO_GRADES.get(grade) or MULTIGRADES.get(grade)
    if two_points is not None:
        nu40, nu100, density = two_points
        walther = WaltherTemperature(
            first=(CELSIUS_40, 1e-6 * nu40), second=(CELSIUS_100, 1e-6 * nu100), expansion=EXPANSION / density
        )
        return Lubricant(temperature_law=walther, temperature=temperature, density=density)
    law = VogelTemperature(first=_sae_point(grade, CELSIUS_40), second=_sae_point(grade, CELSIUS_100), pole=VOGEL_POLE)
    return Lubricant(temperature_law=law, temperature=temperature, density=SAE_DENSITY)


def _sae_point(grade: str, temperature: float) -> tuple[float, float]:
    mu_0, b = SAE_GRADES[grade]
    fahrenheit = 1.8 * temperature - 459.67
    return temperature, 1e-6 * mu_0 * REYN * math.exp(b / (fahrenheit + 95.0))


def _key(name: str) -> str:
    return "".join(name.split()).upper()
