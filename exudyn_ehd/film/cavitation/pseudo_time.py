"""Pseudo time: the way to a film that Newton's method does not find from where it starts.

A storage of its own, added to every vertex, holds the film back and is taken away step by step; the last step is the
film that is asked for.
"""

from __future__ import annotations

from collections.abc import Callable

MOST_STEPS = 200
# Rates of the storage over those of the film: of the first one, of one that no film comes out of, and of one that is
# none.
FIRST, HOPELESS, LAST = 100.0, 1e6, 1e-3
# From step to step after a film that is found, and after one that is not.
FADES, GROWS = 0.3, 8.0


def pseudo_time(
    attempt: Callable[[float], tuple[bool, int]], rate: float, first: float = FIRST, *, least: float = 0.0
) -> tuple[bool, int]:
    """Follow a film in pseudo time; returns (found, Newton steps).

    Parameters
    ----------
    attempt : function of a rate, 1/s
        Solves with a storage of that rate, 0 for the film that is asked for, and keeps the film if it is found, as the
        start of the next; returns (found, Newton steps).
    rate : float
        Of the film itself, 1/s, > 0.
    first : float
        Rate of the first storage over ``rate``.
    least : float
        Rate over ``rate`` of the smallest storage from which the film without one is tried.
    """
    extra, total = first * rate, 0
    for _ in range(MOST_STEPS):
        ok, steps = attempt(extra)
        total += steps
        if not ok:
            extra *= GROWS
            if extra > HOPELESS * rate:
                return False, total
            continue
        extra *= FADES
        if extra < LAST * rate:
            ok, steps = attempt(0.0)
            total += steps
            if ok:
                return True, total
            if extra < least * rate:
                return False, total
    return False, total
