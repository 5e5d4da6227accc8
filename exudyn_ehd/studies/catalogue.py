"""All studies: which scene meets which ladder."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from functools import partial
from typing import Any

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.lubricant.pressure_viscosity import RoelandsPressure
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear
from exudyn_ehd.film.lubricant.temperature_viscosity import VogelTemperature
from exudyn_ehd.film.supply import AxialGroove
from exudyn_ehd.film.surfaces.asperity import GreenwoodTripp
from exudyn_ehd.film.surfaces.flow_factors import PatirCheng
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.studies import ladders
from exudyn_ehd.studies.moving_catalogue import STEEL, moving_catalogue, quick_moving_catalogue
from exudyn_ehd.studies.steady import DEGREE, SteadyScene
from exudyn_ehd.studies.study import Study

QUICK_GRIDS = ((32, 4), (64, 8), (96, 10), (128, 12))
QUICK_CLASSIC = ((ladders.PAPER_GRID, (1e-3, ladders.PAPER_TOLERANCE)),)
# The directions of a steady scene lie around this one, rad; it is no symmetry direction of any grid.
DIRECTION = 0.3


def paper_journal() -> JournalBearing:
    """The rotating journal of the EHD joint paper: 66 mm long, clearance 30 um, 9 mPa s; R = 30 mm, which it leaves out."""
    return JournalBearing(
        journal_radius=0.03, length=0.066, radial_clearance=30e-6, lubricant=Lubricant(viscosity=9e-3)
    )


def steady_scene(eccentricity_ratio: float, tilt_ratio: float = 0.0) -> SteadyScene:
    """The paper's journal at 3000 rpm, held at an eccentricity."""
    tilted = "_tilted" if tilt_ratio > 0.0 else ""
    title = f"steady journal, eccentricity ratio {eccentricity_ratio:g}" + (
        f", tilt takes {tilt_ratio:.0%} of the smallest gap" if tilt_ratio > 0.0 else ""
    )
    return SteadyScene(
        name=f"steady_{round(1000 * eccentricity_ratio):03d}{tilted}", title=title, bearing=paper_journal(),
        speed=100.0 * math.pi, eccentricity_ratio=eccentricity_ratio, tilt_ratio=tilt_ratio, start_direction=DIRECTION,
    )  # fmt: skip


def _middle(scene: SteadyScene) -> float:
    return scene.start_direction + 0.5 * (scene.directions - 1) * DEGREE


def steady_film(scene: SteadyScene, *, quick: bool) -> Study:
    """Film models at a steady position."""
    middle = _middle(scene)
    aligned = scene.tilt_ratio == 0.0
    # the long bearing stands for the aligned journal with an inlet only
    settings = ladders.film_ladder(direction=middle, aligned=aligned, reduced=aligned)
    if quick:
        settings = ladders.film_ladder(
            grids=QUICK_GRIDS, direction=middle, aligned=False, reduced=False, classic=QUICK_CLASSIC
        )
    return Study(
        name=f"{scene.name}_film", title=f"{scene.title}: film models", scene=scene, settings=settings,
        references=ladders.film_references(short=aligned, grids=ladders.QUICK_REFERENCE_GRIDS if quick else ladders.REFERENCE_GRIDS),
        quantities=("load", "attitude", "friction", "peak pressure", "leakage", "stiffness", "damping"),
    )  # fmt: skip


def steady_closures(scene: SteadyScene) -> Study:
    """Cavitation closures at a steady position: cavity 1 bar below ambient, oil from an axial groove at the widest gap, 1 bar above."""
    groove = AxialGroove(angle=_middle(scene) + math.pi, width_angle=0.3, pressure=1e5)
    scene = dataclasses.replace(scene, bearing=dataclasses.replace(scene.bearing, supply=(groove,)))
    return Study(
        name=f"{scene.name}_closure", title=f"{scene.title}: cavitation", scene=scene,
        settings=ladders.closure_ladder(), references=ladders.closure_references(),
        quantities=("load", "attitude", "friction"),
    )  # fmt: skip


def paper_bush(size: ladders.MeshSize) -> HollowCylinder:
    """The paper's bush, 20 mm thick."""
    axial, radial, circumferential = size
    return HollowCylinder(
        inner_radius=0.03, thickness=0.02, length=0.066, axial=axial, radial=radial, circumferential=circumferential
    )


def steady_bush(scene: SteadyScene) -> Study:
    """Bushes at a steady position, steel, 20 mm thick, on one film grid and some on finer ones."""
    tilted = scene.tilt_ratio > 0.0
    scene = dataclasses.replace(scene, directions=2)
    return Study(
        name=f"{scene.name}_bush", title=f"{scene.title}: bush", scene=scene,
        settings=ladders.bush_ladder(paper_bush, STEEL, tilted=tilted, films=ladders.BUSH_FILMS),
        references=ladders.bush_references(paper_bush, STEEL, tilted=tilted),
        quantities=("load", "peak pressure", "minimum film", "friction", "stiffness"),
    )  # fmt: skip


def loaded_bearing() -> JournalBearing:
    """The paper's journal in an oil with every law of this package, with a film temperature field and rough surfaces."""
    oil = Lubricant(
        viscosity=9e-3, temperature=353.15, pressure_law=RoelandsPressure(coefficient=1.5e-8),
        temperature_law=VogelTemperature(first=(313.15, 0.0396), second=(373.15, 0.0059)),
        shear_law=CarreauShear(relaxation_time=1e-6, exponent=0.8, residual=0.5),
    )  # fmt: skip
    heat = FilmEnergy(supply_temperature=353.15, bush_coefficient=2000.0, journal_coefficient=2000.0)
    return dataclasses.replace(
        paper_journal(), lubricant=oil, thermal=heat, roughness=PatirCheng(composite_roughness=0.8e-6),
        asperity=GreenwoodTripp(composite_roughness=0.8e-6, composite_modulus=1.1e11),
        end_pressures=(1e3, 1e3),
    )  # fmt: skip


def steady_effects() -> Study:
    """Effects left out one by one, and all of them, at eccentricity ratio 0.85."""
    bearing = loaded_bearing()
    oil = bearing.lubricant
    scene = dataclasses.replace(
        steady_scene(0.85), name="steady_loaded", title="steady journal, eps 0.85, hot oil, rough surfaces",
        bearing=bearing, directions=2,
    )  # fmt: skip
    lumped = LumpedThermal(supply_temperature=353.15, housing_conductance=20.0)
    off: dict[str, dict[str, Any]] = {
        "all": {},
        "no pressure law": {"lubricant": dataclasses.replace(oil, pressure_law=None)},
        "no shear thinning": {"lubricant": dataclasses.replace(oil, shear_law=None)},
        "no heating": {"thermal": None},
        "one temperature": {"thermal": lumped},
        "no roughness": {"roughness": None},
        "no asperities": {"asperity": None},
        "none": {
            "lubricant": dataclasses.replace(oil, pressure_law=None, shear_law=None), "thermal": None, "roughness": None,
            "asperity": None,
        },
    }  # fmt: skip
    return ladders.effects_study(scene, off, ("load", "friction", "peak pressure", "leakage", "attitude"))


def full_catalogue() -> dict[str, Callable[[], Study]]:
    """Every shipped study by name; made when called."""
    studies: dict[str, Callable[[], Study]] = {}
    for eps, tilt in ((0.5, 0.0), (0.8, 0.0), (0.95, 0.0), (0.8, 0.5)):
        scene = steady_scene(eps, tilt)
        studies[f"{scene.name}_film"] = partial(steady_film, scene, quick=False)
    main = steady_scene(0.8)
    studies[f"{main.name}_closure"] = partial(steady_closures, main)
    studies[f"{main.name}_bush"] = partial(steady_bush, main)
    studies["steady_loaded_effects"] = steady_effects
    return studies | moving_catalogue()


def quick_catalogue() -> dict[str, Callable[[], Study]]:
    """A minute's worth of it: film models at a steady position and on a journal's path, and step and integrator there."""
    main = steady_scene(0.8)
    return {f"{main.name}_film": partial(steady_film, main, quick=True)} | quick_moving_catalogue()
