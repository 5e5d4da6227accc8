"""Initial guess of Newton's method in a step of Exudyn's generalized alpha or Newmark integrator.

Exudyn starts a step at zero accelerations, as in M. Arnold and O. Bruels, Multibody System Dynamics 18 (2007) 185. With
accelerations a the error of the first positions is beta h^2 f a, f = (1 - alpha_f) / (1 - alpha_m), about 0.3 h^2 a for
any spectral radius. This is too much for a film: a crank radius r at n steps per turn gives 0.3 r (2 pi / n)^2, 4 um
for 43 mm and 360 steps, where films are 3 um thick. The first force is then far too large. Newton's method needs two to
four times the iterations, steps are halved without need, and a tolerance relative to the first residual accepts forces
whose error exceeds the film's load.

Accelerations that last are known from the steps before. With a guess g of them, Newton starts at

    q + beta h^2 f g,   dq/dt + gamma h f g,   d2q/dt2 + g,

which satisfies the integrator's formulas like Exudyn's start, so that the solution is the same. g is extrapolated from
the last two accelerations if the last three, over equal steps, lie on a line to a tenth of their change (with less
straight ones, extrapolation would prolong the ringing after a halved step). Otherwise g is the smaller one of the last
two if they agree in sign, else 0. If they differ by more than half of the last one, as in an impact or a vibration of a
few steps per period, there is no guess. Norms are those of all coordinates together. Only deformations of bodies, which
may ring while the body moves smoothly, are judged separately.

Constraints need care. Newton's first iteration leaves them open by some (h v)^2 / L from Exudyn's start and by far less
from this one. An opening that is the same in every step has no effect on forces. But a change g from one step to the
next causes a force m g / (beta h^2): between both starts m v^2 / L at any step size, as large as the inertia. So
Newton's method continues if the opening jumps. Exudyn treats this like a contact that has opened or closed, and would
start again at zero accelerations; here each further pass of a step starts at the end of the last one.

Steps that converge to a film that no bearing has
-------------------------------------------------
Newton's method may converge to a state without a valid film: beyond the end of a pressure law, where forces only lead
iterates back, or at a pressure that no steel bears, after too large a step. Iterates may lie there, but not the result.
After Newton's method Exudyn asks for an error and a step size: a step with such a result is repeated with half its
size, down to the smallest size, at which the run ends.

Newton's method kept within the films
-------------------------------------
Exudyn's Newton method makes full steps. A film stiffens towards the wall as 1 / gap^3 and more, but a cavitated or
opening film has hardly any stiffness. A step from there goes through the wall, where the film cannot be evaluated or
has a force of 1e12 N, and the time step is halved without need. From the thin side Newton's method converges step by
step, from the thick side it overshoots. So a step may close at most half of a film (as the fraction-to-the-boundary
rule of interior point methods). With the ends of the journal's axis at p, moved by d, and the gap g = c - max |p|
before the step, the part s of the step satisfies

    |p + s d| <= c - g / 2,   s = (sqrt((p d)^2 + d^2 ((c - g / 2)^2 - p^2)) - p d) / d^2,

with the smallest s of all films and ends. Coordinates, velocities and accelerations satisfy Newmark's formulas also
after a part of a step, so that the solution is the same. Rotations of Lie groups are not additive and keep the full
step. Films thinner than a thousandth of the clearance, on a contact, do not limit steps. Flexible bores are treated as
undeformed: a journal beyond the clearance is not limited, and before that the number of steps changes a little.

A film with a pressure law has a second limit: velocities v of the journal's axis for which no finite pressure exists.
The law's continuation beyond that end is flatter than the law, so that Newton's method may jump from one side to the
other for ever. After an iterate v_b beyond the end and one at v before it, a step goes at most half of the way to v_b,
d (v_b - v) <= |v_b - v|^2 / 2: a bisection, until Newton's method converges.

Newton's tolerances in the measure of the films' and bushes' forces
-------------------------------------------------------------------
Exudyn's Newton method ends if the residual is a share of the step's first one, or below an absolute tolerance. With an
initial guess close to the solution the first residual is so small that a share of it is below round-off: metres
from the origin, or under meganewtons, the round-off of a film's force is that of the position times its stiffness, 1e-9
of the force and more. The step would be halved without need. From Exudyn's start the first residual is about as large
as the forces, so that its tolerance is a share of the forces. Here the tolerance is a share of the forces too, a tenth
as large. The round-off of the forces within a nodal bush is that of its displacements times the stiffness of its
elements.

Without an initial guess, as in the first step, the first positions may lie deep in a contact, where film forces and
residual are millions of times those of the solution. A share of this residual would accept any state. So the relative
tolerance is reduced in proportion as the films' forces fall below their first ones in a step. Residuals of other parts
have no influence on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import exudyn_solvers
from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, NodeIndex, ObjectIndex, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.bush_equations import BushEquations
from exudyn_ehd.coupling.items.objects import force_owner
from exudyn_ehd.coupling.kinematics.relative import BoreGap, levers_of
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.joint.time_step import part_that_closes
from exudyn_ehd.status import SMALL, Status

_UserFunction: TypeAlias = Callable[..., Any]
# Largest change of the accelerations from step to step, over the last ones, with which a guess is made. Larger: guesses
# also after impacts, which are worse than none.
LARGEST_CHANGE = 0.5
# Largest second difference of the accelerations, over their last change, with which they are extrapolated. Larger: more
# ringing after halved steps.
LARGEST_BEND = 0.1
# Change of the opening of constraints from step to step, over beta h^2 times the largest acceleration, above which a
# step gets another pass of Newton's method. Larger: larger errors of constraint forces.
LARGEST_JUMP = 3e-5


class StartGuess:
    """User functions of a run that set the start of Newton's method in each step and keep it within the films.

    Parameters
    ----------
    films : sequence of FilmElement
        Elements of all joints of a system.
    settings : exudyn.SimulationSettings
        Settings of the run.
    """

    def __init__(self, films: Sequence[FilmElement], settings: exu.SimulationSettings) -> None:
        self.limit, self.tolerance = GapLimit(films), ForceTolerance(films, settings)
        self.by_velocities = settings.timeIntegration.generalizedAlpha.useIndex2Constraints
        bodies = {int(node) for film in films for side in film.sides for node in side.nodes}
        self.bushes = {int(node) for film in films for node in getattr(film, "bore_nodes", ())} - bodies
        self.additive = self.groups = np.empty(0)
        self.start, self.attempts = np.nan, 0
        self.past: list[tuple[float, np.ndarray]] = []
        self.ended: list[np.ndarray] = []
        self.guess: np.ndarray | None = None
        # opening of the constraints at the end of the last step, and of the last pass of Newton's method
        self.accepted = self.latest = np.zeros(1)

    def begin(self, own: _UserFunction, mbs: exu.MainSystem, t: float, iteration: int, discontinuous: int) -> None:
        """User function before a residual; the user's own is called after it."""
        solver = mbs.sys["dynamicSolver"]
        if iteration > 0:
            # before a step is shortened, since that moves the films away from their last evaluation
            self.tolerance.limit(solver, iteration)
            self.limit.shorten(mbs, self.additive)
        else:
            if discontinuous == 0:
                self._set_start(mbs, solver)
            elif self.ended:
                for values, ended in zip(state_of(mbs), self.ended, strict=False):
                    values[:] = ended
            self.limit.start(mbs)
        own(mbs, t, iteration, discontinuous)

    def _set_start(self, mbs: exu.MainSystem, solver: exu.MainSolverImplicitSecondOrder) -> None:
        data = mbs.systemData
        start = data.GetTime(START_OF_STEP)
        if not self.past:
            # not before the run: Exudyn's solver assembles a system that is not
            self.additive, self.groups = coordinates_of(mbs, self.bushes)
        if start != self.start:
            now = np.array(data.GetODE2Coordinates_tt(START_OF_STEP), dtype=float)
            self.past = [*self.past[-2:], (start, now)]
            expected = lasting(self.past, self.groups)
            self.guess = None if expected is None else expected * self.additive
            self.start, self.attempts, self.accepted = start, 0, self.latest
            self.tolerance.set(mbs, solver)
        self.attempts += 1
        # a step that was refused is tried from Exudyn's start and from this one in turns
        if self.guess is None or self.attempts % 2 == 0:
            return
        h = solver.it.currentStepSize
        change = (1.0 - solver.alphaF) / (1.0 - solver.alphaM) * self.guess
        places, velocities, accelerations, _ = state_of(mbs)
        places += solver.newmarkBeta * h * h * change
        velocities += solver.newmarkGamma * h * change
        accelerations += self.guess

    def go_on(self, own: _UserFunction, mbs: exu.MainSystem, t: float) -> list[float]:
        """User function after Newton's method: request another pass if the opening of constraints has jumped.

        The user's own is called first. A further pass of the step starts where this one has ended.
        """
        error, size = own(mbs, t)
        self.ended = [values.copy() for values in state_of(mbs)[:3]]
        # Exudyn's type stubs forget the method's own argument
        solver: Any = mbs.sys["dynamicSolver"]
        data = mbs.systemData
        opening = np.asarray(solver.GetSystemResidual())[data.ODE2Size() + data.ODE1Size() :]
        if not opening.size:
            return [error, size]
        self.latest = opening
        if error > 0.0 or solver.it.discontinuousIteration > 0:
            return [error, size]
        h = solver.it.currentStepSize
        reach = solver.newmarkGamma * h if self.by_velocities else solver.newmarkBeta * h * h
        largest = LARGEST_JUMP * reach * np.abs(data.GetODE2Coordinates_tt()).max(initial=0.0)
        return [math.inf, -1.0] if np.abs(opening - self.accepted).max() > largest else [error, size]


def lasting(past: Sequence[tuple[float, np.ndarray]], groups: np.ndarray) -> np.ndarray | None:
    """Predict the accelerations of the next step from those of the last steps.

    Parameters
    ----------
    past : sequence of (float, (n,) array)
        Times and accelerations, oldest first.
    groups : (n,) array of int
        Number of each coordinate's group; groups are judged separately.

    Returns
    -------
    (n,) array or None
        Accelerations, zero in groups without a guess; None if there is only one step.
    """
    if len(past) < 2:
        return None

    def sizes(values: np.ndarray) -> np.ndarray:
        return np.sqrt(np.bincount(groups, values * values))[groups] if groups.any() else np.sqrt(values @ values)

    (t_1, before), (t_0, now) = past[-2:]
    change = sizes(now - before)
    lasts = change <= LARGEST_CHANGE * sizes(now)
    expected = np.where(before * now > 0.0, np.sign(now) * np.minimum(np.abs(before), np.abs(now)), 0.0)
    if len(past) > 2:
        t_2, earlier = past[-3]
        even = abs((t_0 - t_1) - (t_1 - t_2)) < 1e-6 * (t_0 - t_1)
        if even:
            straight = sizes(now - 2.0 * before + earlier) < LARGEST_BEND * change
            expected = np.where(straight, 2.0 * now - before, expected)
    return np.where(lasts, expected, 0.0)


def coordinates_of(mbs: exu.MainSystem, bushes: Collection[int]) -> tuple[np.ndarray, np.ndarray]:
    """Mask (n,) and groups (n,) of the second-order coordinates.

    The mask is one for additive coordinates, zero for Lie-group rotations. Deformations of each body are a separate
    group, except those of ``bushes``, which follow the film at once; all other coordinates are one group.
    """
    size = len(mbs.systemData.GetODE2Coordinates())
    mask, groups = np.ones(size), np.zeros(size, dtype=np.intp)
    for number in range(mbs.systemData.NumberOfNodes()):
        node = NodeIndex(number)
        values = mbs.GetNode(node)
        kind = values["nodeType"]
        if "LG" in kind or "LieGroup" in kind:
            first = mbs.GetNodeODE2Index(node)
            mask[first + 3 : first + 6] = 0.0
        elif kind == "GenericODE2" and number not in bushes:
            first = mbs.GetNodeODE2Index(node)
            groups[first : first + values["numberOfODE2Coordinates"]] = 1 + groups.max()
    return mask, groups


def refuse(films: Sequence[FilmElement], own: _UserFunction, mbs: exu.MainSystem, t: float) -> list[float]:
    """User function after Newton's method: request a step of half the size if a film has no valid result.

    Parameters
    ----------
    films : sequence of FilmElement
        Elements of all joints of a system.
    own : callable
        The user's own function, called first.
    mbs : exudyn.MainSystem
    t : float
        s.
    """
    error, size = own(mbs, t)
    solver = mbs.sys.get("dynamicSolver")
    failed = [film for film in films if not film.has_result()]
    if solver is None or not failed or not exudyn_solvers.can_reject_step(solver):
        return [error, size]
    for film in failed:
        film.failures.blame(film.steps.start, t, "the pressure exceeded what oil and steel bear")
    half = 0.5 * solver.it.currentStepSize
    return [math.inf, half if size < 0.0 else min(size, half)]


# Largest share of a film's gap that a step of Newton's method may close. Larger: more overshooting; smaller: more
# iterations.
SHARE = 0.5
# Absolute tolerance over the relative tolerance times the films' forces. Smaller: steps may be halved because of
# round-off.
FORCE_SHARE = 0.1


class GapLimit:
    """Shortening of Newton's steps that close a film too much.

    Parameters
    ----------
    films : collection of FilmElement
        Elements of all joints of a system.
    """

    def __init__(self, films: Collection[FilmElement]) -> None:
        self.films = films
        self.bores = {film: BoreGap(film.model.bearing) for film in films}
        self.before: list[np.ndarray] = []
        # last motions beyond the end of the films' pressure laws
        self.behind: dict[FilmElement, np.ndarray] = {}

    def start(self, mbs: exu.MainSystem) -> None:
        """Store the state at which Newton's method starts."""
        self.before = [values.copy() for values in state_of(mbs)]
        self.behind.clear()

    def shorten(self, mbs: exu.MainSystem, additive: np.ndarray) -> None:
        """Shorten the step that Newton's method has made, if it closes a film by more than `SHARE`.

        Parameters
        ----------
        mbs : exudyn.MainSystem
            Holds the state after the step.
        additive : (n,) array
            Zero for coordinates that keep the full step, else one.
        """
        part = 1.0
        for film in self.films:
            if (last := film.last) is not None:
                after = film.motion(mbs, CURRENT)
                allowed = allowed_part(self.bores[film], last.bodies, after)
                part = min(part, allowed, self._allowed_at_end(film, last, after))
        state = state_of(mbs)
        if part < 1.0:
            taken = np.where(additive, part, 1.0)
            for share, old, new in zip((taken, taken, taken, part), self.before, state, strict=True):
                # from the old values: the new ones of a step of any size would round them away
                new[:] = np.where(share == 1.0, new, old + share * (new - old))
        for old, new in zip(self.before, state, strict=True):
            old[:] = new

    def _allowed_at_end(self, film: FilmElement, last: Trial, after: np.ndarray) -> float:
        """Part of a step, from before a pressure law's end, that goes half of the way to the last motion beyond."""
        bearing = film.model.bearing
        if last.status == Status.NO_PRESSURE and bearing.yielding is None:
            self.behind[film] = last.bodies
        elif film in self.behind:
            return _allowed_towards(self.behind[film], last.bodies, after, levers_of(bearing))
        return 1.0


def allowed_part(bore: BoreGap, before: np.ndarray, after: np.ndarray) -> float:
    """Part of a step between two motions that closes the gap of rigid surfaces by `SHARE`; at most 1.

    Gaps of a bore with profiles are linear in the motion.
    """
    smallest = bore.smallest(before)
    if not (smallest > SMALLEST_GAP_SHARE * bore.clearance and np.isfinite(after[:4]).all()):
        return 1.0
    if not bore.depth.size:
        return part_that_closes(SHARE, before, after, bore.clearance, 2.0 * bore.half)
    gaps, ends = bore.values(before), bore.values(after)
    beyond = ends < SHARE * smallest
    return float(np.min((gaps - SHARE * smallest)[beyond] / (gaps - ends)[beyond], initial=1.0))


def _allowed_towards(other: np.ndarray, before: np.ndarray, after: np.ndarray, levers: np.ndarray) -> float:
    """Part of a step between two motions that goes half of the way to the velocities of a third one; at most 1."""
    way, step = levers * (other - before)[4:8], levers * (after - before)[4:8]
    half, along = 0.5 * float(way @ way), float(way @ step)
    return half / along if along > half else 1.0


def state_of(mbs: exu.MainSystem) -> list[np.ndarray]:
    """Views of Exudyn's present second-order coordinates, velocities, accelerations and multipliers, not copies."""
    state = mbs.systemData.GetSystemStateDict(CURRENT, True)
    return [state[name] for name in ("ODE2Coords", "ODE2Coords_t", "ODE2Coords_tt", "AECoords")]


class ForceTolerance:
    """Tolerances of Newton's method, set in a running solver; the user's settings are not changed.

    Parameters
    ----------
    films : sequence of FilmElement
        Elements of all joints of a system.
    settings : exudyn.SimulationSettings
        Settings of the run.

    Attributes
    ----------
    bushes : list or None
        Nodal bushes of the system with the places of their coordinates in its vectors; known from the first step on.
    """

    def __init__(self, films: Sequence[FilmElement], settings: exu.SimulationSettings) -> None:
        newton = settings.timeIntegration.newton
        self.films = films
        self.given, self.relative = newton.absoluteTolerance, newton.relativeTolerance
        # mode 1 measures coordinates
        self.measures_forces = newton.residualMode == 0
        self.bushes: list[tuple[BushEquations, np.ndarray]] | None = None
        self.first, self.level = 0.0, 0.0

    def set(self, mbs: exu.MainSystem, solver: Any) -> None:
        """Set Newton's tolerances at the start of a step, with the films evaluated at the end of the step before."""
        if self.bushes is None:
            self.bushes = _bushes(mbs)
            for film in self.films:
                film.steps.tolerance = self.given
        newton = solver.newton
        newton.relativeTolerance = self.relative
        if self.measures_forces:
            self.level = self._forces()
            level = FORCE_SHARE * self.relative * self.level
            if self.bushes:
                state = mbs.systemData.GetSystemStateDict(START_OF_STEP, True)
                reach = abs(state["ODE2Coords"]) + solver.it.currentStepSize * abs(state["ODE2Coords_t"])
                level = max(level, math.hypot(*(bush.rounding(reach[at]) for bush, at in self.bushes)))
            newton.absoluteTolerance = max(self.given, level / solver.conv.errorCoordinateFactor)

    def limit(self, solver: Any, iteration: int) -> None:
        """Set Newton's relative tolerance before an iteration, with the films evaluated in the iteration before."""
        if not self.measures_forces:
            return
        forces = self._forces()
        if iteration == 1:
            self.first = forces
        present = max(forces, self.level)
        part = present / self.first if self.first > present else 1.0
        solver.newton.relativeTolerance = self.relative * max(part, SMALL)

    def _forces(self) -> float:
        """Norm of the forces of all films at their last evaluations, N."""
        trials = [film.last for film in self.films]
        known = [trial for trial in trials if trial is not None and trial.status == Status.CONVERGED]
        return math.hypot(*(force for trial in known for force in trial.found.wrench[:3].tolist()))


def free_bushes(mbs: exu.MainSystem) -> list[BushEquations]:
    """Nodal bushes of a system that neither supports nor a carrier hold."""
    return [bush for bush, _ in _bushes(mbs) if bush.carrier is None and not bush.held.any()]


def _bushes(mbs: exu.MainSystem) -> list[tuple[BushEquations, np.ndarray]]:
    owners = ((force_owner(mbs, number), number) for number in range(mbs.systemData.NumberOfObjects()))
    data = mbs.systemData
    return [(o, np.array(data.GetObjectLTGODE2(ObjectIndex(n)))) for o, n in owners if isinstance(o, BushEquations)]
