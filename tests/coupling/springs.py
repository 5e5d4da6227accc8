"""A linear law in place of a film, which Exudyn's own connector knows too, and bodies joined to ground by it."""

from types import SimpleNamespace

import exudyn.itemInterface as eii
import numpy as np
import scenes
import toy

from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.status import Status

STIFFNESS, DAMPING, TILTING = 1e5, 40.0, 50.0


class Spring:
    """F = -k e - d e_t at the journal's or at the housing's point, M = -k_t tilt; with the interface of a film."""

    remembers = needs_spin = False
    bearing = SimpleNamespace(
        radial_clearance=5e-3, journal_radius=0.02, length=0.03, supply=(), inlet=None, cavitation=SwiftStieber()
    )

    def __init__(self, at_journal, tilting=TILTING):
        self.at_journal, self.tilting = at_journal, tilting

    def evaluate(self, motion, history=None, step=0.0, spin=0.0):
        e, b, e_t, b_t = (motion[i : i + 2] for i in (0, 2, 4, 6))
        wrench, tangent = np.zeros(6), np.zeros((6, 10))
        wrench[:2] = -STIFFNESS * e - DAMPING * e_t
        tangent[[0, 1], [0, 1]], tangent[[0, 1], [4, 5]] = -STIFFNESS, -DAMPING
        kt, dt = self.tilting, 1e-3 * self.tilting
        wrench[3:5] = [kt * b[1] + dt * b_t[1], -kt * b[0] - dt * b_t[0]]
        tangent[[3, 4], [3, 2]], tangent[[3, 4], [7, 6]] = [kt, -kt], [dt, -dt]
        if self.at_journal:
            wrench[5] = e[0] * wrench[1] - e[1] * wrench[0]
            tangent[5] = e[0] * tangent[1] - e[1] * tangent[0]
            tangent[5, :2] += [wrench[1], -wrench[0]]
        return SimpleNamespace(
            wrench=wrench, status=Status.CONVERGED, tangent=lambda: tangent, quantities=lambda: {"minimum_gap": 1.0}
        )


def joined(make, role="journal", axis=(0, 0, 1), tilting=TILTING):
    """System with the body in a joint to ground."""
    mbs = scenes.new_system()
    body = make(mbs)
    ground = mbs.CreateGround()
    item = resolve(mbs, "item", body.item)
    point = item.position if body.point is None else body.point
    if item.is_marker:
        ground = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground, localPosition=list(point)))
    items = [ground, body.item] if role == "journal" else [body.item, ground]
    film = Spring(role == "journal", tilting)
    joint = toy.attach(mbs, items, film, position=[] if item.is_marker else point, axis=axis)
    return mbs, body, joint
