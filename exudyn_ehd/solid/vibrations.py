"""Modes that let a bush on static modes vibrate as its mesh does."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu

from exudyn_ehd.solid.total_lagrange import TotalLagrange

# Vibrations of the mesh that are looked at, the lowest, and the least share of static modes in the energy of one that pressure excites.
VIBRATIONS = 40
EXCITED = 1e-6
# Vibrations this close to the highest one may belong to a pair that the count cuts.
SAME_FREQUENCY = 1e-4
# Share of the energy below which what is left of a vibration is rounding.
DEPENDENT = 1e-9
# Of the algorithm: raise it with every change of what a file holds.
FORMAT = 2
# What a file of modes depends on besides the bush.
SETTINGS = (FORMAT, VIBRATIONS, EXCITED, SAME_FREQUENCY, DEPENDENT)


def held_stiffness(solid: TotalLagrange) -> tuple[np.ndarray, csc_matrix, SuperLU]:
    """Free coordinates (3 n,) with the outer surface held, their stiffness at rest, and its factor."""
    mesh = solid.mesh
    free = np.ones(3 * len(mesh.nodes), dtype=bool)
    free[(3 * mesh.outer.nodes[:, None] + np.arange(3)).ravel()] = False
    K = solid.tangent(np.zeros_like(mesh.nodes))[free][:, free].tocsc()
    return free, K, splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def vibration_modes(solid: TotalLagrange, static: np.ndarray, stiffness: np.ndarray) -> dict[str, np.ndarray]:
    """Vibrations of a solid with held outer surface that static modes don't span, and the mass of both.

    Parameters
    ----------
    solid : TotalLagrange
    static : ndarray, shape (k, n, 3)
        Nodal displacements of modes orthogonal in energy.
    stiffness : ndarray, shape (k,)
        Their stiffness [N/m].

    Returns
    -------
    dict
        ``displacements`` (r, n, 3) and ``stiffness`` (r,) of what the lowest vibrations add, orthogonal in energy to each other and
        to the static modes, the largest nodal displacement 1; ``mass`` (k + r, k + r) [kg] of all modes, consistent; ``moments`` (n, 4)
        of the shape functions, int rho N [kg] and int rho N X [kg m].
    """
    free, K, factor = held_stiffness(solid)
    M = solid.mass[free][:, free].tocsc()
    # room for all of a small mesh but one
    count = min(VIBRATIONS, K.shape[0] - 1)
    inverse = LinearOperator(K.shape, matvec=factor.solve, dtype=float)
    start = np.random.default_rng(0).standard_normal(K.shape[0])
    square, shapes = eigsh(K, k=count, M=M, sigma=0.0, OPinv=inverse, v0=start)
    u = static.reshape(len(static), -1)[:, free]
    part = (u @ (K @ shapes)) / stiffness[:, None]
    share = stiffness @ part**2 / square
    chosen = (share > EXCITED) & (square < square.max() * (1.0 - 2.0 * SAME_FREQUENCY))
    rest = (shapes[:, chosen] - u.T @ part[:, chosen]) / np.sqrt(square[chosen])
    energy, vectors = eigh(rest.T @ (K @ rest))
    keep = energy > DEPENDENT
    added = np.zeros((int(keep.sum()), free.size))
    added[:, free] = (rest @ vectors[:, keep]).T
    peak = np.linalg.norm(added.reshape(len(added), -1, 3), axis=2).max(axis=1)
    added /= peak[:, None]
    whole = np.concatenate((u, added[:, free]))
    mass = whole @ (M @ whole.T)
    return {
        "displacements": added.reshape(len(added), -1, 3),
        "stiffness": energy[keep] / peak**2,
        "mass": 0.5 * (mass + mass.T),
        "moments": solid.scalar_mass @ np.column_stack((np.ones(len(solid.mesh.nodes)), solid.mesh.nodes)),
    }
