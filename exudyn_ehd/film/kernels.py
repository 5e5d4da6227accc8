"""Integers and truth values of one type each, for kernels, and the freedom of their sums.

numba compiles a kernel anew for every plain number or truth value among its arguments. A signed index is checked for
being negative, which keeps loops from being vectorised; with a plain number beside it an unsigned one becomes a float.
"""

from __future__ import annotations

from typing import Any

import numpy as np

# What a compiler may do with sums: reorder and fuse them, lose the sign of a zero, multiply by inverses; infinite
# values and nan stay what they are.
FAST = {"reassoc", "contract", "nsz", "arcp"}
# The same in the order that is written.
FUSED = {"contract", "nsz", "arcp"}
I0, I1, I4 = np.int64(0), np.int64(1), np.int64(4)
# Any: for mypy, products of numpy's integers are no indices
unsigned: Any = np.uint64
U0, U1, U2, U3, U4 = (unsigned(k) for k in range(5))
YES, NO = np.True_, np.False_
