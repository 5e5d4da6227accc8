"""The residual of a system, with its nodal bushes' part beside Exudyn's.

Exudyn hands a user function its coordinates as lists, and multiplies a constant mass entry by entry: of a mesh of 6000
coordinates that takes three times as long as the mesh's forces. While a residual is made the bushes' forces and masses
are therefore out of Exudyn's sums, and come to them afterwards, scaled as Exudyn scales,

    r_b += beta h^2 (M q_tt - f).

That goes for bushes without a carrier, whose object is as it was made. Exudyn keeps the mass matrix of a system in
which all are constant, and asks every object in each residual otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.bush.equations import BushFunctions
from exudyn_ehd.coupling.contract import CURRENT, Index, ObjectIndex
from exudyn_ehd.coupling.items.object_mass import as_sparse

# Exudyn's stubs lack the self of its solvers' methods.
Solver: TypeAlias = Any
# Bodies whose mass matrices are constant, and the beginnings of what is no body. Others may be so, too.
_LASTING = ("Ground", "MassPoint", "MassPoint2D", "Mass1D", "RotationalMass1D")
_MASSLESS = ("Connector", "Contact", "Joint")


class BushResiduals:
    """Residuals of a system in a run.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        Assembled.
    bushes : sequence of (index, (n,) array of int, BushFunctions)
        Objects of nodal bushes, the places of their coordinates in the system's, and their functions.

    Attributes
    ----------
    vector : (n,) array
        The last residual, which Exudyn's solver has without the bushes' part.
    """

    def __init__(self, mbs: exu.MainSystem, bushes: list[tuple[Index, np.ndarray, BushFunctions]]) -> None:
        self.bushes = [
            (item, _together(places), functions, mbs.GetObjectParameter(item, "massMatrix"))
            for item, places, functions in bushes
            if _as_made(mbs, item, places, functions)
        ]
        self.taken, self.vector = False, np.zeros(0)
        self.lasting = all(_lasting(mbs.GetObject(ObjectIndex(i))) for i in range(mbs.systemData.NumberOfObjects()))

    @contextmanager
    def without_masses(self, mbs: exu.MainSystem, solver: Solver, settings: exu.SimulationSettings) -> Iterator[None]:
        """Within, Exudyn's mass matrix of the system lacks the bushes' after the first time, or altogether."""
        lasting = self.lasting and settings.timeIntegration.reuseConstantMassMatrix
        if not self.bushes or (lasting and self.taken):
            yield
            return
        self.taken = True
        for item, *_ in self.bushes:
            mbs.SetObjectParameter(item, "massMatrix", exu.MatrixContainer())
        try:
            solver.ComputeMassMatrix(mbs)
            if not lasting:
                yield
        finally:
            for item, _, _, mass in self.bushes:
                mbs.SetObjectParameter(item, "massMatrix", mass)
        if lasting:
            yield

    def __call__(self, solver: Solver, mbs: exu.MainSystem, settings: exu.SimulationSettings) -> float:
        """Compute the solver's residual like its ``ComputeNewtonResidual``, and return its measure."""
        if not self.bushes:
            error = solver.ComputeNewtonResidual(mbs, settings)
            self.vector = np.array(solver.GetSystemResidual())
            return error
        for item, *_ in self.bushes:
            mbs.SetObjectParameter(item, "forceUserFunction", 0)
        try:
            solver.ComputeNewtonResidual(mbs, settings)
        finally:
            for item, _, bush, _ in self.bushes:
                mbs.SetObjectParameter(item, "forceUserFunction", bush.force)
        data, scale = mbs.systemData, solver.newmarkBeta * solver.it.currentStepSize**2
        state = data.GetSystemStateDict(CURRENT, True)
        motion = [state[name] for name in ("ODE2Coords", "ODE2Coords_t", "ODE2Coords_tt")]
        residual, n = np.array(solver.GetSystemResidual()), len(motion[0])
        for item, places, bush, _ in self.bushes:
            q, q_t, q_tt = (values[places] for values in motion)
            bush.watch(mbs, int(item), places)
            residual[places] += scale * (bush.equations.inertia(q_tt) - bush.equations.force(data.GetTime(), q, q_t))
        self.vector = residual
        return float(np.hypot(np.linalg.norm(residual[:n]) / scale, np.linalg.norm(residual[n:]))) / (
            solver.conv.errorCoordinateFactor
        )


def _together(places: np.ndarray) -> np.ndarray | slice:
    """Places that follow each other as a slice, which copies nothing."""
    return slice(places[0], places[-1] + 1) if (np.diff(places) == 1).all() else places


def _as_made(mbs: exu.MainSystem, item: Index, places: np.ndarray, bush: BushFunctions) -> bool:
    """Return whether a bush has no carrier and still has the force and mass with which it was created."""
    force: object = mbs.GetObjectParameter(item, "forceUserFunction")
    if bush.equations.carrier is not None or not isinstance(force, dict) or force["function"] != bush.force:
        return False
    mass = as_sparse(mbs.GetObjectParameter(item, "massMatrix"))
    return mass is not None and mass.shape[0] == len(places) and abs(mass - bush.equations.mass(None)).max() == 0.0


def _lasting(values: dict) -> bool:
    """Return whether an object has a constant mass matrix or none."""
    if values["objectType"] == "GenericODE2":
        return not values["massMatrixUserFunction"]
    return values["objectType"] in _LASTING or values["objectType"].startswith(_MASSLESS)
