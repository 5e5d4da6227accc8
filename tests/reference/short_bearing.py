"""Short journal bearing (no pressure flow in the circumference) with the half Sommerfeld condition.

Sources: F. W. Ocvirk, NACA TN 2808 (1952), for load and attitude; stiffness and damping follow by differentiation of
the force with the rates of the journal,

    f_r = (mu R L^3 / c^2) [(omega - 2 phi') eps^2 / s^2 + pi (1 + 2 eps^2) eps' / (2 s^(5/2))],         s = 1 - eps^2,
    f_t = (mu R L^3 / c^2) [(omega - 2 phi') pi eps / (4 s^(3/2)) + 2 eps eps' / s^2],

f_r against the eccentricity, f_t in the direction of rotation, phi' the precession of the line of centres. (Cavitated
region of the pure rotation: exact to first order in the rates, because the pressure vanishes on its edge.)
"""

from __future__ import annotations

import math

Matrix = tuple[tuple[float, float], tuple[float, float]]


def load(eps: float, length_to_diameter: float) -> float:
    """Sommerfeld number."""
    s = 1.0 - eps**2
    return length_to_diameter**2 * eps / (2.0 * s**2) * math.sqrt(math.pi**2 * s + 16.0 * eps**2)


def attitude(eps: float) -> float:
    """Attitude angle, rad."""
    return math.atan2(math.pi * math.sqrt(1.0 - eps**2), 4.0 * eps)


def _along_load(rr: float, rt: float, tr: float, tt: float, eps: float) -> Matrix:
    """Matrix from (radial, tangential) axes to x along the load, y ahead in the rotation; divided by the load."""
    phi, size = attitude(eps), load(eps, 1.0) / 2.0
    cos, sin = math.cos(phi), math.sin(phi)
    xx = rr * cos**2 - (rt + tr) * sin * cos + tt * sin**2
    xy = (rr - tt) * sin * cos + rt * cos**2 - tr * sin**2
    yx = (rr - tt) * sin * cos + tr * cos**2 - rt * sin**2
    yy = rr * sin**2 + (rt + tr) * sin * cos + tt * cos**2
    return (xx / size, xy / size), (yx / size, yy / size)


def stiffness(eps: float) -> Matrix:
    """``K c / W``, x along the load, y 90 degrees ahead in the sense of rotation; 0 < eps < 1."""
    s = 1.0 - eps**2
    radial = eps / s**2
    tangential = math.pi / (4.0 * s**1.5)
    radial_slope = 2.0 * eps * (1.0 + eps**2) / s**3
    tangential_slope = math.pi * (1.0 + 2.0 * eps**2) / (4.0 * s**2.5)
    return _along_load(radial_slope, tangential, -tangential_slope, radial, eps)


def damping(eps: float) -> Matrix:
    """``C c omega / W``, axes as in `stiffness`; 0 < eps < 1."""
    s = 1.0 - eps**2
    rr = math.pi * (1.0 + 2.0 * eps**2) / (2.0 * s**2.5)
    rt = -2.0 * eps / s**2
    return _along_load(rr, rt, rt, math.pi / (2.0 * s**1.5), eps)


def whirl_threshold(eps: float) -> tuple[float, float]:
    """Whirl ratio and ``M c omega^2 / W`` of a rigid rotor at the threshold of stability; (0, inf) if always stable.

    ``s = i gamma omega`` in ``det(M s^2 + C s + K) = 0``: the imaginary part gives ``M gamma^2 = k``, the real part
    gamma.
    """
    (kxx, kxy), (kyx, kyy) = stiffness(eps)
    (cxx, cxy), (cyx, cyy) = damping(eps)
    k = (kxx * cyy + kyy * cxx - kxy * cyx - kyx * cxy) / (cxx + cyy)
    square = ((k - kxx) * (k - kyy) - kxy * kyx) / (cxx * cyy - cxy * cyx)
    return (math.sqrt(square), k / square) if square > 0.0 else (0.0, math.inf)


def squeeze_force(eps: float, *, cavitated: bool) -> float:
    """``F c^2 / (mu R L^3 d(eps)/dt)`` of a journal that moves along its eccentricity, towards the wall if eps > 0.

    The integral of ``cos^2 / (1 - eps cos)^3`` over the whole circumference, or over the closing half (``cavitated``).

    Parameters
    ----------
    eps : float
        -1 < eps < 1; negative if the journal moves towards the centre.
    cavitated : bool
        Only the closing half of the film carries pressure.
    """
    s = 1.0 - eps**2
    if not cavitated:
        return math.pi * (1.0 + 2.0 * eps**2) / s**2.5
    return (1.0 + 2.0 * eps**2) * math.acos(-eps) / s**2.5 + 3.0 * eps / s**2
