"""A film that does not settle from another state's set is tried again from the coarser grid."""

import dataclasses

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.status import Status


@dataclasses.dataclass(frozen=True)
class _Misled:
    """Swift-Stieber that gives up once when it is asked on the fine grid with the set marked as a bad start."""

    inner: ehd.SwiftStieber = ehd.SwiftStieber()
    cavity_pressure = 0.0
    cavity_shear = 1.0
    conserves_mass = False
    clips = False
    line_in_cells = False
    refused: list = dataclasses.field(default_factory=list)

    def solve(self, system, work):
        if work.shape[0] == 64 and work.warm and not self.refused and work.active.all():
            self.refused.append(True)
            return Status.NOT_CONVERGED, 1
        return self.inner.solve(system, work)

    def adjoint(self, work, rhs):
        self.inner.adjoint(work, rhs)


def test_second_try_from_the_coarser_grid():
    grid = ehd.bearing_grid(0.025, 0.05, 64, 8)
    closure = _Misled()
    solver, plain = FilmSolver(grid, closure), FilmSolver(grid, ehd.SwiftStieber())
    for film in (solver, plain):
        film.H[:] = (1.0 - 0.7 * np.cos(grid.x))[:, None]
        film.HF[:] = (1.0 - 0.7 * np.cos(grid.x_face))[:, None]
    solver.work.warm = True
    solver.work.active[:] = True
    status, steps = solver.solve(50.0, 0.0, 0.0)
    assert closure.refused == [True]
    assert status is Status.CONVERGED
    assert steps > 1
    plain.solve(50.0, 0.0, 0.0)
    np.testing.assert_array_equal(solver.pressure, plain.pressure)
