"""The exact centre: tangents against one-sided quotients of the force, and against Ocvirk's half film."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

RADIUS, CLEARANCE, VISCOSITY = 0.02, 40e-6, 0.03


def bearing(ratio=0.6, **options):
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=2.0 * RADIUS * ratio,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=VISCOSITY),
        **options,
    )


def quotients(model, spin, angle, history=None, step=0.0):
    """Force (2,) per displacement and per velocity in one direction, from one side."""
    out = []
    for first, size in ((0, 1e-5 * CLEARANCE), (4, 1e-5 * CLEARANCE * max(abs(spin), 1.0))):
        motion = np.zeros(10)
        motion[8] = spin
        motion[first : first + 2] = size * np.array([np.cos(angle), np.sin(angle)])
        out.append(model.evaluate(motion, history, step).wrench[:2] / size)
    return out


@pytest.mark.parametrize(
    ("cavitation", "film"),
    [
        (ehd.SwiftStieber(), ehd.FiniteLength()),
        (ehd.SwiftStieber(cavity_pressure=1e5), ehd.FiniteLength(n_theta=64, n_z=6)),
        (ehd.SwiftStieber(line_in_cells=False), ehd.FiniteLength(n_theta=128)),
        (ehd.Gumbel(), ehd.FiniteLength(n_theta=96)),
        (ehd.FullSommerfeld(), ehd.FiniteLength(n_theta=64)),
        (ehd.SwiftStieber(), ehd.ShortBearing()),
    ],
    ids=lambda option: repr(option),
)
def test_the_tangent_at_the_centre_is_the_force_per_displacement_in_every_direction(cavitation, film):
    rng = np.random.default_rng(3)
    # lines on vertices move by whole columns, 1 % on 128 columns; in cells the tangent of one direction differs from
    # the mean by some 3e-4 on the default grid, 5e-3 on 64 columns
    on_vertices = repr(cavitation).endswith("line_in_cells=False)")
    tolerance = 1e-2 if on_vertices or film.n_theta == 64 else 1e-3
    ends = (max(cavitation.cavity_pressure, 0.0),) * 2
    for spin in (0.0, -80.0, 400.0):
        made = bearing(rng.uniform(0.25, 2.0), cavitation=cavitation, film=film, end_pressures=ends)
        model = build_model(made)
        motion = np.zeros(10)
        motion[8] = spin
        evaluation = model.evaluate(motion)
        tangent, angle = evaluation.tangent(), rng.uniform(0.0, 2.0 * np.pi)
        assert evaluation.quantities()["peak_pressure"] == pytest.approx(ends[0], abs=1e-3)
        along = np.array([np.cos(angle), np.sin(angle)])
        by_place, by_rate = quotients(model, spin, angle)
        size = np.abs(tangent[:2, 4:6]).max()
        assert np.allclose(tangent[:2, :2] @ along, by_place, rtol=0.0, atol=tolerance * size * max(abs(spin), 1.0))
        assert np.allclose(tangent[:2, 4:6] @ along, by_rate, rtol=0.0, atol=tolerance * size)


def test_a_short_bearing_at_the_centre_has_half_of_an_unbroken_film():
    """Ocvirk: c = pi mu R L^3 / (2 c^3) of the film's half that closes, K = c omega / 2, C = c."""
    made, omega = bearing(0.2, film=ehd.ShortBearing()), 250.0
    rest = ehd.equilibrium(made, speed=omega, load=(0.0, 0.0))
    c = 0.5 * np.pi * VISCOSITY * RADIUS * made.length**3 / CLEARANCE**3
    # the parabola along z on 8 stretched intervals: 1e-4
    assert np.allclose(rest.damping, c * np.eye(2), rtol=0.0, atol=1e-3 * c)
    assert np.allclose(rest.stiffness, 0.5 * omega * c * np.array([[0, 1], [-1, 0]]), rtol=0.0, atol=5e-4 * omega * c)
    assert np.array_equal(rest.position, np.zeros(2))


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"cavitation": ehd.Gumbel()},
        {"supply": (ehd.CircumferentialGroove(width=2e-3),)},
        {"end_pressures": (2e5, 2e5)},
    ],
    ids=str,
)
def test_no_load_and_a_tiny_load_have_the_same_stiffness_and_damping(options):
    made = bearing(0.4, **options)
    none, tiny = (ehd.equilibrium(made, speed=250.0, load=(0.0, -load)) for load in (0.0, 1e-3))
    # the one direction of the tiny load has the grid's error, below 2e-3
    for name in ("stiffness", "damping"):
        there = getattr(tiny, name)
        assert np.allclose(getattr(none, name), there, rtol=0.0, atol=2e-3 * np.abs(there).max())
    assert none.whirl_ratio == pytest.approx(0.5, abs=1e-3)


def test_a_groove_at_the_cavity_pressure_leaves_no_derivatives_at_the_centre():
    groove = ehd.AxialGroove(angle=1.0, width_angle=0.3)
    with pytest.raises(ehd.FilmError, match="exact centre this film has no stiffness"):
        ehd.equilibrium(bearing(supply=(groove,)), speed=250.0, load=(0.0, 0.0))


def test_a_fed_groove_moves_the_unloaded_journal_off_the_centre():
    groove = ehd.AxialGroove(angle=1.0, width_angle=0.3, length=0.01, pressure=2e5)
    rest = ehd.equilibrium(bearing(supply=(groove,)), speed=250.0, load=(0.0, 0.0))
    force = rest.film.force[:2]
    assert rest.eccentricity_ratio > 0.01
    assert np.abs(force).max() < 1e-9 * rest.film.peak_pressure * RADIUS**2


def test_a_full_film_that_keeps_its_oil_has_the_derivatives_of_a_step_at_the_centre():
    model = build_model(bearing(0.5, cavitation=ehd.ElrodAdams(), film=ehd.FiniteLength(n_theta=64, n_z=6)))
    motion, step, angle = np.zeros(10), 1e-3, 0.7
    motion[8] = 250.0
    history = model.initial_history(motion)
    tangent = model.evaluate(motion, history, step).tangent()
    by_place, _ = quotients(model, 250.0, angle, history, step)
    along = np.array([np.cos(angle), np.sin(angle)])
    # on 64 columns the lines of one direction differ from their mean by up to 1 %
    assert np.allclose(tangent[:2, :2] @ along, by_place, rtol=0.0, atol=0.01 * np.abs(by_place).max())


def test_a_hard_liner_at_the_centre_keeps_the_half_film():
    hard = bearing(0.4, bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=3e9))
    rest, rigid = (ehd.equilibrium(b, speed=250.0, load=(0.0, 0.0)) for b in (hard, bearing(0.4)))
    # the liner yields by 1e-3 of the displacement
    assert np.allclose(rest.stiffness, rigid.stiffness, rtol=0.0, atol=5e-3 * np.abs(rigid.stiffness).max())
    assert np.allclose(rest.damping, rigid.damping, rtol=0.0, atol=1e-2 * np.abs(rigid.damping).max())


def test_a_soft_liner_at_the_centre_has_no_damping():
    soft = bearing(0.4, bush=ehd.ElasticLiner(thickness=2e-3, youngs_modulus=3e6, poisson_ratio=0.4))
    with pytest.raises(ehd.FilmError, match="soft surface"):
        ehd.equilibrium(soft, speed=250.0, load=(0.0, 0.0))
