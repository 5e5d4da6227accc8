"""The factor along the flow against dense algebra with the matrix of the folded ring."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_ldl
from exudyn_ehd.film.banded.workspace import PAD, transport_buffers
from exudyn_ehd.film.cavitation.cavity_adjoint import reduce_transposed, solve_transport_transposed
from exudyn_ehd.film.cavitation.cavity_transport import (
    FRONT,
    FULL_COUNT,
    RECEIVED,
    WIDTH,
    factor_transport,
    solve_transport,
)
from exudyn_ehd.film.cavitation.elrod_adams import assemble_elrod, film_terms
from exudyn_ehd.film.reynolds.links import Coefficients, flow_direction

N, M, PC = 14, 6, -0.3
CASES = {
    "one film": {"columns": (3, 9)},
    "against": {"columns": (3, 9), "vx": -1.0},
    "over the end of the ring": {"columns": (11, 17), "vz": 0.4},
    "two films": {"columns": (2, 5), "more": (8, 11), "vz": -0.7, "vx": -1.0},
    "strips along the ends": {"columns": (4, 9), "strips": True},
    "strips, axial flow": {"columns": (4, 9), "strips": True, "vz": 0.5},
    "full": {"columns": (0, N)},
    "instationary": {"columns": (5, 9), "inverse_step": 3.0},
    "missing links": {"columns": (0, N), "gap": 6, "strips": True},
    "missing links, against": {"columns": (0, N), "gap": 6, "vx": -1.0},
    "pocket": {"columns": (2, 9), "pocket": True, "vz": 0.2},
    "ragged": {"columns": (3, 9), "ragged": True, "vz": 0.3},
    "at rest": {"columns": (0, N), "vx": 0.0},
    "full in one row all around": {"columns": (3, 9), "seam": (1,)},
    "full in one row all around, against": {"columns": (3, 9), "seam": (4,), "vx": -1.0, "vz": 0.4},
    "full in one row all around, at rest": {"columns": (3, 9), "seam": (4,), "vx": 0.0, "inverse_step": 2.0},
    "squeezed": {"columns": (3, 9), "vx": 0.0, "inverse_step": 2.0},
}


def film(
    columns, vx=1.0, vz=0.0, more=None, strips=False, inverse_step=0.0, gap=None, pocket=False, ragged=False, seam=()
):
    """Arguments of `assemble_elrod` before the numbering, and the full vertices."""
    rng = np.random.default_rng(3)
    H = rng.uniform(0.5, 1.5, (N, M))
    kx, kz = rng.uniform(0.5, 2.0, (2, N, M))
    fx, fz = vx * rng.uniform(0.5, 1.5, (N, M)), vz * rng.uniform(0.5, 1.5, (N, M))
    kz[:, -1] = fz[:, -1] = 0.0
    if gap is not None:
        kx[gap] = fx[gap] = 0.0
    area, mass_old = rng.uniform(0.5, 1.5, (2, N, M))
    H_t = rng.uniform(-0.02, 0.02, (N, M))
    fixed = np.zeros((N, M), dtype=bool)
    fixed[:, [0, -1]] = True
    fixed[5:7, 2] = pocket
    full = np.zeros((N, M), dtype=bool)
    for span in (columns, more):
        if span is not None:
            full[np.arange(*span) % N] = True
    if strips:
        full[:, [1, -2]] = True
    full[:, seam] = True
    if ragged:
        full ^= rng.uniform(size=(N, M)) < 0.2
    full &= ~fixed
    P = np.where(fixed, 0.2, PC)
    lag = rng.uniform(0.0, 0.45, (N, M)) * (inverse_step > 0.0)
    coefficients = Coefficients(kx, kz, fx, fz, H, H_t, area, fixed, 1.0 - lag, lag * rng.uniform(size=(N, M)))
    return (coefficients, inverse_step, mass_old, PC, full), P


def dense(arguments, P):
    """Matrix, right-hand side and flat vertex of every unknown, from the kernel of the folded ring."""
    *given, full = arguments
    coefficients, inverse_step, mass_old, pc = given
    links, fixed = np.abs(coefficients.kx) + np.abs(coefficients.fx), coefficients.fixed
    order, number = np.zeros(N * M, dtype=np.int64), np.zeros((N, M), dtype=np.int64)
    count, width = number_cells(~fixed, links, order, number)
    lower, upper = np.zeros((2, count, width + 1 + PAD))
    rhs = np.zeros(N * M)
    terms = film_terms(coefficients, inverse_step, mass_old)
    assemble_elrod(terms, links, pc, full | fixed, number, order, count, P, lower, upper, rhs)
    A = np.zeros((count, count))
    for r in range(count):
        for d in range(min(width, count - 1 - r) + 1):
            A[r, r + d] = upper[r, d]
            A[r + d, r] = lower[r, d] if d else upper[r, 0]
    return A, rhs[:count], order[:count]


def check(arguments, P, rtol, atol):
    """Every solution with the factor against dense algebra, to ``rtol`` and ``atol`` of its largest; returns it."""
    A, b, places = dense(arguments, P)
    t = transport_buffers(N, M, np.full((N * M, 2 * M + 2 + PAD), np.nan))
    order, x = np.zeros(N * M, dtype=np.int64), np.zeros(N * M)
    along, across = flow_direction(arguments[0].fx), flow_direction(arguments[0].fz)
    ok, count = factor_transport(*arguments, along, across, order, P, t, x, None)
    assert ok
    assert count == len(b)
    # the same unknowns in another order
    at = np.argsort(places)[np.searchsorted(np.sort(places), order[:count])]
    np.testing.assert_array_equal(places[at], order[:count])
    A, b = A[np.ix_(at, at)], b[at]
    np.testing.assert_allclose(x[:count], b, atol=1e-13 * max(1.0, abs(b).max()))

    def equal(found, system, known):
        expected = np.linalg.solve(system, known)
        np.testing.assert_allclose(found, expected, rtol=rtol, atol=atol * max(1.0, abs(expected).max()))

    solve_transport(t, count, x)
    equal(x[:count], A, b)
    sides = np.random.default_rng(5).normal(size=(count, 5))
    known = sides.copy()
    solve_transport_transposed(t, count, sides)
    equal(sides, A.T, known)
    rows = np.ascontiguousarray(known.T)
    rows[0, t.shape[FULL_COUNT] :] = 0.0
    known[t.shape[FULL_COUNT] :, 0] = 0.0
    reduce_transposed(t, count, rows)
    solve_ldl(t.band, t.diagonal, t.shape[FULL_COUNT], t.shape[WIDTH], rows)
    equal(rows.T, A.T, known)
    return t, count


@pytest.mark.parametrize("name", CASES)
def test_against_dense(name):
    arguments, P = film(**CASES[name])
    t, count = check(arguments, P, 1e-10, 1e-11)
    fx, full = arguments[0].fx, arguments[-1]
    convects = full.sum() < count and fx.any()
    rows = 2 if CASES[name].get("strips") and "gap" not in CASES[name] else len(CASES[name].get("seam", ()))
    assert (t.received_from[: t.shape[RECEIVED]] < t.shape[FULL_COUNT]).sum() == 2 * rows
    assert (t.shape[FRONT] > 0) == (convects or rows > 0)
    assert not rows or t.shape[WIDTH] <= M - 2


@pytest.mark.parametrize("seed", range(12))
def test_any_cavity(seed):
    """Full vertices anywhere, rows full all around, conductances over six decades: no pivot, no cancellation."""
    rng = np.random.default_rng(seed)
    columns = rng.integers(N) + np.array([0, rng.integers(1, N)])
    arguments, P = film(columns=columns, vx=rng.choice([-1.0, 1.0]), inverse_step=1.0)
    coefficients, *given, full = arguments
    kx, kz = 10.0 ** rng.uniform(-3.0, 3.0, (2, N, M))
    kz[:, -1] = 0.0
    full ^= rng.uniform(size=(N, M)) < 0.05
    full[rng.integers(N)] = True
    full[:, rng.choice(np.arange(1, M - 1), rng.integers(1, 3), replace=False)] = True
    full &= ~coefficients.fixed
    check((coefficients._replace(kx=kx, kz=kz), *given, full), P, 1e-9, 1e-11)


def test_oil_that_goes_round_is_left_to_the_folded_ring():
    arguments, P = film(columns=(3, 9))
    arguments[-1][:, 3] = False
    t = transport_buffers(N, M, np.zeros((N * M, 2 * M + 2 + PAD)))
    ok, _ = factor_transport(*arguments, 1, 1, np.zeros(N * M, dtype=np.int64), P, t, np.zeros(N * M), None)
    assert not ok


def test_flow_direction():
    f = np.zeros((3, 2))
    assert flow_direction(f) == 1
    f[1, 1] = -1.0
    assert flow_direction(f) == -1
    f[2, 0] = 1.0
    assert flow_direction(f) == 0
