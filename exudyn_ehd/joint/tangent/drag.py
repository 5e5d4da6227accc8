"""Drag of a pressure gradient on unequally rough surfaces, of a bearing model; see `exudyn_ehd.film.loads`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.loads import drag_gap_slopes, drag_pose_gradient, drag_rhs, drag_sums
from exudyn_ehd.film.reynolds.gap import contract_pose

if TYPE_CHECKING:
    from exudyn_ehd.film.reynolds.links import LinkFlux
    from exudyn_ehd.film.solvers.compliant import CompliantFilmSolver
    from exudyn_ehd.joint.model.rigid import BearingModel


def drag_integrals(model: BearingModel) -> tuple[float, float]:
    """E_x and E_z of the last solution."""
    f, g = _flux(model), model.grid
    return drag_sums(model.P, f.cx, model.solver.HF, f.cz, f.gap_z, g.width_x, g.width_z, g.link_x, g.link_z)


def add_drag_rows(model: BearingModel, rows: np.ndarray) -> None:
    """Add the weights of the unknown pressures in E_x and E_z to ``rows`` (2, count)."""
    f, g, w = _flux(model), model.grid, model.solver.work
    drag_rhs(
        w.order, w.count, w.active, f.cx, model.solver.HF, f.cz, f.gap_z, g.width_x, g.width_z, g.link_x, g.link_z, rows
    )


def drag_by_gap(model: BearingModel) -> tuple[np.ndarray, np.ndarray]:
    """Gradients at fixed pressure to the true gap: of E_x on the links i -> i+1 (1, n, m), of E_x and E_z at the vertices (2, n, m).

    On a liner: to the gap of the undeformed surfaces, whose contact follows.
    """
    limited, film, ones = model.limited, model.compliant, model.solver.ones
    if film is None:
        slope, face_slope = (ones, ones) if limited is None else (limited.slope, limited.face_slope)
        face, cell = _slopes(model, slope, face_slope)
        return face[None], np.stack((np.zeros_like(cell), cell))
    c = film.columns
    face, cell = _slopes(model, ones, c.link)
    return face[None], np.stack((_ends(face) * c.D_r, cell * c.H_r))


def add_drag_by_pose(model: BearingModel, gradient: np.ndarray) -> None:
    """Add the gradients of E_x and E_z at fixed pressure to the scaled pose to ``gradient`` (2, 10)."""
    if model.compliant is not None:
        face, cell = drag_by_gap(model)
        contract_pose(face, model.cos_f, model.sin_f, model.grid.z, gradient[:1, :4])
        contract_pose(cell[1:], model.cos_x, model.sin_x, model.grid.z, gradient[1:, :4])
        contract_pose(cell[:1], model.cos_x, model.sin_x, model.grid.z, gradient[:1, :4])
        return
    f, g, ones, limited = _flux(model), model.grid, model.solver.ones, model.limited
    slope, face_slope = (ones, ones) if limited is None else (limited.slope, limited.face_slope)
    drag_pose_gradient(
        model.P, f.cx_h, f.cz_h, slope, face_slope, g.width_x, g.width_z, g.link_x, g.link_z, model.cos_x, model.sin_x,
        model.cos_f, model.sin_f, g.z, gradient,
    )  # fmt: skip


def drag_by_deflection(model: BearingModel, film: CompliantFilmSolver) -> np.ndarray:
    """Gradients (2, n, m) of E_x and E_z to the unknown pressures through the gap that a liner leaves them."""
    face, cell = _slopes(model, film.ones, film.columns.link)
    return np.stack((_ends(face) * film.deflection_by_pressure, cell * film.gap_by_pressure))


def _slopes(model: BearingModel, slope: np.ndarray, face_slope: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gradients of E_x on the links i -> i+1 and of E_z at the vertices (n, m), times the gaps' slopes there."""
    f, g = _flux(model), model.grid
    face, cell = np.empty(g.shape), np.empty(g.shape)
    drag_gap_slopes(model.P, f.cx_h, f.cz_h, slope, face_slope, g.width_x, g.width_z, g.link_x, g.link_z, face, cell)
    return face, cell


def _ends(face: np.ndarray) -> np.ndarray:
    """Half of what stands on the links i -> i+1 (n, m) at either of their ends."""
    return 0.5 * (face + np.roll(face, 1, axis=0))


def _flux(model: BearingModel) -> LinkFlux:
    flux = model.solver.flux
    assert flux is not None
    return flux
