"""Laws of the oil, turbulence and shear thinning on one thrust face: closed forms, an independent film, tangents."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.film.thrust.face import FACE_SIZE, FaceFilm
from tests.film.thrust.test_face import CLOSURES, MU, PROFILES, RO, SCALE, C, _faces, _motion, extrapolated

RI, OMEGA = 0.5 * RO, 250.0
BARUS = ehd.BarusPressure(coefficient=1e-7)
ROELANDS = ehd.RoelandsPressure(coefficient=1.5e-7)
DENSE = ehd.DowsonHigginson(coefficient=2e-8, saturation=5e-8)
CARREAU = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.1)
# laws of a Lubricant, or turbulence; strong ones, whose effect on these films is far above every error
LAWS = {
    "barus": {"pressure_law": BARUS},
    "roelands": {"pressure_law": ROELANDS},
    "density": {"density_law": DENSE},
    "barus and density": {"pressure_law": BARUS, "density_law": DENSE},
    "carreau": {"shear_law": CARREAU},
    "carreau, barus and density": {"shear_law": CARREAU, "pressure_law": BARUS, "density_law": DENSE},
    "ng and pan": {"turbulence": ehd.NgPan(onset=2.0, full=6.0)},
    "hirs": {"turbulence": ehd.Hirs(onset=2.0, full=6.0, coefficient=5.0)},
}


def _film(faces=None, side=1, closure=None, pressures=(0.0, 0.0), turbulence=None, **laws):
    oil = ehd.Lubricant(viscosity=MU, **laws)
    return FaceFilm(faces or _faces(), side, closure or ehd.FullSommerfeld(), oil, pressures, True, turbulence)


def barus(q):
    return -np.log1p(-BARUS.coefficient * q) / BARUS.coefficient


def test_pressure_law_of_a_washer():
    """In q the washer is that of a constant viscosity: p = -ln(1 - alpha q) / alpha; between pressures and squeezed."""
    p_i, log = 5e6, math.log(RO / RI)
    q_i = -math.expm1(-BARUS.coefficient * p_i) / BARUS.coefficient
    film = _film(_faces(n_theta=16, n_r=24), pressures=(p_i, 0.0), pressure_law=BARUS)
    found = film.evaluate(_motion())
    force = quad(lambda r: barus(q_i * math.log(RO / r) / log) * 2 * math.pi * r, RI, RO)[0]
    assert found.wrench[2] == pytest.approx(force - 0.0, rel=2e-4)
    assert film.flows() == pytest.approx(2 * (math.pi * C**3 * q_i / (6 * MU * log),), rel=1e-12)
    # q = 3 mu v / h^3 (r_o^2 - r^2 - (r_o^2 - r_i^2) ln(r_o / r) / ln(r_o / r_i))
    speed = 0.015
    film = _film(_faces(n_theta=16, n_r=24), pressure_law=BARUS)
    found = film.evaluate(_motion(zeta_t=-speed))

    def q(r):
        return 3 * MU * speed / C**3 * (RO**2 - r**2 - (RO**2 - RI**2) * math.log(RO / r) / log)

    thick, thin = (quad(lambda r: p(q(r)) * 2 * math.pi * r, RI, RO)[0] for p in (barus, float))  # noqa: B023
    assert thick > 1.1 * thin
    assert found.wrench[2] == pytest.approx(thick, rel=2e-4)


def test_density_law_of_a_washer():
    """Mass flow of a washer between pressures: mu_0 q' = rho p' / mu, both laws by quadrature."""
    p_i, log = 5e6, math.log(RO / RI)
    film = _film(pressures=(p_i, 0.0), pressure_law=BARUS, density_law=DENSE)
    film.evaluate(_motion())
    q = quad(lambda p: float(DENSE.ratio(p) * np.exp(-BARUS.coefficient * p)), 0.0, p_i)[0]
    assert film.flows() == pytest.approx(2 * (math.pi * C**3 * q / (6 * MU * log),), rel=1e-9)


def _wedge():
    """Gap, rate and motion of a tilted collar that turns, sinks and tilts on."""
    b, b_t, sink = 0.6 * C / RO * np.array([math.cos(0.3), math.sin(0.3)]), np.array([0.03, -0.05]), 5e-4

    def gap(theta, r):
        return C - r * (b[0] * np.cos(theta) + b[1] * np.sin(theta))

    def rate(theta, r):
        return -sink - r * (b_t[0] * np.cos(theta) + b_t[1] * np.sin(theta))

    motion = _motion(bx=b[0], by=b[1], bx_t=b_t[0], by_t=b_t[1], omega=OMEGA, zeta_t=-sink)
    return gap, rate, motion, b


def _turbulent(h, r):
    """Factors k_x / 12, k_z / 12 and t of Hirs' law with n = 5 in `LAWS` at gaps and radii, as its module has them."""
    Re = 870.0 * OMEGA * r * h / MU
    s = np.clip((Re - 2.0) / 4.0, 0.0, 1.0)
    excess = np.array([f * 5.0 * 2**-0.75 * Re**0.75 - 1.0 for f in (1.75 / 12, 1 / 12, 0.25)])
    return 1.0 + s**3 * (10 - 15 * s + 6 * s**2) * 0.5 * (excess + np.hypot(excess, 0.04))


@pytest.mark.parametrize("closure", ("full", "swift"))
@pytest.mark.parametrize("case", ("barus", "barus and density", "hirs"))
def test_tilted_face_against_an_independent_film(case, closure):
    """Forces, moments and torque of the default grid, and how far they are from those of a plain film."""
    gap, rate, motion, b = _wedge()
    film = _film(_faces(n_r=14), closure=ehd.SwiftStieber() if closure == "swift" else None, **LAWS[case])
    found = film.evaluate(motion).wrench

    def oil(p):
        return np.exp(BARUS.coefficient * p), DENSE.ratio(p) if "density" in case else np.ones_like(p)

    law = {"turbulent": _turbulent} if case == "hirs" else {"oil": oil}
    grid = {"n": 64, "m": 16, "ri": RI, "clips": closure == "swift"}
    expected, plain = (extrapolated(gap, rate, OMEGA, **grid, **options) for options in (law, {}))
    for values in (expected, plain):
        values[3] -= b[0] * values[1] + b[1] * values[2]
    assert np.abs(expected / plain - 1.0).max() > 0.1
    assert found[2:] == pytest.approx(expected, rel=6e-3)


@pytest.mark.parametrize("law", (ehd.NgPan(onset=1.0, full=2.0), ehd.Hirs(onset=1.0, full=2.0, coefficient=5.0)))
def test_turbulent_torque_of_a_plane_face(law):
    """-int t(Re) mu omega r^2 / h dA with Re = rho omega r h / mu; laminar below the onset, bit by bit."""
    film = _film(turbulence=law)
    found = film.evaluate(_motion(zeta=0.3 * C, omega=OMEGA))
    h = 1.3 * C

    def t(r):
        Re = 870.0 * OMEGA * r * h / MU
        if isinstance(law, ehd.NgPan):
            return 1 + 0.0012 * Re**0.94
        excess = 5.0 * 2**-2.75 * Re**0.75 - 1.0
        return 1 + 0.5 * (excess + math.hypot(excess, 0.04))

    torque = -quad(lambda r: t(r) * MU * OMEGA * r**3 / h * 2 * math.pi, RI, RO)[0]
    assert found.wrench[5] == pytest.approx(torque, rel=1e-4)
    assert found.power_loss == pytest.approx(-torque * OMEGA, rel=1e-4)
    _, _, motion, _ = _wedge()
    laminar, slow = _film(), _film(turbulence=type(law)())
    assert np.array_equal(slow.evaluate(motion).wrench, laminar.evaluate(motion).wrench)
    assert slow.tangent() == pytest.approx(laminar.tangent(), rel=1e-9, abs=1e-9 * np.abs(laminar.tangent()).max())


def test_turbulence_begins_between_planes_that_slide():
    """By default at a local Reynolds number of 1440, whatever radius and clearance: first at the outer radius."""
    speeds = np.array([0.99, 1.2]) * 1440.0 * MU / (870.0 * RO * C)
    for speed, differs in zip(speeds, (False, True), strict=True):
        turbulent, laminar = (_film(turbulence=t).evaluate(_motion(omega=speed)).wrench[5] for t in (ehd.NgPan(), None))
        assert (abs(turbulent / laminar - 1.0) > 1e-9) == differs


def test_shear_thinning_of_a_plane_face():
    """Torque by the rate omega r / h, and a weak radial flow against the viscosity that the sliding leaves."""
    rate = lambda r: 3e3 * r / C  # noqa: E731
    film = _film(_faces(n_r=20), pressures=(1e3, 0.0), shear_law=CARREAU)
    found = film.evaluate(_motion(omega=3e3))
    torque = -quad(lambda r: CARREAU.ratio(rate(r)) * MU * 3e3 * r**3 / C * 2 * math.pi, RI, RO)[0]
    assert CARREAU.ratio(rate(RO)) < 0.7
    assert found.wrench[5] == pytest.approx(torque, rel=1e-4)
    resistance = quad(lambda r: 12 * MU * CARREAU.ratio(rate(r)) / (2 * math.pi * r * C**3), RI, RO)[0]
    assert film.flows() == pytest.approx(2 * (1e3 / resistance,), rel=1e-4)


def test_shear_thinning_of_a_squeezed_washer():
    """Without a turn the pressure flow thins: its gradient G, q = 2 int z gamma(G z) dz by radius, integrated."""
    speed, law = 0.3, ehd.CarreauShear(relaxation_time=1e-4, exponent=0.6, residual=0.1)

    def flow(G):
        def gamma(stress):
            return brentq(lambda g: MU * law.ratio(g) * g - stress, 0.0, 20.0 * stress / MU)

        return 2.0 * quad(lambda z: z * gamma(G * z), 0.0, 0.5 * C, epsrel=1e-9)[0]

    def gradient(q):
        return math.copysign(brentq(lambda G: flow(G) - abs(q), 0.0, 12.0 * MU * abs(q) / C**3 + 1.0), q) if q else 0.0

    r = np.linspace(RI, RO, 41)

    def pressures(peak):
        """Pressures of a flow that parts at the radius ``peak``, from the inner radius on, by Simpson's rule."""
        slope = np.array([-gradient(0.5 * speed * (x - peak**2 / x)) for x in r])
        middle = np.array([-gradient(0.5 * speed * (x - peak**2 / x)) for x in 0.5 * (r[1:] + r[:-1])])
        return np.append(0.0, np.cumsum(np.diff(r) / 6.0 * (slope[:-1] + 4.0 * middle + slope[1:])))

    peak = brentq(lambda x: pressures(x)[-1], RI + 1e-4, RO - 1e-4, xtol=1e-9)
    p = pressures(peak)
    weights = np.array([1, *[4, 2] * 19, 4, 1]) / 3.0 * np.diff(r)[0]
    force = float(weights @ (p * 2.0 * math.pi * r))
    found = _film(_faces(n_theta=16, n_r=24), shear_law=law).evaluate(_motion(zeta_t=-speed)).wrench[2]
    plain = _film(_faces(n_theta=16, n_r=24)).evaluate(_motion(zeta_t=-speed)).wrench[2]
    assert force < 0.7 * plain
    assert found == pytest.approx(force, rel=5e-3)


@pytest.mark.parametrize("profile", ("plane", pytest.param("taper", marks=pytest.mark.slow), "step"))
@pytest.mark.parametrize(
    "closure", ("full", "gumbel", pytest.param("gumbel_in_cells", marks=pytest.mark.slow), "swift", "swift_in_cells")
)
@pytest.mark.parametrize("case", LAWS)
def test_tangent_and_power(case, closure, profile):
    """Exact on random states, with and without a wall, both faces; the motion's power is ``power_loss``."""
    rng, seen = np.random.default_rng(7), 0
    for wall, side in ((None, 1), (ehd.RegularisedWall(onset=15e-6, pressure=1e7), -1)):
        faces = _faces(profile=PROFILES[profile], contact=wall, n_theta=40, n_r=6)
        film = _film(faces, side, CLOSURES[closure], (2e5, 0.0), **LAWS[case])
        for _ in range(2):
            motion = rng.uniform(-1, 1, FACE_SIZE) * SCALE * np.array([0.5, 0.3, 0.3, *[1.0] * 6])
            if wall is not None:
                motion[0] = -side * rng.uniform(0.6, 1.1) * C
            found = film.evaluate(motion)
            if found.status is not ehd.Status.CONVERGED:  # touching surfaces that leave no pressure
                assert "barus" in case or "roelands" in case
                continue
            seen += 1
            tangent, d = film.tangent() * SCALE, rng.normal(size=FACE_SIZE)
            errors = []
            for step in (1e-6, 1e-5, 1e-7):
                plus, minus = (film.evaluate(motion + k * step * d * SCALE).wrench for k in (1, -1))
                errors.append(np.abs(tangent @ d - (plus - minus) / (2 * step)) / np.abs(tangent).max(axis=1))
            assert np.nanmin(np.max(errors, axis=1)) < 1e-6
            if wall is None:
                _, bx, by, zeta_t, bx_t, by_t, omega, ux, uy = motion
                twist = np.array([ux, uy, zeta_t - bx * ux - by * uy, omega * bx - by_t, omega * by + bx_t, omega])
                assert -found.wrench @ twist == pytest.approx(found.power_loss, rel=1e-9)
    assert seen > 1


def test_viscosity_of_another_temperature():
    """A film with a ratio of its oil's viscosity is that of the other oil, and comes back."""
    _, _, motion, _ = _wedge()
    for case, laws in LAWS.items():
        if "roelands" in case:  # whose law depends on the viscosity at ambient pressure
            continue
        film, other = (
            _film(**laws),
            FaceFilm(
                _faces(),
                1,
                ehd.FullSommerfeld(),
                ehd.Lubricant(viscosity=0.7 * MU, **{k: v for k, v in laws.items() if k != "turbulence"}),
                (0.0, 0.0),
                True,
                laws.get("turbulence"),
            ),
        )
        first = film.evaluate(motion).wrench
        assert film.evaluate(motion, 0.7).wrench == pytest.approx(other.evaluate(motion).wrench, rel=1e-9)
        # Newton's method of a film that thins starts from the film before
        assert film.evaluate(motion).wrench == pytest.approx(first, rel=1e-10)


def test_no_pressure():
    """Behind the end of a pressure law there is a status, and forces that lead an iteration back."""
    film = _film(pressure_law=BARUS)
    found = film.evaluate(_motion(zeta=-0.6 * C, zeta_t=-0.2))
    assert found.status is ehd.Status.NO_PRESSURE
    assert found.wrench[2] > 1e3 and np.all(np.isfinite(film.tangent()))
