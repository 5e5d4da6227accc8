"""Shares of the grid's control volumes that supply areas cover.

The function that is one at a vertex and falls to zero at its neighbours in theta and z, integrated over an area, is the
part of the area that belongs to the vertex; its integral over the whole surface is the control volume. So the parts add
up to the area to rounding, what is linear between the vertices is integrated exactly, and nothing steps where an edge
of a turning area passes a column. Along z an area has the grid's finer integration weights on the rows inside.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.supply.areas import EDGE, CircumferentialGroove, Hole, SupplyArea, axial_span

# Chords that a round hole is integrated over, by the rule of Gauss and Chebyshev: the area is exact with any number;
# with 128 the shares of control volumes inside a hole over ten rows are within 1 % of one.
CHORDS = 128


def area_parts(
    area: SupplyArea, grid: FilmGrid, rows: tuple[np.ndarray, np.ndarray], spin: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return what an area with these `row_parts` covers with the journal at the angle ``spin``, rad.

    Returns
    -------
    share, weight : (n, m) arrays
        Of the control volumes, and of the integration weights.
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
    """Return the shares (m,) of the rows' widths from end to end of an area, and the part of their weights.

    Rows inside have the grid's weights, as have the lands that the outermost rows belong to as well.
    """
    (low, high), z, width = axial_span(area), grid.z * grid.reference_length, grid.width_z
    if not grid.flows_along_z:  # slices of their own
        slack = EDGE * (z[-1] - z[0])
        inside = (z >= low - slack) & (z <= high + slack)
        return inside.astype(float), inside * width
    parts = vertex_parts(z, low, high) / grid.reference_length
    parts[parts < EDGE * width] = 0.0  # rows beside one on the edge
    inside, weight = parts >= width * (1.0 - EDGE), parts.copy()
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


def _columns(grid: FilmGrid, center: float, half: float | np.ndarray) -> np.ndarray:
    """Shares (..., n) of the columns' widths within ``half`` of an angle, rad."""
    step, n = grid.width_x[0], grid.x.size
    low, high = (center - half - grid.x[0]) / step, (center + half - grid.x[0]) / step
    columns = np.arange(math.floor(np.min(low)), math.ceil(np.max(high)) + 1)
    parts = vertex_parts(columns.astype(float), low, high)
    out = np.zeros((*parts.shape[:-1], n))
    out[..., columns % n] = parts  # never all around: there is a film beside every area
    return out


def _disc(hole: Hole, grid: FilmGrid, spin: float) -> np.ndarray:
    """Shares of a round hole, over chords in theta."""
    radius = 0.5 * hole.diameter / grid.reference_length
    angle = math.pi * np.arange(1, CHORDS + 1) / (CHORDS + 1)
    z, half = hole.z / grid.reference_length + radius * np.cos(angle), radius * np.sin(angle)
    rows = np.array([np.interp(z, grid.z, unit, left=0.0, right=0.0) for unit in np.eye(grid.z.size)])
    return (rows * half @ _columns(grid, hole.angle + spin, half)).T * (math.pi / (CHORDS + 1)) / grid.width_z
