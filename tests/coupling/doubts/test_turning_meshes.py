"""Finite elements on absolute coordinates that a step turns too far warn, once; rigid ones and fine steps do not."""

import warnings

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from bodies import section
from turning import BEARING, free_ring, spinning_ring

import exudyn_ehd as ehd
from exudyn_ehd.coupling.doubts import largest_turn, lost_in_a_turn

SPEED = 300.0


def ring_journal():
    return spinning_ring(SPEED)[0]


def ring_housing():
    return spinning_ring(SPEED, "housing")[0]


def beam():
    """A free ANCF beam along x."""
    mbs = scenes.new_system()
    nodes = [
        mbs.AddNode(
            eii.NodePointSlope23(
                referenceCoordinates=[x, 0, 0, 0, 1, 0, 0, 0, 1],
                initialVelocities=[0, 0, 0, 0, 0, SPEED, 0, -SPEED, 0],
            )
        )
        for x in (-0.1, 0.1)
    ]
    body = mbs.AddObject(eii.ObjectANCFBeam(nodeNumbers=nodes, length=0.2, sectionData=section()))
    items = [mbs.CreateGround(), mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body))]
    ehd.CreateLubricatedJoint(mbs, name="film", itemNumbers=items, position=[], axis=[1, 0, 0], bearing=BEARING)
    mbs.Assemble()
    return mbs


def rigid():
    mbs, _ = scenes.loaded_journal(BEARING, [0.0, 0.0, 0.0], SPEED)
    mbs.Assemble()
    return mbs


def turn(mbs, per_turn, steps, radius=0.6):
    settings = scenes.settings(steps * 2.0 * np.pi / (per_turn * SPEED), steps, tolerance=1e-8)
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    ehd.SolveDynamic(mbs, settings)


@pytest.mark.parametrize("make", [ring_journal, ring_housing, beam])
def test_meshes_at_twenty_steps_a_turn_warn_once(make):
    mbs = make()
    with pytest.warns(ehd.RingingWarning) as told:
        turn(mbs, 20, 4)
    (text,) = [str(w.message) for w in told]
    first = 2.0 * np.pi / (20 * SPEED)
    assert f"'film': in the step to t = {first:.9g} s" in text
    # the first step takes the nodes along a line
    assert float(text.split("turn by ")[1].split(" rad")[0]) == pytest.approx(2.0 * np.pi / 20, rel=0.05)
    assert "of its angular momentum in the first turn; " in text
    assert "take 37 steps a turn or more" in text


@pytest.mark.parametrize(
    ("make", "per_turn", "radius"),
    [(ring_journal, 80, 0.6), (ring_housing, 80, 0.6), (beam, 80, 0.6), (ring_journal, 60, 0.6), (rigid, 20, 0.6)],
)
def test_fine_steps_and_rigid_bodies_say_nothing(make, per_turn, radius):
    mbs = make()
    with warnings.catch_warnings():
        warnings.simplefilter("error", ehd.RingingWarning)
        turn(mbs, per_turn, 4, radius)


def test_little_damping_wants_more_steps():
    with pytest.warns(ehd.RingingWarning, match=r"vibrations of its elements grow.* take 79 steps a turn"):
        turn(ring_journal(), 60, 4, radius=0.9)
    assert largest_turn(1.0) == pytest.approx(2.0 * np.pi / 200)


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "per_turn"), [(0.0, 80), (0.3, 60), (0.6, 40), (0.8, 40), (0.9, 80)])
def test_loss_in_the_first_turn(radius, per_turn, measured):
    mbs = scenes.new_system()
    ring = free_ring(mbs, SPEED)
    mbs.Assemble()
    first = ring.momentum()[1][2]
    turn(mbs, per_turn, per_turn, radius)
    lost = 1.0 - ring.momentum()[1][2] / first
    measured("loss", abs(lost / (lost_in_a_turn(radius) * (2.0 * np.pi / per_turn) ** 2) - 1.0), 0.15)
