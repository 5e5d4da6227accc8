"""Initial velocities that do not fit the joints: journals that are thrown across their bores at the start of a run.

An ideal joint leaves a body one velocity. A film takes any, and stops what does not fit within the clearance, with
forces that nobody meant. Exudyn does not make initial velocities consistent.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.kinematics.relative import levers_of
from exudyn_ehd.status import PlausibilityWarning, warn_user

# Steps in which a journal crosses the clearance. Below the first nothing of the impact is resolved; below the second it
# is hardly, which is told of a journal that moves faster than the third times clearance x spin, a hundred times as fast
# as it orbits. Larger numbers of steps, and a smaller ratio, tell of more runs.
LEAST_STEPS, FEW_STEPS, FASTER = 1.0, 10.0, 100.0


def warn_of_misfit(states: Iterable[tuple[str, np.ndarray, JournalBearing]], step: float) -> None:
    """Warn of journals that cross their bores at the start of a run with steps of ``step`` s.

    ``states``: names of the joints, their motions (10,) there, and their bearings.
    """
    told: list[tuple[float, str]] = []
    for name, motion, bearing in states:
        c, speed = bearing.radial_clearance, float(np.linalg.norm(levers_of(bearing) * motion[4:8]))
        spin = float(np.linalg.norm(motion[8 : 9 if isinstance(bearing, JournalBearing) else None]))
        thrown = step * speed * FEW_STEPS > c and speed > FASTER * c * spin > 0.0
        if thrown or step * speed * LEAST_STEPS > c:
            told.append((speed, f"{speed:.3g} m/s in LubricatedJoint '{name}' (clearance {c:.3g} m)"))
    if told:
        warn_user(
            "SolveDynamic: the initial velocities do not fit the joints; journals move across their bores by "
            f"{', '.join(text for _, text in sorted(told, reverse=True))}, and their films stop them within the "
            "clearance: forces and pressures of the start are those of an impact. Give every body the velocities of "
            "the mechanism (that of its centre of mass is the joint's plus angular velocity x distance); for an impact "
            "that is meant take steps of a tenth of clearance / velocity or less.",
            PlausibilityWarning,
        )
