"""Audit of a bearing: effects that mattered in its films, omitted ones that would have, and needless ones.

Rows of the flow and of numbers: squeeze, cavities, vortices, turbulence, inertia; grid, time step, ringing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.models import FiniteLength, LongBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.supply.areas import CircumferentialGroove, Hole
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.audit import effects, switches
from exudyn_ehd.joint.audit.case import MATTERS, Case
from exudyn_ehd.joint.audit.findings import Audit, Finding, judged
from exudyn_ehd.joint.audit.resolution import ENOUGH, FEWEST, FINER, STEEPEST, WINDOW, Resolution, watched
from exudyn_ehd.joint.audit.samples import RecordedSteps, recorded_states, squeeze_rate
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.step_error import enough_steps

# Ratio of the intervals across the peak to the needed ones above which a coarser grid is advised. Larger: later.
TOO_FINE = 6.0
# Advised grids: option, number of which sizes are multiples, least size.
SIZES = {"grid around": ("n_theta", 8, 48), "grid along": ("n_z", 2, 6)}


def misalignment(case: Case) -> Finding:
    """Tilt of the journal, which every film but the impedance map includes."""
    is_map = isinstance(case.bearing.film, ImpedanceMap)
    return judged(
        case,
        "misalignment",
        "share of the mid-plane gap lost at an end",
        case.numbers["tilt_loss"].max(),
        not is_map,
        switches.two_dimensional if is_map else None,
        mattering="use film=FiniteLength(...), which follows the tilt.",
    )


def squeeze(case: Case) -> Finding:
    """Share of the squeeze term in the sum of squeeze and wedge terms."""
    is_on = case.bearing.squeeze
    return judged(
        case,
        "squeeze",
        "v / (v + e omega / 2)",
        case.numbers["squeeze_share"].max(),
        is_on,
        None if is_on else switches.squeezing,
        mattering="use squeeze=True: without it the film has no damping.",
    )


def cavitation(case: Case) -> Finding:
    """Cavitated share of the surface, or tension in a film without cavitation."""
    if not np.isinf(case.bearing.cavitation.cavity_pressure):
        return judged(case, "cavitation", *_cavitated(case), True)
    return judged(
        case,
        "cavitation",
        f"share of the {case.surface} below -1e5 Pa",
        case.numbers["tension"].max(),
        False,
        switches.swift_stieber,
        mattering="oil does not carry such tension: cavitation=SwiftStieber().",
    )


def _cavitated(case: Case) -> tuple[str, float]:
    return f"cavitated share of the {case.surface}", case.numbers["cavitated"].max()


def rupture(case: Case) -> Finding | None:
    """Error of the half Sommerfeld rupture, compared with Reynolds' condition; None for other closures."""
    if not case.bearing.cavitation.clips:
        return None
    advice = "the film breaks where its pressure still falls: cavitation=SwiftStieber() keeps the flow there."
    return judged(case, "rupture", *_cavitated(case), False, switches.swift_stieber, mattering=advice)


def mass_conservation(case: Case) -> Finding | None:
    """Effect of conserving the oil of cavities; None for a film without cavitation."""
    closure, effect = case.bearing.cavitation, "mass conservation"
    if np.isinf(closure.cavity_pressure):
        return None
    if closure.conserves_mass:
        needless = f"cavities hardly matter: cavitation=SwiftStieber(cavity_pressure={closure.cavity_pressure:g})."
        return judged(case, effect, *_cavitated(case), True, switches.swift_stieber, needless=needless)
    pressure = switches.cavity_pressure(case.bearing)
    advice = (
        f"cavities keep their oil: cavitation=ElrodAdams(cavity_pressure={pressure:g}), or at the pressure of yours."
    )
    return judged(case, effect, *_cavitated(case), False, switches.mass_conserving, mattering=advice)


def _reynolds(case: Case) -> float:
    """Largest Reynolds number of the Couette flow."""
    b, numbers = case.bearing, case.numbers
    return float((b.lubricant.density * numbers["speed"] * b.radial_clearance / numbers["viscosity"]).max())


def vortices(case: Case) -> Finding:
    """Taylor number."""
    return judged(
        case,
        "Taylor vortices",
        "Re sqrt(c / R)",
        _reynolds(case) * math.sqrt(case.bearing.clearance_ratio),
        None if case.bearing.turbulence is None else True,
        mattering="beyond the laminar film: friction is too low here; see the row on turbulence.",
    )


def turbulence(case: Case) -> Finding:
    """Reynolds number of the Couette flow."""
    is_on = case.bearing.turbulence is not None
    return judged(
        case,
        "turbulence",
        "Re = rho U c / mu",
        _reynolds(case),
        is_on,
        switches.laminar if is_on else switches.turbulent,
        mattering="beyond the laminar film, friction and load are too low here: turbulence=NgPan().",
        needless="the film is laminar: turbulence=None.",
    )


def inertia(case: Case) -> Finding:
    """Reynolds number of the rate at which the flow changes: by the spin in the gap, or by the squeeze."""
    b, r, numbers = case.bearing, case.record, case.numbers
    by_squeeze = numbers["squeeze_rate"]
    if r is not None:
        by_squeeze = np.array(squeeze_rate(case.sources(r.motion), b.radial_clearance, r.time))
    rate = np.maximum(numbers["speed"] / b.journal_radius, by_squeeze)
    return judged(
        case,
        "fluid inertia",
        "rho w c^2 / mu, w of spin or squeeze",
        b.lubricant.density * b.radial_clearance**2 * (rate / numbers["viscosity"]).max(),
        None,
        mattering="the Reynolds equation leaves the fluid's inertia out: take forces as estimates.",
    )


def grid_columns(case: Case) -> Finding | None:
    """Intervals around across the pressure peak; None for an impedance map, whose error is sampled when it is built."""
    worst = min(case.resolutions, key=lambda seen: seen.columns)
    text, across = "intervals across the peak at half its height", worst.columns
    return _grid(case, "grid around", text, across, worst, across)


def grid_rows(case: Case) -> Finding | None:
    """Growth of the film within the last interval along z; None for a long bearing, which has no grid along z."""
    if isinstance(case.bearing.film, LongBearing):
        return None
    worst, text = (
        max(case.resolutions, key=lambda seen: seen.narrowing),
        "growth of the film within an interval of its end",
    )
    across = min(seen.rows for seen in case.resolutions)
    narrows = FINER * (max(seen.growth for seen in case.resolutions) - 1.0) > STEEPEST - 1.0
    return _grid(case, "grid along", text, worst.narrowing, worst, across, narrows)


def _grid(
    case: Case,
    effect: str,
    text: str,
    value: float,
    worst: Resolution,
    across: float,
    narrows: bool = False,
) -> Finding | None:
    """Finding about the intervals ``across`` the peak, of which `FEWEST` are needed.

    Films with twice as many intervals are computed for comparison, unless there are `ENOUGH` of a grid that is not
    coarser than the default, and the film does not narrow too fast.
    """
    film, (name, unit, fewest) = case.bearing.sized_film, SIZES[effect]
    if isinstance(film, ImpedanceMap):
        return None
    size, sizes = getattr(film, name), {"n_theta": film.n_theta, "n_z": film.n_z}
    default = getattr(replace(case.bearing, film=FiniteLength()).sized_film, name)
    is_fine = across > ENOUGH and size >= default and not narrows
    change = None if is_fine else case.change(partial(switches.on_grid, **sizes | {name: 2 * size}))
    found = replace(judged(case, effect, f"{text}, {name} = {size}", value, None), change=change)
    wanted = unit * math.ceil(1.5 * size * FEWEST / (unit * max(across, 0.25)))
    if found.matters or (change is not None and change.found and change.size > MATTERS):
        cause = "film narrows too fast towards its ends" if narrows else "pressure peak is too narrow"
        wanted = max(wanted, unit * math.ceil(1.5 * size / unit))
        grid, remedy = f"{name}={wanted}", partial(switches.on_grid, **sizes | {name: wanted})
        if found.matters and worst.wanted is not None:
            # the grid that `steady` and runs name
            grid, remedy = repr(worst.wanted), partial(replace, film=worst.wanted)
        return replace(found, matters=True, advice=f"the {cause} for the grid: {grid}.", remedy=remedy)
    wanted = max(wanted, fewest)
    if across > TOO_FINE * FEWEST and wanted < size:
        coarser = partial(switches.on_grid, **sizes | {name: wanted})
        # a flexible bore has a constriction narrower than the pressure peak
        loss = None if case.bearing.bush is None else case.change(coarser)
        if loss is None or loss.size <= MATTERS:
            advice = f"finer than the pressure needs: {name}={wanted} would do."
            return replace(found, unneeded=True, advice=advice, remedy=coarser)
    return found


def supply_resolution(case: Case) -> Finding | None:
    """Intervals around on the narrowest supply area, and the change by a grid twice as fine.

    None without such an area: circumferential grooves lie on rows of the grid.
    """
    b, film = case.bearing, case.bearing.film
    areas = [area for area in b.supply if not isinstance(area, CircumferentialGroove)]
    if not areas or not isinstance(film, FiniteLength):
        return None
    widths = [a.diameter / b.journal_radius if isinstance(a, Hole) else a.width_angle for a in areas]
    n_theta, n_z = 2 * b.columns, 2 * film.n_z
    return judged(
        case,
        "supply resolution",
        "intervals around on the narrowest area of supply",
        min(widths) * b.columns / (2.0 * math.pi),
        None,
        partial(switches.on_grid, n_theta=n_theta, n_z=n_z),
        mattering=f"the areas of supply are coarse on this grid: n_theta={n_theta}, n_z={n_z}.",
    )


def time_step(case: Case) -> Finding | None:
    """Estimated error of the gap by the time steps; None for a record without this estimate."""
    record = case.record
    if record is None or not np.any(np.isfinite(record.step_error)):
        return None
    needed = enough_steps(record.time, case.turns(record.motion), record.step_error)
    return judged(
        case,
        "time step",
        "estimated error of the gap / minimum film thickness",
        np.nanmax(record.step_error),
        None,
        mattering=f"the steps are too coarse for the film: take {needed}.",
    )


def ringing(case: Case) -> Finding | None:
    """Forces that alternate from step to step."""
    record, b = case.record, case.bearing
    if record is None:
        return None
    watch = watched(record.time, record.force[:, : case.axes], 2.0 * b.journal_radius * b.length)
    when = "" if watch.most == 0 else f", at {watch.first:.4g} s"
    if watch.first < watch.last:
        when = f", {watch.first:.4g} to {watch.last:.4g} s"
    return judged(
        case,
        "ringing",
        f"times within {WINDOW} steps that the force is thrown into alternation{when}",
        watch.most,
        None,
        mattering="forces and pressures jump from step to step: run by ehd.SolveDynamic, with more steps until none is "
        "halved, or with a smaller spectral radius.",
    )


# Function that returns the finding about one effect; None if the effect does not apply to the case.
AuditRow = Callable[[Case], Finding | None]
ROWS: Mapping[str, AuditRow] = {
    "misalignment": misalignment,
    "elasticity": effects.elasticity,
    "journal elasticity": effects.journal_elasticity,
    "profile": effects.shape,
    "piezoviscosity": effects.piezoviscosity,
    "heating": effects.heating,
    "walls": effects.walls,
    "oil temperature": effects.temperature,
    "shear thinning": effects.shear_thinning,
    "roughness": effects.roughness,
    "contact": effects.contact,
    "wear": effects.wear,
    "squeeze": squeeze,
    "cavitation": cavitation,
    "rupture": rupture,
    "mass conservation": mass_conservation,
    "thrust faces": effects.faces_share,
    "heat of thrust faces": effects.faces_heat,
    "Taylor vortices": vortices,
    "turbulence": turbulence,
    "fluid inertia": inertia,
    "grid around": grid_columns,
    "grid along": grid_rows,
    "supply resolution": supply_resolution,
    "time step": time_step,
    "ringing": ringing,
}


def audit_of(case: Case, rows: Mapping[str, AuditRow] = ROWS) -> Audit:
    """Audit the films of a case."""
    return Audit(findings=tuple(finding for row in rows.values() if (finding := row(case)) is not None))


def audit_record(
    bearing: JournalBearing, record: RecordedSteps, *, liner: ElasticLiner | None = None, measure_time: bool = False
) -> Audit:
    """Audit a bearing by the worst states of a record; arguments as for `Case`.

    Films with a memory are evaluated again over recorded steps before such a state: at least 60, if there are as many.
    """
    # without the faces, which exclude options that an audit may try in the journal's film
    model = build_study_model(replace(bearing, thrust=None), 0.0)
    states = recorded_states(model, record)
    return audit_of(Case(model, states, record, liner=liner, faces=bearing.thrust, measure_time=measure_time))
