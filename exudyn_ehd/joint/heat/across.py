"""Two temperatures across the film, `FilmEnergy.across` = 2: state, viscosity and heat balance of a bearing model.

A state has four blocks (n, m) in place of the film's one temperature, K: the mean, the mean with the tilt, and the
surfaces of bush and journal; see `exudyn_ehd.film.heat.across`. The columns of conducting walls follow, as in
`exudyn_ehd.joint.heat.walls`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.across import (
    HEIGHTS,
    FluidityField,
    at_heights,
    at_points,
    band_of_pairs,
    carry,
    crossed_tilt,
    flow_shapes,
    heat_tilts,
    start_heights,
    surfaces,
    weighed,
)
from exudyn_ehd.film.heat.energy import ViscosityField, film_heat
from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.joint.heat.power import conductances_of, dropped, sheared
from exudyn_ehd.joint.heat.temperature import MIXED, STAGNANT, HeatBalance, linear
from exudyn_ehd.joint.heat.walls import FilmTemperature
from exudyn_ehd.joint.solved_film import SolvedFilm


class PairBalance(HeatBalance):
    """Energy equations of mean and tilt of a solved film over a step, or in the steady state with a step of 0.

    Unknowns are mean and tilt (2, n, m), K.

    Parameters
    ----------
    thermal : CubicTemperature
    film, step, passage, band, supply
        As for `HeatBalance`.
    """

    def _assemble(self, kappa: np.ndarray | None, area: np.ndarray, outward: tuple[float | None, float | None]) -> None:
        film, thermal = self.film, self.thermal
        assert isinstance(thermal, CubicTemperature) and kappa is not None
        assert film.walls is not None and film.walls.across is not None
        self.surface, self.through, lost = surfaces(kappa, area, outward)
        self.own, across = lost / self.scale, film.walls.across
        largest_lost = float(np.abs(self.own).max())
        self._carry(thermal.fluidity, np.array([self.old, *across]))
        kept = self.store + STAGNANT * self.largest
        self.own[0, ..., 0] += kept + self.follows
        self.own[1, ..., 1] += kept / 3.0
        if film.parts.mixing:
            areas = np.logical_or.reduce(film.parts.mixing)
            self.own[1, ..., 1] += areas * MIXED * (self.largest + largest_lost)
        self.given = np.array([self.heat, thermal.heat_tilt(film)]) / self.scale
        self.given[0] += (kept + self.follows) * (self.old - self.supply)
        self.given[1] += kept / 3.0 * across[0]
        band_of_pairs(self.ends, self.own, self.band.number, self.band.lower, self.band.upper)

    def _carry(self, field: FluidityField, old: np.ndarray) -> None:
        """Add the heat that flows carry; the limiter takes the start-of-step temperatures ``old`` (4, n, m)."""
        film, flows = self.film, self.flows
        q, (kx, kz) = film.solver.system.flow_pressure, conductances_of(film)
        at, own = at_heights(self.surface), flow_shapes(field.vertices)
        limiter = start_heights(old), film.grid.link_z, self.held
        made = flows.found - flows.lost
        below = flows.outside[..., None] * own.pressed_below + made[..., None] * own.slides_below
        content, ends = flows.outside + made, np.zeros((2, 2, *self.own.shape))
        for axis, (k, whole, fluid) in enumerate(((kx, flows.x, field.along), (kz, flows.z, field.across))):
            driven = k * (q - np.roll(q, -1, axis))
            carry(axis, driven, whole - driven, flow_shapes(fluid), at, limiter, ends[axis], below, content)
        stirred = self.stirred()
        ends[:, 0, 0, ..., 0] += stirred
        ends[:, 1, 0, ..., 0] -= stirred
        self.ends = ends
        leaves, loses = (weighed(flow, at) for flow in (own.pressed, own.slides))
        if flows.areas:
            # oil that enters a supply area is mixed over the height
            leaves[:, np.logical_or.reduce(flows.areas)] = np.eye(2, 4)[:, None] * [[[1.0]], [[0.0]]]
        self.takes, uniform = (leaves[0], loses[0]), np.ones((*q.shape, HEIGHTS.size, 4))
        self.brings = flows.found * weighed(own.slides, uniform)[..., 0]
        self.own[0, ..., 0] += content
        self.own[1, ..., 1] += content / 3.0
        self.own[1] -= 2.0 * weighed(below - content[..., None] * HEIGHTS, at)[0]
        self.own += flows.leaving[..., None] * leaves + flows.lost[..., None] * loses

    def state(self, x: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Blocks (n, 4 m) of a state."""
        return np.hstack([x[0], x[0] + x[1], *linear(self.surface, [*x, *at])])


class CubicTemperature(FilmTemperature):
    """`FilmEnergy` with two temperatures across the film, of one bearing model.

    Parameters
    ----------
    spec, bearing, shape
        As for `FilmTemperature`.
    field : FluidityField
        Viscosity field that the film reads.
    """

    blocks, fields = 4, 2

    def __init__(
        self, spec: FilmEnergy, bearing: JournalBearing, field: ViscosityField, shape: tuple[int, int]
    ) -> None:
        assert isinstance(field, FluidityField)
        super().__init__(spec, bearing, field, shape)
        self.fluidity = field

    def initial_temperature(self, shape: tuple[int, int]) -> np.ndarray:
        """Initial state (n, 4 m + k), K: one temperature in the film, those of the walls at the surfaces."""
        start, m = super().initial_temperature(shape), shape[1]
        for at, wall in zip((2 * m, 3 * m), self.sides, strict=True):
            start[:, at : at + m] = self.initial if wall is None else wall.initial
        return start

    def heights(self, state: np.ndarray) -> np.ndarray:
        """Temperatures (n, m, 4) that set the viscosity, at Lobatto's points."""
        return at_points(self._blocks(state))

    def heat_tilt(self, film: SolvedFilm) -> np.ndarray:
        """Return the P_1 component of the heat at the vertices, W (n, m); contacts heat evenly over the height."""
        sliding, pressed, both = heat_tilts(self.fluidity.vertices)
        s = film.solver
        flow = film_heat(dropped(film), s.system.flow_pressure, conductances_of(film))
        crossed = crossed_tilt(film.oil.P, s.H, both, (s.vx * s.flow_x, s.vz), film.grid.mesh)
        power = film.parts.flow_scale * film.scales.pressure
        return power * (sheared(film) * sliding + flow * pressed + crossed)

    def equations(self, film: SolvedFilm, step: float, supply: float) -> PairBalance:
        """Return the equations of a solved film over a step, see `FilmTemperature.equations`."""
        return PairBalance(self, film, step, self.passage(film), self.band, supply)

    def _blocks(self, state: np.ndarray) -> np.ndarray:
        """Mean, tilt and both surfaces (4, n, m) of a state."""
        n, m = self.shape
        out = state[:, : 4 * m].reshape(n, 4, m).transpose(1, 0, 2).copy()
        out[1] -= out[0]
        return out

    def _across(self, state: np.ndarray) -> np.ndarray:
        return self._blocks(state)[1:]

    def _of_film(self, state: np.ndarray) -> np.ndarray:
        return self._blocks(state)[:2]
