"""Vibrations of a linear system, also of one whose films follow them with a delay."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from exudyn_ehd.status import FilmError

# Vibrations of films with a memory, as shares of their size: the change that ends a search, the distance up to which
# the shape decides between two, and how far a step may lead. Smallest step of the films' share, and rounds of one.
SETTLED, NEAR, FARTHEST, SMALLEST_SHARE, ROUNDS = 1e-7, 0.2, 0.25, 1e-3, 8
# Step of difference quotients over the speed: their error of 1e-5 slows the rounds, but is none of the result.
DIFFERENCE = 1e-5
Stiffness: TypeAlias = Callable[[complex], np.ndarray]


def vibrations(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (2n,) and vectors (n, 2n) of ``(s^2 M + s D + K) y = 0``."""
    n = len(M)
    lower = -np.linalg.solve(M, np.hstack((K, D)))
    values, vectors = np.linalg.eig(np.vstack((np.eye(n, 2 * n, n), lower)))
    return values.astype(complex), vectors[:n].astype(complex)


def delayed_vibrations(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, beyond: Stiffness, speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (2n,) and vectors (n, 2n) of ``(s^2 M + s D + K + beyond(s)) y = 0`` for films with a memory.

    They are followed from those of the films' K and C at half the speed, as the dynamic stiffness takes their place by
    and by.
    """
    half = 0.5 * speed
    there = beyond(1j * half)
    start = D + there.imag / half, K + there.real
    values, vectors = vibrations(M, *start)
    for j in np.flatnonzero(values.imag >= 0.0):
        twin = np.argmin(np.abs(values - values[j].conj())) if values[j].imag > 0.0 else j
        share, step = 0.0, 0.25
        while share < 1.0:
            larger = min(1.0, share + step)

            def stiffness(s: complex, share: float = larger) -> np.ndarray:
                """Dynamic stiffness (n, n) without inertia, with a share of the films' own."""
                return share * (K + s * D + beyond(s)) + (1.0 - share) * (start[1] + s * start[0])

            found = _near(M, stiffness, values[j], vectors[:, j], DIFFERENCE * speed)
            share, step = (share, 0.5 * step) if found is None else (larger, 1.5 * step)
            if found is not None:
                values[j], vectors[:, j] = found
            elif step < SMALLEST_SHARE:
                raise FilmError(
                    f"RotorResult: the vibration near {values[j]:.6g} 1/s at {speed:.6g} rad/s is not found, because "
                    "its films follow it with a delay; look at speeds beside it, or run it in time."
                )
        if twin != j:
            values[twin], vectors[:, twin] = values[j].conj(), vectors[:, j].conj()
    return values, vectors


def _near(
    M: np.ndarray, stiffness: Stiffness, s: complex, y: np.ndarray, step: float
) -> tuple[complex, np.ndarray] | None:
    """The vibration near s with a shape near y; None if it is lost.

    Every round solves for all vibrations of the damping and stiffness tangent to ``stiffness`` at the one before.
    """
    before = s
    for _ in range(ROUNDS):
        at = stiffness(s)
        by_s = (stiffness(s + step) - at) / step
        values, shapes = vibrations(M, by_s, at - s * by_s)
        alike = np.abs(y.conj() @ shapes) / np.linalg.norm(shapes, axis=0)
        # of those that are as near as the nearest, the one with this shape
        away = np.abs(values - s)
        best = np.argmax(np.where(away <= away.min() + NEAR * abs(s), alike, -1.0))
        change, s = abs(values[best] - s), values[best]
        if abs(s - before) > FARTHEST * abs(before):
            return None
        if change <= SETTLED * abs(s):
            # round-off leaves an imaginary part to motions that only decay
            s = complex(s.real, s.imag if abs(s.imag) > SETTLED * abs(s) else 0.0)
            return s, shapes[:, best] / np.linalg.norm(shapes[:, best])
    return None
