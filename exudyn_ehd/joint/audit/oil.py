"""Indicators of the oil: its viscosity under pressure, heat and shear."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.joint.audit.findings import Case, Finding, finding, judged
from exudyn_ehd.joint.audit.samples import time_mean
from exudyn_ehd.joint.audit.switches import (
    TYPICAL_PRESSURE_COEFFICIENT,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
    heated,
    isothermal,
    isoviscous,
    newtonian,
    piezoviscous,
    thinning,
    typical_conductance,
    walled,
    warmer,
)
from exudyn_ehd.joint.balance.limits import COOLER


def piezoviscosity(case: Case) -> Finding:
    """Viscosity under pressure."""
    law = case.bearing.lubricant.pressure_law
    alpha = TYPICAL_PRESSURE_COEFFICIENT if law is None else law.coefficient
    return judged(
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
        power, flow, spin = (time_mean(r.time, v) for v in (r.power_loss, r.leakage, np.abs(r.motion[:, 8])))
        pairs = [(power, flow, spin * b.journal_radius)]
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
    return judged(
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


def walls(case: Case) -> Finding | None:
    """Heat into bush and journal: its share, or what walls of steel would change at a steady state.

    None without a temperature field, and for runs without such walls, which warm up for longer than the run.
    """
    b = case.bearing
    if not isinstance(b.thermal, FilmEnergy):
        return None
    if b.thermal.bush is not None or b.thermal.journal is not None:
        bush, journal = case.largest("to_bush"), case.largest("to_journal")
        text = f"largest shares of the heat: {bush:.0%} into the bush, {journal:.0%} into the journal"
        needless = "the oil takes nearly all of the heat: bush=None and journal=None."
        return finding("walls", text, max(bush + journal, 0.0), True, needless=needless)
    if case.record is not None or b.thermal.bush_coefficient > 0.0 or b.thermal.journal_coefficient > 0.0:
        return None
    lost = case.largest("rise") * typical_conductance(b) / max(case.largest("power_loss"), 1e-300)
    return judged(
        case,
        "walls",
        "share of the loss that steel around the film would give off",
        lost,
        False,
        walled,
        mattering="give FilmEnergy(conductivity=0.13) a bush=Conduction(...) and a journal=Conduction(...).",
    )


def temperature(case: Case) -> Finding | None:
    """Highest temperature of the film against what oil bears; None for an isothermal one."""
    thermal = case.bearing.thermal
    if thermal is None:
        return None
    value = thermal.supply_temperature + case.largest("rise")
    advice = f"mineral oils do not bear this for long: {COOLER}"
    return finding("oil temperature", "highest temperature of the film, K", value, None, mattering=advice)


def shear_thinning(case: Case) -> Finding:
    """Largest shear rate against the onset of thinning."""
    law = case.bearing.lubricant.shear_law
    onset = TYPICAL_SHEAR_ONSET if law is None else law.onset
    rate = max(s.speed / s.minimum_gap for s in case.samples)
    return judged(
        case,
        "shear thinning",
        f"U / minimum film thickness over its onset, {onset:g} 1/s",
        rate / onset,
        law is not None,
        thinning if law is None else newtonian,
        mattering="for a multigrade oil: shear_law=CarreauShear(...); a plain mineral oil does not thin yet.",
        needless="shear rates are low: shear_law=None.",
    )
