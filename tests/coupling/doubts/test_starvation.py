"""Joints that run dry say so, once; those whose oil comes back, or has hardly left, do not."""

import math
import warnings

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import RigidBodyInertia

import exudyn_ehd as ehd
from exudyn_ehd.coupling import doubts
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

VENTED = ehd.ElrodAdams()
GROOVE = (ehd.AxialGroove(angle=0.5 * math.pi, width_angle=0.4, length=0.04, pressure=1e5),)


def bearing(n_theta=32, **options):
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.05,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=n_theta, n_z=6),
        **options,
    )


def run(end_time=0.1, **options):
    """A journal of 1.5 kg under 8 kN that a flywheel keeps at 300 rad/s; 0.1 s are 4.8 turns."""
    mbs = scenes.new_system()
    journal = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=1.5, inertiaTensor=np.diag([1e-2, 1e-2, 50.0])),
        initialAngularVelocity=[0.0, 0.0, 300.0],
        nodeType=exu.NodeType.RotationRotationVector,
    )
    mbs.CreateForce(itemNumber=journal, loadVector=[2000.0, -8000.0, 0.0])
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="main",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing(**options),
        axial=ehd.Held(),
    )
    mbs.Assemble()
    mbs.SolveDynamic(scenes.settings(end_time, round(4000 * end_time), tolerance=1e-8))
    return joint.history


@pytest.mark.slow
def test_a_film_without_a_source_of_oil_says_when_it_runs_dry():
    with pytest.warns(ehd.StarvationWarning) as told:
        history = run(cavitation=VENTED)
    (text,) = [str(w.message) for w in told]
    assert "'main': at t = " in text
    assert "supply=(AxialGroove(...),)" in text
    time = float(text.split("t = ")[1].split(" s ")[0])
    place = np.hypot(*history.motion[:, :2].T)
    # after one turn; four turns on the journal has sunk on
    assert 0.02 < time < 0.04
    assert place[-1] > 1.2 * place[history.time <= time].max()


@pytest.mark.parametrize(
    ("end_time", "options"),
    sample(
        [
            (0.01, {"cavitation": VENTED}),
            (0.1, {"cavitation": VENTED, "supply": GROOVE}),
            pytest.param(0.1, {"cavitation": VENTED, "end_pressures": (1e4, 0.0)}, marks=pytest.mark.slow),
            pytest.param(0.1, {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)}, marks=pytest.mark.slow),
            (0.1, {}),
        ],
        0,
        2,
    ),
    ids=["short", "groove", "end", "below ambient", "Swift-Stieber"],
)
def test_films_that_keep_their_oil_are_quiet(end_time, options):
    with warnings.catch_warnings():
        warnings.simplefilter("error", ehd.StarvationWarning)
        run(end_time, **options)


@pytest.mark.parametrize("eccentricity", [0.3, 0.6, 0.9])
def test_it_is_seen_before_the_load_has_fallen(eccentricity):
    """And not in a steady film with a supply at the same place, whose cavity is as nature makes it."""
    motion = np.zeros(10)
    motion[0], motion[8] = eccentricity * 25e-6, 300.0
    model = build_model(bearing(cavitation=VENTED))
    history, loads, lost = model.initial_history(motion), [], 0.0
    while lost == 0.0:
        evaluation = model.evaluate(motion, history, 1e-3)
        history = evaluation.history()
        loads.append(math.hypot(*evaluation.wrench[:2]))
        lost = doubts.lost_share(history)
    assert loads[-1] > 0.8 * loads[0]
    for _ in range(60):
        evaluation = model.evaluate(motion, history, 1e-3)
        history = evaluation.history()
    assert math.hypot(*evaluation.wrench[:2]) < 0.75 * loads[0]
    groove = ehd.AxialGroove(angle=math.pi, width_angle=0.4, length=0.04, pressure=1e5)
    supplied = build_model(bearing(cavitation=VENTED, supply=(groove,)))
    assert doubts.lost_share(supplied.evaluate(motion).history()) == 0.0
