"""A gear shaft between thrust faces: the axial force of its helical gear turns round.

A shaft of 20 kg (50 mm journal, 300 rad/s) carries a gear: 2 kN across the axis, and 5 kN along it, which change
their sign within 2 ms when the torque does. Nothing but oil holds the shaft along its axis: films on the two end faces
of its bearing (26 to 45 mm radius, 40 um of room on either side) against two collars.

1. With six taper lands on either face a wedge film carries: the shaft comes to rest where ``ehd.steady`` predicts,
   moves to the other face when the force reverses, and stops there, without touching.
2. Plane faces damp as well as the lands, but have no wedge: under a lasting force the shaft creeps on until it touches
   the face, where the contact model carries it.

Run ``python examples/thrust_reversal.py``; a picture is written to ``results/thrust_reversal``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np
from exudyn.utilities import InertiaCylinder
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

SPEED, MASS, RADIAL, AXIAL = 300.0, 20.0, 2000.0, 5000.0
CLEARANCE, ONSET = 40e-6, 5e-6
REVERSAL, LASTS = 0.05, 2e-3
GOVERNOR = 2.0  # N m s
FACES = {"taper lands": ehd.TaperLand(pads=6, depth=30e-6), "plane faces": None}
COLOURS = {"taper lands": "tab:blue", "plane faces": "tab:red"}


def make_bearing(name: str) -> ehd.JournalBearing:
    """The bearing with the faces of `FACES`."""
    faces = ehd.ThrustFaces(
        inner_radius=0.026,
        outer_radius=0.045,
        clearance=CLEARANCE,
        profile=FACES[name],
        contact=ehd.RegularisedWall(onset=ONSET, pressure=1e8),
    )
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=64, n_z=8),
        thrust=faces,
    )


def axial_force(t: float) -> float:
    """Force of the gear along z, N."""
    return AXIAL * math.cos(math.pi * min(max((t - REVERSAL) / LASTS, 0.0), 1.0))


def simulate(name: str, *, end: float, steps: int) -> ehd.JointHistory:
    """The shaft from the middle of its play, through the reversal."""
    mbs = exu.SystemContainer().AddSystem()
    bearing = make_bearing(name)
    ground = mbs.CreateGround()
    inertia = InertiaCylinder(MASS / (math.pi * 0.04**2 * 0.5), 0.5, 0.04, 2)
    rest = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -RADIAL))
    shaft = mbs.CreateRigidBody(
        inertia=inertia, initialDisplacement=[*rest.position, 0.0], initialAngularVelocity=[0, 0, SPEED]
    )
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=shaft))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=marker,
            loadVector=[0, -RADIAL, 0],
            loadVectorUserFunction=lambda mbs, t, load: [0.0, -RADIAL, axial_force(t)],
        )
    )

    def motor(mbs, t, load):
        return [
            0.0,
            0.0,
            GOVERNOR * (SPEED - mbs.GetObjectOutputBody(shaft, exu.OutputVariableType.AngularVelocity)[2]),
        ]

    mbs.AddLoad(eii.LoadTorqueVector(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=motor))
    # the one joint stands for the bearings of the shaft, which keep it straight
    joint = ehd.CreateLubricatedJoint(
        mbs, f"gear shaft, {name}", [ground, shaft], [0, 0, 0], [0, 0, 1], bearing, tilt=ehd.Held()
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    return joint.history


def rest_position(bearing: ehd.JournalBearing, speed: float) -> float:
    """Axial position in which the lands carry the gear's force, m."""

    def missing(z: float) -> float:
        return ehd.steady(bearing, speed=speed, eccentricity_ratio=0.0, axial_position=z).faces.axial_force + AXIAL

    return float(brentq(missing, 0.0, 0.9 * CLEARANCE, xtol=1e-9))


@styled(10.0)
def draw(runs: dict[str, ehd.JointHistory], rest: float, folder: pathlib.Path) -> None:
    """Way of both shafts, films on their faces, and the pressure on the loaded face."""
    fig = plt.figure(figsize=(13, 4.2), layout="constrained")
    place, film = fig.add_subplot(1, 3, 1), fig.add_subplot(1, 3, 2)
    face = fig.add_subplot(1, 3, 3, projection="polar")
    for name, history in runs.items():
        style = {"color": COLOURS[name], "label": name}
        place.plot(1e3 * history.time, 1e6 * history.axial_position, **style)
        film.plot(1e3 * history.time, 1e6 * history.thrust_minimum_gap, **style)
    for sign in (1, -1):
        place.axhline(1e6 * sign * rest, color="0.4", ls="--", lw=1, label="steady, taper lands" if sign > 0 else None)
    film.axhspan(0.0, 1e6 * ONSET, color="0.85", label="wall")
    place.set(xlabel="time [ms]", ylabel="axial position [µm]", title="the shaft between its faces")
    film.set(
        xlabel="time [ms]", ylabel="minimum film thickness [µm]", title="thinnest film on the faces", ylim=(0, None)
    )
    for ax, where in ((place, "center right"), (film, "best")):
        ax.grid(alpha=0.3)
        ax.legend(loc=where)
    faces = ehd.steady(make_bearing("taper lands"), speed=SPEED, eccentricity_ratio=0.0, axial_position=rest).faces
    around = np.append(faces.theta, faces.theta[0] + 2.0 * math.pi)
    # pushed along +z the shaft closes the lower face
    pressure = 1e-6 * np.vstack((faces.pressure[0], faces.pressure[0][:1]))
    map_ = face.pcolormesh(around, 1e3 * faces.r, pressure.T, shading="gouraud", cmap="viridis")
    face.set(rmin=0.0, rmax=1e3 * faces.r[-1], title="pressure on the loaded face, 26 to 45 mm radius")
    face.set_yticks([])
    face.grid(False)
    fig.colorbar(map_, ax=face, label="MPa", shrink=0.75, pad=0.12)
    fig.savefig(folder / "thrust_reversal.png", dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/thrust_reversal") -> dict[str, float]:
    """Run both shafts; returns the figures.

    Parameters
    ----------
    quick : bool
        A shorter run.
    output : path or None
        Folder for the picture; None writes none.
    """
    end = 0.1 if quick else 0.2
    rows, runs = {}, {}
    rest = rest_position(make_bearing("taper lands"), SPEED)
    rows["taper lands: steady position [um]"] = 1e6 * rest
    for name in FACES:
        print(f"{name} ...", flush=True)
        runs[name] = history = simulate(name, end=end, steps=round(end / (1e-3 if quick else 5e-4)))
        before = int(np.searchsorted(history.time, REVERSAL)) - 1
        rows[f"{name}: position before the reversal [um]"] = 1e6 * history.axial_position[before]
        rows[f"{name}: position at the end [um]"] = 1e6 * history.axial_position[-1]
        rows[f"{name}: thinnest film on the faces [um]"] = 1e6 * float(history.thrust_minimum_gap.min())
        rows[f"{name}: largest contact load [N]"] = float(history.thrust_contact_load.max())
        rows[f"{name}: loss of the faces at the end [W]"] = float(history.thrust_power_loss[-1])
    for key, value in rows.items():
        print(f"  {key:50s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(runs, rest, folder)
        print(f"picture: {folder / 'thrust_reversal.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a shorter run")
    main(quick=parser.parse_args().quick)
