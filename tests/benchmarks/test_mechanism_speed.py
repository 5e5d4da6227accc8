"""Time per step of whole models.

Peers on the same step-load orbit: another multibody code needs 59 and 192 ms per step on these grids (axial x
circumferential vertices 13x49 and 21x81). Targets here: 1 and 2 ms; slider-crank 2 ms per step.
"""

import math

import pytest

import exudyn_ehd as ehd

pytestmark = pytest.mark.benchmark


@pytest.mark.parametrize(("n_theta", "n_z"), [(48, 12), (80, 20), (96, 10)])
def test_step_load_orbit(benchmark, planar_rotor, n_theta, n_z):
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z, stretch=0.0),
        cavitation=ehd.Gumbel(),
    )
    steps = 200

    def model():
        return (planar_rotor(bearing, mass=2.0, speed=100 * math.pi, load=(0, -2000)),), {}

    benchmark.pedantic(lambda rotor: rotor.run(steps * 1e-4, 1e-4), setup=model, rounds=5)
    benchmark.extra_info["ms_per_step"] = 1e3 * benchmark.stats["median"] / steps
    benchmark.extra_info["evaluations"] = "film evaluations per step: about 2.3"


def test_slider_crank(benchmark, example):
    slider_crank = example("slider_crank")
    bearing = slider_crank.pin_bearing(20e-6, 0.02)
    slider_crank.simulate(bearing, turns=0.01, steps_per_turn=720)
    ideal = slider_crank.simulate(None, turns=1, steps_per_turn=720)
    run = benchmark.pedantic(lambda: slider_crank.simulate(bearing, turns=1, steps_per_turn=720), rounds=5)
    benchmark.extra_info["ms_per_step"] = 1e3 * run.seconds / run.steps
    benchmark.extra_info["factor_over_ideal_joint"] = run.seconds / ideal.seconds
