"""Vibrations of a solid on its own, to compare with."""

import numpy as np
from scipy.sparse.linalg import eigsh


def eigenfrequencies(solid, *, held=None, count=12):
    """Lowest angular eigenfrequencies (count,) in rad/s, ascending, and M-orthonormal modes (count, n, 3) at rest.

    ``held`` (n, 3): supported coordinates; without any the six rigid modes come first, with omega near zero.
    """
    shape = solid.mesh.nodes.shape
    free = np.arange(np.prod(shape)) if held is None else np.flatnonzero(~held.ravel())
    K, M = (A[free][:, free].tocsc() for A in (solid.tangent(np.zeros(shape)), solid.mass))
    # a negative shift keeps K - sigma M positive definite with rigid modes present
    shift = -1e-6 * float(K.diagonal().mean() / M.diagonal().mean())
    start = np.random.default_rng(0).standard_normal(len(free))
    square, vectors = eigsh(K, k=count, M=M, sigma=shift, v0=start)
    order = np.argsort(square)
    modes = np.zeros((count, np.prod(shape)))
    modes[:, free] = vectors[:, order].T
    return np.sqrt(np.maximum(square[order], 0.0)), modes.reshape(count, *shape)
