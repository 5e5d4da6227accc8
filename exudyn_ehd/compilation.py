"""Compilation of kernels: constants of one type for them, a line for the user, and a pause of the garbage collector.

Constants
---------
numba compiles a kernel again for every literal number or truth value among its arguments. It checks whether signed
indices are negative, which prevents vectorised loops. An unsigned index plus a literal number becomes a float.

Compilations in this process
----------------------------
numba reports every compilation as an event. Kernels that are read from its cache make none. The collector would look
through numba's syntax trees again and again, which takes a tenth of the processor time.
"""

from __future__ import annotations

import gc
from typing import Any

import numpy as np
from numba.core import event

from exudyn_ehd.progress import tell

# Permissions of the compiler: reorder sums, fuse products and sums, ignore the sign of zero, multiply by inverses.
# Infinite values and nan are handled exactly.
FAST = {"reassoc", "contract", "nsz", "arcp"}
# The same permissions, but sums in the written order.
FUSED = {"contract", "nsz", "arcp"}
I0, I1, I4 = np.int64(0), np.int64(1), np.int64(4)
# of type Any, since mypy accepts no products of numpy integers as indices
unsigned: Any = np.uint64
U0, U1, U2, U3, U4 = (unsigned(k) for k in range(5))
YES, NO = np.True_, np.False_
# Tolerance of iterations for a film, relative: some hundred units of round-off. Larger values reduce the accuracy,
# smaller ones prevent convergence. Largest number of their steps.
TOLERANCE, MOST_STEPS = 1e-13, 60

MESSAGE = "exudyn_ehd: compiling kernels, once per installation (about 20 s for a first film) ..."


class Compilations(event.Listener):
    """Listener to numba's compilations, which runs under numba's lock.

    Attributes
    ----------
    count : int
        Kernels of the package that this process has compiled.
    """

    def __init__(self) -> None:
        self.count = 0
        self._running, self._collects = 0, False

    def on_start(self, event: event.Event) -> None:
        """Begin a compilation, maybe within another one."""
        if self._running or event.data["dispatcher"].py_func.__module__.startswith("exudyn_ehd."):
            if self._running == 0:
                self._collects = gc.isenabled()
                gc.disable()
            if self.count == 0:
                tell(MESSAGE)
            # no kernel is handed over as a C function
            event.data["dispatcher"].targetoptions["no_cfunc_wrapper"] = True
            self.count += 1
            self._running += 1

    def on_end(self, event: event.Event) -> None:
        """End the compilation that began last."""
        if self._running:
            self._running -= 1
            if self._running == 0 and self._collects:
                gc.enable()


COMPILATIONS = Compilations()
event.register("numba:compile", COMPILATIONS)
