"""Pictures in space with matplotlib, no display needed: a deformed bush with contours; pressure around the bore.

In the bore stands the journal. Clearance and pressure are far too small and too large to be drawn to scale next to the
radius: the clearance is shown as a fixed share of the radius, the peak pressure as a hill of fixed height.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.colors import Colormap, Normalize, to_rgba_array
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from exudyn_ehd.pictures.maps import PRESSURE, colour_limits, cylinder_points, resampled, span
from exudyn_ehd.pictures.records import FilmRecord, Target, label, unit_for
from exudyn_ehd.pictures.style import BLACK, VERMILION, WIDE, headed, new_figure, picture, style_ticks, styled, write
from exudyn_ehd.solid.elements.element import Face, face_of
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.status import InputError

# Clearance and height of the hill, as shares of the bore radius.
CLEARANCE, HILL = 0.22, 0.75


def plot_bearing(
    film: FilmRecord,
    *,
    camera: tuple[float, float] | None = None,
    title: str = "",
    ax: Axes3D | None = None,
    path: Target = None,
) -> Figure:
    """Draw the pressure as a coloured hill on the bore, the journal in it, and the load on the bush (arrow).

    Parameters
    ----------
    film : FilmRecord
    camera : (float, float), optional
        Elevation and azimuth, degrees, with y upright and x to the right at azimuth -90; by default the hill is in
        view.
    title : str
        Stands above the sizes, in a new figure.
    ax : matplotlib Axes3D, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure
    """
    unit = unit_for("pressure", film.pressure)
    norm = Normalize(*colour_limits(unit(film.pressure)))
    colours = matplotlib.colormaps[PRESSURE.colours]
    around, along = np.linspace(*span(film), 121), np.linspace(film.z[0], film.z[-1], 31)
    p = resampled(film, film.pressure, around, along)
    z = along / film.bearing.journal_radius
    hill = pressure_surface(around, z, p)
    journal = journal_surface(film, np.linspace(0.0, 2.0 * np.pi, 121), z)
    own = ax is None
    with picture(ax, WIDE, path, where="plot_bearing", projection="3d", computed_zorder=False) as (figure, ax):
        quads, values = quads_of(hill), quads_of(unit(p)[..., None])[..., 0].mean(axis=1)
        quads, values = quads[~np.isnan(values)], values[~np.isnan(values)]
        sides, caps = quads_of(journal), np.concatenate([_fan(journal[:-1, 0]), _fan(journal[:-1, -1])])
        # one collection, since matplotlib sorts facets by depth within a collection only; all of them with four
        # corners, since it pads shorter ones with whatever the memory holds, and scales the axes by it
        polygons = _turned(np.concatenate([quads, sides, caps]))
        greys = to_rgba_array(["0.74"] * len(sides) + ["0.84"] * len(caps))
        faces = np.concatenate([colours(norm(values)), greys])
        ax.add_collection3d(Poly3DCollection(polygons, facecolors=faces, edgecolors=faces, linewidths=0.2, zorder=1))
        ring = np.stack([np.cos(around), np.sin(around)], axis=1)
        ring[np.isnan(p[:, 0])] = np.nan
        for end, order in ((z[0], 0), (z[-1], 2)):
            ax.plot(*_turned(np.column_stack([ring, np.full(len(ring), end)])).T, color=BLACK, lw=0.6, zorder=order)
        peak = float(film.theta[int(np.argmax(film.pressure.max(axis=1)))])
        _draw_arrows(ax, film, z)
        reach = 1.0 + HILL
        box = np.array([[-reach, reach], [-z[-1], -z[0]], [-reach, reach]])
        look_at(ax, box, _camera(peak) if camera is None else camera, zoom=1.15)
        bar = matplotlib.cm.ScalarMappable(norm=norm, cmap=colours)
        style_ticks(figure.colorbar(bar, ax=ax, label=label("pressure", unit), shrink=0.7, pad=0.02).ax)
        if own:
            R, L = 1e3 * film.bearing.journal_radius, 1e3 * film.bearing.length
            sizes = f"R = {R:.4g} mm, L = {L:.4g} mm; clearance and pressure not to scale\narrow: load on the bush"
            ax.set_title(headed(title, sizes), y=0.98)
    return figure


def pressure_surface(theta: np.ndarray, z: np.ndarray, pressure: np.ndarray) -> np.ndarray:
    """Points (k, m, 3) of the hill over the unit bore; pressures below ambient stay on the bore."""
    largest = float(np.nanmax(pressure))
    height = HILL / largest if largest > 0.0 else 0.0
    return cylinder_points(1.0 + height * np.maximum(pressure, 0.0), theta, z)


def journal_surface(film: FilmRecord, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Points (k, m, 3) of the journal, with the clearance enlarged to its share of the radius; z over the radius."""
    c, R = film.bearing.radial_clearance, film.bearing.journal_radius
    points = cylinder_points(1.0 - CLEARANCE, theta, z)
    points[..., :2] += CLEARANCE / c * (film.motion[:2] + np.multiply.outer(R * z, film.motion[2:4]))
    return points


def quads_of(points: np.ndarray) -> np.ndarray:
    """Quadrilaterals (q, 4, d) of grids of points (..., k, m, d)."""
    near, far = points[..., :-1, :, :], points[..., 1:, :, :]
    corners = [near[..., :-1, :], far[..., :-1, :], far[..., 1:, :], near[..., 1:, :]]
    return np.stack(corners, axis=-2).reshape(-1, 4, points.shape[-1])


def _fan(rim: np.ndarray) -> np.ndarray:
    """Facets (k, 4, 3) of the disc within a closed rim (k, 3): triangles with their last corner twice."""
    following = np.roll(rim, -1, axis=0)
    return np.stack([np.broadcast_to(rim.mean(axis=0), rim.shape), rim, following, following], axis=1)


def _turned(points: np.ndarray) -> np.ndarray:
    """The picture's axes: right x, depth z (positive towards the viewer), up y."""
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)


def _draw_arrows(ax: Axes3D, film: FilmRecord, z: np.ndarray) -> None:
    """The joint's x and y, and the load of the journal on the bush, at the end z = L/2 and in front of everything."""
    start = np.array([0.0, 0.0, z[-1]])
    box = {"boxstyle": "circle,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.85}
    for name, way in (("x", (1.0, 0.0, 0.0)), ("y", (0.0, 1.0, 0.0))):
        ax.quiver(*_turned(start), *_turned(np.array(way)), color=BLACK, lw=0.7, arrow_length_ratio=0.1, zorder=10)
        ax.text(*_turned(start + 1.12 * np.array(way)), name, ha="center", va="center", zorder=11, bbox=box)
    load = -film.force[:2]
    size = float(np.hypot(*load))
    if size > 0.0:
        tip = _turned(np.array([*(load / size), 0.0]))
        ax.quiver(*_turned(start), *tip, color=VERMILION, lw=1.6, arrow_length_ratio=0.15, zorder=12)


def _camera(peak: float) -> tuple[float, float]:
    """Elevation and azimuth, degrees, from which a hill at the angle ``peak`` and the end z = L/2 are in view."""
    x, y = np.cos(peak), np.sin(peak)
    elevation = np.degrees(np.arcsin(np.clip(0.8 * y, -0.55, 0.55)))
    # a hill right above or below is looked at from one side
    sideways = np.copysign(max(0.45, 0.9 * abs(x)), x)
    return float(elevation), float(np.degrees(np.arctan2(-1.0, sideways)))


def look_at(ax: Axes3D, box: np.ndarray, camera: tuple[float, float], *, zoom: float) -> None:
    """Show a box (3, 2), to scale and without axes, from an elevation and an azimuth in degrees."""
    ax.set_axis_off()
    ax.set(xlim=box[0], ylim=box[1], zlim=box[2])
    ax.set_box_aspect(np.ptp(box, axis=1), zoom=zoom)
    ax.view_init(elev=camera[0], azim=camera[1])


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
        raise InputError("contour_figure: frames must hold at least one Frame, got none; pass what is to be drawn.")
    columns = min(3, int(np.ceil(np.sqrt(len(frames)))))
    rows = -(-len(frames) // columns)
    norm = Normalize(*colour_limits(np.array([frame.values for frame in frames])))
    colours = matplotlib.colormaps["viridis"]
    points = _turned(np.concatenate([mesh.nodes, *(mesh.nodes + frame.displacements for frame in frames)]))
    box = np.stack([points.min(axis=0), points.max(axis=0)], axis=1)
    # elevation and azimuth, degrees
    camera = 18.0, -65.0
    plots = []
    with styled(10.0):
        figure = new_figure((3.4 * columns + 1.0, 3.3 * rows))
        for i, frame in enumerate(frames):
            axes = figure.add_subplot(rows, columns, i + 1, projection="3d", computed_zorder=False)
            _draw(axes, mesh, frame, norm, colours, camera)
            look_at(axes, box, camera, zoom=1.1)
            axes.set_proj_type("ortho")
            axes.set_title(frame.title, y=1.0)
            plots.append(axes)
        bar = matplotlib.cm.ScalarMappable(norm=norm, cmap=colours)
        style_ticks(figure.colorbar(bar, ax=plots, label=label, shrink=0.8, pad=0.02).ax)
        write(figure, None)
    return figure


def _draw(
    axes: Axes3D, mesh: BushMesh, frame: Frame, norm: Normalize, colours: Colormap, camera: tuple[float, float]
) -> None:
    """Draw the faces of a deformed mesh: facets in the colours of the field, and their outlines."""
    kind, faces = face_of(mesh.boundary), _turned(mesh.nodes + frame.displacements)[mesh.boundary]
    facets, values = _facets(kind, faces, frame.values[mesh.boundary])
    # closed polylines through the corners and mid-edge nodes, towards the viewer so that no facet of their own face
    # hides them
    elevation, azimuth = np.radians(camera)
    sight = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    depth = faces @ sight
    outlines = faces[:, kind.outline] + np.multiply.outer(depth.max(axis=1) - depth.mean(axis=1), sight)[:, None]
    corners = faces[:, : kind.corners]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    outlines = outlines[normals @ sight > 0.0]
    # one collection, which matplotlib sorts by depth, and with as many corners each, since it pads shorter polygons
    # with whatever the memory holds
    facets = np.concatenate([facets, np.repeat(facets[:, -1:], outlines.shape[1] - 4, axis=1)], axis=1)
    fills = np.concatenate([colours(norm(values)), np.zeros((len(outlines), 4))])
    edges = np.concatenate([fills[: len(facets)], np.tile([0.0, 0.0, 0.0, 1.0], (len(outlines), 1))])
    polygons = np.concatenate([facets, outlines])
    axes.add_collection3d(Poly3DCollection(polygons, facecolors=fills, edgecolors=edges, linewidths=0.3))


def _facets(kind: Face, corners: np.ndarray, nodal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Flat quadrilaterals (m, 4, 3), 3 x 3 of them on every face (f, a, 3), and their mean values (m,)."""
    ticks = np.linspace(-1, 1, 4)
    r, s = np.meshgrid(ticks, ticks, indexing="ij")
    shapes, _ = kind.shapes(kind.from_square(np.stack([r.ravel(), s.ravel()], axis=1)))
    points = np.einsum("pa,fai->fpi", shapes, corners)
    fields = np.einsum("pa,fa->fp", shapes, nodal)
    return quads_of(points.reshape(-1, 4, 4, 3)), quads_of(fields.reshape(-1, 4, 4, 1)).mean(axis=1).ravel()
