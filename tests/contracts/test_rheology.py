"""Contract of every law and pair of laws: exact tangent, recovery of the constant law, no cost when absent."""

import dataclasses
import itertools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.cavitation.closures import place_line
from exudyn_ehd.film.lubricant import pressure_viscosity as viscosity
from exudyn_ehd.film.reynolds import links
from exudyn_ehd.film.solvers import film as solver
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.effects import Effects
from tests.sampling import covering
from tests.tangents import tangent_error

C = 25e-6
WALTHER = ehd.WaltherTemperature(first=(313.15, 23e-6), second=(373.15, 5e-6))
OIL = ehd.Lubricant(viscosity=0.02, temperature_law=WALTHER, temperature=325.0)
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)]
PRESSURE = [None, ehd.BarusPressure(coefficient=1e-8), ehd.RoelandsPressure(coefficient=2e-8)]
SHEAR = [None, ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)]
THERMAL = [None, ehd.LumpedThermal(supply_temperature=330.0), ehd.FilmEnergy(supply_temperature=330.0)]
MOTION = np.array(
    [11e-6, 5e-6, 1e-4, -1.5e-4, 3e-3, -2e-3, 0.05, 0.02, 250.0, 0.3]
)  # tilted, squeezing, sliding axially
UNIT = np.array([C, C, 1e-3, 1e-3, 5e-3, 5e-3, 0.2, 0.2, 300.0, 3.0])
STEP = 1e-4


def make(pressure=None, shear=None, thermal=None, cavitation=ehd.SwiftStieber(), **options):  # noqa: B008
    oil = dataclasses.replace(OIL, pressure_law=pressure, shear_law=shear)
    values = {
        "journal_radius": 0.025,
        "length": 0.05,
        "radial_clearance": C,
        "lubricant": oil,
        "thermal": thermal,
        "cavitation": cavitation,
        "end_pressures": (1e5, 2e5),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
    }
    return build_model(ehd.JournalBearing(**(values | options)))


def start(model):
    """A history with a temperature field that varies, three steps after a flooded start."""
    history = model.initial_history(MOTION)
    if history is not None and isinstance(history.temperature, np.ndarray):
        field = 330.0 + 20.0 * np.random.default_rng(0).random(model.grid.shape)
        history = dataclasses.replace(history, temperature=field)
    for _ in range(3):
        evaluation = model.evaluate(MOTION, history, STEP)
        assert evaluation.status is ehd.Status.CONVERGED
        history = evaluation.history()
    return history


@pytest.mark.parametrize(
    ("pressure", "shear", "thermal", "cavitation"),
    covering(itertools.product(PRESSURE, SHEAR, THERMAL, CLOSURES)),
    ids=lambda value: type(value).__name__,
)
def test_tangent_is_exact(pressure, shear, thermal, cavitation):
    """Against central differences; several steps, because a rupture line that
    moves within one spoils the difference."""
    model = make(pressure, shear, thermal, cavitation)
    assert tangent_error(model, MOTION, UNIT, start(model), STEP) < 1e-6


@pytest.mark.parametrize("laws", [PRESSURE[1:2] + SHEAR[1:], PRESSURE[2:] + SHEAR[1:]], ids=["barus", "roelands"])
def test_tangent_is_exact_where_a_wall_limits_the_gap(laws):
    model = make(*laws, contact=ehd.RegularisedWall(onset=20e-6))
    assert tangent_error(model, MOTION, UNIT, None, STEP, sizes=(1e-5, 1e-6, 1e-4)) < 1e-6


def constant_limit(law, amplitudes):
    plain = make().evaluate(MOTION).wrench
    return [
        float(np.abs(make(**law(a)).evaluate(MOTION).wrench - plain).max() / np.abs(plain).max()) for a in amplitudes
    ]


@pytest.mark.parametrize(
    ("law", "amplitudes", "order"),
    [
        (lambda a: {"pressure": ehd.BarusPressure(coefficient=a)}, (1e-11, 1e-12), 1),
        (lambda a: {"pressure": ehd.RoelandsPressure(coefficient=a)}, (1e-11, 1e-12), 1),
        (lambda a: {"shear": ehd.CarreauShear(relaxation_time=a, exponent=0.6)}, (1e-9, 1e-10), 2),
    ],
    ids=["barus", "roelands", "carreau"],
)
def test_vanishing_coefficient_recovers_the_constant_law(law, amplitudes, order):
    """The difference falls with the law's own order in its coefficient."""
    errors = constant_limit(law, amplitudes)
    assert errors[0] < 1e-3
    assert 0.9 * 10**order < errors[0] / errors[1] < 1.1 * 10**order


def test_newtonian_exponent_is_the_constant_law():
    plain, thin = (
        make().evaluate(MOTION),
        make(shear=ehd.CarreauShear(relaxation_time=1e-6, exponent=1.0)).evaluate(MOTION),
    )
    np.testing.assert_allclose(
        thin.wrench, plain.wrench, rtol=1e-12, atol=1e-12 * np.abs(plain.wrench).max()
    )  # other kernels


@pytest.mark.parametrize("thermal", THERMAL[1:], ids=["lumped", "field"])
def test_constant_viscosity_makes_the_temperature_irrelevant(thermal):
    law = ehd.ReynoldsTemperature(point=(325.0, 0.02), coefficient=0.0)
    oil = ehd.Lubricant(temperature_law=law, temperature=325.0)
    hot = make(thermal=thermal, lubricant=oil).evaluate(MOTION)
    plain = make(lubricant=ehd.Lubricant(viscosity=0.02)).evaluate(MOTION)
    np.testing.assert_allclose(
        hot.wrench, plain.wrench, rtol=1e-12, atol=1e-12 * np.abs(plain.wrench).max()
    )  # other kernels


def test_thicker_under_pressure_and_thinner_in_shear():
    plain, barus, carreau = (make(**o).evaluate(MOTION) for o in ({}, {"pressure": PRESSURE[1]}, {"shear": SHEAR[1]}))
    loads = [float(np.hypot(*e.wrench[:2])) for e in (plain, barus, carreau)]
    assert loads[1] > 1.01 * loads[0] > loads[0] > 1.01 * loads[2]


@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
def test_absent_laws_change_no_bit_and_call_nothing(cavitation, monkeypatch):
    """A bearing without laws gives the bits of a model built without effects, with every kernel of the laws forbidden.

    A temperature law alone changes nothing either: without a thermal effect the film has the lubricant's temperature.
    """
    cavitation = place_line(cavitation, False)
    expected = make(cavitation=cavitation, lubricant=ehd.Lubricant(viscosity=0.02))
    bare = type(expected)(expected.bearing, effects=Effects())

    def forbidden(*_):
        raise AssertionError("an absent law was called")

    for module, names in (
        (links, ("plain_flux",)),
        (solver, ("link_flux",)),
        (viscosity, ("law_fields",)),
    ):
        for name in names:
            monkeypatch.setattr(module, name, forbidden)
    for target in ("shear_thinning.ShearThinning.apply", "shear_thinning.ShearThinning.factor"):
        monkeypatch.setattr(f"exudyn_ehd.film.lubricant.{target}", forbidden)
    for target in (
        "heat.temperature.OilTemperature.viscosity_ratio",
        "heat.temperature.heat_and_exchange",
        "newton.Acceleration.step",
    ):
        monkeypatch.setattr(f"exudyn_ehd.joint.{target}", forbidden)
    for model in (expected, make(cavitation=cavitation)):
        history, other = bare.initial_history(MOTION), model.initial_history(MOTION)
        bare.forget()
        for _ in range(3):
            a, b = bare.evaluate(MOTION, history, STEP), model.evaluate(MOTION, other, STEP)
            np.testing.assert_array_equal(a.wrench, b.wrench)
            np.testing.assert_array_equal(a.tangent(), b.tangent())
            assert a.quantities() == b.quantities()
            history, other = a.history(), b.history()
            assert (history is None) == (other is None)
    assert ehd.steady(expected.bearing, speed=100.0, eccentricity_ratio=0.5).temperature is None


def test_plain_lubricant_leaves_every_seam_empty():
    model = make(lubricant=ehd.Lubricant(viscosity=0.02))
    assert model.effects == Effects()
    assert model.solver.flux is None


@pytest.mark.parametrize(
    ("pressure", "shear", "thermal"),
    covering(list(itertools.product(PRESSURE, SHEAR, THERMAL))[1:]),
    ids=lambda value: type(value).__name__,
)
def test_mass_is_conserved(pressure, shear, thermal):
    """Elrod-Adams: the oil that enters equals the change of the content at every step, whatever the laws."""
    model = make(pressure, shear, thermal, CLOSURES[3])
    history = start(model)
    for _ in range(3):
        new, area = model.evaluate(MOTION, history, STEP).history(), model.solver.area
        change = float(np.sum(area * (new.mass - history.mass))) / STEP
        inflow = model.solver.inflow()
        assert abs(change - inflow.sum()) < 1e-10 * np.abs(inflow).sum()  # banded solution: rounding times its growth
        history = new


@pytest.mark.parametrize("speed", [0.0, -250.0, 250.0])
@pytest.mark.parametrize("eccentricity", [0.0, 0.5, 0.95])
def test_finite_over_the_range_of_states(speed, eccentricity):
    for laws in itertools.product((PRESSURE[2],), SHEAR, THERMAL):
        model = make(*laws)
        at = np.zeros(10)
        at[0], at[8] = eccentricity * C, speed
        e = model.evaluate(at, model.initial_history(at), STEP)
        assert e.status in (ehd.Status.CONVERGED, ehd.Status.NO_PRESSURE)
        if e.status is ehd.Status.CONVERGED:
            assert np.all(np.isfinite(e.wrench)) and np.all(np.isfinite(e.tangent()))
            assert e.history() is None or np.all(np.isfinite(e.history().temperature))


def test_no_pressure_in_a_bearing_is_a_status():
    """Loads are those of a law continued in a line, with their exact tangent, by which Newton's method returns."""
    far = make(pressure=ehd.BarusPressure(coefficient=1e-5)).evaluate(MOTION)
    assert far.status is ehd.Status.NO_PRESSURE
    assert np.all(np.isfinite(far.wrench)) and np.all(np.isfinite(far.tangent()))
    # as large as it may be: solvers measure what they leave by it
    assert far.film.oil.P.max() * far.film.scales.pressure == pytest.approx(10.0 * math.log(1e7) / 1e-5)
    model = make(pressure=ehd.BarusPressure(coefficient=1.02 / make().evaluate(MOTION).quantities()["peak_pressure"]))
    e = model.evaluate(MOTION)
    assert e.status is ehd.Status.NO_PRESSURE
    tangent = e.tangent()
    for k, h in ((0, 1e-12), (4, 1e-7)):
        ends = [model.evaluate(MOTION + sign * h * np.eye(10)[k]) for sign in (1.0, -1.0)]
        assert all(end.status is ehd.Status.NO_PRESSURE for end in ends)
        difference = (ends[0].wrench - ends[1].wrench) / (2.0 * h)
        np.testing.assert_allclose(tangent[:2, k], difference[:2], rtol=1e-5)
    with pytest.raises(ehd.FilmError, match="NO_PRESSURE"):
        ehd.steady(far.model.bearing, speed=MOTION[8], eccentricity_ratio=0.5)


@pytest.mark.parametrize(
    ("cavitation", "coefficient"),
    [
        (ehd.SwiftStieber(), 1e-8),
        (ehd.Gumbel(), 1e-8),
        (ehd.FullSommerfeld(), 1e-8),
        (ehd.ElrodAdams(cavity_pressure=-1e5), 1.5e-8),  # its film here is steady, without the pressure of the squeeze
    ],
    ids=["swift", "gumbel", "full", "elrod"],
)
def test_density_near_the_end_of_the_pressure_law(cavitation, coefficient):
    """Barus' transformed pressure (1 - exp(-alpha p)) / alpha ends at 1/alpha; an
    orbit brings films of constant density beyond it and compressible ones near.

    The density's slope has no bound there, and whole Newton steps bounce back and forth across
    the end. From the last state or from nothing, every state is found within 64 linear solves,
    with the same force; the tangent is exact (central differences, 1e-6 of the clearance).
    """
    R, C, speed = 0.02, 20e-6, 300.0
    laws = {"pressure_law": ehd.BarusPressure(coefficient=coefficient), "density_law": ehd.DowsonHigginson()}
    options = {
        "journal_radius": R,
        "length": 0.03,
        "radial_clearance": C,
        "film": ehd.FiniteLength(n_theta=96, n_z=10),
        "cavitation": cavitation,
    }
    model = build_model(ehd.JournalBearing(lubricant=ehd.Lubricant(viscosity=0.03, **laws), **options))
    cold = build_model(ehd.JournalBearing(lubricant=ehd.Lubricant(viscosity=0.03, **laws), **options))
    peaks = []
    for k in np.radians(np.arange(10, 28, 2)):
        e = C * (0.85 + 0.05 * np.sin(5 * k))
        v = 0.3 * speed * e
        motion = np.array([e * np.cos(k), e * np.sin(k), 0, 0, -v * np.sin(k), v * np.cos(k), 0, 0, speed, 0])
        found = model.evaluate(motion)
        cold.forget()
        again = cold.evaluate(motion)
        assert found.status is again.status is ehd.Status.CONVERGED
        assert max(found.iterations, again.iterations) <= 64
        peaks.append(found.quantities()["peak_pressure"])
        # at alpha p = 12 the density's slope, exp(alpha p), is 2e5 times that
        # at ambient pressure and magnifies what Newton leaves
        near = coefficient * peaks[-1] < 9.0
        np.testing.assert_allclose(again.wrench[:2], found.wrench[:2], rtol=1e-8 if near else 1e-6)
    assert 1.0 - np.exp(-coefficient * max(peaks)) > 0.97
    tangent = found.tangent()[:2, :2]
    h = 1e-6 * C
    for j in range(2):
        step = h * np.eye(10)[j]
        slope = (cold.evaluate(motion + step).wrench - cold.evaluate(motion - step).wrench)[:2] / (2.0 * h)
        np.testing.assert_allclose(tangent[:, j], slope, atol=1e-5 * np.abs(tangent).max())
