"""What users call: equilibria over the speed, the speed at which they become unstable, that speed over a parameter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise

import exudyn as exu
import numpy as np
from scipy.optimize import brentq

from exudyn_ehd.coupling.contract import Index, ObjectIndex, require_system
from exudyn_ehd.coupling.rotor.result import Layout, RotorResult
from exudyn_ehd.coupling.rotor.solve import EquilibriumSearch, RotorState, films_off
from exudyn_ehd.coupling.rotor.spinning import WHERE
from exudyn_ehd.coupling.run.solve import joints_of, require_items
from exudyn_ehd.status import InputError, require_number

# Speeds at which a threshold is first looked for between its limits.
SCAN = 16


def SolveEquilibrium(
    mbs: exu.MainSystem,
    speeds: float | Sequence[float] | np.ndarray,
    *,
    rotors: Sequence[Index | Sequence[Index]] | None = None,
    ratios: Sequence[float] | None = None,
) -> RotorResult:
    """Equilibrium of spinning rotors in all of their films at given speeds, linearised with all that the system holds.

    All bodies rest but for the given spins; films, springs and constraints carry the static loads. The equations stand
    in `exudyn_ehd.coupling.rotor.system`. The system's states stay as they are.

    Rotors are made of rigid bodies (any 3D node), also of several with fixed joints or springs between them, and of
    ``ObjectBeamGeometricallyExact`` on rigid nodes. They must be the same in all directions about their axes, their
    unbalance is left to `RotorResult.unbalance_response`. Loads with user functions count as they are at the start
    time. Bearings have rigid surfaces and films whose K and C hold at any frequency: no `ElrodAdams`, heat, wear,
    liners, flexible bushes.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        Assembled, with lubricated joints whose journals spin.
    speeds : float or (k,) array
        Of the first rotor about its joint's z axis, rad/s, not 0. Each is looked for from the one before.
    rotors : sequence, optional
        One entry for every rotor: a body or node, to which all is added that turns with it through beams, fixed joints
        and springs that hold all rotations; or a sequence of all of its bodies and nodes. The first one is driven at
        the constant speed, the others may twist against it. By default those of all journals.
    ratios : (r,) sequence, optional
        Speeds of the rotors over that of the first; 1 by default.

    Returns
    -------
    RotorResult

    Raises
    ------
    InputError
        For what the theory does not hold for: rotors that are not the same in all directions, bodies that nothing
        holds, other kinds of films or bodies.
    FilmError
        If no equilibrium was found at a speed.

    Examples
    --------
    After the example of `JournalBearing`, a shaft of 40 kg in two bearings:

    >>> mbs = exu.SystemContainer().AddSystem()
    >>> inertia = exu.utilities.InertiaCylinder(density=7850.0, length=0.4, outerRadius=0.0636, axis=2)
    >>> items = [mbs.CreateGround(), mbs.CreateRigidBody(inertia=inertia, gravity=[0, -9.81, 0])]
    >>> for z, axial in ((-0.15, ehd.Held()), (0.15, None)):
    ...     _ = ehd.CreateLubricatedJoint(mbs, f"at {z}", items, [0, 0, z], [0, 0, 1], bearing, axial=axial)
    >>> mbs.Assemble(); result = ehd.SolveEquilibrium(mbs, [300.0, 900.0])
    """
    values = np.atleast_1d(np.asarray(speeds, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.all(np.isfinite(values) & (values != 0.0)):
        raise InputError(f"{WHERE}.speeds must be finite numbers other than 0 in rad/s, got {speeds!r}.")
    if not np.all(np.sign(values) == np.sign(values[0])):
        raise InputError(f"{WHERE}.speeds must be of one sign, got {speeds!r}; solve once for each sense of rotation.")
    with _search(mbs, rotors, ratios) as search:
        return _result(search, [search.at(float(speed)) for speed in values])


def SolveThreshold(
    mbs: exu.MainSystem,
    lowest: float,
    highest: float,
    *,
    rotors: Sequence[Index | Sequence[Index]] | None = None,
    ratios: Sequence[float] | None = None,
) -> RotorResult | None:
    """The lowest speed between two at which rotors in their films become unstable.

    The largest real part of the eigenvalues changes its sign there, to 1e-9 of the speed; it is looked for between 16
    speeds, so that ranges of instability narrower than their distance may be missed.

    Parameters
    ----------
    mbs, rotors, ratios
        As in `SolveEquilibrium`.
    lowest, highest : float
        Speeds of the first rotor, rad/s, 0 < lowest < highest.

    Returns
    -------
    RotorResult or None
        At the threshold alone; None if the rotor is stable up to ``highest``.

    Raises
    ------
    InputError, FilmError
        As `SolveEquilibrium`, and if the rotor is unstable at ``lowest`` already.

    Examples
    --------
    After the example of `SolveEquilibrium`:

    >>> threshold = ehd.SolveThreshold(mbs, 300.0, 900.0)
    >>> round(float(threshold.speeds[0]))
    663
    """
    low = require_number("SolveThreshold: lowest", lowest, "rad/s", above=0.0)
    high = require_number("SolveThreshold: highest", highest, "rad/s", above=low)
    with _search(mbs, rotors, ratios) as search:

        def growth(speed: float) -> float:
            return float(_result(search, [search.at(speed)]).growth[0])

        speeds = np.geomspace(low, high, SCAN)
        if growth(low) >= 0.0:
            raise InputError(
                f"SolveThreshold: the rotor is unstable at lowest = {low:.6g} rad/s already; begin at a lower speed."
            )
        for before, speed in pairwise(speeds):
            if growth(float(speed)) >= 0.0:
                found = float(brentq(growth, before, speed, rtol=1e-9))
                return _result(search, [search.at(found)])
    return None


@contextmanager
def _search(
    mbs: exu.MainSystem, rotors: Sequence[Index | Sequence[Index]] | None, ratios: Sequence[float] | None
) -> Iterator[EquilibriumSearch]:
    """A search in a system that gets its states and films back."""
    require_system(WHERE, mbs)
    if not mbs.systemIsConsistent:
        raise InputError(f"{WHERE}: the system is not assembled; call mbs.Assemble() first.")
    require_items(mbs)
    joints = joints_of(mbs)
    if not joints:
        raise InputError(f"{WHERE}: the system has no lubricated joint; create its bearings by CreateLubricatedJoint.")
    state = mbs.systemData.GetSystemState(exu.ConfigurationType.Current)
    try:
        with films_off(mbs, joints):
            yield EquilibriumSearch(mbs, joints, rotors, ratios)
    finally:
        mbs.systemData.SetSystemState(state, exu.ConfigurationType.Current)


def _result(search: EquilibriumSearch, states: list[RotorState]) -> RotorResult:
    """The record of states of one search."""
    system, films = search.system, search.films
    clearances = np.array([film.bearing.radial_clearance for film in films])
    motion, wrench = np.array([s.motion for s in states]), np.array([s.wrench for s in states])
    angles = np.arctan2(motion[:, :, 1], motion[:, :, 0]) - np.arctan2(-wrench[:, :, 1], -wrench[:, :, 0])
    angles = np.angle(np.exp(1j * angles * np.sign(motion[:, :, 8])))
    frames = {
        node: (rotor.frame, float(ratio))
        for rotor, ratio in zip(system.rotors, search.ratios, strict=True)
        for node in rotor.nodes
    }
    bodies = {}
    for number in range(search.mbs.systemData.NumberOfObjects()):
        data = search.mbs.GetObject(ObjectIndex(number))
        if data["objectType"] == "RigidBody":
            bodies[number] = int(data["nodeNumber"])

    def quantity(name: str) -> np.ndarray:
        return np.array([[film[name] for film in s.quantities] for s in states])

    return RotorResult(
        speeds=np.array([s.speed for s in states]),
        joints=tuple(film.name for film in films),
        motion=motion,
        wrench=wrench,
        eccentricity_ratio=np.hypot(motion[:, :, 0], motion[:, :, 1]) / clearances,
        attitude_angle=angles,
        minimum_gap=quantity("minimum_gap"),
        peak_pressure=quantity("peak_pressure"),
        power_loss=quantity("power_loss"),
        stiffness=np.array([s.stiffness for s in states]),
        damping=np.array([s.damping for s in states]),
        mass_matrix=np.array([s.matrices[0] for s in states]),
        damping_matrix=np.array([s.matrices[1] for s in states]),
        stiffness_matrix=np.array([s.matrices[2] for s in states]),
        directions=np.array([s.directions for s in states]),
        film_directions=np.array([s.film_directions for s in states]),
        coordinates=np.array([s.coordinates for s in states]),
        rates=np.array([s.rates for s in states]),
        residual=np.array([s.residual for s in states]),
        evaluations=np.array([s.evaluations for s in states]),
        clearances=clearances,
        layout=Layout(
            nodes={number: node.own.start for number, node in system.nodes.items()}, bodies=bodies, frames=frames
        ),
    )
