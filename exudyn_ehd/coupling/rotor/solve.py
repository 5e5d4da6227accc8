"""Equilibrium of rotors in all of their films, followed over the speed.

All coordinates are at rest except for the given spins. The torque for a constant speed acts on the driven node, the
first of each rotor, about its axis. The unknowns are the positions of all bodies. Newton's method uses the exact
tangents of the films and differences of all other forces (`system`). The search goes from speed to speed along the
tangent of the branch, ``K dx/dOmega = -dr/dOmega``.

Initial guess: with every film replaced by a stiff spring, the springs' forces are the loads of the films, and
`first_guess` gives the positions for these loads.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import exudyn as exu
import numpy as np
from exudyn.rigidBodyUtilities import Skew

from exudyn_ehd.coupling.contract import NodeIndex, objects_of
from exudyn_ehd.coupling.rotor.films import RotorFilm, film_model
from exudyn_ehd.coupling.rotor.spinning import WHERE, Rotors, find_rotors
from exudyn_ehd.coupling.rotor.system import HeldBore, SpinningSystem
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.newton import ROUNDED, DampedNewton, SearchState, damped_step
from exudyn_ehd.joint.static.dynamic_stiffness import FilmMemory
from exudyn_ehd.status import ROUNDING, FilmError, InputError

NOT_HELD = (
    "nothing holds {}; hold it by a film, a spring or a constraint, a shaft along its axis by "
    "CreateLubricatedJoint(axial=ehd.Held())."
)
NO_MASS = "{} moves without mass or inertia; give its body both, or hold it."
# Largest relative difference of the matrices of rotors, and of those turned by one radian, which count as the same in
# all directions.
ISOTROPIC = 1e-4
# Smallest stiffness, and smallest mass, of a body over the largest one; rotations are multiplied by a bearing's length.
# Below it a body counts as not held, or without mass: an error.
LEAST = 1e-12


# Evaluation of a film, and its tangent (6, 10).
FilmTangent: TypeAlias = tuple[Evaluation, np.ndarray]


@dataclass(eq=False)
class ForceBalance(SearchState[list[FilmTangent]]):
    """Balance of all forces at a state, in the N directions x.

    The unknowns ``x`` are the coordinates of the system; ``unbalance`` is the residual of the balance in the free
    directions, N, with moments over a bearing's length; ``film`` holds all films with their tangents.

    Attributes
    ----------
    r : (N,) array
        Residual of the balance, with the constraint forces of the present multipliers.
    K, r_u : (N, N) arrays
        Derivatives of r to x and u; K includes the rotation of the spin vectors.
    free : (N, n) array
        Directions that constraints and drives leave free.
    mend : (N,) array
        Step that satisfies the constraints.
    multipliers : (m,) array
        Multipliers that balance r in the directions of the constraints.
    torques : (r,) array
        Torques of the drives that do the same.
    rounding : float
        Part of the unbalance over its size that is due to round-off of positions times stiffness.
    """

    r: np.ndarray
    K: np.ndarray
    r_u: np.ndarray
    free: np.ndarray
    mend: np.ndarray
    multipliers: np.ndarray
    torques: np.ndarray
    rounding: float


# Values of one equilibrium by their names in `RotorResult`, and the memories of its films.
State: TypeAlias = tuple[dict[str, np.ndarray], tuple[FilmMemory, ...]]


class EquilibriumSearch(DampedNewton[ForceBalance]):
    """Search for the equilibria of one system, whose films are switched off in Exudyn during the search.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    joints : list of Joint
    rotors, ratios
        As in `SolveEquilibrium`.
    """

    growth, tolerance = math.inf, ROUNDED

    def __init__(
        self, mbs: exu.MainSystem, joints: list[Joint], rotors: Rotors, ratios: Sequence[float] | None
    ) -> None:
        # films first: a rotor of finite elements has none of these
        for joint in joints:
            film_model(joint)
        bores = [HeldBore(mbs, joint.element) for joint in joints]
        self.mbs, self.system = mbs, SpinningSystem(mbs, find_rotors(mbs, joints, rotors, ratios), bores)
        self.films = [RotorFilm(joint, self.system, bore) for joint, bore in zip(joints, bores, strict=True)]
        self.length = max(film.bearing.length for film in self.films)
        self.weights = np.ones(self.system.size)
        for node in self.system.nodes.values():
            self.weights[node.own][3:] = 1.0 / self.length
        self.torques = np.zeros(len(self.system.rotors))
        self.rest: tuple[np.ndarray, np.ndarray]
        self.slope: np.ndarray | None = None
        self.speed = math.nan

    def at(self, speed: float) -> State:
        """Find the equilibrium at a speed, rad/s, starting from the last one; return its values for `RotorResult`.

        Raises
        ------
        FilmError
            If none was found.
        """
        system, self.count = self.system, 0
        system.spins[:] = [speed * rotor.ratio for rotor in system.rotors]
        found = None
        if self.slope is not None:
            system.q = system.moved(self._within((speed - self.speed) * self.slope))
            found = self._newton()
        if found is None:
            self._start()
            found = self._newton()
        if found is None:
            raise self._lost(speed)
        self.rest = system.derivatives()
        balance = self._balance([(e.wrench, tangent) for e, tangent in found])
        load = max(float(np.abs(e.wrench[:3]).max()) for e, _ in found)
        require_steady_load(system, self.weights, balance.free, load)
        changed = np.zeros(system.size)
        for film, (_, tangent) in zip(self.films, found, strict=True):
            changed[film.places] -= film.by_spin(tangent)
        free, M = balance.free, system.mass()
        self.slope = -free @ np.linalg.solve(free.T @ balance.K @ free, free.T @ changed)
        self.speed = speed
        D = balance.r_u + M @ system.turning()
        films = [film.found(*of, system.q) for film, of in zip(self.films, found, strict=True)]
        whole = {
            "speeds": speed,
            "mass_matrix": free.T @ M @ free,
            "damping_matrix": free.T @ D @ free,
            "stiffness_matrix": free.T @ balance.K @ free,
            "directions": free,
            "coordinates": system.q.copy(),
            "rates": system.maps() @ system.spin(),
            "residual": float(np.abs(balance.unbalance).max()) / balance.size,
            "evaluations": self.count,
        }
        memories = [film.memory(e, free) for film, (e, _) in zip(self.films, found, strict=True)]
        return {name: np.array(value) for name, value in whole.items()} | {
            name: np.array([film[name] for film in films]) for name in films[0]
        }, tuple(memory for memory in memories if memory is not None)

    def _start(self) -> None:
        """Move all bodies to an initial guess of the equilibrium, and check the assumptions of the theory."""
        self.rest = self.system.derivatives()
        supports = [(np.zeros(6), np.zeros(2)) for _ in self.films]
        for _ in range(3):
            self._update()
            balance = self._balance([film.support(*part) for film, part in zip(self.films, supports, strict=True)])
            require_regular(self.system, self.weights, balance.K, balance.free, NOT_HELD)
            step = balance.newton_step(0.0)
            self.system.q = self.system.moved(min(film.room_of_faces(step) for film in self.films) * step)
            self._update()
            forces = np.array([f.support(*part)[0][:2] for f, part in zip(self.films, supports, strict=True)])
            supports = [place for k, film in enumerate(self.films) for place in film.guess(forces[k:])]
        if self.slope is None:
            require_regular(self.system, self.weights, self.system.mass(), balance.free, NO_MASS)
            require_axis(self.mbs, self.system)
            require_isotropy(self.system, self.weights)

    def _update(self) -> None:
        u = self.system.spin()
        for film in self.films:
            film.update(self.system.q, u)

    def _state(self) -> ForceBalance | None:
        """Balance with all films at the present coordinates and multipliers; None without a film."""
        self._update()
        films: list[FilmTangent] = []
        for film in self.films:
            self.count += 1
            if (evaluation := film.evaluate()) is None:
                return None
            # each film has a separate model, so that the tangent belongs to this evaluation
            films.append((evaluation, evaluation.steady_tangent(exact=True)))
        return self._balance([(e.wrench, tangent) for e, tangent in films], films)

    def _balance(
        self, acting: list[tuple[np.ndarray, np.ndarray]], films: list[FilmTangent] | None = None
    ) -> ForceBalance:
        """Balance of all forces at the state, for wrenches (6,) and tangents (6, 10) of the films."""
        system, size = self.system, 0.0
        r, error = system.balance(system.q, system.spin())
        K, r_u = self.rest[0].copy(), self.rest[1].copy()
        for film, own in zip(self.films, acting, strict=True):
            force, by_place, by_rate = film.loads(*own)
            block = np.ix_(film.places, film.places)
            r[film.places] -= force
            K[block] -= by_place
            r_u[block] -= by_rate
            size += float(force @ force)
        K += r_u @ system.turning()
        for k, rotor in enumerate(system.rotors):
            turns = slice(system.nodes[rotor.nodes[0]].own.start + 3, system.nodes[rotor.nodes[0]].own.stop)
            # the driving torque turns with the axis of its node
            K[turns, turns] -= self.torques[k] * Skew(system.axis(k))
        held = np.vstack((system.constraints(), system.drives()))
        left, values, right = np.linalg.svd(held)
        rank = int(np.sum(values > ROUNDING * values[0]))
        inverse = right[:rank].T / values[:rank] @ left[:, :rank].T
        free = right[rank:].T
        mend = -inverse[:, : error.size] @ error
        scale = max(math.sqrt(size), 1e-300)
        unbalance, forces = self.weights * (free @ (free.T @ r)), -inverse.T @ r
        reach = max(float(np.abs(node.position(system.q)).max()) for node in system.nodes.values())
        rounding = (
            np.finfo(float).resolution * reach * float(np.abs(np.outer(self.weights, self.weights) * K).max()) / scale
        )
        count = system.multipliers.size
        multipliers, torques = system.multipliers + forces[:count], forces[count:]

        def step(resistance: float) -> np.ndarray:
            return mend - free @ damped_step(free.T @ K @ free, free.T @ (r + K @ mend), resistance)

        state = system.q, unbalance, scale, step, films or []
        return ForceBalance(*state, r, K, r_u, free, mend, multipliers, torques, rounding)

    def step(self, state: ForceBalance, resistance: float) -> np.ndarray:
        """Newton's step, shortened if it would close the gap of a film."""
        self.system.q = state.x
        return self._within(state.newton_step(resistance))

    def _within(self, step: np.ndarray) -> np.ndarray:
        """Part of a step from the present coordinates for which all films have room."""
        self._update()
        return min(film.room(step) for film in self.films) * step

    def moved(self, state: ForceBalance, step: np.ndarray) -> ForceBalance | None:
        """Balance after a step, with multipliers and torques that balance the state before it."""
        self.system.q, self.system.multipliers, self.torques = state.x, state.multipliers, state.torques
        self.system.q = self.system.moved(step)
        return self._state()

    def is_balanced(self, state: ForceBalance, tolerance: float) -> bool:
        """Return whether the forces are balanced and the constraints satisfied."""
        balanced = state.residual <= max(tolerance, state.rounding) * state.size
        return balanced and float(np.abs(state.mend).max()) < tolerance * self.length

    def _newton(self) -> list[FilmTangent] | None:
        """Films and tangents of an equilibrium; None if none was found."""
        found = None if (start := self._state()) is None else self.search(start)
        return found.film if found is not None and self.is_balanced(found, self.tolerance) else None

    def _lost(self, speed: float) -> FilmError:
        """Return the error of a search without equilibrium, with the state of the films at its end."""
        self._update()
        states = []
        for film in self.films:
            c = film.bearing.radial_clearance
            e, tilt = np.hypot(*film.motion[:2]) / c, 0.5 * film.bearing.length * np.hypot(*film.motion[2:4]) / c
            states.append(f"joint '{film.name}' at an eccentricity ratio of {e:.4g} with a tilt of {tilt:.4g}")
        return FilmError(
            f"{WHERE}: found no equilibrium at {speed:.6g} rad/s; the search ended with {', '.join(states)}. Begin at "
            "a higher speed and come down in smaller steps, look at loads and clearances, and give films whose "
            "surfaces come to touch a contact (asperity=, contact=)."
        )


def require_regular(
    system: SpinningSystem, weights: np.ndarray, matrix: np.ndarray, free: np.ndarray, message: str
) -> None:
    """Raise `InputError` for a body that moves without stiffness or mass; ``message``: text with a place for its name.

    Parameters
    ----------
    system : SpinningSystem
    weights : (N,) array
        1 for displacements, 1 / length for rotations.
    matrix, free : (N, N), (N, n) arrays
        Stiffness or mass, and the directions that constraints leave.
    """
    scaled = free.T * weights
    _, values, right = np.linalg.svd(scaled @ matrix @ scaled.T)
    if values[-1] <= LEAST * values[0]:
        loose = named(system, int(np.argmax(np.abs(free @ right[-1]) / weights)))
        raise InputError(f"{WHERE}: {message.format(loose)}")


def require_axis(mbs: exu.MainSystem, system: SpinningSystem) -> None:
    """Raise `InputError` for constraints that prevent a rotor's spin; those on coordinates count as drives."""
    kinds = {}
    for number, data in objects_of(mbs):
        kinds.update(dict.fromkeys(map(int, mbs.systemData.GetObjectLTGAE(int(number))), data["objectType"]))
    misfit = np.abs(system.constraints() @ system.spin()) / np.abs(system.spins).max()
    misfit[[kinds.get(k) == "ConnectorCoordinate" for k in range(misfit.size)]] = 0.0
    if misfit.max(initial=0.0) > ISOTROPIC:
        raise InputError(
            f"{WHERE}: a {kinds.get(int(np.argmax(misfit)), 'constraint')} keeps a rotor from turning about its axis; "
            "place nodes, fixed joints and journals on one line, and name what spins by rotors=[...]."
        )


def require_isotropy(system: SpinningSystem, weights: np.ndarray) -> None:
    """Raise `InputError` for rotors that are not the same in all directions, whose equations change as they turn."""
    known, before = system.q, system.matrices()
    system.q = system.turned()
    after = system.matrices()
    system.q = known
    scales, inertia = np.outer(weights, weights), np.diag(before[0]) * weights**2
    for power, what in enumerate(("mass", "damping", "stiffness")):
        sizes = np.abs(before[power] * scales).max(axis=1) + np.abs(system.spins).max() ** power * inertia
        change = np.abs(after[power] - before[power]) * scales / np.sqrt(np.outer(sizes, sizes) + 1e-300)
        if change.max() > ISOTROPIC:
            worst = named(system, int(np.argmax(change.max(axis=1))))
            raise InputError(
                f"{WHERE}: the {what} matrix changes as the rotors turn, by {change.max():.2g} of itself at {worst}; a "
                "rotor must be the same in all directions about its axis (transverse inertias, bending stiffnesses, "
                "springs), with centres of mass, nodes and springs on it."
            )


def require_steady_load(system: SpinningSystem, weights: np.ndarray, free: np.ndarray, size: float) -> None:
    """Raise `InputError` for loads that turn with a rotor, such as an unbalance; ``size``: load of the films, N."""
    known, u = system.q, system.spin()
    before = system.balance(known, u)[0]
    change = np.abs(weights * (free @ (free.T @ (system.balance(system.turned(), u)[0] - before))))
    # force of inertia at one metre from the axis, which positions of this size have as round-off
    inertia = float((np.diag(system.mass()) * weights**2).max() * np.square(system.spins).max())
    if change.max() > ISOTROPIC * size + np.finfo(float).eps * inertia:
        raise InputError(
            f"{WHERE}: the load of {named(system, int(np.argmax(change)))} turns with the rotor, by {change.max():.3g} "
            "N; put its centre of mass on its axis, and leave its unbalance to unbalance_response(...)."
        )


def named(system: SpinningSystem, direction: int) -> str:
    """Name of a direction of x, for messages."""
    for number, node in system.nodes.items():
        if node.own.start <= direction < node.own.stop:
            k = direction - node.own.start
            name = system.mbs.GetNode(NodeIndex(number))["name"]
            return f"node {number} '{name}' {'along' if k < 3 else 'about'} {'xyz'[k % 3]}"
    return f"coordinate {int(system.places[system.own == direction][0])} of the system"
