"""Differences over the links of a grid, and sums over the links by vertices, in arrays.

Links lead from a vertex to the next one in theta, around the ring, and to the next one in z. Values on links are
(2, ..., n, m), those in theta first; behind the last row there is no link in z, and its value has to be zero.
"""

from __future__ import annotations

import numpy as np


def following(P: np.ndarray) -> np.ndarray:
    """Values (2, n, m) of a field at the next vertex in theta and z; of the last row in z its own."""
    out = np.array((P, P))
    out[0, :-1], out[0, -1] = P[1:], P[0]
    out[1, :, :-1] = P[:, 1:]
    return out


def on_links(P: np.ndarray) -> np.ndarray:
    """Mean of both vertices on the links (2, n, m)."""
    return 0.5 * (P + following(P))


def drops(P: np.ndarray) -> np.ndarray:
    """Field P (n, m) less its value at the next vertex, on the links (2, n, m)."""
    return P - following(P)


def drop_weights(links: np.ndarray) -> np.ndarray:
    """Weights of P (2, ..., n, m) in the sums of ``links`` times `drops` in theta and in z.

    Their sum over both is what leaves the vertices by flows on the links.
    """
    out, (x, z) = links.copy(), links
    out[0, ..., 1:, :] -= x[..., :-1, :]
    out[0, ..., 0, :] -= x[..., -1, :]
    out[1, ..., 1:] -= z[..., :-1]
    return out


def to_ends(values: np.ndarray, axis: int) -> np.ndarray:
    """Half of the values on the links along an axis at either of their ends: the transpose of the mean of both."""
    out = values.copy()
    ends, links = out.swapaxes(0, axis), values.swapaxes(0, axis)
    ends[1:] += links[:-1]
    ends[0] += links[-1]
    return 0.5 * out
