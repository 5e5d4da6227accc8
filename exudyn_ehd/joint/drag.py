"""Drag of a pressure gradient on unequally rough surfaces.

Between rough surfaces the relative speed V of the journal (1) carries ``V/2 (h_T + sigma phi_s)`` in the bore's (2) frame. Stokes flow is
reciprocal (H. A. Lorentz): with the wall force as flux of V and the volume flow as flux of the pressure gradient, the cross terms are each
other's opposite, since together they neither dissipate nor produce anything. So a pressure gradient pulls the surfaces, shear and pressure on
their slopes together, by

    f_1 = -(h_T + sigma phi_s) / 2 dp/dx,        f_2 = -(h_T - sigma phi_s) / 2 dp/dx        per area,

the rougher one more; the sum is what the pressure does on the film's cross section, whatever phi_s. With one surface smooth the force on it
is its shear alone: ``phi_fp h = h_T - sigma Phi_s`` of Patir and Cheng. Here stands what departs from equal shares, ``-+ sigma phi_s / 2 dp/ds``
in both directions, summed over the links as the carriers' part of the flow is, so that work and heat match link by link.

Scaled: ``E_x = sum (carrier - gap) (P_i - P_i+1) width``, its torque on the journal is 6 mu R^4 / c E_x, its axial force 6 mu R^3 / c E_z.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from exudyn_ehd.film.flux import LinkFlux
    from exudyn_ehd.joint.model import BearingModel


def drag_integrals(model: BearingModel) -> tuple[float, float]:
    """E_x and E_z of the last solution."""
    along, across = _carried(model)
    P = model.P
    drop_x = np.sum(along * (P - np.roll(P, -1, axis=0)))
    return float(drop_x), float(np.sum(across * (P[:, :-1] - P[:, 1:])))


def drag_weights(model: BearingModel) -> np.ndarray:
    """Weights (2, n, m) of the vertices' pressures in E_x and E_z."""
    along, across = _carried(model)
    out = np.zeros((2, *along.shape))
    out[0] = along - np.roll(along, 1, axis=0)
    out[1, :, :-1] = across
    out[1, :, 1:] -= across
    return out


def drag_by_gap(model: BearingModel) -> tuple[np.ndarray, np.ndarray]:
    """Gradients of E_x and E_z at fixed pressure to the true gap at the vertices and on the links i -> i+1, both (2, n, m)."""
    flux, P, f = _flux(model), model.P, model.limiter_fields
    cell, face = np.zeros((2, *P.shape)), np.zeros((2, *P.shape))
    face[0] = (flux.cx_h - 1.0) * _width_x(model) * (P - np.roll(P, -1, axis=0))
    half = 0.5 * (flux.cz_h[:, :-1] - 1.0) * _width_z(model) * (P[:, :-1] - P[:, 1:])
    cell[1, :, :-1] = half
    cell[1, :, 1:] += half
    if f is not None:
        cell *= f.slope
        face *= f.face_slope
    return cell, face


def _carried(model: BearingModel) -> tuple[np.ndarray, np.ndarray]:
    """sigma phi_s times the links' widths in theta (n, m) and in z (n, m - 1)."""
    flux = _flux(model)
    along = (flux.cx - model.solver.HF) * _width_x(model)
    return along, (flux.cz - flux.gap_z)[:, :-1] * _width_z(model)


def _width_x(model: BearingModel) -> np.ndarray:
    """Widths of the links in theta (n, m); zero where there is none."""
    return np.outer(model.grid.link_x != 0.0, model.grid.width_z)


def _width_z(model: BearingModel) -> np.ndarray:
    """Widths of the links in z (n, m - 1); zero where there is none."""
    return np.outer(model.grid.width_x, model.grid.link_z != 0.0)


def _flux(model: BearingModel) -> LinkFlux:
    flux = model.solver.flux
    assert flux is not None
    return flux
