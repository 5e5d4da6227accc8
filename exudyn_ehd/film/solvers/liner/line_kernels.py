"""The rupture line inside the cells in steps of Newton's method; see `exudyn_ehd.film.solvers.liner.line`.

Every balance looks where a vertex would meet its own one between the pressures of its neighbours, ``met`` with its s:
the tangent of N is taken there, where the pressure itself may be far from it or, on vertices that join, none. With an
older factor the same ``met`` is what a step leads to if the neighbours stay. Symbols of
`exudyn_ehd.film.cavitation.rupture_line`; ``line`` is (f, k, s, whole, shift, met), flat, and `NO_LINE` of a film that
has none: another type would have every kernel that is handed a line compiled twice.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.rupture_line import LEAST, line_terms
from exudyn_ehd.film.reynolds.links import add_squeeze, right_hand_side
from exudyn_ehd.film.solvers.newton import RULE

# Steps after which vertices no longer leave the film at once, since two may drive each other out and in again for ever;
# what is left of an s that would vanish. Steps after which pressures are the unknowns everywhere.
PATIENT, KEPT, SAFE = 8, 0.1, 25
NO_LINE = (np.empty(0),) * 6
# Gap over the clearance below which surfaces at the cavity's pressure touch: no line is looked for there.
TOUCHING = 1e-6


@njit(cache=True)
def is_there(line):
    """Whether a film has a line inside its cells."""
    return line[0].size > 0


@njit(cache=True)
def meet_line(P, pc, kx, kz, line, residual):
    """Subtract N from the balances, and find where every vertex would meet its own."""
    f, k, s, whole, _, met = line
    x, rest, along, across = P.reshape(-1), residual.reshape(-1), kx.reshape(-1), kz.reshape(-1)
    m = P.shape[1]
    for c in range(x.size):
        if not whole[c] > 0.0:
            continue
        p = x[c] - pc
        diagonal = max(along[c - m] + along[c] + across[c - 1] + across[c], 2.0 * k[c])
        known = diagonal * p - rest[c]
        excess = 0.5 + known / f[c]
        place = 2.0 * excess / (1.0 + np.sqrt(max(1.0 + 2.0 * (diagonal / k[c] - 1.0) * excess, 0.0)))
        if place >= 1.0:
            s[c], met[c] = 1.0, known / diagonal
        else:
            s[c] = max(place, 0.0)
            met[c] = whole[c] * s[c] * s[c]
        rest[c] -= _found(p, f[c], whole[c])


@njit(cache=True, inline="always")
def _found(p, f, whole):
    """N at the pressure p above the cavity's."""
    if p >= whole:
        return 0.0
    short = 1.0 - np.sqrt(max(p, 0.0) / whole)
    return 0.5 * f * short * short


@njit(cache=True)
def add_line(line, active, store):
    """Add the line's share to the diagonals, and keep it as that of the factor."""
    _, k, s, whole, shift, _ = line
    free = active.reshape(-1)
    for c in range(store.size):
        shift[c] = 0.0
        if free[c] and whole[c] > 0.0 and s[c] < 1.0:
            own = max(s[c], LEAST)
            shift[c] = k[c] * (1.0 - own) / own
            store[c] += shift[c]


@njit(cache=True)
def lean_to_line(P, pc, order, count, line, x):
    """From minus the balances (count,) to those with N's tangent where vertices meet theirs."""
    f, _, s, whole, shift, met = line
    pressures = P.reshape(-1)
    for r in range(count):
        c = order[r]
        if whole[c] > 0.0:
            p = pressures[c] - pc
            there = 0.5 * f[c] * (1.0 - s[c]) * (1.0 - s[c])
            x[r] -= _found(p, f[c], whole[c]) - there + shift[c] * (p - met[c])


@njit(cache=True)
def bend_to_line(P, pc, order, count, line, taken, x):
    """From steps (count,) of the tangents to those of the pressures, whose s goes along; ``taken``: steps before.

    Returns the largest change of an s times the root of the pressure that s = 1 makes: its square is what is left.
    """
    _, _, s, whole, _, met = line
    pressures = P.reshape(-1)
    kept, largest = KEPT if taken > PATIENT else 0.0, 0.0
    for r in range(count):
        c, own = order[r], s[order[r]]
        if not whole[c] > 0.0:
            continue
        p = pressures[c] - pc
        new = p + x[r]
        if own < 1.0 and taken <= SAFE:
            place = own + 0.5 * (new - met[c]) / (whole[c] * own) if own > 0.0 else 0.0
            place = max(place, kept * own)
            largest = max(largest, np.sqrt(2.0 * whole[c]) * min(abs(place - own), 1.0))
            new = whole[c] * place * place if place < 1.0 else max(new, whole[c])
        # what leaves must not be kept by rounding
        x[r] = new - p if new > 0.0 else -(1.0 + LEAST) * p
    return largest


@njit(cache=True)
def open_gaps(gap_fields, touching_out):
    """Links on which surfaces touch; gaps at vertices and links become at least as large as those."""
    H, HF, touching = gap_fields[0].reshape(-1), gap_fields[1].reshape(-1), touching_out.reshape(-1)
    for c in range(H.size):
        touching[c] = HF[c] < TOUCHING
        H[c], HF[c] = max(H[c], TOUCHING), max(HF[c], TOUCHING)


@njit(cache=True)
def see_line(
    gap_fields, terms, touching, b, squeeze, widths, fixed, density, liner, line_out, gaps_out, lean_out
):  # fmt: skip
    """f, k and s = 1 of a film that has the cavity's pressure everywhere, t of its liner (compliance, vx), its gaps."""
    (beta, vx), m, flat = liner, b.shape[1], b.reshape(-1)
    f, k, s, whole = line_out[0], line_out[1], line_out[2], line_out[3]
    H, HF, kx, shut = gap_fields[0].reshape(-1), gap_fields[1].reshape(-1), terms[0].reshape(-1), touching.reshape(-1)
    at_vertices, at_links, lean = gaps_out[0].reshape(-1), gaps_out[1].reshape(-1), lean_out.reshape(-1)
    right_hand_side(terms[2], terms[3], b)
    if squeeze:
        add_squeeze(gap_fields[4], widths[0], widths[1], b)
    for c in range(s.size):
        kx[c] = 0.0 if shut[c] else kx[c]
        flat[c] *= density
        at_vertices[c], at_links[c], s[c] = H[c], HF[c], 1.0
    line_terms(terms[0], b, fixed, True, line_out)
    for c in range(s.size):
        k[c] += 0.5 * beta * abs(vx) * widths[1][c % m]
        lean[c] = 0.0
        if f[c] > 0.0:
            t = beta * f[c] / (k[c] * (HF[c - m] + HF[c]))
            lean[c] = t
            f[c] /= 1.0 + t * t
            whole[c] = 0.5 * f[c] / k[c]


@njit(cache=True)
def is_factored(line):
    """Return whether the diagonals of a factor are those of the line's present places, to what tangents need."""
    k, s, shift = line[1], line[2], line[5]
    for c in range(s.size):
        place = max(s[c], LEAST)
        own = k[c] * (1.0 - place) / place if s[c] < 1.0 else 0.0
        if abs(shift[c] - own) > RULE.exact * (k[c] + own):
            return False
    return True


@njit(cache=True)
def _by_bare(t):
    """Derivative of f to what it is without a liner; its logarithmic derivative to k, which is that to the gap."""
    held = 1.0 / (1.0 + t * t)
    turned = 2.0 * (t * held) * (t * held)
    return held - turned, turned / held


@njit(cache=True)
def weigh_yielding(places, f, k, lean, weights):
    """From `RuptureLine.weights` (2, c) at ``places`` to those of a film on a liner."""
    sources, conductances, t = f.reshape(-1), k.reshape(-1), lean.reshape(-1)
    for q in range(places.size):
        c = places[q]
        by_f, turned = _by_bare(t[c])
        weights[1, q] -= weights[0, q] * turned * sources[c] / conductances[c]
        weights[0, q] *= by_f


@njit(cache=True)
def add_yielding(places, line, lean, HF, liner, by):
    """Add to `LineGradients.by` what follows from the liner's gap and from the speed that it is lifted by."""
    (beta, vx, width), gap, t, m = liner, HF.reshape(-1), lean.reshape(-1), HF.shape[1]
    f, k, s = line[0], line[1], line[2]
    for q in range(places.size):
        c = places[q]
        _, turned = _by_bare(t[c])
        short = 0.5 * (1.0 - s[c])
        by_gap = short * turned * f[c] / (gap[c - m] + gap[c])
        by[0, q] -= by_gap
        by[1, q] -= by_gap
        conduct = short * (s[c] - turned) * f[c] / k[c]
        by[6, q] += conduct * 0.5 * beta * np.sign(vx) * width[c % m]
