"""Winkler elements of an elastic liner: pressure on them, deflection, the gap that the film sees, and derivatives.

The equations are in `exudyn_ehd.film.solvers.liner.film`. Symbols, all scaled: P unknown of the film; p pressure on the
elements, P itself or p(P) of an oil whose viscosity or density follows its pressure; pc cavity pressure in P; beta
compliance; G true gap; H gap that the film sees, HF that on the links i -> i+1; D deflection; E = H - (film gap of the
undeformed surfaces). ``_P``, ``_r``: derivatives to the unknown pressure and to the undeformed gap. ``rigid``
(3, n, m): gap, gap on links and rate of the undeformed surfaces.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.kernels import FAST, I0, I1
from exudyn_ehd.film.reynolds.balance import part


class Gaps(NamedTuple):
    """Gaps of a film and its deflection, (n, m) each: H, HF, D and E of the module; ``rate`` is dH/dt, without the
    deflection's rate while a mass-conserving film is solved, whose storage contains it."""

    H: np.ndarray
    HF: np.ndarray
    D: np.ndarray
    E: np.ndarray
    rate: np.ndarray


class GapSlopes(NamedTuple):
    """Derivatives of `Gaps`, (n, m) each.

    Attributes
    ----------
    H_P, D_P : of H and D to the unknown pressure
    D_r, E_r, H_r : of D, E and H to the undeformed gap at fixed unknown
    link : of HF to the true gap on the link
    rate_P, rate_r, rate_t : of dH/dt to the unknown, the undeformed gap and the undeformed rate
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
    drive : unknown P, at least pc at free vertices if the closure clips
    p, slope, bend : pressure at ``drive`` with its first two derivatives to the unknown;
        ``drive``, 1 and 0 for an oil of constant viscosity
    """

    drive: np.ndarray
    p: np.ndarray
    slope: np.ndarray
    bend: np.ndarray


# Kernels that are called from Python take these as one array, (fields, n, m):
# handing over a tuple of arrays takes as long as the computation.


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
    ``own`` is 1 if the gap's own rate takes part, else 0."""

    mass: float
    liner: float
    pseudo: float
    own: float


@njit(cache=True, fastmath=FAST)
def drive_elements(P, fixed, pc, clips, load_fields):
    """Set ``drive`` of `Load`, and p as for an oil of constant viscosity."""
    load = load_of(load_fields)
    x, prescribed, drive, p = P.reshape(-1), fixed.reshape(-1), load.drive.reshape(-1), load.p.reshape(-1)
    for c in range(x.size):
        cut = clips & (not prescribed[c]) & (x[c] < pc)
        drive[c] = pc if cut else x[c]
        p[c] = drive[c]


@njit(cache=True, fastmath=FAST)
def scale_load(load_fields, scale):
    """Scale pressures (Pa) and second derivatives (1/Pa) of an oil's law to the film's unit of pressure, in place;
    returns the largest pressure, Pa."""
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


@njit(cache=True)
def deflect(P, fixed, pc, clips, load_fields, rigid, beta, G, delta_old, inverse, gap_fields):
    """Set load and gaps of elements without contact, for an oil of constant viscosity; returns the smallest gaps at a
    vertex and on a link."""
    drive_elements(P, fixed, pc, clips, load_fields)
    smallest = press_elements(rigid, load_fields, beta, G)
    return smallest, move_elements(rigid, G, delta_old, inverse, gap_fields)


@njit(cache=True, fastmath=FAST)
def set_storage(gaps, load, P, fills, known, rates, beta, film):
    """Set E of the elements, and the storage of the vertices: ``grow`` and ``kept`` of `balance.FilmTerms`.

    ``known`` (3, n, m): film gap of the undeformed surfaces, old mass, and old quantity that pseudo time stores.
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


@njit(cache=True, fastmath=FAST, error_model="numpy")
def element_slopes(P, load_fields, rigid_slope, contact_G, bend, beta, inverse, slope_fields):
    """Set `GapSlopes`, but ``rate_t`` (slope of the film gap) and ``link``, which are inputs.

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
def bend_links(gaps, film):
    """Correct conductances of links for different deflections at their ends: mean over the linear course of the gap.

    ``H^3 + H d^2 = H^3 (1 + (d / H)^2)`` of a plain film, d half the difference of E. Flux effects keep their values at
    the mean gap.
    """
    m = gaps.H.shape[1]
    H, HF, E = gaps.H.reshape(-1), gaps.HF.reshape(-1), gaps.E.reshape(-1)
    kx, kz = film.kx.reshape(-1), film.kz.reshape(-1)
    last = H.size - m
    _bend(HF[:last], HF[:last], E[:last], E[m:], kx[:last])
    _bend(HF[last:], HF[last:], E[last:], E[:m], kx[last:])
    _bend(H[:-1], H[1:], E[:-1], E[1:], kz[:-1])


@njit(cache=True, fastmath=FAST, error_model="numpy")
def _bend(h_a, h_b, E_a, E_b, k):
    for c in range(k.size):
        lean = (E_b[c] - E_a[c]) / (h_a[c] + h_b[c])
        k[c] *= 1.0 + lean * lean


@njit(cache=True)
def smallest_of(gap_fields):
    """Return the smallest gap that the film sees, at vertices and on links."""
    gaps = gaps_of(gap_fields)
    return min(_smallest(gaps.H.reshape(-1)), _smallest(gaps.HF.reshape(-1)))


@njit(cache=True)
def ends_open(rigid, p, beta, fixed):
    """Return whether the gap is open at vertices and links of prescribed pressure, where the deflection is given."""
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


@njit(cache=True, fastmath=FAST)
def _add_end(by_h, by_d, side, steep, lean, full, out):
    """Add the derivative of a link's flow to the unknown at its end b (``side`` 1) or a (-1), through the gap there."""
    for c in range(out.size):
        slope = 0.5 * (by_h[c] * steep[c] + side * by_d[c] * lean[c])
        if full is not None:
            slope = slope if full[c] else 0.0
        out[c] += slope


@njit(cache=True, fastmath=FAST)
def _product(a, b, out):
    for c in range(out.size):
        out[c] = a[c] * b[c]


@njit(cache=True, fastmath=FAST)
def _add_storage(area, fill, full, rho, H_P, rate_P, rates, out):
    """Add the derivative of the storage to the unknowns, through the gap."""
    for c in range(out.size):
        by = rate_P[c]
        if fill is not None:
            by = fill[c] * (by * rates.own + H_P[c] * (rates.mass + rates.pseudo))
        if rho is not None:
            by *= rho[c]
        if full is not None:
            by = by if full[c] else 0.0
        out[c] += area[c] * by


@njit(cache=True, fastmath=FAST)
def _add_pseudo(area, P, drive, slope, factor, out):
    """Add the derivative of pseudo time's storage, for a film that does not conserve mass."""
    for c in range(out.size):
        out[c] += area[c] * factor * (slope[c] if P[c] == drive[c] else 1.0)


@njit(cache=True)
def add_gap_slopes(P, fill, full, rho, film, gap_slopes, load, rates, beta, by, slopes):
    """Add the derivatives of flows and storage through the gap to ``slopes`` of `balance.film_slopes`; ``by``: that of
    `exudyn_ehd.film.reynolds.link_derivatives.link_derivatives`."""
    n, m = P.shape
    size = n * m
    last, e = size - m, size - 1
    D, H, link, area = (
        gap_slopes.D_P.reshape(-1),
        gap_slopes.H_P.reshape(-1),
        gap_slopes.link.reshape(-1),
        film.area.reshape(-1),
    )
    face = np.empty(size)
    _product(by[0], link, face)
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        h, d = face[start:stop], by[1, start:stop]
        _add_end(h, d, -1.0, D[start:stop], H[start:stop], part(full, start, stop), slopes[0, start:stop])
        _add_end(h, d, 1.0, D[there:end], H[there:end], part(full, there, end), slopes[1, start:stop])
    h, d = by[2, :e], by[3, :e]
    _add_end(h, d, -1.0, H[:e], H[:e], part(full, I0, e), slopes[2, :e])
    _add_end(h, d, 1.0, H[1:], H[1:], part(full, I1, size), slopes[3, :e])
    _add_storage(
        area,
        part(fill, I0, size),
        part(full, I0, size),
        part(rho, I0, size),
        H,
        gap_slopes.rate_P.reshape(-1),
        rates,
        slopes[4],
    )
    if fill is None and rates.pseudo != 0.0:
        _add_pseudo(area, P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1), rates.pseudo * beta, slopes[4])
