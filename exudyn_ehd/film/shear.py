"""Viscosity that depends on the shear rate: Carreau's law, on the rate ``G = |U| / h`` of the Couette flow.

``mu / mu_0 = r(G) = r_inf + (1 - r_inf) (1 + (lambda G)^2)^((n - 1) / 2)``   (P. J. Carreau, Trans. Soc. Rheology 16 (1972) 99).

The pressure flow disturbs the Couette flow only slightly in a bearing. Linearised about it, ``tau = mu(|G|) G`` gives a disturbance
along the sliding direction the tangent viscosity ``mu + G dmu/dG`` and one across it ``mu`` itself (F. K. Dien and H. G. Elrod,
J. Lubrication Technology 105 (1983) 385). Hence, with s = (lambda U / h)^2 and b = 1 + s:

    r   = r_inf + (1 - r_inf) b^e,   e = (n - 1) / 2,           conductance across the sliding H^3 / r,
    r_t = r_inf + (1 - r_inf) b^(e-1) (1 + n s),                conductance along the sliding  H^3 / r_t,

Couette flux H unchanged, wall shear r U / h. Only the circumferential sliding speed enters; axial sliding is slow beside it.

Symbols: shear = lambda U / c scaled, s = (shear / H)^2; suffix _h derivative to the gap, _v to vx = U / (2 R).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.film.flux import FluxEffect, LinkFlux
from exudyn_ehd.status import InputError, require_number

TABLE_INTERVALS = 2048
TABLE_RATE = 50.0
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@dataclass(frozen=True, kw_only=True)
class CarreauShear:
    """Shear thinning after Carreau, for multigrade and polymer-thickened oils.

    Parameters
    ----------
    relaxation_time : float
        lambda, s: thinning sets in at a shear rate of 1 / lambda.
    exponent : float
        n, above 0 and up to 1 (Newtonian): at high rates the viscosity falls with the power n - 1 of the rate.
    residual : float
        r_inf = mu at infinite rate / mu_0, 0 to 1.
    """

    relaxation_time: float
    exponent: float
    residual: float = 0.0

    def __post_init__(self) -> None:
        require_number("CarreauShear.relaxation_time", self.relaxation_time, "s", above=0.0)
        n = require_number("CarreauShear.exponent", self.exponent, above=0.0)
        r = require_number("CarreauShear.residual", self.residual, at_least=0.0)
        if n > 1.0 or r > 1.0:
            raise InputError(
                f"CarreauShear.exponent and residual must not exceed 1 (an oil that thins), got {n:g} and {r:g}."
            )

    def ratio(self, rate: np.ndarray) -> np.ndarray:
        """mu / mu_0 at shear rates in 1/s."""
        b = 1.0 + (self.relaxation_time * np.asarray(rate)) ** 2
        return self.residual + (1.0 - self.residual) * b ** (0.5 * (self.exponent - 1.0))


class ShearThinning(FluxEffect):
    """A `CarreauShear` in scaled form: flux effect and shear factor of one bearing model.

    Parameters
    ----------
    law : CarreauShear
    radius, clearance : float
        m.
    """

    changes_carriers = False
    depends_on_speed = True

    def __init__(self, law: CarreauShear, radius: float, clearance: float) -> None:
        self.law = law
        self.table = power_table(0.5 * (law.exponent - 1.0))
        self.per_speed = 2.0 * radius * law.relaxation_time / clearance

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Divide the conductances of the links by the tangent (theta) and the plain (z) viscosity ratio."""
        law, k = self.law, self.per_speed
        thin_conductance(gap_x, vx, k, law.exponent, law.residual, self.table, True, flux.gx, flux.gx_h, flux.gx_v)
        thin_conductance(gap_z, vx, k, law.exponent, law.residual, self.table, False, flux.gz, flux.gz_h, flux.gz_v)

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> None:
        """mu/mu_0 of the Couette shear at the vertices, with its derivatives to H and vx."""
        law, k = self.law, self.per_speed
        thin_viscosity(H, vx, k, law.exponent, law.residual, self.table, ratio_out, ratio_h_out, ratio_v_out)


def power_table(exponent: float) -> np.ndarray:
    """Quintic Hermite coefficients (intervals, 6) of ``(1 + g^2)^exponent`` in y = g / (1 + g), g from 0 to TABLE_RATE.

    Error below 1e-12 of the value; a power costs three times as much.
    """
    y = np.linspace(0.0, TABLE_RATE / (1.0 + TABLE_RATE), TABLE_INTERVALS + 1)
    g = y / (1.0 - y)
    g_y, g_yy, b = (1.0 + g) ** 2, 2.0 * (1.0 + g) ** 3, 1.0 + g * g
    f = b**exponent
    f_g = 2.0 * exponent * g * f / b
    f_gg = 2.0 * exponent * f / b * (1.0 + 2.0 * (exponent - 1.0) * g * g / b)
    h = y[1]
    d, e = f_g * g_y * h, 0.5 * (f_gg * g_y**2 + f_g * g_yy) * h**2
    rise, bend, twist = np.diff(f) - d[:-1] - e[:-1], d[1:] - d[:-1] - 2.0 * e[:-1], e[1:] - e[:-1]
    c3, c4 = 10.0 * rise - 4.0 * bend + twist, -15.0 * rise + 7.0 * bend - 2.0 * twist
    c5 = 6.0 * rise - 3.0 * bend + twist
    return np.ascontiguousarray(np.array([f[:-1], d[:-1], e[:-1], c3, c4, c5]).T)


@njit(cache=True, fastmath=_FAST)
def power_from(table, e, g, b):
    """``b^e`` with b = 1 + g^2 from the table of `power_table`; written out beyond its end."""
    a = abs(g)
    if a >= TABLE_RATE:
        return np.exp(e * np.log(b))
    t = a / (1.0 + a) * ((1.0 + TABLE_RATE) / TABLE_RATE * TABLE_INTERVALS)
    k = min(int(t), TABLE_INTERVALS - 1)
    t -= k
    c = table[k]
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))))


@njit(cache=True, fastmath=_FAST)
def thin_viscosity(H, vx, per_speed, n, r_inf, table, ratio_out, ratio_h_out, ratio_v_out):
    """Carreau's ratio at gaps H with its derivatives to H and vx."""
    rows, cols = H.shape
    e = 0.5 * (n - 1.0)
    speed = per_speed * vx
    last = 0.0
    per_gap = g = power = slope = 0.0
    for i in range(rows):
        for j in range(cols):
            if H[i, j] != last:  # an aligned journal has one gap per column
                last = H[i, j]
                per_gap = 1.0 / last
                g = speed * per_gap
                b = 1.0 + g * g
                power = (1.0 - r_inf) * power_from(table, e, g, b)
                slope = power / b * (n - 1.0) * g * per_gap
            ratio_out[i, j] = r_inf + power
            ratio_h_out[i, j] = -slope * g
            ratio_v_out[i, j] = slope * per_speed


@njit(cache=True, fastmath=_FAST)
def thin_conductance(gap, vx, per_speed, n, r_inf, table, tangent, g_io, g_h_io, g_v_io):
    """Divide conductances by the (tangent) viscosity ratio at the links' gaps, derivatives to the gap and vx included."""
    rows, cols = gap.shape
    e = 0.5 * (n - 1.0)
    speed = per_speed * vx
    last = 0.0
    g = inverse = slope = 0.0
    for i in range(rows):
        for j in range(cols):
            if gap[i, j] != last:  # an aligned journal has one gap per column
                last = gap[i, j]
                per_gap = 1.0 / last
                g = speed * per_gap
                s = g * g
                b = 1.0 + s
                r = (1.0 - r_inf) * power_from(table, e, g, b)
                per_b = 1.0 / b
                slope = 2.0 * g * r * per_b
                if tangent:
                    bend = (1.0 + n * s) * per_b
                    slope *= n + (e - 1.0) * bend
                    r *= bend
                else:
                    slope *= e
                inverse = 1.0 / (r_inf + r)
                slope *= inverse * per_gap
            c = g_io[i, j] * inverse
            g_io[i, j] = c
            g_h_io[i, j] = g_h_io[i, j] * inverse + c * slope * g
            g_v_io[i, j] = g_v_io[i, j] * inverse - c * slope * per_speed
