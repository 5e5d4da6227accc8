"""Pressures of oil films on a bore, and the modes that they need.

A bore under the pressure p is displaced by ``C p``, with its compliance C. Modes ``C P`` of pressures P displace it by

    C P (P^T C P)^-1 P^T C p,

the best displacement of their span in the strain energy. P are the leading pressures of a large set of films, those
that leave the least strain energy of the set to the modes behind them: with P in candidates Q, ``Q^T C Q = R^T R`` and
the set's covariance ``Q S S^T Q^T``, the modes are the left singular vectors of R S (proper orthogonal decomposition).
The part of S with n waves around counts by ``(1 + n)^-WAVE_WEIGHT``: few waves that end steeply at the ends of the film
make the minimum film thickness, many waves hardly move the bore.

The films are those of bearings of finite length on the film's own length,

    p ~ (dh/dtheta)^2 / h^4 (1 - cosh(a zeta) / cosh(a)) where dh/dtheta < 0,

with zeta = 2 z / length and the scaled gap h of `Film`: eccentricities in all directions, slopes, waves and crowns, as
elastic bores make them, and profiles along z from the short bearing's parabola (small a) to the nearly even pressure of
a soft bush (large a). The square, and the fourth power to place the peak as the third does, let the pressure end
without a kink, as ruptured films do. The candidates are

    q = {1, cos(n theta), sin(n theta)} P_l(zeta) (1 - zeta^2),   n <= N, l <= L,

with Legendre's polynomials P_l, uniform and axially linear pressures, which pressurised ends need, and where it moves
the bore a uniform traction around it, as the film's shear is.

The number of modes is the smallest one whose error is within the tolerance. The error is that of the radial
displacement in the root mean square over the film's surface, between the mesh's nodes too, the largest one under films
that are not in the set. It counts over the displacement u, but a bush on a seat, a slender eye and a bent pin move by
far more than the film is thick, and over that every error would look small, while the film sees what the local
deformation lacks. The displacement v of a half space that moves alike beyond m waves around,

    v = min over m of |u|_m |p / n| / |p / n|_m   (|v| = |u| in a bush whose outer surface is held),

is what does not move as a whole, with |.|_m the root mean square of the waves beyond m, all of them for m = 0: the
compliance of a half space falls with 1 / n (K. L. Johnson, Contact Mechanics, Cambridge 1985, chapter 13), that of a
bent ring with 1 / n^4. The error counts over ``|v| max(|v| / |u|, LEAST_SHARE)``. The more of its displacement a bush
moves as a whole, the farther is the gap from that of round surfaces, and its pressure from those of the set: over v
alone, polymer bushes of thin walls on a narrow foot have the minimum film thickness within 4 % only.

Source of the idea: L. Sirovich, Quarterly of Applied Mathematics 45 (1987) 561; derived here for pressures on a bore.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legval
from scipy.linalg import block_diag, eigh
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.mesh import Surface, directed
from exudyn_ehd.status import InputError

# With every change of what follows, raise `exudyn_ehd.storage.FORMAT`.
LARGEST_WAVE, LARGEST_AXIAL = 32, 10
# Films of the set and those that measure the error: eccentricity ratios; slopes and waves of the gap (shares of the
# gap left at the loaded side); phases of both (rad, from the direction of the eccentricity); numbers of waves; crowns
# (such shares that the ends are wider by); decays towards the ends. A wider set takes more modes. The phases are those
# of the mirror image too, whose modes are as many. The error under rounder films is smaller: ratios of 0.5 and 0.75
# beside 0.9 tell the same.
SET = (0.3, 0.6, 0.85), (0.5,), (0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi), (2, 3), (-0.5, 1.0), (0.5, 4.0, 12.0, 40.0)
MEASURE = (0.9,), (0.5,), (0.8, 2.4, 0.8 + np.pi, 2.4 + np.pi), (3,), (-0.4, 0.6), (2.0, 20.0)
# Larger, it takes waves around later, and terms along the axis sooner. Of 0, 0.25, 0.5, 0.75 and 1 the films of nine
# bushes take 470, 435, 420, 395 and 395 modes together within 1 %, and 490, 470, 445, 445 and 455 within 0.5 %.
WAVE_WEIGHT = 0.75
# Directions of the eccentricity in the films that measure the error, rad: by the golden angle, so that none lies to
# the elements around as another does.
DIRECTIONS = 0.2 + np.pi * (3.0 - np.sqrt(5.0)) * np.arange(6)
# Waves m around beyond which displacements are compared with a half space's. Larger ones are beyond coarse meshes.
BEYOND = (2, 4, 6, 8, 10)
# Smallest share of a half space's displacement in the whole that makes the tolerance tighter. A smaller one takes more
# modes of bushes on a narrow foot.
LEAST_SHARE = 0.05
# Share of the energy below which a combination of pressures adds nothing but round-off.
DEPENDENT = 1e-11
# Weight of uniform and linear pressures over that of all films: their modes leave no more than its inverse of them.
CERTAIN = 1e3
# Share of the displacements from which others get modes: what is odd along the axis under films that are even, and what
# a uniform traction around the bore moves radially, over pressures of the same size. Where the latter is smaller, the
# film's shear, a hundredth of its pressure, moves the bore by 1e-4 of what the pressure does.
NOTICED = 0.01
# Vertices around and along of the fit of films by candidates.
FIT = 256, 64
# Least number of points around and along on the film's surface: beyond the orders of the pressures.
AROUND, ALONG = 144, 16


class FilmSurface:
    """Points on the faces of a bore under a film.

    Parameters
    ----------
    faces : Surface
    points : (p,) arrays
        Angle [rad], z [m] and weight, as `film_points` returns them.
    length : float
        Length of the film [m].
    frame : ndarray, shape (3, 3)
        Columns are the axes of the bore in the frame of the displacements.

    Attributes
    ----------
    theta, zeta, weight : ndarray, shape (p,)
    places : ndarray of int, shape (3 n,)
        Coordinates of the faces' nodes among those of the body.
    radial : csr_matrix, shape (p, 3 n)
        Radial displacements at the points from displacements at the nodes of the faces.
    twist : ndarray, shape (3 n, 1)
        Consistent nodal forces of a uniform traction around the bore, of one per area of the film's surface.
    """

    def __init__(
        self,
        faces: Surface,
        points: tuple[np.ndarray, np.ndarray, np.ndarray],
        length: float,
        frame: np.ndarray,
    ) -> None:
        self.places = (3 * faces.nodes[:, None] + np.arange(3)).ravel()
        self.theta, z, self.weight = points
        self.zeta = 2.0 * z / length
        cos, sin, values = np.cos(self.theta), np.sin(self.theta), faces.interpolation(self.theta, z)
        normal, tangent = np.moveaxis(np.array([[cos, sin, 0.0 * z], [-sin, cos, 0.0 * z]]), 1, 2) @ frame.T
        self.radial: csr_matrix = directed(values, normal)
        self.twist = np.asarray(directed(values, tangent).T @ self.weight[:, None])
        self._root = np.sqrt(self.weight)[:, None]

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
        waves = self._waves(1)[:, 1:]
        rigid = self._fields(waves, self.zeta[:, None] * waves)
        return np.asarray(weighted - rigid @ (rigid.T @ weighted))

    def _waves(self, most: int) -> np.ndarray:
        """1, cos and sin (p, 2 most + 1) of up to ``most`` waves around."""
        angles = np.multiply.outer(self.theta, np.arange(1, most + 1))
        return np.concatenate((np.ones((self.theta.size, 1)), np.cos(angles), np.sin(angles)), axis=1)

    def scale(self, weighted: np.ndarray, tilted: bool) -> np.ndarray:
        """Size (t,) over which an error of the displacements `weighted` (p, t) under the measuring films counts."""
        along, found = legval(self.zeta, np.eye(LARGEST_AXIAL + 1)).T, [np.linalg.norm(weighted, axis=0)]
        for most in BEYOND:
            waves = self._fields((self._waves(most)[:, :, None] * along[:, None]).reshape(self.theta.size, -1))
            found.append(np.linalg.norm(weighted - waves @ (waves.T @ weighted), axis=0))
        return scale_of(np.array(found), tilted)

    def odd_share(self, weighted: np.ndarray) -> float:
        """Largest share of `weighted` displacements that is linear in zeta, up to two waves around."""
        odd = self._fields(self.zeta[:, None] * self._waves(2))
        return float((np.linalg.norm(odd.T @ weighted, axis=0) / np.linalg.norm(weighted, axis=0)).max())


def film_points(faces: Surface, length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles [rad], z [m] and weights of sum one (p,) of points on the surface of a film, parted where faces meet."""
    cuts, half = faces.cuts, 0.5 * length
    around, width = _points(0.0, 2.0 * np.pi, cuts[0], AROUND)
    along, height = _points(-half, half, cuts[1], ALONG)
    T, Z = (x.ravel() for x in np.meshgrid(around, along, indexing="ij"))
    weight = np.multiply.outer(width, height).ravel() / (2.0 * np.pi * length)
    return T, Z, weight


def _points(low: float, high: float, cuts: np.ndarray, least: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights between ascending cuts, at least ``least``; of many cuts, between even ones."""
    touching = 1e-6 * (high - low)
    inner = cuts[(cuts > low + touching) & (cuts < high - touching)]
    edges = np.concatenate(([low], inner, [high])) if inner.size < least else np.linspace(low, high, least)
    node, weight = np.polynomial.legendre.leggauss(max(2, -(-least // (edges.size - 1))))
    size = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + size * (1.0 + node)).ravel(), (size * weight).ravel()


class SampleFilm(NamedTuple):
    """A film with the gap 1 + Re((e + b zeta) exp(-i theta) + a exp(-i n theta)) + k zeta^2, over the clearance."""

    eccentricity: complex
    slope: complex
    waves: int
    amplitude: complex
    crown: float
    decay: float

    def pressure(self, theta: np.ndarray, zeta: np.ndarray) -> np.ndarray:
        """Pressure at angles [rad] and zeta that broadcast."""
        local = (self.eccentricity + self.slope * zeta) * np.exp(-1j * theta)
        wave = self.amplitude * np.exp(-1j * self.waves * theta)
        gap = 1.0 + local.real + wave.real + self.crown * zeta**2
        rise = np.maximum(-local.imag - self.waves * wave.imag, 0.0) ** 2 / gap**4
        return np.asarray(rise * (1.0 - np.cosh(self.decay * zeta) / np.cosh(self.decay)))


def _films(choice: tuple, tilted: bool, directions: np.ndarray) -> list[SampleFilm]:
    """Return the films of a choice: undisturbed ones, tilted ones, and ones on a bore with waves or a crown."""
    eccentricities, shares, phases, waves, crowns, decays = choice
    found = []
    for e, decay, phi in itertools.product(eccentricities, decays, directions):
        turn, turned = np.exp(1j * phi), [(1.0 - e) * s * np.exp(1j * u) for s in shares for u in phases]
        found += [SampleFilm(e * turn, b * turn, 0, 0.0, 0.0, decay) for b in ([0.0, *turned] if tilted else [0.0])]
        # waves of the gap are 0.7 of its slope
        found += [SampleFilm(e * turn, 0.0, n, 0.7 * a * turn**n, 0.0, decay) for n in waves for a in turned]
        found += [SampleFilm(e * turn, 0.0, 0, 0.0, k * (1.0 - e), decay) for k in crowns]
    return found


def measuring_pressures(theta: np.ndarray, zeta: np.ndarray, tilted: bool) -> np.ndarray:
    """Pressures (k, ...) of the films that measure the error, at angles and zeta that broadcast."""
    return np.array([film.pressure(theta, zeta) for film in _films(MEASURE, tilted, DIRECTIONS)])


def scale_of(beyond: np.ndarray, tilted: bool) -> np.ndarray:
    """Scale (t,) of an error under the measuring films; ``beyond`` (b, t): |u| as a whole and beyond `BEYOND` waves."""
    local = (beyond * half_space(tilted)).min(axis=0)
    return np.asarray(local * np.maximum(local / beyond[0], LEAST_SHARE))


@lru_cache(maxsize=2)
def half_space(tilted: bool) -> np.ndarray:
    """Displacement of a half space over its part beyond no and `BEYOND` waves under the measuring films (b, t)."""
    theta, (zeta, weight) = 2.0 * np.pi * np.arange(FIT[0]) / FIT[0], np.polynomial.legendre.leggauss(FIT[1])
    waves = np.fft.rfft(measuring_pressures(theta[:, None], zeta, tilted), axis=1)
    n = np.arange(waves.shape[1])
    size = (np.abs(waves) ** 2 @ weight) * np.where(n == 0, 0.5, 1.0) / np.maximum(n, 1) ** 2
    whole = size.sum(axis=1)
    return np.sqrt(np.array([whole / size[:, n > most].sum(axis=1) for most in (-1, *BEYOND)]))


def axial_pressures(zeta: np.ndarray, tilted: bool) -> np.ndarray:
    """Profiles (..., a) of the candidates along z."""
    units = np.eye(LARGEST_AXIAL + 1)[:: 1 if tilted else 2].T
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
    """Weighted parts (waves, a, films) of the set's films in the candidates, cos + i sin.

    They are those of pressures of unit mean square times ``(1 + n)^-WAVE_WEIGHT``.
    """
    theta, (zeta, weight) = 2.0 * np.pi * np.arange(FIT[0]) / FIT[0], np.polynomial.legendre.leggauss(FIT[1])
    films = np.array([film.pressure(theta[:, None], zeta) for film in _films(SET, tilted, np.zeros(1))])
    films /= np.sqrt(np.mean(films**2 @ weight, axis=1) / 2.0)[:, None, None]
    waves = np.fft.rfft(films, axis=1)[:, : LARGEST_WAVE + 1].conj() * (2.0 / FIT[0])
    waves[:, 0] *= 0.5
    waves *= (1.0 + np.arange(LARGEST_WAVE + 1.0)[:, None]) ** -WAVE_WEIGHT
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
            f"tolerance (of a bush, a journal or add_bore_modes) must be at least {least:.2g} for this surface, got "
            f"{tolerance:g}: modes have up to {LARGEST_WAVE} waves around it and axial order {LARGEST_AXIAL}; raise it "
            "or take an ANCFBush."
        )
    # singular values within 0.1 % belong to a pair, cos and sin, that the number of modes must not part
    while high < sizes.size and sizes[high] > 0.999 * sizes[high - 1]:
        high += 1
    return high, error(high)


class FilmModes(NamedTuple):
    """Modes of a body under a film, of unit strain energy, and the t measuring films.

    Attributes
    ----------
    modes : ndarray, shape (size, k)
        Nodal displacements.
    error : float
    loads : ndarray, shape (size, t)
        Nodal forces of the measuring films.
    exact, scale : ndarray, shapes (p, t), (t,)
        Displacements under them as the film sees them, and the sizes over which errors count.
    """

    modes: np.ndarray
    error: float
    loads: np.ndarray
    exact: np.ndarray
    scale: np.ndarray


def film_modes(
    surface: FilmSurface,
    solve: Callable[[np.ndarray], np.ndarray],
    size: int,
    tilted: bool,
    tolerance: float,
    without_rigid: bool = False,
) -> FilmModes:
    """Fewest modes of a body within the tolerance; odd pressures take part if even ones displace the body oddly.

    Parameters
    ----------
    surface : FilmSurface
    solve : callable
        Displacements of the held body under nodal forces, both (size, k).
    size : int
        Number of the body's coordinates.
    tilted : bool
    tolerance : float
    without_rigid : bool
        The film does not see the rigid motion of the bore: it is the joint's.
    """
    pressures, count = surface.pressures(tilted)
    loads = np.zeros((size, 1 + pressures.shape[1]))
    loads[surface.places] = np.concatenate((surface.twist, surface.loads(pressures)), axis=1)
    solutions = solve(loads)
    seen = surface.weighted(solutions[surface.places])
    if without_rigid:
        seen = surface.without_rigid(seen)
    if not tilted and surface.odd_share(seen[:, 1 + count :]) > NOTICED:
        return film_modes(surface, solve, size, True, tolerance, without_rigid)
    moved, root = np.linalg.norm(seen, axis=0), covariance_root(tilted)
    if moved[0] > NOTICED * moved[1 : 1 + count].max():
        count, root = count + 1, block_diag(CERTAIN, root)
    else:
        solutions, loads, seen = solutions[:, 1:], loads[:, 1:], seen[:, 1:]
    candidates, exact = solutions[:, :count], seen[:, count:]
    scale, work = surface.scale(exact, tilted), candidates.T @ loads
    coefficients, sizes = leading_modes(work[:, :count], root)
    shapes, amounts = seen[:, :count] @ coefficients.T, coefficients @ work[:, count:]
    chosen, error = fewest_modes(shapes, amounts, exact, scale, sizes, tolerance)
    return FilmModes(candidates @ coefficients[:chosen].T, error, loads[:, count:], exact, scale)


def orthogonal_on(shapes: np.ndarray) -> np.ndarray:
    """Turn (r, k) of modes (k, p) that makes them orthogonal, the largest first; those that vanish are dropped."""
    size, turn = eigh(shapes @ shapes.T)
    # waves that a coarse mesh can't show strain it and leave its bore where it is
    return np.asarray(turn[:, size > DEPENDENT * size[-1]][:, ::-1].T)
