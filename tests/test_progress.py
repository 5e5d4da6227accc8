"""Long work says how far it is where somebody looks, and nowhere else."""

import io
import multiprocessing
import re
import time
import types

import exudyn as exu
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd import progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture(autouse=True)
def without_patience(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setattr(progress, "PERIOD", 0.0)
    yield
    ehd.show_progress(None)


def put(monkeypatch, stream):
    """Let the package's standard error stream be this one."""
    monkeypatch.setattr(progress, "sys", types.SimpleNamespace(stderr=stream, stdout=stream, modules={}))
    return stream


@pytest.fixture
def terminal(monkeypatch):
    screen = put(monkeypatch, Terminal())
    monkeypatch.setattr(
        progress.shutil, "get_terminal_size", lambda *_, **__: progress.shutil.os.terminal_size((120, 24))
    )
    return screen


def run(verbose=0):
    """Ten steps of a shaft in a bearing, all of which the user's own function sees."""
    mbs = exu.SystemContainer().AddSystem()
    shaft = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.1, 0.025, 2), initialAngularVelocity=[0, 0, 300.0])
    mbs.CreateForce(itemNumber=shaft, loadVector=[0, -500.0, 0])
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=32, n_z=6),
    )
    ehd.CreateLubricatedJoint(mbs, "main", [mbs.CreateGround(), shaft], [0, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 1e-3, 10
    settings.timeIntegration.verboseMode = verbose
    settings.solution.file.write = False
    seen = []
    mbs.SetPostStepUserFunction(lambda mbs, t: not seen.append(t))
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(settings))
    assert len(seen) == 11 and callable(mbs.GetPostStepUserFunction()["function"])


def test_runs_tell_on_a_terminal(terminal):
    run()
    lines = terminal.getvalue().split("\r")
    told = r"exudyn_ehd: 50 %, \d+ s left, t = 0\.0005 s, [\d.e+]+ steps/s, minimum film thickness 2\S+ µm in 'main' *"
    assert sum(bool(re.fullmatch(told, line)) for line in lines) == 1
    # the line is taken away
    assert terminal.getvalue().endswith("\r") and not lines[-2].strip()


def test_runs_are_silent_elsewhere(monkeypatch, terminal):
    ehd.show_progress(False)
    run()
    assert terminal.getvalue() == ""
    ehd.show_progress(None)
    pipe = put(monkeypatch, io.StringIO())
    run()
    assert pipe.getvalue() == ""
    ehd.show_progress(True)
    run()
    assert "steps/s" in pipe.getvalue()


def test_exudyns_own_lines_stand_alone(terminal):
    run(verbose=1)
    assert terminal.getvalue() == ""


def _look(pipe):
    pipe.send(progress.is_shown())


def test_processes_of_a_study_are_silent(terminal):
    assert progress.is_shown()
    own, theirs = multiprocessing.Pipe()
    process = multiprocessing.get_context("fork").Process(target=_look, args=(theirs,))
    process.start()
    assert own.recv() is False
    process.join()


def test_studies_print_rows_where_somebody_looks(capsys, terminal):
    def rows():
        ehd.parameter_study(lambda p: p["x"], {"x": [1.0, 2.0]})
        return capsys.readouterr().out.count("done")

    assert rows() == 2
    ehd.show_progress(False)
    assert rows() == 0


def test_work_without_shares_says_what_it_does_once_it_is_long(terminal):
    with progress.announced("computing", patience=0.01):
        time.sleep(0.2)
    with progress.announced("nothing", patience=30.0):
        pass
    assert terminal.getvalue() == "computing\n"
    ehd.show_progress(False)
    with progress.announced("computing", patience=0.01):
        time.sleep(0.05)
    assert terminal.getvalue() == "computing\n"


def test_durations_and_long_lines(terminal):
    assert [progress._duration(s) for s in (45.2, 200.0, 7500.0)] == ["45 s", "3 min 20 s", "2 h 5 min"]
    line = progress.Progress("x")
    line.step(0.5, lambda _: "y" * 200)
    assert len(terminal.getvalue()) == 120
    with pytest.raises(ehd.InputError, match="True, False or None"):
        ehd.show_progress("yes")
