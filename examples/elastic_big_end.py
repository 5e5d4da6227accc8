"""The big end of a connecting rod: an elastic bore on a moving housing.

A slider-crank at 3000 rpm with a gas pulse on the piston. The rod's big end is the housing and carries a steel bush of
8 mm, the crank pin is the journal. Compared with a rigid bore, the elastic bush (`ModalBush`) lowers the pressure peak
of the firing stroke and changes the minimum film thickness. Both runs end when the orbit repeats from one cycle (two
turns) to the next within a thousandth of the clearance; the picture shows the last cycle.

Run ``python examples/elastic_big_end.py``; the picture is written to ``results``.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from pathlib import Path

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from matplotlib.figure import Figure

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

CRANK, ROD = 0.043, 0.14
SPEED = 3000.0 * 2.0 * math.pi / 60.0
PISTON_MASS, ROD_MASS, ROD_INERTIA = 0.5, 0.55, 2e-3
GAS_FORCE, GAS_WIDTH = 25e3, 0.35
CLOSED = ehd.UntilPeriodic(period=4.0 * math.pi / SPEED, tolerance=1e-3)
BUSH = ehd.ModalBush(
    mesh=ehd.HollowCylinder(inner_radius=0.024, thickness=0.008, length=0.022, axial=4, radial=2, circumferential=40),
    material=ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0),
    tilted=False,
)


def big_end(*, quick: bool) -> ehd.JournalBearing:
    """Return the bearing with a rigid bore."""
    return ehd.JournalBearing(
        journal_radius=0.024,
        length=0.022,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=8e-3),
        film=ehd.FiniteLength(n_theta=64, n_z=8) if quick else ehd.FiniteLength(n_theta=96, n_z=10),
    )


def gas_force(angle: float) -> float:
    """Force on the piston towards the crank, N; one pulse just after the outer dead centre of every second turn."""
    distance = math.remainder(angle - 2.4 * math.pi, 4.0 * math.pi)
    return GAS_FORCE * math.exp(-((distance / GAS_WIDTH) ** 2))


def build(bearing: ehd.JournalBearing):
    """The mechanism at its outer dead centre at full speed; returns the system and its lubricated joint."""
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))

    def body(mass: float, inertia: float, x: float, speed: float, spin: float):
        node = mbs.AddNode(
            eii.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0], initialVelocities=[0.0, speed, spin])
        )
        return node, mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))

    def prescribe(node, coordinate: int, spin: float = 0.0):
        marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[origin, marker],
                offsetUserFunction=lambda mbs, t, item, offset: spin * t,
                offsetUserFunction_t=lambda mbs, t, item, offset: spin,
            )
        )

    # the crank turns about the origin; its body's reference point is the axis of rotation
    crank_node, crank = body(3.0, 5e-3, 0.0, 0.0, SPEED)
    _, rod = body(ROD_MASS, ROD_INERTIA, CRANK + ROD / 2, SPEED * CRANK / 2, -SPEED * CRANK / ROD)
    piston_node, piston = body(PISTON_MASS, 1e-4, CRANK + ROD, 0.0, 0.0)
    for coordinate in (0, 1):
        prescribe(crank_node, coordinate)
    prescribe(crank_node, 2, SPEED)
    for coordinate in (1, 2):
        prescribe(piston_node, coordinate)
    pins = [
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=rod, localPosition=[ROD / 2, 0, 0])),
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=piston)),
    ]
    mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=pins))
    pushed = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=piston_node))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=pushed,
            loadVector=[0, 0, 0],
            loadVectorUserFunction=lambda mbs, t, load: [-gas_force(SPEED * t), 0, 0],
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="big end", itemNumbers=[rod, crank], position=[CRANK, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint


def simulate(bearing: ehd.JournalBearing, *, turns: float | None, steps_per_turn: int) -> dict:
    """Run the mechanism from the outer dead centre at full speed, for some turns or until the orbit has closed (None).

    The numbers are those of the last cycle, or of everything behind the first 0.3 turns.
    """
    mbs, joint = build(bearing)
    settings = exu.SimulationSettings()
    longest = 16.0 if turns is None else turns
    settings.timeIntegration.endTime = longest * 2.0 * math.pi / SPEED
    settings.timeIntegration.numberOfSteps = round(longest * steps_per_turn)
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.timeIntegration.newton.relativeTolerance = 1e-6
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    start = time.perf_counter()
    cycle = ehd.SolveDynamic(mbs, settings, until_periodic=CLOSED if turns is None else None)
    steps = joint.history.time.size - 1
    history = joint.history.between(0.6 * math.pi / SPEED) if turns is not None else cycle.histories[joint.name]
    return {
        "angle_deg": np.degrees(SPEED * (history.time - history.time[0])),
        "history": history,
        "closed_within_c": max(cycle.left, float(cycle.changes[-1])) if turns is None else math.nan,
        "peak_MPa": float(history.peak_pressure.max()) / 1e6,
        "minimum_film_thickness_um": float(history.minimum_gap.min()) * 1e6,
        "largest_force_kN": float(np.hypot(*history.force.T[:2]).max()) / 1e3,
        "mean_loss_W": float(history.power_loss.mean()),
        "milliseconds_per_step": 1e3 * (time.perf_counter() - start) / steps,
        "iterations_per_step": mbs.sys["dynamicSolver"].it.newtonStepsCount / steps,
    }


@styled(10.0)
def draw(cases: dict, path: Path) -> None:
    """Pressure, film, force and path of the pin, rigid against elastic."""
    figure = Figure(figsize=(11, 7), layout="constrained")
    closed = max(cases[name]["closed_within_c"] for name in ("rigid", "elastic"))
    axes = figure.subplots(2, 2)
    around = np.linspace(0.0, 2.0 * np.pi, 300)
    axes[1, 1].plot(25.0 * np.cos(around), 25.0 * np.sin(around), color="grey", lw=1)
    for name, style in (("rigid", "-"), ("elastic", "--")):
        h, angle = cases[name]["history"], cases[name]["angle_deg"]
        axes[0, 0].plot(angle, h.peak_pressure / 1e6, style, label=name)
        axes[0, 1].plot(angle, 1e6 * h.minimum_gap, style)
        axes[1, 0].plot(angle, np.hypot(h.force[:, 0], h.force[:, 1]) / 1e3, style)
        axes[1, 1].plot(h.eccentricity[:, 0] * 1e6, h.eccentricity[:, 1] * 1e6, style)
    for a, label in zip(axes.ravel()[:3], ("peak pressure [MPa]", "minimum film thickness [µm]", "force [kN]")):
        a.set(xlabel="crank angle [°]", ylabel=label, xlim=(0, angle[-1]), xticks=np.arange(0.0, angle[-1] + 1.0, 90.0))
        a.set_ylim(0.0)
    axes[1, 1].set(
        xlabel="x in the rod [µm]",
        ylabel="y in the rod [µm]",
        aspect="equal",
        title="path of the crank pin" + ("" if math.isnan(closed) else f",\nclosed within {closed:.0e} c"),
    )
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    figure.savefig(path, dpi=100)


def main(*, quick: bool = False, results: str | Path | None = None) -> dict:
    """Run rigid and elastic bore; with ``results`` write the picture there."""
    turns, steps = (1.4, 360) if quick else (None, 480)
    rigid = big_end(quick=quick)
    cases = {
        name: simulate(dataclasses.replace(rigid, bush=bush), turns=turns, steps_per_turn=steps)
        for name, bush in (("rigid", None), ("elastic", BUSH))
    }
    if results is not None:
        folder = Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        draw(cases, folder / "elastic_big_end.png")
        cases["picture"] = folder / "elastic_big_end.png"
    return cases


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    outcome.pop("picture")
    for name, case in outcome.items():
        print(name, {k: round(v, 3) for k, v in case.items() if isinstance(v, float)})
