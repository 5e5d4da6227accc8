"""Lubricant: viscosity and density at the reference state, and the laws of their change with the state of the oil.

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
from dataclasses import dataclass, replace
from typing import ClassVar, get_args, get_type_hints

from exudyn_ehd.film.lubricant.density import CompressibleLaw, DensityLaw, DowsonHigginson
from exudyn_ehd.film.lubricant.pressure_viscosity import (
    BarusPressure,
    PressureOption,
    PressureTransform,
    RoelandsPressure,
)
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear, ShearLaw
from exudyn_ehd.film.lubricant.temperature_viscosity import (
    ReynoldsTemperature,
    TableViscosity,
    TemperatureLaw,
    VogelTemperature,
    WaltherTemperature,
    require_covered,
)
from exudyn_ehd.status import KELVIN, POSITIVE, Checked, InputError, require_type

# kg/(m3 K), ASTM D1250, table 54D
EXPANSION = 0.6278
CELSIUS_40 = 313.15
CELSIUS_100 = 373.15
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
    temperature_law : ReynoldsTemperature, VogelTemperature, WaltherTemperature, TableViscosity or None, default None
        Or a `TemperatureLaw`. None: the viscosity does not depend on the temperature.
    shear_law : CarreauShear, ShearLaw or None, default None
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
            require_type(
                f"Lubricant.{name}", getattr(self, name), *laws, hint="laws are objects, not strings or classes."
            )
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
        if self.temperature_law is None:
            raise InputError("Lubricant.at needs a temperature_law, which says how the viscosity changes; got None.")
        POSITIVE("Lubricant.at: temperature", temperature)
        law = self.temperature_law
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
