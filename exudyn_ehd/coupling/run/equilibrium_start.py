"""A consistent start: the journal placed where its film carries a steady load."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import INITIAL, JointModel, require_system
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.sides import NodeSide
from exudyn_ehd.joint.balance.newton import settled_history
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.joint.static.equilibrium import EquilibriumResult, equilibrium
from exudyn_ehd.status import InputError, Status, require_number, require_vector

_WHERE = "LubricatedJoint.place_in_equilibrium"


def place(
    mbs: exu.MainSystem, element: FilmElement, name: str, load: Sequence[float] | np.ndarray, speed: float | None
) -> EquilibriumResult:
    """Move the journal's node to its equilibrium; see `LubricatedJoint.place_in_equilibrium`."""
    journal = element.sides[1]
    require_system(_WHERE, mbs, assembled=True, of=f" of joint '{name}'")
    if not isinstance(journal, NodeSide) or not journal.nodes:
        raise InputError(
            f"{_WHERE}: the journal of joint '{name}' must be a rigid body or node that moves; place other bodies by a "
            "static solve (ehd.SolveStatic)."
        )
    if getattr(element, "bush", None) is not None:
        raise InputError(
            f"{_WHERE}: joint '{name}' has a nodal bush, whose nodes would have to move too; place the journal's body "
            "before the joint is created (initialDisplacement), at ehd.equilibrium(...).position: the bush then "
            "starts in equilibrium with its film."
        )
    force = require_vector(f"{_WHERE}: load", load, 2, "N")
    motion = element.motion(mbs, INITIAL)[:MOTION_SIZE]
    if speed is not None:
        motion[8] = require_number(f"{_WHERE}: speed", speed, "rad/s")
    if motion[8] == 0.0:
        raise InputError(
            f"{_WHERE}: joint '{name}' does not turn in the initial state, and a film without speed carries no steady "
            "load; give speed=..., or the bodies an initial angular velocity."
        )
    bearing = element.model.bearing
    result = equilibrium(
        bearing,
        speed=float(motion[8]),
        load=(force[0], force[1]),
        tilt=(motion[2], motion[3]),
        axial_position=0.0 if element.faces is None else float(element.faces_motion(motion)[-1]),
    )
    housing = element.sides[0].frame[:, :3]
    coordinates = np.array(mbs.systemData.GetODE2Coordinates(INITIAL), dtype=float)
    rates = np.array(mbs.systemData.GetODE2Coordinates_t(INITIAL), dtype=float)
    places = np.array(mbs.systemData.GetNodeLTGODE2(int(journal.nodes[0])), dtype=int)
    size = rigid_nodes.translations(journal.kind)
    coordinates[places[:size]] += (housing[:, :2] @ (result.position - motion[:2]))[:size]
    # the journal's axis keeps its place in the bearing: what it moved against it is taken off its velocity
    rates[places[:size]] -= (housing[:, :2] @ motion[4:6])[:size]
    bore = np.zeros(0) if result.film.bore_coordinates is None else result.film.bore_coordinates
    for node in element.bore_nodes:
        where = np.array(mbs.systemData.GetNodeLTGODE2(int(node)), dtype=int)
        coordinates[where], bore = bore[: where.size], bore[where.size :]
        rates[where] = 0.0
    mbs.systemData.SetODE2Coordinates(coordinates.tolist(), INITIAL)
    mbs.systemData.SetODE2Coordinates_t(rates.tolist(), INITIAL)
    at_rest = motion.copy()
    at_rest[:2], at_rest[4:8] = result.position, 0.0
    element.steps.resume(float(mbs.systemData.GetTime(INITIAL)), _memory(element.model, at_rest, result))
    return result


def _memory(model: JointModel, motion: np.ndarray, result: EquilibriumResult) -> History | None:
    """Return the memory of the steady film at ``motion`` (10,); None without effects that need memory."""
    if not model.remembers:
        return None
    assert isinstance(model, BearingModel)
    bore = result.film.bore_coordinates
    whole = motion if bore is None else np.concatenate((motion, bore, np.zeros_like(bore)))
    first = model.initial_history(whole)
    settled = settled_history(model, whole)
    evaluation = model.evaluate(whole, settled)
    if first is None or evaluation.status is not Status.CONVERGED:
        return first
    last = evaluation.history()
    assert last is not None
    temperature = first.temperature if settled is None else settled.temperature
    return dataclasses.replace(
        first, void=last.void, mass=last.mass, deflection=last.deflection, temperature=temperature, density=last.density
    )
