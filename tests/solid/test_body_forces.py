"""Modes for the inertia of an accelerated housing: the mesh's static response, and what they leave as it is."""

import dataclasses

import numpy as np
import pytest

from exudyn_ehd.solid.hex20 import GAUSS27, shape_functions
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.static_modes import ModalBush, bore_modes
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange, reference_gradients
from exudyn_ehd.solid.vibrations import held_stiffness

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=2, circumferential=16)
BUSH = ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1, dynamics=True)


def inertia_load(mesh, a, alpha, omega):
    """Nodal forces (3 n,) of -rho (a + alpha x X + omega x (omega x X)), 27 points per element."""
    X = mesh.nodes[mesh.elements]
    _, weight = reference_gradients(X, GAUSS27)
    N = shape_functions(GAUSS27.points)
    x = np.einsum("qa,eai->eqi", N, X)
    force = -STEEL.density * (a + np.cross(alpha, x) + np.cross(omega, np.cross(omega, x)))
    out = np.zeros_like(mesh.nodes)
    np.add.at(out, mesh.elements, np.einsum("eq,qa,eqi->eai", weight, N, force))
    return out.ravel()


def radial(modes, u):
    bore = modes.mesh.bore
    direction = bore.positions[:, :2] / np.linalg.norm(bore.positions[:, :2], axis=1)[:, None]
    return np.einsum("ai,ai->a", u.reshape(-1, 3)[bore.nodes, :2], direction)


MOTIONS = {
    "shaken": ([3e4, -1e4, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
    "turning": ([0.0, 0.0, 0.0], [0.0, 0.0, 1e5], [0.0, 0.0, 800.0]),
    "planar": ([1e4, 2e4, 0.0], [0.0, 0.0, -3e5], [0.0, 0.0, -500.0]),
    "axially": ([0.0, 0.0, 2e4], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
    "rocked": ([0.0, 0.0, 0.0], [2e5, -1e5, 0.0], [0.0, 0.0, 0.0]),
    "tumbling": ([1e4, -2e4, 3e4], [1e5, 2e5, -3e5], [400.0, -600.0, 500.0]),
}


@pytest.mark.parametrize("tilted", [True, False])
@pytest.mark.parametrize("motion", MOTIONS)
def test_bore_gives_way_to_accelerations_as_the_mesh_does(motion, tilted, measured):
    if not tilted and motion in ("axially", "rocked", "tumbling"):
        pytest.skip("modes for parallel journals are even in z")
    errors = []
    for body_forces in (False, True):
        modes = bore_modes(dataclasses.replace(BUSH, tilted=tilted, body_forces=body_forces))
        load = inertia_load(modes.mesh, *(np.array(v) for v in MOTIONS[motion]))
        free, _, factor = held_stiffness(TotalLagrange(mesh=modes.mesh, material=STEEL))
        exact = np.zeros(free.size)
        exact[free] = factor.solve(load[free])
        shapes = modes.displacements.reshape(modes.count, -1)
        reduced = (shapes @ load / modes.stiffness) @ shapes
        whole, missing = radial(modes, exact), radial(modes, exact - reduced)
        errors.append(np.linalg.norm(missing) / np.linalg.norm(whole))
    if motion in ("shaken", "planar", "tumbling"):
        assert errors[0] > 0.05
    # half a per cent of every field by itself
    measured("displacement of the bore", errors[1], 5e-3)


@pytest.mark.parametrize("tilted", [True, False])
def test_other_modes_stay_as_they_are(tilted):
    bush = dataclasses.replace(BUSH, tilted=tilted)
    modes, others = bore_modes(bush), bore_modes(dataclasses.replace(bush, body_forces=False))
    k = others.count
    assert 3 <= modes.count - k <= (12 if tilted else 7)
    assert np.array_equal(modes.displacements[:k], others.displacements)
    assert np.array_equal(modes.stiffness[:k], others.stiffness)
    assert np.array_equal(modes.mass[:k, :k], others.mass)
    solid = TotalLagrange(mesh=modes.mesh, material=STEEL)
    u = modes.displacements.reshape(modes.count, -1)
    # rounding, relative to the stiffest mode
    energy = u @ (solid.tangent(np.zeros_like(modes.mesh.nodes)) @ u.T)
    assert np.allclose(energy, np.diag(modes.stiffness), rtol=0, atol=1e-8 * modes.stiffness.max())
    mass = u @ (solid.mass @ u.T)
    assert np.allclose(modes.mass, mass, rtol=0, atol=1e-12 * np.abs(mass).max())
    assert np.array_equal(modes.mass, modes.mass.T)


def test_only_bushes_with_mass_have_them():
    quasi = [bore_modes(dataclasses.replace(BUSH, dynamics=False, body_forces=b)) for b in (True, False)]
    assert quasi[0].count == quasi[1].count < bore_modes(dataclasses.replace(BUSH, body_forces=False)).count


def test_disk_keeps_them_apart(monkeypatch, tmp_path):
    """By all that determines them: mesh and material through the other modes, and the settings of their own."""
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path))
    bore_modes(dataclasses.replace(BUSH, body_forces=False))
    assert len(list(tmp_path.iterdir())) == 2
    first = bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 3
    again = bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 3
    assert np.array_equal(again.displacements, first.displacements) and np.array_equal(again.mass, first.mass)
    monkeypatch.setattr("exudyn_ehd.solid.body_forces.SETTINGS", ("other",))
    bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 4
    heavy = bore_modes(dataclasses.replace(BUSH, material=dataclasses.replace(STEEL, density=2 * 7800.0)))
    assert len(list(tmp_path.iterdir())) == 6
    # twice the load on the same mesh
    single, double = (m.participation()[0] @ (m.participation()[0] / m.stiffness).T for m in (first, heavy))
    assert np.allclose(double, 4.0 * single, rtol=0, atol=1e-9 * np.abs(double).max())
