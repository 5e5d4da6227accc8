"""Films on the end faces for the element of a joint, with a check of its start."""

from __future__ import annotations

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.items.carrier import initial_frame
from exudyn_ehd.coupling.kinematics.axial import centre_of
from exudyn_ehd.coupling.kinematics.relative import motion_of
from exudyn_ehd.joint.model.build import MESSAGE
from exudyn_ehd.joint.thrust import ThrustModel
from exudyn_ehd.progress import announced
from exudyn_ehd.status import InputError, Status


def add_faces(mbs: exu.MainSystem, element: FilmElement, items: tuple[Item, Item], offset: float) -> None:
    """Give an element the films on the end faces of its bearing.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    element : FilmElement
    items : pair of Item
        Housing and journal.
    offset : float
        Of `FilmElement`.

    Raises
    ------
    InputError
        If the journal starts outside its faces.
    """
    model, sides = ThrustModel(element.model.bearing), element.sides
    element.faces, element.offset = model, offset
    housing, journal = (initial_frame(mbs, item, side) for item, side in zip(items, sides, strict=True))
    with announced(MESSAGE):
        start = model.evaluate(np.append(motion_of(housing, journal), centre_of(housing, journal, offset)[2]))
        start.tangent()
    if start.status is not Status.CONVERGED:
        _, _, bx, by, *_, place = start.motion
        raise InputError(
            f"CreateLubricatedJoint: the journal is outside the thrust faces of '{element.failures.name}' in the "
            f"initial configuration: axial position {place:.6g} m, tilt ({bx:.3g}, {by:.3g}), smallest gap "
            f"{start.minimum_gap:.6g} m; check the initial positions, and whether ThrustFaces.clearance is that of one "
            "face."
        )
