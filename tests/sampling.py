"""Samples of long tables of cases: the default run takes some, the slow tests take the rest."""

import pytest


def sample(cases, *kept):
    """Cases as parameters of a test; all but those at the places ``kept`` are marked as slow.

    Parameters
    ----------
    cases : sequence
        Tuples hold the values of several parameters.
    kept : int
        Places in the sequence; negative ones count from its end.
    """
    places = range(len(cases))
    chosen = {places[k] for k in kept}
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=() if k in chosen else pytest.mark.slow)
        for k, case in enumerate(cases)
    ]
