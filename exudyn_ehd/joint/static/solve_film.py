"""Film in any given gap, on a bearing's ring or on a slider, without a journal: `solve_film`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

import numpy as np

from exudyn_ehd.bearing import Cavitation
from exudyn_ehd.film.cavitation.closures import Closure, SwiftStieber, place_line
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import Lubricant, transform_of
from exudyn_ehd.film.reynolds.gap import SteppedGap
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import (
    FilmError,
    InputError,
    Status,
    require_bool,
    require_number,
    require_plausible,
    require_type,
    require_vector,
)


@dataclass(frozen=True, eq=False)
class FilmResult:
    """Result of `solve_film`: the film in a given gap.

    Attributes
    ----------
    status : Status
    iterations : int
        Number of linear solves.
    pressure : (n, m) array
        Gauge pressure, Pa.
    gap : (n, m) array
        Film thickness, m.
    unbroken : (n, m) bool array
        True where the film is not cavitated; False at vertices with a prescribed pressure.
    inflow : (n, m) array
        Volume flow into the film at every vertex with a prescribed pressure, m3/s; zero elsewhere.
    load : float
        Integral of the pressure, N.
    fill : (n, m) array
        Film fraction; ones for closures that do not conserve mass.
    content : (n, m) array
        Oil content: fill times gap, m (with a density law also times the density over that at ambient pressure). It is
        the ``history`` of the next step.

    Examples
    --------
    After the example of `solve_film`:

    >>> film.pressure.shape, film.status.name
    ((42, 9), 'CONVERGED')
    >>> round(float(1e-5 * film.pressure.max()), 1)  # bar
    21.3
    """

    status: Status
    iterations: int
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    inflow: np.ndarray
    load: float
    fill: np.ndarray
    content: np.ndarray

    def __repr__(self) -> str:
        load, peak = shown("force", self.load), shown("pressure", float(self.pressure.max()))
        return f"<FilmResult {self.status.name}: load {load}, peak pressure {peak}>"


def solve_film(
    grid: FilmGrid,
    gap: np.ndarray,
    *,
    lubricant: Lubricant,
    surface_speed: tuple[float, float] = (0.0, 0.0),
    gap_rate: np.ndarray | None = None,
    cavitation: Closure | None = None,
    boundary: float | np.ndarray = 0.0,
    stepped_gap: bool = False,
    history: np.ndarray | None = None,
    step: float = 0.0,
) -> FilmResult:
    """Solve the Reynolds equation for any gap, on a bearing's ring or on a slider.

    Parameters
    ----------
    grid : FilmGrid
        From `bearing_grid` or `slider_grid`.
    gap : (n, m) array
        Film thickness at the vertices, shape ``grid.shape``, m, > 0. Between two vertices their mean is used, unless
        ``stepped_gap``.
    lubricant : Lubricant
        Lubricant with its pressure and density laws; a shear law is not supported, since it needs a bearing.
    surface_speed : (float, float), default (0.0, 0.0)
        Sum of both surfaces' speeds in theta (or x) and z, m/s, in the frame in which the gap is given. Half of it is
        the entrainment speed. For a journal in a bush at rest it is (R omega, 0).
    gap_rate : (n, m) array or None, default None
        dh/dt at fixed position, m/s, negative where the gap closes; None: steady.
    cavitation : closure or None, default None
        Default `SwiftStieber`.
    boundary : float or (n, m) array, default 0.0
        Gauge pressure at the prescribed vertices ``grid.fixed``, Pa.
    stepped_gap : bool, default False
        True: the gap is constant around each vertex and steps on the faces between (pockets, textures); see
        `exudyn_ehd.film.reynolds.gap`.
    history : (n, m) array or None, default None
        For `ElrodAdams` in time: ``FilmResult.content`` of the last time step, m. The change of oil content since then
        includes the squeeze, so that ``gap_rate`` is not needed. None: the film is steady.
    step : float, default 0.0
        Time since ``history``, s; > 0 if ``history`` is given.

    Returns
    -------
    FilmResult

    Raises
    ------
    InputError
        For arrays of a wrong shape, or a gap that is not positive.
    FilmError
        If the film could not be solved.

    Examples
    --------
    >>> grid = ehd.slider_grid(0.1, 0.05, n_x=40, n_z=8)
    >>> gap = np.linspace(80e-6, 40e-6, grid.shape[0])[:, None] * np.ones(grid.shape)
    >>> film = ehd.solve_film(grid, gap, lubricant=ehd.Lubricant(viscosity=0.05), surface_speed=(10.0, 0.0))
    >>> round(film.load)  # N
    4421
    """
    _check_kinds(grid, lubricant, cavitation, stepped_gap)
    closure = place_line(SwiftStieber() if cavitation is None else cavitation, True)
    gap = _require_field("gap", gap, grid)
    gap_rate = None if gap_rate is None else _require_field("gap_rate", gap_rate, grid)
    history = None if history is None else _require_field("history", history, grid)
    boundary = _require_field("boundary", boundary, grid)
    _check_film(grid, gap, gap_rate, closure, boundary, history, step)
    speed = require_vector("solve_film: surface_speed", surface_speed, 2, "m/s")
    c, R = float(np.exp(np.mean(np.log(gap)))), grid.reference_length
    scale = 12.0 * lubricant.viscosity * R**2 / c**2
    H = gap / c
    rate, mass = None if gap_rate is None else gap_rate / c, None
    if history is not None:
        mass = history / c
        rate = (H - mass) / step
    law = transform_of(lubricant)
    effects = (SteppedGap(H),) if stepped_gap else ()
    density = law if isinstance(law, CompressibleLaw) else None
    solver = FilmSolver(grid, closure, squeeze=rate is not None, flux_effects=effects, density=density)
    solver.pressure_scale = scale
    solver.H[:] = H
    solver.HF[:] = 0.5 * (H + np.roll(H, -1, axis=0))
    solver.H_t[:] = 0.0 if rate is None else rate
    known = [boundary, np.asarray(closure.cavity_pressure)]
    boundary, cavity = known if law is None else (law.transform(p) for p in known)
    solver.pressure[:] = np.where(grid.fixed, boundary, 0.0) / scale
    status, iterations = solver.solve(speed[0] / (2 * R), speed[1] / (2 * R), float(cavity) / scale, mass, step)
    oil = solver.oil_fields(law, None) if status is Status.CONVERGED else None
    if oil is None or oil.beyond:
        status = Status.NO_PRESSURE if status is Status.CONVERGED else status
        raise FilmError(f"solve_film: {status.name}: {status.advice}")
    pressure = oil.P * scale
    fill = solver.fill.copy() if closure.conserves_mass else np.ones(grid.shape)
    return FilmResult(
        status=status,
        iterations=iterations,
        pressure=pressure,
        gap=gap,
        unbroken=solver.work.active.copy(),
        inflow=solver.inflow() * c * R**2,
        load=float(np.sum(pressure * grid.weight)) * R**2,
        fill=fill,
        content=fill * gap * solver.rho,
    )


def _check_kinds(grid: object, lubricant: Lubricant, cavitation: object, stepped_gap: bool) -> None:
    require_type("solve_film: grid", grid, FilmGrid, hint="make it by bearing_grid or slider_grid.")
    require_type("solve_film: cavitation", cavitation, *get_args(Cavitation), type(None))
    require_bool("solve_film: stepped_gap", stepped_gap)
    require_type("solve_film: lubricant", lubricant, Lubricant)
    if lubricant.shear_law is not None:
        raise InputError(
            f"solve_film: the lubricant's shear_law must be None, got {lubricant.shear_law!r}; shear thinning needs "
            "the sliding speed of a JournalBearing (steady)."
        )


def _require_field(name: str, values: float | np.ndarray, grid: FilmGrid) -> np.ndarray:
    """Return finite values (n, m), for ``boundary`` also a single one; raise `InputError` for others."""
    try:
        field_ = np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"solve_film: {name} must be an array of numbers {grid.shape}, got {values!r}.") from None
    if field_.shape != grid.shape and (name != "boundary" or field_.ndim):
        raise InputError(f"solve_film: {name} must have shape {grid.shape}, got {field_.shape}.")
    if not np.all(np.isfinite(field_)):
        raise InputError(
            f"solve_film: {name} must be finite, got {np.count_nonzero(~np.isfinite(field_))} that are not."
        )
    require_plausible(f"solve_film: {name}", f"up to {np.max(np.abs(field_)):g}", field_)
    return field_


def _check_film(
    grid: FilmGrid,
    gap: np.ndarray,
    gap_rate: np.ndarray | None,
    closure: Closure,
    boundary: np.ndarray,
    history: np.ndarray | None,
    step: float,
) -> None:
    if gap.min() <= 0.0:
        raise InputError(f"solve_film: gap must be > 0 m, got {gap.min():g}.")
    lowest = float(np.broadcast_to(boundary, grid.shape)[grid.fixed].min(initial=np.inf))
    if closure.cavity_pressure > lowest:
        raise InputError(
            f"solve_film: boundary must not be below {type(closure).__name__}.cavity_pressure "
            f"({closure.cavity_pressure:g} Pa), got {lowest:g} Pa; all are gauge pressures, lower the cavity pressure."
        )
    if history is None:
        return
    if history.min() < 0.0:
        raise InputError(f"solve_film: history must be >= 0 m, got {history.min():g}; it is FilmResult.content.")
    require_number("solve_film: step", step, "s", above=0.0, hint="it is the time since the history.")
    if not closure.conserves_mass:
        raise InputError(
            f"solve_film: history is for closures that conserve mass, got {type(closure).__name__}; use "
            "cavitation=ElrodAdams(...), or gap_rate for the squeeze of a film without memory."
        )
    if gap_rate is not None:
        raise InputError(
            "solve_film: give history or gap_rate, not both: the film's change since history is its squeeze."
        )
