"""Rows of the oil: its viscosity under pressure, heat and shear, and its temperature."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import Finding, judged
from exudyn_ehd.joint.audit.samples import adiabatic_rise, time_mean
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
        alpha * case.numbers["peak_pressure"].max(),
        law is not None,
        piezoviscous if law is None else isoviscous,
        mattering="give the lubricant pressure_law=RoelandsPressure(coefficient=...).",
        needless="pressures are low: pressure_law=None.",
    )


def _temperature_rise(case: Case) -> float:
    """Largest `adiabatic_rise`, K, that of a record by its means."""
    b, r = case.bearing, case.record
    power, flow, speed = (case.numbers[name] for name in ("power_loss", "flow", "speed"))
    if r is not None and b.arc is None and np.all(np.isfinite(r.leakage)):
        means = (time_mean(r.time, values) for values in (r.power_loss, r.leakage, case.slide(r.motion)))
        power, flow, spin = (np.array([mean]) for mean in means)
        speed = spin * b.journal_radius
    return max(0.0, float(adiabatic_rise(b, power, flow, speed).max()))


def heating(case: Case) -> Finding:
    """Change of viscosity by the film's own heat."""
    b, is_on = case.bearing, case.bearing.thermal is not None
    law, coefficient = b.lubricant.temperature_law, TYPICAL_TEMPERATURE_COEFFICIENT
    if law is not None:
        T, rho = b.lubricant.temperature, b.lubricant.density
        hot, cold = float(law.viscosity(T + 1.0, rho)), float(law.viscosity(T - 1.0, rho))
        coefficient = 0.5 * abs(math.log(hot / cold))
    rise = float(case.numbers["rise"].max()) if is_on else _temperature_rise(case)
    return judged(
        case,
        "heating",
        f"{coefficient:.3g} 1/K x rise of {rise:.3g} K",
        coefficient * rise,
        is_on,
        isothermal if is_on else heated,
        probe=None if is_on or case.record is None else warmer(rise, coefficient),
        mattering="give the bearing thermal=LumpedThermal(...) and the lubricant a temperature_law, "
        "or the viscosity at its running temperature.",
        needless="the film stays at its supply temperature: thermal=None.",
    )


def walls(case: Case) -> Finding | None:
    """Heat into bush and journal: its share, or what walls of steel would change at a steady state.

    None without a temperature field, and for runs without such walls, which warm up for longer than the run.
    """
    b, numbers = case.bearing, case.numbers
    if not isinstance(b.thermal, FilmEnergy):
        return None
    if b.thermal.bush is not None or b.thermal.journal is not None:
        bush, journal = numbers["to_bush"].max(), numbers["to_journal"].max()
        text = f"largest shares of the heat: {bush:.0%} into the bush, {journal:.0%} into the journal"
        needless = "the oil takes nearly all of the heat: bush=None and journal=None."
        return judged(case, "walls", text, max(bush + journal, 0.0), True, needless=needless)
    if case.record is not None or b.thermal.bush_coefficient > 0.0 or b.thermal.journal_coefficient > 0.0:
        return None
    return judged(
        case,
        "walls",
        "share of the loss that steel around the film would give off",
        numbers["rise"].max() * typical_conductance(b) / max(numbers["power_loss"].max(), 1e-300),
        False,
        walled,
        mattering="give FilmEnergy(conductivity=0.13) a bush=Conduction(...) and a journal=Conduction(...).",
    )


def temperature(case: Case) -> Finding | None:
    """Highest temperature of the film against what oil bears; None for an isothermal one."""
    thermal = case.bearing.thermal
    if thermal is None:
        return None
    value, advice = thermal.supply_temperature + case.numbers["rise"].max(), "mineral oils do not bear this for long: "
    indicator = "highest temperature of the film, K"
    return judged(case, "oil temperature", indicator, value, None, mattering=advice + COOLER)


def shear_thinning(case: Case) -> Finding:
    """Largest shear rate against the onset of thinning."""
    law = case.bearing.lubricant.shear_law
    onset = TYPICAL_SHEAR_ONSET if law is None else law.onset
    return judged(
        case,
        "shear thinning",
        f"U / minimum film thickness over its onset, {onset:g} 1/s",
        (case.numbers["speed"] / case.numbers["minimum_gap"]).max() / onset,
        law is not None,
        thinning if law is None else newtonian,
        mattering="for a multigrade oil: shear_law=CarreauShear(...); a plain mineral oil does not thin yet.",
        needless="shear rates are low: shear_law=None.",
    )


def faces_share(case: Case) -> Finding | None:
    """Share of the thrust faces in the joint's loss; None without a record of them."""
    record = case.record
    if record is None or case.faces is None:
        return None
    faces, film = (time_mean(record.time, loss) for loss in (record.thrust_power_loss, np.abs(record.power_loss)))
    value = faces / (faces + film) if faces + film > 0.0 else 0.0
    return judged(case, "thrust faces", "share of the faces in the loss", value, True)


def faces_heat(case: Case) -> Finding | None:
    """Change of the viscosity by the faces' own heat, in the oil that they carry around."""
    record, faces, oil = case.record, case.faces, case.bearing.lubricant
    if record is None or faces is None:
        return None
    carried = 0.25 * (faces.lower + faces.upper) * faces.clearance * (faces.outer_radius**2 - faces.inner_radius**2)
    flow = carried * time_mean(record.time, case.slide(record.motion))
    loss = time_mean(record.time, record.thrust_power_loss)
    rise = loss / (oil.density * oil.specific_heat * flow) if flow > 0.0 else 0.0
    return judged(
        case,
        "heat of thrust faces",
        f"{TYPICAL_TEMPERATURE_COEFFICIENT:.3g} 1/K x rise of {rise:.3g} K in a turn",
        TYPICAL_TEMPERATURE_COEFFICIENT * rise,
        None,
        mattering="films on faces are isothermal here: give the lubricant the viscosity at their temperature.",
    )
