"""Drag of a pressure gradient on surfaces that share it unevenly, and its derivatives.

Of unequal roughness, and where a limiter leaves the film another gap than the surfaces have; see
`exudyn_ehd.film.surfaces.drag`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.reynolds.gap import contract_pose
from exudyn_ehd.film.solvers.liner.film import LinerFilm
from exudyn_ehd.film.surfaces.drag import drag_gap_slopes, drag_pose_gradient, drag_rhs, drag_sums
from exudyn_ehd.joint.solved_film import FilmParts, LimiterFields, SolvedFilm


def pulls_unevenly(parts: FilmParts, limited: LimiterFields | None) -> bool:
    """Return whether a pressure gradient pulls either surface by other than half its force on the true gap."""
    return parts.uneven_drag or limited is not None or (parts.liner is not None and parts.liner.limited)


def drag_integrals(parts: FilmParts, limited: LimiterFields | None, P: np.ndarray) -> tuple[float, float]:
    """(E_x, E_z) of the film that ``parts.solver`` holds, at the pressures P (n, m)."""
    return drag_sums(P, _gaps(parts, limited), parts.grid.mesh)


def add_drag_rows(film: SolvedFilm, rows: np.ndarray) -> None:
    """Add the weights of E_x and E_z at the unknown pressures, their gaps fixed, to rows (2, count)."""
    w = film.solver.work
    drag_rhs(w.order, w.count, w.active, _gaps(film.parts, film.limited), film.grid.mesh, rows)


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
    g, at = film.grid, film.parts.directions
    if film.parts.liner is None:
        drag_pose_gradient(film.oil.P, *_carrier_slopes(film), *_gap_slopes(film), g.mesh, g.directions, gradient)
        return
    face, cell = drag_by_gap(film)
    contract_pose(face, at.cos_f, at.sin_f, g.z, gradient[:1, :4])
    contract_pose(cell, at.cos_x, at.sin_x, g.z, gradient[:, :4])


def drag_by_deflection(film: SolvedFilm, liner: LinerFilm) -> np.ndarray:
    """Gradients (2, n, m) of E_x and E_z to the unknown pressures through the gap that a liner leaves them."""
    face, cell = _slopes(film)
    return np.stack((_ends(face), cell)) * liner.deflection_by_pressure


def _gaps(parts: FilmParts, limited: LimiterFields | None) -> tuple[object, ...]:
    """Carriers, film's gaps and true gaps that ``parts.solver`` holds, as `link_excess` takes them."""
    s, liner = parts.solver, parts.liner
    gap, link = s.H, s.HF
    if limited is not None:
        gap, link = limited.gap, limited.link
    elif liner is not None and liner.limited:
        gap, link = liner.true_gap, liner.true_link
    carriers = (s.flux.cx, s.flux.cz) if parts.uneven_drag and s.flux is not None else None
    return carriers, s.H, s.HF, gap, link


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
