"""User options for the steps, and the rejection of steps too coarse for a film, through Exudyn's own control.

`exudyn_ehd.coupling.run.step_size` chooses steps by their error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Trial
from exudyn_ehd.coupling.kinematics.relative import BoreGap
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import InputError, require_number, require_type

ROUGHNESSES = 4.0
LARGEST_GAP_CHANGE = 0.25


@dataclass(frozen=True, kw_only=True)
class StepControl:
    """Step control of a run: limit the change of the gap in a step, or choose steps by the error that they make.

    **Of a joint** (``CreateLubricatedJoint(stepControl=StepControl(largest_gap_change=0.1))``): for journals that fall
    onto a contact. Newton's method may converge for a step in which the journal falls from the centre onto its contact,
    or crosses the contact's range at once: the motion is then wrong, without a sign. With the control Exudyn halves a
    step in which the gap changes by more than the limit, and doubles the step again after some good ones
    (``adaptiveStep...`` of its settings). Newton's iterates count too, so that accepted steps end well below the limit.
    At Exudyn's smallest step size every step is accepted. Explicit and static solvers ignore the control.

    **Of a run** (``SolveDynamic(mbs, simulationSettings, stepControl=StepControl(error=0.02))``, `SolveDynamicSparse`
    alike): for loads in bursts. Steps grow and shrink so that the estimated error of the gaps of all joints,
    ``history.step_error``, stays near ``error``; a step with a far larger error is repeated with a smaller size.
    ``numberOfSteps`` of the settings still counts: it gives a reference step, the run's duration over it. The first
    step is an eighth of that, the largest is four times as long. Steps also end at the times at which solution file and
    sensors are written (``writePeriod``).

    Write user functions of loads that depend on time alone: they are called again at earlier times within a step, to
    find jumps. A pulse is found if it lasts a sixteenth of its step. Impacts, and loads that are set from step to step,
    are not seen if they come and go within one step: let the shortest one last five steps.

    Parameters
    ----------
    largest_gap_change : float, default 0.25
        Of a joint: largest change of the minimum gap of the rigid surfaces in a step, over that gap at the start of the
        step (or over the contact's range, if that is larger); the same for the end faces; 0.01 to 1.
    error : float or None, default None
        Of a run: error of the gap to aim at, over the minimum film thickness; 1e-4 to 0.5. The gaps of end faces do not
        count: their films have no estimate.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> mbs.Assemble()
    >>> ehd.SolveDynamic(mbs, settings, stepControl=ehd.StepControl(error=0.02))
    True
    >>> bool(np.nanmax(joint.history.step_error) < 0.05)
    True
    """

    largest_gap_change: float = LARGEST_GAP_CHANGE
    error: float | None = None

    def __post_init__(self) -> None:
        require_number("StepControl.largest_gap_change", self.largest_gap_change, at_least=0.01)
        if self.largest_gap_change > 1.0:
            raise InputError(
                f"StepControl.largest_gap_change must be between 0.01 and 1, got {self.largest_gap_change!r}; leave "
                "the control out with stepControl=None."
            )
        if self.error is not None:
            require_number("StepControl.error", self.error, at_least=1e-4, at_most=0.5)
            if self.largest_gap_change != LARGEST_GAP_CHANGE:
                raise InputError(
                    "StepControl: error is for a whole run, largest_gap_change for one joint; give one StepControl to "
                    "SolveDynamic and another to CreateLubricatedJoint."
                )


def require_of_joint(where: str, control: object) -> None:
    """Refuse what is no control of a joint's steps; None is none."""
    require_type(where, control, StepControl, type(None))
    if isinstance(control, StepControl) and control.error is not None:
        raise InputError(
            f"{where}: StepControl.error sets the steps of a whole run; give it to ehd.SolveDynamic(mbs, "
            "simulationSettings, stepControl=...) or SolveDynamicSparse (mbs.SolveDynamic has no control of errors)."
        )


class GapWatch:
    """A `StepControl` at work on one joint.

    Parameters
    ----------
    control : StepControl
    bearing : JournalBearing
    """

    def __init__(self, control: StepControl, bearing: JournalBearing) -> None:
        self.share = control.largest_gap_change
        self.bore = BoreGap(bearing)
        ranges = [SMALLEST_GAP_SHARE * bearing.radial_clearance]
        if bearing.contact is not None:
            ranges.append(bearing.contact.onset)
        if bearing.asperity is not None:
            ranges.append(ROUGHNESSES * bearing.asperity.composite_roughness)
        self.range = max(ranges)
        faces, self.range_of_faces = getattr(bearing, "thrust", None), 0.0
        if faces is not None:
            least = SMALLEST_GAP_SHARE * faces.clearance
            self.range_of_faces = least if faces.contact is None else faces.contact.onset
        self.gap = self.film = self.face = np.nan

    def start(self, trial: Trial, film: float | None) -> None:
        """Remember the gaps at the start of a step; ``film`` is that of a film in a worn or soft bore."""
        self.gap = self.bore.smallest(trial.motion)
        self.film = self.gap if film is None else film
        self.face = np.nan if trial.faces is None else trial.faces.minimum_gap

    def rejects(self, trial: Trial, solver: solver_state.Solver | None) -> bool:
        """Return whether the step to this state is too coarse and can be repeated."""
        # not true for a gap that is not finite: the film itself reports that
        change = abs(self.bore.smallest(trial.motion) - self.gap)
        too_far = change > self.share * max(self.film, self.range)
        if trial.faces is not None:
            change = abs(trial.faces.minimum_gap - self.face)
            too_far = too_far or change > self.share * max(self.face, self.range_of_faces)
        return bool(too_far and solver_state.is_implicit(solver) and solver_state.can_reject_step(solver))
