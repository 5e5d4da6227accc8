"""A rotating journal in a flexible bush: elastohydrodynamic pressure at a prescribed eccentricity.

The second case of P. Flores, "Modeling, Analysis and Simulation of 3D Elastohydrodynamic Revolute Joints in Multibody Systems".

Length 66 mm, clearance 30 um, eccentricity 24 um, 3000 rpm, 9 mPa s, bush 20 mm thick with its outer surface fixed; E = 2.1e12 Pa as
printed there, which is ten times steel, and steel, aluminium and a polymer. The paper leaves out the journal's radius; 30 mm
assumed. Cavitation by Gumbel as in the paper and, beside it, mass conserving with a cavity 1 bar below the ends.

The flexible bore widens the film and lowers the peak; the film gets thicker.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import exudyn_ehd as ehd
from exudyn_ehd.joint.build import build_model
from exudyn_ehd.pictures.style import styled

SPEED = 3000 * 2 * np.pi / 60
CLEARANCE, ECCENTRICITY = 30e-6, 24e-6
TILT = 1e-4
MODULI = {"E = 2.1e12 (paper)": 2.1e12, "steel": 2.1e11, "aluminium": 7e10, "polymer": 3e9}
CLOSURES = {"Gumbel": ehd.Gumbel(), "mass conserving": ehd.ElrodAdams(cavity_pressure=-1e5)}


def bush(
    modulus: float, kind: type, mesh: ehd.HollowCylinder, tilted: bool
) -> ehd.ElasticLiner | ehd.ModalBush | ehd.ANCFBush:
    """Return a bush of one material: columns of its thickness, modal or nodal."""
    if kind is ehd.ElasticLiner:
        return ehd.ElasticLiner(thickness=mesh.thickness, youngs_modulus=modulus, poisson_ratio=0.3)
    material = ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0)
    if kind is ehd.ANCFBush:
        return ehd.ANCFBush(mesh=mesh, material=material)
    return ehd.ModalBush(mesh=mesh, material=material, tilted=tilted)


def solve(bearing: ehd.JournalBearing, tilt: float) -> dict:
    """Solve one case; the journal sinks along -y, theta counts from x."""
    start = time.perf_counter()
    film = ehd.steady(
        bearing, speed=SPEED, eccentricity_ratio=ECCENTRICITY / CLEARANCE, direction=-np.pi / 2, tilt=(0.0, tilt)
    )
    middle = film.z.size // 2
    return {
        "film": film,
        "peak_MPa": film.peak_pressure / 1e6,
        "load_kN": float(np.hypot(*film.force[:2])) / 1e3,
        "minimum_gap_um": film.minimum_gap * 1e6,
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
        journal_radius=0.03, length=0.066, radial_clearance=CLEARANCE, lubricant=ehd.Lubricant(viscosity=9e-3),
        film=ehd.FiniteLength(n_theta=64, n_z=8) if quick else ehd.FiniteLength(n_theta=96, n_z=16),
    )  # fmt: skip
    moduli = {"steel": 2.1e11} if quick else MODULI
    cases: dict = {}
    for closure, cavitation in CLOSURES.items():
        for name, tilt in (("aligned", 0.0), ("tilted", TILT)):
            plain = dataclasses.replace(rigid, cavitation=cavitation)
            cases[closure, name, "rigid"] = solve(plain, tilt)
            for material, modulus in moduli.items():
                kinds: dict[str, type] = {"modal": ehd.ModalBush}
                if closure == "Gumbel":
                    kinds = {"liner": ehd.ElasticLiner, **kinds, "nodal": ehd.ANCFBush}
                for label, kind in kinds.items():
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
    for column, (closure, title) in enumerate((("Gumbel", "Gumbel"), ("mass conserving", "mass conserving"))):
        axes = figure.add_subplot(2, 3, 1 + 3 * column)
        for name in ("rigid", *(f"{m}, modal" for m in moduli)):
            film = cases[closure, "aligned", name]["film"]
            axes.plot(np.degrees(film.theta), film.pressure[:, film.z.size // 2] / 1e6, label=name.split(",")[0])
        axes.set(xlabel="angle in °", ylabel="pressure at the mid-plane in MPa", title=f"aligned, {title}")
        axes.legend()
    for column, name in enumerate(("aligned", "tilted")):
        film = cases["Gumbel", name, "steel, modal"]["film"]
        axes = figure.add_subplot(2, 3, 2 + 3 * column)
        picture = axes.contourf(np.degrees(film.theta), 1e3 * film.z, film.pressure.T / 1e6, 24)
        figure.colorbar(picture, label="MPa")
        axes.set(xlabel="angle in °", ylabel="z in mm", title=f"steel, {name}")
        view = figure.add_subplot(2, 3, 3 + 3 * column, projection="3d")
        T, Z = np.meshgrid(np.degrees(film.theta), 1e3 * film.z, indexing="ij")
        view.plot_surface(T, Z, film.pressure / 1e6, cmap="viridis", rcount=96, ccount=16)
        view.set(xlabel="angle in °", ylabel="z in mm", title=f"steel, {name}, pressure in MPa")
    return figure


def summary_figure(cases: dict, moduli: dict) -> Figure:
    """Pressure and film thickness at the mid-plane, and the bore's shape there, aligned, Gumbel."""
    figure = Figure(figsize=(12, 4), layout="constrained")
    pressure, gap = figure.add_subplot(1, 3, 1), figure.add_subplot(1, 3, 2)
    draw_bores(figure.add_subplot(1, 3, 3, projection="polar"), cases, moduli)
    for name in ("rigid", *(f"{m}, modal" for m in moduli)):
        film = cases["Gumbel", "aligned", name]["film"]
        middle, angle = film.z.size // 2, np.degrees(film.theta)
        pressure.plot(angle, film.pressure[:, middle] / 1e6, label=name.split(",")[0])
        gap.plot(angle, 1e6 * film.gap[:, middle])
    pressure.set(xlabel="angle in °", ylabel="pressure at the mid-plane in MPa")
    pressure.legend()
    gap.set(xlabel="angle in °", ylabel="film thickness at the mid-plane in µm", ylim=(0, None))
    return figure


def draw_bores(polar: Axes, cases: dict, moduli: dict) -> None:
    """Bore radius at the mid-plane, aligned, Gumbel, with the displacement enlarged."""
    for name in ("rigid", *(f"{m}, modal" for m in moduli)):
        film = cases["Gumbel", "aligned", name]["film"]
        middle, ring = film.z.size // 2, np.append(film.theta, film.theta[:1] + 2 * np.pi)
        shift = np.zeros(film.theta.size) if film.bore_displacement is None else film.bore_displacement[:, middle]
        polar.plot(ring, 30.0 + 1e6 * np.append(shift, shift[:1]), label=name.split(",")[0])
    polar.set(title="bore radius at the mid-plane in mm,\ndisplacement times 1000", ylim=(0, None))


def bore_figure(cases: dict, moduli: dict) -> Figure:
    """Scaled deformation of the bore, film thickness at the mid-plane, and the deformation over the bore."""
    figure = Figure(figsize=(13, 4.6), layout="constrained")
    polar = figure.add_subplot(1, 3, 1, projection="polar")
    gap = figure.add_subplot(1, 3, 2)
    draw_bores(polar, cases, moduli)
    for name in ("rigid", *(f"{m}, modal" for m in moduli)):
        film = cases["Gumbel", "aligned", name]["film"]
        gap.plot(np.degrees(film.theta), 1e6 * film.gap[:, film.z.size // 2], label=name.split(",")[0])
    gap.set(xlabel="angle in °", ylabel="film thickness at the mid-plane in µm", ylim=(0, None), title="aligned")
    gap.legend()
    film = cases["Gumbel", "tilted", "steel, modal"]["film"]
    axes = figure.add_subplot(1, 3, 3)
    assert film.bore_displacement is not None
    picture = axes.contourf(np.degrees(film.theta), 1e3 * film.z, 1e6 * film.bore_displacement.T, 24)
    figure.colorbar(picture, label="µm")
    axes.set(xlabel="angle in °", ylabel="z in mm", title="radial displacement of the bore, steel, tilted")
    return figure


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    outcome.pop("pictures")
    for (closure, name, label), case in outcome.items():
        print(
            f"{closure:16s} {name:8s} {label:28s} peak {case['peak_MPa']:6.2f} MPa  load {case['load_kN']:6.2f} kN  minimum film "
            f"{case['minimum_gap_um']:6.2f} um  extent {case['extent_deg']:4.0f}°  solve {case['solve_s']:5.2f} s  evaluation with "
            f"Jacobian {case['evaluation_ms']:7.2f} ms"
        )
