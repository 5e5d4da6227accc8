"""Puts the items of a flexible bush into an Exudyn system and makes the film element on them."""

from __future__ import annotations

import dataclasses
from typing import Any

import exudyn
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.coupling import kinematics
from exudyn_ehd.coupling.elastic_film import BoreFilmElement, ModalFilmElement
from exudyn_ehd.coupling.sides import NodeSide, Side
from exudyn_ehd.film.cavitation import SwiftStieber
from exudyn_ehd.joint.bore import ModalBore
from exudyn_ehd.joint.build import collect_effects
from exudyn_ehd.joint.elastic import ElasticBearingModel
from exudyn_ehd.status import Status

# the index types exist at run time, but not in the type stubs
exu: Any = exudyn
SIZE = 10
# Period over 2 pi of a mode on its numerical mass, s.
NUMERICAL_PERIOD = 1e-6


def attach_bush(
    mbs: Any, model: Any, sides: tuple[Side, Side], name: str
) -> tuple[BoreFilmElement, dict[str, Any]]:
    """Add the bush of ``model`` (an `ElasticBearingModel`).

    Returns
    -------
    element : BoreFilmElement
        The film on it.
    arguments : dict
        What the element's ObjectGenericODE2 needs beside nodes and functions.
    """
    assert isinstance(model.bore, ModalBore)
    start = initial_coordinates(model, sides)
    k = model.bore.size
    node = mbs.AddNode(
        eii.NodeGenericODE2(
            name=f"{name} bush modes",
            referenceCoordinates=[0.0] * k,
            initialCoordinates=[0.0] * k if start is None else start.tolist(),
            initialCoordinates_t=[0.0] * k,
            numberOfODE2Coordinates=k,
        )
    )
    element = ModalFilmElement(model, *sides, [node], name, model.bore.stiffness)
    return element, {} if start is None else {"massMatrix": _numerical_mass(element)}


def _numerical_mass(element: ModalFilmElement) -> np.ndarray:
    """Mass (n + k, n + k) that gives Exudyn's initial accelerations a solution; far too small to be felt.

    Only for a bore that starts in equilibrium: elsewhere it would start with an acceleration beyond all measure.
    """
    n, k = element.rigid_size, element.stiffness.size
    mass = np.zeros((n + k, n + k))
    mass[np.arange(n, n + k), np.arange(n, n + k)] = element.stiffness * NUMERICAL_PERIOD**2
    return mass


def initial_coordinates(model: Any, sides: tuple[Side, Side]) -> np.ndarray | None:
    """Coordinates (k,) of the bore in equilibrium with the film of the initial configuration, None if there is none.

    The sides' frames must be those of the initial configuration. A film that conserves mass starts flooded, and a flooded film's
    first instant is Swift-Stieber's.
    """
    if not all(isinstance(side, NodeSide) for side in sides):
        return None
    bearing = dataclasses.replace(model.bearing, thermal=None)
    if bearing.cavitation.conserves_mass:
        closure = SwiftStieber(cavity_pressure=bearing.cavitation.cavity_pressure)
        bearing = dataclasses.replace(bearing, cavitation=closure)
    film = ElasticBearingModel(
        bearing, lambda grid: model.bore, elasticity=model.elasticity, effects=collect_effects(bearing)
    )
    motion = np.empty(SIZE)
    kinematics.relative_motion(sides[0].frame, sides[1].frame, motion)
    settled = film.evaluate_steady(motion).status is Status.CONVERGED
    return film.coordinates.copy() if settled else None
