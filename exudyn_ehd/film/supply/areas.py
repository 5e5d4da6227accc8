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
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

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
            f"Pocket(...), got {supply!r}; for a single one write supply=(AxialGroove(...),)."
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
