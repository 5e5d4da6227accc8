"""A turbocharger's rotor runs up on two floating rings: the inner films whirl first, then the outer films.

Each ring floats in the oil between housing and shaft, and the oil turns it. The outer film lies between housing and
ring, the inner film between ring and shaft: the ring is the journal of one joint and the housing of the other, so that
two rings make four joints. The rotor is rigid and symmetric and runs up from 300 to 2500 Hz (150 000 rpm) in 0.3 s. All
numbers are our own, of the size of a passenger car's turbocharger: a shaft of 7 mm and 120 g, bronze rings of 12 mm,
radial clearances of 10 um inside and 45 um outside, hot oil of constant viscosity.

What is compared:

* The speed w of a ring against the shaft's speed W. Concentric films turn a ring of the inertia J by

      J dw/dt = 2 pi mu_i Ri^3 Li / ci (W - w) - 2 pi mu_o Ro^3 Lo / co w

  Before the films whirl, the ring is within 1 % of that, later within 5 %.
* The frequencies of whirl against the mean speed of the surfaces, (W + w) / 2 in an inner and w / 2 in an outer film.
  The motion in the outer film, whose housing stands still, contains both whirls: at 2300 Hz 0.60 and 0.145 of the
  shaft's speed, where the mean speeds are 0.64 and 0.14.

The estimated error of the time steps (``history.step_error``) is 1 % of the film thickness in the inner films, half
or so of the true error. Steps of half the length change no number of the table by 0.5 %.

Run ``python examples/floating_rings.py``; the picture is written to ``results/floating_rings``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.utilities import InertiaCylinder, RigidBodyInertia

import exudyn_ehd as ehd
from exudyn_ehd.pictures.histories import spectra
from exudyn_ehd.pictures.style import PAGE, new_figure, styled, write

HZ = 2.0 * math.pi
FIRST, LAST, DURATION = 300.0 * HZ, 2500.0 * HZ, 0.3
RATE = (LAST - FIRST) / DURATION
SHAFT = RigidBodyInertia(mass=0.12, inertiaTensor=np.diag([9e-5, 9e-5, 1.2e-5]), com=[8e-7, 0, 0])
RING = InertiaCylinder(8400.0, 6e-3, 6e-3, 2, innerRadius=3.5e-3)
GRID = ehd.FiniteLength(n_theta=48, n_z=4)
INNER = ehd.JournalBearing(
    journal_radius=3.5e-3, length=4.5e-3, radial_clearance=10e-6, lubricant=ehd.Lubricant(viscosity=0.007), film=GRID
)
OUTER = ehd.JournalBearing(
    journal_radius=6e-3, length=6e-3, radial_clearance=45e-6, lubricant=ehd.Lubricant(viscosity=0.010), film=GRID
)
# Drag of the concentric films on a ring, N m s.
DRAGS = [HZ * b.lubricant.viscosity * b.journal_radius**3 * b.length / b.radial_clearance for b in (INNER, OUTER)]
RATIO, LAG = DRAGS[0] / sum(DRAGS), RING.Inertia()[2, 2] / sum(DRAGS)


def ring_in_concentric_films(time: np.ndarray) -> np.ndarray:
    """Speed of a ring, rad/s, that starts in balance: it lags behind the shaft by its inertia."""
    return RATIO * (FIRST + RATE * (time - LAG * (1.0 - np.exp(-time / LAG))))


def run_up(steps: int) -> dict[str, ehd.JointHistory]:
    """Histories of the four films by their names."""
    mbs = exu.SystemContainer().AddSystem()
    ground, joints = mbs.CreateGround(), {}
    options = {"nodeType": exu.NodeType.RotationRxyz, "gravity": [0, -9.81, 0]}
    shaft = mbs.CreateRigidBody(inertia=SHAFT, initialAngularVelocity=[0, 0, FIRST], returnDict=True, **options)
    for name, z in (("compressor", -0.02), ("turbine", 0.02)):
        spin = [0, 0, RATIO * FIRST]
        ring = mbs.CreateRigidBody(referencePosition=[0, 0, z], inertia=RING, initialAngularVelocity=spin, **options)
        # one of the two rings holds the shaft along its axis
        inner = ("inner", [ring, shaft["bodyNumber"]], INNER, ehd.Held() if z < 0.0 else ehd.Free())
        for film, items, bearing, held in (("outer", [ground, ring], OUTER, ehd.Held()), inner):
            key = f"{name} {film} film"
            joints[key] = ehd.CreateLubricatedJoint(mbs, key, items, [0, 0, z], [0, 0, 1], bearing, axial=held)
    ends = [(mbs.AddNode(eii.NodePointGround()), 0), (shaft["nodeNumber"], 5)]  # 5: the angle about z
    markers = [mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=n, coordinate=k)) for n, k in ends]
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=markers,
            offsetUserFunction=lambda mbs, t, item, offset: FIRST * t + 0.5 * RATE * t**2,
            offsetUserFunction_t=lambda mbs, t, item, offset: FIRST + RATE * t,
        )
    )
    mbs.Assemble()
    settings = ehd.ConfigureSolver(exu.SimulationSettings())
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, DURATION
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    settings.solution.file.write = False
    ehd.SolveDynamic(mbs, settings)
    return {name: joint.history for name, joint in joints.items()}


def whirls(outer: ehd.JointHistory) -> dict[float, dict[str, float]]:
    """Rows of the table by the shaft's speed in Hz; frequencies and ring's speeds over it, amplitudes in um."""
    frequency, time, amplitude = spectra(outer)
    rows = {}
    for speed in (700.0, 1500.0, 2300.0):
        k = int(np.argmin(np.abs(FIRST + RATE * time - HZ * speed)))
        order, line = frequency / speed, 1e6 * amplitude[:, k]
        ring = float(np.interp(time[k], outer.time, outer.motion[:, 8])) / (HZ * speed)
        row = {"ring": ring, "ring_concentric": float(ring_in_concentric_films(time[k])) / (HZ * speed)}
        for name, low, high in (("outer", 0.05, 0.25), ("inner", 0.45, 0.8)):
            part = np.flatnonzero((order > low) & (order < high))
            best = part[np.argmax(line[part])]
            row |= {f"{name}_whirl": float(order[best]), f"{name}_amplitude_um": float(line[best])}
        rows[speed] = row | {"mean_outside": 0.5 * ring, "mean_inside": 0.5 * (1.0 + ring)}
    return rows


@styled()
def draw(outer: ehd.JointHistory, path: pathlib.Path) -> None:
    """Waterfall of the outer film, and speed of the ring."""
    figure = new_figure((PAGE, 0.45 * PAGE), path)
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1))
    shaft, ring, rpm = FIRST + RATE * outer.time, outer.motion[:, 8], 60.0 / HZ
    outer.plot_waterfall(speed=shaft, ax=left)
    left.set(xlim=left.get_xlim(), ylim=left.get_ylim())
    left.plot(0.5 * (shaft + ring) / HZ, rpm * shaft, lw=0.8, color="tab:red", label="mean of shaft and ring")
    left.plot(0.5 * ring / HZ, rpm * shaft, lw=0.8, color="tab:orange", label="half the ring's speed")
    left.legend(loc="lower right", labelcolor="white")
    right.plot(rpm * shaft, ring / shaft, label="simulated")
    right.plot(rpm * shaft, ring_in_concentric_films(outer.time) / shaft, "--", label="concentric films")
    right.set(xlabel="speed of the shaft [1/min]", ylabel="speed of the ring / of the shaft [-]", ylim=(0.0, 0.4))
    right.locator_params(axis="x", nbins=4)
    right.legend(loc="lower right")
    write(figure, path)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/floating_rings") -> dict:
    """Run up, print a table of speeds and whirls, draw; ``quick`` takes steps of twice the length."""
    outer = run_up(6000 if quick else 12000)["compressor outer film"]
    rows = whirls(outer)
    print("frequencies and the ring's speed over the shaft's speed, amplitudes in the outer film in um")
    for name in rows[700.0]:
        print(f"{name:>22s}" + "".join(f"{row[name]:10.3f} at {speed:.0f} Hz" for speed, row in rows.items()))
    if output is not None:
        draw(outer, pathlib.Path(output) / "floating_rings.png")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="steps of twice the length")
    main(quick=parser.parse_args().quick)
