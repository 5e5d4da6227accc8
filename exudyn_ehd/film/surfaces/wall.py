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
from functools import partial
from typing import ClassVar

import numpy as np
from numba import njit

from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter
from exudyn_ehd.status import POSITIVE, Checked, require_number


@dataclass(frozen=True, kw_only=True)
class RegularisedWall(Checked):
    """Contact as a stiff smooth wall for gaps below an onset: a stop, no model of rough surfaces.

    A stop for journals that touch now and then: a regularisation, not a model of the surfaces. It does nothing while
    all gaps exceed its onset.

    Parameters
    ----------
    onset : float
        Gap at which the wall starts to act, m; a few roughness heights. Must be below the radial clearance.
    pressure : float, default 1e9
        Contact pressure at zero gap, Pa.
    residual : float, default 0.2
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
        """Gap ``onset g(s)`` with its derivatives; as `GapLimiter`."""
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
