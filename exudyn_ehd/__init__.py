"""Elastohydrodynamic (oil-filled) revolute and cylindrical joints for Exudyn.

Module map
----------
bearing    what a scene writes: `JournalBearing` and its options
film       the oil film: grid, gap, Reynolds equation, cavitation closures, solvers, loads, heat
solid      the flexible bush: quadratic elements in absolute nodal coordinates, and its reduction to modes
joint      one bearing as a pure function of its motion; `steady`, `equilibrium`, `stribeck`, `solve_film`, `Audit`,
           `steady_spherical`
pictures   maps, orbits, traces, the bearing in space: matplotlib, in one style
coupling   Exudyn: `CreateLubricatedJoint`, `CreateLubricatedSphericalJoint`, `CreateFlexibleBush`, solvers, histories
studies    many runs: `parameter_study`; what keeps an error: `recommend`, `recommend_steps`
tables     columns of numbers as text and as CSV; units by name
kernels    compilation of first films by two processes
progress   how far long work is, where somebody looks
storage    files on disk: whole or absent, and arrays kept between runs
status     outcomes, errors and checks of input
plausible  which sizes an argument can have, for all of them in one table

Conventions
-----------
SI units, radians, gauge pressures. Joint frame: origin on the bearing's mid-plane, z = bearing axis, x and y fixed in
the housing; theta counts from x about z; arrays are ``[theta, z]``, z from -L/2 to L/2. Forces act on the journal,
moments are taken about the joint's origin.

What describes a scene raises `InputError` for values that can't be meant, and says which. Equations, assumptions and
sources of an effect stand in full at the top of its module, e.g. ``help("exudyn_ehd.film.surfaces.patir_cheng")``.

Examples in docstrings take ``import numpy as np``, ``import exudyn as exu`` and ``import exudyn_ehd as ehd`` for
granted, and go on from the examples that they name.
"""

import importlib
from typing import TYPE_CHECKING

import exudyn_ehd.storage
from exudyn_ehd.bearing import JournalBearing, MaximumGap, Periodic
from exudyn_ehd.film.cavitation.closures import FullSommerfeld, Gumbel, SwiftStieber
from exudyn_ehd.film.cavitation.elrod_adams import ElrodAdams
from exudyn_ehd.film.grid import bearing_grid, slider_grid
from exudyn_ehd.film.heat.options import Conduction, FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.density import DowsonHigginson
from exudyn_ehd.film.lubricant.lubricant import Lubricant, oil
from exudyn_ehd.film.lubricant.pressure_viscosity import BarusPressure, RoelandsPressure
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear
from exudyn_ehd.film.lubricant.temperature_viscosity import ReynoldsTemperature, VogelTemperature, WaltherTemperature
from exudyn_ehd.film.models import FiniteLength, LongBearing, ShortBearing
from exudyn_ehd.film.reynolds.turbulence import Hirs, NgPan
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.sor import ClassicSOR
from exudyn_ehd.film.supply.areas import AxialGroove, CircumferentialGroove, Hole, Pocket
from exudyn_ehd.film.surfaces.asperity import GreenwoodTripp, composite_modulus
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.film.surfaces.patir_cheng import PatirCheng
from exudyn_ehd.film.surfaces.profile import AxialProfile, Crown, EdgeRelief, OutOfRound, ProfileTable
from exudyn_ehd.film.surfaces.wall import RegularisedWall
from exudyn_ehd.film.surfaces.wear import ArchardWear
from exudyn_ehd.film.thrust.options import StepLand, TaperLand, ThrustFaces
from exudyn_ehd.joint.audit.audit import Audit, Finding
from exudyn_ehd.joint.model.fields import FilmFields
from exudyn_ehd.joint.static.equilibrium import EquilibriumResult, equilibrium
from exudyn_ehd.joint.static.solve_film import FilmResult, solve_film
from exudyn_ehd.joint.static.steady import SteadyResult, steady
from exudyn_ehd.joint.static.stribeck import StribeckResult, stribeck
from exudyn_ehd.progress import show_progress
from exudyn_ehd.status import (
    EHDError,
    FilmError,
    GridWarning,
    HotFilmWarning,
    InputError,
    MemoryWarning,
    OverloadWarning,
    PlausibilityWarning,
    RingingWarning,
    RunError,
    StarvationWarning,
    Status,
    StrainWarning,
    ThinFilmWarning,
)

__version__ = "0.2.0"

# By module, imported only when asked for: film studies need neither Exudyn nor the solid, a rigid bearing no solid.
_LAZY = {
    name: module
    for module, names in {
        "coupling.api": "CreateLubricatedJoint Free Held",
        "coupling.bush.object": "CarriedOuter CreateFlexibleBush FixedOuter FlexibleBush FreeOuter Support",
        "coupling.handle": "LubricatedJoint",
        "coupling.record.history": "JointHistory Quantity",
        "coupling.record.on_disk": "File",
        "coupling.record.record": "load_history",
        "coupling.record.revolutions": "Revolutions",
        "coupling.record.thinning": "Every Period",
        "coupling.replace": "ReplaceJoint ReplaceJoints ReplaceReducedBody",
        "coupling.rotor.api": "SolveEquilibrium SolveThreshold stability_map",
        "coupling.rotor.result": "RotorResult",
        "coupling.run.joint_state": "JointState",
        "coupling.run.periodic": "LastCycle UntilPeriodic",
        "coupling.run.restart": "SystemState",
        "coupling.run.settings": "ConfigureSolver",
        "coupling.run.solve": "SaveState SolveDynamic SolveStatic",
        "coupling.run.sparse": "FactorReuse SolveDynamicSparse",
        "coupling.spherical": "CreateLubricatedSphericalJoint LubricatedSphericalJoint SphericalHistory",
        "coupling.watch.step_control": "StepControl",
        "joint.spherical.steady": "SphericalBearing SphericalResult steady_spherical",
        "joint.static.thrust": "ThrustResult",
        "solid.bush": "ANCFBush ModalBush Rayleigh",
        "solid.fe_bore": "BoreModesReport FEBore add_bore_modes",
        "solid.journal.description": "ElasticJournal HeldBands HeldEnds",
        "solid.journal.turning": "FEJournal",
        "solid.loads": "DeadPressure FollowerPressure Gravity LineLoad SurfaceLoad",
        "solid.mesh": "BushMesh HollowCylinder",
        "solid.mesh_files": "mesh_from_file",
        "solid.mesh_import": "OnCylinder OnPlane mesh_from_arrays mesh_from_fem",
        "solid.total_lagrange": "NeoHooke SaintVenantKirchhoff",
        "studies.parameters": "EquilibriumPoint StudyTable parameter_study varied",
        "studies.recommend": "Recommendation recommend",
        "studies.steps": "StepRecommendation recommend_steps",
    }.items()
    for name in names.split()
}

if TYPE_CHECKING:
    from exudyn_ehd.coupling.api import CreateLubricatedJoint, Free, Held
    from exudyn_ehd.coupling.bush.object import (
        CarriedOuter,
        CreateFlexibleBush,
        FixedOuter,
        FlexibleBush,
        FreeOuter,
        Support,
    )
    from exudyn_ehd.coupling.handle import LubricatedJoint
    from exudyn_ehd.coupling.record.history import JointHistory, Quantity
    from exudyn_ehd.coupling.record.on_disk import File
    from exudyn_ehd.coupling.record.record import load_history
    from exudyn_ehd.coupling.record.revolutions import Revolutions
    from exudyn_ehd.coupling.record.thinning import Every, Period
    from exudyn_ehd.coupling.replace import ReplaceJoint, ReplaceJoints, ReplaceReducedBody
    from exudyn_ehd.coupling.rotor.api import SolveEquilibrium, SolveThreshold, stability_map
    from exudyn_ehd.coupling.rotor.result import RotorResult
    from exudyn_ehd.coupling.run.joint_state import JointState
    from exudyn_ehd.coupling.run.periodic import LastCycle, UntilPeriodic
    from exudyn_ehd.coupling.run.restart import SystemState
    from exudyn_ehd.coupling.run.settings import ConfigureSolver
    from exudyn_ehd.coupling.run.solve import SaveState, SolveDynamic, SolveStatic
    from exudyn_ehd.coupling.run.sparse import FactorReuse, SolveDynamicSparse
    from exudyn_ehd.coupling.spherical import CreateLubricatedSphericalJoint, LubricatedSphericalJoint, SphericalHistory
    from exudyn_ehd.coupling.watch.step_control import StepControl
    from exudyn_ehd.joint.spherical.steady import SphericalBearing, SphericalResult, steady_spherical
    from exudyn_ehd.joint.static.thrust import ThrustResult
    from exudyn_ehd.solid.bush import ANCFBush, ModalBush, Rayleigh
    from exudyn_ehd.solid.fe_bore import BoreModesReport, FEBore, add_bore_modes
    from exudyn_ehd.solid.journal.description import ElasticJournal, HeldBands, HeldEnds
    from exudyn_ehd.solid.journal.turning import FEJournal
    from exudyn_ehd.solid.loads import DeadPressure, FollowerPressure, Gravity, LineLoad, SurfaceLoad
    from exudyn_ehd.solid.mesh import BushMesh, HollowCylinder
    from exudyn_ehd.solid.mesh_files import mesh_from_file
    from exudyn_ehd.solid.mesh_import import OnCylinder, OnPlane, mesh_from_arrays, mesh_from_fem
    from exudyn_ehd.solid.total_lagrange import NeoHooke, SaintVenantKirchhoff
    from exudyn_ehd.studies.parameters import EquilibriumPoint, StudyTable, parameter_study, varied
    from exudyn_ehd.studies.recommend import Recommendation, recommend
    from exudyn_ehd.studies.steps import StepRecommendation, recommend_steps
else:

    def __getattr__(name):
        exudyn_ehd.status.require_supported(name)
        if name in _LAZY:
            return exudyn_ehd.status.hint_arguments(getattr(importlib.import_module(f"exudyn_ehd.{_LAZY[name]}"), name))
        hint = f"; did you mean {meant!r}?" if (meant := exudyn_ehd.status.did_you_mean(name, __all__)) else ""
        raise AttributeError(f"module 'exudyn_ehd' has no attribute {name!r}{hint}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


__all__ = [
    "ANCFBush",
    "ArchardWear",
    "Audit",
    "AxialGroove",
    "AxialProfile",
    "BarusPressure",
    "BoreModesReport",
    "BushMesh",
    "CarreauShear",
    "CarriedOuter",
    "CircumferentialGroove",
    "ClassicSOR",
    "Conduction",
    "ConfigureSolver",
    "CreateFlexibleBush",
    "CreateLubricatedJoint",
    "CreateLubricatedSphericalJoint",
    "Crown",
    "DeadPressure",
    "DowsonHigginson",
    "EHDError",
    "EdgeRelief",
    "ElasticJournal",
    "ElasticLiner",
    "ElrodAdams",
    "EquilibriumPoint",
    "EquilibriumResult",
    "Every",
    "FEBore",
    "FEJournal",
    "FactorReuse",
    "File",
    "FilmEnergy",
    "FilmError",
    "FilmFields",
    "FilmResult",
    "Finding",
    "FiniteLength",
    "FixedOuter",
    "FlexibleBush",
    "FollowerPressure",
    "Free",
    "FreeOuter",
    "FullSommerfeld",
    "Gravity",
    "GreenwoodTripp",
    "GridWarning",
    "Gumbel",
    "Held",
    "HeldBands",
    "HeldEnds",
    "Hirs",
    "Hole",
    "HollowCylinder",
    "HotFilmWarning",
    "ImpedanceMap",
    "InputError",
    "JointHistory",
    "JointState",
    "JournalBearing",
    "LastCycle",
    "LineLoad",
    "LongBearing",
    "Lubricant",
    "LubricatedJoint",
    "LubricatedSphericalJoint",
    "LumpedThermal",
    "MaximumGap",
    "MemoryWarning",
    "ModalBush",
    "NeoHooke",
    "NgPan",
    "OnCylinder",
    "OnPlane",
    "OutOfRound",
    "OverloadWarning",
    "PatirCheng",
    "Period",
    "Periodic",
    "PlausibilityWarning",
    "Pocket",
    "ProfileTable",
    "Quantity",
    "Rayleigh",
    "Recommendation",
    "RegularisedWall",
    "ReplaceJoint",
    "ReplaceJoints",
    "ReplaceReducedBody",
    "Revolutions",
    "ReynoldsTemperature",
    "RingingWarning",
    "RoelandsPressure",
    "RotorResult",
    "RunError",
    "SaintVenantKirchhoff",
    "SaveState",
    "ShortBearing",
    "SolveDynamic",
    "SolveDynamicSparse",
    "SolveEquilibrium",
    "SolveStatic",
    "SolveThreshold",
    "SphericalBearing",
    "SphericalHistory",
    "SphericalResult",
    "StarvationWarning",
    "Status",
    "SteadyResult",
    "StepControl",
    "StepLand",
    "StepRecommendation",
    "StrainWarning",
    "StribeckResult",
    "StudyTable",
    "Support",
    "SurfaceLoad",
    "SwiftStieber",
    "SystemState",
    "TaperLand",
    "ThinFilmWarning",
    "ThrustFaces",
    "ThrustResult",
    "UntilPeriodic",
    "VogelTemperature",
    "WaltherTemperature",
    "add_bore_modes",
    "bearing_grid",
    "composite_modulus",
    "equilibrium",
    "load_history",
    "mesh_from_arrays",
    "mesh_from_fem",
    "mesh_from_file",
    "oil",
    "parameter_study",
    "recommend",
    "recommend_steps",
    "show_progress",
    "slider_grid",
    "solve_film",
    "stability_map",
    "steady",
    "steady_spherical",
    "stribeck",
    "varied",
]

for _name in set(__all__) - set(_LAZY):
    exudyn_ehd.status.hint_arguments(globals()[_name])
