"""Puts the items of a flexible bush into an Exudyn system and makes the film element on them."""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.coupling.bush.object import Mount, add_bush
from exudyn_ehd.coupling.contract import JointModel, NodeIndex, Side
from exudyn_ehd.coupling.element.modal import BoreFilmElement, ModalFilmElement, TurningFilmElement
from exudyn_ehd.coupling.element.modal_inertia import ModalInertia, describe
from exudyn_ehd.coupling.element.nodal import NodalFilmElement
from exudyn_ehd.coupling.element.settled_start import initial_coordinates, settle_body, undeformed
from exudyn_ehd.coupling.items.carrier import initial_frame
from exudyn_ehd.coupling.items.item import Item
from exudyn_ehd.coupling.items.object_mass import require_heavy_housing
from exudyn_ehd.coupling.items.own_equations import own_equations
from exudyn_ehd.coupling.items.reduced_bodies import FloatingBoreSide
from exudyn_ehd.joint.bore.shapes import ModalBore
from exudyn_ehd.joint.bore.solid import SolidElasticity
from exudyn_ehd.joint.model.build_flexible import TurningModel
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.solid.bush import ANCFBush
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.loads import Gravity
from exudyn_ehd.solid.modes.static import BoreModes
from exudyn_ehd.status import InputError

# Period over 2 pi of a mode on its numerical mass over the journal's radius, s/m: a thousandth of what sound takes.
NUMERICAL_PERIOD = 2e-7


def attach_bush(
    mbs: exu.MainSystem,
    model: JointModel,
    items: tuple[Item, Item],
    sides: tuple[Side, Side],
    place: tuple[np.ndarray, np.ndarray],
    name: str,
    show: bool,
    gravity: np.ndarray | None,
) -> tuple[BoreFilmElement, dict[str, object]]:
    """Add the bush of ``model`` (an `ElasticBearingModel`).

    Parameters
    ----------
    mbs : exudyn.MainSystem
    model : ElasticBearingModel
    items, sides : pairs
        Housing and journal; the sides are brought to the initial configuration.
    place : ndarray (3,), ndarray (3, 3)
        Joint point and joint frame in the reference configuration, global.
    name : str
        Of the joint.
    show : bool
        Draw the bush.
    gravity : ndarray (3,) or None
        For a nodal bush whose mass counts beside the housing's; None: the housing contains it [m/s^2].

    Returns
    -------
    element : BoreFilmElement
        The film on it.
    arguments : dict
        What the element's ObjectGenericODE2 needs besides nodes and functions.
    """
    assert isinstance(model, ElasticBearingModel)
    for item, side in zip(items, sides, strict=True):
        start = undeformed(mbs, item, side) if isinstance(side, FloatingBoreSide) else item
        side.frame[:] = initial_frame(mbs, start, side)
    if not isinstance(model.bore, ModalBore):
        return _attach_nodes(mbs, model, items[0], sides, place, name, show, gravity), {}
    if gravity is not None:
        raise InputError(
            f"CreateLubricatedJoint.bushGravity: mass and weight of the {type(model.bearing.yielding).__name__} of "
            f"joint '{name}' are its body's; leave it out, and let the body's mass and loads contain them."
        )
    if isinstance(model, TurningModel):
        settle_body(mbs, model, sides)
        _equip_body(mbs, items[1], model.turning.surface)
        return TurningFilmElement(model, *sides, sides[1].nodes[-1:], name), {}
    if isinstance(sides[0], FloatingBoreSide):
        # the body has nodes, mass and stiffness for the modes
        settle_body(mbs, model, sides)
        _equip_body(mbs, items[0], model.bore.modes)
        return ModalFilmElement(model, *sides, sides[0].nodes[-1:], name, model.bore), {}
    settled = initial_coordinates(model, sides)
    k = model.bore.size
    node = mbs.AddNode(
        eii.NodeGenericODE2(
            name=f"{name} bush modes",
            referenceCoordinates=[0.0] * k,
            initialCoordinates=[0.0] * k if settled is None else settled.tolist(),
            initialCoordinates_t=[0.0] * k,
            numberOfODE2Coordinates=k,
        )
    )
    modes = model.bore.modes
    mass = modes.mass if isinstance(modes, BoreModes) else None
    element = ModalFilmElement(model, *sides, [node], name, model.bore)
    if isinstance(modes, BoreModes) and mass is not None and sides[0].nodes:
        require_heavy_housing(mbs, items[0].node, describe(modes), name)
        element.inertia = ModalInertia(mbs, sides[0], modes)
        return element, {"massMatrixUserFunction": element.mass}
    if mass is None:
        element.is_massless = True
        mass = np.diag(element.stiffness * (NUMERICAL_PERIOD * model.bearing.journal_radius) ** 2)
    # the sides of markers find their size after Assemble only
    rigid = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for side in sides for node in side.nodes)
    return element, {"massMatrix": _mass_matrix(rigid, mass)}


def _equip_body(mbs: exu.MainSystem, item: Item, surface: object) -> None:
    """Give a body under the film its exact Jacobian, unless it shall keep Exudyn's or has user functions."""
    assert isinstance(surface, ReducedBore) and item.body is not None
    if surface.exact_jacobian and mbs.GetObjectParameter(item.body, "computeFFRFterms"):
        own_equations(mbs, item.body)


def _attach_nodes(
    mbs: exu.MainSystem,
    model: ElasticBearingModel,
    item: Item,
    sides: tuple[Side, Side],
    place: tuple[np.ndarray, np.ndarray],
    name: str,
    show: bool,
    gravity: np.ndarray | None,
) -> NodalFilmElement:
    solid = model.bearing.bush
    assert isinstance(solid, ANCFBush)
    mount = Mount(sides[0], sides[0].frame.copy(), place[0], gravity is None) if sides[0].nodes else None
    weight = [] if gravity is None else [Gravity(acceleration=gravity)]
    bush = add_bush(mbs, f"{name} bush", solid, mount, place, fixed=mount is None, show=show, loads=weight)
    if bush.equations.contained is not None:
        require_heavy_housing(mbs, item.node, bush.equations.contained.describe(), name)
    start = initial_coordinates(model, sides)
    if start is not None:
        assert isinstance(model.elasticity, SolidElasticity)
        u = model.elasticity.displacements @ sides[0].frame[:, :3].T
        for number, shift in zip(bush.nodeNumbers, u):
            if number >= 0 and shift.any():
                node = NodeIndex(int(number))
                initial = np.array(mbs.GetNodeParameter(node, "initialCoordinates")) + shift
                mbs.SetNodeParameter(node, "initialCoordinates", initial.tolist())
    nodes = [NodeIndex(int(i)) for i in bush.nodeNumbers[bush.mesh.bore.nodes]]
    return NodalFilmElement(model, *sides, nodes, name, bush)


def _mass_matrix(n: int, mass: np.ndarray) -> np.ndarray:
    """Mass (n + k, n + k) of the element: that of the modes (k, k), nothing on the n coordinates of the sides.

    A quasi-static bore gets a numerical mass, far too small to be felt: without one Exudyn finds no initial
    accelerations of the whole system. Those of the modes are zero, see `ModalFilmElement.force`.
    """
    whole = np.zeros((n + len(mass), n + len(mass)))
    whole[n:, n:] = mass
    return whole
