"""Supply areas on the grid: prescribed vertices, covered volumes, links that end at an edge, and shear of their oil.

Links end at an edge between two columns or two rows.

The link from the first free vertex to the last one inside conducts over the distance d to the edge, H^3 / d in place of
H^3 / s with the distance s of the columns or rows, and integrals take the supply's pressure up to an edge between
columns. When such an edge passes a vertex, the link becomes infinitely short and the vertex has the supply's pressure
before and after, so that forces and flows are continuous. The control volumes remain those of the grid, so that flows
balance as without supply.

Shares of the grid's control volumes that supply areas cover
------------------------------------------------------------
The function that is one at a vertex and falls to zero at its neighbours in theta and z, integrated over an area, is the
part of the area that belongs to the vertex; its integral over the whole surface is the control volume. So the parts add
up to the area to rounding, and fields that are linear between the vertices are integrated exactly. The parts are
continuous when an edge of a turning area passes a column. Along z, rows inside an area have the grid's integration
weights, which are of higher order.

Shear of the oil in supply areas: flow that returns within a recess
-------------------------------------------------------------------
The sliding surface at y = d, the recess's depth, moves oil towards one end of the recess. This oil flows back above the
bottom at y = 0, since far less of it passes over the adjacent lands. Laminar flow with no net flow, ``int u dy = 0``,
is

    u = U (3 y^2 / d^2 - 2 y / d),      tau = mu du/dy = 4 mu U / d at the surface.

The bottom is pulled backwards by 2 mu U / d. The pressure that drives the flow back, dp/dx = 6 mu U / d^2, presses on
the recess's end walls by 6 mu U / d per area. So the force per area on the side with the recess is 4 mu U / d in the
direction of U, and that on the other side is the opposite. This pressure rises by 6 mu U l / d^2 over the length l; the
uniform pressure of the supply omits this rise. The friction of the side walls is omitted, too. A circumferential groove
has no end walls. In one much wider than deep the stress would be mu U / d; at the usual widths of two to three depths
the side walls make it about three times as large. So such grooves have the same law.

Turbulent: by Hirs' bulk flow the stress on a wall is ``n rho u^2 / 2 (rho u d / mu)^m`` with the wall's speed u against
the mean flow. In a recess the mean flow rests, so that u = U at the sliding surface,

    tau = n / 2 Re^(1 + m) mu U / d,      Re = rho |U| d / mu,

with n = 0.066, m = -0.25. It acts where it is larger than the laminar stress, above Re = 600. As in a turbulent film, U
is the sliding about the axis alone.

The oil has the viscosity of its temperature, without pressure and without thinning: its shear rate is small.

Sources: W. B. Rowe, Hydrostatic, Aerostatic and Hybrid Bearing Design (2012), for the laminar stress; G. G. Hirs, J.
Lubrication Technology 95 (1973) 137, for the law of turbulent walls; J. N. Shinkle and K. G. Hornung, J. Basic
Engineering 87 (1965) 163, for turbulent recesses without net flow.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.turbulence import Hirs
from exudyn_ehd.film.supply.areas import (
    SHORTEST,
    AxialGroove,
    Circle,
    CircumferentialGroove,
    Hole,
    Pocket,
    SupplyArea,
    axial_span,
    circle,
    placed,
    strength,
    strengths,
)
from exudyn_ehd.status import ROUNDING

# Number of chords for the integration over a round hole, by the rule of Gauss and Chebyshev. The area is exact with any
# number; with 128 the shares of control volumes inside a hole over ten rows are within 1 % of one. More chords reduce
# this error.
CHORDS = 128


def area_parts(
    area: SupplyArea, grid: FilmGrid, rows: tuple[np.ndarray, np.ndarray], spin: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return what an area with these `row_parts` covers with the journal at the angle ``spin``, rad.

    Returns
    -------
    share, weight : (n, m) arrays
        Covered shares of the control volumes, and covered parts of the integration weights.
    """
    turned = spin if area.rotating else 0.0
    if isinstance(area, Hole):
        share = np.clip(_disc(area, grid, turned), 0.0, 1.0)
        return share, share * grid.area
    columns = np.ones(grid.x.size)
    if not isinstance(area, CircumferentialGroove):
        columns = _columns(grid, area.angle + turned, 0.5 * area.width_angle)
    return np.outer(columns, rows[0]), np.outer(columns * grid.width_x, rows[1])


def row_parts(area: SupplyArea, grid: FilmGrid) -> tuple[np.ndarray, np.ndarray]:
    """Return the shares (m,) of the rows' widths within an area's axial span, and the parts of their weights within.

    Rows inside have the grid's weights. The two outermost rows get the rest, so that the weights add up to the span.
    """
    (low, high), z, width = axial_span(area), grid.z * grid.reference_length, grid.width_z
    if not grid.flows_along_z:  # slices of their own
        slack = ROUNDING * (z[-1] - z[0])
        inside = (z >= low - slack) & (z <= high + slack)
        return inside.astype(float), inside * width
    parts = vertex_parts(z, low, high) / grid.reference_length
    parts[parts < ROUNDING * width] = 0.0  # rows beside one on the edge
    inside, weight = parts >= width * (1.0 - ROUNDING), parts.copy()
    reached = np.flatnonzero(parts)
    inside[reached[[0, -1]]] = False
    weight[inside] = grid.weight_z[inside]
    weight[reached[[0, -1]]] += 0.5 * (parts.sum() - weight.sum())
    return parts / width, weight


def vertex_parts(places: np.ndarray, low: float | np.ndarray, high: float | np.ndarray) -> np.ndarray:
    """Integrals (..., m) from low to high of the functions that are one at one of the ``places`` and linear between."""
    step = np.diff(places)
    first, last = (np.clip((np.asarray(edge)[..., None] - places[:-1]) / step, 0.0, 1.0) for edge in (low, high))
    after = 0.5 * step * (last**2 - first**2)
    out = np.zeros((*first.shape[:-1], places.size))
    out[..., :-1] += step * (last - first) - after
    out[..., 1:] += after
    return out


def column_of(grid: FilmGrid, angle: float) -> tuple[float, float]:
    """Place of an angle, rad, among the columns of a ring or of the arc that it lies on, and their distance, rad."""
    if not grid.edges.size:
        step = float(grid.width_x[0])
        return (angle - float(grid.x[0])) / step, step
    first, last = grid.edges.T
    turned, extent = (angle - grid.x[first]) % (2.0 * math.pi), grid.x[last] - grid.x[first]
    k = int(np.argmin(np.where(turned <= extent, turned, math.inf)))
    step = float(extent[k] / (last[k] - first[k]))
    return float(first[k] + turned[k] / step), step


def _columns(grid: FilmGrid, center: float, half: float | np.ndarray) -> np.ndarray:
    """Shares (..., n) of the columns' widths within ``half`` of an angle, rad."""
    (place, step), n = column_of(grid, center), grid.x.size
    low, high = place - half / step, place + half / step
    columns = np.arange(math.floor(np.min(low)), math.ceil(np.max(high)) + 1)
    parts = vertex_parts(columns.astype(float), low, high)
    out = np.zeros((*parts.shape[:-1], n))
    out[..., columns % n] = parts  # an area never covers a whole ring of columns
    return out


def _disc(hole: Hole, grid: FilmGrid, spin: float) -> np.ndarray:
    """Shares of a round hole, over chords in theta."""
    radius = 0.5 * hole.diameter / grid.reference_length
    angle = math.pi * np.arange(1, CHORDS + 1) / (CHORDS + 1)
    z, half = hole.z / grid.reference_length + radius * np.cos(angle), radius * np.sin(angle)
    rows = np.array([np.interp(z, grid.z, unit, left=0.0, right=0.0) for unit in np.eye(grid.z.size)])
    return (rows * half @ _columns(grid, hole.angle + spin, half)).T * (math.pi / (CHORDS + 1)) / grid.width_z


class SupplyMap:
    """Supply areas of one bearing on its film grid.

    Parameters
    ----------
    supply : tuple of SupplyArea
    grid : FilmGrid
        The map changes its arrays ``fixed`` and ``weight`` to those with the areas.
    around : bool
        Whether there is pressure flow in theta.

    Attributes
    ----------
    grid : FilmGrid
        The same grid with `FilmGrid.lands`, and with `FilmGrid.cuts` if not all areas are circumferential grooves.
    masks : list of (n, m) bool arrays
        Vertices of every area at its last position; a shared vertex counts for the first area.
    parts : list of (n, m) arrays
        Scaled part of every area at the vertices; a place that two areas cover counts for the first.
    land : (n, m) array
        Shares of the control volumes outside of all areas.
    rotating : bool
        Whether an area turns with the journal.
    fed : (areas,) bool array
        Areas with a restrictor.
    """

    def __init__(self, supply: tuple[SupplyArea, ...], grid: FilmGrid, around: bool = True) -> None:
        self.around = around
        whole = all(isinstance(area, CircumferentialGroove) for area in supply)
        cuts = None if whole else np.ones((2, *grid.shape))
        self.grid = dataclasses.replace(grid, cuts=cuts, lands=grid.weight.copy())
        # without axial flow grooves have no ends
        length = (grid.z[-1] - grid.z[0]) * grid.reference_length
        self.supply = placed(supply, length) if grid.flows_along_z else supply
        self.rotating = any(area.rotating for area in supply)
        self.fed = np.array([area.supply is not None for area in supply])
        self.ends, self.plain_weight = grid.fixed.copy(), grid.weight.copy()
        self.masks = [np.zeros(grid.shape, dtype=np.bool_) for _ in supply]
        self.rows = [row_parts(area, self.grid) for area in self.supply]
        self.parts, self.land = [np.zeros(grid.shape) for _ in supply], np.ones(grid.shape)
        self.spin = 0.0
        self._place()

    def turn(self, spin: float) -> bool:
        """Move the rotating areas to the spin angle, rad; True if they moved."""
        if not self.rotating or spin == self.spin:
            return False
        self.spin = spin
        self._place()
        return True

    def _place(self) -> None:
        """Set prescribed vertices, cut links and weights for the present spin."""
        g = self.grid
        share = np.ones((2, *g.shape))
        g.fixed[:] = self.ends
        holes: list[tuple[Circle, int, float]] = []
        for area, mask in zip(self.supply, self.masks, strict=True):
            mask[:] = False
            if isinstance(area, Hole):
                holes.append(self._hole(area))
                hole, column, _ = holes[-1]
                mask[(hole.covered[:, 0] + column) % g.x.size, hole.covered[:, 1]] = True
            else:
                cover(area, g, self.spin if area.rotating else 0.0, mask, share)
            mask &= ~g.fixed
            g.fixed[mask] = True
        if g.cuts is not None:
            g.cuts[:], width = cut_links(g.fixed & ~self.ends, share)
            g.weight[:] = self.plain_weight * width
            for hole, column, factor in holes:
                self._cut_hole(hole, column, factor)
        self.land[:], g.shear_weight[:] = 1.0, self.plain_weight
        for area, rows, part in zip(self.supply, self.rows, self.parts, strict=True):
            covers, weight = area_parts(area, g, rows, self.spin)
            part[:] = self.land * weight
            self.land[:] *= 1.0 - covers
            g.shear_weight[:] -= part

    def _hole(self, area: Hole) -> tuple[Circle, int, float]:
        """Return a hole on the grid at the present spin, the column nearest its centre, and the factor of its links."""
        g, (center, step) = self.grid, column_of(self.grid, area.angle + (self.spin if area.rotating else 0.0))
        radius, z = 0.5 * area.diameter / (step * g.reference_length), g.z - area.z / g.reference_length
        rows = tuple(((z - z[np.argmin(np.abs(z))]) / step).tolist())
        column = round(center)
        offset, factor = center - column, 1.0
        if self.around and area.rotating:
            factor = float(np.interp(offset, *strengths(rows, radius)))
        elif self.around:
            factor = strength(rows, radius, offset)
        return circle(rows, radius, offset), column, factor

    def _cut_hole(self, hole: Circle, column: int, factor: float) -> None:
        """Set the links of a hole to the film.

        If a hole is smaller than the one that a vertex stands for without a factor, its links conduct less. The mean
        pressure around the vertex is then below the hole's: integrals use the mean of the neighbours' pressures for the
        same share by which the conductance is reduced.
        """
        g, n = self.grid, self.grid.x.size
        assert g.cuts is not None
        x, z = g.link_x[column % n] * g.width_z, np.append(g.link_z, 0.0) * g.width_x[column % n]
        total = 2.0 * x + z + np.append(0.0, z[:-1])
        for (axis, i, j), conducts in zip(hole.links.tolist(), hole.factors(factor).tolist(), strict=True):
            first = (i + column) % n, j
            last = ((i + column + 1) % n, j) if axis == 0 else (first[0], j + 1)
            if g.fixed[first] and g.fixed[last]:
                continue
            g.cuts[axis][first] *= conducts
            inner, outer = (first, last) if g.fixed[first] else (last, first)
            share = max(0.0, 1.0 - conducts) * (x[j] if axis == 0 else z[j]) / total[inner[1]]
            taken = share * self.plain_weight[inner]
            g.weight[inner] -= taken
            g.weight[outer] += taken

    def pressures(self) -> np.ndarray:
        """Gauge pressure of every area, Pa."""
        return np.array([area.pressure for area in self.supply])

    def prescribe(self, values: np.ndarray, P: np.ndarray) -> None:
        """Write one value per area into the field P (n, m)."""
        for mask, value in zip(self.masks, values, strict=True):
            P[mask] = value

    def flows(self, inflow: np.ndarray) -> np.ndarray:
        """Flow from every area into the film (areas,), in the unit of ``inflow`` (n, m)."""
        return np.array([float(np.sum(inflow[area])) for area in self.masks])


def cover(
    area: AxialGroove | CircumferentialGroove | Pocket, grid: FilmGrid, spin: float, mask: np.ndarray, share: np.ndarray
) -> None:
    """Mark the vertices inside an area, edges included, in mask (n, m), and set the film's share of cut links.

    ``share`` (2, n, m): part of the links in theta and z, to the neighbours of these vertices, that lies in the film.
    """
    low, high = axial_span(area)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    rows = np.ones(grid.z.size, dtype=np.bool_)
    if math.isfinite(half):
        rows = np.abs(grid.z * grid.reference_length - middle) <= half * (1.0 + ROUNDING)
    if isinstance(area, CircumferentialGroove):
        mask[:, rows] = True
        return
    n, (center, step) = grid.x.size, column_of(grid, area.angle + spin)
    half = 0.5 * area.width_angle / step
    first, last = math.ceil(center - half - ROUNDING), math.floor(center + half + ROUNDING)
    inside = np.arange(first, last + 1) % n
    mask[inside[:, None], rows] = True
    if inside.size:
        for link, film in (((first - 1) % n, center - half - first + 1), (last % n, last + 1 - center - half)):
            share[0, link, rows] = np.minimum(share[0, link, rows], film)
    covered = np.flatnonzero(rows)
    if not (covered.size and math.isfinite(low)):
        return
    # a column next to an edge counts by the part of its control volume within, so that the result is continuous
    columns = np.arange(first - 1, last + 2)
    within = np.clip(np.minimum(columns + 0.5, center + half) - np.maximum(columns - 0.5, center - half), 0.0, 1.0)
    z, top = grid.z * grid.reference_length, covered[-1]
    for at, edge, free in ((covered[0] - 1, low, covered[0] - 1), (top, high, top + 1)):
        film = abs(z[free] - edge) / (z[at + 1] - z[at]) if 0 <= at < z.size - 1 else 1.0
        if film < 1.0 - ROUNDING:
            part = 1.0 / (1.0 + within * (1.0 / film - 1.0))
            np.minimum.at(share[1, :, at], columns % n, part)


def cut_links(covered: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`FilmGrid.cuts` (2, n, m) of links from ``covered`` to free vertices, of which ``share`` (2, n, m) is film, and
    the columns' widths (n, m) over those of the grid.

    Integrals, and flows in z, use the supply's pressure up to the edge. With the film's share s of a link, the width of
    the free column is reduced by s (1 - s) column distances. The trapezoidal rule would give (1 - s) / 2, which has the
    same mean over s but is not zero when the edge passes a vertex. The last covered column becomes wider by twice that,
    and the column before it narrower by once that, which keeps the centre of the widths.
    """
    n, cuts, width = len(covered), np.ones_like(share), np.ones(covered.shape)
    i, j = np.nonzero(covered != np.roll(covered, -1, axis=0))
    s = share[0, i, j]
    cuts[0, i, j] = 1.0 / np.maximum(s, SHORTEST)
    # from the last covered column to the free one
    ends = covered[i, j]
    last, way = np.where(ends, i, (i + 1) % n), np.where(ends, 1, -1)
    free, inner = (last + way) % n, (last - way) % n
    moved = s * (1.0 - s)
    before = moved * covered[inner, j]
    for column, more in ((free, -moved), (last, moved + before), (inner, -before)):
        np.add.at(width, (column, j), more)
    low, high = width[:, :-1], width[:, 1:]
    wide = np.where(abs(low - 1.0) > abs(high - 1.0), low, high)
    cuts[1, :, :-1] = wide / np.maximum(share[1, :, :-1], SHORTEST)
    return cuts, width


# Stress tau of the laminar flow over mu U / d.
RECIRCULATION = 4.0


class RecessShear(NamedTuple):
    """Shear in recesses at the vertices, in units of that between concentric surfaces.

    density : (n, m) array, scaled area times shear
    by_spin : (n, m) array, its derivative to the journal's relative spin, s/rad
    """

    density: np.ndarray
    by_spin: np.ndarray


def recess_shear(
    depths: list[float | None],
    parts: list[np.ndarray],
    clearance: float,
    spin: float,
    oil: tuple[np.ndarray, np.ndarray],
) -> RecessShear | None:
    """Shear in the areas that have a depth; None if no area has one.

    Parameters
    ----------
    depths : list of float or None
        Depth of every area, m; None: so deep that its shear is omitted.
    parts : list of (n, m) arrays
        Scaled area of every one at the vertices.
    clearance, spin : float
        m, rad/s.
    oil : two arrays
        Viscosity over the reference, and Reynolds number per depth and spin, s/(m rad); floats or (n, m).
    """
    viscosity, per_depth = oil
    found = [(depth, part) for depth, part in zip(depths, parts, strict=True) if depth is not None]
    if not found:
        return None
    law = Hirs()
    power = 1.0 + law.exponent
    out = RecessShear(*np.zeros((2, *parts[0].shape)))
    for depth, part in found:
        turbulent = 0.5 * law.coefficient * (per_depth * depth * abs(spin)) ** power
        laminar = turbulent <= RECIRCULATION
        sheared = clearance / depth * viscosity * part
        out.density[:] += sheared * np.maximum(RECIRCULATION, turbulent)
        out.by_spin[:] += sheared * np.where(laminar, 0.0, power * turbulent / (spin or 1.0))
    return out
