"""Model from a bearing's description, and compilation of its kernels before a study or a run."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.model.effects import collect_effects
from exudyn_ehd.joint.model.impedance import ImpedanceModel
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.status import InputError


def compile_kernels(model: BearingModel) -> None:
    """Evaluate once at a small eccentricity, so that a run never stops to compile; leaves no warm start behind."""
    motion = np.zeros(MOTION_SIZE)
    motion[0] = 0.1 * model.bearing.radial_clearance
    motion[8] = 1.0
    history = model.initial_history(motion)
    evaluation = model.evaluate(motion, history, 1.0)
    if evaluation.film is not None:
        evaluation.tangent()
        evaluation.quantities()
        evaluation.history()
    model.forget()


def build_study_model(bearing: JournalBearing, start_angle: float) -> BearingModel:
    """Model of a bearing for one prescribed position; ``start_angle`` is where a film with `MaximumGap` starts, rad."""
    effects = collect_effects(bearing, start_angle)
    if (bearing.bush is None and bearing.journal is None) or effects.liner is not None:
        model = BearingModel(bearing, start_angle=start_angle, effects=effects)
    else:
        # imported here: a rigid bearing needs no solid
        from exudyn_ehd.joint.model.build_flexible import elastic_model

        model = elastic_model(bearing, start_angle, effects)
    compile_kernels(model)
    return model


def build_model(bearing: JournalBearing) -> BearingModel | ImpedanceModel:
    """Model of a bearing for a moving journal.

    Raises
    ------
    InputError
        If the bearing is described by something else, or by an option that only a prescribed position allows.
    """
    if not isinstance(bearing, JournalBearing):
        raise InputError(f"CreateLubricatedJoint.bearing must be a JournalBearing(...), got {bearing!r}.")
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError(
            "JournalBearing.inlet=MaximumGap() is for prescribed positions only: the line of maximum gap is "
            "undefined for a concentric journal and jumps with a moving one; use inlet=Periodic()."
        )
    if isinstance(bearing.film, ImpedanceMap):
        return ImpedanceModel(bearing)
    return build_study_model(bearing, 0.0)
