"""The lubricant: viscosity and density at the reference state, and the laws by which they depart from it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from exudyn_ehd.film.lubricant.density import DowsonHigginson
from exudyn_ehd.film.lubricant.pressure_viscosity import BarusPressure, RoelandsPressure
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear
from exudyn_ehd.film.lubricant.temperature_viscosity import ReynoldsTemperature, VogelTemperature, WaltherTemperature
from exudyn_ehd.status import InputError, require_number, require_type

LAWS: dict[str, tuple[type, ...]] = {
    "pressure_law": (BarusPressure, RoelandsPressure),
    "temperature_law": (ReynoldsTemperature, VogelTemperature, WaltherTemperature),
    "shear_law": (CarreauShear,),
    "density_law": (DowsonHigginson,),
}


@dataclass(frozen=True, kw_only=True)
class Lubricant:
    """Lubricant: Newtonian and of constant viscosity unless laws are named.

    When: a pressure law above some 50 MPa, a temperature law where the film warms up by more than a few kelvin, a shear
    law for multigrade oils above 1e5 to 1e6 per second. A law adds a tenth to a fifth to the time of a film evaluation;
    a density law a quarter with `ElrodAdams`, and more than the whole again with the other closures, whose matrix it
    makes non-symmetric.

    Laws multiply: ``mu = viscosity * r_p(p) * r_T(T) * r_G(shear rate)``, each ratio 1 at ambient pressure, at
    ``temperature``, at rest.

    Parameters
    ----------
    viscosity : float
        Dynamic viscosity at ``temperature``, ambient pressure and low shear, Pa s. Left out, it comes from
        ``temperature_law``.
    density : float
        kg/m3; used where a mass, a Reynolds number, a heat capacity or a kinematic viscosity enters.
    temperature : float
        K, at which ``viscosity`` holds; without a thermal effect the whole film has it. To change it, use `at`, which
        changes the viscosity along.
    specific_heat : float
        J/(kg K); only used by thermal effects.
    pressure_law : BarusPressure, RoelandsPressure or None
    temperature_law : ReynoldsTemperature, VogelTemperature, WaltherTemperature or None
    shear_law : CarreauShear or None
    density_law : DowsonHigginson or None
        Density under pressure, at any temperature; None: incompressible. Flows are then mass flows over ``density``.

    Raises
    ------
    InputError
        For values that can't be meant, or if neither a viscosity nor a temperature law is given.

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
    pressure_law: BarusPressure | RoelandsPressure | None = None
    temperature_law: ReynoldsTemperature | VogelTemperature | WaltherTemperature | None = None
    shear_law: CarreauShear | None = None
    density_law: DowsonHigginson | None = None

    def __post_init__(self) -> None:
        require_number("Lubricant.density", self.density, "kg/m3", above=0.0)
        require_number(
            "Lubricant.temperature", self.temperature, "K", above=0.0, hint="0 degrees Celsius are 273.15 K."
        )
        require_number("Lubricant.specific_heat", self.specific_heat, "J/(kg K)", above=0.0)
        for name, laws in LAWS.items():
            hint = "laws are objects, not strings or classes."
            require_type(f"Lubricant.{name}", getattr(self, name), *laws, type(None), hint=hint)
        if self.viscosity is None:
            object.__setattr__(self, "viscosity", self._viscosity_from_law())
        require_number("Lubricant.viscosity", self.viscosity, "Pa s", above=0.0)
        if self.pressure_law is not None:
            self.pressure_law.check(self.viscosity)

    def _viscosity_from_law(self) -> float:
        if self.temperature_law is None:
            raise InputError(
                "Lubricant.viscosity must be > 0 Pa s, got None; give viscosity=..., a temperature_law=..., or take a "
                "named "
                'oil, oil("ISO VG 46").'
            )
        return float(self.temperature_law.viscosity(self.temperature, self.density))

    def at(self, temperature: float) -> Lubricant:
        """The same lubricant at another temperature.

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
        require_number("Lubricant.at: temperature", temperature, "K", above=0.0)
        law = self.temperature_law
        ratio = law.viscosity(temperature, self.density) / law.viscosity(self.temperature, self.density)
        return dataclasses.replace(self, temperature=float(temperature), viscosity=float(self.viscosity * ratio))
