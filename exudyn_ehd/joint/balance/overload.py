"""Pressures that neither oil nor steel bears."""

from __future__ import annotations

from exudyn_ehd.status import OverloadWarning, warn_user

# Pa; films of real machines stay below a third of it.
HIGHEST_PEAK = 3e9


def warn_of_overload(peak: float, where: str) -> bool:
    """Warn in the name of ``where`` of a film whose peak pressure, Pa, no material bears; whether it is one."""
    if peak <= HIGHEST_PEAK:
        return False
    warn_user(
        f"{where}: the film has a peak pressure of {peak:.3g} Pa, and neither oil nor steel bears {HIGHEST_PEAK:.3g} "
        "Pa: surfaces this close touch or give way; look at the units of viscosity, speed and clearance, take a "
        "smaller eccentricity or load, or give the bearing a contact (GreenwoodTripp, RegularisedWall) or a bush that "
        "deflects.",
        OverloadWarning,
    )
    return True
