"""Description of end faces with oil films, and their grid: an annulus in the logarithm of its radius.

With s = ln(r / R), R = sqrt(r_i r_o), Reynolds' equation of a face, times r^2,

    d/dtheta (h^3 dp/dtheta) + d/ds (h^3 dp/ds) = 12 mu r^2 (omega / 2 dh/dtheta + dh/dt),

is that of a bearing's unrolled film: links conduct the same, and what moves the oil has the weight r^2. So the annulus
is a `FilmGrid` of theta and s, its Couette flows go through `AnnularFlow`, and rates of the gap are handed to the
solver with the weights ``square`` (m,), in place of r^2 at the vertices: of one row

    square_j width_j = (D (r^2)_j+1/2 - D (r^2)_j-1/2) / 4,    D difference over distance in s,

with which pressures in proportion to r^2, ln r and 1, those of a squeezed washer, are exact at the vertices. Weights of
integrals over s are corrected so that the loads of these three, and the torque of a plane film, are exact too.

Columns lie on the edges of pads, where pressure has kinks. Pressure decays from there as exp(-pi theta / L), with the
ring's width L = ln(r_o / r_i), and likewise from the radii over the length of a pad. Between two edges columns are
stretched towards both. Integrals over theta are sums over the control volumes, as the balances are. The load of the
pressure about a step then hardly depends on the distance of the columns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar, TypeAlias

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure, FullSommerfeld, Gumbel, SwiftStieber
from exudyn_ehd.film.grid import FilmGrid, axial_vertices, bearing_grid, rows_between
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.reynolds.gap import drop_weights, drops, on_links, to_ends
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.status import (
    POSITIVE,
    SHARE,
    Checked,
    InputError,
    require_bool,
    require_count,
    require_integer,
    require_vector,
)

# Names of attributes of a bearing.
BearingOptions: TypeAlias = Mapping[str, Any]
# Largest number of pads of a face for which the error of its default grid was measured.
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
    """Pads of a thrust face: the recess falls from ``depth`` to 0 over the first ``share`` of each; the rest is flat.

    On the bush's side of both faces, fixed in the housing. The first pad begins at theta = 0, the joint's x; pads
    follow each other about +z without grooves.

    Parameters
    ----------
    pads : int
        Number of pads around the face.
    depth : float
        Depth of the recess below the land where a pad begins, m; 1 to 3 minimum film thicknesses carry most.
    share : float, default 0.75
        Share of a pad's length that is tapered, above 0 up to 1.
    reverse : bool, default False
        False: pads for a positive spin about z. True: for a negative one, tapered from their other end.

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
        As for `TaperLand`.
    depth : float
        Depth of the recess below the land, m; 0.7 of the minimum film thickness carries most.
    share : float, default 0.75
        Share of a pad's length that is recessed, above 0 up to 1; 0.5 carries most in pads longer than they are wide,
        0.6 in others. A depth of 1.0 with a share of 0.7, as for pads without ends, carries 5 to 13 % less.
    reverse : bool, default False
        As for `TaperLand`.

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

    They carry axial load and tilting moments. Upper face at z = L/2, lower one at -L/2; the collars lie outside, so
    that a journal that moves along +z opens the upper gap and closes the lower one, whose film pushes it back:

        h = clearance + s (zeta - bx X - by Y) + d(theta),     s = 1 upper, -1 lower,

    with the journal's axial position zeta (``axial_position``, m; 0: equal gaps), the slopes bx, by of its axis, rad,
    the point (X, Y) of the face in the joint frame, and the depth d of the pads (`exudyn_ehd.film.thrust.face`).

    Plane parallel faces carry by squeeze alone: for a steady axial load add pads, pressures or a contact. The faces
    have the bearing's lubricant with all laws, and ``turbulence`` by the Reynolds number at every radius, which begins
    at 1440 unless the law has an ``onset``. The bearing's ``roughness``, ``asperity``, ``wear``, ``profile`` and
    ``contact`` are those of the bore: faces are smooth. Their cavities have no memory: if the bore has `ElrodAdams`,
    give the faces a ``cavitation`` of their own.

    Temperature. With `LumpedThermal` faces have the one temperature of the bearing, and their power is part of the heat
    that sets it. With `FilmEnergy` each face has the temperature of the oil that leaves the bore at its end, the mean
    over the flow. Its own heat is omitted: with a power P of a face and an oil flow Q through it, its film is warmer by
    about P / (2 rho c Q) in the mean, with some 3 % less viscosity per kelvin: 5 K and 14 % for six tapered pads of 26
    to 45 mm, 40 um and ISO VG 46 at 300 rad/s. The audit of a joint has an estimate.

    Largest error of the default grid, against a grid four times as fine in both directions (Swift-Stieber, inner over
    outer radius 0.35 to 0.85, 3 to 16 pads, share 0.2 to 0.9, depth 0.3 to 3 times the gap of the land, axial position
    -0.8 to 0.5 clearances, tilt up to 0.8 of the tilt that closes the gap):

    ======  =====  =========  =============================  =============  ===============
    faces   force  stiffness  damping                        torque, power  inflow, outflow
    ======  =====  =========  =============================  =============  ===============
    pads    1.5 %  2 %        5 %; 2.5 % of 95 % of faces    0.6 %          1 %
    plane   0.4 %  0.6 %      2 %                            0.1 %          1 %
    ======  =====  =========  =============================  =============  ===============

    The error of the flows is 2 % with pressures at the radii or in narrower rings. Columns of the grid lie on the edges
    of the pads, where films end; so faces with pads have their rupture line on vertices, whatever
    `SwiftStieber.line_in_cells` says.

    Parameters
    ----------
    inner_radius, outer_radius : float
        Of the faces, m; the inner one at least the journal's radius.
    clearance : float
        Gap of either face, on the lands, with the journal in the middle, m: half of the axial play.
    profile : TaperLand, StepLand or None, default None
        Pads on both faces; None: plane faces.
    cavitation : SwiftStieber, FullSommerfeld, Gumbel, Closure or None, default None
        Cavitation model of the faces; None: that of the bearing.
    contact : RegularisedWall or None, default None
        Smooth wall that carries load before a gap vanishes; None: a vanishing gap ends the run with an error.
    inner_pressures : (float, float) or None, default None
        Gauge pressures at the inner radius of lower and upper face, Pa; None: the bearing's ``end_pressures``.
    outer_pressures : (float, float), default (0.0, 0.0)
        Gauge pressures at the outer radius of lower and upper face, Pa.
    lower, upper : bool, default True
        True: this face has a film.
    n_theta, n_r : int or None, default None
        Grid: vertices around, at least 16 and 8 a pad, rounded up to the same number in every pad; intervals from inner
        to outer radius, at least 6. None: the default grid, for up to 16 pads; 96 and 10 for plane faces.

    Raises
    ------
    InputError
        For values outside their ranges.

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
    cavitation: SwiftStieber | Gumbel | FullSommerfeld | Closure | None = None
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
        "profile": (TaperLand, StepLand, type(None)),
        "cavitation": (SwiftStieber, Gumbel, FullSommerfeld, Closure, type(None)),
        "contact": (RegularisedWall, type(None)),
    }

    @property
    def grid(self) -> tuple[int, int, np.ndarray | None, None]:
        """Arguments of the `Annulus` of a face that come after its radii."""
        return *face_grid(self), None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.inner_radius < 0.99 * self.outer_radius:
            raise InputError(
                f"ThrustFaces.inner_radius must be below 0.99 of the outer radius {self.outer_radius!r} m, got "
                f"{self.inner_radius!r} m; the film is the ring between them."
            )
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
    """Raise `InputError` for faces that do not fit their bearing, and for options that their films do not support.

    Parameters
    ----------
    bearing : mapping
        Attributes of the `JournalBearing`.
    """
    faces = bearing["thrust"]
    if faces is None:
        return
    oil, closure, radius = bearing["lubricant"], faces.cavitation or bearing["cavitation"], bearing["journal_radius"]
    if closure.conserves_mass:
        raise InputError(
            "JournalBearing.thrust=ThrustFaces(...) does not go with ElrodAdams(...): cavities on faces have no "
            "memory; give the faces a model of their own, ThrustFaces(cavitation=SwiftStieber(), ...)."
        )
    check_shear_law("JournalBearing.thrust=ThrustFaces(...)", oil)
    if faces.inner_radius < radius:
        raise InputError(
            f"ThrustFaces.inner_radius must be at least the journal's radius {radius:g} m, got "
            f"{faces.inner_radius:g} m; the faces lie around the bore."
        )
    inner = bearing["end_pressures"] if faces.inner_pressures is None else faces.inner_pressures
    lowest, cavity_pressure = min(*inner, *faces.outer_pressures), closure.cavity_pressure
    if cavity_pressure > lowest:
        raise InputError(
            f"{'ThrustFaces' if faces.cavitation else 'JournalBearing'}.cavitation: the cavity_pressure must not "
            f"exceed the pressures at the edges of the thrust faces, {lowest:g} Pa, got {cavity_pressure:g} Pa; all "
            "are gauge pressures, lower the cavity pressure."
        )


def check_shear_law(where: str, oil: Lubricant) -> None:
    """Raise `InputError` for a shear law by gap and sliding speed, which holds at one radius only.

    Other laws depend on the shear rate at every height of the film, and so hold at every radius.
    """
    if oil.shear_law is not None and not hasattr(oil.shear_law, "relaxation_time"):
        raise InputError(
            f"{where} does not go with Lubricant.shear_law={type(oil.shear_law).__name__}(...), a law by the gap and "
            "the sliding speed of a bore: on a face the speed grows with the radius; take a law of the shear rate, "
            "such as CarreauShear(...)."
        )


# Columns and rows of plane faces.
COLUMNS, ROWS = 96, 10
# Columns on the ring's width, and columns of a pad. The error falls with their inverse square, and the time grows in
# proportion: `ThrustFaces` states the errors of these numbers, measured in tests/film/thrust/test_annulus.py.
ON_WIDTH, OF_PAD = 12.0, 16
# Fewest columns of a land or a step, and of a taper, but no more than 3/8 of the pad's columns. With fewer, the slope
# of short tapers and the damping of short lands are wrong; with more, the rest of the pad has too few.
LEAST, OF_TAPER = 5, 6
# Most columns; this limit gives narrow rings fewer than ON_WIDTH columns on their width.
MOST_COLUMNS = 320
# Rows: ROWS_BESIDES, and 2 pi times the ring's width over the length of a pad, or of one whose recess has the share
# SHORT; at most MOST_ROWS. More lower the error of the flows at the radii.
ROWS_BESIDES, SHORT, MOST_ROWS = 8.0, 0.45, 40
# Stretch of rows, and of columns between two edges, as in `exudyn_ehd.film.grid.axial_vertices`.
STRETCH = 0.75


def face_grid(faces: ThrustFaces) -> tuple[int, int, np.ndarray | None]:
    """Return ``n_theta``, ``n_r`` and ``columns`` of the `Annulus` of faces."""
    profile, n_theta, n_r = faces.profile, faces.n_theta, faces.n_r
    if profile is None:
        return n_theta or COLUMNS, n_r or ROWS, None
    width, turn = math.log(faces.outer_radius / faces.inner_radius), 2.0 * math.pi
    wanted = max(OF_PAD * profile.pads, min(ON_WIDTH * turn / width, MOST_COLUMNS)) if n_theta is None else n_theta
    layers = profile.pads * width * max(1.0, SHORT / profile.share)
    rows = min(max(ROWS, 2 * math.ceil(0.5 * (ROWS_BESIDES + layers))), MOST_ROWS)
    columns = pad_columns(profile, math.ceil(wanted / profile.pads))
    return columns.size, n_r or rows, columns


def pad_columns(profile: TaperLand | StepLand, count: int) -> np.ndarray:
    """Angles (n,), rad, of ``count`` columns a pad with one on every edge."""
    edges, pitch = profile.edges, 2.0 * math.pi / profile.pads
    least, land = (min(k, 3 * count // 8) for k in (OF_TAPER if isinstance(profile, TaperLand) else LEAST, LEAST))
    recess = min(max(round(count * profile.share), least), count - land)
    counts = [recess, count - recess][:: -1 if profile.reverse else 1] if len(edges) == 3 else [count]
    theta, _ = rows_between([pitch * edge for edge in edges], counts, STRETCH)
    return (pitch * np.arange(profile.pads)[:, None] + theta[:-1]).ravel()


class Annulus:
    """Grid of an annulus, or of a sector of one, with its weights; lengths over R.

    The pressure at both edges of a sector is prescribed, and has to be that at its radii, because ``along`` and
    ``across`` omit flow along its edges.

    Parameters
    ----------
    inner, outer : float
        Radii, m.
    n_theta, n_r : int
        Vertices around, intervals across.
    columns : (n,) array, optional
        Angles of the vertices, increasing, rad; they replace ``n_theta`` equal steps.
    sector : (n,) array, optional
        Integration weights of these columns, of which the first and the last are the edges of a sector.

    Attributes
    ----------
    scale : float
        R, m.
    grid : FilmGrid
    r : (m,) array
        Radii of the rows.
    weight : (n, m) array
        Weights of integrals over the area.
    square : (m,) array
        Weights in place of r^2 at the vertices, see the module's docstring.
    sides : (2, n, 1) array
        Shares of a vertex's control volume before and after the vertex in theta.
    link_weight : (n, m) array
        Weights of integrals over the area, for values on the links i -> i+1.
    moments, link_moments : (3, n, m), (4, n, m) arrays
        1, x and y at the vertices; 1, x, y and r^2 on the links i -> i+1.
    along, across : (3, n, m) arrays
        Of links in theta and s: ``sum along h (p_i - p_i+1) + across h (p_j - p_j+1) = -int h u . grad p dA`` with
        the velocities u of a turn about the axis and of shifts along x and y.
    """

    def __init__(
        self,
        inner: float,
        outer: float,
        n_theta: int,
        n_r: int,
        columns: np.ndarray | None = None,
        sector: np.ndarray | None = None,
    ) -> None:
        length = math.log(outer / inner)
        self.scale = R = math.sqrt(inner * outer)
        s, weight = axial_vertices(n_r, 0.5 * length, STRETCH)
        r = np.exp(s)
        weight = _exact_load(r, s, weight)
        self.grid: FilmGrid = bearing_grid(R, R * length, n_theta, n_r, rows=(s, weight))
        if columns is not None:
            self.grid = _on_columns(self.grid, columns, sector)
        # nothing lies between the last column of a sector and its first
        steps = np.diff(self.grid.x, append=self.grid.x[-1] if sector is not None else 2.0 * math.pi + self.grid.x[0])
        self.sides = 0.5 * np.array([np.roll(steps, 1), steps])[:, :, None] / self.grid.width_x[:, None]
        self.link_weight = np.outer(steps, weight * r**2)
        self.r, width = r, self.grid.width_z
        self.weight = self.grid.weight * r**2
        self.square = r**2
        self.square[1:-1] = 0.25 * np.diff(np.diff(r**2) / np.diff(s)) / width[1:-1]
        cos_x, sin_x, cos_f, sin_f, _ = self.grid.directions
        flat = np.ones(self.grid.shape)
        self.moments = np.array([flat, np.outer(cos_x, r), np.outer(sin_x, r)])
        self.link_moments = np.array([flat, np.outer(cos_f, r), np.outer(sin_f, r), flat * r**2])
        turn = np.broadcast_to(self.square * width, self.grid.shape)
        self.along = np.array([turn, -np.outer(sin_f, r * width), np.outer(cos_f, r * width)])
        # so that a uniform pressure in a uniform gap has no force on a vertex
        between = np.append(0.5 * (r[0] + r[1]) + np.cumsum(r * width)[:-1] - r[0] * width[0], 0.0)
        outward = np.array([np.zeros_like(cos_f), sin_f - np.roll(sin_f, 1), np.roll(cos_f, 1) - cos_f])
        self.across = outward[:, :, None] * between

    def link_rows(self, H: np.ndarray, HF: np.ndarray) -> np.ndarray:
        """Weights (3, n, m) of the pressures in the sums of ``along`` and ``across`` for the gaps (n, m)."""
        return np.asarray(drop_weights(np.array((self.along * HF, self.across * on_links(H)[1]))).sum(axis=0))

    def link_gradients(self, P: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (3, n, m) of these sums to the gaps at the vertices and on the links for pressures P (n, m)."""
        x, z = drops(P)
        return to_ends(self.across * z, -1), self.along * x


def _on_columns(grid: FilmGrid, theta: np.ndarray, sector: np.ndarray | None) -> FilmGrid:
    """Return the grid with its columns at these angles (n,); ``sector`` (n,) as in `Annulus`."""
    step = np.diff(theta, append=2.0 * math.pi + theta[0] if sector is None else theta[-1])
    width, fixed = 0.5 * (step + np.roll(step, 1)), np.zeros((theta.size, grid.z.size), dtype=np.bool_)
    fixed[:, [0, -1]] = True
    fixed[[0, -1]] |= sector is not None
    return replace(
        grid,
        x=theta,
        x_face=theta + 0.5 * step,
        width_x=width,
        link_x=np.divide(1.0, step, out=np.zeros_like(step), where=step > 0.0),
        weight=np.outer(width if sector is None else sector, grid.weight_z),
        fixed=fixed,
    )


def products(fields: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Sums (k, l) over the grid of all products of fields (k, n, m) with others (l, n, m)."""
    return np.asarray(fields.reshape(len(fields), -1) @ others.reshape(len(others), -1).T)


def _exact_load(r: np.ndarray, s: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Weights (m,) over s with the smallest relative change that integrates r^2 times 1, r^2 and ln r exactly."""
    a, b = s[0], s[-1]
    moments = np.array([r**2, r**4, r**2 * s])
    two, four = 0.5 * (r[-1] ** 2 - r[0] ** 2), 0.25 * (r[-1] ** 4 - r[0] ** 4)
    logarithm = 0.5 * (b * r[-1] ** 2 - a * r[0] ** 2) - 0.5 * two
    missing = np.array([two, four, logarithm]) - moments @ weight
    return np.asarray(weight * (1.0 + moments.T @ np.linalg.solve((moments * weight) @ moments.T, missing)))


class AnnularFlow(FluxEffect):
    """Flux effect of an annulus with a profile on the carriers and conductances of its links.

    Couette flows around it have the weight r^2. A column between two gaps, h + e_1 over the share s_1 of its width and
    h + e_2 over the rest s_2, with the mean h, conducts along the radius

        s_1 (h + e_1)^3 + s_2 (h + e_2)^3 = h^3 + 3 h (s_1 e_1^2 + s_2 e_2^2) + s_1 e_1^3 + s_2 e_2^3.

    Parameters
    ----------
    square : (m,) array
        Of `Annulus`.
    sides, steps : (2, n, 1) arrays
        s and e of every column, e scaled as gaps.
    """

    changes_carriers = True
    depends_on_speed = False

    def __init__(self, square: np.ndarray, sides: np.ndarray, steps: np.ndarray) -> None:
        self.square = square
        self.edges, self.skew = 3.0 * (sides * steps**2).sum(axis=0), (sides * steps**3).sum(axis=0)

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Weight the carriers in theta, and add to the conductances along the radius, with their derivatives."""
        flux.cx[:] = gap_x * self.square
        flux.cx_h[:] = self.square
        added = gap_z * self.edges + self.skew
        # negative only where a collar is pressed into one of both gaps
        flux.gz[:] += np.maximum(added, 0.0)
        flux.gz_h[:] += self.edges * (added > 0.0)
