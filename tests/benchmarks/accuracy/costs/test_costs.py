"""Costs: factors of blocks, the disk, small runs of every measure, failures that stay in their row, growth."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import InputError
from tests.benchmarks.accuracy.costs import bushes, effects, growth
from tests.benchmarks.accuracy.table import Cost, costs_of_blocks, format_costs, read_table, write_table


def _silent(text):
    pass


@pytest.mark.slow
def test_factors_are_those_of_a_block():
    """A machine twice as slow in one block changes the times, not the factors."""
    blocks = {"plain": [1.0, 2.0, 1.0], "effect": [1.5, 3.0, 1.5], "alone": [3.0, 3.0, 3.0]}
    plain, effect, alone = costs_of_blocks("run", blocks, {"effect": "plain"}, modes={"alone": 7.0})
    assert (effect.factor, effect.factor_spread) == (1.5, 0.0)
    assert effect.spread > 0.0 and effect.base == "plain"
    assert math.isnan(plain.factor) and plain.base == ""
    assert alone.modes == 7.0 and alone.seconds == 3.0


def test_a_base_that_failed_gives_no_factor():
    (effect,) = costs_of_blocks("run", {"effect": [1.0, 2.0]}, {"effect": "plain"})
    assert effect.base == "" and math.isnan(effect.factor)


def test_round_trip(tmp_path):
    costs = [
        Cost(what='`a`, "b"', per="step", base="c", seconds=1.234e-5, low=1e-5, high=2e-5, factor=1.5),
        Cost(what="d", per="step", failure="no film, today"),
    ]
    path = tmp_path / "costs.csv"
    write_table(path, Cost, costs, ["note", "machine"])
    back, notes = read_table(path, Cost)
    assert notes == ["note", "machine"]
    write_table(tmp_path / "again.csv", Cost, back, notes)
    assert (tmp_path / "again.csv").read_bytes() == path.read_bytes()
    assert "no film, today" in format_costs(back)
    path.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="columns"):
        read_table(path, Cost)


# tabulating a map takes seconds
@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in effects.CASES if name != "`ImpedanceMap`"])
def test_every_case_of_effects_is_evaluated_on_the_orbit(name):
    case = effects.CASES[name]
    assert case.base in ("", *effects.CASES)
    model = build_model(growth.plain_bearing(**({"film": ehd.FiniteLength(n_theta=32, n_z=4)} | dict(case.options))))
    assert np.all(effects.stages(model, effects.orbit(count=6)) >= 0.0)


def test_the_orbit_moves_with_its_own_velocity():
    motions, step = effects.orbit(), effects.DEGREE / (effects.WHIRL * growth.SPEED)
    angle = np.arctan2(motions[:, 1], motions[:, 0])
    assert np.diff(angle) == pytest.approx(effects.DEGREE)
    moved = np.gradient(motions[:, :2], step, axis=0)
    # the radial velocity is left out: 0.05 * 5 of 0.8
    assert np.linalg.norm(moved - motions[:, 4:6], axis=1).max() < 0.35 * np.linalg.norm(moved, axis=1).max()


def test_effects_of_some_names(monkeypatch):
    bad = effects.Case(options={"profile": ehd.OutOfRound(order=2, amplitude=2e-5)})
    monkeypatch.setitem(effects.CASES, "touching", bad)
    names = ["`Gumbel`", "`ElrodAdams`, `LumpedThermal`", "touching"]
    found = effects.measure_effects(names, blocks=2, rounds=1, grid=(32, 4), progress=_silent)
    known = {(cost.what, cost.per): cost for cost in found}
    for per in (effects.EVALUATION, effects.STEP):
        assert known["`Gumbel`", per].base == effects.PLAIN
        assert known["`Gumbel`", per].factor > 0.0
        assert known["`ElrodAdams`, `LumpedThermal`", per].base == effects.CONSERVING
        assert known[effects.PLAIN, per].seconds > 0.0
        assert known["touching", per].failure
    step, evaluation = (known[effects.PLAIN, per].seconds for per in (effects.STEP, effects.EVALUATION))
    assert 2.0 < step / evaluation < 4.0


@pytest.mark.slow
def test_bushes():
    cases = {name: bushes.CASES[name] for name in (bushes.RIGID, "`ElasticLiner`", "`ModalBush`")}
    # a liner as soft as rubber is pressed through its film
    soft = ehd.ElasticLiner(thickness=0.02, youngs_modulus=1e5)
    cases["soft"] = dataclasses.replace(cases["`ElasticLiner`"], bush=soft)
    found = bushes.measure_bushes(cases, blocks=1, turns=1, share=0.05, progress=_silent)
    known = {(cost.what, cost.per): cost for cost in found}
    for name in list(cases)[:3]:
        cost = known[name, bushes.STEP_TIME]
        assert cost.seconds > 0.0 and 1.0 <= cost.iterations < 20.0
    assert known["`ModalBush`", bushes.STEP_TIME].modes == 48
    assert known["`ModalBush`", bushes.STEP_TIME].base == bushes.RIGID
    assert known["`ModalBush`", bushes.JACOBIAN].seconds > 0.0
    assert known["soft", bushes.STEP_TIME].failure
    assert {cost.what for cost in found if cost.per == bushes.ASSEMBLY} == set(bushes.ASSEMBLIES)


def test_exponent():
    sizes = (10, 20, 40)
    assert growth.exponent(sizes, tuple(3e-6 * n**1.7 for n in sizes)) == pytest.approx(1.7)


def test_growth_runs(tmp_path):
    found = growth.joint_growth(1, (1, 3))
    assert found.sizes == (1, 3)
    assert 0.0 < found.seconds[0] < found.seconds[1]
    growth.write_growths(tmp_path / "growth.csv", [found], "note")
    (back,), notes = growth.read_growths(tmp_path / "growth.csv")
    assert notes == ["note"]
    assert back.sizes == found.sizes and back.name == found.name
    assert back.exponent == pytest.approx(found.exponent, rel=1e-2)
