"""Equations of a floating body: against the sum over its particles, and their derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from exudyn.rigidBodyUtilities import Skew
from scenes import rotation

from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.flexible_bodies import BodyIntegrals, FloatingBody
from exudyn_ehd.coupling.kinematics.sides import NodeSide

KINDS = {
    "EP": rigid_nodes.EULER_PARAMETERS,
    "Rxyz": rigid_nodes.TAIT_BRYAN,
    "RotVec": rigid_nodes.ROTATION_VECTOR,
}
PARTICLES, MODES = 7, 4


class Particles:
    """Mass points in a floating frame: what `FloatingBody` does, particle by particle."""

    def __init__(self, kind, rng):
        self.masses = rng.uniform(0.1, 1.0, PARTICLES)
        self.places, self.shapes = rng.normal(size=(PARTICLES, 3)), rng.normal(size=(PARTICLES, 3, MODES))
        self.stiffness, self.damping = rng.normal(size=(2, MODES, MODES))
        # unit Euler parameters
        reference = {"EP": [0.1, 0.2, 0.3, 0.8, 0.36, -0.48, 0.0]}.get(kind, [0.1, 0.2, 0.3, 0.4, -0.5, 0.2])
        self.side = NodeSide(KINDS[kind], None, np.array(reference), np.zeros(3), np.eye(3))
        self.n = self.side.size

    def integrals(self):
        k = MODES
        x = np.array([Skew(v) for v in self.places])
        # [particle, mode, 3, 3]
        psi = np.array([[Skew(shape[:, i]) for i in range(k)] for shape in self.shapes])
        m, shapes = self.masses, self.shapes
        return BodyIntegrals(
            mass=m.sum(),
            moment=m @ self.places,
            inertia=np.einsum("p,pab,pac->bc", m, x, x),
            S=np.einsum("p,pai->ai", m, shapes),
            T=np.einsum("p,pab,pai->bi", m, x, shapes),
            X=np.einsum("p,pab,piac->ibc", m, x, psi),
            P=np.einsum("p,piab,pjac->ijbc", m, psi, psi),
            C=np.einsum("p,piab,paj->ijb", m, psi, shapes),
            modal_mass=np.einsum("p,pai,paj->ij", m, shapes, shapes),
            stiffness=self.stiffness,
            damping=self.damping,
        )

    def state(self, rng):
        """Coordinates and rates, large; Euler parameters of the unit sphere and along it."""
        q, q_t = rng.normal(size=(2, self.n + MODES))
        if self.side.kind == rigid_nodes.EULER_PARAMETERS:
            e = q[3:7] + self.side.reference[3:]
            e /= np.linalg.norm(e)
            q[3:7], q_t[3:7] = e - self.side.reference[3:], q_t[3:7] - e * (e @ q_t[3:7])
        return q, q_t

    def jacobians(self, q, q_t):
        """Jacobians of all particles (p, 3, n + k); their arms A (x + u) and rates A u_t."""
        self.side.update(None, q[: self.n], q_t[: self.n], None)
        A, Jr = self.side.frame[:, :3], self.side.jac[1]
        arms = (self.places + self.shapes @ q[self.n :]) @ A.T
        J = np.zeros((PARTICLES, 3, q.size))
        J[:, :, :3] = np.eye(3)
        J[:, :, : self.n] += np.array([-Skew(arm) @ Jr for arm in arms])
        J[:, :, self.n :] = A @ self.shapes
        return J, arms, self.shapes @ q_t[self.n :] @ A.T

    def mass(self, q):
        J, _, _ = self.jacobians(q, q)
        return np.einsum("p,pai,paj->ij", self.masses, J, J)

    def left_hand_side(self, q, q_t):
        """Sum of J^T m a with the accelerations a at q_tt = 0, and the modes' own forces."""
        J, arms, flows = self.jacobians(q, q_t)
        w, alpha = self.side.frame[:, 5].copy(), np.zeros(3)
        if self.side.kind == rigid_nodes.TAIT_BRYAN:
            # quadratic in the rates, and the change of w along them
            alpha = self.side.change(None, q[: self.n])[3:] @ q_t[: self.n] @ q_t[: self.n]
        a = np.array([np.cross(alpha, u) + np.cross(w, np.cross(w, u) + 2 * v) for u, v in zip(arms, flows)])
        out = np.einsum("p,pai,pa->i", self.masses, J, a)
        out[self.n :] += self.stiffness @ q[self.n :] + self.damping @ q_t[self.n :]
        return out


def moved(body, q, direction, step):
    """Coordinates a step along one of them; rotation vectors turn the frame by a local angle."""
    out = q + step * direction
    if body.side.kind == rigid_nodes.ROTATION_VECTOR:
        turned = rotation(q[3:6] + body.side.reference[3:]) @ rotation(step * direction[3:6])
        cosine = 0.5 * (np.trace(turned) - 1.0)
        axis = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
        angle = np.arctan2(0.5 * np.linalg.norm(axis), cosine)
        out[3:6] = angle * axis / np.linalg.norm(axis) - body.side.reference[3:]
    return out


@pytest.mark.parametrize("kind", KINDS)
def test_equations_are_the_sum_over_the_particles(kind):
    rng = np.random.default_rng(1)
    for _ in range(5):
        particles = Particles(kind, rng)
        body = FloatingBody(particles.side, particles.integrals())
        q, q_t = particles.state(rng)
        for own, plain in (
            (body.mass(q), particles.mass(q)),
            (body.left_hand_side(q, q_t), particles.left_hand_side(q, q_t)),
        ):
            # rounding of sums of seven
            assert np.abs(own - plain).max() < 1e-13 * np.abs(plain).max()


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_are_exact(kind):
    """Central differences of second order over 1e-3 and 2e-3, extrapolated: 1e-12 of truncation, 1e-13 of rounding."""
    rng = np.random.default_rng(2)
    for _ in range(5):
        particles = Particles(kind, rng)
        body = FloatingBody(particles.side, particles.integrals())
        q, q_t = particles.state(rng)
        f_q, f_qt = rng.normal(size=2)
        exact = body.derivative(q, q_t, f_q, f_qt)
        numeric = np.zeros_like(exact)
        for i, unit in enumerate(np.eye(q.size)):
            slopes = []
            for step in (1e-3, 2e-3):
                ends = [
                    f_q * body.left_hand_side(moved(particles, q, unit, s), q_t)
                    + f_qt * body.left_hand_side(q, q_t + s * unit)
                    for s in (step, -step)
                ]
                slopes.append((ends[0] - ends[1]) / (2.0 * step))
            numeric[:, i] = (4.0 * slopes[0] - slopes[1]) / 3.0
        if kind == "EP":
            # off the sphere neither rates nor coordinates are those of a motion
            e = np.zeros(q.size)
            e[3:7] = q[3:7] + particles.side.reference[3:]
            along = np.eye(q.size) - np.outer(e, e)
            exact, numeric = exact @ along, numeric @ along
        assert np.abs(exact - numeric).max() < 1e-10 * np.abs(numeric).max()
