"""Progress of long work: one line that is rewritten in place, on a terminal or in a notebook.

Pipes, files and the processes of a study get no such line, nor does work of less than two seconds.
"""

from __future__ import annotations

import logging
import multiprocessing
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from exudyn_ehd.status import require_type

# Seconds until work counts as long, and from one look to the next.
PATIENCE, PERIOD = 2.0, 0.5
# Last argument of `show_progress`.
_asked: list[bool | None] = [None]


def show_progress(on: bool | None = True) -> None:
    """Switch the display of progress on or off: runs, parameter studies, modes, maps, compilation.

    Parameters
    ----------
    on : bool or None, default True
        True: always, also in pipes and files. False: never. None, the state at the start: on a terminal and in
        notebooks.

    Raises
    ------
    InputError
        For anything else.

    Examples
    --------
    >>> ehd.show_progress(False)
    >>> ehd.show_progress(None)
    """
    require_type("show_progress", on, bool, type(None), hint="give True, False or None.")
    _asked[0] = on


def is_shown() -> bool:
    """Return whether progress is shown: on a terminal or in a notebook, or as the user has chosen."""
    if _asked[0] is not None:
        return _asked[0]
    if multiprocessing.parent_process() is not None:
        return False
    return _in_notebook() or bool(sys.stderr is not None and sys.stderr.isatty())


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return type(shell).__name__ == "ZMQInteractiveShell"


def _stream() -> TextIO:
    # notebooks have errors in red
    return sys.stdout if _in_notebook() else sys.stderr


class Progress:
    """The line of one run, which begins now."""

    def __init__(self, title: str) -> None:
        self.title, self.width, self.steps = title, 0, 0
        self.begin = self.last = time.perf_counter()
        self.next = self.begin + PATIENCE

    def step(self, share: float, note: Callable[[float], str]) -> None:
        """Count a step, and write the line if it is due.

        It says the share (0 to 1) that is done, what is left at that rate, and a note on the rate of steps, 1/s.
        """
        now, self.steps = time.perf_counter(), self.steps + 1
        if now >= self.next:
            rate = self.steps / (now - self.last)
            self.steps, self.last, self.next = 0, now, now + PERIOD
            left = f", {_duration((now - self.begin) * (1.0 - share) / share)} left" if share > 0.0 else ""
            self._write(f"{self.title}: {100.0 * share:.0f} %{left}{note(rate)}")

    def close(self) -> None:
        """Take the line away."""
        if self.width:
            self._write("", end="\r")

    def _write(self, text: str, end: str = "") -> None:
        text = text[: shutil.get_terminal_size().columns - 1]
        stream = _stream()
        stream.write(f"\r{text.ljust(self.width)}{end}")
        stream.flush()
        self.width = len(text)


def tell(message: str) -> None:
    """Print a line, to pipes and files too; not in the processes of a study, nor with the display switched off."""
    if _asked[0] is not False and multiprocessing.parent_process() is None:
        print(message, file=_stream(), flush=True)


@contextmanager
def announced(message: str, patience: float = PATIENCE) -> Iterator[None]:
    """Print a message if the block takes longer than ``patience`` seconds: work whose share can't be told."""
    timer = threading.Timer(patience, lambda: print(message, file=_stream(), flush=True))
    timer.daemon = True
    if is_shown():
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


@contextmanager
def without_lines() -> Iterator[None]:
    """Runs within end without the lines that they log."""
    log = logging.getLogger("exudyn_ehd")
    level = log.level
    log.setLevel(max(level, logging.WARNING))
    try:
        yield
    finally:
        log.setLevel(level)


def _duration(seconds: float) -> str:
    """Return a duration in everyday units: 45 s, 3 min 20 s, 2 h 5 min."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
