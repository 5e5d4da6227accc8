"""Drag of a pressure gradient on unequally rough surfaces, of a bearing model; see `exudyn_ehd.film.drag`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.drag import drag_gap_slopes, drag_pose_gradient, drag_rhs, drag_sums

if TYPE_CHECKING:
    from exudyn_ehd.film.flux import LinkFlux
    from exudyn_ehd.joint.model import BearingModel


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
    """Gradients at fixed pressure to the true gap: of E_x on the links i -> i+1 and of E_z at the vertices, both (1, n, m)."""
    face, cell = np.empty((1, *model.grid.shape)), np.empty((1, *model.grid.shape))
    drag_gap_slopes(*_slopes(model), face[0], cell[0])
    return face, cell


def add_drag_by_pose(model: BearingModel, gradient: np.ndarray) -> None:
    """Add the gradients of E_x and E_z at fixed pressure to the scaled pose to ``gradient`` (2, 10)."""
    drag_pose_gradient(
        *_slopes(model), model.cos_x, model.sin_x, model.cos_f, model.sin_f, model.grid.z, gradient
    )  # fmt: skip


def _slopes(model: BearingModel) -> tuple[np.ndarray, ...]:
    """What `drag_gap_slopes` reads."""
    f, g, limited = _flux(model), model.grid, model.limited
    ones = model.solver.ones
    slope, face_slope = (ones, ones) if limited is None else (limited.slope, limited.face_slope)
    return model.P, f.cx_h, f.cz_h, slope, face_slope, g.width_x, g.width_z, g.link_x, g.link_z


def _flux(model: BearingModel) -> LinkFlux:
    flux = model.solver.flux
    assert flux is not None
    return flux
