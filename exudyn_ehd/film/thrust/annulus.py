"""Grid of an annulus in the logarithm of its radius.

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
from dataclasses import replace

import numpy as np

from exudyn_ehd.film.differences import drop_weights, drops, on_links, to_ends
from exudyn_ehd.film.grid import FilmGrid, axial_vertices, bearing_grid, rows_between
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.film.thrust.options import StepLand, TaperLand, ThrustFaces

# Columns and rows of plane faces.
COLUMNS, ROWS = 96, 10
# Columns on the ring's width, and columns of a pad. The error falls with their inverse square, and the time grows in
# proportion: `ThrustFaces` states the errors of these numbers, measured in tests/film/thrust/test_annulus.py.
ON_WIDTH, OF_PAD = 12.0, 16
# Fewest columns of a land or a step, and of a taper, but no more than 3/8 of the pad's. Fewer miss the slope of short
# tapers and the damping of short lands, more leave too few to the rest of the pad.
LEAST, OF_TAPER = 5, 6
# Most columns, beyond which narrow rings have fewer than ON_WIDTH.
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
    """Grid of an annulus with its weights; lengths over R.

    Parameters
    ----------
    inner, outer : float
        Radii, m.
    n_theta, n_r : int
        Vertices around, intervals across.
    columns : (n,) array, optional
        Angles of the vertices, increasing from 0 on, rad; they replace ``n_theta`` equal steps.

    Attributes
    ----------
    scale : float
        R, m.
    grid : FilmGrid
    r : (m,) array
        Radii of the rows.
    weight : (n, m) array
        Of integrals over the area.
    square : (m,) array
        See the module.
    sides : (2, n, 1) array
        Share of a vertex' control volume behind and ahead of it in theta.
    link_weight : (n, m) array
        Of integrals over the area from values on the links i -> i+1.
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
    ) -> None:
        length = math.log(outer / inner)
        self.scale = R = math.sqrt(inner * outer)
        s, weight = axial_vertices(n_r, 0.5 * length, STRETCH)
        r = np.exp(s)
        weight = _exact_load(r, s, weight)
        self.grid: FilmGrid = bearing_grid(R, R * length, n_theta, n_r, rows=(s, weight))
        if columns is not None:
            self.grid = _on_columns(self.grid, columns)
        steps = np.diff(self.grid.x, append=2.0 * math.pi + self.grid.x[0])
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
        # with which an even pressure pulls at no vertex of an even gap
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


def _on_columns(grid: FilmGrid, theta: np.ndarray) -> FilmGrid:
    """Return the grid with its columns at these angles (n,)."""
    step = np.diff(theta, append=2.0 * math.pi + theta[0])
    width = 0.5 * (step + np.roll(step, 1))
    return replace(
        grid,
        x=theta,
        x_face=theta + 0.5 * step,
        width_x=width,
        link_x=1.0 / step,
        weight=np.outer(width, grid.weight_z),
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
        """Weigh the carriers in theta, and add to the conductances along the radius, with their derivatives."""
        flux.cx[:] = gap_x * self.square
        flux.cx_h[:] = self.square
        added = gap_z * self.edges + self.skew
        # negative only where a collar is pressed into one side
        flux.gz[:] += np.maximum(added, 0.0)
        flux.gz_h[:] += self.edges * (added > 0.0)
