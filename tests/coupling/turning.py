"""A ring of finite elements on absolute coordinates that spins in its bearing."""

import exudyn.itemInterface as eii
import scenes

import exudyn_ehd as ehd

STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=40e-6,
    lubricant=ehd.Lubricant(viscosity=0.001),
    film=ehd.FiniteLength(n_theta=24, n_z=4),
)
RING = ehd.HollowCylinder(inner_radius=0.01, thickness=0.01, length=0.02, axial=1, radial=1, circumferential=6)


def free_ring(mbs, speed):
    """A ring of finite elements that spins about z."""
    bush = ehd.ANCFBush(mesh=RING, material=STEEL)
    return ehd.CreateFlexibleBush(mbs, "ring", bush=bush, outer=ehd.FreeOuter(), initialAngularVelocity=[0, 0, speed])


def spinning_ring(speed, role="journal"):
    """A free ring that spins in a bearing on ground, or as a bearing about a fixed journal."""
    mbs = scenes.new_system()
    ring = free_ring(mbs, speed)
    nodes = ring.mesh.outer.nodes.tolist()
    marker = mbs.AddMarker(
        eii.MarkerSuperElementRigid(
            bodyNumber=ring.objectNumber, meshNodeNumbers=nodes, weightingFactors=[1.0 / len(nodes)] * len(nodes)
        )
    )
    ground = mbs.CreateGround()
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="film",
        itemNumbers=[ground, marker] if role == "journal" else [marker, ground],
        position=[],
        axis=[0, 0, 1],
        bearing=BEARING,
    )
    mbs.Assemble()
    return mbs, ring, joint
