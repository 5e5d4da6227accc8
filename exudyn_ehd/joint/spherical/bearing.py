"""`SphericalBearing`: the description of a ball in an oil-filled socket, its checks, and its film grid.

The grid is that of a patch of a sphere between two circles about its axis, in Mercator's coordinates.

Directions n(phi, chi) = (sin chi cos phi, sin chi sin phi, cos chi), chi the colatitude from the socket's axis. With
s = ln tan(chi / 2) the map (phi, s) of the sphere is conformal, so that

    sin^2 chi div(h^3 grad p) = d_phi(h^3 d_phi p) + d_s(h^3 d_s p) :

links conduct as on a plane, and only areas differ from the plane. So every solver can use a `FilmGrid` with theta = phi
and z = s. Rows are closer in chi near the open edges, where a ball that nearly touches an edge has its steepest
pressures, as in cylindrical films (`exudyn_ehd.film.grid`). Control volumes end half-way between rows, with the width
d_chi / sin(chi) in s. In a patch that is closed at the pole the first row is half an interval from the pole. Its
control volumes end in a point there, through which nothing flows: no cell at the pole is needed, and the scheme is of
second order.

Integrals over control volumes (area, normal, products of two components of the normal) are exact, so that the areas
and the drag of a centred ball are exact to round-off on any grid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.film.cavitation.closures import (
    Closure,
    ElrodAdams,
    FullSommerfeld,
    Gumbel,
    SwiftStieber,
    place_line,
)
from exudyn_ehd.film.combinations import require_viscosities
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.reynolds.gap import drops, to_ends
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.status import POSITIVE, Checked, InputError, require_count, require_number, require_type, require_vector


@dataclass(frozen=True, eq=False)
class SpherePatch:
    """A patch of the unit sphere.

    Attributes
    ----------
    grid : FilmGrid
        Vertices (n, m) at angles phi and s, links and fixed edges.
    chi, faces : (m,), (m + 1,) arrays
        Colatitudes of the rows, and of the edges of their control volumes, rad.
    normals, link_normals : (3, n, m) arrays
        Directions of the vertices and of the links i -> i+1.
    area : (n, m) array
    vector : (3, n, m) array
        Integral of the normal over each control volume.
    tensor : (3, 3, n, m) array
        Integrals of the products of two of its components.
    """

    grid: FilmGrid
    chi: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    link_normals: np.ndarray
    area: np.ndarray
    vector: np.ndarray
    tensor: np.ndarray


def sphere_patch(radius: float, angles: tuple[float, float], n_phi: int, n_chi: int) -> SpherePatch:
    """Patch of a sphere of ``radius`` (m) between two colatitudes (rad), with ``n_chi`` + 1 rows."""
    first, last = angles
    closed = first == 0.0
    # from the middle of the patch to its edges; the middle of a closed patch is the pole
    middle, half = (0.0, last) if closed else (0.5 * (first + last), 0.5 * (last - first))
    share = (np.arange(n_chi + 1) + 0.5) / (n_chi + 0.5) if closed else np.linspace(-1.0, 1.0, n_chi + 1)
    quarter = 0.5 * math.pi * FiniteLength.stretch
    chi = middle + half * np.sin(quarter * share) / math.sin(quarter)
    chi[0], chi[-1] = chi[0] if closed else first, last
    faces = np.concatenate(([first], 0.5 * (chi[1:] + chi[:-1]), [last]))
    s = np.log(np.tan(0.5 * chi))
    step = 2.0 * math.pi / n_phi
    phi = step * np.arange(n_phi)
    fixed = np.zeros((n_phi, chi.size), dtype=np.bool_)
    fixed[:, -1] = True
    fixed[:, 0] = not closed
    width_x, width_z = np.full(n_phi, step), np.diff(faces) / np.sin(chi)
    grid = FilmGrid(
        x=phi,
        z=s,
        x_face=phi + 0.5 * step,
        width_x=width_x,
        width_z=width_z,
        link_x=1.0 / width_x,
        link_z=1.0 / np.diff(s),
        weight_z=width_z,
        weight=np.outer(width_x, width_z),
        fixed=fixed,
        reference_length=radius,
    )
    around = _around(phi, step)
    across = np.diff(_across(faces), axis=1)
    vector = np.stack([np.outer(around[a], across[b]) for a, b in ((1, 1), (2, 1), (0, 2))])
    pairs = (((3, 3), (5, 3), (1, 5)), ((5, 3), (4, 3), (2, 5)), ((1, 5), (2, 5), (0, 4)))
    tensor = np.array([[np.outer(around[a], across[b]) for a, b in row] for row in pairs])
    normals, links = _directions(phi, chi), _directions(grid.x_face, chi)
    return SpherePatch(grid, chi, faces, normals, links, np.outer(around[0], across[0]), vector, tensor)


class SphereFlow(FluxEffect):
    """Couette flows over the edges of the control volumes, with surface speeds that differ from link to link.

    The flow over an edge with the normal m is, in units of R^2 c and with the scaled gap H = 1 - e n / c,

        f = 1/2 int (w x n) m H ds = w (T H_l + S C e),
        T = 1/2 int n x m ds,    C = -1/2 int (n x m) (n - n_l) ds / c,

    with the gap H_l of the link and its direction n_l. This is exact: the net outflow of a full control volume is
    ``-N (e x w) / (2 c)``, and zero at an even gap, also at the pole. S is the slope of a limited gap, else 1.

    Attributes
    ----------
    turn, lean : (2, 3, n, m) and (2, 3, 3, n, m) arrays
        T and C on the links along phi and along chi.
    along, rest : (2, n, m) arrays
        Products w T and w C e of the last motion, 1/s.
    by_place : (2, 3, n, m) array
        w C, 1/(m s).
    slope : (2, n, m) array
        S.
    """

    changes_carriers, depends_on_speed = True, False

    def __init__(self, patch: SpherePatch, clearance: float) -> None:
        phi, step, below, faces = patch.grid.x, patch.grid.width_x[0], patch.faces[:-1], patch.faces[1:]
        ends = np.stack([patch.link_normals, 0.5 * (patch.normals + np.roll(patch.normals, -1, 2))])
        self.widths = patch.grid.width_z, patch.grid.width_x[:, None]
        self.turn, self.lean = np.zeros((2, 3, *patch.grid.shape)), np.zeros((2, 3, 3, *patch.grid.shape))
        # exact to round-off for edges up to 0.5 rad
        for at, weight in zip(*np.polynomial.legendre.leggauss(6), strict=True):
            # meridians, and circles of latitude, along which n x m ds is minus d n and d n
            chi, around = below + 0.5 * (1.0 + at) * (faces - below), phi + 0.5 * at * step
            n = np.stack([_directions(patch.grid.x_face, chi), _directions(around, faces)])
            turn = 0.5 * math.pi
            moved = np.stack([-_directions(patch.grid.x_face, chi + turn), _directions(around + turn, faces)])
            moved[1, 2] = 0.0
            moved[0] *= 0.25 * weight * (faces - below)
            moved[1] *= 0.25 * weight * step
            self.turn += moved
            self.lean -= moved[:, :, None] * (n - ends)[:, None] / clearance

    def take(self, spin: np.ndarray, place: np.ndarray, slope: np.ndarray) -> None:
        """Set w (3,), e (3,) and S."""
        self.along, self.by_place = np.tensordot(spin, self.turn, (0, 1)), np.tensordot(spin, self.lean, (0, 1))
        self.place, self.slope, self.rest = place, slope, np.tensordot(place, self.by_place, (0, 1))

    def flows(self, gap_x: np.ndarray, gap_z: np.ndarray) -> np.ndarray:
        """Couette flows (2, n, m) of a full film over the links; the last row has the flows over the last edge."""
        return np.asarray(self.along * np.stack([gap_x, gap_z]) + self.slope * self.rest)

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Set the carriers and their derivatives, divided by the speeds and widths by which the solver multiplies."""
        carriers = zip((vx, vz), self.widths, (flux.cx, flux.cz), (flux.cx_h, flux.cz_h), strict=True)
        flows = self.flows(gap_x, gap_z)
        for k, (v, width, out, slope_out) in enumerate(carriers):
            if v != 0.0:
                out[:], slope_out[:] = flows[k] / (v * width), self.along[k] / (v * width)

    def gradients(
        self, weights: np.ndarray, taken: np.ndarray, gaps: tuple[np.ndarray, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Derivatives to w (k, 3), to e (k, 3) and, through S, to the slope at the vertices (k, n, m).

        They are derivatives of sums, with ``weights`` (k, n m), of the outflow of the vertices by ``taken`` (2, n m)
        times f. The links' gaps (n, m) along phi and chi are constant.
        """
        shape, by_spin = gaps[0].shape, self.turn * np.stack(gaps)[:, None]
        by_flow = np.stack([drops(own.reshape(shape)) for own in weights]) * taken.reshape(2, *shape)
        by_spin += self.slope[:, None] * np.tensordot(self.lean, self.place, (2, 0))
        by_slope = sum(to_ends(by_flow[:, k] * self.rest[k], axis) for k, axis in enumerate((1, -1)))
        to = partial(np.tensordot, axes=((1, 2, 3), (0, 2, 3)))
        return to(by_flow, by_spin), to(by_flow, self.slope[:, None] * self.by_place), np.asarray(by_slope)


def _directions(phi: np.ndarray, chi: np.ndarray) -> np.ndarray:
    """Directions (3, n, m)."""
    sine = np.sin(chi)
    return np.stack(
        [np.outer(np.cos(phi), sine), np.outer(np.sin(phi), sine), np.outer(np.ones_like(phi), np.cos(chi))]
    )


def _around(phi: np.ndarray, step: float) -> np.ndarray:
    """Integrals (6, n) over columns of 1, cos, sin, cos^2, sin^2 and sin cos."""
    half, swing = 2.0 * math.sin(0.5 * step), 0.5 * math.sin(step)
    one = np.full_like(phi, step)
    return np.stack(
        [
            one,
            half * np.cos(phi),
            half * np.sin(phi),
            0.5 * one + swing * np.cos(2.0 * phi),
            0.5 * one - swing * np.cos(2.0 * phi),
            swing * np.sin(2.0 * phi),
        ]
    )


def _across(chi: np.ndarray) -> np.ndarray:
    """Antiderivatives (6, k) of sin times 1, sin, cos, sin^2, cos^2 and sin cos."""
    sine, cosine = np.sin(chi), np.cos(chi)
    return np.stack(
        [
            -cosine,
            0.5 * (chi - sine * cosine),
            0.5 * sine**2,
            cosine**3 / 3.0 - cosine,
            -(cosine**3) / 3.0,
            sine**3 / 3.0,
        ]
    )


def skew(v: np.ndarray) -> np.ndarray:
    """Matrix (3, 3) of the cross product with v (3,)."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def drag_of_moments(R: float) -> np.ndarray:
    """Return the map from moments over H (13,) to the shear (36, 13) per speed: [[K, -R a x], [R a x, R^2 K]]."""

    def drag(moments: np.ndarray) -> np.ndarray:
        K, turn = moments[0] * np.eye(3) - moments[4:].reshape(3, 3), R * skew(moments[1:4])
        return np.block([[K, -turn], [turn, R**2 * K]])

    return np.stack([drag(moments) for moments in np.eye(13)], axis=-1).reshape(36, 13)


# Least width of a patch, and least colatitude of its open end from either pole, rad.
LEAST_ANGLE = 0.05


@dataclass(frozen=True, kw_only=True)
class SphericalBearing(Checked):
    """A ball in a socket with oil between them, for `CreateLubricatedSphericalJoint` and `steady_spherical`.

    The socket is the part of a sphere between two circles around the joint's z axis, fixed in the housing. Colatitudes
    count from +z: (0, pi/2) is a hemispherical cup on the side of +z, which carries a ball that is pushed along +z. A
    socket that ends beyond pi/2 also holds the ball along -z. The edges are open to the ambient pressure. Equations and
    assumptions: `exudyn_ehd.joint.spherical.model`.

    Errors of the default grid. Squeeze force of the cup, against the closed form: 0.02 % up to eccentricity ratio 0.5,
    0.4 % at 0.9. Any motion in any direction, in sockets closed or open at the pole: force up to 1 % at eccentricity
    ratio 0.8 and 2.5 % at 0.9, where the ball is close to an edge; torque 0.5 %.

    Parameters
    ----------
    ball_radius : float
        R, m.
    radial_clearance : float
        c = socket radius - ball radius, m; at most 0.05 R.
    lubricant : Lubricant
        Lubricant with its ``pressure_law`` and ``density_law``. Its ``temperature_law`` acts with ``thermal``; without,
        it only sets the viscosity at ``lubricant.temperature``. A ``shear_law`` raises `InputError`.
    socket_angles : (float, float), default (0.0, pi / 2)
        Colatitudes from +z at which the socket begins and ends, rad; it begins at 0 (closed at the pole) or, with an
        opening around the axis, from 0.05 on.
    n_phi : int, default 48
        Vertices around the axis, at least 16.
    n_chi : int, default 24
        Intervals from edge to edge, or from the pole to the edge of a socket that is closed there; at least 4.
    cavitation : FullSommerfeld, Gumbel, SwiftStieber, ElrodAdams or Closure, default SwiftStieber()
        Cavitation model. Its rupture line lies on vertices; with ``line_in_cells=True`` it lies inside the cells, and
        the error of stiffness and damping falls from 7 to 1 %. Its ``cavity_pressure`` must not be above 0, the ambient
        pressure. `ElrodAdams` conserves the oil, which moves with the mean speed of the surfaces: the error of steady
        forces is up to 3 %, and 16 % where much void returns to the film (on 96 x 48, 1.2 and 6 %). With `ElrodAdams`,
        or with a ``density_law``, the line lies on vertices. `Closure` is a cavitation model of your own.
    contact : RegularisedWall or None, default None
        Smooth wall that carries load before the gap vanishes; None: a vanishing gap ends the run with an error.
    thermal : LumpedThermal or None, default None
        One temperature of the film, heated by shear and pressure flow. Oil that flows out over the edges, or is lost in
        cavities, is replaced by oil of the supply temperature. The film's volume is the socket's area times the
        clearance. None: isothermal, at ``lubricant.temperature``. `FilmEnergy` is not supported.

    Raises
    ------
    InputError
        For values outside their ranges, and for laws of the oil and closures that this film does not support.

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
    cavitation: SwiftStieber | Gumbel | FullSommerfeld | ElrodAdams | Closure = SwiftStieber()
    contact: RegularisedWall | None = None
    thermal: LumpedThermal | None = None

    # attributes of every bearing that a joint's checks and audits read
    bush = yielding = journal = asperity = roughness = wear = film = turbulence = inlet = None
    profiles = supply = bore_arcs = edge_pressures = ()
    end_pressures, squeeze = (0.0, 0.0), True
    levers = (1.0, 1.0, 1.0, 0.0)

    checks: ClassVar = {
        "ball_radius": POSITIVE,
        "radial_clearance": POSITIVE,
        "lubricant": (Lubricant,),
        "n_phi": partial(require_count, at_least=16),
        "n_chi": partial(require_count, at_least=4),
        "cavitation": (SwiftStieber, Gumbel, FullSommerfeld, ElrodAdams, Closure),
        "contact": (RegularisedWall, type(None)),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        name = "SphericalBearing"
        if not self.radial_clearance <= 0.05 * self.ball_radius:
            raise InputError(
                f"{name}.radial_clearance must be at most a twentieth of the ball's radius {self.ball_radius:g} m, for "
                f"which thin films are, got {self.radial_clearance!r}; if yours is diametral, halve it."
            )
        if (given := self.lubricant.shear_law) is not None:
            raise InputError(
                f"{name}.lubricant: a spherical film has no shear_law, got {type(given).__name__}: the law takes one "
                "sliding speed in one direction, but a ball slides past in another way at every place; give a "
                "Lubricant without it, with the viscosity at the film's shear rate."
            )
        first, last = require_vector(f"{name}.socket_angles", self.socket_angles, 2, "rad").tolist()
        end = math.pi - LEAST_ANGLE
        if not (first == 0.0 or first >= LEAST_ANGLE) or not first + LEAST_ANGLE <= last <= end:
            raise InputError(
                f"{name}.socket_angles must be (begin, end) in rad with begin = 0 or >= {LEAST_ANGLE}, end >= begin + "
                f"{LEAST_ANGLE} and end <= {end:.5g}, got {self.socket_angles!r}; use math.radians for degrees."
            )
        object.__setattr__(self, "socket_angles", (first, last))
        if self.cavitation.cavity_pressure > 0.0:
            raise InputError(
                f"{name}.cavitation must have a cavity_pressure <= 0 Pa, that of the open edges, got "
                f"{self.cavitation!r}."
            )
        carries = self.cavitation.conserves_mass or self.lubricant.density_law is not None
        if carries and self.cavitation.line_in_cells:
            raise InputError(
                f"{name}.cavitation: with ElrodAdams or a density_law a line inside the cells takes oil along at one "
                "speed, but the surface of a ball has another speed at every place; use line_in_cells=False, got "
                f"{self.cavitation!r}."
            )
        object.__setattr__(self, "cavitation", place_line(self.cavitation, False))
        if isinstance(self.thermal, FilmEnergy):
            raise InputError(
                f"{name}.thermal=FilmEnergy(...): its journal is equally warm all around, as it turns past hot and "
                "cold, but a ball that swings has hot and cold sides, which move with it; give a LumpedThermal(...)."
            )
        require_type(f"{name}.thermal", self.thermal, LumpedThermal, type(None))
        if self.thermal is not None:
            require_viscosities(f"{name}.thermal", self.thermal, self.lubricant)
        if self.contact is not None:
            require_number(
                f"{name}.contact: RegularisedWall.onset", self.contact.onset, "m", below=self.radial_clearance
            )

    def gap_normals(self) -> np.ndarray:
        """Directions (k, 4), the last column 0, along which the distance of the ball from the socket is computed."""
        normals = sphere_patch(1.0, self.socket_angles, self.n_phi, self.n_chi).normals.reshape(3, -1)
        return np.vstack((normals, 0.0 * normals[:1])).T

    def smallest_gap(self, place: np.ndarray) -> float:
        """Smallest gap (m) of the rigid surfaces for the ball's centre at ``place`` (3,), exact."""
        x, y, z = place.tolist()
        across = math.hypot(x, y)
        first, last = self.socket_angles
        nearest = min(max(math.atan2(across, z), first), last)
        return self.radial_clearance - (across * math.sin(nearest) + z * math.cos(nearest))

    @property
    def closure(self) -> Closure:
        """The cavitation model, whose line is placed."""
        return self.cavitation

    @property
    def journal_radius(self) -> float:
        """Radius of the ball, m, under the name that cylindrical bearings use."""
        return self.ball_radius

    @property
    def length(self) -> float:
        """Length of a journal of the same radius and projected area, pi R / 2, m."""
        return 0.5 * math.pi * self.ball_radius

    def reference_force(self, speed: float) -> float:
        """Reference force of a journal of that length, L D mu |omega| / psi^2, N; ``speed`` in rad/s."""
        psi = self.radial_clearance / self.ball_radius
        return 2.0 * self.ball_radius * self.length * self.lubricant.viscosity * abs(speed) / psi**2
