"""Indicators of the flow and of numbers: vortices, turbulence, inertia, grid, time step, and its ringing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from exudyn_ehd.film.models import FiniteLength, LongBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.supply.areas import CircumferentialGroove, Hole
from exudyn_ehd.joint.audit.changes import MATTERS
from exudyn_ehd.joint.audit.findings import LIMITS, Case, Finding, finding, judged
from exudyn_ehd.joint.audit.ringing import WINDOW, watched
from exudyn_ehd.joint.audit.switches import laminar, on_film, refined, turbulent
from exudyn_ehd.joint.step_error import enough_steps

# Grids this many times finer than needed cost time for nothing.
TOO_FINE = 6.0
# Grids that are so much finer than needed, and not coarser than the default, are not compared with finer ones.
SURELY_FINE = 2.0
# Intervals along z across a peak that its load needs: 1 % of it.
ROWS = 3.0
# Film thicknesses across the last interval along z: the pressure there rises by int dz / h^3, which the vertices at
# its ends know to 2 % of the film thickness on the end up to here.
NARROWS = 1.6
INERTIA = "rho w c^2 / mu, w of spin or squeeze"


def reynolds(case: Case) -> float:
    """Largest Reynolds number of the Couette flow."""
    b = case.bearing
    return max(b.lubricant.density * s.speed * b.radial_clearance / s.viscosity for s in case.samples)


def vortices(case: Case) -> Finding:
    """Taylor number."""
    value = reynolds(case) * math.sqrt(case.bearing.clearance_ratio)
    return finding(
        "Taylor vortices",
        "Re sqrt(c / R)",
        value,
        None if case.bearing.turbulence is None else True,
        mattering="beyond the laminar film: friction is too low here; see the row on turbulence.",
    )


def turbulence(case: Case) -> Finding:
    """Reynolds number of the Couette flow."""
    on = case.bearing.turbulence is not None
    return judged(
        case,
        "turbulence",
        "Re = rho U c / mu",
        reynolds(case),
        on,
        laminar if on else turbulent,
        mattering="beyond the laminar film, friction and load are too low here: turbulence=NgPan().",
        needless="the film is laminar: turbulence=None.",
    )


def inertia(case: Case) -> Finding:
    """Reynolds number of the rate at which the flow changes: by the spin in the gap, or by the squeeze."""
    b, r, samples = case.bearing, case.record, case.samples
    run = None if r is None else case.films.squeeze_rate(r.motion, r.time)
    rates = [max(s.speed / b.journal_radius, s.squeeze_rate if run is None else run) for s in samples]
    oscillating = max(rate / s.viscosity for rate, s in zip(rates, samples, strict=True))
    return finding(
        "fluid inertia",
        INERTIA,
        b.lubricant.density * b.radial_clearance**2 * oscillating,
        None,
        mattering="the Reynolds equation leaves the fluid's inertia out: take forces as estimates.",
    )


def _grid(case: Case, name: str, effect: str) -> Finding | None:
    film, along = case.bearing.sized_film, name == "n_z"
    if isinstance(film, ImpedanceMap):
        return None
    limit, size, peaks = LIMITS[effect], getattr(film, name), [s.resolution for s in case.samples]
    if along:
        worst = max(peaks, key=lambda peak: peak.narrowing)
        value, indicator = (
            worst.narrowing,
            f"growth of the film within an interval of its end, n_z = {size}",
        )
        across, needed = min(peak.rows for peak in peaks), ROWS
        narrows = max(peak.growth for peak in peaks) > NARROWS
    else:
        worst = min(peaks, key=lambda peak: peak.columns)
        value, indicator = worst.columns, f"intervals across the peak at half its height, n_theta = {size}"
        across, needed, narrows = value, limit.value, False
    sizes = {"n_theta": film.n_theta, "n_z": film.n_z}
    default = replace(case.bearing, film=FiniteLength()).sized_film
    plain = not narrows and across > SURELY_FINE * needed and size >= getattr(default, name)
    change = None if plain else case.films.change(refined(**sizes | {name: 2 * size}))
    found = replace(finding(effect, indicator, value, None), change=change)
    coarse = found.matters
    if change is not None and change.found and change.size > MATTERS:
        found = replace(found, matters=True)
    unit = 8 if name == "n_theta" else 2
    wanted = unit * math.ceil(1.5 * size * needed / (unit * max(across, 0.25)))
    if found.matters:
        wanted = max(wanted, unit * math.ceil(1.5 * size / unit))
        cause = "film narrows too fast towards its ends" if narrows else "pressure peak is too narrow"
        if coarse and worst.wanted is not None:
            # the grid that `steady` and runs name
            return replace(found, advice=f"the {cause} for the grid: {worst.wanted!r}.", remedy=on_film(worst.wanted))
        advice = f"the {cause} for the grid: {name}={wanted}."
        return replace(found, advice=advice, remedy=refined(**sizes | {name: wanted}))
    wanted = max(wanted, 48 if name == "n_theta" else 6)
    if across > TOO_FINE * needed and wanted < size:
        coarser = refined(**sizes | {name: wanted})
        # a flexible bore constricts its film within less than the pressure's peak
        loss = None if case.bearing.bush is None else case.films.change(coarser)
        if loss is None or loss.size <= MATTERS:
            advice = f"finer than the pressure needs: {name}={wanted} would do."
            return replace(found, unneeded=True, advice=advice, remedy=coarser)
    return found


def grid_columns(case: Case) -> Finding | None:
    """Columns across the pressure peak; an impedance map has its error sampled when it is built."""
    return _grid(case, "n_theta", "grid around")


def grid_rows(case: Case) -> Finding | None:
    """Rows next to the end where the pressure peaks; the slices of a long bearing are no grid."""
    if isinstance(case.bearing.film, LongBearing):
        return None
    return _grid(case, "n_z", "grid along")


def supply_resolution(case: Case) -> Finding | None:
    """Intervals on the narrowest area of supply, and what twice as many change; circumferential grooves have rows."""
    b, film = case.bearing, case.bearing.film
    areas = [area for area in b.supply if not isinstance(area, CircumferentialGroove)]
    if not areas or not isinstance(film, FiniteLength):
        return None
    widths = [a.diameter / b.journal_radius if isinstance(a, Hole) else a.width_angle for a in areas]
    n_theta, n_z = 2 * b.columns, 2 * film.n_z
    return finding(
        "supply resolution",
        "intervals around on the narrowest area of supply",
        min(widths) * b.columns / (2.0 * math.pi),
        None,
        mattering=f"the areas of supply are coarse on this grid: n_theta={n_theta}, n_z={n_z}.",
        change=case.films.change(refined(n_theta, n_z)),
        switch=refined(n_theta, n_z),
    )


def time_step(case: Case) -> Finding | None:
    """Estimated error of the steps against the gap; None for a record that does not know it."""
    record = case.record
    if record is None or not np.any(np.isfinite(record.step_error)):
        return None
    needed = enough_steps(record.time, case.films.spin(record.motion), record.step_error)
    return finding(
        "time step",
        "estimated error of the gap / minimum film thickness",
        float(np.nanmax(record.step_error)),
        None,
        mattering=f"the steps are too coarse for the film: take {needed}.",
    )


def ringing(case: Case) -> Finding | None:
    """Forces that alternate from step to step."""
    record, b = case.record, case.bearing
    if record is None:
        return None
    watch = watched(record.time, record.force[:, : case.films.axes], 2.0 * b.journal_radius * b.length)
    when = (
        ""
        if watch.most == 0
        else f", at {watch.first:.4g} s"
        if watch.first == watch.last
        else f", {watch.first:.4g} to {watch.last:.4g} s"
    )
    return finding(
        "ringing",
        f"times within {WINDOW} steps that the force is thrown into alternation{when}",
        float(watch.most),
        None,
        mattering="forces and pressures jump from step to step: run by ehd.SolveDynamic, with more steps until none is "
        "halved, or with a smaller spectral radius.",
    )
