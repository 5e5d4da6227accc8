"""A free journal in a bearing on a housing that stands, or turns and accelerates; energies, powers and momenta of every
step."""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.utilities import InertiaCylinder, RigidBodyInertia
from scenes import marker_loads, new_system, rotation

import exudyn_ehd as ehd
from exudyn_ehd.solid.total_lagrange import TotalLagrange

SPEED = 3000 * 2 * np.pi / 60
CLEARANCE = 30e-6
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
HOUSING, JOURNAL = InertiaCylinder(7800, 0.1, 0.08, 2, 0.05), InertiaCylinder(7800, 0.3, 0.03, 2)
LOAD, SWING, OFFSET = 15e3, 314.0, 3e-3


def bearing(bush=None, n_theta=48, n_z=8, **options):
    given = {
        "journal_radius": 0.03,
        "length": 0.066,
        "radial_clearance": CLEARANCE,
        "lubricant": ehd.Lubricant(viscosity=9e-3),
        "film": ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
        "bush": bush,
    }
    return ehd.JournalBearing(**(given | options))


def with_bush(own, material=STEEL):
    """Inertia of housing and bush together."""
    mesh = CYLINDER.mesh()
    mass = TotalLagrange(mesh=mesh, material=material).scalar_mass
    second = mesh.nodes.T @ (mass @ mesh.nodes)
    return RigidBodyInertia(
        mass=own.Mass() + mass.sum(),
        com=np.zeros(3),
        inertiaTensor=np.array(own.InertiaCOM()) + np.trace(second) * np.eye(3) - second,
    )


def journal_load(t):
    """Force on the journal, off its centre: it swings around and tilts the journal."""
    return np.array([0.4 * LOAD * np.sin(SWING * t), -LOAD * (1.0 - 0.3 * np.cos(SWING * t)), 0.0])


def housing_load(t):
    """Force and torque on a moving housing."""
    return np.array([0.8 * LOAD, 0.7 * LOAD * np.cos(200.0 * t), 500.0]), np.array(
        [50.0, 80.0 * np.sin(300.0 * t), 60.0]
    )


class Scene:
    """Bodies, joint and record.

    Parameters
    ----------
    bearing : JournalBearing
    moving : bool
        Housing on a free body that turns and is accelerated; else ground, and the journal is held axially.
    """

    def __init__(self, bearing, *, moving=False):
        self.mbs = mbs = new_system()
        self.moving = moving
        A, turn = np.eye(3), np.zeros(3)
        self.solids = []
        if moving:
            A = rotation([0.4, -0.7, 0.3])
            turn = A @ [3.0, -2.0, 5.0]
            inertia = with_bush(HOUSING) if isinstance(bearing.bush, ehd.ANCFBush) else HOUSING
            item = mbs.CreateRigidBody(
                referenceRotationMatrix=A,
                inertia=inertia,
                initialVelocity=[0.3, -0.2, 0.1],
                initialAngularVelocity=list(turn),
            )
            self.solids.append((item, inertia))
            self._push(item, 0.0, lambda t: housing_load(t)[0])
            self._twist(item, lambda t: housing_load(t)[1])
        else:
            item = mbs.CreateGround()
        place = A @ [0.4 * CLEARANCE, -0.5 * CLEARANCE, 0.0]
        self.journal = mbs.CreateRigidBody(
            referenceRotationMatrix=A,
            initialDisplacement=list(place),
            inertia=JOURNAL,
            initialVelocity=list(np.array([0.3, -0.2, 0.1]) * moving + np.cross(turn, place)),
            initialAngularVelocity=list(A @ [0.0, 0.0, SPEED] + turn),
        )
        self.solids.append((self.journal, JOURNAL))
        self._push(self.journal, OFFSET, journal_load)
        self.joint = ehd.CreateLubricatedJoint(
            mbs,
            name="b",
            itemNumbers=[item, self.journal],
            position=[0, 0, 0],
            axis=list(A[:, 2]),
            bearing=bearing,
            axial=ehd.Free() if moving else ehd.Held(),
        )
        mbs.Assemble()
        self.times, self.rows, self.cancelling = [], [], []

    def _push(self, body, z, force):
        marker = self.mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[0, 0, z]))
        self.mbs.AddLoad(
            eii.LoadForceVector(
                markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=lambda mbs, t, v: list(force(t))
            )
        )

    def _twist(self, body, torque):
        marker = self.mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body))
        self.mbs.AddLoad(
            eii.LoadTorqueVector(
                markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=lambda mbs, t, v: list(torque(t))
            )
        )

    def run(self, settings, solve=None):
        """Integrate and record every accepted step, the initial state included."""
        element = self.joint.element
        evaluate = element._generalized_force

        def watch(trial):
            force = evaluate(trial)
            self.cancelling.append(self.unbalance(force, trial.evaluation.wrench))
            return force

        element._generalized_force = watch
        self.mbs.SetPostStepUserFunction(self._record)
        return self.mbs.SolveDynamic(settings) if solve is None else solve(self.mbs, settings)

    def _record(self, mbs, t):
        momenta = self.momentum()
        force, moment = self.input_loads(t)
        self.times.append(t)
        self.rows.append((*self.energies(), self.input_power(t), self.bush_damping(), *momenta, *force, *moment))
        return True

    def output(self, body, kind, z=0.0):
        return np.array(self.mbs.GetObjectOutputBody(body, getattr(exu.OutputVariableType, kind), [0, 0, z]))

    def unbalance(self, generalized, wrench):
        """Force and moment of the film on journal, bush and housing together over those on the journal."""
        element = self.joint.element
        a, b = element.sides
        loads = marker_loads(element, wrench, generalized)
        force, moment = loads[2].copy(), loads[3] + np.cross(b.frame[:, 3] - a.frame[:, 3], loads[2])
        if self.joint.bush is None:
            force += loads[0]
            moment += loads[1]
        else:
            nodal = generalized[element.rigid_size :].reshape(-1, 3)
            assert not generalized[: a.size].any()
            force += nodal.sum(axis=0)
            moment += np.cross(element.arms, nodal).sum(axis=0)
        # a trial of Newton's may find a film without any pressure: then in N and Nm
        sizes = [max(float(np.abs(w).max()), 1.0) for w in (wrench[:3], wrench[3:])]
        return max(np.abs(force).max() / sizes[0], np.abs(moment).max() / sizes[1])

    def energies(self):
        """Kinetic and elastic energy, J; the liner's is not in it."""
        kinetic, elastic, element = 0.0, 0.0, self.joint.element
        for body, solid in self.solids:
            v, w = self.output(body, "Velocity"), self.output(body, "AngularVelocityLocal")
            kinetic += 0.5 * (solid.Mass() * v @ v + w @ np.array(solid.InertiaCOM()) @ w)
        if self.joint.bush is not None:
            elastic, moving = self.joint.bush.energy()
            return kinetic + moving, elastic
        if hasattr(element, "stiffness"):
            q = np.array(self.mbs.GetNodeOutput(element.bore_nodes[0], exu.OutputVariableType.Coordinates))
            elastic = 0.5 * float(q @ (element.stiffness * q))
        return kinetic, elastic

    def liner_energy(self):
        """Energy of an elastic liner at the film evaluated last, int p delta / 2 dA, J."""
        model = self.joint.element.model
        pressure = model.solver.pressure * model.scales.pressure
        area = model.grid.weight * model.grid.reference_length**2
        return 0.5 * float(np.sum(pressure * model.solver.elements.deflection * CLEARANCE * area))

    def momentum(self):
        """Linear and angular momentum (6,) of bodies and bush about the global origin."""
        total = np.zeros(6)
        for body, solid in self.solids:
            p, v = self.output(body, "Position"), self.output(body, "Velocity")
            A, w = self.output(body, "RotationMatrix").reshape(3, 3), self.output(body, "AngularVelocityLocal")
            total[:3] += solid.Mass() * v
            total[3:] += solid.Mass() * np.cross(p, v) + A @ np.array(solid.InertiaCOM()) @ w
        if self.joint.bush is not None:
            total += np.concatenate(self.joint.bush.momentum())
        return total

    def input_loads(self, t):
        """Force and moment about the global origin of the loads."""
        force = journal_load(t)
        moment = np.cross(self.output(self.journal, "Position", OFFSET), force)
        if self.moving:
            push, torque = housing_load(t)
            moment = moment + np.cross(self.output(self.solids[0][0], "Position"), push) + torque
            force = force + push
        return force, moment

    def input_power(self, t):
        """Power of the loads, W."""
        power = journal_load(t) @ self.output(self.journal, "Velocity", OFFSET)
        if self.moving:
            force, torque = housing_load(t)
            body = self.solids[0][0]
            power += force @ self.output(body, "Velocity") + torque @ self.output(body, "AngularVelocity")
        return power

    def bush_damping(self):
        """Power that the material of the bush turns into heat, W."""
        bush = self.joint.bush
        if bush is None or bush.solid.viscosity_time == 0.0:
            return 0.0
        u, v = bush.displacements(), bush.velocities()
        return float(np.sum((bush.solid.force(u, v) - bush.solid.force(u)) * v))

    def energy_error(self):
        """Error of the energy balance over the run, as a share of the energy that the film dissipates; integrals by the
        trapezoidal rule."""
        t, rows, history = np.array(self.times), np.array(self.rows), self.joint.history
        assert np.allclose(history.time, t, rtol=0, atol=1e-12)
        kinetic, elastic, power, damping = rows[:, :4].T
        taken = np.trapezoid(history.power_loss, t)
        change = kinetic[-1] - kinetic[0] + elastic[-1] - elastic[0]
        if self.joint.element.model.remembers_deflection:
            change += self.liner_energy()
            self.joint.element.model.initial_history(history.motion[0])
            change -= self.liner_energy()
        return abs(np.trapezoid(power - damping, t) - taken - change) / taken

    def momentum_errors(self):
        """Error of linear and angular momentum over the run, over the impulses of the loads."""
        t, rows = np.array(self.times), np.array(self.rows)
        change, impulse = rows[-1, 4:10] - rows[0, 4:10], np.trapezoid(rows[:, 10:16], t, axis=0)
        error = change - impulse
        return [np.abs(error[k]).max() / np.abs(impulse[k]).max() for k in (slice(0, 3), slice(3, 6))]
