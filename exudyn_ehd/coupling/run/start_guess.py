"""Initial guess of Newton's method in a step of Exudyn's generalized alpha or Newmark integrator.

Exudyn starts a step at zero accelerations, as the algorithm is printed (M. Arnold and O. Bruels, Multibody System
Dynamics 18 (2007) 185). With accelerations a the first positions miss the solution by beta h^2 f a, f = (1 -
alpha_f) / (1 - alpha_m), about 0.3 h^2 a for any spectral radius. A mechanism does not notice, a film does: a crank
radius r at n steps per turn gives 0.3 r (2 pi / n)^2, 4 um for 43 mm and 360 steps, where films are 3 um thick.
Newton's first force is then far beyond the film's: it takes two to four times the iterations, halves steps without
need, and a tolerance relative to its first residual accepts forces that are wrong by more than the film carries.

Accelerations that last are known from the steps before. With a guess g of them, Newton starts at

    q + beta h^2 f g,   dq/dt + gamma h f g,   d2q/dt2 + g,

which satisfies the integrator's formulas like Exudyn's own start, so that the solution is the same. g goes on in a line
through the last two accelerations if the last three lie in a line to a tenth of their change, over steps of one
size (less straight ones prolong the ringing behind a halved step). Else it is the smaller one of the last two where
they agree in sign. If these differ by more than half of the last one, as in an impact or a vibration of a few steps per
period, there is no guess. Norms are those of all coordinates together, since what one would gain is lost where it meets
another; but deformations of bodies, which ring while the body moves smoothly, are judged by themselves.

Constraints are what it must not upset. Newton's first iteration leaves them open by some (h v)^2 / L from Exudyn's
start and by far less from this one. Forces do not feel what is the same in every step, but a change g from one step to
the next as m g / (beta h^2): from one start to the other m v^2 / L at any step size, as much as the inertia. So
Newton's method goes on where the opening jumps (`ConstraintJumps`). Exudyn takes that for a contact that has opened or
closed, and begins again at zero accelerations; here each further pass of a step starts where the last one has ended.

Steps that converge to a film that none bears, refused before Exudyn accepts them.

Newton's method may well converge where there is no film: behind the end of a pressure law, where forces only lead its
iterates back, or at a pressure that no steel bears, into which too large a step has thrown the journal. Its iterates
may pass there; its result may not. After Newton's method Exudyn asks for an error and a step size: a step with such a
result is repeated with half its size, down to the smallest one, where it ends the run.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, NodeIndex
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.run.newton_limits import ForceTolerance, GapLimit
from exudyn_ehd.coupling.watch import solver_state

UserFunction: TypeAlias = Callable[[exu.MainSystem, float, int, int], object]
"""Exudyn's user function before a residual: system, time, Newton iteration, discontinuous iteration."""
# Largest change of the accelerations from step to step with which they count as lasting, share of the last ones.
LARGEST_CHANGE = 0.5
# Largest change of their change with which they go on in a line, share of their change.
LARGEST_BEND = 0.1
# Largest change of the opening of constraints from step to step, share of beta h^2 times the largest acceleration.
LARGEST_JUMP = 3e-5
# Error for Exudyn's discontinuous iterations that makes Newton's method take another pass.
GO_ON = 1e100, -1.0
PostNewton: TypeAlias = Callable[[exu.MainSystem, float], Sequence[float]]
"""Exudyn's user function after Newton's method: system and time to [error, recommended step size or -1]."""
# Beyond any tolerance of Exudyn's discontinuous iterations.
REFUSED = 1e100


class StartGuess:
    """Pre-Newton user function of a system that sets the start of Newton's method and keeps it within the films.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    limit : GapLimit
    tolerance : ForceTolerance
    before : callable or None
        The user's own function, called after it.
    bushes : collection of int
        Numbers of the nodes that hold the deformation of bushes: without inertia they follow the film at once.
    """

    def __init__(
        self,
        mbs: exu.MainSystem,
        limit: GapLimit,
        tolerance: ForceTolerance,
        before: UserFunction | None,
        bushes: Collection[int] = (),
    ) -> None:
        self.limit = limit
        self.tolerance = tolerance
        self.before = before
        self.old_solver = mbs.sys.get("dynamicSolver")
        self.bushes = bushes
        self.additive = self.groups = np.empty(0)
        self.start = np.nan
        self.attempts = 0
        self.past: list[tuple[float, np.ndarray]] = []
        self.ended: list[np.ndarray] = []
        self.guess: np.ndarray | None = None

    def __call__(self, mbs: exu.MainSystem, t: float, iteration: int, discontinuous: int) -> None:
        solver = mbs.sys.get("dynamicSolver")
        # a stored solver outlives its run
        if solver is not self.old_solver and isinstance(solver, exu.MainSolverImplicitSecondOrder):
            if iteration > 0:
                # to shorten a step films leave the state that they were evaluated at
                self.tolerance.limit(solver, iteration)
                self.limit.shorten(mbs, self.additive)
            else:
                if discontinuous == 0:
                    self._set_start(mbs, solver)
                elif self.ended:
                    for values, ended in zip(motion(mbs), self.ended, strict=True):
                        values[:] = ended
                self.limit.start(mbs)
        if self.before is not None:
            self.before(mbs, t, iteration, discontinuous)

    def keep(self, mbs: exu.MainSystem) -> None:
        """Let a further pass of the step start where this one has ended."""
        self.ended = [values.copy() for values in motion(mbs)]

    def _set_start(self, mbs: exu.MainSystem, solver: exu.MainSolverImplicitSecondOrder) -> None:
        data = mbs.systemData
        start = data.GetTime(START_OF_STEP)
        if not self.past:
            # not before the run: Exudyn's solver assembles a system that is not
            self.additive, self.groups = additive_coordinates(mbs), coordinate_groups(mbs, self.bushes)
        if start != self.start:
            now = np.array(data.GetODE2Coordinates_tt(START_OF_STEP), dtype=float)
            self.past = [*self.past[-2:], (start, now)]
            expected = lasting(self.past, self.groups)
            self.guess = None if expected is None else expected * self.additive
            self.start, self.attempts = start, 0
            self.tolerance.set(mbs, solver)
        self.attempts += 1
        # a step that was refused is tried from Exudyn's start and from this one in turns
        if self.guess is None or self.attempts % 2 == 0:
            return
        h = solver.it.currentStepSize
        change = (1.0 - solver.alphaF) / (1.0 - solver.alphaM) * self.guess
        places, velocities, accelerations = motion(mbs)
        places += solver.newmarkBeta * h * h * change
        velocities += solver.newmarkGamma * h * change
        accelerations += self.guess


class ConstraintJumps:
    """User function after Newton's method that lets it go on where constraints have opened or closed at a jump.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    settings : exudyn.SimulationSettings
        Settings of the run.
    start : StartGuess
        Told where every pass has ended.
    before : callable or None
        The user's own function, called first.
    """

    def __init__(
        self, mbs: exu.MainSystem, settings: exu.SimulationSettings, start: StartGuess, before: PostNewton | None
    ) -> None:
        self.start_guess, self.before = start, before
        self.old_solver = mbs.sys.get("dynamicSolver")
        self.by_velocities = settings.timeIntegration.generalizedAlpha.useIndex2Constraints
        self.start = np.nan
        self.accepted = self.latest = np.zeros(1)

    def __call__(self, mbs: exu.MainSystem, t: float) -> list[float]:
        error, size = (0.0, -1.0) if self.before is None else self.before(mbs, t)
        solver, data = mbs.sys.get("dynamicSolver"), mbs.systemData
        if solver is self.old_solver or not isinstance(solver, exu.MainSolverImplicitSecondOrder):
            return [error, size]
        self.start_guess.keep(mbs)
        # Exudyn's type stubs forget the method's own argument
        known: Any = solver
        opening = np.asarray(known.GetSystemResidual())[data.ODE2Size() + data.ODE1Size() :]
        if not opening.size:
            return [error, size]
        start = data.GetTime(START_OF_STEP)
        if start != self.start:
            self.start, self.accepted = start, self.latest
        self.latest = opening
        if error > 0.0 or solver.it.discontinuousIteration > 0:
            return [error, size]
        h = solver.it.currentStepSize
        reach = solver.newmarkGamma * h if self.by_velocities else solver.newmarkBeta * h * h
        largest = LARGEST_JUMP * reach * np.abs(data.GetODE2Coordinates_tt()).max(initial=0.0)
        return list(GO_ON) if np.abs(opening - self.accepted).max() > largest else [error, size]


def motion(mbs: exu.MainSystem) -> list[np.ndarray]:
    """Coordinates of second order, velocities and accelerations now, not copied."""
    state = mbs.systemData.GetSystemStateDict(CURRENT, True)
    return [state[name] for name in ("ODE2Coords", "ODE2Coords_t", "ODE2Coords_tt")]


def lasting(past: Sequence[tuple[float, np.ndarray]], groups: np.ndarray) -> np.ndarray | None:
    """Predict the accelerations of the next step from those of the last steps.

    Parameters
    ----------
    past : sequence of (float, (n,) array)
        Times and accelerations, oldest first.
    groups : (n,) array of int
        Number of the group that a coordinate belongs to; each is judged by itself.

    Returns
    -------
    (n,) array or None
        Zero in groups in which nothing lasts; None where there is but one step.
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


def additive_coordinates(mbs: exu.MainSystem) -> np.ndarray:
    """Return a mask (n,) of the second-order coordinates: one where displacements add, zero for Lie-group rotations."""
    mask = np.ones(len(mbs.systemData.GetODE2Coordinates()))
    for number in range(mbs.systemData.NumberOfNodes()):
        node = NodeIndex(number)
        kind = mbs.GetNode(node)["nodeType"]
        if "LG" in kind or "LieGroup" in kind:
            first = mbs.GetNodeODE2Index(node)
            mask[first + 3 : first + 6] = 0.0
    return mask


def coordinate_groups(mbs: exu.MainSystem, bushes: Collection[int]) -> np.ndarray:
    """Group (n,) of every second-order coordinate: deformations of a body one each, everything else together."""
    groups = np.zeros(len(mbs.systemData.GetODE2Coordinates()), dtype=np.intp)
    for number in range(mbs.systemData.NumberOfNodes()):
        node = NodeIndex(number)
        values = mbs.GetNode(node)
        if values["nodeType"] == "GenericODE2" and number not in bushes:
            first = mbs.GetNodeODE2Index(node)
            groups[first : first + values["numberOfODE2Coordinates"]] = 1 + groups.max()
    return groups


class StepRefusal:
    """User function after Newton's method.

    Parameters
    ----------
    films : sequence of FilmElement
        Elements of all joints of a system.
    before : callable or None
        The user's own function, called first.
    """

    def __init__(self, films: Sequence[FilmElement], before: PostNewton | None) -> None:
        self.films, self.before = films, before

    def __call__(self, mbs: exu.MainSystem, t: float) -> list[float]:
        error, size = (0.0, -1.0) if self.before is None else self.before(mbs, t)
        if all(film.has_result() for film in self.films):
            return [error, size]
        solver = mbs.sys.get("dynamicSolver")
        if solver is None or not solver_state.can_reject_step(solver):
            return [error, size]
        half = 0.5 * solver.it.currentStepSize
        return [REFUSED, half if size < 0.0 else min(size, half)]
