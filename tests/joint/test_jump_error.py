"""Errors of steps within which a load jumps: closed forms of linear films, and a squeeze film that lifts."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from exudyn_ehd.joint.time_step import errors_of_jumps

STEP = 1e-4


@pytest.mark.parametrize("mass", [0.0, 0.5, 5.0, 50.0])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.8])
def test_linear_film(mass, share):
    """Numerical step less exact motion, from matrix exponentials before the jump and behind it.

    Of 8 second-order steps each, the error is 1 % of the change of the pose at most.
    """
    rng = np.random.default_rng(int(10.0 * share))
    K = np.array([[2e7, 1.5e7], [-0.5e7, 1e7]])
    D = np.array([[3e4, 0.5e4], [0.5e4, 2e4]])
    loads = np.array([[0.0, 500.0], [400.0, -200.0]])
    pose, rate = np.zeros((2, 2)), np.zeros((2, 2))
    pose[0], pose[1] = 1e-6 * rng.normal(size=2), 1e-6 * rng.normal(size=2)
    rate[1] = 1e-2 * rng.normal(size=2)
    if mass > 0.0:
        rate[0] = 1e-2 * rng.normal(size=2)
        A = np.block([[np.zeros((2, 2)), np.eye(2)], [-K / mass, -D / mass]])
        state = np.concatenate([pose[0], rate[0]])
    else:
        rate[0] = np.linalg.solve(D, loads[0] - K @ pose[0])
        A, state = -np.linalg.solve(D, K), pose[0]
    for load, part in zip(loads, (share, 1.0 - share), strict=True):
        balance = np.zeros_like(state)
        balance[:2] = np.linalg.solve(K, load)
        state = balance + expm(A * part * STEP) @ (state - balance)
    if mass == 0.0:
        state = np.concatenate([state, np.linalg.solve(D, loads[1] - K @ state)])
    force = -pose @ K.T - rate @ D.T
    beyond = (0.5 - share) * (loads[1] - loads[0])
    found = errors_of_jumps(
        np.array([STEP]),
        *(np.broadcast_to(x, (2, 1, 2, 2)) for x in (K, D)),
        mass * np.eye(2)[None],
        force[:, None],
        loads[:, None],
        beyond[None],
        np.zeros(1),
        pose[:, None],
        rate[:, None],
    )[0]
    exact = np.concatenate([pose[1], rate[1]]) - state
    change = np.abs(state[:2] - pose[0]).max()
    np.testing.assert_allclose(found[:2], exact[:2], atol=0.01 * change)
    np.testing.assert_allclose(found[2:], exact[2:], atol=0.02 * change / STEP + 0.02 * np.abs(state[2:]).max())


def test_a_squeeze_film_that_lifts():
    """F = -c v / g^3 of a gap g that opens to 1.04 to 1.9 times its size: a step that takes the jump in its middle.

    The error is told at 0.87 to 1.14 of its size; with the impulse over the mean damping of both ends at 0.35 to 0.88.
    """
    c, gap, mass = 1e-9, 1e-5, 0.01

    def motion(share, load):
        """Gap and rate at the end; no load acts before the jump."""
        run = solve_ivp(
            lambda t, y: [y[1], (load - c * y[1] / y[0] ** 3) / mass],
            (share * STEP, STEP),
            (gap, 0.0),
            method="Radau",
            rtol=1e-9,
            atol=1e-14,
        )
        return run.y[:, -1]

    load = c / gap**2 * (1.0 - 1.0 / 1.3**2) / STEP
    end, rate = motion(0.5, load)
    for share in (0.1, 0.3, 0.7, 0.9):
        true, _ = motion(share, load)
        found = errors_of_jumps(
            np.array([STEP]),
            -3.0 * c * np.array([0.0, rate / end**4]).reshape(2, 1, 1, 1),
            c * np.array([gap**-3, end**-3]).reshape(2, 1, 1, 1),
            np.full((1, 1, 1), mass),
            np.array([0.0, -c * rate / end**3]).reshape(2, 1, 1),
            np.array([0.0, load]).reshape(2, 1, 1),
            np.array([[(0.5 - share) * load]]),
            np.zeros(1),
            np.array([gap, end]).reshape(2, 1, 1),
            np.array([0.0, rate]).reshape(2, 1, 1),
        )[0]
        assert found[0] == pytest.approx(end - true, rel=0.2), share


def test_nothing_resists():
    """No error without mass, stiffness and damping."""
    none = np.zeros((2, 1, 2, 2))
    some, step = np.ones((2, 1, 2)), np.array([STEP])
    assert not errors_of_jumps(step, none, none, none[0], some, some, some[0], np.zeros(1), some, some).any()
