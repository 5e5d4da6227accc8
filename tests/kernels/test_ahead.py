"""Kernels shared out between a process and its helper: order, a helper that fails in any way, when there is none."""

import os
import subprocess
import sys
import time

import pytest

from exudyn_ehd.kernels import ahead
from exudyn_ehd.kernels.ahead import TABLE, Kernel

ANSWERS = """
import os, sys, time
print({first!r}, flush=True)
for k, line in enumerate(sys.stdin):
    if k == {good}:
        {then}
    print(line.strip(), flush=True)
"""
HELPERS = {
    "answers": ANSWERS.format(first=str(TABLE), good=-1, then="pass"),
    "another package's": ANSWERS.format(first="elsewhere", good=-1, then="pass"),
    "dies at once": "",
    "dies at its second kernel": ANSWERS.format(first=str(TABLE), good=1, then="sys.exit(1)"),
    "hangs at its second kernel": ANSWERS.format(first=str(TABLE), good=1, then="time.sleep(60)"),
    "dies behind its first answer": ANSWERS.format(first=str(TABLE), good=0, then="sys.stdin.close(); os.close(0)"),
    "talks nonsense": ANSWERS.format(first=str(TABLE), good=1, then="print('?', flush=True)"),
}


class Notes(list):
    """Kernels in the order in which this process has compiled them."""

    def kernel(self, name, after=()):
        notes = self

        class Noted(Kernel):
            def compile(self):
                # the helper needs a moment to start
                time.sleep(0.05)
                notes.append(self.function)
                return False

        return Noted("film", name, "", tuple(after))


@pytest.fixture
def started(monkeypatch):
    """Function that puts a script in the place of the helper; returns the list of helpers."""
    found = []

    def use(script):
        def start():
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
            found.append(subprocess.Popen([sys.executable, "-c", script], **pipes))
            return found[-1]

        monkeypatch.setattr(ahead, "_start_helper", start)
        return found

    return use


@pytest.mark.parametrize("kind", HELPERS)
def test_every_kernel_is_compiled_whatever_the_helper_does(started, monkeypatch, kind):
    monkeypatch.setattr(ahead, "PATIENCE", 0.5)
    helpers, notes = started(HELPERS[kind]), Notes()
    chain = {k: notes.kernel(f"m:{k}", [f"m:{k - 2}"] if k > 1 else []) for k in range(8)}
    shares = ahead._Shares(chain)
    shares.compile()
    assert not shares.left and not shares.unfinished
    # what this process did not compile, the helper did; each once, but for the one that it gave back
    assert len(set(notes)) == len(notes) and set(notes) <= {f"m:{k}" for k in range(8)}
    if kind in ("another package's", "dies at once"):
        assert len(notes) == 8
    # in the order of the table, as far as callees allow
    assert notes == sorted(notes) or kind not in ("answers", "another package's", "dies at once")
    # it is gone, and waited for
    assert helpers[0].returncode is not None


def test_the_helper_takes_its_share(started):
    helpers, notes = started(HELPERS["answers"]), Notes()
    many = {k: notes.kernel(f"m:{k}") for k in range(100)}
    ahead._Shares(many).compile()
    assert 0 < len(notes) < len(many) and helpers[0].returncode is not None


def test_an_interruption_ends_the_helper(started):
    class Interrupted(Kernel):
        def compile(self):
            raise KeyboardInterrupt

    helpers = started(HELPERS["answers"])
    kernels = {k: Interrupted("film", f"m:{k}", "", ()) for k in range(3)}
    with pytest.raises(KeyboardInterrupt):
        ahead._Shares(kernels).compile()
    assert helpers[0].returncode is not None


def test_without_a_helper_who_calls_a_kernel_compiles_it(monkeypatch):
    def refused():
        raise OSError

    notes = Notes()
    monkeypatch.setattr(ahead, "_start_helper", refused)
    ahead._Shares({0: notes.kernel("m:0")}).compile()
    assert not notes


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (f"os.environ:{ahead.HELPER_VARIABLE}", "0"),
        ("os.environ:PYTEST_XDIST_WORKER", "gw0"),
        ("numba.config.DISABLE_JIT", 1),
        ("multiprocessing.parent_process", lambda: 1),
        ("sys.frozen", True),
        ("sys.executable", None),
        ("exudyn_ehd.kernels.ahead.cores", lambda: 1),
    ],
)
def test_there_is_no_helper(monkeypatch, place, value):
    monkeypatch.delenv("PYTEST_XDIST_WORKER", raising=False)
    monkeypatch.delenv(ahead.HELPER_VARIABLE, raising=False)
    monkeypatch.setattr("exudyn_ehd.kernels.ahead.cores", lambda: 2)
    assert ahead._may_start()
    if place.startswith("os.environ:"):
        monkeypatch.setitem(os.environ, place.split(":")[1], value)
    else:
        monkeypatch.setattr(place, value, raising=False)
    assert not ahead._may_start()


def test_a_process_looks_once_and_starts_nothing_for_kernels_in_the_cache(monkeypatch):
    monkeypatch.setattr(ahead, "_may_start", lambda: True)
    monkeypatch.setattr(ahead, "_seen", set())
    asked = []
    monkeypatch.setattr(ahead, "_is_cached", lambda group, kernels: not asked.append(group))
    monkeypatch.setattr(ahead, "_start_helper", lambda: pytest.fail("a helper"))
    for _ in range(2):
        ahead.compile_ahead("film", "swift", "bodies")
    assert asked == ["film", "swift", "bodies"]
