"""Limits of the costs paid once; ``-m benchmark``.

Targets: 20 s for the first film with an empty kernel cache, of which 8 s in the process that waits for it, 2 s from the
cache, 10 s for an impedance map, 3 s for modes.
"""

import os
import subprocess
import sys
import time

import pytest

from exudyn_ehd.kernels import ahead
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


@pytest.mark.skipif(ahead.cores() < 2, reason="the helper needs a core of its own")
def test_half_of_the_first_compilation_is_the_helper_s(tmp_path):
    """Processor time of the first process alone, which is what somebody waits for where two cores are free."""
    code = f"{once.FIRST_RESULT}import time; print(time.process_time())"
    own, waited = [], []
    for turn in range(2):
        start = time.perf_counter()
        environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / str(turn))}
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        waited.append(time.perf_counter() - start)
        own.append(float(done.stdout))
        print(f"first film: {own[-1]:.1f} s in the first process, {waited[-1]:.1f} s until it was there")
    assert min(own) < 8.0
