"""From adjoint solutions to the journal's motion in one sweep, without fields in between.

First the derivatives of every link's flow with respect to its gap and to the speeds, once for all adjoints; then one pass over
each adjoint that contracts with the pose. It does the same as `solver.FilmSolver.sensitivities` and `gap.contract_pose` one after the
other, which elastic bores need because they want the fields.

Symbols: DX, DZ derivative of the flow of a link in theta, z with respect to the gap that the link sees (with the limiter's
slope for the true gap), SX, SZ with respect to its own mean speed, SZX of the flow in z with respect to vx; all with metric.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class LinkDerivatives:
    """Buffers DX, DZ, SX, SZ, SZX (n, m)."""

    def __init__(self, shape: tuple[int, int]) -> None:
        self.DX, self.DZ = np.zeros(shape), np.zeros(shape)
        self.SX, self.SZ, self.SZX = np.zeros(shape), np.zeros(shape), np.zeros(shape)


@njit(cache=True, fastmath=_FAST)
def plain_link_derivatives(P, H, HF, vx, vz, flow_x, width_x, width_z, link_x, link_z, DX, DZ, SX, SZ):
    """Derivatives for conductances H^3 and carriers H."""
    n, m = H.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        lx = 3.0 * link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            h = HF[i, j]
            DX[i, j] = (linked * vx - lx * h * h * (P[nxt, j] - P[i, j])) * width_z[j]
            SX[i, j] = linked * h * width_z[j]
        for j in range(m - 1):
            h = 0.5 * (H[i, j] + H[i, j + 1])
            DZ[i, j] = (vz - 3.0 * h * h * link_z[j] * (P[i, j + 1] - P[i, j])) * wx
            SZ[i, j] = h * wx


@njit(cache=True, fastmath=_FAST)
def flux_link_derivatives(
    P, gx_h, gx_v, gz_h, gz_v, cx, cx_h, cz, cz_h, vx, vz, flow_x, width_x, width_z, link_x, link_z, DX, DZ, SX, SZ, SZX
):  # fmt: skip
    """Derivatives for the coefficients of `flux.LinkFlux`, in loops of one result."""
    n, m = cx.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        lx = link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            drop = lx * (P[nxt, j] - P[i, j])
            DX[i, j] = (linked * vx * cx_h[i, j] - gx_h[i, j] * drop) * width_z[j]
        for j in range(m):
            drop = lx * (P[nxt, j] - P[i, j])
            SX[i, j] = (linked * cx[i, j] - gx_v[i, j] * drop) * width_z[j]
        for j in range(m - 1):
            DZ[i, j] = (vz * cz_h[i, j] - gz_h[i, j] * (link_z[j] * (P[i, j + 1] - P[i, j]))) * wx
        for j in range(m - 1):
            SZ[i, j] = cz[i, j] * wx
        for j in range(m - 1):
            SZX[i, j] = -gz_v[i, j] * (link_z[j] * (P[i, j + 1] - P[i, j])) * wx


@njit(cache=True, fastmath=_FAST)
def conductance_link_derivatives(
    P, gx_h, gz_h, gap_x, gap_z, vx, vz, flow_x, width_x, width_z, link_x, link_z, DX, DZ, SX, SZ
):  # fmt: skip
    """Derivatives for carriers H and conductances that don't depend on the speed; `flux_link_derivatives` in loops of one result."""
    n, m = gap_x.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        v = linked * vx
        lx = link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            DX[i, j] = (v - gx_h[i, j] * (lx * (P[nxt, j] - P[i, j]))) * width_z[j]
        for j in range(m):
            SX[i, j] = linked * gap_x[i, j] * width_z[j]
        for j in range(m - 1):
            DZ[i, j] = (vz - gz_h[i, j] * (link_z[j] * (P[i, j + 1] - P[i, j]))) * wx
        for j in range(m - 1):
            SZ[i, j] = gap_z[i, j] * wx


@njit(cache=True, fastmath=_FAST)
def take_upstream_fill(fill, fx, fz, cx_h, cx, cz_h, cz, vx, vz, width_x, width_z, link_x, DX, DZ, SX, SZ):
    """Correct the Couette parts of the derivatives for the fill upstream; carriers cx, cz and their slopes as in `LinkFlux`."""
    n, m = fill.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            missing = linked * width_z[j] * (1.0 - (fill[i, j] if fx[i, j] >= 0.0 else fill[nxt, j]))
            DX[i, j] -= missing * vx * cx_h[i, j]
            SX[i, j] -= missing * cx[i, j]
        for j in range(m - 1):
            missing = width_x[i] * (1.0 - (fill[i, j] if fz[i, j] >= 0.0 else fill[i, j + 1]))
            DZ[i, j] -= missing * vz * cz_h[i, j]
            SZ[i, j] -= missing * cz[i, j]


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
        Gradients of (S_c, S_s, S_zc, S_zs), of C, and of the integrals over the slopes of gap terms, to (scaled pose, scaled rates, vx,
        vz).
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
