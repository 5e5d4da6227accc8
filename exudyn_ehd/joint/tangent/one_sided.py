"""One-sided derivatives of the wrench of a film that ruptures as soon as it moves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

# Shares of the clearance. Eccentricity up to which a journal is at the centre: larger than the round-off of a position
# of 1 m in a clearance of 1 um. Eccentricity of the films beside it, by which K and C differ from their limits.
CENTRE, BESIDE = 1e-9, 1e-6
# Share of the wrench, above the square of `BESIDE` and the round-off: larger changes are of first order in the step.
SECOND_ORDER = 10.0 * BESIDE**2
# Largest difference of K or C between a direction and the mean of all, over the mean, up to which that is given; on few
# columns n 2 / n. Bearings that are the same in all directions have at most 0.12 on 17 columns, 0.057 on 31, 0.023 from
# 48 on; an axial groove of 0.3 rad at the cavity pressure over two thirds of the length has 0.16.
LARGEST_SPREAD = 0.05


def quotients(wrench: Callable[[np.ndarray], np.ndarray], motion: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """One-sided derivatives (2, 6, n) of a wrench to the entries of a motion (n,) with a step, from above and below.

    Steps are `BESIDE` of what changes the wrench as a whole: changes of second order are omitted.
    """
    out, middle = np.zeros((2, 6, motion.size)), wrench(motion)
    least = SECOND_ORDER * np.abs(middle).max()
    for k in np.flatnonzero(steps):
        for side, step in zip(out, (steps[k], -steps[k]), strict=True):
            change = wrench(motion + step * np.eye(motion.size)[k]) - middle
            side[:, k] = np.where(np.abs(change) > least, change, 0.0) / step
    return out
