"""Compiles a model's kernels before a study or a run, and says so if that takes noticeable time."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.kernels.ahead import compile_ahead
from exudyn_ehd.progress import announced

MESSAGE = (
    "exudyn_ehd: compiling the film's kernels; this happens once (15 to 30 s, some effects more), later runs read "
    "them from numba's cache ..."
)

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
    with announced(MESSAGE):
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
    with announced(MESSAGE):
        compile_ahead(*_groups(model.bearing))
        history = model.initial_history(motion)
        evaluation = model.evaluate(motion, history, 1.0)
        if evaluation.film is not None:
            evaluation.tangent()
            evaluation.quantities()
            evaluation.history()
    model.forget()
