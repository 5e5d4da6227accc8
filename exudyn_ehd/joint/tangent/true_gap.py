"""Derivatives to the true gap: drag of a pressure gradient, and balances and sums at a rupture line in cells.

Surfaces share the drag of a pressure gradient unevenly if their roughness differs, and where a limiter leaves the film
another gap than the surfaces have; see `exudyn_ehd.film.surfaces.patir_cheng`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.gradients import Gradients, join
from exudyn_ehd.film.reynolds.links import on_links, to_ends
from exudyn_ehd.film.solvers.film import at_beside_ends
from exudyn_ehd.film.solvers.liner.film import LinerFilm
from exudyn_ehd.film.surfaces import patir_cheng
from exudyn_ehd.joint.solved_film import FilmParts, LimiterFields, SolvedFilm


def pulls_unevenly(parts: FilmParts, limited: LimiterFields | None) -> bool:
    """Return whether a pressure gradient pulls either surface by other than half its force on the true gap."""
    return parts.uneven_drag or limited is not None or (parts.liner is not None and parts.liner.limited)


def drag_weights(parts: FilmParts, limited: LimiterFields | None) -> np.ndarray:
    """Weights (2, n, m) of the pressures in E_x and E_z of the film that ``parts.solver`` holds."""
    s, liner = parts.solver, parts.liner
    gap, link = s.H, s.HF
    if limited is not None:
        gap, link = limited.gap, limited.link
    elif liner is not None and liner.limited:
        gap, link = liner.true_gap, liner.true_link
    carriers = (s.HF, on_links(s.H)[1])
    if parts.uneven_drag and s.flux is not None:
        carriers = s.flux.cx, s.flux.cz
    return patir_cheng.drag_weights(carriers, gap, link, parts.grid.link_widths)


def drag_by_gap(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients at fixed pressure to the true gap.

    Of E_x on the links i -> i+1 (1, n, m), of E_z at the vertices (1, n, m). On a liner, to the gap of the undeformed
    surfaces, whose contact follows: of E_x and E_z at the vertices (2, n, m).
    """
    face, cell = _slopes(film)
    if film.parts.liner is None:
        return face[None], cell[None]
    deflection = film.parts.liner.gap_slopes.D_r
    return face[None], np.stack((to_ends(face, 0) * deflection, cell * (1.0 + deflection)))


def add_drag_by_pose(film: SolvedFilm, gradient: np.ndarray) -> None:
    """Add the gradients of E_x and E_z at fixed pressure to the scaled pose to ``gradient`` (2, 10)."""
    face, cell = drag_by_gap(film)
    gradient[:1, :4] += film.grid.by_pose(face, 1)
    gradient[-len(cell) :, :4] += film.grid.by_pose(cell)


def drag_by_deflection(film: SolvedFilm, liner: LinerFilm) -> np.ndarray:
    """Gradients (2, n, m) of E_x and E_z to the unknown pressures through the gap that a liner leaves them."""
    face, cell = _slopes(film)
    return np.stack((to_ends(face, 0), cell)) * liner.deflection_by_pressure


def _slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients to the true gap, of E_x on the links i -> i+1 and of E_z at the vertices (n, m)."""
    ones, flux, limited, liner = film.solver.ones, film.solver.flux, film.limited, film.parts.liner
    slope, face_slope = (ones, ones) if limited is None else (limited.slope, limited.face_slope)
    if liner is not None:
        slope, face_slope = liner.gap_slopes.rate_t, liner.gap_slopes.link
    carriers = (ones, ones) if flux is None else (flux.cx_h, flux.cz_h)
    return patir_cheng.drag_by_gap(film.oil.P, carriers, slope, face_slope, film.grid.link_widths)


def true_gradients(film: SolvedFilm) -> Gradients:
    """`FilmAnswers.gradients` to the true gap, with the balances of supply areas with an unknown pressure behind.

    These are sums over the balances at their vertices.
    """
    s, found = film.solver, _to_true_gap(film, film.solver.gradients())
    if (r := s.reservoirs) is None:
        return found
    flows = _to_true_gap(film, s.gradients(r.at))
    rows, entries = np.nonzero(r.within().T[:, flows.rows])
    by = flows.by[:, entries] * r.weights()[rows]
    return join(found, Gradients(s.work.count + rows, flows.places[entries], by))


def true_fills(film: SolvedFilm) -> Gradients | None:
    """The fills of `FilmSolver.fill_gradients` to the true gap; None without."""
    fills = film.solver.fill_gradients()
    return None if fills is None else _to_true_gap(film, fills[1])


def _to_true_gap(film: SolvedFilm, gradients: Gradients) -> Gradients:
    f = film.limited
    return gradients if f is None else gradients.to_true_gap(f.slope, f.bend, f.face_slope)


def shear_of_fills(film: SolvedFilm) -> np.ndarray:
    """Couette shear (n, m) that comes with the fill of every vertex."""
    return ratio_of(film) * film.grid.shear_weight / film.solver.H + shear_of_ends(film)


def shear_of_ends(film: SolvedFilm) -> np.ndarray:
    """Density of the ends' shear at the vertices beside them (n, m), where they share their fill."""
    return at_beside_ends(film.solver.system, ratio_of(film) * film.grid.shear_weight / film.solver.H)


def ratio_of(film: SolvedFilm) -> np.ndarray:
    """Viscosity ratio (n, m) that shear sees."""
    return film.solver.ones if film.oil.ratio is None else film.oil.ratio
