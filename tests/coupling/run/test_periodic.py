"""Runs until orbits close: a driven journal under a load that turns and swells with a period."""

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd

PERIOD, STEPS = 0.02, 40
BEARING = ehd.JournalBearing(
    journal_radius=0.025,
    length=0.025,
    radial_clearance=25e-6,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)


def loaded(driven=True, bearing=BEARING):
    """Planar journal; without a drive its friction slows it down."""
    mbs = scenes.new_system()
    journal = mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800, 0.1, 0.025, 2), initialAngularVelocity=[0, 0, 300.0], create2D=True
    )

    def load(mbs, t, vector):
        phase = 2.0 * np.pi * t / PERIOD
        return [3000.0 * (0.6 + 0.4 * np.cos(phase)), 900.0 * np.sin(phase), 0.0]

    mbs.CreateForce(itemNumber=journal, loadVector=[1, 0, 0], loadVectorUserFunction=load)
    if driven:
        items = (mbs.AddNode(eii.NodePointGround()), 0), (mbs.GetObject(journal)["nodeNumber"], 2)
        markers = [mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=n, coordinate=k)) for n, k in items]
        mbs.AddObject(eii.CoordinateConstraint(markerNumbers=markers, velocityLevel=True, offset=300.0))
    joint = ehd.CreateLubricatedJoint(mbs, "main", [mbs.CreateGround(), journal], [0, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    return mbs, joint


def settings(cycles, steps=STEPS):
    return ehd.ConfigureSolver(scenes.settings(cycles * PERIOD, int(cycles * steps)))


@pytest.mark.parametrize("steps", [STEPS, pytest.param(37.3, marks=pytest.mark.slow)])
def test_last_cycle_is_that_of_many_cycles(steps):
    """A whole number of steps in a period, and none; the user's function sees every step and stays."""
    mbs, joint = loaded()
    seen = []
    mbs.SetPostStepUserFunction(lambda mbs, t: not seen.append(t))
    cycle = ehd.SolveDynamic(mbs, settings(40, steps), until_periodic=ehd.UntilPeriodic(period=PERIOD, tolerance=2e-3))
    assert 3 <= cycle.cycles == len(cycle.changes) + 1 < 8 and cycle.left <= 2e-3 and cycle.changes[-1] <= 2e-3
    np.testing.assert_allclose([cycle.start, cycle.end], [(cycle.cycles - 1) * PERIOD, cycle.cycles * PERIOD])
    assert cycle.end <= joint.history.time[-1] < cycle.end + 3 * PERIOD / steps
    assert seen == joint.history.time.tolist() and mbs.GetPostStepUserFunction() != 0
    assert "'main' 10.6 µm" in repr(cycle)
    other, by_hand = loaded()
    ehd.SolveDynamic(other, settings(8))
    late, own = by_hand.history, cycle.histories["main"]
    assert own.time[0] >= cycle.start * (1.0 - 1e-9)
    phases = (own.time - cycle.start) + 7 * PERIOD
    orbit = np.stack([np.interp(phases, late.time, late.eccentricity[:, k]) for k in (0, 1)], axis=1)
    # between its own steps the orbit by hand is a chord
    assert np.abs(orbit - own.eccentricity).max() < (2e-3 if steps == STEPS else 2e-2) * BEARING.radial_clearance


@pytest.mark.slow
def test_orbits_that_do_not_close_are_an_error():
    """A wrong period; and a journal that slows down by 0.4 % a cycle, of which no two cycles in a row tell much."""
    mbs, joint = loaded()
    with pytest.raises(ehd.RunError, match=r"not closed to 0\.01 within 6 cycles of 0\.012 s.*has another period"):
        ehd.SolveDynamic(mbs, settings(4), until_periodic=ehd.UntilPeriodic(period=0.6 * PERIOD))
    assert joint.history.time[-1] == pytest.approx(4 * PERIOD)
    mbs, _ = loaded(driven=False)
    with pytest.raises(ehd.RunError, match="left to the limit"):
        ehd.SolveDynamic(mbs, settings(6), until_periodic=ehd.UntilPeriodic(period=PERIOD))


@pytest.mark.parametrize("sump", [False, True])
def test_a_film_that_warms_up_in_thousands_of_cycles_has_not_closed(sump):
    """Orbits settle in four cycles, in which the film hardly warms up; small heat capacities reach the limit."""
    law = ehd.ReynoldsTemperature(point=(313.15, 0.02), coefficient=0.03)
    warm = {"lubricant": ehd.Lubricant(temperature_law=law)}

    def heated(capacity):
        tank = ehd.Sump(conductance=6.0, ambient=313.15, heat_capacity=capacity, initial_temperature=313.15)
        thermal = {"supply_temperature": tank} if sump else {"supply_temperature": 313.15, "capacity": capacity}
        return dataclasses.replace(BEARING, **warm, thermal=ehd.LumpedThermal(**thermal))

    with pytest.raises(ehd.RunError, match="left to the limit"):
        mbs, _ = loaded(bearing=heated(500.0))
        ehd.SolveDynamic(mbs, settings(15), until_periodic=ehd.UntilPeriodic(period=PERIOD))
    ends = []
    for capacity in (0.1, 0.5):
        mbs, _ = loaded(bearing=heated(capacity))
        cycle = ehd.SolveDynamic(mbs, settings(150), until_periodic=ehd.UntilPeriodic(period=PERIOD))
        ends.append(cycle.histories["main"].film_temperature.mean())
    assert ends[0] > 316.0 and ends[1] == pytest.approx(ends[0], abs=0.02 * (ends[0] - 313.15))


def test_what_can_not_be_meant_is_refused():
    mbs, _ = loaded()
    aim = ehd.UntilPeriodic(period=PERIOD)
    with pytest.raises(ehd.InputError, match="room for three periods"):
        ehd.SolveDynamic(mbs, settings(2), until_periodic=aim)
    with pytest.raises(ehd.InputError, match=r"must be UntilPeriodic\(\.\.\.\) or None"):
        ehd.SolveDynamic(mbs, settings(4), until_periodic=PERIOD)
    with pytest.raises(ehd.InputError, match="period"):
        ehd.UntilPeriodic(period=-1.0)
    with pytest.raises(ehd.InputError, match="tolerance"):
        ehd.UntilPeriodic(period=1.0, tolerance=2.0)
    empty = exu.SystemContainer().AddSystem()
    empty.Assemble()
    with pytest.raises(ehd.InputError, match="no lubricated joints"):
        ehd.SolveDynamic(empty, settings(4), until_periodic=aim)
