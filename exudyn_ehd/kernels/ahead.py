"""Compiles the kernels of a first film by two processes, before the film would compile them one after the other.

numba compiles under one lock, so that threads do not help. A helper, a second process in `main`, compiles kernels into
numba's cache, from which this process reads them; both take the next one of the table whose callees are there. The
helper lives as long as the call that needs it. Where it does not start, or dies, this process compiles what is left.

There is no helper if all is in the cache, on a machine with one core, in the processes of a study or of a parallel test
run, and with ``EXUDYN_EHD_HELPER=0``.

The table ``first_films.txt`` has the kernels that the first films compile, with the types of their arguments as text: a
line has a group, a kernel as ``module:function``, its arguments, and the kernels of the table that it calls. Types
are f, i, u, b for 64-bit floats, integers, unsigned integers and bool; f2 for a contiguous array of two dimensions, f2A
for one with any strides; - for None; (f1 f1) for a tuple and ``module:Name(f1 f1)`` for a NamedTuple. Modules are those
of the package.

The helper reads numbers of lines of the table from its standard input and answers each with the same number. It ends
with its input, and so with the process that started it.
"""

from __future__ import annotations

import importlib
import itertools
import multiprocessing
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterable
from contextlib import suppress
from typing import Any, NamedTuple

import numba
import numpy as np
from numba.core import types
from numba.core.types.containers import BaseTuple

TABLE = pathlib.Path(__file__).parent / "first_films.txt"
PACKAGE = __name__.split(".")[0]
SCALARS = {"f": types.float64, "i": types.int64, "u": types.uint64, "b": types.boolean, "-": types.none}
_TOKEN = re.compile(r"[()]|[\w.]+:\w+|[fiub]\d?A?|-")


class Kernel(NamedTuple):
    """One line of the table.

    Attributes
    ----------
    group : str
        Films that need it.
    function : str
        ``module:function``, modules without the package's name.
    arguments : str
        Types, see this module.
    after : tuple of str
        Kernels of the table that it calls, each ``module:function``.
    """

    group: str
    function: str
    arguments: str
    after: tuple[str, ...]

    def compile(self) -> bool:
        """Compile the kernel, or read it from numba's cache; returns whether it was there."""
        dispatcher = find(self.function)
        before = sum(dispatcher.stats.cache_hits.values())
        known = len(dispatcher.signatures)
        dispatcher.compile(read_types(self.arguments))
        return len(dispatcher.signatures) == known or sum(dispatcher.stats.cache_hits.values()) > before


def find(name: str) -> Any:
    """Return the object of the package with the path ``module:name``."""
    module, function = name.split(":")
    return getattr(importlib.import_module(f"{PACKAGE}.{module}"), function)


def table() -> tuple[Kernel, ...]:
    """All lines, the first to be compiled first."""
    lines = (f"{line} ".split("|") for line in TABLE.read_text(encoding="utf-8").splitlines())
    return tuple(Kernel(g.strip(), f.strip(), a.strip(), tuple(after.split())) for g, f, a, after in lines)


def read_types(text: str) -> tuple[types.Type, ...]:
    """Types of the arguments of a kernel from their text."""
    stack: list[list[types.Type]] = [[]]
    makers: list[str] = []
    named = ""
    for token in _TOKEN.findall(text):
        if token == "(":
            stack.append([])
            makers.append(named)
            named = ""
        elif token == ")":
            items, maker = stack.pop(), makers.pop()
            stack[-1].append(BaseTuple.from_types(items, find(maker) if maker else None))
        elif ":" in token:
            named = token
        elif len(token) == 1:
            stack[-1].append(SCALARS[token])
        else:
            stack[-1].append(types.Array(SCALARS[token[0]], int(token[1]), "A" if token.endswith("A") else "C"))
    return tuple(stack[0])


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
_START = "import sys; sys.path.insert(0, sys.argv[1]); from exudyn_ehd.kernels.ahead import main; main()"
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


def main() -> None:
    """Answer until the input ends."""
    # who interrupts the run from its terminal means the first process, which ends this one
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    kernels = table()
    print(TABLE, flush=True)
    for line in sys.stdin:
        kernels[int(line)].compile()
        print(line.strip(), flush=True)
