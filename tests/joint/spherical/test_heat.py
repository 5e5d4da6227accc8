"""Temperature of a ball's film: heat, exchange of oil and balance, against closed forms and isothermal films."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.spherical.model import SPIN, VELOCITY, SphericalModel
from tests.joint.spherical.test_model import BARUS, CUP, RING, WALL, C, R, motion, states

SUPPLY = 313.15
WARM = {"supply_temperature": SUPPLY, "housing_conductance": 0.5, "housing_temperature": 300.0}
VG = ehd.oil("ISO VG 100")
CONSTANT = ehd.Lubricant(viscosity=0.1)
CLOSURES = (ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5))


def ball(oil=CONSTANT, thermal=WARM, **options):
    given = {"thermal": ehd.LumpedThermal(**thermal)} if thermal else {}
    return ehd.SphericalBearing(ball_radius=R, radial_clearance=C, lubricant=oil, **given, **options)


def heat_and_flow(bearing, state):
    """Heat, W, and exchange of oil, m3/s, of a film."""
    model = SphericalModel(bearing)
    heat, exchanged = model.heat_and_exchange(model.evaluate(state).film, 1.0)
    return heat, exchanged * model.parts.flow_scale


@pytest.mark.parametrize("closure", [CLOSURES[0], CLOSURES[2]])
@pytest.mark.parametrize("wall", [None, WALL])
@pytest.mark.parametrize("law", [None, BARUS])
def test_heat_is_the_work_of_the_motion(closure, wall, law):
    """To round-off where edges and cavities have the same pressure; less what the wall stores."""
    oil, rng = ehd.Lubricant(viscosity=0.1, pressure_law=law), np.random.default_rng(5)
    bearing = ball(oil, cavitation=closure, contact=wall, socket_angles=RING)
    for state in states(rng, 5, 0.9 if wall is None else 1.0):
        state[VELOCITY] *= 0.1
        loss = SphericalModel(bearing).evaluate(state).quantities()["power_loss"]
        assert heat_and_flow(bearing, state)[0] == pytest.approx(loss, rel=1e-9)


@pytest.mark.parametrize("closure", CLOSURES)
def test_oil_that_leaves_is_what_the_ball_presses_out_and_drags_along(closure):
    """pi R^2 V of a cup; of a centred cup under a spin across its axis w R^2 c, and as much enters."""
    V, w = 1e-3, 7.0
    bearing = ball(cavitation=closure)
    _, pressed = heat_and_flow(bearing, motion((0, 0, 0.3 * C), (0, 0, V)))
    assert pressed == pytest.approx(math.pi * R**2 * V, rel=1e-9)
    heat, dragged = heat_and_flow(bearing, motion(spin=(w, 0, 0)))
    # columns in which it turns round count nothing
    assert dragged == pytest.approx(w * R**2 * C, rel=3e-3)
    # (8/3 pi - 2/3 pi 2) R^4 mu w^2 / c of the hemisphere: R^2 int (1 - n_x^2) dA
    assert heat == pytest.approx(0.1 * w**2 * R**4 / C * 4 / 3 * math.pi, rel=1e-9)


@pytest.mark.parametrize("angles", [CUP, RING])
def test_films_that_count_their_oil_and_others_exchange_the_same(angles):
    """To round-off, where nothing ruptures."""
    rng, kept = np.random.default_rng(3), ehd.ElrodAdams(cavity_pressure=-1e9)
    for state in states(rng, 4, 0.8):
        one = heat_and_flow(ball(cavitation=ehd.FullSommerfeld(), socket_angles=angles), state)
        other = heat_and_flow(ball(cavitation=kept, socket_angles=angles), state)
        assert one == pytest.approx(other, rel=1e-7)


@pytest.mark.parametrize("closure", CLOSURES)
def test_a_film_has_the_viscosity_of_its_temperature(closure):
    rng, T = np.random.default_rng(6), 341.0
    warm = SphericalModel(ball(VG, cavitation=closure, socket_angles=RING))
    plain = SphericalModel(ball(VG.at(T), thermal=None, cavitation=closure, socket_angles=RING))
    for state in states(rng, 3, 0.8):
        one, other = warm.evaluate(state, History(temperature=T)), plain.evaluate(state)
        assert one.wrench == pytest.approx(other.wrench, rel=1e-9, abs=1e-9 * np.abs(other.wrench).max())
        a, b = one.tangent(), other.tangent()
        assert np.abs(a - b).max() < 1e-7 * np.abs(b).max()
        assert one.quantities()["film_temperature"] == T


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("sump", [False, True])
def test_steady_temperatures_are_in_balance(closure, sump):
    """P = rho c Q (T - T_supply) + G (T - T_housing), with a sump that has H / conductance above its ambient."""
    rng, tank = np.random.default_rng(7), ehd.Sump(conductance=2.0, ambient=SUPPLY)
    bearing = ball(VG, WARM | ({"supply_temperature": tank} if sump else {}), cavitation=closure, socket_angles=RING)
    for state in states(rng, 3, 0.8):
        state[VELOCITY] *= 0.1
        given = {"velocity": state[VELOCITY], "angular_velocity": 3.0 * state[SPIN]}
        film = ehd.steady_spherical(bearing, place=state[:3], **given)
        model, T = SphericalModel(bearing), film.temperature
        still = film.motion.copy()
        still[VELOCITY] = 0.0
        content = model.evaluate(still, History(temperature=T)).history() if model.remembers_mass else History()
        found = model.evaluate(film.motion, History(T and content.void, content.mass, content.outflow, temperature=T))
        heat, exchanged = model.heat_and_exchange(found.film, 1.0)
        flow = VG.density * VG.specific_heat * exchanged * model.parts.flow_scale
        carried = heat - 0.5 * (T - 300.0)
        assert carried == pytest.approx(flow * (T - SUPPLY - (carried / 2.0 if sump else 0.0)), rel=1e-6)
        assert film.force == pytest.approx(found.wrench[:3], rel=1e-9) and T > 300.0


def test_a_film_warms_up_as_its_capacity_says():
    """C dT/dt = P - K (T - T_supply) of a centred ball with constant viscosity, backward Euler of first order."""
    capacity, w, end, errors = 2.0, 40.0, 3.0, []
    bearing = ball(thermal=WARM | {"capacity": capacity, "housing_temperature": None}, socket_angles=CUP)
    heat, flow = heat_and_flow(bearing, motion(spin=(0, w, 0)))
    film = CONSTANT.density * CONSTANT.specific_heat * 2 * math.pi * R**2 * C
    K = 0.5 + CONSTANT.density * CONSTANT.specific_heat * flow
    exact = SUPPLY + heat / K * (1 - math.exp(-K * end / (capacity + film)))
    for n in (20, 40):
        model = SphericalModel(bearing)
        history = model.initial_history(motion(spin=(0, w, 0)))
        assert history.temperature == SUPPLY
        for _ in range(n):
            history = model.evaluate(motion(spin=(0, w, 0)), history, end / n).history()
        errors.append(abs(history.temperature - exact) / (exact - SUPPLY))
    assert errors[1] < 0.55 * errors[0] < 0.02


def test_what_has_no_temperature_is_refused():
    with pytest.raises(ehd.InputError, match=r"hot and cold sides, which move with it"):
        ehd.SphericalBearing(
            ball_radius=R, radial_clearance=C, lubricant=VG, thermal=ehd.FilmEnergy(supply_temperature=SUPPLY)
        )
    with pytest.raises(ehd.InputError, match=r"SphericalBearing.thermal.housing_temperature = 25.0 K"):
        ball(VG, WARM | {"housing_temperature": 25.0})
    closed = ball(VG, {"supply_temperature": SUPPLY})
    with pytest.raises(ehd.FilmError, match="steady_spherical: the film is heated, and its heat has no way out"):
        ehd.steady_spherical(closed, place=(0, 0, 0), angular_velocity=(0, 0, 100.0))
    with pytest.raises(ehd.FilmError, match="no oil is a liquid above"):
        small = ball(VG, {"supply_temperature": SUPPLY, "housing_conductance": 1e-3})
        ehd.steady_spherical(small, place=(0, 0, 0), angular_velocity=(0, 0, 1000.0))
    with pytest.raises(ehd.FilmError, match="the heating is too strong"):
        ehd.steady_spherical(small, place=(0, 0, 0), angular_velocity=(0, 0, 3000.0))


def test_an_audit_tells_that_a_film_warms_up():
    given = {"place": (0, 0, 0.6 * C), "angular_velocity": (300.0, 0.0, 50.0)}
    cold = ehd.steady_spherical(ball(VG, thermal=None, socket_angles=RING), **given).audit()["heating"]
    assert cold.on is False and cold.matters and cold.remedy is not None
    warm = ehd.steady_spherical(ball(VG, socket_angles=RING), **given).audit()["heating"]
    assert warm.on and warm.value > 0.1
