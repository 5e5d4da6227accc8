"""Supply areas on the grid: what they cover, and what is refused."""

from __future__ import annotations

import dataclasses
import math
from functools import partial

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.supply.areas import axial_span, circle, placed, strength, strengths
from exudyn_ehd.film.supply.cuts import SupplyMap
from exudyn_ehd.film.supply.rows import meeting_rows, supply_rows
from tests.sampling import sample

RADIUS, LENGTH = 0.025, 0.05
AREAS = [
    ehd.AxialGroove(angle=0.3, width_angle=0.4),
    ehd.AxialGroove(angle=-3.1, width_angle=0.4, length=0.03, pressure=1e5),
    ehd.CircumferentialGroove(width=0.01, pressure=2e5),
    ehd.CircumferentialGroove(z=0.012, width=0.006),
    ehd.Hole(angle=6.2, diameter=0.012, pressure=1e5),
    ehd.Pocket(angle=2.0, z=0.01, width_angle=0.5, length=0.01, pressure=3e5),
    ehd.Pocket(angle=2.0, width_angle=0.5, length=0.01, rotating=True),
]


def _inside(area, theta, z):
    """Plain twin: is one point (rad, m) inside?"""
    d = math.remainder(theta - getattr(area, "angle", 0.0), 2.0 * math.pi)
    if isinstance(area, ehd.Hole):
        return math.hypot(RADIUS * d, z - area.z) <= 0.5 * area.diameter
    if isinstance(area, ehd.CircumferentialGroove):
        return abs(z - area.z) <= 0.5 * area.width
    if abs(d) > 0.5 * area.width_angle:
        return False
    return abs(z - getattr(area, "z", 0.0)) <= 0.5 * (area.length or 0.875 * LENGTH)


@pytest.mark.parametrize("area", AREAS, ids=lambda a: type(a).__name__)
def test_twin(area):
    grid = ehd.bearing_grid(RADIUS, LENGTH, 64, 12)
    supply = SupplyMap((area,), grid)
    for i, theta in enumerate(grid.x):
        for j, z in enumerate(grid.z * RADIUS):
            end = j in (0, 12)
            assert supply.masks[0][i, j] == (_inside(area, theta, z) and not end)
            assert grid.fixed[i, j] == (end or supply.masks[0][i, j])


def test_edges_on_vertices_count_as_inside():
    grid = ehd.bearing_grid(RADIUS, LENGTH, 144, 10)
    supply = SupplyMap((ehd.AxialGroove(angle=math.pi, width_angle=math.radians(20.0)),), grid)
    covered = np.flatnonzero(supply.masks[0][:, 5])
    np.testing.assert_array_equal(covered, np.arange(68, 77))


def test_areas_in_the_journal_turn_with_it():
    grid = ehd.bearing_grid(RADIUS, LENGTH, 64, 12)
    supply = SupplyMap(tuple(AREAS[-2:]), grid)
    before = [m.copy() for m in supply.masks]
    assert not supply.turn(0.0)
    assert supply.turn(5.0 * 2.0 * math.pi / 64)
    np.testing.assert_array_equal(supply.masks[0], before[0])
    np.testing.assert_array_equal(supply.masks[1], np.roll(before[1], 5, axis=0))
    np.testing.assert_array_equal(grid.fixed[:, 1:-1], (supply.masks[0] | supply.masks[1])[:, 1:-1])
    supply.turn(2.0 * math.pi)
    np.testing.assert_array_equal(supply.masks[1], before[1])


def test_rows_lie_on_the_edges_of_circumferential_grooves():
    """Weights integrate every land's parabola and the grooves' pressures exactly."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        z, w = rng.uniform(-0.02, 0.02), LENGTH * rng.uniform(1e-4, 0.15)
        grooves = (ehd.CircumferentialGroove(z=z, width=w),)
        rows, weight = supply_rows(grooves, RADIUS, LENGTH, int(rng.integers(4, 16)), 0.75)
        assert rows.size % 2 == 1 and np.all(np.diff(rows) > 0.0)
        edges = np.array([-LENGTH / 2, z - w / 2, z + w / 2, LENGTH / 2]) / RADIUS
        at = np.abs(rows[:, None] - edges).argmin(axis=0)
        np.testing.assert_allclose(rows[at], edges, rtol=1e-15)
        assert at[1] >= 4 and at[3] - at[2] >= 4
        p = np.where(np.arange(rows.size) <= at[1], (rows - edges[0]) * (edges[1] - rows), 0.0)
        assert weight @ p == pytest.approx((edges[1] - edges[0]) ** 3 / 6.0, rel=1e-12)
        assert weight.sum() == pytest.approx(LENGTH / RADIUS, rel=1e-13)
    assert supply_rows((), RADIUS, LENGTH, 10, 0.75) is None


def test_rows_lie_on_the_edges_of_any_areas():
    """Rows lie on the edges, with few more than asked for and at least four intervals outside the areas."""
    rng = np.random.default_rng(4)
    for _ in range(30):
        z, length = rng.uniform(-0.015, 0.015), LENGTH * rng.uniform(0.01, 0.35)
        areas = [ehd.Pocket(angle=1.0, width_angle=0.5, z=z, length=length), AREAS[0], AREAS[4]]
        areas = placed(tuple(areas[: rng.integers(1, 4)]), LENGTH)
        n_z = int(rng.integers(6, 16))
        rows, weight = supply_rows(areas, RADIUS, LENGTH, n_z, 0.75)
        assert np.all(np.diff(rows) > 0.0) and rows.size % 2 == 1 and rows.size <= max(n_z, 8) + 16
        for edge in (z - length / 2, z + length / 2):
            assert np.abs(rows * RADIUS - edge).min() < 1e-15
        outside = np.flatnonzero(
            rows * RADIUS < min(z - length / 2, -0.4375 * LENGTH if len(areas) > 1 else 1.0) - 1e-12
        )
        assert outside.size >= 4
        assert weight @ np.cos(2.0 * rows) == pytest.approx(np.sin(2.0), rel=5e-3)


SIZES = {
    "journal_radius": RADIUS,
    "length": LENGTH,
    "radial_clearance": RADIUS / 1000.0,
    "lubricant": ehd.Lubricant(viscosity=0.02),
}


def _random_areas(rng, half, symmetric):
    """One to three areas; with a mirror image each, or about the mid-plane, if symmetric."""
    areas = []
    for _ in range(rng.integers(1, 4)):
        z = rng.uniform(0.2, 0.7) * half
        length = rng.uniform(0.02, 0.25) * half
        middle = rng.random() < 0.4
        at, size = (
            (0.0, float(rng.choice([0.3, 0.5, 0.6, 0.7, rng.uniform(0.1, 0.8)])) * half) if middle else (z, length)
        )
        kind = rng.integers(3)
        for side in (1.0, -1.0) if symmetric and not middle else (1.0,):
            angle = rng.uniform(0.0, 6.0)
            if kind == 0:
                areas.append(ehd.Pocket(angle=angle, width_angle=0.5, z=side * at, length=2.0 * size))
            elif kind == 1:
                areas.append(ehd.CircumferentialGroove(z=side * at, width=0.2 * size))
            else:
                areas.append(ehd.Hole(angle=angle, z=side * at, diameter=0.3 * size))
    return areas


def test_control_volumes_meet_on_the_edges_of_any_areas():
    """Random areas of a film that conserves mass: its rows' control volumes fill every area, and no more, where rows of
    other areas are not in the way; with four intervals at either end and an even number in all."""
    rng, holes = np.random.default_rng(12), 0
    for _ in range(200):
        z, length = rng.uniform(-0.012, 0.012), LENGTH * rng.uniform(0.01, 0.3)
        areas = [
            ehd.Pocket(angle=1.0, width_angle=0.5, z=z, length=length),
            ehd.AxialGroove(angle=3.0, width_angle=0.4, length=0.03),
            ehd.Hole(angle=5.0, z=z, diameter=10 ** rng.uniform(-3.3, -1.9)),
        ][rng.integers(3)]
        others = (AREAS[0],) if rng.random() < 0.3 else ()
        columns, n_z = int(rng.choice([48, 112, 192])), int(rng.integers(6, 24))
        rows, weight = meeting_rows(placed((areas, *others), LENGTH), RADIUS, LENGTH, n_z, 0.75, columns)
        faces = RADIUS * np.concatenate(([rows[0]], 0.5 * (rows[1:] + rows[:-1]), [rows[-1]]))
        assert np.all(weight > 0.0)
        for power in range(5):
            exact = (1.0 + (-1.0) ** power) / (power + 1.0) * (0.5 * LENGTH / RADIUS) ** (power + 1)
            assert weight @ rows**power == pytest.approx(exact, rel=1e-11, abs=1e-13)
        assert np.all(np.diff(rows) > 0.0) and rows.size % 2 == 1 and rows.size <= max(n_z, 8) + 24
        low, high = axial_span(areas)
        within = np.flatnonzero((rows * RADIUS > low) & (rows * RADIUS < high))
        if min(within[0], rows.size - 1 - within[-1]) < 4:
            assert others
        if isinstance(areas, ehd.Hole):
            holes += 1
            assert np.abs(rows * RADIUS - areas.z).min() < 1e-15
            if others:
                continue
            half = math.sqrt(0.25 * areas.diameter**2 - (RADIUS * rows[within[0]] - areas.z) ** 2)
            assert within.size == 1 or half > (0.5 - 1e-9) * 2.0 * math.pi * RADIUS / columns
        for edge in (low, high):
            assert np.abs(faces - edge).min() < 1e-9 * LENGTH
    assert holes > 40


@pytest.mark.parametrize(
    "layout", sample([supply_rows, partial(meeting_rows, columns=112)], 1), ids=["edges", "meeting"]
)
@pytest.mark.parametrize("symmetric", sample([True, False], 1))
def test_mirrored_areas_have_mirrored_rows(symmetric, layout):
    """A bearing that is symmetric about its mid-plane has rows that are; any other the mirrored rows of its image."""
    rng, tried = np.random.default_rng(11), 0
    while tried < 300:
        areas = _random_areas(rng, 0.5 * LENGTH, symmetric)
        image = [dataclasses.replace(area, z=-area.z) for area in areas]
        n_z = int(rng.integers(6, 17))
        try:
            ehd.JournalBearing(**SIZES, supply=tuple(areas))
        except ehd.InputError:
            continue  # areas that overlap
        tried += 1
        made = [layout(placed(tuple(a), LENGTH), RADIUS, LENGTH, n_z, 0.75) for a in (areas, image)]
        rows, weight = made[0]
        other, its_weight = made[0] if symmetric else made[1]
        np.testing.assert_allclose(rows, -other[::-1], rtol=0.0, atol=1e-13)
        np.testing.assert_allclose(weight, its_weight[::-1], rtol=1e-9, atol=1e-13)


@pytest.mark.parametrize("share", [0.3, 0.5, 0.6, 0.7])
def test_a_symmetric_groove_tilts_no_aligned_journal(share):
    groove = ehd.AxialGroove(angle=1.07, width_angle=0.4, length=share * LENGTH, pressure=1e5)
    for n_z in (6, 8, 10, 16):
        bearing = ehd.JournalBearing(**SIZES, film=ehd.FiniteLength(n_z=n_z), supply=(groove,))
        film = ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.6)
        assert np.abs(film.moment[:2]).max() < 1e-12 * np.abs(film.force).max() * LENGTH


def test_small_holes_feed_as_the_well_model_of_a_square_grid():
    """Peaceman's equivalent radius, 0.198 of the spacing; the links are as much shorter as the hole is wide."""
    rows = tuple(float(j) for j in range(-8, 9))
    for radius in (1e-4, 1e-3, 1e-2):
        exact = 1.0 / (1.0 + 2.0 / math.pi * math.log(0.198 / radius))
        hole = circle(rows, radius, 0.0)
        assert hole.factors(strength(rows, radius, 0.0)) == pytest.approx(exact, rel=5e-3)


def test_factors_of_a_hole_follow_its_size_and_place():
    """Factors of 60 sizes and of places between two columns change smoothly, and agree with the tables."""
    rng = np.random.default_rng(9)
    rows = (-9.0, -6.0, -3.5, -1.5, 0.0, 1.5, 4.0, 7.0, 10.0)
    for radius in rng.uniform(0.5, 3.0, 3):
        places, table = strengths(rows, radius)
        for offset in rng.uniform(-0.5, 0.5, 4):
            assert np.interp(offset, places, table) == pytest.approx(strength(rows, radius, offset), rel=0.1)
    fed = []
    for radius in np.geomspace(0.02, 0.7, 60):
        hole = circle(rows, radius, 0.2)
        fed.append(hole.factors(strength(rows, radius, 0.2)).sum())
    assert np.all(np.diff(fed) > 0.0)


def test_flows_count_a_shared_vertex_once():
    grid = ehd.bearing_grid(RADIUS, LENGTH, 64, 12)
    supply = SupplyMap((ehd.CircumferentialGroove(width=0.01), ehd.AxialGroove(angle=1.0, width_angle=0.5)), grid)
    inflow = np.random.default_rng(0).uniform(size=grid.shape)
    union = supply.masks[0] | supply.masks[1]
    assert supply.flows(inflow).sum() == pytest.approx(inflow[union].sum(), rel=1e-14)


def _bearing(**options):
    return ehd.JournalBearing(
        journal_radius=RADIUS, length=LENGTH, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02), **options
    )


@pytest.mark.parametrize(
    "options, message",
    [
        ({"supply": ehd.Hole(angle=0.0, diameter=0.01)}, "must be a tuple"),
        ({"supply": ("hole",)}, "must be a tuple"),
        ({"supply": np.zeros(2)}, "JournalBearing.supply must be a tuple"),
        ({"supply": 3, "film": ehd.LongBearing()}, "JournalBearing.supply must be a tuple"),
        (
            {"end_pressures": (0, -100)},
            r"SwiftStieber.cavity_pressure must not exceed JournalBearing.end_pressures \(0.0, -100.0\)",
        ),
        (
            {
                "end_pressures": (500.0, 500.0),
                "cavitation": ehd.SwiftStieber(cavity_pressure=100.0),
                "inlet": ehd.MaximumGap(),
            },
            "must not exceed the ambient pressure",
        ),
        ({"end_pressures": ("1", "2")}, "JournalBearing.end_pressures must be 2 finite numbers"),
        ({"supply": (ehd.Hole(angle=0.1, z=0.003, diameter=0.001, rotating=True),)}, "n_theta=158 would do"),
        ({"supply": (ehd.Hole(angle=0.1, z=1.0, diameter=0.001),)}, "outside the bearing"),
        ({"supply": (ehd.AxialGroove(angle=0.0, width_angle=0.01, rotating=True),)}, "n_theta=629 would do"),
        ({"supply": (ehd.AxialGroove(angle=0.1, width_angle=0.01),)}, "lies between two columns"),
        (
            {"supply": (ehd.Pocket(angle=1.0, z=0.02, width_angle=0.5, length=0.02, pressure=1e5),)},
            "and the bearing's end",
        ),
        ({"supply": (ehd.AxialGroove(angle=1.0, width_angle=6.2),)}, r"beside AxialGroove.* n_theta=2\d\d would do"),
        (
            {"supply": tuple(ehd.AxialGroove(angle=a, width_angle=0.3) for a in (1.0, 1.4))},
            r"supply\[0\] and \[1\]: the film between them spans 0.1 rad, .* n_theta=189 would do",
        ),
        ({"supply": (ehd.CircumferentialGroove(z=0.02, width=0.01),)}, r"the land from z = 0.025 to 0.025 m"),
        (
            {
                "supply": (
                    ehd.CircumferentialGroove(z=0.002, width=0.01),
                    ehd.CircumferentialGroove(z=-0.002, width=0.01, pressure=1e5),
                )
            },
            "or give one groove in place of two",
        ),
        (
            {
                "supply": (
                    ehd.AxialGroove(angle=0.0, width_angle=0.5),
                    ehd.CircumferentialGroove(width=0.02, pressure=1e5),
                )
            },
            "overlap",
        ),
        ({"supply": (ehd.AxialGroove(angle=0.0, width_angle=0.5),), "inlet": ehd.MaximumGap()}, "exclude each other"),
        (
            {"supply": (ehd.AxialGroove(angle=0.0, width_angle=0.5, pressure=-1e4),), "cavitation": ehd.Gumbel()},
            "must not be below Gumbel.cavity_pressure",
        ),
    ],
)
def test_refused_supply(options, message):
    with pytest.raises(ehd.InputError, match=message):
        _bearing(**options)


def test_end_pressures_in_an_array_are_a_pair():
    given = np.array([0.0, 0.0])
    assert _bearing(end_pressures=given) == _bearing(end_pressures=(0.0, 0.0))
    assert _bearing(end_pressures=given, film=ehd.ImpedanceMap()).end_pressures == (0.0, 0.0)


@pytest.mark.parametrize(
    "kind, values, message",
    [
        (ehd.AxialGroove, {"angle": 0.0, "width_angle": 20.0}, "math.radians"),
        (ehd.AxialGroove, {"angle": 0.0, "width_angle": 0.0}, "width_angle must be > 0"),
        (ehd.AxialGroove, {"angle": math.nan, "width_angle": 0.1}, "angle must be a finite number in rad, got nan"),
        (ehd.AxialGroove, {"angle": 0.0, "width_angle": 0.1, "length": -1.0}, "length must be > 0"),
        (ehd.AxialGroove, {"angle": 0.0, "width_angle": 0.1, "rotating": "yes"}, "rotating must be"),
        (ehd.Hole, {"angle": 0.0, "diameter": 0.0}, "diameter must be > 0"),
        (ehd.CircumferentialGroove, {"width": -1.0}, "width must be > 0"),
        (ehd.Pocket, {"angle": 0.0, "width_angle": 0.1, "length": 0.0}, "length must be > 0"),
        (
            ehd.Pocket,
            {"angle": 0.0, "width_angle": 0.1, "length": 0.1, "pressure": "high"},
            "pressure must be a finite number in Pa",
        ),
    ],
)
def test_refused_areas(kind, values, message):
    with pytest.raises(ehd.InputError, match=message):
        kind(**values)


def test_the_named_grid_does():
    rng = np.random.default_rng(2)
    for _ in range(20):
        area = ehd.AxialGroove(angle=rng.uniform(0.0, 6.0), width_angle=rng.uniform(0.01, 0.06), rotating=True)
        with pytest.raises(ehd.InputError) as error:
            _bearing(supply=(area,))
        n_theta = int(str(error.value).split("n_theta=")[1].split()[0])
        _bearing(supply=(area,), film=ehd.FiniteLength(n_theta=n_theta))


def test_cuts_keep_areas_and_their_middles():
    """Weights add up to the bearing's surface and to the middles of areas; links end at the edges."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        angle, width = rng.uniform(0.0, 6.0), rng.uniform(0.3, 1.5)
        area = ehd.Pocket(angle=angle, width_angle=width, length=0.02, rotating=True)
        supply = SupplyMap((area,), ehd.bearing_grid(RADIUS, LENGTH, 64, 12))
        grid, spin = supply.grid, rng.uniform(-10.0, 10.0)
        assert supply.turn(spin)
        assert grid.weight.sum() == pytest.approx(2.0 * math.pi * LENGTH / RADIUS, rel=1e-13)
        x = (grid.x - angle - spin + math.pi) % (2.0 * math.pi) - math.pi
        assert abs((grid.weight - supply.plain_weight)[:, 6] @ x) < 1e-12
        step = 2.0 * math.pi / 64
        inside, link = np.abs(x) <= width / 2, grid.cuts[0][:, 6]
        for i in np.flatnonzero(inside & ~np.roll(inside, -1)):
            assert step / link[i] == pytest.approx(max(x[i] + step - width / 2, 1e-4 * step), rel=1e-9)
        assert np.count_nonzero(link != 1.0) == 2 and np.all(grid.cuts[0][:, 0] == 1.0)
