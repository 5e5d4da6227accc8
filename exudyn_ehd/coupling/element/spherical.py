"""`SphericalFilmElement`: the film of a ball in its socket as an object of Exudyn."""

from __future__ import annotations

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import JointModel, Side, Trial
from exudyn_ehd.coupling.element.failures import Failures
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics import spherical
from exudyn_ehd.coupling.record.history import make_row
from exudyn_ehd.joint.model.fields import FilmFields
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.status import FilmError, InputError, Status

# Distance of the centres beyond which no film is thin, share of the ball's radius.
FARTHEST = 0.1


class SphericalFailures(Failures):
    """Messages of a ball that has no film."""

    bearing: SphericalBearing  # type: ignore[assignment]
    axes = 3

    def absurd(self, time: float, row: np.ndarray, trial: Trial) -> FilmError | None:
        """As for journals; a ball far out of its socket has no film either."""
        if float(np.linalg.norm(trial.motion[:3])) > FARTHEST * self.bearing.journal_radius:
            return self._at(
                time,
                f"{self._place(trial.motion)}the ball has left its socket, of which the film covers "
                f"{self.bearing.socket_angles} rad; let socket_angles reach beyond the equator, or hold it otherwise.",
            )
        return super().absurd(time, row, trial)

    def _place(self, motion: np.ndarray) -> str:
        x, y, z = (motion[:3] / self.bearing.radial_clearance).tolist()
        gap = self.bore.smallest(motion)
        return f"the ball at ({x:.4g}, {y:.4g}, {z:.4g}) clearances, minimum gap of the rigid surfaces {gap:.6g} m; "


class SphericalFilmElement(FilmElement):
    """Film between the sides of a socket and of a ball; parameters as for `FilmElement`."""

    kinematics = spherical

    def __init__(self, model: JointModel, socket: Side, ball: Side, name: str) -> None:
        super().__init__(model, socket, ball, name)
        self.failures = SphericalFailures(name, model.bearing)

    def _film_tangent(self, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (6, 10) of the wrench to the motion's `spherical.ROWS`."""
        assert trial.evaluation is not None
        return np.ascontiguousarray(trial.evaluation.tangent()[:, spherical.ROWS])

    def _derivatives(self, mbs: exu.MainSystem, trial: Trial, tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = super()._derivatives(mbs, trial, tangent)
        # it is that of another motion than the estimates of step errors know
        self.steps.tangent = None
        return found

    def row(self, time: float, trial: Trial) -> np.ndarray | None:
        """Row of the record, None without a film; its motion is place, velocity, angular velocity and 0."""
        if trial.evaluation is None or trial.status != Status.CONVERGED:
            return None
        motion = trial.motion[[0, 1, 2, 4, 5, 6, 8, 9, 10, 3]]
        ratio = float(np.linalg.norm(motion[:3])) / self.model.bearing.radial_clearance
        return make_row(time, motion, (ratio, ratio), trial.evaluation.wrench, trial.evaluation.quantities())

    def fields(
        self, mbs: exu.MainSystem, time: float, trial: Trial, configuration: exu.ConfigurationType
    ) -> FilmFields:
        """A ball has no film over angle and length."""
        raise InputError(f"LubricatedSphericalJoint '{self.failures.name}' records no films over angle and length.")
