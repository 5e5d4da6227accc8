"""Rows of the effects of surfaces and oil.

Surfaces: elasticity, profile, roughness, contact, wear. Oil: its viscosity under pressure, heat and shear, and its
temperature.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal, known_supply
from exudyn_ehd.joint.audit import switches
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import LIMITS, Finding, judged
from exudyn_ehd.joint.audit.samples import STEEL_COMPLIANCE, adiabatic_rise, time_mean
from exudyn_ehd.joint.balance.limits import COOLER
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE


def _over_gap(case: Case, deflection: np.ndarray) -> float:
    """Largest ratio of deflection and film thickness, which has a lower bound for surfaces that touch."""
    gap = np.maximum(case.numbers["minimum_gap"], SMALLEST_GAP_SHARE * case.bearing.radial_clearance)
    return float((deflection / gap).max())


def _deflecting(bearing: JournalBearing) -> str:
    both = bearing.bush is not None and bearing.journal is not None
    return f"{'deflection of bush and journal' if both else 'deflection'} / minimum film thickness"


def elasticity(case: Case) -> Finding:
    """Deflection of the bearing's bush; for a rigid bore that of the audit's liner or of a steel ring."""
    b, liner, numbers = case.bearing, case.liner, case.numbers
    if b.bush is not None:
        value, needless = _over_gap(case, numbers["deflection"]), "the bush is stiff enough to be rigid: bush=None."
        return judged(case, "elasticity", _deflecting(b), value, True, switches.rigid, needless=needless)
    if liner is not None:
        return judged(
            case,
            "elasticity",
            "deflection of the liner / minimum film thickness",
            _over_gap(case, liner.compliance * numbers["peak_pressure"]),
            False,
            partial(replace, bush=liner),
            mattering="give the bearing bush=ElasticLiner(...), or a bush with a mesh.",
        )
    return judged(
        case,
        "elasticity",
        f"deflection of {case.steel} / minimum film thickness",
        _over_gap(case, numbers["compliance"] * numbers["peak_pressure"]),
        False,
        switches.steel_ring,
        probe=switches.coarse_ring,
        mattering="even steel gives way: give the bearing bush=ModalBush(...) of its housing.",
    )


def journal_elasticity(case: Case) -> Finding | None:
    """Deflection of the elastic journal, or for a rigid one that of a free steel pin.

    None if the bush excludes an elastic journal.
    """
    b, effect = case.bearing, "journal elasticity"
    if b.journal is not None:
        value = _over_gap(case, case.numbers["deflection"])
        needless = "the journal is stiff enough to be rigid: journal=None."
        return judged(case, effect, _deflecting(b), value, True, switches.rigid_journal, needless=needless)
    if b.bush is not None and type(b.bush).__name__ != "ModalBush":
        return None
    compliance = STEEL_COMPLIANCE * b.journal_radius / switches.STEEL["youngs_modulus"]
    return judged(
        case,
        effect,
        "deflection of a solid steel pin / minimum film thickness",
        _over_gap(case, compliance * case.numbers["peak_pressure"]),
        False,
        switches.steel_pin,
        probe=switches.coarse_pin,
        mattering="even solid steel gives way: give the bearing journal=ElasticJournal(...), held as it is.",
    )


def shape(case: Case) -> Finding | None:
    """Profile of the surfaces and worn depth."""
    if not case.bearing.profiles:
        return None
    return judged(
        case,
        "profile",
        "profile height / minimum film thickness",
        (case.numbers["shape"] / case.numbers["minimum_gap"]).max(),
        True,
        switches.unprofiled,
        needless="the film is much thicker than the profile: profile=None.",
    )


def thinnest(case: Case) -> tuple[str, float]:
    """Minimum film thickness over the roughness, in words and as a number."""
    height = switches.roughness_height(case.bearing)
    return f"minimum film thickness / sigma, sigma = {height:g} m", case.numbers["minimum_gap"].min() / height


def roughness(case: Case) -> Finding:
    """Effect of the flow factors, by the film thickness over the roughness."""
    is_on = case.bearing.roughness is not None
    return judged(
        case,
        "roughness",
        *thinnest(case),
        is_on,
        switches.smooth if is_on else switches.rough,
        mattering="give the bearing roughness=PatirCheng(composite_roughness=...).",
        needless="the film is thick next to the roughness: roughness=None.",
    )


def contact(case: Case) -> Finding:
    """Share of the load carried by contacts, with their times; without a contact the film thickness over roughness."""
    b = case.bearing
    if b.contact is None and b.asperity is None:
        return judged(
            case,
            "contact",
            *thinnest(case),
            False,
            switches.touching,
            limit=LIMITS["asperities"],
            mattering="surfaces touch: asperity=GreenwoodTripp(...), or contact=RegularisedWall(...).",
        )
    needless = "contact carries next to nothing: " + ("contact=None." if b.asperity is None else "asperity=None.")
    return judged(case, "contact", *_contact_share(case), True, switches.untouching, needless=needless)


def _contact_share(case: Case) -> tuple[str, float]:
    """Return a text that says how often and when contacts carry, and their largest share of the load."""
    record, numbers, often = case.record, case.numbers, ""
    carried = numbers["contact_load"]
    share = (carried / np.maximum(np.maximum(numbers["load"], carried), 1e-300)).max()
    if record is not None:
        acting = record.contact_load > 1e-6 * numbers["load"].max()
        often = f", acting in {np.mean(acting):.0%} of the steps"
        if np.any(acting):
            times, most = record.time[acting], record.time[int(np.nanargmax(record.contact_load))]
            often += f", {times[0]:.4g} to {times[-1]:.4g} s, most at {most:.4g} s"
    return f"share of the load{often}", share


def wear(case: Case) -> Finding | None:
    """Wear, which is proportional to the load of the contact; None without wear."""
    if case.bearing.wear is None:
        return None
    needless = "surfaces hardly touch, nothing wears: wear=None."
    return judged(case, "wear", *_contact_share(case), True, switches.unworn, needless=needless)


def piezoviscosity(case: Case) -> Finding:
    """Change of the viscosity under pressure."""
    law = case.bearing.lubricant.pressure_law
    alpha = switches.PIEZOVISCOSITY.coefficient if law is None else law.coefficient
    return judged(
        case,
        "piezoviscosity",
        f"alpha p_max, alpha = {alpha:g} 1/Pa",
        alpha * case.numbers["peak_pressure"].max(),
        law is not None,
        switches.piezoviscous if law is None else switches.isoviscous,
        mattering="give the lubricant pressure_law=RoelandsPressure(coefficient=...).",
        needless="pressures are low: pressure_law=None.",
    )


def _temperature_rise(case: Case) -> float:
    """Largest `adiabatic_rise`, K; of a record by the time means of power, flow and speed."""
    b, r = case.bearing, case.record
    power, flow, speed = (case.numbers[name] for name in ("power_loss", "flow", "speed"))
    if r is not None and not b.bore_arcs and np.all(np.isfinite(r.leakage)):
        means = (time_mean(r.time, values) for values in (r.power_loss, r.leakage, case.slide(r.motion)))
        power, flow, spin = (np.array([mean]) for mean in means)
        speed = spin * b.journal_radius
    return max(0.0, float(adiabatic_rise(b, power, flow, speed).max()))


def heating(case: Case) -> Finding:
    """Change of the viscosity by the film's heat."""
    b, coefficient = case.bearing, switches.TEMPERATURE_COEFFICIENT
    law, is_warm = b.lubricant.temperature_law, b.thermal is not None
    is_on = is_warm and law is not None
    if law is not None:
        T, rho = b.lubricant.temperature, b.lubricant.density
        hot, cold = float(law.viscosity(T + 1.0, rho)), float(law.viscosity(T - 1.0, rho))
        coefficient = 0.5 * abs(math.log(hot / cold))
    rise = float(case.numbers["rise"].max()) if is_warm else _temperature_rise(case)
    return judged(
        case,
        "heating",
        f"{coefficient:.3g} 1/K x rise of {rise:.3g} K",
        coefficient * rise,
        is_on,
        switches.isothermal if is_on else switches.heated,
        probe=None if is_on or case.record is None else switches.warmer(rise, coefficient),
        mattering="give the bearing thermal=LumpedThermal(...) and the lubricant a temperature_law, "
        "or the viscosity at its running temperature.",
        needless="the film stays at its supply temperature: thermal=None.",
    )


def walls(case: Case) -> Finding | None:
    """Share of the heat that enters bush and journal, or change of a steady state by steel walls.

    None without a temperature field, and for runs without walls, because walls take longer than a run to warm up.
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
        numbers["rise"].max() * sum(switches.typical_conductances(b)) / max(numbers["power_loss"].max(), 1e-300),
        False,
        switches.walled,
        mattering="give FilmEnergy(conductivity=0.13) a bush=Conduction(...) and a journal=Conduction(...).",
    )


def temperature(case: Case) -> Finding | None:
    """Highest temperature of the film, compared with the limit of mineral oils; None for an isothermal film."""
    if (thermal := case.bearing.thermal) is None:
        return None
    value, advice = known_supply(thermal) + case.numbers["rise"].max(), "mineral oils do not bear this for long: "
    indicator = "highest temperature of the film, K"
    return judged(case, "oil temperature", indicator, value, None, mattering=advice + COOLER)


def shear_thinning(case: Case) -> Finding:
    """Largest shear rate over the rate at which thinning begins."""
    law = case.bearing.lubricant.shear_law
    onset = switches.MULTIGRADE.onset if law is None else law.onset
    return judged(
        case,
        "shear thinning",
        f"U / minimum film thickness over its onset, {onset:g} 1/s",
        (case.numbers["speed"] / case.numbers["minimum_gap"]).max() / onset,
        law is not None,
        switches.thinning if law is None else switches.newtonian,
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
    """Change of the viscosity by the heat of the thrust faces, in the oil that their sliding carries around.

    None without faces, and for `LumpedThermal`, whose balance contains this heat.
    """
    record, faces, oil = case.record, case.faces, case.bearing.lubricant
    if record is None or faces is None or isinstance(case.bearing.thermal, LumpedThermal):
        return None
    carried = 0.25 * (faces.lower + faces.upper) * faces.clearance * (faces.outer_radius**2 - faces.inner_radius**2)
    flow = carried * time_mean(record.time, case.slide(record.motion))
    loss = time_mean(record.time, record.thrust_power_loss)
    rise = loss / (oil.density * oil.specific_heat * flow) if flow > 0.0 else 0.0
    return judged(
        case,
        "heat of thrust faces",
        f"{switches.TEMPERATURE_COEFFICIENT:.3g} 1/K x rise of {rise:.3g} K in a turn",
        switches.TEMPERATURE_COEFFICIENT * rise,
        None,
        mattering="the faces' own heat is omitted: give thermal=LumpedThermal(...), whose balance contains it.",
    )
