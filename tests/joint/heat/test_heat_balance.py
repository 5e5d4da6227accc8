"""Heat balance of random bearings by reported quantities: fresh oil carries the loss away at the film's rise."""

import functools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.heat.energy import end_flows_around, pass_on, transport_slopes
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.heat.power import OilFlows, heat_and_exchange, heat_of
from exudyn_ehd.joint.model.build import build_model, build_study_model
from exudyn_ehd.joint.model.results import supply_flows
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from tests.sampling import sample

SUPPLY = 313.0
OIL = ehd.oil("ISO VG 46")
CAPACITY = OIL.density * OIL.specific_heat


def draw(number):
    """Bearing, speed, rad/s, eccentricity ratio and tilt of a number, over sizes, closures, supplies and models."""
    rng = np.random.default_rng((61, number))
    R = math.exp(rng.uniform(math.log(0.01), math.log(0.1)))
    L, c = 2.0 * R * rng.uniform(0.3, 1.2), R * rng.uniform(8e-4, 2e-3)
    p = rng.choice([0.2e5, 0.5e5, 2e5, 5e5])
    at, long = rng.uniform(0.0, 2.0 * math.pi), L * rng.uniform(0.4, 0.8)
    axial = ehd.AxialGroove(angle=at, width_angle=rng.uniform(0.2, 0.6), length=long, pressure=p)
    areas = {
        "hole": (ehd.Hole(angle=at, z=0.1 * L * rng.uniform(-1, 1), diameter=L * rng.uniform(0.08, 0.25), pressure=p),),
        "groove": (axial,),
        "two grooves": (axial, ehd.AxialGroove(angle=at - math.pi, width_angle=0.3, length=long, pressure=p)),
        "pocket": (ehd.Pocket(angle=at, width_angle=rng.uniform(0.3, 0.9), length=0.6 * long, pressure=p),),
        "around": (ehd.CircumferentialGroove(width=L * rng.uniform(0.06, 0.2), pressure=p),),
        "none": (),
    }
    supply = areas[list(areas)[number % 6]]
    closures = [ehd.ElrodAdams(), ehd.SwiftStieber(), ehd.ElrodAdams(), ehd.Gumbel(), ehd.FullSommerfeld()]
    closure = closures[(number // 6) % 5]
    if closure.conserves_mass and not supply:
        closure = ehd.ElrodAdams(cavity_pressure=-1e5)
    walls = {"bush_coefficient": rng.uniform(100.0, 3000.0), "bush_temperature": SUPPLY + rng.uniform(0.0, 30.0)}
    models = [
        functools.partial(ehd.LumpedThermal, housing_conductance=rng.choice([0.0, 1.0])),
        ehd.FilmEnergy,
        functools.partial(ehd.FilmEnergy, conductivity=0.13, **walls),
        functools.partial(ehd.FilmEnergy, conductivity=0.13, across=2, **walls),
    ]
    thermal = models[rng.integers(4)](supply_temperature=SUPPLY, carry_over=rng.choice([1.0, 1.0, 0.7]))
    bearing = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": c,
        "lubricant": OIL,
        "cavitation": closure,
        "supply": supply,
        "thermal": thermal,
    }
    eccentricity = rng.uniform(0.2, 0.9)
    tilt = rng.choice([0.0, 0.5]) * (1.0 - eccentricity) * c / (0.5 * L)
    return bearing, rng.uniform(2.0, 15.0) / R, eccentricity, (tilt, 0.0)


def settled(number, **options):
    """Steady film of a number and its model."""
    bearing, speed, eccentricity, tilt = draw(number)
    model, at = build_study_model(ehd.JournalBearing(**bearing, **options), 0.0), np.zeros(MOTION_SIZE)
    at[0], at[2], at[8] = eccentricity * bearing["radial_clearance"], tilt[0], speed
    return model, model.evaluate(at, settled_history(model, at))


def reported(model, evaluation):
    """Loss with the power of the feeds, W, flow of the feeds and flow out, m3/s, by quantities that users see.

    Oil that a cavity makes enters a groove against its pressure, like any oil that a film gives back. Of this oil the
    balance of heat leaves out what the film passes on to the groove, and the flow of the feed all.
    """
    q, film, pc = evaluation.quantities(), evaluation.film, model.bearing.cavitation.cavity_pressure
    areas, supply, pc = supply_flows(film), film.parts.supply, pc if math.isfinite(pc) else 0.0
    passed, made = (0.0 * areas,) * 2
    if areas.size:
        oil = OilFlows(film, 1.0)
        passed, made = (supply.flows(field) * film.parts.flow_scale for field in (oil.passed, oil.made))
    pumped = sum((a.pressure - pc) * flow for a, flow in zip(model.bearing.supply, areas - made, strict=True))
    feeds = areas - made + passed
    loss, out = q["power_loss"] + pumped + pc * q["leakage"], q["leakage"] - np.minimum(feeds, 0.0).sum()
    return loss, np.maximum(feeds, 0.0).sum(), out


def check(number, tolerance, **options):
    """Defects of the balance, relative to loss and flow, are below ``tolerance``."""
    model, evaluation = settled(number, **options)
    film, thermal = evaluation.film, model.effects.thermal
    T = thermal.steady_temperature(film)
    balance, (loss, *flows) = thermal.balance(film, T), reported(model, evaluation)
    through = max(flows)
    assert balance["convected"] + balance["conducted"] == pytest.approx(balance["heat_in"], rel=1e-8)
    closure, rise = model.bearing.cavitation, np.asarray(thermal.split(T)[0]) - SUPPLY
    breathes = isinstance(closure, ehd.FullSommerfeld) or closure.cavity_pressure < 0.0
    lumped = isinstance(model.bearing.thermal, ehd.LumpedThermal)
    # losses count the pressure flow by the loads' integrals, of higher order along z
    assert balance["heat_in"] == pytest.approx(loss, rel=1e-3 if lumped else 0.25 * tolerance)
    if not breathes:
        carried = CAPACITY * OilFlows(film, 1.0).exchanged * film.parts.flow_scale
        assert carried == pytest.approx(CAPACITY * through, rel=tolerance)
        if model.bearing.thermal.carry_over == 1.0:
            # no oil leaves hotter than the hottest place
            assert balance["convected"] < (1.0 + tolerance) * CAPACITY * through * rise.max()


@pytest.mark.parametrize("numbers", [(0, 7, 16, 22, 34), pytest.param(range(200), marks=pytest.mark.slow)])
def test_what_leaves_carries_the_loss(numbers):
    """2 % is the error of flows on ten rows."""
    for number in numbers:
        check(number, 0.02)


@pytest.mark.slow
def test_balance_on_a_fine_grid():
    for number in range(0, 200, 7):
        check(number, 0.005, film=ehd.FiniteLength(n_theta=96, n_z=40))


def whirl(number, turns, per_turn=64, **options):
    """Model, evaluation and history of every step of a journal that whirls."""
    spec, speed, eccentricity, tilt = draw(number)
    c, model = spec["radial_clearance"], build_model(ehd.JournalBearing(**spec | options))
    step, size = 2.0 * math.pi / speed / per_turn, 0.3 * (1.0 - eccentricity)
    at, history = np.zeros(MOTION_SIZE), None
    at[2], at[8] = tilt[0], speed
    for k in range(turns * per_turn):
        angle = speed * step * k
        at[:2] = c * (eccentricity + size * math.cos(angle)), c * size * math.sin(angle)
        at[4:6] = -c * size * speed * math.sin(angle), c * size * speed * math.cos(angle)
        evaluation = model.evaluate(at, model.initial_history(at) if history is None else history, step)
        history = evaluation.history()
        yield model, evaluation, history


def cycle(number, turns, per_turn=64):
    """Means over the last turn: heat, W, exchanged flow, m3/s, and those of `reported`.

    The film is isothermal, as only the oil in the film has to settle.
    """
    rows = []
    for model, evaluation, _ in whirl(number, turns, per_turn, thermal=None):
        heat, exchanged = heat_and_exchange(evaluation.film, 1.0)
        rows.append((heat, exchanged * evaluation.film.parts.flow_scale, *reported(model, evaluation)))
    return np.mean(rows[-per_turn:], axis=0)


@pytest.mark.parametrize("number", sample([14, 0, 1, 2, 4, 12, 16, 30, 34, 7, 10, 21], 0))
def test_balance_over_a_settled_cycle(number):
    """2 %: some per mille are left of flows that have not settled, and the journal's rate steps."""
    heat, exchanged, loss, *flows = cycle(number, 6 if number == 14 else 15)
    assert heat == pytest.approx(loss, rel=0.005)
    assert exchanged == pytest.approx(max(flows), rel=0.02)


def check_cycle(number, tolerance, per_turn=64, turns=15, **options):
    """Over the last turn the loss leaves by oil and walls, but for the heat by which the film's oil still gains."""
    rows, held = [], []
    for model, evaluation, history in whirl(number, turns, per_turn, **options):
        film, T, thermal = evaluation.film, history.temperature, model.effects.thermal
        balance, rise = thermal.balance(film, T), thermal.split(T)[0] - SUPPLY
        content = film.solver.content if film.solver.closure.conserves_mass else film.solver.H
        full = CAPACITY * film.parts.flow_scale * np.sum(film.solver.area * content * rise)
        held.append(getattr(thermal, "capacity", 0.0) * rise if np.isscalar(rise) else full)
        parts = [balance[name] for name in ("heat_in", "convected", "conducted", "stored")]
        rows.append([reported(model, evaluation)[0], *parts])
    loss, heat, convected, conducted, stored = np.mean(rows[-per_turn:], axis=0)
    gained = (held[-1] - held[-1 - per_turn]) / (per_turn * film.step)
    assert heat == pytest.approx(loss, rel=0.5 * tolerance)
    assert stored == pytest.approx(gained, abs=0.1 * tolerance * loss)
    assert convected + conducted == pytest.approx(loss - gained, abs=tolerance * loss)


@pytest.mark.slow
def test_heat_balance_over_a_settled_cycle():
    """0.5 %: heat of the pressure flow on ten rows; 0.1 %: storage that 64 steps a turn leave."""
    for number in (23, *range(0, 200, 11)):
        # a wide groove, whose own oil warms up for long
        check_cycle(number, 0.01, turns=45 if number == 154 else 15)


@pytest.mark.slow
@pytest.mark.parametrize("number", [14, 24, 46])
def test_heat_balance_over_a_settled_cycle_on_a_fine_grid(number):
    check_cycle(number, 0.005, film=ehd.FiniteLength(n_theta=96, n_z=40))


SMALL = {"journal_radius": 0.02, "length": 0.032, "radial_clearance": 25e-6, "lubricant": OIL}
AREAS = {
    "around": ehd.CircumferentialGroove(width=0.003, pressure=0.5e5),
    "axial": ehd.AxialGroove(angle=-1.4, width_angle=0.3, length=0.026, pressure=1e5),
}


@pytest.mark.parametrize("carry_over", sample([1.0, 0.6], 1))
@pytest.mark.parametrize("area", AREAS.values(), ids=AREAS)
@pytest.mark.parametrize("closure", [ehd.SwiftStieber(), ehd.ElrodAdams()], ids=["swift", "elrod"])
def test_a_supply_area_is_well_mixed(closure, area, carry_over):
    """One temperature T_mix, and what links carry in, Q T, and out, with no more fresh oil than N + X.

    0.2 % is by how much mixed areas differ, and what is left of the temperature's limiter along z.
    """
    thermal = ehd.FilmEnergy(supply_temperature=SUPPLY, carry_over=carry_over)
    bearing = ehd.JournalBearing(**SMALL, cavitation=closure, supply=(area,), thermal=thermal)
    model, at = build_study_model(bearing, 0.0), np.zeros(MOTION_SIZE)
    at[0], at[8] = 0.75 * SMALL["radial_clearance"], 350.0
    film = model.evaluate(at, settled_history(model, at)).film
    T, inside = model.effects.thermal.steady_temperature(film) - SUPPLY, model.parts.supply.masks[0]
    mix, flows, slopes = T[inside].mean(), OilFlows(film, 1.0), np.empty((5, T.size))
    assert np.ptp(T[inside]) < 2e-3 * T.max()
    links, unlimited = (film.grid.link_x, film.grid.link_z), np.full(T.shape, np.inf)
    transport_slopes(flows.x, flows.z, flows.entering, T, links, unlimited, slopes)
    slopes, given, arriving = slopes.reshape(5, *T.shape), 0.0, 0.0
    for axis, flow in enumerate((flows.x, flows.z)):
        leaves = inside.astype(float) - np.roll(inside, -1, axis)
        given += np.sum(leaves * (slopes[2 * axis] * T + slopes[2 * axis + 1] * np.roll(T, -1, axis)))
        arriving += np.sum(np.maximum(-leaves * flow, 0.0))
    heat = heat_of(film)[inside].sum() / (CAPACITY * film.parts.flow_scale)
    taken = max(0.0, -flows.outside[inside].sum()) + (1.0 / carry_over - 1.0) * arriving
    # where a closure does not conserve mass, the cavity begins in half control volumes beside the area
    mixed = flows.back * np.sum(flows.lost * T) / (flows.total_lost or 1.0)
    made = carry_over * mixed * flows.found[inside].sum() - mix * flows.lost[inside].sum()
    assert given + taken * mix == pytest.approx(heat + made, abs=2e-3 * (arriving * mix))
    flushed = OilFlows(film, carry_over).exchanged - flows.exchanged
    fresh_cavity = (1.0 - carry_over) * min(flows.total_found, flows.total_lost)
    assert flushed == pytest.approx((1.0 / carry_over - 1.0) * arriving + fresh_cavity)


def test_flows_along_an_end():
    """A half control volume fills up before oil leaves it, sucks nothing in, and takes what an end pressure drives."""
    turned, none, flow, entering = np.array([4.0, 3.0, 2.0, 3.0, 4.0, 5.0]), np.zeros(6), np.empty(6), np.empty(6)
    nowhere = np.zeros(6, dtype=bool)
    # nothing is pressed out: the ring carries what its narrowest place lets through
    end_flows_around(turned, none, none, none, nowhere, flow, entering)
    np.testing.assert_allclose(flow, 2.0)
    np.testing.assert_allclose(entering, 0.0)
    # the film presses 1.5 out where the gap opens: half of it leaves, the rest fills up and leaves where it closes
    pressed = np.array([0.0, 0.0, 0.0, -1.5, 0.0, 0.0])
    end_flows_around(turned, pressed, none, none, nowhere, flow, entering)
    np.testing.assert_allclose(flow, [3.0, 3.0, 2.0, 3.0, 3.0, 3.0])
    np.testing.assert_allclose(entering, [0.0, 0.0, -1.0, -0.5, 0.0, 0.0])
    # the same turned backwards
    end_flows_around(-turned[::-1].copy(), np.roll(pressed[::-1], 1), none, none, nowhere, flow, entering)
    np.testing.assert_allclose(entering, np.roll([0.0, 0.0, -1.0, -0.5, 0.0, 0.0][::-1], 1))
    # an end pressure drives 2 sqrt(q B) with q = 0.25 and B = 1
    pressed[:] = 0.0, 0.0, 0.0, 0.25, 0.0, 0.0
    end_flows_around(turned, pressed, none, none, nowhere, flow, entering)
    assert entering[3] == pytest.approx(2.0 * math.sqrt(0.25))
    assert flow[3] == pytest.approx(2.0 - 0.25 + 1.0)


@pytest.mark.parametrize("seed", range(40))
def test_flows_along_an_end_close(seed):
    """The ring's flows after one turn are those with which it began, whatever enters and leaves."""
    rng = np.random.default_rng((5, seed))
    n, way = 48, rng.choice([-1.0, 1.0])
    turned = way * (1.0 + 0.9 * np.cos(2.0 * math.pi * np.arange(n) / n + rng.uniform(0.0, 6.0)))
    pressed, stored = 0.03 * rng.normal(size=n) - rng.choice([0.0, 1e-4]), 0.01 * rng.normal(size=n)
    squeezed, full = 0.01 * rng.normal(size=n), rng.random(n) < 0.1
    flow, entering = np.empty(n), np.empty(n)
    end_flows_around(turned, pressed, stored, squeezed, full, flow, entering)
    np.testing.assert_allclose(flow - np.roll(flow, 1) + pressed + stored, entering, atol=1e-13)
    assert np.all((flow * way >= -0.02) & (np.abs(flow) <= np.abs(turned) + 0.02))


@pytest.mark.parametrize("way", (1, -1))
def test_a_cavity_passes_on_what_it_receives(way):
    """A gap that widens keeps the oil of its rupture, flows against the sliding stay, and the wall receives less.

    Walls are the edges of an arc in the first row, a quarter of the second row, and nothing in the third.
    """
    couette = np.array([3.0, 2.0, 3.0, 5.0, 6.0, 0.0])
    flow = np.array([-1.0, 2.0, 3.0, 5.0, 6.0, 0.0])
    found = np.array([0.0, 0.0, 1.0, 2.0, 1.0, 0.0])
    kept, last = np.array([-1.0, 2.0, 2.0, 2.0, 2.0, 0.0]), 5
    if way < 0:  # links i -> i+1 from the other end
        couette, flow, kept = (-np.roll(f[::-1], -1) for f in (couette, flow, kept))
        found, last = found[::-1].copy(), 0
    walls = np.zeros((6, 3))
    walls[[0, 5], 0], walls[last, 1] = 1.0, 0.25
    flows, left = np.tile(flow[:, None], 3), np.tile(found[:, None], 3)
    sliding, expected = np.tile(couette[:, None], 3), np.zeros((6, 3))
    passed, made = pass_on(flows, sliding, left, np.ones((6, 3)), walls, 300.0 * way)
    np.testing.assert_allclose(flows, np.transpose([kept, kept, flow]))
    expected[last, :2] = 4.0, 1.0
    np.testing.assert_allclose(passed, expected)
    np.testing.assert_allclose(made, expected)
    expected[last, :2] = 0.0, 3.0
    expected[:, 2] = found
    np.testing.assert_allclose(left, expected)


@pytest.mark.parametrize(
    ("closure", "supply"),
    [
        (ehd.ElrodAdams(), (AREAS["axial"],)),
        (ehd.ElrodAdams(), (AREAS["around"],)),
        (ehd.SwiftStieber(cavity_shear=0.0), ()),
    ],
    ids=["groove", "around", "swift"],
)
def test_ends_beside_a_cavity_shear_what_it_holds(closure, supply):
    """0.4 %: the error of second order on ten rows; a full half control volume at the ends makes 1.2 to 3 %."""
    losses = []
    for grid in ({}, {"film": ehd.FiniteLength(n_theta=96, n_z=40)}):
        oil = ehd.Lubricant(viscosity=0.02)
        b = ehd.JournalBearing(**SMALL | {"lubricant": oil}, cavitation=closure, supply=supply, **grid)
        losses.append(ehd.steady(b, speed=350.0, eccentricity_ratio=0.75).power_loss)
    assert losses[0] == pytest.approx(losses[1], rel=0.004)
