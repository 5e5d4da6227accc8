"""Films thinner than the surfaces are rough, where the bearing says nothing about rough surfaces or contact."""

from __future__ import annotations

import math
import warnings

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.status import ThinFilmWarning

# Roughness of a good surface, m; surfaces of the smallest bearings are as much finer as these are smaller.
GOOD_SURFACE, CLEARANCE_SHARE = 0.2e-6, 0.05


def limit(bearing: JournalBearing) -> float:
    """Minimum film thickness below which a smooth film is none, m; -inf where the bearing models what touches."""
    if any(getattr(bearing, name, None) is not None for name in ("asperity", "contact")):
        return -math.inf
    return min(GOOD_SURFACE, CLEARANCE_SHARE * bearing.radial_clearance)


def warn(name: str, time: float, gap: float) -> None:
    """Warn that the film of the joint ``name`` is thinner than its surfaces are rough."""
    warnings.warn(
        f"LubricatedJoint '{name}': at t = {time:.9g} s the minimum film thickness is {1e6 * gap:.3g} um, less than "
        "the roughness of a good surface: real surfaces touch there, and pressure, friction and film are those of "
        "perfectly smooth ones; give the bearing asperity=GreenwoodTripp(...) and roughness=PatirCheng(...), "
        "contact=RegularisedWall(onset=...) if surfaces only just touch, or check load, clearance and viscosity.",
        ThinFilmWarning,
        stacklevel=2,
    )
