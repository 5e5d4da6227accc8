"""Changes by another description of a ball: films that carry the same load at the same velocities."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import cast

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.peak import refined_peak
from exudyn_ehd.joint.audit.changes import MOST_STEPS, NO_LOAD, STARTS, TOLERANCE, Change
from exudyn_ehd.joint.audit.switches import Switch
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.spherical.model import PLACE, SPIN, VELOCITY, SphericalEvaluation, SphericalModel
from exudyn_ehd.status import Status

# Largest step towards the same load, as a share of the minimum film thickness.
STRIDE = 0.3


class BallComparison:
    """Films of a ball at some motions, to compare other descriptions with; as those of journals.

    Parameters
    ----------
    model : SphericalModel
    motions : sequence of (11,) arrays
    """

    def __init__(self, model: SphericalModel, motions: Sequence[np.ndarray]) -> None:
        self.model, self.motions = model, motions

    def change(self, switch: Switch) -> Change | None:
        """Worst change by a switch; None where no film could be compared."""
        bearing = cast(SphericalBearing, switch(cast(JournalBearing, self.model.bearing)))
        other = SphericalModel(bearing)
        changes = [change for motion in self.motions if (change := self._at(other, motion)) is not None]
        return max(changes, key=lambda change: change.size, default=None)

    def _at(self, other: SphericalModel, motion: np.ndarray) -> Change | None:
        mine = self.model.evaluate(motion)
        b, force = self.model.bearing, mine.wrench[:3].copy()
        rates = float(np.linalg.norm(motion[SPIN]) + np.linalg.norm(motion[VELOCITY]) / b.radial_clearance)
        load = float(np.linalg.norm(force))
        if mine.film is None or not load > NO_LOAD * self.model.force_scale * rates:
            return None
        here = other.evaluate(motion)
        share = math.nan if here.film is None else float(np.linalg.norm(here.wrench[:3])) / load - 1.0
        found = _same_load(other, motion, force)
        if found is None:
            return Change(load=share, minimum_gap=math.nan, peak_pressure=math.nan, power_loss=math.nan)
        pairs = zip(_numbers(other, found), _numbers(self.model, mine), strict=True)
        gap, peak, loss = (new / old - 1.0 if old > 0.0 else 0.0 for new, old in pairs)
        return Change(load=share, minimum_gap=gap, peak_pressure=peak, power_loss=loss)


def _numbers(model: SphericalModel, found: SphericalEvaluation) -> tuple[float, float, float]:
    """Minimum film thickness, m, refined peak pressure, Pa, and loss, W."""
    assert found.film is not None
    grid = model.grid
    peak = refined_peak(found.film.pressure, grid.fixed, grid.x, model.patch.chi, True)[0]
    return found.minimum_gap, peak, found.quantities()["power_loss"]


def _same_load(model: SphericalModel, motion: np.ndarray, force: np.ndarray) -> SphericalEvaluation | None:
    """The film with this force, by Newton's method for the ball's place; None if it is not found."""
    limit, least = TOLERANCE * float(np.linalg.norm(force)), TOLERANCE * model.bearing.radial_clearance
    for start in STARTS:
        place, found = motion[PLACE] * start, None
        step, error = np.zeros(3), math.inf
        for _ in range(2 * MOST_STEPS):
            trial = motion.copy()
            trial[PLACE] = place + step
            new = model.evaluate(trial)
            left = force - new.wrench[:3]
            size = float(np.linalg.norm(left))
            if new.status is not Status.CONVERGED or size > error:
                if found is None or np.linalg.norm(step) < least * TOLERANCE:
                    break
                step = 0.5 * step
                continue
            place, found, error = trial[PLACE], new, size
            if error <= limit:
                return found
            step, *_ = np.linalg.lstsq(found.tangent()[:3, PLACE], left, rcond=1e-9)
            step *= min(1.0, STRIDE * max(found.minimum_gap, least) / max(float(np.linalg.norm(step)), 1e-300))
    return None
