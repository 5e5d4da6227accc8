"""Energy equation of one solved film, from its flows: system, solution and balance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_ehd.film.banded.assemble import assemble
from exudyn_ehd.film.heat.energy import through_surfaces, transport_slopes
from exudyn_ehd.joint.heat.band import BandSolver
from exudyn_ehd.joint.heat.power import OilFlows, heat_of
from exudyn_ehd.joint.heat.temperature import OilTemperature, temperature_of
from exudyn_ehd.joint.solved_film import SolvedFilm

# Keeps the temperature of a control volume defined that no oil enters, at this share of the largest flow.
STAGNANT = 1e-14
# Exchange over every link within a supply area, in the film's largest flow. Smaller: areas are mixed less well, their
# temperatures differ by up to a share n_theta / MIXED of their rise. Larger: more round-off, 1e-16 MIXED of that rise.
MIXED = 1e4


# k / h, W/(m2 K), None without a conductivity; m2 of the vertices; coefficients of both sides, W/(m2 K), of walls None.
PassageData = tuple[np.ndarray | None, np.ndarray, tuple[float | None, float | None]]


class HeatBalance:
    """Energy equations of a film between surfaces that have temperatures outside, K.

    Over a step, or in the steady state with a step of 0. The unknowns are k fields (k, n, m), K: here the mean
    temperature alone. ``at`` lists the temperatures of both sides as (n, 1) or (1, 1) arrays. Coefficients of all of
    them have a last axis of k + 2.

    Attributes
    ----------
    scale : float
        W/K per scaled flow, the unit of the equations.
    through : (2, n, m, k + 2) array
        Heat into both sides, W.
    own : (k, n, m, k + 2) array
        Scaled heat that leaves the vertices, without that over the links.
    given, brings : (k, n, m) arrays
        Scaled heat besides it, and what oil of unit temperature adds that a cavitation model finds.
    ends : (2, 2, k, n, m, k + 2) array, or empty
        Scaled heat over the links in theta and z by their own and the next vertex, where it depends on what is outside.
    takes : two arrays
        Temperature of the oil that leaves, and of that which a cavitation model loses.
    """

    def __init__(
        self, thermal: OilTemperature, film: SolvedFilm, step: float, passage: PassageData, band: BandSolver
    ) -> None:
        area, shape = film.solver.area, film.grid.shape
        self.film, self.step, self.supply, self.thermal, self.band = film, step, thermal.supply, thermal, band
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
        """Exchange (2, n, m) over the links in theta and z that mixes the supply areas."""
        links = np.zeros((2, *self.store.shape))
        for area in self.flows.areas:
            links[0] += area & np.roll(area, -1, axis=0)
            links[1, :, :-1] += area[:, :-1] & area[:, 1:]
        return MIXED * self.flows.largest * links

    def between(self, at: list[np.ndarray]) -> np.ndarray:
        """Unknowns with temperatures ``at`` outside."""
        x = self._answer(self.given, [a - self.supply for a in at])
        x[0] += self.supply
        return x

    def change(self, at: list[np.ndarray]) -> np.ndarray:
        """Change of `between` by a change outside."""
        return self._answer(np.zeros_like(self.given), at)

    def _answer(self, given: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Unknowns with rises ``at`` outside."""
        rest = given - linear(self.own[..., -2:], at)
        for axis, (own, other) in enumerate(self.ends):
            flow = linear(own[..., -2:], at) + linear(other[..., -2:], [np.roll(a, -1, axis) for a in at])
            rest -= flow - np.roll(flow, 1, axis + 1)
        x = self.band.solve(rest)
        if self.flows.back > 0.0:
            x = x + self._mixed([*x, *at]) / (1.0 - self._mixed([*self.returning, 0.0, 0.0])) * self.returning
        return x

    def _mixed(self, fields: Sequence[np.ndarray | float]) -> float:
        """Temperature of all oil that is lost, mixed."""
        return float(np.sum(self.weight * linear(self.takes[1], fields)))

    def passed(self, x: np.ndarray, at: list[np.ndarray]) -> list[np.ndarray]:
        """Heat into both sides (n, m), W."""
        return list(linear(self.through, [*x, *at]))

    def state(self, x: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Blocks (n, ...) of the film in a state."""
        return x[0]

    def totals(self, x: np.ndarray, at: list[np.ndarray]) -> dict[str, float]:
        """Heat in, convected and stored, W, with these unknowns at the end."""
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
    """Values (..., n, m) of what is linear in fields (n, m), one for each of the coefficients' last axis."""
    return np.asarray(sum(coefficients[..., k] * field for k, field in enumerate(fields)))
