"""Meshes of a bearing bush: hollow cylinders of 20-node hexahedra, surfaces and lines of any mesh.

Bush frame: origin on the bearing axis, z = axis; theta counts from x about z. A structured mesh spans
z = -length/2 to length/2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.solid.elements.element import Element
from exudyn_ehd.solid.elements.kinds import HEX_NODES, boundary_faces, element_of
from exudyn_ehd.solid.unrolled import Surface, patch, wrapped
from exudyn_ehd.status import (
    POSITIVE,
    ROUNDING,
    SMALL,
    Checked,
    InputError,
    require_integer,
    require_number,
    require_vector,
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """A chain of quadratic element edges.

    Parameters
    ----------
    nodes : ndarray of int, shape (k,)
        Mesh nodes on the line, each once.
    edges : ndarray of int, shape (m, 3)
        Mesh nodes of each edge: corner, corner, mid-edge.
    """

    nodes: np.ndarray
    edges: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class BushMesh:
    """A mesh of 20-node hexahedra or of 10-node tetrahedra, with the surfaces that a bearing needs.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Undeformed positions [m], bush frame: z = bush axis, z = 0 on the bearing's mid-plane.
    elements : ndarray of int, shape (m, a)
        Node numbers from 0, a = 20 in the order of the Abaqus element C3D20, a = 10 in that of C3D10.
    bore, outer, end_low, end_high : Surface
        Inner cylinder, outer surface, and the end faces at the smallest and largest z.

    Examples
    --------
    After the example of `HollowCylinder`:

    >>> bush = mesh.mesh()
    >>> bush.nodes.shape, bush.bore.nodes.shape
    ((304, 3), (128,))
    """

    nodes: np.ndarray
    elements: np.ndarray
    bore: Surface
    outer: Surface
    end_low: Surface
    end_high: Surface

    @property
    def element(self) -> Element:
        """Kind of the elements: 20-node hexahedra or 10-node tetrahedra."""
        return element_of(self.elements)

    @cached_property
    def boundary(self) -> np.ndarray:
        """All faces that belong to one element only, shape (f, a), mesh nodes."""
        return boundary_faces(self.elements)

    @cached_property
    def sample_gradients(self) -> np.ndarray:
        """Gradients dN_a/dX (m, q, a, 3) [1/m] at the points of the elements at which stresses are most accurate."""
        return self.element.reference_gradients(self.nodes[self.elements], self.element.sampling)[0]

    def surface(self, nodes: np.ndarray) -> Surface:
        """Return the boundary faces all of whose nodes are in ``nodes`` (mesh node numbers)."""
        return surface_of(self.nodes, self.boundary, np.isin(np.arange(len(self.nodes)), nodes))

    def line(self, nodes: np.ndarray) -> Line:
        """Return the element edges all of whose nodes are in ``nodes`` (mesh node numbers)."""
        edges = self.elements[:, self.element.edges].reshape(-1, 3)
        edges[:, :2] = np.sort(edges[:, :2])
        edges = np.unique(edges, axis=0)
        edges = edges[np.isin(edges, nodes).all(axis=1)]
        if len(edges) == 0:
            raise InputError(
                f"BushMesh.line: the {len(np.atleast_1d(nodes))} nodes given must contain at least one whole element "
                "edge (two corners and the node between them), got none; take them from BushMesh.generatrix or from "
                "one grid line of the mesh."
            )
        return Line(nodes=np.unique(edges), edges=edges)

    def generatrix(self, surface: Surface, theta: float) -> Line:
        """Return the straight line at angle ``theta`` [rad] on the bore or on the outer surface.

        Raises
        ------
        InputError
            No grid line runs at this angle.
        """
        theta = require_number("BushMesh.generatrix theta", theta, "rad")
        gap = np.abs(wrapped(surface.theta - theta))
        near = surface.nodes[gap < SMALL]
        if len(near) == 0:
            raise InputError(
                f"BushMesh.generatrix theta must be the angle of a grid line, got {theta:g} rad; the nearest one is "
                f"{surface.theta[int(np.argmin(gap))]:g} rad: take that one or change the circumferential count."
            )
        return self.line(near)


def surface_of(nodes: np.ndarray, boundary: np.ndarray, member: np.ndarray) -> Surface:
    """Patch of the faces ``boundary`` (f, a) all of whose nodes are flagged by ``member`` (n,)."""
    return patch(nodes, boundary[member[boundary].all(axis=1)])


@dataclass(frozen=True, kw_only=True)
class HollowCylinder(Checked):
    """Mesh of a hollow cylinder: its dimensions and its numbers of elements.

    Parameters
    ----------
    inner_radius, thickness, length : float
        Radius of the bore, thickness of the wall, length along z [m]; the mesh reaches from z = -length/2 to length/2.
    axial, radial, circumferential : int, default 4, 2, 40
        Numbers of elements. With one radial layer the bore is 2 % too stiff under a pressure cos(4 theta); with three
        layers and 40 elements around the error is 1 % up to cos(5 theta).

    Examples
    --------
    >>> mesh = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.06, axial=2, radial=1, circumferential=16)
    >>> round(mesh.outer_radius, 3), mesh.mesh().elements.shape
    (0.04, (32, 20))
    """

    inner_radius: float
    thickness: float
    length: float
    axial: int = 4
    radial: int = 2
    circumferential: int = 40

    checks: ClassVar = {
        **dict.fromkeys(("inner_radius", "thickness", "length"), POSITIVE),
        **dict.fromkeys(("axial", "radial"), partial(require_integer, at_least=1)),
        "circumferential": partial(require_integer, at_least=3),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("HollowCylinder: its elements", self.axial * self.radial * self.circumferential, at_most=1e5)

    @property
    def outer_radius(self) -> float:
        """Inner radius plus thickness [m]."""
        return self.inner_radius + self.thickness

    def mesh(self) -> BushMesh:
        """Return the mesh; xi runs along r, eta along theta, zeta along z; all mid-edge nodes lie on the cylinders."""
        counts = np.array([self.radial, self.circumferential, self.axial])
        corner = np.stack(np.meshgrid(*(np.arange(c) for c in counts), indexing="ij"), axis=-1).reshape(-1, 1, 3)
        grid = 2 * corner + (HEX_NODES + 1).astype(int)
        grid[..., 1] %= 2 * self.circumferential
        shape = (2 * self.circumferential, 2 * self.axial + 1, 2 * self.radial + 1)
        key = np.ravel_multi_index((grid[..., 1], grid[..., 2], grid[..., 0]), shape)
        used, elements = np.unique(key, return_inverse=True)
        elements = elements.reshape(-1, 20)
        j, k, i = np.unravel_index(used, shape)
        radius = self.inner_radius + self.thickness * i / (2 * self.radial)
        theta = np.pi * j / self.circumferential
        z = self.length * (k / (2 * self.axial) - 0.5)
        nodes = np.stack([radius * np.cos(theta), radius * np.sin(theta), z], axis=1)
        boundary = boundary_faces(elements)
        members = (i == 0, i == 2 * self.radial, k == 0, k == 2 * self.axial)
        bore, outer, end_low, end_high = (surface_of(nodes, boundary, member) for member in members)
        return BushMesh(nodes=nodes, elements=elements, bore=bore, outer=outer, end_low=end_low, end_high=end_high)


def require_frame(where: str, axis: Sequence[float]) -> np.ndarray:
    """Columns x, y and z = axis; x is the user's x (else y) projected normal to it.

    Raises
    ------
    InputError
        For an axis without a direction.
    """
    z = require_vector(where, axis, 3)
    if not np.any(z):
        raise InputError(f"{where} must be a direction, got a zero vector; use (0, 0, 1) for z.")
    z = z / np.linalg.norm(z)
    return frame_of(z, np.eye(3)[0 if abs(z[0]) < 1.0 - ROUNDING else 1])


def frame_of(z: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Columns x, y and z, a unit vector; x is ``towards`` projected normal to z."""
    x = towards - z * (z @ towards)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
