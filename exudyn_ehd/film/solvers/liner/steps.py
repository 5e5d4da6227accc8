"""Newton steps of a film on a liner, from one residual to the next; see `balance`.

Arguments that belong together are plain tuples: numba takes longer to inspect a named tuple than to run these kernels.

``film``: (fields of `exudyn_ehd.film.reynolds.balance.terms_of`, prescribed vertices, ``late`` of the flows without
curves, fields of `exudyn_ehd.film.cavitation.oil_line.curve_of`). ``state``: (u, pressures above the cavity's, fills).
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import add_corners, add_tangents, assemble, dense_band
from exudyn_ehd.film.banded.factors import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells, number_with_corners
from exudyn_ehd.film.cavitation.oil_line import add_curve, curve_of
from exudyn_ehd.film.cavitation.solve import BENDS, EVEN, EVEN_DENSE, GOES_ON, LOST, MOST_STEPS, look, take_step
from exudyn_ehd.film.cavitation.states import OIL, RUPTURE, add_sink, place_states, set_states
from exudyn_ehd.film.reynolds.balance import carried_fill, film_slopes, oil_links, terms_of, upstream
from exudyn_ehd.film.reynolds.link_derivatives import link_derivatives
from exudyn_ehd.film.solvers.liner.elements import Rates, add_gap_slopes, element_slopes, gaps_of, load_of, slopes_of
from exudyn_ehd.film.solvers.liner.winkler import plain_residual

# Largest share of a gap by which one step may close it; larger values risk a shut gap, smaller ones cost steps.
CLOSING = 0.8
# Smallest range of pressures, over the scaled speed (the pressure scale of a gap of one clearance). A smaller range is
# round-off of a centred journal, and counts as this.
LEAST_PRESSURE = 1e-6
# Growth of the residual from which a step is halved, the second one where vertices of a film that conserves mass change
# their side: their fills change at once, those of their neighbours in the next step. Relative change of the pressures
# below which the growth is round-off.
WORSE, REFILLED, SILENT = 2.0, 10.0, 1e-8
# Largest number of halvings of a step; steps after which round-off may be that of a density, as in gaps of 1e-5 of the
# clearance.
MOST_HALVINGS, PATIENT = 12, 20


@njit(cache=True)
def _where_filled(fill, sets):
    """Return the full vertices of a film that conserves mass; else None."""
    if fill is None:
        return None
    return sets


@njit(cache=True)
def _add_edge(fill, curve, terms, rho, slopes):
    if fill is None:
        add_sink(curve, slopes)
    else:
        add_curve(curve, terms, rho, slopes)


@njit(cache=True, nogil=True)
def find_slopes(P, fill, rho, film, elements, links):
    """Set the derivatives of the gaps (gap slopes) and of the links' flows (``by``, ``by_speed``) at the present state.

    ``elements``: (gap slopes, gaps, load, rates, beta, by of `link_derivatives`, slope of the undeformed film gap,
    slope of the contact pressure, ``bend`` of `element_slopes`); ``links``: (`LinkFlux.laws` or None, metric, vx, vz,
    by_speed).
    """
    gap_slopes, gaps, load, rates, beta, by, rigid_slope, contact_G, bend = elements
    laws, metric, vx, vz, by_speed = links
    element_slopes(P, load, rigid_slope, contact_G, bend, beta, rates[1], gap_slopes)
    terms, at = terms_of(film[0], film[1]), gaps_of(gaps)
    up = upstream(terms.fx, terms.fz, carried_fill(fill, terms), rho)
    link_derivatives(P, at.H, at.HF, at.E, up, laws, metric, vx, vz, by, by_speed)


@njit(cache=True, nogil=True)
def factor_film(kind, P, oil, film, elements, links, thin, matrix, full):
    """Set and factor Newton's matrix of a film; returns (ok, count, width).

    Parameters
    ----------
    kind : int
        Kind of film, see `exudyn_ehd.film.cavitation.states`.
    oil : (fill, rho, drho/dP); fill is None without mass conservation, rho and drho/dP at constant density
    elements, links : those of `find_slopes`
    thin : `ShearThinning.response`, or None if no conductance follows the pressure
    matrix : (order, number, lower, upper, inv_diag, slopes, relative change of links, gap or density per unit of P)
    """
    (fill, rho, rho_P), terms = oil, terms_of(film[0], film[1])
    order, number, lower, upper, inv_diag, slopes, steep = matrix
    gap_slopes, gaps, load, rates, beta, by, _, _, _ = elements
    find_slopes(P, fill, rho, film, elements, links)
    # Couette flows couple where pressure flow is dropped
    coupled, free, sets = oil_links(terms, full)
    if thin is None:
        count, width = number_cells(full if kind == RUPTURE else free, coupled, order, number)
    else:
        count, width = number_with_corners(full if kind == RUPTURE else free, coupled, order, number)
    filled = _where_filled(fill, sets)
    film_slopes(fill, filled, rho, rho_P, terms, slopes)
    if thin is not None:
        add_tangents(thin[0], terms.kx, terms.kz, filled, slopes)
    add_gap_slopes(P, fill, filled, rho, terms, slopes_of(gap_slopes), load_of(load), Rates(*rates), beta, by, slopes)
    _add_edge(fill, curve_of(film[3]), terms, rho, slopes)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(coupled, terms.kz, slopes, number, order, count, L, U)
    steep[:] = 0.0
    if thin is not None:
        add_corners(thin[1], thin[2:], terms.kx, terms.kz, filled, number, L, U)
        steep[:] = 1.0 / max(P.max() - P.min(), LEAST_PRESSURE * (abs(links[2]) + abs(links[3])), 1e-300)
    _steepen(gap_slopes[0], gaps[0], rho_P, steep)
    return factor_lu(L, U, count, width, inv_diag), count, width


@njit(cache=True)
def _steepen(yields, gap, rho_P, steep_out):
    steep, by, height = steep_out.reshape(-1), yields.reshape(-1), gap.reshape(-1)
    for c in range(steep.size):
        steep[c] = max(steep[c], by[c] / height[c])
    if rho_P is not None:
        denser = rho_P.reshape(-1)
        for c in range(steep.size):
            steep[c] = max(steep[c], denser[c])


@njit(cache=True, nogil=True)
def begin(film, kind, pc, full, state, P):
    """Unknowns of the pressures P (n, m) and fills at hand, and the film of them."""
    fixed, above = film[1], state[1]
    for i in range(P.shape[0]):
        for j in range(P.shape[1]):
            above[i, j] = P[i, j] - pc
            if kind < RUPTURE:
                full[i, j] = not fixed[i, j]
    place_states(curve_of(film[3]), full, above, state[2], state[0])
    set_film(film, pc, full, state, P)


@njit(cache=True)
def set_film(film, pc, full, state, P):
    """Set the pressures P (n, m), and the fields that `set_states` sets."""
    terms, fixed, late, curve = film
    set_states(terms_of(terms, fixed), late, curve_of(curve), full, *state)
    _lift(fixed, state[1], pc, P)


@njit(cache=True)
def _lift(fixed, pressures, pc, P):
    """Set P (n, m) from pressures above the cavity's, except at prescribed vertices."""
    known, above, x = fixed.reshape(-1), pressures.reshape(-1), P.reshape(-1)
    for c in range(x.size):
        if not known[c]:
            x[c] = above[c] + pc


@njit(cache=True)
def _shorten(share, film, pc, full, state, P, before):
    """Shorten a step: take a share of the way from the unknowns and sets ``before``; 0 takes it back."""
    x, sets, old, old_sets = state[0].reshape(-1), full.reshape(-1), before[0].reshape(-1), before[1].reshape(-1)
    for c in range(x.size):
        x[c], sets[c] = old[c] + share * (x[c] - old[c]), old_sets[c]
    set_film(film, pc, full, state, P)


@njit(cache=True)
def _open_share(above, before, yields, gap):
    """Return the largest share of a change of the pressures (n, m) that uses up at most `CLOSING` of any gap."""
    after, old, slope, height, share = above.reshape(-1), before.reshape(-1), yields.reshape(-1), gap.reshape(-1), 1.0
    for c in range(after.size):
        closing = (old[c] - after[c]) * slope[c]
        if closing > CLOSING * height[c]:
            share = min(share, CLOSING * height[c] / closing)
    return share


@njit(cache=True, nogil=True)
def proceed(norm, gap, course, kind, pc, full, state, oil, film, elements, links, thin, matrix, places):
    """Shorten the last step or take the next one, as the residual demands; returns (outcome, course).

    Parameters
    ----------
    norm, gap : float
        Norm of the residual, and the smallest gap.
    course : tuple
        Number of steps before; whether the last one had a new factor; its halvings, -1 before the first step; share of
        it that is taken, 0: none; largest norm after it; count and width of the factor; progress of `look`.
    oil, film, elements, links, thin, matrix : those of `factor_film`
    places : (P, residual, Newton's step; u, active set and pressures above the cavity's before the step)
    """
    step, fresh, tries, share, limit, count, width, progress = course
    P, rest, x, u_before, full_before, before = places
    u, above, _ = state
    if tries >= 0:
        worse = norm > limit and progress[4] > SILENT
        if (not gap > 0.0 or worse) and share > 0.0 and tries < MOST_HALVINGS:
            share = 0.5 if fresh else 0.0
            _shorten(share, film, pc, full, state, P, (u_before, full_before))
            return GOES_ON, (step, fresh, tries + 1, share, limit, count, width, progress)
        if share < 1.0:
            progress = (False, False, False, progress[3], progress[4])
    if not (gap > 0.0 and norm < np.inf):
        return LOST, course
    terms, curve, is_last = terms_of(film[0], film[1]), curve_of(film[3]), step + 1 == MOST_STEPS
    # old and new deflection cancel at an instant
    stored = elements[3][1] * np.max(np.abs(elements[1][2]) * terms.area)
    even = EVEN_DENSE if progress[2] and step >= PATIENT else EVEN
    outcome, progress = look(terms, film[2], kind, curve, even, stored, is_last, full, state, rest, progress)
    fresh = not progress[0]
    if outcome == GOES_ON and fresh:
        ok, count, width = factor_film(kind, P, oil, film, elements, links, thin, matrix, full)
        outcome = GOES_ON if ok else LOST
    if outcome != GOES_ON:
        _lift(film[1], above, pc, P)
        return outcome, (step, fresh, tries, share, limit, count, width, progress)
    order, _, lower, upper, inv_diag, _, steep = matrix
    u_before[:], full_before[:], before[:] = u, full, above
    bends = BENDS, steep, 1e300, elements[2].reshape(4, -1), 1.0
    ok, changes, progress = take_step(
        kind, bends, curve, (order, lower, upper, inv_diag), (count, width), step == 0, fresh, x, full, state, rest,
        progress,
    )  # fmt: skip
    if not ok:
        return LOST, course
    set_film(film, pc, full, state, P)
    share = _open_share(above, before, elements[0][0], elements[1][0])
    if share < 1.0:
        _shorten(share, film, pc, full, state, P, (u_before, full_before))
    limit = norm * (WORSE if fresh else 1.0)
    if kind == OIL and changes > 0:
        limit = norm * REFILLED
    return GOES_ON, (step + 1, fresh, 0, share, limit, count, width, progress)


@njit(cache=True, nogil=True)
def solve_plain(course, kind, pc, full, state, oil, film, elements, links, matrix, places, plain):
    """Solve by Newton's method for a film whose gap alone follows its pressure; returns as `proceed`.

    ``plain``: further arguments of `plain_residual`: (numbers, whether the film clips, gap and rate of the undeformed
    surfaces, true gap, old deflection, `LinerFilm.known`).
    """
    numbers, clips, rigid, G, delta_old, known = plain
    begin(film, kind, pc, full, state, places[0])
    while True:
        norm, gap = plain_residual(
            places[0], film, numbers, (clips, kind == RUPTURE), elements[2], rigid, G, delta_old, elements[1],
            links[1], known, elements[3], places[1],
        )  # fmt: skip
        outcome, course = proceed(
            norm, gap, course, kind, pc, full, state, oil, film, elements, links, None, matrix, places
        )
        if outcome != GOES_ON:
            return outcome, course
