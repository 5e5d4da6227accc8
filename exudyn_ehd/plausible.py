"""Plausible sizes of arguments: one table of all arguments with a physical dimension.

A value in another unit (mm, GPa, degrees, bar) is a thousand or a million times off, and often still gives a film.
Between the plausible range and the limits a value gives a warning. Beyond the limits it raises `InputError`. The
plausible range covers bearings from a watch's pivot to a ship's shaft, gels to ceramics, liquid gases to cold grease.
The limits are far outside it. Both hold for the magnitude: each argument checks its own sign, and 0 has no unit.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class Kind(NamedTuple):
    """A physical quantity: its unit, the plausible sizes, and those beyond which it raises `InputError`.

    Parameters
    ----------
    unit : str
    refused_below, low, high, refused_above : float
        Sizes in that unit; between ``low`` and ``high`` nothing is said.
    others : tuple of str
        Units of `UNITS`, or degrees Celsius, that are taken by mistake, the likeliest first.
    note : str
        A last sentence for the message.
    """

    unit: str
    refused_below: float
    low: float
    high: float
    refused_above: float
    others: tuple[str, ...] = ()
    note: str = ""


UNITS = {
    **{"mm": 1e-3, "micrometres": 1e-6, "nm": 1e-9, "mm/s": 1e-3, "mm/s2": 1e-3, "cm3": 1e-6, "mm3": 1e-9, "l": 1e-3},
    **{"bar": 1e5, "MPa": 1e6, "GPa": 1e9, "1/MPa": 1e-6, "1/GPa": 1e-9, "mPa s": 1e-3, "N/mm": 1e3, "N/um": 1e6},
    **{"degrees": math.radians(1.0), "rev/min": math.pi / 30.0, "microseconds": 1e-6, "l/min": 1e-3 / 60.0},
    **{"g": 1e-3, "t": 1e3, "g/cm3": 1e3, "t/mm3": 1e12, "g m2": 1e-3, "kg mm2": 1e-6, "kJ/(kg K)": 1e3},
    **{"mm3/s": 1e-9, "mm3/(N m)": 1e-9, "mm2/N": 1e-6},
}
"""SI values of units that are taken by mistake."""
_SMALL, _FINE = ("mm", "micrometres"), ("micrometres", "mm", "nm")
_STRESS = ("GPa", "MPa")
_PRESSURE = ("bar", "MPa", "GPa")
_KELVIN = "0 degrees Celsius are 273.15 K"
_RADIANS = "use math.radians for degrees"
_OILS = "mineral oils have 0.005 to 1; gases are compressible, which these films are not"

KINDS: dict[str, Kind] = {
    "size": Kind("m", 1e-7, 1e-5, 3.0, 10.0, _SMALL),
    "length": Kind("m", 1e-7, 1e-5, 5.0, 10.0, _SMALL),
    "grid": Kind("m", 0.0, 1e-6, 10.0, 1e3, _SMALL),
    "part": Kind("m", 1e-8, 1e-6, 0.5, 3.0, _SMALL),
    "place along z": Kind("m", 0.0, 0.0, 3.0, 10.0, _SMALL),
    "place": Kind("m", 0.0, 0.0, 1e5, 1e9),
    "clearance": Kind("m", 1e-9, 1e-8, 5e-3, 0.1, _FINE),
    "gap": Kind("m", 0.0, 1e-10, 0.01, 1e3, _FINE),
    "form": Kind("m", 0.0, 1e-10, 2e-3, 0.05, _FINE),
    "roughness": Kind("m", 1e-11, 1e-9, 3e-5, 1e-3, _FINE),
    "wall": Kind("m", 1e-12, 1e-9, 1e-4, 0.01, (*_SMALL, "nm")),
    "layer": Kind("m", 1e-9, 1e-7, 0.1, 1.0, _SMALL),
    "angle": Kind("rad", 0.0, 0.0, 6.2832, 12.5664, ("degrees",), _RADIANS),
    "angles": Kind("rad", 0.0, 0.0, 12.5664, 1e3, ("degrees",), _RADIANS),
    "width": Kind("rad", 1e-9, 1e-4, 3.2, 6.2832, ("degrees",), _RADIANS),
    "tilt": Kind("rad", 0.0, 0.0, 0.05, 1.0, ("degrees",), _RADIANS),
    "viscosity": Kind("Pa s", 1e-18, 1e-4, 6.0, 1e4, ("mPa s",), _OILS),
    "oil density": Kind("kg/m3", 10.0, 500.0, 3000.0, 3e4, ("g/cm3",)),
    "density": Kind("kg/m3", 15.0, 300.0, 2.5e4, 1e9, ("g/cm3", "t/mm3")),
    "specific heat": Kind("J/(kg K)", 50.0, 500.0, 1e4, 1e5, ("kJ/(kg K)",)),
    "specific heat of a solid": Kind("J/(kg K)", 20.0, 100.0, 3000.0, 1e5, ("kJ/(kg K)",)),
    "temperature": Kind("K", 1.0, 200.0, 700.0, 3000.0, ("degrees Celsius",), _KELVIN),
    "oil temperature": Kind("K", 180.0, 210.0, 600.0, 1000.0, ("degrees Celsius",), _KELVIN),
    "pressure": Kind("Pa", 0.0, 50.0, 2e8, 5e9, _PRESSURE, "it is a gauge pressure"),
    "cavity pressure": Kind("Pa", 0.0, 50.0, 1e7, 1e10, _PRESSURE, "it is a gauge pressure, vacuum is -1e5"),
    "stress": Kind("Pa", 0.0, 50.0, 1e10, 1e13, ("MPa", "bar", "GPa")),
    "wall pressure": Kind("Pa", 1e3, 1e5, 1e12, 1e14, _STRESS),
    "modulus": Kind("Pa", 1e3, 5e5, 2.5e12, 1e18, _STRESS),
    "pressure coefficient": Kind("1/Pa", 0.0, 0.0, 1e-6, 1e-4, ("1/GPa", "1/MPa")),
    "compressibility": Kind("1/Pa", 0.0, 0.0, 1e-8, 1e-6, ("1/GPa",)),
    "law's pressure": Kind("Pa", 1e5, 1e7, 1e10, 1e12, _STRESS),
    "temperature coefficient": Kind("1/K", 0.0, 1e-5, 0.2, 2.0),
    "expansion": Kind("1/K", 0.0, 0.0, 1e-3, 0.1),
    "pole": Kind("K", 0.0, 0.0, 300.0, 500.0, ("degrees Celsius",), _KELVIN),
    "relaxation time": Kind("s", 1e-18, 1e-11, 0.1, 1e5, ("microseconds",)),
    "volume": Kind("m3", 0.0, 1e-12, 1.0, 100.0, ("cm3", "mm3", "l")),
    "flow": Kind("m3/s", 0.0, 0.0, 0.1, 100.0, ("l/min", "mm3/s")),
    "seal": Kind("m3/(s Pa m)", 0.0, 0.0, 1.0, 1e9),
    "time": Kind("s", 0.0, 0.0, 1e7, 1e12),
    "rate": Kind("1/s", 0.0, 0.0, 1e7, 1e12),
    "damping time": Kind("s", 0.0, 0.0, 1.0, 1e3),
    "sliding speed": Kind("m/s", 0.0, 0.0, 10.0, 1e3, ("mm/s",)),
    "surface speed": Kind("m/s", 0.0, 0.0, 1e3, 1e6, ("mm/s",)),
    "velocity": Kind("m/s", 0.0, 0.0, 1e4, 3e8, ("mm/s",)),
    "acceleration": Kind("m/s2", 0.0, 0.0, 5e3, 1e9, ("mm/s2",)),
    "spin": Kind("rad/s", 0.0, 0.0, 1e5, 1e9, ("rev/min",)),
    "wear rate": Kind("m2/N", 0.0, 0.0, 1e-10, 1e-8, ("mm3/(N m)", "mm2/N")),
    "mass": Kind("kg", 1e-12, 1e-6, 1e6, 1e9, ("g", "t")),
    "moment of inertia": Kind("kg m2", 1e-20, 1e-12, 1e6, 1e12, ("g m2", "kg mm2")),
    "stiffness": Kind("N/m", 1e-3, 1e4, 1e13, 1e18, ("N/um", "N/mm")),
    "damping": Kind("N s/m", 0.0, 0.0, 1e11, 1e18),
    "force": Kind("N", 0.0, 0.0, 1e9, 1e15),
    "line force": Kind("N/m", 0.0, 0.0, 1e10, 1e14),
    "heat conductance": Kind("W/K", 0.0, 0.0, 1e6, 1e12),
    "heat capacity": Kind("J/K", 0.0, 0.0, 1e8, 1e14),
    "heat transfer": Kind("W/(m2 K)", 0.0, 0.0, 1e7, 1e14),
    "conductivity": Kind("W/(m K)", 1e-4, 5e-3, 500.0, 1e5),
}

_AREAS = ("AxialGroove", "CircumferentialGroove", "Hole", "Pocket")
_RESTRICTORS = ("Orifice", "Capillary", "GivenFlow")
_ARGUMENTS: dict[str, tuple[str, ...]] = {
    "size": (
        *(f"{bearing}.journal_radius" for bearing in ("JournalBearing", "TiltingPads")),
        "SphericalBearing.ball_radius",
        *(f"ThrustFaces.{name}_radius" for name in ("inner", "outer")),
        *(f"TiltingThrustPads.{name}_radius" for name in ("inner", "outer", "pivot")),
        *("HollowCylinder.inner_radius", "ElasticJournal.inner_radius"),
        *("HollowCylinder.thickness", "Conduction.thickness"),
        *("mesh_from_arrays.bore_radius", "mesh_from_fem.bore_radius"),
        "OnCylinder.radius",
        "add_bore_modes.radius",
    ),
    "length": (
        *(f"{part}.length" for part in ("JournalBearing", "TiltingPads", "AxialGroove", "HollowCylinder")),
        "add_bore_modes.length",
    ),
    "grid": (
        "bearing_grid.radius",
        "bearing_grid.length",
        "slider_grid.length",
        "slider_grid.width",
        "slider_grid.reference_length",
    ),
    "part": (
        "CircumferentialGroove.width",
        "Hole.diameter",
        *("Pocket.length", "Dam.length", "pressure_dam.length"),
        *("Orifice.diameter", "Capillary.diameter", "Capillary.length"),
        *(f"{area}.depth" for area in _AREAS),
        "EdgeRelief.relief_length",
        *("pressure_dam.track_length", "TiltingPads.pad_thickness"),
    ),
    "place along z": (
        *(f"{area}.z" for area in _AREAS[1:]),
        "ElasticJournal.span",
        "HeldBands.bands",
        "AxialProfile.positions",
        "ProfileTable.positions",
    ),
    "place": (
        *(f"Create{item}.position" for item in ("LubricatedJoint", "LubricatedSphericalJoint", "FlexibleBush")),
        *("CreateTiltingPadBearing.position", "CreateTiltingPadThrustBearing.position"),
        "add_bore_modes.position",
        "mesh_from_arrays.origin",
        "OnPlane.point",
    ),
    "clearance": (
        *(f"{bearing}.radial_clearance" for bearing in ("JournalBearing", "SphericalBearing", "TiltingPads")),
        *(f"{part}.clearance" for part in ("ThrustFaces", "TiltingThrustPads", "WornArc")),
    ),
    "gap": (
        "solve_film.gap",
        "solve_film.history",
        "steady_spherical.place",
        "steady.axial_position",
        "equilibrium.axial_position",
    ),
    "form": (
        "OutOfRound.amplitude",
        "WornArc.worn_depth",
        "OnPlane.tolerance",
        "Crown.drop",
        "EdgeRelief.drop",
        "AxialProfile.depths",
        "ProfileTable.depths",
        *(f"{step}.depth" for step in ("TaperLand", "StepLand", "Dam", "pressure_dam")),
        "TiltingThrustPads.crown",
    ),
    "roughness": ("GreenwoodTripp.composite_roughness", "PatirCheng.composite_roughness"),
    "wall": ("RegularisedWall.onset",),
    "layer": ("ElasticLiner.thickness",),
    "angle": (
        *("Arc.start", "Arc.extent", "Dam.extent", "pressure_dam.step_angle"),
        *("TiltingThrustPads.extent", "TiltingThrustPads.pivot_angle", "TiltingPads.extent", "TiltingPads.first_pivot"),
        *(f"{bore}.angle" for bore in ("two_lobe", "three_lobe", "offset_halves", "pressure_dam")),
        *(f"{area}.angle" for area in _AREAS if area != "CircumferentialGroove"),
        "OutOfRound.phase",
        "WornArc.angle",
        "bearing_grid.start_angle",
        "steady.direction",
        "recommend.direction",
    ),
    "angles": ("ProfileTable.angles", "SphericalBearing.socket_angles"),
    "width": tuple(
        f"{place}.width_angle"
        for place in ("AxialGroove", "Pocket", "two_lobe", "three_lobe", "offset_halves", "pressure_dam")
    ),
    "tilt": ("steady.tilt", "equilibrium.tilt"),
    "viscosity": ("Lubricant.viscosity",),
    "oil density": ("Lubricant.density",),
    "density": ("SaintVenantKirchhoff.density", "NeoHooke.density", "Conduction.density"),
    "specific heat": ("Lubricant.specific_heat",),
    "specific heat of a solid": ("Conduction.specific_heat",),
    "temperature": (
        "Lubricant.temperature",
        *("Sump.ambient", "Sump.initial_temperature"),
        *(f"LumpedThermal.{of}_temperature" for of in ("supply", "housing", "initial")),
        *(f"FilmEnergy.{of}_temperature" for of in ("supply", "bush", "journal", "initial")),
        *(f"Conduction.{of}_temperature" for of in ("ambient", "initial", "clearance")),
    ),
    "oil temperature": (
        "oil.temperature",
        "Lubricant.at.temperature",
        "ReynoldsTemperature.point",
        *(f"{law}Temperature.{point}" for law in ("Vogel", "Walther") for point in ("first", "second")),
        "TableViscosity.temperatures",
    ),
    "pressure": (
        "JournalBearing.end_pressures",
        "ThrustFaces.inner_pressures",
        "ThrustFaces.outer_pressures",
        *(f"Arc.{edge}_pressure" for edge in ("leading", "trailing")),
        *(f"{bore}.pressure" for bore in ("two_lobe", "three_lobe", "offset_halves", "pressure_dam")),
        *(f"{area}.pressure" for area in _AREAS),
        *(f"{restrictor}.supply_pressure" for restrictor in _RESTRICTORS[:2]),
        *(f"TiltingPads.{where}_pressures" for where in ("edge", "end")),
        "solve_film.boundary",
    ),
    "cavity pressure": tuple(f"{closure}.cavity_pressure" for closure in ("Gumbel", "SwiftStieber", "ElrodAdams")),
    "stress": ("SurfaceLoad.traction", "DeadPressure.pressure", "FollowerPressure.pressure"),
    "wall pressure": ("RegularisedWall.pressure", "LubricatedJoint.stop_at.pressure"),
    "modulus": (
        "SaintVenantKirchhoff.youngs_modulus",
        "NeoHooke.youngs_modulus",
        "ElasticLiner.youngs_modulus",
        "GreenwoodTripp.composite_modulus",
        "composite_modulus.youngs_moduli",
        *(f"{restrictor}.bulk_modulus" for restrictor in _RESTRICTORS),
    ),
    "pressure coefficient": ("BarusPressure.coefficient", "RoelandsPressure.coefficient"),
    "compressibility": ("DowsonHigginson.coefficient", "DowsonHigginson.saturation"),
    "law's pressure": ("RoelandsPressure.reference_pressure",),
    "temperature coefficient": ("ReynoldsTemperature.coefficient", "WaltherTemperature.expansion"),
    "expansion": ("Conduction.expansion",),
    "pole": ("VogelTemperature.pole",),
    "relaxation time": ("CarreauShear.relaxation_time",),
    "volume": tuple(f"{restrictor}.compressible_volume" for restrictor in _RESTRICTORS),
    "flow": ("GivenFlow.flow",),
    "seal": ("EndSeal.conductance",),
    "time": (
        *(f"{record}.revolutions.period" for record in ("JointHistory", "LubricatedJoint")),
        *("LubricatedJoint.record_films.period", "UntilPeriodic.period", "recommend_steps.period", "Period.seconds"),
        "solve_film.step",
    ),
    "rate": ("Rayleigh.mass_rate",),
    "damping time": ("Rayleigh.stiffness_time",),
    "sliding speed": ("GreenwoodTripp.transition_speed",),
    "surface speed": (
        *("steady_spherical.velocity", "steady.velocity", "steady.axial_speed"),
        "solve_film.surface_speed",
        "solve_film.gap_rate",
    ),
    "velocity": ("CreateFlexibleBush.initialVelocity",),
    "acceleration": (
        *(f"Create{item}.gravity" for item in ("TiltingPadBearing", "TiltingPadThrustBearing")),
        *("CreateLubricatedJoint.bushGravity", "Gravity.acceleration"),
    ),
    "spin": (
        *(f"{call}.speed" for call in ("steady", "equilibrium", "recommend", "recommend_steps")),
        "steady_spherical.angular_velocity",
        "stribeck.speeds",
        "SolveEquilibrium.speeds",
        *(f"{call}.{end}" for call in ("SolveThreshold", "stability_map") for end in ("lowest", "highest")),
        *(f"{joint}.place_in_equilibrium.speed" for joint in ("LubricatedJoint", "TiltingPadJoint")),
        "reduced.frequency",
        "CreateFlexibleBush.initialAngularVelocity",
    ),
    "wear rate": ("ArchardWear.wear_rate",),
    "mass": ("recommend_steps.mass", "TiltingThrustPads.pad_mass", "TiltingPads.pad_mass"),
    "moment of inertia": ("TiltingThrustPads.pad_inertia", "TiltingPads.pad_inertia"),
    "stiffness": ("TiltingThrustPads.pivot_stiffness", "TiltingPads.pivot_stiffness"),
    "damping": ("TiltingThrustPads.pivot_damping",),
    "force": (
        *(f"{call}.load" for call in ("equilibrium", "stribeck", "recommend_steps")),
        "equilibrium.axial_load",
        *(f"{joint}.place_in_equilibrium.load" for joint in ("LubricatedJoint", "TiltingPadJoint")),
        "LubricatedJoint.stop_at.force",
    ),
    "line force": ("LineLoad.force_per_length",),
    "heat conductance": ("LumpedThermal.housing_conductance", "Conduction.conductance", "Sump.conductance"),
    "heat capacity": ("LumpedThermal.capacity", "Sump.heat_capacity"),
    "heat transfer": ("FilmEnergy.bush_coefficient", "FilmEnergy.journal_coefficient"),
    "conductivity": ("FilmEnergy.conductivity", "Conduction.conductivity"),
}

ARGUMENTS: dict[str, str] = {argument: kind for kind, group in _ARGUMENTS.items() for argument in group}


def kind_of(where: str) -> Kind | None:
    """Quantity of ``Class.argument`` or ``function: argument``, as in messages; None without a dimension."""
    return KINDS.get(ARGUMENTS.get(where.replace(": ", ".").replace(" ", "."), ""))


def doubt(where: str, value: object, size: float) -> tuple[str, bool] | None:
    """Return a message on an implausible size of an argument, and whether it is an error; None if it is plausible.

    Parameters
    ----------
    where, value
        Argument, as of `kind_of`, and its value as given, for the message.
    size : float
        Its size in the unit of the table.
    """
    kind = kind_of(where)
    if kind is None or size == 0.0 or kind.low <= size <= kind.high:
        return None
    meant = ((u, size + 273.15 if u == "degrees Celsius" else UNITS[u] * size) for u in kind.others)
    sign = "-" if str(value).startswith("-") else ""
    found = (f"if it is in {u}, give {sign}{n:.3g}." for u, n in meant if kind.low <= n <= kind.high)
    usual = f"{kind.low:g} to {kind.high:g}" if kind.low else f"up to {kind.high:g}"
    text = f"bearings have {usual} {kind.unit}; {next(found, 'check its unit.')}" + f" ({kind.note})" * bool(kind.note)
    if kind.refused_below <= size <= kind.refused_above:
        return f"{where}: {value!r} {kind.unit} is unusual, {text}", False
    limits = f"{kind.refused_below:g} and {kind.refused_above:g} {kind.unit}"
    return f"{where} must be between {limits} in size, got {value!r}; {text}", True
