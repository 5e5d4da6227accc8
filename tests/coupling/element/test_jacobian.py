"""Exact generalized force and Jacobian of the film element, for every pair of node types.

Reference: central differences of the force user function itself. With a step h the truncation error is O(h^2) relative
to the scale on which the force varies (the clearance, 1e-3 m; radians), the rounding error eps |Q| / h. Steps of 2e-8 m
(2e-8 rad times arms below 1 m) give about (2e-5)^2 + 1e-16 / 2e-5 relative, so 1e-6 of the largest entry of the same
block is met with a margin if, and only if, every geometric term is there.
"""

import itertools

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.advancedUtilities import NumericalJacobian

from exudyn_ehd.coupling.kinematics import rigid_nodes

STEP = 2e-8
TOLERANCE = 1e-6
SPATIAL = [pair for pair in itertools.product(("ground", "EP", "Rxyz", "RotVec"), repeat=2) if pair != ("ground",) * 2]
PLANAR = [("ground", "2D"), ("2D", "ground"), ("2D", "2D"), ("EP", "2D"), ("2D", "RotVec")]


def perturbed(element, q, k, step):
    """Coordinates after a variation of coordinate k: added, or a local incremental rotation for a Lie group node."""
    out = q.copy()
    start = 0
    for side in element.sides:
        if side.kind == rigid_nodes.ROTATION_VECTOR and start + 3 <= k < start + 6:
            ref = side.reference[3:]
            increment = np.zeros(3)
            increment[k - start - 3] = step
            matrix = scenes.rotation(ref + q[start + 3 : start + 6]) @ scenes.rotation(increment)
            out[start + 3 : start + 6] = rotation_vector(matrix) - ref
            return out
        start += side.size
    out[k] += step
    return out


def rotation_vector(matrix):
    """Logarithm of a rotation matrix, away from angle pi."""
    skew = 0.5 * np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    sine = np.linalg.norm(skew)
    angle = np.arctan2(sine, 0.5 * (np.trace(matrix) - 1.0))
    return skew * angle / sine


def differences(mbs, element, q, q_t):
    n = q.size
    stiffness, damping = np.empty((n, n)), np.empty((n, n))

    def force(a, b):
        return element.force(mbs, 0.0, 0, a.tolist(), b.tolist()).copy()

    for k in range(n):
        plus, minus = perturbed(element, q, k, STEP), perturbed(element, q, k, -STEP)
        stiffness[:, k] = (force(plus, q_t) - force(minus, q_t)) / (2 * STEP)
        # the force is smooth in the rates on a scale of 1 m/s: a large step loses nothing
        change = np.zeros(n)
        change[k] = 1e-4
        damping[:, k] = (force(q, q_t + change) - force(q, q_t - change)) / 2e-4
    return stiffness, damping


def assert_blocks(element, got, expected):
    """Compare translation and rotation blocks apart: a small block must not hide behind a large one."""
    cuts = []
    start = 0
    for side in element.sides:
        if side.size:
            split = 2 if side.kind == rigid_nodes.PLANAR else 3
            cuts += [slice(start, start + split), slice(start + split, start + side.size)]
        start += side.size
    for rows, columns in itertools.product(cuts, cuts):
        scale = np.abs(expected[rows, columns]).max()
        np.testing.assert_allclose(got[rows, columns], expected[rows, columns], rtol=0, atol=TOLERANCE * scale)


@pytest.mark.parametrize(("housing", "journal"), SPATIAL + PLANAR)
def test_jacobian_is_the_derivative_of_the_force(housing, journal):
    mbs, joint, q, q_t = scenes.pair(housing, journal, seed=3, planar="2D" in (housing, journal))
    element = joint.element
    stiffness, damping = differences(mbs, element, q, q_t)
    got_k = -element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 1.0, 0.0)
    got_d = -element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 0.0, 1.0)
    assert_blocks(element, got_k, stiffness)
    assert_blocks(element, got_d, damping)
    both = element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 0.3, 0.7)
    # one linear combination, so rounding only
    np.testing.assert_allclose(both, -(0.3 * got_k + 0.7 * got_d), rtol=0, atol=1e-13 * np.abs(both).max())


@pytest.mark.parametrize("journal", ["EP", "Rxyz"])
def test_jacobian_against_exudyns_own_differences(journal):
    """The Jacobian of the assembled system, which also shows the order of the coordinates and the sign.

    Central differences of the toy's force with steps of 1e-7, against a clearance of 1e-3: (1e-4)^2 of truncation and
    1e-16 / 1e-4 of rounding, so that 1e-6 of the largest entry holds with a margin. Lie group nodes are left out: here
    their coordinates are perturbed by addition, which is not the variation that Newton uses.
    """
    mbs, joint, q, q_t = scenes.pair("Rxyz", journal, seed=3)
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    coordinates = list(range(q.size))

    def lhs():
        return np.array(mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS))

    for item, velocities in ((exu.ComputeItemType.JacobianODE2, False), (exu.ComputeItemType.JacobianODE2_t, True)):
        analytic = np.array(mbs.ComputeItem(joint.objectNumber, item))
        numeric = NumericalJacobian(mbs, lhs, coordinates, velocities=velocities, epsilon=1e-7)
        np.testing.assert_allclose(analytic, numeric, rtol=0, atol=TOLERANCE * np.abs(numeric).max())


def test_jacobian_call_reuses_the_evaluation_of_the_force():
    mbs, joint, q, q_t = scenes.pair("Rxyz", "RotVec")
    joint.element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist())
    count = joint.element.evaluations
    joint.element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 1.0, 0.5)
    joint.element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist())
    assert joint.element.evaluations == count
