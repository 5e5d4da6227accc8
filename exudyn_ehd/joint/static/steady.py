"""Film at a prescribed position of the journal, without a multibody model, and films on the end faces there.

`exudyn_ehd.joint.static.equilibrium` finds the position that carries a load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.audit.audit import audit_of
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import Audit
from exudyn_ehd.joint.audit.resolution import warn_of_grid
from exudyn_ehd.joint.audit.samples import FilmState
from exudyn_ehd.joint.balance.limits import (
    lacks_oil,
    warn_of_heat,
    warn_of_overload,
    warn_of_starved,
)
from exudyn_ehd.joint.balance.steady_film import evaluate_at, history_at
from exudyn_ehd.joint.model import results
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.joint.thrust import ThrustEvaluation, ThrustModel, faces_of
from exudyn_ehd.pictures.mixins import FilmPictures
from exudyn_ehd.pictures.records import FilmRecord, shown
from exudyn_ehd.solid.bush import BoreModes
from exudyn_ehd.status import (
    InputError,
    Status,
    StrainWarning,
    require_number,
    require_size,
    require_type,
    require_vector,
    warn_user,
)


@dataclass(frozen=True, eq=False, kw_only=True)
class ThrustResult:
    """Films on the end faces at one position of the journal; vectors on the journal, in the joint frame.

    Attributes
    ----------
    axial_position : float
        Position of the journal's centre along the axis, m.
    force, moment : (3,) arrays
        Force, N, and moment about the joint's origin, N m.
    axial_force, friction_torque : float
        Force along z, N; torque about the bearing's axis, N m.
    axial_stiffness, axial_damping : float
        -dF/dz, N/m, and -dF/dw, N s/m, with F along z and the axial speed w. Between plane faces at rest, a film that
        ruptures has a pressure on the closing side only. Midway between two equal faces the damping is that of one
        face. Elsewhere it is nan, because it differs between both directions of motion.
    minimum_gap, peak_pressure, power_loss, contact_load : float
        Minimum film thickness, m, peak pressure, Pa, power loss, W, and contact load, N, of all faces.
    edge_pressures : (k,) array
        Pressure at the inner radius of every face, Pa; the lower face first.
    inflow, outflow : (k,) arrays
        Flow into every face at its inner radius, and out of it at its outer radius, m3/s.
    theta, r : (n,), (m,) arrays
        Grid, rad and m.
    pressure, gap : (k, n, m) arrays
        Pressure, Pa (gauge), and film thickness, m, of every face; the lower face first. On edges of pads the gap is
        the mean of both sides.
    tangent : (6, 11) array
        Derivative of force and moment to the motion (x, y, bx, by, their rates, omega, w) and the axial position, SI
        units. For plane faces at rest it is the mean over both directions of motion.

    Examples
    --------
    After the example of `ThrustFaces`:

    >>> print(film.faces)
    <ThrustResult: axial force -3.93 kN, minimum film thickness 20 µm, peak pressure 2.93 MPa, power loss 578 W>
    >>> film.faces.pressure.shape  # faces, theta, r
    (2, 136, 15)
    """

    axial_position: float
    force: np.ndarray
    moment: np.ndarray
    axial_force: float
    friction_torque: float
    axial_stiffness: float
    axial_damping: float
    minimum_gap: float
    peak_pressure: float
    power_loss: float
    contact_load: float
    edge_pressures: np.ndarray
    inflow: np.ndarray
    outflow: np.ndarray
    theta: np.ndarray = field(repr=False)
    r: np.ndarray = field(repr=False)
    pressure: np.ndarray = field(repr=False)
    gap: np.ndarray = field(repr=False)
    tangent: np.ndarray = field(repr=False)

    def __repr__(self) -> str:
        gap, peak = shown("length", self.minimum_gap), shown("pressure", self.peak_pressure)
        force, loss = shown("force", self.axial_force), shown("power", self.power_loss)
        film = f"minimum film thickness {gap}, peak pressure {peak}, power loss {loss}"
        return f"<ThrustResult: axial force {force}, {film}>"


def require_faces(bearing: JournalBearing, where: str, **arguments: float | None) -> None:
    """Raise `InputError` for arguments that need thrust faces, if the bearing has none."""
    given = [f"{name} = {value!r}" for name, value in arguments.items() if value]
    if bearing.thrust is None and given:
        raise InputError(
            f"{where}: {', '.join(given)}: axial_position is that between the faces of "
            "JournalBearing.thrust=ThrustFaces(...), which the bearing does not have; without faces nothing depends on "
            "it, and nothing carries along the axis."
        )


def result_of(found: ThrustEvaluation) -> ThrustResult:
    """Result of the last evaluation of its model."""
    tangent = found.tangent()
    model, values, first = found.model, found.quantities(), found.model.faces[0]
    inflow, outflow = np.array([face.flows() for face in model.faces]).T
    return ThrustResult(
        axial_position=values["axial_position"],
        force=found.wrench[:3],
        moment=found.wrench[3:],
        axial_force=float(found.wrench[2]),
        friction_torque=float(found.wrench[5]),
        axial_stiffness=-float(tangent[2, 10]),
        axial_damping=found.axial_damping(),
        minimum_gap=values["thrust_minimum_gap"],
        peak_pressure=values["thrust_peak_pressure"],
        power_loss=values["thrust_power_loss"],
        contact_load=values["thrust_contact_load"],
        edge_pressures=np.array([face.pressures[0] for face in model.faces]),
        inflow=inflow,
        outflow=outflow,
        theta=first.annulus.grid.x,
        r=first.annulus.scale * first.annulus.r,
        pressure=np.array([face.pressure for face in model.faces]),
        gap=np.array([face.gap for face in model.faces]),
        tangent=tangent,
    )


# Strain of a linear bush (displacement over thickness) above which, with an error above 1 %, a warning is given. Speed
# of a surface, m/s, above which numbers may overflow.
LARGEST_STRAIN, LARGEST_SPEED = 0.01, 1e6


@dataclass(frozen=True, eq=False)
class SteadyResult(FilmRecord, FilmPictures):
    """Result of `steady`: the film at one position.

    ``plot_pressure()`` and its like draw it. SI units; vectors in the joint frame: origin on the bearing's mid-plane,
    z = bearing axis, fixed in the housing. Angles count from x towards y.

    Attributes
    ----------
    theta, z : (n,), (m,) arrays
        Grid, rad and m.
    pressure, gap : (n, m) arrays
        Film pressure, Pa (gauge), and film thickness, m.
    unbroken : (n, m) bool array
        True where the film is not cavitated.
    force, moment : (3,) arrays
        Force, N, and moment about the joint's origin, N m, on the journal, from film and contact.
    minimum_gap, peak_pressure, peak_angle : float
        Minimum film thickness, m; largest film pressure, Pa, and its angle, rad, from parabolas through the vertex with
        the largest pressure.
    friction_torque, friction_torque_unbroken : float
        Torque on the journal about its own axis, N m; negative if it brakes a positive spin. The first contains the
        contact and the shear of the whole clearance with cavities; the second only the shear of the unbroken film. With
        `ElrodAdams` the latter ends at the last full vertex: on the default grid it is up to 5 % too small.
    friction_torque_bush : float
        Torque on the bush about the bearing's axis, N m: minus ``moment[2]``. It is smaller than that on the journal
        by the force times its lever arm, the eccentricity.
    power_loss, leakage, contact_load : float
        Power loss, W; oil out of both ends together, m3/s; size of the contact's force, N. If the contact extends
        around an arc, this vector sum is less than the integral of the contact pressure (by 3 % over 0.8 rad).
    pocket_pressures, restrictor_flows : (k,) arrays
        Pressure of every area of ``bearing.supply``, Pa; flow through its restrictor, m3/s, nan without one.
    inlet_flow : float
        Circumferential flow into the loaded zone, Q_1, m3/s; nan at zero speed:
        `exudyn_ehd.joint.model.results.passing_flows`. Tables have the side flow ratio Q_s / Q = leakage /
        inlet_flow and the flow variable Q / (R c N L) = inlet_flow / (R c N L), N = omega / (2 pi).
    oil_flow : float
        Total oil flow: fresh oil that passes through the film, m3/s. It replaces oil that leaves through ends and
        supply areas. Without end pressures and supply areas it is the leakage, unless a cavity below ambient pressure
        takes in oil at an end: the leakage is the net flow. With a single arc: sum of ``supply_flows``.
    supply_flows : (k,) array
        Oil that every area of ``bearing.supply`` feeds into the film, m3/s. With arcs, two values for each arc come
        first: oil that enters at its leading and at its trailing edge, 0 for outflow.
    contact_torque, contact_power_loss, peak_contact_pressure : float
        Boundary friction of the contacts on the journal about its own axis, N m, part of ``friction_torque``; its
        loss, W, part of ``power_loss``; largest contact pressure, Pa.
    sommerfeld_number, attitude_angle : float
        So = p psi^2 / (mu |omega|) of ISO 7902 and DIN 31652 with p = F / (L D), F the size of ``force`` across the
        axis, psi = c / R, D = 2 R and mu of the lubricant; nan at zero speed. Angle from the load (minus ``force``) to
        the eccentricity in the sense of rotation, rad.
    characteristic_number : float
        S = (R / c)^2 mu N / p with N = |omega| / (2 pi) in revolutions per second: the Sommerfeld number of Raimondi
        and Boyd and of American tables, 1 / (2 pi So); inf without a force.
    friction_number : float
        f R / c with the coefficient of friction f = |friction_torque| / (R F); inf without a force.
    status, iterations : Status, int
        Outcome of the film's solution; number of its linear solves, or of sweeps with `ClassicSOR`.
    fill : (n, m) array or None
        Film fraction; None for closures that do not conserve mass.
    temperature : (n, m) array, float or None
        Temperature of the film, K; None for an isothermal bearing.
    peak_temperature : float or None
        Highest temperature of the film, K; None for an isothermal bearing.
    heat_by_oil, heat_to_walls : float or None
        Heat that the oil carries out of the bearing, and heat that its walls give off, W; with `LumpedThermal`
        including the films on end faces. None for an isothermal bearing.
    supply_temperature : float or None
        Temperature of the oil that enters, K: the given one, or that of a `Sump`; None for an isothermal bearing. The
        oil leaves at this temperature plus ``heat_by_oil`` over ``oil_flow`` times density and specific heat; with a
        single arc at a higher one, because oil that has left at an edge is a part of what enters.
    walls : Walls or None
        Temperatures of bush and journal, and the clearance between them; None if neither conducts and the film has one
        temperature across it.
    bore_displacement : (n, m) array or None
        Deflection of a flexible bore or a liner, m, positive outward; None for a rigid one.
    bore_coordinates : (k,) array or None
        Coordinates of a flexible bore (amplitudes of its modes), m; None for a rigid one.
    faces : ThrustResult or None
        Films on the end faces; all other values except the heat are without them. None without ``bearing.thrust``.
    bearing : JournalBearing
    motion : (10,) array
        Motion of the journal, as in `exudyn_ehd.joint.solved_film`; with a flexible bore its coordinates and rates
        follow.

    Examples
    --------
    After the example of `steady`:

    >>> print(film)
    <SteadyResult: load 13.6 kN, minimum film thickness 4.96 µm, peak pressure 39.8 MPa, power loss 346 W>
    >>> film.pressure.shape, round(1e-6 * film.peak_pressure, 1)  # [theta, z], MPa
    ((112, 11), 39.8)
    >>> figure = film.plot_pressure()
    """

    minimum_gap: float
    peak_pressure: float
    peak_angle: float
    friction_torque: float
    friction_torque_unbroken: float
    friction_torque_bush: float
    power_loss: float
    leakage: float
    contact_load: float
    pocket_pressures: np.ndarray
    restrictor_flows: np.ndarray
    inlet_flow: float
    oil_flow: float
    supply_flows: np.ndarray
    contact_torque: float
    contact_power_loss: float
    peak_contact_pressure: float
    sommerfeld_number: float
    attitude_angle: float
    characteristic_number: float
    friction_number: float
    status: Status
    iterations: int
    peak_temperature: float | None = None
    heat_by_oil: float | None = None
    heat_to_walls: float | None = None
    supply_temperature: float | None = None
    bore_coordinates: np.ndarray | None = None
    faces: ThrustResult | None = None

    def __repr__(self) -> str:
        load = shown("force", float(np.hypot(*self.force[:2])))
        gap, peak = shown("length", self.minimum_gap), shown("pressure", self.peak_pressure)
        loss = shown("power", self.power_loss)
        return f"<SteadyResult: load {load}, minimum film thickness {gap}, peak pressure {peak}, power loss {loss}>"

    def audit(self, *, liner: ElasticLiner | None = None, measure_time: bool = False) -> Audit:
        """Find effects at this position that matter, that are omitted, or that are not needed; print it for a table.

        Parameters
        ----------
        liner : ElasticLiner or None, default None
            Liner with which elasticity is assessed, for bearings with a rigid bore; None: a steel ring.
        measure_time : bool, default False
            True measures the share of computing time of each effect that is on.

        Returns
        -------
        Audit
        """
        model = model_at(replace(self.bearing, thrust=None), self.motion)
        near = None if self.temperature is None else results.remembered(self)
        if model.flexible:
            model.evaluate(self.motion, near)  # start the search for the bore's shape at this film's shape
        # with faces keep the temperature, whose balance contains the heat of the faces
        settled = near if self.faces is not None and near is not None else history_at(model, self.motion, "audit", near)
        state = FilmState(self.motion, settled)
        return audit_of(Case(model, [state], liner=liner, measure_time=measure_time))


def steady(
    bearing: JournalBearing,
    *,
    speed: float,
    eccentricity_ratio: float,
    direction: float = 0.0,
    tilt: tuple[float, float] = (0.0, 0.0),
    velocity: tuple[float, float] = (0.0, 0.0),
    axial_speed: float = 0.0,
    axial_position: float = 0.0,
) -> SteadyResult:
    """Compute the film at a prescribed position and speed of the journal: pressure, force, friction, leakage.

    The position is prescribed, and the load is a result; `equilibrium` finds the position for a given load. All
    arguments are in the joint frame: origin on the bearing's mid-plane, z = bearing axis, fixed in the housing.

    Warnings: `OverloadWarning` for a peak pressure above 3 GPa, or a force of film and contact above 1 GPa times the
    projected area 2 R L; `GridWarning`, which names a finer grid, if the error of the peak pressure exceeds some 5 %;
    `StrainWarning` if a `ModalBush`, which is linear, strains by more than 1 %; `HotFilmWarning` above 150 degrees
    Celsius. An `ANCFBush` is in static equilibrium with the film, at any strain.

    Supply areas in the journal (``rotating=True``) are at the angles of their description. The film is that of the
    instant at which they pass there; oil content, temperature and deflection are those of areas at rest.

    Parameters
    ----------
    bearing : JournalBearing
    speed : float
        Spin omega of the journal against the housing, rad/s, positive about +z; 0 for pure squeeze.
    eccentricity_ratio : float
        Distance of the journal axis from the bore's centre at the mid-plane over the radial clearance, >= 0. Values
        above 1 are possible only with surfaces that deflect, wear or touch.
    direction : float, default 0.0
        Angle of the eccentricity from x towards y, rad.
    tilt : (float, float), default (0.0, 0.0)
        Slopes (bx, by) of the journal axis, which runs through (x + bx z, y + by z); m per m, so rad.
    velocity : (float, float), default (0.0, 0.0)
        Velocity (dx/dt, dy/dt) of the journal axis, m/s. With `ElrodAdams` the film is that of the instant at which the
        journal gets this velocity in its steady film: full parts are squeezed, cavities keep their oil content. With an
        `ElasticLiner` and `ElrodAdams` the velocity then changes no force, because the liner takes up the squeeze;
        `EquilibriumResult.dynamic_stiffness` gives the forces of continued motion.
    axial_speed : float, default 0.0
        Speed w of the journal along z, m/s.
    axial_position : float, default 0.0
        Position of the journal between the faces of ``bearing.thrust``, m; 0 without them.

    Returns
    -------
    SteadyResult

    Raises
    ------
    InputError
        For values that are not numbers, a negative eccentricity ratio, an axial position without faces, or
        `ElrodAdams` without a source of oil.
    FilmError
        If there is no film at this position, or if the journal penetrates its contact by more than the clearance.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8, tilt=(0.0, 1e-4))
    >>> (1e-3 * film.force[:2]).round(1), round(1e6 * film.minimum_gap, 2)  # kN, um
    (array([-11.4,   7.4]), 4.96)
    """
    require_type("steady: bearing", bearing, JournalBearing)
    e = require_number("steady: eccentricity_ratio", eccentricity_ratio, at_least=0.0) * bearing.radial_clearance
    angle = require_number("steady: direction", direction, "rad")
    b = require_vector("steady: tilt", tilt, 2, "rad (slopes bx and by)")
    v = require_vector("steady: velocity", velocity, 2, "m/s")
    omega = require_number("steady: speed", speed, "rad/s")
    w = require_number("steady: axial_speed", axial_speed, "m/s")
    require_size("steady: speed", omega * bearing.journal_radius, "m/s at the surface", LARGEST_SPEED)
    place = require_number("steady: axial_position", axial_position, "m")
    require_size("steady: velocity", v, "m/s", LARGEST_SPEED)
    require_size("steady: axial_speed", w, "m/s", LARGEST_SPEED)
    require_oil(bearing, "steady", w)
    position = e * math.cos(angle), e * math.sin(angle)
    start = angle + math.pi if isinstance(bearing.inlet, MaximumGap) else 0.0
    model = build_study_model(bearing, start)
    motion = np.array([*position, *b, *v, 0.0, 0.0, omega, w])
    require_faces(bearing, "steady", axial_position=place)
    return result_at(model, np.append(motion, place), "steady", faces=faces_of(bearing))


def model_at(bearing: JournalBearing, motion: np.ndarray) -> BearingModel:
    """Model for one position; a film with `MaximumGap` begins opposite to it, for a concentric journal on -x."""
    turned = isinstance(bearing.inlet, MaximumGap)
    return build_study_model(bearing, math.atan2(motion[1], motion[0]) + math.pi if turned else 0.0)


def require_rest(bearing: JournalBearing, where: str) -> None:
    """Raise `InputError` for a bearing in which a journal under a constant load has no position of rest."""
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError(f"{where}: inlet=MaximumGap() is for `steady` and `equilibrium`; use Periodic().")
    for k, area in enumerate(bearing.supply):
        if area.rotating:
            raise InputError(
                f"{where}: JournalBearing.supply[{k}] turns with the journal (rotating=True): the film changes with "
                "the angle, so that a journal under a constant load has no position of rest. Run a joint until its "
                "orbit repeats: ehd.SolveDynamic(..., until_periodic=ehd.UntilPeriodic(period=...)) with the time of "
                "one turn as period; or put the area into the housing (rotating=False)."
            )
    require_oil(bearing, where)


def require_oil(bearing: JournalBearing, where: str, axial_speed: float = 0.0) -> None:
    """Raise `InputError` if a steady mass-conserving film has no source of oil, so that it would run dry."""
    if axial_speed == 0.0 and lacks_oil(bearing):
        raise InputError(
            f"{where}: a steady film with ElrodAdams needs oil from somewhere, but no pressure is above the cavity "
            f"pressure ({bearing.cavitation.cavity_pressure:g} Pa gauge), so that the side leakage would drain the "
            f"closed ring; {MORE_OIL}"
        )


MORE_OIL = (
    "give the bearing supply=(AxialGroove(...),), end_pressures above the cavity pressure, or "
    "ElrodAdams(cavity_pressure=-1e5) below ambient pressure."
)


def _warn_of_strain(model: BearingModel, film: SolvedFilm, where: str) -> None:
    """Warn if a `ModalBush` strains by more than `LARGEST_STRAIN`, beyond which its linear modes are inaccurate."""
    modes = getattr(getattr(model, "bore", None), "modes", None)
    if film.bore is None or not isinstance(modes, BoreModes):
        return
    strain = modes.largest_strain(film.bore.coordinates[: modes.count])
    if strain > LARGEST_STRAIN:
        warn_user(
            f"{where}: the bush strains by {strain:.1%}, and a ModalBush is linear: its displacement is off by one to "
            "two times that share. Take an ANCFBush, with NeoHooke(...) for large strain.",
            StrainWarning,
        )


def result_at(
    model: BearingModel, motion: np.ndarray, where: str, near: History | None = None, faces: ThrustModel | None = None
) -> SteadyResult:
    """Return the steady film at ``motion`` as a result, with warnings; arguments and errors as for `evaluate_at`."""
    found = evaluate_at(model, motion, where, near, faces)
    evaluation, film = found.evaluation, found.film
    _warn_of_strain(model, film, where)
    warn_of_heat(film.temperature, film.grid, where)
    q, wrench = evaluation.quantities(), evaluation.wrench
    peak, angle, _ = results.refined_peak(film)
    force = math.hypot(wrench[0], wrench[1])
    warn_of_overload(model.bearing, q["minimum_gap"], peak, force, where)
    warn_of_grid(film, where)
    warn_of_starved(model.bearing, film.solver.reservoirs, where)
    # Python's floats, because quotients of numpy's floats warn of overflow
    reference, friction = float(model.bearing.reference_force(motion[8])) or math.nan, abs(float(q["friction_torque"]))
    pressures, flows = results.pocket_pressures(film)
    attitude = math.nan
    if math.hypot(motion[0], motion[1]) > 0.0 and force > 0.0:
        turn = math.atan2(motion[1], motion[0]) - math.atan2(-wrench[1], -wrench[0])
        attitude = math.remainder(turn if motion[8] >= 0.0 else -turn, 2.0 * math.pi)
    inlet, through = results.passing_flows(film)
    heat: dict[str, float] = {}
    if model.effects.thermal is not None and film.history is not None:
        heat = model.effects.thermal.balance(film, film.history.temperature)
    return SteadyResult(
        **vars(results.film_record(film)),
        minimum_gap=q["minimum_gap"],
        peak_pressure=peak,
        peak_angle=angle,
        friction_torque=q["friction_torque"],
        friction_torque_unbroken=q["friction_torque_unbroken"],
        friction_torque_bush=q["friction_torque_bush"],
        power_loss=q["power_loss"],
        leakage=q["leakage"],
        contact_load=q["contact_load"],
        pocket_pressures=pressures,
        restrictor_flows=flows,
        inlet_flow=inlet,
        oil_flow=through,
        supply_flows=results.supply_flows(film),
        contact_torque=q["contact_torque"],
        contact_power_loss=q["contact_power_loss"],
        peak_contact_pressure=q["peak_contact_pressure"],
        sommerfeld_number=force / reference,
        attitude_angle=attitude,
        characteristic_number=reference / force / (2.0 * math.pi) if force > 0.0 else math.inf,
        friction_number=friction / model.bearing.radial_clearance / force if force > 0.0 else math.inf,
        status=evaluation.status,
        iterations=evaluation.iterations,
        peak_temperature=q.get("peak_temperature"),
        heat_by_oil=heat.get("convected"),
        heat_to_walls=heat.get("conducted"),
        supply_temperature=heat.get("supply_temperature"),
        bore_coordinates=None if film.bore is None else film.bore.coordinates.copy(),
        faces=None if found.faces is None else result_of(found.faces),
    )
