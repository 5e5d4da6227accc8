"""Vibrations of a linear system, also of one whose films follow them with a delay."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from scipy.linalg import block_diag

from exudyn_ehd.joint.static.dynamic_stiffness import ROUNDING, FilmMemory
from exudyn_ehd.status import FilmError

# Vibrations of films with a memory, as shares of their size: the change that ends a search, the distance up to which
# the shape decides between two, and how far a step may lead. Smallest step of the films' share, and rounds of one.
SETTLED, NEAR, FARTHEST, SMALLEST_SHARE, ROUNDS = 1e-7, 0.2, 0.25, 1e-3, 8
# Step of difference quotients over the speed: their error of 1e-5 slows the rounds, but is none of the result.
DIFFERENCE = 1e-5
# K and C of coordinates that follow.
Linear: TypeAlias = tuple[np.ndarray, np.ndarray]
Stiffness: TypeAlias = Callable[[complex], np.ndarray]
# Eigenvalue, 1/s, and shape (n,) of a vibration.
Track: TypeAlias = tuple[complex, np.ndarray]


def vibrations(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (2n,) and vectors (n, 2n) of ``(s^2 M + s D + K) y = 0``."""
    n = len(M)
    lower = -np.linalg.solve(M, np.hstack((K, D)))
    values, vectors = np.linalg.eig(np.vstack((np.eye(n, 2 * n, n), lower)))
    return values.astype(complex), vectors[:n].astype(complex)


def vibrations_on_bores(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, films: Sequence[tuple[FilmMemory, Linear]], speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (m,) and vectors (n, m) of a system with films on flexible bores, and their `FilmResponse.linear`.

    The coordinates q of the bores have no mass. With z = (y, q), y the first n of them, and v = s y,

        -K z = s (D z + M v),    s y = v,

    is one linear problem; its 1 / s are the eigenvalues of a matrix. Motions that die out without a swing and within a
    turn are left out.
    """
    n, whole = len(M), []
    for k, own in enumerate((K, D)):
        corner = own + sum(film.loads @ (both[k][:4, :4] - film.slow[k]) @ film.places for film, both in films)
        right = np.hstack([film.loads @ both[k][:4, 4:] for film, both in films])
        below = np.vstack([both[k][4:, :4] @ film.places for film, both in films])
        whole.append(np.block([[corner, right], [below, block_diag(*(both[k][4:, 4:] for _, both in films))]]))
    size = len(whole[0])
    moved = np.linalg.solve(whole[0], -np.hstack((whole[1], np.eye(size, n) @ M)))
    inverse, vectors = np.linalg.eig(np.vstack((moved, np.eye(n, size + n))))
    there = np.abs(inverse) > ROUNDING * np.abs(inverse).max()
    values, vectors = 1.0 / inverse[there].astype(complex), vectors[:n, there].astype(complex)
    lasts = values.real >= -np.maximum(np.abs(values.imag), speed / (2.0 * np.pi))
    return values[lasts], vectors[:, lasts]


def delayed_vibrations(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, beyond: Stiffness, speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (2n,) and vectors (n, 2n) of ``(s^2 M + s D + K + beyond(s)) y = 0`` for films with a memory.

    They are followed from those of the films' K and C at half the speed, as the dynamic stiffness takes their place by
    and by, all of them together: where two end in one, or one is lost, the step is halved. With the films' own memory
    there are more or fewer motions that die out without a swing and within a turn of the rotor: those lost are nan.
    """
    half, share, step = 0.5 * speed, 0.0, 0.25
    there = beyond(1j * half)
    start = D + there.imag / half, K + there.real
    values, vectors = vibrations(M, *start)
    # one of each pair of conjugates
    tracks = [(values[j], vectors[:, j]) for j in np.flatnonzero(values.imag >= 0.0)]
    while share < 1.0:
        larger = min(1.0, share + step)

        def stiffness(s: complex, share: float = larger) -> np.ndarray:
            """Dynamic stiffness (n, n) without inertia, with a share of the films' own."""
            return share * (K + s * D + beyond(s)) + (1.0 - share) * (start[1] + s * start[0])

        fades = speed / (2.0 * np.pi) if step < SMALLEST_SHARE else np.inf
        found = _follow(M, stiffness, tracks, DIFFERENCE * speed, fades)
        if not found and step < SMALLEST_SHARE:
            raise FilmError(
                f"RotorResult: the vibrations at {speed:.6g} rad/s are not all found, because the films follow them "
                "with a delay; look at speeds beside it, or run it in time."
            )
        tracks, share, step = (found, larger, 1.5 * step) if found else (tracks, share, 0.5 * step)
    tracks += [(s.conjugate(), y.conj()) for s, y in tracks if s.imag > 0.0]
    values, vectors = np.full(values.size, np.nan, dtype=complex), np.full(vectors.shape, np.nan, dtype=complex)
    values[: len(tracks)], vectors[:, : len(tracks)] = [s for s, _ in tracks], np.column_stack([y for _, y in tracks])
    return values, vectors


def _follow(M: np.ndarray, stiffness: Stiffness, tracks: list[Track], step: float, fades: float) -> list[Track] | None:
    """Vibrations near those of ``tracks``, none of negative frequency; None if one is lost, or if two end in one.

    A pair that meets on the real axis goes on as two motions that decay; two of these that meet go on as a pair. Of
    motions that decay faster than they swing, and than at the rate ``fades``, 1/s, lost ones are left out.
    """
    out: list[Track] = []
    met: list[Track] = []
    for s, y in tracks:
        found = _near(M, stiffness, s, y, step)
        new = [] if found is None else [found if found[0].imag >= 0.0 else (found[0].conjugate(), found[1].conj())]
        if new and s.imag == 0.0 < new[0][0].imag and not any(_is_same(new[0], other) for other in met):
            met += new
            continue
        parts = 1 + bool(new and s.imag > 0.0 == new[0][0].imag)
        if parts == 2:
            other = _near(M, stiffness, complex(2.0 * s.real - new[0][0].real), y, step)
            new += [other] if other is not None and other[0].imag == 0.0 else []
        new = [track for k, track in enumerate(new) if not any(_is_same(track, other) for other in out + new[:k])]
        if len(new) < parts and not s.real < -max(abs(s.imag), fades):
            return None
        out += new
    alone = [track[0] for track in met if not any(_is_same(track, other) for other in out)]
    return None if any(not s.real < -fades for s in alone) else out


def _is_same(a: Track, b: Track) -> bool:
    """Return whether two vibrations are one, in value and shape."""
    alike = abs(np.vdot(a[1], b[1])) / (np.linalg.norm(a[1]) * np.linalg.norm(b[1]))
    return abs(a[0] - b[0]) <= DIFFERENCE * abs(a[0]) and bool(alike >= 1.0 - DIFFERENCE)


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
