"""Indicators of an audit: one function per effect that a bearing can have, from the worst films to a finding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.audit import assumptions, oil, surfaces
from exudyn_ehd.joint.audit.findings import Case, Finding, finding, judged
from exudyn_ehd.joint.audit.samples import time_mean
from exudyn_ehd.joint.audit.switches import (
    TYPICAL_TEMPERATURE_COEFFICIENT,
    cavity_pressure,
    isoviscous,
    mass_conserving,
    newtonian,
    rigid,
    rigid_journal,
    smooth,
    swift_stieber,
    two_dimensional,
    untouching,
    unworn,
)


def faces_share(case: Case) -> Finding | None:
    """Share of the faces in the joint's loss; None without a record of them."""
    record = case.record
    if record is None or case.faces is None:
        return None
    faces, film = (time_mean(record.time, loss) for loss in (record.thrust_power_loss, np.abs(record.power_loss)))
    value = faces / (faces + film) if faces + film > 0.0 else 0.0
    return finding("thrust faces", "share of the faces in the loss", value, True)


def faces_heat(case: Case) -> Finding | None:
    """Change of the viscosity by the faces' own heat, in the oil that they carry around."""
    record, faces, oil = case.record, case.faces, case.bearing.lubricant
    if record is None or faces is None:
        return None
    films = faces.lower + faces.upper
    carried = 0.25 * films * faces.clearance * (faces.outer_radius**2 - faces.inner_radius**2)
    flow = carried * time_mean(record.time, np.abs(record.motion[:, 8]))
    loss = time_mean(record.time, record.thrust_power_loss)
    rise = loss / (oil.density * oil.specific_heat * flow) if flow > 0.0 else 0.0
    return finding(
        "heat of thrust faces",
        f"{TYPICAL_TEMPERATURE_COEFFICIENT:.3g} 1/K x rise of {rise:.3g} K in a turn",
        TYPICAL_TEMPERATURE_COEFFICIENT * rise,
        None,
        mattering="films on faces are isothermal here: give the lubricant the viscosity at their temperature.",
    )


@dataclass(frozen=True)
class Indicator:
    """One effect: its finding, and the bearing without it (None where nothing can be left out)."""

    find: Callable[[Case], Finding | None]
    without: Callable[[JournalBearing], JournalBearing] | None = None


def misalignment(case: Case) -> Finding:
    """Tilt of the journal, which every film but the impedance map includes."""
    return finding(
        "misalignment",
        "share of the mid-plane gap lost at an end",
        case.largest("tilt_loss"),
        not isinstance(case.bearing.film, ImpedanceMap),
        mattering="use film=FiniteLength(...), which follows the tilt.",
        switch=two_dimensional,
    )


def squeeze(case: Case) -> Finding:
    """Squeeze against wedge."""
    return finding(
        "squeeze",
        "v / (v + e omega / 2)",
        case.largest("squeeze_share"),
        case.bearing.squeeze,
        mattering="use squeeze=True: without it the film has no damping.",
        switch=partial(replace, squeeze=True),
    )


def cavitation(case: Case) -> Finding:
    """Cavitated share of the bore, or tension in a film that never breaks."""
    if np.isinf(case.bearing.cavitation.cavity_pressure):
        return finding(
            "cavitation",
            f"share of the {case.films.surface} below -1e5 Pa",
            case.largest("tension"),
            False,
            mattering="oil does not carry such tension: cavitation=SwiftStieber().",
            switch=swift_stieber,
        )
    return finding("cavitation", _cavitated(case), case.largest("cavitated"), True)


def _cavitated(case: Case) -> str:
    return f"cavitated share of the {case.films.surface}"


def rupture(case: Case) -> Finding | None:
    """Half Sommerfeld's rupture against Reynolds' condition."""
    if not case.bearing.cavitation.clips:
        return None
    return judged(
        case,
        "rupture",
        _cavitated(case),
        case.largest("cavitated"),
        False,
        swift_stieber,
        mattering="the film breaks where its pressure still falls: cavitation=SwiftStieber() keeps the flow there.",
    )


def mass_conservation(case: Case) -> Finding | None:
    """Oil content and pressure of cavities: against a film whose cavities keep their oil."""
    closure = case.bearing.cavitation
    if np.isinf(closure.cavity_pressure):
        return None
    indicator, value = _cavitated(case), case.largest("cavitated")
    if closure.conserves_mass:
        needless = f"cavities hardly matter: cavitation=SwiftStieber(cavity_pressure={closure.cavity_pressure:g})."
        return judged(case, "mass conservation", indicator, value, True, swift_stieber, needless=needless)
    pressure = cavity_pressure(case.bearing)
    keeping = (
        f"cavities keep their oil: cavitation=ElrodAdams(cavity_pressure={pressure:g}), or at the pressure of yours."
    )
    return judged(case, "mass conservation", indicator, value, False, mass_conserving, mattering=keeping)


INDICATORS = (
    Indicator(misalignment),
    Indicator(surfaces.elasticity, rigid),
    Indicator(surfaces.journal_elasticity, rigid_journal),
    Indicator(surfaces.shape, partial(replace, profile=None)),
    Indicator(oil.piezoviscosity, isoviscous),
    Indicator(oil.heating, partial(replace, thermal=None)),
    Indicator(oil.walls),
    Indicator(oil.temperature),
    Indicator(oil.shear_thinning, newtonian),
    Indicator(surfaces.roughness, smooth),
    Indicator(surfaces.contact, untouching),
    Indicator(surfaces.wear, unworn),
    Indicator(squeeze),
    Indicator(cavitation),
    Indicator(rupture),
    Indicator(mass_conservation, swift_stieber),
    Indicator(faces_share),
    Indicator(faces_heat),
    Indicator(assumptions.vortices),
    Indicator(assumptions.turbulence, partial(replace, turbulence=None)),
    Indicator(assumptions.inertia),
    Indicator(assumptions.grid_columns),
    Indicator(assumptions.grid_rows),
    Indicator(assumptions.supply_resolution),
    Indicator(assumptions.time_step),
    Indicator(assumptions.ringing),
)
