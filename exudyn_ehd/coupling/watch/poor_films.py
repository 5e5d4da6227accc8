"""Summary of a run, one line per joint, through the logger of this package.

``logging.getLogger("exudyn_ehd").setLevel("WARNING")`` turns the lines off. Where a program has not configured logging,
the lines go to the standard error stream.

Films that run dry, are too thin for their surfaces, too steep for their grid, or carry too little.

Films that run dry conserve mass, oil leaves them through the ends, and nothing brings it back.

In a flooded film the cavity's void takes some 0.4 of ``1 - smallest gap / mean gap``, as a share of the film's volume.
What the load squeezes out beyond it costs load: 10 % at a void of 0.55, 0.7 and 0.85 of it (eccentricity ratios 0.3,
0.6 and 0.9), which at a given eccentricity comes within one or two turns, and soon all. Under a given load the journal
sinks.

Films thinner than the surfaces are rough, where the bearing says nothing about rough surfaces or contact.

Films whose pressure peak the grid does not resolve (`exudyn_ehd.joint.balance.resolution`), at the highest pressure.

Films that carry so little that Newton's absolute tolerance is a share of it.
"""

from __future__ import annotations

import logging
import math
from collections import Counter
from collections.abc import Iterable

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.watch.solver_state import Solver
from exudyn_ehd.joint.audit.findings import LIMITS
from exudyn_ehd.joint.audit.samples import RING_COMPLIANCE, adiabatic_rise, time_mean
from exudyn_ehd.joint.audit.switches import (
    STEEL,
    TYPICAL_PRESSURE_COEFFICIENT,
    TYPICAL_ROUGHNESS,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
)
from exudyn_ehd.joint.balance.resolution import Resolution, coarse_film, is_judged, resolution
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.joint.static.steady import MORE_OIL
from exudyn_ehd.joint.step_error import enough_steps
from exudyn_ehd.status import ROUNDING, SMALL, GridWarning, StarvationWarning, ThinFilmWarning, warn_user

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


# Void of a starved film over ``1 - smallest gap / mean gap``, and the least one that counts: shares of the volume.
STARVED, LEAST = 0.6, 0.1
# Roughness of a good surface, m; surfaces of the smallest bearings are as much finer as these are smaller.
GOOD_SURFACE, CLEARANCE_SHARE = 0.2e-6, 0.05
# Pressure over the highest one yet from which on the grid is looked at again. Larger: of a lower peak; smaller: dearer.
HIGHER = 1.02
# Tolerance over the mean force of a run from which on it is told.
LOOSE = 1e-3


def lost_share(history: History) -> float:
    """Share of its oil that a starved film has lost; 0 if it is not starved."""
    if history.void is None or history.mass is None:
        return 0.0
    # the ends are full, whatever the film
    void = history.void[:, 1:-1]
    gap = void + history.mass[:, 1:-1]
    lost, smallest = float(np.mean(void) / np.mean(gap)), float(np.min(gap) / np.mean(gap))
    return lost if lost > max(LEAST, STARVED * (1.0 - smallest)) else 0.0


def warn_of_starvation(name: str, time: float, lost: float) -> None:
    """Warn that the film of the joint ``name`` is starved."""
    warn_user(
        f"LubricatedJoint '{name}': at t = {time:.9g} s {100.0 * lost:.0f} % of the film's oil has left through the "
        "ends: with ElrodAdams and neither a supply nor ends above the cavity pressure none comes back, and the film "
        f"carries less and less; {MORE_OIL[:-1]}, or SwiftStieber() for a bearing that stays flooded.",
        StarvationWarning,
    )


def smooth_limit(bearing: JournalBearing) -> float:
    """Minimum film thickness below which a smooth film is none, m; -inf where the bearing models what touches."""
    if any(getattr(bearing, name, None) is not None for name in ("asperity", "contact")):
        return -math.inf
    return min(GOOD_SURFACE, CLEARANCE_SHARE * bearing.radial_clearance)


def warn_of_thin_film(name: str, time: float, gap: float, tilting: str) -> None:
    """Warn that the film of the joint ``name`` is thinner than its surfaces are rough; ``tilting`` is advised first."""
    warn_user(
        f"LubricatedJoint '{name}': at t = {time:.9g} s the minimum film thickness is {1e6 * gap:.3g} um, less than "
        "the roughness of a good surface: real surfaces touch there, and pressure, friction and film are those of "
        f"perfectly smooth ones; {tilting}give the bearing asperity=GreenwoodTripp(...) and roughness=PatirCheng(...), "
        "contact=RegularisedWall(onset=...) if surfaces only just touch, or check load, clearance and viscosity.",
        ThinFilmWarning,
    )


class GridWatch:
    """Watch of one run for a grid that does not resolve the pressure peak, there where that is highest."""

    def __init__(self) -> None:
        self._peak = 0.0
        self._coarse: tuple[float, Resolution] | None = None

    def take(self, time: float, peak: float, film: object) -> None:
        """Take an accepted step's film of a peak pressure, Pa."""
        if not (peak > HIGHER * self._peak and isinstance(film, SolvedFilm)):
            return
        if is_judged(film):
            self._peak, found = peak, resolution(film)
            self._coarse = (time, found) if found.is_coarse else None

    def tell(self, name: str) -> None:
        """Warn, once, at the end of the run of the joint ``name``."""
        if self._coarse is not None:
            (time, found), self._coarse = self._coarse, None
            where = f"LubricatedJoint '{name}': at t = {time:.9g} s, at its highest pressure"
            warn_user(coarse_film(found, where), GridWarning)


def warn_of_tiny_forces(
    name: str, solver: Solver | None, given: float | None, bearing: object, history: JointHistory
) -> None:
    """Warn where a run with Newton's method has left a share of the forces of the joint ``name``.

    ``given``: the absolute tolerance that was asked for, where the solver has another one.
    """
    if not isinstance(solver, exu.MainSolverImplicitSecondOrder | exu.MainSolverStatic):
        return
    reference_force = getattr(bearing, "reference_force", None)
    if reference_force is None or history.time.size < 2:
        return
    newton = solver.newton
    force = float(np.mean(np.linalg.norm(history.force, axis=1)))
    left = (newton.absoluteTolerance if given is None else given) / solver.conv.errorCoordinateFactor
    unit = reference_force(float(spins(bearing, history).max()))
    if newton.residualMode == 0 and ROUNDING * unit < force < left / LOOSE:
        warn_user(
            f"LubricatedJoint '{name}': Newton's absolute tolerance of {left:.2g} N is {100.0 * left / force:.2g} % of "
            f"the film's mean load of {force:.2g} N, so that its forces may be off by as much; use "
            f"ConfigureSolver(simulationSettings, absoluteTolerance={SMALL * force:.0e}).",
            UserWarning,
        )
