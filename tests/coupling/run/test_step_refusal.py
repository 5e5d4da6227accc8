"""Converged steps without a film are halved; the user's function after Newton's method stays."""

from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
import scenes

from exudyn_ehd.coupling.run.newton import refuse


def falling(before, largest, own):
    """Times of a falling point whose steps behind 0.055 s have a result only up to a size; ``before`` is the user's.

    Also the ends of the steps for which the film is blamed.
    """
    mbs, times, blamed = scenes.new_system(), [], []
    mbs.CreateMassPoint(mass=1.0, gravity=[0, -9.81, 0])
    mbs.Assemble()

    def has_result():
        iteration = mbs.sys["dynamicSolver"].it
        return iteration.currentTime < 0.055 or iteration.currentStepSize <= largest

    failures = SimpleNamespace(blame=lambda start, end, reason: blamed.append(end))
    film = SimpleNamespace(has_result=has_result, steps=SimpleNamespace(start=0.0), failures=failures)
    mbs.SetPostNewtonUserFunction(partial(refuse, [film], before) if own else before)
    mbs.SetPostStepUserFunction(lambda mbs, t: not times.append(t))
    mbs.SolveDynamic(scenes.settings(0.1, 10))
    return np.array(times), blamed


def test_a_step_without_a_result_is_halved():
    asked = []
    times, blamed = falling(lambda mbs, t: asked.append(t) or [0.0, -1.0], 0.003, True)
    steps = np.diff(times)
    behind = times[1:] > 0.05 + 1e-9
    assert steps[~behind][:4] == pytest.approx(0.01) and steps[behind].max() <= 0.003
    assert times[-1] == pytest.approx(0.1)
    # every attempt, refused or not
    assert len(asked) > steps.size and set(times[1:]) <= set(asked)
    assert len(blamed) == len(asked) - steps.size > 0


def test_a_smaller_step_of_the_users_function_goes_first():
    def user(mbs, t):
        step = mbs.sys["dynamicSolver"].it.currentStepSize
        return [1e9, 0.1 * step] if t > 0.055 and step > 0.002 else [0.0, -1.0]

    np.testing.assert_array_equal(falling(user, 0.009, True)[0], falling(user, 1.0, False)[0])
