"""A film that is not found from the last one is tried again from a full film."""

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.film.solvers import solver as module
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.status import Status


def test_second_try_from_the_full_film(monkeypatch):
    grid = ehd.bearing_grid(0.025, 0.05, 64, 8)
    solver, plain = (FilmSolver(grid, ehd.SwiftStieber(line_in_cells=False)) for _ in range(2))
    for film in (solver, plain):
        film.H[:] = (1.0 - 0.7 * np.cos(grid.x))[:, None]
        film.HF[:] = (1.0 - 0.7 * np.cos(grid.x_face))[:, None]
    solver.work.warm = True
    solve, starts = module.solve_sets, []

    def mislead(system, work):
        """Give up on every film that starts from the last one."""
        starts.append(work.warm)
        return (Status.NOT_CONVERGED, 1) if work.warm else solve(system, work)

    monkeypatch.setattr(module, "solve_sets", mislead)
    status, steps = solver.solve(50.0, 0.0, 0.0)
    assert starts == [True, False]
    assert status is Status.CONVERGED
    assert steps > 1
    plain.solve(50.0, 0.0, 0.0)
    np.testing.assert_array_equal(solver.pressure, plain.pressure)
