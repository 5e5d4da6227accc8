"""End faces with oil films, and pads on them, as a scene names them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, TypeAlias

import numpy as np

from exudyn_ehd.film.surfaces.wall import RegularisedWall
from exudyn_ehd.status import (
    POSITIVE,
    SHARE,
    Checked,
    InputError,
    require_bool,
    require_count,
    require_integer,
    require_type,
    require_vector,
)

# Attributes of a bearing by name.
BearingOptions: TypeAlias = Mapping[str, Any]
# Pads of a face up to which the error of its default grid was measured.
MOST_PADS = 16


@dataclass(frozen=True, kw_only=True)
class _Pads(Checked):
    """Equal pads around a face, recessed over a share of their length."""

    pads: int
    depth: float
    share: float = 0.75
    reverse: bool = False

    checks: ClassVar = {
        "pads": partial(require_integer, at_least=1),
        "depth": POSITIVE,
        "share": partial(SHARE, hint="it is a share of a pad."),
        "reverse": require_bool,
    }

    @property
    def edges(self) -> tuple[float, ...]:
        """Edges of a pad from its beginning to its end along theta, in lengths of a pad."""
        cut = 1.0 - self.share if self.reverse else self.share
        return (0.0, cut, 1.0) if self.share < 1.0 else (0.0, 1.0)

    def _place(self, theta: np.ndarray) -> np.ndarray:
        """Place in the pad over its recessed length, in the sense of rotation; above 1 on the land."""
        part = (self.pads * theta / (2.0 * math.pi)) % 1.0
        return (1.0 - part if self.reverse else part) / self.share


@dataclass(frozen=True, kw_only=True)
class TaperLand(_Pads):
    """Pads of a thrust face that taper to a flat land: ``d = depth (1 - s)`` over the first ``share`` of each pad.

    Fixed in the housing, on both faces; pads begin at theta = 0 and follow each other without grooves.

    Parameters
    ----------
    pads : int
        Number around the face.
    depth : float
        Of a pad's beginning below its land, m; 1 to 3 minimum film thicknesses carry most.
    share : float, default 0.75
        Of a pad's length that tapers, 0 to 1.
    reverse : bool, default False
        For journals that turn in the negative sense about z.

    Examples
    --------
    >>> ehd.TaperLand(pads=6, depth=20e-6).depth_at(np.array([0.0, 0.4, 1.0]))  # m
    array([2.00000000e-05, 9.81408364e-06, 0.00000000e+00])
    """

    def depth_at(self, theta: np.ndarray) -> np.ndarray:
        """Addition to the gap (n,) in m at the angles theta (n,)."""
        return self.depth * np.maximum(1.0 - self._place(theta), 0.0)


@dataclass(frozen=True, kw_only=True)
class StepLand(_Pads):
    """Stepped pads of a thrust face (Rayleigh's step): recessed by ``depth`` over the first ``share`` of each pad.

    Fixed in the housing, as `TaperLand`.

    Parameters
    ----------
    pads : int
        As of `TaperLand`.
    depth : float
        Of the recess, m; 0.9 to 1.2 minimum film thicknesses carry most.
    share : float, default 0.75
        Of a pad's length that is recessed, 0 to 1; 0.7 carries most.
    reverse : bool, default False
        As of `TaperLand`.

    Examples
    --------
    >>> ehd.StepLand(pads=6, depth=20e-6).depth_at(np.array([0.0, 0.4, 1.0]))  # m
    array([2.e-05, 2.e-05, 0.e+00])
    """

    def depth_at(self, theta: np.ndarray) -> np.ndarray:
        """Addition to the gap (n,) in m at the angles theta (n,)."""
        return np.where(self._place(theta) < 1.0, self.depth, 0.0)


@dataclass(frozen=True, kw_only=True)
class ThrustFaces(Checked):
    """Oil films between the end faces of a bush and collars of its journal: `JournalBearing.thrust`.

    They carry axial load and tilting moments by squeeze, wedge and pressure. Upper face at z = L/2, lower one at -L/2;
    the collars lie outside, so that a journal that moves along +z opens the upper gap and closes the lower one:

        h = clearance + s (z - bx X - by Y) + d(theta),     s = 1 upper, -1 lower,

    at the point (X, Y) of the face (`exudyn_ehd.film.thrust.face`). With plane parallel faces only squeeze carries; a
    stiff place along the axis takes pads, pressure or a wall. The oil has the lubricant's constant viscosity.

    Columns of the grid lie on the edges of the pads. Largest error of the default grid against one four times as fine
    in both directions (Swift-Stieber, inner over outer radius 0.35 to 0.85, 3 to 16 pads, share 0.2 to 0.9, depth 0.3
    to 3 times the gap of the land, axial position -0.8 to 0.5 clearances, tilt up to 0.8 of what closes the gap):

    ======  =====  =========  =============================  =============  ===============
    faces   force  stiffness  damping                        torque, power  inflow, outflow
    ======  =====  =========  =============================  =============  ===============
    pads    1.5 %  2 %        5 %; 2.5 % of 95 % of faces    0.6 %          1 %
    plane   0.4 %  0.6 %      2 %                            0.1 %          1 %
    ======  =====  =========  =============================  =============  ===============

    Flows are within 2 % with pressures at the radii, and of narrower rings, which have fewer columns on their width.
    Faces with pads have their rupture line on vertices, whatever `SwiftStieber.line_in_cells` says: their films end on
    edges.

    Parameters
    ----------
    inner_radius, outer_radius : float
        Of the faces, m; the inner one at least the journal's radius.
    clearance : float
        Gap of either face with the journal in the middle, m: half of the axial play.
    profile : TaperLand, StepLand or None, default None
        Pads on both faces; None: plane faces.
    contact : RegularisedWall or None, default None
        What takes over before a gap vanishes; None: a gap that vanishes ends the run with an error.
    inner_pressures : (float, float) or None, default None
        Gauge pressures at the inner radius of lower and upper face, Pa; None: the bearing's ``end_pressures``.
    outer_pressures : (float, float), default (0.0, 0.0)
        Gauge pressures at the outer radius, Pa.
    lower, upper : bool, default True
        Which faces have a film.
    n_theta, n_r : int or None, default None
        Grid: vertices around, at least 16 and 8 a pad, rounded up to the same number in every pad, and intervals
        across, at least 6. None: those of the table above, for up to 16 pads; 96 and 10 of plane faces.

    Raises
    ------
    InputError
        For values that can't be meant.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> pads = ehd.TaperLand(pads=8, depth=40e-6)
    >>> faces = ehd.ThrustFaces(inner_radius=0.025, outer_radius=0.045, clearance=40e-6, profile=pads)
    >>> bearing = ehd.JournalBearing(**b, thrust=faces)
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8, axial_position=20e-6)
    >>> round(film.faces.axial_force)  # N
    -3929
    """

    inner_radius: float
    outer_radius: float
    clearance: float
    profile: TaperLand | StepLand | None = None
    contact: RegularisedWall | None = None
    inner_pressures: tuple[float, float] | None = None
    outer_pressures: tuple[float, float] = (0.0, 0.0)
    lower: bool = True
    upper: bool = True
    n_theta: int | None = None
    n_r: int | None = None

    checks: ClassVar = {
        **dict.fromkeys(("inner_radius", "outer_radius", "clearance"), POSITIVE),
        "n_theta": partial(require_count, at_least=16),
        "n_r": partial(require_count, at_least=6),
        "lower": require_bool,
        "upper": require_bool,
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.inner_radius < 0.99 * self.outer_radius:
            raise InputError(
                f"ThrustFaces.inner_radius must be below 0.99 of the outer radius {self.outer_radius!r} m, got "
                f"{self.inner_radius!r} m; the film is the ring between them."
            )
        require_type("ThrustFaces.profile", self.profile, TaperLand, StepLand, type(None))
        require_type("ThrustFaces.contact", self.contact, RegularisedWall, type(None))
        for name in ("inner_pressures", "outer_pressures"):
            if getattr(self, name) is not None:
                pressures = require_vector(f"ThrustFaces.{name}", getattr(self, name), 2, "Pa")
                object.__setattr__(self, name, tuple(pressures.tolist()))
        if not (self.lower or self.upper):
            raise InputError("ThrustFaces: lower and upper are both False, so that there is no face; drop the option.")
        if self.contact is not None and not self.contact.onset < self.clearance:
            raise InputError(
                f"ThrustFaces.contact: RegularisedWall.onset must be below the clearance {self.clearance:g} m, got "
                f"{self.contact.onset:g} m; the wall would touch a journal in the middle."
            )
        pads = 0 if self.profile is None else self.profile.pads
        if pads > (MOST_PADS if self.n_theta is None else self.n_theta / 8):
            raise InputError(
                f"ThrustFaces.n_theta must be at least 8 columns a pad, {8 * pads} for {pads} pads, got "
                f"{self.n_theta!r}; it may be None for up to {MOST_PADS} pads."
            )


def check_faces(bearing: BearingOptions) -> None:
    """Refuse faces that do not fit the bearing around them, and what their films would leave out.

    Parameters
    ----------
    bearing : mapping
        Attributes of the `JournalBearing`.
    """
    faces = bearing["thrust"]
    if faces is None:
        return
    oil, closure, radius = bearing["lubricant"], bearing["cavitation"], bearing["journal_radius"]
    laws, own = ("pressure_law", "density_law", "shear_law"), ("thermal", "turbulence", "roughness", "asperity")
    others = [f"Lubricant.{law}" for law in laws if getattr(oil, law) is not None]
    others += [f"JournalBearing.{name}" for name in own if bearing[name] is not None]
    others += ["JournalBearing.cavitation=ElrodAdams(...)"] if closure.conserves_mass else []
    if others:
        raise InputError(
            f"JournalBearing.thrust=ThrustFaces(...) does not go with {', '.join(others)}: its films have the "
            "lubricant's constant viscosity, smooth surfaces and cavities without a memory; leave one out, or take "
            "two joints, one of them with the faces."
        )
    if faces.inner_radius < radius:
        raise InputError(
            f"ThrustFaces.inner_radius must be at least the journal's radius {radius:g} m, got "
            f"{faces.inner_radius:g} m; the faces lie around the bore."
        )
    inner = bearing["end_pressures"] if faces.inner_pressures is None else faces.inner_pressures
    lowest, cavity_pressure = min(*inner, *faces.outer_pressures), closure.cavity_pressure
    if cavity_pressure > lowest:
        raise InputError(
            f"JournalBearing.cavitation: the cavity_pressure must not exceed the pressures at the edges of the thrust "
            f"faces, {lowest:g} Pa, got {cavity_pressure:g} Pa; all are gauge pressures, lower the cavity pressure."
        )
