"""The gudgeon pin of an engine, tilted and bent.

A four-stroke cycle at 3000 rpm. The piston is the journal and holds a hollow pin in its two bosses; the rod's small end
is the housing, with a steel eye of 6 mm wall around the pin. The rod's bores are out of parallel by 1.5e-4 rad, so that
the pin is tilted in its film; the gas force bends it between its bosses and flattens it. The picture shows minimum film
thickness and peak pressure over the cycle for a rigid pin, an elastic pin, and an elastic pin in an elastic eye.

Run ``python examples/elastic_gudgeon_pin.py``; the picture is written to ``results``.
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
from exudyn.utilities import RigidBodyInertia, RotationMatrixY
from matplotlib.figure import Figure

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

CRANK, ROD = 0.043, 0.14
SPEED = 3000.0 * 2.0 * math.pi / 60.0
GAS_FORCE, GAS_WIDTH = 20e3, 0.35
SKEW = 1.5e-4
PISTON = RigidBodyInertia(mass=0.45, inertiaTensor=np.diag([4e-4, 3e-4, 3e-4]))
ROD_INERTIA = RigidBodyInertia(mass=0.55, inertiaTensor=np.diag([2e-4, 2e-3, 2e-3]))
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
RADIUS, LENGTH, CLEARANCE = 0.011, 0.022, 12e-6
PIN = ehd.ElasticJournal(
    material=STEEL,
    span=(-0.03, 0.03),
    held=ehd.HeldBands(bands=((-0.03, -0.012), (0.012, 0.03))),
    inner_radius=0.005,
)
EYE = ehd.ModalBush(
    mesh=ehd.HollowCylinder(
        inner_radius=RADIUS + CLEARANCE, thickness=0.006, length=LENGTH, axial=4, radial=2, circumferential=32
    ),
    material=STEEL,
    tolerance=0.04,
)
CASES = {"rigid": (None, None), "elastic pin": (PIN, None), "elastic pin and eye": (PIN, EYE)}


def small_end(*, quick: bool) -> ehd.JournalBearing:
    """Return the bearing with rigid surfaces."""
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=LENGTH,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.012, pressure_law=ehd.RoelandsPressure(coefficient=1.5e-8)),
        asperity=ehd.GreenwoodTripp(composite_roughness=0.3e-6, composite_modulus=1.15e11),
        film=ehd.FiniteLength(n_theta=64 if quick else 96, n_z=12, stretch=0.9),
    )


def gas_force(angle: float) -> float:
    """Force on the piston towards the crank, N; one pulse just after the outer dead centre of every second turn."""
    distance = math.remainder(angle - 2.0 * math.pi - 0.35, 4.0 * math.pi)
    return GAS_FORCE * math.exp(-((distance / GAS_WIDTH) ** 2))


def build(bearing: ehd.JournalBearing):
    """The mechanism at its outer dead centre at full speed; returns the system and its lubricated joint."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0.0] * 3, initialVelocities=[0.0, 0.0, SPEED]))
    crank = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=3.0, inertia=5e-3))
    for coordinate, spin in enumerate((0.0, 0.0, SPEED)):
        mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[origin, mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))],
                offsetUserFunction=lambda mbs, t, item, offset, spin=spin: spin * t,
                offsetUserFunction_t=lambda mbs, t, item, offset, spin=spin: spin,
            )
        )
    # the rod stands askew on the crank's pin, by its bores that are out of parallel
    turn = RotationMatrixY(SKEW)
    rod = mbs.CreateRigidBody(
        inertia=ROD_INERTIA,
        referencePosition=[CRANK + ROD / 2, 0, 0],
        initialDisplacement=(turn - np.eye(3)) @ [ROD / 2, 0, 0],
        initialRotationMatrix=turn,
        initialVelocity=[0, SPEED * CRANK / 2, 0],
        initialAngularVelocity=[0, 0, -SPEED * CRANK / ROD],
    )
    eye = exu.HT(rotation=turn.T, translation=[-ROD / 2, 0, 0])
    pins = [
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=crank, localPosition=[CRANK, 0, 0])),
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=rod, localHT=eye)),
    ]
    mbs.AddObject(eii.ObjectJointRevoluteZ(markerNumbers=pins))
    piston = mbs.CreateRigidBody(inertia=PISTON, referencePosition=[CRANK + ROD, 0, 0])
    mbs.CreateGenericJoint(
        itemNumbers=[ground, piston], position=[CRANK + ROD, 0, 0], constrainedAxes=[0, 1, 1, 1, 1, 1]
    )
    pushed = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=piston))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=pushed,
            loadVector=[0, 0, 0],
            loadVectorUserFunction=lambda mbs, t, load: [-gas_force(SPEED * t), 0, 0],
        )
    )
    joint = ehd.CreateLubricatedJoint(mbs, "gudgeon pin", [rod, piston], [CRANK + ROD, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    return mbs, joint


def simulate(bearing: ehd.JournalBearing, *, turns: float, steps_per_turn: int) -> dict:
    """Run from the outer dead centre at full speed; the numbers are those of the last turns, with the firing."""
    mbs, joint = build(bearing)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * math.pi / SPEED
    settings.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.timeIntegration.newton.relativeTolerance = 1e-6
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    joint.record_films(period=settings.timeIntegration.endTime / round(turns * steps_per_turn))
    start = time.perf_counter()
    ehd.SolveDynamic(mbs, settings)
    # from the first outer dead centre with gas on: the journal starts in the middle of its film
    history = joint.history.between(math.pi / SPEED)
    thinnest = history.time[int(np.argmin(history.minimum_gap))]
    return {
        "angle_deg": np.degrees(SPEED * history.time),
        "history": history,
        "film": min(joint.films, key=lambda film: abs(film.time - thinnest)),
        "minimum_film_thickness_um": float(history.minimum_gap.min()) * 1e6,
        "peak_MPa": float(history.peak_pressure.max()) / 1e6,
        "largest_deflection_um": float(history.bore_displacement.max()) * 1e6,
        "milliseconds_per_step": 1e3 * (time.perf_counter() - start) / (joint.history.time.size - 1),
    }


@styled(10.0)
def draw(cases: dict, path: Path) -> None:
    """Film thickness and pressure over the cycle; the thinnest film along the pin and around it."""
    figure = Figure(figsize=(11, 7), layout="constrained")
    axes = figure.subplots(2, 2)
    for name, style in zip(CASES, ("-", "--", ":"), strict=True):
        case, h = cases[name], cases[name]["history"]
        film, angle = case["film"], case["angle_deg"]
        i, j = np.unravel_index(int(np.argmin(film.gap)), film.gap.shape)
        around = np.degrees(np.unwrap(film.theta))
        axes[0, 0].plot(angle, 1e6 * h.minimum_gap, style, label=name)
        axes[0, 1].plot(angle, 1e-6 * h.peak_pressure, style)
        axes[1, 0].plot(1e3 * film.z, 1e6 * film.gap[i], style)
        axes[1, 1].plot(around, 1e6 * film.gap[:, j], style)
    for a, label in zip(axes[0], ("minimum film thickness [µm]", "peak pressure [MPa]"), strict=True):
        a.set(xlabel="crank angle [°]", ylabel=label, xlim=(angle[0], angle[-1]))
        a.set_xticks(np.arange(180.0, angle[-1] + 1.0, 90.0))
    axes[1, 0].set(xlabel="along the pin [mm]", ylabel="film thickness [µm]", title="thinnest film along the pin")
    axes[1, 1].set(xlabel="angle in the rod [°]", ylabel="film thickness [µm]", title="thinnest film around the pin")
    axes[1, 1].set_xticks(np.arange(0.0, 361.0, 90.0))
    for a in axes.flat:
        a.set_ylim(0.0)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.savefig(path, dpi=100)


def main(*, quick: bool = False, results: str | Path | None = None) -> dict:
    """Run the three cases; with ``results`` write the picture there."""
    turns, steps = (1.4, 360) if quick else (2.5, 400)
    bearing = small_end(quick=quick)
    cases: dict = {
        name: simulate(dataclasses.replace(bearing, journal=pin, bush=eye), turns=turns, steps_per_turn=steps)
        for name, (pin, eye) in CASES.items()
    }
    if results is not None:
        folder = Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        draw(cases, folder / "elastic_gudgeon_pin.png")
        cases["picture"] = folder / "elastic_gudgeon_pin.png"
    return cases


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results", default="results")
    arguments = parser.parse_args()
    outcome = main(quick=arguments.quick, results=arguments.results)
    outcome.pop("picture")
    for name, case in outcome.items():
        print(name, {k: round(v, 3) for k, v in case.items() if isinstance(v, float)})
