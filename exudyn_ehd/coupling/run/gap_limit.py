"""Newton's method kept within the films.

Exudyn's Newton method takes its steps whole. A film hardens towards the wall as 1 / gap^3 and more, and where it is
hollow, or opens, it has hardly any stiffness: a step from there goes through the wall, where the film can't be
evaluated or pushes back with 1e12 N, and the time step is halved for no fault of its own. From the thin side Newton's
method converges step by step, from the thick side it overshoots. None of its steps may therefore close more than half
of a film (the fraction to the boundary of interior point methods). With the ends of the journal's axis at p, moved by
d, and the gap g = c - max |p| before, the part s of the step that is taken holds

    |p + s d| <= c - g / 2,   s = (sqrt((p d)^2 + d^2 ((c - g / 2)^2 - p^2)) - p d) / d^2,

the smallest s of all films and ends. Coordinates, velocities and accelerations satisfy Newmark's formulas one by one,
after a part of a step too: the solution stays what it is. Rotations of Lie groups don't add up, and keep their step.
Films thinner than a thousandth of the clearance, on a contact, are left alone. Flexible bores are judged as undeformed:
a journal that presses into one is free beyond the clearance, and on the way there the steps are a few more or fewer.

With a pressure law a film has another end: velocities v of the journal's axis at which no finite pressure carries it.
The law's line behind that end is flatter than the law in front of it, so that Newton's method may jump from one side to
the other and back for ever. Where it was behind the end, at v_b, and has come back to v, a step goes no more than half
of the way there, d (v_b - v) <= |v_b - v|^2 / 2: a bisection, until Newton's method converges.
"""

from __future__ import annotations

import math
from collections.abc import Collection

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import CURRENT, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics.bore_gap import BoreGap
from exudyn_ehd.coupling.record.history import eccentricity_ratios
from exudyn_ehd.coupling.watch.step_control import SMALLEST_GAP_SHARE
from exudyn_ehd.status import Status

# Share of a film's gap that a step of Newton's method may close.
SHARE = 0.5


class GapLimit:
    """Takes back what a step of Newton's method closes too much.

    Parameters
    ----------
    films : collection of FilmElement
        Elements of all joints of a system.
    """

    def __init__(self, films: Collection[FilmElement]) -> None:
        self.films = films
        self.bores = {film: BoreGap(film.model.bearing) for film in films}
        self.before: list[np.ndarray] = []
        # last motions behind the end of the films' pressure laws
        self.behind: dict[FilmElement, np.ndarray] = {}

    def start(self, mbs: exu.MainSystem) -> None:
        """Remember where Newton's method starts."""
        self.before = [values.copy() for values in _state(mbs)]
        self.behind.clear()

    def shorten(self, mbs: exu.MainSystem, additive: np.ndarray) -> None:
        """Shorten the step that Newton's method has taken, where it closes a film by more than `SHARE`.

        Parameters
        ----------
        mbs : exudyn.MainSystem
            Holds the state after the step.
        additive : (n,) array
            Zero at the coordinates that keep their step, one elsewhere.
        """
        part = 1.0
        for film in self.films:
            last = film.last
            if last is not None:
                bearing = film.model.bearing
                bore, after = self.bores[film], film.peek(mbs)
                if bore.depth.size:
                    allowed = _allowed_in_profile(bore, last.bodies, after)
                else:
                    allowed = allowed_part(last.bodies, after, bearing.radial_clearance, bearing.length)
                part = min(part, allowed, self._allowed_at_end(film, last, after))
        state = _state(mbs)
        if part < 1.0:
            taken = np.where(additive, part, 1.0)
            for share, old, new in zip((taken, taken, taken, part), self.before, state, strict=True):
                # from the old values: the new ones of a step of any size would round them away
                new[:] = np.where(share == 1.0, new, old + share * (new - old))
        for old, new in zip(self.before, state, strict=True):
            old[:] = new

    def _allowed_at_end(self, film: FilmElement, last: Trial, after: np.ndarray) -> float:
        """Part of a step from in front of the end of a film's law that goes half of the way back behind it."""
        bearing = film.model.bearing
        if last.status == Status.NO_PRESSURE and bearing.yielding is None:
            self.behind[film] = last.bodies
        elif film in self.behind:
            half = 0.5 * bearing.length
            levers = np.array(getattr(bearing, "levers", (1.0, 1.0, half, half)))
            return _allowed_towards(self.behind[film], last.bodies, after, levers)
        return 1.0


def allowed_part(before: np.ndarray, after: np.ndarray, clearance: float, length: float) -> float:
    """Part of a step between two motions that closes the film of the rigid surfaces by `SHARE`, 1 if none does.

    Parameters
    ----------
    before, after : (10,) array
        Motion of the journal's axis, m and rad first.
    clearance, length : float
        m.
    """
    gap = clearance * (1.0 - eccentricity_ratios(before, clearance, length)[1])
    farthest = clearance - SHARE * gap
    # not true for what is not finite
    if not gap > SMALLEST_GAP_SHARE * clearance:
        return 1.0
    if not clearance * eccentricity_ratios(after, clearance, length)[1] > farthest:
        return 1.0
    part = 1.0
    for z in (-0.5 * length, 0.5 * length):
        p, d = before[:2] + z * before[2:4], after[:2] - before[:2] + z * (after[2:4] - before[2:4])
        along, square, rest = float(p @ d), float(d @ d), farthest * farthest - float(p @ p)
        if 2.0 * along + square > rest:
            part = min(part, (math.sqrt(along * along + square * rest) - along) / square)
    return part


def _allowed_in_profile(bore: BoreGap, before: np.ndarray, after: np.ndarray) -> float:
    """As `allowed_part` in a bore with profiles, whose gaps are linear in the journal's place."""
    gaps, ends = bore.values(before), bore.values(after)
    smallest = float(gaps.min())
    if not (smallest > SMALLEST_GAP_SHARE * bore.clearance and np.isfinite(ends).all()):
        return 1.0
    beyond = ends < SHARE * smallest
    return float(np.min((gaps - SHARE * smallest)[beyond] / (gaps - ends)[beyond], initial=1.0))


def _allowed_towards(other: np.ndarray, before: np.ndarray, after: np.ndarray, levers: np.ndarray) -> float:
    """Part of a step between two motions that goes half of the way to the velocities of a third one, 1 if none does."""
    way, step = levers * (other - before)[4:8], levers * (after - before)[4:8]
    half, along = 0.5 * float(way @ way), float(way @ step)
    return half / along if along > half else 1.0


def _state(mbs: exu.MainSystem) -> list[np.ndarray]:
    """Coordinates, velocities, accelerations and multipliers, as Exudyn holds them."""
    state = mbs.systemData.GetSystemStateDict(CURRENT, True)
    return [state[name] for name in ("ODE2Coords", "ODE2Coords_t", "ODE2Coords_tt", "AECoords")]
