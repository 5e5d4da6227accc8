"""Options of a bearing that exclude or need each other, refused when the bearing is described."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.heat.options import FilmEnergy, known_supply
from exudyn_ehd.film.lubricant.temperature_viscosity import require_covered
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.sor import ClassicSOR
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.film.thrust.annulus import BearingOptions
from exudyn_ehd.status import InputError

# Pa s; of a gas far from cold, and of pitch.
LEAST_VISCOSITY, LARGEST_VISCOSITY = 1e-7, 1e9


def check_combinations(bearing: BearingOptions) -> None:
    """Raise `InputError` for options that exclude each other, or for one without what it needs.

    Parameters
    ----------
    bearing : mapping
        Attributes of the `JournalBearing`.
    """
    _check_film(bearing)
    if bearing["arc"] is not None:
        _check_arc(bearing)
    _check_turbulence(bearing)
    if bearing["thermal"] is not None:
        _check_heat(bearing)
    if bearing["wear"] is not None and bearing["asperity"] is None:
        raise InputError(
            "JournalBearing.wear=ArchardWear(...) needs a contact pressure to wear with; give the bearing "
            "asperity=GreenwoodTripp(...), or leave wear out."
        )
    if bearing["asperity"] is not None or bearing["roughness"] is not None:
        _check_roughness(bearing)


def _check_film(bearing: BearingOptions) -> None:
    """Refuse effects that the film model leaves out."""
    film, oil, name = bearing["film"], bearing["lubricant"], type(bearing["film"]).__name__
    if isinstance(bearing["bush"], ElasticLiner) and not isinstance(film, FiniteLength):
        raise InputError(
            f"JournalBearing.bush=ElasticLiner(...) can't be combined with film={name}(): its film is solved in two "
            "dimensions; leave one of the two out."
        )
    if oil.density_law is not None and isinstance(film, ClassicSOR | ImpedanceMap):
        raise InputError(
            f"Lubricant.density_law must be None with film={name}(...), which takes oil as incompressible; use "
            "film=FiniteLength(...)."
        )
    uneven = (bearing["roughness"], bearing["turbulence"], oil.shear_law)
    if isinstance(film, ClassicSOR) and (any(uneven) or isinstance(bearing["thermal"], FilmEnergy)):
        raise InputError(
            "JournalBearing.film=ClassicSOR(...) is the paper's plain film and takes no roughness, turbulence, shear "
            "thinning or temperature field; use film=FiniteLength(...)."
        )


def _check_arc(bearing: BearingOptions) -> None:
    """Refuse what needs the whole ring."""
    others = [name for name in ("thermal", "bush", "journal", "profile", "wear", "supply") if bearing[name]]
    others += [] if isinstance(bearing["film"], FiniteLength) else ["film"]
    others += [] if type(bearing["inlet"]).__name__ == "Periodic" else ["inlet"]
    if others:
        raise InputError(
            f"JournalBearing.arc=Arc(...) does not go with JournalBearing.{others[0]}={bearing[others[0]]!r}: the film "
            "of an arc is one of FiniteLength(...) between rigid cylinders of one temperature, fed at its edges; leave "
            "one of the two out."
        )


def _check_turbulence(bearing: BearingOptions) -> None:
    """Refuse what has no turbulent form: properties by the pressure, and factors of a laminar profile."""
    oil, laws = bearing["lubricant"], ("pressure_law", "density_law", "shear_law")
    others = [f"Lubricant.{law}" for law in laws if getattr(oil, law) is not None]
    others += [] if bearing["roughness"] is None else ["JournalBearing.roughness"]
    others += [] if getattr(bearing["thermal"], "conductivity", None) is None else ["FilmEnergy.conductivity"]
    if bearing["turbulence"] is not None and others:
        raise InputError(
            f"JournalBearing.turbulence={type(bearing['turbulence']).__name__}() does not go with {', '.join(others)}: "
            "its Reynolds number takes viscosity and density at ambient pressure, its walls are smooth, and its eddies "
            "carry heat across the film; leave one out."
        )


def _check_heat(bearing: BearingOptions) -> None:
    """Refuse temperatures at which the oil's law gives no viscosity, as for degrees Celsius given as kelvin, and a
    temperature field that does not go with the bearing."""
    thermal, oil = bearing["thermal"], bearing["lubricant"]
    law = oil.temperature_law
    for name, value in (vars(thermal) | {"supply_temperature": known_supply(thermal)}).items():
        if law is None or value is None or not name.endswith("temperature"):
            continue
        require_covered(f"JournalBearing.thermal.{name}", law, value)
        with np.errstate(all="ignore"):
            viscosity = float(law.viscosity(value, oil.density))
        if not LEAST_VISCOSITY <= viscosity <= LARGEST_VISCOSITY:
            raise InputError(
                f"JournalBearing.thermal.{name} = {value!r} K: the lubricant's {type(law).__name__} gives a "
                f"viscosity of {viscosity:g} Pa s there; temperatures are in kelvin, 0 degrees Celsius are 273.15 K."
            )
    if not isinstance(thermal, FilmEnergy):
        return
    if thermal.across == 2 and oil.shear_law is not None:
        raise InputError(
            f"FilmEnergy.across=2 does not go with Lubricant.shear_law={type(oil.shear_law).__name__}(): both change "
            "the viscosity across the film, and either leaves out the other's profile; take across=1, or leave the "
            "shear_law out."
        )
    radius, pin = bearing["journal_radius"], thermal.journal
    if pin is not None and pin.thickness > radius * (1.0 + 1e-12):
        raise InputError(
            f"FilmEnergy.journal=Conduction(thickness={pin.thickness:g} m) is thicker than the journal, whose radius "
            f"is {radius:g} m; a solid journal's thickness is its radius."
        )


def _check_roughness(bearing: BearingOptions) -> None:
    """Refuse rough surfaces with a wall, of two roughnesses, or too rough for the clearance."""
    asperity, roughness, clearance = bearing["asperity"], bearing["roughness"], bearing["radial_clearance"]
    if bearing["contact"] is not None:
        raise InputError(
            "JournalBearing.contact=RegularisedWall(...) and the gap of rough surfaces (asperity, roughness) "
            "exclude each other: both say which gap the film sees where surfaces touch; keep "
            "asperity=GreenwoodTripp(...) and leave out the wall."
        )
    heights = {float(part.composite_roughness) for part in (asperity, roughness) if part is not None}
    if len(heights) == 2:
        raise InputError(
            f"PatirCheng.composite_roughness ({roughness.composite_roughness:g} m) must equal "
            f"GreenwoodTripp.composite_roughness ({asperity.composite_roughness:g} m): they describe the same "
            "surfaces; the composite roughness is the root of the sum of both surfaces' squares, give it to both."
        )
    if not 4.0 * max(heights) < clearance:
        raise InputError(
            f"JournalBearing: the composite roughness {max(heights):g} m must be below a quarter of the radial "
            f"clearance {clearance:g} m; it is the standard deviation of the heights, in metres."
        )
