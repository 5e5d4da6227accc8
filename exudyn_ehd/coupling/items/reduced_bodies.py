"""Bore or journal of a user's ObjectFFRFreducedOrder: its data in Exudyn, and the frame that moves with the surface.

The film's object lists the body's modal node twice: in the body's side, for the rigid motion of the surface by the
modes, and as the surface's coordinates, for the rest. Exudyn adds both contributions of an object to such a node,
forces and Jacobians.

Carrier of a bush's slaved nodes: points that move with the rigid frame of a side of a joint
--------------------------------------------------------------------------------------------
With the frame's position p, rotation A, velocity v, angular velocity omega and Jacobians Jp, Jr (see `kinematics`), a
point X of the bush's frame has the arm s = A X and

    x = p + s,   dx/dt = v + omega x s,   B = dx/dq = Jp - [s]x Jr,
    d2x/dt2 = B q_tt + Vq q_t + (Wq q_t) x s + omega x (omega x s),

where Vq, Wq are the derivatives of v and omega to q. They are zero for sides without derivatives of their Jacobians
(`MarkerSide`).
"""

from __future__ import annotations

import copy
import dataclasses
import weakref

import exudyn as exu
import numpy as np
from exudyn.lieGroupBasics import ExpSO3, TExpSO3
from scipy.sparse import csr_matrix

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import CURRENT, INITIAL, Index, Side
from exudyn_ehd.coupling.items.beams import node_coordinates, reference_pose
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.kinematics.sides import MarkerSide, NodeSide, floating_change, node_side
from exudyn_ehd.solid.fe_bore import FEBore, FESurface, ReducedBore, bore_faces, find_bore
from exudyn_ehd.solid.turning_journal import FEJournal, TurningJournal
from exudyn_ehd.status import SMALL, InputError


def hold_fe_surfaces(
    mbs: exu.MainSystem,
    bearing: JournalBearing,
    items: tuple[Item, Item],
    points: tuple[np.ndarray, np.ndarray],
    rotation: np.ndarray,
) -> tuple[JournalBearing, tuple[Item, Item]]:
    """Return the bearing with the surfaces of the reduced bodies, and both items with frames that move with them.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    bearing : JournalBearing
        Bearing with an `FEBore` as bush for an ObjectFFRFreducedOrder as housing, an `FEJournal` for one as journal.
    items : pair of Item
        Housing and journal.
    points, rotation : pair of ndarray (3,), ndarray (3, 3)
        Joint points [m] and joint frame in the reference configuration, global.

    Raises
    ------
    InputError
        If a body has no such surface, or if the bearing has no `FEBore` or `FEJournal` for it.
    """
    held = list(items)
    for k, (option, kind, name) in enumerate((("bush", FEBore, "bore"), ("journal", FEJournal, "journal"))):
        surface = getattr(bearing, option, None)
        if items[k].body is None or surface is None:
            continue
        if not isinstance(surface, kind):
            raise InputError(
                f"CreateLubricatedJoint.bearing: the {name} of an ObjectFFRFreducedOrder deflects by its own modes "
                f"with {option}={kind.__name__}(fem=...), got {type(surface).__name__}(...); for another {option} give "
                f"MarkerSuperElementRigid on the body as itemNumbers[{k}]."
            )
        if isinstance(surface, FEJournal) and bearing.thrust is not None:
            raise InputError(
                "JournalBearing.thrust=ThrustFaces(...) does not go with journal=FEJournal(...): its collars would "
                "move with the mean of the journal's surface; give another joint the faces, or leave them out."
            )
        size = bearing.journal_radius + (1 - k) * bearing.radial_clearance, bearing.length
        found, held[k] = _find_surface(mbs, surface, option, items[k], size, (points[k], rotation))
        if isinstance(found, TurningJournal):
            bearing = dataclasses.replace(bearing, journal=found)
        else:
            bearing = dataclasses.replace(bearing, bush=found)
    return bearing, (held[0], held[1])


def _find_surface(
    mbs: exu.MainSystem,
    surface: FESurface,
    option: str,
    item: Item,
    size: tuple[float, float],
    place: tuple[np.ndarray, np.ndarray],
) -> tuple[ReducedBore | TurningJournal, Item]:
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

    moved = dataclasses.replace(item, side=build)
    if not outer:
        return reduced, moved
    # the places across the joint's axis, from which centrifugal forces push the modes
    across = places[:, :2] @ local[:, :2].T
    mass = basis.T @ (csr_matrix(surface.fem.massMatrix) @ across.ravel())
    return TurningJournal(surface=reduced, mass=mass), moved


class FloatingBoreSide(Side):
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
        super().__init__([*frame.nodes, modal_node], frame.size + rigid.shape[1])
        self.floating = frame
        self.origin, self.rotation = origin, rotation
        self.shift, self.turn = rotation @ rigid[:3], rotation @ rigid[3:]
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
        A = floating.frame[:, :3]
        turn = self.turn @ q[n:]
        self.frame[:, 3:] = floating.frame[:, 3:]
        self.jac[:2, :, :n] = floating.jac[:2]
        self.jac[1, :, n:] = 0.0
        self.move_point(A @ (self.origin + self.shift @ q[n:]))
        self.jac[0, :, n:] = A @ self.shift
        self.jac[1, :, n:] = A @ (TExpSO3(-turn) @ self.turn)
        self.frame[:, :3] = A @ ExpSO3(turn) @ self.rotation
        self.frame[:, 4:] += (self.jac[:2, :, n:] @ q_t[n:]).T

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        return floating_change(self.floating, q[: self.floating.size], self.arm, self.jac)


class Carrier:
    """Points in the frame of a side.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    side : Side
        Side with the bush's frame; the carrier uses a copy with separate work arrays.
    local : ndarray (s, 3)
        X [m].
    """

    def __init__(self, mbs: exu.MainSystem, side: Side, local: np.ndarray) -> None:
        # weak reference: the system's user functions refer to the carrier, which must not keep the system alive
        self.mbs: exu.MainSystem = weakref.proxy(mbs)
        self.side: Side = copy.deepcopy(side)
        self.local = local
        self._bound = False

    def move(self, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType = CURRENT) -> None:
        """Update frame and Jacobians to the coordinates ``q`` and rates ``q_t`` (n,) of a ``configuration``."""
        if not self._bound:
            self.side.bind(self.mbs)
            self._bound = True
        self.side.update(self.mbs, q, q_t, configuration)

    def accelerations(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Accelerations at q_tt = 0, after `move` to this state: of the frame (6,), and of the points (s, 3) [m/s^2].

        Those of the frame are an acceleration and an angular one.
        """
        frame, arms, omega = self.side.change(self.mbs, q) @ q_t @ q_t, self._arms(), self.side.frame[:, 5]
        return frame, frame[:3] + np.cross(frame[3:], arms) + np.cross(omega, np.cross(omega, arms))

    def jacobian(self) -> np.ndarray:
        """Return B, shape (3 s, n)."""
        B = self.side.jac[0].T + np.cross(self.side.jac[1].T, self._arms()[:, None, :])
        return B.transpose(0, 2, 1).reshape(3 * len(self.local), -1)

    def force_derivative(self, q: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """Return d(B^T f)/dq (n, n) at constant global forces f, shape (s, 3) [N].

        It is the derivative for the resultants F = sum f and M = sum s x f at the frame, plus dM = sum (dphi x s) x f.
        """
        arms, turn = self._arms(), self.side.jac[1]
        load = np.concatenate((forces, np.cross(arms, forces)), axis=1).sum(axis=0)
        result = np.tensordot(load, self.side.change(self.mbs, q), 1)
        # (dphi x s) x f = s (dphi . f) - dphi (s . f)
        both = np.einsum("si,sj->ij", arms, forces)
        return np.asarray(result + turn.T @ (both - np.trace(both) * np.eye(3)) @ turn)

    def _arms(self) -> np.ndarray:
        return self.local @ self.side.frame[:, :3].T


def positions(frame: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Positions (s, 3) of points ``local`` (s, 3) of a frame (3, 6) [m]."""
    return frame[:, 3] + local @ frame[:, :3].T


def velocities(frame: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Velocities (s, 3) of points ``local`` (s, 3) of a frame (3, 6) [m/s]."""
    return frame[:, 4] + np.cross(frame[:, 5], local @ frame[:, :3].T)


def initial_frame(mbs: exu.MainSystem, side: Side, state: tuple[np.ndarray, np.ndarray] | None = None) -> np.ndarray:
    """Frame (3, 6) of a side in the initial configuration, before Assemble, or at a state (q, q_t)."""
    reference, initial, rates = node_coordinates(mbs, side.nodes)
    if not isinstance(side, MarkerSide):
        own: Side = copy.deepcopy(side)
        own.update(mbs, *((initial, rates) if state is None else state), INITIAL)
        return own.frame
    place, matrix = _marker_frame(mbs, side, reference + initial, reference)
    frame = np.zeros((3, 6))
    frame[:, :3], frame[:, 3] = matrix @ side.rotation, place
    fastest = np.abs(rates).max(initial=0.0)
    if fastest > 0.0:
        # m or rad over which velocities are found as differences of positions
        step = SMALL / fastest
        ends = [_marker_frame(mbs, side, reference + initial + s * step * rates, reference) for s in (1.0, -1.0)]
        frame[:, 4] = (ends[0][0] - ends[1][0]) / (2.0 * step)
        spin = (ends[0][1] - ends[1][1]) @ matrix.T / (2.0 * step)
        frame[:, 5] = 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])
    return frame


def _marker_frame(
    mbs: exu.MainSystem, side: MarkerSide, coordinates: np.ndarray, reference: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation of a marker at coordinates of its nodes.

    Before Assemble Exudyn knows the reference configuration only: the nodes' reference coordinates are moved and put
    back.
    """
    try:
        _set_reference(mbs, side.nodes, coordinates)
        return reference_pose(mbs.GetMarkerOutput, side.marker)
    finally:
        _set_reference(mbs, side.nodes, reference)


def _set_reference(mbs: exu.MainSystem, nodes: list[Index], coordinates: np.ndarray) -> None:
    start = 0
    for node in nodes:
        size = len(mbs.GetNodeParameter(node, "referenceCoordinates"))
        mbs.SetNodeParameter(node, "referenceCoordinates", coordinates[start : start + size].tolist())
        start += size
