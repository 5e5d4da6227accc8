"""A toy film with the interface of the real ones: smooth, closed form, with an analytic tangent, and costs nothing.

Not a bearing's physics, but everything the coupling must get right shows: a force that grows towards the wall, a wedge
force (spin times eccentricity, across), damping, tilting moments, friction and an axial drag.
"""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import api
from exudyn_ehd.coupling.items import joint_frame
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.status import Status

exu.config.printToConsole = False


class ToyEvaluation:
    def __init__(self, model, motion):
        self.model, self.motion, self.count = model, motion, model.count
        self.status = Status.CONVERGED
        b = model.bearing
        x, y, bx, by = motion[:4]
        half = 0.5 * b.length
        ends = max(np.hypot(x + s * half * bx, y + s * half * by) for s in (-1, 1))
        self.gap = b.radial_clearance - ends
        if not self.gap > 0:
            self.status = Status.NO_FILM
        self.wrench, self._tangent = model.law(motion) if self.gap > 0 else (np.full(6, np.nan), None)

    def tangent(self):
        assert self.count == self.model.count, "stale evaluation"
        return self._tangent

    def quantities(self):
        return {"minimum_gap": self.gap, "peak_pressure": 1.0, "friction_torque": self.wrench[5]}


@dataclasses.dataclass
class ToyFilm:
    """F = -(k + s) * e - d(e) * e_t + w * spin * z x e, with stiffness growing as 1 / (1 - eps^2)."""

    stiffness: float = 2e6
    damping: float = 2e3
    wedge: float = 5e3
    tilting: float = 50.0
    friction: float = 1e-4
    axial_drag: float = 3.0
    axial: bool = True
    bearing: SimpleNamespace = dataclasses.field(
        default_factory=lambda: SimpleNamespace(
            radial_clearance=1e-3, journal_radius=0.02, length=0.03, supply=(), inlet=None, cavitation=SwiftStieber()
        )
    )
    count: int = 0
    linear: bool = False
    remembers: bool = False
    needs_spin = False

    def evaluate(self, motion, history=None, step=0.0, spin=0.0):
        self.count += 1
        return ToyEvaluation(self, motion.copy())

    def law(self, m):
        c = self.bearing.radial_clearance
        e, b, e_t, b_t, omega, w = m[0:2], m[2:4], m[4:6], m[6:8], m[8], m[9]
        s = 0.0 if self.linear else 1.0
        g = 1.0 / (1.0 - s * (e @ e) / c**2)
        dg = s * g * g * 2.0 / c**2 * e
        cross = np.array([[0.0, -1.0], [1.0, 0.0]])
        base = -self.stiffness * e - self.damping * e_t + self.wedge * omega * (cross @ e)
        f = g * base
        t = np.zeros((6, 10))
        t[:2, 0:2] = g * (-self.stiffness * np.eye(2) + self.wedge * omega * cross) + np.outer(base, dg)
        t[:2, 4:6] = -g * self.damping * np.eye(2)
        t[:2, 8] = g * self.wedge * (cross @ e)
        f_z = -self.axial_drag * w
        t[2, 9] = -self.axial_drag
        mb = -self.tilting * b - 0.01 * self.tilting * b_t
        # a tilt b = (bx, by) is a rotation (-by, bx)
        moment = np.array([-mb[1], mb[0]]) + g * np.array([e[1], -e[0]]) * 30.0
        rot = np.array([[0.0, -1.0], [1.0, 0.0]])
        t[3:5, 2:4] = -self.tilting * rot
        t[3:5, 6:8] = -0.01 * self.tilting * rot
        t[3:5, 0:2] += 30.0 * (g * np.array([[0.0, 1.0], [-1.0, 0.0]]) + np.outer(np.array([e[1], -e[0]]), dg))
        m_z = -g * self.friction * omega
        t[5, 0:2] = -self.friction * omega * dg
        t[5, 8] = -g * self.friction
        if not self.axial:
            f_z = 0.0
            t[2] = 0.0
        return np.array([f[0], f[1], f_z, moment[0], moment[1], m_z]), t


def attach(mbs, items, model, position=(), axis=(0, 0, 1), rotation=None, use_global=True, **options):
    """CreateLubricatedJoint with a film model in place of a bearing."""
    place = joint_frame.place_joint("CreateLubricatedJoint", mbs, items, position, axis, rotation, use_global)
    return api.attach(mbs, model, *place, **options)
