"""A stiff smooth wall that takes over before the gap vanishes.

For a gap h below the onset h0, with s = h / h0:

* contact pressure ``p_w = pressure (1 - s)^2`` (continuous first derivative, still rising for h < 0), and
* the film sees ``h0 g(s)``, ``g = 1 - a tanh((1 - s) / a)``, a = 1 - residual gap
  share: equal to s up to second derivatives at s = 1 and never below ``residual h0``,
  so that the Reynolds equation keeps a solution while surfaces press on each other.

The wall is a regularisation with one stiffness, not a model of asperities, and it has no friction of its own. Where it
acts, the film sees another gap than the one on whose slope its pressure rests. The rest of the slope is the solids',
which the journal meets along its normal, without a torque on it: see Closed gaps in `exudyn_ehd.film.surfaces.drag`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.status import require_number, require_numbers


@dataclass(frozen=True, kw_only=True)
class RegularisedWall:
    """Stiff smooth wall for gaps below an onset.

    A stop for journals that touch now and then: a regularisation, not a model of the surfaces. It does nothing while
    all gaps exceed its onset.

    Parameters
    ----------
    onset : float
        Gap at which the wall starts to act, m; a few roughness heights. Must be below the radial clearance.
    pressure : float
        Contact pressure at zero gap, Pa.
    residual : float
        Share of the onset that the film gap never falls below, 0.01 to 0.9.

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

    def __post_init__(self) -> None:
        require_numbers(self, above=0.0, onset="m", pressure="Pa")
        require_number("RegularisedWall.residual", self.residual, at_least=0.01, at_most=0.9)


class WallContact:
    """A `RegularisedWall` in scaled form: contact pressure and gap limiter of one bearing model.

    Parameters
    ----------
    wall : RegularisedWall
    clearance : float
        Radial clearance, m.
    """

    friction_coefficient = 0.0
    transition_speed = 1.0

    def __init__(self, wall: RegularisedWall, clearance: float) -> None:
        self.onset = self.limits_below = self.presses_below = wall.onset / clearance
        self.residual = wall.residual
        self.level = wall.pressure

    def pressure(self, H: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray) -> None:
        """Contact pressure in Pa and its derivative with respect to the scaled gap H (n, m)."""
        wall_pressure(H, self.onset, self.level, P_out, slope_out)

    def solve_gap(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None:
        """Gap G (n, m) on Winkler elements, with contact pressure and slope there; as `joint.seams.Contact`."""
        solve_wall_gap(X, compliance, scale, self.onset, self.level, G, P_out, slope_out)

    def limit(
        self,
        H: np.ndarray,
        HF: np.ndarray,
        H_t: np.ndarray,
        slope_out: np.ndarray,
        bend_out: np.ndarray,
        face_slope_out: np.ndarray,
    ) -> None:
        """Replace scaled gaps and the rate (n, m) by those that the film sees; as `joint.seams.GapLimiter`."""
        limit_gap(H, HF, H_t, self.onset, self.residual, slope_out, bend_out, face_slope_out)


@njit(cache=True)
def wall_pressure(H, onset, pressure, P_out, slope_out):
    """Contact pressure in the unit of ``pressure`` and its derivative with respect to H."""
    n, m = H.shape
    for i in range(n):
        for j in range(m):
            d = max(1.0 - H[i, j] / onset, 0.0)
            P_out[i, j] = pressure * d * d
            slope_out[i, j] = -2.0 * pressure * d / onset


@njit(cache=True)
def solve_wall_gap(X, compliance, scale, onset, pressure, G_out, P_out, slope_out):
    """Gap on a Winkler element that the wall presses: ``G = X + q (1 - G / onset)^2``,
    q = compliance times pressure, by its larger root.

    With the pressure there, and its derivative to G over ``scale``.
    """
    n, m = X.shape
    q = compliance * pressure / scale
    for i in range(n):
        for j in range(m):
            room = onset - X[i, j]
            if room <= 0.0:
                G_out[i, j] = X[i, j]
                P_out[i, j] = 0.0
                slope_out[i, j] = 0.0
            else:
                # s = 1 - G / onset is the positive root of q s^2 + onset s - room = 0, in the form without cancellation
                s = 2.0 * room / (onset + np.sqrt(onset * onset + 4.0 * q * room))
                G_out[i, j] = onset * (1.0 - s)
                P_out[i, j] = pressure * s * s
                slope_out[i, j] = -2.0 * pressure * s / (onset * scale)


@njit(cache=True)
def limit_gap(H, HF, H_t, onset, residual, slope_out, bend_out, face_slope_out):
    """Replace gaps at vertices and links, and the rate H_t, by those that the film sees, in place.

    First derivatives at both and the second one times the gap's rate come back, all (n, m).
    """
    n, m = H.shape
    a = 1.0 - residual
    for i in range(n):
        for j in range(m):
            slope_out[i, j] = 1.0
            bend_out[i, j] = 0.0
            if H[i, j] < onset:
                t = np.tanh((1.0 - H[i, j] / onset) / a)
                H[i, j] = onset * (1.0 - a * t)
                slope_out[i, j] = 1.0 - t * t
                bend_out[i, j] = 2.0 * t * (1.0 - t * t) / (a * onset) * H_t[i, j]
                H_t[i, j] *= slope_out[i, j]
            face_slope_out[i, j] = 1.0
            if HF[i, j] < onset:
                t = np.tanh((1.0 - HF[i, j] / onset) / a)
                HF[i, j] = onset * (1.0 - a * t)
                face_slope_out[i, j] = 1.0 - t * t
