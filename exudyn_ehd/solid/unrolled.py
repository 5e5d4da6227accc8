"""Faces on a cylinder, unrolled to angle theta and place z: where points lie on them, where they meet and end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np

from exudyn_ehd.solid.elements.faces import Face, face_of

# Share of the faces that are smaller than a small one.
SMALL_FACES = 0.1


class Unrolled(ABC):
    """Faces with a nodes each around an axis."""

    positions: np.ndarray

    @property
    @abstractmethod
    def local(self) -> np.ndarray:
        """Indices (f, a) of the faces into ``positions``."""

    @cached_property
    def kind(self) -> Face:
        """Kind of the faces."""
        return face_of(self.local)

    @property
    def count(self) -> int:
        """Number of faces."""
        return len(self.local)

    @cached_property
    def cuts(self) -> tuple[np.ndarray, np.ndarray]:
        """Angles [rad], 0 to 2 pi, and places z [m], ascending, at which integrals over the faces are parted.

        The lines of their corners if these are as few as a structured mesh has; others are cut evenly, in steps of
        half a small face.
        """
        ends = self.positions[self.local[:, : self.kind.corners]]
        _, spread, low, high = _extents(self.positions[self.local])
        angles = _distinct(np.arctan2(ends[..., 1], ends[..., 0]) % (2.0 * np.pi), 2.0 * np.pi)
        places = _distinct(ends[..., 2], float(np.ptp(ends[..., 2])))
        around, along = (0.5 * float(np.quantile(size, SMALL_FACES)) for size in (2.0 * spread, high - low))
        if angles.size * around > 2.0 * np.pi:
            angles = np.arange(0.0, 2.0 * np.pi, around)
        if (places.size - 1) * along > places[-1] - places[0]:
            places = np.arange(places[0], places[-1], along)
        return angles, places

    @cached_property
    def rims(self) -> np.ndarray:
        """Edges of one face only: middle and half of their angle [rad], lowest and highest z [m], shape (r, 4)."""
        corners = self.local[:, : self.kind.corners]
        edges = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
        edges, uses = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
        return np.stack(_extents(self.positions[edges[uses == 1]]), axis=1)


def near_faces(corner: np.ndarray, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Flags (p, f): which points (p,) of an unrolled surface may lie on which faces with nodes ``corner`` (f, a, 3)."""
    centre, spread, low, high = _extents(corner)
    margin = 0.05 * (high - low)
    # points of a grid share their angles and places
    angles, angle = np.unique(theta, return_inverse=True)
    places, place = np.unique(z, return_inverse=True)
    around = np.abs(wrapped(angles[:, None] - centre)) <= 1.05 * spread + 1e-9
    along = (places[:, None] >= low - margin) & (places[:, None] <= high + margin)
    return np.asarray(around[angle] & along[place])


def invert_faces(kind: Face, corner: np.ndarray, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Natural coordinates (n, 2) of points (n,) on a face each, by Newton's method on theta(r, s) and z(r, s).

    Parameters
    ----------
    kind : Face
    corner : ndarray, shape (n, a, 3)
        Nodes of every point's face [m].
    theta, z : ndarray, shape (n,)
        [rad], [m]
    """
    natural = np.full((len(corner), 2), kind.middle)
    moving = np.arange(len(corner))
    for _ in range(20):
        value, gradient = kind.shapes(natural[moving])
        nodes = corner[moving]
        x = (value[:, None] @ nodes)[:, 0]
        slope = gradient.transpose(0, 2, 1) @ nodes
        error = wrapped(np.arctan2(x[:, 1], x[:, 0]) - theta[moving]), x[:, 2] - z[moving]
        turn = (x[:, 0, None] * slope[..., 1] - x[:, 1, None] * slope[..., 0]) / (x[:, :2] ** 2).sum(axis=1)[:, None]
        rise = slope[..., 2]
        det = turn[:, 0] * rise[:, 1] - turn[:, 1] * rise[:, 0]
        r, s = error[0] * rise[:, 1] - error[1] * turn[:, 1], error[1] * turn[:, 0] - error[0] * rise[:, 0]
        step = np.stack([r, s], axis=1) / det[:, None]
        natural[moving] = np.clip(natural[moving] - step, -1.5, 1.5)
        moving = moving[np.abs(step).max(axis=1) >= 1e-13]
        if not moving.size:
            break
    return natural


def wrapped(angle: np.ndarray) -> np.ndarray:
    """Return the angle in the range from -pi to pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _distinct(values: np.ndarray, span: float) -> np.ndarray:
    """Ascending values that differ by more than rounding."""
    ordered = np.sort(values.ravel())
    return ordered[np.concatenate(([True], np.diff(ordered) > 1e-7 * span))]


def _extents(corner: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Angle of the middle, largest angle from there, lowest and highest z of every face (f,) with nodes (f, a, 3)."""
    middle = corner.mean(axis=1)
    centre = np.arctan2(middle[:, 1], middle[:, 0])
    spread = np.abs(wrapped(np.arctan2(corner[..., 1], corner[..., 0]) - centre[:, None])).max(axis=1)
    return centre, spread, corner[..., 2].min(axis=1), corner[..., 2].max(axis=1)
