"""Rows of the film's grid at the axial edges of supply areas, a column on a hole, and checks of supply areas.

Circumferential grooves divide the film into lands, and the grid's intervals are distributed over the lands by their
lengths. In a land with edges of other areas, every part between two edges gets as many intervals as the stretched grid
has there. Parts without an area, which are the film between areas or at an end, get at least four.

With a cavitation model that conserves oil, the band of oil downstream of an area is as wide as the control volumes of
the area's rows. So rows are then placed such that control volumes end on the edges of areas, also on those of holes
(`meeting_rows`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from exudyn_ehd.film.grid import exact_weights, rows_between
from exudyn_ehd.film.supply.areas import (
    CircumferentialGroove,
    Hole,
    SupplyArea,
    axial_span,
    outline,
    placed,
)
from exudyn_ehd.film.supply.cuts import RECIRCULATION
from exudyn_ehd.status import ROUNDING, InputError

# Least number of intervals of a land, of a part of a land without an area, and of an arc before and behind a step.
LEAST = 4
# Additional intervals for short parts are taken from a land's longest part, which keeps at least this number.
KEPT = 6


def supply_rows(
    supply: Sequence[SupplyArea], radius: float, length: float, n_z: int, stretch: float
) -> tuple[np.ndarray, np.ndarray] | None:
    """Axial vertices over R with rows on the edges of `placed` areas, and their weights; None without areas."""
    if not supply:
        return None
    half, grooves = 0.5 * length, groove_spans(supply)
    bounds = [-half, *(z for span in grooves for z in span), half]
    total = sum(high - low for low, high in zip(bounds[::2], bounds[1::2], strict=True))
    edges, counts = [-half], []
    for k, (low, high) in enumerate(zip(bounds[::2], bounds[1::2], strict=True)):
        if k > 0:
            edges.append(low)
            counts.append(1)
        share = (n_z + 2 * len(grooves)) * (high - low) / total
        cuts = _edges_on(supply, low, high, length)
        edges += cuts[1:]
        counts += [max(LEAST, math.ceil(share - ROUNDING))] if len(cuts) == 2 else _parts(supply, cuts, share, stretch)
    # if grooves are the only areas: in a groove
    alone = grooves and len(counts) == 2 * len(grooves) + 1
    middle = 1 + 2 * int(np.argmin([abs(sum(span)) for span in grooves])) if alone else _largest(counts, edges)
    if np.allclose(edges, -np.array(edges[::-1]), rtol=0.0, atol=ROUNDING * length):
        # parts of equal length may have got different numbers; symmetric halves must get symmetric rows
        counts, middle = [max(pair) for pair in zip(counts, counts[::-1], strict=True)], len(counts) // 2
    # an even number, so that symmetric films have a row in the middle
    counts[middle] += sum(counts) % 2
    return rows_between([z / radius for z in edges], counts, stretch)


def meeting_rows(
    supply: Sequence[SupplyArea], radius: float, length: float, n_z: int, stretch: float, columns: int
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return `supply_rows` with control volumes that end on the edges of areas.

    Every edge of a groove along the axis or of a pocket gets a row on either side. A hole gets an odd number of rows,
    whose control volumes together are as wide as the hole. Rows are unchanged where other rows prevent this.
    """
    found = supply_rows(supply, radius, length, n_z, stretch)
    if found is None or all(isinstance(area, CircumferentialGroove) for area in supply):
        return found
    z, same = radius * found[0], ROUNDING * length
    near = np.minimum(np.diff(z, prepend=-math.inf), np.diff(z, append=math.inf))
    lasting = [-0.5 * length, 0.5 * length, *(edge for span in groove_spans(supply) for edge in span)]
    edges = {x for a in supply if not isinstance(a, (CircumferentialGroove, Hole)) for x in axial_span(a)}
    for edge in sorted(edges):
        k = int(np.argmin(np.abs(z - edge)))
        if abs(z[k] - edge) <= same and not _taken(lasting, edge, edge, same):
            lasting += [edge - near[k] / 2.0, edge + near[k] / 2.0]
    rows = [x for x in z if not any(abs(x - edge) <= same for edge in edges)] + lasting
    holes = [area for area in supply if isinstance(area, Hole)]
    for hole in holes:
        inside, width = _rows_of_hole(hole, near[int(np.argmin(np.abs(z - hole.z)))], 2.0 * math.pi * radius / columns)
        around = inside[0] - width, inside[-1] + width
        others = [*lasting, *(other.z for other in holes if other.z != hole.z)]
        if not _taken(others, around[0] - 0.4 * width, around[1] + 0.4 * width, 0.0):
            rows = [x for x in rows if not around[0] - 0.4 * width < x < around[1] + 0.4 * width]
            rows += [*inside, *around]
            lasting += [*inside, *around]
    rows = sorted({x for x in rows if abs(x) <= 0.5 * length})
    z = np.array([x for k, x in enumerate(rows) if k == 0 or x - rows[k - 1] > same])
    fed = [k for k, x in enumerate(z) if any(low <= x <= high for low, high in map(axial_span, supply))]
    # areas may reach the ends
    while (few := 0 < fed[0] < LEAST) or 0 < z.size - 1 - fed[-1] < LEAST or z.size % 2 == 0:
        low, high = (0, fed[0]) if few else (fed[-1] if 0 < z.size - 1 - fed[-1] < LEAST else 0, z.size - 1)
        middles, widths = 0.5 * (z[1:] + z[:-1])[low:high], np.diff(z)[low:high]
        # among equal ones the one nearest to the mid-plane, then the one on the side of the mean of all rows
        order = -middles * np.sign(np.round(z.sum() / length, 9)), np.abs(middles), -np.round(widths / length, 9)
        k = low + int(np.lexsort(order)[0])
        z = np.insert(z, k + 1, 0.5 * (z[k] + z[k + 1]))
        fed = [j + (j > k) for j in fed]
    if z.size == found[0].size and np.allclose(z, radius * found[0], rtol=0.0, atol=same):
        return found
    z *= 2.0 / length
    ends = np.concatenate(([z[0]], 0.5 * (z[1:] + z[:-1]), [z[-1]]))
    scale = 0.5 * length / radius
    return scale * z, scale * exact_weights(z, np.diff(ends), 4, step=1)


def _taken(lasting: Sequence[float], low: float, high: float, same: float) -> bool:
    return any(low - same <= x <= high + same for x in lasting)


def _rows_of_hole(hole: Hole, spacing: float, column: float) -> tuple[np.ndarray, float]:
    """Rows within a hole, and the width of their control volumes.

    Their number is that of the grid there, limited so that the outermost rows reach a column within the hole.
    """
    r = 0.5 * hole.diameter
    count = 2 * round(r / spacing) + 1
    while count > 1 and (r * (1.0 - 1.0 / count)) ** 2 + (0.5 * column) ** 2 > r * r:
        count -= 2
    width = hole.diameter / count
    return hole.z + width * (np.arange(count) - count // 2), width


def column_of_hole(supply: Sequence[SupplyArea], n_theta: int) -> float:
    """Shift of the grid, less than a column, that places a column on the housing's first hole; 0 without a hole."""
    holes = (area for area in supply if isinstance(area, Hole) and not area.rotating)
    return next((hole.angle % (2.0 * math.pi / n_theta) for hole in holes), 0.0)


def groove_spans(supply: Sequence[SupplyArea]) -> list[tuple[float, float]]:
    """Axial extents, m, of the circumferential grooves from end to end of the bearing."""
    return sorted(axial_span(a) for a in supply if isinstance(a, CircumferentialGroove))


def _edges_on(supply: Sequence[SupplyArea], low: float, high: float, length: float) -> list[float]:
    """Axial edges of the areas on the land from low to high, and centres of holes; its ends are the first and last."""
    found = {low, high}
    for area in supply:
        places = (area.z,) if isinstance(area, Hole) else axial_span(area)
        found.update(z for z in places if low < z < high)
    edges: list[float] = []
    for z in sorted(found):
        if not edges or z - edges[-1] > ROUNDING * length:
            edges.append(z)
    edges[-1] = high
    return edges


def _parts(supply: Sequence[SupplyArea], edges: list[float], share: float, stretch: float) -> list[int]:
    """Intervals between the edges on a land with ``share`` of the grid's."""
    middle, half, quarter = 0.5 * (edges[0] + edges[-1]), 0.5 * (edges[-1] - edges[0]), 0.5 * math.pi * stretch
    s = np.clip((np.array(edges) - middle) / half, -1.0, 1.0)
    if stretch > 0.0:
        s = np.arcsin(s * math.sin(quarter)) / quarter
    spans = [axial_span(a) for a in supply if not isinstance(a, (CircumferentialGroove, Hole))]
    counts = []
    for k, part in enumerate(0.5 * share * np.diff(s)):
        z = 0.5 * (edges[k] + edges[k + 1])
        # with two intervals the pressure next to the area is integrated to third order
        least = (2 if part > 0.3 else 1) if any(low < z < high for low, high in spans) else LEAST
        counts.append(max(least, math.ceil(part - ROUNDING)))
    while sum(counts) > share + 2.0:
        k = _largest(counts, edges)
        if counts[k] <= KEPT:
            break
        counts[k] -= 1
    return counts


def _largest(counts: Sequence[int], edges: Sequence[float]) -> int:
    """Index of the part with most intervals; a mirrored layout has the mirrored part.

    Among equal ones it is the part nearest to the mid-plane, then the one on the side of the mean of all edges.
    """
    places = np.array(edges) / (edges[-1] - edges[0])
    centres = np.round(0.5 * (places[1:] + places[:-1]), 9)
    return int(np.lexsort((-centres * np.sign(np.round(places.sum(), 9)), np.abs(centres), -np.array(counts)))[0])


# Shortest film next to a groove or at an end, over the bearing's length.
SHORTEST_LAND = 1e-3
# Least number of intervals of the film between two areas in theta.
LEAST_BETWEEN = 3


def check_supply(
    supply: Sequence[SupplyArea],
    radius: float,
    length: float,
    n_theta: int,
    around: bool,
    end_pressures: tuple[float, float] | None,
) -> None:
    """Raise `InputError` for areas that the film does not support.

    Parameters
    ----------
    supply : sequence of SupplyArea
    radius, length : float
        R and L in m.
    n_theta : int
        Columns of the film's grid.
    around : bool
        Whether there is pressure flow in theta.
    end_pressures : two floats or None
        Pa; None: without axial flow, where areas reach from end to end.
    """
    for k, area in enumerate(supply):
        _check_extent(k, area, radius, length)
    areas = placed(tuple(supply), length)
    step = 2.0 * math.pi / n_theta
    for k, area in enumerate(areas):
        low, high = axial_span(area)
        if low >= 0.5 * length or high <= -0.5 * length:
            raise InputError(
                f"JournalBearing.supply[{k}]: {area!r} lies outside the bearing, whose z is within +-{0.5 * length:g} "
                "m; check its position and size."
            )
        _check_columns(k, area, radius, step, around)
        if end_pressures is not None:
            _check_ends(k, area, length, end_pressures)
    _check_lands(areas, length)
    for k, area in enumerate(areas):
        for i in range(k):
            _check_pair(i, areas[i], k, area, radius, step)


def check_on_arcs(supply: Sequence[SupplyArea], arcs: np.ndarray, radius: float, n_theta: int) -> None:
    """Raise `InputError` for areas that do not lie on one arc of the bore; ``arcs`` (k, 2): start and extent, rad."""
    step = 2.0 * math.pi / n_theta
    for k, area in enumerate(supply):
        angle, _, half, _, reach = outline(area, radius)
        away = (half + reach) / radius + LEAST_BETWEEN * step
        on = np.any((angle - away - arcs[:, 0]) % (2.0 * math.pi) <= arcs[:, 1] - 2.0 * away)
        if not on or area.rotating or (reach == 0.0 and 2.0 * half < step * radius):
            raise InputError(
                f"JournalBearing.supply[{k}]: on arcs an area must lie in the bore of one arc, "
                f"{LEAST_BETWEEN * step:.3g} rad off its edges, and be at least {step:.3g} rad wide if it is no hole, "
                f"got {area!r}; oil between arcs has leading_pressure and trailing_pressure."
            )


def check_depths(supply: Sequence[SupplyArea], clearance: float) -> None:
    """Raise `InputError` for areas too shallow for a uniform pressure, whose shear would be that of a film."""
    least = RECIRCULATION * clearance
    for k, area in enumerate(supply):
        if area.depth is not None and area.depth < least:
            raise InputError(
                f"JournalBearing.supply[{k}].depth must be at least {RECIRCULATION:g} radial clearances, {least:g} m, "
                f"for a uniform pressure, got {area.depth:g} m; give a shallower one as a profile, and an area where "
                "it is fed."
            )


def _check_extent(k: int, area: SupplyArea, radius: float, length: float) -> None:
    """Raise `InputError` for holes wider than the journal, and for other areas far longer than the bearing."""
    _, _, _, half, reach = outline(area, radius)
    if reach > radius or length < half < math.inf:
        size = f"diameter of {2.0 * radius:g}" if isinstance(area, Hole) else f"length of {length:g}"
        raise InputError(
            f"JournalBearing.supply[{k}]: {area!r} is larger than the bearing with its {size} m; all lengths are in m."
        )


def _check_columns(k: int, area: SupplyArea, radius: float, step: float, around: bool) -> None:
    """Raise `InputError` for areas that fit between two columns, and for grooves that leave no film around."""
    if isinstance(area, CircumferentialGroove):
        return
    width = area.diameter / radius if isinstance(area, Hole) else area.width_angle
    low, high = (area.angle - 0.5 * width) / step, (area.angle + 0.5 * width) / step
    if isinstance(area, Hole) and around and not area.rotating:
        return  # a hole of any size feeds at least the nearest vertex
    between = width < step if area.rotating else math.floor(high + ROUNDING) < math.ceil(low - ROUNDING)
    if between:
        lies = "is narrower than the step between" if area.rotating else "lies between"
        raise InputError(
            f"JournalBearing.supply[{k}]: {area!r} {lies} two "
            f"columns of the film's grid; n_theta={math.ceil(2.0 * math.pi / width)} would do, or make it wider."
        )
    _require_between(f"JournalBearing.supply[{k}]: the film beside {area!r}", 2.0 * math.pi - width, step)


def _require_between(what: str, angle: float, step: float) -> None:
    if angle < LEAST_BETWEEN * step * (1.0 - ROUNDING):
        raise InputError(
            f"{what} spans {angle:.4g} rad, less than {LEAST_BETWEEN} intervals of its grid; "
            f"n_theta={math.ceil(LEAST_BETWEEN * 2.0 * math.pi / angle)} would do, or leave no film there."
        )


def _check_ends(k: int, area: SupplyArea, length: float, end_pressures: tuple[float, float]) -> None:
    """Raise `InputError` for areas that reach an end whose pressure is another one."""
    low, high = axial_span(area)
    for land, pressure in zip((low + 0.5 * length, 0.5 * length - high), end_pressures, strict=True):
        if land < SHORTEST_LAND * length and (area.supply is not None or pressure != area.pressure):
            raise InputError(
                f"JournalBearing.supply[{k}]: between {area!r} and the bearing's end, which has {pressure:g} Pa, there "
                f"must be a land of at least {SHORTEST_LAND:g} of the bearing's length {length:g} m; make it shorter, "
                "or give both one pressure."
            )


def _check_lands(supply: Sequence[SupplyArea], length: float) -> None:
    """Raise `InputError` for circumferential grooves that leave no film next to or between them."""
    before = -0.5 * length
    for low, high in [*groove_spans(supply), (0.5 * length, math.inf)]:
        if low - before < SHORTEST_LAND * length:
            raise InputError(
                f"JournalBearing.supply: the land from z = {before:g} to {low:g} m, next to a CircumferentialGroove, "
                f"must be at least {SHORTEST_LAND:g} of the bearing's length {length:g} m; move the groove, make it "
                "narrower, or give one groove in place of two."
            )
        before = high


def _check_pair(i: int, first: SupplyArea, k: int, second: SupplyArea, radius: float, step: float) -> None:
    """Raise `InputError` for areas on one surface that overlap at different pressures or nearly touch."""
    if first.rotating != second.rotating:
        return  # areas on different surfaces pass each other; where they overlap, the first one's pressure acts
    (angle1, place1, x1, z1, r1), (angle2, place2, x2, z2, r2) = outline(first, radius), outline(second, radius)
    apart = max(0.0, radius * abs(math.remainder(angle1 - angle2, 2.0 * math.pi)) - x1 - x2)
    along = max(0.0, abs(place1 - place2) - z1 - z2)
    if math.hypot(apart, along) <= r1 + r2:
        if first.supply is not None or second.supply is not None:
            raise InputError(
                f"JournalBearing.supply[{i}] and [{k}] overlap, and one of them has a restrictor, "
                f"{first.supply or second.supply!r}; make one area of both, or move them apart."
            )
        if first.pressure != second.pressure:
            raise InputError(
                f"JournalBearing.supply[{i}] and [{k}] overlap with different pressures, {first.pressure:g} and "
                f"{second.pressure:g} Pa; give overlapping areas one pressure or move them apart."
            )
    elif along <= r1 + r2:
        _require_between(
            f"JournalBearing.supply[{i}] and [{k}]: the film between them", (apart - r1 - r2) / radius, step
        )
