"""Verdicts of the audit against true changes: random bearings at equal load on converged grids (`truths`)."""

import collections

import pytest

from tests.joint.audit import truths

SCENES = truths.read()
MATTERS, NOTHING = 0.1, 0.025


def score(numbers):
    """By effect: verdicts on changes above 10 % and below 2.5 %, True where the audit says that it matters."""
    said = collections.defaultdict(lambda: ([], []))
    for number in filter(SCENES.__getitem__, numbers):
        verdicts = truths.flagged(truths.draw(number))
        for effect, change in SCENES[number].items():
            if change is not None and not NOTHING <= change <= MATTERS:
                said[effect][change < NOTHING].append(verdicts[effect])
    return said


def test_verdicts_on_some_bearings():
    for effect, (large, small) in score((2, 9)).items():
        assert all(large) and not any(small), effect


@pytest.mark.slow
def test_verdicts_on_many_bearings(measured):
    """Every fourth bearing of the file."""
    for effect, (large, small) in score(range(0, len(SCENES), 4)).items():
        if large:
            measured(f"{effect}: missed of {len(large)}", 1.0 - sum(large) / len(large), 0.03)
        if small:
            measured(f"{effect}: false alarms of {len(small)}", sum(small) / len(small), 0.05)


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 5])
def test_stored_truths_are_those_of_today(number):
    for effect, change in truths.truth(truths.draw(number)).items():
        stored = SCENES[number][effect]
        assert change == pytest.approx(stored, abs=2e-3 + 0.01 * (stored or 0.0)), effect


@pytest.mark.slow
@pytest.mark.parametrize("number", [row["scene"] for row in truths.read(truths.COMPLETE)[:20]])
def test_followed_advice_ends_at_the_film_with_everything_on(number, measured):
    clean, rounds, differences = truths.follow(number)
    assert clean and rounds <= 4
    for name, difference in differences.items():
        measured(f"{name} against everything on", abs(difference), 0.05)
