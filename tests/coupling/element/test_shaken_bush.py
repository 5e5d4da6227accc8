"""The bore of a dynamic modal bush on a shaken and rocked housing, with next to no oil: that of the nodal bush of the
same mesh."""

from __future__ import annotations

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from elastic_scene import CYLINDER, HOUSING, JOURNAL, STEEL, bearing, with_bush

import exudyn_ehd as ehd
from exudyn_ehd.solid.modes.static import bore_modes

DYNAMIC = ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1, dynamics=True)
STEPS, END = 120, 6e-4
# Of the shaking, 1/s; the bush's lowest frequency is 43 kHz.
PULSE = 2.0 * np.pi * 5e3
# Half of the largest accelerations, m/s^2 and 1/s^2.
SHAKE, ROCK = np.array([2e4, -1e4, 0.0]), np.array([4e5, 2e5, 0.0])


def shaken(bush):
    """Radial displacement of the bore's nodes against the housing over the steps (n, nodes); the journal moves as the
    housing does."""
    mbs = scenes.new_system()
    whole, bodies = with_bush(HOUSING), []
    nodal = isinstance(bush, ehd.ANCFBush)
    for own in (whole, JOURNAL):
        body = mbs.CreateRigidBody(inertia=own, nodeType=exu.NodeType.RotationRxyz)
        marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body))
        for add, size in (
            (eii.LoadForceVector, own.Mass() * SHAKE),
            (eii.LoadTorqueVector, np.array(own.InertiaCOM()) @ ROCK),
        ):
            course = lambda mbs, t, v, size=size: list(size * (1.0 - np.cos(PULSE * t)))  # noqa: E731
            mbs.AddLoad(add(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=course))
        bodies.append(body)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=bodies,
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing(bush, lubricant=ehd.Lubricant(viscosity=1e-12)),
    )
    mbs.Assemble()
    mesh, rows = CYLINDER.mesh(), []
    direction = mesh.bore.positions[:, :2] / np.linalg.norm(mesh.bore.positions[:, :2], axis=1)[:, None]

    def take(mbs, t):
        if nodal:
            place = np.array(mbs.GetObjectOutputBody(bodies[0], exu.OutputVariableType.Position, [0, 0, 0]))
            turn = np.array(mbs.GetObjectOutputBody(bodies[0], exu.OutputVariableType.RotationMatrix, [0, 0, 0]))
            u = (mesh.nodes + joint.bush.displacements() - place) @ turn.reshape(3, 3) - mesh.nodes
        else:
            q = np.array(mbs.GetNodeOutput(joint.element.bore_nodes[0], exu.OutputVariableType.Coordinates))
            u = np.tensordot(q, joint.element.model.bore.modes.displacements, 1)
        rows.append(np.einsum("ai,ai->a", u[mesh.bore.nodes, :2], direction))
        return True

    mbs.SetPostStepUserFunction(take)
    options = scenes.settings(END, STEPS, tolerance=1e-8)
    (ehd.SolveDynamicSparse if nodal else ehd.SolveDynamic)(mbs, options)
    return np.array(rows)


@pytest.mark.slow
def test_bore_of_a_shaken_housing_is_that_of_the_mesh(measured):
    """Root mean square over the bore, over its largest one in the run."""
    mesh = shaken(ehd.ANCFBush(mesh=CYLINDER, material=STEEL))
    size = np.sqrt((mesh**2).mean(axis=1)).max()
    assert 1e-7 < size < 3e-7
    without, with_modes = (
        np.sqrt(((shaken(dataclasses.replace(DYNAMIC, body_forces=b)) - mesh) ** 2).mean(axis=1)).max() / size
        for b in (False, True)
    )
    assert without > 0.05
    # measured 1.9e-3: large rotation and strain of second order in the nodal bush, starts from rest
    measured("displacement of the bore", with_modes, 4e-3)


def test_a_bush_that_stands_still_has_no_modes_for_its_acceleration():
    counts = []
    for body_forces in (True, False):
        mbs = scenes.new_system()
        items = [mbs.CreateGround(), mbs.CreateRigidBody(inertia=JOURNAL)]
        given = bearing(dataclasses.replace(DYNAMIC, body_forces=body_forces))
        joint = ehd.CreateLubricatedJoint(
            mbs, name="b", itemNumbers=items, position=[0, 0, 0], axis=[0, 0, 1], bearing=given
        )
        counts.append(joint.element.stiffness.size)
    assert counts[0] == counts[1] == bore_modes(dataclasses.replace(DYNAMIC, body_forces=False)).count
    assert bore_modes(DYNAMIC).count > counts[0]
