"""Restrictors of supply areas, and seals: the pressure between them and the film follows from a balance of flows.

The flow Q that the film takes from an area with the pressure p comes through the restrictor, from the supply pressure
p_s (W. B. Rowe, Hydrostatic, Aerostatic and Hybrid Bearing Design, 2012):

    capillary    Q = pi d^4 (p_s - p) / (128 mu l),
    orifice      Q = C_d pi d^2 / 4 sqrt(2 (p_s - p) / rho)  for p < p_s; for p > p_s it flows back by the same law,
    given flow   Q = Q_0.

All of them are one balance, smooth in p and Q where the flow changes its direction too,

    g = a p + b Q + k Q |Q| - c = 0.

With the film's balances r and its unknowns u, an area adds the unknown p and the balance g. Q is the sum of the
balances at the vertices of the area: flows of pressure and of surfaces over the links around it, and the squeeze
under it. Let

    A = dr/du,    B = dr/dp,    C = dQ/du,    D = dQ/dp at fixed u,    S = D - C A^-1 B.

S, the derivative of the film's flows to the pressures of the areas, is an M-matrix, and g rises with p. So there is one
solution, which Newton's method finds. No pressure is below the cavity's: an area from which the film takes more than
comes through its restrictor has the cavity pressure and no balance. Derivatives are those of u and p together.

The oil between restrictor and film is incompressible, unless a restrictor has a ``compressible_volume`` V. With the
bulk modulus K the restrictor then passes

    Q_r = Q + V / K dp/dt

in place of Q in its balance, by backward Euler over the accepted steps. A steady film has Q_r = Q. An area at the
cavity pressure fills again without a delay.

Seals at the ends of the film are restrictors all around: their flow per length is ``C (p_end - p_outside)``. The
pressure at a sealed end is an additional unknown of the film (`sealed_grid`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np
from numba import njit

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, ROUNDING, Checked, InputError, require_number


class _Feed(Checked):
    """Base of restrictors: checks of their arguments."""

    checks: ClassVar = {
        "diameter": POSITIVE,
        "length": POSITIVE,
        "supply_pressure": require_number,
        "discharge_coefficient": partial(POSITIVE, at_most=1.0, hint="a sharp edge has some 0.6."),
        "flow": NOT_NEGATIVE,
        "compressible_volume": NOT_NEGATIVE,
        "bulk_modulus": POSITIVE,
    }


@dataclass(frozen=True, kw_only=True)
class Orifice(_Feed):
    """Sharp-edged orifice between a supply of constant pressure and a supply area.

    Parameters
    ----------
    diameter : float
        m.
    supply_pressure : float
        Gauge pressure in front of it, Pa.
    discharge_coefficient : float, default 0.6
        C_d, above 0 and up to 1.
    compressible_volume : float, default 0.0
        V of the oil between restrictor and film, which is in pocket and line, m3. In joints and in small motions about
        an equilibrium its compression takes the flow ``V / K dp/dt``. A large V makes the bearing unstable. 0: the
        pressure follows without a delay.
    bulk_modulus : float, default 1.7e9
        K of that oil, Pa: 1.4e9 to 1.8e9 without air. Bubbles of the volume share x at an absolute pressure p lower it
        to ``1 / (1 / K + x / p)``, 1 % of them at 1 MPa to 1e8.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> feed = ehd.Orifice(diameter=3e-4, supply_pressure=4e6)
    >>> pocket = ehd.Pocket(angle=np.pi, width_angle=0.6, length=0.012, supply=feed)
    >>> film = ehd.steady(ehd.JournalBearing(**b, supply=(pocket,)), speed=100.0, eccentricity_ratio=0.3)
    >>> (1e-6 * film.pocket_pressures).round(2), (6e7 * film.restrictor_flows).round(1)  # MPa, cm3/min
    (array([2.24]), array([162.]))
    """

    diameter: float
    supply_pressure: float
    discharge_coefficient: float = 0.6
    compressible_volume: float = 0.0
    bulk_modulus: float = 1.7e9

    def coefficients(self, viscosity: float, density: float) -> tuple[float, float, float, float]:
        """Coefficients a, b, k, c of the balance for an oil, Pa s and kg/m3."""
        area = 0.25 * math.pi * self.discharge_coefficient * self.diameter**2
        return 1.0, 0.0, 0.5 * density / area**2, self.supply_pressure


@dataclass(frozen=True, kw_only=True)
class Capillary(_Feed):
    """Laminar capillary between a supply of constant pressure and a supply area.

    Its oil has the viscosity of the supply temperature at ambient pressure. It should be at least 100 diameters long,
    with a Reynolds number below 1000.

    Parameters
    ----------
    diameter, length : float
        m.
    supply_pressure : float
        Gauge pressure in front of it, Pa.
    compressible_volume, bulk_modulus : float, default 0.0, 1.7e9
        As for `Orifice`.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> feed = ehd.Capillary(diameter=5e-4, length=0.06, supply_pressure=4e6)
    >>> pocket = ehd.Pocket(angle=np.pi, width_angle=0.6, length=0.012, supply=feed)
    >>> film = ehd.steady(ehd.JournalBearing(**b, supply=(pocket,)), speed=100.0, eccentricity_ratio=0.3)
    >>> (1e-6 * film.pocket_pressures).round(2)  # MPa
    array([2.06])
    """

    diameter: float
    length: float
    supply_pressure: float
    compressible_volume: float = 0.0
    bulk_modulus: float = 1.7e9

    def coefficients(self, viscosity: float, density: float) -> tuple[float, float, float, float]:
        """Coefficients a, b, k, c of the balance for an oil, Pa s and kg/m3."""
        return 1.0, 128.0 * viscosity * self.length / (math.pi * self.diameter**4), 0.0, self.supply_pressure


@dataclass(frozen=True, kw_only=True)
class GivenFlow(_Feed):
    """Constant flow into a supply area at any pressure, by a pump or a flow regulator for this area alone.

    Parameters
    ----------
    flow : float
        m3/s; 0: a closed recess.
    compressible_volume, bulk_modulus : float, default 0.0, 1.7e9
        As for `Orifice`.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> pocket = ehd.Pocket(angle=np.pi, width_angle=0.6, length=0.012, supply=ehd.GivenFlow(flow=5e-7))
    >>> film = ehd.steady(ehd.JournalBearing(**b, supply=(pocket,)), speed=100.0, eccentricity_ratio=0.3)
    >>> (1e-6 * film.pocket_pressures).round(2)  # MPa
    array([0.42])
    """

    flow: float
    compressible_volume: float = 0.0
    bulk_modulus: float = 1.7e9

    def coefficients(self, viscosity: float, density: float) -> tuple[float, float, float, float]:
        """Coefficients a, b, k, c of the balance for any oil."""
        return 0.0, 1.0, 0.0, self.flow


@dataclass(frozen=True, kw_only=True)
class EndSeal(Checked):
    """Seal at an end of the bearing, as the piston ring of a squeeze-film damper: ``q = conductance (p - p_outside)``.

    q is the axial outflow per length around, p the film's pressure at the end, which is unknown, and p_outside the one
    of ``end_pressures``. The conductance does not depend on the gap. 0: tight; above some 1e4 c^3 / (12 mu L) the end
    is practically open. A narrow slot of height s and length l has s^3 / (12 mu l).

    Results have a row outside of every seal, at ``z`` beyond the end by 1e-9 of the length. Of the axial force on a
    seal one half acts on either surface.

    Parameters
    ----------
    conductance : float
        m3/(s Pa m).

    Examples
    --------
    >>> b = dict(journal_radius=0.065, length=0.02, radial_clearance=1e-4, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> damper = ehd.JournalBearing(**b, cavitation=ehd.FullSommerfeld(), end_seals=ehd.EndSeal(conductance=5e-11))
    >>> film = ehd.steady(damper, speed=0.0, eccentricity_ratio=0.0, velocity=(1e-3, 0.0))
    >>> round(-film.force[0] / 1e-3)  # N s/m
    704921
    """

    conductance: float

    checks: ClassVar = {"conductance": partial(require_number, at_least=0.0)}


def require_seals(seals: object) -> None:
    """Raise `InputError` for anything but a seal, a pair of seals or open ends, or None."""
    pair = seals if isinstance(seals, tuple) else (seals, seals)
    if len(pair) != 2 or not all(isinstance(seal, EndSeal | None) for seal in pair):
        raise InputError(
            "JournalBearing.end_seals must be EndSeal(...) for both ends, a pair with None for an open one, or None, "
            f"got {seals!r}."
        )


def sealed_grid(grid: FilmGrid, seals: tuple[float | None, float | None]) -> FilmGrid:
    """Film grid whose ends are sealed: the pressure at an end is unknown, that of a row outside of it prescribed.

    The link to that row does not depend on the gap: per length around, the seal lets ``q = C (p_end - p_outside)``
    through, besides what an axially moving surface takes along.

    Parameters
    ----------
    grid : FilmGrid
        With open ends.
    seals : pair of floats or None
        C over clearance and R of the lower and the upper end, 1/(Pa s); None: an open end.
    """
    added = tuple(int(seal is not None) for seal in seals)
    # above the rounding of slopes, and without area
    step = ROUNDING * (grid.z[-1] - grid.z[0])
    z = np.concatenate((grid.z[:1] - step, grid.z, grid.z[-1:] + step))[1 - added[0] : grid.z.size + 1 + added[1]]
    widths, fixed = np.diff(z), np.pad(grid.fixed, ((0, 0), added), constant_values=True)
    for row, sealed in zip((1, -2), added, strict=True):
        if sealed:
            fixed[:, row] = grid.fixed[:, 1]
    return replace(
        grid,
        z=z,
        width_z=0.5 * (np.append(widths, 0.0) + np.insert(widths, 0, 0.0)),
        link_z=np.pad(grid.link_z, added),
        weight_z=np.pad(grid.weight_z, added),
        weight=np.pad(grid.weight, ((0, 0), added)),
        fixed=fixed,
        seals=seals,
    )


# Largest conductance of a seal over that of a film as thick as the clearance and as long as the bearing. A larger limit
# would only increase the rounding error of the leakage.
WIDE_OPEN = 1e8


def seal_ends(grid: FilmGrid, kz: np.ndarray, pressure_scale: float) -> None:
    """Set the conductances of seals in those of a film's links in z, kz (n, m); ``pressure_scale`` in Pa.

    Edges of arcs have no seals, because their oil does not come from the film.
    """
    for row, seal in zip((0, -2), grid.seals or (), strict=False):
        if seal is not None:
            kz[:, row] = min(seal * pressure_scale, WIDE_OPEN / (grid.z[-1] - grid.z[0])) * grid.width_x
            kz[grid.edges, row] = 0.0


Restrictor = Orifice | Capillary | GivenFlow


class Reservoirs:
    """Supply areas with a restrictor, whose pressures are unknown.

    Parameters
    ----------
    restrictors : sequence of Restrictor
    masks : list of (n, m) bool arrays
        Vertices of every area; they may change.
    oil : (float, float)
        Viscosity, Pa s, and density, kg/m3, of the oil in the restrictors.
    flow_scale : float
        m3/s per scaled flow of the film.
    law : PressureTransform or None
        Transform from the pressure to the film's unknown; None: the unknown is the pressure.

    Attributes
    ----------
    pressures : (k,) array
        Pressures of the last solution, Pa, from which the next one starts.
    live : (k,) bool array
        Areas that have a balance.
    compliance : (k,) array
        V / K of the areas' oil, m3/Pa.
    before, inverse_step : (k,) array or None, float
        Pressures at the start of the step, Pa, None for a steady film, and the inverse of the step, 1/s; set by the
        caller before a film is solved.
    by_pressure, by_flow, size : (k,) arrays
        Derivatives of g to the area's pressure, Pa, and to the film's flow, m3/s; size of its terms.
    """

    def __init__(
        self,
        restrictors: Sequence[Restrictor],
        masks: list[np.ndarray],
        oil: tuple[float, float],
        flow_scale: float,
        law: PressureTransform | None = None,
    ) -> None:
        self.masks, self.flow_scale, self.law = masks, flow_scale, law
        self.place()
        self.coefficients = np.array([restrictor.coefficients(*oil) for restrictor in restrictors]).T
        a, _, _, c = self.coefficients
        self.pressures = 0.5 * a * c
        self.live = np.ones(len(masks), dtype=bool)
        self.compliance = np.array([r.compressible_volume / r.bulk_modulus for r in restrictors])
        self.before: np.ndarray | None = None
        self.inverse_step = 0.0
        self.by_pressure, self.by_flow, self.size = np.zeros((3, len(masks)))

    def place(self) -> None:
        """Set the vertices of the areas from their masks."""
        areas = np.full(self.masks[0].shape, -1)
        for q, mask in enumerate(self.masks):
            areas[mask] = q
        self.at = np.flatnonzero(areas >= 0)
        self.areas, self.of_vertices = areas, areas.reshape(-1)[self.at]
        self.sizes = np.bincount(self.of_vertices, minlength=len(self.masks))

    def sums(self, field: np.ndarray) -> np.ndarray:
        """Sums (k,) of a field (n, m) over the vertices of every area."""
        return np.bincount(self.of_vertices, field.reshape(-1)[self.at], len(self.masks))

    def transformed(self) -> tuple[np.ndarray, np.ndarray]:
        """Film's unknown (k,), Pa, at the areas' pressures, and its derivatives to the pressures."""
        if self.law is None:
            return self.pressures, np.ones(self.pressures.size)
        q = self.law.transform(self.pressures)
        return q, 1.0 / self.law.fields(q)[1][1]

    def within(self) -> np.ndarray:
        """Return 1 for vertices ``at`` within areas with a balance (., .), else 0."""
        return (self.of_vertices[:, None] == np.flatnonzero(self.live)).astype(float)

    def weights(self) -> np.ndarray:
        """Derivatives of g to the scaled flows, of the areas with a balance."""
        weights: np.ndarray = self.by_flow[self.live] * self.flow_scale
        return weights

    def storage(self) -> np.ndarray:
        """Derivatives of g to the rates of the pressures, of the areas with a balance."""
        return (self.by_flow * self.compliance)[self.live]

    def derivatives(self, by_pressure: np.ndarray) -> np.ndarray:
        """Derivatives (., .) of g to the pressures, Pa, of the areas with a balance, from those of the scaled flows."""
        out: np.ndarray = self.weights()[:, None] * by_pressure + np.diag(self.by_pressure[self.live])
        return out

    def balance(self, inflow: np.ndarray, cavity_pressure: float) -> np.ndarray:
        """Return g (.,) of the areas with a balance; sets ``size``.

        ``inflow`` (n, m): scaled, from the vertices into the film; ``cavity_pressure`` in Pa.
        """
        (a, b, k, c), p = self.coefficients, self.pressures
        flows, sizes = self.flow_scale * self.sums(inflow), self.flow_scale * self.sums(np.abs(inflow))
        store, old = (p * 0.0, p) if self.before is None else (self.compliance * self.inverse_step, self.before)
        self.taken, flows = (a, b, k, c, store, old, p, flows), flows + store * (p - old)
        self.by_flow = b + 2.0 * k * np.abs(flows)
        self.by_pressure = a + self.by_flow * store
        g = a * p + (b + k * np.abs(flows)) * flows - c
        sizes += store * np.abs(p)
        self.size = np.abs(a * p) + (b + k * np.abs(flows)) * sizes + np.abs(c) + 1e-300
        self.live = ((p > cavity_pressure) | (g < 0.0)) & (self.sizes > 0)
        balance: np.ndarray = g[self.live]
        return balance

    def change(self, S: np.ndarray, cavity_pressure: float) -> np.ndarray:
        """Return the change (k,) of the pressures that zeroes the last `balance`, if S is the slope of the flows."""
        change, at = np.zeros(self.pressures.size), self.live
        even = even_balances(*(part[at] for part in self.taken), S * self.flow_scale, cavity_pressure)
        change[at] = even - self.pressures[at]
        return change

    def flows(self) -> np.ndarray:
        """Flow through every restrictor (k,), m3/s, at the present pressures."""
        a, b, k, c = self.coefficients
        left = c - a * self.pressures
        through = np.sign(left) * np.sqrt(np.abs(left) / np.maximum(k, 1e-300))
        return np.where(b > 0.0, left / np.maximum(b, 1e-300), through)


@njit(cache=True)
def even_balances(a, b, k, c, store, old, start, taken, S, lowest):
    """Pressures (k,), at least ``lowest``, at which the balances are zero, with flows ``taken + S (p - start)``.

    ``a``, ``b``, ``k``, ``c``: coefficients of the balances; ``store``, ``old``: V / K over the step, and pressures at
    its start.
    """
    p = start.copy()
    for _ in range(30):  # far more than Newton's method needs; the caller checks the remaining balance
        through = taken + S @ (p - start) + store * (p - old)
        by_flow, g = b + 2.0 * k * np.abs(through), a * p + (b + k * np.abs(through)) * through - c
        J = by_flow.reshape(-1, 1) * S + np.diag(a + by_flow * store)
        for i in range(p.size):
            if p[i] <= lowest and g[i] >= 0.0:
                J[i], J[i, i], g[i] = 0.0, 1.0, 0.0
        before, p = p, np.maximum(p - np.linalg.solve(J, g), lowest)
        if np.all(np.abs(p - before) <= 1e-15 * np.abs(p)):
            break
    return p


def add_border(
    areas: np.ndarray, number: np.ndarray, slopes: np.ndarray, B: np.ndarray, C: np.ndarray, D: np.ndarray
) -> None:
    """Add the symbols of `Reservoirs` from the derivatives of the links' flows and of the storage.

    Parameters
    ----------
    areas : (n, m) int array
        Area with a balance of every vertex, -1 without.
    number : (n, m) int array
        Unknown of every vertex, -1 without.
    slopes : (5, n, m) array
        As `exudyn_ehd.film.banded.workspace.assemble` takes them.
    B, C, D : (k, count), (k, count), (k, k) arrays
        B^T, C and D, changed in place.
    """
    inside = (areas == np.arange(len(D))[:, None, None]).astype(float)
    # outflow of every vertex by the areas' pressures, and outflow of the areas by every vertex's pressure
    leaves, drawn, unknown, flat = slopes[4] * inside, np.zeros_like(inside), number >= 0, (len(D), number.size)
    for axis, (by_own, by_next) in enumerate((slopes[:2], slopes[2:4]), start=1):
        following = np.roll(inside, -1, axis)
        flow, counts = by_own * inside + by_next * following, inside - following
        leaves += flow - np.roll(flow, 1, axis)
        drawn += by_own * counts + np.roll(by_next * counts, 1, axis)
    B[:, number[unknown]] += leaves[:, unknown]
    C[:, number[unknown]] += drawn[:, unknown]
    D += inside.reshape(flat) @ leaves.reshape(flat).T
