"""From a bush's description to a bearing model with a flexible bore."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.bore.equilibrium import DenseElasticity, ModalElasticity
from exudyn_ehd.joint.bore.shapes import ModalBore, NodalBore
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.seams import Effects
from exudyn_ehd.solid.bush import ANCFBush, ModalBush
from exudyn_ehd.solid.fe_bore import FEBore, ReducedBore
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.static_equilibrium import held_stiffness
from exudyn_ehd.solid.static_modes import bore_modes
from exudyn_ehd.status import InputError


def elastic_model(bearing: JournalBearing, start_angle: float, effects: Effects) -> ElasticBearingModel:
    """Model of a bearing whose ``bush`` is not None."""
    bush = bearing.bush
    if isinstance(bush, ModalBush):
        modes = bore_modes(bush)
        return ElasticBearingModel(
            bearing,
            lambda grid: ModalBore(modes, grid),
            elasticity=ModalElasticity(modes.stiffness),
            start_angle=start_angle,
            effects=effects,
        )
    if isinstance(bush, ReducedBore):
        reduced = bush
        return ElasticBearingModel(
            bearing,
            lambda grid: ModalBore(reduced, grid),
            elasticity=DenseElasticity(lambda: reduced.stiffness_matrix),
            start_angle=start_angle,
            effects=effects,
        )
    if isinstance(bush, FEBore):
        raise InputError(
            "JournalBearing.bush=FEBore(...) takes its modes from the body that is the joint's housing: give "
            "CreateLubricatedJoint an ObjectFFRFreducedOrder as itemNumbers[0]; for other bodies, and for a bearing by "
            "itself, take a ModalBush(...)."
        )
    assert isinstance(bush, ANCFBush)
    mesh = bush.build_mesh()
    return ElasticBearingModel(
        bearing,
        lambda grid: NodalBore(mesh.bore, grid),
        elasticity=DenseElasticity(lambda: bore_stiffness(bush)),
        start_angle=start_angle,
        effects=effects,
    )


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
