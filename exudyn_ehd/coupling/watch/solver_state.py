"""State of the calling Exudyn solver: its kind, and whether it can reject a step."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, TypeAlias, cast

import exudyn as exu

from exudyn_ehd.coupling.contract import CURRENT
from exudyn_ehd.status import InputError

Solver: TypeAlias = exu.MainSolverImplicitSecondOrder | exu.MainSolverStatic | exu.MainSolverExplicit
Stored: TypeAlias = tuple[Solver | None, Solver | None]
# Before the first run: not even no solver is the same object.
NO_RUN: Stored = (cast(Solver, object()), cast(Solver, object()))


def stored_solvers(mbs: exu.MainSystem) -> Stored:
    """The solver objects that Exudyn's SolveDynamic and SolveStatic left in ``mbs.sys``; new ones for every run."""
    stored = mbs.sys
    return stored.get("dynamicSolver"), stored.get("staticSolver")


def running_solver(before: Stored, now: Stored) -> Solver | None:
    """The solver at work, from the stored ones at the run before and now; None if it was not stored in ``mbs.sys``.

    A stored solver outlives its run, and one that an exception has ended looks as if it were still at work: what tells
    is that the object is a new one.
    """
    changed = [solver for old, solver in zip(before, now, strict=True) if solver is not None and solver is not old]
    working = [solver for solver in changed if not solver.output.finishedSuccessfully]
    # two new ones: the other was run without this joint being asked, and is not initialised or has stopped its timer
    return min(working, key=lambda solver: solver.timer.total, default=None)


def warn_unknown(name: str) -> None:
    """Warn that steps of the joint ``name`` are taken by a solver that is none of the stored ones."""
    warnings.warn(
        f"LubricatedJoint '{name}': the solver at work is not in mbs.sys: its films take velocities as they are, which "
        "lets journals drift at coarse steps, and a step without a film ends the run where a smaller one might do. Use "
        "ehd.SolveDynamic, mbs.SolveDynamic without storeSolver=False, or mbs.sys['dynamicSolver'] = solver before a "
        "run of a solver of your own.",
        stacklevel=2,
    )


def is_static(solver: Solver | None) -> bool:
    """Return whether ``solver`` is a static one: its time is a load parameter."""
    return isinstance(solver, exu.MainSolverStatic)


def is_explicit(solver: Solver | None) -> bool:
    """Return whether ``solver`` is an explicit integrator."""
    return isinstance(solver, exu.MainSolverExplicit)


def is_implicit(solver: Solver | None) -> bool:
    """Return whether ``solver`` is implicit: forces at the end of a step, coordinates by a second-order rule."""
    return isinstance(solver, exu.MainSolverImplicitSecondOrder)


def is_finished(solver: Solver | None) -> bool:
    """Return whether the run of ``solver`` has ended successfully; True without a solver, False after a failed run."""
    return solver is None or bool(solver.output.finishedSuccessfully)


def require_end(where: str, mbs: exu.MainSystem, solver: Solver | None) -> None:
    """Raise `InputError` where a system is not as a run of ``solver`` that has come to its end has left it."""
    time = mbs.systemData.GetTime(CURRENT)
    if solver is not None and is_finished(solver) and time != solver.it.currentTime:
        raise InputError(
            f"{where}: the system is at t = {time:.9g} s, and its last run has ended at {solver.it.currentTime:.9g} s: "
            "its state was changed since (ComputeLinearizedSystem, Assemble, another solve); read or store it right "
            "behind the run."
        )


def can_reject_step(solver: Solver | None) -> bool:
    """Return whether ``solver`` is running and can repeat the step with a smaller size if a force is nan.

    Implicit and static solvers can, down to their smallest step size. Explicit ones would accept the nan, and initial
    accelerations (step size zero) can't be repeated.
    """
    if solver is None or is_explicit(solver) or is_finished(solver) or solver.timer.total >= 0.0:
        return False
    # iteration data, not the settings: the solver's own copy is what decides
    iteration = solver.it
    return bool(iteration.adaptiveStep) and iteration.currentStepSize > iteration.minStepSize * (1.0 + 1e-6)


def user_function(mbs: exu.MainSystem, moment: str) -> Any:
    """The user's own function at a moment of the solver, e.g. ``"PostNewton"``; 0, as Exudyn takes it, for none."""
    found = getattr(mbs, f"Get{moment}UserFunction")()
    function = found["function"] if isinstance(found, dict) else found
    return function if callable(function) else 0


def idle(moment: str) -> Callable[..., Any]:
    """Return a user function for a moment of the solver that changes nothing."""
    return lambda *_: (0.0, -1.0) if moment == "PostNewton" else True


@contextmanager
def hooked(mbs: exu.MainSystem, moment: str, function: Callable[..., object]) -> Iterator[None]:
    """Put a function in the place of the user's own at a moment of the solver, within; the user's comes back then.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    moment : str
        As in the names of Exudyn's functions, e.g. ``"PostNewton"``.
    function : callable
        It gets the function in whose place it stands, which it has to call, before Exudyn's arguments.
    """
    own = user_function(mbs, moment)
    put = getattr(mbs, f"Set{moment}UserFunction")
    put(partial(function, own or idle(moment)))
    try:
        yield
    finally:
        put(own)
