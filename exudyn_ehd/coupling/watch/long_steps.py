"""Steps that are too long for what they integrate.

Explicit integrators beyond their stability limit, recognised from the accepted steps of a joint.

A film is a damper C between masses: beyond h C / m = 2 (forward Euler), 2.51 (RK33) or 2.79 (RK44) the journal's
velocity is a product of the step size h. The film's stiffening keeps it finite, so that the journal chatters about a
wrong place. What tells is that velocities are no longer the rates of the positions: with the displacement d of a step
and the velocities v0, v1 at its ends,

    s = |d - h (v0 + v1) / 2| / (h max(|v0|, |v1|))

is |sin(a) / a - cos(a)|, a = pi / n, for an oscillation with n steps per period: 0.05 at eight, 0.19 at four, 0.64 at
two. For v' = -lambda v a Runge-Kutta method has d = h v0 (1 - R) / z, with z = h lambda and its stability function
R(z): s = |(1 - R) / z - (1 + R) / 2| is 2 / z at the limit R = -1 and 1 at the limit R = 1, however slow the growth.
Single steps of that kind belong to impacts, and those that die away to transients that end within some steps: neither
counts.

Far beyond the limit a step throws the journal out of the thin film, where its damping is a hundredth; it flies back for
some well resolved steps and is thrown again, each time by another amount. Film and walls slow a journal down: a step
that is not resolved and makes it faster is such a kick, and kicks in short succession count however unequal they are.

Bodies on absolute coordinates that turn too far in a step: finite elements on points, ANCF beams and cables.

Their nodes move on circles that an integrator's formulas leave: in the first turn a free ring of any wall and material
loses the share

    (0.24 + 1.64 (1 - rho)^3) a^2

of its angular momentum, with the turn a of a step in rad and the spectral radius rho (measured to 15 % of it at 20 to
160 steps a turn and radii of 0 to 0.95, an ANCF beam alike), most of it in the first steps. And the elements vibrate:
what a turn feeds into them outgrows the integrator's damping where a is beyond 0.87 to 1.05 (1 - rho), up to elements
that turn inside out; none did at 0.79 (1 - rho). At rho = 1 that takes some turns at 120 steps a turn, and was not seen
in six turns at 200.

Spectral radii near 1. A film holds a journal of mass m with the damping D >> m / h: what its velocity departs from the
film's own rate is multiplied by about -rho in every step. At rho = 1 it alternates for ever. A start at rest, a halved
step or a film boundary that moves throws it anew, and forces that follow no straight line make displacements of it.
Measured on journals that whirl freely in 4 or 8 turns of 50 to 200 steps (clearances of 20 to 100 um, 50 to 800 rad/s,
three closures, starts at rest): 36 runs at 0.9 without a bad one, and the growth rates of all 24 that were compared are
those at 0.6. Runs with a wrong growth or hundreds of halved steps, counted by eye: about 7 of 36 at 0.95, 7 of 12 at
0.99, 3 of 11 at 1. A whirl of 80 steps per period loses 2e-7 of its amplitude per period at 0.9. `TrapezoidalIndex2`
has the radius 1.
"""

from __future__ import annotations

import math

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Side
from exudyn_ehd.coupling.kinematics.relative import eccentricity_ratios, levers_of
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.joint.audit.ringing import FADING
from exudyn_ehd.status import SMALL, RingingWarning, warn_user

# Mismatch s of a step that is not resolved: an oscillation with less than 3.5 steps per period.
UNRESOLVED = 0.25
# Position error below which a step counts as resolved, a small share of the gap or of this one of the clearance, and m:
# rounding of positions some metres from the origin stays below.
SMALLEST_GAP_SHARE, ROUNDING = 1e-2, 1e-14
# A step counts if its error is still so large a share of the largest one before, which fades.
LASTING_SHARE = 0.15
# A step that counts adds two, any other takes one.
LIMIT = 32
# A step is a kick if it makes the journal faster by this factor; a kick adds seven and any other step takes one, so
# that one in eight lasts.
KICK, KICK_WEIGHT, KICK_LIMIT = 1.1, 7, 70
# Loss of angular momentum in a turn that counts, and the turn of a step over 1 - rho from which vibrations may grow; no
# smaller turn of a step than the last one counts, rad.
LOST, GROWING, LEAST = 0.01, 0.8, 2.0 * math.pi / 200
# Spectral radius for films; see `ConfigureSolver`.
USUAL_RADIUS = 0.6
# Largest spectral radius at which alternating velocities fade soon enough, see above; a smaller one damps whirl more.
LARGEST_RADIUS = 0.9


class ChatterWatch:
    """Watches one joint under an explicit solver.

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
        """Take an accepted state; whether the last steps were not resolved.

        Parameters
        ----------
        time : float
            s.
        motion : (10,) array
            In the joint frame.
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
        smallest = max(ROUNDING, SMALL * self.clearance * max(gap, SMALLEST_GAP_SHARE))
        self.largest = max(self.error, FADING * self.largest)
        unresolved = self.error > max(UNRESOLVED * step * max(speed, speed_before), smallest)
        counts = unresolved and self.error > LASTING_SHARE * self.largest
        self.score = self.score + 2 if counts else max(self.score - 1, 0)
        kick = unresolved and speed > KICK * speed_before
        self.kicks = self.kicks + KICK_WEIGHT if kick else max(self.kicks - 1, 0)
        return self.score >= LIMIT or self.kicks >= KICK_LIMIT


def lost_share(radius: float) -> float:
    """Loss of angular momentum in the first turn over the square of the turn of a step, 1/rad^2."""
    return 0.24 + 1.64 * (1.0 - radius) ** 3


def largest_turn(radius: float) -> float:
    """Turn of a step beyond which more is lost than counts, or vibrations may grow, rad."""
    return min(math.sqrt(LOST / lost_share(radius)), max(GROWING * (1.0 - radius), LEAST))


class TurnWatch:
    """Watches the sides of one joint that lie on absolute coordinates.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    sides : pair of Side
        Housing and journal.
    solver : solver of Exudyn or None
        At work; only the turns of implicit ones are watched.
    """

    def __init__(self, mbs: exu.MainSystem, sides: tuple[Side, Side], solver: solver_state.Solver | None) -> None:
        self.sides, self.before = list[Side](), list[np.ndarray]()
        if isinstance(solver, exu.MainSolverImplicitSecondOrder):
            self.radius = solver.spectralRadius
            self.sides = [s for s in sides if s.nodes and mbs.GetNode(s.nodes[0])["nodeType"].startswith("Point")]

    def take(self, name: str, time: float) -> None:
        """Take an accepted state, to which the sides were brought; warn, once, if the step to it turned one too far.

        Parameters
        ----------
        name : str
            Of the joint.
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
            warn(name, time, turn, self.radius)


def warn(name: str, time: float, turn: float, radius: float) -> None:
    """Warn that a body at the joint ``name`` turns too far in a step."""
    fate = f"loses some {100.0 * lost_share(radius) * turn**2:.2g} % of its angular momentum in the first turn"
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


def warn_of_radius(solver: solver_state.Solver | None) -> None:
    """Warn of an integrator that keeps alternating velocities."""
    if isinstance(solver, exu.MainSolverImplicitSecondOrder) and solver.spectralRadius > LARGEST_RADIUS:
        warn_user(
            f"The time integration has a spectral radius of {solver.spectralRadius:g} (Newmark and TrapezoidalIndex2 "
            "have 1): journal velocities that alternate from step to step hardly fade, steps are halved, and growth "
            f"rates of whirl may be wrong. Use GeneralizedAlpha with a spectral radius of {LARGEST_RADIUS:g} or less: "
            f"ehd.ConfigureSolver(simulationSettings, spectralRadius={LARGEST_RADIUS:g}) for whirl.",
            RingingWarning,
        )
