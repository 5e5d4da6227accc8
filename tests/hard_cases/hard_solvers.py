"""Hard cases of Exudyn's solvers: coarse and fine steps, explicit and implicit, restarts."""

from __future__ import annotations

import pathlib
import tempfile

import exudyn as exu
import numpy as np
from hard_registry import hard_case
from hard_scene import CLEARANCE, SPEED, Rotor, bearing

import exudyn_ehd as ehd


@hard_case("coarse steps", rejected=60, slow=True)
def coarse():
    """Steps of 5 ms where the film responds within 0.05 ms: Newton would converge all the same, to another motion."""
    made = bearing()
    load = (0.0, -5000.0)
    fine = Rotor(made, load=load).run(0.05, 2e-5)
    plain = Rotor(made, load=load).run(0.05, 5e-3)
    watched = Rotor(made, load=load, step_control=ehd.StepControl(largest_gap_change=0.05)).run(0.05, 5e-3)

    def error(run):
        h = run.history
        path = np.column_stack([np.interp(h.time, fine.history.time, fine.history.eccentricity[:, k]) for k in (0, 1)])
        return np.abs(h.eccentricity - path).max() / CLEARANCE

    # without a control the path is another one; with it, the run refines its own steps
    assert error(plain) > 0.02
    assert error(watched) < 0.005
    assert watched.rejected > plain.rejected
    assert watched.steps < 0.1 * fine.steps
    return fine, plain, watched


@hard_case("fine steps", slow=True)
def fine():
    """Steps of a ten-millionth of a second: nothing moves within one, and rates are differences of next to nothing."""
    made = bearing()
    coarse = Rotor(made, load=(0.0, -1000.0)).run(2e-4, 5e-6)
    fine = Rotor(made, load=(0.0, -1000.0)).run(2e-4, 2e-7)
    h = fine.history
    assert h.time.size == 1001
    assert np.abs(h.eccentricity[-1] - coarse.history.eccentricity[-1]).max() < 1e-4 * CLEARANCE
    # smooth: neighbouring forces differ by next to nothing
    assert np.abs(np.diff(h.force[2:, 1])).max() < 0.01 * h.force[:, 1].max()
    return coarse, fine


@hard_case("explicit solver", newton=2.0, slow=True)
def explicit():
    """RK44 has no Newton and no second try: the force alone must be smooth and unique."""
    made = bearing()
    rotors = [Rotor(made, load=(0.0, -500.0), speed=None, spin=SPEED) for _ in range(2)]
    implicit = rotors[0].run(0.01, 1e-5)
    run = rotors[1].run(0.01, 1e-5, solver=exu.DynamicSolverType.RK44)
    a, b = run.history, implicit.history
    assert a.time.size == b.time.size == 1001
    # the implicit integrator's own error, second order, with a numerical damping of 0.8
    assert np.abs(a.eccentricity - b.eccentricity).max() < 2e-3 * CLEARANCE
    return implicit, run


@hard_case("explicit solver that loses its film", rejected=1, newton=0.5)
def explicit_fails():
    """A step too coarse for an explicit solver: it can't reject it, and must not go on with what is not a number."""
    rotor = Rotor(bearing(), load=lambda t: (0.0, -5e7 * t), speed=None, spin=SPEED)
    # stable in the centre, where damping over mass is 3e4 1/s, not where the film is thin
    run = rotor.run(0.02, 2.5e-5, solver=exu.DynamicSolverType.RK44, fails=True)
    text = str(run.error)
    assert "rotor bearing" in text and "t = " in text
    assert run.history.time.size > 10
    assert run.history.largest_eccentricity_ratio.max() < 1.0
    return run


@hard_case("full and modified Newton", newton=6.0, slow=True)
def newtons():
    """A kept Jacobian of a film that stiffens a hundredfold on the way: more iterations, the same motion."""
    made = bearing()
    runs = [
        Rotor(made, load=(0.0, -5000.0)).run(0.02, 1e-4, useModifiedNewton=modified, relativeTolerance=1e-8)
        for modified in (False, True)
    ]
    full, modified = (run.history for run in runs)
    assert full.time.size == modified.time.size
    # both stop at 1e-8 of the residual
    assert np.abs(full.eccentricity - modified.eccentricity).max() < 1e-6 * CLEARANCE
    assert np.allclose(full.force, modified.force, rtol=0.0, atol=0.5)
    return runs


@hard_case("index-2 trapezoidal rule", slow=True)
def trapezoidal():
    """No numerical damping at all, with the drive as velocity constraint."""
    made = bearing()
    one = Rotor(made, load=(0.0, -1000.0)).run(0.05, 1e-4)
    two = Rotor(made, load=(0.0, -1000.0)).run(0.05, 1e-4, solver=exu.DynamicSolverType.TrapezoidalIndex2)
    eq = ehd.equilibrium(made, speed=SPEED, load=(0.0, -1000.0))
    for run in (one, two):
        assert np.hypot(*(run.history.eccentricity[-1] - eq.position)) < 0.02 * CLEARANCE
    assert np.abs(one.history.eccentricity - two.history.eccentricity)[50:].max() < 5e-3 * CLEARANCE
    return one, two


@hard_case("film that is not finite", rejected=30)
def not_finite():
    """A load that turns into nan in the middle of a run: named as such, not as
    a film's failure, with all steps before it kept."""
    made = bearing()
    rotor = Rotor(made, load=lambda t: (0.0, -500.0 if t < 5e-3 else float("nan")))
    run = rotor.run(0.02, 1e-4, fails=True)
    assert "not finite" in str(run.error)
    assert "masses and loads" in str(run.error)
    assert abs(run.history.time[-1] - 5e-3) < 2e-4
    return run


@hard_case("restart from a stored state", slow=True)
def restart():
    """Stopped in the middle of a swinging load, written to a file and taken up
    by a new system: nothing may remember the stop."""
    made = bearing(cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))

    def rotor():
        return Rotor(made, load=lambda t: (500.0 * np.sin(300.0 * t), -1500.0))

    whole = rotor().run(0.03, 1e-4, relativeTolerance=1e-9)
    first = rotor()
    half = first.run(0.0123, 1e-4, relativeTolerance=1e-9)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "state.npz"
        ehd.SaveState(first.mbs, path)
        rest = rotor().run(0.03, 1e-4, start=0.0123, relativeTolerance=1e-9, restart=path)
    a, b = whole.history, rest.history
    assert a.time.size == b.time.size == 301
    # times that sum up differently in their last bit, and Newton's tolerance
    assert np.abs(a.motion - b.motion).max(axis=0)[:2].max() < 1e-9 * CLEARANCE
    assert np.abs(a.force - b.force).max() < 1e-7 * np.abs(a.force).max()
    assert np.array_equal(b.force[:124], half.history.force)
    return whole, half, rest
