"""Reduced bodies with their exact Jacobian: Exudyn's own object as reference, runs with and without, what is kept."""

from __future__ import annotations

import functools

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.advancedUtilities import NumericalJacobian
from exudyn.FEM import ObjectFFRFreducedOrderInterface

import exudyn_ehd as ehd
from exudyn_ehd.coupling.items.objects import object_mass
from exudyn_ehd.status import InputError
from tests.finite_elements import fem_of

KIND = exu.ComputeItemType
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.3, axial=3, radial=1, circumferential=8)
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
TURNED, SPIN = [0.3, -0.5, 0.2], [100.0, 60.0, -80.0]
NODES = ["EP", "Rxyz", "RotVec"]


@functools.cache
def meshed(modes):
    mesh = CYLINDER.mesh()
    fem = fem_of(mesh, STEEL)
    fem.ComputeHurtyCraigBamptonModes([list(np.flatnonzero(mesh.nodes[:, 2] < -0.149))], modes)
    return mesh, fem


def add(mbs, kind, *, own, modes=6, **options):
    """The cylinder, its frame at one end."""
    _, fem = meshed(modes)
    interface = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType=scenes.NODE_TYPES[kind])
    parts = interface.AddObjectFFRFreducedOrder(mbs, rotationMatrixRef=scenes.rotation(TURNED), **options)
    body = parts["oFFRFreducedOrder"]
    return parts, ehd.ReplaceReducedBody(mbs, body) if own else body


def both(kind, **options):
    """Two systems with one body: Exudyn's own, and the body with equations of its own."""
    systems = []
    for own in (False, True):
        mbs = scenes.new_system()
        _, item = add(mbs, kind, own=own, stiffnessProportionalDamping=1e-6, **options)
        mbs.Assemble()
        systems.append((mbs, item))
    return systems


def at_state(systems, rng, *, one_angle=False):
    """Put both into a state of a large rotation, modes of 5 mm, large rates."""
    n = systems[0][0].systemData.ODE2Size()
    r = n - 6
    q, q_t = rng.normal(size=n), 10.0 * rng.normal(size=n)
    q[r:] *= 5e-3
    if one_angle:
        q_t[3:5] = 0.0
    if r == 7:
        node = systems[0][0].GetNode(exu.NodeIndex(0))
        reference = np.array(node["referenceCoordinates"])[3:]
        e = q[3:7] + reference
        e /= np.linalg.norm(e)
        q[3:7], q_t[3:7] = e - reference, q_t[3:7] - e * (e @ q_t[3:7])
    for mbs, _ in systems:
        mbs.systemData.SetODE2Coordinates(q.tolist())
        mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    return q


def difference(a, b, blocks):
    """Largest difference of two arrays, each block of rows over its own size."""
    return max(np.abs(a[rows] - b[rows]).max() / np.abs(b[rows]).max() for rows in blocks)


@pytest.mark.parametrize("kind", NODES)
def test_mass_and_forces_are_exudyns(kind, measured):
    """To rounding: of translation, rotation and modes each. With Tait-Bryan angles where one of them turns."""
    systems, rng, worst = both(kind), np.random.default_rng(0), 0.0
    for _ in range(5):
        q = at_state(systems, rng, one_angle=kind == "Rxyz")
        blocks = slice(3), slice(3, q.size - 6), slice(q.size - 6, None)
        for what in (KIND.ODE2LHS, KIND.MassMatrix):
            exudyns, own = (np.array(mbs.ComputeItem(item, what)) for mbs, item in systems)
            worst = max(worst, difference(own, exudyns, blocks))
    measured("relative difference", worst, 1e-12)


def test_exudyn_leaves_out_a_term_of_tait_bryan_angles():
    """The docstring of `ReplaceReducedBody` says so; here it is a tenth of the forces."""
    systems = both("Rxyz")
    at_state(systems, np.random.default_rng(0))
    exudyns, own = (np.array(mbs.ComputeItem(item, KIND.ODE2LHS)) for mbs, item in systems)
    assert difference(own, exudyns, [slice(3), slice(3, 6)]) > 0.03


@pytest.mark.parametrize("kind", NODES)
def test_jacobian_is_the_derivative_of_exudyns_forces(kind, measured):
    """Forces are quadratic in the rates and of degree two in modes: there differences over any step are exact."""
    systems, rng, worst = both(kind), np.random.default_rng(1), 0.0
    (mbs, body), (other, item) = systems
    places = list(range(mbs.systemData.ODE2Size()))
    for _ in range(3):
        q = at_state(systems, rng, one_angle=True)
        n = q.size - 6

        def lhs():
            return np.array(mbs.ComputeItem(body, KIND.ODE2LHS))

        by_rate = NumericalJacobian(mbs, lhs, places, velocities=True, epsilon=1.0)
        exact = np.array(other.ComputeItem(item, KIND.JacobianODE2_t))
        by_mode = NumericalJacobian(mbs, lhs, places, epsilon=1e-2)[:, n:]
        exact_mode = np.array(other.ComputeItem(item, KIND.JacobianODE2))[:, n:]
        if kind == "EP":
            e = q[3:7] + np.array(mbs.GetNode(exu.NodeIndex(0))["referenceCoordinates"])[3:]
            along = np.eye(q.size)
            along[3:7, 3:7] -= np.outer(e, e)
            by_rate, exact = by_rate @ along, exact @ along
        if kind == "Rxyz":
            # rates of the other two angles bring the term that Exudyn leaves out
            by_rate, exact = np.delete(by_rate, [3, 4], axis=1), np.delete(exact, [3, 4], axis=1)
        blocks = slice(3), slice(3, n), slice(n, None)
        worst = max(worst, difference(exact, by_rate, blocks), difference(exact_mode, by_mode, blocks))
    measured("relative difference", worst, 1e-9)


@pytest.mark.parametrize("kind", NODES)
def test_free_body_keeps_momentum_and_energy(kind, measured):
    """Tumbling and vibrating; what is left is of the time integration, four times as much with half of the steps."""
    mbs = scenes.new_system()
    parts, item = add(mbs, kind, own=True, initialVelocity=[3.0, -2.0, 1.0], initialAngularVelocity=SPIN)
    marker = mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=parts["nRigidBody"]))
    mbs.Assemble()
    settings = scenes.settings(0.01, 400, tolerance=1e-9)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.95
    K = np.array(mbs.GetObjectParameter(parts["oFFRFreducedOrder"], "stiffnessMatrixReduced").Convert2DenseMatrix())

    def kept():
        q, q_t = (np.array(get()) for get in (mbs.systemData.GetODE2Coordinates, mbs.systemData.GetODE2Coordinates_t))
        p = np.array(mbs.ComputeItem(item, KIND.MassMatrix)) @ q_t
        r = q.size - 6
        place = np.array(mbs.GetNodeOutput(parts["nRigidBody"], exu.OutputVariableType.Position))
        turn = np.array(mbs.ComputeItem(marker, KIND.RotationJacobian))[:, 3:r]
        spin = np.linalg.lstsq(turn.T, p[3:r], rcond=None)[0] + np.cross(place, p[:3])
        return p[:3], spin, 0.5 * q_t @ p + 0.5 * q[r:] @ K @ q[r:]

    flow, spin, energy = kept()
    mbs.SolveDynamic(settings)
    end = kept()
    measured("momentum", np.linalg.norm(end[0] - flow) / np.linalg.norm(flow), 5e-5)
    measured("angular momentum", np.linalg.norm(end[1] - spin) / np.linalg.norm(spin), 2e-5)
    measured("energy", abs(end[2] / energy - 1.0), 2e-5)


def equipped(kind, *, own, gravity=(0.0, -9.81, 3.0), spring=True):
    """The body with a load, a spring and a sensor on its mesh, and gravity."""
    mbs = scenes.new_system()
    mesh, _ = meshed(6)
    parts, _ = add(mbs, kind, own=own, gravity=list(gravity), initialAngularVelocity=[3.0, -2.0, 5.0])
    body, tip = parts["oFFRFreducedOrder"], int(np.argmax(mesh.nodes[:, 2]))
    point = mbs.AddMarker(eii.MarkerSuperElementPosition(bodyNumber=body, meshNodeNumbers=[tip], weightingFactors=[1]))
    free_end = [int(i) for i in np.flatnonzero(mesh.nodes[:, 2] > 0.149)]
    rigid = mbs.AddMarker(
        eii.MarkerSuperElementRigid(
            bodyNumber=body, meshNodeNumbers=free_end, weightingFactors=[1.0 / len(free_end)] * len(free_end)
        )
    )
    place = mbs.GetObjectOutputSuperElement(body, exu.OutputVariableType.Position, tip, exu.ConfigurationType.Reference)
    ground = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=mbs.CreateGround(referencePosition=place)))
    if spring:
        mbs.AddObject(eii.ObjectConnectorCartesianSpringDamper(markerNumbers=[ground, point], stiffness=[1e5] * 3))
    mbs.AddLoad(eii.LoadTorqueVector(markerNumber=rigid, loadVector=[20.0, 10.0, -5.0]))
    sensor = mbs.AddSensor(
        eii.SensorSuperElement(
            bodyNumber=body, meshNodeNumber=tip, storeInternal=True, outputVariableType=exu.OutputVariableType.Velocity
        )
    )
    mbs.Assemble()
    return mbs, parts, sensor


@pytest.mark.parametrize("kind", ["EP", "RotVec"])
def test_run_with_markers_loads_and_sensors_is_exudyns(kind, measured):
    """To Newton's tolerance, 1e-10 of forces: 5 to 40 of a step's."""
    stored = []
    for own in (False, True):
        mbs, _, sensor = equipped(kind, own=own)
        mbs.SolveDynamic(scenes.settings(0.01, 100))
        stored.append(np.array(mbs.GetSensorStoredData(sensor))[:, 1:])
    measured("velocity of a mesh node", np.abs(stored[1] - stored[0]).max() / np.abs(stored[0]).max(), 1e-7)


def test_other_solvers_find_what_they_found(measured):
    """A run of the sparse solver, static balance, eigenvalues."""
    found = []
    for own in (False, True):
        mbs, parts, sensor = equipped("Rxyz", own=own, gravity=(0.0, -200.0, 0.0), spring=False)
        ground = mbs.CreateGround(referenceRotationMatrix=scenes.rotation(TURNED))
        pins = [
            mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground)),
            mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=parts["nRigidBody"])),
        ]
        mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=pins, constrainedAxes=[1] * 6))
        mbs.SetNodeParameter(parts["nRigidBody"], "initialVelocities", [0.0] * 6)
        mbs.Assemble()
        settings = scenes.settings(2e-3, 40)
        ehd.SolveDynamicSparse(mbs, settings)
        sparse = np.array(mbs.GetSensorStoredData(sensor))[-1, 1:]
        ehd.SolveStatic(mbs, settings)
        balance = np.array(mbs.systemData.GetODE2Coordinates())[6:]
        values = np.array(mbs.ComputeODE2Eigenvalues(useAbsoluteValues=True)[0])[-6:]
        found.append((sparse, balance, values))
    for name, exudyns, own in zip(("sparse run", "static balance", "eigenvalues"), *found):
        measured(name, np.abs(own - exudyns).max() / np.abs(exudyns).max(), 1e-6)


def test_matrices_are_read_anew():
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    parts, item = add(mbs, "Rxyz", own=True)
    mbs.Assemble()
    body, q = parts["oFFRFreducedOrder"], np.zeros(12)
    q[6:] = 1e-4
    mbs.SolveDynamic(scenes.settings(1e-5, 1))
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t([0.0] * 12)
    before = np.array(mbs.ComputeItem(item, KIND.ODE2LHS))
    stiffness = exu.MatrixContainer()
    old = np.array(mbs.GetObjectParameter(body, "stiffnessMatrixReduced").Convert2DenseMatrix())
    stiffness.SetWithDenseMatrix(2.0 * old, useDenseMatrix=True)
    mbs.SetObjectParameter(body, "stiffnessMatrixReduced", stiffness)
    np.testing.assert_allclose(mbs.ComputeItem(item, KIND.ODE2LHS), 2.0 * before, rtol=1e-14)
    # a bush with mass asks for that of what carries it
    np.testing.assert_array_equal(object_mass(mbs, item), mbs.ComputeItem(item, KIND.MassMatrix))
    mbs.DeleteObject(ground)
    mbs.Assemble()
    with pytest.raises(exu.ExudynError, match="delete items before"):
        mbs.ComputeItem(exu.ObjectIndex(int(item) - 1), KIND.ODE2LHS)


def test_other_objects_are_refused():
    mbs = scenes.new_system()
    rigid = scenes.add_body(mbs, "EP")
    parts, _ = add(mbs, "EP", own=True)
    with pytest.raises(InputError, match="replaced already"):
        ehd.ReplaceReducedBody(mbs, parts["oFFRFreducedOrder"])
    with pytest.raises(InputError, match=r"object 0 .* is no ObjectFFRFreducedOrder"):
        ehd.ReplaceReducedBody(mbs, rigid)
    with pytest.raises(InputError, match="ObjectIndex"):
        ehd.ReplaceReducedBody(mbs, 0)
    mbs.Assemble()
    with pytest.raises(InputError, match="assembled already"):
        ehd.ReplaceReducedBody(mbs, parts["oFFRFreducedOrder"])
