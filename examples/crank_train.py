"""Crank train of a three-cylinder engine over four-stroke cycles: four main bearings and three big ends on oil.

A petrol engine of one litre at 3000 rpm and full load, with typical sizes of no engine in particular. Four main
bearings carry one rigid crankshaft: with ideal joints their loads would be undetermined, the films determine them.
Ideal joints guide the pistons and hold the rods' small ends. A groove in the upper shell feeds each main bearing, a
hole in the pin each big end. The gas is an ideal one, d(p V^k) = (k - 1) V^(k-1) dQ, with Wiebe's burn function for the
heat Q (J. I. Ghojel, Int. J. Engine Research 11 (2010) 297). Surfaces are rigid and the viscosity is constant:
``joint.audit()`` tells how much that matters.

Run ``python examples/crank_train.py``; the picture is written to ``results/crank_train``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import matplotlib.pyplot as plt
import numpy as np
from exudyn.utilities import InertiaCuboid, InertiaCylinder, InertiaMassPoint, RotationMatrixZ

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

SPEED = 3000.0 * 2.0 * math.pi / 60.0
CYCLE = 4.0 * math.pi / SPEED
CRANK, ROD, PITCH, AREA = 0.041, 0.137, 0.080, 0.25 * math.pi * 0.072**2  # m, m2; bore 72 mm
PISTON_MASS, ROD_MASS, ROD_CENTRE = 0.33, 0.42, 0.3  # kg; centre of mass behind the big end, over the length
FIRING = np.radians([0.0, 480.0, 240.0])  # crank angles of cylinders 1, 2, 3 at their firing dead centres
FEED, OIL = 3e5, ehd.Lubricant(viscosity=8e-3)  # Pa; SAE 5W-30 at some 105 degrees Celsius


def gas_pressure() -> tuple[np.ndarray, np.ndarray]:
    """Crank angle from the firing dead centre (n,), rad, -2 pi to 2 pi, and gauge pressure in the cylinder (n,), Pa."""
    angle, k, heat = np.radians(np.linspace(-360.0, 360.0, 1441)), 1.32, 720.0  # ratio of specific heats; J
    stroke = CRANK * (1.0 - np.cos(angle)) + ROD - np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2)
    volume = AREA * (stroke + 2.0 * CRANK / 9.5)  # compression ratio 10.5
    burnt = 1.0 - np.exp(-5.0 * np.clip((np.degrees(angle) + 18.0) / 55.0, 0.0, None) ** 3)
    middle = 0.5 * (volume[1:] ** (k - 1.0) + volume[:-1] ** (k - 1.0))
    gained = (k - 1.0) * heat * np.concatenate([[0.0], np.cumsum(middle * np.diff(burnt))])
    closed = (1e5 * volume[360] ** k + gained) / volume**k - 1e5  # from 1 bar at the bottom dead centre
    leaves = np.clip((np.degrees(angle) - 130.0) / 50.0, 0.0, 1.0)  # the exhaust valve opens at 130 degrees
    return angle, np.where(angle < -math.pi, 0.0, 0.5 * (1.0 + np.cos(math.pi * leaves)) * closed)


def lubricated(mbs, name, items, position, supply, radius, length, film, axial=None) -> ehd.LubricatedJoint:
    """A bearing of 20 um radial clearance between ``items``, housing and journal."""
    size = {"journal_radius": radius, "length": length, "radial_clearance": 20e-6, "lubricant": OIL, "film": film}
    bearing = ehd.JournalBearing(**size, supply=(supply,), cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    return ehd.CreateLubricatedJoint(mbs, name, items, position, [0, 0, 1], bearing, axial=axial or ehd.Free())


def add_cylinder(mbs, ground: int, pin: np.ndarray, fires: float) -> int:
    """Rod on the crank ``pin`` and piston, with the velocities of the ideal mechanism; returns the rod."""
    turned, velocity = RotationMatrixZ(-math.asin(pin[1] / ROD)), SPEED * np.array([-pin[1], pin[0], 0.0])
    spin = -velocity[1] / (ROD * turned[0, 0])
    rod = mbs.CreateRigidBody(
        inertia=InertiaCuboid(ROD_MASS / (0.2 * 0.02 * 0.02), [0.2, 0.02, 0.02]),
        referencePosition=pin + turned @ [ROD_CENTRE * ROD, 0, 0],
        referenceRotationMatrix=turned,
        initialVelocity=velocity + spin * turned @ [0, ROD_CENTRE * ROD, 0],
        initialAngularVelocity=[0, 0, spin],
    )
    top, speed = pin + turned @ [ROD, 0, 0], velocity + spin * turned @ [0, ROD, 0]
    inertia = InertiaCuboid(PISTON_MASS / 0.06**3, [0.06, 0.06, 0.06])
    piston = mbs.CreateRigidBody(inertia=inertia, referencePosition=top, initialVelocity=speed)
    mbs.CreateRevoluteJoint(itemNumbers=[rod, piston], position=top, axis=[0, 0, 1])
    mbs.CreatePrismaticJoint(itemNumbers=[ground, piston], position=top, axis=[1, 0, 0])
    gas = gas_pressure()

    def load(mbs, t, vector):
        return [-AREA * float(np.interp(SPEED * t - fires, *gas, period=4.0 * math.pi)), 0.0, 0.0]

    mbs.CreateForce(itemNumber=piston, loadVector=[0, 0, 0], loadVectorUserFunction=load)
    return rod


def simulate(*, cycles: int, steps: int, film: ehd.FiniteLength) -> list[ehd.LubricatedJoint]:
    """Run cycles of so many steps from the firing of cylinder 1 on; returns the mains and the big ends."""
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    ground, z = mbs.CreateGround(), PITCH * np.array([-1.0, 0.0, 1.0])
    pins = np.column_stack([CRANK * np.cos(FIRING), -CRANK * np.sin(FIRING), z])  # cylinders along x, shaft along z
    inertia = InertiaCylinder(7800, 4.0 * PITCH, 0.03, 2) + InertiaCylinder(7800, 0.03, 0.13, 2)  # shaft and flywheel
    for pin in pins:  # counterweights balance the big ends' share of the rods
        inertia += InertiaMassPoint((1.0 - ROD_CENTRE) * ROD_MASS).Translated(pin * [-1.0, -1.0, 1.0])
    angles = {"nodeType": exu.NodeType.RotationRxyz, "initialAngularVelocity": [0, 0, SPEED]}
    shaft = mbs.CreateRigidBody(inertia=inertia, **angles)  # its coordinate 5 is the angle about z
    drive = {"offsetUserFunction": lambda mbs, t, item, offset: SPEED * t}
    mbs.CreateCoordinateConstraint(itemNumbers=[ground, shaft], coordinates=[None, 5], **drive)
    joints, groove = [], ehd.Pocket(angle=0.0, width_angle=math.pi, length=4e-3, pressure=FEED)
    for i in range(4):
        name, place, axial = f"main {i + 1}", [0, 0, PITCH * (i - 1.5)], ehd.Held() if i == 3 else None
        joints.append(lubricated(mbs, name, [ground, shaft], place, groove, 0.023, 0.018, film, axial))
    for i, (pin, fires) in enumerate(zip(pins, FIRING, strict=True)):
        rod = add_cylinder(mbs, ground, pin, fires)
        ahead = math.atan2(pin[1], pin[0]) + math.asin(pin[1] / ROD) + math.pi / 3.0  # of the throw; from the rod's x
        hole = ehd.Hole(angle=ahead, diameter=5e-3, pressure=FEED, rotating=True)
        joints.append(lubricated(mbs, f"big end {i + 1}", [rod, shaft], pin, hole, 0.021, 0.017, film))
    mbs.Assemble()
    settings = ehd.ConfigureSolver(exu.SimulationSettings())
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = cycles * CYCLE, cycles * steps
    settings.solution.file.write = False
    ehd.SolveDynamic(mbs, settings)
    return joints


@styled(10.0)
def draw(joints: list[ehd.LubricatedJoint], path: pathlib.Path) -> None:
    """Gas pressure and minimum film thickness over the last cycle."""
    fig, axes = plt.subplots(3, 1, figsize=(8, 8.5), sharex=True, layout="constrained")
    crank = np.linspace(0.0, 4.0 * math.pi, 1441)
    for i, fires in enumerate(FIRING):
        gas = np.interp(crank - fires, *gas_pressure(), period=4.0 * math.pi)
        axes[0].plot(np.degrees(crank), 1e-5 * gas, label=f"cylinder {i + 1}")
    for joint in joints:
        h, ax = joint.history.between(joint.history.time[-1] - CYCLE), axes[1 + joint.name.startswith("big")]
        ax.plot(np.degrees(SPEED * (h.time - h.time[0])), 1e6 * h.minimum_gap, label=joint.name)
    for ax, label in zip(axes, ("gas, above ambient [bar]", *2 * ["minimum film thickness [µm]"]), strict=True):
        ax.set(ylabel=label, ylim=(0, None), xlim=(0, 720), xticks=range(0, 721, 60))
        ax.vlines(np.degrees(FIRING), *ax.get_ylim(), color="grey", ls="--", lw=0.8)
        ax.legend(ncols=4, loc="lower right", bbox_to_anchor=(1, 1))
    axes[2].set_xlabel("crank angle [°]; dashed: a cylinder at its firing dead centre")
    fig.savefig(path, dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, results: str | pathlib.Path = "results/crank_train") -> dict:
    """Run two cycles, ``quick`` one on a coarse grid; returns the last one's table by bearing, and the joints."""
    cycles, steps, grid = (1, 540, (48, 6)) if quick else (2, 720, (64, 8))  # 96 x 10: films of big ends + 7 %
    joints, table = simulate(cycles=cycles, steps=steps, film=ehd.FiniteLength(n_theta=grid[0], n_z=grid[1])), {}
    print("bearing    minimum film thickness [µm]   at [°]   peak pressure [MPa]   loss [W]   oil flow [l/min]")
    for joint in joints:
        cycle = joint.revolutions(period=CYCLE)
        at = np.degrees(SPEED * cycle.minimum_gap_time[-1]) % 720.0
        row = [1e6 * cycle.minimum_gap[-1], at, 1e-6 * cycle.peak_pressure[-1], cycle.mean_power_loss[-1]]
        table[joint.name] = row = [*row, 6e4 * cycle.mean_leakage[-1]]
        print("{:10s}{:28.2f}{:9.0f}{:22.1f}{:11.1f}{:19.3f}".format(joint.name, *row))
    picture = pathlib.Path(results) / "crank_train.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw(joints, picture)
    return {"table": table, "joints": joints, "picture": picture}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one cycle, coarse films")
    main(quick=parser.parse_args().quick)
