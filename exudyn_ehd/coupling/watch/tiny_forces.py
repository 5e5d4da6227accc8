"""Films that carry so little that Newton's absolute tolerance lets them be anything."""

from __future__ import annotations

import warnings

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.record.summary import spins
from exudyn_ehd.coupling.watch.solver_state import Solver

# Tolerance over the mean force of a run from which on it is told, one to take, and the force that is rounding, as a
# share of the film's unit.
LOOSE, CLOSE, ROUNDING = 1e-3, 1e-6, 1e-8


def warn(name: str, solver: Solver | None, given: float | None, bearing: object, history: JointHistory) -> None:
    """Warn where a run with Newton's method has left a share of the forces of the joint ``name``.

    ``given``: the absolute tolerance that was asked for, where the solver has another one.
    """
    if not isinstance(solver, exu.MainSolverImplicitSecondOrder | exu.MainSolverStatic):
        return
    reference_force = getattr(bearing, "reference_force", None)
    if reference_force is None or history.time.size < 2:
        return
    newton = solver.newton
    force = float(np.mean(np.linalg.norm(history.force, axis=1)))
    left = (newton.absoluteTolerance if given is None else given) / solver.conv.errorCoordinateFactor
    unit = reference_force(float(spins(bearing, history).max()))
    if newton.residualMode == 0 and ROUNDING * unit < force < left / LOOSE:
        warnings.warn(
            f"LubricatedJoint '{name}': its film carries {force:.2g} N in the mean, of which Newton's absolute "
            f"tolerance lets {left:.2g} N be anything: ConfigureSolver(simulationSettings, absoluteTolerance="
            f"{CLOSE * force:.0e}).",
            stacklevel=2,
        )
