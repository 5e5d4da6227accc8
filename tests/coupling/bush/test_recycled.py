"""Recycled equations: solved to the tolerance, and in fewer products the less the operator changes."""

import numpy as np

from exudyn_ehd.coupling.bush.linear import LARGEST, RecycledSolver


def operator(rng, n=200):
    """One plus a film: an operator whose large part has some thirty directions."""
    left, right = rng.standard_normal((n, 30)), rng.standard_normal((n, 30))
    return np.eye(n) + 3.0 / n * left @ np.diag(0.8 ** np.arange(30)) @ right.T


def solve(solver, A, b, tolerance=1e-6, most=60):
    count = [0]

    def product(x):
        count[0] += 1
        return A @ x

    return solver.solve(product, b, tolerance * np.linalg.norm(b), most), count[0]


def test_every_solution_is_within_its_tolerance_while_the_operator_changes():
    rng, solver = np.random.default_rng(1), RecycledSolver()
    A, change, counts = operator(rng), operator(rng) - np.eye(200), []
    for k in range(12):
        b = rng.standard_normal(200)
        now = A + 0.02 * k * change
        z, count = solve(solver, now, b)
        # M^-1 is not exactly what the norm of GMRES takes it for: rounding of the basis
        assert np.linalg.norm(b - now @ z) < 1.01e-6 * np.linalg.norm(b)
        assert solver.V.shape[1] <= LARGEST
        counts.append(count)
    fresh = [solve(RecycledSolver(), A, rng.standard_normal(200))[1] for _ in range(5)]
    assert np.mean(counts[6:]) < np.mean(fresh)


def test_the_same_operator_again_takes_a_fraction():
    rng, solver = np.random.default_rng(2), RecycledSolver()
    A, b = operator(rng), rng.standard_normal(200)
    first = solve(solver, A, b)[1]
    assert first > 8 and solve(solver, A, b)[1] <= 2
    # as the plain formula has it
    M = np.eye(200) + solver.G @ solver.V.T
    assert np.allclose(solver._approximate(b), np.linalg.solve(M, b), atol=1e-9)


def test_nothing_to_solve():
    assert not RecycledSolver().solve(lambda x: x, np.zeros(5), 0.0, 10).any()


def test_another_size_starts_anew():
    rng, solver = np.random.default_rng(3), RecycledSolver()
    solve(solver, operator(rng), rng.standard_normal(200))
    A, b = operator(rng, 90), rng.standard_normal(90)
    z, _ = solve(solver, A, b)
    assert np.linalg.norm(b - A @ z) < 1.01e-6 * np.linalg.norm(b)
