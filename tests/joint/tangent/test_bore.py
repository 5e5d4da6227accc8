"""The exact tangent of a film on a flexible bore against central differences in smooth states."""

from __future__ import annotations

import numpy as np
import pytest
from bore_states import BUSHES, FOOT, OPTIONS, C, make_bearing, random_motion

from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import Status
from tests.sampling import sample


@pytest.mark.parametrize("bush", BUSHES)
def test_a_film_that_is_all_cavity_has_no_tangent_but_shear(bush):
    model = build_model(make_bearing(BUSHES[bush]))
    k = model.bore.size
    motion = np.zeros(10 + 2 * k)
    motion[8] = 1e-3
    # the whole bore recedes
    whole = np.ones(model.grid.shape)
    motion[10 + k :] = 1e-2 * np.linalg.lstsq(model.bore.product(whole), model.bore.load(whole), rcond=1e-9)[0]
    assert model.bore.displacement(motion[10 + k :]).min() > 0.0
    evaluation = model.evaluate(motion)
    assert evaluation.status is Status.CONVERGED
    assert model.solver.work.count == 0
    tangent = evaluation.tangent()
    assert not tangent[6:].any() and not tangent[:2].any() and not tangent[:, 10 + k :].any()
    assert tangent[5, 8] < 0.0
    if bush == "nodal":
        wrench, nodal = evaluation.nodal_tangent().whole()
        assert not wrench[:2, 10:].any() and not wrench[:, 10 + k :].any()
        assert np.isfinite(nodal).all()


CASES = [(bush, option) for option in OPTIONS for bush in BUSHES]
# each option on one of the bushes, the other one with the next
QUICK = [k for k, (_, option) in enumerate(CASES) if k % 4 in (0, 3) and not option.endswith("cells")]


@pytest.mark.parametrize(("bush", "option"), sample(CASES, *QUICK))
def test_tangent_is_the_derivative_of_wrench_and_bore_loads(bush, option):
    check_tangent(BUSHES[bush], option, 1 if bush == "modal" else 7)


@pytest.mark.parametrize("option", sample(["swift", "elrod", "wall"], 1, 2))
def test_tangent_has_the_films_moment_on_a_bush_that_it_turns(option):
    assert build_model(make_bearing(FOOT)).bore.twist is not None
    check_tangent(FOOT, option, 1)


def check_tangent(bush, option, every):
    """Columns of the tangent, one of ``every``, against central differences."""
    model, probe = (build_model(make_bearing(bush, **OPTIONS[option])) for _ in range(2))
    k = model.bore.size
    motion = random_motion(k, 1)
    history = model.initial_history(0.9 * motion)
    step = 0.0 if history is None else 1e-4
    evaluation = model.evaluate(motion, history, step)
    assert evaluation.status is Status.CONVERGED
    tangent, active = evaluation.tangent(), model.solver.work.active
    assert tangent.shape == (6 + k, 10 + 2 * k)
    combined = evaluation.combined_tangent(2.0, -0.03)
    assert np.array_equal(combined[:, :10], tangent[:, :10])
    both = 2.0 * tangent[:, 10 : 10 + k] - 0.03 * tangent[:, 10 + k :]
    assert abs(combined[:, 10:] - both).max() < 1e-12 * abs(both).max()
    unit = np.concatenate(([C, C, C / 0.03, C / 0.03, 0.01, 0.01, 0.3, 0.3, 300, 9.0], np.full(k, C), np.full(k, 0.01)))
    rows = abs(tangent * unit).max(axis=1)
    rows[rows < 1e-12 * rows.max()] = np.inf
    for j in range(0, motion.size, every):
        # central differences: the step leaves the active set alone
        # fills at a line inside its cells bend more: truncation 1.5e-6 at 1e-5, 1.5e-8 at 1e-6
        for size in (1e-5, 1e-6, 1e-7)[option == "elrod in cells" :]:
            loads, same = [], True
            for sign in (1.0, -1.0):
                moved = motion.copy()
                moved[j] += sign * size * unit[j]
                e = probe.evaluate(moved, history, step)
                loads.append(np.concatenate((e.wrench, e.bore.load)))
                same &= np.array_equal(probe.solver.work.active, active)
            if same:
                break
        else:
            raise AssertionError("not a smooth state: choose another one")
        numeric = (loads[0] - loads[1]) / (2.0 * size)
        # 1e-6: truncation 1e-10 and rounding 1e-16 / 1e-7 with a decade to spare, per largest entry of the row
        limits = np.full(rows.size, 1e-6)
        if option == "shear thinning":
            # slopes of the shear (axial force, friction) are those in front of the profile's last Newton step, whatever
            # the step of the difference: 1.2e-6 of 1e-5 of the stress, `shear_profile.LAST_STEP`; its values behind it
            limits[[2, 5]] = 3e-6
        assert np.all(abs((tangent[:, j] * unit[j] - numeric) / rows) < limits), (j, size)
