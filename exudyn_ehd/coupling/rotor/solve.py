"""Equilibrium of rotors in all of their films, followed over the speed.

All coordinates rest but the spins, which are given; the torque that a constant speed takes acts on the driven node, the
first of each rotor, about its own axis. The unknowns are the places of all bodies, by Newton's method with the exact
tangents of the films and differences of the forces of all else (`system`), from speed to speed along the tangent of the
branch, ``K dx/dOmega = -dr/dOmega``.

The first place: every film as a stiff spring tells the load that it has to carry, and `first_guess` the place for that
load.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import NodeIndex, ObjectIndex
from exudyn_ehd.coupling.kinematics.relative import skew
from exudyn_ehd.coupling.rotor.films import FilmLoads, RotorFilm
from exudyn_ehd.coupling.rotor.spinning import WHERE, Rotors, find_rotors
from exudyn_ehd.coupling.rotor.system import SpinningSystem
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.status import FilmError, InputError

# Unbalance over the largest load of a film that counts as none; steps of Newton's method, and of a creep after it.
TOLERANCE, STEPS, CREEP_STEPS, HALVINGS = 1e-8, 25, 200, 8
# Angle by which rotors are turned to see that they are the same in all directions, rad, and how far they may differ.
TURN, ISOTROPIC = 1.0, 1e-4
# Smallest stiffness over the largest, with rotations at the length of a bearing, that holds a body.
SOFTEST = 1e-11
# Resistance at which a creep gives up, over the stiffness of the films as springs.
STIFFEST = 1e6
RANK = 1e-9
FUNCTIONS = ("forceUserFunction", "jacobianUserFunction")


class RotorState(NamedTuple):
    """Equilibrium at one speed; see `RotorResult`."""

    speed: float
    coordinates: np.ndarray
    motion: np.ndarray
    wrench: np.ndarray
    quantities: list[dict[str, float]]
    stiffness: np.ndarray
    damping: np.ndarray
    matrices: tuple[np.ndarray, np.ndarray, np.ndarray]
    directions: np.ndarray
    film_directions: np.ndarray
    rates: np.ndarray
    residual: float
    evaluations: int


class Balance(NamedTuple):
    """All forces at a state, in the N directions x.

    Attributes
    ----------
    r : (N,) array
        What is not in balance, constraints with their multipliers so far included.
    K, r_u : (N, N) arrays
        Its derivatives, K with the turning of the spins.
    free : (N, n) array
        Directions that constraints and drives leave.
    mend : (N,) array
        The way to where constraints hold.
    multipliers : (m + r,) array
        Change of the multipliers, and the torques of the drives.
    residual : float
        Unbalance over the films' loads.
    """

    r: np.ndarray
    K: np.ndarray
    r_u: np.ndarray
    free: np.ndarray
    mend: np.ndarray
    multipliers: np.ndarray
    residual: float


class EquilibriumSearch:
    """Search for the equilibria of one system, whose films are switched off in Exudyn meanwhile (`films_off`).

    Parameters
    ----------
    mbs : exudyn.MainSystem
    joints : list of Joint
    rotors, ratios
        As in `SolveEquilibrium`.
    """

    def __init__(
        self, mbs: exu.MainSystem, joints: list[Joint], rotors: Rotors, ratios: Sequence[float] | None
    ) -> None:
        found = find_rotors(mbs, joints, rotors)
        self.ratios = np.ones(len(found)) if ratios is None else np.asarray(ratios, dtype=float)
        if self.ratios.shape != (len(found),) or not np.all(np.isfinite(self.ratios) & (self.ratios != 0.0)):
            raise InputError(
                f"{WHERE}: ratios must be {len(found)} finite numbers other than 0, one for each rotor (driven nodes "
                f"{[rotor.nodes[0] for rotor in found]}), got {ratios!r}."
            )
        self.mbs, self.system = mbs, SpinningSystem(mbs, found)
        self.films = [RotorFilm(joint, self.system) for joint in joints]
        self.length = max(film.bearing.length for film in self.films)
        self.weights = np.ones(self.system.size)
        for node in self.system.nodes.values():
            self.weights[node.own][3:] = 1.0 / self.length
        self.torques = np.zeros(len(found))
        self.rest: tuple[np.ndarray, np.ndarray]
        self.slope: np.ndarray | None = None
        self.speed, self.count = math.nan, 0

    def at(self, speed: float) -> RotorState:
        """The equilibrium at a speed, rad/s, looked for from the last one found.

        Raises
        ------
        FilmError
            If none was found.
        """
        system, self.count = self.system, 0
        system.spins[:] = speed * self.ratios
        if self.slope is None:
            self._start()
        else:
            self._move((speed - self.speed) * self.slope)
        start = system.q.copy()
        found = self._newton(0.0, STEPS)
        if found is None:
            system.q = start
            found = self._newton(1.0, CREEP_STEPS)
        if found is None:
            raise self._lost(speed)
        evaluations, tangents = found
        self.rest = system.derivatives()
        balance = self._balance([f.loads(e.wrench, t) for f, e, t in zip(self.films, *found, strict=True)])
        self._require_steady_load(balance, max(float(np.linalg.norm(e.wrench[:3])) for e in evaluations))
        changed = np.zeros(system.size)
        for film, tangent in zip(self.films, tangents, strict=True):
            ratio = system.spins[self._rotor_of(film)] / speed
            changed[film.places] -= film.loads(tangent[:, 8] * ratio, tangent).force
        free = balance.free
        self.slope = -free @ np.linalg.solve(free.T @ balance.K @ free, free.T @ changed)
        self.speed = speed
        coefficients = [film.coefficients(t) for film, t in zip(self.films, tangents, strict=True)]
        M, S = system.mass(), system.turning()
        return RotorState(
            speed,
            system.q.copy(),
            np.array([film.motion for film in self.films]),
            np.array([e.wrench for e in evaluations]),
            [e.quantities() for e in evaluations],
            np.array([K for K, _ in coefficients]),
            np.array([C for _, C in coefficients]),
            tuple(free.T @ matrix @ free for matrix in (M, balance.r_u + M @ S, balance.K)),
            free,
            np.array([film.rows() for film in self.films]),
            system.maps() @ system.spin(),
            balance.residual,
            self.count,
        )

    def _rotor_of(self, film: RotorFilm) -> int:
        node = int(film.journal.side.nodes[0])
        return next(k for k, rotor in enumerate(self.system.rotors) if node in rotor.nodes)

    def _start(self) -> None:
        """Move all bodies to a first place near the equilibrium, and check what the theory asks of them."""
        self.rest = self.system.derivatives()
        supports = [(np.zeros(2), np.zeros(2)) for _ in self.films]
        for _ in range(3):
            self._update()
            springs = [film.support(*part) for film, part in zip(self.films, supports, strict=True)]
            balance = self._balance([f.loads(*spring) for f, spring in zip(self.films, springs, strict=True)])
            self._require_held(balance)
            self.system.q = self.system.moved(self._step(balance))
            self._update()
            forces = [f.support(*part)[0][:2] for f, part in zip(self.films, supports, strict=True)]
            supports = [(force, film.guess(-force)) for film, force in zip(self.films, forces, strict=True)]
        self._require_axis()
        self._require_isotropy()

    def _update(self) -> None:
        u = self.system.spin()
        for film in self.films:
            film.update(self.system.q, u)

    def _films(self) -> tuple[list[Evaluation], list[np.ndarray]] | None:
        """Films and tangents at the state; None without a film."""
        self._update()
        evaluations, tangents = [], []
        for film in self.films:
            self.count += 1
            evaluation = film.evaluate()
            if evaluation is None:
                return None
            evaluations.append(evaluation)
            # films of one bearing's description have models of their own: the tangent is this evaluation's
            tangents.append(evaluation.tangent())
        return evaluations, tangents

    def _balance(self, loads: list[FilmLoads]) -> Balance:
        """All forces at the state, for the last derivatives of the system without films."""
        system, size = self.system, sum(part.force @ part.force for part in loads)
        r, error = system.balance(system.q, system.spin())
        K, r_u = self.rest[0].copy(), self.rest[1].copy()
        for film, part in zip(self.films, loads, strict=True):
            block = np.ix_(film.places, film.places)
            r[film.places] -= part.force
            K[block] -= part.by_place
            r_u[block] -= part.by_rate
        K += r_u @ system.turning()
        for k, rotor in enumerate(system.rotors):
            own = slice(system.nodes[rotor.nodes[0]].own.start + 3, system.nodes[rotor.nodes[0]].own.stop)
            # the driving torque follows the axis of its node
            K[own, own] -= self.torques[k] * skew(system.axis(k, 0))
        held = np.vstack((system.constraints(), system.drives()))
        left, values, right = np.linalg.svd(held)
        rank = int(np.sum(values > RANK * values[0]))
        inverse = right[:rank].T / values[:rank] @ left[:, :rank].T
        free = right[rank:].T
        mend = -inverse[:, : error.size] @ error
        scale = max(math.sqrt(size), 1e-300)
        residual = float(np.abs(self.weights * (free @ (free.T @ r))).max()) / scale
        return Balance(r, K, r_u, free, mend, -inverse.T @ r, residual)

    def _step(self, balance: Balance, resistance: np.ndarray | float = 0.0) -> np.ndarray:
        """Newton's step (size,), against a resistance (size, size)."""
        free, mend = balance.free, balance.mend
        K = balance.K + resistance
        return mend - free @ np.linalg.solve(free.T @ K @ free, free.T @ (balance.r + balance.K @ mend))

    def _move(self, step: np.ndarray) -> None:
        """Move the state by a step, shortened where it would use up the gap of a film."""
        self._update()
        self.system.q = self.system.moved(min(film.room(step) for film in self.films) * step)

    def _newton(self, share: float, most: int) -> tuple[list[Evaluation], list[np.ndarray]] | None:
        """Films and tangents of an equilibrium; None if none was found within ``most`` steps.

        With a ``share`` of the films' reference stiffness journals creep against a resistance, that falls as the
        unbalance does; a step that increases it is taken back and the resistance grows.
        """
        system, films = self.system, self._films()
        known: tuple[np.ndarray, Balance, np.ndarray] | None = None
        for _ in range(most):
            balance = parts = None
            if films is not None:
                parts = [f.loads(e.wrench, t) for f, e, t in zip(self.films, *films, strict=True)]
                balance = self._balance(parts)
                if balance.residual < TOLERANCE and np.abs(balance.mend).max() < TOLERANCE * self.length:
                    return films
            if balance is not None and parts and not (share and known and balance.residual >= known[1].residual):
                known, share = (system.q.copy(), balance, self._resistance(parts)), 0.2 * share
                count = system.multipliers.size
                system.multipliers = system.multipliers + balance.multipliers[:count]
                self.torques = balance.multipliers[count:]
            elif known is None or share == 0.0 or share > STIFFEST:
                return None
            else:
                system.q, share = known[0], 4.0 * share
            try:
                self._move(self._step(known[1], share * known[2]))
            except np.linalg.LinAlgError:
                return None
            films = self._films()
        return None

    def _resistance(self, parts: list[FilmLoads]) -> np.ndarray:
        """The films as springs about where their journals are (size, size)."""
        out = np.zeros((self.system.size, self.system.size))
        for film, part in zip(self.films, parts, strict=True):
            slopes = part.motion_by_place[:2]
            out[np.ix_(film.places, film.places)] += film.support_stiffness * slopes.T @ slopes
        return out

    def _require_held(self, balance: Balance) -> None:
        """Refuse a body that may move without resistance."""
        scaled = balance.free.T * self.weights
        _, values, right = np.linalg.svd(scaled @ balance.K @ scaled.T)
        if values[-1] > SOFTEST * values[0]:
            return
        loose = balance.free @ right[-1]
        worst = int(np.argmax(np.abs(loose) / self.weights))
        raise InputError(
            f"{WHERE}: nothing holds {self._named(worst)}; hold it by a film, a spring or a constraint, a shaft along "
            "its axis by CreateLubricatedJoint(axial=ehd.Held())."
        )

    def _require_axis(self) -> None:
        """Refuse constraints that keep a rotor from turning about its axis; those on coordinates count as drives."""
        system, kinds = self.system, self._equations()
        misfit = np.abs(system.constraints() @ system.spin()) / np.abs(system.spins).max()
        misfit[[kinds.get(k) == "ConnectorCoordinate" for k in range(misfit.size)]] = 0.0
        if misfit.max(initial=0.0) > ISOTROPIC:
            raise InputError(
                f"{WHERE}: a {kinds.get(int(np.argmax(misfit)), 'constraint')} keeps a rotor from turning about its "
                "axis; place nodes, fixed joints and journals on one line, and name what spins by rotors=[...]."
            )

    def _require_isotropy(self) -> None:
        """Refuse rotors that are not the same in all directions: their equations change as they turn."""
        system, known = self.system, self.system.q
        before = self._matrices_without_films()
        system.q = system.turned(TURN)
        after = self._matrices_without_films()
        system.q = known
        inertia, speed = np.diag(before[0]) * self.weights**2, np.abs(system.spins).max()
        for power, (first, last, what) in enumerate(zip(before, after, ("mass", "damping", "stiffness"), strict=True)):
            scaled = np.outer(self.weights, self.weights)
            sizes = np.abs(first * scaled).max(axis=1) + speed**power * inertia
            change = np.abs(last - first) * scaled / np.sqrt(np.outer(sizes, sizes) + 1e-300)
            if change.max() > ISOTROPIC:
                worst = int(np.unravel_index(int(np.argmax(change)), change.shape)[0])
                raise InputError(
                    f"{WHERE}: the {what} matrix changes as the rotors turn, by {change.max():.2g} of itself at "
                    f"{self._named(worst)}; a rotor must be the same in all directions about its axis (transverse "
                    "inertias, bending stiffnesses, springs), with centres of mass, nodes and springs on it."
                )

    def _require_steady_load(self, balance: Balance, size: float) -> None:
        """Refuse loads that turn with a rotor, as the unbalance that its model has."""
        system, known, u = self.system, self.system.q, self.system.spin()
        r = system.balance(known, u)[0]
        system.q = system.turned(TURN)
        change = self.weights * (balance.free @ (balance.free.T @ (system.balance(system.q, u)[0] - r)))
        system.q = known
        if np.abs(change).max() > ISOTROPIC * size:
            raise InputError(
                f"{WHERE}: the load of {self._named(int(np.argmax(np.abs(change))))} turns with the rotor, by "
                f"{np.abs(change).max():.3g} N; put its centre of mass on its axis, and leave its unbalance to "
                "unbalance_response(...)."
            )

    def _matrices_without_films(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M, D, K (size, size) without films at the state."""
        M, S, (r_x, r_u) = self.system.mass(), self.system.turning(), self.system.derivatives()
        return M, r_u + M @ S, r_x + r_u @ S

    def _equations(self) -> dict[int, str]:
        """Type of the object of every constraint equation."""
        found = {}
        for number in range(self.mbs.systemData.NumberOfObjects()):
            for place in self.mbs.systemData.GetObjectLTGAE(ObjectIndex(number)):
                found[int(place)] = str(self.mbs.GetObject(ObjectIndex(number))["objectType"])
        return found

    def _named(self, direction: int) -> str:
        """A direction of x in words."""
        for number, node in self.system.nodes.items():
            if node.own.start <= direction < node.own.stop:
                k = direction - node.own.start
                name = self.mbs.GetNode(NodeIndex(number))["name"]
                return f"node {number} '{name}' {'along' if k < 3 else 'about'} {'xyz'[k % 3]}"
        return f"coordinate {int(self.system.places[self.system.own == direction][0])} of the system"

    def _lost(self, speed: float) -> FilmError:
        """What the films looked like when the search gave up."""
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


@contextmanager
def films_off(mbs: exu.MainSystem, joints: list[Joint]) -> Iterator[None]:
    """Let Exudyn see no films: they are evaluated here, once per state."""
    kept = []
    try:
        for joint in joints:
            number = joint.objectNumber
            kept += [(number, name, mbs.GetObjectParameter(number, name)["function"]) for name in FUNCTIONS]
            mbs.SetObjectParameter(number, FUNCTIONS[0], lambda mbs, t, item, q, q_t: np.zeros(len(q)))
            mbs.SetObjectParameter(number, FUNCTIONS[1], lambda mbs, t, item, q, *rest: np.zeros((len(q), len(q))))
        yield
    finally:
        for number, name, function in kept:
            mbs.SetObjectParameter(number, name, function)
        for joint in joints:
            joint.element.forget()
