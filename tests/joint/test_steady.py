"""`steady`, `equilibrium`, `whirl_threshold` and `solve_film`."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.build import build_model
from exudyn_ehd.joint.steady import whirl_threshold
from exudyn_ehd.reference import short_bearing

SPEED = 100.0
FILM = ehd.FiniteLength(n_theta=64, n_z=8)
CLOSURES = (ehd.Gumbel(), ehd.SwiftStieber())


def _rotation(angle):
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


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
        with pytest.raises(ehd.FilmError, match=r"steady: NO_FILM at x = .*minimum gap.*RegularisedWall"):
            ehd.steady(make_bearing(1.0), speed=SPEED, eccentricity_ratio=1.0)
        with pytest.raises(ehd.FilmError, match="NO_FILM"):
            ehd.steady(make_bearing(1.0), speed=SPEED, eccentricity_ratio=0.5, tilt=(1e-3, 0.0))

    @pytest.mark.parametrize(
        "wrong",
        [{"eccentricity_ratio": -0.1}, {"eccentricity_ratio": math.nan}, {"eccentricity_ratio": "0.5"}, {"speed": math.inf},
         {"direction": None}, {"tilt": (1e-4,)}, {"tilt": 1e-4}, {"velocity": (0.0, math.nan)}, {"axial_speed": math.nan}],
    )  # fmt: skip
    def test_input(self, make_bearing, wrong):
        with pytest.raises(ehd.InputError, match=f"steady: {next(iter(wrong))}"):
            ehd.steady(make_bearing(1.0), **{"speed": SPEED, "eccentricity_ratio": 0.5, **wrong})


class TestEquilibrium:
    @pytest.mark.parametrize("closure", CLOSURES)
    @pytest.mark.parametrize("So", (1e-6, 1e-3, 0.1, 1.0, 10.0, 90.0))
    def test_residual_from_tiny_to_high_loads(self, make_bearing, closure, So):
        # So = 90 means an eccentricity ratio of about 0.99 at L/D = 1.
        bearing = make_bearing(1.0, film=FILM, cavitation=closure)
        load = So * bearing.reference_force(SPEED) * np.array([math.cos(0.4), math.sin(0.4)])
        result = ehd.equilibrium(bearing, speed=SPEED, load=tuple(load))
        assert result.residual < 1e-10
        assert result.iterations <= 30
        np.testing.assert_allclose(result.film.force[:2], -load, rtol=1e-9, atol=1e-9 * abs(load).max())
        assert result.film.sommerfeld_number == pytest.approx(So, rel=1e-9)
        assert result.eccentricity_ratio == pytest.approx(float(np.hypot(*result.position)) / 25e-6, rel=1e-12)
        if So == 90.0:
            assert result.eccentricity_ratio > 0.985

    @pytest.mark.parametrize("closure", CLOSURES)
    def test_turns_with_the_load(self, make_bearing, closure):
        # By whole columns the problem is the same up to rounding.
        bearing = make_bearing(1.0, film=FILM, cavitation=closure)
        load = np.array([0.0, -0.8 * bearing.reference_force(SPEED)])
        a = ehd.equilibrium(bearing, speed=SPEED, load=tuple(load))
        for cells in (5, 16, 41):
            Q = _rotation(2 * math.pi * cells / 64)
            b = ehd.equilibrium(bearing, speed=SPEED, load=tuple(Q @ load))
            np.testing.assert_allclose(b.position, Q @ a.position, rtol=1e-7, atol=1e-8 * 25e-6)
            np.testing.assert_allclose(b.stiffness, Q @ a.stiffness @ Q.T, atol=1e-6 * abs(a.stiffness).max())
            np.testing.assert_allclose(b.damping, Q @ a.damping @ Q.T, atol=1e-6 * abs(a.damping).max())
            assert b.critical_mass == pytest.approx(a.critical_mass, rel=1e-6)

    def test_reversed_spin_is_the_mirror_image(self, make_bearing):
        bearing = make_bearing(1.0, film=FILM)
        W = 0.8 * bearing.reference_force(SPEED)
        a = ehd.equilibrium(bearing, speed=SPEED, load=(W, 0.0))
        b = ehd.equilibrium(bearing, speed=-SPEED, load=(W, 0.0))
        M = np.diag([1.0, -1.0])
        np.testing.assert_allclose(b.position, M @ a.position, rtol=1e-8)
        np.testing.assert_allclose(b.stiffness, M @ a.stiffness @ M, rtol=1e-7)
        assert b.attitude_angle == pytest.approx(a.attitude_angle, rel=1e-8)
        assert b.whirl_ratio == pytest.approx(a.whirl_ratio, rel=1e-7)

    @pytest.mark.parametrize("tilt", ((0.0, 0.0), (2e-4, -1e-4)))
    def test_stiffness_and_damping_are_derivatives_of_the_force(self, make_bearing, tilt):
        bearing = make_bearing(1.0, film=FILM)
        W = 0.8 * bearing.reference_force(SPEED)
        result = ehd.equilibrium(bearing, speed=SPEED, load=(W, 0.3 * W), tilt=tilt)
        model = build_model(bearing)
        base = np.array([*result.position, *tilt, 0, 0, 0, 0, SPEED, 0])
        active = None
        for matrix, first, step in ((result.stiffness, 0, 1e-6 * 25e-6), (result.damping, 4, 1e-6 * 25e-6 * SPEED)):
            for k in range(2):
                forces = []
                for sign in (1.0, -1.0):
                    moved = base.copy()
                    moved[first + k] += sign * step
                    forces.append(model.evaluate(moved).wrench[:2])
                    active = model.solver.work.active.copy() if active is None else active
                    assert np.array_equal(active, model.solver.work.active)  # a smooth state
                numeric = -(forces[0] - forces[1]) / (2 * step)
                np.testing.assert_allclose(matrix[:, k], numeric, atol=1e-6 * abs(matrix).max())

    def test_finds_a_prescribed_position_again(self, make_bearing):
        bearing = make_bearing(0.5, film=FILM)
        for eps in (0.05, 0.5, 0.9, 0.98):
            film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=eps, direction=1.0)
            result = ehd.equilibrium(bearing, speed=SPEED, load=tuple(-film.force[:2]))
            assert result.eccentricity_ratio == pytest.approx(eps, rel=1e-8)
            assert result.attitude_angle == pytest.approx(film.attitude_angle, rel=1e-7)

    @pytest.mark.parametrize("closure", CLOSURES)
    def test_finds_every_tilted_load_that_the_film_can_carry(self, make_bearing, closure):
        """Loads of random tilted positions, up to 98 % of the gap at an end. (A prescribed tilt carries a bounded load only.)"""
        rng = np.random.default_rng(1)
        for _ in range(40):
            bearing = make_bearing(rng.choice([0.25, 1.0, 2.0]), film=FILM, cavitation=closure)
            share, reach = rng.uniform(0.0, 0.8), rng.uniform(0.1, 0.98)
            direction, turn = rng.uniform(0.0, 2 * math.pi, 2)
            slope = reach * share * 2.0 * bearing.radial_clearance / bearing.length
            tilt = (slope * math.cos(turn), slope * math.sin(turn))
            spin = float(rng.choice([-1.0, 1.0])) * SPEED
            film = ehd.steady(
                bearing, speed=spin, eccentricity_ratio=reach * (1.0 - share), direction=direction, tilt=tilt
            )
            result = ehd.equilibrium(bearing, speed=spin, load=tuple(-film.force[:2]), tilt=tilt)
            assert result.residual < 1e-10
            assert result.iterations <= 30

    @pytest.mark.parametrize("So", (1e-9, 1e-12, 1e-15))
    def test_loads_near_rounding(self, make_bearing, So):
        # The force's rounding is 1e-16 of the reference force or less; what is left of the load's digits counts.
        bearing = make_bearing(1.0, film=FILM)
        result = ehd.equilibrium(bearing, speed=SPEED, load=(So * bearing.reference_force(SPEED), 0.0))
        assert result.residual <= max(1e-10, 1e-16 / So)
        assert result.iterations <= 5
        assert result.eccentricity_ratio < So
        # Half speed whirl; the central difference of the wedge on 64 columns is (2 pi / 64)^2 / 24 = 4e-4 too small.
        assert result.whirl_ratio == pytest.approx(0.5, rel=5e-4)

    def test_tilt_and_wall(self, make_bearing):
        W = 3.0 * make_bearing(1.0).reference_force(SPEED)
        tilted = ehd.equilibrium(make_bearing(1.0, film=FILM), speed=SPEED, load=(W, 0.0), tilt=(3e-4, 0.0))
        plain = ehd.equilibrium(make_bearing(1.0, film=FILM), speed=SPEED, load=(W, 0.0))
        assert tilted.residual < 1e-10
        assert tilted.film.minimum_gap < plain.film.minimum_gap
        wall = make_bearing(1.0, film=FILM, contact=ehd.RegularisedWall(onset=2e-6, pressure=1e9))
        pressed = ehd.equilibrium(wall, speed=SPEED, load=(200.0 * W, 0.0))
        assert pressed.residual < 1e-10
        assert pressed.film.contact_load > 0.0

    def test_whirl_of_the_short_bearing(self, make_bearing):
        # 1024 columns: the rupture line snaps to columns, which leaves 0.3 % in K and C.
        bearing = make_bearing(0.25, film=ehd.ShortBearing(n_theta=1024, n_z=4), cavitation=ehd.Gumbel())
        for eps in (0.2, 0.5):
            W = short_bearing.load(eps, 0.25) * bearing.reference_force(SPEED)
            result = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -W))
            ratio, mass = short_bearing.whirl_threshold(eps)
            assert result.whirl_ratio == pytest.approx(ratio, rel=3e-3)
            assert result.critical_mass * 25e-6 * SPEED**2 / W == pytest.approx(mass, rel=3e-3)

    @pytest.mark.parametrize(
        "wrong",
        [
            {"load": (0.0, 0.0)},
            {"speed": 0.0},
            {"load": (1.0,)},
            {"load": (math.nan, 1.0)},
            {"speed": math.nan},
            {"tilt": 1.0},
        ],
    )
    def test_input(self, make_bearing, wrong):
        with pytest.raises(ehd.InputError, match="equilibrium"):
            ehd.equilibrium(make_bearing(1.0), **{"speed": SPEED, "load": (10.0, 0.0), **wrong})

    def test_refuses_the_maximum_gap_inlet(self, make_bearing):
        with pytest.raises(ehd.InputError, match="Periodic"):
            ehd.equilibrium(make_bearing(1.0, inlet=ehd.MaximumGap()), speed=SPEED, load=(1.0, 0.0))

    def test_a_hopeless_tilt_is_an_error(self, make_bearing):
        with pytest.raises(ehd.FilmError, match="equilibrium"):
            ehd.equilibrium(make_bearing(1.0), speed=SPEED, load=(1e3, 0.0), tilt=(2e-3, 0.0))


class TestWhirlThreshold:
    def test_eigenvalues_cross_there(self):
        rng = np.random.default_rng(0)
        seen = 0
        for _ in range(200):
            K = rng.normal(size=(2, 2)) + np.array([[2.0, 3.0], [-3.0, 2.0]])
            C = np.diag(rng.uniform(3, 8, 2)) + rng.uniform(-1, 1)
            ratio, mass = whirl_threshold(K, C, 2.0)
            if not (math.isfinite(mass) and mass > 0.0):
                continue
            seen += 1
            real = []
            for m in (0.999 * mass, mass, 1.001 * mass):
                s = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-K / m, -C / m]]))
                near = s[np.argmin(abs(s - 1j * ratio * 2.0))]
                real.append(near.real)
            assert abs(real[1]) < 1e-8
            assert real[0] < 0.0 < real[2]
        assert seen > 50

    def test_limits(self):
        one = np.eye(2)
        assert whirl_threshold(one, one, 1.0)[1] == math.inf
        assert whirl_threshold(-one, one, 1.0)[1] == 0.0
        assert whirl_threshold(one, -one, 1.0)[1] == 0.0


class TestSolveFilm:
    GRID = ehd.bearing_grid(0.03, 0.06, 32, 6)
    OIL = ehd.Lubricant(viscosity=0.02)

    def _gap(self, eps=0.5):
        return np.repeat(30e-6 * (1.0 - eps * np.cos(self.GRID.x))[:, None], 7, axis=1)

    def test_equals_the_bearing_model(self):
        # The bearing takes the gap on the links itself, solve_film the mean of both neighbours: (pi/32)^2 / 2 = 0.5 %.
        film = ehd.solve_film(self.GRID, self._gap(), lubricant=self.OIL, surface_speed=(0.03 * SPEED, 0.0))
        bearing = ehd.JournalBearing(
            journal_radius=0.03, length=0.06, radial_clearance=30e-6, lubricant=self.OIL,
            film=ehd.FiniteLength(n_theta=32, n_z=6),
        )  # fmt: skip
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


def test_load_on_a_groove_that_starves_the_film_ends_with_an_error_that_says_so():
    groove = ehd.AxialGroove(angle=np.radians(270.0), width_angle=np.radians(15.0), length=0.06, pressure=7e4)
    bearing = ehd.JournalBearing(
        journal_radius=0.05, length=0.08, radial_clearance=150e-6, lubricant=ehd.Lubricant(viscosity=0.01),
        cavitation=ehd.ElrodAdams(), supply=(groove,), film=ehd.FiniteLength(n_theta=96, n_z=8),
    )  # fmt: skip
    with pytest.raises(ehd.FilmError, match=r"no position found that carries 3000 N.*supply area"):
        ehd.equilibrium(bearing, speed=100.0 * np.pi, load=(0.0, -3000.0))
