"""A flexible shaft in two bearings through rigid markers on a beam: the path through Exudyn's marker Jacobians."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.advancedUtilities import ItemODE2Coordinates, NumericalJacobian

import exudyn_ehd as ehd
from exudyn_ehd.coupling.api import CreateLubricatedJoint
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver

BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=40e-6,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=48, n_z=8),
)


def shaft(load=-50.0):
    """Steel shaft along x, 0.3 m, spinning with 100 rad/s in two bearings 30 mm from its ends."""
    mbs = scenes.new_system()
    ground = scenes.add_body(mbs, "ground")
    radius, density, young, shear = 0.02, 7800.0, 2e11, 8e10
    area, inertia = np.pi * radius**2, np.pi * radius**4 / 4
    section = exu.BeamSection()
    section.stiffnessMatrix = np.diag(
        [young * area, shear * area, shear * area, 2 * shear * inertia, young * inertia, young * inertia]
    )
    section.inertia = density * np.diag([2 * inertia, inertia, inertia])
    section.massPerLength = density * area
    spin = [0, 0, 0, 0, 0, 100.0, 0, -100.0, 0]
    nodes = [
        mbs.AddNode(eii.NodePointSlope23(referenceCoordinates=[x, 0, 0, 0, 1, 0, 0, 0, 1], initialVelocities=spin))
        for x in (0.0, 0.3)
    ]
    beam = mbs.AddObject(eii.ObjectANCFBeam(nodeNumbers=nodes, length=0.3, sectionData=section))
    joints = []
    for x in (0.03, 0.27):
        journal = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=beam, localPosition=[x - 0.15, 0, 0]))
        bore = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground, localHT=exu.HT(translation=[x, 0, 0])))
        joints.append(CreateLubricatedJoint(mbs, f"at {x}", [bore, journal], axis=[1, 0, 0], bearing=BEARING))
    for node in nodes:
        marker = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=node))
        mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, load, 0]))
    mbs.Assemble()
    return mbs, joints


def test_shaft_floats_in_two_bearings():
    mbs, (left, right) = shaft()
    mbs.SolveDynamic(ConfigureSolver(scenes.settings(0.02, 200)))
    one, two = left.history, right.history
    # mirror symmetry: the two beam ends do the same up to the order of a sum
    np.testing.assert_allclose(one.eccentricity, two.eccentricity, rtol=0, atol=1e-9 * BEARING.radial_clearance)
    iterations = mbs.sys["dynamicSolver"].it.newtonStepsCount
    assert iterations <= 3 * 200
    # joint frame of the axis x: x is the local y of ground, y is z
    np.testing.assert_allclose(one.force[-1], [50.0, 0.0, 0.0], rtol=0, atol=1.0)


@pytest.mark.parametrize("velocities", [False, True])
def test_jacobian_through_marker_jacobians(velocities):
    """Exact at any velocity: the spin of 100 rad/s and a squeezing and tilting motion on top.

    Steps of 1e-9 m against 4e-5 m of clearance: truncation (3e-5)^2, rounding 1e-17 / 1e-9; 1e-5 of the largest entry
    allows for the stiff slopes. Steps of 2e-7 m/s: films are exact to 1e-12.
    """
    mbs, (left, _) = shaft()
    coordinates = ItemODE2Coordinates(mbs, left.objectNumber)
    rng = np.random.default_rng(1)
    q = 3e-6 * rng.normal(size=18)
    mbs.systemData.SetODE2Coordinates(q.tolist())
    q_t = np.tile([0, 0, 0, 0, 0, 100.0, 0, -100.0, 0], 2) + 1e-3 * rng.normal(size=18)
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())

    def lhs():
        return np.array(mbs.ComputeItem(left.objectNumber, exu.ComputeItemType.ODE2LHS))

    item = exu.ComputeItemType.JacobianODE2_t if velocities else exu.ComputeItemType.JacobianODE2
    analytic = np.array(mbs.ComputeItem(left.objectNumber, item))
    step = 2e-7 if velocities else 1e-9
    numeric = NumericalJacobian(mbs, lhs, coordinates, velocities=velocities, epsilon=step)
    np.testing.assert_allclose(analytic, numeric, rtol=0, atol=1e-5 * np.abs(numeric).max())
