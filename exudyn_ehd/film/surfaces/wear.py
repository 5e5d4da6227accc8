"""Wear of the bore after Archard: what asperities rub off deepens the gap.

``dh/dt = k p v`` with the asperity contact's pressure p, the sliding speed v and the specific wear rate k in m2/N (k =
K / H with Archard's dimensionless K and the softer surface's hardness H). Source: J. F. Archard, J. Applied Physics 24
(1953) 981.

The depth belongs to the accepted history: a step sees the depth at its start, and its own wear is added at its end with
the pressure and speed found there (explicit in the gap, first order in the step; wear per step is a tiny share of the
roughness).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, Checked


@dataclass(frozen=True, kw_only=True)
class ArchardWear(Checked):
    """Wear of the bore by its asperity contact; needs ``asperity=GreenwoodTripp(...)``.

    The depth is worn off over the accepted steps.

    Parameters
    ----------
    wear_rate : float
        Specific wear rate k, m2/N; 1e-18 to 1e-14 from well lubricated to dry.
    acceleration : float, default 1.0
        Factor on the wear per time: 1e6 lets a second stand for twelve days of the same motion. The depth stays an
        estimate as long as it changes by much less than the roughness per period of the load.

    The worn volume is k times the integral of contact pressure and sliding distance over the surface. ``contact_load``
    is the vector sum of that pressure: k times contact_load times distance is 3 % below the worn volume of a contact
    over 0.8 rad. A joint shows the largest depth as ``history.wear_depth``, the volume as ``history.worn_volume``, and
    the depth on its bore by ``plot_wear_depth()``.

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
        """Depth, m, that contact pressures, Pa, wear off in a step, s, at a sliding speed, m/s."""
        depth: np.ndarray = pressure * (self.wear_rate * self.acceleration * step * speed)
        return depth
