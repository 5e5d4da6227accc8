"""One film on one grid: its arrays, links, oil, rupture line inside its cells, and flows at prescribed vertices.

The density may follow the pressure. With the density ratio rho = rho(p) / rho_0 and the transformed pressure q of
`exudyn_ehd.film.lubricant.density`, scaled to P, the mass balance of a control volume reads

    sum over its links of (sigma V H - H^3 dP/ds) + d(rho fill H)/dt area = 0,

the compressible Reynolds equation (D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, 1966) in the scaled
form of `exudyn_ehd.film.reynolds.links`. sigma is the mean density of a link's ends (second order) times the fill of
its upstream end. The closures are unchanged in P, because q grows with p: `FullSommerfeld`, `Gumbel` (solved over
the whole film, cut off afterwards; the density follows the clipped pressure), `SwiftStieber` and `ElrodAdams`.

Storage. `ElrodAdams` with a history: difference of the void over the step, where the void is the gap less
``rho fill H``. Without a history the rate of the pressure is omitted: ``d(rho H)/dt = rho dH/dt``. The omitted term
``H d(rho)/dt``, over the squeeze, is the strain dp / K of the oil over that of the gap in the same time, dH / H. With a
bulk modulus K = 1 / a near 1.7 GPa this is 1 % for 10 MPa while the gap changes by half. The rates at an instant (a
history without a time step) omit it as well. A flooded start has oil of ambient density, so that its film builds up the
pressure over some steps.

With a rupture line inside the cells, f and the pressure at s = 1 are multiplied by the density of oil at the cavity
pressure. For these symbols see `exudyn_ehd.film.cavitation.rupture_line` and `exudyn_ehd.film.cavitation.oil_line`. If
the film needs pressures beyond the range of the density law, there is no solution.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csc_matrix, identity

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.closures import Closure, FilmSystem
from exudyn_ehd.film.cavitation.oil_line import OilLine
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine
from exudyn_ehd.film.cavitation.states import CLIPPED, FULL, OIL, RUPTURE
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.loads import end_films
from exudyn_ehd.film.lubricant.density import CompressibleLaw, DensityField
from exudyn_ehd.film.lubricant.pressure_viscosity import law_at
from exudyn_ehd.film.reynolds.balance import right_hand_side, upstream
from exudyn_ehd.film.reynolds.links import (
    FluxEffect,
    hold_back,
    lag_void,
    link_flux,
    link_metric,
    move_upstream,
    outflow_of,
    rise_slopes,
    set_links,
)
from exudyn_ehd.film.supply.restrictors import seal_ends


def flow_pressures(s: FilmSystem, active: np.ndarray, clips: bool) -> tuple[np.ndarray, np.ndarray]:
    """Pressures (n, m) whose differences drive the flows at prescribed vertices, and where the film is full.

    A film with clipped pressures (``clips``) has the gradient of the linear film next to a prescribed pressure above
    the cavity's. Its rupture line may lie in front of the next vertex. This vertex therefore has its linear pressure
    here, and counts as full.
    """
    if not clips:
        return s.linear_pressure, active
    near, pressed = np.zeros(active.shape, dtype=bool), s.fixed & (s.pressure > s.cavity_pressure)
    for axis, links in enumerate((s.kx > 0.0, s.kz > 0.0)):
        # nothing flows over the last links in z
        near |= links & np.roll(pressed, -1, axis) | np.roll(links & pressed, 1, axis)
    near &= ~s.fixed
    return np.where(near, s.linear_pressure, s.pressure), active | near


def ends_of_cavities(s: FilmSystem, conserves_mass: bool) -> list[tuple[int, int, np.ndarray]]:
    """Rows of both ends, rows beside them, and where (n,) an end has the fill of the vertex beside it.

    The half control volume of an end has the fill of a cavity beside it, though its pressure is prescribed. If the film
    conserves mass and the end pressure is above the cavity's, a full band lies along the end instead.
    """
    m = s.fixed.shape[1]
    out = []
    for end, beside in ((0, 1), (m - 1, m - 2)) if m > 2 else ():
        at = s.fixed[:, end] & ~s.fixed[:, beside]
        if conserves_mass:
            at &= s.pressure[:, end] <= s.cavity_pressure
        out.append((end, beside, at))
    return out


def shear_share(s: FilmSystem, active: np.ndarray, closure: Closure) -> np.ndarray:
    """Shear at each vertex over that of a full film (n, m)."""
    out = np.empty(s.fixed.shape)
    fill = s.fill + s.rise * (s.fill < 1.0) if closure.conserves_mass else s.fill
    _share(fill, active, s.fixed, s.pressure, s.cavity_pressure, closure.conserves_mass, closure.cavity_shear, out)
    return out


@njit(cache=True)
def _share(fill, active, fixed, P, pc, conserves, cavity_shear, out):
    n, m = out.shape
    for i in range(n):
        for j in range(m):
            out[i, j] = fill[i, j] if conserves else (1.0 if active[i, j] | fixed[i, j] else cavity_shear)
        for end, beside in ((0, 1), (m - 1, m - 2)):
            if m > 2 and fixed[i, end] and not fixed[i, beside] and not (conserves and P[i, end] > pc):
                out[i, end] = out[i, beside]


def at_beside_ends(s: FilmSystem, field: np.ndarray) -> np.ndarray:
    """Return a field with the values of ``field`` (n, m) at the ends moved to the vertices beside them, where the ends
    have their fill (in a film that conserves mass); 0 elsewhere."""
    out = np.zeros(field.shape)
    _move_beside(field, s.fixed, s.pressure, s.cavity_pressure, out)
    return out


@njit(cache=True)
def _move_beside(field, fixed, P, pc, out):
    n, m = out.shape
    for i in range(n):
        for end, beside in ((0, 1), (m - 1, m - 2)):
            if m > 2 and fixed[i, end] and not fixed[i, beside] and P[i, end] <= pc:
                out[i, beside] += field[i, end]


@njit(cache=True)
def shear_by_unknown(weight, H, ratio, by_pressure, fill, rise, active, fixed, P, pc, out):
    """Set derivatives (n, m) of a mass-conserving film's Couette shear to its unknowns: pressures where ``active``,
    else fills.

    ``weight``: integration weight of the shear; ``ratio``, ``by_pressure``: viscosity ratio for the shear and its
    derivative to the unknown; ``rise``: derivative of the fill to the pressure, at the line. Ends have the fill of the
    vertices beside them.
    """
    n, m = out.shape
    for i in range(n):
        for j in range(m):
            by = by_pressure[i, j] * fill[i, j] + ratio[i, j] * rise[i, j] if active[i, j] else ratio[i, j]
            out[i, j] = weight[i, j] / H[i, j] * by
        for end, beside in ((0, 1), (m - 1, m - 2)):
            if m > 2 and fixed[i, end] and not fixed[i, beside] and P[i, end] <= pc:
                by = rise[i, beside] if active[i, beside] else 1.0
                out[i, beside] += weight[i, end] / H[i, end] * ratio[i, end] * by


def end_films_of_areas(s: FilmSystem, active: np.ndarray, grid: FilmGrid, balance_out: np.ndarray) -> None:
    """Correct the balances (n, m) of supply areas for films that end within the link to a cavity."""
    cuts = np.ones((2, *grid.shape)) if grid.cuts is None else grid.cuts
    widths = grid.width_x, grid.width_z
    end_films((s.kx, s.kz), s.b, active, grid.fixed, cuts, widths, np.diff(grid.z), balance_out)


# Time step for the rates at an instant, over the time in which the film changes. Larger values change the rates,
# smaller ones add round-off.
INSTANT = 1e-7


class FilmArrays:
    """Arrays, links, oil and rupture line of one film; attributes as for `FilmSolver`.

    Parameters
    ----------
    grid, closure, squeeze, flux_effects, density
        As for `FilmSolver`.
    flow_x : float
        0 drops the circumferential pressure flow, else 1.
    has_feedback : bool
        Whether gaps or conductances follow the pressure.
    """

    def __init__(
        self,
        grid: FilmGrid,
        closure: Closure,
        flow_x: float,
        squeeze: bool,
        flux_effects: tuple[FluxEffect, ...],
        density: CompressibleLaw | None,
        has_feedback: bool,
    ) -> None:
        shape = grid.shape
        self.grid, self.closure, self.squeeze, self.flux_effects = grid, closure, squeeze, flux_effects
        self.flow_x, self.area, self.work = flow_x, grid.area, Workspace(*shape)
        self.ones, self.nothing, self.metric = np.ones(shape), np.zeros(shape), link_metric(grid, flow_x)
        self._whole = np.ones((2, grid.x.size * grid.z.size))
        self.vx = self.vz = 0.0
        # whether oil flows in z; without links in z it does not, even with an axially moving surface
        self.axial = bool(grid.link_z.any())
        self.lagging = False
        # whether the closure ruptures, and whether it is a complementarity problem
        self.ruptures = bool(np.isfinite(closure.cavity_pressure))
        self.complementary = self.ruptures and not closure.clips
        ruptures = RUPTURE if self.ruptures else FULL
        self.system = s = FilmSystem(grid, OIL if closure.conserves_mass else CLIPPED if closure.clips else ruptures)
        self.take_gaps(s.H, s.HF, s.H_t)
        # whether the film's matrix is symmetric: factored as L D L^T, else as L U
        self.symmetric = not (closure.conserves_mass or density is not None or has_feedback)
        self.line: RuptureLine | None = None
        self.oil_line: OilLine | None = None
        if closure.line_in_cells and closure.conserves_mass:
            self.oil_line = s.oil_line = OilLine(s.curve, shape)
        elif closure.line_in_cells and (closure.clips or flow_x == 0.0):
            s.count_in_cells(grid, closure.clips)
        elif closure.line_in_cells:
            self.line = s.rupture
            s.line = None if has_feedback else self.line
        # density law; ratio rho of the last solution (n, m), and its derivative to the unknown pressures at the last
        # factor; None, ones and None without a law
        self.law, self.density = density, None if density is None or has_feedback else DensityField(density, shape)
        self.rho: np.ndarray = self.ones
        self.rho_P: np.ndarray | None = None
        if self.density is not None:
            self.rho, self.rho_P = self.density.rho, self.density.rho_P
            s.density = self.density
            if s.kind != OIL:
                s.fill, s.mass_old = np.ones((2, *shape))
        # Pa per unit of the scaled pressure
        self.pressure_scale = 1.0
        # derivative of the last result of `keep` to the gap
        self.follows = self.nothing

    def take_gaps(self, H: np.ndarray, HF: np.ndarray, H_t: np.ndarray) -> None:
        """Use these arrays (n, m) as gaps at vertices and on links, and as rate of the gap."""
        self.H, self.HF, self.H_t = H, HF, H_t
        self.system.H, self.system.HF, self.system.H_t = H, HF, H_t
        self.flux = link_flux(HF, self.flux_effects) if self.flux_effects else None

    @property
    def pressure(self) -> np.ndarray:
        """Scaled pressure of the last solution (n, m)."""
        return self.system.pressure

    @property
    def fill(self) -> np.ndarray:
        """Film fraction of the last solution (n, m); empty if the closure does not conserve mass."""
        return self.system.fill

    @property
    def carried(self) -> np.ndarray:
        """Fill of the Couette flows out of every vertex in the last solution (n, m)."""
        s = self.system
        if not self.closure.conserves_mass:
            return self.ones
        return s.prompt * s.fill + s.terms.late if self.lagging or self.oil_line is not None else s.fill

    def taken_along(self) -> np.ndarray:
        """Fill times mean density (2, n m) of the Couette flows on the links in the last solution."""
        if self.law is None and not self.closure.conserves_mass:
            return self._whole
        carried, rho = self.carried if self.closure.conserves_mass else None, None if self.law is None else self.rho
        taken: np.ndarray = upstream(self.system.fx, self.system.fz, carried, rho)
        return taken

    @property
    def cavity_density(self) -> float:
        """Density over that at ambient pressure, of oil at the cavity pressure; 1 without a density law."""
        if self.law is None:
            return 1.0
        return float(law_at(self.system.cavity_pressure * self.pressure_scale, self.law.kernel_table)[1])

    @property
    def content(self) -> np.ndarray:
        """Scaled oil content fill H, or mass rho fill H, of the last solution (n, m)."""
        content = self.system.fill * self.H
        return content if self.law is None else self.rho * content

    def forget(self) -> None:
        """Make the next solution a cold start from a full film."""
        self.work.warm = False

    def cut_links(self) -> None:
        """Update the metric of the links for the grid's ``cuts``."""
        self.metric[:] = link_metric(self.grid, self.flow_x)

    def set_links(self) -> None:
        """Set conductances and Couette fluxes of the links."""
        s, f = self.system, self.flux
        if f is not None:
            first, *others = self.flux_effects
            first.start(f, self.H, self.vx, self.vz)
            for effect in others:
                effect.apply(f, self.HF, f.gap_z, self.vx, self.vz)
        set_links(self.H, self.HF, None if f is None else f.flow, self.metric, self.vx, self.vz, s.fields)
        if self.grid.seals is not None:
            seal_ends(self.grid, s.kz, self.pressure_scale)

    def set_right_hand_side(self) -> None:
        """Set the right-hand side: net inflow by the links' Couette flows, less the squeeze."""
        s = self.system
        right_hand_side(s.fx, s.fz, self.squeeze, self.H_t, self.area, s.b)

    def inverse_instant(self) -> float:
        """Return 1 / time step for the rates at an instant, 1/s, for the present speeds and rates, see `INSTANT`."""
        return (abs(self.vx) + abs(self.vz) + float(np.abs(self.H_t).max()) or 1.0) / INSTANT

    def set_times(self, mass_old: np.ndarray | None, step: float) -> None:
        """Set the inverse time step and the start-of-step content of a film that conserves mass."""
        s = self.system
        if not self.closure.conserves_mass:
            return
        s.closes = mass_old is None and bool(self.H_t.min() < 0.0)
        s.turns = abs(self.vx) if mass_old is None and self.vz == 0.0 else 0.0
        s.instant, s.inverse_step = mass_old is not None and step <= 0.0, 0.0
        if mass_old is not None:
            s.inverse_step = self.inverse_instant() if s.instant else 1.0 / step
            s.mass_old[:] = mass_old

    def memory(self, mass: np.ndarray | None, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return what the next step needs of the last solution and its step, (n, m), (n, m) and (4, n, m).

        The void at the end of the step; the sum of oil flows: ``mass`` at its start plus the change of content in the
        step; fields of `exudyn_ehd.film.reynolds.links`. There a vertex at a line inside the cells counts as full,
        since the flows out of it follow its pressure, not its fill.
        """
        s, (flows, outflow), content = self.system, self._outflow(), self.content
        if s.inverse_step == 0.0:
            content = content + self.rho * (outflow[0] - flows) * self.H
        return self.H - content, content if mass is None or step <= 0.0 else mass + content - s.mass_old, outflow

    def _outflow(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the fills (n, m) of the last solution, and the fields (4, n, m) for the next step."""
        s, line, links = self.system, self.oil_line, self.grid.link_x
        fill = s.fill if line is None else np.where(line.s < 1.0, 1.0, s.fill)
        outflow = outflow_of(s.fx, s.fz, s.H, s.H_t, s.area, links, fill)
        if s.inverse_step == 0.0:
            move_upstream(s.fx, s.fz, links, outflow)
        return fill, outflow

    def flows_by_fills(self) -> tuple[csc_matrix, np.ndarray]:
        """Derivative (n m, n m) of the fills of the flows to the fills of the vertices, of a steady film, and their
        differences (n, m)."""
        s, (fill, outflow), here = self.system, self._outflow(), np.arange(self.grid.area.size)
        slopes, places = rise_slopes(s.fx, s.fz, outflow[0], outflow[3], self.grid.link_x)
        cavitated = (fill < 1.0).ravel()
        by_fill = (slopes * cavitated * cavitated[places]).ravel(), (np.tile(here, 3), places.ravel())
        return csc_matrix(by_fill, shape=(here.size, here.size)) + identity(here.size, format="csc"), outflow[3]

    def flooded(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the result of `memory` for a full film at the present gaps, without flows so far."""
        return self.nothing, self.H.copy(), np.array([self.ones, self.nothing, self.nothing, self.nothing])

    def lag(self, outflow: np.ndarray | None, step: float) -> None:
        """Average the next solution's flows out of cavities over its step, from ``outflow`` (4, n, m) at its start;
        None: no average."""
        s = self.system
        if outflow is not None:
            lag_void(outflow, step, s.fixed, s.prompt, s.late, s.rise)
            self.lagging = True
        elif self.lagging:
            s.prompt[:], s.late[:], s.rise[:] = 1.0, 0.0, 0.0
            self.lagging = False

    def hold_back(self) -> None:
        """Do not average flows that would carry away more than the start-of-step content, for the present links."""
        s = self.system
        if self.lagging:
            hold_back(s.fields, s.inverse_step * s.mass_old, s.late, s.rise)

    def couette_flows(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Couette flows of the links in theta and z, and rate of a full film's content per area, all (n, m); mass flows
        with a density law."""
        if self.law is None:
            return self.system.fx, self.system.fz, self.H_t
        fill, rho = self.carried, self.rho
        flow_x, flow_z = (
            f * np.where(f >= 0.0, fill, np.roll(fill, -1, axis)) * 0.5 * (rho + np.roll(rho, -1, axis))
            for axis, f in enumerate((self.system.fx, self.system.fz))
        )
        return flow_x, flow_z, rho * self.H_t

    def flow_pressures(self) -> tuple[np.ndarray, np.ndarray]:
        """Pressures (n, m) that drive flows at prescribed vertices, and where the film is full."""
        return flow_pressures(self.system, self.work.active, self.closure.clips)

    def flow_work(self, P: np.ndarray) -> np.ndarray:
        """Scaled integral of dp over the density ratio up to scaled pressures P; see `DensityLaw.flow_work`."""
        assert self.law is not None
        return self.law.density.flow_work(P * self.pressure_scale) / self.pressure_scale
