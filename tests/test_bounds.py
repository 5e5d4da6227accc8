"""Kernels stay within their arrays: numba checks no index unless asked to.

What is outside is read as garbage, or ends the process. A few tests that take most kernels run again with the checks
on. All of them do by

    NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=/somewhere/else python -m pytest -m "slow or not slow"

in a cache of its own, since the one of kernels without the checks serves those with them too.
"""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from numba import njit

ROOT = pathlib.Path(__file__).resolve().parent.parent
# of every layer those that are quick to compile
CHECKED = (
    "tests/film/banded/",
    "tests/coupling/element/test_settled_start.py::test_start_with_end_pressures_is_the_steady_film",
)


@njit
def take(values, place):
    """One number of an array."""
    return values[place]


def beyond():
    """Read behind an array."""
    take(np.ones(3), 7)


@pytest.mark.slow
def test_kernels_stay_within_their_arrays(tmp_path):
    environment = os.environ | {"NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": str(tmp_path)}
    # the tests of a worker share the cache of modes of its run; these are a run of their own
    environment.pop("PYTEST_XDIST_WORKER", None)
    look = "import importlib.util as u; s = u.spec_from_file_location('t', {!r}); t = u.module_from_spec(s); "
    look += "s.loader.exec_module(t); t.beyond()"
    options = {"cwd": ROOT, "env": environment, "capture_output": True, "text": True}
    done = subprocess.run([sys.executable, "-c", look.format(__file__)], **options)
    assert "IndexError" in done.stderr, "the checks are on"
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-x", "-k", "not nodal", *CHECKED], **options)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]
