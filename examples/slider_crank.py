"""A slider-crank mechanism whose gudgeon-pin bearing is filled with oil.

The crank turns at 5000 rpm. The bearing between connecting rod (housing) and the slider's pin (journal) is modelled
three times:

* ideal: Exudyn's revolute joint,
* realistic: clearance 20 um and 0.02 Pa s,
* literature: clearance 0.5 mm and 0.4 Pa s, as in the studies of clearance joints that use this mechanism
  (P. Flores, J. Ambrosio, Computers & Structures 82 (2004) 1359: crank 0.05 m, 0.30 kg, 1e-4 kg m2; rod 0.12 m, 0.21
  kg, 2.5e-4 kg m2; slider 0.14 kg). A clearance of 5 % of the radius is no bearing that one would build, and the
  package warns; it shows what play does.

The pin swings by +-24.6 degrees only: there are two instants per turn without any entrainment, in which the squeeze of
the film alone carries the load.

Run ``python examples/slider_crank.py``; pictures are written to ``results/slider_crank``.
"""

from __future__ import annotations

import argparse
import math
import pathlib
import time
import warnings
from dataclasses import dataclass

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

CRANK, ROD = 0.05, 0.12
CRANK_MASS, CRANK_INERTIA = 0.30, 1e-4
ROD_MASS, ROD_INERTIA = 0.21, 2.5e-4
SLIDER_MASS = 0.14
SPEED = 5000.0 * 2.0 * math.pi / 60.0
PIN_RADIUS, PIN_LENGTH = 0.010, 0.020
COLOURS = {"realistic": "tab:blue", "literature": "tab:orange"}


@dataclass(frozen=True, kw_only=True)
class Run:
    """One simulated mechanism; arrays over the recorded instants.

    ``angle`` crank angle (rad), ``slider`` position and ``acceleration`` (m, m/s2), ``force`` of the joint on the pin
    in global x, y (N), ``moment`` that drives the crank (Nm), ``history`` of the joint or None.
    """

    angle: np.ndarray
    slider: np.ndarray
    acceleration: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    history: ehd.JointHistory | None
    bearing: ehd.JournalBearing | None
    steps: int
    seconds: float


def pin_bearing(radial_clearance: float, viscosity: float, **options) -> ehd.JournalBearing:
    """The gudgeon-pin bearing; the literature's clearance lies outside the usual range on purpose."""
    with warnings.catch_warnings():
        if radial_clearance > 1e-2 * PIN_RADIUS:
            warnings.simplefilter("ignore", UserWarning)
        return ehd.JournalBearing(
            journal_radius=PIN_RADIUS,
            length=PIN_LENGTH,
            radial_clearance=radial_clearance,
            lubricant=ehd.Lubricant(viscosity=viscosity),
            **options,
        )


def _planar_body(mbs, name: str, mass: float, inertia: float, position, velocity, spin: float = 0.0):
    node = mbs.AddNode(
        eii.NodeRigidBody2D(name=name, referenceCoordinates=[*position, 0.0], initialVelocities=[*velocity, spin])
    )
    return node, mbs.AddObject(eii.ObjectRigidBody2D(name=name, nodeNumber=node, mass=mass, inertia=inertia))


def build(bearing: ehd.JournalBearing | None):
    """The mechanism at its outer dead centre at full speed; returns the system, its sensors and the lubricated joint.

    ``bearing=None`` is the ideal joint.
    """
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    rod_spin = -SPEED * CRANK / ROD
    crank_node, crank = _planar_body(
        mbs, "crank", CRANK_MASS, CRANK_INERTIA, (CRANK / 2, 0), (0, SPEED * CRANK / 2), SPEED
    )
    _, rod = _planar_body(mbs, "rod", ROD_MASS, ROD_INERTIA, (CRANK + ROD / 2, 0), (0, SPEED * CRANK / 2), rod_spin)
    slider_node, slider = _planar_body(mbs, "slider", SLIDER_MASS, 1e-4, (CRANK + ROD, 0), (0, 0))
    ground = mbs.AddObject(eii.ObjectGround())

    def marker(body, x: float):
        return mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0, 0]))

    mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=[marker(ground, 0), marker(crank, -CRANK / 2)]))
    mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=[marker(crank, CRANK / 2), marker(rod, -ROD / 2)]))
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    for coordinate in (1, 2):  # the slider's guide
        guided = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=slider_node, coordinate=coordinate))
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[origin, guided]))
    crank_angle = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=crank_node, coordinate=2))
    drive = mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, crank_angle],
            offsetUserFunction=lambda mbs, t, item, offset: SPEED * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: SPEED,
        )
    )
    sensors, joint = {}, None
    if bearing is None:
        pin = mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=[marker(rod, ROD / 2), marker(slider, 0)]))
        sensors["pin"] = _force_sensor(mbs, pin)
    else:
        joint = ehd.CreateLubricatedJoint(
            mbs,
            name="gudgeon pin",
            itemNumbers=[rod, slider],
            position=[CRANK + ROD, 0, 0],
            axis=[0, 0, 1],
            bearing=bearing,
        )
    for name in ("Displacement", "Acceleration"):
        kind = getattr(exu.OutputVariableType, name)
        sensors[name] = mbs.AddSensor(
            eii.SensorNode(nodeNumber=slider_node, storeInternal=True, outputVariableType=kind)
        )
    sensors["drive"] = _force_sensor(mbs, drive)
    mbs.Assemble()
    return mbs, sensors, joint


def _force_sensor(mbs, item):
    force = exu.OutputVariableType.Force
    return mbs.AddSensor(eii.SensorObject(objectNumber=item, storeInternal=True, outputVariableType=force))


def simulate(bearing: ehd.JournalBearing | None, *, turns: float, steps_per_turn: int) -> Run:
    """Run the mechanism from the outer dead centre at full speed; ``bearing=None`` is the ideal joint."""
    mbs, sensors, joint = build(bearing)
    settings = exu.SimulationSettings()
    period = 2.0 * math.pi / SPEED
    settings.timeIntegration.endTime = turns * period
    settings.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    settings.timeIntegration.verboseMode = 0
    settings.solution.sensors.writePeriod = period / steps_per_turn
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    start = time.perf_counter()
    ehd.SolveDynamic(mbs, settings)
    seconds = time.perf_counter() - start

    stored = {name: mbs.GetSensorStoredData(sensor) for name, sensor in sensors.items()}
    position = stored["Displacement"]
    if joint is None:
        force = -stored["pin"][:, 1:3]  # Exudyn reports the force on the other side
    else:
        force = _force_in_space(joint.history, position[:, 0])
    return Run(
        angle=SPEED * position[:, 0],
        slider=CRANK + ROD + position[:, 1],
        acceleration=stored["Acceleration"][:, 1],
        force=force,
        moment=stored["drive"][:, 1],
        history=None if joint is None else joint.history,
        bearing=bearing,
        steps=settings.timeIntegration.numberOfSteps,
        seconds=seconds,
    )


def _force_in_space(h: ehd.JointHistory, time: np.ndarray) -> np.ndarray:
    """Force on the pin in global x, y (n, 2), N; the history holds it in the rod's frame."""
    turn = np.interp(time, h.time, np.unwrap(_rod_angle(h.time)))
    local = np.column_stack([np.interp(time, h.time, h.force[:, k]) for k in (0, 1)])
    c, s = np.cos(turn), np.sin(turn)
    return np.column_stack([c * local[:, 0] - s * local[:, 1], s * local[:, 0] + c * local[:, 1]])


def _rod_angle(t: np.ndarray) -> np.ndarray:
    """Angle of the rod of the ideal mechanism, rad; the clearance changes it by less than c / ROD."""
    return -np.arcsin(CRANK / ROD * np.sin(SPEED * t))


def _after(run: Run, turns: float) -> np.ndarray:
    """Recorded instants after the start-up, with a rounding's tolerance on the angle."""
    return run.angle >= 2.0 * math.pi * turns - 1e-6


def figures(ideal: Run, run: Run, start_up: float) -> dict[str, float]:
    """Numbers of the table, over the turns after the start-up."""
    assert run.history is not None and run.bearing is not None
    late = _after(run, start_up)
    h = run.history
    kept = h.time >= start_up * 2.0 * math.pi / SPEED
    c = run.bearing.radial_clearance
    reference = np.interp(run.angle, ideal.angle, ideal.slider)
    force = np.hypot(*run.force.T)
    return {
        "clearance_um": 1e6 * c,
        "largest_eccentricity_ratio": float(h.eccentricity_ratio[kept].max()),
        "minimum_film_thickness_um": 1e6 * float(h.minimum_gap[kept].min()),
        "peak_pressure_MPa": 1e-6 * float(h.peak_pressure[kept].max()),
        "largest_pin_force_N": float(force[late].max()),
        "largest_crank_moment_Nm": float(np.abs(run.moment[late]).max()),
        "mean_power_loss_W": float(np.mean(h.power_loss[kept])),
        "largest_slider_deviation_um": 1e6 * float(np.abs(run.slider - reference)[late].max()),
        "ms_per_step": 1e3 * run.seconds / run.steps,
        "time_factor": (run.seconds / run.steps) / (ideal.seconds / ideal.steps),
    }


def print_table(rows: dict[str, dict[str, float]], ideal: Run, start_up: float) -> None:
    """Results side by side."""
    late = _after(ideal, start_up)
    force = float(np.hypot(*ideal.force.T)[late].max())
    print(f"\n{'after start-up':32s}{'ideal':>12s}" + "".join(f"{name:>14s}" for name in rows))
    known = {"largest_pin_force_N": force, "largest_crank_moment_Nm": float(np.abs(ideal.moment[late]).max())}
    known["ms_per_step"] = 1e3 * ideal.seconds / ideal.steps
    for key in next(iter(rows.values())):
        first = f"{known[key]:12.4g}" if key in known else f"{'-':>12s}"
        print(f"{key:32s}{first}" + "".join(f"{row[key]:14.4g}" for row in rows.values()))


def _over_the_crank_angle(axes, end: int, which: str) -> None:
    for ax in axes:
        ax.set(
            xlabel="crank angle after start-up [°]",
            xlim=(0, end),
            xticks=range(0, end + 1, 90 if end == 360 else 180),
        )
        ax.grid(alpha=0.3, which=which)


@styled(10.0)
def draw_mechanism(ideal: Run, runs: dict[str, Run], start_up: float, path: pathlib.Path) -> None:
    """Slider, joint force and driving moment over the crank angle."""
    end = round(math.degrees(ideal.angle[-1]) - 360.0 * start_up)
    fig, axes = plt.subplots(2, 2, figsize=(11, 7.5), layout="constrained")
    everyone = {"ideal joint": (ideal, "black")} | {name: (run, COLOURS[name]) for name, run in runs.items()}
    for name, (run, colour) in everyone.items():
        late = _after(run, start_up)
        degrees = np.degrees(run.angle[late]) - 360.0 * start_up
        style = {
            "color": colour,
            "label": name,
            "lw": 1.4,
            "ls": "--" if run is ideal else "-",
            "zorder": 3 if run is ideal else 2,
        }
        axes[0, 1].plot(degrees, 1e-3 * run.acceleration[late], **style)
        axes[1, 0].plot(degrees, 1e-3 * np.hypot(*run.force[late].T), **style)
        axes[1, 1].plot(degrees, run.moment[late], **style)
        if run is not ideal:
            deviation = run.slider - np.interp(run.angle, ideal.angle, ideal.slider)
            axes[0, 0].plot(degrees, 1e6 * deviation[late], **style)
    labels = (
        "slider position - ideal [µm]",
        "slider acceleration [km/s$^2$]",
        "joint force on the pin [kN]",
        "crank moment [Nm]",
    )
    for ax, label in zip(axes.flat, labels, strict=True):
        ax.set(ylabel=label)
    _over_the_crank_angle(axes.flat, end, "major")
    fig.legend(*axes[0, 1].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    fig.suptitle("Slider-crank at 5000 rpm: ideal and lubricated gudgeon-pin bearing")
    fig.savefig(path, dpi=120)
    plt.close(fig)


def _sketch(ax) -> None:
    """The mechanism, with the pin that floats on oil."""
    angle = 0.9
    pin = CRANK * np.array([math.cos(angle), math.sin(angle)])
    slider = np.array([pin[0] + math.sqrt(ROD**2 - pin[1] ** 2), 0.0])
    around = np.linspace(0.0, 2.0 * np.pi, 100)
    ax.plot(*(CRANK * np.array([np.cos(around), np.sin(around)])), color="0.8", lw=0.8)
    ax.plot([-0.06, 0.2], [0.0, 0.0], color="0.8", lw=0.8, ls="-.")
    ax.plot(*np.transpose([(0.0, 0.0), pin]), color="black", lw=3)
    ax.plot(*np.transpose([pin, slider]), color="0.6", lw=3)
    ax.plot([0.0, pin[0]], [0.0, pin[1]], "o", color="black", mfc="white", ms=6)
    ax.plot(*slider, "s", color="0.4", ms=17)
    ax.plot(*slider, "o", color="tab:blue", ms=8)
    ax.text(*(slider + (0.018, 0.008)), "pin on oil", color="tab:blue")
    ax.text(*(slider + (0.018, -0.022)), "slider", color="0.4")
    ax.text(*(0.5 * (pin + slider) + (0.004, 0.01)), "rod")
    ax.text(-0.06, 0.045, "crank,\n5000 rpm", ha="right", va="center")
    ax.set(aspect="equal", xlim=(-0.13, 0.26))
    ax.set_axis_off()


@styled(10.0)
def draw_bearing(ideal: Run, runs: dict[str, Run], start_up: float, path: pathlib.Path) -> None:
    """Force, orbit, film and pressure of the lubricated pins, with the force of the ideal joint."""
    fig = plt.figure(figsize=(11, 9.6), layout="constrained")
    grid = fig.add_gridspec(3, 2, height_ratios=(0.45, 1.0, 1.0))
    _sketch(fig.add_subplot(grid[0, :]))
    axes = [fig.add_subplot(grid[row, column]) for row, column in ((1, 1), (2, 0), (2, 1), (1, 0))]
    around = np.linspace(0, 2 * np.pi, 200)
    axes[0].plot(np.cos(around), np.sin(around), color="grey", lw=1)
    shown = [(run, {"color": COLOURS[name]}) for name, run in runs.items()]
    for run, style in [*shown, (ideal, {"color": "black", "ls": "--", "label": "ideal joint"})]:
        late = _after(run, start_up)
        axes[3].plot(np.degrees(run.angle[late]) - 360.0 * start_up, 1e-3 * np.hypot(*run.force[late].T), **style)
    opening = 0.0
    for name, run in runs.items():
        end = round(math.degrees(run.angle[-1]) - 360.0 * start_up)
        h, bearing = run.history, run.bearing
        assert h is not None and bearing is not None
        kept = h.time >= start_up * 2.0 * math.pi / SPEED
        degrees = np.degrees(SPEED * h.time[kept]) - 360.0 * start_up
        c = bearing.radial_clearance
        first, *_, last = h.eccentricity[kept] / c
        opening = max(opening, float(np.hypot(*(last - first))))
        label = f"{name}: c = {1e6 * c:g} µm, {bearing.lubricant.viscosity:g} Pa s"
        axes[0].plot(*(h.eccentricity[kept].T / c), color=COLOURS[name], label=label)
        axes[1].semilogy(degrees, 1e6 * h.minimum_gap[kept], color=COLOURS[name])
        axes[2].plot(degrees, 1e-6 * h.peak_pressure[kept], color=COLOURS[name])
    axes[0].set(
        xlabel="x / c (along the rod) [-]",
        ylabel="y / c [-]",
        aspect="equal",
        title=f"orbit of the pin in the rod's eye, closed within {opening:.1g} c",
    )
    axes[1].set(ylabel="minimum film thickness [µm]", title="minimum film thickness")
    axes[1].yaxis.set_major_formatter("{x:g}")
    axes[2].set(ylabel="peak pressure [MPa]", title="peak pressure")
    axes[3].set(ylabel="joint force on the pin [kN]", title="joint force (realistic under ideal)")
    _over_the_crank_angle(axes[1:], end, "both")
    fig.legend(loc="outside upper center", ncols=3)
    fig.savefig(path, dpi=100)
    plt.close(fig)


def main(
    *, quick: bool = False, output: str | pathlib.Path | None = "results/slider_crank"
) -> dict[str, dict[str, float]]:
    """Compare ideal and lubricated pin; returns the table's numbers by case.

    Parameters
    ----------
    quick : bool
        One turn after one of start-up instead of two after two, and coarser steps.
    output : path or None
        Folder for the pictures; None writes none.
    """
    start_up, turns = (1.0, 2.0) if quick else (2.0, 4.0)
    steps_per_turn = 360 if quick else 720
    cases = {
        "realistic": pin_bearing(20e-6, 0.02),
        "literature": pin_bearing(0.5e-3, 0.4, film=ehd.FiniteLength(n_theta=192)),
    }
    print(f"slider-crank, {turns:g} turns at 5000 rpm, {steps_per_turn} steps per turn")
    print("  compiling the film's kernels (some seconds the first time, then read from the cache) ...", flush=True)
    simulate(cases["realistic"], turns=0.01, steps_per_turn=steps_per_turn)
    print("  ideal joint ...", flush=True)
    ideal = simulate(None, turns=turns, steps_per_turn=steps_per_turn)
    runs = {}
    for name, bearing in cases.items():
        print(f"  lubricated joint, {name} clearance ...", flush=True)
        runs[name] = simulate(bearing, turns=turns, steps_per_turn=steps_per_turn)
    rows = {name: figures(ideal, run, start_up) for name, run in runs.items()}
    print_table(rows, ideal, start_up)
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw_mechanism(ideal, runs, start_up, folder / "mechanism.png")
        draw_bearing(ideal, runs, start_up, folder / "bearing.png")
        print(f"\npictures: {folder / 'mechanism.png'}, {folder / 'bearing.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer turns and steps")
    main(quick=parser.parse_args().quick)
