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
def link_derivatives(P, H, HF, flux, sigma, vx, vz, flow_x, mesh, out):
    """Derivatives of all links' flows.

    Parameters
    ----------
    P, H, HF : (n, m) arrays
        Pressure, gaps at vertices and on the links i -> i+1.
    flux : LinkFlux or None
        None: plain film.
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
            if flux is None:
                h = HF[i, j]
                g_h = 3.0 * h * h
            else:
                v *= flux.cx_h[i, j]
                g_h = flux.gx_h[i, j]
            out.DX[i, j] = (v - g_h * (lx * (P[nxt, j] - P[i, j]))) * width_z[j]
        for j in range(m):
            carrier = HF[i, j] if flux is None else flux.cx[i, j]
            carried = linked * carrier if sigma is None else linked * carrier * sigma[0][i, j]
            out.SX[i, j] = carried * width_z[j]
        for j in range(m - 1):
            v = vz if sigma is None else vz * sigma[1][i, j]
            if flux is None:
                h = 0.5 * (H[i, j] + H[i, j + 1])
                g_h = 3.0 * h * h
            else:
                v *= flux.cz_h[i, j]
                g_h = flux.gz_h[i, j]
            out.DZ[i, j] = (v - g_h * (mesh.link_z[j] * (P[i, j + 1] - P[i, j]))) * wx
        for j in range(m - 1):
            carrier = 0.5 * (H[i, j] + H[i, j + 1]) if flux is None else flux.cz[i, j]
            carried = carrier if sigma is None else carrier * sigma[1][i, j]
            out.SZ[i, j] = carried * wx
        if flux is not None and flux.speeds:
            for j in range(m):
                out.SX[i, j] -= flux.gx_v[i, j] * (lx * (P[nxt, j] - P[i, j])) * width_z[j]
            for j in range(m - 1):
                out.SZX[i, j] = -flux.gz_v[i, j] * (mesh.link_z[j] * (P[i, j + 1] - P[i, j])) * wx


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


@njit(cache=True, fastmath=_FAST)
def pose_gradient(lam, DX, DZ, SX, SZ, SZX, slope, AR, AC, cos_x, sin_x, cos_f, sin_f, z, out):
    """Gradients of k adjoint functionals to (scaled pose, scaled rates, vx, vz).

    Parameters
    ----------
    lam : (k, n, m) array
        Adjoint solutions.
    DX, DZ, SX, SZ, SZX : (n, m) arrays
        Link derivatives; DX already by the true gap.
    slope : (n, m) array
        d(film gap)/d(true gap) at the vertices; ones without a limiter.
    AR, AC : (n, m) arrays
        Derivative of a vertex's balance through its storage, with respect to the true gap's rate and to the true gap.
    out : (k, 10) array
        Overwritten.
    """
    count, n, m = lam.shape
    for k in range(count):
        for q in range(10):
            out[k, q] = 0.0
        sx = 0.0
        sz = 0.0
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            a = lam[k, i]
            b = lam[k, nxt]
            f0 = 0.0
            f1 = 0.0
            r0 = 0.0
            r1 = 0.0
            c0 = 0.0
            c1 = 0.0
            for j in range(m):
                d = a[j] - b[j]
                g = d * DX[i, j]
                f0 += g
                f1 += g * z[j]
                sx -= d * SX[i, j]
                w = a[j] * AR[i, j]
                r0 += w
                r1 += w * z[j]
                w = a[j] * AC[i, j]
                c0 += w
                c1 += w * z[j]
            for j in range(m - 1):
                d = a[j] - a[j + 1]
                g = 0.5 * d * DZ[i, j]
                c0 += g * (slope[i, j] + slope[i, j + 1])
                c1 += g * (slope[i, j] * z[j] + slope[i, j + 1] * z[j + 1])
                sz -= d * SZ[i, j]
                sx -= d * SZX[i, j]
            # dH/d(x, y, bx, by) = -(cos, sin, z cos, z sin); the functionals' gradients are -lam . dr
            out[k, 0] += f0 * cos_f[i] + c0 * cos_x[i]
            out[k, 1] += f0 * sin_f[i] + c0 * sin_x[i]
            out[k, 2] += f1 * cos_f[i] + c1 * cos_x[i]
            out[k, 3] += f1 * sin_f[i] + c1 * sin_x[i]
            out[k, 4] += r0 * cos_x[i]
            out[k, 5] += r0 * sin_x[i]
            out[k, 6] += r1 * cos_x[i]
            out[k, 7] += r1 * sin_x[i]
        out[k, 8] = sx
        out[k, 9] = sz


@njit(cache=True)
def wrench_gradient(ds, dc, extra, ends, pose, sums, pose_scale, R, force, shear, omega, w, couette, out):
    """d wrench / d motion (6, 10) in SI units from the gradients of the integrals; see `loads` for the wrench itself.

    Parameters
    ----------
    ds, dc, extra : (4, 10), (10,), (2, 10) arrays
        Gradients of (S_c, S_s, S_zc, S_zs), of C, and of the integrals over the slopes of gap terms, to (scaled pose,
        scaled rates, vx, vz).
    ends : (4,) array
        Gradient of the ends' pressure force to the scaled pose.
    pose, sums, pose_scale : (4,) arrays
        Scaled pose, the four integrals, scale of the pose.
    R, force, shear, omega, w, couette : float
        Radius, scales of force and shear, spin, axial speed, C.
    """
    x, y, bx, by = pose[0], pose[1], pose[2], pose[3]
    for q in range(10):
        theta = x * ds[1, q] - y * ds[0, q] + bx * ds[3, q] - by * ds[2, q] - extra[0, q]
        z = -(bx * ds[0, q] + by * ds[1, q]) - extra[1, q]
        if q == 0:
            theta += sums[1]
        elif q == 1:
            theta -= sums[0]
        elif q == 2:
            theta += sums[3]
            z -= sums[0]
        elif q == 3:
            theta -= sums[2]
            z -= sums[1]
        out[0, q] = -force * ds[0, q]
        out[1, q] = -force * ds[1, q]
        out[2, q] = -shear * (6.0 * R * z + w * dc[q])
        out[3, q] = force * R * ds[3, q]
        out[4, q] = -force * R * ds[2, q]
        out[5, q] = -shear * R * R * (6.0 * theta + omega * dc[q])
        if q < 4:
            out[2, q] += 6.0 * shear * R * ends[q]
        scale = 0.5
        if q < 8:
            scale = pose_scale[q % 4]
        elif q == 9:
            scale = 0.5 / R
        for r in range(6):
            out[r, q] *= scale
    out[2, 9] -= shear * couette
    out[5, 8] -= shear * R * R * couette
