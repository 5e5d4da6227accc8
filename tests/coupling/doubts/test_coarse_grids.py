"""Runs whose film has a pressure peak that the grid does not resolve say so at their end, once."""

import warnings

import scenes

import exudyn_ehd as ehd


def run(load, **grid):
    """Texts of the warnings of a run that starts where the film carries the load."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(**grid),
    )
    mbs, joint = scenes.loaded_journal(bearing, [0.0, -load, 0.0], 300.0)
    mbs.Assemble()
    # an equilibrium warns for itself
    joint.place_in_equilibrium(load=(0.0, -load))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        ehd.SolveDynamic(mbs, scenes.settings(2e-3, 10, tolerance=1e-8))
        joint.history.time.sum()
    return [str(w.message) for w in told if w.category is ehd.GridWarning]


def test_a_run_on_a_coarse_grid_warns_once_with_the_grid_that_does_it():
    (text,) = run(5e4, n_theta=32, n_z=6)
    assert "LubricatedJoint 'bearing': at t = " in text and "at its highest pressure" in text
    columns = int(text.split("n_theta=")[1].split(",")[0])
    assert columns > 32
    assert not run(5e4, n_theta=columns, n_z=6)


def test_a_run_on_the_default_grid_says_nothing():
    assert not run(5e4)
