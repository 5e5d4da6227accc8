"""Largest pressure of a film, between its vertices too."""

from __future__ import annotations

import numpy as np


def refined_peak(
    P: np.ndarray, fixed: np.ndarray, x: np.ndarray, z: np.ndarray, periodic: bool
) -> tuple[float, float, float]:
    """Peak of P and its position from parabolas through the largest vertex and its neighbours in x and in z.

    At a vertex whose pressure is prescribed (``fixed``, (n, m)), of a supply area or an end, the pressure has a kink:
    there the peak is the vertex itself. Beside one, from which the pressure may fall steeply, a parabola overshoots;
    there it may rise above the vertex by a quarter of the smaller drop to its neighbours.
    """
    n, m = P.shape
    i, j = divmod(int(P.argmax()), m)
    value = P[i, j]
    rise_x = rise_z = shift_x = shift_z = 0.0
    if fixed[i, j]:
        return float(value), float(x[i]), float(z[j])
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
    return float(value + rise_x + rise_z), float(x[i] + shift_x), float(z[j] + shift_z)


def _crest(before: float, value: float, after: float, h0: float, h1: float) -> tuple[float, float]:
    """Height above the middle one, and place from there, of the crest of a parabola through three points."""
    d0, d1 = (value - before) / h0, (after - value) / h1
    second, slope = (d1 - d0) / (h0 + h1), (d0 * h1 + d1 * h0) / (h0 + h1)
    return (-0.25 * slope * slope / second, -0.5 * slope / second) if second < 0.0 else (0.0, 0.0)
