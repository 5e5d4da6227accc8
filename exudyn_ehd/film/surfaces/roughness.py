"""Rough surfaces: contact after Greenwood and Tripp with an average gap, flow and friction after Patir and Cheng.

Contact pressure after Greenwood and Tripp, with boundary friction
------------------------------------------------------------------
At the gap h between the mean planes of the surfaces the pressure of the contact is

    p = (16 sqrt(2) pi / 15) (eta beta sigma)^2 sqrt(sigma / beta) E' F(h / sigma),    F = F_5/2,
    F_n(u) = 1 / sqrt(2 pi) int_u^inf (s - u)^n exp(-s^2 / 2) ds = Gamma(n + 1) / sqrt(2 pi) exp(-u^2 / 4) D_{-n-1}(u)

with the asperity density eta, tip radius beta, combined roughness sigma, composite modulus 1/E' = (1 - nu_1^2)/E_1 +
(1 - nu_2^2)/E_2, and the parabolic cylinder function D. Source: J. A. Greenwood, J. H. Tripp, Proc. Instn Mech. Engrs
185 (1970) 625; the second form of F_n is the integral representation of D (Abramowitz and Stegun 19.5.3). The power fit
4.4086e-5 (4 - u)^6.804 that is often used instead is 10.7 % low at u = 0 and is not used here.

F_5/2 comes from cubic Hermite interpolation on 1/64 sigma with the exact values and derivatives ``F_5/2' = -5/2 F_3/2``
(relative error below 1e-6), and is zero from u = 8 on (where it is below 1e-16). For u < -8 the values are those of
the series ``(-u)^(5/2) (1 + 15/8 u^-2 - 15/128 u^-4 - 75/1024 u^-6)``, so that surfaces pressed into each other still
push back. Below u = -64 the first cubic goes on, 0.5 % too stiff at -128.

Average gap of rough surfaces, which replaces the nominal gap in the film
-------------------------------------------------------------------------
Two rough surfaces with a nominal gap h and Gaussian combined roughness s of standard deviation sigma leave, where peaks
that would overlap are flattened, the average gap (Patir and Cheng, J. Lubrication Technology 100 (1978) 12, with a
Gaussian)

    h_T = E[max(h + s, 0)] = h Phi(h / sigma) + sigma phi(h / sigma),      dh_T/dh = Phi(h / sigma).

Here touching spots keep a residual film a sigma, so that pockets that close do not shear without bound:

    h_T = E[max(h + s, a sigma)] = a sigma + sigma t(h / sigma - a),       t(x) = x Phi(x) + phi(x).

The two agree for a = 0; at h = 0 the film is 0.399 sigma, and 0.409 sigma with a = 0.02.

Symbols: H gap over the clearance, sigma roughness over the clearance, Phi and phi the normal distribution and its
density.

Flow and friction factors after Patir and Cheng
-----------------------------------------------
Mean flow between rough surfaces with nominal gap h, average gap h_T, combined roughness sigma, pattern gamma (ratio of
the correlation lengths in theta and z; > 1: lay along theta), surface 1 = journal, surface 2 = bore, in the bore's
frame::

    q_x = U/2 (h_T + sigma phi_s) - phi_x h^3 / (12 mu) dp/dx,        q_z likewise with 1/gamma,
    phi_x = 1 - C exp(-r H) for gamma <= 1,    1 + C H^-r for gamma > 1,     H = h / sigma,
    phi_s = (sigma_1^2 - sigma_2^2) / sigma^2 Phi_s,
    Phi_s = A1 H^a1 exp(-a2 H + a3 H^2) for H <= 5,    A2 exp(-H / 4) for H > 5.

Sources: N. Patir, H. S. Cheng, J. Lubrication Technology 100 (1978) 12 (phi_x) and 101 (1979) 220 (phi_s and the
friction factors). All constants agree with those that foam-extend 4.0 uses in its lubricated contact, those of Phi_fs
for gamma = 1 also with R. Boman's EHD program (University of Liege); the smallest H is 1 there for all gamma < 1.

Friction. The second paper gives the mean shear stress of the two surfaces in pure sliding as
``mu U / h (phi_f +- phi_fs)`` with ``phi_f = h E[1 / local gap]`` (here for Gaussian heights, with their cut-off at
sigma / 100) and

    phi_fs = (sigma_1^2 - sigma_2^2) / sigma^2 Phi_fs,    Phi_fs = A3 H^a4 exp(-a5 H + a6 H^2) for H <= 7,

the larger stress on the smoother surface. Pressure ripples push on the slopes of the rougher surface, and this force
equals the difference of the stresses: both surfaces get the same tangential force, by the film's momentum balance. On a
smooth surface shear is the only tangential force, so that the tangential force on either surface is

    mu U / h (phi_f + Phi_fs),

and as both factors are linear in the variances (heights of the two surfaces are independent) that holds for every share
of the two. For parallel ridges across the motion it is 1 + 4 (sigma/h)^2, and 1 + (sigma/h)^2 along it (exact for small
roughness). Beyond H = 7 Phi_fs is the power of H that continues the fit with its slope. Under a pressure gradient the
tangential forces, shear and ripples together, are ``-(h_T +- sigma phi_s) / 2 dp/dx`` by reciprocity, with ``phi_fp h =
h_T - sigma Phi_s`` of the second paper (drag, below). Where peaks touch (h below 2 sigma) the pressure is taken to act
on the whole area, the flow to have the open part of it.

The film is computed in h_T, so all factors are tabulated over ``y = 1 / (1 + h_T / (8 sigma))``: the pressure flow as
phi = phi_x h^3 / h_T^3, the shear flow as psi = sigma Phi_s / h_T, the friction as
``h_T E[1 / local gap] + Phi_fs h_T / h``. Below the smallest H that the fits are meant for (0.5 to 1) their logarithms
run on smoothly, in ``L tanh(s / L)`` of s = ln(h_T), to a constant: an extrapolation.

Drag of a pressure gradient on the two surfaces, where they share it unevenly
-----------------------------------------------------------------------------
Between rough surfaces the relative speed V of the journal (1) carries ``V/2 (h_T + sigma phi_s)`` in the bore's
(2) frame. Stokes flow is reciprocal (H. A. Lorentz): with the wall force as flux of V and the volume flow as flux of
the pressure gradient, the cross terms are each other's opposite, since together they neither dissipate nor produce
anything. So a pressure gradient pulls the surfaces, shear and pressure on their slopes together, by

    f_1 = -(h_T + sigma phi_s) / 2 dp/dx,        f_2 = -(h_T - sigma phi_s) / 2 dp/dx        per area,

the rougher one more; the sum is what the pressure does on the film's cross section, whatever phi_s. With one surface
smooth the force on it is its shear alone: ``phi_fp h = h_T - sigma Phi_s`` of Patir and Cheng. The difference from
equal shares, ``-+ sigma phi_s / 2 dp/ds`` in both directions, is summed over the links as the carriers' part of the
flow is, so that work and heat agree on every link: ``E_x = sum (carrier - gap) (P_i - P_i+1) width``; its torque on the
journal is 6 mu R^4 / c E_x, its axial force 6 mu R^3 / c E_z.

Closed gaps. Where surfaces touch, the gap h of the film (from a limiter, or the average gap) changes less than the gap
g of the surfaces, ``dh = h' dg``. The pressure acts on the whole area, on the journal along its normal. The film pulls
either surface by ``-h/2 dp/dx``. The remaining force ``p (1 - h') dg/dx`` is transmitted between the solids like
contact pressure, and has no torque on the journal about its axis. So the torque is that of the same sum with g as the
gap, ``E_x = sum (carrier - g) (P_i - P_i+1) width``, with the carrier of h. Then the work of sliding equals the heat,
however closely the surfaces touch.

Symbols of `exudyn_ehd.film.loads`. Values on links are (n, m); the last column of those in z, behind which there is
no link, counts for nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, partial
from typing import ClassVar

import numpy as np
import scipy
from numba import njit

from exudyn_ehd.compilation import FAST
from exudyn_ehd.film.reynolds.gap import drop_weights, drops, on_links, to_ends
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter
from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, Checked, InputError, require_number

# Beyond this many sigma the average gap equals the nominal one (to 2e-13 sigma).
SMOOTH_BEYOND = 7.0
# Beginning of the hint on a composite roughness outside the plausible range.
ROUGHNESS = "it is the standard deviation of both surfaces' heights together; leave smooth surfaces out with"


class AverageGap(GapLimiter):
    """Gap limiter of rough surfaces.

    Parameters
    ----------
    sigma : float
        Combined roughness divided by the clearance.
    residual : float
        Residual film a, share of sigma.
    """

    def __init__(self, sigma: float, residual: float) -> None:
        self.sigma, self.residual = sigma, residual
        self.limits_below = SMOOTH_BEYOND * sigma

    def film_gap(self, gaps: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> None:
        """Average gap with its derivatives; as `GapLimiter`."""
        average_gap(gaps, self.sigma, self.residual, slopes, bends)


def average_gap_ratio(x: np.ndarray, residual: float) -> np.ndarray:
    """h_T / sigma for x = h / sigma."""
    y = np.asarray(x, dtype=float) - residual
    return residual + y * scipy.special.ndtr(y) + np.exp(-0.5 * y * y) / math.sqrt(2.0 * math.pi)


@njit(cache=True)
def average_gap(gaps, sigma, residual, slopes, bends):
    """Average gaps of rough surfaces with their first two derivatives, in place."""
    g, slope, bend = gaps.reshape(-1), slopes.reshape(-1), bends.reshape(-1)
    for k in range(g.size):
        if g[k] <= SMOOTH_BEYOND * sigma:
            y = g[k] / sigma - residual
            density = math.exp(-0.5 * y * y) / math.sqrt(2.0 * math.pi)
            # erfc keeps its relative accuracy deep below the mean line, where y Phi(y) + phi(y) cancels.
            slope[k] = 0.5 * math.erfc(-y / math.sqrt(2.0))
            bend[k] = density / sigma
            g[k] = sigma * (residual + max(y * slope[k] + density, 0.0))


REACH, DEEPEST = 8.0, -64.0
STEPS_PER_SIGMA = 64


@dataclass(frozen=True, kw_only=True)
class GreenwoodTripp(Checked):
    """Contact of rough surfaces at their asperities, with boundary friction: carries load in mixed lubrication.

    When: films below three times the composite roughness; above 8 times it the contact pressure is zero. Not with
    ``contact=RegularisedWall(...)``, which it replaces.

    The film gets the average gap between the asperities, which is positive at any position of the journal. The contact
    pressure is ``(16 sqrt(2) pi / 15) (eta beta sigma)^2 sqrt(sigma / beta) E' F_5/2(h / sigma)``, with the exact
    integral F_5/2. Load, torque and power loss of the contact are reported apart.

    Parameters
    ----------
    composite_roughness : float
        sigma = sqrt(sigma_journal^2 + sigma_bore^2) of the r.m.s. roughnesses, m.
    composite_modulus : float
        E' in Pa, 1/E' = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2; see `composite_modulus`.
    density_radius_roughness : float, default 0.05
        eta beta sigma, with eta asperities per area and the radius beta of their tips; 0.03 to 0.05 for most finished
        surfaces.
    roughness_radius_ratio : float, default 0.01
        sigma / beta; 1e-4 to 1e-2.
    friction_coefficient : float, default 0.1
        Boundary friction of the asperities; 0: none.
    transition_speed : float, default 0.01
        v0, m/s: the friction coefficient acts times ``v / sqrt(v^2 + v0^2)`` with the sliding speed v, so that friction
        is too low for v near v0 and below. This holds in joints, `steady` and `equilibrium`, but not in `stribeck`.
    residual_film : float, default 0.02
        Film thickness at touching spots, as a share of sigma, 0.001 to 0.2.

    Source
    ------
    J. A. Greenwood and J. H. Tripp, Proc. Instn Mech. Engrs 185 (1970) 625.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> rough = ehd.GreenwoodTripp(
    ...     composite_roughness=0.5e-6, composite_modulus=ehd.composite_modulus((2.1e11, 1.1e11), (0.3, 0.34))
    ... )
    >>> ehd.JournalBearing(**b, asperity=rough).asperity.friction_coefficient
    0.1
    """

    composite_roughness: float
    composite_modulus: float
    density_radius_roughness: float = 0.05
    roughness_radius_ratio: float = 0.01
    friction_coefficient: float = 0.1
    transition_speed: float = 0.01
    residual_film: float = 0.02

    checks: ClassVar = {
        "composite_roughness": partial(POSITIVE, hint=f"{ROUGHNESS} asperity=None."),
        **dict.fromkeys(("composite_modulus", "density_radius_roughness", "roughness_radius_ratio"), POSITIVE),
        "transition_speed": POSITIVE,
        "friction_coefficient": partial(
            NOT_NEGATIVE, at_most=5.0, hint="lubricated metals have 0.05 to 0.2, rubber up to 2."
        ),
        "residual_film": partial(require_number, at_least=0.001, at_most=0.2),
    }

    @property
    def pressure_scale(self) -> float:
        """Contact pressure at F = 1, Pa."""
        product, ratio = self.density_radius_roughness, self.roughness_radius_ratio
        return 16.0 * math.sqrt(2.0) * math.pi / 15.0 * product**2 * math.sqrt(ratio) * self.composite_modulus


def greenwood_tripp_integral(order: float, u: np.ndarray | float) -> np.ndarray:
    """F_order(u) from the parabolic cylinder function; good to about 1e-12 for u within -8 and 8."""
    u = np.asarray(u, dtype=float)
    return (
        scipy.special.gamma(order + 1.0)
        / math.sqrt(2.0 * math.pi)
        * np.exp(-0.25 * u * u)
        * scipy.special.pbdv(-order - 1.0, u)[0]
    )


@cache
def contact_knots() -> np.ndarray:
    """Values and derivatives (k, 2) of F_5/2 at u = -64, ..., 8 in steps of 1/64; zero at the last knot."""
    u = np.linspace(DEEPEST, REACH, int((REACH - DEEPEST) * STEPS_PER_SIGMA) + 1)
    near = np.maximum(u, -REACH)
    knots = np.column_stack((greenwood_tripp_integral(2.5, near), -2.5 * greenwood_tripp_integral(1.5, near)))
    deep = -u[u < -REACH]
    q = deep**-2
    knots[u < -REACH, 0] = deep**2.5 * (1.0 + q * (1.875 + q * (-0.1171875 + q * -0.0732421875)))
    knots[u < -REACH, 1] = -(deep**1.5) * (2.5 + q * (0.5 * 1.875 + q * (1.5 * 0.1171875 + q * 3.5 * 0.0732421875)))
    knots[-1] = 0.0
    return knots


class AsperityContact(AverageGap, Contact):
    """`GreenwoodTripp` in scaled form: contact pressure and gap limiter of one bearing model.

    Parameters
    ----------
    asperity : GreenwoodTripp
    clearance : float
        Radial clearance, m.
    """

    def __init__(self, asperity: GreenwoodTripp, clearance: float) -> None:
        AverageGap.__init__(self, asperity.composite_roughness / clearance, asperity.residual_film)
        friction = asperity.friction_coefficient, asperity.transition_speed
        Contact.__init__(self, self.sigma, asperity.pressure_scale, (DEEPEST, REACH), contact_knots(), *friction)


# gamma: C, r, smallest H, A1, a1, a2, a3, A2, A3, a4, a5, a6
PATTERNS = {
    1 / 9: (1.48, 0.42, 1.0, 2.046, 1.12, 0.78, 0.03, 1.856, 14.1, 2.45, 2.30, 0.10),
    1 / 6: (1.38, 0.42, 1.0, 1.962, 1.08, 0.77, 0.03, 1.754, 13.4, 2.42, 2.30, 0.10),
    1 / 3: (1.18, 0.42, 0.75, 1.858, 1.01, 0.76, 0.03, 1.561, 12.3, 2.32, 2.30, 0.10),
    1.0: (0.9, 0.56, 0.5, 1.899, 0.98, 0.92, 0.05, 1.126, 11.1, 2.31, 2.38, 0.11),
    3.0: (0.225, 1.5, 0.5, 1.56, 0.85, 1.13, 0.08, 0.556, 9.8, 2.25, 2.80, 0.18),
    6.0: (0.52, 1.5, 0.5, 1.29, 0.62, 1.09, 0.08, 0.388, 10.1, 2.25, 2.90, 0.18),
    9.0: (0.87, 1.5, 0.5, 1.011, 0.54, 1.07, 0.08, 0.295, 8.7, 2.15, 2.97, 0.18),
}
FRICTION_REACH = 7.0
SHEAR_CUTOFF = 0.01
FLOW_BLEND = 0.5
SHEAR_BLEND = 0.15
TABLE_STEPS = 2048
# Gap, in sigma, at the middle of the tables: half of the knots are for larger gaps, where the factors vary slowly. A
# larger value places more knots at small gaps.
TABLE_MIDDLE = 8.0


@dataclass(frozen=True, kw_only=True)
class PatirCheng(Checked):
    """Flow and friction factors of rough surfaces; for films below about five times the roughness.

    When: films below three to five times the composite roughness.

    Without ``asperity`` a nominal gap of zero ends the run with an error. With `GreenwoodTripp` both must have the same
    ``composite_roughness``. Not with ``contact=RegularisedWall(...)``.

    Parameters
    ----------
    composite_roughness : float
        sigma = sqrt(sigma_journal^2 + sigma_bore^2) of the r.m.s. roughnesses, m.
    pattern : float, default 1.0
        gamma, correlation length in theta over that in z. One of the patterns that Patir and Cheng computed: 1/9, 1/6,
        1/3 (lay across the motion), 1 (isotropic), 3, 6, 9 (lay along the motion).
    journal_share : float, default 0.5
        sigma_journal^2 / sigma^2, 0 to 1; 0.5: equally rough surfaces, whose shear flow factors cancel. The rougher
        surface drags more oil along and is pulled more by a pressure gradient.

    Source
    ------
    N. Patir and H. S. Cheng, J. Lubrication Technology 100 (1978) 12 and 101 (1979) 220.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, roughness=ehd.PatirCheng(composite_roughness=0.5e-6, pattern=3))
    >>> bearing.roughness.journal_share
    0.5
    """

    composite_roughness: float
    pattern: float = 1.0
    journal_share: float = 0.5

    checks: ClassVar = {
        "composite_roughness": partial(POSITIVE, hint=f"{ROUGHNESS} roughness=None."),
        "pattern": POSITIVE,
        "journal_share": partial(NOT_NEGATIVE, at_most=1.0, hint="it is a share."),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if not any(math.isclose(self.pattern, known, rel_tol=1e-3) for known in PATTERNS):
            raise InputError(
                f"PatirCheng.pattern must be one of 1/9, 1/6, 1/3, 1, 3, 6, 9 (the computed patterns), got "
                f"{self.pattern!r}; take the nearest one."
            )


def pressure_flow_factor(H: np.ndarray, pattern: float) -> np.ndarray:
    """phi_x(H, gamma); phi_z(H, gamma) is phi_x(H, 1/gamma)."""
    C, r = _constants(pattern)[:2]
    H = np.asarray(H, dtype=float)
    return 1.0 - C * np.exp(-r * H) if pattern <= 1.0 + 1e-9 else 1.0 + C * H**-r


def shear_flow_factor(H: np.ndarray, pattern: float) -> np.ndarray:
    """Phi_s(H, gamma) of one rough surface."""
    A1, a1, a2, a3, A2 = _constants(pattern)[3:8]
    H = np.asarray(H, dtype=float)
    return np.where(H <= 5.0, A1 * H**a1 * np.exp(-a2 * H + a3 * np.minimum(H, 5.0) ** 2), A2 * np.exp(-0.25 * H))


def shear_stress_factor(H: np.ndarray, pattern: float) -> np.ndarray:
    """Phi_fs(H, gamma) of one rough surface; beyond H = 7 a power of H that continues the fit with its slope."""
    A3, a4, a5, a6 = _constants(pattern)[8:]
    H, end = np.asarray(H, dtype=float), FRICTION_REACH
    power = a4 - a5 * end + 2.0 * a6 * end**2
    near = np.minimum(H, end)
    return A3 * near**a4 * np.exp(-a5 * near + a6 * near**2) * (np.maximum(H, end) / end) ** power


def mean_inverse_gap(H: np.ndarray) -> np.ndarray:
    """``E[1 / local gap]`` over the open film with local gaps above sigma / 100; H (k,) and result in sigma units.

    The integral runs in ln(gap) by the trapezoidal rule; from H = 15 on it is ``1/H + 1/H^3 + 3/H^5 + 15/H^7``
    (error 4e-8).
    """
    v = np.linspace(math.log(SHEAR_CUTOFF), math.log(40.0), 4001)
    gap = np.exp(v)
    weight = np.full(v.size, v[1] - v[0]) / math.sqrt(2.0 * math.pi)
    weight[0] *= 0.5
    near = np.minimum(H, 15.0)
    integral = np.array([float(np.exp(-0.5 * (gap - x) ** 2) @ weight) for x in near])
    far = 1.0 / np.maximum(H, 15.0)
    q = far * far
    return np.where(H > 15.0, far * (1.0 + q * (1.0 + q * (3.0 + q * 15.0))), integral)


def _constants(pattern: float) -> tuple[float, ...]:
    return next(v for known, v in PATTERNS.items() if math.isclose(pattern, known, rel_tol=1e-3))


def _continued(log_value: np.ndarray, s: np.ndarray, start: int, blend: float) -> np.ndarray:
    """Replace ``log_value`` before index ``start`` by its tangent in s, bent to a constant over ``blend``."""
    slope = (log_value[start + 1] - log_value[start]) / (s[start + 1] - s[start])
    d = s[:start] - s[start]
    return np.concatenate((log_value[start] + slope * blend * np.tanh(d / blend), log_value[start:]))


def _table(y: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Cubic spline through values(y) as (k, 4) coefficients of the powers of u = (y - y_k) / step."""
    step = y[1] - y[0]
    return np.ascontiguousarray(scipy.interpolate.CubicSpline(y, values).c[::-1].T * step ** np.arange(4))


@cache
def flow_tables(pattern: float, residual: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tables (k, 4) of phi, psi and the friction factor over y = 1 / (1 + h_T / (8 sigma)) in [0, 1]."""
    y = np.linspace(0.0, 1.0, TABLE_STEPS + 1)
    y_safe = np.clip(y, 1e-6, 1.0 - 1e-9)
    t = TABLE_MIDDLE * (1.0 - y_safe) / y_safe
    x = nominal_gap(t, residual)
    order = np.argsort(t)
    ts, xs = t[order], x[order]
    start = int(np.searchsorted(xs, _constants(pattern)[2]))
    positive = np.maximum(xs, 1e-3)
    s = np.log(ts)
    flow = np.log(np.maximum(pressure_flow_factor(positive, pattern), 1e-12) * (positive / ts) ** 3)
    shear = np.log(np.maximum(shear_flow_factor(positive, pattern) / ts, 1e-300))
    phi = np.exp(_continued(flow, s, start, FLOW_BLEND))[::-1]
    psi = np.exp(_continued(shear, s, start, SHEAR_BLEND))[::-1]
    drag = np.log(np.maximum(shear_stress_factor(positive, pattern) * ts / positive, 1e-300))
    friction = (ts * mean_inverse_gap(xs) + np.exp(_continued(drag, s, start, SHEAR_BLEND)))[::-1].copy()
    phi[0] = friction[0] = 1.0
    return _table(y, phi), _table(y, psi), _table(y, friction)


def nominal_gap(t: np.ndarray, residual: float) -> np.ndarray:
    """h / sigma for average gaps t = h_T / sigma, by bisection; -38 for closed gaps."""
    t = np.asarray(t, dtype=float)
    low, high = np.full(t.shape, -38.0), t + 1.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        below = average_gap_ratio(middle, residual) < t
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high)


class RoughFlow(FluxEffect):
    """`PatirCheng` as flux effect and shear factor of one bearing model.

    Parameters
    ----------
    roughness : PatirCheng
    clearance : float
        Radial clearance, m.
    residual : float
        Residual film of the average gap, share of sigma.
    """

    depends_on_speed = False

    def __init__(self, roughness: PatirCheng, clearance: float, residual: float) -> None:
        self.sigma = roughness.composite_roughness / clearance
        self.phi_x, self.psi_x, self.friction = flow_tables(roughness.pattern, residual)
        self.phi_z, self.psi_z, _ = flow_tables(1.0 / roughness.pattern, residual)
        self.shear = 2.0 * roughness.journal_share - 1.0
        self.changes_carriers = self.shear != 0.0

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Multiply conductances and carriers by their factors at the links' average gaps (n, m), with derivatives."""
        multiply_by_table(gap_x, 1.0 / self.sigma, self.phi_x, 0.0, 1.0, flux.gx, flux.gx_h)
        multiply_by_table(gap_z, 1.0 / self.sigma, self.phi_z, 0.0, 1.0, flux.gz, flux.gz_h)
        if self.shear != 0.0:
            multiply_by_table(gap_x, 1.0 / self.sigma, self.psi_x, 1.0, self.shear, flux.cx, flux.cx_h)
            multiply_by_table(gap_z, 1.0 / self.sigma, self.psi_z, 1.0, self.shear, flux.cz, flux.cz_h)

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> None:
        """Friction factor phi_f + Phi_fs at average gaps H (n, m) and its derivatives with respect to H and vx."""
        look_up(H, 1.0 / self.sigma, self.friction, ratio_out, ratio_h_out)
        ratio_v_out[:] = 0.0


# Checks for a division by zero would keep the compiler from vectorising the loops below.
@njit(cache=True, fastmath=FAST, error_model="numpy")
def multiply_by_table(gap, inverse_sigma, table, base, share, value, value_h):
    """value *= f, with its derivative by the gap, f = base + share table(y), y = 1 / (1 + gap / (8 sigma)).

    In place.
    """
    factor, factor_h = np.empty(gap.shape), np.empty(gap.shape)
    look_up(gap, inverse_sigma, table, factor, factor_h)
    v, v_h, f, f_h = value.reshape(-1), value_h.reshape(-1), factor.reshape(-1), factor_h.reshape(-1)
    for k in range(v.size):
        by = base + share * f[k]
        v_h[k] = v_h[k] * by + v[k] * (share * f_h[k])
        v[k] *= by


@njit(cache=True, fastmath=FAST, error_model="numpy")
def look_up(gap, inverse_sigma, table, f_out, f_h_out):
    """Value of a table at gaps (n, m), and its derivative by them."""
    h, f, f_h = gap.reshape(-1), f_out.reshape(-1), f_h_out.reshape(-1)
    scale, steps = inverse_sigma / TABLE_MIDDLE, len(table)
    for c in range(h.size):
        y = 1.0 / (1.0 + h[c] * scale)
        u = y * steps
        k = min(int(u), steps - 1)
        u -= k
        a, b, c2, c3 = table[k]
        f[c] = a + u * (b + u * (c2 + u * c3))
        f_h[c] = (b + u * (2.0 * c2 + u * 3.0 * c3)) * steps * (-y * y * scale)


def drag_weights(
    carriers: tuple[np.ndarray, np.ndarray], gap: np.ndarray, link: np.ndarray, widths: np.ndarray
) -> np.ndarray:
    """Weights (2, n, m) of the pressures in E_x and E_z.

    ``carriers``: of the links in theta and in z; ``gap``, ``link``: true gaps at the vertices and on the links i ->
    i+1; ``widths`` (2, n, m): `FilmGrid.link_widths`.
    """
    return drop_weights((np.array(carriers) - (link, on_links(gap)[1])) * widths)


def drag_by_gap(
    P: np.ndarray,
    carrier_slopes: tuple[np.ndarray, np.ndarray],
    slope: np.ndarray,
    face_slope: np.ndarray,
    widths: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Gradients (n, m) at fixed pressure to the true gap: of E_x on the links i -> i+1, of E_z at the vertices.

    ``carrier_slopes``: of the carriers in theta and z to the film's gap there; ``slope``, ``face_slope``: h' at
    vertices and links; ``widths`` as in `drag_weights`.
    """
    (along, across), (x, z) = carrier_slopes, widths * drops(P)
    return (along * face_slope - 1.0) * x, to_ends(across * z, 1) * slope - to_ends(z, 1)
