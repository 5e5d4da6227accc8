"""What is paid once; ``-m benchmark``. Targets: 20 s for the first film with an empty kernel cache, 2 s from the cache, 10 s for an impedance map, 3 s for modes."""

import pytest

from exudyn_ehd.studies import once_costs

pytestmark = pytest.mark.benchmark


def test_what_is_paid_once():
    found = once_costs.measure_once(turns=1, progress=lambda text: None)
    times = {(cost.what, cost.per): cost.seconds for cost in found}
    for place, seconds in times.items():
        print(f"{place}: {seconds:.3f} s")
    assert not [cost for cost in found if cost.failure]
    (modes,) = {what for what, _ in times if "modes" in what}
    assert times[once_costs.FIRST_FILM, once_costs.EMPTY] < 20.0
    assert times[once_costs.FIRST_FILM, once_costs.FULL] < 2.0
    assert times[once_costs.MAP, once_costs.EMPTY] < 10.0
    assert times[modes, once_costs.EMPTY] < 3.0 and times[modes, once_costs.FULL] < 0.1
