"""Integrals of pressure and shear over the film, flows through its edges, and its largest pressure.

Scaled integrals, W = integration weights of (theta, z/R), P = p c^2 / (12 mu R^2):

    S_c = sum P W cos,  S_s = sum P W sin,  S_zc = sum P W z cos,  S_zs = sum P W z sin,  C = sum W share / H

With one normal e_r, fixed in the housing, and one point per vertex, the pressure on the journal gives

    F = -(12 mu R^4 / c^2) (S_c, S_s),   M = (12 mu R^5 / c^2) (S_zs, -S_zc).

Shear: on the bush acts ``tau = mu U/h - (h/2) dp/dx``, on the journal, at the same point, its opposite. The Poiseuille
part, summed by parts, is ``sum (h/2) dp/dx = -(1/2) sum p dh/dx`` (+ the ends' part in z). It splits e x F between the
two surfaces: the torque on the journal about its own axis carries +, that on the bush about its own carries - of half
of it.

Derivatives of the wrench to the motion of a rigid journal and to an elastic bore. Largest pressure of a film, between
its vertices too.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.kernels import FAST
from exudyn_ehd.film.reynolds.gap import transposed_slopes


@njit(cache=True, fastmath=FAST)
def pressure_integrals(P, weight, shapes, out):
    """S_c, S_s, S_zc, S_zs -> out (4,); ``shapes``: `FilmGrid.gap_shapes`."""
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
    """Return whether the end vertex (i, end) lies beside a cavity, whose fill its half control volume then has."""
    last = active.shape[1] - 1
    beside = 1 if end == 0 else last - 1
    return last > 1 and fixed[i, end] and not (active[i, beside] or fixed[i, beside])


# A flat loop without checks for a division by zero, which the compiler vectorises.
@njit(cache=True, fastmath=FAST, error_model="numpy")
def couette_integral(H, weight, active, fixed, cavity_share):
    """C of an oil of one viscosity, with ``cavity_share`` where the film is broken."""
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
    """Integral over both ends of the gap times the pressures (lower, upper) there, the upper end's less the lower's.

    ``width`` (n,): of the control volumes.
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
def journal_wrench(pose, integrals, couette, extra_theta, extra_z, H, width, ends, edges, scales, omega, w, out):
    """Wrench on the journal -> out (>= 6,), SI; returns the scaled integral of the pressure flow's shear along theta.

    ``extra_theta`` and ``extra_z``: what gap terms and uneven drag add to those integrals. On the bore, gap terms act
    twice: by half of p dh/ds as in every shear, and by -p dh/ds of the pressure on their slope. Uneven drag pulls the
    journal by as much as it holds the bore back. H, ``width``, ``ends``: for `end_forces`; ``edges``: the same of
    an arc's edges, 0 of a ring, whose grooves press on their walls in the bore; ``scales``: of force and shear, and R;
    omega, w: spin and axial speed.
    """
    force, shear, R = scales
    x, y, bx, by = pose[0], pose[1], pose[2], pose[3]
    sc, ss, szc, szs = integrals[0], integrals[1], integrals[2], integrals[3]
    s_theta = x * ss - y * sc + bx * szs - by * szc + extra_theta - edges
    s_z = -(bx * sc + by * ss) + extra_z
    out[0], out[1] = -force * sc, -force * ss
    out[2] = -shear * (w * couette + 6.0 * R * (s_z - 2.0 * extra_z - end_forces(H, width, ends)))
    out[3], out[4] = force * R * szs, -force * R * szc
    out[5] = -shear * R**2 * (omega * couette + 6.0 * (s_theta - 2.0 * extra_theta + 2.0 * edges))
    return s_theta


# A flat loop as in `couette_integral`.
@njit(cache=True, fastmath=FAST, error_model="numpy")
def couette_gradient(H, weight, active, fixed, cavity_share, out):
    """dC/dH -> out (n, m)."""
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
    """Weights of S_c, S_s, S_zc, S_zs at the unknowns: rhs_out (4, count); zero where the pressure is clipped.

    ``shapes``: `FilmGrid.gap_shapes`.
    """
    by_pose, w, free = shapes[0].reshape(-1, 4), weight.reshape(-1), active.reshape(-1)
    for r in range(count):
        c = order[r]
        for q in range(4):
            rhs_out[q, r] = -w[c] * by_pose[c, q] if free[c] else 0.0


@njit(cache=True)
def end_flows(P, kz, fz, fx, H_t, width_x, width_z, squeeze, full):
    """Scaled volume flow that leaves through z = -L/2 and z = +L/2.

    The end's half control volume takes q + B: q through the link to the next vertex, B for the divergence of what the
    turn carries and for the squeeze. That is so where the film next to the end is ``full`` (n, m): unbroken, or fed by
    a supply area. Next to a cavity an end with more than its pressure has a film up to a line closer than the next
    vertex: as far as its parabola of pressure falls. For q < B it takes ``2 sqrt(q B)``, which joins q + B with its
    slope at q = B, where the line reaches the next vertex.
    """
    n, m = P.shape
    lower = 0.0
    upper = 0.0
    e = m - 1
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        flow, q, carried = -fz[i, 0], kz[i, 0] * (P[i, 0] - P[i, 1]), fx[i, 0] - fx[prv, 0]
        rate = H_t[i, 0] * width_x[i] * width_z[0] if squeeze else 0.0
        lower += flow - _taken(q, carried, rate, full[i, 1])
        flow, q, carried = fz[i, e - 1], kz[i, e - 1] * (P[i, e] - P[i, e - 1]), fx[i, e] - fx[prv, e]
        rate = H_t[i, e] * width_x[i] * width_z[e] if squeeze else 0.0
        upper += flow - _taken(q, carried, rate, full[i, e - 1])
    return lower, upper


@njit(cache=True)
def _taken(q, carried, rate, full):
    """Inflow of an end's half control volume, without the axial Couette flow; see `end_flows`."""
    B = carried + rate
    if full or (q > 0.0 and q >= B):
        return q + B
    return 2.0 * np.sqrt(q * B) if q > 0.0 else q


@njit(cache=True)
def refined_peak(P, fixed, x, links, z):
    """Peak of P (n, m) with its x and z, from parabolas through the largest vertex and its neighbours in x and in z.

    At a vertex whose pressure is prescribed (``fixed``, (n, m)), of a supply area or an end, the pressure has a kink:
    there the peak is the vertex itself. Beside one, from which the pressure may fall steeply, a parabola overshoots;
    there it may rise above the vertex by a quarter of the smaller drop to its neighbours. ``links`` (n,): 0 behind
    the last column of an arc. Where columns are spaced unevenly, at the step of a dam, the pressure has a kink too.
    """
    n, m = P.shape
    i, j = 0, 0
    for r in range(n):
        for c in range(m):
            if P[r, c] > P[i, j]:
                i, j = r, c
    value = P[i, j]
    rise_x = rise_z = shift_x = shift_z = 0.0
    if fixed[i, j]:
        return value, x[i], z[j]
    first, nxt = i, (i + 1) % n
    while first > 0 and links[first - 1] != 0.0:
        first -= 1
    step, before, after = (x[first + 1] - x[first] if n > 1 else 1.0), P[i - 1, j], P[nxt, j]
    if abs(links[i - 1] - links[i]) <= 1e-9 * links[i]:
        rise_x, shift_x = _crest(before, value, after, step, step)
    if fixed[i - 1, j] or fixed[nxt, j]:
        rise_x = min(rise_x, 0.25 * (value - max(before, after)))
    if 0 < j < m - 1:
        before, after = P[i, j - 1], P[i, j + 1]
        rise_z, shift_z = _crest(before, value, after, z[j] - z[j - 1], z[j + 1] - z[j])
        if fixed[i, j - 1] or fixed[i, j + 1]:
            rise_z = min(rise_z, 0.25 * (value - max(before, after)))
    return value + rise_x + rise_z, x[i] + shift_x, z[j] + shift_z


@njit(cache=True)
def _crest(before, value, after, h0, h1):
    """Height above the middle one, and place from there, of the crest of a parabola through three points."""
    d0, d1 = (value - before) / h0, (after - value) / h1
    second, slope = (d1 - d0) / (h0 + h1), (d0 * h1 + d1 * h0) / (h0 + h1)
    return (-0.25 * slope * slope / second, -0.5 * slope / second) if second < 0.0 else (0.0, 0.0)


@njit(cache=True)
def wrench_gradient(ds, dc, extra, ends, pose, sums, pose_scale, R, force, shear, omega, w, couette, out):
    """d wrench / d motion (6, 10) in SI units from the gradients of the integrals of `exudyn_ehd.film.loads`.

    Parameters
    ----------
    ds, dc, extra : (4, 10), (10,), (2, 10) arrays
        Gradients of (S_c, S_s, S_zc, S_zs), of C, and of the integrals over the slopes of gap terms, to (scaled pose,
        scaled rates, vx, vz).
    ends : (2, 4) array
        Gradients of the pressure force of the ends, and of an arc's edges, to the scaled pose.
    pose, sums, pose_scale : (4,) arrays
        Scaled pose, the four integrals, scale of the pose.
    R, force, shear, omega, w, couette : float
        Radius, scales of force and shear, spin, axial speed, C.
    """
    x, y, bx, by = pose[0], pose[1], pose[2], pose[3]
    for q in range(10):
        theta = x * ds[1, q] - y * ds[0, q] + bx * ds[3, q] - by * ds[2, q] - extra[0, q]
        z = -(bx * ds[0, q] + by * ds[1, q]) - extra[1, q]
        if q == 0:
            theta += sums[1]
        elif q == 1:
            theta -= sums[0]
        elif q == 2:
            theta += sums[3]
            z -= sums[0]
        elif q == 3:
            theta -= sums[2]
            z -= sums[1]
        out[0, q] = -force * ds[0, q]
        out[1, q] = -force * ds[1, q]
        out[2, q] = -shear * (6.0 * R * z + w * dc[q])
        out[3, q] = force * R * ds[3, q]
        out[4, q] = -force * R * ds[2, q]
        out[5, q] = -shear * R * R * (6.0 * theta + omega * dc[q])
        if q < 4:
            out[2, q] += 6.0 * shear * R * ends[0, q]
            out[5, q] -= 6.0 * shear * R * R * ends[1, q]
        scale = 0.5
        if q < 8:
            scale = pose_scale[q % 4]
        elif q == 9:
            scale = 0.5 / R
        for r in range(6):
            out[r, q] *= scale
    out[2, 9] -= shear * couette
    out[5, 8] -= shear * R * R * couette


@njit(cache=True)
def integral_weights(pose, R, force, shear, omega, w, out):
    """Weights (6, 8) of (S_c, S_s, S_zc, S_zs, C, slopes in theta and z, ends' force) in the wrench.

    Symbols as in `wrench_gradient`.
    """
    x, y, bx, by = pose[0], pose[1], pose[2], pose[3]
    out[:] = 0.0
    out[0, 0] = out[1, 1] = -force
    out[3, 3], out[4, 2] = force * R, -force * R
    axial, turning = -6.0 * shear * R, -6.0 * shear * R * R
    out[2, 0], out[2, 1], out[2, 4], out[2, 6], out[2, 7] = -axial * bx, -axial * by, -shear * w, -axial, -axial
    out[5, 0], out[5, 1], out[5, 2], out[5, 3] = -turning * y, turning * x, -turning * by, turning * bx
    out[5, 4], out[5, 5] = -shear * R * R * omega, -turning


@njit(cache=True, fastmath=FAST)
def shear_fields(P, weight, width, z, couette, ends, factors, out):
    """Combinations (2, n, m) of the fields that shear owes to an elastic gap.

    Parameters
    ----------
    P, weight : (n, m) arrays
        Pressure and integration weights: slopes of the gap act on their product.
    couette, ends : (n, m) arrays
        Gradients of the Couette shear and of the ends' pressure force to the gap.
    factors : (2, 4) array
        Of couette, slopes in theta, slopes in z, ends.
    """
    n, m = P.shape
    along_x, along_z = np.empty((n, m)), np.empty((n, m))
    transposed_slopes(P * weight, width, z, along_x, along_z)
    for r in range(2):
        a, b, c, d = factors[r, 0], factors[r, 1], factors[r, 2], factors[r, 3]
        for i in range(n):
            for j in range(m):
                out[r, i, j] = a * couette[i, j] + b * along_x[i, j] + c * along_z[i, j] + d * ends[i, j]
