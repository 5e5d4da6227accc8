"""The exact tangent against central differences in smooth states."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import but_slow

CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "gumbel": ehd.Gumbel(),
    "swift": ehd.SwiftStieber(),
    "gumbel, partly sheared": ehd.Gumbel(cavity_shear=0.2),
    "swift, partly sheared": ehd.SwiftStieber(cavity_shear=0.3),
    "gumbel, cavity below ambient": ehd.Gumbel(cavity_pressure=-5e4),
    "swift, cavity below ambient": ehd.SwiftStieber(cavity_pressure=-5e4),
    "swift, line in its cells": ehd.SwiftStieber(cavity_pressure=-5e4, line_in_cells=True),
}
STATES = {
    "steady": {"eccentricity": (0.5, 0.2)},
    "tilted": {"eccentricity": (0.4, -0.3), "tilt": (0.3, 0.2)},
    "squeezing": {"eccentricity": (-0.5, 0.3), "velocity": (0.4, -0.3)},
    "everything": {
        "eccentricity": (0.35, 0.3),
        "tilt": (-0.2, 0.25),
        "velocity": (-0.2, 0.15),
        "tilt_rate": (0.1, 0.2),
        "axial": 0.7,
        "speed": 1.0,
    },
    "reversed": {"eccentricity": (0.6, 0.1), "velocity": (0.1, 0.2), "tilt": (0.1, 0.1), "speed": -1.3, "axial": -0.3},
    "no spin": {"eccentricity": (0.3, 0.1), "velocity": (0.5, 0.4), "tilt_rate": (0.1, -0.3), "speed": 0.0},
    "high": {"eccentricity": (0.93, 0.05), "velocity": (0.02, 0.1)},
}
FILM = ehd.FiniteLength(n_theta=48, n_z=8)


def _check(bearing, motion, scale):
    """Tangent (6, 10) against central differences.

    Rows by their largest entry, columns by the natural unit of the motion.

    A state is smooth if no vertex changes sides within the step. Steps: 1e-5 of the natural unit times the gap that is
    left. Their truncation is 1e-10 of a value that varies over that gap and rounding about 1e-16 / 1e-5, so that 1e-6
    is safe; where a vertex changes sides, a smaller step is taken. The first step is ten times larger, but where shares
    of cells count: they bend more, 1e-6 at that step and 1e-8 at the next.
    """
    model, probe = build_model(bearing), build_model(bearing)
    evaluation = model.evaluate(motion)
    assert evaluation.status is ehd.Status.CONVERGED
    tangent = evaluation.tangent() * scale
    active = model.solver.work.active
    left = max(evaluation.quantities()["minimum_gap"] / bearing.radial_clearance, 0.05)
    rows = abs(tangent).max(axis=1)
    rows[rows < 1e-12 * rows[:2].max()] = np.inf  # no axial force without axial speed, tilt or end pressure
    for k in range(10):
        for step in (1e-4, 1e-5, 1e-6)[model.solver.system.continued is not None :]:
            wrenches, same = [], True
            for sign in (1.0, -1.0):
                moved = motion.copy()
                moved[k] += sign * step * left * scale[k]
                wrenches.append(probe.evaluate(moved).wrench)
                same &= np.array_equal(probe.solver.work.active, active)
            if same:
                break
        else:
            raise AssertionError("not a smooth state: choose another one")
        numeric = (wrenches[0] - wrenches[1]) / (2.0 * step * left)
        assert abs((tangent[:, k] - numeric) / rows).max() < 1e-6, (k, tangent[:, k], numeric)


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("closure", but_slow(CLOSURES, "swift, line in its cells"))
def test_closures(make_bearing, make_motion, motion_scale, closure, state):
    bearing = make_bearing(0.8, cavitation=CLOSURES[closure], film=FILM)
    _check(bearing, make_motion(bearing, **STATES[state]), motion_scale(bearing))


OPTIONS = {
    "end pressures": {"end_pressures": (2e5, 5e4)},
    "end pressures, cavity below": {"end_pressures": (2e5, 5e4), "cavitation": ehd.SwiftStieber(cavity_pressure=-3e4)},
    "no squeeze": {"squeeze": False},
    "short": {"film": ehd.ShortBearing(n_theta=48, n_z=8)},
    "short, Gumbel": {"film": ehd.ShortBearing(n_theta=48, n_z=8), "cavitation": ehd.Gumbel()},
    "wall": {"contact": ehd.RegularisedWall(onset=10e-6, pressure=2e7)},
    "wall, Gumbel": {"contact": ehd.RegularisedWall(onset=10e-6, pressure=2e7), "cavitation": ehd.Gumbel()},
    "wall, line in its cells": {
        "contact": ehd.RegularisedWall(onset=10e-6, pressure=2e7),
        "cavitation": ehd.SwiftStieber(line_in_cells=True),
    },
    "wall, end pressures": {
        "contact": ehd.RegularisedWall(onset=10e-6, pressure=2e7),
        "end_pressures": (2e5, 5e4),
        "cavitation": ehd.FullSommerfeld(),
    },
}


@pytest.mark.parametrize("state", [s for s in STATES if s != "no spin"])
@pytest.mark.parametrize("option", but_slow(OPTIONS, "wall, line in its cells"))
def test_options(make_bearing, make_motion, motion_scale, option, state):
    bearing = make_bearing(0.8, **{"film": FILM, **OPTIONS[option]})
    _check(bearing, make_motion(bearing, **STATES[state]), motion_scale(bearing))


@pytest.mark.parametrize("reach", (0.97, 1.05, 1.3))
def test_pressed_into_the_wall(make_bearing, make_motion, motion_scale, reach):
    # Beyond the bore: the true gap is negative, the film sees a residual gap.
    bearing = make_bearing(0.8, film=FILM, contact=ehd.RegularisedWall(onset=5e-6, pressure=1e8))
    motion = make_motion(bearing, (reach, 0.1), (0.05, -0.1), (0.1, 0.2), speed=1.0)
    _check(bearing, motion, motion_scale(bearing))


def test_squeeze_off_has_no_damping(make_bearing, make_motion):
    bearing = make_bearing(1.0, squeeze=False, film=FILM)
    tangent = build_model(bearing).evaluate(make_motion(bearing, (0.4, 0.1), (0.1, 0.1), (0.3, 0.2))).tangent()
    assert not tangent[:, 4:8].any()


@pytest.mark.parametrize("closure", ("full", "swift"))
def test_damping_is_symmetric_and_positive(make_bearing, make_motion, closure):
    """The rates enter through the same weights that collect the load; the damping matrix is symmetric
    (not for Gümbel's film, which collects the load over a part of it only).

    For the generalised force (Fx, Fy, My, -Mx) of the rates (x', y', bx', by'); the load's quadrature in z differs
    from the control volumes' area, which leaves a few per mille.
    """
    bearing = make_bearing(1.0, cavitation=CLOSURES[closure], film=ehd.FiniteLength(n_theta=48, n_z=24))
    motion = make_motion(bearing, (0.5, 0.2), (0.1, 0.2))
    T = build_model(bearing).evaluate(motion).tangent()
    C = -np.array([T[0, 4:8], T[1, 4:8], T[4, 4:8], -T[3, 4:8]])
    unit = np.sqrt(np.diag(C))
    C = C / np.outer(unit, unit)
    assert abs(C - C.T).max() < 5e-3
    assert np.linalg.eigvalsh(C + C.T).min() > 0.0


def test_tangent_of_an_outdated_evaluation_is_refused(make_bearing, make_motion):
    bearing = make_bearing(1.0, film=FILM)
    model = build_model(bearing)
    first = model.evaluate(make_motion(bearing, (0.4, 0.1)))
    model.evaluate(make_motion(bearing, (0.3, 0.1)))
    with pytest.raises(RuntimeError, match="evaluated another state"):
        first.tangent()
    with pytest.raises(RuntimeError, match="evaluated another state"):
        first.quantities()
