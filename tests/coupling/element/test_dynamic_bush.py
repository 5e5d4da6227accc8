"""A modal bush with mass in Exudyn: free vibration, Jacobian, energy, slow and fast loads against quasi-static and
nodal bushes."""

from __future__ import annotations

import dataclasses

import exudyn as exu
import numpy as np
import pytest
from elastic_scene import CLEARANCE, CYLINDER, JOURNAL, SPEED, STEEL, Scene, bearing
from scenes import new_system, settings

import exudyn_ehd as ehd

STATIC = ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2)
DYNAMIC = dataclasses.replace(STATIC, dynamics=True)


def soft(bush, modulus, density):
    material = ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=density)
    return dataclasses.replace(bush, material=material)


def test_free_vibration_has_the_reduced_bushs_frequency_and_keeps_its_energy():
    """Trapezoidal rule: the phase moves by 2 atan(omega h / 2) per step, the energy stays."""
    mbs = new_system()
    ground, journal = mbs.CreateGround(), mbs.CreateRigidBody(inertia=JOURNAL)
    # a film without pressure to speak of
    thin = bearing(dataclasses.replace(DYNAMIC, tilted=False), lubricant=ehd.Lubricant(viscosity=1e-15))
    joint = ehd.CreateLubricatedJoint(
        mbs, name="b", itemNumbers=[ground, journal], position=[0, 0, 0], axis=[0, 0, 1], bearing=thin
    )
    modes = joint.element.model.bore.modes
    omega, shapes = modes.vibrations()
    node = joint.element.bore_nodes[0]
    for i in (0, 7):
        start = 1e-7 * shapes[:, i] / np.abs(shapes[:, i]).max()
        mbs.SetNodeParameter(node, "initialCoordinates", start.tolist())
        mbs.Assemble()
        steps, step = 200, 0.1 / omega[i]
        s = settings(steps * step, steps, tolerance=1e-12)
        s.timeIntegration.generalizedAlpha.spectralRadius = 1.0
        s.timeIntegration.generalizedAlpha.computeInitialAccelerations = True
        mbs.SolveDynamic(s)
        q, q_t = (
            np.array(mbs.GetNodeOutput(node, kind))
            for kind in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        )
        phase = steps * 2.0 * np.arctan(0.05)
        # 200 steps of Newton's tolerance
        assert np.allclose(q, start * np.cos(phase), rtol=0, atol=1e-7 * np.abs(start).max())
        energy = q @ (modes.stiffness * q) + q_t @ modes.mass @ q_t
        assert energy == pytest.approx(start @ (modes.stiffness * start), rel=1e-7)


def run(bush, end, steps, radius=0.9, **options):
    scene = Scene(bearing(bush, **options))
    solve = ehd.SolveDynamicSparse if isinstance(bush, ehd.ANCFBush) else None
    s = settings(end, steps, tolerance=1e-9)
    s.timeIntegration.generalizedAlpha.spectralRadius = radius
    scene.run(s, solve)
    return scene


@pytest.mark.slow
def test_slow_load_finds_the_quasi_static_bush():
    """The journal's path differs by the square of the load's frequency over the bush's: in proportion to the density.

    Besides by what the modes of vibrations add to the compliance, which a bush of hardly any mass has too.
    """
    end, steps = 3e-3, 60
    # the start's transient has gone by then
    reference = run(STATIC, end, steps, 0.4).joint.history
    late = reference.time > 2e-3
    densities, motion = np.array([78.0, 7800.0, 31200.0]), []
    for density in densities:
        history = run(soft(DYNAMIC, 2.1e11, density), end, steps, 0.4).joint.history
        motion.append(history.motion[late, :2] / CLEARANCE)
        assert np.allclose(history.peak_pressure[late], reference.peak_pressure[late], rtol=1e-4)
    light, *heavy = motion
    quasi_static = reference.motion[late, :2] / CLEARANCE
    assert np.abs(light - quasi_static).max() < 1e-5
    # (314 rad/s over 2 pi 43 kHz)^2 = 1.3e-6, of a path that film and journal's inertia amplify
    assert np.abs(heavy[0] - quasi_static).max() < 2e-5
    by_mass = [np.abs(path - light).max() for path in heavy] / (densities[1:] - densities[0])
    assert by_mass[1] / by_mass[0] == pytest.approx(1.0, rel=0.1)


@pytest.mark.slow
def test_fast_load_finds_the_nodal_bush():
    """A heavy bush, 4 kHz, shaken by the first 0.4 ms: the nodal bush of the same mesh has all of its inertia."""
    heavy = [soft(bush, 2.1e11, 7.8e5) for bush in (STATIC, DYNAMIC)]
    material = heavy[0].material
    still, moving, nodal = (
        run(bush, 4e-4, 80).joint.history.motion[:, :2]
        for bush in (*heavy, ehd.ANCFBush(mesh=CYLINDER, material=material))
    )
    # measured 4.4e-3 and 2.9e-4
    assert np.abs(still - nodal).max() > 3e-3 * CLEARANCE
    assert np.abs(moving - nodal).max() < 5e-4 * CLEARANCE


def test_steady_films_know_nothing_of_the_mass():
    def solve(bush):
        return ehd.steady(bearing(bush), speed=SPEED, eccentricity_ratio=0.8)

    light, heavy, quasi = (solve(b) for b in (DYNAMIC, soft(DYNAMIC, 2.1e11, 7.8e5), STATIC))
    # modes of either density from eigenvalue solutions of their own: rounding
    assert heavy.peak_pressure == pytest.approx(light.peak_pressure, rel=1e-9)
    # the modes of vibrations add less than the tolerance of the static ones leaves out
    assert light.peak_pressure == pytest.approx(quasi.peak_pressure, rel=0.01)
    assert light.minimum_gap == pytest.approx(quasi.minimum_gap, rel=0.01)
