"""Films on the end faces beside a journal's film whose position under a load is sought.

Their wrench acts at the journal's place z along the axis, which is given, or that in which film and faces carry an
axial load F_a::

    F_z(x, y, z) + F_a = 0,    dz/d(x, y) = -(dF_z/dz)^-1 dF_z/d(x, y).

For every position (x, y) it is found by Newton's method between places of either sign of the sum. A step may use up 60
% of the smallest gap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.thrust import PLACE, ThrustEvaluation, ThrustModel, no_film
from exudyn_ehd.status import FilmError, Status

LARGEST_PLACE_STEPS = 100
# Share of the load that is left along the axis, below what the search for x and y leaves.
AXIAL_TOLERANCE = 1e-12
# Shares of the clearance: step with a wall, and round-off of the difference of two places.
WALL_STEP, SAME_PLACE = 0.3, 1e-13
# Smallest gaps beyond which no place is looked for, over the clearance.
CLOSED, FARTHEST = 1e-3, 100.0


@dataclass(frozen=True, eq=False)
class FacesShare:
    """Contribution of the thrust faces at one position of the journal.

    Attributes
    ----------
    evaluation : ThrustEvaluation
    tangent : (6, 11) array
        d wrench / d motion.
    slope : (2, 2) array
        Contribution to dF/d(x, y) of the journal's film; under an axial load the axial position follows (x, y).
    """

    evaluation: ThrustEvaluation
    tangent: np.ndarray
    slope: np.ndarray


class FacesUnderLoad:
    """The films on the end faces of a bearing in a search for a position.

    Parameters
    ----------
    bearing : JournalBearing
        With ``thrust``.
    position : float
        Axial position, m, where the search for it starts if there is an axial load.
    load : float or None
        Force on the journal along z, N; None: the position is held.
    size : float
        Magnitude of the whole load, N.
    where : str
        Name of the caller, for error messages.
    """

    def __init__(self, bearing: JournalBearing, position: float, load: float | None, size: float, where: str) -> None:
        assert bearing.thrust is not None
        self.model, self.options = ThrustModel(bearing), bearing.thrust
        self.position, self.load, self.size, self.where = position, load, size, where

    def share(self, motion: np.ndarray, wrench: np.ndarray, tangent: np.ndarray) -> FacesShare:
        """The faces beside a film of this wrench (6,) and tangent (6, >= 4) at a motion.

        Raises
        ------
        FilmError
            Without a film, or a place that carries the axial load.
        """
        found = self._found(motion, float(wrench[2]))
        own = found.tangent()
        slope = own[:2, :2]
        if self.load is not None and own[2, PLACE] != 0.0:
            slope = slope - np.outer(own[:2, PLACE], own[2, :2] + tangent[2, :2]) / own[2, PLACE]
        return FacesShare(found, own, slope)

    def _found(self, motion: np.ndarray, film: float) -> ThrustEvaluation:
        """The films at the given place or that of the load, beside a film with this axial force, N."""
        if self.load is None:
            return self._at(motion, self.position)[0]
        below, above, place, rest = -math.inf, math.inf, self.position, self.load + film
        for _ in range(LARGEST_PLACE_STEPS):
            found, force, slope = self._at(motion, place)
            below, above = (place, above) if force + rest > 0.0 else (below, place)
            same = above - below <= SAME_PLACE * self.options.clearance
            if abs(force + rest) <= AXIAL_TOLERANCE * self.size or same:
                self.position = place
                return found
            gap = found.minimum_gap / self.options.clearance
            closed = self.options.contact is None and gap < CLOSED
            if (closed or gap > FARTHEST) and math.isinf(above - below):
                break
            step = -(force + rest) / slope if slope < 0.0 else math.copysign(math.inf, force + rest)
            longest = self.options.clearance * (0.6 * gap if self.options.contact is None else WALL_STEP)
            place += math.copysign(min(abs(step), longest), force + rest)
            place = place if below < place < above else 0.5 * (below + above)
        raise FilmError(
            f"{self.where}: no axial position found in which the thrust faces carry {rest:.4g} N; at "
            f"{found.motion[PLACE]:.4g} m their force is {found.wrench[2]:.4g} N. One face carries in one direction, "
            "plane faces no steady load: give them pads that carry (profile=TaperLand(...)), "
            "contact=RegularisedWall(onset=...), or less load."
        )

    def _at(self, motion: np.ndarray, place: float) -> tuple[ThrustEvaluation, float, float]:
        """The films at a place, their axial force, N, and its derivative to the place."""
        found = self.model.evaluate(np.append(motion[:PLACE], place))
        if found.status is not Status.CONVERGED:
            raise FilmError(no_film(found, self.where))
        return found, float(found.wrench[2]), float(found.tangent()[2, PLACE])
