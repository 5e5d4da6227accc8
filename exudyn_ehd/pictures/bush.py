"""Contour pictures of a deformed bush with matplotlib; no display needed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from exudyn_ehd.pictures.bearing3d import look_at, quads_of
from exudyn_ehd.pictures.style import new_figure, style_ticks, styled, write
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
            axes.set_proj_type("ortho")
            axes.set_title(frame.title, y=1.0)
            plots.append(axes)
        bar = matplotlib.cm.ScalarMappable(norm=norm, cmap=colours)
        style_ticks(figure.colorbar(bar, ax=plots, label=label, shrink=0.8, pad=0.02).ax)
        write(figure, None)
    return figure


def _box(mesh: BushMesh, frames: Sequence[Frame]) -> np.ndarray:
    points = np.concatenate([mesh.nodes] + [mesh.nodes + frame.displacements for frame in frames])[:, ORDER]
    return np.stack([points.min(axis=0), points.max(axis=0)], axis=1)


def _draw(axes: Axes3D, mesh: BushMesh, frame: Frame, norm: Normalize, colours: Colormap) -> None:
    """Draw the faces of a deformed mesh: facets in the colours of the field, and their outlines."""
    kind, faces = face_of(mesh.boundary), (mesh.nodes + frame.displacements)[:, ORDER][mesh.boundary]
    facets, values = _facets(kind, faces, frame.values[mesh.boundary])
    # closed polylines through the corners and mid-edge nodes, towards the viewer so that no facet of their own face
    # hides them
    elevation, azimuth = np.radians([ELEVATION, AZIMUTH])
    camera = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    depth = faces @ camera
    outlines = faces[:, kind.outline] + np.multiply.outer(depth.max(axis=1) - depth.mean(axis=1), camera)[:, None]
    corners = faces[:, : kind.corners]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    outlines = outlines[normals @ camera > 0.0]
    # one collection, which matplotlib sorts by depth, and with as many corners each, since it pads shorter polygons
    # with whatever the memory holds
    facets = np.concatenate([facets, np.repeat(facets[:, -1:], outlines.shape[1] - 4, axis=1)], axis=1)
    fills = np.concatenate([colours(norm(values)), np.zeros((len(outlines), 4))])
    edges = np.concatenate([fills[: len(facets)], np.tile([0.0, 0.0, 0.0, 1.0], (len(outlines), 1))])
    polygons = np.concatenate([facets, outlines])
    axes.add_collection3d(Poly3DCollection(polygons, facecolors=fills, edgecolors=edges, linewidths=0.3))


def _facets(kind: Face, corners: np.ndarray, nodal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Flat quadrilaterals (m, 4, 3) and their mean values (m,) of faces (f, a, 3)."""
    ticks = np.linspace(-1, 1, FACETS + 1)
    r, s = np.meshgrid(ticks, ticks, indexing="ij")
    shapes, _ = kind.shapes(kind.from_square(np.stack([r.ravel(), s.ravel()], axis=1)))
    points = np.einsum("pa,fai->fpi", shapes, corners)
    fields = np.einsum("pa,fa->fp", shapes, nodal)
    grids = (-1, FACETS + 1, FACETS + 1)
    return quads_of(points.reshape(*grids, 3)), quads_of(fields.reshape(*grids, 1)).mean(axis=1).ravel()
