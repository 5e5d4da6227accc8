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
from exudyn_ehd.joint.balance.film import evaluate_at
from exudyn_ehd.joint.feed.films import FedEvaluation, FedFilms
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.thrust import ThrustEvaluation, ThrustModel, no_film
from exudyn_ehd.status import FilmError, Status

LARGEST_PLACE_STEPS = 100
# Share of the load that is left along the axis, below what the search for x and y leaves.
AXIAL_TOLERANCE = 1e-12
# Of the clearance: step with a wall, and what two places differ by at rounding.
WALL_STEP, SAME_PLACE = 0.3, 1e-13
# Smallest gaps beyond which no place is looked for, over the clearance.
CLOSED, FARTHEST = 1e-3, 100.0


@dataclass(frozen=True, eq=False)
class FacesShare:
    """What the faces add at one position of the journal.

    Attributes
    ----------
    evaluation : ThrustEvaluation
    tangent : (6, 11) array
        d wrench / d (motion, axial position).
    slope : (2, 2) array
        What they add to dF/d(x, y) of the journal's film, with an axial load at the place that follows (x, y).
    own : (6, 11) array
        d wrench / d (motion, axial position) of the faces alone; of fed ones ``tangent`` also has what their feed
        changes in the journal's film.
    fed : (k,) array or None
        Flow that the journal's film gives every face, m3/s; None without ``feed``.
    """

    evaluation: ThrustEvaluation
    tangent: np.ndarray
    slope: np.ndarray
    own: np.ndarray
    fed: np.ndarray | None = None


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
        Of the whole load, N.
    where : str
        Who asks, for messages.
    """

    def __init__(self, bearing: JournalBearing, position: float, load: float | None, size: float, where: str) -> None:
        assert bearing.thrust is not None
        self.model, self.options = ThrustModel(bearing), bearing.thrust
        self.position, self.load, self.size, self.where = position, load, size, where

    def settle(self, motion: np.ndarray) -> None:
        """Bring what the journal's film has to know of the faces to a motion."""

    def share(self, motion: np.ndarray, wrench: np.ndarray, tangent: np.ndarray) -> FacesShare:
        """The faces beside a film of this wrench (6,) and tangent (6, >= 4) at a motion, after `settle`.

        Raises
        ------
        FilmError
            Without a film, or a place that carries the axial load.
        """
        found = self._found(motion, float(wrench[2]))
        own = found.tangent()
        return FacesShare(found, own, self._slope(own, tangent), own)

    def _slope(self, own: np.ndarray, film: np.ndarray) -> np.ndarray:
        """`FacesShare.slope` of what the faces add to the tangent (6, >= 4) of the film."""
        if self.load is None or own[2, 10] == 0.0:
            return np.asarray(own[:2, :2])
        return np.asarray(own[:2, :2] - np.outer(own[:2, 10], own[2, :2] + film[2, :2]) / own[2, 10])

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
            gap = min(state.minimum_gap for state in found.states) / self.options.clearance
            closed = self.options.contact is None and gap < CLOSED
            if (closed or gap > FARTHEST) and math.isinf(above - below):
                break
            step = -(force + rest) / slope if slope < 0.0 else math.copysign(math.inf, force + rest)
            longest = self.options.clearance * (0.6 * gap if self.options.contact is None else WALL_STEP)
            place += math.copysign(min(abs(step), longest), force + rest)
            place = place if below < place < above else 0.5 * (below + above)
        raise FilmError(
            f"{self.where}: no axial position found in which the thrust faces carry {rest:.4g} N; at "
            f"{found.position:.4g} m their force is {found.wrench[2]:.4g} N. One face carries in one direction, plane "
            "faces no steady load: give them pads that carry (profile=TaperLand(...)), "
            "contact=RegularisedWall(onset=...), or less load."
        )

    def _at(self, motion: np.ndarray, place: float) -> tuple[ThrustEvaluation, float, float]:
        """The films at a place, their axial force, N, and its derivative to the place."""
        found = self.model.evaluate(motion, place)
        if found.status is not Status.CONVERGED:
            raise FilmError(no_film(found, self.where))
        return found, float(found.wrench[2]), float(found.tangent()[2, 10])


class FedFacesUnderLoad(FacesUnderLoad):
    """Faces that the journal's film feeds; arguments as for `FacesUnderLoad`, with the film's model."""

    def __init__(
        self,
        model: BearingModel,
        position: float,
        load: float | None,
        size: float,
        where: str,
    ) -> None:
        super().__init__(model.bearing, position, load, size, where)
        self.films = FedFilms(model, self.model)

    def settle(self, motion: np.ndarray) -> None:
        """Bring the ends of the journal's film to the pressures of the edges at a motion, and the place of the load."""
        self._found(motion, 0.0)
        journal, self._own = self._both.with_feed()
        self._added = journal + self._own

    def share(self, motion: np.ndarray, wrench: np.ndarray, tangent: np.ndarray) -> FacesShare:
        """As `FacesUnderLoad.share`, after `settle` at this motion."""
        found = self._both
        return FacesShare(found, self._added, self._slope(self._added, tangent), self._own, found.given)

    def _at(self, motion: np.ndarray, place: float) -> tuple[ThrustEvaluation, float, float]:
        """As `FacesUnderLoad._at`, with the force of the journal's film."""
        found = self._both = require_fed(self.films, motion, place, self.where)
        force = float(found.wrench[2] + found.journal.wrench[2])
        return found, force, 0.0 if self.load is None else float(found.tangent()[2, 10])


def require_fed(films: FedFilms, motion: np.ndarray, position: float, where: str) -> FedEvaluation:
    """Both films at a motion (10,) and an axial position; `FilmError` if there are none."""
    found = films.evaluate(motion, position)
    if found.journal.film is None:
        evaluate_at(films.model, motion, where)
    if found.status is not Status.CONVERGED:
        raise FilmError(no_film(found, where))
    if not found.settled:
        raise FilmError(
            f"{where}: no pressures found at which the journal's film gives its thrust faces what they take; the "
            f"nearest are {found.pressures} Pa, with {found.given} and {found.taken} m3/s. A finer film grid may have "
            "them; ThrustFaces.inner_pressures with JournalBearing.end_pressures needs no search."
        )
    return found
