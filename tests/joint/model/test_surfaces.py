"""Mixed friction, wear, profile and liner in the bearing model: statics, balances, histories and what is refused."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.surfaces.contact import (
    add_contact,
    contact_tangent,
    contact_weights,
)
from exudyn_ehd.joint.model.build import build_model

R, L, C, SPEED = 0.02, 0.03, 20e-6, 200.0
SIGMA = 0.4e-6
ASPERITY = ehd.GreenwoodTripp(composite_roughness=SIGMA, composite_modulus=5e10, friction_coefficient=0.08)
LINER = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)


def bearing(**options):
    values = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=0.03),
        "film": ehd.FiniteLength(n_theta=64, n_z=8),
    } | options
    return ehd.JournalBearing(**values)


def at(eps, angle=0.0, speed=SPEED, axial=0.0, tilt=(0.0, 0.0)):
    return np.array([eps * C * math.cos(angle), eps * C * math.sin(angle), *tilt, 0, 0, 0, 0, speed, axial])


def contact_only(motion, **options):
    """The contact alone, with friction, under a film of a vanishing viscosity."""
    model = build_model(bearing(lubricant=ehd.Lubricant(viscosity=1e-12), asperity=ASPERITY, **options))
    return model.evaluate(motion)


def brute_force(film, motion):
    """Wrench of the contact by a loop over vertices.

    Pressure along -e_r, friction against the slip, moments about O.
    """
    g, f = film.grid, film.pressing
    v = np.array([R * motion[8], motion[9]])
    slip = v / math.sqrt(float(v @ v) + ASPERITY.transition_speed**2)
    F, M = np.zeros(3), np.zeros(3)
    for i, theta in enumerate(g.x):
        e_r, e_t = np.array([math.cos(theta), math.sin(theta), 0]), np.array([-math.sin(theta), math.cos(theta), 0])
        for j, z in enumerate(g.z * R):
            size = f.P[0][i, j] * g.weight[i, j] * R**2
            point = R * e_r + np.array([0, 0, z])
            push = -size * e_r
            drag = -0.08 * size * (slip[0] * e_t + slip[1] * np.array([0, 0, 1]))
            F += push + drag
            M += np.cross(point, push) + np.cross(point, drag)
    return F, M


def normal_wrench(integrals, motion):
    """Wrench of contact pressures with the integrals (c, s, zc, zs, 1) in N, z over R: torque e x F about O."""
    sc, ss, szc, szs, _ = integrals
    x, y, bx, by = motion[:4]
    return np.array([-sc, -ss, 0.0, R * szs, -R * szc, y * sc - x * ss + R * (by * szc - bx * szs)])


@pytest.mark.parametrize("speed", [SPEED, -SPEED, 0.1, 0.0])
@pytest.mark.parametrize("friction", [0.0, 0.08])
def test_contact_tangent_is_the_derivative_of_the_wrench(speed, friction):
    """Pressures are linear in the gap, so that the error of central differences is 1e-10 of the columns."""
    rng = np.random.default_rng(7)
    grid, scale, transition = ehd.bearing_grid(R, L, 24, 4), np.array([1.0 / C, 1.0 / C, R / C, R / C]), 0.01
    P, slope = rng.uniform(1e5, 1e6, grid.shape), -rng.uniform(1e5, 1e6, grid.shape)
    motion = at(0.98, 0.4, speed, axial=0.01, tilt=(1e-4, -5e-5))

    def contact(m):
        gap, found = -np.tensordot((m - motion)[:4] * scale, grid.moments[:4], 1), (np.empty(5), *np.zeros((2, 6)))
        add_contact(P + slope * gap, grid.weight, grid.moments, m, friction, transition, R, *found)
        return found

    def wrench(m):
        return contact(m)[2]

    integrals, drag, whole = contact(motion)
    np.testing.assert_allclose(contact_weights(motion, friction, transition, R) @ integrals, whole, rtol=1e-12)
    np.testing.assert_allclose(
        (contact_weights(motion, friction, transition, R) - contact_weights(motion, 0.0, transition, R)) @ integrals,
        drag,
        atol=1e-12 * np.abs(whole).max(),
    )
    fields = slope, grid.weight, grid.moments
    found = contact_tangent(*fields, motion, scale, friction, transition, R, integrals)
    steps = np.array([C, C, C / L, C / L, C, C, C / L, C / L, 1e-3 * transition / R, 1e-3 * transition])
    for k, d in enumerate(np.diag(1e-3 * steps)):
        difference = (wrench(motion + d) - wrench(motion - d)) / (2.0 * d[k])
        size = np.abs(wrench(motion)).max() / steps[k]
        np.testing.assert_allclose(found[:, k] / size, difference / size, atol=1e-9)


@pytest.mark.parametrize("speed", [SPEED, -SPEED, 0.1, 0.0])
@pytest.mark.parametrize("tilt", [(0.0, 0.0), (1e-4, -5e-5)])
def test_contact_wrench_point_by_point(speed, tilt):
    """Force and moment to rounding.

    The torque differs by e x F of the pressures, which act on the journal through its axis.
    """
    motion = at(0.98, 0.4, speed, axial=0.5, tilt=tilt)
    evaluation = contact_only(motion)
    wrench, film = evaluation.wrench, evaluation.film
    F, M = brute_force(film, motion)
    normal = normal_wrench(film.pressing.integrals[0] * R**2, motion)
    x, y, bx, by = motion[:4]
    own = normal[5] - (x * normal[1] - y * normal[0] - bx * normal[3] - by * normal[4])
    assert own == pytest.approx(0.0, abs=1e-12 * R * np.abs(F).max())
    np.testing.assert_allclose(wrench[:5], [*F, *M[:2]], atol=1e-8 * np.abs(F).max())
    assert wrench[5] == pytest.approx(M[2] + normal[5], abs=1e-8 * R * np.abs(F).max())


def test_parts_of_contact_and_film_add_up():
    model = build_model(bearing(asperity=ASPERITY))
    frictionless = build_model(
        bearing(
            asperity=ehd.GreenwoodTripp(composite_roughness=SIGMA, composite_modulus=5e10, friction_coefficient=0.0)
        )
    )
    motion = at(0.97, 1.0)
    q, q0 = model.evaluate(motion).quantities(), frictionless.evaluate(motion).quantities()
    assert q["contact_load"] == q0["contact_load"] > 0.0
    assert q["contact_torque"] < 0.0 < q["contact_power_loss"]
    assert q0["contact_torque"] == q0["contact_power_loss"] == 0.0
    assert q["friction_torque"] - q["contact_torque"] == pytest.approx(q0["friction_torque"], rel=1e-12)
    assert q["power_loss"] - q["contact_power_loss"] == pytest.approx(q0["power_loss"], rel=1e-12)
    assert q["contact_power_loss"] == pytest.approx(-q["contact_torque"] * SPEED, rel=1e-12)


@pytest.mark.parametrize("in_cells", [False, True], ids=["on vertices", "in cells"])
@pytest.mark.parametrize(
    "options", [{"asperity": ASPERITY}, {"contact": ehd.RegularisedWall(onset=1e-6)}], ids=["asperity", "wall"]
)
def test_surfaces_that_part_and_meet_again(options, in_cells):
    """Nothing of an earlier contact stays behind.

    Every state is that of a fresh model, far films those of smooth surfaces, to Newton's rounding.
    """
    options = {"cavitation": ehd.SwiftStieber(line_in_cells=in_cells), **options}
    error = 1e-12

    def require_same(a, b):
        assert np.abs(a.wrench - b.wrench).max() <= error * np.abs(b.wrench).max()
        assert np.abs(a.tangent() - b.tangent()).max() <= error * np.abs(b.tangent()).max()

    touching, apart = at(0.99, tilt=(1e-5, 0.0)), at(0.5, 2.0)
    model = build_model(bearing(**options))
    for motion in (touching, apart, touching, apart):
        fresh = build_model(bearing(**options)).evaluate(motion)
        evaluation = model.evaluate(motion)
        require_same(evaluation, fresh)
        for found, expected in zip(evaluation.quantities().values(), fresh.quantities().values(), strict=True):
            # small ones are differences of large ones
            assert found == pytest.approx(expected, rel=1e3 * error, abs=0.0)
        assert (evaluation.quantities()["contact_load"] > 0.0) == (motion is touching)
    assert not model.parts.contacts.P[0].any()
    require_same(evaluation, build_model(bearing(cavitation=options["cavitation"])).evaluate(apart))


def test_coulomb_friction_above_the_transition_speed():
    """Torque mu_b R sum(p dA) in the limit of fast sliding.

    (v0/v)^2 / 2 = 3e-6 below it, e/R = 1e-3 from the lever arm.
    """
    motion = at(0.98)
    evaluation = contact_only(motion)
    normal = evaluation.film.pressing.integrals[0, 4] * R**2
    assert -evaluation.quantities()["contact_torque"] == pytest.approx(0.08 * R * normal, rel=2e-3)


def test_contact_is_conservative():
    """Work of the contact's pressures around a closed path of position and tilt vanishes.

    Their potential is a function of the pose.

    Trapezoidal rule on a smooth closed path of 400 points: converges faster than any power; 1e-6 of the work one way.
    """
    model = build_model(bearing(lubricant=ehd.Lubricant(viscosity=1e-12), asperity=ASPERITY, squeeze=False))
    s = np.linspace(0, 2 * np.pi, 401)
    path = np.stack([0.97 * C + 0.02 * C * np.cos(s), 0.1 * C * np.sin(s), 2e-5 * np.cos(2 * s), 1e-5 * np.sin(s)])
    wrench = np.array([model.evaluate(np.array([*p, 0, 0, 0, 0, 0, 0])).wrench for p in path.T])
    # Generalised forces to (x, y, bx, by): F_x, F_y, M_y, -M_x.
    forces = np.stack([wrench[:, 0], wrench[:, 1], wrench[:, 4], -wrench[:, 3]])
    steps = np.diff(path, axis=1)
    work = np.sum(0.5 * (forces[:, 1:] + forces[:, :-1]) * steps)
    assert abs(work) < 1e-6 * np.sum(np.abs(0.5 * (forces[:, 1:] + forces[:, :-1]) * steps))


def test_a_journal_pressed_into_the_bore_finds_its_place():
    """A load far beyond the film's at a crawl: contact carries it, the nominal gap is negative at its smallest."""
    result = ehd.stribeck(bearing(asperity=ASPERITY), load=30e3, speeds=[0.01])
    carried = math.hypot(result.contact_load_share[0], result.contact_torque[0] / (R * 30e3))  # pressure and friction
    assert carried == pytest.approx(1.0, abs=0.02)
    assert result.minimum_gap[0] < 0.0


def test_contact_supports_a_standing_journal():
    """No speed, no film pressure: the load is the contact's, without friction torque."""
    q = build_model(bearing(asperity=ASPERITY)).evaluate(at(1.0, speed=0.0)).quantities()
    assert q["contact_load"] > 0.0 and q["contact_torque"] == 0.0 and q["peak_pressure"] == 0.0


def test_wear_grows_by_archard():
    """One step: k p v dt at every vertex to rounding, told as the largest depth and the volume at its end."""
    rate, step = 1e-13, 1e-3
    model = build_model(bearing(asperity=ASPERITY, wear=ehd.ArchardWear(wear_rate=rate)))
    motion = at(0.98, axial=1.0)
    start = model.initial_history(motion)
    assert start.wear.shape == model.grid.shape and not start.wear.any()
    evaluation = model.evaluate(motion, start, step)
    told, after = evaluation.quantities(), evaluation.history()
    depth = rate * model.parts.contacts.P[0] * math.hypot(R * SPEED, 1.0) * step
    np.testing.assert_allclose(after.wear * C, depth, rtol=1e-13)
    assert told["wear_depth"] == pytest.approx(depth.max(), rel=1e-13)
    assert told["worn_volume"] == pytest.approx(R**2 * np.sum(depth * model.grid.weight), rel=1e-13)
    assert "worn_volume" not in build_model(bearing(asperity=ASPERITY)).evaluate(motion).quantities()
    assert not start.wear.any()
    accelerated = build_model(bearing(asperity=ASPERITY, wear=ehd.ArchardWear(wear_rate=rate / 1e3, acceleration=1e3)))
    other = accelerated.evaluate(motion, accelerated.initial_history(motion), step).history()
    np.testing.assert_allclose(other.wear, after.wear, rtol=1e-12)


def test_wear_relieves_the_contact():
    """The contact pressure at a held position falls as the bore wears, and the wear never shrinks."""
    model = build_model(bearing(asperity=ASPERITY, wear=ehd.ArchardWear(wear_rate=1e-11)))
    motion, history, loads, worn = at(0.99), None, [], 0.0
    history = model.initial_history(motion)
    for _ in range(30):
        evaluation = model.evaluate(motion, history, 1e-3)
        loads.append(evaluation.quantities()["contact_load"])
        history = evaluation.history()
        assert np.all(history.wear >= worn)
        worn = history.wear
    assert np.all(np.diff(loads) < 0.0) and loads[-1] < 0.9 * loads[0]


def test_history_enters_at_the_start_of_the_step_only():
    """Evaluating again from the same history gives the same film: a rejected step leaves nothing behind."""
    model = build_model(bearing(asperity=ASPERITY, wear=ehd.ArchardWear(wear_rate=1e-10)))
    motion = at(0.98)
    history = model.evaluate(motion, model.initial_history(motion), 1e-3).history()
    first = model.evaluate(motion, history, 1e-3).wrench
    model.evaluate(at(0.5), history, 1e-3)
    again = model.evaluate(motion, history, 1e-3).wrench
    assert np.abs(again - first).max() < 1e-12 * np.abs(first).max()


def test_minimum_gap_with_a_profile():
    """Oval bore and concentric journal: c - amplitude at a vertex.

    With an eccentric one the least of all vertices and links.
    """
    amplitude = 3e-6
    oval = bearing(profile=ehd.OutOfRound(order=2, amplitude=amplitude))
    assert build_model(oval).evaluate(at(0.0)).quantities()["minimum_gap"] == pytest.approx(C - amplitude, rel=1e-12)
    q = build_model(oval).evaluate(at(0.6, 0.7)).quantities()
    theta = np.linspace(0, 2 * np.pi, 100001)
    exact = np.min(C - 0.6 * C * np.cos(theta - 0.7) + amplitude * np.cos(2 * theta))
    # A vertex or link lies within 1/256 turn of the minimum, 0.5 (0.6 + 4 * 0.15) (2 pi / 256)^2 c = 4e-4 c, and the
    # profile on links is the mean of both vertices, 0.5 * 0.6 (2 pi / 128)^2 c = 7e-4 c.
    assert q["minimum_gap"] == pytest.approx(exact, abs=1.1e-3 * C)


def test_a_crowned_journal_carries_less_but_tilts_more():
    plain, crowned = build_model(bearing()), build_model(bearing(profile=ehd.Crown(drop=5e-6)))
    assert crowned.evaluate(at(0.8)).wrench[0] > plain.evaluate(at(0.8)).wrench[0]
    tilted = at(0.3, tilt=(1.6 * C / L, 0.0))
    assert plain.evaluate(tilted).status is ehd.Status.NO_FILM
    assert crowned.evaluate(tilted).status is ehd.Status.CONVERGED


def test_lobes_balance_the_torque():
    """The bore's torque holds e x F and the pressure on its lobes: torque about the journal's own axis, from the
    wrench and from the shear on the journal. Concentric in an oval bore: friction on both surfaces is the same.
    """
    model = build_model(bearing(profile=ehd.OutOfRound(order=2, amplitude=4e-6)))
    q = model.evaluate(at(0.0)).quantities()
    assert q["friction_torque"] == pytest.approx(-q["friction_torque_bush"], rel=1e-12)
    for motion in (at(0.5, 1.0), at(0.5, 2.0, tilt=(1e-4, 2e-4))):
        evaluation = model.evaluate(motion)
        f = evaluation.wrench
        x, y, bx, by = motion[:4]
        own = f[5] - (x * f[1] - y * f[0] - bx * f[3] - by * f[4])
        assert evaluation.quantities()["friction_torque"] == pytest.approx(own, rel=1e-12)


def test_loss_of_a_lobed_film_is_that_of_viscous_flow():
    """Power into the film = Couette + Poiseuille dissipation, summed over links without any use of forces.

    1 % of discretisation.
    """
    options = {"profile": ehd.OutOfRound(order=3, amplitude=4e-6), "cavitation": ehd.FullSommerfeld()}
    model = build_model(bearing(film=ehd.FiniteLength(n_theta=192, n_z=16), **options))
    q = model.evaluate(at(0.5)).quantities()
    s, g, p = model.solver, model.grid, model.solver.pressure * model.scales.pressure
    c, mu = C, 0.03
    shear = float(np.sum(mu * (R * SPEED) ** 2 / (s.H * c) * g.weight)) * R**2
    flow = (c**3 / (12 * mu)) * (
        float(np.sum(s.system.kx * (np.roll(p, -1, axis=0) - p) ** 2))
        + float(np.sum(s.system.kz[:, :-1] * np.diff(p, axis=1) ** 2))
    )
    assert q["power_loss"] == pytest.approx(shear + flow, rel=1e-2)


def test_liner_history_relaxes():
    """A liner's film under a held position approaches the steady one, and the first step lies between."""
    model = build_model(bearing(bush=ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e9)))
    motion = at(0.8)
    steady = model.evaluate(motion).wrench
    history = model.initial_history(at(0.3))
    first = model.evaluate(motion, history, 1e-4)
    history = first.history()
    assert np.linalg.norm(first.wrench[:2] - steady[:2]) > 0.05 * np.linalg.norm(steady[:2])
    for _ in range(200):
        evaluation = model.evaluate(motion, history, 1e-3)
        history = evaluation.history()
    np.testing.assert_allclose(evaluation.wrench, steady, atol=1e-8 * np.abs(steady).max())


def test_liner_mass_balance():
    """Oil pressed out by a step = leakage: the film's content changes by inflow only.

    To 1e-10 of the flow through the gap.
    """
    model = build_model(
        bearing(bush=ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e9), cavitation=ehd.FullSommerfeld())
    )
    motion = at(0.5)
    history = model.initial_history(at(0.4))
    evaluation = model.evaluate(motion, history, 1e-3)
    s = model.solver
    inflow = float(s.inflow().sum())
    stored = float(np.sum(s.H_t * s.area))
    assert inflow == pytest.approx(stored, abs=1e-10 * 0.5 * SPEED)
    assert evaluation.status is ehd.Status.CONVERGED


THINNING = {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.6, residual=0.1)}
THICKENING = {"pressure_law": ehd.BarusPressure(coefficient=1e-7)}


@pytest.mark.parametrize("laws", [{}, THICKENING, THINNING], ids=["constant", "barus", "carreau"])
@pytest.mark.parametrize(
    "cavitation", [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber()], ids=lambda c: type(c).__name__
)
def test_damping_on_a_liner_follows_slow_motions(cavitation, laws):
    """Force of a slowly moving journal minus the steady one.

    By a long step of the transient film, against the damping columns.

    A step of 10 s at 1 nm/s moves by 5e-4 c; relaxation within 1 ms leaves 1e-4. The film alone, without the liner's
    rate, would miss more than a tenth.
    """
    oil = ehd.Lubricant(viscosity=0.03, **laws)
    liner = ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e9)
    model = build_model(bearing(bush=liner, cavitation=cavitation, lubricant=oil))
    steady, step = at(0.8, 0.3), 10.0
    evaluation = model.evaluate(steady)
    damping, film_alone = evaluation.tangent(slow_motion=True)[:, 4:8], evaluation.tangent()[:, 4:8]
    for k, v in ((0, 1e-9), (1, 1e-9), (2, 1e-7), (3, 1e-7)):
        force = []
        for sign in (1, -1):
            before, now = steady.copy(), steady.copy()
            before[k] -= sign * v * step
            now[4 + k] = sign * v
            force.append(model.evaluate(now, model.initial_history(before), step).wrench)
        difference = (force[0] - force[1]) / (2 * v)
        size = np.abs(damping[:5, k]).max()
        np.testing.assert_allclose(difference[:5], damping[:5, k], atol=5e-3 * size)
        assert np.abs(film_alone[:5, k] - damping[:5, k]).max() > 0.05 * size


CLASSIC = {"film": ehd.ClassicSOR(), "cavitation": ehd.Gumbel()}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"wear": ehd.ArchardWear(wear_rate=1e-15)}, "needs a contact pressure"),
        ({"asperity": ASPERITY, "contact": ehd.RegularisedWall(onset=1e-6)}, "exclude each other"),
        ({"asperity": ASPERITY, "roughness": ehd.PatirCheng(composite_roughness=1e-6)}, "must equal"),
        ({"roughness": ehd.PatirCheng(composite_roughness=6e-6)}, "quarter of the radial clearance"),
        ({"bush": LINER, "film": ehd.ShortBearing()}, "ShortBearing"),
        (
            {
                "roughness": ehd.PatirCheng(composite_roughness=SIGMA),
                "film": ehd.ClassicSOR(),
                "cavitation": ehd.Gumbel(),
            },
            "ClassicSOR.*without roughness",
        ),
        (
            {"turbulence": ehd.NgPan(), "film": ehd.ClassicSOR(), "cavitation": ehd.Gumbel()},
            "ClassicSOR.*without roughness",
        ),
        (
            {
                "lubricant": ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson()),
                "film": ehd.ImpedanceMap(),
            },
            "density_law must be None with film=ImpedanceMap",
        ),
    ],
)
def test_combinations_are_refused_when_described(options, message):
    with pytest.raises(ehd.InputError, match=message):
        bearing(**options)


def test_profile_that_closes_the_gap_is_refused():
    with pytest.raises(ehd.InputError, match="closes the gap"):
        build_model(bearing(profile=ehd.Crown(drop=-25e-6)))


@pytest.mark.parametrize("name", ["asperity", "roughness", "profile", "wear", "bush"])
def test_options_are_objects(name):
    with pytest.raises(ehd.InputError, match=f"JournalBearing.{name}"):
        bearing(**{name: "yes"})


def test_roughness_without_contact_ends_where_the_gap_does():
    model = build_model(bearing(roughness=ehd.PatirCheng(composite_roughness=SIGMA)))
    assert model.evaluate(at(0.99)).status is ehd.Status.CONVERGED
    assert model.evaluate(at(1.001)).status is ehd.Status.NO_FILM
