"""Triplets against scipy."""

import numpy as np
from scipy.sparse import coo_matrix

from exudyn_ehd.solid.linear.triplets import Triplets


def test_triplets_are_summed_whether_their_places_are_known_or_new():
    rng, triplets = np.random.default_rng(2), Triplets()
    for places in (rng.integers(0, 9, (2, 60)), rng.integers(0, 9, (2, 40))):
        for _ in range(4):
            values = rng.standard_normal(places.shape[1])
            found = triplets.matrix([(*places[:, :30], values[:30]), (*places[:, 30:], values[30:])], 9)
            expected = coo_matrix((values, tuple(places)), shape=(9, 9)).toarray()
            np.testing.assert_allclose(found.toarray(), expected, atol=1e-14)
            assert found.has_sorted_indices
