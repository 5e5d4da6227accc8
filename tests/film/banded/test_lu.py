"""Refusals of the banded LU; its solutions are those of `test_substitution` and `test_many_sides`."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.factors import factor_lu
from exudyn_ehd.film.banded.workspace import PAD


@pytest.mark.parametrize("width", [2, 70])
@pytest.mark.parametrize("count", [75, 76, 77])
def test_a_vanishing_pivot_is_told(count, width):
    """In every place of a panel, and behind the last whole one; elsewhere a diagonal matrix."""
    for r in (0, 1, 2, 3, count - 2, count - 1):
        lower, upper = (np.zeros((count + PAD, width + 1 + PAD)) for _ in range(2))
        upper[:count, 0] = 1.0
        upper[r, 0] = 0.0
        assert not factor_lu(lower, upper, count, width, np.zeros(count))
