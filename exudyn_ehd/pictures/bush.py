"""Contour pictures of a deformed bush with matplotlib; no display needed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from exudyn_ehd.pictures.bearing3d import look_at, quads_of
from exudyn_ehd.pictures.style import new_figure, style_ticks, styled
from exudyn_ehd.solid.elements.faces import Face, face_of
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.status import InputError

# Coordinates along the picture's first, second and vertical axis: y is upright.
ORDER = [2, 0, 1]
# Camera angles, degrees.
ELEVATION, AZIMUTH = 18.0, 25.0
# Flat quadrilaterals along each side of an element's face.
FACETS = 3
# Type of a figure of several panels, pt.
TYPE_SIZE = 10.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """One deformed shape with a field on its nodes.

    Parameters
    ----------
    title : str
    displacements : ndarray, shape (n, 3)
        [m]
    values : ndarray, shape (n,)
        Field at the nodes, in the unit named in the colour bar's label.
    """

    title: str
    displacements: np.ndarray
    values: np.ndarray


def contour_figure(mesh: BushMesh, frames: Sequence[Frame], *, label: str) -> Figure:
    """Return a figure of deformed shapes side by side with one colour scale.

    Parameters
    ----------
    mesh : BushMesh
    frames : sequence of Frame
    label : str
        Label of the colour bar, with unit.
    """
    if len(frames) == 0:
        raise InputError("contour_figure frames must hold at least one Frame, got none; pass what is to be drawn.")
    columns = min(3, int(np.ceil(np.sqrt(len(frames)))))
    rows = -(-len(frames) // columns)
    low = min(float(np.min(frame.values)) for frame in frames)
    high = max(float(np.max(frame.values)) for frame in frames)
    norm = Normalize(low, high if high > low else low + 1.0)
    colours = matplotlib.colormaps["viridis"]
    box = _box(mesh, frames)
    plots = []
    with styled(TYPE_SIZE):
        figure = new_figure((3.4 * columns + 1.0, 3.3 * rows))
        for i, frame in enumerate(frames):
            axes = figure.add_subplot(rows, columns, i + 1, projection="3d", computed_zorder=False)
            _draw(axes, mesh, frame, norm, colours)
            look_at(axes, box, (ELEVATION, AZIMUTH), zoom=1.1)
            axes.set_title(frame.title, y=1.0)
            plots.append(axes)
        bar = matplotlib.cm.ScalarMappable(norm=norm, cmap=colours)
        style_ticks(figure.colorbar(bar, ax=plots, label=label, shrink=0.8, pad=0.02).ax)
    return figure


def _box(mesh: BushMesh, frames: Sequence[Frame]) -> np.ndarray:
    points = np.concatenate([mesh.nodes] + [mesh.nodes + frame.displacements for frame in frames])[:, ORDER]
    return np.stack([points.min(axis=0), points.max(axis=0)], axis=1)


def _draw(axes, mesh: BushMesh, frame: Frame, norm: Normalize, colours) -> None:
    positions = (mesh.nodes + frame.displacements)[:, ORDER]
    kind, faces = face_of(mesh.boundary), positions[mesh.boundary]
    polygons, values = _facets(kind, faces, frame.values[mesh.boundary])
    # closed polylines through the corners and mid-edge nodes
    outlines = faces[:, kind.outline]
    elevation, azimuth = np.radians([ELEVATION, AZIMUTH])
    camera = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    normals = _normals(polygons)
    # facets seen edge-on stay in: without them slits open along curved edges
    toward = normals @ camera > -0.1 * np.linalg.norm(normals, axis=1)
    polygons, values = polygons[toward], values[toward]
    # painter's order: far facets first
    nearness = np.argsort(polygons.mean(axis=1) @ camera)
    face_colours = colours(norm(values[nearness]))
    axes.add_collection3d(
        Poly3DCollection(polygons[nearness], facecolors=face_colours, edgecolors=face_colours, linewidths=0.3, zorder=1)
    )
    corners = faces[:, : kind.corners]
    visible = (_normals(corners) @ camera > 0) & _unhidden(corners, camera)
    axes.add_collection3d(Line3DCollection(outlines[visible], colors="k", linewidths=0.25, zorder=2))


def _facets(kind: Face, corners: np.ndarray, nodal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Flat quadrilaterals (m, 4, 3) and their mean values (m,) of faces (f, a, 3)."""
    ticks = np.linspace(-1, 1, FACETS + 1)
    r, s = np.meshgrid(ticks, ticks, indexing="ij")
    shapes, _ = kind.shapes(kind.from_square(np.stack([r.ravel(), s.ravel()], axis=1)))
    points = np.einsum("pa,fai->fpi", shapes, corners)
    fields = np.einsum("pa,fa->fp", shapes, nodal)
    grids = (-1, FACETS + 1, FACETS + 1)
    return quads_of(points.reshape(*grids, 3)), quads_of(fields.reshape(*grids, 1)).mean(axis=1).ravel()


def _normals(polygons: np.ndarray) -> np.ndarray:
    """Normals of quadrilaterals (m, 4, 3) or triangles (m, 3, 3)."""
    return np.cross(polygons[:, 2] - polygons[:, 0], polygons[:, -1] - polygons[:, 1])


def _unhidden(quads: np.ndarray, camera: np.ndarray) -> np.ndarray:
    """Faces whose centre no other face covers, seen along the camera direction."""
    side = np.cross(camera, np.eye(3)[int(np.argmin(np.abs(camera)))])
    side /= np.linalg.norm(side)
    plane = np.stack([side, np.cross(camera, side)], axis=1)
    flat, depth = quads @ plane, quads.mean(axis=1) @ camera
    centre = flat.mean(axis=1)
    hidden = np.zeros(len(quads), dtype=bool)
    extent = np.linalg.norm(np.ptp(flat, axis=1), axis=1).max()
    size = np.linalg.norm(quads[:, 2] - quads[:, 0], axis=1).max()
    for k in range(len(quads)):
        near = np.flatnonzero((np.abs(centre - centre[k]).max(axis=1) < extent) & (depth > depth[k] + 0.5 * size))
        corner = flat[near] - centre[k]
        following = np.roll(corner, -1, axis=1)
        turn = corner[..., 0] * following[..., 1] - corner[..., 1] * following[..., 0]
        hidden[k] = bool(((turn > 0).all(axis=1) | (turn < 0).all(axis=1)).any())
    return ~hidden
