"""Derivatives of the film's balances at its unknowns, as a stencil for gaps whose links are the mean of their columns.

With the derivatives of every link's flow to its gap (symbols as in `exudyn_ehd.film.reynolds.link_derivatives`) the
balance of vertex (i, j) changes with the true gap by

    dr = DX_i dHF_i - DX_i-1 dHF_i-1 + DZ_j dHZ_j - DZ_j-1 dHZ_j-1 + AC dH + AR dH_t,   HF, HZ means over the two ends
    of a link.

An adjoint functional's gradient is ``-lam . dr``.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.link_derivatives import derivatives_of

_FAST = {"reassoc", "contract", "nsz", "arcp"}


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
def put_rows(shapes, place, weight, first, out):
    """Rows ``place`` of shapes (., k) times ``weight``, both (count,), to the columns from ``first`` on.

    ``out``: tiles (tiles, >= count, width).
    """
    k, wide, done = shapes.shape[1], out.shape[2], 0
    while done < k:
        tile = (first + done) // wide
        low = first + done - tile * wide
        size = min(wide - low, k - done)
        for r in range(place.size):
            own, target, w = shapes[place[r], done : done + size], out[tile, r, low : low + size], weight[r]
            for q in range(size):
                target[q] = w * own[q]
        done += size


@njit(cache=True, fastmath=_FAST)
def balance_change(motion, by_place, place, by_rate, change, moved, speed, out):
    """Change of the balances at the unknowns.

    Parameters
    ----------
    motion : (count, 10) array
        Derivatives to the motion, whose change is ``change`` (10,).
    by_place, place : (count, 5) arrays
        Stencil for displacements ``moved`` (n m,).
    by_rate : (count,) array
        Derivative to the own vertex's rate ``speed`` (n m,).
    out : (count,) array
    """
    for r in range(out.size):
        total = by_rate[r] * speed[place[r, 0]]
        for c in range(5):
            total += by_place[r, c] * moved[place[r, c]]
        for c in range(10):
            total += motion[r, c] * change[c]
        out[r] = total


@njit(cache=True, fastmath=_FAST)
def gap_slopes(field, width, z, link_out, slope_x_out, slope_z_out):
    """Mean on the links in theta and slopes of a field (n, m): central differences, one-sided at the ends of z.

    Second order inside on any spacing of z, first order at its ends, as numpy.gradient.
    """
    n, m = field.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            link_out[i, j] = 0.5 * (field[i, j] + field[nxt, j])
            slope_x_out[i, j] = (field[nxt, j] - field[prv, j]) / (2.0 * width)
        slope_z_out[i, 0] = (field[i, 1] - field[i, 0]) / (z[1] - z[0])
        slope_z_out[i, m - 1] = (field[i, m - 1] - field[i, m - 2]) / (z[m - 1] - z[m - 2])
        for j in range(1, m - 1):
            low, high = z[j] - z[j - 1], z[j + 1] - z[j]
            slope_z_out[i, j] = (
                low * low * field[i, j + 1] - high * high * field[i, j - 1] + (high * high - low * low) * field[i, j]
            ) / (low * high * (low + high))


@njit(cache=True, fastmath=_FAST)
def transposed_slopes(field, width, z, along_x_out, along_z_out):
    """Fields whose products with any gap term are those of ``field`` with its slopes of `gap_slopes`."""
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
def add_gap(field, rate, width, z, H, HF, H_t, slope_x_out, slope_z_out):
    """Add an elastic gap (n, m) and its rate to the gaps and their rate; its slopes as in `gap_slopes`.

    Returns the smallest gap.
    """
    n, m = field.shape
    link = np.empty((n, m))
    gap_slopes(field, width, z, link, slope_x_out, slope_z_out)
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


@njit(cache=True, fastmath=_FAST)
def spread_gradient(tiles, by_bore, weights, direct, scale, motion_scale, motion_out, bore_out):
    """Rows of the tangent of an elastic film from the gradients of its r integrals and k loads of the bore.

    Parameters
    ----------
    tiles : (tiles, 10, width) array
        Minus gradients of integrals and loads to the motion; only those of the loads are wanted.
    by_bore : (r + k, k) array
        Gradients of integrals and loads to the bore.
    weights, direct : (6, r), (6, k) arrays
        Integrals in the wrench; gradient of the wrench to the bore at fixed pressure.
    scale, motion_scale : float, (10,) array
        Units of the loads and of the motion.
    motion_out, bore_out : (k, 10), (6 + k, k) arrays
        Gradients of the loads to the motion; of wrench and loads to the bore.
    """
    r, k, width = weights.shape[1], direct.shape[1], tiles.shape[2]
    for a in range(k):
        tile, q = (r + a) // width, (r + a) % width
        own, target = by_bore[r + a], bore_out[6 + a]
        for c in range(10):
            motion_out[a, c] = -scale * motion_scale[c] * tiles[tile, c, q]
        for b in range(k):
            target[b] = scale * own[b]
    for i in range(6):
        for b in range(k):
            bore_out[i, b] = direct[i, b]
        for c in range(r):
            w = weights[i, c]
            if w != 0.0:
                for b in range(k):
                    bore_out[i, b] += w * by_bore[c, b]
