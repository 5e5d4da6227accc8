"""Linearised rotors on springs, without films, against closed forms: the gyroscopic terms and the shaft's bending."""

import itertools

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
from exudyn.utilities import RigidBodyInertia

from exudyn_ehd.coupling.rotor.spinning import Rotor
from exudyn_ehd.coupling.rotor.system import SpinningSystem

NODES = [exu.NodeType.RotationEulerParameters, exu.NodeType.RotationRxyz, exu.NodeType.RotationRotationVector]
MASS, TRANSVERSE, POLAR = 12.0, 0.4, 0.7


def frame_along(axis):
    """Rotation (3, 3) whose last column is the axis."""
    axis = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    x = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    x /= np.linalg.norm(x)
    return np.column_stack((x, np.cross(axis, x), axis))


def inertia_about(frame):
    return RigidBodyInertia(
        mass=MASS, com=[0, 0, 0], inertiaTensor=frame @ np.diag([TRANSVERSE, TRANSVERSE, POLAR]) @ frame.T
    )


def spring(mbs, ground, body, place, stiffness):
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, body], localPosition0=place, localPosition1=place, stiffness=[stiffness] * 3
    )


def eigenvalues(system, speed):
    """Eigenvalues of the motion with the spin held, sorted by frequency."""
    system.spins[:] = speed
    r_x, r_u = system.derivatives()
    M, S = system.mass(), system.turning()
    held = np.vstack((system.constraints(), system.drives()))
    _, values, right = np.linalg.svd(held)
    free = right[int(np.sum(values > 1e-9)) :].T
    M, D, K = (free.T @ matrix @ free for matrix in (M, r_u + M @ S, r_x + r_u @ S))
    n = len(M)
    matrix = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    values = np.linalg.eigvals(matrix)
    return values[np.argsort(values.imag)]


def whirl(speed, near, far, a, b):
    """Frequencies of a rigid rotor on isotropic springs at distances -a and b; negative ones turn backward.

    With z = x + i y and the slope s = bx + i by: m z'' + (k1 + k2) z + (k2 b - k1 a) s = 0 and
    Jt s'' - i Omega Jp s' + (k1 a^2 + k2 b^2) s + (k2 b - k1 a) z = 0.
    """
    K = np.array([[near + far, far * b - near * a], [far * b - near * a, near * a**2 + far * b**2]])
    M, G = np.diag([MASS, TRANSVERSE]), np.diag([0.0, speed * POLAR])
    matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), 1j * np.linalg.solve(M, G)]])
    return np.sort(np.linalg.eigvals(matrix).imag)


@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 0, 0), (0, 1, 0), (1, 2, -2)])
@pytest.mark.parametrize("node", NODES)
def test_a_rigid_rotor_on_springs_whirls_as_its_closed_form(node, axis):
    near, far, a, b = 3e6, 1e6, 0.3, 0.5
    frame = frame_along(axis)
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    body = mbs.CreateRigidBody(inertia=inertia_about(frame), nodeType=node)
    spring(mbs, ground, body, (-a * frame[:, 2]).tolist(), near)
    spring(mbs, ground, body, (b * frame[:, 2]).tolist(), far)
    mbs.Assemble()
    system = SpinningSystem(mbs, [Rotor([0], [frame[:, 2]], frame)])
    for speed in (0.0, 200.0, 900.0, -900.0):
        values = eigenvalues(system, speed)
        axial = np.sqrt((near + far) / MASS)
        forms = whirl(speed, near, far, a, b)
        expected = np.sort(np.concatenate((forms, -forms, [axial, -axial])))
        np.testing.assert_allclose(values.imag, expected, rtol=2e-8)
        assert np.abs(values.real).max() < 1e-5


@pytest.mark.parametrize("node", NODES)
def test_equations_of_a_rotor_do_not_change_as_it_turns(node):
    frame = frame_along((1, 2, -2))
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    body = mbs.CreateRigidBody(inertia=inertia_about(frame), nodeType=node, gravity=[0, -9.81, 0])
    spring(mbs, ground, body, (-0.3 * frame[:, 2]).tolist(), 1e6)
    mbs.Assemble()
    system = SpinningSystem(mbs, [Rotor([0], [frame[:, 2]], frame)])
    system.spins[:] = 300.0
    first = (*system.derivatives(), system.mass(), system.turning())
    start = system.nodes[0].turn(system.q)
    system.q = system.turned()
    turn = system.nodes[0].turn(system.q) @ start.T
    assert np.trace(turn) == pytest.approx(1.0 + 2.0 * np.cos(1.0), rel=1e-12)
    np.testing.assert_allclose(turn @ frame[:, 2], frame[:, 2], atol=1e-12)
    for before, after in zip(first, (*system.derivatives(), system.mass(), system.turning()), strict=True):
        np.testing.assert_allclose(after, before, rtol=0, atol=1e-7 * np.abs(before).max())


@pytest.mark.parametrize("speed", [2000.0, pytest.param(500.0, marks=pytest.mark.slow)])
def test_a_shaft_of_beams_whirls_as_a_rotating_rayleigh_beam(speed):
    """(rho A + rho I b^2) s^2 - 2 i Omega rho I b^2 s + E I b^4 = 0 with b = pi / L, simply supported."""
    count, span, radius, density, modulus = 24, 1.0, 0.05, 7850.0, 2.1e11
    area, moment = np.pi * radius**2, np.pi * radius**4 / 4.0
    data = exu.BeamSection()
    stiff = 1e4 * modulus * area
    data.stiffnessMatrix = np.diag([modulus * area, stiff, stiff, modulus * moment, modulus * moment, modulus * moment])
    data.inertia, data.massPerLength = density * moment * np.diag([2.0, 1.0, 1.0]), density * area
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    nodes = [
        mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[x, 0, 0, 0, 0, 0]))
        for x in np.linspace(0.0, span, count + 1)
    ]
    for pair in itertools.pairwise(nodes):
        mbs.AddObject(eii.ObjectBeamGeometricallyExact(nodeNumbers=list(pair), length=span / count, sectionData=data))
    for node, axes in ((nodes[0], [1, 1, 1, 0, 0, 0]), (nodes[-1], [0, 1, 1, 0, 0, 0])):
        place = mbs.GetNode(node)["referenceCoordinates"][:3]
        markers = [
            mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground, localPosition=list(place))),
            mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=node)),
        ]
        mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=axes))
    mbs.Assemble()
    frame = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    turning = [int(node) for node in nodes]
    system = SpinningSystem(mbs, [Rotor(turning, [np.eye(3)[0]] * len(nodes), frame)])
    values = eigenvalues(system, speed)
    b = np.pi / span
    rotary, bending = density * moment * b**2, modulus * moment * b**4
    for root in np.roots([density * area + rotary, -2j * speed * rotary, bending]):
        assert np.abs(values - root).min() < 0.0025 * abs(root)
