"""Files on disk: folders that can't be written, folders that are full, and descriptions by content."""

import dataclasses
import functools
import os
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd import storage
from exudyn_ehd.storage import cached_arrays, fingerprint


@pytest.fixture
def nowhere(tmp_path):
    """An environment and a copy of the package where nothing can be written, not by root either."""
    shutil.copytree(storage.__file__.rsplit(os.sep, 1)[0], tmp_path / "exudyn_ehd", ignore=lambda *_: {"__pycache__"})
    for folder, _, _ in list(os.walk(tmp_path / "exudyn_ehd")):
        (tmp_path / "exudyn_ehd" / folder / "__pycache__").touch()
    names = ("NUMBA_CACHE_DIR", "EXUDYN_EHD_CACHE", "XDG_CACHE_HOME", "IPYTHONDIR")
    kept = {name: value for name, value in os.environ.items() if name not in names}
    return kept | {"HOME": os.devnull, "PYTHONPATH": str(tmp_path), "TMPDIR": str(tmp_path)}


def test_package_runs_where_nothing_can_be_written(nowhere, tmp_path):
    code = (
        "import os, sys, exudyn_ehd.storage as s; from exudyn_ehd.film.loads import np; from numba import njit;"
        "assert os.path.isdir(os.environ['NUMBA_CACHE_DIR']);"
        "x = s.cached_arrays('x', b'', lambda: {'a': s.np.ones(2)}); print(s.__file__, x['a'].sum())"
    )
    done = subprocess.run([sys.executable, "-c", code], env=nowhere, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(tmp_path)) and done.stdout.endswith(" 2.0\n")
    assert done.stderr.count("numba can write its cache neither") == 1 and "set NUMBA_CACHE_DIR" in done.stderr
    assert not list(tmp_path.glob("exudyn_ehd_kernels*")), "the folder of a process goes with it"


def test_who_has_no_home_keeps_nothing(monkeypatch):
    for name in (storage.CACHE_VARIABLE, "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("os.path.expanduser", lambda path: path)
    calls = []
    for _ in range(2):
        cached_arrays("x", b"", lambda: calls.append(1) or {"a": np.zeros(1)})
    assert len(calls) == 2


def test_a_full_cache_loses_what_was_not_used_for_longest(tmp_path, monkeypatch):
    monkeypatch.setenv(storage.CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(storage, "LARGEST_CACHE", 3.5 * 8e4)
    computed = []

    def ask(name):
        def compute():
            computed.append(name)
            return {"a": np.full(10_000, 1.0)}

        cached_arrays("x", name.encode(), compute)
        # times of files may be as coarse as the system's clock
        time.sleep(0.02)

    (tmp_path / ".x_1.bin.abc").write_bytes(b"cut")
    os.utime(tmp_path / ".x_1.bin.abc", (0.0, 0.0))
    (tmp_path / "notes.txt").write_text("mine")
    for name in "abc":
        ask(name)
    ask("a")
    ask("d")
    assert computed == list("abcd") and len(list(tmp_path.glob("*.bin"))) == 3
    assert not (tmp_path / ".x_1.bin.abc").exists() and (tmp_path / "notes.txt").exists()
    for name in "acd":
        ask(name)
    assert computed == list("abcd"), "what was read lately stays"
    ask("b")
    assert computed == list("abcdb")


class Plain:
    """No dataclass."""

    def __init__(self, weights):
        self.weights = weights


def power(x, exponent=2):
    """A function with a default."""
    return x**exponent


def test_fingerprints_tell_contents_apart():
    large = np.arange(5000.0)
    changed = large.copy()
    changed[2500] += 1e-9
    loop: list = [1]
    loop.append(loop)
    bearing = ehd.JournalBearing(
        journal_radius=0.02, length=0.02, radial_clearance=2e-5, lubricant=ehd.Lubricant(viscosity=0.02)
    )
    values = [
        *(large, changed, large.reshape(50, 100), large.astype(np.float32), list(range(5000))),
        *(Plain(large), Plain(changed), Plain(None), {"a": 1}, {"a": 2}, {"b": 1}, (1, (2, 3)), (1, 2, 3)),
        *(functools.partial(power, exponent=2), functools.partial(power, exponent=3), power, lambda x: x, lambda x: -x),
        *(True, 1, 1.5, "1", None, b"1", 2**60, 2**60 + 1, loop, {1, 2}, {1, 3}, Plain, storage.LARGEST_CACHE),
        *(
            bearing,
            dataclasses.replace(bearing, length=0.02 + 1e-17 + 4e-18),
            dataclasses.replace(bearing, squeeze=False),
        ),
    ]
    marks = [fingerprint(value) for value in values]
    assert len(set(marks)) == len(marks)
    # a number is the same however it was written
    assert len({fingerprint(x) for x in (1, 1.0, np.float64(1.0), np.int32(1))}) == 1
    assert fingerprint(bearing) == fingerprint(dataclasses.replace(bearing)) == fingerprint(bearing)
