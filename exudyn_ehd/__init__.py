"""Elastohydrodynamic (oil-filled) revolute and cylindrical joints for Exudyn.

All public names by task, with their defaults, and the columns of histories with units and signs: `exudyn_ehd/API.md`,
a text file in the package's folder.

Module map
----------
bearing    what a scene writes: `JournalBearing` and its options
film       the oil film: grid, gap, Reynolds equation, cavitation closures, solvers, loads, heat
solid      the flexible bush: quadratic elements in absolute nodal coordinates, and its reduction to modes
joint      one bearing as a pure function of its motion; `steady`, `equilibrium`, `stribeck`, `solve_film`, `Audit`,
           `steady_spherical`
pictures   maps, orbits, traces, the bearing in space: matplotlib, in one style
coupling   Exudyn: `CreateLubricatedJoint`, `CreateLubricatedSphericalJoint`, `CreateTiltingPadThrustBearing`,
           `CreateFlexibleBush`, solvers, histories
studies    many runs: `parameter_study`; what keeps an error: `recommend`, `recommend_steps`
tables     columns of numbers as text and as CSV; units by name
compilation constants of kernels; a line for the user while they are compiled
progress   how far long work is, where somebody looks
storage    files on disk: whole or absent, and arrays kept between runs
status     outcomes, errors and checks of input
plausible  which sizes an argument can have, for all of them in one table

Conventions
-----------
SI units, radians, gauge pressures. Joint frame: origin on the bearing's mid-plane, z = bearing axis, x and y fixed in
the housing; theta counts from x about z; arrays are ``[theta, z]``, z from -L/2 to L/2. Forces act on the journal,
moments are taken about the joint's origin.

Descriptions of a model raise `InputError` for invalid values and name the argument. The docstring of each effect's
module has the equations, assumptions and sources, e.g. ``help("exudyn_ehd.film.surfaces.roughness")``.

Examples in docstrings take ``import numpy as np``, ``import exudyn as exu`` and ``import exudyn_ehd as ehd`` for
granted, and go on from the examples that they name.
"""

import ast
import importlib
import pathlib

import exudyn_ehd.compilation
import exudyn_ehd.storage

__version__ = "0.2.0"

# Modules by public name, as type checkers read them. A module is imported when a name of it is asked for: film studies
# need neither Exudyn nor the solid, a rigid bearing no solid.
_STUB = ast.parse(pathlib.Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
_IMPORTS = [node for node in _STUB.body if isinstance(node, ast.ImportFrom)]
_MODULES = dict(sorted((alias.name, node.module) for node in _IMPORTS for alias in node.names))
__all__ = list(_MODULES)


def __getattr__(name):
    exudyn_ehd.status.require_supported(name)
    if name in _MODULES:
        found = exudyn_ehd.status.hint_arguments(getattr(importlib.import_module(_MODULES[name]), name))
        globals()[name] = found  # asked for once
        return found
    hint = f"; did you mean {meant!r}?" if (meant := exudyn_ehd.status.did_you_mean(name, __all__)) else ""
    raise AttributeError(f"module 'exudyn_ehd' has no attribute {name!r}{hint}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
