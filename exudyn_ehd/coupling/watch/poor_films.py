"""Films that run dry, are too thin for their surfaces, too steep for their grid, or carry too little.

Films that run dry conserve mass, oil leaves them through the ends, and nothing brings it back.

In a flooded film the cavity's void takes some 0.4 of ``1 - smallest gap / mean gap``, as a share of the film's volume.
What the load squeezes out beyond it costs load: 10 % at a void of 0.55, 0.7 and 0.85 of it (eccentricity ratios 0.3,
0.6 and 0.9), which at a given eccentricity comes within one or two turns, and soon all. Under a given load the journal
sinks.

Films thinner than the surfaces are rough, where the bearing says nothing about rough surfaces or contact.

Films whose pressure peak the grid does not resolve (`exudyn_ehd.joint.balance.resolution`), at the highest pressure.

Films that carry so little that Newton's absolute tolerance is a share of it.
"""

from __future__ import annotations

import math
import warnings

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.record.summary import spins
from exudyn_ehd.coupling.watch.solver_state import Solver
from exudyn_ehd.joint.balance.resolution import Resolution, coarse_film, is_judged, resolution
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.joint.static.steady import MORE_OIL
from exudyn_ehd.status import ROUNDING, SMALL, GridWarning, StarvationWarning, ThinFilmWarning

# Void of a starved film over ``1 - smallest gap / mean gap``, and the least one that counts: shares of the volume.
STARVED, LEAST = 0.6, 0.1
# Roughness of a good surface, m; surfaces of the smallest bearings are as much finer as these are smaller.
GOOD_SURFACE, CLEARANCE_SHARE = 0.2e-6, 0.05
# Pressure over the highest one yet from which on the grid is looked at again. Larger: of a lower peak; smaller: dearer.
HIGHER = 1.02
# Tolerance over the mean force of a run from which on it is told.
LOOSE = 1e-3


def lost_share(history: History) -> float:
    """Share of its oil that a starved film has lost; 0 if it is not starved."""
    if history.void is None or history.mass is None:
        return 0.0
    # the ends are full, whatever the film
    void = history.void[:, 1:-1]
    gap = void + history.mass[:, 1:-1]
    lost, smallest = float(np.mean(void) / np.mean(gap)), float(np.min(gap) / np.mean(gap))
    return lost if lost > max(LEAST, STARVED * (1.0 - smallest)) else 0.0


def warn_of_starvation(name: str, time: float, lost: float) -> None:
    """Warn that the film of the joint ``name`` is starved."""
    warnings.warn(
        f"LubricatedJoint '{name}': at t = {time:.9g} s {100.0 * lost:.0f} % of the film's oil has left through the "
        "ends: with ElrodAdams and neither a supply nor ends above the cavity pressure none comes back, and the film "
        f"carries less and less; {MORE_OIL[:-1]}, or SwiftStieber() for a bearing that stays flooded.",
        StarvationWarning,
        stacklevel=2,
    )


def smooth_limit(bearing: JournalBearing) -> float:
    """Minimum film thickness below which a smooth film is none, m; -inf where the bearing models what touches."""
    if any(getattr(bearing, name, None) is not None for name in ("asperity", "contact")):
        return -math.inf
    return min(GOOD_SURFACE, CLEARANCE_SHARE * bearing.radial_clearance)


def warn_of_thin_film(name: str, time: float, gap: float, tilting: str) -> None:
    """Warn that the film of the joint ``name`` is thinner than its surfaces are rough; ``tilting`` is advised first."""
    warnings.warn(
        f"LubricatedJoint '{name}': at t = {time:.9g} s the minimum film thickness is {1e6 * gap:.3g} um, less than "
        "the roughness of a good surface: real surfaces touch there, and pressure, friction and film are those of "
        f"perfectly smooth ones; {tilting}give the bearing asperity=GreenwoodTripp(...) and roughness=PatirCheng(...), "
        "contact=RegularisedWall(onset=...) if surfaces only just touch, or check load, clearance and viscosity.",
        ThinFilmWarning,
        stacklevel=2,
    )


class GridWatch:
    """Watch of one run for a grid that does not resolve the pressure peak, there where that is highest."""

    def __init__(self) -> None:
        self._peak = 0.0
        self._coarse: tuple[float, Resolution] | None = None

    def take(self, time: float, peak: float, film: object) -> None:
        """Take an accepted step's film of a peak pressure, Pa."""
        if not (peak > HIGHER * self._peak and isinstance(film, SolvedFilm)):
            return
        if is_judged(film):
            self._peak, found = peak, resolution(film)
            self._coarse = (time, found) if found.is_coarse else None

    def tell(self, name: str) -> None:
        """Warn, once, at the end of the run of the joint ``name``."""
        if self._coarse is not None:
            (time, found), self._coarse = self._coarse, None
            where = f"LubricatedJoint '{name}': at t = {time:.9g} s, at its highest pressure"
            warnings.warn(coarse_film(found, where), GridWarning, stacklevel=2)


def warn_of_tiny_forces(
    name: str, solver: Solver | None, given: float | None, bearing: object, history: JointHistory
) -> None:
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
            f"LubricatedJoint '{name}': Newton's absolute tolerance of {left:.2g} N is {100.0 * left / force:.2g} % of "
            f"the film's mean load of {force:.2g} N, so that its forces may be off by as much; use "
            f"ConfigureSolver(simulationSettings, absoluteTolerance={SMALL * force:.0e}).",
            stacklevel=2,
        )
