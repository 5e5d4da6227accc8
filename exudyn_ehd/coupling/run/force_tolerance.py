"""Newton's tolerances in the measure of the films' and bushes' forces.

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
from collections.abc import Sequence
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.bush.equations import BushFunctions
from exudyn_ehd.coupling.contract import START_OF_STEP, ObjectIndex, Trial
from exudyn_ehd.coupling.element.presence import force_owner
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.status import Status

# Exudyn's stubs lack attributes of its solvers
_Solver: TypeAlias = Any
# Share of the relative tolerance times the films' forces.
SHARE = 0.1
# Least part of the relative tolerance that is left.
LEAST_PART = 1e-6


class ForceTolerance:
    """Sets the tolerances of a running solver, which are its own: settings stay.

    Parameters
    ----------
    films : sequence of FilmElement
        Elements of all joints of a system.

    Attributes
    ----------
    bushes : list
        Nodal bushes of the system with the places of their coordinates in its vectors; known from the first step on.
    """

    def __init__(self, films: Sequence[FilmElement]) -> None:
        self.films = films
        self.bushes: list[tuple[BushFunctions, np.ndarray]] = []
        self.given: float | None = None
        self.relative, self.first, self.level = 0.0, 0.0, 0.0

    def set(self, mbs: exu.MainSystem, solver: _Solver) -> None:
        """At the start of a step, where the films were evaluated last at the end of the step before."""
        newton = solver.newton
        if self.given is None:
            self.given, self.relative = newton.absoluteTolerance, newton.relativeTolerance
            self.bushes = _bushes(mbs)
        newton.relativeTolerance = self.relative
        # mode 1 measures coordinates
        if newton.residualMode == 0:
            self.level = self._forces()
            level = SHARE * newton.relativeTolerance * self.level
            if self.bushes:
                state = mbs.systemData.GetSystemStateDict(START_OF_STEP, True)
                reach = abs(state["ODE2Coords"]) + solver.it.currentStepSize * abs(state["ODE2Coords_t"])
                level = max(level, math.hypot(*(bush.equations.rounding(reach[at]) for bush, at in self.bushes)))
            newton.absoluteTolerance = max(self.given, level / solver.conv.errorCoordinateFactor)

    def limit(self, solver: _Solver, iteration: int) -> None:
        """Before an iteration of Newton's method, where the films were evaluated last in the one before."""
        newton = solver.newton
        if self.given is None or newton.residualMode != 0:
            return
        forces = self._forces()
        if iteration == 1:
            self.first = forces
        present = max(forces, self.level)
        part = present / self.first if self.first > present else 1.0
        newton.relativeTolerance = self.relative * max(part, LEAST_PART)

    def _forces(self) -> float:
        return math.hypot(*(force for film in self.films for force in _force(film.last)))


def free_bushes(mbs: exu.MainSystem) -> list[BushFunctions]:
    """Nodal bushes of a system that neither supports nor a carrier hold."""
    return [bush for bush, _ in _bushes(mbs) if bush.equations.carrier is None and not bush.equations.held.any()]


def _bushes(mbs: exu.MainSystem) -> list[tuple[BushFunctions, np.ndarray]]:
    owners = ((force_owner(mbs, number), number) for number in range(mbs.systemData.NumberOfObjects()))
    data = mbs.systemData
    return [(o, np.array(data.GetObjectLTGODE2(ObjectIndex(n)))) for o, n in owners if isinstance(o, BushFunctions)]


def _force(trial: Trial | None) -> list[float]:
    if trial is None or trial.evaluation is None or trial.status != Status.CONVERGED:
        return []
    return trial.evaluation.wrench[:3].tolist()
