"""A shaft with a disc between its bearings and one beyond them: critical speeds, whirl and unbalance on two oil films.

A steel shaft, 40 mm thick and 0.8 m long, runs in two plain bearings 0.6 m apart (length 24 mm, radial clearance 40 um,
0.02 Pa s). A disc of 15 kg sits in the middle of the span, a thin one of 6 kg on the overhang. The numbers are our own,
of the size of a blower. The shaft is a chain of geometrically exact beams on ``NodeRigidBodyRxyz`` nodes.

`SolveEquilibrium` finds the bent shaft in its two films at every speed and linearises all of the Exudyn model about it.
From its result come

* the Campbell diagram: the gyroscopic moment of the overhung disc splits its bending mode into a forward and a backward
  one, the films add a whirl at half the speed that grows beyond a threshold;
* the response to an unbalance of 50 g mm on the middle disc, with its resonance where a forward mode crosses the
  speed; beside it the same rotor in time, by `SolveDynamic`, from the equilibrium on until the transient has gone;
* with `stability_map` the threshold over the clearance.

Linear results hold for small motions: the unbalance moves the journals by less than a tenth of the clearance.

Run ``python examples/rotor_campbell.py``; pictures are written to ``results/rotor_campbell``.
"""

from __future__ import annotations

import argparse
import math
import pathlib
import time

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

STEEL, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
DIAMETER, SPAN, LENGTH, ELEMENTS = 0.040, 0.6, 0.8, 8
MIDDLE, OVERHUNG = 3, 8  # nodes of the discs
BEARINGS = (0, 6)  # and of the journals
CLEARANCE, GRAVITY, UNBALANCE = 40e-6, 9.81, 50e-6
RPM = 2.0 * math.pi / 60.0


def bearing(clearance: float = CLEARANCE, *, quick: bool = False) -> ehd.JournalBearing:
    """One of the two bearings."""
    return ehd.JournalBearing(
        journal_radius=0.5 * DIAMETER,
        length=0.024,
        radial_clearance=clearance,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=4) if quick else ehd.FiniteLength(n_theta=96, n_z=6),
    )


class Rotor:
    """The rotor in Exudyn, its axis along x, gravity along -z.

    Parameters
    ----------
    film : JournalBearing
        Both bearings.
    speed : float or None
        Spin of a run in time, rad/s, with the unbalance; None for a model to linearise.
    """

    def __init__(self, film: ehd.JournalBearing, speed: float | None = None) -> None:
        self.mbs = mbs = exu.SystemContainer().AddSystem()
        places = np.linspace(0.0, LENGTH, ELEMENTS + 1)
        self.nodes = [mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[x, 0, 0, 0, 0, 0])) for x in places]
        data, length = section(), LENGTH / ELEMENTS
        bodies = [
            mbs.AddObject(eii.ObjectBeamGeometricallyExact(nodeNumbers=[a, b], length=length, sectionData=data))
            for a, b in zip(self.nodes[:-1], self.nodes[1:], strict=True)
        ]
        self.discs = [self._disc(MIDDLE, mass=15.0, radius=0.12), self._disc(OVERHUNG, mass=6.0, radius=0.15)]
        for body in (*bodies, *self.discs):
            marker = mbs.AddMarker(eii.MarkerBodyMass(bodyNumber=body))
            mbs.AddLoad(eii.LoadMassProportional(markerNumber=marker, loadVector=[0, 0, -GRAVITY]))
        ground = mbs.AddObject(eii.ObjectGround())
        self.joints = [
            ehd.CreateLubricatedJoint(
                mbs,
                name=name,
                itemNumbers=[ground, self.nodes[node]],
                position=[places[node], 0, 0],
                rotationMatrixAxes=[[0, 0, 1], [1, 0, 0], [0, 1, 0]],  # x, y of the joint are y, z of space
                bearing=film,
            )
            for name, node in zip(("free end", "overhung end"), BEARINGS, strict=True)
        ]
        self._hold(self.nodes[0], 0)
        if speed is not None:
            self._drive(speed)
        mbs.Assemble()

    def _disc(self, node: int, mass: float, radius: float):
        moment = 0.25 * mass * radius**2
        inertia = [2.0 * moment, moment, moment, 0, 0, 0]
        return self.mbs.AddObject(eii.ObjectRigidBody(nodeNumber=self.nodes[node], mass=mass, inertia=inertia))

    def _hold(self, node, coordinate: int, **drive) -> None:
        mbs = self.mbs
        markers = [
            mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0)),
            mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)),
        ]
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers, **drive))

    def _drive(self, speed: float) -> None:
        """Prescribe the spin of the free end, and let the unbalance pull on the middle disc."""
        self._hold(
            self.nodes[0],
            3,
            offsetUserFunction=lambda mbs, t, item, offset: speed * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: speed,
        )
        force, marker = UNBALANCE * speed**2, self.mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=self.discs[0]))

        def pull(mbs, t, load):
            return [0.0, force * math.cos(speed * t), force * math.sin(speed * t)]

        self.mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=pull))


def section() -> exu.BeamSection:
    """Section of the shaft, without damping of its own."""
    area, moment = math.pi * DIAMETER**2 / 4.0, math.pi * DIAMETER**4 / 64.0
    shear = 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON) * STEEL / (2.0 * (1.0 + POISSON))
    torsion = STEEL / (2.0 * (1.0 + POISSON)) * 2.0 * moment
    data = exu.BeamSection()
    data.stiffnessMatrix = np.diag([STEEL * area, shear * area, shear * area, torsion, STEEL * moment, STEEL * moment])
    data.inertia = DENSITY * np.diag([2.0 * moment, moment, moment])
    data.massPerLength = DENSITY * area
    return data


def whirl_in_time(film: ehd.JournalBearing, rest: ehd.RotorResult, speed: float, *, turns: int, steps: int) -> float:
    """Major semi-axis of the last turn of the free end's journal, m, started in the equilibrium."""
    rotor = Rotor(film, speed)
    rest.place(rotor.mbs, speed)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * math.pi / speed
    settings.timeIntegration.numberOfSteps = turns * steps
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(rotor.mbs, settings)
    history = rotor.joints[0].history
    e = history.eccentricity[-steps:] @ [1.0, 1j]
    forward, backward = (np.mean(e * np.exp(-sign * 1j * speed * history.time[-steps:])) for sign in (1.0, -1.0))
    return float(abs(forward) + abs(backward))


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/rotor_campbell") -> dict[str, float]:
    """Modes, threshold and unbalance response; returns their figures.

    Parameters
    ----------
    quick : bool
        Fewer speeds, coarser film, one run in time.
    output : path or None
        Folder for the pictures; None writes none.
    """
    film, top = bearing(quick=quick), 12000.0
    rotor = Rotor(film)
    chosen = np.array([2500.0] if quick else [1500.0, 2500.0, 4000.0]) * RPM
    speeds = np.unique(np.concatenate((np.linspace(800.0, top, 15 if quick else 100) * RPM, chosen)))
    print(
        "rotor with two discs on two films; compiling the film's kernels takes some seconds the first time", flush=True
    )
    start = time.process_time()
    result = ehd.SolveEquilibrium(rotor.mbs, speeds)
    response = result.unbalance_response({rotor.discs[0]: UNBALANCE})
    seconds = time.process_time() - start
    threshold = ehd.SolveThreshold(rotor.mbs, 2000.0 * RPM, top * RPM)
    assert threshold is not None
    amplitude, runs = response.amplitude("free end"), {}
    for speed in chosen:
        runs[speed] = whirl_in_time(film, result, speed, turns=12 if quick else 40, steps=80)
        linear = amplitude[int(np.argmin(np.abs(speeds - speed)))]
        print(f"  {speed / RPM:.0f} rpm: {1e6 * runs[speed]:.3f} um in time, {1e6 * linear:.3f} um linear", flush=True)
    clearances = np.array([30e-6, 40e-6, 50e-6] if quick else [25e-6, 30e-6, 35e-6, 40e-6, 45e-6, 50e-6, 60e-6])
    table = ehd.stability_map(
        lambda c: Rotor(bearing(c, quick=quick)).mbs, clearances, lowest=1500.0 * RPM, highest=top * RPM
    )
    numbers = figures(result, response, threshold, runs) | {
        "threshold_rpm_at_the_smallest_clearance": table.thresholds[0] / RPM,
        "threshold_rpm_at_the_largest_clearance": table.thresholds[-1] / RPM,
        "milliseconds_per_speed": 1e3 * seconds / speeds.size,
    }
    for name, value in numbers.items():
        print(f"{name:40s}{value:10.4g}")
    if output is not None:
        draw(rotor, result, response, table, runs, pathlib.Path(output))
    return numbers


def figures(result, response, threshold, runs: dict[float, float]) -> dict[str, float]:
    """Numbers of the example."""
    amplitude, value = response.amplitude("free end"), threshold.eigenvalues[0]
    whirl = value[np.argmax(value.real)]
    campbell, last = result.campbell(), result.speeds[-1]
    # bending of the overhung disc at the highest speed: the slowest whirls that hardly feel the films
    light = (campbell["damping_ratio"][-1] < 0.1) & (campbell["frequency"][-1] < last)
    bending, sense = campbell["frequency"][-1][light] / (2.0 * math.pi), campbell["whirl"][-1][light]
    linear = [amplitude[int(np.argmin(np.abs(result.speeds - speed)))] for speed in runs]
    return {
        "threshold_rpm": threshold.speeds[0] / RPM,
        "whirl_ratio": abs(whirl.imag) / threshold.speeds[0],
        "resonance_rpm": result.speeds[int(np.argmax(amplitude))] / RPM,
        "backward_Hz": float(bending[sense < -0.5].min()),
        "forward_Hz": float(bending[sense > 0.5].max()),
        "largest_error_in_time": max(abs(a / b - 1.0) for a, b in zip(linear, runs.values(), strict=True)),
        "largest_journal_amplitude": float(amplitude.max()) / CLEARANCE,
    }


def draw(rotor, result, response, table, runs: dict[float, float], folder: pathlib.Path) -> None:
    """Write the pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    with styled():
        figure, axes = plt.subplots(1, 2, figsize=(9.5, 3.6), layout="constrained")
        result.plot_campbell(ax=axes[0])
        result.plot_stability(ax=axes[1])
        figure.savefig(folder / "campbell.png", dpi=120)
        plt.close(figure)
    items = {"middle disc": rotor.discs[0], "overhung disc": rotor.discs[1], "journal, free end": "free end"}
    figure = response.plot(items)
    upper = figure.axes[0]
    with styled():
        upper.plot(
            np.array(list(runs)) / RPM, 1e6 * np.array(list(runs.values())), "o", color="black", label="run in time"
        )
        upper.set(yscale="log", ylim=(1e-2, 1e3))
        upper.legend(loc="upper right", ncols=2)
    figure.savefig(folder / "unbalance.png", dpi=120)
    table.plot("radial clearance", unit="µm", factor=1e6, path=folder / "stability_map.png")
    result.plot_positions(path=folder / "positions.png")
    print(f"\npictures: {folder}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer speeds, coarser film")
    main(quick=parser.parse_args().quick)
