"""`SphericalBearing`: the description of a ball in an oil-filled socket, and its checks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure, FullSommerfeld, Gumbel, SwiftStieber, place_line
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.joint.spherical.patch import sphere_patch
from exudyn_ehd.status import POSITIVE, Checked, InputError, require_count, require_number, require_type, require_vector

# Least width of a patch, and least colatitude of its open end from either pole, rad.
LEAST_ANGLE = 0.05


@dataclass(frozen=True, kw_only=True)
class SphericalBearing(Checked):
    """A ball in a socket with oil between them, for `CreateLubricatedSphericalJoint` and `steady_spherical`.

    The socket is the patch of a sphere between two circles about its axis, the joint's z. It starts at z: an angle of 0
    to pi/2 is a hemispherical cup that carries along z; beyond pi/2 it holds the ball both ways. Its edges are open to
    the ambient pressure. Equations and assumptions: `exudyn_ehd.joint.spherical.model`.

    Errors of the default grid, of second order: squeeze of the cup against its closed form 0.02 % up to eccentricity
    ratio 0.5, 0.4 % at 0.9; any motion in any direction, cups and belts, up to 1 % of the force at 0.8 and 2.5 % at
    0.9, where the ball leans on an edge, and 0.5 % of the torque.

    Parameters
    ----------
    ball_radius : float
        R, m.
    radial_clearance : float
        c: radius of the socket less that of the ball, m.
    lubricant : Lubricant
        A pressure law takes part, a temperature law gives the viscosity at the lubricant's temperature, other laws are
        refused.
    socket_angles : (float, float), default (0.0, pi / 2)
        Colatitudes from the socket's axis at which the patch begins and ends, rad; 0 for a patch that is closed there.
    n_phi : int, default 48
        Vertices around the axis, at least 16.
    n_chi : int, default 24
        Intervals from edge to edge (of a closed patch from the pole to the edge), at least 4.
    cavitation : FullSommerfeld, Gumbel, SwiftStieber or Closure, default SwiftStieber()
        Without a memory and without a line inside the cells; `Closure` is one of your own. Its ``cavity_pressure`` must
        not be above the ambient pressure.
    contact : RegularisedWall or None, default None
        Takes over before the gap vanishes.

    Raises
    ------
    InputError
        For values that can't be meant, laws of the oil and closures that this film does not carry.

    Examples
    --------
    >>> oil, wall = ehd.Lubricant(viscosity=0.1), ehd.RegularisedWall(onset=2e-6)
    >>> size = dict(ball_radius=0.015, radial_clearance=30e-6, socket_angles=(0.0, 2.0))
    >>> ball = ehd.SphericalBearing(**size, lubricant=oil, contact=wall)
    """

    ball_radius: float
    radial_clearance: float
    lubricant: Lubricant
    socket_angles: tuple[float, float] = (0.0, 0.5 * math.pi)
    n_phi: int = 48
    n_chi: int = 24
    cavitation: SwiftStieber | Gumbel | FullSommerfeld | Closure = SwiftStieber()
    contact: RegularisedWall | None = None

    # what a joint's watches and audits ask of every bearing
    bush = yielding = journal = thermal = asperity = roughness = wear = film = turbulence = inlet = None
    profiles = supply = ()
    end_pressures, squeeze = (0.0, 0.0), True
    levers = (1.0, 1.0, 1.0, 0.0)

    checks: ClassVar = {
        "ball_radius": POSITIVE,
        "radial_clearance": POSITIVE,
        "n_phi": partial(require_count, at_least=16),
        "n_chi": partial(require_count, at_least=4),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        name = "SphericalBearing"
        if not self.radial_clearance <= 0.05 * self.ball_radius:
            raise InputError(
                f"{name}.radial_clearance must be at most a twentieth of the ball's radius {self.ball_radius:g} m, for "
                f"which thin films are, got {self.radial_clearance!r}; if yours is diametral, halve it."
            )
        require_type(f"{name}.lubricant", self.lubricant, Lubricant)
        for law in ("shear_law", "density_law"):
            if (given := getattr(self.lubricant, law)) is not None:
                raise InputError(
                    f"{name}.lubricant: a spherical film has no {law}, got {type(given).__name__}; give a Lubricant "
                    "without it, with the viscosity at the film's state."
                )
        first, last = require_vector(f"{name}.socket_angles", self.socket_angles, 2, "rad").tolist()
        end = math.pi - LEAST_ANGLE
        if not (first == 0.0 or first >= LEAST_ANGLE) or not first + LEAST_ANGLE <= last <= end:
            raise InputError(
                f"{name}.socket_angles must be (begin, end) in rad with begin = 0 or >= {LEAST_ANGLE}, end >= begin + "
                f"{LEAST_ANGLE} and end <= {end:.5g}, got {self.socket_angles!r}; use math.radians for degrees."
            )
        object.__setattr__(self, "socket_angles", (first, last))
        require_type(f"{name}.cavitation", self.cavitation, SwiftStieber, Gumbel, FullSommerfeld, Closure)
        if self.cavitation.conserves_mass or self.cavitation.line_in_cells or self.cavitation.cavity_pressure > 0.0:
            raise InputError(
                f"{name}.cavitation must be SwiftStieber(...) or another closure without a memory, with "
                "line_in_cells=False (its line lies on vertices) and a cavity_pressure <= 0 Pa, that of the open "
                f"edges, got {self.cavitation!r}."
            )
        object.__setattr__(self, "cavitation", place_line(self.cavitation, False))
        require_type(f"{name}.contact", self.contact, RegularisedWall, type(None))
        if self.contact is not None:
            require_number(
                f"{name}.contact: RegularisedWall.onset", self.contact.onset, "m", below=self.radial_clearance
            )

    def gap_normals(self) -> np.ndarray:
        """Directions (k, 4), the last column 0, from which to tell how near the ball is to the socket."""
        normals = sphere_patch(1.0, self.socket_angles, self.n_phi, self.n_chi).normals.reshape(3, -1)
        return np.vstack((normals, 0.0 * normals[:1])).T

    @property
    def journal_radius(self) -> float:
        """The ball's radius, by the name that it has in cylindrical bearings, m."""
        return self.ball_radius

    @property
    def length(self) -> float:
        """Length of a journal of the same radius and projected area, pi R / 2, m."""
        return 0.5 * math.pi * self.ball_radius

    def reference_force(self, speed: float) -> float:
        """Reference force of a journal of that length, L D mu |omega| / psi^2, N; ``speed`` in rad/s."""
        psi = self.radial_clearance / self.ball_radius
        return 2.0 * self.ball_radius * self.length * self.lubricant.viscosity * abs(speed) / psi**2
