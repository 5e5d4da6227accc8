"""The solid itself: patch test, rigid motion, tangent, mass and threads."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_ehd.solid.elements.element import GAUSS8, GAUSS27, HEX20, HEX_EDGES, HEX_NODES, IRONS14
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, StressRecovery, TotalLagrange
from exudyn_ehd.status import InputError
from tests.sampling import sample

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
SOFT = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
RULES = [GAUSS27, IRONS14, GAUSS8]
SMALL = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=2, radial=2, circumferential=12).mesh()


def straightened(mesh):
    """Return the mesh with mid-edge nodes half way between the corners."""
    nodes = mesh.nodes.copy()
    edges = mesh.elements[:, HEX_EDGES].reshape(-1, 3)
    nodes[edges[:, 2]] = (nodes[edges[:, 0]] + nodes[edges[:, 1]]) / 2
    return dataclasses.replace(mesh, nodes=nodes)


def distorted(mesh, straight):
    """All nodes shifted at random by up to a tenth of the wall; mid-edge nodes follow if edges shall be straight."""
    nodes = mesh.nodes + 0.005 * np.random.default_rng(4).uniform(-1, 1, mesh.nodes.shape)
    moved = dataclasses.replace(mesh, nodes=nodes)
    return straightened(moved) if straight else moved


def inner_nodes(mesh):
    return np.setdiff1d(np.arange(len(mesh.nodes)), np.unique(mesh.boundary))


def readable_force(solid, u):
    """f_a = sum over elements and points of w P G_a with P = F S, written out with numpy."""
    lam, mu = solid.material.lame
    force = np.zeros_like(u)
    for nodes in solid.mesh.elements:
        for point, weight in zip(solid.quadrature.points, solid.quadrature.weights, strict=True):
            natural = HEX20.shapes(point)[1][0]
            jacobian = solid.mesh.nodes[nodes].T @ natural
            G = natural @ np.linalg.inv(jacobian)
            F = np.eye(3) + u[nodes].T @ G
            E = (F.T @ F - np.eye(3)) / 2
            S = lam * np.trace(E) * np.eye(3) + 2 * mu * E
            force[nodes] += weight * np.linalg.det(jacobian) * G @ (F @ S).T
    return force


def test_of_elements_that_are_equal_but_for_round_off_the_first_is_named():
    """A body turned inside out as a whole, det F = -1; a displacement that is nan hides nothing."""
    solid = TotalLagrange(mesh=SMALL, material=SOFT)
    u = -2.0 * SMALL.nodes
    assert solid.inversion(u).startswith("element 0 at")
    u[SMALL.elements[-1]] = np.nan
    first = np.flatnonzero(np.isfinite(u[SMALL.elements]).all(axis=(1, 2)))[0]
    assert first > 0 and solid.inversion(u).startswith(f"element {first} at")


@pytest.mark.parametrize("rule", sample(RULES, 1, 2))
def test_kernel_equals_its_readable_twin(rule):
    solid = TotalLagrange(mesh=SMALL, material=SOFT, quadrature=rule)
    u = 0.02 * np.random.default_rng(5).standard_normal(SMALL.nodes.shape)
    expected = readable_force(solid, u)
    # the kernel sums in another order: rounding of some hundred terms
    assert np.allclose(solid.force(u), expected, rtol=0, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize(("rule", "straight"), [(GAUSS27, False), (GAUSS27, True), (IRONS14, True), (GAUSS8, True)])
def test_patch_of_distorted_elements_is_in_equilibrium_under_a_homogeneous_finite_deformation(rule, straight):
    mesh = distorted(SMALL, straight)
    solid = TotalLagrange(mesh=mesh, material=SOFT, quadrature=rule)
    stretch = np.eye(3) + 0.2 * np.random.default_rng(6).standard_normal((3, 3))
    u = mesh.nodes @ (stretch - np.eye(3)).T
    force = solid.force(u)
    inner = inner_nodes(mesh)
    assert len(inner) > 0
    # constant stress: no force inside, to rounding of forces of order one on the boundary
    assert np.abs(force[inner]).max() < 1e-11 * np.abs(force).max()
    stress = StressRecovery(mesh=mesh, material=SOFT).cauchy_at_nodes(u)
    assert np.allclose(stress, stress[0], rtol=1e-9, atol=1e-9 * np.abs(stress).max())


@pytest.mark.parametrize("rule", [IRONS14, GAUSS8])
def test_patch_of_curved_elements_needs_27_points(rule):
    """The reason for the straight patches above: with fewer points a curved patch keeps a residual, if a small one."""
    mesh = distorted(SMALL, False)
    u = mesh.nodes @ (0.01 * np.diag([1.0, -1.0, 0.5]))
    force = TotalLagrange(mesh=mesh, material=SOFT, quadrature=rule).force(u)
    residual = np.abs(force[inner_nodes(mesh)]).max() / np.abs(force).max()
    assert 1e-9 < residual < 0.2


@pytest.mark.parametrize("rule", RULES)
def test_finite_rigid_motion_gives_no_stress_force_or_energy(rule):
    solid = TotalLagrange(mesh=SMALL, material=STEEL, quadrature=rule)
    turn = Rotation.from_rotvec([0.7, -1.9, 1.1]).as_matrix()
    u = SMALL.nodes @ turn.T + [3.0, -2.0, 1.0] - SMALL.nodes
    # strains are rounding (1e-16 of F, amplified by |u|/element size ~ 100): against E they leave 1e-13 of stress
    assert np.abs(StressRecovery(mesh=SMALL, material=STEEL).cauchy_at_nodes(u)).max() < 1e-12 * STEEL.youngs_modulus
    unit = np.abs(solid.force(0.01 * SMALL.nodes)).max() / 0.01
    assert np.abs(solid.force(u)).max() < 1e-12 * unit
    assert solid.energy(u) < 1e-24 * STEEL.youngs_modulus


@pytest.mark.parametrize("rule", RULES)
def test_force_turns_with_the_body(rule):
    solid = TotalLagrange(mesh=SMALL, material=SOFT, quadrature=rule)
    turn = Rotation.from_rotvec([0.3, 2.0, -0.4]).as_matrix()
    u = 0.01 * np.random.default_rng(7).standard_normal(SMALL.nodes.shape)
    turned = (SMALL.nodes + u) @ turn.T - SMALL.nodes
    force = solid.force(u)
    assert np.allclose(solid.force(turned), force @ turn.T, atol=1e-12 * np.abs(force).max())


@pytest.mark.parametrize("rule", RULES)
def test_tangent_is_symmetric_and_the_derivative_of_the_force(rule):
    solid = TotalLagrange(mesh=SMALL, material=SOFT, quadrature=rule)
    random = np.random.default_rng(8)
    u = 0.005 * random.standard_normal(SMALL.nodes.shape)
    K = solid.tangent(u)
    assert abs(K - K.T).max() < 1e-14 * abs(K).max()
    for _ in range(3):
        direction = random.standard_normal(u.shape)
        step = 1e-5
        # the force is cubic in u: central differences at two steps, extrapolated, leave only rounding / step ~ 1e-10
        coarse = (solid.force(u + 2 * step * direction) - solid.force(u - 2 * step * direction)) / (4 * step)
        fine = (solid.force(u + step * direction) - solid.force(u - step * direction)) / (2 * step)
        slope = (4 * fine - coarse) / 3
        assert np.abs(K @ direction.ravel() - slope.ravel()).max() < 1e-7 * np.abs(slope).max()


def test_force_is_the_derivative_of_the_energy():
    solid = TotalLagrange(mesh=SMALL, material=SOFT, quadrature=GAUSS27)
    random = np.random.default_rng(9)
    u, direction = 0.005 * random.standard_normal((2, *SMALL.nodes.shape))
    step = 1e-3
    slope = (solid.energy(u + step * direction) - solid.energy(u - step * direction)) / (2 * step)
    curved = (solid.energy(u + 2 * step * direction) - solid.energy(u - 2 * step * direction)) / (4 * step)
    # the energy is quartic in u: the extrapolated difference is exact up to rounding
    assert (4 * slope - curved) / 3 == pytest.approx(float(np.sum(solid.force(u) * direction)), rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_serial_and_parallel_kernels_agree_to_rounding(rule):
    """They are compiled one by one, and need not round products in sums alike."""
    u, v = np.random.default_rng(10).standard_normal((2, *SMALL.nodes.shape)) * 0.01
    results = []
    for parallel in (False, True):
        solid = TotalLagrange(mesh=SMALL, material=SOFT, quadrature=rule, parallel=parallel, viscosity_time=1e-3)
        results.append((solid.force(u, v), solid.tangent(u, v).data))
    for serial, parallel in zip(*results, strict=True):
        assert np.abs(serial - parallel).max() < 1e-14 * np.abs(serial).max()


def block_mesh():
    """One straight block of 0.3 x 0.2 x 0.1 m, whose mass and inertia are known."""
    nodes = HEX_NODES * [0.15, 0.1, 0.05]
    return dataclasses.replace(SMALL, nodes=nodes, elements=np.arange(20)[None])


def test_mass_and_inertia_of_a_block_are_exact():
    mesh = block_mesh()
    M = TotalLagrange(mesh=mesh, material=STEEL).scalar_mass.toarray()
    mass = 7800 * 0.3 * 0.2 * 0.1
    x = mesh.nodes
    assert M.sum() == pytest.approx(mass, rel=1e-13)
    second = x.T @ M @ x
    assert np.allclose(second, mass / 12 * np.diag([0.3**2, 0.2**2, 0.1**2]), atol=1e-13 * mass)
    assert np.all(np.linalg.eigvalsh(M) > 0)


def test_mass_and_polar_inertia_of_the_cylinder_converge_at_fourth_order():
    exact = 7800 * np.pi * (0.275**2 - 0.225**2) * 0.2
    polar = exact * (0.275**2 + 0.225**2) / 2
    errors = []
    for around in (8, 16):
        mesh = HollowCylinder(
            inner_radius=0.225, thickness=0.05, length=0.2, axial=1, radial=1, circumferential=around
        ).mesh()
        M = TotalLagrange(mesh=mesh, material=STEEL).scalar_mass
        x, y = mesh.nodes[:, 0], mesh.nodes[:, 1]
        errors.append([abs(M.sum() / exact - 1), abs((x @ M @ x + y @ M @ y) / polar - 1)])
    rate = np.log2(np.array(errors[0]) / errors[1])
    # both follow the geometry of the parabola, fourth order
    assert np.all(rate > 3.8)
    assert max(errors[1]) < 1e-3


def test_full_mass_repeats_the_scalar_mass_in_three_directions():
    solid = TotalLagrange(mesh=SMALL, material=SOFT)
    v = np.random.default_rng(11).standard_normal(SMALL.nodes.shape)
    assert np.allclose((solid.mass @ v.ravel()).reshape(v.shape), solid.scalar_mass @ v, rtol=1e-14)


def test_viscosity_is_rayleigh_damping_in_the_small_and_idle_in_a_spin():
    solid = TotalLagrange(mesh=SMALL, material=SOFT, viscosity_time=2e-3)
    zero = np.zeros(SMALL.nodes.shape)
    v = np.random.default_rng(12).standard_normal(zero.shape)
    expected = 2e-3 * (TotalLagrange(mesh=SMALL, material=SOFT).tangent(zero) @ v.ravel()).reshape(v.shape)
    assert np.allclose(solid.force(zero, v), expected, atol=1e-12 * np.abs(expected).max())
    turn = Rotation.from_rotvec([0.0, 0.4, 2.0]).as_matrix()
    u = SMALL.nodes @ turn.T - SMALL.nodes
    spin = np.cross([1.0, -2.0, 30.0], SMALL.nodes + u)
    assert np.abs(solid.force(u, spin)).max() < 1e-10 * np.abs(expected).max()


def test_damped_tangent_is_exact_in_the_rate():
    solid = TotalLagrange(mesh=SMALL, material=SOFT, viscosity_time=2e-3)
    random = np.random.default_rng(13)
    u = 0.005 * random.standard_normal(SMALL.nodes.shape)
    v, direction = random.standard_normal((2, *u.shape))
    slope = solid.force(u, v + direction) - solid.force(u, v)  # linear in v
    D = solid.tangent(u, v, position_factor=0.0, velocity_factor=1.0)
    assert np.allclose(D @ direction.ravel(), slope.ravel(), atol=1e-10 * np.abs(slope).max())


def test_shape_functions_carry_the_isoparametric_map():
    nodes = SMALL.nodes[SMALL.elements[0]]
    assert np.allclose(HEX20.shapes(np.zeros(3))[0] @ nodes, (nodes[8:].sum(axis=0) - nodes[:8].sum(axis=0)) / 4)


@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [
        ("poisson_ratio", 0.5, "must be below 0.5, got 0.5"),
        ("youngs_modulus", 0.0, "youngs_modulus must be > 0 Pa"),
        ("density", -1.0, "density must be > 0 kg/m"),
    ],
)
def test_impossible_materials_are_refused(argument, value, message):
    arguments = {"youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 7800.0} | {argument: value}
    with pytest.raises(InputError, match=message):
        SaintVenantKirchhoff(**arguments)
