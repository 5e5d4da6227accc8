"""Film grid of a patch of a sphere between two circles about its axis, in Mercator's coordinates.

Directions n(phi, chi) = (sin chi cos phi, sin chi sin phi, cos chi), chi the colatitude from the socket's axis. With
s = ln tan(chi / 2) the map (phi, s) of the sphere is conformal, so that

    sin^2 chi div(h^3 grad p) = d_phi(h^3 d_phi p) + d_s(h^3 d_s p) :

links conduct as on a plane, and only areas know of the sphere. A `FilmGrid` with theta = phi and z = s is therefore
that of the sphere, for every solver. Rows are stretched in chi towards the open edges, where a ball that leans on one
has its steepest pressures, as those of cylindrical films (`exudyn_ehd.film.grid`). Control volumes end half-way between
rows, with the width d_chi / sin(chi) in s. A patch that is closed at the pole has its first row half an interval from
it, so that the control volumes there end at the pole in a point, through which nothing flows: no cell of its own is
needed, and the scheme stays of second order.

Integrals over control volumes (area, normal, products of two components of the normal) are exact, so that the areas
and the drag of a centred ball hold to rounding on any grid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.film.grid import FilmGrid

# Of the rows, 0 is uniform.
STRETCH = 0.75
# Rows of the six second moments xx, yy, zz, xy, xz, yz in the symmetric matrix of them.
COMPONENTS = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])


@dataclass(frozen=True, eq=False)
class SpherePatch:
    """A patch of the unit sphere.

    Attributes
    ----------
    grid : FilmGrid
        Vertices (n, m) at angles phi and s, links and fixed edges.
    chi : (m,) array
        Colatitudes of the rows, rad.
    normals, link_normals : (3, n, m) arrays
        Directions of the vertices and of the links i -> i+1.
    area : (n, m) array
    vector : (3, n, m) array
        Integral of the normal over each control volume.
    tensor : (6, n, m) array
        Integrals of the products of its components, in the order of `COMPONENTS`.
    """

    grid: FilmGrid
    chi: np.ndarray
    normals: np.ndarray
    link_normals: np.ndarray
    area: np.ndarray
    vector: np.ndarray
    tensor: np.ndarray


def sphere_patch(radius: float, angles: tuple[float, float], n_phi: int, n_chi: int) -> SpherePatch:
    """Patch of a sphere of ``radius`` (m) between two colatitudes (rad), with ``n_chi`` + 1 rows."""
    first, last = angles
    closed = first == 0.0
    # from the middle of the patch, which of a closed one is the pole, to its edges
    middle, half = (0.0, last) if closed else (0.5 * (first + last), 0.5 * (last - first))
    share = (np.arange(n_chi + 1) + 0.5) / (n_chi + 0.5) if closed else np.linspace(-1.0, 1.0, n_chi + 1)
    quarter = 0.5 * math.pi * STRETCH
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
    tensor = np.stack([np.outer(around[a], across[b]) for a, b in ((3, 3), (4, 3), (0, 4), (5, 3), (1, 5), (2, 5))])
    normals, links = _directions(phi, chi), _directions(grid.x_face, chi)
    return SpherePatch(grid, chi, normals, links, np.outer(around[0], across[0]), vector, tensor)


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
