"""`CreateLubricatedSphericalJoint`: an oil-filled ball joint between two bodies, its film, history and picture."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Sequence
from typing import cast

import exudyn as exu
import exudyn.graphics
import numpy as np
from numpy.typing import ArrayLike

from exudyn_ehd.coupling.api import equip, require_arguments
from exudyn_ehd.coupling.contract import Data, Index, JointModel, Trial
from exudyn_ehd.coupling.element.failures import Failures
from exudyn_ehd.coupling.element.outputs import FilmDisplay, add_element, pressure_colours, ring_triangles
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.exudyn_solvers import StepControl
from exudyn_ehd.coupling.items.joint_frame import move_to_start, place_joint
from exudyn_ehd.coupling.kinematics.relative import BALL, ball_motion
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.coupling.run.solve import register_joint
from exudyn_ehd.joint import step_error
from exudyn_ehd.joint.audit.findings import Audit
from exudyn_ehd.joint.audit.samples import FilmSteps
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.spherical.model import SphericalEvaluation, SphericalModel
from exudyn_ehd.joint.spherical.steady import SphericalResult, audit_ball, result_of
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import FilmError, InputError, require_type, require_vector

# Distance of the centres of ball and socket, over the ball's radius, beyond which a step is an error: the film is not
# thin.
FARTHEST = 0.1
_WHERE = "CreateLubricatedSphericalJoint"
_QUANTITIES = (
    *("eccentricity_ratio", "force", "minimum_gap", "peak_pressure", "power_loss", "contact_load"),
    *("film_temperature", "sump_temperature"),
)


class SphericalFailures(Failures):
    """Messages of a ball that has no film."""

    bearing: SphericalBearing  # type: ignore[assignment]
    axes = 3

    def absurd(self, time: float, row: np.ndarray, trial: Trial) -> FilmError | None:
        """Return the error of an accepted step as for journals, or of a ball out of its socket; None if it is valid."""
        if float(np.linalg.norm(trial.motion[:3])) > FARTHEST * self.bearing.journal_radius:
            return self._at(
                time,
                f"{self.place(trial.motion)}the ball has left its socket, of which the film covers "
                f"{self.bearing.socket_angles} rad; let socket_angles reach beyond the equator, or hold it otherwise.",
            )
        return super().absurd(time, row, trial)

    def tilting(self, motion: np.ndarray) -> str:
        """Return an empty text: balls have no axis."""
        return ""

    def place(self, motion: np.ndarray) -> str:
        """Describe the ball's position at a motion (10,), for messages."""
        # without round-off, which differs between machines
        x, y, z = (np.round(motion[:3] / self.bearing.radial_clearance, 9) + 0.0).tolist()
        gap = self.bore.smallest(motion)
        return f"the ball at ({x:.4g}, {y:.4g}, {z:.4g}) clearances, minimum gap of the rigid surfaces {gap:.6g} m; "


class SphericalFilmElement(FilmElement):
    """Film between the sides of a socket and of a ball; parameters as for `FilmElement`."""

    kinematics, parts, messages = BALL, step_error.BALL, SphericalFailures

    def recorded(self, motion: np.ndarray) -> tuple[np.ndarray, tuple[float, float]]:
        """Return place, velocity, angular velocity and 0 (10,), and the eccentricity ratio twice."""
        ratio = float(np.linalg.norm(motion[:3])) / self.model.bearing.radial_clearance
        return motion[[0, 1, 2, 4, 5, 6, 8, 9, 10, 3]], (ratio, ratio)


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class SphericalHistory(FilmSteps):
    """Accepted steps of a ball joint, first the initial state, last the state now; an array for each quantity.

    `exudyn_ehd/API.md` has these columns as a table. All vectors are in the socket's frame (origin in its centre, z =
    its axis), SI units.

    Attributes
    ----------
    time : (n,) [s]
        Time at the end of the step. In a static solve Exudyn's load parameter.
    place : (n, 3) [m]
        Centre of the ball. From the socket's centre, along x, y, z.
    velocity : (n, 3) [m/s]
        Velocity of the ball's centre. Against the socket, along x, y, z; the rate that the film takes
        (`exudyn_ehd.joint.time_step`).
    angular_velocity : (n, 3) [rad/s]
        Angular velocity of the ball. Against the socket, about x, y, z, as the film takes it.
    force : (n, 3) [N]
        Force of film and contact. On the ball, along x, y, z.
    torque : (n, 3) [N m]
        Torque of the film's shear. On the ball, about its centre.
    eccentricity_ratio : (n,) [-]
        Distance of the two centres over the radial clearance. From 0.
    minimum_gap : (n,) [m]
        Minimum film thickness. Above 0; in contact, the distance of the rigid surfaces, which may be below 0.
    peak_pressure : (n,) [Pa]
        Highest film pressure. Above ambient.
    power_loss : (n,) [W]
        Mechanical power that turns into heat. Positive: taken from the motion.
    contact_load : (n,) [N]
        Force that the wall carries by contact. From 0, a part of ``force``.
    film_temperature, sump_temperature : (n,) [K]
        Temperature of the film, and of a `Sump`. With which the film was solved; nan without.
    step_error : (n,) [-]
        Estimated error of the ball's place that the time steps have made, over the minimum film thickness. From 0; of
        implicit solvers, from the third step on, else nan (`exudyn_ehd.joint.step_error`).

    Examples
    --------
    After the example of `CreateLubricatedSphericalJoint`:

    >>> mbs.Assemble()
    >>> joint.history.place.shape  # of the initial state
    (1, 3)
    """

    place: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    torque: np.ndarray
    eccentricity_ratio: np.ndarray
    film_temperature: np.ndarray
    sump_temperature: np.ndarray

    def __repr__(self) -> str:
        if not self.time.size:
            return "<SphericalHistory without steps: run a solver first>"
        gap, peak = float(self.minimum_gap.min()), float(self.peak_pressure.max())
        return (
            f"<SphericalHistory of {self.time.size} steps from {self.time[0]:.6g} to {self.time[-1]:.6g} s: "
            f"minimum film thickness {shown('length', gap)}, peak pressure {shown('pressure', peak)}>"
        )


def spherical_history(rows: JointHistory) -> SphericalHistory:
    """Convert a record, in the format of journals with moments about the socket's centre, to a ball's history."""
    place, velocity, spin = rows.motion[:, :3], rows.motion[:, 3:6], rows.motion[:, 6:9]
    return SphericalHistory(
        place=place,
        velocity=velocity,
        angular_velocity=spin,
        torque=rows.moment - np.cross(place, rows.force),
        **{name: getattr(rows, name) for name in ("time", *_QUANTITIES, "step_error")},
    )


class SphericalDisplay(FilmDisplay):
    """Graphics of the socket's patch, in the colours of the pressure of the last accepted step."""

    def graphics(self, mbs: exu.MainSystem, itemNumber: int) -> list[Data]:
        """User function of Exudyn: graphics data of the state that the renderer shows, global coordinates."""
        model, steps = self.element.model, self.element.steps
        assert isinstance(model, SphericalModel)
        if steps.is_idle:
            film = getattr(steps.look_at_accepted(mbs)[1].evaluation, "film", None)
            self.pressure = None if film is None else film.pressure
        frame, normals = self._frame(mbs), model.patch.normals
        points = np.moveaxis(normals, 0, -1).reshape(-1, 3) @ (model.bearing.ball_radius * frame[:, :3].T) + frame[:, 3]
        values = np.zeros(normals.shape[1:]) if self.pressure is None else self.pressure
        triangles, colours = ring_triangles(*values.shape), pressure_colours(values).reshape(-1, 4)
        return [exudyn.graphics.FromPointsAndTrigs(points, triangles, color=colours)]


class LubricatedSphericalJoint(Joint):
    """A lubricated ball joint in a model: history, film, sensors, audit; from `CreateLubricatedSphericalJoint`.

    Attributes
    ----------
    name : str
    mbs : exudyn.MainSystem
    bearing : SphericalBearing
    objectNumber : exudyn.ObjectIndex
        The film element.
    element : SphericalFilmElement
        The film between the two frames.

    Examples
    --------
    After the example of `CreateLubricatedSphericalJoint`:

    >>> joint
    <LubricatedSphericalJoint 'ball': object 2, ball of 30 mm, clearance 30 µm>
    """

    bearing: SphericalBearing  # type: ignore[assignment]
    _quantities = _QUANTITIES

    def __repr__(self) -> str:
        ball = f"ball of {shown('length', 2.0 * self.bearing.ball_radius)}"
        clearance = f"clearance {shown('length', self.bearing.radial_clearance)}"
        return f"<LubricatedSphericalJoint '{self.name}': object {int(self.objectNumber)}, {ball}, {clearance}>"

    @property
    def history(self) -> SphericalHistory:  # type: ignore[override]
        """All accepted steps up to now; as `LubricatedJoint.history`, with the arrays of `SphericalHistory`.

        `exudyn_ehd/API.md` describes them with their units and signs.
        """
        return spherical_history(super().history)

    def film(self) -> SphericalResult:
        """Return the film at the last accepted state; ``film().plot_pressure()`` draws it.

        Raises
        ------
        InputError
            Before Assemble, and where the system's state was changed since its run.
        FilmError
            If there is no film at that state.
        """
        self._require_end("film")
        found = self.element.steps.look_at_accepted(self.mbs)[1].evaluation
        assert isinstance(found, SphericalEvaluation)
        # valid, because this is the model's last evaluation
        return result_of(found, f"{type(self).__name__}.film")

    def audit(self) -> Audit:
        """Find the effects that mattered in the accepted steps, and important ones that a ball's film omits; print it.

        The films at the worst recorded steps are evaluated again in a separate model: the joint does not change.
        See `exudyn_ehd.joint.spherical.steady`.

        Raises
        ------
        InputError
            If nothing was recorded yet.
        """
        record = self._audited()
        return audit_ball(self.bearing, record.motion, record)


def CreateLubricatedSphericalJoint(
    mbs: exu.MainSystem,
    name: str = "",
    itemNumbers: Sequence[Index | None] = (None, None),
    position: Sequence[float] | np.ndarray = (),
    bearing: SphericalBearing | None = None,
    axis: Sequence[float] | np.ndarray = (0.0, 0.0, 1.0),
    rotationMatrixAxes: ArrayLike | None = None,
    stepControl: StepControl | None = None,
    useGlobalFrame: bool = True,
    show: bool = True,
    color: Sequence[float] = (-1.0, -1.0, -1.0, -1.0),
) -> LubricatedSphericalJoint:
    """Create an oil-filled spherical joint between two bodies.

    Arguments that ``mbs.CreateSphericalJoint`` also has mean the same, so that one call replaces the other. The film
    holds the ball in all three directions only if the socket reaches beyond the ball's equator (`SphericalBearing`). In
    Exudyn it is an ObjectGenericODE2 without mass on the nodes of the two bodies, with its exact Jacobian.

    It works as a `CreateLubricatedJoint` does with implicit, explicit and static solvers, `SolveDynamic`, `SaveState`,
    restarts and a `StepControl` of the run. `UntilPeriodic` does not accept it.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system, before Assemble.
    name : str, default ""
        Name of the joint, used in messages too.
    itemNumbers : sequence of two, default (None, None)
        Required: socket, ball; bodies, nodes or rigid markers as for `CreateLubricatedJoint`.
    position : (3,) [m], default ()
        Centre of socket and ball in the reference configuration, global, or in the socket's frame with
        ``useGlobalFrame=False``; [] if a marker is given.
    bearing : SphericalBearing, default None
        Required: dimensions, lubricant, cavitation and contact.
    axis : (3,), default (0.0, 0.0, 1.0)
        The socket's axis, global or in the socket's frame, from which its colatitudes are measured. It points from the
        centre into the cup, to its deepest point.
    rotationMatrixAxes : (3, 3) or None, default None
        Frame of the joint, global or in the socket's frame; its third column takes the place of ``axis``.
    stepControl : StepControl or None, default None
        Lets Exudyn halve steps in which the gap changes by too much; None as for `CreateLubricatedJoint`.
    useGlobalFrame : bool, default True
        See position, axis, rotationMatrixAxes.
    show : bool, default True
        Draw the socket in Exudyn's renderer, in the colours of the film's pressure.
    color : (4,), default (-1.0, -1.0, -1.0, -1.0)
        Colour of the film element's nodes, RGBA; Exudyn's default for -1.

    Returns
    -------
    LubricatedSphericalJoint

    Raises
    ------
    InputError
        Before anything runs, for: wrong or identical items; an invalid position or axis; a ball that is not
        inside the socket in the initial configuration; an assembled system.

    Examples
    --------
    After the example of `SphericalBearing`:

    >>> from exudyn.utilities import InertiaCuboid
    >>> SC = exu.SystemContainer()
    >>> mbs = SC.AddSystem()
    >>> arm = mbs.CreateRigidBody(inertia=InertiaCuboid(7800, [0.2, 0.02, 0.02]), gravity=[0, 0, -9.81])
    >>> joint = ehd.CreateLubricatedSphericalJoint(mbs, "ball", [mbs.CreateGround(), arm], [0, 0, 0], ball)
    """
    require_arguments(_WHERE, mbs, name, stepControl, {}, {"useGlobalFrame": useGlobalFrame, "show": show})
    require_type(f"{_WHERE}.bearing", bearing, SphericalBearing)
    assert bearing is not None
    require_vector(f"{_WHERE}.color", color, 4)
    axis = axis if rotationMatrixAxes is None else ()
    socket, ball, points, rotation = place_joint(
        _WHERE, mbs, itemNumbers, position, axis, rotationMatrixAxes, useGlobalFrame, ("socket", "ball")
    )
    name = name or f"lubricated ball joint {mbs.systemData.NumberOfObjects()}"
    sides = socket.side(points[0], rotation), ball.side(points[1], rotation)
    model = SphericalModel(bearing)
    if move_to_start(mbs, (socket, ball), sides):
        place = ball_motion(sides[0].frame, sides[1].frame)[:3]
        if not bearing.smallest_gap(place) > 0.0:
            raise InputError(
                f"{_WHERE}: the ball is outside the socket in the initial configuration: its centre is at {place} m in "
                f"the socket's frame, radial clearance {bearing.radial_clearance:g} m; check the initial positions, "
                "and whether the clearance is radial."
            )
    element = SphericalFilmElement(cast(JointModel, model), *sides, name)
    number = add_element(mbs, SphericalDisplay(element), show, color)
    make = functools.partial(LubricatedSphericalJoint, element=element, numbers=(number, None))
    register_joint(mbs, make)
    equip(joint := make(mbs), stepControl)
    return joint
