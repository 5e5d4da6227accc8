"""A spatial four-bar mechanism whose elastic rocker tilts its journals in their bearings.

An RSSR mechanism: a crank (radius 20 mm, 1800 rpm, axis y) drives a rocker, whose axis x crosses the crank's at 90
degrees, by a coupler with a ball joint at either end. The rocker is a steel shaft of 16 mm in two bearings 100 mm apart
(length 16 mm, radial clearance 16 um, 0.04 Pa s), with an arm overhanging by 30 mm. The coupler pulls at the arm's
middle, a tool of 0.25 kg sits at its tip. The numbers are our own. The tool's inertia force, 0.6 kN in both directions,
bends arm and shaft. No other force acts on the shaft between the bearings, so that beam theory gives the tilt of the
right journal from the force F and the moment M of the left film, with the bearings' distance s, and the section's
rotation in place of the axis' slope::

    tilt = (e_right - e_left) / s + F s^2 / (3 EI) - M s / (2 EI) + F / (k GA)

A rigid rocker tilts only as far as its two journals are eccentric to different sides: the first term, below 1e-4 rad.
With the elastic rocker the right journal is tilted by 9e-4 rad. Its film is thinnest at the bearing's edge, little
more than half as thick as under the same load with parallel axes. The latter is the usual way to size bearings, done
here with the recorded load on a journal that can't tilt.

The rocker swings by +-20 degrees: twice per turn there is no entrainment and the squeeze of the film alone carries.

Shaft and arm are geometrically exact beams (``ObjectBeamGeometricallyExact`` on ``NodeRigidBodyRxyz``, whose first
angle is the swing); the rigid rocker is one body of the same mass and inertia, with the same bearings, and with
Exudyn's ideal revolute joint. The coupler has no mass.

After four turns the journals' orbits repeat within 2 % of the clearance; otherwise the example raises an error.

Run ``python examples/four_bar_spatial.py``; pictures are written to ``results/four_bar_spatial``.
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
from exudyn.rigidBodyUtilities import InertiaCylinder, InertiaMassPoint
from scipy import optimize

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

STEEL, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
DIAMETER = 0.016
AREA, INERTIA = math.pi * DIAMETER**2 / 4.0, math.pi * DIAMETER**4 / 64.0
SHEAR = STEEL / (2.0 * (1.0 + POISSON))
SHEAR_FACTOR = 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON)  # G. R. Cowper 1966, solid circle
SPAN, OVERHANG, ARM, TOOL_MASS = 0.10, 0.03, 0.12, 0.25
CRANK, COUPLER = 0.02, 0.15
SPEED = 1800.0 * 2.0 * math.pi / 60.0
DAMPING_TIME = 3e-6  # s, Kelvin-Voigt, for the vibrations that the start excites
SPAN_ELEMENTS, OVERHANG_ELEMENTS, ARM_ELEMENTS = 4, 2, 4
CASES = ("ideal joint", "oil, rigid", "oil, elastic")
BEARING = ehd.JournalBearing(
    journal_radius=0.5 * DIAMETER, length=0.016, radial_clearance=16e-6, lubricant=ehd.Lubricant(viscosity=0.04)
)
AXES = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]  # of the bearings: their x, y are y, z of space


def crank_pin(angle: float) -> np.ndarray:
    """Position of the crank's ball (m): a circle in a plane parallel to x and z below the middle of the arm."""
    return np.array([SPAN + OVERHANG + CRANK * math.cos(angle), 0.5 * ARM, CRANK * math.sin(angle) - COUPLER])


def swing(angle: float) -> float:
    """Angle of the ideal rocker (rad) at a crank angle, from the coupler's length."""
    pin = crank_pin(angle)

    def excess(alpha: float) -> float:
        ball = np.array([SPAN + OVERHANG, 0.5 * ARM * math.cos(alpha), 0.5 * ARM * math.sin(alpha)])
        return float(np.sum((ball - pin) ** 2)) - COUPLER**2

    return float(optimize.brentq(excess, -0.9, 0.9, xtol=1e-14))


def dead_centre() -> float:
    """Crank angle at which the rocker is at its lowest and stands still."""
    return float(optimize.minimize_scalar(swing, bounds=(-2.0, -1.0), method="bounded", options={"xatol": 1e-10}).x)


def section() -> exu.BeamSection:
    """Section data of shaft and arm."""
    transverse, bending = SHEAR_FACTOR * SHEAR * AREA, STEEL * INERTIA
    stiffness = np.diag([STEEL * AREA, transverse, transverse, 2.0 * SHEAR * INERTIA, bending, bending])
    data = exu.BeamSection()
    data.stiffnessMatrix = stiffness
    data.dampingMatrix = DAMPING_TIME * stiffness
    data.inertia = DENSITY * np.diag([2.0 * INERTIA, INERTIA, INERTIA])
    data.massPerLength = DENSITY * AREA
    return data


@dataclasses.dataclass(frozen=True, kw_only=True)
class Run:
    """One simulated mechanism.

    Recorded ``time`` (s), ``tool`` position (n, 3) in m, histories of left and right joint, reaction of the ideal joint
    (n, 3) in N or None; ``closed`` how far the last turn of the journals is from the one before and from the limit,
    over the clearance, nan for less than three turns and for the ideal joint.
    """

    time: np.ndarray
    tool: np.ndarray
    histories: tuple[ehd.JointHistory, ...]
    reaction: np.ndarray | None
    closed: float
    milliseconds_per_step: float


class Mechanism:
    """The mechanism in Exudyn, at a dead centre of the rocker and at full crank speed.

    Parameters
    ----------
    bearing : JournalBearing or None
        Both bearings; None for one ideal revolute joint.
    elastic : bool
        Rocker of beams, or one rigid body.
    """

    def __init__(self, *, bearing: ehd.JournalBearing | None, elastic: bool) -> None:
        self.mbs = mbs = exu.SystemContainer().AddSystem()
        self.start = dead_centre()
        self.joints: list[ehd.LubricatedJoint] = []
        self.reaction = None
        ground = mbs.AddObject(eii.ObjectGround())
        build = self._elastic if elastic else self._rigid
        journals, ball, tool = build(swing(self.start))
        if bearing is None:
            bed = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground))
            pin = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journals[0]))
            joint = mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=[bed, pin], constrainedAxes=[1, 1, 1, 0, 1, 1]))
            self.reaction = self._sensor(eii.SensorObject, "ForceLocal", objectNumber=joint)
        else:
            for name, item, x in zip(("left", "right"), journals, (0.0, SPAN), strict=True):
                self.joints.append(
                    ehd.CreateLubricatedJoint(
                        mbs,
                        name=name,
                        itemNumbers=[ground, item],
                        position=[x, 0, 0],
                        rotationMatrixAxes=AXES,
                        bearing=bearing,
                    )
                )
            self._constrain(self.axial_node, 0)
        pin = mbs.AddNode(
            eii.NodePoint(referenceCoordinates=crank_pin(self.start), initialVelocities=self._pin_velocity(0.0))
        )
        mass = mbs.AddObject(eii.ObjectMassPoint(nodeNumber=pin, mass=0.1))
        for k in range(3):
            self._constrain(
                pin,
                k,
                offsetUserFunction=lambda mbs, t, item, offset, k=k: self._pin_displacement(t)[k],
                offsetUserFunction_t=lambda mbs, t, item, offset, k=k: self._pin_velocity(t)[k],
            )
        ends = [mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=mass)), ball]
        mbs.AddObject(eii.ObjectConnectorDistance(markerNumbers=ends, distance=COUPLER))
        self.tool = self._sensor(eii.SensorMarker, "Position", markerNumber=tool)
        mbs.Assemble()

    def _pin_displacement(self, t: float) -> np.ndarray:
        return crank_pin(self.start + SPEED * t) - crank_pin(self.start)

    def _pin_velocity(self, t: float) -> np.ndarray:
        angle = self.start + SPEED * t
        return SPEED * CRANK * np.array([-math.sin(angle), 0.0, math.cos(angle)])

    def _sensor(self, kind, name: str, **what):
        output = getattr(exu.OutputVariableType, name)
        return self.mbs.AddSensor(kind(storeInternal=True, outputVariableType=output, **what))

    def _constrain(self, node, coordinate: int, **drive) -> None:
        mbs = self.mbs
        markers = [
            mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0)),
            mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)),
        ]
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers, **drive))

    def _rigid(self, alpha: float):
        mbs, radius = self.mbs, 0.5 * DIAMETER
        x = SPAN + OVERHANG
        inertia = InertiaCylinder(DENSITY, x, radius, axis=0).Translated([0.5 * x, 0, 0])
        inertia += InertiaCylinder(DENSITY, ARM, radius, axis=1).Translated([x, 0.5 * ARM, 0])
        inertia += InertiaMassPoint(TOOL_MASS).Translated([x, ARM, 0])
        turn = np.array([[1, 0, 0], [0, math.cos(alpha), -math.sin(alpha)], [0, math.sin(alpha), math.cos(alpha)]])
        made = mbs.CreateRigidBody(
            inertia=inertia, referenceRotationMatrix=turn, nodeType=exu.NodeType.RotationRxyz, returnDict=True
        )
        body, self.axial_node = made["bodyNumber"], made["nodeNumber"]
        ball = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0.5 * ARM, 0]))
        tool = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[x, ARM, 0]))
        return (body, body), ball, tool

    def _elastic(self, alpha: float):
        mbs, data = self.mbs, section()
        end = SPAN + OVERHANG
        first = np.linspace(0.0, SPAN, SPAN_ELEMENTS + 1)
        second = np.linspace(SPAN, end, OVERHANG_ELEMENTS + 1)[1:]
        shaft = [[x, 0.0, 0.0, alpha, 0.0, 0.0] for x in (*first, *second)]
        along = np.linspace(0.0, ARM, ARM_ELEMENTS + 1)
        # the arm's own x is y of the turned rocker
        arm = [[end, y * math.cos(alpha), y * math.sin(alpha), alpha, 0.0, 0.5 * math.pi] for y in along]
        chains = [[mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=q)) for q in chain] for chain in (shaft, arm)]
        for nodes, chain in zip(chains, (shaft, arm), strict=True):
            for k in range(len(nodes) - 1):
                length = float(np.linalg.norm(np.subtract(chain[k + 1][:3], chain[k][:3])))
                mbs.AddObject(
                    eii.ObjectBeamGeometricallyExact(nodeNumbers=nodes[k : k + 2], length=length, sectionData=data)
                )
        turned = np.eye(4)
        turned[:2, :2] = [[0.0, 1.0], [-1.0, 0.0]]
        corner = [
            mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=node, localHT=frame))
            for node, frame in ((chains[0][-1], np.eye(4)), (chains[1][0], turned))
        ]
        mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=corner, constrainedAxes=[1] * 6))
        tip = mbs.AddObject(
            eii.ObjectRigidBody(nodeNumber=chains[1][-1], mass=TOOL_MASS, inertia=[1e-9, 1e-9, 1e-9, 0, 0, 0])
        )
        ball = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=chains[1][ARM_ELEMENTS // 2]))
        tool = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=tip))
        self.axial_node = chains[0][0]
        return (chains[0][0], chains[0][SPAN_ELEMENTS]), ball, tool

    def run(self, *, turns: float, steps_per_turn: int) -> Run:
        """Integrate over a number of crank turns; from three on the journals' orbits must have closed by then."""
        period = 2.0 * math.pi / SPEED
        closes = bool(self.joints) and turns >= 3.0
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = turns * period
        settings.timeIntegration.numberOfSteps = steps = round(turns * steps_per_turn)
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
        settings.timeIntegration.verboseMode = 0
        settings.solution.sensors.writePeriod = period / steps_per_turn
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings)
        start = time.process_time()
        aim = ehd.UntilPeriodic(period=period, tolerance=0.02) if closes else None
        cycle = ehd.SolveDynamic(self.mbs, settings, until_periodic=aim)
        seconds = time.process_time() - start
        tool = self.mbs.GetSensorStoredData(self.tool)
        reaction = None if self.reaction is None else self.mbs.GetSensorStoredData(self.reaction)[:, 1:4]
        return Run(
            time=tool[:, 0],
            tool=tool[:, 1:4],
            histories=tuple(joint.history for joint in self.joints),
            reaction=reaction,
            closed=max(cycle.left, float(cycle.changes[-1])) if closes else math.nan,
            milliseconds_per_step=1e3 * seconds / steps,
        )


def tilt_by_beam_theory(run: Run, *, elastic: bool) -> np.ndarray:
    """Slopes (n, 2) of the right journal from the eccentricities and the left film's force and moment; see the story.

    Linear elements with one integration point, n between the bearings, have F s^2 (1/3 - 1/(12 n^2)) / EI in place
    of F s^2 / (3 EI).
    """
    left, right = run.histories
    chord = (right.eccentricity - left.eccentricity) / SPAN
    if not elastic:
        return chord
    force = left.force[:, :2]
    # a turn about y tilts towards x, one about x towards -y
    moment = np.column_stack([left.moment[:, 1], -left.moment[:, 0]])
    flexible = SPAN**2 * (1.0 / 3.0 - 1.0 / (12.0 * SPAN_ELEMENTS**2)) / (STEEL * INERTIA)
    return chord + force * (flexible + 1.0 / (SHEAR_FACTOR * SHEAR * AREA)) - moment * SPAN / (2.0 * STEEL * INERTIA)


def with_parallel_axes(history: ehd.JointHistory, bearing: ehd.JournalBearing) -> ehd.JointHistory:
    """A journal that can't tilt, under the load and with the spin of a recorded one."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    # 1 g: its inertia is nothing against the film's force
    node = mbs.AddNode(eii.NodeRigidBody2D(initialVelocities=[0, 0, history.motion[0, 8]]))
    journal = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=1e-3, inertia=1e-6))
    t, spin = history.time, history.motion[:, 8]
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (spin[1:] + spin[:-1]) * np.diff(t))])
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[origin, mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))],
            offsetUserFunction=lambda mbs, now, item, offset: float(np.interp(now, t, angle)),
            offsetUserFunction_t=lambda mbs, now, item, offset: float(np.interp(now, t, spin)),
        )
    )
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=journal)),
            loadVector=[0, 0, 0],
            loadVectorUserFunction=lambda mbs, now, load: [
                *(-float(np.interp(now, t, history.force[:, k])) for k in (0, 1)),
                0.0,
            ],
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="parallel", itemNumbers=[ground, journal], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = t[-1]
    settings.timeIntegration.numberOfSteps = t.size - 1
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    return joint.history


def figures(ideal: Run, run: Run, start_up: float, *, elastic: bool = False) -> dict[str, float]:
    """Numbers of one mechanism after the start-up; film and tilt of the right bearing, which is loaded most."""
    begin = start_up * 2.0 * math.pi / SPEED - 1e-9
    row = {
        "tool_deviation_um": 1e6 * float(np.linalg.norm(run.tool - ideal.tool, axis=1)[run.time >= begin].max()),
        "milliseconds_per_step": run.milliseconds_per_step,
    }
    if run.reaction is not None:
        return row | {
            "largest_reaction_N": float(np.hypot(run.reaction[:, 1], run.reaction[:, 2])[run.time >= begin].max())
        }
    left, right = run.histories
    kept = right.time >= begin
    tilt = np.hypot(*right.motion[kept, 2:4].T)
    theory = np.hypot(*(tilt_by_beam_theory(run, elastic=elastic) - right.motion[:, 2:4])[kept].T)
    return row | {
        "largest_reaction_N": float(np.hypot(*(left.force + right.force)[kept, :2].T).max()),
        "right_force_N": float(np.hypot(*right.force[kept, :2].T).max()),
        "right_tilt_urad": 1e6 * float(tilt.max()),
        "beam_theory_off_by_urad": 1e6 * float(theory.max()),
        "right_eccentricity_ratio": float(right.eccentricity_ratio[kept].max()),
        "right_minimum_film_thickness_um": 1e6 * float(right.minimum_gap[kept].min()),
        "right_peak_pressure_MPa": 1e-6 * float(right.peak_pressure[kept].max()),
    }


def _sketch(axes) -> None:
    """The mechanism at both dead centres of the rocker, the upper one in grey."""
    corner, ground = np.array([SPAN + OVERHANG, 0.0, 0.0]), np.array([SPAN + OVERHANG, 0.5 * ARM, -COUPLER])
    low = dead_centre()
    high = optimize.minimize_scalar(lambda angle: -swing(angle), bounds=(1.0, 2.5), method="bounded").x
    for angle, colours in ((high, ("0.8",) * 3), (low, ("black", "tab:blue", "tab:red"))):
        alpha = swing(angle)
        arm = np.array([0.0, math.cos(alpha), math.sin(alpha)])
        ball, pin, tip = corner + 0.5 * ARM * arm, crank_pin(angle), corner + ARM * arm
        for points, colour in zip(
            ((np.zeros(3), corner, tip), (ball, pin), (pin, ground)), (colours[0], *colours[1:]), strict=True
        ):
            axes.plot(*np.transpose(points), color=colour, lw=2.0)
        axes.plot(*np.transpose((ball, pin)), "o", color=colours[1], ms=5)
        axes.plot(*tip, "s", color=colours[0], ms=10)
    for x in (0.0, SPAN):
        axes.plot((x - 0.008, x + 0.008), (0, 0), (0, 0), color="tab:orange", lw=9, solid_capstyle="butt")
    circle = [crank_pin(angle) for angle in np.linspace(0.0, 2.0 * math.pi, 60)]
    axes.plot(*np.transpose(circle), color="0.5", lw=0.8)
    axes.plot(*np.transpose((ground - [0, 0.03, 0], ground + [0, 0.03, 0])), color="0.5", ls="-.", lw=1)
    names = (
        ("left bearing", (0.0, 0.0, 0.016)),
        ("right bearing", (SPAN - 0.06, 0.0, -0.03)),
        ("tool", tip + [0.0, 0.014, 0.0]),
        ("coupler", 0.5 * (ball + pin) + [0.0, 0.012, 0.0]),
        ("crank", ground + [0.0, 0.014, -0.024]),
    )
    for name, place in names:
        axes.text(*place, name)
    axes.set_axis_off()
    axes.set_box_aspect([np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())], zoom=1.3)
    axes.view_init(elev=18, azim=-48)
    for line in axes.lines:
        line.set_clip_on(False)
    axes.set_title("rocker at its lowest,\nat its highest in grey")


def _say_closed(fig, runs: list[Run], turns: int) -> None:
    """Title: how far the last turn is from the one before."""
    closed = max(run.closed for run in runs)
    if not math.isnan(closed):
        fig.suptitle(f"the last two of {turns} turns; the journals' orbits have closed within {closed:.1g} c")


@styled(10.0)
def draw(runs: dict[str, Run], parallel: ehd.JointHistory, start_up: float, path: pathlib.Path) -> None:
    """Load and tilt of the right bearing, its films, and the tool against the ideal mechanism."""
    begin = start_up * 2.0 * math.pi / SPEED
    before = 360.0 * math.floor(start_up)
    first = round(360.0 * start_up - before)
    end = round(math.degrees(SPEED * runs[CASES[0]].time[-1]) - before)
    colours = dict(zip(CASES[1:], ("tab:orange", "tab:blue"), strict=True))
    fig = plt.figure(figsize=(15, 8), layout="constrained")
    grid = fig.add_gridspec(2, 3, width_ratios=(0.62, 1, 1))
    _sketch(fig.add_subplot(grid[:, 0], projection="3d"))
    axes = np.array([[fig.add_subplot(grid[row, column]) for column in (1, 2)] for row in (0, 1)])

    def degrees(t: np.ndarray) -> np.ndarray:
        return np.degrees(SPEED * t) - before

    for name, colour in colours.items():
        run = runs[name]
        right = run.histories[1]
        kept = right.time >= begin
        x = degrees(right.time[kept])
        axes[0, 0].plot(x, 1e-3 * np.hypot(*right.force[kept, :2].T), color=colour, label=name)
        axes[0, 1].plot(x, 1e6 * right.motion[kept, 2], color=colour, label=f"{name}, towards y")
        axes[0, 1].plot(x, 1e6 * right.motion[kept, 3], color=colour, ls="--", label=f"{name}, towards z")
        axes[1, 0].plot(x, 1e6 * right.minimum_gap[kept], color=colour, label=f"{name}: at the edge")
        late = run.time >= begin
        difference = np.linalg.norm(run.tool - runs[CASES[0]].tool, axis=1)
        axes[1, 1].plot(degrees(run.time[late]), 1e6 * difference[late], color=colour, label=name)
    elastic = runs[CASES[2]].histories[1]
    kept, theory = elastic.time >= begin, tilt_by_beam_theory(runs[CASES[2]], elastic=True)
    axes[0, 1].plot(degrees(elastic.time[kept]), 1e6 * theory[kept], color="black", ls=":", lw=1.2)
    axes[0, 1].plot([], [], color="black", ls=":", label="beam theory, on elastic")
    kept = parallel.time >= begin
    axes[1, 0].plot(
        degrees(parallel.time[kept]),
        1e6 * parallel.minimum_gap[kept],
        color="black",
        ls=":",
        label="same load, parallel axes",
    )
    labels = (
        "force in the right bearing [kN]",
        "tilt of the right journal [µrad]",
        "minimum film thickness, right bearing [µm]",
        "tool's distance from the ideal path [µm]",
    )
    for ax, label in zip(axes.flat, labels, strict=True):
        ax.set(
            xlabel="crank angle from the rocker's dead centre [°]",
            ylabel=label,
            xlim=(first, end),
            xticks=range(first, end + 1, 90 if end == first + 360 else 180),
        )
        ax.grid(alpha=0.3)
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False, columnspacing=1.0)
    for ax in (axes[0, 0], axes[1, 0], axes[1, 1]):
        ax.set_ylim(0, None)
    _say_closed(fig, [runs[name] for name in colours], round((end + before) / 360.0))
    fig.savefig(path, dpi=85)
    plt.close(fig)


def main(
    *, quick: bool = False, output: str | pathlib.Path | None = "results/four_bar_spatial"
) -> dict[str, dict[str, float]]:
    """Compare ideal joint, rigid and elastic rocker; returns the numbers by case, parallel axes among them.

    Parameters
    ----------
    quick : bool
        One turn after half a turn of start-up in place of two after two, coarser steps and film.
    output : path or None
        Folder for the picture; None writes none.
    """
    start_up, turns, steps_per_turn = (0.5, 1.5, 300) if quick else (2.0, 4.0, 720)
    bearing = dataclasses.replace(BEARING, film=ehd.FiniteLength(n_theta=64, n_z=8)) if quick else BEARING
    print(f"spatial four-bar, {turns:g} crank turns at 1800 rpm, {steps_per_turn} steps per turn")
    print("  compiling the film's kernels (some seconds the first time, then read from the cache) ...", flush=True)
    Mechanism(bearing=bearing, elastic=False).run(turns=0.01, steps_per_turn=steps_per_turn)
    runs = {}
    for name, film, elastic in zip(CASES, (None, bearing, bearing), (False, False, True), strict=True):
        print(f"  {name} ...", flush=True)
        runs[name] = Mechanism(bearing=film, elastic=elastic).run(turns=turns, steps_per_turn=steps_per_turn)
    print("  the same load with parallel axes ...", flush=True)
    parallel = with_parallel_axes(runs[CASES[2]].histories[1], bearing)
    rows = {name: figures(runs[CASES[0]], run, start_up, elastic=name == CASES[2]) for name, run in runs.items()}
    kept = parallel.time >= start_up * 2.0 * math.pi / SPEED - 1e-9
    rows["same load, parallel axes"] = {
        "right_eccentricity_ratio": float(parallel.eccentricity_ratio[kept].max()),
        "right_minimum_film_thickness_um": 1e6 * float(parallel.minimum_gap[kept].min()),
        "right_peak_pressure_MPa": 1e-6 * float(parallel.peak_pressure[kept].max()),
    }
    print(f"\n{'after start-up':33s}" + "".join(f"{name:>26s}" for name in rows))
    for key in rows[CASES[2]]:
        print(f"{key:33s}" + "".join(f"{row[key]:26.4g}" if key in row else f"{'-':>26s}" for row in rows.values()))
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(runs, parallel, start_up, folder / "four_bar_spatial.png")
        print(f"\npicture: {folder / 'four_bar_spatial.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer turns and steps")
    main(quick=parser.parse_args().quick)
