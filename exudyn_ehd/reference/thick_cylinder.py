"""Thick-walled cylinder under inner pressure: G. Lame (1852); e.g. Timoshenko and Goodier, Theory of Elasticity, chapter 4."""

from __future__ import annotations


def stresses(inner: float, outer: float, pressure: float, r: float) -> tuple[float, float]:
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
    radial, hoop = stresses(inner, outer, pressure, inner)
    return inner / E * (hoop - nu * radial)
