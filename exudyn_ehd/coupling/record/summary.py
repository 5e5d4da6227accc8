"""Summary of a run, one line per joint, through the logger of this package.

``logging.getLogger("exudyn_ehd").setLevel("WARNING")`` turns the lines off. Where a program has not configured logging,
the lines go to the standard error stream.
"""

from __future__ import annotations

import logging
import math
from collections import Counter
from collections.abc import Iterable

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.joint.audit.findings import LIMITS
from exudyn_ehd.joint.audit.samples import RING_COMPLIANCE, adiabatic_rise, time_mean
from exudyn_ehd.joint.audit.switches import (
    STEEL,
    TYPICAL_PRESSURE_COEFFICIENT,
    TYPICAL_ROUGHNESS,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
)
from exudyn_ehd.joint.step_error import enough_steps

LOGGER = logging.getLogger("exudyn_ehd")
# Rise from which on oil of constant viscosity describes no film, K; with hardly any outflow it grows without bound.
HOTTEST = 100.0


def is_on() -> bool:
    """Return whether lines are logged; add a handler if the program has none and has not chosen a level."""
    if LOGGER.level == logging.NOTSET and not LOGGER.hasHandlers():
        handler = logging.StreamHandler()
        handler.setFormatter(logging.Formatter("%(name)s: %(message)s"))
        LOGGER.addHandler(handler)
        LOGGER.setLevel(logging.INFO)
    return LOGGER.isEnabledFor(logging.INFO)


def line(name: str, bearing: JournalBearing, history: JointHistory, reasons: Iterable[str] = ()) -> str:
    """The line of a joint whose run has ended.

    Parameters
    ----------
    name : str
        Name of the joint.
    bearing : JournalBearing
    history : JointHistory
        With one step or more.
    reasons : iterable of str
        Why steps were halved, one for each of them; those of all joints of the run.
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
    counts = Counter(reasons)
    why = "; ".join(f"{count} x {reason}" for reason, count in counts.most_common())
    text += f", halved steps: {counts.total()} ({why})" if why else ""
    error = float(np.nanmax(h.step_error, initial=0.0))
    if error > LIMITS["time step"].value:
        k = int(np.nanargmax(h.step_error))
        text += (
            f", error of the time steps {100.0 * error:.0f} % of the minimum film thickness at {time[k]:.6g} s: take "
            f"{enough_steps(time, h.motion[:, 8], h.step_error, h.step_count)}"
        )
    doubts = worth_an_audit(bearing, history) if hasattr(bearing, "reference_force") else []
    return text + (f"; worth an audit (joint.audit()): {', '.join(doubts)}." if doubts else ".")


def spins(bearing: object, history: JointHistory) -> np.ndarray:
    """Size (n,) of the relative spin, rad/s; a ball's rows have its angular velocity in three parts."""
    parts = slice(8, 9) if isinstance(bearing, JournalBearing) else slice(6, 9)
    return np.asarray(np.linalg.norm(history.motion[:, parts], axis=1))


def worth_an_audit(bearing: JournalBearing, history: JointHistory) -> list[str]:
    """Effects that the record alone shows to matter and that the bearing leaves out, each with its size."""
    b, h, spin = bearing, history, spins(bearing, history)
    thinnest, highest = float(np.nanmin(h.minimum_gap)), float(np.nanmax(h.peak_pressure, initial=0.0))
    speed = float(np.max(spin)) * b.journal_radius
    means = (np.array(time_mean(h.time, x)) for x in (h.power_loss, h.leakage, spin * b.journal_radius))
    rise = float(adiabatic_rise(b, *means))
    deflection = RING_COMPLIANCE * b.journal_radius * highest / STEEL["youngs_modulus"]
    thickening = TYPICAL_PRESSURE_COEFFICIENT * highest
    reynolds = b.lubricant.density * speed * b.radial_clearance / b.lubricant.viscosity
    # a gap that has closed has no shear rate
    rate = speed / thinnest if thinnest > 0.0 else math.inf
    found = {
        f"elasticity: {1e6 * deflection:.3g} um of a steel ring": b.bush is None
        and deflection > LIMITS["elasticity"].value * thinnest,
        f"piezoviscosity: viscosity x {math.exp(min(thickening, 99.0)):.3g}": b.lubricant.pressure_law is None
        and thickening > LIMITS["piezoviscosity"].value,
        f"heating: {rise:+.3g} K" if rise < HOTTEST else f"heating: above +{HOTTEST:g} K": b.thermal is None
        and TYPICAL_TEMPERATURE_COEFFICIENT * rise > LIMITS["heating"].value,
        f"shear thinning: {rate:.3g} 1/s": b.lubricant.shear_law is None
        and rate > LIMITS["shear thinning"].value * TYPICAL_SHEAR_ONSET,
        f"turbulence: Re = {reynolds:.3g}": b.turbulence is None and reynolds > LIMITS["turbulence"].value,
        f"roughness: film of {1e6 * thinnest:.3g} um": b.asperity is b.contact is b.roughness is None
        and thinnest < LIMITS["roughness"].value * TYPICAL_ROUGHNESS,
    }
    return [text for text, matters in found.items() if matters]
