"""`steady` and `solve_film`."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

SPEED = 100.0
FILM = ehd.FiniteLength(n_theta=64, n_z=8)


class TestSteady:
    def test_result_is_the_model_s(self, make_bearing):
        bearing = make_bearing(0.7, film=FILM, end_pressures=(1e5, 2e5))
        c = bearing.radial_clearance
        args = {"tilt": (1e-4, -2e-4), "velocity": (1e-3, 2e-3), "axial_speed": 0.4}
        film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.4, direction=0.7, **args)
        x, y = 0.4 * c * math.cos(0.7), 0.4 * c * math.sin(0.7)
        model = build_model(bearing)
        motion = [x, y, 1e-4, -2e-4, 1e-3, 2e-3, 0, 0, SPEED, 0.4]
        evaluation = model.evaluate(np.array(motion))
        np.testing.assert_array_equal(np.concatenate((film.force, film.moment)), evaluation.wrench)
        q = evaluation.quantities()
        for name in (
            "minimum_gap",
            "friction_torque",
            "friction_torque_unbroken",
            "friction_torque_bush",
            "power_loss",
            "leakage",
        ):
            assert getattr(film, name) == q[name]
        np.testing.assert_allclose(film.gap[:, 4], c - x * np.cos(film.theta) - y * np.sin(film.theta), rtol=1e-12)
        np.testing.assert_array_equal(film.pressure[:, 0], 1e5)
        np.testing.assert_array_equal(film.pressure[:, -1], 2e5)
        assert film.z[0] == -bearing.length / 2
        assert film.status is ehd.Status.CONVERGED

    def test_force_is_the_integral_of_the_pressure(self, make_bearing):
        # Independent quadrature of the returned field: trapezoidal in z, second order in ten intervals.
        film = ehd.steady(
            make_bearing(1.0, film=ehd.FiniteLength(n_theta=96, n_z=40)), speed=SPEED, eccentricity_ratio=0.6
        )
        line = np.trapezoid(film.pressure, film.z, axis=1)
        step = 2 * math.pi / 96 * 0.025
        force = [-(line * np.cos(film.theta)).sum() * step, -(line * np.sin(film.theta)).sum() * step]
        np.testing.assert_allclose(film.force[:2], force, rtol=2e-3)

    def test_a_liner_is_displaced_by_what_the_gap_has_more(self, make_bearing):
        b = make_bearing(bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9), cavitation=ehd.SwiftStieber())
        film = ehd.steady(b, speed=SPEED, eccentricity_ratio=0.8)
        rigid = b.radial_clearance * (1.0 - 0.8 * np.cos(film.theta))[:, None]
        np.testing.assert_allclose(film.bore_displacement, film.gap - rigid, atol=1e-12)
        assert film.bore_displacement.max() > 1e-7

    def test_attitude_and_load_in_every_direction(self, make_bearing):
        bearing = make_bearing(1.0, film=ehd.FiniteLength())
        reference = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.7)
        assert 0.0 < reference.attitude_angle < math.pi / 2
        for direction in np.linspace(0.1, 6.0, 7):
            for sign in (1.0, -1.0):
                film = ehd.steady(bearing, speed=sign * SPEED, eccentricity_ratio=0.7, direction=direction)
                # Between two columns: 0.3 % on the default grid.
                assert film.sommerfeld_number == pytest.approx(reference.sommerfeld_number, rel=3e-3)
                assert film.attitude_angle == pytest.approx(reference.attitude_angle, abs=3e-3)

    def test_concentric_and_at_rest(self, make_bearing):
        film = ehd.steady(make_bearing(1.0), speed=0.0, eccentricity_ratio=0.5)
        assert math.isnan(film.sommerfeld_number)
        assert math.isnan(film.attitude_angle)
        assert film.power_loss == 0.0

    def test_tilted_against_the_wall(self, make_bearing):
        with pytest.raises(ehd.FilmError, match=r"steady: NO_FILM at x = .*minimum film thickness.*RegularisedWall"):
            ehd.steady(make_bearing(1.0), speed=SPEED, eccentricity_ratio=1.0)
        with pytest.raises(ehd.FilmError, match="NO_FILM"):
            ehd.steady(make_bearing(1.0), speed=SPEED, eccentricity_ratio=0.5, tilt=(1e-3, 0.0))

    @pytest.mark.parametrize(
        "wrong",
        [
            {"eccentricity_ratio": -0.1},
            {"eccentricity_ratio": math.nan},
            {"eccentricity_ratio": "0.5"},
            {"speed": math.inf},
            {"direction": None},
            {"tilt": (1e-4,)},
            {"tilt": 1e-4},
            {"velocity": (0.0, math.nan)},
            {"axial_speed": math.nan},
        ],
    )
    def test_input(self, make_bearing, wrong):
        with pytest.raises(ehd.InputError, match=f"steady: {next(iter(wrong))}"):
            ehd.steady(make_bearing(1.0), **{"speed": SPEED, "eccentricity_ratio": 0.5, **wrong})


class TestSolveFilm:
    GRID = ehd.bearing_grid(0.03, 0.06, 32, 6)
    OIL = ehd.Lubricant(viscosity=0.02)

    def _gap(self, eps=0.5):
        return np.repeat(30e-6 * (1.0 - eps * np.cos(self.GRID.x))[:, None], 7, axis=1)

    def test_equals_the_bearing_model(self):
        # The bearing takes the gap on the links itself, solve_film the mean of both neighbours: (pi/32)^2 / 2 = 0.5 %.
        film = ehd.solve_film(self.GRID, self._gap(), lubricant=self.OIL, surface_speed=(0.03 * SPEED, 0.0))
        bearing = ehd.JournalBearing(
            journal_radius=0.03,
            length=0.06,
            radial_clearance=30e-6,
            lubricant=self.OIL,
            film=ehd.FiniteLength(n_theta=32, n_z=6),
        )
        reference = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.5)
        np.testing.assert_allclose(film.pressure, reference.pressure, atol=0.02 * reference.pressure.max())
        assert film.load == pytest.approx((reference.pressure * self.GRID.weight).sum() * 0.03**2, rel=0.02)

    def test_boundary_pressures_and_inflow(self):
        boundary = np.zeros(self.GRID.shape)
        boundary[:, 0] = 1e5
        film = ehd.solve_film(self.GRID, np.full(self.GRID.shape, 30e-6), lubricant=self.OIL, boundary=boundary)
        flow = math.pi * 0.03 * 30e-6**3 * 1e5 / (6 * 0.02 * 0.06)
        assert film.inflow[:, 0].sum() == pytest.approx(flow, rel=1e-10)
        assert film.inflow.sum() == pytest.approx(0.0, abs=1e-10 * flow)
        assert not film.inflow[:, 1:-1].any()
        assert film.load == pytest.approx(0.5e5 * 2 * math.pi * 0.03 * 0.06, rel=1e-10)
        uniform = ehd.solve_film(self.GRID, self._gap(), lubricant=self.OIL, boundary=2e5)
        np.testing.assert_allclose(uniform.pressure, 2e5, rtol=1e-10)

    @pytest.mark.parametrize("closure", (ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber()))
    def test_any_closure(self, closure):
        rate = np.full(self.GRID.shape, -1e-3)
        film = ehd.solve_film(
            self.GRID, self._gap(), lubricant=self.OIL, surface_speed=(3.0, 0.1), gap_rate=rate, cavitation=closure
        )
        assert film.status is ehd.Status.CONVERGED
        assert film.load > 0.0

    def test_input(self):
        def solve(gap, **options):
            ehd.solve_film(self.GRID, gap, lubricant=self.OIL, **options)

        for gap in (np.ones((3, 3)), -self._gap(), self._gap() * np.nan, 1e-5):
            with pytest.raises(ehd.InputError, match="solve_film: gap"):
                solve(gap)
        with pytest.raises(ehd.InputError, match="gap_rate"):
            solve(self._gap(), gap_rate=np.zeros(3))
        for speed in (1.0, (1.0,), (math.nan, 0.0)):
            with pytest.raises(ehd.InputError, match="surface_speed"):
                solve(self._gap(), surface_speed=speed)
        for closure in (ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e4)):
            with pytest.raises(ehd.InputError, match=r"boundary must not be below .*cavity_pressure .*got -20000 Pa"):
                solve(self._gap(), boundary=-2e4, cavitation=closure)
        solve(self._gap(), boundary=-2e4, cavitation=ehd.FullSommerfeld())
        for name, wrong in {"boundary": "high", "cavitation": ehd.Gumbel, "stepped_gap": "no"}.items():
            with pytest.raises(ehd.InputError, match=f"solve_film: {name} must be"):
                solve(self._gap(), **{name: wrong})
        with pytest.raises(ehd.InputError, match="boundary must have shape"):
            solve(self._gap(), boundary=np.zeros(3))
        with pytest.raises(ehd.InputError, match="history must be >= 0 m"):
            solve(self._gap(), history=-self._gap(), step=1e-4, cavitation=ehd.ElrodAdams())
        with pytest.raises(ehd.InputError, match="grid must be FilmGrid"):
            ehd.solve_film(None, self._gap(), lubricant=self.OIL)
        with pytest.raises(ehd.InputError, match="lubricant must be Lubricant"):
            ehd.solve_film(self.GRID, self._gap(), lubricant=0.02)


@pytest.mark.parametrize("bush", [None, ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9)], ids=["rigid", "liner"])
def test_force_at_an_instant_is_the_same_at_any_speed(bush):
    """Similar films have similar forces: the short step that stands for none is scaled by the speeds, from slow gates
    to dental drills. A fixed step of 1e-6 s on liners took a tenth of the force at 1e5 rad/s."""
    forces = []
    for faster in (1.0, 2.0**-20, 2.0**9):
        bearing = ehd.JournalBearing(
            journal_radius=0.02,
            length=0.02,
            radial_clearance=2e-5,
            lubricant=ehd.Lubricant(viscosity=0.02 / faster if faster >= 1.0 else 0.02),
            film=ehd.FiniteLength(n_theta=48, n_z=6),
            cavitation=ehd.ElrodAdams(cavity_pressure=-1e5 * min(faster, 1.0)),
            bush=bush if faster >= 1.0 or bush is None else dataclasses.replace(bush, youngs_modulus=2e9 * faster),
        )
        speeds = {"speed": 256.0 * faster, "velocity": (1e-4 * faster, -2.5e-4 * faster)}
        film = ehd.steady(bearing, eccentricity_ratio=0.6, **speeds)
        forces.append(film.force[:2] / min(faster, 1.0))
    np.testing.assert_allclose(forces, [forces[0]] * 3, rtol=1e-9)
