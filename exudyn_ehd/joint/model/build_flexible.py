"""From a bush's description to a bearing model with a flexible bore."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.joint.bore.equilibrium import Elasticity
from exudyn_ehd.joint.bore.shapes import Bore, ModalBore, NodalBore
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.seams import Effects
from exudyn_ehd.solid.bush import ANCFBush, ModalBush
from exudyn_ehd.solid.fe_bore import FEBore, ReducedBore
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.modes.static import bore_modes
from exudyn_ehd.solid.static_equilibrium import held_stiffness
from exudyn_ehd.status import InputError


def elastic_model(bearing: JournalBearing, start_angle: float, effects: Effects) -> ElasticBearingModel:
    """Model of a bearing whose ``bush`` is not None."""
    bush = bearing.bush
    if isinstance(bush, FEBore):
        raise InputError(
            "JournalBearing.bush=FEBore(...) takes its modes from the body that is the joint's housing: give "
            "CreateLubricatedJoint an ObjectFFRFreducedOrder as itemNumbers[0]; for other bodies, and for a bearing by "
            "itself, take a ModalBush(...)."
        )
    bore, stiffness = _bore_and_stiffness(bush)
    return ElasticBearingModel(
        bearing, bore, elasticity=Elasticity(stiffness), start_angle=start_angle, effects=effects
    )


def _bore_and_stiffness(bush: object) -> tuple[Callable[[FilmGrid], Bore], Callable[[], np.ndarray]]:
    """Functions that make the bore on a film's grid, and the stiffness of its coordinates."""
    if isinstance(bush, ModalBush):
        modes = bore_modes(bush)
        return lambda grid: ModalBore(modes, grid), lambda: np.diag(modes.stiffness)
    if isinstance(bush, ReducedBore):
        return lambda grid: ModalBore(bush, grid), lambda: bush.stiffness_matrix
    assert isinstance(bush, ANCFBush)
    mesh = bush.build_mesh()
    return lambda grid: NodalBore(mesh.bore, grid), lambda: bore_stiffness(bush)


def bore_stiffness(bush: ANCFBush) -> np.ndarray:
    """Stiffness (k, k) of a mesh at rest condensed on the x and y displacements of its bore nodes, N/m.

    Outer surface fixed.
    """
    mesh = bush.build_mesh()
    free, _, factor = held_stiffness(bush.solid(mesh))
    places = (np.cumsum(free) - 1)[_bore_places(mesh)]
    unit = np.zeros((int(free.sum()), len(places)))
    unit[places, np.arange(len(places))] = 1.0
    stiffness = np.linalg.inv(factor.solve(unit)[places])
    return 0.5 * (stiffness + stiffness.T)


def displacements_at_rest(bush: ANCFBush, bore_load: np.ndarray) -> np.ndarray:
    """Small displacements (n, 3) of all nodes, m, under loads (k,) on the bore nodes' x and y, N.

    Outer surface fixed.
    """
    mesh = bush.build_mesh()
    free, _, factor = held_stiffness(bush.solid(mesh))
    load, u = np.zeros(free.size), np.zeros(free.size)
    load[_bore_places(mesh)] = bore_load
    u[free] = factor.solve(load[free])
    return u.reshape(-1, 3)


def _bore_places(mesh: BushMesh) -> np.ndarray:
    return (3 * mesh.bore.nodes[:, None] + np.arange(2)).ravel()
