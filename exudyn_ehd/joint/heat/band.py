"""Banded systems at the vertices of a film."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.banded.factors import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu
from exudyn_ehd.film.banded.workspace import PAD


class BandSolver:
    """Systems of ``unknowns`` at every vertex of a film grid (n, m); its buffers stay."""

    def __init__(self, shape: tuple[int, int], unknowns: int) -> None:
        n, m = shape
        self.number, self.order = np.zeros(shape, dtype=np.int64), np.zeros(n * m, dtype=np.int64)
        _, width = number_cells(np.ones(shape, dtype=np.bool_), np.ones(shape), self.order, self.number)
        self.unknowns, self.size, self.width = unknowns, unknowns * n * m, unknowns * (width + 1) - 1
        self.lower, self.upper = np.zeros((2, self.size, self.width + 1 + PAD))
        self.inverse = np.zeros(self.size)

    def factor(self) -> None:
        """Factor what ``lower`` and ``upper`` hold."""
        self.regular = factor_lu(self.lower, self.upper, self.size, self.width, self.inverse)

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Fields of each right-hand side's unknowns in turn (k, n, m), as ``rhs``; inf for a singular system."""
        if not self.regular:
            return np.full(rhs.shape, np.inf)
        sides = rhs.reshape(-1, self.unknowns, self.order.size)
        x = np.ascontiguousarray(sides[:, :, self.order].swapaxes(1, 2)).reshape(len(sides), -1)
        solve_lu(self.lower, self.upper, self.inverse, self.size, self.width, x)
        out = np.empty_like(sides)
        out[:, :, self.order] = x.reshape(len(sides), -1, self.unknowns).swapaxes(1, 2)
        return out.reshape(rhs.shape)
