"""Results of a joint after a run: tables, files, pictures, an animation.

A journal (R 25 mm, L 50 mm, 5 kg, with a flywheel) turns at 3000 rpm on thin oil under a load of 8 kN downwards and an
unbalance of 5 kN that turns with it. It begins in the middle of its bore and runs until its orbit has closed within a
thousandth of the clearance, after 12 turns. The pictures show the last two of them. The numbers are made up; nothing is
compared.

Run ``python examples/reading_results.py``; everything is written to ``results/reading_results``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import numpy as np
from exudyn.utilities import RigidBodyInertia
from matplotlib.figure import Figure

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import PAGE, styled

SPEED = 3000.0 * 2.0 * math.pi / 60.0
TURN = 2.0 * math.pi / SPEED
LOAD, UNBALANCE = 8000.0, 5000.0


def simulate(turns: int | None, steps_per_turn: int) -> tuple[ehd.LubricatedJoint, str]:
    """Run the journal from the middle of its bore, for some turns or until its orbit has closed (None).

    Returns the joint, and what to say of the orbit.
    """
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    mbs.variables["container"] = SC  # the system lives as long as its container
    journal = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=5.0, inertiaTensor=np.diag([2.5, 2.5, 5.0])),
        initialAngularVelocity=[0.0, 0.0, SPEED],
        nodeType=exu.NodeType.RotationRotationVector,
    )

    def load(mbs, t, vector):
        return [UNBALANCE * math.cos(SPEED * t), UNBALANCE * math.sin(SPEED * t) - LOAD, 0.0]

    mbs.CreateForce(itemNumber=journal, loadVector=[0.0, -LOAD, 0.0], loadVectorUserFunction=load)
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.05,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.01),
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5),
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="bearing",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing,
        axial=ehd.Held(),
    )
    joint.record_films(period=TURN / 24.0, frames=150)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    longest = 30 if turns is None else turns
    settings.timeIntegration.endTime = longest * TURN
    settings.timeIntegration.numberOfSteps = longest * steps_per_turn
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    if turns is not None:
        ehd.SolveDynamic(mbs, settings)
        return joint, ""
    cycle = ehd.SolveDynamic(mbs, settings, until_periodic=ehd.UntilPeriodic(period=TURN, tolerance=1e-3))
    left = max(cycle.left, float(cycle.changes[-1]))
    return joint, f",\nclosed within {left:.1g} c in {cycle.cycles} turns"


def overview(joint: ehd.LubricatedJoint, path: pathlib.Path, closed: str) -> None:
    """One page: every picture drawn into axes of its own, histories over the last two turns."""
    end = joint.history.time[-1]
    history = joint.history.between(max(0.0, end - 2.0 * TURN))
    with styled():
        figure = Figure(figsize=(PAGE, 0.8 * PAGE), layout="constrained")
        grid = figure.add_gridspec(2, 6)
        orbit, pressure = figure.add_subplot(grid[0, :2]), figure.add_subplot(grid[1, :3])
        history.plot_orbit(ax=orbit)
        orbit.set_title(f"orbit of the journal{closed}")
        load = figure.add_subplot(grid[0, 2:4], projection="polar")
        history.plot_load(ax=load)
        load.set_title("load on the bush [kN]")
        bearing = figure.add_subplot(grid[0, 4:], projection="3d", computed_zorder=False)
        joint.plot_bearing(ax=bearing)
        bearing.set_title("pressure at the end")
        joint.plot_pressure(ax=pressure)
        # the circle is the clearance; start and end are marked on orbit and load
        figure.legend(
            handles=[*(ax.get_legend_handles_labels()[0][0] for ax in (orbit, pressure)), *orbit.lines[-2:]],
            labels=["clearance", "edge of the cavity", "start", "end"],
            loc="outside lower center",
            ncols=4,
        )
        traces = grid[1, 3:].subgridspec(2, 1)
        axes = [figure.add_subplot(traces[0]), figure.add_subplot(traces[1])]
        history.plot_traces(angle=SPEED * (history.time - history.time[0]), angle_text="shaft angle", ax=axes)
        axes[0].tick_params(labelbottom=False)
        figure.align_ylabels(axes)
        figure.savefig(path, dpi=110)


def main(*, quick: bool = False, results: str | pathlib.Path | None = "results/reading_results") -> dict:
    """Run, print the table of revolutions, write everything.

    Parameters
    ----------
    quick : bool
        Fewer turns and no animation.
    results : path or None
        Folder; None writes nothing.

    Returns
    -------
    dict
        ``revolutions`` (the table), ``history``, ``films`` and ``files``.
    """
    joint, closed = simulate(turns=2 if quick else None, steps_per_turn=72)
    table = joint.revolutions()
    print(table)
    files = []
    if results is not None:
        folder = pathlib.Path(results)
        folder.mkdir(parents=True, exist_ok=True)
        overview(joint, folder / "overview.png", closed)
        joint.save(folder / "bearing.npz")
        joint.to_csv(folder / "bearing.csv")
        table.to_csv(folder / "revolutions.csv")
        joint.plot_fill(path=folder / "fill.png")
        if not quick:
            joint.animate(folder / "bearing.gif")
        files = sorted(folder.iterdir())
        again = ehd.load_history(folder / "bearing.npz")
        assert np.array_equal(again.minimum_gap, joint.history.minimum_gap)
    return {"revolutions": table, "history": joint.history, "films": joint.films, "files": files}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer turns, no animation")
    main(quick=parser.parse_args().quick)
