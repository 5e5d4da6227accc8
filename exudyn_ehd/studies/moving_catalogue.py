"""The moving scenes and their ladders."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.closures import Gumbel, SwiftStieber
from exudyn_ehd.film.cavitation.elrod_adams import ElrodAdams
from exudyn_ehd.film.grid import FiniteLength
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.solvers.sor import ClassicSOR
from exudyn_ehd.film.surfaces.asperity import GreenwoodTripp
from exudyn_ehd.film.surfaces.flow_factors import PatirCheng
from exudyn_ehd.film.surfaces.wall import RegularisedWall
from exudyn_ehd.joint.static.equilibrium import equilibrium
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from exudyn_ehd.studies import ladders, mechanisms
from exudyn_ehd.studies.moving import MovingScene, extremes, extremes_quantities, growth, mixed, mixed_quantities
from exudyn_ehd.studies.setting import Integration, QuantityOfInterest, Setting
from exudyn_ehd.studies.study import Reference, Study

STEEL = SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
GRIDS = ((32, 4), (48, 6), (64, 8), (96, 10), (128, 12))
LEVELS = ((64, 6), (128, 12), (256, 24))
CHEAP = FiniteLength(n_theta=64, n_z=8)
# An implicit run needs the paper's relaxation converged; at the paper's own tolerance its force is noise to Newton.
CLASSIC = ((ladders.PAPER_GRID, (ladders.PAPER_TOLERANCE, 1e-9)),)


def step_load_orbit() -> MovingScene:
    """Journal of 2 kg, d = 50 mm, c = 50 um, B = 25 mm, 0.02 Pa s, 100 pi rad/s; 2000 N from t = 0, concentric at rest."""
    motion = mechanisms.ConstantSpin(spin=100.0 * math.pi)
    bearing = JournalBearing(
        journal_radius=0.025, length=0.025, radial_clearance=50e-6, lubricant=Lubricant(viscosity=0.02)
    )
    return MovingScene(
        name="orbit", title="journal under a step load", bearing=bearing,
        build=partial(mechanisms.rotor, mass=2.0, load=(0.0, -2000.0), angle=motion.angle, spin=motion.spin_at, driven=False),
        end=0.04, steps=400, samples=40, observe=extremes, quantities=extremes_quantities(50e-6),
    )  # fmt: skip


def slider_pin() -> MovingScene:
    """Gudgeon pin of a slider-crank at 5000 rpm, R = 10 mm, L = 20 mm, c = 20 um, 0.02 Pa s; what follows the first half turn counts."""
    spin = 5000.0 * 2.0 * math.pi / 60.0
    bearing = JournalBearing(
        journal_radius=0.010, length=0.020, radial_clearance=20e-6, lubricant=Lubricant(viscosity=0.02)
    )
    return MovingScene(
        name="slider_pin", title="gudgeon pin of a slider-crank, 5000 rpm", bearing=bearing,
        build=partial(
            mechanisms.slider_crank, crank=0.05, rod=0.12, masses=(0.30, 0.21, 0.14), inertias=(8.5e-4, 2.5e-4), spin=spin
        ),
        end=1.5 * 2.0 * math.pi / spin, steps=540, samples=54, start=1.0 / 3.0,
        observe=extremes, quantities=extremes_quantities(20e-6),
    )  # fmt: skip


def big_end() -> MovingScene:
    """Big end of a connecting rod at 3000 rpm with a gas pulse, R = 24 mm, L = 22 mm, c = 25 um, 8 mPa s."""
    spin = 3000.0 * 2.0 * math.pi / 60.0
    bearing = JournalBearing(
        journal_radius=0.024, length=0.022, radial_clearance=25e-6, lubricant=Lubricant(viscosity=8e-3), film=CHEAP
    )
    return MovingScene(
        name="big_end", title="big end of a connecting rod, 3000 rpm", bearing=bearing,
        build=partial(
            mechanisms.slider_crank, crank=0.043, rod=0.14, masses=(3.0, 0.55, 0.5), inertias=(5e-3, 2e-3), spin=spin,
            piston_force=mechanisms.GasPulse(spin=spin, peak=25e3, width=0.35), big_end=True,
        ),
        end=1.4 * 2.0 * math.pi / spin, steps=504, samples=63, start=0.3,
        observe=extremes, quantities=extremes_quantities(25e-6),
    )  # fmt: skip


WHIRL_SPIN = 300.0
WHIRL_MASS_RATIO = 1.1
WHIRL_TURNS = 8


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
        name="whirl", title="oil whirl of a rotor 10 % above its threshold mass", bearing=bearing,
        build=partial(
            mechanisms.whirling_rotor, mass=WHIRL_MASS_RATIO * threshold.critical_mass, load=load, spin=WHIRL_SPIN,
            offset=offset,
        ),
        end=WHIRL_TURNS * 2.0 * math.pi / (threshold.whirl_ratio * WHIRL_SPIN), steps=80 * WHIRL_TURNS,
        samples=WHIRL_TURNS, start=2.0 / WHIRL_TURNS, observe=partial(growth, offset=offset, spin=WHIRL_SPIN),
        quantities=(
            QuantityOfInterest(name="growth", unit="1/rad", text="growth rate of the whirl over the spin"),
            QuantityOfInterest(name="frequency", unit="1", text="whirl frequency over the spin"),
        ),
    )  # fmt: skip


CONTACT = GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=1.1e11)


def start_stop() -> MovingScene:
    """Loaded journal that starts from rest on its bush and stops again: boundary, mixed and full lubrication; R = 25 mm, L = 25 mm."""
    bearing = JournalBearing(
        journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=Lubricant(viscosity=0.02), film=CHEAP,
        asperity=CONTACT, roughness=PatirCheng(composite_roughness=0.4e-6),
    )  # fmt: skip
    load, end = (0.0, -1500.0), 1.0
    motion = mechanisms.StartStop(top=30.0, end=end)
    rest = equilibrium(bearing, speed=1e-3, load=load).position
    return MovingScene(
        name="start_stop", title="start and stop in mixed friction", bearing=bearing,
        build=partial(
            mechanisms.rotor, mass=5.0, load=load, angle=motion.angle, spin=motion.spin_at,
            position=(float(rest[0]), float(rest[1])),
        ),
        end=end, steps=480, samples=80, observe=mixed, quantities=mixed_quantities(25e-6),
    )  # fmt: skip


SCENES: Mapping[str, Callable[[], MovingScene]] = {
    "orbit": step_load_orbit,
    "slider_pin": slider_pin,
    "big_end": big_end,
    "whirl": whirl,
    "start_stop": start_stop,
}


def film_study(scene: MovingScene, *, quick: bool = False) -> Study:
    """Film models in a moving scene, all with its own steps."""
    contact = scene.bearing.asperity is not None
    whirling = scene.name == "whirl"
    settings = ladders.film_ladder(
        grids=GRIDS[:3] if quick else GRIDS, aligned=not (contact or whirling or quick), reduced=False, classic=()
    )
    if contact:
        settings = tuple(s for s in settings if s.model == ladders.SWIFT)
    elif not quick:
        short = [s for s in ladders.film_ladder(grids=(), aligned=False, classic=()) if s.family == "short bearing"]
        settings += (*short, *_classic())
    references = ladders.film_references(short=False, grids=((48, 4), (96, 8), (192, 16)) if quick else LEVELS)
    return Study(
        name=f"{scene.name}_film", title=f"{scene.title}: film models", scene=scene, settings=settings,
        references=references[:1] if contact else references,
    )  # fmt: skip


def _classic() -> list[Setting]:
    """The paper's scheme: rule (11) at its own tolerance with a Newton tolerance that its noise allows, and converged."""
    out = []
    for tolerance, newton in ((ladders.PAPER_TOLERANCE, 1e-3), (1e-9, 1e-6)):
        grid = ladders.PAPER_GRID
        film = ClassicSOR(n_theta=grid[0], n_z=grid[1], tolerance=tolerance)
        paper = " (paper)" if tolerance == ladders.PAPER_TOLERANCE else ""
        out.append(
            Setting(
                label=f"SOR {ladders.grid_label(grid)}, {tolerance:.0e}{paper}", family="FD + SOR, Gumbel",
                model=ladders.GUMBEL, options={"film": film, "cavitation": Gumbel()},
                integration=Integration(newton_tolerance=newton),
            )
        )  # fmt: skip
    return out


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
        name=f"{scene.name}_integration", title=f"{scene.title}: step and integrator", scene=scene,
        settings=tuple(settings), references=(Reference(model=model, levels=(a, b, c), ratio=2.0),),
    )  # fmt: skip


def closure_study(scene: MovingScene) -> Study:
    """Cavitation closures in a moving scene, cavity 1 bar below ambient."""
    settings = ladders.closure_ladder(grids=((64, 8), (96, 10)))
    return Study(
        name=f"{scene.name}_closure", title=f"{scene.title}: cavitation", scene=scene,
        settings=tuple(s for s in settings if s.model != "full Sommerfeld"),
        references=tuple(
            r for r in ladders.closure_references(((48, 4), (96, 8), (192, 16))) if r.model != "full Sommerfeld"
        ),
    )  # fmt: skip


def rod_bush(size: ladders.MeshSize) -> HollowCylinder:
    """The rod's eye as a bush 8 mm thick."""
    axial, radial, circumferential = size
    return HollowCylinder(
        inner_radius=0.024, thickness=0.008, length=0.022, axial=axial, radial=radial, circumferential=circumferential
    )


# As for the steady bush: mesh, tolerance and film together.
ROD_LEVELS: tuple[ladders.BushLevel, ...] = (
    ((4, 2, 24), 3.2e-2, (48, 6)), ((6, 3, 36), 1.6e-2, (72, 9)), ((9, 4, 54), 8e-3, (108, 14)),
)  # fmt: skip


def bush_study(scene: MovingScene) -> Study:
    """Bushes in a moving scene: rigid, columns, modal by tolerance; nodal ones are compared at steady positions."""
    settings = ladders.bush_ladder(rod_bush, STEEL, tilted=False, tolerances=(0.2, 0.08, 0.04, 0.02), nodal_meshes=())
    return Study(
        name=f"{scene.name}_bush", title=f"{scene.title}: bush", scene=scene, settings=settings,
        references=ladders.bush_references(rod_bush, STEEL, tilted=False, levels=ROD_LEVELS),
    )  # fmt: skip


def mixed_effects_study(scene: MovingScene) -> Study:
    """What each effect of mixed friction is worth: left out one by one."""
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


def quick_moving_catalogue() -> dict[str, Callable[[], Study]]:
    """The journal under a step load with few rungs."""
    return {"orbit_film": partial(_make, "orbit", partial(film_study, quick=True))}


def _make(scene: str, study: Callable[[MovingScene], Study]) -> Study:
    return study(SCENES[scene]())
