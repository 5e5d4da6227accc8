"""Energy and momentum of a run: work on the film against heat, elastic and kinetic energy, to the integrator's
order."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from elastic_scene import CYLINDER, STEEL, Scene, bearing
from scenes import settings

import exudyn_ehd as ehd
from tests.sampling import sample

NODAL = ehd.ANCFBush(mesh=CYLINDER, material=STEEL)
ROUND = CYLINDER.mesh()
FOOT = ehd.mesh_from_arrays(
    ROUND.nodes, ROUND.elements, bore_radius=0.03, held=lambda x: (np.hypot(*x[:, :2].T) > 0.0499) & (x[:, 0] > 0.03)
)
BUSHES = {
    "rigid": None,
    "liner": ehd.ElasticLiner(thickness=5e-4, youngs_modulus=1e9),
    "modal": ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2),
    # the film's moment turns it
    "foot": ehd.ModalBush(mesh=FOOT, material=STEEL, tolerance=0.2),
    "nodal": NODAL,
    "damped": dataclasses.replace(NODAL, damping=ehd.Rayleigh(stiffness_time=2e-7)),
}


def run(bush, moving, steps, end=2e-3):
    scene = Scene(bearing(BUSHES[bush]), moving=moving)
    solve = ehd.SolveDynamicSparse if bush in ("nodal", "damped") else None
    scene.run(settings(end, steps, tolerance=1e-9), solve)
    # film force and moment on journal, bush and housing: rounding of sums over the bore's nodes
    assert max(scene.cancelling) < 1e-11
    return scene


def slow(*case):
    return pytest.param(*case, marks=pytest.mark.slow)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bush", "moving", "steps", "least"),
    [
        # second order: a quarter; the first quarter millisecond carries a transient of 0.1 ms, which 2 ms / 80 just
        # resolve
        ("rigid", False, 80, 3.0),
        ("rigid", True, 80, 3.0),
        ("modal", True, 40, 3.0),
        slow("foot", True, 40, 3.0),
        slow("nodal", True, 40, 3.0),
        slow("damped", True, 40, 3.0),
        # the liner's own rate is backward Euler: a half, once its relaxation within some microseconds is resolved
        slow("liner", True, 640, 1.5),
    ],
)
def test_work_on_the_film_is_heat_elastic_and_kinetic_energy_to_the_order_of_the_integrator(bush, moving, steps, least):
    coarse, fine = (run(bush, moving, n).energy_error() for n in (steps, 2 * steps))
    assert coarse < 0.01
    assert fine < coarse / least


@pytest.mark.parametrize(("bush", "steps"), sample([("rigid", 20), ("modal", 20), ("nodal", 10)], 0))
def test_momentum_of_journal_bush_and_an_accelerating_housing_is_the_impulse_of_the_loads(bush, steps):
    linear, angular = run(bush, True, steps, 5e-5 * steps).momentum_errors()
    # trapezoidal rule of the loads' course; spin of 314 rad/s in steps of the integrator, second order (below)
    assert linear < 3e-6
    assert angular < 5e-4


def test_error_of_the_momentum_is_of_second_order():
    coarse, fine = (np.array(run("rigid", True, n).momentum_errors()) for n in (40, 80))
    assert np.all(fine < coarse / 3.5)
