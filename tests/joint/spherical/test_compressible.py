"""A ball in compressible oil: a reference of its own, the limit of stiff oil, tangent and mass balance."""

import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.joint.spherical.model import PLACE, SPIN, VELOCITY, SphericalModel
from tests.joint.spherical.test_model import BARUS, CUP, MU, RING, WALL, C, R, motion, numerical, states
from tests.joint.spherical.test_oil_content import VAPOUR, path

SOFT = ehd.DowsonHigginson()
CLOSURES = (ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(cavity_pressure=-1e5), VAPOUR)


def model(law=SOFT, pressure_law=None, **options):
    oil = ehd.Lubricant(viscosity=MU, density_law=law, pressure_law=pressure_law)
    return SphericalModel(ehd.SphericalBearing(ball_radius=R, radial_clearance=C, lubricant=oil, **options))


def test_squeeze_is_that_of_the_axisymmetric_equation():
    """rho h^3 / (12 mu) dp/dchi sin = -R^2 V int rho cos sin, from the pole to the edge, whose pressure is 0."""
    e, V = 0.9, 2e-3

    def shot(pole):
        def rates(x, y):
            rho, h = SOFT.ratio(max(y[0], 0.0)), C * (1 - e * math.cos(x))
            turn = math.cos(x) * math.sin(x)
            return [-12 * MU * R**2 * V * y[1] / (rho * h**3 * math.sin(x)), rho * turn, y[0] * turn]

        small = 1e-6
        start = [pole, 0.5 * small**2 * SOFT.ratio(pole), 0.5 * small**2 * pole]
        return solve_ivp(rates, (small, 0.5 * math.pi), start, rtol=1e-9, atol=1e-6, method="LSODA").y[:, -1]

    stiff = 3 * MU * R**2 * V / (C**3 * e) * (1 / (1 - e) ** 2 - 1)
    pole = brentq(lambda p: shot(p)[0], 0.3 * stiff, 1.5 * stiff, rtol=1e-9)
    force = 2 * math.pi * R**2 * shot(pole)[2]
    assert abs(pole / stiff - 1) > 0.005
    errors = []
    for n in (24, 48):
        wrench = model(n_chi=n, n_phi=16).evaluate(motion((0, 0, e * C), (0, 0, V))).wrench
        errors.append(abs(wrench[2] / -force - 1))
    assert errors[1] < 0.4 * errors[0] < 0.004


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("angles", [CUP, RING])
def test_stiff_oil_has_the_film_of_incompressible_oil(closure, angles):
    rng = np.random.default_rng(3)
    stiff = model(ehd.DowsonHigginson(coefficient=1e-13, saturation=1e-9), cavitation=closure, socket_angles=angles)
    plain = model(None, cavitation=closure, socket_angles=angles)
    for state in states(rng, 3, 0.8):
        one, other = stiff.evaluate(state), plain.evaluate(state)
        assert np.abs(one.wrench - other.wrench)[:3].max() < 3e-6 * np.abs(other.wrench[:3]).max()


@pytest.mark.parametrize("wall", [None, WALL])
@pytest.mark.parametrize("law", [None, BARUS])
@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("angles", [CUP, RING])
def test_tangent_is_exact(closure, angles, law, wall):
    """Derivatives of steady films, and over steps where the film has a memory."""
    rng = np.random.default_rng(4)
    film = model(pressure_law=law, n_phi=24, n_chi=8, cavitation=closure, socket_angles=angles, contact=wall)
    history, densest = None, 1.0
    for k, state in enumerate(states(rng, 4, 0.8 if wall is None else 1.02)):
        state[VELOCITY] *= 10.0 if law is None else 0.1
        step = 1e-3 if history is not None else 0.0
        found = film.evaluate(state, history, step)
        tangent = found.tangent()
        densest = max(densest, film.solver.rho.max())
        other = numerical(SimpleNamespace(evaluate=partial(film.evaluate, history=history, step=step)), state)
        for rows in (slice(0, 3), slice(3, 6)):
            for columns in (PLACE, VELOCITY, SPIN):
                assert np.abs(tangent - other)[rows, columns].max() < 1e-4 * np.abs(other[rows, columns]).max(), k
        history = film.evaluate(state, history, step).history()
    assert densest > (1.001 if law is None else 1.0003)


@pytest.mark.parametrize("angles", [CUP, RING])
def test_mass_balances_to_round_off_in_a_motion(angles):
    film, step, least = model(n_phi=32, n_chi=12, cavitation=VAPOUR, socket_angles=angles), 5e-4, 1.0
    history = film.initial_history(path(0.0))
    brought, first, area = 0.0, history.mass, film.grid.area
    for k in range(1, 60):
        found = film.evaluate(path(k * step), history, step)
        brought += step * film.solver.inflow().sum()
        history, least = found.history(), min(least, film.solver.fill.min())
        held, whole = (area * (history.mass - first)).sum(), (area * history.mass).sum()
        assert abs(held - brought) < 1e-9 * whole
    assert least < 0.95


def test_heat_is_the_work_on_compressible_oil():
    """A cup in a steady spin across its axis, in which nothing stores: to the grid's error."""
    rng, thermal = np.random.default_rng(5), ehd.LumpedThermal(supply_temperature=313.0, housing_conductance=1.0)
    oil = ehd.Lubricant(viscosity=MU, density_law=SOFT)
    for closure in CLOSURES:
        film = SphericalModel(
            ehd.SphericalBearing(
                ball_radius=R,
                radial_clearance=C,
                lubricant=oil,
                thermal=thermal,
                socket_angles=RING,
                cavitation=closure,
            )
        )
        for state in states(rng, 2, 0.7):
            state[VELOCITY] = 0.0
            found = film.evaluate(state)
            heat, exchanged = film.heat_and_exchange(found.film, 1.0)
            assert heat == pytest.approx(found.quantities()["power_loss"], rel=0.02)
            assert exchanged > 0.0
