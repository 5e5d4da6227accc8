"""The bush against thick-cylinder and ring theory."""

import csv
from pathlib import Path

import numpy as np
import pytest

from exudyn_ehd.solid.elements.element import GAUSS8, GAUSS27, IRONS14
from exudyn_ehd.solid.loads import DeadPressure, LineLoad
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, StressRecovery, TotalLagrange
from tests.sampling import sample
from tests.solid_equilibrium import equilibrium
from tests.solid_vibrations import eigenfrequencies

DATA = Path(__file__).parent / "data"
RULES = [GAUSS27, IRONS14, GAUSS8]


def rows(name):
    with (DATA / name).open() as file:
        return list(csv.DictReader(file))


def angles(mesh):
    return np.arctan2(mesh.nodes[:, 1], mesh.nodes[:, 0])


def quarter_symmetry(mesh):
    """Supports that hold rigid motion of a doubly symmetric load without adding force, and all axial displacement."""
    held = np.zeros(mesh.nodes.shape, dtype=bool)
    held[:, 2] = True
    held[np.abs(np.sin(angles(mesh))) < 1e-9, 1] = True
    held[np.abs(np.cos(angles(mesh))) < 1e-9, 0] = True
    return held


def lame_errors(case, counts, rule):
    """Largest relative errors of bore displacement, hoop stress and radial stress (the latter over p)."""
    axial, radial, around = counts
    a, b = float(case["a"]), float(case["b"])
    mesh = HollowCylinder(
        inner_radius=a, thickness=b - a, length=0.2, axial=axial, radial=radial, circumferential=around
    ).mesh()
    material = SaintVenantKirchhoff(youngs_modulus=float(case["E"]), poisson_ratio=float(case["nu"]), density=7800.0)
    pressure = 1e-9 * material.youngs_modulus
    solid = TotalLagrange(mesh=mesh, material=material, quadrature=rule)
    load = DeadPressure(surface=mesh.bore, pressure=pressure)
    u = equilibrium(solid, held=quarter_symmetry(mesh), loads=[load]).displacements / pressure
    normal = mesh.bore.positions * [1, 1, 0] / a
    around_it = np.cross([0, 0, 1], normal)
    displacement = np.einsum("ni,ni->n", u[mesh.bore.nodes], normal)
    stress = StressRecovery(mesh=mesh, material=material).cauchy_at_nodes(u * pressure)[mesh.bore.nodes] / pressure
    hoop = np.einsum("ni,nij,nj->n", around_it, stress, around_it)
    radial_stress = np.einsum("ni,nij,nj->n", normal, stress, normal)
    return np.array(
        [
            np.abs(displacement / float(case["u_r(a)_plane_strain"]) - 1).max(),
            np.abs(hoop / float(case["sigma_theta(a)"]) - 1).max(),
            np.abs(radial_stress - float(case["sigma_r(a)"])).max(),
        ]
    )


@pytest.mark.parametrize("case", sample(rows("lame_thick_cylinder.csv"), 1), ids=["paper", "steel"])
@pytest.mark.parametrize("rule", RULES)
def test_bore_displacement_of_lame_at_the_default_mesh(case, rule):
    # the target is 0.5 %; measured 5e-6 for the thin bush and 1e-4 for the thick one
    assert lame_errors(case, (4, 2, 40), rule)[0] < 5e-4


@pytest.mark.parametrize("rule", sample(RULES, 0, 2))
def test_lame_converges_at_the_element_s_order(rule):
    case = rows("lame_thick_cylinder.csv")[0]
    coarse, middle, fine = (lame_errors(case, (1, n, 20 * n), rule) for n in (1, 2, 4))
    first, second = np.log2(coarse / middle), np.log2(middle / fine)
    # displacement at nodes of quadratic elements: fourth order (nodal superconvergence); stress at a surface: second
    assert min(first[0], second[0]) > 3.7
    assert min(second[1:]) > 1.7


@pytest.mark.parametrize("outer", ["fixed", "free"])
@pytest.mark.parametrize(("layers", "tolerance"), sample([(3, 0.01), (2, 0.025), (1, 0.11)], 1, 2))
def test_fourier_compliance_of_the_bore(outer, layers, tolerance):
    """u_r at the bore per pressure cos(n theta), plane strain, n = 0..5 (free outer surface: without n = 1).

    Target 1 % from 3 layers on (measured 0.7 %); reported besides: 2 layers 2.0 %, 1 layer 10.1 %, both at n = 5 with
    a free outer surface; with a fixed one 0.35, 1.0 and 3.6 %.
    """
    cases = [r for r in rows("annulus_plane_strain_fourier_compliance.csv") if r["outer"] == outer and int(r["n"]) <= 5]
    a, b = 0.03, 0.05
    mesh = HollowCylinder(
        inner_radius=a, thickness=b - a, length=0.01, axial=1, radial=layers, circumferential=40
    ).mesh()
    solid = TotalLagrange(
        mesh=mesh,
        material=SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0),
        quadrature=IRONS14,
    )
    held = np.zeros(mesh.nodes.shape, dtype=bool)
    held[:, 2] = True
    if outer == "fixed":
        held[mesh.outer.nodes] = True
    else:
        held[np.abs(np.sin(angles(mesh))) < 1e-9, 1] = True
        held[mesh.generatrix(mesh.outer, 0.0).nodes, 0] = True
    area = (
        -np.einsum(
            "ni,ni->n",
            DeadPressure(surface=mesh.bore, pressure=1.0).nodal_forces(mesh)[mesh.bore.nodes],
            mesh.bore.positions,
        )
        / a
    )
    errors = {}
    for case in cases:
        n = int(case["n"])
        wave = np.cos(n * mesh.bore.theta)
        load = DeadPressure(surface=mesh.bore, pressure=1e3, distribution=wave)
        u = equilibrium(solid, held=held, loads=[load], tolerance=1e-9).displacements[mesh.bore.nodes] / 1e3
        radial = u[:, 0] * np.cos(mesh.bore.theta) + u[:, 1] * np.sin(mesh.bore.theta)
        amplitude = (area * radial * wave).sum() / (area * wave**2).sum()
        errors[n] = abs(amplitude / float(case["u_r(a)_per_unit_p_n [m/Pa]"]) - 1)
    assert set(errors) == ({0, 1, 2, 3, 4, 5} if outer == "fixed" else {0, 2, 3, 4, 5})
    assert max(errors.values()) < tolerance


R, T = 0.25, 0.005
RING = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.0, density=7800.0)


def thin_ring(around):
    return HollowCylinder(
        inner_radius=R - T / 2, thickness=T, length=T, axial=1, radial=1, circumferential=around
    ).mesh()


@pytest.mark.parametrize("rule", [GAUSS27, IRONS14])
def test_pinched_thin_ring_shortens_and_lengthens_as_the_closed_forms(rule):
    """(pi/4 - 2/pi) P R^3/(E I) and (2/pi - 1/2) P R^3/(E I): textbook thin-ring bending, nu = 0."""
    mesh = thin_ring(120)
    held = quarter_symmetry(mesh)
    held[:, 2] = mesh.nodes[:, 2] < -0.4 * T
    top, low, side = (mesh.generatrix(mesh.outer, angle) for angle in (np.pi / 2, -np.pi / 2, 0.0))
    load = 1e-6
    loads = [
        LineLoad(line=top, force_per_length=(0, -load, 0)),
        LineLoad(line=low, force_per_length=(0, load, 0)),
    ]
    u = equilibrium(TotalLagrange(mesh=mesh, material=RING, quadrature=rule), held=held, loads=loads).displacements
    unit = load * R**3 / (1e6 * T**3 / 12)
    # thin-ring theory leaves out terms of order (T/R)^2; the mesh error is 0.2 %
    assert -2 * u[top.nodes, 1].mean() / unit == pytest.approx(np.pi / 4 - 2 / np.pi, rel=0.01)
    assert 2 * u[side.nodes, 0].mean() / unit == pytest.approx(2 / np.pi - 0.5, rel=0.01)


@pytest.mark.parametrize("rule", [GAUSS27, IRONS14])
def test_free_thin_ring_swings_in_plane_at_the_closed_form_frequencies(rule):
    """omega_n = n (n^2 - 1)/sqrt(n^2 + 1) sqrt(E I/(rho A R^4)), in-plane flexure of a thin ring, each one twice.

    Not with 8 points: a single row of elements then has spurious modes, see below.
    """
    mesh = thin_ring(80)
    omega, modes = eigenfrequencies(TotalLagrange(mesh=mesh, material=RING, quadrature=rule), count=18)
    unit = np.sqrt(1e6 * T**2 / 12 / (7800 * R**4))
    axial = (modes[..., 2] ** 2).sum(axis=1) / (modes**2).sum(axis=(1, 2))
    in_plane = omega[(axial < 0.1) & (omega > 0.1 * unit)][:4] / unit
    expected = [n * (n**2 - 1) / np.sqrt(n**2 + 1) for n in (2, 2, 3, 3)]
    # the target is 2 %; measured 0.4 % with 80 elements
    assert np.allclose(in_plane, expected, rtol=0.01)
    assert np.all(omega[:6] < 1e-2 * omega[6])


@pytest.mark.parametrize(("counts", "sound"), [((1, 1, 16), False), ((2, 1, 16), True), ((1, 2, 16), True)])
def test_reduced_integration_needs_two_rows_of_elements(counts, sound):
    """A ring of one row of elements with 8 points has mechanisms besides its six rigid motions; two rows lock them."""
    axial, radial, around = counts
    mesh = HollowCylinder(
        inner_radius=0.225, thickness=0.05, length=0.2, axial=axial, radial=radial, circumferential=around
    ).mesh()
    material = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
    full, reduced = (
        eigenfrequencies(TotalLagrange(mesh=mesh, material=material, quadrature=rule), count=8)[0]
        for rule in (GAUSS27, GAUSS8)
    )
    # sound: within 5 % of the full rule at this coarse mesh; unsound: a seventh mode near zero
    assert (abs(reduced[6] / full[6] - 1) < 0.05) == sound
