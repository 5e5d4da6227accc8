"""Limits of the costs paid once; ``-m benchmark``.

Targets: 20 s for the first film with an empty kernel cache, 2 s from the cache,
10 s for an impedance map, 3 s for modes.
"""

import pytest

from tests.benchmarks.accuracy.costs import once

pytestmark = pytest.mark.benchmark


def test_what_is_paid_once():
    found = once.measure_once(turns=1, progress=lambda text: None)
    times = {(cost.what, cost.per): cost.seconds for cost in found}
    for place, seconds in times.items():
        print(f"{place}: {seconds:.3f} s")
    assert not [cost for cost in found if cost.failure]
    (modes,) = {what for what, _ in times if "modes" in what}
    assert times[once.FIRST_FILM, once.EMPTY] < 20.0
    assert times[once.FIRST_FILM, once.FULL] < 2.0
    assert times[once.MAP, once.EMPTY] < 10.0
    assert times[modes, once.EMPTY] < 3.0 and times[modes, once.FULL] < 0.1
