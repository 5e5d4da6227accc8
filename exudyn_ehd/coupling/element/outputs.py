"""The bearing in Exudyn's renderer: a ring of the housing or the modal bush, and the film in it.

The journal has its true radius. The clearance is drawn as a tenth of it; film thickness and bore deflection are
magnified by the same factor. So the film is a layer between the bore and a journal with the true eccentricity ratio.
Colours show the pressure on the bore, and on the film's ends the largest pressure along the axis.

Exudyn asks for the picture only while a renderer runs, or for an image of its ray tracer
(``SC.renderer.RedrawAndGetImage(True)``, which needs no display). The first time it does, the film element begins to
store the pressure of every accepted step; before that nothing is stored. During a run, drawing does not evaluate the
film, because the solver needs its last evaluation. Outside of a run it shows the film of the present state.

Sensors of Exudyn that read a joint: quantities of its film, and what Exudyn's own joints give
----------------------------------------------------------------------------------------------
The latter are those of a joint whose first marker is on the housing and whose second is on the journal. Local values
are in the housing's joint frame A0. Loads are those of the journal on the housing (minus those on the journal), by
films, thrust faces and constraint together. Torques are vectors about the bearing's centre, as for Exudyn's
spring-dampers. ``TorqueLocal`` of its ideal joints contains multipliers, for ``CreateRevoluteJoint`` (-M_y, M_x).
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import exudyn.graphics
import exudyn.itemInterface as eii
import numpy as np
from exudyn.rigidBodyUtilities import HomogeneousTransformation, RotationMatrix2RotXYZ

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Data, Index, Side, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.objects import Presence
from exudyn_ehd.coupling.record.history import COLUMNS, WIDTH, Quantity
from exudyn_ehd.solid.elements.element import face_of
from exudyn_ehd.status import InputError, Status

_VISUALIZATION = exu.ConfigurationType.Visualization
# Transparent colour (RGBA) of the housing's ring or the bush.
GREY = [0.72, 0.74, 0.78, 0.2]


class FilmDisplay:
    """Graphics of one film.

    Parameters
    ----------
    element : FilmElement

    Attributes
    ----------
    wanted : bool
        True after a renderer has asked for the picture.
    clearance : float
        Size of the drawn clearance, or of a larger deflection of the bore, over the journal's radius; 0.1 by default,
        0 draws the true size.
    """

    def __init__(self, element: FilmElement) -> None:
        self.element = element
        self.wanted = False
        self.clearance = 0.1
        self.pressure: np.ndarray | None = None
        self.gap: np.ndarray | None = None
        self.largest = 0.0
        self.bore: np.ndarray | None = None
        self.bush: np.ndarray | None = None
        self._housing: Side | None = None

    def take(self, trial: Trial) -> None:
        """Store the data for drawing a film, which must be the last evaluated one."""
        if (film := getattr(trial.evaluation, "film", None)) is None:
            return
        model: Any = self.element.model
        clearance = model.bearing.radial_clearance
        self.pressure = film.pressure
        self.gap = film.solver.H * clearance
        if film.bore is None:
            return
        # the displacement of the bore itself, without an elastic journal's part
        own = np.arange(model.bore.size) < model.bore.own
        self.bore = model.bore.displacement(np.where(own, film.bore.coordinates, 0.0))
        self.largest = max(self.largest, float(np.abs(film.bore.displacement).max()) * clearance)
        modes: Any = getattr(model.bore, "modes", None)
        # finite-element bodies are drawn by Exudyn
        if modes is not None and hasattr(modes, "mesh"):
            self.bush = np.tensordot(film.bore.coordinates[: modes.count], modes.displacements, 1)

    def graphics(self, mbs: exu.MainSystem, itemNumber: int) -> list[Data]:
        """User function of Exudyn: graphics data of the state that the renderer shows, global coordinates."""
        model: Any = self.element.model
        if not hasattr(model, "grid"):
            return []
        steps = self.element.steps
        if not self.wanted:
            self.wanted = True
            steps.observers.append(self.take)
        if steps.is_idle:
            trial = steps.look_at_accepted(mbs)[1]
            if trial.status is Status.CONVERGED:
                self.take(trial)
        frame, scale = self._frame(mbs), self._scale(model.bearing)
        lobes, clearance = model.effects.lobes, model.bearing.radial_clearance
        depth = 0.0 if lobes is None else clearance * lobes.values
        bore, z = self._bore(scale) + scale * depth, model.grid.z * model.grid.reference_length
        rings, last = _points(frame, model.grid.x, bore[:, [0, -1]], z[[0, -1]]), model.grid.edges[:, 1]
        lines = np.split(rings, last[:-1] + 1) if last.size else [np.vstack([rings, rings[:1]])]
        black = exudyn.graphics.color.black
        data = [exudyn.graphics.Lines(line[:, k], color=black) for line in lines for k in (0, 1)]

        def surface(radii: np.ndarray, places: np.ndarray, color: list[float] | np.ndarray) -> None:
            """Add the surface through rings of radii (n, k) at places (k,)."""
            points = _points(frame, model.grid.x, radii, places).reshape(-1, 3)
            triangles = ring_triangles(*radii.shape, last=last)
            data.append(exudyn.graphics.FromPointsAndTrigs(points, triangles, color=color))

        if self.pressure is not None and self.gap is not None:
            colors = pressure_colours(np.column_stack([self.pressure, self.pressure.max(axis=1)]))
            surface(bore, z, colors[:, :-1].reshape(-1, 4))
            journal = bore - scale * np.minimum(self.gap, 2.0 * clearance + self.largest + depth)
            ends = np.repeat(colors[:, -1], 2, axis=0)
            surface(np.column_stack([journal[:, 0], bore[:, 0]]), z[[0, 0]], ends)
            surface(np.column_stack([bore[:, -1], journal[:, -1]]), z[[-1, -1]], ends)
        if self.bush is None:
            # the housing's ring is a fifth of the journal's radius thick
            wall = np.full(len(bore), bore.max() + 0.2 * model.bearing.journal_radius)
            surface(np.column_stack([bore[:, 0], wall, wall, bore[:, -1]]), z[[0, 0, -1, -1]], GREY)
        else:
            mesh = model.bore.modes.mesh
            outward = mesh.nodes * (1.0, 1.0, 0.0) / np.linalg.norm(mesh.nodes[:, :2], axis=1)[:, None]
            moved = mesh.nodes + (scale - 1.0) * model.bearing.radial_clearance * outward + scale * self.bush
            triangles = mesh.boundary[:, face_of(mesh.boundary).triangles].reshape(-1, 3)
            moved = moved @ frame[:, :3].T + frame[:, 3]
            data.append(exudyn.graphics.FromPointsAndTrigs(moved, triangles, color=GREY))
        return data

    def _scale(self, bearing: JournalBearing) -> float:
        """Return the factor by which film thickness and bore deflection are magnified in the picture."""
        return max(1.0, self.clearance * bearing.journal_radius / max(bearing.radial_clearance, self.largest))

    def _bore(self, scale: float) -> np.ndarray:
        """Radii (n, m) of the bore as drawn."""
        model: Any = self.element.model
        grid, bearing = model.grid, model.bearing
        # a polygon around the bore: the chords of one in the bore would cut through the journal
        radius = (bearing.journal_radius + scale * bearing.radial_clearance) / np.cos(0.5 * grid.width_x.max())
        return np.full(grid.shape, radius) if self.bore is None else radius + scale * self.bore

    def _frame(self, mbs: exu.MainSystem) -> np.ndarray:
        """Joint frame (3, 6) of the housing in the shown state, without changing the element's work arrays."""
        if self._housing is None:
            self._housing = copy.deepcopy(self.element.sides[0])
        q, q_t = (np.array(values[: self._housing.size]) for values in self.element.read(mbs, _VISUALIZATION))
        self._housing.update(mbs, q, q_t, _VISUALIZATION)
        return self._housing.frame


def add_element(mbs: exu.MainSystem, display: FilmDisplay, show: bool, color: Sequence[float], **more: object) -> Index:
    """Add the object of a display's element to a system; ``more``: further arguments of ObjectGenericODE2."""
    element = display.element
    name, shown = element.failures.name, {"show": show, "color": list(color)}
    number = mbs.AddObject(
        eii.ObjectGenericODE2(
            name=name,
            nodeNumbers=element.nodes,
            forceUserFunction=element.force,
            jacobianUserFunction=element.jacobian,
            visualization=eii.VObjectGenericODE2(graphicsDataUserFunction=display.graphics, **shown),
            **more,
        )
    )
    element.presence = Presence(mbs, name, element, number, element.sides)
    return number


def _points(frame: np.ndarray, theta: np.ndarray, radii: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Global points (n, k, 3) of radii (n, k) at the angles theta (n,) and the axial places (k,) of a frame (3, 6)."""
    z = np.broadcast_to(places, radii.shape)
    local = np.stack([radii * np.cos(theta)[:, None], radii * np.sin(theta)[:, None], z], axis=-1)
    return local @ frame[:, :3].T + frame[:, 3]


def ring_triangles(n: int, m: int, *, last: Sequence[int] | np.ndarray = ()) -> np.ndarray:
    """Triangles (2 n (m - 1), 3) of a ring of n x m vertices, numbered row by row; normals point outward.

    ``last``: columns at which arcs end; no triangles follow them.
    """
    columns = np.delete(np.arange(n), np.asarray(last, dtype=int))
    i, j = (index.ravel() for index in np.meshgrid(columns, np.arange(m - 1), indexing="ij"))
    a, b = i * m + j, ((i + 1) % n) * m + j
    return np.concatenate([np.stack([a, b, a + 1], axis=1), np.stack([a + 1, b, b + 1], axis=1)])


def pressure_colours(pressure: np.ndarray) -> np.ndarray:
    """RGBA (n, m, 4) from the smallest to the largest pressure, in the colours of the maps."""
    import matplotlib

    low, high = float(pressure.min()), float(pressure.max())
    share = (pressure - low) / (high - low) if high > low else np.zeros_like(pressure)
    return matplotlib.colormaps["viridis"](share)


_NO_ROW = np.full(WIDTH, np.nan)


def _turn(h: np.ndarray, j: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) of the journal against the housing, for their frames (3, 6)."""
    return h[:, :3].T @ j[:, :3]


def _local(h: np.ndarray, j: np.ndarray, column: int) -> np.ndarray:
    """Difference of a column of both frames, in the housing's frame."""
    return h[:, :3].T @ (j[:, column] - h[:, column])


OUTPUTS: dict[str, Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]] = {
    "Position": lambda h, j, load: h[:, 3],
    "Velocity": lambda h, j, load: h[:, 4],
    "HomogeneousTransformation": lambda h, j, load: HomogeneousTransformation(h[:, :3], h[:, 3]),
    "HomogeneousTransformationLocal": lambda h, j, load: HomogeneousTransformation(_turn(h, j), _local(h, j, 3)),
    "Displacement": lambda h, j, load: j[:, 3] - h[:, 3],
    "DisplacementLocal": lambda h, j, load: _local(h, j, 3),
    "VelocityLocal": lambda h, j, load: _local(h, j, 4),
    "Rotation": lambda h, j, load: RotationMatrix2RotXYZ(_turn(h, j)),
    "AngularVelocity": lambda h, j, load: j[:, 5] - h[:, 5],
    "AngularVelocityLocal": lambda h, j, load: _local(h, j, 5),
    "Force": lambda h, j, load: h[:, :3] @ load[:3],
    "ForceLocal": lambda h, j, load: load[:3],
    "Torque": lambda h, j, load: h[:, :3] @ load[3:],
    "TorqueLocal": lambda h, j, load: load[3:],
}
"""Functions that read a sensor's value, by the names of Exudyn's OutputVariableType.

They take the frames (3, 6) of housing and journal, and the load (6,) on the housing in its frame.
"""


def reader(
    element: FilmElement,
    constraint: Index | None,
    quantity: Quantity | exu.OutputVariableType | str,
    known: Sequence[str],
    where: str,
) -> tuple[str, Callable[[exu.MainSystem], np.ndarray]]:
    """Return the name of a quantity, and the function that reads it at the current state; nan without a film.

    Raises
    ------
    InputError
        In the name of ``where``, for a quantity that is not ``known``.
    """
    asked = getattr(quantity, "name" if isinstance(quantity, exu.OutputVariableType) else "value", quantity)
    if isinstance(asked, str) and asked in OUTPUTS:
        output = OUTPUTS[asked]
        return asked, lambda mbs: np.ravel(output(*_sensed(mbs, element, constraint)))
    if not isinstance(asked, str) or asked not in known:
        raise InputError(
            f"{where}: quantity must be a member of Quantity or its name, one of {', '.join(known)}, or an "
            f"exu.OutputVariableType or its name, one of {', '.join(OUTPUTS)}; got {quantity!r}."
        )

    def read(mbs: exu.MainSystem) -> np.ndarray:
        row = element.row(*element.current(mbs))
        return np.atleast_1d((_NO_ROW if row is None else row)[COLUMNS[asked]])

    return asked, read


def _sensed(
    mbs: exu.MainSystem, element: FilmElement, constraint: Index | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Frames (3, 6) of housing and journal, after an evaluation of the film, and the load (6,)."""
    trial = element.current(mbs)[1]
    load = np.full(6, np.nan) if trial.status is not Status.CONVERGED else -trial.found.wrench
    if trial.faces is not None:
        load -= trial.faces.wrench
    if constraint is not None:
        output = exu.OutputVariableType
        load[:3] += mbs.GetObjectOutput(constraint, output.ForceLocal)
        multipliers = mbs.GetObjectOutput(constraint, output.TorqueLocal)
        load[3:] += [multipliers[1], -multipliers[0], 0.0]
    housing, journal = (side.frame.copy() for side in element.sides)
    return housing, journal, load


def add_sensor(
    mbs: exu.MainSystem,
    element: FilmElement,
    read: Callable[[exu.MainSystem], np.ndarray],
    name: str,
    file_name: str,
    write_to_file: bool,
) -> Index:
    """Add a sensor of the quantity of a `reader`; its values are stored in the sensor.

    After an accepted step the sensor reads exactly the state that is recorded, so that both are bit-identical.
    """

    def values(
        mbs: exu.MainSystem,
        t: float,
        sensorNumbers: list[int],
        factors: list[float],
        configuration: exu.ConfigurationType,
    ) -> list[float]:
        element.presence.require(mbs)
        return read(mbs).tolist()

    return mbs.AddSensor(
        eii.SensorUserFunction(
            name=name,
            sensorNumbers=[],
            factors=[],
            sensorUserFunction=values,
            storeInternal=True,
            fileName=file_name,
            writeToFile=write_to_file,
        )
    )
