"""A hollow finite-element shaft in a bearing that carries a standing load: round and oval bore against a rigid one.

A shaft of 40 mm runs at 2865 rpm under a constant load of 8 kN in one bearing of 30 mm length. A flywheel drives it
through a coupling that transmits rotation and axial position only. The wall of a hollow shaft deflects under the oil
pressure: the peak falls from 17.8 to 12.4 MPa. The minimum film thickness falls from 7.1 to 6.4 µm and moves to the
bearing's ends, where the wall deflects least. With an oval hole the shaft is softer in one direction than in the
other: under the same constant load the minimum film thickness varies twice in every turn, from 6.1 to 6.5 µm. A
journal whose modes stand still in the film (`ElasticJournal`) can't show that; the modes of a finite-element body turn
with it (`FEJournal`). The cross sections have the same area to 0.7 %. The end faces carry the floating frame, so that
modes represent the bending too.

The rigid shaft starts in its equilibrium, the others in that of the round shaft. All numbers leave out the first turn,
in which the oscillation of the start decays.

Run ``python examples/fe_shaft.py``; the picture is written to ``results``.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from exudyn.utilities import InertiaCylinder
from matplotlib.figure import Figure

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled
from exudyn_ehd.solid.total_lagrange import TotalLagrange

RADIUS, HOLE, SPAN = 0.020, 0.015, 0.060
LENGTH, CLEARANCE, VISCOSITY = 0.030, 20e-6, 0.02
SPEED, LOAD = 300.0, 8e3
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
# half the difference of the oval hole's half axes, m
OVAL = {"round hole": 0.0, "oval hole": 0.0015}
SKIPPED, SHOWN = 1, 2


def shaft_fem(oval: float, *, quick: bool) -> FEMinterface:
    """Return a hollow shaft about the z axis with the modes that its journal needs under oil.

    Its hole has the radius HOLE + oval cos(2 theta).
    """
    tube = ehd.HollowCylinder(
        inner_radius=HOLE,
        thickness=RADIUS - HOLE,
        length=SPAN,
        axial=4 if quick else 8,
        radial=1 if quick else 2,
        circumferential=16 if quick else 32,
    ).mesh()
    r, theta = np.hypot(*tube.nodes[:, :2].T), np.arctan2(tube.nodes[:, 1], tube.nodes[:, 0])
    r = r + oval * np.cos(2.0 * theta) * (RADIUS - r) / (RADIUS - HOLE)
    fem = FEMinterface()
    fem.nodes = {"Position": np.column_stack([r * np.cos(theta), r * np.sin(theta), tube.nodes[:, 2]])}
    fem.elements = [{"Name": "shaft", "Hex20": tube.elements}]
    mesh = ehd.mesh_from_fem(fem, bore_radius=RADIUS, origin=(0, 0, 0))
    solid = TotalLagrange(mesh=mesh, material=STEEL)
    fem.stiffnessMatrix = solid.tangent(np.zeros_like(mesh.nodes)).tocsr()
    fem.massMatrix = solid.mass.tocsr()
    fem.VolumeToSurfaceElements()
    ends = np.flatnonzero(np.abs(np.abs(mesh.nodes[:, 2]) - 0.5 * SPAN) < 1e-9)
    # load and bearing are symmetric about the mid-plane
    ehd.add_bore_modes(
        fem,
        position=[0, 0, 0],
        axis=[0, 0, 1],
        radius=RADIUS,
        length=LENGTH,
        fixed_nodes=ends,
        tolerance=0.1 if quick else 0.04,
        tilted=False,
    )
    return fem


def bearing(journal: object, *, quick: bool) -> ehd.JournalBearing:
    """Return the bearing with a rigid bore around a journal; None: a rigid one."""
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=LENGTH,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=VISCOSITY),
        journal=journal,
        film=ehd.FiniteLength(n_theta=48, n_z=6) if quick else ehd.FiniteLength(),
    )


def start_place(fem: FEMinterface | None) -> np.ndarray:
    """Equilibrium position (2,) of a rigid shaft, or of the round one as a pin held by its end faces, m."""
    pin = None
    if fem is not None:
        pin = ehd.ElasticJournal(
            material=STEEL, span=(-0.5 * SPAN, 0.5 * SPAN), held=ehd.HeldEnds(), inner_radius=HOLE, tilted=False
        )
    return ehd.equilibrium(bearing(pin, quick=False), speed=SPEED, load=(0.0, -LOAD)).position


def add_shaft(mbs: exu.MainSystem, fem: FEMinterface | None) -> tuple[exu.ObjectIndex, exu.MarkerIndex]:
    """The shaft, rigid without ``fem``, at full speed; its body and a marker on its frame."""
    place, spin = start_place(fem), [0.0, 0.0, SPEED]
    if fem is None:
        shaft = mbs.CreateRigidBody(
            inertia=InertiaCylinder(7800, SPAN, RADIUS, 2, HOLE),
            initialDisplacement=[*place, 0.0],
            initialAngularVelocity=spin,
            nodeType=exu.NodeType.RotationRxyz,
        )
        return shaft, mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=shaft))
    body = ObjectFFRFreducedOrderInterface(fem, "NodeType.RotationRxyz")
    parts = body.AddObjectFFRFreducedOrder(mbs, initialAngularVelocity=spin)
    shaft, node = parts["oFFRFreducedOrder"], parts["nRigidBody"]
    coordinates = np.array(mbs.GetNodeParameter(node, "initialCoordinates"))
    coordinates[:2] += place
    mbs.SetNodeParameter(node, "initialCoordinates", coordinates.tolist())
    return shaft, mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=node))


def build(fem: FEMinterface | None, *, quick: bool) -> tuple[exu.MainSystem, ehd.LubricatedJoint]:
    """The flywheel and the shaft in its bearing, the shaft rigid without ``fem``."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    flywheel = mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800, 0.1, 0.3, 2),
        referencePosition=[0, 0, 0.2],
        initialAngularVelocity=[0.0, 0.0, SPEED],
    )
    mbs.CreateRevoluteJoint(itemNumbers=[ground, flywheel], position=[0, 0, 0.2], axis=[0, 0, 1])
    shaft, marker = add_shaft(mbs, fem)
    # the coupling turns the shaft and holds it along its axis
    wheel = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=flywheel, localPosition=[0, 0, -0.2]))
    mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=[wheel, marker], constrainedAxes=[0, 0, 1, 0, 0, 1]))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0.0, -LOAD, 0.0]))
    journal = None if fem is None else ehd.FEJournal(fem=fem)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="shaft",
        itemNumbers=[ground, shaft],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing(journal, quick=quick),
    )
    mbs.Assemble()
    return mbs, joint


def simulate(fem: FEMinterface | None, *, quick: bool) -> dict:
    """Run one shaft; its history over the turns that count, and what it says."""
    mbs, joint = build(fem, quick=quick)
    steps_per_turn, turns = (60, 1.5) if quick else (360, SKIPPED + SHOWN)
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
    settings.timeIntegration.endTime = turns * 2.0 * math.pi / SPEED
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    clock = time.process_time()
    ehd.SolveDynamic(mbs, settings)
    spent = time.process_time() - clock
    h, turn = joint.history, SPEED * joint.history.time / (2.0 * math.pi)
    kept = turn >= (0.5 if quick else SKIPPED)
    return {
        "turn": turn[kept],
        "film_um": 1e6 * h.minimum_gap[kept],
        "peak_MPa": h.peak_pressure[kept] / 1e6,
        "eccentricity": h.eccentricity[kept] / CLEARANCE,
        "modes": 0 if fem is None else fem.modeBasis["matrix"].shape[1],
        "milliseconds_per_step": 1e3 * spent / settings.timeIntegration.numberOfSteps,
    }


@styled(10.0)
def draw(cases: dict, path: Path) -> None:
    """Film and pressure over two turns, orbits in the clearance, and the two sections."""
    figure = Figure(figsize=(11, 6.5), layout="constrained")
    axes = figure.subplot_mosaic("ffo;ffo;pps", gridspec_kw={"width_ratios": (1, 1, 1.1)})
    colours = {}
    for name, case in cases.items():
        (line,) = axes["f"].plot(case["turn"], case["film_um"], label=name)
        colours[name] = line.get_color()
        axes["p"].plot(case["turn"], case["peak_MPa"], color=colours[name])
        axes["o"].plot(*case["eccentricity"].T, color=colours[name], marker="." if name == "rigid shaft" else None)
    turn = cases["rigid shaft"]["turn"]
    for key, label in (("f", "minimum film thickness [µm]"), ("p", "peak pressure [MPa]")):
        axes[key].set(xlabel="turns of the shaft", ylabel=label, xlim=(turn[0], turn[-1]))
    axes["f"].legend()
    axes["o"].set(title="path of the shaft in the clearance", xlabel="x / c [-]", ylabel="y / c [-]", aspect="equal")
    angle = np.linspace(0.0, 2.0 * math.pi, 181)
    for name, oval in OVAL.items():
        hole = 1e3 * (HOLE + oval * np.cos(2.0 * angle))
        axes["s"].plot(hole * np.cos(angle), hole * np.sin(angle), color=colours[name])
    axes["s"].plot(1e3 * RADIUS * np.cos(angle), 1e3 * RADIUS * np.sin(angle), color="0.4")
    axes["s"].set(title="sections", xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    figure.savefig(path, dpi=110)


def main(*, quick: bool = False, results: str | Path | None = None) -> dict:
    """Run the three shafts; with ``results`` write the picture there."""
    fems = {name: shaft_fem(oval, quick=quick) for name, oval in OVAL.items()}
    cases = {"rigid shaft": simulate(None, quick=quick)}
    cases |= {name: simulate(fem, quick=quick) for name, fem in fems.items()}
    outcome: dict = dict(cases)
    if results is not None:
        folder = Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        draw(cases, folder / "fe_shaft.png")
        outcome["picture"] = folder / "fe_shaft.png"
    return outcome


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    outcome.pop("picture")
    for name, case in outcome.items():
        film, peak = case["film_um"], case["peak_MPa"]
        print(
            f"{name}: {case['modes']} modes, film {film.min():.2f} to {film.max():.2f} µm, "
            f"peak {peak.min():.1f} to {peak.max():.1f} MPa, {case['milliseconds_per_step']:.1f} ms a step"
        )
