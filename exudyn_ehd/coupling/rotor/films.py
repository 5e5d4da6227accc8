"""Films of a system about a state in which rotors spin, in the directions x and rates u of `system`."""

from __future__ import annotations

import math

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import NodeIndex, Side
from exudyn_ehd.coupling.element.nodal import NodalFilmElement
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics import relative, rigid_nodes
from exudyn_ehd.coupling.kinematics.sides import NodeSide, derivatives_between
from exudyn_ehd.coupling.rotor.spinning import TURNING, WHERE
from exudyn_ehd.coupling.rotor.system import HeldBore, SpinningSystem, TurningNode
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.joint.audit.resolution import warn_of_grid
from exudyn_ehd.joint.balance.limits import require_bearable, warn_of_heat, warn_of_overload
from exudyn_ehd.joint.balance.position import first_guess
from exudyn_ehd.joint.balance.steady_film import room, room_of_faces, settled_history
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.static.dynamic_stiffness import (
    LOADS,
    PLACES,
    FilmMemory,
    require_derivatives,
    response_of,
    slow_motions,
)
from exudyn_ehd.joint.static.equilibrium import NO_LOAD
from exudyn_ehd.joint.static.pad_equilibrium import PadSearch
from exudyn_ehd.joint.static.pads import PadModel
from exudyn_ehd.joint.static.steady import require_rest
from exudyn_ehd.joint.thrust import ThrustEvaluation, seen_by_faces
from exudyn_ehd.status import FilmError, InputError, Status


class SpinningSide(Side):
    """One side of a joint: its node in the system, None for ground, its frame and its Jacobians.

    Work arrays as in `exudyn_ehd.coupling.kinematics.rigid_nodes`, for x and u in place of q and q_t: dp = Jp dx and
    v = Jp u.
    """

    def __init__(self, side: NodeSide, node: TurningNode | None) -> None:
        self.side, self.node = side, node
        super().__init__(side.nodes, 0 if node is None else 6)
        self.frame[:] = side.frame
        self.places = np.arange(self.size) + (0 if node is None else node.own.start)

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at the system's coordinates ``q`` (n,) and rates u, ``q_t`` (size,)."""
        if self.node is None:
            return
        turn = self.node.turn(q)
        self.frame[:, :3] = turn @ self.side.rotation
        self.frame[:, 3] = self.node.position(q)
        self.frame[:, 4:] = q_t[self.node.own].reshape(2, 3).T
        self.jac[:2] = np.eye(6).reshape(2, 3, 6)
        self.move_point(turn @ self.side.rho)

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr by x: the arm turns."""
        out = np.zeros((6, self.size, self.size))
        rigid_nodes.add_lever(self.jac[1], self.arm, out)
        return out


class RotorFilm:
    """One film of the system.

    Parameters
    ----------
    joint : Joint
    system : SpinningSystem
    bore : HeldBore
    """

    def __init__(self, joint: Joint, system: SpinningSystem, bore: HeldBore) -> None:
        self.bore, self.name, self.size = bore, joint.name, system.size
        self.model = film_model(joint)
        self.bearing = self.model.bearing
        housing, journal = (_spinning_side(joint, side, system) for side in joint.element.sides)
        self.mbs, self.sides = system.mbs, (housing, journal)
        self.frames, self.jacobians = (housing.frame, journal.frame), (housing.jac, journal.jac)
        turning = [system.ratios.get(int(side.nodes[0]), 0.0) if side.nodes else 0.0 for side in joint.element.sides]
        self.ratio = turning[1]
        if turning[0] or not turning[1]:
            raise InputError(
                f"{WHERE}: joint '{joint.name}' must have a journal that spins in a housing that does not; name the "
                "spinning bodies by rotors=..., and give them as second entry of the joint's itemNumbers."
            )
        self.places = np.concatenate((housing.places, journal.places))
        self.motion, self.rates = np.zeros(10), np.zeros(self.places.size)
        # with films on end faces the motion contains the axial position
        self.faces, self.kinematics, self._place = joint.element.faces, joint.element.collars, np.zeros(11)
        self._on_faces: ThrustEvaluation | None = None
        self._near: History | None = None
        # whether warnings have been given
        self._hot = self._coarse = False

    def update(self, q: np.ndarray, u: np.ndarray) -> None:
        """Update the journal's motion to a state."""
        for side in self.sides:
            side.update(self.mbs, q, u, None)
        self.rates = u[self.places]
        self._place = self.kinematics.motion_of(*self.frames)
        self.motion, self.by_place = self._place[:10], self.kinematics.variation_of(*self.frames, *self.jacobians)[0]
        if self.faces is not None:
            self._on_faces = self.faces.evaluate(self._place, self._near)

    def evaluate(self) -> Evaluation | None:
        """Evaluate the film at the motion; None without a film here or on an end face."""
        found = self._on_faces
        if not np.all(np.isfinite(self.motion)) or (found is not None and found.status is not Status.CONVERGED):
            return None
        try:
            self._near = settled_history(self.model, self._place, self._near, WHERE, self.faces)
        except FilmError:
            return None
        evaluation = self.model.evaluate_steady(self.motion, self._near)
        if self.faces is not None and self._near is not None and evaluation.film is not None:
            seen = seen_by_faces(evaluation.film, self.model.effects.thermal)
            self._on_faces = self.faces.evaluate(self._place, seen)
        return evaluation if evaluation.status is Status.CONVERGED else None

    def memory(self, evaluation: Evaluation, free: np.ndarray) -> FilmMemory | None:
        """Response of the last evaluated film in directions ``free`` (N, n); None if K and C are constant."""
        slow, response = response_of(evaluation)
        if response is None:
            return None
        own, by_wrench = free[self.places], self._wrench_map()
        return FilmMemory(response, slow, own.T @ by_wrench @ LOADS.T, self.by_place[:PLACES] @ own)

    def loads(self, wrench: np.ndarray, tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Generalized forces (n,) of a wrench (6,) and of films on end faces, and their derivatives (n, n) to x and u.

        ``tangent`` (6, 10) is that of the wrench; `update` must have run.
        """
        whole = np.zeros((6, len(self._place)))
        whole[:, :10] = tangent[:, :10]
        if self._on_faces is not None:
            wrench, whole = wrench + self._on_faces.wrench, whole + self._on_faces.tangent()
        state = self.rates, self.rates
        by_place, by_rate, _, _ = derivatives_between(self.mbs, self.sides, state, wrench, whole, self.kinematics)
        return self._wrench_map() @ wrench, by_place, by_rate

    def _wrench_map(self) -> np.ndarray:
        """Map (n, 6) from a wrench on the journal to generalized forces."""
        return np.asarray(relative.wrench_map(*self.frames, *self.jacobians))

    def by_spin(self, tangent: np.ndarray) -> np.ndarray:
        """Derivative (n,) of the generalized force of all films to the speed of the first rotor."""
        change = tangent[:, 8].copy()
        if self._on_faces is not None:
            change += self._on_faces.tangent()[:, 8]
        return self._wrench_map() @ (self.ratio * change)

    def support(self, wrench: np.ndarray, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Wrench (6,) and tangent (6, 10) of stiff springs in place of the film, about the position ``middle`` (2,)."""
        # N/m, of the size of the stiffness of a heavily loaded film
        stiffness = 10.0 * self.bearing.reference_force(self.motion[8]) / self.bearing.radial_clearance
        tangent = np.zeros((6, 10))
        tangent[:, :4] = -stiffness * LOADS.T * [1.0, 1.0, *[self.bearing.length**2 / 12.0] * 2]
        away = np.concatenate((self.motion[:2] - middle, self.motion[2:]))
        return wrench + tangent @ away, tangent

    def guess(self, forces: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Initial guesses of wrench (6,) and position (2,) of the journal for the load of the film's spring.

        For tilting pads the first pad returns those of all pads, the others return an empty list.

        Parameters
        ----------
        forces : (k, 2) array
            Forces of the springs in place of this film and of those after it.
        """
        speed, model = float(self.motion[8]), self.model
        if not isinstance(model, PadModel):
            return [(np.append(forces[0], np.zeros(4)), first_guess(self.bearing, speed, -forces[0], self.motion[2:4]))]
        if model.number > 0:
            return []
        load, where = -forces[: model.pads.pads].sum(axis=0), f"{WHERE}: joint '{self.name}'"
        size = max(float(np.hypot(*load)), NO_LOAD * self.bearing.reference_force(speed))
        loads = PadSearch(model.pads, speed, load, size, where).find().film
        if idle := [k + 1 for k, own in enumerate(loads) if not own.loaded]:
            raise FilmError(
                f"{where}: pad {idle[0]} of the bearing is not loaded and has no definite tilt about which it would "
                "vibrate; give the pads more preload, or contact=RegularisedWall(onset=...) to rest on."
            )
        return [(own.wrench, own.motion[:2]) for own in loads]

    def room(self, x: np.ndarray) -> float:
        """Largest part of a step x (size,) for which all films of the joint have room; `update` has run."""
        change = self.by_place[:4] @ x[self.places]
        return min(room(self.model, self.motion, change), self.room_of_faces(x))

    def room_of_faces(self, x: np.ndarray) -> float:
        """Largest part of a step x (size,) for which the films on end faces have room; `update` has run."""
        if self._on_faces is None:
            return 1.0
        change = self.by_place @ x[self.places]
        return room_of_faces(self._on_faces, float(change[10]), float(np.hypot(*change[2:4])))

    def found(self, evaluation: Evaluation, tangent: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray | float]:
        """Return the values of one film at its equilibrium for `RotorResult`, and write its bore's coordinates to q."""
        force, known = evaluation.wrench[:2], evaluation.quantities()
        where = f"{WHERE}, joint '{self.name}'"
        self.bore.enter(q, evaluation, self.frames[0])
        if evaluation.is_central:
            require_derivatives(evaluation, where)
        loads = known["minimum_gap"], known["peak_pressure"], float(np.hypot(*force))
        warn_of_overload(self.bearing, *loads, where)
        if (film := evaluation.film) is not None:
            require_bearable(film, where)
            self._hot = self._hot or warn_of_heat(film.temperature, film.grid, where)
            self._coarse = self._coarse or warn_of_grid(film, where)
        angle = math.atan2(self.motion[1], self.motion[0]) - math.atan2(-force[1], -force[0])
        rows = np.zeros((2, self.size))
        rows[:, self.places] = self.by_place[:2]
        stiffness, damping = slow_motions(tangent)
        values: dict[str, np.ndarray | float] = {
            "motion": self.motion.copy(),
            "wrench": evaluation.wrench,
            "attitude_angle": math.remainder(math.copysign(angle, angle * self.motion[8]), 2.0 * math.pi),
            "stiffness": stiffness,
            "damping": damping,
            "film_directions": rows,
        }
        return values | {
            name: known[name] for name in ("eccentricity_ratio", "minimum_gap", "peak_pressure", "power_loss")
        }


def _spinning_side(joint: Joint, side: object, system: SpinningSystem) -> SpinningSide:
    if isinstance(side, NodeSide):
        if not side.nodes:
            return SpinningSide(side, None)
        if int(side.nodes[0]) in system.nodes:
            return SpinningSide(side, system.nodes[int(side.nodes[0])])
    kinds = sorted({system.mbs.GetNode(NodeIndex(int(node)))["nodeType"] for node in getattr(side, "nodes", ())})
    raise InputError(
        f"{WHERE}: both sides of joint '{joint.name}' must be ground, rigid bodies or nodes of types {list(TURNING)}, "
        f"got {type(side).__name__} on {kinds}; give the joint the node of a beam in place of its element, and 3D "
        "bodies."
    )


def film_model(joint: Joint) -> BearingModel:
    """Return the model of a joint's film; `InputError` for films without stiffness and damping about a position."""
    where, element, model = f"{WHERE}: joint '{joint.name}'", joint.element, joint.element.model
    # modes of a bush or journal of the bearing have no mass; those of a finite-element body have
    known = type(element) in (FilmElement, NodalFilmElement) or element.is_massless
    if not known or not isinstance(model, BearingModel):
        raise InputError(
            f"{where} has a ball, the bore or journal of a finite-element body, whose modes have mass, an ImpedanceMap "
            "or a film of your own; take a bearing that is rigid or has a bush or journal of its own (ElasticLiner, "
            "ModalBush, ANCFBush, ElasticJournal)."
        )
    if not model.bearing.squeeze:
        raise InputError(f"{where} has squeeze=False and so no damping; take squeeze=True.")
    require_rest(model.bearing, where)
    return model
