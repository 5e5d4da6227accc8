"""`SphericalHistory`: the accepted steps of a ball joint, and its picture in Exudyn's renderer."""

from __future__ import annotations

import dataclasses

import exudyn as exu
import exudyn.graphics
import numpy as np

from exudyn_ehd.coupling.contract import Data
from exudyn_ehd.coupling.record.display import FilmDisplay, pressure_colours, ring_triangles
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.joint.spherical.model import SphericalModel
from exudyn_ehd.pictures.units import shown

COPIED = ("time", "eccentricity_ratio", "force", "minimum_gap", "peak_pressure", "power_loss", "contact_load")


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class SphericalHistory:
    """Accepted steps of a ball joint, first the initial state, last the state now; socket's frame, SI units.

    Attributes
    ----------
    time : (n,) array
        s.
    place, velocity, angular_velocity : (n, 3) arrays
        Of the ball's centre and of the ball as seen from the socket, m, m/s, rad/s; velocities as the film takes them
        (`exudyn_ehd.joint.step_rates`).
    force, torque : (n, 3) arrays
        On the ball, N; torque about its centre, N m.
    eccentricity_ratio : (n,) array
        Distance of the centres over the radial clearance.
    minimum_gap, peak_pressure : (n,) arrays
        m, Pa.
    power_loss, contact_load : (n,) arrays
        W that turn into heat, N of the wall in ``force``.

    Examples
    --------
    After the example of `CreateLubricatedSphericalJoint`:

    >>> joint.history, joint.history.place.shape
    (<SphericalHistory without steps>, (0, 3))
    """

    time: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    force: np.ndarray
    torque: np.ndarray
    eccentricity_ratio: np.ndarray
    minimum_gap: np.ndarray
    peak_pressure: np.ndarray
    power_loss: np.ndarray
    contact_load: np.ndarray

    def __repr__(self) -> str:
        if not self.time.size:
            return "<SphericalHistory without steps>"
        gap, peak = float(self.minimum_gap.min()), float(self.peak_pressure.max())
        return (
            f"<SphericalHistory of {self.time.size} steps from {self.time[0]:.6g} to {self.time[-1]:.6g} s: "
            f"minimum film thickness {shown('length', gap)}, peak pressure {shown('pressure', peak)}>"
        )


def spherical_history(rows: JointHistory) -> SphericalHistory:
    """A ball's history from the record that it shares with journals, whose moments are about the socket's centre."""
    place, velocity, spin = rows.motion[:, :3], rows.motion[:, 3:6], rows.motion[:, 6:9]
    return SphericalHistory(
        place=place,
        velocity=velocity,
        angular_velocity=spin,
        torque=rows.moment - np.cross(place, rows.force),
        **{name: getattr(rows, name) for name in COPIED},
    )


class SphericalDisplay(FilmDisplay):
    """The socket's patch in the colours of the pressure of the last accepted step."""

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
