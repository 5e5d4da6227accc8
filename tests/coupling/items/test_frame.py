"""Start places of bore and journal: bearings off a line misalign a shaft."""

import exudyn.itemInterface as eii
import numpy as np
import scenes

import exudyn_ehd as ehd


def test_markers_of_two_sides_misalign_a_shaft():
    mbs = scenes.new_system()
    ground, shaft = mbs.CreateGround(), scenes.add_body(mbs, "Rxyz")
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=4e-5,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=32, n_z=4),
    )
    joints = []
    for z, off in ((-0.1, 0.0), (0.1, 2e-5)):
        places = ((ground, [0, off, z]), (shaft, [0, 0, z]))
        markers = [mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=b, localPosition=p)) for b, p in places]
        joints.append(ehd.CreateLubricatedJoint(mbs, f"at {z}", itemNumbers=markers, axis=[0, 0, 1], bearing=bearing))
    mbs.Assemble()
    mbs.SolveDynamic(scenes.settings(1e-6, 1))
    first, second = (joint.history.motion[0, :4] for joint in joints)
    np.testing.assert_allclose(second - first, [0.0, -2e-5, 0.0, 0.0], rtol=0.0, atol=1e-9)
