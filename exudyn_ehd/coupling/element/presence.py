"""Check that the items of a joint still exist in its system, under the same numbers."""

from __future__ import annotations

import weakref
from typing import Any

import exudyn as exu

from exudyn_ehd.coupling.contract import Index, ObjectIndex, Side
from exudyn_ehd.coupling.kinematics.sides import MarkerSide
from exudyn_ehd.status import InputError


class Presence:
    """Items of one joint as they were when it was created.

    Exudyn's DeleteObject, DeleteNode and DeleteMarker renumber what is left, and its Reset leaves nothing; a joint that
    went on with its numbers would hold other bodies.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    name : str
        Name of the joint.
    owner : object
        Object whose method is the force function of the joint's object.
    number : exudyn.ObjectIndex
        The joint's object.
    sides : pair of Side
    """

    def __init__(self, mbs: exu.MainSystem, name: str, owner: object, number: Index, sides: tuple[Side, Side]) -> None:
        self.name, self.owner, self.number = name, weakref.ref(owner), int(number)
        self.nodes = _nodes(mbs, self.number)
        self.markers = [(side.marker, _marker(mbs, side.marker)) for side in sides if isinstance(side, MarkerSide)]

    def found(self, mbs: exu.MainSystem) -> int | None:
        """Number of the joint's object in the system; None if it is not there."""
        count = mbs.systemData.NumberOfObjects()
        for number in (self.number, *range(count)):
            if number < count and force_owner(mbs, number) is self.owner():
                return number
        return None

    def require(self, mbs: exu.MainSystem) -> None:
        """Raise `InputError` unless the joint is in the system, on the items that it was made on."""
        number = self.found(mbs)
        if number is None:
            raise InputError(
                f"LubricatedJoint '{self.name}': its object is no longer in the system, after mbs.Reset() or "
                "mbs.DeleteObject(...); create the joint again."
            )
        same = number == self.number and _nodes(mbs, number) == self.nodes
        for marker, as_made in self.markers:
            same = same and int(marker) < mbs.systemData.NumberOfMarkers() and _marker(mbs, marker) == as_made
        if same:
            return
        raise InputError(
            f"LubricatedJoint '{self.name}': items of the system were deleted after the joint was created, and Exudyn "
            f"has renumbered the others: the joint's object {self.number} on nodes {self.nodes} is now object {number} "
            f"on nodes {_nodes(mbs, number)}; delete items before CreateLubricatedJoint."
        )


def force_owner(mbs: exu.MainSystem, number: int) -> object:
    """Return the object whose method is the force function of an Exudyn object; None without such a function."""
    item = ObjectIndex(number)
    # only some objects have a force function
    if mbs.GetObject(item)["objectType"] != "GenericODE2":
        return None
    function: Any = mbs.GetObjectParameter(item, "forceUserFunction")
    return getattr(function["function"], "__self__", None) if isinstance(function, dict) else None


def _nodes(mbs: exu.MainSystem, number: int) -> list[int]:
    return [int(node) for node in mbs.GetObjectParameter(ObjectIndex(number), "nodeNumbers")]


def _marker(mbs: exu.MainSystem, number: Index) -> str:
    values = mbs.GetMarker(number)
    return repr({key: value for key, value in values.items() if key != "name" and not key.startswith("V")})
