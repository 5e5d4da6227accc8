"""Cold start of a rotor: its bearing loses clearance because the journal warms up faster than the housing.

A steel journal of 80 mm diameter starts at 3000 rpm in a bearing of 40 mm length, fed by a groove with oil at 40
degrees Celsius; shaft and housing (a heavy steel ring) are at 20 degrees. The film heats both of them, and each expands
with the mean temperature of its section: the solid journal soon, the ring much later.

1. With 50 um of radial clearance the journal's expansion takes a sixth of it within a minute or two; then the ring
   expands too.
2. With 20 um `equilibrium` finds a steady film of 15 um with all parts warm. The cold start never gets there: the
   clearance closes, the thinner film heats more, and after 80 s the bearing seizes. That ends the run: Exudyn prints
   DYNAMIC SOLVER FAILED.

Run ``python examples/cold_start.py``; a picture is written to ``results/cold_start``.
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

RADIUS, LENGTH, LOAD, SPEED = 0.04, 0.04, 2000.0, 3000.0 * math.pi / 30.0
WIDE, NARROW = 50e-6, 20e-6
COLD, SUPPLY, ZERO = 293.15, 313.15, 273.15
STEEL = {"expansion": 1.15e-5, "initial_temperature": COLD, "ambient_temperature": COLD, "clearance_temperature": COLD}


def make_bearing(clearance: float) -> ehd.JournalBearing:
    """The bearing with a radial clearance, m, at 20 degrees Celsius."""
    thermal = ehd.FilmEnergy(
        supply_temperature=SUPPLY,
        conductivity=0.13,
        bush=ehd.Conduction(thickness=0.05, conductance=1.0, **STEEL),
        journal=ehd.Conduction(thickness=RADIUS, conductance=1.0, **STEEL),
        carry_over=0.8,
    )
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=LENGTH,
        radial_clearance=clearance,
        lubricant=ehd.oil("ISO VG 46"),
        thermal=thermal,
        supply=(ehd.AxialGroove(angle=0.5 * math.pi, width_angle=0.3, length=0.8 * LENGTH, pressure=1e5),),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )


def start(clearance: float, *, end: float, steps: int) -> tuple[ehd.LubricatedJoint, str]:
    """The rotor's joint after ``end`` seconds at full speed, and why the run ended before, if it did."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(
        eii.NodeRigidBody2D(
            referenceCoordinates=[0, 0, 0],
            initialCoordinates=[0.2 * clearance, -0.2 * clearance, 0],
            initialVelocities=[0, 0, SPEED],
        )
    )
    rotor = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=LOAD / 9.81, inertia=0.1))
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    spin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, spin],
            offsetUserFunction=lambda mbs, t, item, offset: SPEED * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: SPEED,
        )
    )
    centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=rotor))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[0, -LOAD, 0]))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="cold bearing",
        itemNumbers=[ground, rotor],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=make_bearing(clearance),
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = end
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings, spectralRadius=0.3)
    try:
        ehd.SolveDynamic(mbs, settings)
    except ehd.FilmError as error:
        return joint, str(error)
    return joint, ""


def warm(clearance: float) -> ehd.EquilibriumResult:
    """The film once nothing changes any more."""
    return ehd.equilibrium(make_bearing(clearance), speed=SPEED, load=(0.0, -LOAD))


def figures(runs: dict[float, ehd.LubricatedJoint], said: dict[float, str]) -> dict[str, float]:
    """Numbers that the example is there for."""
    rows = {}
    for clearance, joint in runs.items():
        history, final, name = joint.history, warm(clearance), f"{1e6 * clearance:g} um"
        rows[f"{name}: smallest clearance of the start [um]"] = 1e6 * float(history.clearance.min())
        rows[f"{name}: clearance in the end, all warm [um]"] = 1e6 * final.film.walls.clearance
        rows[f"{name}: minimum film thickness in the end [um]"] = 1e6 * final.film.minimum_gap
        rows[f"{name}: last temperature of the journal [deg C]"] = float(history.journal_temperature[-1]) - ZERO
        rows[f"{name}: seizes after [s]"] = float(history.time[-1]) if "seizes" in said[clearance] else math.nan
    return rows


@styled(10.0)
def draw(runs: dict[float, ehd.LubricatedJoint], folder: pathlib.Path) -> None:
    """Temperatures and clearances over time, temperatures around the bearing at the end."""
    fig, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    wide = runs[WIDE].history.between(1.0)
    for name, label, colour in (
        ("film_temperature", "film, mean", "tab:red"),
        ("journal_temperature", "journal's surface", "tab:orange"),
        ("bush_temperature", "bore, mean", "tab:blue"),
    ):
        axes[0].plot(wide.time, getattr(wide, name) - ZERO, color=colour, label=label)
    axes[0].set(xlabel="time [s]", ylabel="temperature [°C]", title=f"{1e6 * WIDE:g} µm of clearance")
    for clearance, joint in runs.items():
        colour = "tab:blue" if clearance == WIDE else "tab:red"
        history, name = joint.history.between(1.0), f"{1e6 * clearance:g} µm cold"
        axes[1].plot(history.time, 1e6 * history.clearance, color=colour, label=f"clearance, {name}")
        axes[1].plot(history.time, 1e6 * history.minimum_gap, "--", color=colour, label="minimum film thickness")
    axes[1].set(xlabel="time [s]", ylabel="thickness [µm]", title="clearance and minimum film thickness", ylim=(0, 66))
    film = runs[WIDE].film()
    angle, middle = np.degrees(film.theta), film.z.size // 2
    axes[2].plot(angle, film.temperature[:, middle] - ZERO, color="tab:red", label="film, mid-plane")
    for ring, label in ((0, "bore"), (-1, "ring's outside")):
        axes[2].plot(angle, film.walls.bush[:, ring] - ZERO, color=("tab:blue", "tab:cyan")[ring], label=label)
    axes[2].axhline(film.walls.journal[0] - ZERO, color="tab:orange", label="journal's surface")
    axes[2].set(xlabel="angle [°]", ylabel="temperature [°C]", title=f"after {wide.time[-1]:.0f} s", xlim=(0, 360))
    for ax in axes:
        ax.grid(alpha=0.3)
    axes[0].legend(loc="lower right")
    axes[1].legend(loc="upper center", ncols=2, fontsize=8)
    axes[2].set_ylim(top=float(film.temperature.max()) - ZERO + 4.0)
    axes[2].legend(loc="upper center", ncols=2)
    fig.savefig(folder / "cold_start.png", dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/cold_start") -> dict[str, float]:
    """Answer both questions; returns the figures.

    Parameters
    ----------
    quick : bool
        A shorter run.
    output : path or None
        Folder for the picture; None writes none.
    """
    runs, said = {}, {}
    for clearance in (WIDE, NARROW):
        print(f"cold start with {1e6 * clearance:g} um ...", flush=True)
        end = 100.0 if quick else 300.0
        runs[clearance], said[clearance] = start(clearance, end=end, steps=round(2.5 * end))
        if said[clearance]:
            print(f"  {said[clearance][:240]} ...")
    rows = figures(runs, said)
    for key, value in rows.items():
        print(f"  {key:56s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(runs, folder)
        print(f"picture: {folder / 'cold_start.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a shorter run")
    main(quick=parser.parse_args().quick)
