"""Temperature across the film as a cubic with two unknowns, `FilmEnergy.across` = 2: viscosity and heat balance.

Over the height zeta, 0 at the bush and 1 at the journal, with Legendre's polynomials P_k on it,

    T = s + a P_1 + ((T_j + T_b)/2 - s) P_2 + ((T_j - T_b)/2 - a) P_3,

with the mean s, the tilt a, and the temperatures T_b and T_j of the surfaces. T_b and T_j follow from the heat flow
through the surfaces, ``q_b = k/h (6 s - 10 a - 9 T_b + 3 T_j)`` and ``q_j = k/h (6 s + 10 a - 9 T_j + 3 T_b)``. The
fluidity 1/mu is the cubic through its values at Lobatto's four points, which are the surfaces and 1/2 -+ 1/(2 sqrt 5)
(H. G. Elrod and D. E. Brewe, Proc. 13th Leeds-Lyon Symposium (1986) 493). Lobatto's rule gives its moments
``J_r = int zeta^r / mu`` exactly. With them the flow and the shear stress are (D. Dowson, Int. J. Mech. Sci. 4 (1962)
159)

    q = U h (1 - J_1/J_0) - h^3 (J_2 - J_1^2/J_0) dp/dx,        tau = U / (h J_0) + h (zeta - J_1/J_0) dp/dx.

There are two energy equations for a control volume: the mean over the height, and the one weighted with P_1. On a link
the flow at every height transports the temperature upstream at that height; in z this is of second order, as in
`exudyn_ehd.film.heat.energy`. Oil also flows across the film, as continuity demands. Oil that leaves at the ends has
the profile of pressure flow. Oil that a cavitation model adds or loses has the profile of Couette flow.

Scaled as in `exudyn_ehd.film.heat.energy`. Quantities that are linear in the temperatures have a last axis of four
coefficients: of s, of a, and of the temperatures w_b and w_j outside the surfaces. An axis of two holds the heat and
its tilt, which is the heat weighted with P_1. Fluidities (n, m, 4) are divided by the reference fluidity, and are those
at Lobatto's points.

A state of a bearing's model has four blocks (n, m) in place of the film's one temperature, K: the mean, the mean with
the tilt, and the surfaces of bush and journal. The columns of conducting walls follow, as in
`exudyn_ehd.joint.heat.walls`.
"""

from __future__ import annotations

import numpy as np
import scipy
from numba import njit
from numpy.polynomial import Polynomial

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.compilation import FAST
from exudyn_ehd.film.heat.energy import (
    LOBATTO,
    ViscosityField,
    at_points,
    cubic_at,
    film_heat,
    passed,
    weight_across,
    weight_along,
)
from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.film.reynolds.gap import drops, to_ends
from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.joint.heat.equations import MIXED, STAGNANT, HeatBalance, linear
from exudyn_ehd.joint.heat.power import conductances_of, dropped, sheared
from exudyn_ehd.joint.heat.temperature import Field
from exudyn_ehd.joint.heat.walls import FilmTemperature
from exudyn_ehd.joint.solved_film import SolvedFilm

_MOMENTS = (np.array([1.0, 5.0, 5.0, 1.0]) / 12.0)[:, None] * LOBATTO[:, None] ** np.arange(3)
# five heights: Gauss's rule is then exact for the product of a flow (degree 5), a temperature (3) and a weight (1)
HEIGHTS, _SHARES = scipy.special.roots_sh_legendre(5)
_WEIGHTS = np.array([_SHARES, _SHARES * (2.0 * HEIGHTS - 1.0)])


def _of_points(moment: int, times: int) -> np.ndarray:
    """zeta^moment times Lagrange's polynomial of each point, integrated ``times`` times from the bush: (4, 5)."""
    polynomials = (Polynomial.fromroots(np.delete(LOBATTO, k)) for k in range(4))
    weighted = (p * Polynomial.basis(moment) / p(at) for p, at in zip(polynomials, LOBATTO, strict=True))
    return np.array([p.integ(times)(HEIGHTS) for p in weighted])


_FLUID, _FLOWS = _of_points(0, 0), [_of_points(r, k) for k in (1, 2) for r in (0, 1)]
_CUBIC = cubic_at(HEIGHTS)


def on_links(fluid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fluidities of the links in theta and z, by the mean viscosity of both vertices at each point."""
    thick = 1.0 / fluid
    far = np.concatenate((thick[:, 1:], thick[:, -1:]), axis=1)
    return 2.0 / (thick + np.roll(thick, -1, axis=0)), 2.0 / (thick + far)


def flow_factors(fluid: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Factors (n, m) of conductance, carrier and shear stress for the fluidities (n, m, 4) at Lobatto's points."""
    J0, J1, J2 = np.moveaxis(fluid @ _MOMENTS, -1, 0)
    return 12.0 * (J2 - J1 * J1 / J0), 2.0 * (1.0 - J1 / J0), 1.0 / J0


class FluidityField(ViscosityField):
    """Viscosity over the height of a film: flux effect and shear factor.

    Attributes
    ----------
    vertices, along, across : (n, m, 4) arrays
        1 over the viscosity ratio at Lobatto's points: at the vertices, on links in theta, and on links in z.
    """

    changes_carriers = True

    def set(self, ratio: np.ndarray) -> None:
        """Set the viscosity ratio at Lobatto's points of the vertices (n, m, 4); a link has its vertices' mean."""
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


def flow_shapes(fluid: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Flows of sliding and of pressure at the heights, and both below the heights, over the mean flow.

    Four arrays (n, m, 5), for the fluidities (n, m, 4).
    """
    J0, J1, J2 = np.moveaxis(fluid @ _MOMENTS, -1, 0)[..., None]
    F0, F1, B0, B1 = ((fluid.reshape(-1, 4) @ of).reshape(*fluid.shape[:2], 5) for of in _FLOWS)
    centre = J1 / J0
    slide, press = 1.0 / (J0 - J1), 1.0 / (J2 - J1 * centre)
    return slide * F0, press * (centre * F0 - F1), slide * B0, press * (centre * B0 - B1)


def heat_tilts(fluid: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tilt of the heat, (n, m) each: of sliding and of pressure flow over their heat, and of their mixed product."""
    J0, J1, _ = np.moveaxis(fluid @ _MOMENTS, -1, 0)
    heat, tilt = ((fluid @ _FLUID) * w for w in _WEIGHTS)
    arm = HEIGHTS - (J1 / J0)[..., None]
    return tilt.sum(-1) / J0, (tilt * arm**2).sum(-1) / (heat * arm**2).sum(-1), (tilt * arm).sum(-1) / J0


def crossed_tilt(
    P: np.ndarray, H: np.ndarray, both: np.ndarray, speeds: tuple[float, float], mesh: tuple[np.ndarray, ...]
) -> np.ndarray:
    """Tilt of the heat (n, m) from the mixed product of the stresses of sliding and of pressure flow.

    ``both``: last array of `heat_tilts`; ``speeds``: scaled, along theta and z.
    """
    width_x, width_z, link_x, _ = mesh
    x, z = -drops(P)
    along, across = speeds[0] * np.outer(link_x != 0.0, width_z) * x, speeds[1] * width_x[:, None] * z
    return 4.0 * H * both * (to_ends(along, 0) + to_ends(across, 1))


def surfaces(
    kappa: np.ndarray, area: np.ndarray, outward: tuple[float | None, float | None]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Temperatures of both surfaces, heat into them, W, and the losses of heat and tilt by conduction, W.

    Arguments as for `exudyn_ehd.film.heat.energy.passed`; (2, n, m, 4) each.
    """
    inside = np.array([[6.0, -10.0, 0.0, 0.0], [6.0, 10.0, 0.0, 0.0]])
    T, through = (np.ascontiguousarray(np.moveaxis(x, 1, -1)) for x in passed(kappa, area, outward, inside, 9.0, -3.0))
    tilt = (kappa * area)[..., None] * (np.array([0.0, 20.0, 0.0, 0.0]) - 10.0 * (T[1] - T[0]))
    return T, through, np.stack((through[0] + through[1], tilt))


def at_heights(surface: np.ndarray) -> np.ndarray:
    """Temperatures (n, m, 5, 4) at the heights, from those of both surfaces (2, n, m, 4)."""
    out = np.einsum("gk,kijc->ijgc", _CUBIC[:, 2:], surface)
    out[..., :2] += _CUBIC[:, :2]
    return out


def weighed(flow: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Heat and tilt (2, n, m, 4) of flows at the heights (n, m, 5) with temperatures ``at`` of `at_heights`."""
    return np.asarray(np.einsum("rijg,ijgc->rijc", _WEIGHTS[:, None, None] * flow, at))


@njit(cache=True, fastmath=FAST)
def carry(axis, driven, sliding, shapes, at, limiter, ends_out, below_out, content_out):
    """Add the heat, its tilt and the oil that flow over the links in theta (axis 0) or z (1).

    Parameters
    ----------
    driven, sliding : (n, m) arrays
        Flows by pressure and by sliding.
    shapes : four arrays
        `flow_shapes` on the links.
    at : (n, m, 5, 4) array
        See `at_heights`.
    limiter : three arrays
        Temperatures (n, 5, m) at the heights, and ``links`` and ``held`` as in
        `exudyn_ehd.film.heat.energy.transport_slopes`. Here the limiter of that function acts at every height.
    ends_out : (2, 2, n, m, 4) array
        Coefficients of the heat and tilt that leave over the link: of the temperatures at its first vertex, and at its
        second one.
    below_out, content_out : (n, m, 5), (n, m) arrays
        Inflow of oil into a vertex below the heights, and over the whole height.
    """
    slides, pressed, slides_below, pressed_below = shapes
    T, links, held = limiter
    n, m, heights = slides.shape
    for i in range(n):
        for j in range(m - axis):
            a, b = ((i + 1) % n, j) if axis == 0 else (i, j + 1)
            p, s = driven[i, j], sliding[i, j]
            content_out[i, j] -= p + s
            content_out[a, b] += p + s
            for g in range(heights):
                passed = s * slides_below[i, j, g] + p * pressed_below[i, j, g]
                below_out[i, j, g] -= passed
                below_out[a, b, g] += passed
                F, share = s * slides[i, j, g] + p * pressed[i, j, g], 0.0
                if F != 0.0:
                    weight = (
                        weight_along(T[:, g, j], links[0], i, F)
                        if axis == 0
                        else weight_across(T[i, g], links[1], j, F)
                    )
                    share = weight * min(1.0, (held[i, j] if F > 0.0 else held[a, b]) / abs(F))
                own = (1.0 - share if F > 0.0 else share) * F
                for r in range(2):
                    for c in range(4):
                        ends_out[0, r, i, j, c] += _WEIGHTS[r, g] * own * at[i, j, g, c]
                        ends_out[1, r, i, j, c] += _WEIGHTS[r, g] * (F - own) * at[a, b, g, c]


@njit(cache=True)
def band_of_pairs(ends, own, number, lower, upper):
    """Fill the bands, as in `exudyn_ehd.film.banded.factors`, for the pairs (s, a) at the numbered vertices (n, m).

    ``own`` (2, n, m, 4): coefficients of a vertex without its links; ``ends`` (2, 2, 2, n, m, 4): ``ends_out`` of
    `carry` for the links in theta and in z.
    """
    n, m = number.shape
    lower[:] = 0.0
    upper[:] = 0.0
    for i in range(n):
        for j in range(m):
            here = number[i, j]
            _add(own[:, i, j], 1.0, here, here, lower, upper)
            for axis in range(2 if j + 1 < m else 1):
                there = number[(i + 1) % n, j] if axis == 0 else number[i, j + 1]
                for side, column in ((0, here), (1, there)):
                    _add(ends[axis, side, :, i, j], 1.0, here, column, lower, upper)
                    _add(ends[axis, side, :, i, j], -1.0, there, column, lower, upper)


@njit(cache=True, inline="always")
def _add(block, sign, row, column, lower, upper):
    for r in range(2):
        for c in range(2):
            a, b = 2 * row + r, 2 * column + c
            if b >= a:
                upper[a, b - a] += sign * block[r, c]
            else:
                lower[b, a - b] += sign * block[r, c]


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
        self._carry(thermal.fluidity, np.array([self.felt, *across]))
        kept = self.store + STAGNANT * self.largest
        self.own[0, ..., 0] += kept + self.follows
        self.own[1, ..., 1] += kept / 3.0
        if film.parts.mixing:
            areas = np.logical_or.reduce(film.parts.mixing)
            self.own[1, ..., 1] += areas * MIXED * (self.largest + largest_lost)
        self.given = np.array([self.heat, thermal.heat_tilt(film)]) / self.scale
        self.given[0] += kept * (self.begin[0] - self.supply) + self.follows * (self.felt - self.supply)
        self.given[1] += kept / 3.0 * self.begin[1]
        band_of_pairs(self.ends, self.own, self.band.number, self.band.lower, self.band.upper)

    def _carry(self, field: FluidityField, felt: np.ndarray) -> None:
        """Add the heat that flows carry; the limiter takes the film's extrapolated temperatures ``felt`` (4, n, m)."""
        film, flows = self.film, self.flows
        q, (kx, kz) = film.solver.system.flow_pressure, conductances_of(film)
        at, (slides, pressed, slides_below, pressed_below) = at_heights(self.surface), flow_shapes(field.vertices)
        limiter = np.ascontiguousarray(np.einsum("gc,cij->igj", _CUBIC, felt)), self.links(), self.held
        made = flows.found - flows.lost
        below = flows.outside[..., None] * pressed_below + made[..., None] * slides_below
        content, ends = flows.outside + made, np.zeros((2, 2, *self.own.shape))
        for axis, (k, whole, fluid) in enumerate(((kx, flows.x, field.along), (kz, flows.z, field.across))):
            driven = k * (q - np.roll(q, -1, axis))
            carry(axis, driven, whole - driven, flow_shapes(fluid), at, limiter, ends[axis], below, content)
        stirred = self.stirred()
        for unknown, stored in enumerate((1.0, 1.0 / 3.0)):
            ends[:, 0, unknown, ..., unknown] += stored * stirred
            ends[:, 1, unknown, ..., unknown] -= stored * stirred
        self.ends = ends
        leaves, loses = (weighed(flow, at) for flow in (pressed, slides))
        if flows.areas:
            # oil that enters a supply area is mixed over the height
            leaves[:, np.logical_or.reduce(flows.areas)] = np.eye(2, 4)[:, None] * [[[1.0]], [[0.0]]]
        self.takes, uniform = (leaves[0], loses[0]), np.ones((*q.shape, HEIGHTS.size, 4))
        self.brings = flows.found * weighed(slides, uniform)[..., 0]
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

    def initial_temperature(self) -> np.ndarray:
        """Initial state (n, 4 m + k), K: one temperature in the film, those of the walls at the surfaces."""
        start, m = super().initial_temperature(), self.shape[1]
        for at, wall in zip((2 * m, 3 * m), self.sides, strict=True):
            start[:, at : at + m] = self.initial if wall is None else wall.initial
        return start

    def heights(self, state: np.ndarray) -> np.ndarray:
        """Temperatures (n, m, 4) that set the viscosity, at Lobatto's points."""
        return at_points(self.across(state))

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

    def across(self, temperature: Field) -> np.ndarray:
        """Mean, tilt and both surfaces (4, n, m) in a state, K."""
        n, m = self.shape
        out = np.asarray(temperature)[:, : 4 * m].reshape(n, 4, m).transpose(1, 0, 2).copy()
        out[1] -= out[0]
        return out

    def warmed(self, temperature: Field, change: np.ndarray) -> np.ndarray:
        """State after a ``change`` of the fields of `across`, with the same walls, K."""
        out, m = np.array(temperature), self.shape[1]
        mean, tilt, *surfaces = change
        out[:, : 4 * m] += np.hstack([mean, mean + tilt, *surfaces])
        return out

    def _across(self, state: np.ndarray) -> np.ndarray:
        return self.across(state)[1:]
