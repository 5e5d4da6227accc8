"""Kind of element of a connectivity."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.solid.elements.element import Element
from exudyn_ehd.solid.elements.faces import face_of
from exudyn_ehd.solid.elements.hex20 import HEX20
from exudyn_ehd.solid.elements.tet10 import TET10

ELEMENTS = (HEX20, TET10)


def element_of(elements: np.ndarray) -> Element:
    """The element with as many nodes as a connectivity (m, n) has columns."""
    return next(element for element in ELEMENTS if element.size == elements.shape[1])


def boundary_faces(elements: np.ndarray) -> np.ndarray:
    """Faces (f, a) of elements (m, n) that belong to one element only."""
    own = element_of(elements).faces
    faces = elements[:, own].reshape(-1, own.shape[1])
    corners = np.sort(faces[:, : face_of(own).corners], axis=1)
    _, index, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    return faces[np.sort(index[count == 1])]
