"""Time per step of a joint on a reduced finite-element body, over that on a rigid one, in turns.

Without its exact Jacobian the body is differentiated by Exudyn. What is left is the film on the modes.
"""

from __future__ import annotations

import math
import time

import exudyn as exu
import exudyn.itemInterface as eii
import pytest
from exudyn.FEM import ObjectFFRFreducedOrderInterface
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from tests.finite_elements import fem_of

pytestmark = pytest.mark.benchmark

SPEED, STEPS, ROUNDS = 314.0, 60, 5
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=3, radial=2, circumferential=20)
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=5e10, poisson_ratio=0.3, density=7800.0)


def run(modes, fem, *, exact=True):
    """Processor time of a step, s: a journal of 6.6 kg under a load of 15 kN in a body that is held."""
    mbs = exu.SystemContainer().AddSystem()
    bush = None
    if modes:
        interface = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType="NodeType.RotationRxyz")
        parts = interface.AddObjectFFRFreducedOrder(mbs)
        housing, node, bush = parts["oFFRFreducedOrder"], parts["nRigidBody"], ehd.FEBore(fem=fem, exact_jacobian=exact)
    else:
        ring = InertiaCylinder(7800.0, 0.066, 0.05, 2, innerRadius=0.03)
        housing = mbs.CreateRigidBody(inertia=ring, nodeType=exu.NodeType.RotationRxyz)
        node = mbs.GetObject(housing)["nodeNumber"]
    pins = [
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=mbs.CreateGround())),
        mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=node)),
    ]
    mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=pins, constrainedAxes=[1] * 6))
    journal = mbs.CreateRigidBody(
        initialDisplacement=[12e-6, -15e-6, 0.0],
        initialAngularVelocity=[0.0, 0.0, SPEED],
        inertia=InertiaCylinder(7800.0, 0.3, 0.03, 2),
        nodeType=exu.NodeType.RotationRxyz,
    )
    mbs.CreateForce(itemNumber=journal, loadVector=[0.0, -15e3, 0.0])
    bearing = ehd.JournalBearing(
        journal_radius=0.03,
        length=0.066,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=9e-3),
        film=ehd.FiniteLength(n_theta=96, n_z=10),
        bush=bush,
    )
    ehd.CreateLubricatedJoint(mbs, "bore", [housing, journal], [0, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = STEPS * 1e-4, STEPS
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    start = time.process_time()
    ehd.SolveDynamic(mbs, settings)
    return (time.process_time() - start) / STEPS


@pytest.mark.parametrize(("modes", "limit", "gain"), [(8, 3.7, 0.65), (20, 4.1, 0.9), (40, 4.9, 1.7)])
def test_reduced_body(modes, limit, gain):
    """2.8, 3.2 and 3.5 times the rigid one's time, and 2.3, 3.6 and 9 times by differences; on a busy machine up to a
    third more. A `ModalBush` with as many modes takes as long an iteration."""
    mesh = CYLINDER.mesh()
    fem = fem_of(mesh, STEEL)
    fem.ComputeHurtyCraigBamptonModes([list(mesh.outer.nodes)], modes)
    best = dict.fromkeys(("rigid", "exact", "differences"), math.inf)
    for _ in range(ROUNDS):
        best["rigid"] = min(best["rigid"], run(0, None))
        best["exact"] = min(best["exact"], run(modes, fem))
        best["differences"] = min(best["differences"], run(modes, fem, exact=False))
    exact, differences = (best[k] / best["rigid"] for k in ("exact", "differences"))
    print(
        f"{1e3 * best['rigid']:.2f} ms a step on a rigid body, {modes} modes: {exact:.2f} and {differences:.2f} times"
    )
    assert exact < limit
    assert differences > gain * exact
