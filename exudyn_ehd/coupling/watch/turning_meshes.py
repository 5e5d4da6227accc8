"""Bodies on absolute coordinates that turn too far in a step: finite elements on points, ANCF beams and cables.

Their nodes move on circles that an integrator's formulas leave: in the first turn a free ring of any wall and material
loses the share

    (0.24 + 1.64 (1 - rho)^3) a^2

of its angular momentum, with the turn a of a step in rad and the spectral radius rho (measured to 15 % of it at 20 to
160 steps a turn and radii of 0 to 0.95, an ANCF beam alike), most of it in the first steps. And the elements vibrate:
what a turn feeds into them outgrows the integrator's damping where a is beyond 0.87 to 1.05 (1 - rho), up to elements
that turn inside out; none did at 0.79 (1 - rho). At rho = 1 that takes some turns at 120 steps a turn, and was not seen
in six turns at 200.
"""

from __future__ import annotations

import math
import warnings

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Side
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.status import RingingWarning

# Loss of angular momentum in a turn that counts, and the turn of a step over 1 - rho from which vibrations may grow; no
# smaller turn of a step than the last one counts, rad.
LOST, GROWING, LEAST = 0.01, 0.8, 2.0 * math.pi / 200
# That of ConfigureSolver.
USUAL_RADIUS = 0.6


def lost_share(radius: float) -> float:
    """Loss of angular momentum in the first turn over the square of the turn of a step, 1/rad^2."""
    return 0.24 + 1.64 * (1.0 - radius) ** 3


def largest_turn(radius: float) -> float:
    """Turn of a step beyond which more is lost than counts, or vibrations may grow, rad."""
    return min(math.sqrt(LOST / lost_share(radius)), max(GROWING * (1.0 - radius), LEAST))


class TurnWatch:
    """Watches the sides of one joint that lie on absolute coordinates.

    Parameters
    ----------
    sides : list of Side
    solver : MainSolverImplicitSecondOrder
        At work.
    """

    def __init__(self, sides: list[Side], solver: exu.MainSolverImplicitSecondOrder) -> None:
        self.sides, self.solver = sides, solver
        self.before: list[np.ndarray] = []

    def take(self, name: str, time: float) -> None:
        """Take an accepted state, to which the sides were brought; warn, once, if the step to it turned one too far.

        Parameters
        ----------
        name : str
            Of the joint.
        time : float
            s.
        """
        before, self.before = self.before, [side.frame[:, :3].copy() for side in self.sides]
        traces = [float(np.sum(old * new)) for old, new in zip(before, self.before, strict=False)]
        turn = max((math.acos(min(max(0.5 * (t - 1.0), -1.0), 1.0)) for t in traces), default=0.0)
        if turn > largest_turn(self.solver.spectralRadius):
            self.sides = []
            warn(name, time, turn, self.solver.spectralRadius)


def turn_watch(mbs: exu.MainSystem, sides: tuple[Side, Side], solver: solver_state.Solver | None) -> TurnWatch | None:
    """A watch of those sides (housing, journal) that lie on absolute coordinates; None if none does, or needs none."""
    if not isinstance(solver, exu.MainSolverImplicitSecondOrder):
        return None
    loose = [s for s in sides if s.nodes and mbs.GetNode(s.nodes[0])["nodeType"].startswith("Point")]
    return TurnWatch(loose, solver) if loose else None


def warn(name: str, time: float, turn: float, radius: float) -> None:
    """Warn that a body at the joint ``name`` turns too far in a step."""
    fate = f"loses some {100.0 * lost_share(radius) * turn**2:.2g} % of its angular momentum in the first turn"
    if turn > GROWING * (1.0 - radius):
        fate += ", and its elements vibrate more and more, up to nonsense"
    wanted, usual = (math.ceil(2.0 * math.pi / largest_turn(each)) for each in (radius, USUAL_RADIUS))
    warnings.warn(
        f"LubricatedJoint '{name}': in the step to t = {time:.9g} s the finite elements that it holds turn by "
        f"{turn:.3g} rad, {2.0 * math.pi / turn:.3g} steps a turn: on absolute coordinates Exudyn's integrator with a "
        f"spectral radius of {radius:g} {fate}; take {wanted} steps a turn or more ({usual} at a "
        f"spectral radius of {USUAL_RADIUS:g}), or a body with a floating frame (ObjectFFRFreducedOrder).",
        RingingWarning,
        stacklevel=2,
    )
