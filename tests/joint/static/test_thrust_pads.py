"""Tilting thrust pads under an axial load: balance of an independent film, similarity, small motions, messages."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.reference.sector_film import sector_film

MU = 0.03
PADS = ehd.TiltingThrustPads(
    inner_radius=0.05,
    outer_radius=0.1,
    pads=8,
    extent=0.65,
    pivot_radius=0.077,
    pivot_angle=0.39,
    clearance=60e-6,
    lubricant=ehd.Lubricant(viscosity=MU),
    pad_mass=0.3,
    pad_inertia=(6e-5, 9e-5),
)


def _with(**options):
    return dataclasses.replace(PADS, **options)


@pytest.mark.parametrize(
    ("options", "speed"),
    (
        ({}, 300.0),
        ({"pivot_radius": 0.075, "pivot_angle": 0.38}, 300.0),
        ({"pivot_radius": 0.08, "pivot_angle": 0.27}, -150.0),
        ({"pivot_angle": 0.325, "crown": 20e-6}, 200.0),
        ({"pivot_angle": 0.325, "crown": 60e-6}, -200.0),
        ({"pads": 5, "extent": 1.0, "pivot_angle": 0.62, "inner_radius": 0.04, "pivot_radius": 0.073}, 300.0),
    ),
)
def test_balance_of_an_independent_film(options, speed):
    """Load and pivot of the position found, by finite differences; inclination, gaps and oil as they belong to it."""
    pads, load = _with(**options), 25e3
    found = ehd.equilibrium(pads, speed=speed, load=load)
    (radial, around), depth, reach = found.inclination, pads.pivot_film - pads.clearance, pads.pivot_radius
    motion = [found.film_thickness - depth - radial * reach - pads.clearance, -radial, -around, 0.0, 0.0, 0.0, speed]
    size = {"inner": pads.inner_radius, "outer": 0.1, "first": -pads.pivot_angle, "extent": pads.extent}
    size |= {"clearance": pads.clearance, "viscosity": MU, "crown": pads.crown}
    coarse, fine = (sector_film(motion, **size, shape=shape) for shape in ((61, 31), (121, 61)))
    force, mx, my, torque, peak, *flows = fine + (fine - coarse) / 3.0
    assert pads.pads * force == pytest.approx(load, rel=3e-3)
    assert abs(mx / force) < 5e-4 * 0.1 * pads.extent
    assert abs(my / force + reach) < 5e-4 * (0.1 - pads.inner_radius)
    # about the collar's axis, which is tilted against the pad
    torque -= radial * mx + around * my
    assert found.friction_torque == pytest.approx(pads.pads * torque, rel=1e-3)
    # the extrapolated peak is that of vertices
    assert found.peak_pressure == pytest.approx(peak, rel=5e-3)
    assert found.minimum_gap == pytest.approx(found.gap.min()) and found.maximum_gap == found.gap.max()
    flows, behind = pads.pads * np.array(flows), int(speed > 0.0)
    if pads.crown:
        # behind a crown the film is torn: it carries on what it has there, less than the Couette flow of a full gap
        flows[behind] -= flows.sum()
    # second order on either side; those of a crown are worst, by its thin film in the middle
    assert found.flows == pytest.approx(flows, abs=3e-3 * np.abs(flows).max())
    assert np.all(found.flows[:2] * [-speed, speed] > 0.0) and np.all(found.flows[2:] > 0.0)
    assert found.residual < 1e-9


def test_similar_films():
    """Films of one shape carry in proportion to 1 / h^2; the reference configuration does not matter."""
    first = ehd.equilibrium(PADS, speed=300.0, load=30e3)
    for pads, load in ((PADS, 30e1), (_with(clearance=5e-6), 30e5)):
        other = ehd.equilibrium(pads, speed=300.0, load=load)
        by = math.sqrt(30e3 / load)
        assert other.film_thickness == pytest.approx(by * first.film_thickness, rel=1e-7)
        assert other.inclination == pytest.approx(by * first.inclination, rel=1e-6)
    turned = ehd.equilibrium(_with(pivot_angle=0.26), speed=-300.0, load=30e3)
    assert turned.film_thickness == pytest.approx(first.film_thickness, rel=1e-7)
    assert turned.inclination == pytest.approx(first.inclination * [1, -1], rel=1e-6)


def test_stiffness_at_rest_and_without_pads_that_follow():
    """K at low frequency is the derivative of the load, -2 W / h by similarity; heavy pads stand still."""
    found = ehd.equilibrium(PADS, speed=300.0, load=30e3)
    slow = found.dynamic_stiffness([1e-3])[0]
    assert slow.real == pytest.approx(2.0 * 30e3 / found.film_thickness, rel=1e-6)
    held = ehd.equilibrium(_with(pad_inertia=(1e4, 1e4)), speed=300.0, load=30e3)
    assert held.stiffness == pytest.approx(8 * held.pad_stiffness[0, 0], rel=1e-5)
    assert held.damping == pytest.approx(8 * held.pad_damping[0, 0], rel=1e-5)
    again = found.dynamic_stiffness([300.0])[0]
    assert [again.real, again.imag / 300.0] == pytest.approx([found.stiffness, found.damping])


def test_pivots_with_a_spring():
    """A soft pivot is a spring behind the film, and the pad a mass between them."""
    k, c, nu = 2e8, 3e4, 500.0
    rigid, soft = (
        ehd.equilibrium(p, speed=300.0, load=30e3) for p in (PADS, _with(pivot_stiffness=k, pivot_damping=c))
    )
    assert soft.film_thickness == rigid.film_thickness
    film, support = rigid.dynamic_stiffness([nu])[0] / 8, k + 1j * nu * c
    # collar on film, pad's mass, support
    matrix = np.array([[film, -film], [-film, film + support - nu**2 * PADS.pad_mass]])
    expected = 8.0 / np.linalg.inv(matrix)[0, 0]
    assert soft.dynamic_stiffness([nu])[0] == pytest.approx(expected, rel=1e-9)


def test_matrices_by_differences():
    """K by equilibria under other loads, with pads that tilt on; the tilting stiffness of a pad is positive."""
    found = ehd.equilibrium(PADS, speed=300.0, load=30e3)
    step = 1e-5
    up, down = (ehd.equilibrium(PADS, speed=300.0, load=30e3 * (1 + s * step)) for s in (1, -1))
    moved = np.array([p.film_thickness for p in (up, down)]), np.array([p.inclination for p in (up, down)])
    change = np.array([moved[0][0] - moved[0][1], *((moved[1][0] - moved[1][1])[::-1] * [-1, 1])])
    # -(K v) = (force, 0, 0): of one pad
    assert -found.pad_stiffness @ change == pytest.approx(
        [2 * step * 30e3 / 8, 0.0, 0.0], abs=1e-6 * 2 * step * 30e3 / 8
    )
    assert np.linalg.eigvals(found.pad_stiffness[1:, 1:]).real.min() > 0.0
    assert np.linalg.eigvals(found.pad_damping).real.min() > 0.0


def test_plausible_beside_a_published_bearing():
    """Pads of a hydro generator, published with oil that heats up: oil of one viscosity in between is near them."""
    pads = ehd.TiltingThrustPads(
        inner_radius=1.15,
        outer_radius=1.725,
        pads=12,
        extent=math.radians(26),
        pivot_radius=1.4425,
        pivot_angle=math.radians(15),
        clearance=150e-6,
        lubricant=ehd.Lubricant(viscosity=0.045),
        pad_mass=1000.0,
        pad_inertia=(20.0, 20.0),
    )
    found = ehd.equilibrium(pads, speed=90 * 2 * math.pi / 60, load=13.32e6)
    # its table: film at the pivot 131 um, largest 207, smallest 82, peak 6.96 MPa, 3.18e11 N/m, 1.08e10 N s/m
    assert 0.7 < found.film_thickness / 131e-6 < 1.3
    assert 0.6 < found.minimum_gap / 82e-6 < 1.4 and 0.6 < found.maximum_gap / 207e-6 < 1.4
    assert 0.7 < found.peak_pressure / 6.96e6 < 1.3
    assert 0.4 < found.stiffness / 3.18e11 < 2.5 and 0.4 < found.damping / 1.08e10 < 2.5


def test_refused():
    """Plane pads on central pivots carry nothing; arguments of journals are not those of pads."""
    for options, speed in (({"pivot_angle": 0.325}, 300.0), ({}, -300.0), ({"pivot_radius": 0.055}, 300.0)):
        with pytest.raises(ehd.FilmError, match=r"no film was found .* give them a pivot at about 0\.6 .* crown="):
            ehd.equilibrium(_with(**options), speed=speed, load=30e3)
    for wrong, message in (
        ({"load": (0.0, -1e3)}, "load must be"),
        ({"load": -1e3}, "load must be > 0 N"),
        ({"speed": 0.0}, "speed must not be zero"),
        ({"axial_load": 10.0}, "are for a JournalBearing"),
    ):
        with pytest.raises(ehd.InputError, match=f"equilibrium.*{message}"):
            ehd.equilibrium(PADS, **{"speed": 300.0, "load": 30e3} | wrong)
