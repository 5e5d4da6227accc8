"""Studies over parameters: the table holds what single calls give, wherever they ran; failures stay in their rows."""

import csv
import multiprocessing

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
    assert np.all(table["seconds"] > 0.0)


def test_processes_give_the_same_table(point, table, capfd):
    parallel = ehd.parameter_study(point, PARAMETERS, processes=2)
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
def test_exudyn_models_run_in_processes():
    parameters = {"radial_clearance": [20e-6, 40e-6]}
    here = ehd.parameter_study(settling, parameters, show_progress=False)
    there = ehd.parameter_study(settling, parameters, processes=2, show_progress=False)
    np.testing.assert_array_equal(here["steps"], 10)
    np.testing.assert_array_equal(here["minimum_gap"], there["minimum_gap"])
    assert here["minimum_gap"][0] < here["minimum_gap"][1]


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
        ({"processes": 2, "mpi": True}, "only one of processes, mpi and hosts.*got processes and mpi"),
        ({"processes": 0}, "processes must be an integer >= 1"),
    ],
)
def test_input_is_checked(change, message):
    arguments = {"function": stubborn, "parameters": {"x": [1]}, "show_progress": False} | change
    with pytest.raises(EHDError, match=message):
        ehd.parameter_study(arguments.pop("function"), arguments.pop("parameters"), **arguments)


def test_missing_packages_are_named(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"mpi needs the package mpi4py.*pip install mpi4py"):
        ehd.parameter_study(stubborn, {"x": [1]}, mpi=True)
    with pytest.raises(InputError, match="hosts needs the package dispy"):
        ehd.parameter_study(stubborn, {"x": [1]}, hosts=("localhost",))


def test_unknown_parameters_are_named(make_bearing):
    with pytest.raises(InputError, match=r"must be among journal_radius.*got width"):
        ehd.varied(make_bearing(), {"width": 0.1})
