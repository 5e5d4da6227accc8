"""Drag of a pressure gradient on unequally rough surfaces, and its derivatives; see `exudyn_ehd.film.loads`."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.loads import drag_gap_slopes, drag_pose_gradient, drag_rhs, drag_sums
from exudyn_ehd.film.reynolds.gap import contract_pose
from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.nonlinear import NonlinearFilmSolver
from exudyn_ehd.joint.solved_film import FilmParts, SolvedFilm


def drag_integrals(parts: FilmParts, P: np.ndarray) -> tuple[float, float]:
    """E_x and E_z of the film that ``parts.solver`` holds, with its pressure P (n, m)."""
    f = _flux(parts.solver)
    return drag_sums(P, f.cx, f.gap_x, f.cz, f.gap_z, parts.grid.mesh)


def add_drag_rows(film: SolvedFilm, rows: np.ndarray) -> None:
    """Add the weights of the unknown pressures in E_x and E_z to ``rows`` (2, count)."""
    f, w = _flux(film.solver), film.solver.work
    drag_rhs(w.order, w.count, w.active, f.cx, f.gap_x, f.cz, f.gap_z, film.grid.mesh, rows)


def drag_by_gap(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients at fixed pressure to the true gap.

    Of E_x on the links i -> i+1 (1, n, m), of E_x and E_z at the vertices (2, n, m).

    On a liner: to the gap of the undeformed surfaces, whose contact follows.
    """
    if film.parts.liner is None:
        face, cell = _slopes(film, *_gap_slopes(film))
        return face[None], np.stack((np.zeros_like(cell), cell))
    c = film.parts.liner.gap_slopes
    face, cell = _slopes(film, film.solver.ones, c.link)
    return face[None], np.stack((_ends(face) * c.D_r, cell * c.H_r))


def add_drag_by_pose(film: SolvedFilm, gradient: np.ndarray) -> None:
    """Add the gradients of E_x and E_z at fixed pressure to the scaled pose to ``gradient`` (2, 10)."""
    p, g = film.parts, film.grid
    if p.liner is not None:
        face, cell = drag_by_gap(film)
        contract_pose(face, p.directions.cos_f, p.directions.sin_f, g.z, gradient[:1, :4])
        contract_pose(cell[1:], p.directions.cos_x, p.directions.sin_x, g.z, gradient[1:, :4])
        contract_pose(cell[:1], p.directions.cos_x, p.directions.sin_x, g.z, gradient[:1, :4])
        return
    f = _flux(film.solver)
    drag_pose_gradient(film.oil.P, f.cx_h, f.cz_h, *_gap_slopes(film), g.mesh, g.directions, gradient)


def drag_by_deflection(film: SolvedFilm, liner: NonlinearFilmSolver) -> np.ndarray:
    """Gradients (2, n, m) of E_x and E_z to the unknown pressures through the gap that a liner leaves them."""
    face, cell = _slopes(film, liner.ones, liner.gap_slopes.link)
    return np.stack((_ends(face) * liner.deflection_by_pressure, cell * liner.gap_by_pressure))


def _gap_slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """d(film gap)/d(true gap) at the vertices and on the links i -> i+1 of a rigid bore."""
    ones, limited = film.solver.ones, film.limited
    return (ones, ones) if limited is None else (limited.slope, limited.face_slope)


def _slopes(film: SolvedFilm, slope: np.ndarray, face_slope: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gradients of E_x on the links i -> i+1 and of E_z at the vertices (n, m), times the gaps' slopes there."""
    f, g = _flux(film.solver), film.grid
    face, cell = np.empty(g.shape), np.empty(g.shape)
    drag_gap_slopes(film.oil.P, f.cx_h, f.cz_h, slope, face_slope, g.mesh, face, cell)
    return face, cell


def _ends(face: np.ndarray) -> np.ndarray:
    """Half of what stands on the links i -> i+1 (n, m) at either of their ends."""
    return 0.5 * (face + np.roll(face, 1, axis=0))


def _flux(solver: FilmSolver) -> LinkFlux:
    assert solver.flux is not None
    return solver.flux
