"""Searches for the position in which a film carries a load."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import scipy

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.surfaces.profile import AxialProfile, Crown, EdgeRelief
from exudyn_ehd.joint.balance.limits import HOTTEST, WAY_OUT, hottest, is_above, too_hot
from exudyn_ehd.joint.balance.steady_film import FREE_STEP, LOAD_TOLERANCE, Balance, Place, gaps_of_arcs
from exudyn_ehd.joint.newton import HALVINGS, PATIENCE, ROUNDED, ROUNDS, continued, damped_step
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import SMALL, FilmError, InputError, warn_user

# First and shortest step of the continuation from small loads, as shares of the load. Smaller: slower, fails less.
FIRST_SHARE, SMALLEST_SHARE = 0.25, 0.01
# Gap over the clearance below which surfaces count as touching: a journal lies on the edge of an arc, says an error
# message, and errors of time steps are no longer relative to the film. Larger: more often.
CLOSED = 0.01


class LoadSearch(Balance):
    """Search for the position in which the steady film of a model carries a load.

    Searches in this order, until one succeeds:

    1. Newton's method from the given motion;
    2. `climb`, for loads that grow from a quarter of the whole: only if the film has a temperature and no film ``near``
       is known. If it reaches a part of the load, the search ends here;
    3. damped steps from the given motion;
    4. damped steps from one longest step, `FREE_STEP`, along the load from the centre, where no cavity is large;
    5. in a lobed bearing, damped steps from `opposed`.

    Attributes
    ----------
    held_back : float
        Resistance of damped steps, N/m.
    """

    def find(self, motion: np.ndarray, near: Place | None = None) -> Place:
        """Return the film at the position in which it carries the load.

        The search starts at the position of ``motion`` and at the temperature of the film ``near``.

        Raises
        ------
        FilmError
            If none was found.
        """
        self.first, carried = self.model.parts.evaluations, 0.0
        self.held_back = 10.0 * self.size / self.model.bearing.radial_clearance
        self.nearest: Place | None = None
        start = self.temperature_of(None if near is None else near.film.history)
        found = self.attempt(motion, start)
        if found is None and near is None and self.thermal is not None:
            carried, found = self.climb(motion)
        guesses = [lambda: motion, lambda: self.loaded(motion, FREE_STEP)]
        if self.model.bearing.is_lobed:
            guesses.append(lambda: self.opposed(motion, start))
        for guess in guesses if carried == 0.0 else ():
            found = found or self.attempt(guess(), start, self.held_back)
        if found is None:
            raise self._not_found(carried * self.size)
        return found

    def attempt(
        self, motion: np.ndarray, temperature: np.ndarray, resistance: float = 0.0, rounds: int = ROUNDS
    ) -> Place | None:
        """Return the film of one search, see `solve`; None if it is not in balance, or too hot for any oil."""
        # round-off of the film's force limits the accuracy under tiny loads
        rounding = np.finfo(float).eps * self.model.bearing.reference_force(motion[8]) / self.size
        tolerance = max(LOAD_TOLERANCE, rounding)
        try:
            found = self.solve(motion, temperature, tolerance, resistance=resistance, rounds=rounds)
        except FilmError as error:
            self.failure = error
            return None
        self.nearest = found
        hot = found.change.size and is_above(HOTTEST, found.temperature)
        return found if self.is_balanced(found, max(tolerance, ROUNDED), SMALL) and not hot else None

    def loaded(self, motion: np.ndarray, ratio: float) -> np.ndarray:
        """Return the motion with the journal moved along the load, by a ``ratio`` of the way from centre to bore."""
        b, motion, direction = self.model.bearing, motion.copy(), self.load[:2] / self.size
        room = max(1.0 - 0.5 * b.length * float(np.hypot(*motion[2:4])) / b.radial_clearance, 0.0)
        motion[:2] = ratio * room * b.radial_clearance * direction
        if b.is_lobed and np.any(direction):
            # without a film the journal would lie at the farthest position along the load with all gaps open
            gaps = gaps_of_arcs(self.model, motion * (np.arange(motion.size) > 1)).min(axis=1) / b.radial_clearance
            found = scipy.optimize.linprog(
                -direction, np.transpose(self.model.grid.directions[:2]), gaps, bounds=(None, None)
            )
            if found.success:
                motion[:2] = ratio * b.radial_clearance * found.x
        return motion

    def opposed(self, motion: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        """Return the motion of `loaded` at which the film's force has the size of the load, by bisection."""
        lower, upper = 0.0, 1.0
        for _ in range(2 * HALVINGS):
            ratio = 0.5 * (lower + upper)
            try:
                wrench = self.at(self.loaded(motion, ratio), temperature).evaluation.wrench
                weak = math.hypot(*wrench[:2]) < self.size
            except FilmError:
                weak = False
            lower, upper = (ratio, upper) if weak else (lower, ratio)
        return self.loaded(motion, lower)

    def climb(self, motion: np.ndarray) -> tuple[float, Place | None]:
        """Find the film by continuation from smaller loads.

        Returns the largest share of the load that was reached, and the film if this is the whole load.
        """
        first = motion.copy()
        first[:2] = first_guess(self.model.bearing, motion[8], FIRST_SHARE * self.load[:2], motion[2:4])

        def reach(share: float, here: Place | None, _: bool) -> Place | None:
            self.share = share
            if here is None:
                return self.attempt(first, self.temperature_of(None), rounds=PATIENCE)
            return self.attempt(here.motion, here.temperature, rounds=PATIENCE)

        share, found = continued(reach, FIRST_SHARE, SMALLEST_SHARE)
        self.share = 1.0
        if found is not None and share < 1.0:
            self.nearest = self.at(found.motion, found.temperature)
        return share, found if share == 1.0 else None

    def _not_found(self, carried: float) -> FilmError:
        """Error for a load that no position carries; ``carried``: largest load reached by `climb`, N."""
        if self.nearest is None:
            return self.failure
        place, b = self.nearest, self.model.bearing
        off, ratio = np.abs(place.unbalance), float(np.hypot(*place.motion[:2])) / b.radial_clearance
        if place.faces is not None and off.argmax() > 1:
            z = place.faces.motion[-1]
            return FilmError(
                f"{self.where}: no axial position found in which the thrust faces carry {self.load[2]:.4g} N; at "
                f"{z:.4g} m their force is {place.faces.wrench[2]:.4g} N. One face carries in one "
                "direction, plane faces no steady load: give them pads that carry (profile=TaperLand(...)), "
                "contact=RegularisedWall(onset=...), or less load."
            )
        if (left := self.residual(place)) <= SMALL and place.change.size:
            return FilmError(
                f"{self.where}: at eccentricity ratio {ratio:.4f} the film carries the load, but its heat finds no "
                f"balance at a temperature that oil bears: it has reached "
                f"{hottest(place.temperature, self.model.grid)}; {WAY_OUT}"
            )
        remedy = (
            "On the way a film has carried more, {:.4g} N at eccentricity ratio {:.4f}.".format(*self.strongest)
            if self.strongest[0] > self.size
            else "A load this high may need asperity=GreenwoodTripp(...) or contact=RegularisedWall(...), or a finer "
            "film grid."
        )
        reason = self._on_an_edge(place) or (
            f"{remedy} A supply area in the loaded zone, a starved film or an arc beside the load may carry no such "
            "load at any position: look at ehd.steady(...) around there."
        )
        return FilmError(
            f"{self.where}: no position found that carries {self.size:.4g} N in {self.count} steps; the nearest is off "
            f"by {left:.2g} of the load, at eccentricity ratio {ratio:.4f}. {reason}"
            f"{too_hot(place.film.temperature, carried)}"
        )

    def _on_an_edge(self, place: Place) -> str:
        """Return why a journal on the edge of an arc is not in balance; empty if it is not on an edge."""
        grid, gaps = self.model.grid, gaps_of_arcs(self.model, place.motion).min(axis=1)
        edges = np.argwhere(grid.edges == gaps.argmin())
        if not edges.size or gaps.min() > CLOSED * self.model.bearing.radial_clearance:
            return ""
        number, end = edges[0]
        return (
            f"The load presses the journal onto the {('leading', 'trailing')[end]} edge of arcs[{number}] at theta = "
            f"{grid.x[gaps.argmin()]:.4g} rad, where the film ends and carries no such load in this sense of rotation. "
            "Let the load point into an arc behind a film that narrows: turn the arcs (angle=...), the spin or the "
            "load, or take contact=RegularisedWall(...)."
        )


class LineSearch(LoadSearch):
    """Search for the position of a journal whose film begins on the line of maximum gap, opposite to the eccentricity.

    In a bearing that is the same in all directions, the film turns with the position. At the eccentricity e in the
    direction phi the force is ``F = R(phi) F_0(e)``, with the rotation R and the force F_0 at the direction x. So all
    films are evaluated at the direction x, with the line fixed on -x, and

        dF/de = R dF_0/de,    dF / (e dphi) = R J F_0 / e,    J: by a right angle,

    are the derivatives along the eccentricity and across it. At the centre both are dF_0/de, the second one turned by
    J.
    """

    def at(self, motion: np.ndarray, temperature: np.ndarray) -> Place:
        """Evaluate the steady film at a motion (11,), with the position turned to the direction x."""
        e, turned = float(np.hypot(*motion[:2])), motion.copy()
        turned[:2] = e, 0.0
        place = super().at(turned, temperature)
        force = place.unbalance - self.share * self.load
        x, y = force / e if e > 0.0 else place.slope[:, 0]
        back = turning(motion)
        place.motion[:2], place.unbalance = motion[:2], self.share * self.load + back @ force
        place.slope = back @ np.column_stack((place.slope[:, 0], (-y, x))) @ back.T
        place.x, place.newton_step = motion[:2], partial(damped_step, -place.slope, place.unbalance)
        return place


def require_turning(bearing: JournalBearing, load: np.ndarray, tilt: np.ndarray) -> None:
    """Raise `InputError` if the film of a bearing with `MaximumGap` does not turn with the journal's position."""
    around = [profile for profile in bearing.profiles if not isinstance(profile, Crown | EdgeRelief | AxialProfile)]
    reasons = {
        "load=(0, 0): the gap is the same all around": not np.any(load),
        f"tilt={tuple(tilt.tolist())!r}": bool(np.any(tilt)),
        f"JournalBearing.cavitation={bearing.cavitation!r}": bearing.cavitation.conserves_mass,
        f"JournalBearing.profile={around[:1]!r}": bool(around),
        "JournalBearing.bush or journal": bearing.yielding is not None,
        f"JournalBearing.end_pressures={bearing.end_pressures!r}": any(bearing.end_pressures),
        "JournalBearing.thrust": bearing.thrust is not None,
    }
    if found := [name for name, given in reasons.items() if given]:
        raise InputError(
            f"equilibrium: inlet=MaximumGap() does not go with {found[0]}. Its line follows the journal, as in design "
            "charts, in a rigid bearing that is the same in all directions, under a load, aligned, with ambient ends "
            "and without ElrodAdams; use inlet=Periodic() with a supply, or steady(...) at a prescribed position."
        )


def turning(motion: np.ndarray) -> np.ndarray:
    """Rotation (2, 2) from the direction x to that of a motion's eccentricity."""
    angle = math.atan2(motion[1], motion[0])
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def first_guess(bearing: JournalBearing, omega: float, force: np.ndarray, tilt: np.ndarray) -> np.ndarray:
    """Initial guess of the eccentricity (2,), m, for a film that carries ``force``.

    Its load combines those of the short and of the long bearing, both half Sommerfeld: s l / (s + l). The eccentricity
    stays within the clearance that the tilt leaves.
    """
    target = float(np.hypot(*force)) / bearing.reference_force(omega)
    ratio = (0.5 * bearing.length / bearing.journal_radius) ** 2
    room = 1.0 - 0.5 * bearing.length * float(np.hypot(*tilt)) / bearing.radial_clearance
    lower, upper = 0.0, 1.0
    for _ in range(40):
        eps = 0.5 * (lower + upper)
        s = 1.0 - eps * eps
        short = ratio * eps / (2.0 * s * s) * math.sqrt(math.pi**2 * s + 16.0 * eps * eps)
        long = 3.0 * eps * math.sqrt(math.pi**2 - eps**2 * (math.pi**2 - 4.0)) / ((2.0 + eps * eps) * s)
        lower, upper = (eps, upper) if short * long / (short + long + 1e-300) < target else (lower, eps)
    eps = lower * max(room, 0.02)
    angle = math.atan2(force[1], force[0]) + math.copysign(
        math.atan2(math.pi * math.sqrt(1.0 - eps * eps), 4.0 * eps), omega
    )
    return eps * bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])


# Eccentricity ratio, in the direction of the load, from which another position is searched. Larger: nearer to a closed
# gap.
LOADED = 0.9
STEADINESS = (
    "has a negative determinant: a journal does not stay there",
    "is not positive definite: the damping decides whether a journal stays",
    "is positive definite",
)


def steadiest(search: LoadSearch, found: Place) -> Place:
    """Return the position found, or a steadier one that carries the load too; a warning lists all that were found.

    A journal stays where the stiffness K is positive definite. It leaves a place where the determinant of K is
    negative, whatever the damping. Other positions are searched for if the determinant is negative. They are also
    searched for if K is not positive definite and supply areas, tilt or a memory of the oil allow several positions.
    Films with a temperature are not checked.

    Parameters
    ----------
    search : LoadSearch
    found : Place
    """
    b = search.model.bearing
    several = bool(b.supply) or search.model.remembers_mass or bool(np.any(found.motion[2:4]))
    steady = _steadiness(found)
    if search.model.effects.thermal is not None or steady == 2 or (steady == 1 and not several):
        return found
    places = [found]
    for ratio in (LOADED, FREE_STEP):
        start = search.loaded(found.motion, ratio)
        if (other := search.attempt(start, found.temperature, search.held_back)) is None:
            continue
        away = min(float(np.hypot(*(other.motion - place.motion)[:2])) for place in places)
        # where the stiffness is nearly singular, a load in balance leaves a position far less accurate
        if away > SMALLEST_GAP_SHARE * b.radial_clearance:
            places.append(other)
    best = max(places, key=_steadiness)
    if len(places) > 1 or _steadiness(best) == 0:
        ratios = [f"{np.hypot(*place.motion[:2]) / b.radial_clearance:.4f}" for place in places]
        warn_user(
            f"{search.where}: the load is carried at the eccentricity ratios {', '.join(ratios)}; returned is "
            f"{ratios[places.index(best)]}, where the stiffness matrix {STEADINESS[_steadiness(best)]}.",
            UserWarning,
        )
    return search.at(best.motion, best.temperature)


def _steadiness(place: Place) -> int:
    """Index in `STEADINESS` of a place."""
    stiffness = -place.slope
    if np.all(np.linalg.eigvalsh(stiffness + stiffness.T) > 0.0):
        return 2
    return int(np.linalg.det(stiffness) > 0.0)
