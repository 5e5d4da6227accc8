"""Modes that a bush on static modes lacks when it moves: vibrations of its mesh, and responses to body forces.

Static modes don't vibrate as the mesh does. Its lowest vibrations that pressure excites are added, less their part in
the span of the static modes.

In a frame with acceleration a, angular acceleration alpha and angular velocity Omega the material feels the body force

    -rho (a + alpha x X + Omega x (Omega x X)),

which is affine in X: twelve fields of it, three uniform ones, three of alpha, and six symmetric gradients that the
products of Omega's components span. The mesh's static responses to them, less their part in the span of the modes that
are there, are made orthogonal in energy; what displaces the bore by too little is left out. Then the modes' response to
any such body force at rest is the mesh's.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh

from exudyn_ehd.solid.linear.supernodal import sparse_factor
from exudyn_ehd.solid.total_lagrange import TotalLagrange

# Share of the energy below which what is left of a vibration or of a response is rounding.
DEPENDENT = 1e-9

# Vibrations of the mesh that are looked at, the lowest, and the least share of static modes in the energy of one that
# pressure excites.
VIBRATIONS = 40
EXCITED = 1e-6
# Vibrations this close to the highest one may belong to a pair that the count cuts.
SAME_FREQUENCY = 1e-4
# Of the algorithm: raise it with every change of what a file holds.
VIBRATION_FORMAT = 2
# What a file of vibrations depends on besides the bush.
VIBRATION_SETTINGS = (VIBRATION_FORMAT, VIBRATIONS, EXCITED, SAME_FREQUENCY, DEPENDENT)

# Displacement of the bore under a body force that modes left out may lack, over all of it, both in the root mean
# square.
SMALLEST_PART = 5e-3
# Displacement that counts at least as all of it, over the largest one under the twelve fields: torsion hardly moves the
# bore at all.
SMALLEST_RESPONSE = 0.1
# Of the algorithm: raise it with every change of what a file holds.
BODY_FORCE_FORMAT = 1
# What a file of modes for body forces depends on besides the bush.
BODY_FORCE_SETTINGS = (BODY_FORCE_FORMAT, SMALLEST_PART, SMALLEST_RESPONSE, DEPENDENT)


def held_stiffness(solid: TotalLagrange) -> tuple[np.ndarray, csc_matrix, SuperLU]:
    """Free coordinates (3 n,) with the outer surface held, their stiffness at rest, and its factor."""
    mesh = solid.mesh
    free = np.ones(3 * len(mesh.nodes), dtype=bool)
    free[(3 * mesh.outer.nodes[:, None] + np.arange(3)).ravel()] = False
    K = solid.tangent(np.zeros_like(mesh.nodes))[free][:, free].tocsc()
    return free, K, sparse_factor(K)


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
        ``displacements`` (r, n, 3) and ``stiffness`` (r,) of what the lowest vibrations add, orthogonal in energy to
        each other and to the static modes, the largest nodal displacement 1; ``mass`` (k + r, k + r) [kg] of all modes,
        consistent; ``moments`` (n, 4) of the shape functions, int rho N [kg] and int rho N X [kg m].
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
    peak = np.linalg.norm(added.reshape(len(added), free.size // 3, 3), axis=2).max(axis=1)
    added /= peak[:, None]
    whole = np.concatenate((u, added[:, free]))
    mass = whole @ (M @ whole.T)
    return {
        "displacements": added.reshape(len(added), free.size // 3, 3),
        "stiffness": energy[keep] / peak**2,
        "mass": 0.5 * (mass + mass.T),
        "moments": solid.scalar_mass @ np.column_stack((np.ones(len(solid.mesh.nodes)), solid.mesh.nodes)),
    }


def body_fields(tilted: bool) -> list[np.ndarray]:
    """Fields (3, 4) of body forces ``field @ (1, x, y, z)``: a group even in z and, if ``tilted``, one odd in z."""

    def gradient(*entries: tuple[int, int, float]) -> np.ndarray:
        field = np.zeros((3, 4))
        for row, column, value in entries:
            field[row, 1 + column] = value
        return field

    uniform = [np.outer(e, (1.0, 0.0, 0.0, 0.0)) for e in np.eye(3)]
    even = [
        *uniform[:2],
        *(gradient((0, 0, 1.0), (1, 1, s)) for s in (1.0, -1.0)),
        *(gradient((0, 1, 1.0), (1, 0, s)) for s in (1.0, -1.0)),
        gradient((2, 2, 1.0)),
    ]
    odd = [uniform[2], *(gradient((i, 2, 1.0), (2, i, s)) for i in (0, 1) for s in (1.0, -1.0))]
    return [np.array(even), np.array(odd)] if tilted else [np.array(even)]


def body_force_modes(
    solid: TotalLagrange, displacements: np.ndarray, stiffness: np.ndarray, tilted: bool
) -> dict[str, np.ndarray]:
    """What modes of a solid with held outer surface lack of its static responses to body forces.

    Parameters
    ----------
    solid : TotalLagrange
    displacements : ndarray, shape (k, n, 3)
        Nodal displacements of modes orthogonal in energy.
    stiffness : ndarray, shape (k,)
        Their stiffness [N/m].
    tilted : bool
        Also body forces whose response is odd in z on the bore.

    Returns
    -------
    dict
        ``displacements`` (b, n, 3) and ``stiffness`` (b,) of modes orthogonal in energy to each other and to the given
        ones, the largest nodal displacement 1; ``mass`` (b, k + b) [kg], consistent, their rows of the mass of all.
    """
    mesh = solid.mesh
    free, K, factor = held_stiffness(solid)
    groups = body_fields(tilted)
    affine = np.column_stack((np.ones(len(mesh.nodes)), mesh.nodes / np.abs(mesh.nodes).max()))
    known, energies = displacements.reshape(len(displacements), -1), stiffness
    responses = []
    for fields in groups:
        loads = np.concatenate([(solid.mass @ (affine @ field.T).ravel())[None] for field in fields])
        response = np.zeros_like(loads)
        response[:, free] = factor.solve(np.ascontiguousarray(loads[:, free].T)).T
        responses.append((loads, response, np.linalg.norm(mesh.bore.radial(response), axis=1)))
    largest = max(float(size.max()) for _, _, size in responses)
    for loads, response, size in responses:
        rest = response - (loads @ known.T / energies) @ known
        basis = _orthogonal(rest, rest[:, free] @ (K @ rest[:, free].T), np.einsum("ij,ij->i", loads, response))
        # turned so that each mode moves the bore in a shape of its own, which leaves them orthogonal in energy
        basis = np.linalg.svd(mesh.bore.radial(basis).T, full_matrices=False)[2] @ basis
        lacking = np.abs(loads @ basis.T) * np.linalg.norm(mesh.bore.radial(basis), axis=1)
        scale = np.maximum(size, SMALLEST_RESPONSE * largest)
        added = basis[(lacking / scale[:, None]).max(axis=0) > SMALLEST_PART]
        peak = np.linalg.norm(added.reshape(len(added), free.size // 3, 3), axis=2).max(axis=1)
        known = np.concatenate((known, added / peak[:, None]))
        energies = np.concatenate((energies, 1.0 / peak**2))
    k = len(displacements)
    mass = known[k:] @ (solid.mass @ known.T)
    mass[:, k:] = 0.5 * (mass[:, k:] + mass[:, k:].T)
    return {
        "displacements": known[k:].reshape(len(known) - k, len(mesh.nodes), 3),
        "stiffness": energies[k:],
        "mass": mass,
    }


def _orthogonal(vectors: np.ndarray, energy: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Combinations (r, 3 n) of unit energy, orthogonal in it, of vectors (m, 3 n); ``energy`` (m, m) is theirs.

    They are what is left of vectors with energies ``whole`` (m,).
    """
    size = np.sqrt(whole)
    values, turn = eigh(energy / np.outer(size, size))
    keep = values > DEPENDENT
    return (turn[:, keep] / np.sqrt(values[keep])).T @ (vectors / size[:, None])
