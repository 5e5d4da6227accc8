"""Consistent nodal forces: resultants, moments, and the tangent of the follower pressure."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_ehd.solid.loads import DeadPressure, FollowerPressure, LineLoad, SurfaceLoad, factor
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.status import InputError

MESH = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=3, radial=1, circumferential=16).mesh()


def test_line_load_has_the_resultant_and_the_quadratic_edge_weights():
    top = MESH.generatrix(MESH.outer, np.pi / 2)
    forces = LineLoad(line=top, force_per_length=(0.0, -1000.0, 5.0)).nodal_forces(MESH)
    assert np.allclose(forces.sum(axis=0), [0, -200, 1], rtol=1e-13)
    one_edge = 200 / 3
    ends = top.nodes[np.abs(np.abs(MESH.nodes[top.nodes, 2]) - 0.1) < 1e-12]
    # int N ds over a quadratic edge: 1/6, 4/6, 1/6
    assert np.allclose(forces[ends, 1], -one_edge / 6, rtol=1e-12)


def test_surface_load_sums_to_traction_times_area():
    area = np.pi * (0.275**2 - 0.225**2)
    forces = SurfaceLoad(surface=MESH.end_high, traction=(1.0, 2.0, 3.0)).nodal_forces(MESH)
    # the area of the parabolic ring errs at fourth order: (pi/16)^4 / 100 ~ 1e-5
    assert np.allclose(forces.sum(axis=0), np.array([1, 2, 3]) * area, rtol=1e-4)


def test_cosine_pressure_has_the_resultant_of_the_integral():
    pressure = DeadPressure(surface=MESH.bore, pressure=2.0, distribution=np.cos(MESH.bore.theta))
    total = pressure.nodal_forces(MESH).sum(axis=0)
    # int p cos(theta) n dA = p pi a L on the solid, outward from the axis; the cosine is interpolated quadratically
    assert total[0] == pytest.approx(2.0 * np.pi * 0.225 * 0.2, rel=1e-3)
    assert np.allclose(total[1:], 0, atol=1e-14)


def test_uniform_pressure_on_the_whole_boundary_is_in_balance():
    closed = MESH.surface(np.arange(len(MESH.nodes)))
    forces = DeadPressure(surface=closed, pressure=7.0).nodal_forces(MESH)
    assert np.allclose(forces.sum(axis=0), 0, atol=1e-14)
    assert np.allclose(np.cross(MESH.nodes, forces).sum(axis=0), 0, atol=1e-14)


def test_follower_pressure_turns_with_the_surface_and_equals_the_dead_one_at_rest():
    follower = FollowerPressure(surface=MESH.bore, pressure=3.0, distribution=1 + 0.3 * MESH.bore.z)
    dead = DeadPressure(surface=MESH.bore, pressure=3.0, distribution=1 + 0.3 * MESH.bore.z)
    rest = follower.forces(MESH.nodes)
    assert np.array_equal(rest, dead.nodal_forces(MESH))
    turn = Rotation.from_rotvec([1.0, 0.2, -0.7]).as_matrix()
    assert np.allclose(follower.forces(MESH.nodes @ turn.T), rest @ turn.T, atol=1e-14)


def test_follower_stiffness_is_the_derivative_of_the_forces():
    follower = FollowerPressure(surface=MESH.bore, pressure=3.0, distribution=1 + 0.3 * MESH.bore.z)
    random = np.random.default_rng(14)
    x = MESH.nodes + 0.01 * random.standard_normal(MESH.nodes.shape)
    direction = random.standard_normal(x.shape)
    slope = (
        follower.forces(x + 0.01 * direction) - follower.forces(x - 0.01 * direction)
    ) / 0.02  # quadratic in x: exact
    product = np.zeros_like(x)
    faces = MESH.bore.faces
    local = np.einsum("fab,fb->fa", follower.stiffness(x), direction[faces].reshape(-1, 24)).reshape(-1, 8, 3)
    np.add.at(product, faces, -local)
    assert np.allclose(product, slope, atol=1e-12 * np.abs(slope).max())


def test_history_scales_and_bad_input_is_named():
    top = MESH.generatrix(MESH.outer, np.pi / 2)
    assert factor(LineLoad(line=top, force_per_length=(0, 1, 0), history=lambda t: 3 * t), 2.0) == 6.0
    assert factor(LineLoad(line=top, force_per_length=(0, 1, 0)), 2.0) == 1.0
    with pytest.raises(InputError, match=r"LineLoad.history must be a function of time or None, got 5.0"):
        LineLoad(line=top, force_per_length=(0, 1, 0), history=5.0)
    with pytest.raises(InputError, match=r"DeadPressure.distribution must be 176 finite numbers"):
        DeadPressure(surface=MESH.bore, pressure=1.0, distribution=np.ones(3))
    with pytest.raises(InputError, match=r"SurfaceLoad.traction must be 3 finite numbers in Pa"):
        SurfaceLoad(surface=MESH.bore, traction=(1.0, 2.0))
