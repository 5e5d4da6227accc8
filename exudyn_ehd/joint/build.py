"""From a bearing's description to its model: the only place that asks whether an effect is present."""

from __future__ import annotations

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.joint.model import RigidBearingModel
from exudyn_ehd.status import InputError


def build_model(bearing: JournalBearing) -> RigidBearingModel:
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
    return RigidBearingModel(bearing)
