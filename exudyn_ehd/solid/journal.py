"""`ElasticJournal`, and its reduction to what its surface does under an oil film.

The modes are the displacements under the leading pressures of films, `exudyn_ehd.solid.pressure_modes`, wave by wave,
so that a mode is a profile along z times cos(n theta) or sin(n theta). Its displacement is counted inwards, as it opens
the gap: with it S q of a journal adds to that of a bore, and its loads are S^T (p A) alike.

The user describes an elastic journal by its cylinder, its material and the bands where its body holds it. The body of
the joint's journal moves as a rigid body; the journal's motion relative to it is the deflection. With `HeldBands` and
`HeldEnds` the body holds the pin (a piston with its bosses, a crank with its webs), and the pin's bending against it is
deflection. With ``held=None`` the journal is the body itself, and nothing holds it. Its rigid motion under the film's
force is then the body's. Its deflection is the rest, in the frame of its mean motion,

    K u = f - M R (R^T M R)^-1 R^T f,   R^T M u = 0,

with its rigid motions R and its mass M, spread as its material is (inertia relief). No motion is counted twice: modes
under ``held=None`` have neither momentum nor moment of momentum.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, partial
from math import ceil, log, log1p
from typing import ClassVar

import numpy as np
from scipy.linalg import block_diag

from exudyn_ehd.solid import pressure_modes as films
from exudyn_ehd.solid.bush import ModalBush, require_tolerance
from exudyn_ehd.solid.harmonics import Cylinder, interpolation
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from exudyn_ehd.status import NOT_NEGATIVE, Checked, InputError, require_bool, require_vector
from exudyn_ehd.storage import cached_arrays


@dataclass(frozen=True, kw_only=True)
class HeldEnds:
    """``held`` of an `ElasticJournal`: its body holds both end faces, as the webs of a crank hold its pin.

    Examples
    --------
    >>> held = ehd.HeldEnds()
    """


@dataclass(frozen=True, kw_only=True)
class HeldBands:
    """``held`` of an `ElasticJournal`: its body holds bands of the cylinder, as a piston's bosses hold its pin.

    In the bands the surface does not move against the body in any direction: bosses as stiff as the body, without play.
    One band on one side of the film makes an overhung pin.

    Parameters
    ----------
    bands : tuple of (float, float)
        z where each band begins and ends, joint frame [m]; outside the film's length.

    Examples
    --------
    >>> bosses = ehd.HeldBands(bands=((-0.03, -0.015), (0.015, 0.03)))
    >>> len(bosses.bands)
    2
    """

    bands: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not isinstance(self.bands, Iterable) or not tuple(self.bands):
            raise InputError(
                f"HeldBands.bands must be pairs of places, ((z0, z1), ...) in m, got {self.bands!r}; held=None is for "
                "a journal that nothing holds."
            )
        bands = tuple(_place("HeldBands.bands", band) for band in self.bands)
        object.__setattr__(self, "bands", bands)


@dataclass(frozen=True, kw_only=True)
class ElasticJournal(Checked):
    """A linear elastic solid or hollow pin as a bearing's journal, reduced to modes of its surface.

    It is a cylinder that follows the film without inertia: only film and contact deform it. Its mass is its body's;
    weight, centrifugal forces and loads elsewhere on the body do not bend it. Being round it responds alike at every
    angle, so its modes stay in the joint's frame at any spin. The film takes the radial deflection only, measured
    across the bore's axis: the tilt (some 1e-3) changes it by that share, and sliding along the axis is omitted. For a
    journal that is not round or whose body deforms as a whole: `FEJournal`.

    Parameters
    ----------
    material : SaintVenantKirchhoff
        Its density is not used.
    span : (float, float)
        z of its end faces in the joint frame, from the bearing's mid-plane [m], lower one first; the film lies between
        them.
    held : HeldEnds, HeldBands or None
        Where the body of the joint's journal holds the pin. None: the pin is that body, nothing holds it, and its mean
        motion is the body's.
    inner_radius : float, default 0.0
        Inner radius of a hollow pin [m]; 0: solid. The outer one is the bearing's ``journal_radius``.
    tolerance : float, default 0.05
        Largest relative error of the surface's deflection under sampled films, as in `ModalBush`, 2e-3 to 0.2: smaller
        takes more modes. For a pin that bends by more than it flattens, relative to its local deformation.
    tilted : bool, default True
        False omits the modes that are odd in z, for journals that stay parallel to the bore; only for pins that are
        symmetric about the mid-plane.

    Examples
    --------
    After the example of `SaintVenantKirchhoff`:

    >>> bosses = ehd.HeldBands(bands=((-0.03, -0.015), (0.015, 0.03)))
    >>> pin = ehd.ElasticJournal(material=steel, span=(-0.03, 0.03), held=bosses, inner_radius=5e-3)
    >>> oil = ehd.Lubricant(viscosity=9e-3)
    >>> b = ehd.JournalBearing(journal_radius=0.01, length=0.02, radial_clearance=1e-5, lubricant=oil, journal=pin)
    >>> film = ehd.steady(b, speed=100.0, eccentricity_ratio=0.9)
    >>> round(1e6 * film.minimum_gap, 1)  # um; 1.0 between rigid surfaces
    1.5
    """

    material: SaintVenantKirchhoff
    span: tuple[float, float]
    held: HeldEnds | HeldBands | None
    inner_radius: float = 0.0
    tolerance: float = 0.05
    tilted: bool = True

    checks: ClassVar = {
        "inner_radius": partial(NOT_NEGATIVE, hint="0 is a solid pin."),
        "tolerance": require_tolerance,
        "tilted": require_bool,
        "material": (SaintVenantKirchhoff,),
        "held": (HeldEnds, HeldBands, type(None)),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "span", _place("ElasticJournal.span", self.span))

    @property
    def bands(self) -> tuple[tuple[float, float], ...]:
        """Bands in which its cylinder is held, [m]."""
        return self.held.bands if isinstance(self.held, HeldBands) else ()

    def require_fit(self, radius: float, length: float, bush: object) -> None:
        """Raise `InputError` for a pin of ``radius`` that does not fit a film of ``length`` about z = 0 or ``bush``."""
        half, (low, high) = 0.5 * length * (1.0 - 1e-9), self.span
        if bush is not None and not isinstance(bush, ModalBush):
            raise InputError(
                "JournalBearing.journal=ElasticJournal(...) goes with a rigid bore or a ModalBush(...), got "
                f"bush={type(bush).__name__}(...): its modes follow those of such a bush and have no mass; take one, "
                "or leave one out."
            )
        if not self.inner_radius <= 0.95 * radius:
            raise InputError(
                f"ElasticJournal.inner_radius must be at most 0.95 of the journal radius {radius:g} m, got "
                f"{self.inner_radius:g} m; thinner tubes are shells, which take other elements."
            )
        if low > -half or high < half:
            raise InputError(
                f"ElasticJournal.span must reach beyond the film, {length:g} m about its mid-plane, got {self.span} m."
            )
        for begin, end in self.bands:
            if not (low * (1.0 + 1e-9) <= begin and end <= high * (1.0 + 1e-9) and (end <= -half or begin >= half)):
                raise InputError(
                    f"HeldBands.bands must lie on the pin, {self.span} m, beside the film of {length:g} m about z = 0, "
                    f"got {(begin, end)} m."
                )
        mirrored = sorted((-end, -begin) for begin, end in (self.span, *self.bands))
        if not self.tilted and mirrored != sorted((self.span, *self.bands)):
            raise InputError(
                "ElasticJournal.tilted must be True for a pin that is not symmetric about the film's mid-plane: it "
                "bends askew."
            )


def _place(where: str, value: tuple[float, float]) -> tuple[float, float]:
    low, high = require_vector(where, value, 2, "m").tolist()
    if not low < high:
        raise InputError(f"{where} must be two places in m, the lower one first, got {value!r}.")
    return low, high


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
        """Return the opening of the gap by unit coordinates on the grid theta x z, (len(theta), len(z), k)."""
        return self.around(theta)[:, None] * self.along(z)


def journal_modes(journal: ElasticJournal, radius: float, length: float) -> JournalModes:
    """The modes of a journal of ``radius`` under a film of ``length``, from the disk, or computed and stored there.

    Raises
    ------
    InputError
        If the tolerance takes more waves than the search allows.
    """
    described = (journal.material.lame, journal.span, journal.held, journal.inner_radius)
    choice = journal.tolerance, journal.tilted, radius, length
    data = cached_arrays("journal_modes", (*described, *choice), lambda: _Reduction(journal, radius, length).modes())
    error = float(data.pop("error"))
    return JournalModes(edges=film_edges(length, data["profiles"].shape[1] // 2), error=error, **data)


class _Reduction:
    """Displacements of the surface under the candidates and the samples, wave by wave."""

    def __init__(self, journal: ElasticJournal, radius: float, length: float) -> None:
        self.journal, self.half = journal, 0.5 * length
        # elements through the wall and under the film, and waves around: the compliance of a solid pin is off by 2e-4
        # at 8 waves around and 5e-3 at 24, on the second mesh by 6e-3 at 8
        radial, axial, self.waves = (8, 16, films.LARGEST_WAVE) if journal.tolerance < 0.1 else (5, 8, 20)
        self.edges = film_edges(length, axial)
        places = _beyond(self.edges, journal)
        self.body = Cylinder(wall_edges(journal.inner_radius, radius, radial), places, journal.material.lame)
        first = 2 * int(np.argmin(np.abs(places + self.half)))
        self.film = slice(first, first + 2 * axial + 1)
        self.surface = 3 * self.body.surface[self.film]
        self.zeta = self.body.places / self.half
        # of the film alone
        self.loaded = np.abs(self.zeta) < 1.0

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
        tilted, measuring = self.journal.tilted, self._measuring()
        t, waves = measuring.shape[1] // 2, films.wave_parts(tilted)
        combinations, profiles, shapes, amounts, exact, sizes, owners = [], [], [], [], [], [], []
        for n, (part, films_of_wave) in enumerate(zip(waves[: self.waves + 1], measuring, strict=True)):
            candidates = self._candidates(n)
            c, load = len(candidates), self.body.load(n, np.concatenate((candidates, films_of_wave)))
            # pressed inwards, the journal is displaced by as much the other way
            answer = self.body.solve(n, load, self.held)
            root = np.concatenate((part.real, part.imag), axis=1) / np.sqrt(2.0)
            if n == 0:
                root = block_diag(films.CERTAIN * np.eye(1 + tilted), part.real)
            coefficients, size = films.leading_modes(answer[:, :c].T @ load[:, :c], root)
            profile, work = answer[self.surface], coefficients @ (answer[:, :c].T @ load[:, c:])
            combinations.append(coefficients)
            profiles.append(profile[:, :c])
            # in the mean square around
            weighted = self._root[:, None] * profile * (np.sqrt(0.5) if n else 1.0)
            for phase in range(2 if n else 1):
                shapes.append(weighted[:, :c] @ coefficients.T)
                amounts.append(work[:, phase * t : (phase + 1) * t])
                exact.append(weighted[:, c + phase * t : c + (phase + 1) * t])
                sizes.append(size)
                owners += [(n, phase, row) for row in range(size.size)]
        order = np.argsort(-np.concatenate(sizes), kind="stable")
        # one block for no wave, two for every other
        beyond = [np.linalg.norm(np.concatenate(exact[2 * most + 1 :]), axis=0) for most in films.BEYOND]
        whole = np.concatenate(exact)
        chosen, error = films.fewest_modes(
            block_diag(*shapes)[:, order],
            np.concatenate(amounts)[order],
            whole,
            films.scale_of(np.array([np.linalg.norm(whole, axis=0), *beyond]), tilted),
            np.concatenate(sizes)[order],
            self.journal.tolerance,
        )
        taken = [owners[row] for row in order[:chosen]]
        rows = [[row for wave, phase, row in taken if (wave, phase) == (n, 0)] for n in range(self.waves + 1)]
        parts = [c[own] @ p.T for c, p, own in zip(combinations, profiles, rows, strict=True)]
        return self._arrays(parts) | {"error": np.array(error)}

    def _arrays(self, parts: list[np.ndarray]) -> dict[str, np.ndarray]:
        """Arrays of `JournalModes` of the profiles (modes, nodes) of every number of waves, of unit strain energy."""
        found: list[tuple[np.ndarray, ...]] = []
        for n, part in enumerate(parts):
            if not len(part):
                continue
            moved = films.orthogonal_on(part * self._root) @ part
            peak = moved[np.arange(len(moved)), np.argmax(np.abs(moved), axis=1)]
            for phase in (0.0, 0.5 * np.pi)[: 2 if n else 1]:
                same = np.ones_like(peak)
                found.append((n * same, phase * same, moved / peak[:, None], 1.0 / peak**2))
        names = "waves", "phases", "profiles", "stiffness"
        return dict(zip(names, map(np.concatenate, zip(*found, strict=True)), strict=True))

    @cached_property
    def _root(self) -> np.ndarray:
        """Root of the nodes' shares of the film's length."""
        weights, third = np.zeros(2 * self.edges.size - 1), np.diff(self.edges) / (6.0 * self.half)
        weights[1::2] = 4.0 * third
        weights[:-1:2] += third
        weights[2::2] += third
        return np.sqrt(0.5 * weights)

    def _candidates(self, n: int) -> np.ndarray:
        """Pressures (c, elements, 3) of the candidates with n waves."""
        kinds = [films.axial_pressures] if n else [films.even_pressures, films.axial_pressures]
        found = np.concatenate([kind(self.zeta, self.journal.tilted) for kind in kinds], axis=-1)
        return np.moveaxis(found, -1, 0) * self.loaded

    def _measuring(self) -> np.ndarray:
        """Parts (waves, 2 t, elements, 3) of the t measuring films with cos(n theta) and sin(n theta)."""
        # angles at which sampled films are taken apart into waves
        angles = films.FIT[0]
        theta, zeta = 2.0 * np.pi * np.arange(angles) / angles, np.where(self.loaded, self.zeta, 0.0)
        pressures = films.measuring_pressures(theta, zeta[..., None], self.journal.tilted)
        parts = np.fft.rfft(pressures)[..., : self.waves + 1] * (2.0 / angles) * self.loaded[..., None]
        parts[..., 0] *= 0.5
        return np.moveaxis(np.concatenate((parts.real, -parts.imag)), -1, 0)


def film_edges(length: float, count: int) -> np.ndarray:
    """Edges (count + 1,) of the elements along z under a film, shorter towards its ends, as the films' waves are."""
    return 0.5 * length * np.sin(np.linspace(-0.5, 0.5, count + 1) * np.pi)


def wall_edges(inner: float, outer: float, count: int) -> np.ndarray:
    """Edges (count + 1,) of the elements through a wall, each by a quarter larger than the next one outwards."""
    growth = np.concatenate(([0.0], np.cumsum(1.25 ** np.arange(count)[::-1])))
    return inner + (outer - inner) * growth / growth[-1]


def _beyond(film: np.ndarray, journal: ElasticJournal) -> np.ndarray:
    """Edges of the elements along z: those under the film, and beside it ones that grow away from every change."""
    growth = 1.8
    bounds = sorted({*journal.span, *(place for band in journal.bands for place in band), film[0], film[-1]})
    edges, least = [film], film[1] - film[0]
    for low, high in itertools.pairwise(bounds):
        if high - low > 1e-9 * film[-1] and not (low >= film[0] and high <= film[-1]):
            half = 0.5 * (high - low)
            count = max(1, ceil(log1p(half / least * (growth - 1.0)) / log(growth)))
            part = np.cumsum(growth ** np.arange(count))
            part *= half / part[-1]
            edges += [low + part, high - part[:-1], np.array([low, high])]
    # neighbours share their ends up to rounding
    whole = np.sort(np.concatenate(edges))
    return whole[np.concatenate(([True], np.diff(whole) > 0.1 * least))]
