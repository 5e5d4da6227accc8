"""Runs that mix four to nine effects over cycles of load, drawn at random: which of them stop, and where.

``python -m tests.fuzz.mixed_runs KIND FIRST COUNT`` prints one line per run. A stop is physics only if a finer step
meets it too (``run(seed, kind, finer=4)``), or if a simpler film or a bore that deflects carries the same load.
"""

from __future__ import annotations

import dataclasses
import math
import sys
import time
import warnings

import exudyn as exu
import exudyn.itemInterface as eii
import exudyn.utilities as eut
import numpy as np
from exudyn.FEM import ObjectFFRFreducedOrderInterface

import exudyn_ehd as ehd
from tests.finite_elements import fem_of

# Numbers of their random streams.
KINDS = {"rigid": 0, "liner": 1, "modal": 2, "nodal": 4, "tilted": 5, "body": 6}
CYCLES = {"rigid": 2.0, "liner": 2.0, "modal": 1.0, "nodal": 0.5, "tilted": 1.0, "body": 0.5}
STEPS = 200
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
BRONZE = ehd.SaintVenantKirchhoff(youngs_modulus=1.0e11, poisson_ratio=0.34, density=8800.0)
POLYMER = ehd.SaintVenantKirchhoff(youngs_modulus=3.0e9, poisson_ratio=0.38, density=1400.0)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Scene:
    """Random scene made from one seed.

    Attributes
    ----------
    bearing : JournalBearing
    drive : str
        "rotor", "swing", "crank", or "tilted": a rotor with a load beside the mid-plane.
    speed : float
        Mean spin, of a crank its own, rad/s.
    load : float
        Largest load, N.
    """

    bearing: ehd.JournalBearing
    drive: str
    speed: float
    load: float


def _bush(rng, kind, radius, clearance, length):
    material = [STEEL, BRONZE, POLYMER][rng.integers(3)]
    if kind in ("rigid", "tilted"):
        return None
    if kind == "liner":
        return ehd.ElasticLiner(
            thickness=float(rng.choice([3e-4, 1e-3, 2e-3])), youngs_modulus=float(rng.choice([2e9, 1e10, 6e10]))
        )
    nodal = kind == "nodal"
    mesh = ehd.HollowCylinder(
        inner_radius=radius + clearance,
        thickness=float(rng.uniform(0.15, 0.4)) * radius,
        length=length,
        axial=1 if nodal else 2,
        radial=1,
        circumferential=8 if nodal else 16,
    )
    if nodal:
        return ehd.ANCFBush(mesh=mesh, material=material)
    if kind == "body":
        solid = mesh.mesh()
        fem = fem_of(solid, material)
        place = {"position": [0, 0, 0], "axis": [0, 0, 1], "radius": radius + clearance, "length": length}
        ehd.add_bore_modes(fem, **place, fixed_nodes=solid.outer.nodes, tolerance=0.1)
        return ehd.FEBore(fem=fem)
    return ehd.ModalBush(
        mesh=mesh,
        material=material,
        tolerance=float(rng.choice([0.05, 0.1])),
        tilted=bool(rng.integers(2)),
    )


def _options(rng, radius, length, clearance, sigma):
    """Groups of effects; one of a group at most."""
    pressure = float(rng.choice([5e-9, 1e-8, 2e-8]))
    angle, feed = float(rng.uniform(0, 2 * math.pi)), float(rng.choice([0.0, 1e5, 4e5]))
    return [
        [
            ("pressure_law", ehd.BarusPressure(coefficient=pressure)),
            ("pressure_law", ehd.RoelandsPressure(coefficient=pressure)),
        ],
        [("shear_law", ehd.CarreauShear(relaxation_time=float(rng.choice([1e-7, 2e-6])), exponent=0.75, residual=0.3))],
        [("density_law", ehd.DowsonHigginson())],
        [
            ("supply", (ehd.AxialGroove(angle=angle, width_angle=0.5, length=0.7 * length, pressure=feed),)),
            ("supply", (ehd.Hole(angle=angle, diameter=0.35 * radius, pressure=feed, rotating=True),)),
            ("supply", (ehd.Hole(angle=angle, diameter=0.35 * radius, pressure=feed),)),
            ("supply", (ehd.Pocket(angle=angle, width_angle=0.6, length=0.5 * length, pressure=feed),)),
            ("supply", (ehd.CircumferentialGroove(width=0.25 * length, pressure=feed),)),
        ],
        [("roughness", ehd.PatirCheng(composite_roughness=sigma, pattern=float(rng.choice([1.0, 3.0, 1 / 3]))))],
        [
            ("thermal", ehd.LumpedThermal(supply_temperature=333.15, capacity=float(rng.choice([0.0, 5.0])))),
            ("thermal", ehd.FilmEnergy(supply_temperature=333.15, bush_coefficient=2e4, journal_coefficient=2e4)),
            ("thermal", ehd.FilmEnergy(supply_temperature=333.15, bush_coefficient=2e4, conductivity=0.13)),
        ],
        [
            ("profile", (ehd.Crown(drop=0.1 * clearance), ehd.OutOfRound(amplitude=0.05 * clearance, order=2))),
            ("profile", ehd.EdgeRelief(drop=0.2 * clearance, relief_length=0.2 * length)),
        ],
        [("wear", ehd.ArchardWear(wear_rate=1e-16, acceleration=1e4))],
        [("end_pressures", (float(rng.choice([0.0, 1e5])), 3e4))],
    ]


def draw(seed: int, kind: str) -> Scene:
    """A scene of sizes that are built, with four to nine effects; what a bearing refuses is drawn anew."""
    rng = np.random.default_rng([seed, KINDS[kind]])
    while True:
        radius = float(rng.choice([0.01, 0.02, 0.03]))
        length = radius * float(rng.choice([0.7, 1.0, 1.6]))
        clearance = radius * float(rng.choice([8e-4, 1.2e-3]))
        sigma = float(rng.choice([3e-7, 8e-7]))
        groups = _options(rng, radius, length, clearance, sigma)
        options: dict = {}
        laws: dict = {}
        for k in rng.permutation(len(groups))[: rng.integers(3, 9)]:
            name, value = groups[k][rng.integers(len(groups[k]))]
            (laws if name.endswith("_law") else options)[name] = value
        modulus = float(rng.choice([2e10, 1e11]))
        options["asperity"] = ehd.GreenwoodTripp(composite_roughness=sigma, composite_modulus=modulus)
        if rng.random() < 0.15 and "wear" not in options and "roughness" not in options:
            del options["asperity"]
            options["contact"] = ehd.RegularisedWall(onset=3.0 * sigma, pressure=float(rng.choice([1e9, 1e10])))
        closures = [
            ehd.ElrodAdams(cavity_pressure=-5e4),
            ehd.ElrodAdams(cavity_pressure=-1e5),
            ehd.SwiftStieber(cavity_pressure=-5e4),
            ehd.SwiftStieber(),
            ehd.Gumbel(),
        ]
        grid = [(48, 6), (64, 8), (45, 6)][rng.integers(3)]
        speed = float(rng.choice([100.0, 300.0]))
        mean_pressure = float(rng.choice([1e6, 4e6, 12e6]))
        drive = ("rotor", "swing", "crank")[rng.integers(3)]
        if kind == "tilted" or (kind == "body" and drive == "crank"):
            drive = "tilted"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                bearing = ehd.JournalBearing(
                    journal_radius=radius,
                    length=length,
                    radial_clearance=clearance,
                    lubricant=dataclasses.replace(
                        ehd.oil(("ISO VG 32", "ISO VG 100", "SAE 5W-30")[rng.integers(3)], temperature=343.15), **laws
                    ),
                    film=ehd.FiniteLength(n_theta=grid[0], n_z=grid[1]),
                    cavitation=closures[rng.integers(len(closures))],
                    bush=_bush(rng, kind, radius, clearance, length),
                    **options,
                )
                Model(Scene(bearing=bearing, drive=drive, speed=speed, load=1.0))
            except ehd.InputError:
                continue
        return Scene(bearing=bearing, drive=drive, speed=speed, load=2.0 * radius * length * mean_pressure)


class Model:
    """The multibody system of a scene: a rotor under a turning load, or the gudgeon pin of a crank drive."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.rate = scene, scene.speed
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        drives = {"crank": self._crank, "tilted": self._tilted}
        self.joint = drives.get(scene.drive, self._rotor)()
        self.mbs.Assemble()

    def _rotor(self):
        mbs, scene, rate = self.mbs, self.scene, self.rate
        c = scene.bearing.radial_clearance
        swings = scene.drive == "swing"
        node = mbs.AddNode(
            eii.NodeRigidBody2D(
                referenceCoordinates=[0, 0, 0],
                initialCoordinates=[0.2 * c, -0.3 * c, 0.0],
                initialVelocities=[0.0, 0.0, scene.speed],
            )
        )
        mass = 0.05 * scene.load / 9.81
        body = mbs.AddObject(
            eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=0.5 * mass * scene.bearing.journal_radius**2)
        )
        ground = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
        turned = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))

        def angle(mbs, t, item, offset):
            return scene.speed * (math.sin(rate * t) / rate if swings else t)

        def spin(mbs, t, item, offset):
            return scene.speed * (math.cos(rate * t) if swings else 1.0)

        mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[ground, turned], offsetUserFunction=angle, offsetUserFunction_t=spin
            )
        )

        mbs.CreateForce(itemNumber=body, loadVector=[0.0, 0.0, 0.0], loadVectorUserFunction=self._turning)
        return ehd.CreateLubricatedJoint(
            mbs,
            name="journal",
            itemNumbers=[self._housing(), body],
            position=[0, 0, 0],
            axis=[0, 0, 1],
            bearing=scene.bearing,
        )

    def _turning(self, mbs, t, load):
        rate = self.rate
        ramp = min(1.0, 10.0 * rate * t / (2.0 * math.pi))
        x, y = 0.5 * math.sin(rate * t), -0.7 * (1.0 - 0.4 * math.cos(rate * t))
        return [ramp * self.scene.load * x, ramp * self.scene.load * y, 0.0]

    def _housing(self):
        """Ground, or the reduced body of the bore, its frame held."""
        bush = self.scene.bearing.bush
        if not isinstance(bush, ehd.FEBore):
            return self.mbs.AddObject(eii.ObjectGround())
        parts = ObjectFFRFreducedOrderInterface(bush.fem, "NodeType.RotationRxyz").AddObjectFFRFreducedOrder(self.mbs)
        markers = [
            self.mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=self.mbs.CreateGround())),
            self.mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=parts["nRigidBody"])),
        ]
        self.mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=[1] * 6))
        return parts["oFFRFreducedOrder"]

    def _tilted(self):
        """Rotor in space with its load a tenth of the length beside the mid-plane; a torque keeps its speed."""
        mbs, scene, speed = self.mbs, self.scene, self.scene.speed
        b = scene.bearing
        c, mass, size = b.radial_clearance, 0.05 * scene.load / 9.81, 2.0 * b.journal_radius
        body = mbs.CreateRigidBody(
            inertia=eut.RigidBodyInertia(mass=mass, inertiaTensor=np.eye(3) * mass * size**2),
            initialDisplacement=[0.2 * c, -0.3 * c, 0.0],
            initialAngularVelocity=[0.0, 0.0, speed],
        )

        def drive(mbs, t, load):
            rate = mbs.GetObjectOutputBody(body, exu.OutputVariableType.AngularVelocity, [0, 0, 0])[2]
            return [0.0, 0.0, 10.0 * mass * size**2 * (speed - rate) * speed]

        mbs.CreateForce(
            itemNumber=body,
            localPosition=[0.0, 0.0, 0.1 * b.length],
            loadVector=[0.0, 0.0, 0.0],
            loadVectorUserFunction=self._turning,
        )
        mbs.CreateTorque(itemNumber=body, loadVector=[0.0, 0.0, 1.0], loadVectorUserFunction=drive)
        return ehd.CreateLubricatedJoint(
            mbs, name="journal", itemNumbers=[self._housing(), body], position=[0, 0, 0], axis=[0, 0, 1], bearing=b
        )

    def _crank(self):
        """Piston of 0.05 of the load at one g, crank of two bearing radii; gas acts around top dead centre."""
        mbs, scene, speed = self.mbs, self.scene, self.rate
        size = scene.bearing.journal_radius
        throw, rod_length = 2.0 * size, 7.0 * size
        mass = min(0.05 * scene.load / 9.81, 0.3 * scene.load / (throw * speed**2))
        ground = mbs.CreateGround()

        def body(mass, **options):
            inertia = eut.RigidBodyInertia(mass=mass, inertiaTensor=np.eye(3) * mass * (2.0 * size) ** 2)
            return mbs.CreateRigidBody(inertia=inertia, **options)

        crank = body(20.0 * mass, initialAngularVelocity=[speed, 0, 0])
        mbs.CreateRevoluteJoint(itemNumbers=[ground, crank], position=[0, 0, 0], axis=[1, 0, 0])
        end, place = np.array([0, 0, -throw]), np.array([0, 0, rod_length - throw])
        velocity, middle = np.cross([speed, 0, 0], end), np.array([0, 0, 0.3 * rod_length])
        swing = np.array([velocity[1] / rod_length, 0, 0])
        rod = body(
            mass,
            referencePosition=end + middle,
            initialVelocity=velocity + np.cross(swing, middle),
            initialAngularVelocity=swing,
        )
        piston = body(mass, referencePosition=place)
        mbs.CreatePrismaticJoint(itemNumbers=[ground, piston], position=place, axis=[0, 0, 1])
        mbs.CreateGenericJoint(itemNumbers=[rod, crank], position=end, constrainedAxes=[1, 1, 1, 0, 1, 1])
        joint = ehd.CreateLubricatedJoint(
            mbs, name="journal", itemNumbers=[rod, piston], position=place, axis=[1, 0, 0], bearing=scene.bearing
        )

        def gas(mbs, t, load):
            past = math.remainder(speed * t - math.pi, 2.0 * math.pi)
            return [0, 0, -min(1.0, 1.6 * speed * t) * scene.load * math.exp(-((past / 0.6) ** 2))]

        def drive(mbs, t, load):
            rate = mbs.GetObjectOutputBody(crank, exu.OutputVariableType.AngularVelocity, [0, 0, 0])[0]
            return [100.0 * scene.load * size / speed * (speed - rate), 0, 0]

        mbs.CreateForce(itemNumber=piston, loadVector=[0, 0, -1.0], loadVectorUserFunction=gas)
        mbs.CreateTorque(itemNumber=crank, loadVector=[1.0, 0, 0], loadVectorUserFunction=drive)
        return joint

    def run(self, cycles: float, steps: int, **options: float) -> None:
        """Integrate with the settings that the guide recommends, or others for `ConfigureSolver`."""
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = cycles * 2.0 * math.pi / self.rate
        settings.timeIntegration.numberOfSteps = round(cycles * steps)
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings, **options)
        ehd.SolveDynamic(self.mbs, settings)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """Outcome of a run: rows and smallest step over those asked for, history, and the error that ended it or None."""

    rows: float
    smallest: float
    history: ehd.JointHistory
    error: Exception | None
    warned: tuple[str, ...]
    seconds: float


def run(scene: Scene, cycles: float, *, finer: int = 1, **options: float) -> Outcome:
    """Run a scene with options for `ConfigureSolver`; only the package's own errors end it."""
    model, error, start = Model(scene), None, time.process_time()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            model.run(cycles, finer * STEPS, **options)
        except ehd.EHDError as stopped:
            error = stopped
        history = model.joint.history
    asked = cycles * finer * STEPS
    step = cycles * 2.0 * math.pi / model.rate / asked
    return Outcome(
        rows=(history.time.size - 1) / asked,
        smallest=float(np.diff(history.time).min(initial=step)) / step,
        history=history,
        error=error,
        warned=tuple(sorted({w.category.__name__ for w in caught})),
        seconds=time.process_time() - start,
    )


def words(scene: Scene) -> str:
    """A scene in one line."""
    b = scene.bearing
    laws = [type(v).__name__ for v in (b.lubricant.pressure_law, b.lubricant.shear_law, b.lubricant.density_law) if v]
    named = [b.cavitation, b.asperity, b.contact, b.roughness, b.thermal, b.wear, *b.profiles, *b.supply]
    names = [type(v).__name__ for v in named if v is not None] + laws
    return f"{scene.drive} {scene.load:.3g} N {' '.join(names)}"


def main(kind: str, first: int, count: int) -> None:
    """Print a line per run."""
    for seed in range(first, first + count):
        scene = draw(seed, kind)
        out = run(scene, CYCLES[kind])
        h, end = out.history, "ok" if out.error is None else f"STOP at row {out.history.time.size}: {out.error}"
        print(
            f"{kind} {seed}: {words(scene)} | rows {out.rows:.2f} smallest {out.smallest:.2g}, film "
            f"{1e6 * np.nanmin(h.minimum_gap):.3g} um, peak {1e-6 * np.nanmax(h.peak_pressure):.4g} MPa, "
            f"{','.join(out.warned)} {out.seconds:.1f} s | {end}",
            flush=True,
        )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
