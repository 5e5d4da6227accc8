"""The estimator of a reference's own error on functions whose order and limit are known."""

import numpy as np
import pytest

from exudyn_ehd.status import InputError
from exudyn_ehd.studies.film_errors import LOWEST_ORDER, converged

SCALE = 2.0


def _distance(a, b):
    return float(np.max(np.abs(a - b))) / SCALE


def _levels(order, ratio, limit, scale=0.3):
    return [limit + scale * (0.1 / ratio**k) ** order * np.ones_like(limit) for k in range(3)]


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("ratio", [1.5, 2.0])
def test_known_order(order, ratio):
    limit = np.array([2.0, -1.0])
    levels = _levels(order, ratio, limit)
    found = converged(levels, ratio=ratio, formal_order=2.0, scale=SCALE)
    assert found.order == pytest.approx(order, rel=1e-6)
    # a single power of h: the estimate is exact
    assert found.error == pytest.approx(_distance(levels[2], limit), rel=1e-9)
    assert np.array_equal(found.value, levels[2])


def test_trapezoidal_rule():
    """Integral of exp over [0, 1], second order."""

    def rule(n):
        return np.array([np.trapezoid(np.exp(np.linspace(0.0, 1.0, n + 1)), dx=1.0 / n)])

    found = converged([rule(8), rule(16), rule(32)], ratio=2.0, formal_order=2.0, scale=SCALE)
    # the next term, h^4, changes the estimate by about h^2
    assert found.error == pytest.approx((rule(32)[0] - np.e + 1.0) / SCALE, rel=1e-2)


def test_order_is_cut_off():
    limit = np.array([1.0])
    faster = converged(_levels(4.0, 2.0, limit), ratio=2.0, formal_order=2.0, scale=SCALE)
    assert faster.order == 2.0
    assert faster.error > _distance(_levels(4.0, 2.0, limit)[2], limit)
    diverging = converged([limit, limit + 0.01, limit - 0.02], ratio=2.0, formal_order=2.0, scale=SCALE)
    assert diverging.order == LOWEST_ORDER
    assert diverging.error > 0.015


def test_equal_levels_have_no_error():
    same = [np.array([3.0])] * 3
    assert converged(same, ratio=2.0, formal_order=2.0, scale=SCALE).error == 0.0


@pytest.mark.parametrize("levels", [[np.ones(1)] * 2, [np.full(1, np.nan)] * 3])
def test_refuses(levels):
    with pytest.raises(InputError):
        converged(levels, ratio=2.0, formal_order=2.0, scale=SCALE)
