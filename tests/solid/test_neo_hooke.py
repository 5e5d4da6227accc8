"""The Neo-Hooke material: closed forms, energy, tangent; and elements that St. Venant-Kirchhoff turns inside out."""

import dataclasses

import numpy as np
import pytest

from exudyn_ehd.solid.elements.element import GAUSS27
from exudyn_ehd.solid.loads import FollowerPressure
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import NeoHooke, SaintVenantKirchhoff, StressRecovery, TotalLagrange
from tests.solid_equilibrium import EquilibriumError, equilibrium

RUBBER = NeoHooke(youngs_modulus=5e6, poisson_ratio=0.45, density=1100.0)
LAM, MU = RUBBER.lame
MESH = HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.02, axial=2, radial=2, circumferential=12).mesh()
SOLID = TotalLagrange(mesh=MESH, material=RUBBER)


def random_state(seed, size=4e-4):
    return size * np.random.default_rng(seed).standard_normal(MESH.nodes.shape)


@pytest.mark.parametrize("stretch", [0.3, 0.7, 1.5, 3.0])
def test_uniaxial_tension_is_the_closed_form(stretch):
    """The sides are free: mu (a - 1/a) + lam ln(J) / a = 0 with the stretch a across, J = stretch a^2."""
    a = 1.0
    for _ in range(60):
        residual = MU * (a * a - 1.0) + LAM * np.log(stretch * a * a)
        a -= residual / (2.0 * MU * a + 2.0 * LAM / a)
    u = MESH.nodes * [a - 1.0, a - 1.0, stretch - 1.0]
    # straight mid-edge nodes do not matter: the deformation is affine
    force = SOLID.force(u)
    stress = MU * (stretch - 1.0 / stretch) + LAM * np.log(stretch * a * a) / stretch
    volume = SOLID._geometry[2].sum()
    pull = force[MESH.end_high.nodes, 2].sum()
    assert pull == pytest.approx(stress * volume / 0.02, rel=1e-10)
    sides = np.setdiff1d(np.arange(len(force)), np.union1d(MESH.end_high.nodes, MESH.end_low.nodes))
    assert np.abs(force[sides]).max() < 1e-11 * abs(pull)


@pytest.mark.parametrize("shear", [0.2, 1.0, 2.5])
def test_simple_shear_is_the_closed_form(shear):
    """Cauchy's stress mu [[g^2, g], [g, 0]], energy mu g^2 / 2 per volume."""
    u = np.zeros_like(MESH.nodes)
    u[:, 0] = shear * MESH.nodes[:, 1]
    expected = np.zeros((3, 3))
    expected[:2, :2] = MU * np.array([[shear**2, shear], [shear, 0.0]])
    got = StressRecovery(mesh=MESH, material=RUBBER).cauchy_at_nodes(u)
    np.testing.assert_allclose(got, np.broadcast_to(expected, got.shape), atol=1e-9 * MU)
    assert SOLID.energy(u) == pytest.approx(0.5 * MU * shear**2 * SOLID._geometry[2].sum(), rel=1e-10)


@pytest.mark.parametrize("seed", range(2))
def test_force_is_that_of_the_energy_and_tangent_that_of_the_force(seed):
    u, d = random_state(seed), random_state(seed + 10)
    slope = (SOLID.energy(u + 1e-6 * d) - SOLID.energy(u - 1e-6 * d)) / 2e-6
    assert np.sum(SOLID.force(u) * d) == pytest.approx(slope, rel=1e-7)
    numeric = (SOLID.force(u + 1e-5 * d) - SOLID.force(u - 1e-5 * d)) / 2e-5
    exact = (SOLID.tangent(u) @ d.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(exact, numeric, atol=1e-7 * np.abs(numeric).max())


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_threads_change_no_bit(seed):
    u = random_state(seed)
    parallel = dataclasses.replace(SOLID, parallel=True)
    assert np.array_equal(parallel.force(u), SOLID.force(u))
    assert np.array_equal(parallel.tangent(u).data, SOLID.tangent(u).data)


def test_viscosity_adds_its_force_and_its_tangent():
    damped = dataclasses.replace(SOLID, viscosity_time=1e-3)
    like = dataclasses.replace(damped, material=SaintVenantKirchhoff(**dataclasses.asdict(RUBBER)))
    still = dataclasses.replace(like, viscosity_time=0.0)
    u, v, d = random_state(3), random_state(4), random_state(5)
    viscous = damped.force(u, v) - SOLID.force(u)
    np.testing.assert_allclose(viscous, like.force(u, v) - still.force(u), atol=1e-9 * np.abs(viscous).max())
    exact = damped.tangent(u, v, position_factor=0.0, velocity_factor=1.0) @ d.ravel()
    numeric = (damped.force(u, v + d) - damped.force(u, v - d)).ravel() / 2.0
    np.testing.assert_allclose(exact, numeric, atol=1e-9 * np.abs(numeric).max())


def test_small_strains_are_those_of_the_linear_material_to_rounding():
    u = random_state(6, 1e-13)
    linear = TotalLagrange(mesh=MESH, material=SaintVenantKirchhoff(**dataclasses.asdict(RUBBER)))
    np.testing.assert_allclose(SOLID.force(u), linear.force(u), atol=1e-8 * np.abs(linear.force(u)).max())


def pressed(material, pressure, steps):
    """A soft bush whose bore is pressed on one side against its held outer surface."""
    solid = TotalLagrange(mesh=MESH, material=material)
    held = np.zeros(MESH.nodes.shape, dtype=bool)
    held[MESH.outer.nodes] = True
    load = FollowerPressure(
        surface=MESH.bore, pressure=pressure, distribution=np.maximum(np.cos(MESH.bore.theta), 0) ** 3
    )
    return solid, equilibrium(solid, held=held, loads=[load], steps=steps)


@pytest.mark.slow
def test_compression_turns_no_element_of_neo_hooke_inside_out():
    solid, found = pressed(RUBBER, 5e6, 20)
    assert solid.inversion(found.displacements) == ""
    thinnest = 0.01 - np.linalg.norm(found.displacements[MESH.bore.nodes], axis=1).max()
    assert 0.0 < thinnest < 0.007


def test_elements_that_turn_inside_out_are_named():
    linear = SaintVenantKirchhoff(**dataclasses.asdict(RUBBER))
    u = np.zeros_like(MESH.nodes)
    layer = np.isclose(np.hypot(*MESH.nodes[:, :2].T), 0.03) & (MESH.nodes[:, 0] > 0.0)
    u[layer, :2] = 0.4 * MESH.nodes[layer, :2]
    message = TotalLagrange(mesh=MESH, material=linear, quadrature=GAUSS27).inversion(u)
    assert "has turned inside out (det F = -" in message and "NeoHooke" in message
    assert np.all(np.isnan(SOLID.force(u)[layer]))
    with pytest.raises(EquilibriumError):
        pressed(linear, 5e6, 20)
