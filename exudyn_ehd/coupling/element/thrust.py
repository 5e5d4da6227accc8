"""The films on the end faces as an element of their own, an ObjectGenericODE2 beside that of the journal's film.

It has no mass, no memory and no record: on the nodes of the same two sides it adds the force and the exact Jacobian of
`exudyn_ehd.joint.thrust`, whose wrench on the journal the housing gets with opposite sign about the same point, also
where a bush yields under the journal's film. Besides the motion (10,) it needs the journal's place along the axis,

    z = e_z . (p_J - p_H) - z_0 a_z,

with the bearing's axis e_z, the journal's axis a_z in its direction, and the distance z_0 of both joint points in the
reference configuration. It does not depend on where along the axis the journal's joint point lies, and its rate is w,
to second order in the tilt. Rates are the velocities.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import CURRENT, ObjectIndex, Side, Trial
from exudyn_ehd.coupling.element.accepted_steps import AcceptedSteps
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.items.carrier import initial_frame
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.rigid_nodes import PLACE
from exudyn_ehd.coupling.kinematics.sides import bind, derivatives_between, motion_between
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.coupling.watch.step_control import SMALLEST_GAP_SHARE
from exudyn_ehd.joint.model.compile import MESSAGE
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.joint.thrust import ADVICE, ThrustEvaluation, ThrustModel
from exudyn_ehd.progress import announced
from exudyn_ehd.status import FilmError, InputError, Status


class ThrustElement:
    """Films on the end faces between two sides.

    Parameters
    ----------
    name : str
        Name of the joint.
    bearing : JournalBearing
    steps : AcceptedSteps
        Those of the journal's film, which keeps the record.
    sides : pair of Side
        Housing and journal, not those of the journal's film.
    offset : float
        z_0, m.

    Attributes
    ----------
    objectNumber : exudyn.ObjectIndex
        Number of the element in the system.
    """

    objectNumber: ObjectIndex

    def __init__(
        self, name: str, bearing: JournalBearing, steps: AcceptedSteps, sides: tuple[Side, Side], offset: float
    ) -> None:
        self.model = ThrustModel(bearing)
        self.steps, self.name = steps, name
        self.sides, self.offset = sides, offset
        self._gap = np.nan  # smallest one at the start of the step, m
        self._last: tuple[list[float], list[float], ThrustEvaluation] | None = None
        self._bound = False

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """User function of Exudyn: generalized force (n,) on the nodes; nan asks for a smaller step."""
        found, out, (housing, journal) = self._evaluate(mbs, q, q_t), np.full(len(q), np.nan), self.sides
        if self._has_film(t, found) and not self._goes_too_far(t, found):
            relative.wrench_force(housing.frame, journal.frame, housing.jac, journal.jac, found.wrench, out)
        return out

    def jacobian(
        self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> np.ndarray:
        """User function of Exudyn: -(f_q dQ/dq + f_qt dQ/dq_t) (n, n)."""
        found, n = self._evaluate(mbs, q, q_t), len(q)
        if not self._has_film(t, found):
            return np.full((n, n), np.nan)
        stiffness, damping = self.derivatives(mbs, self.sides, (np.array(q), np.array(q_t)), found)
        return -(f_q * stiffness + f_qt * damping)

    def derivatives(
        self,
        mbs: exu.MainSystem,
        sides: tuple[Side, Side],
        state: tuple[np.ndarray, np.ndarray],
        found: ThrustEvaluation,
    ) -> tuple[np.ndarray, np.ndarray]:
        """dQ/dq and dQ/dq_t (n, n) of the films at a state (q, q_t), to which the sides are brought."""
        frames, jacobians = (sides[0].frame, sides[1].frame), (sides[0].jac, sides[1].jac)
        tangent = found.tangent()
        own = np.ascontiguousarray(tangent[:, :MOTION_SIZE])
        stiffness, damping, by_q, _ = derivatives_between(mbs, sides, state, found.wrench, own)
        turned = relative.wrench_map(*frames, *jacobians) @ tangent[:, MOTION_SIZE]
        stiffness += np.outer(turned, self.position_change(frames, jacobians, found.motion, by_q))
        return stiffness, damping

    def at(self, frames: tuple[np.ndarray, np.ndarray], motion: np.ndarray) -> ThrustEvaluation:
        """The films at frames (3, 6) of housing and journal, of the motion (10,)."""
        return self.model.evaluate(motion, self._position(frames, motion))

    def place(self, sides: tuple[Side, Side], motion: np.ndarray) -> float:
        """Axial position, m, at the state to which the frames of ``sides`` and the motion (10,) belong."""
        return self._position((sides[0].frame, sides[1].frame), motion)

    def wrench(self, sides: tuple[Side, Side]) -> np.ndarray:
        """Force and moment about O (6,) on the journal at the state to which the arrays of ``sides`` belong."""
        frames = sides[0].frame, sides[1].frame
        return self.at(frames, relative.motion_of(*frames)).wrench

    def quantities(self, sides: tuple[Side, Side], trial: Trial) -> Mapping[str, float]:
        """Scalars of the films at an accepted state, to which the arrays of ``sides`` belong."""
        values = self.at((sides[0].frame, sides[1].frame), trial.bodies[:MOTION_SIZE]).quantities()
        self._gap = values["thrust_minimum_gap"]
        return values

    def _evaluate(self, mbs: exu.MainSystem, q: list[float], q_t: list[float]) -> ThrustEvaluation:
        """The films at a state, to which the sides' frames and Jp, Jr are brought."""
        q, q_t, last = list(q), list(q_t), self._last
        if last is not None and last[0] == q and last[1] == q_t and last[2].serial == self.model.serial:
            return last[2]
        self._last = None
        if not self._bound:
            bind(mbs, *self.sides)
            self._bound = True
        motion = motion_between(mbs, self.sides, np.array(q), np.array(q_t), CURRENT)
        found = self.at((self.sides[0].frame, self.sides[1].frame), motion)
        self._last = q, q_t, found
        return found

    def _position(self, frames: tuple[np.ndarray, np.ndarray], motion: np.ndarray) -> float:
        housing, journal = frames
        along = float(housing[:, 2] @ (journal[:, PLACE] - housing[:, PLACE]))
        return along - self.offset / math.sqrt(1.0 + float(motion[2:4] @ motion[2:4]))

    def position_change(
        self,
        frames: tuple[np.ndarray, np.ndarray],
        jacobians: tuple[np.ndarray, np.ndarray],
        motion: np.ndarray,
        by_q: np.ndarray,
    ) -> np.ndarray:
        """Derivative (n,) of the position to q, from frames and Jacobians of both sides and that of the motion."""
        (housing, journal), tilt = frames, motion[2:4]
        axis = housing[:, 2]
        turning = np.cross(axis, journal[:, PLACE] - housing[:, PLACE])
        along = np.concatenate((turning @ jacobians[0][1] - axis @ jacobians[0][0], axis @ jacobians[1][0]))
        return np.asarray(along + self.offset * (1.0 + tilt @ tilt) ** -1.5 * (tilt @ by_q[2:4]))

    def _goes_too_far(self, time: float, found: ThrustEvaluation) -> bool:
        """Return whether the step control rejects the step for its change of the faces' smallest gap."""
        control, faces = self.steps.control, self.model.bearing.thrust
        if control is None or faces is None or not time > self.steps.start:
            return False
        least = SMALLEST_GAP_SHARE * faces.clearance if faces.contact is None else faces.contact.onset
        change = min(state.minimum_gap for state in found.states) - self._gap
        return control.refuses(change, max(self._gap, least), self.steps.solver)

    def _has_film(self, time: float, found: ThrustEvaluation) -> bool:
        """Return whether the faces have films; raise `FilmError` if they have none and the step can't be repeated."""
        if found.status is Status.CONVERGED:
            return True
        if not solver_state.can_reject_step(self.steps.solver):
            gap = min(state.minimum_gap for state in found.states)
            raise FilmError(
                f"LubricatedJoint '{self.name}' can't be evaluated at t = {time:.9g} s: {found.status.name} on a "
                f"thrust face, axial position {found.position:.6g} m, smallest gap {gap:.6g} m; {ADVICE}"
            )
        return False


def attach_faces(
    mbs: exu.MainSystem,
    name: str,
    bearing: JournalBearing,
    steps: AcceptedSteps,
    items: tuple[Item, Item],
    points: tuple[np.ndarray, np.ndarray],
    rotation: np.ndarray,
) -> ThrustElement:
    """Add the films on the end faces of a joint.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    name, bearing, steps
        As for `ThrustElement`.
    items : pair of Item
        Housing and journal.
    points, rotation : pair of (3,) arrays, (3, 3) array
        Joint points and joint frame in the reference configuration.

    Raises
    ------
    InputError
        If the journal starts outside its faces.
    """
    housing, journal = (item.side(point, rotation) for item, point in zip(items, points, strict=True))
    offset = float(rotation[:, 2] @ (points[1] - points[0]))
    element = ThrustElement(name, bearing, steps, (housing, journal), offset)
    frames = initial_frame(mbs, items[0], housing), initial_frame(mbs, items[1], journal)
    motion = relative.motion_of(*frames)
    with announced(MESSAGE):
        start = element.at(frames, motion)
        start.tangent()
    if start.status is not Status.CONVERGED:
        raise InputError(
            f"CreateLubricatedJoint: the journal is outside the thrust faces of '{element.name}' in the initial "
            f"configuration: axial position {start.position:.6g} m, tilt ({motion[2]:.3g}, {motion[3]:.3g}), smallest "
            f"gap {min(state.minimum_gap for state in start.states):.6g} m; check the initial positions, and whether "
            "ThrustFaces.clearance is that of one face."
        )
    element.objectNumber = mbs.AddObject(
        eii.ObjectGenericODE2(
            name=f"{element.name} thrust faces",
            nodeNumbers=[node for side in (housing, journal) for node in side.nodes],
            forceUserFunction=element.force,
            jacobianUserFunction=element.jacobian,
            visualization=eii.VObjectGenericODE2(show=False),
        )
    )
    return element
