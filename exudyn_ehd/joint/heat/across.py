"""Two temperatures across the film: a bearing model's state, viscosity and balance of heat, `FilmEnergy.across` = 2.

A state has four blocks (n, m) in place of the film's one temperature, K: the mean, the mean with the tilt, and the
surfaces of bush and journal; see `exudyn_ehd.film.heat.across`. Behind them stand walls that conduct, as in
`exudyn_ehd.joint.heat.walls`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.across import (
    HEIGHTS,
    at_heights,
    at_points,
    band_of_pairs,
    carry,
    crossed_tilt,
    flow_factors,
    flow_shapes,
    heat_tilts,
    on_links,
    start_heights,
    surfaces,
    weighed,
)
from exudyn_ehd.film.heat.energy import film_heat
from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.joint.heat.heat_balance import MIXED, STAGNANT, HeatBalance
from exudyn_ehd.joint.heat.temperature import ViscosityField
from exudyn_ehd.joint.heat.walls import FilmTemperature
from exudyn_ehd.joint.solved_film import SolvedFilm


class FluidityField(ViscosityField):
    """Viscosity over the height of a film: flux effect and shear factor.

    Attributes
    ----------
    vertices, along, across : (n, m, 4) arrays
        1 over the viscosity's ratio at Lobatto's points: at vertices, on links in theta and z.
    """

    changes_carriers = True

    def set(self, ratio: np.ndarray) -> None:
        """Take over the ratio at the vertices at Lobatto's points (n, m, 4); links take the mean of their vertices."""
        self.vertices = 1.0 / ratio
        self.along, self.across = on_links(self.vertices)
        self.inverse_x, self.carried_x, _ = flow_factors(self.along)
        self.inverse_z, self.carried_z, _ = flow_factors(self.across)
        self.ratio = flow_factors(self.vertices)[2]

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Multiply conductances and carriers by their factors on the links."""
        super().apply(flux, gap_x, gap_z, vx, vz)
        for carriers, factor in (((flux.cx, flux.cx_h), self.carried_x), ((flux.cz, flux.cz_h), self.carried_z)):
            for carrier in carriers:
                carrier *= factor


class PairBalance(HeatBalance):
    """Energy equations of mean and tilt of a solved film over a step, or in the steady state with a step of 0.

    Unknowns are mean and tilt (2, n, m), K.

    Parameters
    ----------
    thermal : CubicTemperature
    film, step
        As for `HeatBalance`.
    """

    def __init__(self, thermal: CubicTemperature, film: SolvedFilm, step: float) -> None:
        super().__init__(thermal, film, step, thermal.passage(film))
        assert film.walls is not None and film.walls.across is not None
        self.pairs, across, largest = thermal.band(film.grid.shape, 2), film.walls.across, self.largest()
        largest_lost = float(np.abs(self.own).max())
        self._carry(thermal.fluidity, np.array([self.old, *across]))
        kept = self.store + STAGNANT * largest
        self.own[0, ..., 0] += kept + self.follows
        self.own[1, ..., 1] += kept / 3.0
        if film.parts.supply is not None:
            areas = np.logical_or.reduce(film.parts.supply.masks)
            self.own[1, ..., 1] += areas * MIXED * (largest + largest_lost)
        self.given = np.array([self.heat, thermal.heat_tilt(film)]) / self.scale
        self.given[0] += (kept + self.follows) * (self.old - self.supply)
        self.given[1] += kept / 3.0 * across[0]

    def _pass(self, kappa: np.ndarray | None, area: np.ndarray, outward: tuple[float | None, float | None]) -> None:
        assert kappa is not None
        self.surface, through, lost = surfaces(kappa, area, outward)
        self.through = np.moveaxis(through, -1, 1)
        self.own = lost / self.scale

    def _carry(self, field: FluidityField, old: np.ndarray) -> None:
        """Add the heat that flows carry; the limiter takes the start-of-step temperatures ``old`` (4, n, m)."""
        film, flows = self.film, self.flows
        q, y = film.solver.system.flow_pressure, film.solver.system
        at, own = at_heights(self.surface), flow_shapes(field.vertices)
        held = self.store if self.step > 0.0 else np.full(q.shape, np.inf)
        limiter = start_heights(old), film.grid.link_z, held
        made = flows.found - flows.lost
        below = flows.outside[..., None] * own.pressed_below + made[..., None] * own.slides_below
        content, self.ends = flows.outside + made, np.zeros((2, 2, *self.own.shape))
        for axis, (k, whole, fluid) in enumerate(((y.kx, flows.x, field.along), (y.kz, flows.z, field.across))):
            driven = k * (q - np.roll(q, -1, axis))
            carry(axis, driven, whole - driven, flow_shapes(fluid), at, limiter, self.ends[axis], below, content)
        stirred = self.stirred()
        self.ends[:, 0, 0, ..., 0] += stirred
        self.ends[:, 1, 0, ..., 0] -= stirred
        leaves, loses = (weighed(flow, at) for flow in (own.pressed, own.slides))
        if flows.areas:
            # what areas take is mixed over the height
            leaves[:, np.logical_or.reduce(flows.areas)] = np.eye(2, 4)[:, None] * [[[1.0]], [[0.0]]]
        self.takes, uniform = (leaves[0], loses[0]), np.ones((*q.shape, HEIGHTS.size, 4))
        self.brings = flows.found * weighed(own.slides, uniform)[..., 0]
        self.own[0, ..., 0] += content
        self.own[1, ..., 1] += content / 3.0
        self.own[1] -= 2.0 * weighed(below - content[..., None] * HEIGHTS, at)[0]
        self.own += flows.leaving[..., None] * leaves + flows.lost[..., None] * loses

    def solve(self) -> None:
        """Factor the system, which `between` and `change` use."""
        p = self.pairs
        band_of_pairs(self.ends, self.own, p.number, p.lower, p.upper)
        p.factor()
        if self.flows.back > 0.0:
            self.returning = self.pairs.solve(self.flows.back * self.brings)

    def between(self, at: list[np.ndarray]) -> np.ndarray:
        """Mean and tilt (2, n, m), K, with temperatures ``at`` outside both surfaces."""
        x = self._answer(self.given, [a - self.supply for a in at])
        x[0] += self.supply
        return x

    def change(self, at: list[np.ndarray]) -> np.ndarray:
        """Change of `between` by a change outside."""
        return self._answer(np.zeros_like(self.given), at)

    def _answer(self, given: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Mean and tilt (2, n, m), with rises ``at`` outside both surfaces."""
        outside = _fields(np.zeros_like(given), at)
        rest = given - _of(self.own, outside)
        for axis, (own, other) in enumerate(self.ends):
            flow = _of(own, outside) + _of(other, np.roll(outside, -1, axis))
            rest -= flow - np.roll(flow, 1, axis + 1)
        x = self.pairs.solve(rest)
        if self.flows.back > 0.0:
            back = self._mixed(_fields(self.returning, [np.zeros((1, 1))] * 2))
            x = x + self._mixed(_fields(x, at)) / (1.0 - back) * self.returning
        return x

    def _mixed(self, fields: np.ndarray) -> float:
        """Temperature of all oil that is lost, mixed."""
        return float(np.sum(self.weight * _of(self.takes[1], fields)))

    def passed(self, x: np.ndarray, at: list[np.ndarray]) -> list[np.ndarray]:
        """Heat into both sides (n, m), W."""
        return list(_of(np.moveaxis(self.through, 1, -1), _fields(x, at)))

    def state(self, x: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
        """Blocks (n, 4 m) of a state."""
        return np.hstack([x[0], x[0] + x[1], *_of(self.surface, _fields(x, at))])

    def totals(self, x: np.ndarray, at: list[np.ndarray]) -> dict[str, float]:
        """Heat in, convected and stored, W, with mean and tilt ``x`` (2, n, m) at the end."""
        rise = _fields(x, at) - np.array([self.supply, 0.0, self.supply, self.supply])
        leaving, lost = (_of(takes, rise) for takes in self.takes)
        out, flows = super().totals(x[0], at), self.flows
        convected = float(np.sum(flows.leaving * leaving + flows.lost * lost))
        return out | {"convected": self.scale * (convected - flows.back * self._mixed(rise) * flows.total_found)}


def _fields(x: np.ndarray, at: list[np.ndarray]) -> np.ndarray:
    """Mean and tilt (2, n, m) and temperatures outside both surfaces as (n, m, 4)."""
    return np.stack([*x, *(np.broadcast_to(a, x.shape[1:]) for a in at)], axis=-1)


def _of(linear: np.ndarray, fields: np.ndarray) -> np.ndarray:
    """Values (..., n, m) of what is linear in fields (n, m, 4)."""
    return np.einsum("...c,...c", linear, fields)


class CubicTemperature(FilmTemperature):
    """`FilmEnergy` with two temperatures across the film, of one bearing model.

    Parameters
    ----------
    spec, bearing, shape
        As for `FilmTemperature`.
    field : FluidityField
        Takes the viscosity of the temperatures to the film.
    """

    blocks = 4

    def __init__(
        self, spec: FilmEnergy, bearing: JournalBearing, field: ViscosityField, shape: tuple[int, int]
    ) -> None:
        assert isinstance(field, FluidityField)
        super().__init__(spec, bearing, field, shape)
        self.fluidity = field

    def initial_temperature(self, shape: tuple[int, int]) -> np.ndarray:
        """(n, 4 m + k) state, K, at the start of a motion: one temperature, and the walls' at the surfaces."""
        if self._start is None:
            start, m = super().initial_temperature(shape), shape[1]
            for at, wall in zip((2 * m, 3 * m), self.sides, strict=True):
                start[:, at : at + m] = self.initial if wall is None else wall.initial
        return super().initial_temperature(shape)

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Bring the viscosity field to a state, K; the film shares no other factor than 1."""
        if temperature is not self._last:
            self._last = np.asarray(temperature)
            self.field.set(self.viscosity_ratio(at_points(self._blocks(self._last))))
        return 1.0

    def heat_tilt(self, film: SolvedFilm) -> np.ndarray:
        """Return the P_1 component of the heat at the vertices, W (n, m); contacts heat evenly over the height."""
        sliding, pressed, both = heat_tilts(self.fluidity.vertices)
        s, y = film.solver, film.solver.system
        flow = film_heat(self.dropped(film), y.flow_pressure, np.array((y.kx, y.kz)))
        crossed = crossed_tilt(film.oil.P, s.H, both, (s.vx * s.flow_x, s.vz), film.grid.mesh)
        power = film.parts.flow_scale * film.scales.pressure
        return power * (self.sheared(film) * sliding + flow * pressed + crossed)

    def equations(self, film: SolvedFilm, step: float) -> PairBalance:
        """Return the equations of a solved film over a step, s; 0: steady state."""
        return PairBalance(self, film, step)

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
