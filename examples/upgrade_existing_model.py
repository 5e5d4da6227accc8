"""An existing model before and after: the revolute joints of Exudyn's rigid-body tutorial become oil-filled.

Two links hang on each other by revolute joints and fall under gravity, as in the tutorial that most users of Exudyn
begin with (J. Gerstmayr, Exudyn's example ``rigidBodyTutorial3``: links of 1 m, 0.1 m wide, 5000 kg/m3, first axis z,
second axis x, a force of 0.5 N and a torque of 0.1 Nm on the tip; pins of 20 mm radius and 140 mm length). ``before``
builds it with ideal joints, ``after`` with bearings: the program prints the difference of the two functions, which is
all that a model needs. The bearings have a radial clearance of 40 um and a gear oil of 0.4 Pa s.

What the bearings change: the pins tilt and move within their clearance, and the film brakes the fall. The mechanism's
loss of energy equals the integral of the films' power loss.

Run ``python examples/upgrade_existing_model.py``; the picture is written to ``results/upgrade_existing_model``.
"""

from __future__ import annotations

import argparse
import difflib
import inspect
import pathlib
import time

import exudyn as exu
import matplotlib.pyplot as plt
import numpy as np
from exudyn.utilities import InertiaCuboid, SensorBody

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

GRAVITY = [0.0, -9.81, 0.0]
LENGTH, WIDTH = 1.0, 0.1
STEP = 1e-3


def links(mbs):
    """Ground and the two bodies of the tutorial."""
    ground = mbs.CreateGround(referencePosition=[0, 0, 0])
    inertia = InertiaCuboid(density=5000, sideLengths=[LENGTH, WIDTH, WIDTH]).Translated([-0.25 * LENGTH, 0, 0])
    upper = mbs.CreateRigidBody(inertia=inertia, referencePosition=[0.5 * LENGTH, 0, 0], gravity=GRAVITY)
    lower = mbs.CreateRigidBody(
        inertia=InertiaCuboid(density=5000, sideLengths=[WIDTH, WIDTH, LENGTH]),
        referencePosition=[LENGTH, 0, 0.5 * LENGTH],
        gravity=GRAVITY,
    )
    mbs.CreateForce(itemNumber=lower, loadVector=[0, 0.5, 0], localPosition=[0, 0, 0.5 * LENGTH], bodyFixed=False)
    mbs.CreateTorque(itemNumber=lower, loadVector=[0.1, 0, 0], localPosition=[0, 0, 0], bodyFixed=False)
    return ground, upper, lower


def before(mbs, ground, upper, lower, simulationSettings):
    mbs.CreateRevoluteJoint(itemNumbers=[ground, upper], position=[0, 0, 0], axis=[0, 0, 1])
    mbs.CreateRevoluteJoint(itemNumbers=[upper, lower], position=[LENGTH, 0, 0], axis=[1, 0, 0])
    mbs.Assemble()
    mbs.SolveDynamic(simulationSettings)


def after(mbs, ground, upper, lower, simulationSettings):
    oil, wall = ehd.Lubricant(viscosity=0.4), ehd.RegularisedWall(onset=2e-6)
    size = {"journal_radius": 0.02, "length": 0.14, "radial_clearance": 40e-6}
    fine = ehd.FiniteLength(n_z=16, stretch=0.95)  # the pins tilt: fine rows near the ends
    film = {"bearing": ehd.JournalBearing(**size, lubricant=oil, contact=wall, film=fine), "axial": ehd.Held()}
    j1 = ehd.CreateLubricatedJoint(mbs, itemNumbers=[ground, upper], position=[0, 0, 0], axis=[0, 0, 1], **film)
    j2 = ehd.CreateLubricatedJoint(mbs, itemNumbers=[upper, lower], position=[LENGTH, 0, 0], axis=[1, 0, 0], **film)
    mbs.Assemble()
    ehd.ConfigureSolver(simulationSettings)
    ehd.SolveDynamic(mbs, simulationSettings)
    return j1, j2


def simulate(variant, *, end: float) -> dict:
    """Build and run one variant; arrays over the recorded instants."""
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    ground, upper, lower = links(mbs)

    def sensor(body, variable, point=(0.0, 0.0, 0.0)):
        kind = getattr(exu.OutputVariableType, variable)
        return mbs.AddSensor(
            SensorBody(bodyNumber=body, localPosition=point, storeInternal=True, outputVariableType=kind)
        )

    sensors = {
        "tip": sensor(lower, "Position", (0.0, 0.0, 0.5 * LENGTH)),
        "spin": sensor(lower, "AngularVelocity"),
        "upper_centre": sensor(upper, "Position", (-0.25 * LENGTH, 0.0, 0.0)),
        "lower_centre": sensor(lower, "Position"),
        "upper_energy": sensor(upper, "KineticEnergy"),
        "lower_energy": sensor(lower, "KineticEnergy"),
    }
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = end
    settings.timeIntegration.numberOfSteps = round(end / STEP)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.timeIntegration.verboseMode = 0
    settings.solution.sensors.writePeriod = STEP
    settings.solution.file.write = False
    clock = time.perf_counter()
    joints = variant(mbs, ground, upper, lower, settings)
    seconds = time.perf_counter() - clock
    data = {name: mbs.GetSensorStoredData(number) for name, number in sensors.items()}
    mass = 5000.0 * LENGTH * WIDTH**2
    energy = data["upper_energy"][:, 1] + data["lower_energy"][:, 1]
    energy = energy + 9.81 * mass * (data["upper_centre"][:, 2] + data["lower_centre"][:, 2])
    # the small loads of the tutorial do work, too
    t = data["tip"][:, 0]
    turned = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(t) * (data["spin"][1:, 1] + data["spin"][:-1, 1]))])
    energy = energy - 0.5 * data["tip"][:, 2] - 0.1 * turned
    return {
        "time": t,
        "tip": data["tip"][:, 1:],
        "energy": energy,
        "histories": [joint.history for joint in joints or ()],
        "ms_per_step": 1e3 * seconds / round(end / STEP),
    }


def difference() -> str:
    """Unified diff of the model's source."""
    old, new = (inspect.getsource(f).splitlines()[1:] for f in (before, after))
    return "\n".join(difflib.unified_diff(old, new, "before", "after", lineterm="", n=1))


def lost_in_films(histories: list[ehd.JointHistory], time: np.ndarray) -> np.ndarray:
    """Energy (n,) that the joints have taken out of the mechanism by ``time`` (n,), J."""
    total = np.zeros_like(time)
    for h in histories:
        steps = 0.5 * np.diff(h.time) * (h.power_loss[1:] + h.power_loss[:-1])
        total += np.interp(time, h.time, np.concatenate([[0.0], np.cumsum(steps)]))
    return total


def _sketch(ax) -> None:
    """Both links as they are let go, seen from the side and above."""

    def seen(x: float, y: float, z: float) -> tuple[float, float]:
        return x - 0.45 * z, y - 0.3 * z

    shoulder, elbow, tip = (0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (LENGTH, 0.0, LENGTH)
    for start, end in ((shoulder, elbow), (elbow, tip)):
        ax.plot(*np.transpose([seen(*start), seen(*end)]), color="0.6", lw=5, solid_capstyle="butt")
    for place, axis, name, colour in (
        (shoulder, (0.0, 0.0, 0.14), "shoulder", "tab:blue"),
        (elbow, (0.14, 0.0, 0.0), "elbow", "tab:red"),
    ):
        middle, half = np.array(place), np.array(axis)
        ax.plot(*np.transpose([seen(*(middle - half)), seen(*(middle + half))]), color=colour, lw=8)
        ax.text(seen(*place)[0], 0.1, name, color=colour, ha="center")
    ax.text(seen(*tip)[0] - 0.06, seen(*tip)[1], "tip", ha="right", va="center")
    ax.annotate("", (0.3, -0.38), (0.3, -0.1), arrowprops={"arrowstyle": "-|>", "lw": 1.2})
    ax.text(0.26, -0.25, "g", ha="right", va="center")
    ax.set(aspect="equal", xlim=(-0.3, 1.3), ylim=(-0.45, 0.25))
    ax.set_axis_off()


@styled(10.0)
def draw(ideal: dict, oiled: dict, path: pathlib.Path) -> None:
    """Tip, energy, eccentricity and minimum film thickness of both variants."""
    fig, axes = plt.subplots(2, 2, figsize=(11, 7.5), layout="constrained")
    t = oiled["time"]
    axes[0, 0].plot(ideal["time"], ideal["tip"][:, 1], color="black", label="before: ideal joints")
    axes[0, 0].plot(t, oiled["tip"][:, 1], "--", color="tab:orange", label="after: oil-filled joints")
    axes[0, 0].set(ylabel="height of the tip [m]", title="motion", ylim=(-1.95, 0.55))
    axes[0, 0].legend(frameon=False, loc="lower center", ncols=2)
    axes[0, 1].plot(t, oiled["energy"][0] - oiled["energy"], color="tab:orange", label="missing in the mechanism")
    axes[0, 1].plot(t, lost_in_films(oiled["histories"], t), ":", color="black", lw=2, label="lost in the films")
    axes[0, 1].set(ylabel="energy [J]", title="energy taken by the bearings")
    axes[0, 1].legend(frameon=False)
    _sketch(axes[0, 1].inset_axes((0.42, 0.06, 0.56, 0.42)))
    for name, colour, h in zip(("shoulder", "elbow"), ("tab:blue", "tab:red"), oiled["histories"], strict=True):
        axes[1, 0].plot(h.time, h.largest_eccentricity_ratio, color=colour, label=name)
        axes[1, 1].semilogy(h.time, 1e6 * h.minimum_gap, color=colour, label=name)
    axes[1, 0].set(
        ylabel="largest eccentricity ratio [-]", title="pins in their clearance (at the worse end)", ylim=(0, 1)
    )
    axes[1, 1].set(ylabel="minimum film thickness [µm]", title="minimum film thickness")
    axes[1, 1].axhline(2.0, color="grey", lw=0.8, ls="--", label="the wall acts below")
    axes[1, 1].legend(frameon=False, loc="upper center", ncols=3)
    axes[1, 1].set_ylim(0.5, 150)
    axes[1, 0].legend(frameon=False)
    for ax in axes.flat:
        ax.set(xlabel="time [s]", xlim=(0, t[-1]))
        ax.grid(alpha=0.3, which="both")
    fig.savefig(path, dpi=100)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/upgrade_existing_model") -> dict:
    """Run the tutorial's model with ideal and with oil-filled joints; returns the figures.

    Parameters
    ----------
    quick : bool
        0.8 s instead of the tutorial's 4 s.
    output : path or None
        Folder for the picture; None writes none.
    """
    end = 0.8 if quick else 4.0
    print("what changes in the model:\n" + difference())
    ideal, oiled = simulate(before, end=end), simulate(after, end=end)
    distance = np.linalg.norm(oiled["tip"] - ideal["tip"], axis=1)
    rows = {
        "largest_tip_distance_mm": 1e3 * float(distance.max()),
        "tip_distance_at_0.3_s_mm": 1e3 * float(np.interp(0.3, ideal["time"], distance)),
        "energy_missing_J": float(oiled["energy"][0] - oiled["energy"][-1]),
        "energy_lost_in_films_J": float(lost_in_films(oiled["histories"], oiled["time"])[-1]),
        "energy_drift_before_J": float(ideal["energy"][-1] - ideal["energy"][0]),
        "before_ms_per_step": ideal["ms_per_step"],
        "after_ms_per_step": oiled["ms_per_step"],
    }
    for name, h in zip(("shoulder", "elbow"), oiled["histories"], strict=True):
        rows[f"{name}_largest_eccentricity_ratio"] = float(h.largest_eccentricity_ratio.max())
        rows[f"{name}_minimum_film_thickness_um"] = 1e6 * float(h.minimum_gap.min())
        rows[f"{name}_peak_pressure_MPa"] = 1e-6 * float(h.peak_pressure.max())
        rows[f"{name}_largest_friction_torque_Nm"] = float(np.abs(h.friction_torque).max())
    print(f"\n{end:g} s of the tutorial")
    for key, value in rows.items():
        print(f"  {key:36s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(ideal, oiled, folder / "upgrade_existing_model.png")
        print(f"\npicture: {folder / 'upgrade_existing_model.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="0.8 s instead of 4 s")
    main(quick=parser.parse_args().quick)
