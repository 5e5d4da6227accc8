"""The plain film's way from adjoint solutions to the journal's motion in one sweep, without fields in between.

Does the same as `reynolds.link_flow_sensitivity`, `reynolds.speed_sensitivity`, the storage term and `gap.contract_pose` one after the other,
which remain the way for films with effects.
"""

from __future__ import annotations

from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def plain_pose_gradient(
    lam, P, H, HF, cos_x, sin_x, cos_f, sin_f, z, vx, vz, flow_x, squeeze, width_x, width_z, link_x, link_z, out
):  # fmt: skip
    """Gradients of k adjoint functionals to (scaled pose, scaled rates, vx, vz).

    Parameters
    ----------
    lam : (k, n, m) array
        Adjoint solutions.
    P, H, HF : (n, m) arrays
        Pressure that solves the linear problem, gap at vertices and links.
    squeeze : float
        1 with the storage term, 0 without.
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
            linked = 1.0 if link_x[i] != 0.0 else 0.0
            lx = 3.0 * link_x[i] * flow_x
            a = lam[k, i]
            b = lam[k, nxt]
            pa = P[i]
            pb = P[nxt]
            hf = HF[i]
            f0 = 0.0
            f1 = 0.0
            r0 = 0.0
            r1 = 0.0
            for j in range(m):
                d = (a[j] - b[j]) * width_z[j]
                g = d * (linked * vx - lx * hf[j] * hf[j] * (pb[j] - pa[j]))
                f0 += g
                f1 += g * z[j]
                sx -= linked * d * hf[j]
                w = a[j] * width_z[j]
                r0 += w
                r1 += w * z[j]
            c0 = 0.0
            c1 = 0.0
            h = H[i]
            wx = width_x[i]
            for j in range(m - 1):
                hz = 0.5 * (h[j] + h[j + 1])
                d = (a[j] - a[j + 1]) * wx
                g = 0.5 * d * (vz - 3.0 * hz * hz * link_z[j] * (pa[j + 1] - pa[j]))
                c0 += 2.0 * g
                c1 += g * (z[j] + z[j + 1])
                sz -= d * hz
            # dH/d(x, y, bx, by) = -(cos, sin, z cos, z sin); the functionals' gradients are -lam . dr
            out[k, 0] += f0 * cos_f[i] + c0 * cos_x[i]
            out[k, 1] += f0 * sin_f[i] + c0 * sin_x[i]
            out[k, 2] += f1 * cos_f[i] + c1 * cos_x[i]
            out[k, 3] += f1 * sin_f[i] + c1 * sin_x[i]
            r0 *= wx * squeeze
            r1 *= wx * squeeze
            out[k, 4] += r0 * cos_x[i]
            out[k, 5] += r0 * sin_x[i]
            out[k, 6] += r1 * cos_x[i]
            out[k, 7] += r1 * sin_x[i]
        out[k, 8] = sx
        out[k, 9] = sz
