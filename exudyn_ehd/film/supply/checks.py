"""Checks of a bearing's supply areas: places outside, sizes for which the grid has no column, no film beside them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from exudyn_ehd.film.supply.areas import EDGE, CircumferentialGroove, Hole, SupplyArea, axial_span, outline, placed
from exudyn_ehd.film.supply.recess import RECIRCULATION
from exudyn_ehd.film.supply.rows import groove_spans
from exudyn_ehd.status import InputError

# Shortest film beside a groove or at an end, over the bearing's length.
SHORTEST_LAND = 1e-3
# Intervals of the film between two areas in theta.
LEAST_BETWEEN = 3


def check_supply(
    supply: Sequence[SupplyArea],
    radius: float,
    length: float,
    n_theta: int,
    around: bool,
    end_pressures: tuple[float, float] | None,
) -> None:
    """Raise `InputError` for areas that the film can't have.

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


def check_depths(supply: Sequence[SupplyArea], clearance: float) -> None:
    """Raise `InputError` for areas too shallow for a uniform pressure, which shear their oil as much as lands."""
    least = RECIRCULATION * clearance
    for k, area in enumerate(supply):
        if area.depth is not None and area.depth < least:
            raise InputError(
                f"JournalBearing.supply[{k}].depth must be at least {RECIRCULATION:g} radial clearances, {least:g} m, "
                f"for a uniform pressure, got {area.depth:g} m; give a shallower one as a profile, and an area where "
                "it is fed."
            )


def _check_extent(k: int, area: SupplyArea, radius: float, length: float) -> None:
    """Refuse holes wider than the journal, and other areas that are far longer than the bearing."""
    _, _, _, half, reach = outline(area, radius)
    if reach > radius or length < half < math.inf:
        size = f"diameter of {2.0 * radius:g}" if isinstance(area, Hole) else f"length of {length:g}"
        raise InputError(
            f"JournalBearing.supply[{k}]: {area!r} is larger than the bearing with its {size} m; all lengths are in m."
        )


def _check_columns(k: int, area: SupplyArea, radius: float, step: float, around: bool) -> None:
    """Refuse areas that may lie between two columns, and grooves that meet themselves around the journal."""
    if isinstance(area, CircumferentialGroove):
        return
    width = area.diameter / radius if isinstance(area, Hole) else area.width_angle
    low, high = (area.angle - 0.5 * width) / step, (area.angle + 0.5 * width) / step
    if isinstance(area, Hole) and around and not area.rotating:
        return  # holes of any size feed the nearest vertex
    between = width < step if area.rotating else math.floor(high + EDGE) < math.ceil(low - EDGE)
    if between:
        raise InputError(
            f"JournalBearing.supply[{k}]: {area!r} {'is narrower than' if area.rotating else 'lies between'} two "
            f"columns of the film's grid; n_theta={math.ceil(2.0 * math.pi / width)} would do, or make it wider."
        )
    _require_between(f"JournalBearing.supply[{k}]: the film beside {area!r}", 2.0 * math.pi - width, step)


def _require_between(what: str, angle: float, step: float) -> None:
    if angle < LEAST_BETWEEN * step * (1.0 - EDGE):
        raise InputError(
            f"{what} spans {angle:.4g} rad, less than {LEAST_BETWEEN} intervals of its grid; "
            f"n_theta={math.ceil(LEAST_BETWEEN * 2.0 * math.pi / angle)} would do, or leave no film there."
        )


def _check_ends(k: int, area: SupplyArea, length: float, end_pressures: tuple[float, float]) -> None:
    """Refuse areas that reach an end with another pressure."""
    low, high = axial_span(area)
    for land, pressure in zip((low + 0.5 * length, 0.5 * length - high), end_pressures, strict=True):
        if land < SHORTEST_LAND * length and pressure != area.pressure:
            raise InputError(
                f"JournalBearing.supply[{k}]: between {area!r} and the bearing's end, which has {pressure:g} Pa, there "
                f"must be a land of at least {SHORTEST_LAND:g} of the bearing's length {length:g} m; make it shorter, "
                "or give both one pressure."
            )


def _check_lands(supply: Sequence[SupplyArea], length: float) -> None:
    """Refuse circumferential grooves that leave no film beside or between them."""
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
    """Refuse areas on one surface that overlap at different pressures, or with hardly a film between them."""
    if first.rotating != second.rotating:
        return  # they pass each other; where they overlap the first one's pressure counts
    (angle1, place1, x1, z1, r1), (angle2, place2, x2, z2, r2) = outline(first, radius), outline(second, radius)
    apart = max(0.0, radius * abs(math.remainder(angle1 - angle2, 2.0 * math.pi)) - x1 - x2)
    along = max(0.0, abs(place1 - place2) - z1 - z2)
    if math.hypot(apart, along) <= r1 + r2:
        if first.pressure != second.pressure:
            raise InputError(
                f"JournalBearing.supply[{i}] and [{k}] overlap with different pressures, {first.pressure:g} and "
                f"{second.pressure:g} Pa; give overlapping areas one pressure or move them apart."
            )
    elif along <= r1 + r2:
        _require_between(
            f"JournalBearing.supply[{i}] and [{k}]: the film between them", (apart - r1 - r2) / radius, step
        )
