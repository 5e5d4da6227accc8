"""Drag of a pressure gradient on surfaces that share it unevenly, and its derivatives; see `exudyn_ehd.film.loads`.

Of unequal roughness, and where a limiter leaves the film another gap than the surfaces have.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.loads import drag_gap_slopes, drag_pose_gradient, drag_rhs, drag_sums
from exudyn_ehd.film.reynolds.gap import contract_pose
from exudyn_ehd.film.solvers.nonlinear import NonlinearFilmSolver
from exudyn_ehd.film.surfaces.closed_gap import closed_pose_gradient, closed_rhs, closed_sums
from exudyn_ehd.joint.solved_film import FilmParts, LimiterFields, SolvedFilm


def pulls_unevenly(parts: FilmParts, limited: LimiterFields | None) -> bool:
    """Whether a pressure gradient pulls the surfaces of this film by other than half of it on the true gap."""
    return parts.uneven_drag or limited is not None or (parts.liner is not None and parts.liner.limited)


def drag_integrals(parts: FilmParts, limited: LimiterFields | None, P: np.ndarray) -> tuple[float, float]:
    """E_x and E_z of the film that ``parts.solver`` holds, with its pressure P (n, m)."""
    f, mesh, closed = parts.solver.flux, parts.grid.mesh, _closed_gaps(parts, limited)
    along = across = 0.0
    if parts.uneven_drag and f is not None:
        along, across = drag_sums(P, f.cx, f.gap_x, f.cz, f.gap_z, mesh)
    if closed is None:
        return along, across
    x, z = closed_sums(P, *closed, mesh)
    return along + x, across + z


def add_drag_rows(film: SolvedFilm, rows: np.ndarray) -> None:
    """Add the weights of the unknown pressures in E_x and E_z to ``rows`` (2, count)."""
    w, f, mesh, closed = film.solver.work, film.solver.flux, film.grid.mesh, _closed_gaps(film.parts, film.limited)
    if film.parts.uneven_drag and f is not None:
        drag_rhs(w.order, w.count, w.active, f.cx, f.gap_x, f.cz, f.gap_z, mesh, rows)
    if closed is not None:
        closed_rhs(w.order, w.count, w.active, *closed, mesh, rows)


def drag_by_gap(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients at fixed pressure to the true gap.

    Of E_x on the links i -> i+1 (1, n, m), of E_x and E_z at the vertices (2, n, m).

    On a liner: to the gap of the undeformed surfaces, whose contact follows.
    """
    face, cell = _slopes(film)
    if film.parts.liner is None:
        return face[None], np.stack((np.zeros_like(cell), cell))
    deflection = film.parts.liner.gap_slopes.D_r
    return face[None], np.stack((_ends(face) * deflection, cell * (1.0 + deflection)))


def add_drag_by_pose(film: SolvedFilm, gradient: np.ndarray) -> None:
    """Add the gradients of E_x and E_z at fixed pressure to the scaled pose to ``gradient`` (2, 10)."""
    p, g = film.parts, film.grid
    if p.liner is not None:
        face, cell = drag_by_gap(film)
        contract_pose(face, p.directions.cos_f, p.directions.sin_f, g.z, gradient[:1, :4])
        contract_pose(cell[1:], p.directions.cos_x, p.directions.sin_x, g.z, gradient[1:, :4])
        contract_pose(cell[:1], p.directions.cos_x, p.directions.sin_x, g.z, gradient[:1, :4])
        return
    drag_pose_gradient(film.oil.P, *_carrier_slopes(film), *_gap_slopes(film), g.mesh, g.directions, gradient)


def add_closed_by_pose(
    film: SolvedFilm, limited: LimiterFields, couette: np.ndarray, dc: np.ndarray, drag: np.ndarray
) -> None:
    """As `add_drag_by_pose` for a limited film of even carriers, to ``drag`` (2, 10); and to ``dc`` (10,) that of C.

    ``couette`` (n, m) is dC/d(film gap).
    """
    g = film.grid
    closed_pose_gradient(film.oil.P, limited.slope, limited.face_slope, couette, g.mesh, g.directions, dc, drag)


def drag_by_deflection(film: SolvedFilm, liner: NonlinearFilmSolver) -> np.ndarray:
    """Gradients (2, n, m) of E_x and E_z to the unknown pressures through the gap that a liner leaves them."""
    face, cell = _slopes(film)
    return np.stack((_ends(face), cell)) * liner.deflection_by_pressure


def _closed_gaps(parts: FilmParts, limited: LimiterFields | None) -> tuple[np.ndarray, ...] | None:
    """Film's and true gap at the vertices, and on the links i -> i+1; None where they are the same."""
    s, liner = parts.solver, parts.liner
    if limited is not None:
        return s.H, limited.gap, s.HF, limited.link
    if liner is not None and liner.limited:
        return s.H, liner.true_gap, s.HF, liner.true_link
    return None


def _carrier_slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """d(carrier)/d(film gap) of the links in theta and z."""
    f, ones = film.solver.flux, film.solver.ones
    return (ones, ones) if f is None else (f.cx_h, f.cz_h)


def _gap_slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """d(film gap)/d(true gap) at the vertices and on the links i -> i+1."""
    ones, limited, liner = film.solver.ones, film.limited, film.parts.liner
    if liner is not None:
        return liner.gap_slopes.rate_t, liner.gap_slopes.link
    return (ones, ones) if limited is None else (limited.slope, limited.face_slope)


def _slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients to the true gap, of E_x on the links i -> i+1 and of E_z at the vertices (n, m)."""
    g = film.grid
    face, cell = np.empty(g.shape), np.empty(g.shape)
    drag_gap_slopes(film.oil.P, *_carrier_slopes(film), *_gap_slopes(film), g.mesh, face, cell)
    return face, cell


def _ends(face: np.ndarray) -> np.ndarray:
    """Half of what stands on the links i -> i+1 (n, m) at either of their ends."""
    return 0.5 * (face + np.roll(face, 1, axis=0))
