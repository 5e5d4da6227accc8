"""Loads that neither oil nor steel bears."""

from __future__ import annotations

import math

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.status import FilmError, OverloadWarning, warn_user

# Pressures at the peak and on the projected area, Pa; films of real machines stay below a third of them.
HIGHEST_PEAK, HIGHEST_MEAN = 3e9, 1e9
# Depth in a rigid bore that no contact explains, over the clearance.
DEEPEST = 1.0
PRESSED_THROUGH = "the journal was pressed through its contact by more than the clearance"


def mean_pressure(bearing: JournalBearing, force: float) -> float:
    """Force, N, on the projected area, Pa."""
    return force / (2.0 * bearing.journal_radius * bearing.length)


def warn_of_overload(bearing: JournalBearing, peak: float, force: float, where: str) -> None:
    """Warn in the name of ``where`` of a film with a peak pressure, Pa, or a force, N, that no material bears."""
    mean = mean_pressure(bearing, force)
    # films without a peak have nan
    if not peak > HIGHEST_PEAK and not mean > HIGHEST_MEAN:
        return
    warn_user(
        f"{where}: the film has a peak pressure of {peak:.3g} Pa, and with its contact {mean:.3g} Pa on the projected "
        f"area; neither oil nor steel bears {HIGHEST_PEAK:.3g} or {HIGHEST_MEAN:.3g} Pa there: surfaces this close "
        "touch or give way; look at the units of viscosity, speed and clearance, take a smaller eccentricity or load, "
        "or give the bearing a contact (GreenwoodTripp, RegularisedWall) or a bush that deflects.",
        OverloadWarning,
    )


def refuse_pressed_through(bearing: JournalBearing, gap: float, where: str) -> None:
    """Refuse in the name of ``where`` a journal so deep in a rigid bore, ``gap`` in m, that no contact explains it."""
    if getattr(bearing, "yielding", None) is None and math.isfinite(gap) and gap < -DEEPEST * bearing.radial_clearance:
        raise FilmError(
            f"{where}: {PRESSED_THROUGH}, minimum film thickness {gap:.3g} m; check load, eccentricity and units, or "
            "give the contact more stiffness (RegularisedWall.pressure)."
        )
