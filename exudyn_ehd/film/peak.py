"""Largest pressure of a film, between its vertices too."""

from __future__ import annotations

from numba import njit


@njit(cache=True)
def refined_peak(P, fixed, x, z, periodic):
    """Peak of P (n, m) with its x and z, from parabolas through the largest vertex and its neighbours in x and in z.

    At a vertex whose pressure is prescribed (``fixed``, (n, m)), of a supply area or an end, the pressure has a kink:
    there the peak is the vertex itself. Beside one, from which the pressure may fall steeply, a parabola overshoots;
    there it may rise above the vertex by a quarter of the smaller drop to its neighbours.
    """
    n, m = P.shape
    i, j = 0, 0
    for r in range(n):
        for c in range(m):
            if P[r, c] > P[i, j]:
                i, j = r, c
    value = P[i, j]
    rise_x = rise_z = shift_x = shift_z = 0.0
    if fixed[i, j]:
        return value, x[i], z[j]
    if periodic or 0 < i < n - 1:
        step, nxt = (x[1] - x[0] if n > 1 else 1.0), (i + 1) % n
        before, after = P[i - 1, j], P[nxt, j]
        rise_x, shift_x = _crest(before, value, after, step, step)
        if fixed[i - 1, j] or fixed[nxt, j]:
            rise_x = min(rise_x, 0.25 * (value - max(before, after)))
    if 0 < j < m - 1:
        before, after = P[i, j - 1], P[i, j + 1]
        rise_z, shift_z = _crest(before, value, after, z[j] - z[j - 1], z[j + 1] - z[j])
        if fixed[i, j - 1] or fixed[i, j + 1]:
            rise_z = min(rise_z, 0.25 * (value - max(before, after)))
    return value + rise_x + rise_z, x[i] + shift_x, z[j] + shift_z


@njit(cache=True)
def _crest(before, value, after, h0, h1):
    """Height above the middle one, and place from there, of the crest of a parabola through three points."""
    d0, d1 = (value - before) / h0, (after - value) / h1
    second, slope = (d1 - d0) / (h0 + h1), (d0 * h1 + d1 * h0) / (h0 + h1)
    return (-0.25 * slope * slope / second, -0.5 * slope / second) if second < 0.0 else (0.0, 0.0)
