"""Film temperature against closed forms (Petroff heating, isothermal walls), its balance, its order, its steady state.

One bearing throughout: R = 25 mm, L = 50 mm, c = 25 um. Couette heat per area of the concentric film: mu (R omega)^2
/ c.
"""

import itertools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.solved_film import History
from tests.sampling import covering, sample

R, L, C = 0.025, 0.05, 25e-6
SUPPLY, MU, BETA, OMEGA = 320.0, 0.02, 0.03, 300.0
LAW = ehd.ReynoldsTemperature(point=(SUPPLY, MU), coefficient=BETA)
OIL = ehd.Lubricant(temperature_law=LAW, temperature=SUPPLY, density=870.0, specific_heat=2000.0)
CAPACITY = 870.0 * 2000.0
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)]
# Relative to the largest of the four terms; the equations close to rounding, the flows carry about 1e-11.
BALANCE = 1e-8


def bearing(thermal, **options):
    return ehd.JournalBearing(
        **({"journal_radius": R, "length": L, "radial_clearance": C, "lubricant": OIL, "thermal": thermal} | options)
    )


def motion(eccentricity=0.0, speed=OMEGA, axial=0.0, **rates):
    out = np.zeros(10)
    out[0], out[8], out[9] = eccentricity * C, speed, axial
    out[4], out[5] = rates.get("vx", 0.0), rates.get("vy", 0.0)
    return out


def petroff(temperature=SUPPLY, speed=OMEGA):
    """Loss of the concentric film, W."""
    return float(LAW.viscosity(temperature, 870.0)) * (R * speed) ** 2 / C * 2.0 * math.pi * R * L


def defect(balance):
    return abs(balance["heat_in"] - balance["convected"] - balance["conducted"] - balance["stored"]) / max(
        abs(v) for v in balance.values()
    )


def run(model, at, step, steps, history=None):
    """Accept ``steps`` steps at a motion; returns the last history and the largest defect of the balance."""
    history = model.initial_history(at) if history is None else history
    worst = 0.0
    for _ in range(steps):
        evaluation = model.evaluate(at, history, step)
        assert evaluation.status is ehd.Status.CONVERGED
        history = evaluation.history()
        worst = max(worst, defect(model.effects.thermal.balance(evaluation.film, history.temperature)))
    return history, worst


@pytest.mark.parametrize(
    "thermal", sample([ehd.LumpedThermal(supply_temperature=SUPPLY), ehd.FilmEnergy(supply_temperature=SUPPLY)], 0)
)
def test_adiabatic_petroff_heating_in_time(thermal):
    """No through-flow, no conduction.

    Exp(beta (T - T0)) = 1 + beta P0 t / (rho c_p V), approached with the second order.
    """
    model, at, end, errors = build_model(bearing(thermal)), motion(), 0.02, []
    volume = 2.0 * math.pi * R * L * C
    exact = math.log(1.0 + BETA * petroff() * end / (CAPACITY * volume)) / BETA
    assert exact > 15.0  # the viscosity falls to 60 %
    for steps in (200, 400):
        history, worst = run(model, at, end / steps, steps)
        assert worst < BALANCE
        errors.append(float(np.abs(np.asarray(history.temperature) - SUPPLY - exact).max()))
    assert errors[1] < 1e-5 * exact
    assert 3.8 < errors[0] / errors[1] < 4.2


@pytest.mark.parametrize("cavitation", sample([ehd.SwiftStieber(), ehd.FullSommerfeld(), ehd.Gumbel()], 0), ids=repr)
@pytest.mark.parametrize("turn", [0.5, 1.0])
def test_a_hot_place_that_moves_is_of_second_order_in_time(cavitation, turn):
    """The smallest gap turns with the oil, or with the journal: temperatures and force after one of its turns.

    The errors of 64, 128 and 256 steps fall by more than ten in all, the last one is below 3e-4 of the force.
    """
    thermal, found = ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=1e3), []
    for steps in (64, 128, 256, 1024):
        model, history, at = build_model(bearing(thermal, cavitation=cavitation)), None, motion()
        rate = turn * at[8]
        for k in range(1, steps + 1):
            angle = 2.0 * math.pi * k / steps
            at[:2] = 0.6 * C * math.cos(angle), 0.6 * C * math.sin(angle)
            at[4:6] = -rate * at[1], rate * at[0]
            history = model.initial_history(at) if history is None else history
            evaluation = model.evaluate(at, history, 2.0 * math.pi / rate / steps)
            history = evaluation.history()
        found.append((history.temperature, evaluation.wrench[:2]))
    for values, largest in zip(zip(*found), (3e-3, 3e-4)):
        size = np.ptp(values[-1]) if values[-1].ndim == 2 else np.linalg.norm(values[-1])
        errors = np.array([np.abs(one - values[-1]).max() for one in values[:3]]) / size
        assert errors[-1] < largest
        assert np.all(errors[:-1] > 2.5 * errors[1:]) and errors[0] > 10.0 * errors[2]


def test_adiabatic_petroff_heating_along_the_bearing():
    """Concentric journal that pulls oil through at h w / 2.

    Exp(beta (T - T_s)) = 1 + beta mu_s v^2 z / (rho c_p h q).
    """
    w, errors = 2.0, []
    q = 0.5 * C * w
    for n_z in (40, 80):
        film = ehd.FiniteLength(n_theta=16, n_z=n_z, stretch=0.0)
        model = build_model(bearing(ehd.FilmEnergy(supply_temperature=SUPPLY), film=film))
        T = settled_history(model, motion(axial=w)).temperature
        heat = MU * ((R * OMEGA) ** 2 + w**2) / C
        z = model.grid.z * R + 0.5 * L
        exact = SUPPLY + np.log(1.0 + BETA * heat * z / (CAPACITY * q)) / BETA
        assert np.ptp(T, axis=0).max() < 1e-8  # the film is the same all around
        errors.append(np.abs(T[0] - exact).max() / (exact[-1] - SUPPLY))
    assert exact[-1] - SUPPLY > 15.0
    assert errors[1] < 0.03  # first-order upwind with 80 cells
    assert 1.7 < errors[0] / errors[1] < 2.3


def test_lumped_steady_state_is_petroff_against_the_housing():
    """Concentric: P(T) = G (T - T_h), the only way out; one equation, solved here by bisection."""
    G, housing = 8.0, 310.0
    thermal = ehd.LumpedThermal(supply_temperature=SUPPLY, housing_conductance=G, housing_temperature=housing)
    uniform = ehd.FiniteLength(stretch=0.0)  # whose weights add up to the area exactly
    result = ehd.steady(bearing(thermal, film=uniform), speed=OMEGA, eccentricity_ratio=0.0)
    low, high = housing, 500.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if petroff(middle) > G * (middle - housing) else (low, middle)
    assert result.temperature == pytest.approx(low, abs=1e-8)  # settled to 1e-11 of the rise
    assert result.power_loss == pytest.approx(G * (low - housing), rel=1e-9)


@pytest.mark.parametrize("sides", [(4e4, 0.0), (1e4, 3e4)])
def test_film_between_walls_without_through_flow(sides):
    """U_b (T - T_b) + U_j (T - T_j) = mu(T) v^2 / h at every point of a concentric film.

    Tends to the walls as U grows.
    """
    bush, journal = sides
    thermal = ehd.FilmEnergy(
        supply_temperature=SUPPLY,
        bush_coefficient=bush,
        bush_temperature=330.0,
        journal_coefficient=journal,
        journal_temperature=310.0,
    )
    T = ehd.steady(bearing(thermal), speed=OMEGA, eccentricity_ratio=0.0).temperature
    heat = LAW.viscosity(T, 870.0) * (R * OMEGA) ** 2 / C
    np.testing.assert_allclose(
        bush * (T - 330.0) + journal * (T - 310.0), heat, rtol=1e-8
    )  # settled to 1e-11 of the rise
    assert np.ptp(T) < 1e-8


@pytest.mark.parametrize(("bush", "journal"), [(1e9, 1e9), (1e9, 0.0), (0.0, 2e3), (1e3, 3e3), (2e3, 1e9)])
def test_conduction_across_a_film_without_through_flow(bush, journal):
    """Uniform heat between two walls: the exact parabola, its mean, from k T'' = -heat / h with k T' = U_b (T - T_b)
    at y = 0 and
    -k T' = U_j (T - T_j) at y = h, for walls of different temperatures."""
    k, T_b, T_j = 0.13, 331.0, 315.0
    thermal = ehd.FilmEnergy(
        supply_temperature=SUPPLY,
        bush_coefficient=bush,
        bush_temperature=T_b,
        journal_coefficient=journal,
        journal_temperature=T_j,
        conductivity=k,
    )
    T = ehd.steady(bearing(thermal), speed=OMEGA, eccentricity_ratio=0.0).temperature
    heat = float(LAW.viscosity(T[0, 0], 870.0)) * (R * OMEGA) ** 2 / C
    # T = a + b y - heat y^2 / (2 k h)
    system = np.array([[bush, -k], [journal, k + journal * C]])
    a, b = np.linalg.solve(system, [bush * T_b, heat + journal * (T_j + 0.5 * heat * C / k)])
    np.testing.assert_allclose(T, a + 0.5 * b * C - heat * C / (6.0 * k), atol=1e-6)


def test_conductivity_of_an_adiabatic_film_changes_nothing():
    off, on = (ehd.FilmEnergy(supply_temperature=SUPPLY, conductivity=k) for k in (None, 0.13))
    first, second = (
        ehd.steady(bearing(t, end_pressures=(0.0, 4e5)), speed=OMEGA, eccentricity_ratio=0.5) for t in (off, on)
    )
    assert np.array_equal(first.temperature, second.temperature)


def test_isothermal_walls_are_the_limit_of_strong_cooling():
    """Excess over the wall falls like 1 / U, and the film becomes the isothermal one."""
    plain = ehd.steady(bearing(None), speed=OMEGA, eccentricity_ratio=0.6)
    rise, loss = [], []
    for U in (1e7, 1e8):
        r = ehd.steady(
            bearing(ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=U)), speed=OMEGA, eccentricity_ratio=0.6
        )
        rise.append(r.temperature.max() - SUPPLY)
        loss.append(abs(r.power_loss / plain.power_loss - 1.0))
    assert 9.5 < rise[0] / rise[1] < 10.5
    assert loss[1] < 1e-3
    assert 9.0 < loss[0] / loss[1] < 11.0


THERMAL = {
    "lumped": ehd.LumpedThermal(
        supply_temperature=SUPPLY, housing_conductance=3.0, housing_temperature=310.0, capacity=0.01
    ),
    "field": ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=2e3, bush_temperature=310.0),
    "conducting": ehd.FilmEnergy(
        supply_temperature=SUPPLY, bush_coefficient=2e4, bush_temperature=310.0, conductivity=0.13
    ),
}


@pytest.mark.parametrize(
    ("ends", "kind", "cavitation"),
    covering(itertools.product([(0.0, 0.0), (1e5, 4e5)], THERMAL, CLOSURES)),
    ids=lambda x: x if isinstance(x, str) else type(x).__name__,
)
def test_balance_over_a_transient_and_at_rest(cavitation, kind, ends):
    """Heat in = convected + conducted + stored, at every accepted step with squeeze, and in the steady state."""
    model = build_model(bearing(THERMAL[kind], cavitation=cavitation, end_pressures=ends))
    history, worst = run(model, motion(0.6, vx=2e-3, vy=-3e-3), 1e-4, 20)
    assert worst < BALANCE
    assert np.all(np.isfinite(history.temperature))
    if ends == (0.0, 0.0) and cavitation.conserves_mass:
        return
    at = motion(0.6)
    settled = settled_history(model, at)
    balance = model.effects.thermal.balance(model.evaluate(at, settled).film, settled.temperature)
    assert balance["stored"] == 0.0
    assert defect(balance) < BALANCE


@pytest.mark.parametrize("cavitation", sample(CLOSURES, 2), ids=lambda c: type(c).__name__)
def test_steady_temperature_is_where_the_transient_ends(cavitation):
    thermal = ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=5e3)
    b = bearing(thermal, cavitation=cavitation, end_pressures=(1e5, 4e5), film=ehd.FiniteLength(n_theta=32, n_z=6))
    model = build_model(b)
    at = motion(0.5)
    settled = settled_history(model, at).temperature
    history, _ = run(model, at, 2e-3, 600)
    # the oil of steps of ten revolutions passes many columns: its transport is of first order in part
    assert 1e-3 < np.abs(history.temperature - settled).max() < 0.01 * np.ptp(settled)
    history, _ = run(model, at, 2.0 * math.pi / at[8] / 64, 1600, history)
    np.testing.assert_allclose(history.temperature, settled, atol=1e-6)


def test_field_heat_is_the_mechanical_power():
    """The field's own sum of shear and pressure-flow heat tends to the power that the motion puts in."""
    errors = []
    for n_theta, n_z in ((48, 8), (192, 32)):
        model = build_model(
            bearing(
                ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=5e3),
                film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
                cavitation=ehd.FullSommerfeld(),
                end_pressures=(0.0, 0.0),
            )
        )
        at = motion(0.6, vx=2e-3, vy=-3e-3)
        evaluation = model.evaluate(at)
        film = evaluation.film
        heat = model.effects.thermal.balance(film, film.temperature)["heat_in"]
        errors.append(abs(heat / evaluation.quantities()["power_loss"] - 1.0))
    assert errors[0] < 0.015  # second order on 48 x 8
    assert errors[1] < 0.2 * errors[0]


def test_force_of_a_step_sees_the_temperature_at_its_start():
    """Lumped: the wrench is that of an isothermal bearing whose oil has the history's temperature."""
    model = build_model(bearing(ehd.LumpedThermal(supply_temperature=SUPPLY)))
    at = motion(0.6, vx=2e-3)
    wrench = model.evaluate(at, History(temperature=340.0), 1e-4).wrench
    cold = build_model(bearing(None, lubricant=OIL.at(340.0))).evaluate(at).wrench
    np.testing.assert_allclose(wrench, cold, rtol=1e-12, atol=1e-12 * np.abs(cold).max())


def test_uniform_field_equals_the_lumped_film():
    at = motion(0.6, vx=2e-3)
    lumped = build_model(bearing(ehd.LumpedThermal(supply_temperature=SUPPLY)))
    field = build_model(bearing(ehd.FilmEnergy(supply_temperature=SUPPLY)))
    one = lumped.evaluate(at, History(temperature=340.0)).wrench
    many = field.evaluate(at, History(temperature=np.full(field.grid.shape, 340.0))).wrench
    np.testing.assert_allclose(many, one, rtol=1e-11, atol=1e-11 * np.abs(one).max())


def test_a_rejected_step_leaves_nothing_behind():
    """Evaluating other states and steps in between does not change a step's result."""
    for thermal in (ehd.LumpedThermal(supply_temperature=SUPPLY), ehd.FilmEnergy(supply_temperature=SUPPLY)):
        model = build_model(bearing(thermal))
        history, _ = run(model, motion(0.5), 1e-4, 3)
        after = model.evaluate(motion(0.6), history, 1e-4).history()
        first = np.array(after.temperature)
        model.evaluate(motion(0.8), after, 3e-4).history()
        again = model.evaluate(motion(0.6), history, 1e-4).history().temperature
        np.testing.assert_allclose(again, first, rtol=1e-14)


def test_equilibrium_is_settled():
    b = bearing(ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=2e3))
    eq = ehd.equilibrium(b, speed=OMEGA, load=(0.0, -2000.0))
    np.testing.assert_allclose(eq.film.force[:2], [0.0, 2000.0], atol=1e-6)  # 1e-10 of the load, settled to 1e-11
    again = ehd.steady(
        b, speed=OMEGA, eccentricity_ratio=eq.eccentricity_ratio, direction=math.atan2(*eq.position[::-1])
    )
    np.testing.assert_allclose(again.temperature, eq.film.temperature, rtol=1e-9)


def test_no_way_out_for_the_heat_is_an_error():
    for thermal in (ehd.LumpedThermal(supply_temperature=SUPPLY), ehd.FilmEnergy(supply_temperature=SUPPLY)):
        with pytest.raises(ehd.FilmError, match="no way out"):
            ehd.steady(bearing(thermal), speed=OMEGA, eccentricity_ratio=0.0)


def test_input_errors_name_what_is_missing():
    with pytest.raises(ehd.InputError, match=r"JournalBearing\.thermal must be LumpedThermal"):
        bearing("lumped")
    with pytest.raises(ehd.InputError, match=r"LumpedThermal\.supply_temperature must be > 0 K"):
        ehd.LumpedThermal(supply_temperature=-5.0)
    with pytest.raises(ehd.InputError, match=r"FilmEnergy\.bush_coefficient"):
        ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=-1.0)


@pytest.mark.parametrize(
    "thermal", [ehd.LumpedThermal(supply_temperature=313.15), ehd.FilmEnergy(supply_temperature=313.15)]
)
def test_long_steps_do_not_swing_and_short_ones_are_explicit(thermal):
    """Steps of ten exchanges of the oil, hot by 60 to 110 K: every film after the first few is the steady one.

    With a temperature field up to 1 %, as the oil passes many columns in a step. A step whose heat is held would swing
    between a third and twice the load.
    """
    law = ehd.VogelTemperature(first=(313.15, 0.05), second=(373.15, 0.008))
    b = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=20e-6,
        lubricant=ehd.Lubricant(temperature_law=law),
        thermal=thermal,
        film=ehd.FiniteLength(n_theta=48, n_z=8),
    )
    model, at = build_model(b), np.zeros(10)
    at[0], at[8] = 0.7 * 20e-6, 1000.0
    steady = float(np.hypot(*model.evaluate(at, settled_history(model, at)).wrench[:2]))
    for step in (0.03, 0.1, 1.0):
        history, worst = run(model, at, step, 12)
        assert worst < BALANCE
        loads = []
        for _ in range(4):
            evaluation = model.evaluate(at, history, step)
            loads.append(float(np.hypot(*evaluation.wrench[:2])))
            history = evaluation.history()
        np.testing.assert_allclose(loads, steady, rtol=0.01 if isinstance(thermal, ehd.FilmEnergy) else 2e-3)
    # a thousandth of an exchange: what the oil stores is the power at the temperature of the step's start
    start = model.initial_history(at)
    film = model.evaluate(at, start, 1e-5)
    balance = model.effects.thermal.balance(film.film, film.history().temperature)
    assert balance["heat_in"] == model.effects.thermal.balance(film.film, start.temperature)["heat_in"]


@pytest.mark.parametrize("closure", [ehd.FullSommerfeld(), ehd.ElrodAdams()], ids=lambda c: type(c).__name__)
def test_a_groove_that_takes_oil_back_carries_no_heat_away(closure):
    """One temperature: friction and pumping heat the oil that leaves at the ends, for all that goes round in a groove.

    Full films, of an eccentricity and a pressure at which no oil comes in at the ends.
    """
    groove = ehd.CircumferentialGroove(width=0.005, pressure=1e6)
    made = bearing(ehd.LumpedThermal(supply_temperature=SUPPLY), supply=(groove,), cavitation=closure)
    film = ehd.steady(made, speed=OMEGA, eccentricity_ratio=0.15)
    assert film.leakage == pytest.approx(film.supply_flows[0], rel=1e-9)
    heat = film.power_loss + groove.pressure * film.leakage
    assert film.temperature - SUPPLY == pytest.approx(heat / (CAPACITY * film.leakage), rel=1e-7)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 1.6, 2.0, 2.4])
@pytest.mark.parametrize("heat", [ehd.LumpedThermal, ehd.FilmEnergy])
def test_a_hot_film_that_cools(measured, heat, ratio):
    """Steps that grow, from a tenth of a turn: no film is colder than the oil that enters, and forces do not run away.

    The film starts 60 K above its supply, and ends 20 to 30 K above it.
    """
    hot, turn = bearing(heat(supply_temperature=SUPPLY, initial_temperature=SUPPLY + 60.0)), 2.0 * math.pi / OMEGA
    model, at = build_model(hot), motion(0.7)
    settled = model.evaluate(at, settled_history(model, at)).wrench
    history, largest = model.initial_history(at), 0.0
    for k in range(24):
        found = model.evaluate(at, history, 0.1 * turn * min(ratio**k, 1e4))
        history = found.history()
        largest = max(largest, float(np.hypot(*found.wrench[:2])))
        assert np.min(found.film.temperature) >= SUPPLY - 1e-9
        assert np.min(model.effects.thermal.across(history.temperature)) >= SUPPLY - 1e-9
    measured("largest force over the settled one", largest / float(np.hypot(*settled[:2])), 3.0)


@pytest.mark.parametrize("seed", sample(range(24), 4))
def test_what_is_around_is_the_coldest(seed):
    """A film that falls is extrapolated to no temperature below those of supply, housing, walls and film, K."""
    rng = np.random.default_rng((8, seed))
    wall, housing = SUPPLY + rng.uniform(-30.0, 30.0, 2)
    heats = (
        ehd.LumpedThermal(supply_temperature=SUPPLY, housing_temperature=housing, housing_conductance=5.0),
        ehd.FilmEnergy(supply_temperature=SUPPLY, bush_temperature=wall, bush_coefficient=2e3),
        ehd.FilmEnergy(
            supply_temperature=SUPPLY, bush_temperature=wall, bush_coefficient=2e3, conductivity=0.13, across=2
        ),
    )
    for heat, around in zip(heats, (housing, wall, wall)):
        thermal = build_model(bearing(heat, film=ehd.FiniteLength(n_theta=24, n_z=4))).effects.thermal
        start = thermal.first_memory()
        rise = rng.uniform(0.0, 50.0, np.shape(thermal.across(start.temperature)[0]))
        fields = np.zeros_like(thermal.across(start.temperature))
        fields[0] = rise
        hot = thermal.warmed(start.temperature, fields)
        fall = np.zeros_like(fields)
        fall[0] = -(10.0 ** rng.uniform(-2.0, 4.0, rise.shape))
        history = History(temperature=hot, heating=np.array([fall, fall]), last_step=1.0)
        found = thermal.across(thermal.extrapolated(history, 1.0))[0]
        assert found.min() >= min(SUPPLY, around) - 1e-9
        # a short fall is a straight line, to second order
        slow = History(temperature=hot, heating=1e-4 * np.array([fall, fall]) / np.abs(fall).max(), last_step=1.0)
        line = thermal.across(hot)[0] + slow.heating[1, 0]
        away = thermal.across(hot)[0] > min(SUPPLY, around) + 1.0
        np.testing.assert_allclose(
            thermal.across(thermal.extrapolated(slow, 1.0))[0][away], line[away], rtol=0, atol=1e-8
        )


@pytest.mark.slow
def test_grooved_films_of_swift_and_stieber_against_films_that_conserve_mass():
    """A groove or a pocket within 30 degrees of the largest gap: nine of ten bearings are in the stated ranges."""
    rng, ratios = np.random.default_rng(5), []
    for k in range(20):
        radius, slender, way = 10 ** rng.uniform(-1.9, -1.0), rng.uniform(0.4, 1.2), rng.choice([-1.0, 1.0])
        length, clearance = 2.0 * radius * slender, radius * rng.uniform(0.8e-3, 2e-3)
        supply = rng.uniform(308.0, 333.0)
        area = (ehd.AxialGroove, ehd.Pocket)[k % 2](
            angle=math.pi + rng.uniform(-1.0, 1.0) * math.pi / 6.0,
            width_angle=math.radians(rng.uniform(10.0, 30.0) + 20.0 * (k % 2)),
            length=rng.uniform(0.6, 0.9) * length,
            pressure=0.0 if k % 4 == 3 else 10 ** rng.uniform(4.3, 5.5),
        )
        oil = ehd.oil(("ISO VG 32", "ISO VG 46", "ISO VG 68")[k % 3])
        place = {"speed": way * rng.uniform(2.0, 20.0) / radius, "eccentricity_ratio": rng.uniform(0.3, 0.85)}
        found = []
        for closure in (ehd.SwiftStieber(), ehd.ElrodAdams()):
            films = [
                ehd.steady(
                    ehd.JournalBearing(
                        journal_radius=radius,
                        length=length,
                        radial_clearance=clearance,
                        lubricant=oil,
                        supply=(area,),
                        cavitation=closure,
                        thermal=thermal,
                    ),
                    **place,
                )
                for thermal in (ehd.FilmEnergy(supply_temperature=supply), ehd.LumpedThermal(supply_temperature=supply))
            ]
            field, mean = (np.asarray(film.temperature) - supply for film in films)
            film = films[0]
            rises = field.mean(), field.max(), float(mean)
            found.append([*rises, film.power_loss, film.oil_flow, film.supply_flows[0]])
        ratios.append(np.divide(*found))
    low, high = np.quantile(ratios, (0.1, 0.9), axis=0)
    stated = ((0.65, 1.0), (1.0, 1.2), (0.85, 1.1), (1.0, 1.3), (1.05, 1.6), (0.7, 1.1))
    for name, least, most, (lower, upper) in zip(
        ("mean rise", "largest rise", "one temperature", "loss", "oil", "supply"), low, high, stated, strict=True
    ):
        assert lower < least < most < upper, (name, least, most)


@pytest.mark.slow
def test_films_behind_grooves_without_pressure_are_found():
    """The border between cavity and loaded film moves with the temperature; oil that is passed on must not jump."""
    for k in range(30):
        rng = np.random.default_rng((7, k))
        radius = 10 ** rng.uniform(-1.9, -1.0)
        clearance, length = radius * rng.uniform(0.8e-3, 2e-3), rng.uniform(0.4, 1.2) * 2.0 * radius
        speed = rng.uniform(2.0, 20.0) / radius * rng.choice([-1.0, 1.0])
        oil = ehd.oil(str(rng.choice(["ISO VG 32", "ISO VG 46", "ISO VG 68"])))
        ratio, angle = rng.uniform(0.3, 0.9), math.pi + rng.uniform(-1.0, 1.0)
        groove = ehd.AxialGroove(angle=angle, width_angle=math.radians(rng.uniform(10.0, 30.0)), length=0.75 * length)
        made = ehd.JournalBearing(
            journal_radius=radius,
            length=length,
            radial_clearance=clearance,
            lubricant=oil,
            supply=(groove,),
            thermal=ehd.FilmEnergy(supply_temperature=320.0),
        )
        assert ehd.steady(made, speed=speed, eccentricity_ratio=ratio).temperature.max() > 320.0
