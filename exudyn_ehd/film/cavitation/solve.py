"""Semismooth Newton's method for a mass-conserving film in the unknowns of `exudyn_ehd.film.cavitation.states`.

The balance of a vertex is the sum of what its links carry and of what it stores, `exudyn_ehd.film.reynolds.balance`.
Every matrix is a column diagonally dominant M-matrix, whatever the sets, so that the film exists and is unique (see
`exudyn_ehd.film.cavitation.steady_oil` for the exceptions). The factor of the film before leads the first step: if the
film has hardly changed it leads all of them, and how they shrink says what is left (E. Hairer, G. Wanner, Solving
Ordinary Differential Equations II, 1996, section IV.8); else it foretells the sets, and every further step has a factor
of its own. Without curves the balances are linear as long as the sets stay: a step with its own factor ends.
"""

from __future__ import annotations

from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu_one
from exudyn_ehd.film.cavitation.oil_line import add_curve, curve_terms
from exudyn_ehd.film.cavitation.states import move_states, set_states, settle_states, start_states
from exudyn_ehd.film.cavitation.steady_oil import imbalance
from exudyn_ehd.film.reynolds.balance import film_balance, film_slopes, film_terms, oil_links
from exudyn_ehd.film.reynolds.lagging_void import hold_back

MOST_STEPS = 60
# What a step with an older factor may leave of a film, and a step whose own factor leaves its square.
LEFT, SETTLED = 1e-13, 1e-8
# Share that steps with an older factor have to shrink to, for another one: more takes longer than a factor of its own.
REUSABLE = 0.01
# Balance of a vertex over the largest flow: more is no rounding. Over the largest flow that drives the film: more is
# that of a singular matrix.
EVEN, BALANCED = 1e-13, 1e-8
# Rounding of the fill in a dry cavity. Less oil than none only comes from rates that last in a film without history: no
# such film exists.
LARGEST_DEFICIT = 1e-6
# Change of a place on a curve, behind whose step with a factor of its own a second one with it pays.
WORN = 0.3
# Change of a pressure over the peak, or of a fill, that takes digits of small pressures and fills with it: another step
# with the same factor brings them back.
FAR = 10.0


@njit(cache=True)
def factor_oil(film, terms, curve, full, fill, factor):
    """Number the unknowns and factor Newton's matrix; returns (ok, count, width)."""
    order, number, lower, upper, inv_diag, slopes = factor
    links, free, sets = oil_links(film, full)
    count, width = number_cells(free, links, order, number)
    film_slopes(fill, sets, None, None, terms, slopes)
    add_curve(curve, terms, slopes)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(links, film.kz, slopes, number, order, count, L, U)
    return factor_lu(L, U, count, width, inv_diag), count, width


@njit(cache=True, nogil=True)
def factor_oil_film(film, since, curve, full, fill, factor):
    """`factor_oil` of a solved film."""
    return factor_oil(film, film_terms(film, since[0], since[1]), curve, full, fill, factor)


@njit(cache=True)
def _newton(film, late, b, since, pc, curve, in_cells, start, factor, x, full, u, P, fill):
    """`solve_oil` with pressures P above the cavity's."""
    order, _, lower, upper, inv_diag, _ = factor
    (known, ready, count, width), (inverse_step, mass_old) = start, since
    flat, given = film.late.reshape(-1), late.reshape(-1)
    for c in range(flat.size):
        flat[c] = given[c]
    if inverse_step > 0.0:
        hold_back(film, inverse_step, mass_old)
    carried, rest, terms = film.late.copy(), film.kx.copy(), film_terms(film, inverse_step, mass_old)
    curve.s[:] = 1.0
    curve.slope[:] = 0.0
    curve.rise[:] = 0.0
    if in_cells:
        curve_terms(film, b, curve)
    if not known:
        start_states(film, pc, curve, full, u)
    flat, own, done, last, drift = rest.reshape(-1), False, False, LEFT, 0.0
    for step in range(MOST_STEPS):
        set_states(film, carried, curve, full, u, P, fill)
        film_balance(P, fill, None, terms, rest)
        if done:
            of_drive, of_flows = imbalance(film, terms, P, rest)
            if of_flows <= EVEN:
                sound = settle_states(film, full, P, fill) > -LARGEST_DEFICIT and of_drive <= BALANCED
                return sound, step, own and drift <= LEFT, count, width
            ready = own
        fresh = not ready
        if fresh:
            ok, count, width = factor_oil(film, terms, curve, full, fill, factor)
            if not ok:
                return False, step + 1, False, count, width
            own, drift = True, 0.0
        for r in range(count):
            x[r] = -flat[order[r]]
        solve_lu_one(dense_band(lower, count, width), dense_band(upper, count, width), inv_diag, count, width, x)
        changes, moved, bent = move_states(curve, order, count, x, full, u, P)
        if not moved < 1e300:
            return False, step + 1, False, count, width
        if fresh:
            done, ready = changes == 0 and bent <= SETTLED and moved <= FAR, changes == 0 and bent <= WORN
        else:
            # nobody knows how the first step's successors will shrink
            done = changes == 0 and moved * moved <= LEFT * last
            ready = changes == 0 and moved <= REUSABLE * (last if step > 0 else 1.0)
        drift, last = drift + bent, moved
    return False, MOST_STEPS, False, count, width


@njit(cache=True, nogil=True)
def solve_oil(film, late, b, since, pc, curve, in_cells, start, factor, x, full, u, P, fill):
    """Solve from ``full`` and ``u``, in place; returns (found, steps, whether the factor is exact, count, width).

    Parameters
    ----------
    film : Coefficients
    late, b : (n, m) arrays
        ``late`` without curves, which ``film`` gets with them; right-hand side of `exudyn_ehd.film.reynolds.links`.
    since : (float, (n, m) array)
        1 / time step since the content, 0 of a steady film, and that content.
    in_cells : bool
        Whether vertices have curves.
    start : (whether ``u`` is that of another film, whether ``factor`` is, count, width)
    factor : (order, number, lower, upper, inv_diag, slopes)
        Of `factor_oil`.
    x : (n m,) array
        Newton's step.
    """
    given, known = P.copy(), film.fixed.reshape(-1)
    pressures, kept = P.reshape(-1), given.reshape(-1)
    # flows follow differences alone: above the cavity's, small pressures keep their digits
    for c in range(known.size):
        pressures[c] = kept[c] - pc
    found = _newton(film, late, b, since, pc, curve, in_cells, start, factor, x, full, u, P, fill)
    for c in range(known.size):
        pressures[c] = kept[c] if known[c] else pressures[c] + pc
    return found
