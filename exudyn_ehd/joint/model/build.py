"""Model from a bearing's description, and compilation of its kernels before a study or a run."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.model.effects import collect_effects
from exudyn_ehd.joint.model.impedance import ImpedanceModel
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.kernels.ahead import compile_ahead
from exudyn_ehd.status import InputError

# Options with the same kernels as without them, or with more.
_BESIDE = {
    "journal_radius",
    "length",
    "radial_clearance",
    "lubricant",
    "film",
    "cavitation",
    "end_pressures",
    "contact",
    "thrust",
}


def compile_together(bearing: JournalBearing, *more: str) -> None:
    """Compile by two processes what a bearing needs that nobody compiled yet, if its kernels are known beforehand.

    Parameters
    ----------
    bearing : JournalBearing
        One with effects of its own has its kernels compiled when they are called.
    *more : str
        Other groups of `exudyn_ehd.kernels`.
    """
    compile_ahead(*_groups(bearing), *more)


def _groups(bearing: JournalBearing) -> tuple[str, ...]:
    """Groups of kernels that a bearing needs for sure."""
    oil = bearing.lubricant
    plain = oil.pressure_law is oil.shear_law is oil.density_law is None and all(
        getattr(bearing, f.name) == f.default for f in fields(bearing) if f.name not in _BESIDE
    )
    closure, known = bearing.closure, {(True, False, False): "swift", (False, True, False): "elrod"}
    own = known.get((bool(closure.line_in_cells), closure.conserves_mass, closure.clips))
    return ("film", own) if plain and own and isinstance(bearing.film, FiniteLength) else ()


def compile_kernels(model: BearingModel) -> None:
    """Evaluate once at a small eccentricity, so that a run never stops to compile; leaves no warm start behind."""
    motion = np.zeros(MOTION_SIZE)
    motion[0] = 0.1 * model.bearing.radial_clearance
    motion[8] = 1.0
    compile_ahead(*_groups(model.bearing))
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
