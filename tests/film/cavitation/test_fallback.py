"""A film that does not settle from another state's set is tried again from the coarser grid."""

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.film.cavitation.closures import SOLVERS
from exudyn_ehd.film.cavitation.states import RUPTURE
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.status import Status


def test_second_try_from_the_coarser_grid(monkeypatch):
    grid = ehd.bearing_grid(0.025, 0.05, 64, 8)
    solver, plain = (FilmSolver(grid, ehd.SwiftStieber(line_in_cells=False)) for _ in range(2))
    for film in (solver, plain):
        film.H[:] = (1.0 - 0.7 * np.cos(grid.x))[:, None]
        film.HF[:] = (1.0 - 0.7 * np.cos(grid.x_face))[:, None]
    solver.work.warm = True
    solver.work.active[:] = True
    solve, refused = SOLVERS[RUPTURE], []

    def mislead(system, work):
        """Give up once on the fine grid with the set marked as a bad start."""
        if work is solver.work and work.warm and not refused and work.active.all():
            refused.append(True)
            return Status.NOT_CONVERGED, 1
        return solve(system, work)

    monkeypatch.setitem(SOLVERS, RUPTURE, mislead)
    status, steps = solver.solve(50.0, 0.0, 0.0)
    assert refused == [True]
    assert status is Status.CONVERGED
    assert steps > 1
    plain.solve(50.0, 0.0, 0.0)
    np.testing.assert_array_equal(solver.pressure, plain.pressure)
