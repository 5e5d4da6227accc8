"""The second process of a first compilation: compiles what it is told into numba's cache, line by line.

It reads numbers of lines of the table from its standard input and answers each with the same number. It ends with its
input, and so with the process that started it.
"""

from __future__ import annotations

import signal
import sys

from exudyn_ehd.kernels.signatures import TABLE, table


def main() -> None:
    """Answer until the input ends."""
    # who interrupts the run from its terminal means the first process, which ends this one
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    kernels = table()
    print(TABLE, flush=True)
    for line in sys.stdin:
        kernels[int(line)].compile()
        print(line.strip(), flush=True)
