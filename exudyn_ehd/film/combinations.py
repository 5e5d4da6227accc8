"""Checks of the options of a bearing that exclude or need each other, made when the bearing is described."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal, Sump, known_supply
from exudyn_ehd.film.lubricant.lubricant import Lubricant, require_covered
from exudyn_ehd.film.models import FiniteLength, LongBearing
from exudyn_ehd.film.reynolds.turbulence import FOLLOWING, check_turbulence
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.sor import ClassicSOR
from exudyn_ehd.film.supply.restrictors import Capillary, GivenFlow
from exudyn_ehd.film.surfaces.contact import ElasticLiner
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
    if bearing["arcs"]:
        _check_arcs(bearing)
    check_turbulence("JournalBearing", bearing)
    _check_restrictors(bearing)
    if bearing["end_seals"] is not None:
        _check_seals(bearing)
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
    """Raise `InputError` for effects that the film model does not support."""
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
            "JournalBearing.film=ClassicSOR(...) is a plain film without roughness, turbulence, shear "
            "thinning or temperature field; use film=FiniteLength(...)."
        )


# Options that need the whole ring, or supply that needs arcs without a dam, and the reason.
RING_ALONE = {
    "film": "films of arcs are two-dimensional; use film=FiniteLength(...)",
    "inlet": "an arc has its inlet at its leading edge; leave inlet out",
    "supply": "rows of the grid lie beside the sides of dams, or on the edges of areas; leave one of the two out",
    "journal": "modes of a journal need a film all around; leave journal out",
    "bush": "of flexible bores only an ElasticLiner can be parted; use ElasticLiner(...), or leave bush out",
    "thermal": "a wall conducts heat around the whole bore; give the bush a coefficient and a temperature instead",
}


def _check_arcs(bearing: BearingOptions) -> None:
    """Raise `InputError` for options that arcs do not support."""
    goes = {
        "film": isinstance(bearing["film"], FiniteLength),
        "inlet": type(bearing["inlet"]).__name__ == "Periodic",
        "supply": not (bearing["supply"] and any(arc.dam for arc in bearing["arcs"])),
        "journal": bearing["journal"] is None,
        "bush": isinstance(bearing["bush"], ElasticLiner | None),
        "thermal": getattr(bearing["thermal"], "bush", None) is None,
    }
    for name in RING_ALONE:
        if not goes[name]:
            raise InputError(
                f"JournalBearing.arcs=(Arc(...), ...) does not go with JournalBearing.{name}={bearing[name]!r}: "
                f"{RING_ALONE[name]}."
            )


def _check_restrictors(bearing: BearingOptions) -> None:
    """Raise `InputError` for restrictors whose flow or oil temperature has no balance."""
    fed = [k for k, area in enumerate(bearing["supply"]) if isinstance(area.supply, Capillary)]
    if fed and isinstance(getattr(bearing["thermal"], "supply_temperature", None), Sump):
        raise InputError(
            f"JournalBearing.supply[{fed[0]}] with Capillary(...) does not go with supply_temperature=Sump(...): a "
            "capillary lets through what the viscosity of its oil allows, and the temperature of that oil follows from "
            "the flow itself; take an Orifice(...) or a GivenFlow(...), whose flow does not depend on the viscosity, "
            "or a known supply temperature."
        )
    if isinstance(bearing["film"], LongBearing) and any(isinstance(a.supply, GivenFlow) for a in bearing["supply"]):
        raise InputError(
            "JournalBearing.supply: GivenFlow(...) does not go with film=LongBearing(...), out of which no oil flows; "
            "use film=FiniteLength(...)."
        )


def _check_seals(bearing: BearingOptions) -> None:
    """Raise `InputError` for films that need a given pressure at a sealed end, or that have none anywhere."""
    seals, supply = bearing["end_seals"], bearing["supply"]
    others = [f"Lubricant.{law}" for law in FOLLOWING if getattr(bearing["lubricant"], law) is not None]
    others += [f"JournalBearing.{name}" for name in ("bush", "journal") if bearing[name]]
    others += [] if isinstance(bearing["film"], FiniteLength) else ["JournalBearing.film"]
    others += ["JournalBearing.thermal"] if isinstance(bearing["thermal"], FilmEnergy) else []
    if others:
        raise InputError(
            f"JournalBearing.end_seals does not go with {others[0]}: the pressure at a sealed end is unknown, which "
            "needs film=FiniteLength(...) between rigid surfaces, an oil whose density and viscosity do not follow the "
            "pressure, and one temperature; leave one of the two out."
        )
    pair = seals if isinstance(seals, tuple) else (seals,)
    tight = all(seal is not None and seal.conductance == 0.0 for seal in pair)
    if tight and not bearing["arcs"] and all(isinstance(area.supply, GivenFlow) for area in supply):
        raise InputError(
            "JournalBearing.end_seals: with a conductance of 0 at both ends nothing gives the film a pressure; give "
            "the bearing a supply with a pressure or an Orifice, or one of the seals a conductance."
        )


def require_viscosities(where: str, thermal: LumpedThermal | FilmEnergy, oil: Lubricant) -> None:
    """Raise `InputError` for temperatures of a thermal effect at which the oil's law gives no viscosity."""
    law = oil.temperature_law
    for name, value in (vars(thermal) | {"supply_temperature": known_supply(thermal)}).items():
        if law is None or value is None or not name.endswith("temperature"):
            continue
        require_covered(f"{where}.{name}", law, value)
        with np.errstate(all="ignore"):
            viscosity = float(law.viscosity(value, oil.density))
        if not LEAST_VISCOSITY <= viscosity <= LARGEST_VISCOSITY:
            raise InputError(
                f"{where}.{name} = {value!r} K: the lubricant's {type(law).__name__} gives a viscosity of "
                f"{viscosity:g} Pa s there; temperatures are in kelvin, 0 degrees Celsius are 273.15 K."
            )


def _check_heat(bearing: BearingOptions) -> None:
    """Raise `InputError` for temperatures without a viscosity, such as degrees Celsius given as kelvin, and for a
    temperature field that does not go with the bearing."""
    thermal, oil = bearing["thermal"], bearing["lubricant"]
    require_viscosities("JournalBearing.thermal", thermal, oil)
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
    """Raise `InputError` for rough surfaces with a wall, of two roughnesses, or too rough for the clearance."""
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
