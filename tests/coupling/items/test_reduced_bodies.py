"""The film in the bore of a user's ObjectFFRFreducedOrder: against a modal bush of the same mesh, a rigid bore, and
itself moved."""

import copy

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.advancedUtilities import NumericalJacobian
from exudyn.FEM import ObjectFFRFreducedOrderInterface
from exudyn.utilities import InertiaCylinder
from scipy.sparse.linalg import spsolve

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError
from tests.finite_elements import fem_of

C, SPEED, LOAD = 30e-6, 314.0, 15e3
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=3, radial=2, circumferential=20)
TOLERANCE = 0.05


def material(youngs_modulus):
    return ehd.SaintVenantKirchhoff(youngs_modulus=youngs_modulus, poisson_ratio=0.3, density=7800.0)


def bearing(bush):
    return ehd.JournalBearing(
        journal_radius=0.03,
        length=0.066,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=9e-3),
        film=ehd.FiniteLength(n_theta=48, n_z=8),
        bush=bush,
    )


def bush_body(mbs, youngs_modulus=5e10, held=True, rotation=None, tolerance=TOLERANCE, tilted=True, **options):
    """The cylinder as reduced body, its outer surface carrying the frame; returns the parts, the FEMinterface and the
    report."""
    mesh = CYLINDER.mesh()
    fem = fem_of(mesh, material(youngs_modulus))
    report = ehd.add_bore_modes(
        fem,
        position=[0, 0, 0],
        axis=[0, 0, 1],
        radius=0.03,
        length=0.066,
        fixed_nodes=mesh.outer.nodes,
        tolerance=tolerance,
        tilted=tilted,
    )
    cms = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType="NodeType.RotationRxyz")
    parts = cms.AddObjectFFRFreducedOrder(mbs, rotationMatrixRef=[] if rotation is None else rotation, **options)
    if held:
        markers = [
            mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=mbs.CreateGround())),
            mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=parts["nRigidBody"])),
        ]
        mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=[1] * 6))
    return parts["oFFRFreducedOrder"], fem, report


def journal_run(kind, youngs_modulus=5e10, steps=60, step=1e-4, exact=True):
    """Record of a free journal of 6.6 kg under a swinging load; it stays parallel, so that half of the modes do."""
    mbs = scenes.new_system()
    bush = None
    housing = None
    if kind == "reduced body":
        housing, fem, _ = bush_body(mbs, youngs_modulus, tilted=False)
        bush = ehd.FEBore(fem=fem, exact_jacobian=exact)
    elif kind == "modal bush":
        bush = ehd.ModalBush(mesh=CYLINDER, material=material(youngs_modulus), tolerance=TOLERANCE, tilted=False)
    journal = mbs.CreateRigidBody(
        initialDisplacement=[0.4 * C, -0.5 * C, 0],
        initialAngularVelocity=[0, 0, SPEED],
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
        nodeType=exu.NodeType.RotationRxyz,
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name=kind,
        itemNumbers=[mbs.CreateGround() if housing is None else housing, journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing(bush),
    )
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, 0]))

    def swing(mbs, t, vector):
        return [0.4 * LOAD * np.sin(SPEED * t), -LOAD * (1 - 0.3 * np.cos(SPEED * t)), 0]

    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, -LOAD, 0], loadVectorUserFunction=swing))
    mbs.Assemble()
    settings = scenes.settings(steps * step, steps, tolerance=1e-8)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    mbs.SolveDynamic(settings)
    return joint.history


@pytest.mark.slow
def test_reduced_body_is_the_modal_bush_of_the_same_mesh(measured):
    """Same mesh, modes and film, but that the body's modes have mass and its frame follows the bore; both start
    settled."""
    rigid, modal, body = (journal_run(kind, steps=40) for kind in ("rigid", "modal bush", "reduced body"))
    after = slice(10, None)
    for name in ("peak_pressure", "minimum_gap"):
        expected = getattr(modal, name)[after]
        measured(name, np.abs(getattr(body, name)[after] / expected - 1.0).max(), 0.01)
    # and the elasticity matters here
    assert np.abs(rigid.peak_pressure[after] / modal.peak_pressure[after] - 1.0).max() > 0.05


@pytest.mark.slow
def test_exact_jacobian_changes_nothing_but_the_time(measured):
    """To Newton's tolerance, 1e-8 of a step's forces."""
    ours, exudyns = (journal_run("reduced body", steps=6, exact=exact) for exact in (True, False))
    for name in ("peak_pressure", "minimum_gap"):
        expected = getattr(exudyns, name)
        measured(name, np.abs(getattr(ours, name) / expected - 1.0).max(), 1e-6)


@pytest.mark.slow
def test_stiff_reduced_body_is_a_rigid_bore(measured):
    """The deviation falls with the compliance: 1.4e-2, 1.5e-3, 1.5e-4 at 1e2, 1e3, 1e4 times steel's modulus, most of
    it in the first steps, where the bore takes up its motion."""
    rigid, body = journal_run("rigid", steps=20), journal_run("reduced body", youngs_modulus=2.1e15, steps=20)
    for name in ("peak_pressure", "eccentricity"):
        expected = getattr(rigid, name)
        measured(name, np.abs(getattr(body, name) - expected).max() / np.abs(expected).max(), 3e-4)


def moving():
    """A free body and its journal, turned and moving, at a random state."""
    mbs = scenes.new_system()
    rotation = scenes.rotation([0.3, -0.5, 0.2])
    body, fem, _ = bush_body(mbs, held=False, rotation=rotation, tolerance=0.2)
    journal = scenes.add_body(mbs, "Rxyz", matrix=rotation)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[body, journal],
        position=[0, 0, 0],
        axis=rotation[:, 2],
        bearing=bearing(ehd.FEBore(fem=fem, settled=False)),
    )
    mbs.Assemble()
    rng = np.random.default_rng(2)
    n = mbs.systemData.ODE2Size()
    q, q_t = np.zeros(n), np.zeros(n)
    modes = slice(6, n - 6)
    q[modes] = 2e-7 * rng.normal(size=n - 12)
    q_t[modes] = 1e-5 * rng.normal(size=n - 12)
    q[n - 6 :] = [5e-6, -8e-6, 3e-6, 1e-5, -2e-5, 0.3]
    # a common rigid motion, and the journal's own on top
    q_t[:6] = q_t[n - 6 :] = [0.1, 0.2, -0.1, 0.4, -0.3, 0.5]
    q_t[n - 6 :] += [1e-3, 2e-3, 0, 1e-3, 1e-3, 200.0]
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    return mbs, joint


def test_jacobian_is_the_derivative_of_the_force():
    """Steps of 1e-9 against a gap of 2e-5 m: (5e-5)^2 of truncation, 1e-16 / 5e-5 of rounding, a film's kinks at its
    rupture; 1e-4 of a coordinate's largest entry."""
    mbs, joint = moving()
    places = list(range(mbs.systemData.ODE2Size()))

    def full(values):
        """Assembled over the modes, which the object lists twice."""
        out = np.zeros((len(places), *np.shape(values)[1:]))
        np.add.at(out, mbs.systemData.GetObjectLTGODE2(joint.objectNumber), values)
        return out

    def lhs():
        return full(np.array(mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS)))

    for item, step in ((exu.ComputeItemType.JacobianODE2, 1e-9), (exu.ComputeItemType.JacobianODE2_t, 1e-7)):
        exact = full(full(np.array(mbs.ComputeItem(joint.objectNumber, item))).T).T
        numeric = NumericalJacobian(mbs, lhs, places, velocities=step == 1e-7, epsilon=step)
        scale = np.abs(numeric).max(axis=1, keepdims=True)
        assert np.all(np.abs(exact - numeric) < 1e-4 * scale + 1e-9 * np.abs(numeric).max())


@pytest.mark.slow
def test_film_does_no_work_in_a_common_rigid_motion():
    mbs, joint = moving()
    element = joint.element
    loads = np.array(mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS))
    housing, journal = element.sides
    rng = np.random.default_rng(0)
    shift, turn = rng.normal(size=3), rng.normal(size=3)
    work = scale = 0.0
    n = housing.size
    for side, node, place in ((housing, 0, slice(0, 6)), (journal, 2, slice(n, n + 6))):
        origin = np.array(mbs.GetNodeOutput(exu.NodeIndex(node), exu.OutputVariableType.Position))
        variation = np.concatenate([shift + np.cross(turn, origin), np.linalg.solve(side.jac[1][:, 3:6], turn)])
        work += loads[place] @ variation
        scale += np.abs(loads[place] * variation).sum()
    # rounding of forces times arms
    assert abs(work) < 1e-12 * scale


@pytest.mark.slow
def test_reduced_body_and_journal_fall_with_g(measured):
    """The momentum of all nodes grows by the weight. The error of 2e-8 is the time integration's: 9e-7 with half of the
    steps, 5e-9 with twice as many."""
    mbs, gravity, rotation = scenes.new_system(), np.array([3.0, -9.81, 4.0]), scenes.rotation([0.3, -0.5, 0.2])
    weight = {"gravity": gravity.tolist()}
    body, fem, _ = bush_body(mbs, held=False, rotation=rotation, tolerance=0.2, tilted=False, **weight)
    inertia = InertiaCylinder(7800, 0.3, 0.03, 2)
    journal = mbs.CreateRigidBody(
        referenceRotationMatrix=rotation,
        initialDisplacement=list(rotation @ [0.4 * C, -0.5 * C, 0.0]),
        initialAngularVelocity=list(SPEED * rotation[:, 2]),
        inertia=inertia,
        nodeType=exu.NodeType.RotationRxyz,
        **weight,
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="bore",
        itemNumbers=[body, journal],
        position=[0, 0, 0],
        axis=rotation[:, 2],
        bearing=bearing(ehd.FEBore(fem=fem)),
    )
    mbs.Assemble()
    end, velocity = 1e-4, exu.OutputVariableType.Velocity
    mbs.SolveDynamic(scenes.settings(end, 10, tolerance=1e-9, full_newton=False))
    nodes = range(len(fem.nodes["Position"]))
    flow = fem.massMatrix @ np.ravel([mbs.GetObjectOutputSuperElement(body, velocity, i) for i in nodes])
    own, mass = flow.reshape(-1, 3).sum(axis=0), fem.massMatrix.sum() / 3.0
    whole = own + inertia.Mass() * np.array(mbs.GetObjectOutputBody(journal, velocity, [0, 0, 0]))
    fallen = whole / ((mass + inertia.Mass()) * end)
    measured("momentum over mass, g t", np.abs(fallen - gravity).max() / 9.81, 1e-6)
    # and the film pushes one away from the other
    assert np.abs(own / (mass * end) - gravity).max() > 9.81
    assert np.abs(joint.history.force).max() > 100.0
    # the renderer draws the film, and leaves the body to itself
    assert joint.display.graphics(mbs, 0)


@pytest.mark.slow
def test_modes_report_and_modes_beyond_those_that_are_there():
    mesh = CYLINDER.mesh()
    fem = fem_of(mesh, material(2.1e11))
    fem.ComputeHurtyCraigBamptonModes([list(mesh.outer.nodes)], 6)
    old = fem.modeBasis["matrix"].copy()
    report = ehd.add_bore_modes(
        fem, position=[0, 0, 0], axis=[0, 0, 1], radius=0.03, length=0.066, fixed_nodes=mesh.outer.nodes, tolerance=0.1
    )
    basis = fem.modeBasis["matrix"]
    assert basis.shape[1] == report.total == old.shape[1] + report.added
    np.testing.assert_array_equal(basis[:, : old.shape[1]], old)
    # eigenmodes know little of a film's pressure; the added ones meet the tolerance
    assert report.error_before > 0.3
    assert report.error <= 0.1
    K = fem.stiffnessMatrix
    energy = np.sqrt(np.einsum("ij,ij->j", basis, K @ basis))
    coupling = (old.T @ (K @ basis[:, old.shape[1] :])) / np.outer(energy[: old.shape[1]], energy[old.shape[1] :])
    # orthogonal to the rounding of a stiffness with entries 1e4 times the energies
    assert np.abs(coupling).max() < 1e-8


@pytest.mark.slow
def test_thin_eye_on_a_shank_keeps_what_the_film_sees(measured):
    """A ring held at one side moves and gets oval 17 times as much as it deforms locally; the modes must have the
    latter.

    Full mesh against modes under a pressure of its own, (1 - (x / 0.8)^2)^2 over the angle x: error over the
    deformation beyond two waves, 0.009. A tolerance over the whole displacement would be met by modes of two waves,
    with an error of 0.12.
    """
    mesh = ehd.HollowCylinder(
        inner_radius=0.03, thickness=0.006, length=0.03, axial=2, radial=1, circumferential=40
    ).mesh()
    fem = fem_of(mesh, material(2.1e11))
    held = mesh.outer.nodes[np.abs(mesh.outer.theta) < 0.3]
    ehd.add_bore_modes(
        fem,
        position=[0, 0, 0],
        axis=[0, 0, 1],
        radius=0.03,
        length=0.03,
        fixed_nodes=held,
        tolerance=TOLERANCE,
        tilted=False,
    )
    theta = 2 * np.pi * np.arange(360) / 360
    grid = np.repeat(theta, 9), np.tile(np.linspace(-0.015, 0.015, 9), 360)
    H = mesh.bore.radial_interpolation(*grid)
    angle = np.abs((grid[0] - 2.0 + np.pi) % (2 * np.pi) - np.pi)
    pressure = np.where(angle < 0.8, (1 - (angle / 0.8) ** 2) ** 2, 0.0)
    bore = (3 * mesh.bore.nodes[:, None] + np.arange(3)).ravel()
    load = np.zeros(3 * len(mesh.nodes))
    load[bore] = H.T @ pressure
    free = np.setdiff1d(np.arange(load.size), (3 * held[:, None] + np.arange(3)).ravel())
    exact = np.zeros_like(load)
    exact[free] = spsolve(fem.stiffnessMatrix[free][:, free].tocsc(), load[free])
    basis = fem.modeBasis["matrix"]
    modal = basis @ np.linalg.solve(basis.T @ (fem.stiffnessMatrix @ basis), basis.T @ load)

    def beyond(waves, displacement):
        """Mean over the length without the waves up to this one."""
        values = np.fft.rfft((H @ displacement[bore]).reshape(360, 9).mean(axis=1))
        values[: waves + 1] = 0.0
        return np.linalg.norm(np.fft.irfft(values, 360))

    local = beyond(2, exact)
    assert beyond(-1, exact) > 15 * local
    error = beyond(1, modal - exact) / local
    measured("error", error, TOLERANCE)


def test_input_that_cannot_be_meant():
    mbs = scenes.new_system()
    body, fem, _ = bush_body(mbs, tolerance=0.2)
    journal = scenes.add_body(mbs, "Rxyz")

    def join(item=body, position=(0, 0, 0), **options):
        spec = {"journal_radius": 0.03, "length": 0.066, "bush": ehd.FEBore(fem=fem)} | options
        return ehd.CreateLubricatedJoint(
            mbs,
            itemNumbers=[item, journal],
            position=position,
            axis=[0, 0, 1],
            bearing=ehd.JournalBearing(radial_clearance=C, lubricant=ehd.Lubricant(viscosity=9e-3), **spec),
        )

    for options, match in (
        ({"journal_radius": 0.0375}, "nodes lie on the bore"),
        ({"length": 0.08}, "must span the film"),
        ({"position": (0, 0, 0.02)}, "must span the film"),
        ({"item": scenes.add_body(mbs, "EP")}, "itemNumbers\\[0\\]"),
        ({"bush": None}, "MarkerSuperElementRigid"),
        ({"bush": ehd.ModalBush(mesh=CYLINDER, material=material(2e11))}, "bush=FEBore"),
    ):
        with pytest.raises(InputError, match=match):
            join(**options)
    with pytest.raises(InputError, match="itemNumbers\\[0\\]"):
        ehd.steady(bearing(ehd.FEBore(fem=fem)), speed=100.0, eccentricity_ratio=0.5)
    with pytest.raises(InputError, match="FEMinterface"):
        ehd.FEBore(fem=None)
    for options, match in (
        ({"radius": 0.0375}, "nodes lie on the bore"),
        ({"fixed_nodes": [0]}, "three nodes or more"),
        ({"axis": [0, 0, 0]}, "direction"),
    ):
        spec = {
            "position": [0, 0, 0],
            "axis": [0, 0, 1],
            "radius": 0.03,
            "length": 0.066,
            "fixed_nodes": [1, 2, 3],
        } | options
        with pytest.raises(InputError, match=match):
            ehd.add_bore_modes(fem, **spec)


@pytest.mark.slow
def test_film_can_be_seen_and_judged_and_the_picture_leaves_the_solver_alone():
    mbs, joint = moving()
    element = joint.element
    load = np.array(mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS))
    film = joint.film()
    assert film.bush_displacement is None
    assert film.pressure.max() > 0.0
    side = element.sides[0]
    other = copy.deepcopy(side)
    before = side.floating.frame.copy(), side.jac.copy()
    other.update(mbs, np.full(side.size, 1e-3), np.zeros(side.size), exu.ConfigurationType.Visualization)
    np.testing.assert_array_equal(side.floating.frame, before[0])
    np.testing.assert_array_equal(side.jac, before[1])
    np.testing.assert_array_equal(np.array(mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS)), load)
    assert "elasticity" in str(joint.audit())
