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
from exudyn_ehd.film.cavitation import FullSommerfeld, Gumbel, SwiftStieber
from exudyn_ehd.film.contact import RegularisedWall
from exudyn_ehd.film.elrod import ElrodAdams
from exudyn_ehd.film.grid import FiniteLength, ShortBearing, bearing_grid, slider_grid
from exudyn_ehd.film.lubricant import Lubricant
from exudyn_ehd.film.oils import oil
from exudyn_ehd.film.shear import CarreauShear
from exudyn_ehd.film.temperature import ReynoldsTemperature, VogelTemperature, WaltherTemperature
from exudyn_ehd.film.thermal import FilmEnergy, LumpedThermal
from exudyn_ehd.film.viscosity import BarusPressure, RoelandsPressure
from exudyn_ehd.joint.steady import EquilibriumResult, FilmResult, SteadyResult, equilibrium, solve_film, steady
from exudyn_ehd.status import EHDError, FilmError, InputError, Status

__version__ = "0.1.0"

__all__ = [
    "BarusPressure",
    "CarreauShear",
    "EHDError",
    "ElrodAdams",
    "EquilibriumResult",
    "FilmEnergy",
    "FilmError",
    "FilmResult",
    "FiniteLength",
    "FullSommerfeld",
    "Gumbel",
    "InputError",
    "JournalBearing",
    "Lubricant",
    "LumpedThermal",
    "MaximumGap",
    "Periodic",
    "RegularisedWall",
    "ReynoldsTemperature",
    "RoelandsPressure",
    "ShortBearing",
    "Status",
    "SteadyResult",
    "SwiftStieber",
    "VogelTemperature",
    "WaltherTemperature",
    "bearing_grid",
    "equilibrium",
    "oil",
    "slider_grid",
    "solve_film",
    "steady",
]
