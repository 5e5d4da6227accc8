"""`equilibrium` and `whirl_threshold`."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.position import LoadSearch, first_guess
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.static.dynamic_stiffness import whirl_threshold
from tests.reference import short_bearing

SPEED = 100.0
FILM = ehd.FiniteLength(n_theta=64, n_z=8)
CLOSURES = (ehd.Gumbel(), ehd.SwiftStieber())


def _rotation(angle):
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


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
        """Loads of random tilted positions, up to 98 % of the gap at an end.

        (A prescribed tilt carries a bounded load only.)
        """
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

    def test_only_stribeck_refuses_the_maximum_gap_inlet(self, make_bearing):
        with pytest.raises(ehd.InputError, match="Periodic"):
            ehd.stribeck(make_bearing(1.0, inlet=ehd.MaximumGap()), speeds=[SPEED], load=1.0)

    @pytest.mark.parametrize("closure", [*CLOSURES, ehd.ElrodAdams()])
    def test_refuses_areas_that_turn_with_the_journal(self, make_bearing, closure):
        """Turning areas of any kind, next to areas in the housing, raise in every search for a position of rest."""
        rng = np.random.default_rng(3)
        still = ehd.CircumferentialGroove(z=-0.011, width=0.001, pressure=1e5)
        for kind in (ehd.Hole, ehd.Pocket, ehd.AxialGroove):
            size = {
                ehd.Hole: {"diameter": 0.005},
                ehd.Pocket: {"width_angle": 0.4, "length": 0.01},
                ehd.AxialGroove: {"width_angle": 0.4, "length": 0.01},
            }[kind]
            area = kind(angle=rng.uniform(0.0, 6.0), pressure=2e5, rotating=True, **size)
            bearing = make_bearing(1.0, cavitation=closure, supply=(still, area))
            point = ehd.EquilibriumPoint(bearing=bearing, speed=SPEED, load=(0.0, -10.0))
            for name, search in (
                ("equilibrium", lambda b=bearing: ehd.equilibrium(b, speed=SPEED, load=(0.0, -10.0))),
                ("equilibrium", lambda p=point: p({})),
                ("stribeck", lambda b=bearing: ehd.stribeck(b, load=10.0, speeds=[SPEED])),
            ):
                with pytest.raises(ehd.InputError, match=rf"{name}: JournalBearing.supply\[1\] turns .*UntilPeriodic"):
                    search()

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

    @pytest.mark.parametrize(("cross", "threshold"), [(-1.0, 0.0), (0.5, math.inf)])
    def test_damping_in_one_direction_alone(self, cross, threshold):
        K, C = np.array([[1.0, abs(cross)], [cross, 1.0]]), np.diag([1.0, 0.0])
        assert whirl_threshold(K, C, 1.0)[1] == threshold
        for m in (1e-3, 1.0, 1e3):
            s = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-K / m, -C / m]]))
            assert (s.real.max() > 0.0) == (threshold == 0.0)


def random_loads(seed):
    """A bearing under end pressures, or with a groove anywhere and starved, and a place and load of its film.

    End pressures from a hundredth to a hundred times mu omega / psi^2, from films that are half cavity to full ones; a
    supply from a thousandth to three times that; either spin, L/D 0.25 to 1, tilt by up to 0.9 of what closes the gap.
    """
    rng = np.random.default_rng([seed, 77])
    R, c, L = 0.03, 30e-6, 0.03 * float(rng.choice([0.5, 1.0, 2.0]))
    closure = (*CLOSURES, ehd.SwiftStieber(line_in_cells=False), ehd.ElrodAdams())[seed % 4]
    speed = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(1.5, 3.0))
    unit = 0.02 * abs(speed) * (R / c) ** 2
    ends, supply = unit * 10.0 ** rng.uniform(-2.0, 2.0), ()
    if seed % 8 >= 4:
        ends *= 1e-4
        size = {"width_angle": rng.uniform(0.2, 1.2), "length": 0.9 * L}
        pressure = unit * 10.0 ** rng.uniform(-3.0, 0.5)
        supply = (ehd.AxialGroove(angle=rng.uniform(0.0, 6.0), pressure=max(pressure, ends), **size),)
    bearing = ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=c,
        lubricant=ehd.Lubricant(viscosity=0.02),
        end_pressures=(ends, ends),
        cavitation=closure,
        supply=supply,
        film=FILM,
    )
    e, (a, b) = rng.uniform(0.2, 0.95), rng.uniform(0.0, 2.0 * math.pi, 2)
    tilt = (seed % 3 == 0) * rng.uniform(0.0, 0.9) * (1.0 - e) * 2.0 * c / L * np.array([math.cos(b), math.sin(b)])
    film = ehd.steady(bearing, speed=speed, eccentricity_ratio=e, direction=a, tilt=tuple(tilt))
    return bearing, {"speed": speed, "load": tuple(-film.force[:2]), "tilt": tuple(tilt)}, film


def carries(seed):
    """The position found carries the load, to the closures' rounding next to supply areas."""
    bearing, asked, film = random_loads(seed)
    found = ehd.equilibrium(bearing, **asked)
    assert np.abs(found.film.force - film.force)[:2].max() < 1e-8 * np.hypot(*film.force[:2]), seed
    return np.hypot(*(found.position - film.motion[:2])) < 1e-4 * bearing.radial_clearance


@pytest.mark.filterwarnings("ignore:.*the load is carried at:UserWarning")
def test_random_loads_are_found():
    """Random loads are carried; end pressures that prevent cavitation move the journal across the load."""
    same = [carries(seed) for seed in range(24)]
    # several positions carry some loads of starved films
    assert sum(same) >= 21


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*the load is carried at:UserWarning")
def test_many_random_loads_are_found():
    for seed in range(24, 424):
        carries(seed)


def test_of_several_positions_the_steadiest_is_returned_and_all_are_named():
    """A load on a groove has several positions; stiffnesses are found from forces at positions nearby."""
    bearing, asked, _ = random_loads(191)
    load, c = np.array(asked["load"]), bearing.radial_clearance
    with pytest.warns(
        UserWarning, match=r"carried at .* 0\.0006, 0\.6080, .*; returned is 0\.6080, .* positive definite"
    ):
        found = ehd.equilibrium(bearing, **asked)

    def force(x):
        e, angle = float(np.hypot(*x)) / c, math.atan2(x[1], x[0])
        at = {"speed": asked["speed"], "tilt": asked["tilt"], "eccentricity_ratio": e, "direction": angle}
        return ehd.steady(bearing, **at).force[:2]

    np.testing.assert_allclose(force(found.position), -load, rtol=0, atol=1e-7 * np.hypot(*load))
    steps = 1e-4 * c * np.eye(2)
    K = np.array([force(found.position - s) - force(found.position + s) for s in steps]).T / (2e-4 * c)
    assert np.linalg.eigvalsh(K + K.T)[0] > 0.0
    np.testing.assert_allclose(K, found.settled_stiffness, rtol=0, atol=1e-3 * np.abs(K).max())
    # the search alone comes to the first of them
    search = LoadSearch(build_model(bearing), "test", load)
    motion = np.zeros(10)
    motion[2:4], motion[8] = asked["tilt"], asked["speed"]
    motion[:2] = first_guess(bearing, asked["speed"], load, motion[2:4])
    first = search.find(motion)
    assert np.hypot(*first.motion[:2]) < 1e-3 * c
    assert np.linalg.eigvalsh(-first.slope - first.slope.T)[0] < 0.0


@pytest.mark.parametrize("closure", [*CLOSURES, ehd.SwiftStieber(line_in_cells=False), ehd.ElrodAdams()])
@pytest.mark.parametrize("e", (0.72, 0.76))
def test_loads_of_full_films_under_high_end_pressures(closure, e):
    """Without a cavity the force is normal to the eccentricity, and the stiffness nearly that of a turn."""
    bearing = ehd.JournalBearing(
        journal_radius=0.03,
        length=0.03,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        end_pressures=(4e7, 4e7),
        cavitation=closure,
    )
    film = ehd.steady(bearing, speed=300.0, eccentricity_ratio=e, direction=-1.2)
    assert film.pressure.min() > 1e7
    assert np.abs(film.force[:2] @ film.motion[:2]) < 1e-6 * np.hypot(*film.force[:2]) * 30e-6
    found = ehd.equilibrium(bearing, speed=300.0, load=tuple(-film.force[:2]))
    np.testing.assert_allclose(found.position, film.motion[:2], atol=1e-8 * 30e-6)


def test_load_on_a_groove_that_starves_the_film_ends_with_an_error_that_says_so():
    groove = ehd.AxialGroove(angle=np.radians(270.0), width_angle=np.radians(15.0), length=0.06, pressure=7e4)
    bearing = ehd.JournalBearing(
        journal_radius=0.05,
        length=0.08,
        radial_clearance=150e-6,
        lubricant=ehd.Lubricant(viscosity=0.01),
        cavitation=ehd.ElrodAdams(),
        supply=(groove,),
        film=ehd.FiniteLength(n_theta=96, n_z=8),
    )
    with pytest.raises(ehd.FilmError, match=r"no position found that carries 3000 N.*supply area"):
        ehd.equilibrium(bearing, speed=100.0 * np.pi, load=(0.0, -3000.0))


LAW = ehd.VogelTemperature(first=(313.15, 0.05), second=(373.15, 0.008))
THERMAL = {
    "one temperature": ehd.LumpedThermal(supply_temperature=313.15),
    "field": ehd.FilmEnergy(supply_temperature=313.15),
}


def _hot(make_bearing, kind):
    return make_bearing(1.0, film=FILM, lubricant=ehd.Lubricant(temperature_law=LAW), thermal=THERMAL[kind])


def _counted(monkeypatch):
    """Number of film solves since, in a list."""
    solves, evaluate = [0], BearingModel.evaluate

    def counted(self, *args, **options):
        solves[0] += 1
        return evaluate(self, *args, **options)

    monkeypatch.setattr(BearingModel, "evaluate", counted)
    return solves


@pytest.mark.parametrize("kind", THERMAL)
class TestThermal:
    def test_stiffness_holds_the_temperature_and_settled_stiffness_lets_it_follow(self, make_bearing, kind):
        bearing, load = _hot(make_bearing, kind), np.array([800.0, -2500.0])
        result = ehd.equilibrium(bearing, speed=600.0, load=tuple(load))
        model, step = build_model(bearing), 1e-6 * 25e-6
        held = np.zeros((2, 2))
        for k in range(2):
            for sign in (1.0, -1.0):
                moved = result.film.motion.copy()
                moved[k] += sign * step
                force = model.evaluate(moved, History(temperature=result.film.temperature)).wrench[:2]
                held[:, k] -= sign * force / (2 * step)
        np.testing.assert_allclose(result.stiffness, held, atol=1e-5 * abs(held).max())
        settled = result.settled_stiffness
        assert np.abs(settled - held).max() > 0.05 * np.abs(settled).max()
        # loads a little further on displace the journal as the settled stiffness says
        for change in ([30.0, 0.0], [0.0, 30.0]):
            ends = [
                ehd.equilibrium(bearing, speed=600.0, load=tuple(load + s * np.array(change))).position
                for s in (0.5, -0.5)
            ]
            np.testing.assert_allclose(settled @ (ends[0] - ends[1]), change, atol=0.03 * 30.0)

    def test_position_and_temperature_together_take_few_film_solves(self, make_bearing, kind, monkeypatch):
        """A field takes twice as many: the limiter of its transport depends on the temperature that is sought."""
        rng, solves = np.random.default_rng(8), _counted(monkeypatch)
        for size in (100.0, 2e3, 2e4, *np.exp(rng.uniform(math.log(100.0), math.log(3e4), 9))):
            turn = rng.uniform(0.0, 2.0 * math.pi)
            solves[0] = 0
            result = ehd.equilibrium(
                _hot(make_bearing, kind), speed=600.0, load=(size * math.cos(turn), size * math.sin(turn))
            )
            assert result.residual < 1e-10
            assert result.iterations <= solves[0] <= {"one temperature": 22, "field": 46}[kind]
            again = ehd.steady(
                result.film.bearing,
                speed=600.0,
                eccentricity_ratio=result.eccentricity_ratio,
                direction=math.atan2(result.position[1], result.position[0]),
            )
            np.testing.assert_allclose(again.temperature, result.film.temperature, rtol=0, atol=1e-6)
            np.testing.assert_allclose(again.force, result.film.force, rtol=1e-7, atol=1e-7 * size)

    def test_a_load_beyond_reach_is_refused_after_a_bounded_number_of_film_solves(
        self, make_bearing, kind, monkeypatch
    ):
        solves = _counted(monkeypatch)
        with pytest.raises(ehd.FilmError, match=r"no position found|temperature"):
            ehd.equilibrium(_hot(make_bearing, kind), speed=600.0, load=(0.0, -2e6))
        assert solves[0] < 8000


def test_a_load_at_which_the_friction_of_asperities_heats_the_film_away_says_so(make_bearing):
    bearing = _hot(make_bearing, "one temperature")
    rough = ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=1.15e11)
    bearing = dataclasses.replace(bearing, asperity=rough)
    ehd.equilibrium(bearing, speed=600.0, load=(0.0, -1e4))
    with pytest.raises(ehd.FilmError, match=r"no position found .*The film is at \d+ K there: .*seizes") as error:
        ehd.equilibrium(bearing, speed=600.0, load=(0.0, -3e5))
    most = float(re.search(r"the film carries at least (\S+) N", str(error.value)).group(1))
    assert 1e4 < most < 3e5 and ehd.equilibrium(bearing, speed=600.0, load=(0.0, -most)).residual < 1e-8


def test_loads_that_grow_lead_to_the_film_that_a_search_finds_at_once(make_bearing):
    bearing = _hot(make_bearing, "one temperature")
    found = ehd.equilibrium(bearing, speed=600.0, load=(0.0, -2e4)).film
    search = LoadSearch(build_model(bearing), "test", np.array([0.0, -2e4]))
    share, place = search.climb(np.where(np.arange(10) == 8, 600.0, 0.0))
    assert share == 1.0
    np.testing.assert_allclose(place.motion[:2], found.motion[:2], rtol=0, atol=1e-8 * bearing.radial_clearance)


def test_what_remembers_its_oil_has_its_settled_stiffness_at_rest(make_bearing):
    bearing = make_bearing(1.0, film=FILM, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    result = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -300.0))
    near = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -301.0))
    change = result.settled_stiffness @ (near.position - result.position)
    np.testing.assert_allclose(change, [0.0, -1.0], atol=0.02)
    plain = ehd.equilibrium(make_bearing(1.0, film=FILM), speed=SPEED, load=(0.0, -300.0))
    assert plain.settled_stiffness is plain.stiffness


@pytest.mark.parametrize("coefficient", (0.0, 20.0, 100.0))
@pytest.mark.parametrize("closure", (ehd.ElrodAdams(cavity_pressure=-1e5), ehd.SwiftStieber()))
def test_loads_of_heated_films_are_carried(closure, coefficient):
    """Loads of steady films with a temperature field, drawn in at the ends: `equilibrium` finds their positions."""
    heat = ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=coefficient)
    hot = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.oil("ISO VG 46"),
        thermal=heat,
        film=ehd.FiniteLength(n_theta=48, n_z=8),
        cavitation=closure,
    )
    for ratio in (0.5, 0.7, 0.85):
        film = ehd.steady(hot, speed=314.0, eccentricity_ratio=ratio)
        found = ehd.equilibrium(hot, speed=314.0, load=tuple(-film.force[:2]))
        assert np.hypot(*found.position) / 25e-6 == pytest.approx(ratio, rel=1e-6)
