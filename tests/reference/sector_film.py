"""Independent film on a sector pad: finite differences on a grid uniform in r and theta, rupture by sets.

It shares no code with the package. In SI units, with the gap h at half intervals,

    d/dr (r h^3 dp/dr) + d/dtheta (h^3 dp/dtheta) / r = 12 mu r (omega / 2 dh/dtheta + dh/dt),

p = 0 at all four edges, trapezoidal sums.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve


def sector_film(motion, *, inner, outer, first, extent, clearance, viscosity, crown=0.0, shape=(161, 81)):
    """Load, moments of the pressure about x and y on a collar above, its torque, peak pressure, and flows; (9,).

    The flows leave at the edges first in theta, last in theta, inner and outer, those of Couette flow in a full gap.
    ``motion``: zeta, bx, by, their rates, the spin; the collar's gap is clearance + zeta - bx x - by y + crown's share.
    """
    zeta, bx, by, zeta_t, bx_t, by_t, spin = motion
    n, m = shape
    theta, r = first + np.linspace(0.0, extent, n), np.linspace(inner, outer, m)
    dt, dr = theta[1] - theta[0], r[1] - r[0]
    T, R = np.meshgrid(theta, r, indexing="ij")

    def gap(t, s):
        depth = crown * (2.0 * (t - first) / extent - 1.0) ** 2
        return clearance + zeta - s * (bx * np.cos(t) + by * np.sin(t)) + depth

    rate = zeta_t - R * (bx_t * np.cos(T) + by_t * np.sin(T))
    I, J = (k.ravel() for k in np.meshgrid(np.arange(1, n - 1), np.arange(1, m - 1), indexing="ij"))
    number = np.full(shape, -1)
    number[1:-1, 1:-1] = np.arange(I.size).reshape(n - 2, m - 2)
    t, s = theta[I], r[J]
    b = -12.0 * viscosity * s * (0.5 * spin * (gap(t + dt / 2, s) - gap(t - dt / 2, s)) / dt + rate[I, J])
    rows, columns, values, total = [], [], [], np.zeros(I.size)
    for di, dj in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        half = s + 0.5 * dj * dr
        k = gap(t + 0.5 * di * dt, half) ** 3 * (half / dr**2 if dj else 1.0 / (s * dt**2))
        near = number[I + di, J + dj]
        inside, total = near >= 0, total + k
        rows.append(np.flatnonzero(inside))
        columns.append(near[inside])
        values.append(-k[inside])
    every = np.arange(I.size)
    A = coo_matrix(
        (np.concatenate([total, *values]), (np.concatenate([every, *rows]), np.concatenate([every, *columns])))
    )
    A, full, p = A.tocsr(), np.ones(I.size, bool), np.zeros(I.size)
    for _ in range(100):
        p[:], at = 0.0, np.flatnonzero(full)
        p[at] = spsolve(A[at][:, at].tocsc(), b[at])
        now = np.where(full, p > 0.0, A @ p < b)
        if np.array_equal(now, full):
            break
        full = now
    else:
        raise RuntimeError("the sets go on changing")
    P = np.zeros(shape)
    P[I, J] = p
    ends = [np.r_[0.5, np.ones(k - 2), 0.5] for k in shape]
    weight, H = np.outer(*ends) * R * dt * dr, gap(T, R)
    slope = R * (bx * np.sin(T) - by * np.cos(T))
    pull = viscosity * spin * R**2 / H + 0.5 * H * np.gradient(P, dt, axis=0) + P * slope
    X, Y = R * np.cos(T), R * np.sin(T)
    moved, (p_t, p_r) = 0.5 * spin * R * H, np.gradient(P, dt, dr, edge_order=2)
    along, across = moved - H**3 / (12.0 * viscosity * R) * p_t, -(H**3) / (12.0 * viscosity) * R * p_r
    over_radius, over_angle = dr * ends[1], dt * ends[0]
    flows = -along[0] @ over_radius, along[-1] @ over_radius, -over_angle @ across[:, 0], over_angle @ across[:, -1]
    sums = (P * part * weight for part in (1.0, Y, -X))
    return np.array([*(own.sum() for own in sums), -(pull * weight).sum(), P.max(), *flows])
