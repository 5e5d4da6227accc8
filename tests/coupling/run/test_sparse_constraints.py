"""Constraints and user functions of all kinds in `SolveDynamicSparse`: the run of Exudyn's own solver, or a refusal."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid, InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.run.system_matrix import SystemMatrix

EULER, ANGLES = exu.NodeType.RotationEulerParameters, exu.NodeType.RotationRxyz
INERTIA = InertiaCuboid(1000.0, [0.5, 0.1, 0.2])


def _body(mbs, x, node=ANGLES, **options):
    return mbs.CreateRigidBody(
        inertia=INERTIA, referencePosition=[x, 0, 0], gravity=[0, 0, -9.81], nodeType=node, **options
    )


def _rolling(node, axes):
    def build(mbs):
        ground = mbs.CreateGround()
        disc = mbs.CreateRigidBody(
            inertia=InertiaCylinder(1000, 0.1, 0.3, 0),
            referencePosition=[0, 0, 0.3],
            initialVelocity=[0, 1, 0],
            initialAngularVelocity=[-1 / 0.3, 0, 0.2],
            nodeType=node,
            gravity=[0, 0, -9.81],
        )
        markers = [mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body)) for body in (ground, disc)]
        mbs.AddObject(
            eii.ObjectJointRollingDisc(
                markerNumbers=markers, constrainedAxes=axes, discRadius=0.3, discAxis=[1, 0, 0], planeNormal=[0, 0, 1]
            )
        )

    return build


def _chain(mbs, node=ANGLES):
    last = mbs.CreateGround()
    for i in range(3):
        body = _body(mbs, 0.25 + 0.5 * i, node)
        mbs.CreateRevoluteJoint(itemNumbers=[last, body], position=[0.5 * i, 0, 0], axis=[0, 1, 0])
        last = body
    return last


def _chain_of_euler_parameters(mbs):
    _chain(mbs, EULER)


def _half_free(mbs):
    mbs.CreateGenericJoint(
        itemNumbers=[mbs.CreateGround(), _body(mbs, 0.25)], position=[0, 0, 0], constrainedAxes=[1, 0, 1, 1, 0, 1]
    )


def _released(mbs):
    """A joint that carries a force is opened in mid run."""
    last, body = _chain(mbs), _body(mbs, 1.75)
    joint = mbs.CreateSphericalJoint(itemNumbers=[last, body], position=[1.5, 0, 0])

    def before_step(mbs, t):
        if t > 0.01:
            mbs.SetObjectParameter(joint, "activeConnector", False)
        return True

    mbs.SetPreStepUserFunction(before_step)


def _points(mbs, marker):
    nodes = [mbs.AddNode(eii.NodePoint(referenceCoordinates=[i, 0, 0], initialVelocities=[1, 1, 0])) for i in (0, 1)]
    for node in nodes:
        mbs.AddObject(eii.ObjectMassPoint(mass=2.0, nodeNumber=node))
    force = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=nodes[0]))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=force, loadVector=[1, 2, 3]))
    return [mbs.AddMarker(marker(node)) for node in nodes]


def _coordinate_speeds(mbs):
    markers = _points(mbs, lambda node: eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=1))
    mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers, velocityLevel=True))


def _coordinate_vector_speeds(mbs):
    markers, a = _points(mbs, lambda node: eii.MarkerNodeCoordinates(nodeNumber=node)), [[1.0, 0, 0.5], [0, 1, 0]]
    mbs.AddObject(
        eii.ObjectConnectorCoordinateVector(
            markerNumbers=markers,
            velocityLevel=True,
            scalingMarker0=np.array(a),
            scalingMarker1=-np.array(a),
            offset=[0.0, 0.0],
        )
    )


def _settings(index2=False):
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    integration = settings.timeIntegration
    integration.verboseMode = 0
    integration.endTime, integration.numberOfSteps = 0.02, 40
    integration.generalizedAlpha.useIndex2Constraints = integration.generalizedAlpha.useNewmark = index2
    integration.newton.relativeTolerance = integration.newton.absoluteTolerance = 1e-9
    return settings


def _system(build):
    mbs = exu.SystemContainer().AddSystem()
    build(mbs)
    mbs.Assemble()
    return mbs


def _end(mbs):
    return np.array(mbs.systemData.GetODE2Coordinates())


@pytest.mark.parametrize("index2", [False, True], ids=["index3", "index2"])
@pytest.mark.parametrize(
    "build",
    [
        _rolling(EULER, [1, 1, 1]),
        _rolling(ANGLES, [1, 0, 1]),
        _chain,
        _chain_of_euler_parameters,
        _half_free,
        _released,
        _coordinate_speeds,
        _coordinate_vector_speeds,
    ],
)
def test_same_matrix_and_same_run_as_exudyns_own_solver(build, index2):
    mbs, settings, pairs = _system(build), _settings(index2), []
    matrix = SystemMatrix(mbs)

    def newton(solver, mbs, settings):
        solver.ComputeNewtonUpdate(mbs, settings, True)
        solver.ComputeNewtonResidual(mbs, settings)
        solver.ComputeNewtonJacobian(mbs, settings)
        pairs.append((np.array(solver.GetSystemJacobian()), matrix.assemble(mbs, solver, index2=index2).toarray()))
        return False

    settings.timeIntegration.adaptiveStep = False
    solver = exu.MainSolverImplicitSecondOrder()
    solver.SetUserFunctionNewton(mbs, newton)
    with pytest.raises(exu.ExudynError):
        mbs.sys["dynamicSolver"] = solver
        if not solver.SolveSystem(mbs, settings):
            raise exu.SolverError("one iteration")
    expected, got = pairs[0]
    n = matrix.coordinates
    assert np.allclose(got[n:], expected[n:], rtol=1e-12, atol=1e-12 * np.abs(expected[n:]).max())
    # velocity forces of turning bodies are in Exudyn's matrix only
    assert np.allclose(got[:n], expected[:n], atol=1e-4 * np.abs(expected[:n]).max())

    ends = []
    for solve in (ehd.SolveDynamicSparse, lambda mbs, settings: mbs.SolveDynamic(settings)):
        mbs = _system(build)
        solve(mbs, _settings(index2))
        ends.append(_end(mbs))
    assert np.allclose(ends[0], ends[1], atol=1e-5 * np.abs(ends[1]).max())


def test_every_user_function_of_the_system_takes_part():
    """A spring of 1 MN/m written by a function before residuals; without its Jacobian Newton's method diverges."""
    stiffness, results = 1e6, []
    for solve in (ehd.SolveDynamicSparse, lambda mbs, settings: mbs.SolveDynamic(settings)):
        mbs = exu.SystemContainer().AddSystem()
        force = mbs.CreateForce(itemNumber=_body(mbs, 0.25), loadVector=[0, 0, 0])
        calls = dict.fromkeys(("before step", "after step", "before residual", "after Newton", "Jacobian"), 0)

        def count(what, result=None, calls=calls):
            calls[what] += 1
            return result

        iterations = []

        def spring(mbs, t, iteration, discontinuous, force=force, count=count, iterations=iterations):
            iterations.append((t, iteration))
            lift = mbs.GetNodeOutput(0, exu.OutputVariableType.Displacement)[2]
            mbs.SetLoadParameter(force, "loadVector", [0, 0, -stiffness * lift])
            count("before residual")

        def jacobian(mbs, t, of_positions, of_rates, of_first_order, count=count):
            matrix = exu.MatrixContainer()
            matrix.SetWithSparseMatrix([[2, 2, -stiffness * of_positions]], 6, 6)
            return count("Jacobian", matrix)

        mbs.SetPreNewtonResidualUserFunction(spring)
        mbs.SetSystemJacobianUserFunction(jacobian)
        mbs.SetPreStepUserFunction(lambda mbs, t, count=count: count("before step", True))
        mbs.SetPostStepUserFunction(lambda mbs, t, count=count: count("after step", True))
        mbs.SetPostNewtonUserFunction(lambda mbs, t, count=count: count("after Newton", [0, -1]))
        solve(mbs, _settings())  # assembles the system, as Exudyn's solver does
        assert all(calls.values())
        assert len(set(iterations)) == len(iterations)
        assert (calls["before step"], calls["after step"], calls["after Newton"]) == (40, 41, 40)
        results.append(_end(mbs))
    assert np.allclose(results[0], results[1], atol=1e-9 * np.abs(results[1]).max())


def _sliding(mbs):
    cable = mbs.AddObject(
        eii.ObjectANCFCable2D(
            nodeNumbers=[mbs.AddNode(eii.NodePoint2DSlope1(referenceCoordinates=[x, 0, 1, 0])) for x in (0.0, 1.0)],
            length=1.0,
            massPerLength=1.0,
            bendingStiffness=10.0,
            axialStiffness=1e4,
        )
    )
    point = mbs.AddNode(eii.NodePoint2D(referenceCoordinates=[0.2, 0]))
    mass = mbs.AddObject(eii.ObjectMassPoint2D(mass=0.1, nodeNumber=point))
    markers = [
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=mass)),
        mbs.AddMarker(eii.MarkerBodyCable2DCoordinates(bodyNumber=cable)),
    ]
    data = mbs.AddNode(eii.NodeGenericData(initialCoordinates=[0, 0.2], numberOfDataCoordinates=2))
    mbs.AddObject(
        eii.ObjectJointSliding2D(
            markerNumbers=markers, slidingMarkerNumbers=markers[1:], slidingMarkerOffsets=[0.0], nodeNumber=data
        )
    )


def _general_contact(mbs):
    _chain(mbs)
    contact = mbs.AddGeneralContact()
    contact.SetFrictionPairings(np.eye(1))
    contact.SetSearchTreeBox([-1, -1, -1], [1, 1, 1])


@pytest.mark.parametrize(
    ("build", "name", "value", "message"),
    [
        (_sliding, None, None, r"object \d+ of type JointSliding2D, .* use mbs.SolveDynamic"),
        (_general_contact, None, None, r"no GeneralContact"),
        (_chain, "computeLoadsJacobian", 1, r"timeIntegration.computeLoadsJacobian must be 0, got 1"),
        (_chain, "newton.residualMode", 1, r"timeIntegration.newton.residualMode must be 0, got 1"),
        (_chain, "newton.active", False, r"timeIntegration.newton.active must be True, got False"),
    ],
)
def test_what_can_not_be_followed_is_refused_by_name(build, name, value, message):
    mbs, settings = _system(build), _settings()
    if name is not None:
        *path, last = name.split(".")
        target = settings.timeIntegration
        for part in path:
            target = getattr(target, part)
        setattr(target, last, value)
    with pytest.raises(ehd.InputError, match=message):
        ehd.SolveDynamicSparse(mbs, settings)
