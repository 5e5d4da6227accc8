"""Derivatives of the balances and of the wrench to the motion of a rigid journal and to an elastic bore.

The gradient of an adjoint functional is ``-lam . dr``. `exudyn_ehd.film.reynolds.link_derivatives` followed by
`exudyn_ehd.film.reynolds.gap.contract_pose` gives the same through fields (n, m), which elastic bores need.

Derivatives of the film's balances at its unknowns, as a stencil for gaps whose links are the mean of their columns.

With the derivatives of every link's flow to its gap (symbols as in `exudyn_ehd.film.reynolds.link_derivatives`) the
balance of vertex (i, j) changes with the true gap by

    dr = DX_i dHF_i - DX_i-1 dHF_i-1 + DZ_j dHZ_j - DZ_j-1 dHZ_j-1 + AC dH + AR dH_t,   HF, HZ means over the two ends
    of a link.

An adjoint functional's gradient is ``-lam . dr``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.grid import Directions
from exudyn_ehd.film.reynolds.link_derivatives import derivatives_of

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def motion_columns(order, count, d, slope, AR, AC, at, out):
    """Derivatives of the balances at the unknowns to (scaled pose, scaled rates, vx, vz).

    The gap is ``-(x + z bx) cos - (y + z by) sin``, on links in theta with the true angle.

    Parameters
    ----------
    order, count
        Flat vertices of the unknowns.
    d : (5, n, m) array
        As for `derivatives_of`, DX already by the true gap.
    slope : (n, m) array
        d(film gap)/d(true gap) at the vertices; ones without a limiter.
    AR, AC : (n, m) arrays
        Derivative of a vertex's balance through its storage, with respect to the true gap's rate and to the true gap.
    at : tuple of arrays
        `Directions`.
    out : (10, count) array
    """
    n, m = slope.shape
    DX, DZ, SX, SZ, SZX = derivatives_of(d.reshape(5, n * m))
    low, high, s = np.empty(n * m), np.empty(n * m), slope.reshape(-1)
    for c in range(low.size):
        low[c] = 0.5 * DZ[c] * s[c]
    for c in range(high.size - 1):
        high[c] = 0.5 * DZ[c] * s[c + 1]
    rate, gap = AR.reshape(-1), AC.reshape(-1)
    columns_of_links(order, count, m, DX, None, (low, high), (SX, SZX, SZ), (rate, gap), at, out)


@njit(cache=True, fastmath=_FAST)
def columns_of_links(order, count, m, face, along, across, by_speed, storage, at, out):
    """`motion_columns` for links of any kind; fields are flat (n m,).

    Parameters
    ----------
    face : field
        Derivative of the flow in theta to the gap on the link.
    along : two fields or None
        Of the flow in theta to the gaps at the link's ends; None: it does not know them.
    across : two fields
        Of the flow in z to the gaps at the link's ends.
    by_speed : three fields
        Of the flow in theta to vx, in z to vx and to vz.
    storage : two fields
        Of the storage to the gap's rate and to the gap.
    """
    at = Directions(*at)
    z, n, (rate, gap) = at.z, at.cos_x.size, storage
    i = nxt = prv = 0
    for r in range(count):
        j = order[r] - i * m
        if r == 0 or j < 0 or j >= m:  # rows of a column follow each other: one division per column
            i = order[r] // m
            j = order[r] - i * m
            prv = i - 1 if i > 0 else n - 1
            nxt = i + 1 if i + 1 < n else 0
        # flat unsigned indices need no check of their sign
        c, back = np.uint64(order[r]), np.uint64(prv * m + j)
        own = gap[c]
        x = face[c] * at.cos_f[i] - face[back] * at.cos_f[prv]
        y = face[c] * at.sin_f[i] - face[back] * at.sin_f[prv]
        if along is not None:
            own += along[0][c] - along[1][back]
            x += along[1][c] * at.cos_x[nxt] - along[0][back] * at.cos_x[prv]
            y += along[1][c] * at.sin_x[nxt] - along[0][back] * at.sin_x[prv]
        tilt = own * z[j]
        vx = by_speed[0][c] - by_speed[0][back]
        vz = 0.0
        if j + 1 < m:
            here, there = across[0][c], across[1][c]
            own += here + there
            tilt += here * z[j] + there * z[j + 1]
            vx += by_speed[1][c]
            vz += by_speed[2][c]
        if j > 0:
            low = c - np.uint64(1)
            there, here = across[0][low], across[1][low]
            own -= here + there
            tilt -= there * z[j - 1] + here * z[j]
            vx -= by_speed[1][low]
            vz -= by_speed[2][low]
        cos, sin, v = at.cos_x[i], at.sin_x[i], rate[c]
        out[0, r] = -(x + own * cos)
        out[1, r] = -(y + own * sin)
        out[2, r] = -(x * z[j] + tilt * cos)
        out[3, r] = -(y * z[j] + tilt * sin)
        out[4, r] = -v * cos
        out[5, r] = -v * sin
        out[6, r] = -v * cos * z[j]
        out[7, r] = -v * sin * z[j]
        out[8, r] = vx
        out[9, r] = vz


@njit(cache=True, fastmath=_FAST)
def functional_gradients(lam, columns, out):
    """Gradients ``-lam . dr`` (k, 10) of adjoint functionals lam (k, count), from `motion_columns` (10, count)."""
    for k in range(lam.shape[0]):
        own = lam[k]
        for q in range(columns.shape[0]):
            column, total = columns[q], 0.0
            for r in range(own.size):
                total -= own[r] * column[r]
            out[k, q] = total


@njit(cache=True)
def wrench_gradient(ds, dc, extra, ends, pose, sums, pose_scale, R, force, shear, omega, w, couette, out):
    """d wrench / d motion (6, 10) in SI units from the gradients of the integrals of `exudyn_ehd.film.loads`.

    Parameters
    ----------
    ds, dc, extra : (4, 10), (10,), (2, 10) arrays
        Gradients of (S_c, S_s, S_zc, S_zs), of C, and of the integrals over the slopes of gap terms, to (scaled pose,
        scaled rates, vx, vz).
    ends : (2, 4) array
        Gradients of the pressure force of the ends, and of an arc's edges, to the scaled pose.
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
            out[2, q] += 6.0 * shear * R * ends[0, q]
            out[5, q] += 6.0 * shear * R * R * ends[1, q]
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


@njit(cache=True)
def gap_stencil(order, count, d, slope, AR, AC, by_gap, by_rate, weight_out, place_out):
    """Rows of ``by_gap dr/dH + by_rate dr/dH_t`` at the unknowns for elastic gaps.

    Parameters
    ----------
    order, count
        Flat vertices of the unknowns.
    d, slope, AR, AC : (5, n, m) array, (n, m) arrays
        As `gap_derivatives` returns them.
    by_gap, by_rate : float
        Factors.
    weight_out, place_out : (count, 5) float and int arrays
        Weight and flat vertex: itself, next and last in theta, next and last in z.
    """
    n, m = slope.shape
    DX, DZ, _, _, _ = derivatives_of(d)
    for r in range(count):
        i = order[r] // m
        j = order[r] - i * m
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        place_out[r, 0] = order[r]
        place_out[r, 1] = nxt * m + j
        place_out[r, 2] = prv * m + j
        weight_out[r, 1] = 0.5 * by_gap * DX[i, j]
        weight_out[r, 2] = -0.5 * by_gap * DX[prv, j]
        own = 0.5 * (DX[i, j] - DX[prv, j]) + AC[i, j]
        for q in range(3, 5):
            weight_out[r, q] = 0.0
            place_out[r, q] = order[r]
        if j + 1 < m:
            own += 0.5 * DZ[i, j] * slope[i, j]
            weight_out[r, 3] = 0.5 * by_gap * DZ[i, j] * slope[i, j + 1]
            place_out[r, 3] = order[r] + 1
        if j > 0:
            own -= 0.5 * DZ[i, j - 1] * slope[i, j]
            weight_out[r, 4] = -0.5 * by_gap * DZ[i, j - 1] * slope[i, j - 1]
            place_out[r, 4] = order[r] - 1
        weight_out[r, 0] = by_gap * own + by_rate * AR[i, j]


@njit(cache=True, fastmath=_FAST)
def sum_rows(weight, place, fields, out):
    """Sums (count, r) of the rows ``place`` of fields (., r) times ``weight``, both (count, s)."""
    for r in range(out.shape[0]):
        target = out[r]
        for q in range(target.size):
            target[q] = 0.0
        for c in range(place.shape[1]):
            own, w = fields[place[r, c]], weight[r, c]
            for q in range(target.size):
                target[q] += w * own[q]


@njit(cache=True, fastmath=_FAST)
def gap_slopes(field, width, links, z, link_out, slope_x_out, slope_z_out):
    """Mean on the links in theta and slopes of a field (n, m): central differences, one-sided at the ends of z and at
    columns without a link.

    Second order inside on any spacing of z, first order at its ends, as numpy.gradient. ``width`` and ``links`` (n,):
    `FilmGrid.width_x` and `FilmGrid.link_x`; behind a column without a link its own values stand for the next ones.
    """
    n, m = field.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        prv = prv if links[prv] != 0.0 else i
        nxt = i + 1 if i + 1 < n else 0
        nxt = nxt if links[i] != 0.0 else i
        inverse = 1.0 / (2.0 * width[i])
        for j in range(m):
            link_out[i, j] = 0.5 * (field[i, j] + field[nxt, j])
            slope_x_out[i, j] = (field[nxt, j] - field[prv, j]) * inverse
        slope_z_out[i, 0] = (field[i, 1] - field[i, 0]) / (z[1] - z[0])
        slope_z_out[i, m - 1] = (field[i, m - 1] - field[i, m - 2]) / (z[m - 1] - z[m - 2])
        for j in range(1, m - 1):
            low, high = z[j] - z[j - 1], z[j + 1] - z[j]
            slope_z_out[i, j] = (
                low * low * field[i, j + 1] - high * high * field[i, j - 1] + (high * high - low * low) * field[i, j]
            ) / (low * high * (low + high))


@njit(cache=True, fastmath=_FAST)
def transposed_slopes(field, width, z, along_x_out, along_z_out):
    """Fields whose products with any gap term are those of ``field`` with its slopes of `gap_slopes` on a ring of
    columns of one ``width``."""
    n, m = field.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            along_x_out[i, j] = (field[prv, j] - field[nxt, j]) / (2.0 * width)
            along_z_out[i, j] = 0.0
        first, last = field[i, 0] / (z[1] - z[0]), field[i, m - 1] / (z[m - 1] - z[m - 2])
        along_z_out[i, 0] -= first
        along_z_out[i, 1] += first
        along_z_out[i, m - 2] -= last
        along_z_out[i, m - 1] += last
        for j in range(1, m - 1):
            low, high = z[j] - z[j - 1], z[j + 1] - z[j]
            share = field[i, j] / (low * high * (low + high))
            along_z_out[i, j + 1] += low * low * share
            along_z_out[i, j - 1] -= high * high * share
            along_z_out[i, j] += (high * high - low * low) * share


@njit(cache=True, fastmath=_FAST)
def add_gap(field, rate, width, links, z, H, HF, H_t, slope_x_out, slope_z_out):
    """Add an elastic gap (n, m) and its rate to the gaps and their rate; its slopes as in `gap_slopes`.

    Returns the smallest gap.
    """
    n, m = field.shape
    link = np.empty((n, m))
    gap_slopes(field, width, links, z, link, slope_x_out, slope_z_out)
    smallest = np.inf
    for i in range(n):
        for j in range(m):
            H[i, j] += field[i, j]
            HF[i, j] += link[i, j]
            H_t[i, j] += rate[i, j]
            smallest = min(smallest, H[i, j], HF[i, j])
    return smallest


@njit(cache=True, fastmath=_FAST)
def shear_fields(P, weight, width, z, couette, ends, factors, out):
    """Combinations (2, n, m) of the fields that shear owes to an elastic gap.

    Parameters
    ----------
    P, weight : (n, m) arrays
        Pressure and integration weights: slopes of the gap act on their product.
    couette, ends : (n, m) arrays
        Gradients of the Couette shear and of the ends' pressure force to the gap.
    factors : (2, 4) array
        Of couette, slopes in theta, slopes in z, ends.
    """
    n, m = P.shape
    along_x, along_z = np.empty((n, m)), np.empty((n, m))
    transposed_slopes(P * weight, width, z, along_x, along_z)
    for r in range(2):
        a, b, c, d = factors[r, 0], factors[r, 1], factors[r, 2], factors[r, 3]
        for i in range(n):
            for j in range(m):
                out[r, i, j] = a * couette[i, j] + b * along_x[i, j] + c * along_z[i, j] + d * ends[i, j]
