"""Description of an elastic journal by the user: its cylinder, its material and the bands where its body holds it.

The body of the joint's journal moves as a rigid body; the journal's motion relative to it is the deflection. With
`HeldBands` and `HeldEnds` the body holds the pin (a piston with its bosses, a crank with its webs), and the pin's
bending against it is deflection. With ``held=None`` the journal is the body itself, and nothing holds it. Its rigid
motion under the film's force is then the body's. Its deflection is the rest, in the frame of its mean motion,

    K u = f - M R (R^T M R)^-1 R^T f,   R^T M u = 0,

with its rigid motions R and its mass M, spread as its material is (inertia relief). No motion is counted twice: modes
under ``held=None`` have neither momentum nor moment of momentum.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from exudyn_ehd.solid.bush import ModalBush, require_tolerance
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from exudyn_ehd.status import InputError, require_bool, require_number, require_type, require_vector


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

    The surface does not move there against the body, in no direction: bosses as stiff as the body, without play. One
    band beside the film: an overhung pin.

    Parameters
    ----------
    bands : tuple of (float, float)
        Axial places where each begins and ends, joint frame, beside the film [m].

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
class ElasticJournal:
    """A linear elastic solid or hollow pin as a bearing's journal, reduced to modes of its surface.

    Quasi-static: it follows the film at once, its mass is its body's. Weight, centrifugal forces and loads that act on
    the body elsewhere do not bend it. It is a cylinder, so that its response does not depend on its angle: its modes
    stay in the joint's frame, in which the film does not turn either, whatever its spin. To first order the film knows
    the radial deflection alone, along the axis of the bore; the journal's tilt (1e-3) turns it by that share, and its
    slide along the axis is left out.

    Parameters
    ----------
    material : SaintVenantKirchhoff
        Its density is not used.
    span : (float, float)
        Axial places of its end faces in the joint frame, about the bearing's mid-plane [m]; the film lies between them.
    held : HeldEnds, HeldBands or None
        Bands or ends where its body holds it; None: the journal is the body, and its mean motion is the body's.
    inner_radius : float, default 0.0
        Inner radius of a hollow pin [m]; 0: solid. The outer one is the bearing's ``journal_radius``.
    tolerance : float, default 0.05
        Error of the surface's displacement under sampled films, as in `ModalBush`; 2e-3 to 0.2. Of a pin that bends by
        more than it flattens, over what it deforms locally.
    tilted : bool, default True
        False leaves out the modes that are odd in z: for journals that stay parallel.

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

    def __post_init__(self) -> None:
        require_type("ElasticJournal.material", self.material, SaintVenantKirchhoff)
        require_type("ElasticJournal.held", self.held, HeldEnds, HeldBands, type(None))
        require_number("ElasticJournal.inner_radius", self.inner_radius, "m", at_least=0.0, hint="0 is a solid pin.")
        require_tolerance("ElasticJournal.tolerance", self.tolerance)
        require_bool("ElasticJournal.tilted", self.tilted)
        object.__setattr__(self, "span", _place("ElasticJournal.span", self.span))

    @property
    def bands(self) -> tuple[tuple[float, float], ...]:
        """Bands in which its cylinder is held, [m]."""
        return self.held.bands if isinstance(self.held, HeldBands) else ()

    def require_fit(self, radius: float, length: float, bush: object) -> None:
        """Refuse a journal of ``radius`` that does not carry a film of ``length`` about z = 0, or go with its bush."""
        half, (low, high) = 0.5 * length * (1.0 - 1e-9), self.span
        if bush is not None and not isinstance(bush, ModalBush):
            raise InputError(
                "JournalBearing.journal=ElasticJournal(...) goes with a rigid bore or a ModalBush(...), got "
                f"bush={type(bush).__name__}(...): its modes follow those of such a bush and have no mass; take one, "
                "or leave one out."
            )
        if not self.inner_radius <= THINNEST * radius:
            raise InputError(
                f"ElasticJournal.inner_radius must be at most {THINNEST:g} of the journal radius {radius:g} m, got "
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


# Largest inner radius, over the outer one.
THINNEST = 0.95


def _place(where: str, value: tuple[float, float]) -> tuple[float, float]:
    low, high = require_vector(where, value, 2, "m").tolist()
    if not low < high:
        raise InputError(f"{where} must be two places in m, the lower one first, got {value!r}.")
    return low, high
