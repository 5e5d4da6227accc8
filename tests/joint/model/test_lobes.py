"""Bores of several arcs: lobes with preload, pressure dams, and the effects that they may have."""

import math
import types
from dataclasses import replace

import exudyn as exu
import matplotlib.pyplot as plt
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.heat.power import OilFlows
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.pictures.files import film_mesh
from exudyn_ehd.pictures.maps import on_picture
from tests.reference.arc_film import arc_film
from tests.sampling import sample

R, C, MU = 0.025, 25e-6, 0.02
OIL, HOT = ehd.Lubricant(viscosity=MU), ehd.oil("ISO VG 46")
ASPERITY = ehd.GreenwoodTripp(composite_roughness=8e-7, composite_modulus=1e11)
LINER = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)
OUT_OF_ROUND = (ehd.OutOfRound(order=3, amplitude=3e-6), ehd.Crown(drop=2e-6))


def bearing_of(arcs, *, length=R, lubricant=OIL, **options):
    return ehd.JournalBearing(
        journal_radius=R, length=length, radial_clearance=C, lubricant=lubricant, arcs=arcs, **options
    )


def random_scene(rng):
    """Two to four lobes, a length, and a motion with tilt and squeeze, both ways around."""
    count, width, first = int(rng.integers(2, 5)), math.radians(rng.uniform(5.0, 30.0)), rng.uniform(0.0, 6.2)
    pressure, spacing = rng.uniform(0.0, 2e5) * rng.integers(0, 2), 2.0 * math.pi / count
    lobe = ehd.Arc(
        start=0.0, extent=spacing - width, leading_pressure=pressure, trailing_pressure=pressure,
        preload=rng.uniform(0.1, 0.75), offset=rng.uniform(0.3, 1.0),
    )  # fmt: skip
    arcs = tuple(replace(lobe, start=math.remainder(first + k * spacing, 2.0 * math.pi)) for k in range(count))
    length, angle, e = R * rng.uniform(0.6, 2.0), rng.uniform(0.0, 6.2), C * rng.uniform(0.3, 0.8)
    tilt, rates = rng.uniform(-0.1, 0.1, 2) * (C - e) / length, rng.uniform(-0.05, 0.05, 2) * C * 300.0
    spin = 300.0 * rng.choice([-1.0, 1.0])
    return arcs, length, np.array([e * math.cos(angle), e * math.sin(angle), *tilt, *rates, 0.0, 0.0, spin, 0.0])


def reference(arcs, motion, length=R, shape=(161, 51)):
    """Force, torque and peak pressure of the independent films on all arcs."""
    films = [
        arc_film(
            motion, radius=R, length=length, clearance=C, viscosity=MU, start=arc.start, extent=arc.extent,
            edges=arc.pressures, preload=arc.preload, offset=arc.offset, shape=shape,
        )
        for arc in arcs
    ]  # fmt: skip
    return sum(f for f, _, _ in films), sum(t for _, t, _ in films), max(p for _, _, p in films)


@pytest.mark.parametrize("seed", sample(range(10), 0, 1, 2))
def test_lobes_against_an_independent_solution(seed):
    """Force within 0.5 %, torque within 0.1 %, peak within 1 %."""
    arcs, length, motion = random_scene(np.random.default_rng((3, seed)))
    found = build_model(bearing_of(arcs, length=length)).evaluate(motion)
    force, torque, peak = reference(arcs, motion, length)
    q = found.quantities()
    assert np.linalg.norm(found.wrench[:2] - force) < 5e-3 * np.linalg.norm(force)
    assert q["friction_torque"] == pytest.approx(torque, rel=1e-3)
    assert q["peak_pressure"] == pytest.approx(peak, rel=1e-2)


@pytest.mark.parametrize("depth", sample([0.5 * C, 3.0 * C], 1))
def test_a_dam_against_an_independent_solution(depth):
    """Force within 0.5 %, torque and peak within 1 % of the reference, which is extrapolated from two grids."""
    arc = ehd.Arc(start=0.2, extent=2.8, dam=ehd.Dam(depth=depth, length=0.03, extent=2.1))
    motion = np.array([0.09 * C, -0.29 * C, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 300.0, 0.0])
    found = build_model(bearing_of((arc,), length=0.05)).evaluate(motion)
    size = {"radius": R, "length": 0.05, "clearance": C, "viscosity": MU, "start": 0.2, "extent": 2.8}
    coarse, fine = (arc_film(motion, **size, dam=(depth, 0.03, 2.1), shape=n) for n in ((121, 41), (241, 81)))
    force, torque, peak = (2.0 * b - a for a, b in zip(coarse, fine, strict=True))
    q = found.quantities()
    assert np.linalg.norm(found.wrench[:2] - force) < 5e-3 * np.linalg.norm(force)
    assert q["friction_torque"] == pytest.approx(torque, rel=1e-2)
    assert q["peak_pressure"] == pytest.approx(peak, rel=1e-2)


def test_the_pressure_on_the_sides_of_a_dam():
    """The journal's axial force is half of the pressure times the slope of the gap: the bore's part less the journal's.

    The sides of the dam are slopes of the bore, with the mean pressure of their two rows; the default grid within 4 %.
    """
    arc = ehd.Arc(start=3.4, extent=2.4, dam=ehd.Dam(depth=2.0 * C, length=0.6 * R))
    motion = np.array([0.0, -0.4 * C, 0.0, -0.3 * C / R, 0.0, 0.0, 0.0, 0.0, 300.0, 0.0])
    forces = []
    for film in (ehd.FiniteLength(), ehd.FiniteLength(n_theta=256, n_z=48)):
        found = build_model(bearing_of((arc,), film=film)).evaluate(motion)
        P, g = found.film.oil.P * found.film.scales.pressure, found.film.grid
        rise = C * np.diff(found.model.effects.lobes.values, axis=1)
        sides = R * float(g.weight[:, 0] / g.weight_z[0] @ (0.5 * (P[:, 1:] + P[:, :-1]) * rise).sum(axis=1))
        journal = -motion[3] * R**2 * float(np.sum(g.weight * P * np.sin(g.x)[:, None]))
        assert found.wrench[2] == pytest.approx(0.5 * (sides - journal), rel=1e-9)
        forces.append(found.wrench[2])
    assert abs(forces[1]) > 0.1 * abs(sides)
    assert forces[0] == pytest.approx(forces[1], rel=4e-2)


def test_one_arc_without_preload_is_the_arc_itself():
    """To the last bit, wherever its offset would be."""
    arc, motion = ehd.Arc(start=3.4, extent=2.3, leading_pressure=1e5), np.zeros(10)
    motion[:2], motion[8] = (-0.2 * C, -0.6 * C), 300.0
    same = [build_model(bearing_of((), arc=arc)), build_model(bearing_of((replace(arc, offset=0.9),)))]
    one, other = (model.evaluate(motion) for model in same)
    assert np.array_equal(one.wrench, other.wrench) and np.array_equal(one.tangent(), other.tangent())
    assert one.quantities() == other.quantities()


@pytest.mark.parametrize(
    "options", [{}, {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)}, {"profile": OUT_OF_ROUND}], ids=str
)
def test_two_arcs_are_the_sum_of_two_bearings(options):
    """Wrench, tangent, friction, leakage and flows at the edges, to rounding."""
    arcs = tuple(replace(a, leading_pressure=2e5, trailing_pressure=1e5) for a in ehd.two_lobe(preload=0.4, angle=0.3))
    motion = np.array([0.3 * C, -0.4 * C, 3e-5, -2e-5, 2e-4, -1e-4, 0.0, 0.0, 300.0, 0.0])
    models = [build_model(bearing_of(part, **options)) for part in (arcs, arcs[:1], arcs[1:])]
    history = [model.initial_history(motion) for model in models]
    step = 0.0 if history[0] is None else 1e-4
    whole, one, other = (m.evaluate(motion, h, step) for m, h in zip(models, history, strict=True))
    scale = np.abs(whole.wrench).max(), np.abs(whole.tangent()).max(axis=0)
    assert np.abs(whole.wrench - one.wrench - other.wrench).max() < 1e-12 * scale[0]
    assert (np.abs(whole.tangent() - one.tangent() - other.tangent()) / scale[1]).max() < 1e-9
    for name in ("friction_torque", "leakage", "supply_flow"):
        parts = sum(e.quantities()[name] for e in (one, other))
        assert whole.quantities()[name] == pytest.approx(parts, rel=1e-10), name


KEPT = ehd.ElrodAdams(cavity_pressure=-1e5)
FIELD = ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13, across=2)
CARREAU = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)
CASES = {
    "FullSommerfeld": {"cavitation": ehd.FullSommerfeld()},
    "Gumbel": {"cavitation": ehd.Gumbel()},
    "line in the cells": {},
    "line on vertices": {"cavitation": ehd.SwiftStieber(line_in_cells=False)},
    "ElrodAdams": {"cavitation": KEPT},
    "pressure law": {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=ehd.BarusPressure(coefficient=1e-8))},
    "shear law": {"lubricant": ehd.Lubricant(viscosity=MU, shear_law=CARREAU)},
    "wall": {"contact": ehd.RegularisedWall(onset=3e-6)},
    "turbulent": {"turbulence": ehd.NgPan()},
    "profile, pressure at the ends": {"profile": OUT_OF_ROUND, "end_pressures": (1e5, 2e5)},
    "wear": {"asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-12)},
    "liner, pressure at the ends": {"bush": LINER, "end_pressures": (1e5, 2e5)},
    "liner, contact, oil kept": {"bush": LINER, "asperity": ASPERITY, "cavitation": KEPT},
    "one temperature": {"lubricant": HOT, "thermal": ehd.LumpedThermal(supply_temperature=313.0)},
    "temperatures": {"lubricant": HOT, "thermal": FIELD},
}  # fmt: skip
LOBES = tuple(
    replace(arc, leading_pressure=3e5, trailing_pressure=1.5e5)
    for arc in ehd.two_lobe(preload=0.4, offset=0.7, angle=0.3)
)
DAM = ehd.pressure_dam(depth=40e-6, step_angle=math.radians(140.0), length=0.7 * R, track_length=0.3 * R, pressure=1e5)


@pytest.mark.parametrize("arcs", [LOBES, DAM], ids=["lobes", "dam"])
@pytest.mark.parametrize("name", CASES)
def test_tangent_against_differences(name, arcs):
    """1e-5 of the wrench, at random motions of both spins in a second step.

    With a dam 5e-5: the short links at its sides cost a digit of the pressures.
    """
    rng = np.random.default_rng(7)
    model = build_model(bearing_of(arcs, **CASES[name]))
    size = np.array([C, C, C / R, C / R, 300 * C, 300 * C, 300 * C / R, 300 * C / R, 300.0, 1.0])
    for spin in (300.0, -300.0):
        angle, e = rng.uniform(0.0, 6.2), 0.6 * C
        motion = np.array([e * math.cos(angle), e * math.sin(angle), *rng.uniform(-1.0, 1.0, 8) * 0.05 * size[2:]])
        motion[8] = spin
        history, step = model.initial_history(motion), 0.0
        if history is not None:
            step, history = 1e-4, model.evaluate(motion, history, 1e-4).history()
        found = model.evaluate(motion, history, step)
        tangent, wrench = found.tangent() * size, np.abs(found.wrench)
        differences = np.empty((6, 10))
        for k, h in enumerate(1e-6 * size):
            beside = [model.evaluate(motion + way * h * np.eye(10)[k], history, step).wrench for way in (1.0, -1.0)]
            differences[:, k] = (beside[0] - beside[1]) / (2.0 * h) * size[k]
        scale = np.array(
            [wrench[:2].max()] * 2 + [wrench[2] + 1e-3 * wrench[:2].max()] + [wrench[3:5].max()] * 2 + [wrench[5]]
        )
        assert (np.abs(tangent - differences) / scale[:, None]).max() < (5e-5 if arcs is DAM else 1e-5)


@pytest.mark.parametrize("options", [{}, {"cavitation": KEPT}, {"bush": LINER}], ids=str)
@pytest.mark.parametrize("arcs", [LOBES, DAM], ids=["lobes", "dam"])
@pytest.mark.parametrize("spin", [300.0, -300.0])
def test_the_moment_is_that_of_shear_and_force(options, arcs, spin):
    """About its own axis the journal feels friction alone: the pressures of grooves act on their walls in the bore."""
    for tilt in ((0.0, 0.0), (2e-4, -1e-4)):
        film = ehd.steady(bearing_of(arcs, **options), speed=spin, eccentricity_ratio=0.5, direction=-1.9, tilt=tilt)
        (x, y, bx, by), (fx, fy, _), (mx, my, mz) = film.motion[:4], film.force, film.moment
        own = mz - (x * fy - y * fx) + bx * mx + by * my
        assert own == pytest.approx(film.friction_torque, rel=1e-9)
        assert film.power_loss == pytest.approx(-own * spin, rel=1e-9)


def test_gap_around_a_concentric_journal():
    """Assembled clearance at the nearest points, machined clearance a right angle off; a dam's depth up to its step."""
    model = build_model(bearing_of(ehd.three_lobe(preload=0.6, offset=0.7)))
    motion = np.zeros(10)
    motion[8] = 300.0
    found = model.evaluate(motion)
    assert found.minimum_gap == pytest.approx(C, rel=1e-3)
    arcs, film = model.bearing.bore_arcs, found.film
    for arc, (first, last) in zip(arcs, film.grid.edges, strict=True):
        for H, theta in ((film.solver.H, film.grid.x), (film.solver.HF, film.grid.x_face)):
            nearest = arc.start + 0.7 * arc.extent
            gap = C / 0.4 - 0.6 * C / 0.4 * np.cos(theta[first : last + 1] - nearest)
            np.testing.assert_allclose(C * H[first : last + 1, 3], gap, rtol=1e-12)
    film = build_model(bearing_of(DAM)).evaluate(motion).film
    depth, step = C * (film.solver.HF - 1.0), math.radians(140.0)
    inside = np.outer(film.grid.x_face < step, np.abs(film.grid.z) < 0.35)
    track = np.outer(film.grid.x_face % (2.0 * math.pi) > math.pi, np.abs(film.grid.z) < 0.15)
    upper = (film.grid.x_face > 0.0) & (film.grid.x_face < math.pi)
    expected = np.where(upper[:, None], inside, track)
    np.testing.assert_allclose(depth, 40e-6 * expected, atol=1e-15)


def test_equilibrium_stiffness_and_damping_against_the_independent_solution():
    """K and C within 1 % of their largest entry; the journal lies beyond the clearance, towards a groove."""
    arcs = ehd.two_lobe(preload=0.7)
    rest = ehd.equilibrium(bearing_of(arcs), speed=314.0, load=(0.0, -3e3))
    assert rest.eccentricity_ratio > 1.0
    motion = rest.film.motion

    def force(k, h):
        return reference(arcs, motion + h * np.eye(10)[k], shape=(121, 41))[0]

    assert np.linalg.norm(force(0, 0.0) - (0.0, 3e3)) < 15.0
    for matrix, first, h in ((rest.stiffness, 0, 1e-3 * C), (rest.damping, 4, 0.3 * C)):
        found = np.column_stack([(force(first + k, -h) - force(first + k, h)) / (2.0 * h) for k in (0, 1)])
        assert np.abs(matrix[:2, :2] - found).max() < 1e-2 * np.abs(found).max()


@pytest.mark.parametrize("number", range(12))
def test_usual_bearings_carry_usual_loads(number):
    """Down to 45 degrees beside it, up to half of the reference force, both closures, with and without heat."""
    rng = np.random.default_rng((9, number))
    width, pressure, kind = math.radians(rng.uniform(0.0, 40.0)), rng.choice([0.0, 2e5]), number % 4
    arcs = (
        ehd.two_lobe(preload=rng.uniform(0.0, 0.8), width_angle=width, pressure=pressure),
        ehd.three_lobe(preload=rng.uniform(0.0, 0.8), width_angle=width, pressure=pressure),
        ehd.offset_halves(preload=rng.uniform(0.1, 0.7), width_angle=width, pressure=pressure),
        ehd.pressure_dam(depth=C * rng.uniform(0.5, 6.0), step_angle=2.4, length=0.7 * R, width_angle=width),
    )[kind]
    options = {"cavitation": ehd.ElrodAdams()} if rng.integers(2) else {}
    if rng.integers(2):
        options |= {"lubricant": HOT, "thermal": ehd.FilmEnergy(supply_temperature=313.0, carry_over=0.8)}
    bearing = bearing_of(arcs, **options)
    size, angle = bearing.reference_force(314.0) * 10.0 ** rng.uniform(-2.0, -0.3), rng.uniform(-2.35, -0.8)
    load = size * np.array([math.cos(angle), math.sin(angle)])
    rest = ehd.equilibrium(bearing, speed=314.0, load=tuple(load))
    assert np.linalg.norm(rest.film.force[:2] + load) < 1e-6 * size
    assert np.isfinite(rest.stiffness).all() and np.isfinite(rest.damping).all()


@pytest.mark.parametrize("closure", [ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5), ehd.Gumbel()], ids=repr)
@pytest.mark.parametrize("across", [1, 2])
def test_heat_and_the_oil_that_grooves_mix(closure, across):
    """All heat is carried away; both sides of a groove have the temperature of hot and fresh oil mixed."""
    thermal = ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13, across=across, carry_over=0.8)
    model = build_model(bearing_of(ehd.two_lobe(preload=0.4), lubricant=HOT, thermal=thermal, cavitation=closure))
    motion = np.zeros(10)
    motion[:2], motion[8] = (0.1 * C, -0.55 * C), 300.0
    film = model.evaluate_steady(motion, settled_history(model, motion)).film
    T = np.asarray(film.temperature)
    found = model.effects.thermal.balance(film, film.history.temperature)
    assert found["heat_in"] > 50.0
    assert found["convected"] + found["conducted"] == pytest.approx(found["heat_in"], rel=1e-9)
    # inside, as the ends are fed from outside; the flows of the settled film
    flows, inner, edges = OilFlows(film, 0.8), slice(1, -1), film.grid.edges
    for (_, last), (first, _) in zip(edges, np.roll(edges, -1, axis=0), strict=True):
        both = T[[last, first], inner]
        assert np.ptp(both) < 1e-2
        arrives = flows.x[last - 1, inner]
        hot, total = float(arrives @ (T[last - 1, inner] - 313.0)), float(arrives.sum())
        fresh = max(0.0, float(flows.outside[[last, first], inner].sum())) + (1.0 / 0.8 - 1.0) * total
        if across == 1:
            assert both.mean() - 313.0 == pytest.approx(hot / (total + fresh), rel=0.1)
        assert 0.0 < both.mean() - 313.0 < T[last - 1, inner].mean() - 313.0


def test_wear_stays_on_the_arcs():
    bearing = bearing_of(ehd.two_lobe(preload=0.3), asperity=ASPERITY, wear=ehd.ArchardWear(wear_rate=1e-12))
    model, motion = build_model(bearing), np.zeros(10)
    motion[:2], motion[8] = (0.0, -0.97 * C), 30.0
    history = model.initial_history(motion)
    for _ in range(3):
        history = model.evaluate(motion, history, 10.0).history()
    upper, lower = (history.wear[first : last + 1] for first, last in model.grid.edges)
    assert upper.max() == 0.0 < lower.max()


def rotor_in(bearing, gravity):
    """System with a rotor in one bearing, not assembled; its container, joint and the load, N."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.CreateGround()
    inertia = InertiaCylinder(7800.0, 0.3, 0.05, 2)
    spin = [0.0, 0.0, 314.0]
    rotor = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=spin, gravity=[0.0, -gravity, 0.0])
    joint = ehd.CreateLubricatedJoint(
        mbs, name="lobes", itemNumbers=[ground, rotor], position=[0.0, 0.0, 0.0], axis=[0.0, 0.0, 1.0], bearing=bearing,
        tilt=ehd.Held(), axial=ehd.Held(),
    )  # fmt: skip
    mbs.Assemble()
    return container, mbs, joint, (0.0, -gravity * inertia.mass)


def run(mbs, end, steps):
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
    settings.timeIntegration.verboseMode = 0
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)


@pytest.mark.parametrize("arcs", sample(map(pytest.param, (ehd.two_lobe(preload=0.5), DAM)), 0), ids=["lobes", "dam"])
def test_a_rotor_in_exudyn_comes_to_rest(arcs):
    """Its position is that of `equilibrium`, within 0.5 % of the clearance; the renderer leaves the grooves out."""
    bearing = bearing_of(arcs)
    container, mbs, joint, load = rotor_in(bearing, 60.0)
    run(mbs, 0.15, 500)
    rest = ehd.equilibrium(bearing, speed=314.0, load=load)
    assert np.abs(joint.history.eccentricity[-1] - rest.position[:2]).max() < 5e-3 * C
    scene, (n, m) = container.renderer.GetGraphicsData(), joint.film().pressure.shape
    own = scene["triangles"]["items"][:, 2] == int(joint.objectNumber)
    own &= scene["triangles"]["items"][:, 1] == int(exu.ItemType.Object)
    # bore, two ends of the film, three sides of the housing's ring; two columns have none behind them
    assert own.sum() == 2 * (n - 2) * (m - 1 + 2 + 3)
    points = np.asarray(scene["triangles"]["points"])[own].reshape(-1, 3)
    assert np.abs(np.abs(np.arctan2(points[:, 1], points[:, 0])) % math.pi).min() > math.radians(9.0)


def test_a_journal_beyond_the_clearance():
    """It starts where `equilibrium` has it, towards a groove, stays there, and `SolveEquilibrium` finds it there."""
    bearing = bearing_of(ehd.two_lobe(preload=0.7))
    _, mbs, joint, load = rotor_in(bearing, 160.0)
    rest = ehd.equilibrium(bearing, speed=314.0, load=load)
    assert rest.eccentricity_ratio > 1.1
    found = ehd.SolveEquilibrium(mbs, 314.0)
    assert float(np.ravel(found.eccentricity_ratio)[0]) == pytest.approx(rest.eccentricity_ratio, rel=1e-6)
    joint.place_in_equilibrium(load=load)
    run(mbs, 0.01, 50)
    assert np.abs(joint.history.eccentricity - rest.position[:2]).max() < 1e-3 * C


def test_pictures_leave_the_grooves_out():
    arcs = ehd.three_lobe(preload=0.5, width_angle=0.4)
    film = ehd.steady(bearing_of(arcs), speed=300.0, eccentricity_ratio=0.5, direction=4.5)
    values = on_picture(film, film.pressure)
    angles = np.linspace(0.0, 2.0 * math.pi, len(values))
    inside = np.zeros(len(values), bool)
    for arc in arcs:
        inside |= (angles - arc.start) % (2.0 * math.pi) <= arc.extent
    assert np.array_equal(~np.isnan(values[:, 60]), inside)
    assert np.nanmax(values) == pytest.approx(film.pressure.max(), rel=1e-2)
    for name in ("pressure", "gap"):
        axes = getattr(film, f"plot_{name}")().axes[0]
        assert axes.get_xlim() == pytest.approx((0.0, 360.0))
        assert "no bore" in axes.get_legend_handles_labels()[1]
    film.plot_bearing()
    plt.close("all")
    points, [(_, quads)], _ = film_mesh(_as_joint_film(film))
    assert len(quads) == (film.theta.size - 3) * (film.z.size - 1)
    # no facet spans a groove of 0.4 rad
    assert np.linalg.norm(np.ptp(points[quads][..., :2], axis=1), axis=1).max() < 0.1 * R


def _as_joint_film(film):
    return types.SimpleNamespace(**vars(film), contact_pressure=None, wear_depth=None)


def test_helpers_say_what_the_field_says():
    upper, lower = ehd.two_lobe(preload=0.5, width_angle=0.2)
    assert (upper.start, upper.extent) == pytest.approx((0.1, math.pi - 0.2))
    assert lower.start % (2.0 * math.pi) == pytest.approx(math.pi + 0.1)
    assert [arc.offset for arc in ehd.offset_halves(preload=0.5)] == [1.0, 1.0]
    middle = [(a.start + 0.5 * a.extent) % (2.0 * math.pi) for a in ehd.three_lobe(preload=0.5)]
    assert min(abs(angle - 1.5 * math.pi) for angle in middle) < 1e-12
    upper, lower = ehd.pressure_dam(depth=5e-5, step_angle=2.5, length=0.02, track_length=0.01, width_angle=0.3)
    assert upper.start + upper.dam.extent == pytest.approx(2.5)
    assert (lower.dam.length, lower.dam.extent, lower.dam.depth) == (0.01, None, 5e-5)


ARC = ehd.Arc(start=0.0, extent=2.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ehd.Arc(start=0.0, extent=1.0, preload=-0.1), "Arc.preload must be >= 0"),
        (lambda: ehd.Arc(start=0.0, extent=1.0, preload=1.0), "Arc.preload must be between 0 and 1"),
        (lambda: ehd.Arc(start=0.0, extent=1.0, offset=1.1), "Arc.offset must be between 0 and 1"),
        (lambda: ehd.Arc(start=0.0, extent=1.0, offset=-0.1), "Arc.offset must be >= 0"),
        (lambda: replace(ARC, dam=ehd.Dam(depth=1e-5, length=0.01, extent=1.99)), "Dam.extent must leave"),
        (lambda: ehd.Arc(start=0.0, extent=1.0, dam=5e-5), "Arc.dam must be"),
        (lambda: bearing_of((ARC, ehd.Arc(start=1.5, extent=2.0))), r"arcs\[1\], from 1.5 .* overlaps arcs\[0\]"),
        (lambda: bearing_of((ehd.Arc(start=3.0, extent=1.0), ehd.Arc(start=5.0, extent=5.0))), r"overlaps arcs\[1\]"),
        (lambda: bearing_of((ARC, ehd.Arc(start=4.0, extent=1.0), ehd.Arc(start=2.5, extent=1.0))), "does not follow"),
        (lambda: bearing_of((ARC,), arc=ARC), "arc and JournalBearing.arcs exclude each other"),
        (lambda: bearing_of(ARC), "arcs must be a tuple"),
        (lambda: bearing_of((replace(ARC, dam=ehd.Dam(depth=1e-5, length=R)),)), r"arcs\[0\].dam.length"),
        (lambda: ehd.two_lobe(preload=0.5, width_angle=3.2), "two_lobe: width_angle"),
        (lambda: ehd.pressure_dam(depth=1e-5, length=0.01, step_angle=3.0), "Dam.extent"),
        (lambda: ehd.pressure_dam(depth=1e-5, length=0.01, step_angle=145.0), "in degrees, give 2.53"),
    ],
)  # fmt: skip
def test_bores_that_cannot_be_are_refused(make, message):
    with pytest.raises(ehd.InputError, match=message):
        make()


def test_touching_arcs_are_two():
    """Without a groove between them the oil still has the edges' pressure there."""
    film = ehd.steady(bearing_of(ehd.two_lobe(preload=0.0, width_angle=0.0)), speed=300.0, eccentricity_ratio=0.5)
    assert film.supply_flows.shape == (4,)
    assert film.pressure.max() > 1e5
