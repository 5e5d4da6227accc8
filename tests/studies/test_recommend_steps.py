"""`recommend_steps`: what it says of a bearing alone holds for it, and in the mechanism that its load comes from."""

import math

import exudyn as exu
import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.studies import steps as tried
from tests.benchmarks.accuracy.scenes import measured


def _bearing(**options):
    values = {
        "journal_radius": 0.025,
        "length": 0.025,
        "radial_clearance": 25e-6,
        "lubricant": ehd.Lubricant(viscosity=0.02),
        "film": ehd.FiniteLength(n_theta=48, n_z=6),
    }
    return ehd.JournalBearing(**(values | options))


def _cycle(rng, size):
    """A load of a mean and three harmonics."""
    turn = np.linspace(0.0, 2.0 * math.pi, 48, endpoint=False)
    parts = [1.0, 1.0, 0.5, 0.3]
    waves = [a * rng.normal(size=2) * np.cos(k * turn + rng.uniform(0.0, 6.0))[:, None] for k, a in enumerate(parts)]
    return size * sum(waves)


def test_loads_stay_between_their_rows():
    """Loads that come and go at once are not exceeded; cubic splines went 13 % beyond. Periodic, with its slope."""
    rng = np.random.default_rng(1)
    load = 1e4 * rng.integers(0, 2, (24, 2))
    force, t = tried._two_periods(load, 0.02), np.linspace(0.0, 0.02, 2001)
    # round-off of the cubics' powers
    assert force(t).min() >= -1e-8 and force(t).max() <= 1e4 + 1e-8
    assert force(0.02 + t[1:]) == pytest.approx(force(t[1:]), abs=1e-6)
    wave = np.cos(2.0 * math.pi * (np.arange(24) + 0.5) / 24)[:, None]
    # a peak between two rows is flattened to their value
    error = tried._two_periods(wave, 0.02)(t)[:, 0] - np.cos(2.0 * math.pi * (t / 0.02 + 0.5 / 24))
    assert np.abs(error).max() < 1.01 * (1.0 - math.cos(math.pi / 24))


def _true_error(bearing, steps, speed, period, load, mass):
    motion = tried._two_periods(np.broadcast_to(speed, len(load)), period)
    force = tried._two_periods(load, period)
    coarse, fine = (tried._second_period(bearing, n, period, motion, force, mass) for n in (steps, 4 * steps))
    floor = max(fine.min(), tried.CLOSED * bearing.radial_clearance)
    return np.abs(coarse - fine[::4]).max() / floor


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_random_cycles():
    """Four cycles of load: a bound for all of them, and seldom a loose one."""
    ratios = []
    for seed in range(4):
        rng = np.random.default_rng([seed, 4])
        groove = ehd.AxialGroove(angle=float(rng.uniform(0.0, 6.0)), width_angle=0.4, pressure=2e5)
        options = {"cavitation": ehd.ElrodAdams(), "supply": (groove,)} if rng.random() < 0.3 else {}
        speed, period = float(rng.choice([100.0, 300.0, -300.0])), float(rng.choice([0.01, 0.03]))
        load, mass = _cycle(rng, 10.0 ** rng.uniform(2.0, 4.0)), float(rng.choice([0.3, 3.0]))
        bearing, error = _bearing(**options), float(rng.choice([0.05, 0.02, 0.01]))
        advice = ehd.recommend_steps(bearing, error, speed=speed, period=period, load=load, mass=mass)
        assert advice.found, advice.reason
        assert advice.error <= error
        true = _true_error(bearing, advice.steps, speed, period, load, mass)
        assert true <= advice.error
        ratios.append(advice.error / true)
    assert np.median(ratios) <= 5.0


def _last_turn(scene, steps, turns=2):
    """Minimum film thickness, force and spin over the last turn of the crank, at its ``steps`` steps."""
    mbs, joint = scene.build(scene.bearing)
    period = 2.0 * math.pi / scene.build.keywords["spin"]
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = turns * period, turns * steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    h, grid = joint.history, (turns - 1) * period + period * np.arange(steps + 1) / steps
    columns = np.column_stack([h.minimum_gap, h.force[:, :2], h.motion[:, 8]])
    return period, np.column_stack([np.interp(grid, h.time, column) for column in columns.T])


@pytest.mark.slow
@pytest.mark.parametrize(("make", "mass"), [(measured.slider_pin, 0.14), (measured.big_end, 0.55)])
def test_in_a_mechanism(make, mass):
    """Load and spin of a run with 360 steps; the mechanism itself keeps the error with the steps that are named."""
    scene = make()
    period, known = _last_turn(scene, 360)
    cycle = known[:-1:4]
    advice = ehd.recommend_steps(scene.bearing, 0.02, speed=cycle[:, 3], period=period, load=-cycle[:, 1:3], mass=mass)
    coarse, fine = _last_turn(scene, advice.steps)[1][:, 0], _last_turn(scene, 4 * advice.steps)[1][:, 0]
    assert np.abs(coarse - fine[::4]).max() <= 0.02 * fine.min()


@pytest.mark.slow
def test_fewer_steps_for_less(monkeypatch):
    turn = np.linspace(0.0, 2.0 * math.pi, 24, endpoint=False)
    load = 6000.0 * np.column_stack([np.sin(turn), -1.2 + np.cos(turn)])
    options = {"speed": 300.0, "period": 0.02, "load": load, "mass": 1.0}
    rough, close = (ehd.recommend_steps(_bearing(), error, **options) for error in (0.1, 0.001))
    assert rough.steps < close.steps
    assert "steps a period" in str(close)
    monkeypatch.setattr(tried, "LEVELS", 4)
    none = ehd.recommend_steps(_bearing(), 1e-9, **options)
    assert not none.found
    assert "no number of steps" in none.reason


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"load": np.zeros((4, 2))}, "load"),
        ({"load": np.full((8, 2), np.nan)}, "load"),
        ({"speed": np.zeros(3)}, "speed"),
        ({"period": 0.0}, "period"),
        ({"mass": -1.0}, "mass"),
        ({"bearing": None}, "bearing"),
        ({"error": 2.0}, "error"),
    ],
)
def test_refuses(change, words):
    options = {"bearing": _bearing(), "speed": 300.0, "period": 0.02, "load": np.ones((8, 2)), "mass": 1.0}
    with pytest.raises(ehd.InputError, match=words):
        ehd.recommend_steps(**(options | change))
