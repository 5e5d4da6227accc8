"""The record holds exactly the accepted steps, and failures end with an error that says what to do."""

import exudyn as exu
import numpy as np
import pytest
import scenes
import toy

import exudyn_ehd as ehd
from exudyn_ehd.coupling.record.history import Quantity
from exudyn_ehd.status import FilmError, InputError, Status


class FragileEvaluation(toy.ToyEvaluation):
    """Cannot be evaluated where the model's predicate says so."""

    def __init__(self, model, motion):
        super().__init__(model, motion)
        if model.fails(motion):
            self.status = Status.NOT_CONVERGED
            self.wrench = np.full(6, np.nan)


class FragileFilm(toy.ToyFilm):
    """Toy film that fails on demand and logs what it was asked."""

    def __init__(self, fails, **options):
        super().__init__(**options)
        self.fails = fails
        self.asked = []

    def evaluate(self, motion, history=None, step=0.0, spin=0.0):
        self.count += 1
        self.asked.append(motion.copy())
        return FragileEvaluation(self, motion.copy())


def scene(film, node="RotVec"):
    mbs = scenes.new_system()
    housing = scenes.add_body(mbs, "ground")
    journal = scenes.add_body(mbs, node, velocity=(0.1, 0, 0), spin=(0, 0, 20.0), gravity=[0, -9.81, 0])
    joint = toy.attach(mbs, [housing, journal], film, position=[0, 0, 0.0], name="big end")
    return mbs, joint, journal


def accepted_positions(mbs, journal, settings, solver=None):
    """Time, x, y of the journal at every accepted step, from Exudyn's own sensor."""
    sensor = mbs.AddSensor(
        exu.itemInterface.SensorBody(
            bodyNumber=journal, outputVariableType=exu.OutputVariableType.Position, storeInternal=True
        )
    )
    mbs.Assemble()
    settings.solution.sensors.writePeriod = 1e-12
    mbs.SolveDynamic(settings, **({} if solver is None else {"solverType": solver}))
    return mbs.GetSensorStoredData(sensor)[:, :3]


SOLVERS = [
    exu.DynamicSolverType.GeneralizedAlpha,
    exu.DynamicSolverType.TrapezoidalIndex2,
    exu.DynamicSolverType.RK44,
    exu.DynamicSolverType.ExplicitEuler,
    exu.DynamicSolverType.DOPRI5,
]


@pytest.mark.parametrize("solver", SOLVERS, ids=str)
@pytest.mark.parametrize("full", [True, False], ids=["full Newton", "modified Newton"])
def test_record_is_the_accepted_states(solver, full):
    mbs, joint, journal = scene(toy.ToyFilm())
    expected = accepted_positions(mbs, journal, scenes.settings(0.002, 40, full_newton=full), solver)
    history = joint.history
    # the same state read twice: no tolerance
    np.testing.assert_array_equal(history.time, expected[:, 0])
    np.testing.assert_array_equal(history.eccentricity, expected[:, 1:])
    assert history.time[0] == 0.0
    assert len(history.time) >= 41


def test_record_under_rejected_steps():
    """A film that fails for large predicted velocities or on the first look at some times: steps are halved."""
    film = FragileFilm(lambda m: False)
    rejected = []

    def fails(motion):
        # every seventh evaluation fails once: the step is repeated with half the size
        film.number = getattr(film, "number", 0) + 1
        if film.number in (9, 30, 31, 60):
            rejected.append(motion)
            return True
        return False

    film.fails = fails
    mbs, joint, journal = scene(film)
    expected = accepted_positions(mbs, journal, scenes.settings(0.002, 40))
    history = joint.history
    assert len(rejected) == 4
    assert len(history.time) > 41
    np.testing.assert_array_equal(history.time, expected[:, 0])
    np.testing.assert_array_equal(history.eccentricity, expected[:, 1:])
    assert np.all(np.isfinite(history.force))


def test_restart_starts_a_new_record_and_continuation_goes_on():
    mbs, joint, _ = scene(toy.ToyFilm())
    mbs.Assemble()
    settings = scenes.settings(0.001, 10)
    mbs.SolveDynamic(settings)
    first = joint.history
    mbs.SolveDynamic(settings)
    again = joint.history
    np.testing.assert_array_equal(again.motion, first.motion)
    mbs.SolveDynamic(settings, updateInitialValues=True)
    settings.timeIntegration.startTime = 0.001
    settings.timeIntegration.endTime = 0.002
    mbs.SolveDynamic(settings)
    both = joint.history
    assert len(both.time) == 21
    np.testing.assert_array_equal(both.motion[:11], first.motion)
    assert np.all(np.diff(both.time) > 0)


def test_single_step_run_after_changed_initial_values_forgets_the_old_start():
    mbs, joint, _ = scene(toy.ToyFilm())
    mbs.Assemble()
    settings = scenes.settings(1e-4, 1)
    mbs.SolveDynamic(settings)
    first = joint.history
    mbs.systemData.SetODE2Coordinates([2e-4, 0, 0, 0, 0, 0], exu.ConfigurationType.Initial)
    mbs.SolveDynamic(settings)
    second = joint.history
    assert len(first.time) == len(second.time) == 2
    assert second.eccentricity[0, 0] == 2e-4


def test_history_before_and_after_assemble():
    mbs, joint, _ = scene(toy.ToyFilm())
    with pytest.warns(UserWarning, match=r"its history is empty before a run; run a solver first"):
        history = joint.history
    assert len(history.time) == 0 and "run a solver first" in repr(history)
    mbs.Assemble()
    assert joint.history.time.tolist() == [0.0] and "initial state, without a run" in repr(joint.history)
    mbs.SolveDynamic(scenes.settings(1e-4, 1))
    assert "2 steps" in repr(joint.history)


def test_a_history_is_that_of_the_run_whatever_is_done_to_the_system_behind_it():
    mbs, joint, _ = scene(toy.ToyFilm())
    mbs.Assemble()
    assert len(joint.history.time) == 1
    ehd.SolveDynamic(mbs, scenes.settings(0.001, 10))
    mbs.ComputeLinearizedSystem()
    told = joint.history
    assert told.time[-1] == 0.001 and len(told.time) == 11
    q = mbs.systemData.GetODE2Coordinates()
    mbs.systemData.SetODE2Coordinates((0.0 * np.array(q)).tolist())
    mbs.Assemble()
    np.testing.assert_array_equal(joint.history.motion, told.motion)
    mbs.SolveDynamic(scenes.settings(0.0005, 5))
    assert joint.history.time[-1] == 0.0005 and len(joint.history.time) == 6
    mbs.Reset()
    assert len(joint.history.time) == 6


def test_reading_between_steps_changes_nothing():
    """A user's hook that reads the history in every step."""
    runs = []
    for read in (False, True):
        mbs, joint, _ = scene(toy.ToyFilm())
        mbs.Assemble()
        lengths = []

        def hook(mbs, t, joint=joint, lengths=lengths):
            lengths.append(len(joint.history.time))
            return True

        if read:
            mbs.SetPostStepUserFunction(hook)
            mbs.SetPreStepUserFunction(hook)
        mbs.SolveDynamic(scenes.settings(0.001, 10))
        runs.append(joint.history)
        assert not read or len(lengths) > 10
    np.testing.assert_array_equal(runs[1].time, runs[0].time)
    np.testing.assert_array_equal(runs[1].motion, runs[0].motion)


def test_long_records_grow():
    mbs, joint, journal = scene(toy.ToyFilm())
    expected = accepted_positions(mbs, journal, scenes.settings(0.002, 300))
    assert len(joint.history.time) == len(expected) == 301


def wall(limit):
    return lambda motion: motion[0] > limit


def test_lasting_failure_ends_an_implicit_run_with_the_reason():
    """The journal moves at 0.1 m/s towards a region the film can't do."""
    film = FragileFilm(wall(2e-5), stiffness=0.0, damping=0.0)
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    with pytest.raises(exu.ExudynError) as caught:
        mbs.SolveDynamic(scenes.settings(0.002, 20))
    error = caught.value.__cause__
    assert isinstance(error, FilmError)
    text = str(error)
    for part in ("big end", "t = 0.0002", "eccentricity ratio 0.02", "minimum gap", Status.NOT_CONVERGED.advice):
        assert part in text
    history = joint.history
    # approached by halving the step down to 1e-8 s at 0.1 m/s
    assert history.eccentricity[-1, 0] == pytest.approx(2e-5, abs=4e-9)
    assert len(history.time) > 2


def test_lasting_failure_ends_a_static_run_with_the_reason():
    film = FragileFilm(lambda m: m[1] < -1e-5)
    mbs, joint, journal = scene(film)
    scenes.hold_axially_and_in_spin(mbs, exu.ObjectIndex(0), journal)
    mbs.AddLoad(
        exu.itemInterface.LoadForceVector(
            markerNumber=mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=journal)),
            loadVector=[0, -100.0, 0],
        )
    )
    mbs.Assemble()
    with pytest.raises(exu.ExudynError) as caught:
        mbs.SolveStatic(scenes.settings(1, 1))
    assert isinstance(caught.value.__cause__, FilmError)
    assert "big end" in str(caught.value.__cause__)
    history = joint.history
    # approached by load steps of ever smaller size; the last recorded one is the last accepted
    assert history.motion[-1, 1] == pytest.approx(-1e-5, rel=1e-3)
    assert history.time[-1] == mbs.systemData.GetTime(exu.ConfigurationType.StartOfStep) > 0.0


def test_error_elsewhere_in_a_static_run_leaves_no_row_of_the_failed_state():
    """The film is fine, but another user function raises in the middle of a load step."""
    mbs, joint, journal = scene(toy.ToyFilm())
    scenes.hold_axially_and_in_spin(mbs, exu.ObjectIndex(0), journal)

    def load(mbs, t, vector):
        if t > 0.6:
            raise ValueError("no such load")
        return [0, -100.0 * t, 0]

    marker = mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=journal))
    mbs.AddLoad(
        exu.itemInterface.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=load)
    )
    mbs.Assemble()
    settings = scenes.settings(1, 1)
    settings.staticSolver.numberOfLoadSteps = 4
    with pytest.raises(exu.ExudynError):
        mbs.SolveStatic(settings)
    assert joint.history.time.tolist() == [0.0, 0.25, 0.5]


def test_plot_sensor_draws(monkeypatch):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    mbs, joint, _ = scene(toy.ToyFilm())
    sensor = joint.AddSensor(Quantity.ECCENTRICITY)
    mbs.Assemble()
    mbs.SolveDynamic(scenes.settings(0.001, 10))
    monkeypatch.setattr(plt, "show", lambda *args, **kwargs: None)
    mbs.PlotSensor(sensorNumbers=[sensor], components=[1])
    assert plt.get_fignums()
    plt.close("all")


@pytest.mark.parametrize("solver", [exu.DynamicSolverType.RK44, exu.DynamicSolverType.ExplicitEuler], ids=str)
def test_failure_raises_at_once_under_explicit_solvers(solver):
    film = FragileFilm(wall(2e-5), stiffness=0.0, damping=0.0)
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    with pytest.raises(exu.ExudynError) as caught:
        mbs.SolveDynamic(scenes.settings(0.002, 20), solverType=solver)
    assert isinstance(caught.value.__cause__, FilmError)
    assert sum(film.fails(m) for m in film.asked) == 1
    assert np.all(np.isfinite(joint.history.motion))
    assert len(joint.history.time) >= 2


def test_failure_at_the_initial_state_raises_at_once():
    film = FragileFilm(lambda m: True)
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    with pytest.raises(exu.ExudynError) as caught:
        mbs.SolveDynamic(scenes.settings(0.002, 20))
    assert isinstance(caught.value.__cause__, FilmError)
    assert "t = 0 s" in str(caught.value.__cause__)
    assert len(joint.history.time) == 0


def test_failure_after_a_run_is_not_mistaken_for_one_in_it():
    """The solver object of a finished run stays in mbs.sys: a direct call must raise, not return nan."""
    film = FragileFilm(lambda m: False)
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    mbs.SolveDynamic(scenes.settings(0.001, 10))
    film.fails = lambda m: True
    with pytest.raises(FilmError):
        joint.element.force(mbs, 0.0, 0, [1e-5, 0, 0, 0, 0, 0], [0.0] * 6)


def test_not_finite_state_and_closed_gap_have_their_own_messages():
    mbs, joint, _ = scene(toy.ToyFilm())
    mbs.Assemble()
    with pytest.raises(FilmError, match="not finite"):
        joint.element.force(mbs, 0.0, 0, [np.nan, 0, 0, 0, 0, 0], [0.0] * 6)
    with pytest.raises(FilmError, match="contact=RegularisedWall"):
        joint.element.force(mbs, 0.0, 0, [2e-3, 0, 0, 0, 0, 0], [0.0] * 6)
    with pytest.raises(FilmError, match="tilt near 90"):
        joint.element.force(mbs, 0.0, 0, [0, 0, 0, 1.6, 0, 0], [0.0] * 6)


def test_two_joints_keep_records_of_their_own():
    mbs = scenes.new_system()
    housing = scenes.add_body(mbs, "ground")
    bodies = [scenes.add_body(mbs, "Rxyz", (k, 0, 0), velocity=(0.05 * (k + 1), 0, 0)) for k in range(2)]
    joints = [toy.attach(mbs, [housing, b], toy.ToyFilm(), position=[k, 0, 0]) for k, b in enumerate(bodies)]
    mbs.Assemble()
    mbs.SolveDynamic(scenes.settings(0.001, 10))
    one, two = (joint.history for joint in joints)
    np.testing.assert_array_equal(one.time, two.time)
    assert two.motion[0, 4] == 2 * one.motion[0, 4] == 0.1


def test_sensor_agrees_with_the_record():
    mbs, joint, _ = scene(toy.ToyFilm())
    sensors = {q: joint.AddSensor(q) for q in Quantity}
    mbs.Assemble()
    settings = scenes.settings(0.001, 10)
    settings.solution.sensors.writePeriod = 1e-12
    mbs.SolveDynamic(settings)
    history = joint.history
    for quantity, sensor in sensors.items():
        data = mbs.GetSensorStoredData(sensor)
        # one state, one evaluation: no tolerance
        np.testing.assert_array_equal(data[:, 0], history.time)
        expected = getattr(history, quantity.value)
        np.testing.assert_array_equal(data[:, 1:], expected.reshape(len(history.time), -1))
    with pytest.raises(InputError):
        joint.AddSensor("gap")


class BeyondEvaluation(toy.ToyEvaluation):
    """Behind the end of a pressure law, where forces go on."""

    def __init__(self, model, motion):
        super().__init__(model, motion)
        if model.beyond:
            self.status = Status.NO_PRESSURE


class BeyondFilm(toy.ToyFilm):
    """Toy film whose last states lie behind the end of a pressure law."""

    beyond = False

    def evaluate(self, motion, history=None, step=0.0, spin=0.0):
        self.count += 1
        return BeyondEvaluation(self, motion.copy())


def test_last_state_without_a_film_is_said():
    film = BeyondFilm()
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    settings = scenes.settings(0.001, 20)
    mbs.SetPreStepUserFunction(lambda mbs, t: setattr(film, "beyond", t > 0.00096) or True)
    mbs.SolveDynamic(settings)
    with pytest.warns(UserWarning, match="'big end'.* t = 0.001 .*history leaves this state out"):
        history = joint.history
    assert len(history.time) == 20


class LaggingEvaluation(toy.ToyEvaluation):
    """A force that follows the eccentricity with a lag: m' = (x - m) / tau by backward Euler."""

    def __init__(self, model, motion, memory, step):
        super().__init__(model, motion)
        weight = 1.0 if step == np.inf else step / (model.tau + step)
        self.new = memory + weight * (motion[0] - memory)
        self.wrench[0] -= model.extra * self.new
        self._tangent[0, 0] -= model.extra * weight
        if model.fails(motion):
            self.status = Status.NOT_CONVERGED

    def history(self):
        assert self.count == self.model.count, "stale evaluation"
        return self.new


class LaggingFilm(FragileFilm):
    """Toy film with a memory of one number."""

    tau, extra = 3e-4, 1e6

    def __init__(self, fails):
        super().__init__(fails, remembers=True)

    def initial_history(self, motion):
        self.count += 1
        return 0.5 * motion[0]

    def evaluate(self, motion, history=None, step=0.0, spin=0.0):
        self.count += 1
        self.asked.append(step)
        # without a memory the lag is over
        return LaggingEvaluation(self, motion.copy(), history or 0.0, np.inf if history is None else step)


@pytest.mark.parametrize(
    ("solver", "rejecting"),
    [
        (exu.DynamicSolverType.GeneralizedAlpha, False),
        (exu.DynamicSolverType.GeneralizedAlpha, True),
        (exu.DynamicSolverType.RK44, False),
    ],
    ids=str,
)
def test_memory_advances_on_accepted_steps_only(solver, rejecting):
    """Replaying the accepted states gives every recorded force: nothing else was remembered."""
    film = LaggingFilm(lambda m: False)
    calls = []

    def fails(motion):
        calls.append(motion)
        return rejecting and len(calls) in (9, 30, 31, 60)

    film.fails = fails
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    settings = scenes.settings(0.001, 20)
    mbs.SolveDynamic(settings, updateInitialValues=True, solverType=solver)
    film.fails = lambda m: False
    # and a second run goes on where the first one ended
    settings.timeIntegration.startTime, settings.timeIntegration.endTime = 0.001, 0.002
    mbs.SolveDynamic(settings, solverType=solver)
    history = joint.history
    assert len(history.time) == 41 or (rejecting and len(history.time) > 41)
    memory = 0.5 * history.motion[0, 0]
    for k, motion in enumerate(history.motion):
        step = history.time[k] - history.time[max(k - 1, 0)]
        memory += step / (film.tau + step) * (motion[0] - memory)
        # the same few operations in another order
        assert history.force[k, 0] == pytest.approx(film.law(motion)[0][0] - film.extra * memory, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("solver", [exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.RK44], ids=str)
def test_later_run_from_the_old_initial_values_remembers_nothing(solver):
    """Without ``updateInitialValues`` Exudyn starts anew, whatever the start time: so do memory and record."""
    film = LaggingFilm(lambda m: False)
    mbs, joint, _ = scene(film)
    mbs.Assemble()
    settings = scenes.settings(0.001, 20)
    mbs.SolveDynamic(settings, solverType=solver)
    first = joint.history
    settings.timeIntegration.startTime, settings.timeIntegration.endTime = 0.001, 0.002
    mbs.SolveDynamic(settings, solverType=solver)
    again = joint.history
    assert len(again.time) == len(first.time)
    # times that sum up differently
    np.testing.assert_allclose(again.time - 0.001, first.time, rtol=0, atol=1e-15)
    np.testing.assert_allclose(again.force, first.force, rtol=0, atol=1e-9 * np.abs(first.force).max())


def test_a_joint_that_does_not_move_goes_on():
    """Nothing but its memory has changed: the same coordinates are the end of the run and its start."""
    film = LaggingFilm(lambda m: False)
    mbs = scenes.new_system()
    items = [scenes.add_body(mbs, "ground"), scenes.add_body(mbs, "Rxyz")]
    mbs.CreateGenericJoint(itemNumbers=items, position=[0, 0, 0], constrainedAxes=[1, 1, 1, 1, 1, 1])
    joint = toy.attach(mbs, items, film, position=[0, 0, 0.0], name="held")
    mbs.Assemble()
    settings = scenes.settings(0.001, 10)
    mbs.SolveDynamic(settings, updateInitialValues=True)
    settings.timeIntegration.startTime, settings.timeIntegration.endTime = 0.001, 0.002
    mbs.SolveDynamic(settings, updateInitialValues=True)
    assert len(joint.history.time) == 21


def test_static_solve_asks_for_the_steady_film():
    film = LaggingFilm(lambda m: False)
    mbs, joint, journal = scene(film)
    scenes.hold_axially_and_in_spin(mbs, exu.ObjectIndex(0), journal)
    mbs.Assemble()
    mbs.SolveStatic(scenes.settings(1, 1))
    assert set(film.asked) == {0.0}
    assert len(joint.history.time) == 2


def test_runs_after_a_failed_one_know_their_solver():
    """A run that an exception ended leaves its solver looking busy; the next runs must not mistake it for theirs."""
    film = FragileFilm(wall(2e-5), stiffness=0.0, damping=0.0)
    mbs, joint, journal = scene(film)
    scenes.hold_axially_and_in_spin(mbs, exu.ObjectIndex(0), journal)
    mbs.Assemble()
    settings = scenes.settings(0.002, 20)
    for solver in (exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.RK44) * 2:
        film.asked.clear()
        with pytest.raises(exu.ExudynError) as caught:
            mbs.SolveDynamic(settings, solverType=solver)
        assert isinstance(caught.value.__cause__, FilmError)
        failures = sum(film.fails(m) for m in film.asked)
        # the explicit solver ends at the first failure, the implicit one after halving 1e-4 s down to 1e-8 s
        assert failures == 1 if solver == exu.DynamicSolverType.RK44 else failures >= 13
        assert joint.history.time[0] == 0.0
        assert np.all(joint.history.eccentricity[:, 0] <= 2e-5)
    film.stiffness, film.fails = 2e6, lambda m: False
    mbs.SolveStatic(scenes.settings(1, 1))
    assert joint.history.time.tolist() == [0.0, 1.0]
