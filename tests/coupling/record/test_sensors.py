"""Sensors of what Exudyn's joints give, against Exudyn's own connector on the same markers and against ideal joints."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from exudyn_ehd.coupling.element.outputs import OUTPUTS

OUTPUT = exu.OutputVariableType
BEARING = ehd.JournalBearing(
    journal_radius=0.01,
    length=0.06,
    radial_clearance=20e-6,
    lubricant=ehd.Lubricant(viscosity=0.05),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)
PLACE, AXIS = np.array([0.2, 0.1, 0.25]), np.array([0.3, -0.5, 0.8])


def links(join):
    """A turning link on ground and another on it, on the joint that ``join`` adds."""
    mbs, turn = scenes.new_system(), scenes.rotation([0.3, -0.5, 0.9])
    inertia = InertiaCuboid(7800.0, [0.3, 0.03, 0.03])
    kind = {"nodeType": exu.NodeType.RotationRxyz, "inertia": inertia, "gravity": [0.0, -9.81, 0.0]}
    first = mbs.CreateRigidBody(referencePosition=[0.1, 0.2, 0.3], referenceRotationMatrix=turn, **kind)
    second = mbs.CreateRigidBody(referencePosition=[0.3, 0.2, 0.2], **kind)
    mbs.CreateRevoluteJoint("shoulder", [mbs.CreateGround(), first], [0.0, 0.1, 0.2], list(turn[:, 2]))
    joint = join(mbs, [first, second])
    mbs.CreateTorque(itemNumber=second, loadVector=[0.2, 0.1, -0.1])
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.005, 25)))
    return mbs, joint


def film(mbs, items):
    joint = ehd.CreateLubricatedJoint(
        mbs, "elbow", items, PLACE, AXIS, BEARING, axial=ehd.Held(), tilt=ehd.Held(), show=False
    )
    # at the same points and frames, without any stiffness
    markers = [int(m) for m in mbs.GetObject(joint.constraintNumber)["markerNumbers"]]
    spring = mbs.AddObject(
        eii.ObjectConnectorRigidBodySpringDamper(markerNumbers=markers, useIntrinsicFormulation=False)
    )
    generic = mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=[0] * 6))
    return joint, spring, generic, {name: joint.AddSensor(getattr(OUTPUT, name)) for name in OUTPUTS}


def test_sensors_read_what_exudyns_joints_give():
    mbs, (joint, spring, generic, sensors) = links(film)
    got = {name: mbs.GetSensorStoredData(sensor)[-1, 1:] for name, sensor in sensors.items()}
    compared = 0
    for connector in (spring, generic):
        for name in OUTPUTS:
            if "Force" in name or "Torque" in name:
                continue
            try:
                expected = np.ravel(mbs.GetObjectOutput(connector, getattr(OUTPUT, name)))
            except exu.ExudynError:
                continue
            compared += 1
            scale = np.abs(expected).max()
            assert np.abs(got[name] - expected).max() < 1e-9 * scale + 1e-14, name
    assert compared > 12
    turn = got["HomogeneousTransformation"].reshape(4, 4)[:3, :3]
    for name in ("Force", "Torque", "Displacement", "AngularVelocity"):
        assert got[name] == pytest.approx(turn @ got[f"{name}Local"])
    # the film alone, and what the constraint adds to it
    assert got["ForceLocal"][:2] == pytest.approx(-joint.history.force[-1, :2])
    ideal, pin = links(lambda mbs, items: mbs.CreateRevoluteJoint("elbow", items, list(PLACE), list(AXIS)))
    frame = np.array(ideal.GetObjectOutput(pin, OUTPUT.HomogeneousTransformation)).reshape(4, 4)[:3, :3]
    force = frame @ ideal.GetObjectOutput(pin, OUTPUT.ForceLocal)
    multipliers = ideal.GetObjectOutput(pin, OUTPUT.TorqueLocal)
    torque = frame @ [multipliers[1], -multipliers[0], 0.0]
    axis = frame[:, 2]
    across = got["Torque"] - axis * (axis @ got["Torque"])
    assert np.linalg.norm(force) > 3.0 and np.linalg.norm(torque) > 0.3
    assert np.linalg.norm(got["Force"] - force) < 0.05 * np.linalg.norm(force)
    assert np.linalg.norm(across - torque) < 0.05 * np.linalg.norm(torque)


def test_what_is_no_quantity_is_refused():
    mbs = scenes.new_system()
    body = scenes.add_body(mbs, "Rxyz")
    joint = ehd.CreateLubricatedJoint(mbs, "a", [mbs.CreateGround(), body], [0, 0, 0], [0, 0, 1], BEARING)
    for unknown in ("force_local", OUTPUT.StressLocal, 3):
        with pytest.raises(ehd.InputError, match=r"quantity must be a member of Quantity .* ForceLocal, Torque, "):
            joint.AddSensor(unknown)
