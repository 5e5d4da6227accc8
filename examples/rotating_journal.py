"""A rotating journal in a flexible bush: elastohydrodynamic pressure at a prescribed eccentricity.

The second case of P. Flores, "Modeling, Analysis and Simulation of 3D Elastohydrodynamic Revolute Joints in Multibody
Systems".

Length 66 mm, clearance 30 um, eccentricity 24 um, 3000 rpm, 9 mPa s, bush 20 mm thick with its outer surface fixed; E =
2.1e12 Pa as printed there, which is ten times steel, and steel, aluminium and a polymer. The paper omits the
journal's radius; 30 mm is assumed. Cavitation by Gümbel as in the paper and, next to it, mass conserving with a cavity
1 bar below the ends.

The flexible bore widens the film and lowers the peak; the film gets thicker. A liner does not deflect at its ends: for
tilted journals on soft liners the film at the edge is too thin for the grid, which is the same for all bushes.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
import warnings
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.pictures.style import styled

SPEED = 3000 * 2 * np.pi / 60
CLEARANCE, ECCENTRICITY = 30e-6, 24e-6
TILT = 1e-4
MODULI = {"E = 2.1e12 Pa (paper)": 2.1e12, "steel": 2.1e11, "aluminium": 7e10, "polymer": 3e9}
KINDS = {"liner": ehd.ElasticLiner, "modal": ehd.ModalBush, "nodal": ehd.ANCFBush}
CLOSURES = {"Gümbel": ehd.Gumbel(), "mass conserving": ehd.ElrodAdams(cavity_pressure=-1e5)}


def bush(
    modulus: float, kind: type, mesh: ehd.HollowCylinder, tilted: bool
) -> ehd.ElasticLiner | ehd.ModalBush | ehd.ANCFBush:
    """Return a bush of one material: liner, modal or nodal."""
    if kind is ehd.ElasticLiner:
        return ehd.ElasticLiner(thickness=mesh.thickness, youngs_modulus=modulus, poisson_ratio=0.3)
    material = ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0)
    if kind is ehd.ANCFBush:
        return ehd.ANCFBush(mesh=mesh, material=material)
    return ehd.ModalBush(mesh=mesh, material=material, tilted=tilted)


def solve(bearing: ehd.JournalBearing, tilt: float) -> dict:
    """Solve one case; the journal sinks along -y, theta counts from x."""
    start = time.perf_counter()
    with warnings.catch_warnings():
        # a liner does not deflect at its ends, where the film of a tilted journal is then too thin for the grid
        if isinstance(bearing.bush, ehd.ElasticLiner):
            warnings.simplefilter("ignore", ehd.GridWarning)
        film = ehd.steady(
            bearing, speed=SPEED, eccentricity_ratio=ECCENTRICITY / CLEARANCE, direction=-np.pi / 2, tilt=(0.0, tilt)
        )
    middle = film.z.size // 2
    return {
        "film": film,
        "peak_MPa": film.peak_pressure / 1e6,
        "load_kN": float(np.hypot(*film.force[:2])) / 1e3,
        "minimum_film_thickness_um": film.minimum_gap * 1e6,
        "extent_deg": 360.0 * float(np.mean(film.pressure[:, middle] > 1e3)),
        "asymmetry": float(np.abs(film.pressure - film.pressure[:, ::-1]).max() / film.peak_pressure),
        "solve_s": time.perf_counter() - start,
        "evaluation_ms": evaluation_time(bearing, film),
    }


def evaluation_time(bearing: ehd.JournalBearing, film: ehd.SteadyResult) -> float:
    """Return the processor time of one force and one Jacobian of the film in ms, at the solution."""
    model = build_model(bearing)
    motion = np.zeros(10)
    motion[1], motion[8] = -ECCENTRICITY, SPEED
    if film.bore_coordinates is not None:
        motion = np.concatenate((motion, film.bore_coordinates, 0 * film.bore_coordinates))
    times = []
    for _ in range(5):
        start = time.process_time()
        model.evaluate(motion).tangent()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


def main(*, quick: bool = False, results: str | Path | None = None) -> dict:
    """Solve all cases; with ``results`` write the pictures there.

    Returns
    -------
    dict
        {(cavitation, "aligned" or "tilted", bush): case}, with "pictures" if they were asked for.
    """
    mesh = ehd.HollowCylinder(
        inner_radius=0.03, thickness=0.02, length=0.066, axial=4, radial=2, circumferential=24 if quick else 40
    )
    rigid = ehd.JournalBearing(
        journal_radius=0.03,
        length=0.066,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=9e-3),
        film=ehd.FiniteLength(n_theta=64, n_z=8) if quick else ehd.FiniteLength(n_theta=96, n_z=16),
    )
    moduli = {"steel": 2.1e11} if quick else MODULI
    cases: dict = {}
    for closure, cavitation in CLOSURES.items():
        for name, tilt in (("aligned", 0.0), ("tilted", TILT)):
            plain = dataclasses.replace(rigid, cavitation=cavitation)
            cases[closure, name, "rigid"] = solve(plain, tilt)
            for material, modulus in moduli.items():
                for label, kind in KINDS.items():
                    bearing = dataclasses.replace(plain, bush=bush(modulus, kind, mesh, tilt > 0.0))
                    cases[closure, name, f"{material}, {label}"] = solve(bearing, tilt)
    if results is not None:
        folder = Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        cases["pictures"] = draw(cases, moduli, folder)
    return cases


@styled(10.0)
def draw(cases: dict, moduli: dict, folder: Path) -> list[Path]:
    """Write the pictures and return their paths."""
    figures = {
        "rotating_journal.png": summary_figure(cases, moduli),
        "rotating_journal_pressure.png": pressure_figure(cases, moduli),
        "rotating_journal_bore.png": bore_figure(cases, moduli),
    }
    for file, figure in figures.items():
        figure.savefig(folder / file, dpi=110)
    return [folder / file for file in figures]


def pressure_figure(cases: dict, moduli: dict) -> Figure:
    """Pressure over the angle at the mid-plane, as a map and as a surface."""
    figure = Figure(figsize=(13, 8), layout="constrained")
    for column, closure in enumerate(CLOSURES):
        axes = figure.add_subplot(2, 3, 1 + 3 * column)
        for film, style in rigid_and_modal(cases, moduli, closure):
            axes.plot(*at_middle(film, film.pressure / 1e6), **style)
        axes.set(
            xlabel="angle θ [°]",
            ylabel="pressure at the mid-plane [MPa]",
            title=f"aligned, {closure}",
            xticks=range(0, 361, 60),
        )
        axes.legend()
    for column, name in enumerate(("aligned", "tilted")):
        film = cases["Gümbel", name, "steel, modal"]["film"]
        axes = figure.add_subplot(2, 3, 2 + 3 * column)
        angle, pressure = np.degrees(around(film.theta, 2 * np.pi)), np.vstack((film.pressure, film.pressure[:1])) / 1e6
        picture = axes.contourf(angle, 1e3 * film.z, pressure.T, 24)
        figure.colorbar(picture, label="pressure [MPa]")
        axes.set(xlabel="angle θ [°]", ylabel="z [mm]", title=f"steel, {name}, Gümbel", xticks=range(0, 361, 60))
        view = figure.add_subplot(2, 3, 3 + 3 * column, projection="3d")
        T, Z = np.meshgrid(angle, 1e3 * film.z, indexing="ij")
        view.plot_surface(T, Z, pressure, cmap="viridis", rcount=97, ccount=17)
        view.set(
            xlabel="angle θ [°]",
            ylabel="z [mm]",
            title=f"steel, {name}, Gümbel: pressure [MPa]",
            xticks=range(0, 361, 90),
        )
    return figure


def summary_figure(cases: dict, moduli: dict) -> Figure:
    """Pressure and film thickness at the mid-plane, and the bore's shape there, aligned, Gümbel."""
    figure = Figure(figsize=(12, 4), layout="constrained")
    pressure, gap = figure.add_subplot(1, 3, 1), figure.add_subplot(1, 3, 2)
    draw_bores(figure.add_subplot(1, 3, 3, projection="polar"), cases, moduli)
    for film, style in rigid_and_modal(cases, moduli):
        pressure.plot(*at_middle(film, film.pressure / 1e6), **style)
        gap.plot(*at_middle(film, 1e6 * film.gap), **style)
    pressure.set(ylabel="pressure at the mid-plane [MPa]", title="pressure, Gümbel's condition")
    pressure.legend()
    gap.set(
        ylabel="film thickness at the mid-plane [µm]", ylim=(0, None), title="film thickness; the journal sinks to 270°"
    )
    for axes in (pressure, gap):
        axes.set(xlabel="angle θ [°]", xticks=range(0, 361, 60))
    return figure


def around(values: np.ndarray, end: float | None = None) -> np.ndarray:
    """Return values over the angle with the first one again at the end, where they have become ``end``."""
    return np.append(values, values[:1] if end is None else end)


def at_middle(film: ehd.SteadyResult, field: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return angles in degrees from 0 to 360 and a field [theta, z] there, at the mid-plane."""
    return np.degrees(around(film.theta, 2 * np.pi)), around(field[:, film.z.size // 2])


def draw_bores(polar: Axes, cases: dict, moduli: dict) -> None:
    """Draw the bore deflection at the mid-plane, aligned, Gümbel; the inner circle is the bore without load."""
    largest = 0.0
    for film, style in rigid_and_modal(cases, moduli):
        shift = np.zeros_like(film.gap) if film.bore_displacement is None else film.bore_displacement
        angle, shift = at_middle(film, 1e6 * shift)
        polar.plot(np.radians(angle), shift, **style)
        largest = max(largest, float(shift.max()))
    polar.set(title="radial displacement of the bore\nat the mid-plane [µm]", ylim=(0.0, 1.05 * largest))
    polar.set_rorigin(-2.0 * largest)
    polar.yaxis.set_major_locator(MaxNLocator(3))
    polar.set_rlabel_position(67.5)


def rigid_and_modal(
    cases: dict, moduli: dict, closure: str = "Gümbel"
) -> list[tuple[ehd.SteadyResult, dict[str, object]]]:
    """Return the films of the rigid bore and of all modal bushes, aligned, with label and style of their curves."""
    rigid = {"label": "rigid", "color": "black", "ls": "--", "zorder": 3}
    names = {"rigid": rigid} | {f"{m}, modal": {"label": m} for m in moduli}
    return [(cases[closure, "aligned", name]["film"], style) for name, style in names.items()]


def bore_figure(cases: dict, moduli: dict) -> Figure:
    """Scaled deformation of the bore, film thickness at the mid-plane, and the deformation over the bore."""
    figure = Figure(figsize=(13, 4.6), layout="constrained")
    polar = figure.add_subplot(1, 3, 1, projection="polar")
    gap = figure.add_subplot(1, 3, 2)
    draw_bores(polar, cases, moduli)
    for film, style in rigid_and_modal(cases, moduli):
        gap.plot(*at_middle(film, 1e6 * film.gap), **style)
    gap.set(
        xlabel="angle θ [°]",
        ylabel="film thickness at the mid-plane [µm]",
        ylim=(0, None),
        title="aligned, Gümbel",
        xticks=range(0, 361, 60),
    )
    gap.legend()
    film = cases["Gümbel", "tilted", "steel, modal"]["film"]
    axes = figure.add_subplot(1, 3, 3)
    assert film.bore_displacement is not None
    angle, shift = (
        np.degrees(around(film.theta, 2 * np.pi)),
        np.vstack((film.bore_displacement, film.bore_displacement[:1])),
    )
    picture = axes.contourf(angle, 1e3 * film.z, 1e6 * shift.T, 24)
    figure.colorbar(picture, label="µm")
    axes.set(
        xlabel="angle θ [°]",
        ylabel="z [mm]",
        title="radial displacement of the bore, steel, tilted",
        xticks=range(0, 361, 60),
    )
    return figure


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    outcome.pop("pictures")
    print(
        f"{'':55s}{'peak':>8s}{'load':>8s}{'minimum film thickness':>24s}{'extent':>8s}{'asymmetry':>11s}"
        f"{'evaluation':>12s}{'solve':>8s}"
    )
    print(f"{'':55s}{'MPa':>8s}{'kN':>8s}{'um':>24s}{'°':>8s}{'-':>11s}{'ms':>12s}{'s':>8s}")
    for (closure, name, label), case in outcome.items():
        print(
            f"{closure:17s}{name:10s}{label:28s}{case['peak_MPa']:8.2f}{case['load_kN']:8.2f}{case['minimum_film_thickness_um']:24.2f}"
            f"{case['extent_deg']:8.0f}{case['asymmetry']:11.1e}{case['evaluation_ms']:12.2f}{case['solve_s']:8.2f}"
        )
