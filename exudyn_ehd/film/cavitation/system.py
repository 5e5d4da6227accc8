"""One film problem and its solution, as arrays that closures read and write.

Symbols: kx, kz conductances of the links, b right-hand side, P pressure, all scaled (see
`exudyn_ehd.film.reynolds.links`).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from exudyn_ehd.film.cavitation.linear_film import ColumnLine, column_line
from exudyn_ehd.film.cavitation.oil_line import OilLine, straight
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine
from exudyn_ehd.film.cavitation.states import CLIPPED, OIL
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import DensityField
from exudyn_ehd.film.reynolds.balance import FilmTerms


class FilmSystem:
    """One film problem and its solution, as arrays that closures read and write.

    Attributes
    ----------
    kx, kz, b : (n, m) arrays
        Link conductances and right-hand side.
    fixed : (n, m) bool array
        Vertices whose entry of ``pressure`` is prescribed.
    cavity_pressure : float
        Scaled.
    pressure : (n, m) array
        In: prescribed values at fixed vertices. Out: the film's pressure.
    linear_pressure : (n, m) array
        Pressure that solves the linear film, on which the adjoint is received; the same array as ``pressure`` unless
        other pressures count in loads: clipped ones, or those up to a line inside the cells.
    flow_pressure : (n, m) array
        Pressure that drives flows inside the film: ``pressure``, or where a line lies between columns the linear one.
    continued : (n, m) array or None
        ``linear_pressure``, beyond a rupture line with the negative pressures that place it inside the cells of
        `exudyn_ehd.film.cavitation.linear_film.mean_in_cells`; None where no line lies there.
    column_line : ColumnLine or None
        What continues it in a film of Swift and Stieber without pressure flow in theta.
    fx, fz, H, H_t, area : (n, m) arrays
        Couette fluxes of a full film, gap, its rate, control volumes; ``b`` already holds the fluxes and the squeeze.
    fill, mass_old : (n, m) arrays
        Film fraction, and the old value of fill H; only used by closures that conserve mass.
    prompt, late : (n, m) arrays
        Of `exudyn_ehd.film.reynolds.lagging_void`; 1 and 0 without.
    inverse_step : float
        1 / time step since ``mass_old``, 1/s; 0: steady.
    closes : bool
        Whether a steady film conserves mass and its gap closes somewhere; see
        `exudyn_ehd.film.cavitation.steady_oil`.
    turns : float
        Scaled speed with which oil goes round in the rows of a steady film that conserves mass, 1/s; 0 with axial
        speed.
    rupture : RuptureLine
        Where a film of Swift and Stieber ends.
    line : RuptureLine or None
        The same if it may end inside its cells; None: on vertices.
    oil_line : OilLine or None
        The same of a film that conserves mass.
    curve : (9, n m) array
        `CurveFields` of the vertices; straight ones of a film without a line in its cells. Made when it is asked for.
    density : DensityField or None
        None: the density does not follow the pressure.
    instant : bool
        Whether the time step stands for none.
    linked : (n,) bool array
        Columns with a link to the next one.
    terms : FilmTerms
        Holds kx, kz, fx, fz, area and prompt. Couette flows take ``prompt fill + terms.late`` along: on curves it is
        smaller than ``late``.
    fields : (15, n, m) array
        Those of ``terms``, then b, H, HF (gap on the links i -> i+1), H_t and pressure.
    """

    def __init__(self, grid: FilmGrid, kind: int) -> None:
        shape, self.kind = grid.shape, kind
        self.fields = np.zeros((15, *shape))
        self.term_fields = self.fields[:10]
        self.terms = FilmTerms(*(*self.term_fields, grid.fixed))
        self.kx, self.kz, self.fx, self.fz = self.term_fields[:4]
        self.b, self.H, self.HF, self.H_t, self.pressure = self.fields[10:]
        self.H[:] = self.HF[:] = 1.0
        self.fixed = grid.fixed
        self.cavity_pressure = 0.0
        self.linear_pressure = np.zeros(shape) if kind == CLIPPED else self.pressure
        self.flow_pressure = self.pressure
        self.area, self.terms.area[:] = grid.area, grid.area
        self.inverse_step = 0.0
        self.closes, self.turns = False, 0.0
        empty = np.ones(shape) if kind == OIL else np.ones((0, 0))
        self.fill, self.mass_old = empty, empty.copy()
        self.prompt, self.late = self.terms.prompt, np.zeros(shape)
        self.prompt[:] = 1.0
        self.line: RuptureLine | None = None
        self.column_line: ColumnLine | None = None
        self.continued: np.ndarray | None = None
        self.rupture = RuptureLine(shape)
        self.oil_line: OilLine | None = None
        self.density: DensityField | None = None
        self.instant = False
        self.linked = grid.link_x != 0.0

    def count_in_cells(self, grid: FilmGrid, clips: bool) -> None:
        """Let pressures count in loads up to a line inside the cells: where the film is clipped, or between columns."""
        if clips:
            self.continued = self.linear_pressure
            return
        self.column_line = line = column_line(grid, self.kz)
        self.linear_pressure, self.continued = line.solved, line.continued
        self.flow_pressure = line.solved

    def see_motion(self, steady: bool, rate: np.ndarray, vx: float, vz: float) -> None:
        """Take over the gap's rate (n, m) and the scaled speeds of a film that conserves mass."""
        self.closes = steady and bool(rate.min() < 0.0)
        self.turns = abs(vx) if steady and vz == 0.0 else 0.0

    def take_density(self, density: DensityField) -> None:
        """Let the density follow the pressure in all later solutions."""
        self.density = density
        if self.kind != OIL:
            self.fill, self.mass_old = np.ones((2, *self.H.shape))

    @cached_property
    def curve(self) -> np.ndarray:
        """Fields of the vertices' curves, of a film that Newton's method solves."""
        return straight(self.H.shape)

    @property
    def film(self) -> tuple[np.ndarray, ...]:
        """Fields of the terms, prescribed vertices, ``late``, and fields of the curves, as kernels take them."""
        return self.term_fields, self.fixed, self.late, self.curve

    @property
    def floor(self) -> float:
        """Scaled pressure below which the density stays."""
        return self.cavity_pressure if self.kind >= CLIPPED else -np.inf
