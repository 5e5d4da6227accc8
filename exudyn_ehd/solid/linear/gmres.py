"""Linear equations known by products alone: the generalised minimal residual, Saad and Schultz (1986)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

# Part of a product outside of the space, relative, from which it is a direction more.
NEW = 1e-14


def gmres(
    product: Callable[[np.ndarray], np.ndarray], right: np.ndarray, enough: float, most: int
) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal directions (k, n) and weights (k,), whose sum is x with ``product(x) = right``.

    Parameters
    ----------
    product : function
        A x, (n,) of an (n,) array.
    right : (n,) array
    enough : float
        Norm of ``right - A x`` to reach.
    most : int
        Products at most.
    """
    size = float(np.linalg.norm(right))
    if not size > enough:
        return np.empty((0, right.size)), np.empty(0)
    basis, table = right[None] / size, np.zeros((most + 1, most))
    for k in range(most):
        image = product(basis[k])
        whole = np.linalg.norm(image)
        for _ in range(2):  # orthogonal to rounding
            part = basis @ image
            table[: k + 1, k] += part
            image = image - part @ basis
        table[k + 1, k] = outside = np.linalg.norm(image)
        known, target = table[: k + 2, : k + 1], size * np.eye(1, k + 2)[0]
        weights = np.linalg.lstsq(known, target, rcond=None)[0]
        if np.linalg.norm(target - known @ weights) <= enough or not outside > NEW * whole:
            break
        basis = np.vstack((basis, image / outside))
    return basis[: weights.size], weights
