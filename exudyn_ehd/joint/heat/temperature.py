"""Temperature of a bearing's film: one for the whole film, or a field by the energy equation.

Heat balance of accepted steps, viscosity for the next step, and steady state.
"""

from __future__ import annotations

import abc
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from exudyn_ehd.film.heat.energy import ViscosityField
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal, Sump, Walls, known_supply
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.joint.heat.power import heat_and_exchange
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.status import SMALL

# Largest ratio of a step to the one before with which BDF2 is zero-stable, 1 + sqrt(2) (E. Hairer, S. P. Norsett, G.
# Wanner, Solving Ordinary Differential Equations I, 1993, section III.5). Longer steps are taken by backward Euler.
LARGEST_STEP_RATIO = 2.41
Field = float | np.ndarray


def temperature_of(film: SolvedFilm) -> np.ndarray:
    """Temperature of a film, K: one number, or a field (n, m)."""
    assert film.temperature is not None
    return np.asarray(film.temperature)


def viscosity_ratio(oil: Lubricant, temperature: Field) -> np.ndarray:
    """Viscosity of an oil at a temperature, K, over that at `Lubricant.temperature`."""
    if (law := oil.temperature_law) is None:
        return np.ones_like(np.asarray(temperature, dtype=float))
    return law.viscosity(temperature, oil.density) / float(law.viscosity(float(oil.temperature), oil.density))


def heating_before(history: History | None, step: float) -> np.ndarray | None:
    """`History.heating`, by which a step is integrated to second order; None for backward Euler."""
    known = history is not None and 0.0 < step <= LARGEST_STEP_RATIO * history.last_step
    return history.heating if history is not None and known else None


class OilTemperature(abc.ABC):
    """Temperature of the film, stored in the history of accepted steps.

    The film of a step h has the temperature T + h T' that is extrapolated from its start with the rate T' of the step
    before, so that force and tangent do not depend on the temperature at the end of the step. A fall is extrapolated as
    ``D (exp(h T' / D) - 1)``, with the rise D of T over the coldest temperature around: the film does not become colder
    than that. Where the rate has changed its sign in the step before, the film has the temperature T: so temperatures
    that swing from step to step are damped.

    From the heat of this film the temperature at the end of the step follows by backward differences of second order
    (BDF2): with the ratio r of h to the step before, and kappa = r / (1 + 2 r),

        dT/dt at the end = (T_end - (T + kappa h T')) / ((1 - kappa) h).

    First steps, and steps much longer than the one before, are taken by backward Euler (kappa = 0), at the viscosity of
    their start. Elsewhere kappa is reduced where T + kappa h T' would be below the coldest temperature, as behind a
    front of cold oil.
    """

    initial_leaving: np.ndarray | None = None
    # given temperatures around the film besides that of the supply, K
    around: tuple[float, ...] = ()
    # whether a steady temperature field is transported along theta with first order, as searches begin
    upwind = False

    @abc.abstractmethod
    def set_viscosity(self, temperature: Field) -> float:
        """Set the viscosity field to that of a temperature, K.

        Returns the factor on the reference viscosity that is the same in the whole film.
        """

    @abc.abstractmethod
    def advance(self, film: SolvedFilm) -> Field:
        """Temperature at the end of a solved film's step, K."""

    @abc.abstractmethod
    def balance(self, film: SolvedFilm, temperature: Any) -> dict[str, float]:
        """Terms of the heat balance, W, of a step or a steady state that ends at a temperature."""

    @abc.abstractmethod
    def steady_temperature(self, film: SolvedFilm) -> Field:
        """Temperature in balance with the heat of a solved film, K; not finite if there is none."""

    def __init__(self, spec: LumpedThermal | FilmEnergy, lubricant: Lubricant) -> None:
        self.lubricant = lubricant
        self.supply, supply = known_supply(spec), spec.supply_temperature
        self.sump = supply if isinstance(supply, Sump) else None
        self.initial_sump = None if self.sump is None else self.sump.initial_temperature or self.supply
        self.initial = self._or_supply(spec.initial_temperature)
        self.flow_capacity = lubricant.density * lubricant.specific_heat
        self.carry_over = spec.carry_over
        self._extrapolated: tuple[History | None, float, Field] = (None, 0.0, math.nan)

    def _or_supply(self, temperature: float | None) -> float:
        return self.supply if temperature is None else temperature

    def initial_temperature(self) -> Field:
        """Temperature at the start of a motion, K."""
        return self.initial

    def across(self, temperature: Field) -> np.ndarray:
        """Fields (k, ...) across the film that describe its temperature, K; the first one is the mean.

        Here there is one field, the temperature itself.
        """
        return np.array([temperature], dtype=float)

    def warmed(self, temperature: Field, change: np.ndarray) -> Field:
        """Temperature after a ``change`` of the fields of `across`, K."""
        return float(temperature + change[0])

    def state_of(self, history: History | None) -> Field:
        """Temperature in a history, K; the initial one if there is none."""
        known = None if history is None else history.temperature
        return self.initial_temperature() if known is None else known

    def extrapolated(self, history: History | None, step: float) -> Field:
        """Temperature of the film that ends a step, K, whose viscosity it has."""
        if history is None or (heating := heating_before(history, step)) is None:
            return self.state_of(history)
        known, size, T = self._extrapolated
        if known is not history or size != step:
            start, change = self.state_of(history), step * heating[1]
            # a film that is D above the coldest temperature and falls comes to D exp(change / D)
            room, fall = self.across(start)[0] - self.coldest(history), np.minimum(change[0], 0.0)
            kept = np.ones_like(fall)
            np.divide(room * np.expm1(fall / np.maximum(room, SMALL)), fall, out=kept, where=fall < 0.0)
            T = self.warmed(start, change * kept)
            self._extrapolated = history, step, T
        return T

    def coldest(self, history: History | None) -> float:
        """Temperature, K, below which the film cannot fall in a step: the least of film, walls and what flows in."""
        sumps = [] if history is None or history.sump is None else [history.sump]
        return min(self.supply, *sumps, *self.around, float(np.min(self.state_of(history))))

    def start(self, film: SolvedFilm) -> tuple[Field, np.ndarray]:
        """Return 1 - kappa of a film's step, and T + kappa h T' of the fields of `across`."""
        T = self.across(self.state_of(film.history))
        history, step = film.history, film.step
        if history is None or (heating := heating_before(history, step)) is None:
            return 1.0, T
        change, whole = step * heating[0], step / (history.last_step + 2.0 * step)
        kappa, room = np.full(T[0].shape, whole), T[0] - self.coldest(history)
        np.divide(room, -change[0], out=kappa, where=room < -whole * change[0])
        return 1.0 - kappa, T + kappa * change

    def heating(self, film: SolvedFilm, temperature: Field) -> np.ndarray:
        """`History.heating` at the end of a film's step that ends at ``temperature``."""
        change, history = self.across(temperature) - self.across(self.state_of(film.history)), film.history
        rate = change / film.step if film.step > 0.0 else np.zeros_like(change)
        before = 0.0 if history is None or history.heating is None else history.heating[0, 0]
        return np.array([rate, np.where(before * rate[0] > 0.0, rate, 0.0)])

    def outside(self, film: SolvedFilm) -> tuple[float, float]:
        """Return the temperature, K, to which the oil carries heat in the film's step, and the conductance, W/K.

        Without a sump they are the supply temperature and infinity. With a sump they combine two conductances in
        parallel: that of the sump to the supply temperature, and heat capacity / step to the sump's start-of-step
        temperature.
        """
        sump, known = self.sump, None if film.history is None else film.history.sump
        if sump is None or known is None or film.step <= 0.0:
            return self.supply, math.inf if sump is None else sump.conductance
        total = sump.conductance + sump.heat_capacity / film.step
        return known + sump.conductance / total * (self.supply - known), total

    def split(self, temperature: Field) -> tuple[Field, Walls | None]:
        """Split a history's temperature, K, into that of the film and those of walls and surfaces."""
        return temperature, None

    def leaving(self, film: SolvedFilm, temperature: Field) -> np.ndarray | None:
        """Temperature (2,) of the oil that leaves a film at both ends, K; None if the film has one temperature."""
        return None

    def first_memory(self) -> History:
        """Temperatures at the start of a motion: of the film, the sump, and the oil that leaves towards end faces."""
        T = self.initial_temperature()
        still = np.zeros((2, *self.across(T).shape))
        return History(temperature=T, heating=still, sump=self.initial_sump, leaving=self.initial_leaving)

    def memory(self, film: SolvedFilm) -> History:
        """Temperatures at the end of a solved film's step: those of `first_memory`."""
        T = self.advance(film)
        sump = None if self.sump is None else self.balance(film, T)["supply_temperature"]
        return History(
            temperature=T,
            heating=self.heating(film, T),
            last_step=film.step,
            sump=sump,
            leaving=None if film.beside is None else self.leaving(film, T),
        )

    def viscosity_ratio(self, temperature: Field) -> np.ndarray:
        """Viscosity of the oil at a temperature, K, over that at `Lubricant.temperature`."""
        return viscosity_ratio(self.lubricant, temperature)

    def follows(self, T: Field, heat: Field, store: Field) -> Field:
        """Return by how much the heat falls per kelvin in the linearised heat of a step.

        ``heat``, W, and ``store``, W/K, have the same scale. A step uses the viscosity and the heat of the extrapolated
        temperature T. Where the oil stores less per kelvin than the heat changes, the temperature would overshoot and
        swing back in the next step. There the heat is linearised about T, with the excess of its slope over the store.
        In steps much shorter than the time in which the oil is replaced, the excess is 0. In a steady state, with no
        store, the linearisation lets the iteration converge under strong heating.
        """
        thicker, thinner = (self.viscosity_ratio(T + d) for d in (-0.05, 0.05))
        return np.maximum(np.log(thicker / thinner) / 0.1 * heat - store, 0.0)


class LumpedTemperature(OilTemperature):
    """`LumpedThermal` of one bearing model.

    Parameters
    ----------
    spec : LumpedThermal
    lubricant : Lubricant
    volume : float
        Volume of the film, m3.
    heat_and_exchange : function
        Function of a film and a carry-over; returns the heat, W, and the scaled flow that is replaced by oil from
        outside.

    Attributes
    ----------
    field : ViscosityField or None
        Viscosity field, a (1, 1) array, for effects that read one.
    """

    def __init__(
        self,
        spec: LumpedThermal,
        lubricant: Lubricant,
        volume: float,
        heat_and_exchange: Callable[..., tuple[float, float]] = heat_and_exchange,
    ) -> None:
        super().__init__(spec, lubricant)
        self.spec, self.heat_and_exchange = spec, heat_and_exchange
        self.housing = self._or_supply(spec.housing_temperature)
        self.around = (self.housing,)
        self.capacity = self.flow_capacity * volume + spec.capacity
        self.field: ViscosityField | None = None

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Set the viscosity field, and return the factor on the reference viscosity at a temperature, K."""
        ratio = float(self.viscosity_ratio(float(temperature)))
        if self.field is not None:
            self.field.set(np.full((1, 1), ratio))
        return ratio

    def _rates(self, film: SolvedFilm) -> tuple[float, float]:
        """Heat, W, and conductance of the oil from the film to what is `outside`, W/K."""
        heat, exchanged = self.heat_and_exchange(film, self.carry_over)
        flow = self.flow_capacity * film.parts.flow_scale * exchanged / self.spec.effective_rise
        return heat, flow / (1.0 + flow / self.outside(film)[1])

    def advance(self, film: SolvedFilm) -> float:
        """Temperature at the end of a solved film's step."""
        return self._settled(film, self.capacity / film.step) if film.step > 0.0 else float(self.state_of(film.history))

    def steady_temperature(self, film: SolvedFilm) -> float:
        """Temperature in balance with the heat of a solved film; inf without a sink for the heat."""
        return self._settled(film, 0.0)

    def _settled(self, film: SolvedFilm, store: float) -> float:
        """Temperature at the end of a step; ``store``: heat capacity / step, W/K, 0 for the steady state."""
        T, (heat, flow), G = float(temperature_of(film)), self._rates(film), self.spec.housing_conductance
        if store + flow + G <= 0.0:
            return math.inf if heat > 0.0 else T
        part, (start,) = self.start(film)
        store = store / float(part)
        follows = float(self.follows(T, heat, store))
        rise = heat + flow * self.outside(film)[0] + G * self.housing + store * float(start) + follows * T
        return rise / (store + flow + G + follows)

    def balance(self, film: SolvedFilm, temperature: float) -> dict[str, float]:
        """Heat in, convected, conducted and stored, W, of a step or a steady state that ends at ``temperature``."""
        (heat, flow), (supply, conductance) = self._rates(film), self.outside(film)
        T, (part, (start,)) = float(temperature_of(film)), self.start(film)
        store = self.capacity / (float(part) * film.step) if film.step > 0.0 else 0.0
        stored = store * (temperature - float(start))
        return {
            "heat_in": heat - float(self.follows(T, heat, store)) * (temperature - T),
            "convected": flow * (temperature - supply),
            "conducted": self.spec.housing_conductance * (temperature - self.housing),
            "stored": stored,
            "supply_temperature": supply + flow * (temperature - supply) / conductance,
        }
