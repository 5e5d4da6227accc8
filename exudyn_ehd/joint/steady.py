"""Studies without a multibody model: a prescribed position, the equilibrium under a load with K and C."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap, advice
from exudyn_ehd.film.liner import ElasticLiner
from exudyn_ehd.joint.audit import Audit, audit_states
from exudyn_ehd.joint.audit_states import FilmState
from exudyn_ehd.joint.build import build_study_model
from exudyn_ehd.joint.effects import History
from exudyn_ehd.joint.fields import grid_fields
from exudyn_ehd.joint.model import BearingModel
from exudyn_ehd.joint.settle import settle
from exudyn_ehd.pictures.methods import FilmPictures
from exudyn_ehd.status import FilmError, InputError, Status, require_number, require_size, require_vector

LARGEST_LOAD_STEPS = 100
SPEEDS = {"smallest": 1e-30, "largest": 1e6}
LOADS = {"smallest": 1e-30, "largest": 1e15}
LARGEST_CREEP_STEPS = 300
STEP_HALVINGS = 8
LOAD_TOLERANCE = 1e-10
# Rounding of the film's force in units of L D mu omega / psi^2, which a tiny load can't fall below.
FORCE_ROUNDING = 1e-16


@dataclass(frozen=True, eq=False)
class SteadyResult(FilmPictures):
    """One position of the journal; ``plot_pressure()`` and its like draw it. Frame and signs as in `exudyn_ehd.joint.model`; SI units.

    Attributes
    ----------
    theta, z : (n,), (m,) arrays
        Grid, rad and m.
    pressure, gap : (n, m) arrays
        Pa (gauge) and m.
    unbroken : (n, m) bool array
        Where the film is not cavitated.
    force, moment : (3,) arrays
        On the journal, moment about the joint origin.
    minimum_gap, peak_pressure, peak_angle : float
        m, Pa, rad; peak from parabolas through the largest vertex.
    friction_torque, friction_torque_unbroken, friction_torque_bush : float
        Nm; about the journal's own axis (all of the clearance sheared, unbroken film only), and on the bush.
    power_loss, leakage, contact_load : float
        W, m3/s out of both ends, N.
    supply_flows : (k,) array
        m3/s out of every area of ``bearing.supply``.
    contact_torque, contact_power_loss, peak_contact_pressure : float
        Boundary friction of the contacts on the journal about its own axis (Nm, part of ``friction_torque``) and the loss it
        makes (W, part of ``power_loss``); Pa.
    sommerfeld_number, attitude_angle : float
        So = F psi^2 / (L D mu |omega|), nan at zero speed; angle from the load to the eccentricity in the sense of
        rotation, rad.
    status, iterations : Status, int
    fill : (n, m) array or None
        Film fraction; None for closures that do not conserve mass.
    temperature : (n, m) array, float or None
        Of the film, K; None for an isothermal bearing.
    bore_displacement : (n, m) array or None
        Of a flexible bore, m, positive outward; None for a rigid one.
    bore_coordinates : (k,) array or None
        Of a flexible bore, m.
    bearing : JournalBearing
    motion : (10,) array
        Of the journal, as in `exudyn_ehd.joint.model`; with a flexible bore followed by its coordinates and rates.
    """

    theta: np.ndarray
    z: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    minimum_gap: float
    peak_pressure: float
    peak_angle: float
    friction_torque: float
    friction_torque_unbroken: float
    friction_torque_bush: float
    power_loss: float
    leakage: float
    contact_load: float
    supply_flows: np.ndarray
    contact_torque: float
    contact_power_loss: float
    peak_contact_pressure: float
    sommerfeld_number: float
    attitude_angle: float
    status: Status
    iterations: int
    fill: np.ndarray | None = None
    temperature: float | np.ndarray | None = None
    bore_displacement: np.ndarray | None = None
    bore_coordinates: np.ndarray | None = None
    bearing: JournalBearing = field(repr=False, kw_only=True)
    motion: np.ndarray = field(repr=False, kw_only=True)

    def audit(self, *, liner: ElasticLiner | None = None, measure_time: bool = False) -> Audit:
        """Which effects matter at this position, which are left out, which are paid for in vain; print it for a table.

        Parameters
        ----------
        liner : ElasticLiner, optional
            Of which to say whether its elasticity would matter; for bearings without one.
        measure_time : bool
            Measure the share of the time that every effect takes which is on.
        """
        open_ring = isinstance(self.bearing.inlet, MaximumGap)
        start = math.atan2(self.motion[1], self.motion[0]) + math.pi if open_ring else 0.0
        model = build_study_model(self.bearing, start)
        state = FilmState(self.motion, _history_at(model, self.motion, "audit"))
        return audit_states(model, [state], liner=liner, measure_time=measure_time)


def steady(
    bearing: JournalBearing,
    *,
    speed: float,
    eccentricity_ratio: float,
    direction: float = 0.0,
    tilt: tuple[float, float] = (0.0, 0.0),
    velocity: tuple[float, float] = (0.0, 0.0),
    axial_speed: float = 0.0,
) -> SteadyResult:
    """Film at a prescribed position.

    Parameters
    ----------
    bearing : JournalBearing
    speed : float
        Relative spin omega, rad/s.
    eccentricity_ratio : float
        e/c at the mid-plane.
    direction : float
        Angle of the eccentricity from x, rad.
    tilt : (float, float)
        Slopes (bx, by) of the journal axis, rad.
    velocity : (float, float)
        dx/dt, dy/dt, m/s. With `ElrodAdams`: the force at the instant at which the journal, in its steady film, gets this
        velocity, so that full parts are squeezed at once and cavities keep their oil content.
    axial_speed : float
        w, m/s.

    Raises
    ------
    InputError
        For values that are not numbers.
    FilmError
        If there is no film at this position.
    """
    e = require_number("steady: eccentricity_ratio", eccentricity_ratio, at_least=0.0) * bearing.radial_clearance
    angle = require_number("steady: direction", direction, "rad")
    b = require_vector("steady: tilt", tilt, 2, "rad")
    v = require_vector("steady: velocity", velocity, 2, "m/s")
    omega = require_number("steady: speed", speed, "rad/s")
    w = require_number("steady: axial_speed", axial_speed, "m/s")
    require_size("steady: speed", omega * bearing.journal_radius, "m/s at the surface", **SPEEDS)
    require_size("steady: velocity", v, "m/s", **SPEEDS)
    require_size("steady: axial_speed", w, "m/s", **SPEEDS)
    require_oil(bearing, "steady", w)
    position = e * math.cos(angle), e * math.sin(angle)
    start = angle + math.pi if isinstance(bearing.inlet, MaximumGap) else 0.0
    model = build_study_model(bearing, start)
    return _result(model, np.array([*position, *b, *v, 0.0, 0.0, omega, w]), "steady")


def require_oil(bearing: JournalBearing, where: str, axial_speed: float = 0.0) -> None:
    """Raise `InputError` if a steady mass-conserving film has no source of oil and would starve to nothing."""
    closure = bearing.cavitation
    if not closure.conserves_mass or axial_speed != 0.0 or isinstance(bearing.inlet, MaximumGap) or bearing.supply:
        return
    if max(bearing.end_pressures) <= closure.cavity_pressure:
        raise InputError(
            f"{where}: a steady film with ElrodAdams needs oil from somewhere, but no pressure is above the cavity pressure "
            f"({closure.cavity_pressure:g} Pa gauge), so that the side leakage would drain the closed ring; give the bearing "
            "supply=(AxialGroove(...),), end_pressures above the cavity pressure, or ElrodAdams(cavity_pressure=-1e5) below "
            "ambient pressure."
        )


def _history_at(model: BearingModel, motion: np.ndarray, where: str) -> History | None:
    """Settled temperature at ``motion`` and, with rates, the oil content of the steady film at rest there; None if nothing remembers."""
    history = settle(model, motion)
    if not model.remembers_mass or not np.any(motion[4:8]):
        return history
    at_rest = motion.copy()
    at_rest[4:8] = 0.0
    _evaluate(model, at_rest, where)
    content = model.history()
    assert content is not None
    return replace(content, temperature=None if history is None else history.temperature)


def _evaluate(model: BearingModel, motion: np.ndarray, where: str) -> np.ndarray:
    evaluation = model.evaluate_steady(motion, _history_at(model, motion, where))
    if evaluation.status is not Status.CONVERGED:
        gap = evaluation.quantities().get("minimum_gap", math.nan)
        raise FilmError(
            f"{where}: {evaluation.status.name} at x = {motion[0]:.4g} m, y = {motion[1]:.4g} m, tilt = "
            f"({motion[2]:.3g}, {motion[3]:.3g}), minimum gap {gap:.3g} m: {advice(evaluation.status, model.bearing)}"
        )
    return evaluation.wrench


def _result(model: BearingModel, motion: np.ndarray, where: str) -> SteadyResult:
    wrench = _evaluate(model, motion, where)
    q = model.quantities()
    peak, angle, _ = model.refined_peak()
    force = math.hypot(wrench[0], wrench[1])
    reference = model.bearing.reference_force(motion[8])
    eccentric = math.hypot(motion[0], motion[1]) > 0.0
    attitude = math.nan
    if eccentric and force > 0.0:
        turn = math.atan2(motion[1], motion[0]) - math.atan2(-wrench[1], -wrench[0])
        attitude = math.remainder(turn if motion[8] >= 0.0 else -turn, 2.0 * math.pi)
    return SteadyResult(
        **grid_fields(model),
        force=wrench[:3].copy(),
        moment=wrench[3:].copy(),
        minimum_gap=q["minimum_gap"],
        peak_pressure=peak,
        peak_angle=angle,
        friction_torque=q["friction_torque"],
        friction_torque_unbroken=q["friction_torque_unbroken"],
        friction_torque_bush=q["friction_torque_bush"],
        power_loss=q["power_loss"],
        leakage=q["leakage"],
        contact_load=q["contact_load"],
        supply_flows=model.supply_flows(),
        contact_torque=q["contact_torque"],
        contact_power_loss=q["contact_power_loss"],
        peak_contact_pressure=q["peak_contact_pressure"],
        sommerfeld_number=force / reference if reference > 0.0 else math.nan,
        attitude_angle=attitude,
        status=model.status,
        iterations=model.iterations,
        **model.bore_fields(),
        bearing=model.bearing,
        motion=model.motion.copy(),
    )


@dataclass(frozen=True, eq=False)
class EquilibriumResult:
    """Equilibrium of an aligned or tilted journal under a steady load.

    Attributes
    ----------
    position : (2,) array
        x, y of the journal axis at the mid-plane, m.
    eccentricity_ratio, attitude_angle : float
        e/c; angle from the load to the eccentricity in the sense of rotation, rad.
    stiffness, damping : (2, 2) arrays
        K = -dF/d(x, y) in N/m and C = -dF/d(dx/dt, dy/dt) in N s/m, joint frame.
    whirl_ratio : float
        Whirl frequency at the threshold divided by |omega|; nan if stable at any mass.
    critical_mass : float
        Mass of a rigid symmetric rotor per bearing at the threshold, kg; inf if stable at any mass, 0 if unstable at any.
    residual : float
        Largest component of film force + load, divided by the load.
    iterations : int
        Film evaluations.
    film : SteadyResult
    """

    position: np.ndarray
    eccentricity_ratio: float
    attitude_angle: float
    stiffness: np.ndarray
    damping: np.ndarray
    whirl_ratio: float
    critical_mass: float
    residual: float
    iterations: int
    film: SteadyResult = field(repr=False)


def equilibrium(
    bearing: JournalBearing, *, speed: float, load: tuple[float, float], tilt: tuple[float, float] = (0.0, 0.0)
) -> EquilibriumResult:
    """Position in which the film carries a steady load on the journal, with stiffness, damping and whirl threshold.

    Newton's method with the exact tangent; a step may use up at most 60 % of the remaining gap, which keeps it inside
    the bearing and costs nothing near the solution. Where it fails, the journal creeps to its position against a falling resistance.

    With `ElrodAdams` the stiffness is that of the steady film (the cavity's oil follows the position), the damping that of a
    sudden velocity in it (the cavity's oil content stays): the limit of slow displacement and fast motion. A transient
    joint has what lies between.

    Parameters
    ----------
    bearing : JournalBearing
        With ``inlet=Periodic()``.
    speed : float
        Relative spin, rad/s, not 0.
    load : (float, float)
        Force on the journal in x and y, N, not zero.
    tilt : (float, float)
        Slopes (bx, by), held fixed, rad.

    Raises
    ------
    InputError
        For a zero load or speed, or an inlet that a moving journal can't have.
    FilmError
        If no equilibrium was found.
    """
    force = require_vector("equilibrium: load", load, 2, "N")
    omega = require_number("equilibrium: speed", speed, "rad/s")
    b = require_vector("equilibrium: tilt", tilt, 2, "rad")
    size = float(np.hypot(*force))
    if size == 0.0 or omega * bearing.journal_radius == 0.0:
        raise InputError("equilibrium: load and speed must not be zero: without them every or no position is one.")
    require_size("equilibrium: speed", omega * bearing.journal_radius, "m/s at the surface", **SPEEDS)
    require_size("equilibrium: load", size, "N", **LOADS)
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError("equilibrium: inlet=MaximumGap() is for prescribed positions (`steady`); use Periodic().")
    require_oil(bearing, "equilibrium")
    model = build_study_model(bearing, 0.0)
    motion = np.array([0.0, 0.0, *b, 0.0, 0.0, 0.0, 0.0, omega, 0.0])
    motion[:2] = _first_guess(bearing, omega, force, b)
    tolerance = max(LOAD_TOLERANCE, FORCE_ROUNDING * bearing.reference_force(omega) / size)
    start = motion[:2].copy()
    count, residual, tangent = _newton(model, motion, force, tolerance)
    if residual > tolerance:
        motion[:2] = start
        more, residual, tangent = _creep(model, motion, force, tolerance)
        count += more
    if residual > tolerance:
        raise FilmError(
            f"equilibrium: no position found that carries {size:.4g} N in {count} steps; the nearest is off by {residual:.2g} of the "
            f"load, at eccentricity ratio {np.hypot(*motion[:2]) / bearing.radial_clearance:.4f}. A load this high may need "
            "contact=RegularisedWall(...) or a finer film grid; a supply area in the loaded zone or a starved film may carry "
            "no such load at any position: look at ehd.steady(...) around there."
        )
    K, C = -tangent[:2, :2], -_rate_tangent(model, tangent)[:2, 4:6]
    ratio, mass = whirl_threshold(K, C, abs(omega))
    film = _result(model, motion, "equilibrium")
    return EquilibriumResult(
        position=motion[:2].copy(),
        eccentricity_ratio=float(np.hypot(*motion[:2])) / bearing.radial_clearance,
        attitude_angle=film.attitude_angle,
        stiffness=K,
        damping=C,
        whirl_ratio=ratio,
        critical_mass=mass,
        residual=residual,
        iterations=count,
        film=film,
    )


def _newton(
    model: BearingModel, motion: np.ndarray, force: np.ndarray, tolerance: float
) -> tuple[int, float, np.ndarray]:
    """Newton's method from ``motion`` (changed in place): steps, unbalance over load, tangent at the end."""
    size = float(np.hypot(*force))
    count, residual = 0, math.inf
    wrench = _evaluate(model, motion, "equilibrium")
    tangent = model.steady_tangent()
    while count < LARGEST_LOAD_STEPS:
        count += 1
        unbalance = wrench[:2] + force
        residual = float(np.max(np.abs(unbalance))) / size
        if residual <= tolerance:
            break
        try:
            wrench = _move(model, motion, _limited_step(model, motion, np.linalg.solve(tangent[:2, :2], -unbalance)))
        except (np.linalg.LinAlgError, FilmError):  # a film that carries nothing, or no film whatever the step
            break
        tangent = model.steady_tangent()
    return count, residual, tangent


def _creep(
    model: BearingModel, motion: np.ndarray, force: np.ndarray, tolerance: float
) -> tuple[int, float, np.ndarray]:
    """As `_newton`, by way of the journal's creep: a viscous resistance r holds it back, which falls as the unbalance does.

    ``(r I - dF/dx) step = unbalance``; a step that increases the unbalance is taken back and r grows. Slow and sure where Newton's
    method jumps over a film that starves or touches.
    """
    size = float(np.hypot(*force))
    unbalance = _evaluate(model, motion, "equilibrium")[:2] + force
    tangent = model.steady_tangent()
    resistance, count = 10.0 * size / model.bearing.radial_clearance, 1
    while count < LARGEST_CREEP_STEPS and float(np.max(np.abs(unbalance))) > tolerance * size:
        try:
            step = np.linalg.solve(resistance * np.eye(2) - tangent[:2, :2], unbalance)
        except np.linalg.LinAlgError:
            resistance *= 4.0
            count += 1
            continue
        base = motion[:2].copy()
        motion[:2] += _limited_step(model, motion, step)
        count += 1
        try:
            trial = _evaluate(model, motion, "equilibrium")[:2] + force
        except FilmError:
            trial = np.full(2, math.inf)
        if float(np.hypot(*trial)) < float(np.hypot(*unbalance)):
            unbalance, tangent = trial, model.steady_tangent()
            resistance /= 5.0
        else:
            motion[:2] = base
            resistance *= 4.0
    _evaluate(model, motion, "equilibrium")
    return count, float(np.max(np.abs(unbalance))) / size, tangent


def _rate_tangent(model: BearingModel, tangent: np.ndarray) -> np.ndarray:
    """Tangent whose rate columns hold for a sudden velocity in the steady film, or a slow one on a liner; see `equilibrium`."""
    if model.liner_solver is not None:
        return model.tangent(slow_motion=True)
    if not model.remembers_mass:
        return tangent
    model.evaluate(model.motion, model.history())
    return model.steady_tangent()


def _first_guess(bearing: JournalBearing, omega: float, force: np.ndarray, tilt: np.ndarray) -> np.ndarray:
    """Eccentricity (2,) in m from the mean of the short and the long bearing's load, both half Sommerfeld.

    The guess only saves steps. It stays inside the gap that the tilt leaves.
    """
    target = float(np.hypot(*force)) / bearing.reference_force(omega)
    ratio = (0.5 * bearing.length / bearing.journal_radius) ** 2
    room = 1.0 - 0.5 * bearing.length * float(np.hypot(*tilt)) / bearing.radial_clearance
    lower, upper = 0.0, 1.0
    for _ in range(40):
        eps = 0.5 * (lower + upper)
        s = 1.0 - eps * eps
        short = ratio * eps / (2.0 * s * s) * math.sqrt(math.pi**2 * s + 16.0 * eps * eps)
        long = 3.0 * eps * math.sqrt(math.pi**2 - eps**2 * (math.pi**2 - 4.0)) / ((2.0 + eps * eps) * s)
        if short * long / (short + long + 1e-300) < target:
            lower = eps
        else:
            upper = eps
    eps = lower * max(room, 0.02)
    angle = math.atan2(force[1], force[0]) + math.copysign(
        math.atan2(math.pi * math.sqrt(1.0 - eps * eps), 4.0 * eps), omega
    )
    return eps * bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])


def _move(model: BearingModel, motion: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Advance ``motion`` (10,) in place by a step (2,) and evaluate; in a flexible bore by the part of it that leaves a film."""
    motion[:2] += step
    if hasattr(model, "bore"):
        for _ in range(STEP_HALVINGS):
            evaluation = model.evaluate_steady(motion, _history_at(model, motion, "equilibrium"))
            if evaluation.status is Status.CONVERGED:
                return evaluation.wrench
            step = 0.5 * step
            motion[:2] -= step
    return _evaluate(model, motion, "equilibrium")


def _limited_step(model: BearingModel, motion: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Shorten a step (2,) so that it uses up at most 60 % of the smallest gap at either end; a wall or a flexible bush limits nothing."""
    if model.effects.contacts or hasattr(model, "bore"):
        longest = 0.3 * model.bearing.radial_clearance
        return step * min(1.0, longest / float(np.hypot(*step) + 1e-300))
    c, half = model.bearing.radial_clearance, 0.5 * model.bearing.length
    scale = 1.0
    for s in (-half, half):
        e = motion[:2] + s * motion[2:4]
        allowed = float(np.hypot(*e)) + 0.6 * (c - float(np.hypot(*e)))
        a, b, d = float(step @ step), float(e @ step), float(e @ e) - allowed**2
        if a > 0.0:
            scale = min(scale, (-b + math.sqrt(b * b - a * d)) / a)
    return scale * step


def whirl_threshold(stiffness: np.ndarray, damping: np.ndarray, omega: float) -> tuple[float, float]:
    """Whirl ratio and critical mass of a rigid rotor on one bearing (half of a symmetric rotor on two).

    With ``det(M s^2 + C s + K) = 0`` at ``s = i gamma omega``::

        k = (Kxx Cyy + Kyy Cxx - Kxy Cyx - Kyx Cxy) / (Cxx + Cyy),
        (gamma omega)^2 = ((k - Kxx)(k - Kyy) - Kxy Kyx) / (Cxx Cyy - Cxy Cyx),   M = k / (gamma omega)^2.

    Source: J. W. Lund, J. Tribology 109 (1987) 37, derived again from the determinant.

    Parameters
    ----------
    stiffness, damping : (2, 2) arrays
    omega : float
        Spin, rad/s, > 0.

    Returns
    -------
    whirl_ratio, critical_mass : float
        (nan, inf) if stable at any mass; (nan, 0) if k is not positive, that is unstable at any mass.
    """
    (kxx, kxy), (kyx, kyy) = stiffness
    (cxx, cxy), (cyx, cyy) = damping
    trace = cxx + cyy
    if trace <= 0.0:
        return math.nan, 0.0
    k = (kxx * cyy + kyy * cxx - kxy * cyx - kyx * cxy) / trace
    if k <= 0.0:
        return math.nan, 0.0
    square = ((k - kxx) * (k - kyy) - kxy * kyx) / (cxx * cyy - cxy * cyx)
    if square <= 0.0:
        return math.nan, math.inf
    return math.sqrt(square) / omega, k / square
