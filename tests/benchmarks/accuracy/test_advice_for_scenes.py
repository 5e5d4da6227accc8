"""Advice for measured scenes rests on their own tables, and holds in their own runs."""

import dataclasses

import pytest

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError
from exudyn_ehd.studies.film_errors import SCALES
from tests.benchmarks.accuracy.advice_for_scenes import advice_for_scene
from tests.benchmarks.accuracy.scenes import measured
from tests.benchmarks.accuracy.scenes.setting import Integration, Setting
from tests.benchmarks.accuracy.scenes.steady import QUANTITIES


def test_recommend_knows_the_quantities_of_steady_scenes():
    assert {q.name: q.scale for q in QUANTITIES} == dict(SCALES)


def _values(scene, quantity, options, **integration):
    """Value of a quantity with some options, and the quantity."""
    setting = Setting(label="", family="", model="", options=options, integration=Integration(**integration))
    (known,) = (q for q in scene.quantities if q.name == quantity)
    return known, scene.prepare(setting)().values[quantity]


@pytest.mark.slow
def test_steady_scene():
    scene = measured.steady_scene(0.8)
    advice = advice_for_scene(scene, 0.01, "peak pressure")
    assert advice.found
    assert "steady_800_film" in advice.evidence[0]
    quantity, value = _values(scene, "peak pressure", advice.options)
    fine = _values(scene, "peak pressure", {"film": ehd.FiniteLength(n_theta=256, n_z=24)})[1]
    assert quantity.distance(value, fine) < 0.01
    # another eccentricity has no table of its own
    near = dataclasses.replace(scene, eccentricity_ratio=0.7)
    assert "eps 0.7" in advice_for_scene(near, 0.01, "load").evidence[0]
    with pytest.raises(InputError, match="one of the scene's"):
        advice_for_scene(scene, 0.01, "colour")


@pytest.mark.slow
def test_moving_scene():
    """Film and steps from their own tables; the run with both keeps the error."""
    scene = measured.step_load_orbit()
    advice = advice_for_scene(scene, 0.01, "path")
    assert advice.found
    assert len(advice.evidence) == 2
    quantity, value = _values(scene, "path", advice.options, **dataclasses.asdict(advice.integration))
    fine = _values(scene, "path", {"film": ehd.FiniteLength(n_theta=128, n_z=12)}, steps=1200)[1]
    assert quantity.distance(value, fine) < 0.01
    other = dataclasses.replace(scene, name="mine")
    assert "none of the measured scenes" in advice_for_scene(other, 0.01, "path").reason
