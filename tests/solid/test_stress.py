"""Stress recovery at nodes and points."""

import numpy as np
import pytest

from exudyn_ehd.solid.elements.element import HEX20
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, StressRecovery, von_mises
from exudyn_ehd.status import InputError

MATERIAL = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
MESH = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=2, radial=2, circumferential=16).mesh()
RECOVERY = StressRecovery(mesh=MESH, material=MATERIAL)


def test_von_mises_of_uniaxial_shear_and_hydrostatic_stress():
    stress = np.zeros((3, 3, 3))
    stress[0, 0, 0] = -4.0
    stress[1, 0, 1] = stress[1, 1, 0] = 2.0
    stress[2] = 5 * np.eye(3)
    assert np.allclose(von_mises(stress), [4.0, 2 * np.sqrt(3), 0.0], atol=1e-14)


def test_finite_uniaxial_stretch_has_the_closed_cauchy_stress():
    stretch = 1.3
    u = MESH.nodes * [stretch - 1, 0, 0]
    lam, mu = MATERIAL.lame
    strain = (stretch**2 - 1) / 2
    # S = ((lam + 2 mu) E, lam E, lam E); sigma = F S F^T / det F
    expected = np.diag([stretch * (lam + 2 * mu) * strain, lam * strain / stretch, lam * strain / stretch])
    points = RECOVERY.locate(np.array([[0.25, 0.0, 0.01], [-0.1, 0.23, -0.05]]))
    assert np.allclose(RECOVERY.cauchy_at(points, u), expected, rtol=1e-10)
    assert np.allclose(RECOVERY.cauchy_at_nodes(u), expected, atol=1e-9 * expected.max())


def test_located_points_map_back_to_their_positions():
    random = np.random.default_rng(15)
    theta, r, z = random.uniform(0, 7, 40), random.uniform(0.226, 0.274, 40), random.uniform(-0.1, 0.1, 40)
    positions = np.stack([r * np.cos(theta), r * np.sin(theta), z], axis=1)
    points = RECOVERY.locate(positions)
    nodes = MESH.nodes[MESH.elements[points.element]]
    assert np.allclose(np.einsum("na,nai->ni", HEX20.shapes(points.natural)[0], nodes), positions, atol=1e-13)
    with pytest.raises(InputError, match="must lie inside the solid, got"):
        RECOVERY.locate(np.array([[0.0, 0.0, 0.0]]))


def test_stress_at_a_node_from_one_element_meets_the_averaged_one_for_a_smooth_field():
    u = 1e-4 * np.stack([MESH.nodes[:, 0] * MESH.nodes[:, 2], MESH.nodes[:, 1] ** 2, MESH.nodes[:, 2] * 0], axis=1)
    node = MESH.bore.nodes[5]
    points = RECOVERY.locate(MESH.nodes[[node]])
    at_node = RECOVERY.von_mises_at_nodes(u)[node]
    # a quadratic displacement on a curved mesh: both are approximations, of third order
    assert RECOVERY.von_mises_at(points, u)[0] == pytest.approx(at_node, rel=0.05)
