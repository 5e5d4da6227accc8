"""Relative motion of the two frames of a joint, its smallest gap, and loads on their coordinates, as array kernels.

Frames, Jacobians and legend as in `kinematics`; index h: housing, j: journal. The journal's axis is z of its frame, the
joint frame that of the housing.

Place of a journal along its bearing's axis: the eleventh entry of its motion, for films on end faces
-----------------------------------------------------------------------------------------------------
It is the position of the journal's centre, the point of its axis at the housing's joint point in the reference
configuration,

    z = e_z . (p_J - z_0 a - p_H),

with the bearing's axis e_z, the journal's axis a, and the distance z_0 of both joint points in the reference
configuration. It does not depend on where along the axis the journal's joint point lies; its rate is w, to second order
in the tilt.

Motion of a ball in the frame of its socket, of whose own frame the place alone counts. With r = p_j - p_h and A the
socket's frame

    e = A^T r,   v = A^T (v_j - v_h - w_h x r) = A^T u,   w = A^T (w_j - w_h) = A^T s,

and where the socket turns by dphi a vector A^T g fixed in space changes by -A^T (dphi x g).

Smallest gap between a journal and its rigid bore, circular or not
------------------------------------------------------------------
With the journal's axis at (x, y) + z (b_x, b_y) the gap is c - (x + z b_x) cos theta - (y + z b_y) sin theta and what
the bore's profiles add. Its smallest value in a circular bore is c less the larger eccentricity of the two ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from exudyn.rigidBodyUtilities import Skew
from numba import njit

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.kinematics.rigid_nodes import AXIS, PLACE, SPIN, VELOCITY, column, cross, dot, in_frame, times


def skews(vectors: np.ndarray) -> np.ndarray:
    """Matrices (n, 3, 3) of the cross products with the columns of ``vectors`` (3, n)."""
    (x, y, z), zero = vectors, np.zeros(vectors.shape[1])
    return np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), -1, 0)


@njit(cache=True)
def _minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(cache=True)
def _plus(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@njit(cache=True)
def _columns(jac, k):
    """Columns k of Jp, Jr, Vq and Wq."""
    return column(jac[0], k), column(jac[1], k), column(jac[2], k), column(jac[3], k)


@njit(cache=True)
def motion_of(frame_h, frame_j):
    """Motion (10,) of the journal axis in the joint frame of the housing; see `exudyn_ehd.joint.solved_film`.

    The journal axis is the line (x + bx z, y + by z). All ten components are independent of where along the axis the
    journal's marker sits; w is the velocity along z of the journal's axis point in the mid-plane.
    The motion is nan where the cosine of the angle between the axes is below 0.1 (no bearing any more).
    """
    out = np.empty(10)
    r = _minus(column(frame_j, PLACE), column(frame_h, PLACE))
    omega_h = column(frame_h, SPIN)
    d = in_frame(frame_h, r)
    d_t = in_frame(frame_h, _minus(_minus(column(frame_j, VELOCITY), column(frame_h, VELOCITY)), cross(omega_h, r)))
    spin = in_frame(frame_h, _minus(column(frame_j, SPIN), omega_h))
    a = in_frame(frame_h, column(frame_j, AXIS))
    if not a[2] > 0.1:
        out.fill(np.nan)
        return out
    a_t = cross(spin, a)
    for i in range(2):
        b = a[i] / a[2]
        b_t = (a_t[i] - b * a_t[2]) / a[2]
        out[i] = d[i] - b * d[2]
        out[2 + i] = b
        out[4 + i] = d_t[i] - b_t * d[2] - b * d_t[2]
        out[6 + i] = b_t
    out[8] = spin[0] * a[0] + spin[1] * a[1] + spin[2] * a[2]
    out[9] = d_t[2] - a_t[2] * d[2] / a[2]
    return out


@njit(cache=True)
def _motion_variation(sign, d, d_t, spin, a, a_t, dd, dd_t, dspin, da, c, out):
    """Variation of the ten motion components, into column c of ``out``, from ``sign`` times the variation of d, d_t,
    Omega and a, all 3-tuples in the joint frame."""
    da_t = _plus(cross(dspin, a), cross(spin, da))
    for i in range(2):
        b = a[i] / a[2]
        b_t = (a_t[i] - b * a_t[2]) / a[2]
        db = (da[i] - b * da[2]) / a[2]
        db_t = (da_t[i] - db * a_t[2] - b * da_t[2] - b_t * da[2]) / a[2]
        out[i, c] = sign * (dd[i] - db * d[2] - b * dd[2])
        out[2 + i, c] = sign * db
        out[4 + i, c] = sign * (dd_t[i] - db_t * d[2] - b_t * dd[2] - db * d_t[2] - b * dd_t[2])
        out[6 + i, c] = sign * db_t
    out[8, c] = sign * (
        dspin[0] * a[0] + dspin[1] * a[1] + dspin[2] * a[2] + spin[0] * da[0] + spin[1] * da[1] + spin[2] * da[2]
    )
    out[9, c] = sign * (dd_t[2] - (da_t[2] * d[2] + a_t[2] * dd[2]) / a[2] + a_t[2] * d[2] * da[2] / (a[2] * a[2]))


@njit(cache=True, inline="always")
def variation_of(frame_h, frame_j, jac_h, jac_j):
    """Derivatives (10, n) of the motion with respect to q and q_t, columns in the order housing, journal."""
    axis, omega_h = column(frame_j, AXIS), column(frame_h, SPIN)
    r = _minus(column(frame_j, PLACE), column(frame_h, PLACE))
    u = _minus(_minus(column(frame_j, VELOCITY), column(frame_h, VELOCITY)), cross(omega_h, r))
    spin_g = _minus(column(frame_j, SPIN), omega_h)
    d, d_t, spin, a = in_frame(frame_h, r), in_frame(frame_h, u), in_frame(frame_h, spin_g), in_frame(frame_h, axis)
    a_t, zero = cross(spin, a), (0.0, 0.0, 0.0)
    n_h, n = jac_h.shape[2], jac_h.shape[2] + jac_j.shape[2]
    motion_q, motion_qt = np.empty((10, n)), np.empty((10, n))
    for c in range(n):
        with_housing = c < n_h
        jac, k = (jac_h, c) if with_housing else (jac_j, c - n_h)
        jp, jr, vq, wq = _columns(jac, k)
        moved = cross(omega_h, jp)
        if with_housing:
            # the frame turns with the housing: a fixed global vector g changes by -A^T (dphi x g)
            sign, place = -1.0, _plus(jp, cross(jr, r))
            rate = _plus(_minus(_plus(vq, cross(wq, r)), moved), cross(jr, u))
            spun = _plus(wq, cross(jr, spin_g))
        else:
            sign, place, rate, spun = 1.0, jp, _minus(vq, moved), wq
        dd, dd_t, dspin = in_frame(frame_h, place), in_frame(frame_h, rate), in_frame(frame_h, spun)
        da, dspin_rate = in_frame(frame_h, cross(jr, axis)), in_frame(frame_h, jr)
        _motion_variation(sign, d, d_t, spin, a, a_t, dd, dd_t, dspin, da, c, motion_q)
        # the velocity changes with the rates as the place does with the coordinates
        _motion_variation(sign, d, d_t, spin, a, a_t, zero, dd, dspin_rate, zero, c, motion_qt)
    return motion_q, motion_qt


def angle_of(frame_h: np.ndarray, frame_j: np.ndarray) -> float:
    """Angle of the journal against the housing about the bearing's axis [rad], 0 in the reference configuration."""
    turn = frame_h[:, :3].T @ frame_j[:, 0]
    return math.atan2(turn[1], turn[0])


@njit(cache=True, inline="always")
def global_loads(frame_h, frame_j, wrench, loads_out):
    """Global force and moment at the two markers, rows F_H, M_H, F_J, M_J of ``loads_out`` (4, 3).

    ``wrench`` (6,) acts on the journal, joint frame, moment about O = p_H; the housing gets exactly minus it about O.
    """
    force = times(frame_h, (wrench[0], wrench[1], wrench[2]))
    moment = times(frame_h, (wrench[3], wrench[4], wrench[5]))
    arm = cross(_minus(column(frame_j, PLACE), column(frame_h, PLACE)), force)
    for i in range(3):
        loads_out[0, i], loads_out[1, i] = -force[i], -moment[i]
        loads_out[2, i], loads_out[3, i] = force[i], moment[i] - arm[i]


@njit(cache=True, inline="always")
def wrench_map(frame_h, frame_j, jac_h, jac_j):
    """Map (n, 6) from the wrench on the journal, joint frame, to the generalized forces of both sides."""
    n_h = jac_h.shape[2]
    out = np.empty((n_h + jac_j.shape[2], 6))
    r = _minus(column(frame_j, PLACE), column(frame_h, PLACE))
    for c in range(3):
        a = column(frame_h, c)
        # moment about the journal's point of a force along axis c at O
        m = cross(a, r)
        for k in range(n_h):
            place, turn, _, _ = _columns(jac_h, k)
            out[k, c], out[k, 3 + c] = -dot(place, a), -dot(turn, a)
        for k in range(jac_j.shape[2]):
            place, turn, _, _ = _columns(jac_j, k)
            out[n_h + k, c] = dot(place, a) + dot(turn, m)
            out[n_h + k, 3 + c] = dot(turn, a)
    return out


@njit(cache=True, inline="always")
def tangent_matrices(frame_h, frame_j, jac_h, jac_j, loads, tangent, motion_q, motion_qt, k_out, d_out):
    """Add dQ/dq to ``k_out`` and write dQ/dq_t to ``d_out`` (n, n); ``k_out`` brings the geometric blocks of the sides.

    ``tangent`` (6, m) is d wrench / d motion in the joint frame, of a motion with m entries.
    """
    force, moment = (loads[2, 0], loads[2, 1], loads[2, 2]), (-loads[1, 0], -loads[1, 1], -loads[1, 2])
    by_wrench, n_h = wrench_map(frame_h, frame_j, jac_h, jac_j), jac_h.shape[2]
    n = by_wrench.shape[0]
    by_place, by_rate = np.empty(6), np.empty(6)
    for c in range(n):
        jac, k = (jac_h, c) if c < n_h else (jac_j, c - n_h)
        for i in range(6):
            by_place[i] = by_rate[i] = 0.0
            for m in range(tangent.shape[1]):
                by_place[i] += tangent[i, m] * motion_q[m, c]
                by_rate[i] += tangent[i, m] * motion_qt[m, c]
        # the arm of the force about the journal's point
        place, turned, _, _ = _columns(jac, k)
        moved = cross(force, place)
        if c < n_h:
            # the joint frame turns, and with it the wrench
            moved = _minus((0.0, 0.0, 0.0), moved)
            turn_f, turn_m = in_frame(frame_h, cross(turned, force)), in_frame(frame_h, cross(turned, moment))
            for i in range(3):
                by_place[i] += turn_f[i]
                by_place[3 + i] += turn_m[i]
        for i in range(n):
            total = dot(_columns(jac_j, i - n_h)[1], moved) if i >= n_h else 0.0
            d_out[i, c] = 0.0
            for m in range(6):
                total += by_wrench[i, m] * by_place[m]
                d_out[i, c] += by_wrench[i, m] * by_rate[m]
            k_out[i, c] += total


def ball_motion(frame_h: np.ndarray, frame_j: np.ndarray) -> np.ndarray:
    """Motion (11,) of a ball for frames (3, 6): place, 0, velocity, 0, angular velocity."""
    out = np.zeros(11)
    d = frame_j - frame_h
    turn = Skew(frame_h[:, SPIN]) @ d[:, PLACE]
    out[:3], out[4:7], out[8:] = (d[:, PLACE], d[:, VELOCITY] - turn, d[:, SPIN]) @ frame_h[:, :3]
    return out


def ball_variation(
    frame_h: np.ndarray, frame_j: np.ndarray, jac_h: np.ndarray, jac_j: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (11, n) of a ball's motion to q and q_t, columns in the order socket, ball."""
    d, spin, n_h = frame_j - frame_h, Skew(frame_h[:, SPIN]), jac_h.shape[2]
    arm, moving = Skew(d[:, PLACE]), Skew(d[:, VELOCITY] - spin @ d[:, PLACE])
    by_q, by_rate = np.zeros((2, 11, n_h + jac_j.shape[2]))
    for sign, (jp, jr, vq, wq), own in ((-1.0, jac_h, slice(n_h)), (1.0, jac_j, slice(n_h, None))):
        place, rate, spun, turn = jp, vq - spin @ jp, wq, sign * frame_h[:, :3].T
        if sign < 0.0:
            place, rate = jp - arm @ jr, rate - arm @ wq - moving @ jr
            spun = wq - Skew(d[:, SPIN]) @ jr
        by_q[:3, own], by_q[4:7, own], by_q[8:, own] = turn @ place, turn @ rate, turn @ spun
        by_rate[4:7, own], by_rate[8:, own] = turn @ place, turn @ jr
    return by_q, by_rate


class Kinematics(NamedTuple):
    """Motion (m,) of one frame in another, and its derivatives (m, n) to the coordinates and rates of both."""

    motion_of: Callable
    variation_of: Callable


JOURNAL, BALL = Kinematics(motion_of, variation_of), Kinematics(ball_motion, ball_variation)


def collar_kinematics(offset: float) -> Kinematics:
    """Kinematics of a journal with its place along the axis (11,), for a distance ``offset`` of the joint points, m."""

    def centre(frame_h: np.ndarray, frame_j: np.ndarray) -> np.ndarray:
        return (frame_j[:, PLACE] - offset * frame_j[:, AXIS] - frame_h[:, PLACE]) @ frame_h[:, :3]

    def motion(frame_h: np.ndarray, frame_j: np.ndarray) -> np.ndarray:
        return np.append(motion_of(frame_h, frame_j), centre(frame_h, frame_j)[2])

    def variation(
        frame_h: np.ndarray, frame_j: np.ndarray, jac_h: np.ndarray, jac_j: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        by_q, by_rate = variation_of(frame_h, frame_j, jac_h, jac_j)
        x, y, _ = centre(frame_h, frame_j)
        # the work of a unit force along the axis at the centre
        along = wrench_map(frame_h, frame_j, jac_h, jac_j) @ np.array([0.0, 0.0, 1.0, y, -x, 0.0])
        return np.vstack((by_q, along)), np.vstack((by_rate, np.zeros_like(along)))

    return Kinematics(motion, variation)


def levers_of(bearing: JournalBearing) -> np.ndarray:
    """Lengths (4,) that turn a motion's places, or their rates, into distances: a tilt counts at the ends, m."""
    half = 0.5 * bearing.length
    return np.array(getattr(bearing, "levers", (1.0, 1.0, half, half)))


def eccentricity_ratios(motion: np.ndarray, radial_clearance: float, length: float) -> tuple[float, float]:
    """Eccentricity ratio in the mid-plane and the largest along the length (which is at an end: it is convex)."""
    x, y, bx, by = motion[:4].tolist()
    half = 0.5 * length
    ends = max((x + bx * half) ** 2 + (y + by * half) ** 2, (x - bx * half) ** 2 + (y - by * half) ** 2)
    return (x * x + y * y) ** 0.5 / radial_clearance, ends**0.5 / radial_clearance


# Points around and along a bore that is no circular cylinder.
AROUND, ALONG = 180, 9


class BoreGap:
    """Gap of one bearing's rigid surfaces.

    Parameters
    ----------
    bearing : JournalBearing

    Attributes
    ----------
    widest : float
        Largest gap of a journal in the bore's axis, m.
    """

    def __init__(self, bearing: JournalBearing) -> None:
        self.clearance, self.half = bearing.radial_clearance, 0.5 * bearing.length
        self.widest, self.depth = self.clearance, np.empty(0)
        profiles, arcs = getattr(bearing, "profiles", ()), getattr(bearing, "bore_arcs", ())
        if profiles or arcs:
            theta, z = (
                np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False),
                np.linspace(-self.half, self.half, ALONG),
            )
            lobes = np.zeros((AROUND, 1))
            if arcs:
                parts = [(arc, arc.start + arc.extent * np.linspace(0.0, 1.0, AROUND)) for arc in arcs]
                theta = np.concatenate([at for _, at in parts])
                lobes = self.clearance * np.concatenate([arc.lobe(at) for arc, at in parts])[:, None]
            depths = [profile.depth(theta, z, bearing.length) for profile in profiles]
            self.depth = np.sum([lobes + np.zeros(ALONG), *depths], axis=0)
            self.widest += float(self.depth.max())
            c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
            self.normals = np.stack(np.broadcast_arrays(c, s, c * z, s * z), axis=-1)
        # bearings that are no cylinders provide their own directions
        own = getattr(bearing, "gap_normals", None)
        if own is not None:
            self.normals = own()
            self.depth = np.zeros(len(self.normals))

    def smallest(self, motion: np.ndarray) -> float:
        """Smallest gap [m] at a motion (10,) of the journal's axis; negative where the surfaces overlap."""
        if self.depth.size:
            return float(self.values(motion).min())
        return self.clearance * (1.0 - eccentricity_ratios(motion, self.clearance, 2.0 * self.half)[1])

    def values(self, motion: np.ndarray) -> np.ndarray:
        """Gaps [m] all over a bore with profiles."""
        return self.clearance + self.depth - self.normals @ motion[:4]
