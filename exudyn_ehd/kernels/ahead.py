"""Compiles the kernels of a first film by two processes, before the film would compile them one after the other.

numba compiles under one lock, so that threads do not help. A helper, `exudyn_ehd.kernels.helper`, compiles kernels into
numba's cache, from which this process reads them; both take the next one of the table whose callees are there. The
helper lives as long as the call that needs it. Where it does not start, or dies, this process compiles what is left.

There is no helper if all is in the cache, on a machine with one core, in the processes of a study or of a parallel test
run, and with ``EXUDYN_EHD_HELPER=0``.
"""

from __future__ import annotations

import itertools
import multiprocessing
import os
import pathlib
import subprocess
import sys
import threading
from collections.abc import Iterable
from contextlib import suppress

import numba
import numpy as np

from exudyn_ehd.kernels.signatures import TABLE, Kernel, table

HELPER_VARIABLE = "EXUDYN_EHD_HELPER"
# s after which a helper that has not answered is given up; it needs 2 s for its longest kernel on a quiet machine
PATIENCE = 60.0
# Fewer kernels than this are compiled before a helper has started.
FEWEST = 10
# A kernel of each group that compiles in a moment, and that no other film needs
PROBES = {
    "film": "film.loads:end_forces",
    "swift": "film.loads:couette_integral",
    "elrod": "film.reynolds.links:lag_void",
    "bodies": "coupling.kinematics.relative:_jac_column",
}
_START = "import sys; sys.path.insert(0, sys.argv[1]); from exudyn_ehd.kernels.helper import main; main()"
_seen: set[str] = set()


def compile_ahead(*groups: str) -> None:
    """Compile the kernels of groups of the table by two processes, if they are not in numba's cache.

    Does nothing where there can be no helper: whoever calls the kernels compiles them.
    """
    new = [group for group in groups if group not in _seen]
    if not new or not _may_start():
        return
    _seen.update(new)
    lines = dict(enumerate(table()))
    # behind the first group that is not in the cache the others are not asked for: what is there is read in a moment
    absent = list(itertools.dropwhile(lambda group: _is_cached(group, lines.values()), new))
    wanted = {number: kernel for number, kernel in lines.items() if kernel.group in absent}
    if len(wanted) >= FEWEST:
        _Shares(wanted).compile()


def _may_start() -> bool:
    if os.environ.get(HELPER_VARIABLE) == "0" or "PYTEST_XDIST_WORKER" in os.environ or numba.config.DISABLE_JIT:
        return False
    if multiprocessing.parent_process() is not None or getattr(sys, "frozen", False) or not sys.executable:
        return False
    # the table knows integers of 64 bits
    return np.int_ is np.int64 and cores() > 1


def cores() -> int:
    """Cores that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def _is_cached(group: str, kernels: Iterable[Kernel]) -> bool:
    """Return whether the group's probe, a kernel that compiles fast, was in numba's cache; it is compiled if not."""
    return next(kernel for kernel in kernels if kernel.function == PROBES[group]).compile()


class _Shares:
    """Kernels that this process and a helper compile.

    Parameters
    ----------
    kernels : dict
        Lines of the table by their number.
    """

    def __init__(self, kernels: dict[int, Kernel]) -> None:
        self.kernels = kernels
        self.left = list(kernels)
        self.unfinished = set(kernels)
        self.change = threading.Condition()
        self.helper: subprocess.Popen[str] | None = None

    def compile(self) -> None:
        """Compile all, with a helper if it starts."""
        try:
            self.helper = _start_helper()
        except OSError:
            return
        partner = threading.Thread(target=self._feed, args=(self.helper,), daemon=True)
        partner.start()
        try:
            while (number := self._take()) is not None:
                self.kernels[number].compile()
                self._finish(number)
        finally:
            with self.change:
                self.left.clear()
                self.change.notify_all()
            # it has nothing to do any more, or this process is interrupted
            self.helper.kill()
            partner.join()

    def _take(self, helping: bool = False) -> int | None:
        """The next kernel whose callees are there, once there is one; None: nothing is left."""
        with self.change:
            while self.left or (self.unfinished and not helping):
                waiting = {self.kernels[number].function for number in self.unfinished}
                for number in self.left:
                    if waiting.isdisjoint(self.kernels[number].after):
                        self.left.remove(number)
                        return number
                if not self.change.wait(PATIENCE) and not helping and self.helper is not None:
                    # gives back what it has, see _feed
                    self.helper.kill()
            return None

    def _finish(self, number: int) -> None:
        with self.change:
            self.unfinished.discard(number)
            self.change.notify_all()

    def _feed(self, helper: subprocess.Popen[str]) -> None:
        """Give the helper one kernel after the other; where it fails, give its kernel back."""
        number = None
        try:
            # a pipe that is broken is so once more when it is closed
            with suppress(OSError, ValueError), helper:
                assert helper.stdin is not None and helper.stdout is not None
                if helper.stdout.readline().strip() == str(TABLE):
                    while (number := self._take(helping=True)) is not None:
                        print(number, file=helper.stdin, flush=True)
                        if helper.stdout.readline().strip() != str(number):
                            break
                        self._finish(number)
        finally:
            with self.change:
                if number is not None:
                    self.left.append(number)
                self.change.notify_all()


def _start_helper() -> subprocess.Popen[str]:
    environment = dict(os.environ)
    if numba.config.CACHE_DIR:
        environment["NUMBA_CACHE_DIR"] = numba.config.CACHE_DIR
    return subprocess.Popen(
        [sys.executable, "-c", _START, str(pathlib.Path(TABLE).parents[2])],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        encoding="utf-8",
        env=environment,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
