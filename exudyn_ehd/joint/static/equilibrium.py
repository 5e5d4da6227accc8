"""The position in which a film carries a steady load, with stiffness, damping and whirl threshold.

If several positions carry one load, the most stable of those found is returned.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import overload

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.joint.balance.position import (
    LineSearch,
    LoadSearch,
    first_guess,
    require_turning,
    steadiest,
    turning,
)
from exudyn_ehd.joint.balance.steady_film import Place, evaluate_at
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.results import remembered
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.newton import SETTLED
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.joint.static.dynamic_stiffness import (
    FilmResponse,
    require_derivatives,
    response_of,
    slow_motions,
    threshold,
    whirl_stiffness,
    whirl_threshold,
)
from exudyn_ehd.joint.static.pad_equilibrium import TiltingPadResult, pad_equilibrium
from exudyn_ehd.joint.static.pads import TiltingPads
from exudyn_ehd.joint.static.steady import (
    LARGEST_SPEED,
    SteadyResult,
    model_at,
    require_faces,
    require_rest,
    result_at,
)
from exudyn_ehd.joint.static.thrust_pads import ThrustPadsResult, equilibrium_of_pads
from exudyn_ehd.joint.thrust import ThrustModel, faces_of
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import InputError, require_number, require_size, require_type, require_vector

# Relative error of the critical mass above which a printed result contains it.
SURE = 0.05
# Relative error of the critical mass over the squared cancellation, on 96 columns: rupture line on the grid, and inside
# the cells.
ON_GRID, IN_CELLS = 0.016, 0.0013
# Relative error of the critical mass on 96 columns without cancellation, rupture line inside the cells.
LEFT_IN_CELLS = 0.007
# Force that replaces a load of 0 in the relative residual: share of L D mu omega / psi^2, plus share of L D times the
# supply pressure of restrictors. Smaller: a more accurate position. Round-off limits this at 1e-16 of the first force,
# the balances of restrictors at 1e-13 of the second one.
NO_LOAD, NO_LOAD_FED = 1e-5, 1e-3


@dataclass(frozen=True, eq=False)
class EquilibriumResult:
    """Result of `equilibrium`: position of the journal under a steady load, stiffness, damping, whirl threshold.

    Attributes
    ----------
    position : (2,) array
        x, y of the journal axis at the mid-plane, m.
    eccentricity_ratio, attitude_angle : float
        Distance of the journal axis from the bore's centre over the radial clearance; angle from the load to the
        eccentricity in the sense of rotation, rad.
    stiffness, damping : (2, 2) arrays
        K = -dF/d(x, y) in N/m and C = -dF/d(dx/dt, dy/dt) in N s/m with F on the journal, joint frame, at
        ``frequency``. With ``thermal`` the temperature is constant, which holds for motions that are fast compared with
        the exchange of the film's oil; ``settled_stiffness`` is the other limit. Flexible bore, journal and liner have
        no inertia.
    frequency : float
        Frequency of the small motions for which K and C hold, rad/s. 0: they do not depend on it, or hold for slow
        motions (surfaces that deflect, a ``compressible_volume``). With `ElrodAdams` it is that of the whirl threshold,
        or half the spin if there is no threshold.
    whirl_ratio : float
        Whirl frequency at the threshold divided by |omega|; nan where there is no threshold: stable at any mass, or
        unstable at any.
    critical_mass : float
        A rigid symmetric rotor is stable at this speed while its mass per bearing, kg, is smaller than this; inf if
        stable at any mass, 0 if unstable at any.
    critical_mass_error : float
        Estimate of the relative error of ``critical_mass`` due to the position of the rupture line on the grid; inf if
        the grid is too coarse to decide whether the bearing is stable at any mass. Of all results the critical mass
        depends most on the grid. Its error on the default film is 3 % at an eccentricity ratio of 0.7 and 17 % at 0.76;
        with the rupture line on the grid's vertices it is some 20 % at 0.7 and several times the value at 0.76.
    residual : float
        Largest component of film force + load in x and y, divided by the size of the load; without a load by 1e-5 of
        ``L D mu omega / psi^2``.
    iterations : int
        Number of positions tried, each with a film solve and with the temperature and deflection there.
    film : SteadyResult
        The film in this position.
    response : FilmResponse or None
        Used by `dynamic_stiffness`; None where K and C do not depend on the frequency.

    Examples
    --------
    After the example of `equilibrium`:

    >>> rest.damping.shape, round(rest.whirl_ratio, 2)
    ((2, 2), 0.51)
    >>> rest.dynamic_stiffness([150.0, 300.0]).shape  # K + i nu C at these frequencies, rad/s
    (2, 2, 2)
    """

    position: np.ndarray
    eccentricity_ratio: float
    attitude_angle: float
    stiffness: np.ndarray
    damping: np.ndarray
    whirl_ratio: float
    critical_mass: float
    critical_mass_error: float
    residual: float
    iterations: int
    film: SteadyResult = field(repr=False)
    frequency: float = 0.0
    response: FilmResponse | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        angle, mass = shown("angle", self.attitude_angle), f"{self.critical_mass:.3g} kg"
        if self.critical_mass_error > SURE:
            error = (
                f"within {100.0 * self.critical_mass_error:.0f} %" if self.critical_mass_error < 1.0 else "uncertain"
            )
            mass = f"{mass} ({error})"
        place = f"eccentricity ratio {self.eccentricity_ratio:.4f}, attitude angle {angle}"
        return f"<EquilibriumResult: {place}, critical mass {mass}, film {self.film!r}>"

    @cached_property
    def settled_stiffness(self) -> np.ndarray:
        """Stiffness -dF/d(x, y) (2, 2), N/m, for slow changes of the load, with steady temperature and oil content.

        Equal to ``stiffness`` for a film without ``thermal`` and without dependence on the frequency. With ``thermal``
        it comes from central differences of films that are solved at the first call.
        """
        b, motion = self.film.bearing, self.film.motion[:MOTION_SIZE]
        if b.thermal is None:
            return self.stiffness if self.response is None else self.response.at(0.0).real[:2, :2]
        model, faces = model_at(b, motion), faces_of(b)
        if self.film.faces is not None:
            motion = np.append(motion, self.film.faces.axial_position)
        # the step with the least error of central differences of forces with the tolerance of their films
        step = np.cbrt(SETTLED) * max(self.film.minimum_gap, 1e-3 * b.radial_clearance)
        near = remembered(self.film)

        def force(shift: np.ndarray) -> np.ndarray:
            there = model_at(b, motion + shift) if isinstance(b.inlet, MaximumGap) else model
            found = evaluate_at(there, motion + shift, "settled_stiffness", near, faces)
            beside = 0.0 if found.faces is None else found.faces.wrench[:2]
            return np.asarray(found.evaluation.wrench[:2] + beside)

        return np.array([force(-s) - force(s) for s in step * np.eye(2, motion.size)]).T / (2.0 * step)

    def dynamic_stiffness(self, frequencies: Sequence[float] | np.ndarray) -> np.ndarray:
        """Z = K + i nu C: the force's amplitude is -Z x for a motion x exp(i nu t).

        x is the small motion (x, y) about the equilibrium, and the force acts on the journal, joint frame. K and C
        depend on the frequency in three cases: with `ElrodAdams`, because the cavity's oil follows with a delay; with
        surfaces that deflect; with restrictors that have a ``compressible_volume``. See
        `exudyn_ehd.joint.static.dynamic_stiffness`.

        Parameters
        ----------
        frequencies : (k,) array
            nu, rad/s (not Hz).

        Returns
        -------
        ndarray (k, 2, 2)
            Complex, N/m.

        Raises
        ------
        InputError
            For frequencies that are no list of finite numbers.
        """
        nu = np.asarray(frequencies, dtype=float)
        if nu.ndim != 1 or not np.all(np.isfinite(nu)):
            got = f"a list of finite numbers in rad/s, got {frequencies!r}"
            raise InputError(f"dynamic_stiffness: frequencies must be {got}.")
        if self.response is None:
            return self.stiffness + 1j * nu[:, None, None] * self.damping
        return np.array([self.response.at(float(f))[:2, :2] for f in nu]).reshape(-1, 2, 2)


@overload
def equilibrium(bearing: TiltingThrustPads, *, speed: float, load: float) -> ThrustPadsResult: ...
@overload
def equilibrium(bearing: TiltingPads, *, speed: float, load: tuple[float, float]) -> TiltingPadResult: ...
@overload
def equilibrium(
    bearing: JournalBearing,
    *,
    speed: float,
    load: tuple[float, float],
    tilt: tuple[float, float] = (0.0, 0.0),
    axial_position: float = 0.0,
    axial_load: float | None = None,
) -> EquilibriumResult: ...
def equilibrium(
    bearing: JournalBearing | TiltingPads | TiltingThrustPads,
    *,
    speed: float,
    load: tuple[float, float] | float,
    tilt: tuple[float, float] = (0.0, 0.0),
    axial_position: float = 0.0,
    axial_load: float | None = None,
) -> EquilibriumResult | TiltingPadResult | ThrustPadsResult:
    """Find the position in which the film carries a steady load, with stiffness, damping and whirl threshold.

    This is for one bearing with a fixed tilt. Use `SolveEquilibrium` for a rotor in several bearings or a journal that
    is tilted by moments, `stribeck` for friction over the speed. With `TiltingPads` every pad is in balance, too; the
    journal is parallel to them, and the result is a `TiltingPadResult`.

    For which motions stiffness K and damping C hold:

    - `ElrodAdams`: both depend on the frequency, because the cavity's oil follows with a delay. Those returned hold at
      the frequency of the whirl threshold; `EquilibriumResult.dynamic_stiffness` gives others.
    - ``inlet=MaximumGap()``: the film always begins opposite to the journal. K contains the rotation of this line with
      the journal, as in the closed forms of short and long bearings; C holds for a line at rest.
    - ``thermal``: at constant temperature; `EquilibriumResult.settled_stiffness` is that with steady temperature.
    - liner, flexible bore or journal: K of the steady film, C of slow motions. Quick motions deflect a surface with a
      delay, which the threshold and `EquilibriumResult.dynamic_stiffness` include. With `ElrodAdams` K and C hold at
      the threshold's frequency here too. With an `ANCFBush` they hold about its deformed state.

    Films on end faces (``bearing.thrust``) carry a part of the load, also in x and y. Position, stiffness and damping
    are those of all films together; ``film.faces`` has the results of the faces alone. The journal is held at
    ``axial_position``, or the position is found in which the faces carry ``axial_load``. K and C are for motions across
    the axis; those along it are ``film.faces.axial_stiffness`` and ``axial_damping``.

    Several positions may carry one load where asperities touch, the film heats, oil is supplied, the journal is tilted
    or the film is starved. The search starts where a film with a cavity would carry the load and returns the position
    to which it converges. If K is not positive definite there, and there are supply areas, a tilt or `ElrodAdams`, it
    searches for other positions. A UserWarning lists all positions found, and the most stable one is returned.

    `TiltingThrustPads` carry an axial load: give ``speed`` and ``load`` alone. The result has the film thickness and
    the tilts of the pads, at which there is no moment about their pivots, and the axial stiffness and damping with pads
    that tilt freely (`exudyn_ehd.joint.static.thrust_pads`).

    Method: Newton's method with the exact tangent; a step closes at most 60 % of the remaining gap. If it fails, damped
    steps of Levenberg and Marquardt.

    Parameters
    ----------
    bearing : JournalBearing, TiltingPads or TiltingThrustPads
        With ``inlet=MaximumGap()`` the bearing must be rigid and the same in all directions, with an aligned journal,
        ambient ends, a film that does not conserve mass, and without ``thrust``.
    speed : float
        Spin of the journal against the housing, rad/s, positive about +z, not 0.
    load : (float, float), or float
        External force on the journal in x and y of the joint frame, N, which the film balances; a weight W along -y is
        (0, -W). Without a load, (0, 0), the journal of a bearing that is the same in all directions lies at the exact
        centre. A film that ruptures has one-sided derivatives there; stiffness and damping are those slightly off the
        centre, `exudyn_ehd.joint.model.rigid`. For thrust pads one number: the force, above 0, that presses the collar
        onto all pads.
    tilt : (float, float), default (0.0, 0.0)
        Slopes (bx, by) of the journal axis, rad, held fixed.
    axial_position : float, default 0.0
        Position of the journal between the faces of ``bearing.thrust``, m; 0 without them, and with ``axial_load``.
    axial_load : float or None, default None
        External force on the journal along z, N, which the faces carry; None: the journal is held at
        ``axial_position``.

    Returns
    -------
    EquilibriumResult, TiltingPadResult or ThrustPadsResult

    Raises
    ------
    InputError
        For zero speed, an inlet that the bearing does not support, supply areas that turn with the journal, an axial
        load without faces or together with an axial position.
    FilmError
        If no equilibrium was found, or if it is the exact centre and stiffness and damping depend on the direction.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> rest = ehd.equilibrium(bearing, speed=314.0, load=(0.0, -2000.0))
    >>> round(rest.eccentricity_ratio, 3), round(float(np.degrees(rest.attitude_angle)), 1)
    (0.454, 58.6)
    >>> (1e-6 * rest.stiffness).round()  # N/um
    array([[ 175.,   99.],
           [-295.,  181.]])
    """
    require_type("equilibrium: bearing", bearing, JournalBearing, TiltingPads, TiltingThrustPads)
    omega = require_number("equilibrium: speed", speed, "rad/s")
    if omega * bearing.journal_radius == 0.0:
        raise InputError("equilibrium: speed must not be zero: without it the film carries no load at any position.")
    require_size("equilibrium: speed", omega * bearing.journal_radius, "m/s at the surface", LARGEST_SPEED)
    if isinstance(bearing, TiltingThrustPads):
        return equilibrium_of_pads(bearing, omega, load, (tilt, axial_position, axial_load))
    force = require_vector("equilibrium: load", load, 2, "N (x and y on the journal; a weight W is (0, -W))")  # type: ignore[arg-type]
    b = require_vector("equilibrium: tilt", tilt, 2, "rad (slopes bx and by)")
    place = require_number("equilibrium: axial_position", axial_position, "m")
    size = float(np.hypot(*force))
    if size == 0.0:
        size = _no_load(bearing.pad(0) if isinstance(bearing, TiltingPads) else bearing, omega)
    else:
        require_size("equilibrium: load", size, "N", 1e15)
    if isinstance(bearing, TiltingPads):
        return pad_equilibrium(bearing, omega, force, size, not np.any(b) and place == 0.0 and axial_load is None)
    line, kind = isinstance(bearing.inlet, MaximumGap), LoadSearch
    if line:
        require_turning(bearing, force, b)
        kind = LineSearch
    else:
        require_rest(bearing, "equilibrium")
    model = build_study_model(bearing, math.pi if line else 0.0)
    faces, along = _faces(bearing, place, axial_load)
    motion = np.array([*first_guess(bearing, omega, force, b), *b, 0.0, 0.0, 0.0, 0.0, omega, 0.0, place])
    search = kind(model, "equilibrium", np.append(force, along), size=size, faces=faces)
    found = steadiest(search, search.find(motion))
    return _result(search, found, model_at(bearing, found.motion) if line else model)


def _no_load(bearing: JournalBearing, omega: float) -> float:
    """Force, N, that replaces a load of 0 in relative residuals."""
    fed = max((getattr(area.supply, "supply_pressure", 0.0) for area in bearing.supply), default=0.0)
    area = 2.0 * bearing.journal_radius * bearing.length
    return NO_LOAD * bearing.reference_force(omega) + NO_LOAD_FED * area * fed


def _result(search: LoadSearch, found: Place, model: BearingModel) -> EquilibriumResult:
    """Result at a position that was found, whose film is the last one of the search's model."""
    (K, C, response), bearing, omega = _small_motions(found), model.bearing, abs(float(found.motion[8]))
    if response is None:
        ratio, mass = whirl_threshold(K, C, omega)
    else:
        ratio, mass = threshold(response.at, omega, response.rates, response.fastest)
    frequency = omega * (0.5 if math.isnan(ratio) else ratio)
    Z = K + 1j * frequency * C if response is None else response.at(frequency)[:2, :2]
    there = Z.real, Z.imag / frequency
    if not model.remembers_mass:
        frequency = 0.0
    film = result_at(model, found.motion, "equilibrium", found.film.history, search.faces)
    return EquilibriumResult(
        position=found.motion[:2],
        eccentricity_ratio=float(np.hypot(*found.motion[:2])) / bearing.radial_clearance,
        attitude_angle=film.attitude_angle,
        stiffness=there[0] if model.remembers_mass else K,
        damping=there[1] if model.remembers_mass else C,
        frequency=frequency,
        whirl_ratio=ratio,
        critical_mass=mass,
        critical_mass_error=critical_mass_error(bearing, *there),
        response=response,
        residual=search.residual(found),
        iterations=search.count,
        film=film,
    )


def _small_motions(found: Place) -> tuple[np.ndarray, np.ndarray, FilmResponse | None]:
    """K and C (2, 2) of slow motions about a position whose film is the model's last, and its response.

    The response is None if K and C do not depend on the frequency.
    """
    evaluation = found.evaluation
    if evaluation.is_central:
        require_derivatives(evaluation, "equilibrium")
    K, C = (part[:2, :2] for part in slow_motions(evaluation.steady_tangent(exact=True)))
    if isinstance(evaluation.model.bearing.inlet, MaximumGap):
        back = turning(found.motion)
        return -found.slope, back @ C @ back.T, None
    if found.faces is not None:
        beside = found.faces.tangent()
        K, C = K - beside[:2, :2], C - beside[:2, 4:6]
    own, response = response_of(evaluation)
    if response is not None:
        response.add(K - own[0][:2, :2], C - own[1][:2, :2])
    return K, C, response


def _faces(bearing: JournalBearing, position: float, load: float | None) -> tuple[ThrustModel | None, list[float]]:
    """Films on end faces for the search, and their axial load, N; an empty list if the axial position is given."""
    along = [] if load is None else [require_number("equilibrium: axial_load", load, "N")]
    require_faces(bearing, "equilibrium", axial_position=position, axial_load=load)
    if along and position != 0.0:
        raise InputError(
            f"equilibrium: axial_position = {position!r} m and axial_load = {load!r} N exclude each other: the journal "
            "is held along the axis, or finds its place under a load; leave one out."
        )
    return faces_of(bearing), [] if bearing.thrust is None else along


def critical_mass_error(bearing: JournalBearing, stiffness: np.ndarray, damping: np.ndarray) -> float:
    """Estimate of the relative error of the critical mass; inf from 1 on.

    The square of the whirl frequency of `whirl_threshold` is a difference of products that nearly cancel if the bearing
    is nearly stable at any mass. In axes that are turned so that Kxy = -Kyx, a = (k - Kxx)(k - Kyy), b = Kxy Kyx, and
    the cancellation is A = (|a| + |b|) / |a - b|. The measured error was less than::

        0.016 (96 / n) A^2                 rupture line on a grid of n columns
        (0.0013 A^2 + 0.007) (96 / n)^2    rupture line inside the cells, with `Gumbel` without 0.007

    in 99 % of films with L/D 0.25 to 2, eccentricity ratios of 0.3 and more, and 16 directions of the load.
    """
    columns = getattr(bearing.sized_film, "n_theta", None)
    if columns is None or math.isinf(bearing.closure.cavity_pressure):
        return 0.0
    _, above = whirl_stiffness(stiffness, damping)
    if math.isnan(above) or above == 0.0:
        return math.inf
    b, grid = -0.25 * (stiffness[0, 1] - stiffness[1, 0]) ** 2, 96.0 / columns
    cancelled = ((abs(above + b) + abs(b)) / above) ** 2
    inside = (IN_CELLS * cancelled + (0.0 if bearing.closure.clips else LEFT_IN_CELLS)) * grid**2
    error = inside if bearing.closure.line_in_cells else ON_GRID * grid * cancelled
    return error if error < 1.0 else math.inf
