"""From adjoint solutions to the motion of a rigid journal in one sweep, and from the load integrals to its wrench.

One pass over each adjoint contracts the derivatives of the links' flows with the pose. It gives the same as
`exudyn_ehd.film.reynolds.link_derivatives.contract_links` and `exudyn_ehd.film.reynolds.gap.contract_pose` one after
the other, without the fields, which elastic bores want.
"""

from __future__ import annotations

from numba import njit

from exudyn_ehd.film.grid import Directions
from exudyn_ehd.film.reynolds.link_derivatives import derivatives_of

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def pose_gradient(lam, d, slope, AR, AC, at, out):
    """Gradients of k adjoint functionals to (scaled pose, scaled rates, vx, vz).

    Parameters
    ----------
    lam : (k, n, m) array
        Adjoint solutions.
    d : (5, n, m) array
        `LinkDerivatives`, DX already by the true gap.
    slope : (n, m) array
        d(film gap)/d(true gap) at the vertices; ones without a limiter.
    AR, AC : (n, m) arrays
        Derivative of a vertex's balance through its storage, with respect to the true gap's rate and to the true gap.
    at : tuple of arrays
        `Directions`.
    out : (k, 10) array
        Overwritten.
    """
    count, n, m = lam.shape
    DX, DZ, SX, SZ, SZX = derivatives_of(d)
    at = Directions(*at)
    z = at.z
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
                drop = a[j] - b[j]
                g = drop * DX[i, j]
                f0 += g
                f1 += g * z[j]
                sx -= drop * SX[i, j]
                w = a[j] * AR[i, j]
                r0 += w
                r1 += w * z[j]
                w = a[j] * AC[i, j]
                c0 += w
                c1 += w * z[j]
            for j in range(m - 1):
                drop = a[j] - a[j + 1]
                g = 0.5 * drop * DZ[i, j]
                c0 += g * (slope[i, j] + slope[i, j + 1])
                c1 += g * (slope[i, j] * z[j] + slope[i, j + 1] * z[j + 1])
                sz -= drop * SZ[i, j]
                sx -= drop * SZX[i, j]
            # dH/d(x, y, bx, by) = -(cos, sin, z cos, z sin); the functionals' gradients are -lam . dr
            out[k, 0] += f0 * at.cos_f[i] + c0 * at.cos_x[i]
            out[k, 1] += f0 * at.sin_f[i] + c0 * at.sin_x[i]
            out[k, 2] += f1 * at.cos_f[i] + c1 * at.cos_x[i]
            out[k, 3] += f1 * at.sin_f[i] + c1 * at.sin_x[i]
            out[k, 4] += r0 * at.cos_x[i]
            out[k, 5] += r0 * at.sin_x[i]
            out[k, 6] += r1 * at.cos_x[i]
            out[k, 7] += r1 * at.sin_x[i]
        out[k, 8] = sx
        out[k, 9] = sz


@njit(cache=True)
def wrench_gradient(ds, dc, extra, ends, pose, sums, pose_scale, R, force, shear, omega, w, couette, out):
    """d wrench / d motion (6, 10) in SI units from the gradients of the integrals of `exudyn_ehd.film.loads`.

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


@njit(cache=True)
def integral_weights(pose, R, force, shear, omega, w, out):
    """Weights (6, 8) of (S_c, S_s, S_zc, S_zs, C, slopes in theta and z, ends' force) in the wrench.

    Symbols as in `wrench_gradient`.
    """
    x, y, bx, by = pose[0], pose[1], pose[2], pose[3]
    out[:] = 0.0
    out[0, 0] = out[1, 1] = -force
    out[3, 3], out[4, 2] = force * R, -force * R
    axial, turning = -6.0 * shear * R, -6.0 * shear * R * R
    out[2, 0], out[2, 1], out[2, 4], out[2, 6], out[2, 7] = -axial * bx, -axial * by, -shear * w, -axial, -axial
    out[5, 0], out[5, 1], out[5, 2], out[5, 3] = -turning * y, turning * x, -turning * by, turning * bx
    out[5, 4], out[5, 5] = -shear * R * R * omega, -turning
