"""A bush of 10-node tetrahedra: patch test, rigid motion, tangents, mass, closed forms, film to bore, stress."""

import csv
import dataclasses
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_ehd.solid.bush import ANCFBush, ModalBush
from exudyn_ehd.solid.elements.element import HAMMER4, IRONS14, TET_EDGES, WALKINGTON14
from exudyn_ehd.solid.loads import DeadPressure, FollowerPressure, Gravity, SurfaceLoad, dead_forces
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import NeoHooke, SaintVenantKirchhoff, StressRecovery, TotalLagrange
from exudyn_ehd.status import InputError
from tests.solid_equilibrium import equilibrium
from tests.solid_tetrahedra import tet_mesh

# kernels of an element are compiled for it alone, which takes longer than all these tests
pytestmark = pytest.mark.slow

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
SOFT = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
RUBBER = NeoHooke(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=2, radial=2, circumferential=12)
SMALL = tet_mesh(CYLINDER)
RULES = [HAMMER4, WALKINGTON14]


def distorted(straight):
    """All nodes shifted at random by up to a fifth of an element; mid-edge nodes follow if edges shall be straight."""
    nodes = SMALL.nodes + (0.005 if straight else 0.002) * np.random.default_rng(4).uniform(-1, 1, SMALL.nodes.shape)
    if straight:
        edges = SMALL.elements[:, TET_EDGES].reshape(-1, 3)
        nodes[edges[:, 2]] = (nodes[edges[:, 0]] + nodes[edges[:, 1]]) / 2
    return dataclasses.replace(SMALL, nodes=nodes)


@pytest.mark.parametrize(("rule", "straight"), [(HAMMER4, True), (WALKINGTON14, True), (WALKINGTON14, False)])
@pytest.mark.parametrize("material", [SOFT, RUBBER], ids=["svk", "neo-hooke"])
def test_patch_of_distorted_elements_is_in_equilibrium_under_a_homogeneous_finite_deformation(rule, straight, material):
    mesh = distorted(straight)
    solid = TotalLagrange(mesh=mesh, material=material, quadrature=rule)
    stretch = np.eye(3) + 0.1 * np.random.default_rng(6).standard_normal((3, 3))
    u = mesh.nodes @ (stretch - np.eye(3)).T
    force = solid.force(u)
    inner = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.boundary)
    assert len(inner) > 100
    assert np.abs(force[inner]).max() < 1e-12 * np.abs(force).max()
    stress = StressRecovery(mesh=mesh, material=material).cauchy_at_nodes(u)
    assert np.allclose(stress, stress[0], rtol=0, atol=1e-10 * np.abs(stress).max())
    # energy of the homogeneous deformation: density times volume
    volume = solid.scalar_mass.sum() / material.density
    assert solid.energy(u) == pytest.approx(volume * material.energy_density(stretch - np.eye(3)), rel=1e-12)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("material", [STEEL, dataclasses.replace(RUBBER, youngs_modulus=2.1e11)])
def test_finite_rigid_motion_gives_no_force_and_no_energy(rule, material):
    solid = TotalLagrange(mesh=SMALL, material=material, quadrature=rule)
    turn = Rotation.from_rotvec([0.7, -1.9, 1.1]).as_matrix()
    u = SMALL.nodes @ turn.T + [3.0, -2.0, 1.0] - SMALL.nodes
    unit = np.abs(solid.force(0.01 * SMALL.nodes)).max() / 0.01
    assert np.abs(solid.force(u)).max() < 1e-12 * unit
    assert abs(solid.energy(u)) < 1e-14 * material.youngs_modulus


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("material", [SOFT, RUBBER], ids=["svk", "neo-hooke"])
def test_tangent_is_symmetric_and_the_derivative_of_the_force(rule, material):
    solid = TotalLagrange(mesh=SMALL, material=material, quadrature=rule)
    random = np.random.default_rng(8)
    u = 0.001 * random.standard_normal(SMALL.nodes.shape)
    K = solid.tangent(u)
    assert abs(K - K.T).max() < 1e-14 * abs(K).max()
    direction, step = random.standard_normal(u.shape), 1e-6
    coarse = (solid.force(u + 2 * step * direction) - solid.force(u - 2 * step * direction)) / (4 * step)
    fine = (solid.force(u + step * direction) - solid.force(u - step * direction)) / (2 * step)
    slope = (4 * fine - coarse) / 3
    assert np.abs(K @ direction.ravel() - slope.ravel()).max() < 1e-7 * np.abs(slope).max()
    assert solid.inversion(u) == ""
    crushed = -1.5 * SMALL.nodes * (np.arange(len(SMALL.nodes)) == SMALL.elements[7, 3])[:, None]
    assert "has turned inside out" in solid.inversion(crushed)


def test_serial_and_parallel_kernels_agree_to_rounding():
    u, v = np.random.default_rng(10).standard_normal((2, *SMALL.nodes.shape)) * 0.001
    results = []
    for parallel in (False, True):
        solid = TotalLagrange(mesh=SMALL, material=SOFT, parallel=parallel, viscosity_time=1e-3)
        results.append((solid.force(u, v), solid.tangent(u, v).data))
    for serial, parallel in zip(*results, strict=True):
        assert np.abs(serial - parallel).max() < 1e-14 * np.abs(serial).max()


def test_six_rigid_motions_and_no_others_cost_no_energy():
    """Four points leave no mode of a single element without stiffness."""
    nodes = SMALL.nodes[SMALL.elements[0]]
    mesh = dataclasses.replace(SMALL, nodes=nodes, elements=np.arange(10)[None])
    values = np.linalg.eigvalsh(TotalLagrange(mesh=mesh, material=SOFT).tangent(0 * nodes).toarray())
    assert np.abs(values[:6]).max() < 1e-12 * values[-1]
    assert values[6] > 1e-5 * values[-1]


def test_follower_pressure_has_its_stiffness():
    load = FollowerPressure(surface=SMALL.bore, pressure=3e5)
    random = np.random.default_rng(3)
    x = SMALL.nodes + 0.001 * random.standard_normal(SMALL.nodes.shape)
    direction, step = random.standard_normal(x.shape), 1e-6
    slope = (load.forces(x - step * direction) - load.forces(x + step * direction)) / (2 * step)
    product = np.zeros_like(x)
    local = np.einsum("fij,fj->fi", load.stiffness(x), direction[SMALL.bore.faces].reshape(-1, 18))
    np.add.at(product, SMALL.bore.faces, local.reshape(-1, 6, 3))
    assert np.allclose(product, slope, rtol=0, atol=1e-8 * np.abs(slope).max())


def test_mass_inertia_and_resultants_of_the_cylinder():
    mesh = tet_mesh(dataclasses.replace(CYLINDER, circumferential=24, radial=1))
    a, b, length = 0.225, 0.275, 0.2
    mass = 7800 * np.pi * (b**2 - a**2) * length
    solid = TotalLagrange(mesh=mesh, material=STEEL)
    M, x = solid.scalar_mass, mesh.nodes
    # the parabola's distance from the circle
    assert M.sum() == pytest.approx(mass, rel=2e-5)
    second = x.T @ (M @ x)
    across = mass * (a**2 + b**2) / 4
    assert np.allclose(second, np.diag([across, across, mass * length**2 / 12]), rtol=0, atol=5e-5 * across)
    weight = dead_forces(Gravity(acceleration=(0.0, -9.81, 2.0)), solid).sum(axis=0)
    assert np.allclose(weight, M.sum() * np.array([0.0, -9.81, 2.0]), rtol=1e-12, atol=1e-9)
    push = SurfaceLoad(surface=mesh.bore, traction=(1e3, 0.0, 5e2)).nodal_forces(mesh).sum(axis=0)
    assert np.allclose(push, 2 * np.pi * a * length * np.array([1e3, 0.0, 5e2]), rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("outer", ["fixed", "free"])
def test_fourier_compliance_of_the_bore(outer):
    """u_r at the bore per pressure cos(n theta), plane strain: closed form, and three layers of hexahedra."""
    data = Path(__file__).parent / "data" / "annulus_plane_strain_fourier_compliance.csv"
    with data.open() as file:
        cases = [r for r in csv.DictReader(file) if r["outer"] == outer and int(r["n"]) in (0, 2, 3)]
    cylinder = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.006, axial=1, radial=3, circumferential=32)
    found = []
    for mesh in (tet_mesh(cylinder), cylinder.mesh()):
        solid, theta = TotalLagrange(mesh=mesh, material=STEEL), mesh.bore.theta
        held = np.zeros(mesh.nodes.shape, dtype=bool)
        held[:, 2] = True
        if outer == "fixed":
            held[mesh.outer.nodes] = True
        else:
            held[np.abs(mesh.nodes[:, 1]) < 1e-9, 1] = True
            held[mesh.generatrix(mesh.outer, 0.0).nodes, 0] = True
        area = DeadPressure(surface=mesh.bore, pressure=1.0).nodal_forces(mesh)[mesh.bore.nodes]
        area = -np.einsum("ni,ni->n", area, mesh.bore.positions)
        row = []
        for case in cases:
            wave = np.cos(int(case["n"]) * theta)
            load = DeadPressure(surface=mesh.bore, pressure=1e3, distribution=wave)
            u = equilibrium(solid, held=held, loads=[load], tolerance=1e-9).displacements[mesh.bore.nodes] / 1e3
            radial = u[:, 0] * np.cos(theta) + u[:, 1] * np.sin(theta)
            row.append((area * radial * wave).sum() / (area * wave**2).sum())
        found.append(row)
    exact = [float(case["u_r(a)_per_unit_p_n [m/Pa]"]) for case in cases]
    assert np.allclose(found[0], exact, rtol=0.01)
    assert np.allclose(found[0], found[1], rtol=0.01)


def test_points_of_a_film_are_found_on_the_bore():
    bore = SMALL.bore
    theta, z = np.meshgrid(np.linspace(-np.pi, np.pi, 61), np.linspace(-0.1, 0.1, 13), indexing="ij")
    theta, z = theta.ravel(), z.ravel()
    S = bore.interpolation(theta, z)
    assert np.allclose(S @ np.ones(S.shape[1]), 1.0, rtol=0, atol=1e-12)
    assert np.allclose(S @ bore.z, z, rtol=0, atol=1e-12)
    x = S @ bore.positions
    assert np.allclose(np.arctan2(x[:, 1] * np.cos(theta) - x[:, 0] * np.sin(theta), 1.0), 0.0, atol=1e-12)
    # the sagitta's rest of a parabola on a diagonal and on an arc of 30 degrees
    assert np.allclose(np.hypot(x[:, 0], x[:, 1]), 0.225, rtol=3e-4)
    H = bore.radial_interpolation(theta, z)
    assert np.allclose(H @ bore.positions.ravel(), np.hypot(x[:, 0], x[:, 1]), rtol=1e-12)
    with pytest.raises(InputError, match="must lie on the surface"):
        bore.locate(np.zeros(1), np.array([0.11]))


def test_stress_is_found_at_any_material_point():
    recovery = StressRecovery(mesh=SMALL, material=SOFT)
    r, theta = np.random.default_rng(2).uniform([0.23, -np.pi], [0.27, np.pi], (20, 2)).T
    positions = np.column_stack([r * np.cos(theta), r * np.sin(theta), np.linspace(-0.09, 0.09, 20)])
    points = recovery.locate(positions)
    found = np.einsum(
        "na,nai->ni", SMALL.element.shapes(points.natural)[0], SMALL.nodes[SMALL.elements[points.element]]
    )
    assert np.allclose(found, positions, rtol=0, atol=1e-12)
    stress = recovery.cauchy_at(points, SMALL.nodes @ np.diag([0.01, 0.0, -0.02]))
    assert np.allclose(stress, stress[0], rtol=0, atol=1e-9 * np.abs(stress).max())
    with pytest.raises(InputError, match="must lie inside the solid"):
        recovery.locate(np.array([[0.0, 0.0, 0.0]]))


@pytest.mark.parametrize("kind", [ModalBush, ANCFBush, TotalLagrange])
def test_quadratures_belong_to_an_element(kind):
    assert kind(mesh=SMALL, material=STEEL).quadrature is HAMMER4
    assert kind(mesh=CYLINDER.mesh(), material=STEEL).quadrature is IRONS14
    with pytest.raises(InputError, match=r"quadrature of a mesh of 10-node tetrahedra must be HAMMER4, WALKINGTON14"):
        kind(mesh=SMALL, material=STEEL, quadrature=IRONS14)
    with pytest.raises(InputError, match=r"quadrature of a mesh of 20-node hexahedra must be IRONS14, GAUSS27, GAUSS8"):
        kind(mesh=CYLINDER.mesh(), material=STEEL, quadrature=HAMMER4)
