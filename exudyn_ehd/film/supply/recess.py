"""Shear of the oil in supply areas: flow that returns within a recess.

Between the sliding surface at y = d, the recess's depth, and its bottom at y = 0 the oil that the surface takes along
comes back, as the lands beside let far less of it through. Laminar flow with no net flow, ``int u dy = 0``, is

    u = U (3 y^2 / d^2 - 2 y / d),      tau = mu du/dy = 4 mu U / d at the surface.

The bottom is pulled backwards by 2 mu U / d. The pressure that drives the flow back, dp/dx = 6 mu U / d^2, presses on
the recess's end walls by 6 mu U / d per area: together the side with the recess gets 4 mu U / d in the direction of U,
what the other one loses. This pressure rises by 6 mu U l / d^2 over the length l, which the supply's uniform pressure
leaves out. The side walls brake in addition, which the equation does not count. A circumferential groove has no end
walls. If it were wide against its depth, its oil would turn with mu U / d; at the usual widths of two to three depths
the side walls make some three times that of it. It has the same law.

Turbulent: by Hirs' bulk flow the stress on a wall is ``n rho u^2 / 2 (rho u d / mu)^m`` with the wall's speed u against
the mean flow. In a recess the mean flow rests, so that u = U at the sliding surface,

    tau = n / 2 Re^(1 + m) mu U / d,      Re = rho |U| d / mu,

with n = 0.066, m = -0.25. It acts where it is larger than the laminar stress, above Re = 600. As in a turbulent film, U
is the sliding about the axis alone.

The oil has the viscosity of its temperature, without pressure and without thinning: its shear rate is small.

Sources: W. B. Rowe, Hydrostatic, Aerostatic and Hybrid Bearing Design (2012), for the laminar stress; G. G. Hirs, J.
Lubrication Technology 95 (1973) 137, for the law of turbulent walls; J. N. Shinkle and K. G. Hornung, J. Basic
Engineering 87 (1965) 163, for turbulent recesses without net flow.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.reynolds.turbulence import Hirs

# tau over mu U / d of the laminar flow.
RECIRCULATION = 4.0


class RecessShear(NamedTuple):
    """Shear in recesses at the vertices, in units of that between concentric surfaces.

    density : (n, m) array, scaled area times shear
    by_spin : (n, m) array, its derivative to the journal's relative spin, s/rad
    """

    density: np.ndarray
    by_spin: np.ndarray


def recess_shear(
    depths: list[float | None],
    parts: list[np.ndarray],
    clearance: float,
    spin: float,
    oil: tuple[np.ndarray, np.ndarray],
) -> RecessShear | None:
    """Shear in the areas that have a depth; None without any.

    Parameters
    ----------
    depths : list of float or None
        Of every area, m; None: deep.
    parts : list of (n, m) arrays
        Scaled area of every one at the vertices.
    clearance, spin : float
        m, rad/s.
    oil : two arrays
        Viscosity over the reference, and Reynolds number per depth and spin, s/(m rad); floats or (n, m).
    """
    viscosity, per_depth = oil
    found = [(depth, part) for depth, part in zip(depths, parts, strict=True) if depth is not None]
    if not found:
        return None
    law = Hirs()
    power = 1.0 + law.exponent
    out = RecessShear(*np.zeros((2, *parts[0].shape)))
    for depth, part in found:
        turbulent = 0.5 * law.coefficient * (per_depth * depth * abs(spin)) ** power
        laminar = turbulent <= RECIRCULATION
        sheared = clearance / depth * viscosity * part
        out.density[:] += sheared * np.maximum(RECIRCULATION, turbulent)
        out.by_spin[:] += sheared * np.where(laminar, 0.0, power * turbulent / (spin or 1.0))
    return out
