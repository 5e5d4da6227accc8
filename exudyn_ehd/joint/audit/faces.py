"""Indicators of films on the end faces, from what a record says of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.audit.findings import Case, Finding, finding
from exudyn_ehd.joint.audit.samples import FilmState, RecordedSteps
from exudyn_ehd.joint.audit.switches import TYPICAL_TEMPERATURE_COEFFICIENT
from exudyn_ehd.joint.model.rigid import BearingModel


def with_ends(
    bearing: JournalBearing, model: BearingModel, record: RecordedSteps, states: Sequence[FilmState]
) -> Sequence[FilmState]:
    """Recorded states of a journal's film with the pressures at its ends, where it feeds the faces."""
    if bearing.thrust is None or bearing.thrust.feed is None:
        return states
    # imported here: bearings whose films feed no faces need none of it
    from exudyn_ehd.joint.feed.films import FedFilms
    from exudyn_ehd.joint.thrust import ThrustModel

    films, places = FedFilms(model, ThrustModel(bearing)), [float(record.axial_position[s.recorded]) for s in states]
    return [
        replace(s, ends=films.evaluate(s.motion, place, s.history, s.step, s.spin).pressures)
        for s, place in zip(states, places, strict=True)
    ]


def share(case: Case) -> Finding | None:
    """Share of the faces in the joint's loss; None without a record of them."""
    record = case.record
    if record is None or case.faces is None:
        return None
    faces, film = float(np.nanmean(record.thrust_power_loss)), float(np.nanmean(np.abs(record.power_loss)))
    value = faces / (faces + film) if faces + film > 0.0 else 0.0
    return finding("thrust faces", "share of the faces in the loss", value, True)


def heat(case: Case) -> Finding | None:
    """Change of the viscosity by the faces' own heat, in the oil that they carry around."""
    record, faces, oil = case.record, case.faces, case.bearing.lubricant
    if record is None or faces is None:
        return None
    films = faces.lower + faces.upper
    carried = 0.25 * films * faces.clearance * (faces.outer_radius**2 - faces.inner_radius**2)
    flow = carried * float(np.mean(np.abs(record.motion[:, 8])))
    loss = float(np.nanmean(record.thrust_power_loss))
    rise = loss / (oil.density * oil.specific_heat * flow) if flow > 0.0 else 0.0
    return finding(
        "heat of thrust faces",
        f"{TYPICAL_TEMPERATURE_COEFFICIENT:.3g} 1/K x rise of {rise:.3g} K in a turn",
        TYPICAL_TEMPERATURE_COEFFICIENT * rise,
        None,
        mattering="films on faces are isothermal here: give the lubricant the viscosity at their temperature.",
    )
