"""Integrals of pressure and shear over the film, flows through its edges, and its largest pressure.

Scaled integrals, W = integration weights of (theta, z/R), P = p c^2 / (12 mu R^2):

    S_c = sum P W cos,  S_s = sum P W sin,  S_zc = sum P W z cos,  S_zs = sum P W z sin,  C = sum W share / H

The normal e_r is fixed in the housing, and the pressure acts at the same point on both surfaces. On the journal it
gives

    F = -(12 mu R^4 / c^2) (S_c, S_s),   M = (12 mu R^5 / c^2) (S_zs, -S_zc).

Shear: the stress on the bush is ``tau = mu U/h - (h/2) dp/dx``, that on the journal, at the same point, its opposite.
The Poiseuille part, summed by parts, is ``sum (h/2) dp/dx = -(1/2) sum p dh/dx`` (+ the ends' part in z). It is half of
e x F. This half is added to the torque on the journal about the journal's axis, and subtracted from that on the bush
about the bush's axis.

The module also has the derivatives of the wrench to the motion of a rigid journal. The largest pressure of a film may
lie between its vertices.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST


class Scales(NamedTuple):
    """SI units of scaled quantities at the viscosity of one temperature, and the known pressures in them.

    pressure, force, shear : Pa, N, and N s/m of Couette shear
    ends : (2,) array, pressures at both ends
    cavity : cavity pressure
    edges : (2 k,) array; for every arc minus the pressure at its leading edge, then the pressure at its trailing edge;
        None if all are 0
    """

    pressure: float
    force: float
    shear: float
    ends: np.ndarray
    cavity: float
    edges: np.ndarray | None = None


def film_scales(viscosity: float, radius: float, clearance: float, known: np.ndarray) -> Scales:
    """Scales of a film of a viscosity, Pa s; ``known``: pressures of ends, cavity and edges of arcs, Pa."""
    pressure = 12.0 * viscosity * radius**2 / clearance**2
    ends, cavity, edges = known[:2] / pressure, float(known[2] / pressure), known[3:] / pressure
    signed = edges * np.tile((-1.0, 1.0), edges.size // 2) if edges.any() else None
    return Scales(pressure, pressure * radius**2, viscosity * radius**2 / clearance, ends, cavity, signed)


@njit(cache=True, fastmath=FAST)
def pressure_integrals(P, weight, shapes, out):
    """Set S_c, S_s, S_zc, S_zs in out (4,); ``shapes``: `FilmGrid.gap_shapes`."""
    by_pose, p, w = shapes[0].reshape(-1, 4), P.reshape(-1), weight.reshape(-1)
    x = y = bx = by = 0.0
    for c in range(p.size):
        pressed = p[c] * w[c]
        x += pressed * by_pose[c, 0]
        y += pressed * by_pose[c, 1]
        bx += pressed * by_pose[c, 2]
        by += pressed * by_pose[c, 3]
    out[0], out[1], out[2], out[3] = -x, -y, -bx, -by


@njit(cache=True, inline="always")
def ends_cavity(active, fixed, i, end):
    """Return whether the end vertex (i, end) lies beside a cavity; its half control volume then has the cavity's
    fill."""
    last = active.shape[1] - 1
    beside = 1 if end == 0 else last - 1
    return last > 1 and fixed[i, end] and not (active[i, beside] or fixed[i, beside])


# A flat loop without checks for a division by zero, which the compiler vectorises.
@njit(cache=True, fastmath=FAST, error_model="numpy")
def couette_integral(H, weight, active, fixed, cavity_share):
    """Return C for constant viscosity; ``cavity_share``: shear of the ruptured film over that of a full one."""
    h, w, free, known = H.reshape(-1), weight.reshape(-1), active.reshape(-1), fixed.reshape(-1)
    cavity = unbroken = 0.0
    for c in range(h.size):
        s = w[c] / h[c]
        unbroken += s if free[c] | known[c] else 0.0
        cavity += 0.0 if free[c] | known[c] else s
    ends = 0.0
    for i in range(H.shape[0]):
        for end in (0, H.shape[1] - 1):
            if ends_cavity(active, fixed, i, end):
                ends += weight[i, end] / H[i, end]
    return unbroken + cavity_share * cavity - (1.0 - cavity_share) * ends


@njit(cache=True, inline="always")
def end_forces(H, width, pressures):
    """Return the integral of gap times pressure over the upper end less that over the lower end.

    ``width`` (n,): widths of the control volumes; ``pressures``: (lower, upper).
    """
    lower, upper = pressures[0], pressures[1]
    if lower == 0.0 and upper == 0.0:
        return 0.0
    n, m = H.shape
    first = last = 0.0
    for i in range(n):
        first += H[i, 0] * width[i]
        last += H[i, m - 1] * width[i]
    return upper * last - lower * first


@njit(cache=True)
def integral_weights(pose, scales, speeds, out):
    """Set weights (6, 8) of (S_c, S_s, S_zc, S_zs, C, additions to the integrals of p dh/ds in theta and z, end force)
    in the wrench on the journal.

    Gap terms and uneven drag add to the integrals over the slopes. On the bore this addition acts twice: by half of
    p dh/ds as in every shear, and by -p dh/ds, the pressure on the slope of the gap term. Uneven drag acts on journal
    and bore with opposite forces. ``pose`` (4,): scaled; ``scales``: (force, shear, R); ``speeds``: spin, axial speed.
    """
    (force, shear, R), (omega, w) = scales, speeds
    x, y, bx, by = pose[0], pose[1], pose[2], pose[3]
    axial, turning = 6.0 * shear * R, 6.0 * shear * R * R
    out[:] = 0.0
    out[0, 0] = out[1, 1] = -force
    out[2, 0], out[2, 1], out[2, 4], out[2, 6], out[2, 7] = axial * bx, axial * by, -shear * w, axial, axial
    out[3, 3], out[4, 2] = force * R, -force * R
    out[5, 0], out[5, 1], out[5, 2], out[5, 3] = turning * y, -turning * x, turning * by, -turning * bx
    out[5, 4], out[5, 5] = -shear * R * R * omega, turning


@njit(cache=True)
def journal_wrench(pose, integrals, couette, extra_theta, extra_z, H, width, ends, scales, speeds, out):
    """Set the wrench on the journal in out (>= 6,), SI; returns the scaled integral of the pressure flow's shear along
    theta.

    ``extra_theta``, ``extra_z``: additions of gap terms and uneven drag to those integrals. At the edges of an arc, the
    edge pressure times the gap is subtracted from the first, as grooves press on their walls in the bore. H, ``width``,
    ``ends``: for `end_forces`; ``scales``, ``speeds``: as for `integral_weights`.
    """
    w, pressed = np.empty((6, 8)), end_forces(H, width, ends)
    integral_weights(pose, scales, speeds, w)
    for r in range(6):
        out[r] = w[r, 4] * couette + w[r, 5] * extra_theta + w[r, 6] * extra_z + w[r, 7] * pressed
        for k in range(4):
            out[r] += w[r, k] * integrals[k]
    along = pose[0] * integrals[1] - pose[1] * integrals[0] + pose[2] * integrals[3] - pose[3] * integrals[2]
    return along + extra_theta


# A flat loop as in `couette_integral`.
@njit(cache=True, fastmath=FAST, error_model="numpy")
def couette_gradient(H, weight, active, fixed, cavity_share, out):
    """Set dC/dH in out (n, m)."""
    h, w, free, known, by = H.reshape(-1), weight.reshape(-1), active.reshape(-1), fixed.reshape(-1), out.reshape(-1)
    for c in range(h.size):
        by[c] = -w[c] / (h[c] * h[c]) * (1.0 if free[c] | known[c] else cavity_share)
    if cavity_share == 1.0:
        return
    for i in range(H.shape[0]):
        for end in (0, H.shape[1] - 1):
            out[i, end] *= cavity_share if ends_cavity(active, fixed, i, end) else 1.0


@njit(cache=True, fastmath=FAST)
def load_adjoint_rhs(order, count, weight, shapes, active, rhs_out):
    """Set rhs_out (4, count): weights of the unknowns in S_c, S_s, S_zc, S_zs, zero where the pressure is clipped.

    ``shapes``: `FilmGrid.gap_shapes`.
    """
    by_pose, w, free = shapes[0].reshape(-1, 4), weight.reshape(-1), active.reshape(-1)
    for r in range(count):
        c = order[r]
        for q in range(4):
            rhs_out[q, r] = -w[c] * by_pose[c, q] if free[c] else 0.0


def end_flows(
    P: np.ndarray,
    kz: np.ndarray,
    fz: np.ndarray,
    fx: np.ndarray,
    H_t: np.ndarray,
    width_x: np.ndarray,
    width_z: np.ndarray,
    squeeze: bool,
    full: np.ndarray,
) -> tuple[float, float]:
    """Scaled volume flow that leaves through z = -L/2 and z = +L/2.

    The flow from an end into its half control volume is q + B: q is the pressure flow to the next vertex, B the
    divergence of the Couette flow in theta plus the squeeze. This holds where the film next to the end is ``full``
    (n, m): unbroken, or fed by a supply area. Next to a cavity, a film begins at an end with a pressure above the
    cavity's. It ends where its pressure parabola does, before the next vertex. For q < B its flow is
    ``2 sqrt(q B)``. At q = B, where the line reaches the next vertex, this is equal to q + B, with the same slope.
    """
    m = P.shape[1]
    # first and last column; those beside them, one and the same of three; links to them
    ends, beside, links = slice(None, None, m - 1), slice(1, -1, max(m - 3, 1)), slice(0, -1, m - 2)
    around = fx[:, ends]
    q = kz[:, links] * (P[:, ends] - P[:, beside])
    B = around - np.concatenate((around[-1:], around[:-1]))
    if squeeze:
        B = B + H_t[:, ends] * (width_x[:, None] * width_z[ends])
    reaches = full[:, beside] | ((q > 0.0) & (q >= B))
    taken = np.where(reaches, q + B, np.where(q > 0.0, 2.0 * np.sqrt(np.maximum(q * B, 0.0)), q))
    lower, upper = (fz[:, links] * (-1.0, 1.0) - taken).sum(axis=0).tolist()
    return lower, upper


def refined_peak(
    P: np.ndarray, fixed: np.ndarray, x: np.ndarray, links: np.ndarray, z: np.ndarray
) -> tuple[float, float, float]:
    """Peak of P (n, m) with its x and z, from parabolas through the largest vertex and its neighbours in x and in z.

    At a vertex whose pressure is prescribed (``fixed``, (n, m)), of a supply area or an end, the pressure has a kink:
    the peak is then that of the vertex. Beside such a vertex, from which the pressure may fall steeply, a parabola
    overshoots: its rise above the largest vertex is limited to a quarter of the smaller drop to the neighbours.
    ``links`` (n,): 0 behind the last column of an arc. Where columns are spaced unevenly, at the step of a dam, the
    pressure has a kink as well, and no parabola in x is used.
    """
    n, m = P.shape
    i, j = divmod(int(np.argmax(P)), m)
    peak, at_x, at_z = float(P[i, j]), float(x[i]), float(z[j])
    if fixed[i, j]:
        return peak, at_x, at_z
    rise_x = rise_z = 0.0
    if abs(links[i - 1] - links[i]) <= 1e-9 * links[i]:
        around, step = [i - 1, i, (i + 1) % n], math.remainder(x[(i + 1) % n] - x[i], math.tau)
        rise_x, shift = _crest(P[around, j], fixed[around, j], step, step)
        at_x += shift
    if 0 < j < m - 1:
        near = slice(j - 1, j + 2)
        rise_z, shift = _crest(P[i, near], fixed[i, near], *np.diff(z[near]).tolist())
        at_z += shift
    return peak + rise_x + rise_z, at_x, at_z


def _crest(values: np.ndarray, fixed: np.ndarray, h0: float, h1: float) -> tuple[float, float]:
    """Return height and position, relative to the middle point, of the crest of a parabola through three points, some
    of which may be ``fixed``."""
    before, value, after = values.tolist()
    d0, d1 = (value - before) / h0, (after - value) / h1
    second, slope = (d1 - d0) / (h0 + h1), (d0 * h1 + d1 * h0) / (h0 + h1)
    if not second < 0.0:
        return 0.0, 0.0
    rise = -0.25 * slope * slope / second
    return min(rise, 0.25 * (value - max(before, after))) if fixed.any() else rise, -0.5 * slope / second


@njit(cache=True)
def wrench_gradient(changes, pose, integrals, couette, pose_scale, scales, speeds, out):
    """Set the tangent d wrench / d motion (6, 10), SI units, from the gradients of the integrals.

    Parameters
    ----------
    changes : (8, 10) array
        Gradients of the integrals of `integral_weights` to (scaled pose, scaled rates, vx, vz).
    integrals, couette : (4,) array, float
        S_c, S_s, S_zc, S_zs and C.
    pose_scale : (4,) array
        Scale of the pose.
    """
    (_, shear, R), weights = scales, np.empty((6, 8))
    axial, turning = 6.0 * shear * R, 6.0 * shear * R * R
    integral_weights(pose, scales, speeds, weights)
    for r in range(6):
        for q in range(10):
            out[r, q] = 0.0
            for k in range(8):
                out[r, q] += weights[r, k] * changes[k, q]
    # derivatives of the weights to the pose
    out[2, 2] += axial * integrals[0]
    out[2, 3] += axial * integrals[1]
    out[5, 0] -= turning * integrals[1]
    out[5, 1] += turning * integrals[0]
    out[5, 2] -= turning * integrals[3]
    out[5, 3] += turning * integrals[2]
    for r in range(6):
        for q in range(8):
            out[r, q] *= pose_scale[q % 4]
        out[r, 8] *= 0.5
        out[r, 9] *= 0.5 / R
    out[2, 9] -= shear * couette
    out[5, 8] -= shear * R * R * couette


@njit(cache=True)
def end_films(links, b, active, fixed, cuts, widths, length_z, balance_out):
    """Correct the balances of supply areas: the film from an area into a cavity ends where its parabola of pressure
    does.

    B is the flow per length that wedge and squeeze take away. The scheme takes ``B (d - l / 2)`` from the area for the
    film from its edge to the middle of the link, where the control volumes meet. l is the length of the link, d the
    distance from the edge to the first vertex of the cavity. A film that begins at the cavity pressure ends at once and
    takes nothing. If the vertex receives the pressure flow q, the total flow from the area (for d = l) is
    ``sqrt(2 q B l)`` in place of ``q + B l / 2``. This holds up to the q at which the film reaches the vertex.

    Parameters
    ----------
    links : conductances (n, m) in theta and z
    b, active, fixed : (n, m), right-hand side of the balances, vertices of the film and prescribed ones
    cuts : (2, n, m), factors of the links in theta and z, see `exudyn_ehd.film.grid.FilmGrid`
    widths : control volumes' widths (n,) and (m,)
    length_z : (m - 1,), lengths of the links in z
    balance_out : (n, m)
        Balances, changed in place at prescribed vertices: the flows that these feed into the film.
    """
    n, m = b.shape
    for axis in range(2):
        for i in range(n):
            for j in range(1, m - 1):
                if not fixed[i, j]:
                    continue
                for way in (-1, 1):
                    u, v = ((i + way) % n, j) if axis == 0 else (i, j + way)
                    at = (i, j) if way > 0 else (u, v)
                    if fixed[u, v] or active[u, v] or b[u, v] >= 0.0 or links[axis][at] <= 0.0:
                        continue
                    received = max(0.0, 2.0 * (1.0 + balance_out[u, v] / b[u, v]))
                    width = widths[0][u] if axis == 0 else widths[1][v]
                    # the columns on the edges of arcs have half a width
                    length = max(widths[0][i], widths[0][u]) if axis == 0 else length_z[at[1]]
                    d = length * min(1.0, 1.0 / cuts[axis][at])
                    if received < 1.0:
                        balance_out[i, j] += b[u, v] / width * (d - 0.5 * length) * (1.0 - np.sqrt(received)) ** 2
