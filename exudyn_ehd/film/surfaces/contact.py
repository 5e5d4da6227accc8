"""Contacts, which press where surfaces touch, and limiters of the gap that the film sees.

A contact presses with ``level F(h / unit)``. F is a cubic Hermite spline through equidistant knots, falls and is
convex, ends at its last knot with zero slope, and goes on as its first cubic below its first knot.

Fields are (n, m) arrays on the film grid; gaps are divided by the clearance, contact pressures in Pa.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numba import njit

# Share of land below which a vertex lies inside an area: far above round-off, far below what an edge leaves.
INSIDE = 1e-9
# Of the gap on an elastic element: Newton steps at most, and the last one over the gap at which the contact begins. The
# slope of the pressure is that before the last step.
MOST_STEPS, LAST_STEP = 60, 1e-13


class GapLimiter(Protocol):
    """Keeps the gap that the film sees above zero where surfaces touch.

    Attributes
    ----------
    limits_below : float
        Scaled gap from which on the film sees the gap itself.
    """

    limits_below: float

    def film_gap(self, gaps: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> None:
        """Replace the ``gaps`` below ``limits_below`` by the film's, with their first two derivatives, in place.

        Contiguous arrays of one shape; derivatives of other gaps are left as they are.
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

        ``slope_out`` and ``face_slope_out`` take d(film gap)/d(gap), ``bend_out`` the second derivative times the
        gap's rate.
        """
        slope_out[:], bend_out[:], face_slope_out[:] = 1.0, 0.0, 1.0
        self.film_gap(H, slope_out, bend_out)
        # rates of a step that closes the gap may be infinite: its residual refuses it
        with np.errstate(invalid="ignore"):
            bend_out *= H_t
            H_t *= slope_out
        self.film_gap(HF, face_slope_out, np.empty_like(HF))


class Contact:
    """A pressure between the surfaces that depends on the true gap alone.

    Parameters
    ----------
    unit : float
        Scaled gap of one unit of the spline.
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
        Scaled gap from which on there is no pressure.
    """

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

    def solve_gap(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None:
        """Solve ``G = X + compliance pressure(G) / scale`` on Winkler elements for G (n, m), in place from any start.

        Outputs: the pressure there, Pa, and its slope over ``scale``.
        """
        solve_contact_gap(X, compliance / scale, scale, self.presses_below, *self.law, G, P_out, slope_out)


class LandContact(Contact):
    """A contact outside of supply areas, where nothing touches: its pressure times the land's share of a vertex.

    Parameters
    ----------
    contact : Contact
    land : (n, m) array
        As of `exudyn_ehd.film.supply.cuts.SupplyMap`; it may change.
    """

    def __init__(self, contact: Contact, land: np.ndarray) -> None:
        self.contact, self.land = contact, land
        self.presses_below = contact.presses_below
        self.friction_coefficient, self.transition_speed = contact.friction_coefficient, contact.transition_speed

    def pressure(self, H: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray) -> None:
        """Pressure and slope as of `Contact`."""
        self.contact.pressure(H, P_out, slope_out)
        P_out *= self.land
        slope_out *= self.land

    def solve_gap(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None:
        """Gap and slope on the land, as of `Contact`, and the land's share of the pressure; no contact in areas."""
        self.contact.solve_gap(X, compliance, scale, G, P_out, slope_out)
        inside = self.land < INSIDE
        G[inside], slope_out[inside] = X[inside], 0.0
        P_out *= self.land


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
    """Gap on Winkler elements that a contact presses: the root of ``G - X - compliance p(G)``, in place from any start.

    p falls and is convex, so that Newton's method gets below the root in one step, never below X, and then rises to it.
    With the pressure there, and its derivative to G over ``scale``.
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
                if abs(change) <= LAST_STEP * reach:
                    break
            p += p_h * change
        gap[k], P[k], slope[k] = g, p, p_h / scale
