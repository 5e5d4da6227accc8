"""Films on threads have the bits of one thread, and errors where they were."""

import time
from types import SimpleNamespace

import exudyn as exu
import numpy as np
import pytest
import scenes
from elastic_scene import CYLINDER, STEEL
from elastic_scene import bearing as on_bush
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.element import side_by_side
from exudyn_ehd.coupling.element.side_by_side import ENOUGH, SideBySide
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.status import Status

GRID = ehd.FiniteLength(n_theta=48, n_z=6)
SIZE = {"journal_radius": 0.02, "length": 0.02, "radial_clearance": 40e-6}
PLAIN = {**SIZE, "lubricant": ehd.Lubricant(viscosity=0.02), "film": GRID}
SWIFT = ehd.JournalBearing(**PLAIN)
ELROD = ehd.JournalBearing(**PLAIN, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
VERTICES = ehd.JournalBearing(**PLAIN, cavitation=ehd.SwiftStieber(line_in_cells=False))
OIL = ehd.oil("ISO VG 46", temperature=330.0)
HOT = ehd.JournalBearing(**(PLAIN | {"lubricant": OIL}), thermal=ehd.LumpedThermal(supply_temperature=330.0))
FIELD = ehd.JournalBearing(
    **(PLAIN | {"lubricant": OIL}), thermal=ehd.FilmEnergy(supply_temperature=330.0, bush_coefficient=1e3)
)
SOFT = on_bush(ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2))


@pytest.fixture
def crews(monkeypatch):
    """List of the `SideBySide` objects that the test makes."""
    found, begin = [], SideBySide.__init__

    def noted(self, *arguments):
        begin(self, *arguments)
        found.append(self)

    monkeypatch.setattr(SideBySide, "__init__", noted)
    return found


def rotor(bearings, force=400.0, record=None):
    """A shaft in films, one for each of ``bearings``, under a turning load."""
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    shaft = mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800.0, 0.1 * len(bearings), 0.02, 2),
        initialAngularVelocity=[0.0, 0.0, 200.0],
        nodeType=exu.NodeType.RotationRxyz,
    )
    joints = []
    for k, bearing in enumerate(bearings):
        place = [0.0, 0.0, 0.1 * (k - 0.5 * (len(bearings) - 1))]
        joints.append(ehd.CreateLubricatedJoint(mbs, f"film {k}", [ground, shaft], place, [0, 0, 1], bearing))

    def load(mbs, t, vector):
        return [force * np.cos(300.0 * t), force * np.sin(300.0 * t) - 0.5 * force, 0.0]

    mbs.CreateForce(itemNumber=shaft, loadVector=[0, 0, 0], loadVectorUserFunction=load)
    mbs.Assemble()
    return mbs, joints


def histories(bearings, threads, solve=ehd.SolveDynamic, steps=30, step=1e-4, **options):
    """Rows of all joints after a run, and their number of evaluations."""
    mbs, joints = rotor(bearings)
    solve(mbs, ehd.ConfigureSolver(scenes.settings(steps * step, steps)), threads=threads, **options)
    rows = [joint.element.steps.record.rows(None) for joint in joints]
    return rows, [joint.element.evaluations for joint in joints]


def require_same(bearings, crews, **options):
    (one, counts), (two, again) = (histories(bearings, threads, **options) for threads in (1, 2))
    assert counts == again
    assert crews[-1].shared > len(one[0])
    for a, b in zip(one, two, strict=True):
        assert a.tobytes() == b.tobytes()


def test_films_of_many_kinds_have_the_bits_of_one_thread(crews):
    require_same([SWIFT, ELROD, SWIFT, VERTICES], crews)


def test_a_run_whose_steps_are_rejected_has_the_bits_of_one_thread(crews):
    require_same([SWIFT, ELROD, SWIFT], crews, steps=6, step=1e-3, stepControl=ehd.StepControl(error=0.05))


@pytest.mark.slow
@pytest.mark.parametrize("solve", [ehd.SolveDynamic, ehd.SolveDynamicSparse])
def test_films_with_memory_and_bushes_have_the_bits_of_one_thread(crews, solve):
    require_same([HOT, SOFT, HOT, ELROD, SOFT, FIELD], crews, solve=solve)


def test_a_run_that_goes_on_has_the_bits_of_one_thread():
    found = []
    for threads in (1, 2):
        mbs, joints = rotor([SWIFT, ELROD, ELROD])
        settings = scenes.settings(1e-3, 10)
        ehd.SolveDynamic(mbs, settings, threads=threads, updateInitialValues=True)
        settings.timeIntegration.startTime, settings.timeIntegration.endTime = 1e-3, 2e-3
        ehd.SolveDynamic(mbs, settings, threads=threads)
        assert all(joint.element.crew is None for joint in joints)
        found.append(b"".join(joint.element.steps.record.rows(None).tobytes() for joint in joints))
    assert found[0] == found[1]


def test_an_error_of_an_evaluation_is_that_of_one_thread(monkeypatch):
    messages = []
    for threads in (1, 2):
        mbs, joints = rotor([SWIFT, SWIFT, SWIFT])
        model, evaluate = joints[2].element.model, BearingModel.evaluate

        def broken(*arguments, model=model, joint=joints[2], evaluate=evaluate):
            if joint.element.evaluations > 12:
                raise ValueError(f"broken after {joint.element.evaluations}")
            return evaluate(model, *arguments)

        monkeypatch.setattr(model, "evaluate", broken)
        with pytest.raises(Exception, match="broken after 13") as error:
            ehd.SolveDynamic(mbs, scenes.settings(3e-3, 30), threads=threads)
        messages.append((type(error.value), str(error.value), [joint.element.evaluations for joint in joints]))
    assert messages[0][:2] == messages[1][:2]


def test_a_limit_of_a_joint_ends_both_runs_with_the_same_words(crews):
    messages = []
    for threads in (1, 2):
        mbs, joints = rotor([SWIFT, SWIFT, SWIFT], force=2000.0)
        joints[1].stop_at(force=300.0)
        with pytest.raises(ehd.FilmError, match="film 1") as error:
            ehd.SolveDynamic(mbs, scenes.settings(3e-3, 30), threads=threads)
        messages.append(str(error.value))
    assert messages[0] == messages[1] and crews[-1].shared > 0


def test_errors_of_a_run_that_has_ended_are_not_those_of_the_next(crews):
    """Both joints exceed their limit in the same step: the first one ends the run, the second one's error goes."""
    mbs, joints = rotor([SWIFT, SWIFT], force=2000.0)
    for joint in joints:
        joint.stop_at(force=300.0)
    with pytest.raises(ehd.FilmError, match="film 0"):
        ehd.SolveDynamic(mbs, scenes.settings(3e-3, 30), threads=2)
    assert crews[-1].shared > 0
    for joint in joints:
        joint.stop_at()
    ehd.SolveDynamic(mbs, scenes.settings(1e-3, 10), threads=2)
    assert joints[1].history.time.size == 11


class Fake:
    """A film that counts."""

    def __init__(self, state):
        self.state, self.crew, self.last, self.calls = state, None, None, 0
        self.model = SimpleNamespace()

    def read(self, mbs, configuration):
        return list(self.state), [0.0]

    def trial(self, q):
        known = self.last is not None and self.last.q == q
        return self.last if known else SimpleNamespace(q=q, q_t=[0.0], status=Status.CONVERGED)

    def arrive(self, mbs, t, q, q_t):
        return self.trial(q)

    def evaluate(self, trial):
        time.sleep(1e-3)
        self.calls, self.last = self.calls + 1, trial

    def ask(self, crew, q):
        """Ask for a film as an element's force does."""
        trial = self.trial(q)
        crew.evaluate(None, 0.0, self, trial)
        if trial is not self.last:
            self.evaluate(trial)


@pytest.fixture
def crew():
    crew = SideBySide([Fake([0.0]), Fake([0.0]), Fake([0.0])], 2)
    yield crew
    crew.close()


def test_films_go_side_by_side_once_all_were_asked_as_expected(crew):
    for state in range(ENOUGH + 3):
        for film in crew.films:
            film.state = [float(state)]
        for film in crew.films:
            film.ask(crew, [float(state)])
        assert crew.shared == max(0, state + 2 - ENOUGH)
    assert [film.calls for film in crew.films] == [ENOUGH + 3] * 3


def test_states_that_change_between_joints_stay_on_one_thread(crew):
    for state in range(4 * ENOUGH):
        for k, film in enumerate(crew.films):
            film.state = [float(state)]
            film.ask(crew, [state + 1e-9 * k])
    assert crew.shared == 0
    assert [film.calls for film in crew.films] == [4 * ENOUGH] * 3


def test_a_film_that_is_asked_alone_stops_the_others(crew):
    for state in range(ENOUGH):
        for film in crew.films:
            film.state = [float(state)]
            film.ask(crew, [float(state)])
    shared = crew.shared
    for state in range(100, 110):
        crew.films[0].ask(crew, [float(state)])
    # those of the first of these states went along, before anybody could know
    assert crew.shared <= shared + 1


def test_threads_that_make_no_sense_are_refused():
    mbs, _ = rotor([SWIFT])
    for threads in (0, -1, 1.5, True):
        with pytest.raises(ehd.InputError, match=r"SolveDynamic\.threads"):
            ehd.SolveDynamic(mbs, scenes.settings(1e-4, 1), threads=threads)


def test_one_core_one_joint_and_a_model_in_two_joints_need_no_threads(monkeypatch, crews):
    films = [Fake([0.0]), Fake([0.0])]
    for part, threads in ((films[:1], 4), (films, 1)):
        with side_by_side.side_by_side("run", part, threads):
            assert films[0].crew is None
    monkeypatch.setattr(side_by_side, "cores", lambda: 1)
    with side_by_side.side_by_side("run", films, None):
        assert films[0].crew is None
    films[1].model = films[0].model
    with side_by_side.side_by_side("run", films, 2):
        assert films[0].crew is None
    assert not crews
