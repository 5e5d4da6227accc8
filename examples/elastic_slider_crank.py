"""A slider-crank whose connecting rod is a chain of ANCF beams and floats on oil at both ends.

The mechanism of `slider_crank.py` at 5000 rpm (P. Flores, J. Ambrosio, Computers & Structures 82 (2004) 1359: crank
0.05 m, 0.30 kg, 1e-4 kg m2; rod 0.12 m, 0.21 kg, 2.5e-4 kg m2; slider 0.14 kg). Its rod is uniform (m l^2 / 12 = 2.5e-4
kg m2); here it is a flat steel bar of the same mass, 10 mm high in the plane of motion and 22 mm wide. Both pins:
radius 10 mm, length 20 mm, clearance 20 um, 0.02 Pa s. Four mechanisms side by side: rod rigid or elastic, pins ideal
(Exudyn's revolute joints) or lubricated.

What the elastic rod changes: its own inertia bends it by 0.09 mm to either side, more than four clearances. At the
inner dead centre it is stretched by 12 um, about the eccentricity of the gudgeon pin. The bend turns the rod's eyes by
0.14 degrees, which adds to the swing of the pins. The forces on the films come from the mechanism's inertia: orbits and
films differ from those of the rigid rod by a few per cent only, the slider's position and velocity by more.

The beam. P. Flores, "Modeling, Analysis and Simulation of 3D Elastohydrodynamic Revolute Joints in Multibody Systems",
takes the two-node element of A. A. Shabana and R. Y. Yakoub (J. Mechanical Design 123 (2001) 606): position and all
three slopes at each node, 24 coordinates, cubic along the axis, elastic forces from continuum mechanics. Exudyn's
``ObjectANCFBeam`` has position and the two slopes of the cross section, 18 coordinates for two nodes, linear along the
axis, elastic forces from section stiffnesses (tension, shear, torsion, bending) at one point in the middle against
locking. It converges quadratically: with n elements a cantilever under a force at its tip bends by 1 / (4 n^2) too
little, a simply supported beam under uniform load by 8 / (5 n^2), a tension is exact. The paper's element is cubic and
needs fewer elements, with more coordinates each; the strains of its solid's cross section stiffen it in bending
(Poisson locking), which section stiffnesses do not.

After four turns the orbits of the pins repeat within a hundredth of the clearance; otherwise the example raises an
error.

Run ``python examples/elastic_slider_crank.py``; pictures are written to ``results/elastic_slider_crank``.
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

CRANK, ROD = 0.05, 0.12
CRANK_MASS, CRANK_INERTIA = 0.30, 1e-4
ROD_MASS = 0.21
SLIDER_MASS = 0.14
SPEED = 5000.0 * 2.0 * math.pi / 60.0
STEEL, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
HEIGHT = 0.010  # of the rod, in the plane of motion
WIDTH = ROD_MASS / (DENSITY * ROD * HEIGHT)
SHEAR_FACTOR = 5.0 / 6.0
# s, Kelvin-Voigt: loss factor 0.002 at the crank's frequency, 0.04 at the rod's first bending, 0.2 at its stretching
DAMPING_TIME = 4e-6
BEARING = ehd.JournalBearing(
    journal_radius=0.010, length=0.020, radial_clearance=20e-6, lubricant=ehd.Lubricant(viscosity=0.02)
)
# Factor of the bend in the sketch.
ENLARGED = 150.0
CASES = ("ideal pins, rigid rod", "ideal pins, elastic rod", "oil, rigid rod", "oil, elastic rod")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Run:
    """One simulated mechanism; arrays over the recorded instants.

    ``angle`` crank angle (rad); ``slider``, ``velocity``, ``acceleration`` (m, m/s, m/s2); ``deflection`` of the rod's
    middle from the chord between its ends and ``stretch`` of that chord (m), zero for the rigid rod; ``histories`` of
    the joints, crank pin first; ``closed`` how far their last turn is from the one before and from the limit, over the
    clearance, nan for less than four turns and for ideal joints.
    """

    angle: np.ndarray
    slider: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    deflection: np.ndarray
    stretch: np.ndarray
    histories: tuple[ehd.JointHistory, ...]
    closed: float
    steps: int
    milliseconds_per_step: float


def section() -> exu.BeamSection:
    """Section data of the rod: y in the plane of motion, z along the pins."""
    area, iy, iz = HEIGHT * WIDTH, HEIGHT * WIDTH**3 / 12.0, WIDTH * HEIGHT**3 / 12.0
    shear = STEEL / (2.0 * (1.0 + POISSON))
    # Saint-Venant's torsion of a rectangle, first term of the series
    torsion = WIDTH * HEIGHT**3 / 3.0 * (1.0 - 0.63 * HEIGHT / WIDTH)
    data = exu.BeamSection()
    transverse = SHEAR_FACTOR * shear * area
    stiffness = np.diag([STEEL * area, transverse, transverse, shear * torsion, STEEL * iy, STEEL * iz])
    data.stiffnessMatrix = stiffness
    data.dampingMatrix = DAMPING_TIME * stiffness
    data.inertia = DENSITY * np.diag([iy + iz, iy, iz])
    data.massPerLength = DENSITY * area
    return data


class Mechanism:
    """The slider-crank in Exudyn, at its outer dead centre and at full speed.

    Parameters
    ----------
    elements : int
        Beams of the rod, an even number; 0 for a rigid rod.
    bearing : JournalBearing or None
        Of both pins of the rod; None for ideal joints.
    """

    def __init__(self, *, elements: int, bearing: ehd.JournalBearing | None) -> None:
        self.mbs = exu.SystemContainer().AddSystem()
        self.joints: list[ehd.LubricatedJoint] = []
        self.rod_nodes: list = []
        mbs = self.mbs
        origin = mbs.AddNode(eii.NodePointGround())
        self.origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=origin, coordinate=0))
        crank_node, crank = self._planar(CRANK_MASS, CRANK_INERTIA, CRANK / 2, SPEED * CRANK / 2, SPEED)
        self.slider_node, slider = self._planar(SLIDER_MASS, 1e-4, CRANK + ROD, 0.0, 0.0)
        ground = mbs.AddObject(eii.ObjectGround())
        self._revolute(self._marker(ground, 0.0), self._marker(crank, -CRANK / 2), planar=True)
        for coordinate in (1, 2):
            self._constrain(self.slider_node, coordinate)
        self._constrain(crank_node, 2, SPEED)
        ends = self._elastic_rod(elements) if elements else self._rigid_rod()
        pins = (crank, CRANK / 2), (slider, 0.0)
        for name, end, (body, x) in zip(("crank pin", "gudgeon pin"), ends, pins, strict=True):
            pin = self._marker(body, x)
            if bearing is None:
                # the crank pin keeps the three-dimensional rod in the plane
                self._revolute(pin, end, planar=not elements or name == "gudgeon pin")
            else:
                self.joints.append(
                    ehd.CreateLubricatedJoint(mbs, name=name, itemNumbers=[end, pin], axis=[0, 0, 1], bearing=bearing)
                )
        if elements and bearing is not None:
            # a thrust collar: films let the rod slide along its pins
            self._constrain(self.rod_nodes[0], 2)
        self.sensors = [self._sensor(self.slider_node, name) for name in ("Displacement", "Velocity", "Acceleration")]
        rod = [self.rod_nodes[k] for k in (0, elements // 2, elements)] if elements else []
        self.rod_sensors = [self._sensor(node, "Position") for node in rod]
        mbs.Assemble()

    def _planar(self, mass: float, inertia: float, x: float, speed: float, spin: float):
        node = self.mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[x, 0, 0], initialVelocities=[0, speed, spin]))
        return node, self.mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))

    def _marker(self, body, x: float):
        return self.mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0, 0]))

    def _constrain(self, node, coordinate: int, speed: float = 0.0) -> None:
        moved = self.mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        drive = {}
        if speed:
            drive = {
                "offsetUserFunction": lambda mbs, t, item, offset: speed * t,
                "offsetUserFunction_t": lambda mbs, t, item, offset: speed,
            }
        self.mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[self.origin, moved], **drive))

    def _revolute(self, first, second, *, planar: bool) -> None:
        axes = [1, 1, 0, 0, 0, 0] if planar else [1, 1, 1, 1, 1, 0]
        self.mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=[first, second], constrainedAxes=axes))

    def _sensor(self, node, name: str):
        kind = getattr(exu.OutputVariableType, name)
        return self.mbs.AddSensor(eii.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind))

    def _rigid_rod(self):
        inertia = ROD_MASS * ROD**2 / 12.0
        _, rod = self._planar(ROD_MASS, inertia, CRANK + ROD / 2, SPEED * CRANK / 2, -SPEED * CRANK / ROD)
        return self._marker(rod, -ROD / 2), self._marker(rod, ROD / 2)

    def _elastic_rod(self, elements: int):
        mbs, length = self.mbs, ROD / elements
        spin = -SPEED * CRANK / ROD
        for k in range(elements + 1):
            x = k * length
            # slope of y (0, 1, 0) turns with the rod; slope of z stays
            velocity = [0, SPEED * CRANK + spin * x, 0, -spin, 0, 0, 0, 0, 0]
            self.rod_nodes.append(
                mbs.AddNode(
                    eii.NodePointSlope23(
                        referenceCoordinates=[CRANK + x, 0, 0, 0, 1, 0, 0, 0, 1], initialVelocities=velocity
                    )
                )
            )
        data = section()
        beams = [
            mbs.AddObject(eii.ObjectANCFBeam(nodeNumbers=list(pair), length=length, sectionData=data))
            for pair in zip(self.rod_nodes[:-1], self.rod_nodes[1:], strict=True)
        ]
        return self._marker(beams[0], -length / 2), self._marker(beams[-1], length / 2)

    def run(self, *, turns: float, steps_per_turn: int) -> Run:
        """Integrate over a number of crank turns; from four on the orbits of the pins must have closed by then."""
        period = 2.0 * math.pi / SPEED
        closes = bool(self.joints) and turns >= 4.0
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = turns * period
        settings.timeIntegration.numberOfSteps = steps = round(turns * steps_per_turn)
        # damps the rod's stretching at 8 kHz, which the sudden start excites and the steps do not resolve
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
        # the strains of an ANCF beam's cross section have no mass of their own: its mass matrix is singular
        settings.timeIntegration.generalizedAlpha.computeInitialAccelerations = False
        settings.timeIntegration.verboseMode = 0
        settings.solution.sensors.writePeriod = period / steps_per_turn
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings)
        start = time.process_time()
        aim = ehd.UntilPeriodic(period=period, tolerance=0.01) if closes else None
        cycle = ehd.SolveDynamic(self.mbs, settings, until_periodic=aim)
        seconds = time.process_time() - start
        displacement, velocity, acceleration = (self.mbs.GetSensorStoredData(s) for s in self.sensors)
        deflection, stretch = np.zeros((2, displacement.shape[0]))
        if self.rod_nodes:
            first, middle, last = (self.mbs.GetSensorStoredData(s)[:, 1:3] for s in self.rod_sensors)
            chord = last - first
            size = np.hypot(*chord.T)
            offset = middle - 0.5 * (first + last)
            deflection = (chord[:, 0] * offset[:, 1] - chord[:, 1] * offset[:, 0]) / size
            stretch = size - ROD
        return Run(
            angle=SPEED * displacement[:, 0],
            slider=CRANK + ROD + displacement[:, 1],
            velocity=velocity[:, 1],
            acceleration=acceleration[:, 1],
            deflection=deflection,
            stretch=stretch,
            histories=tuple(joint.history for joint in self.joints),
            closed=max(cycle.left, float(cycle.changes[-1])) if closes else math.nan,
            steps=steps,
            milliseconds_per_step=1e3 * seconds / steps,
        )


def rod_by_beam_theory(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Deflection of the middle and stretch of the rod (m) from the ideal mechanism's accelerations, quasi-static.

    The rod carries -m a per length, with an acceleration a that is linear along it. Across: a simply supported beam
    with bending and shear, 5 q l^4 / (384 EI) + q l^2 / (8 k GA), q the load in the middle (the antisymmetric rest does
    not move it), enlarged by 1 / (1 + N / P) under the tension N in the middle, P = pi^2 EI / l^2. Along: the integral
    of the tension over EA.
    """
    psi = -np.arcsin(CRANK / ROD * np.sin(angle))
    psi_t = -CRANK / ROD * SPEED * np.cos(angle) / np.cos(psi)
    psi_tt = (CRANK / ROD * SPEED**2 * np.sin(angle) + psi_t**2 * np.sin(psi)) / np.cos(psi)
    along, across = np.array([np.cos(psi), np.sin(psi)]), np.array([-np.sin(psi), np.cos(psi)])
    crank_pin = -CRANK * SPEED**2 * np.array([np.cos(angle), np.sin(angle)])
    slider = crank_pin + ROD * (psi_tt * across - psi_t**2 * along)
    mass, slider_force = ROD_MASS / ROD, -SLIDER_MASS * slider[0]

    def parts(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return (crank_pin * direction).sum(axis=0), (slider * direction).sum(axis=0)

    (a_crank, a_slider), (n_crank, n_slider) = parts(along), parts(across)
    # the slider pulls at the rod with its inertia along the guide; moments about the crank pin give the other component
    guide_force = (mass * ROD * (n_crank / 6.0 + n_slider / 3.0) + slider_force * np.sin(psi)) / np.cos(psi)
    pull = slider_force * np.cos(psi) + guide_force * np.sin(psi)
    tension_middle = pull - mass * ROD * (a_crank / 8.0 + 3.0 * a_slider / 8.0)
    tension_mean = pull - mass * ROD * (a_crank / 6.0 + a_slider / 3.0)
    area, inertia = HEIGHT * WIDTH, WIDTH * HEIGHT**3 / 12.0
    shear = SHEAR_FACTOR * STEEL / (2.0 * (1.0 + POISSON)) * area
    compliance = 5.0 * ROD**4 / (384.0 * STEEL * inertia) + ROD**2 / (8.0 * shear)
    critical = math.pi**2 * STEEL * inertia / ROD**2
    deflection = -0.5 * mass * (n_crank + n_slider) * compliance / (1.0 + tension_middle / critical)
    return deflection, tension_mean * ROD / (STEEL * area)


def _late(run: Run, start_up: float) -> np.ndarray:
    """Recorded instants after the start-up, with a rounding's tolerance on the angle."""
    return run.angle >= 2.0 * math.pi * start_up - 1e-6


def figures(ideal: Run, run: Run, start_up: float) -> dict[str, float]:
    """Numbers of the table, over the turns after the start-up."""
    late, first = _late(run, start_up), start_up * 2.0 * math.pi / SPEED - 1e-9

    def deviation(name: str) -> float:
        return float(np.abs(getattr(run, name) - getattr(ideal, name))[late].max())

    row = {
        "slider_position_um": 1e6 * deviation("slider"),
        "slider_velocity_mm_s": 1e3 * deviation("velocity"),
        "slider_acceleration_m_s2": deviation("acceleration"),
        "rod_deflection_um": 1e6 * float(np.abs(run.deflection[late]).max()),
        "rod_stretch_um": 1e6 * float(run.stretch[late].max()),
    }
    for name, h in zip(("crank_pin", "gudgeon_pin"), run.histories, strict=False):
        kept = h.time >= first
        row |= {
            f"{name}_force_N": float(np.hypot(*h.force[kept].T[:2]).max()),
            f"{name}_eccentricity_ratio": float(h.eccentricity_ratio[kept].max()),
            f"{name}_minimum_film_thickness_um": 1e6 * float(h.minimum_gap[kept].min()),
            f"{name}_peak_pressure_MPa": 1e-6 * float(h.peak_pressure[kept].max()),
        }
    return row | {"milliseconds_per_step": run.milliseconds_per_step}


def print_table(rows: dict[str, dict[str, float]]) -> None:
    """Results side by side."""
    print(f"\n{'after start-up; slider against ideal':38s}" + "".join(f"{name:>25s}" for name in rows))
    for key in rows[CASES[-1]]:
        print(f"{key:38s}" + "".join(f"{row[key]:25.4g}" if key in row else f"{'-':>25s}" for row in rows.values()))


def _draw_rod(ax, elastic: Run, late: np.ndarray, degrees: np.ndarray) -> None:
    """Bending and stretch of the rod against beam theory."""
    bent, stretched = rod_by_beam_theory(elastic.angle)
    pairs = (
        ("bending", elastic.deflection, bent, "tab:blue"),
        ("stretch", elastic.stretch, stretched, "tab:red"),
    )
    for label, simulated, theory, colour in pairs:
        ax.plot(degrees, 1e6 * simulated[late], color=colour, label=label)
        ax.plot(degrees, 1e6 * theory[late], color="black", ls=":", lw=1.2, label=None)
    ax.plot([], [], color="black", ls=":", label="beam theory")
    ax.set(ylabel="deformation of the rod [µm]")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)


def _sketch(ax, elastic: Run, late: np.ndarray) -> None:
    """The mechanism where its rod is bent most, with the bend enlarged, and the rigid rod in grey."""
    most = np.flatnonzero(late)[np.argmax(np.abs(elastic.deflection[late]))]
    angle, bend = float(elastic.angle[most]), float(elastic.deflection[most])
    pin = CRANK * np.array([math.cos(angle), math.sin(angle)])
    slider = np.array([pin[0] + math.sqrt(ROD**2 - pin[1] ** 2), 0.0])
    along = (slider - pin) / ROD
    share = np.linspace(0.0, 1.0, 60)
    chord = pin + share[:, None] * (slider - pin)
    bent = chord + ENLARGED * bend * np.sin(np.pi * share)[:, None] * np.array([-along[1], along[0]])
    around = np.linspace(0.0, 2.0 * np.pi, 100)
    ax.plot(*(CRANK * np.array([np.cos(around), np.sin(around)])), color="0.8", lw=0.8)
    ax.plot([-0.07, 0.19], [0.0, 0.0], color="0.8", lw=0.8, ls="-.")
    ax.plot(*chord.T, color="0.7", lw=2)
    ax.plot(*bent.T, color="tab:blue", lw=3)
    ax.plot(*np.transpose([(0.0, 0.0), pin]), color="black", lw=3)
    ax.plot(0.0, 0.0, "o", color="black", mfc="white", ms=8)
    ax.plot(*slider, "s", color="0.4", ms=22)
    for place, name, shift, colour in (
        (pin, "crank pin, on oil", (-0.008, 0.002), "tab:purple"),
        (slider, "gudgeon pin, on oil", (0.022, 0.012), "tab:brown"),
    ):
        ax.plot(*place, "o", color=colour, ms=9)
        ax.text(*(place + shift), name, color=colour, ha="right" if shift[0] < 0.0 else "left", va="bottom")
    ax.text(*(0.5 * pin + [-0.006, 0.0]), "crank, 5000 rpm", ha="right")
    ax.text(*(slider + [0.022, -0.006]), "slider", color="0.4", va="top")
    middle = bent[len(bent) // 2] + (0.012, 0.012 if bend > 0.0 else -0.022)
    ax.text(*middle, f"rod, bent by {1e6 * abs(bend):.0f} µm (drawn {ENLARGED:.0f} times)", color="tab:blue")
    ax.set(aspect="equal", xlim=(-0.2, 0.36))
    ax.set_axis_off()


def _closed(runs: list[Run]) -> str:
    """Second line of a title: how far the last turn is from the one before."""
    largest = max(run.closed for run in runs)
    return "" if math.isnan(largest) else f",\nclosed within {largest:.1g} c"


@styled(10.0)
def draw(runs: dict[str, Run], start_up: float, path: pathlib.Path) -> None:
    """Slider against the ideal mechanism, the rod against beam theory, pins and films."""
    ideal, names = runs[CASES[0]], CASES[1:]
    colours = dict(zip(names, ("tab:green", "tab:orange", "tab:blue"), strict=True))
    styles = dict(zip(names, ("-", "-", "--"), strict=True))
    before = 360.0 * math.floor(start_up)
    begin, end = round(360.0 * start_up - before), round(math.degrees(ideal.angle[-1]) - before)
    fig = plt.figure(figsize=(14, 10), layout="constrained")
    grid = fig.add_gridspec(3, 3, height_ratios=(0.55, 1.0, 1.0))
    axes = np.array([[fig.add_subplot(grid[row, column]) for column in range(3)] for row in (1, 2)])
    late = _late(ideal, start_up)
    _sketch(fig.add_subplot(grid[0, :]), runs[CASES[3]], late)
    degrees = np.degrees(ideal.angle[late]) - before
    shown = (
        ("slider", 1e6, "position [µm]"),
        ("velocity", 1e3, "velocity [mm/s]"),
        ("acceleration", 1.0, "acceleration [m/s²]"),
    )
    for ax, (quantity, unit, label) in zip(axes[0], shown, strict=True):
        for name in names:
            difference = getattr(runs[name], quantity) - getattr(ideal, quantity)
            ax.plot(degrees, unit * difference[late], color=colours[name], ls=styles[name], label=name, lw=1.3)
        ax.set(ylabel=f"slider {label} - rigid ideal")
    axes[0, 1].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)

    _draw_rod(axes[1, 0], runs[CASES[3]], late, degrees)
    around = np.linspace(0, 2 * np.pi, 200)
    axes[1, 1].plot(np.cos(around), np.sin(around), color="grey", lw=1)
    for name in CASES[2:]:
        for joint, colour, h in zip(
            ("crank pin", "gudgeon pin"), ("tab:purple", "tab:brown"), runs[name].histories, strict=True
        ):
            kept = h.time >= start_up * 2.0 * math.pi / SPEED
            style = {"color": colour, "ls": "-" if name == CASES[2] else "--", "lw": 1.3}
            label = f"{joint}, {name.split(', ')[1]}"
            axes[1, 1].plot(*(h.eccentricity[kept].T / BEARING.radial_clearance), **style, label=label)
            axes[1, 2].plot(np.degrees(SPEED * h.time[kept]) - before, 1e6 * h.minimum_gap[kept], **style)
    axes[1, 1].set(
        xlabel="x / c (along the rod) [-]",
        ylabel="y / c [-]",
        aspect="equal",
        title="pins in the rod's eyes\n(elastic over rigid rod)" + _closed([runs[name] for name in CASES[2:]]),
    )
    axes[1, 1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, frameon=False)
    axes[1, 2].set(ylabel="minimum film thickness [µm]", ylim=(0, None))
    for ax in (*axes[0], axes[1, 0], axes[1, 2]):
        ax.set(
            xlabel="crank angle [°]",
            xlim=(begin, end),
            xticks=range(begin, end + 1, 90 if end == begin + 360 else 180),
        )
        ax.grid(alpha=0.3)
    fig.savefig(path, dpi=90)
    plt.close(fig)


def main(
    *, quick: bool = False, output: str | pathlib.Path | None = "results/elastic_slider_crank"
) -> dict[str, dict[str, float]]:
    """Compare the four mechanisms; returns the table's numbers by case, and those of beam theory.

    Parameters
    ----------
    quick : bool
        One turn after half a turn of start-up in place of two after two, coarser steps, film and rod.
    output : path or None
        Folder for the picture; None writes none.
    """
    start_up, turns, steps_per_turn, elements = (0.5, 1.5, 360, 4) if quick else (2.0, 4.0, 720, 8)
    bearing = dataclasses.replace(BEARING, film=ehd.FiniteLength(n_theta=64, n_z=6)) if quick else BEARING
    print(f"elastic slider-crank, {turns:g} turns at 5000 rpm, {steps_per_turn} steps per turn")
    print("  compiling the film's kernels (some seconds the first time, then read from the cache) ...", flush=True)
    Mechanism(elements=0, bearing=bearing).run(turns=0.01, steps_per_turn=steps_per_turn)
    runs = {}
    models = ((0, None), (elements, None), (0, bearing), (elements, bearing))
    for name, (count, film) in zip(CASES, models, strict=True):
        print(f"  {name} ...", flush=True)
        runs[name] = Mechanism(elements=count, bearing=film).run(turns=turns, steps_per_turn=steps_per_turn)
    rows = {name: figures(runs[CASES[0]], run, start_up) for name, run in runs.items()}
    bent, stretched = rod_by_beam_theory(runs[CASES[0]].angle)
    rows["beam theory"] = {
        "rod_deflection_um": 1e6 * float(np.abs(bent).max()),
        "rod_stretch_um": 1e6 * float(stretched.max()),
    }
    # what linear elements with one integration point make of a distributed load, see the story
    on_mesh = 1.0 - 1.6 / elements**2
    rows["beam theory on this mesh"] = rows["beam theory"] | {
        "rod_deflection_um": on_mesh * rows["beam theory"]["rod_deflection_um"]
    }
    print_table(rows)
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(runs, start_up, folder / "elastic_slider_crank.png")
        print(f"\npicture: {folder / 'elastic_slider_crank.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer turns and steps")
    main(quick=parser.parse_args().quick)
