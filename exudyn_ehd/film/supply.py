"""Oil supply: grooves, holes and pockets in which the pressure is prescribed.

A supply area is deep against the clearance, so that its pressure is uniform. Circumferential grooves have rows of the
grid on their edges, and the lands beside them rows of their own.

In other areas, the vertices inside (edges included) carry the supply pressure; the area thus reaches from the first to
the last vertex inside and may be up to one cell narrower per edge than drawn. Choose a grid with vertices on the edges
where that matters (edges at multiples of 2 pi / n_theta), or refine. The rows at the bearing's ends keep the end
pressures: a groove up to the ends leaves one axial interval of land.

With `ElrodAdams` a supply area is full of oil (fill = 1): it feeds starved parts even at the cavity pressure. Its
pressure acts on the journal; its shear counts as that of the land. What flows out of it is reported; with `ElrodAdams`
supply, leakage and the film's change of content balance to rounding, the other closures lose oil at the film's rupture.

Areas lie in the housing, or with ``rotating=True`` in the journal; those need the spin angle of the journal, and the
force then steps when the area's edge passes a vertex.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.film.grid import FilmGrid, axial_vertices, rows_between
from exudyn_ehd.status import InputError, require_number

# Vertices on an edge count as inside: share of the area's width, far above rounding and far below a cell.
EDGE = 1e-9
LARGEST_REFINEMENT = 64
# Intervals of a land next to a circumferential groove, and its shortest length over the bearing's.
LEAST_ON_LAND, SHORTEST_LAND = 4, 1e-3


@dataclass(frozen=True, kw_only=True)
class AxialGroove:
    """Groove along the axis, centred at mid-plane.

    Parameters
    ----------
    angle : float
        theta of its centre, rad (with ``rotating``: in the journal).
    width_angle : float
        Angle that it spans, rad, below 2 pi.
    length : float or None
        Axial length, m; None: the whole bearing except the last interval at each end.
    pressure : float
        Gauge pressure, Pa.
    rotating : bool
        True: in the journal, turning with its spin.
    """

    angle: float
    width_angle: float
    length: float | None = None
    pressure: float = 0.0
    rotating: bool = False

    def __post_init__(self) -> None:
        _check_area(self, angle="rad")
        _check_width(self)
        if self.length is not None:
            require_number("AxialGroove.length", self.length, "m", above=0.0)

    def covers(self, theta: np.ndarray, z: np.ndarray, radius: float) -> np.ndarray:
        """Vertices inside, (n, m) bool; theta (n,) in rad, z (m,) in m."""
        half = math.inf if self.length is None else 0.5 * self.length
        return _rectangle(theta, z, self.angle, 0.5 * self.width_angle, 0.0, half)


@dataclass(frozen=True, kw_only=True)
class CircumferentialGroove:
    """Groove around the bearing; it parts the film into lands, whose load is within 1 % on the default grid.

    Parameters
    ----------
    z : float
        Axial position of its centre, m.
    width : float
        Axial width, m.
    pressure : float
        Gauge pressure, Pa.
    """

    z: float = 0.0
    width: float
    pressure: float = 0.0

    rotating = False

    def __post_init__(self) -> None:
        _check_area(self, z="m")
        require_number("CircumferentialGroove.width", self.width, "m", above=0.0)

    def covers(self, theta: np.ndarray, z: np.ndarray, radius: float) -> np.ndarray:
        """Vertices inside, (n, m) bool; theta (n,) in rad, z (m,) in m."""
        return _rectangle(theta, z, 0.0, math.pi, self.z, 0.5 * self.width)


@dataclass(frozen=True, kw_only=True)
class Hole:
    """Round hole.

    Parameters
    ----------
    angle : float
        theta of its centre, rad (with ``rotating``: in the journal).
    z : float
        Axial position of its centre, m.
    diameter : float
        m.
    pressure : float
        Gauge pressure, Pa.
    rotating : bool
        True: in the journal, turning with its spin.
    """

    angle: float
    z: float = 0.0
    diameter: float
    pressure: float = 0.0
    rotating: bool = False

    def __post_init__(self) -> None:
        _check_area(self, angle="rad", z="m")
        require_number("Hole.diameter", self.diameter, "m", above=0.0)

    def covers(self, theta: np.ndarray, z: np.ndarray, radius: float) -> np.ndarray:
        """Vertices inside, (n, m) bool; theta (n,) in rad, z (m,) in m."""
        x = radius * _turn(theta - self.angle)
        return x[:, None] ** 2 + (z - self.z) ** 2 <= (0.5 * self.diameter * (1.0 + EDGE)) ** 2


@dataclass(frozen=True, kw_only=True)
class Pocket:
    """Rectangular pocket.

    Parameters
    ----------
    angle : float
        theta of its centre, rad (with ``rotating``: in the journal).
    z : float
        Axial position of its centre, m.
    width_angle : float
        Angle that it spans, rad, below 2 pi.
    length : float
        Axial length, m.
    pressure : float
        Gauge pressure, Pa.
    rotating : bool
        True: in the journal, turning with its spin.
    """

    angle: float
    z: float = 0.0
    width_angle: float
    length: float
    pressure: float = 0.0
    rotating: bool = False

    def __post_init__(self) -> None:
        _check_area(self, angle="rad", z="m")
        _check_width(self)
        require_number("Pocket.length", self.length, "m", above=0.0)

    def covers(self, theta: np.ndarray, z: np.ndarray, radius: float) -> np.ndarray:
        """Vertices inside, (n, m) bool; theta (n,) in rad, z (m,) in m."""
        return _rectangle(theta, z, self.angle, 0.5 * self.width_angle, self.z, 0.5 * self.length)


SupplyArea = AxialGroove | CircumferentialGroove | Hole | Pocket


def _check_area(area: SupplyArea, **units: str) -> None:
    for argument, unit in {"pressure": "Pa", **units}.items():
        require_number(f"{type(area).__name__}.{argument}", getattr(area, argument), unit)
    if not isinstance(area.rotating, bool):
        raise InputError(
            f"{type(area).__name__}.rotating must be True (in the journal) or False (in the housing), got "
            f"{area.rotating!r}."
        )


def _check_width(area: AxialGroove | Pocket) -> None:
    hint = "if yours is in degrees, use math.radians; a groove all around is a CircumferentialGroove."
    where = f"{type(area).__name__}.width_angle"
    require_number(where, area.width_angle, "rad", above=0.0, below=2.0 * math.pi, hint=hint)


def _turn(angle: np.ndarray) -> np.ndarray:
    """Angles brought to -pi .. pi."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def _rectangle(
    theta: np.ndarray, z: np.ndarray, angle: float, half_angle: float, center: float, half_length: float
) -> np.ndarray:
    inside_theta = np.abs(_turn(theta - angle)) <= half_angle * (1.0 + EDGE)
    inside_z = np.abs(z - center) <= half_length * (1.0 + EDGE)
    return np.outer(inside_theta, inside_z)


def require_areas(supply: object) -> None:
    """Raise `InputError` for anything but a tuple of supply areas."""
    if not isinstance(supply, tuple) or not all(isinstance(a, SupplyArea) for a in supply):
        raise InputError(
            f"JournalBearing.supply must be a tuple of AxialGroove(...), CircumferentialGroove(...), Hole(...) or "
            f"Pocket(...), got {supply!r}; for a single one write supply=(AxialGroove(...),)."
        )


def check_supply(
    supply: Sequence[SupplyArea], radius: float, length: float, n_theta: int, n_z: int, stretch: float
) -> None:
    """Raise `InputError` for areas without a vertex of the film grid, or that overlap at different pressures."""
    for k, area in enumerate(supply):
        _check_extent(k, area, radius, length)
    _check_lands(supply, length)
    masks = []
    for k, area in enumerate(supply):
        mask = _covered(area, supply, radius, length, n_theta, n_z, stretch)
        if not mask.any():
            raise InputError(
                f"JournalBearing.supply[{k}]: no vertex of the {n_theta} x {n_z} film grid lies inside {area!r}; "
                f"{_grid_needed(area, supply, radius, length, n_theta, n_z, stretch)}"
            )
        masks.append(mask)
    for k, area in enumerate(supply):
        for i in range(k):
            if area.pressure != supply[i].pressure and np.any(masks[k] & masks[i]):
                raise InputError(
                    f"JournalBearing.supply[{i}] and [{k}] overlap with different pressures, {supply[i].pressure:g} "
                    f"and {area.pressure:g} Pa; give overlapping areas one pressure or move them apart."
                )


def _check_extent(k: int, area: SupplyArea, radius: float, length: float) -> None:
    """Refuse holes wider than the journal, and other areas that are far longer than the bearing."""
    if isinstance(area, Hole):
        size, limit, whose = area.diameter, 2.0 * radius, "diameter"
    else:
        given = area.width if isinstance(area, CircumferentialGroove) else area.length
        size, limit, whose = given or 0.0, 2.0 * length, "length"
    if size > limit:
        raise InputError(
            f"JournalBearing.supply[{k}]: {area!r} is larger than the bearing with its {whose} of "
            f"{2.0 * radius if whose == 'diameter' else length:g} m; all lengths are in m."
        )


def supply_rows(
    supply: Sequence[SupplyArea], radius: float, length: float, n_z: int, stretch: float
) -> tuple[np.ndarray, np.ndarray] | None:
    """Axial vertices over R with rows on the edges of circumferential grooves, and their weights; None without any.

    The lands share ``n_z`` intervals and two more per groove by their lengths, but have at least `LEAST_ON_LAND` each.
    """
    spans = _groove_spans(supply)
    if not spans:
        return None
    edges = [-0.5 * length, *(z for span in spans for z in span), 0.5 * length]
    lands = np.diff(edges)[::2]
    counts = [1] * (len(edges) - 1)
    per_length = (n_z + 2 * len(spans)) / lands.sum()
    counts[::2] = [max(LEAST_ON_LAND, math.ceil(per_length * land - EDGE)) for land in lands]
    counts[1] += sum(counts) % 2  # an even number can be halved for a coarser grid
    return rows_between([z / radius for z in edges], counts, stretch)


def _groove_spans(supply: Sequence[SupplyArea]) -> list[tuple[float, float]]:
    """Axial extents, m, of the circumferential grooves from end to end of the bearing."""
    grooves = (a for a in supply if isinstance(a, CircumferentialGroove))
    return sorted((a.z - 0.5 * a.width, a.z + 0.5 * a.width) for a in grooves)


def _check_lands(supply: Sequence[SupplyArea], length: float) -> None:
    """Refuse circumferential grooves that leave no film beside or between them."""
    before = -0.5 * length
    for low, high in [*_groove_spans(supply), (0.5 * length, math.inf)]:
        if low - before < SHORTEST_LAND * length:
            raise InputError(
                f"JournalBearing.supply: the land from z = {before:g} to {low:g} m, next to a CircumferentialGroove, "
                f"must be at least {SHORTEST_LAND:g} of the bearing's length {length:g} m; move the groove, make it "
                "narrower, or give one groove in place of two."
            )
        before = high


def _covered(
    area: SupplyArea,
    supply: Sequence[SupplyArea],
    radius: float,
    length: float,
    n_theta: int,
    n_z: int,
    stretch: float,
) -> np.ndarray:
    """Vertices inside (n, m), end rows excepted; a rotating area in its worst position between the vertices."""
    step = 2.0 * math.pi / n_theta
    theta = step * np.arange(n_theta)
    rows = supply_rows(supply, 1.0, length, n_z, stretch)
    z = axial_vertices(n_z, 0.5 * length, stretch)[0] if rows is None else rows[0]
    mask = area.covers(theta, z, radius)
    mask[:, 0] = mask[:, -1] = False
    if not area.rotating:
        return mask
    turned = [area.covers(theta + s * step, z, radius)[:, 1:-1] for s in np.linspace(0.0, 1.0, 17)]
    return mask if all(position.any() for position in turned) else np.zeros_like(mask)


def _grid_needed(
    area: SupplyArea,
    supply: Sequence[SupplyArea],
    radius: float,
    length: float,
    n_theta: int,
    n_z: int,
    stretch: float,
) -> str:
    for k in range(2, LARGEST_REFINEMENT + 1):
        for around, along in ((k * n_theta, n_z), (n_theta, k * n_z), (k * n_theta, k * n_z)):
            if _covered(area, supply, radius, length, around, along, stretch).any():
                return f"a grid of n_theta={around}, n_z={along} would do; or make the area larger."
    return "it lies outside the bearing or is far too small; check its position (m, rad) and size."


class SupplyMap:
    """Supply areas of one bearing on its film grid.

    Parameters
    ----------
    supply : tuple of SupplyArea
    grid : FilmGrid
        Its array ``fixed`` is extended by the areas, in place.

    Attributes
    ----------
    masks : list of (n, m) bool arrays
        Vertices of every area at its last position.
    rotating : bool
        Whether an area turns with the journal.
    """

    def __init__(self, supply: tuple[SupplyArea, ...], grid: FilmGrid) -> None:
        self.supply = supply
        self.grid = grid
        self.rotating = any(area.rotating for area in supply)
        self.ends = grid.fixed.copy()
        self.masks = [self._mask(area, 0.0) for area in supply]
        self.spin = 0.0
        self._fix()

    def _mask(self, area: SupplyArea, spin: float) -> np.ndarray:
        g = self.grid
        theta = g.x - spin if area.rotating else g.x
        mask = area.covers(theta, g.z * g.reference_length, g.reference_length)
        return mask & ~self.ends

    def _fix(self) -> None:
        self.grid.fixed[:] = self.ends
        for mask in self.masks:
            self.grid.fixed[mask] = True

    def turn(self, spin: float) -> bool:
        """Move the rotating areas to the spin angle, rad; True if a vertex changed."""
        if not self.rotating or spin == self.spin:
            return False
        self.spin = spin
        old = self.grid.fixed.copy()
        for k, area in enumerate(self.supply):
            if area.rotating:
                self.masks[k] = self._mask(area, spin)
        self._fix()
        return not np.array_equal(old, self.grid.fixed)

    def pressures(self) -> np.ndarray:
        """Gauge pressure of every area, Pa."""
        return np.array([area.pressure for area in self.supply])

    def prescribe(self, values: np.ndarray, P: np.ndarray) -> None:
        """Write one value per area into the field P (n, m)."""
        for mask, value in zip(self.masks, values, strict=True):
            P[mask] = value

    def flows(self, inflow: np.ndarray) -> np.ndarray:
        """What every area feeds into the film, in the unit of ``inflow`` (n, m).

        A shared vertex counts for the first area.
        """
        left = np.ones(inflow.shape, dtype=np.bool_)
        out = np.empty(len(self.masks))
        for k, mask in enumerate(self.masks):
            out[k] = float(np.sum(inflow[mask & left]))
            left &= ~mask
        return out
