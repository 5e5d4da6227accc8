"""Errors of tangents against central differences of fourth order."""

import numpy as np


def tangent_error(model, motion, unit, history, step, *, columns=range(10), sizes=(1e-5, 1e-6, 1e-4, 1e-7), limit=1e-6):
    """Return the largest error of a tangent's columns over the largest entry of their row.

    A rupture line that moves over a vertex spoils a difference: the first size whose error is below the limit counts,
    without one the best of all.

    Parameters
    ----------
    model : BearingModel
    motion, unit : (10,) arrays
        Motion, and sizes of its changes.
    history : History or None
    step : float
        Time step, s.
    columns : sequence of int
        Components of the motion.
    sizes : sequence of float
        Steps of the differences over ``unit``.
    limit : float
    """
    columns, errors = list(columns), []
    exact = (model.evaluate(motion, history, step).tangent() * unit)[:, columns]
    rows = np.abs(exact).max(axis=1)
    for h in sizes:
        ends = [
            [model.evaluate(motion + k * d, history, step).wrench for k in (-2, -1, 1, 2)]
            for d in h * np.diag(unit)[columns]
        ]
        found = np.array([(8.0 * (w[2] - w[1]) - (w[3] - w[0])) / (12.0 * h) for w in ends]).T
        errors.append(float((np.abs(found - exact) / rows[:, None]).max()))
        if errors[-1] < limit:
            break
    return min(errors)
