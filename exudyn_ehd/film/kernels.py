"""Integers and truth values of one type each for kernels, and options of floating-point arithmetic.

numba compiles a kernel again for every literal number or truth value among its arguments. It checks whether signed
indices are negative, which prevents vectorised loops. An unsigned index plus a literal number becomes a float.
"""

from __future__ import annotations

from typing import Any

import numpy as np

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
