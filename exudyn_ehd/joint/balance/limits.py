"""Loads and temperatures that neither oil nor steel bears, grids too coarse for a film, and what to do about them.

Resolution of a pressure peak by the grid, seen from the film alone. Around, the width of the peak at half its height
decides: with ``columns`` intervals across it the peak pressure of an aligned journal is off by up to
``0.5 / columns^2``, according to where it lies between two columns (measured at L/D 0.25 to 2, minimum film thickness
0.005 to 0.5 of the clearance, from two intervals on).

Along, the film of a tilted journal grows from its end, and the pressure rises by ``int dz / h^3``, most of it where the
film is less than twice as thick as on the end. The film thickness one interval before the end over that on the end,
``narrowing``, decides where the peak lies next to that end:

=========  ===  ===  ====  ====  ====  ====
narrowing  1.5  2.2  3     4.5   7     17
error, %   5    7    25    45    45    65
=========  ===  ===  ====  ====  ====  ====

Largest errors of the peak pressure on 10 intervals of ``stretch=0.75``, of seeded random films of rigid bearings with
SwiftStieber. The peak is too low from 2.2 on. `tests/joint/balance/test_resolution.py` measures who is warned, and what
the named grids are worth. Thrust faces and balls have grids of their own, which nothing here judges; an audit compares
a ball's with finer ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.options import Walls
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.supply.restrictors import Reservoirs
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import SolvedFilm
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import (
    ROUNDING,
    FilmError,
    GridWarning,
    HotFilmWarning,
    OverloadWarning,
    StarvationWarning,
    Status,
    warn_user,
)

# Pressures at the peak and on the projected area, Pa; films of real machines stay below a third of them.
HIGHEST_PEAK, HIGHEST_MEAN = 3e9, 1e9
# Depth in a rigid bore that no contact explains, over the clearance.
DEEPEST = 1.0
PRESSED_THROUGH = "the journal was pressed through its contact by more than the clearance"
# K. Rules of thumb, not properties of an oil: 150 degrees Celsius, from which mineral oils oxidise fast, and what is
# beyond any oil, so that a film of one is a wrong answer.
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
    """Force, N, on the projected area, Pa."""
    return force / (2.0 * bearing.journal_radius * bearing.length)


def warn_of_overload(bearing: JournalBearing, peak: float, force: float, where: str) -> None:
    """Warn in the name of ``where`` of a film with a peak pressure, Pa, or a force, N, that no material bears."""
    mean = mean_pressure(bearing, force)
    # films without a peak have nan
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


def refuse_pressed_through(bearing: JournalBearing, gap: float, where: str) -> None:
    """Refuse in the name of ``where`` a journal so deep in a rigid bore, ``gap`` in m, that no contact explains it."""
    if getattr(bearing, "yielding", None) is None and math.isfinite(gap) and gap < -DEEPEST * bearing.radial_clearance:
        raise FilmError(
            f"{where}: {PRESSED_THROUGH}, minimum film thickness {gap:.3g} m; check load, eccentricity and units, or "
            "give the contact more stiffness (RegularisedWall.pressure)."
        )


def is_above(limit: float, temperature: float | np.ndarray) -> bool:
    """Return whether a film's temperature, K, exceeds a limit anywhere, or is not a number."""
    return not float(np.max(temperature)) <= limit


def hottest(temperature: float | np.ndarray, grid: FilmGrid) -> str:
    """Highest temperature of a film, with its place where it has a field, for messages."""
    if np.ndim(temperature) == 0:
        return f"{float(temperature):.4g} K"
    T = np.asarray(temperature)[:, : grid.z.size]  # without the walls behind it
    i, j = divmod(int(np.argmax(T)), grid.z.size)
    return f"{T[i, j]:.4g} K at theta = {grid.x[i]:.3g} rad, z = {grid.z[j] * grid.reference_length:.4g} m"


def require_oil_bears(temperature: Temperature, grid: FilmGrid, where: str) -> None:
    """Raise `FilmError` in the name of ``where`` for a film in which no oil is a liquid."""
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
    if not isinstance(film, SolvedFilm) or film.temperature is None:
        return ""
    law = film.parts.bearing.lubricant.temperature_law
    if (limits := getattr(law, "limits", None)) is None:
        return ""
    T = film.temperature if film.walls is None else film.walls.across_film(film.temperature)
    low, high = float(np.min(T)), float(np.max(T))
    if limits[0] * (1.0 - ROUNDING) <= low and high <= limits[1] * (1.0 + ROUNDING):
        return ""
    return (
        f"the film's temperatures reach from {low:.4g} to {high:.4g} K, but the oil's {type(law).__name__} from "
        f"{limits[0]:g} to {limits[1]:g} K only; extend the table, or take WaltherTemperature through two points of it."
    )


def warn_of_heat(temperature: Temperature, grid: FilmGrid, where: str) -> bool:
    """Warn in the name of ``where`` of a film that oil does not bear for long; whether it is one."""
    if temperature is None or not is_above(HOT, temperature):
        return False
    warn_user(hot_film(temperature, grid, where), HotFilmWarning)
    return True


def too_hot(T: Temperature, carried: float) -> str:
    """Return the part of a message that explains a load limit by heat; empty if the film has no temperature."""
    if T is None:
        return ""
    most = f" Followed from smaller loads, the film carries at least {carried:.4g} N." if carried else ""
    return (
        f"{most} The film is at {float(np.max(T)):.0f} K there: heat limits the load: beyond the limit the oil "
        "gets thinner by the heat of film and asperities faster than the closing gap makes up for, and the bearing "
        "seizes; a supply of oil or a housing_conductance raises the limit."
    )


def advice(status: Status, bearing: object) -> str:
    """Return the remedy for a failed evaluation of this bearing; `Status.advice` without a special one."""
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
        # rho dh/dt is there, h drho/dt, which would hold the pressure, is not
        return (
            f"{status.advice} With a density_law and {type(closure).__name__}, which keeps no account of the oil, thin "
            "films that are pressed together fast may have no pressure: what oil takes in as it gets denser is left "
            "out; cavitation=ElrodAdams(...) counts it, or take density_law=None."
        )
    return status.advice


def no_film(evaluation: Evaluation, where: str) -> str:
    """Return the message for an evaluation without a steady film; it begins with ``where``."""
    x, y, bx, by = evaluation.motion[:4]
    remedy = advice(evaluation.status, evaluation.model.bearing)
    if isinstance(evaluation, ElasticEvaluation) and evaluation.status is not Status.NO_PRESSURE:
        remedy = _without_a_shape(evaluation)
    return (
        f"{where}: {evaluation.status.name} at x = {x:.4g} m, y = {y:.4g} m, tilt = ({bx:.3g}, {by:.3g}), minimum film "
        f"thickness {evaluation.minimum_gap:.3g} m: {remedy}"
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


# Intervals across the peak around below which, and narrowing from which on, the peak pressure is off by some 5 %; rows
# from an end up to which a peak is that end's.
FEWEST, STEEPEST, NEAR = 3.2, 2.15, 2
# Properties of a wanted grid, whose peak pressure is off by 2 %: intervals across the peak; narrowing less one; stretch
# of the rows, whose end intervals are then 0.235 / n_z of half the length; least number of rows.
ENOUGH, GENTLE, STRETCH, END_INTERVAL, FEWEST_ROWS = 6.0, 0.4, 0.95, 0.235, 48
# Narrowing up to which the film is even along the bearing; from 1.15 on its crest between two rows costs up to 4 %.
EVEN = 1.02
# Width of a peak at half its height over the square root of 2 h / h'', for films thinner than a tenth of the clearance.
PEAK_WIDTH = 1.25
# Sizes from which on a wanted grid takes seconds for one film.
MOST_COLUMNS, MOST_ROWS = 2000, 200


class Resolution(NamedTuple):
    """Resolution of a pressure peak by the grid.

    Attributes
    ----------
    columns, rows : float
        Intervals across the peak at half its height, around and along.
    narrowing : float
        Film thickness one interval before the end next to the peak over that on the end; 1 for a peak away from ends.
    growth : float
        The larger such ratio of both ends, wherever the peak lies.
    wanted : FiniteLength or None
        A grid whose peak pressure is off by 2 %; None where it would be too large, or for another film model.
    """

    columns: float
    rows: float
    narrowing: float
    growth: float
    wanted: FiniteLength | None

    @property
    def is_coarse(self) -> bool:
        """Return whether the peak pressure may be off by more than 5 %."""
        return self.columns < FEWEST or self.narrowing > STEEPEST


def resolution(film: SolvedFilm) -> Resolution:
    """Resolution of the pressure peak of a solved film."""
    lower, upper = film.grid.seals or (None, None)
    rows = slice(int(lower is not None), film.grid.z.size - int(upper is not None))  # none outside of seals
    P, H, z = film.oil.P[:, rows], film.solver.H[:, rows], film.grid.z[rows]
    n, last = P.shape[0], P.shape[1] - 1
    i, j = divmod(int(P.argmax()), last + 1)
    columns = intervals_at_half(np.roll(P[:, j], n // 2 - i), n // 2)
    places = int(H[:, 0].argmin()), int(H[:, last].argmin())
    ends = [
        (float(H[k, row + way] / H[k, row]), k, row, abs(float(z[row + way] - z[row])))
        for k, row, way in ((places[0], 0, 1), (places[1], last, -1))
    ]
    near = [end for end, distance in zip(ends, (j, last - j), strict=True) if distance <= NEAR]
    steepest = max(near, default=(1.0, i, j, 1.0))
    return Resolution(
        columns, intervals_at_half(P[i], j), steepest[0], max(end[0] for end in ends), _wanted(film, columns, *steepest)
    )


def _wanted(
    film: SolvedFilm, across: float, narrowing: float, k: int, row: int, interval: float
) -> FiniteLength | None:
    """Grid that resolves a peak of some intervals across, next to the thinnest film (k, row) of an end."""
    own, ring, (n, _), H = film.parts.bearing.sized_film, film.parts.bearing.columns, film.grid.shape, film.solver.H
    if not isinstance(own, FiniteLength):
        return None
    rows, stretch = own.n_z, own.stretch
    if narrowing > EVEN:
        needed = END_INTERVAL * film.parts.half_length / interval * (narrowing - 1.0) / GENTLE
        rows, stretch = max(rows, FEWEST_ROWS, 2 * math.ceil(0.5 * needed)), STRETCH
        bend = float(H[(k + 1) % n, row] - 2.0 * H[k, row] + H[k - 1, row])
        if bend > 0.0:
            across = min(across, PEAK_WIDTH * math.sqrt(2.0 * H[k, row] / bend))
    columns = max(ring, 8 * math.ceil(ENOUGH * ring / (8.0 * max(across, 1e-3))))
    if columns > MOST_COLUMNS or rows > MOST_ROWS:
        return None
    return FiniteLength(n_theta=columns, n_z=rows, stretch=stretch)


def coarse_film(found: Resolution, where: str) -> str:
    """Return the message for a film whose pressure peak the grid does not resolve; it begins with ``where``."""
    thin = (
        "a grid that resolves a film this thin takes seconds for each evaluation: check the journal's position, or "
        "model how surfaces behave that nearly touch (asperity=, contact=, a bush)"
    )
    grid = found.wanted
    advice = thin if grid is None else f"take film={grid!r}"
    return (
        f"{where}: the grid does not resolve the film's pressure peak, whose pressure may be off by more than 5 %: "
        f"around the bore the peak spans {found.columns:.2g} intervals at half its height (it needs {FEWEST:g}), and "
        f"one interval before the bearing's end the film is {found.narrowing:.2g} times as thick as at the end (up to "
        f"{STEEPEST:g} is resolved); {advice}."
    )


def is_judged(film: SolvedFilm) -> bool:
    """Return whether a film has a grid that a warning can name, and carries more than its contact does."""
    contact = 0.0 if film.pressing is None else np.hypot(*film.pressing.integrals[:, :2].sum(axis=0))
    carried = math.hypot(*film.loads.wrench[:2]) / film.grid.reference_length**2
    return isinstance(film.parts.bearing.film, FiniteLength) and bool(contact <= 0.5 * carried)


def warn_of_grid(film: SolvedFilm, where: str) -> bool:
    """Warn in the name of ``where`` of a film whose peak the grid does not resolve; return whether it is one."""
    if not is_judged(film) or not (found := resolution(film)).is_coarse:
        return False
    warn_user(coarse_film(found, where), GridWarning)
    return True


def intervals_at_half(values: np.ndarray, peak: int) -> float:
    """Intervals between the points on both sides of ``peak`` where ``values`` (n,) fall to half of it, interpolated."""
    half = 0.5 * float(values[peak])
    if not half > 0.0:
        return float(values.size)
    width = 0.0
    for side in (values[peak::-1], values[peak:]):
        below = np.flatnonzero(side < half)
        if below.size == 0:
            width += side.size - 1.0
            continue
        k = int(below[0])
        width += k - float((half - side[k]) / (side[k - 1] - side[k]))
    return width
