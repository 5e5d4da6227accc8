"""A finite-element connecting rod whose big end deforms under the oil pressure.

The slider-crank of `elastic_big_end.py`, 3000 rpm with a gas pulse on the piston, with the whole rod as a reduced
finite-element body: two eyes and a shank of 20-node hexahedra, small end as rigid interface, eigenmodes of the rod and
the modes that its bore needs under an oil film. At the firing the pin force is the same for a rigid rod and for both
elastic ones. The film depends on the shank:

* A narrow shank carries the firing load in the middle of a thin eye, which deflects on both sides of it. The pressure
  concentrates over the shank, and the film right after the firing is less than half as thick as in a rigid bore.
* A wide shank backs the whole loaded side: the bore deflects where the pressure is largest, and the peak is below that
  of the rigid bore.

A bush in a rigid housing can't show this difference. The wide shank is heavier, so that between firings its inertia
force is larger than that of the narrow one, whose mass the rigid rod has.

The run begins half a turn before the one that is shown, at the inner dead centre, so that the journal has left the
middle of its bore and the rod's first vibrations have decayed. It does not continue until the cycle of two turns
repeats, which takes two and a half times as long. Compared with the turn of the next firing, the orbit shown is off by
3 % of the clearance at its beginning and by 0.5 % from 60 degrees on; peak pressure and minimum film thickness by
0.1 %.

Run ``python examples/fe_connecting_rod.py``; the picture is written to ``results``.
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
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from exudyn.utilities import RigidBodyInertia
from matplotlib.figure import Figure
from scipy.sparse.linalg import spsolve

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled
from exudyn_ehd.solid.elements.element import HEX_NODES
from exudyn_ehd.solid.total_lagrange import TotalLagrange

CRANK, ROD = 0.043, 0.14
SPEED = 3000.0 * 2.0 * math.pi / 60.0
PISTON_MASS = 0.5
GAS_FORCE, GAS_WIDTH = 25e3, 0.35
# Crank angle of the largest gas force, rad.
FIRING = 0.4 * math.pi
BORE, LENGTH = 0.024, 0.022
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
# Largest distance of the pin from where it is a cycle later, over the clearance; from longer runs.
CYCLE_LATER = 0.03
# element counts: along the axis of the bores, along the shank; across it, of the 40 around the big eye
AXIAL, ALONG = 2, 7
SHANKS = {"narrow shank": 4, "wide shank": 10}
# decay of the rod's vibrations: damping is this time times stiffness, s
DAMPING = 2e-6


def rod_mesh(across: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return nodes (n, 3) in m, elements (m, 20) and the nodes of the small end's bore.

    The small end lies at the origin, the big end at x = -ROD.
    """
    big = ehd.HollowCylinder(
        inner_radius=BORE, thickness=0.008, length=LENGTH, axial=AXIAL, radial=2, circumferential=40
    ).mesh()
    small = ehd.HollowCylinder(
        inner_radius=0.011, thickness=0.006, length=LENGTH, axial=AXIAL, radial=1, circumferential=24
    ).mesh()

    def bridge(xi: np.ndarray, eta: np.ndarray, zeta: np.ndarray) -> np.ndarray:
        """Straight lines from the big eye's outer surface, xi = 0, to the small eye's, xi = 1; -1 < eta < 1 across."""
        at_big, at_small = eta * across * math.pi / 40, math.pi - eta * across * math.pi / 24
        first = np.stack([0.032 * np.cos(at_big) - ROD, 0.032 * np.sin(at_big), zeta], axis=-1)
        second = np.stack([0.017 * np.cos(at_small), 0.017 * np.sin(at_small), zeta], axis=-1)
        return first + xi[..., None] * (second - first)

    cell = np.stack(np.meshgrid(*map(np.arange, (ALONG, across, AXIAL)), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    xi, eta, zeta = np.moveaxis((cell + 0.5 * (HEX_NODES + 1.0)) / np.array([ALONG, across, AXIAL]), -1, 0)
    shank = bridge(xi, 2.0 * eta - 1.0, LENGTH * (zeta - 0.5))
    places = np.concatenate([(big.nodes - [ROD, 0.0, 0.0])[big.elements], small.nodes[small.elements], shank]).reshape(
        -1, 3
    )
    # parts share the nodes that coincide
    _, first, elements = np.unique(np.round(places / 1e-8), axis=0, return_index=True, return_inverse=True)
    nodes = places[first]
    held = np.flatnonzero(np.hypot(nodes[:, 0], nodes[:, 1]) < 0.0111)
    return nodes, elements.reshape(-1, 20), held


def rod_fem(across: int, tolerance: float) -> tuple[FEMinterface, ehd.BoreModesReport]:
    """Return the rod with its modes, and what the bore modes achieve."""
    nodes, elements, held = rod_mesh(across)
    fem = FEMinterface()
    fem.nodes = {"Position": nodes}
    fem.elements = [{"Name": "rod", "Hex20": elements}]
    solid = TotalLagrange(mesh=ehd.mesh_from_fem(fem, bore_radius=BORE, origin=(-ROD, 0, 0)), material=STEEL)
    fem.stiffnessMatrix = solid.tangent(np.zeros_like(nodes)).tocsr()
    fem.massMatrix = solid.mass.tocsr()
    fem.VolumeToSurfaceElements()
    fem.ComputeHurtyCraigBamptonModes([list(held)], 4)
    # the pin stays parallel to the bore
    report = ehd.add_bore_modes(
        fem,
        position=[-ROD, 0, 0],
        axis=[0, 0, 1],
        radius=BORE,
        length=LENGTH,
        fixed_nodes=held,
        tolerance=tolerance,
        tilted=False,
    )
    return fem, report


def rigid_inertia(fem: FEMinterface) -> RigidBodyInertia:
    """Return mass, centre and inertia of a mesh about its origin, from its mass matrix."""
    x, y, z = fem.nodes["Position"].T
    zero, one = np.zeros_like(x), np.ones_like(x)
    motions = [(one, zero, zero), (zero, one, zero), (zero, zero, one), (zero, -z, y), (z, zero, -x), (-y, x, zero)]
    R = np.stack([np.stack(m, axis=1).ravel() for m in motions], axis=1)
    M = R.T @ (fem.massMatrix @ R)
    mass = M[0, 0]
    return RigidBodyInertia(mass=mass, inertiaTensor=M[3:, 3:], com=[M[1, 5] / mass, M[2, 3] / mass, M[0, 4] / mass])


def big_end(*, quick: bool) -> ehd.JournalBearing:
    """Return the bearing with a rigid bore."""
    return ehd.JournalBearing(
        journal_radius=BORE,
        length=LENGTH,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=8e-3),
        film=ehd.FiniteLength(n_theta=64, n_z=8) if quick else ehd.FiniteLength(n_theta=96, n_z=10),
    )


def gas_force(angle: float) -> float:
    """Force on the piston towards the crank, N: a pulse 72 degrees after the outer dead centre of every second turn."""
    distance = math.remainder(angle - FIRING, 4.0 * math.pi)
    return GAS_FORCE * math.exp(-((distance / GAS_WIDTH) ** 2))


def crank_and_piston(start: float):
    """Crank and piston at full speed, guided and driven; the system and both bodies.

    ``start`` is the crank angle at which they begin, a dead centre: 0 is the outer one, -pi the inner one before it.
    """
    mbs = exu.SystemContainer().AddSystem()
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))

    def body(mass: float, inertia: float, x: float, spin: float):
        node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[x, 0, 0], initialVelocities=[0, 0, spin]))
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

    crank_node, crank = body(3.0, 5e-3, 0.0, SPEED)
    piston_node, piston = body(PISTON_MASS, 1e-4, CRANK * math.cos(start) + ROD, 0.0)
    for coordinate in (0, 1):
        prescribe(crank_node, coordinate)
    prescribe(crank_node, 2, SPEED)
    for coordinate in (1, 2):
        prescribe(piston_node, coordinate)
    pushed = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=piston_node))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=pushed,
            loadVector=[0, 0, 0],
            loadVectorUserFunction=lambda mbs, t, load: [-gas_force(start + SPEED * t), 0, 0],
        )
    )
    return mbs, crank, piston


def build(bearing: ehd.JournalBearing, fem: FEMinterface, *, flexible: bool, start: float):
    """The whole mechanism; returns the system and its lubricated joint."""
    mbs, crank, piston = crank_and_piston(start)
    pin = CRANK * math.cos(start)
    # the small end is the rod's floating frame and starts at rest in the piston
    place, spin = [pin + ROD, 0.0, 0.0], [0.0, 0.0, -SPEED * pin / ROD]
    if flexible:
        parts = ObjectFFRFreducedOrderInterface(fem, "NodeType.RotationRxyz").AddObjectFFRFreducedOrder(
            mbs, positionRef=place, initialAngularVelocity=spin, stiffnessProportionalDamping=DAMPING
        )
        rod, rod_node = parts["oFFRFreducedOrder"], parts["nRigidBody"]
        bearing = dataclasses.replace(bearing, bush=ehd.FEBore(fem=fem))
    else:
        rod = mbs.CreateRigidBody(
            inertia=rigid_inertia(fem),
            referencePosition=place,
            initialAngularVelocity=spin,
            nodeType=exu.NodeType.RotationRxyz,
        )
        rod_node = mbs.GetObject(rod)["nodeNumber"]
    pins = [
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=piston)),
        mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=rod_node)),
    ]
    mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=pins, constrainedAxes=[1, 1, 1, 1, 1, 0]))
    joint = ehd.CreateLubricatedJoint(
        mbs, name="big end", itemNumbers=[rod, crank], position=[pin, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint


def simulate(
    bearing: ehd.JournalBearing,
    fem: FEMinterface,
    *,
    flexible: bool,
    start: float,
    turns: float,
    steps_per_turn: int,
) -> dict:
    """Run the mechanism at full speed from the crank angle ``start``, a dead centre."""
    mbs, joint = build(bearing, fem, flexible=flexible, start=start)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * math.pi / SPEED
    settings.timeIntegration.numberOfSteps = steps = round(turns * steps_per_turn)
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.timeIntegration.newton.relativeTolerance = 1e-6
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    clock = time.process_time()
    ehd.SolveDynamic(mbs, settings)
    spent = time.process_time() - clock
    h = joint.history
    angle = np.degrees(start + SPEED * h.time)
    # without the start from the middle of the bore
    later = (angle >= 0.0) & (h.time > 0.1 * 2.0 * math.pi / SPEED)
    firing = int(np.argmax(np.where(later, h.peak_pressure, 0.0)))
    return {
        "angle_deg": angle,
        "history": h,
        "peak_MPa": float(h.peak_pressure[firing]) / 1e6,
        "minimum_film_thickness_um": float(h.minimum_gap[later].min()) * 1e6,
        "largest_force_kN": float(np.hypot(*h.force[later].T[:2]).max()) / 1e3,
        "mean_loss_W": float(h.power_loss[later].mean()),
        "milliseconds_per_step": 1e3 * spent / steps,
        "iterations_per_step": mbs.sys["dynamicSolver"].it.newtonStepsCount / steps,
    }


def draw_rod(axes, fem: FEMinterface, color: str) -> None:
    """Draw the mesh from the side, and deformed by a firing load: a parabola over 120 degrees on the shank's side."""
    nodes, elements = np.asarray(fem.nodes["Position"]), fem.elements[0]["Hex20"]
    shape = 300.0 * firing_shape(fem)[0]
    ring = [4, 12, 5, 13, 6, 14, 7, 15, 4]
    top = elements[nodes[elements[:, 4], 2] > 0.499 * LENGTH]
    for u, style in ((np.zeros_like(nodes), {"color": "0.75", "lw": 0.6}), (shape, {"color": color, "lw": 0.8})):
        x = 1e3 * (nodes + u)[top][:, ring]
        axes.plot(x[..., 0].T, x[..., 1].T, **style)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")


def firing_shape(fem: FEMinterface) -> tuple[np.ndarray, np.ndarray]:
    """Displacements (n, 3) in m of the whole mesh and of its modes under a pressure of 25 kN from the shank's side."""
    places = np.asarray(fem.nodes["Position"])
    mesh = ehd.mesh_from_fem(fem, bore_radius=BORE, origin=(-ROD, 0, 0))
    theta, z = (a.ravel() for a in np.meshgrid(np.linspace(-1.0, 1.0, 81), np.linspace(-0.5, 0.5, 21) * LENGTH))
    load = np.zeros_like(places)
    H = mesh.bore.radial_interpolation(theta, z)
    pressure = 1.0 - theta**2
    load[mesh.bore.nodes] = (H.T @ pressure).reshape(-1, 3)
    load *= GAS_FORCE / load[:, 0].sum()
    free = np.repeat(np.hypot(places[:, 0], places[:, 1]) > 0.0111, 3)
    K, f = fem.stiffnessMatrix, load.ravel()
    whole = np.zeros_like(f)
    whole[free] = spsolve(K[free][:, free].tocsc(), f[free])
    basis = fem.modeBasis["matrix"]
    modal = basis @ np.linalg.solve(basis.T @ (K @ basis), basis.T @ f)
    return whole.reshape(-1, 3), modal.reshape(-1, 3)


@styled(10.0)
def draw(cases: dict, rods: dict, path: Path) -> None:
    """Pressure, film and force of the three rods, and how the elastic ones deform."""
    figure = Figure(figsize=(11, 8), layout="constrained")
    axes = figure.subplot_mosaic("pg;pg;fn;fw")
    for name, case in cases.items():
        h, angle = case["history"], case["angle_deg"]
        axes["p"].plot(angle, h.peak_pressure / 1e6, label=name)
        axes["g"].plot(angle, 1e6 * h.minimum_gap, label=name)
        axes["f"].plot(angle, np.hypot(h.force[:, 0], h.force[:, 1]) / 1e3, label=name)
    for a, label in zip("pgf", ("peak pressure [MPa]", "minimum film thickness [µm]", "pin force [kN]")):
        axes[a].set(
            xlabel="crank angle after the outer dead centre [°]",
            ylabel=label,
            xlim=(0, angle[-1]),
            xticks=np.arange(0.0, angle[-1] + 1.0, 60.0),
        )
        axes[a].set_ylim(0.0, 1.08 * max(line.get_ydata()[line.get_xdata() >= 0.0].max() for line in axes[a].lines))
        axes[a].axvline(math.degrees(FIRING), color="0.7", lw=0.8, ls=":", zorder=0)
    axes["f"].annotate("firing", (math.degrees(FIRING), 0.0), xytext=(3, 4), textcoords="offset points", color="0.4")
    axes["f"].set_title("rigid rod's force lies under the narrow shank's")
    axes["p"].legend()
    figure.suptitle(f"turn of a firing; a cycle later all pins are within {CYCLE_LATER:g} c of these places")
    for a, (name, (fem, _)) in zip("nw", rods.items()):
        draw_rod(axes[a], fem, next(line.get_color() for line in axes["p"].lines if line.get_label() == name))
        axes[a].set_title(
            f"{name} under 25 kN at the bore, small end held:\ndisplacement 300 times, in grey without load"
        )
    figure.savefig(path, dpi=110)


def main(*, quick: bool = False, results: str | Path | None = None) -> dict:
    """Run all rods over the turn of a firing; with ``results`` write the picture there."""
    # at 360 steps per turn some are halved, and forces ring behind them
    start, turns, steps = (0.0, 0.27, 240) if quick else (-math.pi, 1.5, 720)
    rods = {name: rod_fem(across, tolerance=0.03 if quick else 0.02) for name, across in SHANKS.items()}
    bearing = big_end(quick=quick)

    def run(name: str, *, flexible: bool) -> dict:
        return simulate(bearing, rods[name][0], flexible=flexible, start=start, turns=turns, steps_per_turn=steps)

    cases = {"rigid rod": run("narrow shank", flexible=False)} | {name: run(name, flexible=True) for name in rods}
    outcome: dict = cases | {"modes": {name: report for name, (_, report) in rods.items()}}
    if results is not None:
        folder = Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        draw(cases, rods, folder / "fe_connecting_rod.png")
        outcome["picture"] = folder / "fe_connecting_rod.png"
    return outcome


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    print(outcome.pop("modes"))
    outcome.pop("picture", None)
    for name, case in outcome.items():
        print(name, {k: round(v, 3) for k, v in case.items() if isinstance(v, float)})
