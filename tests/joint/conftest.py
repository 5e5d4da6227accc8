"""Motions for the tests of the bearing model."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import exudyn_ehd as ehd

SPEED = 100.0
# bearings shared by tests are a plain module next to them; importlib mode puts no test folder on the path
sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def make_motion() -> Callable[..., np.ndarray]:
    """Motion of a bearing from dimensionless numbers.

    ``eccentricity``, ``velocity`` over c and c omega; ``tilt``, ``tilt_rate`` as the eccentricity that they make at
    the end of the bearing, over c and c omega; ``speed`` over 100 rad/s; ``axial`` over R omega.
    """

    def make(
        bearing: ehd.JournalBearing,
        eccentricity=(0.0, 0.0),
        tilt=(0.0, 0.0),
        velocity=(0.0, 0.0),
        tilt_rate=(0.0, 0.0),
        speed: float = 1.0,
        axial: float = 0.0,
    ) -> np.ndarray:
        c, slope = bearing.radial_clearance, 2.0 * bearing.radial_clearance / bearing.length
        return np.concatenate(
            (
                c * np.array(eccentricity),
                slope * np.array(tilt),
                c * SPEED * np.array(velocity),
                slope * SPEED * np.array(tilt_rate),
                [speed * SPEED, axial * bearing.journal_radius * SPEED],
            )
        )

    return make


@pytest.fixture(scope="session")
def motion_scale(make_motion) -> Callable[[ehd.JournalBearing], np.ndarray]:
    """Natural unit of every component of the motion."""

    def scale(bearing: ehd.JournalBearing) -> np.ndarray:
        one = (1.0, 1.0)
        return make_motion(bearing, one, one, one, one, 1.0, 1.0)

    return scale
