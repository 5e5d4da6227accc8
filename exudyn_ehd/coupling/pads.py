"""`CreateTiltingPadBearing`: pads as bodies that tilt about their pivots, with a lubricated joint for each of them.

The film of a pad is a joint whose housing is the pad: its frame has the pad's centre of curvature as origin and turns
with the pad. Geometry and forces: `exudyn_ehd.joint.static.pads`.

`CreateTiltingPadThrustBearing`: pads that tilt about pivots, each with a film under the collar
-----------------------------------------------------------------------------------------------
The film of a pad is modelled as a joint between the pad and the shaft, with one end face and no film around its
journal. The pad's face lies at the upper end of the joint's length, under the collar.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Sequence
from typing import cast

import exudyn as exu
import exudyn.graphics
import numpy as np
from exudyn.rigidBodyUtilities import (
    AngularVelocity2EulerParameters_t,
    RigidBodyInertia,
    RotationMatrix2EulerParameters,
    RotationMatrixZ,
)
from numpy.typing import ArrayLike

from exudyn_ehd.coupling.api import Free, Held, attach, equip, require_arguments
from exudyn_ehd.coupling.contract import INITIAL, Data, Index, JointModel, Side, require_system
from exudyn_ehd.coupling.exudyn_solvers import StepControl
from exudyn_ehd.coupling.handle import LubricatedJoint
from exudyn_ehd.coupling.items.bodies import body_item
from exudyn_ehd.coupling.items.joint_frame import add_body_on, hold, hold_at_pivot, in_the_name_of, place_joint
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.rigid_nodes import POINT
from exudyn_ehd.coupling.kinematics.sides import NodeSide
from exudyn_ehd.coupling.run.restart import equilibrium_task, shift_journal
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.static.equilibrium import equilibrium
from exudyn_ehd.joint.static.pad_equilibrium import TiltingPadResult
from exudyn_ehd.joint.static.pads import PadModel, TiltingPads
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import InputError, Status, require_type, require_vector

_WHERE = "CreateTiltingPadBearing"


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class TiltingPadHistory:
    """Accepted steps of a tilting-pad bearing: sums and extremes over its pads, SI units, in the bearing's frame.

    Attributes
    ----------
    time : (n,) array
        s.
    position : (n, 2) array
        x, y of the journal axis in the bearing's mid-plane, m.
    force : (n, 3) array
        Force of all films on the journal, N.
    tilts : (n, k) array
        Angles of the pads about their pivots, rad. With flexible pivots they are computed from shifts that equal the
        films' forces over the stiffness; the inertia of the pads is omitted.
    minimum_gap, peak_pressure : (n,) arrays
        Minimum film thickness, m, and peak pressure, Pa, of all pads.
    power_loss, friction_torque : (n,) arrays
        Power loss, W, and friction torque on the journal, N m, of all films.

    Examples
    --------
    After the example of `CreateTiltingPadBearing`:

    >>> joint.history.tilts.shape
    (1, 5)
    """

    time: np.ndarray
    position: np.ndarray
    force: np.ndarray
    tilts: np.ndarray
    minimum_gap: np.ndarray
    peak_pressure: np.ndarray
    power_loss: np.ndarray
    friction_torque: np.ndarray


class TiltingPadJoint:
    """A tilting-pad bearing in a model, from `CreateTiltingPadBearing`: its pads, sums over them, start in equilibrium.

    Attributes
    ----------
    name : str
    mbs : exudyn.MainSystem
        The system it belongs to.
    bearing : TiltingPads
    pads : tuple of LubricatedJoint
        Film of every pad with its history, sensors and pictures; the frame is that of the pad.
    bodies : tuple of exudyn.ObjectIndex
        Rigid bodies of the pads.
    pivots, springs : tuples of exudyn.ObjectIndex
        Constraints between housing and pads, and springs of flexible pivots; no springs with rigid pivots.
    constraintNumber : exudyn.ObjectIndex or None
        Constraint of a bearing with `Held`; None without.

    Examples
    --------
    After the example of `CreateTiltingPadBearing`:

    >>> joint
    <TiltingPadJoint 'pads': 5 pads, journal 100 mm x 50 mm, assembled clearance 60 µm>
    >>> joint.pads[0].name
    'pads pad 1'
    >>> rest = joint.place_in_equilibrium(load=(0.0, -4000.0))
    """

    def __init__(
        self,
        mbs: exu.MainSystem,
        name: str,
        bearing: TiltingPads,
        pads: Sequence[LubricatedJoint],
        objects: Sequence[Sequence[Index]],
        constraint: Index | None,
        housing: Side,
    ) -> None:
        self.mbs, self.name, self.bearing, self.pads = mbs, name, bearing, tuple(pads)
        self._housing, angles = housing, bearing.pivots
        self._directions = np.array([[np.cos(angles), np.sin(angles)], [-np.sin(angles), np.cos(angles)]])
        self.bodies, self.pivots, self.springs = (tuple(numbers) for numbers in objects)
        self.constraintNumber = constraint

    def __repr__(self) -> str:
        b = self.bearing
        return (
            f"<TiltingPadJoint '{self.name}': {b.pads} pads, journal {1e3 * 2.0 * b.journal_radius:g} mm x "
            f"{1e3 * b.length:g} mm, assembled clearance {1e6 * b.radial_clearance:g} µm>"
        )

    @property
    def history(self) -> TiltingPadHistory:
        """Sums and extremes over the pads at all accepted steps that every film has."""
        rows = [pad.history for pad in self.pads]
        time = functools.reduce(np.intersect1d, [h.time for h in rows])

        def of(name: str) -> np.ndarray:
            """Values (k, n, ...) of all pads at these times."""
            return np.array([getattr(h, name)[np.searchsorted(h.time, time)] for h in rows])

        forces = of("force")
        outward = -np.einsum("dk,knd->kn", self._directions[0], forces[..., :2])
        position, tilts = self._places(of("motion")[..., :2], outward / (self.bearing.pivot_stiffness or math.inf))
        turned = (forces[..., 0] + 1j * forces[..., 1]) * np.exp(1j * tilts)
        forces[..., 0], forces[..., 1] = turned.real, turned.imag
        return TiltingPadHistory(
            time=time,
            position=position,
            force=forces.sum(axis=0),
            tilts=tilts.T,
            minimum_gap=of("minimum_gap").min(axis=0),
            peak_pressure=of("peak_pressure").max(axis=0),
            power_loss=of("power_loss").sum(axis=0),
            friction_torque=of("friction_torque").sum(axis=0),
        )

    def _places(self, motions: np.ndarray, shifts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute the journal's positions (n, 2) and the tilts (k, n) from its positions (k, n, 2) in the pads' frames.

        ``shifts`` (k, n): outward displacements of the pads at their pivots.
        """
        b, (radial, across) = self.bearing, self._directions
        outward = np.einsum("dk,knd->kn", radial, motions) - b.arm
        along = np.einsum("dk,knd->kn", across, motions)
        pivots, tilts = b.arm - b.preload * b.machined_clearance + shifts, np.zeros_like(along)
        # each iteration reduces the error by a factor of clearance over R
        for _ in range(4):
            position = np.linalg.lstsq(radial.T, pivots + outward * np.cos(tilts) - along * np.sin(tilts))[0].T
            tilts = np.arcsin(((position @ across).T - along * np.cos(tilts)) / outward)
        return position, tilts

    def place_in_equilibrium(
        self, *, load: Sequence[float] | np.ndarray, speed: float | None = None
    ) -> TiltingPadResult:
        """Let the next run start in the equilibrium under a steady load: journal and pads are moved there.

        Call it after Assemble. The journal's node is moved across the axis, and its velocity across the axis is set to
        that of the housing; its spin and its tilt do not change. The weight of the pads is omitted. Films with a
        thermal option start with its initial temperature.

        Parameters
        ----------
        load : (2,) [N]
            Force on the journal along x and y of the bearing's frame: all forces on its body.
        speed : float or None, default None
            Spin for which the equilibrium is computed, rad/s; None: that of the initial state.

        Returns
        -------
        TiltingPadResult

        Raises
        ------
        InputError
            For a bearing without spin, a journal that is no rigid body, or a system that is not assembled.
        FilmError
            If no equilibrium was found.
        """
        where, mbs = "TiltingPadJoint.place_in_equilibrium", self.mbs
        require_system(where, mbs, assembled=True, of=f" of bearing '{self.name}'")
        journal = self.pads[0].element.sides[1]
        # updates the journal's frame to the initial state
        self.pads[0].element.motion(mbs, INITIAL)
        data, housing = mbs.systemData, self._housing
        q, q_t = np.array(data.GetODE2Coordinates(INITIAL)), np.array(data.GetODE2Coordinates_t(INITIAL))
        own = [place for node in housing.nodes for place in data.GetNodeLTGODE2(int(node))]
        housing.update(mbs, q[own], q_t[own], INITIAL)
        motion = relative.motion_of(housing.frame, journal.frame)
        journal, force, spin = equilibrium_task(where, journal, f"bearing '{self.name}'", motion, load, speed)
        result = equilibrium(self.bearing, speed=spin, load=force)
        A, place, velocity, turning = np.split(housing.frame, (3, 4, 5), axis=1)
        shift_journal(mbs, journal, (q, q_t), A, result.position, motion)
        pivots = self.bearing.arm - self.bearing.preload * self.bearing.machined_clearance + result.pivot_displacements
        for k, pad in enumerate(self.pads):
            node, lever = pad.element.sides[0], A[:, :2] @ (pivots[k] * self._directions[0, :, k])
            assert isinstance(node, NodeSide)
            turn = RotationMatrix2EulerParameters(A @ RotationMatrixZ(result.tilts[k]))
            turn = np.ravel(turn) * math.copysign(1.0, np.ravel(turn) @ node.reference[3:])
            rates = AngularVelocity2EulerParameters_t(turning[:, 0], turn)
            own = data.GetNodeLTGODE2(int(node.nodes[0]))
            q[own] = np.append(place[:, 0] + lever, turn) - node.reference
            q_t[own] = np.append(velocity[:, 0] + np.cross(turning[:, 0], lever), rates)
            pad.element.steps.resume(float(data.GetTime(INITIAL)), None)
        data.SetODE2Coordinates(q.tolist(), INITIAL)
        data.SetODE2Coordinates_t(q_t.tolist(), INITIAL)
        return result


def CreateTiltingPadBearing(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    axis: Sequence[float] | np.ndarray = (),
    bearing: TiltingPads | None = None,
    rotationMatrixAxes: ArrayLike | None = None,
    axial: Free | Held = Free(),
    tilt: Free | Held = Free(),
    gravity: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0),
    stepControl: StepControl | None = None,
    useGlobalFrame: bool = True,
    show: bool = True,
) -> TiltingPadJoint:
    """Create a bearing of tilting pads between a housing and a journal: pads as rigid bodies, a film for each of them.

    A constraint to the housing leaves each pad its rotation about the line through its pivot parallel to the axis; with
    ``pivot_stiffness`` also the radial displacement against a spring. Implicit and static solvers run it.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system, before Assemble.
    name : str, default ""
        Name of the bearing; by default "tilting pads" and a number. Its pads are called "... pad 1" and so on.
    itemNumbers : sequence of two, default (None, None)
        Required: housing, journal, as for `CreateLubricatedJoint`; the housing is a rigid body, its node, a marker on
        it, or ground.
    position : (3,) [m], default ()
        Point of the bearing's axis in its mid-plane, as for `CreateLubricatedJoint`.
    axis : (3,), default ()
        Axis z of the bearing, as for `CreateLubricatedJoint`.
    bearing : TiltingPads, default None
        Required: pads, pivots and oil, with mass and inertia.
    rotationMatrixAxes : (3, 3) or None, default None
        Frame of the bearing, from whose x the pivots' angles count, as for `CreateLubricatedJoint`.
    axial : Free or Held, default Free()
        Free: the journal slides along the axis, along which the pads carry no force. Held: a constraint between housing
        and journal prevents this.
    tilt : Free or Held, default Free()
        Free: the films alone carry tilting moments; the pads follow the journal about their pivots' lines only. Held: a
        constraint keeps journal and housing parallel.
    gravity : (3,) [m/s^2], default (0.0, 0.0, 0.0)
        Acceleration that gives the pads their weight, global.
    stepControl : StepControl or None, default None
        As for `CreateLubricatedJoint`, in the films of all pads.
    useGlobalFrame : bool, default True
        As for `CreateLubricatedJoint`.
    show : bool, default True
        Draw the films in Exudyn's renderer.

    Returns
    -------
    TiltingPadJoint

    Raises
    ------
    InputError
        For pads without mass or inertia, a housing that can't hold them, and what `CreateLubricatedJoint` rejects.

    Examples
    --------
    After the example of `TiltingPads`:

    >>> from exudyn.utilities import InertiaCylinder
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> shaft = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.5, 0.05, 2), initialAngularVelocity=[0, 0, 300])
    >>> items = [mbs.CreateGround(), shaft]
    >>> joint = ehd.CreateTiltingPadBearing(mbs, "pads", items, [0, 0, 0], [0, 0, 1], pads, tilt=ehd.Held())
    >>> mbs.Assemble()
    """
    name = name or f"tilting pads {mbs.systemData.NumberOfObjects()}"
    flags = {"useGlobalFrame": useGlobalFrame, "show": show}
    require_arguments(_WHERE, mbs, f"{name} pad 1", stepControl, {"axial": axial, "tilt": tilt}, flags)
    require_type(f"{_WHERE}.bearing", bearing, TiltingPads)
    assert bearing is not None
    weight = require_vector(f"{_WHERE}.gravity", gravity, 3, "m/s^2")
    if not min(bearing.pad_mass, bearing.pad_inertia) > 0.0:
        raise InputError(
            f"{_WHERE}.bearing: pads are bodies and need TiltingPads.pad_mass and pad_inertia above 0, got "
            f"{bearing.pad_mass!r} kg and {bearing.pad_inertia!r} kg m2."
        )
    housing, journal, points, rotation = place_joint(
        _WHERE, mbs, itemNumbers, position, axis, rotationMatrixAxes, useGlobalFrame
    )
    if housing.kind is None or (housing.nodes and housing.kind == POINT):
        raise InputError(f"{_WHERE}.itemNumbers[0] must be a rigid body, a rigid node or marker, or ground.")
    pads, objects, inertia = [], [], RigidBodyInertia(bearing.pad_mass, bearing.pad_inertia * np.eye(3))
    rigid, spring = bearing.pivot_stiffness is None, ([1.0, 0.0, 0.0], bearing.pivot_stiffness, 0.0)
    for k, angle in enumerate(bearing.pivots):
        radial = rotation @ [math.cos(angle), math.sin(angle), 0.0]
        centre = points[0] - bearing.preload * bearing.machined_clearance * radial
        own, pivot = f"{name} pad {k + 1}", centre + bearing.arm * radial
        body = add_body_on(mbs, f"{own} body", housing, pivot, rotation, inertia, weight, show=False)
        pad = body_item(mbs, _WHERE, body)
        held = np.column_stack((radial, np.cross(rotation[:, 2], radial), rotation[:, 2]))
        joints = hold_at_pivot(mbs, own, (housing, pad), pivot, held, [int(rigid), 1, 1, 1, 1, 0], spring)
        ends, model = (centre, points[1]), PadModel(bearing, k)
        joint = attach(mbs, model, pad, journal, ends, rotation, name=own, show=show)
        equip(joint, stepControl)
        pads.append(joint)
        objects.append((body, *joints))
    kept = {"axial": isinstance(axial, Held), "tilt": isinstance(tilt, Held)}
    constraint = hold(mbs, name, (housing, journal), points, rotation, **kept)
    numbers = [*zip(*objects, strict=True), ()][:3]
    return TiltingPadJoint(mbs, name, bearing, pads, numbers, constraint, housing.side(points[0], rotation))


@dataclasses.dataclass(frozen=True, eq=False)
class NoFilm:
    """Model of a joint without a film around its journal; it is also its own evaluation.

    Attributes
    ----------
    bearing : TiltingThrustPads
    """

    bearing: TiltingThrustPads
    remembers, needs_spin, status, wrench = False, False, Status.CONVERGED, np.zeros(6)

    def initial_history(self, motion: np.ndarray) -> History | None:
        """Return None: there is no memory."""
        return None

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> NoFilm:
        """Return the evaluation at any motion."""
        return self

    def tangent(self) -> np.ndarray:
        """Zeros (6, 10)."""
        return np.zeros((6, 10))

    def quantities(self) -> dict[str, float]:
        """Return an empty dict."""
        return {}


@dataclasses.dataclass(frozen=True, eq=False, kw_only=True)
class TiltingPadThrustBearing:
    """A thrust bearing with tilting pads in a model, from `CreateTiltingPadThrustBearing`.

    Attributes
    ----------
    name : str
    mbs : exudyn.MainSystem
    bearing : TiltingThrustPads
    pads : tuple of LubricatedJoint
        Films of the pads. ``history`` has them in the columns ``thrust_minimum_gap``, ``thrust_peak_pressure``,
        ``thrust_force`` (on the collar, along the axis), ``thrust_torque``, ``thrust_power_loss`` and
        ``thrust_contact_load``; all others are nan or 0. ``AddSensor`` takes the same names. Methods that look at the
        film around a journal do not apply.
    bodyNumbers : tuple of exudyn.ObjectIndex
        Bodies of the pads; the pivot is their reference point and their centre of mass, the radial line through it x.

    Examples
    --------
    After the example of `CreateTiltingPadThrustBearing`:

    >>> thrust
    <TiltingPadThrustBearing 'thrust': 8 pads, outer diameter 200 mm>
    >>> sensor = thrust.pads[0].AddSensor("thrust_minimum_gap")
    >>> mbs.Assemble()
    >>> thrust.film_thickness.shape  # of the initial state
    (1, 8)
    """

    name: str
    mbs: exu.MainSystem
    bearing: TiltingThrustPads
    pads: tuple[LubricatedJoint, ...]
    bodyNumbers: tuple[Index, ...]

    def __repr__(self) -> str:
        size = shown("length", 2.0 * self.bearing.outer_radius)
        return f"<TiltingPadThrustBearing '{self.name}': {len(self.pads)} pads, outer diameter {size}>"

    @property
    def film_thickness(self) -> np.ndarray:
        """Film thickness (n, k) of the k pads at their pivots in the n accepted steps, m."""
        rows = [pad.history for pad in self.pads]
        (x, y, bx, by), z = np.array([r.motion[:, :4] for r in rows]).T, np.array([r.axial_position for r in rows]).T
        return np.asarray(self.bearing.pivot_film + z + bx * (x - self.bearing.pivot_radius) + by * y)


def CreateTiltingPadThrustBearing(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    axis: Sequence[float] | np.ndarray = (),
    bearing: TiltingThrustPads | None = None,
    rotationMatrixAxes: ArrayLike | None = None,
    gravity: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0),
    useGlobalFrame: bool = True,
    show: bool = True,
) -> TiltingPadThrustBearing:
    """Create a thrust bearing with tilting pads between a housing and a shaft with a collar.

    Every pad becomes a rigid body on the housing: a joint holds it at its pivot across the axis and against a turn
    about the axis, and along the axis too unless ``bearing.pivot_stiffness`` gives it an axial spring and damper. A
    film element without mass lies between each pad and the shaft, with its exact Jacobian. The films press the collar
    along +axis only; they and the pivots leave the shaft free in all other directions.

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
        Before anything runs, for: wrong or identical items; planar bodies; an invalid position or axis; a
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
    where, flags = "CreateTiltingPadThrustBearing", {"useGlobalFrame": useGlobalFrame, "show": show}
    require_arguments(where, mbs, f"{name} pad 1" if name else "", None, {}, flags)
    require_type(f"{where}.bearing", bearing, TiltingThrustPads)
    assert bearing is not None
    weight = require_vector(f"{where}.gravity", gravity, 3, "m/s^2").tolist()
    name = name or f"thrust bearing {mbs.systemData.NumberOfObjects()}"
    housing, shaft, points, rotation = place_joint(
        where, mbs, itemNumbers, position, axis, rotationMatrixAxes, useGlobalFrame, ("housing", "shaft")
    )
    if housing.kind is None or (housing.nodes and housing.kind == POINT) or housing.planar or shaft.planar:
        raise InputError(
            f"{where}.itemNumbers: pivots need a 3D rigid body, its node or ground as housing, and the collar a shaft "
            "that moves along its axis; not planar bodies, and as housing no mass point, link of a kinematic tree or "
            "flexible body: put a rigid body on it."
        )
    pads, bodies, height = [], [], 0.5 * bearing.length * rotation[:, 2]
    # a marker stays where it is
    points = points[0], points[1] if shaft.is_marker else points[1] - height
    inertia = RigidBodyInertia(bearing.pad_mass, np.diag([*bearing.pad_inertia, sum(bearing.pad_inertia)]))
    shape = {"graphicsDataList": [_shape(bearing)], "show": show}
    rigid, spring = bearing.pivot_stiffness is None, ([0.0, 0.0, 1.0], bearing.pivot_stiffness, bearing.pivot_damping)
    for k in range(bearing.pads):
        angle, title = 2.0 * math.pi * k / bearing.pads, f"{name} pad {k + 1}"
        c, s = math.cos(angle), math.sin(angle)
        frame = rotation @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        pivot = points[0] + bearing.pivot_radius * frame[:, 0]
        bodies.append(add_body_on(mbs, f"{title} body", housing, pivot, frame, inertia, weight, **shape))
        pad = body_item(mbs, f"{where}: {title}", bodies[-1])
        hold_at_pivot(mbs, title, (housing, pad), pivot, frame, [1, 1, int(rigid), 0, 0, 1], spring)
        with in_the_name_of(where, "pad", "shaft"):
            ends, model = (points[0] - height, points[1]), cast(JointModel, NoFilm(bearing))
            pads.append(attach(mbs, model, pad, shaft, ends, frame, name=title))
    return TiltingPadThrustBearing(name=name, mbs=mbs, bearing=bearing, pads=tuple(pads), bodyNumbers=tuple(bodies))


def _shape(bearing: TiltingThrustPads) -> Data:
    """Graphics of a pad in the frame of its body, a quarter of its width thick, its edges of 12 points."""
    inner, outer, first = bearing.inner_radius, bearing.outer_radius, -bearing.pivot_angle
    radii, height = np.repeat([inner, outer], 12), 0.25 * (outer - inner)
    theta = np.concatenate([along := np.linspace(first, first + bearing.extent, 12), along[::-1]])
    corners = np.column_stack([radii * np.cos(theta) - bearing.pivot_radius, radii * np.sin(theta)])
    sides = [[k, (k + 1) % len(corners)] for k in range(len(corners))]
    return cast(Data, exudyn.graphics.SolidExtrusion(corners.tolist(), sides, height, pOff=[0.0, 0.0, -height]))
