"""A spatial slider-crank whose rod has oil-filled ball joints at both ends, next to Exudyn's ideal ones.

The crank (radius 40 mm, prescribed 955 rpm about z) drives a slider of 1.5 kg along x, 60 mm below the crank's plane,
by a rod of 160 mm. Balls of 20 mm run in sockets with a radial clearance of 25 um and oil of 0.1 Pa s. The sockets
belong to the rod: belts about the balls' equators, open where the studs come out. The numbers are our own.

The ball on the crank turns in its socket with the whole speed of the crank, so that a wedge film carries it. The
slider's ball only swings: at every reversal of the load it is squeezed from one side of the socket to the other. The
slider deviates from the path of the ideal mechanism by the displacements of the balls in both sockets; the forces are
those of the ideal joints.

Run ``python examples/ball_joint_slider_crank.py``; the picture is written to ``results/ball_joint_slider_crank``.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import pathlib

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np
from exudyn.rigidBodyUtilities import InertiaCuboid, InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

RADIUS, ROD, DROP = 0.04, 0.16, 0.06
SPEED = 100.0
SLIDER = InertiaCuboid(density=1.5 / 0.05**3, sideLengths=[0.05] * 3)
NAMES = ("crank", "slider")
BALL = ehd.SphericalBearing(
    ball_radius=0.01,
    radial_clearance=25e-6,
    lubricant=ehd.Lubricant(viscosity=0.1),
    socket_angles=(0.7, math.pi - 0.7),
    contact=ehd.RegularisedWall(onset=1e-6),
)


class Mechanism:
    """The mechanism at its outer dead centre, in motion.

    Parameters
    ----------
    bearing : SphericalBearing or None
        Of both ends of the rod; None for ideal joints.
    """

    def __init__(self, bearing: ehd.SphericalBearing | None) -> None:
        self.container = exu.SystemContainer()
        self.mbs = mbs = self.container.AddSystem()
        pin = np.array([RADIUS, 0.0, 0.0])
        end = pin + [math.sqrt(ROD**2 - DROP**2), 0.0, -DROP]
        x, y, speed = (end - pin) / ROD, np.array([0.0, 1.0, 0.0]), np.array([0.0, RADIUS * SPEED, 0.0])
        ground = mbs.CreateGround()
        crank = mbs.CreateRigidBody(
            inertia=InertiaCylinder(7800, 0.02, 0.05, 2),
            initialAngularVelocity=[0, 0, SPEED],
            nodeType=exu.NodeType.RotationRxyz,
        )
        rod = mbs.CreateRigidBody(
            referencePosition=0.5 * (pin + end),
            referenceRotationMatrix=np.column_stack([x, y, np.cross(x, y)]),
            inertia=InertiaCylinder(7800, ROD, 0.008, 0),
            initialVelocity=0.5 * speed,
            initialAngularVelocity=np.cross(x, -speed) / ROD,
        )
        slider = mbs.CreateRigidBody(referencePosition=end, inertia=SLIDER)
        mbs.CreateRevoluteJoint(itemNumbers=[ground, crank], position=[0, 0, 0], axis=[0, 0, 1])
        mbs.CreatePrismaticJoint(itemNumbers=[ground, slider], position=end, axis=[1, 0, 0])
        self._drive(crank)
        self.joints, self.forces = [], []
        for name, body, position in zip(NAMES, (crank, slider), (pin, end)):
            where = {"itemNumbers": [rod, body], "position": position}
            output = exu.OutputVariableType.Force
            if bearing is None:
                joint = mbs.CreateSphericalJoint(**where)
                sensor = eii.SensorObject(objectNumber=joint, outputVariableType=output, storeInternal=True)
                self.forces.append(mbs.AddSensor(sensor))
            else:
                joint = ehd.CreateLubricatedSphericalJoint(mbs, name, **where, bearing=bearing, axis=[0, 0, 1])
                self.forces.append(joint.AddSensor(output))
                self.joints.append(joint)
        self.place = mbs.AddSensor(
            eii.SensorBody(bodyNumber=slider, outputVariableType=exu.OutputVariableType.Position, storeInternal=True)
        )
        mbs.Assemble()

    def _drive(self, crank: exu.ObjectIndex) -> None:
        """Prescribe the angle of the crank."""
        mbs, fixed = self.mbs, self.mbs.AddNode(eii.NodePointGround())
        places = ((fixed, 0), (mbs.GetObject(crank)["nodeNumber"], 5))
        markers = [mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=n, coordinate=c)) for n, c in places]
        mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=markers,
                offset=1.0,
                offsetUserFunction=lambda mbs, t, item, offset: SPEED * t,
                offsetUserFunction_t=lambda mbs, t, item, offset: SPEED,
            )
        )

    def run(self, turns: float, steps_per_turn: int) -> dict[str, np.ndarray]:
        """Crank angle in turns, slider's place (n,) in m and size of the forces at crank and slider (n,) in N."""
        end = turns * 2.0 * math.pi / SPEED
        settings = ehd.ConfigureSolver(exu.SimulationSettings())
        settings.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
        settings.timeIntegration.endTime = end
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = end / settings.timeIntegration.numberOfSteps
        ehd.SolveDynamic(self.mbs, settings)
        place = self.mbs.GetSensorStoredData(self.place)
        forces = [np.linalg.norm(self.mbs.GetSensorStoredData(s)[:, 1:], axis=1) for s in self.forces]
        return {"turn": place[:, 0] * SPEED / (2.0 * math.pi), "place": place[:, 1], **dict(zip(NAMES, forces))}


def film_at_peak(joint: ehd.LubricatedSphericalJoint) -> ehd.SphericalResult:
    """The film of the step with the highest pressure."""
    h = joint.history
    k = int(h.peak_pressure.argmax())
    return ehd.steady_spherical(
        joint.bearing, place=h.place[k], velocity=h.velocity[k], angular_velocity=h.angular_velocity[k]
    )


def draw(ideal: dict, oil: dict, joints: list[ehd.LubricatedSphericalJoint], path: pathlib.Path) -> None:
    """Deviation of the slider, forces, films, and the slider's socket at its highest pressure."""
    with styled():
        fig = plt.figure(figsize=(9.0, 6.4), layout="constrained")
        axes = [fig.add_subplot(2, 2, k) for k in (1, 2, 3)]
        axes[0].plot(oil["turn"], 1e6 * (oil["place"] - ideal["place"]))
        axes[0].set(ylabel="slider off the ideal path [µm]")
        for name, joint, colour in zip(NAMES, joints, ("C0", "C1")):
            axes[1].plot(oil["turn"], oil[name], color=colour, label=f"{name}, oil")
            axes[1].plot(ideal["turn"], ideal[name], color="k", linestyle=":", label=f"{name}, ideal", linewidth=0.8)
            axes[2].plot(joint.history.time * SPEED / (2.0 * math.pi), 1e6 * joint.history.minimum_gap, label=name)
        # the films start centred, and ring until they carry
        axes[1].set(ylabel="joint force [N]", ylim=(0, 1.2 * ideal["crank"].max()))
        axes[2].set(ylabel="minimum film thickness [µm]", ylim=(0, None))
        for ax in axes:
            ax.set(xlabel="crank turns", xlim=(0, oil["turn"][-1]))
            ax.grid(alpha=0.3)
        for ax in axes[1:]:
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
        film_at_peak(joints[1]).plot_pressure(title="slider's socket", ax=fig.add_subplot(2, 2, 4, projection="polar"))
        fig.savefig(path, dpi=110)
        plt.close(fig)


def main(
    *, quick: bool = False, output: str | pathlib.Path | None = "results/ball_joint_slider_crank"
) -> dict[str, float]:
    """Compare ball joints on oil with ideal ones; returns the numbers.

    Parameters
    ----------
    quick : bool
        One turn with coarser steps and grid.
    output : path or None
        Folder for the picture; None writes none.
    """
    turns, steps = (1.0, 180) if quick else (2.0, 720)
    bearing = dataclasses.replace(BALL, n_phi=32, n_chi=12) if quick else BALL
    print(f"spatial slider-crank, {turns:g} turns at {SPEED * 30.0 / math.pi:.0f} rpm, {steps} steps per turn")
    ideal = Mechanism(None).run(turns, steps)
    mechanism = Mechanism(bearing)
    oil = mechanism.run(turns, steps)
    histories = {joint.name: joint.history for joint in mechanism.joints}
    settled = oil["turn"] > 0.25
    rows = {
        "slider_deviation_um": 1e6 * float(np.abs(oil["place"] - ideal["place"]).max()),
        "largest_force_ideal_N": float(ideal["slider"][settled].max()),
        "largest_force_oil_N": float(oil["slider"][settled].max()),
    }
    for name, h in histories.items():
        rows |= {
            f"{name}_eccentricity_ratio": float(h.eccentricity_ratio.max()),
            f"{name}_minimum_film_thickness_um": 1e6 * float(h.minimum_gap.min()),
            f"{name}_peak_pressure_MPa": 1e-6 * float(h.peak_pressure.max()),
            f"{name}_loss_W": float(np.trapezoid(h.power_loss, h.time) / h.time[-1]),
        }
    for key, value in rows.items():
        print(f"{key:35s}{value:12.4g}")
    for joint in mechanism.joints:
        print(f"{joint.name}: {joint.audit()!r}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(ideal, oil, mechanism.joints, folder / "ball_joint_slider_crank.png")
        print(f"picture: {folder / 'ball_joint_slider_crank.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one turn, coarser steps and grid")
    main(quick=parser.parse_args().quick)
