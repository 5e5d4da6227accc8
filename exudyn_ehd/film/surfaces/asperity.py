"""Contact pressure of rough surfaces after Greenwood and Tripp, with boundary friction, and their average gap.

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
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
import scipy
from numba import njit

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
        self.sigma = sigma
        self.residual = residual
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


def composite_modulus(youngs_moduli: tuple[float, float], poisson_ratios: tuple[float, float]) -> float:
    """Composite modulus E' of two bodies in contact, ``1/E' = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2``.

    Parameters
    ----------
    youngs_moduli : (float, float)
        E_1, E_2, Pa.
    poisson_ratios : (float, float)
        nu_1, nu_2, each between -1 and 0.5.

    Returns
    -------
    float
        E', Pa.

    Raises
    ------
    InputError
        For other than two bodies, moduli that are not positive, or Poisson ratios beyond -1 to 0.5.

    Examples
    --------
    >>> round(1e-9 * ehd.composite_modulus((2.1e11, 1.1e11), (0.3, 0.34)), 1)  # GPa, steel on bronze
    80.8
    """
    if not len(youngs_moduli) == len(poisson_ratios) == 2:
        raise InputError(
            "composite_modulus: youngs_moduli and poisson_ratios must be two numbers each, one of each body, got "
            f"{len(youngs_moduli)} and {len(poisson_ratios)}."
        )
    compliance = 0.0
    for E, nu in zip(youngs_moduli, poisson_ratios, strict=True):
        POSITIVE("composite_modulus: youngs_moduli", E)
        require_number("composite_modulus: poisson_ratios", nu, above=-1.0, at_most=0.5)
        compliance += (1.0 - nu**2) / E
    return 1.0 / compliance


def greenwood_tripp_integral(order: float, u: np.ndarray | float) -> np.ndarray:
    """F_order(u) from the parabolic cylinder function; good to about 1e-12 for u within -8 and 8."""
    u = np.asarray(u, dtype=float)
    return (
        scipy.special.gamma(order + 1.0)
        / math.sqrt(2.0 * math.pi)
        * np.exp(-0.25 * u * u)
        * scipy.special.pbdv(-order - 1.0, u)[0]
    )


@functools.cache
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
