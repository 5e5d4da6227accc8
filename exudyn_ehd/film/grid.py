"""The (theta, z) film grid: vertices, control volumes, links and integration weights.

Conventions: arrays are ``[theta, z]``; theta counts from the joint's x about its z axis; z runs from -L/2 to L/2.
Lengths are divided by the journal radius R (so that x = theta), gaps by the radial clearance c.

* theta: n vertices, one control volume of width 2 pi / n around each, links between neighbours, closed ring.
* z: n_z intervals, n_z + 1 vertices, the two end vertices on the bearing's ends. The vertices are stretched towards the
  ends, ``z = L/2 sin(pi a s / 2) / sin(pi a / 2)``, s uniform in [-1, 1]. The scheme is exact for an axial parabola,
  but not for the load near the ends. Integrals over z use Gregory's end weights 3/8, 7/6, 23/24 in s (fourth order),
  corrected so that 1, z^2 and z^4 are integrated exactly. Areas and the load of an axial parabola, aligned or tilted,
  are then exact to round-off on any grid. Below four intervals the trapezoidal rule is used.

Where supply areas have edges along z, rows lie on the edges. Every part between two edges has its own stretched rows
and weights (`rows_between`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, require_bool, require_count, require_number

# Largest axial stretching of a film model, and its check: larger values refine the ends more.
LARGEST_STRETCH = 0.95
STRETCH = partial(NOT_NEGATIVE, at_most=LARGEST_STRETCH, hint="0.75 suits most bearings.")


class Mesh(NamedTuple):
    """Metric of a `FilmGrid`, as arrays of the same names.

    Kernels receive plain tuples and convert them to this named one: when called from Python, numba would take as long
    for a named tuple as for running such a kernel.
    """

    width_x: np.ndarray
    width_z: np.ndarray
    link_x: np.ndarray
    link_z: np.ndarray


@dataclass(frozen=True, eq=False)
class FilmGrid:
    """Tensor-product film grid in scaled lengths (divided by ``reference_length``).

    Attributes
    ----------
    x, z : (n,), (m,) arrays
        Vertices; for a bearing x = theta.
    x_face : (n,) array
        Position of the link between column i and i + 1.
    width_x, width_z : (n,), (m,) arrays
        Control-volume widths.
    link_x : (n,) array
        Inverse distance between column i and i + 1 (cyclic); 0 where there is no link.
    link_z : (m - 1,) array
        Inverse distance between row j and j + 1.
    weight_z : (m,) array
        Integration weights along z.
    weight : (n, m) array
        Integration weights (area); products of weights in theta and z, except next to the edges of supply areas.
    lands : (n, m) array or None
        Integration weights of quantities outside of supply areas, such as the shear; None: ``weight``.
    fixed : (n, m) bool array
        Vertices with prescribed pressure.
    reference_length : float
        R in m.
    cuts : (2, n, m) array or None
        Factors on the conductances of links in theta and z that end at the edge of a supply area, and are therefore
        shorter than ``link_x`` and ``link_z`` tell; None: no such links.
    seals : pair of floats or None
        Scaled conductances of the seals at both ends per circumferential length, see
        `exudyn_ehd.film.supply.restrictors.sealed_grid`; None: open ends.
    """

    x: np.ndarray
    z: np.ndarray
    x_face: np.ndarray
    width_x: np.ndarray
    width_z: np.ndarray
    link_x: np.ndarray
    link_z: np.ndarray
    weight_z: np.ndarray
    weight: np.ndarray
    fixed: np.ndarray
    reference_length: float
    cuts: np.ndarray | None = None
    lands: np.ndarray | None = None
    seals: tuple[float | None, float | None] | None = None

    @property
    def shear_weight(self) -> np.ndarray:
        """Integration weights (n, m) of the shear between the surfaces."""
        return self.weight if self.lands is None else self.lands

    @property
    def shape(self) -> tuple[int, int]:
        """(n, m): vertices in theta and z, the ends included."""
        return self.x.size, self.z.size

    @cached_property
    def area(self) -> np.ndarray:
        """Control volumes (n, m)."""
        return np.outer(self.width_x, self.width_z)

    @cached_property
    def flows_along_z(self) -> bool:
        """Return whether there are links in z, through which oil reaches the ends."""
        return bool(self.link_z.any())

    @cached_property
    def edges(self) -> np.ndarray:
        """First and last column (k, 2) of every arc: a part between missing links; empty for a ring."""
        last = np.flatnonzero(self.link_x == 0.0)
        return np.column_stack(((np.roll(last, 1) + 1) % self.x.size, last))

    @cached_property
    def closed(self) -> bool:
        """Return whether the columns are a ring."""
        return not self.edges.size

    @cached_property
    def beside(self) -> tuple[np.ndarray, np.ndarray]:
        """Columns before and behind every column (n,); the column itself where there is no link."""
        here, ends = np.arange(self.x.size), self.link_x == 0.0
        return np.where(np.roll(ends, 1), here, np.roll(here, 1)), np.where(ends, here, np.roll(here, -1))

    @cached_property
    def differences_z(self) -> np.ndarray:
        """Matrix (m, m) from values at the rows to slopes in z, see `exudyn_ehd.film.reynolds.gap.gap_slopes`."""
        return np.asarray(np.gradient(np.eye(self.z.size), self.z, axis=0))

    @cached_property
    def mesh(self) -> tuple[np.ndarray, ...]:
        """Metric for kernels, fields of `Mesh`."""
        return self.width_x, self.width_z, self.link_x, self.link_z

    @cached_property
    def directions(self) -> tuple[np.ndarray, ...]:
        """Cosine and sine (n,) of theta at vertices and at links i -> i+1, and the rows z (m,), for kernels."""
        return np.cos(self.x), np.sin(self.x), np.cos(self.x_face), np.sin(self.x_face), self.z

    @cached_property
    def moments(self) -> np.ndarray:
        """Fields cos, sin, z cos, z sin and 1 at the vertices of a bearing, (5, n, m)."""
        flat, around = np.ones(self.shape), np.array(self.directions[:2])[:, :, None]
        return np.concatenate((around * flat, around * self.z, flat[None]))

    @cached_property
    def gap_shapes(self) -> np.ndarray:
        """Derivatives (2, n, m, 4) of the scaled gap, at vertices and on links in theta, to the journal's scaled
        pose."""
        normals = -np.array(self.directions[:4]).reshape(2, 2, -1).transpose(0, 2, 1)[:, :, None, None, :]
        heights = np.stack((np.ones_like(self.z), self.z), axis=1)[None, None, :, :, None]
        return np.ascontiguousarray((normals * heights).reshape(2, *self.shape, 4))

    def by_pose(self, fields: np.ndarray, on_links: int = 0) -> np.ndarray:
        """Return the sums (k, 4) of fields (k, n, m) times `gap_shapes`; ``on_links``: 0 at vertices, 1 on links in
        theta."""
        by_pose: np.ndarray = fields.reshape(len(fields), -1) @ self.gap_shapes[on_links].reshape(-1, 4)
        return by_pose

    @cached_property
    def link_widths(self) -> np.ndarray:
        """Widths (2, n, m) of the links in theta and z; 0 where there is none."""
        across = np.append(self.link_z != 0.0, False)
        return np.array((np.outer(self.link_x != 0.0, self.width_z), np.outer(self.width_x, across)))


def axial_metric(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Control-volume widths (m,) and inverse distances (m-1,) of axial vertices z (m,)."""
    dz = np.diff(z)
    width = np.zeros(z.size)
    width[:-1] += dz / 2
    width[1:] += dz / 2
    return width, 1.0 / dz


def _mirrored(values: np.ndarray, sign: float) -> np.ndarray:
    """Make values (m,) along z exactly symmetric, times ``sign``, if they are so up to round-off."""
    image = sign * values[::-1]
    same = np.allclose(values, image, rtol=0.0, atol=1e-14 * float(np.abs(values).max()))
    return 0.5 * (values + image) if same else values


def tensor_grid(
    x: np.ndarray,
    z: np.ndarray,
    width_x: np.ndarray,
    link_x: np.ndarray,
    reference_length: float,
    fixed: np.ndarray,
    weight_x: np.ndarray | None = None,
    weight_z: np.ndarray | None = None,
) -> FilmGrid:
    """Return the grid of columns x (n,) and rows z (m,); other parameters as for `FilmGrid`."""
    z = _mirrored(z, -1.0)
    width_z, link_z = axial_metric(z)
    weight_x = width_x if weight_x is None else weight_x
    weight_z = width_z if weight_z is None else _mirrored(weight_z, 1.0)
    return FilmGrid(
        x=np.ascontiguousarray(x),
        z=np.ascontiguousarray(z),
        x_face=np.ascontiguousarray(x + width_x / 2),
        width_x=np.ascontiguousarray(width_x),
        width_z=width_z,
        link_x=np.ascontiguousarray(link_x),
        link_z=link_z,
        weight_z=weight_z,
        weight=np.outer(weight_x, weight_z),
        fixed=np.ascontiguousarray(fixed),
        reference_length=float(reference_length),
    )


def axial_vertices(n_z: int, half_length: float, stretch: float) -> tuple[np.ndarray, np.ndarray]:
    """Stretched vertices (n_z + 1,) in [-half_length, half_length] and their integration weights.

    Source of the end weights: J. Gregory's formula with second differences, e.g. Hildebrand, Introduction to Numerical
    Analysis (1974), section 5.9. The correction to exact even moments is the smallest relative one (least squares).
    """
    s = np.linspace(-1.0, 1.0, n_z + 1)
    quarter = 0.5 * math.pi * stretch
    if stretch > 0.0:
        z = np.sin(quarter * s) / math.sin(quarter)
        slope = quarter * np.cos(quarter * s) / math.sin(quarter)
    else:
        z, slope = s, np.ones_like(s)
    z[0], z[-1] = -1.0, 1.0
    if n_z < 4:
        return half_length * z, half_length * axial_metric(z)[0]
    weight = (2.0 / n_z) * slope
    if n_z >= 6:
        weight[:3] *= 3 / 8, 7 / 6, 23 / 24
        weight[-3:] *= 23 / 24, 7 / 6, 3 / 8
    else:
        weight[0], weight[-1] = 0.5 * weight[0], 0.5 * weight[-1]
    return half_length * z, half_length * exact_weights(z, weight, 4)


def exact_weights(z: np.ndarray, weight: np.ndarray, power: int, step: int = 2) -> np.ndarray:
    """Correct integration weights on [-1, 1] to be exact for even powers of z up to ``power``; ``step`` 1: for all."""
    powers = range(0, power + 1, step)
    moments = np.array([z**k for k in powers])
    missing = np.array([(1.0 + (-1.0) ** k) / (k + 1) for k in powers]) - moments @ weight
    return weight * (1.0 + moments.T @ np.linalg.solve((moments * weight) @ moments.T, missing))


def rows_between(edges: Sequence[float], counts: Sequence[int], stretch: float) -> tuple[np.ndarray, np.ndarray]:
    """Return ascending vertices, one on every edge and ``counts`` intervals between two edges, and their weights.

    Every part is integrated by its own `axial_vertices`, so that pressures may have kinks at the edges.
    """
    z, weight = np.empty(sum(counts) + 1), np.zeros(sum(counts) + 1)
    first = 0
    for k, count in enumerate(counts):
        half = 0.5 * (edges[k + 1] - edges[k])
        part, part_weight = axial_vertices(count, half, stretch)
        if count in (2, 3):
            part_weight = half * exact_weights(part / half, part_weight / half, 2)
        z[first : first + count + 1] = edges[k] + half + part
        weight[first : first + count + 1] += part_weight
        first += count
        z[first] = edges[k + 1]
    z[0] = edges[0]
    return z, weight


def _check_grid(where: str, n_z: int, stretch: float, **flags: bool) -> None:
    require_count(f"{where}: n_z", n_z, at_least=1)
    require_number(f"{where}: stretch", stretch, at_least=0.0, below=1.0)
    for name, value in flags.items():
        require_bool(f"{where}: {name}", value)


def bearing_grid(
    radius: float,
    length: float,
    n_theta: int,
    n_z: int,
    *,
    stretch: float = 0.75,
    start_angle: float = 0.0,
    open_ring: bool = False,
    rows: tuple[np.ndarray, np.ndarray] | None = None,
) -> FilmGrid:
    """Grid of a journal bearing's film, for `solve_film`.

    Its vertices are at theta = ``grid.x``, rad, and z = ``grid.z * grid.reference_length``, m, from -L/2 to L/2.

    Parameters
    ----------
    radius, length : float
        Radius R and length L, m.
    n_theta, n_z : int
        Vertices around, intervals along z: the grid has n_theta x (n_z + 1) vertices.
    stretch : float, default 0.75
        Axial stretching a in [0, 1): 0 is uniform, larger values refine the ends.
    start_angle : float, default 0.0
        theta of the first column, rad.
    open_ring : bool, default False
        True: the first column has a prescribed pressure, so that the film starts and ends there. The vertices at both
        ends of the bearing have one in any case.
    rows : tuple of (m,) arrays or None, default None
        z / R of the axial vertices, from end to end, and their integration weights, also over R; they replace ``n_z``
        and ``stretch``.

    Returns
    -------
    FilmGrid

    Raises
    ------
    InputError
        For lengths that are not positive and finite, numbers of vertices or a stretch of which no grid can be made.

    Examples
    --------
    >>> grid = ehd.bearing_grid(0.025, 0.025, n_theta=48, n_z=6)
    >>> grid.shape
    (48, 7)
    """
    POSITIVE("bearing_grid: radius", radius)
    POSITIVE("bearing_grid: length", length)
    require_number("bearing_grid: start_angle", start_angle)
    require_count("bearing_grid: n_theta", n_theta, at_least=3)
    _check_grid("bearing_grid", n_z, stretch, open_ring=open_ring)
    step = 2.0 * math.pi / n_theta
    theta = start_angle + step * np.arange(n_theta)
    z, weight_z = axial_vertices(n_z, 0.5 * length / radius, stretch) if rows is None else rows
    fixed = np.zeros((n_theta, z.size), dtype=np.bool_)
    fixed[:, 0] = fixed[:, -1] = True
    fixed[0, :] |= open_ring
    width = np.full(n_theta, step)
    return tensor_grid(theta, z, width, 1.0 / width, radius, fixed, width, weight_z)


def long_bearing_grid(
    radius: float, length: float, n_theta: int, n_z: int, *, start_angle: float = 0.0, open_ring: bool = False
) -> FilmGrid:
    """Film grid of uncoupled slices at ``n_z`` Gauss-Legendre points; other parameters as for `bearing_grid`.

    Loads of a tilted journal are integrated exactly if those of the slices are polynomials of z.
    """
    step = 2.0 * math.pi / n_theta
    theta = start_angle + step * np.arange(n_theta)
    points, weights = np.polynomial.legendre.leggauss(n_z)
    half = 0.5 * length / radius
    width_x, width_z = np.full(n_theta, step), half * weights
    fixed = np.zeros((n_theta, n_z), dtype=np.bool_)
    fixed[0, :] = open_ring
    return FilmGrid(
        x=theta,
        z=half * points,
        x_face=theta + 0.5 * step,
        width_x=width_x,
        width_z=width_z,
        link_x=1.0 / width_x,
        link_z=np.zeros(n_z - 1),
        weight_z=width_z,
        weight=np.outer(width_x, width_z),
        fixed=fixed,
        reference_length=float(radius),
    )


def slider_grid(
    length: float,
    width: float,
    n_x: int,
    n_z: int,
    *,
    stretch: float = 0.75,
    sealed_sides: bool = False,
    reference_length: float | None = None,
) -> FilmGrid:
    """Grid of a plane slider's film, for `solve_film`: x in [0, length], z in [-width/2, width/2].

    Its vertices are at ``grid.x`` and ``grid.z`` times ``grid.reference_length``, m. The columns are the centres of n_x
    cells and two end columns of zero width, for the pressures at x = 0 and x = length. A gap may jump at the faces
    between cells. The grid has (n_x + 2) x (n_z + 1) vertices.

    Parameters
    ----------
    length, width : float
        Extent in x, the direction of sliding, and in z, m.
    n_x, n_z : int
        Cells in x, intervals in z.
    stretch : float, default 0.75
        Stretching in z in [0, 1): 0 is uniform, larger values refine the sides.
    sealed_sides : bool, default False
        True: no flow through the sides z = -width/2 and width/2 (with n_z = 1 a one-dimensional film). False: the sides
        have a prescribed pressure.
    reference_length : float or None, default None
        Length by which ``grid.x`` and ``grid.z`` are divided, m; None: ``length``.

    Returns
    -------
    FilmGrid

    Raises
    ------
    InputError
        For lengths that are not positive and finite, numbers of vertices or a stretch of which no grid can be made.

    Examples
    --------
    >>> grid = ehd.slider_grid(0.1, 0.05, n_x=40, n_z=8)
    >>> grid.shape
    (42, 9)
    """
    scale = length if reference_length is None else reference_length
    for name, value in (("length", length), ("width", width), ("reference_length", scale)):
        POSITIVE(f"slider_grid: {name}", value)
    require_count("slider_grid: n_x", n_x, at_least=1)
    _check_grid("slider_grid", n_z, stretch, sealed_sides=sealed_sides)
    step = length / scale / n_x
    x = np.concatenate(([0.0], step * (np.arange(n_x) + 0.5), [length / scale]))
    cell = np.concatenate(([0.0], np.full(n_x, step), [0.0]))
    distance = np.diff(x)
    link = np.concatenate((1.0 / distance, [0.0]))
    z, weight_z = axial_vertices(n_z, 0.5 * width / scale, stretch)
    fixed = np.zeros((n_x + 2, n_z + 1), dtype=np.bool_)
    fixed[0] = fixed[-1] = True
    if not sealed_sides:
        fixed[:, 0] = fixed[:, -1] = True
    return tensor_grid(x, z, cell, link, scale, fixed, cell, weight_z)
