"""Kernels of the columns of an elastic liner: what presses on them, how far they give way, what they hold; see `exudyn_ehd.film.compliant`.

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


class Load(NamedTuple):
    """The film's pressure on the columns, (n, m) arrays.

    Attributes
    ----------
    drive : (n, m) array
        The unknown; no less than pc where a film clips.
    p, slope, bend : (n, m) arrays
        Pressure at ``drive`` with its two derivatives to it: 1 and 0 for an oil of constant viscosity.
    """

    drive: np.ndarray
    p: np.ndarray
    slope: np.ndarray
    bend: np.ndarray


class Storage(NamedTuple):
    """What a control volume's content gains per time, with its derivatives to unknown and fill, (n, m) arrays."""

    gain: np.ndarray
    gain_P: np.ndarray
    gain_fill: np.ndarray


@njit(cache=True, fastmath=_FAST)
def drive_columns(P, fixed, pc, clips, drive_out):
    """What drives the columns: the unknown, or where a film clips no less than pc."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            p = P[i, j]
            drive_out[i, j] = pc if clips and not fixed[i, j] and p < pc else p


@njit(cache=True, fastmath=_FAST)
def press_columns(rigid, p, beta, G_out):
    """Gap under the film's pressure alone."""
    n, m = p.shape
    for i in range(n):
        for j in range(m):
            G_out[i, j] = rigid[0, i, j] + beta * p[i, j]


@njit(cache=True, fastmath=_FAST)
def move_columns(rigid, G, delta_old, inverse, c):
    """Deflections, and gaps and rate of the deformed surfaces, into ``c`` (Columns), where a limiter may change them."""
    n, m = G.shape
    for i in range(n):
        for j in range(m):
            d = G[i, j] - rigid[0, i, j]
            c.D[i, j] = d
            c.H[i, j] = G[i, j]
            c.rate[i, j] = rigid[2, i, j] + (d - delta_old[i, j]) * inverse
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            c.HF[i, j] = rigid[1, i, j] + 0.5 * (c.D[i, j] + c.D[nxt, j])


@njit(cache=True, fastmath=_FAST)
def answer_columns(rigid_film, rigid_slope, P, load, contact_G, bend, beta, inverse, c):
    """What the columns answer to unknown and undeformed gap, for film gaps, rate and their slope (``c.rate_t``) in ``c`` (Columns).

    ``contact_G`` is d(contact pressure)/dG over the film's scale, ``bend`` the film gap's second derivative times the gap's rate.
    """
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            follow = 1.0 / (1.0 - beta * contact_G[i, j])
            s = c.rate_t[i, j]
            c.E[i, j] = c.H[i, j] - rigid_film[i, j]
            c.D_P[i, j] = beta * follow * load.slope[i, j] if P[i, j] == load.drive[i, j] else 0.0
            c.H_P[i, j] = s * c.D_P[i, j]
            c.D_r[i, j] = follow - 1.0
            c.H_r[i, j] = s * follow
            c.E_r[i, j] = c.H_r[i, j] - rigid_slope[i, j]
            c.rate_P[i, j] = (bend[i, j] + s * inverse) * c.D_P[i, j]
            c.rate_r[i, j] = bend[i, j] * follow + s * inverse * c.D_r[i, j]


@njit(cache=True, fastmath=_FAST)
def set_storage(c, P, load, fill, area, mass_old, mass_inverse, with_rate, extra, extra_old, conserves, beta, out):
    """Storage ``out`` of every vertex: of the mass fill H over a step, of the gap's rate, and of pseudo time (``extra``)."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            w = area[i, j]
            f = fill[i, j]
            if conserves:
                pull = mass_inverse + extra
                mass = f * c.H[i, j]
                gain = mass * pull - mass_old[i, j] * mass_inverse - extra_old[i, j] * extra
                by_p = f * c.H_P[i, j] * pull
                by_fill = c.H[i, j] * pull
                if with_rate:
                    gain += f * c.rate[i, j]
                    by_p += f * c.rate_P[i, j]
                    by_fill += c.rate[i, j]
                out.gain[i, j], out.gain_P[i, j], out.gain_fill[i, j] = w * gain, w * by_p, w * by_fill
            elif extra == 0.0:
                out.gain[i, j] = w * c.rate[i, j]
                out.gain_P[i, j] = w * c.rate_P[i, j]
            else:
                # what is cut off counts as it stands
                cut = P[i, j] - load.drive[i, j]
                slope = load.slope[i, j] if cut == 0.0 else 1.0
                out.gain[i, j] = w * (c.rate[i, j] + extra * (beta * (load.p[i, j] + cut) - extra_old[i, j]))
                out.gain_P[i, j] = w * (c.rate_P[i, j] + extra * beta * slope)
