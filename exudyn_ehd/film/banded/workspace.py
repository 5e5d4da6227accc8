"""Buffers of a film, allocated once; independent of the solvers."""

from __future__ import annotations

from functools import cached_property

import numpy as np

# Number of zeros after the half-bandwidth in every row of a band, for kernels that process four pivots and vectors of
# four numbers. Smaller numbers let them read the next row, larger ones cost time.
PAD = 6


class Workspace:
    """Buffers of one film on n columns and m rows, for one solution at a time.

    Attributes
    ----------
    active : (n, m) bool array
        Active set of the last solution.
    warm : bool
        Whether the next solution is a warm start from the last one.
    ready, exact : bool
        Whether the factor may be used for a chord step as first step of the next solution, and whether it is that of
        the last solution.
    u : (n, m) array
        Unknowns of the last solution, see `exudyn_ehd.film.cavitation.states`.
    slopes : (5, n m) array
        Derivatives to the unknowns: of the flows over the links (4), and of the storage.
    """

    def __init__(self, n: int, m: int) -> None:
        size = n * m
        self.shape = (n, m)
        self.order = np.zeros(size, dtype=np.int64)
        self.number = np.full((n, m), -1, dtype=np.int64)
        self.upper = self._new_band()
        self.inv_diag = np.zeros(size)
        self.unknowns = np.zeros(size)
        self.active = np.zeros((n, m), dtype=np.bool_)
        self.warm = self.ready = self.exact = False
        self.count = 0
        self.width = 1

    @property
    def size(self) -> tuple[bool, int, int]:
        """Argument ``size`` of `exudyn_ehd.film.solvers.newton.solve_film`."""
        return self.warm and self.ready, self.count, self.width

    def take_end(self, found: bool, exact: bool, steps: int, count: int, width: int) -> tuple[bool, int]:
        """Store the state of the factor after a solution; returns (found, steps)."""
        self.ready, self.exact, self.count, self.width = found, exact, count, width
        return found, steps

    def _new_band(self) -> np.ndarray:
        n, m = self.shape
        return np.zeros((n * m, 2 * m + 2 + PAD))

    @cached_property
    def lower(self) -> np.ndarray:
        """L of a non-symmetric film."""
        return self._new_band()

    @cached_property
    def u(self) -> np.ndarray:
        """Unknowns of a film that Newton's method solves."""
        return np.zeros(self.shape)

    @cached_property
    def slopes(self) -> np.ndarray:
        """Derivatives of the flows and the storage of a non-symmetric film."""
        return np.zeros((5, self.order.size))

    @cached_property
    def above(self) -> np.ndarray:
        """Pressures above the cavity's."""
        return np.zeros(self.shape)

    @cached_property
    def matrix(self) -> tuple[np.ndarray, ...]:
        """Argument ``matrix`` of `exudyn_ehd.film.solvers.newton` for a non-symmetric film."""
        steep = np.zeros(self.shape)
        return self.order, self.number, self.lower, self.upper, self.inv_diag, self.slopes, steep

    @cached_property
    def symmetric(self) -> tuple[np.ndarray | None, ...]:
        """Argument ``matrix`` for a symmetric film."""
        return self.order, self.number, None, self.upper, self.inv_diag, None, None

    @cached_property
    def before(self) -> tuple[np.ndarray, ...]:
        """Last entry of ``places`` of `exudyn_ehd.film.solvers.newton`, where gaps follow the pressure."""
        u, above = np.zeros((2, *self.shape))
        return u, np.zeros(self.shape, dtype=np.bool_), above

    @cached_property
    def residual(self) -> np.ndarray:
        """Residuals of the vertices' mass balances."""
        return np.zeros(self.shape)
