"""Description of tilting thrust pads, and the grid of a sector.

A pad is a sector of an annulus in its own frame: z the bearing's axis from the pads to the collar, x the radial line
through the pivot, the origin on the axis in the plane of the pads. So the pivot is at theta = 0, the leading edge,
where oil enters if the collar turns about +z, at -``pivot_angle`` and the trailing edge at ``extent - pivot_angle``.
The film is that of `exudyn_ehd.film.thrust.face` with the collar above,

    h = clearance + zeta - bx X - by Y + d(theta),        d = crown (2 (theta - theta_m) / extent)^2,

theta_m the middle of the pad, and all four edges at the ambient pressure.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure, FullSommerfeld, Gumbel, SwiftStieber
from exudyn_ehd.film.grid import axial_vertices
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.reynolds.turbulence import Hirs, NgPan, check_turbulence
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.film.thrust.annulus import STRETCH, check_shear_law
from exudyn_ehd.status import (
    NOT_NEGATIVE,
    POSITIVE,
    Checked,
    InputError,
    require_count,
    require_number,
    require_vector,
)

_NAME = "TiltingThrustPads"


@dataclass(frozen=True, kw_only=True)
class TiltingThrustPads(Checked):
    """Pads of a thrust bearing, sectors that tilt about pivots, for `equilibrium` and `CreateTiltingPadThrustBearing`.

    All pads are equal and evenly spaced. Every pad tilts about the radial and about the tangential line through its
    pivot, which lies in the plane of its face; it does not turn about the bearing's axis. Its film has one temperature,
    that of the lubricant, and the ambient pressure at all four edges. The leading edge is the one at which oil enters
    if the collar turns about +z, the axis from the pads to the collar.

    Plane pads carry a load if the film converges: the pivot must lie behind the middle of the pad in the sense of
    rotation, at about 0.6 of the extent. Pads for both senses have the pivot in the middle and need a ``crown``.

    Errors of the default grid against an independent film of finite differences (inner over outer radius 0.4 to 0.8,
    extent 0.3 to 1 rad, largest over smallest gap up to 4, squeeze, both senses of rotation): load up to 0.4 %, 0.05 %
    in the median; friction torque 0.1 %; place of the load 0.05 % of the pad's length and width.

    Parameters
    ----------
    inner_radius, outer_radius : float
        Radii of the pads, m.
    pads : int
        Number of pads.
    extent : float
        Angle of a pad from its leading to its trailing edge, rad; all pads together stay below 2 pi.
    pivot_radius : float
        Distance of the pivots from the bearing's axis, m.
    pivot_angle : float
        Angle from the leading edge to the pivot, rad (not a share of the extent).
    clearance : float
        Gap between untilted pads and the collar in the reference configuration, at the pads' middle, m. An equilibrium
        does not depend on it.
    lubricant : Lubricant
        Oil with any laws; a ``shear_law`` must depend on the shear rate, such as `CarreauShear`.
    pad_mass : float
        Mass of one pad, kg, its centre in the pivot.
    pad_inertia : (float, float)
        Moments of inertia of one pad about the radial and about the tangential line through its pivot, kg m2.
    pivot_stiffness : float or None, default None
        Axial stiffness of one pivot, N/m; None: rigid.
    pivot_damping : float, default 0.0
        Axial damping of one pivot that has a stiffness, N s/m.
    crown : float, default 0.0
        Depth of leading and trailing edge below the middle of the pad, m; a parabola along theta.
    cavitation : SwiftStieber, FullSommerfeld, Gumbel or Closure, default SwiftStieber()
        Model that does not conserve mass, with a ``cavity_pressure`` not above 0. The rupture line lies on vertices.
    contact : RegularisedWall or None, default None
        Smooth wall that carries load before a gap vanishes; None: a vanishing gap ends the run with an error.
    turbulence : NgPan, Hirs or None, default None
        Turbulent flow by the Reynolds number at every radius; None: laminar.
    n_theta, n_r : int, default 24, 20
        Intervals of the grid of a pad from edge to edge and from inner to outer radius, at least 8 and 6.

    Raises
    ------
    InputError
        For values outside their ranges, pads that overlap, and a pivot that is not under its pad.

    Examples
    --------
    >>> pads = ehd.TiltingThrustPads(
    ...     inner_radius=0.05, outer_radius=0.1, pads=8, extent=0.65, pivot_radius=0.077, pivot_angle=0.39,
    ...     clearance=60e-6, lubricant=ehd.Lubricant(viscosity=0.03), pad_mass=0.3, pad_inertia=(6e-5, 6e-5),
    ... )
    """

    inner_radius: float
    outer_radius: float
    pads: int
    extent: float
    pivot_radius: float
    pivot_angle: float
    clearance: float
    lubricant: Lubricant
    pad_mass: float
    pad_inertia: tuple[float, float]
    pivot_stiffness: float | None = None
    pivot_damping: float = 0.0
    crown: float = 0.0
    cavitation: SwiftStieber | Gumbel | FullSommerfeld | Closure = SwiftStieber()
    contact: RegularisedWall | None = None
    turbulence: NgPan | Hirs | None = None
    n_theta: int = 24
    n_r: int = 20

    # Attributes that a joint reads of every bearing and of faces: one face, and a bore that no shaft can touch.
    bush = yielding = journal = thermal = asperity = roughness = wear = film = inlet = arc = None
    profiles = supply = ()
    end_pressures, inner_pressures, outer_pressures, squeeze = (0.0, 0.0), None, (0.0, 0.0), True
    lower, upper, radial_clearance = False, True, 1e6

    checks: ClassVar = {
        **dict.fromkeys(
            ("inner_radius", "outer_radius", "pivot_radius", "clearance", "pad_mass", "pivot_stiffness"), POSITIVE
        ),
        "pads": partial(require_count, at_least=1, hint="bearings have 3 to 20."),
        "extent": partial(require_number, at_least=1e-3, below=2.0 * math.pi),
        "pivot_angle": POSITIVE,
        "pivot_damping": NOT_NEGATIVE,
        "crown": NOT_NEGATIVE,
        "n_theta": partial(require_count, at_least=8),
        "n_r": partial(require_count, at_least=6),
        "lubricant": (Lubricant,),
        "contact": (RegularisedWall, type(None)),
        "cavitation": (SwiftStieber, Gumbel, FullSommerfeld, Closure),
        "turbulence": (NgPan, Hirs, type(None)),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.inner_radius < 0.99 * self.outer_radius:
            raise InputError(
                f"{_NAME}.inner_radius must be below 0.99 of the outer radius {self.outer_radius!r} m, got "
                f"{self.inner_radius!r} m; a pad is the sector between them."
            )
        if not self.pads * self.extent < 2.0 * math.pi:
            raise InputError(
                f"{_NAME}.extent: {self.pads} pads of {self.extent:g} rad overlap, together they must stay below 2 pi; "
                f"give each less than {2.0 * math.pi / self.pads:.4g} rad, or take fewer pads."
            )
        if not (self.inner_radius < self.pivot_radius < self.outer_radius and self.pivot_angle < self.extent):
            raise InputError(
                f"{_NAME}.pivot_radius and pivot_angle: the pivot must be under its pad, between {self.inner_radius:g} "
                f"and {self.outer_radius:g} m and between 0 and {self.extent:g} rad behind the leading edge, got "
                f"{self.pivot_radius!r} m and {self.pivot_angle!r} rad; pivot_angle is an angle, not a share."
            )
        inertia = require_vector(f"{_NAME}.pad_inertia", self.pad_inertia, 2, "kg m2")
        if not inertia.min() > 0.0:
            raise InputError(
                f"{_NAME}.pad_inertia must be two numbers > 0 kg m2, about the radial and about the tangential line "
                f"through the pivot, got {self.pad_inertia!r}."
            )
        object.__setattr__(self, "pad_inertia", tuple(inertia.tolist()))
        check_shear_law(_NAME, self.lubricant)
        check_turbulence(_NAME, vars(self) | {"roughness": None, "thermal": None})
        left_out = ["cavitation=ElrodAdams(...)"] if self.cavitation.conserves_mass else []
        left_out += ["a cavity_pressure above 0 Pa"] if self.cavitation.cavity_pressure > 0.0 else []
        if left_out:
            raise InputError(
                f"{_NAME} does not go with {', '.join(left_out)}: its films have cavities without a memory and ambient "
                "pressure at their edges; leave it out."
            )
        if self.contact is not None and not self.contact.onset < self.clearance:
            raise InputError(
                f"{_NAME}.contact: RegularisedWall.onset must be below the clearance {self.clearance:g} m, got "
                f"{self.contact.onset:g} m; the wall would touch in the reference configuration."
            )

    @property
    def profile(self) -> TiltingThrustPads | None:
        """The pads as the shape of their faces; None if they are plane."""
        return self if self.crown > 0.0 else None

    def depth_at(self, theta: np.ndarray) -> np.ndarray:
        """Addition of the crown to the gap in m at the angles theta."""
        return self.crown * (2.0 * (theta + self.pivot_angle) / self.extent - 1.0) ** 2

    @property
    def grid(self) -> tuple[int, int, np.ndarray, np.ndarray]:
        """Arguments of the sector's `exudyn_ehd.film.thrust.annulus.Annulus` that come after its radii."""
        half = 0.5 * self.extent
        theta, weight = axial_vertices(self.n_theta, half, STRETCH)
        return self.n_theta, self.n_r, half - self.pivot_angle + theta, weight

    @property
    def pivot_film(self) -> float:
        """Film thickness at the pivot of an untilted pad in the reference configuration, m."""
        return self.clearance + float(self.depth_at(np.zeros(1))[0])

    @property
    def thrust(self) -> TiltingThrustPads:
        """The pads, as the faces of a bearing that has no other film."""
        return self

    @property
    def journal_radius(self) -> float:
        """Outer radius, m, under the name of the radius of cylindrical bearings."""
        return self.outer_radius

    @property
    def length(self) -> float:
        """Length of the joint to which the film belongs, whose face lies at its upper end, m: the clearance."""
        return self.clearance
