"""From a bearing's description to its model: the only place that asks whether an effect is present."""

from __future__ import annotations

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.contact import WallContact
from exudyn_ehd.joint.model import BearingModel, Effects
from exudyn_ehd.joint.surfaces import liner_of, surface_effects
from exudyn_ehd.status import InputError


def collect_effects(bearing: JournalBearing, start_angle: float = 0.0) -> Effects:
    """The effects that a bearing names, in scaled form, on the grid that starts at ``start_angle``."""
    c = bearing.radial_clearance
    wall = None if bearing.contact is None else WallContact(bearing.contact, c)
    surfaces = surface_effects(bearing, start_angle)
    limiter = wall if wall is not None else surfaces.limiter
    return Effects(
        limiter=limiter,
        gap_terms=surfaces.gap_terms,
        wear=surfaces.wear,
        liner=liner_of(bearing),
        contacts=(() if wall is None else (wall,)) + surfaces.contacts,
        flux=surfaces.flux,
        shear_factor=surfaces.shear_factor,
    )


def build_study_model(bearing: JournalBearing, start_angle: float) -> BearingModel:
    """Model of a bearing for one prescribed position; ``start_angle`` is where a film with `MaximumGap` starts, rad."""
    return BearingModel(bearing, start_angle=start_angle, effects=collect_effects(bearing, start_angle))


def build_model(bearing: JournalBearing) -> BearingModel:
    """Model of a bearing for a moving journal.

    Raises
    ------
    InputError
        If the bearing is described by something else, or by an option that only a prescribed position allows.
    """
    if not isinstance(bearing, JournalBearing):
        raise InputError(f"bearing must be a JournalBearing(...), got {bearing!r}.")
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError(
            "JournalBearing.inlet=MaximumGap() is for prescribed positions only: the line of maximum gap is undefined for a "
            "concentric journal and jumps with a moving one; use inlet=Periodic()."
        )
    return BearingModel(bearing, effects=collect_effects(bearing))
