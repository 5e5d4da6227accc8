"""Flow and friction factors of rough surfaces as effects on a film: tables of `patir_cheng` over the average gaps.

Over ``y = 1 / (1 + h_T / (8 sigma))``: the pressure flow as phi = phi_x h^3 / h_T^3, the shear flow as psi = sigma
Phi_s / h_T, the friction as ``h_T E[1 / local gap] + Phi_fs h_T / h``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.film.surfaces.patir_cheng import TABLE_MIDDLE, PatirCheng, flow_tables

_FAST = {"reassoc", "contract", "nsz", "arcp"}
_unsigned = np.uint64


class RoughFlow(FluxEffect):
    """`PatirCheng` as flux effect and shear factor of one bearing model.

    Parameters
    ----------
    roughness : PatirCheng
    clearance : float
        Radial clearance, m.
    residual : float
        Residual film of the average gap, share of sigma.
    """

    depends_on_speed = False

    def __init__(self, roughness: PatirCheng, clearance: float, residual: float) -> None:
        self.sigma = roughness.composite_roughness / clearance
        self.phi_x, self.psi_x, self.friction = flow_tables(roughness.pattern, residual)
        self.phi_z, self.psi_z, _ = flow_tables(1.0 / roughness.pattern, residual)
        self.shear = 2.0 * roughness.journal_share - 1.0
        self.changes_carriers = self.shear != 0.0

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Multiply conductances and carriers by their factors at the links' average gaps (n, m), with derivatives."""
        multiply_by_table(gap_x, 1.0 / self.sigma, self.phi_x, 0.0, 1.0, flux.gx, flux.gx_h)
        multiply_by_table(gap_z, 1.0 / self.sigma, self.phi_z, 0.0, 1.0, flux.gz, flux.gz_h)
        if self.shear != 0.0:
            multiply_by_table(gap_x, 1.0 / self.sigma, self.psi_x, 1.0, self.shear, flux.cx, flux.cx_h)
            multiply_by_table(gap_z, 1.0 / self.sigma, self.psi_z, 1.0, self.shear, flux.cz, flux.cz_h)

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> None:
        """Friction factor phi_f + Phi_fs at average gaps H (n, m) and its derivatives with respect to H and vx."""
        look_up(H, 1.0 / self.sigma, self.friction, ratio_out, ratio_h_out)
        ratio_v_out[:] = 0.0


# Checks for a division by zero would keep the compiler from vectorising the loops below; the tables' gathers stand
# apart for the same reason.
@njit(cache=True, fastmath=_FAST, error_model="numpy")
def multiply_by_table(gap, inverse_sigma, table, base, share, value, value_h):
    """value *= f, with its derivative by the gap, f = base + share table(y), y = 1 / (1 + gap / (8 sigma)).

    In place.
    """
    factor, factor_h = np.empty(gap.shape), np.empty(gap.shape)
    look_up(gap, inverse_sigma, table, factor, factor_h)
    v, v_h, f, f_h = value.reshape(-1), value_h.reshape(-1), factor.reshape(-1), factor_h.reshape(-1)
    for k in range(v.size):
        by = base + share * f[k]
        v_h[k] = v_h[k] * by + v[k] * (share * f_h[k])
        v[k] *= by


@njit(cache=True)
def _aligned(gap):
    """Return whether there is one gap per column, as with an aligned journal."""
    n, m = gap.shape
    for i in range(n):
        differing = 0
        for j in range(1, m):
            differing += gap[i, j] != gap[i, 0]
        if differing > 0:
            return False
    return True


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def look_up(gap, inverse_sigma, table, f_out, f_h_out):
    """Value of a table at gaps (n, m), and its derivative by them."""
    n, m = gap.shape
    scale, flat = inverse_sigma / TABLE_MIDDLE, table.reshape(-1)
    if _aligned(gap):
        for i in range(n):
            value, slope = _table_at(1.0 / (1.0 + gap[i, 0] * scale), scale, flat)
            for j in range(m):
                f_out[i, j] = value
            for j in range(m):
                f_h_out[i, j] = slope
        return
    h, f, f_h = gap.reshape(-1), f_out.reshape(-1), f_h_out.reshape(-1)
    for k in range(h.size):
        f[k] = 1.0 / (1.0 + h[k] * scale)
    for k in range(h.size):
        f[k], f_h[k] = _table_at(f[k], scale, flat)


@njit(cache=True, fastmath=_FAST, error_model="numpy", inline="always")
def _table_at(y, scale, table):
    """Value of a flat table at y, and its derivative by the gap."""
    steps = table.size // 4
    u = y * steps
    k = min(_unsigned(u), _unsigned(steps - 1))
    u -= float(k)
    k *= _unsigned(4)
    b = table[k + _unsigned(1)]
    c2 = table[k + _unsigned(2)]
    c3 = table[k + _unsigned(3)]
    f = table[k] + u * (b + u * (c2 + u * c3))
    return f, (b + u * (2.0 * c2 + u * 3.0 * c3)) * steps * (-y * y * scale)
