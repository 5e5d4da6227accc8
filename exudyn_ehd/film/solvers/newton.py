"""Semismooth Newton's method for a film in the unknowns of `exudyn_ehd.film.cavitation.states`.

The residual of a vertex is its mass balance: the sum of the flows over its links and of its storage, see
`exudyn_ehd.film.reynolds.balance`. Where a film of Swift and Stieber ends inside a cell, N of
`exudyn_ehd.film.cavitation.rupture_line` is subtracted. In a film that conserves mass or does not rupture, every vertex
without a prescribed pressure has an unknown. In a film of Swift and Stieber only the active set has unknowns. A vertex
is removed from it when its u falls below 0, and added to it when more oil flows into the vertex than out of it.

Between rigid surfaces at constant density, every matrix is a column diagonally dominant M-matrix, for any active set.
So the film exists and is unique (see `exudyn_ehd.film.cavitation.closures` for the exceptions).

The first step is a chord step with the factor of the previous film. If the film has hardly changed, all steps are chord
steps. Their contraction rate gives an estimate of the error (E. Hairer, G. Wanner, Solving Ordinary Differential
Equations II, 1996, section IV.8). Otherwise the first step predicts the active set, and Newton's matrix is refactored
for the later steps. Without curves and density laws the balances are linear for a given active set. A step with the
factor of this set then gives the solution. Such steps are those of the primal-dual active set method, which for an
M-matrix is Howard's policy iteration (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Bokanowski, Maroso,
Zidani, SIAM J. Numer. Anal. 47 (2009) 3001).

Where gaps follow the pressure, a step reduces no gap by more than the fraction `LARGEST_CLOSING`. It is halved if the
norm of the residual grows.

Arguments that belong together are plain tuples: numba takes longer to inspect a named tuple than to run these kernels.

- ``film``: (``FilmSystem.fields``, prescribed vertices, ``late`` of the flows without curves, fields of
  `exudyn_ehd.film.cavitation.oil_line.curve_of`);
- ``full``: (n, m) bool, vertices whose unknown is a pressure (the active set);
- ``pc``: scaled cavity pressure, 0 without cavitation;
- ``state``: (u, pressures above the cavity's, fills), (n, m) each, fills None without mass conservation;
- ``oil``: (fill, rho, drho/dP); fill is None without mass conservation, rho and drho/dP at constant density;
- ``density``: `DensityField.fields` between rigid surfaces, else None;
- ``feedback``: (elements, links) of `exudyn_ehd.film.solvers.winkler.find_slopes`, None where neither gaps nor
  conductances follow the pressure;
- ``thin``: `ShearThinning.response`, None where no conductance follows the pressure;
- ``matrix``: (order, number, lower, upper, inv_diag, slopes, relative change of links, gap or density per unit of P);
  lower, slopes and change are None where the matrix is symmetric, factored as L D L^T in ``upper``;
- ``places``: (P, residual, Newton's step, values before the step); these are (u, active set, pressures above the
  cavity's), None where no gap follows the pressure.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.compilation import I0, I1, MOST_STEPS, NO, TOLERANCE
from exudyn_ehd.film.banded.workspace import dense_band
from exudyn_ehd.film.cavitation.closures import imbalance
from exudyn_ehd.film.cavitation.rupture_line import line_terms
from exudyn_ehd.film.cavitation.states import (
    OIL,
    RUPTURE,
    activate_vertices,
    apply_step,
    place_unknowns,
    set_fields,
    snap_to_bounds,
    subtract_sink,
)
from exudyn_ehd.film.lubricant.density import density_at
from exudyn_ehd.film.reynolds.balance import film_balance, linear_residual, terms_of
from exudyn_ehd.film.solvers.matrix import factor_film, solve_step
from exudyn_ehd.film.solvers.winkler import plain_residual
from exudyn_ehd.status import SMALL

# A chord step converges if its estimated error, over the peak pressure, is at most `TOLERANCE`. A step with a new
# factor converges if its nonlinear change (see `apply_step`) is at most this number: its error is of the order of the
# square of this change. Below a largest change of this size, growth of the residual norm is round-off.
SMALLEST_CHANGE = 1e-8
# Largest contraction rate at which chord steps continue. Larger values cost more steps, smaller ones more factors.
LARGEST_CONTRACTION_RATE = 0.01
# Largest residual of a vertex over the largest flow of the film, in place of `TOLERANCE`, with a density law, near
# whose end round-off grows. Larger values reduce the accuracy, smaller ones prevent convergence.
LOOSE_TOLERANCE = 1e-11
# Weight of a relative change of the density or a gap in the nonlinear change, in which a change of u on a curve has the
# weight 1. The error of p / p_max after a step is at most the square of the weighted change. For a mineral oil it is
# (2 b + alpha) / a, about 6^2, times the square of the density's change. Larger values cost another step.
NONLINEAR_WEIGHT = 6.0
# Largest change of p / p_max, or of a fill, in a step with a new factor that converges. After a larger change small
# pressures and fills have lost digits, which a further chord step restores.
LARGEST_FINAL_CHANGE = 0.3
# Outcomes of a step.
GOES_ON, FOUND, LOST = 0, 1, 2
# Largest fraction of a gap by which one step may reduce it; larger values risk a shut gap, smaller ones cost steps.
LARGEST_CLOSING = 0.8
# Growth factors of the residual norm above which a step is halved, with a new factor (chord steps: 1). The second one
# holds where vertices of a film that conserves mass become full or cavitated: fills then change a step before those of
# the neighbours. Larger values allow divergence, smaller ones cost steps.
LARGEST_GROWTH, LARGEST_REFILL_GROWTH = 2.0, 10.0
# Largest number of halvings of a step. Number of steps after which a converged film may have the residual
# `LOOSE_TOLERANCE`: gaps of 1e-5 of the clearance have such a round-off.
MOST_HALVINGS, TIGHT_STEPS = 12, 20


@njit(cache=True, nogil=True, inline="always")
def begin(film, kind, pc, warm, full, state, P):
    """Set the unknowns and all fields of the initial guess from the pressures P (n, m) and the fills.

    A cold start (not ``warm``) sets P first: on curves to its value at u = 1, elsewhere to the larger one of ambient
    and cavity pressure.
    """
    known, sets, above, x = film[1].reshape(-1), full.reshape(-1), state[1].reshape(-1), P.reshape(-1)
    whole, drop = film[3][4], film[3][5]
    for c in range(x.size):
        if not (warm or known[c]):
            x[c] = pc + whole[c] if whole[c] > 0.0 else max(pc, 0.0)
        sets[c] = not known[c] and (sets[c] or not warm or kind < RUPTURE)
        above[c] = x[c] - pc
    place_unknowns(whole, drop, full, above, state[2], state[0])
    _set_film(film, pc, full, state, P)


@njit(cache=True)
def _set_film(film, pc, full, state, P):
    """Set the pressures P (n, m), and the fields that `set_fields` sets."""
    set_fields(film, full, *state)
    offset_pressures(film[1], state[1], pc, P)


@njit(cache=True, inline="always")
def offset_pressures(fixed, pressures, pc, P):
    """Set P (n, m) from pressures above the cavity's, except at prescribed vertices."""
    known, above, x = fixed.reshape(-1), pressures.reshape(-1), P.reshape(-1)
    for c in range(x.size):
        if not known[c]:
            x[c] = above[c] + pc


@njit(cache=True)
def _shorten(fraction, film, pc, full, state, P, before):
    """Reduce a step from the unknowns ``before`` to a fraction of it, with the active set before; 0 reverts it."""
    x, sets, old, old_sets = state[0].reshape(-1), full.reshape(-1), before[0].reshape(-1), before[1].reshape(-1)
    for c in range(x.size):
        x[c], sets[c] = old[c] + fraction * (x[c] - old[c]), old_sets[c]
    _set_film(film, pc, full, state, P)


@njit(cache=True)
def _open_fraction(above, before, gap_by_pressure, gap):
    """Return the largest fraction, at most 1, of a change of the pressures (n, m) that reduces no gap by more than
    `LARGEST_CLOSING`.

    ``above``, ``before``: pressures after and before the change; ``gap_by_pressure``: dH/dP.
    """
    after, old, slope, height, fraction = (
        above.reshape(-1),
        before.reshape(-1),
        gap_by_pressure.reshape(-1),
        gap.reshape(-1),
        1.0,
    )
    for c in range(after.size):
        closing = (old[c] - after[c]) * slope[c]
        if closing > LARGEST_CLOSING * height[c]:
            fraction = min(fraction, LARGEST_CLOSING * height[c] / closing)
    return fraction


@njit(cache=True, inline="always")
def _judge(film, kind, tolerance, stored, is_last, full, state, residual, progress):
    """Add vertices at which oil piles up to the active set, and decide by the residual whether the film is solved;
    returns (outcome, progress).

    Parameters
    ----------
    tolerance : float
        Largest residual of a solved film, over the largest flow.
    stored : float
        Argument of `imbalance`.
    is_last : bool
        Whether the largest number of steps is reached. The residual alone then decides, as the pressures of a film at
        rest are round-off and never converge.
    residual : (n, m) array
        Mass balances, less N.
    progress : tuple
        Whether the factor is reusable for a chord step; whether it was made in this solution and the unknowns are still
        the same; whether the last step converged; sum of the nonlinear changes (see `apply_step`) since that factor;
        largest change in the last step, of p / p_max, of u on curves or of fills.
    """
    (reusable, same_unknowns, converged, summed_change, previous_change), (u, P, fill) = progress, state
    links, line = (film[0][0], film[0][1]), (film[3][0], film[3][1])
    if kind == RUPTURE and activate_vertices(film[1], links, line, residual, full, P, u) > 0:
        converged = reusable = same_unknowns = False
        set_fields(film, full, u, P, fill)
    outcome = GOES_ON
    if converged or is_last:
        of_drive, of_flows = imbalance(terms_of(film[0], film[1]), P, residual, full, kind == RUPTURE, stored)
        # the round-off of pressures that no longer change may cause a residual above the tolerance
        at_round_off = converged and previous_change <= TOLERANCE
        if of_flows <= tolerance or at_round_off:
            smallest_fill = snap_to_bounds(film[1], kind, full, P, fill)
            # more negative fills are those of steady films whose gap has a rate: no such film exists; larger residuals
            # over the flows that drive the film come from a singular matrix
            sound = smallest_fill > -SMALL and of_drive <= SMALL
            outcome = FOUND if sound else LOST
        elif is_last:
            outcome = LOST
        reusable = same_unknowns if converged else reusable
    return outcome, (reusable, same_unknowns, converged, summed_change, previous_change)


@njit(cache=True, inline="always")
def _take_step(kind, nonlinearity, whole, halves, matrix, size, is_first, fresh, x, full, state, residual, progress):
    """Take Newton's step; returns (whether it is finite, number of vertices that become full or cavitated or cross the
    end of the oil's law, progress).

    Parameters
    ----------
    nonlinearity, halves : tuple, bool
        Arguments of `apply_step`.
    size : (int, int)
        Number of unknowns, half-bandwidth.
    is_first, fresh : bool
        Whether it is the first step of the solution, and whether the factor is that of the present state.
    """
    (order, _, lower, upper, inv_diag, _, _), (count, width), flat = matrix, size, residual.reshape(-1)
    _, same_unknowns, _, summed_change, previous_change = progress
    for r in range(count):
        x[r] = -flat[order[r]]
    if count > 0:
        solve_step(lower, dense_band(upper, count, width), inv_diag, count, width, x)
    changes, largest_change, nonlinear_change, matrix_change = apply_step(
        kind, nonlinearity, whole, halves, order, count, x, full, state[0], state[1]
    )
    same_unknowns = (same_unknowns or fresh) and changes == 0
    if fresh:
        summed_change = 0.0
        converged, reusable = (
            changes == 0 and nonlinear_change <= SMALLEST_CHANGE and largest_change <= LARGEST_FINAL_CHANGE,
            changes == 0 and matrix_change <= LARGEST_CONTRACTION_RATE,
        )
    else:
        # the contraction rate is unknown after the first step
        # two steps may differ more by chance than the factor contracts
        contracted = max(largest_change, LARGEST_CONTRACTION_RATE**2 * previous_change)
        converged = changes == 0 and largest_change * contracted <= TOLERANCE * previous_change
        reusable = changes == 0 and largest_change <= LARGEST_CONTRACTION_RATE * (1.0 if is_first else previous_change)
    return (
        largest_change < 1e300,
        changes,
        (reusable, same_unknowns, converged, summed_change + nonlinear_change, largest_change),
    )


@njit(cache=True, nogil=True, inline="always")
def proceed(norm, gap, course, kind, pc, full, state, oil, density, film, feedback, thin, matrix, places):
    """Reduce the last step if the residual has grown, else take the next one; returns (outcome, course).

    Parameters
    ----------
    norm, gap : float
        Norm of the residual, and the minimum film thickness; 0 and 1 between rigid surfaces.
    course : tuple
        Number of steps so far; whether the last one had a new factor; its number of halvings, -1 before the first step;
        fraction of it that is taken, 0: reverted; norm above which it is halved; number of unknowns and half-bandwidth
        of the factor; progress of `_judge`.
    """
    step, fresh, halvings, fraction, limit, count, width, progress = course
    P, residual, x, before = places
    u, above, _ = state
    if feedback is not None and halvings >= 0:
        worse = norm > limit and progress[4] > SMALLEST_CHANGE
        if (not gap > 0.0 or worse) and fraction > 0.0 and halvings < MOST_HALVINGS:
            fraction = 0.5 if fresh else 0.0
            _shorten(fraction, film, pc, full, state, P, before)
            return GOES_ON, (step, fresh, halvings + 1, fraction, limit, count, width, progress)
        if fraction < 1.0:
            progress = (False, False, False, progress[3], progress[4])
    if not (gap > 0.0 and norm < np.inf):
        return LOST, course
    most, stored, nonlinearity = MOST_STEPS, 0.0, _nonlinearity(pc, oil, density, residual)
    if kind >= RUPTURE and density is None and feedback is None:
        # a rupture or reformation line may move by only one column per step
        most = max(most, P.shape[0])
    if feedback is not None:
        elements, relative_slopes = feedback[0], matrix[6]
        # rates at an instant: round-off of the difference of two deflections over a very short time
        stored = elements[3][1] * np.max(np.abs(elements[1][2]) * film[0][7])
        nonlinearity = NONLINEAR_WEIGHT, relative_slopes, 1e300, elements[2][2:].reshape(2, -1), 1.0
    tolerance = LOOSE_TOLERANCE if density is not None or (progress[2] and step >= TIGHT_STEPS) else TOLERANCE
    outcome, progress = _judge(film, kind, tolerance, stored, step + 1 == most, full, state, residual, progress)
    fresh = not progress[0]
    if outcome == GOES_ON and fresh:
        ok, count, width = factor_film(kind, P, oil, film, feedback, thin, matrix, full, (progress[1], count, width))
        outcome = GOES_ON if ok else LOST
    if outcome != GOES_ON:
        return outcome, (step, fresh, halvings, fraction, limit, count, width, progress)
    if feedback is not None:
        before[0][:], before[1][:], before[2][:] = u, full, above
    is_first, halves, size = step == 0, step >= TIGHT_STEPS, (count, width)
    ok, changes, progress = _take_step(
        kind, nonlinearity, film[3][4], halves, matrix, size, is_first, fresh, x, full, state, residual, progress
    )
    if not ok:
        return LOST, course
    _set_film(film, pc, full, state, P)
    if feedback is not None:
        fraction = _open_fraction(above, before[2], feedback[0][0][0], feedback[0][1][0])
        if fraction < 1.0:
            _shorten(fraction, film, pc, full, state, P, before)
    limit = norm * (LARGEST_GROWTH if fresh else 1.0)
    if kind == OIL and changes > 0:
        limit = norm * LARGEST_REFILL_GROWTH
    return GOES_ON, (step + 1, fresh, 0, fraction, limit, count, width, progress)


@njit(cache=True)
def _nonlinearity(pc, oil, density, residual):
    """Return argument ``nonlinearity`` of `apply_step` between rigid surfaces.

    ``residual``: any field (n, m), a placeholder of the right type.
    """
    if density is None:
        return 0.0, residual, np.inf, residual, 1.0
    scale, _, law, bends, crosses = density
    return NONLINEAR_WEIGHT, oil[2], np.inf if crosses else law.highest / scale - pc, bends, scale


@njit(cache=True)
def _residual(lower, P, above, oil, density, film, ruptures, out):
    """Set the residual of every vertex between rigid surfaces.

    Flows depend on pressure differences alone. So pressures ``above`` the cavity's are used, which have less round-off.
    """
    if lower is None:
        fields = film[0]
        linear_residual((fields[0], fields[1], fields[10]), above, out)
        subtract_sink(film[3][0], film[3][6], -1.0, out)
    else:
        fill, rho, rho_P = oil
        if density is not None:
            scale, floor, law, bends, _ = density
            density_at(P, scale, floor, law, bends, rho, rho_P)
        film_balance(above, fill, rho, terms_of(film[0], film[1]), out)
        if ruptures:
            subtract_sink(film[3][0], film[3][6], 1.0, out)


@njit(cache=True, inline="always")
def course_from(size):
    """Return ``course`` of `proceed` before the first step; ``size``: argument of `solve_film`."""
    reusable_at_start, count, width = size
    return I0, NO, I0 - I1, 1.0, 0.0, count, width, (reusable_at_start, NO, NO, 0.0, TOLERANCE)


@njit(cache=True, inline="always")
def end_of(outcome, course):
    """Return whether the film is solved, whether the factor is that of the solution, the numbers of steps and unknowns,
    and the half-bandwidth."""
    step, _, _, _, _, count, width, (_, same_unknowns, converged, summed_change, _) = course
    found = outcome == FOUND
    return found, found and converged and same_unknowns and summed_change <= TOLERANCE, step, count, width


@njit(cache=True, nogil=True)
def solve_film(kind, pc, warm, size, full, state, oil, density, film, feedback, matrix, places, plain):
    """Solve a film by Newton's method; returns the values of `end_of`.

    Parameters
    ----------
    warm : bool
        True: warm start from the pressures and fills of the last film; False: cold start from a full film.
    size : (bool, int, int)
        Whether the present factor is used for a first chord step, its number of unknowns and half-bandwidth.
    plain : tuple or None
        Further arguments of `plain_residual`, for a film of which the gap alone follows the pressure: (numbers, whether
        the film clips, gap and rate of the undeformed surfaces, true gap, deflection at the start of the step,
        `LinerFilm.known`). None between rigid surfaces.
    """
    begin(film, kind, pc, warm, full, state, places[0])
    norm, gap, course = 0.0, 1.0, course_from(size)
    while True:
        if plain is None:
            _residual(matrix[2], places[0], state[1], oil, density, film, kind == RUPTURE, places[1])
        else:
            (numbers, clips, rigid, G, delta_old, known), (elements, links) = plain, feedback
            norm, gap = plain_residual(
                places[0], film, numbers, (clips, kind == RUPTURE), elements[2], rigid, G, delta_old, elements[1],
                links[1], known, elements[3], places[1],
            )  # fmt: skip
        outcome, course = proceed(
            norm, gap, course, kind, pc, full, state, oil, density, film, feedback, None, matrix, places
        )
        if outcome != GOES_ON:
            offset_pressures(film[1], state[1], pc, places[0])
            return end_of(outcome, course)


@njit(cache=True, nogil=True, inline="always")
def solve_rupturing(size, pc, in_cells, warm, H_t, full, state, film, matrix, places):
    """Solve a film of Swift and Stieber without liner, density law and shear thinning, as `solve_film`.

    ``in_cells``: whether the rupture line lies inside the cells, else on vertices; ``H_t`` (n, m): rate of the gap.
    """
    (fields, fixed, _, curve), (reusable_at_start, count, width) = film, size
    inflow, known, rate = fields[10].reshape(-1), fixed.reshape(-1), H_t.reshape(-1)
    line_terms(fields[0], fields[10], fixed, in_cells, curve)
    grow, most, driven = fields[4].reshape(-1), 0.0, 0.0
    for c in range(grow.size):
        grow[c] = rate[c]
        most = max(most, abs(inflow[c]))
        if not known[c]:
            driven = max(driven, abs(inflow[c]))
    # cold start of a film at rest, or of one that only round-off drives: the last pressures are no better guess
    warm &= driven > TOLERANCE * most
    at_hand, oil = (reusable_at_start and warm, count, width), (None, None, None)
    return solve_film(RUPTURE, pc, warm, at_hand, full, state, oil, None, film, None, matrix, places, None)
