"""Energy equation of one solved film, from its flows: system, solution and balance."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.banded.assemble import assemble
from exudyn_ehd.film.heat.energy import passage, transport_slopes
from exudyn_ehd.joint.heat.power import OilFlows
from exudyn_ehd.joint.heat.temperature import HeatedFilm, temperature_of
from exudyn_ehd.joint.solved_film import SolvedFilm

# Keeps the temperature of a control volume defined that no oil enters, at this share of the largest flow.
STAGNANT = 1e-14
# Exchange over every link within a supply area, in the film's largest flow. Smaller: areas are mixed less well, their
# temperatures differ by up to a share n_theta / MIXED of their rise. Larger: more round-off, 1e-16 MIXED of that rise.
MIXED = 1e4


# k / h, W/(m2 K), None without a conductivity; m2 of the vertices; coefficients of both sides, W/(m2 K), of walls None.
PassageData = tuple[np.ndarray | None, np.ndarray, tuple[float | None, float | None]]


class HeatBalance:
    """Energy equation of a film's mean temperature between surfaces that have temperatures outside, K.

    Over a step, or in the steady state with a step of 0. ``at`` lists the temperatures of both sides as (n, 1) or (1,
    1) arrays. Unknowns are temperatures (n, m), K.

    Attributes
    ----------
    scale : float
        W/K per scaled flow, the unit of the equations.
    through : (2, f, n, m) array
        Heat into both sides, W, per kelvin of a vertex's unknowns and, last, of the temperatures outside.
    by : (2, 2, n, m) array
        Heat that each of the temperatures outside gives to both sides, at held unknowns, W/K.
    """

    def __init__(self, thermal: HeatedFilm, film: SolvedFilm, step: float, between: PassageData) -> None:
        area, shape, heat = film.solver.area, film.grid.shape, thermal.heat(film)
        self.film, self.step, self.supply, self.thermal = film, step, thermal.supply, thermal
        self.old = temperature_of(film)
        self.scale = thermal.flow_capacity * film.parts.flow_scale
        self.heat, self.flows = heat, OilFlows(film, thermal.carry_over)
        self.weight = self.flows.lost / (self.flows.total_lost or 1.0)
        self.store = area * self.flows.content / step if step > 0.0 else np.zeros(shape)
        self.follows = thermal.follows(self.old, heat / self.scale, self.store)
        self._pass(*between)
        self.by = -self.through[:, -2:]

    def _pass(self, kappa: np.ndarray | None, area: np.ndarray, outward: tuple[float | None, float | None]) -> None:
        self.through = passage(kappa, area, outward)

    def largest(self) -> float:
        """Largest of the flows and of the storage."""
        return max(self.flows.largest, float(self.store.max()))

    def stirred(self) -> np.ndarray:
        """Exchange (2, n, m) over the links in theta and z that mixes the supply areas."""
        links = np.zeros((2, *self.store.shape))
        for area in self.flows.areas:
            links[0] += area & np.roll(area, -1, axis=0)
            links[1, :, :-1] += area[:, :-1] & area[:, 1:]
        return MIXED * self.flows.largest * links

    def solve(self) -> None:
        """Factor the system, which `between` and `change` use."""
        flows, store, walls = self.flows, self.store, self.through[:, 0].sum(axis=0) / self.scale
        rigid = STAGNANT * self.largest()
        diagonal = self.follows + store + flows.entering + flows.found + walls + rigid
        held = store if self.step > 0.0 else np.full(store.shape, np.inf)
        slopes, links = np.empty((5, store.size)), (flows.x, flows.z)
        transport_slopes(*links, diagonal, self.old, self.film.grid.link_z, held, slopes)
        if flows.areas:
            stirred = self.stirred()
            slopes[:4:2] += stirred.reshape(2, -1)
            slopes[1:4:2] -= stirred.reshape(2, -1)
            links = links[0] + stirred[0], links[1] + stirred[1]  # also where nothing flows
        self.band = band = self.thermal.band(store.shape, 1)
        assemble(*links, slopes, band.number, band.order, band.size, band.lower, band.upper)
        band.factor()
        self.given = self.heat / self.scale + (store + rigid + self.follows) * (self.old - self.supply)

    def between(self, at: list[np.ndarray]) -> np.ndarray:
        """Unknowns with temperatures ``at`` outside."""
        gain = self._gain([a - self.supply for a in at])
        T0, self.returning = self.band.solve(np.array([self.given + gain, self.flows.back * self.flows.found]))
        mixed = 0.0
        if self.flows.back > 0.0:
            mixed = float(np.sum(self.weight * T0)) / (1.0 - float(np.sum(self.weight * self.returning)))
        return self.supply + T0 + mixed * self.returning

    def change(self, at: list[np.ndarray]) -> np.ndarray:
        """Change of `between`, which has been asked for, by a change outside."""
        change = self.band.solve(self._gain(at)[None])[0]
        if self.flows.back > 0.0:
            mixed = float(np.sum(self.weight * change)) / (1.0 - float(np.sum(self.weight * self.returning)))
            change += mixed * self.returning
        return change

    def _gain(self, at: list[np.ndarray]) -> np.ndarray:
        """Scaled heat (n, m) from temperatures ``at`` outside into a film of temperature 0."""
        by = self.by.sum(axis=0)
        return (by[0] * at[0] + by[1] * at[1]) / self.scale

    def passed(self, x: np.ndarray, at: list[np.ndarray]) -> list[np.ndarray]:
        """Heat into both sides (n, m), W."""
        outside = self.by[:, 0] * at[0] + self.by[:, 1] * at[1]
        return list(self.through[:, 0] * x - outside)

    def state(self, x: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Blocks of the film in a state."""
        return x

    def totals(self, T: np.ndarray, at: list[np.ndarray]) -> dict[str, float]:
        """Heat in, convected and stored, W, with these temperatures at the end."""
        rise, area, flows = T - self.supply, self.film.solver.area, self.flows
        mixed = float(np.sum(self.weight * rise))
        stored = float(np.sum(self.store * (T - self.old))) if self.step > 0.0 else 0.0
        convected = float(np.sum((flows.leaving + flows.lost) * rise)) - flows.back * mixed * flows.total_found
        return {
            "heat_in": float(np.sum(self.heat - self.scale * self.follows * (T - self.old))),
            "convected": self.scale * convected,
            "stored": self.scale * (stored + float(np.sum(area * flows.rate * rise))),
        }
