"""`CreateTiltingPadThrustBearing`: pads as bodies of a model that tilt about pivots, each with a film under the collar."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Sequence
from typing import cast

import exudyn as exu
import exudyn.graphics
import exudyn.itemInterface as eii
import numpy as np
from exudyn.rigidBodyUtilities import RigidBodyInertia
from numpy.typing import ArrayLike

from exudyn_ehd.coupling.contract import INITIAL, Index, JointModel, Side, Trial, require_system
from exudyn_ehd.coupling.element.failures import Failures
from exudyn_ehd.coupling.element.outer_load import OuterLoad
from exudyn_ehd.coupling.element.presence import Presence
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.items.joint_frame import (
    in_the_name_of,
    joint_points,
    joint_rotation,
    resolve_pair,
    rigid_marker,
)
from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.coupling.kinematics import collar
from exudyn_ehd.coupling.kinematics.rigid_nodes import PLACE, POINTS, SPIN, VELOCITY
from exudyn_ehd.coupling.kinematics.sides import MarkerSide
from exudyn_ehd.coupling.record.history import make_row
from exudyn_ehd.coupling.record.record import Record
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.coupling.run.solve import register_joint, require_new
from exudyn_ehd.coupling.watch.step_control import GapWatch, StepControl, require_of_joint
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.joint.step_error import NO_BALL_ERROR
from exudyn_ehd.joint.thrust_pad import PadModel
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import InputError, Status, require_bool, require_type, require_vector

_WHERE = "CreateTiltingPadThrustBearing"
# Thickness of a pad as drawn over the width of the pads, and lines along its edges.
THICKNESS, LINES = 0.25, 12


class PadFailures(Failures):
    """Messages of a thrust pad that has no film."""

    axes = 3

    def tilting(self, motion: np.ndarray) -> str:
        """Return an empty text: pads tilt as they like."""
        return ""

    def place(self, motion: np.ndarray) -> str:
        """Describe the collar's position at a motion (11,), for messages."""
        zeta, bx, by = motion[:3].tolist()
        gap = self.bore.smallest(motion)
        return f"the collar at {zeta:.4g} m, tilt ({bx:.3g}, {by:.3g}) against the pad, smallest gap {gap:.4g} m; "


def _no_errors(bearing: object, rows: np.ndarray, before: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return nan (n,) for rows (n, k) and the error before them: steps of pads have no estimate."""
    return np.full(len(rows), np.nan), before


class PadFilmElement(FilmElement):
    """Film between the sides of a thrust pad and of a shaft; parameters as for `FilmElement`."""

    kinematics = collar

    def __init__(self, model: JointModel, pad: Side, shaft: Side, name: str) -> None:
        super().__init__(model, pad, shaft, name)
        self.failures = PadFailures(name, model.bearing)
        self.steps.record = Record(model.bearing, _no_errors, NO_BALL_ERROR)
        self.outer = OuterLoad(self.sides, ())

    def _film_tangent(self, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (6, 10) of the wrench to the motion's `collar.ROWS`."""
        return np.ascontiguousarray(trial.found.tangent()[:, collar.ROWS])

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """Return the Jacobian as `FilmElement`; no tangent is kept for an estimate of the steps' errors."""
        jacobian = super()._jacobian(mbs, trial, f_q, f_qt)
        self.steps.tangent = None
        return jacobian

    def row(self, time: float, trial: Trial) -> np.ndarray | None:
        """Row of the record, None without a film; its motion has the entries `collar.ROWS`."""
        if trial.evaluation is None or trial.status != Status.CONVERGED:
            return None
        quantities, ratios = trial.evaluation.quantities(), (math.nan, math.nan)
        return make_row(time, trial.motion.take(collar.ROWS), ratios, trial.evaluation.wrench, quantities)


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class ThrustPadsHistory:
    """Accepted steps of a tilting-pad thrust bearing with k pads, first the initial state, last the state now.

    Attributes
    ----------
    time : (n,) [s]
        Time at the end of the step.
    film_thickness : (n, k) [m]
        Film thickness of every pad at its pivot.
    inclination : (n, k, 2) [rad]
        Slopes of every gap at the pivot. Along the radius, dh / dr, and in the sense of +theta, dh / (r dtheta);
        without a crown's.
    minimum_gap : (n, k) [m]
        Minimum film thickness of every pad.
    peak_pressure : (n, k) [Pa]
        Highest film pressure of every pad, at a vertex of its grid.
    pad_force : (n, k) [N]
        Axial force of every film and its contact. On the collar, positive away from the pads.
    force : (n,) [N]
        Axial force of all pads. On the collar, the sum of ``pad_force``.
    friction_torque : (n,) [N m]
        Torque of all pads. On the collar, about the axis.
    power_loss : (n,) [W]
        Mechanical power that turns into heat or pumps oil, of all pads.

    Examples
    --------
    After the example of `CreateTiltingPadThrustBearing`:

    >>> mbs.Assemble()
    >>> thrust.history.film_thickness.shape  # of the initial state
    (1, 8)
    """

    time: np.ndarray
    film_thickness: np.ndarray
    inclination: np.ndarray
    minimum_gap: np.ndarray
    peak_pressure: np.ndarray
    pad_force: np.ndarray
    force: np.ndarray
    friction_torque: np.ndarray
    power_loss: np.ndarray

    def __repr__(self) -> str:
        if not self.time.size:
            return "<ThrustPadsHistory without steps: run a solver first>"
        gap, peak = float(self.minimum_gap.min()), float(self.peak_pressure.max())
        return (
            f"<ThrustPadsHistory of {self.time.size} steps from {self.time[0]:.6g} to {self.time[-1]:.6g} s: "
            f"minimum film thickness {shown('length', gap)}, peak pressure {shown('pressure', peak)}>"
        )


class ThrustPad(Joint):
    """Film of one pad in a model, as solvers, stored states and restarts know it.

    Attributes
    ----------
    name : str
    mbs : exudyn.MainSystem
    bearing : TiltingThrustPads
    objectNumber : exudyn.ObjectIndex
        The film element.
    element : PadFilmElement
    """

    bearing: TiltingThrustPads  # type: ignore[assignment]

    def __init__(self, mbs: exu.MainSystem, name: str, element: PadFilmElement, number: Index) -> None:
        self.mbs, self.name, self.element, self.objectNumber = mbs, name, element, number
        self.bearing = cast(TiltingThrustPads, element.model.bearing)

    def __repr__(self) -> str:
        return f"<ThrustPad '{self.name}': object {int(self.objectNumber)}>"


class TiltingPadThrustBearing:
    """A thrust bearing with tilting pads in a model: its pads and their history; from `CreateTiltingPadThrustBearing`.

    Attributes
    ----------
    name : str
    mbs : exudyn.MainSystem
    bearing : TiltingThrustPads
    pads : tuple of ThrustPad
        Films of the pads, with ``stop_at``, ``forget``, ``state`` of a `LubricatedJoint`.
    bodyNumbers : tuple of exudyn.ObjectIndex
        Bodies of the pads, for sensors and loads; the pivot is their reference point and their centre of mass.
    """

    def __init__(self, mbs: exu.MainSystem, name: str, pads: Sequence[ThrustPad], bodies: Sequence[Index]) -> None:
        self.mbs, self.name, self.pads, self.bodyNumbers = mbs, name, tuple(pads), tuple(bodies)
        self.bearing = self.pads[0].bearing

    def __repr__(self) -> str:
        size = f"{shown('length', 2.0 * self.bearing.outer_radius)} outer diameter"
        return f"<TiltingPadThrustBearing '{self.name}': {len(self.pads)} pads, {size}>"

    @property
    def history(self) -> ThrustPadsHistory:
        """All accepted steps up to now, as `LubricatedJoint.history`, with the arrays of `ThrustPadsHistory`."""
        rows, (untilted, lever) = [pad.history for pad in self.pads], self.bearing.pivot_film
        motion, force = (np.stack([getattr(r, part) for r in rows], axis=1) for part in ("motion", "force"))
        names = ("minimum_gap", "peak_pressure", "friction_torque", "power_loss")
        parts = {name: np.stack([getattr(r, name) for r in rows], axis=1) for name in names}
        return ThrustPadsHistory(
            time=rows[0].time,
            film_thickness=untilted + motion[:, :, 0] + lever * motion[:, :, 1],
            inclination=-motion[:, :, 1:3],
            minimum_gap=parts["minimum_gap"],
            peak_pressure=parts["peak_pressure"],
            pad_force=force[:, :, 2],
            force=force[:, :, 2].sum(axis=1),
            friction_torque=parts["friction_torque"].sum(axis=1),
            power_loss=parts["power_loss"].sum(axis=1),
        )


def CreateTiltingPadThrustBearing(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    axis: Sequence[float] | np.ndarray = (),
    bearing: TiltingThrustPads | None = None,
    rotationMatrixAxes: ArrayLike | None = None,
    gravity: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0),
    stepControl: StepControl | None = None,
    useGlobalFrame: bool = True,
    show: bool = True,
) -> TiltingPadThrustBearing:
    """Create a thrust bearing with tilting pads between a housing and a shaft with a collar.

    Every pad becomes a rigid body on the housing: a joint holds it at its pivot across the axis and against a turn
    about the axis, and along the axis too unless ``bearing.pivot_stiffness`` gives it an axial spring and damper. A film
    element without mass lies between each pad and the shaft, with its exact Jacobian. The films press the collar along
    +axis only; they and the pivots leave the shaft free in all other directions.

    It works as a `CreateLubricatedJoint` does with implicit and static solvers, `SolveDynamic`, `SaveState` and
    restarts. Its films do not take part in ``StepControl(error=...)``; `UntilPeriodic` and `SolveEquilibrium` do not
    accept them.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system, before Assemble.
    name : str, default ""
        Name of the bearing, used in messages too; its pads are called "name pad 1" and so on.
    itemNumbers : sequence of two, default (None, None)
        Required: housing, a rigid body, its node, a rigid marker on it, or ground; shaft, as for
        `CreateLubricatedJoint`.
    position : (3,) [m], default ()
        Point of the bearing's axis in the plane of the untilted pads, in the reference configuration: global, or in the
        housing's frame with ``useGlobalFrame=False``; [] if markers are given, both in this plane. The collar lies
        ``bearing.clearance`` beyond it.
    axis : (3,), default ()
        Axis of bearing and shaft from the pads to the collar, as for `CreateLubricatedJoint`.
    bearing : TiltingThrustPads, default None
        Required: dimensions, pivots, inertia and lubricant of the pads.
    rotationMatrixAxes : (3, 3) or None, default None
        Frame as for `CreateLubricatedJoint`; the first pivot lies on its x, the others follow about its z.
    gravity : (3,) [m/s^2], default (0.0, 0.0, 0.0)
        Acceleration of gravity that acts on the pads, global.
    stepControl : StepControl or None, default None
        Lets Exudyn halve steps in which a gap changes by too much; None as for `CreateLubricatedJoint`.
    useGlobalFrame : bool, default True
        See position, axis, rotationMatrixAxes.
    show : bool, default True
        Draw the pads in Exudyn's renderer.

    Returns
    -------
    TiltingPadThrustBearing

    Raises
    ------
    InputError
        Before anything runs, for: wrong or identical items; planar bodies; a position or axis that can't be meant; a
        collar that touches pads in the initial configuration; an assembled system.

    Examples
    --------
    After the example of `TiltingThrustPads`:

    >>> from exudyn.utilities import InertiaCylinder
    >>> SC = exu.SystemContainer()
    >>> mbs = SC.AddSystem()
    >>> shaft = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.5, 0.04, 2), initialAngularVelocity=[0, 0, 300])
    >>> items = [mbs.CreateGround(), shaft]
    >>> thrust = ehd.CreateTiltingPadThrustBearing(mbs, "thrust", items, [0, 0, 0], [0, 0, 1], pads)
    """
    require_system(_WHERE, mbs, assembled=False)
    for argument, value in (("useGlobalFrame", useGlobalFrame), ("show", show)):
        require_bool(f"{_WHERE}.{argument}", value)
    require_type(f"{_WHERE}.bearing", bearing, TiltingThrustPads)
    assert bearing is not None
    require_of_joint(f"{_WHERE}.stepControl", stepControl)
    weight = require_vector(f"{_WHERE}.gravity", gravity, 3, "m/s^2").tolist()
    require_new(_WHERE, mbs, f"{name} pad 1" if name else "")
    name = name or f"thrust bearing {mbs.systemData.NumberOfObjects()}"
    with in_the_name_of(_WHERE, "housing", "shaft"):
        housing, shaft = resolve_pair(mbs, itemNumbers)
        rotation = joint_rotation(housing, axis, rotationMatrixAxes, useGlobalFrame)
        points = joint_points(housing, shaft, position, useGlobalFrame)
    _require_spatial(housing, shaft, float(rotation[:, 2] @ (points[1] - points[0])) / bearing.outer_radius)
    look = [_shape(bearing)] if show else []
    pads, bodies = [], []
    for k in range(bearing.pads):
        angle = 2.0 * math.pi * k / bearing.pads
        c, s = math.cos(angle), math.sin(angle)
        frame = rotation @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        title = f"{name} pad {k + 1}"
        bodies.append(_add_body(mbs, title, bearing, housing, points[0], frame, weight, look))
        pad = resolve(mbs, f"{_WHERE}: {title}", bodies[-1])
        pads.append(_add_film(mbs, title, bearing, (pad, shaft), points, frame))
        if stepControl is not None:
            pads[-1].element.steps.control = GapWatch(stepControl, pads[-1].element.model.bearing)
    return TiltingPadThrustBearing(mbs, name, pads, bodies)


def _require_spatial(housing: Item, shaft: Item, offset: float) -> None:
    """Refuse items that can't hold pads or a collar, and markers at an ``offset`` along the axis, over the radius."""
    if housing.kind is None or housing.kind in POINTS:
        raise InputError(
            f"{_WHERE}.itemNumbers[0]: pivots need a rigid body, a rigid node or ground as housing, not a mass point, a "
            "link of a kinematic tree or a flexible body; hold a rigid body on it, and give that body."
        )
    if housing.planar or shaft.planar:
        raise InputError(f"{_WHERE}.itemNumbers: planar bodies do not move along an axis or tilt; give 3D bodies.")
    if abs(offset) > 1e-9:
        raise InputError(
            f"{_WHERE}.itemNumbers: both markers must lie in the plane of the pads in the reference configuration, got "
            f"an axial distance of {offset:.3g} outer radii; shift one of them along the axis."
        )


def _shape(bearing: TiltingThrustPads) -> dict[str, object]:
    """Graphics of a pad in the frame of its body."""
    theta = np.linspace(-bearing.pivot_angle, bearing.extent - bearing.pivot_angle, LINES)
    arcs = [r * np.array([np.cos(t), np.sin(t)]) for r, t in ((bearing.inner_radius, theta), (bearing.outer_radius, theta[::-1]))]
    corners, height = np.hstack(arcs).T - [bearing.pivot_radius, 0.0], THICKNESS * (bearing.outer_radius - bearing.inner_radius)
    sides = [[k, (k + 1) % len(corners)] for k in range(len(corners))]
    return exudyn.graphics.SolidExtrusion(corners.tolist(), sides, height, pOff=[0.0, 0.0, -height])


def _add_body(
    mbs: exu.MainSystem,
    title: str,
    bearing: TiltingThrustPads,
    housing: Item,
    point: np.ndarray,
    frame: np.ndarray,
    weight: list[float],
    look: list[dict[str, object]],
) -> Index:
    """Add the body of a pad, which moves with the housing at the start, and what holds it at its pivot."""
    pivot, k, d = point + bearing.pivot_radius * frame[:, 0], bearing.pivot_stiffness, bearing.pivot_damping
    side = housing.side(pivot, frame)
    side.update(mbs, housing.initial_coordinates, housing.initial_velocities, INITIAL)
    inertia = RigidBodyInertia(bearing.pad_mass, np.diag([*bearing.pad_inertia, sum(bearing.pad_inertia)]))
    body: Index = mbs.CreateRigidBody(
        name=f"{title} body",
        referencePosition=pivot.tolist(),
        referenceRotationMatrix=frame,
        initialDisplacement=(side.frame[:, PLACE] - pivot).tolist(),
        initialRotationMatrix=frame.T @ side.frame[:, :3],
        initialVelocity=side.frame[:, VELOCITY].tolist(),
        initialAngularVelocity=side.frame[:, SPIN].tolist(),
        inertia=inertia,
        gravity=weight,
        graphicsDataList=look,
        show=bool(look),
    )
    items = {"seat": housing, "pivot": resolve(mbs, title, body)}
    markers = [rigid_marker(mbs, f"{title} {part}", item, pivot, frame, "a pivot") for part, item in items.items()]
    mbs.AddObject(
        eii.ObjectJointGeneric(
            name=f"{title} pivot",
            markerNumbers=markers,
            constrainedAxes=[1, 1, int(k is None), 0, 0, 1],
            visualization=eii.VObjectJointGeneric(show=False),
        )
    )
    if k is not None:
        mbs.AddObject(
            eii.ObjectConnectorRigidBodySpringDamper(
                name=f"{title} support",
                markerNumbers=markers,
                stiffness=np.diag([0.0, 0.0, k, 0.0, 0.0, 0.0]),
                damping=np.diag([0.0, 0.0, d, 0.0, 0.0, 0.0]),
                visualization=eii.VObjectConnectorRigidBodySpringDamper(show=False),
            )
        )
    return body


def _add_film(
    mbs: exu.MainSystem,
    title: str,
    bearing: TiltingThrustPads,
    items: tuple[Item, Item],
    points: tuple[np.ndarray, np.ndarray],
    frame: np.ndarray,
) -> ThrustPad:
    """Add the film between a pad and the collar of the shaft."""
    sides = items[0].side(points[0], frame), items[1].side(points[1], frame)
    element = PadFilmElement(cast(JointModel, PadModel(bearing)), *sides, title)
    if not isinstance(sides[1], MarkerSide):
        for item, side in zip(items, sides, strict=True):
            side.update(mbs, item.initial_coordinates, item.initial_velocities, INITIAL)
        motion = collar.motion_of(sides[0].frame, sides[1].frame)
        if not element.failures.bore.smallest(motion) > 0.0:
            raise InputError(
                f"{_WHERE}: the collar is not above '{title}' in the initial configuration: "
                f"{element.failures.place(motion)}check the initial positions, the axis, which points from the pads to "
                "the collar, and TiltingThrustPads.clearance."
            )
    number = mbs.AddObject(
        eii.ObjectGenericODE2(
            name=title,
            nodeNumbers=element.nodes,
            forceUserFunction=element.force,
            jacobianUserFunction=element.jacobian,
            visualization=eii.VObjectGenericODE2(show=False),
        )
    )
    element.presence = Presence(mbs, title, element, number, sides)
    make = functools.partial(ThrustPad, name=title, element=element, number=number)
    register_joint(mbs, make)
    return make(mbs)
