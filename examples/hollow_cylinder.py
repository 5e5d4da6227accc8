"""A flexible hollow cylinder under a growing line load.

The first case of P. Flores, "Modeling, Analysis and Simulation of 3D Elastohydrodynamic Revolute Joints in Multibody
Systems".

Inner radius 0.225 m, length 0.2 m, thickness 0.05 m, E = 1e6 Pa, line load 1000 t N/m, step 1e-3 s, 1 s. The paper
omits density, Poisson ratio, supports and direction; assumed here: 7800 kg/m^3, 0.3, the lowest outer generatrix
fixed in x, y and z, the top outer generatrix guided in x (one fixed line alone leaves a rotation free), no gravity, a
dead load on the top outer generatrix pointing down (-y). The bush axis is z.

Stress is reported at two bore points of the mid-plane: under the load and at the side. At the loaded line itself it is
unbounded in the exact solution, so that a number there would only tell the mesh size.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_ehd.coupling.items.bush import CreateFlexibleBush, FlexibleBush, FreeOuter, Support
from exudyn_ehd.coupling.run.sparse import SolveDynamicSparse
from exudyn_ehd.pictures.bush import Frame, contour_figure
from exudyn_ehd.pictures.style import styled
from exudyn_ehd.solid.bush import ANCFBush
from exudyn_ehd.solid.loads import LineLoad
from exudyn_ehd.solid.mesh import BushMesh, HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff

MATERIAL = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
PAPER_SECONDS = {"ADINA": 616.0, "the paper's code": 878.0}


def build(axial: int, radial: int, circumferential: int) -> tuple[exu.SystemContainer, FlexibleBush, int]:
    """Return the container (keep it alive), the bush and Exudyn's node number of the top point in the mid-plane."""
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    cylinder = HollowCylinder(
        inner_radius=0.225, thickness=0.05, length=0.2, axial=axial, radial=radial, circumferential=circumferential
    )
    mesh = cylinder.mesh()
    low, top = mesh.generatrix(mesh.outer, -np.pi / 2), mesh.generatrix(mesh.outer, np.pi / 2)
    bush = CreateFlexibleBush(
        mbs,
        "hollow cylinder",
        bush=ANCFBush(mesh=mesh, material=MATERIAL),
        outer=FreeOuter(),
        supports=[Support(nodes=low.nodes), Support(nodes=top.nodes, directions=(True, False, False))],
        loads=[LineLoad(line=top, force_per_length=(0.0, -1000.0, 0.0), history=lambda t: t)],
    )
    middle = top.nodes[np.argmin(np.abs(mesh.nodes[top.nodes, 2]))]
    return system, bush, int(bush.nodeNumbers[middle])


def simulate(counts: tuple[int, int, int], step: float, end: float, instants: list[float]) -> dict:
    """Run one mesh; return histories, snapshots and costs."""
    system, bush, top = build(*counts)
    mbs = bush.mbs
    points = bush.stress.locate(np.array([[0.0, 0.2251, 0.0], [0.2251, 0.0, 0.0]]))

    def stresses(mbs, t, sensorNumbers, factors, configuration):
        return bush.stress.von_mises_at(points, bush.displacements(configuration))

    shapes: dict[float, np.ndarray] = {}

    def remember(mbs, t):
        for instant in instants:
            if instant not in shapes and t > instant - 0.5 * step:
                shapes[instant] = bush.displacements()
        return True

    moved = mbs.AddSensor(
        items.SensorNode(
            nodeNumber=exu.NodeIndex(top),
            outputVariableType=exu.OutputVariableType.Displacement,
            storeInternal=True,
            writeToFile=False,
        )
    )
    stressed = mbs.AddSensor(
        items.SensorUserFunction(sensorUserFunction=stresses, storeInternal=True, writeToFile=False)
    )
    mbs.SetPostStepUserFunction(remember)
    mbs.Assemble()
    run = SolveDynamicSparse(mbs, settings(step, end))
    displacement, stress = mbs.GetSensorStoredData(moved), mbs.GetSensorStoredData(stressed)
    del system
    return {
        "counts": counts,
        "bush": bush,
        "time": displacement[:, 0],
        "top_displacement": displacement[:, 2],
        "stress_time": stress[:, 0],
        "von_mises_under_load": stress[:, 1],
        "von_mises_side": stress[:, 2],
        "shapes": shapes,
        "run": run,
    }


def settings(step: float, end: float) -> exu.SimulationSettings:
    """Exudyn's settings: generalized-alpha with its default spectral radius 0.9, no files."""
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = round(end / step)
    result.timeIntegration.endTime = end
    result.timeIntegration.verboseMode = 0
    result.solution.file.write = False
    result.solution.sensors.writePeriod = max(step, end / 200)
    return result


@styled(10.0)
def draw(cases: list[dict], folder: Path) -> list[Path]:
    """Write the pictures and return their paths."""
    figures = {
        "hollow_cylinder_histories.png": history_figure(cases),
        "hollow_cylinder_shapes.png": shapes_figure(cases[-1]),
    }
    for file, figure in figures.items():
        figure.savefig(folder / file, dpi=130)
    return [folder / file for file in figures]


def history_figure(cases: list[dict]) -> Figure:
    """Displacement of the top point for all meshes, von Mises stress of the finest."""
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for case, style in zip(cases, ("-", "--", "-.", ":")):
        label = " x ".join(map(str, case["counts"]))
        left.plot(case["time"], 1e3 * case["top_displacement"], style, label=label, linewidth=2)
    left.set(xlabel="time [s]", ylabel="displacement of the top point [mm]", title="Mesh: axial x radial x around")
    fine = cases[-1]
    right.plot(fine["stress_time"], 1e-3 * fine["von_mises_under_load"], label="bore, under the load")
    right.plot(fine["stress_time"], 1e-3 * fine["von_mises_side"], label="bore, side")
    name = " x ".join(map(str, fine["counts"]))
    right.set(xlabel="time [s]", ylabel="von Mises stress [kPa]", title=f"Mid-plane, mesh {name}")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend()
    return figure


def shapes_figure(case: dict) -> Figure:
    """Deformed shapes with contours of the von Mises stress, load, supports and axes, true scale."""
    bush = case["bush"]
    frames = [
        Frame(title=f"t = {t:g} s", displacements=u, values=1e-3 * bush.stress.von_mises_at_nodes(u))
        for t, u in case["shapes"].items()
    ]
    figure = contour_figure(bush.mesh, frames, label="von Mises stress [kPa], displacement at true scale")
    for axes, (t, u) in zip(figure.axes, case["shapes"].items()):
        _draw_load(axes, bush.mesh, u, t / max(case["shapes"]))
    figure.suptitle(
        "Outer diameter 0.55 m, length 0.2 m. Arrows: line load, 1000 N/m after 1 s. Triangles: fixed line.\n"
        "The loaded line is held in x, the ends are free."
    )
    return figure


def _draw_load(axes: Axes, mesh: BushMesh, u: np.ndarray, share: float) -> None:
    """Draw arrows on the loaded line as long as the ``share`` of the last load, supports, and the axes x, y and z."""
    low, top = (mesh.generatrix(mesh.outer, angle).nodes for angle in (-np.pi / 2, np.pi / 2))
    x, y, z = (mesh.nodes + u)[top].T
    length = 0.16 * share
    # the picture's axes are x, -z, y
    axes.quiver(x, -z, y + length, 0, 0, -length, color="tab:red", lw=1.0, arrow_length_ratio=0.25, zorder=3)
    x, y, z = mesh.nodes[low].T
    axes.plot(x, -z, y - 0.012, "^", color="black", ms=5, zorder=0)
    corner = np.array([-0.36, -0.14, -0.275])
    for name, direction in (("x", [1, 0, 0]), ("z", [0, -1, 0]), ("y", [0, 0, 1])):
        arrow = 0.1 * np.array(direction)
        axes.quiver(*corner, *arrow, color="black", lw=0.8, arrow_length_ratio=0.2).set_clip_on(False)
        axes.text(*(corner + 1.3 * arrow), name, ha="center", va="center")
    axes.set_title(axes.get_title(), y=-0.05)


def main(*, quick: bool = False, results: str | Path | None = "results") -> dict:
    """Run the case and return its numbers.

    Parameters
    ----------
    quick : bool
        Two coarse meshes, 0.2 s and a step of 4e-3 s instead of the full case.
    results : path, optional
        Folder for the pictures; None writes nothing.

    Returns
    -------
    dict
        ``cases``: per mesh the counts, final top displacement [m], final von Mises stresses [Pa] at the two points
        and the run's cost; ``pictures``: files written.
    """
    meshes = [(1, 1, 16), (2, 1, 24)] if quick else [(2, 1, 20), (4, 1, 40), (6, 2, 60), (4, 2, 40)]
    step, end = (4e-3, 0.2) if quick else (1e-3, 1.0)
    instants = [end * part for part in (0.4, 0.6, 0.8, 1.0)]
    cases = [simulate(counts, step, end, instants if counts == meshes[-1] else []) for counts in meshes]
    files = []
    if results is not None:
        folder = Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        files = draw(cases, folder)
    return {
        "cases": [
            {
                "counts": case["counts"],
                "top_displacement": float(case["top_displacement"][-1]),
                "von_mises_under_load": float(case["von_mises_under_load"][-1]),
                "von_mises_side": float(case["von_mises_side"][-1]),
                "cost": case["run"],
            }
            for case in cases
        ],
        "pictures": files,
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    for entry in outcome["cases"]:
        print(
            " x ".join(map(str, entry["counts"])),
            f"top {1e3 * entry['top_displacement']:.2f} mm, von Mises under the load "
            f"{1e-3 * entry['von_mises_under_load']:.2f} kPa, side {1e-3 * entry['von_mises_side']:.2f} kPa;",
            entry["cost"].report(),
        )
    print(f"on {os.cpu_count()} cores; the paper, on other hardware, for 4 x 2 x 40:", PAPER_SECONDS, "s")
