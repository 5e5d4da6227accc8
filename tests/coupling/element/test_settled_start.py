"""Flexible bores start in balance with their film: with pressures at the ends, and at the temperature of the run."""

import itertools
import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from tests.sampling import sample

R, L, C, SPEED = 0.02, 0.02, 25e-6, 300.0
PLACE = (0.2, -0.3)
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
MESH = ehd.HollowCylinder(inner_radius=R + C, thickness=0.006, length=L, axial=2, radial=1, circumferential=16)
BUSHES = {
    "modal": ehd.ModalBush(mesh=MESH, material=STEEL, tolerance=0.2),
    "nodal": ehd.ANCFBush(mesh=MESH, material=STEEL),
}


def rotor(kind, grid=(45, 6), **options):
    options = {"lubricant": ehd.Lubricant(viscosity=0.02)} | options
    bearing = ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        bush=BUSHES[kind],
        film=ehd.FiniteLength(n_theta=grid[0], n_z=grid[1]),
        **options,
    )
    mbs = scenes.new_system()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(
        eii.NodeRigidBody2D(
            referenceCoordinates=[0, 0, 0],
            initialCoordinates=[PLACE[0] * C, PLACE[1] * C, 0],
            initialVelocities=[0, 0, SPEED],
        )
    )
    body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=2.0, inertia=1e-3))
    joint = ehd.CreateLubricatedJoint(
        mbs, name="film", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint, bearing


@pytest.mark.parametrize(
    ("kind", "grid", "ends"),
    sample(list(itertools.product(BUSHES, [(45, 6), (96, 10)], [(1e5, 1e5), (2e6, 0.0)])), 0, 3, 5),
)
def test_start_with_end_pressures_is_the_steady_film(kind, grid, ends):
    mbs, joint, bearing = rotor(kind, grid, end_pressures=ends)
    settings = scenes.settings(1e-4, 10)
    (ehd.SolveDynamicSparse if kind == "nodal" else ehd.SolveDynamic)(mbs, settings)
    expected = ehd.steady(
        bearing, speed=SPEED, eccentricity_ratio=math.hypot(*PLACE), direction=math.atan2(PLACE[1], PLACE[0])
    )
    largest = np.abs(expected.bore_displacement).max()
    assert joint.history.bore_displacement[0] == pytest.approx(largest, rel=1e-6)
    assert len(joint.history.time) == 11


@pytest.mark.parametrize(
    "thermal",
    [
        ehd.LumpedThermal(supply_temperature=313.15, capacity=1.0),
        ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=2e4),
    ],
    ids=["lumped", "energy"],
)
@pytest.mark.parametrize("closure", [ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)])
def test_modes_start_in_balance_at_the_temperature_of_the_run(thermal, closure):
    """The oil's own temperature, 325 K, is not the one that the heat balance starts from."""
    oil = ehd.oil("ISO VG 32", temperature=325.0)
    mbs, joint, _ = rotor("modal", lubricant=oil, thermal=thermal, cavitation=closure)
    element = joint.element
    q = np.array(mbs.GetNodeOutput(element.bore_nodes[0], exu.OutputVariableType.Coordinates))
    load, spring = element.steps.look_at_accepted(mbs)[1].evaluation.bore_load, element.stiffness * q
    if not closure.conserves_mass:  # whose film starts flooded, and is looked at as a steady one before the run
        assert np.abs(load - spring).max() < 1e-6 * np.abs(spring).max()
    mbs.SolveDynamic(scenes.settings(4e-3, 20, tolerance=1e-8))
    peak = joint.history.peak_pressure
    assert peak[:10].max() < 1.5 * peak[0]


@pytest.mark.parametrize("thickness", [3e-3, 5e-3])
def test_dynamic_modes_that_lack_nothing(thickness):
    """Body forces, and vibrations, whose responses the static modes hold already."""
    mesh = ehd.HollowCylinder(inner_radius=R, thickness=thickness, length=L, axial=2, radial=1, circumferential=24)
    bush = ehd.ModalBush(mesh=mesh, material=STEEL, tolerance=0.2, dynamics=True)
    bearing = ehd.JournalBearing(
        journal_radius=R, length=L, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.02), bush=bush
    )
    assert ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.5).status is ehd.Status.CONVERGED
