"""From the item numbers of a scene (body, ground, node, rigid marker) to the carriers of a joint frame."""

from __future__ import annotations

import exudyn as exu

from exudyn_ehd.coupling.contract import Index, MarkerIndex, NodeIndex, ObjectIndex
from exudyn_ehd.coupling.items.bodies import MASS_POINTS, body_item, node_item
from exudyn_ehd.coupling.items.item import Item
from exudyn_ehd.coupling.items.markers import marker_item
from exudyn_ehd.status import InputError


def resolve(mbs: exu.MainSystem, where: str, number: object) -> Item:
    """Find out what an item number stands for.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system.
    where : str
        Name of the argument for messages.
    number : exudyn.ObjectIndex, NodeIndex or MarkerIndex
        The item; an int counts as an object, as in Exudyn.

    Raises
    ------
    InputError
        If it is no such item, or nothing that can turn.
    """
    try:
        if isinstance(number, MarkerIndex):
            return marker_item(mbs, where, number)
        if isinstance(number, NodeIndex):
            return node_item(mbs, where, number)
        if isinstance(number, ObjectIndex) or (isinstance(number, int) and not isinstance(number, bool)):
            return body_item(mbs, where, ObjectIndex(int(number)))
    except exu.ExudynError as error:
        raise InputError(f"{where} is not an item of this system: {number!r} ({error}).") from None
    raise InputError(
        f"{where} must be an ObjectIndex (body or ground), a NodeIndex (rigid-body, beam, cable or point node) or a "
        f"MarkerIndex (rigid marker), got {number!r}; pass what AddObject, AddNode, AddMarker or mbs.Create... "
        "returned."
    )


def body_of_node(mbs: exu.MainSystem, node: Index) -> Index | None:
    """The rigid body or mass point that moves ``node``, or None if there is none yet."""
    for i in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(i)
        if body["objectType"] in ("RigidBody", "RigidBody2D", *MASS_POINTS) and int(body["nodeNumber"]) == int(node):
            return ObjectIndex(i)
    return None
