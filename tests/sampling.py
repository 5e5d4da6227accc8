"""Samples of long tables of cases: the default run takes some, the slow tests take the rest."""

import itertools
import re

import numpy as np
import pytest

# Folders whose tests solve films, and words of such a test's name that go together: kernels for a density law, a liner,
# and shear thinning with cavities that keep their oil take as long to compile as those of all other films. An audit
# tries shear thinning on every film.
OF_FILMS = re.compile(
    "tests/(benchmarks|contracts|coupling|film/(lubricant|solvers|thrust)|hard_cases|joint|mechanisms|validation)/"
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
    cases : iterable
        Tuples hold the values of several parameters; what `pytest.param` returns keeps its name and its marks.
    kept : int
        Places in the sequence; negative ones count from its end.
    """
    cases = [case if isinstance(case, ParameterSet) else _parameters(case) for case in cases]
    places = range(len(cases))
    chosen = {places[k] for k in kept}
    return [
        case if k in chosen else case._replace(marks=(*case.marks, pytest.mark.slow)) for k, case in enumerate(cases)
    ]


ParameterSet = type(pytest.param())


def _parameters(case):
    return pytest.param(*(case if isinstance(case, tuple) else (case,)))


def covering_places(cases, seed=0):
    """Return the places of a covering sample of strength 2.

    Every pair of values of two elements of the tuples that is in a case is in a case of the sample. The sample is
    drawn greedily, as the array of `tests.recorded.draw`; the seed decides between equal ones.

    Parameters
    ----------
    cases : sequence of tuple
    seed : int

    Returns
    -------
    list of int
    """
    # the place of the first case with the same value
    columns = [list(column) for column in zip(*cases, strict=True)]
    levels = [[column.index(value) for column, value in zip(columns, case, strict=True)] for case in cases]
    pairs = [set(itertools.combinations(enumerate(level), 2)) for level in levels]
    todo, kept = set().union(*pairs), []
    order = np.random.default_rng(seed).permutation(len(cases)).tolist()
    while todo:
        kept.append(max(order, key=lambda k: len(pairs[k] & todo)))
        todo -= pairs[kept[-1]]
    return kept


def covering(cases, seed=0):
    """Cases as parameters; all but a covering sample of strength 2 are marked as slow (`covering_places`)."""
    cases = list(cases)
    return sample(cases, *covering_places(cases, seed))
