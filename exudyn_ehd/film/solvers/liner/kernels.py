"""Kernels for the mass balances of a film on a liner; see `exudyn_ehd.film.solvers.liner.film`."""

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.oil_line import curve_of
from exudyn_ehd.film.cavitation.states import take_sink
from exudyn_ehd.film.lubricant.density import law_at
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
def density_of_load(load_fields, P, scale, law, rho_out, rho_P_out):
    """Set the density ratio at the pressure on the elements and its derivative to the unknown, 0 where the pressure is
    clipped."""
    load = load_of(load_fields)
    x, drive = P.reshape(-1), load.drive.reshape(-1)
    rho, rho_P = rho_out.reshape(-1), rho_P_out.reshape(-1)
    for c in range(x.size):
        _, rho[c], _, _, by, _, _, _ = law_at(drive[c] * scale, law)
        rho_P[c] = by * scale if x[c] == drive[c] else 0.0


@njit(cache=True)
def liner_residual(
    P, fill, rho, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, complementary, curve, out
):  # fmt: skip
    """Apply `bend_links` and set the residual of every vertex, for the present elements and links; returns its norm,
    see `violation`."""
    film, gaps = terms_of(terms, fixed), gaps_of(gap_fields)
    set_storage(gaps, load_of(load_fields), P, fill is not None, known, Rates(*rates), beta, film)
    bend_links(gaps, film)
    film_balance(P, fill, rho, film, out)
    if complementary:
        take_sink(curve_of(curve), out)
    return violation(out, P, fixed, pc, complementary)


@njit(cache=True, nogil=True)
def plain_residual(
    P, film, numbers, kinds, load_fields, rigid, G, delta_old, gap_fields, metric, known, rates, out
):  # fmt: skip
    """Set gaps, links and residual of a film on a liner without further effects; returns (norm of the residual,
    smallest gap).

    ``film``: that of `exudyn_ehd.film.solvers.liner.steps`; ``numbers``: (pc, vx, vz, beta); ``kinds``: (clips, whether
    vertices in the cavity have no unknown).
    """
    (pc, vx, vz, beta), (clips, chooses), (terms, fixed, _, curve) = numbers, kinds, film
    at_vertices, at_links = deflect(P, fixed, pc, clips, load_fields, rigid, beta, G, delta_old, rates[1], gap_fields)
    smallest = min(at_vertices, at_links)
    if not smallest > 0.0:
        return np.inf, smallest
    plain_links(gap_fields, metric, vx, vz, terms)
    norm = liner_residual(
        P, None, None, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, chooses, curve, out
    )
    return norm, smallest
