"""The film in a running mechanism, drawn by Exudyn's ray tracer: a picture or an animation, no display needed.

A slider-crank of rigid bodies: a flywheel as crank (50 mm), a connecting rod of 150 mm and a piston of 0.58 kg, at 3000
rpm. The gudgeon pin, 28 mm thick and 30 mm long with 20 um radial clearance, runs on oil of 20 mPa s. The piston is
drawn as glass and the rod without its eye, so that the pressure on the bore can be seen: dark is ambient pressure,
yellow the largest of the moment.

Run ``python examples/film_in_mechanism.py``; picture and animation are written to ``results/film_in_mechanism``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import exudyn.graphics as graphics
import numpy as np
from exudyn.utilities import InertiaCuboid, InertiaCylinder
from PIL import Image

import exudyn_ehd as ehd

CRANK, ROD, SPEED = 0.05, 0.15, 314.0
TURN = 2.0 * math.pi / SPEED
PIN, WIDTH = 0.014, 0.030
GREY, STEEL, BLUE, GLASS = [0.55, 0.6, 0.66, 1], [0.72, 0.74, 0.78, 1], [0.36, 0.5, 0.68, 1], [0.6, 0.66, 0.74, 0.22]
# degrees of crank angle from one picture to the next, and steps of the solver between them
FRAME, STEPS = 2, 2


def cylinder(start, vector, radius, color):
    return graphics.Cylinder(pAxis=start, vAxis=vector, radius=radius, color=color, nTiles=96)


def build():
    """The mechanism at its outer dead centre; returns container, system and joint."""
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    ground = mbs.CreateGround()
    flywheel = mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800, 0.05, 0.15, 2),
        initialAngularVelocity=[0, 0, SPEED],
        graphicsDataList=[
            cylinder([0, 0, -0.035], [0, 0, 0.02], 0.07, GREY),
            cylinder([CRANK, 0, -0.035], [0, 0, 0.055], 0.011, STEEL),
        ],
    )
    rod = mbs.CreateRigidBody(
        inertia=InertiaCuboid(7800, [ROD, 0.02, 0.02]),
        referencePosition=[CRANK + ROD / 2, 0, 0],
        initialVelocity=[0, SPEED * CRANK / 2, 0],
        initialAngularVelocity=[0, 0, -SPEED * CRANK / ROD],
        graphicsDataList=[
            graphics.Brick(centerPoint=[-0.005, 0, 0], size=[0.118, 0.018, 0.012], color=BLUE),
            cylinder([-ROD / 2, 0, -0.008], [0, 0, 0.016], 0.018, BLUE),
        ],
    )
    piston = mbs.CreateRigidBody(
        inertia=InertiaCuboid(2700, [0.06, 0.06, 0.06]),
        referencePosition=[CRANK + ROD, 0, 0],
        graphicsDataList=[
            cylinder([-0.025, 0, 0], [0.06, 0, 0], 0.038, GLASS),
            cylinder([0, 0, -0.035], [0, 0, 0.07], 0.98 * PIN, STEEL),
        ],
    )
    mbs.CreateRevoluteJoint(itemNumbers=[ground, flywheel], position=[0, 0, 0], axis=[0, 0, 1])
    mbs.CreateRevoluteJoint(itemNumbers=[flywheel, rod], position=[CRANK, 0, 0], axis=[0, 0, 1])
    mbs.CreatePrismaticJoint(itemNumbers=[ground, piston], position=[CRANK + ROD, 0, 0], axis=[1, 0, 0])
    bearing = ehd.JournalBearing(
        journal_radius=PIN, length=WIDTH, radial_clearance=20e-6, lubricant=ehd.Lubricant(viscosity=0.02)
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="gudgeon pin",
        itemNumbers=[rod, piston],
        position=[CRANK + ROD, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing,
    )
    mbs.Assemble()
    return SC, mbs, joint


def set_view(SC, width: int) -> None:
    """Bodies and film only, seen from the front and the right."""
    shown = SC.visualizationSettings
    shown.view0.window.renderWindowSize = [width, round(0.54 * width)]
    for group in (shown.connectors, shown.nodes, shown.markers, shown.loads, shown.sensors):
        group.show = False
    shown.view0.scene.drawCoordinateSystem = False
    shown.raytracer.advanced.showText = False
    shown.raytracer.multiSampling = 4
    # the first image sets the view from the settings
    SC.renderer.RedrawAndGetImage(True)
    SC.renderer.SetModelView(zoom=0.085, rotationVector=[0.47, -0.72, 0.18], centerPoint=[0.062, 0.012, 0.0])


def run(SC, mbs, degrees: int, first: int) -> list[Image.Image]:
    """Run to a crank angle; pictures from ``first`` on, every ``FRAME`` degrees."""
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = degrees * STEPS // FRAME
    settings.timeIntegration.endTime = degrees / 360 * TURN
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    pictures = []

    def draw(mbs, t):
        angle = 360 * t / TURN
        if angle > first - 0.5 and min(angle % FRAME, -angle % FRAME) < 0.1:
            mbs.SendRedrawSignal()
            pictures.append(Image.fromarray(np.array(SC.renderer.RedrawAndGetImage(True))))
        return True

    mbs.SetPostStepUserFunction(draw)
    ehd.SolveDynamic(mbs, settings)
    return pictures


def main(*, quick: bool = False, results: str | pathlib.Path = "results/film_in_mechanism") -> dict:
    """Run a turn and draw the next one.

    Parameters
    ----------
    quick : bool
        A small picture after a few degrees, and no animation.
    results : path
        Folder.

    Returns
    -------
    dict
        ``joint`` and ``files``.
    """
    folder = pathlib.Path(results)
    folder.mkdir(parents=True, exist_ok=True)
    SC, mbs, joint = build()
    set_view(SC, 240 if quick else 560)
    pictures = run(SC, mbs, 12 if quick else 720, 12 if quick else 360 + FRAME)
    files = [folder / "film_in_mechanism.png"]
    pictures[-1].save(files[0])
    if not quick:
        files.append(folder / "film_in_mechanism.gif")
        first, *others = [picture.quantize(128) for picture in pictures]
        first.save(files[1], save_all=True, append_images=others, duration=110, loop=0, optimize=True)
    print(f"minimum film thickness {1e6 * joint.history.minimum_gap.min():.2f} µm; " + ", ".join(map(str, files)))
    return {"joint": joint, "files": files}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one small picture")
    main(quick=parser.parse_args().quick)
