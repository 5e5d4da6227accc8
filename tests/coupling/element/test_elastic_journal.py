"""An elastic journal in Exudyn: its Jacobian, its rest, forces that cancel, spin that does not matter."""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder
from scenes import marker_loads, new_system, rotation, settings

import exudyn_ehd as ehd
from tests.sampling import sample

C, SPEED = 30e-6, 314.0
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
BUSH = ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2)
BOSSES = ehd.HeldBands(bands=((-0.08, -0.04), (0.04, 0.08)))
PIN = ehd.ElasticJournal(material=STEEL, span=(-0.08, 0.08), held=BOSSES, inner_radius=0.015, tolerance=0.2)


def bearing(bush=None, **options):
    given = {
        "journal_radius": 0.03,
        "length": 0.066,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=9e-3),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
        "journal": PIN,
    }
    return ehd.JournalBearing(bush=bush, **(given | options))


def scene(described, *, moving=False, load=(1e3, -1.5e4), spin_angle=0.0, control=None):
    """A journal that spins in a bearing on ground, or on a body that turns and flies."""
    mbs = new_system()
    A, turn, fly = np.eye(3), np.zeros(3), [0.0, 0.0, 0.0]
    housing = mbs.CreateGround()
    if moving:
        A, fly = rotation([0.4, -0.7, 0.3]), [0.3, -0.2, 0.1]
        turn = A @ [3.0, -2.0, 5.0]
        housing = mbs.CreateRigidBody(
            referenceRotationMatrix=A,
            inertia=InertiaCylinder(7800, 0.1, 0.08, 2, 0.05),
            initialVelocity=fly,
            initialAngularVelocity=list(turn),
        )
    journal = mbs.CreateRigidBody(
        referenceRotationMatrix=A @ rotation([0.0, 0.0, spin_angle]),
        initialDisplacement=list(A @ [0.2 * C, -0.6 * C, 0.0]),
        initialVelocity=fly,
        initialAngularVelocity=list(A @ [0.0, 0.0, SPEED] + turn),
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
    )
    held = ehd.Free() if moving else ehd.Held()
    items, axis = [housing, journal], list(A[:, 2])
    joint = ehd.CreateLubricatedJoint(mbs, "pin", items, [0, 0, 0], axis, described, axial=held, stepControl=control)
    if not moving:
        marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal))
        mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[*load, 0]))
    mbs.Assemble()
    return mbs, joint, journal


@pytest.mark.parametrize("bush", sample([None, BUSH], 1))
def test_jacobian_is_the_derivative_of_the_force(bush):
    mbs, joint, _ = scene(bearing(bush), moving=True)
    element = joint.element
    q, q_t = element.read(mbs, exu.ConfigurationType.Initial)
    k, rng = element.stiffness.size, np.random.default_rng(3)
    assert k == len(q) - element.rigid_size
    q[-k:] = (np.array(q[-k:]) + 1e-7 * rng.normal(size=k)).tolist()
    q_t[-k:] = (1e-5 * rng.normal(size=k)).tolist()
    unit = np.concatenate((np.full(element.rigid_size, 1e-3), np.full(k, 1e-6)))
    for f_q, f_qt, at in ((1.0, 0.0, 0), (0.0, 1.0, 1)):
        J = element.jacobian(mbs, 0.0, 0, q, q_t, f_q, f_qt)
        for _ in range(4):
            change = rng.normal(size=unit.size) * unit * (1.0 if at == 0 else 1e3)
            forces = []
            for h in (5e-7, -5e-7):
                moved = [np.array(q), np.array(q_t)]
                moved[at] = moved[at] + h * change
                forces.append(np.array(element.force(mbs, 0.0, 0, moved[0].tolist(), moved[1].tolist())))
            numeric, expected = (forces[1] - forces[0]) / 1e-6, np.asarray(J) @ change
            for part in (slice(0, element.rigid_size), slice(element.rigid_size, None)):
                # truncation of central differences, and sets that change in some directions
                assert np.abs(numeric - expected)[part].max() < 2e-5 * np.abs(expected)[part].max()


def test_run_to_rest_is_the_equilibrium():
    described = bearing(BUSH)
    found = ehd.equilibrium(described, speed=SPEED, load=(1e3, -1.5e4))
    mbs, joint, _ = scene(described)
    joint.place_in_equilibrium(load=(1e3, -1.5e4))
    mbs.SolveDynamic(settings(2e-3, 20, tolerance=1e-8))
    q = np.array(mbs.GetNodeOutput(joint.element.bore_nodes[0], exu.OutputVariableType.Coordinates))
    motion = joint.history.motion[-1]
    # the spin has fallen by the film's friction meanwhile
    assert np.abs(motion[:2] - found.position).max() < 2e-3 * C
    assert np.abs(q - found.film.bore_coordinates).max() < 2e-3 * np.abs(q).max()
    assert joint.history.minimum_gap[-1] == pytest.approx(found.film.minimum_gap, rel=2e-3)


@pytest.mark.parametrize("control", [None, ehd.StepControl(largest_gap_change=0.5)])
def test_a_soft_journal_bends_by_more_than_the_clearance(control):
    """Rigid surfaces would be pressed through each other by more than the clearance, but the film is open.

    A step control looks at the film's thickness, not at the gap of rigid surfaces, which is closed.
    """
    soft = ehd.SaintVenantKirchhoff(youngs_modulus=3e9, poisson_ratio=0.3, density=7800.0)
    pin = ehd.ElasticJournal(material=soft, span=(-0.08, 0.08), held=BOSSES, inner_radius=0.015, tolerance=0.2)
    described = bearing(journal=pin, contact=ehd.RegularisedWall(onset=2e-6))
    mbs, joint, _ = scene(described, load=(0.0, -1e4), control=control)
    ehd.SolveDynamic(mbs, settings(4e-4, 8, tolerance=1e-8))
    history = joint.history
    assert history.largest_eccentricity_ratio[-1] > 2.5 and history.minimum_gap.min() > 0.5e-6
    assert history.time.size < 100


@pytest.mark.slow
def test_run_from_elsewhere_comes_to_rest_there():
    mbs, joint, _ = scene(bearing(), load=(0.0, -3e3))
    mbs.SolveDynamic(settings(0.1, 500, tolerance=1e-8))
    spin = joint.history.motion[-1, 8]
    found = ehd.equilibrium(bearing(), speed=spin, load=(0.0, -3e3))
    assert np.abs(joint.history.motion[-1, :2] - found.position).max() < 0.01 * C


@pytest.mark.slow
def test_nothing_depends_on_the_angle_of_the_journal():
    histories = []
    for angle in (0.0, 0.7):
        mbs, joint, _ = scene(bearing(), spin_angle=angle)
        mbs.SolveDynamic(settings(2e-3, 20, tolerance=1e-10))
        histories.append(joint.history)
    for name in ("minimum_gap", "peak_pressure", "bore_displacement"):
        a, b = (getattr(history, name) for history in histories)
        np.testing.assert_allclose(a, b, rtol=1e-7)


def test_force_and_moment_cancel_on_a_turning_housing():
    mbs, joint, _ = scene(bearing(BUSH), moving=True)
    element, unbalanced = joint.element, []
    evaluate = element._generalized_force

    def watch(trial):
        force, (a, b), F = evaluate(trial), element.sides, trial.evaluation.wrench
        loads = marker_loads(element, F, force)
        moment = loads[1] + loads[3] + np.cross(b.frame[:, 3] - a.frame[:, 3], loads[2])
        unbalanced.append(np.abs(loads[0] + loads[2]).max() / np.abs(F[:3]).max())
        unbalanced.append(np.abs(moment).max() / np.abs(F[3:]).max())
        return force

    element._generalized_force = watch
    mbs.SolveDynamic(settings(1e-3, 20, tolerance=1e-8))
    assert np.max(unbalanced) < 1e-10


def test_explicit_solvers_refuse_it():
    mbs, _, _ = scene(bearing(), moving=True)
    with pytest.raises(ehd.InputError, match=r"ElasticJournal have no mass.*implicit solver"):
        ehd.SolveDynamic(mbs, settings(1e-6, 2), solverType=exu.DynamicSolverType.RK44)


def test_picture_and_state():
    """The renderer's picture has both surfaces apart, a restart knows the modes."""
    mbs, joint, _ = scene(bearing(BUSH))
    data = joint.display.graphics(mbs, 0)
    assert data
    film = joint.film()
    assert film.bush_displacement.shape == (len(BUSH.build_mesh().nodes), 3)
    state = joint.state()
    joint.restore_state(state)
    other = scene(bearing(BUSH, journal=None))[1]
    with pytest.raises(ehd.InputError, match="another bearing"):
        other.restore_state(state)
