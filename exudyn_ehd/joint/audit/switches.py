"""Switches of an audit: functions that add an effect to a bearing's description or remove it.

Added effects have typical numbers where the bearing does not name its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import scipy

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.closures import ElrodAdams, SwiftStieber
from exudyn_ehd.film.heat.options import Conduction, FilmEnergy, LumpedThermal, known_supply
from exudyn_ehd.film.lubricant.lubricant import ReynoldsTemperature
from exudyn_ehd.film.lubricant.pressure_viscosity import RoelandsPressure
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.reynolds.turbulence import NgPan
from exudyn_ehd.film.surfaces.roughness import GreenwoodTripp, PatirCheng
from exudyn_ehd.joint.balance.limits import is_fed

# Typical oils: pressure law and temperature coefficient, 1/K, of a mineral oil (ISO VG 46 near 70 degrees Celsius);
# shear law of a multigrade oil.
PIEZOVISCOSITY = RoelandsPressure(coefficient=2e-8)
TEMPERATURE_COEFFICIENT = 0.03
MULTIGRADE = CarreauShear(relaxation_time=1e-6, exponent=0.7, residual=0.5)
# Asperities of a ground steel journal in a finely turned steel bore.
ROUGH_STEEL = GreenwoodTripp(composite_roughness=0.5e-6, composite_modulus=1.15e11)
# Gauge pressure of oil vapour, Pa. Oil at a lower pressure is under tension.
VAPOUR_PRESSURE = -1e5
STEEL = {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7800.0}
RING_THICKNESS = 0.5  # of the bore radius

Switch = Callable[[JournalBearing], JournalBearing]


def _oil(bearing: JournalBearing, **laws: object) -> JournalBearing:
    return replace(bearing, lubricant=replace(bearing.lubricant, **laws))  # type: ignore[arg-type]


def _ring(elements: tuple[int, int, int], tolerance: float, bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with a steel ring, half a radius thick and held outside.

    ``elements``: numbers of finite elements (axial, radial, around).
    """
    # imported here: a rigid bearing needs no solid
    from exudyn_ehd.solid.bush import ModalBush
    from exudyn_ehd.solid.mesh import HollowCylinder
    from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff

    radius = bearing.journal_radius + bearing.radial_clearance
    sizes = {"inner_radius": radius, "thickness": RING_THICKNESS * radius, "length": bearing.length}
    axial, radial, around = elements
    mesh = HollowCylinder(**sizes, axial=axial, radial=radial, circumferential=around)
    bush = ModalBush(mesh=mesh, material=SaintVenantKirchhoff(**STEEL), tolerance=tolerance)
    return replace(bearing, bush=bush)


# The coarse ring takes below 0.1 s. Error of peak and minimum film thickness: 2 % where they change by 15 %, 8 % at 60
# %.
steel_ring, coarse_ring = partial(_ring, (4, 2, 40), 0.02), partial(_ring, (2, 1, 24), 0.08)


def _pin(tolerance: float, bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with a solid steel journal as long as the film, not held.

    With a ``tolerance`` of 0.08 the error of the peak pressure is 1 to 3 % where the change is large.
    """
    # imported here: a rigid bearing needs no solid
    from exudyn_ehd.solid.journal import ElasticJournal
    from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff

    half, steel = 0.5 * bearing.length, SaintVenantKirchhoff(**STEEL)
    return replace(bearing, journal=ElasticJournal(material=steel, span=(-half, half), held=None, tolerance=tolerance))


steel_pin, coarse_pin = partial(_pin, 0.02), partial(_pin, 0.08)


def heated(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with a temperature law of its oil and a thermal option; existing ones are kept.

    Added are the law of a mineral oil and `LumpedThermal`, whose oil is supplied at the lubricant's temperature.
    """
    oil = bearing.lubricant
    if oil.temperature_law is None:
        law = ReynoldsTemperature(point=(oil.temperature, oil.viscosity), coefficient=TEMPERATURE_COEFFICIENT)
        bearing = _oil(bearing, temperature_law=law)
    return replace(bearing, thermal=bearing.thermal or LumpedThermal(supply_temperature=oil.temperature))


def typical_conductances(bearing: JournalBearing) -> tuple[float, float]:
    """Conductances from a steel ring half a radius thick to air, and along a steel shaft to both sides, W/K.

    Still air takes 15 W/(m2 K) by convection and radiation. On either side heat leaves through four radii of the shaft.
    """
    R = bearing.journal_radius
    outside = 2.0 * math.pi * (1.0 + RING_THICKNESS) * R * bearing.length * 15.0
    return outside, 2.0 * math.pi * R * Conduction.conductivity / 4.0


def walled(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with a steel ring half a radius thick in air and a solid steel journal, both of which grow.

    Steel grows by 1.15e-5 per kelvin; oil whose conductivity is not given has 0.13 W/(m K).
    """
    R, thermal = bearing.journal_radius, bearing.thermal
    assert isinstance(thermal, FilmEnergy)
    outside, along = typical_conductances(bearing)
    bush = Conduction(thickness=RING_THICKNESS * R, conductance=outside, expansion=1.15e-5)
    journal = replace(bush, thickness=R, conductance=along)
    conductivity = 0.13 if thermal.conductivity is None else thermal.conductivity
    return replace(bearing, thermal=replace(thermal, bush=bush, journal=journal, conductivity=conductivity))


def isothermal(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with its oil at the supply temperature throughout."""
    assert bearing.thermal is not None
    oil, supply = bearing.lubricant, known_supply(bearing.thermal)
    oil = oil if oil.temperature_law is None else oil.at(supply)
    return replace(bearing, thermal=None, lubricant=oil)


def warmer(rise: float, coefficient: float) -> Switch:
    """Return a switch to the viscosity of a film that heats itself; ``rise``, K: rise at the unchanged viscosity.

    The heat is proportional to the viscosity, so the actual rise r solves r = rise exp(-coefficient r).
    """
    return partial(_thinner, math.exp(-float(scipy.special.lambertw(coefficient * rise).real)))


def _thinner(factor: float, bearing: JournalBearing) -> JournalBearing:
    return _oil(bearing, viscosity=factor * bearing.lubricant.viscosity)


def untouching(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing without contact and wear."""
    given = [name for name in ("asperity", "contact", "wear") if getattr(bearing, name) is not None]
    return replace(bearing, **dict.fromkeys(given))  # type: ignore[arg-type]


def roughness_height(bearing: JournalBearing) -> float:
    """Composite roughness of a bearing, m; a typical one if it names none."""
    return (bearing.asperity or bearing.roughness or ROUGH_STEEL).composite_roughness


def rough(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with flow factors of its roughness, or of a typical one."""
    return replace(bearing, roughness=PatirCheng(composite_roughness=roughness_height(bearing)))


def touching(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with steel asperities of its roughness, or of a typical one."""
    return replace(bearing, asperity=replace(ROUGH_STEEL, composite_roughness=roughness_height(bearing)))


def cavity_pressure(bearing: JournalBearing) -> float:
    """Pressure for cavities that conserve mass, Pa: the bearing's own, or that of oil vapour if no oil is fed in."""
    pressure = max(bearing.cavitation.cavity_pressure, VAPOUR_PRESSURE)
    return pressure if is_fed(bearing, pressure) else min(pressure, VAPOUR_PRESSURE)


def mass_conserving(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with `ElrodAdams` at the pressure of `cavity_pressure`."""
    return replace(bearing, cavitation=ElrodAdams(cavity_pressure=cavity_pressure(bearing)))


def swift_stieber(bearing: JournalBearing) -> JournalBearing:
    """Return the bearing with `SwiftStieber` at its cavity pressure."""
    pressure = max(bearing.cavitation.cavity_pressure, VAPOUR_PRESSURE)
    return replace(bearing, cavitation=SwiftStieber(cavity_pressure=pressure))


def on_grid(bearing: JournalBearing, n_theta: int, n_z: int) -> JournalBearing:
    """Return the bearing with a grid of this size."""
    return replace(bearing, film=replace(bearing.film, n_theta=n_theta, n_z=n_z))


# Switches that remove an effect, or add one that does not depend on the bearing.
rigid: Switch = partial(replace, bush=None)
rigid_journal: Switch = partial(replace, journal=None)
isoviscous: Switch = partial(_oil, pressure_law=None)
piezoviscous: Switch = partial(_oil, pressure_law=PIEZOVISCOSITY)
newtonian: Switch = partial(_oil, shear_law=None)
thinning: Switch = partial(_oil, shear_law=MULTIGRADE)
smooth: Switch = partial(replace, roughness=None)
unprofiled: Switch = partial(replace, profile=None)
unworn: Switch = partial(replace, wear=None)
squeezing: Switch = partial(replace, squeeze=True)
turbulent: Switch = partial(replace, turbulence=NgPan())
laminar: Switch = partial(replace, turbulence=None)
two_dimensional: Switch = partial(replace, film=FiniteLength())
