"""Surfaces under load: contact pressure, limiters of the film's gap, wear, and elastic liners.

The pressure of a contact is ``level F(h / unit)``. F is a cubic Hermite spline through equidistant knots. It decreases
with the gap, is convex, and is zero with zero slope at its last knot. Below its first knot the first cubic continues.

Fields are (n, m) arrays on the film grid; gaps are divided by the clearance, contact pressures in Pa.

Wall: stiff and smooth, before the gap vanishes
-----------------------------------------------
For a gap h below the onset h0, with s = h / h0:

* contact pressure ``p_w = pressure (1 - s)^2`` (continuous first derivative, still rising for h < 0), and
* the film sees ``h0 g(s)``, ``g = 1 - a tanh((1 - s) / a)``, a = 1 - residual gap
  share: equal to s up to second derivatives at s = 1 and never below ``residual h0``,
  so that the Reynolds equation keeps a solution while surfaces press on each other.

The wall is a regularisation with one stiffness, not a model of asperities, and it has no friction. Where it acts, the
film's gap changes less along the surface than the gap of the solids. The film's pressure on this difference of slopes
acts along the normal of the journal and has no torque about its axis: see closed gaps in
`exudyn_ehd.film.surfaces.roughness`.

Wear of the bore after Archard, which adds to the gap
-----------------------------------------------------
``dh/dt = k p v`` with the asperity contact's pressure p, the sliding speed v and the specific wear rate k in m2/N (k =
K / H with Archard's dimensionless K and the softer surface's hardness H). Source: J. F. Archard, J. Applied Physics 24
(1953) 981.

The depth belongs to the accepted history: the film of a step uses the depth at its start. The wear of the step is added
at its end, with the pressure and speed found there (explicit in the gap, first order in the step; wear per step is a
tiny share of the roughness).

Wrench of contact pressures and of their friction, and its gradient
-------------------------------------------------------------------
The wrench is linear in the integrals of the pressure times `FilmGrid.moments`: cos, sin, z cos, z sin and 1. The
pressures do no work on the journal's spin, so that their torque about O is e x F. Friction acts at the bore's points
against the slip, regularised as ``v / sqrt(|v|^2 + v0^2)``.

Elastic liner, whose deflection at a point depends on the pressure at that point only
-------------------------------------------------------------------------------------
A layer of thickness t on a stiff housing, pressed by p without sliding sideways (plane strain in both directions along
the surface), deflects by

    delta = K_nu t p / E,    K_nu = (1 + nu)(1 - 2 nu) / (1 - nu),

the Winkler model. It is right for layers thinner than the width of the contact, and wrong for incompressible layers.
`exudyn_ehd.film.solvers.liner` solves the film on a liner.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar, Protocol

import numpy as np
from numba import njit

from exudyn_ehd.compilation import MOST_STEPS, TOLERANCE
from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, ROUNDING, Checked, InputError, require_number


class GapLimiter(Protocol):
    """Limiter that keeps the film's gap above zero where surfaces touch.

    Attributes
    ----------
    limits_below : float
        Scaled gap above which the film's gap is the gap of the surfaces.
    """

    limits_below: float

    def film_gap(self, gaps: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> None:
        """Replace ``gaps`` below ``limits_below`` by the film's gaps, in place, and set their first two derivatives.

        Contiguous arrays of one shape; derivatives of other gaps are not changed.
        """

    def limit(
        self,
        H: np.ndarray,
        HF: np.ndarray,
        H_t: np.ndarray,
        slope_out: np.ndarray,
        bend_out: np.ndarray,
        face_slope_out: np.ndarray,
    ) -> None:
        """Replace gaps at vertices (H) and links (HF) and the gap's rate (H_t) by the film's, in place.

        ``slope_out`` and ``face_slope_out`` are set to d(film gap)/d(gap), ``bend_out`` to the second derivative times
        the gap's rate.
        """
        slope_out[:], bend_out[:], face_slope_out[:] = 1.0, 0.0, 1.0
        self.film_gap(H, slope_out, bend_out)
        # rates of a step that closes the gap may be infinite; Newton's method then rejects it by its residual
        with np.errstate(invalid="ignore"):
            bend_out *= H_t
            H_t *= slope_out
        self.film_gap(HF, face_slope_out, np.empty_like(HF))


class Contact:
    """Contact pressure between the surfaces, which depends on their gap alone.

    Parameters
    ----------
    unit : float
        Scaled gap for a unit of the spline's argument.
    level : float
        Contact pressure at F = 1, Pa.
    ends : (float, float)
        First and last knot.
    knots : (k, 2) array
        Values and slopes of F.
    friction_coefficient : float
        Boundary friction coefficient; 0 for a frictionless contact.
    transition_speed : float
        Sliding speed over which Coulomb friction is regularised, m/s.

    Attributes
    ----------
    presses_below : float
        Scaled gap above which there is no pressure.
    land : (n, m) array or float
        Share of a vertex's control volume outside of supply areas, as a factor of the pressure: supply areas do not
        touch the journal.
    """

    land: np.ndarray | float = 1.0

    def __init__(
        self,
        unit: float,
        level: float,
        ends: tuple[float, float],
        knots: np.ndarray,
        friction_coefficient: float = 0.0,
        transition_speed: float = 1.0,
    ) -> None:
        self.presses_below = unit * ends[1]
        self.friction_coefficient, self.transition_speed = friction_coefficient, transition_speed
        step = (ends[1] - ends[0]) / (len(knots) - 1)
        # first knot and distance of the knots as scaled gaps; values in Pa, slopes in Pa over this distance
        self.law = unit * ends[0], unit * step, level * knots * np.array([1.0, step])

    def pressure(self, H: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray) -> None:
        """Contact pressure, Pa, and its derivative to the scaled gap H (n, m); overwrites both outputs."""
        contact_pressure(H, self.presses_below, *self.law, P_out, slope_out)
        P_out *= self.land
        slope_out *= self.land

    def solve_gap(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None:
        """Solve ``G = X + compliance pressure(G) / scale`` on Winkler elements for G (n, m), in place from any start.

        Outputs: the pressure at G, Pa, and its slope over ``scale``, both on the land.
        """
        solve_contact_gap(X, compliance / scale, scale, self.presses_below, *self.law, G, P_out, slope_out)
        inside = np.less(self.land, ROUNDING)
        np.copyto(G, X, where=inside)
        np.copyto(slope_out, 0.0, where=inside)
        P_out *= self.land

    def on_land(self, land: np.ndarray) -> Contact:
        """The contact outside of supply areas; ``land`` (n, m), which may change, as of
        `exudyn_ehd.film.supply.cuts.SupplyMap`."""
        contact = copy.copy(self)
        contact.land = land
        return contact


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


@njit(cache=True)
def _pressure_at(h, first, step, knots):
    """Contact pressure and its derivative at one gap."""
    s = (h - first) / step
    k = min(max(int(s), 0), len(knots) - 2)
    s -= k
    a, b = knots[k]
    rise = knots[k + 1, 0] - a
    c2 = 3.0 * rise - 2.0 * b - knots[k + 1, 1]
    c3 = rise - b - c2
    return a + s * (b + s * (c2 + s * c3)), (b + s * (2.0 * c2 + s * 3.0 * c3)) / step


@njit(cache=True)
def contact_pressure(H, reach, first, step, knots, P_out, slope_out):
    """Contact pressure and its derivative with respect to H, zero from ``reach`` on."""
    h, P, slope = H.reshape(-1), P_out.reshape(-1), slope_out.reshape(-1)
    for k in range(h.size):
        P[k] = slope[k] = 0.0
        if h[k] < reach:
            P[k], slope[k] = _pressure_at(h[k], first, step, knots)


@njit(cache=True)
def solve_contact_gap(X, compliance, scale, reach, first, step, knots, G, P_out, slope_out):
    """Solve ``G - X - compliance p(G) = 0``, the gap on Winkler elements under a contact, in place from any start.

    p falls and is convex, so that Newton's method gets below the root in one step, never below X, and then rises to it.
    Also sets the pressure at G, and its derivative to G over ``scale``.
    """
    gap, P, slope = G.reshape(-1), P_out.reshape(-1), slope_out.reshape(-1)
    for k, x in enumerate(X.reshape(-1)):
        g, p, p_h = x, 0.0, 0.0
        if x < reach:
            g = max(gap[k], x)
            for _ in range(MOST_STEPS):
                p, p_h = _pressure_at(min(g, reach), first, step, knots)
                change = (x + compliance * p - g) / (1.0 - compliance * p_h)
                g += change
                # the slope of the pressure is that before the last step
                if abs(change) <= TOLERANCE * reach:
                    break
            p += p_h * change
        gap[k], P[k], slope[k] = g, p, p_h / scale


@dataclass(frozen=True, kw_only=True)
class RegularisedWall(Checked):
    """Contact as a stiff smooth wall for gaps below an onset: a stop, no model of rough surfaces.

    For journals that touch now and then. At a gap h below the onset the contact pressure is ``pressure (1 - h /
    onset)^2``; the wall has no friction of its own. Not with `GreenwoodTripp` or `PatirCheng`.

    Parameters
    ----------
    onset : float
        Gap at which the wall starts to act, m; a few roughness heights. Must be below the radial clearance.
    pressure : float, default 1e9
        Contact pressure at zero gap, Pa.
    residual : float, default 0.2
        Smallest gap that the film sees, as a share of the onset, 0.01 to 0.9.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, contact=ehd.RegularisedWall(onset=2e-6))
    >>> bearing.contact.pressure  # Pa at zero gap
    1000000000.0
    """

    onset: float
    pressure: float = 1e9
    residual: float = 0.2

    checks: ClassVar = {
        "onset": POSITIVE,
        "pressure": POSITIVE,
        "residual": partial(require_number, at_least=0.01, at_most=0.9),
    }


class WallContact(Contact, GapLimiter):
    """A `RegularisedWall` in scaled form: contact pressure and gap limiter of one bearing model.

    Parameters
    ----------
    wall : RegularisedWall
    clearance : float
        Radial clearance, m.
    """

    def __init__(self, wall: RegularisedWall, clearance: float) -> None:
        self.onset = self.limits_below = wall.onset / clearance
        self.residual = wall.residual
        # (1 - s)^2 from s = 0 to 1
        super().__init__(self.onset, wall.pressure, (0.0, 1.0), np.array([[1.0, -2.0], [0.0, 0.0]]))

    def film_gap(self, gaps: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> None:
        """Gap ``onset g(s)`` with its derivatives; arguments as for `GapLimiter`."""
        wall_gap(gaps, self.onset, 1.0 - self.residual, slopes, bends)


@njit(cache=True)
def wall_gap(gaps, onset, a, slopes, bends):
    """``onset g(gap / onset)`` where the wall acts, with its first two derivatives, in place."""
    g, slope, bend = gaps.reshape(-1), slopes.reshape(-1), bends.reshape(-1)
    for k in range(g.size):
        if g[k] < onset:
            t = np.tanh((1.0 - g[k] / onset) / a)
            g[k] = onset * (1.0 - a * t)
            slope[k] = 1.0 - t * t
            bend[k] = 2.0 * t * slope[k] / (a * onset)


@dataclass(frozen=True, kw_only=True)
class ArchardWear(Checked):
    """Wear of the bore by its asperity contact; needs ``asperity=GreenwoodTripp(...)``.

    The depth grows by ``k p v`` per time, with the contact pressure p and the sliding speed v, and adds to the gap of
    the next step. The worn volume is k times the integral over the surface of pressure times sliding distance: 3 % more
    than k times ``contact_load`` times distance for a contact over 0.8 rad, as ``contact_load`` is a vector sum.

    A joint gives the largest depth, m, as ``history.wear_depth``, the volume, m3, as ``history.worn_volume``, and a
    picture of the depth by ``plot_wear_depth()``.

    Parameters
    ----------
    wear_rate : float
        Specific wear rate k, m3 per N and m of sliding, that is m2/N; from 1e-18 (well lubricated) to 1e-14 (dry).
    acceleration : float, default 1.0
        Factor on k: with 1e6 a second stands for twelve days of the same motion. It must be so small that the depth
        changes by much less than the roughness in a period of the load.

    Source
    ------
    J. F. Archard, J. Applied Physics 24 (1953) 981.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> rough = ehd.GreenwoodTripp(composite_roughness=0.5e-6, composite_modulus=8e10)
    >>> bearing = ehd.JournalBearing(**b, asperity=rough, wear=ehd.ArchardWear(wear_rate=1e-16, acceleration=1000))
    >>> bearing.wear.wear_rate  # m^2/N
    1e-16
    """

    wear_rate: float
    acceleration: float = 1.0

    checks: ClassVar = {
        "wear_rate": partial(NOT_NEGATIVE, hint="1e-16 is a start for a lubricated bush."),
        "acceleration": POSITIVE,
    }

    def growth(self, pressure: np.ndarray, speed: float, step: float) -> np.ndarray:
        """Depth of wear, m, by contact pressures, Pa, in a step, s, at a sliding speed, m/s."""
        depth: np.ndarray = pressure * (self.wear_rate * self.acceleration * step * speed)
        return depth


def slip(motion: np.ndarray, R: float, transition: float) -> tuple[np.ndarray, np.ndarray]:
    """Regularised slip direction (theta, z) of a motion (10,), and its derivatives (2, 2) to (omega, w).

    ``transition``: v0, m/s.
    """
    v, w = R * float(motion[8]), float(motion[9])
    size = math.sqrt(v * v + w * w + transition * transition)
    a, b = v / size, w / size
    return np.array([a, b]), np.array([[(1.0 - a * a) * R, -a * b], [-a * b * R, 1.0 - b * b]]) / size


def _traction_weights(traction: np.ndarray, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench of a traction (2,) over the pressure, towards -theta and -z."""
    a, b = R**2 * traction
    return np.array(
        [
            [0.0, a, 0.0, 0.0, 0.0],
            [-a, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, -b],
            [0.0, -R * b, R * a, 0.0, 0.0],
            [R * b, 0.0, 0.0, R * a, 0.0],
            [0.0, 0.0, 0.0, 0.0, -R * a],
        ]
    )


def _pressure_weights(motion: np.ndarray, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench about O of pressures, N and Nm."""
    x, y, bx, by = (R**2 * motion[:4]).tolist()
    force, moment = R**2, R**3
    return np.array(
        [
            [-force, 0.0, 0.0, 0.0, 0.0],
            [0.0, -force, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, moment, 0.0],
            [0.0, 0.0, -moment, 0.0, 0.0],
            [y, -x, R * by, -R * bx, 0.0],
        ]
    )


def contact_weights(motion: np.ndarray, friction: float, transition: float, R: float) -> np.ndarray:
    """Weights (6, 5) of the integrals in the wrench about O of pressures and their Coulomb friction, N and Nm."""
    return _pressure_weights(motion, R) + _traction_weights(friction * slip(motion, R, transition)[0], R)


def add_contact(
    P: np.ndarray,
    weight: np.ndarray,
    moments: np.ndarray,
    motion: np.ndarray,
    friction: float,
    transition: float,
    R: float,
    integrals_out: np.ndarray,
    friction_out: np.ndarray,
    wrench: np.ndarray,
) -> None:
    """Set the integrals (5,) of a contact's pressures P (n, m), and add its wrench and that of its friction alone, both
    (6,)."""
    integrals_out[:] = moments.reshape(5, -1) @ (P * weight).ravel()
    drag = _traction_weights(friction * slip(motion, R, transition)[0], R) @ integrals_out
    wrench += _pressure_weights(motion, R) @ integrals_out + drag
    friction_out += drag


def contact_tangent(
    slope: np.ndarray,
    weight: np.ndarray,
    moments: np.ndarray,
    motion: np.ndarray,
    pose_scale: np.ndarray,
    friction: float,
    transition: float,
    R: float,
    integrals: np.ndarray,
) -> np.ndarray:
    """Gradient (6, 10) of a contact's wrench to the motion.

    ``slope`` (n, m): derivative of the pressure to the scaled gap; ``integrals`` (5,): of `add_contact`.
    """
    out, flat = np.zeros((6, 10)), moments.reshape(5, -1)
    by_pose = (flat * (slope * weight).ravel()) @ flat[:4].T * -pose_scale
    out[:, :4] = contact_weights(motion, friction, transition, R) @ by_pose
    c, s, zc, zs, _ = R**2 * integrals
    out[5, :4] += -s, c, -R * zs, R * zc
    for q, by_speed in enumerate(slip(motion, R, transition)[1].T):
        out[:, 8 + q] = _traction_weights(friction * by_speed, R) @ integrals
    return out


@dataclass(frozen=True, kw_only=True)
class ElasticLiner(Checked):
    """Thin elastic layer on a rigid housing, which deflects where the pressure acts (Winkler elements).

    Use it for soft or thick layers whose deflection reaches a tenth of the minimum film thickness; a housing that
    bends needs a bush with a mesh. Each point deflects outward by ``compliance`` times its own pressure, in one solve
    with the film; ``compliance`` = (1 + nu) (1 - 2 nu) / (1 - nu) t / E.

    Contact pressure deflects the liner too: journals may sink into soft liners, also at their edges, by more than the
    clearance; under `ElrodAdams` such a film can starve. Liners work with every law and effect, but not with the
    reduced films (such as `ShortBearing`). With `BarusPressure` or `RoelandsPressure` the result is the classical
    elastohydrodynamic film, in which high viscosity and deflection increase each other.

    Parameters
    ----------
    thickness : float
        Thickness t, m.
    youngs_modulus : float
        Young's modulus E, Pa.
    poisson_ratio : float, default 0.3
        Poisson's ratio nu, 0 to 0.49: incompressible layers do not deflect point by point.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> liner = ehd.ElasticLiner(thickness=0.002, youngs_modulus=3e9, poisson_ratio=0.35)
    >>> f"{liner.compliance:.2g}"  # m/Pa
    '4.2e-13'
    >>> bearing = ehd.JournalBearing(**b, bush=liner)
    """

    thickness: float
    youngs_modulus: float
    poisson_ratio: float = 0.3

    checks: ClassVar = {
        "thickness": POSITIVE,
        "youngs_modulus": POSITIVE,
        "poisson_ratio": partial(
            NOT_NEGATIVE,
            at_most=0.49,
            hint="a nearly incompressible liner does not deflect point by point, take a bush with a mesh.",
        ),
    }

    @property
    def compliance(self) -> float:
        """Deflection per pressure K_nu t / E, m/Pa."""
        nu = self.poisson_ratio
        return (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu) * self.thickness / self.youngs_modulus
