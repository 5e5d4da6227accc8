"""Summary of a run, one line per joint, through the logger of this package.

``logging.getLogger("exudyn_ehd").setLevel("WARNING")`` turns the lines off. Where a program has not configured logging,
the lines go to the standard error stream.
"""

from __future__ import annotations

import logging

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.joint.audit.findings import LIMITS
from exudyn_ehd.joint.audit.samples import time_mean
from exudyn_ehd.joint.audit.switches import (
    TYPICAL_PRESSURE_COEFFICIENT,
    TYPICAL_ROUGHNESS,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
)
from exudyn_ehd.joint.step_error import enough_steps

LOGGER = logging.getLogger("exudyn_ehd")
# Young's modulus of steel, Pa: a rigid bore is taken for a ring of it about half a radius thick.
STEEL = 2.1e11
# Share of the largest step below which a step was halved.
HALVED = 0.75


def is_on() -> bool:
    """Return whether lines are logged; add a handler if the program has none and has not chosen a level."""
    if LOGGER.level == logging.NOTSET and not LOGGER.hasHandlers():
        handler = logging.StreamHandler()
        handler.setFormatter(logging.Formatter("%(name)s: %(message)s"))
        LOGGER.addHandler(handler)
        LOGGER.setLevel(logging.INFO)
    return LOGGER.isEnabledFor(logging.INFO)


def line(name: str, bearing: JournalBearing, history: JointHistory, *, since: float | None) -> str:
    """The line of a joint whose run has ended.

    Parameters
    ----------
    name : str
        Name of the joint.
    bearing : JournalBearing
    history : JointHistory
        With one step or more.
    since : float, optional
        Start of the run, s, if it has steps in time that differ in size only where they were halved.
    """
    h, time = history, history.time
    text = f"LubricatedJoint '{name}', {h.step_count[-1]} steps to t = {time[-1]:.6g} s"
    for title, values, worst, factor, unit in (
        ("minimum film thickness", h.minimum_gap, np.nanargmin, 1e6, "um"),
        ("peak pressure", h.peak_pressure, np.nanargmax, 1e-6, "MPa"),
        ("minimum film thickness of its thrust faces", h.thrust_minimum_gap, np.nanargmin, 1e6, "um"),
    ):
        if np.any(np.isfinite(values)):
            k = int(worst(values))
            text += f", {title} {factor * values[k]:.3g} {unit} at {time[k]:.6g} s"
    # a thinned record does not know the size of every step
    halved = 0 if since is None or h.is_thinned else _halved(time[time >= since])
    text += f", {halved} halved steps" if halved else ""
    error = float(np.nanmax(h.step_error, initial=0.0))
    if error > LIMITS["time step"].value:
        k = int(np.nanargmax(h.step_error))
        text += (
            f", error of the time steps {100.0 * error:.0f} % of the minimum film thickness at {time[k]:.6g} s: take "
            f"{enough_steps(time, h.motion[:, 8], h.step_error, h.step_count)}"
        )
    doubts = worth_an_audit(bearing, history) if hasattr(bearing, "reference_force") else []
    return text + (f"; worth an audit (joint.audit()): {', '.join(doubts)}." if doubts else ".")


def _halved(time: np.ndarray) -> int:
    """Steps far smaller than the largest; the last one may end anywhere."""
    steps = np.diff(time)[:-1]
    return int(np.sum(steps < HALVED * steps.max())) if steps.size else 0


def spins(bearing: object, history: JointHistory) -> np.ndarray:
    """Size (n,) of the relative spin, rad/s; a ball's rows have its angular velocity in three parts."""
    parts = slice(8, 9) if isinstance(bearing, JournalBearing) else slice(6, 9)
    return np.asarray(np.linalg.norm(history.motion[:, parts], axis=1))


def worth_an_audit(bearing: JournalBearing, history: JointHistory) -> list[str]:
    """Effects that the record alone shows to matter, and that the bearing leaves out."""
    b, h, spin = bearing, history, spins(bearing, history)
    thinnest, highest = float(np.nanmin(h.minimum_gap)), float(np.nanmax(h.peak_pressure, initial=0.0))
    speed = float(np.max(spin)) * b.journal_radius
    couette = 0.5 * time_mean(h.time, spin) * b.journal_radius * b.radial_clearance * b.length
    flow = float(np.fmax(time_mean(h.time, h.leakage), couette))
    heat = b.lubricant.density * b.lubricant.specific_heat * flow
    rise = time_mean(h.time, h.power_loss) / heat if heat > 0.0 else 0.0
    rough = not (b.asperity is None and b.contact is None and b.roughness is None)
    found = {
        "elasticity": b.bush is None and highest * b.journal_radius / STEEL > LIMITS["elasticity"].value * thinnest,
        "piezoviscosity": b.lubricant.pressure_law is None
        and TYPICAL_PRESSURE_COEFFICIENT * highest > LIMITS["piezoviscosity"].value,
        "heating": b.thermal is None and TYPICAL_TEMPERATURE_COEFFICIENT * rise > LIMITS["heating"].value,
        "shear thinning": b.lubricant.shear_law is None
        and speed > LIMITS["shear thinning"].value * TYPICAL_SHEAR_ONSET * thinnest,
        "turbulence": b.turbulence is None
        and speed * b.radial_clearance > LIMITS["turbulence"].value * b.lubricant.viscosity / b.lubricant.density,
        "roughness": not rough and thinnest < LIMITS["roughness"].value * TYPICAL_ROUGHNESS,
    }
    return [name for name, matters in found.items() if matters]
