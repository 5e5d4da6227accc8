"""Derivatives of the links' flows to gap and speeds at fixed pressure, and their sums with adjoint solutions.

For an adjoint solution lam the gradient of ``-lam . r``, r the balance of the vertices, is taken either as fields
(`contract_links`, for elastic bores and liners) or, with the chain rule to the journal's pose, in one sweep without
fields in between (`pose_gradient`).

Symbols: DX, DZ derivative of the flow of a link in theta, z with respect to the gap that the link sees (with the
limiter's slope for the true gap), SX, SZ with respect to its own mean speed, SZX of the flow in z with respect to vx;
all with metric. ``sigma = fill_upstream (rho_a + rho_b) / 2`` on the link a -> b with the density ratio rho: what a
link carries of a full film's Couette flow.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class LinkDerivatives(NamedTuple):
    """(n, m) arrays, see the module's docstring."""

    DX: np.ndarray
    DZ: np.ndarray
    SX: np.ndarray
    SZ: np.ndarray
    SZX: np.ndarray


@njit(cache=True)
def link_factors(fill, rho, fx, fz, sigma_x_out, sigma_z_out):
    """sigma on the links in theta and z (0 behind the last row)."""
    n, m = rho.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            up = fill[i, j] if fx[i, j] >= 0.0 else fill[nxt, j]
            sigma_x_out[i, j] = 0.5 * up * (rho[i, j] + rho[nxt, j])
        for j in range(m - 1):
            up = fill[i, j] if fz[i, j] >= 0.0 else fill[i, j + 1]
            sigma_z_out[i, j] = 0.5 * up * (rho[i, j] + rho[i, j + 1])
        sigma_z_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def link_derivatives(P, H, HF, slopes, by_speed, sigma, vx, vz, flow_x, mesh, out):
    """Derivatives of all links' flows.

    Parameters
    ----------
    P, H, HF : (n, m) arrays
        Pressure, gaps at vertices and on the links i -> i+1.
    slopes, by_speed : tuples of (n, m) arrays or None
        `LinkFlux.slopes` and `LinkFlux.by_speed`; None: plain film, conductances that do not depend on the speed.
    sigma : (sigma_x, sigma_z) or None
        (n, m) arrays; None: a full film of density ratio 1.
    vx, vz, flow_x : float
        Scaled mean speeds; 0 drops the circumferential pressure flow.
    mesh : Mesh
    out : LinkDerivatives
    """
    n, m = H.shape
    width_z = mesh.width_z
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if mesh.link_x[i] != 0.0 else 0.0
        lx = mesh.link_x[i] * flow_x
        wx = mesh.width_x[i]
        for j in range(m):
            v = linked * vx if sigma is None else linked * vx * sigma[0][i, j]
            if slopes is None:
                h = HF[i, j]
                g_h = 3.0 * h * h
            else:
                v *= slopes[4][i, j]
                g_h = slopes[0][i, j]
            out.DX[i, j] = (v - g_h * (lx * (P[nxt, j] - P[i, j]))) * width_z[j]
        for j in range(m):
            carrier = HF[i, j] if slopes is None else slopes[2][i, j]
            carried = linked * carrier if sigma is None else linked * carrier * sigma[0][i, j]
            out.SX[i, j] = carried * width_z[j]
        for j in range(m - 1):
            v = vz if sigma is None else vz * sigma[1][i, j]
            if slopes is None:
                h = 0.5 * (H[i, j] + H[i, j + 1])
                g_h = 3.0 * h * h
            else:
                v *= slopes[5][i, j]
                g_h = slopes[1][i, j]
            out.DZ[i, j] = (v - g_h * (mesh.link_z[j] * (P[i, j + 1] - P[i, j]))) * wx
        for j in range(m - 1):
            carrier = 0.5 * (H[i, j] + H[i, j + 1]) if slopes is None else slopes[3][i, j]
            carried = carrier if sigma is None else carrier * sigma[1][i, j]
            out.SZ[i, j] = carried * wx
        if by_speed is not None:
            for j in range(m):
                out.SX[i, j] -= by_speed[0][i, j] * (lx * (P[nxt, j] - P[i, j])) * width_z[j]
            for j in range(m - 1):
                out.SZX[i, j] = -by_speed[1][i, j] * (mesh.link_z[j] * (P[i, j + 1] - P[i, j])) * wx


def contract_links(lam: np.ndarray, d: LinkDerivatives) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gradients of ``-lam . r``, storage apart, for k adjoints lam (k, n, m).

    Returns
    -------
    cell, face : (k, n, m) arrays
        To the gaps at vertices and on the links i -> i+1.
    speed : (k, 2) array
        To (vx, vz).
    """
    along, across = lam - np.roll(lam, -1, axis=1), lam[:, :, :-1] - lam[:, :, 1:]
    half = -0.5 * across * d.DZ[:, :-1]
    cell = np.zeros_like(lam)
    cell[:, :, :-1] += half
    cell[:, :, 1:] += half
    turning = np.sum(along * d.SX, axis=(1, 2)) + np.sum(across * d.SZX[:, :-1], axis=(1, 2))
    sliding = np.sum(across * d.SZ[:, :-1], axis=(1, 2))
    return cell, -along * d.DX, -np.stack([turning, sliding], axis=1)
