"""Exudyn's own models on films: their ideal joints in the limit of no clearance, and their energy."""

import pytest

from tests.mechanisms.exudyn_models import TABLE, distance, energy_error, outcomes


@pytest.mark.slow
@pytest.mark.parametrize("name", TABLE)
def test_model_on_films(name, measured):
    """Places and loads go to those of ideal joints with the clearance, at a constant Sommerfeld number.

    What remains at the end of a run is proportional to the clearance: half of it halves the distance, to 10 %, which
    hold what the steps in time leave. Energy is what the films have taken to 1 % of it.
    """
    case = TABLE[name]
    ideal, coarse, fine, real = outcomes(case)
    far, near = distance(coarse, ideal), distance(fine, ideal)
    measured("place", abs(near[0] / far[0] - 0.5), 0.05)
    if case.determinate:
        measured("load", abs(near[1] / far[1] - 0.5), 0.05)
    assert far[0] > 0.0 and coarse.eccentricity > 0.04
    assert fine.steps <= 1.05 * case.steps
    measured("energy", energy_error(real, ideal), 0.01)
    assert real.iterations < 4 * case.steps
