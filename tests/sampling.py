"""Samples of long tables of cases: the default run takes some, the slow tests take the rest."""

import re

import pytest

# Folders whose tests solve films, and words of such a test's name that go together: kernels for a density law, a liner,
# and shear thinning with cavities that keep their oil take as long to compile as those of all other films. An audit
# tries shear thinning on every film.
OF_FILMS = re.compile(
    "tests/(benchmarks|contracts|coupling|film/(lubricant|solvers)|hard_cases|joint|mechanisms|validation)/"
)
LONG_TO_COMPILE = (
    ("densi|dense|compress|dowson", ""),
    ("elrod|conserv", "carreau|shear law|thinning"),
    ("liner", ""),
    ("audit", "all laws|conserv|elasticity|elrod|keep_their_oil|remembers|says_the_same|shear thinning"),
    ("line in its cells", ""),
)


def is_long_to_compile(name):
    """Return whether the film of a test of this name (`item.nodeid`) has kernels that take long to compile."""
    words = name.lower().replace("-", "")
    return bool(OF_FILMS.match(name)) and any(re.search(a, words) and re.search(b, words) for a, b in LONG_TO_COMPILE)


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
