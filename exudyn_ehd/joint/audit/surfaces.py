"""Indicators of the surfaces: elasticity, profile, roughness, contact, wear."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.audit.findings import LIMITS, PLAINLY_NOTHING, Case, Finding, finding, judged
from exudyn_ehd.joint.audit.samples import Sample
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
    untouching,
    unworn,
)

# Radial deflection of a steel ring under the peak pressure, over R p / E; half of it under a uniform one. Of a free
# steel pin likewise.
RING_COMPLIANCE, PIN_COMPLIANCE = 0.7, 0.6


def elasticity(case: Case) -> Finding:
    """Deflection of the bore: as it is, of a liner that is only asked about, or of a steel ring."""
    b, liner = case.bearing, case.liner
    if b.bush is not None:
        return judged(
            case,
            "elasticity",
            f"{_deflecting(b)} / minimum film thickness",
            max(s.deflection / _gap(b, s) for s in case.samples),
            True,
            rigid,
            needless="the bush is stiff enough to be rigid: bush=None.",
        )
    ring = RING_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"]
    compliance = ring if liner is None else liner.compliance
    return judged(
        case,
        "elasticity",
        f"deflection of {'a steel ring' if liner is None else 'the liner'} / minimum film thickness",
        max(compliance * s.peak_pressure / _gap(b, s) for s in case.samples),
        False,
        steel_ring if liner is None else partial(replace, bush=liner),
        probe=coarse_ring if liner is None else None,
        mattering="even steel gives way: give the bearing bush=ModalBush(...) of its housing."
        if liner is None
        else "give the bearing bush=ElasticLiner(...), or a bush with a mesh.",
    )


def _gap(bearing: JournalBearing, s: Sample) -> float:
    """Minimum film thickness; surfaces that touch count as a thousandth of the clearance apart."""
    return max(s.minimum_gap, 1e-3 * bearing.radial_clearance)


def _deflecting(bearing: JournalBearing) -> str:
    both = bearing.bush is not None and bearing.journal is not None
    return "deflection of bush and journal" if both else "deflection"


def journal_elasticity(case: Case) -> Finding | None:
    """Deflection of the journal: as it is, or of a steel pin that nothing holds; None where it could not have one."""
    b = case.bearing
    if b.journal is not None:
        return judged(
            case,
            "journal elasticity",
            f"{_deflecting(b)} / minimum film thickness",
            max(s.deflection / _gap(b, s) for s in case.samples),
            True,
            rigid_journal,
            needless="the journal is stiff enough to be rigid: journal=None.",
        )
    if b.bush is not None and type(b.bush).__name__ != "ModalBush":
        return None
    compliance = PIN_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"]
    return judged(
        case,
        "journal elasticity",
        "deflection of a solid steel pin / minimum film thickness",
        max(compliance * s.peak_pressure / _gap(b, s) for s in case.samples),
        False,
        steel_pin,
        probe=coarse_pin,
        mattering="even solid steel gives way: give the bearing journal=ElasticJournal(...), held as it is.",
    )


def shape(case: Case) -> Finding | None:
    """Profile of the surfaces and worn depth."""
    if not case.bearing.profiles:
        return None
    value = max(s.shape / s.minimum_gap for s in case.samples)
    return judged(
        case,
        "profile",
        "profile height / minimum film thickness",
        value,
        True,
        partial(replace, profile=None),
        needless="the film is much thicker than the profile: profile=None.",
    )


def _roughness_ratio(case: Case) -> float:
    return case.smallest("minimum_gap") / roughness_height(case.bearing)


def roughness(case: Case) -> Finding:
    """Flow factors: film thickness over roughness."""
    return judged(
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
    b = case.bearing
    if b.contact is None and b.asperity is None:
        return judged(
            case,
            "contact",
            f"minimum film thickness / sigma, sigma = {roughness_height(b):g} m",
            _roughness_ratio(case),
            False,
            touching,
            limit=LIMITS["roughness"],
            mattering="surfaces touch: asperity=GreenwoodTripp(...), or contact=RegularisedWall(...).",
        )
    share, indicator = _contact_share(case)
    # little load has much of a thin film's friction
    unclear = PLAINLY_NOTHING["contact share"] < share < LIMITS["contact"].value
    return finding(
        "contact",
        indicator,
        share,
        True,
        needless="contact carries next to nothing: " + ("contact=None." if b.asperity is None else "asperity=None."),
        change=case.films.change(untouching) if unclear else None,
        switch=untouching,
    )


def _contact_share(case: Case) -> tuple[float, str]:
    """Largest share of the load that contacts carry, and how often and when, in words."""
    record, often = case.record, ""
    share = max(s.contact_load / max(s.load, s.contact_load, 1e-300) for s in case.samples)
    if record is not None:
        acting = record.contact_load > 1e-6 * case.largest("load")
        often = f", acting in {np.mean(acting):.0%} of the steps"
        if np.any(acting):
            times, most = record.time[acting], record.time[int(np.nanargmax(record.contact_load))]
            often += f", {times[0]:.4g} to {times[-1]:.4g} s, most at {most:.4g} s"
    return share, f"share of the load{often}"


def wear(case: Case) -> Finding | None:
    """Wear goes with the contact's load, however small."""
    if case.bearing.wear is None:
        return None
    share, indicator = _contact_share(case)
    return finding(
        "wear",
        indicator,
        share,
        True,
        needless="surfaces hardly touch, nothing wears: wear=None.",
        switch=unworn,
    )
