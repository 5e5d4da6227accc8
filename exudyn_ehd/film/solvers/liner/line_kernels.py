"""Kernels of the rupture line inside the cells of a film on a liner; see `exudyn_ehd.film.solvers.liner.line`."""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.rupture_line import line_terms
from exudyn_ehd.film.reynolds.links import add_squeeze, right_hand_side

# Gap over the clearance below which surfaces at the cavity's pressure touch: no line is looked for there.
TOUCHING = 1e-6


@njit(cache=True)
def open_gaps(gap_fields, touching_out):
    """Mark links on which surfaces touch, and enlarge gaps at vertices and links to `TOUCHING` at least."""
    H, HF, touching = gap_fields[0].reshape(-1), gap_fields[1].reshape(-1), touching_out.reshape(-1)
    for c in range(H.size):
        touching[c] = HF[c] < TOUCHING
        H[c], HF[c] = max(H[c], TOUCHING), max(HF[c], TOUCHING)


@njit(cache=True)
def see_line(
    gap_fields, terms, touching, b, squeeze, widths, fixed, density, liner, line_out, gaps_out, lean_out
):  # fmt: skip
    """Set f, k and s = 1 of a film at the cavity pressure everywhere, t (``lean_out``) of its liner, and its gaps.

    ``liner``: (compliance, vx); ``touching``: of `open_gaps`.
    """
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
def _by_bare(t):
    """Return df / d(f without a liner), and d(ln f) / d(ln k), which is also d(ln f) / d(ln h)."""
    held = 1.0 / (1.0 + t * t)
    turned = 2.0 * (t * held) * (t * held)
    return held - turned, turned / held


@njit(cache=True)
def weigh_yielding(places, f, k, lean, weights):
    """Convert `RuptureLine.weights` (2, c) at ``places`` to those of a film on a liner, in place."""
    sources, conductances, t = f.reshape(-1), k.reshape(-1), lean.reshape(-1)
    for q in range(places.size):
        c = places[q]
        by_f, turned = _by_bare(t[c])
        weights[1, q] -= weights[0, q] * turned * sources[c] / conductances[c]
        weights[0, q] *= by_f


@njit(cache=True)
def add_yielding(places, line, lean, HF, liner, by):
    """Add to `LineGradients.by` the derivatives through t to the gap, and through the liner's conductance to vx."""
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
