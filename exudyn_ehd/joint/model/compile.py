"""Compiles a model's kernels before a study or a run, and says so if that takes noticeable time."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE

PATIENCE = 2.0
MESSAGE = (
    "exudyn_ehd: compiling the film's kernels; this happens once (10 to 20 s), later runs read them from numba's "
    "cache ..."
)


@contextmanager
def announced(patience: float = PATIENCE) -> Iterator[None]:
    """Print `MESSAGE` to stderr if the block takes longer than ``patience`` seconds."""
    timer = threading.Timer(patience, lambda: print(MESSAGE, file=sys.stderr, flush=True))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def compile_kernels(model: BearingModel) -> None:
    """Evaluate once at a small eccentricity, so that a run never stops to compile; leaves no warm start behind."""
    motion = np.zeros(MOTION_SIZE)
    motion[0] = 0.1 * model.bearing.radial_clearance
    motion[8] = 1.0
    with announced():
        history = model.initial_history(motion)
        evaluation = model.evaluate(motion, history, 1.0)
        if evaluation.film is not None:
            evaluation.tangent()
            evaluation.quantities()
            evaluation.history()
    model.forget()
