"""Estimated errors of the time steps against runs with many more, and the number of steps that runs say would do."""

import dataclasses
import functools
import math
import re
import warnings

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling import doubts
from exudyn_ehd.joint.step_error import FIRST
from tests.benchmarks.accuracy.scenes import measured
from tests.mechanisms.test_rates_follow_positions import CLOSURES, four_bar, pin, settings

FILM = ehd.FiniteLength(n_theta=48, n_z=6)


def moving(scene, **options):
    bearing = dataclasses.replace(scene.bearing, film=FILM, **options)
    mbs, joint = scene.build(bearing)
    return mbs, joint, scene.end


def planar(**options):
    speed = 50.0 * math.pi
    mbs, joint = four_bar(pin(CLOSURES["swift-stieber"], film=FILM, **options), speed)
    return mbs, joint, 4.0 * math.pi / speed


LINER = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=5e9)
SCENES = {
    "four-bar": (planar, {}),
    "slider-crank": (lambda **o: moving(measured.slider_pin(), **o), {}),
    "big end": (lambda **o: moving(measured.big_end(), **o), {}),
    "orbit": (lambda **o: moving(measured.step_load_orbit(), **o), {}),
    "big end, liner": (lambda **o: moving(measured.big_end(), **o), {"bush": LINER}),
    "four-bar, oil content": (planar, {"cavitation": CLOSURES["elrod-adams"]}),
}


def run(name, steps, counts=None, round_off=0, **options_of_run):
    """A run of a scene; ``counts`` takes the film's evaluations so far at each accepted state.

    ``round_off``: number of thousand units of round-off by which the clearance of the big end is larger.
    """
    make, options = SCENES[name]
    if round_off:
        options = {"radial_clearance": measured.big_end().bearing.radial_clearance * (1.0 + 3e-13 * round_off)}
    if "cavitation" in options:
        speed = 50.0 * math.pi
        (mbs, joint), end = four_bar(pin(options["cavitation"], film=FILM), speed), 4.0 * math.pi / speed
    else:
        mbs, joint, end = make(**options)
    if counts is not None:
        joint.element.steps.observers.append(lambda trial: counts.append(joint.element.evaluations))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ehd.SolveDynamic(mbs, settings(end, steps, 0.6), **options_of_run)
    return joint


@functools.cache
def reference(name):
    """History of a scene with many steps, of several tests."""
    return run(name, 2016 if "big end" in name else 1600).history


def true_error(history, reference, start=0.0):
    """Distance of the journal's axis from that of the reference over the minimum film thickness, largest from a time
    on."""
    places = [np.interp(history.time, reference.time, x) for x in reference.eccentricity.T]
    apart = np.hypot(*(history.eccentricity - np.stack(places, axis=1)).T)
    return float(np.max((apart / history.minimum_gap)[history.time >= start]))


def told_steps(joint):
    """The number of steps in all that the line of a run names, None if it names none."""
    history = joint.history
    line = doubts.line(joint.name, joint.bearing, history)
    found = re.search(r"take (\d+) steps (per turn|in all)", line)
    if found is None:
        return None
    turns = abs(float(np.trapezoid(history.motion[:, 8], history.time))) / (2.0 * math.pi)
    return round(int(found[1]) * (turns if found[2] == "per turn" else 1.0))


def test_a_run_with_coarse_steps_says_so():
    """75 steps a turn: 13 % off in the second turn; with what it says, below 5 %."""
    coarse, reference = run("four-bar", 150), run("four-bar", 900)
    error = true_error(coarse.history, reference.history)
    assert 1 / 3 < np.nanmax(coarse.history.step_error) / error < 3.0 and error > 0.1
    assert 250 < told_steps(coarse) < 600


def shaft_in_three_films(steps):
    """The first turn of a shaft of 12 kg under a load that alternates once a turn, off its middle, 2 to 6 kN."""
    speed, SC = 300.0, exu.SystemContainer()
    mbs = SC.AddSystem()
    inertia = InertiaCylinder(7800, 0.3, 0.04, 2)
    shaft = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0, 0, speed])
    bearing = pin(CLOSURES["swift-stieber"], film=FILM)
    joints = [
        ehd.CreateLubricatedJoint(
            mbs, f"main {z}", [mbs.CreateGround(), shaft], [0, 0, z], [0, 0, 1], bearing, axial=axial
        )
        for z, axial in ((-0.12, ehd.Free()), (0.0, ehd.Free()), (0.12, ehd.Held()))
    ]
    mbs.CreateForce(
        itemNumber=shaft,
        localPosition=[0, 0, 0.06],
        loadVector=[0, 0, 0],
        loadVectorUserFunction=lambda mbs, t, load: [0.0, -4000.0 - 2000.0 * math.cos(speed * t), 0.0],
    )
    mbs.Assemble()
    ehd.SolveDynamic(mbs, settings(2.0 * math.pi / speed, steps, 0.6))
    return [joint.history for joint in joints]


@pytest.mark.slow
def test_a_shaft_in_three_films_is_told_its_own_error():
    """0.3 to 3.5 %; with the whole shaft's inertia on each of its films they were told as 70 % and more."""
    for coarse, reference in zip(shaft_in_three_films(120), shaft_in_three_films(960), strict=True):
        error = true_error(coarse, reference, start=coarse.time[FIRST])
        assert 1 / 3 < np.nanmax(coarse.step_error) / error < 3.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("four-bar", (150, 200, 400)),
        ("slider-crank", (90, 135, 180, 270)),
        ("big end", (126, 252, 504)),
        ("orbit", (100, 200, 400)),
        ("big end, liner", (252,)),
        ("four-bar, oil content", (150, 200)),
    ],
)
def test_estimates_are_within_three_of_the_error_and_their_advice_does(name, steps):
    """A fixed number of steps after what the coarsest run says has an error below 5 %.

    Errors count from the first state with an estimate on: of the orbit the first step has a larger one, which is gone
    in the second.
    """
    for number in steps:
        joint = run(name, number)
        error = true_error(joint.history, reference(name), start=joint.history.time[FIRST])
        assert 1 / 3 < np.nanmax(joint.history.step_error) / error < 3.0, number
        told = told_steps(joint)
        if told is not None:
            assert true_error(run(name, told).history, reference(name)) < 0.05, told


# Changes of the clearance by round-off with which a scene is run. The chosen steps of the big end hang on round-off: in
# seven of eight runs at 2 %, errors are 0.76 to 1.12 of the one asked for, and 1.51 in the other one.
ROUND_OFFS = {"big end": range(5)}


def within(errors, error):
    """Return whether the median error is within a third of what is asked, and the largest within 1.6 times."""
    return np.median(errors) < 1.33 * error and max(errors) < 1.6 * error


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "usual", "fixed", "most"),
    [
        ("four-bar", 200, (391, 615), 1.0),
        ("slider-crank", 135, (371, 583), 0.8),
        ("big end", 252, (223, 552), 1.35),
        ("orbit", 100, (139, 245), 0.6),
    ],
)
def test_steps_by_their_error(name, usual, fixed, most):
    """Errors within a third of what is asked, at the cost of the best equal steps that were found by hand.

    Those hold 5 and 2 % with every larger number of steps, too.
    """
    for error, steps in zip((0.05, 0.02), fixed, strict=True):
        control, best = ehd.StepControl(error=error), run(name, steps)
        joint, *others = (run(name, usual, round_off=k, stepControl=control) for k in ROUND_OFFS.get(name, (0,)))
        assert within([true_error(each.history, reference(name)) for each in (joint, *others)], error)
        assert joint.element.evaluations < most * best.element.evaluations


@pytest.mark.slow
def test_steps_by_their_error_of_two_films_in_space(example):
    """The rigid rocker of the spatial four-bar mechanism, against the best equal steps for two turns."""
    scene = example("four_bar_spatial")
    bearing, end = dataclasses.replace(scene.BEARING, film=FILM), 4.0 * math.pi / scene.SPEED

    def films(steps, **options):
        made = scene.Mechanism(bearing=bearing, elastic=False)
        given = settings(end, steps, 0.6)
        given.solution.sensors.writePeriod = end
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ehd.SolveDynamic(made.mbs, given, **options)
        return made.joints

    reference = [joint.history for joint in films(800)]
    for error, steps in ((0.05, 100), (0.02, 150)):
        found, best = films(100, stepControl=ehd.StepControl(error=error)), films(steps)
        for joint, exact in zip(found, reference, strict=True):
            assert true_error(joint.history, exact) < 1.33 * error
        assert found[0].element.evaluations < best[0].element.evaluations


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "usual", "fixed"),
    [("four-bar", 200, (188, 252)), ("slider-crank", 135, (128, 154)), ("big end", 252, (196, 348))],
)
def test_steps_by_their_error_in_a_settled_cycle(name, usual, fixed):
    """Cycles without a start-up, in which equal steps are better: their errors cancel, those of other steps less so."""

    def late(steps, **options):
        counts = []
        history = run(name, steps, counts, **options).history
        return history, counts[-1] - counts[np.searchsorted(history.time, 0.5 * history.time[-1])]

    for error, steps in zip((0.05, 0.02), fixed, strict=True):
        _, best = late(steps)
        for guess in (usual // 2, usual, 2 * usual):
            control, sizes = ehd.StepControl(error=error), ROUND_OFFS.get(name, (0,))
            runs = [late(2 * (guess // 2), round_off=k, stepControl=control) for k in sizes]
            half = [true_error(history, reference(name), 0.5 * history.time[-1]) for history, _ in runs]
            assert within(half, error)
            _, found = runs[0]
            assert found < 1.6 * best
