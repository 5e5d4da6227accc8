"""Two joints of different fidelity in one model with the user's own hooks and sensors: each does what it does alone."""

import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd

CLEARANCE, STEPS, STEP = 40e-6, 40, 1e-4
FILMS = {
    "fine": {"film": ehd.FiniteLength(n_theta=48, n_z=6), "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "coarse": {"film": ehd.ShortBearing(), "cavitation": ehd.Gumbel()},
}


def add_journal(mbs, name, place):
    body = scenes.add_body(
        mbs,
        "Rxyz",
        [place, 0, 0],
        spin=[0, 0, 150.0],
        initialDisplacement=[0.3 * CLEARANCE, 0, 0],
        gravity=[0, -100.0, 0],
    )
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.02),
        **FILMS[name],
    )
    return ehd.CreateLubricatedJoint(
        mbs, name=name, itemNumbers=[mbs.CreateGround(), body], position=[place, 0, 0], axis=[0, 0, 1], bearing=bearing
    )


def run(mbs):
    mbs.Assemble()
    settings = scenes.settings(STEPS * STEP, STEPS, tolerance=1e-9)
    settings.solution.sensors.writePeriod = 1e-12
    mbs.SolveDynamic(settings)


def test_two_joints_with_hooks_and_sensors_do_what_each_does_alone(measured):
    mbs = scenes.new_system()
    joints = {name: add_journal(mbs, name, place) for name, place in (("fine", 0.0), ("coarse", 0.5))}
    sensors = {name: joint.AddSensor(ehd.Quantity.MINIMUM_GAP) for name, joint in joints.items()}
    calls = {"pre": 0, "post": 0}

    def count(which):
        def hook(mbs, t):
            calls[which] += 1
            return True

        return hook

    hooks = count("pre"), count("post")
    mbs.SetPreStepUserFunction(hooks[0])
    mbs.SetPostStepUserFunction(hooks[1])
    run(mbs)
    # the user's hooks are still there, called at every step, the post-step hook for the initial state too
    assert calls == {"pre": STEPS, "post": STEPS + 1}
    for name, joint in joints.items():
        stored = mbs.GetSensorStoredData(sensors[name])
        np.testing.assert_allclose(stored[:, 0], joint.history.time, rtol=0, atol=1e-12)
        # the sensor writes what the history holds
        np.testing.assert_allclose(stored[:, 1], joint.history.minimum_gap, rtol=1e-12, atol=0)
        alone = scenes.new_system()
        single = add_journal(alone, name, 0.0)
        run(alone)
        difference = np.abs(joint.history.eccentricity - single.history.eccentricity).max() / CLEARANCE
        # Newton stops for both joints together: its tolerance times the film's stiffness
        measured(f"{name} next to another", difference, 1e-8)
    fine, coarse = (joints[name].history.eccentricity for name in FILMS)
    assert np.abs(fine - coarse).max() > 1e-2 * CLEARANCE
    assert joints["fine"].history.time.size == STEPS + 1


def test_two_joints_with_hooks_and_sensors_go_on_from_a_stored_state(tmp_path):
    def scene():
        mbs = scenes.new_system()
        joints = [add_journal(mbs, name, place) for name, place in (("fine", 0.0), ("coarse", 0.5))]
        sensor = joints[0].AddSensor(ehd.Quantity.MINIMUM_GAP)
        calls = []

        def hook(mbs, t):
            calls.append(t)
            return True

        mbs.SetPostStepUserFunction(hook)
        mbs.Assemble()
        return mbs, joints, sensor, calls

    def settings(first, last):
        s = scenes.settings(last * STEP, last - first)
        s.timeIntegration.startTime = first * STEP
        s.solution.sensors.writePeriod = 1e-12
        return ehd.ConfigureSolver(s, relativeTolerance=1e-9)

    through, whole, _, _ = scene()
    ehd.SolveDynamic(through, settings(0, STEPS))
    first, _, _, _ = scene()
    ehd.SolveDynamic(first, settings(0, STEPS // 2))
    ehd.SaveState(first, tmp_path / "state.npz")
    second, parts, sensor, calls = scene()
    ehd.SolveDynamic(second, settings(STEPS // 2, STEPS), restart=tmp_path / "state.npz")
    assert calls[-1] == pytest.approx(STEPS * STEP)
    for one, other in zip(whole, parts, strict=True):
        difference = np.abs(one.history.eccentricity[-1] - other.history.eccentricity[-1]).max()
        # Newton's tolerance of 1e-9 over the steps
        assert difference < 1e-7 * CLEARANCE
    stored = second.GetSensorStoredData(sensor)
    np.testing.assert_allclose(stored[-1, 1], parts[0].history.minimum_gap[-1], rtol=1e-12)
