"""Joints whose journal's film feeds those on the end faces."""

import dataclasses
import math

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd

C, CJ, MU = 40e-6, 50e-6, 0.03
GROOVE = ehd.CircumferentialGroove(width=8e-3, pressure=2e5)
PADS = ehd.TaperLand(pads=4, depth=3e-5)


def _bearing(feed=True, **options):
    edges = {"feed": ehd.JournalLeakage()} if feed else {}
    faces = ehd.ThrustFaces(
        inner_radius=0.026, outer_radius=0.05, clearance=C, profile=PADS, n_theta=48, n_r=6, **edges
    )
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=CJ,
        lubricant=ehd.Lubricant(viscosity=MU),
        **{"film": ehd.FiniteLength(n_theta=48, n_z=6), "supply": (GROOVE,), "thrust": faces, **options},
    )


@pytest.mark.parametrize(
    ("closure", "offset"),
    (
        (ehd.SwiftStieber(), 0.0),
        pytest.param(ehd.SwiftStieber(), 0.15, marks=pytest.mark.slow),
        pytest.param(ehd.FullSommerfeld(), 0.15, marks=pytest.mark.slow),
    ),
    ids=("swift", "swift_apart", "full_apart"),
)
def test_jacobian(closure, offset):
    """Central differences of the force of both elements between two bodies that move, tilt and slide at random.

    Steps of 1e-8 m against 4e-5 m of gap: as of unfed faces, 2e-6 of the largest entry of its kind.
    """
    mbs = scenes.new_system()
    one = scenes.add_body(mbs, "Rxyz", (0.1, 0, 0), scenes.rotation([0.1, 0.2, 0.3]))
    two = scenes.add_body(mbs, "EP", (0, 0.05, 0), scenes.rotation([0.4, -0.2, 0.3]))
    bearing = _bearing(cavitation=closure)
    joint = ehd.CreateLubricatedJoint(mbs, "pin", [one, two], [0, 0, 0], [0.2, 0.1, 1.0], bearing)
    film, faces = joint.element, joint.element.faces
    if offset:
        # the same joint, with its journal's point elsewhere on the axis
        side = film.sides[1]
        side.rho += offset * side.rotation[:, 2]
        faces.offset = offset
    mbs.Assemble()
    rng, fed = np.random.default_rng(2), 0

    def force(q, q_t):
        return sum(part.force(mbs, 0.0, 0, q.tolist(), q_t.tolist()) for part in (film, faces))

    for _ in range(3):
        q, q_t = np.zeros(13), 1e-2 * rng.normal(size=13)
        q[6:9] = 1.2e-5 * rng.normal(size=3)
        q[9:] = 4e-5 * rng.normal(size=4)
        q_t[9:] += [0.0, 1.0, 2.0, 20.0]
        assert np.all(np.isfinite(force(q, q_t)))
        fed += faces._found.balanced.sum()
        for f_q, f_qt, step in ((1.0, 0.0, 1e-9), (0.0, 1.0, 1e-6)):
            force(q, q_t)
            jacobian = sum(
                part.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), f_q, f_qt) for part in (film, faces)
            )
            columns = []
            for k in range(13):
                d = step * np.eye(13)[k]
                plus, minus = (force(q + f_q * s * d, q_t + f_qt * s * d) for s in (1, -1))
                columns.append(-(plus - minus) / (2 * step))
            kinds = np.r_[np.zeros(3), np.ones(3), np.zeros(3), np.ones(4)].astype(int)
            expected = np.array(columns).T
            for a in (0, 1):
                for b in (0, 1):
                    block = np.ix_(kinds == a, kinds == b)
                    worst = np.abs(jacobian[block] - expected[block]).max() / np.abs(expected[block]).max()
                    print(worst)
                    assert worst < 2e-6
    print(fed)
    assert fed
