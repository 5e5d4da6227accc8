"""Inertia of a modal bush on a housing that moves: integrals, equations, energy and momentum of runs, the nodal bush as
reference."""

from __future__ import annotations

import dataclasses
from contextlib import nullcontext

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from bodies import ancf_beam
from elastic_scene import CLEARANCE, CYLINDER, HOUSING, SPEED, STEEL, Nodes, bearing, with_bush
from exudyn.rigidBodyUtilities import RigidBodyInertia
from exudyn.utilities import InertiaCylinder
from rods import PUSH, rod, total

import exudyn_ehd as ehd
from exudyn_ehd.coupling.element.modal import ModalInertia
from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.coupling.kinematics.sides import detached
from exudyn_ehd.solid.modes.static import bore_modes

STATIC = ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2, tilted=False)
DYNAMIC = dataclasses.replace(STATIC, dynamics=True)


@pytest.mark.parametrize("kind", ["EP", "Rxyz", "RotVec", "2D"])
def test_equations_are_those_of_energy_and_momenta_of_the_mesh(kind):
    """Left-hand side times a rate is the rate of an energy; times a rigid motion that of a momentum: differences over
    1e-5 s."""
    modes, rng = bore_modes(DYNAMIC), np.random.default_rng(2)
    nodes = Nodes(modes, STEEL)
    mbs = scenes.new_system()
    # rotation vectors add up about zero only
    turned = np.eye(3) if kind == "RotVec" else scenes.rotation([0, 0, 0.3])
    body = scenes.add_body(mbs, kind, [0.1, 0.2, 0.0], turned)
    side = resolve(mbs, "item", body).side(np.array([0.2, -0.1, 0.0]), scenes.rotation([0, 0, 0.8]))
    inertia, n, k = ModalInertia(mbs, side, modes), side.size, modes.count
    q, q_t, q_tt = 0.1 * rng.normal(size=n), rng.normal(size=n), rng.normal(size=n)
    m, m_t, m_tt = 1e-2 * rng.normal(size=k), 0.3 * rng.normal(size=k), 5.0 * rng.normal(size=k)
    if kind == "RotVec":
        q[3:] = 0.0
    if kind == "EP":
        # on the unit sphere, staying there
        e = side.reference[3:]
        q[3:], q_t[3:] = 0.0, q_t[3:] - e * (e @ q_t[3:])
        q_tt[3:] -= e * (e @ q_tt[3:] + q_t[3:] @ q_t[3:])
    own, coupling, modal = inertia.mass(q, m)
    on_housing, on_modes = inertia.force(q, q_t, m, m_t)
    lhs = own @ q_tt + coupling @ m_tt - on_housing, coupling.T @ q_tt + modal @ m_tt - on_modes
    assert np.allclose(own, own.T, rtol=0, atol=1e-14 * np.abs(own).max())

    def at(t):
        place, rate = q + t * q_t + 0.5 * t * t * q_tt, q_t + t * q_tt
        probe = detached(side)
        probe.update(None, place, rate, None)
        state = probe.frame, m + t * m_t + 0.5 * t * t * m_tt, m_t + t * m_tt
        return nodes.energy(*state), nodes.momenta(*state)

    step = 1e-5
    (energy, momenta), (energy_0, momenta_0) = at(step), at(-step)
    power = lhs[0] @ q_t + lhs[1] @ m_t
    assert power == pytest.approx((energy - energy_0) / (2 * step), rel=1e-6)
    probe = detached(side)
    probe.update(None, q, q_t, None)
    rates = (momenta - momenta_0) / (2 * step)
    # virtual coordinates of a rigid motion about the global origin
    turn, move = probe.jac[1], probe.jac[0]
    ways = [2, 5] if kind == "2D" else []
    for i in [0, 1, 5] if ways else range(6):
        shift, angle = (
            (np.eye(3)[i], np.zeros(3)) if i < 3 else (np.cross(np.eye(3)[i - 3], probe.frame[:, 3]), np.eye(3)[i - 3])
        )
        virtual = np.linalg.lstsq(np.concatenate((move, turn)), np.r_[shift, angle], rcond=None)[0]
        assert virtual @ lhs[0] == pytest.approx(rates[i], rel=1e-6, abs=1e-6 * np.abs(rates).max())


@pytest.mark.parametrize("kind", ["EP", "Rxyz", "RotVec", "2D"])
def test_derivatives_are_those_of_the_velocity_forces(kind):
    modes, rng = bore_modes(DYNAMIC), np.random.default_rng(3)
    mbs = scenes.new_system()
    body = scenes.add_body(mbs, kind, [0.1, 0.2, 0.0], scenes.rotation([0, 0, 0.3]))
    side = resolve(mbs, "item", body).side(np.array([0.2, -0.1, 0.0]), np.eye(3))
    inertia, n, k = ModalInertia(mbs, side, modes), side.size, modes.count
    q, q_t = 0.1 * rng.normal(size=n), rng.normal(size=n)
    m, m_t = 1e-2 * rng.normal(size=k), 0.3 * rng.normal(size=k)
    place, rate = inertia.derivatives(q, q_t, m, m_t)
    for _ in range(3):
        d, d_t = rng.normal(size=k), rng.normal(size=n + k)
        ends = [
            np.concatenate(inertia.force(q, q_t + s * d_t[:n], m + s * d, m_t + s * d_t[n:])) for s in (1e-3, -1e-3)
        ]
        expected = place[:, n:] @ d + rate @ d_t
        # cubic at most: 1e-6 of truncation where displacement meets two rates
        assert np.allclose((ends[0] - ends[1]) / 2e-3, expected, rtol=0, atol=3e-5 * np.abs(expected).max())


def test_a_link_of_a_tree_has_the_inertia_of_a_planar_body():
    """The same coordinates: two sliders and a hinge."""
    found = []
    for housing in ("planar", "tree"):
        mbs, joint = rod(housing, DYNAMIC)
        element, rng = joint.element, np.random.default_rng(4)
        places = np.concatenate([mbs.systemData.GetNodeLTGODE2(int(node)) for node in element.sides[0].nodes])
        whole, rates = (np.zeros(mbs.systemData.ODE2Size()) for _ in range(2))
        whole[places], rates[places] = 0.1 * rng.normal(size=3), rng.normal(size=3)
        mbs.systemData.SetODE2Coordinates(whole.tolist())
        mbs.systemData.SetODE2Coordinates_t(rates.tolist())
        m, m_t = rng.normal(size=(2, element.stiffness.size))
        state = whole[places], rates[places], m, m_t
        found.append(
            [
                *element.inertia.mass(state[0], m),
                *element.inertia.force(*state),
                *element.inertia.derivatives(*state),
            ]
        )
    for a, b in zip(*found, strict=True):
        assert np.allclose(a, b, rtol=0, atol=1e-11 * np.abs(a).max())


def test_momentum_of_a_tree_with_a_bush_is_the_impulse_of_its_load(measured):
    mbs, joint = rod("tree", DYNAMIC)
    modes = joint.element.bore_nodes
    before, _ = total(mbs, modes)
    steps, step = 20, 5e-6
    mbs.SolveDynamic(scenes.settings(steps * step, steps, tolerance=1e-9))
    assert len(joint.history.time) == steps + 1
    times = step * np.arange(steps + 1)
    impulse = PUSH * np.array([steps * step, np.trapezoid(np.cos(2000.0 * times), times)])
    # the share of the modes' own momentum is in the coupling of the mass matrix
    measured("momentum", np.abs(total(mbs, modes)[0] - before - impulse).max() / np.abs(impulse).max(), 1e-5)


def accelerated(kind, density, acceleration, spin, steps=25, end=5e-4):
    """Path of a light journal in a bush on a free housing, pushed within 0.2 ms to an acceleration, turning; body and
    bush weigh the same."""
    material = dataclasses.replace(STEEL, density=density)
    whole = with_bush(HOUSING, material)
    light = InertiaCylinder(780, 0.3, 0.03, 2)
    push = (whole.Mass() + light.Mass()) * acceleration
    mbs = scenes.new_system()
    place = CLEARANCE * np.array([-0.5, 0.1, 0.0])
    common = {"nodeType": exu.NodeType.RotationRxyz}
    body = mbs.CreateRigidBody(inertia=whole, initialAngularVelocity=[0, 0, spin], **common)
    journal = mbs.CreateRigidBody(
        inertia=light,
        initialDisplacement=list(place),
        initialVelocity=list(np.cross([0, 0, spin], place)),
        initialAngularVelocity=[0, 0, spin + SPEED],
        **common,
    )
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body))
    force = lambda mbs, t, v: [0.5 * push * (1 - np.cos(min(t / 2e-4, 1.0) * np.pi)), 0, 0]  # noqa: E731
    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=force))
    bush = {
        "nodal": ehd.ANCFBush(mesh=CYLINDER, material=material),
        "static": dataclasses.replace(STATIC, tolerance=0.05, material=material),
        "dynamic": dataclasses.replace(DYNAMIC, tolerance=0.05, material=material),
    }[kind]
    joint = ehd.CreateLubricatedJoint(
        mbs, name="b", itemNumbers=[body, journal], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing(bush)
    )
    mbs.Assemble()
    options = scenes.settings(end, steps, tolerance=1e-8)
    options.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    ehd.SolveDynamicSparse(mbs, options)
    return joint.history.motion[:, :2] / CLEARANCE


@pytest.mark.slow
@pytest.mark.parametrize(
    ("density", "spin", "without", "with_inertia"),
    # a bush ten times as heavy as steel at 1e4 m/s^2; turning, it grows under the centrifugal force as well
    [(7.8e4, 0.0, 1e-2, 5e-4), (7.8e4, 600.0, 4e-2, 3e-3)],
)
def test_bore_of_an_accelerated_housing_is_that_of_the_nodal_bush(density, spin, without, with_inertia, measured):
    nodal, static, dynamic = (accelerated(kind, density, 1e4, spin) for kind in ("nodal", "static", "dynamic"))
    assert np.abs(static - nodal).max() > without
    measured("path over the clearance", np.abs(dynamic - nodal).max(), with_inertia)


def light_housing(mass, **options):
    """A joint on a body of ``mass``; its bush of 2.6 kg has mass."""
    mbs = scenes.new_system()
    inertia = RigidBodyInertia(mass=mass, com=np.zeros(3), inertiaTensor=np.eye(3))
    items = [mbs.CreateRigidBody(inertia=inertia, **options), mbs.CreateRigidBody(inertia=HOUSING, **options)]
    joint = ehd.CreateLubricatedJoint(
        mbs, name="big end", itemNumbers=items, position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing(DYNAMIC)
    )
    return mbs, joint


@pytest.mark.parametrize("options", [{}, {"create2D": True}])
def test_a_housing_lighter_than_its_bush_is_refused(options):
    """The mass matrix of a bush that weighs more than the body that contains it is indefinite."""
    with pytest.raises(ehd.InputError, match=r"'big end'.* 2 kg, its bush .* 2\.58\d kg"):
        light_housing(2.0, **options)
    light_housing(2.7, **options)


def test_what_is_lighter_than_its_bush_warns_when_it_is_assembled():
    """A beam's own mass is not known by a number: its mass matrix tells."""
    for density, light in ((7800.0, True), (700.0, False)):
        mbs = scenes.new_system()
        body = ancf_beam()(mbs)
        journal = mbs.CreateRigidBody(referencePosition=list(body.point), inertia=HOUSING)
        bush = dataclasses.replace(DYNAMIC, material=dataclasses.replace(STEEL, density=density))
        ehd.CreateLubricatedJoint(
            mbs,
            name="big end",
            itemNumbers=[body.item, journal],
            position=list(body.point),
            axis=[0, 0, 1],
            bearing=bearing(bush),
        )
        mbs.Assemble()
        with pytest.warns(UserWarning, match=r"'big end'.*indefinite.* 2\.58\d kg") if light else nullcontext():
            mbs.SolveDynamic(scenes.settings(1e-7, 1, tolerance=1e-6))
