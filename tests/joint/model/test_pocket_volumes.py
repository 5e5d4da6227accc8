"""Restrictors with a compressible volume: steps in time, tangents, and small motions about a steady film."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

RADIUS, LENGTH, CLEARANCE, SUPPLY = 0.03, 0.06, 30e-6, 4e6
SIZE = {
    "journal_radius": RADIUS,
    "length": LENGTH,
    "radial_clearance": CLEARANCE,
    "lubricant": ehd.Lubricant(viscosity=0.008, density=860.0),
}
FEEDS = [
    ehd.Orifice(diameter=3.96e-4, supply_pressure=SUPPLY),
    ehd.Capillary(diameter=5.05e-4, length=0.08, supply_pressure=SUPPLY),
    ehd.GivenFlow(flow=8e-6),
]
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams()]
# of x, y, tilts and their rates, spin and axial speed
SCALE = np.array([1.0, 1.0, 2.0 / LENGTH, 2.0 / LENGTH] * 2 + [0.0, 0.0]) * CLEARANCE
SCALE[4:8] *= 150.0
SCALE[8:] = 150.0, 1.0


def _name(value):
    return type(value).__name__


def _bearing(volumes, closure, feeds=(*FEEDS, FEEDS[0]), **options):
    """Four pockets with volumes of oil, m3, at 1e9 Pa."""
    supply = tuple(
        ehd.Pocket(
            angle=0.1 + 0.5 * math.pi * k,
            width_angle=1.1,
            length=0.04,
            supply=dataclasses.replace(feed, compressible_volume=volume, bulk_modulus=1e9),
        )
        for k, (feed, volume) in enumerate(zip(feeds, volumes, strict=True))
    )
    return ehd.JournalBearing(**SIZE | options, cavitation=closure, supply=supply)


def _given(pressures, closure):
    """Return the bearing with given pressures of its pockets, Pa."""
    bearing = _bearing(np.zeros(4), closure)
    supply = (dataclasses.replace(a, supply=None, pressure=p) for a, p in zip(bearing.supply, pressures, strict=True))
    return dataclasses.replace(bearing, supply=tuple(supply))


def _motion(rng, largest=0.5):
    e, angle = CLEARANCE * rng.uniform(0.1, largest), rng.uniform(0.0, 2.0 * math.pi)
    rates = SCALE[2:8] * rng.uniform(-0.3, 0.3, 6)
    return np.array([e * math.cos(angle), e * math.sin(angle), *rates, rng.choice([-1, 1]) * 150.0, 0.03])


@pytest.mark.parametrize("closure", CLOSURES, ids=_name)
def test_steps_and_tangents(closure):
    """Backward Euler, checked by the flows; exact tangents; after a long step the oil is as if incompressible."""
    rng = np.random.default_rng(11)
    for _ in range(2):
        volumes, motion, step = 10.0 ** rng.uniform(-6.0, -4.0, 4), _motion(rng), 10.0 ** rng.uniform(-4.0, -2.0)
        model = build_model(_bearing(volumes, closure))
        r, first = model.solver.reservoirs, model.initial_history(_motion(rng))
        evaluation = model.evaluate(motion, first, step)
        taken = model.parts.supply.flows(model.solver.inflow(linear=True)) * model.parts.flow_scale
        stored = 1e-9 * volumes * (r.pressures - first.pockets) / step
        np.testing.assert_allclose(r.flows(), taken + stored, rtol=0.0, atol=1e-8 * np.abs(stored).max())
        assert np.all(np.abs(stored) > 1e-4 * np.abs(taken).max())
        assert np.array_equal(evaluation.history().pockets, r.pressures)
        tangent, direction = evaluation.tangent(), rng.standard_normal(10) * SCALE
        sides = [model.evaluate(motion + sign * 1e-4 * direction, first, step).wrench for sign in (1.0, -1.0)]
        size = np.array([1.0] * 3 + [RADIUS] * 3) * np.linalg.norm(evaluation.wrench[:3])
        assert np.all(np.abs((sides[0] - sides[1]) / 2e-4 - tangent @ direction) < 3e-6 * size)
        # a step of no time keeps the pressures, one of all time is as if the oil were incompressible
        if closure.conserves_mass:
            continue
        plain = build_model(_bearing(np.zeros(4), closure))
        for time, other in ((0.0, build_model(_given(first.pockets, closure))), (1e9, plain)):
            expected = other.evaluate(motion)
            found = model.evaluate(motion, first, time)
            near = 2e-5 * np.abs(expected.wrench[:3]).max()
            np.testing.assert_allclose(found.wrench, expected.wrench, rtol=0.0, atol=near)


@pytest.mark.parametrize("closure", CLOSURES, ids=_name)
def test_steady_films_do_not_see_it(closure):
    rng = np.random.default_rng(4)
    state = {"speed": 150.0, "eccentricity_ratio": 0.4, "direction": 1.0, "velocity": (1e-3, -2e-3)}
    one, other = (ehd.steady(_bearing(v, closure), **state) for v in (np.zeros(4), 10.0 ** rng.uniform(-6.0, -3.0, 4)))
    np.testing.assert_allclose(other.pocket_pressures, one.pocket_pressures, rtol=1e-12)
    np.testing.assert_allclose(other.force, one.force, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("closure", CLOSURES[:3], ids=_name)
@pytest.mark.parametrize("film", [ehd.FiniteLength(), ehd.ShortBearing()], ids=_name)
def test_small_motions_by_films_of_given_pressures(closure, film):
    """V / K dp/dt = Q_r(p) - Q(p, x, dx/dt) with derivatives of flows and forces by differences."""
    rng = np.random.default_rng(6)
    volumes = 10.0 ** rng.uniform(-6.0, -4.0, 4)
    bearing = _bearing(volumes, closure, film=film)
    rest = ehd.equilibrium(bearing, speed=150.0, load=(300.0, -1500.0))
    p, r = rest.film.pocket_pressures, rest.film.restrictor_flows
    at = np.concatenate((p, np.zeros(10)))
    at[4:6], at[12] = rest.position, 150.0

    def film_of(state):
        model = build_model(dataclasses.replace(_given(state[:4], closure), film=film))
        wrench = model.evaluate(state[4:]).wrench
        inflow = model.solver.inflow(linear=True)
        return np.concatenate((model.parts.supply.flows(inflow) * model.parts.flow_scale, wrench[:2]))

    columns = []
    for k, size in ((0, 1e3), (1, 1e3), (2, 1e3), (3, 1e3), (4, 1e-9), (5, 1e-9), (8, 1e-6), (9, 1e-6)):
        step = size * np.eye(14)[k]
        columns.append((film_of(at + step) - film_of(at - step)) / (2.0 * size))
    J = np.array(columns).T
    restrict = np.array([0.5 * r[0] / (SUPPLY - p[0]), r[1] / (SUPPLY - p[1]), 0.0, 0.5 * r[3] / (SUPPLY - p[3])])
    nu = np.array([0.0, 30.0, 1e3, 3e4])
    for frequency, found in zip(nu, rest.dynamic_stiffness(nu), strict=True):
        moved = J[:, 4:6] + 1j * frequency * J[:, 6:8]
        settling = J[:4, :4] + np.diag(restrict + 1j * frequency * 1e-9 * volumes)
        expected = -moved[4:] + J[4:, :4] @ np.linalg.solve(settling, moved[:4])
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=2e-5 * np.abs(expected).max())
    slow = 1e-3
    np.testing.assert_allclose(rest.damping, rest.dynamic_stiffness([slow])[0].imag / slow, rtol=1e-6)
    np.testing.assert_allclose(rest.stiffness, rest.dynamic_stiffness([0.0])[0].real, rtol=1e-9)
