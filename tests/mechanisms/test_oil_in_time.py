"""Errors of runs by the columns of the grid where oil moves through cavities: random journals under loads that turn."""

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.mechanisms.test_heat_in_time import PERIODS, run, scenes

STEPS = 720
FED = {"cavitation": ehd.ElrodAdams(), "supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5),)}
DRAWN_IN = {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)}


@pytest.mark.slow
@pytest.mark.parametrize("k", range(5))
def test_errors_by_columns(measured, k):
    """Orbits on 64, 96 and 192 columns against 384: of the film thickness, 4, 2.1 and 1 % at most."""
    bearing, *rest = list(scenes(5))[k]
    oil = ehd.Lubricant(viscosity=bearing.lubricant.temperature_law.point[1])
    options = FED if k % 2 else DRAWN_IN

    def found(columns):
        film = ehd.FiniteLength(n_theta=columns, n_z=6)
        history, period = run(
            dataclasses.replace(bearing, lubricant=oil, thermal=None, film=film, **options), *rest, STEPS
        )
        late = history.time > (PERIODS - 1) * period
        return history.motion[late, :2], history.minimum_gap[late]

    reference, gap = found(384)
    for columns, limit in ((64, 0.04), (96, 0.021), (192, 0.01)):
        misses = np.hypot(*(found(columns)[0] - reference).T) / gap
        measured(f"{columns} columns", misses.max(), limit)
