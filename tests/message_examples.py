"""Examples for the page of messages: code of at most three lines, each raises an error or a warning."""

from typing import NamedTuple


class Setup(NamedTuple):
    """Names with which examples begin.

    Attributes
    ----------
    title : str
        What the names are.
    code : str
        Python that makes them.
    after : str
        Setup that runs before; empty for none.
    shared : bool
        Whether all examples share the objects, because none of them changes them.
    """

    title: str
    code: str
    after: str = ""
    shared: bool = True


class Group(NamedTuple):
    """Examples for messages of one kind.

    Attributes
    ----------
    title, text : str
        Heading on the page, and what stands below it.
    setup : str
        Key of `SETUPS`.
    examples : str
        Codes with an empty line between them.
    """

    title: str
    text: str
    setup: str
    examples: str


SETUPS = {
    "bearing": Setup(
        "a bearing",
        """
import dataclasses
from pathlib import Path

import numpy as np
import exudyn_ehd as ehd

oil = ehd.Lubricant(viscosity=0.02)
size = {"journal_radius": 0.025, "length": 0.025, "radial_clearance": 25e-6}
plain = {**size, "lubricant": oil}
bearing = ehd.JournalBearing(**plain)
faces = ehd.ThrustFaces(inner_radius=0.03, outer_radius=0.05, clearance=50e-6)
orifice = ehd.Orifice(diameter=5e-4, supply_pressure=4e6)
faced = ehd.JournalBearing(**plain, thrust=faces)
sector = {"inner_radius": 0.05, "outer_radius": 0.1, "pads": 8, "extent": 0.65, "pivot_radius": 0.077}
sector |= {"pivot_angle": 0.39, "clearance": 60e-6, "lubricant": oil, "pad_mass": 0.3, "pad_inertia": (6e-5, 6e-5)}
pads = ehd.TiltingThrustPads(**sector)
""",
    ),
    "film": Setup(
        "a steady film",
        """
film = ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.5)
thick = ehd.Lubricant(viscosity=0.1, pressure_law=ehd.BarusPressure(coefficient=2e-8))
""",
        "bearing",
    ),
    "model": Setup(
        "a model",
        """
import exudyn as exu
import exudyn.itemInterface as eii
from exudyn.utilities import InertiaCuboid

cube = InertiaCuboid(density=7800.0, sideLengths=[0.1, 0.1, 0.1])
turning = {"inertia": cube, "gravity": [0, -9.81, 0], "initialAngularVelocity": [0, 0, 200.0]}
turning["nodeType"] = exu.NodeType.RotationRotationVector
mbs = exu.SystemContainer().AddSystem()
ground, shaft = mbs.CreateGround(), mbs.CreateRigidBody(**turning)
sides, centre, z = [ground, shaft], [0, 0, 0], [0, 0, 1]
ball = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil)
settings = exu.SimulationSettings()
settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 10, 1e-3
settings.timeIntegration.verboseMode = 0
settings.solution.file.write = False
ehd.ConfigureSolver(settings)


def cable():
    nodes = [mbs.AddNode(eii.NodePointSlope1(referenceCoordinates=[x, 0, 0, 1, 0, 0])) for x in (0.0, 0.1)]
    stiff = {"massPerLength": 1.0, "bendingStiffness": 1e3, "axialStiffness": 1e6}
    return mbs.AddObject(eii.ObjectANCFCable(nodeNumbers=nodes, length=0.1, **stiff))


def averaged(points, weights):
    nodes = [mbs.AddNode(eii.NodePoint(referenceCoordinates=point)) for point in points]
    body = mbs.AddObject(eii.ObjectGenericODE2(nodeNumbers=nodes, massMatrix=np.eye(3 * len(nodes))))
    marker = {"meshNodeNumbers": list(range(len(nodes))), "weightingFactors": weights}
    return mbs.AddMarker(eii.MarkerSuperElementRigid(bodyNumber=body, **marker))
""",
        "bearing",
        shared=False,
    ),
    "run": Setup(
        "a model before its run",
        """
def joined(film, record=None, **motion):
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    shaft = mbs.CreateRigidBody(**turning | motion)
    joint = ehd.CreateLubricatedJoint(mbs, "main", [ground, shaft], [0, 0, 0], [0, 0, 1], film, record=record)
    mbs.Assemble()
    return mbs, shaft, joint


def slider(mbs):
    nodes = [mbs.AddNode(eii.NodePoint2DSlope1(referenceCoordinates=[x, 0, 1, 0])) for x in (0.0, 1.0)]
    stiff = {"massPerLength": 1.0, "bendingStiffness": 10.0, "axialStiffness": 1e4}
    cable = mbs.AddObject(eii.ObjectANCFCable2D(nodeNumbers=nodes, length=1.0, **stiff))
    mass = mbs.AddObject(eii.ObjectMassPoint2D(mass=0.1, nodeNumber=mbs.AddNode(eii.NodePoint2D())))
    markers = [mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=mass))]
    markers += [mbs.AddMarker(eii.MarkerBodyCable2DCoordinates(bodyNumber=cable))]
    data = mbs.AddNode(eii.NodeGenericData(initialCoordinates=[0, 0], numberOfDataCoordinates=2))
    along = {"slidingMarkerNumbers": markers[1:], "slidingMarkerOffsets": [0.0], "nodeNumber": data}
    return mbs.AddObject(eii.ObjectJointSliding2D(markerNumbers=markers, **along))


mbs, shaft, joint = joined(bearing)
""",
        "model",
        shared=False,
    ),
    "ran": Setup(
        "a model after its run",
        """
ehd.SolveDynamic(mbs, settings)
history = joint.history
""",
        "run",
    ),
    "rotor": Setup(
        "a rotor in two films",
        """
def rotor(film=bearing, axes=(0, 0, 1, 0, 0, 0), **options):
    mbs = exu.SystemContainer().AddSystem()
    ground, body = mbs.CreateGround(), mbs.CreateRigidBody(**{"inertia": cube, "gravity": [0, -9.81, 0]} | options)
    for name, z in (("left", -0.2), ("right", 0.2)):
        ehd.CreateLubricatedJoint(mbs, name, [ground, body], [0, 0, z], [0, 0, 1], film)
    mbs.CreateGenericJoint(itemNumbers=[ground, body], position=[0, 0, 0], constrainedAxes=list(axes))
    mbs.Assemble()
    return mbs, body


mbs, body = rotor()
""",
        "model",
        shared=False,
    ),
    "pads": Setup(
        "tilting pads",
        """
rocking = {**plain, "preload": 0.4, "pad_thickness": 0.01, "pad_mass": 0.1, "pad_inertia": 2e-5}
pads = ehd.TiltingPads(**rocking)
rest = ehd.equilibrium(pads, speed=300.0, load=(0.0, -1000.0))


def padded(bearing=pads, **options):
    spin = {"initialAngularVelocity": [0, 0, 200.0]} | options
    mbs = exu.SystemContainer().AddSystem()
    items = [mbs.CreateGround(), mbs.CreateRigidBody(inertia=cube, **spin)]
    joint = ehd.CreateTiltingPadBearing(mbs, "pads", items, [0, 0, 0], [0, 0, 1], bearing, axial=ehd.Held())
    mbs.Assemble()
    return mbs, joint
""",
        "model",
        shared=False,
    ),
    "bush": Setup(
        "a bush",
        """
from exudyn.FEM import FEMinterface

steel = ehd.SaintVenantKirchhoff(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0)
tube = ehd.HollowCylinder(inner_radius=0.025, thickness=0.005, length=0.025, axial=2, radial=1, circumferential=16)
mesh = tube.mesh()
fem = FEMinterface()
fem.nodes, fem.elements = {"Position": mesh.nodes}, [{"Name": "bush", "Hex20": mesh.elements}]


def write(name, *lines):
    Path(name).write_text("\\n".join(lines))
""",
        "model",
        shared=False,
    ),
    "reduced": Setup(
        "a finite-element body",
        """
from exudyn.FEM import ObjectFFRFreducedOrderInterface
from exudyn_ehd.solid.total_lagrange import TotalLagrange

solid = TotalLagrange(mesh=mesh, material=steel)
fem.stiffnessMatrix, fem.massMatrix = solid.tangent(0 * mesh.nodes).tocsr(), solid.mass.tocsr()
fem.VolumeToSurfaceElements()
bore = {"position": centre, "axis": z, "radius": 0.025, "length": 0.025, "fixed_nodes": mesh.outer.nodes}
ehd.add_bore_modes(fem, **bore, tolerance=0.2, tilted=False)
reduced = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType="NodeType.RotationRxyz")
housing = reduced.AddObjectFFRFreducedOrder(mbs)["oFFRFreducedOrder"]
wide = {**plain, "journal_radius": 0.024975}
""",
        "bush",
        shared=False,
    ),
}
GROUPS = (
    Group(
        "Describing a bearing: sizes and arguments",
        "Raised where the description is made, before anything runs.",
        "bearing",
        """
ehd.JournalBearing(journal_radius=-0.025, length=0.025, radial_clearance=25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=25.0, length=0.025, radial_clearance=25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length="25 mm", radial_clearance=25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length=float("nan"), radial_clearance=25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length=6.0, radial_clearance=25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length=0.025, radial_clearance=-25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length=0.025, radial_clearance=5e-3, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length=0.025, radial_clearance=5e-4, lubricant=oil)

ehd.JournalBearing(0.025, 0.025, 25e-6, oil)

ehd.JournalBearing(journal_radius=0.025, length=0.025, clearance=25e-6, lubricant=oil)

ehd.JournalBearing(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=0.02)

ehd.JournalBearing(**plain, cavitation="Elrod")

ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams)

ehd.JournalBearing(**plain, squeeze="yes")

ehd.JournalBearing(**plain, end_pressures=1e5)

ehd.JournalBearing(**plain, end_pressures=(0.0, "1 bar"))

ehd.JournalBearing(**plain, end_pressures=(0.0, 1e9))

ehd.SolveDynamics

ehd.JournalLeakage
""",
    ),
    Group(
        "Describing a bearing: oil",
        "Arguments of `Lubricant`, and laws of viscosity and density.",
        "bearing",
        """
ehd.Lubricant(viscosity=-0.02)

ehd.Lubricant(viscosity=20.0)

ehd.Lubricant(viscosity=1e5)

ehd.Lubricant()

ehd.Lubricant(viscosity=0.02, density=0.87)

ehd.Lubricant(viscosity=0.02, temperature=-40.0)

ehd.Lubricant(viscosity=0.02, temperature_law="Vogel")

ehd.oil("SAE 46")

ehd.oil("ISO VG 46", temperature=40.0)

oil.at(350.0)

ehd.TableViscosity(temperatures=(293.0, 313.0), viscosities=(0.04, 0.1))

table = ehd.TableViscosity(temperatures=(293.0, 333.0), viscosities=(0.1, 0.02))
ehd.Lubricant(temperature_law=table, temperature=353.0)

ehd.Lubricant(viscosity=1e-5, pressure_law=ehd.RoelandsPressure(coefficient=2e-8))

ehd.BarusPressure(coefficient=20.0)

ehd.ReynoldsTemperature(point=(313.0, 0.04), coefficient=-0.03)

ehd.ReynoldsTemperature(point=0.04, coefficient=0.03)

ehd.VogelTemperature(first=(313.0, -0.04), second=(373.0, 0.006))

ehd.VogelTemperature(first=(313.0, 0.04), second=(373.0, 0.06))

ehd.VogelTemperature(first=(313.0, 0.04), second=(373.0, 0.006), pole=320.0)

ehd.WaltherTemperature(first=(313.15, 46.0), second=(373.15, 6.8))

ehd.WaltherTemperature(first=(40.0, 46e-6), second=(100.0, 6.8e-6))

ehd.CarreauShear(relaxation_time=1e-6, exponent=1.5)
""",
    ),
    Group(
        "Describing a bearing: film and cavitation",
        "Arguments `film`, `cavitation`, `inlet`, `arc` and `turbulence` of `JournalBearing`.",
        "bearing",
        """
ehd.FiniteLength(n_theta=96.5)

ehd.FiniteLength(n_theta=4)

ehd.FiniteLength(n_theta=100_000)

ehd.FiniteLength(n_theta=10_000, n_z=10_000)

ehd.ElrodAdams(cavity_pressure=-5e5)

ehd.JournalBearing(**plain, cavitation=ehd.SwiftStieber(cavity_pressure=1e5))

liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9)
ehd.JournalBearing(**plain, cavitation=ehd.Gumbel(line_in_cells=True), bush=liner)

ehd.JournalBearing(**plain, film=ehd.ShortBearing(), bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9))

ehd.JournalBearing(**plain, film=ehd.ClassicSOR())

ehd.JournalBearing(
    **plain, film=ehd.ClassicSOR(), cavitation=ehd.Gumbel(), supply=(ehd.Hole(angle=0.0, diameter=0.005),)
)

ehd.JournalBearing(**plain, film=ehd.ClassicSOR(), cavitation=ehd.Gumbel(), turbulence=ehd.NgPan())

ehd.JournalBearing(**plain, film=ehd.LongBearing())

groove = ehd.AxialGroove(angle=0.0, width_angle=0.3, length=0.02)
ehd.JournalBearing(**plain, film=ehd.LongBearing(), supply=(groove,))

groove = ehd.AxialGroove(angle=0.0, width_angle=0.3)
ehd.JournalBearing(**plain, film=ehd.LongBearing(), supply=(groove,), end_pressures=(1e5, 1e5))

ehd.JournalBearing(**plain, film=ehd.ImpedanceMap(), cavitation=ehd.ElrodAdams())

ehd.JournalBearing(**plain, film=ehd.ImpedanceMap(), contact=ehd.RegularisedWall(onset=1e-6))

ehd.JournalBearing(
    **size, film=ehd.ImpedanceMap(), lubricant=ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson())
)

ehd.JournalBearing(
    **size, film=ehd.ClassicSOR(), cavitation=ehd.Gumbel(),
    lubricant=ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson()))

ehd.JournalBearing(**plain, arc=ehd.Arc(start=-1.0, extent=2.0), film=ehd.ShortBearing())

ehd.JournalBearing(**plain, arc=ehd.Arc(start=-1.0, extent=120.0))

ehd.JournalBearing(**plain, arcs=ehd.Arc(start=-1.0, extent=2.0))

ehd.JournalBearing(**plain, arc=ehd.Arc(start=-1.0, extent=2.0), arcs=ehd.two_lobe(preload=0.5))

ehd.JournalBearing(**plain, arcs=(ehd.Arc(start=0.0, extent=2.0), ehd.Arc(start=1.5, extent=2.0)))

ehd.JournalBearing(**plain, arcs=ehd.pressure_dam(depth=50e-6, step_angle=2.5, length=0.025))

ehd.JournalBearing(**plain, arcs=ehd.two_lobe(preload=0.5), supply=(ehd.Hole(angle=0.0, diameter=0.003),))

ehd.pressure_dam(depth=50e-6, step_angle=3.0, length=0.018)

hard = ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=2e-8))
ehd.JournalBearing(**size, lubricant=hard, turbulence=ehd.NgPan())

ehd.NgPan(onset=2000.0, full=1000.0)
""",
    ),
    Group(
        "Describing a bearing: supply and thrust faces",
        "Arguments `supply`, `end_seals` and `thrust` of `JournalBearing`.",
        "bearing",
        """
ehd.JournalBearing(**plain, supply=ehd.Hole(angle=0.0, diameter=0.005, pressure=2e5))

ehd.AxialGroove(angle=90.0, width_angle=0.3)

ehd.AxialGroove(angle=1.57, width_angle=20.0)

ehd.Hole(angle=0.0, diameter=5.0)

ehd.JournalBearing(**plain, supply=(ehd.Hole(angle=0.0, diameter=0.06),))

ehd.JournalBearing(**plain, supply=(ehd.Hole(angle=0.0, diameter=0.005, z=0.05),))

ehd.JournalBearing(**plain, supply=(ehd.Hole(angle=0.0, diameter=0.005, depth=30e-6),))

ehd.JournalBearing(**plain, supply=(ehd.AxialGroove(angle=0.015, width_angle=0.001),))

ehd.JournalBearing(**plain, supply=(ehd.Hole(angle=0.0, diameter=0.0005, rotating=True),))

groove = ehd.AxialGroove(angle=0.0, width_angle=0.3, length=0.025, pressure=2e5)
ehd.JournalBearing(**plain, supply=(groove,))

groove = ehd.CircumferentialGroove(width=0.004, z=0.0105, pressure=1e5)
ehd.JournalBearing(**plain, supply=(groove,), end_pressures=(1e5, 1e5))

holes = ehd.Hole(angle=0.0, diameter=0.006, pressure=1e5), ehd.Hole(angle=0.1, diameter=0.006, pressure=2e5)
ehd.JournalBearing(**plain, supply=holes)

ehd.JournalBearing(**plain, supply=(ehd.AxialGroove(angle=0.0, width_angle=6.2, length=0.02),))

ehd.JournalBearing(**plain, supply=(ehd.Hole(angle=0.0, diameter=0.006),), inlet=ehd.MaximumGap())

hole = ehd.Hole(angle=0.0, diameter=0.006, pressure=-1e5)
ehd.JournalBearing(**plain, supply=(hole,))

ehd.Pocket(angle=0.0, width_angle=0.5, length=0.01, supply=4e6)

ehd.Pocket(angle=0.0, width_angle=0.5, length=0.01, pressure=1e6, supply=orifice)

wide = ehd.Pocket(angle=0.0, width_angle=0.5, length=0.025, supply=orifice)
ehd.JournalBearing(**plain, supply=(wide,))

pockets = [ehd.Pocket(angle=a, width_angle=0.5, length=0.01, supply=orifice) for a in (0.0, 0.4)]
ehd.JournalBearing(**plain, supply=tuple(pockets))

low = ehd.Hole(angle=0.0, diameter=0.006, supply=ehd.Orifice(diameter=5e-4, supply_pressure=-1e5))
ehd.JournalBearing(**plain, supply=(low,))

fed = ehd.Hole(angle=0.0, diameter=0.006, supply=ehd.Capillary(diameter=5e-4, length=0.06, supply_pressure=4e6))
sump = ehd.Sump(conductance=5.0, ambient=293.15)
ehd.JournalBearing(**plain, supply=(fed,), thermal=ehd.LumpedThermal(supply_temperature=sump))

ehd.JournalBearing(**plain, end_seals=1e-10)

ehd.JournalBearing(**plain, film=ehd.ShortBearing(), end_seals=ehd.EndSeal(conductance=1e-10))

ehd.JournalBearing(**plain, end_seals=ehd.EndSeal(conductance=0.0))

groove = ehd.AxialGroove(angle=0.0, width_angle=0.3, supply=ehd.GivenFlow(flow=1e-6))
ehd.JournalBearing(**plain, film=ehd.LongBearing(), supply=(groove,))

ehd.ThrustFaces(inner_radius=0.05, outer_radius=0.05, clearance=50e-6)

ehd.ThrustFaces(inner_radius=0.03, outer_radius=0.05, clearance=50e-6, lower=False, upper=False)

ehd.ThrustFaces(inner_radius=0.03, outer_radius=0.05, clearance=50e-6, contact=ehd.RegularisedWall(onset=60e-6))

lands = ehd.TaperLand(pads=8, depth=2e-5)
ehd.ThrustFaces(inner_radius=0.03, outer_radius=0.05, clearance=50e-6, profile=lands, n_theta=32)

faces = ehd.ThrustFaces(inner_radius=0.02, outer_radius=0.05, clearance=50e-6)
ehd.JournalBearing(**plain, thrust=faces)

ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams(), thrust=faces)

yielding = type("Yielding", (), {"onset": 1e6, "bound": lambda self, radius, clearance: None})()
ehd.JournalBearing(**size, lubricant=ehd.Lubricant(viscosity=0.02, shear_law=yielding), thrust=faces)

faces = ehd.ThrustFaces(inner_radius=0.03, outer_radius=0.05, clearance=50e-6, outer_pressures=(-2e5, 0.0))
ehd.JournalBearing(**plain, thrust=faces)

ehd.ThrustFaces(inner_radius=0.03, outer_radius=0.05, clearance=50e-6, feed=1e5)

ehd.TiltingThrustPads(**sector | {"inner_radius": 0.1})

ehd.TiltingThrustPads(**sector | {"pads": 10})

ehd.TiltingThrustPads(**sector | {"pivot_angle": 22.3})

ehd.TiltingThrustPads(**sector | {"pivot_radius": 0.12})

ehd.TiltingThrustPads(**sector | {"pad_inertia": (6e-5, 0.0)})

ehd.TiltingThrustPads(**sector | {"cavitation": ehd.ElrodAdams()})

ehd.TiltingThrustPads(**sector, contact=ehd.RegularisedWall(onset=80e-6))
""",
    ),
    Group(
        "Describing a bearing: shape, roughness, contact, wear",
        "Arguments `profile`, `roughness`, `asperity`, `contact` and `wear` of `JournalBearing`.",
        "bearing",
        """
ehd.Crown(drop=5.0)

ehd.OutOfRound(order=1, amplitude=1e-6)

ehd.WornArc(worn_depth=50e-6, angle=0.0, clearance=25e-6)

egg = ehd.JournalBearing(**plain, profile=ehd.OutOfRound(order=2, amplitude=40e-6))
ehd.steady(egg, speed=300.0, eccentricity_ratio=0.0)

relief = ehd.EdgeRelief(drop=10e-6, relief_length=0.0005)
relieved = ehd.JournalBearing(**plain, profile=relief, film=ehd.FiniteLength(n_z=4))
ehd.steady(relieved, speed=300.0, eccentricity_ratio=0.0)

ehd.AxialProfile(positions=(-0.01, 0.0, 0.01), depths=(0.0, 1e-6))

ehd.AxialProfile(positions=(0.01, 0.0, -0.01), depths=(0.0, 1e-6, 0.0))

ehd.AxialProfile(positions=(-0.01, 0.0, 0.01), depths=(0.0, float("nan"), 0.0))

ehd.AxialProfile(positions=(-0.01, 0.0, 0.01), depths=(0.0, 1e30, 0.0))

ehd.AxialProfile(positions=(-0.01, 0.0, 0.01), depths="flat")

ehd.ProfileTable(angles=(0.0, 2.1, 4.2, 6.3), positions=(-0.01, 0.01), depths=np.zeros((4, 2)))

ehd.ProfileTable(angles=(0.0, 1.5, 3.0, 4.5), positions=(-0.01, 0.01), depths=np.zeros((2, 4)))

ehd.PatirCheng(composite_roughness=4e-7, pattern=2.0)

ehd.PatirCheng(composite_roughness=0.4)

ehd.JournalBearing(**plain, roughness=ehd.PatirCheng(composite_roughness=10e-6))

ehd.JournalBearing(
    **plain, roughness=ehd.PatirCheng(composite_roughness=1e-6),
    asperity=ehd.GreenwoodTripp(composite_roughness=2e-6, composite_modulus=1e11))

ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=110.0)

ehd.composite_modulus(youngs_moduli=(210e9, 210e9), poisson_ratios=(0.3, 0.6))

ehd.composite_modulus(youngs_moduli=(210e9,), poisson_ratios=(0.3, 0.3))

ehd.RegularisedWall(onset=0.002)

ehd.JournalBearing(**plain, contact=ehd.RegularisedWall(onset=30e-6))

ehd.JournalBearing(
    **plain, contact=ehd.RegularisedWall(onset=1e-6), roughness=ehd.PatirCheng(composite_roughness=1e-6)
)

ehd.JournalBearing(**plain, wear=ehd.ArchardWear(wear_rate=1e-15))

ehd.ArchardWear(wear_rate=1e-7)
""",
    ),
    Group(
        "Describing a bearing: heat",
        "Argument `thermal` of `JournalBearing`.",
        "bearing",
        """
ehd.LumpedThermal(supply_temperature=-5.0)

ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=ehd.LumpedThermal(supply_temperature=40.0))

ehd.LumpedThermal(supply_temperature=313.0, carry_over=1.5)

ehd.FilmEnergy(supply_temperature=313.0, across=3)

ehd.FilmEnergy(supply_temperature=313.0, across=2)

wall = ehd.Conduction(thickness=0.01, conductance=50.0)
ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13, bush=wall, bush_coefficient=1e3)

ehd.FilmEnergy(supply_temperature=313.0, bush=ehd.Conduction(thickness=0.01, conductance=50.0))

wall = ehd.Conduction(thickness=0.05, conductance=50.0)
heat = ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13, journal=wall)
ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=heat)

heat, shear = ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13, across=2), ehd.CarreauShear
thin = dataclasses.replace(ehd.oil("ISO VG 46"), shear_law=shear(relaxation_time=1e-6, exponent=0.8))
ehd.JournalBearing(**size, lubricant=thin, thermal=heat)

ehd.Conduction(thickness=10.0, conductance=50.0)
""",
    ),
    Group(
        "Putting a film into a model",
        "Raised by `CreateLubricatedJoint` and its like, while the model is built.",
        "model",
        """
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, ehd.FiniteLength())

ehd.CreateLubricatedJoint(None, "main", sides, centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, 1, sides, centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)

mbs.Assemble()
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", shaft, centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", [ground, "shaft"], centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", [ground, exu.ObjectIndex(7)], centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", [ground, mbs.CreateGround()], centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", [shaft, shaft], centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", itemNumbers=sides, bodyNumbers=sides, position=centre, axis=z, bearing=bearing)

ehd.CreateLubricatedJoint(mbs, "main", bodyNumbers=sides, position=centre, axis=z, bearing=bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, [0, 0], z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, bearing=bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, [0, 0, 0], bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, bearing=bearing, rotationMatrixAxes=np.eye(2))

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, bearing=bearing, rotationMatrixAxes=2 * np.eye(3))

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, [1, 0, 0], bearing, rotationMatrixAxes=np.eye(3))

disc = mbs.CreateRigidBody(inertia=cube, create2D=True)
ehd.CreateLubricatedJoint(mbs, "main", [ground, disc], centre, [1, 0, 0], bearing)

marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=shaft))
ehd.CreateLubricatedJoint(mbs, "main", [ground, marker], centre, z, bearing)

marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=shaft))
ehd.CreateLubricatedJoint(mbs, "main", [ground, marker], axis=z, bearing=bearing)

away = mbs.CreateRigidBody(inertia=cube, initialDisplacement=[0, -1e-4, 0])
ehd.CreateLubricatedJoint(mbs, "main", [ground, away], centre, z, bearing)

askew = mbs.CreateRigidBody(inertia=cube, initialRotationMatrix=exu.utilities.RotationMatrixX(0.01))
ehd.CreateLubricatedJoint(mbs, "main", [ground, askew], centre, z, bearing)

nowhere = mbs.CreateRigidBody(inertia=cube, initialDisplacement=[float("nan"), 0, 0])
ehd.CreateLubricatedJoint(mbs, "main", [ground, nowhere], centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing, axial=True)

point = mbs.CreateMassPoint(mass=1.0)
ehd.CreateLubricatedJoint(mbs, "main", [ground, point], centre, z, bearing, axial=ehd.Held())

node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0]))
ehd.CreateLubricatedJoint(mbs, "main", [ground, node], centre, z, bearing)

spring = mbs.CreateSpringDamper(itemNumbers=sides, referenceLength=0.1, stiffness=1e3)
ehd.CreateLubricatedJoint(mbs, "main", [ground, spring], centre, z, bearing)

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing, bushGravity=[0, -9.81, 0])

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing, stepControl=0.25)

ehd.StepControl(largest_gap_change=2.0)

ehd.StepControl(error=0.02, largest_gap_change=0.1)

control = ehd.StepControl(error=0.02)
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing, stepControl=control)

Path("notes.txt").write_text("my notes")
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing, record=ehd.File(path="notes.txt"))

ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, ehd.JournalBearing(**plain, inlet=ehd.MaximumGap()))

high = mbs.CreateRigidBody(inertia=cube, initialDisplacement=[0, 0, 1e-4])
ehd.CreateLubricatedJoint(mbs, "main", [ground, high], centre, z, faced)

ehd.CreateTiltingPadThrustBearing(mbs, "thrust", [mbs.CreateMassPoint(mass=1.0), shaft], centre, z, pads)

sunk = mbs.CreateRigidBody(inertia=cube, initialDisplacement=[0, 0, -1e-4])
ehd.CreateTiltingPadThrustBearing(mbs, "thrust", [ground, sunk], centre, z, pads)

thrust = ehd.CreateTiltingPadThrustBearing(mbs, "thrust", sides, centre, z, pads); mbs.Assemble()
thrust.pads[0].film()

ehd.CreateLubricatedSphericalJoint(mbs, "ball", [shaft, shaft], centre, bearing=ball)

ehd.CreateLubricatedSphericalJoint(mbs, "ball", sides, centre, bearing=bearing)

low = mbs.CreateRigidBody(inertia=cube, initialDisplacement=[0, -1e-4, 0])
ehd.CreateLubricatedSphericalJoint(mbs, "ball", [ground, low], centre, bearing=ball)

ehd.SphericalBearing(ball_radius=0.015, radial_clearance=1e-3, lubricant=oil)

ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil, socket_angles=(0.0, 4.0))

lined = ehd.ElrodAdams(line_in_cells=True)
ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil, cavitation=lined)

above = ehd.Gumbel(cavity_pressure=1.0)
ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil, cavitation=above)

field = ehd.FilmEnergy(supply_temperature=313.15)
ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil, thermal=field)

thin = ehd.Lubricant(viscosity=0.02, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.8))
ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=thin)

node = mbs.AddNode(eii.NodePoint())
mbs.AddObject(eii.ObjectGenericODE2(nodeNumbers=[node], massMatrix=np.eye(3)))
ehd.CreateLubricatedJoint(mbs, "main", [ground, node], centre, z, bearing)

node = mbs.AddNode(eii.NodeRigidBodyRxyz())
ehd.CreateLubricatedJoint(mbs, "main", [ground, node], centre, z, bearing, tilt=ehd.Held())

ehd.CreateLubricatedJoint(mbs, "main", [ground, cable()], [0.2, 0, 0], [1, 0, 0], bearing)

ehd.CreateLubricatedJoint(mbs, "main", [ground, cable()], [0.05, 0, 0], [1, 1, 0], bearing)

node = mbs.AddNode(eii.NodePointSlope23(referenceCoordinates=[0, 0, 0, 0, 1, 0, 0, 0, 1]))
ehd.CreateLubricatedJoint(mbs, "main", [ground, node], [0.05, 0, 0], [1, 0, 0], bearing)

ehd.CreateLubricatedJoint(mbs, "main", [ground, cable()], [0.05, 0, 0], [1, 0, 0], bearing, axial=ehd.Held())

ehd.CreateLubricatedJoint(mbs, "main", [cable(), shaft], [0.05, 0, 0], [1, 0, 0], bearing, axial=ehd.Held())

marker = averaged([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [1.0, 1.0, 1.0])
ehd.CreateLubricatedJoint(mbs, "main", [ground, marker], axis=z, bearing=bearing)

marker = averaged([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [0.25, 0.5, 0.25])
ehd.CreateLubricatedJoint(mbs, "main", [ground, marker], axis=z, bearing=bearing)

marker = averaged([[0, 0, 0.1], [1, 0, 0.1], [0, 1, 0.1]], [0.25, 0.25, 0.5])
away = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground, localPosition=[0.25, 0.5, 0.0]))
ehd.CreateLubricatedJoint(mbs, "main", [away, marker], axis=z, bearing=bearing, axial=ehd.Held())

ehd.ReplaceJoint(mbs, exu.ObjectIndex(7), bearing=bearing)

turn = np.array([[1.0, 0, 0, 0], [0, 0.8, -0.6, 0], [0, 0.6, 0.8, 0], [0, 0, 0, 1]])
ends = [mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=k, localHT=h)) for k, h in zip(sides, (np.eye(4), turn))]
ehd.ReplaceJoint(mbs, mbs.AddObject(eii.ObjectJointRevoluteZ(markerNumbers=ends)), bearing=bearing)

joint = ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)
joint.history

joint = ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)
joint.history.plot_orbit()

joint = ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)
joint.audit()

ehd.Every(steps=0)

ehd.Period(seconds=-1.0)

hinge = mbs.CreateRevoluteJoint("hinge", sides, centre, z)
ehd.ReplaceJoint(mbs, hinge, bearing=bearing, journal=2)

ehd.ReplaceJoint(mbs, 7, bearing=bearing)

ehd.ReplaceJoint(mbs, shaft, bearing=bearing)

hinge = mbs.CreateRevoluteJoint("hinge", sides, centre, z)
ehd.ReplaceJoint(mbs, hinge, bearing=bearing)
ehd.ReplaceJoint(mbs, hinge, bearing=bearing)

hinge = mbs.CreateRevoluteJoint("hinge", sides, centre, z)
mbs.AddSensor(eii.SensorObject(name="load", objectNumber=hinge, outputVariableType=exu.OutputVariableType.ForceLocal))
ehd.ReplaceJoint(mbs, hinge, bearing=bearing)

weld = mbs.CreateGenericJoint("weld", sides, centre, constrainedAxes=[1, 1, 1, 1, 1, 1])
ehd.ReplaceJoint(mbs, weld, bearing=bearing)

slot = mbs.CreateGenericJoint("slot", sides, centre, constrainedAxes=[0, 1, 1, 1, 1, 0])
ehd.ReplaceJoint(mbs, slot, bearing=bearing)

moved = mbs.CreateGenericJoint("moved", sides, centre, constrainedAxes=[1, 1, 1, 1, 1, 0])
mbs.SetObjectParameter(moved, "offsetUserFunctionParameters", [1e-3, 0, 0, 0, 0, 0])
ehd.ReplaceJoint(mbs, moved, bearing=bearing)

still = lambda mbs, t, item, parameters: [0.0] * 6
moved = mbs.CreateGenericJoint("moved", sides, centre, constrainedAxes=[1, 1, 1, 1, 1, 0], offsetUserFunction=still)
ehd.ReplaceJoint(mbs, moved, bearing=bearing)

ehd.ReplaceJoints(mbs, bearing=bearing)

ehd.ReplaceJoints(mbs, bearing=bearing, types=("Ground",))

mbs.SetNodeParameter(exu.NodeIndex(0), "initialCoordinates", [1e-3, 0, 0, 0, 0, 0])
mbs.CreateRevoluteJoint("hinge", sides, centre, z)
ehd.ReplaceJoints(mbs, bearing=bearing)

ehd.ReplaceReducedBody(mbs, shaft)

body = mbs.AddObject(eii.ObjectGenericODE2(nodeNumbers=[mbs.AddNode(eii.NodePoint2D())], massMatrix=np.eye(2)))
marker = mbs.AddMarker(eii.MarkerSuperElementRigid(bodyNumber=body, meshNodeNumbers=[0], weightingFactors=[1.0]))
ehd.CreateLubricatedJoint(mbs, "main", [ground, marker], axis=z, bearing=bearing)

joint = ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing)
mbs.SetNodeParameter(0, "initialCoordinates", [0, -3e-5, 0, 0, 0, 0])
mbs.Assemble(); joint.film()

record = ehd.File(path="both.rows")
for name in ("left", "right"): ehd.CreateLubricatedJoint(mbs, name, sides, centre, z, bearing, record=record)

settings.timeIntegration.numberOfSteps, kept = 600, {"record": ehd.File(path="{name}.rows")}
left, _ = [ehd.CreateLubricatedJoint(mbs, name, sides, centre, z, bearing, **kept) for name in ("left", "right")]
mbs.Assemble(); ehd.SolveDynamic(mbs, settings); Path("right.rows").replace("left.rows"); left.history.time

(folder := Path("rows")).mkdir()
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing, record=ehd.File(path=folder / "main"))
folder.rmdir(); folder.write_text(""); mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

sides = [ground, averaged([[0.1, 0, 0], [-0.1, 0.1, 0], [0, -0.1, 0]], [1 / 3] * 3)]
for k, v in enumerate(([0, 2e3, 0], [-2e3, -2e3, 0], [2e3, 0, 0])): mbs.SetNodeParameter(k + 1, "initialVelocities", v)
ehd.CreateLubricatedJoint(mbs, "main", sides, [], z, bearing); mbs.Assemble(); ehd.SolveDynamic(mbs, settings)
""",
    ),
    Group(
        "Running",
        "Raised by `SolveDynamic`, `SolveStatic` and their like, or told during a run.",
        "run",
        """
ehd.SolveDynamic(mbs, None)

settings.timeIntegration.endTime = 0.0
ehd.SolveDynamic(mbs, settings)

settings.timeIntegration.generalizedAlpha.spectralRadius = 1.5
ehd.SolveDynamic(mbs, settings)

settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
ehd.SolveDynamic(mbs, settings)

ehd.ConfigureSolver(None)

ehd.ConfigureSolver(settings, spectralRadius=2.0)

ehd.SolveDynamic(mbs, settings, threads=2)

ehd.SolveDynamic(mbs, settings, stepControl=0.02)

ehd.SolveDynamic(mbs, settings, stepControl=ehd.StepControl())

settings.timeIntegration.adaptiveStep = False
ehd.SolveDynamic(mbs, settings, stepControl=ehd.StepControl(error=0.02))

ehd.SolveDynamic(mbs, settings, until_periodic=ehd.UntilPeriodic(period=1e-3))

ehd.SolveDynamic(mbs, settings, until_periodic=0.02)

other = exu.SystemContainer().AddSystem()
other.Assemble()
ehd.SolveDynamic(other, settings, until_periodic=ehd.UntilPeriodic(period=1e-4))

ehd.SolveDynamic(mbs, settings, restart=5)

Path("state.npz").write_text("no state")
ehd.SolveDynamic(mbs, settings, restart="state.npz")

ehd.SaveState(mbs, "state.npz")

ehd.SolveDynamic(mbs, settings)
ehd.SaveState(mbs, "state.txt")

ehd.SolveDynamic(mbs, settings)
ehd.SolveDynamic(mbs, settings, restart=ehd.SaveState(mbs, "state.npz"))

ehd.SolveDynamic(mbs, settings)
mbs.ComputeLinearizedSystem()
ehd.SaveState(mbs, "state.npz")

mbs.Reset()
joint.film()

mbs.Reset()
mbs.Assemble()
joint.film()

mbs.DeleteObject(exu.ObjectIndex(0))
mbs.Assemble()
ehd.SolveDynamic(mbs, settings)

ehd.SolveDynamic(mbs, settings)

joint.history.revolutions()

joint.stop_at(pressure=1e3)
ehd.SolveDynamic(mbs, settings)

mbs, shaft, joint = joined(bearing, initialVelocity=[0, -10.0, 0])
ehd.SolveDynamic(mbs, settings)

mbs, shaft, joint = joined(bearing, initialVelocity=[0, -0.3, 0])
ehd.SolveDynamic(mbs, settings)

mbs, shaft, joint = joined(bearing, initialDisplacement=[0, -24.9e-6, 0], initialAngularVelocity=[0, 0, 0.1])
ehd.SolveDynamic(mbs, settings)

coarse = ehd.JournalBearing(**plain, film=ehd.FiniteLength(n_theta=16, n_z=4))
mbs, shaft, joint = joined(coarse, initialDisplacement=[0, -24e-6, 0])
ehd.SolveDynamic(mbs, settings)

heat = ehd.FilmEnergy(supply_temperature=313.15, initial_temperature=450.0)
mbs, shaft, joint = joined(ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=heat))
ehd.SolveDynamic(mbs, settings)

heat = ehd.FilmEnergy(supply_temperature=313.15, initial_temperature=705.0)
mbs, shaft, joint = joined(ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=heat))
ehd.SolveDynamic(mbs, settings)

thick = ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=2e-8))
mbs, shaft, joint = joined(ehd.JournalBearing(**size, lubricant=thick), initialDisplacement=[0, -21.3e-6, 0])
ehd.SolveDynamic(mbs, settings)

thick = ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=2e-8))
mbs, shaft, joint = joined(ehd.JournalBearing(**size, lubricant=thick), initialDisplacement=[0, -22e-6, 0])
ehd.SolveDynamic(mbs, settings)

settings.timeIntegration.adaptiveStep = False
mbs, shaft, joint = joined(faced, initialVelocity=[0, 0, -5.0], initialAngularVelocity=[0, 0, 0])
ehd.SolveDynamic(mbs, settings)

soft = dataclasses.replace(faces, contact=ehd.RegularisedWall(onset=1e-6, pressure=1e5))
mbs, shaft, joint = joined(ehd.JournalBearing(**plain, thrust=soft), initialVelocity=[0, 0, -12.0])
ehd.SolveDynamic(mbs, settings)

hard = dataclasses.replace(faces, contact=ehd.RegularisedWall(onset=1e-6))
mbs, shaft, joint = joined(ehd.JournalBearing(**plain, thrust=hard), initialVelocity=[0, 0, -50.0])
ehd.SolveDynamic(mbs, settings)

walled = ehd.JournalBearing(**plain, contact=ehd.RegularisedWall(onset=1e-6, pressure=1e5))
mbs, shaft, joint = joined(walled); mbs.CreateForce(itemNumber=shaft, loadVector=[0, -1e6, 0])
mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

mbs, up = exu.SystemContainer().AddSystem(), {"inertia": cube, "initialVelocity": [0, 0, -2.0]}
ehd.CreateLubricatedSphericalJoint(mbs, "ball", [mbs.CreateGround(), mbs.CreateRigidBody(**up)], centre, bearing=ball)
mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

short = ehd.ImpedanceMap(n_theta=64, n_z=4, n_eccentricity=8, n_direction=17)
mbs, shaft, joint = joined(ehd.JournalBearing(**plain, film=short), initialAngularVelocity=[2.0, 0, 200.0])
ehd.SolveDynamic(mbs, settings)

mbs.CreateForce(itemNumber=shaft, loadVector=[0, float("nan"), 0])
mbs.Assemble()
ehd.SolveDynamic(mbs, settings)

ehd.ConfigureSolver(settings, absoluteTolerance=10.0)
ehd.SolveDynamic(mbs, settings)

settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 100, 4e-3
mbs, shaft, joint = joined(bearing, initialDisplacement=[0, -10e-6, 0])
ehd.SolveDynamic(mbs, settings, solverType=exu.DynamicSolverType.RK44)

mbs.SolveDynamic(settings, storeSolver=False)

mbs.CreateGenericJoint(itemNumbers=[exu.ObjectIndex(0), shaft], position=centre, constrainedAxes=[0, 0, 1, 0, 0, 0])
mbs.Assemble()
ehd.SolveDynamic(mbs, settings, solverType=exu.DynamicSolverType.RK44)

mbs = exu.SystemContainer().AddSystem(); sides = [mbs.CreateRigidBody(**turning), mbs.CreateGround()]
joint = ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bearing); mbs.Assemble()
joint.place_in_equilibrium(load=(0.0, -100.0))

mbs = exu.SystemContainer().AddSystem(); sides = [mbs.CreateGround(), mbs.CreateRigidBody(**turning)]
ehd.CreateLubricatedSphericalJoint(mbs, "ball", sides, centre, bearing=ball); mbs.Assemble()
ehd.SolveDynamic(mbs, settings, until_periodic=ehd.UntilPeriodic(period=2e-4))

short = ehd.ImpedanceMap(n_theta=64, n_z=4, n_eccentricity=8, n_direction=17)
mbs, shaft, joint = joined(ehd.JournalBearing(**plain, film=short))
joint.record_films()

joint.record_films()
ehd.SolveDynamic(mbs, settings)
joint.animate("orbit.png")

settings.timeIntegration.numberOfSteps = 40
ehd.SolveDynamic(mbs, settings)
joint.history.plot_waterfall(speed=np.zeros(3), window=5e-4)

oily = ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams(), film=ehd.FiniteLength(n_theta=32, n_z=4))
settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.4, 100
ehd.SolveDynamic(joined(oily)[0], settings)

contact = mbs.AddGeneralContact(); contact.SetFrictionPairings(np.eye(1))
contact.SetSearchTreeBox([-1, -1, -1], [1, 1, 1]); mbs.Assemble()
ehd.SolveDynamicSparse(mbs, settings)

node = {"numberOfODE1Coordinates": 1, "referenceCoordinates": [0], "initialCoordinates": [0]}
mbs, shaft, joint = joined(bearing, nodeType=exu.NodeType.RotationRxyz); mbs.AddNode(eii.NodeGenericODE1(**node))
mbs.Assemble(); ehd.SolveDynamicSparse(mbs, settings)

mbs, shaft, joint = joined(bearing, nodeType=exu.NodeType.RotationRxyz)
body = {"nodeNumbers": [mbs.AddNode(eii.NodePoint())], "forceUserFunction": lambda mbs, t, item, q, q_t: [0.0] * 3}
mbs.AddObject(eii.ObjectGenericODE2(massMatrix=np.eye(3), **body)); mbs.Assemble(); ehd.SolveDynamicSparse(mbs)

weld = mbs.CreateGenericJoint(itemNumbers=[exu.ObjectIndex(0), shaft], position=centre, constrainedAxes=[1] * 6)
mbs.SetObjectParameter(weld, "activeConnector", False)
ehd.SolveDynamic(mbs, settings, solverType=exu.DynamicSolverType.RK44)

settings.timeIntegration.endTime = 4e-3
ehd.SolveDynamic(mbs, settings, until_periodic=ehd.UntilPeriodic(period=8e-4, tolerance=1e-6))

mbs, shaft, joint = joined(bearing, record=ehd.Every(steps=2))
ehd.SolveDynamic(mbs, settings, until_periodic=ehd.UntilPeriodic(period=2e-4))

mbs, shaft, joint = joined(bearing, record=ehd.Every(steps=2))
ehd.SolveDynamic(mbs, settings)
joint.history.revolutions(period=5e-4)

mbs, shaft, joint = joined(bearing, record=ehd.Every(steps=2))
ehd.SolveDynamic(mbs, settings)
joint.audit()

ehd.SolveDynamic(mbs, settings)
state = dataclasses.replace(ehd.SaveState(mbs, "state.npz"), joints=())
ehd.SolveDynamic(mbs, settings, restart=state)

ehd.SolveDynamic(mbs, settings)
state = ehd.SaveState(mbs, "state.npz")
ehd.SolveDynamic(mbs, settings, restart=dataclasses.replace(state, coordinates=(np.zeros(2), *state.coordinates[1:])))

ehd.SolveDynamic(mbs, settings)
ehd.SaveState(mbs, "state.npz")
ehd.SolveDynamic(joined(ehd.JournalBearing(**plain, squeeze=False))[0], settings, restart="state.npz")

oily = ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
mbs, shaft, joint = joined(oily); ehd.SolveDynamic(mbs, settings)
mbs.SetNodeParameter(0, "initialCoordinates", [0, -2e-6, 0, 0, 0, 0]); mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

ehd.SolveStatic(mbs, settings)

mbs, shaft, joint = joined(ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5)))
ehd.SolveDynamic(mbs, settings, stepControl=ehd.StepControl(error=0.02))

warm = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=ehd.LumpedThermal(supply_temperature=313))
mbs, shaft, joint = joined(warm); held = {"position": centre, "constrainedAxes": [0, 0, 1, 1, 1, 1]}
mbs.CreateGenericJoint(itemNumbers=[mbs.CreateGround(), shaft], **held); mbs.Assemble(); ehd.SolveStatic(mbs, settings)

ehd.SolveDynamicSparse(mbs, settings)

settings.timeIntegration.newton.residualMode = 1
ehd.SolveDynamicSparse(mbs, settings)

hole = ehd.Hole(angle=1.0, diameter=0.006, pressure=1e5, rotating=True)
mbs, shaft, joint = joined(ehd.JournalBearing(**plain, supply=(hole,)))
joint.place_in_equilibrium(load=(0.0, -100.0))

joint.place_in_equilibrium(load=(0.0, float("nan")))

joint.place_in_equilibrium(load=(0.0, -100.0), speed="fast")

joint.place_in_equilibrium(load=(0.0, -100.0), speed=0.0)

joint.place_in_equilibrium(load=(0.0, -100.0), speed=3000000.0)

mbs, shaft, joint = joined(bearing, nodeType=exu.NodeType.RotationRxyz)
slider(mbs); mbs.Assemble()
ehd.SolveDynamicSparse(mbs, settings)

stop = lambda mbs, t, load: [0, 0, 0] if t < 5e-4 else __import__("signal").raise_signal(2)
mbs.CreateForce(itemNumber=shaft, loadVector=[0, 0, 0], loadVectorUserFunction=stop)
mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.012, 120
shake = {"loadVector": centre, "loadVectorUserFunction": lambda mbs, t, load: [0, 6e3 * (-1) ** round(t / 1e-4), 0]}
mbs.CreateForce(itemNumber=shaft, **shake); mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.012, 120
shake = {"loadVector": centre, "loadVectorUserFunction": lambda mbs, t, load: [0, 600 * (-1) ** round(t / 1e-4), 0]}
mbs.CreateForce(itemNumber=shaft, **shake); mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

wet, wall = ehd.oil("ISO VG 46"), ehd.Conduction(thickness=0.01, conductance=0, expansion=2e-4, initial_temperature=360)
heat, touch = ehd.FilmEnergy(supply_temperature=313, conductivity=0.13, journal=wall), ehd.RegularisedWall(onset=1e-6)
ehd.SolveDynamic(joined(ehd.JournalBearing(**size, lubricant=wet, thermal=heat, contact=touch))[0], settings)
""",
    ),
    Group(
        "Asking for results of a run",
        "Histories, tables, films, pictures and files.",
        "ran",
        """
history.minimum_film_thickness

history.between(start=2.0, end=1.0)

history.revolutions()

history.revolutions(period=1.0)

history.revolutions(period=1e-6)

history.save("history.txt")

history.save(5)

history.to_csv("/")

Path("history.npz").write_text("no history")
ehd.load_history("history.npz")

joint.AddSensor("gap")

joint.animate("orbit.gif")

joint.record_films(period=-1.0)

joint.stop_at(force=-5.0)

history.plot_traces(["force"])

history.plot_traces(["supply_flow"])

history.plot_traces(ax=[])

history.plot_traces(angle=np.zeros(3))

history.plot_waterfall(window=1e-4)

import matplotlib.pyplot as plt
history.plot_load(ax=plt.figure().add_subplot())

joint.plot_fill()

joint.plot_temperature()

joint.plot_wear_depth()

joint.export_vtk("film.vtu")

joint.restore_state(None)

joint.restore_state(dataclasses.replace(joint.state(), name="other"))

joint.restore_state(dataclasses.replace(joint.state(), bearing="other"))

joint.restore_state(dataclasses.replace(joint.state(), rows=np.zeros((3, 3))))

joint.restore_state(dataclasses.replace(joint.state(), modes=np.ones((3, 3))))

import matplotlib.pyplot as plt
plt.rcParams["animation.ffmpeg_path"] = "nowhere"
joint.record_films(); ehd.SolveDynamic(mbs, settings); joint.animate("orbit.mp4")

import sys
sys.modules["pandas"] = None
history.to_dataframe()

import sys
sys.modules["meshio"] = None
joint.export_vtk("film.vtu")

state = joint.state()
changed = dataclasses.replace(state.begin, motion=np.zeros(4))
joint.restore_state(dataclasses.replace(state, begin=changed))
""",
    ),
    Group(
        "Static questions: one film",
        "Raised by `steady`, `equilibrium`, `stribeck`, `steady_spherical` and `solve_film`.",
        "film",
        """
ehd.steady(None, speed=300.0, eccentricity_ratio=0.5)

ehd.steady(bearing, speed=float("inf"), eccentricity_ratio=0.5)

ehd.steady(bearing, speed=1e-200, eccentricity_ratio=0.5)

ehd.steady(bearing, speed=300.0, eccentricity_ratio=1.1)

ehd.steady(bearing, speed=300.0, eccentricity_ratio=-0.5)

ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.5, tilt=0.1)

ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.5, axial_position=1e-5)

ehd.steady(ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams()), speed=300.0, eccentricity_ratio=0.5)

coarse = ehd.JournalBearing(**plain, film=ehd.FiniteLength(n_theta=16, n_z=4))
ehd.steady(coarse, speed=300.0, eccentricity_ratio=0.97)

ehd.steady(bearing, speed=30000.0, eccentricity_ratio=0.99)

walled = ehd.JournalBearing(**plain, contact=ehd.RegularisedWall(onset=1e-6))
ehd.steady(walled, speed=300.0, eccentricity_ratio=3.0)

ehd.steady(ehd.JournalBearing(**size, lubricant=thick), speed=300.0, eccentricity_ratio=0.99)

heat = ehd.LumpedThermal(supply_temperature=313.15)
warm = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=heat)
ehd.steady(warm, speed=300.0, eccentricity_ratio=0.0)

heat = ehd.FilmEnergy(supply_temperature=313.15)
warm = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 460"), thermal=heat)
ehd.steady(warm, speed=30000.0, eccentricity_ratio=0.01)

heat = ehd.FilmEnergy(supply_temperature=313.15, carry_over=1.0)
hot = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=heat)
ehd.steady(hot, speed=3000.0, eccentricity_ratio=0.9)

ehd.equilibrium(bearing, speed=0.0, load=(0.0, -500.0))

ehd.equilibrium(bearing, speed=300.0, load=500.0)

ehd.stribeck(ehd.JournalBearing(**plain, inlet=ehd.MaximumGap()), load=500.0, speeds=[300.0])

wet = ehd.Lubricant(temperature_law=ehd.TableViscosity(temperatures=(300, 330), viscosities=(0.05, 0.02)))
hot = ehd.JournalBearing(**size, lubricant=wet, thermal=ehd.LumpedThermal(supply_temperature=313.0))
ehd.stribeck(hot, load=500.0, speeds=[3000.0])

ehd.equilibrium(ehd.JournalBearing(**plain, inlet=ehd.MaximumGap()), speed=300.0, load=(0, -500), tilt=(1e-4, 0))

turning = ehd.Hole(angle=0.0, diameter=0.005, pressure=1e5, rotating=True)
ehd.equilibrium(ehd.JournalBearing(**plain, supply=(turning,)), speed=300.0, load=(0.0, -500.0))

ehd.equilibrium(faced, speed=300.0, load=(0.0, -500.0), axial_position=1e-6, axial_load=50.0)

ehd.equilibrium(pads, speed=300.0, load=30e3, axial_load=30e3)

ehd.equilibrium(pads, speed=300.0, load=(0.0, -30e3))

ehd.equilibrium(pads, speed=-300.0, load=30e3)

ehd.equilibrium(bearing, speed=300.0, load=(0.0, -1e9))

heat = ehd.LumpedThermal(supply_temperature=313.15)
warm = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 46"), thermal=heat)
ehd.equilibrium(warm, speed=1000.0, load=(0.0, -0.1))

halves = ehd.JournalBearing(**plain, arcs=ehd.offset_halves(preload=0.6))
ehd.equilibrium(halves, speed=-300.0, load=(-500.0, -500.0))

starved = ehd.Pocket(angle=2.0, width_angle=0.8, length=0.01, supply=ehd.GivenFlow(flow=1e-10))
ehd.steady(ehd.JournalBearing(**plain, supply=(starved,)), speed=300.0, eccentricity_ratio=0.5, direction=1.5)

fed = ehd.JournalBearing(**plain, supply=(ehd.Hole(angle=0.0, diameter=0.006),))
ehd.equilibrium(fed, speed=300.0, load=(0.0, 0.0))

ehd.equilibrium(faced, speed=300.0, load=(0.0, -500.0), axial_load=1e9)

ehd.steady(faced, speed=300.0, eccentricity_ratio=0.5, axial_position=60e-6)

ehd.stribeck(bearing, load=1e8, speeds=[10.0, 100.0])

ehd.equilibrium(bearing, speed=300.0, load=(0.0, -500.0)).dynamic_stiffness([float("nan")])

ehd.stribeck(bearing, load=500.0, speeds=[0.0, 10.0])

film.plot_fill()

film.audit()["heat"]

ball = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil)
ehd.steady_spherical(ball, place=(0.0, 0.0, 40e-6))

steep = ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=2e-8))
piezo = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=steep)
ehd.steady_spherical(piezo, place=(0.0, 0.0, 29e-6), velocity=(0.0, 0.0, 10.0))

warm = ehd.LumpedThermal(supply_temperature=313.15)
closed = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil, thermal=warm)
ehd.steady_spherical(closed, place=(0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 100.0))

wet = ehd.Lubricant(temperature_law=ehd.TableViscosity(temperatures=(300, 330), viscosities=(0.05, 0.02)))
hot = dict(ball_radius=0.01, lubricant=wet, thermal=ehd.LumpedThermal(supply_temperature=313, housing_conductance=1))
ehd.steady_spherical(ehd.SphericalBearing(radial_clearance=1e-5, **hot), place=(0, 0, 0), angular_velocity=(1e3, 0, 0))

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
ehd.solve_film(grid, np.ones((3, 3)), lubricant=oil)

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
ehd.solve_film(grid, np.zeros(grid.shape), lubricant=oil)

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
ehd.solve_film(grid, np.full(grid.shape, np.nan), lubricant=oil)

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
ehd.solve_film(grid, "thin", lubricant=oil)

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
ehd.solve_film(grid, np.full(grid.shape, 1e-5), lubricant=oil, boundary=-1e5)

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
gap = np.full(grid.shape, 1e-5)
ehd.solve_film(grid, gap, lubricant=oil, history=gap, step=1e-3)

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
gap = 1e-6 * (2.0 - np.linspace(0.0, 1.0, grid.shape[0]))[:, None] * np.ones(grid.shape)
ehd.solve_film(grid, gap, lubricant=thick, surface_speed=(10.0, 0.0))

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
gap = np.full(grid.shape, 1e-5)
ehd.solve_film(grid, gap, lubricant=oil, history=-gap, step=1e-3, cavitation=ehd.ElrodAdams())

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
gap = np.full(grid.shape, 1e-5)
ehd.solve_film(grid, gap, lubricant=oil, history=gap, gap_rate=gap, step=1e-3, cavitation=ehd.ElrodAdams())

grid = ehd.slider_grid(length=0.1, width=0.1, n_x=16, n_z=8)
thin = ehd.Lubricant(viscosity=0.02, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.8))
ehd.solve_film(grid, np.full(grid.shape, 1e-5), lubricant=thin)

class Plastic(ehd.CarreauShear): ratio = lambda self, rate: 2.0 + 0.0 * rate
plastic = ehd.Lubricant(viscosity=0.02, shear_law=Plastic(relaxation_time=1e-6, exponent=0.8))
ehd.steady(ehd.JournalBearing(**size, lubricant=plastic), speed=300.0, eccentricity_ratio=0.5)

ball = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=oil)
at = ehd.steady_spherical(ball, place=(0.0, 0.0, 1e-5))
dataclasses.replace(at, motion=np.where(np.arange(11) == 2, 6e-5, 0.0)).audit()

groove = ehd.AxialGroove(angle=5.03, width_angle=1.19, length=0.0225, pressure=4740.0)
fed = {"supply": (groove,), "cavitation": ehd.ElrodAdams(), "end_pressures": (57.6, 57.6)}
ehd.equilibrium(ehd.JournalBearing(**plain, **fed), speed=116.9, load=(1.16, -3.197))

heat = ehd.LumpedThermal(supply_temperature=313.15)
hot = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 460"), thermal=heat)
ehd.steady(hot, speed=3e4, eccentricity_ratio=0.99)

heat = ehd.FilmEnergy(supply_temperature=313.15, initial_temperature=2500.0)
hot = ehd.JournalBearing(**size, lubricant=ehd.oil("ISO VG 460"), thermal=heat)
ehd.equilibrium(hot, speed=3e3, load=(0.0, -1e3))

wet, wall = ehd.oil("ISO VG 46"), ehd.Conduction(thickness=0.01, conductance=9, ambient_temperature=400, expansion=1e-3)
heat, touch = ehd.FilmEnergy(supply_temperature=313, conductivity=0.13, journal=wall), ehd.RegularisedWall(onset=1e-6)
ehd.steady(ehd.JournalBearing(**size, lubricant=wet, thermal=heat, contact=touch), speed=300.0, eccentricity_ratio=0.5)
""",
    ),
    Group(
        "Studies",
        "Raised by `recommend`, `recommend_steps`, `parameter_study` and their tables.",
        "film",
        """
ehd.recommend(None, eccentricity_ratio=0.5)

ehd.recommend(bearing)

ehd.recommend(bearing, eccentricity_ratio=(0.9, 0.5))

ehd.recommend(bearing, quantity="colour", eccentricity_ratio=0.5)

ehd.recommend(bearing, quantity="supply flow", eccentricity_ratio=0.5)

ehd.recommend(ehd.JournalBearing(**plain, end_pressures=(1e5, 0.0)), eccentricity_ratio=0.5)

ehd.recommend(bearing, 1.5, eccentricity_ratio=0.5)

ehd.recommend_steps(bearing, 0.02, speed=300.0, period=0.02, load=np.zeros((4, 2)), mass=1.0)

ehd.recommend_steps(bearing, 0.02, speed=np.zeros(3), period=0.02, load=np.ones((8, 2)), mass=1.0)

ehd.parameter_study(lambda p: p["x"], {})

ehd.parameter_study(lambda p: p["x"], {"x": 3.0})

ehd.parameter_study(lambda p: "three", {"x": [1.0]}, show_progress=False)

ehd.parameter_study(lambda p: {"x": 1.0}, {"x": [1.0]}, show_progress=False)

ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, mpi=True)

ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, executor=4)

from concurrent.futures import ThreadPoolExecutor
ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, executor=ThreadPoolExecutor(1))

from concurrent.futures import ThreadPoolExecutor
ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, executor=ThreadPoolExecutor(1), processes=2)

class Later:
    submit = lambda self, *arguments: None
ehd.parameter_study(abs, {"x": [1.0]}, executor=Later())

ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, processes=2)

peak = lambda p: ehd.steady(bearing, eccentricity_ratio=p["ratio"], speed=300.0).peak_pressure
ehd.parameter_study(peak, {"ratio": [1.1, 1.2]}, show_progress=False)

Path("rows.jsonl").write_text("no rows")
ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, file="rows.jsonl", show_progress=False)

ehd.parameter_study(lambda p: 1.0, {"x": [1.0]}, file="new.jsonl", show_progress=False)
ehd.parameter_study(lambda p: 2.0, {"x": [1.0]}, file="new.jsonl", show_progress=False)

table = ehd.parameter_study(lambda p: p["x"], {"x": [1.0, 2.0]}, show_progress=False)
table["y"]

table = ehd.parameter_study(lambda p: p["x"], {"x": [1.0, 2.0]}, show_progress=False)
table.plot("y")

table = ehd.parameter_study(lambda p: p["x"], {"x": [1.0], "y": list(range(11))}, show_progress=False)
table.plot("value")

ehd.varied(bearing, {"width": 0.1})

print(ehd.recommend(bearing, 0.05, "critical mass", eccentricity_ratio=0.9).reason)

still = ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams())
print(ehd.recommend(still, eccentricity_ratio=0.5).reason)

hole = ehd.Hole(angle=3.14, diameter=0.001, pressure=50.0)
fed = ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams(), supply=(hole,))
print(ehd.recommend(fed, speed=3000.0, eccentricity_ratio=0.1).reason)

coarse = ehd.JournalBearing(**plain, film=ehd.FiniteLength(n_theta=16, n_z=4))
force = np.array([(0.0, -2e4 - 5e3 * np.sin(k)) for k in range(8)])
ehd.recommend_steps(coarse, 0.9, speed=300.0, period=0.02, load=force, mass=1.0)

from exudyn_ehd.studies.film_errors import converged
converged([1.0, 2.0], ratio=2.0, formal_order=2.0, scale=1.0)
""",
    ),
    Group(
        "Tilting pads",
        "Raised by `TiltingPads`, `CreateTiltingPadBearing`, and `equilibrium` with pads.",
        "pads",
        """
ehd.TiltingPads(**rocking, extent=1.3)

ehd.TiltingPads(**plain, pad_thickness=0.01, preload=1.0)

ehd.TiltingPads(**plain, pad_thickness=0.01, pivot_offset=1.5)

ehd.TiltingPads(**rocking, pads=2)

ehd.TiltingPads(**rocking, film=ehd.ShortBearing())

ehd.equilibrium(pads, speed=300.0, load=(0.0, -1000.0), tilt=(1e-4, 0.0))

ehd.equilibrium(ehd.TiltingPads(**plain, pad_thickness=0.01), speed=300.0, load=(0.0, -0.1))

springy = ehd.TiltingPads(**plain, pad_thickness=0.01, preload=0.2, pivot_stiffness=1e5)
ehd.equilibrium(springy, speed=300.0, load=(0.0, -5.0))

ehd.equilibrium(ehd.TiltingPads(**plain, pad_thickness=0.01), speed=300.0, load=(0.0, 0.0))

three = dataclasses.replace(pads, pads=3, extent=1.3, preload=0.05)
ehd.equilibrium(three, speed=300.0, load=(800.0, -480.0))

rest.reduced(0.0)

light = ehd.TiltingPads(**plain, pad_thickness=0.01)
ehd.CreateTiltingPadBearing(mbs, "pads", sides, centre, z, light)

point = mbs.CreateMassPoint(mass=1.0)
ehd.CreateTiltingPadBearing(mbs, "pads", [point, shaft], centre, z, pads)

items = [shaft, ground]
joint = ehd.CreateTiltingPadBearing(mbs, "pads", items, centre, z, pads); mbs.Assemble()
joint.place_in_equilibrium(load=(0.0, -1000.0))

padded(initialAngularVelocity=[0, 0, 0])[1].place_in_equilibrium(load=(0.0, -1000.0))

plainer = dataclasses.replace(pads, preload=0.0)
ehd.SolveEquilibrium(padded(plainer, gravity=[0, -1e3, 0])[0], 300.0)
""",
    ),
    Group(
        "Rotors in several films",
        "Raised by `SolveEquilibrium`, `SolveThreshold` and their results.",
        "rotor",
        """
ehd.SolveEquilibrium(mbs, 0.0)

ehd.SolveEquilibrium(mbs, [300.0, -300.0])

empty = exu.SystemContainer().AddSystem()
empty.Assemble()
ehd.SolveEquilibrium(empty, 300.0)

empty = exu.SystemContainer().AddSystem()
ehd.SolveEquilibrium(empty, 300.0)

ehd.SolveEquilibrium(mbs, 300.0, ratios=[1.0, 2.0])

ehd.SolveEquilibrium(mbs, 300.0, rotors=["shaft"])

ehd.SolveEquilibrium(rotor(ehd.JournalBearing(**plain, cavitation=ehd.ElrodAdams()))[0], 300.0)

ehd.SolveEquilibrium(rotor(axes=(0, 0, 0, 0, 0, 0))[0], 300.0)

ehd.SolveEquilibrium(rotor(axes=(0, 0, 1, 0, 0, 1))[0], 300.0)

ehd.SolveEquilibrium(rotor(inertia=InertiaCuboid(density=7800.0, sideLengths=[0.1, 0.2, 0.1]))[0], 300.0)

ehd.SolveEquilibrium(rotor(inertia=cube.Translated([1e-6, 0, 0]))[0], 300.0)

ehd.SolveEquilibrium(rotor(gravity=[0, -1e9, 0])[0], 300.0)

ehd.SolveEquilibrium(rotor(ehd.JournalBearing(**plain, squeeze=False))[0], 300.0)

ehd.SolveEquilibrium(rotor(ehd.JournalBearing(**plain, film=ehd.ImpedanceMap()))[0], 300.0)

ehd.SolveEquilibrium(mbs, 300.0, rotors=[exu.ObjectIndex(0)])

extra = mbs.CreateRigidBody(inertia=cube)
mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0, rotors=[extra])

other = mbs.CreateRigidBody(inertia=cube, gravity=[0, -9.81, 0])
ehd.CreateLubricatedJoint(mbs, "third", [body, other], centre, z, bearing); mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0, rotors=[[body, other]])

disc = mbs.CreateRigidBody(inertia=cube, create2D=True)
mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0, rotors=[[body, disc]])

mbs.AddNode(eii.NodeGenericODE1(numberOfODE1Coordinates=1, referenceCoordinates=[0], initialCoordinates=[0]))
mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0)

ehd.SolveThreshold(mbs, 5000.0, 6000.0)

ehd.SolveEquilibrium(mbs, 300.0).place(exu.SystemContainer().AddSystem(), 300.0)

ehd.SolveEquilibrium(mbs, 300.0).place(mbs, 600.0)

ehd.SolveEquilibrium(mbs, 300.0).unbalance_response({exu.ObjectIndex(0): 1e-4})

ehd.SolveEquilibrium(mbs, 300.0).unbalance_response(1e-4)

ehd.SolveEquilibrium(mbs, 300.0).unbalance_response({body: 1e-4}).amplitude("middle")

point = mbs.CreateMassPoint(physicsMass=0.0)
mbs.CreateCartesianSpringDamper(itemNumbers=[exu.ObjectIndex(0), point], stiffness=[1e6] * 3); mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0)

other = mbs.CreateRigidBody(inertia=cube); mbs.CreateRevoluteJoint("hinge", [exu.ObjectIndex(0), other], centre, z)
ehd.CreateLubricatedJoint(mbs, "third", [exu.ObjectIndex(0), other], centre, z, bearing); mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0, rotors=[[body], [other]]).unbalance_response({body: 1e-4, other: 1e-4})

marker = averaged([[0.1, 0, 0], [-0.1, 0.1, 0], [0, -0.1, 0]], [1 / 3] * 3)
ehd.CreateLubricatedJoint(mbs, "third", [marker, body], [], z, bearing); mbs.Assemble()
ehd.SolveEquilibrium(mbs, 300.0)
""",
    ),
    Group(
        "Meshes, bushes and journals that deflect",
        "Arguments `bush` and `journal` of `JournalBearing`, meshes, and `CreateFlexibleBush`.",
        "bush",
        """
ehd.SaintVenantKirchhoff(youngs_modulus=210.0, poisson_ratio=0.3, density=7850.0)

ehd.SaintVenantKirchhoff(youngs_modulus=210e9, poisson_ratio=0.5, density=7850.0)

ehd.ElasticLiner(thickness=1.5, youngs_modulus=2e9)

ehd.HollowCylinder(inner_radius=0.025, thickness=0.005, length=0.025, axial=0)

ehd.HollowCylinder(inner_radius=25.0, thickness=0.005, length=0.025)

ehd.HollowCylinder(inner_radius=0.025, thickness=5e-3, length=0.025, axial=10**5, radial=10**4, circumferential=10**4)

steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
ehd.ModalBush(mesh=3, material=steel)

ehd.ModalBush(mesh=tube, material="steel")

ehd.ModalBush(mesh=tube, material=steel, tolerance=0.0)

ehd.ModalBush(mesh=tube, material=steel, tilted="no")

ehd.ModalBush(mesh=tube, material=steel, dynamics=True)

bush = ehd.ModalBush(mesh=tube, material=steel)
ehd.JournalBearing(**plain, film=ehd.ClassicSOR(), cavitation=ehd.Gumbel(), bush=bush)

ehd.JournalBearing(
    journal_radius=0.02, length=0.025, radial_clearance=25e-6, lubricant=oil,
    bush=ehd.ModalBush(mesh=tube, material=steel))

ehd.JournalBearing(
    journal_radius=0.025, length=0.05, radial_clearance=25e-6, lubricant=oil,
    bush=ehd.ModalBush(mesh=tube, material=steel))

eight = ehd.HollowCylinder(inner_radius=0.025, thickness=0.005, length=0.025, axial=1, radial=1, circumferential=8)
bushed = ehd.JournalBearing(**plain, bush=ehd.ModalBush(mesh=eight, material=steel))
ehd.steady(bushed, speed=300.0, eccentricity_ratio=0.2)

ehd.HeldBands(bands=())

pin = ehd.ElasticJournal(material=steel, span=(-0.01, 0.03), held=ehd.HeldEnds())
ehd.JournalBearing(**plain, journal=pin)

pin = ehd.ElasticJournal(material=steel, span=(-0.03, 0.03), held=ehd.HeldEnds(), inner_radius=0.0249)
ehd.JournalBearing(**plain, journal=pin)

pin = ehd.ElasticJournal(material=steel, span=(-0.03, 0.03), held=ehd.HeldBands(bands=((0.01, 0.04),)))
ehd.JournalBearing(**plain, journal=pin)

pin = ehd.ElasticJournal(material=steel, span=(-0.03, 0.04), held=None, tilted=False)
ehd.JournalBearing(**plain, journal=pin)

ehd.ElasticJournal(material=steel, span=(0.03, -0.03), held=ehd.HeldEnds())

pin = ehd.ElasticJournal(material=steel, span=(-0.03, 0.03), held=ehd.HeldEnds())
ehd.JournalBearing(**plain, journal=pin, bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9))

ehd.mesh_from_file("bush.inp", bore_radius=0.025)

Path("part.vtu").write_text("")
ehd.mesh_from_file("part.vtu", bore_radius=0.025, instance="bush")

ehd.mesh_from_arrays(mesh.nodes, mesh.elements[:, :8], bore_radius=0.025)

ehd.mesh_from_arrays(mesh.nodes, mesh.elements, bore_radius=0.02)

ehd.mesh_from_arrays(mesh.nodes, mesh.elements + 1, bore_radius=0.025)

ehd.mesh_from_arrays(mesh.nodes, mesh.elements, bore_radius=0.025, axis=(0, 0, 0))

ehd.mesh_from_arrays(mesh.nodes, [[1, 2], [3]], bore_radius=0.025)

ehd.mesh_from_arrays(mesh.nodes * [1, 1, -1], mesh.elements, bore_radius=0.025)

ehd.mesh_from_arrays(mesh.nodes, mesh.elements, bore_radius=0.025, held=ehd.OnCylinder(radius=0.05))

ehd.mesh_from_arrays(mesh.nodes, mesh.elements, bore_radius=0.025, held=lambda nodes: nodes[:, 0])

plane = ehd.OnPlane(point=(0, 0, 0.0125), normal=(0, 0, 1))
ehd.mesh_from_arrays(mesh.nodes, mesh.elements, bore_radius=0.025, held=plane)

ehd.OnPlane(point=(0, 0, 0), normal=(0, 0, 0))

mesh.generatrix(mesh.outer, 0.01)

mesh.line([0, 1])

mesh.bore.interpolation(np.array([0.0]), np.array([0.15]))

ehd.LineLoad(line=mesh.generatrix(mesh.outer, 0.0), force_per_length=(0, 1, 0), history=5.0)

ehd.DeadPressure(surface=mesh.bore, pressure=1e5, distribution=np.ones(3))

bush = ehd.ANCFBush(mesh=tube, material=steel)
ehd.CreateFlexibleBush(mbs, bush=bush, outer=ehd.CarriedOuter(itemNumber=ground))

bush = ehd.ANCFBush(mesh=tube, material=steel)
ehd.CreateFlexibleBush(mbs, bush=bush, outer=ehd.FreeOuter(), rotationMatrix=2 * np.eye(3))

bush = ehd.ANCFBush(mesh=tube, material=steel)
ehd.CreateFlexibleBush(mbs, bush=bush, outer=ehd.FreeOuter(), supports=[ehd.Support(nodes=np.array([99999]))])

bush = ehd.ANCFBush(mesh=tube, material=steel, damping=ehd.Rayleigh(mass_rate=1.0))
ehd.CreateFlexibleBush(mbs, bush=bush, outer=ehd.CarriedOuter(itemNumber=shaft))

bush, disc = ehd.ANCFBush(mesh=tube, material=steel), mbs.CreateRigidBody(inertia=cube, create2D=True)
lying = exu.utilities.RotationMatrixX(1.5)
ehd.CreateFlexibleBush(mbs, bush=bush, outer=ehd.CarriedOuter(itemNumber=disc), rotationMatrix=lying)

bush, held = ehd.ANCFBush(mesh=tube, material=steel), [ehd.Support(nodes=mesh.outer.nodes)]
ehd.CreateFlexibleBush(mbs, bush=bush, outer=ehd.CarriedOuter(itemNumber=shaft), supports=held)

bushed = ehd.JournalBearing(**plain, bush=ehd.ANCFBush(mesh=tube, material=steel))
light = mbs.CreateRigidBody(inertia=InertiaCuboid(density=1.0, sideLengths=[0.1, 0.1, 0.1]))
ehd.CreateLubricatedJoint(mbs, "main", [light, shaft], centre, z, bushed)

bushed = ehd.JournalBearing(**plain, bush=ehd.ModalBush(mesh=tube, material=steel))
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bushed)
mbs.Assemble(); ehd.SolveDynamic(mbs, settings, solverType=exu.DynamicSolverType.RK44)

bushed = ehd.JournalBearing(**plain, bush=ehd.ModalBush(mesh=tube, material=steel, tilted=False))
ehd.steady(bushed, speed=300.0, eccentricity_ratio=0.2, tilt=(5e-4, 0.0))

soft = ehd.SaintVenantKirchhoff(youngs_modulus=1e7, poisson_ratio=0.4, density=1200.0)
bushed = ehd.JournalBearing(**plain, bush=ehd.ModalBush(mesh=tube, material=soft))
ehd.steady(bushed, speed=3000.0, eccentricity_ratio=0.9)

ehd.ModalBush(mesh=tube, material=steel, quadrature="Gauss")

write("two.inp", "*Node", "1, 0, 0, 0", "*Node", "2, 0, 0, 0")
ehd.mesh_from_file("two.inp", bore_radius=0.025)

write("far.inp", "*Node", "1, 0, 0, 0", "*Include, input=elements.inp")
ehd.mesh_from_file("far.inp", bore_radius=0.025)

write("seat.inp", "*Node", "1, 0, 0, 0", "*Element, type=C3D10", "1, " + ", ".join(["1"] * 10))
ehd.mesh_from_file("seat.inp", bore_radius=0.025, held="seat")

ehd.mesh_from_fem(FEMinterface(), bore_radius=0.025)

bushed = ehd.JournalBearing(**plain, bush=ehd.ANCFBush(mesh=tube, material=steel))
joint = ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bushed)
mbs.Assemble(); joint.place_in_equilibrium(load=(0.0, -100.0))

ehd.FEBore(fem=None)

ehd.FEBore(fem=fem, nodes="bore")

ehd.steady(ehd.JournalBearing(**plain, bush=ehd.FEBore(fem=fem)), speed=300.0, eccentricity_ratio=0.5)

ehd.steady(ehd.JournalBearing(**plain, journal=ehd.FEJournal(fem=fem)), speed=300.0, eccentricity_ratio=0.5)

liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9)
ehd.JournalBearing(**plain, journal=ehd.FEJournal(fem=fem), bush=liner)

ehd.add_bore_modes(fem, position=centre, axis=[0, 0, 0], radius=0.025, length=0.02, fixed_nodes=[0, 1, 2])

ehd.add_bore_modes(fem, position=centre, axis=z, radius=0.02, length=0.02, fixed_nodes=[0, 1, 2])

ehd.add_bore_modes(fem, position=centre, axis=z, radius=0.025, length=0.05, fixed_nodes=[0, 1, 2])

fem.elements, where = [], {"position": centre, "axis": z, "radius": 0.025, "length": 0.02}
ehd.add_bore_modes(fem, **where, fixed_nodes=mesh.outer.nodes)

right = [node for node in mesh.bore.nodes if mesh.nodes[node, 0] > 0.0]
ehd.add_bore_modes(fem, position=centre, axis=z, radius=0.025, length=0.02, fixed_nodes=[0, 1, 2], nodes=right)

some, where = mesh.bore.nodes[::2], {"position": centre, "axis": z, "radius": 0.025, "length": 0.02}
ehd.add_bore_modes(fem, **where, fixed_nodes=mesh.outer.nodes, nodes=some)

ehd.add_bore_modes(fem, position=centre, axis=z, radius=0.025, length=0.02, fixed_nodes=[0])

ehd.add_bore_modes(fem, position=centre, axis=z, radius=0.025, length=0.02, fixed_nodes=[0, 1, 2], nodes=[9999])

bushed = ehd.JournalBearing(**plain, bush=ehd.ModalBush(mesh=tube, material=steel))
ehd.CreateLubricatedJoint(mbs, "main", sides, centre, z, bushed, bushGravity=[0, -9.81, 0])

bushed = ehd.JournalBearing(**plain, bush=ehd.ANCFBush(mesh=tube, material=steel))
ehd.CreateLubricatedJoint(mbs, "main", [cable(), shaft], [0.05, 0, 0], [1, 0, 0], bushed)
mbs.Assemble(); mbs.ComputeLinearizedSystem()

soft = ehd.ANCFBush(mesh=tube, material=dataclasses.replace(steel, youngs_modulus=1e5))
press = {"loads": [ehd.DeadPressure(surface=mesh.bore, pressure=1e9)], "outer": ehd.FreeOuter()}
ehd.CreateFlexibleBush(mbs, bush=soft, **press); mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

Path("plate.vtu").write_text("no mesh")
ehd.mesh_from_file("plate.vtu", bore_radius=0.025)

import meshio
meshio.write_points_cells("sheet.vtu", mesh.nodes, {"quad": mesh.elements[:, :4]})
ehd.mesh_from_file("sheet.vtu", bore_radius=0.025)

import sys
Path("bore.vtu").write_text(""); sys.modules["meshio"] = None
ehd.mesh_from_file("bore.vtu", bore_radius=0.025)

some = np.setdiff1d(mesh.outer.nodes, mesh.outer.faces[0, -1])
ehd.mesh_from_arrays(mesh.nodes, mesh.elements, bore_radius=0.025, held=some)

long = ehd.HollowCylinder(inner_radius=0.025, thickness=0.002, length=0.3, axial=12, radial=1, circumferential=24)
bush = ehd.ModalBush(mesh=long, material=steel, tolerance=0.002)
ehd.steady(ehd.JournalBearing(**{**plain, "length": 0.3}, bush=bush), speed=300.0, eccentricity_ratio=0.2)

import os; os.environ["EXUDYN_EHD_CACHE"] = "kept"
bushed = ehd.JournalBearing(**plain, bush=ehd.ModalBush(mesh=tube, material=steel))
for _ in "12": ehd.steady(bushed, speed=9.0, eccentricity_ratio=0.2), [f.write_text("") for f in Path("kept").iterdir()]

from exudyn_ehd.pictures.bush import contour_figure
contour_figure(mesh, [], label="stress in Pa")

from exudyn_ehd.solid.total_lagrange import StressRecovery
StressRecovery(mesh=mesh, material=steel).locate([[0.0, 0.0, 0.0]])

from exudyn_ehd.solid.total_lagrange import TotalLagrange
mirrored = dataclasses.replace(mesh, nodes=-mesh.nodes)
TotalLagrange(mesh=mirrored, material=steel).tangent(0 * mesh.nodes)
""",
    ),
    Group(
        "Finite-element bodies with films",
        "Raised for an ObjectFFRFreducedOrder as a joint's side, by `add_bore_modes` and by `ReplaceReducedBody`.",
        "reduced",
        """
ehd.CreateLubricatedJoint(mbs, "main", [housing, shaft], centre, z, bearing)

nodes = {"meshNodeNumbers": mesh.bore.nodes, "weightingFactors": 0 * mesh.bore.nodes + 1 / mesh.bore.nodes.size}
marker = mbs.AddMarker(eii.MarkerSuperElementRigid(bodyNumber=housing, **nodes))
ehd.CreateLubricatedJoint(mbs, "main", [marker, shaft], axis=z, bearing=bearing, axial=ehd.Held())

lined = ehd.JournalBearing(**wide, bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9))
ehd.CreateLubricatedJoint(mbs, "main", [housing, shaft], centre, z, lined)

pin = ehd.ElasticJournal(material=steel, span=(-0.03, 0.03), held=ehd.HeldEnds())
ehd.CreateLubricatedJoint(mbs, "main", [ground, housing], centre, z, ehd.JournalBearing(**plain, journal=pin))

turned = ehd.JournalBearing(**plain, journal=ehd.FEJournal(fem=fem), thrust=faces)
ehd.CreateLubricatedJoint(mbs, "main", [ground, housing], centre, z, turned)

other = FEMinterface()
other.nodes, bushed = {"Position": mesh.nodes[1:]}, ehd.JournalBearing(**wide, bush=ehd.FEBore(fem=other))
ehd.CreateLubricatedJoint(mbs, "main", [housing, shaft], centre, z, bushed)

ehd.ReplaceReducedBody(mbs, housing)
ehd.ReplaceReducedBody(mbs, housing)

ehd.ReplaceReducedBody(mbs, housing)
mbs.SetObjectParameter(housing, "computeFFRFterms", True)
mbs.Assemble(); ehd.SolveDynamic(mbs, settings)

fem.stiffnessMatrix = 0.0 * fem.stiffnessMatrix
ehd.add_bore_modes(fem, **bore)
""",
    ),
)
