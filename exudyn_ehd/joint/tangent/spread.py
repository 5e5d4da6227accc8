"""A wrench carried by the nodes of a bore.

Forces of pressure and shear on the nodes add up to what the film's wrench contains; the rest of it is spread over the
nodes as ``a + b x r``, with a and b from force and moment.
"""

from __future__ import annotations

import numpy as np


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


def spread_matrix(x: np.ndarray) -> np.ndarray:
    """Map (count, 3, 6) from a force and a moment about O to forces with these resultants at points x (count, 3).

    The forces are ``(a + b x r) / count``: the resultants' pseudo-inverse.
    """
    onto = resultant(x)
    return np.linalg.solve(onto @ onto.T, onto).T.reshape(-1, 3, 6)
