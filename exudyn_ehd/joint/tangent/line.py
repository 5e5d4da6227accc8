"""A rupture line inside the cells: what its place changes in balances and sums over the film, to the true gap."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.rupture_line import LineGradients, add_line_columns, to_true_gap
from exudyn_ehd.joint.solved_film import MOTION_SIZE, SolvedFilm


def true_line(film: SolvedFilm) -> LineGradients | None:
    """The rupture line's part of the balances' derivatives, to the true gap; None without."""
    return _to_true_gap(film, film.solver.line_gradients())


def true_fills(film: SolvedFilm) -> LineGradients | None:
    """The fills of `FilmSolver.fill_gradients` to the true gap; None without."""
    fills = film.solver.fill_gradients()
    return None if fills is None else _to_true_gap(film, fills[1])


def by_fills(
    film: SolvedFilm, fills: LineGradients, weights: np.ndarray, rows: np.ndarray | None = None, count: int = 1
) -> np.ndarray:
    """Derivatives (10, count) of what the fills are weighed to, by ``weights`` (n, m), to the motion.

    At fixed pressure; ``rows`` (n m,): where each vertex counts, None: all in one sum.
    """
    out, places = np.zeros((MOTION_SIZE, count)), fills.places
    at = np.zeros_like(places) if rows is None else rows[places]
    weighed = fills._replace(rows=at, by=fills.by * weights.reshape(-1)[places])
    add_line_columns(tuple(weighed), film.grid.directions, out)
    return out


def _to_true_gap(film: SolvedFilm, line: LineGradients | None) -> LineGradients | None:
    f = film.limited
    return line if line is None or f is None else to_true_gap(line, f.slope, f.bend, f.face_slope)
