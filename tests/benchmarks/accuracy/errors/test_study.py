"""The engine on a quick ladder, against itself and against what is known of the film."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.status import EHDError, InputError
from tests.benchmarks.accuracy import catalogue
from tests.benchmarks.accuracy.errors import ladders
from tests.benchmarks.accuracy.errors.study import Reference, Study, run_study
from tests.benchmarks.accuracy.scenes.setting import QuantityOfInterest, Setting

GRIDS = ((32, 4), (64, 8))
LEVELS = ((48, 4), (96, 8), (192, 16))


def _study(**changes):
    scene = dataclasses.replace(catalogue.steady_scene(0.8), directions=2)
    settings = ladders.film_ladder(grids=GRIDS, aligned=False, reduced=False, classic=(((80, 8), (1e-3, 1e-5)),))
    values = {
        "name": "quick",
        "title": "",
        "scene": scene,
        "settings": settings,
        "quantities": ("load", "attitude"),
        "references": ladders.film_references(short=False, grids=LEVELS),
    }
    return Study(**(values | changes))


@pytest.fixture(scope="module")
def rows():
    return run_study(_study(), repeats=3, progress=None)


def _find(rows, setting, quantity="load"):
    (row,) = (r for r in rows if r.setting == setting and r.quantity == quantity)
    return row


@pytest.mark.slow
def test_errors(rows):
    coarse, fine = _find(rows, "2D 32 x 4"), _find(rows, "2D 64 x 8")
    assert fine.error < 0.5 * coarse.error
    assert fine.reference == "Swift-Stieber"
    assert fine.reference_error < 0.5 * fine.error
    # same model: both errors are one
    assert fine.own_error == fine.error
    # Gümbel lacks 15 % of the load at this eccentricity, however fine its grid
    gumbel = _find(rows, "Gümbel 64 x 8")
    assert gumbel.error == pytest.approx(0.15, abs=0.02)
    assert gumbel.own_error < 0.005


def test_times(rows):
    for row in rows:
        assert 0.0 < row.low <= row.seconds <= row.high
        assert row.setup >= 0.0
        assert row.compile >= 0.0
    assert _find(rows, "2D 64 x 8").seconds > _find(rows, "2D 32 x 4").seconds
    # sweeps of the paper's scheme count as iterations
    assert _find(rows, "SOR 80 x 8, 1e-05 (paper)").newton > _find(rows, "SOR 80 x 8, 1e-03").newton > 5


@pytest.mark.slow
def test_errors_repeat_to_rounding(rows):
    for row, again in zip(rows, run_study(_study(), repeats=1, progress=None), strict=True):
        assert again.setting == row.setting
        assert again.error == pytest.approx(row.error, rel=1e-9, abs=1e-14)
        assert again.value == pytest.approx(row.value, rel=1e-13)


@pytest.mark.slow
def test_in_parallel(rows):
    """A study in two processes finds the errors of one in a single process, and measures no times."""
    study = _study(settings=_study().settings[:2])
    parallel = run_study(study, processes=2, progress=None)
    for row in parallel:
        assert math.isnan(row.seconds)
        assert row.error == pytest.approx(_find(rows, row.setting, row.quantity).error, rel=1e-9, abs=1e-14)


@pytest.mark.slow
def test_a_failing_rung_is_recorded():
    bad = Setting(
        label="touching",
        family="2D",
        model="Swift-Stieber",
        options={"profile": ehd.OutOfRound(order=2, amplitude=2e-5)},
    )
    found = run_study(_study(settings=(bad, _study().settings[0])), repeats=1, progress=None)
    assert "NO_FILM" in _find(found, "touching").failure
    assert math.isnan(_find(found, "touching").error)
    assert _find(found, "2D 32 x 4").failure == ""
    reference = Reference(model="Swift-Stieber", levels=(bad, bad, bad), ratio=2.0)
    with pytest.raises(EHDError, match="reference Swift-Stieber"):
        run_study(_study(references=(reference,)), repeats=1, progress=None)


def test_progress_is_shown():
    lines = []
    run_study(_study(settings=_study().settings[:1]), repeats=1, progress=lines.append)
    assert any("2D 32 x 4" in line for line in lines)
    assert any("reference" in line for line in lines)


def test_refuses():
    setting = _study().settings[0]
    with pytest.raises(InputError, match="unique"):
        _study(settings=(setting, setting))
    with pytest.raises(InputError, match="among"):
        _study(quantities=("colour",))
    with pytest.raises(InputError, match="references"):
        _study(references=())
    with pytest.raises(InputError, match="tilt_ratio"):
        catalogue.steady_scene(0.8, 1.0)


def test_scale_of_a_quantity():
    reference = np.array([4.0, -2.0])
    assert QuantityOfInterest(name="a", unit="").distance(reference + 0.4, reference) == pytest.approx(0.1)
    assert QuantityOfInterest(name="a", unit="", scale=0.1).distance(reference + 0.4, reference) == pytest.approx(4.0)


def test_catalogue_is_complete_and_its_names_fit():
    for studies in (catalogue.full_catalogue(), catalogue.quick_catalogue()):
        for name, make in studies.items():
            study = make()
            assert study.name == name
            models = {r.model for r in study.references}
            assert study.references[0].model in models
