"""Temperature of a bearing's film.

Heat balance at accepted steps, viscosity for the next one, and the settled steady state.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.energy import ViscosityField
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal, Walls
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.joint.heat.power import heat_and_exchange
from exudyn_ehd.joint.solved_film import SolvedFilm

# 1/K; no oil thins faster with the temperature.
STEEPEST = 0.2
Field = float | np.ndarray


def temperature_of(film: SolvedFilm) -> np.ndarray:
    """Temperature of a film, K: one for all of it, or a field (n, m)."""
    assert film.temperature is not None
    return np.asarray(film.temperature)


class OilTemperature:
    """Common part of both kinds of film temperature."""

    def __init__(self, spec: LumpedThermal | FilmEnergy, lubricant: Lubricant) -> None:
        assert lubricant.temperature_law is not None
        self.law, self.density = lubricant.temperature_law, lubricant.density
        self.reference = float(self.law.viscosity(float(lubricant.temperature), self.density))
        self.supply = spec.supply_temperature
        self.initial = self._or_supply(spec.initial_temperature)
        self.flow_capacity = lubricant.density * lubricant.specific_heat
        self.carry_over = spec.carry_over

    def _or_supply(self, temperature: float | None) -> float:
        return self.supply if temperature is None else temperature

    def split(self, temperature: Field) -> tuple[Field, Walls | None]:
        """The film's own temperature and that of walls, of which there are none."""
        return temperature, None

    def viscosity_ratio(self, temperature: np.ndarray | float) -> np.ndarray:
        """mu(T) / mu at the lubricant's own temperature."""
        return self.law.viscosity(temperature, self.density) / self.reference

    def follows(self, T: Field, heat: Field, store: Field) -> Field:
        """Return the decrease of the heat per kelvin that a step raises T; heat, W, and store, W/K, are scaled alike.

        Viscosity and heat are those at the start of the step. Where the oil stores less per kelvin than the heat
        changes, such a step would overshoot and the next one swing back. There the heat is linearised in the
        temperature, by the part that the store lacks. Steps much shorter than the exchange of the oil are explicit. In
        a steady state, which stores nothing, repeated use converges where the heating is strong.
        """
        if not np.any(STEEPEST * heat > store):
            return 0.0
        thicker, thinner = (self.viscosity_ratio(T + d) for d in (-0.05, 0.05))
        return np.maximum(np.log(thicker / thinner) / 0.1 * heat - store, 0.0)


class LumpedTemperature(OilTemperature):
    """`LumpedThermal` of one bearing model.

    Parameters
    ----------
    spec : LumpedThermal
    bearing : JournalBearing

    Attributes
    ----------
    field : ViscosityField or None
        Takes the viscosity to an effect that asks for it, as (1, 1) arrays.
    """

    def __init__(self, spec: LumpedThermal, bearing: JournalBearing) -> None:
        super().__init__(spec, bearing.lubricant)
        self.spec = spec
        self.housing = self._or_supply(spec.housing_temperature)
        volume = 2.0 * math.pi * bearing.journal_radius * bearing.length * bearing.radial_clearance
        self.capacity = self.flow_capacity * volume + spec.capacity
        self._last = math.nan, 1.0
        self.field: ViscosityField | None = None

    def initial_temperature(self, shape: tuple[int, int]) -> float:
        """K, at the start of a motion."""
        return self.initial

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Viscosity over the reference at a temperature, K, that the whole film shares."""
        if self._last[0] != temperature:
            ratio = float(self.viscosity_ratio(float(temperature)))
            self._last = float(temperature), ratio
            if self.field is not None:
                self.field.set(np.full((1, 1), ratio))
        return self._last[1]

    def _rates(self, film: SolvedFilm) -> tuple[float, float]:
        """Heat, W, and heat capacity flow of the oil that fresh oil replaces, W/K, of a solved film."""
        heat, exchanged = heat_and_exchange(film, self.carry_over)
        return heat, self.flow_capacity * film.parts.flow_scale * exchanged

    def advance(self, film: SolvedFilm) -> float:
        """Temperature at the end of a solved film's step."""
        return self._settled(film, self.capacity / film.step) if film.step > 0.0 else float(temperature_of(film))

    def steady_temperature(self, film: SolvedFilm) -> float:
        """Temperature in balance with the heat of a solved film; inf without a way out for the heat."""
        return self._settled(film, 0.0)

    def _settled(self, film: SolvedFilm, store: float) -> float:
        """Temperature at the end of a step that stores so much, W/K."""
        T, (heat, flow), G = float(temperature_of(film)), self._rates(film), self.spec.housing_conductance
        if store + flow + G <= 0.0:
            return math.inf if heat > 0.0 else T
        follows = float(self.follows(T, heat, store))
        rise = heat + flow * self.supply + G * self.housing + (store + follows) * T
        return rise / (store + flow + G + follows)

    def balance(self, film: SolvedFilm, temperature: float) -> dict[str, float]:
        """Heat in, convected, conducted and stored, W, of a step or a steady state that ends at ``temperature``."""
        heat, flow = self._rates(film)
        T, store = float(temperature_of(film)), self.capacity / film.step if film.step > 0.0 else 0.0
        stored = store * (temperature - T)
        return {
            "heat_in": heat - float(self.follows(T, heat, store)) * (temperature - T),
            "convected": flow * (temperature - self.supply),
            "conducted": self.spec.housing_conductance * (temperature - self.housing),
            "stored": stored,
        }
