"""The bore or journal of a user's ObjectFFRFreducedOrder: its data as Exudyn holds them, and the frame that follows it.

The body's modal node serves twice in the film's object: in the body's side, for the rigid motion of the surface that
the modes cause, and as the surface's coordinates, for the rest. Exudyn adds up what an object hands to a node that it
lists twice, forces and Jacobians alike.
"""

from __future__ import annotations

import dataclasses

import exudyn as exu
import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.kinematics.relative import skew
from exudyn_ehd.coupling.kinematics.sides import NodeSide, floating_change, node_side
from exudyn_ehd.solid.fe_bore import FEBore, FESurface, ReducedBore, bore_faces, find_bore
from exudyn_ehd.solid.journal.turning import FEJournal, TurningJournal
from exudyn_ehd.status import InputError


def hold_fe_bore(
    mbs: exu.MainSystem, bearing: JournalBearing, housing: Item, point: np.ndarray, rotation: np.ndarray
) -> tuple[JournalBearing, Item]:
    """Bearing with the bore that was found in the housing, and the housing that moves with it.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    bearing : JournalBearing
        With an `FEBore` as bush.
    housing : Item
        An ObjectFFRFreducedOrder.
    point, rotation : ndarray (3,), (3, 3)
        Joint point [m] and joint frame in the reference configuration, global.

    Raises
    ------
    InputError
        If the housing is something else, or has no such bore.
    """
    bush = bearing.bush
    if not isinstance(bush, FEBore):
        raise InputError(
            "CreateLubricatedJoint.bearing: the bore of an ObjectFFRFreducedOrder deflects by its own modes with "
            f"bush=FEBore(fem=...), got {type(bush).__name__}(...); for another bush give MarkerSuperElementRigid on "
            "the body as itemNumbers[0]."
        )
    radius = bearing.journal_radius + bearing.radial_clearance
    reduced, housing = _find_surface(mbs, bush, "bush", housing, (radius, bearing.length), (point, rotation))
    return dataclasses.replace(bearing, bush=reduced), housing


def hold_fe_journal(
    mbs: exu.MainSystem, bearing: JournalBearing, journal: Item, point: np.ndarray, rotation: np.ndarray
) -> tuple[JournalBearing, Item]:
    """Return the bearing with the flexible journal of a body, and the journal's item, as `hold_fe_bore` does."""
    pin = bearing.journal
    if not isinstance(pin, FEJournal):
        raise InputError(
            "CreateLubricatedJoint.bearing: the journal of an ObjectFFRFreducedOrder deflects by its own modes with "
            f"journal=FEJournal(fem=...), got {type(pin).__name__}(...); for another one give MarkerSuperElementRigid "
            "on the body as itemNumbers[1]."
        )
    if bearing.thrust is not None:
        raise InputError(
            "JournalBearing.thrust=ThrustFaces(...) does not go with journal=FEJournal(...): its collars would move "
            "with the mean of the journal's surface; give another joint the faces, or leave them out."
        )
    size = bearing.journal_radius, bearing.length
    reduced, held = _find_surface(mbs, pin, "journal", journal, size, (point, rotation))
    mass = _centrifugal_mass(mbs, pin, journal, point, rotation)
    return dataclasses.replace(bearing, journal=TurningJournal(surface=reduced, mass=mass)), held


def _centrifugal_mass(
    mbs: exu.MainSystem, pin: FEJournal, item: Item, point: np.ndarray, rotation: np.ndarray
) -> np.ndarray:
    """Phi^T M x (k,) of the places x across the joint's axis, from which centrifugal forces push the modes, kg m."""
    data = mbs.GetObject(item.body)
    local = item.node_rotation.T @ rotation
    places = np.asarray(data["referencePositions"], dtype=float).reshape(-1, 3)
    across = (places - item.node_rotation.T @ (point - item.node_position)) @ local[:, :2] @ local[:, :2].T
    return np.asarray(data["modeBasis"], dtype=float).T @ (csr_matrix(pin.fem.massMatrix) @ across.ravel())


def _find_surface(
    mbs: exu.MainSystem,
    surface: FESurface,
    option: str,
    item: Item,
    size: tuple[float, float],
    place: tuple[np.ndarray, np.ndarray],
) -> tuple[ReducedBore, Item]:
    """Return the body's surface under a film of radius and length ``size``, and the item that moves with it."""
    where, (radius, length), (point, rotation) = (
        f"CreateLubricatedJoint.bearing with {option}={type(surface).__name__}(...)",
        size,
        place,
    )
    data = mbs.GetObject(item.body)
    basis = np.asarray(data["modeBasis"], dtype=float)
    local = item.node_rotation.T @ rotation
    origin = item.node_rotation.T @ (point - item.node_position)
    places = (np.asarray(data["referencePositions"], dtype=float).reshape(-1, 3) - origin) @ local
    outer = isinstance(surface, FEJournal)
    chosen = find_bore(where, places, radius, length, surface.radius_tolerance, surface.nodes, outer)
    if len(np.asarray(surface.fem.nodes["Position"])) != len(places):
        raise InputError(
            f"{where}: fem must be the FEMinterface that the body was made of, with {len(places)} nodes, got one with "
            f"{len(surface.fem.nodes['Position'])}."
        )
    faces = bore_faces(where, surface.fem, places, chosen)
    shapes = basis.reshape(len(places), 3, -1)[faces.nodes]
    reduced = ReducedBore(
        faces=faces,
        displacements=np.einsum("nik,ij->njk", shapes, local),
        stiffness_matrix=np.asarray(data["stiffnessMatrixReduced"].Convert2DenseMatrix()),
        radius=radius,
        length=length,
        settled=surface.settled,
        exact_jacobian=surface.exact_jacobian,
    )

    def build(point: np.ndarray, rotation: np.ndarray) -> FloatingBoreSide:
        return FloatingBoreSide(node_side(mbs, item.nodes[0]), item.nodes[1], origin, local, reduced.rigid)

    return reduced, dataclasses.replace(item, build=build)


class FloatingBoreSide:
    """Frame that follows a body's floating frame and the rigid part P q, Theta q of its bore's motion in the modes q.

    Position ``r + A (x0 + P q)``, rotation ``A exp(Theta q) R``.

    Parameters
    ----------
    frame : NodeSide
        The rigid node's own frame.
    modal_node : exudyn.NodeIndex
        Node of the modes.
    origin, rotation : ndarray (3,), (3, 3)
        Joint point x0 [m] and joint frame R in the body's frame.
    rigid : ndarray (6, k)
        P and Theta in the joint's frame.
    """

    def __init__(
        self, frame: NodeSide, modal_node: Index, origin: np.ndarray, rotation: np.ndarray, rigid: np.ndarray
    ) -> None:
        self.floating = frame
        self.nodes = [*frame.nodes, modal_node]
        self.origin, self.rotation = origin, rotation
        self.shift, self.turn = rotation @ rigid[:3], rotation @ rigid[3:]
        self.size = frame.size + rigid.shape[1]
        self.frame = np.zeros((3, 6))
        self.jac = np.zeros((4, 3, self.size))
        rest = np.zeros(self.size)
        self.update(None, rest, rest, None)

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,)."""
        n, floating = self.floating.size, self.floating
        if not np.isfinite(q.sum()):
            self.frame[:] = np.nan
            return
        floating.update(mbs, q[:n], q_t[:n], configuration)
        A, omega = floating.frame[:, :3], floating.frame[:, 5]
        turned, rate = _rotation(self.turn @ q[n:])
        self.jac[:2, :, :n] = floating.jac[:2]
        self.jac[0, :, n:] = A @ self.shift
        self.jac[1, :, n:] = A @ (rate @ self.turn)
        self.arm = A @ (self.origin + self.shift @ q[n:])
        S = skew(self.arm)
        self.jac[0, :, :n] -= S @ floating.jac[1]
        self.frame[:, :3] = A @ turned @ self.rotation
        self.frame[:, 3] = floating.frame[:, 3] + self.arm
        self.frame[:, 4] = floating.frame[:, 4] - S @ omega + self.jac[0, :, n:] @ q_t[n:]
        self.frame[:, 5] = omega + self.jac[1, :, n:] @ q_t[n:]

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        return floating_change(self.floating, q[: self.floating.size], self.arm, self.jac)


def _rotation(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """exp(angle) (3, 3), and T (3, 3) with its angular velocity T d(angle)/dt, in the frame before the rotation."""
    size = float(np.linalg.norm(angle))
    S = skew(angle)
    square = S @ S
    if size < 1e-4:
        # to 1e-16 and 1e-12: the next terms are of fourth order
        first, second, third = 1.0 - size**2 / 6.0, 0.5 - size**2 / 24.0, 1.0 / 6.0 - size**2 / 120.0
    else:
        first, second = np.sin(size) / size, 2.0 * (np.sin(0.5 * size) / size) ** 2
        third = (1.0 - first) / size**2
    return np.eye(3) + first * S + second * square, np.eye(3) + second * S + third * square
