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
