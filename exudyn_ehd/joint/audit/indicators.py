"""Indicators of an audit: one function per effect that a bearing can have, from the worst films to a finding."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.closures import FullSommerfeld
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.audit import assumptions
from exudyn_ehd.joint.audit.findings import LIMITS, Case, Finding, Limit, finding
from exudyn_ehd.joint.audit.samples import Sample
from exudyn_ehd.joint.audit.switches import (
    STEEL,
    TYPICAL_PRESSURE_COEFFICIENT,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
    Switch,
    cavity_pressure,
    coarse_ring,
    heated,
    isothermal,
    isoviscous,
    mass_conserving,
    newtonian,
    piezoviscous,
    rigid,
    rough,
    roughness_height,
    smooth,
    steel_ring,
    swift_stieber,
    thinning,
    touching,
    two_dimensional,
    untouching,
    unworn,
    warmer,
)

# Values beyond which an effect is plainly nothing, so that no other film is solved for it.
PLAINLY_NOTHING = {
    "elasticity": 0.01,
    "profile": 0.01,
    "piezoviscosity": 0.01,
    "heating": 0.01,
    "shear thinning": 0.2,
    "roughness": 10.0,
    "contact": 6.0,
    "mass conservation": 1e-3,
}
# From here on the bore is plainly elastic; the search for its film at such loads is long.
PLAINLY_ELASTIC = 5.0
# Radial deflection of a steel ring under the peak pressure, over R p / E; half of it under a uniform one.
RING_COMPLIANCE = 0.7


@dataclass(frozen=True)
class Indicator:
    """One effect: its finding, and the bearing without it (None where nothing can be left out)."""

    find: Callable[[Case], Finding | None]
    without: Callable[[JournalBearing], JournalBearing] | None = None


def _judged(
    case: Case,
    effect: str,
    indicator: str,
    value: float,
    on: bool | None,
    switch: Switch,
    *,
    probe: Switch | None = None,
    limit: Limit | None = None,
    mattering: str = "",
    needless: str | None = None,
) -> Finding:
    """A finding by the change that ``switch`` makes (seen by ``probe``), unless its value says enough."""
    limit = LIMITS[effect] if limit is None else limit
    nothing = PLAINLY_NOTHING.get(effect, 0.0)
    plain = value > nothing if limit.below else value < nothing
    plain = plain or (effect == "elasticity" and value > PLAINLY_ELASTIC)
    return finding(
        effect,
        indicator,
        value,
        on,
        limit=limit,
        mattering=mattering,
        needless=needless,
        change=None if plain else case.films.change(switch if probe is None else probe),
        switch=switch,
    )


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


def elasticity(case: Case) -> Finding:
    """Deflection of the bore: as it is, of a liner that is only asked about, or of a steel ring."""
    b, liner = case.bearing, case.liner

    def gap(s: Sample) -> float:
        # surfaces that touch count as a thousandth of the clearance apart
        return max(s.minimum_gap, 1e-3 * b.radial_clearance)

    if b.bush is not None:
        value = max(s.deflection / gap(s) for s in case.samples)
        return _judged(
            case,
            "elasticity",
            "deflection / minimum film thickness",
            value,
            True,
            rigid,
            needless="the bush is stiff enough to be rigid: bush=None.",
        )
    ring = RING_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"]
    compliance = ring if liner is None else liner.compliance
    return _judged(
        case,
        "elasticity",
        f"deflection of {'a steel ring' if liner is None else 'the liner'} / minimum film thickness",
        max(compliance * s.peak_pressure / gap(s) for s in case.samples),
        False,
        steel_ring if liner is None else lambda bearing: replace(bearing, bush=liner),
        probe=coarse_ring if liner is None else None,
        mattering="even steel gives way: give the bearing bush=ModalBush(...) of its housing."
        if liner is None
        else "give the bearing bush=ElasticLiner(...), or a bush with a mesh.",
    )


def shape(case: Case) -> Finding | None:
    """Profile of the surfaces and worn depth."""
    if not case.bearing.profiles:
        return None
    value = max(s.shape / s.minimum_gap for s in case.samples)
    return _judged(
        case,
        "profile",
        "profile height / minimum film thickness",
        value,
        True,
        lambda bearing: replace(bearing, profile=None),
        needless="the film is much thicker than the profile: profile=None.",
    )


def piezoviscosity(case: Case) -> Finding:
    """Viscosity under pressure."""
    law = case.bearing.lubricant.pressure_law
    alpha = TYPICAL_PRESSURE_COEFFICIENT if law is None else law.coefficient
    return _judged(
        case,
        "piezoviscosity",
        f"alpha p_max, alpha = {alpha:g} 1/Pa",
        alpha * case.largest("peak_pressure"),
        law is not None,
        piezoviscous if law is None else isoviscous,
        mattering="give the lubricant pressure_law=RoelandsPressure(coefficient=...).",
        needless="pressures are low: pressure_law=None.",
    )


def temperature_rise(case: Case) -> float:
    """Adiabatic rise P / (rho c_p Q), K, averaged over a record.

    Without flow through the bearing, that of one turn's Couette flow.
    """
    b, r = case.bearing, case.record
    pairs = [(s.power_loss, s.flow, s.speed) for s in case.samples]
    if r is not None and np.all(np.isfinite(r.leakage)):
        speed = float(np.mean(np.abs(r.motion[:, 8]))) * b.journal_radius
        pairs = [(float(np.mean(r.power_loss)), float(np.mean(r.leakage)), speed)]
    rises = []
    for power, flow, speed in pairs:
        couette = 0.5 * speed * b.radial_clearance * b.length
        flow = flow if flow > 1e-2 * couette else couette
        rises.append(power / (b.lubricant.density * b.lubricant.specific_heat * flow) if flow > 0.0 else 0.0)
    return max(0.0, *rises)


def heating(case: Case) -> Finding:
    """Change of viscosity by the film's own heat."""
    b = case.bearing
    law = b.lubricant.temperature_law
    coefficient = TYPICAL_TEMPERATURE_COEFFICIENT
    if law is not None:
        T, rho = b.lubricant.temperature, b.lubricant.density
        hot, cold = float(law.viscosity(T + 1.0, rho)), float(law.viscosity(T - 1.0, rho))
        coefficient = 0.5 * abs(math.log(hot / cold))
    rise = case.largest("rise") if b.thermal is not None else temperature_rise(case)
    return _judged(
        case,
        "heating",
        f"{coefficient:.3g} 1/K x rise of {rise:.3g} K",
        coefficient * rise,
        b.thermal is not None,
        heated if b.thermal is None else isothermal,
        probe=warmer(rise, coefficient) if b.thermal is None and case.record is not None else None,
        mattering="give the bearing thermal=LumpedThermal(...) and the lubricant a temperature_law, "
        "or the viscosity at its running temperature.",
        needless="the film stays at its supply temperature: thermal=None.",
    )


def shear_thinning(case: Case) -> Finding:
    """Largest shear rate against the onset of thinning."""
    law = case.bearing.lubricant.shear_law
    onset = TYPICAL_SHEAR_ONSET if law is None else law.onset
    rate = max(s.speed / s.minimum_gap for s in case.samples)
    return _judged(
        case,
        "shear thinning",
        f"U / minimum film thickness over its onset, {onset:g} 1/s",
        rate / onset,
        law is not None,
        thinning if law is None else newtonian,
        mattering="for a multigrade oil: shear_law=CarreauShear(...); a plain mineral oil does not thin yet.",
        needless="shear rates are low: shear_law=None.",
    )


def _roughness_ratio(case: Case) -> float:
    return case.smallest("minimum_gap") / roughness_height(case.bearing)


def roughness(case: Case) -> Finding:
    """Flow factors: film thickness over roughness."""
    return _judged(
        case,
        "roughness",
        f"minimum film thickness / sigma, sigma = {roughness_height(case.bearing):g} m",
        _roughness_ratio(case),
        case.bearing.roughness is not None,
        rough if case.bearing.roughness is None else smooth,
        mattering="give the bearing roughness=PatirCheng(composite_roughness=...).",
        needless="the film is thick next to the roughness: roughness=None.",
    )


def contact(case: Case) -> Finding:
    """Load that the contacts carry, how often and when, or the film thickness at which there should be one."""
    b, record = case.bearing, case.record
    if b.contact is None and b.asperity is None:
        return _judged(
            case,
            "contact",
            f"minimum film thickness / sigma, sigma = {roughness_height(b):g} m",
            _roughness_ratio(case),
            False,
            touching,
            limit=LIMITS["roughness"],
            mattering="surfaces touch: asperity=GreenwoodTripp(...), or contact=RegularisedWall(...).",
        )
    share = max(s.contact_load / max(s.load, s.contact_load, 1e-300) for s in case.samples)
    often = ""
    if record is not None:
        acting = record.contact_load > 1e-6 * case.largest("load")
        often = f", acting in {np.mean(acting):.0%} of the steps"
        if np.any(acting):
            times, most = record.time[acting], record.time[int(np.nanargmax(record.contact_load))]
            often += f", {times[0]:.4g} to {times[-1]:.4g} s, most at {most:.4g} s"
    return finding(
        "contact",
        f"share of the load{often}",
        share,
        True,
        needless="contact carries next to nothing: " + ("contact=None." if b.asperity is None else "asperity=None."),
        switch=untouching,
    )


def wear(case: Case) -> Finding | None:
    """Wear goes with the contact's load, however small."""
    if case.bearing.wear is None:
        return None
    touching = contact(case)
    return finding(
        "wear",
        touching.indicator,
        touching.value,
        True,
        needless="surfaces hardly touch, nothing wears: wear=None.",
        switch=unworn,
    )


def squeeze(case: Case) -> Finding:
    """Squeeze against wedge."""
    return finding(
        "squeeze",
        "v / (v + e omega / 2)",
        case.largest("squeeze_share"),
        case.bearing.squeeze,
        mattering="use squeeze=True: without it the film has no damping.",
        switch=lambda bearing: replace(bearing, squeeze=True),
    )


def cavitation(case: Case) -> Finding:
    """Cavitated share of the bore, or tension in a film that never breaks."""
    if isinstance(case.bearing.cavitation, FullSommerfeld):
        return finding(
            "cavitation",
            "share of the bore below -1e5 Pa",
            case.largest("tension"),
            False,
            mattering="oil does not carry such tension: cavitation=SwiftStieber().",
            switch=swift_stieber,
        )
    return finding("cavitation", "cavitated share of the bore", case.largest("cavitated"), True)


def rupture(case: Case) -> Finding | None:
    """Half Sommerfeld's rupture against Reynolds' condition."""
    if not case.bearing.cavitation.clips:
        return None
    return _judged(
        case,
        "rupture",
        "cavitated share of the bore",
        case.largest("cavitated"),
        False,
        swift_stieber,
        mattering="the film breaks where its pressure still falls: cavitation=SwiftStieber() keeps the flow there.",
    )


def mass_conservation(case: Case) -> Finding | None:
    """Oil content and pressure of cavities: against a film whose cavities keep their oil."""
    closure = case.bearing.cavitation
    if isinstance(closure, FullSommerfeld):
        return None
    indicator, value = "cavitated share of the bore", case.largest("cavitated")
    if closure.conserves_mass:
        needless = f"cavities hardly matter: cavitation=SwiftStieber(cavity_pressure={closure.cavity_pressure:g})."
        return _judged(case, "mass conservation", indicator, value, True, swift_stieber, needless=needless)
    pressure = cavity_pressure(case.bearing)
    keeping = (
        f"cavities keep their oil: cavitation=ElrodAdams(cavity_pressure={pressure:g}), or at the pressure of yours."
    )
    return _judged(case, "mass conservation", indicator, value, False, mass_conserving, mattering=keeping)


INDICATORS = (
    Indicator(misalignment),
    Indicator(elasticity, rigid),
    Indicator(shape, lambda b: replace(b, profile=None)),
    Indicator(piezoviscosity, isoviscous),
    Indicator(heating, lambda b: replace(b, thermal=None)),
    Indicator(shear_thinning, newtonian),
    Indicator(roughness, smooth),
    Indicator(contact, untouching),
    Indicator(wear, unworn),
    Indicator(squeeze),
    Indicator(cavitation),
    Indicator(rupture),
    Indicator(mass_conservation, swift_stieber),
    Indicator(assumptions.vortices),
    Indicator(assumptions.turbulence),
    Indicator(assumptions.inertia),
    Indicator(assumptions.grid_columns),
    Indicator(assumptions.grid_rows),
    Indicator(assumptions.supply_resolution),
    Indicator(assumptions.time_step),
    Indicator(assumptions.ringing),
)
