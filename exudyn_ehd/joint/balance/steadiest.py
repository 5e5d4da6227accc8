"""Several positions that carry one load: which of them a journal keeps."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.joint.balance.newton import Place
from exudyn_ehd.joint.balance.position import INSIDE, LoadSearch
from exudyn_ehd.status import warn_user

# Start on the load's side, where the film is thinnest: eccentricity ratio. Larger ones are nearer to a closed gap.
LOADED = 0.9
# Distance over the clearance up to which two positions are one.
SAME_PLACE = 1e-3
STEADINESS = (
    "has a negative determinant: a journal does not stay there",
    "is not positive definite: the damping decides whether a journal stays",
    "is positive definite",
)


def steadiest(search: LoadSearch, found: Place) -> Place:
    """The position found, or a steadier one that carries the load too; a warning names all that are known.

    A journal stays where the stiffness K is positive definite, and leaves a place where its determinant is
    negative, whatever the damping. Others are looked for from the load's side and from inside: where K is not
    positive definite, and supply areas, tilt or a memory of the oil may give the load several positions.

    Parameters
    ----------
    search : LoadSearch
    found : Place
    """
    b = search.model.bearing
    several = bool(b.supply) or search.model.remembers_mass or bool(np.any(found.motion[2:4]))
    steady = _steadiness(found)
    if search.model.effects.thermal is not None or steady == 2 or (steady == 1 and not several):
        return found
    places = [found]
    for ratio in (LOADED, INSIDE):
        start = search.loaded(found.motion, ratio)
        other = search.attempt(start, found.temperature, search.held_back)
        if other is None:
            continue
        away = min(float(np.hypot(*(other.motion - place.motion)[:2])) for place in places)
        if away > SAME_PLACE * b.radial_clearance:
            places.append(other)
    best = max(places, key=_steadiness)
    if len(places) > 1 or _steadiness(best) == 0:
        ratios = [f"{np.hypot(*place.motion[:2]) / b.radial_clearance:.4f}" for place in places]
        warn_user(
            f"{search.where}: the load is carried at the eccentricity ratios {', '.join(ratios)}; returned is "
            f"{ratios[places.index(best)]}, where the stiffness matrix {STEADINESS[_steadiness(best)]}.",
            UserWarning,
        )
    return search.at(best.motion, best.temperature)


def _steadiness(place: Place) -> int:
    """Index in `STEADINESS` of a place."""
    stiffness = -place.slope
    if np.all(np.linalg.eigvalsh(stiffness + stiffness.T) > 0.0):
        return 2
    return int(np.linalg.det(stiffness) > 0.0)
