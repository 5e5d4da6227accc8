"""Winkler elements of an elastic liner: pressure on them, deflection, gap of the film, and derivatives.

The equations are in `exudyn_ehd.film.solvers.liner`. Symbols, all scaled: P unknown of the film; p pressure on the
elements, P itself or p(P) of an oil whose viscosity or density follows its pressure; pc cavity pressure in P; beta
compliance; G true gap; H gap of the film (film gap), after a limiter; HF film gap on the links i -> i+1; D deflection;
E = H - (film gap of the undeformed surfaces). ``_P``, ``_r``: derivatives to the unknown pressure and to the undeformed
gap. ``rigid`` (3, n, m): gap, gap on links and rate of the undeformed surfaces.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST
from exudyn_ehd.film.reynolds.balance import flat


class Gaps(NamedTuple):
    """Gaps and deflection of a film, (n, m) each: H, HF, D and E of the module, and ``rate``, dH/dt.

    While a mass-conserving film is solved, ``rate`` omits the rate of the deflection, which its storage contains.
    """

    H: np.ndarray
    HF: np.ndarray
    D: np.ndarray
    E: np.ndarray
    rate: np.ndarray


class GapSlopes(NamedTuple):
    """Derivatives of `Gaps`, (n, m) each.

    Attributes
    ----------
    H_P, D_P : derivatives of H and D to the unknown pressure
    D_r, E_r, H_r : derivatives of D, E and H to the undeformed gap at fixed unknown
    link : derivative of HF to the true gap on the link
    rate_P, rate_r, rate_t : derivatives of dH/dt to the unknown, the undeformed gap and the undeformed rate
    """

    H_P: np.ndarray
    D_P: np.ndarray
    D_r: np.ndarray
    E_r: np.ndarray
    H_r: np.ndarray
    link: np.ndarray
    rate_P: np.ndarray
    rate_r: np.ndarray
    rate_t: np.ndarray


class Load(NamedTuple):
    """Pressure on every element, (n, m) each.

    Attributes
    ----------
    drive : unknown P, raised to pc at free vertices where it is lower, if the closure clips
    p, slope, bend : pressure at ``drive`` with its first two derivatives to the unknown;
        ``drive``, 1 and 0 for an oil of constant viscosity
    """

    drive: np.ndarray
    p: np.ndarray
    slope: np.ndarray
    bend: np.ndarray


# Kernels that are called from Python take these fields as one array, (fields, n, m): passing a tuple of arrays would
# take as long as the computation.


@njit(cache=True)
def gaps_of(f):
    """Return `Gaps` of an array of fields (5, ...)."""
    return Gaps(f[0], f[1], f[2], f[3], f[4])


@njit(cache=True)
def slopes_of(f):
    """Return `GapSlopes` of an array of fields (9, ...)."""
    return GapSlopes(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8])


@njit(cache=True)
def load_of(f):
    """Return `Load` of an array of fields (4, ...)."""
    return Load(f[0], f[1], f[2], f[3])


class Rates(NamedTuple):
    """Inverse time steps of the storage, 1/s, 0 if absent: of the mass, of the liner's deflection, of pseudo time.

    ``gap_rate`` is 1 if the storage contains the rate of the gap, else 0.
    """

    mass: float
    liner: float
    pseudo: float
    gap_rate: float


@njit(cache=True, fastmath=FAST)
def drive_elements(P, fixed, pc, clips, load_fields):
    """Set ``drive`` of `Load`, and p to its value for an oil of constant viscosity."""
    load = load_of(load_fields)
    x, prescribed, drive, p = P.reshape(-1), fixed.reshape(-1), load.drive.reshape(-1), load.p.reshape(-1)
    for c in range(x.size):
        cut = clips & (not prescribed[c]) & (x[c] < pc)
        drive[c] = pc if cut else x[c]
        p[c] = drive[c]


# Loops with one result each, which the compiler vectorises.
@njit(cache=True, fastmath={"reassoc", "contract", "nsz", "arcp", "nnan"})
def _smallest(x):
    """Return the smallest of numbers; nan is not detected here, but in the residual."""
    smallest = np.inf
    for c in range(x.size):
        smallest = min(smallest, x[c])
    return smallest


@njit(cache=True, fastmath=FAST)
def press_elements(rigid, load_fields, beta, G_out):
    """Set the gap under the film's pressure alone, without contact; returns the smallest."""
    gap, p, out = rigid[0].reshape(-1), load_of(load_fields).p.reshape(-1), G_out.reshape(-1)
    for c in range(out.size):
        out[c] = gap[c] + beta * p[c]
    return _smallest(out)


@njit(cache=True, fastmath=FAST)
def move_elements(rigid, G, delta_old, inverse, gap_fields):
    """Set deflections, gaps and rate of the deformed surfaces, before a limiter changes them; returns the smallest gap
    on a link."""
    m, gaps, bare = G.shape[1], gaps_of(gap_fields), rigid.reshape(3, G.size)
    gap, link, rate = bare[0], bare[1], bare[2]
    g, old = G.reshape(-1), delta_old.reshape(-1)
    D, H, HF, moved = gaps.D.reshape(-1), gaps.H.reshape(-1), gaps.HF.reshape(-1), gaps.rate.reshape(-1)
    for c in range(D.size):
        D[c], H[c] = g[c] - gap[c], g[c]
        moved[c] = rate[c] + (D[c] - old[c]) * inverse
    for c in range(D.size):
        HF[c] = link[c] + 0.5 * (D[c] + D[c + m if c + m < D.size else c + m - D.size])
    return _smallest(HF)


@njit(cache=True, fastmath=FAST)
def set_storage(gaps, load, P, fills, known, rates, beta, film):
    """Set E of the elements, and the storage of the vertices: ``grow``, ``known`` and ``kept`` of `balance.FilmTerms`.

    ``known`` (3, n, m): film gap of the undeformed surfaces, start-of-step mass, and quantity that pseudo time stores
    at the start of its step.
    """
    H, E, rate, undeformed = gaps.H.reshape(-1), gaps.E.reshape(-1), gaps.rate.reshape(-1), known[0].reshape(-1)
    grow, kept, old, slow = film.grow.reshape(-1), film.kept.reshape(-1), known[1].reshape(-1), known[2].reshape(-1)
    volume = film.known.reshape(-1)
    x, drive, p = P.reshape(-1), load.drive.reshape(-1), load.p.reshape(-1)
    pull = rates.mass + rates.pseudo
    for c in range(E.size):
        E[c] = H[c] - undeformed[c]
        if fills:
            grow[c] = H[c] * pull + rate[c] * rates.gap_rate
            # the rates at an instant keep the volume
            volume[c] = -old[c] * rates.mass * rates.gap_rate
            kept[c] = -old[c] * rates.mass * (1.0 - rates.gap_rate) - slow[c] * rates.pseudo
        else:
            grow[c] = rate[c]
            kept[c] = rates.pseudo * (beta * (p[c] + (x[c] - drive[c])) - slow[c])


@njit(cache=True, fastmath=FAST, error_model="numpy")
def element_slopes(P, load_fields, rigid_slope, contact_G, bend, beta, inverse, slope_fields):
    """Set `GapSlopes`, except ``rate_t`` (slope of the film gap) and ``link``, which are inputs.

    ``contact_G``: d(contact pressure)/dG over the film's scale; ``bend``: second derivative of the film gap times the
    gap's rate.
    """
    load, out = load_of(load_fields), slopes_of(slope_fields)
    stiff, turned, s, rigid = contact_G.reshape(-1), bend.reshape(-1), out.rate_t.reshape(-1), rigid_slope.reshape(-1)
    x, drive, steep = P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1)
    D_P, H_P, rate_P = out.D_P.reshape(-1), out.H_P.reshape(-1), out.rate_P.reshape(-1)
    D_r, H_r, E_r, rate_r = out.D_r.reshape(-1), out.H_r.reshape(-1), out.E_r.reshape(-1), out.rate_r.reshape(-1)
    for c in range(x.size):
        follow, moved = 1.0 / (1.0 - beta * stiff[c]), turned[c] + s[c] * inverse
        D_P[c] = beta * follow * steep[c] if x[c] == drive[c] else 0.0
        H_P[c], rate_P[c] = s[c] * D_P[c], moved * D_P[c]
        D_r[c], H_r[c] = follow - 1.0, s[c] * follow
        E_r[c], rate_r[c] = H_r[c] - rigid[c], moved * D_r[c] + turned[c]


@njit(cache=True, fastmath=FAST)
def correct_links(gaps, film):
    """Correct conductances of links for different deflections at their ends, to the mean for a linear gap.

    ``H^3 + H d^2 = H^3 (1 + (d / H)^2)`` of a plain film, d half the difference of E. Flux effects keep their values at
    the mean gap.
    """
    m = gaps.H.shape[1]
    H, HF, E = gaps.H.reshape(-1), gaps.HF.reshape(-1), gaps.E.reshape(-1)
    kx, kz = film.kx.reshape(-1), film.kz.reshape(-1)
    last = H.size - m
    _correct(HF[:last], HF[:last], E[:last], E[m:], kx[:last])
    _correct(HF[last:], HF[last:], E[last:], E[:m], kx[last:])
    _correct(H[:-1], H[1:], E[:-1], E[1:], kz[:-1])


@njit(cache=True, fastmath=FAST, error_model="numpy")
def _correct(h_a, h_b, E_a, E_b, k):
    for c in range(k.size):
        half_ratio = (E_b[c] - E_a[c]) / (h_a[c] + h_b[c])
        k[c] *= 1.0 + half_ratio * half_ratio


@njit(cache=True, fastmath=FAST)
def add_gap_slopes(P, fill, full, rho, film, gap_slopes, load, rates, beta, by, slopes):
    """Add the derivatives of flows and storage through the gap to ``slopes`` of `balance.film_slopes`; ``by``: that of
    `exudyn_ehd.film.reynolds.balance.link_derivatives`."""
    m, size = P.shape[1], P.size
    D, H, rate_P = gap_slopes.D_P.reshape(-1), gap_slopes.H_P.reshape(-1), gap_slopes.rate_P.reshape(-1)
    x, drive, steep = P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1)
    link, area, filled, dense = gap_slopes.link.reshape(-1), film.area.reshape(-1), flat(fill), flat(rho)
    if full is not None:
        # gaps do not depend on fills
        moves = full.reshape(-1)
        D, H, rate_P = D * moves, H * moves, rate_P * moves
    for c in range(size):
        on, up = c + m if c + m < size else c + m - size, c + 1 if c + 1 < size else 0
        by_h, by_d = 0.5 * by[0, c] * link[c], 0.5 * by[1, c]
        slopes[0, c] += by_h * D[c] - by_d * H[c]
        slopes[1, c] += by_h * D[on] + by_d * H[on]
        slopes[2, c] += 0.5 * (by[2, c] - by[3, c]) * H[c]
        slopes[3, c] += 0.5 * (by[2, c] + by[3, c]) * H[up]
        stored, pseudo = rate_P[c], 0.0
        if fill is None:
            pseudo = rates.pseudo * beta * (steep[c] if x[c] == drive[c] else 1.0)
        else:
            stored = filled[c] * (stored * rates.gap_rate + H[c] * (rates.mass + rates.pseudo))
        if rho is not None:
            stored *= dense[c]
        slopes[4, c] += area[c] * (stored + pseudo)
