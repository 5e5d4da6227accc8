"""A model leaves nothing behind: dropped, reset, or with items deleted."""

import gc
import weakref

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import rods
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from tests.sampling import sample

CLEARANCE = 40e-6


def bearing(**effects):
    return ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=CLEARANCE,
        lubricant=ehd.oil("ISO VG 46", temperature=313.15),
        film=ehd.FiniteLength(n_theta=24, n_z=4),
        **effects,
    )


def journal(mbs, x=0.0):
    return mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800, 0.2, 0.02, 2),
        initialDisplacement=[x, 0, 0],
        initialAngularVelocity=[0, 0, 300.0],
        nodeType=exu.NodeType.RotationRxyz,
    )


def joint_on(mbs, items, name="film", **effects):
    return ehd.CreateLubricatedJoint(
        mbs, name=name, itemNumbers=items, position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing(**effects)
    )


def run(mbs, solve=ehd.SolveDynamic):
    mbs.Assemble()
    solve(mbs, ehd.ConfigureSolver(scenes.settings(3e-4, 3)))


STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800)
RING = ehd.HollowCylinder(
    inner_radius=0.02 + CLEARANCE, thickness=0.01, length=0.02, axial=1, radial=1, circumferential=12
)
KINDS = {
    "rigid": {},
    "heat": {"thermal": ehd.FilmEnergy(supply_temperature=313.15)},
    "modes": {"bush": ehd.ModalBush(mesh=RING, material=STEEL, tolerance=0.2)},
    "nodes": {"bush": ehd.ANCFBush(mesh=RING, material=STEEL)},
}


@pytest.mark.parametrize(
    ("kind", "sparse"), sample([("rigid", True), ("nodes", True), *((kind, False) for kind in KINDS)], 1)
)
def test_a_model_that_is_dropped_is_gone(kind, sparse):
    def build():
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        housing = mbs.CreateGround()
        if kind == "nodes":
            housing = mbs.CreateRigidBody(
                inertia=InertiaCylinder(7800, 0.2, 0.1, 2), nodeType=exu.NodeType.RotationRxyz
            )
        joint = joint_on(mbs, [housing, journal(mbs)], **KINDS[kind])
        joint.AddSensor(ehd.Quantity.FORCE)
        run(mbs, ehd.SolveDynamicSparse if sparse else ehd.SolveDynamic)
        assert joint.history.time.size > 3
        assert np.isfinite(joint.film().pressure).all()
        assert joint.bush is None or np.isfinite(joint.bush.displacements()).all()
        return [weakref.ref(thing) for thing in (mbs, joint, joint.element, joint.element.steps)]

    left = build()
    # circles of Python's own (SciPy makes some) may wait for their collector; what Exudyn holds would never go
    gc.collect()
    assert [thing() for thing in left] == [None] * 4


@pytest.mark.slow
def test_many_models_in_one_process_take_the_memory_of_one():
    """Resident memory after 300 models against that after ten."""

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * 4096 / 1e6

    for number in range(300):
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        joint_on(mbs, [mbs.CreateGround(), journal(mbs)])
        run(mbs)
        if number == 9:
            before = resident()
    assert resident() - before < 5.0


@pytest.mark.parametrize("name", ["", "film"])
def test_a_system_that_was_reset_knows_the_new_joint_only(name, tmp_path):
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    old = joint_on(mbs, [mbs.CreateGround(), journal(mbs)], name)
    run(mbs)
    rows = old.history.time.size
    mbs.Reset()
    new = joint_on(mbs, [mbs.CreateGround(), journal(mbs)], name)
    run(mbs)
    assert [joint.name for joint in ehd.SaveState(mbs, tmp_path / "state.npz").joints] == [new.name]
    # what the old joint has recorded stays, and it looks at nothing else
    assert old.history.time.size == rows
    with pytest.raises(ehd.InputError, match=r"no longer in the system, after mbs.Reset\(\)"):
        old.film()
    with pytest.raises(ehd.InputError, match=r"no longer in the system"):
        old.AddSensor(ehd.Quantity.FORCE)


@pytest.mark.parametrize("solve", [ehd.SolveDynamic, ehd.SolveDynamicSparse, lambda mbs, s: mbs.SolveDynamic(s)])
def test_a_body_deleted_after_the_joint_is_noticed(solve):
    """Exudyn renumbers what is left: the joint would hold the body behind its journal."""
    mbs = scenes.new_system()
    ground, spare = mbs.CreateGround(), journal(mbs, 0.1 * CLEARANCE)
    joint = joint_on(mbs, [ground, journal(mbs)])
    journal(mbs, 0.5 * CLEARANCE)
    mbs.DeleteObject(spare)
    mbs.Assemble()
    with pytest.raises(ehd.InputError, match=r"'film': items of the system were deleted .* object 3 on nodes \[1\]"):
        joint.film()
    with pytest.raises((ehd.InputError, exu.ExudynError), match=r"'film': items of the system were deleted"):
        solve(mbs, ehd.ConfigureSolver(scenes.settings(3e-4, 3)))


def test_a_marker_deleted_after_the_joint_is_noticed():
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    first = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground))
    marker, centre = rods.planar_tree(mbs, rods.HOUSING)
    assert int(centre) > int(marker) > int(first)
    joint = ehd.CreateLubricatedJoint(
        mbs, name="film", itemNumbers=[marker, journal(mbs)], axis=[0, 0, 1], bearing=bearing()
    )
    mbs.DeleteMarker(first)
    mbs.Assemble()
    with pytest.raises(ehd.InputError, match=r"'film': items of the system were deleted"):
        joint.film()


def test_items_behind_a_joint_may_go():
    mbs = scenes.new_system()
    joint = joint_on(mbs, [mbs.CreateGround(), journal(mbs)])
    mbs.DeleteObject(journal(mbs, 0.5 * CLEARANCE))
    run(mbs)
    assert joint.history.time.size > 3
