"""Sparse matrices from triplets whose places stay while their values change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix


class Triplets:
    """Sums of triplets at places that stay for a while: from the second time on their order is known."""

    def __init__(self) -> None:
        self.places: list[np.ndarray] = []
        self.found: csc_matrix | None = None
        self.sums: np.ndarray | None = None

    def matrix(self, parts: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]], size: int) -> csc_matrix:
        """The matrix (size, size) in compressed columns with sorted rows, of parts (rows, columns, values).

        Places of a part that are the same array as before must be the same places.
        """
        places = [x for rows, columns, _ in parts for x in (rows, columns)]
        values = np.concatenate([x for *_, x in parts])
        if self.found is None or not same_arrays(places, self.places):
            self.places, self.sums = places, None
            self.found = coo_matrix((values, self._together()), shape=(size, size)).tocsc()
            self.found.sum_duplicates()
            return self.found
        if self.sums is None:
            numbered = csc_matrix(
                (np.arange(self.found.nnz), self.found.indices, self.found.indptr), shape=(size, size)
            )
            self.sums = np.asarray(numbered[self._together()]).ravel()
        data = np.bincount(self.sums, values, self.found.nnz)
        return csc_matrix((data, self.found.indices, self.found.indptr), shape=(size, size))

    def _together(self) -> tuple[np.ndarray, np.ndarray]:
        return np.concatenate(self.places[::2]), np.concatenate(self.places[1::2])


def same_arrays(first: Sequence[np.ndarray], second: Sequence[np.ndarray]) -> bool:
    """Return whether two sequences hold the same arrays, or arrays of the same content."""
    return len(first) == len(second) and all(a is b or np.array_equal(a, b) for a, b in zip(first, second, strict=True))
