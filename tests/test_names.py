"""The package as a user sees it: names, objects in one line, and arguments as Exudyn and matplotlib have them."""

import pathlib
import subprocess
import sys

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid
from matplotlib.figure import Figure

import exudyn_ehd as ehd

BEARING = ehd.JournalBearing(
    journal_radius=0.025,
    length=0.025,
    radial_clearance=25e-6,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)


def pair():
    """Ground and a body that spins in it."""
    mbs = exu.SystemContainer().AddSystem()
    inertia = InertiaCuboid(density=7800, sideLengths=[0.1] * 3)
    return mbs, [mbs.CreateGround(), mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0, 0, 100.0])]


@pytest.fixture(scope="module")
def run():
    mbs, items = pair()
    joint = ehd.CreateLubricatedJoint(mbs, "main", items, [0, 0, 0], [0, 0, 1], BEARING)
    sensors = [joint.AddSensor("minimum_gap", name="by name"), joint.AddSensor(ehd.Quantity.MINIMUM_GAP)]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 10, 1e-3
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    return mbs, joint, sensors


def test_dir_shows_the_public_names():
    assert set(dir(ehd)) == {*ehd.__all__, "__version__"}
    assert all(hasattr(ehd, name) for name in ehd.__all__)


def test_names_wait_for_their_modules():
    """Importing the package takes nothing but its names."""
    code = (
        "import sys, exudyn_ehd; packages = {'bearing', 'film', 'solid', 'joint', 'pictures', 'coupling', 'studies'};"
        "assert not packages & {m.split('.')[1] for m in sys.modules if m.startswith('exudyn_ehd.')};"
        "from exudyn_ehd import JournalBearing; assert 'exudyn_ehd.solid' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=pathlib.Path(ehd.__file__).parent.parent)


def test_misspelt_names_are_met_with_the_right_one():
    for wrong, right in (("SwiftSteiber", "SwiftStieber"), ("createLubricatedJoint", "CreateLubricatedJoint")):
        with pytest.raises(AttributeError, match=f"did you mean '{right}'"):
            getattr(ehd, wrong)
    with pytest.raises(AttributeError, match=r"'quaternion'$"):
        ehd.quaternion  # noqa: B018


def test_objects_say_in_a_line_what_they_are(run, tmp_path):
    mbs, joint, _ = run
    film = ehd.equilibrium(BEARING, speed=300.0, load=(0.0, -500.0))
    curve = ehd.stribeck(BEARING, load=500.0, speeds=[100.0, 300.0])
    point = ehd.EquilibriumPoint(bearing=BEARING, speed=300.0, load=(0.0, -500.0))
    table = ehd.parameter_study(point, {"viscosity": [0.02]}, show_progress=False)
    grid = ehd.slider_grid(0.1, 0.1, 8, 8)
    slider = ehd.solve_film(grid, np.full(grid.shape, 1e-4), lubricant=BEARING.lubricant, surface_speed=(1.0, 0.0))
    things = (joint, joint.history, joint.film(), joint.audit(), joint.state(), film, film.film)
    for thing in (
        *things,
        joint.history.revolutions(period=5e-4),
        curve,
        table,
        slider,
        ehd.SaveState(mbs, tmp_path / "state.npz"),
    ):
        assert type(thing).__name__ in repr(thing)
        assert len(repr(thing)) <= 300 and "\n" not in repr(thing) and "array(" not in repr(thing)
    gap = 1e6 * film.film.minimum_gap
    assert f"minimum film thickness {gap:.3g} µm" in repr(film.film)
    assert repr(joint).startswith("<LubricatedJoint 'main'")


def test_quantities_have_names(run):
    mbs, joint, sensors = run
    by_name, by_member = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
    assert (by_name == by_member).all()
    with pytest.raises(ehd.InputError, match=r"AddSensor: quantity .* minimum_gap, .* got 'gap'"):
        joint.AddSensor("gap")
    ax = Figure().add_subplot()
    joint.plot_traces("minimum_gap", ax=ax)
    assert len(ax.lines) == 1 and "film" in ax.get_ylabel()


def test_calls_of_exudyns_revolute_joint_can_be_taken_over():
    mbs, items = pair()
    place = {"position": [0, 0, 0], "axis": [0, 0, 1], "useGlobalFrame": True, "show": True}
    drawn = {"axisRadius": 0.1, "axisLength": 0.2, "color": [1.0, 0.0, 0.0, 1.0]}
    with pytest.warns(DeprecationWarning, match="now called itemNumbers"):
        ehd.CreateLubricatedJoint(mbs, name="a", bodyNumbers=items, **place, **drawn, bearing=BEARING)
    with pytest.raises(ehd.InputError, match="not both"):
        ehd.CreateLubricatedJoint(mbs, "b", items, bodyNumbers=items, **place, bearing=BEARING)
    mbs.Assemble()
