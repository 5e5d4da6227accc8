"""Elastohydrodynamic (oil-filled) revolute and cylindrical joints for Exudyn.

Module map
----------
bearing   what a scene writes: `JournalBearing` and its options
film      the oil film: grid, gap, Reynolds equation, cavitation closures, direct solver, loads
joint     one bearing as a pure function of its motion; `steady`, `equilibrium`, `solve_film`
coupling  Exudyn: `CreateLubricatedJoint`, film element, kinematics, histories, sensors
reference closed forms to compare with
status    outcomes and errors

Conventions
-----------
SI units, radians, gauge pressures. Joint frame: origin on the bearing's mid-plane, z = bearing axis, x and y fixed in the
housing; theta counts from x about z; arrays are ``[theta, z]``, z from -L/2 to L/2. Forces act on the journal, moments are
taken about the joint's origin.
"""

from exudyn_ehd.bearing import JournalBearing, MaximumGap, Periodic
from exudyn_ehd.film.asperity import GreenwoodTripp, composite_modulus
from exudyn_ehd.film.cavitation import FullSommerfeld, Gumbel, SwiftStieber
from exudyn_ehd.film.contact import RegularisedWall
from exudyn_ehd.film.elrod import ElrodAdams
from exudyn_ehd.film.grid import FiniteLength, ShortBearing, bearing_grid, slider_grid
from exudyn_ehd.film.liner import ElasticLiner
from exudyn_ehd.film.lubricant import Lubricant
from exudyn_ehd.film.profile import AxialProfile, Crown, EdgeRelief, OutOfRound, ProfileTable
from exudyn_ehd.film.roughness import PatirCheng
from exudyn_ehd.film.wear import ArchardWear
from exudyn_ehd.joint.steady import EquilibriumResult, FilmResult, SteadyResult, equilibrium, solve_film, steady
from exudyn_ehd.joint.stribeck import StribeckResult, stribeck
from exudyn_ehd.status import EHDError, FilmError, InputError, Status

__version__ = "0.1.0"

__all__ = [
    "ArchardWear",
    "AxialProfile",
    "Crown",
    "EHDError",
    "EdgeRelief",
    "ElasticLiner",
    "ElrodAdams",
    "EquilibriumResult",
    "FilmError",
    "FilmResult",
    "FiniteLength",
    "FullSommerfeld",
    "GreenwoodTripp",
    "Gumbel",
    "InputError",
    "JournalBearing",
    "Lubricant",
    "MaximumGap",
    "OutOfRound",
    "PatirCheng",
    "Periodic",
    "ProfileTable",
    "RegularisedWall",
    "ShortBearing",
    "Status",
    "SteadyResult",
    "StribeckResult",
    "SwiftStieber",
    "bearing_grid",
    "composite_modulus",
    "equilibrium",
    "slider_grid",
    "solve_film",
    "steady",
    "stribeck",
]
