"""`CreateTiltingPadThrustBearing`: pads as bodies of a model that tilt about pivots, each with a film under the collar.

To a solver the film of a pad is that of a joint between the pad and the shaft with one end face and no film around its
journal: the pad's face lies at the upper end of the joint's length, under the collar.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import cast

import exudyn as exu
import exudyn.graphics
import numpy as np
from exudyn.rigidBodyUtilities import RigidBodyInertia
from numpy.typing import ArrayLike

from exudyn_ehd.coupling.api import attach, require_arguments
from exudyn_ehd.coupling.contract import Data, Index, JointModel
from exudyn_ehd.coupling.handle import LubricatedJoint
from exudyn_ehd.coupling.items.bodies import body_item
from exudyn_ehd.coupling.items.joint_frame import add_body_on, hold_at_pivot, in_the_name_of, place_joint
from exudyn_ehd.coupling.kinematics.rigid_nodes import POINTS
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import InputError, Status, require_type, require_vector

_WHERE = "CreateTiltingPadThrustBearing"
# Thickness of a pad as drawn over the width of the pads, and points along its edges.
THICKNESS, POINTS_DRAWN = 0.25, 12


@dataclasses.dataclass(frozen=True, eq=False)
class NoFilm:
    """A joint without a film around its journal: the model, which is its own evaluation.

    Attributes
    ----------
    bearing : TiltingThrustPads
    """

    bearing: TiltingThrustPads
    remembers, needs_spin, status, wrench = False, False, Status.CONVERGED, np.zeros(6)

    def initial_history(self, motion: np.ndarray) -> History | None:
        """Return None: there is nothing to remember."""
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
        """Return none."""
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
    flags = {"useGlobalFrame": useGlobalFrame, "show": show}
    require_arguments(_WHERE, mbs, f"{name} pad 1" if name else "", None, {}, flags)
    require_type(f"{_WHERE}.bearing", bearing, TiltingThrustPads)
    assert bearing is not None
    weight = require_vector(f"{_WHERE}.gravity", gravity, 3, "m/s^2").tolist()
    name = name or f"thrust bearing {mbs.systemData.NumberOfObjects()}"
    housing, shaft, points, rotation = place_joint(
        _WHERE, mbs, itemNumbers, position, axis, rotationMatrixAxes, useGlobalFrame, ("housing", "shaft")
    )
    if housing.kind is None or housing.kind in POINTS or housing.planar or shaft.planar:
        raise InputError(
            f"{_WHERE}.itemNumbers: pivots need a 3D rigid body, its node or ground as housing, and the collar a shaft "
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
        pad = body_item(mbs, f"{_WHERE}: {title}", bodies[-1])
        hold_at_pivot(mbs, title, (housing, pad), pivot, frame, [1, 1, int(rigid), 0, 0, 1], spring)
        with in_the_name_of(_WHERE, "pad", "shaft"):
            ends, model = (points[0] - height, points[1]), cast(JointModel, NoFilm(bearing))
            pads.append(attach(mbs, model, pad, shaft, ends, frame, name=title))
    return TiltingPadThrustBearing(name=name, mbs=mbs, bearing=bearing, pads=tuple(pads), bodyNumbers=tuple(bodies))


def _shape(bearing: TiltingThrustPads) -> Data:
    """Graphics of a pad in the frame of its body."""
    inner, outer, first = bearing.inner_radius, bearing.outer_radius, -bearing.pivot_angle
    radii, height = np.repeat([inner, outer], POINTS_DRAWN), THICKNESS * (outer - inner)
    theta = np.concatenate([along := np.linspace(first, first + bearing.extent, POINTS_DRAWN), along[::-1]])
    corners = np.column_stack([radii * np.cos(theta) - bearing.pivot_radius, radii * np.sin(theta)])
    sides = [[k, (k + 1) % len(corners)] for k in range(len(corners))]
    return cast(Data, exudyn.graphics.SolidExtrusion(corners.tolist(), sides, height, pOff=[0.0, 0.0, -height]))
