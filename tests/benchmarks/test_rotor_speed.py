"""Processor time of a rotor's equilibria over that of its films' evaluations with tangents, in turns."""

import math
import time

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.benchmarks.accuracy.costs import effects

pytestmark = pytest.mark.benchmark

SPEEDS, ROUNDS = np.linspace(300.0, 2200.0, 100), 3


def test_a_hundred_speeds_of_a_rigid_rotor_in_two_films():
    """30 evaluations a speed, of which 4.5 are films with their tangents: 0.9 s in all.

    The rest is Python: differences of the forces of all else, their matrices and their checks.
    """
    bearing = ehd.JournalBearing(
        journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02)
    )
    mbs = exu.SystemContainer().AddSystem()
    shaft = mbs.CreateRigidBody(inertia=InertiaCylinder(7850, 0.4, 0.045, 2), gravity=[0, -9.81, 0])
    ground = mbs.CreateGround()
    for name, z, axial in (("left", -0.15, ehd.Held()), ("right", 0.15, ehd.Free())):
        ehd.CreateLubricatedJoint(mbs, name, [ground, shaft], [0, 0, z], [0, 0, 1], bearing, axial=axial)
    mbs.Assemble()
    ehd.SolveEquilibrium(mbs, SPEEDS[:2])
    model, states = build_model(bearing), effects.orbit(bearing.radial_clearance, 300.0)
    whole = evaluation = math.inf
    for _ in range(ROUNDS):
        evaluation = min(evaluation, effects.block({"": model}, states, 4)[""][0])
        start = time.process_time()
        result = ehd.SolveEquilibrium(mbs, SPEEDS)
        result.campbell()
        whole = min(whole, time.process_time() - start)
    ratio = whole / SPEEDS.size / evaluation
    print(f"{whole:.2f} s, {result.evaluations.mean():.1f} films and {ratio:.1f} evaluations with tangent a speed")
    assert ratio < 40.0
