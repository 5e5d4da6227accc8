"""Sparse matrices from triplets whose places stay while their values change."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix


class Triplets:
    """Sums of triplets at places that stay for a while: from the second time on their order is known."""

    def __init__(self) -> None:
        self.places = np.zeros((2, 0), dtype=np.int32)
        self.found: csc_matrix | None = None
        self.sums: np.ndarray | None = None

    def matrix(self, rows: np.ndarray, columns: np.ndarray, values: np.ndarray, size: int) -> csc_matrix:
        """The matrix (size, size) in compressed columns with sorted rows."""
        if self.found is None or not np.array_equal(self.places, (rows, columns)):
            self.places, self.sums = np.array((rows, columns)), None
            self.found = coo_matrix((values, (rows, columns)), shape=(size, size)).tocsc()
            self.found.sum_duplicates()
            return self.found
        if self.sums is None:
            numbered = csc_matrix(
                (np.arange(self.found.nnz), self.found.indices, self.found.indptr), shape=(size, size)
            )
            self.sums = np.asarray(numbered[rows, columns]).ravel()
        data = np.bincount(self.sums, values, self.found.nnz)
        return csc_matrix((data, self.found.indices, self.found.indptr), shape=(size, size))
