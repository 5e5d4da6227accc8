"""Balance of a film on a liner; see `exudyn_ehd.film.solvers.liner.film`."""

import numpy as np
from numba import njit

from exudyn_ehd.film.lubricant.density import density_ratio
from exudyn_ehd.film.reynolds.balance import film_balance, terms_of, violation
from exudyn_ehd.film.solvers.liner.elements import (
    Rates,
    bend_links,
    deflect,
    gaps_of,
    load_of,
    plain_links,
    set_storage,
)


@njit(cache=True)
def density_of_load(load_fields, P, scale, a, b, rho_out, rho_P_out):
    """Density ratio under the pressure on the elements, and its derivative to the unknown; none where a film clips."""
    load = load_of(load_fields)
    p, x, drive, slope = load.p.reshape(-1), P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1)
    rho, rho_P = rho_out.reshape(-1), rho_P_out.reshape(-1)
    for c in range(p.size):
        rho[c], by = density_ratio(p[c] * scale, a, b)
        rho_P[c] = by * scale * slope[c] if x[c] == drive[c] else 0.0


@njit(cache=True)
def liner_residual(
    P, fill, rho, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, complementary, out
):  # fmt: skip
    """Balance of every vertex for settled elements and unbent links; returns the norm of those that do not hold."""
    film, gaps = terms_of(terms, fixed), gaps_of(gap_fields)
    set_storage(gaps, load_of(load_fields), P, fill is not None, known, Rates(*rates), beta, film)
    bend_links(gaps, film)
    film_balance(P, fill, rho, film, out)
    return violation(out, P, fixed, pc, complementary)


@njit(cache=True, inline="always")
def plain_residual(
    P, fixed, numbers, kinds, load_fields, rigid, G, delta_old, gap_fields, metric, terms, known, rates, out
):  # fmt: skip
    """Balance of a film on a liner without further effects; returns (norm of what does not hold, smallest gap).

    ``numbers``: (pc, vx, vz, beta); ``kinds``: (clips, whether vertices at pc are no unknowns).
    """
    pc, vx, vz, beta = numbers
    clips, chooses = kinds
    at_vertices, at_links = deflect(P, fixed, pc, clips, load_fields, rigid, beta, G, delta_old, rates[1], gap_fields)
    smallest = min(at_vertices, at_links)
    if not smallest > 0.0:
        return np.inf, smallest
    plain_links(gap_fields, metric, vx, vz, terms)
    norm = liner_residual(P, None, None, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, chooses, out)
    return norm, smallest
