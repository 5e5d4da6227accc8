"""Steps that converge to a film that none bears, refused before Exudyn accepts them.

Newton's method may well converge where there is no film: behind the end of a pressure law, where forces only lead its
iterates back, or at a pressure that no steel bears, into which too large a step has thrown the journal. Its iterates
may pass there; its result may not. After Newton's method Exudyn asks for an error and a step size: a step with such a
result is repeated with half its size, down to the smallest one, where it ends the run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import exudyn as exu

from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.watch import solver_state

PostNewton: TypeAlias = Callable[[exu.MainSystem, float], Sequence[float]]
"""Exudyn's user function after Newton's method: system and time to [error, recommended step size or -1]."""
# Beyond any tolerance of Exudyn's discontinuous iterations.
REFUSED = 1e100


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
