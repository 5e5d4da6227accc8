"""Newton's method kept within the films, and its tolerances.

Exudyn's Newton method takes its steps whole. A film hardens towards the wall as 1 / gap^3 and more, and where it is
hollow, or opens, it has hardly any stiffness: a step from there goes through the wall, where the film can't be
evaluated or pushes back with 1e12 N, and the time step is halved for no fault of its own. From the thin side Newton's
method converges step by step, from the thick side it overshoots. None of its steps may therefore close more than half
of a film (the fraction to the boundary of interior point methods). With the ends of the journal's axis at p, moved by
d, and the gap g = c - max |p| before, the part s of the step that is taken holds

    |p + s d| <= c - g / 2,   s = (sqrt((p d)^2 + d^2 ((c - g / 2)^2 - p^2)) - p d) / d^2,

the smallest s of all films and ends. Coordinates, velocities and accelerations satisfy Newmark's formulas one by one,
after a part of a step too: the solution stays what it is. Rotations of Lie groups don't add up, and keep their step.
Films thinner than a thousandth of the clearance, on a contact, are left alone. Flexible bores are judged as undeformed:
a journal that presses into one is free beyond the clearance, and on the way there the steps are a few more or fewer.

With a pressure law a film has another end: velocities v of the journal's axis at which no finite pressure carries it.
The law's line behind that end is flatter than the law in front of it, so that Newton's method may jump from one side to
the other and back for ever. Where it was behind the end, at v_b, and has come back to v, a step goes no more than half
of the way there, d (v_b - v) <= |v_b - v|^2 / 2: a bisection, until Newton's method converges.

Newton's tolerances in the measure of the films' and bushes' forces.

Exudyn's Newton method ends where the residual is a share of the step's first one, or below an absolute tolerance. A
start close to the solution makes the first residual so small that a share of it is below what positions resolve: metres
from the origin, or under meganewtons, a film's force has the rounding of the position times its stiffness, 1e-9 of
itself and more. The step would be halved for nothing. From Exudyn's own start the first residual is about as large as
the forces, so that its tolerance is a share of these; here too, with a tenth of it. The forces within a nodal bush, in
a film or not, have the rounding of its displacements times the stiffness of its elements.

Where no start is known, as in the first step, the first positions may lie deep in a contact, with forces of films and a
residual millions of times those at the end: a share of it would let any state pass. As the films' forces fall below
their first ones in a step, the relative tolerance shrinks alike. Residuals of other parts do not count.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.bush.equations import BushEquations
from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, ObjectIndex, Trial
from exudyn_ehd.coupling.element.presence import force_owner
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics.relative import BoreGap, levers_of
from exudyn_ehd.joint.balance.newton import part_that_closes
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import SMALL, Status

# Share of a film's gap that a step of Newton's method may close.
SHARE = 0.5
# Share of the relative tolerance times the films' forces.
FORCE_SHARE = 0.1


class GapLimit:
    """Takes back what a step of Newton's method closes too much.

    Parameters
    ----------
    films : collection of FilmElement
        Elements of all joints of a system.
    """

    def __init__(self, films: Collection[FilmElement]) -> None:
        self.films = films
        self.bores = {film: BoreGap(film.model.bearing) for film in films}
        self.before: list[np.ndarray] = []
        # last motions behind the end of the films' pressure laws
        self.behind: dict[FilmElement, np.ndarray] = {}

    def start(self, mbs: exu.MainSystem) -> None:
        """Remember where Newton's method starts."""
        self.before = [values.copy() for values in state_of(mbs)]
        self.behind.clear()

    def shorten(self, mbs: exu.MainSystem, additive: np.ndarray) -> None:
        """Shorten the step that Newton's method has taken, where it closes a film by more than `SHARE`.

        Parameters
        ----------
        mbs : exudyn.MainSystem
            Holds the state after the step.
        additive : (n,) array
            Zero at the coordinates that keep their step, one elsewhere.
        """
        part = 1.0
        for film in self.films:
            last = film.last
            if last is not None:
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
        """Part of a step from in front of the end of a film's law that goes half of the way back behind it."""
        bearing = film.model.bearing
        if last.status == Status.NO_PRESSURE and bearing.yielding is None:
            self.behind[film] = last.bodies
        elif film in self.behind:
            return _allowed_towards(self.behind[film], last.bodies, after, levers_of(bearing))
        return 1.0


def allowed_part(bore: BoreGap, before: np.ndarray, after: np.ndarray) -> float:
    """Part of a step between two motions that closes the film of the rigid surfaces by `SHARE`, 1 if none does.

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
    """Part of a step between two motions that goes half of the way to the velocities of a third one, 1 if none does."""
    way, step = levers * (other - before)[4:8], levers * (after - before)[4:8]
    half, along = 0.5 * float(way @ way), float(way @ step)
    return half / along if along > half else 1.0


def state_of(mbs: exu.MainSystem) -> list[np.ndarray]:
    """Coordinates of second order, velocities, accelerations and multipliers now, as Exudyn holds them: not copied."""
    state = mbs.systemData.GetSystemStateDict(CURRENT, True)
    return [state[name] for name in ("ODE2Coords", "ODE2Coords_t", "ODE2Coords_tt", "AECoords")]


class ForceTolerance:
    """Sets the tolerances of a running solver, which are its own: settings stay.

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
        return math.hypot(*(force for film in self.films for force in _force(film.last)))


def free_bushes(mbs: exu.MainSystem) -> list[BushEquations]:
    """Nodal bushes of a system that neither supports nor a carrier hold."""
    return [bush for bush, _ in _bushes(mbs) if bush.carrier is None and not bush.held.any()]


def _bushes(mbs: exu.MainSystem) -> list[tuple[BushEquations, np.ndarray]]:
    owners = ((force_owner(mbs, number), number) for number in range(mbs.systemData.NumberOfObjects()))
    data = mbs.systemData
    return [(o, np.array(data.GetObjectLTGODE2(ObjectIndex(n)))) for o, n in owners if isinstance(o, BushEquations)]


def _force(trial: Trial | None) -> list[float]:
    if trial is None or trial.evaluation is None or trial.status != Status.CONVERGED:
        return []
    return trial.evaluation.wrench[:3].tolist()
