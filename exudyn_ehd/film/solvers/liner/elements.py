"""Winkler elements of an elastic liner: pressure on them, deflection, the gap
that the film sees, and derivatives; see `exudyn_ehd.film.solvers.nonlinear`.

Symbols, all scaled: P unknown of the film, p the pressure on the elements (P itself, or p(P) of
an oil whose viscosity or density follows its pressure), pc cavity pressure in P, beta compliance;
G true gap, H the gap that the film sees, HF that on the links i -> i+1, D deflection, E = H -
(film gap of the undeformed surfaces). ``_P``, ``_r``: derivatives to the unknown pressure and to
the undeformed gap. ``rigid`` (3, n, m): gap, gap on links and rate of the undeformed surfaces.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Gaps(NamedTuple):
    """What the film sees, (n, m) each: gaps at vertices and links, deflection,
    what it adds to the film gap, dH/dt without storage."""

    H: np.ndarray
    HF: np.ndarray
    D: np.ndarray
    E: np.ndarray
    rate: np.ndarray


class GapSlopes(NamedTuple):
    """Derivatives of `Gaps`, (n, m) each.

    Attributes
    ----------
    H_P, D_P : to the unknown pressure
    H_r, D_r, E_r : to the undeformed gap at fixed unknown
    link : of HF to the true gap on the link
    rate_P, rate_r, rate_t : of dH/dt to the unknown, the undeformed gap and the undeformed rate
    """

    H_P: np.ndarray
    D_P: np.ndarray
    H_r: np.ndarray
    D_r: np.ndarray
    E_r: np.ndarray
    link: np.ndarray
    rate_P: np.ndarray
    rate_r: np.ndarray
    rate_t: np.ndarray


class Load(NamedTuple):
    """Pressure on every element, (n, m) each.

    Attributes
    ----------
    drive : the unknown, where a film clips no less than pc
    p, slope, bend : pressure there with its first two derivatives to the unknown;
        1 and 0 for an oil of constant viscosity
    """

    drive: np.ndarray
    p: np.ndarray
    slope: np.ndarray
    bend: np.ndarray


# Kernels that are called from Python take these as one array, (fields, n, m): a
# tuple of arrays takes as long to hand over as they to compute.


@njit(cache=True)
def gaps_of(f):
    """`Gaps` of their fields."""
    return Gaps(f[0], f[1], f[2], f[3], f[4])


@njit(cache=True)
def slopes_of(f):
    """`GapSlopes` of their fields."""
    return GapSlopes(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8])


@njit(cache=True)
def load_of(f):
    """`Load` of its fields."""
    return Load(f[0], f[1], f[2], f[3])


class Rates(NamedTuple):
    """Rates of the storage, 1/s: of the mass, of the liner, of pseudo time; and
    whether the gap's own rate takes part (1 or 0)."""

    mass: float
    liner: float
    pseudo: float
    own: float


@njit(cache=True, fastmath=_FAST)
def drive_elements(P, fixed, pc, clips, load_fields):
    """What drives the elements, as it is for an oil of constant viscosity."""
    load = load_of(load_fields)
    x, prescribed, drive, p = P.reshape(-1), fixed.reshape(-1), load.drive.reshape(-1), load.p.reshape(-1)
    for c in range(x.size):
        cut = clips & (not prescribed[c]) & (x[c] < pc)
        drive[c] = pc if cut else x[c]
        p[c] = drive[c]


@njit(cache=True, fastmath=_FAST)
def scale_load(load_fields, scale):
    """Pressures (Pa) and their derivatives as an oil gives them, to the film's
    scale; returns the largest pressure, Pa."""
    load = load_of(load_fields)
    p, bend = load.p.reshape(-1), load.bend.reshape(-1)
    largest = -np.inf
    for c in range(p.size):
        largest = max(largest, p[c])
        p[c] /= scale
        bend[c] *= scale
    return largest


# Loops with one result each, which the compiler vectorises.
@njit(cache=True, fastmath={"reassoc", "contract", "nsz", "arcp", "nnan"})
def _smallest(x):
    """Smallest of numbers; what is none shows in the balances."""
    smallest = np.inf
    for c in range(x.size):
        smallest = min(smallest, x[c])
    return smallest


@njit(cache=True, fastmath=_FAST)
def press_elements(rigid, load_fields, beta, G_out):
    """Gap under the film's pressure alone; returns the smallest."""
    gap, p, out = rigid[0].reshape(-1), load_of(load_fields).p.reshape(-1), G_out.reshape(-1)
    for c in range(out.size):
        out[c] = gap[c] + beta * p[c]
    return _smallest(out)


@njit(cache=True, fastmath=_FAST)
def _moved_rate(rate, D, old, inverse, out):
    for c in range(out.size):
        out[c] = rate[c] + (D[c] - old[c]) * inverse


@njit(cache=True, fastmath=_FAST)
def _mean_gap(link, D_a, D_b, out):
    for c in range(out.size):
        out[c] = link[c] + 0.5 * (D_a[c] + D_b[c])


@njit(cache=True, fastmath=_FAST)
def move_elements(rigid, G, delta_old, inverse, gap_fields):
    """Deflections, gaps and rate of the deformed surfaces before a limiter
    changes them; returns the smallest gap of a link."""
    m = G.shape[1]
    gaps = gaps_of(gap_fields)
    g, gap, D, H, HF = G.reshape(-1), rigid[0].reshape(-1), gaps.D.reshape(-1), gaps.H.reshape(-1), gaps.HF.reshape(-1)
    for c in range(D.size):
        D[c] = g[c] - gap[c]
    for c in range(H.size):
        H[c] = g[c]
    _moved_rate(rigid[2].reshape(-1), D, delta_old.reshape(-1), inverse, gaps.rate.reshape(-1))
    last, link = g.size - m, rigid[1].reshape(-1)
    _mean_gap(link[:last], D[:last], D[m:], HF[:last])
    _mean_gap(link[last:], D[last:], D[:m], HF[last:])
    return _smallest(HF)


@njit(cache=True)
def deflect(P, fixed, pc, clips, load_fields, rigid, beta, G, delta_old, inverse, gap_fields):
    """Elements that the film alone presses, with oil of constant viscosity;
    returns the smallest gaps of a vertex and of a link."""
    drive_elements(P, fixed, pc, clips, load_fields)
    smallest = press_elements(rigid, load_fields, beta, G)
    return smallest, move_elements(rigid, G, delta_old, inverse, gap_fields)


@njit(cache=True, fastmath=_FAST)
def set_storage(gaps, load, P, fills, known, rates, beta, film):
    """E of the elements, and what vertices store: ``grow`` and ``kept`` of `balance.FilmTerms`.

    ``known`` (3, n, m): film gap of the undeformed surfaces, old mass, and what pseudo time holds on to.
    """
    H, E, rate, undeformed = gaps.H.reshape(-1), gaps.E.reshape(-1), gaps.rate.reshape(-1), known[0].reshape(-1)
    grow, kept, old, slow = film.grow.reshape(-1), film.kept.reshape(-1), known[1].reshape(-1), known[2].reshape(-1)
    x, drive, p = P.reshape(-1), load.drive.reshape(-1), load.p.reshape(-1)
    for c in range(E.size):
        E[c] = H[c] - undeformed[c]
    if not fills:
        for c in range(grow.size):
            grow[c] = rate[c]
        for c in range(kept.size):
            kept[c] = rates.pseudo * (beta * (p[c] + (x[c] - drive[c])) - slow[c])
        return
    pull = rates.mass + rates.pseudo
    for c in range(grow.size):
        grow[c] = H[c] * pull + rate[c] * rates.own
    for c in range(kept.size):
        kept[c] = -old[c] * rates.mass - slow[c] * rates.pseudo


@njit(cache=True, fastmath=_FAST)
def element_slopes(P, load_fields, rigid_slope, contact_G, bend, beta, inverse, slope_fields):
    """Derivatives of gaps and rate, for a slope of the film gap (``rate_t``) and of its links that are known already.

    ``contact_G`` is d(contact pressure)/dG over the film's scale, ``bend`` the
    film gap's second derivative times the gap's rate.
    """
    load, out = load_of(load_fields), slopes_of(slope_fields)
    size = P.size
    follow = np.empty(size)
    stiff, turned, s = contact_G.reshape(-1), bend.reshape(-1), out.rate_t.reshape(-1)
    _follow(stiff, beta, follow)
    D_P, H_P, D_r, H_r = out.D_P.reshape(-1), out.H_P.reshape(-1), out.D_r.reshape(-1), out.H_r.reshape(-1)
    _yield(P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1), follow, beta, D_P)
    for c in range(size):
        D_r[c] = follow[c] - 1.0
    for c in range(size):
        H_P[c] = s[c] * D_P[c]
    for c in range(size):
        H_r[c] = s[c] * follow[c]
    combine(H_r, 1.0, rigid_slope.reshape(-1), -1.0, out.E_r.reshape(-1))
    _turn(turned, s, inverse, D_P, 0.0, out.rate_P.reshape(-1))
    _turn(turned, s, inverse, D_r, 1.0, out.rate_r.reshape(-1))


@njit(cache=True, fastmath=_FAST)
def plain_slopes(P, load_fields, beta, inverse, slope_fields):
    """`element_slopes` of elements that the film alone presses, with oil of
    constant viscosity: what does not stay the same."""
    load, out = load_of(load_fields), slopes_of(slope_fields)
    x, drive, D_P, H_P, rate_P = (
        P.reshape(-1),
        load.drive.reshape(-1),
        out.D_P.reshape(-1),
        out.H_P.reshape(-1),
        out.rate_P.reshape(-1),
    )
    for c in range(D_P.size):
        D_P[c] = beta if x[c] == drive[c] else 0.0
    for c in range(H_P.size):
        H_P[c] = D_P[c]
    for c in range(rate_P.size):
        rate_P[c] = inverse * D_P[c]


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _follow(stiff, beta, out):
    for c in range(out.size):
        out[c] = 1.0 / (1.0 - beta * stiff[c])


@njit(cache=True, fastmath=_FAST)
def _yield(x, drive, steep, follow, beta, out):
    for c in range(out.size):
        d = beta * follow[c] * steep[c]
        out[c] = d if x[c] == drive[c] else 0.0


@njit(cache=True, fastmath=_FAST)
def combine(a, by_a, b, by_b, out):
    """Sum of fields (k,) times factors."""
    for c in range(out.size):
        out[c] = by_a * a[c] + by_b * b[c]


@njit(cache=True, fastmath=_FAST)
def _turn(turned, s, inverse, yields, own, out):
    """Derivative of the rate to a change that deflects by ``yields``;
    ``own`` = 1: of the undeformed gap, which turns the film gap itself."""
    for c in range(out.size):
        out[c] = (turned[c] + s[c] * inverse) * yields[c] + own * turned[c]


@njit(cache=True, fastmath=_FAST)
def bend_links(gaps, film):
    """Conductances of links with another deflection at either end: their mean over the linear course of the gap.

    ``H^3 + H d^2 = H^3 (1 + (d / H)^2)`` of a plain film, d half the difference
    of E; what multiplies a plain film's is taken at the mean gap.
    """
    m = gaps.H.shape[1]
    H, HF, E = gaps.H.reshape(-1), gaps.HF.reshape(-1), gaps.E.reshape(-1)
    kx, kz = film.kx.reshape(-1), film.kz.reshape(-1)
    last = H.size - m
    _bend(HF[:last], HF[:last], E[:last], E[m:], kx[:last])
    _bend(HF[last:], HF[last:], E[last:], E[:m], kx[last:])
    _bend(H[:-1], H[1:], E[:-1], E[1:], kz[:-1])


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _bend(h_a, h_b, E_a, E_b, k):
    for c in range(k.size):
        lean = (E_b[c] - E_a[c]) / (h_a[c] + h_b[c])
        k[c] *= 1.0 + lean * lean


@njit(cache=True, fastmath=_FAST)
def _plain(h_a, h_b, conducts, linked, v, k, f):
    for c in range(k.size):
        h = 0.5 * (h_a[c] + h_b[c])
        k[c] = conducts[c] * h * h * h
    for c in range(f.size):
        f[c] = v * linked[c] * 0.5 * (h_a[c] + h_b[c])


@njit(cache=True)
def plain_links(gap_fields, metric, vx, vz, terms):
    """Conductances and Couette fluxes (rows 0 to 3 of ``terms``, see
    `balance.terms_of`) of a film without effects, unbent.

    ``metric`` (4, n, m): of the conductances in theta and in z, and widths that
    Couette flows in theta and in z pass through.
    """
    H, HF = gap_fields[0].reshape(-1), gap_fields[1].reshape(-1)
    by, out = metric.reshape(4, -1), terms.reshape(terms.shape[0], -1)
    _plain(HF, HF, by[0], by[2], vx, out[0], out[2])
    _plain(H[:-1], H[1:], by[1, :-1], by[3, :-1], vz, out[1, :-1], out[3, :-1])


@njit(cache=True)
def smallest_of(gap_fields):
    """Smallest gap that the film sees."""
    gaps = gaps_of(gap_fields)
    return min(_smallest(gaps.H.reshape(-1)), _smallest(gaps.HF.reshape(-1)))


@njit(cache=True)
def ends_open(rigid, p, beta, fixed):
    """Whether the gap is open where the pressure is prescribed, which is beyond the liner's reach."""
    n, m = p.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if fixed[i, j]:
                if not rigid[0, i, j] + beta * p[i, j] > 0.0:
                    return False
                if fixed[nxt, j] and not rigid[1, i, j] + 0.5 * beta * (p[i, j] + p[nxt, j]) > 0.0:
                    return False
    return True
