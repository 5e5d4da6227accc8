"""Time per step of whole models, over that of a film's evaluation with its tangent, in turns.

Peers on the same step-load orbit: another multibody code needs 59 and 192 ms per step on these grids (axial x
circumferential vertices 13x49 and 21x81). Here a step takes two to three evaluations of the film, a tangent or two, and
what Exudyn and the coupling add.
"""

import math
import time

import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.benchmarks.accuracy.costs import effects

pytestmark = pytest.mark.benchmark

SPEED, STEPS, ROUNDS = 100.0 * math.pi, 200, 5


def _evaluations_per_step(run, steps, bearing, speed):
    """Best processor time of a step over that of an evaluation with tangent."""
    model, states = build_model(bearing), effects.orbit(bearing.radial_clearance, speed)
    step = evaluation = math.inf
    for _ in range(ROUNDS):
        evaluation = min(evaluation, effects.block({"": model}, states, 4)[""][0])
        start = time.process_time()
        run()
        step = min(step, (time.process_time() - start) / steps)
    print(f"{1e3 * step:.2f} ms a step, {step / evaluation:.2f} evaluations with tangent")
    return step / evaluation


@pytest.mark.parametrize(("n_theta", "n_z", "limit"), [(48, 12, 7.0), (80, 20, 4.7), (96, 10, 6.8)])
def test_step_load_orbit(planar_rotor, n_theta, n_z, limit):
    """A free body and a film: 5.6, 3.8 and 5.0 evaluations, on a busy machine up to a fifth more."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z, stretch=0.0),
        cavitation=ehd.Gumbel(),
    )

    def run():
        planar_rotor(bearing, mass=2.0, speed=SPEED, load=(0, -2000)).run(STEPS * 1e-4, 1e-4)

    run()
    assert _evaluations_per_step(run, STEPS, bearing, SPEED) < limit


def test_slider_crank(example):
    """Three rigid bodies and a film: 5.1 evaluations."""
    slider_crank = example("slider_crank")
    bearing = slider_crank.pin_bearing(20e-6, 0.02)

    def run():
        slider_crank.simulate(bearing, turns=1, steps_per_turn=720)

    run()
    assert _evaluations_per_step(run, 720, bearing, slider_crank.SPEED) < 6.5
