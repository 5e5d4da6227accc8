"""The impedance map against the film behind it: error, tangent, smoothness, frames, cache, refusals."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.solvers.impedance_map import (
    impedance_force,
    impedance_nodes,
    interpolate,
)
from exudyn_ehd.joint.model.build import build_model

SMALL = ehd.ImpedanceMap(n_theta=64, n_z=8, n_eccentricity=12, n_direction=17, largest_eccentricity_ratio=0.9)
C = 25e-6


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("maps")
        patch.setenv("EXUDYN_EHD_CACHE", str(folder))
        yield folder


def _motion(rng, largest=0.98, speed=150.0):
    eps, a, b = 1.0 - math.exp(rng.uniform(math.log(1.0 - largest), 0.0)), *rng.uniform(0.0, 2.0 * np.pi, 2)
    v = 10.0 ** rng.uniform(-4.0, -2.0)
    motion = np.zeros(10)
    motion[:2] = eps * C * math.cos(a), eps * C * math.sin(a)
    motion[4:6] = v * math.cos(b), v * math.sin(b)
    motion[8], motion[9] = rng.choice([speed, -speed, 0.0]), rng.normal()
    return motion


@pytest.mark.slow
@pytest.mark.parametrize("closure", [ehd.SwiftStieber(), ehd.Gumbel()], ids=lambda c: type(c).__name__)
def test_default_map_within_one_percent_of_the_film(make_bearing, measured, closure):
    """Relative to the force at the very state: rotation, squeeze and both, any orientation of the grid."""
    model = build_model(make_bearing(film=ehd.ImpedanceMap(), cavitation=closure))
    film = build_model(make_bearing(film=ehd.FiniteLength(n_theta=320, n_z=10), cavitation=closure))
    rng = np.random.default_rng(8)
    errors = []
    for _ in range(150):
        motion = _motion(rng)
        exact, guess = film.evaluate(motion), model.evaluate(motion)
        assert guess.status is ehd.Status.CONVERGED
        errors.append(np.linalg.norm(guess.wrench[:2] - exact.wrench[:2]) / np.linalg.norm(exact.wrench[:2]))
        size = abs(exact.wrench[5]) + np.linalg.norm(exact.wrench[:2]) * C
        # The Couette part is exact to the film's quadrature; the rest is the force's error times the eccentricity.
        assert abs(guess.wrench[5] - exact.wrench[5]) < 0.01 * size
        assert guess.wrench[2] == pytest.approx(exact.wrench[2], rel=1e-3)
        mine, theirs = guess.quantities(), exact.quantities()
        assert mine["minimum_gap"] == pytest.approx(theirs["minimum_gap"], rel=1e-9)
        scale = np.linalg.norm(exact.wrench[:2]) * (C * 150.0 + np.hypot(*motion[4:6])) + abs(theirs["power_loss"])
        assert abs(mine["power_loss"] - theirs["power_loss"]) < 0.01 * scale
    measured("worst of 150 states", max(errors), 0.01)
    measured("median of 150 states", float(np.median(errors)), 1e-4)


@pytest.mark.slow
def test_a_line_inside_the_cells_has_a_map_of_its_own(make_bearing, cache):
    nodes, medians, plain = [], [], ehd.FiniteLength(n_theta=SMALL.n_theta, n_z=SMALL.n_z)
    for line in (False, True):
        closure = ehd.SwiftStieber(line_in_cells=line)
        mapped, film = (build_model(make_bearing(1.0, film=f, cavitation=closure)) for f in (SMALL, plain))
        rng, errors = np.random.default_rng(1), []
        for _ in range(300):
            motion, eps, alpha, turn = (
                np.zeros(10),
                1.0 - 0.1 ** rng.random(),
                math.pi * rng.random(),
                7.0 * rng.random(),
            )
            motion[:2] = eps * C * math.cos(turn), eps * C * math.sin(turn)
            motion[4:6] = 1e-3 * math.cos(turn + alpha), 1e-3 * math.sin(turn + alpha)
            exact, guess = film.evaluate(motion).wrench[:2], mapped.evaluate(motion).wrench[:2]
            errors.append(np.linalg.norm(guess - exact) / np.linalg.norm(exact))
        nodes.append(mapped.nodes)
        medians.append(np.median(errors))
    assert not np.array_equal(*nodes)
    # what the line's place on the grid leaves of error is less
    assert medians[1] < 0.5 * medians[0]


@pytest.mark.parametrize("largest", [0.01, 0.5, 0.9])
def test_tangent_against_differences(make_bearing, largest):
    model = build_model(make_bearing(film=SMALL))
    rng = np.random.default_rng(4)
    scale = np.array([1e-6, 1e-6, 1.0, 1.0, 1e-3, 1e-3, 1.0, 1.0, 10.0, 0.1])
    for _ in range(20):
        motion = _motion(rng, 0.999 * largest)
        evaluation = model.evaluate(motion)
        tangent = evaluation.tangent()
        for k in (0, 1, 4, 5, 8, 9):
            step = np.zeros(10)
            step[k] = 1e-6 * min(scale[k], abs(motion[k]) + 1e-3 * scale[k])
            numeric = (model.evaluate(motion + step).wrench - model.evaluate(motion - step).wrench) / (2.0 * step[k])
            size = np.abs(tangent[:, k]) + np.linalg.norm(evaluation.wrench[:3]) / scale[k]
            # Rounding 1e-15 / 1e-9 in the smallest steps; across a node line 1e-6 of the jump of the second derivative.
            assert np.all(np.abs(numeric - tangent[:, k]) < 1e-6 * size), k


def test_interpolation_twin_and_continuity(make_bearing):
    """A bicubic polynomial is reproduced with its derivatives; value and slopes are continuous across nodes."""
    ns, na, ds, da = 5, 6, 0.3, 0.2
    s, a = ds * np.arange(ns)[:, None], da * np.arange(na)

    def poly(s, a):
        return 1.0 + s - 2.0 * a + s**3 * a**3 - s**2 * a + 0.5 * s * a**3

    def poly_s(s, a):
        return 1.0 + 3.0 * s**2 * a**3 - 2.0 * s * a + 0.5 * a**3

    def poly_a(s, a):
        return -2.0 + 3.0 * s**3 * a**2 - s**2 + 1.5 * s * a**2

    nodes = np.zeros((ns, na, 8))
    nodes[..., 0], nodes[..., 1], nodes[..., 2] = poly(s, a), poly_s(s, a), poly_a(s, a)
    nodes[..., 3] = 9.0 * s**2 * a**2 - 2.0 * s + 1.5 * a**2
    nodes[..., 4:] = 2.0 * nodes[..., :4]
    out = np.empty(6)
    for si, ai in np.random.default_rng(0).uniform(0.0, [1.2, 1.0], (50, 2)):
        interpolate(nodes, ds, da, si, ai, out)
        exact = np.array([poly(si, ai), poly_s(si, ai), poly_a(si, ai)])
        np.testing.assert_allclose(out, [*exact, *(2.0 * exact)], atol=1e-13)
    nodes = build_model(make_bearing(film=SMALL)).nodes
    before, after = np.empty(6), np.empty(6)
    for i, j in ((3, 4), (7, 11), (1, 1)):
        for shift in ((1e-9, 0.0), (0.0, 1e-9)):
            interpolate(nodes, 0.2, 0.2, 0.2 * i - shift[0], 0.2 * j - shift[1], before)
            interpolate(nodes, 0.2, 0.2, 0.2 * i + shift[0], 0.2 * j + shift[1], after)
            np.testing.assert_allclose(before, after, atol=1e-6)


def test_smooth_through_the_centre(make_bearing):
    """Force and tangent have one limit at the centre, whichever way it is approached."""
    model = build_model(make_bearing(film=SMALL))
    motion = np.zeros(10)
    motion[4:6], motion[8] = (1e-3, 2e-3), 150.0
    centre = model.evaluate(motion)
    force, tangent = centre.wrench[:2], centre.tangent()[:2]
    for a in np.linspace(0.0, 2.0 * np.pi, 9):
        motion[:2] = 1e-6 * C * np.cos(a), 1e-6 * C * np.sin(a)
        near = model.evaluate(motion)
        np.testing.assert_allclose(near.wrench[:2], force, atol=1e-4 * np.abs(force).max())
        np.testing.assert_allclose(near.tangent()[:2], tangent, atol=1e-4 * np.abs(tangent).max(axis=0).max())


def test_turning_the_model_turns_the_force(make_bearing):
    model = build_model(make_bearing(film=SMALL))
    rng = np.random.default_rng(3)
    for _ in range(20):
        motion, a = _motion(rng, 0.89), rng.uniform(0.0, 2.0 * np.pi)
        turn = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
        turned = motion.copy()
        turned[:2], turned[4:6] = turn @ motion[:2], turn @ motion[4:6]
        force = model.evaluate(motion).wrench[:2]
        np.testing.assert_allclose(model.evaluate(turned).wrench[:2], turn @ force, atol=1e-10 * np.linalg.norm(force))


def test_half_spin_frame(make_bearing):
    """A journal whirling with half the spin on a circle has no force; a spin is a squeeze of -omega/2 x e."""
    model = build_model(make_bearing(film=SMALL))
    motion = np.zeros(10)
    motion[0], motion[5], motion[8] = 0.5 * C, 0.5 * 150.0 * 0.5 * C, 150.0
    assert np.abs(model.evaluate(motion).wrench[:2]).max() < 1e-9
    spin, squeeze = np.zeros(10), np.zeros(10)
    spin[0] = squeeze[0] = 0.5 * C
    spin[8], squeeze[5] = 150.0, -0.5 * 150.0 * 0.5 * C
    np.testing.assert_allclose(
        model.evaluate(spin).wrench[:2], model.evaluate(squeeze).wrench[:2], rtol=1e-12, atol=1e-9
    )


def test_at_rest_force_vanishes_and_damping_is_that_of_closing():
    table_force, tangent = np.empty(2), np.empty((2, 5))
    nodes = np.zeros((3, 3, 8))
    impedance_force(nodes, 0.5, math.pi / 2, 0.3, 0.0, 0.0, 0.0, 0.0, table_force, tangent)
    np.testing.assert_array_equal(table_force, 0.0)
    # m = g = 0: f = -V.
    np.testing.assert_allclose(tangent[:, 2:4], -np.eye(2), atol=1e-15)
    np.testing.assert_array_equal(tangent[:, :2], 0.0)


def test_stiffness_of_a_concentric_spinning_journal(make_bearing):
    """Cross-coupled, half the spin times the damping, in the centre as next to it; eccentric at half speed likewise."""
    model = build_model(make_bearing(film=SMALL))
    tangents = []
    for shift in (0.0, 1e-9 * C):
        motion = np.zeros(10)
        motion[0], motion[8] = shift, 300.0
        tangents.append(model.evaluate(motion).tangent())
    K, near, damping = -tangents[0][:2, :2], -tangents[1][:2, :2], -tangents[0][:2, 4:6]
    np.testing.assert_allclose(K, near, atol=1e-6 * abs(near).max())
    np.testing.assert_allclose(K, 150.0 * damping @ [[0.0, 1.0], [-1.0, 0.0]], atol=1e-9 * abs(near).max())
    # whirl at half speed makes no pressure at any eccentricity: a shift across the velocity's direction
    motion = np.zeros(10)
    motion[0], motion[5], motion[8] = 0.4 * C, 0.4 * C * 150.0, 300.0
    tangent = model.evaluate(motion).tangent()[:2]
    np.testing.assert_allclose(tangent[:, 1], 150.0 * tangent[:, 4], atol=1e-9 * abs(tangent).max())


def test_outside_the_map_and_tilted(make_bearing):
    model = build_model(make_bearing(film=SMALL))
    motion = np.zeros(10)
    motion[8] = 100.0
    for eps, status in ((0.95, ehd.Status.OUTSIDE_MAP), (1.01, ehd.Status.NO_FILM), (math.nan, ehd.Status.NOT_FINITE)):
        motion[0] = eps * C
        evaluation = model.evaluate(motion)
        assert evaluation.status is status
        assert np.all(np.isnan(evaluation.wrench)) and np.all(np.isnan(evaluation.tangent()))
    assert "largest_eccentricity_ratio" in ehd.Status.OUTSIDE_MAP.advice
    motion[0] = 0.5 * C
    motion[2] = 1e-9
    assert model.evaluate(motion).status is ehd.Status.CONVERGED
    motion[2] = 1e-4
    with pytest.raises(ehd.FilmError, match=r"tilted by 0\.0001 rad.*FiniteLength"):
        model.evaluate(motion)


def test_studies_solve_the_film_behind_the_map(make_bearing):
    """`steady` and `equilibrium` give the map's film, with its pressure."""
    plain = ehd.FiniteLength(n_theta=SMALL.n_theta, n_z=SMALL.n_z)
    mapped, film = make_bearing(film=SMALL), make_bearing(film=plain)
    a = ehd.steady(mapped, speed=100.0, eccentricity_ratio=0.6, tilt=(1e-5, 0.0))
    b = ehd.steady(film, speed=100.0, eccentricity_ratio=0.6, tilt=(1e-5, 0.0))
    np.testing.assert_array_equal(a.pressure, b.pressure)
    assert (
        ehd.equilibrium(mapped, speed=100.0, load=(0.0, -1000.0)).eccentricity_ratio
        == ehd.equilibrium(film, speed=100.0, load=(0.0, -1000.0)).eccentricity_ratio
    )


@pytest.mark.slow
def test_cache_is_used_detects_damage_and_is_optional(cache, monkeypatch, tmp_path):
    film, closure = dataclasses.replace(SMALL, n_direction=18), ehd.SwiftStieber()
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path / "new"))
    first = impedance_nodes(film, closure, 2.0)
    (path,) = (tmp_path / "new").iterdir()
    assert path.name.startswith("impedance_") and path.suffix == ".bin"

    def forbidden(*args):
        raise AssertionError("built although cached")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("exudyn_ehd.film.solvers.impedance_map.build_nodes", forbidden)
        again = impedance_nodes(film, closure, 2.0)
        np.testing.assert_array_equal(again, first)
        for other in ((film, closure, 1.0), (film, ehd.Gumbel(), 2.0), (SMALL, closure, 2.5)):
            with pytest.raises(AssertionError, match="built although cached"):
                impedance_nodes(*other)
    raw = bytearray(path.read_bytes())
    for damaged in (raw[:100], raw[:5000] + bytes([raw[5000] ^ 1]) + raw[5001:], b""):
        path.write_bytes(damaged)
        with pytest.warns(UserWarning, match="damaged"):
            np.testing.assert_array_equal(impedance_nodes(film, closure, 2.0), first)
        assert path.read_bytes() == raw
    other = impedance_nodes(film, ehd.Gumbel(), 2.0)
    (foreign,) = set((tmp_path / "new").iterdir()) - {path}
    foreign.write_bytes(raw)
    with pytest.warns(UserWarning, match="damaged"):
        np.testing.assert_array_equal(impedance_nodes(film, ehd.Gumbel(), 2.0), other)
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(blocked))
    np.testing.assert_array_equal(impedance_nodes(film, closure, 2.0), first)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"cavitation": ehd.ElrodAdams()}, "must be Gumbel"),
        ({"cavitation": ehd.FullSommerfeld()}, "must be Gumbel"),
        ({"cavitation": ehd.SwiftStieber(cavity_pressure=-1e5)}, "cavity_pressure=0"),
        ({"end_pressures": (1e5, 0.0)}, "end_pressures must be"),
        ({"squeeze": False}, "squeeze must be True"),
        ({"contact": ehd.RegularisedWall(onset=1e-6)}, "contact must be None"),
        ({"supply": (ehd.AxialGroove(angle=0.0, width_angle=0.3),)}, r"supply must be \(\)"),
        ({"inlet": ehd.MaximumGap()}, "inlet must be"),
    ],
)
def test_refused_bearings(make_bearing, options, message):
    with pytest.raises(ehd.InputError, match=message):
        make_bearing(film=SMALL, **options)


@pytest.mark.parametrize(
    "values, message",
    [
        ({"n_theta": 16}, "n_theta must be an integer >= 64"),
        ({"n_z": 1}, "n_z must be"),
        ({"n_eccentricity": 2}, "n_eccentricity"),
        ({"n_direction": 2}, "n_direction"),
        ({"largest_eccentricity_ratio": 0.999}, "between 0.5 and 0.995"),
        ({"stretch": 0.99}, "between 0 and 0.95"),
    ],
)
def test_refused_values(values, message):
    with pytest.raises(ehd.InputError, match=message):
        ehd.ImpedanceMap(**values)


def test_oil_taken_at_another_temperature(make_bearing):
    """Without a thermal effect an oil is its viscosity."""
    hot = ehd.oil("SAE 5W-30", temperature=373.15)
    by_name, by_number = (
        ehd.steady(make_bearing(film=SMALL, lubricant=lubricant), speed=300.0, eccentricity_ratio=0.6).force
        for lubricant in (hot, ehd.Lubricant(viscosity=hot.viscosity, density=hot.density))
    )
    np.testing.assert_array_equal(by_name, by_number)
