"""Load on a film from everything else: inertia of the bodies less the film's own force.

The journal moves against its housing by x'' = W (F + L), with the film's force F, the load L and the inverse W of the
mass that a force between the two bodies feels, W = J M^-1 J^T with the Jacobian J of the relative motion. So

    L = W^-1 J q'' - F

follows from an accepted state alone, with the accelerations that the equations of motion demand there. What alternates
between film and inertia from step to step cancels in L; a load that jumps does not. The momentum that a step has
missed is W^-1 J (q'1 - q'0 - integral of q''). It is kept with the trapezoid; the record knows what parabolas add,
also behind a restart. Constraints and terms of the second order in
the rates are left out of W and of J q'': they change smoothly. Only rigid bodies and mass points have a
mass here; with any other body at the joint L = -F, the load on a film that outweighs the inertia.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Side, Trial
from exudyn_ehd.coupling.element.load_functions import LoadFunctions
from exudyn_ehd.coupling.items.bodies import body_of_node
from exudyn_ehd.coupling.items.object_mass import object_mass
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.joint.step_error import DEMANDED, LOADS, MASS, MOMENTUM, OFFSET, missed_in_steps

UNKNOWN = np.full(LOADS, np.nan)
_State: TypeAlias = tuple[float, np.ndarray, np.ndarray]
# Rows of the wrench (6,) on a journal, and on a ball, in blocks that do not share a mass.
JOURNAL, BALL = ([0, 1], [3, 4]), ([0, 1, 2],)


class OuterLoad:
    """Load on the film of one joint.

    Parameters
    ----------
    sides : (Side, Side)
        Housing and journal.
    blocks : sequence of list of int
        `JOURNAL` or `BALL`.

    Attributes
    ----------
    load : (20,) array
        At the state taken last, with what the step to it has missed; nan where it is not known.
    functions : LoadFunctions or None
        Loads of the system that are functions of time, from the first state of a run on.
    """

    def __init__(self, sides: tuple[Side, Side], blocks: Sequence[list[int]]) -> None:
        self.sides, self.blocks = sides, blocks
        self.load = UNKNOWN
        self.begin(None)

    def begin(self, solver: solver_state.Solver | None) -> None:
        """Begin a run of ``solver``: masses are read at its first state, loads are known in implicit runs."""
        self.masses: list[np.ndarray] | None = None
        self.functions: LoadFunctions | None = None
        self.is_known = solver_state.is_implicit(solver)
        self.is_heavy, self.places = False, list[int]()
        # times, velocities and accelerations of the last two accepted states
        self.states: list[_State] = []

    def take(self, mbs: exu.MainSystem, where: exu.ConfigurationType, trial: Trial) -> None:
        """Keep the load at a state, an accepted one."""
        begins = self.functions is None
        self.load = self.at(mbs, where, trial)
        if self.functions is not None:
            time = mbs.systemData.GetTime(where)
            self.functions.accept(mbs, time)
            # a run may begin with accelerations that no equations demand
            if self.is_heavy and not begins:
                self.states = self._states(mbs, where, time)

    def _states(self, mbs: exu.MainSystem, where: exu.ConfigurationType, time: float) -> list[_State]:
        """The one accepted before a time, and the one there; the end of a run is taken more than once."""
        data, before = mbs.systemData, [state for state in self.states if state[0] < time][-1:]
        rates, demanded = data.GetODE2Coordinates_t(where), data.GetODE2Coordinates_tt(where)
        return [*before, (time, np.asarray(rates)[self.places], np.asarray(demanded)[self.places])]

    def at(self, mbs: exu.MainSystem, where: exu.ConfigurationType, trial: Trial) -> np.ndarray:
        """Load (20,) at a state to which the sides' arrays and the film of ``trial`` belong, joint frame.

        Its columns are those of `exudyn_ehd.joint.step_error`, those of a ball's blocks with a zero behind them; nan
        without a film.
        """
        if not self.is_known or trial.evaluation is None:
            return UNKNOWN
        wrench = trial.evaluation.wrench
        housing, journal = self.sides
        J = relative.wrench_map(housing.frame, journal.frame, housing.jac, journal.jac)
        if self.masses is None:
            self.masses, self.functions = self._masses(mbs, J), LoadFunctions(mbs)
            self.is_heavy = any(mass.any() for mass in self.masses)
            nodes = [int(node) for side in self.sides for node in side.nodes]
            self.places = [int(place) for node in nodes for place in mbs.systemData.GetNodeLTGODE2(node)]
        assert self.functions is not None
        time, out, demanded, missed = mbs.systemData.GetTime(where), np.zeros(LOADS), np.zeros(6), np.zeros(6)
        if self.is_heavy:
            times, rates, accelerations = (np.array(x) for x in zip(*self._states(mbs, where, time), strict=True))
            demanded, missed = accelerations[-1] @ J, missed_in_steps(times, rates, accelerations)[-1] @ J
        place = 0
        for rows, mass in zip(self.blocks, self.masses, strict=True):
            out[place : place + len(rows)] = mass @ demanded[rows] - wrench[rows]
            out[MOMENTUM + place :][: len(rows)] = mass @ missed[rows]
            out[DEMANDED + place :][: len(rows)] = mass @ demanded[rows]
            place += len(rows)
        out[OFFSET:MASS] = self.functions.offset(mbs, time)
        out[MASS:MOMENTUM] = np.concatenate([mass[np.triu_indices(len(mass))] for mass in self.masses])
        return out

    def _masses(self, mbs: exu.MainSystem, J: np.ndarray) -> list[np.ndarray]:
        """W^-1 of every block; zero where a body's mass is not known."""
        W, first = np.zeros((6, 6)), 0
        for side in self.sides:
            last = first + side.size
            if side.size:
                body = body_of_node(mbs, side.nodes[0]) if len(side.nodes) == 1 else None
                M = None if body is None else object_mass(mbs, body)
                if not isinstance(M, np.ndarray) or M.shape != (side.size, side.size):
                    return [np.zeros((len(rows), len(rows))) for rows in self.blocks]
                # Euler parameters have no inertia along themselves, where no force of the joint points either
                W += J[first:last].T @ np.linalg.pinv(M, rcond=1e-9, hermitian=True) @ J[first:last]
            first = last
        return [np.linalg.pinv(W[np.ix_(rows, rows)], hermitian=True) for rows in self.blocks]
