"""Pressures of oil films on a bore, and the modes that they need.

A bore under the pressure p is displaced by ``C p``, with its compliance C. Modes ``C P`` of pressures P displace it by

    C P (P^T C P)^-1 P^T C p,

the best displacement of their span in the strain energy. P are the leading pressures of a large set of films, those
that leave the least strain energy of the set to the modes behind them: with P in candidates Q, ``Q^T C Q = R^T R`` and
the set's covariance ``Q S S^T Q^T``, the modes are the left singular vectors of R S (proper orthogonal decomposition).

The films are those of bearings of finite length on the film's own length,

    p ~ -(dh/dtheta) / h^3 (1 - cosh(a zeta) / cosh(a)),   h = 1 + (e + b zeta) . (cos theta, sin theta),

with zeta = 2 z / length, eccentricities e up to 0.95 in all directions, slopes b in all directions, and profiles along
z from the short bearing's parabola (small a) to the nearly even pressure of a soft bush (large a). The candidates are

    q = {1, cos(n theta), sin(n theta)} P_l(zeta) (1 - zeta^2),   n <= N, l <= L,

with Legendre's polynomials P_l, and uniform and axially linear pressures, which pressurised ends need.

The number of modes is the smallest one whose error is within the tolerance. The error is that of the radial
displacement in the root mean square over the film's surface, between the mesh's nodes too, the largest one under films
that are not in the set. It counts over the displacement, but over no more than `HELD_SHAPE` times the part of it beyond
two waves around: a bush on a seat, a slender eye and a bent pin move by far more than the film is thick, and over that
every error would look small, while the film sees what the local deformation lacks.

Source of the idea: L. Sirovich, Quarterly of Applied Mathematics 45 (1987) 561; derived here for pressures on a bore.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial.legendre import legval
from scipy.linalg import block_diag, eigh
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.mesh import Surface, directed
from exudyn_ehd.solid.unrolled import Unrolled
from exudyn_ehd.status import InputError

LARGEST_WAVE, LARGEST_AXIAL = 24, 10
# Eccentricity ratios, slopes (share of the gap left at the loaded side), their directions (rad, from that of the
# eccentricity) and decays towards the ends of the set of films, and of those that measure the error. A wider set
# takes more modes.
SET = (0.3, 0.6, 0.85, 0.95), (0.35, 0.7), (0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi), (0.5, 4.0, 12.0, 40.0)
MEASURE = (0.5, 0.75, 0.9), (0.5,), (0.8, 2.4, 3.9, 5.5), (2.0, 20.0)
# Directions of the eccentricity in the films that measure the error, rad.
DIRECTIONS = 0.2 + 2.0 * np.pi * np.arange(6) / 6.0
# Largest scale of an error, in parts of the displacement beyond two waves around: what the whole displacement is in a
# bush whose outer surface is held.
HELD_SHAPE = 2.2
# Share of the energy below which a combination of pressures adds nothing but round-off.
DEPENDENT = 1e-11
# Weight of uniform and linear pressures over that of all films: their modes leave no more than its inverse of them.
CERTAIN = 1e3
# Singular values this close belong to a pair, cos and sin, that the number of modes must not part.
PAIR = 1e-3
# Vertices around and along of the fit of films by candidates.
FIT = 256, 64
# Least number of points around and along on the film's surface: beyond the orders of the pressures.
AROUND, ALONG = 144, 16
SETTINGS = (LARGEST_WAVE, LARGEST_AXIAL, SET, MEASURE, (*DIRECTIONS,), HELD_SHAPE, DEPENDENT, CERTAIN, PAIR, FIT)


class FilmSurface:
    """Points on the faces of a bore under a film.

    Parameters
    ----------
    faces : Unrolled
    points : (p,) arrays
        Angle [rad], z [m] and weight, as `film_points` returns them.
    length : float
        Length of the film [m].
    frame : ndarray, shape (3, 3)
        Columns are the axes of the bore in the frame of the displacements.

    Attributes
    ----------
    theta, zeta, weight : ndarray, shape (p,)
    radial : csr_matrix, shape (p, 3 n)
        Radial displacements at the points from displacements at the nodes of the faces.
    """

    def __init__(
        self, faces: Unrolled, points: tuple[np.ndarray, np.ndarray, np.ndarray], length: float, frame: np.ndarray
    ) -> None:
        self.theta, z, self.weight = points
        self.zeta = 2.0 * z / length
        normal = np.stack([np.cos(self.theta), np.sin(self.theta), np.zeros_like(z)], axis=1) @ frame.T
        self.radial: csr_matrix = directed(faces.interpolation(self.theta, z), normal)
        self._root = np.sqrt(self.weight)[:, None]
        one, two = (np.stack([np.cos(n * self.theta), np.sin(n * self.theta)], axis=1) for n in (1, 2))
        self._round = np.concatenate((np.ones_like(one[:, :1]), one, two), axis=1)
        self._rigid = self._fields(one, self.zeta[:, None] * one)

    def pressures(self, tilted: bool) -> tuple[np.ndarray, int]:
        """Pressures (p, c + t) of candidates and of measuring films, and c."""
        candidates, films = (f(self.theta, self.zeta, tilted) for f in (candidate_pressures, measuring_pressures))
        return np.concatenate((candidates, films.T), axis=1), candidates.shape[1]

    def loads(self, pressures: np.ndarray) -> np.ndarray:
        """Consistent nodal forces (3 n, k) of pressures (p, k), per area of the film's surface."""
        return np.asarray(self.radial.T @ (self.weight[:, None] * pressures))

    def weighted(self, displacements: np.ndarray) -> np.ndarray:
        """Radial displacements (p, k) times the root of the weights, of nodal displacements (3 n, k)."""
        return np.asarray(self._root * (self.radial @ displacements))

    def _fields(self, *fields: np.ndarray) -> np.ndarray:
        """Orthonormal basis (p, f) of fields (p, ...) in `weighted` displacements."""
        return np.linalg.qr(self._root * np.concatenate(fields, axis=1))[0]

    def without_rigid(self, weighted: np.ndarray) -> np.ndarray:
        """Return `weighted` without the rigid motions that fit it best: cos, sin, zeta cos and zeta sin."""
        return weighted - self._rigid @ (self._rigid.T @ weighted)

    def scale(self, weighted: np.ndarray) -> np.ndarray:
        """Size (k,) over which an error of `weighted` displacements counts."""
        two_waves = self._fields(self._round, self.zeta[:, None] * self._round)
        local = weighted - two_waves @ (two_waves.T @ weighted)
        return np.minimum(np.linalg.norm(weighted, axis=0), HELD_SHAPE * np.linalg.norm(local, axis=0))

    def odd_share(self, weighted: np.ndarray) -> float:
        """Largest share of `weighted` displacements that is linear in zeta, up to two waves around."""
        odd = self._fields(self.zeta[:, None] * self._round)
        return float((np.linalg.norm(odd.T @ weighted, axis=0) / np.linalg.norm(weighted, axis=0)).max())


def film_points(faces: Unrolled, length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles [rad], z [m] and weights of sum one (p,) of points on the surface of a film, parted where faces meet.

    Points of a `Surface` that lie in its holes are left out.
    """
    cuts, half = faces.cuts, 0.5 * length
    around, width = _points(0.0, 2.0 * np.pi, cuts[0], AROUND)
    along, height = _points(-half, half, cuts[1], ALONG)
    T, Z = (x.ravel() for x in np.meshgrid(around, along, indexing="ij"))
    weight = np.multiply.outer(width, height).ravel() / (2.0 * np.pi * length)
    if isinstance(faces, Surface):
        covered = faces.covers(T, Z)
        T, Z, weight = T[covered], Z[covered], weight[covered]
    return T, Z, weight


def _points(low: float, high: float, cuts: np.ndarray, least: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights between ascending cuts, at least ``least``; of many cuts, between even ones."""
    touching = 1e-6 * (high - low)
    inner = cuts[(cuts > low + touching) & (cuts < high - touching)]
    edges = np.concatenate(([low], inner, [high])) if inner.size < least else np.linspace(low, high, least)
    node, weight = np.polynomial.legendre.leggauss(max(2, -(-least // (edges.size - 1))))
    size = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + size * (1.0 + node)).ravel(), (size * weight).ravel()


def film_pressure(
    theta: np.ndarray, zeta: np.ndarray, eccentricity: complex, slope: complex, decay: float
) -> np.ndarray:
    """Pressure of a film at angles [rad] and zeta; eccentricity and slope as x + i y over the clearance."""
    local = (eccentricity + slope * zeta) * np.exp(-1j * theta)
    return np.maximum(-local.imag, 0.0) / (1.0 + local.real) ** 3 * (1.0 - np.cosh(decay * zeta) / np.cosh(decay))


def _films(choice: tuple, tilted: bool, directions: np.ndarray) -> list[tuple[complex, complex, float]]:
    """Eccentricity, slope and decay of films."""
    eccentricities, shares, turns, decays = choice
    found = []
    for e in eccentricities:
        slopes = [0.0, *((1.0 - e) * s * np.exp(1j * u) for s in shares for u in turns)] if tilted else [0.0]
        found += [
            (e * np.exp(1j * phi), slope * np.exp(1j * phi), decay)
            for slope in slopes
            for decay in decays
            for phi in directions
        ]
    return found


def measuring_pressures(theta: np.ndarray, zeta: np.ndarray, tilted: bool) -> np.ndarray:
    """Pressures (k, ...) of the films that measure the error, at angles and zeta that broadcast."""
    return np.array([film_pressure(theta, zeta, *film) for film in _films(MEASURE, tilted, DIRECTIONS)])


def axial_orders(tilted: bool) -> list[int]:
    """Orders of the candidates along z."""
    return list(range(0, LARGEST_AXIAL + 1, 1 if tilted else 2))


def axial_pressures(zeta: np.ndarray, tilted: bool) -> np.ndarray:
    """Profiles (..., a) of the candidates along z."""
    units = np.eye(LARGEST_AXIAL + 1)[axial_orders(tilted)].T
    return np.moveaxis(legval(zeta, units), 0, -1) * (1.0 - zeta**2)[..., None]


def even_pressures(zeta: np.ndarray, tilted: bool) -> np.ndarray:
    """Uniform and, if tilted, linear pressure (..., 1 or 2)."""
    return np.stack([np.ones_like(zeta), zeta][: 1 + tilted], axis=-1)


def candidate_pressures(theta: np.ndarray, zeta: np.ndarray, tilted: bool) -> np.ndarray:
    """Candidates (p, c): the uniform and linear ones, then wave by wave cos and sin, each in all axial orders."""
    n = np.arange(LARGEST_WAVE + 1)
    waves = np.stack([np.cos(np.multiply.outer(theta, n)), np.sin(np.multiply.outer(theta, n))], axis=2)
    waves = waves.reshape(theta.size, -1)[:, np.arange(2 * n.size) != 1]
    products = waves[:, :, None] * axial_pressures(zeta, tilted)[:, None]
    return np.concatenate((even_pressures(zeta, tilted), products.reshape(theta.size, -1)), axis=1)


@lru_cache(maxsize=2)
def wave_parts(tilted: bool) -> np.ndarray:
    """Parts (waves, a, films) of the set's films in the candidates, cos + i sin, for pressures of unit mean square."""
    theta, (zeta, weight) = 2.0 * np.pi * np.arange(FIT[0]) / FIT[0], np.polynomial.legendre.leggauss(FIT[1])
    films = np.array([film_pressure(theta[:, None], zeta, *film) for film in _films(SET, tilted, np.zeros(1))])
    films /= np.sqrt(np.mean(films**2 @ weight, axis=1) / 2.0)[:, None, None]
    waves = np.fft.rfft(films, axis=1)[:, : LARGEST_WAVE + 1].conj() * (2.0 / FIT[0])
    waves[:, 0] *= 0.5
    root = np.sqrt(weight)
    fit = np.linalg.pinv(root[:, None] * axial_pressures(zeta, tilted)) * root
    return np.asarray(np.einsum("am,fnm->naf", fit, waves)) / np.sqrt(len(films))


def covariance_root(tilted: bool) -> np.ndarray:
    """S (c, s) of the set's films in all directions, in `candidate_pressures`.

    Films in all directions have wave by wave the covariance ``Re(p p^H)`` of cos with cos and of sin with sin, and
    ``Im(p p^H)`` of cos with sin, p being their parts.
    """
    blocks = []
    for n, part in enumerate(wave_parts(tilted)):
        both = np.block([[part.real, part.imag], [part.imag, -part.real]]) / np.sqrt(2.0)
        U, s, _ = np.linalg.svd(part.real if n == 0 else both, full_matrices=False)
        blocks.append(U * s)
    return block_diag(CERTAIN * np.eye(1 + tilted), *blocks)


def leading_modes(compliance: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Combinations (k, c) of unit strain energy, orthogonal in it, and their singular values, descending.

    Parameters
    ----------
    compliance : ndarray, shape (c, c)
        Q^T C Q of the candidates.
    root : ndarray, shape (c, s)
        S.
    """
    size = np.sqrt(np.diag(compliance))
    values, vectors = eigh(compliance / np.outer(size, size))
    # of more waves than the mesh has nodes for some depend on others
    keep = values > DEPENDENT * values[-1]
    vectors, values = vectors[:, keep] / size[:, None], np.sqrt(values[keep])
    U, sizes, _ = np.linalg.svd((vectors * size[:, None] ** 2 * values).T @ root, full_matrices=False)
    return (vectors / values @ U).T, sizes


def fewest_modes(
    shapes: np.ndarray, amounts: np.ndarray, exact: np.ndarray, scale: np.ndarray, sizes: np.ndarray, tolerance: float
) -> tuple[int, float]:
    """Smallest number of leading modes within the tolerance, and their error.

    Parameters
    ----------
    shapes, amounts : ndarray, shapes (p, k), (k, t)
        Displacement of the modes, and their coordinates under the measuring films.
    exact, scale : ndarray, shapes (p, t), (t,)
    sizes : ndarray, shape (k,)
        Singular values of the modes.

    Raises
    ------
    InputError
        If all modes miss the tolerance.
    """

    def error(count: int) -> float:
        return float((np.linalg.norm(shapes[:, :count] @ amounts[:count] - exact, axis=0) / scale).max())

    low, high = 0, sizes.size
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if error(middle) <= tolerance else (middle, high)
    if (least := error(high)) > tolerance:
        raise InputError(
            f"the modes' tolerance {tolerance:g} can't be met with {LARGEST_WAVE} waves around the bore and axial "
            f"order {LARGEST_AXIAL} (error {least:.2g}); raise it, or take an ANCFBush."
        )
    while high < sizes.size and sizes[high] > (1.0 - PAIR) * sizes[high - 1]:
        high += 1
    return high, error(high)


def film_modes(
    compliance: np.ndarray, weighted: np.ndarray, scale: np.ndarray, tilted: bool, tolerance: float
) -> tuple[np.ndarray, float]:
    """Combinations (k, c) of c candidates within the tolerance, of unit strain energy, and their error.

    Parameters
    ----------
    compliance : ndarray, shape (c, c + t)
        Work of the loads of candidates and measuring films on the displacements of the candidates.
    weighted : ndarray, shape (p, c + t)
        Displacements of both, as `FilmSurface.weighted`.
    scale : ndarray, shape (t,)
    """
    count = len(compliance)
    coefficients, sizes = leading_modes(compliance[:, :count], covariance_root(tilted))
    shapes, amounts = weighted[:, :count] @ coefficients.T, coefficients @ compliance[:, count:]
    chosen, error = fewest_modes(shapes, amounts, weighted[:, count:], scale, sizes, tolerance)
    return coefficients[:chosen], error


def orthogonal_on(shapes: np.ndarray) -> np.ndarray:
    """Turn (r, k) of modes (k, p) that makes them orthogonal, the largest first; those that vanish are dropped."""
    size, turn = eigh(shapes @ shapes.T)
    # waves that a coarse mesh can't show strain it and leave its bore where it is
    return np.asarray(turn[:, size > DEPENDENT * size[-1]][:, ::-1].T)
