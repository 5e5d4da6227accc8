"""Heat balances of films whose density follows the pressure.

Masses, dissipated power, the incompressible limit, exact tangents.

The oil is ten times softer than mineral oil where an error in the density's share must show.
"""

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.heat.power import OilFlows, heat_and_exchange
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.solved_film import History
from tests.tangents import tangent_error

R, L, C = 0.025, 0.05, 25e-6
SUPPLY, OMEGA, STEP = 320.0, 300.0, 1e-4
SOFT = ehd.DowsonHigginson(coefficient=6e-9)
BARUS = ehd.BarusPressure(coefficient=1e-8)
OIL = ehd.Lubricant(
    temperature_law=ehd.ReynoldsTemperature(point=(SUPPLY, 0.02), coefficient=0.03),
    temperature=SUPPLY,
    density=870.0,
    specific_heat=2000.0,
)
CLOSURES = [
    ehd.FullSommerfeld(),
    ehd.Gumbel(),
    ehd.SwiftStieber(),
    ehd.ElrodAdams(cavity_pressure=-1e5),
]
LUMPED = ehd.LumpedThermal(supply_temperature=SUPPLY, housing_conductance=3.0, housing_temperature=310.0, capacity=0.01)
FIELD = ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=2e3, bush_temperature=310.0)
THERMAL = pytest.mark.parametrize("thermal", [LUMPED, FIELD], ids=["lumped", "field"])
CLOSURE = pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
PRESSURE = pytest.mark.parametrize("pressure_law", [None, BARUS], ids=["constant", "barus"])
# Tilted, squeezing, sliding axially; an eccentricity of 0.6.
MOTION = np.array([0.5 * C, 0.3 * C, 1e-4, -1.5e-4, 2e-3, -3e-3, 0.05, 0.02, OMEGA, 0.3])
UNIT = np.array([C, C, 1e-3, 1e-3, 5e-3, 5e-3, 0.2, 0.2, 300.0, 3.0])
REST = np.array([0.5 * C, 0.3 * C, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, OMEGA, 0.0])


def make(thermal, law=SOFT, pressure_law=None, **options):
    oil = dataclasses.replace(OIL, density_law=law, pressure_law=pressure_law)
    values = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": C,
        "lubricant": oil,
        "thermal": thermal,
        "end_pressures": (1e5, 4e5),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
    }
    return build_model(ehd.JournalBearing(**(values | options)))


def defect(balance):
    out = balance["convected"] + balance["conducted"] + balance["stored"]
    return abs(balance["heat_in"] - out) / max(abs(v) for v in balance.values())


def run(model, motion=MOTION, steps=4):
    """History after some steps that end at ``motion``, and the largest defect of the heat balance."""
    back = np.zeros(10)
    back[:4] = STEP * motion[4:8]
    history, worst = model.initial_history(motion - steps * back), 0.0
    for k in range(steps):
        evaluation = model.evaluate(motion - (steps - 1 - k) * back, history, STEP)
        assert evaluation.status is ehd.Status.CONVERGED
        history = evaluation.history()
        worst = max(worst, defect(model.effects.thermal.balance(evaluation.film, history.temperature)))
    return history, worst


@THERMAL
@CLOSURE
@PRESSURE
def test_heat_in_is_convected_conducted_and_stored(thermal, cavitation, pressure_law):
    """1e-8 of the largest term; the equations close to rounding, the flows carry about 1e-11."""
    model = make(thermal, pressure_law=pressure_law, cavitation=cavitation)
    history, worst = run(model, steps=20)
    assert worst < 1e-8
    assert np.all(np.isfinite(history.temperature))
    settled = settled_history(model, REST)
    balance = model.effects.thermal.balance(model.evaluate(REST, settled).film, settled.temperature)
    assert balance["stored"] == 0.0
    assert defect(balance) < 1e-8


@pytest.mark.parametrize("step", [0.0, STEP])
@pytest.mark.parametrize("cavitation", [CLOSURES[0], *CLOSURES[2:]], ids=lambda c: type(c).__name__)
def test_flows_are_the_mass_flows_of_the_solved_film(cavitation, step):
    """The flows that carry heat balance the mass at every vertex of the unbroken film.

    1e-11 of the flow: the film's own accuracy.
    """
    model = make(FIELD, cavitation=cavitation)
    history, _ = run(model)
    evaluation = model.evaluate(MOTION, history if step else None, step)
    s, flows = model.solver, OilFlows(evaluation.film, 1.0)
    assert s.rho.max() > 1.02
    gain = flows.x - np.roll(flows.x, 1, axis=0) + flows.z + s.area * flows.rate
    gain[:, 1:] -= flows.z[:, :-1]
    inside = ~s.grid.fixed
    if not cavitation.conserves_mass:
        inside &= s.work.active
    if s.line is not None:
        # what appears at a line inside the cells
        gain -= np.where(s.line.s < 1.0, 0.5 * s.line.f * (1.0 - s.line.s) ** 2, 0.0)
    size = np.abs(flows.x).max()
    assert np.abs(gain[inside]).max() < 1e-11 * size
    if cavitation.conserves_mass:
        np.testing.assert_allclose(flows.outside[:, 1:-1], s.inflow()[:, 1:-1], atol=1e-12 * size)
        # what goes round in an end neither enters nor leaves; reported flows count the ends as full in time as well
        kept, ends = (s.area * flows.rate).sum(axis=0), flows.z.sum(axis=0)
        assert np.abs(gain - flows.outside)[:, [0, -1]].max() < 1e-11 * size
        assert flows.outside[:, 0].sum() == pytest.approx(ends[0] + kept[0], abs=1e-11 * size)
        assert flows.outside[:, -1].sum() == pytest.approx(kept[-1] - ends[-2], abs=1e-11 * size)
        if step:
            # the rate is that of the mass which the history keeps
            rate = (evaluation.history().mass - history.mass) / step
            np.testing.assert_allclose(flows.rate[:, 1:-1], rate[:, 1:-1], atol=1e-15 * s.H.max() / step)


def dissipation(film):
    """Heat of shear, and of the links' volume flows times their drop of pressure, W."""
    s, g, ratio = film.solver, film.grid, film.oil.ratio
    h, p, rho = s.H * C, film.oil.P * film.scales.pressure, s.rho
    mu = film.scales.pressure * C**2 / (12.0 * R**2) * (1.0 if ratio is None else ratio)
    shear = np.sum(mu * ((R * MOTION[8]) ** 2 + MOTION[9] ** 2) / h * film.share() * g.weight * R**2)
    q = s.pressure
    flow_x = s.system.kx * (np.roll(q, -1, 0) - q) / (0.5 * (np.roll(rho, -1, 0) + rho))
    flow_z = s.system.kz[:, :-1] * np.diff(q, axis=1) / (0.5 * (rho[:, 1:] + rho[:, :-1]))
    flow = np.sum(flow_x * (np.roll(p, -1, 0) - p)) + np.sum(flow_z * np.diff(p, axis=1))
    return float(shear + C * R**2 * flow)


@CLOSURE
def test_lumped_heat_is_the_dissipated_power(cavitation):
    """Power of the motion less the work on compressible oil.

    Second order in the grid, first where the rupture line is not resolved.

    High end pressures, so that the elastic energy counts: without it 4 % would be left on any grid.
    """
    left = []
    for n_theta, n_z in ((48, 8), (96, 16)):
        film = ehd.FiniteLength(n_theta=n_theta, n_z=n_z)
        model = make(LUMPED, SOFT, BARUS, cavitation=cavitation, film=film, end_pressures=(2e7, 1e7))
        made = model.evaluate(MOTION).film
        left.append(abs(heat_and_exchange(made, 1.0)[0] / dissipation(made) - 1.0))
    assert left[0] < 0.0065
    assert left[1] < 0.6 * left[0]


@pytest.mark.parametrize("law", [ehd.DowsonHigginson(), SOFT], ids=["oil", "soft"])
def test_lumped_heat_is_the_dissipated_power_while_the_film_is_compressed(law):
    """Films start flooded at ambient density.

    Without the energy that stays in the oil up to a sixth would be left on any grid.
    """
    left = []
    for n_theta, n_z in ((48, 8), (96, 16)):
        film = ehd.FiniteLength(n_theta=n_theta, n_z=n_z)
        model = make(LUMPED, law, BARUS, cavitation=CLOSURES[3], film=film)
        history, motion, worst = model.initial_history(MOTION), MOTION.copy(), 0.0
        for _ in range(6):
            motion[:4] += STEP * MOTION[4:8]
            evaluation = model.evaluate(motion, history, STEP)
            worst = max(worst, abs(heat_and_exchange(evaluation.film, 1.0)[0] / dissipation(evaluation.film) - 1.0))
            history = evaluation.history()
        left.append(worst)
    assert left[0] < 0.013  # as above
    assert left[1] < 0.5 * left[0]


def test_field_heat_is_the_dissipated_power():
    """Areas for the quadrature's weights, drops of the flow work for those of pressure: second order."""
    left = []
    for n_theta, n_z in ((48, 8), (96, 16)):
        model = make(FIELD, pressure_law=BARUS, film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z))
        made = model.evaluate(MOTION).film
        heat = model.effects.thermal.balance(made, made.temperature)["heat_in"]
        left.append(abs(heat / dissipation(made) - 1.0))
    assert left[0] < 0.002
    assert left[1] < 0.3 * left[0]


@THERMAL
@CLOSURE
def test_vanishing_compressibility_recovers_the_incompressible_film(thermal, cavitation):
    """Temperatures of a transient and of the settled film, with the first order in the coefficient."""
    plain, errors = make(thermal, None, cavitation=cavitation), []
    expected = run(plain)[0].temperature, settled_history(plain, REST).temperature
    for a in (5e-12, 5e-13):
        model = make(thermal, ehd.DowsonHigginson(coefficient=a), cavitation=cavitation)
        found = run(model)[0].temperature, settled_history(model, REST).temperature
        errors.append([np.abs(np.asarray(f) - e).max() for f, e in zip(found, expected, strict=True)])
    errors = np.array(errors)
    assert np.all(errors[0] < 2e-2)  # K
    assert np.all(errors[1] < 0.11 * errors[0])


@THERMAL
@CLOSURE
@PRESSURE
def test_tangent_is_exact(thermal, cavitation, pressure_law):
    """Largest difference to fourth-order central differences, relative to the rows, of several steps (moving rupture
    lines); 1e-6:
    differences of a film solved to 1e-14."""
    model = make(thermal, pressure_law=pressure_law, cavitation=cavitation)
    history, _ = run(model)
    warm = 15.0 + 5.0 * np.sin(model.grid.x)[:, None] * np.cos(model.grid.z)[None, :]
    history = dataclasses.replace(history, temperature=SUPPLY + (warm if thermal is FIELD else 15.0))
    assert tangent_error(model, MOTION, UNIT, history, STEP) < 1e-6


@CLOSURE
@PRESSURE
def test_viscosity_follows_the_temperature_whatever_was_evaluated_before(cavitation, pressure_law):
    """Lumped film, uniform field and an isothermal film of warm oil are one; 1e-11: the films' own accuracy."""
    isothermal = make(None, pressure_law=pressure_law, cavitation=cavitation)
    oil = isothermal.bearing.lubricant.at(340.0)
    warm = make(None, cavitation=cavitation, lubricant=oil).evaluate(MOTION).wrench
    lumped = make(LUMPED, pressure_law=pressure_law, cavitation=cavitation)
    field = make(FIELD, pressure_law=pressure_law, cavitation=cavitation)
    for model, ones in ((lumped, 1.0), (field, np.ones(field.grid.shape))):
        # the film at other temperatures before leaves a start for Newton's method, and pressures at which the law is
        # known
        for T in (300.0, 340.0, 350.0, 340.0):
            wrench = model.evaluate(MOTION, History(temperature=T * ones)).wrench
            if T == 340.0:
                np.testing.assert_allclose(wrench, warm, rtol=1e-11, atol=1e-11 * np.abs(warm).max())
