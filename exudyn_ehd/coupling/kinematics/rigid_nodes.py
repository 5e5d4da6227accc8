"""Frames of the nodes of rigid bodies: pose, rates and exact variations, as array kernels.

Every side (housing H, journal J) is described by two work arrays. The kernels here fill them for the nodes of rigid
bodies, `exudyn_ehd.coupling.kinematics.sides.MarkerSide` for any other marker:

frame (3, 6)      columns 0-2: A, marker frame to global; 3: position p; 4: velocity v; 5: angular velocity omega;
                  all global
jac   (4, 3, n)   Jp, Jr, Vq, Wq with dp = Jp dq, dphi = Jr dq (global rotation), dv = Vq dq and domega = Wq dq at
                  fixed q_t; with respect to q_t, dv = Jp dq_t and domega = Jr dq_t
change (6, n, n)  derivatives of J = [Jp, Jr] to q: contracted with q_t they are Vq and Wq, with a force and a moment
                  the geometric stiffness (`vary`).

Legend: q, q_t coordinates (without reference values) and their rates; n their number; rho joint point in the node's
frame [m]; a_loc marker frame to node frame; s = A_node rho the global lever arm; T, F, M global torque, force, moment.
The motion of the joint follows from both sides: `exudyn_ehd.coupling.kinematics.relative`.

Lie group nodes: q_t holds the local angular velocity, and dq the local incremental rotation, as in Exudyn's Newton.
Euler parameters: the node's rotation is that of e / |e|, so that an iterate off the unit sphere is a pure rotation;
on the sphere, where Exudyn's constraint holds it, all quantities equal Exudyn's.

Vectors of three are tuples, and arrays are written in loops, because numba needs many times as long to compile slices
and array expressions.
"""

from __future__ import annotations

import numpy as np
from numba import njit

POINT, EULER_PARAMETERS, TAIT_BRYAN, ROTATION_VECTOR, PLANAR = range(5)
"""Kinds of rotation coordinates of a node; points move without turning, and ground is a point without coordinates."""

# Columns of a frame; numpy's integers, since numba compiles kernels anew for each plain one.
AXIS, PLACE, VELOCITY, SPIN = (np.int64(k) for k in (2, 3, 4, 5))


@njit(cache=True)
def translations(kind, n):
    """Number of coordinates of the position, which are the first of a node's n coordinates."""
    if kind == POINT:
        return n
    return 2 if kind == PLANAR else 3


@njit(cache=True)
def cross(a, b):
    """Vector product of two 3-tuples."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def column(a, k):
    """Column of a matrix (3, n) as a tuple."""
    return a[0, k], a[1, k], a[2, k]


@njit(cache=True)
def times(a, b):
    """First three columns of a matrix times a 3-tuple."""
    return (
        a[0, 0] * b[0] + a[0, 1] * b[1] + a[0, 2] * b[2],
        a[1, 0] * b[0] + a[1, 1] * b[1] + a[1, 2] * b[2],
        a[2, 0] * b[0] + a[2, 1] * b[1] + a[2, 2] * b[2],
    )


@njit(cache=True)
def in_frame(a, b):
    """Global 3-tuple in a frame (3, 6)."""
    return (
        a[0, 0] * b[0] + a[1, 0] * b[1] + a[2, 0] * b[2],
        a[0, 1] * b[0] + a[1, 1] * b[1] + a[2, 1] * b[2],
        a[0, 2] * b[0] + a[1, 2] * b[1] + a[2, 2] * b[2],
    )


@njit(cache=True)
def dot(a, b):
    """Scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True)
def combined(a, fa, b, fb):
    """Combination fa a + fb b of 3-tuples."""
    return fa * a[0] + fb * b[0], fa * a[1] + fb * b[1], fa * a[2] + fb * b[2]


@njit(cache=True)
def _euler_g(e0, e1, e2, e3, g_out):
    """Matrix G (3, 4), bilinear: omega = G(e) e_t for unit e, global components."""
    g_out[0, 0], g_out[0, 1], g_out[0, 2], g_out[0, 3] = -2.0 * e1, 2.0 * e0, -2.0 * e3, 2.0 * e2
    g_out[1, 0], g_out[1, 1], g_out[1, 2], g_out[1, 3] = -2.0 * e2, 2.0 * e3, 2.0 * e0, -2.0 * e1
    g_out[2, 0], g_out[2, 1], g_out[2, 2], g_out[2, 3] = -2.0 * e3, -2.0 * e2, 2.0 * e1, 2.0 * e0


@njit(cache=True)
def _rotation_euler(e0, e1, e2, e3, a_out):
    """Rotation of e / |e|; returns |e|^2."""
    norm2 = e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3
    f = 2.0 / norm2
    a_out[0, 0] = 1.0 - f * (e2 * e2 + e3 * e3)
    a_out[1, 1] = 1.0 - f * (e1 * e1 + e3 * e3)
    a_out[2, 2] = 1.0 - f * (e1 * e1 + e2 * e2)
    a_out[0, 1], a_out[1, 0] = f * (e1 * e2 - e0 * e3), f * (e1 * e2 + e0 * e3)
    a_out[0, 2], a_out[2, 0] = f * (e1 * e3 + e0 * e2), f * (e1 * e3 - e0 * e2)
    a_out[1, 2], a_out[2, 1] = f * (e2 * e3 - e0 * e1), f * (e2 * e3 + e0 * e1)
    return norm2


@njit(cache=True, inline="always")
def _turn_vector(v0, v1, v2, a_out, jr_out):
    """Exponential map of a rotation vector, and the same matrix as Jr."""
    angle = np.sqrt(v0 * v0 + v1 * v1 + v2 * v2)
    half = 0.5 * angle
    # sin(half) / angle stays accurate for small angles, 1 - cos(angle) would not
    sinc = 0.5 * (1.0 - half * half / 6.0) if half < 1e-4 else np.sin(half) / angle
    _rotation_euler(np.cos(half), sinc * v0, sinc * v1, sinc * v2, a_out)
    _rotation_euler(np.cos(half), sinc * v0, sinc * v1, sinc * v2, jr_out)


@njit(cache=True, inline="always")
def _turn_tait_bryan(v0, v1, v2, a_out, jr_out):
    """A = Rx(a) Ry(b) Rz(c), and the global axes about which the three angles turn, as columns of Jr."""
    ca, sa, cb, sb, cc, sc = np.cos(v0), np.sin(v0), np.cos(v1), np.sin(v1), np.cos(v2), np.sin(v2)
    a_out[0, 0], a_out[0, 1], a_out[0, 2] = cb * cc, -cb * sc, sb
    a_out[1, 0], a_out[1, 1], a_out[1, 2] = ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb
    a_out[2, 0], a_out[2, 1], a_out[2, 2] = sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb
    jr_out[0, 0], jr_out[1, 1], jr_out[2, 1] = 1.0, ca, sa
    jr_out[0, 2], jr_out[1, 2], jr_out[2, 2] = sb, -sa * cb, ca * cb


@njit(cache=True)
def turn(kind, q, reference):
    """Rotation of a node with coordinates ``q`` and reference values ``reference`` (n,).

    Parameters
    ----------
    kind, q, reference
        As in `node_frame`.

    Returns
    -------
    a : ndarray (3, 3)
        Node to global.
    jr : ndarray (3, 4)
        Jr in the first m columns.
    theta : ndarray (4,)
        The m coordinates of the rotation with their reference values.
    m : int
    """
    a, jr, theta = np.zeros((3, 3)), np.zeros((3, 4)), np.zeros(4)
    nt = translations(kind, q.size)
    m = q.size - nt
    for k in range(m):
        theta[k] = q[nt + k] + reference[nt + k]
    for i in range(3):
        a[i, i] = 1.0
    v0, v1, v2, v3 = theta[0], theta[1], theta[2], theta[3]
    if kind == EULER_PARAMETERS:
        norm2 = _rotation_euler(v0, v1, v2, v3, a)
        _euler_g(v0, v1, v2, v3, jr)
        for i in range(3):
            for j in range(4):
                jr[i, j] /= norm2
    elif kind == TAIT_BRYAN:
        _turn_tait_bryan(v0, v1, v2, a, jr)
    elif kind == ROTATION_VECTOR:
        _turn_vector(v0, v1, v2, a, jr)
    elif kind == PLANAR:
        jr[2, 0] = 1.0
        a[0, 0], a[0, 1] = np.cos(v0), -np.sin(v0)
        a[1, 0], a[1, 1] = np.sin(v0), np.cos(v0)
    return a, jr, theta, m


def rotation_of(kind: int, reference: np.ndarray) -> np.ndarray:
    """Rotation matrix (3, 3), node to global, of a node with coordinates ``reference`` (n,)."""
    return turn(kind, np.zeros_like(reference), reference)[0]


@njit(cache=True, inline="always")
def _turn_change(kind, theta, jr, w_out):
    """Changes (3, m, m) of the columns of Jr (3, m) with theta, in the first entries of ``w_out`` (3, 4, 4)."""
    w_out.fill(0.0)
    if kind == EULER_PARAMETERS:
        norm2 = theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2] + theta[3] * theta[3]
        g, unit = np.empty((3, 4)), np.zeros(4)
        for j in range(4):
            unit[j] = 1.0
            # G is linear, and 1 / |e|^2 the normalisation
            _euler_g(unit[0], unit[1], unit[2], unit[3], g)
            unit[j] = 0.0
            for i in range(3):
                for k in range(4):
                    w_out[i, k, j] = (g[i, k] - 2.0 * jr[i, k] * theta[j]) / norm2
    else:
        for k in range(3):
            # axes turn with every angle before them, those of local increments with all
            for j in range(k if kind == TAIT_BRYAN else 3):
                w_out[0, k, j], w_out[1, k, j], w_out[2, k, j] = cross(column(jr, j), column(jr, k))


@njit(cache=True)
def node_frame(kind, q, q_t, reference, rho, a_loc, frame_out, jac_out):
    """Fill ``frame_out`` and Jp, Jr of ``jac_out`` for the marker frame at ``rho`` of one rigid-body node.

    Parameters
    ----------
    kind : int
        One of the constants above.
    q, q_t, reference : ndarray (n,)
        Coordinates without reference values, rates, reference values.
    rho : ndarray (3,)
        Joint point in the node's frame [m].
    a_loc : ndarray (3, 3)
        Marker frame to node frame.
    frame_out : ndarray (3, 6)
        A, p, v, omega, global.
    jac_out : ndarray (4, 3, n)
        Entries 0 and 1 are written.
    """
    nt = translations(kind, q.size)
    a, jr, _, m = turn(kind, q, reference)
    s = times(a, (rho[0], rho[1], rho[2]))
    for i in range(3):
        for j in range(3):
            frame_out[i, j] = a[i, 0] * a_loc[0, j] + a[i, 1] * a_loc[1, j] + a[i, 2] * a_loc[2, j]
        frame_out[i, 3] = s[i]
        frame_out[i, 5] = 0.0
        for k in range(m):
            frame_out[i, 5] += jr[i, k] * q_t[nt + k]
    frame_out[0, 4], frame_out[1, 4], frame_out[2, 4] = cross(column(frame_out, SPIN), s)
    jac_out[:2] = 0.0
    for i in range(nt):
        frame_out[i, 3] += q[i] + reference[i]
        frame_out[i, 4] += q_t[i]
        jac_out[0, i, i] = 1.0
    for k in range(m):
        arm = cross(column(jr, k), s)
        for i in range(3):
            jac_out[0, i, nt + k], jac_out[1, i, nt + k] = arm[i], jr[i, k]


@njit(cache=True)
def node_change(kind, q, reference, rho, change_out):
    """Fill ``change_out`` (6, n, n): derivatives d J[i, a] / dq_b of J = [Jp, Jr]; arguments as in `node_frame`."""
    nt = translations(kind, q.size)
    a, jr, theta, m = turn(kind, q, reference)
    w = np.empty((3, 4, 4))
    _turn_change(kind, theta, jr, w)
    s = times(a, (rho[0], rho[1], rho[2]))
    change_out.fill(0.0)
    for k in range(m):
        for j in range(m):
            dr = w[0, k, j], w[1, k, j], w[2, k, j]
            dp = lever_change(dr, column(jr, k), column(jr, j), s)
            for i in range(3):
                change_out[i, nt + k, nt + j], change_out[3 + i, nt + k, nt + j] = dp[i], dr[i]


@njit(cache=True, inline="always")
def lever_change(dr, turn, moving, arm):
    """Change of turn x arm, 3-tuples, for a change ``dr`` of the turn while the arm turns with ``moving``."""
    first, second = cross(dr, arm), cross(turn, cross(moving, arm))
    return first[0] + second[0], first[1] + second[1], first[2] + second[2]


@njit(cache=True)
def add_lever(turns, arm, change_out):
    """Add to the changes of Jp in ``change_out`` (6, n, n) those of Jr x arm, for Jr (3, n) and an arm (3,)."""
    s = arm[0], arm[1], arm[2]
    for k in range(turns.shape[1]):
        for j in range(turns.shape[1]):
            dr = change_out[3, k, j], change_out[4, k, j], change_out[5, k, j]
            dp = lever_change(dr, column(turns, k), column(turns, j), s)
            for i in range(3):
                change_out[i, k, j] += dp[i]


@njit(cache=True)
def vary(change, q_t, load, jac_out, geometric_out):
    """Fill Vq, Wq of ``jac_out`` and the geometric term d(J^T load) / dq (n, n) at a fixed load (6,), force and moment.

    ``change`` (6, n, n) is that of `node_change`; (6, 0, 0) counts as zeros.
    """
    n, known = q_t.size, change.shape[1]
    jac_out[2:] = 0.0
    geometric_out[:] = 0.0
    for i in range(6):
        by_rate = jac_out[2 + i // 3, i % 3]
        for a in range(known):
            row, rate, force = change[i, a], q_t[a], load[i]
            for b in range(n):
                by_rate[b] += row[b] * rate
                geometric_out[a, b] += row[b] * force
