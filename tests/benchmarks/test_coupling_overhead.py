"""What the film element costs outside the film: a model that returns a constant."""

import sys
from pathlib import Path
from types import SimpleNamespace

import exudyn as exu
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "coupling"))
import scenes

from exudyn_ehd.status import Status


class ConstantFilm:
    """No film at all: what remains is the coupling."""

    bearing = SimpleNamespace(radial_clearance=1e-3, journal_radius=0.02, length=0.03)
    remembers = needs_spin = False
    status = Status.CONVERGED
    wrench = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])
    slope = np.ones((6, 10))

    def evaluate(self, motion, history=None, step=0.0, spin=0.0):
        return self

    def tangent(self):
        return self.slope

    def quantities(self):
        return {}


PAIRS = [("EP", "EP"), ("Rxyz", "Rxyz"), ("RotVec", "RotVec"), ("ground", "RotVec")]


@pytest.mark.benchmark
@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_force_evaluation(benchmark, pair):
    """Through Exudyn, with its conversion of coordinates to lists and of the force back; goal: 30 us."""
    mbs, joint, q, q_t = scenes.pair(*pair, film=ConstantFilm())
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    element = joint.element

    def evaluate():
        element.forget()
        mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS)

    evaluate()
    benchmark.pedantic(evaluate, rounds=200, iterations=50)


@pytest.mark.benchmark
@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_jacobian_evaluation(benchmark, pair):
    """The same for the Jacobian at a state whose force is known."""
    _, joint, q, q_t = scenes.pair(*pair, film=ConstantFilm())
    values, rates = q.tolist(), q_t.tolist()
    joint.element.force(joint.mbs, 0.0, 0, values, rates)
    benchmark.pedantic(
        lambda: joint.element.jacobian(joint.mbs, 0.0, 0, values, rates, 1.0, 0.5), rounds=100, iterations=50
    )
