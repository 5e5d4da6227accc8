"""Modes of a bush in motion: vibrations and mass of the mesh, a closed form,
and responses to an accelerated housing."""

import dataclasses

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import j1, jvp, y1, yvp

from exudyn_ehd.solid.bush import ModalBush
from exudyn_ehd.solid.elements.hex20 import GAUSS27, HEX20, shapes
from exudyn_ehd.solid.loads import pressure_loads
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.modes.dynamic import held_stiffness
from exudyn_ehd.solid.modes.static import bore_modes
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import InputError
from tests.solid_vibrations import eigenfrequencies

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=2, circumferential=16)
BUSH = ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1, dynamics=True)
VIBRATING = dataclasses.replace(BUSH, body_forces=False)


@pytest.fixture(scope="module")
def modes():
    return bore_modes(VIBRATING)


@pytest.fixture(scope="module")
def static():
    return bore_modes(dataclasses.replace(VIBRATING, dynamics=False))


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
    _, weight = HEX20.reference_gradients(modes.mesh.nodes[modes.mesh.elements], GAUSS27)
    at_points = np.einsum("qa,eai->eqi", shapes(GAUSS27.points)[0], v)
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
    """(K - omega^2 M) u = load under a smooth pressure, at shares of the lowest
    frequency; errors of what the mass changes.

    Static modes have the term of omega^2 exactly, so their error falls with
    omega^2 too; above resonances they lose the response.
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
    first = bore_modes(VIBRATING)
    assert len(list(tmp_path.iterdir())) == 2
    again = bore_modes(VIBRATING)
    assert len(list(tmp_path.iterdir())) == 2
    assert np.array_equal(again.mass, first.mass) and np.array_equal(again.displacements, first.displacements)
    heavy = bore_modes(dataclasses.replace(VIBRATING, material=dataclasses.replace(STEEL, density=2 * 7800.0)))
    assert len(list(tmp_path.iterdir())) == 3
    assert np.allclose(heavy.vibrations()[0], first.vibrations()[0] / np.sqrt(2.0), rtol=1e-9)


def inertia_load(mesh, a, alpha, omega):
    """Nodal forces (3 n,) of -rho (a + alpha x X + omega x (omega x X)), 27 points per element."""
    X = mesh.nodes[mesh.elements]
    _, weight = HEX20.reference_gradients(X, GAUSS27)
    N = shapes(GAUSS27.points)[0]
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
def test_bore_yields_to_accelerations_as_the_mesh_does(motion, tilted, measured):
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
        assert errors[0] > 0.01
    # half a per cent of every field by itself
    measured("displacement of the bore", errors[1], 5e-3)


@pytest.mark.parametrize("tilted", [True, False])
def test_modes_for_body_forces_leave_the_others_as_they_are(tilted):
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


def test_only_bushes_with_mass_have_modes_for_body_forces():
    quasi = [bore_modes(dataclasses.replace(BUSH, dynamics=False, body_forces=b)) for b in (True, False)]
    assert quasi[0].count == quasi[1].count < bore_modes(VIBRATING).count


def test_disk_keeps_modes_for_body_forces_apart(monkeypatch, tmp_path):
    """By all that determines them: mesh and material through the other modes, and the settings of their own."""
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path))
    bore_modes(VIBRATING)
    assert len(list(tmp_path.iterdir())) == 2
    first = bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 3
    again = bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 3
    assert np.array_equal(again.displacements, first.displacements) and np.array_equal(again.mass, first.mass)
    monkeypatch.setattr("exudyn_ehd.solid.modes.dynamic.BODY_FORCE_SETTINGS", ("other",))
    bore_modes(BUSH)
    assert len(list(tmp_path.iterdir())) == 4
    heavy = bore_modes(dataclasses.replace(BUSH, material=dataclasses.replace(STEEL, density=2 * 7800.0)))
    assert len(list(tmp_path.iterdir())) == 6
    # twice the load on the same mesh
    single, double = (m.participation()[0] @ (m.participation()[0] / m.stiffness).T for m in (first, heavy))
    assert np.allclose(double, 4.0 * single, rtol=0, atol=1e-9 * np.abs(double).max())
