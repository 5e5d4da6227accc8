"""Resolution of a film's pressure peak by its grid, seen from the film alone.

Around, the width of the peak at half its height decides: with ``columns`` intervals across it the peak pressure of an
aligned journal is off by up to ``0.5 / columns^2``, according to where it lies between two columns (measured at L/D
0.25 to 2, minimum film thickness 0.005 to 0.5 of the clearance, from two intervals on).

Along, the film of a tilted journal grows from its end, and the pressure rises by ``int dz / h^3``, most of it where the
film is less than twice as thick as on the end. The film thickness one interval before the end over that on the end,
``narrowing``, decides where the peak lies next to that end:

=========  ===  ===  ====  ====  ====  ====
narrowing  1.5  2.2  3     4.5   7     17
error, %   5    7    25    45    45    65
=========  ===  ===  ====  ====  ====  ====

Largest errors of the peak pressure on 10 intervals of ``stretch=0.75``, of seeded random films of rigid bearings with
SwiftStieber. The peak is too low from 2.2 on. `tests/joint/balance/test_resolution.py` measures who is warned, and what
the named grids are worth. Thrust faces and balls have grids of their own, which nothing here judges; an audit compares
a ball's with finer ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.joint.solved_film import SolvedFilm
from exudyn_ehd.status import GridWarning, warn_user

# Intervals across the peak around below which, and narrowing from which on, the peak pressure is off by some 5 %; rows
# from an end up to which a peak is that end's.
FEWEST, STEEPEST, NEAR = 3.2, 2.15, 2
# Properties of a wanted grid, whose peak pressure is off by 2 %: intervals across the peak; narrowing less one; stretch
# of the rows, whose end intervals are then 0.235 / n_z of half the length; least number of rows.
ENOUGH, GENTLE, STRETCH, END_INTERVAL, FEWEST_ROWS = 6.0, 0.4, 0.95, 0.235, 48
# Narrowing up to which the film is even along the bearing; from 1.15 on its crest between two rows costs up to 4 %.
EVEN = 1.02
# Width of a peak at half its height over the square root of 2 h / h'', for films thinner than a tenth of the clearance.
PEAK_WIDTH = 1.25
# Sizes from which on a wanted grid takes seconds for one film.
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
        A grid whose peak pressure is off by 2 %; None where it would be too large, or for another film model.
    """

    columns: float
    rows: float
    narrowing: float
    growth: float
    wanted: FiniteLength | None

    @property
    def is_coarse(self) -> bool:
        """Return whether the peak pressure may be off by more than 5 %."""
        return self.columns < FEWEST or self.narrowing > STEEPEST


def resolution(film: SolvedFilm) -> Resolution:
    """Resolution of the pressure peak of a solved film."""
    lower, upper = film.grid.seals or (None, None)
    rows = slice(int(lower is not None), film.grid.z.size - int(upper is not None))  # none outside of seals
    P, H, z = film.oil.P[:, rows], film.solver.H[:, rows], film.grid.z[rows]
    n, last = P.shape[0], P.shape[1] - 1
    i, j = divmod(int(P.argmax()), last + 1)
    columns = intervals_at_half(np.roll(P[:, j], n // 2 - i), n // 2)
    places = int(H[:, 0].argmin()), int(H[:, last].argmin())
    ends = [
        (float(H[k, row + way] / H[k, row]), k, row, abs(float(z[row + way] - z[row])))
        for k, row, way in ((places[0], 0, 1), (places[1], last, -1))
    ]
    near = [end for end, distance in zip(ends, (j, last - j), strict=True) if distance <= NEAR]
    steepest = max(near, default=(1.0, i, j, 1.0))
    return Resolution(
        columns, intervals_at_half(P[i], j), steepest[0], max(end[0] for end in ends), _wanted(film, columns, *steepest)
    )


def _wanted(
    film: SolvedFilm, across: float, narrowing: float, k: int, row: int, interval: float
) -> FiniteLength | None:
    """Grid that resolves a peak of some intervals across, next to the thinnest film (k, row) of an end."""
    own, ring, (n, _), H = film.parts.bearing.sized_film, film.parts.bearing.columns, film.grid.shape, film.solver.H
    if not isinstance(own, FiniteLength):
        return None
    rows, stretch = own.n_z, own.stretch
    if narrowing > EVEN:
        needed = END_INTERVAL * film.parts.half_length / interval * (narrowing - 1.0) / GENTLE
        rows, stretch = max(rows, FEWEST_ROWS, 2 * math.ceil(0.5 * needed)), STRETCH
        bend = float(H[(k + 1) % n, row] - 2.0 * H[k, row] + H[k - 1, row])
        if bend > 0.0:
            across = min(across, PEAK_WIDTH * math.sqrt(2.0 * H[k, row] / bend))
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
    """Return whether a film has a grid that a warning can name, and carries more than its contact does."""
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
