"""Elastic cylinders, wave by wave, against closed forms, beams and meshes of hexahedra."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.sparse.linalg import splu

import exudyn_ehd as ehd
from exudyn_ehd.solid.harmonics import Cylinder, interpolation
from exudyn_ehd.solid.journal import ElasticJournal, HeldBands, HeldEnds, _Reduction, wall_edges
from tests.reference.elastic_rings import bore_displacement, cylinder_yielding
from tests.sampling import sample

E, NU = 2.1e11, 0.3
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=E, poisson_ratio=NU, density=7800.0)
A = 0.01


def cylinder(inner, z, nu=NU):
    """A cylinder with as many elements through the wall as a journal has."""
    material = ehd.SaintVenantKirchhoff(youngs_modulus=E, poisson_ratio=nu, density=7800.0)
    return Cylinder(wall_edges(inner, A, 8), z, material.lame)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
@pytest.mark.parametrize("n", [0, 2, 3, 5, 8])
def test_closed_form_against_the_equations_of_elasticity(n, nu):
    """Plane equilibrium, integrated along r from a free bore, needs no stress function."""
    lam, mu = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))

    def rates(r, y):
        # displacements U cos, V sin; stresses s_r cos, t sin
        U, V, s, t = y
        e_t = (U + n * V) / r
        e_r = (s - lam * e_t) / (lam + 2.0 * mu)
        s_t = lam * e_r + (lam + 2.0 * mu) * e_t
        return [e_r, t / mu + (V + n * U) / r, -(s - s_t) / r - n * t / r, n * s_t / r - 2.0 * t / r]

    inner = 0.4
    ends = [
        solve_ivp(rates, (inner, 1.0), start, rtol=1e-10, atol=1e-8).y[:, -1]
        for start in ([1e-11, 0.0, 0.0, 0.0], [0.0, 1e-11, 0.0, 0.0])
    ]
    part = np.linalg.lstsq(np.array(ends)[:, 2:].T, [-1.0, 0.0], rcond=None)[0]
    assert cylinder_yielding(n, inner, 1.0, nu) == pytest.approx(-part @ np.array(ends)[:, 0] * E, rel=1e-6)
    # of a solid one as of one with a hole that nothing sees
    assert cylinder_yielding(n, 1e-4, 1.0, nu) == pytest.approx(cylinder_yielding(n, 0.0, 1.0, nu), rel=1e-6)


@pytest.mark.parametrize("inner", sample([0.0, 0.5 * A, 0.8 * A], 1))
def test_plane_strain(inner):
    """The middle of a long cylinder whose ends don't move along the axis."""
    body = cylinder(inner, np.linspace(-10.0 * A, 10.0 * A, 31))
    ends = np.isin(np.arange(body.size // 3) % body.nodes_z.size, (0, body.nodes_z.size - 1))
    for n in (0, *range(2, 9)):
        free = np.ones(body.size, dtype=bool)
        free[2::3], free[1::3] = ~ends, n > 0
        load, u = body.load(n, np.ones((1, *body.places.shape)))[:, 0], np.zeros(body.size)
        u[free] = splu(body.stiffness(n)[free][:, free]).solve(load[free])
        middle = u[3 * body.surface[body.nodes_z.size // 2]]
        # elements half a radius long; the largest error is measured at three waves on half the radius
        assert middle * E / A == pytest.approx(cylinder_yielding(n, inner, A, NU), rel=1.5e-3)


def test_free_pin_is_moved_by_nothing():
    """Balancing forces are spread as the mass is: momentum and its moment vanish, and so do rigid loads' modes."""
    body = cylinder(0.3 * A, np.linspace(-2.0 * A, 3.0 * A, 21))
    rng = np.random.default_rng(1)
    for n in (0, 1):
        R, M = body.rigid(n), body.mass(n)
        assert np.abs(body.stiffness(n) @ R).max() < 1e-9 * np.abs(body.stiffness(n)).max() * np.abs(R).max()
        loads = body.load(n, rng.normal(size=(3, *body.places.shape)))
        u = body.solve(n, loads, None)
        momentum = R.T @ (M @ u)
        assert np.abs(momentum).max() < 1e-9 * np.abs(M).max() * np.abs(u).max() * len(R) * np.abs(R).max()
        # K u is the load without its resultants, which the mass takes
        rest = loads - M @ R @ np.linalg.solve(R.T @ (M @ R), R.T @ loads)
        free = np.ones(body.size, dtype=bool)
        free[1::3] = n > 0
        assert np.abs((body.stiffness(n) @ u - rest)[free]).max() < 1e-8 * np.abs(loads).max()
        inertia = body.solve(n, M @ R, None)
        assert np.abs(inertia).max() < 1e-9 * np.abs(u).max() * np.abs(M @ R).max() / np.abs(loads).max()


@pytest.mark.parametrize("inner", [0.0, 0.6 * A])
def test_held_pin_bends_like_a_beam(inner):
    """A slender pin held at both ends under a uniform transverse load: clamped beam with shear, Cowper's factor."""
    half = 12.0 * A
    body = cylinder(inner, np.linspace(-half, half, 49))
    ends = np.isin(np.arange(body.size // 3) % body.nodes_z.size, (0, body.nodes_z.size - 1))
    u = body.solve(1, body.load(1, np.ones((1, *body.places.shape))), ends)[:, 0]
    area, inertia, m = np.pi * (A**2 - inner**2), 0.25 * np.pi * (A**4 - inner**4), inner / A
    shape = 6.0 * (1.0 + NU) * (1.0 + m**2) ** 2 / ((7.0 + 6.0 * NU) * (1.0 + m**2) ** 2 + (20.0 + 12.0 * NU) * m**2)
    line, G, length = np.pi * A, E / (2.0 * (1.0 + NU)), 2.0 * half
    expected = line * length**4 / (384.0 * E * inertia) + line * length**2 / (8.0 * shape * G * area)
    # of the axis: half the difference of both sides, where the local yielding is another; 24 radii long
    across = u[3 * body.surface[body.nodes_z.size // 2]]
    assert across == pytest.approx(expected, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("held", "tolerance"), [(HeldEnds(), 0.01), (HeldBands(bands=((-0.02, -0.01), (0.01, 0.02))), 0.06)]
)
def test_against_hexahedra(held, tolerance):
    """A hollow pin under a pressure of all waves, on a structured mesh of 20-node elements held at the same places."""
    from exudyn_ehd.solid.mesh import HollowCylinder
    from exudyn_ehd.solid.total_lagrange import TotalLagrange, sparse_factor
    from tests.solid_pressures import pressure_loads

    mesh = HollowCylinder(
        inner_radius=0.5 * A, thickness=0.5 * A, length=4.0 * A, axial=16, radial=2, circumferential=24
    )
    mesh, half = mesh.mesh(), 0.8 * A
    place = mesh.nodes
    fixed = np.zeros(len(place), dtype=bool)
    if isinstance(held, HeldEnds):
        fixed = np.abs(place[:, 2]) > 2.0 * A - 1e-9
    else:
        fixed[mesh.outer.nodes[np.abs(mesh.outer.z) > A - 1e-9]] = True

    def film(theta, zeta):
        inside = np.abs(2.0 * A * zeta) < half
        return inside * (1.0 - (2.0 * A * zeta / half) ** 2) * np.exp(2.0 * np.cos(theta - 0.4) + zeta)

    loads = pressure_loads(mesh.outer, len(place), [film])[:, 0]
    free = np.repeat(~fixed, 3)
    K = TotalLagrange(mesh=mesh, material=STEEL).tangent(np.zeros_like(place))
    u = np.zeros(free.size)
    u[free] = sparse_factor(K[free][:, free]).solve(loads[free])
    on_film = np.abs(mesh.outer.z) < half + 1e-9
    expected = mesh.outer.radial(u[None])[0][on_film]
    journal = ElasticJournal(material=STEEL, span=(-2.0 * A, 2.0 * A), held=held, inner_radius=0.5 * A)
    reduced = _Reduction(journal, A, 2.0 * half)
    body, theta, z = reduced.body, mesh.outer.theta[on_film], mesh.outer.z[on_film]
    angles = 2.0 * np.pi * np.arange(64) / 64
    parts = np.fft.rfft(film(angles, 0.5 * body.places[..., None] / A)) / 32.0
    got = np.zeros(z.size)
    for n in range(20):
        both = np.stack([parts[..., n].real, -parts[..., n].imag]) * (0.5 if n == 0 else 1.0)
        answer = reduced.body.solve(n, body.load(n, both * reduced.loaded), reduced.held)[reduced.surface]
        profile = interpolation(reduced.edges, z) @ answer
        got += profile[:, 0] * np.cos(n * theta) + profile[:, 1] * np.sin(n * theta)
    # errors of the hexahedra, which are long beside the edges of the bands, and too stiff
    assert np.linalg.norm(got - expected) < tolerance * np.linalg.norm(expected)
    assert np.linalg.norm(got) > np.linalg.norm(expected)


def test_solid_pins_need_no_hole():
    """A hole of a hundredth of the radius is not felt, and the axis needs no conditions."""
    z = np.linspace(-2.0 * A, 2.0 * A, 13)
    for n in range(4):
        u = []
        for inner in (0.0, 0.01 * A):
            body = cylinder(inner, z)
            u.append(body.solve(n, body.load(n, (1.0 - (body.places / z[-1]) ** 2)[None]), None)[3 * body.surface, 0])
        assert np.abs(u[0] - u[1]).max() < 2e-3 * np.abs(u[1]).max()


def test_reference_of_a_ring_is_that_of_lame():
    # a pressure inside and outside alike squeezes the ring uniformly: the difference of both loads is known
    inside = bore_displacement(0.5, 1.0, 1.0, 1.0, NU, plane_strain=True)
    # Betti: the bore's yielding to the outer load is the rim's to the inner one
    assert cylinder_yielding(0, 0.5, 1.0, NU) == pytest.approx(1.3 * (1.0 - 0.6 + 0.25) / 0.75)
    assert inside > 0.0
