"""The film of one tilting thrust pad as a pure function of the collar's motion in the frame of the pad.

The frame is that of `exudyn_ehd.film.thrust.tilting`, which moves with the pad: its tilts are those of the collar with
the opposite sign. The motion (11,) is

    zeta, bx, by, 0, zeta_t, bx_t, by_t, 0, omega, u_x, u_y

in the symbols of `exudyn_ehd.film.thrust.face`; `exudyn_ehd.joint.step_rates` knows four places and four rates.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.film.thrust.face import FaceFilm, FaceState
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.thrust import ThrustModel, is_at_rest
from exudyn_ehd.status import Status

SIZE = 11
FACE = [0, 1, 2, 4, 5, 6, 8, 9, 10]
"""Entries of the motion that the film of a face takes."""


@dataclass(frozen=True, eq=False)
class PadEvaluation:
    """One evaluation of a pad's film, as `exudyn_ehd.coupling.contract.JointEvaluation`.

    Attributes
    ----------
    status : Status
    motion : (11,) array
    wrench : (6,) array
        On the collar, moment about the frame's origin, N and N m; nan without a film.
    state : FaceState
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    state: FaceState
    model: PadModel
    serial: int

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 11), exact; only until the model's next evaluation."""
        if self.serial != self.model.serial:
            raise RuntimeError("PadEvaluation.tangent: the model has evaluated another state since.")
        out, film = np.full((6, SIZE), np.nan), self.model.film
        if self.status is Status.CONVERGED:
            out[:] = 0.0
            out[:, FACE] = film.tangent()
            if is_at_rest(film):
                out[:, FACE] += self.model.change_at_rest(film)
        return out

    def quantities(self) -> Mapping[str, float]:
        """Scalars by name: m, Pa, N m, W, N."""
        return {
            "minimum_gap": self.state.minimum_gap,
            "peak_pressure": self.state.peak_pressure,
            "friction_torque": float(self.wrench[5]),
            "power_loss": self.state.power_loss,
            "contact_load": self.state.contact_load,
        }

    def history(self) -> History | None:
        """Return None: the film remembers nothing."""
        return None


class PadModel(ThrustModel):
    """Film between a tilting thrust pad and the collar.

    Parameters
    ----------
    bearing : TiltingThrustPads
    """

    bearing: TiltingThrustPads  # type: ignore[assignment]
    remembers = needs_spin = False
    motion_size = SIZE

    def __init__(self, bearing: TiltingThrustPads) -> None:
        self.bearing, self.serial = bearing, 0
        self.film = FaceFilm(bearing, 1, bearing.cavitation, bearing.lubricant.viscosity, (0.0, 0.0))
        self._changes = {}

    def initial_history(self, motion: np.ndarray) -> History | None:
        """Return None: the film remembers nothing."""
        return None

    def evaluate(  # type: ignore[override]
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> PadEvaluation:
        """Film at a motion (11,)."""
        self.serial += 1
        motion = np.array(motion, dtype=float)
        state = FaceState(Status.NOT_FINITE, np.full(6, np.nan), np.nan)
        if np.isfinite(motion.sum()):
            state = self.film.evaluate(motion[FACE])
        return PadEvaluation(state.status, motion, state.wrench, state, self, self.serial)
