"""Energy equation of one solved film, from its flows: system, solution and balance."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from exudyn_ehd.film.banded.assemble import assemble
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu
from exudyn_ehd.film.banded.workspace import PAD
from exudyn_ehd.film.heat.energy import transport_slopes
from exudyn_ehd.joint.heat.power import OilFlows
from exudyn_ehd.joint.solved_film import SolvedFilm

# Keeps the temperature of a control volume defined that no oil enters, at this share of the largest flow.
STAGNANT = 1e-14
# Exchange over every link within a supply area, in the film's largest flow. Smaller: areas are mixed less well, their
# temperatures differ by up to a share n_theta / MIXED of their rise. Larger: more round-off, 1e-16 MIXED of that rise.
MIXED = 1e4


class BandSolver:
    """Systems of ``unknowns`` at every vertex of a film grid (n, m); its buffers stay."""

    def __init__(self, shape: tuple[int, int], unknowns: int) -> None:
        n, m = shape
        self.number, self.order = np.zeros(shape, dtype=np.int64), np.zeros(n * m, dtype=np.int64)
        _, width = number_cells(np.ones(shape, dtype=np.bool_), np.ones(shape), self.order, self.number)
        self.unknowns, self.size, self.width = unknowns, unknowns * n * m, unknowns * (width + 1) - 1
        self.lower, self.upper = np.zeros((2, self.size, self.width + 1 + PAD))
        self.inverse = np.zeros(self.size)

    def factor(self) -> None:
        """Factor what ``lower`` and ``upper`` hold."""
        self.regular = factor_lu(self.lower, self.upper, self.size, self.width, self.inverse)

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Fields of each right-hand side's unknowns in turn (k, n, m), as ``rhs``; inf for a singular system."""
        if not self.regular:
            return np.full(rhs.shape, np.inf)
        sides = rhs.reshape(-1, self.unknowns, self.order.size)
        x = np.ascontiguousarray(sides[:, :, self.order].swapaxes(1, 2)).reshape(len(sides), -1)
        solve_lu(self.lower, self.upper, self.inverse, self.size, self.width, x)
        out = np.empty_like(sides)
        out[:, :, self.order] = x.reshape(len(sides), -1, self.unknowns).swapaxes(1, 2)
        return out.reshape(rhs.shape)


class HeatedOil(Protocol):
    """Part of `exudyn_ehd.joint.heat.walls.FilmTemperature` that the heat balance uses."""

    supply: float
    flow_capacity: float
    carry_over: float
    band: Callable[[tuple[int, int], int], BandSolver]

    def follows(self, T: np.ndarray, heat: np.ndarray, store: np.ndarray) -> float | np.ndarray:
        """Return the decrease of the heat per kelvin within a step."""


def temperature_of(film: SolvedFilm) -> np.ndarray:
    """Temperature of a film, K: one for all of it, or a field (n, m)."""
    assert film.temperature is not None
    return np.asarray(film.temperature)


class HeatBalance:
    """Heat balance of a solved film over a step, or in the steady state with a step of 0; fields (n, m).

    Attributes
    ----------
    scale : float
        W/K per scaled flow, in which heat transfer to the walls is given.
    """

    def __init__(self, thermal: HeatedOil, film: SolvedFilm, step: float, heat: np.ndarray) -> None:
        area, shape = film.solver.area, film.grid.shape
        self.film, self.step, self.supply, self.thermal = film, step, thermal.supply, thermal
        self.old = temperature_of(film)
        self.scale = thermal.flow_capacity * film.parts.flow_scale
        self.heat, self.flows = heat, OilFlows(film, thermal.carry_over)
        self.weight = self.flows.lost / (self.flows.total_lost or 1.0)
        self.store = area * self.flows.content / step if step > 0.0 else np.zeros(shape)
        self.follows = thermal.follows(self.old, heat / self.scale, self.store)

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

    def factor(self, walls: np.ndarray) -> None:
        """Factor the system with heat transfer ``walls`` to the surfaces, in units of ``scale``."""
        flows, store = self.flows, self.store
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

    def temperatures(self, gain: np.ndarray) -> np.ndarray:
        """Temperatures where the surfaces give ``gain``, in K times ``scale``, to a film at the supply temperature."""
        T0, self.returning = self.band.solve(np.array([self.given + gain, self.flows.back * self.flows.found]))
        mixed = 0.0
        if self.flows.back > 0.0:
            mixed = float(np.sum(self.weight * T0)) / (1.0 - float(np.sum(self.weight * self.returning)))
        return self.supply + T0 + mixed * self.returning

    def response(self, gain: np.ndarray) -> np.ndarray:
        """Change of `temperatures`, which have been asked for, by a change of ``gain``."""
        change = self.band.solve(gain[None])[0]
        if self.flows.back > 0.0:
            mixed = float(np.sum(self.weight * change)) / (1.0 - float(np.sum(self.weight * self.returning)))
            change += mixed * self.returning
        return change

    def sums(self, T: np.ndarray) -> dict[str, float]:
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
