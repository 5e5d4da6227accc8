"""Flexible bushes and journals of bearings in a rotor's system: their coordinates follow the films, and x is without
them.

Modes of a bush or a journal have no mass. With the journal they move as the balance of the film and its surface says,
which is part of the film's K, C and dynamic stiffness (`exudyn_ehd.joint.static.dynamic_stiffness`). The mesh of an
`ANCFBush` has mass. It counts as a rigid part of the housing, whose node carries its nodes: a bush is much stiffer than
its film, and its own vibrations are far above those of a rotor.
"""

from __future__ import annotations

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.element.nodal import NodalFilmElement
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.joint.bore.solid import SolidElasticity
from exudyn_ehd.joint.model.flexible import ElasticEvaluation
from exudyn_ehd.joint.model.rigid import Evaluation


class HeldBore:
    """Coordinates of the bush and the journal of one film; none of rigid surfaces and liners.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    element : FilmElement

    Attributes
    ----------
    places : (k,) array
        Places in the system's coordinates.
    housing : int
        Node that carries a mesh; -1 without one.
    reference : (n, 3) array
        Reference positions of the mesh's nodes that have coordinates, m.
    """

    def __init__(self, mbs: exu.MainSystem, element: FilmElement) -> None:
        bush = element.bush if isinstance(element, NodalFilmElement) else None
        nodes = element.bore_nodes if bush is None else bush.nodeNumbers
        found = [mbs.systemData.GetNodeLTGODE2(int(node)) if int(node) >= 0 else () for node in nodes]
        self.places = np.array([place for part in found for place in part], dtype=int)
        self.housing, self.reference, self.local, self._moves = -1, np.zeros((0, 3)), np.zeros((0, 3)), []
        if bush is not None:
            self._moves = [k for k, part in enumerate(found) if len(part)]
            self.reference, self.local = bush.solid.mesh.nodes[self._moves], bush.mesh.nodes[self._moves]
            self.housing = int(element.sides[0].nodes[0]) if element.sides[0].nodes else -1

    def enter(self, q: np.ndarray, evaluation: Evaluation, frame: np.ndarray) -> None:
        """Bring the system's q (n,) to a film's balance; ``frame`` is that of the housing."""
        if not isinstance(evaluation, ElasticEvaluation):
            return
        elasticity = evaluation.model.elasticity
        if isinstance(elasticity, SolidElasticity):
            moved = self.local + elasticity.displacements[self._moves]
            q[self.places] = (frame[:, 3] + moved @ frame[:, :3].T - self.reference).ravel()
        else:
            q[self.places] = evaluation.bore.coordinates
