"""Absent effects are not called: nothing of an effect's modules runs in a film without it, and with it something does.

Every function, kernel and method of the modules that belong to an effect alone is replaced
by one that raises, wherever it is bound. Films then give the bits that they gave before.
"""

import importlib
import inspect
import pathlib
import sys

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.thrust import ThrustModel
from tests.descriptions import LAWS, options_of

C = 25e-6
MOTION = np.array([11e-6, 5e-6, 1e-4, -1.5e-4, 3e-3, -2e-3, 0.05, 0.02, 250.0, 0.3])
ALIGNED = np.array([1, 1, 0, 0, 1, 1, 0, 0, 1, 1])
STEP = 1e-4
CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "gumbel": ehd.Gumbel(),
    "swift": ehd.SwiftStieber(),
    "swift on vertices": ehd.SwiftStieber(line_in_cells=False),
    "elrod": ehd.ElrodAdams(cavity_pressure=-1e5),
}
HOT = ehd.Lubricant(temperature_law=ehd.ReynoldsTemperature(point=(325.0, 0.02), coefficient=0.03), temperature=325.0)
ASPERITY = ehd.GreenwoodTripp(composite_roughness=3e-6, composite_modulus=1e9)
SMALL_MAP = ehd.ImpedanceMap(n_theta=64, n_z=8, n_eccentricity=12, n_direction=17, largest_eccentricity_ratio=0.9)
LINER = ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)


def oil(**laws):
    return {"lubricant": ehd.Lubricant(viscosity=0.02, **laws)}


# Modules that belong to an effect alone, and options that must call each of them.
EFFECTS = {
    "contact": (("film.surfaces.contact:WallContact",), {"contact": ehd.RegularisedWall(onset=0.9 * C)}),
    "contact loads": (
        ("film.surfaces.contact:add_contact", "film.surfaces.roughness:drag_weights"),
        {"contact": ehd.RegularisedWall(onset=0.9 * C)},
    ),
    "asperity": (
        ("film.surfaces.roughness:AsperityContact", "film.surfaces.roughness:AverageGap"),
        {"asperity": ASPERITY},
    ),
    "roughness": (("film.surfaces.roughness:RoughFlow",), {"roughness": ehd.PatirCheng(composite_roughness=1e-6)}),
    "turbulence": (("film.reynolds.turbulence",), {"turbulence": ehd.Hirs(onset=2.0, full=4.0, coefficient=5.0)}),
    "wear": (("film.surfaces.contact:ArchardWear",), {"asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-15)}),
    "profile": (("film.surfaces.profile",), {"profile": ehd.Crown(drop=2e-6)}),
    "pressure law": (("film.lubricant.pressure_viscosity",), oil(pressure_law=ehd.BarusPressure(coefficient=1e-8))),
    "shear law": (
        ("film.lubricant.shear_thinning", "film.lubricant.shear_profile"),
        oil(shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)),
    ),
    "density law": (
        ("film.lubricant.density",),
        oil(density_law=ehd.DowsonHigginson()),
    ),
    "lumped": (("joint.heat.temperature",), {"lubricant": HOT, "thermal": ehd.LumpedThermal(supply_temperature=330.0)}),
    "energy": (("film.heat.energy",), {"lubricant": HOT, "thermal": ehd.FilmEnergy(supply_temperature=330.0)}),
    "walls": (
        ("film.heat.options:Walls", "film.heat.options:Rings"),
        {
            "lubricant": HOT,
            "thermal": ehd.FilmEnergy(
                supply_temperature=330.0, conductivity=0.13, bush=ehd.Conduction(thickness=0.02, conductance=1.0)
            ),
        },
    ),
    "across": (
        ("joint.heat.across",),
        {"lubricant": HOT, "thermal": ehd.FilmEnergy(supply_temperature=330.0, conductivity=0.13, across=2)},
    ),
    "liner": (
        (
            "film.solvers.liner",
            "film.solvers.winkler",
            "film.solvers.winkler_kernels",
        ),
        {"bush": LINER},
    ),
    "liner in contact": (("film.solvers.winkler",), {"bush": LINER, "asperity": ASPERITY}),
    "bush": (
        (
            "joint.bore.shapes",
            "joint.model.flexible",
            "joint.tangent.bore",
            "joint.bore.equilibrium",
            "solid.bush:bore_modes",
            "solid.bush:BoreModes",
        ),
        {
            "bush": ehd.ModalBush(
                mesh=ehd.HollowCylinder(
                    inner_radius=0.025, thickness=0.01, length=0.05, axial=2, radial=1, circumferential=12
                ),
                material=ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0),
                tolerance=0.2,
            )
        },
    ),
    "classic": (("film.solvers.sor",), {"film": ehd.ClassicSOR(n_theta=32, n_z=6), "cavitation": ehd.Gumbel()}),
    "impedance map": (
        ("film.solvers.impedance_map", "joint.model.build:ImpedanceModel"),
        {"film": SMALL_MAP, "end_pressures": (0.0, 0.0)},
    ),
    "line on a liner": (
        ("film.cavitation.rupture_line:limit_by_liner",),
        {"cavitation": ehd.SwiftStieber(line_in_cells=True), "bush": LINER},
    ),
    "line of a film that conserves mass on a liner": (
        ("film.cavitation.rupture_line:undeformed",),
        {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True), "bush": LINER},
    ),
    "holes": (
        ("film.supply.cuts", "film.supply.cuts:recess_shear", "film.supply.areas:circle"),
        {"supply": (ehd.Hole(angle=1.0, diameter=6e-3, pressure=1e5, depth=1e-3),)},
    ),
    "restrictors": (
        ("film.supply.restrictors:Reservoirs", "film.supply.restrictors:Orifice"),
        {"supply": (ehd.Hole(angle=1.0, diameter=6e-3, supply=ehd.Orifice(diameter=5e-4, supply_pressure=1e6)),)},
    ),
    "seals": (
        ("film.supply.restrictors:sealed_grid", "film.supply.restrictors:seal_ends"),
        {"end_seals": ehd.EndSeal(conductance=1e-11)},
    ),
    "thrust": (
        ("film.thrust.annulus", "film.thrust.face", "joint.thrust"),
        {"thrust": ehd.ThrustFaces(inner_radius=0.026, outer_radius=0.05, clearance=4e-5, n_theta=16, n_r=6)},
    ),
    "mass conservation": (
        ("film.cavitation.oil_line",),
        {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)},
    ),
}


# Modules that every film uses, that describe a scene, or (the last line) whose
# kernels only other kernels of their effect call.
SHARED = {
    "combinations",
    "cavitation.closures",
    "cavitation.linear_film",
    "cavitation.rupture_line",
    "solvers.newton",
    "solvers.matrix",
    "solvers.sets",
    "cavitation.states",
    "models",
    "banded.substitution",
    "banded.workspace",
    "banded.factors",
    "reynolds.gap",
    "grid",
    "loads",
    "lubricant.lubricant",
    "reynolds.links",
    "solvers.answers",
    "solvers.film",
    "solvers.solver",
    "supply.areas",
    "supply.rows",
    "reynolds.balance",
    # a bearing of its own
    "thrust.tilting",
}


FILM = pathlib.Path(ehd.__file__).parent / "film"
FOUND = {".".join(path.relative_to(FILM).with_suffix("").parts) for path in FILM.rglob("[!_]*.py")}
NAMED = {name[5:].partition(":")[0] for names, _ in EFFECTS.values() for name in names if name.startswith("film.")}
# A module with a public option of its own need not be named above.
EFFECTS |= {
    f"{name} of {module}": ((f"film.{module}",), {name: option} if name not in LAWS else oil(**{name: option}))
    for module in sorted(FOUND - SHARED - NAMED)
    for name, option in options_of(f"film.{module}")
}


def bearing(**options):
    values = oil() | {
        "journal_radius": 0.025,
        "length": 0.05,
        "radial_clearance": C,
        "end_pressures": (1e5, 2e5),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
    }
    return ehd.JournalBearing(**(values | options))


def forbidden(*_, **__):
    raise AssertionError("an absent effect was called")


def forbid(patch, *names):
    """Let everything that these modules define raise; classes keep their names, for questions of type.

    ``module:name`` is one class or function of a module that several effects share.
    """
    # all of them first: one that is imported later would keep what it takes from another one
    parts = [name.partition(":") for name in names]
    for module, only in [(importlib.import_module(f"exudyn_ehd.{name}"), only) for name, _, only in parts]:
        own = [item for item in vars(module).values() if getattr(item, "__module__", None) == module.__name__]
        own = [item for item in own if only in ("", item.__name__)]
        assert own, (module, only)
        for item in own:
            if inspect.isclass(item):
                if not getattr(item, "_is_protocol", False):
                    forbid_class(patch, item)
            elif callable(item):
                forbid_function(patch, item)


def forbid_class(patch, kind):
    for name, member in list(vars(kind).items()):
        if inspect.isfunction(member) and (name == "__init__" or not name.startswith("__")):
            patch.setattr(kind, name, forbidden)
        elif isinstance(member, property):
            patch.setattr(kind, name, property(forbidden))


def forbid_function(patch, function):
    for name, module in list(sys.modules.items()):
        if name.startswith("exudyn_ehd") and module is not None:
            for key, value in list(vars(module).items()):
                if value is function:
                    patch.setattr(module, key, forbidden)


def of_effect_alone(module):
    """The whole module of an effect; of one that every film uses, what is named of it."""
    name = module.partition(":")[0]
    return module if name.removeprefix("film.") in SHARED or name == "joint.model.build" else name


def use(made):
    """All that a joint asks of a film over two steps."""
    model = build_model(made)
    motion = MOTION * ALIGNED if isinstance(made.film, ehd.ImpedanceMap) else MOTION
    history, out = model.initial_history(motion), []
    for _ in range(2):
        evaluation = model.evaluate(motion, history, STEP)
        out += [evaluation.wrench, evaluation.tangent(), np.array(list(evaluation.quantities().values()))]
        history = evaluation.history()
    if made.thrust is not None:
        faces = ThrustModel(made).evaluate(np.append(motion, 0.0))
        out += [faces.wrench, faces.tangent(), np.array(list(faces.quantities().values()))]
    return out


def test_every_module_of_the_film_is_asked_about():
    names = [name for modules, _ in EFFECTS.values() for name in modules if name.startswith("film.")]
    assert SHARED | {name[5:].partition(":")[0] for name in names} == FOUND


@pytest.mark.parametrize("closure", CLOSURES)
def test_a_plain_film_calls_no_effect(closure, monkeypatch):
    made = bearing(cavitation=CLOSURES[closure])
    expected = use(made)
    present = ("mass conservation", "elrod"), ("line", "swift")
    absent = [modules for name, (modules, _) in EFFECTS.items() if (name, closure) not in present]
    forbid(monkeypatch, *{of_effect_alone(module) for modules in absent for module in modules})
    for a, b in zip(use(made), expected, strict=True):
        np.testing.assert_array_equal(a, b)


# Kernels that no other test of the default run compiles.
SLOW = {
    "line",
    "line on a liner",
    "line of a film that conserves mass",
    "line of a film that conserves mass on a liner",
}


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in EFFECTS])
def test_every_module_of_an_effect_is_called_with_it(name, monkeypatch):
    """Else the test above would prove nothing."""
    modules, options = EFFECTS[name]
    made = bearing(**options)
    use(made)
    for module in modules:
        with monkeypatch.context() as patch:
            forbid(patch, module)
            with pytest.raises(AssertionError, match="an absent effect was called"):
                use(made)
