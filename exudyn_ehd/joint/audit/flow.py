"""Rows of the flow: misalignment, squeeze, cavitation, vortices, turbulence, inertia."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import Finding, judged
from exudyn_ehd.joint.audit.samples import squeeze_rate
from exudyn_ehd.joint.audit.switches import (
    cavity_pressure,
    laminar,
    mass_conserving,
    squeezing,
    swift_stieber,
    turbulent,
    two_dimensional,
)


def misalignment(case: Case) -> Finding:
    """Tilt of the journal, which every film but the impedance map includes."""
    is_map = isinstance(case.bearing.film, ImpedanceMap)
    return judged(
        case,
        "misalignment",
        "share of the mid-plane gap lost at an end",
        case.numbers["tilt_loss"].max(),
        not is_map,
        two_dimensional if is_map else None,
        mattering="use film=FiniteLength(...), which follows the tilt.",
    )


def squeeze(case: Case) -> Finding:
    """Squeeze against wedge."""
    is_on = case.bearing.squeeze
    return judged(
        case,
        "squeeze",
        "v / (v + e omega / 2)",
        case.numbers["squeeze_share"].max(),
        is_on,
        None if is_on else squeezing,
        mattering="use squeeze=True: without it the film has no damping.",
    )


def cavitation(case: Case) -> Finding:
    """Cavitated share of the surface, or tension in a film that never breaks."""
    if not np.isinf(case.bearing.cavitation.cavity_pressure):
        return judged(case, "cavitation", *_cavitated(case), True)
    return judged(
        case,
        "cavitation",
        f"share of the {case.surface} below -1e5 Pa",
        case.numbers["tension"].max(),
        False,
        swift_stieber,
        mattering="oil does not carry such tension: cavitation=SwiftStieber().",
    )


def _cavitated(case: Case) -> tuple[str, float]:
    return f"cavitated share of the {case.surface}", case.numbers["cavitated"].max()


def rupture(case: Case) -> Finding | None:
    """Half Sommerfeld's rupture against Reynolds' condition."""
    if not case.bearing.cavitation.clips:
        return None
    advice = "the film breaks where its pressure still falls: cavitation=SwiftStieber() keeps the flow there."
    return judged(case, "rupture", *_cavitated(case), False, swift_stieber, mattering=advice)


def mass_conservation(case: Case) -> Finding | None:
    """Oil content and pressure of cavities: against a film whose cavities keep their oil."""
    closure, effect = case.bearing.cavitation, "mass conservation"
    if np.isinf(closure.cavity_pressure):
        return None
    if closure.conserves_mass:
        needless = f"cavities hardly matter: cavitation=SwiftStieber(cavity_pressure={closure.cavity_pressure:g})."
        return judged(case, effect, *_cavitated(case), True, swift_stieber, needless=needless)
    pressure = cavity_pressure(case.bearing)
    advice = (
        f"cavities keep their oil: cavitation=ElrodAdams(cavity_pressure={pressure:g}), or at the pressure of yours."
    )
    return judged(case, effect, *_cavitated(case), False, mass_conserving, mattering=advice)


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
        laminar if is_on else turbulent,
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
