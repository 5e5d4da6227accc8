"""Loads that are functions of time: their impulse within a step against closed forms."""

import math

import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

from exudyn_ehd.coupling.element.outer_load import BISECTIONS, SAMPLES, LoadFunctions

STEP = 1e-3


def at_fourth_state(load):
    """Functions behind four accepted states of a system with a force along y and a constant one."""
    mbs = scenes.new_system()
    body = mbs.CreateRigidBody(inertia=InertiaCylinder(density=7800.0, length=0.1, outerRadius=0.02, axis=2))
    mbs.CreateForce(itemNumber=body, loadVector=[1.0, 0.0, 0.0])
    mbs.CreateForce(
        itemNumber=body, loadVector=[0.0, 2.0, 0.0], loadVectorUserFunction=lambda m, t, v: [0.0, v[1] * load(t), 0.0]
    )
    mbs.Assemble()
    functions = LoadFunctions(mbs)
    for k in range(4):
        functions.accept(mbs, k * STEP)
    return mbs, functions


def test_a_jump_is_found():
    """Offset 1/2 - u of a jump at any share u of the step, and none before it; tolerance of the bisection.

    The ramp beside it, 2 % of the change, has a variance that adds up to 4 x 2 % to the square of the share in which
    the load changes.
    """
    rng = np.random.default_rng(1)
    for u in rng.uniform(0.0, 1.0, 20):
        mbs, functions = at_fourth_state(lambda t, u=u: 300.0 + 1e4 * t + 500.0 * (t > (3.0 + u) * STEP))
        assert math.isnan(functions.offset(mbs, 3.0 * STEP + 1e-3 * u * STEP)[0])
        offset, lasting = functions.offset(mbs, 4.0 * STEP)
        assert offset == pytest.approx(0.5 - u, abs=1.0 / (SAMPLES * 2**BISECTIONS)) and lasting**2 < 0.08
        place = functions.largest_change(mbs, 4.0 * STEP)[1]
        assert place / STEP - 3.0 == pytest.approx(u, abs=1.0 / (SAMPLES * 2**BISECTIONS))
        functions.accept(mbs, 4.0 * STEP)
        # behind a jump the load keeps to its chord; the place on a straight line is bisected, too
        assert functions.offset(mbs, 5.0 * STEP)[0] == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("u", [0.1, 0.45, 0.8])
def test_a_ramp_and_a_pulse(u):
    """Offset -u/2 of a ramp; impulse w of a pulse of that duration; tolerance of a part of the step."""
    mbs, functions = at_fourth_state(lambda t: max(0.0, t / STEP - 3.0 - u))
    offset, lasting = functions.offset(mbs, 4.0 * STEP)
    assert offset == pytest.approx(-0.5 * u, abs=0.01) and lasting == pytest.approx(1.0 - u, abs=0.05)
    mbs, functions = at_fourth_state(lambda t: float(u < t / STEP - 3.0 < u + 0.15))
    assert math.isnan(functions.offset(mbs, 4.0 * STEP)[0])
    assert functions.largest_change(mbs, 4.0 * STEP)[0] == pytest.approx(0.15, abs=1.0 / SAMPLES)


def test_loads_without_a_jump():
    for load in (lambda t: 5.0, lambda t: 3.0 - 2e4 * t, lambda t: math.sin(2.0 * math.pi * t / (40.0 * STEP))):
        mbs, functions = at_fourth_state(load)
        assert math.isnan(functions.offset(mbs, 4.0 * STEP)[0])
        assert functions.largest_change(mbs, 4.0 * STEP)[0] < 2.1e-3
