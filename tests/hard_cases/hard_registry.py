"""The named set of hard cases.

A case is a function that builds scenes, runs them through Exudyn, asserts the physics and returns the runs whose
counts go into the table. Its docstring tells what is hard. ``rejected`` and ``newton`` are the largest numbers
of rejected steps and of Newton iterations per accepted step that its runs may take together; both are asserted.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Sequence

from hard_scene import Run


@dataclasses.dataclass(frozen=True, kw_only=True)
class HardCase:
    """One entry of the set.

    Attributes
    ----------
    name, story : str
        Title in the table; what is hard about it.
    run : callable
        Runs the scenes and asserts their physics.
    rejected : int
        Largest number of rejected steps.
    newton : float
        Largest number of Newton iterations per accepted step.
    slow : bool
        Longer than a third of a second, or another case has most of it.
    """

    name: str
    story: str
    run: Callable[[], Run | Sequence[Run]]
    rejected: int
    newton: float
    slow: bool


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """Counts of one case over all its runs."""

    case: HardCase
    minimum_gap: float
    steps: int
    rejected: int
    newton: float
    seconds: float


CASES: list[HardCase] = []


def hard_case(name: str, *, rejected: int = 0, newton: float = 4.0, slow: bool = False) -> Callable:
    """Decorator that enters a function into the set."""

    def enter(function: Callable) -> Callable:
        story = " ".join((function.__doc__ or "").split())
        assert story, f"{name}: tell what is hard"
        assert name not in {case.name for case in CASES}, name
        CASES.append(HardCase(name=name, story=story, run=function, rejected=rejected, newton=newton, slow=slow))
        return function

    return enter


def perform(case: HardCase) -> Outcome:
    """Run a case, check its counts and return them."""
    start = time.process_time()
    result = case.run()
    seconds = time.process_time() - start
    runs = [result] if isinstance(result, Run) else list(result)
    assert runs
    steps = sum(run.steps for run in runs)
    outcome = Outcome(
        case=case,
        minimum_gap=min(run.minimum_gap for run in runs),
        steps=steps,
        rejected=sum(run.rejected for run in runs),
        newton=sum(run.newton for run in runs) / max(steps, 1),
        seconds=seconds,
    )
    assert steps > 0
    assert outcome.rejected <= case.rejected, f"{case.name}: {outcome.rejected} rejected steps, at most {case.rejected}"
    assert outcome.newton <= case.newton, f"{case.name}: {outcome.newton:.2f} iterations a step, at most {case.newton}"
    return outcome


def load_cases() -> list[HardCase]:
    """Import the modules that enter the cases, and return the set."""
    import importlib

    for module in ("contact", "motion", "extremes", "film", "machines", "elastic", "solvers"):
        importlib.import_module(f"hard_{module}")
    return CASES
