"""The Exudyn models of the moving scenes, planar: a rotor on one bearing and two slider-cranks.

Every function returns the assembled model and its lubricated joint.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.api import CreateLubricatedJoint
from exudyn_ehd.coupling.handle import LubricatedJoint
from exudyn_ehd.joint.static.equilibrium import equilibrium

Built = tuple[Any, LubricatedJoint]
# Friction changes the spin by less than 1e-6 of it in any scene, kg m2.
HUGE_INERTIA = 1e4
OfTime = Callable[[float], float]


def _new() -> tuple[Any, Any]:
    """A model and its marker at a fixed coordinate of value 0."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddNode(eii.NodePointGround())
    return mbs, mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))


def _body(mbs: Any, mass: float, inertia: float, x: float, velocity: tuple[float, float, float], **node: Any) -> Any:
    """Node and body with its reference point at (x, 0); velocities in x, y and spin."""
    item = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0], initialVelocities=[*velocity], **node))
    return item, mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=item, mass=mass, inertia=inertia))


def _prescribe(
    mbs: Any, origin: Any, node: Any, coordinate: int, value: OfTime | None = None, rate: OfTime | None = None
) -> None:
    marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    functions: dict[str, Any] = {}
    if value is not None and rate is not None:
        functions["offsetUserFunction"] = lambda mbs, t, item, offset: value(t)
        functions["offsetUserFunction_t"] = lambda mbs, t, item, offset: rate(t)
    mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[origin, marker], **functions))


def rotor(
    bearing: JournalBearing,
    *,
    mass: float,
    load: tuple[float, float],
    angle: OfTime,
    spin: OfTime,
    position: tuple[float, float] = (0.0, 0.0),
    driven: bool = True,
) -> Built:
    """A disc of ``mass`` (kg), rotation prescribed (rad, rad/s), free in x and y under ``load`` (N).

    Without ``driven`` it keeps its first spin by a huge inertia: explicit integrators know no constraints.
    """
    mbs, joints = rotors(bearing, 1, mass=mass, load=load, angle=angle, spin=spin, position=position, driven=driven)
    return mbs, joints[0]


def rotors(
    bearing: JournalBearing,
    count: int,
    *,
    mass: float,
    load: tuple[float, float],
    angle: OfTime,
    spin: OfTime,
    position: tuple[float, float] = (0.0, 0.0),
    driven: bool = True,
) -> tuple[Any, list[LubricatedJoint]]:
    """``count`` independent rotors in one model, parameters as for `rotor`."""
    mbs, origin = _new()
    ground = mbs.AddObject(eii.ObjectGround())
    joints = []
    for k in range(count):
        inertia = 1.0 if driven else HUGE_INERTIA
        node, body = _body(mbs, mass, inertia, 0.0, (0.0, 0.0, spin(0.0)), initialCoordinates=[*position, 0.0])
        if driven:
            _prescribe(mbs, origin, node, 2, angle, spin)
        centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))
        mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[*load, 0.0]))
        joints.append(
            CreateLubricatedJoint(
                mbs,
                name=f"bearing {k}",
                itemNumbers=[ground, body],
                position=[0, 0, 0],
                axis=[0, 0, 1],
                bearing=bearing,
            )
        )
    mbs.Assemble()
    return mbs, joints


def slider_crank(
    bearing: JournalBearing,
    *,
    crank: float,
    rod: float,
    masses: tuple[float, float, float],
    inertias: tuple[float, float],
    spin: float,
    piston_force: OfTime | None = None,
    big_end: bool = False,
) -> Built:
    """A slider-crank at constant spin from the outer dead centre; a lubricated pin at the slider or at the big end.

    Parameters
    ----------
    bearing : JournalBearing
        Its housing is the rod.
    crank, rod : float
        Lengths, m.
    masses, inertias : floats
        Of crank, rod, slider (kg); of crank about its axis and rod about its middle (kg m2).
    spin : float
        rad/s.
    piston_force : function of time, optional
        On the slider in x, N.
    big_end : bool
        Lubricated joint between crank and rod; otherwise between rod and slider.
    """
    mbs, origin = _new()
    # the crank's body turns about its reference point
    crank_node, crank_body = _body(mbs, masses[0], inertias[0], 0.0, (0.0, 0.0, spin))
    _, rod_body = _body(mbs, masses[1], inertias[1], crank + rod / 2, (0.0, spin * crank / 2, -spin * crank / rod))
    slider_node, slider = _body(mbs, masses[2], 1e-4, crank + rod, (0.0, 0.0, 0.0))
    for coordinate in (0, 1):
        _prescribe(mbs, origin, crank_node, coordinate)
    _prescribe(mbs, origin, crank_node, 2, lambda t: spin * t, lambda t: spin)
    for coordinate in (1, 2):
        _prescribe(mbs, origin, slider_node, coordinate)

    def marker(body: Any, x: float) -> Any:
        return mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0.0, 0.0]))

    if big_end:
        pins = [marker(rod_body, rod / 2), marker(slider, 0.0)]
        items, place = [rod_body, crank_body], crank
    else:
        pins = [marker(crank_body, crank), marker(rod_body, -rod / 2)]
        items, place = [rod_body, slider], crank + rod
    mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=pins))
    if piston_force is not None:
        force = piston_force
        mbs.AddLoad(
            eii.LoadForceVector(
                markerNumber=mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=slider_node)),
                loadVector=[0.0, 0.0, 0.0],
                loadVectorUserFunction=lambda mbs, t, load: [force(t), 0.0, 0.0],
            )
        )
    joint = CreateLubricatedJoint(
        mbs, name="bearing", itemNumbers=items, position=[place, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint


def whirling_rotor(
    bearing: JournalBearing, *, mass: float, load: tuple[float, float], spin: float, offset: tuple[float, float]
) -> Built:
    """`rotor` at constant spin, released at ``offset`` (m) from the equilibrium of its own film."""
    place = equilibrium(bearing, speed=spin, load=load).position
    motion = ConstantSpin(spin=spin)
    return rotor(
        bearing,
        mass=mass,
        load=load,
        angle=motion.angle,
        spin=motion.spin_at,
        position=(float(place[0]) + offset[0], float(place[1]) + offset[1]),
    )


@dataclass(frozen=True, kw_only=True)
class ConstantSpin:
    """Rotation at ``spin`` (rad/s)."""

    spin: float

    def spin_at(self, t: float) -> float:
        """rad/s."""
        return self.spin

    def angle(self, t: float) -> float:
        """rad."""
        return self.spin * t


@dataclass(frozen=True, kw_only=True)
class StartStop:
    """Rotation that starts and stops within ``end`` (s): spin = top sin^2(pi t / end)."""

    top: float
    end: float

    def spin_at(self, t: float) -> float:
        """rad/s."""
        return self.top * math.sin(math.pi * t / self.end) ** 2

    def angle(self, t: float) -> float:
        """rad."""
        return 0.5 * self.top * (t - self.end / (2.0 * math.pi) * math.sin(2.0 * math.pi * t / self.end))


@dataclass(frozen=True, kw_only=True)
class GasPulse:
    """Force on a piston in x: a pulse of ``peak`` (N) after the outer dead centre of every second turn."""

    spin: float
    peak: float
    width: float

    def __call__(self, t: float) -> float:
        """N."""
        distance = math.remainder(self.spin * t - 2.4 * math.pi, 4.0 * math.pi)
        return -self.peak * math.exp(-((distance / self.width) ** 2))
