"""Independent film on an arc: finite differences on a uniform grid with the gap's cube on the links, rupture by sets.

It shares no code with the package: Reynolds' equation in SI units, ``h^3 / (12 mu)`` at half intervals, trapezoidal
sums, and the condition of Swift and Stieber by vertices that enter and leave the film until none does.
"""

import math

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve


def arc_film(
    motion, *, radius, length, clearance, viscosity, start, extent, edges=(0.0, 0.0), preload=0.0, offset=0.5,
    dam=None, shape=(201, 61),
):  # fmt: skip
    """Force (2,), torque about the journal's own axis and peak pressure for a motion (10,) as in the package.

    ``clearance`` is the assembled one: the arc has the radius ``radius + clearance / (1 - preload)`` about a displaced
    centre, from which the distance to the surface of the journal is taken. ``dam``: depth, length and extent from the
    leading edge of a recess with its edges on grid lines; vertices on its sides are shared by recess and land.
    """
    x, y, bx, by, x_t, y_t, bx_t, by_t, spin, _ = motion
    n, m = shape
    theta, z = start + np.linspace(0.0, extent, n), np.linspace(-length / 2, length / 2, m)
    step, dz = theta[1] - theta[0], z[1] - z[0]
    T, Z = np.meshgrid(theta, z, indexing="ij")

    machined, nearest = clearance / (1.0 - preload), start + offset * extent
    away = preload * machined * np.array([math.cos(nearest), math.sin(nearest)])

    def gap(t, s):
        h = machined - (x + away[0] + bx * s) * np.cos(t) - (y + away[1] + by * s) * np.sin(t)
        if dam is not None:
            depth, wide, long = dam
            inside = (0.5 * wide - np.abs(s)) / dz
            h = h + depth * np.clip((long - t + start) / step + 0.5, 0.0, 1.0) * np.clip(inside + 0.5, 0.0, 1.0)
        return h

    rate = -(x_t + bx_t * Z) * np.cos(T) - (y_t + by_t * Z) * np.sin(T)
    I, J = (index.ravel() for index in np.meshgrid(np.arange(1, n - 1), np.arange(1, m - 1), indexing="ij"))
    number = np.full(shape, -1)
    number[1:-1, 1:-1] = np.arange(I.size).reshape(n - 2, m - 2)
    P = np.zeros(shape)
    P[0], P[-1] = edges
    P[:, 0] = P[:, -1] = 0.0
    along, U = radius * step, spin * radius
    rows, columns, values = [np.arange(I.size)], [np.arange(I.size)], []
    b = -0.5 * U * (gap(theta[I] + step / 2, z[J]) - gap(theta[I] - step / 2, z[J])) / along - rate[I, J]
    total = np.zeros(I.size)
    for di, dj, width in ((1, 0, along), (-1, 0, along), (0, 1, dz), (0, -1, dz)):
        k = gap(theta[I] + 0.5 * di * step, z[J] + 0.5 * dj * dz) ** 3 / (12.0 * viscosity * width**2)
        near, total = number[I + di, J + dj], total + k
        inside = near >= 0
        rows.append(np.flatnonzero(inside))
        columns.append(near[inside])
        values.append(-k[inside])
        b[~inside] += k[~inside] * P[I[~inside] + di, J[~inside] + dj]
    A = coo_matrix((np.concatenate([total, *values]), (np.concatenate(rows), np.concatenate(columns)))).tocsr()
    full, p = np.ones(I.size, bool), np.zeros(I.size)
    for _ in range(100):
        p[:], at = 0.0, np.flatnonzero(full)
        p[at] = spsolve(A[at][:, at], b[at])
        now = np.where(full, p > 0.0, A @ p < b)
        if np.array_equal(now, full):
            break
        full = now
    else:
        raise RuntimeError("the sets go on changing")
    P[I, J] = p
    weight = np.outer(np.r_[0.5, np.ones(n - 2), 0.5], np.r_[0.5, np.ones(m - 2), 0.5]) * along * dz
    H = gap(T, Z)
    force = -np.array([(P * np.cos(T) * weight).sum(), (P * np.sin(T) * weight).sum()])
    shear = viscosity * U / H + 0.5 * H * np.gradient(P, along, axis=0)
    return force, -radius * (shear * weight).sum(), P.max()
