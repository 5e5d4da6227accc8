"""Temperature field of a film, with temperatures and growth of a conducting bush and journal (walls).

A state (n, m + k) has the film's temperatures in its first m columns. Then follow those of the bush's rings, from the
bore outward, and of the journal's rings, from its surface inward; the journal's are the same in every row. Unit: K.

Film, bush and journal of a step are one linear system. The walls are condensed onto their surfaces: their heat flow is
a linear function of the surface temperatures, `exudyn_ehd.film.heat.options`. The film's heat flow into the surfaces
follows from its banded system, which is factored once, and from `exudyn_ehd.film.heat.energy`.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.energy import ViscosityField
from exudyn_ehd.film.heat.options import Conduction, FilmEnergy, Rings, Walls
from exudyn_ehd.joint.heat.equations import BandSolver, HeatBalance, PassageData
from exudyn_ehd.joint.heat.power import OilFlows, heat_of
from exudyn_ehd.joint.heat.temperature import Field, OilTemperature
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.solid.total_lagrange import solve_by_products
from exudyn_ehd.status import ROUNDING

# Tolerance of the heat flow between film and walls, relative. Larger: fewer iterations of GMRES.
AGREED = 1e-13


class _Wall:
    """One wall with its place among the columns of a state."""

    def __init__(self, wall: Conduction, rings: Rings, columns: slice, supply: float, bearing: JournalBearing) -> None:
        self.rings, self.columns = rings, columns
        ambient, initial, clearance = (
            supply if T is None else T
            for T in (wall.ambient_temperature, wall.initial_temperature, wall.clearance_temperature)
        )
        self.ambient, self.initial, self.at_clearance = ambient, initial, clearance
        self.expands = wall.expansion * bearing.journal_radius

    def of(self, state: np.ndarray) -> np.ndarray:
        """Temperatures (columns, k) in a state."""
        return state[: self.rings.columns, self.columns]

    def growth(self, state: np.ndarray) -> float:
        """Growth of the radius at the film, m."""
        return self.expands * (float(np.mean(self.of(state) @ self.rings.share)) - self.at_clearance)

    def heat(self, state: np.ndarray, old: np.ndarray) -> tuple[float, float]:
        """Heat given off to the ambient, and stored heat, W, of a step from ``old`` to ``state``."""
        T = self.of(state)
        stored = float(np.sum(self.rings.store * (T - self.of(old))))
        return float(np.sum(self.rings.loss * (T - self.ambient))), stored


class FilmTemperature(OilTemperature):
    """`FilmEnergy` of one bearing model, between surfaces of given temperatures or walls that conduct.

    Parameters
    ----------
    spec : FilmEnergy
    bearing : JournalBearing
    field : ViscosityField
        Viscosity field that the film reads.
    shape : (int, int)
        Shape of the film's grid.
    """

    # number of film blocks in a state, and of unknowns at each vertex
    blocks, fields = 1, 1

    def __init__(self, spec: FilmEnergy, bearing: JournalBearing, field: ViscosityField, shape: tuple[int, int]):
        super().__init__(spec, bearing.lubricant)
        self.spec, self.field, self.shape, self.clearance = spec, field, shape, bearing.radial_clearance
        bush, journal = self._or_supply(spec.bush_temperature), self._or_supply(spec.journal_temperature)
        self.walls = (spec.bush_coefficient, float(bush)), (spec.journal_coefficient, float(journal))
        self.around = tuple(T for coefficient, T in self.walls if coefficient > 0.0)
        self.transfer = spec.bush_coefficient + spec.journal_coefficient
        R, L = bearing.journal_radius, bearing.length
        self.sides: list[_Wall | None] = [None, None]
        end = self.blocks * shape[1]
        for side, wall in enumerate((spec.bush, spec.journal)):
            if wall is not None:
                rings = Rings(wall, R, L, shape[0] if side == 0 else 1, inward=side == 1)
                columns = slice(end, end + rings.radii.size)
                self.sides[side], end = _Wall(wall, rings, columns, self.supply, bearing), columns.stop
                self.transfer += wall.conductance  # above 0, the wall is a sink for the heat
        self.conducting = [wall for wall in self.sides if wall is not None]
        self.size, self.unknowns = end, sum(wall.rings.columns for wall in self.conducting)
        if bearing.thrust is not None:
            self.initial_leaving = np.full(2, float(self.initial))
        self.grows = any(wall.expands > 0.0 for wall in self.conducting)
        self.band = BandSolver(shape, self.fields)
        self._last: np.ndarray | None = None
        self._last_split: np.ndarray | None = None

    def initial_temperature(self) -> np.ndarray:
        """State (n, m + k) at the start of a motion, K."""
        start = np.full((self.shape[0], self.size), float(self.initial))
        for wall in self.conducting:
            start[:, wall.columns] = wall.initial
        return start

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Set the viscosity field to that of a state, K; return 1, the factor on the reference viscosity."""
        if temperature is not self._last:
            self._last = np.asarray(temperature)
            self.field.set(self.viscosity_ratio(self.heights(self._last)))
        return 1.0

    def heights(self, state: np.ndarray) -> np.ndarray:
        """Temperatures that set the viscosity: the film's (n, m)."""
        return np.ascontiguousarray(state[:, : self.shape[1]])

    def split(self, temperature: float | np.ndarray) -> tuple[float | np.ndarray, Walls | None]:
        """Split a state into the film's temperatures (n, m) and its walls; None for a state without walls."""
        if self.size == self.shape[1]:
            return temperature, None
        if temperature is not self._last_split:
            self._last_split = T = np.asarray(temperature)
            bush, journal = self.sides
            walls = Walls(
                None if bush is None else bush.of(T),
                None if journal is None else journal.of(T)[0],
                None if bush is None else bush.rings.radii,
                None if journal is None else journal.rings.radii,
                self.clearance + self.opening(T),
                self._across(T),
            )
            self._parts = np.ascontiguousarray(T[:, : self.shape[1]]), walls
        return self._parts

    def _across(self, state: np.ndarray) -> np.ndarray | None:
        """Tilt and both surfaces' temperatures (3, n, m), K; None with one mean temperature."""
        return None

    def opening(self, temperature: np.ndarray) -> float:
        """Return the change of the radial clearance by the walls' growth, m."""
        bush, journal = (0.0 if wall is None else wall.growth(temperature) for wall in self.sides)
        return bush - journal

    def advance(self, film: SolvedFilm) -> np.ndarray:
        """State at the end of a solved film's step."""
        old = np.asarray(self.state_of(film.history))
        return old if film.step <= 0.0 else self._with_supply(film, film.step)

    def leaving(self, film: SolvedFilm, temperature: np.ndarray | float) -> np.ndarray:
        """Mean temperature (2,) of the oil that leaves at both ends, K, weighted by its flow.

        At an end without outflow it is the mean of the film's temperature there.
        """
        out = np.maximum(OilFlows(film, self.carry_over).leaving[:, [0, -1]], 0.0)
        weights = np.where(out.sum(axis=0) > 0.0, out, 1.0)
        return np.asarray(np.average(np.asarray(temperature)[:, [0, self.shape[1] - 1]], axis=0, weights=weights))

    def steady_temperature(self, film: SolvedFilm) -> np.ndarray:
        """State in balance with the heat of a solved film; not finite without a sink for the heat."""
        flows = OilFlows(film, self.carry_over)
        stagnant = flows.exchanged <= ROUNDING * float(np.abs(flows.x).max())
        if self.transfer == 0.0 and stagnant and heat_of(film).max() > 0.0:
            return np.full((self.shape[0], self.size), np.inf)
        return self._with_supply(film, 0.0)

    def _with_supply(self, film: SolvedFilm, step: float) -> np.ndarray:
        """State at the end of a step, s, with the supply temperature of the sump; step 0: steady state."""
        old, (supply, conductance) = np.asarray(self.state_of(film.history)), self.outside(film)
        state = self._settled(film, step, old, supply)
        if math.isinf(conductance):
            return state
        # state and heat are linear in the supply temperature
        warmer = self._settled(film, step, old, supply + 1.0)
        cold, warm = self._carried(film, step, state, supply), self._carried(film, step, warmer, supply + 1.0)
        return state + cold / (conductance + cold - warm) * (warmer - state)

    def _carried(self, film: SolvedFilm, step: float, state: np.ndarray, supply: float) -> float:
        """Heat flow, W, carried out of the film by the oil in a step, s, at a supply temperature, K."""
        at = [self._surface(side, state) for side in (0, 1)]
        return self.equations(film, step, supply).totals(self._of_film(state), at)["convected"]

    def balance(self, film: SolvedFilm, temperature: np.ndarray) -> dict[str, float]:
        """Heat balance of film and walls, W, for a step that ends at a state.

        Terms: heat in, convected, conducted to the ambient or to given walls, and stored. Also ``bush`` and
        ``journal``, the heat from the film into them, and the supply temperature, K.
        """
        T, old = self._of_film(temperature), np.asarray(self.state_of(film.history))
        supply, conductance = self.outside(film)
        if math.isfinite(conductance):
            cold, warm = (self._carried(film, film.step, temperature, supply + rise) for rise in (0.0, 1.0))
            supply += cold / (conductance + cold - warm)
        film_only = self.equations(film, film.step, supply)
        at = [self._surface(side, temperature) for side in (0, 1)]
        out, q = film_only.totals(T, at), film_only.passed(T, at)
        out["conducted"] = 0.0
        for wall, heat in zip(self.sides, q, strict=True):
            if wall is None:
                out["conducted"] += float(heat.sum())
                continue
            wall.rings.bring_to(film.step)
            lost, stored = wall.heat(temperature, old)
            out["conducted"] += lost
            out["stored"] += stored
        return out | {"bush": float(q[0].sum()), "journal": float(q[1].sum()), "supply_temperature": supply}

    def _surface(self, side: int, state: np.ndarray) -> np.ndarray:
        """Surface temperature of a side, (n, 1) or (1, 1), K."""
        wall = self.sides[side]
        return np.full((1, 1), self.walls[side][1]) if wall is None else wall.of(state)[:, :1]

    def _settled(self, film: SolvedFilm, step: float, old: np.ndarray, supply: float) -> np.ndarray:
        """State at the end of a step for a given supply temperature, K."""
        for wall in self.conducting:
            wall.rings.bring_to(step)
        between = self.equations(film, step, supply)
        at = [self._surface(side, old) for side in (0, 1)]
        if self.conducting:
            change = self._surfaces_change(between, old, between.passed(between.between(at), at))
            at = [a + c for a, c in zip(at, self._spread(change), strict=True)]
        state = np.empty((self.shape[0], self.size))
        state[:, : self.blocks * self.shape[1]] = between.state(between.between(at), at)
        for side, surface in zip(self.sides, at, strict=True):
            if side is not None:
                rise = side.rings.behind(surface.ravel() - side.ambient, side.of(old) - side.ambient)
                state[:, side.columns] = rise + side.ambient
        return state

    def _surfaces_change(self, between: HeatBalance, old: np.ndarray, heat: list[np.ndarray]) -> np.ndarray:
        """Change (k,) of the walls' surface temperatures at which film and walls have the same heat flow.

        ``heat``: heat flow, W, from the film at the temperatures ``old``. Solved by GMRES; the preconditioner is the
        system of the walls with a film of fixed temperatures.
        """
        stiff, missing, at = np.zeros((self.unknowns, self.unknowns)), np.zeros(self.unknowns), 0
        for wall in self.conducting:
            part = slice(at, at + wall.rings.columns)
            at, rise = part.stop, wall.of(old) - wall.ambient
            stiff[part, part] = wall.rings.matrix()
            missing[part] = wall.rings.remembered(rise) - stiff[part, part] @ rise[:, 0]
        given = self._gather(heat)
        lead = lu_factor(stiff - self._held(between.through[..., -2:]))

        def led(w: np.ndarray) -> np.ndarray:
            at = self._spread(w)
            return lu_solve(lead, stiff @ w - self._gather(between.passed(between.change(at), at)))

        enough = AGREED * float(np.linalg.norm(lu_solve(lead, given)))
        return solve_by_products(led, lu_solve(lead, missing + given), enough, self.unknowns)

    def equations(self, film: SolvedFilm, step: float, supply: float) -> HeatBalance:
        """Return the equations of a solved film over a step, s (0: steady state), at a supply temperature, K."""
        return HeatBalance(self, film, step, self.passage(film), self.band, supply)

    def passage(self, film: SolvedFilm) -> PassageData:
        """Return the data of the heat flow from a solved film to both sides, see `PassageData`."""
        k = self.spec.conductivity
        kappa = None if k is None else k / (self.clearance * film.solver.H)
        area = film.solver.area * film.grid.reference_length**2
        bush, journal = (U if wall is None else None for wall, (U, _) in zip(self.sides, self.walls, strict=True))
        return kappa, area, (bush, journal)

    def _of_film(self, state: np.ndarray) -> np.ndarray:
        """The film's unknowns (k, n, m) in a state."""
        return self.across(state)[: self.fields]

    def across(self, temperature: Field) -> np.ndarray:
        """Mean temperature (1, n, m) in a state, K."""
        return np.asarray(temperature)[None, :, : self.shape[1]]

    def warmed(self, temperature: Field, change: np.ndarray) -> np.ndarray:
        """State after a ``change`` of the fields of `across`, with the same walls, K."""
        out = np.array(temperature)
        out[:, : self.shape[1]] += change[0]
        return out

    def _spread(self, w: np.ndarray) -> list[np.ndarray]:
        """Values (k,) at the surfaces of conducting walls as (n, 1) or (1, 1) arrays of both sides; else zero."""
        columns = [0 if wall is None else wall.rings.columns for wall in self.sides]
        parts = np.split(w, columns[:1])
        return [part[:, None] if part.size else np.zeros((1, 1)) for part in parts]

    def _gather(self, heat: list[np.ndarray]) -> np.ndarray:
        """Sums (k,) of the fields (n, m) of both sides over the vertices at each column of a conducting wall."""
        rows = [
            h.sum(axis=1).reshape(wall.rings.columns, -1).sum(axis=1)
            for wall, h in zip(self.sides, heat, strict=True)
            if wall is not None
        ]
        return np.concatenate(rows)

    def _held(self, through: np.ndarray) -> np.ndarray:
        """Heat flow into the walls from a film of fixed temperatures, per kelvin of their surfaces (k, k), W/K.

        ``through`` (2, n, m, 2): heat into both sides per kelvin of both sides.
        """
        (bush, both), (_, journal) = np.moveaxis(through.sum(axis=2), -1, 1)
        whole = np.block([[np.diag(bush), both[:, None]], [both, journal.sum()]])
        known = np.repeat([wall is not None for wall in self.sides], (bush.size, 1))
        return whole[np.ix_(known, known)]


class Growth:
    """Growth of the walls as a gap term: uniform, by the start-of-step temperatures."""

    def __init__(self, thermal: FilmTemperature) -> None:
        self.thermal = thermal

    def field(self, history: History | None) -> np.ndarray:
        """Scaled addition to the gap (n, m)."""
        opening = self.thermal.opening(np.asarray(self.thermal.state_of(history))) / self.thermal.clearance
        return np.full(self.thermal.shape, opening)
