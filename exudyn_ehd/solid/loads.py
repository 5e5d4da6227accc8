"""Loads on a bush: on a line, on a surface, pressure, and gravity, as consistent nodal forces.

Every load has a ``history``, a function of time [s] that multiplies its value; without one the value holds at all
times.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.solid.harmonics import SHAPES, SLOPES, WEIGHTS
from exudyn_ehd.solid.mesh import BushMesh, Line, Surface
from exudyn_ehd.solid.total_lagrange import TotalLagrange
from exudyn_ehd.status import Checked, InputError, require_number, require_vector

LoadHistory = Callable[[float], float]


def _require_history(where: str, history: object) -> None:
    if not callable(history):
        raise InputError(
            f"{where} must be a function of time or None, got {history!r}; write history=lambda t: ... for a load "
            "that varies."
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class LineLoad(Checked):
    """Force per length along a line of a bush, of constant direction.

    Parameters
    ----------
    line : Line
        For example ``mesh.generatrix(mesh.outer, pi / 2)``, the line at the angle 90 degrees.
    force_per_length : three numbers
        Force per undeformed length [N/m], global frame.
    history : function of time or None, default None
        Factor on the force over the time [s]; None: 1.

    Examples
    --------
    After the example of `BushMesh`:

    >>> load = ehd.LineLoad(line=bush.generatrix(bush.outer, np.pi / 2), force_per_length=(0, -1000, 0))
    """

    line: Line
    force_per_length: tuple[float, float, float] | np.ndarray
    history: LoadHistory | None = None

    checks: ClassVar = {
        "force_per_length": partial(require_vector, size=3, unit="N/m"),
        "history": _require_history,
    }

    def nodal_forces(self, mesh: BushMesh) -> np.ndarray:
        """Return int N_a q ds as nodal forces, shape (n, 3) [N]."""
        # nodes of a quadratic edge: its ends, then its middle
        nodes = self.line.edges[:, [0, 2, 1]]
        tangent = np.einsum("qa,eai->eqi", SLOPES, mesh.nodes[nodes])
        weight = WEIGHTS * np.linalg.norm(tangent, axis=2)
        share = np.einsum("eq,qa->ea", weight, SHAPES)
        forces = np.zeros((len(mesh.nodes), 3))
        np.add.at(forces, nodes, share[..., None] * np.asarray(self.force_per_length, dtype=float))
        return forces


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceLoad(Checked):
    """Force per area on a surface of a bush, of constant direction.

    Parameters
    ----------
    surface : Surface
        For example ``mesh.end_high``.
    traction : three numbers
        Force per undeformed area [N/m^2], global frame.
    distribution : ndarray, shape (k,) or None, default None
        Factor at every node of the surface (``surface.nodes``), interpolated between them; None: uniform traction.
    history : function of time or None, default None
        Factor on the force over the time [s]; None: 1.

    Examples
    --------
    After the example of `BushMesh`:

    >>> load = ehd.SurfaceLoad(surface=bush.end_high, traction=(0, 0, 1e5), history=lambda t: min(1.0, t / 1e-3))
    """

    surface: Surface
    traction: tuple[float, float, float] | np.ndarray
    distribution: np.ndarray | None = None
    history: LoadHistory | None = None

    checks: ClassVar = {"traction": partial(require_vector, size=3, unit="Pa"), "history": _require_history}

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_distribution("SurfaceLoad.distribution", self.distribution, self.surface)

    def nodal_forces(self, mesh: BushMesh) -> np.ndarray:
        """Return int N_a t dA as nodal forces, shape (n, 3) [N]."""
        normal = _area_vectors(self.surface, mesh.nodes)
        factor = _at_points(self.distribution, self.surface)
        share = np.einsum("fq,fq,qa->fa", np.linalg.norm(normal, axis=2), factor, self.surface.kind.rule[1])
        forces = np.zeros((len(mesh.nodes), 3))
        np.add.at(forces, self.surface.faces, share[..., None] * np.asarray(self.traction, dtype=float))
        return forces


@dataclass(frozen=True, kw_only=True, eq=False)
class _SurfacePressure(Checked):
    """Pressure along the inward normal of a surface; parameters as in `DeadPressure`."""

    surface: Surface
    pressure: float
    distribution: np.ndarray | None = None
    history: LoadHistory | None = None

    checks: ClassVar = {"pressure": partial(require_number, unit="Pa"), "history": _require_history}

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_distribution(f"{type(self).__name__}.distribution", self.distribution, self.surface)

    def forces(self, positions: np.ndarray) -> np.ndarray:
        """Return -int N_a p n da at positions (n, 3) [m] and history = 1, shape (n, 3) [N]."""
        normal = _area_vectors(self.surface, positions)
        pressure = self.pressure * _at_points(self.distribution, self.surface)
        forces = np.zeros_like(positions)
        np.add.at(forces, self.surface.faces, -np.einsum("fq,qa,fqi->fai", pressure, self.surface.kind.rule[1], normal))
        return forces


class DeadPressure(_SurfacePressure):
    """Pressure along the inward normal of the undeformed surface, on its undeformed area.

    Parameters
    ----------
    surface : Surface
        For example ``mesh.bore``.
    pressure : float
        Pressure [Pa]; positive pushes onto the solid.
    distribution : ndarray, shape (k,) or None, default None
        Factor at every node of the surface (``surface.nodes``), interpolated between them; None: uniform pressure.
    history : function of time or None, default None
        Factor on the pressure over the time [s]; None: 1.

    Examples
    --------
    After the example of `BushMesh`:

    >>> load = ehd.DeadPressure(surface=bush.bore, pressure=1e6)
    >>> bool(abs(load.nodal_forces(bush).sum(axis=0)).max() < 1e-6)
    True
    """

    def nodal_forces(self, mesh: BushMesh) -> np.ndarray:
        """Return -int N_a p n dA as nodal forces, shape (n, 3) [N]."""
        return self.forces(mesh.nodes)


class FollowerPressure(_SurfacePressure):
    """Pressure along the inward normal of the deformed surface, on its deformed area.

    Parameters
    ----------
    surface, pressure
        As in `DeadPressure`.
    distribution, history : array, function or None, default None
        As in `DeadPressure`.

    Examples
    --------
    After the example of `BushMesh`:

    >>> load = ehd.FollowerPressure(surface=bush.bore, pressure=1e6)
    """

    def stiffness(self, positions: np.ndarray) -> np.ndarray:
        """Return -d(forces)/d(positions) of every face, shape (f, 3 a, 3 a) [N/m], coordinates node by node.

        With n da = x_,r × x_,s dr ds, the variation of f_a = -int N_a p x_,r × x_,s gives
        -df_a/dx_b = int N_a p (N_b,s [x_,r]× - N_b,r [x_,s]×); not symmetric, since the edges of a patch carry no load.
        """
        corners = positions[self.surface.faces]
        weights, shapes, slopes = self.surface.kind.rule
        slope = np.einsum("qar,fai->fqri", slopes, corners)
        pressure = weights * self.pressure * _at_points(self.distribution, self.surface)
        # of the cross products with both slopes
        along_r, along_s = np.cross(slope.transpose(2, 0, 1, 3)[..., None, :], np.eye(3)).swapaxes(-1, -2)
        block = np.einsum("fq,qa,qb,fqij->faibj", pressure, shapes, slopes[..., 1], along_r)
        block -= np.einsum("fq,qa,qb,fqij->faibj", pressure, shapes, slopes[..., 0], along_s)
        size = 3 * shapes.shape[1]
        return block.reshape(len(corners), size, size)

    def places(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns of `stiffness` among the nodes' coordinates, (faces, size size) each."""
        size = 3 * self.surface.faces.shape[1]
        dofs = (3 * self.surface.faces[:, :, None] + np.arange(3)).reshape(-1, size)
        return np.repeat(dofs, size, axis=1), np.tile(dofs, (1, size))


@dataclass(frozen=True, kw_only=True, eq=False)
class Gravity(Checked):
    """Weight of the bush: its density times an acceleration.

    Parameters
    ----------
    acceleration : three numbers
        Acceleration of gravity [m/s^2], global frame: (0, -9.81, 0) where y points up.
    history : function of time or None, default None
        Factor on the acceleration over the time [s]; None: 1.

    Examples
    --------
    >>> load = ehd.Gravity(acceleration=(0, -9.81, 0))
    """

    acceleration: tuple[float, float, float] | np.ndarray
    history: LoadHistory | None = None

    checks: ClassVar = {"acceleration": partial(require_vector, size=3, unit="m/s^2"), "history": _require_history}


BushLoad = LineLoad | SurfaceLoad | DeadPressure | FollowerPressure | Gravity


def dead_forces(load: LineLoad | SurfaceLoad | DeadPressure | Gravity, solid: TotalLagrange) -> np.ndarray:
    """Nodal forces (n, 3) of a load that does not follow the surface, at history = 1 [N]."""
    if isinstance(load, Gravity):
        return np.outer(solid.scalar_mass.sum(axis=1), load.acceleration)
    return load.nodal_forces(solid.mesh)


def factor(load: BushLoad, time: float) -> float:
    """Return the load's history at a time [s]."""
    return 1.0 if load.history is None else float(load.history(time))


def _area_vectors(surface: Surface, positions: np.ndarray) -> np.ndarray:
    """x_,r × x_,s times quadrature weight, (f, q, 3), at positions (n, 3) of the mesh's nodes."""
    weights, _, slopes = surface.kind.rule
    slope = np.einsum("qar,fai->fqri", slopes, positions[surface.faces])
    return weights[:, None] * np.cross(slope[:, :, 0], slope[:, :, 1])


def _at_points(distribution: np.ndarray | None, surface: Surface) -> np.ndarray:
    if distribution is None:
        return np.ones((len(surface.faces), len(surface.kind.rule[0])))
    return np.asarray(distribution, dtype=float)[surface.local_faces] @ surface.kind.rule[1].T


def _require_distribution(where: str, distribution: np.ndarray | None, surface: Surface) -> None:
    if distribution is None:
        return
    shape = np.shape(distribution)
    if shape != (len(surface.nodes),) or not np.all(np.isfinite(distribution)):
        raise InputError(
            f"{where} must be {len(surface.nodes)} finite numbers, one per node of the surface, got shape {shape}; "
            "evaluate it from surface.theta and surface.z."
        )
