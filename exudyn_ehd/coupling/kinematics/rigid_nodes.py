"""Frames of the nodes of rigid bodies: pose, rates and exact variations, as array kernels.

Every side (housing H, journal J) is described by two work arrays, whoever fills them (the kernels here for the nodes
of rigid bodies, `film_element.MarkerSide` for any other marker):

frame (3, 6)      columns 0-2: A, marker frame to global; 3: position p; 4: velocity v; 5: angular velocity omega;
                  all global
jac   (4, 3, n)   Jp, Jr, Vq, Wq with dp = Jp dq, dphi = Jr dq (global rotation), dv = Vq dq and domega = Wq dq at
                  fixed q_t; with respect to q_t, dv = Jp dq_t and domega = Jr dq_t.

Legend: q, q_t coordinates (without reference values) and their rates; n their number; rho joint point in the node's
frame [m]; a_loc marker frame to node frame; s = A_node rho the global lever arm; T, F, M global torque, force, moment.
What follows for the joint: `joint_kinematics`.

Lie group nodes: q_t holds the local angular velocity, and dq the local incremental rotation, as in Exudyn's Newton.
Euler parameters: the node's rotation is that of e / |e|, so that an iterate off the unit sphere is a pure rotation;
on the sphere, where Exudyn's constraint holds it, all quantities equal Exudyn's.

Vectors are written in loops: numba takes seconds to compile the message of an assignment to a slice that does not fit.
"""

from __future__ import annotations

import numpy as np
from numba import njit

GROUND, EULER_PARAMETERS, TAIT_BRYAN, ROTATION_VECTOR, PLANAR, POINT, PLANAR_POINT = range(7)
"""How a node turns; GROUND has no coordinates, points move without turning."""
POINTS = (POINT, PLANAR_POINT)

COORDINATES = {
    GROUND: 0,
    EULER_PARAMETERS: 7,
    TAIT_BRYAN: 6,
    ROTATION_VECTOR: 6,
    PLANAR: 3,
    POINT: 3,
    PLANAR_POINT: 2,
}
"""Number of coordinates of each kind."""


@njit(cache=True)
def translations(kind):
    """Number of coordinates of the position, which are the first of a node that moves."""
    return 2 if kind in (PLANAR, PLANAR_POINT) else 3


@njit(cache=True)
def cross(a, b):
    """Vector product of two 3-vectors."""
    c = np.empty(3)
    c[0] = a[1] * b[2] - a[2] * b[1]
    c[1] = a[2] * b[0] - a[0] * b[2]
    c[2] = a[0] * b[1] - a[1] * b[0]
    return c


@njit(cache=True)
def times(a, b):
    """Matrix (3, 3) times vector (3,)."""
    c = np.empty(3)
    for i in range(3):
        c[i] = a[i, 0] * b[0] + a[i, 1] * b[1] + a[i, 2] * b[2]
    return c


@njit(cache=True)
def transposed_times(a, b):
    """Transposed matrix (3, 3) times vector (3,)."""
    c = np.empty(3)
    for i in range(3):
        c[i] = a[0, i] * b[0] + a[1, i] * b[1] + a[2, i] * b[2]
    return c


@njit(cache=True)
def euler_g(e):
    """Matrix G (3, 4), bilinear: omega = G(e) e_t for unit e, global components."""
    g = np.empty((3, 4))
    g[0, 0], g[0, 1], g[0, 2], g[0, 3] = -2.0 * e[1], 2.0 * e[0], -2.0 * e[3], 2.0 * e[2]
    g[1, 0], g[1, 1], g[1, 2], g[1, 3] = -2.0 * e[2], 2.0 * e[3], 2.0 * e[0], -2.0 * e[1]
    g[2, 0], g[2, 1], g[2, 2], g[2, 3] = -2.0 * e[3], -2.0 * e[2], 2.0 * e[1], 2.0 * e[0]
    return g


@njit(cache=True)
def _rotation_euler(e):
    norm2 = e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]
    f = 2.0 / norm2
    a = np.empty((3, 3))
    a[0, 0] = 1.0 - f * (e[2] * e[2] + e[3] * e[3])
    a[1, 1] = 1.0 - f * (e[1] * e[1] + e[3] * e[3])
    a[2, 2] = 1.0 - f * (e[1] * e[1] + e[2] * e[2])
    a[0, 1], a[1, 0] = f * (e[1] * e[2] - e[0] * e[3]), f * (e[1] * e[2] + e[0] * e[3])
    a[0, 2], a[2, 0] = f * (e[1] * e[3] + e[0] * e[2]), f * (e[1] * e[3] - e[0] * e[2])
    a[1, 2], a[2, 1] = f * (e[2] * e[3] - e[0] * e[1]), f * (e[2] * e[3] + e[0] * e[1])
    return a, norm2


@njit(cache=True)
def _rotation_vector(v):
    """Exponential map of a rotation vector (3,)."""
    angle = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    half = 0.5 * angle
    # sin(half) / angle stays accurate for small angles, 1 - cos(angle) would not
    sinc = 0.5 * (1.0 - half * half / 6.0) if half < 1e-4 else np.sin(half) / angle
    e = np.empty(4)
    e[0] = np.cos(half)
    for i in range(3):
        e[i + 1] = sinc * v[i]
    a, _ = _rotation_euler(e)
    return a


@njit(cache=True)
def _rotation_tait_bryan(angles):
    """A = Rx(a) Ry(b) Rz(c)."""
    ca, sa = np.cos(angles[0]), np.sin(angles[0])
    cb, sb = np.cos(angles[1]), np.sin(angles[1])
    cc, sc = np.cos(angles[2]), np.sin(angles[2])
    a = np.empty((3, 3))
    a[0, 0], a[0, 1], a[0, 2] = cb * cc, -cb * sc, sb
    a[1, 0], a[1, 1], a[1, 2] = ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb
    a[2, 0], a[2, 1], a[2, 2] = sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb
    return a


@njit(cache=True)
def _tait_bryan_axes(angles):
    """Global axes (3, 3, columns) about which the three angles turn."""
    ca, sa = np.cos(angles[0]), np.sin(angles[0])
    cb, sb = np.cos(angles[1]), np.sin(angles[1])
    g = np.zeros((3, 3))
    g[0, 0] = 1.0
    g[1, 1], g[2, 1] = ca, sa
    g[0, 2], g[1, 2], g[2, 2] = sb, -sa * cb, ca * cb
    return g


@njit(cache=True)
def node_rotation(kind, theta):
    """Rotation matrix (3, 3), node to global, and Jr (3, m) of a node with rotation coordinates ``theta`` (m,)."""
    if kind == EULER_PARAMETERS:
        a, norm2 = _rotation_euler(theta)
        return a, euler_g(theta) / norm2
    if kind == TAIT_BRYAN:
        return _rotation_tait_bryan(theta), _tait_bryan_axes(theta)
    if kind == ROTATION_VECTOR:
        a = _rotation_vector(theta)
        return a, a.copy()
    a = np.eye(3)
    if kind != PLANAR:
        return a, np.zeros((3, 0))
    jr = np.zeros((3, 1))
    jr[2, 0] = 1.0
    a[0, 0], a[0, 1] = np.cos(theta[0]), -np.sin(theta[0])
    a[1, 0], a[1, 1] = np.sin(theta[0]), np.cos(theta[0])
    return a, jr


@njit(cache=True)
def _spin_variation(kind, theta, theta_t, a, jr):
    """d(Jr theta_t) / d theta (3, m) at fixed theta_t."""
    m = jr.shape[1]
    w = np.zeros((3, m))
    if kind == EULER_PARAMETERS:
        norm2 = theta[0] ** 2 + theta[1] ** 2 + theta[2] ** 2 + theta[3] ** 2
        g_t = euler_g(theta_t)
        for i in range(3):
            omega_i = 0.0
            for k in range(4):
                omega_i += jr[i, k] * theta_t[k]
            for k in range(4):
                # G(e) e_t = -G(e_t) e, and the normalisation 1 / |e|^2
                w[i, k] = -g_t[i, k] / norm2 - 2.0 * omega_i * theta[k] / norm2
    elif kind == TAIT_BRYAN:
        first = cross(jr[:, 0], jr[:, 1] * theta_t[1] + jr[:, 2] * theta_t[2])
        second = cross(jr[:, 1], jr[:, 2] * theta_t[2])
        for i in range(3):
            w[i, 0], w[i, 1] = first[i], second[i]
    elif kind == ROTATION_VECTOR:
        for k in range(3):
            e = np.zeros(3)
            e[k] = 1.0
            turn = times(a, cross(e, theta_t))
            for i in range(3):
                w[i, k] = turn[i]
    return w


@njit(cache=True)
def _torque_variation(kind, theta, jr, torque):
    """d(Jr^T T) / d theta (m, m) at a fixed global torque T."""
    m = jr.shape[1]
    h = np.zeros((m, m))
    if kind == EULER_PARAMETERS:
        norm2 = theta[0] ** 2 + theta[1] ** 2 + theta[2] ** 2 + theta[3] ** 2
        for j in range(4):
            e = np.zeros(4)
            e[j] = 1.0
            g_j = euler_g(e)
            for i in range(4):
                q_i, dq_i = 0.0, 0.0
                for k in range(3):
                    q_i += jr[k, i] * torque[k]
                    dq_i += g_j[k, i] * torque[k]
                h[i, j] = (dq_i - 2.0 * q_i * theta[j]) / norm2
    elif kind == TAIT_BRYAN:
        # axis i turns with every angle before it: dg_i / dtheta_j = g_j x g_i for j < i
        for i in range(3):
            for j in range(i):
                d = cross(jr[:, j], jr[:, i])
                h[i, j] = d[0] * torque[0] + d[1] * torque[1] + d[2] * torque[2]
    elif kind == ROTATION_VECTOR:
        local = transposed_times(jr, torque)
        h[0, 1], h[0, 2] = -local[2], local[1]
        h[1, 0], h[1, 2] = local[2], -local[0]
        h[2, 0], h[2, 1] = -local[1], local[0]
    return h


@njit(cache=True)
def node_frame(kind, q, q_t, reference, rho, a_loc, frame_out, jac_out):
    """Fill ``frame_out`` and Jp, Jr of ``jac_out`` for the marker frame at ``rho`` of one rigid-body node.

    Parameters
    ----------
    kind : int
        One of the constants above, not GROUND.
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
    nt = translations(kind)
    a, jr = node_rotation(kind, q[nt:] + reference[nt:])
    s = times(a, rho)
    omega = np.zeros(3)
    for i in range(3):
        for k in range(jr.shape[1]):
            omega[i] += jr[i, k] * q_t[nt + k]
    v = cross(omega, s)
    for i in range(3):
        for j in range(3):
            frame_out[i, j] = a[i, 0] * a_loc[0, j] + a[i, 1] * a_loc[1, j] + a[i, 2] * a_loc[2, j]
        frame_out[i, 3] = s[i]
        frame_out[i, 4] = v[i]
        frame_out[i, 5] = omega[i]
    for i in range(nt):
        frame_out[i, 3] += q[i] + reference[i]
        frame_out[i, 4] += q_t[i]
    jac_out[:2] = 0.0
    for i in range(nt):
        jac_out[0, i, i] = 1.0
    for k in range(jr.shape[1]):
        arm = cross(jr[:, k], s)
        for i in range(3):
            jac_out[0, i, nt + k], jac_out[1, i, nt + k] = arm[i], jr[i, k]


@njit(cache=True)
def node_variation(kind, q, q_t, reference, rho, jac_out):
    """Fill Vq and Wq of ``jac_out`` (4, 3, n), whose Jr must be current: variation of v and omega at fixed rates."""
    nt = translations(kind)
    theta = q[nt:] + reference[nt:]
    a, jr = node_rotation(kind, theta)
    s = times(a, rho)
    w = _spin_variation(kind, theta, q_t[nt:], a, jr)
    omega = np.zeros(3)
    for k in range(jr.shape[1]):
        for i in range(3):
            omega[i] += jr[i, k] * q_t[nt + k]
    jac_out[2:] = 0.0
    for k in range(jr.shape[1]):
        # v = r_t + omega x s, ds = dphi x s
        turned, moved = cross(w[:, k], s), cross(omega, cross(jr[:, k], s))
        for i in range(3):
            jac_out[2, i, nt + k], jac_out[3, i, nt + k] = turned[i] + moved[i], w[i, k]


@njit(cache=True)
def node_geometric(kind, q, reference, rho, force, moment, geo_out):
    """Geometric term d(Jp^T F + Jr^T M) / dq (n, n) at fixed global force and moment at the marker."""
    nt = translations(kind)
    theta = q[nt:] + reference[nt:]
    a, jr = node_rotation(kind, theta)
    s = times(a, rho)
    m = jr.shape[1]
    h = _torque_variation(kind, theta, jr, moment + cross(s, force))
    geo_out[:] = 0.0
    for j in range(m):
        # the torque s x F changes with the arm: dT = (dphi x s) x F
        d_torque = cross(cross(jr[:, j], s), force)
        for i in range(m):
            geo_out[nt + i, nt + j] = h[i, j] + jr[0, i] * d_torque[0] + jr[1, i] * d_torque[1] + jr[2, i] * d_torque[2]
