"""Ladders: lists of settings from coarse to fine, for every kind of study."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from exudyn_ehd.film.cavitation.closures import ElrodAdams, FullSommerfeld, Gumbel, SwiftStieber
from exudyn_ehd.film.models import FiniteLength, LongBearing, ShortBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.sor import ClassicSOR
from exudyn_ehd.film.supply.areas import AxialGroove
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.solid.bush import ANCFBush, ModalBush
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff as Material
from tests.benchmarks.accuracy.errors.study import Reference, Study
from tests.benchmarks.accuracy.scenes.setting import Integration, Scene, Setting

Grid = tuple[int, int]
MeshSize = tuple[int, int, int]
Mesh = Callable[[MeshSize], HollowCylinder]
GRIDS: tuple[Grid, ...] = ((32, 4), (48, 6), (64, 8), (96, 10), (128, 12), (192, 16), (256, 20))
REFERENCE_GRIDS: tuple[Grid, Grid, Grid] = ((192, 16), (384, 32), (768, 64))
EFFECT_GRIDS: tuple[Grid, Grid, Grid] = ((64, 6), (128, 12), (256, 24))
QUICK_REFERENCE_GRIDS: tuple[Grid, Grid, Grid] = ((64, 6), (128, 12), (256, 24))
SWIFT, GUMBEL, SHORT, LONG = "Swift-Stieber", "Gümbel", "short bearing", "long bearing"
ON_VERTICES = SwiftStieber(line_in_cells=False)
# The paper prints its tolerance, not its film grid; this one has a point at every node that its bush has on the bore.
PAPER_GRID, PAPER_TOLERANCE = (80, 8), 1e-5
CLASSIC = ((PAPER_GRID, (1e-3, PAPER_TOLERANCE, 1e-7)), ((96, 24), (1e-3, 1e-5, 1e-7)), ((192, 48), (1e-5, 1e-7)))
# Cavity pressure of the closures that are compared with the mass-conserving one, Pa gauge.
CAVITY = -1e5
SOLID, WINKLER = "elastic solid", "Winkler elements"
BushLevel = tuple[MeshSize, float, Grid | None]
# Mesh, tolerance and film are refined together: next to the ends a bore deflects within less than an interval of a
# coarse film, and finer modes on such a film converge to something else.
BUSH_LEVELS: tuple[BushLevel, ...] = (
    ((4, 2, 32), 8e-3, (128, 16)),
    ((6, 3, 48), 4e-3, (192, 24)),
    ((9, 4, 72), 2e-3, (288, 36)),
)
# Modes with finer films than the scene's.
BUSH_FILMS: tuple[tuple[float, Grid], ...] = ((0.02, (128, 12)), (0.02, (192, 16)), (0.01, (192, 24)))


def grid_label(grid: Grid) -> str:
    """``96 x 10``."""
    return f"{grid[0]} x {grid[1]}"


def film_ladder(
    *,
    grids: Iterable[Grid] = GRIDS,
    direction: float = 0.0,
    aligned: bool = True,
    reduced: bool = True,
    classic: Iterable[tuple[Grid, tuple[float, ...]]] = CLASSIC,
) -> tuple[Setting, ...]:
    """Film models: two-dimensional with two closures and with the rupture line on vertices, short, long, impedance
    map, and the paper's scheme.

    Parameters
    ----------
    grids : (n_theta, n_z) pairs
    direction : float
        Of the eccentricity, rad: the long bearing's inlet lies opposite.
    aligned : bool
        Include the impedance map, which knows no tilt.
    reduced : bool
        Include short and long bearing.
    classic : pairs of grid and tolerances
    """
    gumbel = {"cavitation": Gumbel()}
    out = [
        Setting(label=f"2D {grid_label(g)}", family="2D, Swift-Stieber", model=SWIFT, options={"film": _film(g)})
        for g in grids
    ]
    out += [
        Setting(
            label=f"line on vertices {grid_label(g)}",
            family="2D, Swift-Stieber, line on vertices",
            model=SWIFT,
            options={"film": _film(g), "cavitation": ON_VERTICES},
        )
        for g in grids
    ]
    out += [
        Setting(
            label=f"Gümbel {grid_label(g)}", family="2D, Gümbel", model=GUMBEL, options={"film": _film(g), **gumbel}
        )
        for g in grids
    ]
    if aligned:
        out.append(Setting(label="map", family="impedance map", model=SWIFT, options={"film": ImpedanceMap()}))
    if reduced:
        out += [
            Setting(
                label=f"short {n} x 8", family="short bearing", model=SHORT, options={"film": ShortBearing(n_theta=n)}
            )
            for n in (32, 128)
        ]
        out.append(
            Setting(
                label="long",
                family="long bearing",
                model=LONG,
                options={"film": LongBearing(), "supply": (AxialGroove(angle=direction + np.pi, width_angle=0.1),)},
            )
        )
    for grid, tolerances in classic:
        for tolerance in tolerances:
            paper = grid == PAPER_GRID and tolerance == PAPER_TOLERANCE
            film = ClassicSOR(n_theta=grid[0], n_z=grid[1], tolerance=tolerance)
            label = f"SOR {grid_label(grid)}, {tolerance:.0e}" + (" (paper)" if paper else "")
            out.append(Setting(label=label, family="FD + SOR, Gümbel", model=GUMBEL, options={"film": film, **gumbel}))
    return tuple(out)


def classic_in_motion() -> list[Setting]:
    """The paper's scheme: its own tolerance with a Newton tolerance that its noise allows, and converged."""
    out = []
    for tolerance, newton in ((PAPER_TOLERANCE, 1e-3), (1e-9, 1e-6)):
        grid = PAPER_GRID
        film = ClassicSOR(n_theta=grid[0], n_z=grid[1], tolerance=tolerance)
        paper = " (paper)" if tolerance == PAPER_TOLERANCE else ""
        out.append(
            Setting(
                label=f"SOR {grid_label(grid)}, {tolerance:.0e}{paper}",
                family="FD + SOR, Gümbel",
                model=GUMBEL,
                options={"film": film, "cavitation": Gumbel()},
                integration=Integration(newton_tolerance=newton),
            )
        )
    return out


def film_references(*, short: bool = True, grids: tuple[Grid, Grid, Grid] = REFERENCE_GRIDS) -> tuple[Reference, ...]:
    """Converged Swift-Stieber film, the dearest model of an isothermal rigid bearing, and those of the other models.

    Swift-Stieber's rupture line lies in the cells, so that its error is of second order.
    """

    def levels(model: str, **options) -> tuple[Setting, Setting, Setting]:
        a, b, c = (
            Setting(
                label=f"{model} {grid_label(g)}", family="reference", model=model, options={"film": _film(g), **options}
            )
            for g in grids
        )
        return a, b, c

    out = [Reference(model=SWIFT, levels=levels(SWIFT), ratio=2.0)]
    out.append(Reference(model=GUMBEL, levels=levels(GUMBEL, cavitation=Gumbel()), ratio=2.0))
    if short:
        a, b, c = (
            Setting(
                label=f"{SHORT} {n}", family="reference", model=SHORT, options={"film": ShortBearing(n_theta=n, n_z=16)}
            )
            for n in (512, 1024, 2048)
        )
        out.append(Reference(model=SHORT, levels=(a, b, c), ratio=2.0))
    return tuple(out)


def _film(grid: Grid) -> FiniteLength:
    return FiniteLength(n_theta=grid[0], n_z=grid[1])


CLOSURES = {
    "full Sommerfeld": FullSommerfeld(),
    "Gümbel": Gumbel(cavity_pressure=CAVITY),
    "Swift-Stieber": SwiftStieber(cavity_pressure=CAVITY),
    "mass conserving": ElrodAdams(cavity_pressure=CAVITY),
}


def closure_ladder(*, grids: Iterable[Grid] = ((64, 8), (96, 10), (192, 16))) -> tuple[Setting, ...]:
    """Every closure on some grids, with the cavity 1 bar below ambient."""
    return tuple(
        Setting(
            label=f"{name} {grid_label(g)}", family=name, model=name, options={"film": _film(g), "cavitation": closure}
        )
        for name, closure in CLOSURES.items()
        for g in grids
    )


def closure_references(grids: tuple[Grid, Grid, Grid] = ((128, 10), (256, 20), (512, 40))) -> tuple[Reference, ...]:
    """Mass conservation first, then every other closure."""
    out = []
    for name in ("mass conserving", "Swift-Stieber", "Gümbel", "full Sommerfeld"):
        a, b, c = (
            Setting(
                label=f"{name} {grid_label(g)}",
                family="reference",
                model=name,
                options={"film": _film(g), "cavitation": CLOSURES[name]},
            )
            for g in grids
        )
        out.append(Reference(model=name, levels=(a, b, c), ratio=2.0))
    return tuple(out)


def bush_ladder(
    mesh: Mesh,
    material: Material,
    *,
    tilted: bool,
    tolerances: Iterable[float] = (0.2, 0.08, 0.04, 0.02, 0.01, 0.005),
    modal_mesh: MeshSize = (4, 2, 40),
    nodal_meshes: Iterable[MeshSize] = ((2, 1, 16), (4, 1, 24), (4, 2, 40)),
    films: Iterable[tuple[float, Grid]] = (),
    liner: bool = True,
) -> tuple[Setting, ...]:
    """Rigid bore, liner of Winkler elements, modal bush by tolerance and mesh, nodal bush by mesh.

    Parameters
    ----------
    mesh : function of (axial, radial, circumferential)
        Gives the bush's `HollowCylinder`.
    material : SaintVenantKirchhoff
    tilted : bool
        Whether modal bushes need modes that are odd in z.
    tolerances : of `ModalBush`, on ``modal_mesh``
    modal_mesh : (axial, radial, circumferential)
    nodal_meshes : of `ANCFBush`
    films : pairs of a tolerance and a film grid other than the scene's
    liner : bool
        Include `ElasticLiner` of the bush's thickness.
    """
    out = [Setting(label="rigid", family="rigid", model="rigid")]
    if liner:
        winkler = ElasticLiner(
            thickness=mesh(modal_mesh).thickness,
            youngs_modulus=material.youngs_modulus,
            poisson_ratio=material.poisson_ratio,
        )
        out.append(Setting(label=WINKLER, family="liner", model=WINKLER, options={"bush": winkler}))
    for tolerance in tolerances:
        bush = ModalBush(mesh=mesh(modal_mesh), material=material, tolerance=tolerance, tilted=tilted)
        out.append(Setting(label=f"modal {tolerance:g}", family="modal", model=SOLID, options={"bush": bush}))
    for tolerance, grid in films:
        bush = ModalBush(mesh=mesh(modal_mesh), material=material, tolerance=tolerance, tilted=tilted)
        options = {"bush": bush, "film": _film(grid)}
        label = f"modal {tolerance:g}, film {grid_label(grid)}"
        out.append(Setting(label=label, family="modal, finer film", model=SOLID, options=options))
    for size in nodal_meshes:
        nodal = ANCFBush(mesh=mesh(size), material=material)
        out.append(Setting(label="nodal " + _mesh_label(size), family="nodal", model=SOLID, options={"bush": nodal}))
    return tuple(out)


def bush_references(
    mesh: Mesh, material: Material, *, tilted: bool, levels: tuple[BushLevel, ...] = BUSH_LEVELS
) -> tuple[Reference, ...]:
    """The elastic solid, by modes whose mesh, tolerance and film are refined together; parameters as in `bush_ladder`.

    ``levels`` are meshes, tolerances and films; None: the scene's film.
    """

    def level(size: MeshSize, tolerance: float, grid: Grid | None) -> Setting:
        options: dict[str, Any] = {
            "bush": ModalBush(mesh=mesh(size), material=material, tolerance=tolerance, tilted=tilted)
        }
        if grid is not None:
            options["film"] = _film(grid)
        label = f"modal {tolerance:g} on {_mesh_label(size)}"
        return Setting(label=label, family="reference", model=SOLID, options=options)

    a, b, c = (level(*one) for one in levels)
    return (Reference(model=SOLID, levels=(a, b, c), ratio=levels[1][0][2] / levels[0][0][2]),)


def _mesh_label(size: MeshSize) -> str:
    return " x ".join(str(n) for n in size)


def effects_study(scene: Scene, off: Mapping[str, Mapping[str, Any]], quantities: tuple[str, ...] = ()) -> Study:
    """Effects left out one by one, on the scene's grid, against all of them on fine grids.

    Parameters
    ----------
    scene : Scene
        With every effect.
    off : mapping
        Label to the options that leave something out; ``"all": {}`` first.
    quantities : tuple of str
        As for `Study`.
    """
    model = "all effects"
    settings = tuple(
        Setting(label=name, family=name, model=name if options else model, options=options)
        for name, options in off.items()
    )
    a, b, c = (
        Setting(label=f"all {grid_label(g)}", family="reference", model=model, options={"film": _film(g)})
        for g in EFFECT_GRIDS
    )
    return Study(
        name=f"{scene.name}_effects",
        title=f"{scene.title}: effects left out",
        scene=scene,
        settings=settings,
        references=(Reference(model=model, levels=(a, b, c), ratio=2.0),),
        quantities=quantities,
    )
