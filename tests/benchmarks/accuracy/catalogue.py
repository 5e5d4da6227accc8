"""All studies: which scene meets which ladder."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from functools import partial
from typing import Any

from exudyn_ehd.film.cavitation.closures import ElrodAdams, Gumbel, SwiftStieber
from exudyn_ehd.film.heat.options import LumpedThermal
from exudyn_ehd.film.supply.areas import AxialGroove
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.solid.mesh import HollowCylinder
from tests.benchmarks.accuracy.errors import ladders
from tests.benchmarks.accuracy.errors.study import Reference, Study
from tests.benchmarks.accuracy.scenes.measured import CHEAP, SCENES, STEEL, fed_scene, loaded_bearing, steady_scene
from tests.benchmarks.accuracy.scenes.moving import MovingScene
from tests.benchmarks.accuracy.scenes.setting import Integration, Setting
from tests.benchmarks.accuracy.scenes.steady import DEGREE, SteadyScene

QUICK_GRIDS = ((32, 4), (64, 8), (96, 10), (128, 12))
QUICK_CLASSIC = ((ladders.PAPER_GRID, (1e-3, ladders.PAPER_TOLERANCE)),)
MOVING_GRIDS = ((32, 4), (48, 6), (64, 8), (96, 10), (128, 12))
MOVING_LEVELS = ((64, 6), (128, 12), (256, 24))
QUICK_LEVELS = ((48, 4), (96, 8), (192, 16))
# As for the steady bush: mesh, tolerance and film together.
ROD_LEVELS: tuple[ladders.BushLevel, ...] = (
    ((4, 2, 24), 3.2e-2, (48, 6)),
    ((6, 3, 36), 1.6e-2, (72, 9)),
    ((9, 4, 54), 8e-3, (108, 14)),
)


# --- journals held in place -------------------------------------------------------------------------------------------


def _middle(scene: SteadyScene) -> float:
    return scene.start_direction + 0.5 * (scene.directions - 1) * DEGREE


def steady_film(scene: SteadyScene, *, quick: bool, more: tuple[str, ...] = ()) -> Study:
    """Film models at a steady position; ``more``: quantities besides those of all such studies."""
    middle = _middle(scene)
    aligned = scene.tilt_ratio == 0.0
    # the long bearing stands for the aligned journal with an inlet only
    settings = ladders.film_ladder(direction=middle, aligned=aligned, reduced=aligned)
    if quick:
        settings = ladders.film_ladder(
            grids=QUICK_GRIDS, direction=middle, aligned=False, reduced=False, classic=QUICK_CLASSIC
        )
    return Study(
        name=f"{scene.name}_film",
        title=f"{scene.title}: film models",
        scene=scene,
        settings=settings,
        references=ladders.film_references(
            short=aligned, grids=ladders.QUICK_REFERENCE_GRIDS if quick else ladders.REFERENCE_GRIDS
        ),
        quantities=("load", "attitude", "friction", "peak pressure", "leakage", "stiffness", "damping", *more),
    )


def fed_film() -> Study:
    """Grids of a journal that a groove feeds."""
    scene = fed_scene()
    grids = ladders.film_ladder(aligned=False, reduced=False, classic=())
    return Study(
        name=f"{scene.name}_film",
        title=f"{scene.title}: film models",
        scene=scene,
        settings=tuple(s for s in grids if s.model == ladders.SWIFT),
        references=ladders.film_references(short=False)[:1],
        quantities=("load", "peak pressure", "supply flow", "leakage", "stiffness", "damping", "critical mass"),
    )


def steady_closures(scene: SteadyScene) -> Study:
    """Closures at a steady position: cavity 1 bar below ambient, oil 1 bar above from a groove at the widest gap."""
    groove = AxialGroove(angle=_middle(scene) + math.pi, width_angle=0.3, pressure=1e5)
    scene = dataclasses.replace(scene, bearing=dataclasses.replace(scene.bearing, supply=(groove,)))
    return Study(
        name=f"{scene.name}_closure",
        title=f"{scene.title}: cavitation",
        scene=scene,
        settings=ladders.closure_ladder(),
        references=ladders.closure_references(),
        quantities=("load", "attitude", "friction"),
    )


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
        name=f"{scene.name}_bush",
        title=f"{scene.title}: bush",
        scene=scene,
        settings=ladders.bush_ladder(paper_bush, STEEL, tilted=tilted, films=ladders.BUSH_FILMS),
        references=ladders.bush_references(paper_bush, STEEL, tilted=tilted),
        quantities=("load", "peak pressure", "minimum film thickness", "friction", "stiffness"),
    )


def steady_effects() -> Study:
    """Effects left out one by one, and all of them, at eccentricity ratio 0.85."""
    bearing = loaded_bearing()
    oil = bearing.lubricant
    scene = dataclasses.replace(
        steady_scene(0.85),
        name="steady_loaded",
        title="steady journal, eps 0.85, hot oil, rough surfaces",
        bearing=bearing,
        directions=2,
    )
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
            "lubricant": dataclasses.replace(oil, pressure_law=None, shear_law=None),
            "thermal": None,
            "roughness": None,
            "asperity": None,
        },
    }
    return ladders.effects_study(scene, off, ("load", "friction", "peak pressure", "leakage", "attitude"))


# --- moving journals --------------------------------------------------------------------------------------------------


def film_study(scene: MovingScene, *, quick: bool = False) -> Study:
    """Film models in a moving scene, all with its own steps."""
    contact = scene.bearing.asperity is not None
    whirling = scene.name == "whirl"
    settings = ladders.film_ladder(
        grids=MOVING_GRIDS[:3] if quick else MOVING_GRIDS,
        aligned=not (contact or whirling or quick),
        reduced=False,
        classic=(),
    )
    if contact:
        settings = tuple(s for s in settings if s.model == ladders.SWIFT)
    elif not quick:
        short = [s for s in ladders.film_ladder(grids=(), aligned=False, classic=()) if s.family == "short bearing"]
        settings += (*short, *ladders.classic_in_motion())
    references = ladders.film_references(short=False, grids=QUICK_LEVELS if quick else MOVING_LEVELS)
    return Study(
        name=f"{scene.name}_film",
        title=f"{scene.title}: film models",
        scene=scene,
        settings=settings,
        references=references[:1] if contact else references,
        quantities=scene.of_models,
    )


def integration_study(scene: MovingScene, *, runge_kutta: int | None = None) -> Study:
    """Step size, spectral radius, Newton tolerance and integrator on one film grid, 64 x 8.

    Parameters
    ----------
    scene : MovingScene
    runge_kutta : int or None
        Multiple of the scene's steps at which explicit Runge-Kutta is stable; None leaves it out.
    """
    scene = dataclasses.replace(scene, bearing=dataclasses.replace(scene.bearing, film=CHEAP))
    n = scene.steps
    model = "64 x 8, converged in time"

    def rung(label: str, family: str, **options: Any) -> Setting:
        return Setting(label=label, family=family, model=model, integration=Integration(**options))

    settings = []
    for radius in (0.8, 1.0, 0.5, 0.0):
        for factor in (0.25, 0.5, 1.0, 2.0, 4.0):
            steps = round(n * factor)
            if radius == 0.8 or factor in (0.5, 1.0):
                settings.append(
                    rung(
                        f"{steps} steps, rho {radius:g}",
                        f"generalised alpha, rho {radius:g}",
                        steps=steps,
                        spectral_radius=radius,
                    )
                )
    for tolerance in (1e-2, 1e-3, 1e-4, 1e-5, 1e-8):
        settings.append(rung(f"Newton {tolerance:.0e}", "Newton tolerance", steps=n, newton_tolerance=tolerance))
    settings.append(rung("modified Newton", "modified Newton", steps=n, modified_newton=True))
    if runge_kutta is not None:
        settings.append(
            rung(f"RK4 {n * runge_kutta} steps", "explicit Runge-Kutta", steps=n * runge_kutta, runge_kutta=True)
        )
    a, b, c = (rung(f"{n * k} steps", "reference", steps=n * k, newton_tolerance=1e-7) for k in (2, 4, 8))
    return Study(
        name=f"{scene.name}_integration",
        title=f"{scene.title}: step and integrator",
        scene=scene,
        settings=tuple(settings),
        references=(Reference(model=model, levels=(a, b, c), ratio=2.0),),
    )


def closure_study(scene: MovingScene) -> Study:
    """Cavitation closures in a moving scene, cavity 1 bar below ambient."""
    settings = ladders.closure_ladder(grids=((64, 8), (96, 10)))
    return Study(
        name=f"{scene.name}_closure",
        title=f"{scene.title}: cavitation",
        scene=scene,
        settings=tuple(s for s in settings if s.model != "full Sommerfeld"),
        references=tuple(r for r in ladders.closure_references(QUICK_LEVELS) if r.model != "full Sommerfeld"),
        quantities=scene.of_models,
    )


def rod_bush(size: ladders.MeshSize) -> HollowCylinder:
    """The rod's eye as a bush 8 mm thick."""
    axial, radial, circumferential = size
    return HollowCylinder(
        inner_radius=0.024, thickness=0.008, length=0.022, axial=axial, radial=radial, circumferential=circumferential
    )


def bush_study(scene: MovingScene) -> Study:
    """Bushes in a moving scene: rigid, Winkler elements, modal by tolerance;
    nodal ones are compared at steady positions."""
    settings = ladders.bush_ladder(rod_bush, STEEL, tilted=False, tolerances=(0.2, 0.08, 0.04, 0.02), nodal_meshes=())
    return Study(
        name=f"{scene.name}_bush",
        title=f"{scene.title}: bush",
        scene=scene,
        settings=settings,
        references=ladders.bush_references(rod_bush, STEEL, tilted=False, levels=ROD_LEVELS),
        quantities=scene.of_models,
    )


def mixed_effects_study(scene: MovingScene) -> Study:
    """Study of mixed friction: errors and times with its effects switched off one by one."""
    off: dict[str, dict[str, Any]] = {
        "all": {},
        "no roughness": {"roughness": None},
        "wall for rough surfaces": {"asperity": None, "roughness": None, "contact": RegularisedWall(onset=1e-6)},
        "no squeeze": {"squeeze": False},
        "Gumbel": {"cavitation": Gumbel()},
        "mass conserving": {"cavitation": ElrodAdams(cavity_pressure=-1e5)},
        "cavity at -1 bar": {"cavitation": SwiftStieber(cavity_pressure=-1e5)},
    }
    return ladders.effects_study(scene, off)


# --- all of them ------------------------------------------------------------------------------------------------------


def moving_catalogue() -> dict[str, Callable[[], Study]]:
    """Every study of a moving scene by name; made when called."""
    ladders_of: dict[str, dict[str, Callable[[MovingScene], Study]]] = {
        "orbit": {
            "film": film_study,
            "closure": closure_study,
            "integration": partial(integration_study, runge_kutta=24),
        },
        "slider_pin": {"film": film_study, "integration": integration_study},
        "big_end": {"bush": bush_study, "integration": integration_study},
        "whirl": {"film": film_study, "integration": integration_study},
        "start_stop": {"film": film_study, "integration": integration_study, "effects": mixed_effects_study},
    }
    return {
        f"{name}_{ladder}": partial(_make, name, make)
        for name, chosen in ladders_of.items()
        for ladder, make in chosen.items()
    }


def _make(scene: str, study: Callable[[MovingScene], Study]) -> Study:
    return study(SCENES[scene]())


def full_catalogue() -> dict[str, Callable[[], Study]]:
    """Every shipped study by name; made when called."""
    studies: dict[str, Callable[[], Study]] = {}
    for eps, tilt in ((0.5, 0.0), (0.8, 0.0), (0.95, 0.0), (0.8, 0.5)):
        scene = steady_scene(eps, tilt)
        # the others are stable with any mass
        more = ("critical mass",) if eps == 0.5 else ()
        studies[f"{scene.name}_film"] = partial(steady_film, scene, quick=False, more=more)
    studies["steady_600_fed_film"] = fed_film
    main = steady_scene(0.8)
    studies[f"{main.name}_closure"] = partial(steady_closures, main)
    studies[f"{main.name}_bush"] = partial(steady_bush, main)
    studies["steady_loaded_effects"] = steady_effects
    return studies | moving_catalogue()


def quick_catalogue() -> dict[str, Callable[[], Study]]:
    """A minute's worth of it: film models at a steady position and on a journal's path."""
    main = steady_scene(0.8)
    return {
        f"{main.name}_film": partial(steady_film, main, quick=True),
        "orbit_film": partial(_make, "orbit", partial(film_study, quick=True)),
    }
