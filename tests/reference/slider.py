"""One-dimensional films between plane and conical surfaces: integrals of the Reynolds equation."""

from __future__ import annotations

import math


def plane_slider_pressure(
    viscosity: float, speed: float, length: float, inlet: float, outlet: float, x: float
) -> float:
    """Pressure in Pa of a plane slider of infinite width, ``h = inlet + (outlet - inlet) x / length``.

    ``p = 6 mu U L (h1 - h)(h - h2) / ((h1^2 - h2^2) h^2)`` for inlet h1 > outlet h2 (O. Reynolds, 1886).

    Parameters
    ----------
    viscosity, speed : float
        Pa s, m/s.
    length, inlet, outlet, x : float
        m.
    """
    h = inlet + (outlet - inlet) * x / length
    return 6.0 * viscosity * speed * length * (inlet - h) * (h - outlet) / ((inlet**2 - outlet**2) * h**2)


def plane_slider_load(viscosity: float, speed: float, length: float, inlet: float, outlet: float) -> float:
    """Load in N per metre of width; arguments as in `plane_slider_pressure`."""
    k = inlet / outlet
    shape = (math.log(k) - 2.0 * (k - 1.0) / (k + 1.0)) / (k - 1.0) ** 2
    return 6.0 * viscosity * speed * length**2 / outlet**2 * shape


def conical_gap_pressure(
    z: float,
    *,
    viscosity: float,
    length: float,
    inlet: float,
    slope: float,
    speed: float,
    gap_rate: float,
    pressures: tuple[float, float],
) -> float:
    """Pressure in Pa at z in the axial film ``h = inlet + slope z`` between prescribed end pressures.

    The flux ``q = U h / 2 - h^3 p' / (12 mu)`` obeys ``q' = -dh/dt``; p' is integrated with the antiderivatives of
    ``1/h^2``, ``1/h^3`` and ``z/h^3``.

    Parameters
    ----------
    z : float
        m, from 0 to ``length``.
    viscosity : float
        Pa s.
    length, inlet : float
        m.
    slope : float
        dh/dz, not 0.
    speed : float
        Sum of both surfaces' axial speeds, m/s.
    gap_rate : float
        dh/dt at fixed z, m/s.
    pressures : (float, float)
        Pa at z = 0 and z = ``length``.
    """

    def integrals(end: float) -> tuple[float, float]:
        """Integrals from 0 to ``end`` of ``12 mu (U h / 2 + z dh/dt) / h^3`` and of ``12 mu / h^3``."""
        h = inlet + slope * end
        inverse = (1.0 / inlet - 1.0 / h) / slope
        cubed = (1.0 / inlet**2 - 1.0 / h**2) / (2.0 * slope)
        first = (inverse - inlet * cubed) / slope
        return 12.0 * viscosity * (0.5 * speed * inverse + gap_rate * first), 12.0 * viscosity * cubed

    drive, resistance = integrals(length)
    flux = (pressures[0] + drive - pressures[1]) / resistance
    part_drive, part_resistance = integrals(z)
    return pressures[0] + part_drive - flux * part_resistance
