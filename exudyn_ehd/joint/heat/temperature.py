"""Temperature of a bearing's film.

Heat balance at accepted steps, viscosity for the next one, and the settled steady state.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.conduction import Walls
from exudyn_ehd.film.heat.energy import film_heat
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.joint.heat.band import BandSolver
from exudyn_ehd.joint.heat.power import OilFlows, heat_and_exchange, powers
from exudyn_ehd.joint.solved_film import SolvedFilm

# Rounding of the flow that leaves, as a share of the largest flow over a link.
NO_FLOW = 1e-11
# 1/K; no oil thins faster with the temperature.
STEEPEST = 0.2
Field = float | np.ndarray


def temperature_of(film: SolvedFilm) -> np.ndarray:
    """Temperature of a film, K: one for all of it, or a field (n, m)."""
    assert film.temperature is not None
    return np.asarray(film.temperature)


class _Temperature:
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


class LumpedTemperature(_Temperature):
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


class ViscosityField(FluxEffect):
    """Viscosity ratio of a temperature field at vertices and links: flux effect and shear factor."""

    changes_carriers = False
    depends_on_speed = False

    def __init__(self) -> None:
        self.ratio = np.ones((1, 1))
        self.inverse_x = self.inverse_z = self.ratio

    def set(self, ratio: np.ndarray) -> None:
        """Take over the ratio at the vertices (n, m); links take the mean of their vertices."""
        self.ratio = ratio
        self.inverse_x = 2.0 / (ratio + np.roll(ratio, -1, axis=0))
        self.inverse_z = 1.0 / ratio
        self.inverse_z[:, :-1] = 2.0 / (ratio[:, :-1] + ratio[:, 1:])

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Divide the conductances by the ratio on the link."""
        for conductance in (flux.gx, flux.gx_h, flux.gx_v)[: 2 + flux.speeds]:
            conductance *= self.inverse_x
        for conductance in (flux.gz, flux.gz_h, flux.gz_v)[: 2 + flux.speeds]:
            conductance *= self.inverse_z

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> None:
        """The ratio at the vertices; it depends neither on the gap nor on the speed."""
        ratio_out[:] = self.ratio
        ratio_h_out[:] = 0.0
        ratio_v_out[:] = 0.0


class HeatedFilm(_Temperature):
    """Viscosity and heat of a film with a field of temperatures, `FilmEnergy` of one bearing model.

    Parameters
    ----------
    spec : FilmEnergy
    bearing : JournalBearing
    field : ViscosityField
        Takes the viscosity of the temperature field to the film.
    """

    def __init__(self, spec: FilmEnergy, bearing: JournalBearing, field: ViscosityField) -> None:
        self.spec = spec
        self.field = field
        super().__init__(spec, bearing.lubricant)
        bush, journal = self._or_supply(spec.bush_temperature), self._or_supply(spec.journal_temperature)
        self.transfer = spec.bush_coefficient + spec.journal_coefficient
        self.walls = (spec.bush_coefficient, float(bush)), (spec.journal_coefficient, float(journal))
        self._last: np.ndarray | None = None
        self.band: Callable[[tuple[int, int], int], BandSolver] = functools.cache(BandSolver)

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Bring the viscosity field to a temperature field, K; the film shares no other factor than 1."""
        if temperature is not self._last:
            self._last = np.asarray(temperature)
            self.field.set(self.viscosity_ratio(self._last))
        return 1.0

    def _has_way_out(self, film: SolvedFilm) -> bool:
        flows = OilFlows(film, self.carry_over)
        stagnant = flows.exchanged <= NO_FLOW * float(np.abs(flows.x).max())
        return not (self.transfer == 0.0 and stagnant and self.heat(film).max() > 0.0)

    def heat(self, film: SolvedFilm) -> np.ndarray:
        """Heat at the vertices, W (n, m): shear, pressure flow and contact friction.

        Their sum is that of `heat_and_exchange` to the grid's error. The shear's sum is that of the loads: counted on
        control volumes it would be up to 5 % more on ten rows beside supply areas, where the film fraction changes
        within a row, and up to 6 % more where cold oil enters the ends, as the viscosity changes within one. Films
        without areas therefore have the difference at their ends.
        """
        p, s, R, w = film.parts, film.solver, film.grid.reference_length, film.journal
        flow_power = p.flow_scale * film.scales.pressure
        heat = self.sheared(film)
        heat += film_heat(self.dropped(film), s.system.flow_pressure, np.array((s.system.kx, s.system.kz)))
        heat *= flow_power
        rubbed = powers(film).contact_loss
        if film.pressing is not None and rubbed > 0.0:
            friction = np.zeros(film.grid.shape)
            for (coefficient, transition), P in zip(film.pressing.friction, film.pressing.P, strict=True):
                g_theta, g_z, _ = film.slip(transition)
                friction += coefficient * (g_theta * (R * w.omega) + g_z * w.axial_speed) * P * s.area
            # contacts that press on an edge: as much as the integrals of the loads say, which count it finely
            heat += friction * (rubbed / friction.sum())
        return heat

    def dropped(self, film: SolvedFilm) -> np.ndarray:
        """Return the energy per scaled flow at the vertices (n, m): pressure, or flow work of a compressible film."""
        oil = film.parts.compressible
        return film.oil.P if oil is None else oil.flow_work(film.oil.P)

    def sheared(self, film: SolvedFilm) -> np.ndarray:
        """Heat of sliding at the vertices, in the power of a unit of flow and pressure (n, m)."""
        R, w, s = film.grid.reference_length, film.journal, film.solver
        ratio = 1.0 if film.oil.ratio is None else film.oil.ratio
        speed2 = w.omega**2 + (w.axial_speed / R) ** 2
        flow_power = film.parts.flow_scale * film.scales.pressure
        shear = film.share() * ratio / s.H
        density = s.area * shear
        # the integrals of the loads count finely what changes beside an area, and beside an end that cold oil enters
        if film.parts.supply is not None:
            density *= film.parts.supply.land
            density *= np.sum(film.grid.shear_weight * shear) / np.sum(density)
        else:
            missed, lower = (film.grid.shear_weight - s.area) * shear, 0.5 - 0.5 * np.sign(film.grid.z)
            for end, side in ((0, lower), (-1, 1.0 - lower)):
                density[:, end] *= 1.0 + float(np.sum(missed @ side)) / max(float(density[:, end].sum()), 1e-300)
        if film.loads.recess is not None:
            density += film.loads.recess.density
        return film.scales.shear / flow_power * speed2 * R**2 * density
