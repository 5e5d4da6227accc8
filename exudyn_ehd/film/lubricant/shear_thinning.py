"""Viscosity that depends on the shear rate: Carreau's law, on the rate ``G = |U| / h`` of the Couette flow.

``mu / mu_0 = r(G) = r_inf + (1 - r_inf) (1 + (lambda G)^2)^((n - 1) / 2)``   (P. J. Carreau, Trans. Soc. Rheology 16
(1972) 99).

The pressure flow disturbs the Couette flow only slightly in a bearing. Linearised about it, ``tau = mu(|G|) G`` gives a
disturbance along the sliding direction the tangent viscosity ``mu + G dmu/dG`` and one across it ``mu`` itself (F. K.
Dien and H. G. Elrod, J. Lubrication Technology 105 (1983) 385). Hence, with s = (lambda U / h)^2 and b = 1 + s:

    r   = r_inf + (1 - r_inf) b^e,   e = (n - 1) / 2,           conductance across the sliding H^3 / r,
    r_t = r_inf + (1 - r_inf) b^(e-1) (1 + n s),                conductance along the sliding  H^3 / r_t,

Couette flux H unchanged, wall shear r U / h. Only the circumferential sliding speed enters; axial sliding is slow
in comparison.

Symbols: shear = lambda U / c scaled, s = (shear / H)^2; suffix _h derivative to the gap, _v to vx = U / (2 R).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.status import InputError, require_number

TABLE_INTERVALS = 2048
TABLE_RATE = 50.0
_FAST = {"reassoc", "contract", "nsz", "arcp"}
_unsigned = np.uint64
_ONE, _TWO, _THREE, _FOUR, _FIVE, _SIX = (_unsigned(k) for k in range(1, 7))


@dataclass(frozen=True, kw_only=True)
class CarreauShear:
    """Shear thinning after Carreau, for multigrade and polymer-thickened oils.

    The pressure flow is linearised about the sliding, see the module; squeeze alone does not thin the oil. Against the
    exact flow across the film of a long bearing (eccentricity ratio 0.8 and 0.9, lambda U / c from 0.2 to 4): the load
    is 1 to 2 % high where thinning takes up to a quarter of it, 7 to 8 % low where it takes half (n = 0.6, residual
    0.2), 15 to 16 % low where it takes three quarters (n = 0.5, no residual); the peak pressure likewise, up to 14 %
    low.

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

    @property
    def onset(self) -> float:
        """Shear rate from which on the oil thins, 1/s."""
        return 1.0 / self.relaxation_time

    def bound(self, radius: float, clearance: float) -> ShearThinning:
        """The law as flux effect and shear factor of a bearing of this radius and clearance, m."""
        return ShearThinning(self, radius, clearance)


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

    def start(self, flux: LinkFlux, H: np.ndarray, vx: float, vz: float) -> None:
        """Conductances with their factors in one pass."""
        if flux.carriers:
            super().start(flux, H, vx, vz)
            return
        law = self.law
        thin_flux(
            H,
            flux.gap_x,
            vx,
            self.per_speed,
            law.exponent,
            law.residual,
            self.table,
            flux.gap_z,
            flux.gx,
            flux.gx_h,
            flux.gx_v,
            flux.gz,
            flux.gz_h,
            flux.gz_v,
        )

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


# Checks for a division by zero would keep the compiler from vectorising the loops below; the table's gather stands
# apart for the same reason.
@njit(cache=True, fastmath=_FAST, error_model="numpy")
def powers(gap, speed, e, table, out):
    """``(1 + g^2)^e`` at ``g = speed / gap`` from the table of `power_table`, written out beyond its end.

    Gap, of either sign, and out (n, m).
    """
    h, p = gap.reshape(-1), out.reshape(-1)
    coefficients = table.reshape(-1)
    size = abs(speed)
    scale = size * ((1.0 + TABLE_RATE) / TABLE_RATE * TABLE_INTERVALS)
    for k in range(h.size):
        p[k] = scale / (abs(h[k]) + size)
    for k in range(h.size):
        t = p[k]
        if t < TABLE_INTERVALS:
            at = _unsigned(t)
            t -= float(at)
            at *= _SIX
            p[k] = coefficients[at] + t * (
                coefficients[at + _ONE] + t * (
                    coefficients[at + _TWO] + t * (
                        coefficients[at + _THREE] + t * (coefficients[at + _FOUR] + t * coefficients[at + _FIVE])
                    )
                )
            )  # fmt: skip
        else:
            g = size / h[k]
            p[k] = np.exp(e * np.log(1.0 + g * g))


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def thin_viscosity(H, vx, per_speed, n, r_inf, table, ratio_out, ratio_h_out, ratio_v_out):
    """Carreau's ratio at gaps H with its derivatives to H and vx."""
    speed = per_speed * vx
    powers(H, speed, 0.5 * (n - 1.0), table, ratio_out)
    h, r, r_h, r_v = H.reshape(-1), ratio_out.reshape(-1), ratio_h_out.reshape(-1), ratio_v_out.reshape(-1)
    s = speed * speed
    for k in range(h.size):
        thin = (1.0 - r_inf) * r[k]
        slope = (n - 1.0) * speed * thin / (h[k] * h[k] + s)
        r[k] = r_inf + thin
        r_h[k] = -slope * speed / h[k]
        r_v[k] = slope * per_speed


@njit(cache=True, fastmath=_FAST, error_model="numpy", inline="always")
def _fluidity(h, power, speed, s, n, r_inf, tangent):
    """1 / r, or 1 / r_t with ``tangent``, at a gap h, and D with d/dh = D speed / h, d/dvx = -D per_speed.

    ``power`` = b^e, ``s`` = speed^2.
    """
    per_b = 1.0 / (h * h + s)  # over h^2
    r = (1.0 - r_inf) * power
    if tangent:
        bend = (h * h + n * s) * per_b
        slope = n + (0.5 * (n - 1.0) - 1.0) * bend
        f = 1.0 / (r_inf + r * bend)
    else:
        slope = 0.5 * (n - 1.0)
        f = 1.0 / (r_inf + r)
    return f, 2.0 * speed * r * per_b * slope * f * f


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def thin_conductance(gap, vx, per_speed, n, r_inf, table, tangent, g_io, g_h_io, g_v_io):
    """Divide conductances by the (tangent) viscosity ratio at the links' gaps; also their derivatives to gap and vx."""
    speed = per_speed * vx
    power = np.empty(gap.size)
    powers(gap, speed, 0.5 * (n - 1.0), table, power)
    h, g, g_h, g_v = gap.reshape(-1), g_io.reshape(-1), g_h_io.reshape(-1), g_v_io.reshape(-1)
    s = speed * speed
    for k in range(h.size):
        f, d = _fluidity(h[k], power[k], speed, s, n, r_inf, tangent)
        g_h[k] = g_h[k] * f + g[k] * d * speed / h[k]
        g_v[k] = g_v[k] * f - g[k] * d * per_speed
        g[k] *= f


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def thin_flux(H, HF, vx, per_speed, n, r_inf, table, gap_z_out, gx_out, gx_h_out, gx_v_out, gz_out, gz_h_out, gz_v_out):
    """`plain_flux` over the viscosity ratios, with the derivatives of `thin_conductance`."""
    rows, cols = H.shape
    for i in range(rows):
        for j in range(cols - 1):
            gap_z_out[i, j] = 0.5 * (H[i, j] + H[i, j + 1])
        gap_z_out[i, cols - 1] = H[i, cols - 1]
    _thin_plain(HF, per_speed * vx, per_speed, n, r_inf, table, True, gx_out, gx_h_out, gx_v_out)
    _thin_plain(gap_z_out, per_speed * vx, per_speed, n, r_inf, table, False, gz_out, gz_h_out, gz_v_out)


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _thin_plain(gap, speed, per_speed, n, r_inf, table, tangent, g_out, g_h_out, g_v_out):
    """H^3 over the (tangent) viscosity ratio, with its derivatives to the gap and to vx."""
    powers(gap, speed, 0.5 * (n - 1.0), table, g_out)
    h, g, g_h, g_v = gap.reshape(-1), g_out.reshape(-1), g_h_out.reshape(-1), g_v_out.reshape(-1)
    s = speed * speed
    for k in range(h.size):
        f, d = _fluidity(h[k], g[k], speed, s, n, r_inf, tangent)
        square = h[k] * h[k]
        g[k] = square * h[k] * f
        g_h[k] = square * (3.0 * f + d * speed)
        g_v[k] = -square * h[k] * d * per_speed
