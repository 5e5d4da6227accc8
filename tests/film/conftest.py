"""Random films for the tests of kernels and solvers."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

from exudyn_ehd.film.banded.factors import factor_band, factor_lu
from exudyn_ehd.film.banded.workspace import PAD
from exudyn_ehd.film.grid import Mesh
from exudyn_ehd.film.reynolds import links as reynolds
from exudyn_ehd.film.reynolds.balance import right_hand_side


class Film(NamedTuple):
    """Everything that a linear film problem is made of."""

    H: np.ndarray
    HF: np.ndarray
    H_t: np.ndarray
    mesh: Mesh
    vx: float
    vz: float
    flow_x: float
    metric: np.ndarray
    terms: np.ndarray
    kx: np.ndarray
    kz: np.ndarray
    fx: np.ndarray
    fz: np.ndarray
    b: np.ndarray


@pytest.fixture
def make_film() -> Callable[..., Film]:
    """A film with random gaps on a random grid; ``cut`` removes the link between the last and the first column."""

    def make(seed: int, n: int = 12, m: int = 6, *, cut: bool = False, flow_x: float = 1.0) -> Film:
        rng = np.random.default_rng(seed)
        H, HF, H_t = 0.2 + rng.random((n, m)), 0.2 + rng.random((n, m)), rng.normal(size=(n, m))
        width_x, width_z = 0.5 + rng.random(n), 0.5 + rng.random(m)
        link_x, link_z = 1.0 + rng.random(n), 1.0 + rng.random(m - 1)
        if cut:
            link_x[-1] = 0.0
        mesh = Mesh(width_x, width_z, link_x, link_z)
        vx, vz = rng.normal(size=2)
        grid = SimpleNamespace(**mesh._asdict(), cuts=None)
        metric, terms, b = reynolds.link_metric(grid, flow_x), np.zeros((10, n, m)), np.full((n, m), np.nan)
        reynolds.set_links(H, HF, None, metric, vx, vz, terms)
        right_hand_side(terms[2], terms[3], True, H_t, np.outer(width_x, width_z), b)
        return Film(H, HF, H_t, mesh, vx, vz, flow_x, metric, terms, *terms[:4], b)

    return make


@pytest.fixture(scope="session")
def dense_matrix() -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """The film's matrix of all vertices (n m, n m), link by link."""

    def build(kx: np.ndarray, kz: np.ndarray) -> np.ndarray:
        n, m = kx.shape
        A = np.zeros((n * m, n * m))

        def add(a: int, b: int, k: float) -> None:
            A[a, a] += k
            A[b, b] += k
            A[a, b] -= k
            A[b, a] -= k

        for i in range(n):
            for j in range(m):
                add(i * m + j, (i + 1) % n * m + j, kx[i, j])
                if j + 1 < m:
                    add(i * m + j, i * m + j + 1, kz[i, j])
        return A

    return build


class Factors(NamedTuple):
    """A column diagonally dominant matrix A with a full band and its L and U; A + A^T and its symmetric factor."""

    A: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    inverse: np.ndarray
    symmetric: np.ndarray
    band: np.ndarray
    band_inverse: np.ndarray


@pytest.fixture(scope="session")
def factors() -> Callable[[int, int], Factors]:
    """`Factors` of a random matrix by size and half-bandwidth."""

    def bands(A, width):
        lower, upper = (np.zeros((len(A) + PAD, width + 1 + PAD)) for _ in range(2))
        for d in range(min(width, len(A) - 1) + 1):
            upper[: len(A) - d, d], lower[: len(A) - d, d] = np.diagonal(A, d), np.diagonal(A, -d)
        return lower, upper

    def make(count, width):
        A = -np.random.default_rng(count).uniform(size=(count, count))
        A[np.abs(np.subtract.outer(np.arange(count), np.arange(count))) > width] = 0.0
        A[np.diag_indices(count)] = 1.1 + np.maximum(np.abs(A).sum(axis=0), np.abs(A).sum(axis=1))
        symmetric = A + A.T
        band, (lower, upper) = bands(symmetric, width)[1], bands(A, width)
        inverse, band_inverse = np.zeros(count), np.zeros(count)
        assert factor_lu(lower, upper, count, width, inverse)
        assert factor_band(band, count, width, band_inverse)
        return Factors(A, lower, upper, inverse, symmetric, band, band_inverse)

    return make
