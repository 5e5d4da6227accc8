"""A connecting-rod bearing over the four-stroke cycle: where does its pin go, and how thin does the film get?

The load acts along the rod and reverses twice per cycle; the pin turns at 2000 rpm. This is the dynamically loaded
bearing on which mobility methods are compared: length 25.4 mm, diameter 63.5 mm, radial clearance 35.56 um, 4.16 mPa s;
the load over 720 degrees is digitised from P. Flores, J. C. P. Claro, J. Ambrosio, Mecanica Experimental 13 (2006) 115
(after J. F. Booker, J. Basic Engineering 87 (1965) 537).

The same engine is driven through five bearings:

* ``short``: short-bearing film, the model of the literature. Its orbit is laid over one that was integrated
  independently for a massless journal in the short-bearing film (``data/four_stroke_orbit.csv``),
* ``finite``: two-dimensional film with Swift-Stieber rupture, the default of the package. At L/D = 0.4 the short
  bearing is too stiff,
* ``Gümbel``: the same with the linear pressure clipped,
* ``oil balance``: Elrod-Adams, with the oil of the cavities as history; fed by the ends and by a hole in the pin at
  3 bar. The other films forget their start within a cycle; here each cycle reduces the distance from the periodic
  orbit to a quarter only,
* ``elastic``: the default film on a steel bush 6 mm thick.

Each run ends when its orbit repeats from one cycle to the next within a thousandth of the clearance.

Run ``python examples/engine_big_end.py``; pictures are written to ``results/engine_big_end``.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import pathlib
import time

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

DATA = pathlib.Path(__file__).parent / "data"
SPEED = 2000.0 * 2.0 * math.pi / 60.0
CYCLE = 4.0 * math.pi / SPEED
# The literature's journal has no mass. At c omega^2 = 1.6 m/s2 this one's inertia is below a thousandth of the smallest
# load.
JOURNAL_MASS = 0.05
MOST_CYCLES = 8
CLOSED = ehd.UntilPeriodic(period=CYCLE, tolerance=1e-3)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cycle:
    """The last cycle of one bearing: ``angle`` (n,) in degrees from its start, and the joint's ``history`` over it."""

    angle: np.ndarray
    history: ehd.JointHistory
    seconds_per_step: float
    iterations_per_step: float


def bearings(*, quick: bool) -> dict[str, ehd.JournalBearing]:
    """The five bearings."""
    plain = ehd.JournalBearing(
        journal_radius=0.03175,
        length=0.0254,
        radial_clearance=35.56e-6,
        lubricant=ehd.Lubricant(viscosity=4.16e-3),
        film=ehd.FiniteLength(n_theta=64, n_z=8) if quick else ehd.FiniteLength(),
    )
    bush = ehd.ModalBush(
        mesh=ehd.HollowCylinder(
            inner_radius=0.03175, thickness=0.006, length=0.0254, axial=4, radial=2, circumferential=40
        ),
        material=ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0),
        tolerance=0.04,
        tilted=False,
    )
    return {
        "short": dataclasses.replace(plain, film=ehd.ShortBearing(n_theta=192)),
        "finite": plain,
        "Gümbel": dataclasses.replace(plain, cavitation=ehd.Gumbel()),
        "oil balance": dataclasses.replace(
            plain,
            cavitation=ehd.ElrodAdams(cavity_pressure=-1e5),
            supply=(ehd.Hole(angle=0.0, diameter=5e-3, pressure=3e5, rotating=True),),
        ),
        "elastic": dataclasses.replace(plain, bush=bush),
    }


def _load_table() -> tuple[np.ndarray, np.ndarray]:
    """Crank angle in degrees and force along the rod in N, closed over the cycle."""
    angle, force = np.genfromtxt(DATA / "four_stroke_load.csv", delimiter=",", skip_header=2).T
    return np.concatenate([angle, angle[:1] + 720.0]), np.concatenate([force, force[:1]])


def simulate(bearing: ehd.JournalBearing, *, start_up: float | None, steps_per_cycle: int) -> Cycle:
    """Run from the steady position under the load there; return the last cycle.

    ``start_up`` cycles come before it; None: until the orbit has closed.
    """
    closes = start_up is None
    start_up = MOST_CYCLES - 1.0 if start_up is None else start_up
    angles, forces = _load_table()
    first = float(np.interp(-720.0 * start_up, angles, forces, period=720.0))
    rigid = dataclasses.replace(bearing, bush=None, cavitation=ehd.SwiftStieber(), supply=())
    start = ehd.equilibrium(rigid, speed=SPEED, load=(first, 0.0)).position

    mbs = exu.SystemContainer().AddSystem()
    rod = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(
        eii.NodeRigidBody2D(
            referenceCoordinates=[0, 0, 0], initialCoordinates=[*start[:2], 0], initialVelocities=[0, 0, SPEED]
        )
    )
    pin = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=JOURNAL_MASS, inertia=1e-4))
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))],
            offsetUserFunction=lambda mbs, t, item, offset: SPEED * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: SPEED,
        )
    )

    def load(mbs, t, vector):
        return [float(np.interp(720.0 * (t / CYCLE - start_up), angles, forces, period=720.0)), 0.0, 0.0]

    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=pin)),
            loadVector=[first, 0, 0],
            loadVectorUserFunction=load,
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="big end", itemNumbers=[rod, pin], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()

    steps = round((1.0 + start_up) * steps_per_cycle)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = (1.0 + start_up) * CYCLE
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    clock = time.perf_counter()
    last = ehd.SolveDynamic(mbs, settings, until_periodic=CLOSED if closes else None)
    seconds = time.perf_counter() - clock
    steps = joint.history.time.size - 1
    history = last.histories[joint.name] if closes else joint.history.between(start_up * CYCLE)
    return Cycle(
        angle=720.0 * (history.time - history.time[0]) / CYCLE,
        history=history,
        seconds_per_step=seconds / steps,
        iterations_per_step=mbs.sys["dynamicSolver"].it.newtonStepsCount / steps,
    )


def reference_orbit() -> np.ndarray:
    """Rows of crank angle in degrees, x / c and y / c (x along the load) of the independent orbit."""
    return np.genfromtxt(DATA / "four_stroke_orbit.csv", delimiter=",", skip_header=2)[:, [0, 2, 3]]


def open_end(history: ehd.JointHistory) -> float:
    """Distance between the first and the last position of a cycle's orbit, m."""
    return float(np.hypot(*(history.eccentricity[-1] - history.eccentricity[0])))


def figures(cycle: Cycle, bearing: ehd.JournalBearing) -> dict[str, float]:
    """Numbers of the table."""
    h, c = cycle.history, bearing.radial_clearance
    thinnest = int(np.argmin(h.minimum_gap))
    reference = reference_orbit()
    reference = reference[reference[:, 0] >= 180.0]  # by then a short start-up is forgotten
    x, y = (np.interp(reference[:, 0], cycle.angle, h.eccentricity[:, k] / c) for k in (0, 1))
    return {
        "minimum_film_thickness_um": 1e6 * float(h.minimum_gap[thinnest]),
        "at_crank_angle_deg": float(cycle.angle[thinnest]),
        "largest_eccentricity_ratio": float(h.eccentricity_ratio.max()),
        "peak_pressure_MPa": 1e-6 * float(h.peak_pressure.max()),
        "mean_power_loss_W": float(np.mean(h.power_loss)),
        "mean_leakage_cm3_per_s": 1e6 * float(np.mean(h.leakage)),
        "largest_distance_to_reference_orbit": float(np.hypot(x - reference[:, 1], y - reference[:, 2]).max()),
        "open_end_of_the_cycle": open_end(h) / c,
        "iterations_per_step": cycle.iterations_per_step,
        "ms_per_step": 1e3 * cycle.seconds_per_step,
    }


def print_table(rows: dict[str, dict[str, float]]) -> None:
    """Results side by side."""
    print(f"\n{'':38s}" + "".join(f"{name:>13s}" for name in rows))
    for key in next(iter(rows.values())):
        print(f"{key:38s}" + "".join(f"{row[key]:13.4g}" for row in rows.values()))


def _sketch(ax) -> None:
    """Big end and pin, with the frame of the orbit and the load."""
    around = np.linspace(0.0, 2.0 * np.pi, 200)
    ring = np.array([np.cos(around), np.sin(around)])
    ax.fill(*(1.55 * ring), color="0.85")
    ax.fill([1.2, 4.6, 4.6, 1.2], [0.75, 0.5, -0.5, -0.75], color="0.85")
    ax.fill(*ring, color="white")
    ax.fill(*(0.9 * ring + [[0.05], [0.03]]), color="0.55")
    arrow = {"arrowstyle": "-|>", "lw": 1.5}
    for end, name, place in (((2.2, 0.0), "x", (1.95, 0.15)), ((0.0, 2.2), "y", (0.15, 1.95))):
        ax.annotate("", end, (0.0, 0.0), arrowprops=arrow | {"lw": 1.0})
        ax.text(*place, name)
    ax.annotate("", (-0.85, 0.0), (-3.2, 0.0), arrowprops=arrow | {"color": "tab:red"})
    ax.text(-2.6, 0.2, "load > 0", color="tab:red", ha="center")
    ax.annotate("", (-0.45, 0.5), (0.5, 0.45), arrowprops=arrow | {"connectionstyle": "arc3,rad=0.6", "color": "white"})
    ax.text(0.05, -2.2, "pin, 2000 rpm", ha="center")
    ax.plot([0.05, 0.05], [-1.75, -0.5], color="black", lw=0.8)
    ax.text(3.5, -0.05, "rod", ha="center", va="center")
    ax.set(aspect="equal", xlim=(-3.4, 4.7), ylim=(-2.4, 2.4))
    ax.set_axis_off()


@styled(10.0)
def draw(cycles: dict[str, Cycle], clearance: float, path: pathlib.Path) -> None:
    """Orbits with the reference, load, minimum film thickness and peak pressure over the cycle."""
    colours = dict(zip(cycles, ("black", "tab:blue", "tab:green", "tab:red", "tab:orange"), strict=True))
    styles = {"elastic": "--"}
    fig, axes = plt.subplots(2, 2, figsize=(12, 9), layout="constrained")
    closed = max(open_end(cycle.history) for cycle in cycles.values()) / clearance
    around = np.linspace(0.0, 2.0 * np.pi, 300)
    axes[0, 0].plot(np.cos(around), np.sin(around), color="grey", lw=1)
    for name, cycle in cycles.items():
        style = {"color": colours[name], "ls": styles.get(name, "-"), "lw": 1.4, "label": name}
        h = cycle.history
        axes[0, 0].plot(*(h.eccentricity.T / clearance), **style)
        axes[1, 0].plot(cycle.angle, 1e6 * h.minimum_gap, **style)
        axes[1, 1].plot(cycle.angle, 1e-6 * h.peak_pressure, **style)
    reference = reference_orbit()[::4]
    axes[0, 0].plot(*reference[:, 1:].T, "o", ms=3.5, mfc="none", color="black", label="short, independent", zorder=4)
    axes[0, 0].set(
        xlabel="x / c (along the rod) [-]",
        ylabel="y / c [-]",
        aspect="equal",
        title=f"orbit of the pin in the big end,\nclosed within {closed:.1g} c",
        xticks=(-1, -0.5, 0, 0.5, 1),
        yticks=(-1, -0.5, 0, 0.5, 1),
    )
    axes[0, 0].legend(frameon=False, loc="center left", bbox_to_anchor=(1.02, 0.5))
    angles, forces = _load_table()
    axes[0, 1].plot(angles, 1e-3 * forces, "o-", ms=3, color="black")
    axes[0, 1].axhline(0.0, color="grey", lw=0.8)
    _sketch(axes[0, 1].inset_axes((0.2, 0.03, 0.5, 0.46)))
    axes[0, 1].set(ylabel="load along the rod [kN]", title="load of the four-stroke cycle")
    axes[1, 0].set(ylabel="minimum film thickness [µm]", title="minimum film thickness", ylim=(0, None))
    axes[1, 1].set(ylabel="peak pressure [MPa]", title="peak pressure", ylim=(0, None))
    for ax in (axes[0, 1], axes[1, 0], axes[1, 1]):
        ax.set(xlabel="crank angle [°]", xlim=(0, 720), xticks=range(0, 721, 90))
        ax.grid(alpha=0.3)
    fig.savefig(path, dpi=100)
    plt.close(fig)


def main(
    *, quick: bool = False, output: str | pathlib.Path | None = "results/engine_big_end"
) -> dict[str, dict[str, float]]:
    """Run the five bearings over the cycle; returns the table's numbers by case.

    Parameters
    ----------
    quick : bool
        Coarse film grid, steps of 2 degrees and a quarter of a cycle to start up, instead of 1 degree and until the
        orbit is closed.
    output : path or None
        Folder for the pictures; None writes none.
    """
    steps_per_cycle = 360 if quick else 720
    cycles, rows = {}, {}
    cases = bearings(quick=quick)
    print(f"big end over the four-stroke cycle at 2000 rpm, {steps_per_cycle} steps per cycle")
    for name, bearing in cases.items():
        print(f"  {name} ...", flush=True)
        cycles[name] = simulate(bearing, start_up=0.25 if quick else None, steps_per_cycle=steps_per_cycle)
        rows[name] = figures(cycles[name], bearing)
    print_table(rows)
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(cycles, cases["finite"].radial_clearance, folder / "engine_big_end.png")
        print(f"\npicture: {folder / 'engine_big_end.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarse grid and steps, shorter start-up")
    main(quick=parser.parse_args().quick)
