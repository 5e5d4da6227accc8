"""Parts of a step of `exudyn_ehd.film.cavitation.swift_stieber`: joining vertices, factor, new state.

Symbols as there and in `exudyn_ehd.film.cavitation.rupture_line`; pressures are those above the cavity's.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.ldl import assemble_band, factor_band
from exudyn_ehd.film.cavitation.states import ROUNDING
from exudyn_ehd.film.reynolds.links import lacks

# s that a vertex starts from whose pressure says nothing of it.
START = 1e-3


@njit(cache=True)
def join_film(links, line, active, lack, p):
    """Vertices at which oil piles up join the film; returns their number. ``lack`` (n, m) of `lacks`, in and out.

    At the line they meet their own balances between given neighbours: ``g s^2 / 2 + s = e``.
    """
    kx, kz, rest, free, m = links[0].reshape(-1), links[1].reshape(-1), lack.reshape(-1), active.reshape(-1), p.shape[1]
    f, k, s, whole, limit = line[0], line[1], line[2], line[3], line[4]
    pressures, joined = p.reshape(-1), 0
    for c in range(rest.size):
        if (rest[c] < limit[c]) | free[c]:
            continue
        joined += 1
        free[c] = True
        if f[c] > 0.0:
            excess, g = 0.5 + rest[c] / f[c], (kx[c - m] + kx[c] + kz[c - 1] + kz[c]) / k[c] - 1.0
            s[c] = min(2.0 * excess / (1.0 + np.sqrt(1.0 + 2.0 * g * excess)), 1.0)
            pressures[c] = whole[c] * s[c] * s[c]
    if joined > 0:
        lacks(links, p, lack)
    return joined


@njit(cache=True)
def line_rows(lack, line, order, count, rhs_out):
    """Write the lack of the unknowns' balances (count,) with the line, and its share of their diagonals."""
    rest, f, k, s, share = lack.reshape(-1), line[0], line[1], line[2], line[6]
    for r in range(count):
        c = order[r]
        short = 1.0 - s[c]
        rhs_out[r] = rest[c] + 0.5 * f[c] * short * short
        share[r] = k[c] * short / s[c]


@njit(cache=True)
def factor_line(links, line, factor, count, width, first, kept):
    """Assemble and factor from the first row that changes, which is ``first`` or whose s does, by more than ``kept``
    of itself.

    Returns whether there is a factor, and the largest change over s that it does not know of.
    """
    kx, kz, _ = links
    order, _, number, band, inv_diag = factor
    k, s, shift, share = line[1], line[2], line[5], line[6]
    row, stale = 0, 0.0
    while row < first:
        if share[row] != shift[row]:
            c = order[row]
            over_s = abs(1.0 - k[c] / ((k[c] + shift[row]) * s[c]))
            if over_s > kept:
                break
            stale = max(stale, over_s)
        row += 1
    first = min(first, row - row % 4)
    assemble_band(kx, kz, number, order, count, width, first, band)
    for r in range(first, count):
        band[r, 0] += share[r]
        shift[r] = share[r]
    return factor_band(band, count, width, first, inv_diag), stale


@njit(cache=True)
def move_film(line, order, count, steps, active, p):
    """Take a step.

    Returns
    -------
    in_line, in_film : float
        Largest change of an s, and of a pressure over the peak.
    stale : float
        Largest change of an s since the factor, over s.
    left : int
        Number of vertices that leave the film.
    """
    k, s, whole, shift, pressures, free = line[1], line[2], line[3], line[5], p.reshape(-1), active.reshape(-1)
    in_line = stale = largest = peak = lowest = 0.0
    left = 0
    for r in range(count):
        c = order[r]
        own, new = s[c], pressures[c] + steps[r]
        if own < 1.0:
            place = own + 0.5 * steps[r] / (whole[c] * own)
        else:
            # the line comes into reach
            place = np.sqrt(max(new, 0.0) / whole[c]) if 0.0 < whole[c] > new else 1.0
        if not place > 0.0:
            free[c], s[c], pressures[c] = False, 1.0, 0.0
            left += 1
            continue
        if place < 1.0:
            new = whole[c] * place * place
        elif own < 1.0:
            place, new = 1.0, max(new, whole[c])
        if min(own, place) < 1.0:
            stale = max(stale, abs(1.0 - k[c] / ((k[c] + shift[r]) * place)))
            in_line = max(in_line, abs(place - own))
            s[c] = place
        largest, peak, lowest = max(largest, abs(new - pressures[c])), max(peak, new), min(lowest, new)
        pressures[c] = new
    if lowest < -ROUNDING * peak:
        for r in range(count):
            c = order[r]
            if pressures[c] < -ROUNDING * peak and free[c]:
                free[c] = False
                pressures[c] = 0.0
                left += 1
    return in_line, largest / peak if peak > 0.0 else 0.0, stale, left


@njit(cache=True)
def place_line(line, fixed, active, p):
    """s of all vertices from the last film's, or from their pressures."""
    s, whole, known, free, pressures = line[2], line[3], fixed.reshape(-1), active.reshape(-1), p.reshape(-1)
    for c in range(s.size):
        own = s[c]
        s[c] = 1.0
        if known[c]:
            free[c] = False
        elif not free[c]:
            pressures[c] = 0.0
        elif whole[c] > 0.0 and (own < 1.0 or pressures[c] < whole[c]):
            if not own < 1.0:
                own = np.sqrt(max(pressures[c], 0.0) / whole[c])
            s[c] = max(own, START)
            pressures[c] = whole[c] * s[c] * s[c]
