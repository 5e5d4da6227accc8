"""Bearing model from an impedance map, for aligned plain bearings.

The interface is that of `exudyn_ehd.joint.model.rigid`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap, impedance_nodes, impedance_wrench, places
from exudyn_ehd.status import FilmError, Status

# Largest tilt that is ignored: reduction of the gap at the ends, over the minimum film thickness. Its effect on the
# force is of second order. Larger: tilted journals are evaluated with a larger error instead of an error message.
NEGLIGIBLE_TILT = 0.01
_OUTCOMES = (Status.CONVERGED, Status.NOT_FINITE, Status.OUTSIDE_MAP, Status.NO_FILM)


@dataclass(eq=False, slots=True)
class ImpedanceEvaluation:
    """One evaluation; see `exudyn_ehd.joint.model.rigid.Evaluation`."""

    bearing: JournalBearing
    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    _tangent: np.ndarray
    iterations: int = 0

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10), exact; columns and rows of the tilt are zero; nan without a film."""
        return self._tangent

    def quantities(self) -> dict[str, float]:
        """Scalars by name, SI units: gap and its place, eccentricity ratio, friction, power loss, contact load 0."""
        x, y, _, _, x_t, y_t, _, _, omega, w = self.motion.tolist()
        eps = math.hypot(x, y) / self.bearing.radial_clearance
        out = {
            "minimum_gap": self.bearing.radial_clearance * (1.0 - eps),
            "minimum_gap_angle": math.atan2(y, x) % (2.0 * math.pi),
            "minimum_gap_z": 0.0,
            "eccentricity_ratio": eps,
            "largest_eccentricity_ratio": eps,
        }
        if self.status is not Status.CONVERGED:
            return out
        fx, fy, fz, _, _, torque = self.wrench.tolist()
        friction = torque - (x * fy - y * fx)
        power = fx * x_t + fy * y_t + friction * omega + fz * w
        return out | {
            "friction_torque": friction,
            "friction_torque_bush": -torque,
            "power_loss": -power,
            "stored_power": 0.0,
            "contact_load": 0.0,
        }

    def history(self) -> None:
        """Return None: the map has no memory."""
        return None


class ImpedanceModel:
    """Force of a plain aligned bearing from its impedance map.

    Parameters
    ----------
    bearing : JournalBearing
        With ``film=ImpedanceMap(...)``.
    """

    remembers = False
    needs_spin = False

    def __init__(self, bearing: JournalBearing) -> None:
        assert isinstance(bearing.film, ImpedanceMap)
        self.bearing = bearing
        ratio = bearing.length / bearing.journal_radius
        self.nodes = impedance_nodes(bearing.film, bearing.closure, ratio)
        R, c, mu = bearing.journal_radius, bearing.radial_clearance, bearing.lubricant.viscosity
        self.parameters = np.array(
            [
                *(at[1] for at in places(bearing.film)),
                bearing.film.largest_eccentricity_ratio,
                c,
                R,
                0.5 * bearing.length,
                2.0 * R * bearing.length * mu * (R / c) ** 2,
                2.0 * math.pi * ratio * mu * R**2 / c,
                NEGLIGIBLE_TILT,
            ]
        )

    def forget(self) -> None:
        """Do nothing: there is no warm start."""

    def initial_history(self, motion: np.ndarray) -> None:
        """Return None: there is no memory."""
        return None

    def evaluate(
        self, motion: np.ndarray, history: None = None, step: float = 0.0, spin: float = 0.0
    ) -> ImpedanceEvaluation:
        """Force at a motion (10,) in the joint frame, SI units; the other arguments are not used.

        Raises
        ------
        FilmError
            If the journal is tilted by more than `NEGLIGIBLE_TILT`.
        """
        motion = np.array(motion, dtype=float)
        wrench, tangent = np.empty(6), np.empty((6, 10))
        code = impedance_wrench(self.nodes, self.parameters, motion, wrench, tangent)
        if code == len(_OUTCOMES):
            self._refuse_tilt(motion)
        return ImpedanceEvaluation(self.bearing, _OUTCOMES[code], motion, wrench, tangent)

    def _refuse_tilt(self, motion: np.ndarray) -> None:
        b = self.bearing
        slope = math.hypot(motion[2], motion[3])
        gap = b.radial_clearance - math.hypot(motion[0], motion[1])
        raise FilmError(
            f"ImpedanceMap: the journal is tilted by {slope:.3g} rad, which takes {0.5 * slope * b.length:.3g} m of "
            f"the {gap:.3g} m gap at the ends; the map is for aligned journals (up to {NEGLIGIBLE_TILT:.0%} of the "
            "gap): guide the journal's axis, or "
            "use film=FiniteLength(...)."
        )
