"""The cheapest film and steps that keep a quantity of a measured scene within an error, from the scene's own tables."""

from __future__ import annotations

import dataclasses
import math
import pathlib
from collections.abc import Sequence

from exudyn_ehd.status import InputError
from exudyn_ehd.studies.recommend import Recommendation, recommend
from exudyn_ehd.tables import format_seconds
from tests.benchmarks.accuracy import catalogue
from tests.benchmarks.accuracy.errors.study import Study
from tests.benchmarks.accuracy.report.front import cheapest
from tests.benchmarks.accuracy.scenes.measured import SCENES, steady_scene
from tests.benchmarks.accuracy.scenes.moving import MovingScene
from tests.benchmarks.accuracy.scenes.setting import Integration, Setting
from tests.benchmarks.accuracy.scenes.steady import SteadyScene
from tests.benchmarks.accuracy.table import DATA, Row, read_table


@dataclasses.dataclass(frozen=True, kw_only=True)
class SceneAdvice(Recommendation):
    """A `Recommendation` with steps and solver, for a moving scene; ``seconds`` are those of the whole run."""

    integration: Integration | None = None


def advice_for_scene(
    scene: SteadyScene | MovingScene, error: float = 0.01, quantity: str = "load", *, data: pathlib.Path = DATA
) -> Recommendation:
    """The cheapest measured setting that keeps one of the scene's quantities within a relative error.

    Parameters
    ----------
    scene : SteadyScene or MovingScene
        A steady one that has no table of its own is judged as a bearing.
    error : float
    quantity : str
    data : path
        Folder of the tables.
    """
    known = [q.name for q in scene.quantities]
    if quantity not in known:
        raise InputError(f"advice_for_scene: quantity must be one of the scene's, {known}, got {quantity!r}.")
    if isinstance(scene, MovingScene):
        return _for_moving(scene, error, quantity, data)
    return _for_steady(scene, error, quantity, data)


def _for_steady(scene: SteadyScene, error: float, quantity: str, data: pathlib.Path) -> Recommendation:
    known = steady_scene(scene.eccentricity_ratio, scene.tilt_ratio)
    rows = _rows(data, f"{scene.name}_film", quantity) if known == scene else []
    if not rows:
        return recommend(
            scene.bearing,
            error,
            quantity,
            eccentricity_ratio=scene.eccentricity_ratio,
            tilt_ratio=scene.tilt_ratio,
            speed=scene.speed,
        )
    row = cheapest(rows, error)
    if row is None:
        return _none(scene, error, quantity, rows)
    setting = _setting(catalogue.steady_film(scene, quick=False), row.setting)
    return SceneAdvice(
        found=True,
        film=setting.options["film"],
        options=dict(setting.options),
        error=row.error + row.reference_error,
        seconds=row.seconds,
        evidence=(_line(row),),
        reason=f"{row.setting} for {scene.title}: the {quantity} within {error:g}",
    )


def _for_moving(scene: MovingScene, error: float, quantity: str, data: pathlib.Path) -> SceneAdvice:
    make = SCENES.get(scene.name)
    if make is None or make().bearing != scene.bearing:
        reason = f"no evidence: {scene.title} is none of the measured scenes {list(SCENES)}."
        return SceneAdvice(found=False, reason=reason)
    films, steps = (_rows(data, f"{scene.name}_{ladder}", quantity) for ladder in ("film", "integration"))
    if not films or not steps:
        reason = f"no evidence: {scene.title} has no table of films and steps for {quantity}."
        return SceneAdvice(found=False, reason=reason)
    # half of the error for the film, half for the integration
    film, step = cheapest(films, 0.5 * error), cheapest(steps, 0.5 * error)
    if film is None or step is None:
        return _none(scene, 0.5 * error, quantity, films if film is None else steps)
    setting = _setting(catalogue.film_study(scene), film.setting)
    # both runs vary one thing from the same base: times are proportional to cost per step and to steps
    base = next((row for row in steps if row.setting == f"{scene.steps} steps, rho 0.8"), step)
    return SceneAdvice(
        found=True,
        film=setting.options["film"],
        options=dict(setting.options),
        integration=_setting(catalogue.integration_study(scene, runge_kutta=24), step.setting).integration,
        error=film.error + film.reference_error + step.error + step.reference_error,
        seconds=film.seconds * step.seconds / base.seconds,
        evidence=(_line(film), _line(step)),
        reason=f"{film.setting} with {step.setting} for {scene.title}: the {quantity} within {error:g}",
    )


def _rows(data: pathlib.Path, name: str, quantity: str) -> list[Row]:
    path = data / f"{name}.csv"
    rows = read_table(path, Row)[0] if path.exists() else []
    return [row for row in rows if row.quantity == quantity and row.timed]


def _setting(study: Study, label: str) -> Setting:
    return next(s for s in study.settings if s.label == label)


def _line(row: Row) -> str:
    return (
        f"{row.study}, {row.setting}: {100.0 * row.error:.2g} % against {row.reference} (itself good to "
        f"{100.0 * row.reference_error:.2g} %), {format_seconds(row.seconds)}"
    )


def _none(scene: SteadyScene | MovingScene, error: float, quantity: str, rows: Sequence[Row]) -> SceneAdvice:
    least = min((row.error + row.reference_error for row in rows), default=math.inf)
    return SceneAdvice(
        found=False,
        reason=f"{scene.title}: no measured setting keeps the {quantity} within {error:g}; the best gives {least:.2g}.",
    )
