"""Semismooth Newton's method for a film in the unknowns of `exudyn_ehd.film.cavitation.states`.

The mass balance of a vertex is the sum of the flows over its links and of its storage, see
`exudyn_ehd.film.reynolds.balance`. Where a film of Swift and Stieber ends inside a cell, N of
`exudyn_ehd.film.cavitation.rupture_line` is subtracted. In a film that conserves its mass or does not rupture, all
vertices have unknowns. In a film of Swift and Stieber only those of the unbroken film do: a vertex leaves it at u = 0
and joins it where oil piles up. Unless the density follows the pressure, every matrix is a column diagonally dominant
M-matrix, whatever the sets. So the film exists and is unique (see `exudyn_ehd.film.cavitation.system` for the
exceptions).

The first step is a chord step with the factor of the previous film. If the film has hardly changed, all steps are chord
steps, and their contraction rate tells the error (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II,
1996, section IV.8). Else the first step predicts the sets, and every further step has a factor of its own. Without
curves and densities the balances are linear as long as the sets stay: a step with its own factor then is the last.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.factors import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu_one
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.oil_line import add_curve, curve_of
from exudyn_ehd.film.cavitation.states import (
    FULL,
    OIL,
    RUPTURE,
    add_sink,
    join_states,
    move_states,
    place_states,
    set_states,
    settle_states,
    start_states,
    take_sink,
)
from exudyn_ehd.film.cavitation.system import FilmSystem, imbalance
from exudyn_ehd.film.kernels import NO
from exudyn_ehd.film.lubricant.density import density_at, density_slope_at, know_at
from exudyn_ehd.film.reynolds.balance import film_balance, film_slopes, oil_links, terms_of
from exudyn_ehd.film.reynolds.links import hold_back

MOST_STEPS = 60
# Largest estimated error after a chord step, over the peak pressure; and largest change of u on a curve, and weighted
# change of the density, in a last step with its own factor, whose error is of the order of its square.
LEFT, SETTLED = 1e-13, 1e-8
# Largest contraction rate at which a factor serves on, as a whole or in rows: at larger ones a new one is faster. A
# step that changes u on a curve by a share of itself makes about that rate.
REUSABLE = 0.01
# Largest residual of a vertex that counts as round-off, over the largest flow; the second one for a density, as
# round-off grows near the end of its law. Over the largest flow that drives the film: larger residuals come from a
# singular matrix.
EVEN, EVEN_DENSE, BALANCED = 1e-13, 1e-11, 1e-6
# Largest negative fill that counts as round-off in a dry cavity. Larger ones come from rates that last in a film
# without history: no such film exists.
LARGEST_DEFICIT = 1e-6
# Weight of a relative change of the density against a change of u on a curve. The square of the weighted change bounds
# the error of a pressure over the peak after a step: that of a mineral oil is (2 b + alpha) / a, about 6^2, times the
# square of the density's change. Larger values cost another step.
BENDS = 6.0
# Largest change of a pressure over the peak, or of a fill, in a last step. Larger ones lose digits of small pressures
# and fills, which a chord step brings back.
FAR = 10.0
# Outcomes of `look`.
GOES_ON, FOUND, LOST = 0, 1, 2


@njit(cache=True, inline="always")
def _factor(terms, kind, oil, curve, full, fill, factor):
    """Number the unknowns and factor Newton's matrix; returns (ok, count, width)."""
    order, number, lower, upper, inv_diag, slopes = factor
    links, free, sets = oil_links(terms, full)
    rho, rho_P = (None, None) if oil is None else (oil[4], oil[5])
    film_slopes(fill, sets, rho, rho_P, terms, slopes)
    if kind == OIL:
        add_curve(curve, terms, rho, slopes)
    else:
        add_sink(curve, slopes)
    count, width = number_cells(free if kind == OIL else full, links, order, number)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(links, terms.kz, slopes, number, order, count, L, U)
    return factor_lu(L, U, count, width, inv_diag), count, width


@njit(cache=True, nogil=True)
def factor_film(film, kind, oil, full, P, fill, factor):
    """Factor the matrix of a solved film; returns (ok, count, width). Parameters as for `solve_film`."""
    if oil is not None:
        scale, floor, law, known, _, rho_P, _ = oil
        density_slope_at(P, scale, floor, law, known, rho_P)
    return _factor(terms_of(film[0], film[1]), kind, oil, curve_of(film[3]), full, fill, factor)


@njit(cache=True, inline="always")
def look(terms, late, kind, curve, even, stored, is_last, full, state, rest, progress):
    """Add vertices at which oil piles up to the film, and judge the residual; returns (outcome, progress).

    Parameters
    ----------
    terms : `FilmTerms`
    late : (n, m) array
        ``late`` of the terms without curves.
    kind, curve, full, state
        As for `solve_film`, pressures above the cavity's.
    even : float
        Largest residual of a film that is found, over the largest flow.
    stored : float
        That of `imbalance`.
    is_last : bool
        Whether no step is left. The residual then decides: pressures of a film at rest are round-off and never
        converge.
    rest : (n, m) array
        Mass balances, less N.
    progress : tuple
        Whether the factor serves for another step; whether it is that of a film on the way here; whether the last step
        converged; sum of the third value of `move_states` since that factor; largest change in the last step, of
        pressures over the peak, of u on curves or of fills.
    """
    (ready, own, done, drift, last), (u, P, fill) = progress, state
    if kind == RUPTURE and join_states(terms, curve, rest, full, u) > 0:
        done = ready = False
        set_states(terms, late, curve, full, u, P, fill)
    outcome = GOES_ON
    if done or is_last:
        of_drive, of_flows = imbalance(terms, P, rest, full, kind == RUPTURE, stored)
        # where a pressure's last digit changes the balances by more, the residual can't be smaller
        rests = done and last <= LEFT
        if of_flows <= even or rests:
            least = settle_states(terms, kind, full, P, fill)
            sound = least > -LARGEST_DEFICIT and of_drive <= BALANCED
            outcome = FOUND if sound else LOST
        elif is_last:
            outcome = LOST
        ready = own if done else ready
    return outcome, (ready, own, done, drift, last)


@njit(cache=True, inline="always")
def take_step(kind, bends, curve, factor, size, is_first, fresh, x, full, state, rest, progress):
    """Take Newton's step; returns (whether it is finite, number of vertices that change their side, progress).

    Parameters
    ----------
    bends : that of `move_states`
    factor : (order, lower, upper, inv_diag)
    size : (count, width)
    is_first, fresh : bool
        Whether it is the first step of the film, and whether the factor is that of the present state.
    """
    (order, lower, upper, inv_diag), (count, width), flat = factor, size, rest.reshape(-1)
    _, own, _, drift, last = progress
    for r in range(count):
        x[r] = -flat[order[r]]
    if count > 0:
        solve_lu_one(dense_band(lower, count, width), dense_band(upper, count, width), inv_diag, count, width, x)
    changes, moved, bent, worn = move_states(kind, bends, curve, order, count, x, full, state[0], state[1])
    if fresh:
        own, drift = True, 0.0
        done, ready = changes == 0 and bent <= SETTLED and moved <= FAR, changes == 0 and worn <= REUSABLE
    else:
        # the contraction rate is unknown after the first step
        done = changes == 0 and moved * moved <= LEFT * last
        ready = changes == 0 and moved <= REUSABLE * (1.0 if is_first else last)
    return moved < 1e300, changes, (ready, own, done, drift + bent, moved)


@njit(cache=True, inline="always")
def _newton(film, pc, kind, oil, start, factor, x, full, state):
    """Solve as `solve_film`, with pressures P above the cavity's."""
    (u, P, fill), (order, _, lower, upper, inv_diag, _), (known, ready, count, width) = state, factor, start
    terms, curve = terms_of(film[0], film[1]), curve_of(film[3])
    flat, given = terms.late.reshape(-1), film[2].reshape(-1)
    for c in range(flat.size):
        flat[c] = given[c]
    hold_back(terms)
    carried, rest = terms.late.copy(), terms.kx.copy()
    absolute, bends = rest, (0.0, rest, np.inf, rest, 1.0)
    if oil is not None:
        scale, floor, law, at, rho, rho_P, crosses = oil
        absolute, bends = rest.copy(), (BENDS, rho_P, np.inf if crosses else law.highest / scale - pc, at, scale)
    if not known:
        start_states(terms, pc, curve, full, u)
    else:
        place_states(curve, full, P, fill, u)
    progress, band = (ready, NO, NO, 0.0, LEFT), (order, lower, upper, inv_diag)
    set_states(terms, carried, curve, full, u, P, fill)
    for step in range(MOST_STEPS):
        if oil is None:
            film_balance(P, fill, None, terms, rest)
        else:
            shifted, above = absolute.reshape(-1), P.reshape(-1)
            for c in range(flat.size):
                shifted[c] = above[c] + pc
            density_at(absolute, scale, floor, law, at, rho)
            film_balance(P, fill, rho, terms, rest)
        if kind == RUPTURE:
            take_sink(curve, rest)
        even, is_last = EVEN if oil is None else EVEN_DENSE, step + 1 == MOST_STEPS
        outcome, progress = look(terms, carried, kind, curve, even, 0.0, is_last, full, state, rest, progress)
        if outcome != GOES_ON:
            return outcome == FOUND, step, is_exact(progress), count, width
        fresh = not progress[0]
        if fresh:
            if oil is not None:
                density_slope_at(absolute, scale, floor, law, at, rho_P)
            ok, count, width = _factor(terms, kind, oil, curve, full, fill, factor)
            if not ok:
                return False, step + 1, False, count, width
        ok, _, progress = take_step(
            kind, bends, curve, band, (count, width), step == 0, fresh, x, full, state, rest, progress
        )
        if not ok:
            return False, step + 1, False, count, width
        set_states(terms, carried, curve, full, u, P, fill)
    return False, MOST_STEPS, False, count, width


@njit(cache=True, inline="always")
def is_exact(progress):
    """Return whether the factor at the end is that of the solved film."""
    _, own, done, drift, _ = progress
    return done and own and drift <= LEFT


@njit(cache=True, nogil=True)
def solve_film(film, pc, kind, oil, start, factor, x, full, state):
    """Solve for u, pressures and fills, in place; returns (found, steps, whether the factor is exact, count, width).

    Parameters
    ----------
    film : tuple
        `FilmSystem.film`.
    pc : float
        Scaled cavity pressure, 0 without one.
    kind : int
        FULL, CLIPPED, RUPTURE or OIL of `states`.
    oil : (scale, floor, law, known, rho, rho_P, crosses) or None
        Density of `exudyn_ehd.film.lubricant.density`; None: it does not follow the pressure.
    start : (whether P and fill are a warm start, else ``full`` alone is used; whether ``factor`` serves; count; width)
    factor : (order, number, lower, upper, inv_diag, slopes)
    x : (n m,) array
        Buffer of Newton's step.
    full : (n, m) bool array
        Active set, in and out.
    state : (u, P, fill)
        Unknowns, pressures and fills (n, m).
    """
    P = state[1]
    given, known = P.copy(), film[1].reshape(-1)
    pressures, kept = P.reshape(-1), given.reshape(-1)
    # flows follow differences alone: above the cavity's, small pressures keep their digits
    for c in range(known.size):
        pressures[c] = kept[c] - pc
    found = _newton(film, pc, kind, oil, start, factor, x, full, state)
    for c in range(known.size):
        pressures[c] = kept[c] if known[c] else pressures[c] + pc
    if oil is not None and found[0]:
        know_at(P, oil[0], oil[1], oil[2], oil[3])
    return found


def solve_system(s: FilmSystem, work: Workspace) -> tuple[bool, int]:
    """Solve a system by `solve_film`, from its last film if ``work.warm``, else from a full one: (found, steps)."""
    if s.kind < RUPTURE or not work.warm:
        np.logical_not(s.fixed, out=work.active)
    ok, steps, work.exact, work.count, work.width = solve_film(
        s.film,
        base_of(s),
        s.kind,
        None if s.density is None else s.density.fields(s.floor),
        (work.warm, work.warm and work.ready, work.count, work.width),
        _buffers(work),
        work.unknowns,
        work.active,
        (work.u, s.linear_pressure, s.fill),
    )
    work.warm = work.ready = ok
    return ok, steps


def factor_solution(s: FilmSystem, work: Workspace) -> None:
    """Make the factor in the workspace that of the last solution."""
    _, work.count, work.width = factor_film(
        s.film,
        s.kind,
        None if s.density is None else s.density.fields(s.floor),
        work.active if s.kind >= RUPTURE else ~s.fixed,
        s.linear_pressure,
        s.fill,
        _buffers(work),
    )


def base_of(s: FilmSystem) -> float:
    """Return the scaled cavity pressure, 0 for a film without cavitation."""
    return s.cavity_pressure if s.kind != FULL else 0.0


def _buffers(work: Workspace) -> tuple[np.ndarray, ...]:
    return work.order, work.number, work.lower, work.upper, work.inv_diag, work.slopes
