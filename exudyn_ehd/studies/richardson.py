"""A converged reference and an estimate of its own error from three levels of refinement.

With values f1, f2, f3 on levels that are each ``ratio`` times finer than the one before and an error ~ h^p,

    p = log(|f2 - f1| / |f3 - f2|) / log(ratio),    |f3 - f| = |f3 - f2| / (ratio^p - 1).

Source: L. F. Richardson, Phil. Trans. Royal Soc. A 210 (1911) 307; use and limits as in P. J. Roache, J. Fluids
Engineering 116 (1994) 405. The observed order is cut off at the scheme's formal order, beyond which it is luck, and at
1/2, below which the levels do not converge visibly (the rupture line snaps to columns): the estimate then is
pessimistic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.status import InputError, require_number

LOWEST_ORDER = 0.5


@dataclass(frozen=True, kw_only=True, eq=False)
class Converged:
    """A reference value.

    Attributes
    ----------
    value : ndarray
        Of the finest level, not extrapolated.
    error : float
        Estimate of the distance from ``value`` to the limit.
    order : float
        Order it rests on.
    """

    value: np.ndarray
    error: float
    order: float


def converged(levels: Sequence[np.ndarray], *, ratio: float, formal_order: float, scale: float) -> Converged:
    """Reference from three levels.

    Parameters
    ----------
    levels : three arrays of one shape
        Coarse to fine.
    ratio : float
        Refinement from level to level, > 1.
    formal_order : float
        Order of the scheme for smooth solutions.
    scale : float
        Differences are the largest over the array, divided by it.

    Raises
    ------
    InputError
        For anything but three finite levels, or a ratio of 1 or less.
    """
    if len(levels) != 3 or not all(np.all(np.isfinite(level)) for level in levels):
        raise InputError(f"converged: levels must be three finite values, coarse to fine, got {levels!r}.")
    require_number("converged: formal_order", formal_order, at_least=LOWEST_ORDER)
    if require_number("converged: ratio", ratio) <= 1.0:
        raise InputError(f"converged: ratio must be > 1 (levels go from coarse to fine), got {ratio!r}.")
    require_number("converged: scale", scale, above=0.0)
    first, last = (float(np.max(np.abs(np.asarray(levels[k]) - levels[k + 1]))) / scale for k in (0, 1))
    order = formal_order
    if last > 0.0:
        observed = math.log(first / last) / math.log(ratio) if first > 0.0 else LOWEST_ORDER
        order = min(max(observed, LOWEST_ORDER), formal_order)
    return Converged(value=np.asarray(levels[2]), error=last / (ratio**order - 1.0), order=order)
