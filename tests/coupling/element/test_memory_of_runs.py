"""A film's history follows the state from run to run, whatever the clock shows and whatever is solved in between."""

import warnings

import exudyn as exu
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from tests.sampling import sample

CLEARANCE, STEP, COUNT = 30e-6, 1e-4, 20
EFFECTS = {
    "oil content": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "temperature": {"thermal": ehd.LumpedThermal(supply_temperature=313.15, capacity=5.0)},
    "wear": {
        "asperity": ehd.GreenwoodTripp(composite_roughness=7e-6, composite_modulus=2e10),
        "wear": ehd.ArchardWear(wear_rate=1e-14, acceleration=1e3),
    },
}


def system(what):
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=CLEARANCE,
        lubricant=ehd.oil("ISO VG 32", temperature=313.15),
        film=ehd.FiniteLength(n_theta=32, n_z=4),
        **EFFECTS[what],
    )
    mbs, joint = scenes.loaded_journal(bearing, load=(300.0, -1500.0, 0.0), speed=200.0)
    mbs.Assemble()
    return mbs, joint


def run(mbs, start=0, **options):
    settings = scenes.settings((start + COUNT) * STEP, COUNT)
    settings.timeIntegration.startTime = start * STEP
    ehd.ConfigureSolver(settings)
    with warnings.catch_warnings():
        warnings.simplefilter("error", ehd.MemoryWarning)
        ehd.SolveDynamic(mbs, settings, **({"updateInitialValues": True} | options))


def memory(joint):
    """Everything that the film remembers, in one row."""
    remembered = joint.state().memory
    parts = (remembered.void, remembered.wear, remembered.temperature)
    return np.concatenate([np.ravel(part) for part in parts if part is not None])


def clock_back(mbs):
    run(mbs)


def static_between(mbs):
    """A static solve that fails at once, since nothing holds the spin, and one that moves nothing."""
    with pytest.raises(ehd.EHDError):
        ehd.SolveStatic(mbs, ehd.ConfigureSolver(scenes.settings(1, 1)))
    run(mbs, COUNT)


def linearised_between(mbs):
    mbs.ComputeODE2Eigenvalues(simulationSettings=scenes.settings(1, 1), ignoreAlgebraicEquations=True)
    run(mbs, COUNT)


def solver_not_kept(mbs):
    run(mbs, storeSolver=False)


def long_after(mbs):
    run(mbs, 10**6)


@pytest.mark.parametrize(
    ("again", "what"),
    sample(
        [
            (clock_back, "oil content"),
            (clock_back, "temperature"),
            *(
                (again, "wear")
                for again in (clock_back, static_between, linearised_between, solver_not_kept, long_after)
            ),
        ],
        0,
        1,
        2,
        4,
    ),
)
def test_a_run_goes_on_with_the_film_of_the_end_of_the_last(again, what):
    mbs, joint = system(what)
    run(mbs, storeSolver=again is not solver_not_kept)
    half = memory(joint)
    run(mbs, COUNT)
    expected = memory(joint)
    mbs, joint = system(what)
    run(mbs, storeSolver=again is not solver_not_kept)
    again(mbs)
    # the first step of a run that is no continuation in time takes the velocities as they are
    change = np.abs(expected - half).max()
    assert change > 0.0
    assert np.abs(memory(joint) - expected).max() < 1e-2 * change


def test_a_run_from_an_earlier_start_has_the_film_of_that_start():
    mbs, joint = system("wear")
    run(mbs)
    worn = memory(joint)
    run(mbs, COUNT, updateInitialValues=False)
    first = memory(joint)
    run(mbs, COUNT, updateInitialValues=False)
    np.testing.assert_allclose(memory(joint), first, rtol=0, atol=1e-3 * first.max())
    assert first.max() > worn.max() > 0.0


def test_a_state_from_nowhere_keeps_the_film_and_warns_unless_it_is_forgotten():
    mbs, joint = system("wear")
    run(mbs)
    worn = memory(joint)
    elsewhere = np.array(mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial))
    elsewhere[0] += 0.1 * CLEARANCE
    mbs.systemData.SetODE2Coordinates(elsewhere.tolist(), exu.ConfigurationType.Initial)
    with pytest.warns(
        ehd.MemoryWarning, match=r"'bearing': the run from t = 0 s .* of t = 0.002 s .* joint.forget\(\)"
    ):
        ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(COUNT * STEP, COUNT)))
    kept = memory(joint)
    joint.forget()
    run(mbs)
    new = memory(joint)
    assert np.max(kept - new) > 0.1 * worn.max() > 0.0
    assert np.all(new < kept + 1e-3 * kept.max())
    assert joint.history.time.size == COUNT + 1


def test_stored_memory_is_taken_at_any_time():
    mbs, joint = system("temperature")
    run(mbs)
    state = joint.state()
    joint.forget()
    joint.restore_state(state)
    run(mbs, 7)
    assert joint.history.film_temperature[0] == pytest.approx(state.memory.temperature, rel=1e-9)


@pytest.mark.filterwarnings("ignore:SolveStatic.*balance of heat:UserWarning")
@pytest.mark.parametrize("what", EFFECTS)
def test_a_state_stored_behind_a_static_solve_holds_the_film_of_the_run(what):
    """The static solve fails, since the load has no equilibrium at rest; films are steady in it and learn nothing."""
    mbs, joint = system(what)
    run(mbs)
    expected = memory(joint)
    settings = ehd.ConfigureSolver(scenes.settings(1, 1))
    settings.staticSolver.stabilizerODE2term = 1e12
    with pytest.raises(ehd.EHDError):
        ehd.SolveStatic(mbs, settings)
    # the film is found again, from where the failed solve has left its solver
    np.testing.assert_allclose(memory(joint), expected, rtol=1e-12, atol=1e-13)
