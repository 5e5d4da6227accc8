"""Rows of the surfaces: elasticity, profile, roughness, contact, wear."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import LIMITS, Finding, judged
from exudyn_ehd.joint.audit.samples import SMALLEST_GAP_SHARE
from exudyn_ehd.joint.audit.switches import (
    STEEL,
    coarse_pin,
    coarse_ring,
    rigid,
    rigid_journal,
    rough,
    roughness_height,
    smooth,
    steel_pin,
    steel_ring,
    touching,
    unprofiled,
    untouching,
    unworn,
)

# Radial deflection of a free solid steel pin under the peak pressure, over R p / E.
PIN_COMPLIANCE = 0.6


def _over_gap(case: Case, deflection: np.ndarray) -> float:
    """Largest deflection over the film thickness; touching surfaces count as a thousandth of the clearance apart."""
    gap = np.maximum(case.numbers["minimum_gap"], SMALLEST_GAP_SHARE * case.bearing.radial_clearance)
    return float((deflection / gap).max())


def _deflecting(bearing: JournalBearing) -> str:
    both = bearing.bush is not None and bearing.journal is not None
    return f"{'deflection of bush and journal' if both else 'deflection'} / minimum film thickness"


def elasticity(case: Case) -> Finding:
    """Deflection of the bore: as it is, of a liner that is only asked about, or of a steel ring."""
    b, liner, numbers = case.bearing, case.liner, case.numbers
    if b.bush is not None:
        value, needless = _over_gap(case, numbers["deflection"]), "the bush is stiff enough to be rigid: bush=None."
        return judged(case, "elasticity", _deflecting(b), value, True, rigid, needless=needless)
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
        steel_ring,
        probe=coarse_ring,
        mattering="even steel gives way: give the bearing bush=ModalBush(...) of its housing.",
    )


def journal_elasticity(case: Case) -> Finding | None:
    """Deflection of the journal: as it is, or of a steel pin that nothing holds; None where it could not have one."""
    b, effect = case.bearing, "journal elasticity"
    if b.journal is not None:
        value, needless = _over_gap(case, case.numbers["deflection"]), "the journal is stiff enough to be rigid: "
        return judged(case, effect, _deflecting(b), value, True, rigid_journal, needless=f"{needless}journal=None.")
    if b.bush is not None and type(b.bush).__name__ != "ModalBush":
        return None
    compliance = PIN_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"]
    return judged(
        case,
        effect,
        "deflection of a solid steel pin / minimum film thickness",
        _over_gap(case, compliance * case.numbers["peak_pressure"]),
        False,
        steel_pin,
        probe=coarse_pin,
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
        unprofiled,
        needless="the film is much thicker than the profile: profile=None.",
    )


def thinnest(case: Case) -> tuple[str, float]:
    """Minimum film thickness over the roughness, in words and as a number."""
    height = roughness_height(case.bearing)
    return f"minimum film thickness / sigma, sigma = {height:g} m", case.numbers["minimum_gap"].min() / height


def roughness(case: Case) -> Finding:
    """Flow factors: film thickness over roughness."""
    is_on = case.bearing.roughness is not None
    return judged(
        case,
        "roughness",
        *thinnest(case),
        is_on,
        smooth if is_on else rough,
        mattering="give the bearing roughness=PatirCheng(composite_roughness=...).",
        needless="the film is thick next to the roughness: roughness=None.",
    )


def contact(case: Case) -> Finding:
    """Load that the contacts carry, how often and when, or the film thickness at which there should be one."""
    b = case.bearing
    if b.contact is None and b.asperity is None:
        return judged(
            case,
            "contact",
            *thinnest(case),
            False,
            touching,
            limit=LIMITS["asperities"],
            mattering="surfaces touch: asperity=GreenwoodTripp(...), or contact=RegularisedWall(...).",
        )
    needless = "contact carries next to nothing: " + ("contact=None." if b.asperity is None else "asperity=None.")
    return judged(case, "contact", *_contact_share(case), True, untouching, needless=needless)


def _contact_share(case: Case) -> tuple[str, float]:
    """Return how often and when contacts carry, in words, and the largest share of the load that they do."""
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
    """Wear goes with the contact's load, however small."""
    if case.bearing.wear is None:
        return None
    needless = "surfaces hardly touch, nothing wears: wear=None."
    return judged(case, "wear", *_contact_share(case), True, unworn, needless=needless)
