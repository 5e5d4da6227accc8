"""Semismooth Newton's method for a film in the unknowns of `exudyn_ehd.film.cavitation.states`.

The mass balance of a vertex is the sum of the flows over its links and of its storage, see
`exudyn_ehd.film.reynolds.balance`. Where a film of Swift and Stieber ends inside a cell, N of
`exudyn_ehd.film.cavitation.rupture_line` is subtracted. In a film that conserves its mass or does not rupture, all
vertices have unknowns. In a film of Swift and Stieber only those of the unbroken film do: a vertex leaves it at u = 0
and joins it where oil piles up. Between rigid surfaces, and unless the density follows the pressure, every matrix is a
column diagonally dominant M-matrix, whatever the sets. So the film exists and is unique (see
`exudyn_ehd.film.cavitation.system` for the exceptions).

The first step is a chord step with the factor of the previous film. If the film has hardly changed, all steps are chord
steps, and their contraction rate tells the error (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II,
1996, section IV.8). Else the first step predicts the sets, and every further step has a factor of its own. Without
curves and densities the balances are linear as long as the sets stay: a step with its own factor then is the last. Such
steps are those of the primal-dual active set method, which for an M-matrix is Howard's policy iteration (Hintermueller,
Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Bokanowski, Maroso, Zidani, SIAM J. Numer. Anal. 47 (2009) 3001).

Where gaps follow the pressure, a step closes no gap by more than `CLOSING` of it, and is halved where the residual
grows.

Arguments that belong together are plain tuples: numba takes longer to inspect a named tuple than to run these kernels.

- ``film``: (``FilmSystem.fields``, prescribed vertices, ``late`` of the flows without curves, fields of
  `exudyn_ehd.film.cavitation.oil_line.curve_of`);
- ``state``: (u, pressures above the cavity's, fills), (n, m) each, fills None without mass conservation;
- ``oil``: (fill, rho, drho/dP); fill is None without mass conservation, rho and drho/dP at constant density;
- ``density``: `DensityField.fields` between rigid surfaces, else None;
- ``yielding``: (elements, links) of `exudyn_ehd.film.solvers.liner.winkler.find_slopes`, None where neither gaps nor
  conductances follow the pressure;
- ``thin``: `ShearThinning.response`, None where no conductance follows the pressure;
- ``matrix``: (order, number, lower, upper, inv_diag, slopes, relative change of links, gap or density per unit of P);
  lower, slopes and change are None where the matrix is symmetric, factored as L D L^T in ``upper``;
- ``places``: (P, residual, Newton's step; u, active set and pressures above the cavity's before the step, None where
  no gap follows the pressure).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import dense_band
from exudyn_ehd.film.cavitation.rupture_line import line_terms
from exudyn_ehd.film.cavitation.states import (
    OIL,
    RUPTURE,
    join_states,
    move_states,
    place_states,
    set_states,
    settle_states,
    take_sink,
)
from exudyn_ehd.film.cavitation.system import imbalance
from exudyn_ehd.film.kernels import I0, I1, NO
from exudyn_ehd.film.lubricant.density import density_at
from exudyn_ehd.film.reynolds.balance import film_balance, terms_of
from exudyn_ehd.film.reynolds.links import lacks
from exudyn_ehd.film.solvers.liner.winkler import plain_residual
from exudyn_ehd.film.solvers.matrix import factor_film, solve_step

MOST_STEPS = 60
# Largest estimated error after a chord step, over the peak pressure; and largest change of u on a curve, and weighted
# change of the density, in a last step with its own factor, whose error is of the order of its square.
LEFT, SETTLED = 1e-13, 1e-8
# Largest contraction rate at which a factor serves on: at larger ones a new one is faster. A step that changes u on a
# curve by a share of itself makes about that rate.
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
# Outcomes of a step.
GOES_ON, FOUND, LOST = 0, 1, 2
# Largest share of a gap by which one step may close it; larger values risk a shut gap, smaller ones cost steps.
CLOSING = 0.8
# Growth of the residual from which a step is halved, the second one where vertices of a film that conserves mass change
# their side: their fills change at once, those of their neighbours in the next step. Relative change of the pressures
# below which the growth is round-off.
WORSE, REFILLED, SILENT = 2.0, 10.0, 1e-8
# Largest number of halvings of a step; steps after which round-off may be that of a density, as in gaps of 1e-5 of the
# clearance.
MOST_HALVINGS, PATIENT = 12, 20


@njit(cache=True, nogil=True, inline="always")
def begin(film, kind, pc, warm, full, state, P):
    """Unknowns of the pressures P (n, m) and fills at hand, and the film of them.

    A start that is not ``warm`` has fully developed curves, and no gauge pressure at other vertices.
    """
    known, sets, above, x = film[1].reshape(-1), full.reshape(-1), state[1].reshape(-1), P.reshape(-1)
    whole, drop = film[3][4], film[3][5]
    for c in range(x.size):
        if not (warm or known[c]):
            x[c] = pc + whole[c] if whole[c] > 0.0 else max(pc, 0.0)
        sets[c] = not known[c] and (sets[c] or not warm or kind < RUPTURE)
        above[c] = x[c] - pc
    place_states(whole, drop, full, above, state[2], state[0])
    _set_film(film, pc, full, state, P)


@njit(cache=True)
def _set_film(film, pc, full, state, P):
    """Set the pressures P (n, m), and the fields that `set_states` sets."""
    set_states(film, full, *state)
    lift(film[1], state[1], pc, P)


@njit(cache=True, inline="always")
def lift(fixed, pressures, pc, P):
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
    _set_film(film, pc, full, state, P)


@njit(cache=True)
def _open_share(above, before, yields, gap):
    """Return the largest share of a change of the pressures (n, m) that uses up at most `CLOSING` of any gap."""
    after, old, slope, height, share = above.reshape(-1), before.reshape(-1), yields.reshape(-1), gap.reshape(-1), 1.0
    for c in range(after.size):
        closing = (old[c] - after[c]) * slope[c]
        if closing > CLOSING * height[c]:
            share = min(share, CLOSING * height[c] / closing)
    return share


@njit(cache=True, inline="always")
def _look(film, kind, even, stored, is_last, full, state, rest, progress):
    """Add vertices at which oil piles up to the film, and judge the residual; returns (outcome, progress).

    Parameters
    ----------
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
        Whether the factor serves for another step; whether it is that of a film on the way here with the same unknowns;
        whether the last step converged; sum of the third value of `move_states` since that factor; largest change in
        the last step, of pressures over the peak, of u on curves or of fills.
    """
    (ready, own, done, drift, last), (u, P, fill) = progress, state
    links, line = (film[0][0], film[0][1]), (film[3][0], film[3][1])
    if kind == RUPTURE and join_states(film[1], links, line, rest, full, P, u) > 0:
        done = ready = own = False
        set_states(film, full, u, P, fill)
    outcome = GOES_ON
    if done or is_last:
        of_drive, of_flows = imbalance(terms_of(film[0], film[1]), P, rest, full, kind == RUPTURE, stored)
        # where a pressure's last digit changes the balances by more, the residual can't be smaller
        rests = done and last <= LEFT
        if of_flows <= even or rests:
            least = settle_states(film[1], kind, full, P, fill)
            sound = least > -LARGEST_DEFICIT and of_drive <= BALANCED
            outcome = FOUND if sound else LOST
        elif is_last:
            outcome = LOST
        ready = own if done else ready
    return outcome, (ready, own, done, drift, last)


@njit(cache=True, inline="always")
def _take_step(kind, bends, whole, matrix, size, is_first, fresh, x, full, state, rest, progress):
    """Take Newton's step; returns (whether it is finite, number of vertices that change their side, progress).

    Parameters
    ----------
    bends : that of `move_states`
    size : (count, width)
    is_first, fresh : bool
        Whether it is the first step of the film, and whether the factor is that of the present state.
    """
    (order, _, lower, upper, inv_diag, _, _), (count, width), flat = matrix, size, rest.reshape(-1)
    _, own, _, drift, last = progress
    for r in range(count):
        x[r] = -flat[order[r]]
    if count > 0:
        solve_step(lower, dense_band(upper, count, width), inv_diag, count, width, x)
    changes, moved, bent, worn = move_states(kind, bends, whole, order, count, x, full, state[0], state[1])
    own = (own or fresh) and changes == 0
    if fresh:
        drift = 0.0
        done, ready = changes == 0 and bent <= SETTLED and moved <= FAR, changes == 0 and worn <= REUSABLE
    else:
        # the contraction rate is unknown after the first step
        done = changes == 0 and moved * moved <= LEFT * last
        ready = changes == 0 and moved <= REUSABLE * (1.0 if is_first else last)
    return moved < 1e300, changes, (ready, own, done, drift + bent, moved)


@njit(cache=True, nogil=True, inline="always")
def proceed(norm, gap, course, kind, pc, full, state, oil, density, film, yielding, thin, matrix, places):
    """Shorten the last step or take the next one, as the residual demands; returns (outcome, course).

    Parameters
    ----------
    norm, gap : float
        Norm of the residual, and the smallest gap; 0 and 1 between rigid surfaces.
    course : tuple
        Number of steps before; whether the last one had a new factor; its halvings, -1 before the first step; share of
        it that is taken, 0: none; largest norm after it; count and width of the factor; progress of `_look`.
    """
    step, fresh, tries, share, limit, count, width, progress = course
    P, rest, x, before = places
    u, above, _ = state
    if yielding is not None and tries >= 0:
        worse = norm > limit and progress[4] > SILENT
        if (not gap > 0.0 or worse) and share > 0.0 and tries < MOST_HALVINGS:
            share = 0.5 if fresh else 0.0
            _shorten(share, film, pc, full, state, P, before)
            return GOES_ON, (step, fresh, tries + 1, share, limit, count, width, progress)
        if share < 1.0:
            progress = (False, False, False, progress[3], progress[4])
    if not (gap > 0.0 and norm < np.inf):
        return LOST, course
    most, stored, bends = MOST_STEPS, 0.0, _bends(pc, oil, density, rest)
    if kind == RUPTURE and density is None and yielding is None:
        # a line moves by a column a step
        most = max(most, P.shape[0])
    if yielding is not None:
        elements, steep = yielding[0], matrix[6]
        # old and new deflection cancel at an instant
        stored = elements[3][1] * np.max(np.abs(elements[1][2]) * film[0][7])
        bends = BENDS, steep, 1e300, elements[2].reshape(4, -1), 1.0
    even = EVEN_DENSE if density is not None or (progress[2] and step >= PATIENT) else EVEN
    outcome, progress = _look(film, kind, even, stored, step + 1 == most, full, state, rest, progress)
    fresh = not progress[0]
    if outcome == GOES_ON and fresh:
        ok, count, width = factor_film(
            kind, P, oil, density, film, yielding, thin, matrix, full, (progress[1], count, width)
        )
        outcome = GOES_ON if ok else LOST
    if outcome != GOES_ON:
        return outcome, (step, fresh, tries, share, limit, count, width, progress)
    if yielding is not None:
        before[0][:], before[1][:], before[2][:] = u, full, above
    is_first, size = step == 0, (count, width)
    ok, changes, progress = _take_step(
        kind, bends, film[3][4], matrix, size, is_first, fresh, x, full, state, rest, progress
    )
    if not ok:
        return LOST, course
    _set_film(film, pc, full, state, P)
    if yielding is not None:
        share = _open_share(above, before[2], yielding[0][0][0], yielding[0][1][0])
        if share < 1.0:
            _shorten(share, film, pc, full, state, P, before)
    limit = norm * (WORSE if fresh else 1.0)
    if kind == OIL and changes > 0:
        limit = norm * REFILLED
    return GOES_ON, (step + 1, fresh, 0, share, limit, count, width, progress)


@njit(cache=True)
def _bends(pc, oil, density, rest):
    """Argument ``bends`` of `move_states` between rigid surfaces; ``rest``: a field (n, m) that is not looked at."""
    if density is None:
        return 0.0, rest, np.inf, rest, 1.0
    scale, _, law, known, crosses = density
    return BENDS, oil[2], np.inf if crosses else law.highest / scale - pc, known, scale


@njit(cache=True)
def _residual(lower, P, above, oil, density, film, ruptures, out):
    """Set the residual of every vertex between rigid surfaces; flows follow differences, so that pressures above the
    cavity's keep their digits."""
    if lower is None:
        fields = film[0]
        lacks((fields[0], fields[1], fields[10]), above, out)
        take_sink(film[3][0], film[3][6], -1.0, out)
    else:
        fill, rho, _ = oil
        if density is not None:
            scale, floor, law, known, _ = density
            density_at(P, scale, floor, law, known, rho)
        film_balance(above, fill, rho, terms_of(film[0], film[1]), out)
        if ruptures:
            take_sink(film[3][0], film[3][6], 1.0, out)


@njit(cache=True, inline="always")
def course_from(size):
    """``course`` of `proceed` before the first step; ``size``: that of `solve_film`."""
    serves, count, width = size
    return I0, NO, I0 - I1, 1.0, 0.0, count, width, (serves, NO, NO, 0.0, LEFT)


@njit(cache=True, inline="always")
def end_of(outcome, course):
    """Return whether a film is found, whether the factor is its own, steps, count and width."""
    step, _, _, _, _, count, width, (_, own, done, drift, _) = course
    found = outcome == FOUND
    return found, found and done and own and drift <= LEFT, step, count, width


@njit(cache=True, nogil=True)
def solve_film(kind, pc, warm, size, full, state, oil, density, film, yielding, matrix, places, plain):
    """Solve by Newton's method, from the film at hand if it is ``warm``, else from a full one; returns as `end_of`.

    ``size``: (whether the factor at hand serves for the first step, its count and width); ``plain``: for a film whose
    gap alone follows its pressure, further arguments of `plain_residual`: (numbers, whether the film clips, gap and
    rate of the undeformed surfaces, true gap, old deflection, `LinerFilm.known`); None between rigid surfaces.
    """
    begin(film, kind, pc, warm, full, state, places[0])
    norm, gap, course = 0.0, 1.0, course_from(size)
    while True:
        if plain is None:
            _residual(matrix[2], places[0], state[1], oil, density, film, kind == RUPTURE, places[1])
        else:
            (numbers, clips, rigid, G, delta_old, known), (elements, links) = plain, yielding
            norm, gap = plain_residual(
                places[0], film, numbers, (clips, kind == RUPTURE), elements[2], rigid, G, delta_old, elements[1],
                links[1], known, elements[3], places[1],
            )  # fmt: skip
        outcome, course = proceed(
            norm, gap, course, kind, pc, full, state, oil, density, film, yielding, None, matrix, places
        )
        if outcome != GOES_ON:
            lift(film[1], state[1], pc, places[0])
            return end_of(outcome, course)


@njit(cache=True, nogil=True, inline="always")
def solve_rupturing(size, pc, in_cells, warm, H_t, full, state, film, matrix, places):
    """`solve_film` of a film of Swift and Stieber without liner, density law and shear thinning.

    ``in_cells``: whether the film may end inside its cells, else on vertices; ``H_t`` (n, m): rate of the gap.
    """
    (fields, fixed, _, curve), (serves, count, width) = film, size
    inflow, known, rate = fields[10].reshape(-1), fixed.reshape(-1), H_t.reshape(-1)
    line_terms(fields[0], fields[10], fixed, in_cells, curve)
    grow, most, driven = fields[4].reshape(-1), 0.0, 0.0
    for c in range(grow.size):
        grow[c] = rate[c]
        most = max(most, abs(inflow[c]))
        if not known[c]:
            driven = max(driven, abs(inflow[c]))
    # pressures that are left over lead nowhere in a film at rest, or where nothing but round-off drives it
    warm &= driven > EVEN * most
    at_hand, oil = (serves and warm, count, width), (None, None, None)
    return solve_film(RUPTURE, pc, warm, at_hand, full, state, oil, None, film, None, matrix, places, None)
