"""A run that is interrupted while a film is evaluated leaves a state that can be stored and gone on from."""

import exudyn as exu
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from tests.sampling import sample

IMPLICIT, EXPLICIT = exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.RK44


def system(cavitation):
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=40e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=32, n_z=4),
        cavitation=cavitation,
    )
    mbs = scenes.new_system()
    journal = scenes.add_body(mbs, "Rxyz", spin=(0, 0, 300.0))
    mbs.CreateForce(itemNumber=journal, loadVector=[300.0, -500.0, 0.0])
    joint = ehd.CreateLubricatedJoint(
        mbs, itemNumbers=[mbs.CreateGround(), journal], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint


def run(mbs, solver, last, **options):
    settings = ehd.ConfigureSolver(scenes.settings(last * 2e-5, last), relativeTolerance=1e-9)
    ehd.SolveDynamic(mbs, settings, solverType=solver, **options)


@pytest.mark.parametrize("solver", [IMPLICIT, EXPLICIT], ids=["implicit", "explicit"])
@pytest.mark.parametrize("cavitation", sample([ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)], 1))
@pytest.mark.parametrize("behind", sample([False, True], 1), ids=["before", "behind"])
def test_state_after_an_interrupt_is_stored(cavitation, solver, behind, monkeypatch, tmp_path):
    """Interrupt a run at every evaluation of three steps, before and after the film is solved."""
    mbs, joint = system(cavitation)
    run(mbs, solver, 30)
    whole = joint.history
    for at in range(40, 52):
        mbs, joint = system(cavitation)
        model, calls = joint.element.model, []

        def interrupted(*arguments, evaluate=model.evaluate, calls=calls, at=at):
            calls.append(0)
            if len(calls) == at and not behind:
                raise KeyboardInterrupt
            found = evaluate(*arguments)
            if len(calls) == at:
                raise KeyboardInterrupt
            return found

        monkeypatch.setattr(model, "evaluate", interrupted)
        with pytest.raises(KeyboardInterrupt, match="last accepted state"):
            run(mbs, solver, 30)
        state = ehd.SaveState(mbs, tmp_path / "state.npz")
        rows = state.joints[0].rows
        assert np.all(np.diff(rows[:, 0]) > 0.0)
        n = np.searchsorted(whole.time, state.time - 1e-12) + 1
        np.testing.assert_allclose(joint.history.time, whole.time[:n], rtol=0, atol=1e-15)
        np.testing.assert_allclose(joint.history.force, whole.force[:n], rtol=0, atol=1e-9 * np.abs(whole.force).max())
        if at == 45:
            mbs, joint = system(cavitation)
            settings = ehd.ConfigureSolver(scenes.settings(30 * 2e-5, 30 - (n - 1)), relativeTolerance=1e-9)
            ehd.SolveDynamic(mbs, settings, solverType=solver, restart=tmp_path / "state.npz")
            np.testing.assert_allclose(joint.history.force[-1], whole.force[-1], rtol=1e-6, atol=1e-3)
