"""Accepted steps whose film no material bears: warned of by name, time and remedy, and ended where they are absurd."""

from types import SimpleNamespace

import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.coupling.contract import Trial
from exudyn_ehd.coupling.element.failures import HIGHEST_MEAN, Failures
from exudyn_ehd.coupling.record.history import FORCE, PEAK_PRESSURE, make_row
from exudyn_ehd.joint.audit.resolution import RingingWatch
from exudyn_ehd.joint.balance.limits import HIGHEST_PEAK, HOT, HOTTEST
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.solved_film import History

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
        (np.nan, 1.1 * HIGHEST_PEAK, 1.1 * HIGHEST_PEAK / HIGHEST_MEAN),
        (1.0, 1.1 * HIGHEST_PEAK, 1.1 * HIGHEST_PEAK / HIGHEST_MEAN),
    ],
)
def test_pressures_over_what_a_material_bears(peak, mean, share):
    row = make_row(0.5, np.zeros(10), (0.0, 0.0), np.zeros(6), {})
    row[PEAK_PRESSURE], row[FORCE] = peak, (0.6 * mean * AREA, 0.0, 0.8 * mean * AREA)
    trial = Trial([], [], None, 0.0, None, np.zeros(10), np.zeros(10))
    failures = Failures("big end", BEARING)
    text = failures.overloaded(0.5, row, trial.motion)
    assert failures.overload(row) == pytest.approx(share)
    for part in ("'big end' at t = 0.5 s", "neither oil nor steel", "ConfigureSolver", "initial velocities"):
        assert part in text
    assert (failures.absurd(0.5, row, trial) is not None) == (max(mean, peak) > HIGHEST_PEAK)
    failures.largest_pressure = 1.2 * HIGHEST_PEAK
    assert failures.absurd(0.5, row, trial) is None


def test_tilt_is_the_first_advice_where_the_journal_touches_by_it():
    """And none where it is eccentric, or where its ends are far from the bore, in every message of a place."""
    rng = np.random.default_rng(2)
    failures, c, half = Failures("big end", BEARING), BEARING.radial_clearance, 0.5 * BEARING.length
    row = make_row(0.5, np.zeros(10), (0.0, 0.0), np.zeros(6), {})
    row[PEAK_PRESSURE] = 1.1 * HIGHEST_PEAK
    for _ in range(100):
        (mid, tilt), (a, b), motion = rng.uniform(0.0, 1.2, 2), rng.uniform(0.0, 6.3, 2), np.zeros(10)
        motion[:4] = (
            *(c * mid * np.array([np.cos(a), np.sin(a)])),
            *(c / half * tilt * np.array([np.cos(b), np.sin(b)])),
        )
        largest = max(np.hypot(*(motion[:2] + s * half * motion[2:4])) for s in (-1.0, 1.0)) / c
        tilts = largest > 2.0 * mid and largest > 0.8
        trial = Trial([], [], None, 0.0, None, motion, motion)
        trial.status = ehd.Status.NO_FILM
        for text in (failures.overloaded(0.5, row, motion), str(failures.no_film(0.5, trial, explicit=False))):
            assert ("tilt=ehd.Held()" in text) == tilts
            if tilts:
                others = [
                    text.find(part) for part in ("contact=", "ehd.SolveDynamic", "check masses", "reduce the load")
                ]
                assert text.find("tilt=ehd.Held()") < min(place for place in others if place >= 0)


def test_films_that_oil_does_not_bear_are_told_once_and_end_the_run_where_there_is_no_oil():
    film = SimpleNamespace(grid=build_model(BEARING).grid)
    trial = Trial([], [], None, 0.0, None, np.zeros(10), np.zeros(10))
    trial.take(SimpleNamespace(status=ehd.Status.CONVERGED, film=film))
    failures, field = Failures("big end", BEARING), np.full(film.grid.shape, 400.0)
    assert failures.check_heat(0.5, trial, None, HOT) == failures.check_heat(0.5, trial, History(None), HOT) == HOT
    assert failures.check_heat(0.5, trial, History(temperature=field), HOT) == HOT
    field[7, 2] = HOT + 1.0
    place = rf"'big end' at t = 0.5 s: .* K at theta = {film.grid.x[7]:.3g} rad"
    with pytest.warns(ehd.HotFilmWarning, match=place):
        limit = failures.check_heat(0.5, trial, History(temperature=field), HOT)
    # told once
    assert failures.check_heat(0.5, trial, History(temperature=field), limit) == limit
    field[7, 2] = HOTTEST + 1.0
    for now in (HOT, limit):
        with pytest.raises(ehd.FilmError, match=place + ".*no oil is a liquid above 700 K"):
            failures.check_heat(0.5, trial, History(temperature=field), now)


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
    assert history.peak_pressure[-1] > HIGHEST_PEAK
    assert np.all(history.peak_pressure[:-1] <= HIGHEST_PEAK)
    if own:
        # smaller steps were tried first
        assert np.diff(history.time).min() < 1e-4 * settings.timeIntegration.endTime / 100
        assert mbs.GetPostNewtonUserFunction() == 0
    assert np.all(np.isfinite(history.force))


def run_of_forces(force):
    """A watch that has seen forces (n,), shares of 10 MPa on the projected area, in a fixed direction."""
    watch = RingingWatch(AREA)
    for k, share in enumerate(force):
        watch.take(1e-4 * k, 0.6e7 * AREA * share, -0.8e7 * AREA * share)
    return watch


STEPS = np.arange(400)


@pytest.mark.parametrize(
    ("force", "throws"),
    [
        (0.1 + (-1.0) ** STEPS, True),
        # a force whose mean is half of it, and one that no bearing minds
        (1.0 + 0.5 * (-1.0) ** STEPS, False),
        (0.05 * (-1.0) ** STEPS, False),
        # three steps per period; impacts in single steps; an alternation that fades
        (0.1 + np.cos(2.0 * np.pi / 3.0 * STEPS), False),
        (0.02 + 1.0 * (STEPS % 7 == 0), False),
        (0.02 + (-0.9) ** STEPS, False),
    ],
)
def test_forces_out_of_all_proportion_to_what_they_move(force, throws):
    watch = run_of_forces(force)
    assert watch.throws == throws
    if throws:
        assert watch.worst == pytest.approx((1.1e7 * AREA, 0.1e7 * AREA))


def test_a_run_that_throws_its_film_ends():
    """A pin shaken to and fro from step to step, as by an integration that rings; at a tenth of the force it may."""
    step, count = 1e-4, 120
    for size, ends in ((6e3, True), (0.6e3, False)):
        mbs, _ = scenes.loaded_journal(BEARING, [0.0, 0.0, 0.0])
        body = mbs.GetObject(mbs.GetMarker(0)["bodyNumber"])["nodeNumber"]
        marker = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=body))
        mbs.AddLoad(
            eii.LoadForceVector(
                markerNumber=marker,
                loadVectorUserFunction=lambda mbs, t, load, size=size: [
                    0.0,
                    size * (0.05 + (-1) ** round(t / step)),
                    0.0,
                ],
            )
        )
        mbs.Assemble()
        settings = ehd.ConfigureSolver(scenes.settings(count * step, count))
        settings.timeIntegration.adaptiveStep = False
        with pytest.warns(ehd.RingingWarning):
            if ends:
                with pytest.raises(
                    ehd.FilmError, match=r"'bearing' at t = .* out of all proportion .* spectral radius"
                ):
                    ehd.SolveDynamic(mbs, settings)
            else:
                ehd.SolveDynamic(mbs, settings)


def test_limits_of_the_user_end_a_run():
    mbs, joint, settings = thrown(1e3)
    ehd.SolveDynamic(mbs, settings)
    free = joint.history
    force, peak = np.linalg.norm(free.force, axis=1), free.peak_pressure
    for limit, values in (("force", force), ("pressure", peak)):
        mbs, joint, settings = thrown(1e3)
        joint.stop_at(**{limit: 0.5 * values.max()})
        with pytest.raises(ehd.FilmError, match=rf"'bearing' at t = .* beyond the limits of joint.stop_at\(.*{limit}="):
            ehd.SolveDynamic(mbs, settings)
        ended = joint.history
        first = int(np.flatnonzero(values > 0.5 * values.max())[0])
        np.testing.assert_array_equal(ended.force, free.force[: len(ended.time)])
        assert ended.time[-1] == free.time[first]
    with pytest.raises(ehd.InputError, match=r"stop_at\.force"):
        joint.stop_at(force=-1.0)
