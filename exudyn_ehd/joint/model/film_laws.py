"""Laws of the oil on a solved film: its pressure, and the viscosity ratio that shear sees."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.joint.seams import Effects
from exudyn_ehd.joint.solved_film import FilmParts, OilFields


def oil_fields(parts: FilmParts, effects: Effects, pressure_scale: float) -> OilFields | None:
    """Pressure and viscosity ratio of the film that ``parts.solver`` holds; None where its solution has no pressure.

    ``pressure_scale`` in Pa.
    """
    s, film, shape = parts.solver, parts.compressible, parts.grid.shape
    law, shear = effects.pressure_law, effects.shear_factor
    if law is None and shear is None:
        return OilFields(s.pressure)
    if law is None and shear is not None:
        ratio, ratio_h, ratio_v = np.empty(shape), np.empty(shape), np.empty(shape)
        shear.factor(s.H, s.vx, ratio, ratio_h, ratio_v)
        return OilFields(s.pressure, ratio=ratio, ratio_h=ratio_h, ratio_v=ratio_v)
    P, ratio, ratio_q = np.empty(shape), np.empty(shape), np.empty(shape)
    P_q = ratio
    if film is not None:
        P_q = np.empty(shape)
        if film.law is not None and film.law.viscosity is None and shear is None:
            return OilFields(P, P_q) if film.pressure_of_solution(P, P_q) else None
        if not film.viscosity(P, ratio, ratio_q, P_q):
            return None
    elif law is not None:
        if not law.inverse(s.pressure * pressure_scale, P, ratio, ratio_q):
            return None
        P /= pressure_scale
        ratio_q *= pressure_scale
    if shear is None:
        return OilFields(P, P_q, ratio, ratio_q, s.nothing, s.nothing)
    factor, ratio_h, ratio_v = np.empty(shape), np.empty(shape), np.empty(shape)
    shear.factor(s.H, s.vx, factor, ratio_h, ratio_v)
    ratio_h *= ratio
    ratio_v *= ratio
    ratio_q *= factor
    return OilFields(P, P_q, factor * ratio, ratio_q, ratio_h, ratio_v)
