"""An elastic journal reduced to what its surface does under an oil film.

The modes are the displacements under the pressures of `exudyn_ehd.solid.modes.static`,

    p = {1, cos(n theta), sin(n theta)} P_l(zeta) (1 - zeta^2),   n <= N, l <= L,   zeta = 2 z / length,

and under uniform and axially linear pressure; N and L are the smallest ones with which sampled films displace the
surface within the tolerance. Wave by wave, so that a mode is a profile along z times cos(n theta) or sin(n theta). Its
displacement is counted inwards, as it opens the gap: with it S q of a journal adds to that of a bore, and its loads are
S^T (p A) alike.

Where the pin bends, its surface moves by far more than the film is thick, and over that every error would look small:
an error counts over no more than 2.2 times the part of the displacement beyond two waves around, as in
`exudyn_ehd.solid.fe_bore`.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property
from math import ceil, log, log1p

import numpy as np
from numpy.polynomial.legendre import legval

from exudyn_ehd.solid.fe_bore import HELD_SHAPE
from exudyn_ehd.solid.journal.description import ElasticJournal, HeldEnds
from exudyn_ehd.solid.journal.harmonics import Cylinder, interpolation
from exudyn_ehd.solid.modes import static
from exudyn_ehd.storage import cached_arrays

# Of the algorithm, as `exudyn_ehd.solid.modes.static.FORMAT`.
FORMAT = 2
# Elements through the wall and under the film, and waves around of the search; from this tolerance on the second set
# does. Compliance of a solid pin off by 2e-4 at 8 waves around and 5e-3 at 24, by 6e-3 at 8 of the second set.
FINE, COARSE, COARSE_FROM = (8, 16, static.LARGEST_WAVE), (5, 8, 12), 0.05
# Growth of the elements inwards and away from the film.
GROWTH_INWARDS, GROWTH_OUTWARDS = 1.25, 1.8
# Angles at which sampled films are taken apart into waves.
ANGLES = 256


@dataclass(frozen=True, kw_only=True, eq=False)
class JournalModes:
    """Modes of a journal's surface under the film.

    Parameters
    ----------
    edges : ndarray, shape (m + 1,)
        Places along z between which the profiles are parabolas [m].
    waves, phases : ndarray, shape (k,)
        A mode is its profile times cos(wave theta - phase).
    profiles : ndarray, shape (k, 2 m + 1)
        Displacement towards the axis at edges and middles; the largest is 1, so that a coordinate is in m.
    stiffness : ndarray, shape (k,)
        Modal stiffness [N/m]; the modes are orthogonal in energy.
    error : float
        Error under the sampled films, as in `ElasticJournal`.
    """

    edges: np.ndarray
    waves: np.ndarray
    phases: np.ndarray
    profiles: np.ndarray
    stiffness: np.ndarray
    error: float

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.stiffness.size

    def around(self, theta: np.ndarray) -> np.ndarray:
        """Waves (p, k) at angles (p,)."""
        return np.cos(np.multiply.outer(theta, self.waves) - self.phases)

    def along(self, z: np.ndarray) -> np.ndarray:
        """Profiles (p, k) at places (p,)."""
        return interpolation(self.edges, z) @ self.profiles.T

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """What unit coordinates open the gap by on the grid theta x z, (len(theta), len(z), k)."""
        return self.around(theta)[:, None] * self.along(z)


def journal_modes(journal: ElasticJournal, radius: float, length: float) -> JournalModes:
    """The modes of a journal of ``radius`` under a film of ``length``, from the disk, or computed and stored there.

    Raises
    ------
    InputError
        If the tolerance takes more waves than the search allows.
    """
    described = (FORMAT, journal.material.lame, journal.span, repr(journal.held), journal.inner_radius)
    choice = (
        journal.tolerance,
        journal.tilted,
        radius,
        length,
        FINE,
        COARSE,
        COARSE_FROM,
        GROWTH_INWARDS,
        GROWTH_OUTWARDS,
    )
    search = (ANGLES, static.LARGEST_AXIAL, static.DEPENDENT, static.AXIAL_FROM, HELD_SHAPE)
    samples = (static.SAMPLE_ECCENTRICITIES, static.SAMPLE_DIRECTIONS, static.SAMPLE_TILTS, static.SAMPLE_DECAY)
    shapes = {"waves": ("k",), "phases": ("k",), "profiles": ("k", "m"), "stiffness": ("k",), "error": ()}
    data = cached_arrays(
        "journal_modes",
        repr((*described, *choice, *search, *samples)).encode(),
        shapes,
        lambda: _Reduction(journal, radius, length).modes(),
    )
    error = float(data.pop("error"))
    return JournalModes(edges=film_edges(length, data["profiles"].shape[1] // 2), error=error, **data)


class _Reduction:
    """Displacements of the surface under the candidates and the samples, wave by wave."""

    def __init__(self, journal: ElasticJournal, radius: float, length: float) -> None:
        self.journal, self.half = journal, 0.5 * length
        radial, axial, self.waves = FINE if journal.tolerance < COARSE_FROM else COARSE
        self.edges = film_edges(length, axial)
        places = _beyond(self.edges, journal)
        growth = np.concatenate(([0.0], np.cumsum(GROWTH_INWARDS ** np.arange(radial)[::-1])))
        r = journal.inner_radius + (radius - journal.inner_radius) * growth / growth[-1]
        self.body = Cylinder(r, places, journal.material.lame)
        first = 2 * int(np.argmin(np.abs(places + self.half)))
        self.film = slice(first, first + 2 * axial + 1)
        self.surface = 3 * self.body.surface[self.film]
        self.zeta = self.body.places / self.half
        # of the film alone
        self.loaded = np.abs(self.zeta) < 1.0
        self.axial = list(range(0, static.LARGEST_AXIAL + 1, 1 if journal.tilted else 2))
        # axial orders of the candidates without a wave: uniform and linear pressures come first
        self._of_rings = [0, 1, *self.axial] if journal.tilted else [0, *self.axial]

    @cached_property
    def held(self) -> np.ndarray | None:
        """Nodes that are held; None: none."""
        if self.journal.held is None:
            return None
        r, z = (x.ravel() for x in np.meshgrid(self.body.nodes_r, self.body.nodes_z, indexing="ij"))
        near = 1e-9 * self.half
        if isinstance(self.journal.held, HeldEnds):
            return np.asarray((z < z.min() + near) | (z > z.max() - near))
        inside = [(z > low - near) & (z < high + near) for low, high in self.journal.bands]
        return np.asarray(np.any(inside, axis=0) & (r == r.max()))

    def modes(self) -> dict[str, np.ndarray]:
        """Arrays of `JournalModes`."""
        candidates = [self._candidates(n) for n in range(self.waves + 1)]
        samples = self._samples()
        loads = [self._loads(n, c, s) for n, (c, s) in enumerate(zip(candidates, samples, strict=True))]
        answers = [self.body.solve(n, load, self.held) for n, load in enumerate(loads)]
        compliance = [u.T @ f for u, f in zip(answers, loads, strict=True)]
        profiles = [u[self.surface].T for u in answers]
        chosen, error = self._choose(compliance, profiles)
        found: list[tuple[np.ndarray, ...]] = []
        for n, (axial, wave) in enumerate(zip(chosen, compliance, strict=True)):
            if not axial.size:
                continue
            coefficients = static.orthogonal_modes(wave[np.ix_(axial, axial)], profiles[n][axial] * self._root)
            shapes = coefficients @ profiles[n][axial]
            peak = shapes[np.arange(len(shapes)), np.argmax(np.abs(shapes), axis=1)]
            for phase in (0.0, 0.5 * np.pi)[: 2 if n else 1]:
                same = np.ones_like(peak)
                found.append((n * same, phase * same, shapes / peak[:, None], 1.0 / peak**2))
        names = "waves", "phases", "profiles", "stiffness"
        return dict(zip(names, map(np.concatenate, zip(*found, strict=True)), strict=True)) | {"error": np.array(error)}

    @cached_property
    def _root(self) -> np.ndarray:
        """Root of the nodes' shares of the film's length."""
        weights, third = np.zeros(2 * self.edges.size - 1), np.diff(self.edges) / (6.0 * self.half)
        weights[1::2] = 4.0 * third
        weights[:-1:2] += third
        weights[2::2] += third
        return np.sqrt(0.5 * weights)

    def _candidates(self, n: int) -> np.ndarray:
        """Pressures (c, elements, 3) of the modes with n waves; those of n = 0 begin with uniform and linear ones."""
        found = [legval(self.zeta, np.eye(static.LARGEST_AXIAL + 1)[k]) * (1.0 - self.zeta**2) for k in self.axial]
        if n == 0:
            found = [np.ones_like(self.zeta), *([self.zeta] if self.journal.tilted else []), *found]
        return np.array(found) * self.loaded

    def _samples(self) -> list[np.ndarray]:
        """Parts (2 s, elements, 3) of the s sampled films with cos(n theta) and sin(n theta), for every n."""
        theta, zeta = 2.0 * np.pi * np.arange(ANGLES) / ANGLES, np.where(self.loaded, self.zeta, 0.0)
        films = [film(theta, zeta[..., None]) for film in static.sample_pressures(self.journal.tilted)]
        parts = np.fft.rfft(np.array(films)) * (2.0 / ANGLES) * self.loaded[..., None]
        parts[..., 0] *= 0.5
        return [np.concatenate((parts[..., n].real, -parts[..., n].imag)) for n in range(self.waves + 1)]

    def _loads(self, n: int, candidates: np.ndarray, samples: np.ndarray) -> np.ndarray:
        """Loads (size, c + 2 s); the journal is pressed inwards, and displaced by as much the other way by these."""
        return self.body.load(n, np.concatenate((candidates, samples)))

    def _choose(self, compliance: list[np.ndarray], profiles: list[np.ndarray]) -> tuple[list[np.ndarray], float]:
        """Candidates of every n, by `exudyn_ehd.solid.modes.static.enough_modes`, and their error."""
        s = len(static.sample_pressures(self.journal.tilted))
        owners = [(n, phase, i) for n, c in enumerate(compliance) for phase in range(2 if n else 1) for i in _own(c, s)]
        orders = np.array([(n, (self.axial if n else self._of_rings)[i]) for n, _, i in owners])
        count, waves = len(owners), len(profiles)
        radial = np.zeros((count + s, waves, 2, self._root.size))
        whole = np.zeros((count + s,) * 2)
        for row, (n, phase, i) in enumerate(owners):
            # in the mean square around
            root = self._root * (np.sqrt(0.5) if n else 1.0)
            own = _own(compliance[n], s)
            mine = slice(len(own) + phase * s, len(own) + (phase + 1) * s)
            radial[row, n, phase] = profiles[n][i] * root
            radial[count:, n, phase] = profiles[n][mine] * root
            whole[row, count:] = compliance[n][i, mine]
            whole[row, row - i : row - i + len(own)] = compliance[n][i, : len(own)]
        films, local = radial[count:].reshape(s, -1), radial[count:, 3:].reshape(s, -1)
        scale = np.minimum(np.linalg.norm(films, axis=1), HELD_SHAPE * np.linalg.norm(local, axis=1))
        choice = self.journal.tolerance, self.journal.tilted, scale
        chosen, error = static.enough_modes(whole, radial.reshape(count + s, -1), orders, *choice)
        taken = [owners[row] for row in chosen]
        return [np.array([i for m, p, i in taken if (m, p) == (n, 0)], dtype=int) for n in range(waves)], error


def _own(compliance: np.ndarray, samples: int) -> range:
    """Numbers of the candidates, which two parts of each sample follow."""
    return range(len(compliance) - 2 * samples)


def film_edges(length: float, count: int) -> np.ndarray:
    """Edges (count + 1,) of the elements along z under a film, shorter towards its ends, as the films' waves are."""
    return 0.5 * length * np.sin(np.linspace(-0.5, 0.5, count + 1) * np.pi)


def _beyond(film: np.ndarray, journal: ElasticJournal) -> np.ndarray:
    """Edges of the elements along z: those under the film, and beside it ones that grow away from every change."""
    bounds = sorted({*journal.span, *(place for band in journal.bands for place in band), film[0], film[-1]})
    edges, least = [film], film[1] - film[0]
    for low, high in itertools.pairwise(bounds):
        if high - low > 1e-9 * film[-1] and not (low >= film[0] and high <= film[-1]):
            half = 0.5 * (high - low)
            count = max(1, ceil(log1p(half / least * (GROWTH_OUTWARDS - 1.0)) / log(GROWTH_OUTWARDS)))
            part = np.cumsum(GROWTH_OUTWARDS ** np.arange(count))
            part *= half / part[-1]
            edges += [low + part, high - part[:-1], np.array([low, high])]
    # neighbours share their ends up to rounding
    whole = np.sort(np.concatenate(edges))
    return whole[np.concatenate(([True], np.diff(whole) > 0.1 * least))]
