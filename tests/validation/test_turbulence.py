"""Turbulent films against the theory behind their fits, against Hirs' wall stresses, and against quadratures of the
long and the short bearing by another program."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import quad

import exudyn_ehd as ehd

R, L, C, SPEED, DENSITY = 0.05, 0.06, 1e-4, 800.0, 1000.0
KARMAN, BUFFER = 0.4, 10.7


def reichardt(friction_reynolds):
    """Re, k_x, k_z and t of the turbulent Couette flow by Reichardt's eddy viscosity, disturbed by small gradients.

    ``1 + kappa (y+ - d tanh(y+ / d))`` times the viscosity at y+ = y sqrt(|tau| rho) / mu from the nearer wall; the
    stress tau is that of the Couette flow and the gradient's together, so that a gradient along the sliding changes the
    eddies as well. Ng and Pan's fits approximate these integrals.
    """
    s = np.linspace(0.0, 1.0, 40001)
    y = 0.5 * np.expm1(9.0 * s) / np.expm1(9.0)
    plus = y * friction_reynolds
    bend = np.tanh(plus / BUFFER)
    eddy = 1.0 + KARMAN * (plus - BUFFER * bend)
    by_stress = 0.5 * KARMAN * plus * bend**2

    def both(f):
        return 2.0 * np.trapezoid(f, y)

    flow = (y - 0.5) ** 2
    across = both(1.0 / eddy)
    return (
        friction_reynolds**2 * across,
        1.0 / both(flow * (eddy - by_stress) / eddy**2),
        1.0 / both(flow / eddy),
        1.0 / across,
    )


def ng_pan(Re):
    return 12.0 + 0.0136 * Re**0.9, 12.0 + 0.0043 * Re**0.96, 1.0 + 0.0012 * Re**0.94


def hirs(Re, n=0.066, m=-0.25):
    """k_x, k_z and t from differences of the wall stresses about half the sliding speed."""

    def stress(u, w=0.0):
        V = math.hypot(u, w)
        return 0.5 * n * Re * V * u * (Re * V) ** m, 0.5 * n * Re * V * w * (Re * V) ** m

    d = 1e-5
    along = (stress(0.5 + d)[0] - stress(0.5 - d)[0]) / d
    across = (stress(0.5, d)[1] - stress(0.5, -d)[1]) / d
    return along, across, stress(0.5)[0]


def blended(law, Re):
    """The factors that a film of `NgPan` or `Hirs` has."""
    onset, full = law.transition(R, C)
    s = min(max((Re - onset) / (full - onset), 0.0), 1.0)
    w = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    out = []
    for k, laminar in zip((ng_pan if isinstance(law, ehd.NgPan) else hirs)(max(Re, 1e-3)), (12.0, 12.0, 1.0)):
        more = k / laminar - 1.0
        if isinstance(law, ehd.Hirs):
            more = 0.5 * (more + math.sqrt(more**2 + 0.04**2))
        out.append(laminar * (1.0 + w * more))
    return out


def bearing(viscosity, **options):
    oil = ehd.Lubricant(viscosity=viscosity, density=DENSITY)
    return ehd.JournalBearing(journal_radius=R, length=L, radial_clearance=C, lubricant=oil, **options)


def reynolds(viscosity):
    return DENSITY * SPEED * R * C / viscosity


def test_fits_lie_within_six_percent_of_the_theory():
    found = [reichardt(h) for h in np.geomspace(55.0, 800.0, 60)]
    assert found[0][0] < 1500.0 and found[-1][0] > 30000.0
    for Re, *factors in found:
        if 1500.0 <= Re <= 30000.0:
            assert np.allclose(ng_pan(Re), factors, rtol=0.06 if Re < 15000.0 else 0.12)


def test_theory_is_laminar_at_rest():
    assert reichardt(0.01)[1:] == pytest.approx((12.0, 12.0, 1.0), rel=1e-3)


def test_hirs_constants_are_those_of_the_literature():
    Re = 1e4
    assert hirs(Re) == pytest.approx((0.0687 * Re**0.75, 0.0392 * Re**0.75, 0.00981 * Re**0.75), rel=2e-3)


LAWS = (ehd.NgPan(), ehd.Hirs(), ehd.NgPan(onset=500.0, full=900.0), ehd.Hirs(onset=4000.0, full=4500.0))


@pytest.mark.parametrize("law", LAWS, ids=str)
@pytest.mark.parametrize("viscosity", [1e-3, 3e-4])
@pytest.mark.parametrize("eps", [0.3, 0.6, 0.8])
def test_long_bearing_by_quadrature(law, viscosity, eps):
    """A full ring, p' = k mu (U h / 2 - q) / h^3 with the flow q that closes it; load, torque and both signs."""
    mu, U, Re = viscosity, SPEED * R, reynolds(viscosity)

    def gap(a):
        return C * (1.0 + eps * math.cos(a))

    def factors(a):
        return blended(law, Re * gap(a) / C)

    # theta from the largest gap; the blend has kinks of its third derivative only
    def integral(f):
        return quad(f, 0.0, math.pi, epsabs=0.0, epsrel=1e-9, limit=400)[0]

    one, two = (integral(lambda a, n=n: factors(a)[0] / gap(a) ** n) for n in (2, 3))
    q = 0.5 * U * one / two

    def slope(a):
        return R * factors(a)[0] * mu * (0.5 * U * gap(a) - q) / gap(a) ** 3

    # load across the line of centres: int p sin = int p' cos, twice the half ring
    load = 2.0 * R * L * integral(lambda a: slope(a) * math.cos(a))
    torque = 2.0 * R**2 * L * integral(lambda a: factors(a)[2] * mu * U / gap(a) + 0.5 * gap(a) * slope(a) / R)
    film = bearing(mu, film=ehd.LongBearing(), cavitation=ehd.FullSommerfeld(), inlet=ehd.MaximumGap(), turbulence=law)
    for speed in (SPEED, -SPEED):
        found = ehd.steady(film, speed=speed, eccentricity_ratio=eps)
        assert np.hypot(*found.force[:2]) == pytest.approx(abs(load), rel=3e-3)
        assert found.power_loss == pytest.approx(torque * SPEED, rel=3e-3)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_short_bearing_by_quadrature(law):
    """p = k_z mu U h' (z^2 - L^2 / 4) / (4 R h^3) where that is positive."""
    mu, U, eps = 5e-4, SPEED * R, 0.6

    def push(a):
        h = C * (1.0 + eps * math.cos(a))
        k = blended(law, reynolds(mu) * h / C)[1]
        return k * mu * U * C * eps * math.sin(a) / (4.0 * R * h**3) * L**3 / 6.0 * R

    x, y = (quad(lambda a, f=f: push(a) * f(a), 0.0, math.pi, epsrel=1e-9, limit=400)[0] for f in (math.cos, math.sin))
    found = ehd.steady(bearing(mu, film=ehd.ShortBearing(), turbulence=law), speed=SPEED, eccentricity_ratio=eps)
    assert np.hypot(*found.force[:2]) == pytest.approx(math.hypot(x, y), rel=3e-3)


def test_below_the_onset_the_film_is_the_laminar_one():
    plain, law = (bearing(1e-3, turbulence=t) for t in (None, ehd.NgPan(onset=1e5)))
    a, b = (ehd.steady(x, speed=SPEED, eccentricity_ratio=0.7) for x in (plain, law))
    assert a.force == pytest.approx(b.force, rel=1e-12) and a.power_loss == pytest.approx(b.power_loss, rel=1e-12)


HOT = ehd.Lubricant(
    density=DENSITY, temperature=320.0, temperature_law=ehd.ReynoldsTemperature(point=(320.0, 1e-3), coefficient=0.02)
)


def test_lumped_heat_sees_the_viscosity_that_it_makes():
    """Reynolds number and scales follow the temperature: the film is the isothermal one at that temperature."""
    hot = dataclasses.replace(
        bearing(1e-3), lubricant=HOT, turbulence=ehd.NgPan(), thermal=ehd.LumpedThermal(supply_temperature=320.0)
    )
    film = ehd.steady(hot, speed=SPEED, eccentricity_ratio=0.6)
    T = float(film.temperature)
    assert T > 321.0
    same = ehd.steady(dataclasses.replace(hot, lubricant=HOT.at(T), thermal=None), speed=SPEED, eccentricity_ratio=0.6)
    assert film.force == pytest.approx(same.force, rel=1e-7, abs=1e-6)
    assert film.power_loss == pytest.approx(same.power_loss, rel=1e-7)


def test_a_temperature_field_thins_the_reynolds_number_too():
    """Walls that hold the film at one temperature: the isothermal film there."""
    walls = ehd.FilmEnergy(
        supply_temperature=320.0, bush_temperature=350.0, journal_temperature=350.0, bush_coefficient=1e12,
        journal_coefficient=1e12,
    )  # fmt: skip
    hot = dataclasses.replace(bearing(1e-3), lubricant=HOT, turbulence=ehd.Hirs(), thermal=walls)
    film = ehd.steady(hot, speed=SPEED, eccentricity_ratio=0.6)
    same = ehd.steady(
        dataclasses.replace(hot, lubricant=HOT.at(350.0), thermal=None), speed=SPEED, eccentricity_ratio=0.6
    )
    assert film.force == pytest.approx(same.force, rel=1e-5, abs=1e-3)


@pytest.mark.slow
def test_equilibrium_tangent_and_audit():
    laminar, turbulent = (bearing(5e-4, turbulence=t) for t in (None, ehd.NgPan()))
    rest = [ehd.equilibrium(b, load=(0.0, -2000.0), speed=SPEED) for b in (laminar, turbulent)]
    assert rest[1].eccentricity_ratio < 0.95 * rest[0].eccentricity_ratio
    assert rest[1].film.power_loss > 2.0 * rest[0].film.power_loss
    row = rest[0].film.audit()["turbulence"]
    assert row.matters and row.on is False and "turbulence=NgPan()" in row.advice
    # what the row says it changes, done and measured
    assert row.change.power_loss == pytest.approx(rest[1].film.power_loss / rest[0].film.power_loss - 1.0, rel=0.01)
    followed = rest[1].film.audit()
    assert followed["turbulence"].on and followed["turbulence"].matters and not followed["Taylor vortices"].advice
    assert rest[0].film.audit().improved(laminar).turbulence == ehd.NgPan()
    oily = ehd.steady(bearing(0.05, turbulence=ehd.NgPan()), speed=SPEED, eccentricity_ratio=0.6).audit()
    assert oily["turbulence"].unneeded


@pytest.mark.slow
def test_advice_on_what_does_not_go_together_can_be_followed():
    """A law of the oil does not pass for turbulence, nor is offered where the film is turbulent."""
    law = ehd.RoelandsPressure(coefficient=2e-8)
    # Re = 400: laminar, and the law matters
    thick = ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=5e-5,
        lubricant=ehd.Lubricant(viscosity=5e-3, density=DENSITY, pressure_law=law),
    )
    audit = ehd.steady(thick, speed=SPEED, eccentricity_ratio=0.8).audit()
    assert audit["piezoviscosity"].matters and not audit["turbulence"].matters
    # Re = 20000 there: both matter, neither is switched on beside the other
    thin = dataclasses.replace(thick.lubricant, viscosity=1e-4)
    for bearing_, row in (
        (dataclasses.replace(thick, lubricant=thin), "turbulence"),
        (
            dataclasses.replace(
                thick,
                lubricant=dataclasses.replace(thick.lubricant, pressure_law=None),
                turbulence=ehd.NgPan(onset=50.0),
            ),
            "piezoviscosity",
        ),
    ):
        audit = ehd.steady(bearing_, speed=SPEED, eccentricity_ratio=0.8).audit()
        assert audit[row].matters and "does not go with Lubricant.pressure_law" in audit[row].advice
        assert audit[row].remedy is None
        audit.improved(bearing_)


@pytest.mark.parametrize("law", [{"onset": -1.0}, {"full": 0.0}, {"onset": 900.0, "full": 800.0}, {"onset": math.nan}])
@pytest.mark.parametrize("kind", [ehd.NgPan, ehd.Hirs])
def test_wrong_transitions_are_refused(kind, law):
    with pytest.raises(ehd.InputError, match=r"(onset|full)"):
        kind(**law)


@pytest.mark.parametrize(
    ("other", "name"),
    [
        (
            {"lubricant": ehd.Lubricant(viscosity=1e-3, pressure_law=ehd.BarusPressure(coefficient=1e-8))},
            "pressure_law",
        ),
        ({"lubricant": ehd.Lubricant(viscosity=1e-3, density_law=ehd.DowsonHigginson())}, "density_law"),
        ({"roughness": ehd.PatirCheng(composite_roughness=1e-6)}, "roughness"),
        (
            {
                "thermal": ehd.FilmEnergy(supply_temperature=320.0, bush_coefficient=1e4, conductivity=0.6),
                "lubricant": ehd.Lubricant(
                    temperature_law=ehd.ReynoldsTemperature(point=(320.0, 1e-3), coefficient=0.02), temperature=320.0
                ),
            },
            "conductivity",
        ),
        ({"film": ehd.ImpedanceMap()}, "turbulence"),
        ({"film": ehd.ClassicSOR(), "cavitation": ehd.Gumbel()}, "turbulence"),
    ],
)
def test_what_has_no_turbulent_form_is_refused(other, name):
    with pytest.raises(ehd.InputError, match=name):
        ehd.steady(
            dataclasses.replace(bearing(1e-3), **other, turbulence=ehd.NgPan()), speed=1.0, eccentricity_ratio=0.5
        )
