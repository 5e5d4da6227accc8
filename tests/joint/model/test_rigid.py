"""Symmetries, balances and outcomes of one bearing evaluation."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.results import refined_peak
from exudyn_ehd.joint.model.rigid import BearingModel

CLOSURES = (ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber())
FILMS = (ehd.FiniteLength(n_theta=48, n_z=8), ehd.ShortBearing(n_theta=48, n_z=8))
GENERAL = {
    "eccentricity": (0.4, 0.3),
    "tilt": (-0.2, 0.15),
    "velocity": (-0.2, 0.15),
    "tilt_rate": (0.1, 0.2),
    "axial": 0.7,
}
# Sums in another order: rounding of a few hundred terms with a condition number of the film up to 1e4.
ROUNDING = 1e-10


def _mirrored(motion, signs):
    return motion * np.array(signs, dtype=float)


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("film", FILMS)
class TestSymmetries:
    def _wrench(self, make_bearing, closure, film, motion, **options):
        model = build_model(make_bearing(1.0, cavitation=closure, film=film, **options))
        evaluation = model.evaluate(motion)
        assert evaluation.status is ehd.Status.CONVERGED
        return evaluation.wrench, evaluation.tangent(), evaluation.quantities()

    def test_mirror_in_the_xz_plane(self, make_bearing, make_motion, closure, film):
        # y, by, their rates and the spin change sign; so do Fy, Mx and Mz.
        motion = make_motion(make_bearing(1.0), **GENERAL)
        a, ta, qa = self._wrench(make_bearing, closure, film, motion)
        flip = np.array([1, -1, 1, -1, 1, -1, 1, -1, -1, 1.0])
        b, tb, qb = self._wrench(make_bearing, closure, film, motion * flip)
        sign = np.array([1, -1, 1, -1, 1, -1.0])
        np.testing.assert_allclose(b, a * sign, rtol=ROUNDING, atol=ROUNDING * abs(a).min())
        unit = np.outer(abs(ta[:, 4:8]).max(axis=1), 1.0 / abs(motion))  # columns in the size of the motion itself
        np.testing.assert_allclose(tb / unit, np.outer(sign, flip) * ta / unit, atol=1e-9 * abs(ta / unit).max())
        assert qb["power_loss"] == pytest.approx(qa["power_loss"], rel=ROUNDING)
        assert qb["leakage"] == pytest.approx(qa["leakage"], rel=1e-9)

    def test_mirror_in_the_mid_plane(self, make_bearing, make_motion, closure, film):
        # z changes sign: tilts, axial speed, Fz, Mx and My change sign, and the ends swap.
        motion = make_motion(make_bearing(1.0), **GENERAL)
        a, _, qa = self._wrench(make_bearing, closure, film, motion, end_pressures=(1e5, 2e5))
        flip = np.array([1, 1, -1, -1, 1, 1, -1, -1, 1, -1.0])
        b, _, qb = self._wrench(make_bearing, closure, film, motion * flip, end_pressures=(2e5, 1e5))
        sign = np.array([1, 1, -1, -1, -1, 1.0])
        np.testing.assert_allclose(b, a * sign, rtol=ROUNDING, atol=ROUNDING * abs(a).min())
        assert qb["leakage_lower"] == pytest.approx(qa["leakage_upper"], rel=1e-9)

    def test_rotation_by_whole_cells(self, make_bearing, make_motion, closure, film):
        bearing = make_bearing(1.0)
        a, _, qa = self._wrench(make_bearing, closure, film, make_motion(bearing, **GENERAL))
        for cells in (1, 7, 30):
            angle = 2 * math.pi * cells / 48
            Q = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
            turned = {k: Q @ v if isinstance(v, tuple) else v for k, v in GENERAL.items()}
            b, _, qb = self._wrench(make_bearing, closure, film, make_motion(bearing, **turned))
            for part in (slice(0, 2), slice(3, 5)):
                np.testing.assert_allclose(b[part], Q @ a[part], rtol=ROUNDING, atol=ROUNDING * abs(a[part]).max())
            np.testing.assert_allclose(b[[2, 5]], a[[2, 5]], rtol=ROUNDING)
            assert qb["peak_pressure"] == pytest.approx(qa["peak_pressure"], rel=ROUNDING)

    def test_doubling_the_viscosity_and_all_rates(self, make_bearing, make_motion, closure, film):
        # The film is linear in viscosity and, with all speeds scaled together, homogeneous in the rates.
        motion = make_motion(make_bearing(1.0), **GENERAL)
        a, _, _ = self._wrench(make_bearing, closure, film, motion)
        thick, _, _ = self._wrench(make_bearing, closure, film, motion, lubricant=ehd.Lubricant(viscosity=0.04))
        np.testing.assert_allclose(thick, 2 * a, rtol=ROUNDING)
        fast = motion.copy()
        fast[4:] *= 3.0
        b, _, _ = self._wrench(make_bearing, closure, film, fast)
        np.testing.assert_allclose(b, 3 * a, rtol=ROUNDING)


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("contact", (None, ehd.RegularisedWall(onset=15e-6, pressure=1e7)))
def test_journal_and_housing_torque_differ_by_the_moment_of_the_force(make_bearing, make_motion, closure, contact):
    """Torque of the film about the journal's own axis + torque on the bush about its own = the force's moment, e x F.

    Own axis of a tilted journal: through (x + bx z, y + by z), so that the force at z has the arm of that z; the arms
    of the moments Mx, My are the tilts.
    """
    bearing = make_bearing(1.0, cavitation=closure, contact=contact)
    for state in (GENERAL, {"eccentricity": (0.7, -0.2)}, {"eccentricity": (0.2, 0.5), "speed": -2.0}):
        evaluation = build_model(bearing).evaluate(make_motion(bearing, **state))
        x, y, bx, by = evaluation.motion[:4]
        fx, fy, _, mx, my, mz = evaluation.wrench
        q = evaluation.quantities()
        about_own_axis = mz - (x * fy - y * fx) + bx * mx + by * my
        scale = abs(mz) + abs(x * fy) + abs(y * fx)
        assert q["friction_torque"] == pytest.approx(about_own_axis, abs=1e-12 * scale)
        assert q["friction_torque_bush"] == pytest.approx(-mz, abs=1e-15 * scale)


def test_axial_force_is_half_of_the_pressure_on_the_gap(make_bearing, make_motion):
    """Concentric, no spin.

    Couette shear ``-mu w A / c``, and from the end pressures the shear pi R c dp on each surface.

    The wrench on the journal is the opposite of the bush's, ``tau = mu w / h - (h / 2) dp/dz``: its end-pressure part
    is the bush's shear with the opposite sign, which counts the pressure on the film's two end faces to the journal.
    """
    bearing = make_bearing(1.0, end_pressures=(1e5, 3e5), cavitation=ehd.FullSommerfeld())
    R, L, c = bearing.journal_radius, bearing.length, bearing.radial_clearance
    w = 0.8
    motion = make_motion(bearing, speed=0.0, axial=w / (R * 100.0))
    force = build_model(bearing).evaluate(motion).wrench
    couette = -0.02 * w * 2 * math.pi * R * L / c
    assert force[2] == pytest.approx(couette + math.pi * R * c * (3e5 - 1e5), rel=1e-12)
    np.testing.assert_allclose(force[[0, 1, 3, 4, 5]], 0.0, atol=1e-9)


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("film", FILMS)
def test_a_film_at_rest_has_no_pressure_and_still_damps(make_bearing, make_motion, closure, film):
    bearing = make_bearing(1.0, cavitation=closure, film=film)
    for place in ((0.0, 0.0), (0.5, 0.2)):
        model = build_model(bearing)
        evaluation = model.evaluate(make_motion(bearing, place, speed=0.0))
        assert evaluation.status is ehd.Status.CONVERGED
        assert not model.solver.pressure.any()
        assert not evaluation.wrench.any()
        tangent = evaluation.tangent()
        damping = -tangent[:2, 4:6]
        assert np.linalg.eigvalsh(0.5 * (damping + damping.T)).min() > 0.0
        assert tangent[5, 8] < 0.0
        assert tangent[2, 9] < 0.0
        # at the centre those of a motion by 1e-6 of the clearance in a second
        assert np.abs(tangent[:, :4]).max() <= (1e-5 * damping.max() if place == (0.0, 0.0) else 0.0)


@pytest.mark.parametrize("closure", CLOSURES)
def test_damping_at_rest_is_the_whole_film_s_off_the_centre(make_bearing, make_motion, closure):
    """The tangent at rest is that of the film without cavitation."""
    rest = make_motion(make_bearing(1.0), (0.3, 0.1), speed=0.0)
    damping, whole = (
        build_model(make_bearing(1.0, cavitation=c)).evaluate(rest).tangent()[:2, 4:6]
        for c in (closure, ehd.FullSommerfeld())
    )
    np.testing.assert_allclose(damping, whole, rtol=1e-12)


@pytest.mark.parametrize("closure", CLOSURES)
def test_damping_at_rest_at_the_centre_is_what_a_slow_motion_meets(make_bearing, make_motion, closure):
    """Gümbel's condition halves the full film's damping; Swift-Stieber's film reaches beyond the closing half."""

    def model(cavitation):
        return build_model(make_bearing(1.0, cavitation=cavitation))

    rest = make_motion(make_bearing(1.0), speed=0.0)
    damping, whole = (-model(c).evaluate(rest).tangent()[0, 4] for c in (closure, ehd.FullSommerfeld()))
    bearing = make_bearing(1.0, cavitation=closure)
    motion = make_motion(bearing, velocity=(1e-3, 0.0), speed=0.0)
    assert -model(closure).evaluate(motion).wrench[0] / motion[4] == pytest.approx(damping, rel=1e-3)
    expected = {ehd.FullSommerfeld: 1.0, ehd.Gumbel: 0.5, ehd.SwiftStieber: 0.536}[type(closure)]
    assert damping / whole == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("state", "status"),
    [
        ({"eccentricity": (1.0, 0.0)}, ehd.Status.NO_FILM),
        ({"eccentricity": (0.8, 0.7)}, ehd.Status.NO_FILM),
        ({"eccentricity": (0.5, 0.0), "tilt": (0.0, 0.9)}, ehd.Status.NO_FILM),
        ({"eccentricity": (math.nan, 0.0)}, ehd.Status.NOT_FINITE),
        ({"velocity": (0.0, math.inf)}, ehd.Status.NOT_FINITE),
        ({"speed": math.nan}, ehd.Status.NOT_FINITE),
    ],
)
def test_states_without_a_film(make_bearing, make_motion, state, status):
    bearing = make_bearing(1.0)
    model = build_model(bearing)
    good = make_motion(bearing, (0.3, 0.2))
    before = model.evaluate(good).wrench
    evaluation = model.evaluate(make_motion(bearing, **state))
    assert evaluation.status is status
    assert np.isnan(evaluation.wrench).all()
    assert np.isnan(evaluation.tangent()).all()
    assert "peak_pressure" not in evaluation.quantities()
    assert status.advice
    # nothing is left behind
    np.testing.assert_allclose(model.evaluate(good).wrench, before, rtol=0, atol=1e-12 * np.abs(before).max())


def test_a_state_without_a_film_leaves_the_warm_start(make_bearing, make_motion):
    model = build_model(make_bearing(1.0, film=FILMS[0]))
    motion = make_motion(model.bearing, eccentricity=(0.5, 0.6))
    model.evaluate(motion)
    steps = model.evaluate(motion).iterations
    assert model.evaluate(2.0 * motion).status is ehd.Status.NO_FILM
    assert model.solver.work.warm
    assert model.evaluate(motion).iterations <= steps + 1


def test_a_wall_carries_a_journal_beyond_the_bore(make_bearing, make_motion):
    bearing = make_bearing(1.0, contact=ehd.RegularisedWall(onset=2e-6, pressure=1e9))
    forces = []
    for reach in (0.97, 1.0, 1.05):
        evaluation = build_model(bearing).evaluate(make_motion(bearing, (reach, 0.0)))
        assert evaluation.status is ehd.Status.CONVERGED
        forces.append((-evaluation.wrench[0], evaluation.quantities()["contact_load"]))
    loads = np.array(forces)
    assert (np.diff(loads[:, 0]) > 0).all()
    assert (np.diff(loads[:, 1]) > 0).all()
    assert evaluation.quantities()["minimum_gap"] == pytest.approx(-0.05 * bearing.radial_clearance)


@pytest.mark.parametrize("eccentricity", ((0.3, 0.0), (0.6, 0.2)))
@pytest.mark.parametrize("n_theta", (96, 192))
def test_power_loss_is_the_dissipation_of_the_film(make_bearing, make_motion, eccentricity, n_theta):
    """Mechanical power into the film = dissipation ``sum (h^3/12 mu) grad p^2 + sum mu (U^2 + w^2)/h`` at ambient ends.

    Summed independently from the links' pressure drops. Second order in the grid: 0.3 % at 96 x 16, a quarter at 192
    x 32.
    """
    film = ehd.FiniteLength(n_theta=n_theta, n_z=n_theta // 6)
    bearing = make_bearing(1.0, cavitation=ehd.FullSommerfeld(), film=film)
    motion = make_motion(bearing, eccentricity, (0.1, 0.2), (0.2, -0.1), (0.1, 0.1), 1.0, 0.5)
    model = build_model(bearing)
    loss = model.evaluate(motion).quantities()["power_loss"]
    R, c, mu = bearing.journal_radius, bearing.radial_clearance, bearing.lubricant.viscosity
    s, g = model.solver, model.grid
    p, h = s.pressure * model.scales.pressure, s.H * c
    drop_x, drop_z = np.roll(p, -1, axis=0) - p, np.diff(p, axis=1)
    pressure = (s.system.kx * drop_x**2).sum() + (s.system.kz[:, :-1] * drop_z**2).sum()
    pressure *= c**3 / (12.0 * mu)
    U, w = R * motion[8], motion[9]
    shear = (mu * (U**2 + w**2) / h * g.weight * R**2).sum()
    assert loss == pytest.approx(pressure + shear, rel=3e-3 * (96 / n_theta) ** 2)
    assert pressure > 0.1 * shear  # both parts matter


def test_power_loss_of_a_steady_journal_is_torque_times_speed(make_bearing, make_motion):
    bearing = make_bearing(1.0)
    q = build_model(bearing).evaluate(make_motion(bearing, (0.6, 0.1))).quantities()
    assert q["power_loss"] == pytest.approx(-q["friction_torque"] * 100.0, rel=1e-12)
    assert abs(q["friction_torque_unbroken"]) < abs(q["friction_torque"])


def test_the_ruptured_film_shears_its_share(make_bearing, make_motion):
    # Friction is linear in the share between "unbroken only" and "all".
    q = [
        build_model(b).evaluate(make_motion(b, (0.6, 0.1))).quantities()
        for b in (make_bearing(1.0, cavitation=ehd.SwiftStieber(cavity_shear=s)) for s in (0.0, 0.5, 1.0))
    ]
    torque = [x["friction_torque"] for x in q]
    assert torque[0] == pytest.approx(q[2]["friction_torque_unbroken"], rel=1e-13)
    assert torque[1] == pytest.approx(0.5 * (torque[0] + torque[2]), rel=1e-13)


@pytest.mark.parametrize("state", (GENERAL, {"eccentricity": (0.5, 0.1), "velocity": (0.3, 0.0), "speed": 0.0}))
def test_mass_balance(make_bearing, make_motion, state):
    """Leakage = rate at which the clearance shrinks: a periodic film without cavitation has no source; to rounding."""
    bearing = make_bearing(1.0, cavitation=ehd.FullSommerfeld(), end_pressures=(1e5, 4e5))
    model = build_model(bearing)
    q = model.evaluate(make_motion(bearing, **state)).quantities()
    R, c = bearing.journal_radius, bearing.radial_clearance
    growth = (model.solver.H_t * np.outer(model.grid.width_x, model.grid.width_z)).sum() * c * R**2
    assert q["leakage"] == pytest.approx(-growth, abs=1e-11 * (abs(q["leakage_lower"]) + abs(q["leakage_upper"])))


def test_leakage_of_a_concentric_annulus(make_bearing, make_motion):
    # Q = pi R c^3 dp / (6 mu L) towards the low pressure, plus the Couette flow pi R c w.
    bearing = make_bearing(1.0, cavitation=ehd.FullSommerfeld(), end_pressures=(4e5, 1e5))
    R, L, c = bearing.journal_radius, bearing.length, bearing.radial_clearance
    q = build_model(bearing).evaluate(make_motion(bearing, axial=0.3)).quantities()
    expected = math.pi * R * c**3 * 3e5 / (6 * 0.02 * L) + math.pi * R * c * 0.3 * R * 100.0
    assert q["leakage_upper"] == pytest.approx(expected, rel=1e-11)
    assert q["leakage_lower"] == pytest.approx(-expected, rel=1e-11)


def test_refined_peak_hides_the_grid(make_bearing, make_motion):
    """Turning the journal by parts of a column.

    The largest vertex ripples, the peak of the parabola a third of that.
    """
    bearing = make_bearing(1.0, film=ehd.FiniteLength(n_theta=48, n_z=10))
    model, values = build_model(bearing), []
    for angle in np.linspace(0.0, 2 * np.pi / 48, 9):
        evaluation = model.evaluate(make_motion(bearing, (0.6 * math.cos(angle), 0.6 * math.sin(angle))))
        peak, theta, z = refined_peak(evaluation.film)
        assert evaluation.quantities()["peak_pressure"] == peak
        values.append((model.solver.pressure.max() * model.scales.pressure, peak, theta - angle))
        assert abs(z) < 1e-3 * bearing.length
    vertex, refined, place = np.ptp(values, axis=0) / np.mean(values, axis=0)
    assert refined < 0.5 * vertex  # the rest is the rupture line, which snaps to columns
    assert abs(place) < 0.005


def test_short_bearing_is_the_limit_of_the_finite_one(make_bearing, make_motion):
    # Error of the short bearing falls with (L/D)^2.
    errors = []
    for ratio in (0.2, 0.1, 0.05):
        F = [
            build_model(b).evaluate(make_motion(b, (0.5, 0.2))).wrench[:2]
            for b in (
                make_bearing(ratio, film=f) for f in (ehd.ShortBearing(n_theta=192), ehd.FiniteLength(n_theta=192))
            )
        ]
        errors.append(np.linalg.norm(F[0] - F[1]) / np.linalg.norm(F[1]))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.25)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.25)


def test_only_journals_that_may_move_are_built(make_bearing):
    with pytest.raises(ehd.InputError, match="JournalBearing"):
        build_model("bearing")
    with pytest.raises(ehd.InputError, match="MaximumGap"):
        build_model(make_bearing(1.0, inlet=ehd.MaximumGap()))
    assert isinstance(build_model(make_bearing(1.0)), BearingModel)


@pytest.mark.parametrize(
    ("eccentricity", "tilt", "end"),
    [
        ((0.4, 0.3), (0.0, 0.0), 0.0),
        ((0.4, 0.3), (0.2, 0.1), 1.0),
        ((-0.4, 0.3), (0.2, 0.1), -1.0),
        ((0.0, 0.0), (0.3, -0.2), 1.0),
    ],
)
def test_place_of_the_smallest_gap(make_bearing, make_motion, eccentricity, tilt, end):
    """Against the smallest of the closed form h = c - x cos - y sin on a fine grid."""
    bearing = make_bearing(film=ehd.FiniteLength(n_theta=48, n_z=6))
    motion = make_motion(bearing, eccentricity, tilt)
    q = build_model(bearing).evaluate(motion).quantities()
    x, y, bx, by = motion[:4]
    theta, z = np.linspace(0.0, 2.0 * np.pi, 3601), np.linspace(-0.5, 0.5, 21) * bearing.length
    h = bearing.radial_clearance - np.outer(np.cos(theta), x + bx * z) - np.outer(np.sin(theta), y + by * z)
    assert q["minimum_gap_z"] == pytest.approx(end * 0.5 * bearing.length, abs=1e-15)
    place = np.argmin(np.abs(z - q["minimum_gap_z"]))
    # half a fine interval
    assert q["minimum_gap_angle"] == pytest.approx(theta[np.argmin(h[:, place])], abs=1e-3)
    assert q["minimum_gap"] == pytest.approx(h.min(), rel=1e-6)


def test_place_of_the_smallest_gap_with_a_profile(make_bearing, make_motion):
    """A bore that is out of round by more than the journal is eccentric is narrowest where its wave is."""
    bearing = make_bearing(profile=ehd.OutOfRound(order=2, amplitude=5e-6), film=ehd.FiniteLength(n_theta=96, n_z=6))
    q = build_model(bearing).evaluate(make_motion(bearing, (0.0, 0.05))).quantities()
    theta = np.arange(96) * 2.0 * np.pi / 96
    h = 25e-6 - 0.05 * 25e-6 * np.sin(theta) + 5e-6 * np.cos(2.0 * theta)
    assert q["minimum_gap_angle"] == pytest.approx(theta[np.argmin(h)], abs=1e-12)


@pytest.mark.parametrize(
    ("film", "name"),
    [
        (ehd.FiniteLength, "n_theta"),
        (ehd.FiniteLength, "n_z"),
        (ehd.ShortBearing, "n_theta"),
        (ehd.LongBearing, "n_theta"),
        (ehd.ClassicSOR, "n_z"),
        (ehd.ImpedanceMap, "n_theta"),
        (ehd.ImpedanceMap, "n_direction"),
        (lambda **n: ehd.ThrustFaces(inner_radius=0.02, outer_radius=0.03, clearance=2e-5, **n), "n_theta"),
        (lambda **n: ehd.bearing_grid(0.02, 0.02, **({"n_theta": 48, "n_z": 6} | n)), "n_theta"),
        (
            lambda **n: ehd.SphericalBearing(
                ball_radius=0.01, radial_clearance=1e-5, lubricant=ehd.Lubricant(viscosity=0.02), **n
            ),
            "n_phi",
        ),
    ],
)
def test_grids_beyond_any_use_are_refused_when_described(film, name):
    """Grids of a million vertices, and of the first number that is too many, raise errors that name the limit."""
    for count in (20_001, 1_000_000, 10**30):
        with pytest.raises(ehd.InputError, match=rf"{name} must be between \d+ and 20000, got {count}; "):
            film(**{name: count})


def test_grids_beyond_any_memory():
    with pytest.raises(ehd.InputError, match=r"FiniteLength: a grid of 20000 x 20000 takes .* 192 x 16 is fine"):
        ehd.FiniteLength(n_theta=20_000, n_z=20_000)


def test_imported_bores_must_fit_the_film(make_bearing):
    """Imported bores are checked as those of cylinders: a film on a bore of another radius is another film."""
    cylinder = ehd.HollowCylinder(inner_radius=0.0225, thickness=0.008, length=0.05, circumferential=12).mesh()
    mesh = ehd.mesh_from_arrays(cylinder.nodes, cylinder.elements, bore_radius=0.0225)
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    for kind in (ehd.ModalBush, ehd.ANCFBush):
        bush = kind(mesh=mesh, material=steel)
        with pytest.raises(
            ehd.InputError, match=r"bore radius 0\.025025 m within 2 %, got a mesh whose .* = 0\.0225 m"
        ):
            make_bearing(bush=bush)
        fits = {"journal_radius": 0.0224, "radial_clearance": 1e-4, "bush": bush}
        assert make_bearing(**fits, length=0.05).bush is bush
        with pytest.raises(ehd.InputError, match=r"as long as the film, 0\.06 m .* bore from -0\.025 to 0\.025 m"):
            make_bearing(**fits, length=0.06)
