"""A shaft that rests on its bush, is started, and coasts to a stop: mixed friction, lift-off and wear.

Journal bearings wear when they start and stop. A steel shaft of 5 kg (50 mm diameter, bush of bronze 25 mm long, 25 um
radial clearance, oil of 20 mPa s) is pressed down by 2 kN. At rest its asperities carry everything. A motor with a
speed governor brings it to 60 rad/s in 0.2 s: the asperities lift off at 34 rad/s, while in steady running 5 rad/s
are enough. Then the motor is cut, and the film's drag brakes the shaft until it stops after 1.2 s, still on its film.

The asperity contact is Greenwood and Tripp's with boundary friction of 0.1, the film's average flow Patir and Cheng's
(composite roughness 0.5 um, both surfaces isotropic), the wear Archard's with 1e-16 m2/N, a common value for boundary
lubrication, accelerated so that one start counts as a thousand.

Shown side by side: the Stribeck curve of steady running (``ehd.stribeck``) and the friction that the shaft meets
on its way up and down, which leaves the curve where the film is squeezed or drawn in.

Run ``python examples/start_stop.py``; the picture is written to ``results/start_stop``.
"""

from __future__ import annotations

import argparse
import dataclasses
import pathlib

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

MASS, INERTIA = 5.0, 0.0015625  # a solid cylinder of 50 mm
LOAD = 2000.0
TOP_SPEED, RUN_UP, MOTOR_TIME, GOVERNOR = 60.0, 0.2, 0.25, 0.5
RADIUS = 0.025
WEAR_RATE, STARTS = 1e-16, 1e3


@dataclasses.dataclass(frozen=True, kw_only=True)
class Run:
    """One start and stop: the joint's ``history``, the ``film`` at its end, and Newton iterations per step."""

    history: ehd.JointHistory
    film: ehd.FilmFields
    iterations_per_step: float


def make_bearing(*, quick: bool) -> ehd.JournalBearing:
    """The bearing."""
    modulus = ehd.composite_modulus((2.1e11, 1.0e11), (0.3, 0.33))
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=96, n_z=8) if quick else ehd.FiniteLength(n_theta=192, n_z=10),
        roughness=ehd.PatirCheng(composite_roughness=0.5e-6),
        asperity=ehd.GreenwoodTripp(
            composite_roughness=0.5e-6, composite_modulus=modulus, friction_coefficient=0.1, transition_speed=1e-3
        ),
        wear=ehd.ArchardWear(wear_rate=WEAR_RATE, acceleration=STARTS),
    )


def simulate(bearing: ehd.JournalBearing, *, end: float, step: float) -> Run:
    """Start, run up, coast."""
    # at rest: the limit of slow turning, in which asperities carry the load, without friction
    smooth = dataclasses.replace(bearing.asperity, friction_coefficient=0.0)
    resting = dataclasses.replace(bearing, wear=None, asperity=smooth)
    rest = ehd.stribeck(resting, load=LOAD, speeds=[1e-3, 1.0, 100.0]).position[0]
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialCoordinates=[*rest, 0]))
    shaft = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=INERTIA))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=shaft)), loadVector=[0, -LOAD, 0]
        )
    )

    def motor(mbs, t, load):
        if t >= MOTOR_TIME:
            return [0.0, 0.0, 0.0]
        speed = mbs.GetNodeOutput(node, exu.OutputVariableType.AngularVelocity)[2]
        return [0.0, 0.0, GOVERNOR * (TOP_SPEED * min(1.0, t / RUN_UP) - speed)]

    mbs.AddLoad(
        eii.LoadTorqueVector(
            markerNumber=mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=shaft)),
            loadVector=[0, 0, 0],
            loadVectorUserFunction=motor,
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="shaft bearing", itemNumbers=[ground, shaft], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = end
    settings.timeIntegration.numberOfSteps = round(end / step)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    history = joint.history
    iterations = mbs.sys["dynamicSolver"].it.newtonStepsCount / (history.time.size - 1)
    return Run(history=history, film=joint.film(), iterations_per_step=iterations)


def steady_curve(bearing: ehd.JournalBearing, *, points: int) -> ehd.StribeckResult:
    """Stribeck curve of steady running."""
    return ehd.stribeck(dataclasses.replace(bearing, wear=None), load=LOAD, speeds=np.geomspace(0.3, TOP_SPEED, points))


def friction_coefficient(history: ehd.JointHistory) -> np.ndarray:
    """Friction torque over R times the load, (n,)."""
    return np.abs(history.friction_torque) / (RADIUS * LOAD)


def _integral(values: np.ndarray, x: np.ndarray) -> float:
    return float(np.sum(0.5 * np.diff(x) * (values[1:] + values[:-1])))


def figures(run: Run, curve: ehd.StribeckResult) -> dict[str, float]:
    """Numbers of the table."""
    h = run.history
    spin = h.motion[:, 8]
    up = h.time <= MOTOR_TIME
    down = (h.time > MOTOR_TIME) & (spin > 0.05)
    share = h.contact_load / LOAD
    lifted = h.time[up][np.argmax((share[up] < 0.01) & (spin[up] > 1.0))]
    first, last = np.flatnonzero(down)[[0, -1]]
    coast = slice(first, last + 1)
    stopped = h.time[last]
    return {
        "contact_share_at_rest": float(share[0]),
        "friction_coefficient_at_start": float(friction_coefficient(h)[up].max()),
        "lift_off_ms": 1e3 * float(lifted),
        "lift_off_speed_up": float(np.interp(lifted, h.time, spin)),
        "touch_down_speed": float(spin[coast][np.argmax(share[coast] > 0.01)]),
        "touch_down_speed_of_the_steady_curve": float(
            np.interp(0.01, curve.contact_load_share[::-1], curve.speeds[::-1])
        ),
        "lowest_friction_coefficient": float(curve.lowest_friction[1]),
        "at_speed": float(curve.lowest_friction[0]),
        "stopped_after_s": float(stopped),
        "contact_share_when_stopped": float(share[last]),
        "kinetic_energy_lost_coasting_J": 0.5 * INERTIA * float(spin[first] ** 2 - spin[last] ** 2),
        "friction_work_coasting_J": _integral(np.abs(h.friction_torque * spin)[coast], h.time[coast]),
        "deepest_wear_nm": 1e9 * float(h.wear_depth[-1]),
        "worn_volume_mm3": 1e9 * float(h.worn_volume[-1]),
        "worn_volume_by_archard_mm3": 1e9
        * WEAR_RATE
        * STARTS
        * _integral(h.contact_load * RADIUS * np.abs(spin), h.time),
        "iterations_per_step": run.iterations_per_step,
    }


@styled(10.0)
def draw(run: Run, curve: ehd.StribeckResult, path: pathlib.Path) -> None:
    """Speed and contact, films, Stribeck curve and wear."""
    h = run.history
    spin = h.motion[:, 8]
    fig, axes = plt.subplots(2, 2, figsize=(11.5, 8), layout="constrained")
    speed, contact = axes[0, 0], axes[0, 0].twinx()
    (first,) = speed.plot(h.time, spin, color="tab:blue", label="speed")
    (second,) = contact.plot(h.time, 100.0 * h.contact_load / LOAD, color="tab:red", label="load carried by asperities")
    speed.set(xlabel="time [s]", ylabel="speed [rad/s]", title="start, coasting, rest", ylim=(0, 75))
    contact.set(ylabel="share of the load [%]", ylim=(0, 125))
    speed.legend(handles=[first, second], frameon=False, loc="upper center", ncols=2)
    axes[0, 1].semilogy(h.time, 1e6 * h.minimum_gap, color="black")
    axes[0, 1].axhline(2.0, color="grey", ls="--", lw=0.9, label="4 x composite roughness: asperities meet below")
    axes[0, 1].set(
        xlabel="time [s]",
        ylabel="minimum film thickness [µm]",
        title="film between the surfaces' mean lines",
        ylim=(0.2, 30),
    )
    axes[0, 1].legend(frameon=False, loc="upper right")
    friction = friction_coefficient(h)
    up, down = (h.time <= MOTOR_TIME) & (spin > 0.1), (h.time > MOTOR_TIME) & (spin > 0.1)
    axes[1, 0].loglog(curve.speeds, curve.friction_coefficient, color="black", lw=2, label="steady")
    axes[1, 0].loglog(spin[up], friction[up], "--", color="tab:red", label="starting")
    axes[1, 0].loglog(spin[down], friction[down], "--", color="tab:blue", label="coasting to a stop")
    axes[1, 0].set(
        xlabel="speed [rad/s]",
        ylabel="friction coefficient [-]",
        title="friction: steady (Stribeck curve), starting, coasting",
        xlim=(0.1, 100),
    )
    axes[1, 0].legend(frameon=False)
    film = run.film
    angle = np.degrees((film.theta + 1.5 * np.pi) % (2 * np.pi) - np.pi)  # 0 in the direction of the load
    where = np.abs(angle) < 40.0
    rows = np.argsort(angle[where])
    depth = 1e9 * film.wear_depth[where][rows]
    image = axes[1, 1].contourf(angle[where][rows], 1e3 * film.z, depth.T, levels=12, cmap="viridis")
    fig.colorbar(image, ax=axes[1, 1], label="wear depth [nm]")
    axes[1, 1].set(
        xlabel="angle from the load's direction [°]",
        ylabel="z [mm]",
        title=f"wear of the bore after {STARTS:g} starts",
    )
    for ax in (axes[0, 0], axes[0, 1], axes[1, 0]):
        ax.grid(alpha=0.3)
    fig.savefig(path, dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/start_stop") -> dict[str, float]:
    """Start and stop the shaft; returns the figures.

    Parameters
    ----------
    quick : bool
        Coarser grid, steps of 1 ms, and an end shortly after the stop.
    output : path or None
        Folder for the picture; None writes none.
    """
    bearing = make_bearing(quick=quick)
    print("Stribeck curve of steady running ...", flush=True)
    curve = steady_curve(bearing, points=12 if quick else 40)
    print("start, coasting, stop ...", flush=True)
    run = simulate(bearing, end=1.6 if quick else 3.0, step=1e-3 if quick else 5e-4)
    rows = figures(run, curve)
    for key, value in rows.items():
        print(f"  {key:40s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(run, curve, folder / "start_stop.png")
        print(f"picture: {folder / 'start_stop.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarser and shorter")
    main(quick=parser.parse_args().quick)
