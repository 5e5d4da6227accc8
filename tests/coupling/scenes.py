"""Small systems shared by the tests."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import toy
from exudyn.utilities import InertiaCuboid, InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.kinematics import relative

NODE_TYPES = {
    "EP": exu.NodeType.RotationEulerParameters,
    "Rxyz": exu.NodeType.RotationRxyz,
    "RotVec": exu.NodeType.RotationRotationVector,
}


def rotation(vector):
    """Rotation matrix of a rotation vector."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    n = np.asarray(vector) / angle
    k = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def marker_loads(element, wrench, generalized):
    """Global force and moment at the two markers (4, 3) of a wrench (6,): F_H, M_H, F_J, M_J.

    The journal gets these and no others by the generalized force (n,) that Exudyn is given.
    """
    loads, (housing, journal) = np.empty((4, 3)), element.sides
    relative.global_loads(housing.frame, journal.frame, wrench, loads)
    given = np.asarray(generalized)[housing.size : housing.size + journal.size]
    own = journal.jac[0].T @ loads[2] + journal.jac[1].T @ loads[3]
    # rounding
    np.testing.assert_allclose(given, own, rtol=1e-10, atol=1e-12 * np.abs(loads).max())
    return loads


def new_system():
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    mbs.variables["container"] = container  # the system lives in its container
    return mbs


def add_body(mbs, node, position=(0, 0, 0), matrix=None, velocity=(0, 0, 0), spin=(0, 0, 0), **options):
    """One body of 6 kg; node is "ground", "2D" or a key of NODE_TYPES."""
    matrix = np.eye(3) if matrix is None else matrix
    if node == "ground":
        return mbs.CreateGround(referencePosition=list(position), referenceRotationMatrix=matrix)
    kind = {"create2D": True} if node == "2D" else {"nodeType": NODE_TYPES[node]}
    return mbs.CreateRigidBody(
        referencePosition=list(position),
        referenceRotationMatrix=matrix,
        initialVelocity=list(velocity),
        initialAngularVelocity=list(spin),
        inertia=InertiaCuboid(1000.0, [0.1, 0.2, 0.3]),
        **kind,
        **options,
    )


def loaded_journal(bearing, load, speed=300.0):
    """A steel journal on ground under a constant load, axially held; returns mbs, not yet assembled, and joint."""
    mbs = new_system()
    journal = mbs.CreateRigidBody(
        inertia=InertiaCylinder(density=7800.0, length=0.1, outerRadius=bearing.journal_radius, axis=2),
        initialAngularVelocity=[0.0, 0.0, speed],
        nodeType=exu.NodeType.RotationRotationVector,
    )
    mbs.CreateForce(itemNumber=journal, loadVector=list(load))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="bearing",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing,
        axial=ehd.Held(),
    )
    return mbs, joint


def settings(end_time, steps, tolerance=1e-10, full_newton=True):
    s = exu.SimulationSettings()
    s.timeIntegration.endTime = end_time
    s.timeIntegration.numberOfSteps = steps
    s.timeIntegration.newton.relativeTolerance = tolerance
    s.timeIntegration.newton.useModifiedNewton = not full_newton
    s.staticSolver.newton.relativeTolerance = tolerance
    s.solution.file.write = False
    return s


def pair(housing, journal, *, seed=0, film=None, planar=False):
    """Two bodies in random orientation with an eccentric, tilted, moving journal; returns mbs, joint, q, q_t.

    The state is random and large in everything but the relative pose, which is inside the bore.
    """
    rng = np.random.default_rng(seed)
    mbs = new_system()
    film = film or toy.ToyFilm()

    def turn():
        return rotation([0, 0, rng.normal()] if planar else rng.normal(size=3))

    def point():
        p = 0.3 * rng.normal(size=3)
        return p * [1, 1, 0] if planar else p

    axis = np.array([0.0, 0.0, -1.0]) if planar else rng.normal(size=3)
    a = add_body(mbs, housing, point(), turn())
    b = add_body(mbs, journal, point(), turn())
    position = 0.2 * rng.normal(size=3)
    joint = toy.attach(mbs, [a, b], film, position=position, axis=axis, name="pair")
    mbs.Assemble()
    q = np.zeros(sum(side.size for side in joint.element.sides))
    n = joint.element.sides[0].size
    # lever arms of 0.3 m times 1e-4 rad stay well inside the 1 mm clearance of the toy
    q[n:] = 2e-4 * rng.normal(size=q.size - n)
    if q.size == n:
        q[:] = 2e-4 * rng.normal(size=n)
    q_t = rng.normal(size=q.size) * 3.0
    return mbs, joint, q, q_t


def hold_axially_and_in_spin(mbs, housing, journal):
    """Soft springs for the two directions that a film leaves free, which a static solve can't."""
    markers = [mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=b)) for b in (housing, journal)]
    mbs.AddObject(
        eii.ObjectConnectorRigidBodySpringDamper(
            markerNumbers=markers,
            stiffness=np.diag([0, 0, 1e3, 0, 0, 1e3]),
            damping=np.zeros((6, 6)),
            useIntrinsicFormulation=False,
        )
    )
