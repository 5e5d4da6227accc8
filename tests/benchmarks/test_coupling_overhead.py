"""Cost of the film element outside the film, measured with a model that returns a constant."""

import sys
import time
from pathlib import Path
from types import SimpleNamespace

import exudyn as exu
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "coupling"))
import scenes

from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import Status
from tests.benchmarks.accuracy.costs import effects
from tests.benchmarks.accuracy.costs.growth import plain_bearing


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
def test_share_of_a_film(pair):
    """The element's share of the time of a plain film with its tangent: force 13 to 16 %, Jacobian 13 to 23 %.

    The force goes through Exudyn, with its conversion of coordinates to lists and of the force back.
    """
    mbs, joint, q, q_t = scenes.pair(*pair, film=ConstantFilm())
    values, rates = q.tolist(), q_t.tolist()
    mbs.systemData.SetODE2Coordinates(values)
    mbs.systemData.SetODE2Coordinates_t(rates)
    element = joint.element
    model, states = build_model(plain_bearing()), effects.orbit(count=12)

    def force():
        element.forget()
        mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS)

    def jacobian():
        element.jacobian(mbs, 0.0, 0, values, rates, 1.0, 0.5)

    best = {}
    for _ in range(30):
        found = {"film": effects.block({"": model}, states, 1)[""][0]}
        for function in (force, jacobian):
            function()
            start = time.process_time()
            for _ in range(50):
                function()
            found[function.__name__] = (time.process_time() - start) / 50.0
        best = {name: min(seconds, best.get(name, seconds)) for name, seconds in found.items()}
    shares = {name: seconds / best["film"] for name, seconds in best.items()}
    print(pair, shares)
    assert shares["force"] < 0.19
    assert shares["jacobian"] < 0.26
