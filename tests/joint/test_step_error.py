"""Errors of time steps: the estimate against the true error of films whose motion is known."""

import numpy as np
import pytest
from scipy.linalg import expm

from exudyn_ehd.joint.step_error import (
    FIRST,
    JOURNAL,
    LOAD_COLUMNS,
    FilmLoad,
    errors_behind,
    next_error,
    no_error,
    recorded_entries,
)

CLEARANCE, LENGTH, GAP = 20e-6, 0.02, 8e-6
# stiffness and damping of translations and tilts, the latter with moments Mx, My; of a film that whirls while it decays
D = (np.array([[5.0, 0.4], [0.4, 3.0]]) * 1e4, np.array([[0.3, -4.0], [5.0, 0.2]]))
K = (np.array([[3.0, 2.0], [-2.5, 1.0]]) * 1e7, D[1] @ np.array([[300.0, 200.0], [-150.0, 400.0]]))
SPEED = 400.0


def tangent():
    out = np.zeros((6, 10))
    for k, (rows, place) in enumerate((((0, 1), 0), ((3, 4), 2))):
        out[np.ix_(rows, (place, place + 1))], out[np.ix_(rows, (place + 4, place + 5))] = -K[k], -D[k]
    return out


def truth(time):
    """Pose and rate (n, 4): an orbit with a higher harmonic, and a tilt."""
    phase = SPEED * np.asarray(time)[..., None] * np.array([1.0, 1.0, 2.0, 1.0]) + np.array([0.0, 1.5, 0.3, 2.0])
    size = np.array([6e-6, 4e-6, 2e-4, 3e-4])
    rate = SPEED * np.array([1.0, 1.0, 2.0, 1.0]) * size
    return size * np.sin(phase), rate * np.cos(phase)


def trapezoid(time, start):
    """A journal without mass whose rates are those of `truth` with the forces of its own place, by the trapezoid."""
    A = np.zeros((4, 4))
    for k, s in enumerate((slice(0, 2), slice(2, 4))):
        A[s, s] = np.linalg.solve(D[k], K[k])
    motion = np.zeros((time.size, 10))

    def rate(pose, t):
        place, rate = truth(t)
        return rate - A @ (pose - place)

    motion[0, :4] = start
    motion[0, 4:8] = rate(start, time[0])
    for k in range(1, time.size):
        h, before = time[k] - time[k - 1], motion[k - 1]
        place, v = truth(time[k])
        # p1 = p0 + h (r0 + r1) / 2 with r1 linear in p1
        known = before[:4] + 0.5 * h * (before[4:8] + v + A @ place)
        motion[k, :4] = np.linalg.solve(np.eye(4) + 0.5 * h * A, known)
        motion[k, 4:8] = rate(motion[k, :4], time[k])
    return motion


def ends(pose):
    return np.max([np.hypot(*(pose[:, :2] + s * 0.5 * LENGTH * pose[:, 2:4]).T) for s in (-1.0, 1.0)], axis=0)


def recorded():
    """Entries (16,) of the tangent."""
    return tangent()[recorded_entries(JOURNAL)]


def estimate(time, motion, tangents=None, deflection=None, load=None):
    tangents = np.tile(recorded(), (time.size, 1)) if tangents is None else tangents
    load = FilmLoad.of(np.full((time.size, sum(LOAD_COLUMNS)), np.nan)) if load is None else load
    gaps, start = np.full(time.size, GAP), no_error(JOURNAL)
    return errors_behind(JOURNAL, start, time, motion, tangents, gaps, CLEARANCE, LENGTH, deflection, load)[0]


@pytest.mark.parametrize("uneven", [0.0, 0.4])
@pytest.mark.parametrize("steps", [24, 48, 96])
def test_estimate_is_the_true_error(steps, uneven):
    """Largest of two turns after the first steps, by steps that are equal, and that differ up to 2.3 times."""
    rng = np.random.default_rng(steps)
    sizes = 1.0 + uneven * rng.uniform(-1.0, 1.0, 2 * steps)
    time = np.concatenate(([0.0], np.cumsum(sizes))) / sizes.sum() * 4.0 * np.pi / SPEED
    motion = trapezoid(time, truth(0.0)[0])
    true = ends(motion[:, :4] - truth(time)[0]) / GAP
    found = estimate(time, motion)
    assert np.all(np.isnan(found[:FIRST])) and np.all(np.isfinite(found[FIRST:]))
    assert np.nanmax(found) == pytest.approx(true.max(), rel=0.25)


def test_what_is_not_known():
    time = np.linspace(0.0, 0.02, 41)
    motion = trapezoid(time, truth(0.0)[0])
    none = np.full((41, 16), np.nan)
    assert np.all(np.isnan(estimate(time, motion, none)))
    assert np.all(np.isnan(estimate(time[:FIRST], motion[:FIRST], none[:FIRST])))
    # the last tangent counts for the states without one
    some = none.copy()
    some[5] = recorded()
    found = estimate(time, motion, some)
    assert np.all(np.isnan(found[:5])) and np.all(np.isfinite(found[5:]))
    # a film that resists nothing has no error to remember
    assert np.all(estimate(time, motion, np.zeros((41, 16)))[FIRST:] == 0.0)


def test_parts_of_a_record_have_the_errors_of_the_whole():
    """Bit for bit, also where the first tangents are missing."""
    time, rng = np.linspace(0.0, 0.02, 41), np.random.default_rng(3)
    motion, tangents = trapezoid(time, truth(0.0)[0]), rng.normal(size=(41, 16))
    load = FilmLoad.of(rng.normal(size=(41, sum(LOAD_COLUMNS))))
    for missing in range(6):
        tangents[:missing] = np.nan
        parts, before = [], no_error(JOURNAL)
        for start, end in ((0, 20), (20 - FIRST, 41)):
            own = slice(start, end)
            loads = FilmLoad(*(column[own] for column in load))
            states = time[own], motion[own], tangents[own], np.full(end - start, GAP)
            found, before = errors_behind(JOURNAL, before, *states, CLEARANCE, LENGTH, None, loads)
            parts.append(found[FIRST if start else 0 :])
        np.testing.assert_array_equal(np.concatenate(parts), estimate(time, motion, tangents, load=load))


@pytest.mark.parametrize("steps", [50, 100, 200])
def test_lag_of_a_liner(steps):
    """Lag of a stiff film on a liner: h/2 times the acceleration of its deflection, less what it forgets in a step."""
    time = np.linspace(0.0, 2.0 * np.pi / SPEED, steps + 1)
    h, motion = time[1], np.zeros((steps + 1, 10))
    angle = SPEED * time
    w = 1e-6 * np.stack((np.cos(angle), np.zeros_like(angle)), axis=1) + 5e-6 * np.array([1.0, 0.0])
    resting = np.tile([[0.0] * 4, [-1.0, 0.0, 0.0, -1.0]], (steps + 1, 2, 1)).reshape(steps + 1, 16)
    # nothing forgotten: the sum of all lags, h/2 times the change of the deflection's rate
    found = estimate(time, motion, resting, deflection=w)
    rate = -1e-6 * SPEED * np.sin(angle)
    expected = 0.5 * h * np.abs(rate - rate[FIRST - 1]) / GAP
    np.testing.assert_allclose(found[FIRST:], expected[FIRST:], atol=3.0 * h * SPEED * expected.max())
    # a peak that jumps to the other side is no motion
    jumped = w.copy()
    jumped[steps // 2 :] *= -1.0
    assert np.nanmax(estimate(time, motion, resting, deflection=jumped)) < 1.5 * expected.max()


@pytest.mark.parametrize(
    ("loads", "jump"),
    [
        ([0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 1.0),
        ([0.0, 0.0, 0.0, 0.0, 1.0, 1.0], 0.0),
        ([0.0, 0.0, 0.0, 0.0, 1.0, 0.0], 1.0),
        ([0.0, 0.0, 0.0, 1.0, 1.0, 0.0], 1.0),
        ([0.0, 0.0, 0.2, 1.2, 2.2, 3.2], 0.0),
        ([0.0, 1.0, 4.0, 9.0, 16.0, 25.0], 0.0),
        ([0.0, 1.0, -1.0, 1.0, -1.0, 1.0], 0.0),
    ],
)
def test_jumps_of_a_load(loads, jump):
    """Error h |D^-1 dL| / 2 of jumps and of the ends of pulses; none behind a jump, on ramps, smooth or ringing loads.

    The loads lie upon a line. Tolerances are those of round-off.
    """
    time, side = 1e-4 * np.arange(6.0), np.array([100.0, 200.0])
    load = FilmLoad.of(np.zeros((6, sum(LOAD_COLUMNS))))
    load.offset[:] = np.nan
    load.force[:, :2] = np.outer(time, [3e4, -2e4]) + np.outer(loads, side)
    film = recorded()
    expected = 0.5e-4 * jump * np.linalg.norm(np.linalg.solve(D[0], side))
    _, _, moved = next_error(JOURNAL, time, np.zeros((6, 10)), (film, film), load, no_error(JOURNAL), LENGTH, 1e-6)
    assert moved[1] == pytest.approx(expected, rel=1e-9, abs=1e-15)


@pytest.mark.parametrize("mass", [0.0, 5.0, 50.0, 1000.0])
def test_a_missed_impulse_moves_a_mass_in_its_film(mass):
    """Response of M d2e/dt2 + D de/dt + K e = 0 to an impulse in the middle of a step, from the matrix exponential.

    The whirl of 1000 kg grows. Errors are those of second-order steps, 0.8 % of the largest response with 5 kg.
    """
    h, n, impulse = 1e-4, 200, np.array([30.0, -20.0])
    time, load = h * np.arange(n + 1.0), FilmLoad.of(np.zeros((n + 1, sum(LOAD_COLUMNS))))
    load.offset[:], load.mass[:, [0, 2]] = np.nan, mass
    load.momentum[FIRST, :2] = impulse
    found = estimate(time, np.zeros((n + 1, 10)), load=load)
    if mass > 0.0:
        inverse = np.eye(2) / mass
        A, start = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ K[0], -inverse @ D[0]]]), np.zeros(4)
        start[2:] = inverse @ impulse
    else:
        A, start = -np.linalg.solve(D[0], K[0]), np.linalg.solve(D[0], impulse)
    exact = [np.linalg.norm((expm(A * (t - (FIRST - 0.5) * h)) @ start)[:2]) / GAP for t in time[FIRST:]]
    np.testing.assert_allclose(found[FIRST:], exact, atol=0.01 * max(exact))
