"""Fast water in the bearing of a pump: laminar and turbulent films.

A journal of 200 mm diameter turns in a bearing of 160 mm length (radial clearance 0.2 mm) on water of 0.7 mPa s and
carries 4 kN, the weight of its share of the rotor. At 3000 rpm the Reynolds number rho U c / mu is 8900, far beyond the
1300 at which a film with this clearance leaves the laminar flow. Two questions are asked with the laminar film, Ng and
Pan's law and Hirs' law:

1. Which position and which power loss has the journal over the speed? Turbulence lifts the journal and makes the
   power loss several times larger.
2. Does the rotor whirl? A lifted journal does so sooner. At 5000 rpm the rotor starts beside its equilibrium in Exudyn:
   on the laminar film the orbit decays, on turbulent films it grows, as the critical mass of `equilibrium` predicts.

Run ``python examples/turbulent_bearing.py``; a picture is written to ``results/turbulent_bearing``.
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

RPM = math.pi / 30.0
LOAD, CLEARANCE, FAST = 4000.0, 2e-4, 5000.0
MASS = LOAD / 9.81
LAWS = {"laminar": None, "Ng-Pan": ehd.NgPan(), "Hirs": ehd.Hirs()}
COLOURS = {"laminar": "tab:blue", "Ng-Pan": "tab:red", "Hirs": "tab:green"}


def make_bearing(name: str) -> ehd.JournalBearing:
    """The bearing with a law of `LAWS`."""
    return ehd.JournalBearing(
        journal_radius=0.1,
        length=0.16,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=7e-4, density=990.0),
        turbulence=LAWS[name],
    )


def at_rest(name: str, rpm: float) -> ehd.EquilibriumResult:
    """Equilibrium under the weight at a speed."""
    return ehd.equilibrium(make_bearing(name), speed=rpm * RPM, load=(0.0, -LOAD))


def disturbed(name: str, *, turns: float, steps_per_turn: int) -> ehd.JointHistory:
    """The rotor at the fast speed, started a twentieth of the clearance beside its equilibrium."""
    speed = FAST * RPM
    start = at_rest(name, FAST).position + [0.05 * CLEARANCE, 0.0]
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(
        eii.NodeRigidBody2D(
            referenceCoordinates=[0, 0, 0], initialCoordinates=[*start, 0], initialVelocities=[0, 0, speed]
        )
    )
    rotor = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=0.005 * MASS))
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    spin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, spin],
            offsetUserFunction=lambda mbs, t, item, offset: speed * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: speed,
        )
    )
    centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=rotor))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[0, -LOAD, 0]))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name=f"pump bearing, {name}",
        itemNumbers=[ground, rotor],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=make_bearing(name),
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * math.pi / speed
    settings.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings, spectralRadius=0.9)
    ehd.SolveDynamic(mbs, settings)
    return joint.history


def distance(name: str, history: ehd.JointHistory) -> np.ndarray:
    """Distance of the journal from its equilibrium over the clearance, by step."""
    return np.hypot(*(history.eccentricity - at_rest(name, FAST).position).T) / CLEARANCE


def figures(
    rpm: np.ndarray, states: dict[str, list[ehd.EquilibriumResult]], runs: dict[str, ehd.JointHistory]
) -> dict[str, float]:
    """Numbers that the example is there for."""
    rows = {}
    for name, states_of in states.items():
        last = states_of[-1]
        rows[f"{name}: minimum film thickness at {rpm[-1]:g} rpm [um]"] = 1e6 * last.film.minimum_gap
        rows[f"{name}: power loss at {rpm[-1]:g} rpm [W]"] = last.film.power_loss
        rows[f"{name}: critical mass / mass at {FAST:g} rpm"] = at_rest(name, FAST).critical_mass / MASS
        away = distance(name, runs[name])
        rows[f"{name}: orbit at the end / at the start"] = float(away[-away.size // 4 :].max() / away[0])
    return rows


@styled(10.0)
def draw(
    rpm: np.ndarray,
    states: dict[str, list[ehd.EquilibriumResult]],
    runs: dict[str, ehd.JointHistory],
    folder: pathlib.Path,
) -> None:
    """Film thickness and power over the speed, and the disturbed rotors."""
    fig, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    for name, states_of in states.items():
        style = {"color": COLOURS[name], "label": name}
        axes[0].plot(rpm, [1e6 * state.film.minimum_gap for state in states_of], "o-", ms=3, **style)
        axes[1].plot(rpm, [1e-3 * state.film.power_loss for state in states_of], "o-", ms=3, **style)
        turns = runs[name].time * FAST / 60.0
        # the two laws grow alike
        dashed = "--" if name == "Hirs" else "-"
        axes[2].semilogy(turns, distance(name, runs[name]), dashed, lw=1.2, **style)
    axes[0].set(xlabel="speed [rpm]", ylabel="minimum film thickness [µm]", title="4 kN on water", ylim=(0, None))
    axes[1].set(xlabel="speed [rpm]", ylabel="power loss [kW]", title="power lost in the film", ylim=(0, None))
    axes[2].set(
        xlabel="turns of the rotor",
        ylabel="distance from equilibrium / clearance",
        title=f"started beside its equilibrium, {FAST:g} rpm",
    )
    for ax in axes:
        ax.grid(alpha=0.3)
    axes[0].legend(loc="upper left")
    fig.savefig(folder / "turbulent_bearing.png", dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/turbulent_bearing") -> dict[str, float]:
    """Answer both questions; returns the figures.

    Parameters
    ----------
    quick : bool
        Fewer speeds and turns.
    output : path or None
        Folder for the picture; None writes none.
    """
    rpm = np.linspace(500.0, 3000.0, 3 if quick else 11)
    print("equilibria over the speed ...", flush=True)
    states = {name: [at_rest(name, n) for n in rpm] for name in LAWS}
    print("disturbed rotors ...", flush=True)
    runs = {name: disturbed(name, turns=15 if quick else 40, steps_per_turn=100) for name in LAWS}
    rows = figures(rpm, states, runs)
    for key, value in rows.items():
        print(f"  {key:56s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(rpm, states, runs, folder)
        print(f"picture: {folder / 'turbulent_bearing.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer speeds and turns")
    main(quick=parser.parse_args().quick)
