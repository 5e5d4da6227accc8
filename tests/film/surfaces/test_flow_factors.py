"""Flow factors: tables against formulas, limits, derivatives, and the flow
through a sinusoidal roughness by its exact solution."""

import csv
import math
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

import exudyn_ehd as ehd
from exudyn_ehd.film.reynolds.links import link_flux
from exudyn_ehd.film.surfaces.roughness import (
    PATTERNS,
    SHEAR_CUTOFF,
    RoughFlow,
    average_gap_ratio,
    mean_inverse_gap,
    pressure_flow_factor,
    shear_flow_factor,
    shear_stress_factor,
)

DATA = Path(__file__).parents[2] / "validation" / "data"
CLEARANCE = 20e-6
SIGMA = 0.5e-6
# An effect on everything.
ANY = (SimpleNamespace(changes_carriers=True, depends_on_speed=True),)


def rough(pattern=1.0, share=0.5, residual=0.02):
    spec = ehd.PatirCheng(composite_roughness=SIGMA, pattern=pattern, journal_share=share)
    return RoughFlow(spec, CLEARANCE, residual)


def factors(t, pattern=1.0, share=0.5, residual=0.02):
    """phi_x, phi_z, shear carrier factors, each with its derivative by t, at average gaps t = h_T / sigma (k,)."""
    flow = rough(pattern, share, residual)
    gap = np.atleast_2d(t) * flow.sigma
    flux = link_flux(gap, ANY)
    for field in (flux.gx, flux.gz, flux.cx, flux.cz):
        field[:] = 1.0
    flux.cx_h[:] = flux.cz_h[:] = 0.0
    flow.apply(flux, gap, gap, 1.0, 1.0)
    names = ("gx", "gz", "cx", "cz")
    return {k: (getattr(flux, k)[0], getattr(flux, k + "_h")[0] * flow.sigma) for k in names}


@pytest.mark.parametrize("pattern", PATTERNS)
def test_pressure_flow_over_the_fits_range(pattern):
    """phi h_T^3 = phi_x h^3; 2e-4 of the table's interpolation, next to a kink where the extrapolation starts."""
    H = np.concatenate((np.linspace(PATTERNS[pattern][2] + 0.01, 12.0, 500), np.geomspace(12.0, 300.0, 50)))
    t = average_gap_ratio(H, 0.02)
    found = factors(t, pattern)
    np.testing.assert_allclose(found["gx"][0], pressure_flow_factor(H, pattern) * H**3 / t**3, rtol=2e-4)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_flow_across_is_flow_along_the_inverse_pattern(pattern):
    t = np.geomspace(0.1, 100.0, 40)
    np.testing.assert_array_equal(factors(t, pattern)["gz"][0], factors(t, 1.0 / pattern)["gx"][0])


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("share", [0.0, 1.0])
def test_shear_flow_over_the_fits_range(pattern, share):
    """Carrier h_T + sigma phi_s; the fit itself jumps by 1e-4 at H = 5."""
    H = np.linspace(PATTERNS[pattern][2] + 0.01, 30.0, 700)
    t = average_gap_ratio(H, 0.02)
    carrier = factors(t, pattern, share)["cx"][0] * t
    np.testing.assert_allclose(carrier - t, (2 * share - 1) * shear_flow_factor(H, pattern), atol=2e-4)


def test_equally_rough_surfaces_have_no_shear_flow():
    for value, slope in (factors(np.geomspace(0.1, 50, 20))[k] for k in ("cx", "cz")):
        assert np.all(value == 1.0) and not slope.any()


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("share", [0.0, 1.0])
def test_all_factors_stay_positive_and_smooth(pattern, share):
    """Factors and derivatives from the thinnest film to smooth films, against central differences.

    Differences of step 1e-5 t of a cubic spline are good to 1e-6 of the slope's scale away from its knots.
    """
    t = np.geomspace(0.02, 1e3, 400)
    found = factors(t, pattern, share)
    step = 1e-5 * t
    upper, lower = factors(t + step, pattern, share), factors(t - step, pattern, share)
    for name, (value, slope) in found.items():
        assert value.min() > 0.0, name
        difference = (upper[name][0] - lower[name][0]) / (2 * step)
        np.testing.assert_allclose(slope * t, difference * t, atol=2e-6 * max(1.0, np.abs(slope * t).max()))


@pytest.mark.parametrize("share", [0.5, 0.8])
@pytest.mark.parametrize("slope", [0.0, 0.03])
def test_one_pass_is_the_plain_film_times_its_factors(share, slope):
    """Aligned and tilted gaps, into buffers that an effect of another step has
    used; 1e-14: rounding of products in another order."""
    flow = rough(3.0, share)
    column = np.linspace(0.05, 1.9, 7)[:, None]
    H, HF = column + slope * np.arange(5.0), 1.1 * column - slope * np.arange(5.0)
    z = np.column_stack((0.5 * (H[:, 1:] + H[:, :-1]), H[:, -1]))
    flux, expected = link_flux(HF, ANY), link_flux(HF, ANY)
    for field in (flux.cx, flux.cz_h, flux.gx_v):
        field[:] = 7.0
    expected.gx[:], expected.gx_h[:], expected.gz[:], expected.gz_h[:] = HF**3, 3 * HF**2, z**3, 3 * z**2
    expected.cx[:], expected.cz[:] = HF, z
    flow.apply(expected, HF, z, 1.0, 1.0)
    flow.start(flux, H, 1.0, 1.0)
    np.testing.assert_allclose(flux.gap_z, z, rtol=1e-15)
    for name in ("gx", "gx_h", "gx_v", "gz", "gz_h", "gz_v", "cx", "cx_h", "cz", "cz_h"):
        np.testing.assert_allclose(getattr(flux, name), getattr(expected, name), rtol=1e-14, err_msg=name)


def test_smooth_surfaces_are_the_limit():
    """Isotropic: 1 - 0.9 exp(-0.56 H), below 1e-9 at H = 40."""
    found = factors(np.array([40.0, 100.0, 1e4]))
    np.testing.assert_allclose(found["gx"][0], 1.0, atol=1e-8)


def test_friction_factor_is_the_mean_inverse_gap_and_the_drag_of_ripples():
    """h_T E[1 / gap] over gaps above sigma / 100 by quadrature, 5e-5 of the
    table's interpolation; plus Phi_fs h_T / h within its range."""
    shear = rough()
    H = np.array([-1.0, 0.0, 0.3, 1.0, 2.0, 3.0, 5.0, 12.0, 40.0])
    t = average_gap_ratio(H, 0.02)
    exact = [
        quad(lambda s, h=h: norm.pdf(s - h) / s, SHEAR_CUTOFF, max(h, 0) + 12, points=[max(h, 0.05)], limit=400)[0]
        for h in H
    ]
    np.testing.assert_allclose(mean_inverse_gap(H), exact, rtol=1e-5)
    gap = (t * shear.sigma)[None]
    ratio, ratio_h, ratio_v = (np.empty(gap.shape) for _ in range(3))
    shear.factor(gap, 1.0, ratio, ratio_h, ratio_v)
    fit = H > 0.5
    drag = shear_stress_factor(H[fit], 1.0) * t[fit] / H[fit]
    np.testing.assert_allclose(ratio[0][fit], t[fit] * np.array(exact)[fit] + drag, rtol=5e-5, atol=1e-4)
    assert np.all(ratio[0][~fit] > t[~fit] * np.array(exact)[~fit])
    assert not ratio_v.any()


def test_friction_factor_far_from_contact():
    """1 + (sigma/h)^2 + 3 (sigma/h)^4 for a narrow distribution, whose first terms any symmetric one shares."""
    H = 20.0
    assert mean_inverse_gap(np.array([H]))[0] * H == pytest.approx(1 + H**-2 + 3 * H**-4, abs=3e-7)


def test_shear_stress_factor_of_the_isotropic_pattern():
    """11.1 H^2.31 exp(-2.38 H + 0.11 H^2), written out; one tangent at the end of its range."""
    for H in (0.5, 1.0, 3.0, 6.5):
        expected = 11.1 * math.exp(2.31 * math.log(H) - 2.38 * H + 0.11 * H * H)
        assert shear_stress_factor(np.array([H]), 1.0)[0] == pytest.approx(expected, rel=1e-12)
    below, at, above = shear_stress_factor(np.array([7.0 - 1e-4, 7.0, 7.0 + 1e-4]), 1.0)
    assert at - below == pytest.approx(above - at, rel=1e-3)
    assert shear_stress_factor(np.array([1e3]), 1.0)[0] < 1e-9


@pytest.mark.parametrize("pattern", PATTERNS)
def test_friction_factors_agree_with_the_flow_factors(pattern):
    """Small roughness of any pattern has Phi_fs = Phi_s / H = 1 - phi_fp to second order in 1 / H, and
    phi_fp H = H - Phi_s by reciprocity (a surface that drags oil along is pushed by the pressure that drives it). The
    three are fits to separate simulations: they differ by up to 22 % for Phi_fs at H = 4 (below H = 3 each has
    higher orders of its own), and by 2.3 % of H between Phi_s and the published phi_fp = 1 - D exp(-s H)."""
    with open(DATA / "patir_cheng_flow_factors.csv", encoding="utf-8") as file:
        rows = {round(float(Fraction(r["gamma"])), 6): r for r in csv.DictReader(file)}
    D, s = (float(rows[round(pattern, 6)][k]) for k in ("D_phifp", "s_phifp"))
    H = np.array([4.0])
    flow, stress = shear_flow_factor(H, pattern) / H, shear_stress_factor(H, pattern)
    np.testing.assert_allclose(stress, flow, rtol=0.25)
    H = np.linspace(2.0, 6.0, 9)
    np.testing.assert_allclose(1.0 - D * np.exp(-s * H), 1.0 - shear_flow_factor(H, pattern) / H, atol=0.025)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 1.0])
def test_tangential_force_of_ridges_across_the_motion(share):
    """1 + 4 v of the smooth film's, v = (sigma / h)^2, however the roughness is
    shared between the moving and the resting surface.

    Reynolds' equation of two sinusoidal surfaces, averaged over their relative position: shear plus pressure
    on the slopes of the resting surface. Amplitudes of 1 % leave terms of the order 1e-8 against v = 1e-4 / 2.
    """
    x = np.linspace(0.0, 2.0 * np.pi, 256, endpoint=False)
    moving, resting = 0.01 * math.sqrt(share), 0.01 * math.sqrt(1.0 - share)
    total = 0.0
    for phase in x[::16]:
        a, b = moving * np.cos(x - phase), resting * np.cos(x)
        h = 1.0 + a + b
        # units mu = U = 1: h^3 dp/dx / 12 = flow h / 2 - moving surface's a - constant, without mean pressure gradient
        driven = 0.5 * h - a
        constant = np.mean(driven / h**3) / np.mean(1.0 / h**3)
        p_x = 12.0 * (driven - constant) / h**3
        # resting surface at z = -b with the film above it: shear 1 / h - h p_x / 2 and p db/dx, summed by parts
        total += np.mean(1.0 / h - 0.5 * h * p_x + b * p_x) / 16.0
    assert total == pytest.approx(1.0 + 4.0 * 0.5 * 1e-4, abs=2e-8)


def test_lay_decides_the_direction_of_easy_flow():
    """Ridges along the motion ease the flow along it, ridges across hinder it; for
    parallel ridges the exact limits are E[h^3] / h^3 and 1 / (h^3 E[h^-3])."""
    H = 3.0
    along, isotropic, across = (pressure_flow_factor(H, g) for g in (9.0, 1.0, 1 / 9))
    assert 1 + 3 / H**2 > along > 1.0 > isotropic > across > 0.0


@pytest.mark.parametrize(
    ("option", "value"), [("pattern", 2.0), ("composite_roughness", -1e-6), ("journal_share", 1.5)]
)
def test_refused_values(option, value):
    with pytest.raises(ehd.InputError, match=rf"PatirCheng\.{option}"):
        ehd.PatirCheng(**({"composite_roughness": 1e-6} | {option: value}))


def test_patterns_may_be_written_with_three_digits():
    assert math.isclose(factors(np.array([3.0]), 0.3333)["gx"][0][0], factors(np.array([3.0]), 1 / 3)["gx"][0][0])
