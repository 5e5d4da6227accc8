"""`CreateLubricatedJoint`, which puts an oil-filled joint between two bodies of an Exudyn system."""

from __future__ import annotations

import dataclasses
import functools
import pathlib
from collections.abc import Sequence
from typing import Literal, TypeAlias, cast, overload

import exudyn as exu
import numpy as np
from numpy.typing import ArrayLike

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index, JointModel, Side, require_system
from exudyn_ehd.coupling.element.attach import add_faces, attach_bush, initial_coordinates
from exudyn_ehd.coupling.element.outputs import FilmDisplay, add_element
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.exudyn_solvers import GapWatch, StepControl, require_of_joint
from exudyn_ehd.coupling.handle import LubricatedJoint
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.items.joint_frame import check_start, hold, move_to_start, place_joint
from exudyn_ehd.coupling.items.reduced_bodies import hold_fe_surfaces
from exudyn_ehd.coupling.record.rows import Every, File, Period
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.coupling.run.solve import joints_of, register_joint, require_new
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.status import InputError, Status, require_bool, require_number, require_type, require_vector, warn_user

RecordOption: TypeAlias = File | Every | Period

_WHERE = "CreateLubricatedJoint"


@dataclasses.dataclass(frozen=True, kw_only=True)
class Free:
    """Option of a joint. As ``axial``: the journal slides along its axis; as ``tilt``: only the film resists tilting.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> motion = ehd.Free()  # what CreateLubricatedJoint(axial=..., tilt=...) has by default
    """


@dataclasses.dataclass(frozen=True, kw_only=True)
class Held:
    """Option of a joint. As ``axial``: a constraint holds the journal along its axis; as ``tilt``: it stays parallel.

    One algebraic constraint does either or both. It carries the axial force or the tilting moment that the film does
    not carry.

    For implicit and static solvers only: Exudyn's explicit solvers stop at once and name the constraint object
    (``constraintNumber`` of the joint).

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> housing = mbs.CreateGround()
    >>> other = ehd.CreateLubricatedJoint(
    ...     mbs, "held", [housing, shaft], [0, 0, 0.2], [0, 0, 1], joint.bearing, axial=ehd.Held()
    ... )
    >>> other.constraintNumber is None
    False
    """


@overload
def CreateLubricatedJoint(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    axis: Sequence[float] | np.ndarray = (),
    bearing: JournalBearing | None = None,
    rotationMatrixAxes: ArrayLike | None = None,
    axial: Free | Held = Free(),
    tilt: Free | Held = Free(),
    stepControl: StepControl | None = None,
    bushGravity: Sequence[float] | np.ndarray | None = None,
    useGlobalFrame: bool = True,
    show: bool = True,
    axisRadius: float = 0.1,
    axisLength: float = 0.4,
    color: Sequence[float] = (-1.0, -1.0, -1.0, -1.0),
    bodyNumbers: Sequence[Index | None] | None = None,
    returnDict: Literal[False] = False,
    record: RecordOption | None = None,
) -> LubricatedJoint: ...
@overload
def CreateLubricatedJoint(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    axis: Sequence[float] | np.ndarray = (),
    bearing: JournalBearing | None = None,
    rotationMatrixAxes: ArrayLike | None = None,
    axial: Free | Held = Free(),
    tilt: Free | Held = Free(),
    stepControl: StepControl | None = None,
    bushGravity: Sequence[float] | np.ndarray | None = None,
    useGlobalFrame: bool = True,
    show: bool = True,
    axisRadius: float = 0.1,
    axisLength: float = 0.4,
    color: Sequence[float] = (-1.0, -1.0, -1.0, -1.0),
    bodyNumbers: Sequence[Index | None] | None = None,
    *,
    returnDict: Literal[True],
    record: RecordOption | None = None,
) -> dict[str, object]: ...
def CreateLubricatedJoint(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    axis: Sequence[float] | np.ndarray = (),
    bearing: JournalBearing | None = None,
    rotationMatrixAxes: ArrayLike | None = None,
    axial: Free | Held = Free(),
    tilt: Free | Held = Free(),
    stepControl: StepControl | None = None,
    bushGravity: Sequence[float] | np.ndarray | None = None,
    useGlobalFrame: bool = True,
    show: bool = True,
    axisRadius: float = 0.1,
    axisLength: float = 0.4,
    color: Sequence[float] = (-1.0, -1.0, -1.0, -1.0),
    bodyNumbers: Sequence[Index | None] | None = None,
    returnDict: bool = False,
    record: RecordOption | None = None,
) -> LubricatedJoint | dict[str, object]:
    """Create an oil-filled revolute (or, axially free, cylindrical) joint between two bodies.

    Arguments that ``mbs.CreateRevoluteJoint`` also has mean the same, so that one call replaces the other. The joint
    frame and the joint points of both bodies are taken from the reference configuration. In Exudyn the film is an
    ObjectGenericODE2 without mass on the nodes of the two bodies, with its exact Jacobian.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system, before Assemble.
    name : str, default ""
        Name of the joint, used in messages too; by default "lubricated joint" and the number of its object.
    itemNumbers : sequence of two, default (None, None)
        Required: housing, journal; each a body or ground (ObjectIndex: rigid bodies, elements of ANCF beams,
        geometrically exact beams and cables, mass points, Mass1D, RotationalMass1D), a node (NodeIndex: of rigid
        bodies, beams, cables, points) or a rigid marker (MarkerIndex: on any of these, on a link of a kinematic tree,
        on a superelement).
        A beam is joined at the point of the element where ``position`` lies. A cable element does not rotate about its
        own axis: a spatial one takes a joint along the cable, without spin of its own, or a joint across it, for motion
        in the plane normal to the joint's axis. A mass point does not rotate, like a slider in its guide: moments of
        the film on it have no effect.
    position : (3,) [m], default ()
        Point of the bearing's axis in its mid-plane, in the reference configuration: global, or in the housing's frame
        with ``useGlobalFrame=False``. A marker sets it: then give []. With two markers each sets the point of its own
        side.
    axis : (3,), default ()
        Joint axis z: global, or in the housing's frame with ``useGlobalFrame=False``; may be [] if
        ``rotationMatrixAxes`` is given. Bore and journal both have this axis in the reference configuration, so that a
        tilted axis is no misalignment. To misalign a shaft, offset its bearings: give two markers, see ``position``.
    bearing : JournalBearing, default None
        Required: geometry, lubricant, film and effects.
    rotationMatrixAxes : (3, 3) or None, default None
        Joint frame as in ``mbs.CreateGenericJoint``: columns x, y, z = axis, global or in the housing's frame. None: x
        is the local x of the housing item, projected normal to the axis (its local y, if x is parallel to the axis).
        All angles of the film are measured from x about z.
    axial : Free or Held, default Free()
        Free: the journal may slide along the axis; with ``bearing.thrust`` the films on its end faces carry axial load.
        Held: a constraint stops it.
    tilt : Free or Held, default Free()
        Free: the film alone carries tilting moments, by its length. Held: a constraint keeps journal and bore parallel
        and carries these moments, for one joint that stands for several bearings of a shaft.
    stepControl : StepControl or None, default None
        Lets Exudyn halve steps in which the gap changes by too much. None: steps are halved only if the film can't be
        evaluated or Newton's method does not converge.
    bushGravity : (3,) [m/s^2] or None, default None
        None: the housing's mass, inertia and weight contain those of the bush, so that a model weighs the same with
        every kind of bush. For a housing that does not contain its `ANCFBush` (a beam, a cable, a mesh) give the global
        acceleration of gravity: the bush's mass then counts in addition to the housing's and has this weight.
    useGlobalFrame : bool, default True
        See position, axis, rotationMatrixAxes.
    show : bool, default True
        Draw the bearing in Exudyn's renderer: a ring of the housing, and the film of the last accepted step in the
        colours of its pressure, its thickness enlarged.
    axisRadius, axisLength : float, default 0.1, 0.4
        Arguments of ``mbs.CreateRevoluteJoint``, m, accepted so that its calls can be taken over. They have no effect:
        the film is drawn in the bearing's own size.
    color : (4,), default (-1.0, -1.0, -1.0, -1.0)
        Colour of the film element's nodes, RGBA; Exudyn's default for -1.
    bodyNumbers : sequence of two or None, default None
        The name that ``itemNumbers`` had in older calls of Exudyn; a DeprecationWarning says so.
    returnDict : bool, default False
        Return a dictionary of numbers in place of the handle.
    record : File, Every, Period or None, default None
        Accepted steps that `LubricatedJoint.history` keeps, all or some, in memory or in a file. None: all, in memory.

    Returns
    -------
    LubricatedJoint or dict
        The handle, or {'joint': the handle, 'objectNumber', 'constraintNumber'}.

    Raises
    ------
    InputError
        Before anything runs, for: wrong or identical items; an invalid position or axis; a planar body with
        an axis other than z; an initial configuration with the two axes not parallel within the clearance or the
        journal outside the bore; an assembled system.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> from exudyn.utilities import InertiaCylinder
    >>> SC = exu.SystemContainer()
    >>> mbs = SC.AddSystem()
    >>> shaft = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.5, 0.025, 2), initialAngularVelocity=[0, 0, 314])
    >>> joint = ehd.CreateLubricatedJoint(mbs, "main", [mbs.CreateGround(), shaft], [0, 0, 0], [0, 0, 1], bearing)
    """
    flags = {"useGlobalFrame": useGlobalFrame, "show": show, "returnDict": returnDict}
    require_arguments(_WHERE, mbs, name, stepControl, {"axial": axial, "tilt": tilt}, flags)
    require_type(f"{_WHERE}.record", record, File, Every, Period, type(None))
    require_vector(f"{_WHERE}.color", color, 4)
    for argument, size in (("axisRadius", axisRadius), ("axisLength", axisLength)):
        require_number(f"{_WHERE}.{argument}", size, "m", above=0.0)
    if bodyNumbers is not None:
        itemNumbers = _items_of_older_calls(itemNumbers, bodyNumbers)
    gravity = None if bushGravity is None else require_vector(f"{_WHERE}.bushGravity", bushGravity, 3, "m/s^2")
    if bearing is None:
        raise InputError(f"{_WHERE}.bearing is missing; give a JournalBearing(...).")
    name = name or f"lubricated joint {mbs.systemData.NumberOfObjects()}"
    if isinstance(record, File):
        _require_new_file(mbs, record.of(name).absolute())
    housing, journal, points, rotation = place_joint(
        _WHERE, mbs, itemNumbers, position, axis, rotationMatrixAxes, useGlobalFrame
    )
    bearing, (housing, journal) = hold_fe_surfaces(mbs, bearing, (housing, journal), points, rotation)
    joint = attach(
        mbs,
        cast(JointModel, build_model(bearing)),
        housing,
        journal,
        points,
        rotation,
        name=name,
        axial=axial,
        tilt=tilt,
        show=show,
        color=color,
        gravity=gravity,
    )
    equip(joint, stepControl, record)
    if returnDict:
        return {"joint": joint, "objectNumber": joint.objectNumber, "constraintNumber": joint.constraintNumber}
    return joint


def require_arguments(
    where: str,
    mbs: exu.MainSystem,
    name: str,
    control: StepControl | None,
    motions: dict[str, Free | Held],
    flags: dict[str, bool],
) -> None:
    """Check the arguments that all functions which create joints have in common."""
    require_system(where, mbs, assembled=False)
    for argument, value in flags.items():
        require_bool(f"{where}.{argument}", value)
    for argument, motion in motions.items():
        require_type(f"{where}.{argument}", motion, Free, Held)
    require_of_joint(f"{where}.stepControl", control)
    require_new(where, mbs, name)


def _require_new_file(mbs: exu.MainSystem, path: pathlib.Path) -> None:
    """Raise `InputError` for a file into which another lubricated joint of the system writes its rows."""
    if path in {joint.element.steps.record.path for joint in joints_of(mbs)}:
        raise InputError(
            f"{_WHERE}.record: another joint of the system writes its rows to '{path}'; put {{name}} into the path of "
            "File(...), which stands for the joint's name, or name another file."
        )


def equip(joint: Joint, control: StepControl | None, record: RecordOption | None = None) -> None:
    """Set the step control and the rule for the record of a joint."""
    steps = joint.element.steps
    if control is not None:
        steps.control = GapWatch(control, joint.bearing)
    rule = record.every if isinstance(record, File) else record
    if rule is not None:
        steps.record.thin(rule)
    if isinstance(record, File):
        steps.record.keep_on_disk(record.of(joint.name).absolute(), joint.name)


def _items_of_older_calls(
    itemNumbers: Sequence[Index | None], bodyNumbers: Sequence[Index | None]
) -> Sequence[Index | None]:
    if any(item is not None for item in itemNumbers):
        raise InputError(f"{_WHERE}: give itemNumbers or bodyNumbers, its older name, not both.")
    warn_user(f"{_WHERE}.bodyNumbers is now called itemNumbers.", DeprecationWarning)
    return bodyNumbers


def attach(
    mbs: exu.MainSystem,
    model: JointModel,
    housing: Item,
    journal: Item,
    points: tuple[np.ndarray, np.ndarray],
    rotation: np.ndarray,
    *,
    name: str = "",
    axial: Free | Held = Free(),
    tilt: Free | Held = Free(),
    show: bool = True,
    color: Sequence[float] = (-1.0, -1.0, -1.0, -1.0),
    gravity: np.ndarray | None = None,
) -> LubricatedJoint:
    """Put a film model between two resolved items; `CreateLubricatedJoint` calls this after its checks of arguments.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system.
    model : JointModel
        The film.
    housing, journal : Item
        The two sides.
    points : pair of ndarray (3,)
        Joint point of either side in the reference configuration, global [m].
    rotation : ndarray (3, 3)
        Joint frame in the reference configuration.
    name, axial, tilt, show, color, gravity
        As in `CreateLubricatedJoint`.
    """
    for item in (housing, journal):
        if item.planar and abs(rotation[2, 2]) < 1.0 - 1e-12:
            raise InputError(f"{_WHERE}.axis must be parallel to z for a planar body, got {rotation[:, 2]}.")
    sides = housing.side(points[0], rotation), journal.side(points[1], rotation)
    if move_to_start(mbs, (housing, journal), sides):
        check_start(model.bearing, sides, functools.partial(_yields, model, sides))
    element = FilmElement(model, *sides, name)
    more: dict[str, object] = {}
    if isinstance(model, ElasticBearingModel):
        element, more = attach_bush(mbs, model, (housing, journal), sides, (points[0], rotation), name, show, gravity)
    elif gravity is not None:
        raise InputError(f"{_WHERE}.bushGravity: joint '{name}' has no bush with mass; leave it out.")
    display = FilmDisplay(element)
    number = add_element(mbs, display, show, color, **more)
    if getattr(model.bearing, "thrust", None) is not None:
        add_faces(mbs, element, float(rotation[:, 2] @ (points[1] - points[0])))
    held = {"axial": isinstance(axial, Held), "tilt": isinstance(tilt, Held)}
    constraint = hold(mbs, name, (housing, journal), points, rotation, **held)
    make = functools.partial(LubricatedJoint, element=element, numbers=(number, constraint), display=display)
    register_joint(mbs, make)
    return make(mbs)


def _yields(model: JointModel, sides: tuple[Side, Side], motion: np.ndarray) -> bool:
    """Return whether a flexible bore has a film at a motion (10,) at which the gap of a rigid bore would be closed.

    The work arrays of the sides must belong to that motion.
    """
    if isinstance(model, ElasticBearingModel):
        return initial_coordinates(model, sides) is not None
    if getattr(model.bearing, "bush", None) is None:
        return False
    return model.evaluate(motion, model.initial_history(motion)).status is Status.CONVERGED
