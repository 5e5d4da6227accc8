"""Hollow cylinders of 10-node tetrahedra, and Abaqus input files of them."""

from itertools import permutations

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.solid.elements.element import TET_EDGES

# Corners of a hexahedron by their bits (radial, around, along).
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def six_tetrahedra():
    """Corner numbers (6, 4) of the tetrahedra about a hexahedron's diagonal 0-6, right-handed."""
    result = []
    for order in permutations(range(3)):
        path = [(0, 0, 0)]
        for axis in order:
            path.append(tuple(b + (i == axis) for i, b in enumerate(path[-1])))
        corners = [CORNERS.index(bits) for bits in path]
        if np.linalg.det(np.diff(np.array(path), axis=0)) < 0:
            corners[1], corners[2] = corners[2], corners[1]
        result.append(corners)
    return np.array(result)


def tetrahedra(cylinder, shift=0.0, straight=False):
    """Nodes (n, 3) and elements (m, 10): every hexahedron of a cylinder split into six.

    ``shift`` moves corners along theta and z by up to this part of an element, at random; with ``straight`` edges the
    mid nodes lie on chords, else on the cylinders.
    """
    mesh = cylinder.mesh()
    corners = mesh.elements[:, :8][:, six_tetrahedra()].reshape(-1, 4)
    used, corners = np.unique(corners, return_inverse=True)
    corners, nodes = corners.reshape(-1, 4), mesh.nodes[used]
    turn, push = shift * np.random.default_rng(5).uniform(-1, 1, (2, len(nodes)))
    angle = np.arctan2(nodes[:, 1], nodes[:, 0]) + turn * 2 * np.pi / cylinder.circumferential
    inner = np.abs(nodes[:, 2]) < 0.499 * cylinder.length
    r = np.hypot(nodes[:, 0], nodes[:, 1])
    z = nodes[:, 2] + inner * push * cylinder.length / cylinder.axial
    nodes = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    pairs, place = np.unique(np.sort(corners[:, TET_EDGES[:, :2]].reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    middle = nodes[pairs].mean(axis=1)
    if not straight:
        middle[:, :2] *= (r[pairs].mean(axis=1) / np.hypot(middle[:, 0], middle[:, 1]))[:, None]
    elements = np.concatenate([corners, len(nodes) + place.reshape(-1, 6)], axis=1)
    return np.concatenate([nodes, middle]), elements


def tet_mesh(cylinder, shift=0.0, straight=False):
    """Bush mesh of the cylinder's tetrahedra."""
    nodes, elements = tetrahedra(cylinder, shift, straight)
    return ehd.mesh_from_arrays(nodes, elements, bore_radius=cylinder.inner_radius)
