"""Samples of long tables of cases: the default run takes some, the slow tests take the rest."""

import pytest


def but_slow(cases, *names):
    """Names as parameters of a test; those of ``names`` are marked as slow, as their kernels are long to compile."""
    return [pytest.param(case, marks=pytest.mark.slow if case in names else ()) for case in cases]


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
