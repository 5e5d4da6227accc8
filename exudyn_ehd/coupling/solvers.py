"""Which Exudyn solver is calling, and may it reject a step."""

from __future__ import annotations

from typing import Any

import exudyn as exu

_REJECTING = (exu.MainSolverImplicitSecondOrder, exu.MainSolverStatic)


def stored_solvers(mbs: Any) -> tuple[Any, Any]:
    """The solver objects that Exudyn's SolveDynamic and SolveStatic left in ``mbs.sys``; new ones for every run."""
    stored = mbs.sys
    return stored.get("dynamicSolver"), stored.get("staticSolver")


def running_solver(mbs: Any) -> Any:
    """The solver that is at work, or None if none is, or if it was run without storing it in ``mbs.sys``.

    A stored solver outlives its run. Its total timer holds minus the start time while it works; before that, while it
    computes initial accelerations, it is not initialised yet.
    """
    for solver in stored_solvers(mbs):
        if solver is not None and (solver.timer.total < 0.0 or not solver.output.initializationSuccessful):
            return solver
    return None


def can_reject_step(mbs: Any) -> bool:
    """Whether the running solver answers a nan force by repeating the step with a smaller size, as it still can.

    Implicit and static solvers do, down to their smallest step size; explicit ones would accept the nan, and initial
    accelerations (step size zero) can't be repeated.
    """
    solver = running_solver(mbs)
    if not isinstance(solver, _REJECTING):
        return False
    # iteration data, not the settings: the solver's own copy is what decides
    iteration = solver.it
    return bool(iteration.adaptiveStep) and iteration.currentStepSize > iteration.minStepSize * (1.0 + 1e-6)
