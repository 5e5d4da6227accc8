"""One film on one grid: coefficients, closure, adjoint. The straight line gap -> coefficients -> pressure -> sensitivities."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation import LinearFilm
from exudyn_ehd.film.direct import Workspace, solve_many
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.loads import scatter
from exudyn_ehd.film.reynolds import (
    add_squeeze,
    conductances,
    couette_fluxes,
    link_flow_sensitivity,
    right_hand_side,
    speed_sensitivity,
)
from exudyn_ehd.status import Status


class Closure(Protocol):
    """What a cavitation model offers; see `exudyn_ehd.film.cavitation`."""

    @property
    def cavity_pressure(self) -> float: ...

    @property
    def cavity_shear(self) -> float: ...

    def solve(self, system: LinearFilm, work: Workspace) -> tuple[Status, int]: ...


class FilmSolver:
    """Solves the film for gaps that the caller writes into ``H``, ``HF`` and ``H_t``.

    Parameters
    ----------
    grid : FilmGrid
    closure : Closure
        `FullSommerfeld`, `Gumbel` or `SwiftStieber`.
    circumferential_pressure_flow : bool
        False drops the pressure flow in theta (short bearing).
    squeeze : bool
        False leaves the storage term out; ``H_t`` is then never read.

    Attributes
    ----------
    H, HF, H_t : (n, m) arrays
        Scaled gap at vertices, gap on the links i -> i+1, rate of the gap at vertices (1/s).
    pressure : (n, m) array
        Scaled pressure; rows and columns of ``grid.fixed`` hold the prescribed values.
    """

    def __init__(
        self, grid: FilmGrid, closure: Closure, *, circumferential_pressure_flow: bool = True, squeeze: bool = True
    ) -> None:
        shape = grid.shape
        self.grid = grid
        self.closure = closure
        self.squeeze = squeeze
        self.flow_x = 1.0 if circumferential_pressure_flow else 0.0
        self.H = np.ones(shape)
        self.HF = np.ones(shape)
        self.H_t = np.zeros(shape)
        self.fx = np.zeros(shape)
        self.fz = np.zeros(shape)
        self.work = Workspace(*shape)
        clips = type(closure).__name__ == "Gumbel"
        self.system = LinearFilm(shape, grid.fixed, clips=clips)
        self.vx = 0.0
        self.vz = 0.0
        coarse = grid.coarser()
        self.coarse: FilmSolver | None = None
        if (
            coarse is not None
            and hasattr(closure, "cavity_shear")
            and not clips
            and np.isfinite(closure.cavity_pressure)
        ):
            self.coarse = FilmSolver(
                coarse, closure, circumferential_pressure_flow=circumferential_pressure_flow, squeeze=squeeze
            )

    @property
    def pressure(self) -> np.ndarray:
        """Scaled pressure of the last solution (n, m)."""
        return self.system.pressure

    def forget(self) -> None:
        """Drop the warm start; the next solution starts from a coarser grid."""
        self.work.warm = False

    def solve(self, vx: float, vz: float, cavity_pressure: float) -> tuple[Status, int]:
        """Solve for the gaps now stored.

        Parameters
        ----------
        vx, vz : float
            Scaled mean surface speeds U / (2 R), 1/s.
        cavity_pressure : float
            Scaled cavity pressure, 1/s.

        Returns
        -------
        status, steps : Status, int
            Outcome and number of linear solves.
        """
        g, s = self.grid, self.system
        self.vx, self.vz = vx, vz
        conductances(self.H, self.HF, g.width_x, g.width_z, g.link_x, g.link_z, self.flow_x, s.kx, s.kz)
        couette_fluxes(self.H, self.HF, vx, vz, g.width_x, g.width_z, g.link_x, self.fx, self.fz)
        right_hand_side(self.fx, self.fz, s.b)
        if self.squeeze:
            add_squeeze(self.H_t, g.width_x, g.width_z, s.b)
        s.cavity_pressure = cavity_pressure
        if s.linear_pressure is not s.pressure:
            np.copyto(s.linear_pressure, s.pressure)
        steps = 0
        if self.coarse is not None and not self.work.warm:
            steps = self._guess_from_coarse(cavity_pressure)
        status, fine_steps = self.closure.solve(s, self.work)
        return status, steps + fine_steps

    def _guess_from_coarse(self, cavity_pressure: float) -> int:
        coarse = self.coarse
        assert coarse is not None
        coarse.H[:] = self.H[::2, ::2]
        coarse.HF[:] = self.H[1::2, ::2]
        coarse.H_t[:] = self.H_t[::2, ::2]
        coarse.pressure[:] = self.pressure[::2, ::2]
        coarse.forget()
        status, steps = coarse.solve(self.vx, self.vz, cavity_pressure)
        if status is Status.CONVERGED:
            prolong_set(coarse.work.active, self.grid.fixed, self.work.active)
            self.work.warm = True
        return steps

    def adjoint(self, rhs: np.ndarray) -> np.ndarray:
        """Solve ``A lam = rhs`` with the stored factor; rhs (k, count) is overwritten, fields (k, n, m) come back."""
        w = self.work
        solve_many(w.band, w.inv_diag, w.count, w.width, rhs)
        fields = np.empty((rhs.shape[0], *self.grid.shape))
        scatter(rhs, w.order, w.count, fields)
        return fields

    def gap_sensitivity(self, lam: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gradients (k, n, m) of the adjoint functionals with respect to ``H`` and ``HF``."""
        g = self.grid
        cell, face = np.empty_like(lam), np.empty_like(lam)
        link_flow_sensitivity(
            lam, self.system.linear_pressure, self.H, self.HF, self.vx, self.vz, self.flow_x,
            g.width_x, g.width_z, g.link_x, g.link_z, cell, face,
        )  # fmt: skip
        return cell, face

    def speed_sensitivity(self, lam: np.ndarray) -> np.ndarray:
        """Gradients (k, 2) with respect to (vx, vz)."""
        g = self.grid
        out = np.empty((lam.shape[0], 2))
        speed_sensitivity(lam, self.H, self.HF, g.width_x, g.width_z, g.link_x, out)
        return out


@njit(cache=True)
def prolong_set(coarse, fixed, fine_out):
    """Active set of a grid from that of every second vertex: active if a coarse vertex next to it is."""
    n, m = fine_out.shape
    nc = coarse.shape[0]
    for i in range(n):
        a = i // 2
        b = (a + i % 2) % nc
        for j in range(m):
            c = j // 2
            d = c + j % 2
            fine_out[i, j] = (coarse[a, c] or coarse[a, d] or coarse[b, c] or coarse[b, d]) and not fixed[i, j]
