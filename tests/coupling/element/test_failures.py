"""Accepted steps whose film no material bears: warned of by name, time and remedy, and ended where they are absurd."""

import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.coupling.contract import Trial
from exudyn_ehd.coupling.element.failures import ABSURD, HIGHEST_MEAN, HIGHEST_PEAK, Failures
from exudyn_ehd.coupling.record.history import FORCE, PEAK_PRESSURE, make_row

BEARING = ehd.JournalBearing(
    journal_radius=0.025,
    length=0.025,
    radial_clearance=25e-6,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)
AREA = 2.0 * BEARING.journal_radius * BEARING.length


@pytest.mark.parametrize(
    ("peak", "mean", "share"),
    [
        (0.9 * HIGHEST_PEAK, 0.5 * HIGHEST_MEAN, 0.9),
        (1.1 * HIGHEST_PEAK, 0.0, 1.1),
        # films whose peak is unknown
        (np.nan, 2.0 * HIGHEST_MEAN, 2.0),
        (1.0, 2.0 * ABSURD * HIGHEST_MEAN, 2.0 * ABSURD),
        (1.1 * ABSURD * HIGHEST_PEAK, 0.0, 1.1 * ABSURD),
    ],
)
def test_pressures_over_what_a_material_bears(peak, mean, share):
    row = make_row(0.5, np.zeros(10), (0.0, 0.0), np.zeros(6), {})
    row[PEAK_PRESSURE], row[FORCE] = peak, (0.6 * mean * AREA, 0.0, 0.8 * mean * AREA)
    trial = Trial([], [], None, 0.0, None, np.zeros(10), np.zeros(10), None)
    failures = Failures("big end", BEARING)
    text = failures.overloaded(0.5, row, trial.motion)
    assert failures.overload(row) == pytest.approx(share)
    for part in ("'big end' at t = 0.5 s", "neither oil nor steel", "ConfigureSolver", "initial velocities"):
        assert part in text
    assert (failures.absurd(0.5, row, trial) is not None) == (peak > ABSURD * HIGHEST_PEAK)


def thrown(load):
    mbs, joint = scenes.loaded_journal(BEARING, [0.0, -load, 0.0])
    mbs.Assemble()
    return mbs, joint, ehd.ConfigureSolver(scenes.settings(0.02, 100))


def test_a_journal_thrown_into_its_film_warns_once():
    mbs, joint, settings = thrown(1e7)
    with pytest.warns(ehd.OverloadWarning) as told, pytest.raises(ehd.FilmError):
        ehd.SolveDynamic(mbs, settings)
    (text,) = [str(w.message) for w in told if w.category is ehd.OverloadWarning]
    history = joint.history
    peak = history.peak_pressure
    hard = (peak > HIGHEST_PEAK) | (np.linalg.norm(history.force, axis=1) > HIGHEST_MEAN * AREA)
    assert float(text.split("t = ")[1].split(" s:")[0]) == pytest.approx(history.time[hard][0])


@pytest.mark.parametrize("own", [True, False], ids=["ehd", "Exudyn"])
def test_an_absurd_film_ends_the_run_and_can_be_read(own):
    mbs, joint, settings = thrown(1e10)
    with pytest.raises(Exception, match=r"'bearing' at t = .*neither oil nor steel bears: peak pressure"):
        (ehd.SolveDynamic if own else type(mbs).SolveDynamic)(mbs, settings)
    history = joint.history
    assert history.peak_pressure[-1] > ABSURD * HIGHEST_PEAK
    assert np.all(history.peak_pressure[:-1] <= ABSURD * HIGHEST_PEAK)
    assert np.all(np.isfinite(history.force))
