"""Prescribed vertices of supply areas, and links that end at an edge between two columns or two rows.

The link from the first free vertex to the last one inside conducts over the distance d to the edge, H^3 / d in place of
H^3 / s with the distance s of the columns or rows, and integrals take the supply's pressure up to an edge between
columns. Where such an edge passes a vertex, its link becomes infinitely short and it has the supply's pressure on
either side: forces and flows are continuous. The control volumes stay those of the grid, so that flows balance as
without supply.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.supply.areas import (
    EDGE,
    AxialGroove,
    CircumferentialGroove,
    Hole,
    Pocket,
    SupplyArea,
    axial_span,
    placed,
)
from exudyn_ehd.film.supply.coverage import area_parts, row_parts
from exudyn_ehd.film.supply.holes import SHORTEST, Circle, circle, strength, strengths


class SupplyMap:
    """Supply areas of one bearing on its film grid.

    Parameters
    ----------
    supply : tuple of SupplyArea
    grid : FilmGrid
        Its arrays ``fixed`` and ``weight`` are those of the areas from now on.
    around : bool
        Whether there is pressure flow in theta.

    Attributes
    ----------
    grid : FilmGrid
        The same with `FilmGrid.lands`, and with `FilmGrid.cuts` if there are others than circumferential grooves.
    masks : list of (n, m) bool arrays
        Vertices of every area at its last position; a shared vertex counts for the first area.
    parts : list of (n, m) arrays
        Scaled area of every one at the vertices; a place that two cover counts for the first.
    land : (n, m) array
        Shares of the control volumes outside of all areas.
    rotating : bool
        Whether an area turns with the journal.
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
        """Prescribed vertices, cut links and weights at the present spin."""
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
        """A hole on the grid at the present spin, the column next to its centre, and the factor of its links."""
        g, step = self.grid, float(self.grid.width_x[0])
        center = (area.angle + (self.spin if area.rotating else 0.0) - g.x[0]) / step
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
        """Links of a hole to the film.

        A vertex with a hole that is smaller than what it feeds like has not the hole's pressure around: integrals take,
        as the flow does, the mean of its neighbours' for what its links conduct less.
        """
        g, n = self.grid, self.grid.x.size
        assert g.cuts is not None
        x, z = g.link_x[0] * g.width_z, np.append(g.link_z, 0.0) * g.width_x[0]
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
    """Mark the vertices inside an area in mask (n, m), edges included, and take down in ``share`` (2, n, m) what part
    of the links in theta and z to their neighbours is film."""
    low, high = axial_span(area)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    rows = np.ones(grid.z.size, dtype=np.bool_)
    if math.isfinite(half):
        rows = np.abs(grid.z * grid.reference_length - middle) <= half * (1.0 + EDGE)
    if isinstance(area, CircumferentialGroove):
        mask[:, rows] = True
        return
    n, step = grid.x.size, grid.width_x[0]
    center, half = (area.angle + spin - grid.x[0]) / step, 0.5 * area.width_angle / step
    first, last = math.ceil(center - half - EDGE), math.floor(center + half + EDGE)
    inside = np.arange(first, last + 1) % n
    mask[inside[:, None], rows] = True
    if inside.size:
        for link, film in (((first - 1) % n, center - half - first + 1), (last % n, last + 1 - center - half)):
            share[0, link, rows] = np.minimum(share[0, link, rows], film)
    covered = np.flatnonzero(rows)
    if not (covered.size and math.isfinite(low)):
        return
    # of a column next to an edge as much as its control volume lies within: nothing steps where it is passed
    columns = np.arange(first - 1, last + 2)
    within = np.clip(np.minimum(columns + 0.5, center + half) - np.maximum(columns - 0.5, center - half), 0.0, 1.0)
    z, top = grid.z * grid.reference_length, covered[-1]
    for at, edge, free in ((covered[0] - 1, low, covered[0] - 1), (top, high, top + 1)):
        film = abs(z[free] - edge) / (z[at + 1] - z[at]) if 0 <= at < z.size - 1 else 1.0
        if film < 1.0 - EDGE:
            part = 1.0 / (1.0 + within * (1.0 / film - 1.0))
            np.minimum.at(share[1, :, at], columns % n, part)


def cut_links(covered: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`FilmGrid.cuts` (2, n, m) of links from ``covered`` to free vertices, of which ``share`` (2, n, m) is film, and
    the columns' widths (n, m) over those of the grid.

    Integrals, and flows in z, take the supply's pressure up to the edge: the free column stands for s (1 - s) of a
    distance s less (the trapezoidal rule has (1 - s) / 2, the same in the mean; here nothing is left where the edge
    passes a vertex), the last covered one for twice that more, the one before for that less, which keeps middles.
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
