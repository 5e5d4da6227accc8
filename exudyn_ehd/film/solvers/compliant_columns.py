"""Kernels of the columns of an elastic liner: what presses on them, how far they give way, what they hold; see `exudyn_ehd.film.solvers.compliant`.

Symbols, all scaled: P unknown of the film, p the pressure that presses on the columns (P itself, or p(P) of an oil whose viscosity follows
its pressure), pc cavity pressure in P, beta compliance; G true gap, H the gap that the film sees, HF that on the links i -> i+1, D
deflection, E = H - (film gap of the undeformed surfaces). ``_P``, ``_r``, ``_fill``: derivatives to the unknown, to the undeformed gap, and
to the fill.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Columns(NamedTuple):
    """The state of every column of liner, (n, m) arrays.

    Attributes
    ----------
    H, HF, D, E : (n, m) arrays
        Film gap at vertices and on links, deflection, and what it adds to the film gap.
    H_P, D_P, H_r, D_r, E_r : (n, m) arrays
        Derivatives to the unknown and to the undeformed gap at fixed unknown.
    link : (n, m) array
        Derivative of HF to the true gap on the link.
    rate, rate_P, rate_r, rate_t : (n, m) arrays
        dH/dt with its derivatives to the unknown, the undeformed gap and the undeformed rate.
    """

    H: np.ndarray
    HF: np.ndarray
    D: np.ndarray
    E: np.ndarray
    H_P: np.ndarray
    D_P: np.ndarray
    H_r: np.ndarray
    D_r: np.ndarray
    E_r: np.ndarray
    link: np.ndarray
    rate: np.ndarray
    rate_P: np.ndarray
    rate_r: np.ndarray
    rate_t: np.ndarray


# Rows of the pressure on the columns (4, n, m): the unknown, no less than pc where a film clips; pressure there, with its two derivatives to
# the unknown, which are 1 and 0 for an oil of constant viscosity.
DRIVE, LOAD_P, SLOPE, BEND = 0, 1, 2, 3


@njit(cache=True)
def columns_of(fields):
    """`Columns` of their fields (14, n, m)."""
    f = fields
    return Columns(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9], f[10], f[11], f[12], f[13])


@njit(cache=True, fastmath=_FAST)
def drive_columns(P, fixed, pc, clips, load):
    """What drives the columns: the unknown, or where a film clips no less than pc; the pressure itself for an oil of constant viscosity."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            p = P[i, j]
            if clips and not fixed[i, j] and p < pc:
                p = pc
            load[DRIVE, i, j] = p
            load[LOAD_P, i, j] = p


@njit(cache=True, fastmath=_FAST)
def scale_load(load, scale):
    """Pressures (Pa) and their derivatives as an oil gives them, to the film's scale; returns the largest pressure, Pa."""
    _, n, m = load.shape
    largest = -np.inf
    for i in range(n):
        for j in range(m):
            p = load[LOAD_P, i, j]
            largest = max(largest, p)
            load[LOAD_P, i, j] = p / scale
            load[BEND, i, j] *= scale
    return largest


@njit(cache=True, fastmath=_FAST)
def press_columns(rigid, load, beta, G_out):
    """Gap under the film's pressure alone; returns the smallest."""
    _, n, m = load.shape
    smallest = np.inf
    for i in range(n):
        for j in range(m):
            g = rigid[0, i, j] + beta * load[LOAD_P, i, j]
            G_out[i, j] = g
            smallest = min(smallest, g)
    return smallest


@njit(cache=True, fastmath=_FAST)
def move_columns(rigid, G, delta_old, inverse, columns):
    """Deflections, and gaps and rate of the deformed surfaces, where a limiter may change them; returns the smallest gap of a link."""
    c = columns_of(columns)
    n, m = G.shape
    for i in range(n):
        for j in range(m):
            d = G[i, j] - rigid[0, i, j]
            c.D[i, j] = d
            c.H[i, j] = G[i, j]
            c.rate[i, j] = rigid[2, i, j] + (d - delta_old[i, j]) * inverse
    smallest = np.inf
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            h = rigid[1, i, j] + 0.5 * (c.D[i, j] + c.D[nxt, j])
            c.HF[i, j] = h
            smallest = min(smallest, h)
    return smallest


@njit(cache=True, fastmath=_FAST)
def gain_of_columns(columns, P, load, fill, rigid_film, area, times, mass_old, extra_old, conserves, beta, gain_out):
    """E of the columns, and what every vertex gains per time.

    ``times`` holds the rates (1/s) of mass_inverse, of whether the gap's own rate takes part (1 or 0), and of pseudo time.
    """
    c = columns_of(columns)
    n, m = P.shape
    mass_inverse, with_rate, extra = times[0], times[1], times[2]
    for i in range(n):
        for j in range(m):
            c.E[i, j] = c.H[i, j] - rigid_film[i, j]
    if conserves:
        pull = mass_inverse + extra
        for i in range(n):
            for j in range(m):
                f = fill[i, j]
                gain = f * (c.H[i, j] * pull + c.rate[i, j] * with_rate)
                gain_out[i, j] = area[i, j] * (gain - mass_old[i, j] * mass_inverse - extra_old[i, j] * extra)
        return
    for i in range(n):
        for j in range(m):
            gain_out[i, j] = area[i, j] * c.rate[i, j]
    if extra != 0.0:
        for i in range(n):
            for j in range(m):
                push = load[LOAD_P, i, j] + (P[i, j] - load[DRIVE, i, j])
                gain_out[i, j] += area[i, j] * extra * (beta * push - extra_old[i, j])


@njit(cache=True, fastmath=_FAST)
def answer_columns(
    columns, P, load, fill, rigid_slope, contact_G, bend, area, times, conserves, beta, inverse, gain_P, gain_fill
):  # fmt: skip
    """What columns and storage answer to unknown and undeformed gap, for film gaps, rate and their slope (``rate_t``) in ``columns``.

    ``contact_G`` is d(contact pressure)/dG over the film's scale, ``bend`` the film gap's second derivative times the gap's rate.
    """
    c = columns_of(columns)
    n, m = P.shape
    mass_inverse, with_rate, extra = times[0], times[1], times[2]
    for i in range(n):
        for j in range(m):
            follow = 1.0 / (1.0 - beta * contact_G[i, j])
            s = c.rate_t[i, j]
            cut = P[i, j] != load[DRIVE, i, j]
            d = 0.0 if cut else beta * follow * load[SLOPE, i, j]
            turn = bend[i, j] + s * inverse
            c.D_P[i, j] = d
            c.H_P[i, j] = s * d
            c.D_r[i, j] = follow - 1.0
            c.H_r[i, j] = s * follow
            c.E_r[i, j] = s * follow - rigid_slope[i, j]
            c.rate_P[i, j] = turn * d
            c.rate_r[i, j] = bend[i, j] * follow + s * inverse * (follow - 1.0)
            w = area[i, j]
            if conserves:
                pull = mass_inverse + extra
                gain_P[i, j] = w * fill[i, j] * (s * d * pull + turn * d * with_rate)
                gain_fill[i, j] = w * (c.H[i, j] * pull + c.rate[i, j] * with_rate)
            else:
                gain_P[i, j] = w * (turn * d + extra * beta * (1.0 if cut else load[SLOPE, i, j]))


@njit(cache=True, fastmath=_FAST)
def smallest_gap(columns):
    """Smallest gap that the film sees."""
    c = columns_of(columns)
    n, m = c.H.shape
    smallest = np.inf
    for i in range(n):
        for j in range(m):
            smallest = min(smallest, min(c.H[i, j], c.HF[i, j]))
    return smallest


@njit(cache=True, fastmath=_FAST)
def smallest_true_gap(rigid, columns):
    """Smallest gap of the deformed surfaces, at vertices and links."""
    c = columns_of(columns)
    n, m = c.D.shape
    smallest = np.inf
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            smallest = min(smallest, rigid[0, i, j] + c.D[i, j])
            smallest = min(smallest, rigid[1, i, j] + 0.5 * (c.D[i, j] + c.D[nxt, j]))
    return smallest
