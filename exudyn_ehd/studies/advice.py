"""The cheapest setting that keeps a quantity within an error, from the measurements that are shipped with the package."""

from __future__ import annotations

import dataclasses
import math
import pathlib
from collections.abc import Callable, Iterable
from typing import Any

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.models import Film
from exudyn_ehd.film.solvers.liner import ElasticLiner
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.static_modes import ModalBush
from exudyn_ehd.status import InputError, require_number
from exudyn_ehd.studies import catalogue, cells, moving_catalogue
from exudyn_ehd.studies.cells import Cell
from exudyn_ehd.studies.moving import MovingScene
from exudyn_ehd.studies.setting import Integration, Scene, Setting
from exudyn_ehd.studies.steady import SteadyScene
from exudyn_ehd.studies.table import Row, format_seconds, read_rows

# Between cells the error ripples with the place of the rupture line on the grid. Over 40 random rigid bearings inside the table, six films
# and seven quantities, the true error reached 1.45 times the worst neighbouring cell, 0.92 times over 20 with a liner.
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
    integration : Integration or None
        Steps and solver, for a moving scene.
    error : float
        Bound of the quantity's error that the evidence gives.
    seconds : float
        Measured time per evaluation with tangent (steady) or of the whole run (moving), on the machine of the measurement.
    evidence : tuple of str
        The measurements that it rests on.
    reason : str
        What was looked for and why this setting, or why none.
    """

    found: bool
    reason: str
    film: Film | None = None
    options: dict[str, Any] = dataclasses.field(default_factory=dict)
    integration: Integration | None = None
    error: float = math.nan
    seconds: float = math.nan
    evidence: tuple[str, ...] = ()

    def __str__(self) -> str:
        lines = [self.reason]
        if self.found:
            lines.append(f"error within {100.0 * self.error:.2g} %, {format_seconds(self.seconds)}")
        return "\n".join([*lines, *(f"  {line}" for line in self.evidence)])


def recommend(
    bearing_or_scene: JournalBearing | Scene,
    error: float = 0.01,
    quantity: str = "load",
    *,
    eccentricity_ratio: float | tuple[float, float] | None = None,
    tilt_ratio: float = 0.0,
    speed: float | None = None,
    data: pathlib.Path = cells.DATA,
) -> Recommendation:
    """The cheapest film (and steps) that keeps a quantity within an error, for bearings of this kind.

    Parameters
    ----------
    bearing_or_scene : JournalBearing or Scene
        A plain bearing, rigid, with an `ElasticLiner` or with a `ModalBush` of a hollow cylinder; or one of the measured scenes of
        `exudyn_ehd.studies`, whose own tables count.
    error : float
        Relative.
    quantity : str
        For a bearing: "load", "attitude", "friction", "peak pressure", "minimum film", "leakage", "stiffness" or "damping"; for a scene
        one of its quantities.
    eccentricity_ratio : float or (lowest, highest)
        Where a bearing works; the worst of a range counts.
    tilt_ratio : float
        Share of the mid-plane's smallest gap that the tilt takes at one end.
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
    """
    if not 0.0 < require_number("recommend: error", error) < 1.0:
        raise InputError(f"recommend: error must be within 0 and 1 (relative), got {error!r}.")
    if isinstance(bearing_or_scene, JournalBearing):
        if eccentricity_ratio is None:
            raise InputError("recommend: a bearing needs eccentricity_ratio, a number or (lowest, highest).")
        low, high = eccentricity_ratio if isinstance(eccentricity_ratio, tuple) else (eccentricity_ratio,) * 2
        if not 0.0 <= low <= high < 1.0:
            raise InputError(
                f"recommend: eccentricity_ratio must be within 0 and 1, lowest first, got {eccentricity_ratio!r}."
            )
        return _for_bearing(bearing_or_scene, error, quantity, (low, high), tilt_ratio, speed, data)
    known = [q.name for q in bearing_or_scene.quantities]
    if quantity not in known:
        raise InputError(f"recommend: quantity must be one of the scene's, {known}, got {quantity!r}.")
    if isinstance(bearing_or_scene, MovingScene):
        return _for_moving(bearing_or_scene, error, quantity, data)
    if isinstance(bearing_or_scene, SteadyScene):
        return _for_steady(bearing_or_scene, error, quantity, data)
    raise InputError(
        f"recommend: expected a JournalBearing or a scene of exudyn_ehd.studies, got {bearing_or_scene!r}."
    )


# --- bearings: cells ----------------------------------------------------------------------------------------------------


def _for_bearing(
    bearing: JournalBearing, error: float, quantity: str, eccentricities: tuple[float, float], tilt_ratio: float,
    speed: float | None, data: pathlib.Path,
) -> Recommendation:  # fmt: skip
    if quantity not in cells.NAMES:
        raise InputError(f"recommend: quantity must be one of {list(cells.NAMES)}, got {quantity!r}.")
    missing = _not_measured(bearing)
    if missing:
        return Recommendation(
            found=False, reason=f"no evidence: no bearing with {missing} was measured for this table."
        )
    strange = _unlike_measured_bushes(bearing)
    if strange:
        return Recommendation(found=False, reason=f"no evidence: {strange}.")
    kind, compliance = _compliance(bearing)
    kappa = 0.0
    if kind != "rigid":
        if speed is None:
            raise InputError(
                "recommend: a flexible bore needs the speed, rad/s: its elasticity parameter grows with it."
            )
        kappa = cells.elasticity_parameter(bearing, compliance, speed)
    ratio = bearing.length / (2.0 * bearing.journal_radius)
    table = cells.read_cells(data / cells.FILE)
    box = {
        "length_to_diameter": (ratio, ratio), "tilt_ratio": (tilt_ratio, tilt_ratio), "elasticity": (kappa, kappa),
        "eccentricity_ratio": eccentricities,
    }  # fmt: skip
    corners = _corners(table, kind, box)
    place = f"L/D {ratio:.3g}, eps {eccentricities[0]:g} to {eccentricities[1]:g}, tilt {tilt_ratio:g}, kappa {kappa:.2g}, {kind} bore"
    if isinstance(corners, str):
        return Recommendation(found=False, reason=f"no evidence for {place}: {corners}.")
    best = _cheapest(corners, error, quantity)
    if best is None:
        least = min((b for b, _ in _bounds(corners, quantity).values()), default=math.inf)
        return Recommendation(
            found=False,
            reason=f"{place}: no measured setting keeps the {quantity} within {error:g}; the best gives {least:.2g}.",
        )
    setting, bound, seconds = best
    film = cells.FILMS[setting]
    return Recommendation(
        found=True, film=film, options={"film": film}, error=bound, seconds=seconds,
        reason=f"{setting} for {place}: the {quantity} within {error:g}",
        evidence=tuple(
            f"L/D {c.length_to_diameter:g}, tilt {c.tilt_ratio:g}, kappa {c.elasticity:g}, eps {c.eccentricity_ratio:g}: "
            f"{100.0 * c.errors[quantity]:.2g} %"
            for c in corners[setting]
        ),
    )  # fmt: skip


def _not_measured(bearing: JournalBearing) -> str:
    """What the bearing has that no cell has; empty if nothing."""
    defaults = {f.name: f.default for f in dataclasses.fields(JournalBearing)}
    for name in _PLAIN:
        if getattr(bearing, name) != defaults[name]:
            return f"{name}={getattr(bearing, name)!r}"
    if bearing.cavitation != defaults["cavitation"]:
        return f"cavitation={bearing.cavitation!r}"
    for name in _OIL_LAWS:
        if getattr(bearing.lubricant, name) is not None:
            return f"lubricant.{name}={getattr(bearing.lubricant, name)!r}"
    return ""


def _unlike_measured_bushes(bearing: JournalBearing) -> str:
    """Why no measured bush stands for this one; empty if one does."""
    bush = bearing.bush
    if bush is None or isinstance(bush, ElasticLiner):
        return ""
    if not isinstance(bush, ModalBush):
        return (
            f"solid bushes were measured as ModalBush only, not as {type(bush).__name__}, whose bore gives way next to its ends within less "
            "than an interval of a coarse film; compare a finer film"
        )
    if not isinstance(bush.mesh, HollowCylinder) or not (
        0.5 <= bush.mesh.thickness / (cells.THICKNESS * bush.mesh.inner_radius) <= 2.0
    ):
        return "bushes were measured as hollow cylinders only, half as thick as their radius; a factor of two either way counts"
    if bush.tolerance < cells.TOLERANCE:
        return (
            f"modes were measured down to tolerance {cells.TOLERANCE:g}, not {bush.tolerance:g}: finer ones need finer films; compare a finer "
            "film"
        )
    return ""


def _compliance(bearing: JournalBearing) -> tuple[str, float]:
    """Kind of the bore and its displacement per pressure, m/Pa."""
    if bearing.bush is None:
        return "rigid", 0.0
    if isinstance(bearing.bush, ElasticLiner):
        return "liner", bearing.bush.compliance
    bush: Any = bearing.bush
    mesh, material = bush.mesh, bush.material
    return "solid", cells.bore_compliance(
        mesh.thickness, mesh.inner_radius, material.youngs_modulus, material.poisson_ratio
    )


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


def _cheapest(corners: dict[str, list[Cell]], error: float, quantity: str) -> tuple[str, float, float] | None:
    within = [(seconds, s, bound) for s, (bound, seconds) in _bounds(corners, quantity).items() if bound <= error]
    if not within:
        return None
    seconds, setting, bound = min(within)
    return setting, bound, seconds


# --- scenes: their own tables -----------------------------------------------------------------------------------------


def _table(data: pathlib.Path, name: str, quantity: str) -> list[Row]:
    path = data / f"{name}.csv"
    rows = read_rows(path)[0] if path.exists() else []
    return [row for row in rows if row.quantity == quantity and row.timed]


def _pick(rows: list[Row], error: float) -> Row | None:
    within = [row for row in rows if row.error + row.reference_error <= error]
    return min(within, key=lambda row: row.seconds, default=None)


def _setting(settings: Iterable[Setting], label: str) -> Setting:
    return next(s for s in settings if s.label == label)


def _line(row: Row) -> str:
    return (
        f"{row.study}, {row.setting}: {100.0 * row.error:.2g} % against {row.reference} (itself good to "
        f"{100.0 * row.reference_error:.2g} %), {format_seconds(row.seconds)}"
    )


def _none(scene: Scene, error: float, quantity: str, rows: list[Row]) -> Recommendation:
    least = min((row.error + row.reference_error for row in rows), default=math.inf)
    return Recommendation(
        found=False,
        reason=f"{scene.title}: no measured setting keeps the {quantity} within {error:g}; the best gives {least:.2g}.",
    )


def _for_steady(scene: SteadyScene, error: float, quantity: str, data: pathlib.Path) -> Recommendation:
    known = catalogue.steady_scene(scene.eccentricity_ratio, scene.tilt_ratio)
    rows = _table(data, f"{scene.name}_film", quantity) if known == scene else []
    if not rows:
        return _for_bearing(
            scene.bearing, error, quantity, (scene.eccentricity_ratio,) * 2, scene.tilt_ratio, scene.speed, data
        )
    row = _pick(rows, error)
    if row is None:
        return _none(scene, error, quantity, rows)
    setting = _setting(catalogue.steady_film(scene, quick=False).settings, row.setting)
    return Recommendation(
        found=True, film=setting.options["film"], options=dict(setting.options), error=row.error + row.reference_error,
        seconds=row.seconds, evidence=(_line(row),), reason=f"{row.setting} for {scene.title}: the {quantity} within {error:g}",
    )  # fmt: skip


def _for_moving(scene: MovingScene, error: float, quantity: str, data: pathlib.Path) -> Recommendation:
    make: Callable[[], MovingScene] | None = moving_catalogue.SCENES.get(scene.name)
    if make is None or make().bearing != scene.bearing:
        return Recommendation(
            found=False,
            reason=f"no evidence: {scene.title} is none of the measured scenes {list(moving_catalogue.SCENES)}.",
        )
    films, steps = (_table(data, f"{scene.name}_{ladder}", quantity) for ladder in ("film", "integration"))
    if not films or not steps:
        return Recommendation(
            found=False, reason=f"no evidence: {scene.title} has no table of films and steps for {quantity}."
        )
    # half of the error for the film, half for the integration
    film, step = _pick(films, 0.5 * error), _pick(steps, 0.5 * error)
    if film is None or step is None:
        return _none(scene, 0.5 * error, quantity, films if film is None else steps)
    setting = _setting(moving_catalogue.film_study(scene).settings, film.setting)
    integration = _setting(moving_catalogue.integration_study(scene, runge_kutta=24).settings, step.setting).integration
    reached = film.error + film.reference_error + step.error + step.reference_error
    # both runs vary one thing from the same base: times are proportional to cost per step and to steps
    base = next((row for row in steps if row.setting == f"{scene.steps} steps, rho 0.8"), step)
    return Recommendation(
        found=True, film=setting.options["film"], options=dict(setting.options), integration=integration, error=reached,
        seconds=film.seconds * step.seconds / base.seconds, evidence=(_line(film), _line(step)),
        reason=f"{film.setting} with {step.setting} for {scene.title}: the {quantity} within {error:g}",
    )  # fmt: skip
