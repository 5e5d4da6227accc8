"""Indicators of an audit: one function per effect that a bearing can have, from the worst films to a finding."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.closures import FullSommerfeld, SwiftStieber
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.audit import assumptions
from exudyn_ehd.joint.audit.findings import LIMITS, Case, Finding, finding
from exudyn_ehd.joint.audit.samples import Sample

# Mineral oils, where a bearing names nothing: pressure and temperature coefficients of the viscosity, onset of shear
# thinning.
TYPICAL_PRESSURE_COEFFICIENT = 2e-8  # 1/Pa
TYPICAL_TEMPERATURE_COEFFICIENT = 0.03  # 1/K, ISO VG 46 near 70 degrees Celsius
TYPICAL_SHEAR_ONSET = 1e6  # 1/s, multigrade oils
TYPICAL_ROUGHNESS = 0.5e-6  # m, ground journal in a finely turned bore


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
    )


def elasticity(case: Case) -> Finding | None:
    """Deflection of a liner: measured, or by Winkler elements for one that is only asked about."""
    bush = case.bearing.bush
    if bush is None and case.liner is None:
        return None

    def gap(s: Sample) -> float:
        # surfaces that touch count as a thousandth of the clearance apart
        return max(s.minimum_gap, 1e-3 * case.bearing.radial_clearance)

    if bush is not None:
        value = max(s.deflection / gap(s) for s in case.samples)
    else:
        assert case.liner is not None
        value = max(case.liner.compliance * s.peak_pressure / gap(s) for s in case.samples)
    return finding(
        "elasticity",
        "deflection / minimum film thickness",
        value,
        bush is not None,
        mattering="give the bearing bush=ElasticLiner(...), or a bush with a mesh.",
        needless="the bush is stiff enough to be rigid: bush=None.",
    )


def shape(case: Case) -> Finding | None:
    """Profile of the surfaces and worn depth."""
    if not case.bearing.profiles:
        return None
    value = max(s.shape / s.minimum_gap for s in case.samples)
    return finding(
        "profile",
        "profile height / minimum film thickness",
        value,
        True,
        needless="the film is much thicker than the profile: profile=None.",
    )


def piezoviscosity(case: Case) -> Finding:
    """Viscosity under pressure."""
    law = case.bearing.lubricant.pressure_law
    alpha = TYPICAL_PRESSURE_COEFFICIENT if law is None else law.coefficient
    return finding(
        "piezoviscosity",
        f"alpha p_max, alpha = {alpha:g} 1/Pa",
        alpha * case.largest("peak_pressure"),
        law is not None,
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
    return finding(
        "heating",
        f"{coefficient:.3g} 1/K x rise of {rise:.3g} K",
        coefficient * rise,
        b.thermal is not None,
        mattering="give the bearing thermal=LumpedThermal(...) and the lubricant a temperature_law, "
        "or the viscosity at its running temperature.",
        needless="the film stays at its supply temperature: thermal=None.",
    )


def shear_thinning(case: Case) -> Finding:
    """Largest shear rate against the onset of thinning."""
    law = case.bearing.lubricant.shear_law
    onset = TYPICAL_SHEAR_ONSET if law is None else law.onset
    rate = max(s.speed / s.minimum_gap for s in case.samples)
    return finding(
        "shear thinning",
        f"U / minimum film thickness over its onset, {onset:g} 1/s",
        rate / onset,
        law is not None,
        mattering="for a multigrade oil: shear_law=CarreauShear(...); a plain mineral oil does not thin yet.",
        needless="shear rates are low: shear_law=None.",
    )


def _roughness_height(b: JournalBearing) -> float:
    if b.asperity is not None:
        return b.asperity.composite_roughness
    return TYPICAL_ROUGHNESS if b.roughness is None else b.roughness.composite_roughness


def _roughness_ratio(case: Case) -> float:
    return case.smallest("minimum_gap") / _roughness_height(case.bearing)


def roughness(case: Case) -> Finding:
    """Flow factors: film thickness over roughness."""
    return finding(
        "roughness",
        f"minimum film thickness / sigma, sigma = {_roughness_height(case.bearing):g} m",
        _roughness_ratio(case),
        case.bearing.roughness is not None,
        mattering="give the bearing roughness=PatirCheng(composite_roughness=...).",
        needless="the film is thick next to the roughness: roughness=None.",
    )


def contact(case: Case) -> Finding:
    """Load that the contacts carry, how often and when, or the film thickness at which there should be one."""
    b, record = case.bearing, case.record
    if b.contact is None and b.asperity is None:
        return finding(
            "contact",
            f"minimum film thickness / sigma, sigma = {_roughness_height(b):g} m",
            _roughness_ratio(case),
            False,
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
    )


def squeeze(case: Case) -> Finding:
    """Squeeze against wedge."""
    return finding(
        "squeeze",
        "v / (v + e omega / 2)",
        case.largest("squeeze_share"),
        case.bearing.squeeze,
        mattering="use squeeze=True: without it the film has no damping.",
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
        )
    return finding("cavitation", "cavitated share of the bore", case.largest("cavitated"), True)


def mass_conservation(case: Case) -> Finding | None:
    """Oil content of cavities that move, or that a supply refills."""
    closure = case.bearing.cavitation
    if isinstance(closure, FullSommerfeld):
        return None
    fed = bool(case.bearing.supply)
    value = max(s.cavitated * (1.0 if fed else s.squeeze_share) for s in case.samples)
    return finding(
        "mass conservation",
        "cavitated share" + (", refilled by a supply" if fed else " x squeeze share"),
        value,
        closure.conserves_mass,
        mattering="cavities move or are refilled: cavitation=ElrodAdams(...) keeps their oil.",
        needless="cavities are small or at rest: cavitation=SwiftStieber() gives nearly the same load.",
    )


def _without_mass(bearing: JournalBearing) -> JournalBearing:
    return replace(bearing, cavitation=SwiftStieber(cavity_pressure=bearing.cavitation.cavity_pressure))


INDICATORS = (
    Indicator(misalignment),
    Indicator(elasticity, lambda b: replace(b, bush=None)),
    Indicator(shape, lambda b: replace(b, profile=None)),
    Indicator(piezoviscosity, lambda b: replace(b, lubricant=replace(b.lubricant, pressure_law=None))),
    Indicator(heating, lambda b: replace(b, thermal=None)),
    Indicator(shear_thinning, lambda b: replace(b, lubricant=replace(b.lubricant, shear_law=None))),
    Indicator(roughness, lambda b: replace(b, roughness=None)),
    Indicator(contact, lambda b: replace(b, asperity=None, contact=None, wear=None)),
    Indicator(wear, lambda b: replace(b, wear=None)),
    Indicator(squeeze),
    Indicator(cavitation),
    Indicator(mass_conservation, _without_mass),
    Indicator(assumptions.vortices),
    Indicator(assumptions.turbulence),
    Indicator(assumptions.inertia),
    Indicator(assumptions.grid_columns),
    Indicator(assumptions.grid_rows),
    Indicator(assumptions.time_step),
    Indicator(assumptions.ringing),
)
