"""Profiles: depths of surfaces that are not circular cylinders, as additions to the gap.

A profile is a depth d(theta, z) in m that adds to the gap of the circular cylinders: ``h = c - e . n + d``; d > 0 opens
the gap, theta counts from x about z, z from the bearing's mid-plane. Profiles are fixed in the housing: an out-of-round
bore, or a bore or journal whose radius varies along z. (An out-of-round journal carries its shape around with it and is
not described here.) Several profiles add up. The pressure on their slopes acts on the bore; where a crown is on the
journal instead, film, radial force and moments are the same and the axial force differs by the pressure on that slope,
a share depth / length of the load.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar

import numpy as np
import scipy

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.status import (
    POSITIVE,
    ROUNDING,
    Checked,
    InputError,
    PlausibilityWarning,
    require_integer,
    require_number,
    require_plausible,
    warn_user,
)

# Places between two vertices, as shares of their distance, at which a profile is compared with the straight line
# between the vertices, and the difference, as a share of the clearance, above which there is a warning.
BETWEEN, MISSED = (0.21, 0.47, 0.83), 0.02


@dataclass(frozen=True, kw_only=True)
class OutOfRound(Checked):
    """Bore with lobes: ``d = amplitude cos(order (theta - phase))``.

    Parameters
    ----------
    order : int
        Lobes around the circumference, at least 2 (1 is an eccentricity); 2: oval, 3: three-lobe.
    amplitude : float
        Half of the difference between the largest and the smallest radius, m.
    phase : float, default 0.0
        Angle at which the radius is largest, from the joint's x about its z axis, rad.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, profile=ehd.OutOfRound(order=2, amplitude=3e-6))
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(1e6 * film.minimum_gap, 2)  # um
    8.0
    """

    order: int
    amplitude: float
    phase: float = 0.0

    checks: ClassVar = {
        "order": partial(require_integer, at_least=2, hint="order 1 is a shift of the whole bore."),
        "amplitude": require_number,
        "phase": require_number,
    }

    def depth(self, theta: np.ndarray, z: np.ndarray, length: float) -> np.ndarray:
        """Addition to the gap (n, m) in m at the angles theta (n,) and the positions z (m,).

        ``length`` is the bearing's.
        """
        return np.outer(self.amplitude * np.cos(self.order * (theta - self.phase)), np.ones(z.size))


@dataclass(frozen=True, kw_only=True)
class Crown(Checked):
    """Crowned (barrelled) journal or bore: ``d = drop |2 z / L|^exponent``.

    When: journals that tilt, whose edges the crown relieves; shapes deeper than a tenth of the minimum film thickness.

    Parameters
    ----------
    drop : float
        Additional gap at both ends of the bearing, m; negative: waisted.
    exponent : float, default 2.0
        At least 1; 2 is a parabola, with a larger exponent more of the length remains nearly cylindrical.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> crowned = ehd.JournalBearing(**b, profile=ehd.Crown(drop=2e-6))
    >>> round(1e6 * ehd.steady(crowned, speed=314.0, eccentricity_ratio=0.8, tilt=(0, 1e-4)).minimum_gap, 2)  # um
    5.0
    """

    drop: float
    exponent: float = 2.0

    checks: ClassVar = {"drop": require_number, "exponent": partial(require_number, at_least=1.0)}

    def depth(self, theta: np.ndarray, z: np.ndarray, length: float) -> np.ndarray:
        """Addition to the gap; see `OutOfRound.depth`."""
        return np.outer(np.ones(theta.size), self.drop * np.abs(2.0 * z / length) ** self.exponent)


@dataclass(frozen=True, kw_only=True)
class EdgeRelief(Checked):
    """Relieved ends: a parabola over the last part of the length, ``d = drop (1 - (L/2 - |z|) / relief_length)^2``.

    When: as `Crown`.

    Parameters
    ----------
    drop : float
        Additional gap at both ends of the bearing, m.
    relief_length : float
        Axial length of the relief at each end, m.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> relieved = ehd.JournalBearing(**b, profile=ehd.EdgeRelief(drop=5e-6, relief_length=0.004))
    >>> relieved.profile.drop  # m
    5e-06
    """

    drop: float
    relief_length: float

    checks: ClassVar = {"drop": require_number, "relief_length": POSITIVE}

    def depth(self, theta: np.ndarray, z: np.ndarray, length: float) -> np.ndarray:
        """Addition to the gap; see `OutOfRound.depth`."""
        inside = np.clip(1.0 - (0.5 * length - np.abs(z)) / self.relief_length, 0.0, None)
        return np.outer(np.ones(theta.size), self.drop * inside**2)


@dataclass(frozen=True, kw_only=True)
class AxialProfile:
    """Any profile along z, through given points by monotone cubics; constant beyond the first and the last one.

    Parameters
    ----------
    positions : sequence of float
        Increasing z, m, from the bearing's mid-plane; at least 2.
    depths : sequence of float
        Additional gap at these positions, m.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> worn = ehd.AxialProfile(positions=(-0.0125, 0.0, 0.0125), depths=(3e-6, 0.0, 1e-6))
    >>> ehd.JournalBearing(**b, profile=(worn, ehd.Crown(drop=1e-6))).profiles[0] is worn
    True
    """

    positions: Sequence[float]
    depths: Sequence[float]

    def __post_init__(self) -> None:
        z = _increasing("AxialProfile.positions", self.positions, 2, "m")
        d = _finite("AxialProfile.depths", self.depths)
        if d.shape != z.shape:
            raise InputError(
                f"AxialProfile.depths must hold one depth per position ({z.size}), got {d.size}; check the lengths of "
                f"both lists."
            )

    def depth(self, theta: np.ndarray, z: np.ndarray, length: float) -> np.ndarray:
        """Addition to the gap; see `OutOfRound.depth`."""
        at = np.asarray(self.positions, dtype=float)
        line = scipy.interpolate.PchipInterpolator(at, np.asarray(self.depths, dtype=float))(np.clip(z, at[0], at[-1]))
        return np.outer(np.ones(theta.size), line)


@dataclass(frozen=True, kw_only=True)
class ProfileTable:
    """Any profile of the bore over (theta, z), periodic in theta, by monotone cubics along z and then along theta.

    Between two points the depth stays between theirs, so that the table may have steps and kinks (F. N. Fritsch and R.
    E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238). A peak between two points is cut off: a wave with n points around
    loses up to ``1 - cos(pi / n)`` of its amplitude, 1.5 % for 18 points and 0.4 % for 36.

    Parameters
    ----------
    angles : sequence of float
        Increasing theta from the joint's x about its z axis, rad, spanning less than 2 pi; at least 4.
    positions : sequence of float
        Increasing z from the mid-plane, m; at least 2. Constant beyond the first and the last one.
    depths : (angles, positions) array-like
        Additional gap, m, a row per angle.

    Examples
    --------
    >>> angles, positions = np.linspace(0, 5.5, 12), (-0.0125, 0.0125)
    >>> depths = 2e-6 * np.cos(2 * angles)[:, None] * np.ones(2)
    >>> table = ehd.ProfileTable(angles=angles, positions=positions, depths=depths)
    """

    angles: Sequence[float]
    positions: Sequence[float]
    depths: Sequence[Sequence[float]] | np.ndarray = field(repr=False)

    def __post_init__(self) -> None:
        theta = _increasing("ProfileTable.angles", self.angles, 4, "rad")
        z = _increasing("ProfileTable.positions", self.positions, 2, "m")
        d = _finite("ProfileTable.depths", self.depths)
        if theta[-1] - theta[0] > 2.0 * math.pi - ROUNDING:
            raise InputError(
                f"ProfileTable.angles must span less than 2 pi rad, got {theta[-1] - theta[0]:g}; leave out the "
                f"repeated first angle, and give radians."
            )
        if d.shape != (theta.size, z.size):
            raise InputError(
                f"ProfileTable.depths must have the shape (angles, positions) = ({theta.size}, {z.size}), got "
                f"{d.shape}; transpose it if the axes are swapped."
            )

    def depth(self, theta: np.ndarray, z: np.ndarray, length: float) -> np.ndarray:
        """Addition to the gap; see `OutOfRound.depth`."""
        at, turn = np.asarray(self.angles, dtype=float), 2.0 * math.pi
        along, d = np.asarray(self.positions, dtype=float), np.asarray(self.depths, dtype=float)
        rows = scipy.interpolate.PchipInterpolator(along, d, axis=1)(np.clip(z, along[0], along[-1]))
        # slopes depend on the next points alone: one more at the beginning and two at the end close the ring
        around = at - at[0]
        wide = np.concatenate((around[-1:] - turn, around, around[:2] + turn))
        ring = scipy.interpolate.PchipInterpolator(wide, np.concatenate((rows[-1:], rows, rows[:2])))
        return np.asarray(ring(np.mod(theta - at[0], turn)))


@dataclass(frozen=True, kw_only=True)
class WornArc(Checked):
    """Arc worn into a bore by starts and slow turning: ``d = worn_depth - clearance (1 - cos(theta - angle))`` above 0.

    F. W. Dufrane, J. W. Kannel and T. H. McCloskey, J. Lubrication Technology 105 (1983) 313, with theta from the
    deepest place. The worn surface is a part of a circle of the radius ``journal_radius + worn_depth`` about the place
    of a journal that touches the unworn bore at ``angle``: there the film is as thick as the arc is deep, all over the
    arc. It ends with a kink, where d is 0, at ``cos(extent / 2) = 1 - worn_depth / clearance``, and is the same along
    the bearing.

    Parameters
    ----------
    worn_depth : float
        Largest depth, m, at most the clearance; then half of the bore is worn.
    angle : float
        Angle of the deepest place, from the joint's x about its z axis, rad.
    clearance : float
        Radial clearance of the unworn bearing, m. For an arc of a measured extent: ``worn_depth / (1 - cos(extent /
        2))``.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> worn = ehd.WornArc(worn_depth=5e-6, angle=-np.pi / 2, clearance=25e-6)
    >>> round(float(np.degrees(worn.extent)), 1)
    73.7
    >>> rest = ehd.equilibrium(ehd.JournalBearing(**b, profile=worn), speed=314.0, load=(0.0, -2000.0))
    >>> round(rest.eccentricity_ratio, 3), round(1e6 * rest.film.minimum_gap, 2)  # um
    (0.488, 12.79)
    """

    worn_depth: float
    angle: float
    clearance: float

    checks: ClassVar = {"worn_depth": POSITIVE, "angle": require_number, "clearance": POSITIVE}

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.worn_depth > self.clearance:
            raise InputError(
                f"WornArc.worn_depth must be at most the clearance, {self.clearance:g} m, got {self.worn_depth!r} m: a "
                "journal wears no more than half of a larger bore; both are in metres, the clearance is radial."
            )

    @property
    def extent(self) -> float:
        """Angle of the arc, rad, from one end to the other."""
        return 2.0 * math.acos(1.0 - self.worn_depth / self.clearance)

    def depth(self, theta: np.ndarray, z: np.ndarray, length: float) -> np.ndarray:
        """Addition to the gap; see `OutOfRound.depth`."""
        worn = self.worn_depth - self.clearance * (1.0 - np.cos(theta - self.angle))
        return np.outer(np.clip(worn, 0.0, None), np.ones(z.size))


SurfaceProfile = OutOfRound | Crown | EdgeRelief | AxialProfile | ProfileTable | WornArc


class ProfileTerm:
    """Profiles as a gap term of one bearing model.

    Parameters
    ----------
    profiles : tuple of SurfaceProfile
    grid : FilmGrid
    length, clearance : float
        m.
    """

    def __init__(self, profiles: tuple[SurfaceProfile, ...], grid: FilmGrid, length: float, clearance: float) -> None:
        theta, z, steps = grid.x, grid.z * grid.reference_length, 2.0 * (grid.x_face - grid.x)
        linked = grid.link_x != 0.0

        def depth(at: np.ndarray, along: np.ndarray) -> np.ndarray:
            return np.sum([p.depth(at, along, length) for p in profiles], axis=0) / clearance

        self.values = depth(theta, z)
        if not self.values.min() > -1.0:
            raise InputError(
                f"JournalBearing.profile closes the gap of a concentric journal: its depth goes down to "
                f"{self.values.min() * clearance:.3g} m at a radial clearance of {clearance:g} m; a depth is in "
                f"metres and positive where it opens the gap."
            )
        for name, known, inside in (
            ("n_z", self.values.T, lambda share: depth(theta, z[:-1] + share * np.diff(z)).T),
            ("n_theta", np.vstack((self.values, self.values[:1])), lambda share: depth(theta + share * steps, z)),
        ):
            judged = linked if name == "n_theta" else slice(None)
            missed = max(np.abs(inside(s) - known[:-1] - s * np.diff(known, axis=0))[judged].max() for s in BETWEEN)
            if missed > MISSED:
                warn_user(
                    f"JournalBearing.profile: between the vertices of the film's grid it departs from a straight line "
                    f"by {missed:.2g} of the clearance, which the film does not see; take a larger {name}, or leave "
                    "out what is that short.",
                    PlausibilityWarning,
                )

    def field(self, history: object) -> np.ndarray:
        """Scaled addition to the gap (n, m)."""
        return self.values


def _finite(where: str, values: object) -> np.ndarray:
    try:
        array = np.array(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{where} must be finite numbers in rows of equal length, got {values!r}.") from None
    if not np.all(np.isfinite(array)):
        raise InputError(f"{where} must be finite, got {values!r}; fill the gaps of a measured table first.")
    require_plausible(where, values, array)
    return array


def _increasing(where: str, values: object, at_least: int, unit: str) -> np.ndarray:
    array = _finite(where, values)
    if array.ndim != 1 or array.size < at_least or not np.all(np.diff(array) >= ROUNDING):
        raise InputError(
            f"{where} must be at least {at_least} increasing numbers in {unit}, at least {ROUNDING:g} {unit} "
            f"apart, got {values!r}; sort the points."
        )
    return array
