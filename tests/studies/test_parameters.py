"""Studies over parameters: the table holds what single calls give, wherever they ran; failures stay in their rows."""

import contextlib
import csv
import dataclasses
import json
import logging
import math
import multiprocessing
import os
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.status import EHDError, InputError

# Python 3.12 on warns when a process with threads (linear algebra has some) is copied
pytestmark = pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")

PARAMETERS = {"radial_clearance": [20e-6, 30e-6], "viscosity": [0.01, 0.02, 0.04]}


@pytest.fixture(scope="module")
def point(make_bearing):
    return ehd.EquilibriumPoint(
        bearing=make_bearing(film=ehd.FiniteLength(n_theta=48, n_z=6)), speed=300.0, load=(0.0, -2000.0)
    )


@pytest.fixture(scope="module")
def table(point):
    return ehd.parameter_study(point, PARAMETERS, show_progress=False)


def test_rows_are_single_calls_in_order(point, table):
    assert len(table) == 6 and table.parameters == ("radial_clearance", "viscosity") and table.shape == (2, 3)
    k = 0
    for c in PARAMETERS["radial_clearance"]:
        for mu in PARAMETERS["viscosity"]:
            assert table["radial_clearance"][k] == c and table["viscosity"][k] == mu
            eq = ehd.equilibrium(
                ehd.varied(point.bearing, {"radial_clearance": c, "viscosity": mu}), speed=300.0, load=(0, -2000)
            )
            assert table["minimum_gap"][k] == eq.film.minimum_gap
            assert table["critical_mass"][k] == eq.critical_mass
            k += 1
    # thicker oil carries on a thicker film
    assert np.all(np.diff(table.grid("minimum_gap"), axis=1) > 0.0)
    with pytest.raises(KeyError, match=r"no column .minimum_film.; it has .*minimum_gap"):
        table.grid("minimum_film")
    assert np.all(table["seconds"] > 0.0)


def test_processes_give_the_same_table(point, table, capfd):
    parallel = ehd.parameter_study(point, PARAMETERS, processes=2, show_progress=True)
    for name in table.columns:
        if name != "seconds":
            np.testing.assert_array_equal(parallel[name], table[name])
    lines = [line for line in capfd.readouterr().out.splitlines() if line.startswith("[")]
    assert sorted(line.split("]")[0] for line in lines) == [f"[{k}/6" for k in range(1, 7)]
    assert all("viscosity = " in line and ": done (" in line for line in lines)


def test_speed_and_load_are_parameters(point):
    table = ehd.parameter_study(point, {"speed": [200.0, 400.0], "load": [1000.0]}, show_progress=False)
    eq = ehd.equilibrium(point.bearing, speed=400.0, load=(0.0, -1000.0))
    assert table["eccentricity_ratio"][1] == pytest.approx(eq.eccentricity_ratio, rel=1e-12)
    # the load's direction stays
    assert table["attitude_angle"][1] == pytest.approx(eq.attitude_angle, rel=1e-12)


def settling(parameters):
    """A journal falls into its film for 2 ms, in an Exudyn model of its own."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    body = mbs.CreateRigidBody(
        inertia=InertiaCylinder(density=7800.0, length=0.1, outerRadius=0.025, axis=2),
        initialAngularVelocity=[0.0, 0.0, 300.0],
        gravity=[0.0, -500.0, 0.0],
        nodeType=exu.NodeType.RotationRotationVector,
    )
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.05,
        radial_clearance=parameters["radial_clearance"],
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        itemNumbers=[mbs.CreateGround(), body],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing,
        axial=ehd.Held(),
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 2e-3, 10
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    mbs.SolveDynamic(settings)
    return {"minimum_gap": joint.history.minimum_gap[-1], "steps": len(joint.history.time) - 1}


# the workers find this test module only if they are copies of this process
@pytest.mark.skipif(multiprocessing.get_start_method() != "fork", reason="needs processes that are forks")
def test_exudyn_models_run_in_processes(caplog):
    """Their runs log no lines."""
    caplog.set_level(logging.INFO, logger="exudyn_ehd")
    parameters = {"radial_clearance": [20e-6, 40e-6]}
    here = ehd.parameter_study(settling, parameters, show_progress=False)
    there = ehd.parameter_study(settling, parameters, processes=2, show_progress=False)
    np.testing.assert_array_equal(here["steps"], 10)
    np.testing.assert_array_equal(here["minimum_gap"], there["minimum_gap"])
    assert here["minimum_gap"][0] < here["minimum_gap"][1]
    assert not caplog.records


def stubborn(parameters):
    """Fails at x = 2."""
    if parameters["x"] == 2:
        raise ehd.FilmError("no film\nthere")
    return {"square": parameters["x"] ** 2, "kind": type(parameters["x"]) is int}


def test_a_failure_stays_in_its_row(tmp_path):
    table = ehd.parameter_study(stubborn, {"x": [1, 2, 3]}, units={"square": "m2"}, show_progress=False)
    np.testing.assert_array_equal(table["square"], [1.0, np.nan, 9.0])
    assert table.errors == ("", "FilmError: no film there", "")
    assert table["kind"][0] == 1.0, "integers stay integers"
    table.to_csv(tmp_path / "study.csv")
    with open(tmp_path / "study.csv", newline="", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    assert head == ["x", "square [m2]", "kind", "seconds [s]", "error"]
    assert [float(row[1]) for row in rows] == pytest.approx([1.0, np.nan, 9.0], nan_ok=True)
    assert rows[1][-1] == "FilmError: no film there"
    assert str(table).splitlines()[2].endswith("FilmError: no film there")
    with pytest.raises(EHDError, match="all 1 rows failed, the first with FilmError: no film there"):
        ehd.parameter_study(stubborn, {"x": [2]}, show_progress=False)


def test_numbers_alone_become_a_column():
    table = ehd.parameter_study(lambda p: 2.0 * p["x"], {"x": (1.0, 2.5)}, show_progress=False)
    np.testing.assert_array_equal(table["value"], [2.0, 5.0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"parameters": {}}, "parameters is empty"),
        ({"parameters": {"x": 3.0}}, "names and lists of numbers, got 'x': 3.0"),
        ({"parameters": {"x": ["a"]}}, r"got 'x': \['a'\]"),
        ({"function": lambda p: 1.0, "processes": 2}, "can't be sent to other processes"),
        ({"function": lambda p: "three"}, "must return a number or a dict of numbers"),
        ({"function": lambda p: {"x": 1.0}}, "results named as parameters, got x"),
        ({"mpi": True}, r"mpi and hosts are not supported.*executor=mpi4py.futures.MPIPoolExecutor\(\)"),
        ({"hosts": ("there",)}, r"executor=dask.distributed.Client\(...\).get_executor\(\) for hosts"),
        ({"processes": 0}, "processes must be an integer >= 1"),
        ({"executor": 4}, "executor must have a method submit.*got 4"),
        ({"executor": ThreadPoolExecutor(1)}, "executor must compute in processes, got ThreadPoolExecutor"),
        ({"executor": ThreadPoolExecutor(1), "processes": 2}, "only one of processes and executor"),
        ({"executor": ProcessPoolExecutor(1), "function": lambda p: 1.0}, "can't be sent to other processes"),
    ],
)
def test_input_is_checked(change, message):
    arguments = {"function": stubborn, "parameters": {"x": [1]}, "show_progress": False} | change
    with pytest.raises(EHDError, match=message):
        ehd.parameter_study(arguments.pop("function"), arguments.pop("parameters"), **arguments)


class Deferred:
    """Executor that returns futures of its own kind, as a dask Client does."""

    def submit(self, function, *arguments):
        return function, arguments


def test_futures_of_another_kind_are_refused():
    with pytest.raises(InputError, match=r"futures of concurrent.futures.*client.get_executor"):
        ehd.parameter_study(stubborn, {"x": [1]}, executor=Deferred())


@pytest.mark.skipif(multiprocessing.get_start_method() != "fork", reason="needs processes that are forks")
def test_an_executor_gives_the_same_table_and_stays_open(point, table):
    with ProcessPoolExecutor(2) as pool:
        for _ in range(2):
            found = ehd.parameter_study(point, PARAMETERS, executor=pool, show_progress=False)
            for name in table.columns:
                if name != "seconds":
                    np.testing.assert_array_equal(found[name], table[name])
    with pytest.raises(EHDError, match=r"all 6 rows failed.*cannot schedule new futures after shutdown"):
        ehd.parameter_study(point, PARAMETERS, executor=pool, show_progress=False)


@pytest.mark.skipif(multiprocessing.get_start_method() != "fork", reason="needs processes that are forks")
def test_a_broken_executor_leaves_what_it_has_finished(tmp_path):
    """The pool breaks with its process: the row says so, the file keeps the rest, and the next executor goes on."""
    file, x = tmp_path / "rows.jsonl", [1, 4, 5, 2]
    with ProcessPoolExecutor(1) as pool:
        table = ehd.parameter_study(deadly, {"x": x}, executor=pool, file=file, show_progress=False)
        np.testing.assert_array_equal(table["value"], [1.0, 16.0, 25.0, np.nan])
        assert table.errors[3].startswith("BrokenProcessPool: ")
        again = ehd.parameter_study(deadly, {"x": [*x, 6]}, executor=pool, file=file, show_progress=False)
        assert again.errors[4].startswith("BrokenProcessPool: ")
    # processes of the study's own go on from there, too
    more = ehd.parameter_study(deadly, {"x": [*x[:3], 6]}, processes=2, file=file, show_progress=False)
    np.testing.assert_array_equal(more["value"], [1.0, 16.0, 25.0, 36.0])


class Watched(ProcessPoolExecutor):
    """Knows the futures that it has handed out."""

    def submit(self, function, *arguments):
        self.futures = [*getattr(self, "futures", ()), super().submit(function, *arguments)]
        return self.futures[-1]


def slow(parameters):
    time.sleep(0.05)
    return parameters["x"]


@pytest.mark.skipif(multiprocessing.get_start_method() != "fork", reason="needs processes that are forks")
def test_an_interrupted_study_cancels_its_rows(tmp_path, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("exudyn_ehd.studies.parameters.RowFile.add", stop)
    with Watched(1) as pool:
        with pytest.raises(KeyboardInterrupt):
            ehd.parameter_study(
                slow, {"x": list(range(40))}, executor=pool, file=tmp_path / "rows.jsonl", show_progress=False
            )
        assert sum(future.cancelled() for future in pool.futures) > 30


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["loky", "dask", "mpi4py.futures"])
def test_executors_of_other_packages(kind, point, table):
    """Executors of packages that are no extras of this one; skipped unless they are installed."""
    with contextlib.ExitStack() as open_ones:
        if kind == "loky":
            pool = pytest.importorskip("loky").ProcessPoolExecutor(2)
        elif kind == "dask":
            distributed = pytest.importorskip("distributed")
            client = distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None)
            pool = open_ones.enter_context(client).get_executor()
        else:
            pool = pytest.importorskip("mpi4py.futures", exc_type=(ImportError, RuntimeError)).MPIPoolExecutor(2)
        with pool:
            found = ehd.parameter_study(point, PARAMETERS, executor=pool, show_progress=False)
    for name in table.columns:
        if name != "seconds":
            np.testing.assert_array_equal(found[name], table[name])


def test_unknown_parameters_are_named(make_bearing):
    with pytest.raises(InputError, match=r"must be among journal_radius.*got width"):
        ehd.varied(make_bearing(), {"width": 0.1})


def deadly(parameters):
    """End the process at x = 2."""
    if parameters["x"] == 2:
        os._exit(7)
    return parameters["x"] ** 2


@dataclasses.dataclass
class Counted:
    """Writes down every call; fails at x = 2 as long as it shall."""

    log: str
    fails: Path
    weights: np.ndarray = dataclasses.field(default_factory=lambda: np.ones(2000))

    def __call__(self, parameters):
        with open(self.log, "a") as file:
            file.write(f"{parameters['x']}\n")
        if parameters["x"] == 2 and self.fails.exists():
            raise ehd.FilmError("no film")
        return {"square": parameters["x"] ** 2, "nothing": math.nan}


@pytest.mark.parametrize("processes", [1, 2])
def test_a_second_call_computes_what_is_missing(tmp_path, processes):
    log, file, fails = tmp_path / "log", tmp_path / "new" / "study.jsonl", tmp_path / "fails"
    fails.touch()
    log.touch()

    def calls():
        lines = sorted(int(line) for line in log.read_text().split())
        log.write_text("")
        return lines

    def study(values, **options):
        function = Counted(str(log), fails, **options)
        return ehd.parameter_study(function, {"x": values}, processes=processes, file=file, show_progress=False)

    first = study([1, 2, 3])
    assert calls() == [1, 2, 3] and first.errors[1] == "FilmError: no film"
    # a run that was killed while it wrote: the cut line counts as not computed
    text = file.read_text()
    assert text.count("\n") == 3
    file.write_text(text[:-20])
    fails.unlink()
    cut = json.loads(text.splitlines()[-1])["point"]["x"]
    again = study([1, 2, 3, 4])
    assert calls() == sorted({2, cut, 4})
    np.testing.assert_array_equal(again["square"], [1.0, 4.0, 9.0, 16.0])
    assert np.all(np.isnan(again["nothing"])) and np.all(again["seconds"] > 0.0)
    np.testing.assert_array_equal(study([4, 3])["square"], [16.0, 9.0])
    assert calls() == []
    # numpy's text of an array leaves out what lies in its middle
    changed = np.ones(2000)
    changed[1000] = 2.0
    with pytest.raises(InputError, match="rows of another function"):
        study([1], weights=changed)
    file.write_text("something else\n")
    with pytest.raises(InputError, match="holds no rows of a study"):
        study([1])


def test_size_and_direction_of_a_load(point):
    """Sizes are at least 0; a load of size 0 has no direction, and acts along -y where a study gives it a size."""
    still = dataclasses.replace(point, load=(0.0, 0.0))
    assert still({"load": 800.0}) == dataclasses.replace(point, load=(0.0, -1.0))({"load": 800.0})
    with pytest.raises(ehd.InputError, match="EquilibriumPoint: load"):
        point({"load": -800.0})
