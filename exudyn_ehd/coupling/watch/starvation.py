"""Films that run dry: they conserve mass, oil leaves them through the ends, and nothing brings it back.

In a flooded film the cavity's void takes some 0.4 of ``1 - smallest gap / mean gap``, as a share of the film's volume.
What the load squeezes out beyond it costs load: 10 % at a void of 0.55, 0.7 and 0.85 of it (eccentricity ratios 0.3,
0.6 and 0.9), which at a given eccentricity comes within one or two turns, and soon all. Under a given load the journal
sinks.
"""

from __future__ import annotations

import warnings

import numpy as np

from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.static.steady import MORE_OIL
from exudyn_ehd.status import StarvationWarning

# Void of a starved film over ``1 - smallest gap / mean gap``, and the least one that counts: shares of the volume.
STARVED, LEAST = 0.6, 0.1


def lost_share(history: History) -> float:
    """Share of its oil that a starved film has lost; 0 if it is not starved."""
    if history.void is None or history.mass is None:
        return 0.0
    # the ends are full, whatever the film
    void = history.void[:, 1:-1]
    gap = void + history.mass[:, 1:-1]
    lost, smallest = float(np.mean(void) / np.mean(gap)), float(np.min(gap) / np.mean(gap))
    return lost if lost > max(LEAST, STARVED * (1.0 - smallest)) else 0.0


def warn(name: str, time: float, lost: float) -> None:
    """Warn that the film of the joint ``name`` is starved."""
    warnings.warn(
        f"LubricatedJoint '{name}': at t = {time:.9g} s {100.0 * lost:.0f} % of the film's oil has left through the "
        "ends: with ElrodAdams and neither a supply nor ends above the cavity pressure none comes back, and the film "
        f"carries less and less; {MORE_OIL[:-1]}, or SwiftStieber() for a bearing that stays flooded.",
        StarvationWarning,
        stacklevel=2,
    )
