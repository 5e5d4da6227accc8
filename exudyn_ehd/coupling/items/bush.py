"""Nodal bush as an object of an Exudyn model.

One ``ObjectGenericODE2`` over ``NodePoint`` nodes has a constant sparse mass, and force and Jacobian of the total
Lagrangian solid. Nodes that are supported in three directions become ``NodePointGround`` without equations. A single
supported direction remains a coordinate, but is decoupled from the mesh and held by a spring 1e9 times stiffer than the
mesh. So the support of the mesh is exact, and forces of other items on this coordinate go to ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items

from exudyn_ehd.coupling.contract import CURRENT, Index, NodeIndex, Side, require_system
from exudyn_ehd.coupling.items.bush_equations import BushEquations, RigidPart
from exudyn_ehd.coupling.items.joint_frame import checked_rotation
from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.coupling.items.reduced_bodies import Carrier, initial_frame, positions, velocities
from exudyn_ehd.solid.bush import ANCFBush
from exudyn_ehd.solid.elements.element import face_of
from exudyn_ehd.solid.loads import BushLoad
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.total_lagrange import StressRecovery, TotalLagrange
from exudyn_ehd.status import InputError, require_type, require_vector


@dataclass(frozen=True, kw_only=True, eq=False)
class Support:
    """Support of a bush: nodes that cannot move in some global directions.

    Parameters
    ----------
    nodes : ndarray of int
        Mesh node numbers, for example ``mesh.end_low.nodes`` or ``mesh.generatrix(...).nodes``.
    directions : three bools, default (True, True, True)
        True for each of the global x, y, z in which they are held.

    Examples
    --------
    After the example of `BushMesh`:

    >>> held = ehd.Support(nodes=bush.end_low.nodes, directions=(False, False, True))  # axially
    """

    nodes: np.ndarray
    directions: tuple[bool, bool, bool] = (True, True, True)


@dataclass(frozen=True, kw_only=True)
class FreeOuter:
    """Option ``outer`` of a bush: its outer surface is free.

    If such a bush spins, take 40 or more steps a turn and a spectral radius of 0.6. Its nodes have absolute
    coordinates, on which Exudyn's integrator loses angular momentum with the square of the angle per step. A ring of
    any wall loses:

    - 20 steps a turn: 3.1 % in the first turn, 0.25 % in each later one;
    - 40 steps a turn: 0.82 %, then 0.035 %;
    - 80 steps a turn: 0.21 %, then 0.005 %.

    With fewer than 15 steps a turn motion and strains are useless, and elements turn inside out, which ends the run.
    At a spectral radius of 0.8 this limit is 40 steps, at 0.9 it is 80, at 1 even 120 steps are too few. A joint on
    such a mesh warns.

    Examples
    --------
    >>> outer = ehd.FreeOuter()  # for CreateFlexibleBush(outer=...), with supports or in flight
    """


@dataclass(frozen=True, kw_only=True)
class FixedOuter:
    """Option ``outer`` of a bush: its outer surface is fixed in space.

    Examples
    --------
    >>> outer = ehd.FixedOuter()  # for CreateFlexibleBush(outer=...)
    """


@dataclass(frozen=True, kw_only=True)
class CarriedOuter:
    """Option ``outer`` of a bush: its outer surface moves with the rigid frame of a body, without constraint equations.

    Parameters
    ----------
    itemNumber : exudyn.ObjectIndex, NodeIndex or MarkerIndex
        The body, its node or a rigid marker on it, as in ``CreateLubricatedJoint.itemNumbers``: rigid and planar
        bodies, beams and cables, links of kinematic trees, finite-element bodies. The body keeps its own mass and
        inertia and the bush adds its own; for the bush's weight give a `Gravity` among its loads. With a Lie group node
        (RotationRotationVector) use full Newton: Exudyn 1.13.6 was seen to end at a wrong attitude, without a message,
        when its modified Newton restarts often. Euler parameters and Rxyz show no such effect.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> outer = ehd.CarriedOuter(itemNumber=shaft)  # for CreateFlexibleBush(outer=...)
    """

    itemNumber: Index


@dataclass(frozen=True, kw_only=True, eq=False)
class FlexibleBush:
    """A bush in a model, from `CreateFlexibleBush`: its items in Exudyn, displacements, stresses, energy.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    mesh : BushMesh
        Bush frame; surfaces and lines for loads, supports and films.
    solid : TotalLagrange
        Solid of the mesh at its place in the model; its displacements are in the global frame.
    objectNumber : exudyn.ObjectIndex
    nodeNumbers : ndarray of int, shape (n,)
        Number of Exudyn's node for every mesh node; -1 where the mesh node moves with the carrier.
    equations : BushEquations
        Equations of motion, for internal use.

    Examples
    --------
    After the example of `CreateFlexibleBush`:

    >>> mbs.Assemble()
    >>> float(abs(flexible.displacements()).max())  # m
    0.0
    """

    mbs: exu.MainSystem
    mesh: BushMesh
    solid: TotalLagrange
    objectNumber: Index
    nodeNumbers: np.ndarray
    equations: BushEquations

    def coordinates(self, configuration: exu.ConfigurationType = CURRENT) -> np.ndarray:
        """Return the object's coordinates q without reference values."""
        places = self.mbs.systemData.GetObjectLTGODE2(int(self.objectNumber))
        return np.asarray(self.mbs.systemData.GetODE2Coordinates(configuration))[places]

    def coordinates_t(self, configuration: exu.ConfigurationType = CURRENT) -> np.ndarray:
        """Return the rates dq/dt of the object's coordinates."""
        places = self.mbs.systemData.GetObjectLTGODE2(int(self.objectNumber))
        return np.asarray(self.mbs.systemData.GetODE2Coordinates_t(configuration))[places]

    def displacements(self, configuration: exu.ConfigurationType = CURRENT) -> np.ndarray:
        """Return the displacement of all mesh nodes, shape (n, 3) [m], global frame."""
        return self._motion(configuration)[0]

    def velocities(self, configuration: exu.ConfigurationType = CURRENT) -> np.ndarray:
        """Return the velocity of all mesh nodes, shape (n, 3) [m/s], global frame."""
        return self._motion(configuration)[1]

    def _motion(self, configuration: exu.ConfigurationType) -> tuple[np.ndarray, np.ndarray]:
        q, q_t = self.coordinates(configuration), self.coordinates_t(configuration)
        return self.equations.motion(q, q_t, configuration)

    @property
    def stress(self) -> StressRecovery:
        """Object that computes stresses from `displacements`."""
        return StressRecovery(mesh=self.solid.mesh, material=self.solid.material)

    def energy(self, configuration: exu.ConfigurationType = CURRENT) -> tuple[float, float]:
        """Return strain and kinetic energy [J], without kinetic energy that counts as the housing's."""
        u, v = self._motion(configuration)
        kinetic = 0.5 * float(np.einsum("ni,ni->", v, self.solid.scalar_mass @ v))
        return self.solid.energy(u), kinetic - self._contained()[0]

    def momentum(self, configuration: exu.ConfigurationType = CURRENT) -> tuple[np.ndarray, np.ndarray]:
        """Return linear momentum [kg m/s] and angular momentum about the global origin [kg m^2/s].

        If the housing's mass contains the bush, the part that counts as the housing's is omitted.
        """
        u, v = self._motion(configuration)
        flow, (_, linear, angular) = self.solid.scalar_mass @ v, self._contained()
        return flow.sum(axis=0) - linear, np.cross(self.solid.mesh.nodes + u, flow).sum(axis=0) - angular

    def _contained(self) -> tuple[float, np.ndarray, np.ndarray]:
        """Kinetic energy and momenta of the bush that count as the carrier's, at the state of the last `_motion`."""
        equations = self.equations
        if equations.contained is None or equations.carrier is None:
            return 0.0, np.zeros(3), np.zeros(3)
        return equations.contained.momenta(equations.carrier.side.frame)


def CreateFlexibleBush(
    mbs: exu.MainSystem,
    name: str = "",
    *,
    bush: ANCFBush,
    outer: FreeOuter | FixedOuter | CarriedOuter,
    position: Sequence[float] = (0.0, 0.0, 0.0),
    rotationMatrix: np.ndarray | None = None,
    supports: Sequence[Support] = (),
    loads: Sequence[BushLoad] = (),
    initialVelocity: Sequence[float] = (0.0, 0.0, 0.0),
    initialAngularVelocity: Sequence[float] = (0.0, 0.0, 0.0),
    show: bool = True,
    color: Sequence[float] = (0.6, 0.6, 0.7, 1.0),
) -> FlexibleBush:
    """Add a flexible bush to a model.

    For bushes under loads of your own, without an oil film; a bearing gets its bush by ``JournalBearing(bush=...)``.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    name : str, default ""
        Name of the object.
    bush : ANCFBush
        Mesh, material and damping.
    outer : FreeOuter, FixedOuter or CarriedOuter
        Support of the outer surface.
    position : three numbers, default (0.0, 0.0, 0.0)
        Position of the bush frame's origin in the reference configuration, global frame [m].
    rotationMatrix : ndarray, shape (3, 3) or None, default None
        Rotation from the bush frame to the global frame (global vector = matrix @ bush vector); identity by default.
    supports : sequence of Support, default ()
        Nodes that can't move.
    loads : sequence of LineLoad, SurfaceLoad, DeadPressure, FollowerPressure or Gravity, default ()
        Loads; their vectors are in the global frame.
    initialVelocity, initialAngularVelocity : three numbers, default (0.0, 0.0, 0.0)
        Rigid initial motion: velocity of ``position`` [m/s] and angular velocity [rad/s], global frame. A carried bush
        takes its carrier's motion instead.
    show : bool, default True
        Draw the bush in Exudyn's renderer.
    color : (4,), default (0.6, 0.6, 0.7, 1.0)
        Colour of the bush, RGBA.

    Returns
    -------
    FlexibleBush

    Raises
    ------
    InputError
        For arguments of the wrong kind; ground as carrier; supports of nodes that the mesh does not have or that a
        carrier holds; a ``mass_rate`` of damping on a carried bush.

    Examples
    --------
    After the examples of `HollowCylinder` and `SaintVenantKirchhoff`:

    >>> SC = exu.SystemContainer()
    >>> mbs = SC.AddSystem()
    >>> bush = ehd.ANCFBush(mesh=mesh, material=steel)
    >>> flexible = ehd.CreateFlexibleBush(mbs, "bush", bush=bush, outer=ehd.FixedOuter())
    >>> flexible.nodeNumbers.shape
    (304,)
    """
    require_system("CreateFlexibleBush", mbs)
    require_type("CreateFlexibleBush.bush", bush, ANCFBush)
    require_type("CreateFlexibleBush.outer", outer, FreeOuter, FixedOuter, CarriedOuter)
    where = "CreateFlexibleBush.rotationMatrix"
    rotation = np.eye(3) if rotationMatrix is None else checked_rotation(where, rotationMatrix)
    place = require_vector("CreateFlexibleBush.position", position, 3, "m")
    carry = _carried(mbs, outer.itemNumber, place, rotation) if isinstance(outer, CarriedOuter) else None
    velocity = require_vector("CreateFlexibleBush.initialVelocity", initialVelocity, 3, "m/s")
    omega = require_vector("CreateFlexibleBush.initialAngularVelocity", initialAngularVelocity, 3, "rad/s")
    return add_bush(
        mbs,
        name,
        bush,
        carry,
        (place, rotation),
        fixed=isinstance(outer, FixedOuter),
        supports=supports,
        loads=loads,
        start=(velocity, omega),
        show=show,
        color=color,
    )


def _carried(mbs: exu.MainSystem, number: Index, place: np.ndarray, rotation: np.ndarray) -> tuple[Side, np.ndarray]:
    """Side of the bush's frame on an item, and its point (3,) in the reference configuration, global [m]."""
    where = "CarriedOuter.itemNumber"
    item = resolve(mbs, where, number)
    if not item.nodes:
        raise InputError(f"{where} must be a body that moves, got ground; use FixedOuter() for ground.")
    if item.planar and abs(rotation[2, 2]) < 1.0 - 1e-12:
        raise InputError(
            "CreateFlexibleBush.rotationMatrix must keep z normal to the plane of a planar carrier, got the bush axis "
            f"{rotation[:, 2]}."
        )
    point = item.position if item.is_marker else place
    return item.side(point, rotation), point


def add_bush(
    mbs: exu.MainSystem,
    name: str,
    bush: ANCFBush,
    mount: tuple[Side, np.ndarray] | None,
    place: tuple[np.ndarray, np.ndarray],
    *,
    contained: bool = False,
    fixed: bool = False,
    supports: Sequence[Support] = (),
    loads: Sequence[BushLoad] = (),
    start: tuple[np.ndarray, np.ndarray] = (np.zeros(3), np.zeros(3)),
    show: bool = True,
    color: Sequence[float] = (0.6, 0.6, 0.7, 1.0),
) -> FlexibleBush:
    """Add a bush on a mount; `CreateFlexibleBush` calls this after its checks of arguments.

    Parameters
    ----------
    mount : (Side, ndarray (3,)) or None
        Side whose axes are those of the bush, and its point in the reference configuration, global [m]. None: the outer
        surface is ``fixed`` or free.
    place : ndarray (3,), ndarray (3, 3)
        Bush frame in the reference configuration, global [m].
    contained : bool
        True if the mass of the carrier already contains that of the bush.
    start : two ndarrays (3,)
        Initial velocity [m/s] and angular velocity [rad/s] without a mount.
    mbs, name, bush, supports, loads, show, color
        As in `CreateFlexibleBush`.
    """
    position, rotation = place
    mesh = bush.build_mesh()
    solid = bush.solid(replace(mesh, nodes=position + mesh.nodes @ rotation.T))
    held = _held_directions(mesh, supports)
    carrier = None
    slaved = np.zeros(len(mesh.nodes), dtype=bool)
    local = mesh.nodes
    if fixed:
        held[mesh.outer.nodes] = True
    elif mount is not None:
        slaved[mesh.outer.nodes] = True
        local = mesh.nodes + rotation.T @ (position - mount[1])
        carrier = Carrier(mbs, mount[0], local[slaved])
        if held[slaved].any():
            raise InputError(
                "CreateFlexibleBush.supports must leave the outer surface to its carrier, got supported outer nodes; "
                "support the carrier instead."
            )
    mass_rate = 0.0 if bush.damping is None else bush.damping.mass_rate
    if carrier is not None and mass_rate > 0.0:
        raise InputError(
            f"ANCFBush.damping with outer=CarriedOuter must have mass_rate = 0, got {mass_rate:g} 1/s: it would brake "
            "the carrier; use stiffness_time."
        )
    equations = BushEquations(
        name,
        solid=solid,
        held=held,
        slaved=slaved,
        carrier=carrier,
        loads=loads,
        mass_rate=mass_rate,
        contained=RigidPart(local, solid.scalar_mass) if contained else None,
    )
    X = solid.mesh.nodes
    if mount is None:
        u, v = np.zeros_like(X), start[0] + np.cross(start[1], X - position)
    else:
        initial = initial_frame(mbs, mount[0])
        u, v = positions(initial, local) - X, velocities(initial, local)
    numbers = _add_nodes(mbs, equations, u, v)
    return _add_object(mbs, mesh, equations, numbers, show, color)


def _held_directions(mesh: BushMesh, supports: Sequence[Support]) -> np.ndarray:
    held = np.zeros((len(mesh.nodes), 3), dtype=bool)
    for support in supports:
        nodes = np.asarray(support.nodes)
        if nodes.size == 0 or nodes.min() < 0 or nodes.max() >= len(held):
            raise InputError(
                f"Support.nodes must be mesh nodes from 0 to {len(held) - 1}, got {support.nodes!r}; take them from a "
                "surface or a generatrix of the mesh."
            )
        held[np.ix_(nodes.ravel(), np.asarray(support.directions, dtype=bool).nonzero()[0])] = True
    return held


def _add_nodes(mbs: exu.MainSystem, equations: BushEquations, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    numbers = np.full(len(u), -1)
    X, held = equations.solid.mesh.nodes, equations.held
    v = np.where(held, 0.0, v)
    for i in np.flatnonzero(~equations.slaved):
        if held[i].all():
            node = items.NodePointGround(referenceCoordinates=X[i], visualization=items.VNodePointGround(show=False))
        else:
            node = items.NodePoint(
                referenceCoordinates=X[i],
                initialCoordinates=u[i],
                initialVelocities=v[i],
                visualization=items.VNodePoint(show=False),
            )
        numbers[i] = int(mbs.AddNode(node))
    return numbers


def _add_object(
    mbs: exu.MainSystem,
    mesh: BushMesh,
    equations: BushEquations,
    numbers: np.ndarray,
    show: bool,
    color: Sequence[float],
) -> FlexibleBush:
    nodes = [NodeIndex(int(i)) for i in numbers[numbers >= 0]]
    carrier = equations.carrier
    arguments: dict = {"forceUserFunction": equations.force, "jacobianUserFunction": equations.jacobian}
    if carrier is None:
        container = exu.MatrixContainer()
        container.SetWithSparseMatrix(equations.mass(None), useDenseMatrix=False)
        arguments["massMatrix"] = container
    else:
        nodes += carrier.side.nodes
        arguments["massMatrixUserFunction"] = equations.mass_at
    picture = items.VObjectGenericODE2(
        show=show, color=list(color), triangleMesh=_triangles(mesh, numbers), showNodes=False
    )
    number = mbs.AddObject(
        items.ObjectGenericODE2(name=equations.name, nodeNumbers=nodes, visualization=picture, **arguments)
    )
    return FlexibleBush(
        mbs=mbs, mesh=mesh, solid=equations.solid, objectNumber=number, nodeNumbers=numbers, equations=equations
    )


def _triangles(mesh: BushMesh, numbers: np.ndarray) -> np.ndarray:
    """Triangles of the boundary, by the object's node numbers, shape (m, 3)."""
    own = np.cumsum(numbers >= 0) - 1
    faces = mesh.boundary[(numbers[mesh.boundary] >= 0).all(axis=1)]
    return own[faces[:, face_of(faces).triangles].reshape(-1, 3)]
