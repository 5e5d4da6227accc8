"""`exudyn_ehd/API.md` is what `tests/api_page.py` makes; defaults in docstrings, and columns of histories, are true."""

import dataclasses
import inspect
import re

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from exudyn_ehd.tables import unit_of
from tests import api_page

SIZE = {"journal_radius": 0.025, "length": 0.025, "radial_clearance": 25e-6}
GRID = {"film": ehd.FiniteLength(n_theta=32, n_z=6)}
WALL = ehd.Conduction(thickness=0.01, conductance=50.0, ambient_temperature=313.0, expansion=1.2e-5)
# Every effect with a column of its own; thrust faces go with neither heat nor asperities.
ALL_BUT_FACES = ehd.JournalBearing(
    **SIZE,
    **GRID,
    lubricant=ehd.oil("ISO VG 46"),
    supply=(ehd.AxialGroove(angle=1.6, width_angle=0.3, length=0.015, pressure=2e5),),
    thermal=ehd.FilmEnergy(
        supply_temperature=ehd.Sump(conductance=9.0, ambient=313.0), conductivity=0.13, bush=WALL, journal=WALL
    ),
    asperity=ehd.GreenwoodTripp(composite_roughness=4e-6, composite_modulus=1e11),
    wear=ehd.ArchardWear(wear_rate=1e-15),
)
FACES = ehd.JournalBearing(
    **SIZE,
    **GRID,
    lubricant=ehd.Lubricant(viscosity=0.02),
    contact=ehd.RegularisedWall(onset=2e-6),
    bush=ehd.ModalBush(
        mesh=ehd.HollowCylinder(inner_radius=0.025, thickness=0.01, length=0.025, axial=1, radial=1, circumferential=8),
        material=ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0),
        tolerance=0.2,
    ),
    thrust=ehd.ThrustFaces(
        inner_radius=0.03,
        outer_radius=0.05,
        clearance=50e-6,
        profile=ehd.TaperLand(pads=6, depth=20e-6),
        contact=ehd.RegularisedWall(onset=49e-6),
    ),
)
FED = ehd.JournalBearing(
    **SIZE,
    **GRID,
    lubricant=ehd.Lubricant(viscosity=0.02),
    contact=ehd.RegularisedWall(onset=2e-6),
    supply=(ehd.Hole(angle=4.7, diameter=0.006, supply=ehd.Orifice(diameter=5e-4, supply_pressure=2e6)),),
)
BALL = ehd.SphericalBearing(
    ball_radius=0.015,
    radial_clearance=30e-6,
    lubricant=ehd.Lubricant(viscosity=0.1),
    thermal=ehd.LumpedThermal(supply_temperature=ehd.Sump(conductance=1.0, ambient=313.0)),
)


def ran(create, bearing, place, **axis):
    """A joint after six steps of a heavy body that turns in its film."""
    mbs = exu.SystemContainer().AddSystem()
    inertia = InertiaCuboid(density=7800, sideLengths=[0.1] * 3)
    body = mbs.CreateRigidBody(
        inertia=inertia, gravity=[0, -500.0, -3.0], referencePosition=place, initialAngularVelocity=[0, 0, 200.0]
    )
    joint = create(mbs, "main", [mbs.CreateGround(), body], [0, 0, 0], bearing=bearing, **axis)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 6, 6e-4
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    return joint


@pytest.fixture(scope="module")
def joints():
    axis, low = {"axis": [0, 0, 1]}, [0, -22e-6, 0]
    return [ran(ehd.CreateLubricatedJoint, bearing, low, **axis) for bearing in (ALL_BUT_FACES, FACES, FED)]


def test_the_page_is_what_the_package_says():
    assert api_page.PAGE.read_text(encoding="utf-8") == api_page.page(), f"renew it: {api_page.COMMAND}"


def test_every_public_name_has_one_group():
    listed = [name for group in api_page.GROUPS for name in group.names.split()]
    missing = sorted(set(ehd.__all__) - set(listed))
    assert not missing, f"give {missing} a place in GROUPS of tests/api_page.py, then {api_page.COMMAND}"
    assert sorted(listed) == ehd.__all__


def test_lines_of_the_page_are_readable():
    """A name with its arguments fits on half a screen, or what a result holds; an explanation fits in a line."""
    lines = api_page.page().splitlines()
    assert max(len(line) for line in lines if "| holds " not in line) <= 500
    assert max(map(len, lines)) <= 650
    for name in ehd.__all__:
        assert len(api_page.summary(getattr(ehd, name))) <= 130, name


def described():
    """(name, item, argument, default) of everything public that has parameters in its docstring."""
    for name, item in api_page.callables():
        for argument in api_page.parameters(item).values():
            yield name, item, argument.name, argument.default


def test_docstrings_say_the_defaults_of_signatures():
    wrong = []
    for name, item, argument, default in described():
        found = [e for e in api_page.section(item, "Parameters") if argument in e.names]
        if len(found) != 1:
            wrong.append(f"{name}: {argument} stands {len(found)} times among its parameters")
            continue
        _, said, text = found[0].kind.partition(", default ")
        if default is inspect.Parameter.empty:
            wrong += [f"{name}: {argument} has no default, its docstring says {text}"] if said else []
            continue
        defaults = [api_page.default_text(api_page.parameters(item)[n].default) for n in found[0].names]
        expected = ", ".join(defaults if len(set(defaults)) > 1 else defaults[:1])
        if text != expected:
            wrong.append(f"{name}: {argument} must end in ', default {expected}', got {found[0].kind!r}")
    assert not wrong, "\n".join(wrong)


def test_every_default_is_documented():
    """Whoever takes arguments has a section for them; a result has attributes, or is an enumeration."""
    for name in ehd.__all__:
        item = getattr(ehd, name)
        own = inspect.isfunction(item) or (dataclasses.is_dataclass(item) and dataclasses.fields(item))
        if own:
            assert any(api_page.section(item, title) for title in ("Parameters", "Attributes")), name
    assert len({name for name, *_ in described()}) > 100


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1e9, "1e9"),
        (-6e-10, "-6e-10"),
        (0.005, "0.005"),
        (313.15, "313.15"),
        (0.0, "0.0"),
        (float("inf"), "inf"),
        (("a", 1, None), '("a", 1, None)'),
        (("a",), '("a",)'),
        (ehd.FiniteLength(), "FiniteLength()"),
        (ehd.FiniteLength(n_z=4), "FiniteLength(n_theta=None, n_z=4, stretch=0.75)"),
    ],
)
def test_defaults_are_written_briefly(value, text):
    assert api_page.default_text(value) == text


def known_columns(cls):
    """Names in the table of a class."""
    names = [name for name, *_ in api_page.columns(cls)]
    assert len(set(names)) == len(names)
    return set(names)


def occurring(*histories):
    """Columns that have a number in some row of one of the histories."""
    found = set()
    for history in histories:
        # columns in memory are made when they are asked for, so that `dir` does not know them
        for name in {*dir(history), *(field.name for field in dataclasses.fields(history))}:
            values = None if name[0] == "_" else getattr(history, name)
            if isinstance(values, np.ndarray) and np.isfinite(values).any():
                found.add(name)
    return found


def test_every_column_of_a_history_is_in_the_table_and_occurs(joints):
    """No column is missing or unused with heat in film and walls, supply, a bush, asperities, wear and thrust faces."""
    histories = [joint.history for joint in joints]
    numbers = {"radial_clearance", "journal_radius", "length"}
    fields = {field.name for field in dataclasses.fields(ehd.JointHistory)} - numbers
    assert known_columns(ehd.JointHistory) == fields == occurring(*histories)
    quantities = {member.value for member in ehd.Quantity}
    assert quantities | {"time", "step_error", "step_count"} == fields
    # where a sign is told: a spin in the positive sense about z, a weight along -y and -z
    first, second, _ = histories
    assert (first.friction_torque < 0.0).all() and (first.power_loss > 0.0).all() and first.force[-1, 1] > 0.0
    # the groove feeds the film under pressure once the journal no longer squeezes it
    assert first.supply_flow[-1] > 0.0 and first.leakage[-1] > 0.0
    touching = first.contact_load > 0.0
    assert touching.any() and (first.contact_torque[touching] < 0.0).all()
    assert (second.thrust_torque < 0.0).all() and (second.thrust_power_loss > 0.0).all()
    assert second.thrust_force[-1] > 0.0 and second.axial_position[-1] < 0.0


def test_columns_of_files_are_in_the_page(joints, tmp_path):
    joints[0].to_csv(tmp_path / "history.csv")
    heads = (tmp_path / "history.csv").read_text(encoding="utf-8").splitlines()[0].split(",")
    text, split = api_page.PAGE.read_text(encoding="utf-8"), api_page.COMPONENTS
    parts = {part for names in split.values() for part in names}
    expected = (known_columns(ehd.JointHistory) - set(split) - {"eccentricity", "step_count"}) | parts
    assert {head.split(" [")[0] for head in heads} == expected
    for names in split.values():
        assert f"`{', '.join(names)}`" in re.sub(r"\s+", " ", text)


def test_tables_of_revolutions_and_ball_joints_have_all_their_columns(joints):
    ball = ran(ehd.CreateLubricatedSphericalJoint, BALL, [0, -20e-6, 0]).history
    for history in (joints[0].revolutions(period=3e-4), ball):
        fields = {field.name for field in dataclasses.fields(history)}
        assert known_columns(type(history)) == fields == occurring(history)
    assert (ball.torque[:, 2] < 0.0).all() and (ball.power_loss > 0.0).all()


@pytest.mark.parametrize("name", api_page.TABLES)
def test_columns_say_their_unit_and_their_sign(name):
    for column, unit, meaning, sign in api_page.columns(getattr(ehd, name)):
        assert meaning and sign, f"{name}.{column}: a sentence on what it is, then one on sign or frame"
        if (known := unit_of(column)) is not None:
            assert unit == known, f"{name}.{column}"


def test_help_leads_to_the_page():
    # IPython shows the property of `joint.history?` and the class of `history?`
    properties = (ehd.LubricatedJoint.history, ehd.LubricatedSphericalJoint.history)
    for item in (ehd, ehd.JointHistory, ehd.SphericalHistory, *properties):
        assert "exudyn_ehd/API.md" in item.__doc__
