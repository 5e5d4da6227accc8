"""Mechanisms: moving housings, several joints, closed loops, high speed, long runs."""

from __future__ import annotations

import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from hard_registry import hard_case
from hard_scene import CLEARANCE, SPEED, Rotor, bearing, settings, solve

import exudyn_ehd as ehd


@hard_case("housing spins with the journal", slow=True)
def spinning_pair():
    """Housing and journal turn together at 3000 rpm: no wedge in the film, whatever the speeds of the surfaces."""
    made = bearing()

    def housing(mbs):
        node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialVelocities=[0, 0, SPEED]))
        body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=10.0, inertia=0.01))
        pivot = [mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=b)) for b in (mbs.AddObject(eii.ObjectGround()), body)]
        mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=pivot))
        return body

    # a weight fixed in space: seen from the housing it turns backwards, and the film carries by squeeze
    rotor = Rotor(made, load=(0.0, -400.0), speed=None, spin=SPEED, housing=housing)
    run = rotor.run(0.06, 1e-4)
    h = run.history
    # the pair keeps its common spin: relative spin stays zero apart from the friction torque of nothing
    assert np.abs(h.motion[:, 8]).max() < 1e-3 * SPEED
    # a housing that turns under a fixed load is a bearing whose journal turns backwards at twice the
    # wedge: So with the sum of both surface speeds relative to the load, 2 omega instead of omega
    position = ehd.equilibrium(made, speed=2.0 * SPEED, load=(0.0, -400.0))
    assert abs(h.eccentricity_ratio[-1] - position.eccentricity_ratio) < 5e-3
    return run


@hard_case("moving frame", rejected=0)
def moving_frame():
    """The whole model flies at 100 m/s: gaps of micrometres are differences of
    metres, and not a digit may depend on it."""
    made = bearing()
    runs = []
    for speed in (0.0, 100.0):
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        bodies = []
        for mass, spin, x in ((1e4, 0.0, 0.0), (2.0, SPEED, 0.5 * CLEARANCE)):
            node = mbs.AddNode(
                eii.NodeRigidBody2D(
                    referenceCoordinates=[0, 0, 0],
                    initialCoordinates=[x, 0, 0],
                    initialVelocities=[speed, -0.3 * speed, spin],
                )
            )
            bodies.append(mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=mass)))
        marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=bodies[1]))
        mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, -1000.0, 0]))
        joint = ehd.CreateLubricatedJoint(
            mbs, name="flying", itemNumbers=bodies, position=[0, 0, 0], axis=[0, 0, 1], bearing=made
        )
        mbs.Assemble()
        runs.append(solve(mbs, [joint], settings(0.03, 1e-4)))
    rest, flight = (run.history for run in runs)
    # 3 m of flight carry rounding of 4e-16 m, a hundred-thousand-millionth of the clearance; Newton's tolerance is 1e-6
    assert np.abs(flight.eccentricity - rest.eccentricity).max() < 1e-5 * CLEARANCE
    assert np.allclose(flight.force, rest.force, atol=1e-3)
    return runs


def shaft(bearings, places, *, load, load_z, mass=3.0, inertia=(0.02, 2e-3), speed=SPEED, ideal=None):
    """A rigid shaft, free in space, in several bearings on ground at heights z."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    mbs.variables["container"] = container
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6, initialVelocities=[0, 0, 0, 0, 0, speed]))
    body = mbs.AddObject(
        eii.ObjectRigidBody(mass=mass, inertia=[inertia[0], inertia[0], inertia[1], 0, 0, 0], nodeNumber=node)
    )
    zero = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    turned = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=5))
    mbs.AddObject(
        eii.ObjectConnectorCoordinate(
            markerNumbers=[zero, turned],
            offsetUserFunction=lambda mbs, t, item, offset: speed * t,
            offsetUserFunction_t=lambda mbs, t, item, offset: speed,
        )
    )
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, load_z])),
            loadVector=[*load, 0],
        )
    )
    joints = [
        ehd.CreateLubricatedJoint(
            mbs,
            name=f"bearing {k}",
            itemNumbers=[ground, body],
            position=[0, 0, z],
            axis=[0, 0, 1],
            bearing=made,
            axial=ehd.Held() if k == 0 else ehd.Free(),
        )
        for k, (made, z) in enumerate(zip(bearings, places, strict=True))
    ]
    if ideal is not None:
        mbs.CreateGenericJoint(
            itemNumbers=[ground, body], position=[0, 0, ideal], constrainedAxes=[1, 1, 0, 0, 0, 0], show=False
        )
    mbs.Assemble()
    return mbs, joints


@hard_case("two joints on one shaft")
def two_joints():
    """Two films share a rigid shaft that tilts in both; the load off the middle loads them unequally."""
    made = bearing()
    mbs, joints = shaft([made, made], [-0.1, 0.1], load=(0.0, -2000.0), load_z=0.05)
    run = solve(mbs, joints, settings(0.06, 2e-4))
    one, two = run.histories
    # statics: 1/4 and 3/4 of the load, apart from the moments that the tilted films take themselves
    share = two.force[-1, 1] / 2000.0
    assert abs(share - 0.75) < 0.01
    assert abs((one.force[-1, 1] + two.force[-1, 1]) / 2000.0 - 1.0) < 5e-3
    lever = -0.1 * one.force[-1, 1] + 0.1 * two.force[-1, 1] - (one.moment[-1, 0] + two.moment[-1, 0])
    assert abs(lever / (2000.0 * 0.05) - 1.0) < 1e-2
    # both joints see the same tilt of the same shaft
    assert np.allclose(one.motion[:, 2:4], two.motion[:, 2:4], atol=1e-12)
    return run


@hard_case("three bearings on a rigid shaft", slow=True)
def three_bearings():
    """Statically indeterminate: with ideal joints the reactions have no
    solution; the films share the load by their stiffness."""
    made = bearing()
    mbs, joints = shaft([made] * 3, [-0.1, 0.0, 0.1], load=(0.0, -6000.0), load_z=0.0)
    run = solve(mbs, joints, settings(0.06, 2e-4))
    forces = np.array([h.force[-1, 1] for h in run.histories])
    # equal bearings on a shaft that stays parallel by symmetry: a third each
    assert np.allclose(forces, 2000.0, rtol=5e-3)
    eq = ehd.equilibrium(made, speed=SPEED, load=(0.0, -2000.0))
    for h in run.histories:
        assert np.hypot(*(h.eccentricity[-1] - eq.position)) < 5e-3 * CLEARANCE
    return run


@hard_case("redundant next to an ideal joint", slow=True)
def redundant():
    """A film in the same place as an ideal joint: kinematically redundant, and
    nothing is left for the film to carry."""
    made = bearing()
    mbs, joints = shaft([made, made], [-0.1, 0.1], load=(0.0, -2000.0), load_z=-0.1, ideal=-0.1)
    run = solve(mbs, joints, settings(0.02, 1e-4))
    h = run.history
    # the ideal joint keeps the shaft in the centre of the first bearing and takes the load there
    assert np.abs(h.eccentricity).max() < 1e-9 * CLEARANCE + 1e-12
    assert np.hypot(*h.force[-1, :2]) < 1.0
    assert np.hypot(*run.histories[1].force[-1, :2]) < 5.0
    return run


def crank(made, *, speed, turns, steps_per_turn, big_end=False):
    """Slider-crank (crank 50 mm, rod 120 mm, slider 0.14 kg) turning at
    ``speed`` with a lubricated gudgeon pin or big end."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    mbs.variables["container"] = container
    a, b = 0.05, 0.12
    ground = mbs.AddObject(eii.ObjectGround())

    def body(mass, inertia, x, v, spin):
        node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[x, 0, 0], initialVelocities=[0, v, spin]))
        return node, mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))

    crank_node, crank = body(0.3, 1e-4, a / 2, speed * a / 2, speed)
    _, rod = body(0.21, 2.5e-4, a + b / 2, speed * a / 2, -speed * a / b)
    slider_node, slider = body(0.14, 1e-4, a + b, 0.0, 0.0)

    def pivot(first, at_first, second, at_second):
        markers = [
            mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=n, localPosition=[x, 0, 0]))
            for n, x in ((first, at_first), (second, at_second))
        ]
        mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=markers))

    pivot(ground, 0.0, crank, -a / 2)
    if big_end:
        pivot(rod, b / 2, slider, 0.0)
    else:
        pivot(crank, a / 2, rod, -b / 2)
    zero = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))

    def guide(node, coordinate, angle=None):
        marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        functions = {}
        if angle is not None:
            functions = {
                "offsetUserFunction": lambda mbs, t, item, offset: angle * t,
                "offsetUserFunction_t": lambda mbs, t, item, offset: angle,
            }
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[zero, marker], **functions))

    guide(slider_node, 1)
    guide(slider_node, 2)
    guide(crank_node, 2, speed)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="big end" if big_end else "gudgeon pin",
        itemNumbers=[rod, crank if big_end else slider],
        position=[a if big_end else a + b, 0, 0],
        axis=[0, 0, 1],
        bearing=made,
    )
    mbs.Assemble()
    period = 2.0 * math.pi / speed
    return solve(mbs, [joint], settings(turns * period, period / steps_per_turn))


PIN = {"journal_radius": 0.01, "length": 0.02, "radial_clearance": 2e-5}


@hard_case("slider-crank at 20 000 rpm", newton=5.0, slow=True)
def fast_crank():
    """70 kN of inertia on a 20 mm pin that only swings: twice a turn the film has neither wedge nor time."""
    speed = 20000.0 * 2.0 * math.pi / 60.0
    made = bearing(**PIN, viscosity=0.02, film=ehd.FiniteLength(n_theta=96, n_z=8))
    run = crank(made, speed=speed, turns=2, steps_per_turn=360)
    h = run.history
    assert h.largest_eccentricity_ratio.max() < 1.0
    # inertia of the slider on an ideal mechanism: x = a cos p + sqrt(b^2 - a^2 sin^2 p)
    a, b, mass = 0.05, 0.12, 0.14
    p = np.linspace(0.0, 2.0 * math.pi, 721)
    x = a * np.cos(p) + np.sqrt(b**2 - (a * np.sin(p)) ** 2)
    acceleration = np.gradient(np.gradient(x, p), p)[2:-2] * speed**2
    late = h.time > 2.0 * math.pi / speed
    # the force along the slider's path; the rod turns by 25 degrees, and the pin's own motion in the gap adds a little
    size = np.hypot(*h.force[late, :2].T)
    assert size.max() > 0.98 * mass * np.abs(acceleration).max()
    assert size.max() < 1.15 * mass * np.abs(acceleration).max()
    return run


@hard_case("crank at steps of two degrees", rejected=3, slow=True)
def coarse_crank():
    """The crank's end leaves its tangent by 30 um in a step, more than the
    clearance: Newton has to start where the accelerations lead."""
    made = bearing(**PIN, viscosity=0.02, film=ehd.FiniteLength(n_theta=96, n_z=8))
    coarse, fine = (
        crank(made, speed=4000.0 * 2.0 * math.pi / 60.0, turns=2, steps_per_turn=steps, big_end=True)
        for steps in (180, 960)
    )
    a, b = coarse.history, fine.history
    late = a.time > 0.5 * a.time[-1]
    force = np.interp(a.time[late], b.time, np.linalg.norm(b.force, axis=1))
    error = np.abs(np.linalg.norm(a.force[late], axis=1) - force).max() / force.max()
    assert error < 2e-3
    return coarse, fine


@hard_case("ten thousand steps", slow=True)
def no_drift():
    """A swinging load over 50 periods: what is the same in every period must be the same in the last."""
    made = bearing(film=ehd.ShortBearing(n_theta=64), length=0.01)
    rate = 200.0
    rotor = Rotor(
        made,
        mass=0.5,
        load=lambda t: (150.0 * math.sin(rate * t), -200.0 + 100.0 * math.cos(2.0 * rate * t)),
        speed=SPEED,
    )
    period = 2.0 * math.pi / rate
    run = rotor.run(50 * period, period / 200)
    h = run.history
    assert h.time.size == 10001
    tenth, last = slice(9 * 200 + 1, 10 * 200 + 1), slice(-200, None)
    # rounding of 8000 steps, with which times differ that should be whole periods apart
    assert np.abs(h.eccentricity[last] - h.eccentricity[tenth]).max() < 1e-9 * CLEARANCE
    assert np.allclose(h.force[last], h.force[tenth], rtol=0.0, atol=1e-6)
    assert rotor.momentum_error(h) < 1e-3
    return run
