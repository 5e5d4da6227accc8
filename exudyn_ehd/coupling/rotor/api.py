"""User functions: equilibria over the speed, the onset speed of instability, and that speed over a parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

import exudyn as exu
import numpy as np
import scipy

from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, Index, objects_of, require_system
from exudyn_ehd.coupling.rotor.result import Layout, RotorResult
from exudyn_ehd.coupling.rotor.solve import EquilibriumSearch, State
from exudyn_ehd.coupling.rotor.spinning import WHERE
from exudyn_ehd.coupling.run.solve import joints_of
from exudyn_ehd.joint.static.dynamic_stiffness import SCAN
from exudyn_ehd.pictures.records import Axes, Figure, Target, Unit
from exudyn_ehd.status import InputError, require_number, require_plausible

# Configurations of a system that the search overwrites, although a run or its history continues from them.
CONFIGURATIONS = (CURRENT, START_OF_STEP)
# User functions of films, which are removed from Exudyn during a search, because films are evaluated here once per
# state.
FUNCTIONS = ("forceUserFunction", "jacobianUserFunction")


@dataclass(frozen=True, kw_only=True, eq=False)
class StabilityMap:
    """Threshold speeds over a parameter, of `stability_map`.

    Attributes
    ----------
    values : (k,) array
        Values of the parameter.
    thresholds : (k,) array
        Threshold speeds, rad/s; inf if the rotor is stable up to the highest speed, 0 if it is unstable at the lowest.
    whirl_ratios : (k,) array
        Frequency at the threshold over the speed; nan without one.
    limits : (float, float)
        Lowest and highest speed, rad/s.

    Examples
    --------
    After the example of `stability_map`:

    >>> map.whirl_ratios.round(2)
    array([0.5])
    """

    values: np.ndarray
    thresholds: np.ndarray
    whirl_ratios: np.ndarray
    limits: tuple[float, float]

    def plot(
        self, text: str, *, unit: str = "-", factor: float = 1.0, ax: Axes | None = None, path: Target = None
    ) -> Figure:
        """Stable and unstable speeds over the parameter, called ``text`` and shown as ``factor`` times its values."""
        from exudyn_ehd.pictures.curves import plot_map

        return plot_map(self.values, self.thresholds, self.limits, (text, Unit(unit, factor)), ax=ax, path=path)


def SolveEquilibrium(
    mbs: exu.MainSystem,
    speeds: float | Sequence[float] | np.ndarray,
    *,
    rotors: Sequence[Index | Sequence[Index]] | None = None,
    ratios: Sequence[float] | None = None,
) -> RotorResult:
    """Find the equilibrium of spinning rotors in all their films at given speeds, and linearise the system about it.

    All bodies are at rest except for the given spins; films, springs and constraints carry the static loads. The
    system's states are not changed. The equations are in `exudyn_ehd.coupling.rotor.system`.

    - Rotors: rigid bodies (any 3D node), one or several with fixed joints or springs between them, and
      ``ObjectBeamGeometricallyExact`` on rigid nodes. They must be the same in all directions about their axes;
      unbalance comes in by `RotorResult.unbalance_response`.
    - Loads with user functions have their value at the start time.
    - Tilting pads: every pad is a film of the result, called "... pad 1" and so on, in the frame of the pad. Its tilt
      and its shift on a flexible pivot, with their inertia, take part in all vibrations.
    - Bearings: rigid surfaces, liners, flexible bushes and journals, but not those of finite-element bodies (`FEBore`,
      `FEJournal`), whose modes have mass. Bushes and journals deflect without inertia; the mesh of an `ANCFBush` counts
      as a rigid part of its housing. With `ElrodAdams` and on surfaces that deflect, the film follows a motion with a
      delay: stiffness and damping are used at the frequency of each vibration and whirl
      (`exudyn_ehd.joint.static.dynamic_stiffness`). Films with heat have the temperature of the equilibrium, which
      vibrations do not change; nothing wears. Films on end faces take part, but the result's values of single films
      omit them.
    - A film without load: at the exact centre K and C are those slightly off it. They are half to two thirds of those
      of an unbroken film, since the film ruptures on the side that opens (`exudyn_ehd.joint.model.rigid`).

    Parameters
    ----------
    mbs : exudyn.MainSystem
        Assembled, with lubricated joints whose journals spin.
    speeds : float or (k,) array
        Speeds of the first rotor about its joint's z axis, rad/s, not 0. The search for each equilibrium starts from
        the one before, so give them in order.
    rotors : sequence or None, default None
        One entry for every rotor: one of its bodies or nodes, or a sequence of all its bodies and nodes. With one
        entry, all bodies are added that turn with it through beams, fixed joints and springs that hold all rotations.
        In each rotor the first body is driven at the constant speed, the others may twist against it. None: the rotors
        of all journals.
    ratios : (r,) sequence or None, default None
        Speed of each rotor divided by that of the first one, negative for the opposite sense; 1 by default.

    Returns
    -------
    RotorResult

    Raises
    ------
    InputError
        For systems outside the theory: rotors that are not the same in all directions, bodies that nothing holds, other
        kinds of films or bodies.
    FilmError
        If no equilibrium was found at a speed; if a film there is too hot for any oil or outside the oil's table; or if
        one is at the exact centre of a bearing with supply areas at the cavity pressure, where stiffness and damping
        are not defined.

    Examples
    --------
    After the example of `Held`, the shaft in its two films under a load:

    >>> load = mbs.CreateForce(itemNumber=shaft, localPosition=[0, 0, 0.1], loadVector=[0, -100, 0])
    >>> mbs.Assemble()
    >>> result = ehd.SolveEquilibrium(mbs, [600.0, 5000.0])
    >>> result.eccentricity_ratio.round(4)  # speeds, films
    array([[0.0092, 0.0092],
           [0.0011, 0.0011]])
    """
    values = np.atleast_1d(np.asarray(speeds, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.all(np.isfinite(values) & (values != 0.0)):
        raise InputError(f"{WHERE}.speeds must be finite numbers other than 0 in rad/s, got {speeds!r}.")
    if not np.all(np.sign(values) == np.sign(values[0])):
        raise InputError(f"{WHERE}.speeds must be of one sign, got {speeds!r}; solve once for each sense of rotation.")
    require_plausible(f"{WHERE}: speeds", speeds, values)
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
    """Find the lowest speed, within limits, at which rotors in their films become unstable.

    At the threshold the largest real part of the eigenvalues changes its sign; the relative error of the speed is 1e-9.
    The search starts with 16 speeds: a range of instability narrower than their distance may be missed.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        As in `SolveEquilibrium`.
    rotors, ratios : sequence or None, default None
        As in `SolveEquilibrium`.
    lowest, highest : float
        Speeds of the first rotor, rad/s, 0 < lowest < highest.

    Returns
    -------
    RotorResult or None
        Result at the threshold speed, ``speeds[0]``; None if the rotor is stable up to ``highest``.

    Raises
    ------
    InputError, FilmError
        As `SolveEquilibrium`, and if the rotor is unstable at ``lowest`` already.

    Examples
    --------
    After the example of `SolveEquilibrium`:

    >>> threshold = ehd.SolveThreshold(mbs, 600.0, 5000.0)
    >>> round(float(threshold.speeds[0]))  # rad/s
    1050
    """
    low, high = _limits("SolveThreshold", lowest, highest)
    with _search(mbs, rotors, ratios) as search:
        found, unstable = _threshold(search, low, high)
    if unstable:
        raise InputError(
            f"SolveThreshold: the rotor is unstable at lowest = {low:.6g} rad/s already; begin at a lower speed."
        )
    return found


def stability_map(
    make: Callable[[float], exu.MainSystem], values: Sequence[float] | np.ndarray, *, lowest: float, highest: float
) -> StabilityMap:
    """Find the speed at which a rotor becomes unstable, for every value of a parameter such as a clearance or a load.

    Parameters
    ----------
    make : function
        ``make(value)`` returns a new, assembled system (``mbs``) with this value of the parameter.
    values : (k,) sequence
        Values of the parameter, in its own unit.
    lowest, highest : float
        Speeds between which thresholds are searched for, rad/s, as in `SolveThreshold`.

    Returns
    -------
    StabilityMap

    Raises
    ------
    InputError, FilmError
        As `SolveThreshold`.

    Examples
    --------
    After the example of `SolveThreshold`:

    >>> map = ehd.stability_map(lambda load: mbs, [1.0], lowest=600.0, highest=5000.0)
    >>> map.thresholds.round()
    array([1050.])
    """
    low, high = _limits("stability_map", lowest, highest)
    thresholds, ratios = [], []
    for value in values:
        with _search(make(value), None, None) as search:
            found, unstable = _threshold(search, low, high)
        thresholds.append(np.inf if found is None else 0.0 if unstable else float(found.speeds[0]))
        worst = None if found is None or unstable else found.eigenvalues[0, np.nanargmax(found.eigenvalues[0].real)]
        ratios.append(np.nan if worst is None else abs(worst.imag) / thresholds[-1])
    return StabilityMap(
        values=np.array(values, dtype=float),
        thresholds=np.array(thresholds),
        whirl_ratios=np.array(ratios),
        limits=(low, high),
    )


def _limits(where: str, lowest: float, highest: float) -> tuple[float, float]:
    low = require_number(f"{where}: lowest", lowest, "rad/s", above=0.0)
    return low, require_number(f"{where}: highest", highest, "rad/s", above=low)


def _threshold(search: EquilibriumSearch, low: float, high: float) -> tuple[RotorResult | None, bool]:
    """Return the result at the lowest threshold, None without one, and whether the rotor is unstable at ``low``."""

    def at(speed: float) -> RotorResult:
        return _result(search, [search.at(speed)])

    def growth(speed: float) -> float:
        return float(at(speed).growth[0])

    first = at(low)
    if first.growth[0] >= 0.0:
        return first, bool(first.growth[0] > 0.0)
    for before, speed in pairwise(np.geomspace(low, high, SCAN).tolist()):
        if growth(speed) >= 0.0:
            return at(float(scipy.optimize.brentq(growth, before, speed, rtol=1e-9))), False
    return None, False


@contextmanager
def _search(
    mbs: exu.MainSystem, rotors: Sequence[Index | Sequence[Index]] | None, ratios: Sequence[float] | None
) -> Iterator[EquilibriumSearch]:
    """Context with a search in a system, whose states and films are restored at the end."""
    require_system(WHERE, mbs, assembled=True)
    if not (joints := joints_of(mbs)):
        raise InputError(f"{WHERE}: the system has no lubricated joint; create its bearings by CreateLubricatedJoint.")
    for joint in joints:
        joint.element.presence.require(mbs)
    data = mbs.systemData
    kept = [(c, data.GetSystemState(c), data.GetODE2Coordinates_tt(c), data.GetTime(c)) for c in CONFIGURATIONS]
    numbers = [joint.objectNumber for joint in joints]
    films = [
        (number, name, mbs.GetObjectParameter(number, name)["function"]) for number in numbers for name in FUNCTIONS
    ]
    try:
        for number in numbers:
            mbs.SetObjectParameter(number, FUNCTIONS[0], lambda mbs, t, item, q, q_t: np.zeros(len(q)))
            mbs.SetObjectParameter(number, FUNCTIONS[1], lambda mbs, t, item, q, *rest: np.zeros((len(q), len(q))))
        yield EquilibriumSearch(mbs, joints, rotors, ratios)
    finally:
        for number, name, function in films:
            mbs.SetObjectParameter(number, name, function)
        for joint in joints:
            joint.element.forget()
        for configuration, state, accelerations, time in kept:
            data.SetSystemState(state, configuration)
            data.SetODE2Coordinates_tt(accelerations, configuration)
            data.SetTime(time, configuration)


def _result(search: EquilibriumSearch, states: list[State]) -> RotorResult:
    """Result with the states of one search."""
    system = search.system
    layout = Layout(
        nodes={number: node.own.start for number, node in system.nodes.items()},
        bodies={int(k): int(data["nodeNumber"]) for k, data in objects_of(search.mbs) if "nodeNumber" in data},
        frames={node: rotor.frame for rotor in system.rotors for node in rotor.nodes},
        ratios=system.ratios,
        length=search.length,
    )
    return RotorResult(
        joints=tuple(film.name for film in search.films),
        clearances=np.array([film.bearing.radial_clearance for film in search.films]),
        layout=layout,
        memories=tuple(memories for _, memories in states),
        **{name: np.array([values[name] for values, _ in states]) for name in states[0][0]},
    )
