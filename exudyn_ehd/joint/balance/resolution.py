"""Resolution of a film's pressure peak by its grid, estimated from one film.

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
SwiftStieber. From a narrowing of 2.2 on the computed peak is too low. `tests/joint/balance/test_resolution.py` measures
which films cause a warning, and the errors on the grids that it names. The grids of thrust faces and balls are not
judged here; an audit compares a ball's grid with finer ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.joint.solved_film import SolvedFilm
from exudyn_ehd.status import GridWarning, warn_user

# Intervals across the peak below which, and narrowing above which, the error of the peak pressure is above some 5 %: a
# warning. Number of rows from an end up to which the peak counts as next to that end.
FEWEST, STEEPEST, NEAR = 3.2, 2.15, 2
# Properties of the grid that a warning names, with an error of 2 % of the peak pressure: intervals across the peak;
# narrowing less one; stretch of the rows; length of the end interval with this stretch, times n_z over half the length;
# least number of rows.
ENOUGH, GENTLE, STRETCH, END_INTERVAL, FEWEST_ROWS = 6.0, 0.4, 0.95, 0.235, 48
# Narrowing up to which the film counts as even along the bearing, so that its rows are kept. At a limit of 1.15 the
# peak, which lies between two rows, would have an error of up to 4 %.
EVEN = 1.02
# Width of a peak at half its height over the square root of 2 h / h'', for films thinner than a tenth of the clearance.
PEAK_WIDTH = 1.25
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
    near = [end for end, distance in zip(ends, (j, last - j), strict=True) if distance <= NEAR]
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
