"""Areas of supply: grooves, holes and pockets, deep against the clearance, so that their pressure is uniform.

Their edges act where they are (see `exudyn_ehd.film.supply.rows` and `exudyn_ehd.film.supply.cuts`), for areas in the
housing and, with ``rotating=True``, in the journal; those need the spin angle of the journal.

With `ElrodAdams` a supply area is full of oil (fill = 1): it feeds starved parts even at the cavity pressure. Its
pressure acts on the journal. In an area there is neither contact nor the shear of a film; areas with a depth have the
shear of `exudyn_ehd.film.supply.cuts`. Results contain the flow out of every area. With `ElrodAdams` supply, leakage
and the film's change of content balance to rounding; the other closures lose oil at the film's rupture.
With `SwiftStieber` on the default grid an area in the housing feeds mostly within 2 %, next to a cavity within 2.5 % of
the larger of its flow and the bearing's leakage.

With `ElrodAdams` the flow out of an area that turns with the journal ripples, because its edges pass grid columns.
Its mean over time is that of an area at rest, within 0.2 %; the ripple of an axial groove has a standard deviation of
5 % of the mean at 150 steps a turn, 14 % at 600 and 17 % at 2400. Eccentricity and power loss agree within 0.3 %,
leakage within 1.5 %.

Within the cavity of `ElrodAdams` the band of oil downstream of an area is as wide as the area, unless rows of other
areas prevent it. If this band is the only oil of a film, errors of its load are mostly below 2 % on the default grid,
at worst 15 %; errors of flows are up to twice as large. ``supply resolution`` of the audit measures them.

Round holes of any size on the grid
-----------------------------------
A hole covers vertices, and changes the conductances of the links that end at its circle. A row of the grid lies on the
hole's centre. The grid is coarse compared with the circle, so that the flow on it differs from that of the hole. In a
film of one thickness the pressure is linear in the logarithm of the distance from the centre, and the flow of the hole
is

    Q = 2 pi H^3 (p_hole - p(s)) / ln(s / r).

So the links of the hole are multiplied by a factor with which the grid has this flow if the pressure some intervals
around is that of the logarithm. The factor acts in full at the innermost vertex and not at all at one on the circle, so
that the flow is continuous when vertices enter or leave the circle. A vertex on a square grid with spacing h feeds,
without a factor, like a hole of 0.198 h (D. W. Peaceman, SPE Journal 18 (1978) 183; 0.14 sqrt(dx^2 + dz^2) on a
rectangular one, SPE Journal 23 (1983) 531).

A column of the grid lies on the first hole in the housing. Another hole that lies between two columns feeds the nearest
vertex, so that its oil enters up to half a column from its centre.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import pairwise
from typing import ClassVar, NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import laplacian
from scipy.sparse.linalg import splu

from exudyn_ehd.film.supply.restrictors import Restrictor
from exudyn_ehd.status import POSITIVE, ROUNDING, Checked, InputError, require_bool, require_number

# Length of an axial groove whose ``length`` is None, over the bearing's length.
WHOLE_GROOVE = 0.875


class _Area(Checked):
    """Base of supply areas: checks of their arguments."""

    checks: ClassVar = {
        **dict.fromkeys(("angle", "z", "pressure"), require_number),
        **dict.fromkeys(("length", "width", "diameter"), POSITIVE),
        "width_angle": partial(
            POSITIVE,
            below=2.0 * math.pi,
            hint="if yours is in degrees, use math.radians; a groove all around is a CircumferentialGroove.",
        ),
        "depth": partial(POSITIVE, hint="write depth=None for an area so deep that its shear does not count."),
        "rotating": require_bool,
    }
    pressure: float
    supply: Restrictor | None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.supply is None:
            return
        name = type(self).__name__
        if not isinstance(self.supply, Restrictor):
            raise InputError(
                f"{name}.supply must be Orifice(...), Capillary(...), GivenFlow(...) or None, got {self.supply!r}; "
                f"write {name}(..., pressure=...) for an area of given pressure."
            )
        if self.pressure != 0.0:
            raise InputError(
                f"{name}: give pressure or supply, got pressure={self.pressure!r} and supply={self.supply!r}; with a "
                "restrictor the pressure follows from the film, and supply_pressure belongs to the restrictor."
            )


@dataclass(frozen=True, kw_only=True)
class AxialGroove(_Area):
    """Groove that supplies oil along the axis, centred at mid-plane.

    Its edges may lie anywhere between the grid's lines. On the default grid the error of the load is 1 to 1.5 %.

    Parameters
    ----------
    angle : float
        theta of its centre, from the joint's x about its z axis, rad; of a ``rotating`` one as it stands in the model's
        reference configuration.
    width_angle : float
        Angle that it spans, rad, below 2 pi.
    length : float or None, default None
        Axial length, m; None: 7/8 of the bearing's, in a `LongBearing` all of it.
    pressure : float, default 0.0
        Gauge pressure, Pa.
    supply : Orifice, Capillary, GivenFlow or None, default None
        Restrictor through which it is fed, in place of ``pressure``. None: ``pressure`` is given.
    rotating : bool, default False
        True: in the journal, turning with it; `steady` keeps it where it was described. False: in the bore.
    depth : float or None, default None
        Depth of the recess below the surface, m, at least four radial clearances; adds the friction of the oil in it
        (`exudyn_ehd.film.supply.cuts`). None: deep, without friction.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> groove = ehd.AxialGroove(angle=np.pi / 2, width_angle=0.3, length=0.015, pressure=2e5)
    >>> film = ehd.steady(ehd.JournalBearing(**b, supply=(groove,)), speed=314.0, eccentricity_ratio=0.8)
    >>> film.supply_flows.shape
    (1,)
    """

    angle: float
    width_angle: float
    length: float | None = None
    pressure: float = 0.0
    supply: Restrictor | None = None
    depth: float | None = None
    rotating: bool = False


@dataclass(frozen=True, kw_only=True)
class CircumferentialGroove(_Area):
    """Groove that supplies oil around the whole bearing, between two lands.

    On the default grid the error of the load is 1 %.

    Parameters
    ----------
    z : float, default 0.0
        Axial position of its centre from the mid-plane, m.
    width : float
        Axial width, m.
    pressure : float, default 0.0
        Gauge pressure, Pa.
    supply : Orifice, Capillary, GivenFlow or None, default None
        Restrictor through which it is fed, in place of ``pressure``. None: ``pressure`` is given.
    depth : float or None, default None
        Depth of the recess below the surface, m, at least four radial clearances; adds the friction of the oil in it
        (`exudyn_ehd.film.supply.cuts`). None: deep, without friction.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> groove = ehd.CircumferentialGroove(width=0.003, pressure=2e5)
    >>> ehd.JournalBearing(**b, supply=(groove,)).supply[0].pressure  # Pa
    200000.0
    """

    z: float = 0.0
    width: float
    pressure: float = 0.0
    supply: Restrictor | None = None
    depth: float | None = None

    rotating = False


@dataclass(frozen=True, kw_only=True)
class Hole(_Area):
    """Round hole that supplies oil, of any diameter; in the journal at least one column of the grid wide.

    With a pressure well above the film's, the error of its flow on the default grid is 1 %.

    An area of any kind that turns with the journal covers one column of the grid after the other. With `ElrodAdams` it
    fills the cavity of a column when it reaches it, so that its flow ripples. The rms of the ripple is 20 to 30 % of
    the mean for a hole over 0.3 R, and 50 to 80 % for a pocket or a groove along the axis. The oil is balanced to
    round-off, and means over the passage of a column are right. Forces ripple by up to 0.5 %, the leakage by 1.5 %.

    Parameters
    ----------
    angle : float
        theta of its centre, from the joint's x about its z axis, rad; of a ``rotating`` one as it stands in the model's
        reference configuration.
    z : float, default 0.0
        Axial position of its centre from the mid-plane, m.
    diameter : float
        m.
    pressure : float, default 0.0
        Gauge pressure, Pa.
    supply : Orifice, Capillary, GivenFlow or None, default None
        Restrictor through which it is fed, in place of ``pressure``. None: ``pressure`` is given.
    rotating : bool, default False
        True: in the journal, turning with it; `steady` keeps it where it was described. False: in the bore.
    depth : float or None, default None
        Depth of the recess below the surface, m, at least four radial clearances; adds the friction of the oil in it
        (`exudyn_ehd.film.supply.cuts`). None: deep, without friction.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> hole = ehd.Hole(angle=np.pi / 2, diameter=0.004, pressure=3e5, rotating=True)
    >>> ehd.JournalBearing(**b, supply=(hole,)).supply[0].rotating
    True
    """

    angle: float
    z: float = 0.0
    diameter: float
    pressure: float = 0.0
    supply: Restrictor | None = None
    depth: float | None = None
    rotating: bool = False


@dataclass(frozen=True, kw_only=True)
class Pocket(_Area):
    """Rectangular pocket that supplies oil.

    Parameters
    ----------
    angle : float
        theta of its centre, from the joint's x about its z axis, rad; of a ``rotating`` one as it stands in the model's
        reference configuration.
    z : float, default 0.0
        Axial position of its centre from the mid-plane, m.
    width_angle : float
        Angle that it spans, rad, below 2 pi.
    length : float
        Axial length, m.
    pressure : float, default 0.0
        Gauge pressure, Pa.
    supply : Orifice, Capillary, GivenFlow or None, default None
        Restrictor through which it is fed, in place of ``pressure``. None: ``pressure`` is given.
    rotating : bool, default False
        True: in the journal, turning with it; `steady` keeps it where it was described. False: in the bore.
    depth : float or None, default None
        Depth of the recess below the surface, m, at least four radial clearances; adds the friction of the oil in it
        (`exudyn_ehd.film.supply.cuts`). None: deep, without friction.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> pocket = ehd.Pocket(angle=np.pi, width_angle=0.6, length=0.012, pressure=5e5)
    >>> ehd.JournalBearing(**b, supply=(pocket,)).supply[0].length  # m
    0.012
    """

    angle: float
    z: float = 0.0
    width_angle: float
    length: float
    pressure: float = 0.0
    supply: Restrictor | None = None
    depth: float | None = None
    rotating: bool = False


SupplyArea = AxialGroove | CircumferentialGroove | Hole | Pocket


def require_areas(supply: object) -> None:
    """Raise `InputError` for anything but a tuple of supply areas."""
    if not isinstance(supply, tuple) or not all(isinstance(a, SupplyArea) for a in supply):
        raise InputError(
            f"JournalBearing.supply must be a tuple of AxialGroove(...), CircumferentialGroove(...), Hole(...) or "
            f"Pocket(...), got {supply!r}; for a single one write supply="
            f"({type(supply).__name__ if isinstance(supply, SupplyArea) else 'AxialGroove'}(...),)."
        )


def source_pressure(area: SupplyArea) -> float:
    """Pressure from which an area is fed, Pa; infinite with a `GivenFlow`."""
    return area.pressure if area.supply is None else getattr(area.supply, "supply_pressure", math.inf)


def placed(supply: tuple[SupplyArea, ...], length: float) -> tuple[SupplyArea, ...]:
    """Areas with the lengths that they have in a bearing of this length, m."""
    whole = WHOLE_GROOVE * length
    return tuple(replace(a, length=whole) if isinstance(a, AxialGroove) and a.length is None else a for a in supply)


def outline(area: SupplyArea, radius: float) -> tuple[float, float, float, float, float]:
    """Centre (theta, z), half widths (theta, z), and distance, rad and m.

    An area is all points of the surface with this ``radius``, m, that are within the distance of the rectangle with the
    half widths, m.
    """
    angle, z = getattr(area, "angle", 0.0), getattr(area, "z", 0.0)
    if isinstance(area, Hole):
        return angle, z, 0.0, 0.0, 0.5 * area.diameter
    if isinstance(area, CircumferentialGroove):
        return angle, z, radius * math.pi, 0.5 * area.width, 0.0
    return angle, z, radius * 0.5 * area.width_angle, math.inf if area.length is None else 0.5 * area.length, 0.0


def covers(area: SupplyArea, theta: np.ndarray, z: np.ndarray, radius: float) -> np.ndarray:
    """Vertices inside an area, (n, m) bool; theta (n,) in rad, z (m,) in m."""
    angle, middle, half_x, half_z, reach = outline(area, radius)
    turned = (theta - angle + math.pi) % (2.0 * math.pi) - math.pi
    # vertices on an edge count as inside
    x = np.maximum(radius * np.abs(turned) - half_x * (1.0 + ROUNDING), 0.0)
    along = np.maximum(np.abs(z - middle) - half_z * (1.0 + ROUNDING), 0.0)
    return np.hypot.outer(x, along) <= reach * (1.0 + ROUNDING)


def axial_span(area: SupplyArea) -> tuple[float, float]:
    """Axial positions of an area's ends, m."""
    _, z, _, half, reach = outline(area, 0.0)
    return z - half - reach, z + half + reach


# Shortest link over its spacing (with it rounding errors of its flow are below 1e-11; a shorter one has larger errors),
# largest factor, and number of intervals around a hole in the calculation of the factor.
SHORTEST, LARGEST, AROUND = 1e-4, 4.0, 3


class Circle(NamedTuple):
    """Hole on a grid whose columns have the distance 1.

    Attributes
    ----------
    covered : (k, 2) int array
        Column and row of the covered vertices; columns count from the one nearest the hole's centre.
    links : (q, 3) int array
        Axis (0: theta, 1: z), column and row where its links to other vertices begin.
    lengths : (q,) array
        Length of the film on these links over their spacing.
    depths : (q,) array
        Depth of the links' covered vertex inside the circle in theta, from 0 on the circle to 1 at the innermost one.
    """

    covered: np.ndarray
    links: np.ndarray
    lengths: np.ndarray
    depths: np.ndarray

    def factors(self, strength: float) -> np.ndarray:
        """Conductances (q,) of the links over those of links from vertex to vertex."""
        return (1.0 + (strength - 1.0) * self.depths) / self.lengths


def circle(rows: tuple[float, ...], radius: float, offset: float) -> Circle:
    """Hole whose centre lies ``offset``, -0.5 to 0.5, columns from a column; ``rows``: axial distances from it."""
    spans: dict[int, tuple[int, int]] = {}
    links: list[tuple[int, int, int]] = []
    lengths: list[float] = []
    depths: list[float] = []
    for j, z in enumerate(rows):
        if abs(z) > radius and z != 0.0:
            continue
        half = math.sqrt(max(radius * radius - z * z, 0.0))
        first, last = math.ceil(offset - half - ROUNDING), math.floor(offset + half + ROUNDING)
        if z == 0.0 and first > last:
            first = last = 0
        if first <= last:
            spans[j] = first, last
            links += [(0, first - 1, j), (0, last, j)]
            lengths += [offset - half - first + 1.0, last + 1.0 - offset - half]
            depths += [half - abs(first - offset), half - abs(last - offset)]
    covered = [(i, j) for j, (first, last) in spans.items() for i in range(first, last + 1)]
    for i, j in covered:
        edge = math.sqrt(max(radius * radius - (i - offset) ** 2, 0.0))
        for side in (-1, 1):
            first, last = spans.get(j + side, (1, 0))
            if 0 <= j + side < len(rows) and not first <= i <= last:
                links.append((1, i, min(j, j + side)))
                lengths.append((abs(rows[j + side]) - edge) / abs(rows[j + side] - rows[j]))
                depths.append(math.sqrt(max(radius * radius - rows[j] ** 2, 0.0)) - abs(i - offset))
    inner = max(depths)
    depth = np.clip(np.array(depths) / inner, 0.0, 1.0) if inner > ROUNDING else np.ones(len(depths))
    return Circle(np.array(covered), np.array(links), np.maximum(lengths, SHORTEST), depth)


@lru_cache(maxsize=4096)
def strength(rows: tuple[float, ...], radius: float, offset: float) -> float:
    """Factor of the links of a `circle` at its innermost vertex."""
    hole, z = circle(rows, radius, offset), np.array(rows)
    at = rows.index(0.0)
    reach = radius + AROUND * max(1.0, z[at + 1], -z[at - 1])
    low = max(int(np.searchsorted(z, -reach)) - 1, 0)
    z = z[low : int(np.searchsorted(z, reach)) + 1]
    out, m = math.ceil(reach) + 1, z.size
    n = 2 * out + 1
    here = (out, -low)
    kx = np.tile(np.convolve(np.diff(z), (0.5, 0.5)), (n, 1))
    kz = np.tile(np.append(1.0 / np.diff(z), 0.0), (n, 1))
    links = hole.links + (0, *here)
    own = np.array([(kx if axis == 0 else kz)[i, j] for axis, i, j in links])
    free = np.zeros((n, m), dtype=np.bool_)
    free[1:-1, 1:-1] = True
    covered = np.zeros_like(free)
    covered[tuple((hole.covered + here).T)] = True
    free &= ~covered
    distance = (np.arange(n) - out - offset)[:, None] ** 2 + z**2
    given = 0.5 * np.log(np.where(covered, 1.0, distance / radius**2))
    # Laplace's equation at the free vertices, without the hole's own links
    place, film = np.arange(n * m).reshape(n, m), ~covered.ravel()
    one, other = np.append(place[:-1], place[:, :-1]), np.append(place[1:], place[:, 1:])
    k = np.append(kx[:-1], kz[:, :-1]) * (film[one] & film[other])
    links_of = coo_matrix((k, (one, other)), shape=(n * m, n * m))
    balance = laplacian((links_of + links_of.T).tocsr()).tocsr()[free.ravel()]
    source = -balance[:, ~free.ravel()] @ given[~free][:, None]
    number = (np.cumsum(free) - 1).reshape(n, m)
    others = [number[i + (axis == 0), j + (axis == 1)] if covered[i, j] else number[i, j] for axis, i, j in links]
    ends, where = np.unique(others, return_inverse=True)
    unit = np.eye(len(source))[:, ends]
    answer = splu(balance[:, free.ravel()].tocsc()).solve(np.hstack((source, unit)))[ends]
    least, most = 0.0, LARGEST
    for _ in range(40):
        factor = 0.5 * (least + most)
        k = np.bincount(where, own * hole.factors(factor))
        fed = k @ np.linalg.solve(np.eye(k.size) + answer[:, 1:] * k, answer[:, 0])
        least, most = (factor, most) if fed < 2.0 * math.pi else (least, factor)
    return factor


@lru_cache(maxsize=64)
def strengths(rows: tuple[float, ...], radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Offsets from -0.5 to 0.5 and factors for interpolation, with steps where vertices enter or leave the circle."""
    halves = {math.sqrt(radius * radius - z * z) % 1.0 for z in rows if abs(z) <= radius}
    steps = {0.0, 0.5, *(x for half in halves for x in (half, 1.0 - half) if x < 0.5)}
    offsets: list[float] = []
    edges = sorted(steps)
    for low, high in pairwise(edges):
        if high - low > 1e-6:
            offsets += [low + 1e-7, 0.5 * (low + high), high - 1e-7]
    found = [strength(rows, radius, x) for x in offsets]
    return np.array([-x for x in reversed(offsets)] + offsets), np.array(found[::-1] + found)
