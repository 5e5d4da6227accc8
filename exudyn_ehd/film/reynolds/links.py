"""Finite-volume Reynolds equation in scaled form: link coefficients, right-hand side, and the adjoint of the residual.

With H = h/c, lengths over R and P = p c^2 / (12 mu R^2) in 1/s, the balance of a control volume reads

    sum over its links of (V H - H^3 dP/ds) + d(H)/dt area = 0,      V = (U_x, U_z) / (2 R) in 1/s,

which is the conservative form of the paper's Eq. (4) (Poiseuille and Couette flux of a thin film, squeeze). Links in theta
use the gap on the link itself, ``HF``; links in z the mean of both vertices, which is exact for a tilted journal.

Symbols: H (n, m) gap at vertices, HF (n, m) gap on the link i -> i+1, kx / kz link conductances with their metric, fx / fz
Couette fluxes with their metric, b right-hand side of ``A P = b``, P scaled pressure.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class FilmState(NamedTuple):
    """A film as unknowns, (n, m) each: scaled pressure, film fraction, and whether the pressure is a vertex's unknown, else its fill."""

    P: np.ndarray
    fill: np.ndarray
    full: np.ndarray


@njit(cache=True, fastmath=_FAST)
def conductances(H, HF, width_x, width_z, link_x, link_z, flow_x, kx_out, kz_out):
    """Conductances of the links: ``H^3 width / distance``; ``flow_x`` = 0 drops the circumferential pressure flow."""
    n, m = H.shape
    for i in range(n):
        lx = link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            hf = HF[i, j]
            kx_out[i, j] = hf * hf * hf * lx * width_z[j]
        for j in range(m - 1):
            hz = 0.5 * (H[i, j] + H[i, j + 1])
            kz_out[i, j] = hz * hz * hz * link_z[j] * wx
        kz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def couette_fluxes(H, HF, vx, vz, width_x, width_z, link_x, fx_out, fz_out):
    """Couette fluxes of the links; 0 where there is no link."""
    n, m = H.shape
    for i in range(n):
        v = vx if link_x[i] != 0.0 else 0.0
        for j in range(m):
            fx_out[i, j] = v * HF[i, j] * width_z[j]
        for j in range(m - 1):
            fz_out[i, j] = vz * 0.5 * (H[i, j] + H[i, j + 1]) * width_x[i]
        fz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def right_hand_side(fx, fz, b_out):
    """b = net Couette inflow of every control volume."""
    n, m = fx.shape
    for i in range(n):
        p = i - 1 if i > 0 else n - 1
        for j in range(m):
            b_out[i, j] = fx[p, j] - fx[i, j]
        b_out[i, 0] -= fz[i, 0]
        for j in range(1, m):
            b_out[i, j] += fz[i, j - 1] - fz[i, j]


@njit(cache=True, fastmath=_FAST)
def add_squeeze(H_t, width_x, width_z, b_out):
    """Subtract the storage term ``dH/dt area``."""
    n, m = H_t.shape
    for i in range(n):
        for j in range(m):
            b_out[i, j] -= H_t[i, j] * width_x[i] * width_z[j]


@njit(cache=True, fastmath=_FAST)
def link_flow_sensitivity(lam, P, H, HF, vx, vz, flow_x, width_x, width_z, link_x, link_z, cell_out, face_out):
    """Gradient of ``-lam . r`` with respect to the gaps, r = residual without the storage term.

    Parameters
    ----------
    lam : (k, n, m) array
        Adjoint solutions.
    P : (n, m) array
        The pressure that solves the linear problem (before any clipping).
    cell_out, face_out : (k, n, m) arrays
        d(-lam . r)/dH and d(-lam . r)/dHF.
    """
    count, n, m = lam.shape
    for k in range(count):
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            v = vx if link_x[i] != 0.0 else 0.0
            lx = 3.0 * link_x[i] * flow_x
            wx = width_x[i]
            for j in range(m):
                hf = HF[i, j]
                q = (v - lx * hf * hf * (P[nxt, j] - P[i, j])) * width_z[j]
                face_out[k, i, j] = -(lam[k, i, j] - lam[k, nxt, j]) * q
                cell_out[k, i, j] = 0.0
            for j in range(m - 1):
                hz = 0.5 * (H[i, j] + H[i, j + 1])
                q = 0.5 * wx * (vz - 3.0 * hz * hz * link_z[j] * (P[i, j + 1] - P[i, j]))
                g = -(lam[k, i, j] - lam[k, i, j + 1]) * q
                cell_out[k, i, j] += g
                cell_out[k, i, j + 1] += g


@njit(cache=True, fastmath=_FAST)
def couette_sensitivity_fill(lam, fill, fx, fz, H, HF, vx, vz, width_x, width_z, link_x, cell_out, face_out, speed_out):
    """Correct the sensitivities of a full film for the upstream fill of the Couette fluxes; adds to all outputs.

    ``cell_out``, ``face_out`` (k, n, m) as in `link_flow_sensitivity`, ``speed_out`` (k, 2) as in `speed_sensitivity`.
    """
    count, n, m = lam.shape
    for k in range(count):
        sx = 0.0
        sz = 0.0
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            if link_x[i] != 0.0:
                for j in range(m):
                    up = fill[i, j] if fx[i, j] >= 0.0 else fill[nxt, j]
                    d = (lam[k, i, j] - lam[k, nxt, j]) * (1.0 - up) * width_z[j]
                    face_out[k, i, j] += d * vx
                    sx += d * HF[i, j]
            for j in range(m - 1):
                up = fill[i, j] if fz[i, j] >= 0.0 else fill[i, j + 1]
                d = 0.5 * (lam[k, i, j] - lam[k, i, j + 1]) * (1.0 - up) * width_x[i]
                cell_out[k, i, j] += d * vz
                cell_out[k, i, j + 1] += d * vz
                sz += d * (H[i, j] + H[i, j + 1])
        speed_out[k, 0] += sx
        speed_out[k, 1] += sz


@njit(cache=True, fastmath=_FAST)
def speed_sensitivity(lam, H, HF, width_x, width_z, link_x, out):
    """d(-lam . r)/d(vx, vz) for every adjoint: out (k, 2)."""
    count, n, m = lam.shape
    for k in range(count):
        sx = 0.0
        sz = 0.0
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            if link_x[i] != 0.0:
                for j in range(m):
                    sx -= (lam[k, i, j] - lam[k, nxt, j]) * HF[i, j] * width_z[j]
            for j in range(m - 1):
                sz -= (lam[k, i, j] - lam[k, i, j + 1]) * 0.5 * (H[i, j] + H[i, j + 1]) * width_x[i]
        out[k, 0] = sx
        out[k, 1] = sz


@njit(cache=True)
def vertex_balance(P, kx, kz, b, out):
    """Residual ``A P - b`` of every vertex (n, m); at fixed vertices this is minus the inflow that they supply."""
    n, m = P.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            r = kx[i, j] * (P[i, j] - P[nxt, j]) + kx[prv, j] * (P[i, j] - P[prv, j]) - b[i, j]
            if j > 0:
                r += kz[i, j - 1] * (P[i, j] - P[i, j - 1])
            if j + 1 < m:
                r += kz[i, j] * (P[i, j] - P[i, j + 1])
            out[i, j] = r
