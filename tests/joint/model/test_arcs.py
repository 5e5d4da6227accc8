"""Films on a part of the circle: against an independent solution, their tangent, their flows, what they refuse."""

import math

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.element.outputs import ring_triangles
from exudyn_ehd.joint.model.build import build_model
from tests.reference.arc_film import arc_film
from tests.sampling import sample

R, C, MU = 0.025, 25e-6, 0.02
OIL = ehd.Lubricant(viscosity=MU)
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)


def bearing_on(arc, *, length=R, lubricant=OIL, **options):
    return ehd.JournalBearing(
        journal_radius=R, length=length, radial_clearance=C, lubricant=lubricant, arc=arc, **options
    )


def random_scene(rng):
    """An arc, a length, and a journal that comes closest to the bore within it."""
    extent = math.radians(rng.uniform(70.0, 200.0))
    start = rng.uniform(0.0, 2.0 * math.pi)
    edges = tuple(rng.uniform(0.0, 3e5, 2) * rng.integers(0, 2))
    arc = ehd.Arc(start=start, extent=extent, leading_pressure=edges[0], trailing_pressure=edges[1])
    length = R * rng.uniform(0.6, 2.0)
    angle, e = start + extent * rng.uniform(0.3, 0.7), C * rng.uniform(0.3, 0.9)
    tilt = rng.uniform(-0.1, 0.1, 2) * (C - e) / length
    spin = 300.0 * rng.choice([-1.0, 1.0])
    rates = rng.uniform(-0.05, 0.05, 2) * C * 300.0
    motion = np.array([e * math.cos(angle), e * math.sin(angle), *tilt, *rates, 0.0, 0.0, spin, 0.0])
    return arc, length, motion


@pytest.mark.parametrize("seed", sample(range(10), 0, 2))
def test_against_an_independent_solution(seed):
    """Force within 0.5 %, torque within 0.1 %, peak within 1 %, with pressures at the edges, tilt, squeeze, both
    directions of spin; its share of the ring's columns.

    That is the error of the default grid; the reference's own on 201 x 61 is below 0.1 %.
    """
    arc, length, motion = random_scene(np.random.default_rng(seed))
    bearing = bearing_on(arc, length=length)
    model = build_model(bearing)
    found = model.evaluate(motion)
    q, film = found.quantities(), found.film
    force, torque, peak = arc_film(
        motion, radius=R, length=length, clearance=C, viscosity=MU, start=arc.start, extent=arc.extent,
        edges=(arc.leading_pressure, arc.trailing_pressure),
    )  # fmt: skip
    assert np.linalg.norm(found.wrench[:2] - force) < 5e-3 * np.linalg.norm(force)
    assert q["friction_torque"] == pytest.approx(torque, rel=1e-3)
    assert q["peak_pressure"] == pytest.approx(peak, rel=1e-2)
    assert film.grid.shape[0] == math.ceil(bearing.columns * arc.extent / (2.0 * math.pi)) + 1
    assert (film.grid.x[[0, -1]] - arc.start).tolist() == pytest.approx([0.0, arc.extent], abs=1e-12)


CASES = {
    "FullSommerfeld": {"cavitation": ehd.FullSommerfeld()},
    "Gumbel": {"cavitation": ehd.Gumbel()},
    "line in the cells": {},
    "line on vertices": {"cavitation": ehd.SwiftStieber(line_in_cells=False)},
    "ElrodAdams": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "pressure law": {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=ehd.BarusPressure(coefficient=1e-8))},
    "density law": {"lubricant": ehd.Lubricant(viscosity=MU, density_law=ehd.DowsonHigginson())},
    "rough": {
        "roughness": ehd.PatirCheng(composite_roughness=8e-7),
        "asperity": ehd.GreenwoodTripp(composite_roughness=8e-7, composite_modulus=1e11),
    },
    "wall": {"contact": ehd.RegularisedWall(onset=3e-6)},
    "turbulent": {"turbulence": ehd.NgPan()},
    "pressure at the ends": {"end_pressures": (1e5, 2e5)},
}


@pytest.mark.parametrize("name", CASES)
def test_tangent_against_differences(name):
    """1e-5 of the wrench, what central differences leave, at random motions with pressures at the edges, in a step."""
    rng = np.random.default_rng(7)
    arc = ehd.Arc(start=3.4, extent=2.3, leading_pressure=3e5, trailing_pressure=1.5e5)
    model = build_model(bearing_on(arc, **CASES[name]))
    size = np.array([C, C, C / R, C / R, 300 * C, 300 * C, 300 * C / R, 300 * C / R, 300.0, 1.0])
    for _ in range(3):
        angle, e = rng.uniform(3.6, 5.5), 0.75 * C
        motion = np.array([e * math.cos(angle), e * math.sin(angle), *rng.uniform(-1.0, 1.0, 8) * 0.05 * size[2:]])
        motion[8] = 300.0 * rng.choice([-1.0, 1.0])
        history = model.initial_history(motion)
        step = 0.0 if history is None else 1e-4
        found = model.evaluate(motion, history, step)
        tangent, wrench = found.tangent() * size, np.abs(found.wrench)
        differences = np.empty((6, 10))
        for k, h in enumerate(1e-6 * size):
            beside = [model.evaluate(motion + way * h * np.eye(10)[k], history, step).wrench for way in (1.0, -1.0)]
            differences[:, k] = (beside[0] - beside[1]) / (2.0 * h) * size[k]
        scale = np.array(
            [wrench[:2].max()] * 2 + [wrench[2] + 1e-3 * wrench[:2].max()] + [wrench[3:5].max()] * 2 + [wrench[5]]
        )
        assert (np.abs(tangent - differences) / scale[:, None]).max() < 1e-5, name


def test_what_enters_at_the_edges_leaves_at_the_ends():
    """To rounding without motion, when both edges feed the film."""
    arc = ehd.Arc(start=3.6, extent=2.1, leading_pressure=2e5, trailing_pressure=1e5)
    film = ehd.steady(bearing_on(arc), speed=0.0, eccentricity_ratio=0.7, direction=4.4, tilt=(1e-4, 0.0))
    assert film.supply_flows.min() > 0.0
    assert film.supply_flows.sum() == pytest.approx(film.leakage, rel=1e-10)


def test_flow_around_corners_grows_with_the_logarithm_of_the_grid():
    """Every halving of the intervals adds 2 ln 2 / pi h^3 p / (12 mu) at each of the four corners."""
    arc, flows = ehd.Arc(start=0.0, extent=2.0, leading_pressure=1e5, trailing_pressure=1e5), []
    for n in (192, 384, 768):
        b = bearing_on(arc, cavitation=ehd.FullSommerfeld(), film=ehd.FiniteLength(n_theta=n, n_z=n // 8))
        flows.append(ehd.steady(b, speed=0.0, eccentricity_ratio=0.0).leakage)
    corner = 2.0 * math.log(2.0) / math.pi * C**3 * 1e5 / (12.0 * MU)
    np.testing.assert_allclose(np.diff(flows), 4.0 * corner, rtol=0.02)


@pytest.mark.parametrize("cavitation", [ehd.SwiftStieber(), ehd.ElrodAdams()], ids=repr)
def test_flows_and_friction_on_a_finer_grid(cavitation):
    """Within 0.5 % of those on 384 columns, the default grid's error; nothing enters where the film leaves."""
    films = []
    for grid in ({}, {"n_theta": 384, "n_z": 40}):
        bearing = bearing_on(ehd.Arc(start=3.4, extent=2.3), cavitation=cavitation, film=ehd.FiniteLength(**grid))
        films.append(ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.75, direction=5.3, tilt=(1e-4, 0.0)))
    found, fine = films
    assert found.supply_flows[1] == fine.supply_flows[1] == 0.0
    for name in ("leakage", "friction_torque", "power_loss"):
        assert getattr(found, name) == pytest.approx(getattr(fine, name), rel=5e-3), name
    assert found.supply_flows[0] == pytest.approx(fine.supply_flows[0], rel=5e-3)


def test_the_journal_is_free_beside_the_arc():
    """A journal farther off than the clearance has its film where the bore is."""
    arc = ehd.Arc(start=math.radians(240.0), extent=math.radians(60.0))
    film = ehd.steady(bearing_on(arc), speed=300.0, eccentricity_ratio=1.2, direction=math.radians(90.0))
    assert film.minimum_gap == pytest.approx(C * (1.0 + 1.2 * math.cos(math.radians(30.0))), rel=1e-3)
    with pytest.raises(ehd.FilmError, match=r"NO_FILM|no film|touch"):
        ehd.steady(bearing_on(arc), speed=300.0, eccentricity_ratio=1.05, direction=math.radians(270.0))


@pytest.mark.slow
def test_equilibrium_stiffness_and_damping_against_the_independent_solution():
    """K and C within 1 % of their largest entry: differences over 1e-3 of the clearance leave some 0.1 %."""
    arc = ehd.Arc(start=math.radians(210.0), extent=math.radians(120.0))
    rest = ehd.equilibrium(bearing_on(arc), speed=314.0, load=(0.0, -5e3))
    motion = rest.film.motion
    size = {"radius": R, "length": R, "clearance": C, "viscosity": MU, "start": arc.start, "extent": arc.extent}

    def force(k, h):
        return arc_film(motion + h * np.eye(10)[k], **size)[0]

    assert np.linalg.norm(force(0, 0.0) - (0.0, 5e3)) < 25.0
    for matrix, first, h in ((rest.stiffness, 0, 1e-3 * C), (rest.damping, 4, 0.3 * C)):
        reference = np.column_stack([(force(first + k, -h) - force(first + k, h)) / (2.0 * h) for k in (0, 1)])
        assert np.abs(matrix[:2, :2] - reference).max() < 1e-2 * np.abs(reference).max()


@pytest.mark.parametrize("cavitation", sample([ehd.SwiftStieber(), ehd.ElrodAdams()], 0), ids=repr)
def test_a_rotor_in_exudyn_comes_to_rest_in_its_arc(cavitation):
    bearing = bearing_on(ehd.Arc(start=math.radians(210.0), extent=math.radians(120.0)), cavitation=cavitation)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.CreateGround()
    inertia = InertiaCylinder(7800.0, 0.3, 0.05, 2)
    rotor = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0.0, 0.0, 314.0], gravity=[0.0, -60.0, 0.0])
    joint = ehd.CreateLubricatedJoint(
        mbs, name="pad", itemNumbers=[ground, rotor], position=[0.0, 0.0, 0.0], axis=[0.0, 0.0, 1.0], bearing=bearing,
        tilt=ehd.Held(),
    )  # fmt: skip
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.06, 600
    settings.timeIntegration.verboseMode = 0
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    history = joint.history
    rest = ehd.equilibrium(bearing, speed=314.0, load=(0.0, -60.0 * inertia.mass))
    assert history.eccentricity_ratio[-1] == pytest.approx(rest.eccentricity_ratio, rel=2e-2)
    assert history.supply_flow[-1] > 0.0
    lowest, highest = np.radians([210.0, 330.0])
    assert lowest <= history.minimum_gap_angle[-1] <= highest


def test_a_pad_that_is_not_there_is_named():
    with pytest.raises(ehd.FilmError, match="an arc beside the load"):
        ehd.equilibrium(bearing_on(ehd.Arc(start=3.7, extent=2.0)), speed=314.0, load=(0.0, 3e3))


HOT = ehd.oil("ISO VG 46")
WALL = ehd.Conduction(thickness=0.02, conductance=1.0)
MESH = ehd.HollowCylinder(inner_radius=R + C, thickness=5e-3, length=R)
REFUSED = {
    "thermal": {
        "thermal": ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13, bush=WALL),
        "lubricant": HOT,
    },
    "bush": {"bush": ehd.ModalBush(mesh=MESH, material=STEEL)},
    "journal": {"journal": ehd.ElasticJournal(material=STEEL, span=(-0.04, 0.05), held=None)},
    "film": {"film": ehd.ShortBearing()},
    "inlet": {"inlet": ehd.MaximumGap()},
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_needs_the_whole_ring_is_refused_by_name(name):
    with pytest.raises(ehd.InputError, match=rf"arcs=\(Arc\(...\), ...\) does not go with JournalBearing.{name}="):
        bearing_on(ehd.Arc(start=0.0, extent=2.0), **REFUSED[name])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start": 0.0, "extent": 0.0}, "Arc.extent"),
        ({"start": 0.0, "extent": 6.3}, "Arc.extent"),
        ({"start": math.nan, "extent": 1.0}, "Arc.start"),
        ({"start": 0.0, "extent": 1.0, "leading_pressure": "high"}, "Arc.leading_pressure"),
    ],
)
def test_arguments_that_are_none_are_refused(arguments, message):
    with pytest.raises(ehd.InputError, match=message):
        ehd.Arc(**arguments)


def test_a_cavity_above_the_pressure_at_an_edge_is_refused():
    with pytest.raises(ehd.InputError, match="the pressures at the edges of Arc"):
        bearing_on(
            ehd.Arc(start=0.0, extent=2.0), cavitation=ehd.SwiftStieber(cavity_pressure=1e5), end_pressures=(2e5, 2e5)
        )


def test_an_audit_improves_what_an_arc_can_have():
    """Its heat is switched on; surfaces that deflect are told, and left to the user."""
    arc = ehd.Arc(start=math.radians(210.0), extent=math.radians(120.0))
    bearing = bearing_on(arc)
    film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.9, direction=math.radians(270.0))
    improved = film.audit().improved(bearing)
    assert improved.arc == arc
    assert improved.bush is None
    assert improved.thermal is not None
    assert improved.lubricant.pressure_law is not None


def test_pictures_show_the_arc_alone():
    arc = ehd.Arc(start=math.radians(210.0), extent=math.radians(120.0))
    film = ehd.steady(bearing_on(arc), speed=300.0, eccentricity_ratio=0.7, direction=math.radians(250.0))
    axes = film.plot_pressure().axes[0]
    assert axes.get_xlim() == pytest.approx((210.0, 330.0))
    film.plot_bearing()
    with pytest.raises(ehd.InputError, match=r"no contact pressure; .* Films of joints have it"):
        film.plot_contact_pressure()
    assert len(ring_triangles(5, 3, last=[1, 4])) == len(ring_triangles(5, 3)) - 8


@pytest.mark.slow
def test_vertices_that_would_leave_and_join_a_film_by_turns():
    """A pressure dam that heats: two vertices at the line, each of which is in the film only without the other."""
    heat = ehd.FilmEnergy(supply_temperature=313.15, conductivity=0.13, bush_coefficient=1e3, journal_coefficient=200.0)
    dam = ehd.pressure_dam(depth=50e-6, step_angle=2.3, length=0.013)
    oil = ehd.oil("ISO VG 46")
    model = build_model(
        ehd.JournalBearing(journal_radius=0.02, length=0.02, radial_clearance=C, lubricant=oil, arcs=dam, thermal=heat)
    )

    def motion(t):
        angle, rate = 0.3 * math.sin(300.0 * t) - 1.0, 90.0 * math.cos(300.0 * t)
        c, s = 0.5 * C * math.cos(angle), 0.5 * C * math.sin(angle)
        return np.array([c, s, 0.0, 0.0, -rate * s, rate * c, 0.0, 0.0, 500.0, 0.0])

    history = model.initial_history(motion(0.0))
    for k in range(1, 40):
        film = model.evaluate(motion(5e-5 * k), history, 5e-5)
        assert film.iterations < 60
        history = film.history()
