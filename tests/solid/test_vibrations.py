"""Modal mass and vibrations of a reduced bush: the mesh's, a closed form, and what static modes alone miss."""

import dataclasses

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import j1, jvp, y1, yvp

from exudyn_ehd.solid.hex20 import GAUSS27, shape_functions
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.static_equilibrium import eigenfrequencies
from exudyn_ehd.solid.static_modes import ModalBush, bore_modes, pressure_loads
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange, reference_gradients
from exudyn_ehd.solid.vibrations import held_stiffness
from exudyn_ehd.status import InputError

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=2, circumferential=16)
BUSH = ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1, dynamics=True, body_forces=False)


@pytest.fixture(scope="module")
def modes():
    return bore_modes(BUSH)


@pytest.fixture(scope="module")
def static():
    return bore_modes(dataclasses.replace(BUSH, dynamics=False))


def mesh_frequencies(mesh, count):
    held = np.zeros(mesh.nodes.shape, dtype=bool)
    held[mesh.outer.nodes] = True
    return eigenfrequencies(TotalLagrange(mesh=mesh, material=STEEL), held=held, count=count)


def test_lowest_vibrations_are_those_of_the_mesh(modes, static):
    exact, _ = mesh_frequencies(modes.mesh, 40)
    omega, shapes = modes.vibrations()
    added = modes.count - static.count
    assert 20 < added <= 40
    # the vibrations lie in the span: rounding
    assert np.all(np.abs(omega[: added - 8, None] / exact - 1.0).min(axis=1) < 1e-10)
    assert np.allclose(shapes.T @ modes.mass @ shapes, np.eye(modes.count), atol=1e-9)
    # the lowest, 43 kHz, is in it, which static modes alone have 1.9 times too high: bounds from above
    assert omega[0] == pytest.approx(exact[0], rel=1e-10)
    k = static.count
    alone = np.sqrt(eigh(np.diag(static.stiffness), modes.mass[:k, :k], eigvals_only=True))
    assert np.all(alone >= omega[:k] * (1.0 - 1e-10))
    assert 1.7 < alone[0] / omega[0] < 2.1


def test_static_modes_stay_as_they_are(modes, static):
    assert static.mass is None
    assert np.array_equal(modes.displacements[: static.count], static.displacements)
    assert np.array_equal(modes.stiffness[: static.count], static.stiffness)
    K = TotalLagrange(mesh=modes.mesh, material=STEEL).tangent(np.zeros_like(modes.mesh.nodes))
    u = modes.displacements.reshape(modes.count, -1)
    # rounding, relative to the stiffest mode
    assert np.allclose(u @ (K @ u.T), np.diag(modes.stiffness), atol=1e-8 * modes.stiffness.max())
    with pytest.raises(InputError, match="dynamics=True"):
        static.vibrations()


def test_mass_is_that_of_the_mesh(modes):
    """Phi^T M Phi by a quadrature of its own: the kinetic energy of random rates, 27 points per element."""
    rate = np.random.default_rng(1).normal(size=modes.count)
    v = np.tensordot(rate, modes.displacements, 1)[modes.mesh.elements]
    _, weight = reference_gradients(modes.mesh.nodes[modes.mesh.elements], GAUSS27)
    at_points = np.einsum("qa,eai->eqi", shape_functions(GAUSS27.points), v)
    energy = 0.5 * 7800.0 * np.einsum("eq,eqi,eqi->", weight, at_points, at_points)
    assert 0.5 * rate @ modes.mass @ rate == pytest.approx(energy, rel=1e-10)


def test_breathing_vibration_has_the_frequency_of_the_closed_form():
    """nu = 0: u_r(r) alone, u'' + u'/r - u/r^2 + k^2 u = 0, u(b) = 0, u'(a) = 0, omega = k sqrt(E / rho)."""
    a, t = 0.03, 0.02
    b = a + t
    k = brentq(
        lambda k: jvp(1, k * a) * y1(k * b) - yvp(1, k * a) * j1(k * b), 0.7 * np.pi / 2 / t, 1.4 * np.pi / 2 / t
    )
    expected = k * np.sqrt(2.1e11 / 7800.0)
    material = dataclasses.replace(STEEL, poisson_ratio=0.0)
    errors = []
    for layers in (1, 2):
        mesh = HollowCylinder(inner_radius=a, thickness=t, length=0.02, axial=1, radial=layers, circumferential=16)
        modes = bore_modes(ModalBush(mesh=mesh, material=material, tolerance=0.2, tilted=False, dynamics=True))
        omega, shapes = modes.vibrations()
        bore = modes.radial(np.linspace(-np.pi, np.pi, 49), np.zeros(1))[:, 0] @ shapes
        # uniform around the bore
        i = int(np.argmax(np.abs(bore.mean(axis=0)) / np.sqrt((bore**2).mean(axis=0) + 1e-30 * (bore**2).max())))
        errors.append(abs(omega[i] / expected - 1.0))
    assert errors[1] < 1e-3
    # quadratic elements: fourth order in the frequency, less the first mesh's coarseness
    assert errors[1] < errors[0] / 8.0


@pytest.mark.parametrize(("share", "error", "error_static"), [(0.1, 6e-4, 8e-4), (0.5, 0.015, 0.02), (1.2, 0.1, 0.3)])
def test_harmonic_response_of_the_bore_is_the_meshes(modes, static, share, error, error_static):
    """(K - omega^2 M) u = load under a smooth pressure, at shares of the lowest frequency; errors of what the mass changes.

    Static modes have the term of omega^2 exactly, so their error falls with omega^2 too; above resonances they lose the response.
    """
    mesh = modes.mesh
    solid = TotalLagrange(mesh=mesh, material=STEEL)
    free, K, _ = held_stiffness(solid)
    M = solid.mass[free][:, free]

    def film(theta, zeta):
        return (1.0 + np.sin(theta) + 0.5 * np.cos(2.0 * theta)) * (1.0 - zeta**2) * (1.0 + 0.2 * zeta)

    load = pressure_loads(mesh.bore, len(mesh.nodes), [film])[:, 0]
    omega = share * modes.vibrations()[0][0]

    def change(K, M, load):
        """What the mass changes in the load's own displacement, relative."""
        still, moving = np.linalg.solve(K, load), np.linalg.solve(K - omega**2 * M, load)
        return float(load @ moving / (load @ still) - 1.0)

    exact = change(K.toarray(), M.toarray(), load[free])
    results = {}
    for name, k in (("dynamic", modes.count), ("static", static.count)):
        Q = modes.displacements[:k].reshape(k, -1) @ load
        results[name] = abs(change(np.diag(modes.stiffness[:k]), modes.mass[:k, :k], Q) / exact - 1.0)
    assert results["dynamic"] < error
    assert results["dynamic"] < results["static"] < error_static


def test_disk_keeps_mass_by_density(monkeypatch, tmp_path):
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path))
    first = bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 2
    again = bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 2
    assert np.array_equal(again.mass, first.mass) and np.array_equal(again.displacements, first.displacements)
    heavy = bore_modes(dataclasses.replace(BUSH, material=dataclasses.replace(STEEL, density=2 * 7800.0)))
    assert len(list(tmp_path.iterdir())) == 3
    assert np.allclose(heavy.vibrations()[0], first.vibrations()[0] / np.sqrt(2.0), rtol=1e-9)
