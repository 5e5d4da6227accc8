"""The nodal bush inside Exudyn models: dynamic, static and eigenvalue runs, carriers, the own factorisation."""

import time

import exudyn as exu
import numpy as np
import pytest
from exudyn import itemInterface as items
from exudyn.rigidBodyUtilities import InertiaCuboid, RigidBodyInertia

from exudyn_ehd.coupling.items.bush import (
    CarriedOuter,
    CreateFlexibleBush,
    FixedOuter,
    FreeOuter,
    Support,
)
from exudyn_ehd.coupling.run.sparse import FactorReuse, SolveDynamicSparse
from exudyn_ehd.solid.bush import ANCFBush, Rayleigh
from exudyn_ehd.solid.loads import DeadPressure, FollowerPressure, LineLoad
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.mesh_import import mesh_from_fem
from exudyn_ehd.solid.total_lagrange import NeoHooke, SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import InputError, RunError
from tests.sampling import sample
from tests.solid_equilibrium import equilibrium
from tests.solid_vibrations import eigenfrequencies

SOFT = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
CYLINDER = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=1, radial=1, circumferential=8)
KINDS = [exu.NodeType.RotationEulerParameters, exu.NodeType.RotationRxyz, exu.NodeType.RotationRotationVector]
ADDITIVE = KINDS[:2]


class Model:
    """A container and a system; keeps both alive."""

    def __init__(self):
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()


def settings(steps, step, *, radius=0.9, tolerance=1e-8):
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = steps
    result.timeIntegration.endTime = steps * step
    result.timeIntegration.verboseMode = 0
    result.timeIntegration.generalizedAlpha.spectralRadius = radius
    result.timeIntegration.newton.relativeTolerance = tolerance
    result.staticSolver.verboseMode = 0
    result.solution.file.write = False
    result.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    return result


def pinched(model, *, damping=None, scale=400.0, extra=()):
    mesh = CYLINDER.mesh()
    low, top = mesh.generatrix(mesh.outer, -np.pi / 2), mesh.generatrix(mesh.outer, np.pi / 2)
    return CreateFlexibleBush(
        model.mbs,
        bush=ANCFBush(mesh=mesh, material=SOFT, damping=damping),
        outer=FreeOuter(),
        supports=[Support(nodes=low.nodes), Support(nodes=top.nodes, directions=(True, False, False))],
        loads=[LineLoad(line=top, force_per_length=(0.0, -scale, 0.0), history=lambda t: t), *extra],
    )


def carried(
    model, kind, *, material=SOFT, omega=(0.0, 0.0, 0.0), joint=False, damping=None, tilt=(0.0, 0.0, 0.0), loaded=True
):
    """A bush in a housing with its centre of mass off the bush axis."""
    housing = model.mbs.CreateRigidBody(
        referencePosition=[0.1, -0.2, 0.3],
        referenceRotationMatrix=exu.rigidBodyUtilities.RotXYZ2RotationMatrix(list(tilt)),
        inertia=InertiaCuboid(density=2000.0, sideLengths=[0.6, 0.7, 0.3]),
        nodeType=kind,
        initialAngularVelocity=list(omega),
    )
    if joint:
        ground = model.mbs.CreateGround()
        model.mbs.CreateGenericJoint(
            itemNumbers=[ground, housing], position=[0.1, -0.2, 0.3], constrainedAxes=[1, 1, 1, 1, 1, 1]
        )
    mesh = CYLINDER.mesh()
    load = DeadPressure(surface=mesh.bore, pressure=3e4, distribution=1 + mesh.bore.theta, history=lambda t: t)
    bush = CreateFlexibleBush(
        model.mbs,
        bush=ANCFBush(mesh=mesh, material=material, damping=damping),
        outer=CarriedOuter(itemNumber=housing),
        loads=[load] if loaded else [],
    )
    return bush, housing


def random_state(bush, seed, size=0.005):
    random = np.random.default_rng(seed)
    n = len(bush.mbs.systemData.GetObjectLTGODE2(bush.objectNumber))
    q, q_t = size * random.standard_normal((2, n))
    return q, 20 * q_t


def jacobian_error(bush, q, q_t, position, velocity):
    """Largest error of the Jacobian's products against extrapolated differences."""
    equations = bush.equations
    J = equations.jacobian(None, 0.7, 0, q, q_t, position, velocity)
    random = np.random.default_rng(16)
    worst = 0.0
    for _ in range(4):
        d = random.standard_normal(len(q))
        d[equations._held] = 0.0

        def slope(step, d=d):
            def force(s):
                return equations.forces(0.7, q + s * position * d, q_t + s * velocity * d)

            return -(force(step) - force(-step)) / (2 * step)

        step = 1e-5
        expected = (4 * slope(step) - slope(2 * step)) / 3
        worst = max(worst, np.abs(J @ d - expected).max() / np.abs(expected).max())
    return worst


def test_jacobian_with_supports_loads_and_mass_damping_is_exact():
    model = Model()
    mesh = CYLINDER.mesh()
    bush = pinched(model, damping=Rayleigh(mass_rate=3.0), extra=[FollowerPressure(surface=mesh.bore, pressure=2e4)])
    model.mbs.Assemble()
    q, q_t = random_state(bush, 17)
    q[bush.equations._held] = 0.0
    assert jacobian_error(bush, q, q_t, 1.0, 0.0) < 1e-7
    assert jacobian_error(bush, q, q_t, 0.0, 1.0) < 1e-7


@pytest.mark.parametrize("kind", ADDITIVE)
def test_jacobian_of_a_carried_bush_at_rest_is_exact(kind):
    model = Model()
    bush, _ = carried(model, kind, tilt=(0.3, -0.2, 0.5))
    model.mbs.Assemble()
    q, _ = random_state(bush, 18)
    assert jacobian_error(bush, q, 0 * q, 1.0, 0.0) < 1e-7


def test_exudyn_receives_this_jacobian_and_mass():
    model = Model()
    bush = pinched(model)
    model.mbs.Assemble()
    M, K, _ = model.mbs.ComputeLinearizedSystem()
    zero = np.zeros(len(M))
    assert np.allclose(K, bush.equations.jacobian(None, 0.0, 0, zero, zero, 1.0, 0.0).toarray(), rtol=1e-12)
    assert np.allclose(M, bush.equations.mass(None).toarray(), rtol=1e-12)


def test_static_run_of_exudyn_finds_the_same_equilibrium():
    model = Model()
    bush = pinched(model, scale=100.0)
    model.mbs.Assemble()
    options = settings(1, 1.0)
    options.staticSolver.numberOfLoadSteps = 3
    model.mbs.SolveStatic(options)
    load = bush.equations.loads[0]
    expected = equilibrium(
        bush.solid, held=bush.equations.held, loads=[LineLoad(line=load.line, force_per_length=load.force_per_length)]
    ).displacements
    # Exudyn's static tolerance is 1e-8 on the residual
    assert np.allclose(bush.displacements(), expected, atol=1e-6 * np.abs(expected).max())


def test_eigenvalues_of_exudyn_are_those_of_the_solid():
    model = Model()
    mesh = CYLINDER.mesh()
    bush = CreateFlexibleBush(model.mbs, bush=ANCFBush(mesh=mesh, material=SOFT), outer=FixedOuter())
    model.mbs.Assemble()
    square, _ = model.mbs.ComputeODE2Eigenvalues()
    omega, _ = eigenfrequencies(bush.solid, held=bush.equations.held, count=8)
    assert np.allclose(np.sqrt(square[:8]), omega, rtol=1e-7)


def test_single_directions_are_held_and_their_spring_stays_above_all_modes():
    model = Model()
    bush = pinched(model)
    model.mbs.Assemble()
    square, _ = model.mbs.ComputeODE2Eigenvalues()
    omega, _ = eigenfrequencies(bush.solid, held=bush.equations.held, count=8)
    assert np.allclose(np.sqrt(np.asarray(square)[:8]), omega, rtol=1e-6)
    count = len(bush.equations._held)
    assert count == 3 and square[-count] > 10 * square[-count - 1]


def test_a_force_of_another_item_on_a_held_direction_goes_to_ground():
    model = Model()
    bush = pinched(model, scale=100.0)
    top = bush.equations.loads[0].line.nodes[1]
    marker = model.mbs.AddMarker(items.MarkerNodePosition(nodeNumber=exu.NodeIndex(int(bush.nodeNumbers[top]))))
    model.mbs.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=[1000.0, 0.0, 0.0]))
    model.mbs.Assemble()
    model.mbs.SolveStatic(settings(1, 1.0))
    u = bush.displacements()
    # 1000 N on a spring 1e9 times the mesh's own stiffness of about 1e5 N/m
    assert 0 < u[top, 0] < 1e-10
    load = bush.equations.loads[0]
    expected = equilibrium(
        bush.solid, held=bush.equations.held, loads=[LineLoad(line=load.line, force_per_length=load.force_per_length)]
    ).displacements
    assert np.allclose(u, expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("damping", [None, Rayleigh(mass_rate=0.5, stiffness_time=1e-3)])
@pytest.mark.parametrize("radius", [1.0, 0.7])
def test_own_factorisation_gives_the_solution_of_exudyn_s_solver(damping, radius):
    shapes = []
    for own in (False, True):
        model = Model()
        bush = pinched(model, damping=damping)
        model.mbs.Assemble()
        options = settings(40, 5e-3, radius=radius, tolerance=1e-10)
        if own:
            run = SolveDynamicSparse(model.mbs, options)
            assert run.success and run.steps == 40 and run.rejected == 0
            assert run.jacobians < run.steps < run.iterations
        else:
            model.mbs.SolveDynamic(options)
        shapes.append(np.concatenate([bush.displacements(), 0.1 * bush.velocities()]))
    # both stop at a residual of 1e-10 of the step's first one
    assert np.allclose(shapes[0], shapes[1], atol=1e-8 * np.abs(shapes[0]).max())


@pytest.mark.slow
@pytest.mark.parametrize("kind", ADDITIVE)
def test_own_factorisation_serves_bodies_joints_and_constraints_too(kind):
    """Carried bush, housing on a spherical joint with an inactive-axes generic joint, a spring to a mass point."""
    shapes = []
    for own in (False, True):
        model = Model()
        mbs = model.mbs
        bush, housing = carried(model, kind, omega=(1.0, 2.0, -3.0))
        ground = mbs.CreateGround()
        point = mbs.CreateMassPoint(referencePosition=[1.0, 0.0, 0.0], mass=30.0)
        mbs.CreateGenericJoint(
            itemNumbers=[ground, housing], position=[0.1, 0.2, 0.3], constrainedAxes=[1, 1, 1, 0, 0, 0]
        )
        mbs.CreateSpringDamper(itemNumbers=[housing, point], stiffness=1e4, damping=10.0)
        mbs.Assemble()
        options = settings(50, 2e-3, tolerance=1e-10)
        if own:
            SolveDynamicSparse(mbs, options)
        else:
            mbs.SolveDynamic(options)
        state = mbs.systemData.GetODE2Coordinates()
        shapes.append(np.concatenate([bush.displacements().ravel(), state]))
    assert np.abs(shapes[0]).max() > 0.05
    assert np.allclose(shapes[0], shapes[1], atol=1e-7 * np.abs(shapes[0]).max())


@pytest.mark.slow
def test_a_carrier_welded_to_ground_equals_a_fixed_outer_surface():
    shapes = []
    for fixed in (False, True):
        model = Model()
        mesh = CYLINDER.mesh()
        if fixed:
            loads = [
                DeadPressure(surface=mesh.bore, pressure=3e4, distribution=1 + mesh.bore.theta, history=lambda t: t)
            ]
            bush = CreateFlexibleBush(
                model.mbs, bush=ANCFBush(mesh=mesh, material=SOFT), outer=FixedOuter(), loads=loads
            )
        else:
            bush, _ = carried(model, KINDS[0], joint=True)
        model.mbs.Assemble()
        model.mbs.SolveDynamic(settings(40, 5e-3, tolerance=1e-10))
        shapes.append(bush.displacements())
    assert np.abs(shapes[1]).max() > 1e-4
    assert np.allclose(shapes[0], shapes[1], atol=1e-7 * np.abs(shapes[1]).max())


@pytest.mark.slow
@pytest.mark.parametrize("kind", sample(KINDS, 2))
def test_a_tumbling_housing_with_a_stiff_bush_moves_as_one_rigid_body(kind):
    """The carried mass enters the housing's equations with its velocity terms: compare with the summed inertia."""
    omega, steps, step = (3.0, -4.0, 5.0), 60, 2e-3
    stiff = SaintVenantKirchhoff(youngs_modulus=1e12, poisson_ratio=0.3, density=7800.0)
    model = Model()
    # damping takes out the breathing at the start, when the centrifugal load is applied at once
    bush, housing = carried(
        model, kind, material=stiff, omega=omega, damping=Rayleigh(stiffness_time=1e-6), loaded=False
    )
    x, M = bush.solid.mesh.nodes, bush.solid.scalar_mass
    mass = M.sum()
    local = x - [0.1, -0.2, 0.3]
    second = local.T @ (M @ local)
    own = InertiaCuboid(density=2000.0, sideLengths=[0.6, 0.7, 0.3])
    total = RigidBodyInertia(
        mass=own.mass + mass,
        com=(M @ local).sum(axis=0) / (own.mass + mass),
        inertiaTensor=own.inertiaTensor + np.trace(second) * np.eye(3) - second,
    )
    single = Model()
    body = single.mbs.CreateRigidBody(
        referencePosition=[0.1, -0.2, 0.3], inertia=total, nodeType=kind, initialAngularVelocity=list(omega)
    )
    for each in (model, single):
        each.mbs.Assemble()
        options = settings(steps, step, tolerance=1e-8)
        # a bush this stiff makes Exudyn's modified Newton restart often, upon which Lie group nodes end wrong
        options.timeIntegration.newton.useModifiedNewton = False
        each.mbs.SolveDynamic(options)
    variable = exu.OutputVariableType.RotationMatrix
    turned = np.array(model.mbs.GetObjectOutputBody(housing, variable, [0, 0, 0]))
    expected = np.array(single.mbs.GetObjectOutputBody(body, variable, [0, 0, 0]))
    # the body has turned by 0.8 rad; the bush's strain under rotation is 1e-8; the Newton tolerance adds up to 1e-6
    assert np.allclose(turned, expected, atol=2e-5)
    assert np.abs(turned - np.eye(9)[0].reshape(-1)).max() > 0.5


def free_swing(model, *, omega=(0.0, 0.0, 0.0), amplitude=1e-3):
    """A free cylinder started in its lowest flexural mode with a velocity; returns bush and angular frequency."""
    mesh = CYLINDER.mesh()
    bush = CreateFlexibleBush(
        model.mbs, bush=ANCFBush(mesh=mesh, material=SOFT), outer=FreeOuter(), initialAngularVelocity=omega
    )
    frequency, modes = eigenfrequencies(bush.solid, count=7)
    shape = modes[6] / np.abs(modes[6]).max()
    for node, v in zip(bush.nodeNumbers, shape * amplitude * frequency[6], strict=True):
        index = exu.NodeIndex(int(node))
        start = np.array(model.mbs.GetNode(index)["initialVelocities"])
        model.mbs.SetNodeParameter(index, "initialVelocities", start + v)
    model.mbs.Assemble()
    return bush, float(frequency[6])


def energy_errors(steps_per_period, periods, **options):
    """Relative energy error at the samples, and momenta before and after."""
    model = Model()
    bush, frequency = free_swing(model, **options)
    history = []

    def record(mbs, t):
        history.append(sum(bush.energy()))
        return True

    model.mbs.SetPostStepUserFunction(record)
    before = bush.momentum(exu.ConfigurationType.Initial)
    start = sum(bush.energy(exu.ConfigurationType.Initial))
    step = 2 * np.pi / frequency / steps_per_period
    run = settings(int(steps_per_period * periods), step, radius=1.0, tolerance=1e-10)
    SolveDynamicSparse(model.mbs, run)
    return np.array(history) / start - 1, before, bush.momentum()


@pytest.mark.slow
def test_energy_error_of_a_free_undamped_cylinder_falls_at_second_order():
    largest = [np.abs(energy_errors(n, 2, amplitude=0.02)[0]).max() for n in (40, 80, 160)]
    rates = np.log2(np.array(largest[:-1]) / largest[1:])
    assert np.all(np.abs(rates - 2) < 0.3), (largest, rates)


@pytest.mark.slow
def test_energy_does_not_drift_over_100_periods_and_momenta_are_kept():
    errors, before, after = energy_errors(40, 100, amplitude=0.005)
    first, last = errors[: len(errors) // 10], errors[-(len(errors) // 10) :]
    # the error swings with the motion; its mean over the last ten periods stays where it was in the first ten
    assert abs(last.mean() - first.mean()) < 0.2 * np.abs(errors).max() + 1e-9
    assert np.abs(last).max() < 1.5 * np.abs(first).max() + 1e-9
    mass, speed = 7800 * np.pi * (0.275**2 - 0.225**2) * 0.2, 0.005 * 7
    # linear momentum is conserved by the method up to the Newton tolerance; reported: angular momentum too in plane
    # motion
    assert np.abs(after[0] - before[0]).max() < 1e-6 * mass * speed
    assert np.abs(after[1] - before[1]).max() < 1e-4 * mass * speed * 0.25


def test_momentum_of_a_spinning_swinging_cylinder():
    """Linear momentum is kept; generalized-alpha keeps angular momentum at second order: reported by its rate."""
    drifts = []
    for steps in (40, 80):
        _, before, after = energy_errors(steps, 1, amplitude=0.01, omega=(0.0, 0.0, 2.0))
        assert np.abs(after[0] - before[0]).max() < 1e-7 * np.abs(before[1]).max()
        drifts.append(np.abs(after[1] - before[1]).max() / np.abs(before[1]).max())
    assert drifts[0] < 1e-2 and np.log2(drifts[0] / drifts[1]) > 1.6


def test_rayleigh_damping_takes_the_closed_form_decrement():
    """A mode's energy falls as exp(-2 zeta omega t) with zeta = (mass_rate/omega + stiffness_time omega)/2."""
    mesh = CYLINDER.mesh()
    held = np.zeros(mesh.nodes.shape, dtype=bool)
    held[mesh.outer.nodes] = True
    frequency, modes = eigenfrequencies(TotalLagrange(mesh=mesh, material=SOFT), held=held, count=1)
    omega = float(frequency[0])
    damping = Rayleigh(mass_rate=0.05 * omega, stiffness_time=0.05 / omega)
    zeta = 0.05
    model = Model()
    bush = CreateFlexibleBush(model.mbs, bush=ANCFBush(mesh=mesh, material=SOFT, damping=damping), outer=FixedOuter())
    for node, v in zip(bush.nodeNumbers, 1e-6 * omega * modes[0] / np.abs(modes[0]).max(), strict=True):
        if model.mbs.GetNode(exu.NodeIndex(int(node)))["nodeType"] == "Point":
            model.mbs.SetNodeParameter(exu.NodeIndex(int(node)), "initialVelocities", v)
    model.mbs.Assemble()
    start = sum(bush.energy(exu.ConfigurationType.Initial))
    period = 2 * np.pi / (omega * np.sqrt(1 - zeta**2))
    SolveDynamicSparse(model.mbs, settings(400, period / 400, radius=1.0))
    # one full damped period: the decrement is exact for a linear system; 400 steps leave 1e-3
    assert sum(bush.energy()) / start == pytest.approx(np.exp(-2 * zeta * omega * period), rel=5e-3)


def test_a_bush_at_another_place_and_attitude_deforms_alike():
    rotation = np.array(exu.rigidBodyUtilities.RotXYZ2RotationMatrix([0.4, -0.7, 1.2]))
    shapes = []
    for place, turn in (((0, 0, 0), np.eye(3)), ((1.0, 2.0, -3.0), rotation)):
        model = Model()
        mesh = CYLINDER.mesh()
        load = FollowerPressure(surface=mesh.bore, pressure=5e4, distribution=np.cos(mesh.bore.theta) ** 2)
        bush = CreateFlexibleBush(
            model.mbs,
            bush=ANCFBush(mesh=mesh, material=SOFT),
            outer=FixedOuter(),
            position=place,
            rotationMatrix=turn,
            loads=[load],
        )
        model.mbs.Assemble()
        model.mbs.SolveStatic(settings(1, 1.0))
        shapes.append(bush.displacements() @ turn)
    assert np.allclose(shapes[0], shapes[1], atol=1e-8 * np.abs(shapes[0]).max())


def test_unusable_input_is_refused_with_the_next_step():
    model = Model()
    mesh = CYLINDER.mesh()
    bush = ANCFBush(mesh=mesh, material=SOFT)
    ground = model.mbs.CreateGround()
    with pytest.raises(InputError, match="use FixedOuter"):
        CreateFlexibleBush(model.mbs, bush=bush, outer=CarriedOuter(itemNumber=ground))
    with pytest.raises(InputError, match="rotationMatrix must be orthonormal and right-handed"):
        CreateFlexibleBush(model.mbs, bush=bush, outer=FreeOuter(), rotationMatrix=2 * np.eye(3))
    with pytest.raises(InputError, match=r"Support.nodes must be mesh nodes"):
        CreateFlexibleBush(model.mbs, bush=bush, outer=FreeOuter(), supports=[Support(nodes=np.array([99999]))])
    with pytest.raises(InputError, match=r"ANCFBush.mesh must be a HollowCylinder or a BushMesh"):
        ANCFBush(mesh=3, material=SOFT)
    with pytest.raises(InputError, match="mass_rate = 0"):
        carried(model, KINDS[0], damping=Rayleigh(mass_rate=1.0))


def test_own_factorisation_refuses_lie_group_nodes_with_the_way_out():
    model = Model()
    model.mbs.CreateRigidBody(inertia=InertiaCuboid(density=1000.0, sideLengths=[1, 1, 1]), nodeType=KINDS[2])
    model.mbs.Assemble()
    with pytest.raises(InputError, match="must have additive coordinates only, got node 0"):
        SolveDynamicSparse(model.mbs)


def test_factor_reuse_changes_the_cost_and_not_the_answer():
    shapes, costs = [], []
    for reuse in (FactorReuse(contractivity=1e-9), FactorReuse()):
        model = Model()
        bush = pinched(model)
        model.mbs.Assemble()
        run = SolveDynamicSparse(model.mbs, settings(20, 1e-2, tolerance=1e-10), reuse=reuse)
        shapes.append(bush.displacements())
        costs.append(run.jacobians)
    assert costs[0] > 2 * costs[1]
    assert np.allclose(shapes[0], shapes[1], atol=1e-8 * np.abs(shapes[0]).max())


def test_a_mesh_read_by_exudyn_from_an_abaqus_file_becomes_the_same_bush(tmp_path):
    from exudyn.FEM import FEMinterface

    mesh = CYLINDER.mesh()
    lines = ["*Part, name=Part-1", "*Node"]
    lines += [f"{i}, {x:.16g}, {y:.16g}, {z:.16g}" for i, (x, y, z) in enumerate(mesh.nodes, start=1)]
    lines += ["*Element, type=C3D20"]
    for i, element in enumerate(mesh.elements + 1, start=1):
        text = [str(n) for n in (i, *element)]
        lines += [", ".join(text[:16]) + ",", ", ".join(text[16:])]
    file = tmp_path / "bush.inp"
    file.write_text("\n".join([*lines, "*End Part"]) + "\n")
    fem = FEMinterface()
    fem.ImportFromAbaqusInputFile(str(file))
    read = mesh_from_fem(fem, bore_radius=0.225)
    assert np.array_equal(read.elements, mesh.elements)
    assert np.array_equal(read.bore.nodes, mesh.bore.nodes)
    assert np.allclose(read.nodes, mesh.nodes, atol=1e-14)


def test_the_renderer_gets_all_boundary_faces_of_a_free_bush_and_outward_triangles():
    model = Model()
    bush = pinched(model)
    triangles = np.asarray(model.mbs.GetObject(bush.objectNumber)["VtriangleMesh"])
    assert len(triangles) == 6 * len(bush.mesh.boundary)
    # object nodes are mesh nodes in mesh order: the enclosed volume by the divergence theorem is the solid's
    corner = bush.mesh.nodes[triangles]
    volume = np.einsum("ti,ti->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6
    assert volume == pytest.approx(np.pi * (0.275**2 - 0.225**2) * 0.2, rel=0.11)  # facets across 45 degrees: sin(x)/x


@pytest.mark.slow
def test_own_factorisation_equals_exudyn_s_solver_on_the_paper_s_mesh():
    shapes = []
    for own in (False, True):
        model = Model()
        cylinder = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=4, radial=2, circumferential=40)
        mesh = cylinder.mesh()
        low, top = mesh.generatrix(mesh.outer, -np.pi / 2), mesh.generatrix(mesh.outer, np.pi / 2)
        bush = CreateFlexibleBush(
            model.mbs,
            bush=ANCFBush(mesh=mesh, material=SOFT),
            outer=FreeOuter(),
            supports=[Support(nodes=low.nodes), Support(nodes=top.nodes, directions=(True, False, False))],
            loads=[LineLoad(line=top, force_per_length=(0.0, -1000.0, 0.0), history=lambda t: t)],
        )
        model.mbs.Assemble()
        options = settings(100, 3e-3)
        if own:
            print(SolveDynamicSparse(model.mbs, options).report())
        else:
            start = time.perf_counter()
            model.mbs.SolveDynamic(options)
            counts = model.mbs.sys["dynamicSolver"].it
            print(
                f"Exudyn alone: {time.perf_counter() - start:.1f} s, {counts.newtonStepsCount} iterations, "
                f"{counts.newtonJacobiCount} Jacobians"
            )
        shapes.append(bush.displacements())
    # both stop at 1e-8 of the step's first residual; 100 steps add up
    assert np.abs(shapes[0]).max() > 0.01
    assert np.allclose(shapes[0], shapes[1], atol=1e-6 * np.abs(shapes[0]).max())


def pressed(material, pressure, steps=20):
    """A rubber ring, held outside, pressed on one side of its bore within 10 ms, and its smallest det F."""
    model = Model()
    mesh = HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.02, axial=1, radial=2, circumferential=12).mesh()
    load = FollowerPressure(
        surface=mesh.bore,
        pressure=pressure,
        distribution=np.maximum(np.cos(mesh.bore.theta), 0.0) ** 3,
        history=lambda t: min(t / 0.01, 1.0),
    )
    bush = CreateFlexibleBush(
        model.mbs,
        "pad",
        bush=ANCFBush(mesh=mesh, material=material, damping=Rayleigh(stiffness_time=1e-4)),
        outer=FixedOuter(),
        loads=[load],
    )
    model.mbs.Assemble()
    SolveDynamicSparse(model.mbs, settings(steps, 0.01 / steps, radius=0.6, tolerance=1e-6))
    return bush


def test_elements_that_turn_inside_out_end_a_run_and_neo_hooke_bears_five_times_as_much():
    rubber = {"youngs_modulus": 5e6, "poisson_ratio": 0.45, "density": 1100.0}
    with pytest.raises(RunError, match=r"'pad' at t = 0\.00.* element \d+ at .*inside out .det F = -.*NeoHooke"):
        pressed(SaintVenantKirchhoff(**rubber), 5e6, 40)
    bush = pressed(NeoHooke(**rubber), 5e6)
    assert bush.solid.inversion(bush.displacements()) == ""
