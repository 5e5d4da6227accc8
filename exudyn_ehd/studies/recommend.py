"""The cheapest film that keeps a quantity within an error, from the measurements that come with the package."""

from __future__ import annotations

import dataclasses
import math
import pathlib
from collections.abc import Iterable
from typing import Any

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.models import Film
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.solid.bush import ModalBush
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.status import InputError, require_number
from exudyn_ehd.studies.accuracy_table import (
    DATA,
    FILE,
    FILMS,
    NAMES,
    THICKNESS,
    TOLERANCE,
    Cell,
    bore_compliance,
    elasticity_parameter,
    read_cells,
)
from exudyn_ehd.tables import format_seconds

# Between cells the error ripples with the place of the rupture line on the grid. Over 40 random rigid bearings inside
# the table, six films and seven quantities, the true error reached 1.45 times the worst neighbouring cell, 0.92 times
# over 20 with a liner.
MARGIN = 1.75
# What the cells were not measured with; each changes the film.
_PLAIN = (
    "inlet",
    "end_pressures",
    "squeeze",
    "contact",
    "supply",
    "thermal",
    "asperity",
    "roughness",
    "profile",
    "wear",
    "cavitation",
)
_OIL_LAWS = ("pressure_law", "shear_law", "density_law")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Recommendation:
    """Outcome of `recommend`.

    Attributes
    ----------
    found : bool
        False: there is no evidence for such a bearing, or no measured setting keeps the error; ``reason`` says which.
    film : Film or None
        For ``JournalBearing(film=...)``.
    options : dict
        All fields of `JournalBearing` that the setting replaces, ``film`` among them.
    error : float
        Bound of the quantity's error that the evidence gives.
    seconds : float
        Measured time per evaluation with tangent, on the machine of the measurement.
    evidence : tuple of str
        The measurements that it rests on.
    reason : str
        What was looked for and why this setting, or why none.

    Examples
    --------
    After the example of `recommend`:

    >>> import dataclasses
    >>> dataclasses.replace(bearing, **advice.options).film is advice.film
    True
    >>> advice.error < 0.01
    True
    """

    found: bool
    reason: str
    film: Film | None = None
    options: dict[str, Any] = dataclasses.field(default_factory=dict)
    error: float = math.nan
    seconds: float = math.nan
    evidence: tuple[str, ...] = ()

    def __str__(self) -> str:
        lines = [self.reason]
        if self.found:
            lines.append(f"error within {100.0 * self.error:.2g} %, {format_seconds(self.seconds)}")
        return "\n".join([*lines, *(f"  {line}" for line in self.evidence)])


def recommend(
    bearing: JournalBearing,
    error: float = 0.01,
    quantity: str = "load",
    *,
    eccentricity_ratio: float | tuple[float, float] | None = None,
    tilt_ratio: float = 0.0,
    speed: float | None = None,
    data: pathlib.Path = DATA,
) -> Recommendation:
    """The cheapest film that keeps a quantity within an error, for bearings of this kind.

    Parameters
    ----------
    bearing : JournalBearing
        Plain, rigid, with an `ElasticLiner` or with a `ModalBush` of a hollow cylinder.
    error : float
        Relative.
    quantity : str
        "load", "attitude", "friction", "peak pressure", "minimum film thickness", "leakage", "stiffness" or "damping".
    eccentricity_ratio : float or (lowest, highest)
        Where the bearing works; the worst of a range counts.
    tilt_ratio : float
        Share of the mid-plane's minimum film thickness that the tilt takes at one end.
    speed : float
        rad/s; only for a flexible bore.
    data : path
        Folder of the measurements.

    Returns
    -------
    Recommendation
        ``found=False`` where there is no evidence; it never guesses.

    Raises
    ------
    InputError
        For arguments that can't be meant.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> advice = ehd.recommend(bearing, error=0.01, quantity="peak pressure", eccentricity_ratio=(0.5, 0.9))
    >>> advice.found, advice.film
    (True, FiniteLength(n_theta=96, n_z=10, stretch=0.75))
    """
    require_number("recommend: error", error, above=0.0, below=1.0, hint="it is relative.")
    if not isinstance(bearing, JournalBearing):
        raise InputError(f"recommend: expected a JournalBearing, got {bearing!r}.")
    if speed is not None:
        require_number("recommend: speed", speed, "rad/s")
    if eccentricity_ratio is None:
        raise InputError("recommend: a bearing needs eccentricity_ratio, a number or (lowest, highest).")
    low, high = eccentricity_ratio if isinstance(eccentricity_ratio, tuple) else (eccentricity_ratio,) * 2
    if not 0.0 <= low <= high < 1.0:
        raise InputError(
            f"recommend: eccentricity_ratio must be within 0 and 1, lowest first, got {eccentricity_ratio!r}."
        )
    if quantity not in NAMES:
        raise InputError(f"recommend: quantity must be one of {list(NAMES)}, got {quantity!r}.")
    unlike = _not_measured(bearing) or _unlike_measured_bushes(bearing)
    if unlike:
        return Recommendation(found=False, reason=f"no evidence: {unlike}.")
    kind, kappa = _elasticity(bearing, speed)
    ratio = bearing.length / (2.0 * bearing.journal_radius)
    corners = _corners(
        read_cells(data / FILE),
        kind,
        {
            "length_to_diameter": (ratio, ratio),
            "tilt_ratio": (tilt_ratio, tilt_ratio),
            "elasticity": (kappa, kappa),
            "eccentricity_ratio": (low, high),
        },
    )
    place = f"L/D {ratio:.3g}, eps {low:g} to {high:g}, tilt {tilt_ratio:g}, kappa {kappa:.2g}, {kind} bore"
    return _from_corners(corners, place, error, quantity)


def _from_corners(corners: dict[str, list[Cell]] | str, place: str, error: float, quantity: str) -> Recommendation:
    """The answer from the cells around a bearing, or from the reason why there are none."""
    if isinstance(corners, str):
        return Recommendation(found=False, reason=f"no evidence for {place}: {corners}.")
    bounds = _bounds(corners, quantity)
    within = [(seconds, setting, bound) for setting, (bound, seconds) in bounds.items() if bound <= error]
    if not within:
        least = min((bound for bound, _ in bounds.values()), default=math.inf)
        return Recommendation(
            found=False,
            reason=f"{place}: no measured setting keeps the {quantity} within {error:g}; the best gives {least:.2g}.",
        )
    seconds, setting, bound = min(within)
    film = FILMS[setting]
    return Recommendation(
        found=True,
        film=film,
        options={"film": film},
        error=bound,
        seconds=seconds,
        reason=f"{setting} for {place}: the {quantity} within {error:g}",
        evidence=tuple(
            f"L/D {c.length_to_diameter:g}, tilt {c.tilt_ratio:g}, kappa {c.elasticity:g}, "
            f"eps {c.eccentricity_ratio:g}: {100.0 * c.errors[quantity]:.2g} %"
            for c in corners[setting]
        ),
    )


def _not_measured(bearing: JournalBearing) -> str:
    """Which option or law of the oil no cell has; empty if none."""
    defaults = {f.name: f.default for f in dataclasses.fields(JournalBearing)}
    options = [(name, getattr(bearing, name)) for name in _PLAIN if getattr(bearing, name) != defaults[name]]
    laws = [(f"lubricant.{name}", getattr(bearing.lubricant, name)) for name in _OIL_LAWS]
    for name, value in [*options, *((name, law) for name, law in laws if law is not None)]:
        return f"no bearing with {name}={value!r} was measured for this table"
    return ""


def _unlike_measured_bushes(bearing: JournalBearing) -> str:
    """Why no measured bush is like this one; empty if one is."""
    bush = bearing.bush
    if bush is None or isinstance(bush, ElasticLiner):
        return ""
    if not isinstance(bush, ModalBush):
        return f"solid bushes were measured as ModalBush only, not as {type(bush).__name__}; compare a finer film"
    if not isinstance(bush.mesh, HollowCylinder) or not (
        0.5 <= bush.mesh.thickness / (THICKNESS * bush.mesh.inner_radius) <= 2.0
    ):
        return (
            "bushes were measured as hollow cylinders only, half as thick as their radius; "
            "a factor of two either way counts"
        )
    if bush.tolerance < TOLERANCE:
        return f"modes were measured down to tolerance {TOLERANCE:g}, not {bush.tolerance:g}; compare a finer film"
    return ""


def _elasticity(bearing: JournalBearing, speed: float | None) -> tuple[str, float]:
    """Kind of the bore, one of those that were measured, and its elasticity parameter."""
    bush = bearing.bush
    if bush is None:
        return "rigid", 0.0
    if speed is None:
        raise InputError("recommend: a flexible bore needs the speed, rad/s: its elasticity parameter grows with it.")
    if isinstance(bush, ElasticLiner):
        return "liner", elasticity_parameter(bearing, bush.compliance, speed)
    assert isinstance(bush, ModalBush) and isinstance(bush.mesh, HollowCylinder)
    mesh, material = bush.mesh, bush.material
    compliance = bore_compliance(mesh.thickness, mesh.inner_radius, material.youngs_modulus, material.poisson_ratio)
    return "solid", elasticity_parameter(bearing, compliance, speed)


def _corners(table: Iterable[Cell], kind: str, box: dict[str, tuple[float, float]]) -> dict[str, list[Cell]] | str:
    """Cells of every setting around a box of parameters, or what lies outside of the table.

    A flexible bore between rigid and the softest measured one is judged by rigid cells, too.
    """
    kept = [c for c in table if c.kind in ("rigid", kind)]
    chosen = {}
    for axis, (low, high) in box.items():
        own = [c for c in kept if c.kind == kind or axis == "elasticity"]
        values = sorted({getattr(c, axis) for c in own})
        if low < values[0] or high > values[-1]:
            return f"{axis} is measured from {values[0]:g} to {values[-1]:g}"
        first = max(v for v in values if v <= low)
        last = min(v for v in values if v >= high)
        chosen[axis] = {v for v in values if first <= v <= last}
    around: dict[str, list[Cell]] = {}
    for c in kept:
        if all(getattr(c, axis) in values for axis, values in chosen.items()):
            around.setdefault(c.setting, []).append(c)
    count = math.prod(len(values) for values in chosen.values())
    return {setting: found for setting, found in around.items() if len(found) == count}


def _bounds(corners: dict[str, list[Cell]], quantity: str) -> dict[str, tuple[float, float]]:
    """Bound of the error and time by setting, from its worst cell."""
    out = {}
    for setting, found in corners.items():
        errors = [c.errors[quantity] for c in found]
        if not any(math.isnan(e) for e in errors):
            out[setting] = MARGIN * max(errors), max(c.seconds for c in found)
    return out
