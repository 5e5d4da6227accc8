"""Nodal bushes on every kind of body: kinematics of the slaved nodes, Jacobian, starts in motion, runs, momentum and
energy."""

from __future__ import annotations

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from bodies import JACOBIANS
from elastic_scene import CYLINDER, STEEL, bearing
from rods import JOURNAL, PUSH, RING, rod, total

import exudyn_ehd as ehd
from exudyn_ehd.coupling.items.bush import CarriedOuter, CreateFlexibleBush
from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.coupling.items.reduced_bodies import positions, velocities
from tests.sampling import sample

SOFT = ehd.SaintVenantKirchhoff(youngs_modulus=1e8, poisson_ratio=0.3, density=2000.0)
CURRENT = exu.ConfigurationType.Current


def carried(kind, rates=0.0, seed=3):
    """System with a bush on a body in a random state."""
    mbs = scenes.new_system()
    body = JACOBIANS[kind](mbs)
    item = resolve(mbs, "item", body.item)
    point = item.position if body.point is None else np.array(body.point)
    bush = CreateFlexibleBush(
        mbs,
        bush=ehd.ANCFBush(mesh=RING, material=SOFT),
        outer=CarriedOuter(itemNumber=body.item),
        position=point + [0, 0, 0.02 * (kind != "ANCF beam node")],
    )
    mbs.Assemble()
    rng = np.random.default_rng(seed)
    n = mbs.systemData.ODE2Size()
    put(mbs, 1e-3 * rng.normal(size=n), rates * rng.normal(size=n))
    return mbs, body, bush


def put(mbs, q, q_t):
    mbs.systemData.SetODE2Coordinates(np.asarray(q).tolist())
    mbs.systemData.SetODE2Coordinates_t(np.asarray(q_t).tolist())


def state(bush):
    """Coordinates and rates of the carrier."""
    n = bush.equations.count
    return bush.coordinates()[n:], bush.coordinates_t()[n:]


# The averaged rotation of reduced finite elements is linear in small displacements only, 1e-3 here; a geometrically
# exact beam in space turns at its interpolated angular velocity to the square of its nodes' relative rotation.
LOOSE = {"reduced FE body Rxyz": 3e-4, "reduced FE body EP": 3e-4, "exact beam element": 1e-4}


@pytest.mark.parametrize("kind", [k for k in JACOBIANS if not k.endswith("RotVec") and k != "reduced FE body EP"])
def test_slaved_nodes_move_as_their_jacobian_and_accelerations_say(kind, measured):
    """Central differences along the rates, 1e-5 s. Random Euler parameters of Exudyn's own markers are no rotations,
    and rotation vectors don't change by their angular velocity: those are left out."""
    mbs, _, bush = carried(kind, rates=0.3)
    carrier = bush.equations.carrier
    q, q_t = state(bush)
    carrier.move(q, q_t)
    speed = (carrier.jacobian() @ q_t).reshape(-1, 3)
    scale = np.abs(speed).max()
    measured("velocity", np.abs(speed - velocities(carrier.side.frame, carrier.local)).max() / scale, 1e-12)
    acceleration = carrier.accelerations(q, q_t)[1]
    whole, rates = mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()
    places, rates_there, step = [], [], 1e-5
    for s in (1.0, -1.0):
        put(mbs, whole + s * step * rates, rates)
        carrier.move(*state(bush))
        places.append(positions(carrier.side.frame, carrier.local))
        rates_there.append(velocities(carrier.side.frame, carrier.local))
    by_place = np.abs((places[0] - places[1]) / (2 * step) - speed).max() / scale
    measured("place", by_place, LOOSE.get(kind, 1e-8))
    change = (rates_there[0] - rates_there[1]) / (2 * step)
    size = max(np.abs(change).max(), scale)
    measured("acceleration", np.abs(change - acceleration).max() / size, LOOSE.get(kind, 1e-8))


@pytest.mark.parametrize("kind", JACOBIANS)
def test_jacobian_of_a_bush_at_rest_is_the_derivative_of_its_force(kind, measured):
    mbs, _, bush = carried(kind)
    equations, places = bush.equations, mbs.systemData.GetObjectLTGODE2(bush.objectNumber)
    q = np.array(mbs.systemData.GetODE2Coordinates())
    zero = np.zeros_like(q)
    exact = equations.jacobian(None, 0.0, 0, q[places], zero[places], 1.0, 0.0).toarray()
    rng = np.random.default_rng(5)
    size, count = len(places), equations.count
    for part in (slice(0, count), slice(count, size)):
        d = np.zeros(size)
        d[part] = rng.normal(size=d[part].size)
        if kind.endswith("RotVec"):
            # rotation vectors are no incremental rotations
            d[count + 3 :] = 0.0
        ends = []
        for s in (1.0, -1.0):
            moved = q.copy()
            moved[places] += s * 1e-6 * d
            put(mbs, moved, zero)
            ends.append(equations.forces(0.0, moved[places], zero[places]))
        numeric = (ends[1] - ends[0]) / 2e-6
        limit = LOOSE.get(kind, 1e-6) if part.start else 1e-6
        measured(f"part {part}", np.abs(exact @ d - numeric).max() / np.abs(numeric).max(), limit)


def run(housing, steps=20, end=1e-3):
    """History of a run, errors of momentum and energy: impulse and work of the load by the trapezoidal rule."""
    mbs, joint = rod(housing)
    rows = []

    def record(mbs, t):
        momentum, kinetic = total(mbs)
        push = PUSH * np.array([1.0, np.cos(2000.0 * t)])
        speed = np.array(mbs.systemData.GetODE2Coordinates_t()[:2])
        rows.append((t, *push, push @ speed, *momentum, kinetic + joint.bush.energy()[0]))
        return True

    mbs.SetPostStepUserFunction(record)
    done = ehd.SolveDynamicSparse(mbs, scenes.settings(end, steps, tolerance=1e-10))
    assert done.rejected == 0 and done.iterations <= 9 * steps
    t, rest = np.array(rows)[:, 0], np.array(rows)[:, 1:]
    impulse, work = np.trapezoid(rest[:, :2], t, axis=0), np.trapezoid(rest[:, 2], t)
    lost = np.trapezoid(joint.history.power_loss, t)
    momentum = np.abs(rest[-1, 3:5] - rest[0, 3:5] - impulse).max() / np.abs(impulse).max()
    return joint.history, momentum, abs(rest[-1, 5] - rest[0, 5] + lost - work) / lost


@pytest.mark.slow
def test_a_planar_housing_and_a_link_of_a_tree_carry_the_bush_like_a_body_in_space(measured):
    """One set of equations in three sets of coordinates, Newton to 1e-10 of a step's first residual."""
    expected, *_ = run("space")
    assert np.ptp(expected.eccentricity_ratio) > 0.05
    for housing in ("planar", "tree"):
        record, momentum, _ = run(housing)
        # the generalized-alpha scheme averages the load's course over steps of 0.1 rad
        measured(f"{housing} momentum", momentum, 1e-4)
        for name in ("eccentricity_ratio", "minimum_gap", "peak_pressure", "power_loss"):
            a, b = getattr(record, name), getattr(expected, name)
            measured(f"{housing} {name}", np.abs(a - b).max() / np.abs(b).max(), 2e-8)


@pytest.mark.slow
def test_energy_of_a_planar_model_closes_to_the_order_of_the_integrator(measured):
    coarse, fine = run("planar")[2], run("planar", 40)[2]
    # the first step of 0.05 ms hardly resolves the squeezing that the load's sudden start brings
    measured("20 steps", coarse, 0.05)
    measured("40 steps", fine, coarse / 3.0)


MODAL = ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2, tilted=False)


@pytest.mark.slow
def test_modal_bushes_on_a_link_of_a_tree_start_and_run_as_on_a_planar_body(measured):
    """One set of equations in two sets of coordinates, from one start in equilibrium; a tree's marker has its rates by
    differences."""
    records = []
    for housing in ("planar", "tree"):
        mbs, joint = rod(housing, MODAL)
        mbs.SolveDynamic(scenes.settings(1e-3, 20, tolerance=1e-9))
        records.append(joint.history)
    expected, found = records
    assert len(expected.time) == len(found.time) == 21
    for name in ("eccentricity_ratio", "minimum_gap", "peak_pressure", "power_loss"):
        a, b = getattr(found, name), getattr(expected, name)
        measured(name, np.abs(a - b).max() / np.abs(b).max(), 1e-6)


def held(kind, bush):
    """System with a body as housing, and the joint."""
    mbs = scenes.new_system()
    body = JACOBIANS[kind](mbs)
    item = resolve(mbs, "item", body.item)
    point = item.position if body.point is None else np.array(body.point)
    journal = mbs.CreateRigidBody(
        referencePosition=list(point),
        initialDisplacement=[1e-5, -1e-5, 0],
        inertia=JOURNAL,
        create2D=body.planar,
        initialAngularVelocity=[0, 0, 314.0],
    )
    if item.is_marker:
        journal = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, 0]))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[body.item, journal],
        position=[] if item.is_marker else list(point),
        axis=[0, 0, 1],
        bearing=bearing(bush, n_theta=32, n_z=6, length=0.05),
        # beams and cables do not contain the steel
        bushGravity=(0.0, 0.0, 0.0) if isinstance(bush, ehd.ANCFBush) else None,
    )
    mbs.Assemble()
    return mbs, joint


@pytest.mark.parametrize(
    "kind", sample(JACOBIANS, *(k for k, kind in enumerate(JACOBIANS) if k % 4 == 0 and kind != "nodal FE body"))
)
def test_modal_bushes_start_in_equilibrium_on_every_body(kind, measured):
    mbs, joint = held(kind, dataclasses.replace(MODAL, mesh=RING))
    element = joint.element
    q = np.array(mbs.GetNodeOutput(element.bore_nodes[0], exu.OutputVariableType.Coordinates))
    evaluation = element.steps.look_at_accepted(mbs)[1].evaluation
    assert np.abs(q).max() > 1e-8
    load, spring = evaluation.bore.load, element.stiffness * q
    # velocities of markers come from differences of positions
    measured("force on the modes", np.abs(load - spring).max() / np.abs(spring).max(), 1e-6)
    mbs.SolveDynamic(scenes.settings(2e-5, 2, tolerance=1e-8))
    assert len(joint.history.time) == 3


def held_by(kind, bush, steps=10):
    """Gain of momentum, history and Newton iterations of a short run with a body as housing, Exudyn's own full
    Newton."""
    mbs, joint = held(kind, bush)
    before, _ = total(mbs)
    mbs.SolveDynamic(scenes.settings(steps * 2e-5, steps, tolerance=1e-8))
    return total(mbs)[0] - before, joint.history, mbs.sys["dynamicSolver"].it.newtonStepsCount


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind", sample(["ANCF beam element", "cable 2D element", "exact beam element", "reduced FE body Rxyz"], 0)
)
def test_flexible_bodies_carry_a_bush_under_a_film(kind, measured):
    """The housing's load alone gives momentum, 2e-4 Ns against a film force of 17 kN; as much as with a rigid
    bearing."""
    gain, history, iterations = held_by(kind, ehd.ANCFBush(mesh=RING, material=STEEL))
    assert len(history.time) == 11
    measured("Newton iterations per step", iterations / 10, 6.0)
    if "FE" not in kind:
        measured("momentum", np.abs(gain - held_by(kind, None)[0]).max(), 1e-10)
