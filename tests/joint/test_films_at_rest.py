"""Plane thrust faces and balls at rest: tangents against one-sided quotients of the wrench and closed forms."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.spherical.model import PLACE, SIZE, SPIN, VELOCITY, SphericalModel
from exudyn_ehd.joint.thrust import ThrustModel

CLOSURES = (ehd.SwiftStieber(), ehd.SwiftStieber(line_in_cells=False), ehd.Gumbel(), ehd.FullSommerfeld())
OIL = ehd.Lubricant(viscosity=0.03)


def faces_of(rng, cavitation, **options):
    """A bearing with random thrust faces, and its spin, rad/s, one of three at a stop."""
    R, spin = rng.uniform(0.01, 0.05), rng.choice([0.0, -1.0, 1.0]) * rng.uniform(20.0, 500.0)
    inner = R * rng.uniform(1.05, 1.5)
    size = {
        "inner_radius": inner,
        "outer_radius": inner / rng.uniform(0.35, 0.85),
        "clearance": R * rng.uniform(5e-4, 2e-3),
    }
    b = {"journal_radius": R, "length": R, "radial_clearance": 1e-3 * R, "squeeze": rng.uniform() < 0.8}
    return ehd.JournalBearing(
        **b, lubricant=OIL, cavitation=cavitation, thrust=ehd.ThrustFaces(**size | {"n_r": 8} | options)
    ), spin


def one_sided(model, motion, place, entry, direction, size):
    """Wrench (6,) per ``size`` of a step from the motion in two entries."""
    moved = motion.copy()
    moved[entry : entry + 2] = size * direction
    return (model.evaluate(np.append(moved, place)).wrench - model.evaluate(np.append(motion, place)).wrench) / size


def check_faces(seed, draws):
    rng = np.random.default_rng(seed)
    for _ in range(draws):
        cavitation = CLOSURES[rng.integers(len(CLOSURES))]
        bearing, spin = faces_of(rng, cavitation, lower=rng.uniform() < 0.8, n_theta=int(rng.integers(32, 100)))
        c, motion, angle = bearing.thrust.clearance, np.zeros(10), rng.uniform(0.0, 2.0 * math.pi)
        place, motion[8] = rng.choice([0.0, 1.0]) * rng.uniform(-0.6, 0.6) * c, spin
        model, direction = ThrustModel(bearing), np.array([math.cos(angle), math.sin(angle)])
        found = model.evaluate(np.append(motion, place))
        tangent, rate, tilt = found.tangent(), abs(spin) or 1.0, 1e-6 * c / bearing.thrust.outer_radius
        for entry, size in ((2, tilt), (6, rate * tilt)):
            moment = one_sided(model, motion, place, entry, direction, size)[3:5]
            along = tangent[3:5, entry : entry + 2] @ direction
            # rupture lines move by whole columns or with the direction, measured at most 1e-3 from 32 columns on
            assert np.allclose(
                along, moment, rtol=0.0, atol=3e-3 * np.abs(tangent[3:5, entry : entry + 2]).max() + 1e-12
            )
        sides = []
        for way in (1.0, -1.0):
            motion[9] = way * rate * 1e-6 * c
            sides.append(-model.evaluate(np.append(motion, place)).wrench[2] / motion[9])
        motion[9] = 0.0
        found = model.evaluate(np.append(motion, place))
        damping, mean = found.axial_damping(), 0.5 * sum(sides)
        assert -found.tangent()[2, 9] == pytest.approx(mean, rel=1e-5, abs=1e-12)
        if abs(sides[0] - sides[1]) < 0.1 * mean or mean == 0.0:
            assert damping == pytest.approx(mean, rel=1e-5)
        else:
            assert math.isnan(damping)


def test_plane_faces_at_rest_have_the_mean_of_both_sides():
    check_faces(1, 12)


@pytest.mark.slow
def test_plane_faces_at_rest_over_a_wide_draw():
    check_faces(2, 300)


@pytest.mark.parametrize("cavitation", CLOSURES, ids=repr)
def test_the_axial_damping_of_two_plane_faces_at_rest_is_that_of_the_face_that_closes(cavitation):
    """3 pi mu / (2 c^3) (r_o^4 - r_i^4 - (r_o^2 - r_i^2)^2 / ln(r_o / r_i)), twice for films that carry tension."""
    r, R, c = 0.02, 0.04, 30e-6
    bearing = faces_of(np.random.default_rng(0), cavitation)[0]
    faces = ehd.ThrustFaces(inner_radius=r, outer_radius=R, clearance=c)
    bearing = dataclasses.replace(bearing, journal_radius=0.02, radial_clearance=2e-5, thrust=faces, squeeze=True)
    closed = 1.5 * math.pi * OIL.viscosity / c**3 * (R**4 - r**4 - (R**2 - r**2) ** 2 / math.log(R / r))
    films = 2 if isinstance(cavitation, ehd.FullSommerfeld) else 1
    damping = ehd.steady(bearing, speed=100.0, eccentricity_ratio=0.5).faces.axial_damping
    assert damping == pytest.approx(films * closed, rel=0.01)
    one = dataclasses.replace(bearing, thrust=dataclasses.replace(faces, lower=False))
    assert math.isnan(ehd.steady(one, speed=100.0, eccentricity_ratio=0.5).faces.axial_damping) == (films == 1)


def test_faces_with_pressure_or_motion_keep_the_exact_tangent():
    bearing, _ = faces_of(np.random.default_rng(4), ehd.SwiftStieber(), inner_pressures=(1e5, 1e5))
    for motion in (np.zeros(10), np.eye(10)[9] * 1e-4):
        found = ThrustModel(bearing).evaluate(np.append(motion, 0.0))
        own = sum(face.tangent()[2, 3] for face in found.model.faces)
        assert found.tangent()[2, 9] == pytest.approx(own, rel=1e-12)


def ball_of(rng, cavitation):
    last = rng.uniform(0.6, 2.6)
    first = rng.choice([0.0, 1.0]) * rng.uniform(0.1, min(1.2, last - 0.3))
    R = rng.uniform(0.005, 0.05)
    angles = (first, math.pi - first) if rng.uniform() < 0.3 and first > 0.0 else (first, last)
    return ehd.SphericalBearing(
        ball_radius=R, radial_clearance=1e-3 * R, lubricant=OIL, socket_angles=angles, cavitation=cavitation
    )


def check_balls(seed, draws):
    rng = np.random.default_rng(seed)
    closures = (ehd.SwiftStieber(), ehd.Gumbel(), ehd.FullSommerfeld(), ehd.SwiftStieber(cavity_pressure=-1e5))
    for _ in range(draws):
        cavitation = closures[rng.integers(len(closures))]
        bearing, motion = ball_of(rng, cavitation), np.zeros(SIZE)
        c, axial, spin = (
            bearing.radial_clearance,
            rng.uniform(-0.6, 0.6) * rng.integers(2),
            rng.choice([-1, 0, 1]) * 80.0,
        )
        motion[PLACE][2], motion[SPIN][2] = axial * c, spin
        model, angle = SphericalModel(bearing), rng.uniform(0.0, 2.0 * math.pi)
        middle, along = model.evaluate(motion).wrench[:3], np.array([math.cos(angle), math.sin(angle), 0.0])
        result = ehd.steady_spherical(
            bearing, place=motion[PLACE], velocity=motion[VELOCITY], angular_velocity=motion[SPIN]
        )
        rate = abs(spin) or 1.0
        for part, columns, size in ((PLACE, slice(0, 2), 1e-6 * c), (VELOCITY, slice(3, 5), 1e-6 * c * rate)):
            moved = motion.copy()
            moved[part] += size * along
            quotient = (model.evaluate(moved).wrench[:3] - middle) / size
            given = result.tangent[:2, columns]
            # a film is solved to some hundred roundings of its pressures above the cavity's
            cavity = -1e5 if cavitation.cavity_pressure == -1e5 else 0.0
            rounding = -1e-13 * cavity * bearing.ball_radius**2 / size
            # lines lie on vertices; 48 columns: measured at most 1e-3
            most = 3e-3 * np.abs(given).max() + 1e-9 + rounding
            assert np.allclose(given @ along[:2], quotient[:2], rtol=0.0, atol=most)
        sides = []
        for way in (1.0, -1.0):
            moved = motion.copy()
            moved[VELOCITY][2] = way * 1e-6 * c * rate
            sides.append((model.evaluate(moved).wrench[2] - middle[2]) / moved[VELOCITY][2])
        largest = np.nanmax(np.abs(result.tangent[:3, 3:6]))
        if abs(sides[0] - sides[1]) > 0.2 * max(largest, *np.abs(sides)):
            assert math.isnan(result.tangent[2, 5])
        elif not math.isnan(result.tangent[2, 5]):
            assert result.tangent[2, 5] == pytest.approx(np.mean(sides), abs=1e-4 * largest)
        unbroken = isinstance(cavitation, ehd.FullSommerfeld) or cavitation.cavity_pressure < 0.0
        assert not unbroken or np.all(np.isfinite(result.tangent))
        assert model.evaluate(motion).tangent().shape == (6, SIZE)


def test_balls_at_rest_have_the_derivatives_of_films_beside_it_across_their_axis():
    check_balls(1, 8)


@pytest.mark.slow
def test_balls_at_rest_over_a_wide_draw():
    check_balls(2, 200)


def test_a_cup_at_rest_has_no_damping_along_its_axis():
    """4 pi mu R^4 / c^3 where it closes, nothing where it opens; across, half of the film with tension."""
    R, c = 0.015, 30e-6
    cup = ehd.SphericalBearing(ball_radius=R, radial_clearance=c, lubricant=OIL, cavitation=ehd.Gumbel())
    rest, full = (
        ehd.steady_spherical(b, place=(0, 0, 0)).tangent
        for b in (cup, dataclasses.replace(cup, cavitation=ehd.FullSommerfeld()))
    )
    assert full[2, 5] == pytest.approx(-4.0 * math.pi * OIL.viscosity * R**4 / c**3, rel=1e-3)
    assert math.isnan(rest[2, 5])
    # but for the shear, which does not halve
    assert rest[:2, 3:5] == pytest.approx(0.5 * full[:2, 3:5], rel=1e-3, abs=1e-6 * abs(full[0, 3]))
    spinning = ehd.steady_spherical(cup, place=(0, 0, 0), angular_velocity=(0, 0, 50.0)).tangent
    # without the shear, 0.5 % of the damping here
    assert spinning[0, 1] == pytest.approx(25.0 * rest[0, 3], rel=0.01)
