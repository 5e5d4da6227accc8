"""Film models other than `FiniteLength` in an Exudyn run: a rotor dropped into its bearing, guided against tilt."""

from __future__ import annotations

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from tests.sampling import sample

STEPS = 400


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path_factory.getbasetemp() / "maps"))


def _run(make_bearing, **options):
    """Position (2,) of the journal after 10 ms in clearances, and the mean number of Newton iterations."""
    bearing = make_bearing(**options)
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    journal = mbs.CreateRigidBody(
        inertia=InertiaCuboid(7800.0, [0.05, 0.05, 0.05]),
        initialAngularVelocity=[0.0, 0.0, 150.0],
        gravity=[0.0, -9810.0, 0.0],
    )
    mbs.CreateGenericJoint(itemNumbers=[journal, ground], position=[0, 0, 0], constrainedAxes=[0, 0, 1, 1, 1, 0])
    ehd.CreateLubricatedJoint(mbs, itemNumbers=[ground, journal], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing)
    mbs.Assemble()
    s = exu.SimulationSettings()
    s.timeIntegration.endTime, s.timeIntegration.numberOfSteps = 0.01, STEPS
    s.timeIntegration.verboseMode = 0
    s.timeIntegration.newton.useModifiedNewton = False
    s.solution.file.write = False
    assert mbs.SolveDynamic(s)
    position = mbs.GetObjectOutputBody(journal, exu.OutputVariableType.Position, [0, 0, 0])[:2]
    return np.array(position) / bearing.radial_clearance, mbs.sys["dynamicSolver"].it.newtonStepsCount / STEPS


@pytest.mark.slow
def test_impedance_map_runs_as_its_film(make_bearing, measured):
    mapped, steps = _run(make_bearing, film=ehd.ImpedanceMap())
    film, film_steps = _run(make_bearing, film=ehd.FiniteLength(n_theta=320))
    # The map's error is 1e-5 in the median.
    measured("position / c", np.abs(mapped - film).max(), 1e-4)
    assert steps <= film_steps + 0.2


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    sample(
        [
            {"film": ehd.ClassicSOR(n_theta=64, n_z=12, tolerance=1e-10), "cavitation": ehd.Gumbel()},
            {"cavitation": ehd.ElrodAdams(), "supply": (ehd.AxialGroove(angle=0.0, width_angle=0.3, pressure=1e5),)},
            {"supply": (ehd.CircumferentialGroove(width=0.008, pressure=1e5),)},
        ],
        1,
    ),
    ids=["classic", "mass-conserving with groove", "circumferential groove"],
)
def test_newton_needs_as_few_steps_as_the_plain_film(make_bearing, measured, options):
    """The exact tangent holds Newton's iterations at those of the plain film.

    At 25 us per step. At 100 us the plain film takes 3.8 and the mass-conserving one 6.8, because more vertices change
    between full and cavitated within a step.
    """
    _, plain = _run(make_bearing, cavitation=ehd.Gumbel() if "film" in options else ehd.SwiftStieber())
    position, steps = _run(make_bearing, **options)
    assert np.linalg.norm(position) < 1.0
    measured("Newton iterations per step", steps, plain + 0.5)


@pytest.mark.slow
def test_long_bearing_runs(make_bearing):
    """Sealed and several times as stiff as the other films."""
    groove = (ehd.AxialGroove(angle=0.0, width_angle=0.3),)
    position, _ = _run(make_bearing, film=ehd.LongBearing(n_theta=96), supply=groove)
    assert np.linalg.norm(position) < 1.0
