"""Energy equations of a solved film with its flows: banded system, solution and terms of the heat balance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_ehd.film.arcs import rows_at_sides
from exudyn_ehd.film.banded.factors import factor_lu, number_cells
from exudyn_ehd.film.banded.substitution import solve_lu
from exudyn_ehd.film.banded.workspace import PAD, assemble
from exudyn_ehd.film.heat.energy import through_surfaces, transport_slopes
from exudyn_ehd.joint.heat.power import OilFlows, heat_of
from exudyn_ehd.joint.heat.temperature import OilTemperature, heating_before, temperature_of
from exudyn_ehd.joint.solved_film import SolvedFilm


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
        self.felt, self.heat = temperature_of(film), heat_of(film)
        part, self.begin = thermal.start(film)
        self.scale = thermal.flow_capacity * film.parts.flow_scale
        self.flows = OilFlows(film, thermal.carry_over)
        self.weight = self.flows.lost / (self.flows.total_lost or 1.0)
        content = self.flows.content
        if heating_before(film.history, film.step) is not None:
            # the gap at the end of the step, and its mean void: see `exudyn_ehd.film.heat.energy`
            content = np.maximum(content + 0.5 * step * self.flows.rate, 0.0)
        self.store = area * content / (part * step) if step > 0.0 else np.zeros(shape)
        self.held = self.store if step > 0.0 else np.full(shape, np.inf)
        self.follows = thermal.follows(self.felt, self.heat / self.scale, self.store)
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
        kept = self.store + STAGNANT * self.largest
        diagonal = kept + self.follows + flows.entering + flows.found + self.own[0, ..., 0]
        slopes, links = np.empty((5, self.store.size)), (flows.x, flows.z)
        transport_slopes(*links, diagonal, self.felt, self.links(), self.held, slopes)
        if flows.areas:
            stirred = self.stirred()
            slopes[:4:2] += stirred.reshape(2, -1)
            slopes[1:4:2] -= stirred.reshape(2, -1)
            links = links[0] + stirred[0], links[1] + stirred[1]  # also where nothing flows
        band = self.band
        assemble(*links, slopes, band.number, band.order, band.size, band.lower, band.upper)
        given = self.heat / self.scale + self.follows * (self.felt - self.supply)
        self.given = (given + kept * (self.begin[0] - self.supply))[None]

    def links(self) -> tuple[np.ndarray, np.ndarray]:
        """Inverse lengths of the links in theta and z for the limiter of `transport_slopes`; 0: of first order."""
        grid, rough = self.film.grid, self.thermal.upwind and not self.store.any()
        return np.zeros_like(grid.link_x) if rough else grid.link_x, grid.link_z

    def stirred(self) -> np.ndarray:
        """Exchange (2, n, m) over the links in theta and z that mixes supply areas, and rows at the sides of dams.

        Tilts across the film are mixed like means, a third as strongly, as they are stored.
        """
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
        flows, moved = self.flows, x[0] - self.begin[0]
        leaving, lost = (linear(takes, rise) for takes in self.takes)
        convected = float(np.sum(flows.leaving * leaving + flows.lost * lost))
        convected -= flows.back * self._mixed(rise) * flows.total_found
        stored = float(np.sum(self.store * moved + self.film.solver.area * flows.rate * rise[0]))
        return {
            "heat_in": float(np.sum(self.heat - self.scale * self.follows * (x[0] - self.felt))),
            "convected": self.scale * convected,
            "stored": self.scale * stored,
        }


def linear(coefficients: np.ndarray, fields: Sequence[np.ndarray | float]) -> np.ndarray:
    """Sum (..., n, m) of fields (n, m) times coefficients, whose last axis counts the fields."""
    return np.asarray(sum(coefficients[..., k] * field for k, field in enumerate(fields)))
