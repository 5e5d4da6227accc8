"""Cells of elements and their faces; shape functions of simplices, and their gradients.

Functions take natural coordinates (p, d) of points, and return values (p, n) and gradients (p, n, d) of n nodes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True, eq=False)
class Cell:
    """A square or cube, -1 to 1, or a simplex with coordinates >= 0 of sum <= 1, with its nodes.

    Parameters
    ----------
    nodes : ndarray, shape (n, d)
        Natural coordinates.
    shapes : function
        Shape functions (p, n) and their gradients (p, n, d) at natural coordinates (p, d).
    """

    nodes: np.ndarray
    shapes: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

    @property
    def is_simplex(self) -> bool:
        """Return whether it is a triangle or a tetrahedron."""
        return bool(self.nodes.min() >= 0.0)

    def outside(self, natural: np.ndarray) -> np.ndarray:
        """Return the distance of points (p, d) beyond the cell, in natural coordinates; negative inside."""
        if self.is_simplex:
            return np.maximum(-natural.min(axis=1), natural.sum(axis=1) - 1.0)
        return np.abs(natural).max(axis=1) - 1.0


def linear_simplex(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Barycentric coordinates L of a triangle or a tetrahedron, the shape functions of its corners."""
    points = np.atleast_2d(points)
    p, d = points.shape
    slopes = np.vstack([-np.ones(d), np.eye(d)])
    return np.column_stack([1.0 - points.sum(axis=1), points]), np.broadcast_to(slopes, (p, d + 1, d))


def quadratic_simplex(edges: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions L_i (2 L_i - 1) of the corners and 4 L_i L_j of the nodes on edges i-j, shape (e, 2)."""
    L, dL = linear_simplex(points)
    i, j = edges.T
    value = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, i] * L[:, j]], axis=1)
    ends, between = (4.0 * L - 1.0)[:, :, None] * dL, L[:, i, None] * dL[:, j] + L[:, j, None] * dL[:, i]
    return value, np.concatenate([ends, 4.0 * between], axis=1)
