"""Steady elastohydrodynamics: limits, closed forms, modal against nodal, condensed stiffness and damping."""

from __future__ import annotations

import dataclasses
import warnings

import numpy as np
import pytest
from scipy.optimize import root

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.bush import bore_modes
from tests.sampling import sample
from tests.solid_pressures import pressure_loads

SPEED = 3000 * 2 * np.pi / 60
C = 30e-6
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=4, radial=2, circumferential=24)


# To compare.
FINE = dataclasses.replace(CYLINDER, circumferential=40)
FINE_FILM = ehd.FiniteLength(n_theta=96, n_z=12)
# Soft bores deflect next to their ends within an interval of the former.
FINER_FILM = ehd.FiniteLength(n_theta=144, n_z=16)


def material(modulus=2.1e11):
    return ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0)


def modal(modulus=2.1e11, mesh=CYLINDER, **options):
    return ehd.ModalBush(mesh=mesh, material=material(modulus), **options)


def nodal(modulus=2.1e11, mesh=CYLINDER):
    return ehd.ANCFBush(mesh=mesh, material=material(modulus))


def make_bearing(bush, **options):
    given = {
        "journal_radius": 0.03,
        "length": 0.066,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=9e-3),
        "film": ehd.FiniteLength(n_theta=64, n_z=8),
        "bush": bush,
    }
    return ehd.JournalBearing(**(given | options))


def solve(bush, ratio=0.8, tilt=(0.0, 0.0), **options):
    return ehd.steady(make_bearing(bush, **options), speed=SPEED, eccentricity_ratio=ratio, tilt=tilt)


@pytest.mark.slow
@pytest.mark.parametrize("make", [modal, nodal], ids=["modal", "nodal"])
def test_rigid_limit_is_reached_at_first_order_in_the_compliance(make):
    rigid = solve(None)
    loss = [1.0 - solve(make(E)).peak_pressure / rigid.peak_pressure for E in (2.1e13, 2.1e14, 2.1e15)]
    # ratio 10 at first order; the next order is the loss itself, 0.25 % at the softest
    assert loss[0] / loss[1] == pytest.approx(10.0, rel=0.02)
    assert loss[1] / loss[2] == pytest.approx(10.0, rel=0.02)
    assert 0.0 < loss[0] < 0.01


@pytest.mark.parametrize("make", sample([modal, nodal], 1), ids=["modal", "nodal"])
def test_uniform_pressure_opens_the_bore_as_lame_says_and_leaves_no_force(make):
    p, n_z = 1e7, 8
    bearing = make_bearing(make(), end_pressures=(p, p), film=ehd.FiniteLength(n_theta=64, n_z=n_z))
    model = build_model(bearing)
    motion = np.zeros(10)
    film = model.evaluate_steady(motion).film
    assert np.allclose(film.oil.P * film.scales.pressure, p, rtol=1e-9)
    # plane strain with the outer surface held: u = B (1/r - r/b^2)
    E, nu, a, b = 2.1e11, 0.3, 0.03, 0.05
    lam, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    expected = p / (2 * (lam + mu) / b**2 + 2 * mu / a**2) * (1 / a - a / b**2)
    displacement = film.bore.displacement * C
    # the ends are free: a length of 3.3 thicknesses leaves 1.8 % at the mid-plane
    assert np.allclose(displacement[:, n_z // 2], expected, rtol=0.02)
    # around the bore it varies by the interpolation between 48 nodes
    assert np.allclose(displacement, displacement[:1], rtol=0, atol=1e-3 * expected)
    assert np.abs(film.loads.wrench).max() < 1e-9 * p * 2 * a * 0.066
    if make is nodal:
        assert np.abs(film.bore.load.reshape(-1, 2).sum(axis=0)).max() < 1e-9 * p * 2 * a * 0.066


@pytest.mark.parametrize("n_z", sample([8, 24], 0))
def test_pressure_that_falls_from_end_to_end_deforms_the_bore_alike_on_any_grid(n_z):
    """Against the mesh under consistent nodal forces of the same pressure.

    Modes hold uniform and axially linear pressure exactly.
    """
    p = 1e7
    bush = modal(tolerance=0.1)
    bearing = make_bearing(bush, end_pressures=(p, 0.0), film=ehd.FiniteLength(n_theta=64, n_z=n_z))
    model = build_model(bearing)
    load = model.evaluate(np.zeros(10)).bore.load
    modes = bore_modes(bush)
    mesh = modes.mesh
    loads = pressure_loads(mesh.bore, len(mesh.nodes), [lambda theta, zeta: 0.5 * p * (1.0 - zeta)])[:, 0]
    expected = modes.displacements.reshape(modes.count, -1) @ loads
    # Gauss points on the curved faces against points on the cylinder, whose area differs by the chords' 1e-4
    assert np.allclose(load, expected, rtol=0, atol=3e-4 * np.abs(expected).max())


@pytest.mark.parametrize(
    "cavitation",
    [pytest.param(ehd.SwiftStieber(), id="swift"), pytest.param(ehd.Gumbel(), id="gumbel", marks=pytest.mark.slow)],
)
@pytest.mark.parametrize("modulus", sample([2.1e11, 7e10, 3e9]), ids=["steel", "aluminium", "polymer"])
@pytest.mark.parametrize("tilt", sample([((0.0, 0.0),), ((0.0, 1e-4),)], 0), ids=["aligned", "tilted"])
def test_default_modes_are_within_one_per_cent_of_the_nodes(modulus, tilt, cavitation):
    bushes = modal(modulus, FINE, tilted=tilt != (0.0, 0.0)), nodal(modulus, FINE)
    reduced, full = (solve(b, tilt=tilt, film=FINER_FILM, cavitation=cavitation) for b in bushes)
    assert reduced.peak_pressure == pytest.approx(full.peak_pressure, rel=0.01)
    assert reduced.minimum_gap == pytest.approx(full.minimum_gap, rel=0.01)
    assert np.hypot(*reduced.force[:2]) == pytest.approx(np.hypot(*full.force[:2]), rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("modulus", [2.1e11, 7e10, 3e9], ids=["steel", "aluminium", "polymer"])
def test_default_modes_suit_the_default_film(modulus):
    """Within the default's one per cent of a film converged on fine modes (polymer 0.6), finer modes within half."""
    default = ehd.FiniteLength()
    fine = ehd.FiniteLength(n_theta=192, n_z=24)
    truth = solve(modal(modulus, FINE, tolerance=5e-3, tilted=False), film=fine)
    got = solve(modal(modulus, FINE, tilted=False), film=default)
    finer = solve(modal(modulus, FINE, tolerance=0.01, tilted=False), film=default)
    assert got.peak_pressure == pytest.approx(truth.peak_pressure, rel=1e-2)
    assert got.minimum_gap == pytest.approx(truth.minimum_gap, rel=1e-2)
    assert finer.peak_pressure == pytest.approx(truth.peak_pressure, rel=5e-3)
    assert finer.minimum_gap == pytest.approx(truth.minimum_gap, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("modulus", "tilt"), [(6e10, 0.0), (2.1e11, 1e-4)], ids=["soft, aligned", "steel, tilted"])
def test_many_modes_are_within_a_thousandth_of_the_nodes(modulus, tilt):
    """Both agree at small strains; modes are linear, nodes are not: at 2.1e10 Pa they differ by 1.1e-3."""
    bushes = modal(modulus, FINE, tolerance=5e-3, tilted=tilt > 0.0), nodal(modulus, FINE)
    reduced, full = (solve(b, film=FINE_FILM, tilt=(0.0, tilt)) for b in bushes)
    assert reduced.peak_pressure == pytest.approx(full.peak_pressure, rel=1e-3)
    assert reduced.minimum_gap == pytest.approx(full.minimum_gap, rel=1e-3)


@pytest.mark.slow
def test_flexibility_widens_the_film_and_lowers_the_peak():
    results = [solve(None)] + [solve(modal(E, tilted=False)) for E in (2.1e12, 2.1e11, 2.1e10)]
    peaks = [r.peak_pressure for r in results]
    extents = [r.unbroken[:, r.z.size // 2].mean() for r in results]
    assert peaks == sorted(peaks, reverse=True)
    assert extents == sorted(extents)
    assert extents[-1] > extents[0]
    # the paper's journal (30 um clearance, 24 um eccentricity): 33.1 to 33.3 MPa rigid, 27.1 MPa with a steel bush;
    # 2 %: grids differ
    assert peaks[0] == pytest.approx(33.2e6, rel=0.02)
    assert peaks[2] == pytest.approx(27.1e6, rel=0.02)
    assert peaks[3] == pytest.approx(12.1e6, rel=0.02)


@pytest.mark.slow
def test_an_aligned_film_deforms_the_bore_symmetrically():
    film = solve(modal())
    d = film.bore_displacement
    # rounding of a mesh that is symmetric itself
    assert np.allclose(d, d[:, ::-1], atol=1e-9 * d.max())


@pytest.mark.slow
def test_an_eccentricity_beyond_the_clearance_is_reached():
    film = solve(modal(3e9), ratio=1.3)
    assert film.minimum_gap > 0.0
    assert film.peak_pressure > solve(modal(3e9), ratio=0.8).peak_pressure


def test_bore_settles_in_few_newton_steps():
    model = build_model(make_bearing(modal()))
    before = model.parts.evaluations
    evaluation = model.evaluate_steady(np.array([0.8 * C, 0, 0, 0, 0, 0, 0, 0, SPEED, 0.0]))
    # convex, from the undeformed bore: four steps near the solution and a few on the way
    assert model.parts.evaluations - before <= 11
    held = model.elasticity.force(evaluation.bore.coordinates)
    assert np.allclose(evaluation.bore.load, held, rtol=0, atol=1e-6)


@pytest.mark.parametrize("make", sample([modal, nodal], 0), ids=["modal", "nodal"])
def test_equilibrium_carries_the_load_with_the_condensed_stiffness(make):
    bearing = make_bearing(make())
    load = (0.0, -20e3)
    eq = ehd.equilibrium(bearing, speed=SPEED, load=load)
    assert np.allclose(eq.film.force[:2], (0.0, 20e3), atol=1e-5)
    numeric = np.empty((2, 2))
    for i in range(2):
        moved = []
        for sign in (1, -1):
            step = np.zeros(2)
            step[i] = sign * 1e-4 * C
            x, y = eq.position + step
            moved.append(
                ehd.steady(
                    bearing, speed=SPEED, eccentricity_ratio=np.hypot(x, y) / C, direction=np.arctan2(y, x)
                ).force[:2]
            )
        numeric[:, i] = -(moved[0] - moved[1]) / (2e-4 * C)
    # the active set may change by a vertex within the step
    assert np.allclose(eq.stiffness, numeric, rtol=0, atol=2e-3 * abs(numeric).max())
    rigid = ehd.equilibrium(dataclasses.replace(bearing, bush=None), speed=SPEED, load=load)
    # by 0.7 and 0.8 % on 192 x 20, with the rupture line inside the cells and on the vertices
    assert 1.004 < eq.stiffness[1, 1] / rigid.stiffness[1, 1] < 1.012
    assert eq.eccentricity_ratio > rigid.eccentricity_ratio


@pytest.mark.slow
def test_damping_is_that_of_a_bore_that_follows_slowly():
    """K q = Q with the rates of journal and bore.

    Dq/dx by differences of steady films, the balance by scipy, force by differences.
    """
    bearing = make_bearing(modal(7e10, tolerance=0.1, tilted=False))
    eq = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -20e3))
    model = build_model(bearing)
    h, v = 1e-4 * C, 1e-6

    def settled(x, y):
        evaluation = model.evaluate_steady(np.array([x, y, 0, 0, 0, 0, 0, 0, SPEED, 0.0]))
        return evaluation.bore.coordinates.copy()

    x, y = eq.position
    at_rest = settled(x, y)
    follow = np.stack(
        [(settled(x + h, y) - settled(x - h, y)) / (2 * h), (settled(x, y + h) - settled(x, y - h)) / (2 * h)]
    )

    def force(velocity):
        def motion(q):
            return np.concatenate(([x, y, 0, 0, *velocity, 0, 0, SPEED, 0.0], q, velocity @ follow))

        def lack(scaled):
            q = scaled * C
            return (model.evaluate(motion(q)).bore.load - model.elasticity.force(q)) / 20e3 / C

        found = root(lack, at_rest / C, tol=1e-12)
        assert np.abs(found.fun).max() * C < 1e-6
        return model.evaluate(motion(found.x * C)).wrench[:2].copy()

    for i, axis in enumerate(np.eye(2)):
        damping = -(force(v * axis) - force(-v * axis)) / (2 * v)
        # the active set may change by a vertex within the differences
        assert np.allclose(eq.damping[:, i], damping, rtol=0, atol=2e-3 * abs(eq.damping).max())
    rigid = ehd.equilibrium(dataclasses.replace(bearing, bush=None), speed=SPEED, load=(0.0, -20e3))
    # without the bore's part it would be another
    assert abs(eq.damping - rigid.damping).max() > 0.05 * abs(rigid.damping).max()


@pytest.mark.parametrize(
    ("bush", "message"),
    [
        (3, "bush must be ElasticLiner"),
        (ehd.ANCFBush(mesh=dataclasses.replace(CYLINDER, inner_radius=0.04), material=material()), "bore radius"),
        (ehd.ANCFBush(mesh=dataclasses.replace(CYLINDER, length=0.03), material=material()), "as long as the film"),
    ],
)
def test_wrong_bushes_are_named(bush, message):
    with pytest.raises(ehd.InputError, match=message):
        make_bearing(bush)


@pytest.mark.filterwarnings("ignore::exudyn_ehd.StrainWarning")
def test_equilibrium_on_a_bush_that_gives_way_by_more_than_the_clearance():
    """A rigid bore's clearance is no limit for a journal on a soft bush."""
    mesh = ehd.HollowCylinder(inner_radius=0.025, thickness=0.01, length=0.025, axial=2, radial=2, circumferential=16)
    soft = ehd.ModalBush(
        mesh=mesh,
        tolerance=0.2,
        tilted=False,
        material=ehd.SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=1000.0),
    )
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=5e-5,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=32, n_z=6),
        bush=soft,
    )
    eq = ehd.equilibrium(bearing, speed=300.0, load=(0.0, -20.0))
    assert eq.eccentricity_ratio > 1.2
    assert eq.film.minimum_gap > 0.0
    assert np.allclose(eq.film.force[:2], (0.0, 20.0), atol=1e-8 * 20.0)


@pytest.mark.slow
def test_the_audit_takes_the_profile_from_the_undeformed_bore():
    """A soft bush deflects by more than its crown's height: the profile's indicator is that of a rigid bush with the
    same crown, for the minimum film thickness at hand; without a crown there is none."""
    crown = ehd.Crown(drop=1e-6)
    film = solve(modal(2.1e10), profile=crown)
    value = film.audit()["profile"].value
    heights = np.ptp(build_model(make_bearing(None, profile=crown)).effects.gap_terms[0].field(None)) * C
    assert value == pytest.approx(heights / film.minimum_gap, rel=1e-9)
    assert film.audit()["elasticity"].value > 2.0 * value
    assert "profile" not in str(solve(modal(2.1e10)).audit())


@pytest.mark.parametrize("kind", sample([ehd.ANCFBush, ehd.ModalBush], 0))
def test_a_bore_that_strains_a_linear_bush_beyond_its_range_says_so(kind):
    """A wall of 1 mm that yields by 1.4 % of it; stiffer by ten it says nothing. Structured and own mesh alike."""
    cylinder = ehd.HollowCylinder(
        inner_radius=0.02005, thickness=1e-3, length=0.02, axial=2, radial=1, circumferential=24
    )
    own = ehd.mesh_from_arrays(cylinder.mesh().nodes, cylinder.mesh().elements, bore_radius=0.02005)
    for mesh, modulus in ((cylinder, 2e7), (own, 2e7), (cylinder, 2e8)):
        b = ehd.JournalBearing(
            journal_radius=0.02,
            length=0.02,
            radial_clearance=50e-6,
            lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=48, n_z=8),
            bush=kind(mesh=mesh, material=material(modulus)),
        )
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = ehd.steady(b, speed=314.0, eccentricity_ratio=0.5)
        strain = np.abs(result.bore_displacement).max() / 1e-3
        said = [str(w.message) for w in caught if w.category is ehd.StrainWarning]
        assert (strain > 0.01) == (modulus == 2e7)
        assert bool(said) == (modulus == 2e7 and kind is ehd.ModalBush)
        if said:
            # next to the ends of the film a layer strains by more than its displacement over its thickness
            told = float(said[0].partition("strains by ")[2].partition("%")[0]) / 100.0
            assert 0.9 * strain < told < 2.5 * strain
