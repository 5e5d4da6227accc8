"""Walls that take the film's heat: their balance with the film, a reference of another kind, growth, mixing."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import root
from scipy.special import i0, i1

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

R, L, C, SUPPLY, MU, BETA, OMEGA, K_OIL = 0.025, 0.05, 25e-6, 320.0, 0.02, 0.03, 300.0, 0.13
LAW = ehd.ReynoldsTemperature(point=(SUPPLY, MU), coefficient=BETA)
OIL = ehd.Lubricant(temperature_law=LAW, temperature=SUPPLY, density=870.0, specific_heat=2000.0)
BUSH = ehd.Conduction(thickness=0.02, conductance=2.0, ambient_temperature=300.0)
JOURNAL = ehd.Conduction(thickness=R, conductance=1.0, ambient_temperature=305.0)
GROOVE = (ehd.AxialGroove(angle=2.5, width_angle=0.3, length=0.03, pressure=1e5),)
# Of the largest term; the equations close to rounding, the flows carry about 1e-11.
BALANCE = 1e-9


def energy(**options):
    return ehd.FilmEnergy(**({"supply_temperature": SUPPLY, "conductivity": K_OIL} | options))


def bearing(thermal, **options):
    known = {"journal_radius": R, "length": L, "radial_clearance": C, "lubricant": OIL, "thermal": thermal}
    return ehd.JournalBearing(**(known | options))


def motion(eccentricity=0.6, **rates):
    out = np.zeros(10)
    out[0], out[4], out[5], out[8] = eccentricity * C, rates.get("vx", 0.0), rates.get("vy", 0.0), OMEGA
    return out


def defect(b):
    """Error of the heat balance of film and walls, over its largest term."""
    whole = b["heat_in"] - b["convected"] - b["conducted"] - b["stored"]
    return abs(whole) / max(abs(v) for v in b.values())


WALLS = {
    "both": {"bush": BUSH, "journal": JOURNAL},
    "bush": {"bush": BUSH, "journal_coefficient": 2e3, "journal_temperature": 330.0},
    "bush alone": {"bush": BUSH},
    "journal": {"journal": JOURNAL, "bush_coefficient": 5e3},
    "adiabatic": {
        "bush": BUSH,
        "journal": ehd.Conduction(thickness=0.01, conductance=0.0, expansion=5e-6, initial_temperature=310.0),
        "carry_over": 0.7,
    },
}


KEEPING = {"swift": ehd.SwiftStieber(), "elrod": ehd.ElrodAdams(cavity_pressure=-1e5)}


# each pair of walls with one of the closures by default
@pytest.mark.parametrize(("closure", "names"), sample(itertools.product(KEEPING, WALLS), 0, 6, 2, 8, 4))
def test_balance_over_steps_and_at_rest(names, closure):
    """Heat in = convected + given off by the walls + stored in film and walls, in the walls too."""
    film = ehd.FiniteLength(n_theta=48, n_z=8)
    model = build_model(bearing(energy(**WALLS[names]), cavitation=KEEPING[closure], supply=GROOVE, film=film))
    at, thermal = motion(vx=2e-3, vy=-3e-3), model.effects.thermal
    history = model.initial_history(at)
    for step in (1e-4, 1e-4, 1e-2, 3.0, 3.0):
        evaluation = model.evaluate(at, history, step)
        new = evaluation.history()
        assert defect(thermal.balance(evaluation.film, new.temperature)) < BALANCE
        history = new
    at = motion()
    settled = settled_history(model, at)
    balance = thermal.balance(model.evaluate(at, settled).film, settled.temperature)
    assert balance["stored"] == 0.0
    assert defect(balance) < BALANCE
    if names == "adiabatic":
        assert abs(balance["journal"]) < BALANCE * balance["heat_in"]


def _reference(eccentricity, n=96):
    """Long bearing by Fourier collocation, its bush by exact harmonics of the annulus, its journal by Bessel functions.

    Per length, with a film without cavities. Returns temperature, bore and journal, K.
    """
    theta = 2.0 * math.pi / n * np.arange(n)
    order = np.fft.fftfreq(n, 1.0 / n)

    def derivative(f):
        return np.fft.ifft(1j * order * np.fft.fft(f)).real

    def bore_heat(b):
        """Heat per area into the bore, W/m2, of the annulus with a convecting outer surface."""
        far, U = R + BUSH.thickness, BUSH.conductance / (2.0 * math.pi * (R + BUSH.thickness) * L)
        s, k = far / R, BUSH.conductivity
        p = np.abs(order)
        with np.errstate(divide="ignore", invalid="ignore"):
            # T = a rho^p + (1 - a) rho^-p for a unit at the bore
            above, below = (k * p / far + U) * s**p, (U - k * p / far) * s**-p
            a = -below / (above - below)
            slope = k * p / R * (1.0 - 2.0 * a)
        slope[0] = 1.0 / (R * (math.log(s) / k + 1.0 / (U * far)))
        return np.fft.ifft(slope * np.fft.fft(b - BUSH.ambient_temperature)).real

    m = math.sqrt(JOURNAL.conductance / (math.pi * R**2 * L) / JOURNAL.conductivity)
    journal = JOURNAL.conductivity * m * i1(m * R) / i0(m * R)  # W/(m2 K)
    h = C * (1.0 - eccentricity * np.cos(theta))
    U, capacity = R * OMEGA, OIL.density * OIL.specific_heat

    def state(T):
        mu = MU * np.exp(-BETA * (T - SUPPLY))
        q = 0.5 * U * np.mean(mu / h**2) / np.mean(mu / h**3)
        gradient = 12.0 * mu / h**3 * (0.5 * U * h - q)
        return q, mu * U**2 / h + h**3 / (12.0 * mu) * gradient**2

    def residual(x):
        T, b, s = x[:n], x[n : 2 * n], x[-1]
        q, heat = state(T)
        to_bush, to_journal = K_OIL / h * (6.0 * T - 4.0 * b - 2.0 * s), K_OIL / h * (6.0 * T - 4.0 * s - 2.0 * b)
        film = capacity * q * derivative(T) / R - heat + to_bush + to_journal
        wall = to_bush - bore_heat(b)
        return np.concatenate((film / 1e5, wall / 1e5, [np.mean(to_journal) / 1e5 - journal * (s - 305.0) / 1e5]))

    found = root(residual, np.full(2 * n + 1, 350.0), tol=1e-12)
    assert np.abs(found.fun).max() < 1e-8
    return found.x[:n], found.x[n : 2 * n], found.x[-1]


def test_film_and_walls_against_a_reference_of_another_kind():
    """Temperatures of film, bore and journal: 0.5 % of what they vary by around the film.

    The error is of first order, as the film begins at the inlet by upwinding.
    """
    T, b, s = _reference(0.8)
    assert np.ptp(T) > 1.2 and np.ptp(b) > 2.9 and np.mean(T) > SUPPLY + 50.0
    walls, errors = {"bush": dataclasses.replace(BUSH, rings=16), "journal": JOURNAL}, []
    for n in (96, 192):
        film = ehd.LongBearing(n_theta=n)
        whole = bearing(energy(**walls), film=film, cavitation=ehd.FullSommerfeld(), inlet=ehd.MaximumGap())
        result = ehd.steady(whole, speed=OMEGA, eccentricity_ratio=0.8)
        # this film's grid begins at the largest gap
        got = result.temperature[:: n // 96, 1] - np.roll(T, -48), result.walls.bush[:: n // 96, 0] - np.roll(b, -48)
        errors.append([float(np.abs(e).max()) for e in got])
        assert abs(result.walls.journal[0] - s) < 1e-3
    assert errors[0][0] < 0.005 * np.ptp(T) and errors[0][1] < 0.005 * np.ptp(b)
    assert np.all(np.divide(*errors) > 2.0)


@pytest.mark.slow
def test_the_end_of_a_transient_is_the_steady_state():
    bush = ehd.Conduction(
        thickness=1e-3, conductance=20.0, expansion=1.2e-5, clearance_temperature=310.0, density=400.0
    )
    model = build_model(
        bearing(energy(bush=bush, journal=bush), end_pressures=(1e5, 4e5), film=ehd.FiniteLength(n_theta=24, n_z=4))
    )
    at = motion(0.5)
    history = model.initial_history(at)
    for step in (
        *np.full(40, 0.2),
        *np.full(300, 2e-3),
    ):  # long ones first: short ones have the limiter of a steady film
        history = model.evaluate(at, history, step).history()
    np.testing.assert_allclose(history.temperature, settled_history(model, at).temperature, atol=1e-5)


@pytest.mark.slow
def test_walls_that_give_their_heat_off_are_walls_of_a_given_temperature():
    """Excess over that film falls like 1 / conductivity and conductance of the walls."""
    given = energy(bush_coefficient=1e12, bush_temperature=315.0, journal_coefficient=1e12, journal_temperature=325.0)
    fixed = ehd.steady(bearing(given), speed=OMEGA, eccentricity_ratio=0.6).temperature
    errors = []
    for size in (1e4, 1e5):
        bush = ehd.Conduction(thickness=0.02, conductance=size, conductivity=size, ambient_temperature=315.0)
        journal = dataclasses.replace(bush, ambient_temperature=325.0)
        film = ehd.steady(bearing(energy(bush=bush, journal=journal)), speed=OMEGA, eccentricity_ratio=0.6)
        errors.append(np.abs(film.temperature - fixed).max())
    assert errors[1] < 0.03
    assert 9.0 < errors[0] / errors[1] < 11.0


def _free_growth(inner, outer, T, expansion, at):
    """Displacement of a free disc by its equilibrium, u'' + u'/r - u/r^2 = (1 + nu) alpha T', by scipy; at a radius."""
    nu = 0.3
    slope = lambda r: (T(r + 1e-6) - T(r - 1e-6)) / 2e-6  # noqa: E731
    r = np.linspace(inner, outer, 50)
    rates = lambda r, y: [y[1], (1.0 + nu) * expansion * slope(r) - y[1] / r + y[0] / r**2]  # noqa: E731
    stress = lambda y, r: y[1] + nu * y[0] / r - (1.0 + nu) * expansion * T(r)  # noqa: E731
    ends = lambda a, b: [stress(a, inner), stress(b, outer)]  # noqa: E731
    return float(solve_bvp(rates, ends, r, np.zeros((2, r.size)), tol=1e-8).sol(at)[0])


def test_growth_is_that_of_free_walls_in_equilibrium():
    """The growth is that of an elastic disc with the steady radial profiles, to the rings' second order."""
    expansion, cold = 1.2e-5, 300.0
    walls = {
        "bush": dataclasses.replace(BUSH, expansion=expansion, clearance_temperature=cold, rings=16),
        "journal": ehd.Conduction(
            thickness=0.015, conductance=60.0, expansion=expansion, clearance_temperature=cold, rings=16
        ),
    }
    walls["bush"] = dataclasses.replace(walls["bush"], conductance=60.0)
    film = ehd.steady(bearing(energy(**walls)), speed=OMEGA, eccentricity_ratio=0.6)
    assert np.ptp(film.walls.bush.mean(axis=0)) > 1.0
    assert np.ptp(film.walls.journal) > 0.1

    def rise(radii, T):
        order = np.argsort(radii)
        return lambda r: np.interp(r, radii[order], T[order]) - cold

    bush = _free_growth(R, R + 0.02, rise(film.walls.bush_radii, film.walls.bush.mean(axis=0)), expansion, R)
    journal = _free_growth(0.01, R, rise(film.walls.journal_radii, film.walls.journal), expansion, R)
    assert abs(bush - journal) > 0.3e-6
    assert film.walls.clearance - C == pytest.approx(bush - journal, rel=5e-3)


@pytest.mark.parametrize(
    "cavitation", [ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)], ids=["swift", "elrod"]
)
def test_a_grown_film_is_that_of_the_changed_clearance(cavitation):
    walls = {"bush": BUSH, "journal": JOURNAL}
    grows = {k: dataclasses.replace(w, expansion=e) for (k, w), e in zip(walls.items(), (0.8e-5, 1.2e-5), strict=True)}
    film = ehd.steady(bearing(energy(**grows), cavitation=cavitation), speed=OMEGA, eccentricity_ratio=0.6)
    c = film.walls.clearance
    assert c < 0.9 * C
    by_hand = bearing(energy(**walls), cavitation=cavitation, radial_clearance=c)
    same = ehd.steady(by_hand, speed=OMEGA, eccentricity_ratio=0.6 * C / c)
    # settled to 1e-11; scaled by another clearance
    np.testing.assert_allclose(film.force, same.force, rtol=1e-7, atol=1e-7 * np.abs(same.force).max())
    np.testing.assert_allclose(film.temperature, same.temperature, rtol=1e-9)
    assert film.minimum_gap == pytest.approx(same.minimum_gap, rel=1e-3)  # of the grid's vertices


def test_oil_is_kept_while_the_walls_grow():
    """A film that conserves mass holds the oil that flows have brought, also when growth narrows the gap."""
    walls = {"bush": BUSH, "journal": dataclasses.replace(JOURNAL, density=200.0, expansion=1.2e-5)}
    model = build_model(bearing(energy(**walls), cavitation=ehd.ElrodAdams(cavity_pressure=-1e5)))
    at, thermal, missing = motion(0.5), model.effects.thermal, []
    history = model.initial_history(at)
    for _ in range(30):
        evaluation = model.evaluate(at, history, 1e-2)
        new = evaluation.history()
        content = model.solver.H - new.void
        missing.append(float(np.sum((new.mass - content) * model.solver.area)))
        history = new
    assert thermal.opening(history.temperature) < -0.02 * C
    assert np.abs(missing).max() < 1e-10


GROWING = {
    "walls that warm up": {"thermal": {"initial_temperature": None}},
    "a bush that cools": {"thermal": {"initial_temperature": 350.0}},
    "wear": {
        "asperity": ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=1.1e11),
        "wear": ehd.ArchardWear(wear_rate=1e-14),
    },
}


@pytest.mark.parametrize("name", GROWING)
def test_short_steps_after_growth(name):
    """While the gap grows, forces of a step that gets shorter tend to those of the long step, and to the instant's.

    The bush that cools changes the force by 0.6 % in the next long step.
    """
    options, thin = dict(GROWING[name]), name == "wear"
    if "thermal" in options:
        bush = ehd.Conduction(thickness=0.005, conductance=1.0, expansion=1e-5, **options["thermal"])
        options["thermal"] = energy(bush=bush)
    else:
        options["thermal"] = None
    keeps = ehd.ElrodAdams(cavity_pressure=-1e5)
    model = build_model(bearing(**options, cavitation=keeps, film=ehd.FiniteLength(n_theta=48, n_z=6)))
    at = motion(0.965 if thin else 0.6)
    history = model.initial_history(at)
    for _ in range(60):
        found = model.evaluate(at, history, 2.5e-4)
        history = found.history()
    assert np.abs(history.growth).max() > 0.0
    force = found.wrench[:2]
    for step in (2.5e-4, 1e-6, 1e-9, 0.0):
        np.testing.assert_allclose(model.evaluate(at, history, step).wrench[:2], force, atol=1e-2 * np.hypot(*force))


def test_carry_over_at_a_groove():
    """Oil that passes a groove which feeds nothing leaves it with that share of its rise."""
    groove, found = (ehd.AxialGroove(angle=2.5, width_angle=0.05, pressure=0.0),), []
    for share in (1.0, 0.5, 0.25):
        film = ehd.LongBearing(n_theta=96)
        b = bearing(energy(bush=BUSH, carry_over=share), film=film, cavitation=ehd.FullSommerfeld(), supply=groove)
        model = build_model(b)
        history = settled_history(model, motion(0.0))
        solved = model.evaluate(motion(0.0), history).film
        T, mask = solved.temperature.mean(axis=1) - SUPPLY, model.parts.supply.masks[0].any(axis=1)
        i = int(np.flatnonzero(mask)[0])
        balance = model.effects.thermal.balance(solved, history.temperature)
        assert defect(balance) < BALANCE
        found.append(T[i] / T[i - 1])
    # concentric: the groove feeds nothing; the heat of its own column adds a hundredth
    np.testing.assert_allclose(found, [1.0, 0.5, 0.25], atol=0.03)


@pytest.mark.slow
def test_carry_over_of_the_cavity():
    """Half Sommerfeld's film loses oil where it ends and begins with it: without, the whole film is colder."""
    means = []
    for share in (1.0, 0.5, 1e-9):
        b = bearing(energy(bush=BUSH, carry_over=share), cavitation=ehd.Gumbel())
        model = build_model(b)
        history = settled_history(model, motion(0.8))
        assert (
            defect(model.effects.thermal.balance(model.evaluate(motion(0.8), history).film, history.temperature))
            < BALANCE
        )
        means.append(float(history.temperature.mean()))
    assert means[0] > means[1] + 0.5 > means[2] + 1.0


def test_what_is_refused():
    with pytest.raises(ehd.InputError, match="exclude each other"):
        energy(bush=BUSH, bush_coefficient=10.0)
    with pytest.raises(ehd.InputError, match=r"needs the oil's conductivity"):
        ehd.FilmEnergy(supply_temperature=SUPPLY, journal=JOURNAL)
    with pytest.raises(ehd.InputError, match="thicker than the journal"):
        build_model(bearing(energy(journal=dataclasses.replace(JOURNAL, thickness=0.03))))
    with pytest.raises(ehd.InputError, match=r"Conduction\.rings"):
        dataclasses.replace(BUSH, rings=1)
    with pytest.raises(ehd.InputError, match=r"FilmEnergy\.bush must be Conduction"):
        energy(bush=2.0)
    with pytest.raises(ehd.InputError, match=r"FilmEnergy\.carry_over"):
        energy(carry_over=0.0)
    with pytest.raises(ehd.InputError, match="turbulence"):
        bearing(energy(bush=BUSH), turbulence=ehd.NgPan())
    with pytest.raises(ehd.FilmError, match="no way out"):
        shut = dataclasses.replace(JOURNAL, conductance=0.0)
        ehd.steady(bearing(energy(journal=shut)), speed=OMEGA, eccentricity_ratio=0.0)
