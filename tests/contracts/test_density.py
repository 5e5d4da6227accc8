"""A compressible film with every closure: exact tangent, incompressible limit,
oil mass, a solution, no cost when off."""

import dataclasses
import itertools

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant import density
from exudyn_ehd.joint.balance.limits import advice
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import covering_places
from tests.tangents import tangent_error

C, STEP = 25e-6, 1e-4
CLOSURES = [
    ehd.FullSommerfeld(),
    ehd.Gumbel(),
    ehd.SwiftStieber(),
    ehd.ElrodAdams(cavity_pressure=-1e5),
]
PRESSURE = [None, ehd.BarusPressure(coefficient=1e-8), ehd.RoelandsPressure(coefficient=2e-8)]
CARREAU = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)
DENSITY = ehd.DowsonHigginson()
# Ten times softer than oil, so that an error in the density's share of the tangent would show.
SOFT = ehd.DowsonHigginson(coefficient=3e-9, saturation=1.7e-9)
OILS = list(itertools.product((None, CARREAU), CLOSURES, PRESSURE, (DENSITY, SOFT)))
# Tilted, squeezing, sliding axially.
MOTION = np.array([11e-6, 5e-6, 1e-4, -1.5e-4, 3e-3, -2e-3, 0.05, 0.02, 250.0, 0.3])
UNIT = np.array([C, C, 1e-3, 1e-3, 5e-3, 5e-3, 0.2, 0.2, 300.0, 3.0])


def make(law=DENSITY, pressure=None, shear=None, cavitation=CLOSURES[2], **options):
    oil = ehd.Lubricant(viscosity=0.02, pressure_law=pressure, shear_law=shear, density_law=law)
    values = {
        "journal_radius": 0.025, "length": 0.05, "radial_clearance": C, "lubricant": oil, "cavitation": cavitation,
        "end_pressures": (1e5, 2e5), "film": ehd.FiniteLength(n_theta=48, n_z=8),
    }  # fmt: skip
    return build_model(ehd.JournalBearing(**(values | options)))


def start(model):
    """A history three steps after a flooded start."""
    history = model.initial_history(MOTION)
    for _ in range(3):
        evaluation = model.evaluate(MOTION, history, STEP)
        assert evaluation.status is ehd.Status.CONVERGED
        history = evaluation.history()
    return history


@pytest.mark.parametrize(
    ("shear", "cavitation", "pressure", "law"),
    [OILS[k] for k in covering_places(OILS)],
    ids=lambda x: "newton" if x is None else type(x).__name__,
)
def test_tangent_is_exact(law, pressure, shear, cavitation):
    """1e-6: differences of a film solved to 1e-14, over steps of 1e-4 to 1e-7. Every pair of options."""
    if law is SOFT and isinstance(pressure, ehd.RoelandsPressure):
        pressure = ehd.RoelandsPressure(coefficient=1e-8)  # with 2e-8 no pressure of the law's range carries this film
    model = make(law, pressure, shear, cavitation)
    assert tangent_error(model, MOTION, UNIT, start(model), STEP) < 1e-6
    if cavitation.conserves_mass:
        assert tangent_error(model, MOTION, UNIT, None, STEP) < 1e-6


@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
@pytest.mark.parametrize(
    "options",
    [
        {"squeeze": False},
        {"supply": (ehd.AxialGroove(angle=1.5, width_angle=0.3, length=0.03, pressure=3e5),)},
        {"contact": ehd.RegularisedWall(onset=15e-6)},
        {"roughness": ehd.PatirCheng(composite_roughness=2e-6)},
    ],
    ids=["no squeeze", "groove", "wall", "rough"],
)
def test_tangent_is_exact_with_other_options(options, cavitation):
    try:
        model = make(SOFT, PRESSURE[1], cavitation=cavitation, **options)
    except ehd.InputError:
        pytest.skip("refused without a density law, too")
    assert tangent_error(model, MOTION, UNIT, start(model), STEP) < 1e-6


@pytest.mark.parametrize("pressure", PRESSURE[:2], ids=["constant", "barus"])
def test_rates_at_an_instant_are_exact(pressure):
    """Columns of the rates and speeds from a cavitated history without a step, where full films squeeze at once."""
    model = make(SOFT, pressure, cavitation=CLOSURES[3])
    history = start(model)
    # An instant is 1e-7 of the time in which the film changes: rounding 1e-16 / 1e-7 of the rates.
    assert tangent_error(model, MOTION, UNIT, history, 0.0, columns=range(4, 8), limit=1e-5) < 1e-5


@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
def test_vanishing_coefficient_recovers_the_incompressible_film(cavitation):
    """The difference to the incompressible film is of first order in the coefficient."""
    plain = make(None, cavitation=cavitation).evaluate(MOTION).wrench
    errors = []
    for a in (1e-11, 1e-12):
        wrench = make(ehd.DowsonHigginson(coefficient=a), cavitation=cavitation).evaluate(MOTION).wrench
        errors.append(np.abs(wrench - plain).max() / np.abs(plain).max())
    assert errors[0] < 1e-3
    assert 9.0 < errors[0] / errors[1] < 11.0


@pytest.mark.parametrize("cavitation", CLOSURES[1:], ids=lambda c: type(c).__name__)
def test_oil_compressed_in_the_wedge_carries_more_behind_the_peak(cavitation):
    """Pure rotation: the load grows, and turns towards the minimum film thickness.

    To first order in the compressibility ``h^3 dp1/dx = p0 q0 - q1`` with the mass flow q: p1 falls where p0 is small
    and rises where it is large, so that pressure is lost before the peak and won behind it, where the film is thinner.
    The film that carries tension loses on one half what it wins on the other.
    """
    motion = np.where(np.arange(10) == 8, 250.0, np.where(np.arange(10) < 2, MOTION, 0.0))
    loads, angles = [], []
    for law in (SOFT, None):
        force = -make(law, cavitation=cavitation, end_pressures=(0.0, 0.0)).evaluate(motion).wrench[:2]
        loads.append(float(np.hypot(*force)))
        # towards the minimum film thickness, and a quarter of a turn before it
        angles.append(np.arctan2(motion[0] * force[1] - motion[1] * force[0], motion[:2] @ force))
    assert loads[0] > 1.005 * loads[1]
    assert angles[1] + 0.01 < angles[0] < 0.0


@pytest.mark.parametrize(
    "pressure", [*PRESSURE[:2], ehd.RoelandsPressure(coefficient=1e-8)], ids=["constant", "barus", "roelands"]
)
def test_oil_mass_is_conserved_over_a_transient(pressure):
    """Elrod-Adams, swinging journal: what enters is the change of ``rho fill h`` at every step and over all of them."""
    model = make(SOFT if pressure is None else DENSITY, pressure, cavitation=CLOSURES[3])
    motion, history = MOTION.copy(), model.initial_history(MOTION)
    first, total, scale, rho, fill = float(np.sum(model.solver.area * history.mass)), 0.0, 0.0, 1.0, 1.0
    for k in range(40):
        motion[:2] = MOTION[:2] + 2e-6 * np.sin(0.3 * k + np.array([0.0, 1.0])) - 2e-6 * np.sin([0.0, 1.0])
        evaluation = model.evaluate(motion, history, STEP)
        assert evaluation.status is ehd.Status.CONVERGED
        new, inflow = evaluation.history(), model.solver.inflow()
        change = float(np.sum(model.solver.area * (new.mass - history.mass))) / STEP
        assert abs(change - inflow.sum()) < 1e-10 * np.abs(inflow).sum()  # banded solution: rounding times its growth
        total += STEP * inflow.sum()
        scale += STEP * np.abs(inflow).sum()
        history = new
        rho, fill = max(rho, model.solver.rho.max()), min(fill, model.solver.fill.min())
    assert rho > 1.01 and fill < 0.99
    gain = float(np.sum(model.solver.area * history.mass)) - first
    assert abs(gain - total) < 1e-10 * scale


@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
def test_leakage_is_what_supplies_and_squeeze_leave(cavitation):
    """Mass flows at rest of the journal: nothing is stored, so that both ends together lose nothing."""
    model = make(cavitation=cavitation)
    still = MOTION.copy()
    still[4:8] = 0.0
    e = model.evaluate(still)
    if cavitation.conserves_mass or (not cavitation.clips and not np.isfinite(cavitation.cavity_pressure)):
        values = e.quantities()
        both = abs(values["leakage_lower"]) + abs(values["leakage_upper"])
        assert abs(values["leakage"]) < 1e-11 * both  # rounding


def random_motion(rng):
    motion = np.zeros(10)
    e, at = rng.uniform(0.0, 0.99), rng.uniform(0.0, 2.0 * np.pi)
    motion[:2] = e * C * np.array([np.cos(at), np.sin(at)])
    motion[2:4] = rng.uniform(-0.6, 0.6, 2) * (1.0 - e) * C / 0.025
    motion[4:6], motion[6:8] = rng.normal(0.0, 0.01, 2), rng.normal(0.0, 0.1, 2)
    motion[8:] = rng.uniform(-500.0, 500.0), rng.normal()
    return motion


@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
@pytest.mark.parametrize("pressure", PRESSURE, ids=lambda p: type(p).__name__)
def test_every_random_state_is_solved_or_beyond_the_law(pressure, cavitation):
    """Up to eccentricity ratio 0.99, tilted, squeezing, turning both ways: the only failure is oil beyond its law."""
    model, rng = make(pressure=pressure, cavitation=cavitation), np.random.default_rng(11)
    solved = 0
    for _ in range(40):
        motion = random_motion(rng)
        for history, step in ((None, 0.0), (model.initial_history(motion), STEP)):
            e = model.evaluate(motion, history, step)
            assert e.status in (ehd.Status.CONVERGED, ehd.Status.NO_PRESSURE)
            if e.status is ehd.Status.CONVERGED:
                solved += 1
                assert np.all(np.isfinite(e.wrench)) and np.all(np.isfinite(e.tangent()))
    assert solved > 30  # of 80: with Roelands' law and 2e-8 a rigid bearing carries up to some 0.5


def test_equilibrium_with_its_coefficients():
    """Stiffness and damping of a loaded bearing stay near the incompressible ones: 7 MPa compress oil by 0.4 %."""
    results = []
    for law in (DENSITY, None):
        bearing = dataclasses.replace(make(law, cavitation=CLOSURES[3]).bearing, end_pressures=(1e5, 1e5))
        results.append(ehd.equilibrium(bearing, speed=250.0, load=(0.0, -2000.0)))
    for name in ("stiffness", "damping"):
        soft, plain = (getattr(r, name) for r in results)
        np.testing.assert_allclose(soft[:2, :2], plain[:2, :2], atol=0.02 * np.abs(plain[:2, :2]).max())


@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
def test_absent_law_calls_nothing(cavitation, monkeypatch):
    """Its kernels and solver are forbidden, and the film's solver is the plain one."""

    def forbidden(*_, **__):
        raise AssertionError("an absent law was called")

    for name in [n for n in vars(density) if callable(getattr(density, n)) and not n[0].isupper() and n[0] != "_"]:
        if getattr(density, name).__module__.startswith("exudyn_ehd.film.lubricant.density"):
            monkeypatch.setattr(density, name, forbidden)
    for target in ("lubricant.density.DensityField.__init__", "lubricant.density.CompressibleLaw.__init__"):
        monkeypatch.setattr(f"exudyn_ehd.film.{target}", forbidden)
    model = make(None, cavitation=cavitation)
    history = start(model)
    evaluation = model.evaluate(MOTION, history, STEP)
    assert np.all(np.isfinite(evaluation.tangent()))
    assert model.effects.density is None and model.solver.law is None
    assert all(np.isfinite(v) for v in evaluation.quantities().values())


@pytest.mark.parametrize(
    ("options", "names"),
    [
        ({"film": ehd.ClassicSOR(), "cavitation": ehd.Gumbel()}, "ClassicSOR"),
        ({"film": ehd.ImpedanceMap()}, "ImpedanceMap"),
    ],
    ids=lambda o: o if isinstance(o, str) else "",
)
def test_what_takes_oil_as_incompressible_refuses_the_law(options, names):
    with pytest.raises(ehd.InputError, match=names):
        make(**({"end_pressures": (0.0, 0.0)} | options))


@pytest.mark.slow
def test_dense_films_pressed_together_fast_name_the_closure_that_holds_them():
    """A vertex's balance, of conductance h^3, falls with its pressure where rho dh/dt grows faster by its density.

    On vertices, between rough surfaces 130 nm apart at 7 mm/s; with the oil's account h drho/dt holds the pressure.
    """
    options = {
        "asperity": ehd.GreenwoodTripp(composite_roughness=3e-7, composite_modulus=2e10),
        "profile": (ehd.Crown(drop=3.6e-6), ehd.OutOfRound(order=2, amplitude=1.8e-6)),
        "roughness": ehd.PatirCheng(composite_roughness=3e-7),
        "end_pressures": (1e5, 3e4),
    }
    oil = ehd.Lubricant(
        viscosity=9.39746e-3,
        shear_law=ehd.CarreauShear(relaxation_time=2e-6, exponent=0.75, residual=0.3),
        density_law=ehd.DowsonHigginson(),
    )
    motion = np.array([4.11765859e-06, -3.40677614e-05, 0, 0, -6.87884831e-03, -7.43321587e-04, 0, 0, -298.130873, 0])

    def pressed(closure):
        made = ehd.JournalBearing(
            journal_radius=0.03,
            length=0.021,
            radial_clearance=36e-6,
            lubricant=oil,
            film=ehd.FiniteLength(n_theta=45, n_z=6),
            cavitation=closure,
            **options,
        )
        model = build_model(made)
        before = motion.copy()
        before[:4] -= 1e-5 * motion[4:8]
        return model.evaluate(motion, model.initial_history(before), 1e-5).status, made

    status, made = pressed(ehd.SwiftStieber(cavity_pressure=-5e4, line_in_cells=False))
    assert status is ehd.Status.NOT_CONVERGED
    assert "cavitation=ElrodAdams(...) counts it" in advice(status, made)
    assert (
        advice(status, dataclasses.replace(made, lubricant=dataclasses.replace(oil, density_law=None))) == status.advice
    )
    status, _ = pressed(ehd.ElrodAdams(cavity_pressure=-5e4))
    assert status is ehd.Status.CONVERGED
