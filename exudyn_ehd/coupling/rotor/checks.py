"""What the theory of rotors asks of a system, or refuses by name."""

from __future__ import annotations

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import NodeIndex, ObjectIndex
from exudyn_ehd.coupling.rotor.spinning import WHERE
from exudyn_ehd.coupling.rotor.system import SpinningSystem
from exudyn_ehd.status import InputError

# Angle by which rotors are turned to see that they are the same in all directions, rad, and how far they may differ.
TURN, ISOTROPIC = 1.0, 1e-4
# Smallest stiffness over the largest, with rotations at the length of a bearing, that holds a body.
SOFTEST = 1e-11
LIGHTEST = 1e-13


def require_held(system: SpinningSystem, weights: np.ndarray, K: np.ndarray, free: np.ndarray) -> None:
    """Refuse a body that may move without resistance.

    Parameters
    ----------
    system : SpinningSystem
    weights : (N,) array
        1 for displacements, 1 / length for rotations.
    K, free : (N, N), (N, n) arrays
        Stiffness, and the directions that constraints leave.
    """
    scaled = free.T * weights
    _, values, right = np.linalg.svd(scaled @ K @ scaled.T)
    if values[-1] <= SOFTEST * values[0]:
        loose = named(system, int(np.argmax(np.abs(free @ right[-1]) / weights)))
        raise InputError(
            f"{WHERE}: nothing holds {loose}; hold it by a film, a spring or a constraint, a shaft along its axis by "
            "CreateLubricatedJoint(axial=ehd.Held())."
        )


def require_mass(system: SpinningSystem, weights: np.ndarray, M: np.ndarray, free: np.ndarray) -> None:
    """Refuse bodies without mass, as `require_held` those without stiffness."""
    scaled = free.T * weights
    values, vectors = np.linalg.eigh(scaled @ M @ scaled.T)
    if values[0] <= LIGHTEST * values[-1]:
        light = named(system, int(np.argmax(np.abs(free @ vectors[:, 0]) / weights)))
        raise InputError(f"{WHERE}: {light} moves without mass or inertia; give its body both, or hold it.")


def require_axis(mbs: exu.MainSystem, system: SpinningSystem) -> None:
    """Refuse constraints that keep a rotor from turning about its axis; those on coordinates count as drives."""
    kinds = {}
    for number in map(ObjectIndex, range(mbs.systemData.NumberOfObjects())):
        kinds.update(
            dict.fromkeys(map(int, mbs.systemData.GetObjectLTGAE(number)), mbs.GetObject(number)["objectType"])
        )
    misfit = np.abs(system.constraints() @ system.spin()) / np.abs(system.spins).max()
    misfit[[kinds.get(k) == "ConnectorCoordinate" for k in range(misfit.size)]] = 0.0
    if misfit.max(initial=0.0) > ISOTROPIC:
        raise InputError(
            f"{WHERE}: a {kinds.get(int(np.argmax(misfit)), 'constraint')} keeps a rotor from turning about its axis; "
            "place nodes, fixed joints and journals on one line, and name what spins by rotors=[...]."
        )


def require_isotropy(system: SpinningSystem, weights: np.ndarray) -> None:
    """Refuse rotors that are not the same in all directions: their equations change as they turn."""
    known, before = system.q, system.matrices()
    system.q = system.turned(TURN)
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
    """Refuse loads that turn with a rotor, as the unbalance that its model has; ``size`` is the films' load, N."""
    known, u = system.q, system.spin()
    before = system.balance(known, u)[0]
    change = np.abs(weights * (free @ (free.T @ (system.balance(system.turned(TURN), u)[0] - before))))
    if change.max() > ISOTROPIC * size:
        raise InputError(
            f"{WHERE}: the load of {named(system, int(np.argmax(change)))} turns with the rotor, by {change.max():.3g} "
            "N; put its centre of mass on its axis, and leave its unbalance to unbalance_response(...)."
        )


def named(system: SpinningSystem, direction: int) -> str:
    """A direction of x in words."""
    for number, node in system.nodes.items():
        if node.own.start <= direction < node.own.stop:
            k = direction - node.own.start
            name = system.mbs.GetNode(NodeIndex(number))["name"]
            return f"node {number} '{name}' {'along' if k < 3 else 'about'} {'xyz'[k % 3]}"
    return f"coordinate {int(system.places[system.own == direction][0])} of the system"
