"""Shape functions of squares, cubes and simplices, and their gradients.

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


def serendipity(nodes: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions of the square of 8 nodes or the cube of 20, whose natural coordinates are -1, 0 or 1.

    Corners: 2^-d prod(1 + x_i) (sum x_i - d + 1) with x_i = xi_i times that of the node; nodes on an edge along xi_k:
    2^(1-d) (1 - xi_k^2) prod(1 + x_i) over the other directions.
    """
    points = np.atleast_2d(points)[:, None]
    on_edge, d = nodes == 0.0, nodes.shape[1]
    is_corner = ~on_edge.any(axis=1)
    factor = np.where(on_edge, 1.0 - points**2, 1.0 + points * nodes)
    slope = np.where(on_edge, -2.0 * points, nodes)
    rest = np.where(is_corner, (points * nodes).sum(axis=2) - d + 1.0, 2.0) / 2**d
    whole = factor.prod(axis=2)
    others = np.stack([np.delete(factor, i, axis=2).prod(axis=2) for i in range(d)], axis=2)
    gradient = slope * others * rest[..., None] + (whole * is_corner)[..., None] * nodes / 2**d
    return whole * rest, gradient


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
