"""A wrench carried by the nodes of a bore.

Forces of pressure and shear on the nodes add up to what the film's wrench contains; the rest of it is spread over the
nodes as ``a + b x r``, with a and b from force and moment.
"""

from __future__ import annotations

import numpy as np
from numba import njit


def complete(x: np.ndarray, wrench: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Forces (count, 3, ...) at points x (count, 3) that oppose a wrench (6, ...): ``local`` and the spread rest."""
    rest = -wrench - np.tensordot(resultant(x), local.reshape(3 * len(x), *local.shape[2:]), 1)
    return local + np.tensordot(spread_matrix(x), rest, 1)


def resultant(x: np.ndarray) -> np.ndarray:
    """Force and moment about O (6, 3 count) of nodal forces at x (count, 3)."""
    out = np.zeros((6, len(x), 3))
    out[0, :, 0] = out[1, :, 1] = out[2, :, 2] = 1.0
    out[3, :, 1], out[3, :, 2] = -x[:, 2], x[:, 1]
    out[4, :, 0], out[4, :, 2] = x[:, 2], -x[:, 0]
    out[5, :, 0], out[5, :, 1] = -x[:, 1], x[:, 0]
    return out.reshape(6, -1)


@njit(cache=True)
def spread_matrix(x):
    """Map (count, 3, 6) from a force and a moment about O to forces with these resultants at points x (count, 3).

    The forces are ``(a + b x r) / count``.
    """
    count = len(x)
    mean, second = np.zeros(3), np.zeros((3, 3))
    for k in range(count):
        for i in range(3):
            mean[i] += x[k, i] / count
            for j in range(3):
                second[i, j] += x[k, i] * x[k, j] / count
    # force = a + b x mean, moment = mean x a + int r x (b x r)
    both = np.eye(6)
    both[0, 4], both[0, 5], both[1, 5] = mean[2], -mean[1], mean[0]
    both[1, 3], both[2, 3], both[2, 4] = -mean[2], mean[1], -mean[0]
    trace = second[0, 0] + second[1, 1] + second[2, 2]
    for i in range(3):
        for j in range(3):
            both[3 + i, j] = both[j, 3 + i]
            both[3 + i, 3 + j] = (trace if i == j else 0.0) - second[i, j]
    ab = np.linalg.inv(both) / count
    out = np.empty((count, 3, 6))
    for k in range(count):
        for c in range(6):
            b0, b1, b2 = ab[3, c], ab[4, c], ab[5, c]
            out[k, 0, c] = ab[0, c] + b1 * x[k, 2] - b2 * x[k, 1]
            out[k, 1, c] = ab[1, c] + b2 * x[k, 0] - b0 * x[k, 2]
            out[k, 2, c] = ab[2, c] + b0 * x[k, 1] - b1 * x[k, 0]
    return out
