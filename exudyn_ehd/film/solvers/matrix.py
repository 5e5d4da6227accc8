"""Newton's matrix of a film, its factor and its steps; arguments as for `exudyn_ehd.film.solvers.newton`.

The matrix is symmetric, derivatives of the rupture line included, if pressures are the only unknowns, and if neither
gaps nor density nor conductances follow them. L D L^T then takes two thirds of the time of L U.
"""

from __future__ import annotations

from numba import njit

from exudyn_ehd.film.banded.factors import assemble_band, factor_band, factor_lu, number_cells, number_with_corners
from exudyn_ehd.film.banded.substitution import solve_ldl_one, solve_lu_one
from exudyn_ehd.film.banded.workspace import add_corners, add_tangents, assemble, dense_band
from exudyn_ehd.film.cavitation.oil_line import add_curve, curve_of
from exudyn_ehd.film.cavitation.states import RUPTURE, add_sink_slopes
from exudyn_ehd.film.reynolds.balance import film_slopes, oil_links, terms_of
from exudyn_ehd.film.solvers.winkler import find_slopes
from exudyn_ehd.film.solvers.winkler_kernels import Rates, add_gap_slopes, load_of, slopes_of
from exudyn_ehd.status import SMALL


@njit(cache=True)
def _full_vertices(fill, sets):
    """Return ``sets``, the full or prescribed vertices, of a film that conserves mass; None without ``fill``."""
    if fill is None:
        return None
    return sets


@njit(cache=True)
def _add_line_slopes(fill, curve, terms, rho, slopes):
    if fill is None:
        add_sink_slopes(curve, slopes)
    else:
        add_curve(curve, terms, rho, slopes)


@njit(cache=True, nogil=True)
def factor_film(kind, P, oil, film, feedback, thin, matrix, full, size):
    """Assemble and factor Newton's matrix of a film; returns (ok, number of unknowns, half-bandwidth).

    ``kind``: kind of film of `exudyn_ehd.film.cavitation.states`; P and ``full``: pressures and active set (n, m);
    ``size``: (whether the unknowns are numbered already, their number, half-bandwidth).
    """
    return _factor(matrix[2], kind, P, oil, film, feedback, thin, matrix, full, size)


@njit(cache=True)
def _factor(lower, kind, P, oil, film, feedback, thin, matrix, full, size):
    if lower is None:
        return factor_symmetric(film, matrix, full, size)
    return _factor_any(kind, P, oil, film, feedback, thin, matrix, full, size)


@njit(cache=True)
def factor_symmetric(film, matrix, full, size):
    """Assemble and factor a symmetric matrix, see the module; parameters and results as for `factor_film`."""
    (order, number, _, upper, inv_diag, _, _), (numbered, count, width) = matrix, size
    kx, kz, k, s = film[0][0], film[0][1], film[3][1], film[3][6]
    if not numbered:
        count, width = number_cells(full, kx, order, number)
    band = dense_band(upper, count, width)
    assemble_band(kx, kz, number, order, count, width, band)
    for r in range(count):
        c = order[r]
        band[r, 0] += k[c] * (1.0 - s[c]) / s[c]
    return factor_band(band, count, width, inv_diag), count, width


@njit(cache=True)
def _factor_any(kind, P, oil, film, feedback, thin, matrix, full, size):
    (fill, rho, rho_P), terms, (numbered, count, width) = oil, terms_of(film[0], film[1]), size
    order, number, lower, upper, inv_diag, slopes, relative_slopes = matrix
    # Couette flows couple columns also where the pressure flow between them is dropped
    coupled, free, sets = oil_links(terms, full)
    filled, unknown = _full_vertices(fill, sets), full if kind == RUPTURE else free
    film_slopes(fill, filled, rho, rho_P, terms, slopes)
    if thin is not None:
        add_tangents(thin[0], terms.kx, terms.kz, filled, slopes)
    if feedback is not None:
        elements, links = feedback
        gap_slopes, gaps, load, rates, beta, by, _, _, _ = elements
        find_slopes(P, fill, rho, film, elements, links)
        at = slopes_of(gap_slopes), load_of(load), Rates(*rates)
        add_gap_slopes(P, fill, filled, rho, terms, *at, beta, by, slopes)
        # over the pressure scale of a gap of one clearance; smaller differences are round-off of a centred journal
        smallest_range = SMALL * (abs(links[2]) + abs(links[3]))
        relative_slopes[:] = 0.0 if thin is None else 1.0 / max(P.max() - P.min(), smallest_range, 1e-300)
        _raise_relative_slopes(gap_slopes[0], gaps[0], rho_P, relative_slopes)
    _add_line_slopes(fill, curve_of(film[3]), terms, rho, slopes)
    if not numbered:
        if thin is None:
            count, width = number_cells(unknown, coupled, order, number)
        else:
            count, width = number_with_corners(unknown, coupled, order, number)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(coupled, terms.kz, slopes, number, order, count, L, U)
    if thin is not None:
        add_corners(thin[1], thin[2:], terms.kx, terms.kz, filled, number, L, U)
    return factor_lu(L, U, count, width, inv_diag), count, width


@njit(cache=True)
def _raise_relative_slopes(gap_by_pressure, gap, rho_P, relative_slopes_out):
    relative_slopes, by, height = relative_slopes_out.reshape(-1), gap_by_pressure.reshape(-1), gap.reshape(-1)
    for c in range(relative_slopes.size):
        relative_slopes[c] = max(relative_slopes[c], by[c] / height[c])
    if rho_P is not None:
        by_density = rho_P.reshape(-1)
        for c in range(relative_slopes.size):
            relative_slopes[c] = max(relative_slopes[c], by_density[c])


@njit(cache=True)
def solve_step(lower, upper, inv_diag, count, width, x):
    """Solve for Newton's step x (count,) in place; ``upper``: dense band of the upper factor."""
    if lower is None:
        solve_ldl_one(upper, inv_diag, count, width, x)
    else:
        solve_lu_one(dense_band(lower, count, width), upper, inv_diag, count, width, x)
