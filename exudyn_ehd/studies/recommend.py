"""The cheapest film that keeps a quantity within an error, measured on the bearing itself.

Films on a ladder of grids, with the rupture line on the grid and inside its cells, are compared with a film of 256 x 24
intervals at the eccentricities asked for. At each the journal points in twelve directions, with supply or a profile in
24, around the circumference and spread over the columns of every grid, since errors ripple with the place of the
rupture line and of the supply on the grid. An error is

    e = MARGIN (max |q - q_fine| + e_fine) / scale,

e_fine from three levels by Richardson's extrapolation, scale the quantity's largest absolute value (of the attitude
1 rad; of stiffness and damping that of the largest entry).
"""

from __future__ import annotations

import dataclasses
import math
import warnings
from collections.abc import Iterator, Sequence
from typing import Any, TypeAlias

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.models import FilmOption, FiniteLength, ShortBearing
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.solid.bush import ANCFBush
from exudyn_ehd.status import (
    SMALL,
    EHDError,
    FilmError,
    InputError,
    PlausibilityWarning,
    require_number,
    require_vector,
)
from exudyn_ehd.studies.film_errors import SCALES, converged, measure_motions, motion_at, scale_of, time_of_sweep
from exudyn_ehd.tables import format_seconds

# Fields of `JournalBearing` to replace.
Options: TypeAlias = dict[str, Any]
LADDER = ((32, 4), (48, 6), (64, 8), (96, 10), (128, 12), (192, 16))
LEVELS = ((64, 6), (128, 12), (256, 24))
MARGIN = 1.5
# Largest distance of eccentricity ratios at which errors are measured.
SPACING = 0.1
# Ranges in which the recommendation was tried.
TRIED = {"L/D": (0.25, 2.0), "tilt_ratio": (0.0, 0.7), "eccentricity_ratio": (0.1, 0.95)}


@dataclasses.dataclass(frozen=True, kw_only=True)
class Recommendation:
    """Result of `recommend`: the film, its error and its time, or the reason why none was found.

    Attributes
    ----------
    found : bool
        False: the bearing is outside the limits of `recommend`, or no film keeps the error; ``reason`` says which.
    film : FilmOption or None
        Film for ``JournalBearing(film=...)``.
    options : dict
        Fields of `JournalBearing` to replace, as in the example: ``film``, and ``cavitation`` where the rupture line
        has to move into the cells or onto the vertices.
    error : float
        Upper bound of the quantity's relative error (0.01 is 1 %).
    seconds : float
        Processor time of one evaluation with tangent on this machine, s.
    evidence : tuple of str
        Measured errors, a line for each eccentricity ratio.
    reason : str
        The request and the setting found, or why there is none.

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
    film: FilmOption | None = None
    options: Options = dataclasses.field(default_factory=dict)
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
    direction: float | None = None,
    speed: float | None = None,
) -> Recommendation:
    """Find the cheapest film model and grid that keep the error of a quantity below a limit, for one bearing.

    It compares films on a ladder of grids with a finer one at the given eccentricity ratios: a second or two for a
    rigid bearing, longer with heat or a flexible bore.

    Parameters
    ----------
    bearing : JournalBearing
        L/D from 0.25 to 2; no `ANCFBush`, ``inlet=MaximumGap()`` or arc. The film given in it does not matter.
    error : float, default 0.01
        Largest relative error of the quantity, above 0 and below 1 (0.01 is 1 %).
    quantity : str, default "load"
        "load", "attitude", "friction", "peak pressure", "minimum film thickness", "leakage", "supply flow",
        "stiffness", "damping" or "critical mass".
    eccentricity_ratio : float or (lowest, highest), default None
        Required: eccentricity ratio at which the bearing works, 0.1 to 0.95; in a range the largest error counts.
    tilt_ratio : float, default 0.0
        Share of the mid-plane's minimum film thickness by which the tilt reduces it at one end, 0 to 0.7.
    direction : float or None, default None
        Angle of the eccentricity from x towards y, rad; None: the largest error over all directions counts. It matters
        for bearings with supply areas or profiles. Supply areas that turn with the journal meet all directions.
    speed : float or None, default None
        Spin, rad/s. Only plain bearings do without: their relative errors do not depend on it.

    Returns
    -------
    Recommendation
        ``found=False`` with a reason for bearings outside these limits, or if no film keeps the error.

    Raises
    ------
    InputError
        For arguments of a wrong type or shape, or outside their ranges.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> advice = ehd.recommend(bearing, error=0.01, quantity="peak pressure", eccentricity_ratio=(0.5, 0.9))
    >>> advice.found, advice.film
    (True, FiniteLength(n_theta=96, n_z=10, stretch=0.75))
    """
    low, high = _require(bearing, error, quantity, eccentricity_ratio)
    require_number("recommend: tilt_ratio", tilt_ratio, at_least=0.0, below=1.0)
    if direction is not None:
        require_number("recommend: direction", direction, "rad")
    speed = _speed(bearing, speed)
    ratio = bearing.length / (2.0 * bearing.journal_radius)
    place = f"L/D {ratio:.3g}, eps {low:g} to {high:g}, tilt {tilt_ratio:g}"
    asked = ("L/D", ratio), ("tilt_ratio", tilt_ratio), ("eccentricity_ratio", low), ("eccentricity_ratio", high)
    if unknown := _unknown(bearing, quantity, asked):
        return Recommendation(found=False, reason=f"nothing is known of this bearing: {unknown}.")
    count = 1 + math.ceil((high - low) / SPACING - 1e-9)
    ratios = np.linspace(low, high, count)
    motions = [
        [motion_at(bearing, speed, float(e), tilt_ratio, a) for a in _angles(bearing, direction)] for e in ratios
    ]
    try:
        truth = [_reference(bearing, quantity, block) for block in motions]
    except FilmError as failure:
        return Recommendation(found=False, reason=f"{place}: {failure}")
    least = math.inf
    for film, options in _settings(bearing):
        errors = _errors(bearing, options, quantity, motions, truth)
        if errors is None or max(errors) > error:
            least = min(least, math.inf if errors is None else max(errors))
            continue
        flat, chosen = [motion for block in motions for motion in block], dataclasses.replace(bearing, **options)
        return Recommendation(
            found=True,
            film=film,
            options=options,
            error=max(errors),
            seconds=time_of_sweep(_model(chosen), flat),
            reason=f"{_words(chosen)} for {place}: the {quantity} within {error:g}",
            evidence=tuple(
                f"eps {e:.3g}: {100.0 * bound:.2g} %, of it {100.0 * MARGIN * own:.2g} % the reference's own"
                for e, bound, (_, own) in zip(ratios, errors, truth, strict=True)
            ),
        )
    return Recommendation(
        found=False,
        reason=f"{place}: no film on the ladder keeps the {quantity} within {error:g}; the best gives {least:.2g}.",
    )


def _require(
    bearing: object, error: float, quantity: str, eccentricity_ratio: float | tuple[float, float] | None
) -> tuple[float, float]:
    """Checked arguments; the lowest and the highest eccentricity ratio."""
    require_number("recommend: error", error, above=0.0, below=1.0, hint="it is relative: 0.01 is 1 %.")
    if not isinstance(bearing, JournalBearing):
        raise InputError(f"recommend: expected a JournalBearing, got {bearing!r}.")
    if eccentricity_ratio is None:
        raise InputError("recommend: a bearing needs eccentricity_ratio, a number or (lowest, highest).")
    if isinstance(eccentricity_ratio, (int, float, np.number)):
        eccentricity_ratio = (eccentricity_ratio, eccentricity_ratio)
    low, high = require_vector("recommend: eccentricity_ratio", eccentricity_ratio, 2)
    if not 0.0 <= low <= high < 1.0:
        raise InputError(
            f"recommend: eccentricity_ratio must be between 0 and 1, lowest first, got {eccentricity_ratio!r}."
        )
    if quantity not in SCALES:
        raise InputError(f"recommend: quantity must be one of {list(SCALES)}, got {quantity!r}.")
    if quantity == "supply flow" and not bearing.supply:
        raise InputError("recommend: quantity='supply flow' needs a bearing with supply=(...).")
    return float(low), float(high)


def _speed(bearing: JournalBearing, speed: float | None) -> float:
    """The spin; any where relative results do not depend on it."""
    if speed is not None:
        return require_number("recommend: speed", speed, "rad/s")
    oil, closure = bearing.lubricant, bearing.cavitation
    own = {
        "a bush or an elastic journal": bearing.yielding,
        "supply": bearing.supply,
        "end_pressures": any(bearing.end_pressures),
        "thermal": bearing.thermal,
        "contact": bearing.contact,
        "asperity": bearing.asperity,
        "wear": bearing.wear,
        "turbulence": bearing.turbulence,
        "a law of the oil": oil.pressure_law or oil.shear_law or oil.density_law,
        "a cavity pressure": getattr(closure, "cavity_pressure", 0.0),
    }
    for name, there in own.items():
        if there:
            raise InputError(f"recommend: speed (rad/s) is needed with {name}: relative errors depend on it.")
    return 100.0


def _unknown(bearing: JournalBearing, quantity: str, asked: Sequence[tuple[str, float]]) -> str:
    """Return the reason why nothing is known of such a bearing; empty if something is."""
    if isinstance(bearing.bush, ANCFBush):
        return "an ANCFBush takes minutes a film; ask for the ModalBush of the same mesh, or compare a finer film"
    if isinstance(bearing.inlet, MaximumGap):
        return "inlet=MaximumGap() cuts the film where the journal stands; compare a finer film"
    if bearing.bore_arcs:
        return "an arc carries loads of some directions only; compare a finer film"
    if quantity == "critical mass" and any(area.rotating for area in bearing.supply):
        return "supply areas turn with the journal (rotating=True), so that it has no equilibrium and no critical mass"
    for name, value in asked:
        lowest, highest = TRIED[name]
        if not lowest <= value <= highest:
            return f"{name} is {value:g}, and this was tried from {lowest:g} to {highest:g}"
    return ""


def _angles(bearing: JournalBearing, direction: float | None) -> np.ndarray:
    """Directions of the eccentricity, rad: all around or where asked, over a column of the coarsest grid.

    They are 12, or 24 of bearings whose film changes with the place of supply or profile in it. All around too where
    supply areas turn with the journal: they pass every angle to the eccentricity.
    """
    if any(area.rotating for area in bearing.supply):
        direction = None
    many = 24 if (bearing.supply or bearing.profiles) and direction is None else 12
    count = np.arange(many)
    # multiples of the golden ratio, without whole parts, spread over every column of the ladder's grids
    places = 2.0 * math.pi / LADDER[0][0] * (0.5 * (math.sqrt(5.0) - 1.0) * count % 1.0 - 0.5)
    return places + (2.0 * math.pi / many * count if direction is None else direction)


def _settings(bearing: JournalBearing) -> Iterator[tuple[FilmOption, Options]]:
    """Films of the ladder and what they replace, the cheapest first: with the rupture line on the vertices, and where
    the bearing may, inside the cells."""
    given: FilmOption = bearing.film
    own = given if isinstance(given, FiniteLength) else FiniteLength()
    is_inside = bool(dataclasses.replace(bearing, film=FiniteLength()).closure.line_in_cells)
    # a line that was put inside the cells stays there
    stays = is_inside and bearing.cavitation.line_in_cells is not None
    other = None if stays else _with_line(bearing, not is_inside)
    closures = [options for options in ((other, {}) if is_inside else ({}, other)) if options is not None]
    for n, m in LADDER:
        film = FiniteLength(n_theta=n, n_z=m, stretch=own.stretch)
        yield from ((film, {"film": film, **options}) for options in closures)
        if (n, m) == LADDER[0]:
            short = ShortBearing(n_theta=64)
            yield short, {"film": short}


def _with_line(bearing: JournalBearing, in_cells: bool) -> Options | None:
    """The closure with its rupture line inside the cells or on the vertices; None where it has none or may not."""
    if math.isinf(bearing.cavitation.cavity_pressure):
        return None
    lined: Any = dataclasses.replace(bearing.cavitation, line_in_cells=in_cells)  # type: ignore[type-var]
    try:
        dataclasses.replace(bearing, film=FiniteLength(), cavitation=lined)
    except InputError:
        return None
    return {"cavitation": lined}


def _reference(bearing: JournalBearing, quantity: str, motions: list[np.ndarray]) -> tuple[np.ndarray, float]:
    """Values of the finest film over the motions, and their estimated relative error.

    Raises
    ------
    FilmError
        If there is none, or none that carries anything.
    """
    options: Options = _with_line(bearing, True) or {}
    levels = []
    for n, m in LEVELS:
        model = _model(dataclasses.replace(bearing, film=FiniteLength(n_theta=n, n_z=m), **options))
        values = measure_motions(model, motions)
        if float(values["load"].min()) < SMALL * bearing.reference_force(motions[0][8]):
            raise FilmError(
                "the film carries nothing, and errors relative to nothing mean nothing. With ElrodAdams a film that "
                "nothing feeds runs dry: give the bearing supply=(...) or end_pressures."
            )
        if not np.all(np.isfinite(values[quantity])):
            raise FilmError(f"there is no {quantity}: the journal does not whirl there at any mass.")
        levels.append(values[quantity])
    found = converged(levels, ratio=2.0, formal_order=2.0, scale=scale_of(quantity, levels[-1]))
    return found.value, found.error


def _model(bearing: JournalBearing) -> BearingModel:
    """Model on a grid whose error is measured: that it may be coarse for a profile need not be told."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PlausibilityWarning)
        model = build_model(bearing)
    assert isinstance(model, BearingModel)
    return model


def _errors(
    bearing: JournalBearing,
    options: Options,
    quantity: str,
    motions: list[list[np.ndarray]],
    truth: list[tuple[np.ndarray, float]],
) -> list[float] | None:
    """Bounds of the errors at every eccentricity; None for a film that the bearing or the place does not allow."""
    try:
        model = _model(dataclasses.replace(bearing, **options))
        values = [measure_motions(model, block)[quantity] for block in motions]
    except EHDError:
        return None
    if not all(np.all(np.isfinite(value)) for value in values):
        return None
    return [
        MARGIN * (float(np.max(np.abs(value - fine))) / scale_of(quantity, fine) + own)
        for value, (fine, own) in zip(values, truth, strict=True)
    ]


def _words(bearing: JournalBearing) -> str:
    """The setting of a bearing in words."""
    film = bearing.sized_film
    grid = f"{film.n_theta} x {film.n_z}"
    if isinstance(film, ShortBearing):
        return f"short bearing {grid}"
    return f"2D {grid}, line {'in cells' if bearing.closure.line_in_cells else 'on vertices'}"
