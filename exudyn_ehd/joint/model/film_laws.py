"""Laws of the oil on a solved film: its pressure, and the viscosity ratio that shear sees."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.status import Status

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.rigid import BearingModel


def apply_laws(model: BearingModel) -> Status:
    """Pressure of ``model`` from the transformed one; viscosity ratio at the vertices with its derivatives to q, H and vx.

    NO_PRESSURE where the solution has no pressure, else CONVERGED.
    """
    s, shape = model.solver, model.grid.shape
    model.P = s.pressure
    if model.effects.pressure_law is None and model.effects.shear_factor is not None:
        if model.ratio is None or model.ratio_h is None or model.ratio_v is None:
            model.ratio, model.ratio_h, model.ratio_v = np.empty(shape), np.empty(shape), np.empty(shape)
        model.effects.shear_factor.factor(s.H, s.vx, model.ratio, model.ratio_h, model.ratio_v)
        return Status.CONVERGED
    if (
        model.compressible is not None
        and model.compressible.law.viscosity is None
        and model.effects.shear_factor is None
    ):
        model.P, model.P_q = np.empty(shape), np.empty(shape)
        found = model.compressible.pressure_of_solution(model.P, model.P_q)
        return Status.CONVERGED if found else Status.NO_PRESSURE
    ratio, ratio_q = np.empty(shape), np.empty(shape)
    ratio_h = ratio_v = s.nothing
    model.P_q = None
    if model.compressible is not None:
        model.P, model.P_q = np.empty(shape), np.empty(shape)
        if not model.compressible.viscosity(model.P, ratio, ratio_q, model.P_q):
            return Status.NO_PRESSURE
    elif model.effects.pressure_law is not None:
        model.P = np.empty(shape)
        if not model.effects.pressure_law.inverse(s.pressure * model.pressure_scale, model.P, ratio, ratio_q):
            return Status.NO_PRESSURE
        model.P /= model.pressure_scale
        ratio_q *= model.pressure_scale
        model.P_q = ratio
    if model.effects.shear_factor is not None:
        factor, ratio_h, ratio_v = np.empty(shape), np.empty(shape), np.empty(shape)
        model.effects.shear_factor.factor(s.H, s.vx, factor, ratio_h, ratio_v)
        if model.P_q is not None:
            ratio_h *= ratio
            ratio_v *= ratio
            ratio_q *= factor
            factor *= ratio
        ratio = factor
    model.ratio, model.ratio_q, model.ratio_h, model.ratio_v = ratio, ratio_q, ratio_h, ratio_v
    return Status.CONVERGED
