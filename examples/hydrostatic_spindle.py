"""Hydrostatic spindle: four pockets behind capillaries or orifices.

A spindle of 60 mm diameter runs at 3000 rpm in a bearing of 60 mm length (radial clearance 30 um, 8 mPa s). Four
pockets of 66 degrees x 40 mm are fed from 4 MPa. Where the journal comes closer, less oil leaves a pocket, less
pressure is lost in its restrictor, and its pressure rises: that carries the load, at rest too. Three questions:

1. Which restrictor makes the spindle stiffest? The stiffness of the centred spindle, all but at rest, over the pressure
   ratio p / p_s, by restrictors of many sizes. Without flow from pocket to pocket the best ratio is 0.5 with
   capillaries and 2 - sqrt(2) = 0.59 with orifices (W. B. Rowe, Hydrostatic, Aerostatic and Hybrid Bearing Design,
   2012).
2. How far does the turning spindle move under a load? Restrictors are those with a pressure ratio of 0.5.
3. What does a cutting force of 2 kN do that begins at once? A run in Exudyn, against the equilibrium.

Run ``python examples/hydrostatic_spindle.py``; a picture is written to ``results/hydrostatic_spindle``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

SPEED, MASS, CUTTING, SUPPLY, CLEARANCE = 100.0 * math.pi, 12.0, 2000.0, 4e6, 30e-6
COLOURS = {"capillary": "tab:blue", "orifice": "tab:red"}


def restrictor(kind: str, size: float) -> ehd.Orifice | ehd.Capillary:
    """A restrictor of a relative size."""
    if kind == "orifice":
        return ehd.Orifice(diameter=3.96e-4 * size, supply_pressure=SUPPLY)
    return ehd.Capillary(diameter=5.05e-4 * size, length=0.08, supply_pressure=SUPPLY)


def make_bearing(kind: str, size: float = 1.0) -> ehd.JournalBearing:
    """The bearing with pockets at 0, 90, 180 and 270 degrees."""
    quarters, feed = 0.5 * math.pi * np.arange(4), restrictor(kind, size)
    return ehd.JournalBearing(
        journal_radius=0.03,
        length=0.06,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.008, density=860.0),
        supply=tuple(ehd.Pocket(angle=a, width_angle=math.radians(66.0), length=0.04, supply=feed) for a in quarters),
    )


def cut(kind: str, *, end: float, steps: int) -> ehd.JointHistory:
    """The spindle at its equilibrium without a load, on which the cutting force begins to act."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialVelocities=[0, 0, SPEED]))
    spindle = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=0.01))
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))],
            offsetUserFunction=lambda mbs, t, item, offset: SPEED * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: SPEED,
        )
    )
    centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=spindle))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[0, -CUTTING, 0]))
    sides = {"itemNumbers": [ground, spindle], "position": [0, 0, 0], "axis": [0, 0, 1]}
    joint = ehd.CreateLubricatedJoint(mbs, name=f"spindle, {kind}", **sides, bearing=make_bearing(kind))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    return joint.history


@styled(10.0)
def draw(sizes, centred, loads, states, runs, folder: pathlib.Path) -> None:
    """Stiffness over the pressure ratio, position over the load, and the step of the force."""
    fig, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    for kind, colour in COLOURS.items():
        ratios, stiffness = centred[kind]
        axes[0].plot(ratios, 1e-6 * stiffness, "o-", ms=3, color=colour, label=kind)
        axes[1].plot(1e-3 * loads, [s.eccentricity_ratio for s in states[kind]], "o-", ms=3, color=colour, label=kind)
        h = runs[kind]
        for pressure, line in ((h.highest_pocket_pressure, "-"), (h.lowest_pocket_pressure, "--")):
            axes[2].semilogx(1e3 * h.time[1:], 1e-6 * pressure[1:], line, color=colour)
    for name, line in (("highest", "-"), ("lowest", "--")):
        axes[2].plot([], [], line, color="black", label=f"{name} of the four")
    axes[0].set(xlabel="pressure ratio p / p_s [-]", ylabel="stiffness [N/µm]", title="centred, at rest", xlim=(0, 1))
    axes[1].set(xlabel="load [kN]", ylabel="eccentricity ratio [-]", title="3000 rpm")
    title = f"cutting force of {CUTTING / 1e3:g} kN from t = 0 on"
    axes[2].set(xlabel="time [ms]", ylabel="pocket pressure [MPa]", title=title)
    axes[2].legend(loc="lower center")
    for ax in axes:
        ax.set_ylim(bottom=0.0)
        ax.grid(alpha=0.3)
    axes[0].legend(loc="lower center")
    fig.savefig(folder / "hydrostatic_spindle.png", dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/hydrostatic_spindle") -> dict[str, float]:
    """Answer the three questions; returns the figures. ``quick``: fewer sizes, loads and steps."""
    sizes, loads = np.geomspace(0.4, 2.2, 9 if quick else 25), np.linspace(0.0, 6000.0, 4 if quick else 13)
    rows, centred, states, runs = {}, {}, {}, {}
    for kind in COLOURS:
        at_rest = [ehd.equilibrium(make_bearing(kind, size), speed=1e-3, load=(0.0, 0.0)) for size in sizes]
        ratios = np.array([state.film.pocket_pressures[0] / SUPPLY for state in at_rest])
        centred[kind] = ratios, np.array([state.stiffness[1, 1] for state in at_rest])
        states[kind] = [ehd.equilibrium(make_bearing(kind), speed=SPEED, load=(0.0, -load)) for load in loads]
        runs[kind] = cut(kind, end=0.04, steps=200 if quick else 1000)
        end = ehd.equilibrium(make_bearing(kind), speed=SPEED, load=(0.0, -CUTTING))
        best = int(np.argmax(centred[kind][1]))
        away = np.hypot(*(runs[kind].eccentricity[-1] - end.position)) / CLEARANCE
        rows |= {
            f"{kind}: best pressure ratio": float(ratios[best]),
            f"{kind}: stiffness there [N/um]": 1e-6 * float(centred[kind][1][best]),
            f"{kind}: eccentricity ratio at {loads[-1]:g} N": states[kind][-1].eccentricity_ratio,
            f"{kind}: oil at {loads[-1]:g} N [l/min]": 6e4 * float(states[kind][-1].film.restrictor_flows.sum()),
            f"{kind}: end of the run off its equilibrium, over c": float(away),
        }
    for key, value in rows.items():
        print(f"  {key:56s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(sizes, centred, loads, states, runs, folder)
        print(f"picture: {folder / 'hydrostatic_spindle.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer sizes, loads and steps")
    main(quick=parser.parse_args().quick)
