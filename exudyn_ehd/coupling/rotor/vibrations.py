"""Eigenvalues and modes of a rotor in its films, also in films that follow it with a delay."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import block_diag, eig

from exudyn_ehd.joint.newton import ROUNDED, ROUNDS
from exudyn_ehd.joint.static.dynamic_stiffness import FilmMemory
from exudyn_ehd.status import SMALL

# Part of the bodies in a motion above which it is always told. Smaller: more motions of the oil among the results.
PART = 0.1
# Largest unbalanced force of a vibration, over the largest term of its dynamic stiffness, and relative change of the
# eigenvalue from which Newton's method goes on. Larger: more guesses lead to another motion than their own.
NEAR = 0.3


def vibrations(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (2n,) and vectors (n, 2n) of ``(s^2 M + s D + K) y = 0``."""
    n = len(M)
    lower = -np.linalg.solve(M, np.hstack((K, D)))
    values, vectors = np.linalg.eig(np.vstack((np.eye(n, 2 * n, n), lower)))
    return values.astype(complex), vectors[:n].astype(complex)


def vibrations_in_films_that_follow(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, films: Sequence[FilmMemory]
) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (m,) and vectors (n, m), of length 1, of a system with films that follow it with a delay.

    With the coordinates w of films and flexible bores (`FilmResponse.linear`), z = (y, w), and v = s z for coordinates
    with second derivatives,

        -K z = s (D z + M v),    s z = v,

    is one linear problem; its 1 / s are the eigenvalues of a matrix. Each is the first guess of a motion with the whole
    dynamic stiffness, see `_refined`. Returned are the 2n motions in which the bodies have the largest part, those in
    which it is above `PART`, and all that grow. This part is the product of left and right eigenvectors in y and v over
    that in all coordinates.
    """
    n, whole = len(M), []
    parts = [(film, film.response.linear()) for film in films]
    for k, own in enumerate((K, D, M)):
        slow = [film.slow[k] if k < 2 else 0.0 for film in films]
        corner = own + sum(
            f.loads @ (of[k][:4, :4] - known) @ f.places for (f, of), known in zip(parts, slow, strict=True)
        )
        right = np.hstack([film.loads @ of[k][:4, 4:] for film, of in parts])
        below = np.vstack([of[k][4:, :4] @ film.places for film, of in parts])
        whole.append(np.block([[corner, right], [below, block_diag(*(of[k][4:, 4:] for _, of in parts))]]).real)
    fast, size = np.flatnonzero(whole[2].any(axis=0)), len(whole[0])
    moved = np.linalg.solve(whole[0], -np.hstack((whole[1], whole[2][:, fast])))
    inverse, left, vectors = eig(np.vstack((moved, np.eye(size, size + fast.size)[fast])), left=True)
    bodies, products = np.append(np.arange(n), size + np.flatnonzero(fast < n)), left.conj() * vectors
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.nan_to_num(np.abs(products[bodies].sum(axis=0) / products.sum(axis=0)))
    told: dict[complex, np.ndarray] = {}
    rounding = np.finfo(float).eps * len(inverse) * np.abs(inverse).max()
    for k in np.argsort(-part):
        # of a pair the one with a positive frequency; 1 / s of infinite ones is round-off
        if inverse[k].imag > 0.0 or np.abs(inverse[k]) <= rounding:
            continue
        if len(told) >= 2 * n and part[k] < PART and not inverse[k].real > 0.0:
            continue
        s, y = _refined(M, D, K, films, 1.0 / complex(inverse[k]), vectors[:n, k].astype(complex))
        if y is not None and not any(abs(s - other) < SMALL * abs(s) for other in told):
            told |= {s: y, s.conjugate(): y.conj()}
    return np.array(list(told)), np.array(list(told.values())).T.reshape(n, -1)


def _refined(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, films: Sequence[FilmMemory], s: complex, y: np.ndarray
) -> tuple[complex, np.ndarray | None]:
    """Motion with the whole dynamic stiffness T(s), by Newton's method for ``T(s) y = 0`` at a fixed component of y.

    The vector is None if the guess is not near a motion, or the method does not converge. Steps are not damped, since a
    guess that needs damping is near another motion than its own.
    """

    def terms(s: complex) -> np.ndarray:
        return np.array([s**2 * M, s * D, K, *(film.beyond(s) for film in films)])

    for _ in range(ROUNDS):
        if abs(s.imag) < SMALL * abs(s):
            # round-off of a motion without oscillation
            s, y = complex(s.real), (y / y[np.argmax(np.abs(y))]).real.astype(complex)
        try:
            T = terms(s)
            forces = T @ y
            error = np.abs(forces.sum(axis=0)).max() / np.abs(forces).max()
            if not error > ROUNDED:
                return s, y / np.linalg.norm(y)
            slope = (terms(s * (1.0 + ROUNDED)) - T).sum(axis=0) / (ROUNDED * s)
        except RuntimeError:  # at a motion of the film alone
            break
        try:
            x = np.linalg.solve(T.sum(axis=0), slope @ y)
        except np.linalg.LinAlgError:  # the eigenvalue is exact
            return s, np.linalg.svd(T.sum(axis=0))[2][-1].conj()
        change = y[largest := np.argmax(np.abs(y))] / x[largest]
        if error > NEAR or not abs(change) < NEAR * abs(s):
            break
        s, y = s - change, x / np.abs(x).max()
    return s, None
