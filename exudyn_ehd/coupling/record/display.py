"""The film in Exudyn's renderer: its pressure in colours on the bore, and the deformed modal bush.

Exudyn asks for the picture only while a renderer runs, or for an image of its ray tracer
(``SC.renderer.RedrawAndGetImage(True)``, which needs no display). The first time it does, the film element begins to
hand over the pressure of every accepted step; before that nothing is stored. Within a run, drawing never evaluates the
film, whose last evaluation belongs to the solver; outside of one it shows the film of the present state.
"""

from __future__ import annotations

from typing import Any

import exudyn as exu
import exudyn.graphics
import numpy as np

from exudyn_ehd.coupling.contract import Data, Side, Trial
from exudyn_ehd.coupling.kinematics.sides import detached, read_state
from exudyn_ehd.coupling.record.element import Element
from exudyn_ehd.solid.elements.faces import face_of
from exudyn_ehd.status import Status

_VISUALIZATION = exu.ConfigurationType.Visualization
EDGE = [0.0, 0.0, 0.0, 1.0]
BUSH = [0.72, 0.74, 0.78, 0.35]


class FilmDisplay:
    """Graphics of one film.

    Parameters
    ----------
    element : Element

    Attributes
    ----------
    wanted : bool
        Whether a renderer has asked.
    """

    def __init__(self, element: Element) -> None:
        self.element = element
        self.wanted = False
        self.pressure: np.ndarray | None = None
        self.bore: np.ndarray | None = None
        self.bush: np.ndarray | None = None
        self._housing: Side | None = None

    def take(self, trial: Trial) -> None:
        """Store what is drawn of a film, the last that was evaluated."""
        film = getattr(trial.evaluation, "film", None)
        if film is None:
            return
        self.pressure = film.oil.P * film.scales.pressure
        if film.bore is None:
            return
        model: Any = self.element.model
        self.bore = film.bore.displacement * model.bearing.radial_clearance
        modes = getattr(model.bore, "modes", None)
        if modes is not None:
            self.bush = np.tensordot(film.bore.coordinates, modes.displacements, 1)

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
        frame = self._frame(mbs)
        grid, bearing = model.grid, model.bearing
        # a polygon about the bore, not in it: its chords would cut through the journal
        radius = (bearing.journal_radius + bearing.radial_clearance) / np.cos(np.pi / grid.shape[0])
        r = np.full(grid.shape, radius) if self.bore is None else radius + self.bore
        z = np.broadcast_to(grid.z * grid.reference_length, grid.shape)
        local = np.stack([r * np.cos(grid.x)[:, None], r * np.sin(grid.x)[:, None], z], axis=-1)
        points = local @ frame[:, :3].T + frame[:, 3]
        data = [self._line(points[:, 0]), self._line(points[:, -1])]
        if self.pressure is not None:
            flat = points.reshape(-1, 3)
            colors = pressure_colours(self.pressure).reshape(-1, 4)
            triangles = ring_triangles(*grid.shape)
            data.append(exudyn.graphics.FromPointsAndTrigs(flat, triangles, color=colors))
        if self.bush is not None:
            mesh = model.bore.modes.mesh
            moved = (mesh.nodes + self.bush) @ frame[:, :3].T + frame[:, 3]
            triangles = mesh.boundary[:, face_of(mesh.boundary).triangles].reshape(-1, 3)
            data.append(exudyn.graphics.FromPointsAndTrigs(moved, triangles, color=BUSH))
        return data

    def _frame(self, mbs: exu.MainSystem) -> np.ndarray:
        """Joint frame (3, 6) of the housing in the shown state; the element's own arrays belong to the solver."""
        if self._housing is None:
            self._housing = detached(self.element.sides[0])
        q, q_t = read_state(mbs, [self._housing], _VISUALIZATION)
        self._housing.update(mbs, np.array(q), np.array(q_t), _VISUALIZATION)
        return self._housing.frame

    @staticmethod
    def _line(points: np.ndarray) -> Data:
        """Closed line through points (n, 3)."""
        return exudyn.graphics.Lines(np.vstack([points, points[:1]]), color=EDGE)


def ring_triangles(n: int, m: int) -> np.ndarray:
    """Triangles (2 n (m - 1), 3) of a closed ring of n x m vertices, numbered row by row; normals point outward."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(m - 1), indexing="ij"))
    a, b = i * m + j, ((i + 1) % n) * m + j
    return np.concatenate([np.stack([a, b, a + 1], axis=1), np.stack([a + 1, b, b + 1], axis=1)])


def pressure_colours(pressure: np.ndarray) -> np.ndarray:
    """RGBA (n, m, 4) from the smallest to the largest pressure, in the colours of the maps."""
    import matplotlib

    low, high = float(pressure.min()), float(pressure.max())
    share = (pressure - low) / (high - low) if high > low else np.zeros_like(pressure)
    return matplotlib.colormaps["viridis"](share)
