"""The film on a user's ObjectFFRFreducedOrder as journal: against rigid and elastic ones, and itself turned."""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.FEM import ObjectFFRFreducedOrderInterface
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError
from tests.finite_elements import fem_of

R, L, SPAN, C, SPEED, LOAD = 0.02, 0.03, 0.06, 20e-6, 300.0, 4e3
SHAFT = ehd.HollowCylinder(inner_radius=0.012, thickness=0.008, length=SPAN, axial=4, radial=1, circumferential=16)


def material(modulus):
    return ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0)


def bearing(journal, **options):
    given = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=0.02),
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
        "journal": journal,
    }
    return ehd.JournalBearing(**(given | options))


def shaft(mbs, modulus=2.1e11, tolerance=0.1, tilted=False, **placed):
    """A hollow shaft whose end faces carry its frame; its body's object, the rigid node and the FEMinterface."""
    mesh = SHAFT.mesh()
    fem = fem_of(mesh, material(modulus))
    ends = np.flatnonzero(np.abs(np.abs(mesh.nodes[:, 2]) - 0.5 * SPAN) < 1e-9)
    ehd.add_bore_modes(
        fem, position=[0, 0, 0], axis=[0, 0, 1], radius=R, length=L, fixed_nodes=ends, tolerance=tolerance,
        tilted=tilted,
    )  # fmt: skip
    cms = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType="NodeType.RotationRxyz")
    parts = cms.AddObjectFFRFreducedOrder(mbs, **placed)
    return parts["oFFRFreducedOrder"], parts["nRigidBody"], fem


def cylinder(modulus=2.1e11):
    """The shaft as an elastic journal."""
    half = 0.5 * SPAN
    return ehd.ElasticJournal(
        material=material(modulus), span=(-half, half), held=ehd.HeldEnds(), inner_radius=0.012, tolerance=0.05,
        tilted=False,
    )  # fmt: skip


def run(kind, steps=40, step=2.5e-5, angle=0.0, modulus=2.1e11, balanced=None):
    """A journal that spins under a load that swings, from where a rigid one is in balance, or another one."""
    mbs = scenes.new_system()
    place = ehd.equilibrium(bearing(balanced), speed=SPEED, load=(0.0, -LOAD)).position
    start = {"initialVelocity": [0.0, 0.0, 0.0], "initialAngularVelocity": [0.0, 0.0, SPEED]}
    matrix = scenes.rotation([0.0, 0.0, angle])
    described = None
    if kind == "finite elements":
        journal, node, fem = shaft(mbs, modulus, rotationMatrixRef=matrix, **start)
        displaced = np.array(mbs.GetNodeParameter(node, "initialCoordinates"))
        displaced[:2] = place
        mbs.SetNodeParameter(node, "initialCoordinates", displaced.tolist())
        marker = mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=node))
        described = ehd.FEJournal(fem=fem)
    else:
        journal = mbs.CreateRigidBody(
            referenceRotationMatrix=matrix,
            initialDisplacement=[*place, 0.0],
            inertia=InertiaCylinder(7800, SPAN, R, 2, 0.012),
            nodeType=exu.NodeType.RotationRxyz,
            **start,
        )
        marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal))
        if kind == "elastic journal":
            described = cylinder(modulus)
    joint = ehd.CreateLubricatedJoint(
        mbs, kind, [mbs.CreateGround(), journal], [0, 0, 0], [0, 0, 1], bearing(described)
    )

    def swing(mbs, t, vector):
        phase = 1.0 - np.cos(4.0 * SPEED * t)
        return [0.4 * LOAD * phase, -LOAD * (1.0 + 0.3 * phase), 0.0]

    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, -LOAD, 0], loadVectorUserFunction=swing))
    mbs.Assemble()
    settings = scenes.settings(steps * step, steps, tolerance=1e-8, full_newton=False)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.5
    mbs.SolveDynamic(settings)
    return joint


def moving(housing_moves=True):
    """A free body and its housing, turned and moving, at a random state."""
    mbs = scenes.new_system()
    rotation = scenes.rotation([0.3, -0.5, 0.2])
    journal, _, fem = shaft(mbs, tolerance=0.2, tilted=True, rotationMatrixRef=rotation)
    housing = scenes.add_body(mbs, "Rxyz", matrix=rotation)
    joint = ehd.CreateLubricatedJoint(
        mbs, "b", [housing, journal], [0, 0, 0], rotation[:, 2], bearing(ehd.FEJournal(fem=fem))
    )
    mbs.Assemble()
    rng, element = np.random.default_rng(2), joint.element
    n_h, n = element.sides[0].size, element.rigid_size
    q, q_t = np.zeros(n), np.zeros(n)
    q[n_h + 6 :], q_t[n_h + 6 :] = 1e-7 * rng.normal(size=n - n_h - 6), 1e-5 * rng.normal(size=n - n_h - 6)
    q[n_h : n_h + 6] = [5e-6, -8e-6, 3e-6, 1e-5, -2e-5, 0.7]
    q_t[:6] = q_t[n_h : n_h + 6] = [0.1, 0.2, -0.1, 0.4, -0.3, 0.5]
    q_t[n_h : n_h + 6] += [1e-3, 2e-3, 0, 1e-3, 1e-3, 200.0]
    return mbs, joint, np.concatenate((q, q[n_h + 6 :])), np.concatenate((q_t, q_t[n_h + 6 :]))


@pytest.mark.slow
def test_jacobian_is_the_derivative_of_the_force():
    """Differences move housing, frame and modes together, as Exudyn moves them.

    The Jacobian omits the second order of the body's deformation in its frame; steps are as small as rounding allows.
    """
    mbs, joint, q, q_t = moving()
    element, rng = joint.element, np.random.default_rng(3)
    n_h, n, k = element.sides[0].size, element.rigid_size, element.stiffness.size
    assert (len(q), element.sides[1].size) == (n + k, 6 + k)
    for f_q, f_qt, at, h in ((1.0, 0.0, 0, 1e-5), (0.0, 1.0, 1, 1e-5)):
        J = np.asarray(element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), f_q, f_qt))
        for scale in (np.r_[np.full(n_h, 1e-4), np.full(6, 1e-4)], np.r_[np.zeros(n_h + 5), 1.0], np.zeros(n_h + 6)):
            modes = 1e-5 * rng.normal(size=k) * (1.0 if not scale.any() else 0.0)
            change = np.concatenate((scale * rng.normal(size=n_h + 6), modes, modes)) * (1.0 if at == 0 else 1e3)
            forces = []
            for sign in (1.0, -1.0):
                moved = [q.copy(), q_t.copy()]
                moved[at] += sign * h * change
                forces.append(np.array(element.force(mbs, 0.0, 0, moved[0].tolist(), moved[1].tolist())))
            numeric, expected = (forces[1] - forces[0]) / (2.0 * h), J @ change
            for part in (slice(0, n_h), slice(n_h, n), slice(n, None)):
                size = np.abs(expected)[part].max()
                assert np.abs(numeric - expected)[part].max() < 1e-4 * size + 1e-9 * np.abs(expected).max()


@pytest.mark.slow
def test_film_power_is_that_of_all_coordinates():
    """Generalized forces times rates: what wrench, relative motion, and modal loads have."""
    mbs, joint, q, q_t = moving()
    element = joint.element
    force = np.asarray(element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist()))
    found = element.last.evaluation
    housing, journal = (side.frame for side in element.sides)
    A = housing[:, :3]
    r, spin = A.T @ (journal[:, 3] - housing[:, 3]), A.T @ (journal[:, 5] - housing[:, 5])
    slip = A.T @ (journal[:, 4] - housing[:, 4]) - np.cross(A.T @ housing[:, 5], r)
    F, M = found.wrench[:3], found.wrench[3:]
    # of the journal's point at the housing's origin, relative
    power = F @ (slip - np.cross(spin, r)) + M @ spin + found.bore.load @ found.bore.rates
    assert force @ q_t == pytest.approx(power, rel=1e-9)
    # the film takes what its own balance says, to the grid's error of what the tilting journal does
    assert -power == pytest.approx(found.quantities()["power_loss"], rel=1e-3)


@pytest.mark.slow
def test_stiff_body_is_a_rigid_journal(measured):
    """A million times as stiff as steel, from the first step on. Its smallest gap is that of a vertex."""
    with pytest.warns(ehd.PlausibilityWarning, match="youngs_modulus"):
        body = run("finite elements", modulus=2.1e17).history
    rigid = run("rigid").history
    limits = {"peak_pressure": 1e-4, "eccentricity": 1e-5, "friction_torque": 1e-5, "minimum_gap": 1e-3}
    for name, limit in limits.items():
        own, other = getattr(body, name), getattr(rigid, name)
        measured(name, np.abs(own - other).max() / np.abs(other).max(), limit)


@pytest.mark.slow
def test_body_of_revolution_is_an_elastic_journal(measured):
    """Modes that turn with a body, and modes that stand, from the first step on, on a coarse mesh.

    The body starts as grown by its spin, and where the elastic journal is in balance: else the shaft's bending rings.
    """
    rigid, elastic, body = (
        run(k, steps=200, balanced=cylinder()).history for k in ("rigid", "elastic journal", "finite elements")
    )
    for name in ("peak_pressure", "minimum_gap"):
        expected = getattr(elastic, name)
        measured(name, np.abs(getattr(body, name) / expected - 1.0).max(), 0.04)
    after = slice(40, None)
    assert np.abs(rigid.minimum_gap[after] / elastic.minimum_gap[after] - 1.0).max() > 0.07


@pytest.mark.slow
def test_nothing_depends_on_the_angle_of_a_body_of_revolution(measured):
    """But for its mesh of 16 elements around."""
    histories = [run("finite elements", angle=angle).history for angle in (0.0, 0.5)]
    for name in ("minimum_gap", "peak_pressure"):
        a, b = (getattr(history, name) for history in histories)
        measured(name, np.abs(a / b - 1.0).max(), 0.01)


@pytest.mark.slow
def test_run_can_be_kept_judged_and_seen(tmp_path):
    joint = run("finite elements", steps=10)
    assert joint.display.graphics(joint.mbs, 0)
    state = joint.state()
    joint.restore_state(state)
    film = joint.film()
    assert film.bush_displacement is None
    assert film.pressure.max() > 0.0
    assert "journal elasticity" in str(joint.audit())
    with pytest.raises(InputError, match="must be a rigid body or node"):
        joint.place_in_equilibrium(load=(0, -1e3))
    with pytest.raises(InputError, match="'finite elements' has a ball, the bore or journal of a finite-element"):
        ehd.SolveEquilibrium(joint.mbs, SPEED)


def test_input_that_cannot_be_meant():
    mbs = scenes.new_system()
    body, _, fem = shaft(mbs, tolerance=0.2)
    ground, rigid = mbs.CreateGround(), scenes.add_body(mbs, "Rxyz")
    pin = ehd.ElasticJournal(material=material(2e11), span=(-0.03, 0.03), held=ehd.HeldEnds(), inner_radius=0.01)
    faces = ehd.ThrustFaces(inner_radius=0.022, outer_radius=0.03, clearance=2e-5)
    for item, described, match in (
        (body, bearing(None), "journal=FEJournal"),
        (body, bearing(pin), "journal=FEJournal"),
        (rigid, bearing(ehd.FEJournal(fem=fem)), "itemNumbers\\[1\\]"),
        (body, bearing(ehd.FEJournal(fem=fem), thrust=faces), "collars"),
        (body, bearing(ehd.FEJournal(fem=fem), journal_radius=0.015), "nodes lie on the bore"),
        (body, bearing(ehd.FEJournal(fem=fem), length=0.07), "must span the film"),
    ):
        with pytest.raises(InputError, match=match):
            ehd.CreateLubricatedJoint(mbs, "", [ground, item], [0, 0, 0], [0, 0, 1], described)


@pytest.mark.slow
def test_start_does_not_depend_on_the_order_of_joints():
    """A floating ring with a film on either side grows by its spin whatever joint is made first."""
    inner, half = R + C, 0.5 * L
    mesh = ehd.HollowCylinder(
        inner_radius=inner, thickness=0.006, length=L, axial=2, radial=1, circumferential=16
    ).mesh()
    fem = fem_of(mesh, material(2.1e11))
    middle = np.abs(np.hypot(*mesh.nodes[:, :2].T) - inner - 0.003) < 1e-3
    ends = np.flatnonzero(middle & (np.abs(mesh.nodes[:, 2] + half) < 1e-9))
    for radius in (inner, inner + 0.006):
        ehd.add_bore_modes(
            fem, position=[0, 0, 0], axis=[0, 0, 1], radius=radius, length=L, fixed_nodes=ends, tolerance=0.2,
            tilted=False,
        )  # fmt: skip
    found = []
    for order in ((0, 1), (1, 0)):
        mbs = scenes.new_system()
        pin, housing = scenes.add_body(mbs, "Rxyz", spin=(0.0, 0.0, 900.0)), scenes.add_body(mbs, "Rxyz")
        cms = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType="NodeType.RotationRxyz")
        parts = cms.AddObjectFFRFreducedOrder(mbs, initialVelocity=[0.0] * 3, initialAngularVelocity=[0.0, 0.0, 400.0])
        ring = parts["oFFRFreducedOrder"]
        joints = (
            ([ring, pin], bearing(None, bush=ehd.FEBore(fem=fem))),
            ([housing, ring], bearing(ehd.FEJournal(fem=fem), journal_radius=inner + 0.006)),
        )
        for k in order:
            ehd.CreateLubricatedJoint(mbs, f"film {k}", joints[k][0], [0, 0, 0], [0, 0, 1], joints[k][1])
        names = ("initialCoordinates", "initialCoordinates_t")
        found.append([np.array(mbs.GetNodeParameter(parts["nGenericODE2"], name)) for name in names])
    assert np.abs(found[0][0]).max() > 1e-8
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-8 * np.abs(one).max())
