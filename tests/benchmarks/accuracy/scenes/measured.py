"""The scenes that are measured: journals held in place, and journals that move in mechanisms."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.film.lubricant.lubricant import Lubricant, VogelTemperature
from exudyn_ehd.film.lubricant.pressure_viscosity import RoelandsPressure
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.supply.areas import AxialGroove
from exudyn_ehd.film.surfaces.roughness import GreenwoodTripp, PatirCheng
from exudyn_ehd.joint.static.equilibrium import equilibrium
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from tests.benchmarks.accuracy.scenes import mechanisms
from tests.benchmarks.accuracy.scenes.moving import (
    MovingScene,
    extremes,
    extremes_quantities,
    growth,
    mixed,
    mixed_quantities,
)
from tests.benchmarks.accuracy.scenes.setting import QuantityOfInterest
from tests.benchmarks.accuracy.scenes.steady import SteadyScene

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CHEAP = FiniteLength(n_theta=64, n_z=8)
CONTACT = GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=1.1e11)
# The directions of a steady scene lie around this one, rad; it is no symmetry direction of any grid.
DIRECTION = 0.3
WHIRL_SPIN = 300.0
WHIRL_MASS_RATIO = 1.1
WHIRL_TURNS = 8


def paper_journal() -> JournalBearing:
    """The rotating journal of the paper on EHD joints: L = 66 mm, c = 30 um, 9 mPa s; R = 30 mm, which it omits."""
    return JournalBearing(
        journal_radius=0.03, length=0.066, radial_clearance=30e-6, lubricant=Lubricant(viscosity=9e-3)
    )


def steady_scene(eccentricity_ratio: float, tilt_ratio: float = 0.0) -> SteadyScene:
    """The paper's journal at 3000 rpm, held at an eccentricity."""
    tilted = "_tilted" if tilt_ratio > 0.0 else ""
    title = f"steady journal, eccentricity ratio {eccentricity_ratio:g}" + (
        f", tilt takes {tilt_ratio:.0%} of the minimum film thickness" if tilt_ratio > 0.0 else ""
    )
    return SteadyScene(
        name=f"steady_{round(1000 * eccentricity_ratio):03d}{tilted}",
        title=title,
        bearing=paper_journal(),
        speed=100.0 * math.pi,
        eccentricity_ratio=eccentricity_ratio,
        tilt_ratio=tilt_ratio,
        start_direction=DIRECTION,
    )


def fed_scene() -> SteadyScene:
    """The paper's journal with oil at 2 bar from a groove of 20 degrees, upstream of the converging gap."""
    scene = steady_scene(0.6)
    groove = AxialGroove(angle=DIRECTION + 0.75 * math.pi, width_angle=math.pi / 9.0, pressure=2e5)
    return dataclasses.replace(
        scene,
        name="steady_600_fed",
        title="steady journal, eccentricity ratio 0.6, 2 bar from a groove of 20 degrees",
        bearing=dataclasses.replace(scene.bearing, supply=(groove,)),
    )


def loaded_bearing() -> JournalBearing:
    """The paper's journal with pressure, temperature and shear laws of its oil, a heated film and rough surfaces."""
    oil = Lubricant(
        viscosity=9e-3,
        temperature=353.15,
        pressure_law=RoelandsPressure(coefficient=1.5e-8),
        temperature_law=VogelTemperature(first=(313.15, 0.0396), second=(373.15, 0.0059)),
        shear_law=CarreauShear(relaxation_time=1e-6, exponent=0.8, residual=0.5),
    )
    heat = FilmEnergy(supply_temperature=353.15, bush_coefficient=2000.0, journal_coefficient=2000.0)
    return dataclasses.replace(
        paper_journal(),
        lubricant=oil,
        thermal=heat,
        roughness=PatirCheng(composite_roughness=0.8e-6),
        asperity=GreenwoodTripp(composite_roughness=0.8e-6, composite_modulus=1.1e11),
        end_pressures=(1e3, 1e3),
    )


def step_load_orbit() -> MovingScene:
    """Journal of 2 kg, d = 50 mm, c = 50 um, L = 25 mm, 0.02 Pa s, 100 pi rad/s; 2000 N from t = 0, concentric."""
    motion = mechanisms.ConstantSpin(spin=100.0 * math.pi)
    bearing = JournalBearing(
        journal_radius=0.025, length=0.025, radial_clearance=50e-6, lubricant=Lubricant(viscosity=0.02)
    )
    return MovingScene(
        name="orbit",
        title="journal under a step load",
        bearing=bearing,
        build=partial(
            mechanisms.rotor, mass=2.0, load=(0.0, -2000.0), angle=motion.angle, spin=motion.spin_at, driven=False
        ),
        end=0.04,
        steps=400,
        samples=40,
        observe=extremes,
        quantities=extremes_quantities(50e-6),
    )


def slider_pin() -> MovingScene:
    """Gudgeon pin of a slider-crank at 5000 rpm, R = 10 mm, L = 20 mm, c = 20 um, 0.02 Pa s.

    What follows the first half turn counts.
    """
    spin = 5000.0 * 2.0 * math.pi / 60.0
    bearing = JournalBearing(
        journal_radius=0.010, length=0.020, radial_clearance=20e-6, lubricant=Lubricant(viscosity=0.02)
    )
    return MovingScene(
        name="slider_pin",
        title="gudgeon pin of a slider-crank, 5000 rpm",
        bearing=bearing,
        build=partial(
            mechanisms.slider_crank,
            crank=0.05,
            rod=0.12,
            masses=(0.30, 0.21, 0.14),
            inertias=(8.5e-4, 2.5e-4),
            spin=spin,
        ),
        end=1.5 * 2.0 * math.pi / spin,
        steps=540,
        samples=54,
        start=1.0 / 3.0,
        observe=extremes,
        quantities=extremes_quantities(20e-6),
    )


def big_end() -> MovingScene:
    """Big end of a connecting rod at 3000 rpm with a gas pulse, R = 24 mm, L = 22 mm, c = 25 um, 8 mPa s."""
    spin = 3000.0 * 2.0 * math.pi / 60.0
    bearing = JournalBearing(
        journal_radius=0.024, length=0.022, radial_clearance=25e-6, lubricant=Lubricant(viscosity=8e-3), film=CHEAP
    )
    return MovingScene(
        name="big_end",
        title="big end of a connecting rod, 3000 rpm",
        bearing=bearing,
        build=partial(
            mechanisms.slider_crank,
            crank=0.043,
            rod=0.14,
            masses=(3.0, 0.55, 0.5),
            inertias=(5e-3, 2e-3),
            spin=spin,
            piston_force=mechanisms.GasPulse(spin=spin, peak=25e3, width=0.35),
            big_end=True,
        ),
        end=1.4 * 2.0 * math.pi / spin,
        steps=504,
        samples=63,
        start=0.3,
        observe=extremes,
        quantities=extremes_quantities(25e-6),
    )


def whirl() -> MovingScene:
    """Rigid rotor 10 % above its threshold mass at eccentricity ratio 0.2, released close to its equilibrium."""
    bearing = JournalBearing(
        journal_radius=0.025, length=0.025, radial_clearance=50e-6, lubricant=Lubricant(viscosity=0.02)
    )
    load = (0.0, -0.0784 * bearing.reference_force(WHIRL_SPIN))
    fine = dataclasses.replace(bearing, film=FiniteLength(n_theta=384, n_z=32))
    threshold = equilibrium(fine, speed=WHIRL_SPIN, load=load)
    offset = (1e-4 * bearing.radial_clearance, 0.0)
    return MovingScene(
        name="whirl",
        title="oil whirl of a rotor 10 % above its threshold mass",
        bearing=bearing,
        build=partial(
            mechanisms.whirling_rotor,
            mass=WHIRL_MASS_RATIO * threshold.critical_mass,
            load=load,
            spin=WHIRL_SPIN,
            offset=offset,
        ),
        end=WHIRL_TURNS * 2.0 * math.pi / (threshold.whirl_ratio * WHIRL_SPIN),
        steps=80 * WHIRL_TURNS,
        samples=WHIRL_TURNS,
        start=2.0 / WHIRL_TURNS,
        observe=partial(growth, offset=offset, spin=WHIRL_SPIN),
        quantities=(
            QuantityOfInterest(name="growth", unit="1/rad", text="growth rate of the whirl over the spin"),
            QuantityOfInterest(name="frequency", unit="1", text="whirl frequency over the spin"),
        ),
    )


def start_stop() -> MovingScene:
    """Loaded journal that starts from rest on its bush and stops again: boundary, mixed and full lubrication."""
    bearing = JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=Lubricant(viscosity=0.02),
        film=CHEAP,
        asperity=CONTACT,
        roughness=PatirCheng(composite_roughness=0.4e-6),
    )
    load, end = (0.0, -1500.0), 1.0
    motion = mechanisms.StartStop(top=30.0, end=end)
    return MovingScene(
        name="start_stop",
        title="start and stop in mixed friction",
        bearing=bearing,
        build=partial(_rotor_at_rest, mass=5.0, load=load, angle=motion.angle, spin=motion.spin_at),
        end=end,
        steps=480,
        samples=80,
        observe=mixed,
        quantities=mixed_quantities(25e-6),
    )


def _rotor_at_rest(bearing: JournalBearing, *, load: tuple[float, float], **options: Any) -> mechanisms.Built:
    """`mechanisms.rotor` that lies where this very film and its asperities carry the load at rest.

    Another film's place is off by a part of the asperities' height, from which contact throws the journal.
    """
    rest = equilibrium(dataclasses.replace(bearing, asperity=CONTACT), speed=1e-3, load=load).position
    return mechanisms.rotor(bearing, load=load, position=(float(rest[0]), float(rest[1])), **options)


SCENES: Mapping[str, Callable[[], MovingScene]] = {
    "orbit": step_load_orbit,
    "slider_pin": slider_pin,
    "big_end": big_end,
    "whirl": whirl,
    "start_stop": start_stop,
}
