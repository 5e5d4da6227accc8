"""Sizes of arguments: the table covers every public argument, and says what it should."""

import contextlib
import enum
import inspect
import math
import warnings

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.plausible import ARGUMENTS, KINDS, doubt
from tests.descriptions import usual
from tests.sampling import but_slow

# Numbers without a dimension, directions and colours among them.
PURE = {
    "ArchardWear.acceleration", "CarreauShear.exponent", "CarreauShear.residual", "ClassicSOR.tolerance",
    "ClassicSOR.relaxation", "ConfigureSolver.relativeTolerance", "ConfigureSolver.absoluteTolerance",
    "ConfigureSolver.spectralRadius",
    "CreateTiltingPadThrustBearing.axis", "CreateTiltingPadThrustBearing.rotationMatrixAxes",
    "CreateFlexibleBush.rotationMatrix", "CreateLubricatedSphericalJoint.axis",
    "CreateLubricatedSphericalJoint.color", "CreateLubricatedSphericalJoint.rotationMatrixAxes",
    "CreateFlexibleBush.color", "CreateLubricatedJoint.axis",
    "CreateLubricatedJoint.rotationMatrixAxes", "CreateLubricatedJoint.color", "Crown.exponent",
    "DeadPressure.distribution", "ElasticLiner.poisson_ratio", "FactorReuse.contractivity", "FEBore.radius_tolerance",
    "FEJournal.radius_tolerance",
    "FilmEnergy.carry_over", "LumpedThermal.carry_over", "LumpedThermal.effective_rise",
    "FiniteLength.stretch", "FollowerPressure.distribution", "GreenwoodTripp.density_radius_roughness",
    "Orifice.discharge_coefficient",
    "GreenwoodTripp.roughness_radius_ratio", "GreenwoodTripp.friction_coefficient", "GreenwoodTripp.residual_film",
    "Gumbel.cavity_shear", "ImpedanceMap.stretch", "ImpedanceMap.largest_eccentricity_ratio",
    "LubricatedJoint.export_vtk.magnification", "ModalBush.tolerance", "ElasticJournal.tolerance", "PatirCheng.pattern",
    "PatirCheng.journal_share", "RegularisedWall.residual", "SaintVenantKirchhoff.poisson_ratio",
    "ShortBearing.stretch", "StepControl.largest_gap_change", "StepControl.error", "SurfaceLoad.distribution",
    "SwiftStieber.cavity_shear",
    "add_bore_modes.axis", "add_bore_modes.tolerance", "add_bore_modes.radius_tolerance", "bearing_grid.stretch",
    "composite_modulus.poisson_ratios", "recommend.error", "recommend.eccentricity_ratio", "recommend.tilt_ratio",
    "recommend_steps.error", "SolveEquilibrium.ratios", "SolveThreshold.ratios",
    "slider_grid.stretch", "steady.eccentricity_ratio", "add_bore_modes.fixed_nodes", "mesh_from_arrays.elements",
    "NeoHooke.poisson_ratio", "OnCylinder.tolerance", "OnPlane.normal", "mesh_from_file.scale", "bearing_grid.rows",
    "UntilPeriodic.tolerance", "Hirs.coefficient", "Hirs.exponent", "Hirs.full", "Hirs.onset", "NgPan.full",
    "NgPan.onset", "StepLand.share", "TaperLand.share", "Arc.preload", "Arc.offset", "two_lobe.preload",
    "two_lobe.offset", "three_lobe.preload", "three_lobe.offset", "offset_halves.preload",
    "TiltingPads.preload", "TiltingPads.pivot_offset",
    "CreateTiltingPadBearing.axis", "CreateTiltingPadBearing.rotationMatrixAxes",
}  # fmt: skip
# Judged by what they are handed to; nodes by the bore radius that they must have.
HANDED_ON = {
    "TableViscosity.viscosities",
    "mesh_from_arrays.nodes",
    "mesh_from_file.bore_radius",
    "EquilibriumPoint.speed",
    "EquilibriumPoint.load",
    "varied.parameters",
    "parameter_study.parameters",
    "stability_map.make",
    "stability_map.values",
}
# Numbers, but no sizes of a scene: times and angles of a picture or of what has been computed; what is handed on.
READING = {
    "load_history.start", "load_history.end",
    "LubricatedJoint.plot_bearing.camera", "LubricatedJoint.plot_traces.quantities",
    "LubricatedJoint.plot_traces.options", "CreateLubricatedJoint.itemNumbers", "CreateFlexibleBush.supports",
    "LubricatedJoint.plot_waterfall.speed", "LubricatedJoint.plot_waterfall.window",
    "CreateFlexibleBush.loads", "Support.nodes", "mesh_from_arrays.held",
    "mesh_from_fem.held", "mesh_from_file.held", "parameter_study.function", "parameter_study.hosts",
    "CreateTiltingPadThrustBearing.itemNumbers",
    "CreateLubricatedSphericalJoint.itemNumbers", "SolveEquilibrium.rotors", "SolveThreshold.rotors",
    "CreateLubricatedJoint.axisLength", "CreateLubricatedJoint.axisRadius", "CreateLubricatedJoint.bodyNumbers",
    "CreateTiltingPadBearing.itemNumbers",
    "ReplaceJoint.options", "ReplaceJoints.bearing", "ReplaceJoints.options", "ReplaceJoints.types",
}  # fmt: skip
# What the package makes, and hands out to be read.
RESULTS = {
    "BoreModesReport", "BushMesh", "EquilibriumResult", "FilmFields", "FilmResult", "Finding", "FlexibleBush",
    "SphericalHistory", "SphericalResult",
    "JointHistory", "JointState", "LastCycle", "Recommendation", "Revolutions", "SteadyResult", "StepRecommendation",
    "StribeckResult", "StudyTable", "SystemState", "ThrustResult", "RotorResult",
    "ThrustPadsResult", "TiltingPadThrustBearing",
    "TiltingPadHistory", "TiltingPadJoint", "TiltingPadResult",
}  # fmt: skip
# Classes whose methods a scene calls; methods of descriptions are called by the package.
WITH_METHODS = {"LubricatedJoint"}


def _numbers(name, call):
    for parameter in inspect.signature(call).parameters.values():
        text = str(parameter.annotation)
        if parameter.name != "self" and any(word in text for word in ("float", "ndarray", "Sequence", "Array", "Any")):
            yield f"{name}.{parameter.name}"


def _public_arguments():
    for name in ehd.__all__:
        item = getattr(ehd, name)
        if name in RESULTS or (inspect.isclass(item) and issubclass(item, (Exception, enum.Enum))):
            continue
        yield from _numbers(name, item)
        if name in WITH_METHODS:
            for method, call in inspect.getmembers(item, inspect.isfunction):
                if not method.startswith("_"):
                    yield from _numbers(f"{name}.{method}", call)


def test_every_public_argument_is_known():
    known = ARGUMENTS.keys() | PURE | HANDED_ON | READING
    assert sorted(set(_public_arguments()) - known) == []


def test_kinds_are_in_order_and_all_of_use():
    for kind in KINDS.values():
        assert 0.0 <= kind.refused_below <= kind.low < kind.high <= kind.refused_above
    assert set(ARGUMENTS.values()) == set(KINDS)


PLAIN = {
    "journal_radius": 0.025,
    "length": 0.025,
    "radial_clearance": 25e-6,
    "lubricant": ehd.Lubricant(viscosity=0.02),
    "film": ehd.FiniteLength(n_theta=16, n_z=4),
}
CLASS_NEEDS = {
    "JournalBearing": PLAIN,
    "Lubricant": {"viscosity": 0.02},
    "Hole": {"angle": 0.0, "diameter": 5e-3},
    "AxialGroove": {"angle": 0.0, "width_angle": 0.3},
    "Pocket": {"angle": 0.0, "width_angle": 0.3, "length": 0.01},
    "CircumferentialGroove": {"width": 3e-3},
    "HollowCylinder": {"inner_radius": 0.025, "thickness": 5e-3, "length": 0.025},
    "NeoHooke": {"youngs_modulus": 5e6, "poisson_ratio": 0.45, "density": 1100.0},
    "SaintVenantKirchhoff": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7800.0},
    "ElasticLiner": {"thickness": 1e-3, "youngs_modulus": 2e9},
    "GreenwoodTripp": {"composite_roughness": 5e-7, "composite_modulus": 1e11},
    "PatirCheng": {"composite_roughness": 5e-7},
    "RegularisedWall": {"onset": 1e-6},
    "ArchardWear": {"wear_rate": 1e-16},
    "OutOfRound": {"order": 2, "amplitude": 1e-6},
    "Crown": {"drop": 1e-6},
    "WornArc": {"worn_depth": 5e-6, "angle": 0.0, "clearance": 25e-6},
    "EdgeRelief": {"drop": 1e-6, "relief_length": 2e-3},
    "LumpedThermal": {"supply_temperature": 320.0},
    "FilmEnergy": {"supply_temperature": 320.0},
    "Conduction": {"thickness": 0.02, "conductance": 1.0},
    "Sump": {"conductance": 5.0, "ambient": 293.0},
    "BarusPressure": {"coefficient": 2e-8},
    "RoelandsPressure": {"coefficient": 2e-8},
    "CarreauShear": {"relaxation_time": 1e-6, "exponent": 0.8},
    "ReynoldsTemperature": {"point": (313.0, 0.04), "coefficient": 0.03},
    "VogelTemperature": {"first": (313.0, 0.04), "second": (373.0, 0.006)},
    "WaltherTemperature": {"first": (313.0, 46e-6), "second": (373.0, 7e-6)},
    "TableViscosity": {"temperatures": (300.0, 350.0), "viscosities": (0.04, 0.01)},
    "AxialProfile": {"positions": [-0.01, 0.01], "depths": [0.0, 1e-6]},
    "ProfileTable": {
        "angles": [0.0, 1.0, 2.0, 3.0],
        "positions": [-0.01, 0.01],
        "depths": np.full((4, 2), 1e-6),
    },
    "Rayleigh": {},
    "DowsonHigginson": {},
    "Gumbel": {},
    "SwiftStieber": {},
    "ElrodAdams": {},
}
GRID = ehd.bearing_grid(0.025, 0.025, 16, 4)
BEARING = ehd.JournalBearing(**PLAIN)


def _film(**options):
    plain = {"lubricant": PLAIN["lubricant"], "surface_speed": (1.0, 0.0)}
    return ehd.solve_film(GRID, options.pop("gap", np.full(GRID.shape, 1e-5)), **(plain | options))


CALLS = {
    "steady": lambda **k: ehd.steady(BEARING, **({"speed": 100.0, "eccentricity_ratio": 0.5} | k)),
    "equilibrium": lambda **k: ehd.equilibrium(BEARING, **({"speed": 100.0, "load": (0.0, -500.0)} | k)),
    "stribeck": lambda **k: ehd.stribeck(BEARING, **({"load": 100.0, "speeds": (10.0,)} | k)),
    "recommend": lambda **k: ehd.recommend(BEARING, eccentricity_ratio=0.5, **k),
    "recommend_steps": lambda **k: ehd.recommend_steps(
        BEARING, 0.9, **({"speed": 100.0, "period": 0.02, "load": np.full((8, 2), 100.0), "mass": 1.0} | k)
    ),
    "oil": lambda **k: ehd.oil("ISO VG 46", **k),
    "Lubricant.at": lambda **k: ehd.oil("ISO VG 46").at(**k),
    "solve_film": _film,
    "bearing_grid": lambda **k: ehd.bearing_grid(**({"radius": 0.02, "length": 0.02, "n_theta": 16, "n_z": 4} | k)),
    "slider_grid": lambda **k: ehd.slider_grid(**({"length": 0.02, "width": 0.02, "n_x": 16, "n_z": 4} | k)),
    "composite_modulus": lambda **k: ehd.composite_modulus(**({"poisson_ratios": (0.3, 0.3)} | k)),
}


def _shaped(name, argument, size):
    """An argument of a size, in the shape that it has."""
    if name == "recommend_steps" and argument == "load":
        return np.full((8, 2), size)
    pairs = ("end_pressures", "youngs_moduli", "velocity", "tilt", "load", "surface_speed")
    if argument in pairs and name != "stribeck":
        return (size, size)
    if argument in ("point", "first", "second"):
        return (size, 0.01 if name != "WaltherTemperature" else 1e-5)
    if argument in ("positions", "angles", "depths"):
        shape = np.shape(CLASS_NEEDS[name][argument])
        return np.full(shape, size) if len(shape) == 2 else np.linspace(-size, size, shape[0])
    if argument in ("gap", "gap_rate", "boundary", "history"):
        return np.full(GRID.shape, size)
    return size


def _cases():
    for where in sorted(ARGUMENTS):
        name = where.rpartition(".")[0]
        if name in CLASS_NEEDS or name in CALLS:
            yield where


# Other checks of these come first, or say more.
SAID_OTHERWISE = {
    "JournalBearing.radial_clearance", "AxialGroove.width_angle", "Pocket.width_angle", "VogelTemperature.pole",
    "solve_film.history", "solve_film.step", "ProfileTable.angles", "WaltherTemperature.expansion",
    "VogelTemperature.first", "VogelTemperature.second", "WaltherTemperature.first", "WaltherTemperature.second",
    "TableViscosity.temperatures",
}  # fmt: skip


def _call(where, size):
    name, _, argument = where.rpartition(".")
    value = _shaped(name, argument, size)
    if name in CALLS:
        return CALLS[name](**{argument: value})
    return getattr(ehd, name)(**(CLASS_NEEDS[name] | {argument: value}))


# an unusual load or speed makes these search for steps
LONG = [f"recommend_steps.{name}" for name in ("speed", "mass", "period")]


@pytest.mark.parametrize("where", but_slow(sorted(set(_cases()) - SAID_OTHERWISE), *LONG))
def test_a_size_beyond_reason_is_refused_and_an_unusual_one_warns(where):
    kind = KINDS[ARGUMENTS[where]]
    argument = where.rpartition(".")[2]
    beyond = [2.0 * kind.refused_above] + [0.5 * kind.refused_below] * (kind.refused_below > 0.0)
    for size in beyond:
        with pytest.raises(ehd.InputError, match=argument):
            _call(where, size)
    unusual = [1.1 * kind.high] * (1.1 * kind.high < kind.refused_above)
    unusual += [0.9 * kind.low] * (0.9 * kind.low > kind.refused_below)
    for size in unusual:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            with contextlib.suppress(ehd.EHDError):
                _call(where, size)
        said = [str(w.message) for w in caught if issubclass(w.category, ehd.PlausibilityWarning)]
        assert any(argument in text and "unusual" in text for text in said), (size, said)
        assert all(w.filename == __file__ for w in caught if issubclass(w.category, ehd.PlausibilityWarning))


def _bearing(**options):
    return ehd.JournalBearing(**(PLAIN | options))


# (what a scene writes, None for a warning or what the message must name)
TRAPS = {
    "table in degrees": (
        lambda: ehd.TableViscosity(temperatures=(20.0, 40.0, 100.0), viscosities=(0.1, 0.04, 0.006)),
        "273.15",
    ),
    "oil at 90 degrees": (lambda: ehd.oil("ISO VG 46", temperature=90.0), "273.15"),
    "length in mm": (lambda: _bearing(length=20.0), "in mm, give 0.02"),
    "hole in mm": (lambda: ehd.Hole(angle=1.0, diameter=5.0), "give 0.005"),
    "hole wider than the journal": (
        lambda: _bearing(supply=(ehd.Hole(angle=1.0, diameter=0.06),)),
        "larger than the bearing",
    ),
    "angle in degrees": (lambda: ehd.Hole(angle=90.0, diameter=0.005), "in degrees, give 1.57"),
    "composite modulus in GPa": (
        lambda: ehd.GreenwoodTripp(composite_roughness=5e-7, composite_modulus=210.0),
        "in GPa, give 2.1e\\+11",
    ),
    "moduli in GPa": (lambda: ehd.composite_modulus((210.0, 70.0), (0.3, 0.3)), "in GPa, give"),
    "Young's modulus in GPa": (
        lambda: ehd.SaintVenantKirchhoff(youngs_modulus=210.0, poisson_ratio=0.3, density=7800.0),
        "in GPa, give",
    ),
    "crown in micrometres": (lambda: ehd.Crown(drop=5.0), "in micrometres, give 5e-06"),
    "oil density in g/cm3": (lambda: ehd.Lubricant(viscosity=0.02, density=0.87), "give 870"),
    "specific heat in kJ": (lambda: ehd.Lubricant(viscosity=0.02, specific_heat=2.0), "2e\\+03"),
    "mesh in mm": (lambda: ehd.HollowCylinder(inner_radius=22.5, thickness=8.0, length=25.0), "give 0.0225"),
    "solid density in g/cm3": (
        lambda: ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7.8),
        "give 7.8e\\+03",
    ),
}
BORE = ehd.HollowCylinder(inner_radius=0.025, thickness=5e-3, length=0.025, axial=1, circumferential=8).mesh().bore
UNUSUAL = {
    "viscosity in mPa s": (lambda: ehd.Lubricant(viscosity=20.0), "in mPa s, give 0.02"),
    "viscosity of hot oil in mPa s": (lambda: ehd.Lubricant(viscosity=9.0), "in mPa s, give 0.009"),
    "viscosities of a law in mPa s": (
        lambda: ehd.Lubricant(temperature_law=ehd.VogelTemperature(first=(313.0, 40.0), second=(373.0, 6.0))),
        "in mPa s, give 0.0",
    ),
    "relaxation in microseconds": (
        lambda: ehd.CarreauShear(relaxation_time=1.0, exponent=0.8),
        "in microseconds, give 1e-06",
    ),
    "groove in degrees": (lambda: ehd.AxialGroove(angle=0.0, width_angle=4.0), "in degrees, give 0.0698"),
    "gravity in mm/s2": (lambda: ehd.Gravity(acceleration=(0.0, -9810.0, 0.0)), "in mm/s2, give 9.81"),
    "pressure on a solid in MPa": (
        lambda: ehd.FollowerPressure(surface=BORE, pressure=5.0),
        "in MPa, give 5e\\+06",
    ),
    "cavity below the vacuum": (lambda: ehd.SwiftStieber(cavity_pressure=-3e5), "absolute vacuum"),
    "cavity of kept oil below the vacuum": (lambda: ehd.ElrodAdams(cavity_pressure=-3e5), "absolute vacuum"),
    "a gas": (lambda: ehd.Lubricant(viscosity=1.8e-5), "gases are compressible"),
    "Young's modulus in MPa": (
        lambda: ehd.SaintVenantKirchhoff(youngs_modulus=210e3, poisson_ratio=0.3, density=7800.0),
        "in MPa, give 2.1e\\+11",
    ),
    "supply in bar": (lambda: ehd.Hole(angle=0.0, diameter=5e-3, pressure=3.0), "in bar, give 3e\\+05"),
    "film at 40 degrees": (lambda: ehd.LumpedThermal(supply_temperature=40.0), "273.15"),
    "cavity pressure in bar": (lambda: ehd.ElrodAdams(cavity_pressure=-1.0), "in bar, give"),
    "small bore in mm": (lambda: ehd.HollowCylinder(inner_radius=4.0, thickness=2e-3, length=5e-3), "in mm, give"),
}


@pytest.mark.parametrize("trap", TRAPS)
def test_other_units_are_refused(trap):
    call, said = TRAPS[trap]
    with pytest.raises(ehd.InputError, match=said):
        call()


@pytest.mark.parametrize("trap", UNUSUAL)
def test_what_may_be_meant_warns(trap):
    call, said = UNUSUAL[trap]
    with pytest.warns(ehd.PlausibilityWarning, match=said):
        call()


@pytest.mark.parametrize(
    ("onset", "advice"),
    [(0.002, "if it is in mm, give 2e-06"), (0.5, "if it is in micrometres, give 5e-07"), (1e-4, None)],
)
def test_onsets_of_contact_in_other_units(onset, advice):
    """Two micrometres in mm, half of one in micrometres."""
    said = doubt("RegularisedWall.onset", onset, onset)
    assert said is None if advice is None else advice in said[0]


def test_a_mesh_in_millimetres_is_refused():
    mesh = ehd.HollowCylinder(inner_radius=0.0225, thickness=8e-3, length=0.025, axial=1, circumferential=8).mesh()
    with pytest.raises(ehd.InputError, match=r"give 0\.0225"):
        ehd.mesh_from_arrays(mesh.nodes * 1000.0, mesh.elements, bore_radius=22.5)


# radius, clearance ratio, L/D, viscosity: what is built, from a watch's pivot to a ship's stern tube
REAL = {
    "watch pivot": (5e-5, 8e-3, 1.0, 0.05),
    "dental turbine": (1.5e-3, 2e-3, 1.0, 0.002),
    "water-lubricated polymer": (0.05, 3e-3, 2.0, 6e-4),
    "engine": (0.025, 1e-3, 0.4, 0.008),
    "cold engine": (0.025, 1e-3, 0.4, 5.0),
    "steam turbine": (0.45, 1.5e-3, 0.8, 0.02),
    "stern tube": (0.5, 1.5e-3, 2.0, 0.2),
    "liquid nitrogen": (0.02, 1e-3, 0.8, 1.6e-4),
}


@pytest.mark.parametrize("kind", REAL)
def test_what_is_built_says_nothing(kind):
    radius, ratio, shape, viscosity = REAL[kind]
    ehd.JournalBearing(
        journal_radius=radius,
        length=2.0 * shape * radius,
        radial_clearance=ratio * radius,
        lubricant=ehd.Lubricant(viscosity=viscosity),
        supply=(ehd.AxialGroove(angle=0.0, width_angle=0.5, pressure=1e5),),
    )


@pytest.mark.parametrize(
    ("modulus", "density"), [(5e6, 1100.0), (3e9, 1300.0), (7e10, 2700.0), (2.1e11, 7850.0), (6.5e11, 15600.0)]
)
def test_solids_from_rubber_to_hard_metal_say_nothing(modulus, density):
    ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=density)


def test_usual_sizes_are_within():
    for where, name in ARGUMENTS.items():
        assert KINDS[name].low <= usual(where) <= KINDS[name].high
        assert math.isfinite(usual(where))
