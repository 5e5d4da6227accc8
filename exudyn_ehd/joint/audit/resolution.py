"""Resolution of a film by its grid, and by the time steps of a run.

Grid: the pressure peak, estimated from one film
------------------------------------------------
Around the bore, the width of the peak at half its height decides. With ``columns`` intervals across this width, the
relative error of the peak pressure of an aligned journal is up to ``0.5 / columns^2``; it depends on where the peak
lies between two columns. This was measured at L/D 0.25 to 2 and a minimum film thickness of 0.005 to 0.5 of the
clearance, for two and more intervals.

Along the bearing, the film of a tilted journal grows from its end. The pressure rises by ``int dz / h^3``, mostly where
the film is less than twice as thick as on the end. If the peak lies next to that end, its error depends on
``narrowing``, the film thickness one interval before the end over that on the end:

=========  ===  ===  ====  ====  ====  ====
narrowing  1.5  2.2  3     4.5   7     17
error, %   5    7    25    45    45    65
=========  ===  ===  ====  ====  ====  ====

Largest errors of the peak pressure on 10 intervals of ``stretch=0.75``, of seeded random films of rigid bearings with
SwiftStieber. From a narrowing of 2.2 on the computed peak is too low. `tests/joint/audit/test_resolution.py` measures
which films cause a warning, and the errors on the grids that it names. The grids of thrust faces and balls are not
judged here; an audit compares a ball's grid with finer ones.

Time steps: integration that rings, recognised from the accepted steps of a joint
---------------------------------------------------------------------------------
The deviation of a force is d_k = F_k - L_k, where L_k is the value at t_k of the line through the forces of the steps
k - 1 and k + 1. An alternation F = F_0 + (-1)^k A has d_k = 2 (-1)^k A. An oscillation with n steps per period has
d_k = (1 - cos(2 pi / n)) times its value. So d changes its sign from step to step only below some three steps per
period, and such oscillations are not resolved by the steps. A force *zigzags* at a step if d there points against d of
the steps before and after it, and is more than a tenth of the force.

Zigzags alone are no fault: after a sudden start generalized alpha damps the alternation within some steps. In a run
that rings, alternations are excited again and again: by halved steps, by Newton's method that accepts forces next to
the solution, by impacts within a single step. So *bursts* are counted. A burst is a zigzag stronger than those of the
five steps before it, or an alternation that does not fade, which counts once in `RingingWatch.lasting` zigzags.

Masses move by the mean of the force over the steps. By Newmark's formulas, and those of generalized alpha, positions
depend on ``F_k - d_k / 2``, which in equal steps is the mean with the weights (1, 2, 1) / 4. An alternation adds
nothing to this mean; it changes accelerations only. A force that is many times its mean *throws* the masses to and fro
within the steps. Oscillations with three or more steps per period, and a single impact, have a mean of at least a
fourth of the force.
"""

from __future__ import annotations

import math
import warnings
from collections import deque
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.grid import LARGEST_STRETCH
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.joint.solved_film import SolvedFilm
from exudyn_ehd.status import SMALL, GridWarning, RingingWarning, warn_user

# Intervals across the peak below which, and narrowing above which, the error of the peak pressure is above some 5 %: a
# warning.
FEWEST, STEEPEST = 3.2, 2.15
# Factor by which the error on a grid that a warning names is smaller: 2 % of the peak pressure, with a margin. It falls
# with the square of the intervals across the peak, and with the narrowing less one. Larger: finer grids.
FINER = 3.5
ENOUGH = FEWEST * math.sqrt(FINER)
# Least number of rows of that grid, with `LARGEST_STRETCH`: errors of 4 % on 24, and of up to 15 % without this limit.
FEWEST_ROWS = 48
# Largest grid that a warning names. Beyond it one film takes seconds.
MOST_COLUMNS, MOST_ROWS = 2000, 200


class Resolution(NamedTuple):
    """Resolution of a pressure peak by the grid.

    Attributes
    ----------
    columns, rows : float
        Intervals across the peak at half its height, around and along.
    narrowing : float
        Film thickness one interval before the end next to the peak over that on the end; 1 for a peak away from ends.
    growth : float
        The larger such ratio of both ends, wherever the peak lies.
    wanted : FiniteLength or None
        Grid with an error of 2 % of the peak pressure; None if it would be too large, or for another film model.
    """

    columns: float
    rows: float
    narrowing: float
    growth: float
    wanted: FiniteLength | None

    @property
    def is_coarse(self) -> bool:
        """Return whether the error of the peak pressure may exceed 5 %."""
        return self.columns < FEWEST or self.narrowing > STEEPEST


def resolution(film: SolvedFilm) -> Resolution:
    """Resolution of the pressure peak of a solved film."""
    lower, upper = film.grid.seals or (None, None)
    rows = slice(int(lower is not None), film.grid.z.size - int(upper is not None))  # without rows outside of seals
    P, H, z = film.oil.P[:, rows], film.solver.H[:, rows], film.grid.z[rows]
    n, last = P.shape[0], P.shape[1] - 1
    i, j = divmod(int(P.argmax()), last + 1)
    columns = intervals_at_half(np.roll(P[:, j], n // 2 - i), n // 2)
    places = int(H[:, 0].argmin()), int(H[:, last].argmin())
    ends = [
        (float(H[k, row + way] / H[k, row]), k, row, abs(float(z[row + way] - z[row])))
        for k, row, way in ((places[0], 0, 1), (places[1], last, -1))
    ]
    # the peak is next to an end if the pressure one interval before the end is above half of it
    near = [end for end, row in zip(ends, (1, last - 1), strict=True) if P[i, row] > 0.5 * P[i, j]]
    steepest = max(near, default=(1.0, i, j, 1.0))
    return Resolution(
        columns, intervals_at_half(P[i], j), steepest[0], max(end[0] for end in ends), _wanted(film, columns, *steepest)
    )


def _wanted(
    film: SolvedFilm, across: float, narrowing: float, k: int, row: int, interval: float
) -> FiniteLength | None:
    """Grid that resolves a peak which now spans ``across`` intervals.

    (k, row) is the vertex with the thinnest film of an end, ``interval`` the scaled length of the interval before it.
    """
    own, ring, (n, _), H = film.parts.bearing.sized_film, film.parts.bearing.columns, film.grid.shape, film.solver.H
    if not isinstance(own, FiniteLength):
        return None
    rows, stretch = own.n_z, own.stretch
    if narrowing > 1.0 + SMALL:  # a film that is even along the bearing keeps its rows
        # half the length over n_z, times this number, is the end interval with the stretch
        last = math.pi * LARGEST_STRETCH / math.tan(0.5 * math.pi * LARGEST_STRETCH)
        needed = last * film.parts.half_length / interval * FINER * (narrowing - 1.0) / (STEEPEST - 1.0)
        rows, stretch = max(rows, FEWEST_ROWS, 2 * math.ceil(0.5 * needed)), LARGEST_STRETCH
        bend = float(H[(k + 1) % n, row] - 2.0 * H[k, row] + H[k - 1, row])
        if bend > 0.0:
            # length over which a thin film grows to twice its thickness; the peak is up to a quarter wider
            across = min(across, math.sqrt(2.0 * H[k, row] / bend))
    columns = max(ring, 8 * math.ceil(ENOUGH * ring / (8.0 * max(across, 1e-3))))
    if columns > MOST_COLUMNS or rows > MOST_ROWS:
        return None
    return FiniteLength(n_theta=columns, n_z=rows, stretch=stretch)


def coarse_film(found: Resolution, where: str) -> str:
    """Return the message for a film whose pressure peak the grid does not resolve; it begins with ``where``."""
    thin = (
        "a grid that resolves a film this thin takes seconds for each evaluation: check the journal's position, or "
        "model how surfaces behave that nearly touch (asperity=, contact=, a bush)"
    )
    grid = found.wanted
    advice = thin if grid is None else f"take film={grid!r}"
    return (
        f"{where}: the grid does not resolve the film's pressure peak, whose pressure may be off by more than 5 %: "
        f"around the bore the peak spans {found.columns:.2g} intervals at half its height (it needs {FEWEST:g}), and "
        f"one interval before the bearing's end the film is {found.narrowing:.2g} times as thick as at the end (up to "
        f"{STEEPEST:g} is resolved); {advice}."
    )


def is_judged(film: SolvedFilm) -> bool:
    """Return whether a film has a `FiniteLength` grid, and its contact carries at most half of the load."""
    contact = 0.0 if film.pressing is None else np.hypot(*film.pressing.integrals[:, :2].sum(axis=0))
    carried = math.hypot(*film.loads.wrench[:2]) / film.grid.reference_length**2
    return isinstance(film.parts.bearing.film, FiniteLength) and bool(contact <= 0.5 * carried)


def warn_of_grid(film: SolvedFilm, where: str) -> bool:
    """Warn in the name of ``where`` of a film whose peak the grid does not resolve; return whether it is one."""
    if not is_judged(film) or not (found := resolution(film)).is_coarse:
        return False
    warn_user(coarse_film(found, where), GridWarning)
    return True


def intervals_at_half(values: np.ndarray, peak: int) -> float:
    """Intervals between the points on both sides of ``peak`` where ``values`` (n,) fall to half of it, interpolated."""
    half = 0.5 * float(values[peak])
    if not half > 0.0:
        return float(values.size)
    width = 0.0
    for side in (values[peak::-1], values[peak:]):
        below = np.flatnonzero(side < half)
        if below.size == 0:
            width += side.size - 1.0
            continue
        k = int(below[0])
        width += k - float((half - side[k]) / (side[k - 1] - side[k]))
    return width


# Least size of d in a zigzag: over the force there, and over the largest force of some `WINDOW` steps before it.
# Larger: weaker alternations are ignored.
LOCAL_SHARE, LARGEST_SHARE = 0.1, 0.01
# Least component of the neighbouring d against d, over d. Larger: only even alternations count as zigzags.
EVEN_ALTERNATION = 0.3
# Mean pressure on the projected area, Pa, below which d is ignored as round-off next to an ideal joint.
NEGLIGIBLE = 100.0
# Least strength of a burst over that of the five steps before, in which no burst may lie; an alternation that has not
# fallen by this factor lasts. Larger: fewer bursts are counted.
STRONGER = 1.5
# Number of steps in which bursts are counted together, and number of bursts in it from which on a run rings.
WINDOW, LIMIT = 100, 4
# Pressure on the projected area, Pa, below which a force throws no masses. Those that do have a mean of less than
# `LOCAL_SHARE` of them, and are more than this share of the largest force. A run that rings ends at
# `RingingWatch.lasting` such forces within the window.
HEAVY = 1e6


class RingingWatch:
    """Counter of the bursts of one joint's force; it takes some microseconds per step.

    Parameters
    ----------
    area : float
        Projected area of the bearing, 2 R L, m2.

    Attributes
    ----------
    most : int
        Most bursts within `WINDOW` steps.
    lasting : int
        Zigzags after which an alternation that lasts is another burst: more than `LIMIT` bursts lie in the window then.
    first, last : float
        Times of the first and the last burst, s; nan without one.
    worst : (float, float)
        Largest force that throws masses, and its mean, N.
    """

    def __init__(self, area: float) -> None:
        self.smallest, self.heavy, self.lasting = NEGLIGIBLE * area, HEAVY * area, WINDOW // (LIMIT + 1)
        self.begin_anew()

    def begin_anew(self) -> None:
        """Forget all steps."""
        self.most = 0
        self.first = self.last = math.nan
        # time and force of the last steps; the last eight d with their sizes
        self._states: deque[tuple[float, float, float, float]] = deque(maxlen=4)
        self._bends: deque[tuple[float, float, float, float]] = deque([(0.0, 0.0, 0.0, 0.0)] * 8, maxlen=8)
        self._bursts: list[int] = []
        self._throws: deque[int] = deque([-WINDOW] * self.lasting, maxlen=self.lasting)
        self.worst = (0.0, 0.0)
        self._step = self._zigzags = 0
        self._largest = self._strength = 0.0

    def take(self, time: float, x: float, y: float, z: float = 0.0) -> bool:
        """Add an accepted step.

        Parameters
        ----------
        time : float
            s; a time that is not later than the previous one resets the counter.
        x, y, z : float
            Force, N; z of a ball.

        Returns
        -------
        bool
            True if this step is a burst and `LIMIT` or more bursts lie in the window.
        """
        if self._states and not time > self._states[-1][0]:
            self.begin_anew()
        states = self._states
        states.append((time, x, y, z))
        self._step += 1
        self._largest = max(math.hypot(x, y, z), self._largest - self._largest / WINDOW)
        if len(states) < 3:
            return False
        (t_2, x_2, y_2, z_2), (t_1, x_1, y_1, z_1) = states[-3], states[-2]
        share = (t_1 - t_2) / (time - t_2)
        dx, dy, dz = x_1 - x_2 - share * (x - x_2), y_1 - y_2 - share * (y - y_2), z_1 - z_2 - share * (z - z_2)
        self._bends.append((dx, dy, dz, math.hypot(dx, dy, dz)))
        force = math.hypot(x_1, y_1, z_1)
        if force > self.heavy and force > LOCAL_SHARE * self._largest:
            mean = math.hypot(x_1 - 0.5 * dx, y_1 - 0.5 * dy, z_1 - 0.5 * dz)
            if mean < LOCAL_SHARE * force:
                self._throws.append(self._step)
                self.worst = max(self.worst, (force, mean))
        if not self._zigzag():
            return False
        self._zigzags += 1
        return self._is_burst() and self._count(t_1)

    def _zigzag(self) -> bool:
        (ax, ay, az, _), (bx, by, bz, b), (cx, cy, cz, _) = list(self._bends)[-3:]
        against = max(ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz)
        if not b > max(self.smallest, LARGEST_SHARE * self._largest) or against > -EVEN_ALTERNATION * b * b:
            return False
        force = sum(math.hypot(x, y, z) for _, x, y, z in list(self._states)[:3]) / 3.0
        return b > LOCAL_SHARE * force

    def _is_burst(self) -> bool:
        *before, a, b, c = (bend[3] for bend in self._bends)
        if self._bursts and self._step - self._bursts[-1] < len(before):
            return False
        strength = max(a, b, c)
        lasting = self._zigzags >= self.lasting and STRONGER * strength > self._strength
        if not (lasting or strength > STRONGER * max(before)):
            return False
        self._strength = strength
        return True

    def _count(self, time: float) -> bool:
        self._zigzags = 0
        self._bursts = [step for step in self._bursts if step > self._step - WINDOW] + [self._step]
        self.most = max(self.most, len(self._bursts))
        self.first = time if math.isnan(self.first) else self.first
        self.last = time
        return len(self._bursts) >= LIMIT

    @property
    def throws(self) -> bool:
        """Return whether the run rings and `lasting` forces within the window have thrown masses."""
        return self.most >= LIMIT and self._throws[0] > self._step - WINDOW


def watched(time: np.ndarray, force: np.ndarray, area: float) -> RingingWatch:
    """Watch after all steps of a record: times (n,) in s and forces (n, 2) or (n, 3) in N on an area in m2."""
    watch = RingingWatch(area)
    for t, parts in zip(time.tolist(), force.tolist(), strict=True):
        watch.take(t, *parts)
    return watch


def warn_of_ringing(name: str, watch: RingingWatch, *, starts_well: bool) -> None:
    """Warn that the run of the joint ``name`` rings.

    ``starts_well``: this package gives Newton's method its initial guess, so that `SolveDynamic` is not advised.
    """
    start = "" if starts_well else "use ehd.SolveDynamic(mbs, simulationSettings) in place of mbs.SolveDynamic, or "
    warnings.warn(
        f"LubricatedJoint '{name}': from t = {watch.first:.9g} s to {watch.last:.9g} s the film's force alternates "
        f"from step to step, thrown anew {watch.most} times within {WINDOW} steps: the time integration causes these "
        f"forces and pressures; {start}take more steps until none is halved, or a smaller spectral "
        "radius.",
        RingingWarning,
        stacklevel=2,
    )
