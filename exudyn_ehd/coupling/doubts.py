"""Warnings of runs: steps that are too large, doubtful films, and the summary line of a run.

Explicit integrators beyond their stability limit
-------------------------------------------------
A film is a damper C between masses: beyond h C / m = 2 (forward Euler), 2.51 (RK33) or 2.79 (RK44) the journal's
velocity depends on the step size h instead of the physics. The stiffening film keeps it finite, so that the journal
chatters about a wrong position. The criterion is that velocities are no longer the rates of the positions: with the
displacement d of a step and the velocities v0, v1 at its ends, the mismatch

    s = |d - h (v0 + v1) / 2| / (h max(|v0|, |v1|))

is |sin(a) / a - cos(a)|, a = pi / n, for an oscillation with n steps per period: 0.05 at eight, 0.19 at four, 0.64 at
two. For v' = -lambda v a Runge-Kutta method has d = h v0 (1 - R) / z, with z = h lambda and its stability function
R(z): s = |(1 - R) / z - (1 + R) / 2| is 2 / z at the limit R = -1 and 1 at the limit R = 1, however slow the growth.
Single steps of this kind come from impacts, and decaying ones from transients that end within some steps: neither
counts.

Far beyond the limit a step throws the journal out of the thin film to where its damping is a hundredth. The journal
returns in some well resolved steps and is thrown again, each time by a different amount. Film and walls slow a journal
down. So a step that is not resolved and makes the journal faster is such a kick. Kicks in short succession count, even
if they differ in size.

Bodies on absolute coordinates that turn too far in a step
----------------------------------------------------------
Nodes of such bodies move on circles, from which the formulas of an integrator deviate. In the first turn a free ring of
any wall and material loses the share

    (0.24 + 1.64 (1 - rho)^3) a^2

of its angular momentum, with the turn a of a step in rad and the spectral radius rho (measured to 15 % of it at 20 to
160 steps a turn and radii of 0 to 0.95; an ANCF beam behaves alike), most of it in the first steps. The elements also
vibrate. These vibrations grow, until elements turn inside out, if a exceeds 0.87 to 1.05 (1 - rho), because the
integrator damps them less than the rotation excites them; at 0.79 (1 - rho) none grew. At rho = 1 they take some turns
to grow at 120 steps a turn, and did not grow in six turns at 200.

Spectral radii near 1. A film holds a journal of mass m with the damping D >> m / h. The difference between the
journal's velocity and its quasi-static rate in the film is multiplied by about -rho in every step, and at rho = 1 it
alternates for ever. A start at rest, a halved step or a moving film boundary excites it again, and nonlinear forces
turn it into displacements. Measured on journals that whirl freely in 4 or 8 turns of 50 to 200 steps (clearances of 20
to 100 um, 50 to 800 rad/s, three closures, starts at rest): 36 runs at 0.9 without a bad one, and the growth rates of
all 24 that were compared are those at 0.6. Runs with a wrong growth or hundreds of halved steps, counted by eye: about
7 of 36 at 0.95, 7 of 12 at 0.99, 3 of 11 at 1. A whirl of 80 steps per period loses 2e-7 of its amplitude per period at
0.9. `TrapezoidalIndex2` has the radius 1.

Summary of a run, one line per joint, in the log
------------------------------------------------
``logging.getLogger("exudyn_ehd").setLevel("WARNING")`` turns the lines off. Where a program has not configured logging,
the lines go to the standard error stream.

Films that run dry, are too thin for their surfaces, too steep for their grid, or carry too little
--------------------------------------------------------------------------------------------------
Films that run dry conserve mass, oil leaves them through the ends, and nothing brings it back.

In a flooded film the void of the cavity is some 0.4 times ``1 - smallest gap / mean gap``, as a share of the film's
volume. More void reduces the load: by 10 % at a void of 0.55, 0.7 and 0.85 times this number, for eccentricity ratios
of 0.3, 0.6 and 0.9. At a given eccentricity this happens within one or two turns, and soon the film carries nothing.
Under a given load the journal sinks.

Films thinner than the surfaces are rough, where the bearing says nothing about rough surfaces or contact.

Films whose pressure peak the grid does not resolve (`exudyn_ehd.joint.audit.resolution`), at the highest pressure.

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
from exudyn_ehd.coupling.contract import Side
from exudyn_ehd.coupling.exudyn_solvers import USUAL_RADIUS, Solver
from exudyn_ehd.coupling.kinematics.relative import eccentricity_ratios, levers_of
from exudyn_ehd.coupling.record.history import JointHistory, error_of_pockets, unseen_errors
from exudyn_ehd.joint.audit.findings import LIMITS
from exudyn_ehd.joint.audit.resolution import LOCAL_SHARE, WINDOW, Resolution, coarse_film, is_judged, resolution
from exudyn_ehd.joint.audit.samples import STEEL_COMPLIANCE, adiabatic_rise, time_mean
from exudyn_ehd.joint.audit.switches import (
    MULTIGRADE,
    PIEZOVISCOSITY,
    ROUGH_STEEL,
    STEEL,
    TEMPERATURE_COEFFICIENT,
)
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.joint.static.steady import MORE_OIL
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE, enough_steps
from exudyn_ehd.status import (
    ROUNDING,
    SMALL,
    GridWarning,
    RingingWarning,
    StarvationWarning,
    ThinFilmWarning,
    warn_user,
)

# Mismatch s of a step that is not resolved: an oscillation with less than 3.5 steps per period.
UNRESOLVED = 0.25
# Score at which chatter is reported: a step that is not resolved adds two, if its error is more than `LOCAL_SHARE` of
# the largest one of some `WINDOW` steps; any other subtracts one. Larger: reported later.
LIMIT = 32
# A kick adds this weight to a second score, any other step subtracts one, so that one kick in eight steps keeps it.
# Hits from outside are kicks too, so that chatter is reported at twice the limit. Larger: rarer kicks are reported.
KICK = 7
# Loss of angular momentum in a turn above which a run warns; turn of a step over 1 - rho, rad, above which vibrations
# may grow; turn of a step, rad, below which vibrations are not assumed to grow.
LOST, GROWING, LEAST_TURN = 0.01, 0.8, 2.0 * math.pi / 200
# Spectral radius above which a run warns: alternating velocities decay too slowly. Smaller ones damp whirl more.
LARGEST_RADIUS = 0.9


class ChatterWatch:
    """Detection of chatter at one joint under an explicit solver.

    Parameters
    ----------
    bearing : JournalBearing

    Attributes
    ----------
    error : float
        |d - h (v0 + v1) / 2| of the last step, m; tilts count by half the length.
    """

    def __init__(self, bearing: JournalBearing) -> None:
        self.clearance = bearing.radial_clearance
        self.length, self.levers = bearing.length, levers_of(bearing)
        self.time = np.inf
        self.place = self.rate = np.zeros(4)
        self.error = self.largest = 0.0
        self.score = self.kicks = 0

    def sees_chatter(self, time: float, motion: np.ndarray) -> bool:
        """Add an accepted state; return whether the last steps were not resolved.

        Parameters
        ----------
        time : float
            s.
        motion : (10,) array
            Motion in the joint frame.
        """
        place, rate = self.levers * motion[:4], self.levers * motion[4:8]
        step, before, rate_before = time - self.time, self.place, self.rate
        self.time, self.place, self.rate = time, place, rate
        if not step > 0.0:
            return False
        mismatch = place - before - 0.5 * step * (rate + rate_before)
        self.error = float(np.sqrt(mismatch @ mismatch))
        speed, speed_before = float(np.sqrt(rate @ rate)), float(np.sqrt(rate_before @ rate_before))
        gap = 1.0 - eccentricity_ratios(motion, self.clearance, self.length)[1]
        smallest = SMALL * self.clearance * max(gap, SMALLEST_GAP_SHARE)
        self.largest = max(self.error, self.largest - self.largest / WINDOW)
        unresolved = self.error > max(UNRESOLVED * step * max(speed, speed_before), smallest)
        counts = unresolved and self.error > LOCAL_SHARE * self.largest
        self.score = self.score + 2 if counts else max(self.score - 1, 0)
        kick = unresolved and speed > speed_before
        self.kicks = self.kicks + KICK if kick else max(self.kicks - 1, 0)
        return self.score >= LIMIT or self.kicks >= 2 * LIMIT


def lost_in_a_turn(radius: float) -> float:
    """Loss of angular momentum in the first turn over the square of the turn of a step, 1/rad^2."""
    return 0.24 + 1.64 * (1.0 - radius) ** 3


def largest_turn(radius: float) -> float:
    """Turn of a step, rad, beyond which the loss of angular momentum exceeds `LOST`, or vibrations may grow."""
    return min(math.sqrt(LOST / lost_in_a_turn(radius)), max(GROWING * (1.0 - radius), LEAST_TURN))


class TurnWatch:
    """Detection of too large turns per step at sides of one joint that have absolute coordinates.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    sides : pair of Side
        Housing and journal.
    solver : solver of Exudyn or None
        The running solver; turns are checked for implicit ones only.
    """

    def __init__(self, mbs: exu.MainSystem, sides: tuple[Side, Side], solver: Solver | None) -> None:
        self.sides, self.before = list[Side](), list[np.ndarray]()
        if isinstance(solver, exu.MainSolverImplicitSecondOrder):
            self.radius = solver.spectralRadius
            self.sides = [s for s in sides if s.nodes and mbs.GetNode(s.nodes[0])["nodeType"].startswith("Point")]

    def take(self, name: str, time: float) -> None:
        """Add an accepted state, for which the sides are updated; warn, once, if a side turned too far in the step.

        Parameters
        ----------
        name : str
            Name of the joint.
        time : float
            s.
        """
        if not self.sides:
            return
        before, self.before = self.before, [side.frame[:, :3].copy() for side in self.sides]
        traces = [float(np.sum(old * new)) for old, new in zip(before, self.before, strict=False)]
        turn = max((math.acos(min(max(0.5 * (t - 1.0), -1.0), 1.0)) for t in traces), default=0.0)
        if turn > largest_turn(self.radius):
            self.sides = []
            warn_of_turn(name, time, turn, self.radius)


def warn_of_turn(name: str, time: float, turn: float, radius: float) -> None:
    """Warn that a body at the joint ``name`` turns too far in a step."""
    fate = f"loses some {100.0 * lost_in_a_turn(radius) * turn**2:.2g} % of its angular momentum in the first turn"
    if turn > GROWING * (1.0 - radius):
        fate += ", and the vibrations of its elements grow until results are useless"
    wanted, usual = (math.ceil(2.0 * math.pi / largest_turn(each)) for each in (radius, USUAL_RADIUS))
    warn_user(
        f"LubricatedJoint '{name}': in the step to t = {time:.9g} s the finite elements that it holds turn by "
        f"{turn:.3g} rad, {2.0 * math.pi / turn:.3g} steps a turn: on absolute coordinates Exudyn's integrator with a "
        f"spectral radius of {radius:g} {fate}; take {wanted} steps a turn or more ({usual} at a "
        f"spectral radius of {USUAL_RADIUS:g}), or a body with a floating frame (ObjectFFRFreducedOrder).",
        RingingWarning,
    )


def warn_of_radius(solver: Solver | None) -> None:
    """Warn of an integrator with too little damping of alternating velocities, `LARGEST_RADIUS`."""
    if isinstance(solver, exu.MainSolverImplicitSecondOrder) and solver.spectralRadius > LARGEST_RADIUS:
        warn_user(
            f"The time integration has a spectral radius of {solver.spectralRadius:g} (Newmark and TrapezoidalIndex2 "
            "have 1): journal velocities that alternate from step to step hardly fade, steps are halved, and growth "
            f"rates of whirl may be wrong. Use GeneralizedAlpha with a spectral radius of {LARGEST_RADIUS:g} or less: "
            f"ehd.ConfigureSolver(simulationSettings, spectralRadius={LARGEST_RADIUS:g}) for whirl.",
            RingingWarning,
        )


LOGGER = logging.getLogger("exudyn_ehd")
# Largest temperature rise, K, that the summary line states; larger estimates at a constant viscosity are useless.
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
    """Return the summary line of a joint whose run has ended.

    Parameters
    ----------
    name : str
        Name of the joint.
    bearing : JournalBearing
    history : JointHistory
        History with at least one step.
    reasons : iterable of str
        Reasons why steps were halved, one for each halved step; those of all joints of the run.
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
    if counts := Counter(reasons):
        why = "; ".join(f"{count} x {reason}" for reason, count in counts.most_common())
        text += f", halved steps: {counts.total()} ({why})"
    error = float(np.nanmax(h.step_error, initial=0.0))
    if error > LIMITS["time step"].value:
        at = time[np.nanargmax(h.step_error)]
        text += (
            f", error of the time steps {100.0 * error:.0f} % of the minimum film thickness at {at:.6g} s: take "
            f"{enough_steps(time, h.motion[:, 8], h.step_error, h.step_count)}"
        )
    text += f", without an estimate of errors by {unseen}" if (unseen := unseen_errors(bearing)) else ""
    error, k = error_of_pockets(bearing, history)
    if error > LIMITS["time step"].value:
        share = f"{100.0 * error:.0f} % of the highest one in the step to {time[k]:.6g} s"
        text += f", error of the pressure behind a restrictor {share}, on top of the film's: take smaller steps"
    doubts = worth_an_audit(bearing, history) if hasattr(bearing, "reference_force") else []
    return text + (f"; worth an audit (joint.audit()): {', '.join(doubts)}." if doubts else ".")


def spins(bearing: object, history: JointHistory) -> np.ndarray:
    """Size (n,) of the relative spin, rad/s; for a ball that of its angular velocity."""
    parts = slice(8, 9) if isinstance(bearing, JournalBearing) else slice(6, 9)
    return np.asarray(np.linalg.norm(history.motion[:, parts], axis=1))


def worth_an_audit(bearing: JournalBearing, history: JointHistory) -> list[str]:
    """Return texts about effects that the bearing omits and that matter by the record alone, each with its size."""
    b, h, spin = bearing, history, spins(bearing, history)
    thinnest, highest = float(np.nanmin(h.minimum_gap)), float(np.nanmax(h.peak_pressure, initial=0.0))
    speed = float(np.max(spin)) * b.journal_radius
    means = (np.array(time_mean(h.time, x)) for x in (h.power_loss, h.leakage, spin * b.journal_radius))
    rise = float(adiabatic_rise(b, *means))
    deflection = STEEL_COMPLIANCE * b.journal_radius * highest / STEEL["youngs_modulus"]
    thickening = PIEZOVISCOSITY.coefficient * highest
    reynolds = b.lubricant.density * speed * b.radial_clearance / b.lubricant.viscosity
    rate = speed / max(thinnest, SMALLEST_GAP_SHARE * b.radial_clearance)
    found = {
        f"elasticity: {1e6 * deflection:.3g} um of a steel ring": b.bush is None
        and deflection > LIMITS["elasticity"].value * thinnest,
        f"piezoviscosity: viscosity x {math.exp(min(thickening, 99.0)):.3g}": b.lubricant.pressure_law is None
        and thickening > LIMITS["piezoviscosity"].value,
        f"heating: {rise:+.3g} K" if rise < HOTTEST else f"heating: above +{HOTTEST:g} K": b.thermal is None
        and TEMPERATURE_COEFFICIENT * rise > LIMITS["heating"].value,
        f"shear thinning: {rate:.3g} 1/s": b.lubricant.shear_law is None
        and rate > LIMITS["shear thinning"].value * MULTIGRADE.onset,
        f"turbulence: Re = {reynolds:.3g}": b.turbulence is None and reynolds > LIMITS["turbulence"].value,
        f"roughness: film of {1e6 * thinnest:.3g} um": b.asperity is b.contact is b.roughness is None
        and thinnest < LIMITS["roughness"].value * ROUGH_STEEL.composite_roughness,
    }
    return [text for text, matters in found.items() if matters]


# Void, as a share of the film's volume, above which a film counts as starved: over ``1 - smallest gap / mean gap``, and
# at least. Larger: later warnings.
STARVED, LEAST = 0.6, 0.1
# Minimum film thickness below which a smooth film causes a warning: in m, the roughness of a good surface; over the
# clearance, for small bearings, whose surfaces are finer. The smaller one counts.
GOOD_SURFACE, CLEARANCE_SHARE = 0.2e-6, 0.05
# Newton's absolute tolerance over the mean force of a run, above which a run warns.
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
    """Minimum film thickness, m, below which a smooth film causes a warning; -inf for bearings with a contact model."""
    if any(getattr(bearing, name, None) is not None for name in ("asperity", "contact")):
        return -math.inf
    return min(GOOD_SURFACE, CLEARANCE_SHARE * bearing.radial_clearance)


def warn_of_thin_film(name: str, time: float, gap: float, tilting: str) -> None:
    """Warn that the film of the joint ``name`` is thinner than the roughness of good surfaces.

    ``tilting``: advice about tilting, placed first in the message.
    """
    warn_user(
        f"LubricatedJoint '{name}': at t = {time:.9g} s the minimum film thickness is {1e6 * gap:.3g} um, less than "
        "the roughness of a good surface: real surfaces touch there, and pressure, friction and film are those of "
        f"perfectly smooth ones; {tilting}give the bearing asperity=GreenwoodTripp(...) and roughness=PatirCheng(...), "
        "contact=RegularisedWall(onset=...) if surfaces only just touch, or check load, clearance and viscosity.",
        ThinFilmWarning,
    )


class GridWatch:
    """Check, for one run, whether the grid resolves the pressure peak of the film with the highest peak."""

    def __init__(self) -> None:
        self._peak = 0.0
        self._coarse: tuple[float, Resolution] | None = None

    def take(self, time: float, peak: float, film: object) -> None:
        """Add the film of an accepted step, which has a peak pressure, Pa."""
        if peak > self._peak and isinstance(film, SolvedFilm) and is_judged(film):
            self._peak, found = peak, resolution(film)
            self._coarse = (time, found) if found.is_coarse else None

    def tell(self, name: str) -> None:
        """Warn, once, at the end of a run if the grid of the joint ``name`` is too coarse."""
        if self._coarse is not None:
            (time, found), self._coarse = self._coarse, None
            where = f"LubricatedJoint '{name}': at t = {time:.9g} s, at its highest pressure"
            warn_user(coarse_film(found, where), GridWarning)


def warn_of_tiny_forces(
    name: str, solver: Solver | None, given: float | None, bearing: object, history: JointHistory
) -> None:
    """Warn if Newton's absolute tolerance is more than a share `LOOSE` of the mean force of the joint ``name``.

    ``given``: absolute tolerance of the settings, if the solver used another one.
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
