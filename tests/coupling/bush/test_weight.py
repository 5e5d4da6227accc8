"""Mass of bushes: a model weighs the same with every bush, unless the joint is told otherwise."""

import dataclasses
from contextlib import nullcontext

import exudyn as exu
import numpy as np
import pytest
import scenes
from bodies import ancf_beam
from elastic_scene import CLEARANCE, HOUSING, STEEL, bearing
from exudyn.utilities import InertiaCylinder, RigidBodyInertia
from rods import ARM, RING

import exudyn_ehd as ehd
from tests.sampling import sample
from tests.solid_tetrahedra import tet_mesh

TETS = tet_mesh(dataclasses.replace(RING, circumferential=12))
NODAL = ehd.ANCFBush(mesh=RING, material=STEEL)
MODAL = ehd.ModalBush(mesh=RING, material=STEEL, tolerance=0.2, tilted=False)
BUSHES = {
    "rigid": None,
    "liner": ehd.ElasticLiner(thickness=5e-4, youngs_modulus=1e9),
    "modal": MODAL,
    "nodal": NODAL,
    "modal tetrahedra": dataclasses.replace(MODAL, mesh=TETS, quadrature=None),
    "nodal tetrahedra": dataclasses.replace(NODAL, mesh=TETS, quadrature=None),
}
JOURNAL = InertiaCylinder(7800, 0.3, 0.03, 2)
BUSH_MASS = float(NODAL.solid(NODAL.build_mesh()).scalar_mass.sum())
GRAVITY = np.array([3.0, -9.81, 4.0])


def pair(bush, node, turn=(0.0, 0.0, 0.0), **options):
    """Housing that carries the bearing off its centre, and journal; both fall."""
    mbs, planar = scenes.new_system(), node == "2D"
    kind = {"create2D": True} if planar else {"nodeType": scenes.NODE_TYPES[node]}
    gravity = GRAVITY * [1.0, 1.0, not planar]
    place = ARM + CLEARANCE * np.array([0.4, -0.5, 0.0])
    bodies = [
        mbs.CreateRigidBody(inertia=HOUSING, initialAngularVelocity=list(turn), gravity=list(gravity), **kind),
        mbs.CreateRigidBody(
            referencePosition=list(ARM),
            initialDisplacement=list(place - ARM),
            inertia=JOURNAL,
            initialVelocity=list(np.cross(turn, place)),
            initialAngularVelocity=[turn[0], turn[1], turn[2] + 314.0],
            gravity=list(gravity),
            **kind,
        ),
    ]
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="big end",
        itemNumbers=bodies,
        position=list(ARM),
        axis=[0, 0, 1],
        bearing=bearing(bush, n_theta=32, n_z=6, length=0.05),
        **options,
    )
    mbs.Assemble()
    return mbs, joint, bodies, gravity


def momenta(mbs, joint, bodies):
    """Linear and angular momentum (6,) about the global origin."""
    total = np.zeros(6)
    for body, solid in zip(bodies, (HOUSING, JOURNAL), strict=True):
        p, v, w = (
            np.array(mbs.GetObjectOutputBody(body, kind, [0, 0, 0]))
            for kind in (
                exu.OutputVariableType.Position,
                exu.OutputVariableType.Velocity,
                exu.OutputVariableType.AngularVelocityLocal,
            )
        )
        A = np.array(mbs.GetObjectOutputBody(body, exu.OutputVariableType.RotationMatrix, [0, 0, 0])).reshape(3, 3)
        total[:3] += solid.Mass() * v
        total[3:] += solid.Mass() * np.cross(p, v) + A @ np.array(solid.InertiaCOM()) @ w
    return total if joint.bush is None else total + np.concatenate(joint.bush.momentum())


def fall(mbs, steps=5, step=2e-5):
    options = scenes.settings(steps * step, steps, tolerance=1e-9)
    options.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    ehd.SolveDynamic(mbs, options)
    return steps * step


FALLING = [(kind, "Rxyz") for kind in ("rigid", "liner", "modal", "nodal")] + [("nodal", "2D")]
ON_TETRAHEDRA = [(kind, "Rxyz") for kind in BUSHES if kind.endswith("tetrahedra")]


@pytest.mark.parametrize(("kind", "node"), sample(FALLING + sample(ON_TETRAHEDRA), 0, 1, 3))
def test_everything_falls_with_g_whatever_the_bush_is_made_of(kind, node, measured):
    mbs, joint, bodies, gravity = pair(BUSHES[kind], node)
    t = fall(mbs)
    whole = momenta(mbs, joint, bodies)[:3] / (HOUSING.Mass() + JOURNAL.Mass())
    measured("momentum over mass, g t", np.abs(whole / t - gravity).max() / 9.81, 1e-6)
    assert np.abs(joint.history.force).max() > 100.0


def test_bush_that_its_housing_contains_has_no_momentum_of_its_own_in_a_rigid_motion():
    _, joint, _, _ = pair(dataclasses.replace(NODAL), "Rxyz", turn=(4.0, -3.0, 50.0))
    start = exu.ConfigurationType.Initial
    bush = joint.bush
    u, v = bush.displacements(start), bush.velocities(start)
    flow = bush.solid.scalar_mass @ v
    assert np.abs(flow.sum(axis=0)).max() > 1.0
    # the film's first pressure strains the bush by 1e-7 m
    scale = np.abs(np.cross(bush.solid.mesh.nodes + u, flow).sum(axis=0)).max()
    assert np.abs(np.concatenate(bush.momentum(start))).max() < 1e-5 * scale


@pytest.mark.slow
def test_turning_housing_keeps_the_angular_momentum_of_a_bush_that_it_contains(measured):
    errors = []
    for steps in (20, 40):
        mbs, joint, bodies, gravity = pair(NODAL, "Rxyz", turn=(40.0, -30.0, 100.0))
        first = momenta(mbs, joint, bodies)
        t = fall(mbs, steps, 4e-4 / steps)
        last = momenta(mbs, joint, bodies)
        mass, centre = HOUSING.Mass() + JOURNAL.Mass(), JOURNAL.Mass() * ARM
        # the weight's moment about the origin, of the centre of mass along its path
        moment = np.cross(centre * t + (first[:3] * t**2 + mass * gravity * t**3 / 3) / 2, gravity)
        errors.append(np.abs(last - first - np.concatenate([mass * gravity * t, moment])) / np.abs(first[3:]).max())
    measured("momenta", errors[0].max(), 1e-5)
    assert errors[1].max() < errors[0].max() / 3.0


@pytest.mark.slow
def test_mass_beside_the_housing_falls_with_its_own_gravity(measured):
    mbs, joint, bodies, gravity = pair(NODAL, "Rxyz", bushGravity=GRAVITY)
    t = fall(mbs)
    whole = momenta(mbs, joint, bodies)[:3] / (HOUSING.Mass() + JOURNAL.Mass() + BUSH_MASS)
    measured("momentum over mass, g t", np.abs(whole / t - gravity).max() / 9.81, 1e-6)


def test_weight_of_a_free_bush_is_its_mass_times_gravity(measured):
    mbs = scenes.new_system()
    bush = ehd.CreateFlexibleBush(
        mbs,
        bush=ehd.ANCFBush(mesh=RING, material=dataclasses.replace(STEEL, youngs_modulus=1e6)),
        outer=ehd.FreeOuter(),
        loads=[ehd.Gravity(acceleration=tuple(GRAVITY), history=lambda t: 2.0)],
    )
    mbs.Assemble()
    t = fall(mbs, 5, 1e-3)
    measured(
        "momentum", np.abs(bush.momentum()[0] - 2.0 * BUSH_MASS * GRAVITY * t).max() / (BUSH_MASS * 9.81 * t), 1e-9
    )


@pytest.mark.parametrize("kind", ["rigid", "modal"])
def test_gravity_of_a_bush_whose_mass_is_the_housings_is_refused(kind):
    with pytest.raises(ehd.InputError, match=r"bushGravity.*'big end'"):
        pair(BUSHES[kind], "Rxyz", bushGravity=GRAVITY)


def test_housing_lighter_than_its_nodal_bush_is_refused():
    mbs = scenes.new_system()
    light = RigidBodyInertia(mass=0.9 * BUSH_MASS, com=np.zeros(3), inertiaTensor=np.eye(3))
    bodies = [mbs.CreateRigidBody(inertia=inertia) for inertia in (light, JOURNAL)]
    with pytest.raises(ehd.InputError, match=r"'big end'.*1\.76 kg, its ANCFBush has 1\.956 kg.*bushGravity"):
        ehd.CreateLubricatedJoint(
            mbs,
            name="big end",
            itemNumbers=bodies,
            position=[0, 0, 0],
            axis=[0, 0, 1],
            bearing=bearing(NODAL, length=0.05),
        )


@pytest.mark.parametrize("gravity", [None, (0.0, 0.0, 0.0)])
def test_beam_that_does_not_contain_its_nodal_bush_warns(gravity):
    mbs = scenes.new_system()
    body = ancf_beam()(mbs)
    journal = mbs.CreateRigidBody(referencePosition=list(body.point), inertia=HOUSING)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="big end",
        itemNumbers=[body.item, journal],
        position=list(body.point),
        axis=[0, 0, 1],
        bearing=bearing(NODAL, n_theta=32, n_z=6, length=0.05),
        bushGravity=gravity,
    )
    mbs.Assemble()
    number = joint.bush.objectNumber
    mass = mbs.GetObjectParameter(number, "massMatrixUserFunction")["function"]
    rest = [0.0] * len(mbs.systemData.GetObjectLTGODE2(number))
    warns = pytest.warns(UserWarning, match=r"'big end'.*indefinite.*ANCFBush of 1\.956 kg.*bushGravity")
    with warns if gravity is None else nullcontext():
        mass(mbs, 0.0, 2, rest, rest)
