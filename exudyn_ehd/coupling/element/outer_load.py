"""Load on a film by the rest of the system: inertia of the bodies minus the film's force.

The journal moves relative to its housing by x'' = W (F + L), with the film's force F and the load L. W = J M^-1 J^T is
the inverse of the mass that resists a force between the two bodies, J is the Jacobian of the relative motion. So

    L = W^-1 J q'' - F

follows from an accepted state alone, with the accelerations that satisfy the equations of motion there. Alternations of
film force and inertia from step to step cancel in L; a jump of the load does not. The local error of the momentum in a
step is W^-1 J (q'1 - q'0 - integral of q''). It is stored with the trapezoidal integral; the correction by parabolas
follows from the record, also after a restart. Constraints and terms of second order in the rates are omitted in W and
in J q'', because they change smoothly.

Only rigid bodies and mass points in one or two films have a mass here. With any other body at the joint L = -F, the
load on a film for which inertia is negligible. A body in more films has no mass either, because one film does not
account for the damping of the others. Examples: a crankshaft in seven films, with its whole mass on each of them:
errors of 0.2 % were estimated at 20 to 50 %. A floating ring, with films inside and outside at the same place: errors
of 18 % in the inner film were estimated at 14 000 % with its mass, and at 10 % without.

Loads of a system that are functions of time, and their impulse within a step
-----------------------------------------------------------------------------
Accepted states contain a load f at both ends of a step h only. If the load deviates from the line through the two
states before, by d at the end of the step, the user functions of the loads are called within the step. Their impulse
minus that of the chord, over d h,

    offset = d . (mean(f) - (f0 + f1) / 2) / d^2,

is 1/2 - u for a jump at the fraction u of the step. The load L on a film depends linearly on the loads, whatever bodies
and joints lie between. So its impulse minus that of the chord is the offset times the deviation of L, times the step.
Several functions have one common offset. A ramp that begins or ends within the step takes a fraction of it: that of a
linear change whose time has the same variance as the change of the loads. A jump is found by bisection, to 1/1000 of
the step; a pulse shorter than 1/16 of a step may lie between the samples.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import exudyn_solvers
from exudyn_ehd.coupling.contract import Side, Trial, objects_of
from exudyn_ehd.coupling.items.bodies import body_of_node
from exudyn_ehd.coupling.items.objects import force_owner, object_mass
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.sides import NodeSide
from exudyn_ehd.joint.step_error import LOAD_COLUMNS, SUDDEN, FilmLoad, MotionPart, departure
from exudyn_ehd.status import SMALL

UNKNOWN = FilmLoad.of(np.full(sum(LOAD_COLUMNS), np.nan))
_LoadState: TypeAlias = tuple[float, np.ndarray, np.ndarray]
# Number of samples within a step. A pulse is found if it is longer than the step over this number. Each sample costs a
# call of every load function.
SAMPLES = 16
# Halvings of the part with the largest change: with 6 a jump is found to 1 / (16 * 2^6) of the step.
BISECTIONS = 6
# Deviation over the largest value, above which the steps do not resolve a load: (2 pi / 14)^2, 14 steps in a period.
# Larger values treat more ends of short pulses as jumps at unknown times.
UNRESOLVED = 0.2


class LoadFunctions:
    """User functions of the loads of a system.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    """

    def __init__(self, mbs: exu.MainSystem) -> None:
        self.calls: list[tuple[Callable[..., float | list[float]], float | list[float]]] = []
        for number in range(mbs.systemData.NumberOfLoads()):
            data: Any = mbs.GetLoad(number)
            name = "load" if "load" in data else "loadVector"
            function = data[f"{name}UserFunction"]
            if isinstance(function, dict) and callable(function["function"]):
                self.calls.append((function["function"], np.asarray(data[name]).tolist()))
        # times and values of the last four accepted states, and whether the loads have deviated in the last step
        self.times, self.values = np.empty(0), np.empty((0, 0))
        self.departed = False

    def accept(self, mbs: exu.MainSystem, time: float) -> None:
        """Store the values at an accepted state."""
        if self.calls:
            times, values = self._states(mbs, time)
            self.departed = self._departs(times, values)
            self.times, self.values = times, values

    def offset(self, mbs: exu.MainSystem, time: float) -> tuple[float, float]:
        """Offset in the step from the last accepted state to a time, and fraction of the step in which loads change.

        Both are nan if the loads do not deviate.
        """
        if not self.calls:
            return math.nan, math.nan
        times, values = self._states(mbs, time)
        off = departure(times, values)[-1]
        is_straight = np.abs(off).max() <= SMALL * np.abs(values).max()
        if is_straight or not (self.departed or self._departs(times, values)):
            return math.nan, math.nan
        beyond, _, _, lasting = self._impulse(mbs, time)
        return float(beyond @ off / (off @ off)), lasting

    def largest_change(self, mbs: exu.MainSystem, time: float) -> tuple[float, float]:
        """Largest impulse minus that of the chord, over the load's size and the step, and time of the largest change.

        The step is the one from the last accepted state to a time.
        """
        if not (self.calls and np.any(self.times < time)):
            return 0.0, time
        beyond, sizes, place, _ = self._impulse(mbs, time)
        return float((np.abs(beyond) / sizes).max()), place

    def _at(self, mbs: exu.MainSystem, time: float) -> np.ndarray:
        """Values (k,) of all functions."""
        return np.concatenate([np.ravel(function(mbs, time, value)) for function, value in self.calls])

    def _states(self, mbs: exu.MainSystem, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Times and values of the accepted states before a time, and at that time."""
        count = int(np.count_nonzero(self.times < time))
        before = slice(max(0, count - 3), count)
        return np.append(self.times[before], time), np.array([*self.values[before], self._at(mbs, time)])

    def _departs(self, times: np.ndarray, values: np.ndarray) -> bool:
        """Return whether the loads deviate suddenly from their line, see `SUDDEN`, or are not resolved by the steps."""
        if len(times) < 4:
            return False
        sizes = np.linalg.norm(departure(times, values), axis=1)[2:]
        last, now = np.diff(times)[1:] * sizes
        return bool(last < SUDDEN * now or sizes[1] > UNRESOLVED * np.abs(values).max())

    def _impulse(self, mbs: exu.MainSystem, time: float) -> tuple[np.ndarray, np.ndarray, float, float]:
        """Mean values (k,) minus those of the chord, largest values (k,), time of the largest change, and its duration.

        The duration is a fraction of the step, 0 for a jump: that of a linear change whose time has the same variance.
        """
        start = float(self.times[self.times < time][-1])
        step = time - start
        times = start + step * np.array([0.0, *(np.arange(SAMPLES) + 0.5) / SAMPLES, 1.0])
        values = np.array([self._at(mbs, float(t)) for t in times])
        sizes = np.abs(values).max(axis=0)
        sizes = np.maximum(sizes, SMALL * sizes.max() or 1.0)
        change = np.diff(values, axis=0)
        part, which = np.unravel_index(int((np.abs(change) / sizes).argmax()), change.shape)
        (left, right), middle = times[part : part + 2].tolist(), values[part : part + 2, which].mean()
        for _ in range(BISECTIONS):
            half = 0.5 * (left + right)
            is_behind = (self._at(mbs, half)[which] > middle) == (change[part, which] > 0.0)
            left, right = (left, half) if is_behind else (half, right)
        place = 0.5 * (left + right)
        # each sample represents an equal part of the step; the border between two parts is moved to a jump
        borders = np.arange(SAMPLES + 1) / SAMPLES
        borders[part] = (place - start) / step
        whole = values[-1] - values[0]
        beyond = 0.5 * whole - borders @ change
        gone = change @ whole / (whole @ whole or 1.0)
        lasting = math.sqrt(12.0 * max(0.0, float(np.square(borders) @ gone - (borders @ gone) ** 2)))
        return beyond, sizes, place, lasting


class OuterLoad:
    """Load on the film of one joint.

    Parameters
    ----------
    sides : (Side, Side)
        Housing and journal.
    parts : tuple of MotionPart
        Parts of the wrench with separate masses.

    Attributes
    ----------
    load : FilmLoad
        Load at the last state; its arrays have no axis for the states.
    functions : LoadFunctions or None
        Loads of the system that are functions of time, from the first state of a run on.
    """

    def __init__(self, sides: tuple[Side, Side], parts: tuple[MotionPart, ...]) -> None:
        self.sides, self.parts, self.rows = sides, parts, [row for part in parts for row in part.rows]
        self.load = UNKNOWN
        self.begin(None)

    def begin(self, solver: exudyn_solvers.Solver | None) -> None:
        """Begin a run of ``solver``: masses are read at its first state; loads are computed in implicit runs only."""
        # W^-1 of all parts
        self.mass: np.ndarray | None = None
        self.functions: LoadFunctions | None = None
        self.is_known = exudyn_solvers.is_implicit(solver)
        self.is_heavy, self.places = False, list[int]()
        # times, velocities and accelerations of the last accepted state, and of the one before the state at hand
        self.state: _LoadState | None = None
        self.before: _LoadState | None = None

    def take(self, mbs: exu.MainSystem, where: exu.ConfigurationType, trial: Trial) -> None:
        """Store the load at an accepted state."""
        begins = self.functions is None
        self.load = self.at(mbs, where, trial)
        if self.functions is not None:
            time = mbs.systemData.GetTime(where)
            self.functions.accept(mbs, time)
            # the accelerations at the start of a run may not satisfy the equations of motion
            if self.is_heavy and not begins:
                self.before, self.state = self._before(time), self._state(mbs, where, time)

    def _state(self, mbs: exu.MainSystem, where: exu.ConfigurationType, time: float) -> _LoadState:
        data, places = mbs.systemData, self.places
        rates, demanded = data.GetODE2Coordinates_t(where), data.GetODE2Coordinates_tt(where)
        return time, np.asarray(rates)[places], np.asarray(demanded)[places]

    def _before(self, time: float) -> _LoadState | None:
        """Return the last accepted state before a time; the end of a run may be stored more than once."""
        return self.state if self.state is not None and self.state[0] < time else self.before

    def at(self, mbs: exu.MainSystem, where: exu.ConfigurationType, trial: Trial) -> FilmLoad:
        """Load at a state, joint frame; the sides' arrays and the film of ``trial`` must belong to this state.

        It is nan without a film.
        """
        if not self.is_known or trial.evaluation is None:
            return UNKNOWN
        housing, journal = self.sides
        J = relative.wrench_map(housing.frame, journal.frame, housing.jac, journal.jac)
        if self.mass is None or self.functions is None:
            self.mass, self.functions = self._mass(mbs, J), LoadFunctions(mbs)
            self.is_heavy = bool(self.mass.any())
            nodes = [int(node) for side in self.sides for node in side.nodes]
            self.places = [int(place) for node in nodes for place in mbs.systemData.GetNodeLTGODE2(node)]
        time, size = mbs.systemData.GetTime(where), len(self.rows)
        force, momentum, demanded = np.zeros((3, 4))
        force[:size] = -trial.evaluation.wrench[self.rows]
        if self.is_heavy:
            onto = J[:, self.rows] @ self.mass
            _, rates, accelerations = self._state(mbs, where, time)
            demanded[:size] = accelerations @ onto
            force += demanded
            if (before := self._before(time)) is not None:
                missed = rates - before[1] - 0.5 * (time - before[0]) * (accelerations + before[2])
                momentum[:size] = missed @ onto
        offset, lasting = self.functions.offset(mbs, time)
        return FilmLoad(force, np.array([offset]), np.array([lasting]), self.masses, momentum, demanded)

    def _is_ring(self, mbs: exu.MainSystem, side: Side, objects: Sequence[int]) -> bool:
        """Return whether another journal's film holds the side's body at the same place, within half of its length."""
        elements: list[Any] = [force_owner(mbs, number) for number in objects]
        others = [e for e in elements if hasattr(e, "sides") and e.sides is not self.sides]
        return any(
            np.linalg.norm(at.rho - side.rho) < 0.5 * getattr(other.model.bearing, "length", 0.0)
            for other in others
            for at in other.sides
            if isinstance(at, NodeSide)
            and isinstance(side, NodeSide)
            and [*map(int, at.nodes)] == [*map(int, side.nodes)]
        )

    def _mass(self, mbs: exu.MainSystem, J: np.ndarray) -> np.ndarray:
        """W^-1 of all parts, zero if a body's mass is unknown; sets the masses (6,) of `FilmLoad`."""
        W, size = np.zeros((6, 6)), self.sides[0].size
        held = [(int(n), int(k)) for k, data in objects_of(mbs) for n in data.get("nodeNumbers", ())]
        mass, self.masses = np.zeros((len(self.rows), len(self.rows))), np.zeros(6)
        for side, own in zip(self.sides, (slice(size), slice(size, None)), strict=True):
            if side.size:
                films = [number for node, number in held if node == int(side.nodes[0])]
                is_alone = len(side.nodes) == 1 and len(films) < 3 and not self._is_ring(mbs, side, films)
                body = body_of_node(mbs, side.nodes[0]) if is_alone else None
                M = None if body is None else object_mass(mbs, body)
                if not isinstance(M, np.ndarray) or M.shape != (side.size, side.size):
                    return mass
                # Euler parameters have no inertia along themselves, where no force of the joint points either
                W += J[own].T @ np.linalg.pinv(M, rcond=1e-9, hermitian=True) @ J[own]
        column = 0
        for part in self.parts:
            upper = np.triu_indices(len(part.rows))
            inverse = mass[np.ix_(part.places, part.places)] = np.linalg.pinv(
                W[np.ix_(part.rows, part.rows)], hermitian=True
            )
            self.masses[column:][: upper[0].size] = inverse[upper]
            column += upper[0].size
        return mass
