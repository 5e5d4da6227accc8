"""Contract of every film: finite, in balance and differentiated exactly, over a covering array of bearings."""

import math
import warnings

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.recorded import draw, record
from tests.sampling import covering_places

ROWS = list(enumerate(draw.rows()))
# Their kernels take longer to compile than all others to run.
LONG = {"carreau", "dowson", "liner", "soft liner", "walls", "across", "elrod in cells"}
# Rows of the default run: every pair of levels whose kernels compile quickly.
CANDIDATES = [(k, row) for k, (covers, row) in ROWS if (k < 150 or covers) and not LONG & set(row.values())]
QUICK = {CANDIDATES[n][0] for n in covering_places([tuple(row.values()) for _, row in CANDIDATES])}
# All others of the covering array are slow. Random bearings with kernels that are long to compile are recorded.
ROWS = [(k, drawn) for k, drawn in ROWS if drawn[0] or k in QUICK]


def names_of(row):
    """Levels of a row that are not the absence of an effect."""
    return [name for name in row.values() if name not in ("none", "on", "ambient", "rigid")]


def cases():
    """Rows as parameters; all but the quick ones are slow, and ids of the covering array begin with "covers"."""
    return [
        pytest.param(
            k,
            row,
            id=f"{'covers ' * covers}{k}: {', '.join(names_of(row))}",
            marks=() if k in QUICK else pytest.mark.slow,
        )
        for k, (covers, row) in ROWS
    ]


def loads_of(evaluation):
    """Wrench and loads on the coordinates of flexible surfaces."""
    bore = getattr(evaluation, "bore", None)
    return np.concatenate((evaluation.wrench, np.zeros(0) if bore is None else bore.load))


def check_evaluation(model, motion, history, step, evaluation, directions):
    """A film's numbers are finite, its oil is in balance and its tangent is the derivative of its loads."""
    tangent, values = evaluation.tangent(), evaluation.quantities()
    assert np.all(np.isfinite(evaluation.wrench)) and np.all(np.isfinite(tangent))
    assert all(math.isfinite(v) for v in values.values()), values
    if model.bearing.cavitation.conserves_mass:
        check_mass(model, evaluation, history, step)
    unit = np.abs(directions).max(axis=0)
    scale = np.abs(tangent * unit).max(axis=1)
    for change in directions:
        # central differences over 3e-7 of the directions: truncation up to 2e-7, round-off some 3e-9 of smooth states
        ends = [loads_of(model.evaluate(motion + s * 3e-7 * change, history, step)) for s in (1.0, -1.0)]
        off = np.abs(tangent @ change - (ends[0] - ends[1]) / 6e-7)
        assert np.all(off < 1e-6 * scale), off / scale


def check_mass(model, evaluation, history, step):
    """The inflow at prescribed vertices equals the gain of the film's content, to round-off of the flows."""
    after, s = evaluation.history(), model.solver
    inflow = s.inflow()
    # without squeeze the film has no memory: what flows in flows out
    mass = getattr(after, "mass", None)
    gain = 0.0 if mass is None else np.sum((mass - history.mass) * s.area) / step
    assert inflow.sum() == pytest.approx(gain, abs=1e-10 * np.abs(inflow).sum() + 1e-10 * abs(gain) + 1e-9)


@pytest.mark.parametrize(("k", "row"), cases())
def test_evaluation(k, row):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = draw.model_of(row)
        for motion, history, evaluation, directions in record.steps(model, k):
            if evaluation.status is ehd.Status.CONVERGED:
                check_evaluation(model, motion, history, record.STEP, evaluation, directions)
            else:
                # gaps that close without a contact, and what an iteration has not found
                assert np.all(np.isnan(evaluation.wrench)) or np.all(np.isfinite(evaluation.wrench))


def test_most_states_have_a_film():
    """The contract looks at films: nine of ten recorded states have one."""
    assert np.mean(record.read("films")[:, :, 0] == ehd.Status.CONVERGED.value) > 0.9


def test_pairs_are_refused_for_the_recorded_reasons(monkeypatch):
    """Every pair of levels is in the covering array, or is refused with the recorded message."""
    monkeypatch.setattr("exudyn_ehd.joint.model.build.compile_kernels", lambda model: None)
    covered = set().union(*(draw.pairs_of(row) for _, (covers, row) in ROWS if covers))
    plain = {name: next(iter(levels)) for name, levels in draw.FACTORS.items()}
    for pair in draw.all_pairs() - covered:
        assert draw.refusal(plain | dict(pair)) == draw.refused()[pair]
