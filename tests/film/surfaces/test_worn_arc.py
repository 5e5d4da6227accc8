"""`WornArc`: Dufrane's worn bore, its extent, its circle, and films in it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

RADIUS, CLEARANCE, LENGTH = 0.025, 25e-6, 0.025
Z = np.array([-0.01, 0.0, 0.01])


def random_arcs(count):
    """Return arcs from a hundredth of the clearance to all of it, at any angle."""
    rng = np.random.default_rng(1983)
    for _ in range(count):
        depth = CLEARANCE * 10.0 ** rng.uniform(-2.0, 0.0)
        yield ehd.WornArc(worn_depth=depth, angle=rng.uniform(-9.0, 9.0), clearance=CLEARANCE)


def test_depth_and_extent_are_dufrane_s():
    """d = d_0 - c (1 + cos theta) with theta from the place opposite to the deepest, between its two zeros alone."""
    for arc in random_arcs(20):
        phi = np.linspace(-math.pi, math.pi, 2001)
        depth = arc.depth(arc.angle + phi, Z, LENGTH)
        np.testing.assert_array_equal(depth, depth[:, :1] * np.ones(3))
        formula = arc.worn_depth - CLEARANCE * (1.0 + np.cos(phi + math.pi))
        inside = np.abs(phi) < 0.5 * arc.extent
        np.testing.assert_allclose(depth[inside, 0], formula[inside], atol=1e-18)
        assert np.all(depth[~inside] == 0.0) and np.all(formula[~inside] < 1e-18)
        # closed form of the worn angle, from the triangle of both centres and the end of the arc
        assert 2.0 * math.sin(0.25 * arc.extent) ** 2 == pytest.approx(arc.worn_depth / CLEARANCE, rel=1e-12)
        assert arc.depth(np.array([arc.angle]), Z, LENGTH)[0, 0] == pytest.approx(arc.worn_depth, rel=1e-12)
    assert ehd.WornArc(worn_depth=CLEARANCE, angle=0.0, clearance=CLEARANCE).extent == pytest.approx(math.pi, rel=1e-12)


def test_worn_surface_is_a_circle():
    """Its radius is R + d_0, about the journal that touches the unworn bore; thin films leave out c^2 / R."""
    for arc in random_arcs(20):
        phi = np.linspace(-0.5, 0.5, 101) * arc.extent
        r = RADIUS + CLEARANCE + arc.depth(arc.angle + phi, Z, LENGTH)[:, 0]
        distance = np.hypot(r * np.cos(phi) - CLEARANCE, r * np.sin(phi))
        np.testing.assert_allclose(distance, RADIUS + arc.worn_depth, atol=CLEARANCE**2 / RADIUS)


def test_film_of_a_journal_that_has_worn_the_bore(make_bearing):
    """It is as thick as the arc is deep all over it. Pressure without a wedge is harmonic: its peak is at an edge."""
    arc = ehd.WornArc(worn_depth=8e-6, angle=0.7, clearance=CLEARANCE)
    film = ehd.steady(make_bearing(0.5, profile=arc), speed=100.0, eccentricity_ratio=1.0, direction=0.7)
    away = np.abs(np.angle(np.exp(1j * (film.theta - 0.7))))
    inside = away < 0.5 * arc.extent
    np.testing.assert_allclose(film.gap[inside], 8e-6, rtol=1e-9)
    outside = CLEARANCE * (1.0 - np.cos(away[~inside]))
    np.testing.assert_allclose(film.gap[~inside], outside[:, None] * np.ones(film.z.size), rtol=1e-9)
    # between two columns the film takes the arc as a straight line
    assert film.minimum_gap == pytest.approx(8e-6, rel=2e-3)
    inner = away < 0.3 * arc.extent
    assert film.pressure[inner].max() < 0.9 * film.peak_pressure
    entry = math.remainder(film.peak_angle - 0.7, 2.0 * math.pi)
    assert entry == pytest.approx(-0.5 * arc.extent, abs=0.1)


@pytest.mark.parametrize("seed", range(3))
def test_film_is_that_of_a_table(make_bearing, seed):
    """Equilibria under one load in the arc, and in a table of its depths at 720 angles."""
    rng = np.random.default_rng(seed)
    arc = ehd.WornArc(worn_depth=rng.uniform(3e-6, 12e-6), angle=rng.uniform(-3.0, 3.0), clearance=CLEARANCE)
    angles = np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False)
    table = ehd.ProfileTable(angles=angles, positions=(-0.01, 0.01), depths=arc.depth(angles, Z[:2], LENGTH))
    load = 1500.0 * np.array([math.cos(arc.angle), math.sin(arc.angle)])
    worn, same = (
        ehd.equilibrium(make_bearing(0.5, profile=shape), speed=200.0, load=tuple(load)) for shape in (arc, table)
    )
    plain = ehd.equilibrium(make_bearing(0.5), speed=200.0, load=tuple(load))
    np.testing.assert_allclose(worn.position, same.position, atol=1e-3 * CLEARANCE)
    np.testing.assert_allclose(worn.stiffness, same.stiffness, atol=5e-3 * np.abs(same.stiffness).max())
    assert worn.eccentricity_ratio > plain.eccentricity_ratio + 0.02


def test_input():
    with pytest.raises(ehd.InputError, match="worn_depth must be at most the clearance"):
        ehd.WornArc(worn_depth=30e-6, angle=0.0, clearance=CLEARANCE)
    with pytest.raises(ehd.InputError, match=r"WornArc\.worn_depth"):
        ehd.WornArc(worn_depth=0.0, angle=0.0, clearance=CLEARANCE)
