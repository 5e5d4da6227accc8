"""Bores on parts of the circle: lobes with preload, fixed pads, pressure dams; their film grid and their shape.

Every arc is a separate film between two edges of given pressure. One grid contains the columns of all arcs, without a
link from the last column of an arc to the first one of the next.

Let c_b be the clearance of the assembled bearing, m the preload of an arc, and theta_o the angle at which its bore is
nearest to a concentric journal. The centre of the arc's circle lies at the distance ``m c_p`` from the bearing's
centre, on the side away from theta_o, with

    c_p = c_b / (1 - m),    h = c_p - m c_p cos(theta - theta_o) = c_b + (c_p - c_b) (1 - cos(theta - theta_o))

around a concentric journal (J. W. Lund, K. K. Thomsen, A Calculation Method and Data for the Dynamic Coefficients of
Oil-Lubricated Journal Bearings, ASME 1978). A dam adds its depth to the gap from the leading edge to a step (J. C.
Nicholas, P. E. Allaire, Analysis of Step Journal Bearings - Finite Length, Stability, ASLE Trans. 23 (1980) 197). A
column of the grid lies on the step. At either side of the dam lie two rows close to each other, one in the dam and one
on the land.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.film.grid import FilmGrid, axial_metric, axial_vertices, rows_between, tensor_grid
from exudyn_ehd.film.reynolds.gap import gap_slopes
from exudyn_ehd.film.supply.rows import LEAST
from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, ROUNDING, Checked, InputError, require_number

# Smallest extent of an arc, and of its parts before and behind a step, rad. Smaller values reduce the accuracy.
SMALLEST_ARC = 0.05
# Smallest length of a dam's lands over the bearing's length: smaller ones cannot hold the pressure of the dam.
LEAST_LANDS = 0.02
# Distance of either row from the side of a dam, and smallest distance of two sides with rows of their own, over the
# half length. Smaller values cause round-off, larger ones a slope instead of a step.
SIDE, BETWEEN_SIDES = 2e-4, 1e-3
# Usual width of grooves between lobes, rad; 20 degrees.
GROOVE = 0.35


@dataclass(frozen=True, kw_only=True)
class Dam(Checked):
    """Recess of an `Arc` from its leading edge to a step, at which the oil dams up, between two lands.

    In a `pressure_dam` bearing the pressure before the step loads the journal. Without an ``extent`` it is a relief
    track, which runs from edge to edge.

    Parameters
    ----------
    depth : float
        Depth below the bore, m.
    length : float
        Axial length, centred at mid-plane, m; at most 0.98 of the bearing's.
    extent : float or None, default None
        Angle from the arc's leading edge to the step, rad; None: up to the trailing edge.

    Examples
    --------
    >>> dam = ehd.Dam(depth=50e-6, length=0.018, extent=np.radians(125))
    >>> ehd.Arc(start=0.2, extent=2.8, dam=dam).dam.depth  # m
    5e-05
    """

    depth: float
    length: float
    extent: float | None = None

    checks: ClassVar = {"depth": POSITIVE, "length": POSITIVE, "extent": partial(require_number, at_least=SMALLEST_ARC)}


@dataclass(frozen=True, kw_only=True)
class Arc(Checked):
    """Bore on a part of the circle: a lobe, a partial bearing or a fixed pad, with given pressures at its two edges.

    The film begins at the leading edge, where oil enters if the spin is positive, and ends at the trailing edge.
    Between arcs there is no bore, but drain and feed grooves. Only with ``film=FiniteLength(...)`` and
    ``inlet=Periodic()``; not with ``journal``, a ``bush`` other than `ElasticLiner`, and a bush that conducts
    (`FilmEnergy.bush`). Each arc gets its share of the columns of the whole circle. Areas of ``supply`` lie in the
    bore of one arc, off its edges, on arcs without a dam.

    ``radial_clearance`` of the bearing is the assembled clearance c_b, the smallest gap of a concentric journal. With
    the preload m the clearance of the machined arc is ``c_p = c_b / (1 - m)``, and around a concentric journal

        ``h = c_b + (c_p - c_b) (1 - cos(theta - theta_o))``,    ``theta_o = start + offset extent``.

    Oil between two arcs is well mixed: what enters an arc has the temperature of a supply groove with hot oil carried
    over, see `FilmEnergy`.

    Where the pressures of an edge and an end differ by dp, the pressure jumps at their corner, and the flow around the
    corner grows with the logarithm of the grid: every halving of the intervals adds ``(2 ln 2 / pi) h^3 dp / (12 mu)``
    to the leakage, for each corner with its gap h. In thin films this is little; where it is much, compare grids.

    Parameters
    ----------
    start : float
        Angle of the leading edge, from the joint's x about its z axis, rad.
    extent : float
        Angle from the leading to the trailing edge, positive about z, rad, below 2 pi.
    leading_pressure, trailing_pressure : float, default 0.0
        Gauge pressures at the two edges, Pa.
    preload : float, default 0.0
        m = 1 - c_b / c_p, from 0 (a circle about the bearing's centre) to below 1.
    offset : float, default 0.5
        Share of the arc from its leading edge, 0 to 1, at which the bore is nearest to a concentric journal.
    dam : Dam or None, default None
        Recess from the leading edge to a step.

    Examples
    --------
    A partial bearing of 120 degrees that carries a load along -y:

    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, arc=ehd.Arc(start=np.radians(210), extent=np.radians(120)))
    >>> rest = ehd.equilibrium(bearing, speed=314.0, load=(0.0, -5e3))
    >>> round(1e6 * rest.film.minimum_gap, 2)  # um
    8.41
    """

    start: float
    extent: float
    leading_pressure: float = 0.0
    trailing_pressure: float = 0.0
    preload: float = 0.0
    offset: float = 0.5
    dam: Dam | None = None

    checks: ClassVar = {
        "start": require_number,
        "extent": partial(
            require_number,
            at_least=SMALLEST_ARC,
            below=math.tau,
            hint="use math.radians for degrees; leave arc out for a whole ring.",
        ),
        "leading_pressure": require_number,
        "trailing_pressure": require_number,
        "preload": partial(NOT_NEGATIVE, below=1.0, hint="it is 1 - assembled clearance / machined clearance."),
        "offset": partial(NOT_NEGATIVE, at_most=1.0, hint="0.5 is the middle of the arc."),
        "dam": (Dam, type(None)),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.step is not None and not self.step <= self.extent - SMALLEST_ARC:
            raise InputError(
                f"Dam.extent must leave {SMALLEST_ARC:g} rad of the arc of {self.extent:g} rad behind the step, got "
                f"{self.step!r}; angles are in radians, leave extent out for a track from edge to edge."
            )

    @property
    def pressures(self) -> tuple[float, float]:
        """Gauge pressures at the leading and the trailing edge, Pa."""
        return self.leading_pressure, self.trailing_pressure

    @property
    def step(self) -> float | None:
        """Angle from the leading edge to the step of the dam, rad; None without one."""
        return None if self.dam is None else self.dam.extent

    def lobe(self, theta: np.ndarray) -> np.ndarray:
        """Addition to the gap by the preload at angles theta (n,), over the assembled clearance."""
        nearest = self.start + self.offset * self.extent
        return self.preload / (1.0 - self.preload) * (1.0 - np.cos(theta - nearest))


def two_lobe(
    *, preload: float, offset: float = 0.5, angle: float = 0.0, width_angle: float = GROOVE, pressure: float = 0.0
) -> tuple[Arc, Arc]:
    """Return the arcs of a two-lobe bearing, also named elliptical or lemon-bore.

    Parameters
    ----------
    preload : float
        As for `Arc`.
    offset : float, default 0.5
        As for `Arc`.
    angle : float, default 0.0
        theta of the first groove's centre, rad; 0 splits the bearing horizontally, with lobes above and below.
    width_angle : float, default 0.35
        Angle that every groove spans, rad; 0.35 are 20 degrees.
    pressure : float, default 0.0
        Gauge pressure in the grooves, Pa.

    Returns
    -------
    tuple of Arc
        Two arcs for ``JournalBearing(arcs=...)``, in the order of their angles.

    Raises
    ------
    InputError
        For values outside their ranges.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, arcs=ehd.two_lobe(preload=0.5))
    >>> rest = ehd.equilibrium(bearing, speed=314.0, load=(0.0, -2e3))
    >>> round(1e6 * rest.film.minimum_gap, 1)  # um
    13.3
    """
    upper, lower = _lobes("two_lobe", 2, preload, offset, angle, width_angle, pressure)
    return upper, lower


def three_lobe(
    *,
    preload: float,
    offset: float = 0.5,
    angle: float = 0.5 * math.pi,
    width_angle: float = GROOVE,
    pressure: float = 0.0,
) -> tuple[Arc, ...]:
    """Return the arcs of a three-lobe bearing; a lobe's middle lies below.

    Parameters
    ----------
    preload : float
        As for `Arc`.
    offset : float, default 0.5
        As for `Arc`.
    angle : float, default pi / 2
        theta of the first groove's centre, rad; by default it lies above.
    width_angle : float, default 0.35
        Angle that every groove spans, rad.
    pressure : float, default 0.0
        Gauge pressure in the grooves, Pa.

    Returns
    -------
    tuple of Arc
        Three arcs for ``JournalBearing(arcs=...)``, in the order of their angles.

    Raises
    ------
    InputError
        For values outside their ranges.

    Examples
    --------
    >>> [round(np.degrees(arc.start)) for arc in ehd.three_lobe(preload=0.6)]
    [100, -140, -20]
    """
    return _lobes("three_lobe", 3, preload, offset, angle, width_angle, pressure)


def offset_halves(
    *, preload: float, angle: float = 0.0, width_angle: float = GROOVE, pressure: float = 0.0
) -> tuple[Arc, Arc]:
    """Return the arcs of a bearing whose halves are displaced along their split, so that films narrow up to their end.

    The halves are nearest to a concentric journal at their trailing edges (``offset`` of 1), for a positive spin.

    Parameters
    ----------
    preload : float
        As for `Arc`.
    angle : float, default 0.0
        theta of the first groove's centre, rad.
    width_angle : float, default 0.35
        Angle that every groove spans, rad.
    pressure : float, default 0.0
        Gauge pressure in the grooves, Pa.

    Returns
    -------
    tuple of Arc
        Two arcs for ``JournalBearing(arcs=...)``, in the order of their angles.

    Raises
    ------
    InputError
        For values outside their ranges.

    Examples
    --------
    >>> ehd.offset_halves(preload=0.5)[0].offset
    1.0
    """
    upper, lower = _lobes("offset_halves", 2, preload, 1.0, angle, width_angle, pressure)
    return upper, lower


def pressure_dam(
    *,
    depth: float,
    step_angle: float,
    length: float,
    track_length: float | None = None,
    angle: float = 0.0,
    width_angle: float = GROOVE,
    pressure: float = 0.0,
) -> tuple[Arc, Arc]:
    """Return the arcs of a pressure-dam (step) bearing: a dam in the upper half, which presses the journal down.

    Parameters
    ----------
    depth : float
        Depth of the `Dam`, m.
    step_angle : float
        Angle from the first groove's centre, the split, to the step, rad; mostly 125 to 150 degrees.
    length : float
        Axial length of the dam, m.
    track_length : float or None, default None
        Axial length of a relief track in the lower half, as deep as the dam, m; None: none.
    angle : float, default 0.0
        theta of the first groove's centre, rad; the dam lies behind it.
    width_angle : float, default 0.35
        Angle that every groove spans, rad.
    pressure : float, default 0.0
        Gauge pressure in the grooves, Pa.

    Returns
    -------
    tuple of Arc
        Two arcs for ``JournalBearing(arcs=...)``, in the order of their angles.

    Raises
    ------
    InputError
        For values outside their ranges.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> arcs = ehd.pressure_dam(depth=50e-6, step_angle=np.radians(145), length=0.018)
    >>> rest = ehd.equilibrium(ehd.JournalBearing(**b, arcs=arcs), speed=314.0, load=(0.0, -500.0))
    >>> round(rest.eccentricity_ratio, 2)
    0.33
    """
    upper, lower = _lobes("pressure_dam", 2, 0.0, 0.5, angle, width_angle, pressure)
    extent = require_number("pressure_dam: step_angle", step_angle) - 0.5 * width_angle
    track = None if track_length is None else Dam(depth=depth, length=track_length)
    return replace(upper, dam=Dam(depth=depth, length=length, extent=extent)), replace(lower, dam=track)


def _lobes(
    where: str, count: int, preload: float, offset: float, angle: float, width_angle: float, pressure: float
) -> tuple[Arc, ...]:
    """Arcs of equal extent between ``count`` grooves."""
    spacing = math.tau / count
    require_number(f"{where}: angle", angle)
    require_number(f"{where}: width_angle", width_angle, at_least=0.0, at_most=spacing - SMALLEST_ARC)
    return tuple(
        Arc(
            start=math.remainder(angle + 0.5 * width_angle + k * spacing, math.tau),
            extent=spacing - width_angle,
            leading_pressure=pressure,
            trailing_pressure=pressure,
            preload=preload,
            offset=offset,
        )
        for k in range(count)
    )


def check_arcs(arc: Arc | None, arcs: tuple[Arc, ...], length: float) -> None:
    """Raise `InputError` for arcs that overlap or do not follow each other, and for dams without lands."""
    if not isinstance(arcs, tuple) or not all(isinstance(part, Arc) for part in arcs):
        raise InputError(
            f"JournalBearing.arcs must be a tuple of Arc(...), got {arcs!r}; for a single one write arcs=(Arc(...),), "
            "for lobes arcs=two_lobe(...)."
        )
    if arcs and arc is not None:
        raise InputError(
            "JournalBearing.arc and JournalBearing.arcs exclude each other: arc=Arc(...) stands for arcs=(Arc(...),); "
            "leave one of the two out."
        )
    arcs = arcs if arc is None else (arc,)
    ends = [part.start + part.extent for part in arcs]
    between = [
        (after.start - end + ROUNDING) % math.tau - ROUNDING
        for after, end in zip((*arcs[1:], *arcs[:1]), ends, strict=True)
    ]
    if sum(between) + sum(part.extent for part in arcs) > 1.5 * math.tau:
        k = int(np.argmax(between))
        after = arcs[(k + 1) % len(arcs)]
        raise InputError(
            f"JournalBearing.arcs[{(k + 1) % len(arcs)}], from {after.start:g} to {after.start + after.extent:g} rad, "
            f"overlaps arcs[{k}], from {arcs[k].start:g} to {ends[k]:g} rad, or does not follow it; give arcs without "
            "overlaps in the order of their angles."
        )
    for k, part in enumerate(arcs):
        if part.dam is not None and not part.dam.length <= (1.0 - LEAST_LANDS) * length:
            raise InputError(
                f"JournalBearing.arcs[{k}].dam.length must be at most {1.0 - LEAST_LANDS:g} of the bearing's "
                f"{length:g} m, got {part.dam.length!r}; the lands beside a dam hold its pressure."
            )


def arc_grid(
    radius: float,
    length: float,
    arcs: tuple[Arc, ...],
    n_theta: int,
    n_z: int,
    stretch: float,
    rows: tuple[np.ndarray, np.ndarray] | None,
) -> FilmGrid:
    """Return the film grid of all arcs: an arc has ``n_theta`` times its fraction of the circle as intervals, and
    columns on both edges; other parameters as for `bearing_grid`."""
    if rows is None:
        dams = [arc.dam.length / length for arc in arcs if arc.dam is not None]
        z, weight_z = (0.5 * length / radius * part for part in _rows(dams, n_z, stretch))
    else:
        z, weight_z = rows
    x, face, width, links, weight = (np.concatenate(f) for f in zip(*(_columns(arc, n_theta) for arc in arcs)))
    fixed = np.zeros((x.size, z.size), dtype=np.bool_)
    fixed[:, [0, -1]] = True
    # nothing flows from the last column of an arc to the next one
    fixed[links == 0.0] = fixed[np.roll(links == 0.0, 1)] = True
    return replace(tensor_grid(x, z, width, links, radius, fixed, weight, weight_z), x_face=face)


def _rows(dams: list[float], n_z: int, stretch: float) -> tuple[np.ndarray, np.ndarray]:
    """Return rows in [-1, 1] and their weights, for dams of these lengths over that of the bearing, with two rows at
    either side of a dam."""
    sides: list[float] = []
    for side in sorted(dams):
        sides += [side] if not sides or side - sides[-1] > BETWEEN_SIDES else []
    bounds = [*(-side for side in sides[::-1]), *sides]
    edges = [-1.0, *(z + way for z in bounds for way in (-SIDE, SIDE)), 1.0]
    counts = [max(LEAST, 2 * math.ceil(0.25 * n_z * (b - a))) for a, b in zip(edges[::2], edges[1::2])]
    return rows_between(edges, [k for n in counts for k in (n, 1)][:-1], stretch)


def _columns(arc: Arc, n_theta: int) -> tuple[np.ndarray, ...]:
    """Return the angles of an arc's columns and of the links behind them, widths, inverse distances and weights, (n,)
    each."""
    half, count = 0.5 * arc.extent, max(2 * LEAST, math.ceil(n_theta * arc.extent / math.tau))
    if arc.step is None:
        x, weight = axial_vertices(count, half, 0.0)
        step = np.full(x.size, axial_metric(x)[0].max())
    else:
        before = min(max(LEAST, round(count * arc.step / arc.extent)), count - LEAST)
        x, weight = rows_between((-half, arc.step - half, half), (before, count - before), 0.0)
        step = np.diff(x, append=0.0)
    step[-1] = 0.0
    width, links = axial_metric(x)
    at = arc.start + half + x
    return at, at + 0.5 * step, width, np.append(links, 0.0), weight


def columns_of_arcs(theta: np.ndarray, arcs: tuple[Arc, ...]) -> list[slice]:
    """Return the columns of every arc as slices of the angles theta (n,) of a film."""
    found, first = [], 0
    for arc in arcs:
        behind = first + int(np.argmax(theta[first:] > arc.start + arc.extent - ROUNDING)) + 1
        found.append(slice(first, behind))
        first = behind
    return found


def rows_at_sides(grid: FilmGrid) -> np.ndarray:
    """Return whether links along z (m - 1,) lie between the two rows at a side of a dam."""
    return np.asarray(grid.link_z * SIDE * float(grid.z[-1] - grid.z[0]) > 0.5)


def mixing_grooves(grid: FilmGrid) -> list[np.ndarray]:
    """Return masks (n, m) of the vertices on both sides of every groove between arcs; an empty list for a ring."""
    grooves = []
    for last, first in zip(grid.edges[:, 1], np.roll(grid.edges[:, 0], -1), strict=True):
        grooves.append(np.zeros(grid.shape, dtype=np.bool_))
        grooves[-1][[last, first], 1:-1] = True
    return grooves


class LobeTerm:
    """Shape of arcs as a gap term of one bearing model.

    Parameters
    ----------
    arcs : tuple of Arc
    grid : FilmGrid
    clearance : float
        Assembled radial clearance, m.

    Attributes
    ----------
    values, between : (n, m) arrays
        Scaled addition to the gap at the vertices; on links its difference from the mean of both ends.
    slopes : (2, n, m) array
        Slopes of dams along theta and z, less those of `gap_slopes`. Their sum with the grid's weights is the height of
        a step. The slope of a step in theta is at its column, that of a side half on either of its two rows.
    """

    def __init__(self, arcs: tuple[Arc, ...], grid: FilmGrid, clearance: float) -> None:
        self.values, links, dams = np.zeros((3, *grid.shape))
        self.slopes = np.zeros((2, *grid.shape))
        for arc, (first, last) in zip(arcs, grid.edges.tolist(), strict=True):
            part = slice(first, last + 1)
            x, face = grid.x[part] - arc.start, grid.x_face[part] - arc.start
            self.values[part] += arc.lobe(grid.x[part])[:, None]
            links[part] += arc.lobe(grid.x_face[part])[:, None]
            if arc.dam is not None:
                step, half = math.tau if arc.step is None else arc.step, 0.5 * arc.dam.length / grid.reference_length
                depth = arc.dam.depth / clearance * (np.abs(grid.z) < half)
                at_step = np.abs(x - step) < ROUNDING
                dams[part] = np.outer(np.where(at_step, 0.5, x < step), depth)
                links[part] += np.outer(face < step, depth)
                # rows outside of seals have no weight: slope 0
                np.divide(
                    -np.outer(at_step, depth * grid.weight_z),
                    grid.weight[part],
                    out=self.slopes[0, part],
                    where=grid.weight[part] > 0.0,
                )
        self.values += dams
        self.between = links - gap_slopes(self.values, grid)[0]
        self.slopes -= gap_slopes(dams, grid)[1]
        self.slopes[1, :, 1:-1] += 0.5 * (dams[:, 2:] - dams[:, :-2]) / grid.weight_z[1:-1]

    def field(self, history: object) -> np.ndarray:
        """Scaled addition to the gap (n, m)."""
        return self.values


def lobe_term(arcs: tuple[Arc, ...], grid: FilmGrid, clearance: float) -> LobeTerm | None:
    """Return the `LobeTerm` of arcs; None if all of them are parts of one circle."""
    shaped = any(arc.preload > 0.0 or arc.dam is not None for arc in arcs)
    return LobeTerm(arcs, grid, clearance) if shaped else None
