"""Nodal bushes on beams, cables and finite-element bodies over periods of a rotating load: momentum, energy, Newton's
cost.

The housing floats freely; the load acts on the journal and turns with its spin, in the plane normal to its axis.
"""

from __future__ import annotations

import functools
from types import SimpleNamespace

import bodies
import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from elastic_scene import CLEARANCE, STEEL, bearing
from exudyn.utilities import InertiaCylinder
from rods import RING, total

import exudyn_ehd as ehd
from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.coupling.items.objects import as_sparse
from exudyn_ehd.coupling.run.system_matrix import SystemMatrix

SPEED, LOAD, PERIODS = 314.0, 4000.0, 2
PERIOD = 2.0 * np.pi / SPEED
JOURNAL = InertiaCylinder(7800, 0.15, 0.03, 2)
BUSH = ehd.ANCFBush(mesh=RING, material=STEEL)
HOUSINGS = {
    "ANCF beam": bodies.ancf_beam(),
    "cable": bodies.cable(2),
    "exact beam": bodies.exact_beam_2d,
    "reduced FE body": bodies.reduced_ring("Rxyz"),
    "nodal FE body": bodies.nodal_ring,
}


def load(t):
    """Turning force on the journal, full after the first period [N]."""
    ramp = 0.5 * (1.0 - np.cos(np.pi * min(t / PERIOD, 1.0)))
    return LOAD * ramp * np.array([np.cos(SPEED * t), np.sin(SPEED * t)])


class Run:
    """A run of ``fine`` steps per period, over all periods or so many ``steps``."""

    def __init__(self, kind, fine, steps=None, solve=None):
        self.mbs = mbs = scenes.new_system()
        self.body = HOUSINGS[kind](mbs)
        item = resolve(mbs, "item", self.body.item)
        point = item.position if self.body.point is None else np.array(self.body.point)
        self.flexible = exu.ObjectIndex(0)
        journal = mbs.CreateRigidBody(
            referencePosition=list(point),
            initialDisplacement=[0.3 * CLEARANCE, 0, 0],
            inertia=JOURNAL,
            create2D=True,
            initialAngularVelocity=[0, 0, SPEED],
        )
        self.journal = exu.NodeIndex(int(mbs.GetObject(journal)["nodeNumber"]))
        marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, 0]))
        force = lambda mbs, t, v: [*load(t), 0.0]  # noqa: E731
        mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=force))
        self.joint = ehd.CreateLubricatedJoint(
            mbs,
            name="b",
            itemNumbers=[self.body.item, marker if item.is_marker else journal],
            position=[] if item.is_marker else list(point),
            axis=[0, 0, 1],
            bearing=bearing(BUSH, n_theta=32, n_z=6, length=0.05, lubricant=ehd.Lubricant(viscosity=2e-3)),
            # the housings do not contain the steel
            bushGravity=(0.0, 0.0, 0.0),
        )
        mbs.Assemble()
        self.modes = self.body.nodes[1:] if kind == "reduced FE body" else ()
        self.stiffness = self.elements(kind)
        # the body's scene brings a constant load of its own
        self.dead_marker = exu.MarkerIndex(int(mbs.GetLoad(0)["markerNumber"]))
        self.dead = np.array(mbs.GetLoad(0)["loadVector"])[:2]
        self.rows, self.matrix = [], SystemMatrix(mbs)
        mbs.SetPostStepUserFunction(self.record)
        self.count = PERIODS * fine if steps is None else steps
        # the trapezoid of the loads misses (gamma - 1/2) h times the change of m a, five times as much at 0.6
        options = ehd.ConfigureSolver(scenes.settings(self.count * PERIOD / fine, self.count), spectralRadius=0.9)
        self.done = (solve or ehd.SolveDynamicSparse)(mbs, options)

    def elements(self, kind):
        """Stiffness of the housing's finite elements; None for beams and cables."""
        data = self.mbs.GetObject(self.flexible)
        if kind == "reduced FE body":
            return np.asarray(data["stiffnessMatrixReduced"].Convert2DenseMatrix())
        if kind == "nodal FE body":
            return as_sparse(data["stiffnessMatrix"]).tocsr()
        return None

    def record(self, mbs, t):
        momentum, kinetic = total(mbs, self.modes, self.matrix)
        q_t = np.array(mbs.systemData.GetODE2Coordinates_t())
        at = mbs.systemData.GetNodeLTGODE2(self.journal)[:2]
        strained, stored = self.housing(q_t)
        push = load(t) + self.dead
        power = load(t) @ q_t[at] + self.dead_power() - strained
        self.rows.append((t, *push, *momentum, power, kinetic + stored + self.joint.bush.energy()[0]))
        return True

    def housing(self, q_t):
        """Power that strains beams and cables [W], and energy that finite elements store [J]."""
        mbs, number = self.mbs, self.flexible
        own = mbs.systemData.GetObjectLTGODE2(number)
        if self.stiffness is None:
            return q_t[own] @ np.array(mbs.ComputeItem(number, exu.ComputeItemType.ODE2LHS)), 0.0
        q = np.array(mbs.systemData.GetODE2Coordinates())[own][-self.stiffness.shape[0] :]
        return 0.0, 0.5 * q @ (self.stiffness @ q)

    def dead_power(self):
        """Power of the constant load that the body's scene brings [W]."""
        velocity = self.mbs.GetMarkerOutput(self.dead_marker, exu.OutputVariableType.Velocity)
        return self.dead @ velocity[:2]

    def errors(self):
        """Error of momentum over the load's impulse in half a period, and of energy over the film's loss; trapezoidal
        rule."""
        rows = np.array(self.rows)
        t, push, momentum, power, energy = rows[:, 0], rows[:, 1:3], rows[:, 3:5], rows[:, 5], rows[:, 6]
        history = self.joint.history
        assert np.allclose(history.time, t, rtol=0, atol=1e-12) and np.all(np.isfinite(rows))
        lost = np.trapezoid(history.power_loss, t)
        gain = np.array([np.trapezoid(push[: k + 1], t[: k + 1], axis=0) for k in range(len(t))])
        balance = np.abs(momentum - momentum[0] - gain).max() / (2.0 * LOAD / SPEED)
        return balance, abs(energy[-1] - energy[0] + lost - np.trapezoid(power, t)) / lost


# The cable bends by its own length: its axial vibration is hardly resolved.
ENERGY = {"cable": 0.012}


@pytest.mark.slow
@pytest.mark.parametrize("kind", HOUSINGS)
def test_periods_of_a_turning_load(kind, measured):
    run = Run(kind, 100)
    history = run.joint.history
    assert run.done.rejected == 0 and len(history.time) == run.count + 1
    for name in ("motion", "force", "moment", "minimum_gap", "peak_pressure", "friction_torque", "power_loss"):
        assert np.all(np.isfinite(getattr(history, name)))
    assert 0.5 < history.eccentricity_ratio[100:].max() < 0.8
    measured("Newton iterations per step", run.done.iterations / run.count, 5.0)
    momentum, energy = run.errors()
    # second order: the trapezoidal rule on the load's course, 0.06 rad per step; four times as much with 50 steps
    measured("momentum", momentum, 1e-5)
    measured("energy", energy, ENERGY.get(kind, 5e-3))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["ANCF beam", "reduced FE body"])
def test_sparse_solver_takes_bodies_that_exudyn_differentiates_numerically(kind, measured):
    """Both solvers take equal steps to equal motions; this one needs at most 1.5 times Exudyn's iterations."""
    paths, iterations = [], []
    for solve in (ehd.SolveDynamicSparse, _by_exudyn):
        run = Run(kind, 50, steps=10, solve=functools.partial(_to_the_end, solve))
        assert len(run.joint.history.time) >= 11
        paths.append(run.mbs.systemData.GetODE2Coordinates())
        iterations.append(run.done.iterations)
    # either leaves 1e-8 of a step's first residual
    measured("motion", np.abs(paths[0] - paths[1]).max() / np.abs(paths[1]).max(), 1e-5)
    assert iterations[0] <= 1.5 * iterations[1]


def _to_the_end(solve, mbs, options):
    """Solve to a tight tolerance: at a looser one quasi-Newton and full Newton methods end at different residuals."""
    options.timeIntegration.newton.relativeTolerance = 1e-8
    return solve(mbs, options)


def _by_exudyn(mbs, options):
    mbs.SolveDynamic(options)
    return SimpleNamespace(iterations=mbs.sys["dynamicSolver"].it.newtonStepsCount, rejected=0)
