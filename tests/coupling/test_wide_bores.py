"""Bores that are wider than the clearance circle are judged by their gap, not by the eccentricity ratio."""

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.kinematics.relative import BoreGap

CLEARANCE = 40e-6
ANGLES = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
# worn three clearances deep on one side
POCKET = ehd.ProfileTable(
    angles=ANGLES.tolist(),
    positions=[-0.01, 0.01],
    depths=3.0 * CLEARANCE * np.repeat(np.maximum(np.cos(ANGLES), 0.0)[:, None] ** 2, 2, axis=1),
)
SOFT = ehd.ModalBush(
    mesh=ehd.HollowCylinder(
        inner_radius=0.02 + CLEARANCE, thickness=0.01, length=0.02, axial=2, radial=1, circumferential=16
    ),
    material=ehd.SaintVenantKirchhoff(youngs_modulus=3e8, poisson_ratio=0.4, density=1200),
    tolerance=0.1,
)


def bearing(**shape):
    return ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        **shape,
    )


def system(place, load=(2000.0, 0.0, 0.0), control=None, **shape):
    mbs = scenes.new_system()
    journal = mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800, 0.2, 0.02, 2),
        initialAngularVelocity=[0, 0, 50.0],
        initialDisplacement=[place[0] * CLEARANCE, place[1] * CLEARANCE, 0],
        nodeType=exu.NodeType.RotationRxyz,
    )
    mbs.CreateForce(itemNumber=journal, loadVector=list(load))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="wide",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing(**shape),
        stepControl=control,
    )
    return mbs, joint


def run(mbs, steps=60):
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(steps * 5e-5, steps)))


@pytest.mark.parametrize(("start", "control"), [(0.0, None), (2.5, None), (0.0, ehd.StepControl())])
def test_a_journal_runs_in_what_was_worn_away(start, control):
    mbs, joint = system((start, 0.0), control=control, profile=POCKET)
    run(mbs)
    history = joint.history
    assert history.time.size == 61
    assert history.eccentricity_ratio.max() > 2.5
    assert history.minimum_gap.min() > 0.0


@pytest.mark.parametrize(
    ("shape", "place"),
    [
        ({"profile": POCKET}, (-1.1, 0.0)),
        ({"profile": POCKET}, (3.0, 2.0)),
        # inside the circle, but the oval is pinched there
        ({"profile": ehd.OutOfRound(order=2, amplitude=0.7 * CLEARANCE)}, (0.0, 0.5)),
        ({}, (1.3, 0.0)),
    ],
)
def test_a_journal_where_the_gap_is_closed_is_refused(shape, place):
    with pytest.raises(ehd.InputError, match=r"the journal is outside the bore .* smallest gap -[0-9.e-]+ m; check"):
        system(place, **shape)


@pytest.mark.slow
def test_a_soft_bush_makes_room_for_its_journal():
    mbs, joint = system((1.3, 0.0), bush=SOFT)
    run(mbs, 10)
    assert joint.history.eccentricity_ratio[0] == pytest.approx(1.3)
    assert joint.history.minimum_gap.min() > 0.0
    with pytest.raises(ehd.InputError, match="the journal is outside the bore"):
        system((1000.0, 0.0), bush=SOFT)


def test_gap_of_the_rigid_surfaces():
    """Against the gap on a fine grid, for circles and profiles, tilted."""
    rng = np.random.default_rng(3)
    theta, z = np.linspace(0.0, 2.0 * np.pi, 2000), np.linspace(-0.01, 0.01, 41)
    for shape in ({}, {"profile": POCKET}, {"profile": (POCKET, ehd.OutOfRound(order=3, amplitude=1e-5))}):
        description = bearing(**shape)
        gap = BoreGap(description)
        for _ in range(6):
            motion = np.concatenate((rng.normal(size=2) * CLEARANCE, rng.normal(size=2) * 1e-3, np.zeros(6)))
            x, y = motion[0] + z * motion[2], motion[1] + z * motion[3]
            depth = sum(profile.depth(theta, z, 0.02) for profile in description.profiles)
            fine = CLEARANCE - np.outer(np.cos(theta), x) - np.outer(np.sin(theta), y) + depth
            assert gap.smallest(motion) == pytest.approx(fine.min(), abs=2e-3 * CLEARANCE)
