"""Compiles a model's kernels before a study or a run, and says so if that takes noticeable time."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.progress import announced

MESSAGE = (
    "exudyn_ehd: compiling the film's kernels; this happens once (10 to 20 s), later runs read them from numba's "
    "cache ..."
)


def compile_kernels(model: BearingModel) -> None:
    """Evaluate once at a small eccentricity, so that a run never stops to compile; leaves no warm start behind."""
    motion = np.zeros(MOTION_SIZE)
    motion[0] = 0.1 * model.bearing.radial_clearance
    motion[8] = 1.0
    with announced(MESSAGE):
        history = model.initial_history(motion)
        evaluation = model.evaluate(motion, history, 1.0)
        if evaluation.film is not None:
            evaluation.tangent()
            evaluation.quantities()
            evaluation.history()
    model.forget()
