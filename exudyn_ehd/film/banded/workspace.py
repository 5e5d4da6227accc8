"""Every buffer of a film, allocated once; knows no solver."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

# Zeros behind the half-bandwidth of every band: four pivots, and vectors of four, may read past it.
PAD = 6
# First row of a whole matrix; numpy's integer, since numba compiles kernels anew for a plain 0.
FIRST_ROW = np.int64(0)
# Longest front of a cavity in rows of the grid: beyond, its columns cost more than they spare.
FRONT_ROWS = 2


class Transport(NamedTuple):
    """Arrays of one factor of `exudyn_ehd.film.cavitation.cavity_transport`, for a grid of ``size = n m`` vertices.

    Attributes
    ----------
    shape : (6,) int array
        Number of full vertices, of front vertices, columns of V, half-bandwidth of A, length of the lists K and R.
    number : (n, m) int array
        Unknown of a full vertex, else -1.
    place : (n, m) int array
        Place of a cavitated vertex along the flow, else -1.
    along, across : (size,) int arrays
        Place of the cavitated neighbour upstream in theta and in z, or -1.
    by_along, by_across, inverse : (size,) arrays
        U and 1 / D.
    driven_from, driven_to, driven_by : (4 size,) arrays
        K as a list: full unknown, place, conductance.
    received_from, received_to, received_by : (2 size,) arrays
        R and C as a list: unknown, front vertex, flux of a full film or conductance of a cut link.
    front : (size,) int array
        Full unknown of every front vertex, ascending.
    band, diagonal : (size, >= 2 m + 6), (size,) arrays
        Factor of A.
    spread : (size * 2 (m + 2),) array
        V, as (full vertices, columns).
    loop : (2 (m + 2), 2 (m + 2)) array
        Factor L U of I - G, unit L.
    """

    shape: np.ndarray
    number: np.ndarray
    place: np.ndarray
    along: np.ndarray
    across: np.ndarray
    by_along: np.ndarray
    by_across: np.ndarray
    inverse: np.ndarray
    driven_from: np.ndarray
    driven_to: np.ndarray
    driven_by: np.ndarray
    received_from: np.ndarray
    received_to: np.ndarray
    received_by: np.ndarray
    front: np.ndarray
    band: np.ndarray
    diagonal: np.ndarray
    spread: np.ndarray
    loop: np.ndarray


def transport_buffers(n: int, m: int, band: np.ndarray) -> Transport:
    """Buffers for a grid of n columns and m rows; ``band`` (n m, >= 2 m + 6) is shared."""
    size, longest = n * m, FRONT_ROWS * (m + 2)

    def places(*shape: int) -> np.ndarray:
        return np.zeros(shape, dtype=np.int64)

    return Transport(
        shape=places(6),
        number=places(n, m),
        place=places(n, m),
        along=places(size),
        across=places(size),
        by_along=np.zeros(size),
        by_across=np.zeros(size),
        inverse=np.zeros(size),
        driven_from=places(4 * size),
        driven_to=places(4 * size),
        driven_by=np.zeros(4 * size),
        received_from=places(2 * size),
        received_to=places(2 * size),
        received_by=np.zeros(2 * size),
        front=places(size),
        band=band,
        diagonal=np.zeros(size),
        spread=np.zeros(size * longest),
        loop=np.zeros((longest, longest)),
    )


class Workspace:
    """Buffers of one film on n columns and m rows; a workspace serves one film at a time.

    Attributes
    ----------
    active : (n, m) bool array
        The active set of the last solution: the warm start of the next one.
    known : bool
        Of a film with its line in its cells: whether pressures and factor are the last solution's, too.
    convected : bool
        Whether the last mass-conserving film was factored along the flow of its cavity, in ``transport``.
    """

    def __init__(self, n: int, m: int) -> None:
        size = n * m
        self.shape = (n, m)
        self.order = np.zeros(size, dtype=np.int64)
        self.old_order = np.zeros(size, dtype=np.int64)
        self.number = np.full((n, m), -1, dtype=np.int64)
        self.band = self._new_band()
        self.inv_diag = np.zeros(size)
        self.unknowns = np.zeros(size)
        self.active = np.zeros((n, m), dtype=np.bool_)
        self.warm = self.known = False
        self.convected = False
        self.count = 0
        self.width = 1

    @cached_property
    def factor(self) -> tuple[np.ndarray, ...]:
        """Order of the unknowns and of those before, their numbers, and the symmetric factor, for kernels."""
        return self.order, self.old_order, self.number, self.band, self.inv_diag

    def _new_band(self) -> np.ndarray:
        n, m = self.shape
        return np.zeros((n * m, 2 * m + 2 + PAD))

    @cached_property
    def lower(self) -> np.ndarray:
        """L of a non-symmetric film."""
        return self._new_band()

    @cached_property
    def upper(self) -> np.ndarray:
        """U of a non-symmetric film."""
        return self._new_band()

    @cached_property
    def matrix(self) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, ...]]:
        """Derivatives, numbers of the vertices and factor (order, unknowns, L, U, 1 / diagonal) of Newton's matrix."""
        factor = self.order, self.unknowns, self.lower, self.upper, self.inv_diag
        return np.zeros((5, self.order.size)), self.number, factor

    @cached_property
    def transport(self) -> Transport:
        """Factor along the flow of a mass-conserving film; it shares the symmetric band."""
        return transport_buffers(*self.shape, self.band)
