"""Surface under the film of a finite-element body: nodes and faces of its bore, and their shape functions, unrolled.

Faces are those of hexahedra, or triangles of three or six nodes.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from scipy.sparse import spmatrix

from exudyn_ehd.solid.elements.kinds import boundary_faces
from exudyn_ehd.solid.unrolled import Surface, patch
from exudyn_ehd.status import InputError

# Largest angle between neighbouring nodes of a bore, rad.
LARGEST_SPACING = 0.6
# Spread of the radii of nodes on one surface, over the radius: facets.
SURFACE = 5e-3
# Largest distance of a film's end beyond the outermost nodes, over the length: round-off.
BEYOND_END = 1e-6
# Largest distance of a point beyond a face, in natural coordinates: facets, and films as long as the bore.
OUTSIDE = 0.02


class BodyMesh(Protocol):
    """Attributes of a body's ``FEMinterface`` that are read and written."""

    nodes: dict[str, np.ndarray]
    elements: list[dict[str, np.ndarray]]
    surface: list
    modeBasis: dict[str, Any]
    stiffnessMatrix: spmatrix
    massMatrix: spmatrix

    def VolumeToSurfaceElements(self) -> None:
        """Find the triangles of the surface."""

    def GetSurfaceTriangles(self) -> list:
        """Triangles of three nodes."""

    def GetSurfaceTriangles6(self) -> list:
        """Triangles of six nodes."""


def surface_faces(fem: BodyMesh) -> np.ndarray:
    """Boundary faces (f, a) of a ``FEMinterface``, mesh node numbers, counter-clockwise from outside.

    20-node hexahedra give their 8-node faces; any other mesh the triangles of ``VolumeToSurfaceElements``, which is
    called if there are none: six-node ones for 10-node tetrahedra.

    Raises
    ------
    InputError
        If there are no elements to find faces of.
    """
    blocks = [np.asarray(block["Hex20"], dtype=int) for block in fem.elements if len(block.get("Hex20", ()))]
    if blocks:
        return boundary_faces(np.concatenate(blocks))
    if not fem.surface and fem.elements:
        fem.VolumeToSurfaceElements()
    triangles = fem.GetSurfaceTriangles6() or fem.GetSurfaceTriangles()
    if len(triangles) == 0:
        raise InputError(
            "FEBore.fem has neither elements nor surface triangles: import the mesh with its elements (fem.elements), "
            "which tell how the nodes share the pressure."
        )
    return np.asarray(triangles, dtype=int)


def bore_faces(where: str, fem: BodyMesh, positions: np.ndarray, chosen: np.ndarray) -> Surface:
    """Faces of a mesh all of whose nodes are among ``chosen``.

    Parameters
    ----------
    where : str
        For messages.
    fem : FEMinterface
    positions : ndarray, shape (n, 3)
        All nodes, bore frame [m].
    chosen : ndarray of int
        Mesh nodes on the bore.
    """
    faces = surface_faces(fem)
    faces = faces[np.isin(faces, chosen).all(axis=1)]
    if len(faces) == 0:
        raise InputError(
            f"{where}: none of the mesh's surface faces has all of its nodes among the {len(chosen)} on the bore; "
            "check radius_tolerance, and that the FEMinterface is the body's own."
        )
    return replace(patch(positions, faces), tolerance=OUTSIDE)


def find_bore(
    where: str,
    positions: np.ndarray,
    radius: float,
    length: float,
    tolerance: float,
    nodes: tuple[int, ...] | None = None,
    outer: bool = False,
) -> np.ndarray:
    """Numbers of the nodes on a bore, or on the cylinder of a journal.

    Parameters
    ----------
    where : str
        For messages.
    positions : ndarray, shape (n, 3)
        All nodes in the joint's frame [m].
    radius, length : float
        Radius and length of the film's area [m].
    tolerance : float
        On a node's radius, over the radius.
    nodes : sequence of int, optional
        Nodes to search; by default all.
    outer : bool
        True for a journal, whose surface is farthest from its axis.

    Raises
    ------
    InputError
        Too few nodes, or nodes that leave part of the film without support.
    """
    r = np.hypot(positions[:, 0], positions[:, 1])
    if nodes is None:
        # a little beyond the film: other bores on the same axis don't count
        member = (np.abs(r - radius) <= tolerance * radius) & (np.abs(positions[:, 2]) <= 0.75 * length)
        if member.any():
            # a bore's surface is what is nearest to its axis; the next layer of a fine mesh may be within the tolerance
            member &= r >= r[member].max() - SURFACE * radius if outer else r <= r[member].min() + SURFACE * radius
        chosen = np.flatnonzero(member)
    else:
        chosen = np.array(nodes, dtype=int)
        if chosen.size and (chosen.min() < 0 or chosen.max() >= len(r)):
            raise InputError(
                f"{where}: nodes must be mesh nodes 0 to {len(r) - 1}, got {chosen.min()} to {chosen.max()}."
            )
    if chosen.size < 12:
        nearest = np.sort(np.abs(r - radius))[:12].max() / radius if len(r) >= 12 else np.inf
        raise InputError(
            f"{where}: {chosen.size} nodes lie on the bore of radius {radius:g} m within {tolerance:g} of it and "
            f"{0.75 * length:g} m of the mid-plane, at least 12 are needed; the twelve nearest are within "
            f"{nearest:.2g}. Check position, axis, journal radius and units, or raise radius_tolerance."
        )
    angle = np.sort(np.arctan2(positions[chosen, 1], positions[chosen, 0]))
    gap = np.diff(np.append(angle, angle[0] + 2.0 * np.pi)).max()
    if gap > LARGEST_SPACING:
        raise InputError(
            f"{where}: the nodes on the bore leave {gap:.3g} rad of it without any, at most {LARGEST_SPACING:g} rad "
            "are allowed; give a closed bore, or a finer mesh."
        )
    z = positions[chosen, 2]
    if max(z.min() + 0.5 * length, 0.5 * length - z.max()) > BEYOND_END * length:
        raise InputError(
            f"{where}: the bore's nodes must span the film, z = -{0.5 * length:g} to {0.5 * length:g} m about the "
            f"mid-plane, got {z.min():.6g} to {z.max():.6g} m; check position and bearing length."
        )
    return chosen
