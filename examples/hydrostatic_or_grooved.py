"""Oil supply: a bearing with a supply groove, with and without an oil balance.

A bearing of 100 mm diameter and 80 mm length (radial clearance 150 um, 10 mPa s, 3000 rpm) is fed through one axial
groove of 15 degrees x 60 mm at 0.7 bar. Three questions are asked with Gümbel's condition (negative pressure clipped),
Swift-Stieber's (pressure and slope vanish at the rupture line) and Elrod and Adams' (mass conserving):

1. What does the film do at a given position, aligned and tilted? Elrod-Adams and Gümbel are laid next to another
   finite-volume code on the same case, which shears the oil in the groove as on a land.
2. Where should the groove be? The load of 3 kN is fixed, the groove's angle varies. Only the mass-conserving film
   balances inflow and outflow, so only it shows that a groove under the load starves the film until it can't carry.
   Next to these angles `GridWarning` tells that the few micrometres left have a peak too narrow for the grid.
3. What happens when the load sweeps over the groove? The journal turns at 3000 rpm, the load of 2 kN at a tenth of
   that speed. The run begins half a turn of the load before the turn that is shown.

Run ``python examples/hydrostatic_or_grooved.py``; pictures are written to ``results/hydrostatic_or_grooved``.
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

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

SPEED = 100.0 * math.pi
LOAD, TURNING_LOAD, LOAD_SPEED = 3000.0, 2000.0, 0.1 * SPEED
MASS = 5.0
CLOSURES = {"Gümbel": ehd.Gumbel(), "Swift-Stieber": ehd.SwiftStieber(), "Elrod-Adams": ehd.ElrodAdams()}
COLOURS = {"Gümbel": "tab:green", "Swift-Stieber": "tab:blue", "Elrod-Adams": "tab:red"}
# Another finite-volume code on the grid 200 x 52, force on the shell in N, friction in N m: eccentricity ratio 0.5
# towards angle 0, the tilted rows with a tilt across the eccentricity that takes 30 % of the clearance at the ends.
OTHER_CODE = {
    ("Elrod-Adams", "aligned"): (1058.30, -1386.73, 1.38092),
    ("Gümbel", "aligned"): (811.49, -1396.89, 1.46715),
    ("Elrod-Adams", "tilted"): (1066.25, -1396.48, 1.39888),
    ("Gümbel", "tilted"): (804.97, -1414.67, 1.49742),
}


def make_bearing(closure: str, groove_angle: float, film: ehd.FiniteLength) -> ehd.JournalBearing:
    """The bearing with its groove at an angle in rad."""
    return ehd.JournalBearing(
        journal_radius=0.05,
        length=0.08,
        radial_clearance=150e-6,
        lubricant=ehd.Lubricant(viscosity=0.01),
        film=film,
        cavitation=CLOSURES[closure],
        supply=(ehd.AxialGroove(angle=groove_angle, width_angle=math.radians(15.0), length=0.06, pressure=7e4),),
    )


def at_a_position(film: ehd.FiniteLength) -> dict[tuple[str, str], ehd.SteadyResult]:
    """Films at eccentricity ratio 0.5 with the groove a quarter turn ahead, aligned and tilted."""
    films = {}
    for closure in CLOSURES:
        for name, share in (("aligned", 0.0), ("tilted", 0.3)):
            # the tilt's share of the clearance at the ends, across the eccentricity
            tilt = (0.0, share * 150e-6 / 0.04)
            films[closure, name] = ehd.steady(
                make_bearing(closure, 0.5 * math.pi, film), speed=SPEED, eccentricity_ratio=0.5, tilt=tilt
            )
    return films


@dataclasses.dataclass(frozen=True, kw_only=True)
class Sweep:
    """Minimum film thickness (m), flow in and out (m3/s) over the groove's angle from the load in degrees (k,).

    nan where the film can't carry.
    """

    angle: np.ndarray
    minimum_film_thickness: np.ndarray
    supplied: np.ndarray
    leaked: np.ndarray


def around(closure: str, film: ehd.FiniteLength, *, step: float) -> Sweep:
    """Equilibrium under the fixed load with the groove at every ``step`` degrees."""
    angles = np.arange(-180.0, 180.0, step)
    rows = []
    for angle in angles:
        try:
            state = ehd.equilibrium(
                make_bearing(closure, math.radians(angle - 90.0), film), speed=SPEED, load=(0.0, -LOAD)
            ).film
            rows.append((state.minimum_gap, float(state.supply_flows.sum()), state.leakage))
        except ehd.FilmError:
            rows.append((math.nan, math.nan, math.nan))
    film_thickness, supplied, leaked = np.array(rows).T
    return Sweep(angle=angles, minimum_film_thickness=film_thickness, supplied=supplied, leaked=leaked)


def turning_load(
    closure: str, film: ehd.FiniteLength, *, turns: float, steps_per_turn: int
) -> tuple[np.ndarray, ehd.JointHistory]:
    """Journal under a load that turns with `LOAD_SPEED`: its angle from the groove in degrees (n,), and the history."""
    bearing = make_bearing(closure, 0.0, film)
    start = ehd.equilibrium(
        dataclasses.replace(bearing, cavitation=ehd.SwiftStieber()), speed=SPEED, load=(-TURNING_LOAD, 0.0)
    ).position
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(
        eii.NodeRigidBody2D(
            referenceCoordinates=[0, 0, 0], initialCoordinates=[*start, 0], initialVelocities=[0, 0, SPEED]
        )
    )
    journal = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=0.01))
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))],
            offsetUserFunction=lambda mbs, t, item, offset: SPEED * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: SPEED,
        )
    )
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=journal)),
            loadVector=[0, 0, 0],
            loadVectorUserFunction=lambda mbs, t, load: [
                -TURNING_LOAD * math.cos(LOAD_SPEED * t),
                -TURNING_LOAD * math.sin(LOAD_SPEED * t),
                0.0,
            ],
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="grooved bearing", itemNumbers=[ground, journal], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * math.pi / LOAD_SPEED
    settings.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    history = joint.history
    return np.degrees(LOAD_SPEED * history.time) - 180.0, history


def open_end(history: ehd.JointHistory) -> float:
    """Largest distance of the last quarter turn of the load from where the journal was a turn before, over c."""
    turn = 2.0 * math.pi / LOAD_SPEED
    late = history.time >= history.time[-1] - 0.25 * turn
    before = [np.interp(history.time[late] - turn, history.time, places) for places in history.eccentricity.T]
    return float(np.hypot(*(history.eccentricity[late] - np.transpose(before)).T).max()) / history.radial_clearance


def figures(films, sweeps, runs) -> dict[str, float]:
    """Numbers that the example is there for."""
    rows = {}
    for key, (horizontal, vertical, friction) in OTHER_CODE.items():
        film = films[key]
        size = math.hypot(horizontal, vertical)
        rows["force off the other code: " + ", ".join(key)] = (
            math.hypot(-film.force[0] - horizontal, -film.force[1] - vertical) / size
        )
        # which shears the oil in the groove as if it were a land; tilts hardly change its mean
        groove = 0.01 * SPEED * 0.05**3 * math.radians(15.0) * 0.06 / 150e-6
        rows["friction off the other code: " + ", ".join(key)] = (film.friction_torque_bush + groove) / friction - 1.0
    for closure, sweep in sweeps.items():
        best = int(np.nanargmax(sweep.minimum_film_thickness))
        rows[f"{closure}: best groove angle from the load [deg]"] = float(sweep.angle[best])
        rows[f"{closure}: minimum film thickness there [um]"] = 1e6 * float(sweep.minimum_film_thickness[best])
        under = int(np.argmin(np.abs(sweep.angle)))
        rows[f"{closure}: minimum film thickness, groove under the load [um]"] = 1e6 * float(
            sweep.minimum_film_thickness[under]
        )
        rows[f"{closure}: oil out of nothing, share of the leakage"] = float(
            np.nanmax(np.abs(1.0 - sweep.supplied / sweep.leaked))
        )
    for closure, (angle, history) in runs.items():
        late = angle >= 0.0
        thinnest = int(np.argmin(history.minimum_gap[late]))
        rows[f"{closure}: minimum film thickness under the turning load [um]"] = 1e6 * float(
            history.minimum_gap[late][thinnest]
        )
        rows[f"{closure}: load's angle from the groove then [deg]"] = float(angle[late][thinnest])
        rows[f"{closure}: journal's distance from a turn before, over c"] = open_end(history)
    return rows


@styled(10.0)
def draw(films, sweeps, runs, folder: pathlib.Path) -> None:
    """Maps of pressure and fill, and the two sweeps."""
    fig, axes = plt.subplots(2, 2, figsize=(12, 8.5), layout="constrained")
    for ax, field, text in zip(axes[0], ("pressure", "fill"), ("pressure", "film fraction"), strict=True):
        getattr(films["Elrod-Adams", "tilted"], f"plot_{field}")(ax=ax)
        ax.set_title(f"{text} of the tilted film, Elrod-Adams")
    fig.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2, facecolor="0.85")
    for closure, sweep in sweeps.items():
        axes[1, 0].plot(
            sweep.angle, 1e6 * sweep.minimum_film_thickness, "o-", ms=3, color=COLOURS[closure], label=closure
        )
    starved = sweeps["Elrod-Adams"].angle[np.isnan(sweeps["Elrod-Adams"].minimum_film_thickness)]
    if starved.size:
        half = 0.5 * (sweeps["Elrod-Adams"].angle[1] - sweeps["Elrod-Adams"].angle[0])
        span = (starved.min() - half, starved.max() + half)
        axes[1, 0].axvspan(*span, color=COLOURS["Elrod-Adams"], alpha=0.15, lw=0, label="starved: carries no 3 kN")
    axes[1, 0].set(
        xlabel="groove's angle from the load [°]",
        ylabel="minimum film thickness [µm]",
        title="where to put the groove (load 3 kN)",
        xticks=range(-180, 181, 60),
        ylim=(0, 90),
    )
    closed = max(open_end(history) for _, history in runs.values())
    for closure, (angle, history) in runs.items():
        # the closed turn from 0 to 360 degrees, with the groove in the middle
        late = angle >= 0.0
        shown = np.where(angle[late] > 180.0, angle[late] - 360.0, angle[late])
        order = np.argsort(shown)
        axes[1, 1].plot(shown[order], 1e6 * history.minimum_gap[late][order], color=COLOURS[closure], label=closure)
    axes[1, 1].set(
        xlabel="load's angle from the groove [°]",
        ylabel="minimum film thickness [µm]",
        title=f"a load of 2 kN turns over the groove, closed within {closed:.0e} c",
        xticks=range(-180, 181, 60),
        xlim=(-180, 180),
        ylim=(0, 85),
    )
    for ax in axes[1]:
        ax.grid(alpha=0.3)
    axes[1, 0].legend(loc="upper center", ncols=2)
    axes[1, 1].legend(loc="upper center", ncols=3)
    fig.savefig(folder / "hydrostatic_or_grooved.png", dpi=100)
    plt.close(fig)


def main(
    *, quick: bool = False, output: str | pathlib.Path | None = "results/hydrostatic_or_grooved"
) -> dict[str, float]:
    """Answer the three questions; returns the figures.

    Parameters
    ----------
    quick : bool
        Coarser grids and steps.
    output : path or None
        Folder for the picture; None writes none.
    """
    fine = ehd.FiniteLength(n_theta=200, n_z=26, stretch=0.0)
    film = ehd.FiniteLength(n_theta=120, n_z=10) if quick else ehd.FiniteLength(n_theta=144, n_z=12)
    print("films at one position ...", flush=True)
    films = at_a_position(fine)
    print("groove around the bearing ...", flush=True)
    sweeps = {closure: around(closure, film, step=30.0 if quick else 10.0) for closure in CLOSURES}
    print("turning load ...", flush=True)
    runs = {
        closure: turning_load(closure, film, turns=1.5, steps_per_turn=180 if quick else 720) for closure in CLOSURES
    }
    rows = figures(films, sweeps, runs)
    for key, value in rows.items():
        print(f"  {key:68s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(films, sweeps, runs, folder)
        print(f"picture: {folder / 'hydrostatic_or_grooved.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarser grids and steps")
    main(quick=parser.parse_args().quick)
