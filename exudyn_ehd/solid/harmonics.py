"""Finite elements of a cylinder, wave by wave around it.

A body of revolution answers to a load with n waves around by displacements with n waves,

    u_r = U(r, z) cos(n theta),   u_theta = V(r, z) sin(n theta),   u_z = W(r, z) cos(n theta),

and to sin by the same U, V, W a quarter of a wave further. Every n has a plane problem of its own, with the strains

    e_r = U_r,  e_t = (U + n V) / r,  e_z = W_z,  g_rz = U_z + W_r,  g_rt = V_r - (n U + V) / r,  g_zt = V_z - n W / r,

on a mesh of biquadratic elements, which are exact around the axis and of third order along r and z. At the axis of a
solid pin nothing is prescribed: what is not smooth there costs energy.

Source of the idea: E. L. Wilson, AIAA Journal 3 (1965) 2269.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import bmat, coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from exudyn_ehd.solid.total_lagrange import sparse_factor

# Gauss points and weights of an interval, and the quadratic shape functions (points, 3) there with their slopes.
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)


def _quadratic(s: np.ndarray) -> np.ndarray:
    return np.stack([0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)], axis=-1)


SHAPES = _quadratic(POINTS)
SLOPES = np.stack([POINTS - 0.5, -2.0 * POINTS, POINTS + 0.5], axis=-1)


def with_middles(edges: np.ndarray) -> np.ndarray:
    """Nodes (2 m + 1,) of quadratic elements between edges (m + 1,)."""
    nodes = np.empty(2 * edges.size - 1)
    nodes[::2], nodes[1::2] = edges, 0.5 * (edges[1:] + edges[:-1])
    return nodes


def interpolation(edges: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Values (p, 2 m + 1) at places z (p,) from those at the nodes of quadratic elements."""
    element = np.clip(np.searchsorted(edges, z, side="right") - 1, 0, edges.size - 2)
    out = np.zeros((z.size, 2 * edges.size - 1))
    local = 2.0 * (z - edges[element]) / np.diff(edges)[element] - 1.0
    np.put_along_axis(out, 2 * element[:, None] + np.arange(3), _quadratic(local), axis=1)
    return out


class Cylinder:
    """A solid or hollow cylinder, 2 pi around.

    Parameters
    ----------
    r, z : ndarray, shapes (m + 1,), (k + 1,)
        Edges of the elements, ascending [m].
    lame : (float, float)
        Constants of the material [Pa].

    Attributes
    ----------
    nodes_r, nodes_z : ndarray
        Nodes; unknowns are U, V, W node by node, z running faster than r.
    surface : ndarray of int
        Nodes on the outer cylinder.
    """

    def __init__(self, r: np.ndarray, z: np.ndarray, lame: tuple[float, float]) -> None:
        self.r, self.z, self.lame = r, z, lame
        self.nodes_r, self.nodes_z = with_middles(r), with_middles(z)
        count = self.nodes_z.size
        self.surface = (self.nodes_r.size - 1) * count + np.arange(count)
        i, j = (index.ravel() for index in np.meshgrid(np.arange(r.size - 1), np.arange(z.size - 1), indexing="ij"))
        a, b = (index.ravel() for index in np.meshgrid(np.arange(3), np.arange(3), indexing="ij"))
        self.nodes = (2 * i[:, None] + a) * count + 2 * j[:, None] + b
        half_r, half_z = 0.5 * np.diff(r)[i][:, None], 0.5 * np.diff(z)[j][:, None]
        self.values = SHAPES[a][:, a] * SHAPES[b][:, b]
        self.by_r = (SLOPES[a][:, a] * SHAPES[b][:, b]) / half_r[:, :, None]
        self.by_z = (SHAPES[a][:, a] * SLOPES[b][:, b]) / half_z[:, :, None]
        self.radius = r[i][:, None] + half_r * (1.0 + POINTS[a])
        self.volume = np.pi * WEIGHTS[a] * WEIGHTS[b] * half_r * half_z * self.radius

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return 3 * self.nodes_r.size * self.nodes_z.size

    def stiffness(self, n: int) -> csc_matrix:
        """Return the stiffness matrix for n waves around [N/m]."""
        elements, points = self.radius.shape
        lam, mu = self.lame
        B = np.zeros((elements, points, 6, 9, 3))
        over_r = self.values / self.radius[:, :, None]
        B[:, :, 0, :, 0] = B[:, :, 3, :, 2] = self.by_r
        B[:, :, 1, :, 0], B[:, :, 1, :, 1] = over_r, n * over_r
        B[:, :, 2, :, 2] = B[:, :, 3, :, 0] = B[:, :, 5, :, 1] = self.by_z
        B[:, :, 4, :, 0], B[:, :, 4, :, 1] = -n * over_r, self.by_r - over_r
        B[:, :, 5, :, 2] = -n * over_r
        D = np.diag([2.0 * mu] * 3 + [mu] * 3)
        D[:3, :3] += lam
        strains = B.reshape(elements, points, 6, 27)
        stress = self.volume[:, :, None, None] * (D @ strains)
        whole = elements, 6 * points, 27
        return self._assembled(strains.reshape(whole).transpose(0, 2, 1) @ stress.reshape(whole), n)

    def mass(self, n: int) -> csc_matrix:
        """Return the mass matrix for n waves around and unit density [m^3]."""
        same = np.einsum("eg,ga,gb->eab", self.volume, self.values, self.values)
        return self._assembled(np.einsum("eab,ij->eaibj", same, np.eye(3)).reshape(-1, 27, 27), n)

    def load(self, n: int, pressure: np.ndarray) -> np.ndarray:
        """Nodal forces (size, k) of pressures cos(n theta) times those at the surface's Gauss points (k, elements, 3).

        Outwards, the elements along z at `places`.
        """
        share = _around(n) * self.r[-1] * 0.5 * np.diff(self.z)[:, None] * WEIGHTS
        by_element = np.einsum("kjg,jg,ga->kja", pressure, share, SHAPES)
        out = np.zeros((self.size, len(pressure)))
        for a in range(3):
            np.add.at(out, 3 * self.surface[a : a + by_element.shape[1] * 2 : 2], by_element[:, :, a].T)
        return out

    @property
    def places(self) -> np.ndarray:
        """Gauss points (elements, 3) along z [m]."""
        return self.z[:-1, None] + 0.5 * np.diff(self.z)[:, None] * (1.0 + POINTS)

    def rigid(self, n: int) -> np.ndarray:
        """Rigid motions (size, k) with n waves around: along the axis, across it and about the other cross axis."""
        r, z = (x.ravel() for x in np.meshgrid(self.nodes_r, self.nodes_z, indexing="ij"))
        one, none = np.ones_like(r), np.zeros_like(r)
        motions = {0: [(none, none, one)], 1: [(one, -one, none), (z, -z, -r)]}.get(n, [])
        return np.array([np.stack(motion, axis=1).ravel() for motion in motions]).reshape(-1, self.size).T

    def solve(self, n: int, loads: np.ndarray, held: np.ndarray | None) -> np.ndarray:
        """Displacements (size, k) under loads with n waves around.

        ``held`` (nodes,) of bool; None: free, its mean motion taken off as in `exudyn_ehd.solid.journal`.
        """
        K, u = self.stiffness(n), np.zeros_like(loads)
        free = np.ones(self.size, dtype=bool) if held is None else np.repeat(~held, 3)
        if n == 0:
            free[1::3] = False  # torsion, which no pressure makes
        K = K[free][:, free]
        if held is not None or n > 1:
            u[free] = sparse_factor(K).solve(loads[free])
            return u
        momentum = csc_matrix((self.mass(n) @ self.rigid(n))[free]) * (self.lame[1] / self.r[-1] ** 2)
        whole = splu(bmat([[K, momentum], [momentum.T, None]], format="csc"))
        lines = momentum.shape[1]
        u[free] = whole.solve(np.concatenate((loads[free], np.zeros((lines, loads.shape[1])))))[:-lines]
        return u

    def _assembled(self, matrices: np.ndarray, n: int) -> csc_matrix:
        places = (3 * self.nodes[:, :, None] + np.arange(3)).reshape(-1, 27)
        at = np.repeat(places, 27, axis=1).ravel(), np.tile(places, (1, 27)).ravel()
        values = _around(n) / np.pi * matrices.ravel()
        return coo_matrix((values, at), shape=(self.size, self.size)).tocsc()


def _around(n: int) -> float:
    """Integral of cos(n theta)^2."""
    return np.pi if n else 2.0 * np.pi
