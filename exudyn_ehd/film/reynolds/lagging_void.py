"""Couette flows out of a cavity, averaged over the step: what makes its transport of second order in time.

The balance of a film that the flows carry along at a speed U is, in terms of the void ``v = H - fill H``,

    dv/dt + div (U v) = dH/dt + div (U H) + div (pressure flow).

Backward Euler in v is of first order, and damps or feeds whirl. With the right side at the end of a step and the void
on the left as its mean over the step, voids are those of half a step later: all that meets at the end of a step is of
its time, to second order, however far the gap moves. A mean of fills is not: beside a gap that moves it leaves
``U (1 - fill) dH/dt h / 2``, more than backward Euler does. So what leaves a vertex with a full film's flux f is

    f (1 - ((1 - w) v + w v_old) / H) = f ((1 - w) fill + w late),    late = 1 - v_old / H,

the same for all its links: flows and mass balance to rounding. H is foretold from gap and rate at the start of the
step, which is as exact and leaves ``late`` and w known: the film's equations stay linear, and its derivatives exact.

A void that nothing feeds shrinks by ``(1 - w C) / (1 + (1 - w) C)`` in a step that renews the C-fold of the content, so
that it neither changes sign nor stays for ``w C < 1``. What ``late`` takes along is no more than half of the content,
for any C; w vanishes in gaps that open or close by more than the oil in them.
"""

import numpy as np
from numba import njit

# Largest w; a half would be of second order to the last digit, and leave Fourier modes of short waves undamped.
LARGEST_LAG = 0.45
# Share of a vertex's oil that leaves it at most by what was there at the start of a step.
LARGEST_OUTFLOW = 0.5


@njit(cache=True, inline="always")
def _leaves(fx, fz, i, j):
    """Couette flow of a full film out of a vertex."""
    n, m = fx.shape
    out = max(fx[i, j], 0.0) - min(fx[i - 1 if i > 0 else n - 1, j], 0.0)
    if j + 1 < m:
        out += max(fz[i, j], 0.0)
    if j > 0:
        out -= min(fz[i, j - 1], 0.0)
    return out


@njit(cache=True)
def outflow_of(fx, fz, H, H_t, area, fill):
    """Fields (3, n, m) that the next step needs: fill; rate of the gap over the gap, 1/s; share of a full film that its
    Couette flows take along, 1/s."""
    n, m = fill.shape
    out = np.empty((3, n, m))
    for i in range(n):
        for j in range(m):
            volume = area[i, j] * H[i, j]
            out[0, i, j] = fill[i, j]
            out[1, i, j] = H_t[i, j] / H[i, j]
            out[2, i, j] = _leaves(fx, fz, i, j) / volume if volume > 0.0 else 0.0
    return out


@njit(cache=True)
def hold_back(film):
    """No lag where the flows of `FilmTerms` that have grown manifold since the last step would take more than there
    was."""
    n, m = film.late.shape
    for i in range(n):
        for j in range(m):
            late = film.late[i, j]
            if late > 0.0 and late * _leaves(film.fx, film.fz, i, j) > -film.area[i, j] * film.kept[i, j]:
                film.prompt[i, j], film.late[i, j] = 1.0, 0.0


@njit(cache=True)
def lag_void(outflow, step, fixed, prompt_out, late_out):
    """``prompt = 1 - w`` and ``w late`` (n, m) of a step after `outflow_of`; where it was full, 1 and 0."""
    n, m = fixed.shape
    for i in range(n):
        for j in range(m):
            fill, grows, drains = outflow[0, i, j], step * outflow[1, i, j], step * outflow[2, i, j]
            prompt_out[i, j], late_out[i, j] = 1.0, 0.0
            if fixed[i, j] or fill >= 1.0 or not min(fill, fill + grows) > 0.0:
                continue
            late = (fill + grows) / (1.0 + grows)
            w = min(LARGEST_LAG, late / fill, fill / late * min(1.0, LARGEST_OUTFLOW / max(drains, LARGEST_OUTFLOW)))
            prompt_out[i, j], late_out[i, j] = 1.0 - w, w * late
