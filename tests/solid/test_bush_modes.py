"""Modes of a bush's bore: what they must span, and what the tolerance promises."""

import dataclasses

import numpy as np
import pytest

from exudyn_ehd.solid import bush as own
from exudyn_ehd.solid.bush import ModalBush, bore_modes
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import InputError
from tests.sampling import sample
from tests.solid_pressures import pressure_loads

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=4, radial=1, circumferential=24)


@pytest.fixture(scope="module")
def modes():
    return bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.05))


def _radial_response(mesh, pressure):
    """Radial bore displacement (nodes,) under a pressure with a dense solver;
    outer surface fixed. And the nodal loads."""
    solid = TotalLagrange(mesh=mesh, material=STEEL)
    load = pressure_loads(mesh.bore, len(mesh.nodes), [pressure])[:, 0]
    fixed = (3 * mesh.outer.nodes[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(3 * len(mesh.nodes)), fixed)
    K = solid.tangent(np.zeros_like(mesh.nodes)).toarray()[np.ix_(free, free)]
    u = np.zeros(3 * len(mesh.nodes))
    u[free] = np.linalg.solve(K, load[free])
    return _radial(mesh, u.reshape(-1, 3)), load


def _radial(mesh, u):
    theta = mesh.bore.theta
    return u[mesh.bore.nodes, 0] * np.cos(theta) + u[mesh.bore.nodes, 1] * np.sin(theta)


def test_modes_are_orthogonal_in_energy_and_scaled_in_metres(modes):
    solid = TotalLagrange(mesh=modes.mesh, material=STEEL)
    K = solid.tangent(np.zeros_like(modes.mesh.nodes))
    u = modes.displacements.reshape(modes.count, -1)
    energy = u @ (K @ u.T)
    # rounding of the eigenvectors, relative to the stiffest mode
    assert np.allclose(energy, np.diag(modes.stiffness), atol=1e-8 * modes.stiffness.max())
    theta, z = np.linspace(-np.pi, np.pi, 193), np.linspace(-0.033, 0.033, 33)
    largest = np.abs(modes.radial(theta, z)).max(axis=(0, 1))
    # 1 at a node; between nodes the quadratic interpolation may pass it by a little
    assert np.all(largest > 0.9)
    assert np.all(largest < 1.2)


def _film(eps, tau, phi, decay=6.0):
    def pressure(theta, zeta):
        local = eps + tau * zeta
        axial = 1 - np.cosh(decay * zeta) / np.cosh(decay)
        return np.maximum(local * np.sin(theta - phi), 0) / (1 + local * np.cos(theta - phi)) ** 3 * axial

    return pressure


@pytest.mark.parametrize(
    ("pressure", "factor"),
    sample(
        [
            # in the sample
            (_film(0.5, 0.15, 0.3), 1.0),
            # other directions, weaker and other axial shapes
            (_film(0.5, 0.0, 2.0), 1.2),
            (_film(0.4, -0.1, -1.1), 1.0),
            (_film(0.5, 0.1, 3.0, decay=2.0), 1.2),
            (_film(0.9, 0.0, 1.0), 1.5),
            # pressurised ends
            (lambda theta, zeta: np.ones_like(zeta), 1e-3),
            (lambda theta, zeta: 1 + 0.5 * zeta, 1e-3),
        ],
        1,
        4,
        6,
    ),
)
def test_tolerance_holds_for_films(modes, pressure, factor):
    exact, load = _radial_response(modes.mesh, pressure)
    q = modes.displacements.reshape(modes.count, -1) @ load / modes.stiffness
    reduced = _radial(modes.mesh, np.tensordot(q, modes.displacements, 1))
    assert np.linalg.norm(reduced - exact) <= factor * 0.05 * np.linalg.norm(exact)


@pytest.mark.slow
def test_tighter_tolerance_takes_more_modes_and_aligned_films_fewer():
    counts = [bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=t)).count for t in (0.2, 0.05, 0.02)]
    assert counts == sorted(set(counts))
    aligned = bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.02, tilted=False))
    assert aligned.count < 0.6 * counts[2]
    assert aligned.error <= 0.02


def test_aligned_modes_are_even_along_the_axis():
    aligned = bore_modes(ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1, tilted=False))
    shape = aligned.radial(np.linspace(-3, 3, 7), np.linspace(-0.03, 0.03, 5))
    # rounding of the solution
    assert np.allclose(shape, shape[:, ::-1], atol=1e-7)


@pytest.mark.slow
def test_stiffness_is_proportional_to_youngs_modulus(modes):
    soft = SaintVenantKirchhoff(youngs_modulus=2.1e9, poisson_ratio=0.3, density=7800.0)
    other = bore_modes(ModalBush(mesh=CYLINDER, material=soft, tolerance=0.05))
    assert other.count == modes.count
    theta, z = np.linspace(-3, 3, 9), np.linspace(-0.033, 0.033, 5)

    def compliance(m):
        S = m.radial(theta, z).reshape(-1, m.count)
        return (S / m.stiffness) @ S.T

    # pairs of modes may turn among themselves; what they span, weighted by compliance, may not
    assert np.allclose(0.01 * compliance(other), compliance(modes), rtol=0, atol=1e-6 * np.abs(compliance(modes)).max())


def test_loads_carry_the_pressures_resultant():
    mesh = CYLINDER.mesh()
    loads = pressure_loads(mesh.bore, len(mesh.nodes), [lambda t, zeta: np.cos(t) * (1 - zeta**2)])
    total = loads.reshape(len(mesh.nodes), 3).sum(axis=0)
    # integral of cos^2 (1 - zeta^2) over the cylinder; 24 quadratic faces around are 1e-4 off the circle
    assert total[0] == pytest.approx(np.pi * 0.03 * 0.066 * 2 / 3, rel=1e-3)
    assert np.allclose(total[1:], 0.0, atol=1e-12 * total[0])


@pytest.mark.parametrize(
    "wrong", [{"tolerance": 0.0}, {"tolerance": 0.5}, {"tilted": 2}, {"mesh": 3}, {"material": 2.1e11}]
)
def test_wrong_values_are_named(wrong):
    given = {"mesh": CYLINDER, "material": STEEL} | wrong
    with pytest.raises(InputError, match=f"ModalBush.{next(iter(wrong))}"):
        ModalBush(**given)


@pytest.mark.slow
def test_modes_are_kept_on_disk_by_content(monkeypatch, tmp_path):
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path))
    bush = ModalBush(
        mesh=dataclasses.replace(CYLINDER, axial=1, circumferential=12), material=STEEL, tolerance=0.2, tilted=False
    )
    first = bore_modes(bush)
    (path,) = tmp_path.iterdir()
    raw = path.read_bytes()
    built = []
    exact = own.compute_modes
    monkeypatch.setattr(own, "compute_modes", lambda *a: built.append(a) or exact(*a))
    again = bore_modes(bush)
    assert not built and again.error == first.error
    assert np.array_equal(again.displacements, first.displacements) and np.array_equal(again.stiffness, first.stiffness)
    # what only the mass needs does not count, everything else does
    bore_modes(dataclasses.replace(bush, material=dataclasses.replace(STEEL, density=900.0)))
    bore_modes(dataclasses.replace(bush, mesh=bush.build_mesh()))
    assert not built
    moved = bush.build_mesh()
    moved = dataclasses.replace(moved, nodes=moved.nodes * (1.0 + 1e-12))
    for other in (
        dataclasses.replace(bush, material=dataclasses.replace(STEEL, youngs_modulus=2.0e11)),
        dataclasses.replace(bush, tolerance=0.15),
        dataclasses.replace(bush, tilted=True),
        dataclasses.replace(bush, mesh=moved),
    ):
        built.clear()
        bore_modes(other)
        assert len(built) == 1
    path.write_bytes(raw[:-1])
    with pytest.warns(UserWarning, match="damaged"):
        assert np.array_equal(bore_modes(bush).stiffness, first.stiffness)
    assert path.read_bytes() == raw


@pytest.mark.parametrize("size", sample([1.0, 2.0, 0.1], 0))
def test_modes_of_a_coarse_mesh_are_those_of_a_larger_one(size):
    """Two elements along the axis have nodes for five shapes; rounding must not make modes of six."""
    mesh = HollowCylinder(
        inner_radius=0.02002 * size, thickness=0.006 * size, length=0.02 * size, axial=2, radial=1, circumferential=16
    )
    bush = ModalBush(mesh=mesh, material=STEEL, tolerance=0.1)
    stiffness = own.compute_modes(bush, bush.build_mesh(), mesh.length)["stiffness"]
    assert stiffness.size == 77
    # those of rounding would have its inverse
    assert stiffness.max() < 1e4 * stiffness.min()


def test_waves_that_a_coarse_mesh_cannot_show_make_no_modes():
    coarse = dataclasses.replace(CYLINDER, axial=2, circumferential=12)
    modes = bore_modes(ModalBush(mesh=coarse, material=STEEL, tolerance=0.05))
    # some displace no bore node at all, and would have a stiffness of rounding's inverse, 1e39
    assert modes.stiffness.max() < 1e4 * modes.stiffness.min()


def test_a_moment_works_on_the_mean_rotation_of_the_bore(modes):
    turned = np.cross([0.0, 0.0, 2.0], modes.mesh.nodes)
    rigid = dataclasses.replace(modes, displacements=turned[None], stiffness=np.ones(1))
    for length in (0.066, 0.04):
        # 24 quadratic faces around are 1e-4 off the circle
        assert rigid.twist(length) == pytest.approx(2.0, rel=2e-4)
        # a round bush does not turn: rounding
        assert np.abs(modes.twist(length)).max() * 0.03 < 1e-9


@pytest.mark.parametrize("kind", [ModalBush, TotalLagrange])
def test_quadrature_that_is_none_is_refused(kind):
    for value in (np.inf, 14, (), "IRONS14"):
        with pytest.raises(
            InputError, match=rf"{kind.__name__}.quadrature .* must be IRONS14, GAUSS27, GAUSS8 or None"
        ):
            kind(mesh=CYLINDER.mesh(), material=STEEL, quadrature=value)
