"""Gümbel's condition inside the cells: continuous derivatives, of order two."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.film.cavitation.test_rupture_line import _coefficients
from tests.reference import short_bearing
from tests.sampling import but_slow

C, R = 25e-6, 0.025
CELLS = ehd.Gumbel(line_in_cells=True)
BELOW = ehd.Gumbel(cavity_pressure=-3e4, cavity_shear=0.3, line_in_cells=True)
THIN = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7)
OPTIONS = {
    "ends": {"end_pressures": (1e5, 3e4)},
    "short": {"film": ehd.ShortBearing(n_theta=48, n_z=8)},
    "long": {
        "film": ehd.LongBearing(n_theta=64, n_z=4),
        "supply": (ehd.AxialGroove(angle=1.0, width_angle=0.2, pressure=1e5),),
    },
    "piezoviscous": {
        "lubricant": ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=1e-8)),
    },
    "compressible": {
        "lubricant": ehd.Lubricant(
            viscosity=0.02,
            pressure_law=ehd.BarusPressure(coefficient=1e-8),
            density_law=ehd.DowsonHigginson(coefficient=5e-9),
        )
    },
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=2e-6, journal_share=0.9)},
    "thin": {"lubricant": ehd.Lubricant(viscosity=0.02, shear_law=THIN)},
    "groove": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, length=0.03, pressure=2e5),)},
}


@pytest.mark.parametrize("name", but_slow(OPTIONS, "compressible", "thin"))
def test_tangent_is_the_derivative(make_bearing, name):
    """Random states, none of which lies at a kink: there is none."""
    rng = np.random.default_rng(2)
    bearing = make_bearing(1.0, cavitation=BELOW, **{"film": ehd.FiniteLength(n_theta=48, n_z=8)} | OPTIONS[name])
    model, probe = build_model(bearing), build_model(bearing)
    scale = 0.1 * np.array([C, C, C / R, C / R, 100 * C, 100 * C, 100 * C / R, 100 * C / R, 100.0, 1.0])
    for _ in range(8):
        e, (a, b) = rng.uniform(0.1, 0.9), rng.uniform(0.0, 2.0 * np.pi, 2)
        tilt = 0.0 if name == "long" else 0.4 * (1.0 - e) * C / R
        place = np.array([C * e * np.cos(a), C * e * np.sin(a), tilt * np.cos(b), tilt * np.sin(b)])
        rates = 30.0 * C * rng.normal(size=4) * [1.0, 1.0, 1.0 / R, 1.0 / R] * (name != "long")
        motion = np.concatenate((place, rates, (rng.choice([-100.0, 300.0]), 0.0)))
        tangent, numeric = model.evaluate(motion).tangent() * scale, np.empty((6, 10))
        for k in range(10):
            step = 1e-5 * scale[k] * np.eye(10)[k]
            w = [probe.evaluate(motion + at * step).wrench for at in (-2, -1, 1, 2)]
            numeric[:, k] = (8.0 * (w[2] - w[1]) - (w[3] - w[0])) / 12e-5
        rows = np.abs(tangent).max(axis=1)
        rows[rows < 1e-9 * rows.max()] = np.inf
        assert (np.abs(tangent - numeric) / rows[:, None]).max() < 1e-7


@pytest.mark.parametrize("eccentricity", (0.3, 0.6))
def test_short_bearing_against_its_closed_form(eccentricity, measured):
    """Stiffness and damping in 16 directions: order two, where clipped vertices are of order one."""
    expected = np.ravel((short_bearing.stiffness(eccentricity), short_bearing.damping(eccentricity)))
    directions, errors = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False) + 0.0123, {}
    for closure in (CELLS, ehd.Gumbel()):
        for n in (48, 96):
            film = ehd.ShortBearing(n_theta=n, n_z=40)
            where = directions + np.arange(16) * 0.7 * np.pi / n
            got, _ = _coefficients(film, 0.25, eccentricity, where, closure)
            # whose damping is made dimensionless by the spin, twice the mean speed of the surfaces
            got[:, 4:] *= 2.0
            errors[closure, n] = np.abs(np.abs(got) - np.abs(expected)).max() / np.abs(expected).max()
    assert errors[CELLS, 48] > 3.3 * errors[CELLS, 96]
    measured("line in cells", errors[CELLS, 96], 0.01)
    assert errors[ehd.Gumbel(), 96] > 5.0 * errors[CELLS, 96]


@pytest.mark.slow
def test_stiffness_of_thinning_oil_is_of_second_order(measured):
    """Against 1152 columns, for any place of the line in its cell; clipped vertices are of the first order."""
    errors = {}
    for a in np.random.default_rng(5).uniform(-0.4, 0.4, 4):
        motion, found = np.zeros(10), {}
        motion[:2], motion[8] = 0.7 * C * np.array([np.cos(a), np.sin(a)]), 200.0
        for n, closure in ((1152, CELLS), (48, CELLS), (96, CELLS), (192, CELLS), (96, ehd.Gumbel())):
            bearing = ehd.JournalBearing(
                journal_radius=R, length=0.05, radial_clearance=C, film=ehd.FiniteLength(n_theta=n, n_z=8),
                cavitation=closure, **OPTIONS["thin"],
            )  # fmt: skip
            found[n, closure] = build_model(bearing).evaluate(motion).tangent()[:2, [0, 1, 4, 5]]
        fine = found.pop((1152, CELLS))
        for at, value in found.items():
            off = max(np.abs(value - fine)[:, k].max() / np.abs(fine[:, k]).max() for k in ([0, 1], [2, 3]))
            errors[at] = max(errors.get(at, 0.0), off)
    measured("96 columns", errors[96, CELLS], 0.01)
    assert errors[48, CELLS] > 8.0 * errors[192, CELLS]
    assert errors[96, ehd.Gumbel()] > 5.0 * errors[96, CELLS]


@pytest.mark.parametrize(
    "options", ({"film": ehd.ClassicSOR()}, {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)})
)
def test_what_does_not_know_the_line_is_refused(make_bearing, options):
    with pytest.raises(ehd.InputError, match=r"Gumbel\.line_in_cells=True does not go with"):
        make_bearing(1.0, cavitation=CELLS, **options)
    make_bearing(1.0, cavitation=ehd.Gumbel(), **options)
