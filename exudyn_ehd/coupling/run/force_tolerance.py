"""Newton's absolute tolerance in the measure of the films' forces.

Exudyn's Newton method ends where the residual is a share of the step's first one, or below an absolute tolerance. A
start close to the solution makes the first residual so small that a share of it is below what positions resolve: metres
from the origin, or under meganewtons, a film's force has the rounding of the position times its stiffness, 1e-9 of
itself and more. The step would be halved for nothing. From Exudyn's own start the first residual is about as large as
the forces, so that its tolerance is a share of these; here too, with a tenth of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Protocol

from exudyn_ehd.coupling.contract import Trial
from exudyn_ehd.status import Status

# Share of the relative tolerance times the films' forces.
SHARE = 0.1


class Film(Protocol):
    """A joint's element."""

    @property
    def last(self) -> Trial | None:
        """The state evaluated last."""


class ForceTolerance:
    """Sets the absolute tolerance of a running solver, which is its own: settings stay.

    Parameters
    ----------
    films : sequence of Film
        Elements of all joints of a system.
    """

    def __init__(self, films: Sequence[Film]) -> None:
        self.films = films
        self.given: float | None = None

    def set(self, solver: Any) -> None:
        """At the start of a step, where the films were evaluated last at the end of the step before."""
        newton = solver.newton
        if self.given is None:
            self.given = newton.absoluteTolerance
        # mode 1 measures coordinates
        if newton.residualMode == 0:
            forces = [force for film in self.films for force in _force(film.last)]
            level = math.hypot(*forces) / solver.conv.errorCoordinateFactor
            newton.absoluteTolerance = max(self.given, SHARE * newton.relativeTolerance * level)


def _force(trial: Trial | None) -> list[float]:
    if trial is None or trial.evaluation is None or trial.status != Status.CONVERGED:
        return []
    return trial.evaluation.wrench[:3].tolist()
