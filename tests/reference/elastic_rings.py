"""Elastic rings: a thick cylinder under inner pressure, a thin ring under two opposite forces.

Sources: G. Lamé (1852) for the cylinder, e.g. in Timoshenko and Goodier, Theory of Elasticity, chapter 4; Timoshenko,
Strength of Materials, part II, curved bars, for the ring: bending only, valid for a thickness small against the radius
(at a ratio of 0.2 the shortening is 6 to 7 % larger).
"""

from __future__ import annotations

import math

import numpy as np


def lame_stresses(inner: float, outer: float, pressure: float, r: float) -> tuple[float, float]:
    """Radial and hoop stress in Pa at radius r of a cylinder (radii in m) under inner ``pressure`` (Pa)."""
    factor = pressure * inner**2 / (outer**2 - inner**2)
    return factor * (1.0 - outer**2 / r**2), factor * (1.0 + outer**2 / r**2)


def bore_displacement(
    inner: float, outer: float, pressure: float, youngs_modulus: float, poisson_ratio: float, *, plane_strain: bool
) -> float:
    """Radial displacement of the bore, m.

    Parameters
    ----------
    inner, outer : float
        Radii, m; the outer surface is free.
    pressure, youngs_modulus : float
        Pa.
    poisson_ratio : float
    plane_strain : bool
        False: plane stress (free ends).
    """
    E, nu = youngs_modulus, poisson_ratio
    if plane_strain:
        E, nu = E / (1.0 - nu**2), nu / (1.0 - nu)
    radial, hoop = lame_stresses(inner, outer, pressure, inner)
    return inner / E * (hoop - nu * radial)


def diametral_shortening(force: float, radius: float, bending_stiffness: float) -> float:
    """Shortening in m of the diameter along the forces.

    Parameters
    ----------
    force : float
        N (or N/m, per length).
    radius : float
        Mean radius, m.
    bending_stiffness : float
        E I in N m2 (or N m, per length: E t^3 / 12).
    """
    return (math.pi / 4.0 - 2.0 / math.pi) * force * radius**3 / bending_stiffness


def diametral_lengthening(force: float, radius: float, bending_stiffness: float) -> float:
    """Lengthening in m of the diameter across the forces; arguments as in `diametral_shortening`."""
    return (2.0 / math.pi - 0.5) * force * radius**3 / bending_stiffness


def moment_under_load(force: float, radius: float) -> float:
    """Bending moment under the force, Nm (or N)."""
    return force * radius / math.pi


def cylinder_yielding(n: int, inner: float, outer: float, poisson_ratio: float) -> float:
    """Radial displacement of a cylinder's outer surface under a pressure p cos(n theta) on it, over p outer / E.

    Inwards, in plane strain, with a free bore; ``inner`` = 0 is a solid cylinder, which for n > 1 gives

        (1 + nu) [n / (2 (n - 1)) + (kappa - n - 1) / (2 (n + 1))],   kappa = 3 - 4 nu,

    and (1 + nu) (1 - 2 nu) for n = 0. From the terms of J. H. Michell's stress function in r^n, r^(n+2), r^-n, r^(2-n)
    that leave both surfaces without shear (Barber, Elasticity, table 8.1 and 9.1); n = 1 is no balance of forces.

    Parameters
    ----------
    n : int
        0, or 2 and more.
    inner, outer : float
        Radii, m.
    poisson_ratio : float
    """
    nu, kappa = poisson_ratio, 3.0 - 4.0 * poisson_ratio
    ratio = inner / outer
    if n == 0:
        return (1.0 + nu) * (1.0 - 2.0 * nu + ratio**2) / (1.0 - ratio**2)
    if inner == 0.0:
        return (1.0 + nu) * (0.5 * n / (n - 1.0) + 0.5 * (kappa - n - 1.0) / (n + 1.0))
    # powers of r over the outer radius, which are 1 on it; those that fall are scaled by the inner radius
    powers = np.array([n, n + 2, -n, 2 - n])
    at_bore = ratio ** np.array([n - 2.0, n, 0.0, 0.0])
    at_rim = ratio ** np.array([0.0, 0.0, n + 2.0, n])
    normal, shear = powers - n**2.0, n * (powers - 1.0)
    rows = np.array([normal * at_bore, shear * at_bore, normal * at_rim, shear * at_rim])
    amounts = np.linalg.solve(rows, [0.0, 0.0, -1.0, 0.0])
    displaced = np.array([-n, kappa - n - 1.0, n, kappa + n - 1.0]) * at_rim
    return float(-(1.0 + nu) * displaced @ amounts)
