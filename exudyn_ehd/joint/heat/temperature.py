"""Temperature of a bearing's film: one for the whole film, or a field by the energy equation.

Heat balance of accepted steps, viscosity for the next step, and steady state. `HeatBalance` is the energy equation of a
solved film with its flows: banded system, solution and balance.
"""

from __future__ import annotations

import abc
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from exudyn_ehd.film.arcs import rows_at_sides
from exudyn_ehd.film.banded.factors import factor_lu, number_cells
from exudyn_ehd.film.banded.substitution import solve_lu
from exudyn_ehd.film.banded.workspace import PAD, assemble
from exudyn_ehd.film.heat.energy import ViscosityField, through_surfaces, transport_slopes
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal, Sump, Walls, known_supply
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.joint.heat.power import OilFlows, heat_and_exchange, heat_of
from exudyn_ehd.joint.solved_film import History, SolvedFilm


class BandSolver:
    """Banded linear systems with ``unknowns`` at every vertex of a film grid (n, m); the buffers are reused."""

    def __init__(self, shape: tuple[int, int], unknowns: int) -> None:
        n, m = shape
        self.number, self.order = np.zeros(shape, dtype=np.int64), np.zeros(n * m, dtype=np.int64)
        _, width = number_cells(np.ones(shape, dtype=np.bool_), np.ones(shape), self.order, self.number)
        self.unknowns, self.size, self.width = unknowns, unknowns * n * m, unknowns * (width + 1) - 1
        self.lower, self.upper = np.zeros((2, self.size, self.width + 1 + PAD))
        self.inverse = np.zeros(self.size)

    def factor(self) -> None:
        """Factor the matrix in ``lower`` and ``upper``."""
        self.regular = factor_lu(self.lower, self.upper, self.size, self.width, self.inverse)

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Return the solutions (k, n, m) for right-hand sides of the same shape; inf for a singular system.

        k counts the unknowns of the first right-hand side, then those of the second, and so on.
        """
        if not self.regular:
            return np.full(rhs.shape, np.inf)
        sides = rhs.reshape(-1, self.unknowns, self.order.size)
        x = np.ascontiguousarray(sides[:, :, self.order].swapaxes(1, 2)).reshape(len(sides), -1)
        solve_lu(self.lower, self.upper, self.inverse, self.size, self.width, x)
        out = np.empty_like(sides)
        out[:, :, self.order] = x.reshape(len(sides), -1, self.unknowns).swapaxes(1, 2)
        return out.reshape(rhs.shape)


# Largest temperature coefficient of the viscosity of any oil, 1/K. If the heat times this is below what the oil stores
# per kelvin, the heat is not linearised. Larger: the coefficient is computed more often.
STEEPEST = 0.2
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


class OilTemperature(abc.ABC):
    """Temperature of the film: stored in the history of accepted steps, it sets the viscosity of the next step.

    The film of a step has the start-of-step temperature, so that force and tangent do not depend on the temperature at
    its end.
    """

    initial_leaving: np.ndarray | None = None

    @abc.abstractmethod
    def initial_temperature(self, shape: tuple[int, int]) -> Field:
        """Temperature at the start of a motion, K, on a grid of this shape."""

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

    def _or_supply(self, temperature: float | None) -> float:
        return self.supply if temperature is None else temperature

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

    def first_memory(self, shape: tuple[int, int]) -> History:
        """Temperatures at the start of a motion: of the film, the sump, and the oil that leaves towards end faces."""
        T = self.initial_temperature(shape)
        return History(temperature=T, sump=self.initial_sump, leaving=self.initial_leaving)

    def memory(self, film: SolvedFilm) -> History:
        """Temperatures at the end of a solved film's step: those of `first_memory`."""
        T = self.advance(film)
        sump = None if self.sump is None else self.balance(film, T)["supply_temperature"]
        return History(temperature=T, sump=sump, leaving=None if film.beside is None else self.leaving(film, T))

    def viscosity_ratio(self, temperature: Field) -> np.ndarray:
        """Viscosity of the oil at a temperature, K, over that at `Lubricant.temperature`."""
        return viscosity_ratio(self.lubricant, temperature)

    def follows(self, T: Field, heat: Field, store: Field) -> Field:
        """Return by how much the heat falls per kelvin in the linearised heat of a step.

        ``heat``, W, and ``store``, W/K, have the same scale. A step uses the viscosity and the heat at its start. Where
        the oil stores less per kelvin than the heat changes, the temperature would overshoot and swing back in the next
        step. There the heat is linearised, with the excess of its slope over the store. In steps much shorter than the
        time in which the oil is replaced, the excess is 0. In a steady state, with no store, the linearisation lets the
        iteration converge under strong heating.
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
        self.capacity = self.flow_capacity * volume + spec.capacity
        self._last = math.nan, 1.0
        self.field: ViscosityField | None = None

    def initial_temperature(self, shape: tuple[int, int]) -> float:
        """Temperature at the start of a motion, K."""
        return self.initial

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Set the viscosity field, and return the factor on the reference viscosity at a temperature, K."""
        if self._last[0] != temperature:
            ratio = float(self.viscosity_ratio(float(temperature)))
            self._last = float(temperature), ratio
            if self.field is not None:
                self.field.set(np.full((1, 1), ratio))
        return self._last[1]

    def _rates(self, film: SolvedFilm) -> tuple[float, float]:
        """Heat, W, and conductance of the oil from the film to what is `outside`, W/K."""
        heat, exchanged = self.heat_and_exchange(film, self.carry_over)
        flow = self.flow_capacity * film.parts.flow_scale * exchanged / self.spec.effective_rise
        return heat, flow / (1.0 + flow / self.outside(film)[1])

    def advance(self, film: SolvedFilm) -> float:
        """Temperature at the end of a solved film's step."""
        return self._settled(film, self.capacity / film.step) if film.step > 0.0 else float(temperature_of(film))

    def steady_temperature(self, film: SolvedFilm) -> float:
        """Temperature in balance with the heat of a solved film; inf without a sink for the heat."""
        return self._settled(film, 0.0)

    def _settled(self, film: SolvedFilm, store: float) -> float:
        """Temperature at the end of a step; ``store``: heat capacity / step, W/K, 0 for the steady state."""
        T, (heat, flow), G = float(temperature_of(film)), self._rates(film), self.spec.housing_conductance
        if store + flow + G <= 0.0:
            return math.inf if heat > 0.0 else T
        follows = float(self.follows(T, heat, store))
        rise = heat + flow * self.outside(film)[0] + G * self.housing + (store + follows) * T
        return rise / (store + flow + G + follows)

    def balance(self, film: SolvedFilm, temperature: float) -> dict[str, float]:
        """Heat in, convected, conducted and stored, W, of a step or a steady state that ends at ``temperature``."""
        (heat, flow), (supply, conductance) = self._rates(film), self.outside(film)
        T, store = float(temperature_of(film)), self.capacity / film.step if film.step > 0.0 else 0.0
        stored = store * (temperature - T)
        return {
            "heat_in": heat - float(self.follows(T, heat, store)) * (temperature - T),
            "convected": flow * (temperature - supply),
            "conducted": self.spec.housing_conductance * (temperature - self.housing),
            "stored": stored,
            "supply_temperature": supply + flow * (temperature - supply) / conductance,
        }


# Flow into every control volume, as a share of the largest flow, that keeps its old temperature. It makes the
# temperature of a volume that no oil enters defined. Larger: all temperatures lag more.
STAGNANT = 1e-14
# Exchange flow over every link within a supply area, over the film's largest flow. Smaller: areas mix less well, their
# temperatures differ by up to n_theta / MIXED of their rise. Larger: more round-off, 1e-16 MIXED of the rise.
MIXED = 1e4
# Exchange flow between the two rows at the side of a dam, over that in supply areas. Far smaller: the limiter of the
# flows along z uses the slope between these rows, which is round-off, and steady temperatures do not converge.
JOINED = 1e-2


# Conductivity over film thickness, W/(m2 K), None without a conductivity; area of the vertices, m2; coefficients of
# both sides, W/(m2 K), None for a wall that conducts.
PassageData = tuple[np.ndarray | None, np.ndarray, tuple[float | None, float | None]]


class HeatBalance:
    """Energy equations of a film between two sides, bush and journal, with given temperatures, K.

    They hold over a step, or with a step of 0 in the steady state. The unknowns are k fields (k, n, m), K: here the
    mean temperature alone. ``at`` lists the temperatures of both sides as (n, 1) or (1, 1) arrays. Arrays of
    coefficients have a last axis of k + 2: for the k fields and for both sides.

    Attributes
    ----------
    scale : float
        W/K per scaled flow, the unit of the equations.
    through : (2, n, m, k + 2) array
        Coefficients of the heat into both sides, W.
    own : (k, n, m, k + 2) array
        Coefficients of the scaled heat that leaves the vertices, without the heat over the links.
    given, brings : (k, n, m) arrays
        Scaled right-hand side, and heat of the oil found by a cavitation model per unit of its temperature.
    ends : (2, 2, k, n, m, k + 2) array, or empty
        Coefficients of the scaled heat over the links in theta and z, by the values at their first and second vertex;
        empty if this heat does not depend on the sides' temperatures.
    takes : two arrays
        Coefficients of the temperature of the oil that leaves, and of the oil that a cavitation model loses.
    """

    def __init__(
        self,
        thermal: OilTemperature,
        film: SolvedFilm,
        step: float,
        passage: PassageData,
        band: BandSolver,
        supply: float,
    ) -> None:
        area, shape = film.solver.area, film.grid.shape
        self.film, self.step, self.supply, self.thermal, self.band = film, step, supply, thermal, band
        self.old, self.heat = temperature_of(film), heat_of(film)
        self.scale = thermal.flow_capacity * film.parts.flow_scale
        self.flows = OilFlows(film, thermal.carry_over)
        self.weight = self.flows.lost / (self.flows.total_lost or 1.0)
        self.store = area * self.flows.content / step if step > 0.0 else np.zeros(shape)
        self.held = self.store if step > 0.0 else np.full(shape, np.inf)
        self.follows = thermal.follows(self.old, self.heat / self.scale, self.store)
        self.largest = max(self.flows.largest, float(self.store.max()))
        self._assemble(*passage)
        band.factor()
        if self.flows.back > 0.0:
            self.returning = self.band.solve(self.flows.back * self.brings)

    def _assemble(self, kappa: np.ndarray | None, area: np.ndarray, outward: tuple[float | None, float | None]) -> None:
        """Set the arrays of the equations, and fill their band."""
        flows, self.brings = self.flows, self.flows.found[None]
        self.ends: Sequence[np.ndarray] | np.ndarray = ()
        self.takes = (np.array([1.0, 0.0, 0.0]),) * 2
        self.through = through_surfaces(kappa, area, outward)
        self.own = self.through.sum(axis=0)[None] / self.scale
        kept = self.store + STAGNANT * self.largest + self.follows
        diagonal = kept + flows.entering + flows.found + self.own[0, ..., 0]
        slopes, links = np.empty((5, self.store.size)), (flows.x, flows.z)
        transport_slopes(*links, diagonal, self.old, self.film.grid.link_z, self.held, slopes)
        if flows.areas:
            stirred = self.stirred()
            slopes[:4:2] += stirred.reshape(2, -1)
            slopes[1:4:2] -= stirred.reshape(2, -1)
            links = links[0] + stirred[0], links[1] + stirred[1]  # also where nothing flows
        band = self.band
        assemble(*links, slopes, band.number, band.order, band.size, band.lower, band.upper)
        self.given = (self.heat / self.scale + kept * (self.old - self.supply))[None]

    def stirred(self) -> np.ndarray:
        """Exchange (2, n, m) over the links in theta and z that mixes supply areas, and rows at the sides of dams."""
        links = np.zeros((2, *self.store.shape))
        for area in self.flows.areas:
            links[0] += area & np.roll(area, -1, axis=0)
            links[1, :, :-1] += area[:, :-1] & area[:, 1:]
        if any(arc.dam for arc in self.film.parts.bearing.bore_arcs):
            links[1, :, :-1] += JOINED * rows_at_sides(self.film.grid)
        return MIXED * self.flows.largest * links

    def between(self, at: list[np.ndarray]) -> np.ndarray:
        """Solve for the unknowns with temperatures ``at`` of the sides."""
        x = self._answer(self.given, [a - self.supply for a in at])
        x[0] += self.supply
        return x

    def change(self, at: list[np.ndarray]) -> np.ndarray:
        """Change of `between` by a change ``at`` of the sides' temperatures."""
        return self._answer(np.zeros_like(self.given), at)

    def _answer(self, given: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Unknowns, above the supply temperature, with rises ``at`` of the sides."""
        rest = given - linear(self.own[..., -2:], at)
        for axis, (own, other) in enumerate(self.ends):
            flow = linear(own[..., -2:], at) + linear(other[..., -2:], [np.roll(a, -1, axis) for a in at])
            rest -= flow - np.roll(flow, 1, axis + 1)
        x = self.band.solve(rest)
        if self.flows.back > 0.0:
            x = x + self._mixed([*x, *at]) / (1.0 - self._mixed([*self.returning, 0.0, 0.0])) * self.returning
        return x

    def _mixed(self, fields: Sequence[np.ndarray | float]) -> float:
        """Mixed temperature of all oil that a cavitation model loses."""
        return float(np.sum(self.weight * linear(self.takes[1], fields)))

    def passed(self, x: np.ndarray, at: list[np.ndarray]) -> list[np.ndarray]:
        """Heat into both sides (n, m), W."""
        return list(linear(self.through, [*x, *at]))

    def state(self, x: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Columns (n, ...) of the film in a state."""
        return x[0]

    def totals(self, x: np.ndarray, at: list[np.ndarray]) -> dict[str, float]:
        """Heat in, convected and stored, W, of a step that ends with the unknowns x."""
        levels = (self.supply, *[0.0] * (len(x) - 1), self.supply, self.supply)
        rise = [field - level for field, level in zip([*x, *at], levels, strict=True)]
        flows, moved = self.flows, x[0] - self.old
        leaving, lost = (linear(takes, rise) for takes in self.takes)
        convected = float(np.sum(flows.leaving * leaving + flows.lost * lost))
        convected -= flows.back * self._mixed(rise) * flows.total_found
        stored = float(np.sum(self.store * moved + self.film.solver.area * flows.rate * rise[0]))
        return {
            "heat_in": float(np.sum(self.heat - self.scale * self.follows * moved)),
            "convected": self.scale * convected,
            "stored": self.scale * stored,
        }


def linear(coefficients: np.ndarray, fields: Sequence[np.ndarray | float]) -> np.ndarray:
    """Sum (..., n, m) of fields (n, m) times coefficients, whose last axis counts the fields."""
    return np.asarray(sum(coefficients[..., k] * field for k, field in enumerate(fields)))
