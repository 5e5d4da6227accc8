"""Derivatives of balances and of sums over the film to the true gap, by a rupture line inside the cells."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.rupture_line import LineGradients, add_line_columns, to_true_gap
from exudyn_ehd.film.solvers.film import at_beside_ends
from exudyn_ehd.joint.solved_film import MOTION_SIZE, SolvedFilm


def true_line(film: SolvedFilm) -> LineGradients | None:
    """The rupture line's part of the balances' derivatives, to the true gap; None without."""
    return _to_true_gap(film, film.solver.line_gradients())


def true_fills(film: SolvedFilm) -> LineGradients | None:
    """The fills of `FilmSolver.fill_gradients` to the true gap; None without."""
    fills = film.solver.fill_gradients()
    return None if fills is None else _to_true_gap(film, fills[1])


def weigh_fills(fills: LineGradients, weights: np.ndarray, rows: np.ndarray | None = None) -> LineGradients:
    """Gradients of the fills' sums with ``weights`` (n, m), at fixed pressure.

    ``rows`` (n m,): row to which every vertex contributes; None: one sum over all.
    """
    places = fills.places
    at = np.zeros_like(places) if rows is None else rows[places]
    return fills._replace(rows=at, by=fills.by * weights.reshape(-1)[places])


def line_by_motion(film: SolvedFilm, line: LineGradients, count: int) -> np.ndarray:
    """Derivatives (10, count) of the rows of a line to the motion."""
    out = np.zeros((MOTION_SIZE, count))
    add_line_columns(tuple(line), film.grid.directions, out)
    return out


def _to_true_gap(film: SolvedFilm, line: LineGradients | None) -> LineGradients | None:
    f = film.limited
    return line if line is None or f is None else to_true_gap(line, f.slope, f.bend, f.face_slope)


def shear_of_fills(film: SolvedFilm) -> np.ndarray:
    """Couette shear (n, m) that comes with the fill of every vertex."""
    return ratio_of(film) * film.grid.shear_weight / film.solver.H + shear_of_ends(film)


def shear_of_ends(film: SolvedFilm) -> np.ndarray:
    """Density of the ends' shear at the vertices beside them (n, m), where they share their fill."""
    return at_beside_ends(film.solver.system, ratio_of(film) * film.grid.shear_weight / film.solver.H)


def ratio_of(film: SolvedFilm) -> np.ndarray:
    """Viscosity ratio (n, m) that shear sees."""
    return film.solver.ones if film.oil.ratio is None else film.oil.ratio
