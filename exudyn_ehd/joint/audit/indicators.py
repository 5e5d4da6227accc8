"""Indicators of an audit: one function per effect, from the numbers of the worst films to a finding.

An effect matters where leaving it out would change load, peak pressure, friction or smallest gap by some 5 to 10 %. At eccentricity
ratio 0.8, L/D = 0.75, with Swift-Stieber, the thresholds stand for:

* tilt that takes 0.1 of the mid-plane gap: that much of the smallest gap, 1 % of the peak pressure;
* deflection of 0.1 of the smallest gap: 6 % of the peak pressure at the same position;
* alpha p_max = 0.1: 3 % of the load, 5 % of the peak pressure;
* h_min / sigma = 3: 6 % of the load by flow factors; below 3 asperities begin to carry;
* 0.002 of the load on asperities: 5 % of the friction, where a film has 0.004 and asperities 0.1 (wear asks for less contact);
* 4 columns and 3 rows across the peak at half its height: 1 % of the load, 3 to 6 % of the peak pressure.

Viscosities count as changed at 10 %. Taylor vortices: Ta = (rho U c / mu) sqrt(c / R) = 41.2 for a concentric journal (G. I. Taylor,
Phil. Trans. R. Soc. A 223 (1923) 289). Turbulence of Couette flow: rho U c / mu = 2000. Fluid
inertia: reduced Reynolds number rho U c^2 / (mu R) = 1, where inertia and viscous forces are of one size.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.closures import FullSommerfeld, SwiftStieber
from exudyn_ehd.film.models import LongBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.audit.ringing import LIMIT, REMEDY, WINDOW, watched
from exudyn_ehd.joint.audit.samples import RecordedSteps, Sample

# Mineral oils, where a bearing names nothing: pressure and temperature coefficients of the viscosity, onset of shear thinning.
TYPICAL_PRESSURE_COEFFICIENT = 2e-8  # 1/Pa
TYPICAL_TEMPERATURE_COEFFICIENT = 0.03  # 1/K, ISO VG 46 near 70 degrees Celsius
TYPICAL_SHEAR_ONSET = 1e6  # 1/s, multigrade oils
TYPICAL_ROUGHNESS = 0.5e-6  # m, ground journal in a finely turned bore

TILT, DEFLECTION, SHAPE, PRESSURE, HEATING, SHEAR = 0.1, 0.1, 0.1, 0.1, 0.1, 1.0
ROUGHNESS, CONTACT, WEAR, SQUEEZE, CAVITATED, MOVING_CAVITY = 3.0, 2e-3, 1e-4, 0.05, 0.01, 0.05
TAYLOR, TURBULENCE, INERTIA = 41.2, 2000.0, 1.0
COLUMNS, ROWS, ADVANCE = 4.0, 3.0, 0.2
# Grids this many times finer than needed are paid for in vain.
TOO_FINE = 6.0


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What an audit says about one effect.

    Attributes
    ----------
    effect, indicator : str
        Its name, and what ``value`` is.
    value, threshold : float
        The indicator at the worst state, and from where on the effect matters.
    below : bool
        The effect matters below the threshold, not above.
    on : bool or None
        Whether the bearing has it; None for an assumption or a number that can't be switched.
    matters : bool
        Value beyond the threshold.
    in_vain : bool
        Paid for although it does not matter.
    advice : str
        What to do about it; empty if nothing.
    time_share : float or None
        Share of the time of a film evaluation with tangent that the effect takes, 0 to 1; None if not measured.
    """

    effect: str
    indicator: str
    value: float
    threshold: float
    below: bool = False
    on: bool | None
    matters: bool
    in_vain: bool = False
    advice: str = ""
    time_share: float | None = None


@dataclass(frozen=True, eq=False)
class Case:
    """What is audited: worst films, the record they come from if there is one, and a liner that the bearing does not have."""

    bearing: JournalBearing
    samples: list[Sample]
    record: RecordedSteps | None = None
    liner: ElasticLiner | None = None

    def largest(self, name: str) -> float:
        """Largest value of a number of the samples."""
        return max(getattr(sample, name) for sample in self.samples)

    def smallest(self, name: str) -> float:
        """Smallest value of a number of the samples."""
        return min(getattr(sample, name) for sample in self.samples)


@dataclass(frozen=True)
class Indicator:
    """One effect: its finding, and the bearing without it (None where nothing can be left out)."""

    find: Callable[[Case], Finding | None]
    without: Callable[[JournalBearing], JournalBearing] | None = None


def _finding(
    effect: str, indicator: str, value: float, threshold: float, on: bool | None, *, below: bool = False,
    mattering: str = "", needless: str | None = None,
) -> Finding:  # fmt: skip
    """A finding with the advice for the case at hand: ``mattering`` if it matters but is off, ``needless`` if on in vain."""
    matters = value < threshold if below else value > threshold
    in_vain = on is True and not matters and needless is not None
    advice = mattering if matters and not on else ""
    if in_vain and needless:
        advice = needless
    return Finding(
        effect=effect, indicator=indicator, value=value, threshold=threshold, below=below, on=on, matters=matters,
        in_vain=in_vain, advice=advice,
    )  # fmt: skip


def misalignment(case: Case) -> Finding:
    """Tilt of the journal, which every film but the impedance map includes."""
    return _finding(
        "misalignment", "share of the mid-plane gap lost at an end", case.largest("tilt_loss"), TILT,
        not isinstance(case.bearing.film, ImpedanceMap),
        mattering="use film=FiniteLength(...), which follows the tilt.",
    )  # fmt: skip


def elasticity(case: Case) -> Finding | None:
    """Deflection of a liner: measured, or by columns for one that is only asked about."""
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
    return _finding(
        "elasticity", "deflection / smallest gap", value, DEFLECTION, bush is not None,
        mattering="give the bearing bush=ElasticLiner(...), or a bush with a mesh.",
        needless="the bush is stiff enough to be rigid: bush=None.",
    )  # fmt: skip


def shape(case: Case) -> Finding | None:
    """Profile of the surfaces and worn depth."""
    if not case.bearing.profiles:
        return None
    value = max(s.shape / s.minimum_gap for s in case.samples)
    return _finding(
        "profile", "profile height / smallest gap", value, SHAPE, True,
        needless="the film is much thicker than the profile: profile=None.",
    )  # fmt: skip


def piezoviscosity(case: Case) -> Finding:
    """Viscosity under pressure."""
    law = case.bearing.lubricant.pressure_law
    alpha = TYPICAL_PRESSURE_COEFFICIENT if law is None else law.coefficient
    return _finding(
        "piezoviscosity", f"alpha p_max, alpha = {alpha:g} 1/Pa", alpha * case.largest("peak_pressure"), PRESSURE,
        law is not None,
        mattering="give the lubricant pressure_law=RoelandsPressure(coefficient=...).",
        needless="pressures are low: pressure_law=None.",
    )  # fmt: skip


def temperature_rise(case: Case) -> float:
    """Adiabatic rise P / (rho c_p Q), K, averaged over a record; without flow through the bearing, that of one turn's Couette flow."""
    b, r = case.bearing, case.record
    pairs = [(s.power_loss, s.flow, s.speed) for s in case.samples]
    if r is not None and np.all(np.isfinite(r.leakage)):
        speed = float(np.mean(np.abs(r.motion[:, 8]))) * b.journal_radius
        pairs = [(float(np.mean(r.power_loss)), float(np.mean(r.leakage)), speed)]
    rises = []
    for power, flow, speed in pairs:
        carried = 0.5 * speed * b.radial_clearance * b.length
        flow = flow if flow > 1e-2 * carried else carried
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
    return _finding(
        "heating", f"{coefficient:.3g} 1/K x rise of {rise:.3g} K", coefficient * rise, HEATING, b.thermal is not None,
        mattering="give the bearing thermal=LumpedThermal(...) and the lubricant a temperature_law, or the viscosity at its running "
        "temperature.",
        needless="the film stays at its supply temperature: thermal=None.",
    )  # fmt: skip


def shear_thinning(case: Case) -> Finding:
    """Largest shear rate against the onset of thinning."""
    law = case.bearing.lubricant.shear_law
    onset = TYPICAL_SHEAR_ONSET if law is None else 1.0 / law.relaxation_time
    rate = max(s.speed / s.minimum_gap for s in case.samples)
    return _finding(
        "shear thinning", f"U / h_min over its onset, {onset:g} 1/s", rate / onset, SHEAR, law is not None,
        mattering="for a multigrade oil: shear_law=CarreauShear(...); a plain mineral oil does not thin yet.",
        needless="shear rates are low: shear_law=None.",
    )  # fmt: skip


def _roughness_height(b: JournalBearing) -> float:
    if b.asperity is not None:
        return b.asperity.composite_roughness
    return TYPICAL_ROUGHNESS if b.roughness is None else b.roughness.composite_roughness


def _roughness_ratio(case: Case) -> float:
    return case.smallest("minimum_gap") / _roughness_height(case.bearing)


def roughness(case: Case) -> Finding:
    """Flow factors: film thickness over roughness."""
    return _finding(
        "roughness", f"h_min / sigma, sigma = {_roughness_height(case.bearing):g} m", _roughness_ratio(case), ROUGHNESS,
        case.bearing.roughness is not None, below=True,
        mattering="give the bearing roughness=PatirCheng(composite_roughness=...).",
        needless="the film is thick beside the roughness: roughness=None.",
    )  # fmt: skip


def contact(case: Case) -> Finding:
    """Load that the contacts carry, how often and when, or the film thickness at which there should be one."""
    b, record = case.bearing, case.record
    if b.contact is None and b.asperity is None:
        return _finding(
            "contact", f"h_min / sigma, sigma = {_roughness_height(b):g} m", _roughness_ratio(case), ROUGHNESS, False, below=True,
            mattering="surfaces touch: asperity=GreenwoodTripp(...), or contact=RegularisedWall(...).",
        )  # fmt: skip
    share = max(s.contact_load / max(s.load, s.contact_load, 1e-300) for s in case.samples)
    often = ""
    if record is not None:
        acting = record.contact_load > 1e-6 * case.largest("load")
        often = f", acting in {np.mean(acting):.0%} of the steps"
        if np.any(acting):
            times, most = record.time[acting], record.time[int(np.nanargmax(record.contact_load))]
            often += f", {times[0]:.4g} to {times[-1]:.4g} s, most at {most:.4g} s"
    return _finding(
        "contact", f"share of the load{often}", share, CONTACT, True,
        needless="contact carries next to nothing: " + ("contact=None." if b.asperity is None else "asperity=None."),
    )  # fmt: skip


def wear(case: Case) -> Finding | None:
    """Wear goes with the contact's load, however small."""
    if case.bearing.wear is None:
        return None
    touching = contact(case)
    return _finding(
        "wear",
        touching.indicator,
        touching.value,
        WEAR,
        True,
        needless="surfaces hardly touch, nothing wears: wear=None.",
    )


def squeeze(case: Case) -> Finding:
    """Squeeze against wedge."""
    return _finding(
        "squeeze", "v / (v + e omega / 2)", case.largest("squeeze_share"), SQUEEZE, case.bearing.squeeze,
        mattering="use squeeze=True: without it the film has no damping.",
    )  # fmt: skip


def cavitation(case: Case) -> Finding:
    """Cavitated share of the bore, or tension in a film that never breaks."""
    if isinstance(case.bearing.cavitation, FullSommerfeld):
        return _finding(
            "cavitation", "share of the bore below -1e5 Pa", case.largest("tension"), CAVITATED, False,
            mattering="oil does not carry such tension: cavitation=SwiftStieber().",
        )  # fmt: skip
    return _finding("cavitation", "cavitated share of the bore", case.largest("cavitated"), CAVITATED, True)


def mass_conservation(case: Case) -> Finding | None:
    """Oil content of cavities that move, or that a supply refills."""
    closure = case.bearing.cavitation
    if isinstance(closure, FullSommerfeld):
        return None
    fed = bool(case.bearing.supply)
    value = max(s.cavitated * (1.0 if fed else s.squeeze_share) for s in case.samples)
    return _finding(
        "mass conservation", "cavitated share" + (", refilled by a supply" if fed else " x squeeze share"), value,
        MOVING_CAVITY, closure.conserves_mass,
        mattering="cavities move or are refilled: cavitation=ElrodAdams(...) keeps their oil.",
        needless="cavities are small or at rest: cavitation=SwiftStieber() gives nearly the same load.",
    )  # fmt: skip


def _reynolds(case: Case) -> float:
    b = case.bearing
    return max(b.lubricant.density * s.speed * b.radial_clearance / s.viscosity for s in case.samples)


def vortices(case: Case) -> Finding:
    """Taylor number."""
    value = _reynolds(case) * math.sqrt(case.bearing.clearance_ratio)
    return _finding(
        "Taylor vortices", "Re sqrt(c / R)", value, TAYLOR, None,
        mattering="beyond the laminar film: friction and load are too low here.",
    )  # fmt: skip


def turbulence(case: Case) -> Finding:
    """Reynolds number of the Couette flow."""
    return _finding(
        "turbulence", "Re = rho U c / mu", _reynolds(case), TURBULENCE, None,
        mattering="beyond the laminar film: friction and load are too low here.",
    )  # fmt: skip


def inertia(case: Case) -> Finding:
    """Reduced Reynolds number."""
    return _finding(
        "fluid inertia", "Re c / R", _reynolds(case) * case.bearing.clearance_ratio, INERTIA, None,
        mattering="the Reynolds equation leaves the fluid's inertia out: take forces as estimates.",
    )  # fmt: skip


def _grid(case: Case, name: str, field: str, effect: str, needed: float) -> Finding | None:
    if isinstance(case.bearing.film, ImpedanceMap):
        return None
    value, size = case.smallest(field), getattr(case.bearing.film, name)
    finding = _finding(
        effect, f"intervals across the peak at half its height, {name} = {size}", value, needed, None, below=True
    )
    unit = 8 if name == "n_theta" else 2
    wanted = unit * math.ceil(1.5 * size * needed / (unit * max(value, 0.25)))
    if finding.matters:
        return replace(finding, advice=f"the pressure peak is too narrow for the grid: {name}={wanted}.")
    wanted = max(wanted, 48 if name == "n_theta" else 6)
    if value > TOO_FINE * needed and wanted < size:
        return replace(finding, in_vain=True, advice=f"finer than the pressure needs: {name}={wanted} would do.")
    return finding


def grid_columns(case: Case) -> Finding | None:
    """Columns across the pressure peak; an impedance map has its error sampled when it is built."""
    return _grid(case, "n_theta", "columns", "grid around", COLUMNS)


def grid_rows(case: Case) -> Finding | None:
    """Rows across the pressure peak; the slices of a long bearing are no grid."""
    return None if isinstance(case.bearing.film, LongBearing) else _grid(case, "n_z", "rows", "grid along", ROWS)


def time_step(case: Case) -> Finding | None:
    """Motion per accepted step against the gap."""
    if case.record is None:
        return None
    return _finding(
        "time step", "motion in a step / smallest gap", case.record.largest_advance(case.bearing.length), ADVANCE, None,
        mattering="the journal crosses much of its gap in one step: take smaller steps.",
    )  # fmt: skip


def ringing(case: Case) -> Finding | None:
    """Forces that alternate from step to step."""
    record, b = case.record, case.bearing
    if record is None:
        return None
    watch = watched(record.time, record.force, 2.0 * b.journal_radius * b.length)
    when = (
        ""
        if watch.most == 0
        else f", at {watch.first:.4g} s"
        if watch.first == watch.last
        else f", {watch.first:.4g} to {watch.last:.4g} s"
    )
    return _finding(
        "ringing", f"times within {WINDOW} steps that the force is thrown into alternation{when}", float(watch.most), LIMIT - 1.0, None,
        mattering="forces and pressures jump from step to step: " + REMEDY,
    )  # fmt: skip


def _without_law(**law: Any) -> Callable[[JournalBearing], JournalBearing]:
    def without(bearing: JournalBearing) -> JournalBearing:
        return replace(bearing, lubricant=replace(bearing.lubricant, **law))

    return without


def _without(**fields: Any) -> Callable[[JournalBearing], JournalBearing]:
    return lambda bearing: replace(bearing, **fields)


def _without_mass(bearing: JournalBearing) -> JournalBearing:
    return replace(bearing, cavitation=SwiftStieber(cavity_pressure=bearing.cavitation.cavity_pressure))


INDICATORS = (
    Indicator(misalignment),
    Indicator(elasticity, _without(bush=None)),
    Indicator(shape, _without(profile=None)),
    Indicator(piezoviscosity, _without_law(pressure_law=None)),
    Indicator(heating, _without(thermal=None)),
    Indicator(shear_thinning, _without_law(shear_law=None)),
    Indicator(roughness, _without(roughness=None)),
    Indicator(contact, _without(asperity=None, contact=None, wear=None)),
    Indicator(wear, _without(wear=None)),
    Indicator(squeeze),
    Indicator(cavitation),
    Indicator(mass_conservation, _without_mass),
    Indicator(vortices),
    Indicator(turbulence),
    Indicator(inertia),
    Indicator(grid_columns),
    Indicator(grid_rows),
    Indicator(time_step),
    Indicator(ringing),
)
