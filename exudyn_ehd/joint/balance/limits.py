"""Loads and temperatures that neither oil nor steel bears, and what to do about them."""

from __future__ import annotations

from typing import cast

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.options import Walls
from exudyn_ehd.film.supply.restrictors import Reservoirs
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import SolvedFilm
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import SMALL, FilmError, HotFilmWarning, OverloadWarning, StarvationWarning, Status, warn_user

# Peak pressure and mean pressure on the projected area, Pa, above which a run or study warns of a wrong model. Films of
# real machines stay below a third of them.
HIGHEST_PEAK, HIGHEST_MEAN = 3e9, 1e9
PRESSED_THROUGH = "the journal was pressed through its contact by more than the clearance"
# Temperatures in K, rules of thumb and not properties of an oil. Above HOT, 150 degrees Celsius, mineral oils oxidise
# fast: a warning. Above HOTTEST no oil is a liquid, so that the film is wrong: an error.
HOT, HOTTEST = 423.15, 700.0
COOLER = (
    "let more oil flow through (end pressures, supply, clearance), give the thermal effect heat transfer to the "
    "surfaces (housing_conductance, bush_coefficient, journal_coefficient), or take a thinner oil, less load or speed."
)
NO_OIL = f"and no oil is a liquid above {HOTTEST:g} K: the bearing seizes; {COOLER}"
ROOM = (
    "give the journal's heat a way out (Conduction.conductance, more oil), let it warm up slowly, or take a larger "
    "radial_clearance."
)
WAY_OUT = (
    "let oil flow through (end pressures, eccentricity, supply) or give the thermal effect heat transfer to the "
    "surfaces (housing_conductance, bush_coefficient, journal_coefficient)."
)
Temperature = float | np.ndarray | None


def mean_pressure(bearing: JournalBearing, force: float) -> float:
    """Mean pressure of a force, N, on the projected area, Pa."""
    return force / (2.0 * bearing.journal_radius * bearing.length)


def warn_of_overload(bearing: JournalBearing, gap: float, peak: float, force: float, where: str) -> None:
    """Warn in the name of ``where`` of a film with a peak pressure, Pa, or a force, N, that no material bears.

    Raise `FilmError` if the gap, m, is below minus the clearance in a rigid bore: no contact explains such a depth.
    """
    if getattr(bearing, "yielding", None) is None and gap < -bearing.radial_clearance:
        raise FilmError(
            f"{where}: {PRESSED_THROUGH}, minimum film thickness {gap:.3g} m; check load, eccentricity and units, or "
            "give the contact more stiffness (RegularisedWall.pressure)."
        )
    mean = mean_pressure(bearing, force)
    # a film model without peak pressure reports nan, for which the comparison is False
    if not peak > HIGHEST_PEAK and not mean > HIGHEST_MEAN:
        return
    warn_user(
        f"{where}: the film has a peak pressure of {peak:.3g} Pa, and with its contact {mean:.3g} Pa on the projected "
        f"area; neither oil nor steel bears {HIGHEST_PEAK:.3g} or {HIGHEST_MEAN:.3g} Pa there: surfaces this close "
        "touch or give way; look at the units of viscosity, speed and clearance, take a smaller eccentricity or load, "
        "or give the bearing a contact (GreenwoodTripp, RegularisedWall) or a bush that deflects.",
        OverloadWarning,
    )


def warn_of_starved(bearing: JournalBearing, reservoirs: Reservoirs | None, where: str) -> None:
    """Warn in the name of ``where`` of a supply area that its restrictor does not fill."""
    if reservoirs is None or reservoirs.live.all():
        return
    fed = [k for k, area in enumerate(bearing.supply) if area.supply is not None]
    k = fed[int(np.argmin(reservoirs.live))]
    warn_user(
        f"{where}: the film takes more oil from JournalBearing.supply[{k}] than comes through its restrictor: the area "
        f"has the cavity pressure, {reservoirs.pressures.min():.4g} Pa, and is not full; take a larger restrictor or "
        "more supply_pressure, or move the area to where the film presses.",
        StarvationWarning,
    )


def is_above(limit: float, temperature: float | np.ndarray) -> bool:
    """Return whether a film's temperature, K, exceeds a limit anywhere, or is not a number."""
    return not float(np.max(temperature)) <= limit


def hottest(temperature: float | np.ndarray, grid: FilmGrid) -> str:
    """Highest temperature of a film, with its place where it has a field, for messages."""
    if np.ndim(temperature) == 0:
        return f"{float(temperature):.4g} K"
    T = np.asarray(temperature)[:, : grid.z.size]  # without the walls behind it
    i, j = divmod(int(np.argmax(T.round(6))), grid.z.size)  # of equal ones the first, whatever the round-off
    return f"{T[i, j]:.4g} K at theta = {grid.x[i]:.3g} rad, z = {grid.z[j] * grid.reference_length:.4g} m"


def require_oil_bears(temperature: Temperature, grid: FilmGrid, where: str) -> None:
    """Raise `FilmError` in the name of ``where`` for a film that is hotter than `HOTTEST` anywhere."""
    if temperature is not None and is_above(HOTTEST, temperature):
        raise FilmError(f"{where}: the film is at {hottest(temperature, grid)}, {NO_OIL}")


def hot_film(temperature: float | np.ndarray, grid: FilmGrid, where: str) -> str:
    """Return the message for a film that is too hot for oil in the long run."""
    return (
        f"{where}: the film is at {hottest(temperature, grid)}, and mineral oils do not bear {HOT:g} K for long; "
        f"{COOLER}"
    )


def seized(walls: Walls | None) -> str:
    """Return the message for walls that have grown by the whole clearance; empty if they have not."""
    if walls is None or walls.clearance > 0.0:
        return ""
    return (
        f"the bearing seizes: bush and journal have grown by more than the radial clearance, of which "
        f"{walls.clearance:.3g} m are left; {ROOM}"
    )


def outside_table(film: object) -> str:
    """Return the message for a film with temperatures outside the limits of the oil's law; empty for any other film."""
    if (T := getattr(film, "temperature", None)) is None:
        return ""
    film = cast(SolvedFilm, film)
    law = film.parts.bearing.lubricant.temperature_law
    if (limits := getattr(law, "limits", None)) is None:
        return ""
    T = T if film.walls is None else film.walls.across_film(T)
    low, high = float(np.min(T)), float(np.max(T))
    if limits[0] - SMALL <= low and high <= limits[1] + SMALL:
        return ""
    return (
        f"the film's temperatures reach from {low:.4g} to {high:.4g} K, but the oil's {type(law).__name__} from "
        f"{limits[0]:g} to {limits[1]:g} K only; extend the table, or take WaltherTemperature through two points of it."
    )


def require_bearable(film: SolvedFilm, where: str) -> None:
    """Raise `FilmError` for a film too hot for any oil or outside the oil's table, or without a clearance by growth."""
    require_oil_bears(film.temperature, film.grid, where)
    if message := seized(film.walls) or outside_table(film):
        raise FilmError(f"{where}: {message}")


def warn_of_heat(temperature: Temperature, grid: FilmGrid, where: str) -> bool:
    """Warn in the name of ``where`` of a film hotter than `HOT`; return whether it is."""
    if temperature is None or not is_above(HOT, temperature):
        return False
    warn_user(hot_film(temperature, grid, where), HotFilmWarning)
    return True


def too_hot(T: Temperature, carried: float) -> str:
    """Return the part of a message that explains a load limit by heat.

    ``carried``: largest load, N, that was reached by continuation from smaller loads; 0 without one. The part is empty
    if ``carried`` is 0 and the film is no hotter than `HOT`.
    """
    if T is None or not (carried or is_above(HOT, T)):
        return ""
    most = f" Followed from smaller loads, the film carries at least {carried:.4g} N." if carried else ""
    return (
        f"{most} The film is at {float(np.max(T)):.0f} K there: heat limits the load: beyond the limit the oil "
        "gets thinner by the heat of film and asperities faster than the closing gap makes up for, and the bearing "
        "seizes; a supply of oil or a housing_conductance raises the limit."
    )


def advice(status: Status, bearing: object) -> str:
    """Return the remedy for a failed evaluation of a bearing; `Status.advice` if no special remedy exists."""
    if status is Status.NO_FILM and isinstance(getattr(bearing, "bush", None), ElasticLiner):
        return (
            "the gap closed somewhere, most likely at an end, where an ElasticLiner carries no pressure and does not "
            "deflect: name contact=RegularisedWall(onset=...) or asperity=GreenwoodTripp(...), which press on the "
            "liner too, or reduce the load or the step size."
        )
    thermal = getattr(bearing, "thermal", None)
    grows = any(getattr(getattr(thermal, side, None), "expansion", 0.0) > 0.0 for side in ("bush", "journal"))
    if status is Status.NO_FILM and grows:
        return (
            "the gap closed somewhere, and the growth of bush and journal takes part in it: where the journal outgrows "
            f"the clearance the bearing seizes; {ROOM} {status.advice}"
        )
    law = getattr(getattr(bearing, "lubricant", None), "pressure_law", None)
    if status is Status.NO_PRESSURE and law is not None:
        return (
            f"the pressure runs away: with {type(law).__name__} no finite pressure carries a film that is pressed "
            "together as fast as here, and between rigid surfaces none carries a mean pressure (force / diameter / "
            f"length) far above 1 / coefficient = {1e-6 / law.coefficient:.3g} MPa, thin films a fifth of it; name an "
            "elastic liner or bush, which spreads the load, reduce loads and speeds of approach (initial velocities), "
            "or check the law's coefficient."
        )
    oil, closure = getattr(bearing, "lubricant", None), getattr(bearing, "cavitation", None)
    if (
        status is Status.NOT_CONVERGED
        and getattr(oil, "density_law", None)
        and not getattr(closure, "conserves_mass", True)
    ):
        # the closure includes rho dh/dt but not h drho/dt, which would limit the pressure
        return (
            f"{status.advice} With a density_law and {type(closure).__name__}, which keeps no account of the oil, thin "
            "films that are pressed together fast may have no pressure: what oil takes in as it gets denser is left "
            "out; cavitation=ElrodAdams(...) counts it, or take density_law=None."
        )
    return status.advice


def no_film(evaluation: Evaluation, where: str) -> str:
    """Return the message for an evaluation without a steady film; it begins with ``where``."""
    remedy = advice(evaluation.status, evaluation.model.bearing)
    if isinstance(evaluation, ElasticEvaluation) and evaluation.status is not Status.NO_PRESSURE:
        remedy = _without_a_shape(evaluation)
    return (
        f"{where}: {evaluation.status.name} at {evaluation.place}, minimum film thickness "
        f"{evaluation.minimum_gap:.3g} m: {remedy}"
    )


def _without_a_shape(evaluation: ElasticEvaluation) -> str:
    """Return the reason why no shape of a flexible bore has a film, and the remedy."""
    bearing, last = evaluation.model.bearing, evaluation.closing
    kind = type(bearing.yielding).__name__
    if evaluation.model.elasticity.failure:
        return f"{kind}: {evaluation.model.elasticity.failure}"
    surface = "surface" if bearing.bush is None else "bore"
    missing = f"no shape of the {kind}'s {surface} was found in balance with a film"
    if last is None or last.gap > SMALLEST_GAP_SHARE * bearing.radial_clearance or evaluation.model.effects.contacts:
        return (
            f"{missing}, neither by Newton's method nor by a slow deformation from the undeformed shape; thicken "
            "what is thin in it, name a contact=RegularisedWall(...) if the surfaces touch, or refine the "
            "film's grid."
        )
    return (
        f"{missing}. On the way there, at {last.part:.3g} of eccentricity and tilt, the film closes at theta = "
        f"{last.theta:.3g} rad, z = {last.z:.4g} m (minimum film thickness {last.gap:.2g} m): the surfaces touch; at "
        "an end of the bearing, where no pressure opens the gap, they do so first. Name contact=RegularisedWall(...) "
        "or asperity=GreenwoodTripp(...), refine the film's grid, or move the journal back."
    )


def lacks_oil(bearing: JournalBearing) -> bool:
    """Return whether the film conserves mass and has no source of oil, unless the journal slides axially."""
    closure = bearing.cavitation
    return closure.conserves_mass and not is_fed(bearing, closure.cavity_pressure)


def is_fed(bearing: JournalBearing, cavity_pressure: float) -> bool:
    """Return whether ends, supply areas or an open inlet feed oil into cavities of this pressure, Pa."""
    supplied = bool(bearing.supply) or isinstance(bearing.inlet, MaximumGap) or bool(bearing.bore_arcs)
    return supplied or max(bearing.end_pressures) > cavity_pressure
