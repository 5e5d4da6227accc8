"""Semismooth Newton's method for a film in the unknowns of `exudyn_ehd.film.cavitation.states`.

The balance of a vertex is the sum of what its links carry and of what it stores, `exudyn_ehd.film.reynolds.balance`,
less N of `exudyn_ehd.film.cavitation.rupture_line` where a film of Swift and Stieber ends inside a cell. Unknowns are
all vertices of a film that conserves its mass or does not rupture, and those of the unbroken film of Swift and Stieber,
which a vertex leaves at u = 0 and joins where oil piles up. Without a density every matrix is a column diagonally
dominant M-matrix, whatever the sets, so that the film exists and is unique (see
`exudyn_ehd.film.cavitation.steady_oil` for the exceptions).

The factor of the film before leads the first step: if the film has hardly changed it leads all of them, and how they
shrink says what is left (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 1996, section IV.8); else it
foretells the sets, and every further step has a factor of its own. Without curves and densities the balances are linear
as long as the sets stay: a step with its own factor ends.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu_one
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.oil_line import add_curve, curve_terms
from exudyn_ehd.film.cavitation.pseudo_time import pseudo_time
from exudyn_ehd.film.cavitation.states import (
    FULL,
    OIL,
    RUPTURE,
    add_sink,
    empty_cavity,
    join_states,
    move_states,
    set_states,
    settle_states,
    start_states,
    take_sink,
)
from exudyn_ehd.film.cavitation.steady_oil import has_unfed_row, imbalance
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.lubricant.density_field import density_at, density_slope_at, know_at
from exudyn_ehd.film.reynolds.balance import film_balance, film_slopes, film_terms, oil_links
from exudyn_ehd.film.reynolds.lagging_void import hold_back
from exudyn_ehd.film.reynolds.links import Coefficients
from exudyn_ehd.status import Status

MOST_STEPS = 60
# What a step with an older factor may leave of a film, and a step whose own factor leaves its square.
LEFT, SETTLED = 1e-13, 1e-8
# Share that steps with an older factor have to shrink to, for another one: more takes longer than a factor of its own.
REUSABLE = 0.01
# Balance of a vertex over the largest flow: more is no rounding, which a density near the end of its law has more of.
# Over the largest flow that drives the film: more is that of a singular matrix.
EVEN, EVEN_DENSE, BALANCED = 1e-13, 1e-11, 1e-8
# Rounding of the fill in a dry cavity. Less oil than none only comes from rates that last in a film without history: no
# such film exists.
LARGEST_DEFICIT = 1e-6
# Change of a place on a curve over the place, behind whose step with a factor of its own a second one with it pays.
WORN = 0.3
# Weight of a change of the density against that of a place on a curve. The square of the weighted change bounds what a
# step leaves of a pressure over the peak: a mineral oil's law bends by 2 b + alpha, over its slope a, and 6 is the root
# of that. Larger values cost another step.
BENDS = 6.0
# Change of a pressure over the peak, or of a fill, that takes digits of small pressures and fills with it: another step
# with the same factor brings them back.
FAR = 10.0
# Compressibility of an oil, over its own, that films do not feel.
SOFTEST = 1e-9
# Storages in pseudo time over the largest flow into a vertex by the smallest vertex: of the first one, and of the last
# one from which a film without storage is tried.
FIRST_RATE, LAST_RATE = 0.01, 1e-7


@njit(cache=True)
def _factor(film, terms, kind, oil, curve, in_cells, full, fill, factor):
    """Number the unknowns and factor Newton's matrix; returns (ok, count, width)."""
    order, number, lower, upper, inv_diag, slopes = factor
    links, free, sets = oil_links(film, full)
    rho, rho_P = (None, None) if oil is None else (oil[4], oil[5])
    film_slopes(fill, sets, rho, rho_P, terms, slopes)
    if in_cells and kind == OIL:
        add_curve(curve, terms, rho, slopes)
    elif in_cells:
        add_sink(curve, slopes)
    count, width = number_cells(free if kind == OIL else full, links, order, number)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(links, film.kz, slopes, number, order, count, L, U)
    return factor_lu(L, U, count, width, inv_diag), count, width


@njit(cache=True, nogil=True)
def factor_film(film, since, kind, oil, curve, in_cells, full, P, fill, factor):
    """Factor of a solved film's matrix; returns (ok, count, width). Parameters as for `solve_film`."""
    if oil is not None:
        scale, floor, law, known, _, rho_P, _ = oil
        density_slope_at(P, scale, floor, law, known, rho_P)
    return _factor(film, film_terms(film, since), kind, oil, curve, in_cells, full, fill, factor)


@njit(cache=True)
def _newton(links, since, pc, kind, oil, curve, in_cells, start, factor, x, full, state):
    """`solve_film` with pressures P above the cavity's."""
    (film, late, b), (u, P, fill), (order, _, lower, upper, inv_diag, _) = links, state, factor
    (known, ready, count, width), (inverse_step, mass_old, _) = start, since
    flat, given = film.late.reshape(-1), late.reshape(-1)
    for c in range(flat.size):
        flat[c] = given[c]
    if inverse_step > 0.0:
        hold_back(film, inverse_step, mass_old)
    carried, rest, terms = film.late.copy(), film.kx.copy(), film_terms(film, since)
    curve.s[:] = 1.0
    curve.slope[:] = 0.0
    curve.rise[:] = 0.0
    absolute, density = rest, (0.0, rest, np.inf, rest, 1.0)
    if oil is not None:
        scale, floor, law, at, rho, rho_P, crosses = oil
        absolute, density = rest.copy(), (BENDS, rho_P, np.inf if crosses else law.highest / scale - pc, at, scale)
    if in_cells and kind == OIL:
        curve_terms(film, b, curve)
        if oil is not None:
            density_at(floor + 0.0 * rest, scale, floor, law, at, rho)
            for c in range(flat.size):
                curve.whole[c] *= rho[0, 0]
    if not known:
        start_states(film, pc, curve, full, u)
    elif kind == RUPTURE:
        empty_cavity(full, u)
    flat, own, done, last, drift = rest.reshape(-1), False, False, LEFT, 0.0
    for step in range(MOST_STEPS):
        set_states(film, carried, curve, full, u, P, fill)
        if oil is None:
            film_balance(P, fill, None, terms, rest)
        else:
            shifted, above = absolute.reshape(-1), P.reshape(-1)
            for c in range(flat.size):
                shifted[c] = above[c] + pc
            density_at(absolute, scale, floor, law, at, rho)
            film_balance(P, fill, rho, terms, rest)
        if kind == RUPTURE:
            if join_states(film, curve, rest, full, u) > 0:
                done = ready = False
                set_states(film, carried, curve, full, u, P, fill)
            if in_cells:
                take_sink(curve, rest)
        # pressures of a film at rest are rounding, and never settle
        if done or step + 1 == MOST_STEPS:
            of_drive, of_flows = imbalance(film, terms, P, rest, full, kind == RUPTURE)
            if of_flows <= (EVEN if oil is None else EVEN_DENSE):
                sound = settle_states(film, kind, full, P, fill) > -LARGEST_DEFICIT and of_drive <= BALANCED
                return sound, step, done and own and drift <= LEFT, count, width
            ready = own if done else ready
        fresh = not ready
        if fresh:
            if oil is not None:
                density_slope_at(absolute, scale, floor, law, at, rho_P)
            ok, count, width = _factor(film, terms, kind, oil, curve, in_cells, full, fill, factor)
            if not ok:
                return False, step + 1, False, count, width
            own, drift = True, 0.0
        for r in range(count):
            x[r] = -flat[order[r]]
        solve_lu_one(dense_band(lower, count, width), dense_band(upper, count, width), inv_diag, count, width, x)
        changes, moved, bent, worn = move_states(kind, density, curve, order, count, x, full, u, P)
        if not moved < 1e300:
            return False, step + 1, False, count, width
        if fresh:
            done, ready = changes == 0 and bent <= SETTLED and moved <= FAR, changes == 0 and worn <= WORN
        else:
            # nobody knows how the first step's successors will shrink
            done = changes == 0 and moved * moved <= LEFT * last
            ready = changes == 0 and moved <= REUSABLE * (last if step > 0 else 1.0)
        drift, last = drift + bent, moved
    return False, MOST_STEPS, False, count, width


@njit(cache=True, nogil=True)
def solve_film(links, since, pc, kind, oil, curve, in_cells, start, factor, x, full, state):
    """Solve from ``full`` and u, in place; returns (found, steps, whether the factor is exact, count, width).

    Parameters
    ----------
    links : (Coefficients, (n, m) array, (n, m) array)
        Coefficients, their ``late`` without curves, right-hand side of `exudyn_ehd.film.reynolds.links`.
    since : (float, (n, m) array, bool)
        1 / time step since the content, 0 of a steady film; that content; whether the step stands for an instant.
    pc : float
        The cavity's pressure, 0 without one.
    kind : int
        FULL, CLIPPED, RUPTURE or OIL of `states`.
    oil : (scale, floor, law, known, rho, rho_P, crosses) or None
        Density of `exudyn_ehd.film.lubricant.density_field`; None: it does not follow the pressure.
    in_cells : bool
        Whether vertices have curves.
    start : (whether u is that of another film, whether ``factor`` is, count, width)
    factor : (order, number, lower, upper, inv_diag, slopes)
    x : (n m,) array
        Newton's step.
    state : (u, P, fill)
        Unknowns, pressures and fills (n, m).
    """
    P = state[1]
    given, known = P.copy(), links[0].fixed.reshape(-1)
    pressures, kept = P.reshape(-1), given.reshape(-1)
    # flows follow differences alone: above the cavity's, small pressures keep their digits
    for c in range(known.size):
        pressures[c] = kept[c] - pc
    found = _newton(links, since, pc, kind, oil, curve, in_cells, start, factor, x, full, state)
    for c in range(known.size):
        pressures[c] = kept[c] if known[c] else pressures[c] + pc
    if oil is not None and found[0]:
        know_at(P, oil[0], oil[1], oil[2], oil[3])
    return found


def solve_system(
    s: FilmSystem, work: Workspace, film: Coefficients | None = None, since: tuple[float, np.ndarray] | None = None
) -> tuple[bool, int]:
    """`solve_film` of a system, from its last film if ``work.known``, else from ``work.active``: (found, steps).

    ``film``, ``since``: other coefficients and history than the system's.
    """
    oil = work.oil
    ok, steps, oil.exact, work.count, work.width = solve_film(
        (s.coefficients if film is None else film, s.late, s.b),
        (*((s.inverse_step, s.mass_old) if since is None else since), s.instant),
        _base(s),
        s.kind,
        None if s.density is None else s.density.fields(s.floor),
        s.curve,
        s.in_cells,
        (work.known, work.known and oil.factored, work.count, work.width),
        _buffers(work),
        work.unknowns,
        work.active,
        (oil.u, s.linear_pressure, s.fill),
    )
    work.known = oil.factored = ok
    return ok, steps


def factor_solution(s: FilmSystem, work: Workspace) -> None:
    """Make the factor that of the last solution."""
    oil = work.oil
    if not oil.exact:
        oil.exact, work.count, work.width = factor_film(
            s.coefficients,
            (s.inverse_step, s.mass_old, s.instant),
            s.kind,
            None if s.density is None else s.density.fields(s.floor),
            s.curve,
            s.in_cells,
            work.active if s.kind >= RUPTURE else ~s.fixed,
            s.linear_pressure,
            s.fill,
            _buffers(work),
        )


def _base(s: FilmSystem) -> float:
    """The cavity's scaled pressure, 0 of a film without cavitation."""
    return s.cavity_pressure if s.kind != FULL else 0.0


def _buffers(work: Workspace) -> tuple[np.ndarray, ...]:
    return work.order, work.number, work.lower, work.upper, work.inv_diag, work.oil.slopes


def recover(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """The film that Newton's method does not find from a full one, in pseudo time.

    Where the density follows the pressure it starts from the film of an oil that is next to incompressible; if no
    pressure of the law's range carries that one, the film has NO_PRESSURE.
    """
    density, steps = s.density, 0
    if density is not None:
        work.known = False
        if s.kind != RUPTURE or not work.warm:
            np.logical_not(s.fixed, out=work.active)
        scale, density.scale = density.scale, SOFTEST * density.scale
        ok, steps = solve_system(s, work)
        density.scale = scale
        beyond = ok and density.is_exhausted(s.linear_pressure)
        for crosses in (True, False) if ok else ():
            # a film beyond the end of the law bounces there for ever, unless its steps stop
            work.known, density.crosses = True, crosses
            ok, count = solve_system(s, work)
            steps += count
            if ok:
                break
        density.crosses = False
        if ok or beyond or density.is_exhausted(s.linear_pressure):
            return (Status.CONVERGED if ok else Status.NO_PRESSURE), steps
    status, count = follow(s, work)
    return status, steps + count


def follow(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Follow the film in pseudo time from a full one; NO_OIL if rows run dry on the way."""
    largest = max(float(np.max(np.abs(s.fx))), float(np.max(np.abs(s.fz))), float(np.max(np.abs(s.H_t * s.area))))
    largest += float(np.max(s.kx) * np.max(np.abs(s.pressure[s.fixed] - _base(s)), initial=0.0))
    rate = largest / float(np.min(s.area[s.area > 0.0])) + s.inverse_step
    mass = (s.mass_old if s.inverse_step > 0.0 else s.H).copy()
    work.known = runs_dry = False
    np.logical_not(s.fixed, out=work.active)

    def attempt(extra: float) -> tuple[bool, int]:
        nonlocal runs_dry
        inverse = s.inverse_step + extra
        blend = (s.inverse_step * s.mass_old + extra * mass) / inverse if inverse > 0.0 else s.mass_old
        film = s.coefficients
        if s.inverse_step == 0.0 < extra:
            # the gap's rate goes on: extra (fill H - mass) + fill dH/dt
            film = film._replace(H=s.H + s.H_t / extra)
        ok, steps = solve_system(s, work, film, (inverse, blend))
        if ok:
            np.multiply(s.fill, s.H, out=mass)
            if s.density is not None:
                np.multiply(mass, s.density.rho, out=mass)
            runs_dry = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
        return ok, steps

    ok, steps = pseudo_time(attempt, rate if rate > 0.0 else 1.0, FIRST_RATE, least=LAST_RATE)
    if ok:
        return Status.CONVERGED, steps
    return (Status.NO_OIL if runs_dry and not s.H_t.any() else Status.NOT_CONVERGED), steps
