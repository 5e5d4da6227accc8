"""The joint in Exudyn's solvers: node types, implicit and explicit, static, planar, against Exudyn's own connector."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
import toy

from exudyn_ehd.coupling import api
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver
from exudyn_ehd.status import InputError
from tests.sampling import sample

GRAVITY = [0.0, -9.81, 0.0]


def spinning_pair(node, *, film=None, axial=None, ground=True, planar_spin=30.0):
    """A journal that spins and moves off centre in ground or in a free turning housing."""
    mbs = scenes.new_system()
    housing = scenes.add_body(mbs, "ground" if ground else node, spin=[] if ground else (0, 0, 5.0))
    journal = scenes.add_body(
        mbs, node, (0.05, 0, 0), velocity=(0.0, 0.1, 0), spin=(0, 0, planar_spin), gravity=GRAVITY
    )
    options = {} if axial is None else {"axial": axial}
    joint = toy.attach(mbs, [housing, journal], film or toy.ToyFilm(), position=[0.05, 0, 0], name="pin", **options)
    return mbs, joint, journal


def run(mbs, settings, solver=None):
    mbs.Assemble()
    mbs.SolveDynamic(settings, **({} if solver is None else {"solverType": solver}))


@pytest.mark.slow
@pytest.mark.parametrize("ground", sample([True, False], 1))
def test_node_types_give_the_same_motion(ground):
    histories = []
    for node in ("EP", "Rxyz", "RotVec"):
        mbs, joint, _ = spinning_pair(node, ground=ground)
        run(mbs, scenes.settings(0.01, 400))
        histories.append(joint.history)
    e = [h.eccentricity for h in histories]
    size = np.abs(e[0]).max()
    # the three integrate rotations differently, each with an error O(h^2) of the angle 0.3 rad in 400 steps; the orbit
    # feels the spin only through its value
    np.testing.assert_allclose(e[1], e[0], rtol=0, atol=1e-5 * size)
    np.testing.assert_allclose(e[2], e[0], rtol=0, atol=1e-5 * size)


def test_planar_body_moves_as_the_spatial_one():
    results = []
    for node in ("2D", "RotVec"):
        mbs, joint, _ = spinning_pair(node)
        run(mbs, scenes.settings(0.01, 400))
        results.append(joint.history)
    size = np.abs(results[1].eccentricity).max()
    # as above: only the rotational update differs
    np.testing.assert_allclose(results[0].eccentricity, results[1].eccentricity, rtol=0, atol=1e-5 * size)
    assert np.abs(results[0].motion[:, [2, 3, 9]]).max() == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("node", ["Rxyz", "RotVec", "2D"])
def test_implicit_and_explicit_agree(node):
    results = []
    for solver, steps in ((exu.DynamicSolverType.RK44, 1000), (exu.DynamicSolverType.GeneralizedAlpha, 4000)):
        mbs, joint, _ = spinning_pair(node)
        run(mbs, scenes.settings(0.01, steps), solver)
        results.append(joint.history)
    assert len(results[0].time) == 1001
    size = np.abs(results[0].eccentricity).max()
    # RK44 is converged to 1e-8; the implicit solver is of second order with (h * 580 rad/s)^2 = 2e-6 of phase error
    # per radian, over 6 rad of oscillation
    np.testing.assert_allclose(results[1].eccentricity[::4], results[0].eccentricity, rtol=0, atol=1e-4 * size)


def test_explicit_solvers_refuse_euler_parameters():
    """A fact of Exudyn that the documentation relies on."""
    mbs, _, _ = spinning_pair("EP")
    with pytest.raises(exu.ExudynError, match="algebraic"):
        run(mbs, scenes.settings(0.001, 10), exu.DynamicSolverType.RK44)


@pytest.mark.parametrize("node", ["EP", "RotVec", "2D"])
def test_static_equilibrium(node):
    """Weight in the direction of gravity, balanced by stiffness and wedge at the given constant spin."""
    film = toy.ToyFilm(axial=True)
    mbs = scenes.new_system()
    spin = 30.0
    housing = scenes.add_body(mbs, "ground")
    journal = scenes.add_body(mbs, node, spin=(0, 0, spin), gravity=GRAVITY)
    joint = toy.attach(mbs, [housing, journal], film, position=[0, 0, 0])
    # friction and the free axial direction leave rigid motions: hold them
    scenes.hold_axially_and_in_spin(mbs, housing, journal)
    mbs.Assemble()
    mbs.SolveStatic(scenes.settings(1, 1))
    history = joint.history
    weight = 6.0 * 9.81
    # Newton's relative tolerance 1e-10 of the residual, in the direction that the connector doesn't share
    np.testing.assert_allclose(history.force[-1], [0.0, weight, 0.0], rtol=0, atol=1e-7 * weight)
    c, k, d = film.bearing.radial_clearance, film.stiffness, film.wedge * spin
    e = history.eccentricity[-1]
    g = 1.0 / (1.0 - e @ e / c**2)
    assert g * np.hypot(k, d) * np.hypot(*e) == pytest.approx(weight, rel=1e-6)
    assert history.time[0] == 0.0
    assert history.time[-1] == 1.0


@pytest.mark.parametrize("node", ["EP", "Rxyz"])
def test_same_motion_as_exudyns_spring_damper(node):
    """A linear film without wedge is an ObjectConnectorRigidBodySpringDamper with the same stiffness and damping.

    The connector acts at the two markers and measures velocities without the turning of the frame; with ground as
    housing, a journal marker in the mid-plane and no tilting stiffness, both laws are one.
    """
    film = toy.ToyFilm(linear=True, wedge=0.0, tilting=0.0, friction=0.0, axial_drag=0.0)
    film.law = _linear_law(film)
    end = []
    for mine in (True, False):
        mbs = scenes.new_system()
        housing = scenes.add_body(mbs, "ground")
        journal = scenes.add_body(mbs, node, (0.02, 0, 0), velocity=(0, 0.1, 0), spin=(0, 0, 30.0), gravity=GRAVITY)
        if mine:
            toy.attach(mbs, [housing, journal], film, position=[0, 0, 0])
        else:
            ends = [
                mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=b, localHT=exu.HT(translation=p)))
                for b, p in ((housing, [0, 0, 0]), (journal, [-0.02, 0, 0]))
            ]
            mbs.AddObject(
                eii.ObjectConnectorRigidBodySpringDamper(
                    markerNumbers=ends,
                    stiffness=np.diag([film.stiffness, film.stiffness, 0, 0, 0, 0]),
                    damping=np.diag([film.damping, film.damping, 0, 0, 0, 0]),
                    useIntrinsicFormulation=False,
                )
            )
        run(mbs, scenes.settings(0.01, 100, tolerance=1e-12))
        end.append(mbs.GetObjectOutputBody(journal, exu.OutputVariableType.Position, [0, 0, 0]))
    # both stop at Newton's tolerance (1e-12 of the initial residual), which two unlike Jacobians reach differently
    np.testing.assert_allclose(end[0], end[1], rtol=0, atol=1e-10 * 0.02)


def _linear_law(film):
    def law(m):
        wrench, tangent = np.zeros(6), np.zeros((6, 10))
        wrench[:2] = -film.stiffness * m[:2] - film.damping * m[4:6]
        # the connector's force on ground acts at ground's marker, its force on the journal at the journal's: the
        # moment about the joint's origin is e x F
        wrench[5] = m[0] * wrench[1] - m[1] * wrench[0]
        tangent[0, 0] = tangent[1, 1] = -film.stiffness
        tangent[0, 4] = tangent[1, 5] = -film.damping
        tangent[5] = m[0] * tangent[1] - m[1] * tangent[0]
        tangent[5, 0] += wrench[1]
        tangent[5, 1] -= wrench[0]
        return wrench, tangent

    return law


def test_held_journal_stays_in_its_plane():
    for axial, drift in ((api.Free(), True), (api.Held(), False)):
        mbs = scenes.new_system()
        housing = scenes.add_body(mbs, "RotVec", gravity=[0, 0, 0])
        journal = scenes.add_body(mbs, "RotVec", (0, 0, 0.1), velocity=(0, 0, 0.5), spin=(0, 0, 10.0))
        joint = toy.attach(mbs, [housing, journal], toy.ToyFilm(), position=[0, 0, 0], axial=axial)
        run(mbs, scenes.settings(0.01, 50))
        positions = [
            mbs.GetObjectOutputBody(b, exu.OutputVariableType.Position, [0, 0, 0])[2] for b in (housing, journal)
        ]
        distance = positions[1] - positions[0] - 0.1
        assert (joint.constraintNumber is None) == drift
        if drift:
            # 0.5 m/s for 0.01 s, braked by the drag of 3 N s / m on 3 kg reduced mass: 1 %
            assert distance == pytest.approx(0.005, rel=0.02)
        else:
            # Newton's tolerance on the constraint
            assert abs(distance) < 1e-12


def test_held_is_refused_by_explicit_solvers():
    """Exudyn does it, before the film is asked; the joint's docstring relies on it."""
    mbs, _, _ = spinning_pair("RotVec", axial=api.Held())
    with pytest.raises(exu.ExudynError, match="constraints that cannot be solved"):
        run(mbs, scenes.settings(0.001, 10), exu.DynamicSolverType.RK44)


def test_planar_pair_needs_no_axial_constraint():
    mbs, joint, _ = spinning_pair("2D", axial=api.Held())
    assert joint.constraintNumber is None
    run(mbs, scenes.settings(0.001, 10))


def test_eigenvalues_and_linearisation_run():
    film = toy.ToyFilm()
    mbs, _, _ = spinning_pair("Rxyz", film=film, planar_spin=0.0)
    mbs.Assemble()
    mass, stiffness, damping = mbs.ComputeLinearizedSystem(scenes.settings(1, 1))
    # concentric and at rest: the toy's constants, exact
    assert stiffness[0, 0] == pytest.approx(film.stiffness, rel=1e-12)
    assert damping[1, 1] == pytest.approx(film.damping, rel=1e-12)
    assert mass[0, 0] == pytest.approx(6.0, rel=1e-12)


def test_any_rigid_marker_works_as_the_node_itself():
    """The path through Exudyn's marker Jacobians, forced on a rigid body, moves as the kernels do."""
    from exudyn_ehd.coupling.kinematics.sides import MarkerSide

    ends = []
    for generic in (False, True):
        mbs, joint, journal = spinning_pair("Rxyz", ground=False)
        if generic:
            marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, 0]))
            side = MarkerSide(marker, joint.element.sides[1].nodes, np.eye(3))
            joint.element.sides = (joint.element.sides[0], side)
        # the same film with the bearing at the journal's reference point, so that the marker needs no offset
        run(mbs, scenes.settings(0.01, 100))
        ends.append(joint.history)
    np.testing.assert_array_equal(ends[1].time, ends[0].time)
    # Newton's tolerance: the generic Jacobian lacks the velocity term
    size = np.abs(ends[0].eccentricity).max()
    np.testing.assert_allclose(ends[1].eccentricity, ends[0].eccentricity, rtol=0, atol=1e-8 * size)


def test_settings_helper_sets_what_it_says():
    settings = exu.SimulationSettings()
    assert ConfigureSolver(settings) is settings
    assert settings.timeIntegration.newton.relativeTolerance == 1e-6
    assert not settings.timeIntegration.newton.useModifiedNewton
    assert settings.timeIntegration.generalizedAlpha.spectralRadius == 0.6
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    assert ConfigureSolver(settings).timeIntegration.generalizedAlpha.spectralRadius == 0.8
    assert ConfigureSolver(settings, spectralRadius=0.9).timeIntegration.generalizedAlpha.spectralRadius == 0.9
    with pytest.raises(InputError, match="spectralRadius"):
        ConfigureSolver(settings, spectralRadius=1.1)
    with pytest.raises(InputError):
        ConfigureSolver(settings, relativeTolerance=0.0)
